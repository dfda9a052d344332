/* The units of a study in time or frequency: powers of two in which displacement, stress, force, voltage and a time are of
 * size 1. Tolerances and least values of the library then mean the same for an actuator of any size, and powers of two cost no
 * digit. What a run's netlists and states call m, N, V or s are then these units. */
#ifndef DEA_NETWORK_UNITS_H
#define DEA_NETWORK_UNITS_H

#include "network/membrane.h"

/* What a number in SI is multiplied by. The permittivity follows from the others, so that strains stay as they are. */
typedef struct dea_units {
    double length;    /* in the plane of the film */
    double thickness; /* of the film */
    double stress;
    double voltage;
    double time;
} dea_units;

/* Sizes of a study that become 1. */
typedef struct dea_sizes {
    double displacement; /* [m] */
    double voltage;      /* [V], 0: none */
    double time;         /* [s] */
} dea_sizes;

/* Units in which these sizes, and the force that goes with them, are 1. */
dea_units dea_units_of(dea_dynamics *dynamics, const dea_sizes *sizes);
/* Units in which these sizes are 1, and so are the stresses of a membrane that goes with them and its force under the voltage. */
dea_units dea_units_of_rings(const dea_membrane *membrane, const dea_membrane_rest *rest, const dea_sizes *sizes);

/* The scene in these units. It borrows all but the points of its waveform; on DEA_OK the caller ends it with dea_units_leave().
 * DEA_ERROR_MEMORY. */
dea_status dea_units_enter(const dea_units *units, const dea_scene *scene, dea_scene *inside, dea_error *error);
void dea_units_leave(dea_scene *inside);

/* Rows and summary back to SI. */
void dea_units_return_sample(const dea_units *units, dea_sample *sample);
void dea_units_return_response(const dea_units *units, dea_response *row);
void dea_units_return_summary(const dea_units *units, dea_summary *summary);

#endif
