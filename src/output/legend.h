/* Entries of a legend, placed one by one: gnuplot's own key neither wraps where it should nor leaves the grid below it whole. */
#ifndef DEASPICE_OUTPUT_LEGEND_H
#define DEASPICE_OUTPUT_LEGEND_H

#include <stdio.h>

enum { DEA_LEGEND_LABEL = 320, DEA_LEGEND_ROW = 21 };

/* One entry: a line, a point or both, and what it means. */
typedef struct dea_legend_entry {
    char label[DEA_LEGEND_LABEL];
    char colour[8];
    size_t dash; /* as dea_plot_dash() numbers them, from 1; 0: no line */
    int symbol;  /* point type of gnuplot; 0: no point */
} dea_legend_entry;

/* Where entries go: a canvas in units of 1/100 inch, y upward. */
typedef struct dea_legend {
    FILE *script;
    double width, height;
    int next; /* tag of the next entry */
} dea_legend;

/* Room that an entry takes along x, with the gap behind it. */
double dea_legend_room(const dea_legend_entry *entry);
/* Puts one entry with its left end and its middle line at x, y; it shows in every following plot command until
 * dea_legend_clear(). */
void dea_legend_put(dea_legend *legend, const dea_legend_entry *entry, double x, double y);
/* Takes all entries away again. */
void dea_legend_clear(dea_legend *legend);

#endif
