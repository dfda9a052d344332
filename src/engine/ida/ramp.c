/* Equilibrium of a network as an index-1 problem along its displacement: with u = u_0 + x l, u_0 where the film rests without
 * voltage, l the linear answer or the size of the film, whichever is smaller,
 *
 *     dx/dtau = 1,   [ R(u) - t F(u) ] / F(u_0) = 0,
 *
 * IDA follows the share t of the load that holds u, from rest on. Two root functions are watched: t - 1, the answer, and the
 * stiffness (R' - t F')/K_0, whose zero is the fold where t stops growing: pull-in. Along u, unlike along the load, a fold is no
 * singular place. */
#include <math.h>
#include <stdlib.h>

#include "engine/ida/sundials.h"
#include "network/balance.h"

enum { PLACE, SHARE, UNKNOWNS };
enum { FULL_LOAD, FOLD, ROOTS };

struct dea_ramp {
    dea_integrator integrator;
    dea_balance *balance; /* borrowed for one solve, as all below */
    double symbol;
    double accuracy;  /* of u, relative [1] */
    double begin;     /* u_0 [m] */
    double length;    /* l, signed as u - u_0 [m] */
    double load;      /* F(u_0) [N] */
    double stiffness; /* K_0 = R'(u_0) [N/m] */
};

static dea_forces forces_at(const dea_ramp *ramp, const sunrealtype *v)
{
    return dea_balance_forces(ramp->balance, ramp->symbol, ramp->begin + v[PLACE] * ramp->length);
}

static int residual(sunrealtype tau, N_Vector y, N_Vector yp, N_Vector r, void *user)
{
    dea_ramp *ramp = user;
    const sunrealtype *v = NV_DATA_S(y);
    sunrealtype *out = NV_DATA_S(r);
    (void)tau;
    const dea_forces f = forces_at(ramp, v);
    out[PLACE] = NV_DATA_S(yp)[PLACE] - 1.0;
    out[SHARE] = (f.elastic - v[SHARE] * f.load) / ramp->load;
    return isfinite(out[SHARE]) ? 0 : 1; /* a trial step too far: IDA takes a shorter one */
}

static int jacobian(sunrealtype tau, sunrealtype cj, N_Vector y, N_Vector yp, N_Vector r, SUNMatrix matrix, void *user,
                    N_Vector work1, N_Vector work2, N_Vector work3)
{
    dea_ramp *ramp = user;
    const sunrealtype *v = NV_DATA_S(y);
    (void)tau, (void)yp, (void)r, (void)work1, (void)work2, (void)work3;
    const dea_forces f = forces_at(ramp, v);
    SM_ELEMENT_D(matrix, PLACE, PLACE) = cj;
    SM_ELEMENT_D(matrix, PLACE, SHARE) = 0.0;
    SM_ELEMENT_D(matrix, SHARE, PLACE) = (f.elastic_slope - v[SHARE] * f.load_slope) * ramp->length / ramp->load;
    SM_ELEMENT_D(matrix, SHARE, SHARE) = -f.load / ramp->load;
    return 0;
}

static int watch(sunrealtype tau, N_Vector y, N_Vector yp, sunrealtype *out, void *user)
{
    dea_ramp *ramp = user;
    const sunrealtype *v = NV_DATA_S(y);
    (void)tau, (void)yp;
    const dea_forces f = forces_at(ramp, v);
    out[FULL_LOAD] = v[SHARE] - 1.0;
    out[FOLD] = (f.elastic_slope - v[SHARE] * f.load_slope) / ramp->stiffness;
    return 0;
}

