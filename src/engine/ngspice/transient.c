/* Runs with ever finer steps until their answers agree. The error of the trapezoidal rule is even in the step: two runs, h and
 * h/2, give an answer of fourth order, (4 y(h/2) - y(h))/3, and the two last of these the error bar. The balance of energies must
 * close too. */
#include <float.h>
#include <math.h>
#include <stddef.h>
#include <stdio.h>
#include <stdlib.h>

#include "engine/ngspice/moving.h"
#include "engine/ngspice/track.h"
#include "network/thin.h"
#include "result/scales.h"

/* Most work that all runs of a transient may take, in time steps of a linear network. A scene is refused as early as it can be told that it takes more; once so much is spent that a refusal would come
 * late, it gets more. */
static const double most_work = 5e6;
static const double late_work = 1e6;
static const double late_share = 3.0;
static const double bounce_share = 0.4;
static const double corner_points = 10.0; /* of the library behind a corner in a netlist, whose steps begin short */
static const double work_time = 6e-6; /* of one processor, roughly [s] */

/* Most runs, those after which a failure is one, and those after which a film that runs away does so at a sample. */
enum { MOST_LEVELS = 14, STUBBORN = 5, PATIENT = 8 };

/* Pieces that are many. */
enum { MANY = 200 };

/* Share of the wanted error at which an open balance of energies is no longer worth finer runs: the study says that it is open.
 */
static const double enough = 1e-3;

typedef struct levels {
    dea_track coarse, fine; /* the last two runs */
    dea_track before;       /* extrapolated from the two before: points, integrals and peak only */
    double peak_error;      /* of the answer for the peak of the current [A] */
    size_t runs;
    double work;     /* of the last one, counted; 0: none yet */
    bool shown;      /* all rows have numbers: the film stays within its frame */
    double error;    /* of the answer: that of the column that is worst against what it promises */
    double displacement;   /* error of displacement and charge */
    dea_rate_errors rates; /* of velocity and current */
    double motional;       /* error of the current where the charge is no state: C' U v is as good as the velocity [A] */
    dea_scales scales;
    double residual; /* of its energies */
} levels;

/* y + (y - coarse)/3. */
static double better(double coarse, double fine)
{
    return fine + (fine - coarse) / 3.0;
}

static dea_track_point better_point(const dea_track_point *coarse, const dea_track_point *fine)
{
    return (dea_track_point){better(coarse->u, fine->u), better(coarse->v, fine->v), better(coarse->charge, fine->charge),
                             better(coarse->current, fine->current)};
}

/* The error that is wanted of the runs: all but what thinning the drive may take. */
static double wanted_of(const dea_route *route)
{
    return route->scene->accuracy - route->signal->thinned;
}

static size_t common(const levels *l)
{
    return l->coarse.reached < l->fine.reached ? l->coarse.reached : l->fine.reached;
}

/* Largest differences and peaks of the columns. */
typedef struct apart {
    dea_track_point most, peak;
    dea_columns_gap columns; /* of hyperelastic films */
    size_t segment;          /* of the last sample */
} apart;

static void widen(apart *g, const dea_track_point *a, const dea_track_point *b)
{
    g->most.u = fmax(g->most.u, fabs(a->u - b->u));
    g->most.v = fmax(g->most.v, fabs(a->v - b->v));
    g->most.charge = fmax(g->most.charge, fabs(a->charge - b->charge));
    g->most.current = fmax(g->most.current, fabs(a->current - b->current));
    g->peak.u = fmax(g->peak.u, fabs(b->u));
    g->peak.v = fmax(g->peak.v, fabs(b->v));
    g->peak.charge = fmax(g->peak.charge, fabs(b->charge));
    g->peak.current = fmax(g->peak.current, fabs(b->current));
}

static double over(double gap, double scale)
{
    return gap > 0.0 ? gap / scale : 0.0;
}

/* Of displacement and charge. */
static double largest(const apart *g)
{
    return fmax(over(g->most.u, g->peak.u), over(g->most.charge, g->peak.charge));
}

/* Of velocity and the slope of the charge, over their scales. */
static double largest_rate(const apart *g, const dea_scales *scales)
{
    const double u = fmax(g->peak.u, scales->least.displacement), charge = fmax(g->peak.charge, scales->least.charge);
    return fmax(over(g->most.v, fmax(g->peak.v, u * scales->pace)),
                over(g->most.current, fmax(g->peak.current, charge * scales->charging)));
}

/* True where the film has numbers all over a window in both of the last runs. */
static bool covers(const dea_route *route, const levels *l, size_t window)
{
    const double to = route->scene->transient.averages[window].to;
    const bool whole = l->coarse.end == DEA_STATE_OK && l->fine.end == DEA_STATE_OK;
    return whole || to <= fmin(l->coarse.last.time, l->fine.last.time);
}

