#include "program/check_omissions.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

#include "deaspice/needs.h"
#include "program/omissions.h"
#include "result/compare.h"

/* Everything that one engine leaves out of the runs. */
typedef struct dea_sum {
    size_t runs, omissions;
    double closest; /* largest measured change over its bound */
    dea_bounds bounds;
} dea_sum;

static bool is_single(const dea_scene *scene)
{
    return dea_scene_point_count(scene) == 1;
}

static void judge(const dea_arguments *arguments, const dea_scene *scene, const dea_omission *omission, double change,
                  double noise, dea_sum *sum)
{
    char text[DEA_OMISSION_LENGTH];
    const bool broken = change > omission->bound + noise;
    sum->omissions++;
    sum->bounds.broken += broken ? 1 : 0;
    sum->bounds.unjudged += isnan(change) ? 1 : 0;
    sum->closest = fmax(sum->closest, change / (omission->bound + noise));
    if (arguments->quiet || (!broken && !is_single(scene))) {
        return;
    }
    printf("    left out: %s, measured ", dea_omission_text(omission, scene, text));
    if (isnan(change)) {
        puts("by no engine");
    } else if (change < noise) {
        printf("below %s%s\n", dea_bound_text(noise, text), broken ? ": BROKEN" : "");
    } else {
        printf("%.1e%s\n", change, broken ? ": BROKEN" : "");
    }
}

static void check_run(const dea_arguments *arguments, const dea_scene *scene, const dea_engine *engine, size_t number,
                      dea_sum *sum)
{
    double changes[DEA_OMISSIONS], noise = 0.0;
    dea_needs needs;
    const dea_scene placed = dea_scene_of_run(scene, number);
    if (dea_needs_find(&placed, placed.models[0], engine, &needs, NULL) != DEA_OK ||
        dea_needs_measure(&placed, placed.models[0], &needs, changes, &noise, NULL) != DEA_OK) {
        return;
    }
    sum->runs += needs.count > 0 ? 1 : 0;
    for (size_t i = 0; i < needs.count; i++) {
        judge(arguments, scene, &needs.omissions[i], changes[i], noise, sum);
    }
}

dea_bounds dea_check_omissions(const dea_arguments *arguments, const dea_scene *scene)
{
    dea_bounds all = {0};
    unsigned done = 0; /* parts of engines that were checked: another one with the same leaves out the same */
    for (size_t e = 0; e < dea_engine_count() && scene->study == DEA_STUDY_TRANSIENT; e++) {
        const dea_engine *engine = dea_engine_at(e);
        const bool wanted = !arguments->engine || strcmp(arguments->engine, engine->name) == 0;
        if (!wanted || engine->omits == 0 || engine->omits == done || dea_engine_refuses(engine, scene, scene->models[0])) {
            continue;
        }
        dea_sum sum = {.closest = 0.0};
        done = engine->omits;
        for (size_t i = 0; i < dea_scene_point_count(scene) && dea_signals_caught() == 0; i++) {
            check_run(arguments, scene, engine, i, &sum);
        }
        if (!arguments->quiet && sum.omissions > 0) {
            printf("  %-10s leaves out %zu part%s in %zu run%s, measured change over bound at most %.2g\n", engine->name,
                   sum.omissions, sum.omissions == 1 ? "" : "s", sum.runs, sum.runs == 1 ? "" : "s", sum.closest);
        }
        all.broken += sum.bounds.broken;
        all.unjudged += sum.bounds.unjudged;
    }
    return all;
}

static dea_status take_points(void *user, size_t first, const void *points, size_t count, dea_error *error)
{
    return dea_comparison_take(user, first, points, count, error);
}

/* Runs a model by the first engine that can do it. */
static bool run_model(const dea_arguments *arguments, const dea_scene *scene, const dea_model *model, dea_comparison *comparison)
{
    dea_scene here = *scene;
    here.models[0] = model;
    here.full = true;
    const dea_run_options options = {
        .jobs = arguments->jobs ? arguments->jobs : 1, .points = take_points, .stop = dea_signals_stop, .user = comparison};
    for (size_t i = 0; i < dea_engine_count(); i++) {
        if (!dea_engine_refuses(dea_engine_at(i), &here, model)) {
            return dea_study_run(&here, dea_engine_at(i), &options, NULL) == DEA_OK;
        }
    }
    return false;
}

/* The columns that the bound is about: strain, displacement over time, all of a frequency response. */
static double error_of(const dea_comparison *comparison)
{
    double worst = comparison->states > 0 ? (double)INFINITY : comparison->worst[0];
    for (size_t c = 1; c < comparison->column_count && comparison->scene->study == DEA_STUDY_AC; c++) {
        worst = fmax(worst, comparison->worst[c]);
    }
    return worst;
}

dea_bounds dea_check_choice(const dea_arguments *arguments, const dea_scene *scene, double bound)
{
    char text[32];
    dea_bounds bounds = {0};
    dea_comparison comparison;
    const dea_model *truth = dea_needs_truth(scene->study);
    if (truth == scene->models[0]) {
        return bounds;
    }
    if (dea_comparison_open(&comparison, scene, NULL) != DEA_OK) {
        bounds.unjudged++;
        return bounds;
    }
    bool judged = run_model(arguments, scene, truth, &comparison);
    comparison.filling = false;
    dea_comparison_forget(&comparison);
    judged = judged && run_model(arguments, scene, scene->models[0], &comparison);
    const double change = judged ? error_of(&comparison) : (double)NAN;
    bounds.unjudged += judged ? 0 : 1;
    bounds.broken += change > bound + 2.0 * scene->accuracy ? 1 : 0;
    if (!arguments->quiet) {
        printf("  %s instead of %s (<= %s), measured %.1e%s\n", scene->models[0]->name, truth->name, dea_bound_text(bound, text),
               change, bounds.broken > 0 ? ": BROKEN" : "");
    }
    dea_comparison_close(&comparison);
    return bounds;
}
