/* Mooney-Rivlin: W = C10 (I1 - 3) + C01 (I2 - 3): a neo-Hookean film, and what the second invariant adds,
 *
 *     P1 = 2 C01 (l1 l2^2 - l1^-3),  W11 = 2 C01 (l2^2 + 3 l1^-4),  W12 = 4 C01 l1 l2,  sigma = 2 C01 (y^2 - 1/y), y = lambda^2
 */
#include <math.h>

#include "material/form.h"
#include "material/invariant.h"

enum { C10, C01 };

DEA_INLINE dea_slopes slopes(const double *c, double j)
{
    (void)j;
    return (dea_slopes){.w = c[C10]};
}

/* I2 - 3 is I1 - 3 of the reciprocal stretches: the same form (dea_invariant) with p = l1^-2 - 1, q = l2^-2 - 1. */
static double energy(const double *c, double l1, double l2)
{
    const double p = (1.0 - l1) * (1.0 + l1) / (l1 * l1);
    const double q = (1.0 - l2) * (1.0 + l2) / (l2 * l2);
    const double second = (p * p * (1.0 + q) + q * q * (1.0 + p) + p * q) / ((1.0 + p) * (1.0 + q));
    return c[C10] * dea_invariant(l1, l2) + c[C01] * second;
}

static dea_stress stress(const double *c, double l1, double l2)
{
    dea_stress s = dea_invariant_stress(slopes, c, l1, l2);
    const double cube1 = 1.0 / (l1 * l1 * l1);
    const double cube2 = 1.0 / (l2 * l2 * l2);
    const double twice = 2.0 * c[C01];
    s.shear += twice * ((l1 * l1 + l1 * l2 + l2 * l2) * cube1 * cube2 - l1 * l2); /* of l1 l2^2 - l1^-3 */
    s.p1 += twice * (l1 * l2 * l2 - cube1);
    s.p2 += twice * (l2 * l1 * l1 - cube2);
    s.w11 += twice * (l2 * l2 + 3.0 * cube1 / l1);
    s.w12 += 2.0 * twice * l1 * l2;
    s.w22 += twice * (l1 * l1 + 3.0 * cube2 / l2);
    return s;
}

static double rise(const double *c, double l, double d1, double d2)
{
    const double l1 = l + d1;
    const double l2 = l + d2;
    const double stretched = d1 * l2 * l2 + l * d2 * (l2 + l);                           /* l1 l2^2 - l^3 */
    const double thinned = d1 * (l1 * l1 + l1 * l + l * l) / (l1 * l1 * l1 * l * l * l); /* l^-3 - l1^-3 */
    return dea_invariant_rise(slopes, dea_no_gain, c, l, d1, d2) + 2.0 * c[C01] * (stretched + thinned);
}

static void prepare(dea_film *film)
{
    film->rest[0] = film->constants[C10];
}

/* y^2 - 1/y and its derivatives by y: 2 y + y^-2, 2 - 2 y^-3. */
static void change(const dea_film *film, size_t count, const double *strains, dea_change *changes)
{
    const double y0 = film->square;
    const double twice = 2.0 * film->constants[C01];
    for (size_t i = 0; i < count; i++) {
        const double e = strains[i];
        const double d = y0 * e * (2.0 + e);
        const double y = y0 + d;
        const double dy = 2.0 * y0 * (1.0 + e);
        const double slope = twice * (2.0 * y + 1.0 / (y * y));
        const double curve = twice * (2.0 - 2.0 / (y * y * y));
        changes[i] = dea_invariant_change(slopes, dea_no_gain, film, e);
        changes[i].value += twice * d * (y + y0 + 1.0 / (y * y0));
        changes[i].slope += slope * dy;
        changes[i].curve += curve * dy * dy + slope * 2.0 * y0;
    }
}

static const char *fault(const double *c)
{
    return c[C10] + c[C01] > 0.0 ? NULL : "C10 and C01 sum to no more than 0; accepted: a sum > 0, half the shear modulus";
}

static void form(dea_pool *pool, const dea_expr *c, dea_expr l1, dea_expr l2, dea_law_form *form)
{
    const dea_form_invariants at = dea_form_invariants_of(pool, l1, l2);
    dea_form_stresses(pool, &at, c[C10], c[C01], form);
}

static const dea_constant constants[] = {
    {"C10", "Pa", true, -INFINITY, NAN, "a modulus, e.g. 16 kPa"},
    {"C01", "Pa", true, -INFINITY, NAN, "a modulus, e.g. 7.3 kPa"},
};

const dea_law dea_law_mooney_rivlin = {
    .name = "mooney_rivlin",
    .title = "Mooney-Rivlin",
    .energy_text = "W = C10 (I1 - 3) + C01 (I2 - 3)",
    .accepted = "a mapping with C10 and C01, e.g. {C10: 16 kPa, C01: 7.3 kPa}",
    .constants = constants,
    .constant_count = sizeof constants / sizeof *constants,
    .entries = 1,
    .linear = true,
    .fault = fault,
    .energy = energy,
    .stress = stress,
    .rise = rise,
    .prepare = prepare,
    .change = change,
    .form = form,
};
