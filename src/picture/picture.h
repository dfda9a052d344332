/* Points of a study on their way into a picture. */
#ifndef DEASPICE_PICTURE_PICTURE_H
#define DEASPICE_PICTURE_PICTURE_H

#include "deaspice/bench.h"
#include "deaspice/plot.h"
#include "picture/panel.h"
#include "picture/runs.h"

/* Columns of a sweep that a picture draws at most. */
enum { DEA_DRAWN = 2 };

/* What a picture keeps of a static point: the columns that it draws. */
typedef struct dea_dot {
    double values[DEA_DRAWN];
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

extern const dea_drawer dea_drawer_points, dea_drawer_runs, dea_drawer_modes, dea_drawer_profiles, dea_drawer_waves, dea_drawer_forces;

struct dea_plot {
    const dea_scene *scene;
    bool loops; /* as in the options */
    const char *columns;
    const dea_drawer *drawer;
    dea_gnuplot picture;
    dea_runs runs; /* of runs along time, frequency or radius */
    char *kept;    /* all points, of modes and profiles; what follows is of a sweep */
    bool map;      /* a map over two axes, else curves */
    size_t x, y;   /* numbers of the axis along x, and of the one along y of a map */
    dea_thinning across, up;
    size_t curves; /* models times values of all other axes; for a map the kept values of y */
    dea_dot *dots; /* curves rows of across.kept dots */
    dea_column drawn[DEA_DRAWN];
    size_t drawn_count;
};

/* Index that kept value number @p kept has on its axis. */
size_t dea_thinning_index(const dea_thinning *thinning, size_t kept);
/* Order of the kept values of an axis by size: kept numbers, malloc'd; NULL without memory. */
size_t *dea_plot_order(const dea_axis *axis, const dea_thinning *thinning);

/* Room for all points of a study, and a drawer's take() that keeps them there. DEA_ERROR_MEMORY. */
dea_status dea_plot_keep(dea_plot *plot, dea_error *error);
void dea_plot_take(dea_plot *plot, size_t first, const void *points, size_t count);

/* Write the script of a picture of that kind. */
dea_status dea_plot_draw_curves(dea_plot *plot, dea_error *error);
dea_status dea_plot_draw_map(dea_plot *plot, dea_error *error);
dea_status dea_plot_draw_runs(dea_plot *plot, dea_error *error);
dea_status dea_bench_picture(const dea_bench *bench, dea_gnuplot *picture, dea_error *error);

#endif
