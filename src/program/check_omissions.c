
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "deaspice/needs.h"
#include "program/omissions.h"
#include "result/compare.h"
#include "study/study.h"

static const double choice_fine = 0.05; /* of a model error's bound: accuracy of the runs that measure it */

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

static void print_verdict(const dea_measured *m)
{
    char text[32];
    if (m->verdict == DEA_NOT_JUDGED) {
        printf("not judged: %s", m->why);
        if (isfinite(m->change) && isfinite(m->error)) {
            printf(" (measured %.1e, by a judge that may be off by %.1e)", m->change, m->error);
        }
    } else if (!isnan(m->ended)) {
        printf("with or without it alone the run ends at %s", DEA_QUANTITY(m->ended, "s", 3));
    } else if (m->change < m->error) {
        printf("measured below %s", dea_bound_text(m->error, text));
    } else {
        printf("measured %.1e", m->change);
    }
    puts(m->verdict == DEA_BROKEN ? ": BROKEN" : "");
}

static void judge(const dea_arguments *arguments, const dea_scene *scene, const dea_omission *omission, const dea_measured *m,
                  dea_sum *sum)
{
    char text[DEA_OMISSION_LENGTH];
    sum->omissions++;
    sum->bounds.broken += m->verdict == DEA_BROKEN ? 1 : 0;
    sum->bounds.unjudged += m->verdict == DEA_NOT_JUDGED ? 1 : 0;
    if (m->verdict != DEA_NOT_JUDGED) {
        sum->closest = fmax(sum->closest, m->change / omission->bound);
    }
    if (!arguments->quiet && (m->verdict == DEA_BROKEN || is_single(scene))) {
        printf("    left out: %s, ", dea_omission_text(omission, scene, text));
        print_verdict(m);
    }
}

static void check_run(const dea_arguments *arguments, const dea_scene *scene, const dea_engine *engine, size_t number,
                      dea_sum *sum)
{
    dea_measured measured[DEA_OMISSIONS];
    dea_needs needs;
    const dea_scene placed = dea_scene_of_run(scene, number);
    if (dea_needs_find(&placed, placed.models[0], engine, &needs, NULL) != DEA_OK ||
        dea_needs_measure(&placed, placed.models[0], &needs, measured, NULL) != DEA_OK) {
        sum->bounds.unjudged++;
        return;
    }
    sum->runs += needs.count > 0 ? 1 : 0;
    for (size_t i = 0; i < needs.count; i++) {
        judge(arguments, scene, &needs.omissions[i], &measured[i], sum);
    }
}

static void print_sum(const dea_engine *engine, const dea_sum *sum)
{
    printf("  %-10s leaves out %zu part%s in %zu run%s, ", engine->name, sum->omissions, sum->omissions == 1 ? "" : "s",
           sum->runs, sum->runs == 1 ? "" : "s");
    if (sum->bounds.unjudged < sum->omissions) {
        printf("measured change over bound at most %.2g\n", sum->closest);
    } else {
        puts("none judged");
    }
}

