/* What an omission truly changes: the scene run with and without it, by the first engine of the table that runs in this process
 * and can do both. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "deaspice/needs.h"
#include "drive/signal.h"
#include "model/models.h"

static const double tightest = 1e-12;    /* accuracy that the judge is asked for at the most [1] */
static const double tight_enough = 1e-3; /* of the scene's accuracy: the smallest bounds are judged no better */
static const double loose_enough = 0.1;  /* of the scene's accuracy: no judge is worse */
static const double looser = 10.0;       /* from one try to the next */
static const double missed = 0.01;       /* share of the largest static voltage's answer below which a peak counts as that */

typedef struct judge {
    const dea_engine *engine;
    const dea_model *model;
    void *session;
    dea_scene scene; /* borrows; its accuracy is what the judge promises */
    dea_layout layout;
    dea_sample *with, *without; /* owned: samples and summary of a run */
    dea_signal signal;          /* owned */
} judge;

/* The first engine, at an accuracy that it promises, no tighter than wanted. */
static bool appoint(judge *j, const dea_omission *omissions, size_t count)
{
    dea_scene reduced = j->scene;
    const double wanted = j->scene.accuracy;
    reduced.reduction = dea_needs_reduction(omissions, count);
    for (size_t i = 0; i < dea_engine_count(); i++) {
        const dea_engine *engine = dea_engine_at(i);
        if (engine->isolated || !engine->transient) {
            continue;
        }
        for (double accuracy = wanted; accuracy < 1e-3; accuracy *= 10.0) {
            reduced.accuracy = accuracy;
            j->engine = engine;
            j->scene.accuracy = accuracy;
            if (!dea_engine_refuses(engine, &j->scene, j->model) && !dea_engine_refuses(engine, &reduced, j->model)) {
                return true;
            }
        }
    }
    return false;
}

static bool run(judge *j, const dea_reduction *reduction, dea_sample *samples)
{
    dea_error error = {0};
    j->scene.reduction = *reduction;
    const dea_status status =
        j->engine->transient(j->session, &j->scene, j->model, samples, dea_layout_summary(&j->layout, samples), &error);
    for (size_t i = 0; status == DEA_OK && i < j->layout.rows; i++) {
        if (samples[i].state == DEA_STATE_FAILED) {
            return false;
        }
    }
    return status == DEA_OK;
}

static double distance(double a, double b)
{
    return isnan(a) && isnan(b) ? 0.0 : isnan(a) || isnan(b) ? (double)INFINITY : fabs(a - b);
}

/* Largest difference of displacement and charge over their peaks, from that age behind a corner of the voltage on. */
static double difference(const judge *j, double least, double from)
{
    double u = 0.0, charge = 0.0, peak = least, charge_peak = 0.0;
    size_t near = 0;
    for (size_t i = 0; i < j->layout.rows; i++) {
        const dea_sample *a = &j->with[i], *b = &j->without[i];
        near = dea_signal_find(&j->signal, near, a->time);
        peak = fmax(peak, fabs(a->displacement));
        charge_peak = fmax(charge_peak, fabs(a->charge));
        if (a->time - j->signal.segments[near].from >= from) {
            u = fmax(u, distance(a->displacement, b->displacement));
            charge = fmax(charge, distance(a->charge, b->charge));
        }
    }
    return fmax(u > 0.0 ? u / peak : 0.0, charge > 0.0 && charge_peak > 0.0 ? charge / charge_peak : 0.0);
}

/* The displacement under the largest voltage of the run [m], 0 where there is none; behind a series resistance under the voltage
 * that goes with the largest charge of its samples. */
static double static_peak(const judge *j)
{
    dea_scene still = j->scene;
    dea_point point;
    dea_row row = dea_row_failed();
    dea_film_prepare(&still, &point.film);
    dea_point_place(&still, &point);
    point.voltage = j->signal.largest;
    double charge = still.drive.series_resistance > 0.0 ? 0.0 : (double)INFINITY;
    for (size_t i = 0; i < j->layout.rows; i++) {
        charge = fmax(charge, fabs(j->with[i].charge));
    }
    point.voltage = fmin(point.voltage, charge / dea_point_capacitance(&point));
    j->model->solve(&point, 1e-6, &row);
    return isfinite(row.displacement) ? fabs(row.displacement) : 0.0;
}

/* Each on top of those before it, as they were found; false where a run does not end well. */
static bool measure(judge *j, const dea_omission *omissions, const dea_omission *judged, size_t count, double *changes)
{
    const dea_reduction nothing = {.ring = (double)INFINITY};
    bool sound = run(j, &nothing, j->with);
    const double least = missed * static_peak(j);
    for (size_t i = 0; i < count && sound; i++) {
        const dea_reduction reduction = dea_needs_reduction(judged, i + 1);
        sound = run(j, &reduction, j->without);
        if (sound) {
            changes[i] = difference(j, least, omissions[i].from);
        }
        dea_sample *before = j->with;
        j->with = j->without;
        j->without = before;
    }
    return sound;
}

/* Measures as finely as the judge can: what fails at a tight accuracy may well pass at a looser one. */
static void measure_well(judge *j, const dea_omission *omissions, const dea_omission *judged, size_t count, double loosest,
                         double *changes)
{
    while (!measure(j, omissions, judged, count, changes) && j->scene.accuracy * looser <= loosest) {
        j->scene.accuracy *= looser;
    }
}

/* Omissions as the judge knows them: behind its time, a ring that is left out is the mass. */
static void as_judged(const dea_omission *omissions, size_t count, dea_omission *judged)
{
    memcpy(judged, omissions, count * sizeof *omissions);
    for (size_t i = 0; i < count; i++) {
        judged[i].part = judged[i].part == DEA_PART_RING ? DEA_PART_MASS : judged[i].part;
    }
}

static dea_status measure_by(judge *j, const dea_omission *omissions, const dea_omission *judged, size_t count, double loosest,
                             double *changes, dea_error *error)
{
    j->layout = dea_layout_of(&j->scene);
    j->with = malloc(j->layout.point_size);
    j->without = malloc(j->layout.point_size);
    if (!j->with || !j->without) {
        return dea_fail(error, DEA_ERROR_MEMORY, "out of memory while omissions are measured");
    }
    dea_status status = dea_signal_open(&j->scene, &j->signal, error);
    if (status == DEA_OK) {
        status = j->engine->begin(&j->session, error);
    }
    if (status == DEA_OK) {
        measure_well(j, omissions, judged, count, loosest, changes);
        j->engine->end(j->session);
    }
    return status;
}

dea_status dea_needs_measure(const dea_scene *scene, const dea_model *model, const dea_needs *needs, double *changes,
                             double *noise, dea_error *error)
{
    dea_omission judged[DEA_OMISSIONS];
    double least = 1.0;
    for (size_t i = 0; i < needs->count; i++) {
        changes[i] = (double)NAN;
        least = fmin(least, needs->omissions[i].bound);
    }
    judge j = {.model = model, .scene = *scene};
    j.scene.accuracy = fmax(tightest, fmax(0.05 * least, tight_enough * scene->accuracy));
    j.scene.reduction = (dea_reduction){0};
    as_judged(needs->omissions, needs->count, judged);
    if (needs->count == 0 || !appoint(&j, judged, needs->count)) {
        return DEA_OK;
    }
    const dea_status status =
        measure_by(&j, needs->omissions, judged, needs->count, loose_enough * scene->accuracy, changes, error);
    *noise = 2.0 * j.scene.accuracy;
    dea_signal_close(&j.signal);
    free(j.with);
    free(j.without);
    return status;
}
