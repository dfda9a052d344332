/* Transients of a membrane: runs at tighter tolerances on finer meshes, until two of them show that the answer is good enough. */
#include <math.h>
#include <stddef.h>
#include <stdlib.h>
#include <string.h>

#include "drive/signal.h"
#include "engine/ida/rings_solver.h"
#include "engine/rings_gap.h"
#include "network/rings_mesh.h"
#include "support/lapack.h"

enum { MOST_RUNS = 6 };

static const double first_tolerance = 0.05; /* of the accuracy */
/* Of cheap runs ahead: first tolerance and nodes, and the difference above which one that does not fall is no matter of the tolerance. */
static const double rough_tolerance = 1e-4, rough_nodes = 7.0, rough_gap = 5e-3;
static const double thin_front = 64.0; /* width of a front of charge over the spacing of the nodes next to the rim */
static const double first_share = 0.2;      /* from one tolerance to the next */
static const double gains_nothing = 0.5;    /* a difference that falls by less than that stays too large */
static const double least_tolerance = 3e-12; /* what rounding of the stiffest nodes leaves */
static const double drift = 30.0; /* errors of BDF add up over a swing to so many times the tolerance, which two runs may share */
static const double least_told = 0.1; /* of the accuracy */
static const double certain = 1e-7; /* an end of the motion counts from this tolerance on */

/* A study of one scene. */
typedef struct search {
    const dea_sundials *sun;
    const dea_scene *scene;
    const dea_model *model;
    const dea_signal *signal;
    dea_scales scales;
    dea_rings_trace traces[2]; /* owned samples and entries: of the run before, and of the last */
    dea_rings_solver *solver;  /* owned: of the last */
    dea_layout layout;
    size_t rows, entries; /* of the layout; numbers that a row tells over the radius */
    double unseen; /* as membranes have it */
    double loosest;
    double shared; /* error that the last two runs may have alike, of the displacement [1] */
    double worst; /* error that the last run is left with, of the column that is worst against what it promises [1] */
} search;

/* One run on a mesh of its own, which takes the place of the last. */
static dea_status run_on(search *s, dea_rings_mesh mesh, double tolerance, dea_summary *summary, dea_error *error)
{
    const dea_rings_trace before = s->traces[1];
    s->traces[1] = s->traces[0];
    s->traces[0] = before;
    dea_rings_solver_close(s->solver);
    const dea_status status = dea_rings_solver_open(s->sun, s->scene, s->model, s->signal, mesh, s->solver, error);
    if (status != DEA_OK) {
        return status;
    }
    s->solver->loosest = s->loosest;
    s->solver->flight.membrane.unseen = s->unseen;
    dea_rings_solver_run(s->solver, tolerance, &s->traces[1], summary);
    if (dea_rings_solver_fit(s->solver)) {
        dea_rings_solver_run(s->solver, tolerance, &s->traces[1], summary);
    }
    return DEA_OK;
}

/* Three cheap runs of a film that no damper smooths tell whether its error falls with the mesh at all: *@p hopeless where the waves
 * behind fast edges are too steep for any. */
static dea_status look_ahead(search *s, dea_summary *summary, bool *hopeless, dea_error *error)
{
    double nodes = rough_nodes, tolerance = s->loosest = rough_tolerance, last = INFINITY;
    *hopeless = false;
    if (!(first_tolerance * s->scene->accuracy < 0.1 * rough_tolerance) || !dea_rings_stays_rough(s->scene, s->model)) {
        return DEA_OK; /* the runs themselves are as cheap, or converge */
    }
    dea_status status = run_on(s, dea_rings_mesh_of(s->scene, nodes), tolerance, NULL, error);
    for (int i = 0; i < 2 && status == DEA_OK; i++) {
        nodes = dea_rings_more_nodes(&s->solver->flight.membrane, &s->solver->flight.motion.rest, nodes);
        tolerance *= first_share;
        status = run_on(s, dea_rings_mesh_of(s->scene, nodes), tolerance, NULL, error);
        const dea_rings_gap apart = dea_rings_gap_of(s->scene, &s->scales, &s->traces[0], &s->traces[1]);
        const bool comparable = s->traces[0].count == s->traces[1].count;
        *hopeless = status == DEA_OK && comparable && apart.answer > rough_gap && !(apart.answer < gains_nothing * last);
        s->worst = summary->error = apart.answer;
        last = apart.answer;
    }
    *hopeless = *hopeless && s->traces[1].end == DEA_STATE_OK;
    return status;
}

/* Least time between a kink of the voltage and the next sample or window. A sample at the kink itself, or so close that nothing has moved,
 * sees the film from before; the current between samples and runs of lines see all. */
