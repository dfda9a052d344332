/* Exact axisymmetric membrane as an index-1 problem along x = ln(R/R_a). With the changes from the pre-stretched film,
 * Sigma = s1 - p_pre, d1 = lambda_1 - lambda_pre, d2 = lambda_2 - lambda_pre,
 *
 *     dSigma/dx + (s1 - s2) = 0,   dd2/dx - (d1 - d2) = 0,   p1(lambda_1, lambda_2) - p_pre - k lambda_1 lambda_2^2 - Sigma = 0.
 *
 *
 * IDA finds lambda_1 behind the edge itself, from the continuity of s1; KINSOL finds the edge, from d2 = 0 at the frame. Unknowns
 * are scaled by the load, so that no tolerance depends on its size. The capacitance of the annulus of a lens,
 * (2 pi eps R_a^2/H) int (lambda_1 lambda_2)^2 exp(2 x) dx, is summed over IDA's own steps. A permittivity that follows the strain
 * puts its factors (dea_film_electric()) before k and that integrand. */
#include <math.h>
#include <stdlib.h>

#include "engine/ida/sundials.h"
#include "model/loaded.h"
#include "model/path.h"

enum { SIGMA, HOOP, RADIAL, UNKNOWNS };

/* What KINSOL searches: the edge at a load, the load at an edge, or what must pull at an edge that is held. */
typedef enum search { SEARCH_EDGE, SEARCH_SHARE, SEARCH_PULL } search;

/* Steps along the radius after which a guess is taken as hopeless; a good one takes some hundreds. */
enum { MOST_STEPS = 3000 };

/* Tightest tolerance of IDA: ten times that leaves an error of 4e-9 in the force of a film deep in slack. */
static const double finest = 1e-13;
/* Share of s11 at rest below which a film that cannot be followed any further has come to its end. */
static const double nearly = 0.1;

/* What limits the film at a place. */
typedef struct limits {
    double x;
    double stress;                /* smaller in-plane nominal stress [Pa] */
    double s11;                   /* its radial stiffness [Pa] */
    double hoop, hoop_slope;      /* [Pa] */
    double area, area_slope;      /* lambda_1 lambda_2 [1] */
} limits;

/* Integrand of the capacitance, q = (lambda_1 lambda_2)^2 exp(2 x), at one place. */
typedef struct panel {
    double x, value, slope;
} panel;

struct dea_shooting {
    dea_integrator integrator;
    void *kinsol;           /* owned */
    N_Vector edge;          /* owned: d2 at r_a over `strain` */
    N_Vector ones;          /* owned */
    const dea_point *point; /* borrowed for one solve */
    search search;          /* what KINSOL searches now */
    double share;           /* of the load that KINSOL's 1 stands for [1] */
    double held;            /* edge that is held while the load is searched, or a size of the edge [1] */
    double pressure;        /* M at full load [Pa] */
    double disc_k;          /* Maxwell pressure in the disc at this share [Pa] */
    double annulus_k;       /* and in the annulus [Pa] */
    double pull;            /* what pulls the edge outward beside film and load, over 2 pi R_a H, less what a uniform film wants [Pa] */
    double uniform;         /* where the edge is held: what of a uniform film's s1 is the voltage's, over lambda_pre^3, and no part of
                               Sigma; else 0 [Pa] */
    double stress;          /* scale of Sigma [Pa] */
    double strain;          /* scale of d1, d2 [1] */
    double tolerance;
    double least_stress; /* of the last integration [Pa] */
    double least_s11;    /* and there: without it no such film is stable [Pa] */
    double largest_area; /* largest lambda_1 lambda_2 of the electroded region [1] */
    double edge_force;   /* lambda_1 lambda_2^2 of the electroded side at r_a, over k its stress [1] */
    double radial;       /* lambda_1 behind r_a [1] */
    limits limits;       /* at the end of the last step */
    panel end;           /* and there */
    double charge;       /* int (lambda_1 lambda_2)^2 exp(2 x) dx up to there [1] */
};

/* Regions of the film: the disc of a dot and the annulus of a lens carry the skin. */
typedef enum region { DISC, ANNULUS } region;

static bool is_coated(const dea_shooting *s, region where)
{
    return s->point->skin_share > 0.0 && (where == DISC) == (s->point->kind == DEA_DOT);
}

