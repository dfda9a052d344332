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

DEA_INLINE double gain(const double *c, double j, double dj)
{
    (void)c;
    (void)j;
    (void)dj;
    return 0.0;
}

static double energy(const double *c, double l1, double l2)
{
    return 0.5 * c[MU] * dea_invariant(l1, l2);
}

static dea_stress stress(const double *c, double l1, double l2)
{
    return dea_invariant_stress(slopes, c, l1, l2);
}

static long double fine_w11(const double *c, long double l)
{
    const long double y = l * l;
    return 0.5L * c[MU] * (2.0L + 6.0L / (y * y * y));
}

static double rise(const double *c, double l, double d1, double d2)
{
    return dea_invariant_rise(slopes, gain, c, l, d1, d2);
}

static void prepare(dea_film *film)
{
    film->rest[0] = 0.5 * film->constants[MU];
}

static void change(const dea_film *film, size_t count, const double *strains, dea_change *changes)
{
    for (size_t i = 0; i < count; i++) {
        changes[i] = dea_invariant_change(slopes, gain, film, strains[i]);
    }
}

static dea_biaxial biaxial(const dea_film *film, double e1, double e2)
{
    return dea_invariant_biaxial(slopes, gain, film, e1, e2);
}

DEA_INVARIANT_ABREAST(slopes, gain)

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
    .stress = stress,
    .fine_w11 = fine_w11,
    .rise = rise,
    .prepare = prepare,
    .change = change,
    .biaxial = biaxial,
    .changes = changes,
    .biaxials = biaxials,
    .form = form,
};
