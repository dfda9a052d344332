/* What two runs of a membrane differ by. */
#ifndef DEA_RINGS_GAP_H
#define DEA_RINGS_GAP_H

#include "engine/rings_flight.h"
#include "result/scales.h"

typedef struct dea_rings_gap {
    double answer;         /* of the column that is worst against what it promises, times its allowance [1] */
    double displacement;   /* of displacement and its means, over their peaks [1] */
    dea_rate_errors rates; /* of velocity and current */
} dea_rings_gap;

/* Over the samples that both have; the scales are those of @p b. */
dea_rings_gap dea_rings_gap_of(const dea_scene *scene, const dea_scales *scales, const dea_rings_trace *a, const dea_rings_trace *b);

/* The columns that are compared, and a number of a sample: NULL past the end. */
const size_t *dea_rings_column(size_t index);
static inline double *dea_rings_at(dea_sample *sample, size_t offset)
{
    return (double *)((char *)sample + offset);
}

/* Mean of the displacement over a window [m]. */
double dea_rings_mean(const dea_scene *scene, const dea_rings_trace *trace, size_t window);

#endif
