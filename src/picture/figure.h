/* A figure: panels over one quantity along x, or two, in one column or two, with curves as they are drawn, marks on them, words and a
 * legend. */
#ifndef DEASPICE_PICTURE_FIGURE_H
#define DEASPICE_PICTURE_FIGURE_H

#include "picture/legend.h"
#include "picture/picture.h"
#include "picture/series.h"

enum { DEA_PANELS = 5, DEA_TICS = 512, DEA_WORDS = 128 };

/* What stands at a point of a curve: its symbol, and from DEA_AT_LIMIT on, each twice the one before, the marks of dea_marks. */
enum { DEA_AT_SYMBOL = 1, DEA_AT_LIMIT = 2 };

/* One curve: points in the units of the figure, NAN where it is broken; owned. */
typedef struct dea_curve {
    size_t panel;
    dea_look look;
    double width; /* of its line, 0: it has none, and its symbol stands at each point */
    struct {
        double x, y;
        unsigned marks;
    } *points;
    size_t count, room;
    bool marked; /* at any point */
} dea_curve;

/* What lies along x. */
typedef struct dea_across {
    char label[DEA_LABEL_LENGTH];
    dea_span span;       /* as drawn, widened by points */
    bool floats;         /* has room beyond its numbers */
    dea_name *name;      /* of logarithmic tics */
    double room;         /* of the width, for those tics */
    char tics[DEA_TICS]; /* as gnuplot takes them, "": as they come */
} dea_across;

typedef struct dea_panel {
    char label[DEA_LABEL_LENGTH];
    size_t across; /* number of what lies along x */
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
    double reference; /* number that stands for those that are none, "ref."; 0: none does */
    double second; /* second axis: its numbers over the drawn ones, 0: none */
    char second_label[DEA_LABEL_LENGTH];
    const char *tag; /* "(a)", NULL: none */
    bool bottom;     /* carries the labels along x */
    dea_box box;
} dea_panel;

/* A word beside a point, left out where something stands. */
typedef struct dea_figure_word {
    char text[24], colour[8];
    size_t panel;
    double x, y;
} dea_figure_word;

typedef struct dea_figure {
    dea_gnuplot *picture;
    const char *title;
    dea_panel panels[DEA_PANELS];
    size_t count;
    dea_curve *curves; /* curve_count of them, owned */
    size_t curve_count, curve_room;
    bool failed;                  /* out of memory */
    dea_across across[2];         /* the second only where a panel lies along it */
    dea_figure_word words[DEA_WORDS];
    size_t word_count;
    const dea_series *series;     /* whose colour scale stands beside the first panel, NULL: none */
    bool seen[DEA_MARKS];
    dea_legend legend;
    double left;      /* of a pair of panels: their labels, 0: as usual */
    int foot, height; /* of the laid legend, and of the picture [units] */
} dea_figure;

/* A figure without panels. The caller ends it with dea_figure_end(). */
dea_figure dea_figure_begin(dea_gnuplot *picture, const char *title, bool logarithmic);
/* The next panel, without curves. */
dea_panel *dea_figure_panel(dea_figure *figure, double tall, const char *label);
/* Begins a curve on a panel; its line is so wide, 0: it has none. */
void dea_figure_curve(dea_figure *figure, size_t panel, dea_look look, double width);
/* Its next point; one that a logarithmic axis along x has no place for is left out. */
void dea_figure_point(dea_figure *figure, double x, double y, unsigned marks);
/* A word beside a point of a panel. */
void dea_figure_word_add(dea_figure *figure, size_t panel, double x, double y, const char *text, const char colour[8]);
/* Takes the last panel back where its curves are nothing but zeros and gaps. */
void dea_figure_prune(dea_figure *figure);
/* Puts the panels above each other, in all of the canvas where it has a height; those from @p second on (count: none) beside the
 * others where that leaves them room. The legend is laid before. DEA_ERROR_USAGE: no panel, or too small a canvas. */
dea_status dea_figure_stack(dea_figure *figure, size_t second, dea_error *error);
/* Puts one panel into all of the canvas, or two, (a) and (b), side by side with @p share of the width for the first, or one above the
 * other where that leaves them more room; @p tall where the canvas has no height. The legend is laid before. DEA_ERROR_USAGE: too small
 * a canvas. */
dea_status dea_figure_pair(dea_figure *figure, double share, double tall, dea_error *error);
/* Writes the script where @p status is DEA_OK, and frees the figure. @return @p status, or DEA_ERROR_MEMORY */
dea_status dea_figure_end(dea_figure *figure, dea_status status, dea_error *error);

#endif
