/* Transients of a membrane: on coarse steps the mesh is made finer until two runs agree, then the steps, as those of a film of one
 * node are (transient.c): two runs with h and h/2 extrapolate to the fourth order, and the two last of these tell the error. */
#include <math.h>
#include <stddef.h>
#include <stdlib.h>
#include <string.h>

#include "engine/ngspice/moving.h"
#include "engine/ngspice/rings_track.h"
#include "engine/rings_gap.h"
#include "network/rings_mesh.h"
#include "support/lapack.h"

/* Most that the error of two runs, and of what they extrapolate to, is taken for, over differences (transient.c); the latter where
 * those of a film with mass, whose steps are even, fall by about 4, as the order of the rule has it, up to 8: masses that fit the steps
 * leave little of the second order, and what extrapolates has an error of 1/7 of the difference then. */
static const double of_second = 2.0, of_fourth = 2.5, of_order = 0.25;
static const double steepest = 8.0, flattest = 3.0;

/* Shares of the accuracy that are the mesh's, of the finer of two that are compared and of the coarser one, whose error is their gap;
 * and a difference that falls by less than that stays too large. */
static const double mesh_share = 0.3, coarse_share = 0.5;
static const double gains_nothing = 0.5;

/* Steps of the first runs over those of the pieces, at an accuracy of 1e-4 or more: as long as the swing allows, whose slowest mode the
 * masses fit. */
static const double first_fineness = 2.0;

/* Most time that a run may take, roughly, and what one time step of a node does of it [s]. */
static const double most_time = 30.0;
static const double node_time = 4e-5;

enum { MOST_MESHES = 6, MOST_LEVELS = 10 };

/* One run and what it adds up. */
typedef struct level {
    dea_rings_trace trace; /* owned samples */
    dea_summary summary;
} level;

typedef struct search {
    dea_ngspice *library;
    const dea_scene *scene;
    const dea_model *model;
    const dea_signal *signal;
    dea_scales scales;
    size_t rows;
    dea_rings_track *track; /* owned */
    level levels[4];        /* rooms of all below */
    level *coarse, *fine;   /* the last two runs */
    level *answer, *before; /* extrapolated from the last two, and from the two before */
    double mesh_error;      /* of all columns [1] */
    double mesh_displacement;
    dea_rate_errors mesh_rates;
    double apart; /* of the last two runs, of all columns [1] */
    bool ordered; /* falls as the order of the rule has it */
    double error; /* of the steps, likewise */
    double displacement;
    dea_rate_errors rates;
    double spent; /* [s], roughly */
} search;

static void swap(level **a, level **b)
{
    level *last = *a;
    *a = *b;
    *b = last;
}

static dea_status open_mesh(search *s, double nodes, dea_error *error)
{
    dea_rings_track_close(s->track);
    return dea_rings_track_open(s->library, s->scene, s->model, s->signal, dea_rings_mesh_of(s->scene, nodes), s->track, error);
}

static double time_of(const search *s, double fineness)
{
    const double nodes = (double)s->track->flight.motion.nodes;
    return node_time * nodes * s->track->pieces.points / fineness;
}

/* Refuses a run that would take too long. */
static dea_status afford(const search *s, double fineness, dea_error *error)
{
    const double time = s->spent + time_of(s, fineness);
    if (time <= most_time) {
        return DEA_OK;
    }
    return dea_fail(error, DEA_ERROR_ENGINE,
                    "%.2g time steps of %zu nodes would take ngspice some %.0f s, at most %.0f s are spent on a run%s; take --engine ida, a "
                    "looser accuracy, a shorter run or a damper (material.retardation)",
                    s->track->pieces.points / fineness, s->track->flight.motion.nodes, time, most_time,
                    isfinite(s->error) ? ", and coarser ones leave too large an error" : "");
}

static dea_status run(search *s, double fineness, level *l, dea_error *error)
{
    const dea_status status = afford(s, fineness, error);
    s->spent += time_of(s, fineness);
    return status == DEA_OK ? dea_rings_track_run(s->track, fineness, &l->trace, &l->summary, error) : status;
}

/* ---- meshes */

static bool comparable(const dea_rings_trace *a, const dea_rings_trace *b)
{
    return a->count == b->count && a->end == b->end;
}

/* The error of a mesh from the gap between two. */
static void set_mesh_error(search *s, const dea_rings_gap *gap, double trust)
{
    s->mesh_error = trust * gap->answer;
    s->mesh_displacement = trust * gap->displacement;
    s->mesh_rates = (dea_rate_errors){trust * gap->rates.velocity, trust * gap->rates.current};
}

