#include "model/path.h"

#include <math.h>

static double path_fold(const dea_path_place *place)
{
    return place->slope - place->held * place->weight_slope / place->weight;
}

static double fold_at(const dea_path *path, double x)
{
    const dea_path_place place = path->at(path->film, x);
    return path_fold(&place);
}

/* A stretch of the path with the folds of its ends. */
typedef struct reach {
    double low, high;       /* x */
    double at_low, at_high; /* fold there */
} reach;

/* Where `fold` has fallen to a share q of that at rest it may touch zero and rise again, as q = c d^2 over a distance d from there:
 * samples then lie closer by this many times the root of q. */
static const double shallow = 4.0;

/* True where `fold` passes zero nowhere between two samples of it, both positive. */
static bool is_smooth(const dea_path *path, double width, double trusted, double fold, double next)
{
    const double share = fmin(fold, next) / path->rest;
    const bool alike = next > 0.5 * fold && fold > 0.5 * next; /* never NAN */
    return alike && width <= trusted && width * width <= shallow * shallow * share * trusted * trusted;
}

/* Looks for a fold on a reach that begins with a positive one. Returns true and in @p low, @p high a narrow bracket of the first
 * sample that is not positive. Samples lie so close that `fold` at most halves, or stretches move by 5 %, between two of them.
 * Where the energy of the film ends `fold` is NAN: that counts as one, and just before it the film holds any load. */
static bool find_fold(const dea_path *path, const reach *whole, double *low, double *high)
{
    double at = whole->low, fold = whole->at_low;
    double next = whole->high, next_fold = whole->at_high;
    while (at < whole->high) {
        const double width = next - at;
        const double trusted = dea_path_width(path, at);
        const bool finest = width <= 1e-5 * trusted;
        if (finest && !(next_fold > 0.0)) {
            *low = at;
            *high = next;
            return true;
        }
        if (finest || is_smooth(path, width, trusted, fold, next_fold)) {
            at = next;
            fold = next_fold;
            next = fmin(whole->high, at + 2.0 * width);
        } else {
            next = at + 0.5 * width;
        }
        next_fold = next == whole->high ? whole->at_high : fold_at(path, next);
    }
    return false;
}

bool dea_path_cannot_fold(const dea_path *path, double m, double x, const dea_path_place *at)
{
    const double mean = m / x, end = path_fold(at) / at->weight;
    return x <= 3.0 * dea_path_width(path, 0.0) && fmin(fmin(mean, end), path->rest) > 0.5 * fmax(fmax(mean, end), path->rest);
}

bool dea_path_grows(const dea_path *path, double x)
{
    const reach whole = {0.0, x, path->rest, fold_at(path, x)};
    double before, after;
    return whole.at_high > 0.0 && !find_fold(path, &whole, &before, &after);
}

/* The fold itself, where `fold` changes sign in [before, after]. */
static double locate_fold(const dea_path *path, double before, double after)
{
    for (int i = 0; i < 100; i++) {
        const double middle = 0.5 * (before + after);
        if (middle <= before || middle >= after) {
            break;
        }
        *(fold_at(path, middle) > 0.0 ? &before : &after) = middle;
    }
    return before;
}

/* Root of R - m weight in [low, high], where it changes sign from - to +: Newton, with bisection where Newton leaves the bracket. NAN
 * where the film is not solved at a place between. */
static double bracketed_root(const dea_path *path, double m, double low, double high)
{
    double x = 0.5 * (low + high);
    for (int i = 0; i < 200 && high - low > 1e-16 * high; i++) {
        const dea_path_place place = path->at(path->film, x);
        const double residual = place.held - m * place.weight;
        if (residual == 0.0 || isnan(residual)) {
            return residual == 0.0 ? x : residual;
        }
        *(residual < 0.0 ? &low : &high) = x;
        const double next = x - residual / (place.slope - m * place.weight_slope);
        const double step = fabs(next - x);
        x = next > low && next < high ? next : 0.5 * (low + high);
        if (x == next && step <= fmax(2e-16, path->rough) * fabs(x)) {
            break;
        }
    }
    return x;
}

bool dea_path_trace(const dea_path *path, double m, double *x)
{
    const double end = path->end * (1.0 - 1e-12);
    reach way = {.at_low = path->rest};
    while (way.low < end) {
        way.high = fmin(end, way.low + dea_path_width(path, way.low));
        dea_path_place place = path->at(path->film, way.high);
        way.at_high = path_fold(&place);
        double before = 0.0, after = 0.0;
        const bool folds = find_fold(path, &way, &before, &after);
        if (folds) {
            way.high = locate_fold(path, before, after);
            place = path->at(path->film, way.high);
        }
        if (place.held >= m * place.weight) {
            *x = bracketed_root(path, m, way.low, way.high);
            return true;
        }
        if (folds) {
            return false;
        }
        way.low = way.high;
        way.at_low = way.at_high;
    }
    return false;
}

double dea_path_reach(double (*at)(void *user, double share, double guess), void *user, double linear)
{
    const double least = 1.0 / 64.0;
    double answer = at(user, 1.0, linear);
    double gone = 0.0, ratio = linear, slope = 0.0; /* the answer over its share of the way, and the slope of that */
    for (double step = 0.5; isnan(answer) && step >= least;) {
        const double next = fmin(1.0, gone + step);
        const double here = at(user, next, next * (ratio + slope * (next - gone)));
        if (isnan(here)) {
            step *= 0.5;
            continue;
        }
        slope = (here / next - ratio) / (next - gone);
        ratio = here / next;
        gone = next;
        answer = next < 1.0 ? answer : here;
    }
    return answer;
}
