#include "engine/ida/flight.h"

#include <float.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

/* Steps of all runs after which they are given up: about half a minute. */
enum { MOST_STEPS = 3000000 };

/* So many steps that add no more than such a share to the time: the motion gets infinitely fast there. */
enum { CRAWL_STEPS = 1000 };
static const double crawl = 1e-9;

/* Share of its size below which an unknown needs a smaller one. */
static const double small = 0.03;

dea_status dea_flight_open(const dea_sundials *sun, const dea_scene *scene, dea_dynamics *dynamics, const dea_signal *signal,
                           dea_flight *flight, dea_error *error)
{
    *flight = (dea_flight){.scene = scene, .signal = signal, .rows = dea_layout_of(scene).rows};
    flight->peaks = dea_peak_is_known(scene, dynamics, signal);
    dea_motion_open(dynamics, signal, &flight->motion);
    flight->swing = calloc(1, sizeof *flight->swing);
    if (!flight->swing) {
        return dea_fail(error, DEA_ERROR_MEMORY, "out of memory while IDA starts");
    }
    return dea_flight_integrator(sun, flight, error);
}

void dea_flight_close(dea_flight *flight)
{
    if (flight->between) {
        flight->integrator.sun->N_VDestroy(flight->between);
    }
    dea_integrator_close(&flight->integrator);
    free(flight->swing);
    *flight = (dea_flight){0};
}

double dea_flight_next_sample(const dea_flight *flight)
{
    const size_t next = flight->trace->count;
    return next < flight->rows ? dea_layout_place(flight->scene, next) : (double)INFINITY;
}

/* Sees how far the unknowns get: at steps, and at samples too, since the steps of a turning frame may all lie whole periods
 * apart. */
static void reach(dea_flight *flight, const double *y)
{
    for (int i = 0; i < flight->motion.count; i++) {
        flight->reach[i] = fmax(flight->reach[i], fabs(y[i]));
    }
}

bool dea_flight_record(dea_flight *flight, double time, const double *y)
{
    dea_motion seen = flight->motion;
    const double at = seen.segment->from + time;
    seen.segment = dea_segment_seen(seen.segment, at);
    dea_moment moment = dea_motion_moment(&seen, at - seen.segment->from, y);
    if (!dea_motion_inside(&flight->motion, moment.u)) {
        return false;
    }
    dea_dynamics_start(flight->motion.dynamics, &moment);
    reach(flight, y);
    flight->trace->moments[flight->trace->count++] = moment;
    return true;
}

/* Sizes of unknowns that reached no more than @p most of them; what is below the tolerance of that run says little. */
static bool shrink(double *size, int count, double most, double tolerance)
{
    if (!(most > 0.0) || most >= small) {
        return false;
    }
    for (int i = 0; i < count; i++) {
        size[i] *= fmax(most, 10.0 * tolerance);
    }
    return true;
}

bool dea_flight_fit(dea_flight *flight)
{
    dea_motion *motion = &flight->motion;
    const int mechanical = motion->q >= 0 ? motion->q : motion->count;
    double most = 0.0;
    for (int i = 0; i < mechanical; i++) {
        most = fmax(most, flight->reach[i]);
    }
    const bool shrinks = shrink(motion->size, mechanical, most, flight->tolerance);
    return (motion->q >= 0 && shrink(motion->size + motion->q, 1, flight->reach[motion->q], flight->tolerance)) || shrinks;
}

/* The time stands still. A film that gets ever faster runs away, as a material that has lost its stiffness lets it, with mass or
 * with a damper that has vanished with it: there is no motion behind that. */
static dea_state stand_still(dea_flight *flight, double time)
{
    const dea_motion *motion = &flight->motion;
    double f[DEA_MOTION_MOST];
    const bool away = motion->v < 0 || !dea_motion_rates(motion, time, flight->y, f) || f[motion->v] * flight->y[motion->v] > 0.0;
    return away ? DEA_STATE_PULL_IN : dea_flight_broke(flight, "SUNDIALS", 0, time);
}

