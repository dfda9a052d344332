/* Ogden: W = sum mu_k/alpha_k (l1^alpha_k + l2^alpha_k + l3^alpha_k - 3), l3 = 1/(l1 l2). (Abaqus writes 2 mu/alpha^2 in front,
 * so that its mu_k is mu_k alpha_k/2 of these.) With t = l3:
 *
 *     P1 = sum mu (l1^alpha - t^alpha)/l1,  W11 = sum mu ((alpha - 1) l1^alpha + (alpha + 1) t^alpha)/l1^2,  W12 = sum mu alpha
 * t^alpha
 *     /(l1 l2),  sigma = sum mu (lambda^alpha - lambda^(-2 alpha)) */
#include <math.h>

#include "material/form.h"
#include "material/law.h"

enum { TERMS = 4 };

/* One term of the sum; those out of use have mu = 0. */
typedef struct term {
    double mu, alpha;
} term;

static term term_of(const double *c, size_t k)
{
    return (term){c[2 * k], c[2 * k + 1]};
}

/* e^x - 1 - x. */
static double exp_less_2(double x)
{
    if (fabs(x) > 0.5) {
        return expm1(x) - x;
    }
    double sum = 1.0; /* x^2/2 (1 + x/3 (1 + x/4 (1 + ...))) */
    for (int n = 16; n >= 3; n--) {
        sum = 1.0 + x / n * sum;
    }
    return 0.5 * x * x * sum;
}

/* The logarithms of the three stretches sum to 0: so do the first-order terms, and are left out of each. */
static double energy(const double *c, double l1, double l2)
{
    const double x1 = log1p(l1 - 1.0);
    const double x2 = log1p(l2 - 1.0);
    double sum = 0.0;
    for (size_t k = 0; k < TERMS; k++) {
        const term o = term_of(c, k);
        if (o.mu != 0.0) {
            sum += o.mu / o.alpha * (exp_less_2(o.alpha * x1) + exp_less_2(o.alpha * x2) + exp_less_2(-o.alpha * (x1 + x2)));
        }
    }
    return sum;
}

/* (l2^b - l1^b)/(l2 - l1). */
static double power_quotient(double l1, double l2, double b)
{
    const double d = l2 - l1;
    const double power = pow(l1, b);
    return d == 0.0 ? b * power / l1 : power * expm1(b * log1p(d / l1)) / d;
}

static dea_stress stress(const double *c, double l1, double l2)
{
    const double x1 = log1p(l1 - 1.0);
    const double x2 = log1p(l2 - 1.0);
    const double over = 1.0 / (l1 * l2);
    dea_stress s = {0};
    for (size_t k = 0; k < TERMS; k++) {
        const term o = term_of(c, k);
        if (o.mu != 0.0) {
            const double thin = exp(-o.alpha * (x1 + x2));
            const double rise1 = expm1(o.alpha * (2.0 * x1 + x2)); /* (l1/t)^alpha - 1 */
            const double rise2 = expm1(o.alpha * (2.0 * x2 + x1));
            const double front = o.mu * thin;
            s.shear += o.mu * power_quotient(l1, l2, o.alpha - 1.0) + front * over; /* 1/l1 - 1/l2 = (l2 - l1)/(l1 l2) */
            s.p1 += front * rise1 / l1;
            s.p2 += front * rise2 / l2;
            s.w11 += front * (2.0 * o.alpha + (o.alpha - 1.0) * rise1) / (l1 * l1);
            s.w12 += front * o.alpha * over;
            s.w22 += front * (2.0 * o.alpha + (o.alpha - 1.0) * rise2) / (l2 * l2);
        }
    }
    return s;
}

/* P1 = sum mu (l1^(alpha - 1) - l1^(-alpha - 1) l2^-alpha). */
static double rise(const double *c, double l, double d1, double d2)
{
    const double x1 = log1p(d1 / l);
    const double x2 = log1p(d2 / l);
    double sum = 0.0;
    for (size_t k = 0; k < TERMS; k++) {
        const term o = term_of(c, k);
        if (o.mu != 0.0) {
            const double rest = pow(l, o.alpha);
            sum += o.mu * (rest * expm1((o.alpha - 1.0) * x1) - expm1(-(o.alpha + 1.0) * x1 - o.alpha * x2) / (rest * rest));
        }
    }
    return sum / l;
}