/* p1(l + d1, l + d2) - p1(l, l) with l = lambda_pre. */
static double stress_change(const dea_shooting *s, region where, double d1, double d2)
{
    const dea_film *film = &s->point->film;
    const double change = film->law->rise(film->constants, film->prestretch, d1, d2);
    return is_coated(s, where) ? change + dea_point_skin_rise(s->point, d1, d2) : change;
}

/* What a load k at the edge adds to s1 of the annulus, k u/(2 pi R_a H), less what pulls there. */
static double load_stress(const dea_shooting *s, double edge)
{
    return s->point->load * edge / (2.0 * DEA_PI * s->point->film_thickness) - s->pull;
}

static dea_stress stress_at(const dea_shooting *s, region where, double l1, double l2)
{
    const dea_film *film = &s->point->film;
    return is_coated(s, where) ? dea_point_coated_stress(s->point, l1, l2) : film->law->stress(film->constants, l1, l2);
}

/* Electrical stress k lambda_1 lambda_2^2 of the annulus, k that of its permittivity there and its electrostriction, less that of a
 * uniform film where `uniform` is: by the rises of both factors, so that it keeps the digits of a small strain. */
static double annulus_pull(const dea_shooting *s, double d1, double d2)
{
    const dea_film *film = &s->point->film;
    const double pre = film->prestretch, l1 = pre + d1, l2 = pre + d2, k = s->annulus_k * dea_film_electric(film, l1 * l2).first;
    if (s->uniform == 0.0) {
        return k * l1 * l2 * l2;
    }
    const double stretch = (d1 * l2 + pre * d2) / (sqrt(l1 * l2) + pre); /* rise of the mean stretch, on which `first` is linear */
    return k * (d1 * l2 * l2 + pre * d2 * (2.0 * pre + d2)) + 1.25 * s->annulus_k * film->electrostriction * stretch * pre * pre * pre;
}

static int residual(sunrealtype x, N_Vector y, N_Vector yp, N_Vector r, void *user)
{
    const dea_shooting *s = user;
    const dea_film *film = &s->point->film;
    const sunrealtype *v = NV_DATA_S(y);
    const sunrealtype *slope = NV_DATA_S(yp);
    sunrealtype *out = NV_DATA_S(r);
    (void)x;
    const double d1 = s->strain * v[RADIAL];
    const double d2 = s->strain * v[HOOP];
    const double l1 = film->prestretch + d1;
    const double l2 = film->prestretch + d2;
    const double shear = l1 > 0.0 && l2 > 0.0 ? stress_at(s, ANNULUS, l1, l2).shear : NAN;
    if (isnan(shear)) {
        return 1; /* a trial step too far, or past the end of the energy: IDA takes a shorter one */
    }
    const double k = s->annulus_k * dea_film_electric(film, l1 * l2).first;
    const double difference = (d1 - d2) * (shear + k * l1 * l2); /* s1 - s2 */
    out[SIGMA] = slope[SIGMA] + difference / s->stress;
    out[HOOP] = slope[HOOP] - (v[RADIAL] - v[HOOP]);
    out[RADIAL] = (stress_change(s, ANNULUS, d1, d2) - annulus_pull(s, d1, d2)) / s->stress - v[SIGMA];
    return 0;
}

/* Scales of the unknowns for a share of the load. */
static void set_scales(dea_shooting *s, double share)
{
    const double l = s->point->film.prestretch;
    s->stress = share * s->pressure * l * l * l;
    s->strain = s->stress / s->point->film.w11;
}

static void set_load(dea_shooting *s, double share)
{
    const bool dot = s->point->kind == DEA_DOT;
    s->disc_k = dot ? share * s->pressure : 0.0;
    s->annulus_k = dot ? 0.0 : share * s->pressure;
}

/* What limits the film at a place of the annulus: smaller stress, hoop stress and area, the last two with their slopes. */
static limits limits_at(const dea_shooting *s, double x)
{
    const sunrealtype *v = NV_DATA_S(s->integrator.y), *slope = NV_DATA_S(s->integrator.yp);
    const double l1 = s->point->film.prestretch + s->strain * v[RADIAL], l1_slope = s->strain * slope[RADIAL];
    const double l2 = s->point->film.prestretch + s->strain * v[HOOP], l2_slope = s->strain * slope[HOOP];
    const dea_electric electric = dea_film_electric(&s->point->film, l1 * l2);
    const double k = s->annulus_k * electric.first, k_slope = s->annulus_k * electric.second;
    const dea_stress stress = stress_at(s, ANNULUS, l1, l2);
    const double hoop = stress.p2 - k * l2 * l1 * l1;
    return (limits){.x = x,
                    .stress = fmin(stress.p1 - k * l1 * l2 * l2, hoop),
                    .s11 = stress.w11 - k_slope * l2 * l2,
                    .hoop = hoop,
                    .hoop_slope = (stress.w12 - (k + k_slope) * l1 * l2) * l1_slope + (stress.w22 - k_slope * l1 * l1) * l2_slope,
                    .area = l1 * l2,
                    .area_slope = l1_slope * l2 + l1 * l2_slope};
}

