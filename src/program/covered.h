/* Whether a run stretches its film beyond what the data of its material cover. */
#ifndef DEA_PROGRAM_COVERED_H
#define DEA_PROGRAM_COVERED_H

#include "deaspice/result.h"
#include "deaspice/scene.h"

/* The least and the largest stretch so far; zeroed: none. */
typedef struct dea_covered {
    double least, most;       /* [1] */
    size_t outside, at_worst; /* points outside of the data, and the one that is furthest */
    double worst;             /* how far that is [1] */
} dea_covered;

/* Takes point number @p number of the study; nothing where the material has no range. */
void dea_covered_take(dea_covered *covered, const dea_scene *scene, const dea_layout *layout, size_t number, const void *point);
/* One line on standard error where a point lies outside. */
void dea_covered_warn(const dea_covered *covered, const dea_scene *scene);

#endif
