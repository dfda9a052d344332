/* See film_balance.h. The law gives stress differences to the pre-stretch that keep their digits at a strain of 1e-12. */
#include "model/film_balance.h"

typedef struct balance {
    double load;  /* N = sigma_A - sigma_P [Pa] */
    double slope; /* dN/de */
    double curve; /* d2N/de2 */
    double fold;  /* (1 + e) dN/de - 4 N, sign of dU/de */
} balance;

static inline balance balance_at(const dea_film *film, double ratio, double e)
{
    const dea_change active = film->law->change(film, e);
    balance b = {active.value, active.slope, active.curve, 0.0};
    if (ratio > 0.0) {
        const dea_change passive = film->law->change(film, -ratio * e);
        b.load -= passive.value;
        b.slope += ratio * passive.slope;
        b.curve -= ratio * ratio * passive.curve;
    }
    b.fold = (1.0 + e) * b.slope - 4.0 * b.load;
    return b;
}

static double fourth(double x)
{
    return x * x * x * x;
}

/* Width in strain below which `fold` between two samples of like size is trusted to keep its sign: 5 % of stretch in either
 * region. */
static double trusted_width(double ratio, double e)
{
    return 0.05 * (1.0 + e) / (1.0 + ratio);
}

/* Strain of the active film at which a region vanishes, or the energy of the material ends. */
static double end_of(const dea_film *film, double ratio)
{
    const double active = fmin(1e4, film->most / film->prestretch - 1.0);
    return ratio > 0.0 ? fmin(active, (1.0 - film->least / film->prestretch) / ratio) : active;
}

/* Looks for a fold on [low, high], where `fold` has the values at_low > 0 and at_high. Returns true and a narrow bracket of the
 * first sample with fold <= 0, else false. Samples lie so close that `fold` at most halves, or moves by 5 % of stretch, between
 * two of them. */
static bool find_fold(const dea_film *film, double ratio, double low, double at_low, double high, double at_high, double *before,
                      double *after)
{
    double at = low;
    double fold = at_low;
    double next = high;
    double next_fold = at_high;
    while (at < high) {
        const double width = next - at;
        const double trusted = trusted_width(ratio, at);
        const bool finest = width <= 1e-5 * trusted;
        if (finest && !(next_fold > 0.0)) {
            *before = at;
            *after = next;
            return true;
        }
        if (finest || (width <= trusted && fmin(fold, next_fold) > 0.5 * fmax(fold, next_fold))) {
            at = next;
            fold = next_fold;
            next = fmin(high, at + 2.0 * width);
        } else {
            next = at + 0.5 * width;
        }
        next_fold = next == high ? at_high : balance_at(film, ratio, next).fold;
    }
    return false;
}

/* Root of N - m (1+e)^4 in [low, high], where it changes sign from - to +: Newton, with bisection where Newton leaves the
 * bracket. */
static double bracketed_root(const dea_film *film, double ratio, double m, double low, double high)
{
    double e = 0.5 * (low + high);
    for (int i = 0; i < 200 && high - low > 1e-16 * high; i++) {
        const balance b = balance_at(film, ratio, e);
        const double residual = b.load - m * fourth(1.0 + e);
        if (residual == 0.0) {
            return e;
        }
        *(residual < 0.0 ? &low : &high) = e;
        const double next = e - residual / (b.slope - 4.0 * m * (1.0 + e) * (1.0 + e) * (1.0 + e));
        const double step = fabs(next - e);
        e = next > low && next < high ? next : 0.5 * (low + high);
        if (e == next && step <= 2e-16 * fabs(e)) {
            break;
        }
    }
    return e;
}

/* The fold itself, where `fold` changes sign in [before, after]. */
static double locate_fold(const dea_film *film, double ratio, double before, double after)
{
    for (int i = 0; i < 100; i++) {
        const double middle = 0.5 * (before + after);
        if (middle <= before || middle >= after) {
            break;
        }
        *(balance_at(film, ratio, middle).fold > 0.0 ? &before : &after) = middle;
    }
    return before;
}

/* Follows the equilibrium from rest with growing strain until the load reaches m, or a fold, or the end of the film. */
static bool trace(const dea_film *film, double ratio, double m, double *strain)
{
    const double end = (1.0 - 1e-12) * end_of(film, ratio);
    double low = 0.0;
    double fold = balance_at(film, ratio, low).fold;
    while (low < end) {
        double high = fmin(end, low + trusted_width(ratio, low));
        double before = 0.0;
        double after = 0.0;
        balance at = balance_at(film, ratio, high);
        const bool folds = find_fold(film, ratio, low, fold, high, at.fold, &before, &after);
        if (folds) {
            high = locate_fold(film, ratio, before, after);
            at = balance_at(film, ratio, high);
        }
        if (at.load >= m * fourth(1.0 + high)) {
            *strain = bracketed_root(film, ratio, m, low, high);
            return true;
        }
        if (folds) {
            return false;
        }
        low = high;
        fold = at.fold;
    }
    return false;
}

/* Halley's iteration from the second-order answer; false where it does not settle. Convergence is cubic, so the step after the
 * next one is foreseen as step^4/last^3, and where that is below rounding the present step was the last one needed. */
static bool halley(const dea_film *film, double ratio, double m, double stiffness, double *strain, balance *at)
{
    const double end = end_of(film, ratio);
    /* N = K e + c e^2/2 + ..., m (1 + e)^4 = m (1 + 4 e + 6 e^2 + ...) */
    const double bend = 0.5 * film->square * film->curvature * (1.0 - ratio * ratio) - 6.0 * m;
    const double linear = m / (stiffness - 4.0 * m);
    double e = linear / (1.0 + bend * linear / (stiffness - 4.0 * m));
    double last = e;
    for (int i = 0; i < 12; i++) {
        if (!(e >= 0.0 && e < end)) {
            return false;
        }
        const double square = (1.0 + e) * (1.0 + e);
        *at = balance_at(film, ratio, e);
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
 * and two tangents of it that stay within a factor of two leave no room for a fold between. Spares the samples of find_fold(). */
static bool cannot_fold(const dea_film *film, double ratio, double stiffness, double e, const balance *at)
{
    const double slope_at_rest = film->square * film->curvature * (1.0 - ratio * ratio) - 3.0 * stiffness;
    const double slope_at_end = (1.0 + e) * at->curve - 3.0 * at->slope;
    const double tangents = fmin(stiffness + slope_at_rest * e, at->fold - slope_at_end * e);
    return e <= 3.0 * trusted_width(ratio, 0.0) && fmin(tangents, fmin(stiffness, at->fold)) > 0.5 * fmax(stiffness, at->fold);
}

bool dea_film_balance(const dea_film *film, double ratio, double m, double *strain)
{
    if (m == 0.0) {
        *strain = 0.0;
        return true;
    }
    const double stiffness = film->prestretch * film->slope * (1.0 + ratio);
    if (!(stiffness > 0.0) || !isfinite(m)) {
        return false;
    }
    balance at;
    double before;
    double after;
    if (halley(film, ratio, m, stiffness, strain, &at) && at.fold > 0.0 &&
        (cannot_fold(film, ratio, stiffness, *strain, &at) ||
         !find_fold(film, ratio, 0.0, stiffness, *strain, at.fold, &before, &after))) {
        return true; /* U grows all the way from rest to this root, so it is the first */
    }
    return trace(film, ratio, m, strain);
}
