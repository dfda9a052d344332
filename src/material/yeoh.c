/* Incompressible Yeoh film. I - 3 and l^2 - l^-4 are factored so that they keep their digits near l = 1. */
#include "deaspice/material.h"

/* I - 3 at in-plane stretches l1, l2; with p = l1^2 - 1 and q = l2^2 - 1 it is (p^2 (1+q) + q^2 (1+p) + p q)/((1+p)(1+q)). */
static double invariant_less_3(double l1, double l2)
{
    const double p = (l1 - 1.0) * (l1 + 1.0);
    const double q = (l2 - 1.0) * (l2 + 1.0);
    return (p * p * (1.0 + q) + q * q * (1.0 + p) + p * q) / ((1.0 + p) * (1.0 + q));
}

/* w = dW/dI. */
static double energy_slope(const double yeoh[DEA_YEOH_TERMS], double j)
{
    return yeoh[0] + j * (2.0 * yeoh[1] + 3.0 * yeoh[2] * j);
}

dea_stress dea_yeoh_stress(const double yeoh[DEA_YEOH_TERMS], double l1, double l2)
{
    const double t3 = 1.0 / (l1 * l2); /* thickness stretch */
    const double t3s = t3 * t3;
    const double over1 = t3 * l2; /* 1/l1 */
    const double over2 = t3 * l1;
    const double p = (l1 - 1.0) * (l1 + 1.0);
    const double r = (l2 - 1.0) * (l2 + 1.0);
    const double j = (p * p * (1.0 + r) + r * r * (1.0 + p) + p * r) * t3s; /* as invariant_less_3(), with one division in all */
    const double w = energy_slope(yeoh, j);
    const double q = 2.0 * yeoh[1] + 6.0 * yeoh[2] * j;
    const double a1 = 2.0 * (l1 - t3s * over1);
    const double a2 = 2.0 * (l2 - t3s * over2);
    return (dea_stress){
        .w = w,
        .p1 = w * a1,
        .p2 = w * a2,
        .w11 = w * (2.0 + 6.0 * t3s * over1 * over1) + q * a1 * a1,
        .w12 = 4.0 * w * t3s * t3 + q * a1 * a2,
        .w22 = w * (2.0 + 6.0 * t3s * over2 * over2) + q * a2 * a2,
    };
}

double dea_yeoh_energy(const double yeoh[DEA_YEOH_TERMS], double l1, double l2)
{
    const double j = invariant_less_3(l1, l2);
    return j * (yeoh[0] + j * (yeoh[1] + j * yeoh[2]));
}

double dea_yeoh_equibiaxial(const double yeoh[DEA_YEOH_TERMS], double stretch)
{
    const double y = stretch * stretch;
    const double p = (stretch - 1.0) * (stretch + 1.0);
    const double j = p * p * (2.0 * y + 1.0) / (y * y);
    return 2.0 * p * (y * y + y + 1.0) / (y * y) * energy_slope(yeoh, j);
}

double dea_yeoh_modulus(const double yeoh[DEA_YEOH_TERMS], double stretch)
{
    const double y = stretch * stretch;
    const double p = (stretch - 1.0) * (stretch + 1.0);
    const double j = p * p * (2.0 * y + 1.0) / (y * y);
    const double g = p * (y * y + y + 1.0) / (y * y);
    const double w = energy_slope(yeoh, j);
    const double slope = 2.0 * yeoh[1] + 6.0 * yeoh[2] * j;
    /* dg/dl = 2 (l + 2 l^-5), dj/dl = 4 g/l */
    return 4.0 * (stretch + 2.0 / (y * y * stretch)) * w + 8.0 * g * g * slope / stretch;
}
