/* Runs with ever finer steps until their answers agree. The error of the trapezoidal rule is even in the step: two runs, h and
 * h/2, give an answer of fourth order, (4 y(h/2) - y(h))/3, and the two last of these the error bar. The balance of energies must
 * close too. */
#include <math.h>
#include <stdlib.h>

#include "engine/ngspice/moving.h"
#include "engine/ngspice/track.h"

/* Most time steps of the finest run, and most runs. */
static const double most_points = 4e6;
enum { MOST_LEVELS = 14 };

typedef struct levels {
    dea_track coarse, fine; /* the last two runs */
    dea_track before;       /* extrapolated from the two before: points only */
    size_t runs;
    double error; /* of the answer */
} levels;

/* y + (y - coarse)/3. */
static double better(double coarse, double fine)
{
    return fine + (fine - coarse) / 3.0;
}

static dea_track_point better_point(const dea_track_point *coarse, const dea_track_point *fine)
{
    return (dea_track_point){better(coarse->u, fine->u), better(coarse->v, fine->v), better(coarse->charge, fine->charge)};
}

static size_t common(const levels *l)
{
    return l->coarse.reached < l->fine.reached ? l->coarse.reached : l->fine.reached;
}

/* Largest difference of displacement and charge, each over its peak. */
typedef struct gap {
    double u, charge, u_peak, charge_peak;
} gap;

static void widen(gap *g, const dea_track_point *a, const dea_track_point *b)
{
    g->u = fmax(g->u, fabs(a->u - b->u));
    g->charge = fmax(g->charge, fabs(a->charge - b->charge));
    g->u_peak = fmax(g->u_peak, fabs(b->u));
    g->charge_peak = fmax(g->charge_peak, fabs(b->charge));
}

static double largest(const gap *g)
{
    const double u = g->u > 0.0 ? g->u / g->u_peak : 0.0;
    const double charge = g->charge > 0.0 ? g->charge / g->charge_peak : 0.0;
    return fmax(u, charge);
}

/* Two runs: twice their difference; the error of the finer one is 1/3 of it in theory. Three: 2.5 times the difference of what
 * they extrapolate to; the error of the later one is 1/15 of it in theory, and more where steps follow the age of an edge. The
 * factors bound the errors of random scenes. */
static void judge(levels *l)
{
    gap second = {0};
    gap fourth = {0};
    const size_t count = common(l);
    for (size_t i = 0; i < count; i++) {
        const dea_track_point answer = better_point(&l->coarse.points[i], &l->fine.points[i]);
        widen(&second, &l->coarse.points[i], &l->fine.points[i]);
        if (l->runs > 2) {
            widen(&fourth, &l->before.points[i], &answer);
        }
        if (l->runs > 1) {
            l->before.points[i] = answer;
        }
    }
    l->error = 2.0 * largest(&second);
    if (l->runs > 2) {
        l->error = fmin(l->error, 2.5 * largest(&fourth));
    }
    if (l->coarse.reached != l->fine.reached || l->coarse.end != l->fine.end) {
        l->error = INFINITY;
    }
}

static dea_mobility_state better_state(const dea_mobility_state *coarse, const dea_mobility_state *fine, size_t branches)
{
    dea_mobility_state state = {
        better(coarse->u, fine->u), better(coarse->v, fine->v), better(coarse->charge, fine->charge), {0}};
    for (size_t i = 0; i < branches; i++) {
        state.z[i] = better(coarse->z[i], fine->z[i]);
    }
    return state;
}

/* Energies at the end from both runs, as the states are. */
static void fill_summary(const dea_route *route, const levels *l, dea_summary *summary)
{
    dea_dynamics *d = route->dynamics;
    const bool whole = l->fine.end == DEA_STATE_OK;
    const dea_track *other = whole ? &l->coarse : &l->fine; /* runs that end early do not end at one time */
    const dea_audit *coarse = &other->audit;
    const dea_audit *fine = &l->fine.audit;
    const dea_audit audit = {better(coarse->work, fine->work), better(coarse->dissipated, fine->dissipated),
                             better(coarse->branch, fine->branch), fine->largest};
    const dea_mobility_state stop = better_state(&other->stop, &l->fine.stop, d->branch_count);
    dea_moment last = l->fine.last;
    last.u = stop.u;
    last.v = stop.v;
    last.voltage = dea_route_voltage(route, last.source, stop.u, stop.charge);
    dea_audit_close(&audit, d, &l->fine.first, l->fine.start.z, &last, stop.z, summary);
    summary->error = l->error;
    summary->resonance =
        d->mass > 0.0 ? sqrt(dea_dynamics_stiffness(d, 0.0, 0.0, false) / d->mass) / (2.0 * DEA_PI) : (double)NAN;
}

/* From measured errors: three runs from there on mostly do. */
static double first_fineness(const dea_scene *scene)
{
    return fmin(1.0, pow(scene->accuracy / 1e-5, 0.3));
}

