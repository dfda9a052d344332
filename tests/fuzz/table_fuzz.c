/* libFuzzer target of the reader of tables: as a waveform with a header or without one, then as data of a fit. */
#include <math.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include "support/table.h"

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size);

static const char *const time_names[] = {"t", NULL};
static const char *const mode_words[] = {"uniaxial", "equibiaxial", NULL};
static const dea_wanted waves[] = {{.name = "time", .aliases = time_names, .unit = "s", .assumed = "s", .by_unit = true, .suffixes = true},
                                   {.name = "voltage", .unit = "V", .assumed = "V", .by_unit = true, .suffixes = true}};
static const dea_wanted fits[] = {{.name = "stretch", .unit = "1", .assumed = "1"},
                                  {.name = "strain", .unit = "1", .assumed = "1"},
                                  {.name = "displacement", .unit = "m", .by_unit = true},
                                  {.name = "stress", .unit = "Pa", .by_unit = true},
                                  {.name = "mode", .words = mode_words},
                                  {.name = "time", .aliases = time_names, .unit = "s", .by_unit = true}};
enum { WAVES = sizeof waves / sizeof *waves, FITS = sizeof fits / sizeof *fits };

static void demand(bool holds)
{
    if (!holds) {
        abort();
    }
}

/* A row has numbers where the table has the column, none where it has not, and words that are known. */
static void judge_row(const dea_table *table, const double values[])
{
    for (size_t i = 0; i < table->wanted_count; i++) {
        demand(table->seen[i] ? isfinite(values[i]) : isnan(values[i]));
        demand(!table->seen[i] || dea_table_place(table, i) > 0);
        demand(!table->seen[i] || !table->wanted[i].words || values[i] == 0.0 || values[i] == 1.0);
    }
}

/* Refusals have a message in one line, what is read has none. */
static void judge_error(dea_status status, const dea_error *error)
{
    demand((status == DEA_OK) == (error->message[0] == '\0'));
    for (const char *c = error->message; *c; c++) {
        demand((unsigned char)*c >= 0x20);
    }
}

static void read_table(const dea_wanted *wanted, size_t count, bool headless, const char *text, size_t length)
{
    static dea_units *units;
    units = units ? units : dea_units_open();
    dea_error error = {.status = DEA_OK};
    size_t failed = 1;
    dea_table table = {.name = "fuzz",
                       .subject = "",
                       .wanted = wanted,
                       .wanted_count = count,
                       .headless = headless,
                       .units = units,
                       .error = &error,
                       .failed = &failed};
    double values[DEA_TABLE_WANTED];
    dea_status status = dea_table_begin(&table, text, length);
    bool more = status == DEA_OK;
    size_t line = 0;
    while (more) {
        status = dea_table_row(&table, values, &more);
        more = more && status == DEA_OK;
        if (more) {
            demand(table.line > line);
            line = table.line;
            judge_row(&table, values);
        }
    }
    demand(failed > 0);
    judge_error(status, &error);
    dea_table_end(&table);
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    char *text = malloc(size + 1); /* readers of files end their text with a zero */
    demand(text);
    if (size > 0) {
        memcpy(text, data, size);
    }
    text[size] = '\0';
    read_table(waves, WAVES, true, text, size);
    read_table(waves, WAVES, false, text, size);
    read_table(fits, FITS, false, text, size);
    free(text);
    return 0;
}
