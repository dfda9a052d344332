/* An equilibrium with one unknown x >= 0 that grows from rest under a load m:
 *
 *     R(x) = m weight(x),   weight(0) = 1,
 *
 * R what the film holds, both smooth. The load grows along the path while fold = R' - R weight'/weight stays positive; where that
 * is zero, equilibria beyond are not connected to rest. */
#ifndef DEA_PATH_H
#define DEA_PATH_H

#include <stdbool.h>

/* The path at one place. */
typedef struct dea_path_place {
    double held, slope;          /* R [Pa] and dR/dx */
    double weight, weight_slope; /* of the load [1] */
} dea_path_place;

typedef struct dea_path {
    dea_path_place (*at)(const void *film, double x);
    const void *film; /* borrowed: what `at` reads */
    double rest;      /* dR/dx at rest [Pa], > 0 */
    double end;       /* x at which a region has vanished */
    double share;     /* largest change of a stretch, relative, that goes with dx = 1 at rest, inverted [1] */
    double rough;     /* change of a root, relative, that says nothing: rounding of R, 0 where that is the last digit [1] */
} dea_path;

/* Change of x over which stretches move by 5 %. */
static inline double dea_path_width(const dea_path *path, double x)
{
    return 0.05 * (1.0 + x) * path->share;
}

/* True where the slope of the load m that holds x keeps far from zero from rest to there: over so short a way its values at both
 * ends and its mean that stay within a factor of two leave no room for a fold between. Spares the samples of dea_path_grows(). */
bool dea_path_cannot_fold(const dea_path *path, double m, double x, const dea_path_place *at);

/* True where the load grows all the way from rest to x, so that an equilibrium there is the first one. */
bool dea_path_grows(const dea_path *path, double x);

/* The first equilibrium from rest under the load m > 0, NAN where it is there and was not found; false where there is none: pull-in. */
bool dea_path_trace(const dea_path *path, double m, double *x);

/* What answers a load, from rest: `linear` where both are small. It is searched from there at once, and, where that leads nowhere, on
 * the way from rest, all in one proportion, each place telling where the next one lies. @p at finds the answer at a share of the way
 * [1] from a guess of it, NAN where it finds none. NAN where steps of a 64th lead no further: the film has come to its end. */
double dea_path_reach(double (*at)(void *user, double share, double guess), void *user, double linear);

#endif
