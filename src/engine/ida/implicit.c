/* A segment by IDA: residual, samples and energies between its steps. */
#include <math.h>
#include <string.h>

#include "engine/ida/flight.h"

/* Shares of the stiffness at rest: next to a fold, where steps no longer tell this side from the other, and so near to one that
 * it is the reason why IDA gave up. */
static const double folded = 1e-4;
static const double soft = 0.02;

/* Failures of one step after which a run is given up: the first step of a segment can be far too long. */
enum { MOST_FAILS = 40 };

static int residual(sunrealtype time, N_Vector w, N_Vector wp, N_Vector r, void *user)
{
    const dea_flight *flight = user;
    const sunrealtype *unknowns = NV_DATA_S(w);
    const sunrealtype *slope = NV_DATA_S(wp);
    sunrealtype *out = NV_DATA_S(r);
    const dea_turn turn = dea_rotation_turn(flight->swing, time, 0.0);
    double y[DEA_MOTION_MOST], f[DEA_MOTION_MOST];
    dea_rotation_state(flight->swing, turn, unknowns, y);
    if (!dea_motion_rates(&flight->motion, time, y, f)) {
        return 1; /* a trial step too far: IDA takes a shorter one */
    }
    dea_rotation_rates(flight->swing, turn, unknowns, f, out);
    for (int i = 0; i < flight->motion.count; i++) {
        out[i] = (i == 0 && flight->motion.algebraic ? 0.0 : slope[i]) - out[i];
    }
    return 0;
}

static int jacobian(sunrealtype time, sunrealtype cj, N_Vector w, N_Vector wp, N_Vector r, SUNMatrix matrix, void *user,
                    N_Vector work1, N_Vector work2, N_Vector work3)
{
    const dea_flight *flight = user;
    const int n = flight->motion.count;
    sunrealtype *data = SM_DATA_D(matrix);
    (void)wp, (void)r, (void)work1, (void)work2, (void)work3;
    if (flight->swing->turns) {
        memcpy(data, flight->swing->jacobian, (size_t)(n * n) * sizeof *data);
    } else {
        dea_motion_jacobian(&flight->motion, time, NV_DATA_S(w), data);
    }
    for (int i = 0; i < n * n; i++) {
        data[i] = -data[i];
    }
    for (int i = flight->motion.algebraic ? 1 : 0; i < n; i++) {
        data[i * n + i] += cj;
    }
    return 0;
}

dea_status dea_flight_integrator(const dea_sundials *sun, dea_flight *flight, dea_error *error)
{
    const dea_status status = dea_integrator_open(sun, flight->motion.count, residual, &flight->integrator, error);
    if (status != DEA_OK) {
        return status;
    }
    void *ida = flight->integrator.ida;
    flight->between = sun->N_VClone(flight->integrator.y);
    if (!flight->between || sun->IDASetJacFn(ida, jacobian) != IDA_SUCCESS || sun->IDASetUserData(ida, flight) != IDA_SUCCESS ||
        sun->IDASetMaxErrTestFails(ida, MOST_FAILS) != IDA_SUCCESS || sun->IDASetMaxConvFails(ida, MOST_FAILS) != IDA_SUCCESS) {
        return dea_fail(error, DEA_ERROR_ENGINE, "IDA did not start");
    }
    return DEA_OK;
}

/* w, or its derivative, at a time of the last step. */
static const double *unknowns_at(const dea_flight *flight, double time, int derivative)
{
    N_Vector w = flight->between;
    return flight->integrator.sun->IDAGetDky(flight->integrator.ida, time, derivative, w) == IDA_SUCCESS ? NV_DATA_S(w) : NULL;
}

/* The drop over a small R_s is a difference of almost equal voltages; over a step longer than R_s C IDA's own slope of the charge
 * is the better number: with y = X R(omega t) w + center, y' = X R (w' + omega (-w_1, w_0, 0, ...)). @p w is lost. */
static void take_current(const dea_flight *flight, double time, dea_turn turn, const double *w, dea_moment *moment)
{
    const dea_motion *motion = &flight->motion;
    const dea_rotation *swing = flight->swing;
    double step, rate[DEA_MOTION_MOST], y[DEA_MOTION_MOST];
    if (motion->q < 0 || flight->integrator.sun->IDAGetLastStep(flight->integrator.ida, &step) != IDA_SUCCESS ||
        step * motion->signal->largest < motion->dynamics->series * motion->size[motion->q] ||
        dea_dynamics_excess(motion->dynamics, moment->source - moment->voltage) >= 0.0) {
        return; /* at its limit the source gives that */
    }
    const double around[2] = {swing->turns ? -swing->omega * w[1] : 0.0, swing->turns ? swing->omega * w[0] : 0.0};
    const double *slope = unknowns_at(flight, time, 1);
    if (!slope) {
        return;
    }
    memcpy(rate, slope, (size_t)motion->count * sizeof *rate);
    for (int i = 0; swing->turns && i < 2; i++) {
        rate[i] += around[i];
    }
    dea_rotation_state(swing, turn, rate, y);
    moment->charging = true;
    moment->charge_slope = (y[motion->q] - (swing->turns ? swing->center[motion->q] : 0.0)) * motion->size[motion->q];
}

