/* Writes the network of a line of points as a netlist that one DC sweep solves. */
#ifndef DEA_NETLIST_H
#define DEA_NETLIST_H

#include "deaspice/scene.h"
#include "network/network.h"

/* How the netlist is driven. */
typedef struct dea_netlist_study {
    const dea_axis *axis; /* the swept scalar, symbol 0 of the network; NULL: one point */
    size_t from, count;   /* part of the axis */
    size_t ramp;          /* > 0: one point whose load grows from 0 to all of it in so many steps; axis is NULL then */
    double tolerance;     /* relative, of every node [1] */
    double force_scale;   /* size of a force, for the current tolerance [N] */
    double length_scale;  /* size of a displacement, for the voltage tolerance [m] */
} dea_netlist_study;

/* Most values of an axis that is not uniform in one netlist. */
enum { DEA_NETLIST_LIST = 64 };

/* Writes the netlist; on DEA_OK the caller frees *text. One card a line, from the title to `.end`. */
dea_status dea_netlist_write(dea_network *network, const dea_netlist_study *study, char **text, dea_error *error);

#endif
