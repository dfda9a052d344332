/* Tables of stress over stretch, of stress or strain over time, and of moduli over frequency. */
#include "deaspice/fit.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "material/fit/plausible.h"
#include "material/fit/test.h"
#include "support/file.h"
#include "support/grow.h"
#include "support/table.h"

enum { STRETCH, STRAIN, DISPLACEMENT, STRESS, FORCE, MODE, TIME, COMPLIANCE, COLUMNS };
_Static_assert((int)COLUMNS <= (int)DEA_TABLE_WANTED, "a row has room for every column");

static const char *const stretch_names[] = {"stretch ratio", "lambda", NULL};
static const char *const strain_names[] = {"nominal strain", "engineering strain", "tensile strain", "eng strain", NULL};
static const char *const displacement_names[] = {"extension", "elongation", "displ", "disp", "crosshead", "position", NULL};
static const char *const stress_names[] = {"nominal stress", "engineering stress", "tensile stress", "eng stress", NULL};
static const char *const force_names[] = {"load", NULL};
static const char *const mode_words[] = {"uniaxial", "equibiaxial", NULL};
static const char *const time_names[] = {"t", NULL};
static const char *const compliance_names[] = {"creep compliance", "j", NULL};

static const dea_wanted wanted[COLUMNS] = {
    [STRETCH] = {.name = "stretch", .aliases = stretch_names, .unit = "1", .assumed = "1"},
    [STRAIN] = {.name = "strain", .aliases = strain_names, .unit = "1", .assumed = "1"},
    [DISPLACEMENT] = {.name = "displacement", .aliases = displacement_names, .unit = "m", .by_unit = true},
    [STRESS] = {.name = "stress", .aliases = stress_names, .unit = "Pa", .by_unit = true},
    [FORCE] = {.name = "force", .aliases = force_names, .unit = "N", .by_unit = true},
    [MODE] = {.name = "mode", .words = mode_words},
    [TIME] = {.name = "time", .aliases = time_names, .unit = "s", .by_unit = true},
    [COMPLIANCE] = {.name = "compliance", .aliases = compliance_names, .unit = "Pa-1", .by_unit = true},
};

/* Those of a dynamic test. A frequency in radians per second is an angular one, whatever its name. */
enum { FREQUENCY, OMEGA, STORAGE, LOSS, TANGENT, SWINGING };

static const char *const frequency_names[] = {"freq", "f", NULL};
static const char *const omega_names[] = {"frequency", "freq", "f", "ang frequency", "omega", "w", NULL};
static const char *const storage_names[] = {"storage", "elastic modulus", "eprime", "gprime", "e\xE2\x80\xB2", "g\xE2\x80\xB2", NULL};
static const char *const loss_names[] = {"loss", "viscous modulus", "eprimeprime", "gprimeprime", "e\xE2\x80\xB3", "g\xE2\x80\xB3", NULL};
static const char *const tangent_names[] = {"tan d", "tandelta", "tan", "loss factor", "damping factor", "loss tangent", NULL};

