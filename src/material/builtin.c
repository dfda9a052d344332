/* Built-in materials, each with the source of its numbers. */
#include <math.h>
#include <string.h>

#include "material/law.h"

/* Long-term shear moduli and those of the branches [Pa]; g_i = G_i/(G_inf + sum G_i). */
#define VHB_4910_LONG_TERM 15.36e3
#define VHB_4910_INSTANTANEOUS (VHB_4910_LONG_TERM + 26.06e3 + 26.53e3 + 10.83e3)
#define VHB_4910_BRANCHES                                                                                                        \
    {                                                                                                                            \
        {26.06e3 / VHB_4910_INSTANTANEOUS, 0.6074}, {26.53e3 / VHB_4910_INSTANTANEOUS, 6.56},                                    \
            {10.83e3 / VHB_4910_INSTANTANEOUS, 61.25},                                                                           \
    }
#define VHB_4905_LONG_TERM 13.4e3
#define VHB_4905_INSTANTANEOUS (VHB_4905_LONG_TERM + 31.2e3 + 11.6e3)

/* Nothing is known of damping, of an operating modulus, of a breakdown strength, and of other temperatures. */
#define NOT_GIVEN                                                                                                                \
    .retardation = NAN, .modulus = NAN, .breakdown = NAN, .temperature = NAN, .modulus_slope = NAN, .modulus_reference = NAN,    \
    .shift = {.c1 = NAN, .c2 = NAN, .reference = NAN}

static const dea_material materials[] = {
    {
        .name = "elastosil-2030",
        .source = "fit of the base paper to the manufacturer's data of Elastosil Film 2030",
        .law = &dea_law_yeoh,
        .entry_count = 1,
        .constants = {178426.0, -6023.0, 4234.0},
        .permittivity = 2.8,
        .density = 1080.0,
        NOT_GIVEN,
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
        NOT_GIVEN,
    },
    {
        .name = "vhb-4910",
        .source = "Wang, Decker, Henann, Chester, JMPS 2016, by the input decks of the authors: Arruda-Boyce equilibrium and three "
                  "branches of VHB 4910",
        .law = &dea_law_arruda_boyce,
        .entry_count = 1,
        .constants = {VHB_4910_LONG_TERM, 5.99},
        .permittivity = 4.8,
        .density = NAN,
        NOT_GIVEN,
        .prony_count = 3,
        .prony = VHB_4910_BRANCHES,
    },
    {
        .name = "vhb-4910-neo-hookean",
        .source = "the same with chains that do not stiffen: neo-Hookean equilibrium (C1 = G/2) and three branches of VHB 4910",
        .law = &dea_law_yeoh,
        .entry_count = 1,
        .constants = {VHB_4910_LONG_TERM / 2.0},
        .permittivity = 4.8,
        .density = NAN,
        NOT_GIVEN,
        .prony_count = 3,
        .prony = VHB_4910_BRANCHES,
    },
    {
        .name = "vhb-4905",
        .source = "github.com/miguelmaso/2026-ViscousPolyconvex: neo-Hookean fit to uniaxial data of Hossain et al., Comput. Mater. "
                  "Sci. 59 (2012), up to stretch 3; permittivity of VHB 4910",
        .law = &dea_law_neo_hookean,
        .entry_count = 1,
        .constants = {VHB_4905_LONG_TERM},
        .permittivity = 4.8,
        .density = NAN,
        NOT_GIVEN,
        .stretches = {1.0, 3.0},
        .prony_count = 2,
        .prony = {{31.2e3 / VHB_4905_INSTANTANEOUS, 6.45}, {11.6e3 / VHB_4905_INSTANTANEOUS, 140.0}},
    },
    {
        .name = "sylgard-186",
        .source = "Gent constants and permittivity in use for castable Sylgard 186 films; the range of the data is not known",
        .law = &dea_law_gent,
        .entry_count = 1,
        .constants = {0.59e6, 30.04},
        .permittivity = 2.8,
        .density = NAN,
        NOT_GIVEN,
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
        NOT_GIVEN,
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
