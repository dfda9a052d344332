/* The models once more, in extended precision and in their plainest form, straight from physics.md, sections 2 and 3. */
#include "bench.h"

#include <math.h>
#include <string.h>

typedef struct film {
    long double c[3];
    long double prestretch;
    long double pressure; /* M = eps (U/H)^2 */
} film;

static long double slope(const film *f, long double j)
{
    return f->c[0] + 2.0L * f->c[1] * j + 3.0L * f->c[2] * j * j;
}

static long double invariant(long double l)
{
    return 2.0L * l * l + 1.0L / (l * l * l * l) - 3.0L;
}

/* sigma = 2 (l^2 - l^-4) w */
static long double stress(const film *f, long double l)
{
    return 2.0L * (l * l - 1.0L / (l * l * l * l)) * slope(f, invariant(l));
}

/* Y = dsigma/dl */
static long double modulus(const film *f, long double l)
{
    const long double fifth = 1.0L / (l * l * l * l * l);
    const long double j = invariant(l);
    const long double g = l * l - 1.0L / (l * l * l * l);
    return 2.0L * (2.0L * l + 4.0L * fifth) * slope(f, j) + 2.0L * g * (2.0L * f->c[1] + 6.0L * f->c[2] * j) * 4.0L * (l - fifth);
}

/* Eq. 22 */
static long double lumped(const film *f, bool dot, long double b)
{
    const long double fourth = f->prestretch * f->prestretch * f->prestretch * f->prestretch;
    return (dot ? 1.0L : -1.0L) * (1.0L - b) * f->pressure * fourth / modulus(f, f->prestretch);
}

/* u = F_DEA/(1/n_disc + 1/n_annulus), over r_a */
static long double lame(const film *f, bool dot, long double b)
{
    const long double l = f->prestretch;
    const long double j = invariant(l);
    const long double w = slope(f, j);
    const long double q = 2.0L * f->c[1] + 6.0L * f->c[2] * j;
    const long double a = 2.0L * (l - 1.0L / (l * l * l * l * l));
    const long double sixth = 1.0L / (l * l * l * l * l * l);
    const long double w11 = w * (2.0L + 6.0L * sixth) + q * a * a;
    const long double w12 = 4.0L * w * sixth + q * a * a;
    const long double soft = f->pressure * l * l;
    const long double disc = dot ? w11 - soft + w12 - 2.0L * soft : w11 + w12;
    const long double round = (1.0L + b * b) / (1.0L - b * b);
    const long double annulus = dot ? w11 * round - w12 : (w11 - soft) * round - (w12 - 2.0L * soft);
    return (dot ? 1.0L : -1.0L) * soft / (disc + annulus);
}

/* sigma(lambda_A) - sigma(lambda_P) - eps lambda_A^4 (U/H)^2; the passive film gives back ratio times the active strain e. */
static long double imbalance(const film *f, long double ratio, long double e)
{
    const long double active = f->prestretch * (1.0L + e);
    const long double passive = f->prestretch * (1.0L - ratio * e);
    return stress(f, active) - stress(f, passive) - f->pressure * active * active * active * active;
}

/* First root from rest, Eqs. 13 and 18: scanned, then bisected. */
static long double balance(const film *f, long double ratio)
{
    const long double step = 1e-3L / (1.0L + ratio);
    long double low = 0.0L;
    long double high = step;
    while (imbalance(f, ratio, high) < 0.0L) {
        low = high;
        high += step;
        if (high > 2.0L || ratio * high >= 1.0L) {
            return NAN;
        }
    }
    for (int i = 0; i < 80; i++) {
        const long double middle = 0.5L * (low + high);
        *(imbalance(f, ratio, middle) < 0.0L ? &low : &high) = middle;
    }
    return 0.5L * (low + high);
}

long double bench_strain(const char *model, const dea_point *point)
{
    const bool dot = point->kind == DEA_DOT;
    const long double b = point->coverage;
    const long double nominal = (long double)point->voltage / point->film_thickness;
    film f = {.prestretch = point->film.prestretch, .pressure = point->film.permittivity * nominal * nominal};
    for (int i = 0; i < 3; i++) {
        f.c[i] = point->film.constants[i];
    }
    if (strcmp(model, "lumped") == 0) {
        return lumped(&f, dot, b);
    }
    if (strcmp(model, "lame") == 0) {
        return lame(&f, dot, b);
    }
    if (strcmp(model, "constant_force") == 0) {
        return balance(&f, 0.0L);
    }
    if (strcmp(model, "coverage") == 0) {
        return dot ? balance(&f, b / (1.0L - b)) : -(1.0L - b) / b * balance(&f, (1.0L - b) / b);
    }
    return NAN;
}
