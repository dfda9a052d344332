/* A segment of a membrane by IDA: residual, Newton's method over the displacements alone, samples and energies between steps. */
#include <math.h>
#include <string.h>

#include "engine/ida/rings_flight.h"
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
    dea_rings_flight *f = user;
    const sunrealtype *y = NV_DATA_S(vy), *yp = NV_DATA_S(vyp);
    (void)r, (void)matrix, (void)work1, (void)work2, (void)work3;
    if (!dea_rings_look(&f->motion, time, y, speeds(f, y, yp), &f->state)) {
        return 1;
    }
    return dea_rings_schur_fill(&f->motion, &f->state, pace, &f->schur, SM_DATA_D(f->dense)) ? 0 : 1;
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
    dea_rings_flight *f = solver->content;
    (void)matrix;
    return f->inner->ops->setup(f->inner, f->dense);
}

static int solver_solve(SUNLinearSolver solver, SUNMatrix matrix, N_Vector x, N_Vector b, sunrealtype tolerance)
{
    dea_rings_flight *f = solver->content;
    (void)matrix;
    dea_rings_schur_reduce(&f->motion, &f->schur, NV_DATA_S(b), NV_DATA_S(f->reduced));
    const int code = f->inner->ops->solve(f->inner, f->dense, f->reduced, f->reduced, tolerance);
    memcpy(NV_DATA_S(x), NV_DATA_S(f->reduced), f->motion.nodes * sizeof(sunrealtype));
    dea_rings_schur_expand(&f->motion, &f->schur, NV_DATA_S(b), NV_DATA_S(x));
    return code;
}

static bool make_solver(dea_rings_flight *f)
{
    const dea_sundials *sun = f->sun;
    const sunindextype n = (sunindextype)f->motion.nodes;
    f->reduced = sun->N_VNew_Serial(n, sun->context);
    f->dense = sun->SUNDenseMatrix(n, n, sun->context);
    f->inner = f->reduced && f->dense ? sun->SUNLinSol_Dense(f->reduced, f->dense, sun->context) : NULL;
    f->matrix = sun->SUNMatNewEmpty(sun->context);
    f->solver = sun->SUNLinSolNewEmpty(sun->context);
    if (!f->inner || !f->matrix || !f->solver) {
        return false;
    }
    f->matrix->ops->getid = matrix_id;
    f->matrix->ops->zero = matrix_zero;
    f->solver->content = f;
    f->solver->ops->gettype = solver_type;
    f->solver->ops->getid = solver_id;
    f->solver->ops->setup = solver_setup;
    f->solver->ops->solve = solver_solve;
    return true;
}

dea_status dea_rings_implicit_open(dea_rings_flight *f, dea_error *error)
{
    const dea_sundials *sun = f->sun;
    f->ida = make_solver(f) ? sun->IDACreate(sun->context) : NULL;
    if (!f->ida) {
        return dea_fail(error, DEA_ERROR_MEMORY, "out of memory while IDA starts");
    }
#if SUNDIALS_VERSION_MAJOR < 7
    sun->IDASetErrHandlerFn(f->ida, dea_sundials_ignore, NULL);
#endif
    sun->N_VConst(0.0, f->y);
    sun->N_VConst(0.0, f->yp);
    sun->N_VConst(1.0, f->tolerances);
    if (sun->IDAInit(f->ida, residual, 0.0, f->y, f->yp) != IDA_SUCCESS ||
        sun->IDASVtolerances(f->ida, 1e-6, f->tolerances) != IDA_SUCCESS ||
        sun->IDASetLinearSolver(f->ida, f->solver, f->matrix) != IDA_SUCCESS ||
        sun->IDASetJacFn(f->ida, jacobian) != IDA_SUCCESS || sun->IDASetUserData(f->ida, f) != IDA_SUCCESS ||
        sun->IDASetMaxErrTestFails(f->ida, MOST_FAILS) != IDA_SUCCESS ||
        sun->IDASetMaxConvFails(f->ida, MOST_FAILS) != IDA_SUCCESS) {
        return dea_fail(error, DEA_ERROR_ENGINE, "IDA did not start");
    }
    return DEA_OK;
}

void dea_rings_implicit_close(dea_rings_flight *f)
{
    if (f->ida) {
        f->sun->IDAFree(&f->ida);
    }
    if (f->inner) {
        f->sun->SUNLinSolFree(f->inner);
    }
    if (f->solver) {
        f->sun->SUNLinSolFreeEmpty(f->solver);
    }
    if (f->matrix) {
        f->sun->SUNMatFreeEmpty(f->matrix);
    }
    if (f->dense) {
        f->sun->SUNMatDestroy(f->dense);
    }
    if (f->reduced) {
        f->sun->N_VDestroy(f->reduced);
    }
}

/* ---- between steps */

/* State and derivative at a time of the last step; false where IDA has none. */
static bool look_back(dea_rings_flight *f, double time)
{
    return f->sun->IDAGetDky(f->ida, time, 0, f->between) == IDA_SUCCESS &&
           (f->motion.heavy && !f->motion.charged ? true : f->sun->IDAGetDky(f->ida, time, 1, f->slope) == IDA_SUCCESS);
}

/* Does the derivative of the charge tell more than the drop over R_s? */
static bool charges_slowly(const dea_rings_flight *f)
{
    double step;
    return f->motion.charged && f->sun->IDAGetLastStep(f->ida, &step) == IDA_SUCCESS &&
           step * f->signal->largest >= f->membrane.film.series * f->motion.charge;
}

