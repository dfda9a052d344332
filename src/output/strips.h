/* Panels one above the other over one quantity, with curves that the caller has made: colours and dashes are his, marks there are
 * none. */
#ifndef DEASPICE_OUTPUT_STRIPS_H
#define DEASPICE_OUTPUT_STRIPS_H

#include "output/legend.h"
#include "output/picture.h"

enum { DEA_STRIPS = 4 };

/* One curve, as drawn; a number that is none breaks it. */
typedef struct dea_strip_curve {
    size_t strip;
    char colour[8];
    size_t dash; /* as dea_plot_dash() numbers them */
    double *x, *y;
    size_t count;
} dea_strip_curve;

typedef struct dea_strip {
    char label[DEA_LABEL_LENGTH];
    bool floats;      /* its numbers need not begin at zero */
    bool logarithmic;
} dea_strip;

typedef struct dea_strips {
    dea_strip strips[DEA_STRIPS]; /* the first is the highest */
    size_t count;
    dea_strip_curve *curves; /* curve_count of them in room for curve_room; owned, as their room */
    size_t curve_count, curve_room;
    double *room, *next;
    char label[DEA_LABEL_LENGTH]; /* along x */
    bool logarithmic;             /* along x */
    dea_legend legend;            /* entries, kinds[i] being the first of kind i */
    size_t kinds[3];
} dea_strips;

/* Room for so many curves of so many points each; the caller frees it with dea_strips_close(). DEA_ERROR_MEMORY. */
dea_status dea_strips_open(dea_strips *strips, size_t curves, size_t points, dea_error *error);
void dea_strips_close(dea_strips *strips);
/* The next curve, without points, on a strip. */
dea_strip_curve *dea_strips_add(dea_strips *strips, size_t strip, const char colour[8], size_t dash);
/* Its next point. */
void dea_strip_point(dea_strips *strips, dea_strip_curve *curve, double x, double y);
/* Writes the picture; strips whose curves are nothing but zeros and gaps are left out. DEA_ERROR_USAGE: none is left, or there is no
 * room. */
dea_status dea_strips_draw(dea_strips *strips, dea_plot *plot, dea_error *error);

/* Model and values of the axes but number @p along (SIZE_MAX: none) of one of the runs that they make, models slowest. */
void dea_strips_name(const dea_scene *scene, size_t along, size_t group, char *label, size_t size);

#endif
