/* What follows from a material's numbers alone. */
#include "deaspice/material.h"

double dea_material_long_term_share(const dea_material *material)
{
    double share = 1.0;
    if (material->instantaneous) {
        for (size_t i = 0; i < material->prony_count; i++) {
            share -= material->prony[i].g;
        }
    }
    return share;
}

void dea_material_long_term(const dea_material *material, double yeoh[DEA_YEOH_TERMS])
{
    const double share = dea_material_long_term_share(material);
    for (int i = 0; i < DEA_YEOH_TERMS; i++) {
        yeoh[i] = share * material->yeoh[i];
    }
}

double dea_material_permittivity(const dea_material *material, double stretch)
{
    return material->permittivity + material->permittivity_per_stretch * stretch;
}
