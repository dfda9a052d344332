/* Frequency response of the exact membrane: the equation of the film along its radius, linearised about the static film under the
 * bias, by its own quadrature and without a network.
 *
 * u(R) e^{i w t} about r(R), changes of the nominal stresses per volt on the film, k = eps (U/H)^2 where electroded, else 0:
 *
 *     ds1/dR + (s1 - s2)/R = -rho w^2 u,   s_a = S_a1 u' + S_a2 u/R - (dk/dU) dC_a,   u = 0 at the frame
 *     S_11 = (1 + V) W11 + V P1/l1 - k l2^2,   S_12 = (1 + V) W12 - 2 k l1 l2,   S_22 = (1 + V) W22 + V P2/l2 - k l1^2
 *     V = i w tau_KV + sum c_i i w tau_i/(1 + i w tau_i): damper and branches on the principal Cauchy stresses l_a P_a
 *     dC_1 = l1 l2^2,  dC_2 = l1^2 l2:  C = (2 pi eps/H) int (l1 l2)^2 R dR
 *
 * rho: of film and electrode over the reference film. */
#ifndef DEA_DIRECT_RADIAL_H
#define DEA_DIRECT_RADIAL_H

#include <complex.h>

#include "network/dynamics.h"

/* Per volt on the film. */
typedef struct dea_per_volt {
    double complex displacement; /* of the edge at r_a [m/V] */
    double complex charge;       /* [C/V] */
} dea_per_volt;

struct dea_radial_mesh;

enum { DEA_RADIAL_MESHES = 14 };

typedef struct dea_radial {
    const dea_dynamics *dynamics; /* borrowed: point under the bias, masses, damper, branches */
    dea_row rest;                 /* the film under the bias */
    double mass[2];               /* rho R_a^2/W11 of disc and annulus [s^2] */
    double load_mass;             /* at the edge [kg], 0: none */
    struct dea_radial_mesh *meshes[DEA_RADIAL_MESHES]; /* owned: each twice as fine as the one before; NULL: not made yet */
} dea_radial;

/* Rest under the film voltage of the point of @p dynamics, which was set up without a network; its state tells whether there is
 * one. The caller ends it with dea_radial_close(). */
void dea_radial_open(const dea_dynamics *dynamics, const dea_scene *scene, dea_radial *radial);
void dea_radial_close(dea_radial *radial);

/* The answer at a frequency; false where two meshes do not agree within the accuracy, or memory ran out. */
bool dea_radial_answer(dea_radial *radial, double frequency, double accuracy, dea_per_volt *answer);

/* V at an angular frequency. */
double complex dea_radial_viscosity(const dea_dynamics *dynamics, double omega);

#endif
