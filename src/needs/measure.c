/* What an omission truly changes: the scene run with and without it, by the first engine of the table that runs in this process
 * and can do both. A judge must be finer than what it judges: every run is made at two accuracies, and their difference is the
 * judge's own error. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "deaspice/needs.h"
#include "film/point.h"
#include "needs/trial.h"
#include "network/dynamics.h"

static const double fine = 0.02;         /* of the smallest bound: accuracy that the judge is asked for */
static const double tightest = 1e-11;    /* at the most [1] */
static const double loosest_share = 0.1; /* of the scene's accuracy: no judge is worse */
static const double coarser = 10.0;      /* accuracy of the second run over that of the first */
static const double missed = 0.01;       /* share of the largest static voltage's answer below which a peak counts as that */

enum { FINE, COARSE, RUNS };

static const char *const by_none = "by no engine of this process";
static const char *const too_coarse = "the judge's own error is larger than the bound";
static const char *const without_mass = "a film without mass does not end where it swings";

typedef struct judge {
    dea_trial trial;
    dea_trial_run with[RUNS], without[RUNS]; /* owned */
    double accuracy;
    double omega; /* of the film at rest, its branches held [rad/s]; infinite without mass */
    double least; /* a peak of the displacement counts as this at least [m] */
} judge;

static bool fly(judge *j, const dea_reduction *reduction, dea_trial_run runs[RUNS])
{
    return dea_trial_fly(&j->trial, reduction, j->accuracy, &runs[FINE]) &&
           dea_trial_fly(&j->trial, reduction, coarser * j->accuracy, &runs[COARSE]);
}

/* Largest difference of a mean over a window that both runs cover [m]. */
static double means_apart(const judge *j, const dea_trial_run *one, const dea_trial_run *other)
{
    const dea_summary *a = dea_layout_summary(&j->trial.layout, one->samples), *b = dea_layout_summary(&j->trial.layout, other->samples);
    double apart = 0.0;
    for (size_t i = 0; i < j->trial.scene.transient.average_count; i++) {
        apart = fmax(apart, fabs(a->averages[i].displacement - b->averages[i].displacement));
    }
    return apart;
}

/* Largest difference of two runs from that age behind a corner of the voltage on: of displacement, its means and charge over their
 * peaks; of a ring, of the amplitude that its velocity tells, v/omega. */
static double difference(const judge *j, const dea_omission *omission, const dea_trial_run *one, const dea_trial_run *other)
{
    double u = 0.0, charge = 0.0, peak = j->least, charge_peak = 0.0;
    const bool ring = omission->part == DEA_PART_RING;
    const size_t end = one->end < other->end ? one->end : other->end;
    size_t near = 0;
    for (size_t i = 0; i < end; i++) {
        const dea_sample *a = &one->samples[i], *b = &other->samples[i];
        near = dea_signal_find(&j->trial.signal, near, a->time);
        peak = fmax(peak, fabs(a->displacement));
        charge_peak = fmax(charge_peak, fabs(a->charge));
        if (a->time - j->trial.signal.segments[near].from < omission->from) {
            continue;
        }
        u = fmax(u, ring ? fabs(a->velocity - b->velocity) / j->omega : fabs(a->displacement - b->displacement));
        charge = ring ? 0.0 : fmax(charge, fabs(a->charge - b->charge));
    }
    u = ring ? u : fmax(u, means_apart(j, one, other));
    return fmax(u > 0.0 ? u / peak : 0.0, charge > 0.0 ? charge / charge_peak : 0.0);
}

/* The displacement under the largest voltage of the run [m], 0 where there is none; behind a series resistance under the voltage
 * that goes with the largest charge of its samples. */
static double static_peak(const judge *j)
{
    dea_scene still = j->trial.scene;
    dea_point point;
    dea_row row = dea_row_failed();
    dea_film_prepare(&still, &point.film);
    dea_point_place(&still, &point);
    point.voltage = j->trial.signal.largest;
    double charge = dea_series_resistance(&still) > 0.0 ? 0.0 : (double)INFINITY;
    for (size_t i = 0; i < j->with[FINE].end; i++) {
        charge = fmax(charge, fabs(j->with[FINE].samples[i].charge));
    }
    point.voltage = fmin(point.voltage, charge / dea_point_capacitance(&point));
    dea_model_solve(j->trial.model, &point, 1e-6, &row);
    return isfinite(row.displacement) ? fabs(row.displacement) : 0.0;
}

/* Both runs at their end, or one of them alone: whatever the judge's error, where it knows the ends. */
static bool ends_alike(const dea_trial_run a[RUNS], const dea_trial_run b[RUNS])
{
    return a[FINE].end == b[FINE].end && a[COARSE].end == b[COARSE].end;
}

/* Two accuracies, and what the engine itself says of the finer. */
static double error_of(const judge *j, const dea_omission *omission, const dea_trial_run runs[RUNS])
{
    return runs[FINE].end == runs[COARSE].end ? fmax(difference(j, omission, &runs[FINE], &runs[COARSE]), runs[FINE].error)
                                              : (double)INFINITY;
}

