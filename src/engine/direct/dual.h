/* Numbers a + b e with e^2 = q. At sigma + e a function of s holds its values at both roots sigma +- sqrt(q), complex (q < 0),
 * real or coinciding (q = 0), without a division by their difference. With q = 0 and b = 0 they are plain numbers. */
#ifndef DEA_DIRECT_DUAL_H
#define DEA_DIRECT_DUAL_H

#include <math.h>

typedef struct dea_dual {
    double even, odd; /* a, b */
} dea_dual;

static inline dea_dual dea_dual_scale(double factor, dea_dual x)
{
    return (dea_dual){factor * x.even, factor * x.odd};
}

static inline dea_dual dea_dual_add(dea_dual x, dea_dual y)
{
    return (dea_dual){x.even + y.even, x.odd + y.odd};
}

static inline dea_dual dea_dual_mul(dea_dual x, dea_dual y, double square)
{
    return (dea_dual){x.even * y.even + x.odd * y.odd * square, x.even * y.odd + x.odd * y.even};
}

static inline dea_dual dea_dual_div(dea_dual x, dea_dual y, double square)
{
    const double norm = y.even * y.even - y.odd * y.odd * square;
    const dea_dual conjugate = {y.even / norm, -y.odd / norm};
    return dea_dual_mul(x, conjugate, square);
}

/* e^a (cosh(b sqrt q) + e b sinh(b sqrt q)/(b sqrt q)). */
static inline dea_dual dea_dual_exp(dea_dual x, double square)
{
    const double angle2 = x.odd * x.odd * square;
    const double angle = sqrt(fabs(angle2));
    if (angle < 1e-4) {
        const double front = exp(x.even);
        return (dea_dual){front * (1.0 + 0.5 * angle2), front * x.odd * (1.0 + angle2 / 6.0)};
    }
    if (angle2 < 0.0) {
        const double front = exp(x.even);
        return (dea_dual){front * cos(angle), front * x.odd * sin(angle) / angle};
    }
    if (angle < 1.0) {
        const double front = exp(x.even);
        return (dea_dual){front * cosh(angle), front * x.odd * sinh(angle) / angle};
    }
    const double slow = exp(x.even + angle);
    const double fast = exp(x.even - angle);
    return (dea_dual){0.5 * (slow + fast), 0.5 * x.odd * (slow - fast) / angle};
}

enum { DEA_PHI_COUNT = 4, DEA_PHI_TERMS = 18 };

/* exp(z), and phi[k - 1] = phi_k(z) = int_0^1 e^{z (1 - x)} x^{k-1}/(k-1)! dx: phi_{k+1} = (phi_k - 1/k!)/z, phi_0 = e^z; a small
 * z would cancel there, so that it starts from the series of the last. */
static inline dea_dual dea_dual_phi(dea_dual z, double square, dea_dual phi[DEA_PHI_COUNT])
{
    static const double inverse_factorial[DEA_PHI_COUNT] = {1.0, 1.0, 0.5, 1.0 / 6.0};
    const dea_dual whole = dea_dual_exp(z, square);
    if (fmax(fabs(z.even), fabs(z.odd) * sqrt(fabs(square))) > 1.0) {
        dea_dual last = whole;
        for (int k = 0; k < DEA_PHI_COUNT; k++) {
            last.even -= inverse_factorial[k];
            last = phi[k] = dea_dual_div(last, z, square);
        }
        return whole;
    }
    dea_dual sum = {0.0, 0.0};
    for (int k = DEA_PHI_TERMS; k > DEA_PHI_COUNT; k--) { /* Horner: 1/4! (1 + z/5 (1 + z/6 (...))) */
        sum = dea_dual_scale(1.0 / k, dea_dual_mul(z, (dea_dual){1.0 + sum.even, sum.odd}, square));
    }
    phi[DEA_PHI_COUNT - 1] = dea_dual_scale(1.0 / 24.0, (dea_dual){1.0 + sum.even, sum.odd});
    for (int k = DEA_PHI_COUNT - 2; k >= 0; k--) {
        phi[k] = dea_dual_mul(z, phi[k + 1], square);
        phi[k].even += inverse_factorial[k + 1];
    }
    return whole;
}

#endif
