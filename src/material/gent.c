/* Gent: W = -mu Jm/2 ln(1 - J/Jm), J = I1 - 3: chains that are straight at J = Jm, where the energy ends.
 *
 *     f' = mu/2 r,  f'' = mu/(2 Jm) r^2,  f''' = mu/Jm^2 r^3,  r = Jm/(Jm - J) */
#include <math.h>

#include "material/form.h"
#include "material/invariant.h"

enum { MU, JM };

/* r, NAN at the end and past it. */
DEA_INLINE double growth(const double *c, double j)
{
    return j < c[JM] ? c[JM] / (c[JM] - j) : (double)NAN;
}

DEA_INLINE dea_slopes slopes(const double *c, double j)
{
    const double r = growth(c, j);
    const double w = 0.5 * c[MU] * r;
    const double w1 = w * r / c[JM];
    return (dea_slopes){.w = w, .w1 = w1, .w2 = 2.0 * w1 * r / c[JM]};
}

DEA_INLINE double gain(const double *c, double j, double dj)
{
    return 0.5 * c[MU] * growth(c, j) * growth(c, j + dj) * dj / c[JM];
}

static double energy(const double *c, double l1, double l2)
{
    return -0.5 * c[MU] * c[JM] * log1p(-dea_invariant(l1, l2) / c[JM]);
}

DEA_INVARIANT_LAW(slopes, gain)

static double locking(const double *c)
{
    return c[JM];
}

static void form(dea_pool *pool, const dea_expr *c, dea_expr l1, dea_expr l2, dea_law_form *form)
{
    const dea_form_invariants at = dea_form_invariants_of(pool, l1, l2);
    const dea_expr room = SUB(c[JM], at.j);
    dea_form_stresses(pool, &at, DIV(SCALE(0.5, MUL(c[MU], c[JM])), POSITIVE(room)), NUM(0.0), form);
    form->room = room;
}

static const dea_constant constants[] = {
    {"mu", "Pa", true, 0.0, NAN, "a shear modulus > 0, e.g. 45 kPa"},
    {"Jm", "1", false, 0.0, NAN, "a number > 0, I1 - 3 at the longest stretch, e.g. 120"},
};

const dea_law dea_law_gent = {
    .name = "gent",
    .title = "Gent",
    .energy_text = "W = -mu Jm/2 ln(1 - (I1 - 3)/Jm)",
    .accepted = "a mapping with mu and Jm, e.g. {mu: 45 kPa, Jm: 120}",
    .constants = constants,
    .constant_count = sizeof constants / sizeof *constants,
    .entries = 1,
    .starts = {300.0, 100.0, 30.0, 10.0},
    .locking = locking,
    .ends = true,
    .energy = energy,
    DEA_INVARIANT_WAYS,
    .form = form,
};
