/* The moving membrane along its radius: what the polynomials of its elements tell between the nodes, and where it is nearest to its
 * limits. */
#ifndef DEA_ALONG_H
#define DEA_ALONG_H

#include "network/membrane.h"

/* Radii of one mesh. */
typedef struct dea_along {
    size_t count;          /* 0: nothing is told */
    dea_rings_spot *spots; /* owned */
    double accuracy;       /* of the scene */
} dea_along;

/* A state of the membrane; all borrowed. */
typedef struct dea_along_state {
    const dea_membrane_look *look;
    double voltage;        /* of the film [V] */
    const double (*x)[2];  /* stresses of damper and branches at the rings [Pa] */
    const double *u, *v;   /* [m], [m/s] */
} dea_along_state;

/* The radii that rows of a layout tell something at. The caller ends it with dea_along_close(), also after a failure.
 * DEA_ERROR_MEMORY. */
dea_status dea_along_open(const dea_membrane *membrane, const dea_scene *scene, const dea_layout *layout, dea_along *along,
                          dea_error *error);
void dea_along_close(dea_along *along);

/* Numbers of an entry of a transient's profile, of which there are DEA_SPREAD_COLUMNS; true stresses and true field. */
enum {
    DEA_ALONG_DISPLACEMENT,
    DEA_ALONG_VELOCITY,
    DEA_ALONG_RADIAL,
    DEA_ALONG_HOOP,
    DEA_ALONG_THICKNESS,
    DEA_ALONG_RADIAL_STRESS,
    DEA_ALONG_HOOP_STRESS,
    DEA_ALONG_FIELD
};

/* Entries of one row, radius after radius. At r_a they are those of the disc. */
void dea_along_tell(const dea_along *along, const dea_membrane *membrane, const dea_along_state *state, double *entries);
/* Where the film is nearest to its limits, between rings too. A radius is told to a thousandth of the frame's, as an extreme is flat, and
 * NAN where what it is of is the same all over the film but for ten times the accuracy. */
dea_weakest dea_along_weakest(const dea_along *along, const dea_membrane *membrane, const dea_along_state *state);

#endif
