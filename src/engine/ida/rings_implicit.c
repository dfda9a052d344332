/* A segment of a membrane by IDA: residual, Newton's method over the displacements alone, samples and energies between steps. */
#include <math.h>
#include <string.h>

#include "engine/ida/rings_solver.h"
#include "support/gauss.h"

/* Failures of one step after which a run is given up: the first step of a segment can be far too long. */
enum { MOST_FAILS = 40 };

/* Share of the stiffness at rest so low that a fold is the reason why IDA gave up. */
static const double soft = 0.02;

static const double *speeds(const dea_rings_flight *f, const double *y, const double *yp)
{
    return f->motion.heavy ? y + f->motion.nodes : f->motion.damped ? yp : NULL;
}

static int residual(sunrealtype time, N_Vector vy, N_Vector vyp, N_Vector vr, void *user)
{
    dea_rings_flight *f = user;
    const dea_rings_motion *m = &f->motion;
    const sunrealtype *y = NV_DATA_S(vy), *yp = NV_DATA_S(vyp);
    sunrealtype *r = NV_DATA_S(vr);
    if (!dea_rings_look(m, time, y, speeds(f, y, yp), &f->state)) {
        return 1; /* a trial step too far: IDA takes a shorter one */
    }
    dea_rings_relaxing(m, &f->state, y, r);
    for (size_t i = m->z; i < m->count; i++) {
        r[i] = yp[i] - r[i];
    }
    for (size_t n = 0; n < m->nodes; n++) {
        r[n] = m->heavy ? yp[n] - y[m->nodes + n] : -f->state.force[n];
        if (m->heavy) {
            r[m->nodes + n] = yp[m->nodes + n] - f->state.force[n] / f->membrane.masses[n];
        }
    }
    return 0;
}

static int jacobian(sunrealtype time, sunrealtype pace, N_Vector vy, N_Vector vyp, N_Vector r, SUNMatrix matrix, void *user,
                    N_Vector work1, N_Vector work2, N_Vector work3)
{
    dea_rings_solver *s = user;
    dea_rings_flight *f = &s->flight;
    const sunrealtype *y = NV_DATA_S(vy), *yp = NV_DATA_S(vyp);
    (void)r, (void)matrix, (void)work1, (void)work2, (void)work3;
    if (!dea_rings_look(&f->motion, time, y, speeds(f, y, yp), &f->state)) {
        return 1;
    }
    return dea_rings_schur_fill(&f->motion, &f->state, pace, &s->schur, SM_DATA_D(s->dense)) ? 0 : 1;
}

/* ---- the matrix, which stands in the flight, as SUNDIALS wants it */

static SUNMatrix_ID matrix_id(SUNMatrix matrix)
{
    (void)matrix;
    return SUNMATRIX_CUSTOM;
}

static int matrix_zero(SUNMatrix matrix)
{
    (void)matrix;
    return 0;
}

static SUNLinearSolver_Type solver_type(SUNLinearSolver solver)
{
    (void)solver;
    return SUNLINEARSOLVER_DIRECT;
}

static SUNLinearSolver_ID solver_id(SUNLinearSolver solver)
{
    (void)solver;
    return SUNLINEARSOLVER_CUSTOM;
}

static int solver_setup(SUNLinearSolver solver, SUNMatrix matrix)
{
    dea_rings_solver *s = solver->content;
    (void)matrix;
    return s->inner->ops->setup(s->inner, s->dense);
}

static int solver_solve(SUNLinearSolver solver, SUNMatrix matrix, N_Vector x, N_Vector b, sunrealtype tolerance)
{
    dea_rings_solver *s = solver->content;
    dea_rings_flight *f = &s->flight;
    (void)matrix, (void)tolerance;
    dea_rings_schur_reduce(&f->motion, &s->schur, NV_DATA_S(b), NV_DATA_S(s->reduced));
    dea_sundials_substitute(s->inner, s->dense, NV_DATA_S(s->reduced));
    memcpy(NV_DATA_S(x), NV_DATA_S(s->reduced), f->motion.nodes * sizeof(sunrealtype));
    dea_rings_schur_expand(&f->motion, &s->schur, NV_DATA_S(b), NV_DATA_S(x));
    return 0;
}

