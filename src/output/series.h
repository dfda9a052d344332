/* The curves of a picture: a group for each combination of values of the axes that do not lie along x, and in it a curve for each
 * model. Colour tells the group, dash the model. */
#ifndef DEASPICE_OUTPUT_SERIES_H
#define DEASPICE_OUTPUT_SERIES_H

#include "deaspice/result.h"
#include "deaspice/scene.h"
#include "output/legend.h"

enum { DEA_MARKS = 3, DEA_CURVES_MAX = 24 };

/* A mark on a curve: a limit that a point is past. */
typedef struct dea_mark {
    dea_state state;
    int symbol, inside; /* point types of gnuplot: the outline, and its inside in white below it */
    const char *legend;
} dea_mark;

extern const dea_mark dea_marks[DEA_MARKS];

typedef struct dea_series {
    const dea_scene *scene;
    size_t along;  /* number of the axis along x, SIZE_MAX: none */
    size_t groups; /* curves of one model */
} dea_series;

/* Colour of a curve as "#rrggbb". */
void dea_series_colour(const dea_series *series, size_t model, size_t group, char colour[8]);
/* Legend of groups, models and the marks that were seen, in centred rows on a canvas of that width; its height. */
int dea_series_legend(const dea_series *series, const bool seen[DEA_MARKS], int width, dea_legend *legend);

#endif