static const dea_wanted swinging[SWINGING] = {
    [FREQUENCY] = {.name = "frequency", .aliases = frequency_names, .unit = "Hz", .by_unit = true},
    [OMEGA] = {.name = "angular frequency", .aliases = omega_names, .unit = "rad/s", .by_unit = true},
    [STORAGE] = {.name = "storage modulus", .aliases = storage_names, .unit = "Pa"},
    [LOSS] = {.name = "loss modulus", .aliases = loss_names, .unit = "Pa"},
    [TANGENT] = {.name = "tan delta", .aliases = tangent_names, .unit = "1", .assumed = "1"},
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
    last->loss += (point.loss - last->loss) / (double)*equal;
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

static dea_status enough_check(const dea_table *t, const dea_relaxation_data *data)
{
    char problem[80];
    if (data->count < DEA_RELAXATION_LEAST) {
        snprintf(problem, sizeof problem, "%zu points; a %s needs at least %d", data->count, dea_test_of(data->kind)->name,
                 DEA_RELAXATION_LEAST);
        return dea_table_fail(t, 1, problem);
    }
    return DEA_OK;
}

static dea_status relaxation_judge(dea_table *t, const dea_relaxation_data *data, const extremes *found)
{
    const dea_test *test = dea_test_of(data->kind);
    char problem[80];
    const dea_status status = enough_check(t, data);
    if (status == DEA_OK && dea_plausible_negative(found->lowest, found->largest)) {
        t->line = found->line;
        snprintf(problem, sizeof problem, "%s: %.6g%s", test->negative, found->lowest, test->unit);
        return dea_table_fail(t, found->column, problem);
    }
    return status;
}

/* What a row of a test over time has measured, and in which column. */
static double held_of(const dea_table *t, const dea_relaxation_data *data, const double values[], size_t *column)
{
    if (data->kind == DEA_TEST_RELAXATION) {
        *column = t->seen[STRESS] ? STRESS : FORCE;
        return stress_of(t, values, &data->specimen);
    }
    *column = t->seen[STRAIN] ? STRAIN : t->seen[STRETCH] ? STRETCH : t->seen[DISPLACEMENT] ? DISPLACEMENT : COMPLIANCE;
    const double length = data->specimen.length > 0.0 ? data->specimen.length : 1.0; /* its unit does not matter to the branches */
    return *column == STRETCH ? values[STRETCH] - 1.0 : *column == DISPLACEMENT ? values[DISPLACEMENT] / length : values[*column];
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

/* @p ramped: rows before `begin` are of the ramp. */
static dea_status relaxation_rows(dea_table *t, dea_relaxation_data *data, bool ramped, double begin)
{
    extremes found = {.lowest = INFINITY};
    double values[DEA_TABLE_WANTED];
    size_t equal = 0;
    bool more = true;
    dea_status status = dea_table_row(t, values, &more);
    for (; status == DEA_OK && more; status = status ? status : dea_table_row(t, values, &more)) {
        size_t column;
        const dea_relaxation_point point = {.time = values[TIME] - begin, .stress = held_of(t, data, values, &column)};
        if (ramped && values[TIME] < begin) {
            continue;
        }
        if (point.stress < found.lowest) {
            found.lowest = point.stress;
            found.line = t->line;
            found.column = dea_table_place(t, column);
        }
        found.largest = fmax(found.largest, point.stress);
        status = point_take(t, data, point, &equal);
    }
    return status == DEA_OK ? relaxation_judge(t, data, &found) : status;
}

static dea_status strain_check(const dea_table *t)
{
    return t->seen[STRAIN] || t->seen[STRETCH] || t->seen[DISPLACEMENT] || t->seen[COMPLIANCE]
               ? DEA_OK
               : dea_table_missing(t, STRAIN, "name it strain, stretch, displacement_mm or compliance_1/MPa");
}

static dea_status relaxation_read(dea_table *t, const target *to)
{
    dea_relaxation_data *data = to->relaxation;
    ramp found = {0.0, 0.0};
    const bool ramped = data->kind == DEA_TEST_RELAXATION && t->seen[DISPLACEMENT];
    dea_status status = !t->seen[TIME] ? dea_table_missing(t, TIME, "name it with its unit, e.g. time_s")
                        : data->kind == DEA_TEST_CREEP ? strain_check(t)
                                                       : stress_check(t, &data->specimen);
    if (status == DEA_OK && ramped) {
        status = ramp_find(*t, &found);
        data->ramp = status == DEA_OK && data->ramp == 0.0 ? found.end - found.begin : data->ramp;
    }
    status = status ? status : relaxation_rows(t, data, ramped, found.end);
    if (status != DEA_OK) {
        data->count = 0;
    }
    return status;
}

static dea_status moduli_check(const dea_table *t)
{
    if (!t->seen[FREQUENCY] && !t->seen[OMEGA]) {
        return dea_table_missing(t, FREQUENCY, "name it with its unit, e.g. frequency_Hz or omega_rad/s");
    }
    if (!t->seen[STORAGE]) {
        return dea_table_missing(t, STORAGE, "name it with its unit, e.g. storage modulus (kPa)");
    }
    return t->seen[LOSS] || t->seen[TANGENT]
               ? DEA_OK
               : dea_table_missing(t, LOSS, "name it with its unit, e.g. loss modulus (kPa), or give tan delta");
}

static int by_time(const void *a, const void *b)
{
    const double x = ((const dea_relaxation_point *)a)->time, y = ((const dea_relaxation_point *)b)->time;
    return (x > y) - (x < y);
}

static dea_status moduli_rows(dea_table *t, dea_relaxation_point **points, size_t *count)
{
    double values[DEA_TABLE_WANTED];
    size_t room = 0;
    bool more = true;
    dea_status status = dea_table_row(t, values, &more);
    for (; status == DEA_OK && more; status = status ? status : dea_table_row(t, values, &more)) {
        const double omega = t->seen[FREQUENCY] ? 2.0 * DEA_PI * values[FREQUENCY] : values[OMEGA];
        if (!(omega > 0.0)) {
            return dea_table_fail_at(t, t->seen[FREQUENCY] ? FREQUENCY : OMEGA, "a frequency is above 0:");
        }
        dea_relaxation_point *grown = dea_grow(*points, *count, &room, sizeof *grown);
        if (!grown) {
            return dea_fail(t->error, DEA_ERROR_MEMORY, "out of memory");
        }
        *points = grown;
        grown[(*count)++] = (dea_relaxation_point){
            .time = omega, .stress = values[STORAGE], .loss = t->seen[LOSS] ? values[LOSS] : values[STORAGE] * values[TANGENT]};
    }
    return status;
}

/* Frequencies may come in any order; rows of one become their mean. */
static dea_status moduli_read(dea_table *t, const target *to)
{
    dea_relaxation_data *data = to->relaxation;
    dea_relaxation_point *points = NULL;
    size_t count = 0, equal = 0;
    dea_status status = moduli_check(t);
    status = status ? status : moduli_rows(t, &points, &count);
    if (status == DEA_OK && count > 0) {
        qsort(points, count, sizeof *points, by_time);
    }
    for (size_t i = 0; i < count && status == DEA_OK; i++) {
        status = relaxation_add(data, points[i], &equal, t->error);
    }
    free(points);
    status = status ? status : enough_check(t, data);
    if (status != DEA_OK) {
        data->count = 0;
    }
    return status;
}

typedef dea_status table_reader(dea_table *table, const target *to);

static table_reader *reader_of(const dea_relaxation_data *data)
{
    return data->kind == DEA_TEST_DYNAMIC ? moduli_read : relaxation_read;
}

static dea_status parse(const char *text, size_t length, const char *name, table_reader *read, const target *to,
                        char columns[DEA_SOURCE_LENGTH], dea_error *error)
{
    dea_units *units = dea_units_open();
    const bool swings = read == moduli_read;
    dea_table t = {.name = name,
                   .wanted = swings ? swinging : wanted,
                   .wanted_count = swings ? SWINGING : COLUMNS,
                   .units = units,
                   .error = error};
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
    return data->count > 0 ? dea_fail(error, DEA_ERROR_USAGE, "one test at a time") : DEA_OK;
}

dea_status dea_relaxation_parse(const char *text, size_t length, const char *name, dea_relaxation_data *data, dea_error *error)
{
    const dea_status status = one_test(data, error);
    return status ? status : parse(text, length, name, reader_of(data), &(target){.relaxation = data}, data->columns, error);
}

dea_status dea_relaxation_read(const char *path, dea_relaxation_data *data, dea_error *error)
{
    const dea_status status = one_test(data, error);
    return status ? status : parse_file(path, reader_of(data), &(target){.relaxation = data}, data->columns, error);
}