/* Largest value of the cubic through two values and slopes over a width; of one that only rises or falls the larger end. */
static double largest_between(double width, double a, double slope_a, double b, double slope_b)
{
    double low = 0.0, high = 1.0;
    if (!(slope_a > 0.0 && slope_b < 0.0)) {
        return fmax(a, b);
    }
    const double p = width * slope_a, q = width * slope_b, d = b - a;
    for (int i = 0; i < 50; i++) { /* of its slope p + 2 (3 d - 2 p - q) t + 3 (p + q - 2 d) t^2 */
        const double t = 0.5 * (low + high);
        *(p + t * (2.0 * (3.0 * d - 2.0 * p - q) + 3.0 * t * (p + q - 2.0 * d)) > 0.0 ? &low : &high) = t;
    }
    return fmax(fmax(a, b), a + low * (p + low * ((3.0 * d - 2.0 * p - q) + low * (p + q - 2.0 * d))));
}

/* Notes stresses and area at one place of the annulus, and between it and the last. (s1 is least where it crosses s2, which is
 * smaller to one side of that.) */
static void note(dea_shooting *s, double x)
{
    const limits from = s->limits, to = limits_at(s, x);
    const double width = to.x - from.x;
    s->limits = to;
    s->least_stress = fmin(s->least_stress, to.stress);
    s->least_s11 = fmin(s->least_s11, to.s11);
    s->least_stress = fmin(s->least_stress, -largest_between(width, -from.hoop, -from.hoop_slope, -to.hoop, -to.hoop_slope));
    if (s->annulus_k > 0.0) {
        s->largest_area = fmax(s->largest_area, largest_between(width, from.area, from.area_slope, to.area, to.area_slope));
    }
}

static panel panel_at(const dea_shooting *s, double x)
{
    const sunrealtype *v = NV_DATA_S(s->integrator.y), *slope = NV_DATA_S(s->integrator.yp);
    const double l1 = s->point->film.prestretch + s->strain * v[RADIAL];
    const double l2 = s->point->film.prestretch + s->strain * v[HOOP];
    const double area = l1 * l2, growth = s->strain * (slope[RADIAL] * l2 + l1 * slope[HOOP]), weight = exp(2.0 * x);
    const dea_electric electric = dea_film_electric(&s->point->film, area);
    return (panel){x, electric.own * area * area * weight, 2.0 * area * (electric.first * growth + electric.own * area) * weight};
}

/* Adds the step to @p x by the trapezoidal rule with its end correction, h/2 (q0 + q1) + h^2/12 (q0' - q1'). */
static void add_charge(dea_shooting *s, double x)
{
    const panel from = s->end, to = panel_at(s, x);
    const double h = to.x - from.x;
    s->charge += h * (0.5 * (from.value + to.value) + h / 12.0 * (from.slope - to.slope));
    s->end = to;
}

/* Nominal stress of the voltage in the uniform disc. */
static double disc_pull(const dea_shooting *s, double l)
{
    return s->disc_k * dea_film_electric(&s->point->film, l * l).first * l * l * l;
}

/* Jump of lambda_1 at the edge by its own Newton steps, only to start IDA's search near its goal. */
static double jump_guess(const dea_shooting *s, double l)
{
    const double edge = l - s->point->film.prestretch;
    const double at_edge = stress_change(s, DISC, edge, edge) + load_stress(s, edge) - disc_pull(s, l);
    double jump = 0.0;
    double sound = 0.0; /* last place within the energy */
    for (int i = 0; i < 60; i++) {
        const dea_electric electric = dea_film_electric(&s->point->film, (l - jump) * l);
        const double slope = stress_at(s, ANNULUS, l - jump, l).w11 - s->annulus_k * electric.second * l * l;
        if (isnan(slope) && jump != sound) { /* a step went past the end of the energy */
            jump = 0.5 * (sound + jump);
            continue;
        }
        sound = jump;
        const double excess = stress_change(s, ANNULUS, edge - jump, edge) - at_edge - annulus_pull(s, edge - jump, edge);
        const double most = 0.25 * (l - jump); /* lambda_1 moves by a quarter at most: the first root is meant */
        jump += slope > 0.0 ? fmax(-most, fmin(most, excess / slope)) : copysign(most, excess);
        if (fabs(jump - sound) <= 1e-9 * fabs(jump)) {
            break;
        }
    }
    return jump;
}

