/* A legend, placed entry by entry: gnuplot's own key neither wraps where it should nor leaves the grid below it whole. */
#ifndef DEASPICE_PICTURE_LEGEND_H
#define DEASPICE_PICTURE_LEGEND_H

#include <stdio.h>

enum { DEA_LEGEND_LABEL = 320, DEA_LEGEND_ROW = 21, DEA_LEGEND_ENTRIES = 64 };

/* One entry: a line, a point or both, and what it means. */
typedef struct dea_legend_entry {
    char label[DEA_LEGEND_LABEL];
    char colour[8];
    size_t dash; /* as dea_plot_dash() numbers them, from 1; 0: no line */
    int symbol;  /* point type of gnuplot; 0: no point */
    double x, y; /* left end and middle line on the canvas, in its units, y upward */
} dea_legend_entry;

typedef struct dea_legend {
    dea_legend_entry entries[DEA_LEGEND_ENTRIES];
    size_t count;
} dea_legend;

/* Next entry of the legend, empty; the last one again where there is no room. */
dea_legend_entry *dea_legend_add(dea_legend *legend);
/* Puts the entries into centred rows at the foot of a canvas of that width: in one, or each kind on its own, in several where it
 * must; entries kinds[i] to kinds[i + 1] are of kind i. Returns the height of the rows. */
int dea_legend_lay(dea_legend *legend, const size_t *kinds, size_t kind_count, int width);
/* Draws the entries, if there are any, over a canvas of that size, as the last plot of a multiplot. */
void dea_legend_draw(const dea_legend *legend, FILE *script, int width, int height);

#endif