/* The same for the means of the displacement. */
static void widen_means(const dea_route *route, levels *l, double shown, apart *second, apart *fourth)
{
    for (size_t i = 0; i < route->scene->transient.average_count; i++) {
        const dea_window *window = &route->scene->transient.averages[i];
        const double width = window->to - window->from;
        const double coarse = l->coarse.integrals[i], fine = l->fine.integrals[i], answer = better(coarse, fine);
        if (covers(route, l, i) && window->to <= shown) {
            second->most.u = fmax(second->most.u, fabs(fine - coarse) / width);
            fourth->most.u = fmax(fourth->most.u, l->runs > 2 ? fabs(answer - l->before.integrals[i]) / width : 0.0);
        }
        l->before.integrals[i] = answer;
    }
}

/* Of the windows that end before the motion does. */
static void tell_averages(const dea_route *route, const levels *l, dea_summary *summary)
{
    const double end = fmin(l->coarse.last.time, l->fine.last.time);
    for (size_t i = 0; i < route->scene->transient.average_count; i++) {
        const dea_window *window = &route->scene->transient.averages[i];
        const double u = better(l->coarse.integrals[i], l->fine.integrals[i]) / (window->to - window->from);
        if (window->to <= end * (1.0 + 1e-12)) {
            summary->averages[i] = (dea_average){u / route->dynamics->radius, u};
        }
    }
}

/* A row has numbers within the frame alone, while a linear film runs on without end: what it does there is no peak. */
static bool is_shown(const dea_route *route, const dea_track_point *point)
{
    const dea_dynamics *d = route->dynamics;
    return point->u > -d->radius && point->u < d->point.frame_radius - d->radius;
}

/* The peak of the current: half the difference of two runs, from three on 2.5 times that of what they extrapolate to, bounds its
 * error. */
static void judge_peak(levels *l)
{
    const double coarse = l->coarse.peak.current, fine = l->fine.peak.current, answer = better(coarse, fine);
    l->peak_error = 0.5 * fabs(fine - coarse);
    if (l->runs > 2) {
        l->peak_error = fmin(l->peak_error, 2.5 * fabs(answer - l->before.peak.current));
    }
    l->before.peak = (dea_peak){answer, l->fine.peak.time};
}

/* Where it is within ten times the accuracy, and all rows have numbers. */
static void tell_peak(const dea_route *route, const levels *l, dea_summary *summary)
{
    const bool told = route->peaks && l->shown && l->fine.end == DEA_STATE_OK &&
                      l->peak_error <= 10.0 * route->scene->accuracy * l->before.peak.current;
    summary->peak_current = told ? l->before.peak.current : (double)NAN;
    summary->peak_time = told ? l->before.peak.time : (double)NAN;
}

/* The moment of a sample. */
static dea_moment moment_at(const dea_route *route, size_t index, size_t *segment, const dea_track_point *point)
{
    const double time = dea_layout_place(route->scene, index);
    *segment = dea_signal_find(route->signal, *segment, time);
    const dea_segment *s = dea_segment_seen(&route->signal->segments[*segment], time);
    const double source = dea_segment_voltage(route->signal, s, time);
    return (dea_moment){.time = time,
                        .source = source,
                        .voltage = dea_route_voltage(route, source, point->u, point->charge),
                        .slope = dea_segment_slope(route->signal, s, time),
                        .u = point->u,
                        .v = point->v,
                        .charging = route->dynamics->series > 0.0,
                        .charge_slope = point->current};
}

/* What the other columns of a hyperelastic film make of two points: next to its centre or its frame force, capacitance and, without a
 * resistance, current change by many times the share that the displacement does. The columns of linear films do not. */
static void widen_columns(const dea_route *route, size_t index, apart *g, const dea_track_point *a, const dea_track_point *b)
{
    dea_sample p, q;
    if (route->dynamics->linear) {
        return;
    }
    const dea_moment first = moment_at(route, index, &g->segment, a), second = moment_at(route, index, &g->segment, b);
    if (dea_dynamics_sample(route->dynamics, &first, &p) && dea_dynamics_sample(route->dynamics, &second, &q)) {
        dea_columns_widen(&g->columns, &p, &q);
    }
}

/* Two runs: twice their difference; the error of the finer one is 1/3 of it in theory. Three: 2.5 times the difference of what
 * they extrapolate to; the error of the later one is 1/15 of it in theory, and more where steps follow the age of an edge, or
 * where the film runs away behind the last of few rows. The factors bound the errors of random scenes. */
static const double of_second = 2.0, of_fourth = 2.5, running_away = 2.0;