/* Steps, in the times of what relaxes and charges, from which on (S - z)/tau has lost the digits of u': an error of u grows in it by
 * 1/tau, in the slope of steps h by 1/h. Below, it has more: Newton's method leaves it less than a step leaves u. */
static const double stiff_step = 1e3;

/* True where IDA's own slope of u is the better number: where a damper alone sets the velocity, the force that drives it is a small
 * difference; where branches and charge do, what is left of them behind a long step. */
static bool slope_is_better(const dea_flight *flight)
{
    const dea_motion *motion = &flight->motion;
    double step = 0.0;
    if (motion->v >= 0 || (motion->algebraic && motion->count == 1)) {
        return false;
    }
    (void)flight->integrator.sun->IDAGetLastStep(flight->integrator.ida, &step);
    return !motion->algebraic || step * motion->pace > stiff_step;
}

static void take_velocity(const dea_flight *flight, double time, dea_moment *moment)
{
    const dea_motion *motion = &flight->motion;
    const bool thinned = motion->segment->terms && moment == &flight->trace->moments[flight->trace->count - 1];
    const double *slope = !thinned && slope_is_better(flight) ? unknowns_at(flight, time, 1) : NULL;
    if (slope) {
        moment->v = slope[0] * motion->size[0];
    }
}

/* Samples of the segment up to a time of it. */
static dea_state take_samples(dea_flight *flight, double time, bool last)
{
    const dea_segment *segment = flight->motion.segment;
    double y[DEA_MOTION_MOST];
    for (double next = dea_flight_next_sample(flight); next <= segment->to; next = dea_flight_next_sample(flight)) {
        const double at = fmax(0.0, next - segment->from);
        const double *w = at <= time || last ? unknowns_at(flight, fmin(at, time), 0) : NULL;
        if (!w) {
            return at <= time ? DEA_STATE_FAILED : DEA_STATE_OK;
        }
        const dea_turn turn = dea_rotation_turn(flight->swing, fmin(at, time), 0.0);
        dea_rotation_state(flight->swing, turn, w, y);
        if (!dea_flight_record(flight, at, y)) {
            return DEA_STATE_PULL_IN;
        }
        take_current(flight, fmin(at, time), turn, w, &flight->trace->moments[flight->trace->count - 1]);
        take_velocity(flight, fmin(at, time), &flight->trace->moments[flight->trace->count - 1]);
    }
    return DEA_STATE_OK;
}

/* Gauss-Legendre rule on [-1, 1], its upper half. */
enum { NODES = 6 };
static const double node[NODES / 2] = {0.23861918608319690863, 0.66120938646626451366, 0.93246951420315202781};
static const double gauss[NODES / 2] = {0.46791393457269104739, 0.36076157304813860757, 0.17132449237917034504};

static double node_at(int g)
{
    return g < NODES / 2 ? -node[NODES / 2 - 1 - g] : node[g - NODES / 2];
}

static double gauss_at(int g)
{
    return g < NODES / 2 ? gauss[NODES / 2 - 1 - g] : gauss[g - NODES / 2];
}

/* What a quadrature over a step adds up: at a time, its swing turned on by an angle, with that weight [s]. */
typedef void visit(const dea_flight *flight, double time, double angle, const double *w, double weight, double *sum);

static void audit_at(const dea_flight *flight, double time, double angle, const double *w, double weight, double *sum)
{
    (void)sum;
    double y[DEA_MOTION_MOST], z[DEA_RELAXED_MAX];
    const dea_turn turn = dea_rotation_turn(flight->swing, time, angle);
    dea_rotation_state(flight->swing, turn, w, y);
    dea_moment moment = dea_motion_moment(&flight->motion, time, y);
    take_current(flight, time, turn, w, &moment);
    take_velocity(flight, time, &moment);
    dea_motion_branches(&flight->motion, y, z);
    dea_audit_add(flight->audit, flight->motion.dynamics, &moment, z, weight);
}

static void displacement_at(const dea_flight *flight, double time, double angle, const double *w, double weight, double *sum)
{
    double y[DEA_MOTION_MOST];
    dea_rotation_state(flight->swing, dea_rotation_turn(flight->swing, time, angle), w, y);
    *sum += weight * y[0] * flight->motion.size[0];
}

