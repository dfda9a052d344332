/* The membrane as a part: a fixed mesh of rings between the pins p, n (film) and edge (velocity of r_a), mobility analogy. Its text
 * refers to parameters that the part's checks have made: `many`, `ok`, `damp`, `inertia` and, of branch i, `share<i>`, `c_relax<i>`.
 * Stresses are in MPa, displacements in um, velocities in m/s. */
#ifndef DEA_RINGS_PART_H
#define DEA_RINGS_PART_H

#include "netlist/rings_moving.h"

typedef struct dea_rings_part {
    dea_rings_moving moving;
    dea_expr frame_radius; /* [m] */
    dea_expr field, force; /* per volt [V/um] and per square volt [N], of the electroded ring at r_a */
} dea_rings_part;

/* Builds the expressions in the pool of the symbols, whose moduli are in MPa. */
void dea_rings_part_make(const dea_symbols *symbols, const dea_rings_numbers *numbers, size_t branches, dea_rings_part *part);
void dea_rings_part_declare(const dea_rings_part *part, dea_part_text *text);
/* The mechanics, up to node `swell`: (C/C_rest) - 1, and the outputs force, field and tension; tension [MPa] is the least of the
 * stresses on both sides of r_a and at the frame. */
void dea_rings_part_write(const dea_rings_part *part, dea_part_text *text);

#endif