static void judge(const dea_route *route, levels *l)
{
    apart second = {0}, fourth = {0};
    const size_t count = common(l);
    bool shown = true;
    double last = 0.0; /* time of the last row that has numbers */
    for (size_t i = 0; i < count; i++) {
        const dea_track_point answer = better_point(&l->coarse.points[i], &l->fine.points[i]);
        shown = shown && is_shown(route, &answer);
        if (shown) {
            last = dea_layout_place(route->scene, i);
            widen(&second, &l->coarse.points[i], &l->fine.points[i]);
            widen_columns(route, i, &second, &l->coarse.points[i], &l->fine.points[i]);
        }
        if (shown && l->runs > 2) {
            widen(&fourth, &l->before.points[i], &answer);
            widen_columns(route, i, &fourth, &l->before.points[i], &answer);
        }
        if (l->runs > 1) {
            l->before.points[i] = answer;
        }
    }
    l->shown = shown;
    judge_peak(l);
    widen_means(route, l, shown ? (double)INFINITY : last, &second, &fourth);
    const double away = shown && l->fine.end == DEA_STATE_OK ? 1.0 : running_away;
    const double two = away * of_second, three = away * of_fourth;
    l->displacement = two * largest(&second);
    l->rates = (dea_rate_errors){two * second.most.v, two * second.most.current};
    double rate = two * largest_rate(&second, &l->scales), columns = two * dea_columns_worst(&l->scales, &second.columns);
    l->motional = two * second.columns.most.current;
    if (l->runs > 2) {
        l->displacement = fmin(l->displacement, three * largest(&fourth));
        l->rates.velocity = fmin(l->rates.velocity, three * fourth.most.v);
        l->rates.current = fmin(l->rates.current, three * fourth.most.current);
        rate = fmin(rate, three * largest_rate(&fourth, &l->scales));
        columns = fmin(columns, three * dea_columns_worst(&l->scales, &fourth.columns));
        l->motional = fmin(l->motional, three * fourth.columns.most.current);
    }
    l->error = fmax(fmax(l->displacement, columns), rate / dea_scales_allowance(offsetof(dea_sample, velocity)));
    if (l->coarse.reached != l->fine.reached || l->coarse.end != l->fine.end) {
        l->error = l->displacement = INFINITY;
    }
}

static dea_mobility_state better_state(const dea_mobility_state *coarse, const dea_mobility_state *fine, size_t relaxed)
{
    dea_mobility_state state = {
        better(coarse->u, fine->u), better(coarse->v, fine->v), better(coarse->charge, fine->charge), {0}};
    for (size_t i = 0; i < relaxed; i++) {
        state.z[i] = better(coarse->z[i], fine->z[i]);
    }
    return state;
}

/* Energies at the end from both runs, as the states are; none where the motion ends before the run. */
static void fill_summary(const dea_route *route, const levels *l, dea_summary *summary)
{
    dea_dynamics *d = route->dynamics;
    const dea_audit *coarse = &l->coarse.audit;
    const dea_audit *fine = &l->fine.audit;
    *summary = dea_summary_failed();
    summary->error = l->displacement + route->signal->thinned;
    tell_averages(route, l, summary);
    if (l->fine.end != DEA_STATE_OK || l->coarse.end != DEA_STATE_OK) {
        return;
    }
    const dea_audit audit = {better(coarse->work, fine->work), better(coarse->dissipated, fine->dissipated),
                             better(coarse->branch, fine->branch), fine->largest};
    const dea_mobility_state stop = better_state(&l->coarse.stop, &l->fine.stop, dea_dynamics_states(d));
    dea_moment last = l->fine.last;
    last.u = stop.u;
    last.v = stop.v;
    last.voltage = dea_route_voltage(route, last.source, stop.u, stop.charge);
    dea_audit_close(&audit, d, &l->fine.first, l->fine.start.z, &last, stop.z, summary);
    tell_peak(route, l, summary);
}

/* From measured errors: three runs from there on mostly do. */
static double first_fineness(const dea_scene *scene)
{
    return fmin(1.0, pow(scene->accuracy / 1e-5, 0.3));
}

/* Work of a run that nothing is known of. */
static double work_of(const dea_route *route, double fineness)
{
    const dea_pieces *p = route->pieces;
    return dea_track_work(route, p->points / fineness + corner_points * p->corners, (double)p->count);
}

/* Work that a run took. */
static double counted(const dea_route *route, const dea_track *track)
{
    return dea_track_work(route, track->steps, track->netlists);
}

/* Work of the next run: what it halves are steps, at most all of them. */
static double next_work(const dea_route *route, const levels *l, double fineness)
{
    return l->work > 0.0 ? 2.0 * l->work : work_of(route, fineness);
}