dea_state dea_flight_step(dea_flight *flight, double time, const double *w)
{
    dea_trace *trace = flight->trace;
    dea_rotation_state(flight->swing, dea_rotation_turn(flight->swing, time, 0.0), w, flight->y);
    const dea_moment at = dea_motion_moment(&flight->motion, time, flight->y);
    if (dea_motion_inside(&flight->motion, at.u)) {
        trace->largest_u = fmax(trace->largest_u, fabs(at.u));
        trace->largest_v = fmax(trace->largest_v, fabs(at.v));
    }
    reach(flight, flight->y);
    flight->steps++;
    if (++flight->spent > MOST_STEPS) {
        dea_fail(&flight->why, DEA_ERROR_ENGINE, "at a tolerance of %.1g, %ld steps of SUNDIALS take the run to %g s",
                 flight->tolerance, flight->steps, at.time);
        return DEA_STATE_FAILED;
    }
    if (++flight->unseen < CRAWL_STEPS) {
        return DEA_STATE_OK;
    }
    const double passed = time - flight->crawled;
    flight->crawled = time;
    flight->unseen = 0;
    return passed > crawl * time ? DEA_STATE_OK : stand_still(flight, time);
}

/* Next to its limit a source counts as there: such shares of the drop at the limit are rounding. */
static const double at_limit = 1e-9;
enum { HALVES = 60 }; /* of a step that find the time */

/* How far the drop over the resistance is past that at which the source gives its limit, over that; NAN without a state. */
static double excess_at(const dea_flight *flight, double time, dea_flight_state *at, void *user)
{
    double y[DEA_MOTION_MOST];
    if (!at(user, time, y)) {
        return (double)NAN;
    }
    const dea_moment moment = dea_motion_moment(&flight->motion, time, y);
    return dea_dynamics_excess(flight->motion.dynamics, moment.source - moment.voltage);
}

double dea_flight_cut(dea_flight *flight, double before, double time, dea_flight_state *at, void *user)
{
    if (!isfinite(flight->motion.dynamics->limit)) {
        return time;
    }
    const double first = excess_at(flight, before, at, user), last = excess_at(flight, time, at, user);
    if (!(first * last < 0.0) || fabs(first) < at_limit) {
        return time;
    }
    double low = before, high = time;
    for (int i = 0; i < HALVES && high - low > DBL_EPSILON * high; i++) {
        const double middle = 0.5 * (low + high);
        *(excess_at(flight, middle, at, user) * first > 0.0 ? &low : &high) = middle;
    }
    const double begin = flight->motion.segment->from;
    flight->cut = high < time && begin + high > begin + before; /* late in a run a very short time is none */
    flight->cut_at = high;
    return flight->cut ? high : time;
}

bool dea_flight_affords(dea_flight *flight, double steps)
{
    const double left = (double)(MOST_STEPS - flight->spent);
    if (steps <= left) {
        return true;
    }
    dea_fail(&flight->why, DEA_ERROR_ENGINE, "the swing takes %.2g more steps of SUNDIALS at a tolerance of %.1g, %.2g are left",
             steps, flight->tolerance, left);
    return false;
}

dea_state dea_flight_broke(dea_flight *flight, const char *solver, int code, double time)
{
    dea_fail(&flight->why, DEA_ERROR_ENGINE, "at a tolerance of %.1g, %s stopped at %g s with its error %d", flight->tolerance,
             solver, flight->motion.segment->from + time, code);
    return DEA_STATE_FAILED;
}

/* An algebraic u at the begin of a segment. */
static bool jump(dea_flight *flight)
{
    double z[DEA_RELAXED_MAX];
    const double before = flight->y[0] * flight->motion.size[0];
    if (!dea_motion_jump(&flight->motion, flight->y)) {
        return false;
    }
    const double after = flight->y[0] * flight->motion.size[0];
    if (flight->audit && after != before) {
        dea_motion_branches(&flight->motion, flight->y, z);
        dea_audit_jump(flight->audit, flight->motion.dynamics, before, after, z);
    }
    return true;
}

/* A segment that stands for lines is short: up to so many times of the fastest motion Runge-Kutta costs less than a start of BDF. */
static const double brief = 100.0;

/* Runge-Kutta's states between steps are too coarse to cut at. */
static bool suits(const dea_flight *flight)
{
    const dea_rotation *swing = flight->swing;
    if (isfinite(flight->motion.dynamics->limit)) {
        return false;
    }
    const dea_segment *segment = flight->motion.segment;
    if (segment->terms) {
        return swing->stiffest * (segment->to - segment->from) <= brief;
    }
    if (segment->lines && segment->corner) {
        return true;
    }
    const bool linear = flight->motion.dynamics->linear && flight->motion.q < 0;
    return swing->light && !(linear && swing->turns) && swing->fastest <= 5.0 * swing->omega;
}

