/* Transients: runs at tighter and tighter tolerances, until two of them show that the answer is good enough. */
#include <float.h>
#include <math.h>
#include <stddef.h>
#include <stdlib.h>

#include "drive/signal.h"
#include "engine/ida/flight.h"
#include "network/swing.h"
#include "network/thin.h"
#include "result/scales.h"
#include "support/lapack.h"

enum { MOST_RUNS = 8, MOST_FITS = 4 };

/* The error of a run falls at least with this power of its tolerance; of what that promises a multiple is taken. */
static const double order = 0.8;
static const double safety = 9.0;
static const double doubt = 1.5;       /* most that an error is taken for, over the difference of two runs */
static const double shared = 0.1;      /* of the accuracy: error that two runs may have alike, so that none is told as less */
static const double first_share = 0.1; /* from one tolerance to the next */
static const double least_tolerance = 1e-14;
static const double tight = 1e-11; /* a tolerance that sees every swing that rounding leaves */
/* Accuracies near the engine's best, where two runs share some of their error, so that their difference must lie further below. */
static const double fine = 1e-8, margin = 0.3, first_bar = 0.15;
/* A loose step may carry a film out of its frame that turns back just before it: an end of the motion counts from this tolerance on,
 * and others are tightened by so much towards it. */
static const double certain = 1e-9, towards = 1e-2;

/* Peak of the displacement over the samples, or a tenth of that over the run where the samples miss it [m]. */
static double peak(const dea_trace *trace)
{
    double largest = fmax(0.1 * trace->largest_u, DBL_MIN);
    for (size_t i = 0; i < trace->count; i++) {
        largest = fmax(largest, fabs(trace->moments[i].u));
    }
    return largest;
}

/* Mean displacement over a window [m]. */
static double mean(const dea_flight *flight, const dea_trace *trace, size_t window)
{
    const dea_window *w = &flight->scene->transient.averages[window];
    return trace->integrals[window] / (w->to - w->from);
}

/* True where the film has numbers all over a window. */
static bool covers(const dea_flight *flight, const dea_trace *trace, size_t window)
{
    const double last = trace->count > 0 ? trace->moments[trace->count - 1].time : -1.0;
    return trace->end == DEA_STATE_OK || flight->scene->transient.averages[window].to <= last;
}

/* What two runs differ by. */
typedef struct gap {
    double answer;         /* of the column that is worst against what it promises, times its allowance [1] */
    double displacement;   /* of displacement, its means and film voltage, over their peaks [1] */
    dea_rate_errors rates; /* of velocity and current */
} gap;

/* Current of the source behind its resistance, where it has one. */
static double current(const dea_dynamics *d, const dea_moment *m)
{
    return m->charging ? m->charge_slope + m->voltage * d->conductance : d->series > 0.0 ? dea_dynamics_flow(d, m->source - m->voltage) : 0.0;
}

/* What the other columns of a hyperelastic film make of two runs: next to its centre or its frame force, capacitance and, without a
 * resistance, current change by many times the share that the displacement does. The columns of linear films do not. */
static void widen_columns(const dea_flight *flight, const dea_scales *scales, const dea_trace *a, const dea_trace *b, size_t count, gap *g)
{
    dea_dynamics *d = flight->motion.dynamics;
    dea_columns_gap columns = {0};
    for (size_t i = 0; i < count && !d->linear; i++) {
        dea_sample p, q;
        if (dea_dynamics_sample(d, &a->moments[i], &p) && dea_dynamics_sample(d, &b->moments[i], &q)) {
            dea_columns_widen(&columns, &p, &q);
        }
    }
    g->answer = fmax(g->answer, dea_columns_worst(scales, &columns));
    g->rates.current = fmax(g->rates.current, columns.most.current);
}

/* Largest differences of two runs; velocity and current are held to what their columns promise. */
static gap difference(const dea_flight *flight, const dea_scales *scales, const dea_trace *a, const dea_trace *b)
{
    const dea_dynamics *d = flight->motion.dynamics;
    const double u = peak(b), film = fmax(flight->signal->largest, DBL_MIN);
    const size_t count = a->count < b->count ? a->count : b->count;
    double v = DBL_MIN, flow = DBL_MIN; /* peaks */
    gap g = {0.0, 0.0, {0.0, 0.0}};
    for (size_t i = 0; i < flight->scene->transient.average_count; i++) {
        const bool both = covers(flight, a, i) && covers(flight, b, i);
        g.displacement = fmax(g.displacement, both ? fabs(mean(flight, a, i) - mean(flight, b, i)) / u : 0.0);
    }
    for (size_t i = 0; i < count; i++) {
        const dea_moment *p = &a->moments[i];
        const dea_moment *q = &b->moments[i];
        const double i_p = current(d, p), i_q = current(d, q);
        g.displacement = fmax(g.displacement, fmax(fabs(p->u - q->u) / u, fabs(p->voltage - q->voltage) / film));
        g.rates.velocity = fmax(g.rates.velocity, fabs(p->v - q->v));
        g.rates.current = fmax(g.rates.current, fabs(i_p - i_q));
        v = fmax(v, fabs(q->v));
        flow = fmax(flow, fabs(i_q));
    }
    v = fmax(v, u * scales->pace);
    flow = fmax(flow, film * dea_dynamics_edge(flight->motion.dynamics, 0.0).capacitance * scales->charging);
    const double rate = fmax(g.rates.velocity / v, g.rates.current / flow);
    g.answer = fmax(g.displacement, rate / dea_scales_allowance(offsetof(dea_sample, velocity)));
    widen_columns(flight, scales, a, b, count, &g);
    return g;
}