static bool make_solver(dea_rings_solver *s)
{
    dea_rings_flight *f = &s->flight;
    const dea_sundials *sun = s->sun;
    const sunindextype n = (sunindextype)f->motion.nodes;
    s->reduced = sun->N_VNew_Serial(n, sun->context);
    s->dense = sun->SUNDenseMatrix(n, n, sun->context);
    s->inner = s->reduced && s->dense ? sun->SUNLinSol_Dense(s->reduced, s->dense, sun->context) : NULL;
    s->matrix = sun->SUNMatNewEmpty(sun->context);
    s->solver = sun->SUNLinSolNewEmpty(sun->context);
    if (!s->inner || !s->matrix || !s->solver) {
        return false;
    }
    s->matrix->ops->getid = matrix_id;
    s->matrix->ops->zero = matrix_zero;
    s->solver->content = s;
    s->solver->ops->gettype = solver_type;
    s->solver->ops->getid = solver_id;
    s->solver->ops->setup = solver_setup;
    s->solver->ops->solve = solver_solve;
    return true;
}

dea_status dea_rings_implicit_open(dea_rings_solver *s, dea_error *error)
{
    const dea_sundials *sun = s->sun;
    s->ida = make_solver(s) ? sun->IDACreate(sun->context) : NULL;
    if (!s->ida) {
        return dea_fail(error, DEA_ERROR_MEMORY, "out of memory while IDA starts");
    }
#if SUNDIALS_VERSION_MAJOR < 7
    sun->IDASetErrHandlerFn(s->ida, dea_sundials_ignore, NULL);
#endif
    sun->N_VConst(0.0, s->y);
    sun->N_VConst(0.0, s->yp);
    sun->N_VConst(1.0, s->tolerances);
    if (sun->IDAInit(s->ida, residual, 0.0, s->y, s->yp) != IDA_SUCCESS ||
        sun->IDASVtolerances(s->ida, 1e-6, s->tolerances) != IDA_SUCCESS ||
        sun->IDASetLinearSolver(s->ida, s->solver, s->matrix) != IDA_SUCCESS ||
        sun->IDASetJacFn(s->ida, jacobian) != IDA_SUCCESS || sun->IDASetUserData(s->ida, s) != IDA_SUCCESS ||
        sun->IDASetMaxErrTestFails(s->ida, MOST_FAILS) != IDA_SUCCESS ||
        sun->IDASetMaxConvFails(s->ida, MOST_FAILS) != IDA_SUCCESS) {
        return dea_fail(error, DEA_ERROR_ENGINE, "IDA did not start");
    }
    return DEA_OK;
}

void dea_rings_implicit_close(dea_rings_solver *s)
{
    if (s->ida) {
        s->sun->IDAFree(&s->ida);
    }
    if (s->inner) {
        s->sun->SUNLinSolFree(s->inner);
    }
    if (s->solver) {
        s->sun->SUNLinSolFreeEmpty(s->solver);
    }
    if (s->matrix) {
        s->sun->SUNMatFreeEmpty(s->matrix);
    }
    if (s->dense) {
        s->sun->SUNMatDestroy(s->dense);
    }
    if (s->reduced) {
        s->sun->N_VDestroy(s->reduced);
    }
}

/* ---- between steps */

/* State and derivative at a time of the last step; false where IDA has none. */
static bool look_back(dea_rings_solver *s, double time)
{
    dea_rings_flight *f = &s->flight;
    return s->sun->IDAGetDky(s->ida, time, 0, s->between) == IDA_SUCCESS &&
           (f->motion.heavy && !f->motion.charged ? true : s->sun->IDAGetDky(s->ida, time, 1, s->slope) == IDA_SUCCESS);
}

