/* Tables of stress over stretch and of stress over time. */
#include "deaspice/fit.h"

#include <math.h>
#include <string.h>

#include "material/fit_plausible.h"
#include "material/fit_table.h"

enum stretch_role { ROLE_STRETCH, ROLE_STRESS, ROLE_MODE };
enum relaxation_role { ROLE_TIME, ROLE_HELD_STRESS };

static const dea_column stretch_columns[] = {
    {"stretch", ROLE_STRETCH, 1.0},   {"stress_Pa", ROLE_STRESS, 1.0}, {"stress_kPa", ROLE_STRESS, 1e3},
    {"stress_MPa", ROLE_STRESS, 1e6}, {"mode", ROLE_MODE, 1.0},
};

static const dea_column relaxation_columns[] = {
    {"time_s", ROLE_TIME, 1.0},           {"time_ms", ROLE_TIME, 1e-3},          {"time_min", ROLE_TIME, 60.0},
    {"stress_Pa", ROLE_HELD_STRESS, 1.0}, {"stress_kPa", ROLE_HELD_STRESS, 1e3}, {"stress_MPa", ROLE_HELD_STRESS, 1e6},
};

/* Where points of stress over stretch go. */
typedef struct stretch_target {
    dea_load load;
    dea_fit_data *data;
} stretch_target;

static dea_status stretch_header(dea_table *t, dea_load load)
{
    const dea_status status = dea_table_header(t);
    if (status != DEA_OK) {
        return status;
    }
    if (!t->seen[ROLE_STRETCH] || !t->seen[ROLE_STRESS]) {
        return dea_table_fail(t, 1, t->seen[ROLE_STRETCH] ? "no column stress_Pa, stress_kPa or stress_MPa" : "no column stretch",
                              NULL);
    }
    if (!t->seen[ROLE_MODE] && load == DEA_LOAD_UNKNOWN) {
        return dea_table_fail(t, 1, "no column mode, and no load given for the file (uniaxial or equibiaxial)", NULL);
    }
    return DEA_OK;
}

static dea_status stretch_point(const dea_table *t, dea_fit_point *point)
{
    for (size_t i = 0; i < t->count; i++) {
        const dea_field *f = &t->fields[i];
        const int role = f->holds->role;
        if (role == ROLE_MODE) {
            point->load = dea_load_find(f->text);
            if (point->load == DEA_LOAD_UNKNOWN) {
                return dea_table_fail(t, f->column, "unknown mode (accepted: uniaxial, equibiaxial):", f->text);
            }
            continue;
        }
        const dea_status status = dea_table_number(t, f, role == ROLE_STRETCH ? &point->stretch : &point->stress);
        if (status != DEA_OK) {
            return status;
        }
        if (role == ROLE_STRETCH && !(point->stretch > 0.0)) {
            return dea_table_fail(t, f->column, "a stretch is above 0 (1 is the film at rest, 1 + strain):", f->text);
        }
    }
    return DEA_OK;
}

static dea_status stretch_read(dea_table *t, const stretch_target *target)
{
    dea_fit_data *data = target->data;
    const size_t before = data->count;
    dea_status status = stretch_header(t, target->load);
    while (status == DEA_OK) {
        status = dea_table_row(t);
        if (status != DEA_OK || t->count == 0) {
            break;
        }
        dea_fit_point point = {.load = target->load};
        status = stretch_point(t, &point);
        if (status == DEA_OK) {
            status = dea_fit_add(data, point, t->error);
        }
    }
    if (status == DEA_OK && data->count == before) {
        status = dea_table_fail(t, 1, "no measured points below the header", NULL);
    }
    if (status != DEA_OK) {
        data->count = before;
    }
    return status;
}

static dea_status stretch_parse(const char *text, size_t length, const char *name, void *user, dea_error *error)
{
    dea_table t = {.columns = stretch_columns,
                   .column_count = sizeof stretch_columns / sizeof *stretch_columns,
                   .accepted = "stretch, stress_Pa, stress_kPa, stress_MPa, mode",
                   .advice = "stretch = 1 + displacement/length, stress = force/area of the specimen at rest"};
    dea_status status = dea_table_begin(&t, text, length, name, error);
    if (status == DEA_OK) {
        status = stretch_read(&t, user);
    }
    dea_table_end(&t);
    return status;
}

dea_status dea_fit_parse(const char *text, size_t length, const char *name, dea_load load, dea_fit_data *data, dea_error *error)
{
    stretch_target target = {load, data};
    return stretch_parse(text, length, name, &target, error);
}

