#include "output/bench.h"

#include "picture/picture.h"

#include <stdlib.h>

struct dea_bench_output {
    dea_atomic table;    /* zeroed: none */
    dea_gnuplot picture; /* zeroed: none */
    bool has_table, has_picture;
};

dea_status dea_bench_output_open(const char *table, const char *picture, const dea_plot_options *options,
                                 dea_bench_output **output, dea_error *error)
{
    *output = NULL;
    dea_bench_output *opened = calloc(1, sizeof *opened);
    if (!opened) {
        return dea_fail(error, DEA_ERROR_MEMORY, "out of memory");
    }
    dea_status status = table ? dea_atomic_open(&opened->table, table, error) : DEA_OK;
    opened->has_table = table && status == DEA_OK;
    if (status == DEA_OK && picture) {
        status = dea_gnuplot_begin(&opened->picture, picture, options, error);
        opened->has_picture = status == DEA_OK;
    }
    if (status != DEA_OK) {
        dea_bench_output_finish(opened, NULL, NULL);
        return status;
    }
    *output = opened;
    return DEA_OK;
}

static dea_status finish_table(dea_bench_output *output, const dea_bench *bench, dea_error *error)
{
    const dea_status status = bench ? dea_bench_table(bench, &output->table, error) : DEA_OK;
    const dea_status closed = dea_atomic_close(&output->table, bench && status == DEA_OK, error);
    return status != DEA_OK ? status : closed;
}

static dea_status finish_picture(dea_bench_output *output, const dea_bench *bench, dea_error *error)
{
    const dea_status status = bench ? dea_bench_picture(bench, &output->picture, error) : DEA_OK;
    const dea_status drawn = dea_gnuplot_finish(&output->picture, bench && status == DEA_OK, status == DEA_OK ? error : NULL);
    return status != DEA_OK ? status : drawn;
}

dea_status dea_bench_output_finish(dea_bench_output *output, const dea_bench *bench, dea_error *error)
{
    dea_status status = DEA_OK;
    if (!output) {
        return DEA_OK;
    }
    if (output->has_table) {
        status = finish_table(output, bench, error);
    }
    if (output->has_picture) {
        const dea_status drawn = finish_picture(output, status == DEA_OK ? bench : NULL, status == DEA_OK ? error : NULL);
        status = status != DEA_OK ? status : drawn;
    }
    free(output);
    return status;
}
