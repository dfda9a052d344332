/* Points of a study on their way into a picture. */
#ifndef DEASPICE_OUTPUT_PICTURE_H
#define DEASPICE_OUTPUT_PICTURE_H

#include "deaspice/plot.h"
#include "output/gnuplot.h"
#include "output/runs.h"

/* Room above the panels, with a title and without. */
enum { DEA_TITLE = 54, DEA_NO_TITLE = 28 };

/* Inside of a panel on the canvas, in units of 1/100 inch from the top left corner. */
typedef struct dea_box {
    double left, top, width, height;
} dea_box;

/* What a picture keeps of a static point. */
typedef struct dea_dot {
    double strain, displacement;
    dea_state state;
} dea_dot;

/* Every stride-th value of an axis and its last one. */
typedef struct dea_thinning {
    size_t count, stride, kept;
} dea_thinning;

struct dea_plot {
    const dea_scene *scene;
    dea_gnuplot picture;
    dea_runs runs; /* of a transient or frequency response; what follows is of a sweep */
    bool map;      /* a map over two axes, else curves */
    size_t x, y;   /* numbers of the axis along x, and of the one along y of a map */
    dea_thinning across, up;
    size_t curves; /* models times values of all other axes; for a map the kept values of y */
    dea_dot *dots; /* curves rows of across.kept dots */
};

/* Index that kept value number @p kept has on its axis. */
size_t dea_thinning_index(const dea_thinning *thinning, size_t kept);
/* Order of the kept values of an axis by size: kept numbers, malloc'd; NULL without memory. */
size_t *dea_plot_order(const dea_axis *axis, const dea_thinning *thinning);
/* Colour number @p number of @p count as "#rrggbb": distinct hues up to eight, a gradient beyond. */
void dea_plot_colour(size_t number, size_t count, char colour[8]);
/* Colours of a map and of many curves, dark to light, 0 <= share <= 1. */
void dea_plot_gradient(double share, char colour[8]);
/* Writes the line style of curves of one kind, from 1; number 1 is solid. */
void dea_plot_dash(FILE *script, size_t number);
/* Lines of a script that every picture begins with: tics, grid, border. */
void dea_plot_style(FILE *script);
/* Begins a multiplot with a title over it, none where it is empty. It is label 2, to be unset behind the first panel. */
void dea_plot_title(FILE *script, const char *title, int height);
/* Puts the next panel into a box of a canvas of that size. */
void dea_plot_place(FILE *script, int width, int height, dea_box box);

/* Write the script of a picture of that kind. */
dea_status dea_plot_draw_curves(dea_plot *plot, dea_error *error);
dea_status dea_plot_draw_map(dea_plot *plot, dea_error *error);
dea_status dea_plot_draw_runs(dea_plot *plot, dea_error *error);

#endif
