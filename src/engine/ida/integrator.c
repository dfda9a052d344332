#include "engine/ida/sundials.h"

/* Steps of one problem after which it is given up; a good one takes some hundreds. */
enum { MOST_STEPS = 20000 };

#if SUNDIALS_VERSION_MAJOR < 7
void dea_sundials_ignore(int code, const char *module, const char *function, char *message, void *user)
{
    (void)code, (void)module, (void)function, (void)message, (void)user;
}
#endif

dea_status dea_sundials_open(SUNContext *context, dea_error *error)
{
    if (SUNContext_Create(DEA_SUN_COMM_NULL, context) != 0) {
        return dea_fail(error, DEA_ERROR_MEMORY, "SUNDIALS did not start");
    }
#if SUNDIALS_VERSION_MAJOR >= 7
    SUNContext_ClearErrHandlers(*context);
#endif
    return DEA_OK;
}

static bool allocate(sunindextype n, dea_integrator *m)
{
    m->y = N_VNew_Serial(n, m->context);
    m->yp = N_VNew_Serial(n, m->context);
    m->id = N_VNew_Serial(n, m->context);
    m->tolerance = N_VNew_Serial(n, m->context);
    m->matrix = SUNDenseMatrix(n, n, m->context);
    m->ida = IDACreate(m->context);
    if (!m->y || !m->yp || !m->id || !m->tolerance || !m->matrix || !m->ida) {
        return false;
    }
    m->solver = SUNLinSol_Dense(m->y, m->matrix, m->context);
    return m->solver != NULL;
}

dea_status dea_integrator_open(SUNContext context, sunindextype n, IDAResFn residual, dea_integrator *m, dea_error *error)
{
    *m = (dea_integrator){.context = context};
    if (!allocate(n, m)) {
        return dea_fail(error, DEA_ERROR_MEMORY, "out of memory while IDA starts");
    }
#if SUNDIALS_VERSION_MAJOR < 7
    IDASetErrHandlerFn(m->ida, dea_sundials_ignore, NULL);
#endif
    N_VConst(0.0, m->y);
    N_VConst(0.0, m->yp);
    N_VConst(1.0, m->id);
    N_VConst(1.0, m->tolerance);
    if (IDAInit(m->ida, residual, 0.0, m->y, m->yp) != IDA_SUCCESS ||
        IDASVtolerances(m->ida, 1e-6, m->tolerance) != IDA_SUCCESS ||
        IDASetLinearSolver(m->ida, m->solver, m->matrix) != IDA_SUCCESS || IDASetMaxNumSteps(m->ida, MOST_STEPS) != IDA_SUCCESS) {
        return dea_fail(error, DEA_ERROR_ENGINE, "IDA did not start");
    }
    return DEA_OK;
}

void dea_integrator_close(dea_integrator *m)
{
    if (m->ida) {
        IDAFree(&m->ida);
    }
    if (m->solver) {
        SUNLinSolFree(m->solver);
    }
    if (m->matrix) {
        SUNMatDestroy(m->matrix);
    }
    N_Vector vectors[] = {m->y, m->yp, m->id, m->tolerance};
    for (size_t i = 0; i < sizeof vectors / sizeof vectors[0]; i++) {
        if (vectors[i]) {
            N_VDestroy(vectors[i]);
        }
    }
    *m = (dea_integrator){0};
}
