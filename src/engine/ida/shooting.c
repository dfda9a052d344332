/* Exact axisymmetric membrane as an index-1 problem along x = ln(R/R_a). With the changes from the pre-stretched film,
 * Sigma = s1 - p_pre, d1 = lambda_1 - lambda_pre, d2 = lambda_2 - lambda_pre,
 *
 *     dSigma/dx + (s1 - s2) = 0,   dd2/dx - (d1 - d2) = 0,   p1(lambda_1, lambda_2) - p_pre - k lambda_1 lambda_2^2 - Sigma = 0.
 *
 * IDA finds lambda_1 behind the edge itself, from the continuity of s1; KINSOL finds the edge, from d2 = 0 at the frame. Unknowns are
 * scaled by the load, so that no tolerance depends on its size. */
#include <math.h>
#include <stdlib.h>

#include <kinsol/kinsol.h>

#include "engine/ida/sundials.h"

static const double pi = 3.14159265358979323846;

enum { SIGMA, HOOP, RADIAL, UNKNOWNS };

struct dea_shooting {
    dea_integrator integrator;
    void *kinsol;          /* owned */
    N_Vector edge;         /* owned: d2 at r_a over `strain` */
    N_Vector ones;         /* owned */
    const dea_point *point; /* borrowed for one solve */
    double share;          /* of the load */
    double pressure;       /* M at full load [Pa] */
    double disc_k;         /* Maxwell pressure in the disc at this share [Pa] */
    double annulus_k;      /* and in the annulus [Pa] */
    double stress;         /* scale of Sigma [Pa] */
    double strain;         /* scale of d1, d2 [1] */
    double tolerance;
    double least_stress;   /* of the last integration [Pa] */
    double largest_area;   /* largest lambda_1 lambda_2 of the electroded region [1] */
    double edge_force;     /* lambda_1 lambda_2^2 of the electroded side at r_a [1] */
};

/* p1(l + d1, l + d2) - p1(l, l), factored in d1 and d2. */
static double stress_change(const dea_film *film, double d1, double d2)
{
    const double l = film->prestretch;
    const double l1 = l + d1;
    const double l2 = l + d2;
    const double y = l * l;
    const double p1 = d1 * (l1 + l); /* l1^2 - l^2 */
    const double p2 = d2 * (l2 + l);
    const double fourth = 1.0 / (l1 * l1 * l2 * l2);
    const double fifth = fourth / l1;
    const double drop4 = (l1 * l1 * p2 + y * p1) * fourth * film->inverse_fourth;                                       /* l^-4 - l1^-2 l2^-2 */
    const double drop5 = (l1 * l1 * l1 * p2 + y * d1 * (l1 * l1 + l1 * l + y)) * fifth * film->inverse_fourth / l; /* l^-5 - l1^-3 l2^-2 */
    const double dj = p1 + p2 - drop4;
    const double dw = dj * (2.0 * film->yeoh[1] + 3.0 * film->yeoh[2] * (2.0 * film->j + dj));
    return 2.0 * (film->w + dw) * (d1 + drop5) + dw * 2.0 * film->g / l;
}

static int residual(sunrealtype x, N_Vector y, N_Vector yp, N_Vector r, void *user)
{
    const dea_shooting *s = user;
    const dea_film *film = &s->point->film;
    const sunrealtype *v = N_VGetArrayPointer(y);
    const sunrealtype *slope = N_VGetArrayPointer(yp);
    sunrealtype *out = N_VGetArrayPointer(r);
    (void)x;
    const double d1 = s->strain * v[RADIAL];
    const double d2 = s->strain * v[HOOP];
    const double l1 = film->prestretch + d1;
    const double l2 = film->prestretch + d2;
    if (!(l1 > 0.0 && l2 > 0.0)) {
        return 1; /* a trial step too far: IDA takes a shorter one */
    }
    const double t = 1.0 / (l1 * l2);
    const double w = dea_yeoh_stress(film->yeoh, l1, l2).w;
    const double difference = (d1 - d2) * (2.0 * w * (1.0 + t * t * t) + s->annulus_k * l1 * l2); /* s1 - s2 */
    out[SIGMA] = slope[SIGMA] + difference / s->stress;
    out[HOOP] = slope[HOOP] - (v[RADIAL] - v[HOOP]);
    out[RADIAL] = (stress_change(film, d1, d2) - s->annulus_k * l1 * l2 * l2) / s->stress - v[SIGMA];
    return 0;
}