/* Consistent start behind the edge; false where lambda_1 was not found. */
static bool start(dea_shooting *s, double edge)
{
    dea_integrator *m = &s->integrator;
    const dea_sundials *sun = m->sun;
    const double l = s->point->film.prestretch + edge;
    const double sigma = stress_change(s, DISC, edge, edge) + load_stress(s, edge) - disc_pull(s, l);
    sunrealtype *v = NV_DATA_S(m->y);
    v[SIGMA] = sigma / s->stress;
    v[HOOP] = edge / s->strain;
    v[RADIAL] = (edge - jump_guess(s, l)) / s->strain;
    sun->N_VConst(0.0, m->yp);
    if (sun->IDAReInit(m->ida, 0.0, m->y, m->yp) != IDA_SUCCESS ||
        sun->IDASVtolerances(m->ida, s->tolerance, m->tolerance) != IDA_SUCCESS ||
        sun->IDACalcIC(m->ida, IDA_YA_YDP_INIT, fmin(1e-3, -log(s->point->coverage))) != IDA_SUCCESS ||
        sun->IDAGetConsistentIC(m->ida, m->y, m->yp) != IDA_SUCCESS) {
        return false;
    }
    s->radial = s->point->film.prestretch + s->strain * v[RADIAL];
    s->least_stress = stress_at(s, DISC, l, l).p1 - disc_pull(s, l);
    s->largest_area = s->point->kind == DEA_LENS ? s->radial * l : l * l;
    s->edge_force = dea_film_electric(&s->point->film, s->largest_area).first * s->largest_area * l;
    s->least_s11 = INFINITY;
    s->charge = 0.0;
    s->end = panel_at(s, 0.0);
    s->limits = limits_at(s, 0.0);
    note(s, 0.0);
    return true;
}

/* d2 at the frame over its scale, for the edge at @p edge [1]; NAN where the integration fails. */
static double miss_at_frame(dea_shooting *s, double edge)
{
    dea_integrator *m = &s->integrator;
    const double length = -log(s->point->coverage);
    double x = 0.0;
    if (!(s->point->film.prestretch + edge > 0.0) || !start(s, edge) || m->sun->IDASetStopTime(m->ida, length) != IDA_SUCCESS) {
        return NAN;
    }
    int code = IDA_SUCCESS;
    for (int i = 0; i < MOST_STEPS && code == IDA_SUCCESS; i++) {
        code = m->sun->IDASolve(m->ida, length, &x, m->y, m->yp, IDA_ONE_STEP);
        if (code >= 0) {
            note(s, x);
            add_charge(s, x);
        }
    }
    return code == IDA_TSTOP_RETURN ? NV_DATA_S(m->y)[HOOP] : NAN;
}

/* 2 W11/(1 - B^2) [Pa]: what disc and annulus hold together, over the strain of the edge times lambda_pre. */
static double lame_stiffness(const dea_point *point)
{
    return 2.0 * point->film.w11 / (1.0 - point->coverage * point->coverage);
}

/* Fixed points for KINSOL: of the edge at a load, edge - miss, of the load at an edge, share + miss, or of the pull at an edge,
 * pull + 2 W11/(1 - B^2) miss, as Lame's film has it. All slopes are near 1 for a small strain, and Anderson's acceleration takes
 * care of the rest. */
static int next_guess(N_Vector guess, N_Vector next, void *user)
{
    dea_shooting *s = user;
    const double at = NV_DATA_S(guess)[0];
    if (s->search == SEARCH_SHARE) {
        set_load(s, at * s->share);
    } else if (s->search == SEARCH_PULL) {
        s->pull = at * s->stress;
    }
    const double miss = miss_at_frame(s, s->search == SEARCH_EDGE ? at * s->strain : s->held) * s->strain / s->held;
    if (isnan(miss)) {
        return -1;
    }
    NV_DATA_S(next)[0] = s->search == SEARCH_EDGE    ? at - miss * s->held / s->strain
                         : s->search == SEARCH_SHARE ? at + miss
                                                     : at + miss * s->held * lame_stiffness(s->point) / s->stress;
    return 0;
}

