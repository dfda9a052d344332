/* One run of a moving membrane by ngspice on one mesh: netlists of the pieces of its transient, and what is read between their
 * points. */
#ifndef DEA_NGSPICE_RINGS_TRACK_H
#define DEA_NGSPICE_RINGS_TRACK_H

#include "engine/ngspice/library.h"
#include "engine/ngspice/pieces.h"
#include "engine/rings_flight.h"
#include "netlist/rings_motion.h"
#include "engine/ngspice/deck.h"

/* A mesh with its text, and the room of its runs. */
typedef struct dea_rings_track {
    dea_ngspice *library; /* borrowed, as scene and signal */
    const dea_scene *scene;
    const dea_signal *signal;
    dea_rings_flight flight; /* what it records by; knows no SUNDIALS */
    dea_rings_motion quasi;  /* the same film without what long steps do not resolve: mass and damper */
    dea_pieces pieces;       /* owned */
    char *network;           /* owned: numbers and network */
    size_t states, columns;  /* of a netlist; of its plot, with the time */
    double unit;             /* in which currents of the port are counted [A] */
    double *room;            /* owned: states at points */
} dea_rings_track;

/* Cuts the film of a scene whose numbers are of size 1, and its run; the caller ends it with dea_rings_track_close(), also after a
 * failure. */
dea_status dea_rings_track_open(dea_ngspice *library, const dea_scene *scene, const dea_model *model, const dea_signal *signal,
                                dea_rings_mesh mesh, dea_rings_track *track, dea_error *error);
void dea_rings_track_close(dea_rings_track *track);

/* Runs the pieces with @p fineness times their steps; fills trace and the energies of the summary. A run that ends early is no
 * failure of this call. */
dea_status dea_rings_track_run(dea_rings_track *track, double fineness, dea_rings_trace *trace, dea_summary *summary, dea_error *error);

/* ---- The decks in which the engine runs the cards of the moving membrane: source, start, steps, tolerances. */

/* Numbers and network of a scene whose numbers are of size 1, with currents of the port in that unit; on DEA_OK the caller frees
 * *text. */
dea_status dea_rings_deck_network(const dea_scene *scene, const dea_membrane *membrane, double unit, char **text, dea_error *error);

/* The netlist of one piece around it, whose start is @p states in the order of dea_rings_states(), the charge as the voltage that
 * it makes at rest; on DEA_OK the caller frees *text. */
dea_status dea_rings_deck_write(const char *network, const dea_membrane *membrane, const dea_mobility_piece *piece,
                                const double *states, char **text, dea_error *error);

#endif