/* Notes stresses and area at one place of the annulus. */
static void note(dea_shooting *s)
{
    const sunrealtype *v = N_VGetArrayPointer(s->integrator.y);
    const double l1 = s->point->film.prestretch + s->strain * v[RADIAL];
    const double l2 = s->point->film.prestretch + s->strain * v[HOOP];
    const dea_stress stress = dea_yeoh_stress(s->point->film.yeoh, l1, l2);
    s->least_stress = fmin(s->least_stress, fmin(stress.p1 - s->annulus_k * l1 * l2 * l2, stress.p2 - s->annulus_k * l2 * l1 * l1));
    if (s->annulus_k > 0.0) {
        s->largest_area = fmax(s->largest_area, l1 * l2);
    }
}

/* Jump of lambda_1 at the edge by its own Newton steps, only to start IDA's search near its goal. */
static double jump_guess(const dea_shooting *s, double l)
{
    const double load = (s->disc_k - s->annulus_k) * l * l * l;
    const double at_edge = stress_change(&s->point->film, l - s->point->film.prestretch, l - s->point->film.prestretch);
    double jump = 0.0;
    double step = l;
    for (int i = 0; i < 40 && fabs(step) > 1e-6 * fabs(jump); i++) {
        const double d1 = l - jump - s->point->film.prestretch;
        const double slope = dea_yeoh_stress(s->point->film.yeoh, l - jump, l).w11 - s->annulus_k * l * l;
        step = (stress_change(&s->point->film, d1, l - s->point->film.prestretch) - at_edge + load + s->annulus_k * jump * l * l) / slope;
        jump = jump + step < l ? jump + step : 0.5 * (jump + l); /* keeps lambda_1 positive */
    }
    return jump;
}

/* Consistent start behind the edge; false where lambda_1 was not found. */
static bool start(dea_shooting *s, double edge)
{
    dea_integrator *m = &s->integrator;
    const double l = s->point->film.prestretch + edge;
    const double sigma = stress_change(&s->point->film, edge, edge) - s->disc_k * l * l * l;
    sunrealtype *v = N_VGetArrayPointer(m->y);
    v[SIGMA] = sigma / s->stress;
    v[HOOP] = edge / s->strain;
    v[RADIAL] = (edge - jump_guess(s, l)) / s->strain;
    N_VConst(0.0, m->yp);
    if (IDAReInit(m->ida, 0.0, m->y, m->yp) != IDA_SUCCESS || IDASVtolerances(m->ida, s->tolerance, m->tolerance) != IDA_SUCCESS ||
        IDACalcIC(m->ida, IDA_YA_YDP_INIT, 1e-3) != IDA_SUCCESS || IDAGetConsistentIC(m->ida, m->y, m->yp) != IDA_SUCCESS) {
        return false;
    }
    const double l1 = s->point->film.prestretch + s->strain * v[RADIAL];
    const bool lens = s->point->kind == DEA_LENS;
    s->least_stress = dea_yeoh_stress(s->point->film.yeoh, l, l).p1 - s->disc_k * l * l * l;
    s->largest_area = lens ? l1 * l : l * l;
    s->edge_force = lens ? l1 * l * l : l * l * l;
    note(s);
    return true;
}

