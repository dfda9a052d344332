/* The rows of the law table, one file each. */
#ifndef DEA_LAW_H
#define DEA_LAW_H

#include "deaspice/material.h"

extern const dea_law dea_law_yeoh;
extern const dea_law dea_law_neo_hookean;
extern const dea_law dea_law_mooney_rivlin;
extern const dea_law dea_law_gent;
extern const dea_law dea_law_ogden;
extern const dea_law dea_law_arruda_boyce;

#endif
