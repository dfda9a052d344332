/* One picture through gnuplot: the script goes into a private file, gnuplot draws into another, and the picture is then put in
 * place; or the script itself is. Text of users enters a script only as %q of dea_gnuplot_put(), which gives gnuplot nothing to
 * interpret. */
#ifndef DEASPICE_PICTURE_GNUPLOT_H
#define DEASPICE_PICTURE_GNUPLOT_H

#include "deaspice/plot.h"
#include "support/atomic.h"

#include <stdio.h>

/* Unit of a canvas: a pixel of a screen, 1/96 inch, where no size is wanted. With one, letters of 12 units are 7 points high on
 * up to 18 cm, and grow with the width from there. */
typedef struct dea_canvas {
    int width;   /* [units] */
    int height;  /* [units], 0: as high as the panels ask for */
    double unit; /* [inch] */
} dea_canvas;

/* Inside of a panel on the canvas, in its units from the top left corner. */
typedef struct dea_box {
    double left, top, width, height;
} dea_box;

/* A kind of picture, by its ending. */
typedef struct dea_picture_kind dea_picture_kind;

typedef struct dea_gnuplot {
    FILE *script; /* write the script here, after dea_gnuplot_size() */
    dea_atomic file;
    const dea_picture_kind *kind;
    dea_canvas canvas; /* that a picture may fill */
    bool log_x, log_y;
} dea_gnuplot;

/* Checks the ending and the options (NULL: none), that there is a gnuplot, and opens the target. The caller ends it with
 * dea_gnuplot_finish(). */
dea_status dea_gnuplot_begin(dea_gnuplot *picture, const char *path, const dea_plot_options *options, dea_error *error);
/* First lines of every script: the canvas, of its width and a height that is now known [units]; the script then has `ps`, the size
 * of points at this scale. */
void dea_gnuplot_size(dea_gnuplot *picture, int height);
/* Writes a piece of a script: %g stands for a number, or NaN, whatever the locale; %q for a text as a quoted string, in which control
 * characters are dropped and long text is cut; %s for a text as it is, %d for an int, %z for a size_t, %% for itself. */
void dea_gnuplot_put(FILE *script, const char *format, ...);
/* Ends the script, draws, and puts the picture in place when @p keep is true; a zeroed picture is fine. */
dea_status dea_gnuplot_finish(dea_gnuplot *picture, bool keep, dea_error *error);

#endif
