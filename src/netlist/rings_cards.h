/* The film of rings (physics: section 7) as cards: the one text that exports, parts and the engine `ngspice` share.
 *
 * Node n moves by the displacement v(u<n>). A ring q has the relative stretches e_1 = v(a<q>), e_2 = v(b<q>) and, of its thickness,
 * e_3 = v(w<q>), the first two linear in the displacements by slopes that depend on the degrees of the mesh alone and by the ring's `radial` and `hoop`; its two stresses
 * v(s<q>) and v(t<q>) [MPa], changes from rest, act back on the nodes by the same slopes and its levers `along` and `across`. All
 * nodes are 0 at rest.
 *
 *   e_1 = radial sum slopes_n u_n,   e_2 = hoop u_q,   forces: slopes_n along s_1 + across s_2
 *   s_a = lambda_pre P_a - its value at rest - lambda_pre^4 M (1 + e_1)^2 (1 + e_2)^2/(1 + e_a),   M = eps (U/H)^2 where electroded
 */
#ifndef DEA_RINGS_CARDS_H
#define DEA_RINGS_CARDS_H

#include "netlist/rings_film.h"

/* Builds the expressions of a mesh in the pool of the symbols. Displacements are in units of r, forces in units of
 * 2 pi H F^2/r times 1 MPa, F = r/lambda_pre, so that only coverage, pre-stretch, law and M enter. Memory that ran out is told by
 * the pool. */
void dea_rings_cards_make(const dea_symbols *symbols, dea_rings_mesh mesh, dea_rings_cards *cards);

/* Changes of the Cauchy stresses from rest of a kind of ring, by all three strains: simulators differentiate products sooner than
 * quotients. */
void dea_rings_cauchy(const dea_symbols *symbols, dea_rings_strain strain, dea_expr stress[2]);

/* Keeps nodes for the terms that are worth one in a ring; before any is declared. */
void dea_rings_cards_share(dea_part_text *text);
/* Declares all that will be written; then, in this order: cards of the parameters by dea_part_text_parameters(), and the rest. */
void dea_rings_cards_declare(const dea_rings_cards *cards, dea_part_text *text);
/* Strains, stresses and balance of forces in displacement form. */
void dea_rings_cards_write(const dea_rings_cards *cards, dea_part_text *text);

#endif
