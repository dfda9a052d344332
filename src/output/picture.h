/* Points of a study on their way into a picture. */
#ifndef DEASPICE_OUTPUT_PICTURE_H
#define DEASPICE_OUTPUT_PICTURE_H

#include "deaspice/plot.h"
#include "output/gnuplot.h"
#include "output/label.h"
#include "output/runs.h"

/* Room above the panels, with a title and without. */
enum { DEA_TITLE = 54, DEA_NO_TITLE = 28 };

/* Numbers along an axis, as drawn. Empty: low above high. */
typedef struct dea_span {
    double low, high;
    bool logarithmic; /* numbers at or below zero do not count */
} dea_span;

/* Text of a tic. */
typedef void dea_name(double value, char text[DEA_LABEL_LENGTH]);

/* The two panels of a picture, (a) and (b): side by side, or one above the other where that leaves them more room. */
typedef struct dea_pair {
    dea_box boxes[2];
    int height; /* of the picture */
} dea_pair;

/* What a picture keeps of a static point. */
typedef struct dea_dot {
    double strain, displacement;
    dea_state state;
} dea_dot;

/* Every stride-th value of an axis and its last one. */
typedef struct dea_thinning {
    size_t count, stride, kept;
} dea_thinning;

/* How a study is drawn: what it keeps, and the script from that. */
typedef struct dea_drawer {
    dea_status (*open)(dea_plot *plot, dea_error *error);
    void (*take)(dea_plot *plot, size_t first, const void *points, size_t count);
    dea_status (*draw)(dea_plot *plot, dea_error *error);
} dea_drawer;

extern const dea_drawer dea_drawer_points, dea_drawer_runs, dea_drawer_modes, dea_drawer_profiles;

struct dea_plot {
    const dea_scene *scene;
    bool loops; /* as in the options */
    const dea_drawer *drawer;
    dea_gnuplot picture;
    dea_runs runs; /* of runs along time, frequency or radius */
    char *kept;    /* all points, of modes and profiles; what follows is of a sweep */
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
/* Colours of a map and of many curves, dark to light, 0 <= share <= 1. */
void dea_plot_gradient(double share, char colour[8]);
/* Writes the line style of curves of one kind, from 1; number 1 is solid. */
void dea_plot_dash(FILE *script, size_t number);
/* Lines of a script that every picture begins with: tics, grid, border. */
void dea_plot_style(FILE *script);
/* Sets the palette to the gradient up to @p end. */
void dea_plot_palette(FILE *script, double end);
/* Begins a multiplot with a title over it, none where it is empty. It is label 2, to be unset behind the first panel. */
void dea_plot_title(FILE *script, const char *title, int width, int height);
/* Room above the panels. */
double dea_plot_top(const char *title);
/* Puts the next panel into a box of a canvas of that size. */
void dea_plot_place(FILE *script, int width, int height, dea_box box);
/* Places of two panels with @p beside units kept free at the right and @p legend below, in all of a canvas. DEA_ERROR_USAGE: it is
 * too small. */
dea_status dea_plot_pair(dea_canvas canvas, const char *title, double beside, int legend, dea_pair *pair, dea_error *error);
/* Fails for a canvas that leaves a panel no room. */
dea_status dea_plot_cramped(dea_canvas canvas, dea_error *error);

/* Widens a span by a number; those that are none, or have no logarithm, are passed over. */
void dea_span_take(dea_span *span, double value);
/* Leaves room beyond the numbers, so that none lies on the frame: below zero only where @p floats. A single number gets a range. */
void dea_span_pad(dea_span *span, bool floats);
/* Sets range and kind of the axis named @p axis ("x", "y", "y2", "cb") that is @p length units long, and the tics of a logarithmic
 * one: at the decades, and at 2 and 5 or all numbers between them on a short one. */
void dea_span_write(FILE *script, const char *axis, const dea_span *span, double length, dea_name *name);
/* Writes those tics alone, at the logarithms of their numbers where @p placed. */
void dea_span_tics(FILE *script, const char *axis, const dea_span *span, double length, dea_name *name, bool placed);
/* Sets tics of a linear axis in steps of 1, 2 or 5 times a power of ten, @p count steps at most and two tics at least. */
void dea_span_steps(FILE *script, const char *axis, const dea_span *span, double count);
/* Smallest of 1, 2, 5 times a power of ten that is not below @p least > 0. */
double dea_step_choose(double least);
/* Drops what lies more than eight decades below the top of a logarithmic span: rounding has numbers there too. */
void dea_span_limit(dea_span *span);
/* Names of tics: none, "10⁻²", "0.01", and with a prefix, "2k". */
void dea_name_power(double value, char text[DEA_LABEL_LENGTH]);
void dea_name_none(double value, char text[DEA_LABEL_LENGTH]);
void dea_name_plain(double value, char text[DEA_LABEL_LENGTH]);
void dea_name_prefixed(double value, char text[DEA_LABEL_LENGTH]);
/* Positive values with a constant ratio over two decades or more ask for a logarithmic axis. */
bool dea_axis_logarithmic(const dea_axis *axis);

/* Room for all points of a study, and a drawer's take() that keeps them there. DEA_ERROR_MEMORY. */
dea_status dea_plot_keep(dea_plot *plot, dea_error *error);
void dea_plot_take(dea_plot *plot, size_t first, const void *points, size_t count);

/* Write the script of a picture of that kind. */
dea_status dea_plot_draw_curves(dea_plot *plot, dea_error *error);
dea_status dea_plot_draw_map(dea_plot *plot, dea_error *error);
dea_status dea_plot_draw_runs(dea_plot *plot, dea_error *error);

#endif
