/* A legend, placed entry by entry: gnuplot's own key neither wraps where it should nor leaves the grid below it whole. */
#ifndef DEASPICE_OUTPUT_LEGEND_H
#define DEASPICE_OUTPUT_LEGEND_H

#include <stdio.h>

enum { DEA_LEGEND_LABEL = 320, DEA_LEGEND_ROW = 21, DEA_LEGEND_ENTRIES = 64 };

/* One entry: a line, a point or both, and what it means. */
typedef struct dea_legend_entry {
    char label[DEA_LEGEND_LABEL];
    char colour[8];
    size_t dash; /* as dea_plot_dash() numbers them, from 1; 0: no line */
    int symbol;  /* point type of gnuplot; 0: no point */
    double x, y; /* left end and middle line on the canvas, in units of 1/100 inch, y upward */
} dea_legend_entry;

typedef struct dea_legend {
    dea_legend_entry entries[DEA_LEGEND_ENTRIES];
    size_t count;
} dea_legend;

/* Next entry of the legend, empty; the last one again where there is no room. */
dea_legend_entry *dea_legend_add(dea_legend *legend);
/* Room that an entry takes along x, with the gap behind it. */
double dea_legend_room(const dea_legend_entry *entry);
/* Draws the entries over a canvas of that size, as the last plot of a multiplot. */
void dea_legend_draw(const dea_legend *legend, FILE *script, int width, int height);

#endif
