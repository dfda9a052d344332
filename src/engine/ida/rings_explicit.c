/* A segment of a membrane by ARKODE: Verner's explicit Runge-Kutta method of order 6, from sample to sample. In an audited run the
 * energies are unknowns too, and where means are wanted the integral of the displacement. */
#include <math.h>
#include <string.h>

#include "engine/ida/rings_solver.h"

/* Steps that tell how many more will be. */
static const double enough = 5000.0;

enum { WORK, DISSIPATED, BRANCH, ENERGIES };

typedef struct explicit_run {
    dea_rings_solver *solver; /* borrowed */
    double energy;            /* size of energies [J] */
    size_t audited;           /* unknowns behind those of the motion: energies */
    size_t integrated;        /* and the integral of u omega */
    double integral;          /* of that up to the last stop */
    double to;                /* its end [s] */
    long before;              /* steps of the run before this one */
    N_Vector w, tolerances, between, slope; /* owned, as all below: unknowns, then energies */
    void *ark;
} explicit_run;

/* Powers at the state that the flight has looked at, in units of the run. */
static void powers(const explicit_run *run, double time, const double *y, const double *rates, double *out)
{
    const dea_rings_flight *f = &run->solver->flight;
    dea_audit rate = {0};
    const dea_moment moment = dea_rings_moment(&f->motion, time, &f->state);
    (void)rates;
    dea_membrane_audit_add(&rate, &f->membrane, &f->state.look, &moment, y + f->motion.nodes, y + f->motion.z, 1.0);
    out[WORK] = rate.work / run->energy;
    out[DISSIPATED] = rate.dissipated / run->energy;
    out[BRANCH] = rate.branch / run->energy;
}

static int rates_of(sunrealtype time, N_Vector w, N_Vector wp, void *user)
{
    const explicit_run *run = user;
    dea_rings_flight *f = &run->solver->flight;
    const dea_rings_motion *m = &f->motion;
    const sunrealtype *y = NV_DATA_S(w);
    sunrealtype *out = NV_DATA_S(wp);
    if (!dea_rings_look(m, time, y, y + m->nodes, &f->state)) {
        return 1;
    }
    dea_rings_relaxing(m, &f->state, y, out);
    for (size_t n = 0; n < m->nodes; n++) {
        out[n] = y[m->nodes + n];
        out[m->nodes + n] = f->state.force[n] / f->membrane.masses[n];
    }
    if (run->audited > 0) {
        powers(run, time, y, out, out + m->count);
    }
    if (run->integrated > 0) {
        out[m->count + run->audited] = y[f->membrane.rings.edge] * m->rest.slowest;
    }
    return 0;
}

/* Longest step [s]: samples cut steps, and where they alone did, a tighter tolerance would change nothing that a comparison of two
 * runs could see. */
static double longest_step(const dea_rings_solver *s)
{
    const dea_rings_flight *f = &s->flight;
    const double sampled = f->scene->transient.every * pow(f->tolerance / s->loosest, 1.0 / 7.0), lines = f->motion.segment->step;
    return lines > 0.0 ? fmin(sampled, lines) : sampled;
}

static bool begin(explicit_run *run)
{
    dea_rings_flight *f = &run->solver->flight;
    const dea_sundials *sun = run->solver->sun;
    const size_t count = f->motion.count;
    run->w = dea_sundials_vector(sun, count + run->audited + run->integrated);
    run->tolerances = run->w ? sun->N_VClone(run->w) : NULL;
    run->between = run->w ? sun->N_VClone(run->w) : NULL;
    run->slope = run->w ? sun->N_VClone(run->w) : NULL;
    if (!run->tolerances || !run->between || !run->slope) {
        return false;
    }
    sun->N_VConst(0.0, run->w);
    sun->N_VConst(f->tolerance * f->motion.length, run->tolerances);
    memcpy(NV_DATA_S(run->w), NV_DATA_S(run->solver->y), count * sizeof(sunrealtype));
    memcpy(NV_DATA_S(run->tolerances), NV_DATA_S(run->solver->tolerances), count * sizeof(sunrealtype));
    for (size_t i = 0; i < run->audited; i++) {
        NV_DATA_S(run->tolerances)[count + i] = 1e-2 * f->scene->accuracy;
    }
    run->ark = dea_sundials_verner(sun, rates_of, run->w, f->tolerance, run->tolerances, longest_step(run->solver), run);
    return run->ark != NULL;
}

/* The first end of a window behind a time of the segment, at the most @p to. */
static double next_end(const dea_rings_flight *f, double time, double to)
{
    const dea_transient *transient = &f->scene->transient;
    for (size_t i = 0; i < transient->average_count; i++) {
        const double ends[] = {transient->averages[i].from, transient->averages[i].to};
        for (int k = 0; k < 2; k++) {
            const double at = ends[k] - f->motion.segment->from;
            to = at > time && at < to ? at : to;
        }
    }
    return to;
}

/* Adds what a stretch between two stops does to the windows: but for rounding it lies inside of each, or outside. */
static void integrate(explicit_run *run, double before, double time)
{
    dea_rings_flight *f = &run->solver->flight;
    const double middle = f->motion.segment->from + 0.5 * (before + time);
    const double whole = run->integrated > 0 ? NV_DATA_S(run->w)[f->motion.count + run->audited] : 0.0;
    for (size_t i = 0; i < f->scene->transient.average_count; i++) {
        const dea_window *window = &f->scene->transient.averages[i];
        if (window->from < middle && middle < window->to) {
            f->trace->integrals[i] += (whole - run->integral) / f->motion.rest.slowest;
        }
    }
    run->integral = whole;
}

