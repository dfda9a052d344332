#include <math.h>
#include <stdint.h>
#include <stdio.h>
#include <string.h>

#include "program/omissions.h"
#include "program/program.h"
#include "result/compare.h"
#include "study/study.h"
#include "support/clock.h"

/* Rows of all runs that a check keeps as its reference. */
enum { MOST_ROWS = DEA_SAMPLES_MAX };

/* Figures of one check over all its scenes. */
typedef struct dea_tally {
    size_t disagreed, failed, unusable;
    size_t broken; /* bounds of what is left out */
} dea_tally;

static dea_status take_points(void *user, size_t first, const void *points, size_t count, dea_error *error)
{
    return dea_comparison_take(user, first, points, count, error);
}

static void take_log(void *user, const char *line)
{
    (void)user;
    dea_complain("%s", line);
}

static void print_heading(const char *path, const dea_comparison *comparison, double tolerance)
{
    const dea_scene *scene = comparison->scene;
    const dea_study *study = dea_study_of(scene);
    printf("%s: %s (%s), %zu %s", path, scene->models[0]->name, scene->models[0]->equation, comparison->points,
           study->points[comparison->points != 1]);
    if (study->along) {
        printf(" of %zu %s", comparison->layout.rows, study->rows[1]);
    }
    char each[16];
    snprintf(each, sizeof each, "us/%s", study->points[0]);
    printf(", tolerance %g\n  %-10s %9s %9s", tolerance, "engine", "time_s", each);
    for (size_t c = 0; c < comparison->column_count; c++) {
        printf(" %12s", comparison->columns[c].head);
    }
    if (scene->transient.average_count > 0) {
        printf(" %12s", "mean");
    }
    if (study->timed) {
        printf(" %9s", "resonance");
    }
    printf(" %8s", "states");
    if (study->timed) {
        printf(" %9s %9s", "estimate", "balance");
    }
    puts("  verdict");
}

/* A number of the table, "-" where there is none. */
static void print_cell(int width, bool given, double value)
{
    if (given && !isnan(value)) {
        printf(" %*.2g", width, value);
    } else {
        printf(" %*s", width, "-");
    }
}

static void print_line(const dea_engine *engine, const dea_comparison *comparison, double seconds, const char *verdict)
{
    printf("  %-10s %9.3g %9.3g", engine->name, seconds, 1e6 * seconds / (double)comparison->points);
    for (size_t c = 0; c < comparison->column_count; c++) {
        print_cell(12, !comparison->filling, comparison->worst[c]);
    }
    if (comparison->scene->transient.average_count > 0) {
        print_cell(12, !comparison->filling, comparison->mean);
    }
    if (dea_study_of(comparison->scene)->timed) {
        print_cell(9, !comparison->filling, comparison->swing);
    }
    if (comparison->filling) {
        printf(" %8s", "-");
    } else {
        printf(" %8zu", comparison->states);
    }
    if (dea_study_of(comparison->scene)->timed) {
        print_cell(9, true, comparison->error);
        print_cell(9, true, comparison->residual);
    }
    printf("  %s\n", verdict);
}

static const char *judge(const dea_comparison *comparison, double tolerance, dea_tally *tally)
{
    const char *verdict = comparison->filling ? "reference" : "agrees";
    if (!comparison->filling && (comparison->states > 0 || !(dea_comparison_worst(comparison) <= tolerance))) {
        tally->disagreed++;
        verdict = "DISAGREES";
    }
    if (comparison->failed > 0) {
        tally->failed++;
        verdict = comparison->filling ? "reference, not all points solved" : "FAILED";
    }
    return verdict;
}

/* Runs one engine on one model; the first that is fine becomes the reference. */
static bool check_engine(const dea_arguments *arguments, const dea_engine *engine, dea_comparison *comparison, double tolerance,
                         dea_tally *tally)
{
    dea_error error = {0};
    const dea_run_options options = {.jobs = arguments->jobs ? arguments->jobs : 1,
                                     .points = take_points,
                                     .log = take_log,
                                     .stop = dea_signals_stop,
                                     .apart = true,
                                     .user = comparison};
    const double start = dea_clock();
    const dea_status status = dea_study_run(comparison->scene, engine, &options, &error);
    const double seconds = dea_clock() - start;
    if (status != DEA_OK) {
        tally->failed++;
        dea_complain_error(&error);
        if (!arguments->quiet && dea_signals_caught() == 0) {
            printf("  %-10s failed\n", engine->name);
        }
        return false;
    }
    const char *verdict = judge(comparison, tolerance, tally);
    if (!arguments->quiet) {
        print_line(engine, comparison, seconds, verdict);
    }
    return true;
}

static void check_engines(const dea_arguments *arguments, dea_comparison *comparison, double tolerance, dea_tally *tally)
{
    const dea_scene *scene = comparison->scene;
    for (size_t i = 0; i < dea_engine_count() && dea_signals_caught() == 0; i++) {
        const dea_engine *engine = dea_engine_at(i);
        if (i > 0 && !dea_engine_named(scene, engine)) {
            continue;
        }
        const char *why = dea_engine_refuses(engine, scene, scene->models[0]);
        dea_comparison_forget(comparison);
        if (why && !arguments->quiet) {
            printf("  %-10s cannot: %s\n", engine->name, why);
        }
        if (!why && check_engine(arguments, engine, comparison, tolerance, tally)) {
            comparison->filling = false;
        }
        fflush(stdout);
    }
}

