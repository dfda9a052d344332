/* A waveform from a table with columns of time and voltage. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "scene/reader.h"
#include "support/file.h"
#include "support/table.h"

enum { ROWS_MAX = 1000000 };
enum { TIME, VOLTAGE, COLUMNS };

static const char *const time_names[] = {"t", NULL};
static const char *const voltage_names[] = {"volt", "volts", "u", "v", "potential", NULL};
static const dea_wanted wanted[COLUMNS] = {
    [TIME] = {.name = "time", .aliases = time_names, .unit = "s", .assumed = "s", .by_unit = true, .suffixes = true},
    [VOLTAGE] = {.name = "voltage", .aliases = voltage_names, .unit = "V", .assumed = "V", .by_unit = true, .suffixes = true},
};

/* Neighbouring rows of equal time are a jump; those of a clock too coarse for its rows, where more than this share of the times
 * stand twice, the voltage rarely rests between them, and where it goes on within a time as it does to the next: a sawtooth turns. */
static const double twice_most = 0.25, resting_least = 0.5, going_least = 0.5;

/* Adds a row to the points; times fall nowhere. */
static dea_status row_add(const dea_table *table, dea_waveform *wave, double time, double voltage)
{
    const size_t count = wave->point_count;
    if (count == ROWS_MAX) {
        return dea_table_fail(table, 1, "too many rows; accepted: at most 1000000");
    }
    const double step = count > 0 ? time - wave->times[count - 1] : INFINITY;
    if (step < 0.0) {
        return dea_table_fail_at(table, TIME, "this time lies before that of the row above:");
    }
    if (step > 0.0 && step < DEA_EDGE_MIN) {
        return dea_table_fail_at(table, TIME, "two times are closer than 1e-12 s:");
    }
    wave->times[count] = time;
    wave->voltages[count] = voltage;
    wave->point_count++;
    return DEA_OK;
}

static dea_status rows_read(dea_table *table, dea_waveform *wave)
{
    double values[DEA_TABLE_WANTED];
    bool more = true;
    wave->point_count = 0;
    dea_status status = dea_table_row(table, values, &more);
    while (status == DEA_OK && more) {
        status = row_add(table, wave, values[TIME], values[VOLTAGE]);
        status = status ? status : dea_table_row(table, values, &more);
    }
    return status;
}

/* Rows of one time from point @p first on. */
static size_t rows_at(const dea_waveform *wave, size_t first)
{
    size_t count = 1;
    while (first + count < wave->point_count && wave->times[first + count] == wave->times[first]) {
        count++;
    }
    return count;
}

/* True where equal times come from a clock that is too coarse. */
static bool clock_is_coarse(const dea_waveform *wave)
{
    size_t times = 0, twice = 0, resting = 0, going = 0;
    bool thrice = false; /* no jump has a row in its middle */
    for (size_t i = 0; i < wave->point_count;) {
        const size_t rows = rows_at(wave, i);
        const size_t next = i + rows;
        const double within = wave->voltages[next - 1] - wave->voltages[i];
        const double across = next < wave->point_count ? wave->voltages[next] - wave->voltages[next - 1] : 0.0;
        times++;
        twice += rows > 1;
        thrice = thrice || rows > 2;
        resting += next < wave->point_count && across == 0.0;
        going += within * across > 0.0;
        i = next;
    }
    const bool coarse = (double)twice > twice_most * (double)times && (double)resting < resting_least * (double)times;
    return coarse && (thrice || (double)going >= going_least * (double)twice);
}

/* Of the rows of one time stay the mean, where the clock is coarse, else the first and the last, which are a jump; says so where
 * there are any. */
static const char *settle_times(dea_waveform *wave)
{
    const bool coarse = clock_is_coarse(wave);
    const size_t read = wave->point_count;
    size_t kept = 0, times = 0;
    for (size_t i = 0; i < wave->point_count;) {
        const size_t rows = rows_at(wave, i);
        double sum = 0.0;
        for (size_t k = 0; k < rows; k++) {
            sum += wave->voltages[i + k];
        }
        const double time = wave->times[i], last = wave->voltages[i + rows - 1];
        wave->voltages[kept] = coarse ? sum / (double)rows : wave->voltages[i];
        wave->times[kept++] = time;
        if (!coarse && rows > 1 && last != wave->voltages[kept - 1]) {
            wave->times[kept] = time;
            wave->voltages[kept++] = last;
        }
        times++;
        i += rows;
    }
    wave->point_count = kept;
    return times == read ? "" : coarse ? "; of rows at one time counts their mean" : "; two rows at one time are a jump";
}

