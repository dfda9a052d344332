#include "stability.h"

#include "../bench/bench.h"

#include <math.h>
#include <stddef.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

dea_scene stability_scene(const char *text)
{
    dea_scene scene;
    dea_error error = {0};
    if (dea_scene_parse(text, strlen(text), "stability", ".", NULL, 0, NULL, &scene, &error) != DEA_OK) {
        bench_give_up("%s", error.message);
    }
    return scene;
}

/* What follows from the factors: fields grow with the root of stress over permittivity. */
static double field_factor(const stability_units *u)
{
    return sqrt(u->stress / u->permittivity);
}

static double voltage_factor(const stability_units *u)
{
    return u->thickness * field_factor(u);
}

static double capacitance_factor(const stability_units *u)
{
    return u->permittivity * u->length * u->length / u->thickness;
}

/* A mass is a force over an acceleration: rho H r^2 = (C H r)/(r/T^2). */
static double density_factor(const stability_units *u)
{
    return u->stress * u->time * u->time / (u->length * u->length);
}

static double factor_of(const stability_units *u, const char *unit)
{
    const double displacement = u->length / voltage_factor(u);
    const double charge = capacitance_factor(u) * voltage_factor(u), force = u->stress * u->thickness * u->length;
    const struct {
        const char *unit;
        double factor;
    } list[] = {{"1", 1.0},
                {"degree", 1.0},
                {"m", u->length},
                {"N", force},
                {"J", force * u->length},
                {"Pa", u->stress},
                {"V/m", field_factor(u)},
                {"V", voltage_factor(u)},
                {"s", u->time},
                {"Hz", 1.0 / u->time},
                {"m/s", u->length / u->time},
                {"C", charge},
                {"F", capacitance_factor(u)},
                {"A", charge / u->time},
                {"m/V", displacement},
                {"Ohm", u->time / capacitance_factor(u)}};
    for (size_t i = 0; i < sizeof list / sizeof list[0]; i++) {
        if (strcmp(list[i].unit, unit) == 0) {
            return list[i].factor;
        }
    }
    bench_give_up("no factor for the unit %s", unit);
}

static void scale_material(dea_material *material, const stability_units *u)
{
    for (size_t i = 0; i < DEA_LAW_CONSTANTS; i++) {
        material->constants[i] *= material->law->constants[i % material->law->constant_count].modulus ? u->stress : 1.0;
    }
    material->modulus *= u->stress;
    material->permittivity *= u->permittivity;
    material->permittivity_per_stretch *= u->permittivity;
    material->density *= density_factor(u);
    material->retardation *= u->time;
    material->breakdown *= field_factor(u);
    for (size_t i = 0; i < material->prony_count; i++) {
        material->prony[i].tau *= u->time;
    }
}

static void scale_wave(dea_waveform *wave, const stability_units *u)
{
    const double volt = voltage_factor(u);
    wave->step.on *= u->time;
    wave->step.off *= u->time;
    wave->step.rise *= u->time;
    wave->step.voltage *= volt;
    wave->sine.offset *= volt;
    wave->sine.amplitude *= volt;
    wave->sine.frequency /= u->time;
    wave->sine.delay *= u->time;
    wave->period *= u->time;
    for (size_t i = 0; i < wave->point_count; i++) {
        wave->times[i] *= u->time;
        wave->voltages[i] *= volt;
    }
}

void stability_scale(dea_scene *scene, const stability_units *u)
{
    dea_actuator *actuator = &scene->actuator;
    actuator->frame_radius *= u->length;
    actuator->divide_radius *= u->length;
    actuator->focal_length *= u->length;
    actuator->film_thickness *= u->thickness;
    actuator->electrode_mass *= density_factor(u) * u->thickness;
    scale_material(&scene->material, u);
    scene->drive.voltage *= voltage_factor(u);
    scene->drive.series_resistance *= factor_of(u, "Ohm");
    scene->drive.leakage_resistance *= factor_of(u, "Ohm");
    scale_wave(&scene->drive.waveform, u);
    scene->transient.until *= u->time;
    scene->transient.every *= u->time;
    scene->transient.grid /= u->time;
    scene->ac.from /= u->time;
    scene->ac.to /= u->time;
    scene->ac.bias *= voltage_factor(u);
    for (size_t i = 0; i < scene->axis_count; i++) {
        for (size_t k = 0; k < scene->axes[i].count; k++) {
            scene->axes[i].values[k] *= factor_of(u, scene->axes[i].unit);
        }
    }
}

