/* The decks in which the engine runs the cards of the moving network: numbers in its units, source, steps, tolerances. */
#ifndef DEA_NGSPICE_DECK_H
#define DEA_NGSPICE_DECK_H

#include "drive/signal.h"
#include "engine/ngspice/library.h"
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
    double mass;        /* [kg]; of a membrane those of its nodes over their own [1] */
    double conductance; /* 0: none; resistor beside the mass that fits the rule's damping to the film's [N s/m], of a membrane over it [1/s] */
    dea_mobility_state start;
    double most;  /* points of the library that it may take; 0: no limit */
    double taken; /* computed by dea_deck_run(): points of the library, those of steps that collapsed too */
} dea_mobility_piece;

/* Parts of an edge that is shorter than a time step. */
double dea_deck_parts(double fineness);

/* Writes the netlist of a piece; on DEA_OK *text is for free(). */
typedef dea_status dea_deck_writer(const void *user, const dea_mobility_piece *piece, char **text, dea_error *error);
/* Runs a piece and reads the vectors of its plot, again and again with larger absolute tolerances, piece->loose, where the library's
 * steps collapse. The caller frees the table, also after a failure. */
dea_status dea_deck_run(dea_ngspice *library, dea_mobility_piece *piece, dea_deck_writer *write, const void *user,
                        const char *const *names, size_t count, dea_ngspice_table *table, dea_error *error);

/* Most vectors of a run: time, displacement, velocity, charge, branches. */
enum { DEA_MOBILITY_VECTORS = 4 + DEA_RELAXED_MAX, DEA_MOBILITY_NAME = 40 };

typedef struct dea_mobility_vectors {
    char names[DEA_MOBILITY_VECTORS][DEA_MOBILITY_NAME];
    size_t count;
} dea_mobility_vectors;

/* Times since the begin of the piece and voltages there, between which the source follows lines. */
void dea_deck_corners(FILE *out, const dea_mobility_piece *piece);
/* The voltage of the source from the begin of the piece on: its segments as breakpoints, or a sine. */
void dea_deck_source(FILE *out, const dea_mobility_piece *piece, const char *node);
/* Netlist of one piece of a transient; on DEA_OK the caller frees *text. */
dea_status dea_mobility_write(const dea_mobility *mobility, const dea_mobility_piece *piece, char **text, dea_error *error);
/* The vectors of its plot, time first. */
dea_mobility_vectors dea_mobility_vectors_of(const dea_mobility *mobility);
/* The states of point @p index from columns in the order of the vectors. */
dea_mobility_state dea_mobility_read(const dea_mobility *mobility, const double *const *columns, size_t index);

#endif