/* Radians over which a swing that starts at rest keeps its errors. */
static double memory(const dea_flight *flight)
{
    const double until = flight->scene->transient.until;
    const dea_swing swing = dea_swing_of(flight->motion.dynamics, flight->motion.dynamics->rest, 0.0);
    return isnan(swing.frequency) ? 0.0 : 2.0 * DEA_PI * swing.frequency * (swing.decay * until > 1.0 ? 1.0 / swing.decay : until);
}

/* Local tolerance with which a run is likely to be good enough: errors of an explicit method add up over a swing. A corner of a slow
 * voltage sets off a swing of a velocity like the film's own, 1/(omega T) of its displacement, which no looser run would see. */
static double first_tolerance(const dea_flight *flight, const dea_scales *scales, double accuracy)
{
    const dea_dynamics *d = flight->motion.dynamics;
    const double share = d->mass > 0.0 && !d->linear ? fmin(0.01, fmax(1e-3, 1.0 / memory(flight))) : 0.1;
    const double tolerance = share * accuracy;
    if (!(d->mass > 0.0)) {
        return tolerance;
    }
    const double rate = dea_scales_allowance(offsetof(dea_sample, velocity)) * scales->pace;
    const double seen = tolerance * fmin(1.0, rate * sqrt(d->mass / flight->motion.stiffness));
    return fmax(seen, fmin(tolerance, tight));
}

/* Share by which a tolerance must shrink so that a run of error @p error becomes one whose estimate is half the
 * accuracy. */
static double next_share(double error, double accuracy)
{
    return fmin(first_share, fmax(1e-3, pow(accuracy / (2.0 * safety * error), 1.0 / order)));
}

/* What the estimate of two runs must lie below: an undamped film that bounces off its narrow annulus errs by bursts there, which
 * hardly fall from one tolerance to the next, so that both runs share some of it too. The first two runs of a linear film are loose
 * ones: BDF changes its order and step by jumps, and both may err alike by a few times what they differ by. */
static double bar(const dea_flight *flight, double accuracy, bool first)
{
    const dea_dynamics *d = flight->motion.dynamics;
    const double share = d->linear ? (first ? first_bar : 1.0) : d->mass > 0.0 ? margin : 1.0;
    return accuracy > fine ? share * accuracy : accuracy;
}

/* Leaves the better run of the last two in traces[1]; false where the accuracy was not reached. A run that broke off is good up
 * to there. */
static bool refine(dea_flight *flight, const dea_scales *scales, double accuracy, dea_trace traces[2], dea_summary *summary,
                   dea_rate_errors *rates)
{
    double tolerance = first_tolerance(flight, scales, accuracy);
    double share = first_share;
    bool good = false;
    flight->loosest = tolerance;
    dea_flight_run(flight, tolerance, &traces[1], NULL);
    for (int i = 0; i < MOST_FITS && dea_flight_fit(flight); i++) {
        dea_flight_run(flight, tolerance, &traces[1], NULL);
    }
    for (int i = 0; i < MOST_RUNS && tolerance > 1.5 * least_tolerance; i++) {
        const dea_trace coarse = traces[1];
        traces[1] = traces[0];
        traces[0] = coarse;
        share = fmax(share, least_tolerance / tolerance);
        tolerance *= share;
        *summary = dea_summary_failed();
        dea_flight_run(flight, tolerance, &traces[1], summary);
        const double shrinks = pow(share, order), enough = bar(flight, accuracy, i == 0);
        const gap apart = difference(flight, scales, &traces[0], &traces[1]);
        const bool failed = traces[1].end == DEA_STATE_FAILED;
        const bool doubtful = traces[1].end == DEA_STATE_PULL_IN && tolerance > certain;
        const bool comparable = failed || traces[0].count == traces[1].count;
        const double trust = fmin(doubt, safety * shrinks), least = fmax(10.0 * tolerance, shared * accuracy);
        const double worst = fmax(apart.answer * trust, least);
        summary->error = fmax(apart.displacement * trust, least);
        *rates = (dea_rate_errors){apart.rates.velocity * trust, apart.rates.current * trust};
        good = worst <= accuracy && (failed || (comparable && !doubtful));
        if ((good && worst <= enough) || failed) {
            return good;
        }
        share = doubtful ? towards : comparable ? next_share(apart.answer * shrinks, enough) : first_share;
    }
    return good;
}

