/* Yeoh: W = C1 J + C2 J^2 + C3 J^3, J = I1 - 3 (Eq. 11). */
#include <math.h>

#include "material/form.h"
#include "material/invariant.h"

enum { C1, C2, C3 };

DEA_INLINE dea_slopes slopes(const double *c, double j)
{
    return (dea_slopes){
        .w = c[C1] + j * (2.0 * c[C2] + 3.0 * c[C3] * j), .w1 = 2.0 * c[C2] + 6.0 * c[C3] * j, .w2 = 6.0 * c[C3]};
}

DEA_INLINE double gain(const double *c, double j, double dj)
{
    return dj * (2.0 * c[C2] + 3.0 * c[C3] * (2.0 * j + dj));
}

static double energy(const double *c, double l1, double l2)
{
    const double j = dea_invariant(l1, l2);
    return j * (c[C1] + j * (c[C2] + j * c[C3]));
}

/* W11 = w (2 + 6 l^-6) + w' a1^2, a1 = 2 l (1 - l^-6). */
static long double fine_w11(const double *c, long double l)
{
    const long double y = l * l, cube = 1.0L / (y * y * y), a = 1.0L - cube;
    const long double j = 2.0L * y + 1.0L / (y * y) - 3.0L;
    const long double w = c[C1] + j * (2.0L * c[C2] + 3.0L * c[C3] * j);
    return w * (2.0L + 6.0L * cube) + (2.0L * c[C2] + 6.0L * c[C3] * j) * 4.0L * y * a * a;
}

DEA_INVARIANT_LAW(slopes, gain)

static void form(dea_pool *pool, const dea_expr *c, dea_expr l1, dea_expr l2, dea_law_form *form)
{
    const dea_form_invariants at = dea_form_invariants_of(pool, l1, l2);
    const dea_expr w = ADD(c[C1], MUL(at.j, ADD(SCALE(2.0, c[C2]), MUL(SCALE(3.0, c[C3]), at.j))));
    dea_form_stresses(pool, &at, w, NUM(0.0), form);
}

static const dea_constant constants[] = {
    {"C1", "Pa", true, 0.0, NAN, "a modulus > 0, e.g. 178426 Pa"},
    {"C2", "Pa", true, -INFINITY, 0.0, "a modulus, e.g. -6023 Pa"},
    {"C3", "Pa", true, -INFINITY, 0.0, "a modulus, e.g. 4234 Pa"},
};

const dea_law dea_law_yeoh = {
    .name = "yeoh",
    .title = "Yeoh",
    .energy_text = "W = C1 (I1 - 3) + C2 (I1 - 3)^2 + C3 (I1 - 3)^3",
    .accepted = "a mapping with C1, C2, C3, e.g. {C1: 178426 Pa}",
    .constants = constants,
    .constant_count = sizeof constants / sizeof *constants,
    .entries = 1,
    .linear = true,
    .energy = energy,
    .fine_w11 = fine_w11,
    DEA_INVARIANT_WAYS,
    .form = form,
};