static bool open_kinsol(const dea_sundials *sun, dea_shooting *s)
{
    s->edge = sun->N_VNew_Serial(1, sun->context);
    s->ones = sun->N_VNew_Serial(1, sun->context);
    s->kinsol = sun->KINCreate(sun->context);
    if (!s->edge || !s->ones || !s->kinsol) {
        return false;
    }
    sun->N_VConst(1.0, s->ones);
#if SUNDIALS_VERSION_MAJOR < 7
    sun->KINSetErrHandlerFn(s->kinsol, dea_sundials_ignore, NULL);
#endif
    return sun->KINSetMAA(s->kinsol, 1) == KIN_SUCCESS && sun->KINInit(s->kinsol, next_guess, s->edge) == KIN_SUCCESS &&
           sun->KINSetUserData(s->kinsol, s) == KIN_SUCCESS && sun->KINSetNumMaxIters(s->kinsol, 20) == KIN_SUCCESS;
}

dea_status dea_shooting_open(const dea_sundials *sun, dea_shooting **out, dea_error *error)
{
    dea_shooting *s = calloc(1, sizeof *s);
    *out = s;
    if (!s) {
        return dea_fail(error, DEA_ERROR_MEMORY, "out of memory while IDA starts");
    }
    const dea_status status = dea_integrator_open(sun, UNKNOWNS, residual, &s->integrator, error);
    if (status != DEA_OK) {
        return status;
    }
    NV_DATA_S(s->integrator.id)[RADIAL] = 0.0;
    if (sun->IDASetUserData(s->integrator.ida, s) != IDA_SUCCESS ||
        sun->IDASetId(s->integrator.ida, s->integrator.id) != IDA_SUCCESS || !open_kinsol(sun, s)) {
        return dea_fail(error, DEA_ERROR_ENGINE, "IDA and KINSOL did not start");
    }
    return DEA_OK;
}

void dea_shooting_close(dea_shooting *s)
{
    if (s) {
        const dea_sundials *sun = s->integrator.sun;
        if (s->kinsol) {
            sun->KINFree(&s->kinsol);
        }
        if (s->edge) {
            sun->N_VDestroy(s->edge);
        }
        if (s->ones) {
            sun->N_VDestroy(s->ones);
        }
        dea_integrator_close(&s->integrator);
        free(s);
    }
}

/* Runs KINSOL from v = start on; NAN where it does not settle. */
static double search_from(dea_shooting *s, search what, double start)
{
    const dea_sundials *sun = s->integrator.sun;
    s->search = what;
    sun->N_VConst(s->tolerance, s->integrator.tolerance);
    NV_DATA_S(s->integrator.tolerance)[HOOP] *= 1.0 - s->point->coverage; /* the hoop strain of a narrow annulus is that small */
    NV_DATA_S(s->edge)[0] = start;
    sun->KINSetFuncNormTol(s->kinsol, 100.0 * s->tolerance * fabs(start));
    const int code = sun->KINSol(s->kinsol, s->edge, KIN_FP, s->ones, s->ones);
    return code < 0 ? NAN : NV_DATA_S(s->edge)[0];
}

/* Edge under the full load from a guess of it; NAN where KINSOL does not settle. */
static double edge_at_full_load(dea_shooting *s, double guess)
{
    set_scales(s, 1.0);
    set_load(s, 1.0);
    s->held = guess;
    return search_from(s, SEARCH_EDGE, guess / s->strain) * s->strain;
}

/* d(miss)/d(edge) under the full load: 1 for a film without load, 0 where the equilibrium folds. */
static double stiffness_at(dea_shooting *s, double edge)
{
    const double nudge = 1e-4 * edge;
    return (miss_at_frame(s, edge + nudge) - miss_at_frame(s, edge - nudge)) * s->strain / (2.0 * nudge);
}

/* Share of the load that holds the edge, from a guess of it; NAN where there is none. */
static double share_at(dea_shooting *s, double edge, double guess)
{
    set_scales(s, guess);
    s->share = guess;
    s->held = edge;
    return search_from(s, SEARCH_SHARE, 1.0) * guess;
}