/* Radians of a swing, and times of the fastest motion of another film, up to which a line costs Runge-Kutta no more than a start of
 * its own. */
static const double short_line = 20.0, short_of_fastest = 8.0;

double dea_flight_short_line(dea_flight *flight)
{
    const dea_segment *first = flight->motion.segment;
    const dea_segment whole = {.to = flight->scene->transient.until, .start = first->start, .end = first->start, .sine = true};
    if (!dea_motion_start(&flight->motion, flight->scene->transient.from_bias, flight->y)) {
        return 0.0;
    }
    flight->motion.segment = &whole;
    dea_rotation_find(&flight->motion, flight->swing);
    flight->motion.segment = first;
    if (isfinite(flight->motion.dynamics->limit)) {
        return 0.0;
    }
    return suits(flight) ? short_line / flight->swing->omega : flight->swing->light ? 0.0 : short_of_fastest / flight->swing->stiffest;
}

/* How long a swing is worth an explicit method in the segment [s]: until it is smaller than what the tolerance sees, if its
 * periods are no more than a run can take and nothing else is much faster. */
static double explicit_time(const dea_flight *flight)
{
    const dea_rotation *swing = flight->swing;
    const dea_segment *segment = flight->motion.segment;
    const double width = segment->to - segment->from;
    if (!suits(flight)) {
        return 0.0;
    }
    if (segment->corner || segment->terms) {
        return width; /* they never let the swing die */
    }
    const double life = fmin(width, log(10.0 / flight->tolerance) / swing->decay);
    return swing->turns || swing->omega * life < 1e6 ? life : 0.0;
}

/* The segment, or what it is up to where it is cut. */
static dea_state fly_part(dea_flight *flight)
{
    const dea_segment *segment = flight->motion.segment;
    if (!jump(flight) || (flight->trace->count == 0 && !dea_flight_record(flight, 0.0, flight->y))) {
        return DEA_STATE_PULL_IN;
    }
    dea_rotation_find(&flight->motion, flight->swing);
    const double turning = explicit_time(flight);
    if (turning > 0.0) {
        const dea_state state = dea_flight_explicit(flight, turning);
        if (state != DEA_STATE_OK || turning >= segment->to - segment->from) {
            return state;
        }
        dea_rotation_stop(flight->swing);
    }
    return dea_flight_implicit(flight, turning);
}

/* All parts of the segment; what of it is left behind a cut is a segment of its own, @p part. */
static dea_state fly_segment(dea_flight *flight, dea_segment *part)
{
    dea_state state;
    flight->motion.segment = part;
    do {
        flight->crawled = 0.0;
        flight->unseen = 0;
        flight->cut = false;
        state = fly_part(flight);
        if (flight->cut) {
            const double from = part->from + flight->cut_at;
            part->start = dea_segment_voltage(flight->signal, part, from);
            part->from = from;
        }
    } while (state == DEA_STATE_OK && flight->cut && part->from < part->to);
    return state;
}

void dea_flight_run(dea_flight *flight, double tolerance, dea_trace *trace, dea_summary *summary)
{
    dea_audit audit = {0};
    dea_segment part;
    double first_z[DEA_RELAXED_MAX], z[DEA_RELAXED_MAX];
    *trace = (dea_trace){.moments = trace->moments};
    flight->trace = trace;
    flight->audit = summary ? &audit : NULL;
    flight->tolerance = tolerance;
    flight->steps = 0;
    flight->motion.segment = flight->signal->segments;
    if (!dea_motion_start(&flight->motion, flight->scene->transient.from_bias, flight->y)) {
        trace->end = DEA_STATE_PULL_IN;
        return;
    }
    memset(flight->reach, 0, sizeof flight->reach);
    reach(flight, flight->y);
    const dea_moment first = dea_motion_moment(&flight->motion, 0.0, flight->y);
    dea_motion_branches(&flight->motion, flight->y, first_z);
    for (size_t i = 0; trace->end == DEA_STATE_OK && i < flight->signal->count; i++) {
        part = flight->signal->segments[i];
        trace->end = fly_segment(flight, &part);
    }
    if (summary && trace->end == DEA_STATE_OK) {
        const dea_segment *segment = flight->motion.segment;
        const dea_moment last = dea_motion_moment(&flight->motion, segment->to - segment->from, flight->y);
        dea_motion_branches(&flight->motion, flight->y, z);
        dea_audit_close(&audit, flight->motion.dynamics, &first, first_z, &last, z, summary);
    }
}