/* An error as large as the motion says nothing yet of how it falls, [1]. */
static const double unknown = 0.5;

/* Runs that are wanted at least, each finer by 2: two to compare, then as many as a fourth order takes from here, one more where two
 * differ as far as they can; of a film that the last one carried through where it turns back, three that do not. */
static double least_runs(const levels *l, double wanted)
{
    if (l->runs < 3) {
        return l->runs == 1 ? 2.0 : 1.0;
    }
    if (l->fine.bounces) {
        return 3.0;
    }
    if (!isfinite(l->error)) {
        return 1.0; /* runs that cannot be compared tell nothing */
    }
    const double falling = fmax(1.0, ceil(log(fmin(l->error, 1.0) / wanted) / log(16.0)));
    return l->error < unknown ? falling : falling + 1.0;
}

/* What the next runs would take. */
typedef struct bill {
    double steps; /* of the finest */
    double work;  /* of all runs, those that were done too */
} bill;

/* Most work of all runs once so much is spent. Steps that go through the point where a film turns back say that it is steep there, not
 * that one more run would do: that ends early. */
static double most_of(const levels *l, double spent)
{
    return (l->fine.bounces ? bounce_share : spent > late_work ? late_share : 1.0) * most_work;
}

/* Refuses with what it would take, the limit, and what to do. */
static dea_status refuse(const bill *b, double most, const char *why, dea_error *error)
{
    return dea_fail(error, DEA_ERROR_ENGINE,
                    "%s: %.2g time steps of ngspice or more, some %.0f s, at most %.0f s are spent on such a run; take --engine ida, a "
                    "looser accuracy or a shorter run",
                    why, b->steps, b->work * work_time, most * work_time);
}

/* Why a run takes so many steps before anything of it is known. */
static void explain_length(const dea_route *route, char *why, size_t size)
{
    const dea_signal *signal = route->signal;
    const double periods = route->omega * dea_pieces_ringing(route->pieces) / (2.0 * DEA_PI);
    double turns = 0.0;
    for (size_t i = 0; i < signal->count; i++) {
        const dea_segment *s = &signal->segments[i];
        turns += s->terms ? 0.0 : dea_segment_turn(signal, s) * (s->to - s->from) / (2.0 * DEA_PI);
    }
    if (periods > 1000.0) {
        snprintf(why, size, "the film rings for %.2g periods", periods);
    } else if (turns > 1000.0) {
        snprintf(why, size, "the sine of the drive turns %.2g times", turns);
    } else if (route->pieces->count > MANY) {
        snprintf(why, size, "what the film sees of the edges and ramps of the drive makes %zu netlists", route->pieces->count);
    } else {
        snprintf(why, size, "the run is very long beside the fastest times of the film");
    }
}

/* Refuses runs that would take too long: number l->runs is next, of that fineness. */
static dea_status afford(const dea_route *route, const levels *l, double fineness, double spent, dea_error *error)
{
    char why[200];
    const double wanted = wanted_of(route);
    const double runs = least_runs(l, wanted);
    const bill b = {.steps = route->pieces->points / fineness * exp2(runs - 1.0),
                    .work = spent + next_work(route, l, fineness) * (exp2(runs) - 1.0)};
    if (b.work <= most_of(l, spent) && l->runs <= MOST_LEVELS) {
        return DEA_OK;
    }
    if (l->runs > 1 && l->fine.bounces) {
        snprintf(why, sizeof why, "%.2g time steps go through the point where the film turns back",
                 route->pieces->points / fineness / 2.0);
    } else if (l->runs > 2 && l->error <= wanted) {
        snprintf(why, sizeof why, "the balance of energies is open by %.1g, at most %g is wanted", l->residual,
                 10.0 * route->scene->accuracy);
    } else if (l->runs > 2) {
        snprintf(why, sizeof why, "%.2g time steps leave an error of %.1g, the scene wants %g",
                 route->pieces->points / fineness / 2.0, l->error, route->scene->accuracy);
    } else {
        explain_length(route, why, sizeof why);
    }
    return refuse(&b, most_of(l, spent), why, error);
}

/* Refuses a run that took more work than was thought. */
static dea_status refuse_exhausted(const dea_route *route, const levels *l, double spent, dea_error *error)
{
    char why[200];
    const dea_track *t = &l->fine;
    const double until = route->scene->transient.until, share = until / fmax(t->last.time, 1e-3 * until);
    const bill b = {.steps = share * t->steps, .work = spent + share * l->work};
    snprintf(why, sizeof why, "its steps get short, at %.3g s of %.3g s %.2g of them were taken", t->last.time / route->unit,
             until / route->unit, t->steps);
    return refuse(&b, most_of(l, spent), why, error);
}

