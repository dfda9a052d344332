/* Films whose energy depends on the first invariant alone, W = f(J), J = I1 - 3. A law gives f' and how it changes; these
 * functions are to be inlined into its file, so that the law costs no call inside.
 *
 *     P1 = w a1,  W11 = w (2 + 6 l1^-4 l2^-2) + w' a1^2,  W12 = 4 w (l1 l2)^-3 + w' a1 a2,  a1 = 2 (l1 - l1^-3 l2^-2),  w = f'
 *
 * I1 - 3 and l^2 - l^-4 are factored so that they keep their digits near l = 1, and so are all differences in the strain. */
#ifndef DEA_INVARIANT_H
#define DEA_INVARIANT_H

#include <string.h>

#include "material/law.h"
#include "support/lanes.h"

/* f', f'' and f''' [Pa]. */
typedef struct dea_slopes {
    double w, w1, w2;
} dea_slopes;

typedef dea_slopes dea_slopes_at(const double *constants, double j);
/* f'(j + dj) - f'(j), factored in dj. */
typedef double dea_slope_gain(const double *constants, double j, double dj);

/* J at in-plane stretches l1, l2; with p = l1^2 - 1 and q = l2^2 - 1 it is (p^2 (1+q) + q^2 (1+p) + p q)/((1+p)(1+q)). */
DEA_INLINE double dea_invariant(double l1, double l2)
{
    const double p = (l1 - 1.0) * (l1 + 1.0);
    const double q = (l2 - 1.0) * (l2 + 1.0);
    return (p * p * (1.0 + q) + q * q * (1.0 + p) + p * q) / ((1.0 + p) * (1.0 + q));
}

DEA_INLINE dea_stress dea_invariant_stress(dea_slopes_at *slopes, const double *constants, double l1, double l2)
{
    const double t3 = 1.0 / (l1 * l2); /* thickness stretch */
    const double t3s = t3 * t3;
    const double over1 = t3 * l2; /* 1/l1 */
    const double over2 = t3 * l1;
    const double p = (l1 - 1.0) * (l1 + 1.0);
    const double r = (l2 - 1.0) * (l2 + 1.0);
    const double j = (p * p * (1.0 + r) + r * r * (1.0 + p) + p * r) * t3s; /* as dea_invariant(), with one division in all */
    const dea_slopes at = slopes(constants, j);
    const double a1 = 2.0 * (l1 - t3s * over1);
    const double a2 = 2.0 * (l2 - t3s * over2);
    const double cube = at.w * t3s * t3;
    return (dea_stress){
        .shear = 2.0 * (at.w + cube),
        .p1 = at.w * a1,
        .p2 = at.w * a2,
        .w11 = at.w * (2.0 + 6.0 * t3s * over1 * over1) + at.w1 * a1 * a1,
        .w12 = 4.0 * cube + at.w1 * a1 * a2,
        .w22 = at.w * (2.0 + 6.0 * t3s * over2 * over2) + at.w1 * a2 * a2,
    };
}

DEA_INLINE double dea_invariant_rise(dea_slopes_at *slopes, dea_slope_gain *gain, const double *constants, double l, double d1,
                                     double d2)
{
    const double l1 = l + d1;
    const double l2 = l + d2;
    const double y = l * l;
    const double p1 = d1 * (l1 + l); /* l1^2 - l^2 */
    const double p2 = d2 * (l2 + l);
    const double rest = 1.0 / (y * y);
    const double fourth = 1.0 / (l1 * l1 * l2 * l2);
    const double drop4 = (l1 * l1 * p2 + y * p1) * fourth * rest;                                        /* l^-4 - l1^-2 l2^-2 */
    const double drop5 = (l1 * l1 * l1 * p2 + y * d1 * (l1 * l1 + l1 * l + y)) * fourth / l1 * rest / l; /* l^-5 - l1^-3 l2^-2 */
    const double p = (l - 1.0) * (l + 1.0);
    const double j = p * p * (2.0 * y + 1.0) * rest;
    const double dw = gain(constants, j, p1 + p2 - drop4);
    return 2.0 * (slopes(constants, j).w + dw) * (d1 + drop5) + dw * 2.0 * p * (y * y + y + 1.0) * rest / l;
}

