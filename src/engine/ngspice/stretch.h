/* A line of points by sweeps of circuits: as long as answers pass, one circuit after the other; what does not pass alone. */
#ifndef DEA_NGSPICE_STRETCH_H
#define DEA_NGSPICE_STRETCH_H

#include "deaspice/status.h"

#include <stdbool.h>
#include <stddef.h>

/* The points of a line and what is done with them. */
typedef struct dea_stretch {
    void *user;
    size_t count;   /* points */
    size_t longest; /* most of them in one sweep */
    /* The point has load and an equilibrium, so that a sweep can start there. */
    bool (*can_start)(void *user, size_t i);
    /* Sweeps count points from number @p from on and takes its answers up to the first that does not pass; *good: how many. */
    dea_status (*sweep)(void *user, size_t from, size_t count, size_t *good, dea_error *error);
    /* Fills the row of one point alone, whatever its state. */
    dea_status (*alone)(void *user, size_t i, dea_error *error);
} dea_stretch;

/* The whole line. Where a sweep breaks off, or leaves the branch that is connected to rest, the point is solved alone and a new
 * sweep starts behind it: a short one, in case of more such points, then longer ones again. */
dea_status dea_stretch_solve(const dea_stretch *stretch, dea_error *error);

#endif