/* The first mesh, as coarse as it may be; a film without mass takes a finer one, which costs little there and tells where it folds. */
static dea_status open_first(search *s, double *nodes, dea_error *error)
{
    const double accuracy = sqrt(s->scene->accuracy);
    *nodes = dea_rings_first_nodes(sqrt(accuracy));
    const dea_status status = open_mesh(s, *nodes, error);
    if (status != DEA_OK || s->track->flight.membrane.heavy) {
        return status;
    }
    *nodes = dea_rings_first_nodes(accuracy);
    return open_mesh(s, *nodes, error);
}

/* Runs with coarse steps on finer meshes; the last is the one to refine, its run s->fine. */
static dea_status choose_mesh(search *s, double fineness, dea_error *error)
{
    double nodes, last = INFINITY;
    dea_status status = open_first(s, &nodes, error);
    if (status == DEA_OK) {
        status = run(s, fineness, s->fine, error);
    }
    for (int i = 0; i < MOST_MESHES && status == DEA_OK; i++) {
        const double before = nodes;
        dea_rings_mesh mesh = dea_rings_mesh_of(s->scene, nodes);
        if (!dea_rings_finer_mesh(s->scene, &s->track->flight.membrane, &s->track->flight.motion.rest, &nodes, &mesh)) {
            return DEA_OK;
        }
        status = open_mesh(s, nodes, error);
        swap(&s->coarse, &s->fine);
        if (status == DEA_OK) {
            status = run(s, fineness, s->fine, error);
        }
        if (status != DEA_OK) {
            return status;
        }
        const dea_rings_gap gap = dea_rings_gap_of(s->scene, &s->scales, &s->coarse->trace, &s->fine->trace);
        const double trust = dea_rings_mesh_trust(&s->track->flight.membrane, &s->track->flight.motion.rest, nodes);
        const bool alike = comparable(&s->coarse->trace, &s->fine->trace);
        const double coarse = 1.0 + trust;
        const bool whole = alike && s->fine->trace.end == DEA_STATE_OK; /* where a film ends, its mesh decides */
        if (whole && coarse * gap.answer <= coarse_share * s->scene->accuracy) {
            set_mesh_error(s, &gap, coarse);
            swap(&s->coarse, &s->fine);
            return open_mesh(s, before, error);
        }
        set_mesh_error(s, &gap, trust);
        s->mesh_error = alike ? s->mesh_error : (double)INFINITY;
        if (s->mesh_error <= mesh_share * s->scene->accuracy || !(s->mesh_error < gains_nothing * last)) {
            return DEA_OK;
        }
        last = s->mesh_error;
    }
    return status;
}

/* ---- steps */

/* y + (y - coarse)/3. */
static double better(double coarse, double fine)
{
    return fine + (fine - coarse) / 3.0;
}

/* What two answers extrapolate to: behind a corner the library's steps grow to their full length, which leaves a term of third
 * order; of one of fourth order it leaves as much as stood there. */
static double best(double before, double answer)
{
    return answer + (answer - before) / 7.0;
}

/* Energy that the balance leaves open [J]. */
static double open_of(const dea_summary *s)
{
    return s->work - (s->electric + s->elastic + s->kinetic + s->dissipated);
}

static void better_summary(const dea_summary *coarse, const dea_summary *fine, dea_summary *answer)
{
    *answer = *fine;
    answer->work = better(coarse->work, fine->work);
    answer->electric = better(coarse->electric, fine->electric);
    answer->elastic = better(coarse->elastic, fine->elastic);
    answer->kinetic = better(coarse->kinetic, fine->kinetic);
    answer->dissipated = better(coarse->dissipated, fine->dissipated);
    const double left = open_of(fine);
    answer->residual = left != 0.0 ? fine->residual * fabs(open_of(answer) / left) : fine->residual;
}

/* What the last two runs extrapolate to; states are those of the finer one. */
static void extrapolate(search *s)
{
    const dea_rings_trace *a = &s->coarse->trace, *b = &s->fine->trace;
    dea_rings_trace *out = &s->answer->trace;
    dea_sample *samples = out->samples;
    *out = *b;
    out->samples = samples;
    for (size_t i = 0; i < b->count; i++) {
        samples[i] = b->samples[i];
        for (size_t c = 0; i < a->count && dea_rings_column(c); c++) {
            double *value = dea_rings_at(&samples[i], *dea_rings_column(c));
            *value = better(*dea_rings_at(&a->samples[i], *dea_rings_column(c)), *value);
        }
        samples[i].strain = better(i < a->count ? a->samples[i].strain : samples[i].strain, samples[i].strain);
    }
    for (size_t i = 0; i < DEA_WINDOWS; i++) {
        out->integrals[i] = better(a->integrals[i], b->integrals[i]);
    }
    out->peak.current = better(a->peak.current, b->peak.current);
    better_summary(&s->coarse->summary, &s->fine->summary, &s->answer->summary);
}