/* Powers that turn with the swing, P = sum p_k e^{ik omega t}, |k| <= 2, with p_k smooth over the step of half width a: at each
 * node t_g all p_k follow from PHASES turned states, and with int_-1^1 P_l(x) e^{iqx} dx = 2 i^l j_l(q) the weight of phase phi_j
 * is
 *
 *     a g/PHASES [ 1 + 2 Re sum_k e^{-ik(phi_j + kappa x_g)} sum_l (2l+1) P_l(x_g) i^l j_l(k kappa) ],   kappa = omega a. */
enum { HARMONICS = 2, PHASES = 2 * HARMONICS + 1 };

/* sum_l (2l+1) P_l(x) i^l j_l(q), real and imaginary part, for q > NODES: there the recurrence of j_l is stable. */
static void project(double x, double q, double *real, double *imaginary)
{
    double p0 = 1.0, p1 = x;
    double j0 = sin(q) / q, j1 = (sin(q) / q - cos(q)) / q;
    *real = *imaginary = 0.0;
    for (int l = 0; l < NODES; l++) {
        const double term = (2 * l + 1) * p0 * j0 * (l % 4 < 2 ? 1.0 : -1.0);
        *(l % 2 == 0 ? real : imaginary) += term;
        const double p2 = ((2 * l + 3) * x * p1 - (l + 1) * p0) / (l + 2);
        const double j2 = (2 * l + 3) / q * j1 - j0;
        p0 = p1, p1 = p2;
        j0 = j1, j1 = j2;
    }
}

static void visit_turns(const dea_flight *flight, double from, double to, visit *at, double *sum)
{
    const double half = 0.5 * (to - from);
    const double kappa = flight->swing->omega * half;
    for (int g = 0; g < NODES; g++) {
        const double x = node_at(g);
        const double time = from + half * (1.0 + x);
        const double *there = unknowns_at(flight, time, 0);
        double real[HARMONICS], imaginary[HARMONICS], w[DEA_MOTION_MOST];
        if (there) {
            memcpy(w, there, (size_t)flight->motion.count * sizeof *w);
        }
        for (int k = 1; k <= HARMONICS; k++) {
            project(x, k * kappa, &real[k - 1], &imaginary[k - 1]);
        }
        for (int j = 0; there && j < PHASES; j++) {
            const double phase = 2.0 * DEA_PI * j / PHASES;
            double weight = 1.0;
            for (int k = 1; k <= HARMONICS; k++) {
                const double angle = k * (phase + kappa * x);
                weight += 2.0 * (cos(angle) * real[k - 1] + sin(angle) * imaginary[k - 1]);
            }
            at(flight, time, phase, w, half * gauss_at(g) / PHASES * weight, sum);
        }
    }
}

/* Part of a step: by Gauss's rule where it resolves the swing. */
static void visit_step(const dea_flight *flight, double from, double to, visit *at, double *sum)
{
    const double angle = flight->swing->turns ? 0.5 * flight->swing->omega * (to - from) : 0.0;
    if (angle > NODES) {
        visit_turns(flight, from, to, at, sum);
        return;
    }
    const int panels = 1 + (int)angle;
    const double half = 0.5 * (to - from) / panels;
    for (int i = 0; i < NODES * panels; i++) {
        const double time = from + half * (2 * (i / NODES) + 1.0 + node_at(i % NODES));
        const double *w = unknowns_at(flight, time, 0);
        if (w) {
            at(flight, time, 0.0, w, half * gauss_at(i % NODES), sum);
        }
    }
}

/* Adds what a step does inside the windows. */
static void integrate_step(const dea_flight *flight, double before, double time)
{
    const double begin = flight->motion.segment->from;
    for (size_t i = 0; i < flight->scene->transient.average_count; i++) {
        const dea_window *window = &flight->scene->transient.averages[i];
        const double from = fmax(before, window->from - begin), to = fmin(time, window->to - begin);
        if (from < to) {
            visit_step(flight, from, to, displacement_at, &flight->trace->integrals[i]);
        }
    }
}

static bool state_at(void *user, double time, double *y)
{
    const dea_flight *flight = user;
    const double *w = unknowns_at(flight, time, 0);
    if (w) {
        dea_rotation_state(flight->swing, dea_rotation_turn(flight->swing, time, 0.0), w, y);
    }
    return w != NULL;
}

/* Current at a time of the last step, counted over the run [A]. */
static double current_at(void *user, double time)
{
    const dea_flight *flight = user;
    const double at = time - flight->motion.segment->from;
    const double *there = unknowns_at(flight, at, 0);
    double w[DEA_MOTION_MOST], y[DEA_MOTION_MOST];
    if (!there) {
        return 0.0;
    }
    memcpy(w, there, (size_t)flight->motion.count * sizeof *w);
    const dea_turn turn = dea_rotation_turn(flight->swing, at, 0.0);
    dea_rotation_state(flight->swing, turn, w, y);
    dea_moment moment = dea_motion_moment(&flight->motion, at, y);
    take_current(flight, at, turn, w, &moment);
    return dea_dynamics_current(flight->motion.dynamics, &moment);
}

