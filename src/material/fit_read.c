/* Tables of stress over stretch and of stress over time. */
#include "deaspice/fit.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "material/fit_plausible.h"
#include "support/file.h"
#include "support/table.h"

enum { STRETCH, STRAIN, DISPLACEMENT, STRESS, FORCE, MODE, TIME, COLUMNS };
_Static_assert((int)COLUMNS <= (int)DEA_TABLE_WANTED, "a row has room for every column");

static const char *const stretch_names[] = {"stretch ratio", "lambda", NULL};
static const char *const strain_names[] = {"nominal strain", "engineering strain", "tensile strain", "eng strain", NULL};
static const char *const displacement_names[] = {"extension", "elongation", "displ", "disp", "crosshead", "position", NULL};
static const char *const stress_names[] = {"nominal stress", "engineering stress", "tensile stress", "eng stress", NULL};
static const char *const force_names[] = {"load", NULL};
static const char *const mode_words[] = {"uniaxial", "equibiaxial", NULL};
static const char *const time_names[] = {"t", NULL};

static const dea_wanted wanted[COLUMNS] = {
    [STRETCH] = {.name = "stretch", .aliases = stretch_names, .unit = "1", .assumed = "1"},
    [STRAIN] = {.name = "strain", .aliases = strain_names, .unit = "1", .assumed = "1"},
    [DISPLACEMENT] = {.name = "displacement", .aliases = displacement_names, .unit = "m", .by_unit = true},
    [STRESS] = {.name = "stress", .aliases = stress_names, .unit = "Pa", .by_unit = true},
    [FORCE] = {.name = "force", .aliases = force_names, .unit = "N", .by_unit = true},
    [MODE] = {.name = "mode", .words = mode_words},
    [TIME] = {.name = "time", .aliases = time_names, .unit = "s", .by_unit = true},
};

/* A displacement within this share of the largest one is that of the hold, or that of the rest before the ramp. */
static const double held_share = 2e-3;

/* What reads one kind of table. */
typedef struct target {
    dea_load load; /* of points of a file without the column mode */
    dea_fit_data *data;
    dea_relaxation_data *relaxation;
} target;

static double stretch_of(const dea_table *t, const double values[], const dea_specimen *specimen)
{
    return t->seen[STRETCH]  ? values[STRETCH]
           : t->seen[STRAIN] ? 1.0 + values[STRAIN]
                             : 1.0 + values[DISPLACEMENT] / specimen->length;
}

static double stress_of(const dea_table *t, const double values[], const dea_specimen *specimen)
{
    return t->seen[STRESS] ? values[STRESS] : values[FORCE] / specimen->area;
}

/* What turns the table's columns into a stress. */
static dea_status stress_check(const dea_table *t, const dea_specimen *specimen)
{
    if (t->seen[STRESS] || (t->seen[FORCE] && specimen->area > 0.0)) {
        return DEA_OK;
    }
    return t->seen[FORCE]
               ? dea_table_fail(t, 1, "a stress from a force wants the area of the specimen at rest (--area \"22 mm^2\")")
               : dea_table_missing(t, STRESS, "name it with its unit, e.g. stress_kPa, or force_N with --area");
}

static dea_status stretch_check(const dea_table *t, const dea_specimen *specimen, dea_load load)
{
    if (!t->seen[STRETCH] && !t->seen[STRAIN] && !t->seen[DISPLACEMENT]) {
        return dea_table_missing(t, STRETCH,
                                 "name it stretch (length over length at rest), strain, or displacement_mm with --length");
    }
    if (!t->seen[STRETCH] && !t->seen[STRAIN] && !(specimen->length > 0.0)) {
        return dea_table_fail(t, 1,
                              "a stretch from a displacement wants the length of the specimen at rest (--length \"80 mm\")");
    }
    if (!t->seen[MODE] && load == DEA_LOAD_UNKNOWN) {
        return dea_table_fail(t, 1, "no column mode, and no load given for the file (--uniaxial or --equibiaxial)");
    }
    return stress_check(t, specimen);
}