static double unseen_of(const search *s, const dea_dynamics *film, double blink)
{
    double least = INFINITY;
    size_t row = 0;
    for (size_t i = 0; i < s->signal->count; i++) {
        const dea_segment *segment = &s->signal->segments[i];
        while (row < s->rows && dea_layout_place(s->scene, row) <= segment->from + blink) {
            row++;
        }
        least = segment->lines ? 0.0 : row < s->rows ? fmin(least, dea_layout_place(s->scene, row) - segment->from) : least;
        for (size_t k = 0; k < s->scene->transient.average_count; k++) {
            const dea_window *window = &s->scene->transient.averages[k];
            least = segment->from < window->to ? fmin(least, fmax(0.0, window->from - segment->from)) : least;
        }
    }
    return dea_peak_is_known(s->scene, film, s->signal) ? 0.0 : least;
}

/* Nodes of the first run, from what a few tell of the film at rest. */
static double foresee_nodes(search *s)
{
    const double accuracy = s->scene->accuracy, blink = 1e-6;
    dea_membrane m;
    dea_membrane_rest rest;
    if (dea_membrane_open(s->scene, s->model, dea_rings_mesh_of(s->scene, rough_nodes), &m, NULL) != DEA_OK || !dea_membrane_at_rest(&m, &rest)) {
        return dea_rings_first_nodes(accuracy);
    }
    m.unseen = s->unseen = m.heavy ? unseen_of(s, &m.film, blink / rest.slowest) : 0.0;
    return dea_rings_foreseen_nodes(&m, &rest, accuracy);
}

/* Leaves the better run of the last two in traces[1]; *good false where the accuracy was not reached. */
static dea_status refine(search *s, dea_summary *summary, dea_rate_errors *rates, bool *good, dea_error *error)
{
    const double accuracy = s->scene->accuracy;
    bool steep;
    dea_status status = look_ahead(s, summary, &steep, error);
    *good = false;
    if (status != DEA_OK || steep) {
        return status;
    }
    double tolerance = s->loosest = first_tolerance * accuracy, nodes = foresee_nodes(s), last = INFINITY;
    dea_rings_mesh mesh = dea_rings_mesh_of(s->scene, nodes);
    status = run_on(s, mesh, tolerance, NULL, error);
    for (int i = 0; i < MOST_RUNS && status == DEA_OK && s->traces[1].end != DEA_STATE_FAILED; i++) {
        if (!dea_rings_finer_mesh(s->scene, &s->solver->flight.membrane, &s->solver->flight.motion.rest, &nodes, &mesh)) {
            return status;
        }
        tolerance = fmax(first_share * tolerance, least_tolerance);
        *summary = dea_summary_failed();
        status = run_on(s, mesh, tolerance, summary, error);
        if (status != DEA_OK) {
            return status;
        }
        const dea_rings_gap apart = dea_rings_gap_of(s->scene, &s->scales, &s->traces[0], &s->traces[1]);
        const double trust = dea_rings_mesh_trust(&s->solver->flight.membrane, &s->solver->flight.motion.rest, nodes);
        const bool doubtful = s->traces[1].end == DEA_STATE_PULL_IN && tolerance > certain;
        const bool comparable = s->traces[0].count == s->traces[1].count;
        s->shared = fmax(drift * tolerance, least_told * accuracy);
        summary->error = fmax(apart.displacement * trust, s->shared);
        *rates = (dea_rate_errors){apart.rates.velocity * trust, apart.rates.current * trust};
        s->worst = fmax(apart.answer * trust, drift * tolerance);
        *good = s->worst <= accuracy && comparable && !doubtful;
        const bool fronts = s->solver->flight.membrane.sheet.front * nodes * nodes < thin_front; /* they converge late, and then fast */
        const bool hopeless = comparable && !(apart.answer < gains_nothing * last) && !fronts;
        if (*good || s->traces[1].end == DEA_STATE_FAILED || hopeless) {
            return status;
        }
        last = comparable ? apart.answer : INFINITY;
    }
    return status;
}

/* Rows of a trace; where it ended, all that follow are refused. */
static void fill(const search *s, const dea_rings_trace *trace, bool good, dea_sample *samples)
{
    const size_t count = good ? trace->count : 0;
    for (size_t i = 0; i < s->rows; i++) {
        double *entries = s->entries > 0 ? dea_layout_entry(&s->layout, samples, i, 0) : NULL;
        for (size_t k = 0; k < s->entries; k++) {
            entries[k] = i < count ? trace->entries[i * s->entries + k] : (double)NAN;
        }
    }
    memcpy(samples, trace->samples, count * sizeof *samples);
    dea_samples_refuse(s->scene, s->signal, count, good ? trace->end : DEA_STATE_FAILED, samples);
}

static void tell_averages(const search *s, const dea_rings_trace *trace, dea_summary *summary)
{
    for (size_t i = 0; i < s->scene->transient.average_count; i++) {
        const double u = dea_rings_mean(s->scene, trace, i);
        summary->averages[i] = (dea_average){u / s->solver->flight.membrane.film.radius, u};
    }
}

