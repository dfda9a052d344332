/* Writes the moving network in the mobility analogy: velocity of the edge -> voltage, force -> current, compliance -> inductor,
 * mass -> capacitor to ground, mechanical resistance r -> resistor 1/r. Only what the scene has becomes an element. */
#ifndef DEA_MOBILITY_H
#define DEA_MOBILITY_H

#include "drive/signal.h"
#include "network/dynamics.h"

typedef struct dea_mobility {
    const dea_dynamics *dynamics;              /* borrowed */
    dea_network network;                       /* owned: built under 1 V, so that the force is phi */
    dea_network_stress stresses[DEA_STRESSES]; /* S_a and B_a, as many as the dynamics have */
    dea_expr tension, push;                    /* G, phi */
    bool tense;                                /* there is a G */
    dea_expr resistance;                       /* tau_KV sum B_a S_a' [N s/m], where there is a damper */
    double stiffness;                          /* of all linear springs [N/m]; NAN where the springs are hyperelastic */
    double rest;                               /* capacitance of the film at rest [F] */
    bool displaced;                            /* set by dea_mobility_displace() */
} dea_mobility;

/* States of the network: what one piece of a run hands to the next. */
typedef struct dea_mobility_state {
    double u, v;               /* [m], [m/s] */
    double charge;             /* of the film [C], where there is a series resistance */
    double z[DEA_RELAXED_MAX]; /* relaxed stresses of the branches, as the dynamics number them */
} dea_mobility_state;

/* One piece of a transient. */
typedef struct dea_mobility_piece {
    const dea_signal *signal;
    size_t segment;     /* of `from` */
    double from, to;    /* [s] */
    double step;        /* longest time step [s] */
    double parts;       /* an edge that is shorter than so many steps is cut into as many parts by corners */
    double scale;       /* size of a displacement, for tolerances [m] */
    double force;       /* that goes with it, for tolerances [N] */
    double tolerance;   /* of Newton's method in a step, relative [1] */
    double loose;       /* absolute tolerances over the tightest that rounding is thought to allow, >= 1 */
    double mass;        /* [kg] */
    double conductance; /* 0: none; resistor beside the mass that fits the rule's damping to the film's [N s/m] */
    dea_mobility_state start;
} dea_mobility_piece;

/* A small-signal network about an equilibrium. */
typedef struct dea_mobility_bias {
    double u;       /* [m] */
    double voltage; /* of the film [V] */
} dea_mobility_bias;

/* Frequencies: points_per_decade of a decade from `from` on; or, where they are 0, `count` evenly, or one alone. */
typedef struct dea_mobility_band {
    double from, to; /* [Hz] */
    size_t points_per_decade, count;
} dea_mobility_band;

/* Most vectors of a run: time, displacement, velocity, charge, branches. */
enum { DEA_MOBILITY_VECTORS = 4 + DEA_RELAXED_MAX, DEA_MOBILITY_NAME = 24 };

typedef struct dea_mobility_vectors {
    char names[DEA_MOBILITY_VECTORS][DEA_MOBILITY_NAME];
    size_t count;
} dea_mobility_vectors;

/* Builds what the netlists are written from; the caller ends it with dea_mobility_close(), also after a failure. */
dea_status dea_mobility_open(const dea_scene *scene, const dea_dynamics *dynamics, dea_mobility *mobility, dea_error *error);
void dea_mobility_close(dea_mobility *mobility);

/* Transients of a film without mass and damper in the displacement form from here on: nothing holds its velocity, a difference of
 * displacements over a step that drowns in rounding where steps are short. */
void dea_mobility_displace(dea_mobility *mobility);

/* Node of stress number @p index: `stress` where it is alone. */
typedef struct dea_stress_node {
    char name[32];
} dea_stress_node;
dea_stress_node dea_mobility_stress_node(const dea_dynamics *dynamics, size_t index);

/* Netlist of one piece of a transient; on DEA_OK the caller frees *text. */
dea_status dea_mobility_write(const dea_mobility *mobility, const dea_mobility_piece *piece, char **text, dea_error *error);
/* The vectors of its plot, time first. */
dea_mobility_vectors dea_mobility_vectors_of(const dea_mobility *mobility);
/* The states of point @p index from columns in the order of the vectors. */
dea_mobility_state dea_mobility_read(const dea_mobility *mobility, const double *const *columns, size_t index);

/* Small-signal netlist about a bias, over a band; on DEA_OK the caller frees *text. Its vectors are `lspring#branch`, the current
 * of the spring, and `vsource#branch`; the source has 1 V. */
dea_status dea_mobility_write_small(dea_dynamics *dynamics, const dea_mobility_bias *bias, const dea_mobility_band *band,
                                    char **text, dea_error *error);

#endif