/* Error of the answer from the last runs, number @p runs of their steps. */
static void judge(search *s, int runs)
{
    const dea_rings_gap second = dea_rings_gap_of(s->scene, &s->scales, &s->coarse->trace, &s->fine->trace);
    const double falls = s->apart / second.answer;
    s->ordered = runs > 2 && falls > flattest && falls < steepest && s->track->flight.membrane.heavy;
    const double share = s->ordered ? of_order : of_fourth;
    s->apart = second.answer;
    s->error = of_second * second.answer;
    s->displacement = of_second * second.displacement;
    s->rates = (dea_rate_errors){of_second * second.rates.velocity, of_second * second.rates.current};
    if (runs > 2) {
        const dea_rings_gap fourth = dea_rings_gap_of(s->scene, &s->scales, &s->before->trace, &s->answer->trace);
        s->error = fmin(s->error, share * fourth.answer);
        s->displacement = fmin(s->displacement, share * fourth.displacement);
        s->rates.velocity = fmin(s->rates.velocity, of_fourth * fourth.rates.velocity);
        s->rates.current = fmin(s->rates.current, of_fourth * fourth.rates.current);
    }
    if (!comparable(&s->coarse->trace, &s->fine->trace)) {
        s->error = s->displacement = INFINITY;
    }
}

static dea_status refine(search *s, bool *good, dea_error *error)
{
    const double accuracy = s->scene->accuracy;
    double fineness = first_fineness * fmin(1.0, pow(accuracy / 1e-4, 0.4));
    *good = false;
    s->error = INFINITY;
    s->apart = 0.0;
    dea_status status = choose_mesh(s, fineness, error);
    for (int runs = 2; status == DEA_OK && runs <= MOST_LEVELS && s->mesh_error <= accuracy; runs++) {
        swap(&s->coarse, &s->fine);
        fineness *= 0.5;
        status = run(s, fineness, s->fine, error);
        if (status != DEA_OK) {
            return status;
        }
        swap(&s->answer, &s->before);
        extrapolate(s);
        judge(s, runs);
        const bool closed = s->fine->trace.end != DEA_STATE_OK || s->answer->summary.residual <= 10.0 * accuracy;
        *good = s->error + s->mesh_error <= accuracy && closed && s->fine->trace.end != DEA_STATE_FAILED;
        if (*good) {
            return DEA_OK;
        }
    }
    return status;
}

/* ---- rows */

/* The last answer, from the two before where their errors have an order. */
static void polish(search *s)
{
    dea_rings_trace *trace = &s->answer->trace;
    for (size_t i = 0; i < trace->count && i < s->before->trace.count && s->ordered; i++) {
        dea_sample *to = &trace->samples[i], *from = &s->before->trace.samples[i];
        for (size_t c = 0; dea_rings_column(c); c++) {
            double *value = dea_rings_at(to, *dea_rings_column(c));
            *value = best(*dea_rings_at(from, *dea_rings_column(c)), *value);
        }
        to->strain = best(from->strain, to->strain);
    }
}

static void fill(const search *s, bool good, dea_sample *samples)
{
    const dea_rings_trace *trace = &s->answer->trace;
    const size_t count = good ? trace->count : 0;
    memcpy(samples, trace->samples, count * sizeof *samples);
    dea_samples_refuse(s->scene, s->signal, count, good ? trace->end : DEA_STATE_FAILED, samples);
}

static void tell(const search *s, const dea_sample *samples, dea_summary *summary)
{
    const dea_rings_trace *trace = &s->answer->trace;
    *summary = s->answer->summary;
    summary->error = s->displacement + s->mesh_displacement;
    for (size_t i = 0; i < s->scene->transient.average_count; i++) {
        const double u = dea_rings_mean(s->scene, trace, i);
        summary->averages[i] = (dea_average){u / s->track->flight.membrane.film.radius, u};
    }
    const dea_rate_errors rates = {s->rates.velocity + s->mesh_rates.velocity, s->rates.current + s->mesh_rates.current};
    dea_scales_tell(&s->scales, samples, trace->count, rates, 0.0, summary);
    const double gap = fabs(s->fine->trace.peak.current - s->coarse->trace.peak.current);
    if (s->track->flight.peaks && trace->end == DEA_STATE_OK && gap <= 10.0 * s->scene->accuracy * trace->peak.current) {
        summary->peak_current = trace->peak.current;
        summary->peak_time = trace->peak.time;
    }
}

