/* The moving membrane of a scene as cards: what the engine `ngspice` runs and what is exported is this one text. It names its
 * numbers, which stand in `.param` cards before it, so that it is the same in all units and from every start; sources, steps,
 * tolerances and what is read off are the deck around it. The units of the mechanics are those of the scene, those of the port
 * may be others: its elements know no force. */
#ifndef DEA_RINGS_MOTION_H
#define DEA_RINGS_MOTION_H

#include "netlist/mobility.h"
#include "netlist/rings_moving.h"
#include "network/membrane.h"

typedef struct dea_rings_motion_cards {
    const dea_membrane *membrane; /* borrowed */
    dea_pool pool;                /* owned */
    dea_symbols symbols;
    dea_rings_quantities quantities;
    dea_rings_moving moving;
    dea_expr per_r, newton;
    dea_expr springs; /* what they hold at the edge, of node DEA_RINGS_E1 as its displacement */
    dea_part_text text; /* owned */
    double *values;     /* owned: of all terms at rest */
    const char *names[DEA_RINGS_SYMBOLS];
} dea_rings_motion_cards;

/* Numbers of the port, in units of its own. */
typedef struct dea_rings_port {
    double series, leak; /* resistances [Ohm]; used where the membrane has them */
    double rest;         /* capacitance at rest, in series with a charge that counts in volts [F] */
} dea_rings_port;

/* Starts a text of the membrane that was opened on the scene; DEA_ERROR_MEMORY. The caller ends it with
 * dea_rings_motion_cards_close() in either case. */
dea_status dea_rings_motion_cards_open(const dea_scene *scene, const dea_membrane *membrane, const dea_cards_form *form, FILE *out,
                                       dea_rings_motion_cards *cards, dea_error *error);
void dea_rings_motion_cards_close(dea_rings_motion_cards *cards);
/* The numbers, then the network between DEA_CARDS_BEGIN and DEA_CARDS_END. */
void dea_rings_motion_cards_write_numbers(dea_rings_motion_cards *cards, const dea_rings_port *port);
void dea_rings_motion_cards_write_network(dea_rings_motion_cards *cards);
/* What the swell of a film without a series resistance is read off: node `swell`. */
void dea_rings_motion_cards_write_swell(dea_rings_motion_cards *cards);

/* The states of a membrane, in the order u, v where there is mass, z, charge over the capacitance at rest where there is a series
 * resistance; each has a node of that name. */
size_t dea_rings_states(const dea_membrane *membrane);
dea_rings_label dea_rings_state_node(const dea_membrane *membrane, size_t index);
/* The capacitor that holds it, of a film whose displacements are states: not those of one without mass and damper. */
dea_rings_label dea_rings_state_element(const dea_membrane *membrane, size_t index);

#endif
