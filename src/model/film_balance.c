/* See film_balance.h. The law gives stress differences to the pre-stretch that keep their digits at a strain of 1e-12. */
#include "model/film_balance.h"

#include "model/path.h"

typedef struct balance {
    double load;  /* N = sigma_A - sigma_P [Pa] */
    double slope; /* dN/de */
    double curve; /* d2N/de2 */
    double fold;  /* (1 + e) dN/de - 4 N, sign of dU/de */
} balance;

/* Two films of which the passive one gives back `ratio` of the active one's strain, the active one with its skin. */
typedef struct film_pair {
    const dea_film *film;
    double ratio;
    const dea_film *skin; /* NULL: none */
    double share;         /* t lambda_pre^2/H: its Cauchy stress counts so much [1] */
    double load, turn;    /* a spring at the edge adds load e (1 + turn e) [Pa], turn e being the strain of the disc */
} film_pair;

static inline balance balance_at(const film_pair *pair, double e)
{
    const dea_film *film = pair->film;
    const double ratio = pair->ratio;
    const double strains[] = {e, -ratio * e};
    dea_change changes[2];
    film->law->change(film, ratio > 0.0 ? 2 : 1, strains, changes);
    const dea_change active = changes[0];
    balance b = {active.value, active.slope, active.curve, 0.0};
    if (ratio > 0.0) {
        const dea_change passive = changes[1];
        b.load -= passive.value;
        b.slope += ratio * passive.slope;
        b.curve -= ratio * ratio * passive.curve;
    }
    if (pair->skin) {
        dea_change skin;
        pair->skin->law->change(pair->skin, 1, &e, &skin);
        b.load += pair->share * skin.value;
        b.slope += pair->share * skin.slope;
        b.curve += pair->share * skin.curve;
    }
    b.load += pair->load * e * (1.0 + pair->turn * e);
    b.slope += pair->load * (1.0 + 2.0 * pair->turn * e);
    b.curve += 2.0 * pair->load * pair->turn;
    b.fold = (1.0 + e) * b.slope - 4.0 * b.load;
    return b;
}

static dea_path_place place_at(const void *user, double e)
{
    const balance b = balance_at(user, e);
    const double cube = (1.0 + e) * (1.0 + e) * (1.0 + e);
    return (dea_path_place){b.load, b.slope, cube * (1.0 + e), 4.0 * cube};
}

/* Strain of the active film at which a region vanishes, or the energy of the material ends. */
static double end_of(const film_pair *pair)
{
    const double active = pair->skin ? fmin(pair->film->grows, pair->skin->grows) : pair->film->grows;
    const double passive = pair->ratio > 0.0 ? pair->film->shrinks / pair->ratio : active;
    return passive < active ? passive : active;
}

/* dN/de and d2N/de2 at rest. */
static double rest_slope(const film_pair *pair)
{
    const double film = pair->film->prestretch * pair->film->slope * (1.0 + pair->ratio);
    return (pair->skin ? film + pair->share * pair->skin->slope : film) + pair->load;
}

static double rest_curve(const film_pair *pair)
{
    const double film = pair->film->square * pair->film->curvature * (1.0 - pair->ratio * pair->ratio);
    return (pair->skin ? film + pair->share * pair->skin->curvature : film) + 2.0 * pair->load * pair->turn;
}

/* Halley's iteration from the second-order answer; false where it does not settle. Convergence is cubic, so the step after the
 * next one is foreseen as step^4/last^3, and where that is below rounding the present step was the last one needed. */
static bool halley(const film_pair *pair, double m, double stiffness, double *strain, balance *at)
{
    const double end = end_of(pair);
    /* N = K e + c e^2/2 + ..., m (1 + e)^4 = m (1 + 4 e + 6 e^2 + ...) */
    const double bend = 0.5 * rest_curve(pair) - 6.0 * m;
    const double linear = m / (stiffness - 4.0 * m);
    double e = linear / (1.0 + bend * linear / (stiffness - 4.0 * m));
    double last = e;
    for (int i = 0; i < 12; i++) {
        if (!(e >= 0.0 && e < end)) {
            return false;
        }
        const double square = (1.0 + e) * (1.0 + e);
        *at = balance_at(pair, e);
        const double residual = at->load - m * square * square;
        const double slope = at->slope - 4.0 * m * square * (1.0 + e);
        const double curve = at->curve - 12.0 * m * square;
        const double step = -2.0 * residual * slope / (2.0 * slope * slope - residual * curve);
        *strain = e += step;
        const bool is_root =
            fabs(residual) <= 2.0 * fabs(slope * step); /* at a fold steps are short, too, but the residual is not */
        if (is_root && fabs(step) <= 1e-3 * fabs(e) && step * step * step * step <= 1e-16 * fabs(e * last * last * last)) {
            return e >= 0.0 && e < end;
        }
        last = step;
    }
    return false;
}

/* True where `fold` keeps far from zero all the way from rest to e, near which @p at was taken: over so short a way two values
 * and two tangents of it that stay within a factor of two leave no room for a fold between. Spares the samples of
 * dea_path_grows(). */
static bool cannot_fold(const film_pair *pair, double stiffness, double e, const balance *at)
{
    const double slope_at_rest = rest_curve(pair) - 3.0 * stiffness;
    const double slope_at_end = (1.0 + e) * at->curve - 3.0 * at->slope;
    const double tangent_at_rest = stiffness + slope_at_rest * e;
    const double tangent_at_end = at->fold - slope_at_end * e;
    const double half = 0.5 * (stiffness > at->fold ? stiffness : at->fold);
    return e <= 0.15 / (1.0 + pair->ratio) && tangent_at_rest > half && tangent_at_end > half && stiffness > half &&
           at->fold > half;
}

bool dea_film_balance(const dea_point *point, double ratio, double m, double *strain)
{
    if (m == 0.0) {
        *strain = 0.0;
        return true;
    }
    const bool skinned = point->skin_share > 0.0;
    const double turn = point->kind == DEA_DOT ? 1.0 : -ratio;
    const film_pair pair = {.film = &point->film,
                            .ratio = ratio,
                            .skin = skinned ? &point->skin : NULL,
                            .share = point->skin_share * point->film.square,
                            .load = point->load * dea_point_divide(point) / dea_point_cross_section(point) * fabs(turn),
                            .turn = turn};
    const double stiffness = rest_slope(&pair);
    if (!(stiffness > 0.0) || !isfinite(m)) {
        return false;
    }
    const dea_path path = {place_at, &pair, stiffness, end_of(&pair), 1.0 / (1.0 + ratio)};
    balance at;
    if (halley(&pair, m, stiffness, strain, &at) && at.fold > 0.0 &&
        (cannot_fold(&pair, stiffness, *strain, &at) || dea_path_grows(&path, *strain))) {
        return true; /* U grows all the way from rest to this root, so it is the first */
    }
    return dea_path_trace(&path, m, strain);
}
