/* The energies of physics.md, section 8, in long double, as principal Cauchy stresses of an incompressible film under plane
 * stress: with y = l^2 and v = l3^2 = 1/(y1 y2), sigma_1 = 2 (y1 - v) (dW/dI1 + y2 dW/dI2), and sigma_1 = l1 dW/dl1 - l3 dW/dl3
 * where W is a sum over the stretches. */
#include <string.h>

#include "truths.h"

/* dW/dI1 as a function of J = I1 - 3. */
typedef jet invariant_slope(const long double *c, jet j);

static jet yeoh(const long double *c, jet j)
{
    return plus(plain(c[0]), by(j, plus(plain(2.0L * c[1]), times(3.0L * c[2], j))));
}

static jet neo_hookean(const long double *c, jet j)
{
    (void)j;
    return plain(0.5L * c[0]);
}

/* mu/2 Jm/(Jm - J); NAN at the end of the energy and past it. */
static jet gent(const long double *c, jet j)
{
    const jet room = minus(plain(c[1]), j);
    return times(room.value > 0.0L ? 0.5L * c[0] * c[1] : (long double)NAN, inverse(room));
}

/* mu sum i C_i (I1/lambda_m^2)^(i - 1). */
static jet arruda_boyce(const long double *c, jet j)
{
    static const long double series[] = {0.5L, 1.0L / 20.0L, 11.0L / 1050.0L, 19.0L / 7000.0L, 519.0L / 673750.0L};
    const jet share = times(1.0L / (c[1] * c[1]), plus(plain(3.0L), j));
    jet sum = plain(0.0L);
    for (int i = 5; i >= 1; i--) {
        sum = plus(plain(i * series[i - 1]), by(share, sum));
    }
    return times(c[0], sum);
}

/* What the stress of all laws of the invariants is made of. */
typedef struct invariants {
    jet y2, gap, j; /* gap: y1 - v */
} invariants;

static invariants invariants_of(jet l1, jet l2)
{
    const jet y1 = by(l1, l1), y2 = by(l2, l2), v = inverse(by(y1, y2));
    return (invariants){y2, minus(y1, v), plus(plain(-3.0L), plus(plus(y1, y2), v))};
}

static jet stress_of(invariant_slope *slope, const long double *c, jet l1, jet l2)
{
    const invariants at = invariants_of(l1, l2);
    return times(2.0L, by(at.gap, slope(c, at.j)));
}

static jet yeoh_stress(const long double *c, jet l1, jet l2)
{
    return stress_of(yeoh, c, l1, l2);
}

static jet neo_hookean_stress(const long double *c, jet l1, jet l2)
{
    return stress_of(neo_hookean, c, l1, l2);
}

static jet gent_stress(const long double *c, jet l1, jet l2)
{
    return stress_of(gent, c, l1, l2);
}

static jet arruda_boyce_stress(const long double *c, jet l1, jet l2)
{
    return stress_of(arruda_boyce, c, l1, l2);
}

static jet mooney_rivlin_stress(const long double *c, jet l1, jet l2)
{
    const invariants at = invariants_of(l1, l2);
    return times(2.0L, by(at.gap, plus(plain(c[0]), times(c[1], at.y2))));
}

static jet ogden_stress(const long double *c, jet l1, jet l2)
{
    const jet thickness = inverse(by(l1, l2));
    jet sum = plain(0.0L);
    for (int i = 0; i + 1 < DEA_LAW_CONSTANTS; i += 2) {
        if (c[i] != 0.0L) {
            sum = plus(sum, times(c[i], minus(power(l1, c[i + 1]), power(thickness, c[i + 1]))));
        }
    }
    return sum;
}

static const true_law laws[] = {
    {"yeoh", 0x7, yeoh_stress},       {"neo_hookean", 0x1, neo_hookean_stress}, {"mooney_rivlin", 0x3, mooney_rivlin_stress},
    {"gent", 0x1, gent_stress},       {"ogden", 0x55, ogden_stress},            {"arruda_boyce", 0x1, arruda_boyce_stress},
};

const true_law *true_law_find(const char *name)
{
    for (size_t i = 0; i < sizeof laws / sizeof *laws; i++) {
        if (strcmp(laws[i].name, name) == 0) {
            return &laws[i];
        }
    }
    return NULL;
}