dea_bounds dea_check_omissions(const dea_arguments *arguments, const dea_scene *scene)
{
    dea_bounds all = {0};
    unsigned done = 0; /* parts of engines that were checked: another one with the same leaves out the same */
    for (size_t e = 0; e < dea_engine_count() && dea_study_of(scene)->timed; e++) {
        const dea_engine *engine = dea_engine_at(e);
        const bool wanted = dea_engine_named(scene, engine);
        if (!wanted || engine->omits == 0 || engine->omits == done || dea_engine_refuses(engine, scene, scene->models[0])) {
            continue;
        }
        dea_sum sum = {.closest = 0.0};
        done = engine->omits;
        for (size_t i = 0; i < dea_scene_point_count(scene) && dea_signals_caught() == 0; i++) {
            check_run(arguments, scene, engine, i, &sum);
        }
        if (!arguments->quiet && sum.omissions > 0) {
            print_sum(engine, &sum);
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

/* Sets that accuracy, or the tightest above it that an engine promises for a model; false where none does. */
static bool find_judges(dea_scene *scene, const dea_model *model, double wanted)
{
    const double loosest = scene->accuracy;
    for (scene->accuracy = fmin(wanted, loosest); scene->accuracy <= loosest; scene->accuracy *= 10.0) {
        if (dea_crew_of(scene, NULL, model).count > 0) {
            return true;
        }
    }
    return false;
}

/* Runs a model finer than what is judged; by how much it may be off, NAN where nobody ran it. */
static double run_model(const dea_arguments *arguments, const dea_scene *scene, const dea_model *model, double wanted,
                        dea_comparison *comparison)
{
    dea_scene here = *scene;
    here.models[0] = model;
    here.engine_count = 0; /* whoever can */
    here.full = true;
    const dea_run_options options = {
        .jobs = arguments->jobs ? arguments->jobs : 1, .points = take_points, .stop = dea_signals_stop, .user = comparison};
    const bool done = find_judges(&here, model, wanted) && dea_study_run(&here, NULL, &options, NULL) == DEA_OK && comparison->failed == 0;
    return done ? fmax(here.accuracy, isnan(comparison->error) ? 0.0 : comparison->error) : (double)NAN;
}

/* The columns that the bound is about: strain, displacement over time, all of a frequency response. */
static double change_of(const dea_comparison *comparison)
{
    double worst = comparison->worst[0];
    for (size_t c = 1; c < comparison->column_count && dea_study_of(comparison->scene)->phasors; c++) {
        worst = fmax(worst, comparison->worst[c]);
    }
    return worst;
}

/* What a choice is off by, and what that measurement may be off by, NAN where it was not made. */
static dea_measured measure_choice(const dea_arguments *arguments, const dea_scene *scene, const dea_model *truth, double bound,
                                   dea_comparison *comparison)
{
    const double wanted = choice_fine * bound;
    dea_measured m = {.error = run_model(arguments, scene, truth, wanted, comparison)};
    comparison->filling = false;
    comparison->at_limit = bound;
    dea_comparison_forget(comparison);
    m.error += isnan(m.error) ? 0.0 : run_model(arguments, scene, scene->models[0], wanted, comparison);
    m.change = change_of(comparison);
    m.ended = (double)NAN;
    if (isnan(m.error)) {
        m.why = "no engine solved both models";
    } else if (comparison->states > 0 || m.change > bound + m.error) {
        m.verdict = DEA_BROKEN;
    } else if (m.error < bound) {
        m.verdict = DEA_HELD;
    } else {
        m.why = "the judges' own errors are larger than the bound";
    }
    return m;
}

dea_bounds dea_check_choice(const dea_arguments *arguments, const dea_scene *scene, const dea_model_choice *choice)
{
    char text[32];
    dea_bounds bounds = {0};
    dea_comparison comparison;
    const dea_model *truth = choice->truth;
    if (truth == scene->models[0]) {
        return bounds;
    }
    if (dea_comparison_open(&comparison, scene, NULL) != DEA_OK) {
        bounds.unjudged++;
        return bounds;
    }
    const dea_measured m = measure_choice(arguments, scene, truth, choice->bound, &comparison);
    bounds.broken += m.verdict == DEA_BROKEN ? 1 : 0;
    bounds.unjudged += m.verdict == DEA_NOT_JUDGED ? 1 : 0;
    if (!arguments->quiet) {
        printf("  %s instead of %s (<= %s), ", scene->models[0]->name, truth->name, dea_bound_text(choice->bound, text));
        if (m.verdict == DEA_BROKEN && comparison.states > 0) {
            printf("states of %zu row%s differ, else ", comparison.states, comparison.states == 1 ? "" : "s");
        }
        print_verdict(&m);
    }
    dea_comparison_close(&comparison);
    return bounds;
}
