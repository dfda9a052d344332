/* SPICE raw file as ngspice writes it: per run an ASCII header, then doubles of this machine, point after point. A plot holds one
 * run: a transient, a frequency response in complex numbers, or the longest axis of a sweep, so that headers stay few; the title
 * names the model and the other axes' values.
 *
 * Readers take a header for a program: ngspice and WRspice execute what stands behind "Command:", before version 44 even the
 * name of the writer, which makes ngspice source a file of that name. So the one such line is a comment, enough for readers that
 * look in it for the writer's dialect. ngspice reads lines of 511 bytes and takes the rest of a longer one for a line of its
 * own, so that a title is cut short.
 *
 * The format has no missing value, and an ngspice that plots a vector of NAN never ends: rows without numbers are left out, and
 * with them runs that have no others. */
#include "output/writer.h"
#include "study/study.h"
#include "support/number.h"
#include "support/text.h"

#include "deaspice/model.h"

#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

#ifndef DEA_VERSION
#define DEA_VERSION "unknown"
#endif

enum {
    RAW_BUFFER = 1 << 16,
    RAW_PIECE = 512, /* most bytes that go to the buffer at once: a line, or a row */
    RAW_TITLE = 240, /* room for the scene's title, and for what tells the run */
    RAW_TRACES = DEA_LAYOUT_COLUMNS + 2,
    RAW_HELD = 1 << 28, /* most bytes of a sweep that are collected for an axis that is not the last */
    DATE_ROOM = 64
};

/* Where the number of a vector comes from. */
typedef enum trace_kind { TRACE_AXIS, TRACE_COLUMN, TRACE_POLAR, TRACE_STATE } trace_kind;

typedef struct trace {
    trace_kind kind;
    char name[DEA_NAME_LENGTH];
    const char *type;
    size_t offset, phase; /* of a column, of magnitude and phase [deg] in a row */
} trace;

typedef struct raw {
    const dea_scene *scene;
    const dea_study *study;
    dea_layout layout;
    dea_atomic *file;
    trace traces[RAW_TRACES];
    size_t trace_count;
    bool is_sweep;   /* along an axis */
    size_t axis;     /* of a sweep: that of the runs */
    size_t inner;    /* of a sweep: points for one value of that axis, which come between two of a run; else 1 */
    size_t length;   /* rows of a run */
    size_t run;      /* number of the run that comes next: models slowest, last of the other axes fastest */
    size_t plots;    /* written */
    char *rows;      /* of the runs of a sweep that are being collected, length times inner of them; NULL else */
    size_t row_next; /* of those */
    char date[DATE_ROOM];
    char *buffer; /* RAW_BUFFER and room for one piece more */
    size_t used;
} raw;

static dea_status raw_flush(raw *out, dea_error *error)
{
    const size_t used = out->used;
    out->used = 0;
    return dea_atomic_write(out->file, out->buffer, used, error);
}

/* Appends at most RAW_PIECE bytes of text. */
static void DEA_PRINTF(2, 3) raw_print(raw *out, const char *format, ...)
{
    va_list list;
    va_start(list, format);
    const int length = vsnprintf(out->buffer + out->used, RAW_PIECE, format, list);
    va_end(list);
    out->used += length < RAW_PIECE ? (size_t)length : RAW_PIECE - 1;
}

static void raw_put(raw *out, double value)
{
    memcpy(out->buffer + out->used, &value, sizeof value);
    out->used += sizeof value;
}

/* Word of ngspice for the quantity in this unit. */
static const char *type_of(const char *unit)
{
    static const char *const words[][2] = {{"s", "time"},    {"Hz", "frequency"}, {"V", "voltage"},
                                           {"A", "current"}, {"C", "charge"},     {"Ohm", "impedance"}};
    for (size_t i = 0; i < sizeof words / sizeof *words; i++) {
        if (strcmp(words[i][0], unit) == 0) {
            return words[i][1];
        }
    }
    return "notype";
}

