/* Small motion of a membrane about its bias, and the mesh that its frequency response wants: what engine and exports share. */
#ifndef DEA_RINGS_BAND_H
#define DEA_RINGS_BAND_H

#include <complex.h>

#include "network/membrane.h"

/* A membrane at the relaxed equilibrium under its bias. */
typedef struct dea_rings_biased {
    dea_membrane membrane;
    dea_membrane_look look;
    double u[DEA_RINGS_NODES]; /* [m] */
    double voltage;            /* of the film [V] */
    dea_state state;           /* of its static row; pull_in: it has no equilibrium */
} dea_rings_biased;

/* Opens it on a mesh; a film without equilibrium is no failure. */
dea_status dea_rings_bias(const dea_scene *scene, const dea_model *model, dea_rings_mesh mesh, dea_rings_biased *biased, dea_error *error);
/* True where it stands, so that it has a response. */
static inline bool dea_rings_stands(const dea_rings_biased *biased)
{
    return biased->state != DEA_STATE_PULL_IN && biased->state != DEA_STATE_FAILED;
}

/* Opens it on the coarser of the meshes from which on two degrees more change no row of the band by more than the accuracy, by what
 * is *gap; inf where no mesh is so good. */
dea_status dea_rings_band(const dea_scene *scene, const dea_model *model, dea_rings_biased *biased, double *gap, dea_error *error);

#endif