/* Current at a time of the last step, counted over the run [A]. */
static double current_at(void *user, double time)
{
    explicit_run *run = user;
    dea_rings_flight *f = &run->solver->flight;
    const double at = time - f->motion.segment->from;
    if (run->solver->sun->DEA_ARK(GetDky)(run->ark, at, 0, run->between) != ARK_SUCCESS) {
        return 0.0;
    }
    return dea_rings_current(f, at, NV_DATA_S(run->between), NV_DATA_S(run->slope), false);
}

/* True where the swing will take more steps than there are, told from those so far; they get longer as it decays. */
static bool endless(const explicit_run *run, double time)
{
    dea_rings_flight *f = &run->solver->flight;
    const double steps = (double)(f->steps - run->before), decay = dea_rings_decay(&f->motion);
    const double rest = decay > 0.0 ? fmin(run->to - time, 3.0 / decay) : run->to - time;
    return steps >= enough && !dea_rings_affords(f, 0.7 * steps * rest / time);
}

/* Steps to a time of the segment. */
static dea_state step_to(explicit_run *run, double stop, double *time)
{
    dea_rings_flight *f = &run->solver->flight;
    const dea_sundials *sun = run->solver->sun;
    const double start = f->motion.segment->from;
    for (int code = ARK_SUCCESS; *time < stop && code != ARK_TSTOP_RETURN;) {
        const double last = *time;
        code = sun->DEA_ARK(SetStopTime)(run->ark, stop);
        code = code == ARK_SUCCESS ? sun->DEA_ARK(Evolve)(run->ark, stop, run->w, time, ARK_ONE_STEP) : code;
        if (code < 0) {
            const bool gone = code == ARK_REPTD_RHSFUNC_ERR || code == ARK_FIRST_RHSFUNC_ERR || code == ARK_UNREC_RHSFUNC_ERR;
            return gone ? DEA_STATE_PULL_IN : dea_rings_broke(f, "ARKODE", code, *time);
        }
        const dea_state state = dea_rings_step(f, *time, NV_DATA_S(run->w));
        if (state != DEA_STATE_OK || endless(run, *time)) {
            return state != DEA_STATE_OK ? state : DEA_STATE_FAILED;
        }
        if (f->peaks && *time > last) {
            dea_peak_search(&f->trace->peak, start + last, start + *time, current_at, run);
        }
    }
    return DEA_STATE_OK;
}

/* To the next sample or end of a window, or to the end if that is nearer. */
static dea_state advance(explicit_run *run, double to, double *time)
{
    dea_rings_flight *f = &run->solver->flight;
    const dea_segment *segment = f->motion.segment;
    const double next = dea_rings_next_sample(f), before = *time, end = next_end(f, before, to);
    const bool sampled = next <= segment->to && next - segment->from <= end;
    const double stop = sampled ? fmax(before, next - segment->from) : end;
    const dea_state state = step_to(run, stop, time);
    if (state != DEA_STATE_OK) {
        return state;
    }
    integrate(run, before, stop);
    const double *y = NV_DATA_S(run->w);
    return !sampled || dea_rings_record(f, stop, y, NV_DATA_S(run->slope), false) ? DEA_STATE_OK : DEA_STATE_PULL_IN;
}

static void close_energies(const explicit_run *run)
{
    const dea_rings_flight *f = &run->solver->flight;
    const double *energy = NV_DATA_S(run->w) + f->motion.count;
    f->audit->work += energy[WORK] * run->energy;
    f->audit->dissipated += energy[DISSIPATED] * run->energy;
    f->audit->branch += energy[BRANCH] * run->energy;
    f->audit->largest = fmax(f->audit->largest, fmax(fabs(f->audit->work), fabs(f->audit->dissipated)));
}

static void end(explicit_run *run)
{
    const dea_sundials *sun = run->solver->sun;
    N_Vector vectors[] = {run->tolerances, run->between, run->slope, run->w};
    if (run->ark) {
        sun->DEA_ARK(Free)(&run->ark);
    }
    for (size_t i = 0; i < sizeof vectors / sizeof *vectors; i++) {
        if (vectors[i]) {
            sun->N_VDestroy(vectors[i]);
        }
    }
}

dea_state dea_rings_explicit(dea_rings_solver *s, double to)
{
    dea_rings_flight *f = &s->flight;
    const double length = f->motion.length;
    const double stiffness = f->motion.rest.capacitance_slope / f->motion.rest.compliance; /* of a size that counts: F = K u */
    explicit_run run = {.solver = s, .to = to, .before = f->steps, .energy = length * length * stiffness};
    run.audited = f->audit ? ENERGIES : 0;
    run.integrated = f->scene->transient.average_count > 0 ? 1 : 0;
    dea_state state = begin(&run) ? DEA_STATE_OK : DEA_STATE_FAILED;
    f->derived = false;
    for (double time = 0.0; state == DEA_STATE_OK && time < to;) {
        state = advance(&run, to, &time);
    }
    if (run.ark) {
        memcpy(NV_DATA_S(s->y), NV_DATA_S(run.w), f->motion.count * sizeof(sunrealtype));
    }
    if (state == DEA_STATE_OK && f->audit) {
        close_energies(&run);
    }
    end(&run);
    return state;
}
