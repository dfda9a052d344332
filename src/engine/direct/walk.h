/* A linear network on its way through the segments of the source voltage: exact on each, joined at the edges. Where the voltage
 * softens the film, its stiffness is that under the largest voltage of the segment: exact where that rests. */
#ifndef DEA_DIRECT_WALK_H
#define DEA_DIRECT_WALK_H

#include "engine/direct/piece.h"
#include "network/peak.h"

enum { DEA_WALK_CACHED = 2 };

/* Modes under one stiffness, and what the sample interval does to them. */
typedef struct dea_walk_modes {
    dea_modes modes;
    dea_advance every;
} dea_walk_modes;

typedef struct dea_walk {
    const dea_signal *signal; /* borrowed */
    dea_linear linear;
    dea_chain chain; /* at 0 V */
    double every;    /* interval of the samples [s] */
    bool from_bias;  /* starts in the equilibrium under the first voltage */
    dea_walk_modes cache[DEA_WALK_CACHED];
    size_t cached;             /* in use */
    const dea_walk_modes *now; /* NULL before the first segment */
    dea_course course;         /* at the begin of the segment, the part of a sine included */
    double force;              /* before that begin [N] */
    dea_motion motion;         /* before that begin */
    bool lost;                 /* pull-in */
    double cancellation;       /* worst of the modes */
} dea_walk;

/* The chain of a film whose relaxed springs have that stiffness and damp with tau_KV [s]. */
dea_chain dea_walk_chain(const dea_dynamics *dynamics, double stiffness);
/* Begins a segment behind the edge in front of it; `lost` where nothing holds the film. DEA_ERROR_UNSUPPORTED where the modes
 * cannot be told apart. */
dea_status dea_walk_enter(dea_walk *walk, const dea_segment *segment, dea_error *error);
/* The segment that was entered, and the course at its begin without what a sine does. */
dea_piece dea_walk_piece(const dea_walk *walk, const dea_segment *segment, dea_course *start);
/* Motion at time t of the piece. */
dea_motion dea_walk_motion(const dea_walk *walk, const dea_piece *piece, const dea_course *start, double t);
/* Takes the course to the end of the piece. */
void dea_walk_pass(dea_walk *walk, const dea_piece *piece, const dea_course *start);

/* Sees the current of the source over a segment that was entered, without series resistance: the walk, its piece and the course at
 * its begin. False where a ring or a sine turns too often for that. */
bool dea_direct_peak(const dea_walk *walk, const dea_piece *piece, const dea_course *start, dea_dynamics *dynamics, dea_peak *peak);

#endif