static void explain(const search *s, dea_error *error)
{
    const dea_rings_flight *f = &s->track->flight;
    if (f->why.message[0] != '\0') {
        dea_fail(error, DEA_ERROR_ENGINE, "%s", f->why.message);
    } else {
        dea_fail(error, DEA_ERROR_ENGINE,
                 "%zu nodes leave an error of %.1g, the steps of ngspice one of %.1g, the scene wants %g: waves of a film without much "
                 "damping get steep; a rise of the voltage and a damper (material.retardation) smooth them",
                 f->membrane.nodes, s->mesh_error, s->error, s->scene->accuracy);
    }
}

static dea_status search_open(search *s, dea_error *error)
{
    bool room = s->scales.status != DEA_ERROR_MEMORY;
    s->track = calloc(1, sizeof *s->track);
    for (int i = 0; i < 4; i++) {
        s->levels[i].trace.samples = malloc(s->rows * sizeof *s->levels[i].trace.samples);
        room = room && s->levels[i].trace.samples;
    }
    s->coarse = &s->levels[0];
    s->fine = &s->levels[1];
    s->answer = &s->levels[2];
    s->before = &s->levels[3];
    return room && s->track ? DEA_OK : dea_fail(error, DEA_ERROR_MEMORY, "out of memory for %zu samples", s->rows);
}

static void search_close(search *s)
{
    if (s->track) {
        dea_rings_track_close(s->track);
    }
    free(s->track);
    for (int i = 0; i < 4; i++) {
        free(s->levels[i].trace.samples);
    }
}

/* The film's own time: of its first mode, of its damper, or else that of the run [s]. */
static double own_time(const dea_membrane *m, const dea_membrane_rest *rest, const dea_scene *scene)
{
    return m->heavy ? 1.0 / rest->slowest : m->film.retardation > 0.0 ? m->film.retardation : scene->transient.until;
}

dea_status dea_ngspice_units_rings(const dea_scene *scene, const dea_model *model, dea_units *units, dea_error *error)
{
    dea_signal signal = {0};
    dea_membrane_rest rest;
    dea_membrane *m = malloc(sizeof *m);
    dea_status status = m ? dea_lapack_load(error) : dea_fail(error, DEA_ERROR_MEMORY, "out of memory for a membrane");
    if (status == DEA_OK) {
        status = dea_membrane_open(scene, model, dea_rings_mesh_of(scene, dea_rings_first_nodes(0.01)), m, error);
    }
    if (status == DEA_OK) {
        status = dea_signal_open(scene, &signal, error);
    }
    if (status == DEA_OK && !dea_membrane_at_rest(m, &rest)) {
        status = dea_fail(error, DEA_ERROR_ENGINE, "the film is not stable at rest");
    }
    if (status == DEA_OK) {
        const double square = signal.largest * signal.largest, r = m->film.radius;
        const double longest = fmin(r, m->film.point.frame_radius - r);
        const dea_sizes sizes = {.displacement = fmin(longest, rest.compliance * square),
                                 .voltage = signal.largest,
                                 .time = own_time(m, &rest, scene)};
        *units = dea_units_of_rings(m, &rest, &sizes);
    }
    dea_signal_close(&signal);
    free(m);
    return status;
}

dea_status dea_ngspice_transient_rings(dea_ngspice *library, const dea_scene *scene, const dea_model *model, dea_sample *samples,
                                       dea_summary *summary, dea_error *error)
{
    dea_signal signal;
    bool good = false;
    dea_status status = dea_lapack_load(error);
    if (status != DEA_OK) {
        return status;
    }
    status = dea_signal_open(scene, &signal, error);
    search s = {.library = library, .scene = scene, .model = model, .signal = &signal, .rows = dea_layout_of(scene).rows};
    s.scales = dea_scales_open(scene, model);
    if (status == DEA_OK) {
        status = search_open(&s, error);
    }
    if (status == DEA_OK) {
        status = refine(&s, &good, error);
    }
    if (status == DEA_OK) {
        if (!good) {
            explain(&s, error);
        }
        polish(&s);
        fill(&s, good, samples);
        tell(&s, samples, summary);
    }
    search_close(&s);
    dea_signal_close(&signal);
    return status;
}