/* Velocities of an algebraic film between steps; the rates of its charges stay, and count where they tell more than small drops. */
static bool solve_velocities(dea_rings_flight *f, double at, const double *y, double *rates)
{
    const dea_rings_motion *m = &f->motion;
    double charging[DEA_SHEET_PLACES];
    const bool derived = charges_slowly(f);
    memcpy(charging, rates + m->q, m->charges * sizeof *rates);
    const bool solved = dea_rings_rates(m, at, y, rates);
    memcpy(rates + m->q, charging, m->charges * sizeof *rates);
    return solved && derived ? dea_rings_massless(m, at, y, rates) : solved;
}

/* Samples of the segment up to a time of it. The velocity of an algebraic film is solved for. */
static dea_state take_samples(dea_rings_flight *f, double time, bool last)
{
    const dea_segment *segment = f->motion.segment;
    for (double next = dea_rings_next_sample(f); next <= segment->to; next = dea_rings_next_sample(f)) {
        const double at = fmax(0.0, next - segment->from);
        if (at > time && !last) {
            return DEA_STATE_OK;
        }
        if (!look_back(f, fmin(at, time))) {
            return DEA_STATE_FAILED;
        }
        double *y = NV_DATA_S(f->between), *rates = NV_DATA_S(f->slope);
        if (dea_rings_algebraic(&f->motion) && !solve_velocities(f, at, y, rates)) {
            return DEA_STATE_PULL_IN;
        }
        if (!dea_rings_record(f, at, y, rates, charges_slowly(f))) {
            return DEA_STATE_PULL_IN;
        }
    }
    return DEA_STATE_OK;
}

/* Two-point Gauss rule on [0, 1] for energies: a step is a small part of all that the film does. */
static const double places[2] = {0.21132486540518711775, 0.78867513459481288225};

static void audit_step(dea_rings_flight *f, double before, double time)
{
    const bool charging = charges_slowly(f);
    for (int g = 0; g < 2; g++) {
        const double at = before + places[g] * (time - before);
        if (look_back(f, at)) {
            dea_rings_audit(f, at, NV_DATA_S(f->between), NV_DATA_S(f->slope), charging, 0.5 * (time - before));
        }
    }
}

/* Adds what a step does inside the windows. */
static void integrate_step(dea_rings_flight *f, double before, double time)
{
    const double begin = f->motion.segment->from;
    for (size_t i = 0; i < f->scene->transient.average_count; i++) {
        const dea_window *window = &f->scene->transient.averages[i];
        const double from = fmax(before, window->from - begin), to = fmin(time, window->to - begin);
        for (int g = 0; g < DEA_GAUSS_POINTS && from < to; g++) {
            const double at = from + dea_gauss_place(g) * (to - from);
            if (f->sun->IDAGetDky(f->ida, at, 0, f->between) == IDA_SUCCESS) {
                f->trace->integrals[i] += dea_gauss_weight(g) * (to - from) * NV_DATA_S(f->between)[f->membrane.rings.edge];
            }
        }
    }
}

/* Current at a time of the last step, counted over the run [A]. */
static double current_at(void *user, double time)
{
    dea_rings_flight *f = user;
    const double at = time - f->motion.segment->from;
    return look_back(f, at) ? dea_rings_current(f, at, NV_DATA_S(f->between), NV_DATA_S(f->slope), charges_slowly(f)) : 0.0;
}

static bool begin(dea_rings_flight *f, double from)
{
    const dea_sundials *sun = f->sun;
    const dea_segment *segment = f->motion.segment;
    return dea_rings_rates(&f->motion, from, NV_DATA_S(f->y), NV_DATA_S(f->yp)) &&
           sun->IDAReInit(f->ida, from, f->y, f->yp) == IDA_SUCCESS &&
           sun->IDASVtolerances(f->ida, f->tolerance, f->tolerances) == IDA_SUCCESS &&
           sun->IDASetMaxStep(f->ida, segment->step) == IDA_SUCCESS && /* 0: as long as it likes */
           sun->IDASetStopTime(f->ida, segment->to - segment->from) == IDA_SUCCESS;
}

dea_state dea_rings_implicit(dea_rings_flight *f, double from)
{
    const dea_segment *segment = f->motion.segment;
    const double width = segment->to - segment->from;
    if (!begin(f, from)) {
        return DEA_STATE_PULL_IN;
    }
    double time = from;
    f->derived = true;
    for (int code = IDA_SUCCESS; code != IDA_TSTOP_RETURN;) {
        const double before = time;
        code = f->sun->IDASolve(f->ida, width, &time, f->y, f->yp, IDA_ONE_STEP);
        if (code < 0) {
            const bool gone = code == IDA_REP_RES_ERR || dea_rings_firmness(&f->motion, time, NV_DATA_S(f->y)) < soft;
            return gone ? DEA_STATE_PULL_IN : dea_rings_broke(f, "IDA", code, time);
        }
        dea_state state = take_samples(f, time, code == IDA_TSTOP_RETURN);
        if (state == DEA_STATE_OK) {
            state = dea_rings_step(f, time, NV_DATA_S(f->y));
        }
        if (state != DEA_STATE_OK) {
            return state;
        }
        integrate_step(f, before, time);
        if (f->peaks) {
            dea_peak_search(&f->trace->peak, segment->from + before, segment->from + time, current_at, f);
        }
        if (f->audit) {
            audit_step(f, before, time);
        }
    }
    return DEA_STATE_OK;
}
