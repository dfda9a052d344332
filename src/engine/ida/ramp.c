/* Equilibrium of a network as an index-1 problem: with the share t of the load as the free variable,
 *
 *     [ R(u) - t F(u) ] / (K_0 l) = 0,   y = u/l,
 *
 * IDA follows u(t) from rest; K_0 is the stiffness at rest and l the size of the film, so that no tolerance depends on the
 * actuator's size. The stiffness (R' - t F')/K_0 is watched as a root function: where it vanishes the equilibrium folds, which is
 * pull-in. */
#include <math.h>
#include <stdlib.h>

#include "engine/ida/sundials.h"
#include "network/balance.h"

struct dea_ramp {
    dea_integrator integrator;
    dea_balance *balance; /* borrowed for one solve, as all below */
    double symbol;
    double length;    /* l [m] */
    double stiffness; /* K_0 [N/m] */
};

static int residual(sunrealtype t, N_Vector y, N_Vector yp, N_Vector r, void *user)
{
    dea_ramp *ramp = user;
    (void)yp;
    const dea_forces f = dea_balance_forces(ramp->balance, ramp->symbol, N_VGetArrayPointer(y)[0] * ramp->length);
    N_VGetArrayPointer(r)[0] = (f.elastic - t * f.load) / (ramp->stiffness * ramp->length);
    return isfinite(N_VGetArrayPointer(r)[0]) ? 0 : 1;
}

static double relative_stiffness(dea_ramp *ramp, double t, double y)
{
    const dea_forces f = dea_balance_forces(ramp->balance, ramp->symbol, y * ramp->length);
    return (f.elastic_slope - t * f.load_slope) / ramp->stiffness;
}

static int jacobian(sunrealtype t, sunrealtype cj, N_Vector y, N_Vector yp, N_Vector r, SUNMatrix matrix, void *user,
                    N_Vector work1, N_Vector work2, N_Vector work3)
{
    (void)cj, (void)yp, (void)r, (void)work1, (void)work2, (void)work3;
    SM_ELEMENT_D(matrix, 0, 0) = relative_stiffness(user, t, N_VGetArrayPointer(y)[0]);
    return 0;
}

static int softening(sunrealtype t, N_Vector y, N_Vector yp, sunrealtype *out, void *user)
{
    (void)yp;
    out[0] = relative_stiffness(user, t, N_VGetArrayPointer(y)[0]);
    return 0;
}

dea_status dea_ramp_open(SUNContext context, dea_ramp **out, dea_error *error)
{
    dea_ramp *ramp = calloc(1, sizeof *ramp);
    *out = ramp;
    if (!ramp) {
        return dea_fail(error, DEA_ERROR_MEMORY, "out of memory while IDA starts");
    }
    const dea_status status = dea_integrator_open(context, 1, residual, &ramp->integrator, error);
    if (status != DEA_OK) {
        return status;
    }
    void *ida = ramp->integrator.ida;
    if (IDASetJacFn(ida, jacobian) != IDA_SUCCESS || IDASetUserData(ida, ramp) != IDA_SUCCESS ||
        IDARootInit(ida, 1, softening) != IDA_SUCCESS) {
        return dea_fail(error, DEA_ERROR_ENGINE, "IDA did not start");
    }
    return DEA_OK;
}

void dea_ramp_close(dea_ramp *ramp)
{
    if (ramp) {
        dea_integrator_close(&ramp->integrator);
        free(ramp);
    }
}

/* Starts at rest with du/dt = F/K_0. */
static bool start(dea_ramp *ramp, double slope, double tolerance)
{
    dea_integrator *m = &ramp->integrator;
    N_VGetArrayPointer(m->y)[0] = 0.0;
    N_VGetArrayPointer(m->yp)[0] = slope;
    N_VGetArrayPointer(m->tolerance)[0] = tolerance * fabs(slope); /* of the size of the answer */
    return IDAReInit(m->ida, 0.0, m->y, m->yp) == IDA_SUCCESS &&
           IDASVtolerances(m->ida, tolerance, m->tolerance) == IDA_SUCCESS && IDASetStopTime(m->ida, 1.0) == IDA_SUCCESS;
}

void dea_ramp_solve(dea_ramp *ramp, dea_balance *balance, double symbol, double accuracy, dea_row *row)
{
    const double tolerance = fmin(1e-6, fmax(1e-4 * accuracy, 1e-12));
    dea_integrator *m = &ramp->integrator;
    *row = dea_row_failed();
    if (!dea_balance_valid(balance, symbol)) {
        return;
    }
    const dea_forces rest = dea_balance_forces(balance, symbol, 0.0);
    if (rest.load == 0.0) {
        (void)dea_balance_accept(balance, symbol, 0.0, accuracy, row);
        return;
    }
    if (!(rest.elastic_slope > 0.0)) {
        row->state = DEA_STATE_PULL_IN;
        return;
    }
    ramp->balance = balance;
    ramp->symbol = symbol;
    ramp->length = dea_balance_length(balance);
    ramp->stiffness = rest.elastic_slope;
    double t = 0.0;
    const int code = start(ramp, rest.load / (rest.elastic_slope * ramp->length), tolerance)
                         ? IDASolve(m->ida, 1.0, &t, m->y, m->yp, IDA_NORMAL)
                         : IDA_ILL_INPUT;
    const double y = N_VGetArrayPointer(m->y)[0];
    if (code == IDA_TSTOP_RETURN || code == IDA_SUCCESS) {
        dea_balance_fill(balance, symbol, y * ramp->length, row);
    } else if (code == IDA_ROOT_RETURN || relative_stiffness(ramp, t, y) < 1e-2) {
        row->state = DEA_STATE_PULL_IN; /* close to the fold u(t) turns vertical and no step is short enough */
    }
}