/* A place of the equilibrium: the edge, the share of the load that holds it, and lambda_1 behind r_a there. */
typedef struct place {
    double edge, share, radial;
} place;

/* Smallest s11 behind r_a [Pa] on the straight way between two places: where it is lost the film ends, and what holds the load
 * beyond is not connected to rest. */
static double least_s11(const dea_shooting *s, place a, place b)
{
    enum { PARTS = 10 };
    const bool lens = s->point->kind == DEA_LENS;
    double least = INFINITY;
    for (int i = 0; i <= PARTS; i++) {
        const double weight = (double)i / PARTS;
        const double l2 = s->point->film.prestretch + a.edge + weight * (b.edge - a.edge);
        const double l1 = a.radial + weight * (b.radial - a.radial);
        const double k = lens ? s->pressure * (a.share + weight * (b.share - a.share)) : 0.0;
        least = fmin(least, stress_at(s, ANNULUS, l1, l2).w11 - k * dea_film_electric(&s->point->film, l1 * l2).second * l2 * l2);
    }
    return least;
}

/* Edge under the full load between two places on either side of it. */
static double edge_between(dea_shooting *s, place low, place high)
{
    for (int i = 0; i < 60; i++) {
        const double weight = (1.0 - low.share) / (high.share - low.share);
        const double guess = low.edge + weight * (high.edge - low.edge);
        const double edge = edge_at_full_load(s, guess);
        if (fabs(edge) >= fabs(low.edge) && fabs(edge) <= fabs(high.edge)) {
            return edge;
        }
        const double middle = 0.5 * (low.edge + high.edge);
        const place half = {middle, share_at(s, middle, 1.0), s->radial};
        *(half.share < 1.0 ? &low : &high) = half;
    }
    return NAN;
}

/* Largest share near the middle one of three places, by parabolas through the best three; ends early above the full load. */
static place largest_share(dea_shooting *s, place a, place b, place c)
{
    for (int i = 0; i < 12 && !(b.share >= 1.0); i++) {
        const double left = (b.edge - a.edge) * (b.share - c.share);
        const double right = (b.edge - c.edge) * (b.share - a.share);
        const double step = 0.5 * ((b.edge - a.edge) * left - (b.edge - c.edge) * right) / (left - right);
        const double at = b.edge - step;
        const double share = share_at(s, at, b.share);
        const place next = {at, share, s->radial};
        if (!isfinite(next.share) || fabs(step) <= 1e-6 * fabs(b.edge)) {
            break;
        }
        const bool beyond = fabs(next.edge) > fabs(b.edge);
        if (next.share > b.share) {
            *(beyond ? &a : &c) = b;
            b = next;
        } else {
            *(beyond ? &c : &a) = next;
        }
    }
    return b;
}

/* True where no end of the film lies between two places of the equilibrium near to each other. */
static bool is_connected(const dea_shooting *s, place a, place b)
{
    return fabs(b.radial - a.radial) < 0.2 * a.radial && least_s11(s, a, b) > 0.0;
}

/* Follows the equilibrium from rest in steps of the edge until it holds the full load; NAN where the load falls again before, or
 * the film ends: pull-in. */
static double follow(dea_shooting *s, double linear, double end, bool *lost)
{
    const double pre = s->point->film.prestretch;
    const double sign = linear > 0.0 ? 1.0 : -1.0;
    const double fine = s->tolerance;
    place before = {0.0, 0.0, pre};
    place last = before;
    double edge = NAN;
    bool torn = false;               /* the last step went past the end of the film */
    s->tolerance = fmax(fine, 1e-9); /* enough to find the neighbourhood */
    const double longest = 0.03 * fmin(1.0, s->point->film.grows); /* a film near the end of its energy has no longer way */
    double step = longest;
    while (fabs(last.edge) < end && step > 3e-4 * longest) {
        const double at = sign * fmin(end, fabs(last.edge) + step * (pre + fmax(0.0, last.edge)));
        const double guess = last.share > 0.0 ? fmin(1.5, last.share * at / last.edge) : at / linear;
        const double share = share_at(s, at, guess);
        place here = {at, share, s->radial};
        torn = !isnan(share) && !is_connected(s, last, here);
        if (isnan(share) || torn) {
            step *= 0.5; /* the film ends here, or the step was too long */
            continue;
        }
        if (!(here.share > last.share)) {
            here = largest_share(s, before, last, here);
            if (!(here.share >= 1.0)) {
                *lost = true;
                break;
            }
            last = before;
        }
        if (here.share >= 1.0) {
            s->tolerance = fine;
            edge = edge_between(s, last, here);
            break;
        }
        before = last;
        last = here;
        step = fmin(longest, 1.5 * step);
    }
    s->tolerance = fine;
    *lost = *lost || (isnan(edge) && (torn || least_s11(s, last, last) < nearly * s->point->film.w11));
    return edge;
}