static dea_status take(void *user, size_t first, const void *points, size_t count, dea_error *error)
{
    stability_answer *answer = user;
    const size_t size = dea_layout_of(answer->scene).point_size;
    (void)error;
    memcpy(answer->points + first * size, points, count * size);
    return DEA_OK;
}

static void keep_log(void *user, const char *line)
{
    stability_answer *answer = user;
    snprintf(answer->log, sizeof answer->log, "%s", line);
}

stability_answer stability_run(const dea_scene *scene, const char *engine)
{
    dea_error error = {0};
    stability_answer answer = {.scene = scene};
    answer.points = calloc(dea_scene_point_count(scene), dea_layout_of(scene).point_size);
    const dea_run_options options = {.jobs = 1, .points = take, .log = keep_log, .user = &answer};
    if (!answer.points || dea_study_run(scene, dea_engine_find(engine), &options, &error) != DEA_OK) {
        bench_give_up("%s: %s", engine, error.message);
    }
    return answer;
}

dea_summary stability_summary(const stability_answer *answer)
{
    const dea_layout layout = dea_layout_of(answer->scene);
    return *dea_layout_summary(&layout, answer->points);
}

static double value_at(const stability_answer *answer, const dea_layout *layout, size_t point, size_t row, size_t column)
{
    double value;
    memcpy(&value, answer->points + point * layout->point_size + row * layout->row_size + layout->columns[column].offset,
           sizeof value);
    return value;
}

/* Of one column over its peak: of a transient or a response over that of its point, of a sweep over each value. */
static double column_difference(const stability_answer *a, const stability_answer *b, size_t point, size_t column, double factor)
{
    const dea_layout layout = dea_layout_of(a->scene);
    const bool turns = strcmp(layout.columns[column].unit, "degree") == 0;
    double worst = 0.0;
    double peak = turns ? 180.0 : 0.0;
    for (size_t i = 0; i < layout.rows; i++) {
        const double x = value_at(a, &layout, point, i, column);
        const double y = value_at(b, &layout, point, i, column) / factor;
        const double apart = turns ? fabs(remainder(x - y, 360.0)) : fabs(x - y);
        if (isnan(x) && isnan(y)) {
            continue;
        }
        worst = fmax(worst, isnan(apart) ? (double)INFINITY : apart);
        peak = fmax(peak, fabs(x));
    }
    return worst > 0.0 ? worst / peak : 0.0;
}

static bool same_states(const stability_answer *a, const stability_answer *b, size_t point)
{
    const dea_layout layout = dea_layout_of(a->scene);
    bool same = true;
    for (size_t i = 0; i < layout.rows; i++) {
        const size_t place = point * layout.point_size + i * layout.row_size;
        same = same && dea_layout_state(&layout, a->points + place) == dea_layout_state(&layout, b->points + place);
    }
    return same;
}

double stability_difference(const stability_answer *a, const stability_answer *b, const stability_units *units)
{
    const dea_layout layout = dea_layout_of(a->scene);
    double worst = 0.0;
    for (size_t point = 0; point < dea_scene_point_count(a->scene); point++) {
        if (!same_states(a, b, point)) {
            return (double)INFINITY;
        }
        for (size_t k = 0; k < layout.column_count; k++) {
            worst = fmax(worst, column_difference(a, b, point, k, factor_of(units, layout.columns[k].unit)));
        }
    }
    return worst;
}
