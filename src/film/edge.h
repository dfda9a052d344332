/* Loads of a scene. */
#ifndef DEA_GEOMETRY_EDGE_H
#define DEA_GEOMETRY_EDGE_H

#include <math.h>

#include "deaspice/load.h"

static inline bool dea_load_is_given(const dea_edge_load *load)
{
    return load->kind && !isnan(load->number);
}

#endif