static void prepare(dea_film *film)
{
    for (size_t k = 0; k < TERMS; k++) {
        film->rest[k] = pow(film->prestretch, film->constants[2 * k + 1]);
    }
}

/* With s = (1 + e)^alpha - 1 and q = 1 + s the change of lambda^-2 alpha is -s (2 + s)/q^2 of it; where q is small, a film that is
 * squeezed to nothing, the sum would keep none of its digits. */
static dea_change change_at(const dea_film *film, double e)
{
    const double x = log1p(e);
    const double over = 1.0 / (1.0 + e);
    dea_change sum = {0.0, 0.0, 0.0};
    for (size_t k = 0; k < TERMS; k++) {
        const term o = term_of(film->constants, k);
        if (o.mu != 0.0) {
            const double s = expm1(o.alpha * x);
            const double q = s > -0.5 ? 1.0 + s : exp(o.alpha * x);
            const double shrink = 1.0 / (q * q);
            const double out = film->rest[k];      /* lambda_pre^alpha */
            const double thin = 1.0 / (out * out); /* lambda_pre^-2 alpha */
            const double grown = out * q, thinned = thin * shrink;
            sum.value += o.mu * (out * s + thin * s * (2.0 + s) * shrink);
            sum.slope += o.mu * o.alpha * (grown + 2.0 * thinned) * over;
            sum.curve += o.mu * o.alpha * ((o.alpha - 1.0) * grown - 2.0 * (2.0 * o.alpha + 1.0) * thinned) * over * over;
        }
    }
    return sum;
}

static void change(const dea_film *film, size_t count, const double *strains, dea_change *changes)
{
    for (size_t i = 0; i < count; i++) {
        changes[i] = change_at(film, strains[i]);
    }
}

static const char *fault(const double *c)
{
    double sum = 0.0;
    for (size_t k = 0; k < TERMS; k++) {
        const term o = term_of(c, k);
        if (o.mu != 0.0 && o.alpha == 0.0) {
            return "an exponent alpha is 0; accepted: any other number, e.g. 1.445";
        }
        sum += o.mu * o.alpha;
    }
    return sum > 0.0 ? NULL : "mu alpha of the terms sums to no more than 0; accepted: a sum > 0, twice the shear modulus";
}

/* sigma_a = sum mu (l_a^alpha - (l1 l2)^-alpha), of the powers of the two stretches alone: their changes share what is not
 * rational in them. */
static void form(dea_pool *pool, const dea_expr *c, dea_expr l1, dea_expr l2, dea_law_form *form)
{
    *form = (dea_law_form){{NUM(0.0), NUM(0.0)}, NUM(1.0)};
    for (size_t k = 0; k < TERMS; k++) {
        const dea_expr mu = c[2 * k], alpha = c[2 * k + 1];
        if (dea_expr_constant(pool, mu) == 0.0) {
            continue;
        }
        const dea_expr power[] = {POW(l1, alpha), POW(l2, alpha)};
        const bool swapped = power[1] < power[0]; /* one order, so that both stresses share terms */
        const dea_expr thin = DIV(NUM(1.0), MUL(power[swapped], power[!swapped]));
        for (int a = 0; a < 2; a++) {
            form->stress[a] = ADD(form->stress[a], MUL(mu, SUB(power[a], thin)));
        }
        form->room = MUL(form->room, SQUARE(alpha));
    }
}

static const dea_constant constants[] = {
    {"mu", "Pa", true, -INFINITY, NAN, "a modulus, e.g. 43.4 kPa"},
    {"alpha", "1", false, -INFINITY, NAN, "an exponent, not 0, e.g. 1.445"},
};

const dea_law dea_law_ogden = {
    .name = "ogden",
    .title = "Ogden",
    .energy_text = "W = sum mu/alpha (l1^alpha + l2^alpha + l3^alpha - 3)",
    .accepted = "a list of at most 4 terms, e.g. [{mu: 43.4 kPa, alpha: 1.445}]",
    .constants = constants,
    .constant_count = sizeof constants / sizeof *constants,
    .entries = TERMS,
    .starts = {1.5, 4.0, -2.0, 8.0},
    .fault = fault,
    .energy = energy,
    .stress = stress,
    .rise = rise,
    .prepare = prepare,
    .change = change,
    .form = form,
};