static trace *trace_add(raw *out, trace_kind kind, const char *name, const char *type)
{
    trace *added = &out->traces[out->trace_count++];
    *added = (trace){.kind = kind, .type = type};
    snprintf(added->name, sizeof added->name, "%s", name);
    return added;
}

/* The vectors of a plot, the one that the others are drawn over first: ngspice knows it by name as time or frequency. */
static void traces_choose(raw *out)
{
    const dea_scene *scene = out->scene;
    const dea_layout *layout = &out->layout;
    if (out->is_sweep) {
        const dea_axis *along = &scene->axes[out->axis];
        trace_add(out, TRACE_AXIS, along->column, type_of(along->unit));
    }
    for (size_t i = 0; i < layout->column_count; i++) {
        const dea_column *column = &layout->columns[i];
        const bool scale = i == 0 && out->study->along;
        const bool polar = i + 1 < layout->column_count && strcmp(column[1].unit, "degree") == 0;
        const char *type = type_of(column->unit);
        trace *added = trace_add(out, polar ? TRACE_POLAR : TRACE_COLUMN, scale && strcmp(type, "notype") != 0 ? type : column->name, type);
        added->offset = column->offset;
        if (polar) {
            added->phase = column[1].offset;
            i++;
        }
    }
    trace_add(out, TRACE_STATE, "state", "notype");
}

/* Seconds since 1970 that the environment wants as the date of reproducible files, or 0: the same study gives the same bytes, now
 * or in parts, today or tomorrow, and some readers count on the line. */
static time_t date_wanted(void)
{
    const char *wanted = getenv("SOURCE_DATE_EPOCH");
    char *end = NULL;
    const long long seconds = wanted ? strtoll(wanted, &end, 10) : 0;
    const long long most = 253402300799; /* end of the year 9999 */
    return wanted && end != wanted && *end == '\0' && seconds >= 0 && seconds <= most ? (time_t)seconds : 0;
}

/* Universal time in English, whatever the locale. */
static void date_write(char date[DATE_ROOM])
{
    static const char days[][4] = {"Sun", "Mon", "Tue", "Wed", "Thu", "Fri", "Sat"};
    static const char months[][4] = {"Jan", "Feb", "Mar", "Apr", "May", "Jun", "Jul", "Aug", "Sep", "Oct", "Nov", "Dec"};
    const time_t now = date_wanted();
    struct tm at = {0};
    char clock[16] = "";
    gmtime_r(&now, &at);
    strftime(clock, sizeof clock, "%H:%M:%S", &at);
    snprintf(date, DATE_ROOM, "%s %s %2d %s  %d", days[at.tm_wday], months[at.tm_mon], at.tm_mday, clock, at.tm_year + 1900);
}

/* What tells the run from its siblings: ", model = lumped, coverage = 0.5"; empty where there is but one. */
static void run_describe(const raw *out, char text[RAW_TITLE])
{
    const dea_scene *scene = out->scene;
    const size_t along = out->is_sweep ? out->axis : scene->axis_count;
    size_t stride = 1; /* runs for one value of the axis */
    for (size_t i = 0; i < scene->axis_count; i++) {
        stride *= i == along ? 1 : scene->axes[i].count;
    }
    size_t left = out->run % stride;
    int used = 0;
    text[0] = '\0';
    if (scene->model_count > 1) {
        used = snprintf(text, RAW_TITLE, ", model = %s", scene->models[out->run / stride]->name);
    }
    for (size_t i = 0; i < scene->axis_count && used < RAW_TITLE; i++) {
        const dea_axis *axis = &scene->axes[i];
        char number[DEA_NUMBER_LENGTH];
        if (i == along) {
            continue;
        }
        stride /= axis->count;
        dea_number_text(number, axis->values[left / stride], 9);
        used += snprintf(text + used, (size_t)(RAW_TITLE - used), ", %s = %s", axis->column, number);
        left %= stride;
    }
}