/* Rows of a trace; where it ended, or a row is past the film, all that follow are refused. */
static void fill(const dea_flight *flight, const dea_trace *trace, dea_sample *samples)
{
    size_t done = 0;
    while (done < trace->count && dea_dynamics_sample(flight->motion.dynamics, &trace->moments[done], &samples[done])) {
        done++;
    }
    dea_samples_refuse(flight->scene, flight->signal, done, done < trace->count ? DEA_STATE_PULL_IN : trace->end, samples);
}

static void tell_averages(const dea_flight *flight, const dea_trace *trace, dea_summary *summary)
{
    for (size_t i = 0; i < flight->scene->transient.average_count; i++) {
        const double u = mean(flight, trace, i);
        summary->averages[i] = (dea_average){u / flight->motion.dynamics->radius, u};
    }
}

static void explain(const dea_flight *flight, const dea_summary *summary, dea_error *error)
{
    if (flight->why.message[0] != '\0') {
        dea_fail(error, DEA_ERROR_ENGINE, "%s", flight->why.message);
    } else {
        dea_fail(error, DEA_ERROR_ENGINE,
                 "%ld steps of SUNDIALS at a tolerance of %.1g leave an error of %.1g, the scene wants %g", flight->steps,
                 flight->tolerance, summary->error, flight->scene->accuracy);
    }
}

/* Runs until the answer is good enough, and tells it. */
static void fly_on(dea_flight *flight, const dea_scales *scales, dea_trace traces[2], dea_sample *samples, dea_summary *summary,
                   dea_error *error)
{
    dea_rate_errors rates = {0.0, 0.0};
    const double accuracy = flight->scene->accuracy - flight->signal->thinned;
    const bool reached = refine(flight, scales, accuracy > fine ? accuracy : margin * accuracy, traces, summary, &rates);
    summary->error += flight->signal->thinned;
    if (!reached || traces[1].end == DEA_STATE_FAILED) {
        explain(flight, summary, error);
    }
    if (!reached) {
        traces[1].count = 0;
        traces[1].end = DEA_STATE_FAILED;
    }
    fill(flight, &traces[1], samples);
    tell_averages(flight, &traces[1], summary);
    if (flight->motion.dynamics->linear && !(flight->motion.dynamics->series > 0.0)) { /* the current C U' + C' U v is as good as the velocity */
        rates.current = scales->motional * rates.velocity;
    }
    dea_scales_tell(scales, samples, flight->rows, rates, shared * accuracy, summary);
    if (flight->peaks && traces[1].end == DEA_STATE_OK) {
        dea_peak_tell(&traces[0].peak, &traces[1].peak, flight->scene->accuracy, summary);
    }
}

static dea_status fly(dea_flight *flight, dea_sample *samples, dea_summary *summary, dea_error *error)
{
    dea_trace traces[2] = {{0}, {0}};
    const dea_scales scales = dea_scales_open(flight->scene, flight->motion.dynamics->model);
    traces[0].moments = malloc(flight->rows * sizeof *traces[0].moments);
    traces[1].moments = malloc(flight->rows * sizeof *traces[1].moments);
    const bool room = traces[0].moments && traces[1].moments && scales.status != DEA_ERROR_MEMORY;
    if (room) {
        fly_on(flight, &scales, traces, samples, summary, error);
    }
    free(traces[0].moments);
    free(traces[1].moments);
    return room ? DEA_OK : dea_fail(error, DEA_ERROR_MEMORY, "out of memory for %zu samples", flight->rows);
}

static dea_status fly_signal(const dea_sundials *sun, const dea_scene *scene, dea_dynamics *dynamics, dea_sample *samples,
                             dea_summary *summary, dea_error *error)
{
    dea_signal signal;
    dea_flight flight;
    dea_status status = dea_signal_open(scene, &signal, error);
    if (status == DEA_OK && !dea_peak_is_known(scene, dynamics, &signal)) {
        const dea_scales scales = dea_scales_open(scene, dynamics->model);
        status = dea_signal_thin(&signal, scene, dynamics, scales.pace, error);
    }
    if (status == DEA_OK) {
        status = dea_flight_open(sun, scene, dynamics, &signal, &flight, error);
        if (status == DEA_OK && !(flight.peaks && dynamics->series == 0.0)) { /* the current C U' has its peaks at corners */
            status = dea_signal_soften(&signal, scene->accuracy, dea_flight_short_line(&flight), error);
            flight.motion.segment = signal.segments;
        }
        if (status == DEA_OK) {
            status = fly(&flight, samples, summary, error);
        }
        dea_flight_close(&flight);
    }
    dea_signal_close(&signal);
    return status;
}

dea_status dea_transient_solve(const dea_sundials *sun, const dea_scene *scene, const dea_model *model, dea_sample *samples,
                               dea_summary *summary, dea_error *error)
{
    dea_dynamics dynamics;
    *summary = dea_summary_failed();
    dea_status status = dea_lapack_load(error); /* for the swing, see swing.c */
    if (status != DEA_OK) {
        return status;
    }
    status = dea_dynamics_open(scene, model, &dynamics, error);
    if (status == DEA_OK) {
        status = fly_signal(sun, scene, &dynamics, samples, summary, error);
    }
    dea_dynamics_close(&dynamics);
    return status;
}
