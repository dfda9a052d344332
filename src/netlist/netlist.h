/* The network of a line of points in displacement form, v(edge) = displacement, current = force, as cards: what the engine
 * `ngspice` sweeps and what is exported is this one text. */
#ifndef DEA_NETLIST_H
#define DEA_NETLIST_H

#include "netlist/part_text.h"
#include "network/network.h"

/* What the points of a line have in common. */
typedef struct dea_still_line {
    const dea_scene *scene; /* axes at the first point */
    const dea_model *model;
    const dea_axis *axis; /* the swept scalar, NULL: one point */
    double first;         /* its first value */
} dea_still_line;

/* A text on its way out. */
typedef struct dea_still_cards {
    dea_network network;       /* owned; the axis is its symbol 0 */
    dea_quantities quantities; /* its other symbols */
    const char *symbols[DEA_QUANTITIES + 1];
    dea_expr elastic, load;
    dea_part_text text; /* owned */
    double *values;     /* owned: of all terms where the line begins, at rest */
} dea_still_cards;

/* Starts the text of a line; @p numbers: parameters as numbers, else as formulas of those of the scene. The caller ends it with
 * dea_still_cards_close(), also after a failure: DEA_ERROR_MEMORY, DEA_ERROR_UNSUPPORTED for a model that is no network. */
dea_status dea_still_cards_open(const dea_still_line *line, bool numbers, const dea_dialect *dialect, FILE *out,
                                dea_still_cards *cards, dea_error *error);
void dea_still_cards_close(dea_still_cards *cards);
/* The numbers, then the network between DEA_CARDS_BEGIN and DEA_CARDS_END; the axis is v(axis). @p ramp > 0: the load grows with
 * v(k)/ramp. */
void dea_still_cards_write_numbers(dea_still_cards *cards);
void dea_still_cards_write_network(dea_still_cards *cards, size_t ramp);
/* ` v(name)=value` of its nodes at a place; @p inside stands before the names. */
void dea_still_cards_write_start(dea_still_cards *cards, const char *inside, double symbol, double u);

/* True where points `from` to `to`, excluded, are a part of an even axis, in which v(point) holds the index. */
bool dea_axis_holds(const dea_axis *axis, size_t from, size_t to);
/* Those points as the voltage v(axis) of the index v(k), so that no rounding adds up along a sweep. */
void dea_axis_write(const dea_part_text *text, const dea_axis *axis, size_t from, size_t to);

/* How the netlist is driven. */
typedef struct dea_netlist_study {
    const dea_scene *scene; /* axes at the first point */
    const dea_model *model;
    const dea_axis *axis; /* the swept scalar; NULL: one point */
    size_t from, count;   /* part of the axis */
    const dea_force_study *held; /* the edge is held at count displacements, BHOLD by name; NULL: it is free */
    size_t ramp;          /* > 0: one point whose load grows from 0 to all of it in so many steps; axis is NULL then */
    double tolerance;     /* relative, of every node [1] */
    double force_scale;   /* size of a force, for the current tolerance [N] */
    double length_scale;  /* size of a displacement, for the voltage tolerance [m] */
} dea_netlist_study;

/* Most values of an axis that is not uniform in one netlist. */
enum { DEA_NETLIST_LIST = 64 };

/* Writes the netlist that the engine runs; on DEA_OK the caller frees *text. One card a line, from the title to `.end`. */
dea_status dea_netlist_write(const dea_netlist_study *study, char **text, dea_error *error);

#endif