static void count_bounds(const char *path, dea_bounds bounds, dea_tally *tally)
{
    tally->broken += bounds.broken;
    if (bounds.unjudged > 0) {
        dea_complain("%s: %zu bound%s not judged", path, bounds.unjudged, bounds.unjudged == 1 ? " was" : "s were");
    }
}

/* Checks the first model of the scene. */
static void check_model(const dea_arguments *arguments, const char *path, const dea_scene *scene, double tolerance,
                        dea_tally *tally)
{
    dea_error error = {0};
    dea_comparison comparison;
    if (dea_comparison_open(&comparison, scene, &error) != DEA_OK) {
        dea_complain_error(&error);
        tally->failed++;
        return;
    }
    if (!arguments->quiet) {
        print_heading(path, &comparison, tolerance);
    }
    check_engines(arguments, &comparison, tolerance, tally);
    dea_comparison_close(&comparison);
    if (!arguments->full && dea_signals_caught() == 0) {
        count_bounds(path, dea_check_omissions(arguments, scene), tally);
    }
}

static void check_scene(const dea_arguments *arguments, const char *path, dea_tally *tally)
{
    dea_scene scene;
    dea_exit outcome = DEA_EXIT_USAGE;
    if (!dea_scene_open(arguments, path, &scene, &outcome)) {
        tally->unusable += outcome == DEA_EXIT_USAGE ? 1 : 0;
        tally->failed += outcome == DEA_EXIT_FAILED ? 1 : 0;
        return;
    }
    const size_t rows = dea_scene_point_count(&scene) * dea_layout_of(&scene).rows;
    if (rows > MOST_ROWS) {
        dea_complain("%s: a check keeps its reference in memory and takes at most %d rows; this study has %zu, give it fewer",
                     path, MOST_ROWS, rows);
        tally->unusable++;
        dea_scene_free(&scene);
        return;
    }
    dea_model_choice choice;
    const bool automatic = scene.automatic;
    const size_t named = arguments->engine ? scene.engine_count : 0; /* a check runs all but those that the command line leaves out */
    scene.engine_count = 0;
    if (!dea_model_settle(&scene, NULL, arguments->quiet, &choice, &outcome)) {
        tally->unusable++;
        dea_scene_free(&scene);
        return;
    }
    scene.engine_count = named;
    const double both = dea_study_of(&scene)->timed ? 2.0 : 1.0; /* each engine may be off by the accuracy */
    const double tolerance = isnan(arguments->tolerance) ? both * scene.accuracy : arguments->tolerance;
    for (size_t i = 0; i < scene.model_count && dea_signals_caught() == 0; i++) {
        dea_scene alone = scene;
        alone.models[0] = scene.models[i];
        alone.model_count = 1;
        check_model(arguments, path, &alone, tolerance, tally);
    }
    if (automatic && dea_signals_caught() == 0) {
        count_bounds(path, dea_check_choice(arguments, &scene, &choice), tally);
    }
    dea_scene_free(&scene);
}

static dea_exit run(const dea_arguments *arguments)
{
    dea_tally tally = {0};
    dea_signals_catch();
    for (size_t i = 0; i < arguments->operand_count && dea_signals_caught() == 0; i++) {
        check_scene(arguments, arguments->operands[i].path, &tally);
    }
    if (tally.disagreed > 0) {
        dea_complain("the engines disagree in %zu comparison%s", tally.disagreed, tally.disagreed == 1 ? "" : "s");
    }
    if (tally.broken > 0) {
        dea_complain("%zu bound%s of what is left out broken", tally.broken, tally.broken == 1 ? " is" : "s are");
    }
    if (tally.disagreed + tally.broken > 0) {
        return DEA_EXIT_DISAGREED;
    }
    return tally.failed > 0 ? DEA_EXIT_FAILED : tally.unusable > 0 ? DEA_EXIT_USAGE : DEA_EXIT_DONE;
}

const dea_command dea_command_check = {
    .name = "check",
    .summary = "the same study by every engine that can do it, side by side",
    .help = "Usage: deaspice check [OPTION]... SCENE...\n"
            "\n"
            "Solves the study of each scene by every engine that can do it, model by model,\n"
            "and compares the rows with those of the first engine. The columns show the\n"
            "largest relative difference of each quantity and the number of rows whose\n"
            "states differ. In a transient the difference is relative to the largest value\n"
            "of the run, also that of a mean (velocity and current: no less than displacement\n"
            "and charge over the run's fastest time). Displacement and strain must agree\n"
            "within the tolerance, the other columns within ten times that. The columns\n"
            "estimate and balance show what the engine itself says of its error and of its\n"
            "energy balance. Phases differ in radian; that of a zero does not count.\n"
            "\n"
            "Of a transient that leaves out parts of the network, each omission is measured\n"
            "against its bound, by runs at two accuracies: where their difference hides\n"
            "the bound it is not judged. Of a model that `auto` chose, its model error.\n"
            "\n"
            "--engine leaves out all others but direct. There is one job unless --jobs says\n"
            "more, so that the times of the engines compare.\n"
            "\n",
    .further = "Exit status: 0 all agree, 1 an engine failed, 2 usage or a bad scene, 3 they\n"
               "disagree or a bound is broken.\n"
               "\n"
               "Example:\n"
               "  deaspice check examples/*.yaml\n",
    .takes = DEA_TAKES_ENGINE | DEA_TAKES_SCENE | DEA_TAKES_JOBS | DEA_TAKES_QUIET | DEA_TAKES_TOLERANCE | DEA_TAKES_FULL,
    .least = 1,
    .most = SIZE_MAX,
    .files = ".yaml",
    .run = run,
};
