#include "engine/ida/sundials.h"

/* Steps of one problem after which it is given up; a good one takes some hundreds. */
enum { MOST_STEPS = 20000 };

static bool allocate(sunindextype n, dea_integrator *m)
{
    m->y = m->sun->N_VNew_Serial(n, m->sun->context);
    m->yp = m->sun->N_VNew_Serial(n, m->sun->context);
    m->id = m->sun->N_VNew_Serial(n, m->sun->context);
    m->tolerance = m->sun->N_VNew_Serial(n, m->sun->context);
    m->matrix = m->sun->SUNDenseMatrix(n, n, m->sun->context);
    m->ida = m->sun->IDACreate(m->sun->context);
    if (!m->y || !m->yp || !m->id || !m->tolerance || !m->matrix || !m->ida) {
        return false;
    }
    m->solver = m->sun->SUNLinSol_Dense(m->y, m->matrix, m->sun->context);
    return m->solver != NULL;
}

dea_status dea_integrator_open(const dea_sundials *sun, sunindextype n, IDAResFn residual, dea_integrator *m, dea_error *error)
{
    *m = (dea_integrator){.sun = sun};
    if (!allocate(n, m)) {
        return dea_fail(error, DEA_ERROR_MEMORY, "out of memory while IDA starts");
    }
#if SUNDIALS_VERSION_MAJOR < 7
    m->sun->IDASetErrHandlerFn(m->ida, dea_sundials_ignore, NULL);
#endif
    m->sun->N_VConst(0.0, m->y);
    m->sun->N_VConst(0.0, m->yp);
    m->sun->N_VConst(1.0, m->id);
    m->sun->N_VConst(1.0, m->tolerance);
    if (m->sun->IDAInit(m->ida, residual, 0.0, m->y, m->yp) != IDA_SUCCESS ||
        m->sun->IDASVtolerances(m->ida, 1e-6, m->tolerance) != IDA_SUCCESS ||
        m->sun->IDASetLinearSolver(m->ida, m->solver, m->matrix) != IDA_SUCCESS ||
        m->sun->IDASetMaxNumSteps(m->ida, MOST_STEPS) != IDA_SUCCESS) {
        return dea_fail(error, DEA_ERROR_ENGINE, "IDA did not start");
    }
    return DEA_OK;
}

void dea_integrator_close(dea_integrator *m)
{
    if (m->ida) {
        m->sun->IDAFree(&m->ida);
    }
    if (m->solver) {
        m->sun->SUNLinSolFree(m->solver);
    }
    if (m->matrix) {
        m->sun->SUNMatDestroy(m->matrix);
    }
    N_Vector vectors[] = {m->y, m->yp, m->id, m->tolerance};
    for (size_t i = 0; i < sizeof vectors / sizeof vectors[0]; i++) {
        if (vectors[i]) {
            m->sun->N_VDestroy(vectors[i]);
        }
    }
    *m = (dea_integrator){0};
}

/* Error test failures of one step after which a run is given up: a step that outgrew its stability is far too long. */
enum { MOST_FAILS = 30 };

void *dea_sundials_verner(const dea_sundials *sun, ARKRhsFn rates, N_Vector w, double relative, N_Vector absolute, double longest,
                          void *user)
{
    void *ark = sun->ARKStepCreate(rates, NULL, 0.0, w, sun->context);
    if (!ark) {
        return NULL;
    }
#if SUNDIALS_VERSION_MAJOR < 7
    sun->ARKStepSetErrHandlerFn(ark, dea_sundials_ignore, NULL);
    sun->ARKStepSetErrorBias(ark, 1.0); /* as SUNDIALS 7 has it */
#endif
    if (sun->DEA_ARK(SetMaxStep)(ark, longest) != ARK_SUCCESS || sun->DEA_ARK(SetUserData)(ark, user) != ARK_SUCCESS ||
        sun->DEA_ARK(SetMaxErrTestFails)(ark, MOST_FAILS) != ARK_SUCCESS ||
        sun->ARKStepSetTableNum(ark, ARKODE_DIRK_NONE, ARKODE_VERNER_8_5_6) != ARK_SUCCESS ||
        sun->DEA_ARK(SVtolerances)(ark, relative, absolute) != ARK_SUCCESS) {
        sun->DEA_ARK(Free)(&ark);
        return NULL;
    }
    return ark;
}
