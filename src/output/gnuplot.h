/* One picture through gnuplot: the script goes into a private file, gnuplot draws into another, and the picture is then put in
 * place. Text of users enters a script only through dea_gnuplot_text(), which gives gnuplot nothing to interpret. */
#ifndef DEASPICE_OUTPUT_GNUPLOT_H
#define DEASPICE_OUTPUT_GNUPLOT_H

#include "output/atomic.h"

#include <stdio.h>

typedef struct dea_gnuplot {
    FILE *script; /* write the script here, after dea_gnuplot_size() */
    dea_atomic file;
    bool png;
} dea_gnuplot;

/* Checks the ending, that there is a gnuplot, and opens the target. The caller ends it with dea_gnuplot_finish(). */
dea_status dea_gnuplot_begin(dea_gnuplot *picture, const char *path, dea_error *error);
/* First line of every script: the canvas, in units of 1/100 inch. */
void dea_gnuplot_size(dea_gnuplot *picture, int width, int height);
/* Writes @p text as a quoted string of the script; control characters are dropped, long text is cut. */
void dea_gnuplot_text(FILE *script, const char *text);
/* Writes a number, or NaN. */
void dea_gnuplot_number(FILE *script, double value);
/* Runs gnuplot and puts the picture in place when @p keep is true; a zeroed picture is fine. */
dea_status dea_gnuplot_finish(dea_gnuplot *picture, bool keep, dea_error *error);

#endif
