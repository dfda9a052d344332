/* What one run over all pieces leaves: the states at the samples, the energies, how far it came. */
#ifndef DEA_NGSPICE_TRACK_H
#define DEA_NGSPICE_TRACK_H

#include "engine/ngspice/library.h"
#include "engine/ngspice/pieces.h"
#include "engine/ngspice/deck.h"
#include "network/peak.h"

/* Displacement, velocity, charge and its slope, where there is a series resistance, at a sample. */
typedef struct dea_track_point {
    double u, v, charge, current;
} dea_track_point;

typedef struct dea_track {
    dea_track_point *points;       /* owned: computed by dea_track_run(), `reached` of them */
    size_t reached;                /* samples before the run ended */
    dea_state end;                 /* why: ok, pull_in, failed */
    double integrals[DEA_WINDOWS]; /* of u over the windows of the scene [m s] */
    double steps, netlists;        /* of the library, those of steps that collapsed too */
    bool exhausted;                /* it failed since it took more work than it may */
    bool bounces;                  /* it failed since its steps went through where the film turns back */
    bool vague;                    /* a sample lies in the step in which the film ran away */
    dea_peak peak;                 /* of the current, behind a series resistance */
    dea_audit audit;
    dea_moment first, last;
    dea_mobility_state start, stop; /* the states that go with them */
} dea_track;

/* Times at which the source came to its limit or from it. */
typedef struct dea_cuts {
    double *times; /* owned by who made it, not decreasing [s] */
    size_t count, room;
    bool exhausted; /* no memory for all */
} dea_cuts;

/* A run's fixed parts. */
typedef struct dea_route {
    dea_ngspice *library;
    const dea_scene *scene;
    dea_dynamics *dynamics;
    dea_dynamics *slow; /* the same film without mass, and without damper where it has mass */
    const dea_mobility *mobility;
    const dea_signal *signal;
    const dea_pieces *pieces;
    size_t samples;
    double voltage; /* most that the film sees [V] */
    double scale;   /* size of a displacement [m] */
    bool peaks; /* the current between samples is known */
    double omega;   /* of the ring [rad/s], 0: none */
    double most;    /* work of a run, dea_track_work(); 0: no limit */
    double unit;    /* of the times of the scene [1/s] */
    dea_cuts *cuts; /* takes those of a run; NULL: not wanted */
} dea_route;

/* Runs the pieces with @p fineness times their steps; the caller frees track->points, also after a failure. A run that ends early
 * is no failure of this call. */
dea_status dea_track_run(const dea_route *route, double fineness, dea_track *track, dea_error *error);

/* Work, in time steps of a linear network, that so many points in so many netlists take. */
double dea_track_work(const dea_route *route, double points, double netlists);

/* Film voltage that goes with a state. */
double dea_route_voltage(const dea_route *route, double source, double u, double charge);

#endif
