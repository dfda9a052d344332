/* How fast the linear film about an operating point moves, s the complex frequency:
 *
 *   D(s) = m s^2 + r s + K + sum k_i s tau_i/(1 + s tau_i) + T^2 s/(s C + 1/R_s + 1/R_p) */
#ifndef DEA_PACE_H
#define DEA_PACE_H

#include <complex.h>

#include "network/dynamics.h"

struct dea_membrane;
struct dea_membrane_rest;

/* Its motion: the oscillating pair of roots of D, and the times of the rest. */
typedef struct dea_pace {
    double omega;   /* angular frequency [rad/s], 0: it does not oscillate */
    double decay;   /* of the ring [1/s] */
    double fastest; /* shortest time in which something else than the ring settles [s], +inf: nothing does */
} dea_pace;

/* The trapezoidal rule replaces s by (2/h) tanh(s h/2). Mass and resistance that make the ring's roots those of the film in spite
 * of it; with h -> 0 mass and nothing. */
typedef struct dea_matching {
    double mass;         /* [kg] */
    double resistance;   /* to add [N s/m] */
    double complex ring; /* the root that is matched, 0: none [1/s] */
    double complex root; /* that of the network with this mass and resistance [1/s] */
} dea_matching;

dea_pace dea_pace_of(dea_dynamics *dynamics, double u, double voltage);
/* The same of the slowest mode of a membrane at rest, which decays as fast as that; as to the rest of its film. */
dea_pace dea_pace_of_rings(const struct dea_membrane *membrane, const struct dea_membrane_rest *rest, double decay);
dea_matching dea_matching_of(dea_dynamics *dynamics, double u, double voltage, double step);
/* The same of the slowest mode of a membrane at its equilibrium under a voltage, by mass and resistance over the mass of each node
 * [1], [1/s]: its other modes then turn a little too slow, as they do without. */
dea_matching dea_matching_of_rings(const struct dea_membrane *membrane, double voltage, double step);

#endif
