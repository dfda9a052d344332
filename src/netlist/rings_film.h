/* The film of rings as expressions: what its cards are written from. */
#ifndef DEA_RINGS_FILM_H
#define DEA_RINGS_FILM_H

#include "netlist/part_text.h"
#include "network/network.h"
#include "network/rings.h"

/* Nodes of the pool of the symbols: what the expressions of a ring depend on; e_3 = 1/((1 + e_1)(1 + e_2)) - 1. */
enum { DEA_RINGS_E1, DEA_RINGS_E2, DEA_RINGS_E3, DEA_RINGS_VARIABLES };

/* Rings whose stretches differ in kind: both free; at the frame, e_2 = 0; a disc of degree 1, e_1 = e_2. */
typedef enum dea_rings_strain { DEA_RINGS_FREE, DEA_RINGS_FRAME, DEA_RINGS_UNIFORM, DEA_RINGS_STRAINS } dea_rings_strain;

/* One ring of the mesh. */
typedef struct dea_rings_ring {
    bool disc, electroded;
    dea_rings_strain strain;
    size_t place, first, node;     /* its place in the element; number of the element's first node, and of its own; 0: the centre */
    dea_expr radial, hoop;         /* strains over displacements */
    dea_expr along, across;        /* forces over stresses */
} dea_rings_ring;

typedef struct dea_rings_cards {
    dea_symbols symbols;
    dea_rings_mesh mesh;
    dea_rings_slopes slopes[2]; /* of disc and annulus */
    size_t node_count, edge;    /* moving nodes, 1 ... node_count from the centre out, and which is that at r_a */
    size_t ring_count;
    dea_rings_ring rings[DEA_RINGS_MOST];
    dea_expr stress[DEA_RINGS_STRAINS][2][2]; /* s_1 and s_2 [MPa] of a kind of ring, bare and electroded */
    dea_expr load;                            /* springs between edge and frame less the force outward, of node DEA_RINGS_E1 as u/r */
} dea_rings_cards;

#endif
