/* A swing by ARKODE: Verner's explicit Runge-Kutta method of order 6, from sample to sample. (Fehlberg's of order 8 cannot see the
 * error of a pure integral, and the module ERKStep of SUNDIALS 6 takes the last stage of either for the first of the next step.)
 * In an audited run the energies are unknowns too, and where means are wanted the integral of the displacement. */
#include <math.h>

#include "engine/ida/flight.h"

/* Steps that tell how many more will be. */
static const double enough = 20000.0;

enum { WORK, DISSIPATED, BRANCH, ENERGIES };

typedef struct explicit_run {
    dea_flight *flight; /* borrowed */
    double energy;      /* size of energies [J] */
    int audited;        /* unknowns behind those of the motion: energies */
    int integrated;     /* and the integral of u omega, in units of u */
    double integral;    /* of that up to the last stop */
    long before;        /* steps of the run before this one */
    size_t line;        /* of a run of lines: that of the last stop */
    N_Vector w;         /* owned, as all below: unknowns, then energies */
    N_Vector tolerance, between;
    void *ark;
} explicit_run;

/* Powers at y in units of the run. */
static void powers(const explicit_run *run, double time, const double *y, double *out)
{
    const dea_flight *flight = run->flight;
    double z[DEA_RELAXED_MAX];
    dea_audit rate = {0};
    const dea_moment moment = dea_motion_moment(&flight->motion, time, y);
    dea_motion_branches(&flight->motion, y, z);
    dea_audit_add(&rate, flight->motion.dynamics, &moment, z, 1.0);
    out[WORK] = rate.work / run->energy;
    out[DISSIPATED] = rate.dissipated / run->energy;
    out[BRANCH] = rate.branch / run->energy;
}

static int rates(sunrealtype time, N_Vector w, N_Vector wp, void *user)
{
    const explicit_run *run = user;
    const dea_flight *flight = run->flight;
    const sunrealtype *unknowns = NV_DATA_S(w);
    sunrealtype *out = NV_DATA_S(wp);
    const dea_turn turn = dea_rotation_turn(flight->swing, time, 0.0);
    double y[DEA_MOTION_MOST], f[DEA_MOTION_MOST];
    dea_rotation_state(flight->swing, turn, unknowns, y);
    if (!dea_motion_rates(&flight->motion, time, y, f)) {
        return 1;
    }
    dea_rotation_rates(flight->swing, turn, unknowns, f, out);
    if (run->audited > 0) {
        powers(run, time, y, out + flight->motion.count);
    }
    if (run->integrated > 0) {
        out[flight->motion.count + run->audited] = y[0] * flight->swing->omega;
    }
    return 0;
}

/* Fewest steps over a polynomial of the 11th degree that stands for lines: those that hold a whole turn of it pass the test of their
 * error by chance, so that the error hardly falls with the tolerance. */
static const double parts = 8.0;

/* Longest step [s]: samples cut steps, and where they alone did, a tighter tolerance would change nothing that a comparison of
 * two runs could see. In a frame that does not turn, no more than a part of the swing either. */
static double longest_step(const dea_flight *flight)
{
    const dea_rotation *swing = flight->swing;
    const double tolerance = flight->tolerance;
    const dea_segment *segment = flight->motion.segment;
    const double lines = segment->step, every = flight->scene->transient.every;
    const double whole = segment->terms ? fmin(every, (segment->to - segment->from) / parts) : every;
    double sampled = whole * pow(tolerance / flight->loosest, 1.0 / 7.0);
    sampled = lines > 0.0 ? fmin(sampled, lines) : sampled;
    return swing->turns ? sampled : fmin(sampled, fmin(1.2, 6.0 * pow(tolerance, 1.0 / 7.0)) / swing->omega);
}

static bool begin(explicit_run *run)
{
    dea_flight *flight = run->flight;
    const int n = flight->motion.count;
    const dea_sundials *sun = flight->integrator.sun;
    run->w = dea_sundials_vector(sun, (size_t)(n + run->audited + run->integrated));
    run->tolerance = run->w ? sun->N_VClone(run->w) : NULL;
    run->between = run->w ? sun->N_VClone(run->w) : NULL;
    if (!run->tolerance || !run->between) {
        return false;
    }
    sun->N_VConst(0.0, run->w);
    sun->N_VConst(flight->tolerance, run->tolerance);
    dea_rotation_unknowns(flight->swing, dea_rotation_turn(flight->swing, 0.0, 0.0), flight->y, NV_DATA_S(run->w));
    for (int i = 0; i < run->audited; i++) {
        NV_DATA_S(run->tolerance)[n + i] = 1e-3 * flight->scene->accuracy;
    }
    run->ark = dea_sundials_verner(sun, rates, run->w, flight->tolerance, run->tolerance, longest_step(flight), run);
    return run->ark != NULL;
}

/* True where the swing will take more steps than there are, told from those so far; they get longer as it decays. */
static bool endless(const explicit_run *run, double to, double time)
{
    dea_flight *flight = run->flight;
    const double steps = (double)(flight->steps - run->before);
    if (steps < enough) {
        return false;
    }
    const double rest = fmin(to - time, 3.0 / flight->swing->decay);
    return !dea_flight_affords(flight, 0.7 * steps * rest / time);
}

/* The first end of a window behind a time of the segment, at the most @p to. */
static double next_end(const dea_flight *flight, double time, double to)
{
    const dea_transient *transient = &flight->scene->transient;
    for (size_t i = 0; i < transient->average_count; i++) {
        const double ends[] = {transient->averages[i].from, transient->averages[i].to};
        for (int k = 0; k < 2; k++) {
            const double at = ends[k] - flight->motion.segment->from;
            to = at > time && at < to ? at : to;
        }
    }
    return to;
}

