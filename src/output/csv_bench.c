/* A work-precision study as CSV: one header row, a row a setting, empty fields for numbers that are not there. */
#include <math.h>
#include <string.h>

#include "output/bench.h"
#include "support/number.h"

enum { ROW_LENGTH = 1024 };

/* One row while it grows; ROW_LENGTH holds any. */
typedef struct line {
    char text[ROW_LENGTH];
    size_t length;
} line;

static void put(line *row, const char *text)
{
    const size_t length = strlen(text);
    memcpy(row->text + row->length, text, length);
    row->length += length;
}

static void put_number(line *row, double value)
{
    put(row, ",");
    row->length += dea_number_write(row->text + row->length, value);
}

static void put_count(line *row, size_t value)
{
    put_number(row, (double)value);
}

/* A field of words, quotes doubled. */
static void put_words(line *row, const char *words)
{
    const bool quoted = strpbrk(words, ",\"\n") != NULL;
    put(row, quoted ? ",\"" : ",");
    for (const char *letter = words; *letter; letter++) {
        const char text[3] = {*letter, *letter == '"' ? '"' : '\0', '\0'};
        put(row, text);
    }
    put(row, quoted ? "\"" : "");
}

static const char header[] = "model,engine,accuracy_loosest,accuracy,outcome,runs,time_s,time_fastest_s,time_lower_quartile_s,"
                             "time_upper_quartile_s,time_slowest_s,start_s,unit,time_per_unit_s,error,reference,"
                             "reference_accuracy,promise,dominated,states_differ,rows_failed,model_error_median,"
                             "model_error_worst,model_error_points,reason,model_error_rms,delivered_over_asked\n";

static void put_times(line *row, const dea_bench *bench, const dea_bench_setting *setting)
{
    const double none = (double)NAN;
    const bool measured = setting->state == DEA_BENCH_MEASURED;
    const double times[] = {setting->seconds, setting->fastest, setting->lower, setting->upper, setting->slowest, setting->start};
    put_count(row, setting->runs);
    for (size_t i = 0; i < sizeof times / sizeof *times; i++) {
        put_number(row, measured ? times[i] : none);
    }
    put_words(row, bench->unit);
    put_number(row, measured ? setting->seconds / bench->units : none);
}

static void put_setting(line *row, const dea_bench *bench, const dea_bench_setting *setting)
{
    static const char *const outcomes[] = {"measured", "refused", "skipped", "failed"};
    const double none = (double)NAN;
    const dea_bench_model *model = &bench->models[setting->model];
    const bool measured = setting->state == DEA_BENCH_MEASURED;
    const bool judged = measured && model->reference && !setting->reference;
    put(row, model->model->name);
    put_words(row, setting->engine->name);
    put_number(row, setting->loosest);
    put_number(row, setting->accuracy);
    put_words(row, outcomes[setting->state]);
    put_times(row, bench, setting);
    put_number(row, judged ? setting->error : none);
    put_words(row, !measured || !model->reference ? "" : setting->reference ? "itself" : model->reference->name);
    put_number(row, measured ? model->reference_accuracy : none);
    put_words(row, !judged ? "" : setting->broken ? "broken" : "kept");
    put_words(row, !measured ? "" : setting->dominated ? "1" : "0");
    put_count(row, setting->states);
    put_count(row, setting->failed);
    put_number(row, model->error_median);
    put_number(row, model->error_worst);
    put_count(row, model->error_points);
    put_words(row, setting->reason);
    put_number(row, model->error_rms);
    put_number(row, judged ? setting->error / setting->accuracy : none);
    put(row, "\n");
}

dea_status dea_bench_table(const dea_bench *bench, dea_atomic *file, dea_error *error)
{
    dea_status status = dea_atomic_write(file, header, sizeof header - 1, error);
    for (size_t i = 0; i < bench->setting_count && status == DEA_OK; i++) {
        line row = {.length = 0};
        put_setting(&row, bench, &bench->settings[i]);
        status = dea_atomic_write(file, row.text, row.length, error);
    }
    return status;
}
