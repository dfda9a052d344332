/* A work-precision study while it is made: ladder (which settings), measure (their times), judge (their errors). */
#ifndef DEASPICE_BENCH_WORK_H
#define DEASPICE_BENCH_WORK_H

#include <stdint.h>

#include "deaspice/bench.h"
#include "result/compare.h"
#include "study/study.h"

enum { DEA_BENCH_RUNGS = 15 }; /* accuracies 1e-1 to 1e-15, of which a ladder begins with the second */

/* What a model's settings are compared with. */
typedef struct dea_bench_truth {
    dea_scene scene; /* the study with this model alone; borrows all else */
    dea_comparison comparison;
    uint64_t digest; /* of the reference's numbers */
    bool known;      /* there is a reference */
} dea_bench_truth;

/* Times of one setting. */
typedef struct dea_bench_times {
    double first;    /* of the run that was judged; it warms up [s] */
    double *seconds; /* of the timed runs; owned */
    size_t wanted, count;
    uint64_t digest; /* of the setting's numbers */
} dea_bench_times;

typedef struct dea_bench_work {
    dea_bench *bench;
    const dea_bench_options *options;
    dea_layout layout;
    size_t points;           /* of one model */
    char *buffer;            /* points of one run */
    dea_bench_truth *truths; /* of each model, and behind them of `field`, where that is none of them */
    dea_bench_times *times;  /* of each setting */
    size_t setting_room;
    double begun;       /* [s] */
    size_t steps, step; /* of the work, roughly */
} dea_bench_work;

/* ---- measure */

/* Time that is left of the budget [s], >= 0. */
double dea_bench_left(const dea_bench_work *work);
/* Tells progress: one step more is done. */
void dea_bench_step(dea_bench_work *work);
/* Runs a study of one model at an accuracy, as a user's run does. Its points go to @p points, or nowhere where that is NULL.
 * @p full keeps physics that changes less than the accuracy: what a reference needs. */
dea_status dea_bench_solve(const dea_bench_work *work, const dea_engine *engine, const dea_scene *scene, double accuracy,
                           bool full, char *points, double *seconds, dea_error *error);
/* Repeats all settings, turn by turn, and fills their times. @return DEA_OK, DEA_ERROR_INTERRUPTED, DEA_ERROR_MEMORY */
dea_status dea_bench_repeat(dea_bench_work *work, dea_error *error);
/* Times of a setting from its runs, sorted in place. */
void dea_bench_summarise(dea_bench_setting *setting, double *seconds, size_t count);
/* Median time from nothing to a session that waits for its first point [s], NAN where none begins. */
double dea_bench_start(const dea_bench_work *work, const dea_engine *engine);

/* ---- ladder */

/* Accuracy number @p rung of the ladder, from 0. */
double dea_bench_accuracy(size_t rung);
/* How many accuracies of the ladder the engine takes for this scene's model, from the loosest on; *why is set where none. */
size_t dea_bench_rungs(const dea_engine *engine, const dea_scene *scene, const char **why);
/* Walks the ladders of all engines on model number @p model: runs and judges each setting once.
 * @return DEA_OK, DEA_ERROR_INTERRUPTED, DEA_ERROR_MEMORY */
dea_status dea_bench_walk(dea_bench_work *work, size_t model, dea_error *error);
/* Takes a measured setting: in place of the last one where that has the same engine, model and numbers. */
void dea_bench_take(dea_bench *bench, dea_bench_times *times, const dea_bench_setting *setting, const dea_bench_times *time);

/* ---- judge */

/* True where the models of a study are held against the membrane. */
bool dea_bench_has_membrane(const dea_study *study);
/* A number for the numeric columns and states of points: equal for equal results. */
uint64_t dea_bench_digest(const dea_layout *layout, const char *points, size_t count);
/* Engine that promises most for the model of that scene, NULL: none can do it; ties go to the first. */
const dea_engine *dea_bench_best(const dea_scene *scene);
/* Finds the reference of a truth: the best engine at the tightest accuracy that time allows. */
dea_status dea_bench_refer(dea_bench_work *work, size_t truth, double allowance, dea_error *error);
/* Compares the points in the buffer with the reference of the setting's model. */
void dea_bench_judge(dea_bench_work *work, dea_bench_setting *setting, uint64_t digest);
/* Marks broken promises and dominated settings, and finds for each model who else comes near its reference. */
void dea_bench_conclude(dea_bench *bench);
/* The truth that is model `field`: one of the models, or the one behind them. */
dea_bench_truth *dea_bench_membrane(const dea_bench_work *work);
/* Errors of the models' strains relative to it. */
dea_status dea_bench_judge_models(dea_bench_work *work, dea_error *error);

#endif