/* True where no fold can lie between rest and the edge under the full load, and no end of the film. */
static bool is_near_rest(dea_shooting *s, double edge)
{
    const dea_film *film = &s->point->film;
    const double stiffness = stiffness_at(s, edge);
    const double size = fabs(edge) / film->prestretch;
    const place rest = {0.0, 0.0, film->prestretch};
    const place here = {edge, 1.0, s->radial};
    return (stiffness > 0.4 ? size < 0.1 : stiffness > 0.1 && size < 0.05) &&
           fabs(here.radial - rest.radial) < 0.5 * rest.radial && least_s11(s, rest, here) > nearly * film->w11;
}

/* 2 pi H R_a [m^2]. */
static double lever_of(const dea_point *point)
{
    return 2.0 * DEA_PI * point->film_thickness * point->coverage * point->frame_radius / point->film.prestretch;
}

/* From what the last integration found. */
static dea_found found_at(const dea_shooting *s, double edge)
{
    const dea_point *point = s->point;
    const dea_film *film = &point->film;
    const double b2 = point->coverage * point->coverage, sign = dea_point_sign(point), strain = edge / film->prestretch;
    const double annulus = 2.0 * dea_point_full_capacitance(point) * b2 * s->charge / (film->square * film->square);
    return (dea_found){.strain = strain,
                       .force = sign * lever_of(point) * s->pressure * s->edge_force,
                       .stretch = s->largest_area,
                       .capacitance = sign > 0.0 ? dea_point_disc_capacitance(point, strain) : annulus,
                       .taut = s->least_stress > 0.0};
}

/* A film whose edge is held under a share of the load. */
typedef struct grip {
    dea_shooting *shooting;
    double share, edge;
} grip;

/* What must pull there at a share of both, from a guess [Pa]; NAN where KINSOL does not settle. */
static double pull_at(void *user, double way, double guess)
{
    const double most = 1e6; /* what is so many times Lame's answer holds no film: far away a search ends in roots of rounding */
    const grip *g = user;
    dea_shooting *s = g->shooting;
    s->held = way * g->edge;
    s->strain = fabs(s->held);
    s->stress = s->point->film.w11 * s->strain;
    set_load(s, way * g->share);
    s->uniform = s->annulus_k * dea_point_electric(s->point).first;
    const double pull = s->held != 0.0 ? search_from(s, SEARCH_PULL, guess / s->stress) * s->stress : 0.0;
    return fabs(pull) <= most * fabs(lame_stiffness(s->point) * s->held) ? pull : (double)NAN;
}

/* What the film exerts on an edge that is held under a share of the load, outward [N]. At rest it is uniform. */
static double force_on_edge(dea_shooting *s, double share, double edge)
{
    const double l = s->point->film.prestretch;
    grip g = {s, share, edge};
    s->pull = dea_path_reach(pull_at, &g, lame_stiffness(s->point) * edge);
    return -lever_of(s->point) * (s->pull + s->uniform * l * l * l);
}

/* Without voltage, inward; and what the voltage adds, outward: all of it on the disc of a dot, whose annulus does not feel it. */
static double held_at(dea_shooting *s, double edge, double *push)
{
    const double held = -force_on_edge(s, 0.0, edge), l = s->point->film.prestretch + edge;
    const bool dot = s->point->kind == DEA_DOT;
    const double first = dea_film_electric(&s->point->film, l * l).first;
    *push = dot ? lever_of(s->point) * s->pressure * first * l * l * l : force_on_edge(s, 1.0, edge) + held;
    if (dot) {
        s->pull -= *push / lever_of(s->point);
    }
    return held;
}