/* sigma = 2 g w with g = y - y^-2 and J = 2 y + y^-2 - 3, y = lambda^2; film->rest[0] is w at the pre-stretch. */
DEA_INLINE dea_change dea_invariant_change(dea_slopes_at *slopes, dea_slope_gain *gain, const dea_film *film, double e)
{
    const double y0 = film->square;
    const double d = y0 * e * (2.0 + e);           /* y - y0 */
    const double y = y0 * ((1.0 + e) * (1.0 + e)); /* not y0 + d: small where the film is squeezed to nothing */
    const double inverse = 1.0 / (y * y);
    const double q = (y + y0) * inverse * film->inverse_fourth;
    const double dg = d * (1.0 + q); /* g - g0 */
    const double dj = d * (2.0 - q); /* J - J0 */
    const double dw = gain(film->constants, film->j, dj);
    const double w = film->rest[0] + dw;
    const double g = film->g + dg;
    const dea_slopes at = slopes(film->constants, film->j + dj);
    const double cube = inverse * inverse * y; /* y^-3 */
    /* with respect to y: g' = 1 + 2 y^-3, J' = 2 - 2 y^-3, g'' = -6 y^-4, J'' = 6 y^-4 */
    const double g1 = 1.0 + 2.0 * cube;
    const double j1 = 2.0 - 2.0 * cube;
    const double second = 6.0 * inverse * inverse;
    const double slope = 2.0 * (g1 * w + g * at.w1 * j1);
    const double curve = 2.0 * (2.0 * g1 * at.w1 * j1 + at.w2 * g * j1 * j1 + second * (g * at.w1 - w));
    const double dy = 2.0 * y0 * (1.0 + e);
    return (dea_change){2.0 * (dg * w + film->g * dw), slope * dy, curve * dy * dy + slope * 2.0 * y0};
}

/* With y = lambda^2 and v = (y1 y2)^-1: J = y1 + y2 + v - 3, P1 = 2 w (lambda1 - v/lambda1); film->rest[0] is w at the
 * pre-stretch. */
DEA_INLINE dea_biaxial dea_invariant_biaxial(dea_slopes_at *slopes, dea_slope_gain *gain, const dea_film *film, double e1, double e2)
{
    const double l0 = film->prestretch, y0 = film->square, v0 = film->inverse_fourth;
    const double inverse0 = l0 * y0 * v0; /* 1/lambda_pre */
    const double l1 = l0 * (1.0 + e1), l2 = l0 * (1.0 + e2);
    const double d1 = y0 * e1 * (2.0 + e1), d2 = y0 * e2 * (2.0 + e2); /* of y1, y2 */
    const double over = 1.0 / (l1 * l2), v = over * over;
    const double inverse1 = over * l2, inverse2 = over * l1;
    const double dv = -v * v0 * (y0 * (d1 + d2) + d1 * d2);
    const double dj = d1 + d2 + dv;
    const double dw = gain(film->constants, film->j, dj);
    const double w = 2.0 * (film->rest[0] + dw), w1 = 4.0 * slopes(film->constants, film->j + dj).w1;
    const double a0 = film->g * inverse0; /* lambda - v/lambda at the pre-stretch */
    const double da1 = l0 * e1 - (dv - v0 * e1) * inverse1, da2 = l0 * e2 - (dv - v0 * e2) * inverse2;
    const double a1 = a0 + da1, a2 = a0 + da2;
    return (dea_biaxial){
        .p1 = w * da1 + 2.0 * a0 * dw,
        .p2 = w * da2 + 2.0 * a0 * dw,
        .w11 = w * (1.0 + 3.0 * v * inverse1 * inverse1) + w1 * a1 * a1,
        .w12 = 2.0 * w * v * over + w1 * a1 * a2,
        .w22 = w * (1.0 + 3.0 * v * inverse2 * inverse2) + w1 * a2 * a2,
    };
}