static void header_write(raw *out, size_t points)
{
    const dea_scene *scene = out->scene;
    const bool is_point = !out->study->along && !out->is_sweep;
    char title[RAW_TITLE], run[RAW_TITLE];
    dea_text_clip(*scene->title ? scene->title : "deaspice", RAW_TITLE, title, sizeof title);
    run_describe(out, run);
    raw_print(out, "Title: %s%s\n", title, run);
    raw_print(out, "Date: %s\n", out->date);
    raw_print(out, "Plotname: %s\n", is_point ? "Operating Point" : out->study->plot_name);
    raw_print(out, "Command: * ngspice raw file written by deaspice " DEA_VERSION "\n");
    raw_print(out, "Flags: %s\n", out->study->phasors ? "complex" : "real");
    raw_print(out, "No. Variables: %zu\nNo. Points: %zu\nVariables:\n", out->trace_count, points);
    for (size_t i = 0; i < out->trace_count; i++) {
        const trace *vector = &out->traces[i];
        const bool is_frequency = i == 0 && out->study->phasors;
        raw_print(out, "\t%zu\t%s\t%s%s\n", i, vector->name, vector->type, is_frequency ? " grid=3" : "");
    }
    raw_print(out, "Binary:\n");
}

/* Appends row @p index of a run. */
static void row_write(raw *out, size_t index, const char *row)
{
    const dea_scene *scene = out->scene;
    for (size_t i = 0; i < out->trace_count; i++) {
        const trace *vector = &out->traces[i];
        double value[2] = {0.0, 0.0}; /* real and imaginary part */
        if (vector->kind == TRACE_AXIS) {
            value[0] = scene->axes[out->axis].values[index];
        } else if (vector->kind == TRACE_STATE) {
            value[0] = (double)dea_layout_state(&out->layout, row);
        } else if (vector->kind == TRACE_COLUMN) {
            value[0] = dea_layout_number(row, vector->offset);
        } else {
            const double magnitude = dea_layout_number(row, vector->offset);
            const double phase = dea_layout_number(row, vector->phase) * (3.14159265358979323846 / 180.0);
            value[0] = magnitude * cos(phase);
            value[1] = magnitude * sin(phase);
        }
        raw_put(out, value[0]);
        if (out->study->phasors) {
            raw_put(out, value[1]);
        }
    }
}

static bool has_numbers(const dea_layout *layout, const char *row)
{
    const dea_state state = dea_layout_state(layout, row);
    return state != DEA_STATE_PULL_IN && state != DEA_STATE_FAILED;
}

/* Writes the rows of the next run as a plot; others may lie between them. */
static dea_status run_write(raw *out, const char *rows, dea_error *error)
{
    const size_t size = out->inner * out->layout.row_size;
    size_t points = 0;
    for (size_t i = 0; i < out->length; i++) {
        points += has_numbers(&out->layout, rows + i * size);
    }
    if (points > 0) {
        dea_status status = out->used > RAW_BUFFER / 2 ? raw_flush(out, error) : DEA_OK; /* a header needs less than half */
        header_write(out, points);
        for (size_t i = 0; i < out->length && status == DEA_OK; i++) {
            if (has_numbers(&out->layout, rows + i * size)) {
                row_write(out, i, rows + i * size);
            }
            status = out->used >= RAW_BUFFER ? raw_flush(out, error) : DEA_OK;
        }
        if (status != DEA_OK) {
            return status;
        }
        out->plots++;
    }
    out->run++;
    return DEA_OK;
}

static void raw_free(raw *out)
{
    free(out->rows);
    free(out->buffer);
    free(out);
}

