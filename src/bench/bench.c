/* A work-precision study, from references over first runs to repeated ones. */
#include "deaspice/bench.h"

#include <math.h>
#include <stdlib.h>

#include "bench/work.h"
#include "study/study.h"
#include "support/clock.h"

/* Rows that a study keeps: the references of all models. */
enum { MOST_ROWS = DEA_SAMPLES_MAX, ROUNDS = 25 };

/* Part of the budget for references. */
static const double reference_share = 0.3;

dea_bench_options dea_bench_options_default(void)
{
    return (dea_bench_options){.jobs = 1, .runs = 5, .enough = 0.2, .budget = 60.0};
}

static bool can_do(const dea_scene *scene, const dea_model *model)
{
    return (scene->actuator.kind == DEA_DOT || model->lens) && dea_study_takes(dea_study_of(scene), model);
}

void dea_bench_all_models(dea_scene *scene)
{
    scene->model_count = 0;
    scene->automatic = false;
    for (size_t i = 0; i < dea_model_count() && scene->model_count < DEA_SCENE_MODELS; i++) {
        if (can_do(scene, dea_model_at(i))) {
            scene->models[scene->model_count++] = dea_model_at(i);
        }
    }
}

void dea_bench_free(dea_bench *bench)
{
    if (bench) {
        free(bench->models);
        free(bench->settings);
        *bench = (dea_bench){0};
    }
}

static void work_close(dea_bench_work *work)
{
    for (size_t i = 0; work->truths && i <= work->bench->model_count; i++) {
        dea_comparison_close(&work->truths[i].comparison);
    }
    for (size_t i = 0; work->times && i < work->setting_room; i++) {
        free(work->times[i].seconds);
    }
    free(work->truths);
    free(work->times);
    free(work->buffer);
}

/* What one run of a model's study gives: points, simulated seconds or frequencies. */
static void count_units(dea_bench_work *work)
{
    dea_bench *bench = work->bench;
    const double points = (double)work->points;
    const dea_study *study = dea_study_of(bench->scene);
    bench->units = points * (study->timed ? bench->scene->transient.until : (double)work->layout.rows);
    bench->unit = study->unit;
    bench->rows = work->points * work->layout.rows;
}

static dea_scene alone(const dea_scene *scene, const dea_model *model)
{
    dea_scene single = *scene;
    single.models[0] = model;
    single.model_count = 1;
    return single;
}

static dea_status work_open(dea_bench_work *work, dea_bench *bench, const dea_scene *scene, const dea_bench_options *options,
                            dea_error *error)
{
    const double none = (double)NAN;
    const size_t models = scene->model_count;
    *bench = (dea_bench){.scene = scene, .model_count = models};
    *work = (dea_bench_work){.bench = bench,
                             .options = options,
                             .layout = dea_layout_of(scene),
                             .points = dea_scene_point_count(scene),
                             .setting_room = models * dea_engine_count() * DEA_BENCH_RUNGS,
                             .begun = dea_clock()};
    count_units(work);
    if (bench->rows > MOST_ROWS / (models + 1)) {
        return dea_fail(error, DEA_ERROR_USAGE,
                        "a bench keeps the references of all models in memory and takes at most %zu rows of each; this study "
                        "has %zu, give it fewer",
                        MOST_ROWS / (models + 1), bench->rows);
    }
    work->steps = 2 * models + 1 + models * dea_engine_count() + ROUNDS;
    work->buffer = malloc(work->points * work->layout.point_size);
    work->truths = calloc(models + 1, sizeof *work->truths);
    work->times = calloc(work->setting_room, sizeof *work->times);
    bench->models = calloc(models, sizeof *bench->models);
    bench->settings = calloc(work->setting_room, sizeof *bench->settings);
    if (!work->buffer || !work->truths || !work->times || !bench->models || !bench->settings) {
        return dea_fail(error, DEA_ERROR_MEMORY, "out of memory for %zu rows", bench->rows);
    }
    for (size_t i = 0; i < models; i++) {
        bench->models[i] = (dea_bench_model){.model = scene->models[i],
                                             .reference_accuracy = none,
                                             .check_accuracy = none,
                                             .apart = none,
                                             .error_median = none,
                                             .error_worst = none,
                                             .error_rms = none};
        work->truths[i].scene = alone(scene, scene->models[i]);
    }
    work->truths[models].scene = alone(scene, dea_model_find("field"));
    return DEA_OK;
}

static void count_states(dea_bench_work *work, size_t number)
{
    const dea_bench_truth *truth = &work->truths[number];
    for (size_t i = 0; truth->known && i < work->bench->rows; i++) {
        const char *point = truth->comparison.reference + i / work->layout.rows * work->layout.point_size;
        const char *row = point + i % work->layout.rows * work->layout.row_size;
        work->bench->models[number].states[dea_layout_state(&work->layout, row)]++;
    }
}

/* References of all models, and the membrane's, which tells the errors of the models. */
static dea_status refer_all(dea_bench_work *work, dea_error *error)
{
    const size_t models = work->bench->model_count;
    const bool alone = dea_bench_membrane(work) == &work->truths[models];
    const size_t count = models + (dea_bench_has_membrane(dea_study_of(work->bench->scene)) && alone);
    const double allowance = reference_share * work->options->budget / (double)count;
    dea_status status = DEA_OK;
    for (size_t i = 0; i < count && status == DEA_OK; i++) {
        status = dea_bench_refer(work, i, allowance, error);
        if (i < models) {
            count_states(work, i);
        }
        dea_bench_step(work);
    }
    return status;
}

static dea_status measure(dea_bench_work *work, dea_error *error)
{
    dea_status status = refer_all(work, error);
    for (size_t i = 0; i < work->bench->model_count && status == DEA_OK; i++) {
        status = dea_bench_walk(work, i, error);
    }
    status = status ? status : dea_bench_repeat(work, error);
    status = status ? status : dea_bench_judge_models(work, error);
    if (status == DEA_OK) {
        dea_bench_conclude(work->bench);
    }
    return status;
}

dea_status dea_bench_run(const dea_scene *scene, const dea_bench_options *options, dea_bench *bench, dea_error *error)
{
    dea_bench_work work;
    if (options->jobs == 0 || options->runs == 0 || !(options->budget > 0.0) || scene->model_count == 0) {
        return dea_fail(error, DEA_ERROR_USAGE, "a bench needs a model, at least one job and one run, and a budget above 0 s");
    }
    dea_status status = work_open(&work, bench, scene, options, error);
    status = status ? status : measure(&work, error);
    work_close(&work);
    if (status != DEA_OK) {
        dea_bench_free(bench);
    }
    return status;
}
