#include <errno.h>
#include <math.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "deaspice/fit.h"
#include "deaspice/plot.h"
#include "output/atomic.h"
#include "program/program.h"

static dea_load load_of(dea_given_mode mode)
{
    static const dea_load loads[] = {DEA_LOAD_UNKNOWN, DEA_LOAD_UNIAXIAL, DEA_LOAD_EQUIBIAXIAL};
    return loads[mode];
}

static dea_status read_all(const dea_arguments *arguments, dea_fit_data *data, dea_error *error)
{
    dea_status status = DEA_OK;
    for (size_t i = 0; i < arguments->operand_count && status == DEA_OK; i++)
        status = dea_fit_read(arguments->operands[i].path, load_of(arguments->operands[i].mode), data, error);
    return status;
}

static dea_status write_text(const char *path, const char *text, size_t length, dea_error *error)
{
    dea_atomic file;
    dea_status status = dea_atomic_open(&file, path, error);
    if (status != DEA_OK)
        return status;
    status = dea_atomic_write(&file, text, length, error);
    dea_status closed = dea_atomic_close(&file, status == DEA_OK, status == DEA_OK ? error : NULL);
    return status != DEA_OK ? status : closed;
}

static dea_status write_fit(const dea_fit *fit, const char *path, dea_error *error)
{
    char *text = NULL;
    size_t length = 0;
    FILE *stream = open_memstream(&text, &length);
    if (!stream)
        return dea_fail(error, DEA_ERROR_MEMORY, "out of memory");
    dea_status status = dea_fit_print(fit, stream, error);
    if (fclose(stream) != 0 && status == DEA_OK)
        status = dea_fail(error, DEA_ERROR_MEMORY, "out of memory");
    if (status == DEA_OK)
        status = write_text(path, text, length, error);
    free(text);
    return status;
}

static void tell(const dea_arguments *arguments, const dea_fit *fit)
{
    if (!isnan(fit->unstable_stretch))
        dea_complain("warning: a tangent modulus of the fit is not positive from stretch %.4g on", fit->unstable_stretch);
    if (arguments->quiet || (!arguments->output && !arguments->plot))
        return;
    fprintf(stderr,
            "%d term%s from %zu uniaxial and %zu equi-biaxial points, stretch %.4g to %.4g: R^2 = %.6f, rms residual %.4g Pa\n",
            fit->terms, fit->terms == 1 ? "" : "s", fit->count[DEA_LOAD_UNIAXIAL], fit->count[DEA_LOAD_EQUIBIAXIAL],
            fit->stretch_min, fit->stretch_max, fit->r_squared, fit->residual_rms);
}

static dea_exit run(const dea_arguments *arguments)
{
    dea_fit_data data = {0};
    dea_fit fit;
    dea_error error = {0};
    dea_signals_catch();
    dea_status status = read_all(arguments, &data, &error);
    if (status == DEA_OK)
        status =
            dea_fit_yeoh(&data, arguments->terms ? (int)arguments->terms : DEA_YEOH_TERMS, arguments->relative, &fit, &error);
    if (status == DEA_OK && (arguments->output || !arguments->plot))
        status = write_fit(&fit, arguments->output ? arguments->output : "-", &error);
    if (status == DEA_OK && arguments->plot)
        status = dea_plot_fit(&fit, &data, arguments->plot, &error);
    if (status == DEA_OK)
        tell(arguments, &fit);
    dea_fit_data_free(&data);
    return status == DEA_OK ? DEA_EXIT_DONE : dea_complain_error(&error);
}

const dea_command dea_command_fit = {
    .name = "fit",
    .summary = "material constants from measured data",
    .help = "Usage: deaspice fit [OPTION]... [DATA]...\n"
            "\n"
            "Fits Yeoh constants to measured stress over stretch and prints them as a material\n"
            "for a scene. DATA is a CSV file with the columns stretch, stress_Pa (or stress_kPa,\n"
            "stress_MPa; nominal stress) and mode (uniaxial or equibiaxial), - is standard input.\n"
            "Files without the column mode are given by --uniaxial or --equibiaxial.\n"
            "\n"
            "      --uniaxial FILE     data of a uniaxial test; may be repeated\n"
            "      --equibiaxial FILE  data of an equi-biaxial test; may be repeated\n"
            "      --terms N           1 (neo-Hookean), 2 or 3 (default) constants\n"
            "      --relative          relative instead of absolute errors count\n"
            "  -o, --output FILE       write the material to FILE, - is standard output\n"
            "      --plot FILE         draw data and fit, FILE ends in .svg or .png\n"
            "  -q, --quiet             no summary\n"
            "  -h, --help              this text\n"
            "  -V, --version           the version\n"
            "\n"
            "Example:\n"
            "  deaspice fit --uniaxial pull.csv --equibiaxial bulge.csv -o film.yaml --plot fit.svg\n",
    .takes = DEA_TAKES_OUTPUT | DEA_TAKES_PLOT | DEA_TAKES_QUIET | DEA_TAKES_FIT,
    .least = 1,
    .most = SIZE_MAX,
    .run = run,
};