dea_status dea_ramp_open(const dea_sundials *sun, dea_ramp **out, dea_error *error)
{
    dea_ramp *ramp = calloc(1, sizeof *ramp);
    *out = ramp;
    if (!ramp) {
        return dea_fail(error, DEA_ERROR_MEMORY, "out of memory while IDA starts");
    }
    const dea_status status = dea_integrator_open(sun, UNKNOWNS, residual, &ramp->integrator, error);
    if (status != DEA_OK) {
        return status;
    }
    void *ida = ramp->integrator.ida;
    if (sun->IDASetJacFn(ida, jacobian) != IDA_SUCCESS || sun->IDASetUserData(ida, ramp) != IDA_SUCCESS ||
        sun->IDARootInit(ida, ROOTS, watch) != IDA_SUCCESS) {
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

/* Starts at rest, where dt/dx is K_0 l/F(0). */
static bool start(dea_ramp *ramp, double tolerance, double end)
{
    dea_integrator *m = &ramp->integrator;
    const dea_sundials *sun = m->sun;
    sun->N_VConst(0.0, m->y);
    sun->N_VConst(1.0, m->yp);
    NV_DATA_S(m->yp)[SHARE] = ramp->stiffness * ramp->length / ramp->load;
    sun->N_VConst(tolerance, m->tolerance);
    return sun->IDAReInit(m->ida, 0.0, m->y, m->yp) == IDA_SUCCESS &&
           sun->IDASVtolerances(m->ida, tolerance, m->tolerance) == IDA_SUCCESS &&
           sun->IDASetStopTime(m->ida, end) == IDA_SUCCESS;
}

/* Steps of one way from rest after which it is given up; a good one takes some hundreds. */
enum { MOST_STEPS = 20000 };

/* Largest part of the stretch by which a step moves the film, so that no fold is stepped over: of what it is there, since some films
 * come to thousands of their size. */
static const double longest = 0.05;

/* Steps to an answer, a fold or the end; IDA's own code says which. */
static int walk(dea_ramp *ramp, double end)
{
    dea_integrator *m = &ramp->integrator;
    const double size = dea_balance_length(ramp->balance) / fabs(ramp->length);
    double tau = 0.0;
    int code = IDA_SUCCESS;
    for (int i = 0; i < MOST_STEPS && code == IDA_SUCCESS; i++) {
        code = m->sun->IDASetMaxStep(m->ida, longest * (size + NV_DATA_S(m->y)[PLACE]));
        if (code == IDA_SUCCESS) {
            code = m->sun->IDASolve(m->ida, end, &tau, m->y, m->yp, IDA_ONE_STEP);
        }
    }
    return code == IDA_SUCCESS ? IDA_TOO_MUCH_WORK : code;
}

/* From rest to the answer, a fold or the end; false where IDA gives up, as where the load turns so steeply, just before the
 * chains are straight, that the rounding of u outweighs the tolerance of its share. A coarser one then does: what it leaves open
 * of u is little, and a fold may be none, which the network itself confirms. */
static bool follow(dea_ramp *ramp, double tolerance, double end, dea_row *row)
{
    dea_integrator *m = &ramp->integrator;
    const bool fine = tolerance <= ramp->accuracy;
    double share, where;
    int found[ROOTS] = {0, 0};
    const int code = start(ramp, tolerance, end) ? walk(ramp, end) : IDA_ILL_INPUT;
    if (code == IDA_ROOT_RETURN && m->sun->IDAGetRootInfo(m->ida, found) == IDA_SUCCESS && found[FULL_LOAD]) {
        const double u = ramp->begin + NV_DATA_S(m->y)[PLACE] * ramp->length;
        if (fine) {
            dea_balance_fill(ramp->balance, ramp->symbol, u, row);
        } else {
            (void)dea_balance_accept(ramp->balance, ramp->symbol, u, ramp->accuracy, row);
        }
    } else if (code >= 0 && (fine || dea_balance_folds(ramp->balance, ramp->symbol, &share, &where))) {
        row->state = DEA_STATE_PULL_IN; /* a fold, or the end of the film */
    }
    return code >= 0;
}

void dea_ramp_solve(dea_ramp *ramp, dea_balance *balance, double symbol, double accuracy, dea_row *row)
{
    const double tolerance = fmin(1e-6, fmax(2e-5 * accuracy, 1e-12));
    *row = dea_row_failed();
    if (!dea_balance_valid(balance, symbol)) {
        return;
    }
    const double begin = dea_balance_rest(balance, symbol);
    const dea_forces rest = dea_balance_forces(balance, symbol, begin);
    if (rest.load == 0.0) {
        (void)dea_balance_accept(balance, symbol, begin, accuracy, row);
        return;
    }
    if (!(rest.elastic_slope > 0.0)) { /* NAN: no rest */
        row->state = DEA_STATE_PULL_IN;
        return;
    }
    ramp->balance = balance;
    ramp->symbol = symbol;
    ramp->accuracy = accuracy;
    ramp->begin = begin;
    ramp->load = rest.load;
    ramp->stiffness = rest.elastic_slope;
    const double linear = rest.load / rest.elastic_slope;
    ramp->length = copysign(fmin(fabs(linear), dea_balance_length(balance)), linear);
    const double end = dea_balance_end(balance) / fabs(ramp->length);
    if (!follow(ramp, tolerance, end, row) && !follow(ramp, 1e3 * tolerance, end, row)) {
        (void)follow(ramp, 1e6 * tolerance, end, row);
    }
}