/* d2 at the frame over its scale, for the edge at @p edge [1]; NAN where the integration fails. */
static double miss_at_frame(dea_shooting *s, double edge)
{
    dea_integrator *m = &s->integrator;
    const double length = -log(s->point->coverage);
    double x = 0.0;
    if (!(s->point->film.prestretch + edge > 0.0) || !start(s, edge) || IDASetStopTime(m->ida, length) != IDA_SUCCESS) {
        return NAN;
    }
    int code = IDA_SUCCESS;
    while (code == IDA_SUCCESS) {
        code = IDASolve(m->ida, length, &x, m->y, m->yp, IDA_ONE_STEP);
        if (code >= 0) {
            note(s);
        }
    }
    return code == IDA_TSTOP_RETURN ? N_VGetArrayPointer(m->y)[HOOP] : NAN;
}

/* Fixed point of the edge: edge - miss(edge); the slope of the miss is near 1, and Anderson's acceleration takes care of the rest. */
static int next_edge(N_Vector edge, N_Vector next, void *user)
{
    dea_shooting *s = user;
    const double at = N_VGetArrayPointer(edge)[0];
    const double miss = miss_at_frame(s, at * s->strain);
    if (isnan(miss)) {
        return -1;
    }
    N_VGetArrayPointer(next)[0] = at - miss;
    return 0;
}

#if SUNDIALS_VERSION_MAJOR < 7
static void ignore_message(int code, const char *module, const char *function, char *message, void *user)
{
    (void)code, (void)module, (void)function, (void)message, (void)user;
}
#endif

static bool open_kinsol(SUNContext context, dea_shooting *s)
{
    s->edge = N_VNew_Serial(1, context);
    s->ones = N_VNew_Serial(1, context);
    s->kinsol = KINCreate(context);
    if (!s->edge || !s->ones || !s->kinsol) {
        return false;
    }
    N_VConst(1.0, s->ones);
#if SUNDIALS_VERSION_MAJOR < 7
    KINSetErrHandlerFn(s->kinsol, ignore_message, NULL);
#endif
    return KINSetMAA(s->kinsol, 1) == KIN_SUCCESS && KINInit(s->kinsol, next_edge, s->edge) == KIN_SUCCESS &&
           KINSetUserData(s->kinsol, s) == KIN_SUCCESS && KINSetNumMaxIters(s->kinsol, 40) == KIN_SUCCESS;
}

dea_status dea_shooting_open(SUNContext context, dea_shooting **out, dea_error *error)
{
    dea_shooting *s = calloc(1, sizeof *s);
    *out = s;
    if (!s) {
        return dea_fail(error, DEA_ERROR_MEMORY, "out of memory while IDA starts");
    }
    const dea_status status = dea_integrator_open(context, UNKNOWNS, residual, &s->integrator, error);
    if (status != DEA_OK) {
        return status;
    }
    N_VGetArrayPointer(s->integrator.id)[RADIAL] = 0.0;
    if (IDASetUserData(s->integrator.ida, s) != IDA_SUCCESS || IDASetId(s->integrator.ida, s->integrator.id) != IDA_SUCCESS ||
        !open_kinsol(context, s)) {
        return dea_fail(error, DEA_ERROR_ENGINE, "IDA and KINSOL did not start");
    }
    return DEA_OK;
}

void dea_shooting_close(dea_shooting *s)
{
    if (s) {
        if (s->kinsol) {
            KINFree(&s->kinsol);
        }
        if (s->edge) {
            N_VDestroy(s->edge);
        }
        if (s->ones) {
            N_VDestroy(s->ones);
        }
        dea_integrator_close(&s->integrator);
        free(s);
    }
}

static void set_share(dea_shooting *s, double share)
{
    const bool dot = s->point->kind == DEA_DOT;
    const double l = s->point->film.prestretch;
    s->share = share;
    s->disc_k = dot ? share * s->pressure : 0.0;
    s->annulus_k = dot ? 0.0 : share * s->pressure;
    s->stress = share * s->pressure * l * l * l;
    s->strain = s->stress / s->point->film.w11;
    N_VConst(s->tolerance, s->integrator.tolerance);
}