static dea_status stretch_read(dea_table *t, const target *to)
{
    dea_fit_data *data = to->data;
    const size_t before = data->count;
    double values[DEA_TABLE_WANTED];
    bool more = true;
    dea_status status = stretch_check(t, &data->specimen, to->load);
    status = status ? status : dea_table_row(t, values, &more);
    while (status == DEA_OK && more) {
        const dea_fit_point point = {.stretch = stretch_of(t, values, &data->specimen),
                                     .stress = stress_of(t, values, &data->specimen),
                                     .load = t->seen[MODE] ? (dea_load)values[MODE] : to->load};
        if (!(point.stretch > 0.0)) {
            status = dea_table_fail_at(t,
                                       t->seen[STRETCH]  ? STRETCH
                                       : t->seen[STRAIN] ? STRAIN
                                                         : DISPLACEMENT,
                                       "a stretch is above 0 (1 is the film at rest, 1 + strain):");
            break;
        }
        status = dea_fit_add(data, point, t->error);
        status = status ? status : dea_table_row(t, values, &more);
    }
    if (status == DEA_OK && data->count == before) {
        status = dea_fail(t->error, DEA_ERROR_SCENE, "%.300s: no measured points", t->name);
    }
    if (status != DEA_OK) {
        data->count = before;
    }
    return status;
}

/* Adds a point; rows of equal time, as a rounded clock writes them, become their mean. *equal counts them. */
static dea_status relaxation_add(dea_relaxation_data *data, dea_relaxation_point point, size_t *equal, dea_error *error)
{
    if (data->count == 0 || point.time > data->points[data->count - 1].time) {
        *equal = 1;
        return dea_relaxation_add(data, point, error);
    }
    dea_relaxation_point *last = &data->points[data->count - 1];
    ++*equal;
    last->stress += (point.stress - last->stress) / (double)*equal;
    return DEA_OK;
}

/* Begin and end of the ramp by the displacement of the whole test, which a second pass then leaves out. */
typedef struct ramp {
    double begin, end; /* [s] */
} ramp;

static dea_status ramp_find(dea_table t, ramp *found)
{
    double values[DEA_TABLE_WANTED];
    double largest = 0.0;
    bool more = true;
    const dea_table again = t;
    dea_status status = dea_table_row(&t, values, &more);
    for (; status == DEA_OK && more; status = dea_table_row(&t, values, &more)) {
        largest = fmax(largest, fabs(values[DISPLACEMENT]));
    }
    *found = (ramp){NAN, NAN};
    t = again;
    more = status == DEA_OK;
    for (status = status ? status : dea_table_row(&t, values, &more); status == DEA_OK && more;
         status = dea_table_row(&t, values, &more)) {
        const double size = fabs(values[DISPLACEMENT]);
        found->begin = size <= held_share * largest || isnan(found->begin) ? values[TIME] : found->begin;
        if (size >= (1.0 - held_share) * largest) {
            found->end = values[TIME];
            break;
        }
    }
    return status;
}

/* The lowest stress with its place, and the largest one. */
typedef struct extremes {
    size_t line, column;
    double lowest, largest;
} extremes;

static dea_status relaxation_judge(dea_table *t, const dea_relaxation_data *data, const extremes *found)
{
    char problem[80];
    if (data->count < DEA_RELAXATION_LEAST) {
        snprintf(problem, sizeof problem, "%zu points; a relaxation test needs at least %d", data->count, DEA_RELAXATION_LEAST);
        return dea_table_fail(t, 1, problem);
    }
    if (dea_plausible_negative(found->lowest, found->largest)) {
        t->line = found->line;
        snprintf(problem, sizeof problem, "a stress is not negative, in compression too: %.6g Pa", found->lowest);
        return dea_table_fail(t, found->column, problem);
    }
    return DEA_OK;
}

static dea_status point_take(const dea_table *t, dea_relaxation_data *data, dea_relaxation_point point, size_t *equal)
{
    if (!(point.time >= 0.0)) {
        return dea_table_fail_at(t, TIME, "a time is not negative, it counts from the end of the ramp:");
    }
    if (data->count > 0 && !(point.time >= data->points[data->count - 1].time)) {
        return dea_table_fail_at(t, TIME, "time does not increase:");
    }
    return relaxation_add(data, point, equal, t->error);
}