static bool hold_once(dea_shooting *s, const dea_point *point, double strain, dea_hold *hold)
{
    const double nudge = 1e-5; /* of the stretch: slopes tell folds and steer Newton's steps, no digit hangs on them */
    dea_point bare = *point;
    const double nominal = dea_point_nominal_field(point), pre = point->film.prestretch, edge = pre * strain, step = pre * nudge;
    double above, below;
    bare.load = 0.0;
    s->point = &bare;
    s->pressure = point->film.permittivity * nominal * nominal;
    if (!(pre + edge > step)) {
        return false;
    }
    hold->held_slope = hold->push_slope = 0.0;
    if (!hold->plain) {
        const double over = 0.5 / (step * dea_point_divide(point) / pre);
        const double up = held_at(s, edge + step, &above), down = held_at(s, edge - step, &below);
        hold->held_slope = (up - down) * over;
        hold->push_slope = (above - below) * over;
    }
    hold->held = held_at(s, edge, &hold->push); /* last: what follows goes on from it */
    set_load(s, 1.0);
    s->strain = edge != 0.0 ? fabs(edge) : step;
    s->stress = s->point->film.w11 * s->strain;
    const bool sloped = isfinite(hold->held_slope) && isfinite(hold->push_slope);
    const bool there = sloped && isfinite(hold->held) && isfinite(hold->push) && !isnan(miss_at_frame(s, edge)) && s->least_s11 > 0.0;
    if (there) {
        hold->found = found_at(s, edge);
        hold->found.capacitance = edge == 0.0 ? dea_point_capacitance(point) : hold->found.capacitance; /* IDA has no steps to sum over */
    }
    s->pull = s->uniform = 0.0;
    return there;
}

/* At the tightest tolerance a search may end where rounding leads it in a circle, in the middle of a sound film: a tolerance that differs
 * a little leads it past that. */
static bool hold(void *user, const dea_point *point, double strain, dea_hold *hold)
{
    enum { TURNS = 3 };
    dea_shooting *s = user;
    const double tolerance = s->tolerance;
    bool there = false;
    for (int i = 0; i < TURNS && !there; i++) {
        s->tolerance = tolerance * (double)(i + 1);
        there = hold_once(s, point, strain, hold);
    }
    s->tolerance = tolerance;
    return there;
}

static dea_holder holder_of(dea_shooting *s, double accuracy)
{
    s->tolerance = fmin(1e-7, fmax(1e-6 * accuracy, finest));
    return (dea_holder){hold, s, false, 1e3 * s->tolerance};
}

void dea_shooting_hold(dea_shooting *s, const dea_point *point, double displacement, double accuracy, dea_row *row)
{
    const dea_holder holder = holder_of(s, accuracy);
    dea_loaded_hold(&holder, point, displacement, row);
}

void dea_shooting_solve(dea_shooting *s, const dea_point *point, double accuracy, dea_row *row)
{
    const dea_film *film = &point->film;
    const double sign = point->kind == DEA_DOT ? 1.0 : -1.0;
    const double nominal = point->voltage / point->film_thickness;
    const double b2 = point->coverage * point->coverage;
    const dea_holder holder = holder_of(s, accuracy);
    s->point = point;
    s->pressure = film->permittivity * nominal * nominal;
    *row = dea_row_failed();
    if (dea_point_is_shared(point)) {
        dea_loaded_solve(&holder, point, row);
        return;
    }
    if (s->pressure == 0.0) {
        dea_row_fill(row, point, (dea_found){.capacitance = dea_point_capacitance(point), .taut = film->tension > 0.0});
        return;
    }
    if (!(film->w11 > 0.0)) {
        row->state = DEA_STATE_PULL_IN;
        return;
    }
    const double linear =
        sign * s->pressure * film->square * film->prestretch * (1.0 - b2) / (2.0 * film->w11 + (1.0 - b2) * load_stress(s, 1.0)); /* without softening */
    double edge = fabs(linear) < 0.2 * film->prestretch ? edge_at_full_load(s, linear) : NAN;
    if (isnan(edge) || !is_near_rest(s, edge)) {
        const double end = sign > 0.0 ? film->prestretch * (1.0 / point->coverage - 1.0) : film->prestretch;
        bool lost = false;
        edge = follow(s, linear, end * (1.0 - 1e-9), &lost);
        row->state = lost ? DEA_STATE_PULL_IN : DEA_STATE_FAILED;
    }
    if (isnan(edge)) {
        return;
    }
    set_scales(s, 1.0);
    set_load(s, 1.0);
    if (isnan(miss_at_frame(s, edge))) {
        return;
    }
    dea_row_fill(row, point, found_at(s, edge));
}
