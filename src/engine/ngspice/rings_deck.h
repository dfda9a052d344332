/* The decks in which the engine runs the cards of the moving membrane: source, start, steps, tolerances. */
#ifndef DEA_NGSPICE_RINGS_DECK_H
#define DEA_NGSPICE_RINGS_DECK_H

#include "engine/ngspice/deck.h"
#include "netlist/rings_motion.h"

/* Numbers and network of a scene whose numbers are of size 1, with currents of the port in that unit; on DEA_OK the caller frees
 * *text. */
dea_status dea_rings_deck_network(const dea_scene *scene, const dea_membrane *membrane, double unit, char **text, dea_error *error);

/* The netlist of one piece around it, whose start is @p states in the order of dea_rings_states(), the charge as the voltage that
 * it makes at rest; on DEA_OK the caller frees *text. */
dea_status dea_rings_deck_write(const char *network, const dea_membrane *membrane, const dea_mobility_piece *piece,
                                const double *states, char **text, dea_error *error);

#endif
