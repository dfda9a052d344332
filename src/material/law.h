/* The rows of the law table, one file each. */
#ifndef DEA_LAW_H
#define DEA_LAW_H

#include "deaspice/material.h"

extern const dea_law dea_law_yeoh;
extern const dea_law dea_law_neo_hookean;

#endif