/* One more run, twice as fine as the last; true in *done where the answer is good enough. */
static dea_status refine_once(const dea_route *route, levels *l, double fineness, double spent, dea_summary *summary, bool *done,
                              dea_error *error)
{
    const double wanted = wanted_of(route);
    dea_route bounded = *route;
    bounded.most = (most_of(l, spent) - spent) / (exp2(least_runs(l, wanted)) - 1.0);
    free(l->coarse.points);
    l->coarse = l->fine;
    l->fine = (dea_track){0};
    dea_status status = dea_track_run(&bounded, fineness, &l->fine, error);
    l->work = counted(route, &l->fine);
    if (status == DEA_OK && l->fine.exhausted) {
        return refuse_exhausted(route, l, spent, error);
    }
    if (status == DEA_OK && l->runs > 1) {
        judge(route, l);
        fill_summary(route, l, summary);
        l->residual = summary->residual;
        const bool ended = l->fine.end == DEA_STATE_OK || (l->fine.end == DEA_STATE_PULL_IN && !l->fine.vague);
        const bool settled = ended || (l->runs >= (l->fine.vague ? PATIENT : STUBBORN) && !l->fine.bounces);
        const bool closed = l->fine.end != DEA_STATE_OK || summary->residual <= 10.0 * wanted || l->error <= enough * wanted;
        *done = l->error <= wanted && settled && closed;
    }
    return status;
}

/* A trial of the begin of a run whose ring is not linear: the phase that it loses shows in two runs, and how it grows is known. Time
 * steps of its first run, work of two whole runs from which on it is worth that, and what its estimate may be too large by. */
static const double trial_steps = 1.5e4;
static const double trial_work = 5e5;
static const double trial_doubt = 3.0;
static const double trial_share = 0.2; /* most of the run that a trial is worth */

/* The begin of the pieces with so many points, in @p pieces, which has room for all; the time that it rings [s]. */
static double cut_trial(const dea_pieces *all, double points, dea_pieces *begin)
{
    begin->points = begin->corners = 0.0;
    begin->count = 0;
    while (begin->count < all->count && begin->points < points) {
        dea_piece piece = all->pieces[begin->count];
        const double length = fmin(piece.to - piece.from, (points - begin->points) * piece.step);
        piece.to = length < piece.to - piece.from ? piece.from + length : piece.to;
        begin->points += length / piece.step;
        begin->pieces[begin->count++] = piece;
    }
    return dea_pieces_ringing(begin);
}

/* Error of two runs over the begin. */
static dea_status try_begin(const dea_route *route, double fineness, levels *l, dea_error *error)
{
    dea_status status = dea_track_run(route, fineness, &l->coarse, error);
    if (status == DEA_OK) {
        status = dea_track_run(route, 0.5 * fineness, &l->fine, error);
    }
    if (status == DEA_OK) {
        l->runs = 2;
        judge(route, l);
    }
    free(l->coarse.points);
    free(l->fine.points);
    return status;
}

/* Refuses a ring that is not linear where its begin tells that it takes too long: of two runs the phase error grows with the time
 * that it rings, at most that in which its energy falls to 1/e, and every finer run takes 16 times off. */
static dea_status afford_ring(const dea_route *route, levels *l, const dea_pace *pace, double fineness, double *spent, dea_error *error)
{
    const double wanted = wanted_of(route), two = work_of(route, fineness) + work_of(route, 0.5 * fineness);
    if (route->dynamics->linear || pace->omega == 0.0 || two < trial_work) {
        return DEA_OK;
    }
    dea_pieces begin = {.pieces = malloc(route->pieces->count * sizeof *begin.pieces)};
    if (!begin.pieces) {
        return dea_fail(error, DEA_ERROR_MEMORY, "out of memory for the pieces of a run");
    }
    const double life = pace->decay > 0.0 ? 0.5 / pace->decay : (double)INFINITY;
    const double rung = fmin(life, cut_trial(route->pieces, trial_steps * fineness, &begin));
    if (begin.points > trial_share * route->pieces->points) { /* the run itself tells as soon */
        free(begin.pieces);
        return DEA_OK;
    }
    const double grows = rung > 0.0 ? fmin(life, dea_pieces_ringing(route->pieces)) / rung : 1.0;
    dea_route trial = *route;
    trial.pieces = &begin;
    dea_status status = try_begin(&trial, fineness, l, error);
    *spent += counted(route, &l->coarse) + counted(route, &l->fine);
    const double expected = l->error * fmax(grows, 1.0);
    const double runs = 2.0 + (isfinite(expected) ? fmax(0.0, ceil(log(expected / trial_doubt / wanted) / log(16.0))) : 0.0);
    const bill b = {.steps = route->pieces->points / fineness * exp2(runs - 1.0),
                    .work = *spent + work_of(route, fineness) * (exp2(runs) - 1.0)};
    if (status == DEA_OK && b.work > most_of(l, *spent)) {
        char why[200];
        snprintf(why, sizeof why, "the ring of this film would lose a phase of some %.1g at %.2g time steps, the scene wants %g", expected,
                 2.0 * route->pieces->points / fineness, route->scene->accuracy);
        status = refuse(&b, most_of(l, *spent), why, error);
    }
    free(begin.pieces);
    l->coarse = l->fine = (dea_track){0};
    l->error = INFINITY;
    return status;
}

