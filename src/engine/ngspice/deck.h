/* The decks in which the engine runs the cards of the moving network: numbers in its units, source, steps, tolerances. */
#ifndef DEA_NGSPICE_DECK_H
#define DEA_NGSPICE_DECK_H

#include "drive/signal.h"
#include "netlist/mobility.h"

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

/* The voltage of the source from the begin of the piece on: its segments as breakpoints, or a sine. */
void dea_deck_source(FILE *out, const dea_mobility_piece *piece, const char *node);
/* Netlist of one piece of a transient; on DEA_OK the caller frees *text. */
dea_status dea_mobility_write(const dea_mobility *mobility, const dea_mobility_piece *piece, char **text, dea_error *error);
/* The vectors of its plot, time first. */
dea_mobility_vectors dea_mobility_vectors_of(const dea_mobility *mobility);
/* The states of point @p index from columns in the order of the vectors. */
dea_mobility_state dea_mobility_read(const dea_mobility *mobility, const double *const *columns, size_t index);

/* Small-signal netlist about a bias, over a band; on DEA_OK the caller frees *text. Its vectors are `disp` and, with a series
 * resistance, `film`, else `vsource#branch`; the source has 1 V. */
dea_status dea_mobility_write_small(dea_dynamics *dynamics, const dea_mobility_bias *bias, const dea_mobility_band *band,
                                    char **text, dea_error *error);

#endif
