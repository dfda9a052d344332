/* The curves of a picture: a group for each combination of values of the axes that do not lie along x, and in it a curve for each
 * model. A model has its colour in every picture, and beside others its dash. A group has a shade of that colour and a mark, so that curves are
 * told apart in grey too; more groups than can be told so have the colour of a scale, and their models the dash alone. */
#ifndef DEASPICE_PICTURE_SERIES_H
#define DEASPICE_PICTURE_SERIES_H

#include "deaspice/model.h"
#include "deaspice/result.h"
#include "deaspice/scene.h"
#include "picture/gnuplot.h"
#include "picture/label.h"
#include "picture/legend.h"

enum { DEA_MARKS = 3, DEA_CURVES_MAX = 24, DEA_BAR = 96 /* room of a colour scale [units] */ };

/* A mark on a curve: a limit that a point is past. */
typedef struct dea_mark {
    dea_state state;
    int symbol, inside; /* point types of gnuplot: the outline, and its inside in white below it */
    const char *legend;
} dea_mark;

extern const dea_mark dea_marks[DEA_MARKS];

typedef struct dea_series {
    const dea_scene *scene;
    size_t along;    /* number of the axis along x, SIZE_MAX: none */
    size_t groups;   /* curves of one model */
    size_t bar;      /* number of the axis of the colour scale, SIZE_MAX: none */
    dea_scale scale; /* of that axis */
} dea_series;

/* How a curve is drawn. */
typedef struct dea_look {
    char colour[8];
    bool scaled;  /* has the colour of the scale at value instead */
    double value; /* as drawn */
    size_t dash;  /* as dea_plot_dash() numbers them */
    int symbol;   /* point type of gnuplot, 0: none */
    double size;  /* of the symbol, 0: as curves have it */
} dea_look;

/* The series of a study of so many groups. */
dea_series dea_series_of(const dea_scene *scene, size_t along, size_t groups);
/* Look of a curve. */
dea_look dea_series_look(const dea_series *series, size_t model, size_t group);
/* Colour of a model in every picture, and its dash beside others. */
dea_look dea_model_look(const dea_model *model);
/* Writes "linecolor ..." of a look. */
void dea_look_colour(FILE *script, const dea_look *look);
/* Marks of group @p group stand where this number changes along a curve: six on it, those of other groups elsewhere. @p share: of
 * the way along x. */
int dea_series_mark(const dea_series *series, size_t group, double share);
/* Sets up the colour scale beside a panel; it is drawn with the next plot. */
void dea_series_bar(const dea_series *series, FILE *script, dea_canvas canvas, int height, dea_box panel);
/* Legend of groups, models and the marks that were seen, in centred rows on a canvas of that width; its height. */
int dea_series_legend(const dea_series *series, const bool seen[DEA_MARKS], int width, dea_legend *legend);

#endif