/* Edge at this share of the load from a guess; true where KINSOL settled on a stable one. *edge is in and out, absolute. */
static bool settle(dea_shooting *s, double share, double *edge, double *stiffness)
{
    set_share(s, share);
    N_VGetArrayPointer(s->edge)[0] = *edge / s->strain;
    KINSetFuncNormTol(s->kinsol, 100.0 * s->tolerance * fabs(*edge / s->strain));
    const int code = KINSol(s->kinsol, s->edge, KIN_FP, s->ones, s->ones);
    const double at = N_VGetArrayPointer(s->edge)[0];
    if (code < 0 || !isfinite(at)) {
        return false;
    }
    const double nudge = 1e-4 * at;
    *stiffness = (miss_at_frame(s, (at + nudge) * s->strain) - miss_at_frame(s, (at - nudge) * s->strain)) / (2.0 * nudge);
    *edge = at * s->strain;
    return true;
}

/* Follows the edge while the load grows, in steps that halve where no stable edge is found; false: it folds before the full load. */
static bool follow(dea_shooting *s, double *edge)
{
    double share = 0.0;
    double step = 0.125;
    double slope = *edge; /* per share of the load */
    *edge = 0.0;
    while (share < 1.0) {
        const double next = fmin(1.0, share + step);
        double stiffness = NAN;
        double guess = *edge + slope * (next - share);
        if (settle(s, next, &guess, &stiffness) && stiffness > 0.0 && fabs(guess - *edge) < 0.5 * s->point->film.prestretch) {
            slope = (guess - *edge) / (next - share);
            *edge = guess;
            share = next;
        } else {
            step *= 0.5;
            if (step < 1e-7) {
                return false;
            }
        }
    }
    return true;
}

void dea_shooting_solve(dea_shooting *s, const dea_point *point, double accuracy, dea_row *row)
{
    const dea_film *film = &point->film;
    const double sign = point->kind == DEA_DOT ? 1.0 : -1.0;
    const double nominal = point->voltage / point->film_thickness;
    const double b2 = point->coverage * point->coverage;
    double edge = 0.0;
    double stiffness = 1.0;
    s->point = point;
    s->pressure = film->permittivity * nominal * nominal;
    s->tolerance = fmin(1e-7, fmax(1e-6 * accuracy, 1e-12));
    *row = dea_row_failed();
    if (s->pressure == 0.0) {
        *row = (dea_row){0.0, 0.0, 0.0, 0.0, film->tension > 0.0 ? DEA_STATE_OK : DEA_STATE_SLACK};
        return;
    }
    if (!(film->w11 > 0.0)) {
        row->state = DEA_STATE_PULL_IN;
        return;
    }
    const double linear = sign * s->pressure * film->square * film->prestretch * (1.0 - b2) / (2.0 * film->w11); /* without softening */
    edge = linear;
    if (!settle(s, 1.0, &edge, &stiffness) || !(stiffness > 0.5) || fabs(edge) > 0.1 * film->prestretch) {
        edge = linear;
        if (!follow(s, &edge)) {
            row->state = DEA_STATE_PULL_IN;
            return;
        }
    }
    if (isnan(miss_at_frame(s, edge))) {
        return;
    }
    const double radius = point->coverage * point->frame_radius;
    const double strain = edge / film->prestretch;
    const double field = fabs(nominal) * s->largest_area;
    const double force = sign * 2.0 * pi * point->film_thickness * s->pressure * s->edge_force * radius / film->prestretch;
    *row = (dea_row){strain, strain * radius, force, field,
                     field > film->breakdown ? DEA_STATE_BREAKDOWN : s->least_stress > 0.0 ? DEA_STATE_OK : DEA_STATE_SLACK};
}