/* Sees the current over a step: in a frame that turns, radian by radian while the tolerance sees the swing. */
static void see_current(dea_flight *flight, double before, double time)
{
    const dea_rotation *swing = flight->swing;
    const double begin = flight->motion.segment->from;
    const double *w = NV_DATA_S(flight->integrator.y);
    const bool lives = swing->turns && hypot(w[0], w[1]) > flight->tolerance;
    const double parts = lives ? ceil(swing->omega * (time - before)) : 1.0;
    for (double i = 0.0; i < parts && flight->peaks; i++) {
        const double from = before + (time - before) * (i / parts), to = before + (time - before) * ((i + 1.0) / parts);
        dea_peak_search(&flight->trace->peak, begin + from, begin + to, current_at, flight);
    }
}

/* Highest order of BDF behind an explicit method. From order 3 on BDF lets the tail of a swing grow while a step is a part of its
 * period, and may crawl through all that is left, a step a radian. Order 2 never does; of its steps, relaxation takes about
 * 4/tolerance^(1/3). */
static int best_order(const dea_flight *flight, double from)
{
    const dea_segment *segment = flight->motion.segment;
    const double radians = flight->swing->omega * (segment->to - segment->from - from);
    return from > 0.0 && radians > 4.0 / cbrt(flight->tolerance) ? 2 : 5;
}

static bool begin(dea_flight *flight, double from)
{
    dea_integrator *m = &flight->integrator;
    const dea_sundials *sun = m->sun;
    double f[DEA_MOTION_MOST];
    double *w = NV_DATA_S(m->y);
    double *slope = NV_DATA_S(m->yp);
    const dea_turn turn = dea_rotation_turn(flight->swing, from, 0.0);
    dea_rotation_unknowns(flight->swing, turn, flight->y, w);
    if (!dea_motion_rates(&flight->motion, from, flight->y, f)) {
        return false;
    }
    dea_rotation_rates(flight->swing, turn, w, f, slope);
    if (flight->motion.algebraic) {
        slope[0] = dea_motion_moment(&flight->motion, from, flight->y).v / flight->motion.size[0];
    }
    return sun->IDAReInit(m->ida, from, m->y, m->yp) == IDA_SUCCESS &&
           sun->IDASetMaxOrd(m->ida, best_order(flight, from)) == IDA_SUCCESS &&
           sun->IDASStolerances(m->ida, flight->tolerance, flight->tolerance) == IDA_SUCCESS &&
           sun->IDASetMaxStep(m->ida, flight->motion.segment->step) == IDA_SUCCESS && /* 0: as long as it likes */
           sun->IDASetStopTime(m->ida, flight->motion.segment->to - flight->motion.segment->from) == IDA_SUCCESS;
}

dea_state dea_flight_implicit(dea_flight *flight, double from)
{
    dea_integrator *m = &flight->integrator;
    const double width = flight->motion.segment->to - flight->motion.segment->from;
    if (!begin(flight, from)) {
        return DEA_STATE_PULL_IN;
    }
    double time = from;
    for (int code = IDA_SUCCESS; code != IDA_TSTOP_RETURN && !flight->cut;) {
        const double before = time;
        code = m->sun->IDASolve(m->ida, width, &time, m->y, m->yp, IDA_ONE_STEP);
        if (code < 0) {
            const bool gone = code == IDA_REP_RES_ERR || dea_motion_firmness(&flight->motion, time, flight->y) < soft;
            return gone ? DEA_STATE_PULL_IN : dea_flight_broke(flight, "IDA", code, time);
        }
        time = dea_flight_cut(flight, before, time, state_at, flight);
        const double *w = flight->cut ? unknowns_at(flight, time, 0) : NV_DATA_S(m->y);
        dea_state state = w ? dea_flight_step(flight, time, w) : DEA_STATE_FAILED;
        if (state == DEA_STATE_OK) {
            state = take_samples(flight, time, code == IDA_TSTOP_RETURN && !flight->cut);
        }
        if (state != DEA_STATE_OK) {
            return state;
        }
        if (dea_motion_firmness(&flight->motion, time, flight->y) < folded) {
            return DEA_STATE_PULL_IN;
        }
        integrate_step(flight, before, time);
        see_current(flight, before, time);
        if (flight->audit) {
            visit_step(flight, before, time, audit_at, NULL);
        }
    }
    return DEA_STATE_OK;
}
