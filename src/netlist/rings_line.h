/* The exact membrane at rest over a line of points as one subcircuit, `.subckt line<n> k edge`: v(k) is the index of the point,
 * v(edge) the displacement of the edge [m]. The engine `ngspice` runs the very text that exports hold. */
#ifndef DEA_RINGS_LINE_H
#define DEA_RINGS_LINE_H

#include "deaspice/scene.h"
#include "netlist/rings_cards.h"

typedef struct dea_rings_line {
    const dea_scene *scene; /* axes at the first point; of one model */
    const dea_axis *axis;   /* the swept scalar, NULL: one point */
    size_t from, to;        /* points of the axis, `to` excluded: the index is held inside them */
    dea_rings_mesh mesh;
    double error;  /* expected of the edge, relative [1] */
    size_t number; /* in the name of the subcircuit */
} dea_rings_line;

/* Writes the subcircuit, its instance `xline<n> k edge<n> line<n>` and where Newton starts; one card a line.
 * DEA_ERROR_MEMORY. */
dea_status dea_rings_line_write(const dea_rings_line *line, const dea_dialect *dialect, FILE *out, dea_error *error);

/* Sets mesh and error of a line: the mesh of that of some of its points which wants the most nodes; a coarse one where none of
 * them has an equilibrium. */
void dea_rings_line_choose(dea_rings_line *line);

#endif