static dea_status refine(const dea_route *route, levels *l, const dea_pace *pace, dea_summary *summary, dea_error *error)
{
    double fineness = first_fineness(route->scene);
    double spent = 0.0;
    bool done = false;
    dea_status status = DEA_OK;
    l->before.points = malloc(route->samples * sizeof *l->before.points);
    if (!l->before.points) {
        return dea_fail(error, DEA_ERROR_MEMORY, "out of memory for the samples of a run");
    }
    status = afford_ring(route, l, pace, fineness, &spent, error);
    for (l->runs = 1; status == DEA_OK && !done; l->runs++) {
        status = afford(route, l, fineness, spent, error);
        if (status == DEA_OK) {
            status = refine_once(route, l, fineness, spent, summary, &done, error);
        }
        spent += l->work;
        fineness *= 0.5;
    }
    if (status == DEA_OK && l->fine.end == DEA_STATE_FAILED) {
        const char *complaint = dea_ngspice_complaint(route->library);
        dea_fail(error, DEA_ERROR_ENGINE, "ngspice stopped at %g s%s%s", l->fine.last.time / route->unit,
                 complaint[0] ? ": " : "", complaint);
    }
    return status;
}

/* Errors of the rates; where no series resistance makes the charge a state, its slope is C U' + C' U v. */
static void tell_rates(const dea_route *route, const levels *l, const dea_sample *samples, dea_summary *summary)
{
    dea_rate_errors errors = l->rates;
    if (!(route->dynamics->series > 0.0)) {
        errors.current = route->dynamics->linear ? l->scales.motional * errors.velocity : l->motional;
    }
    dea_scales_tell(&l->scales, samples, route->samples, errors, 0.0, summary);
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
    dea_pace pace = dea_pace_of(d, isnan(d->rest) ? 0.0 : d->rest, 0.0);
    if (dea_dynamics_equilibrium(d, signal->largest, &u)) {
        const dea_pace other = dea_pace_of(d, u, signal->largest);
        pace.omega = fmax(pace.omega, other.omega);
        pace.decay = other.omega > 0.0 ? fmin(pace.decay, other.decay) : pace.decay;
        pace.fastest = fmin(pace.fastest, other.fastest);
    }
    return pace;
}

/* Largest voltage that the film can see: behind a series resistance no more than the charge that gets there allows. */
static double film_voltage(dea_dynamics *d, const dea_transient *transient, const dea_signal *signal)
{
    if (!(d->series > 0.0)) {
        return signal->largest;
    }
    double area = 0.0; /* of |U| over time [V s] */
    const double first = transient->from_bias ? fabs(signal->segments[0].start) : 0.0;
    for (size_t i = 0; i < signal->count; i++) {
        const dea_segment *s = &signal->segments[i];
        area += (s->to - s->from) * dea_segment_largest(signal, s);
    }
    return fmin(signal->largest, first + area / (d->series * dea_dynamics_edge(d, 0.0).capacitance));
}

/* r/K of damper and load at rest [s]. */
static double damper_time(dea_dynamics *d)
{
    const dea_edge e = dea_dynamics_edge(d, 0.0);
    return d->retardation + d->damping / fabs(dea_edge_held_slope(d, &e, NULL));
}

/* A displacement that is large for this run: the film may be too viscous or too heavy to follow within it [m]. */
static double scale_of(dea_dynamics *d, const dea_transient *transient, double voltage)
{
    const double still = dea_dynamics_scale(d, voltage);
    const double time = transient->until;
    double share = 1.0;
    if (transient->from_bias || d->rest != 0.0) {
        return still;
    }
    if (dea_dynamics_is_damped(d)) {
        share = fmin(share, time / damper_time(d));
    }
    if (d->mass > 0.0) {
        share = fmin(share, 0.5 * time * time * dea_dynamics_stiffness(d, 0.0, 0.0, false) / d->mass);
    }
    return share * still;
}

/* A point of a netlist stands at a time of the run, which tells no two of them apart within an edge that is very short beside it:
 * refused where the film is as fast. */
