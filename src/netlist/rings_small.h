/* The membrane's small motion about its bias as cards, mobility analogy: v(v<n>) is the velocity of node n [m/s], v(u<n>) its
 * integral, the displacement [m], currents are forces [N]. All elements are linear. */
#ifndef DEA_RINGS_SMALL_H
#define DEA_RINGS_SMALL_H

#include <stdio.h>

#include "netlist/dialect.h"
#include "network/membrane.h"

/* A membrane at its relaxed equilibrium. */
typedef struct dea_rings_small {
    const dea_membrane *membrane;
    const double *u; /* displacements [m] */
    double voltage;  /* of the film [V] */
} dea_rings_small;

/* Writes film and electrical port with a source of 1 V, `Vsource`: the film's voltage is v(film), the charge that its motion brings
 * v(motion) [C]. */
void dea_rings_small_write(const dea_rings_small *small, FILE *out);

#endif