dea_status dea_fit_read(const char *path, dea_load load, dea_fit_data *data, dea_error *error)
{
    stretch_target target = {load, data};
    return dea_table_open(path, stretch_parse, &target, error);
}

static dea_status relaxation_point(const dea_table *t, const dea_relaxation_data *data, dea_relaxation_point *point)
{
    for (size_t i = 0; i < t->count; i++) {
        const dea_field *f = &t->fields[i];
        const bool time = f->holds->role == ROLE_TIME;
        const dea_status status = dea_table_number(t, f, time ? &point->time : &point->stress);
        if (status != DEA_OK) {
            return status;
        }
        if (time && !(point->time >= 0.0)) {
            return dea_table_fail(t, f->column, "a time is not negative, it counts from the end of the ramp:", f->text);
        }
        if (time && data->count > 0 && !(point->time >= data->points[data->count - 1].time)) {
            return dea_table_fail(t, f->column, "time does not increase:", f->text);
        }
    }
    return DEA_OK;
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

/* The lowest stress with its place, and the largest one. */
typedef struct extremes {
    size_t line, column;
    double lowest, largest;
} extremes;

static void extremes_take(extremes *found, const dea_table *t, double stress)
{
    if (stress < found->lowest) {
        found->lowest = stress;
        found->line = t->line;
        found->column = t->fields[t->fields[0].holds->role == ROLE_HELD_STRESS ? 0 : 1].column;
    }
    found->largest = fmax(found->largest, stress);
}

static dea_status relaxation_judge(dea_table *t, const dea_relaxation_data *data, const extremes *found)
{
    char problem[80];
    if (data->count < DEA_RELAXATION_LEAST) {
        snprintf(problem, sizeof problem, "%zu points; a relaxation test needs at least %d", data->count, DEA_RELAXATION_LEAST);
        return dea_table_fail(t, 1, problem, NULL);
    }
    if (dea_plausible_negative(found->lowest, found->largest)) {
        t->line = found->line;
        snprintf(problem, sizeof problem, "a stress is not negative, in compression too: %.6g Pa", found->lowest);
        return dea_table_fail(t, found->column, problem, NULL);
    }
    return DEA_OK;
}

static dea_status relaxation_read(dea_table *t, dea_relaxation_data *data)
{
    extremes found = {.lowest = INFINITY};
    size_t equal = 0;
    dea_status status = dea_table_header(t);
    if (status == DEA_OK && (!t->seen[ROLE_TIME] || !t->seen[ROLE_HELD_STRESS])) {
        status = dea_table_fail(
            t, 1, t->seen[ROLE_TIME] ? "no column stress_Pa, stress_kPa or stress_MPa" : "no column time_s, time_ms or time_min",
            NULL);
    }
    while (status == DEA_OK) {
        status = dea_table_row(t);
        if (status != DEA_OK || t->count == 0) {
            break;
        }
        dea_relaxation_point point = {0};
        status = relaxation_point(t, data, &point);
        if (status == DEA_OK) {
            extremes_take(&found, t, point.stress);
            status = relaxation_add(data, point, &equal, t->error);
        }
    }
    return status == DEA_OK ? relaxation_judge(t, data, &found) : status;
}

static dea_status relaxation_parse(const char *text, size_t length, const char *name, void *user, dea_error *error)
{
    dea_relaxation_data *data = user;
    dea_table t = {.columns = relaxation_columns,
                   .column_count = sizeof relaxation_columns / sizeof *relaxation_columns,
                   .accepted = "time_s, time_ms, time_min, stress_Pa, stress_kPa, stress_MPa",
                   .advice = "time counts from the end of the ramp, stress = force/area of the specimen"};
    if (data->count > 0) {
        return dea_fail(error, DEA_ERROR_USAGE, "one relaxation test at a time");
    }
    dea_status status = dea_table_begin(&t, text, length, name, error);
    if (status == DEA_OK) {
        status = relaxation_read(&t, data);
    }
    if (status != DEA_OK) {
        data->count = 0;
    }
    dea_table_end(&t);
    return status;
}

dea_status dea_relaxation_parse(const char *text, size_t length, const char *name, dea_relaxation_data *data, dea_error *error)
{
    return relaxation_parse(text, length, name, data, error);
}

dea_status dea_relaxation_read(const char *path, dea_relaxation_data *data, dea_error *error)
{
    return dea_table_open(path, relaxation_parse, data, error);
}