static dea_status relaxation_rows(dea_table *t, dea_relaxation_data *data, double begin)
{
    extremes found = {.lowest = INFINITY};
    double values[DEA_TABLE_WANTED];
    size_t equal = 0;
    bool more = true;
    dea_status status = dea_table_row(t, values, &more);
    for (; status == DEA_OK && more; status = status ? status : dea_table_row(t, values, &more)) {
        const dea_relaxation_point point = {values[TIME] - begin, stress_of(t, values, &data->specimen)};
        if (t->seen[DISPLACEMENT] && values[TIME] < begin) {
            continue; /* of the ramp */
        }
        if (point.stress < found.lowest) {
            found.lowest = point.stress;
            found.line = t->line;
            found.column = dea_table_place(t, t->seen[STRESS] ? STRESS : FORCE);
        }
        found.largest = fmax(found.largest, point.stress);
        status = point_take(t, data, point, &equal);
    }
    return status == DEA_OK ? relaxation_judge(t, data, &found) : status;
}

static dea_status relaxation_read(dea_table *t, const target *to)
{
    dea_relaxation_data *data = to->relaxation;
    ramp found = {0.0, 0.0};
    dea_status status =
        t->seen[TIME] ? stress_check(t, &data->specimen) : dea_table_missing(t, TIME, "name it with its unit, e.g. time_s");
    if (status == DEA_OK && t->seen[DISPLACEMENT]) {
        status = ramp_find(*t, &found);
        data->ramp = status == DEA_OK && data->ramp == 0.0 ? found.end - found.begin : data->ramp;
    }
    status = status ? status : relaxation_rows(t, data, found.end);
    if (status != DEA_OK) {
        data->count = 0;
    }
    return status;
}

typedef dea_status table_reader(dea_table *table, const target *to);

static dea_status parse(const char *text, size_t length, const char *name, table_reader *read, const target *to,
                        char columns[DEA_SOURCE_LENGTH], dea_error *error)
{
    dea_units *units = dea_units_open();
    dea_table t = {.name = name, .wanted = wanted, .wanted_count = COLUMNS, .units = units, .error = error};
    dea_status status = units ? dea_table_begin(&t, text, length) : dea_fail(error, DEA_ERROR_MEMORY, "out of memory");
    status = status ? status : read(&t, to);
    snprintf(columns, DEA_SOURCE_LENGTH, "%.*s", DEA_SOURCE_LENGTH - 1, t.told);
    dea_table_end(&t);
    dea_units_close(units);
    return status;
}

static dea_status parse_file(const char *path, table_reader *read, const target *to, char columns[DEA_SOURCE_LENGTH],
                             dea_error *error)
{
    char *text = NULL;
    size_t length = 0;
    const char *why = NULL;
    dea_status status = dea_file_read(path, true, DEA_WAVE_FILE_MAX, &text, &length, NULL, &why);
    if (status != DEA_OK) {
        return dea_fail(error, status, "cannot read %.400s: %s", path, why);
    }
    status = parse(text, length, strcmp(path, "-") == 0 ? "standard input" : path, read, to, columns, error);
    free(text);
    return status;
}

dea_status dea_fit_parse(const char *text, size_t length, const char *name, dea_load load, dea_fit_data *data, dea_error *error)
{
    return parse(text, length, name, stretch_read, &(target){.load = load, .data = data}, data->columns, error);
}

dea_status dea_fit_read(const char *path, dea_load load, dea_fit_data *data, dea_error *error)
{
    return parse_file(path, stretch_read, &(target){.load = load, .data = data}, data->columns, error);
}

static dea_status one_test(const dea_relaxation_data *data, dea_error *error)
{
    return data->count > 0 ? dea_fail(error, DEA_ERROR_USAGE, "one relaxation test at a time") : DEA_OK;
}

dea_status dea_relaxation_parse(const char *text, size_t length, const char *name, dea_relaxation_data *data, dea_error *error)
{
    const dea_status status = one_test(data, error);
    return status ? status : parse(text, length, name, relaxation_read, &(target){.relaxation = data}, data->columns, error);
}

dea_status dea_relaxation_read(const char *path, dea_relaxation_data *data, dea_error *error)
{
    const dea_status status = one_test(data, error);
    return status ? status : parse_file(path, relaxation_read, &(target){.relaxation = data}, data->columns, error);
}
