/* What differs between SUNDIALS 6.4 and 7, and the clean-up that every user of it here shares. */
#ifndef DEA_IDA_SUNDIALS_H
#define DEA_IDA_SUNDIALS_H

#include <ida/ida.h>
#include <nvector/nvector_serial.h>
#include <sundials/sundials_config.h>
#include <sunlinsol/sunlinsol_dense.h>
#include <sunmatrix/sunmatrix_dense.h>

#include "deaspice/engine.h"

#if SUNDIALS_VERSION_MAJOR >= 7
#define DEA_SUN_COMM_NULL SUN_COMM_NULL
#else
#define DEA_SUN_COMM_NULL NULL
#endif

/* An IDA integrator of n unknowns with a dense matrix. Zeroed is empty. */
typedef struct dea_integrator {
    SUNContext context; /* borrowed */
    void *ida;          /* owned, as all below */
    N_Vector y, yp;     /* solution and derivative */
    N_Vector id;        /* 1: differential, 0: algebraic */
    N_Vector tolerance; /* absolute, per component */
    SUNMatrix matrix;
    SUNLinearSolver solver;
} dea_integrator;

/* Makes an integrator for @p residual; the caller ends it with dea_integrator_close(), also after a failure. */
dea_status dea_integrator_open(SUNContext context, sunindextype n, IDAResFn residual, dea_integrator *integrator,
                               dea_error *error);
void dea_integrator_close(dea_integrator *integrator);

/* A context that prints nothing. */
dea_status dea_sundials_open(SUNContext *context, dea_error *error);
#if SUNDIALS_VERSION_MAJOR < 7
/* Message handler of IDA and KINSOL that drops the message; from SUNDIALS 7 on the context does that. */
void dea_sundials_ignore(int code, const char *module, const char *function, char *message, void *user);
#endif

/* The two kinds of static problem; both fill the row, `failed` where nothing converged. */
struct dea_balance;
typedef struct dea_ramp dea_ramp;
dea_status dea_ramp_open(SUNContext context, dea_ramp **ramp, dea_error *error);
void dea_ramp_close(dea_ramp *ramp);
/* Equilibrium of a network: an index-1 problem along its displacement, stopped at the full load or where the stiffness vanishes.
 */
void dea_ramp_solve(dea_ramp *ramp, struct dea_balance *balance, double symbol, double accuracy, dea_row *row);

typedef struct dea_shooting dea_shooting;
dea_status dea_shooting_open(SUNContext context, dea_shooting **shooting, dea_error *error);
void dea_shooting_close(dea_shooting *shooting);
/* Exact membrane: IDA along ln R, KINSOL for the condition at the frame. */
void dea_shooting_solve(dea_shooting *shooting, const dea_point *point, double accuracy, dea_row *row);

/* One transient: fills samples and summary, `failed` or `pull_in` from where the run cannot go on. */
dea_status dea_transient_solve(SUNContext context, const dea_scene *scene, const dea_model *model, dea_sample *samples,
                               dea_summary *summary, dea_error *error);

#endif
