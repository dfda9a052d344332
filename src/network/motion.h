/* The moving network of one run as an index-1 problem  y' = f(t, y)  or, for an algebraic displacement,  0 = f(t, y),  in
 * unknowns of size 1: only those that the scene needs.
 *
 *   u    displacement; with mass a state, with a damper alone u' follows from it, with neither algebraic
 *   v    velocity, with mass
 *   z    stresses that the branches have relaxed from, as the dynamics number them
 *   q    charge of the film, with series resistance */
#ifndef DEA_MOTION_H
#define DEA_MOTION_H

#include "drive/signal.h"
#include "network/dynamics.h"

enum { DEA_MOTION_MOST = DEA_RELAXED_MAX + 3 };

typedef struct dea_motion {
    dea_dynamics *dynamics; /* borrowed, as all here */
    const dea_signal *signal;
    const dea_segment
        *segment;     /* at which times are counted from its begin, so that a short edge late in a run keeps its digits */
    int v, z, q;      /* where they are, -1: there is none; u is always 0 */
    int count;        /* of unknowns */
    bool algebraic;   /* u is */
    double stiffness; /* at rest with the branches held [N/m] */
    double pace;      /* of an algebraic u: makes its row as large as those of the states, whatever the unit of time [1/s] */
    double capacitance; /* at rest [F] */
    double size[DEA_MOTION_MOST]; /* of the unknowns [m, m/s, Pa or N, C] */
} dea_motion;

/* Lays out the unknowns. */
void dea_motion_open(dea_dynamics *dynamics, const dea_signal *signal, dea_motion *motion);

/* True where disc and annulus both are there. */
bool dea_motion_inside(const dea_motion *motion, double u);
/* f at y; false where the film cannot be. */
bool dea_motion_rates(const dea_motion *motion, double time, const double *y, double *f);
/* df/dy, column by column. S'' of the damper's force is left out: it serves Newton's method. */
void dea_motion_jacobian(const dea_motion *motion, double time, const double *y, double *jacobian);
/* Net stiffness that holds an algebraic u, over that at rest: 0 where it loses its equilibrium. Of a film that charges through a
 * resistance no more than its capacitance over that at rest: 0 where nothing is left to charge. 1 for what has neither end. */
double dea_motion_firmness(const dea_motion *motion, double time, const double *y);

/* The state at the begin of a run; false without a stable equilibrium. */
bool dea_motion_start(const dea_motion *motion, bool from_bias, double *y);
/* Moves an algebraic u to the voltage of the begin of the segment, all else held; false without equilibrium. */
bool dea_motion_jump(const dea_motion *motion, double *y);

/* The moment that y is, and its branches. */
dea_moment dea_motion_moment(const dea_motion *motion, double time, const double *y);
void dea_motion_branches(const dea_motion *motion, const double *y, double *z);

#endif
