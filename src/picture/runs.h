/* What a picture keeps of transients and frequency responses: a curve for each run and each quantity that is drawn, thinned to
 * what can be seen. Of every run of samples that share a column of pixels the least and the largest stay, so that no peak is
 * lost. Between the samples of a response with few of them lies its interpolant, so that a resonance is as round as it is. */
#ifndef DEASPICE_PICTURE_RUNS_H
#define DEASPICE_PICTURE_RUNS_H

#include "deaspice/scene.h"
#include "picture/series.h"

enum { DEA_RUNS_QUANTITIES = 5, DEA_RUNS_POINTS = 2000, DEA_SPOTS = 32 };

/* A curve: kept points, NAN where it is broken. */
typedef struct dea_plot_trace {
    double *x, *y; /* DEA_RUNS_POINTS values each at most */
    size_t count;
} dea_plot_trace;

/* A mark on the first quantity. */
typedef struct dea_spot {
    double x, y;
    size_t mark; /* number in dea_marks */
} dea_spot;

typedef struct dea_run {
    dea_plot_trace traces[DEA_RUNS_QUANTITIES];
    dea_spot spots[DEA_SPOTS];
    size_t spot_count;
} dea_run;

typedef struct dea_runs {
    dea_layout layout;
    size_t quantities[DEA_RUNS_QUANTITIES]; /* their columns in the layout, quantity_count of them; of a response in pairs of
                                               magnitude and phase */
    size_t quantity_count;
    size_t abscissa; /* column over which they are drawn: the first, or the voltage, over which curves are loops */
    dea_run *runs; /* count of them, owned */
    size_t count;
    double *room; /* of all traces, owned */
} dea_runs;

/* Makes room for the runs of the scene's study, @p loops: of a transient over its voltage; free with dea_runs_close(). DEA_ERROR_USAGE (too many), DEA_ERROR_MEMORY. */
dea_status dea_runs_open(const dea_scene *scene, bool loops, dea_runs *runs, dea_error *error);
/* Keeps what is drawn of run number @p number: models slowest, last axis fastest. */
void dea_runs_take(dea_runs *runs, size_t number, const void *point);
/* Number of the quantity whose column lies at @p offset of a row, SIZE_MAX where the study has none. */
size_t dea_runs_find(const dea_runs *runs, size_t offset);
/* Frees what the runs own; zeroed ones are fine. */
void dea_runs_close(dea_runs *runs);

#endif
