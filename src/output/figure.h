/* A figure: panels over one quantity along x, in one column or two, with curves as they are drawn, marks on them, and a legend. */
#ifndef DEASPICE_OUTPUT_FIGURE_H
#define DEASPICE_OUTPUT_FIGURE_H

#include "output/legend.h"
#include "output/picture.h"
#include "output/series.h"

enum { DEA_PANELS = 5 };

/* What stands at a point of a curve: its symbol, and from DEA_AT_LIMIT on, each twice the one before, the marks of dea_marks. */
enum { DEA_AT_SYMBOL = 1, DEA_AT_LIMIT = 2 };

/* One curve: points in the units of the figure, NAN where it is broken; owned. */
typedef struct dea_curve {
    size_t panel;
    dea_look look;
    double width; /* of its line, 0: it has none */
    struct {
        double x, y;
        unsigned marks;
    } *points;
    size_t count, room;
    bool marked; /* at any point */
} dea_curve;

typedef struct dea_panel {
    char label[DEA_LABEL_LENGTH];
    double tall;   /* height where no size is wanted */
    double factor; /* from the numbers of its points to what is drawn */
    dea_span span; /* as drawn: widened by points; logarithmic, where wanted, from the begin */
    bool absolute; /* is drawn without its sign */
    bool zero;     /* shows zero */
    bool floats;   /* has room below zero */
    bool whole;    /* shows all numbers of a logarithmic axis, however small */
    int intervals; /* of its tics, at most; 0: as its height asks for */
    double step;   /* of its tics, 0: as it comes */
    dea_name *name; /* of logarithmic tics */
    double second; /* second axis: its numbers over the drawn ones, 0: none */
    char second_label[DEA_LABEL_LENGTH];
    const char *tag; /* "(a)", NULL: none */
    bool bottom;     /* carries the labels along x */
    dea_box box;
} dea_panel;

/* Zeroed but for picture and title, a figure is empty. */
typedef struct dea_figure {
    dea_gnuplot *picture;
    const char *title;
    dea_panel panels[DEA_PANELS];
    size_t count;
    dea_curve *curves; /* curve_count of them, owned */
    size_t curve_count, curve_room;
    bool failed;                  /* out of memory */
    char label[DEA_LABEL_LENGTH]; /* along x */
    dea_span along;               /* as drawn, widened by points */
    dea_name *name;               /* of logarithmic tics along x */
    const dea_series *series;     /* whose colour scale stands beside the first panel, NULL: none */
    bool seen[DEA_MARKS];
    dea_legend legend;
    int foot, height; /* of the laid legend, and of the picture [units] */
} dea_figure;

/* A figure of a study: its title, nothing along x yet. The caller ends it with dea_figure_end(). */
dea_figure dea_figure_begin(dea_plot *plot, bool logarithmic);
/* The next panel, without curves. */
dea_panel *dea_figure_panel(dea_figure *figure, double tall, const char *label);
/* Begins a curve on a panel; its line is so wide. */
void dea_figure_curve(dea_figure *figure, size_t panel, dea_look look, double width);
/* Its next point; one that a logarithmic axis along x has no place for is left out. */
void dea_figure_point(dea_figure *figure, double x, double y, unsigned marks);
/* Takes the last panel back where its curves are nothing but zeros and gaps. */
void dea_figure_prune(dea_figure *figure);
/* Puts the panels above each other, in all of the canvas where it has a height; those from @p second on (count: none) beside the
 * others where that leaves them room. The legend is laid before. DEA_ERROR_USAGE: no panel, or too small a canvas. */
dea_status dea_figure_stack(dea_figure *figure, size_t second, dea_error *error);
/* Writes the script where @p status is DEA_OK, and frees the figure. @return @p status, or DEA_ERROR_MEMORY */
dea_status dea_figure_end(dea_figure *figure, dea_status status, dea_error *error);

#endif
