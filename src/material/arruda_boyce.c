/* Arruda-Boyce by the five terms of the FE codes: W = mu sum C_i lambda_m^(2 - 2 i) (I1^i - 3^i). With x = I1/lambda_m^2
 *
 *     f' = mu p(x),  f'' = mu p'(x)/lambda_m^2,  f''' = mu p''(x)/lambda_m^4,  p(x) = sum i C_i x^(i - 1) */
#include <math.h>

#include "material/form.h"
#include "material/invariant.h"

enum { MU, LAMBDA_M, TERMS = 5 };

/* C_i and i C_i. */
static const double shares[TERMS] = {1.0 / 2.0, 1.0 / 20.0, 11.0 / 1050.0, 19.0 / 7000.0, 519.0 / 673750.0};
static const double slope_shares[TERMS] = {1.0 / 2.0, 1.0 / 10.0, 11.0 / 350.0, 19.0 / 1750.0, 519.0 / 134750.0};

DEA_INLINE dea_slopes slopes(const double *c, double j)
{
    const double unit = 1.0 / (c[LAMBDA_M] * c[LAMBDA_M]);
    const double x = (j + 3.0) * unit;
    double p = 0.0, first = 0.0, half = 0.0; /* p(x), p'(x), p''(x)/2 by Horner's rule */
    for (int i = TERMS - 1; i >= 0; i--) {
        half = half * x + first;
        first = first * x + p;
        p = p * x + slope_shares[i];
    }
    return (dea_slopes){.w = c[MU] * p, .w1 = c[MU] * first * unit, .w2 = c[MU] * 2.0 * half * unit * unit};
}

/* (p(x + d) - p(x))/d of the polynomial with coefficients @p a, by Horner's rule. */
DEA_INLINE double quotient(const double *a, double x, double d)
{
    double p = 0.0, q = 0.0;
    for (int i = TERMS - 1; i >= 0; i--) {
        q = q * (x + d) + p;
        p = p * x + a[i];
    }
    return q;
}

DEA_INLINE double gain(const double *c, double j, double dj)
{
    const double unit = 1.0 / (c[LAMBDA_M] * c[LAMBDA_M]);
    return c[MU] * quotient(slope_shares, (j + 3.0) * unit, dj * unit) * dj * unit;
}

/* sum C_i lambda_m^(2 - 2 i) (I1^i - 3^i) = J sum C_i x_0^(i - 1) (1 + ... + (x/x_0)^(i - 1)), x_0 = 3/lambda_m^2: the quotient of
 * the polynomial sum C_i x^i. */
static double energy(const double *c, double l1, double l2)
{
    const double unit = 1.0 / (c[LAMBDA_M] * c[LAMBDA_M]);
    const double j = dea_invariant(l1, l2);
    const double x = 3.0 * unit;
    const double d = j * unit;
    double p = 0.0, q = 0.0;
    for (int i = TERMS - 1; i >= 0; i--) {
        p = p * x + shares[i];
        q = q * (x + d) + p;
    }
    return c[MU] * j * q;
}

DEA_INVARIANT_LAW(slopes, gain)

/* The chain stretch sqrt(I1/3) has come to lambda_m; the five terms go on. */
static double locking(const double *c)
{
    return 3.0 * (c[LAMBDA_M] - 1.0) * (c[LAMBDA_M] + 1.0);
}

static void form(dea_pool *pool, const dea_expr *c, dea_expr l1, dea_expr l2, dea_law_form *form)
{
    const dea_form_invariants at = dea_form_invariants_of(pool, l1, l2);
    const dea_expr most = SQUARE(c[LAMBDA_M]);
    const dea_expr x = DIV(ADD(at.j, NUM(3.0)), most);
    dea_expr p = NUM(0.0);
    for (int i = TERMS - 1; i >= 0; i--) {
        p = ADD(NUM(slope_shares[i]), MUL(p, x));
    }
    dea_form_stresses(pool, &at, MUL(c[MU], p), NUM(0.0), form);
    form->room = SUB(SCALE(3.0, SUB(most, NUM(1.0))), at.j); /* I1 = 3 lambda_m^2 where the chains are straight */
}

static const dea_constant constants[] = {
    {"mu", "Pa", true, 0.0, NAN, "a modulus > 0, e.g. 40 kPa"},
    {"lambda_m", "1", false, 1.0, NAN, "the stretch > 1 at which the chains are straight, e.g. 5.99"},
};

const dea_law dea_law_arruda_boyce = {
    .name = "arruda_boyce",
    .title = "Arruda-Boyce",
    .energy_text = "W = mu sum C_i lambda_m^(2 - 2 i) (I1^i - 3^i), C = 1/2, 1/20, 11/1050, 19/7000, 519/673750",
    .accepted = "a mapping with mu and lambda_m, e.g. {mu: 40 kPa, lambda_m: 5.99}",
    .constants = constants,
    .constant_count = sizeof constants / sizeof *constants,
    .entries = 1,
    .starts = {8.0, 4.0, 2.0, 1.3},
    .locking = locking,
    .energy = energy,
    DEA_INVARIANT_WAYS,
    .form = form,
};