/* Both abreast, lane after lane. */
DEA_INLINE void dea_invariant_changes(dea_slopes_at *slopes, dea_slope_gain *gain, const dea_film *film, size_t count,
                                      const double *strains, const dea_changes *changes)
{
    const dea_film here = *film; /* what is written cannot change it */
    for (size_t i = 0; i < count; i += DEA_LANES) {
        double value[DEA_LANES], slope[DEA_LANES], curve[DEA_LANES];
        DEA_EACH_LANE(l)
        {
            const dea_change at = dea_invariant_change(slopes, gain, &here, strains[i + l]);
            value[l] = at.value;
            slope[l] = at.slope;
            curve[l] = at.curve;
        }
        memcpy(changes->value + i, value, sizeof value);
        memcpy(changes->slope + i, slope, sizeof slope);
        memcpy(changes->curve + i, curve, sizeof curve);
    }
}

DEA_INLINE void dea_invariant_biaxials(dea_slopes_at *slopes, dea_slope_gain *gain, const dea_film *film, size_t count,
                                       const double *e1, const double *e2, const dea_biaxials *changes)
{
    const dea_film here = *film;
    for (size_t i = 0; i < count; i += DEA_LANES) {
        double p1[DEA_LANES], p2[DEA_LANES], w11[DEA_LANES], w12[DEA_LANES];
        DEA_EACH_LANE(l)
        {
            const dea_biaxial at = dea_invariant_biaxial(slopes, gain, &here, e1[i + l], e2[i + l]);
            p1[l] = at.p1;
            p2[l] = at.p2;
            w11[l] = at.w11;
            w12[l] = at.w12;
        }
        memcpy(changes->p1 + i, p1, sizeof p1);
        memcpy(changes->p2 + i, p2, sizeof p2);
        memcpy(changes->w11 + i, w11, sizeof w11);
        memcpy(changes->w12 + i, w12, sizeof w12);
    }
}

/* Of a law whose f' does not change. */
DEA_INLINE double dea_no_gain(const double *constants, double j, double dj)
{
    (void)constants;
    (void)j;
    (void)dj;
    return 0.0;
}

/* The ways of a law that has no more than these two functions, and their places in its row. */
#define DEA_INVARIANT_LAW(slopes, gain)                                                                                         \
    static dea_stress stress(const double *c, double l1, double l2)                                                             \
    {                                                                                                                           \
        return dea_invariant_stress(slopes, c, l1, l2);                                                                         \
    }                                                                                                                           \
    static double rise(const double *c, double l, double d1, double d2)                                                         \
    {                                                                                                                           \
        return dea_invariant_rise(slopes, gain, c, l, d1, d2);                                                                  \
    }                                                                                                                           \
    static void prepare(dea_film *film)                                                                                         \
    {                                                                                                                           \
        film->rest[0] = slopes(film->constants, film->j).w;                                                                     \
    }                                                                                                                           \
    static void change(const dea_film *film, size_t count, const double *strains, dea_change *changes)                          \
    {                                                                                                                           \
        for (size_t i = 0; i < count; i++) {                                                                                    \
            changes[i] = dea_invariant_change(slopes, gain, film, strains[i]);                                                  \
        }                                                                                                                       \
    }                                                                                                                           \
    static dea_biaxial biaxial(const dea_film *film, double e1, double e2)                                                      \
    {                                                                                                                           \
        return dea_invariant_biaxial(slopes, gain, film, e1, e2);                                                               \
    }                                                                                                                           \
    DEA_INLINE void changes_of(const dea_film *film, size_t count, const double *strains, const dea_changes *out)               \
    {                                                                                                                           \
        dea_invariant_changes(slopes, gain, film, count, strains, out);                                                         \
    }                                                                                                                           \
    DEA_INLINE void biaxials_of(const dea_film *film, size_t count, const double *e1, const double *e2, const dea_biaxials *out)\
    {                                                                                                                           \
        dea_invariant_biaxials(slopes, gain, film, count, e1, e2, out);                                                         \
    }                                                                                                                           \
    DEA_LANES_DISPATCH(changes, changes_of, (const dea_film *film, size_t count, const double *strains, const dea_changes *out),\
                       (film, count, strains, out))                                                                             \
    DEA_LANES_DISPATCH(biaxials, biaxials_of,                                                                                   \
                       (const dea_film *film, size_t count, const double *e1, const double *e2, const dea_biaxials *out),       \
                       (film, count, e1, e2, out))

#define DEA_INVARIANT_WAYS                                                                                                       \
    .stress = stress, .rise = rise, .prepare = prepare, .change = change, .biaxial = biaxial, .changes = changes, .biaxials = biaxials

#endif