static void decide(const dea_omission *omission, dea_measured *m)
{
    const double excess = m->change - omission->bound;
    if (m->error < omission->bound || m->error < excess) {
        m->verdict = excess > m->error ? DEA_BROKEN : DEA_HELD;
    } else {
        m->why = too_coarse;
    }
}

static dea_measured compare(const judge *j, const dea_omission *omission)
{
    dea_measured m = {.ended = (double)NAN, .verdict = DEA_NOT_JUDGED};
    m.change = difference(j, omission, &j->with[FINE], &j->without[FINE]);
    m.error = error_of(j, omission, j->with) + error_of(j, omission, j->without);
    if (!ends_alike(j->with, j->without) && isfinite(m.error)) {
        const size_t with = j->with[FINE].end, without = j->without[FINE].end;
        m.ended = j->with[FINE].samples[with < without ? with : without].time;
        m.change = (double)INFINITY;
        m.why = omission->part == DEA_PART_RING ? without_mass : NULL;
    }
    if (!m.why) {
        decide(omission, &m);
    }
    return m;
}

/* The next omission is measured on top of this one. */
static void exchange(judge *j)
{
    dea_trial_run before[RUNS];
    memcpy(before, j->with, sizeof before);
    memcpy(j->with, j->without, sizeof before);
    memcpy(j->without, before, sizeof before);
}

/* Each on top of those before it, as they were found; false where a run does not end well. */
static bool measure(judge *j, const dea_omission *omissions, const dea_omission *judged, size_t count, dea_measured *measured)
{
    bool sound = fly(j, &j->trial.scene.reduction, j->with);
    j->least = sound ? missed * static_peak(j) : 0.0;
    for (size_t i = 0; i < count && sound; i++) {
        dea_reduction reduction = dea_needs_reduction(judged, i + 1);
        reduction.ring = (double)INFINITY;
        sound = fly(j, &reduction, j->without);
        if (sound) {
            measured[i] = compare(j, &omissions[i]);
            exchange(j);
        }
    }
    return sound;
}

/* Measures as finely as the judge can: what fails at a tight accuracy may well pass at a looser one. */
static void measure_well(judge *j, const dea_omission *omissions, const dea_omission *judged, size_t count, double loosest,
                         dea_measured *measured)
{
    while (!measure(j, omissions, judged, count, measured) && j->accuracy * coarser <= loosest) {
        j->accuracy *= coarser;
    }
}

/* Omissions as the judge knows them: a ring that is left out behind its time is the mass. */
static void as_judged(const dea_omission *omissions, size_t count, dea_omission *judged)
{
    memcpy(judged, omissions, count * sizeof *omissions);
    for (size_t i = 0; i < count; i++) {
        judged[i].part = judged[i].part == DEA_PART_RING ? DEA_PART_MASS : judged[i].part;
    }
}

/* Of a film that is too damped to swing, too: what its mass does there goes faster still. */
static double omega_at_rest(const dea_scene *scene, const dea_model *model)
{
    dea_dynamics dynamics;
    dea_scene full = *scene;
    double omega = (double)INFINITY;
    full.reduction = (dea_reduction){0};
    if (dea_dynamics_open(&full, model, &dynamics, NULL) == DEA_OK && dynamics.mass > 0.0) {
        omega = sqrt(dea_dynamics_stiffness(&dynamics, 0.0, 0.0, false) / dynamics.mass);
    }
    dea_dynamics_close(&dynamics);
    return omega;
}

static bool make_room(judge *j)
{
    const size_t size = j->trial.layout.point_size;
    bool room = true;
    for (int i = 0; i < RUNS; i++) {
        j->with[i].samples = malloc(size);
        j->without[i].samples = malloc(size);
        room = room && j->with[i].samples && j->without[i].samples;
    }
    return room;
}

static void close_judge(judge *j)
{
    for (int i = 0; i < RUNS; i++) {
        free(j->with[i].samples);
        free(j->without[i].samples);
    }
    dea_trial_close(&j->trial);
}

dea_status dea_needs_measure(const dea_scene *scene, const dea_model *model, const dea_needs *needs, dea_measured *measured,
                             dea_error *error)
{
    dea_omission judged[DEA_OMISSIONS];
    double least = 1.0;
    for (size_t i = 0; i < needs->count; i++) {
        measured[i] = (dea_measured){.change = (double)NAN, .error = (double)NAN, .ended = (double)NAN, .why = by_none};
        least = fmin(least, needs->omissions[i].bound);
    }
    if (needs->count == 0) {
        return DEA_OK;
    }
    const double loosest = loosest_share * scene->accuracy;
    judge j = {.accuracy = fmin(fmax(tightest, fine * least), loosest), .omega = omega_at_rest(scene, model)};
    as_judged(needs->omissions, needs->count, judged);
    const dea_reduction all = dea_needs_reduction(judged, needs->count);
    dea_status status = dea_trial_open(scene, model, &all, loosest, &j.trial, error);
    if (status == DEA_OK && j.trial.engine) {
        status = make_room(&j) ? DEA_OK : dea_fail(error, DEA_ERROR_MEMORY, "out of memory while omissions are measured");
    }
    if (status == DEA_OK && j.trial.engine) {
        measure_well(&j, needs->omissions, judged, needs->count, loosest, measured);
    }
    close_judge(&j);
    return status;
}