static void explain(const search *s, const dea_summary *summary, dea_error *error)
{
    const dea_rings_flight *f = &s->solver->flight;
    if (f->why.message[0] != '\0') {
        dea_fail(error, DEA_ERROR_ENGINE, "%s", f->why.message);
    } else {
        dea_fail(error, DEA_ERROR_ENGINE,
                 "%zu nodes and %ld steps of SUNDIALS at a tolerance of %.1g leave an error of %.1g, the scene wants %g: waves of a "
                 "film without much damping get steep; a rise of the voltage and a damper (material.retardation) smooth them%s",
                 f->membrane.nodes, f->steps, f->tolerance, fmax(s->worst, summary->error), s->scene->accuracy,
                 f->membrane.sheet.places > 0 ? "; charge lies close to the rim of so resistive an electrode "
                                                "(electrode.sheet_resistance), the closer the denser the samples" : "");
    }
}

static dea_status fly(search *s, dea_sample *samples, dea_summary *summary, dea_error *error)
{
    dea_rate_errors rates = {0.0, 0.0};
    bool good;
    if (s->scene->electrode.sheet_resistance > 0.0 && !(s->scene->drive.series_resistance > 0.0) && dea_peak_jumps(s->scene, s->signal)) {
        dea_fail(error, DEA_ERROR_ENGINE, "behind a jump of the voltage nothing bounds the current into the rim of the electrode "
                                          "(electrode.sheet_resistance): give the waveform a rise, or the drive a series_resistance");
        fill(s, &s->traces[1], false, samples);
        return DEA_OK;
    }
    const dea_status status = refine(s, summary, &rates, &good, error);
    if (status != DEA_OK) {
        return status;
    }
    if (!good) {
        explain(s, summary, error);
    }
    fill(s, &s->traces[1], good, samples);
    tell_averages(s, &s->traces[1], summary);
    dea_scales_tell(&s->scales, s->traces[1].samples, s->traces[1].count, rates,
                    dea_scales_allowance(offsetof(dea_sample, velocity)) * s->shared, summary);
    if (s->solver->flight.peaks && s->traces[1].end == DEA_STATE_OK) {
        dea_peak_tell(&s->traces[0].peak, &s->traces[1].peak, s->scene->accuracy, summary);
    }
    return DEA_OK;
}

static dea_status search_open(search *s, dea_error *error)
{
    s->layout = dea_layout_of(s->scene);
    s->rows = s->layout.rows;
    s->entries = s->layout.spread_points * s->layout.spread_count;
    s->scales = dea_scales_open(s->scene, s->model);
    s->solver = calloc(1, sizeof *s->solver);
    bool room = s->solver && s->scales.status != DEA_ERROR_MEMORY;
    for (int i = 0; i < 2; i++) {
        s->traces[i].samples = malloc(s->rows * sizeof *s->traces[i].samples);
        s->traces[i].entries = s->entries > 0 ? malloc(s->rows * s->entries * sizeof *s->traces[i].entries) : NULL;
        room = room && s->traces[i].samples && (s->traces[i].entries || s->entries == 0);
    }
    return room ? DEA_OK : dea_fail(error, DEA_ERROR_MEMORY, "out of memory for %zu samples", s->rows);
}

static void search_close(search *s)
{
    if (s->solver) {
        dea_rings_solver_close(s->solver);
    }
    free(s->solver);
    for (int i = 0; i < 2; i++) {
        free(s->traces[i].samples);
        free(s->traces[i].entries);
    }
}

/* Draws lines with small corners together, but where the current C U' of a film at its source has its peaks at them. */
static dea_status soften(const dea_scene *scene, const dea_model *model, dea_signal *signal, dea_error *error)
{
    dea_dynamics film;
    const dea_status status = dea_dynamics_settle(scene, model, &film, error);
    const bool cornered = dea_peak_is_known(scene, &film, signal) && !(scene->drive.series_resistance > 0.0);
    return status != DEA_OK || cornered ? status : dea_signal_soften(signal, scene->accuracy, 0.0, error);
}

dea_status dea_rings_transient_solve(const dea_sundials *sun, const dea_scene *scene, const dea_model *model, dea_sample *samples,
                                     dea_summary *summary, dea_error *error)
{
    dea_signal signal;
    *summary = dea_summary_failed();
    dea_status status = dea_lapack_load(error);
    if (status != DEA_OK) {
        return status;
    }
    status = dea_signal_open(scene, &signal, error);
    if (status == DEA_OK) {
        status = soften(scene, model, &signal, error);
    }
    search s = {.sun = sun, .scene = scene, .model = model, .signal = &signal};
    if (status == DEA_OK) {
        status = search_open(&s, error);
        if (status == DEA_OK) {
            status = fly(&s, samples, summary, error);
        }
        search_close(&s);
    }
    dea_signal_close(&signal);
    return status;
}
