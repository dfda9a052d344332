/* Pieces of text that all cards of rings are made of: levers between the nodes and what stands at a ring, sources of its terms. */
#ifndef DEA_RINGS_TEXT_H
#define DEA_RINGS_TEXT_H

#include "netlist/rings_film.h"

/* A text of rings on its way out. */
typedef struct dea_rings_writer {
    const dea_rings_cards *cards;
    dea_part_text *text;
    FILE *out;
    bool pinned; /* the node at r_a is called `edge` (velocity) and `u` (displacement) */
} dea_rings_writer;

/* Name of a node, an element or a parameter. */
typedef struct dea_rings_label {
    char text[2 * DEA_PART_NAME];
} dea_rings_label;

dea_rings_label dea_rings_label_of(const char *name, size_t number);
/* Node number @p node of displacement, 'u', or of velocity, 'v'. */
dea_rings_label dea_rings_node(const dea_rings_writer *w, char kind, size_t node);
/* A declared term as text of a card. */
dea_rings_label dea_rings_parameter(const dea_rings_writer *w, dea_expr ref);

/* What stands for the nodes of the pool at a ring, and the ending of the nodes of its shared terms, with a mark of what is written; up to
 * dea_rings_leave(). */
typedef struct dea_rings_place {
    const char *const *nodes;
    char suffix[DEA_PART_NAME];
} dea_rings_place;
void dea_rings_enter(const dea_rings_writer *w, dea_rings_place *place, size_t number, const char *mark);
void dea_rings_leave(const dea_rings_writer *w);

/* v(node) = an expression between these, or one term with the nodes of its shared terms before it. */
void dea_rings_begin(const dea_rings_writer *w, const char *node);
void dea_rings_end(const dea_rings_writer *w);
void dea_rings_source(const dea_rings_writer *w, const char *node, dea_expr ref);
/* A transconductance {slope factor} from node @p control; factor NULL: {slope}; the element is called G and @p element. */
void dea_rings_lever(const dea_rings_writer *w, const char *element, const char *from, const char *to, const char *control,
                     double slope, const char *factor);
/* A conductance of 1 that makes a node the sum of the currents into it. */
void dea_rings_sum(const dea_rings_writer *w, const char *node);
/* v(into) = factor times the slopes' sum of the nodes of a kind. */
void dea_rings_gradient(const dea_rings_writer *w, const dea_rings_ring *ring, const char *into, char kind, const char *factor);
/* Currents factor slope_n v(control) out of the nodes of a kind. */
void dea_rings_spread(const dea_rings_writer *w, const dea_rings_ring *ring, const char *control, char kind, const char *factor);

/* A current out of node @p from, of the displacement at node @p u, which the pool has as DEA_RINGS_E1. */
void dea_rings_spring(const dea_rings_writer *w, const char *from, const char *u, dea_expr ref);

/* v(w<q>) = e_3 of a ring: (1 + e_1)(1 + e_2)(1 + e_3) = 1. */
void dea_rings_thickness(const dea_rings_writer *w, dea_rings_strain strain, size_t number);

/* Names a term and a number, and declares it. */
void dea_rings_name(dea_part_text *text, dea_expr ref, const char *what, size_t number);

/* Numbers of a scene that stay symbols in a text: parameters of that name. */
enum { DEA_RINGS_SYMBOLS = 16 + DEA_LOADS + 2 * DEA_LAW_CONSTANTS };
typedef struct dea_rings_quantities {
    size_t count; /* number 0 is the axis */
    char names[DEA_RINGS_SYMBOLS][DEA_PART_NAME];
    const char *units[DEA_RINGS_SYMBOLS];
    double values[DEA_RINGS_SYMBOLS];
} dea_rings_quantities;

/* Symbols of a scene whose numbers, but for what moves with the axis (may be NULL), are names. */
void dea_rings_quantities_of(const dea_scene *scene, const dea_axis *axis, dea_pool *pool, dea_symbols *symbols,
                             dea_rings_quantities *quantities);
/* A number becomes one more of them. */
void dea_rings_quantity(dea_rings_quantities *quantities, dea_pool *pool, const char *name, const char *unit, dea_expr *ref);
/* Comment and .param card of each. */
void dea_rings_quantities_write(const dea_rings_quantities *quantities, FILE *out);

#endif