static dea_status can_tell_edges(const dea_route *route, const dea_pace *pace, dea_error *error)
{
    const dea_signal *signal = route->signal;
    for (size_t i = 0; i < signal->count; i++) {
        const dea_segment *s = &signal->segments[i];
        const double width = s->to - s->from;
        if (s->start != s->end && !s->sine && width < 1e4 * DBL_EPSILON * s->to && pace->fastest < 1e4 * width) {
            return dea_fail(error, DEA_ERROR_ENGINE,
                            "an edge of %.3g s at %.9g s is too short beside its time for the steps of ngspice; take --engine ida or a "
                            "longer rise",
                            width / route->unit, s->from / route->unit);
        }
    }
    return DEA_OK;
}

/* Most of the run over the fastest branch's time: what springs that are not linear lose in it then drowns in the library's
 * tolerance, and the balance of energies does not close, however fine the steps (measured). */
static const double most_decades = 1e11;

static dea_status can_see_branches(const dea_route *route, dea_error *error)
{
    const dea_dynamics *d = route->dynamics;
    const double until = route->scene->transient.until;
    const double fastest = d->branch_count > 0 ? d->branches[d->branch_count - 1].tau : (double)INFINITY;
    if (d->linear || until <= most_decades * fastest) {
        return DEA_OK;
    }
    return dea_fail(error, DEA_ERROR_ENGINE, "a branch of %.3g s in a run of %.3g s is too fast for the tolerances of ngspice; take --engine "
                    "ida",
                    fastest / route->unit, until / route->unit);
}

/* Rounding of the library's times and of the fitted mass turns a ring by so much of its angle: measured on undamped rings. */
static const double drift = 3e-12;

/* Refuses a ring that lives for too many periods. */
static dea_status can_keep_phase(const dea_route *route, const dea_pace *pace, dea_error *error)
{
    const double life = fmin(dea_pieces_ringing(route->pieces), pace->decay > 0.0 ? 1.0 / pace->decay : (double)INFINITY);
    const double angle = pace->omega > 0.0 ? pace->omega * life : 0.0;
    if (angle * drift <= route->scene->accuracy) {
        return DEA_OK;
    }
    return dea_fail(error, DEA_ERROR_ENGINE,
                    "the film rings for %.2g periods, over which ngspice loses a phase of %.1g, the scene wants an error of %g; "
                    "take --engine ida, a looser accuracy or a shorter run",
                    angle / (2.0 * DEA_PI), angle * drift, route->scene->accuracy);
}

/* A source at its limit has corners that only a run can tell: a first one does, and pieces are cut there, as behind all corners. */
static dea_status cut_at_limits(dea_route *route, dea_signal *signal, const dea_pace *pace, bool quiet, dea_pieces *pieces,
                                dea_error *error)
{
    dea_cuts cuts = {0};
    dea_track track;
    dea_route scout = *route;
    scout.cuts = &cuts;
    scout.most = 0.25 * most_work;
    dea_status status = dea_track_run(&scout, first_fineness(route->scene), &track, error);
    free(track.points);
    if (status == DEA_OK) {
        status = cuts.exhausted ? dea_fail(error, DEA_ERROR_MEMORY, "out of memory for the corners of a run")
                                : dea_signal_cut(signal, cuts.times, cuts.count, error);
    }
    free(cuts.times);
    if (status == DEA_OK) {
        free(pieces->pieces);
        status = dea_pieces_cut(signal, pace, route->scene->accuracy, route->scene->reduction.ring, quiet, pieces, error);
    }
    return status;
}

static dea_status run_on(dea_route *route, dea_signal *signal, dea_sample *samples, dea_summary *summary, dea_error *error)
{
    const dea_transient *transient = &route->scene->transient;
    const dea_pace pace = pace_of_run(route->dynamics, route->signal);
    const bool quiet = transient->from_bias || route->signal->segments[0].start == 0.0;
    dea_pieces pieces;
    levels l = {.error = INFINITY, .scales = dea_scales_open(route->scene, route->dynamics->model)};
    pieces.pieces = NULL;
    dea_status status = l.scales.status == DEA_ERROR_MEMORY ? dea_fail(error, DEA_ERROR_MEMORY, "out of memory for a run")
                                                            : DEA_OK;
    if (status == DEA_OK && !dea_peak_is_known(route->scene, route->dynamics, signal)) {
        status = dea_signal_thin(signal, route->scene, route->dynamics, l.scales.pace, error);
    }
    if (status == DEA_OK) {
        status = can_tell_edges(route, &pace, error);
    }
    if (status == DEA_OK) {
        status =
            dea_pieces_cut(route->signal, &pace, route->scene->accuracy, route->scene->reduction.ring, quiet, &pieces, error);
    }
    route->pieces = &pieces;
    route->omega = pace.omega;
    route->peaks = dea_peak_is_known(route->scene, route->dynamics, route->signal);
    route->voltage = film_voltage(route->dynamics, transient, route->signal);
    route->scale = scale_of(route->dynamics, transient, route->voltage);
    if (status == DEA_OK) {
        status = can_keep_phase(route, &pace, error);
    }
    if (status == DEA_OK) {
        status = can_see_branches(route, error);
    }
    if (status == DEA_OK && isfinite(route->dynamics->limit)) {
        status = cut_at_limits(route, signal, &pace, quiet, &pieces, error);
    }
    if (status == DEA_OK) {
        status = refine(route, &l, &pace, summary, error);
    }
    if (status == DEA_OK) {
        fill_samples(route, &l, samples);
        tell_rates(route, &l, samples, summary);
    }
    free(l.coarse.points);
    free(l.fine.points);
    free(l.before.points);
    free(pieces.pieces);
    return status;
}