/* A run begins at time 0: what a recorder wrote before its trigger is cut off there. */
static void cut_before_zero(dea_waveform *wave)
{
    size_t first = 0;
    while (first < wave->point_count && wave->times[first] < 0.0) {
        first++;
    }
    if (first == 0) {
        return;
    }
    const size_t before = first - 1;
    if (first == wave->point_count || wave->times[first] > 0.0) {
        const double span = first < wave->point_count ? wave->times[first] - wave->times[before] : 1.0;
        const double rise = first < wave->point_count ? wave->voltages[first] - wave->voltages[before] : 0.0;
        wave->voltages[before] -= rise * wave->times[before] / span;
        wave->times[before] = 0.0;
        first = before;
    }
    wave->point_count -= first;
    memmove(wave->times, wave->times + first, wave->point_count * sizeof *wave->times);
    memmove(wave->voltages, wave->voltages + first, wave->point_count * sizeof *wave->voltages);
}

static size_t lines_of(const char *text, size_t length)
{
    size_t lines = 1;
    for (const char *at = text; at < text + length; at++) {
        lines += *at == '\n' || *at == '\r';
    }
    return lines;
}

static dea_status table_read(dea_reader *reader, dea_table *table, const char *text, size_t length)
{
    dea_waveform *wave = &reader->scene->drive.waveform;
    const size_t lines = lines_of(text, length);
    dea_status status = dea_table_begin(table, text, length);
    for (size_t i = 0; i < COLUMNS && status == DEA_OK; i++) {
        if (!table->seen[i]) {
            status = dea_table_missing(table, i, i == TIME ? "name it e.g. time_s" : "name it e.g. voltage_V");
        }
    }
    status = status ? status : dea_points_new(reader, lines < ROWS_MAX ? lines : ROWS_MAX);
    status = status ? status : rows_read(table, wave);
    if (status == DEA_OK && wave->point_count < 2) {
        status = dea_table_fail(table, 1, wave->point_count == 0 ? "no row of numbers below the header"
                                                                 : "a single row of numbers; accepted: two or more, each a time and its voltage");
    }
    if (status == DEA_OK) {
        const char *jumps = settle_times(wave);
        const bool cut = wave->times[0] < 0.0, late = wave->times[0] > 0.0;
        cut_before_zero(wave);
        snprintf(wave->columns, sizeof wave->columns, "%.140s%s%s", table->told, jumps,
                 cut    ? "; what lies before time 0 is cut off"
                 : late ? "; up to its first time the voltage is the first one"
                        : "");
    }
    return status;
}

dea_status dea_read_wave_file(dea_reader *reader, const dea_ref *ref, const dea_node *node)
{
    char shown[DEA_TEXT_ROOM];
    char subject[DEA_NAME_LENGTH + 2];
    char *text = NULL;
    size_t length = 0, failed = 1;
    const char *refused = NULL;
    if (node->kind != DEA_NODE_SCALAR || !node->text[0]) {
        return dea_reader_refuse(reader, ref, node, node->kind == DEA_NODE_SCALAR ? "has no value" : "not a file name");
    }
    const dea_status named = dea_reader_names_file(reader, ref, node);
    if (named) {
        return named;
    }
    char *path = dea_reader_path(reader, node);
    dea_origin *origin = path ? dea_reader_origin(reader, path) : NULL;
    const dea_status read =
        origin ? dea_file_read(path, false, DEA_WAVE_FILE_MAX, &text, &length, reader->scene->files, &refused) : DEA_ERROR_MEMORY;
    if (read == DEA_ERROR_MEMORY) {
        return dea_reader_memory(reader);
    }
    if (read) {
        return dea_place_fail(&node->place, reader->error, ref->path, "cannot read the file %s: %s", dea_reader_show(node, shown),
                              refused);
    }
    snprintf(subject, sizeof subject, "%.*s: ", DEA_NAME_LENGTH - 1, ref->path);
    dea_table table = {.name = origin->name,
                       .subject = subject,
                       .wanted = wanted,
                       .wanted_count = COLUMNS,
                       .headless = true,
                       .guarded = true,
                       .units = reader->units,
                       .error = reader->error,
                       .failed = &failed};
    const dea_status status = table_read(reader, &table, text, length);
    if (status == DEA_ERROR_SCENE && reader->error && !table.guarded) {
        *origin = (dea_origin){.name = origin->name, .folder = origin->folder, .text = text, .length = length};
        const dea_place place = {.origin = origin, .line = (int)table.line, .column = (int)failed};
        dea_place_excerpt(&place, reader->error->excerpt, sizeof reader->error->excerpt);
        origin->text = NULL; /* it ends here */
    }
    dea_table_end(&table);
    free(text);
    return status;
}
