/* Built-in materials, each with the source of its numbers. */
#include <math.h>
#include <string.h>

#include "material/law.h"

/* Long-term shear modulus and branches of VHB 4910 [Pa]; g_i = G_i/(G_inf + sum G_i), C1 = G_inf/2. */
#define VHB_LONG_TERM 15.36e3
#define VHB_INSTANTANEOUS (VHB_LONG_TERM + 26.06e3 + 26.53e3 + 10.83e3)

static const dea_material materials[] = {
    {
        .name = "elastosil-2030",
        .source = "fit of the base paper to the manufacturer's data of Elastosil Film 2030",
        .law = &dea_law_yeoh,
        .entry_count = 1,
        .constants = {178426.0, -6023.0, 4234.0},
        .permittivity = 2.8,
        .density = 1080.0,
        .retardation = NAN,
        .modulus = NAN,
        .breakdown = NAN,
    },
    {
        .name = "elastosil-2030-solano",
        .source = "Solano, Zhang, Cattafesta, electroacoustic lumped element model of a DE membrane; permittivity citing Hodgins "
                  "and Seelecke 2016",
        .law = &dea_law_yeoh,
        .entry_count = 1,
        .constants = {180700.0, -16700.0, 6600.0},
        .permittivity = 2.76,
        .permittivity_per_stretch = -0.28,
        .density = 1080.0,
        .retardation = NAN,
        .modulus = NAN,
        .breakdown = NAN,
    },
    {
        .name = "vhb-4910",
        .source = "Wang et al., JMPS 2016: neo-Hookean equilibrium and three branches of VHB 4910",
        .law = &dea_law_yeoh,
        .entry_count = 1,
        .constants = {VHB_LONG_TERM / 2.0},
        .permittivity = 4.8,
        .density = NAN,
        .retardation = NAN,
        .modulus = NAN,
        .breakdown = NAN,
        .prony_count = 3,
        .prony = {{26.06e3 / VHB_INSTANTANEOUS, 0.6074},
                  {26.53e3 / VHB_INSTANTANEOUS, 6.56},
                  {10.83e3 / VHB_INSTANTANEOUS, 61.25}},
    },
};

enum { MATERIAL_COUNT = sizeof materials / sizeof *materials };

dea_material dea_material_default(void)
{
    return (dea_material){
        .law = &dea_law_yeoh,
        .entry_count = 1,
        .constants = {NAN},
        .permittivity = NAN,
        .density = NAN,
        .retardation = NAN,
        .modulus = NAN,
        .breakdown = NAN,
    };
}

size_t dea_material_count(void)
{
    return MATERIAL_COUNT;
}

const dea_material *dea_material_builtin(size_t index)
{
    return index < MATERIAL_COUNT ? &materials[index] : NULL;
}

const dea_material *dea_material_find(const char *name)
{
    for (size_t i = 0; name && i < MATERIAL_COUNT; i++) {
        if (strcmp(materials[i].name, name) == 0) {
            return &materials[i];
        }
    }
    return NULL;
}