/* Runs a scene whose numbers are of size 1; @p unit is that of its times. */
static dea_status run_inside(dea_ngspice *library, const dea_scene *scene, const dea_model *model, double unit,
                             dea_sample *samples, dea_summary *summary, dea_error *error)
{
    dea_dynamics dynamics;
    dea_mobility mobility;
    dea_signal signal = {0};
    dea_status status = dea_mobility_prepare(scene, model, dea_analogy_at(0), &dynamics, &mobility, error);
    if (status == DEA_OK) {
        status = dea_signal_open(scene, &signal, error);
    }
    if (status == DEA_OK) {
        dea_dynamics slow = dynamics; /* borrows what the other owns */
        slow.mass = 0.0;
        slow.retardation = dynamics.mass > 0.0 ? 0.0 : dynamics.retardation;
        slow.damping = dynamics.mass > 0.0 ? 0.0 : dynamics.damping;
        dea_route route = {.library = library,
                           .slow = &slow,
                           .scene = scene,
                           .dynamics = &dynamics,
                           .mobility = &mobility,
                           .signal = &signal,
                           .unit = unit,
                           .samples = dea_layout_of(scene).rows};
        status = run_on(&route, &signal, samples, summary, error);
    }
    dea_signal_close(&signal);
    dea_mobility_close(&mobility);
    dea_dynamics_close(&dynamics);
    return status;
}

/* The film's own time: of its ring, of its damper, or else that of the run [s]. */
static double own_time(dea_dynamics *d, const dea_scene *scene)
{
    if (d->mass > 0.0) {
        return sqrt(d->mass / fabs(dea_dynamics_stiffness(d, 0.0, 0.0, false)));
    }
    return dea_dynamics_is_damped(d) ? damper_time(d) : scene->transient.until;
}

dea_status dea_ngspice_units(const dea_scene *scene, const dea_model *model, dea_units *units, dea_error *error)
{
    dea_dynamics dynamics;
    dea_signal signal = {0};
    dea_status status = dea_dynamics_open(scene, model, &dynamics, error);
    if (status == DEA_OK) {
        status = dea_signal_open(scene, &signal, error);
    }
    if (status == DEA_OK) {
        const double voltage = film_voltage(&dynamics, &scene->transient, &signal);
        const double scale = scale_of(&dynamics, &scene->transient, voltage);
        dea_dynamics_lighten(&dynamics, scene->accuracy);
        const dea_sizes sizes = {.displacement = scale,
                                 .voltage = voltage,
                                 .time = own_time(&dynamics, scene)};
        *units = dea_units_of(&dynamics, &sizes);
    }
    dea_signal_close(&signal);
    dea_dynamics_close(&dynamics);
    return status;
}

dea_status dea_ngspice_transient(dea_ngspice *library, const dea_scene *scene, const dea_model *model, dea_sample *samples,
                                 dea_summary *summary, dea_error *error)
{
    dea_units units;
    dea_scene inside;
    *summary = dea_summary_failed();
    dea_status status = (model->membrane ? dea_ngspice_units_rings : dea_ngspice_units)(scene, model, &units, error);
    if (status == DEA_OK) {
        status = dea_units_enter(&units, scene, &inside, error);
    }
    if (status != DEA_OK) {
        return status;
    }
    status = model->membrane ? dea_ngspice_transient_rings(library, &inside, model, samples, summary, error)
                             : run_inside(library, &inside, model, units.time, samples, summary, error);
    dea_units_leave(&inside);
    if (status != DEA_OK) {
        return status;
    }
    for (size_t i = 0; i < dea_layout_of(scene).rows; i++) {
        dea_units_return_sample(&units, &samples[i]);
    }
    dea_units_return_summary(&units, summary);
    return DEA_OK;
}
