/* SUNDIALS: what differs between 6.4 and 7, the table of its functions, and what every user of it here shares. */
#ifndef DEA_IDA_SUNDIALS_H
#define DEA_IDA_SUNDIALS_H

#include <arkode/arkode_arkstep.h>
#include <ida/ida.h>
#include <kinsol/kinsol.h>
#include <nvector/nvector_serial.h>
#include <sundials/sundials_config.h>
#include <sundials/sundials_version.h>
#include <sunlinsol/sunlinsol_dense.h>
#include <sunmatrix/sunmatrix_dense.h>

#include "deaspice/engine.h"

/* Functions of ARKODE whose names begin in another way from 7.1 on. */
#if SUNDIALS_VERSION_MAJOR > 7 || (SUNDIALS_VERSION_MAJOR == 7 && SUNDIALS_VERSION_MINOR >= 1)
#define DEA_ARK(name) ARKode##name
#else
#define DEA_ARK(name) ARKStep##name
#endif

/* How messages are kept away: from 7 on the context does that for all. */
#if SUNDIALS_VERSION_MAJOR >= 7
#define DEA_SUNDIALS_QUIET(X) X(SUNContext_ClearErrHandlers)
#else
#define DEA_SUNDIALS_QUIET(X) X(ARKStepSetErrHandlerFn) X(ARKStepSetErrorBias) X(IDASetErrHandlerFn) X(KINSetErrHandlerFn)
#endif

/* Every function of SUNDIALS that is called here. */
#define DEA_SUNDIALS_LIST(X)                                                                                                     \
    DEA_SUNDIALS_QUIET(X)                                                                                                        \
    X(SUNContext_Create)                                                                                                         \
    X(SUNContext_Free)                                                                                                           \
    X(SUNDIALSGetVersion) X(SUNDIALSGetVersionNumber) X(N_VClone) X(N_VConst) X(N_VDestroy) X(N_VNew_Serial) X(SUNDenseMatrix)   \
        X(SUNMatDestroy) X(SUNLinSol_Dense) X(SUNLinSolFree) X(SUNLinSolNewEmpty) X(SUNLinSolFreeEmpty) X(SUNMatNewEmpty) X(SUNMatFreeEmpty) X(IDACalcIC) X(IDACreate) X(IDAFree) X(IDAGetConsistentIC)          \
            X(IDAGetDky) X(IDAGetLastStep) X(IDAGetRootInfo) X(IDAInit) X(IDAReInit) X(IDARootInit) X(IDASStolerances)           \
                X(IDASVtolerances) X(IDASetId) X(IDASetJacFn) X(IDASetLinearSolver) X(IDASetMaxConvFails)                        \
                    X(IDASetMaxErrTestFails) X(IDASetMaxNumSteps) X(IDASetMaxOrd) X(IDASetMaxStep) X(IDASetStopTime)             \
                        X(IDASetUserData) X(IDASolve) X(KINCreate) X(KINFree) X(KINInit) X(KINSetFuncNormTol) X(KINSetMAA)       \
                            X(KINSetNumMaxIters) X(KINSetUserData) X(KINSol) X(ARKStepCreate) X(ARKStepSetTableNum)              \
                                X(DEA_ARK(Evolve)) X(DEA_ARK(Free)) X(DEA_ARK(GetDky)) X(DEA_ARK(SVtolerances))                  \
                                    X(DEA_ARK(SetMaxErrTestFails)) X(DEA_ARK(SetMaxStep)) X(DEA_ARK(SetStopTime))                \
                                        X(DEA_ARK(SetUserData))

/* A context that prints nothing, and the functions that work in it. Zeroed is empty. */
typedef struct dea_sundials {
    SUNContext context; /* owned */
#define DEA_MEMBER(name) __typeof__(&name) name;
    DEA_SUNDIALS_LIST(DEA_MEMBER)
#undef DEA_MEMBER
} dea_sundials;

/* Loads the library, the first time, and makes a context; the caller ends it with dea_sundials_close(), also after a failure.
 * DEA_ERROR_MISSING where it is not there or of another version than the headers that this was built with. */
dea_status dea_sundials_open(dea_sundials *sun, dea_error *error);
void dea_sundials_close(dea_sundials *sun);
/* Version of the library, or of the headers where it is not there; returns @p text. */
const char *dea_sundials_version(char *text, size_t size);
#if SUNDIALS_VERSION_MAJOR < 7
/* Message handler that drops the message. */
void dea_sundials_ignore(int code, const char *module, const char *function, char *message, void *user);
#endif

/* A serial vector whose sums, and those of its clones, are sooner done than the library's own; the caller destroys it. NULL without memory. */
N_Vector dea_sundials_vector(const dea_sundials *sun, size_t count);

/* Solves in place with what the dense solver factored, in the same way, sooner. */
void dea_sundials_substitute(SUNLinearSolver solver, SUNMatrix factors, double *b);

/* An IDA integrator of n unknowns with a dense matrix. Zeroed is empty. */
typedef struct dea_integrator {
    const dea_sundials *sun; /* borrowed */
    void *ida;               /* owned, as all below */
    N_Vector y, yp;          /* solution and derivative */
    N_Vector id;             /* 1: differential, 0: algebraic */
    N_Vector tolerance;      /* absolute, per component */
    SUNMatrix matrix;
    SUNLinearSolver solver;
} dea_integrator;

/* Makes an integrator for @p residual; the caller ends it with dea_integrator_close(), also after a failure. */
dea_status dea_integrator_open(const dea_sundials *sun, sunindextype n, IDAResFn residual, dea_integrator *integrator,
                               dea_error *error);
void dea_integrator_close(dea_integrator *integrator);

/* Verner's explicit Runge-Kutta method of order 6 from time 0 and @p w on, with its tolerances and longest step; the caller ends it
 * with DEA_ARK(Free). NULL without memory. */
void *dea_sundials_verner(const dea_sundials *sun, ARKRhsFn rates, N_Vector w, double relative, N_Vector absolute, double longest,
                          void *user);

/* The two kinds of static problem; both fill the row, `failed` where nothing converged. */
struct dea_balance;
typedef struct dea_ramp dea_ramp;
dea_status dea_ramp_open(const dea_sundials *sun, dea_ramp **ramp, dea_error *error);
void dea_ramp_close(dea_ramp *ramp);
/* Equilibrium of a network: an index-1 problem along its displacement, stopped at the full load or where the stiffness vanishes.
 */
void dea_ramp_solve(dea_ramp *ramp, struct dea_balance *balance, double symbol, double accuracy, dea_row *row);

typedef struct dea_shooting dea_shooting;
dea_status dea_shooting_open(const dea_sundials *sun, dea_shooting **shooting, dea_error *error);
void dea_shooting_close(dea_shooting *shooting);
/* Exact membrane: IDA along ln R, KINSOL for the condition at the frame. */
void dea_shooting_solve(dea_shooting *shooting, const dea_point *point, double accuracy, dea_row *row);
/* The row of a membrane whose edge is held, as dea_model_hold() has it. */
void dea_shooting_hold(dea_shooting *shooting, const dea_point *point, double displacement, double accuracy, dea_row *row);

/* One transient: fills samples and summary, `failed` or `pull_in` from where the run cannot go on. */
dea_status dea_transient_solve(const dea_sundials *sun, const dea_scene *scene, const dea_model *model, dea_sample *samples,
                               dea_summary *summary, dea_error *error);
/* The same of the membrane. */
dea_status dea_rings_transient_solve(const dea_sundials *sun, const dea_scene *scene, const dea_model *model, dea_sample *samples,
                                     dea_summary *summary, dea_error *error);

#endif
