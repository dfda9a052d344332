/* Neo-Hookean: W = mu/2 (I1 - 3), of chains without end. */
#include <math.h>

#include "material/form.h"
#include "material/invariant.h"

enum { MU };

DEA_INLINE dea_slopes slopes(const double *c, double j)
{
    (void)j;
    return (dea_slopes){.w = 0.5 * c[MU]};
}

static double energy(const double *c, double l1, double l2)
{
    return 0.5 * c[MU] * dea_invariant(l1, l2);
}

static long double fine_w11(const double *c, long double l)
{
    const long double y = l * l;
    return 0.5L * c[MU] * (2.0L + 6.0L / (y * y * y));
}

DEA_INVARIANT_LAW(slopes, dea_no_gain)

static void form(dea_pool *pool, const dea_expr *c, dea_expr l1, dea_expr l2, dea_law_form *form)
{
    const dea_form_invariants at = dea_form_invariants_of(pool, l1, l2);
    dea_form_stresses(pool, &at, SCALE(0.5, c[MU]), NUM(0.0), form);
}

static const dea_constant constants[] = {{"mu", "Pa", true, 0.0, NAN, "a shear modulus > 0, e.g. 44 kPa"}};

const dea_law dea_law_neo_hookean = {
    .name = "neo_hookean",
    .title = "neo-Hookean",
    .energy_text = "W = mu/2 (I1 - 3)",
    .accepted = "a mapping with mu, e.g. {mu: 44 kPa}",
    .constants = constants,
    .constant_count = sizeof constants / sizeof *constants,
    .entries = 1,
    .linear = true,
    .energy = energy,
    .fine_w11 = fine_w11,
    DEA_INVARIANT_WAYS,
    .form = form,
};