/* The first corner of a run of lines behind a time of the segment, at the most @p to. */
static double next_corner(explicit_run *run, double time, double to)
{
    const dea_segment *segment = run->flight->motion.segment;
    for (; run->line < segment->line_count; run->line++) {
        const double at = segment->lines[run->line].to - segment->from;
        if (at > time && segment->lines[run->line].corner) {
            return fmin(at, to);
        }
        if (at >= to) {
            return to;
        }
    }
    return to;
}

/* Adds what a stretch between two stops does to the windows: but for rounding it lies inside of each, or outside. */
static void integrate(explicit_run *run, double before, double time)
{
    dea_flight *flight = run->flight;
    const dea_motion *motion = &flight->motion;
    const double middle = motion->segment->from + 0.5 * (before + time);
    const double whole = run->integrated > 0 ? NV_DATA_S(run->w)[motion->count + run->audited] : 0.0;
    for (size_t i = 0; i < flight->scene->transient.average_count; i++) {
        const dea_window *window = &flight->scene->transient.averages[i];
        if (window->from < middle && middle < window->to) {
            flight->trace->integrals[i] += (whole - run->integral) * motion->size[0] / flight->swing->omega;
        }
    }
    run->integral = whole;
}

/* Current at a time of the last step, counted over the run [A]. */
static double current_at(void *user, double time)
{
    explicit_run *run = user;
    dea_flight *flight = run->flight;
    const double at = time - flight->motion.segment->from;
    double y[DEA_MOTION_MOST];
    if (flight->integrator.sun->DEA_ARK(GetDky)(run->ark, at, 0, run->between) != ARK_SUCCESS) {
        return 0.0;
    }
    dea_rotation_state(flight->swing, dea_rotation_turn(flight->swing, at, 0.0), NV_DATA_S(run->between), y);
    const dea_moment moment = dea_motion_moment(&flight->motion, at, y);
    return dea_dynamics_current(flight->motion.dynamics, &moment);
}

static void see_current(explicit_run *run, double before, double time)
{
    dea_flight *flight = run->flight;
    if (flight->peaks && time > before) {
        const double begin = flight->motion.segment->from;
        dea_peak_search(&flight->trace->peak, begin + before, begin + time, current_at, run);
    }
}

/* Steps to the next sample or end of a window, or to the end if that is nearer. */
static dea_state advance(explicit_run *run, double to, double *time)
{
    dea_flight *flight = run->flight;
    const dea_sundials *sun = flight->integrator.sun;
    const dea_segment *segment = flight->motion.segment;
    const double next = dea_flight_next_sample(flight), before = *time;
    const double end = next_corner(run, before, next_end(flight, before, to));
    const bool sampled = next <= segment->to && next - segment->from <= end;
    const double stop = sampled ? fmax(before, next - segment->from) : end;
    for (int code = ARK_SUCCESS; *time < stop && code != ARK_TSTOP_RETURN;) {
        const double last = *time;
        code = sun->DEA_ARK(SetStopTime)(run->ark, stop);
        code = code == ARK_SUCCESS ? sun->DEA_ARK(Evolve)(run->ark, stop, run->w, time, ARK_ONE_STEP) : code;
        if (code < 0) {
            const bool gone = code == ARK_REPTD_RHSFUNC_ERR || code == ARK_FIRST_RHSFUNC_ERR || code == ARK_UNREC_RHSFUNC_ERR;
            return gone ? DEA_STATE_PULL_IN : dea_flight_broke(flight, "ARKODE", code, *time);
        }
        const dea_state state = dea_flight_step(flight, *time, NV_DATA_S(run->w));
        if (state != DEA_STATE_OK || endless(run, to, *time)) {
            return state != DEA_STATE_OK ? state : DEA_STATE_FAILED;
        }
        see_current(run, last, *time);
    }
    integrate(run, before, stop);
    return !sampled || dea_flight_record(flight, stop, flight->y) ? DEA_STATE_OK : DEA_STATE_PULL_IN;
}

static void close_energies(const explicit_run *run, double time)
{
    dea_flight *flight = run->flight;
    const double *energy = NV_DATA_S(run->w) + flight->motion.count;
    double z[DEA_RELAXED_MAX];
    const dea_moment moment = dea_motion_moment(&flight->motion, time, flight->y);
    dea_motion_branches(&flight->motion, flight->y, z);
    flight->audit->work += energy[WORK] * run->energy;
    flight->audit->dissipated += energy[DISSIPATED] * run->energy;
    flight->audit->branch += energy[BRANCH] * run->energy;
    dea_audit_add(flight->audit, flight->motion.dynamics, &moment, z, 0.0);
}

dea_state dea_flight_explicit(dea_flight *flight, double to)
{
    const dea_motion *motion = &flight->motion;
    const dea_sundials *sun = flight->integrator.sun;
    explicit_run run = {
        .flight = flight, .before = flight->steps, .energy = motion->stiffness * motion->size[0] * motion->size[0]};
    run.audited = flight->audit ? ENERGIES : 0;
    run.integrated = flight->scene->transient.average_count > 0 ? 1 : 0;
    dea_state state = begin(&run) ? DEA_STATE_OK : DEA_STATE_FAILED;
    double time = 0.0;
    while (state == DEA_STATE_OK && time < to) {
        state = advance(&run, to, &time);
    }
    if (state == DEA_STATE_OK && flight->audit) {
        close_energies(&run, time);
    }
    if (run.ark) {
        sun->DEA_ARK(Free)(&run.ark);
    }
    if (run.tolerance) {
        sun->N_VDestroy(run.tolerance);
    }
    if (run.between) {
        sun->N_VDestroy(run.between);
    }
    if (run.w) {
        sun->N_VDestroy(run.w);
    }
    return state;
}