/* Does the derivative of the charge tell more than the drop over R_s? */
static bool charges_slowly(const dea_rings_solver *s)
{
    const dea_rings_flight *f = &s->flight;
    double step;
    return f->motion.charged && s->sun->IDAGetLastStep(s->ida, &step) == IDA_SUCCESS &&
           step * f->signal->largest >= f->membrane.film.series * f->motion.charge;
}

/* Velocities of an algebraic film between steps; the rates of its charges stay, and count where they tell more than small drops. */
static bool solve_velocities(dea_rings_solver *s, double at, const double *y, double *rates)
{
    dea_rings_flight *f = &s->flight;
    const dea_rings_motion *m = &f->motion;
    double charging[DEA_SHEET_PLACES];
    const bool derived = charges_slowly(s);
    memcpy(charging, rates + m->q, m->charges * sizeof *rates);
    const bool solved = dea_rings_rates(m, at, y, rates);
    memcpy(rates + m->q, charging, m->charges * sizeof *rates);
    return solved && derived ? dea_rings_massless(m, at, y, rates) : solved;
}

/* Samples of the segment up to a time of it. The velocity of an algebraic film is solved for. */
static dea_state take_samples(dea_rings_solver *s, double time, bool last)
{
    dea_rings_flight *f = &s->flight;
    const dea_segment *segment = f->motion.segment;
    for (double next = dea_rings_next_sample(f); next <= segment->to; next = dea_rings_next_sample(f)) {
        const double at = fmax(0.0, next - segment->from);
        if (at > time && !last) {
            return DEA_STATE_OK;
        }
        if (!look_back(s, fmin(at, time))) {
            return DEA_STATE_FAILED;
        }
        double *y = NV_DATA_S(s->between), *rates = NV_DATA_S(s->slope);
        if (dea_rings_algebraic(&f->motion) && !solve_velocities(s, at, y, rates)) {
            return DEA_STATE_PULL_IN;
        }
        if (!dea_rings_record(f, at, y, rates, charges_slowly(s))) {
            return DEA_STATE_PULL_IN;
        }
    }
    return DEA_STATE_OK;
}

/* Powers at the ends of the last steps, and the time up to which their energies are counted. */
enum { ENDS = 4 };

typedef struct power_track {
    size_t count; /* of ends */
    double times[ENDS], until;
    dea_audit powers[ENDS];
} power_track;

/* Counts energies up to a time by the polynomial through the powers: the Gauss rule of two points is exact for a cubic one. */
static void count_energies(power_track *t, double to, dea_audit *audit)
{
    static const double places[2] = {0.21132486540518711775, 0.78867513459481288225};
    for (size_t k = 0; k < 2 * t->count; k++) {
        const size_t i = k / 2;
        const double at = t->until + places[k % 2] * (to - t->until);
        double weight = 0.5 * (to - t->until);
        for (size_t j = 0; j < t->count; j++) {
            weight *= j == i ? 1.0 : (at - t->times[j]) / (t->times[i] - t->times[j]);
        }
        audit->work += weight * t->powers[i].work;
        audit->dissipated += weight * t->powers[i].dissipated;
        audit->branch += weight * t->powers[i].branch;
    }
    audit->largest = fmax(audit->largest, fmax(fabs(audit->work), fabs(audit->dissipated)));
    t->until = to;
}

/* Takes the end of a step: the step before the last lies in the middle of four ends. */
static void audit_step(dea_rings_solver *s, double time, power_track *t)
{
    dea_rings_flight *f = &s->flight;
    if (t->count == ENDS) {
        t->count--;
        memmove(t->times, t->times + 1, t->count * sizeof *t->times);
        memmove(t->powers, t->powers + 1, t->count * sizeof *t->powers);
    }
    dea_audit *audit = f->audit;
    f->audit = &t->powers[t->count];
    *f->audit = (dea_audit){0};
    dea_rings_audit(f, time, NV_DATA_S(s->y), NV_DATA_S(s->yp), charges_slowly(s), 1.0);
    f->audit = audit;
    t->times[t->count++] = time;
    if (t->count == ENDS) {
        count_energies(t, t->times[ENDS - 2], f->audit);
    }
}

