#include <math.h>

#include "deaspice/load.h"

/* In the order in which messages list them. */
static const dea_load_kind kinds[] = {
    {.name = "mass",
     .unit = "kg",
     .suffix = "_kg",
     .low = 0.0,
     .high = INFINITY,
     .accepted = "a mass > 0, e.g. 2 g",
     .time = 2,
     .adds = {.mass = 1.0}},
    {.name = "stiffness",
     .unit = "N/m",
     .suffix = "_N_per_m",
     .low = 0.0,
     .high = INFINITY,
     .accepted = "a stiffness > 0, e.g. 20 N/m",
     .element = "n_load",
     .meaning = "compliance of the load between edge and frame [m/N]",
     .adds = {.stiffness = 1.0}},
    {.name = "damping",
     .unit = "N s/m",
     .suffix = "_N_s_per_m",
     .low = 0.0,
     .high = 1e20, /* its inverse is a resistor of netlists */
     .accepted = "a mechanical resistance > 0 and < 1e20 N s/m, e.g. 1e-3 N s/m",
     .time = 1,
     .adds = {.damping = 1.0}},
    {.name = "force",
     .unit = "N",
     .suffix = "_N",
     .low = -INFINITY,
     .high = INFINITY,
     .accepted = "a force, outward positive, e.g. 50 mN",
     .element = "f_load",
     .meaning = "force of the load onto the edge, outward [N]",
     .length = 1,
     .adds = {.force = 1.0}},
};

size_t dea_load_count(void)
{
    return sizeof kinds / sizeof *kinds;
}

const dea_load_kind *dea_load_at(size_t index)
{
    return index < dea_load_count() ? &kinds[index] : NULL;
}