static dea_status refine(const dea_route *route, levels *l, dea_summary *summary, dea_error *error)
{
    const double wanted = route->scene->accuracy;
    double fineness = first_fineness(route->scene);
    l->before.points = malloc(route->samples * sizeof *l->before.points);
    if (!l->before.points) {
        return dea_fail(error, DEA_ERROR_MEMORY, "out of memory for the samples of a run");
    }
    for (l->runs = 1; l->runs <= MOST_LEVELS && route->pieces->points / fineness <= most_points; l->runs++) {
        free(l->coarse.points);
        l->coarse = l->fine;
        l->fine = (dea_track){0};
        const dea_status status = dea_track_run(route, fineness, &l->fine, error);
        if (status != DEA_OK) {
            return status;
        }
        if (l->runs > 1) {
            judge(l);
            fill_summary(route, l, summary);
            if (l->error <= wanted && (l->fine.end != DEA_STATE_OK || summary->residual <= 10.0 * wanted)) {
                return DEA_OK;
            }
        }
        fineness *= 0.5;
    }
    if (l->runs < 3) {
        return dea_fail(error, DEA_ERROR_ENGINE, "the run needs more than %g time steps of ngspice", most_points);
    }
    return dea_fail(error, DEA_ERROR_ENGINE, "%g time steps of ngspice leave an error of %.1g, the scene wants %g", most_points,
                    l->error, wanted);
}

/* The moment of a sample. */
static dea_moment moment_at(const dea_route *route, size_t index, size_t *segment, const dea_track_point *point)
{
    const double time = dea_layout_place(route->scene, index);
    *segment = dea_signal_find(route->signal, *segment, time);
    const dea_segment *s = &route->signal->segments[*segment];
    const double source = dea_segment_voltage(route->signal, s, time);
    return (dea_moment){.time = time,
                        .source = source,
                        .voltage = dea_route_voltage(route, source, point->u, point->charge),
                        .slope = dea_segment_slope(route->signal, s, time),
                        .u = point->u,
                        .v = point->v};
}

static void fill_samples(const dea_route *route, const levels *l, dea_sample *samples)
{
    const size_t count = common(l);
    size_t segment = 0;
    bool inside = true;
    for (size_t i = 0; i < route->samples; i++) {
        const dea_track_point point = i < count ? l->before.points[i] : (dea_track_point){0};
        const dea_moment moment = moment_at(route, i, &segment, &point);
        if (i < count && inside) {
            inside = dea_dynamics_sample(route->dynamics, &moment, &samples[i]);
        } else {
            samples[i] = dea_sample_refused(moment.time, moment.source, inside ? l->fine.end : DEA_STATE_PULL_IN);
        }
    }
}

/* The faster of the film at rest and of the film under its largest voltage, with the weaker damping. */
static dea_pace pace_of_run(dea_dynamics *d, const dea_signal *signal)
{
    double u;
    dea_pace pace = dea_pace_of(d, 0.0, 0.0);
    if (dea_dynamics_equilibrium(d, signal->largest, &u)) {
        const dea_pace other = dea_pace_of(d, u, signal->largest);
        pace.omega = fmax(pace.omega, other.omega);
        pace.decay = other.omega > 0.0 ? fmin(pace.decay, other.decay) : pace.decay;
        pace.fastest = fmin(pace.fastest, other.fastest);
    }
    return pace;
}

static dea_status run_on(dea_route *route, dea_sample *samples, dea_summary *summary, dea_error *error)
{
    const dea_transient *transient = &route->scene->transient;
    const dea_pace pace = pace_of_run(route->dynamics, route->signal);
    const bool quiet = transient->from_bias || route->signal->segments[0].start == 0.0;
    dea_pieces pieces;
    levels l = {.error = INFINITY};
    dea_status status = dea_pieces_cut(route->signal, &pace, route->scene->accuracy, quiet, &pieces, error);
    route->pieces = &pieces;
    route->omega = pace.omega;
    route->scale = dea_dynamics_scale(route->dynamics, route->signal->largest);
    if (status == DEA_OK) {
        status = refine(route, &l, summary, error);
    }
    if (status == DEA_OK) {
        fill_samples(route, &l, samples);
    }
    free(l.coarse.points);
    free(l.fine.points);
    free(l.before.points);
    free(pieces.pieces);
    return status;
}

dea_status dea_ngspice_transient(dea_ngspice *library, const dea_scene *scene, const dea_model *model, dea_sample *samples,
                                 dea_summary *summary, dea_error *error)
{
    dea_dynamics dynamics;
    dea_mobility mobility = {0};
    dea_signal signal = {0};
    dea_status status = dea_dynamics_open(scene, model, &dynamics, error);
    if (status == DEA_OK) {
        status = dea_mobility_open(scene, &dynamics, &mobility, error);
    }
    if (status == DEA_OK) {
        status = dea_signal_open(scene, &signal, error);
    }
    if (status == DEA_OK) {
        dea_dynamics slow = dynamics; /* borrows what the other owns */
        slow.mass = 0.0;
        slow.retardation = dynamics.mass > 0.0 ? 0.0 : dynamics.retardation;
        dea_route route = {.library = library,
                           .slow = &slow,
                           .scene = scene,
                           .dynamics = &dynamics,
                           .mobility = &mobility,
                           .signal = &signal,
                           .samples = dea_layout_of(scene).rows};
        status = run_on(&route, samples, summary, error);
    }
    dea_signal_close(&signal);
    dea_mobility_close(&mobility);
    dea_dynamics_close(&dynamics);
    return status;
}