/* Adds what a step does inside the windows. */
static void integrate_step(dea_rings_solver *s, double before, double time)
{
    dea_rings_flight *f = &s->flight;
    const double begin = f->motion.segment->from;
    for (size_t i = 0; i < f->scene->transient.average_count; i++) {
        const dea_window *window = &f->scene->transient.averages[i];
        const double from = fmax(before, window->from - begin), to = fmin(time, window->to - begin);
        for (int g = 0; g < DEA_GAUSS_POINTS && from < to; g++) {
            const double at = from + dea_gauss_place(g) * (to - from);
            if (s->sun->IDAGetDky(s->ida, at, 0, s->between) == IDA_SUCCESS) {
                f->trace->integrals[i] += dea_gauss_weight(g) * (to - from) * NV_DATA_S(s->between)[f->membrane.rings.edge];
            }
        }
    }
}

/* Current at a time of the last step, counted over the run [A]. */
static double current_at(void *user, double time)
{
    dea_rings_solver *s = user;
    dea_rings_flight *f = &s->flight;
    const double at = time - f->motion.segment->from;
    return look_back(s, at) ? dea_rings_current(f, at, NV_DATA_S(s->between), NV_DATA_S(s->slope), charges_slowly(s)) : 0.0;
}

static bool begin(dea_rings_solver *s, double from)
{
    dea_rings_flight *f = &s->flight;
    const dea_sundials *sun = s->sun;
    const dea_segment *segment = f->motion.segment;
    return dea_rings_rates(&f->motion, from, NV_DATA_S(s->y), NV_DATA_S(s->yp)) &&
           sun->IDAReInit(s->ida, from, s->y, s->yp) == IDA_SUCCESS &&
           sun->IDASVtolerances(s->ida, f->tolerance, s->tolerances) == IDA_SUCCESS &&
           sun->IDASetMaxStep(s->ida, segment->step) == IDA_SUCCESS && /* 0: as long as it likes */
           sun->IDASetStopTime(s->ida, segment->to - segment->from) == IDA_SUCCESS;
}

dea_state dea_rings_implicit(dea_rings_solver *s, double from)
{
    dea_rings_flight *f = &s->flight;
    const dea_segment *segment = f->motion.segment;
    const double width = segment->to - segment->from;
    if (!begin(s, from)) {
        return DEA_STATE_PULL_IN;
    }
    double time = from;
    power_track track = {.until = from};
    f->derived = true;
    if (f->audit) {
        audit_step(s, from, &track);
    }
    for (int code = IDA_SUCCESS; code != IDA_TSTOP_RETURN;) {
        const double before = time;
        code = s->sun->IDASolve(s->ida, width, &time, s->y, s->yp, IDA_ONE_STEP);
        if (code < 0) {
            const bool gone = code == IDA_REP_RES_ERR || dea_rings_firmness(&f->motion, time, NV_DATA_S(s->y)) < soft;
            return gone ? DEA_STATE_PULL_IN : dea_rings_broke(f, "IDA", code, time);
        }
        dea_state state = take_samples(s, time, code == IDA_TSTOP_RETURN);
        if (state == DEA_STATE_OK) {
            state = dea_rings_step(f, time, NV_DATA_S(s->y));
        }
        if (state != DEA_STATE_OK) {
            return state;
        }
        integrate_step(s, before, time);
        if (f->peaks) {
            dea_peak_search(&f->trace->peak, segment->from + before, segment->from + time, current_at, s);
        }
        if (f->audit) {
            audit_step(s, time, &track);
        }
    }
    if (f->audit) {
        count_energies(&track, width, f->audit);
    }
    return DEA_STATE_OK;
}