static dea_status raw_close(void *state, bool keep, dea_error *error)
{
    raw *out = state;
    if (!out) {
        return DEA_OK;
    }
    dea_status status = DEA_OK;
    if (keep && out->plots == 0) {
        status = dea_fail(error, DEA_ERROR_USAGE, "%s: no point has numbers, and a raw file holds nothing else; use csv or nc",
                          out->file->target);
    } else if (keep) {
        status = raw_flush(out, error);
    }
    raw_free(out);
    return status;
}

/* The longest axis, the later of two, of those whose runs can be held until they are whole. */
static void axis_choose(raw *out)
{
    const dea_scene *scene = out->scene;
    size_t inner = 1;
    for (size_t i = scene->axis_count; i-- > 0;) {
        const size_t count = scene->axes[i].count;
        if (i + 1 == scene->axis_count || (count > out->length && count <= RAW_HELD / out->layout.row_size / inner)) {
            out->axis = i;
            out->inner = inner;
            out->length = count;
        }
        inner *= count;
    }
}

static dea_status raw_open(const dea_scene *scene, const char *engine, dea_atomic *file, void **state, dea_error *error)
{
    (void)engine;
    raw *out = calloc(1, sizeof *out);
    if (!out) {
        return dea_fail(error, DEA_ERROR_MEMORY, "out of memory");
    }
    out->scene = scene;
    out->study = dea_study_of(scene);
    out->layout = dea_layout_of(scene);
    out->file = file;
    out->is_sweep = !out->study->along && scene->axis_count > 0;
    out->inner = 1;
    out->length = out->layout.rows;
    if (out->is_sweep) {
        axis_choose(out);
        out->rows = calloc(out->length * out->inner, out->layout.row_size);
    }
    out->buffer = malloc(RAW_BUFFER + RAW_PIECE);
    if (!out->buffer || (out->is_sweep && !out->rows)) {
        raw_free(out);
        return dea_fail(error, DEA_ERROR_MEMORY, "out of memory");
    }
    traces_choose(out);
    date_write(out->date);
    *state = out;
    return DEA_OK;
}

/* Readers that know one plot a file are many, and none has room for numbers over the radius in each row. */
static bool raw_note(const void *state, char text[DEA_NOTE_LENGTH])
{
    const raw *out = state;
    const size_t points = dea_scene_point_count(out->scene) * out->scene->model_count, plots = out->is_sweep ? points / out->length : points;
    const bool spread = out->layout.spread_count > 0;
    char many[96] = "";
    if (plots > 1) {
        snprintf(many, sizeof many, " holds a plot for each of %zu runs, and many viewers show the first alone", plots);
    }
    snprintf(text, DEA_NOTE_LENGTH, "%s%s%s%s", out->file->target, many, spread && *many ? ", and" : "",
             spread ? " leaves out what the film does along its radius: csv and nc have it" : "");
    return spread || *many;
}

/* Takes one point: a whole run, or a row of a run of a sweep. */
static dea_status raw_point(raw *out, const char *point, dea_error *error)
{
    if (!out->is_sweep) {
        return run_write(out, point, error);
    }
    memcpy(out->rows + out->row_next * out->layout.row_size, point, out->layout.row_size);
    out->row_next = (out->row_next + 1) % (out->length * out->inner);
    dea_status status = DEA_OK;
    for (size_t i = 0; i < out->inner && out->row_next == 0 && status == DEA_OK; i++) {
        status = run_write(out, out->rows + i * out->layout.row_size, error);
    }
    return status;
}

static dea_status raw_points(void *state, size_t first, const void *points, size_t count, dea_error *error)
{
    (void)first;
    raw *out = state;
    for (size_t i = 0; i < count; i++) {
        const dea_status status = raw_point(out, (const char *)points + i * out->layout.point_size, error);
        if (status != DEA_OK) {
            return status;
        }
    }
    return out->file->direct ? raw_flush(out, error) : DEA_OK; /* a reader at the other end sees runs as they come */
}

const dea_format dea_format_raw = {.name = "raw", .straight = true, .open = raw_open, .note = raw_note, .points = raw_points, .close = raw_close};
