/* What a temperature makes of a material: its relaxation times by a shift factor a_T, all alike (a thermorheologically simple film),
 * its moduli by a slope. A temperature that is not given is that of the data. */
#include <math.h>

#include "deaspice/material.h"

/* Evenly in ln a_T between two rows of the table; NAN outside of it. */
static double table_shift(const dea_shift *shift, double temperature)
{
    for (size_t i = 1; i < shift->count; i++) {
        const double *low = shift->table[i - 1], *high = shift->table[i];
        if (temperature >= low[0] && temperature <= high[0]) {
            const double along = (temperature - low[0]) / (high[0] - low[0]);
            return low[1] * pow(high[1] / low[1], along);
        }
    }
    return (double)NAN;
}

/* Williams, Landel, Ferry: log10 a_T = -C1 (T - T_r)/(C2 + T - T_r); NAN at and below its pole. */
static double wlf_shift(const dea_shift *shift, double temperature)
{
    const double above = temperature - shift->reference, room = shift->c2 + above;
    return room > 0.0 ? pow(10.0, -shift->c1 * above / room) : (double)NAN;
}

double dea_material_shift(const dea_material *material)
{
    const dea_shift *shift = &material->shift;
    if (isnan(material->temperature) || (isnan(shift->c1) && shift->count == 0)) {
        return 1.0;
    }
    return shift->count > 0 ? table_shift(shift, material->temperature) : wlf_shift(shift, material->temperature);
}

double dea_material_stiffening(const dea_material *material)
{
    const double above = material->temperature - material->modulus_reference;
    return isnan(material->temperature) || isnan(material->modulus_slope) ? 1.0 : 1.0 + material->modulus_slope * above;
}

dea_prony dea_material_branch(const dea_material *material, size_t index)
{
    const dea_prony *branch = &material->prony[index];
    return (dea_prony){branch->g, branch->tau * dea_material_shift(material)};
}
