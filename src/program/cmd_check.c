#include <math.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "program/program.h"

enum { MOST_POINTS = 1000000 };

/* Numbers below this share of a column's largest reference value are compared with that instead of with themselves. */
static const double negligible = 1e-9;

/* The reference rows of one model, and what a second engine's rows differ by. */
typedef struct dea_comparison {
    dea_row *reference; /* points rows */
    size_t points;
    bool filling;                  /* rows are the reference itself */
    double scale[DEA_ROW_COLUMNS]; /* largest magnitude in the reference */
    double worst[DEA_ROW_COLUMNS]; /* largest relative difference */
    size_t states;                 /* rows whose states differ */
    size_t failed;                 /* rows not solved */
} dea_comparison;

/* Figures of one check over all its scenes. */
typedef struct dea_tally {
    size_t disagreed, failed, unusable;
} dea_tally;

static double column_of(const dea_row *row, size_t column)
{
    double value;
    memcpy(&value, (const char *)row + dea_row_columns[column].offset, sizeof value);
    return value;
}

static void fill(dea_comparison *comparison, size_t first, const dea_row *rows, size_t count)
{
    memcpy(comparison->reference + first, rows, count * sizeof *rows);
    for (size_t i = 0; i < count; i++) {
        for (size_t c = 0; c < DEA_ROW_COLUMNS; c++)
            comparison->scale[c] = fmax(comparison->scale[c], fabs(column_of(&rows[i], c)));
    }
}

/* |a - b|/|b|, with b the reference; a number that only one of them has differs without bound. */
static double difference(double a, double b, double scale)
{
    if (isnan(a) && isnan(b))
        return 0;
    double gap = fabs(a - b);
    if (gap <= 0)
        return 0;
    return isfinite(gap) ? gap / fmax(fabs(b), negligible * scale) : INFINITY;
}

static void compare(dea_comparison *comparison, size_t first, const dea_row *rows, size_t count)
{
    for (size_t i = 0; i < count; i++) {
        const dea_row *reference = &comparison->reference[first + i];
        if (rows[i].state != reference->state) {
            comparison->states++;
            continue;
        }
        for (size_t c = 0; c < DEA_ROW_COLUMNS; c++) {
            double found = difference(column_of(&rows[i], c), column_of(reference, c), comparison->scale[c]);
            comparison->worst[c] = fmax(comparison->worst[c], found);
        }
    }
}

static dea_status take_rows(void *user, size_t first, const dea_row *rows, size_t count, dea_error *error)
{
    dea_comparison *comparison = user;
    if (count > comparison->points - first)
        return dea_fail(error, DEA_ERROR_ENGINE, "more rows than points");
    for (size_t i = 0; i < count; i++)
        comparison->failed += rows[i].state == DEA_STATE_FAILED ? 1 : 0;
    if (comparison->filling)
        fill(comparison, first, rows, count);
    else
        compare(comparison, first, rows, count);
    return DEA_OK;
}

static void take_log(void *user, const char *line)
{
    (void)user;
    dea_complain("%s", line);
}

static bool agrees(const dea_comparison *comparison, double tolerance)
{
    bool all = comparison->states == 0;
    for (size_t c = 0; c < DEA_ROW_COLUMNS; c++)
        all = all && comparison->worst[c] <= tolerance;
    return all;
}

static void print_heading(const char *path, const dea_scene *scene, const dea_model *model, double tolerance)
{
    const size_t points = dea_scene_point_count(scene);
    printf("%s: %s (%s), %zu point%s, tolerance %g\n", path, model->name, model->equation, points, points == 1 ? "" : "s",
           tolerance);
    printf("  %-10s %9s %9s", "engine", "time_s", "us/point");
    for (size_t c = 0; c < DEA_ROW_COLUMNS; c++)
        printf(" %12.*s", (int)strcspn(dea_row_columns[c].name, "_"), dea_row_columns[c].name);
    printf(" %8s  %s\n", "states", "verdict");
}

static void print_line(const dea_engine *engine, const dea_comparison *comparison, double seconds, const char *verdict)
{
    printf("  %-10s %9.3g %9.3g", engine->name, seconds, 1e6 * seconds / (double)comparison->points);
    for (size_t c = 0; c < DEA_ROW_COLUMNS; c++) {
        if (comparison->filling)
            printf(" %12s", "-");
        else
            printf(" %12.2g", comparison->worst[c]);
    }
    if (comparison->filling)
        printf(" %8s", "-");
    else
        printf(" %8zu", comparison->states);
    printf("  %s\n", verdict);
}

/* Runs one engine on one model; the first that is fine becomes the reference. */
static bool check_engine(const dea_arguments *arguments, const dea_scene *scene, const dea_engine *engine,
                         dea_comparison *comparison, double tolerance, dea_tally *tally)
{
    dea_error error = {0};
    dea_run_options options = {.jobs = arguments->jobs ? arguments->jobs : 1,
                               .rows = take_rows,
                               .log = take_log,
                               .stop = dea_signals_stop,
                               .user = comparison};
    double start = dea_seconds();
    dea_status status = dea_study_run(scene, engine, &options, &error);
    double seconds = dea_seconds() - start;
    if (status != DEA_OK) {
        tally->failed++;
        dea_complain_error(&error);
        if (!arguments->quiet && dea_signals_caught() == 0)
            printf("  %-10s failed\n", engine->name);
        return false;
    }
    const char *verdict = comparison->filling ? "reference" : "agrees";
    if (!comparison->filling && !agrees(comparison, tolerance)) {
        tally->disagreed++;
        verdict = "DISAGREES";
    }
    if (comparison->failed > 0) {
        tally->failed++;
        verdict = comparison->filling ? "reference, not all points solved" : "FAILED";
    }
    if (!arguments->quiet)
        print_line(engine, comparison, seconds, verdict);
    return true;
}

static bool takes_part(const dea_arguments *arguments, const dea_engine *engine, size_t index)
{
    return index == 0 || !arguments->engine || strcmp(arguments->engine, engine->name) == 0;
}

static void forget(dea_comparison *comparison)
{
    memset(comparison->worst, 0, sizeof comparison->worst);
    comparison->states = 0;
    comparison->failed = 0;
}

static void check_model(const dea_arguments *arguments, const char *path, const dea_scene *scene, double tolerance,
                        dea_tally *tally)
{
    const dea_model *model = scene->models[0];
    dea_comparison comparison = {.points = dea_scene_point_count(scene), .filling = true};
    comparison.reference = malloc(comparison.points * sizeof *comparison.reference);
    if (!comparison.reference) {
        dea_complain("out of memory for %zu points", comparison.points);
        tally->failed++;
        return;
    }
    if (!arguments->quiet)
        print_heading(path, scene, model, tolerance);
    for (size_t i = 0; i < dea_engine_count() && dea_signals_caught() == 0; i++) {
        const dea_engine *engine = dea_engine_at(i);
        const char *why = engine->refuses ? engine->refuses(scene, model) : NULL;
        if (!takes_part(arguments, engine, i))
            continue;
        forget(&comparison);
        if (why && !arguments->quiet)
            printf("  %-10s cannot: %s\n", engine->name, why);
        if (!why && check_engine(arguments, scene, engine, &comparison, tolerance, tally))
            comparison.filling = false;
        fflush(stdout);
    }
    free(comparison.reference);
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
    if (dea_scene_point_count(&scene) > MOST_POINTS) {
        dea_complain("%s: a check keeps its reference in memory and takes at most %d points; this study has %zu, give it fewer",
                     path, MOST_POINTS, dea_scene_point_count(&scene));
        tally->unusable++;
        dea_scene_free(&scene);
        return;
    }
    double tolerance = isnan(arguments->tolerance) ? scene.accuracy : arguments->tolerance;
    for (size_t i = 0; i < scene.model_count && dea_signals_caught() == 0; i++) {
        dea_scene alone = scene;
        alone.models[0] = scene.models[i];
        alone.model_count = 1;
        check_model(arguments, path, &alone, tolerance, tally);
    }
    dea_scene_free(&scene);
}

static dea_exit run(const dea_arguments *arguments)
{
    dea_tally tally = {0};
    dea_signals_catch();
    for (size_t i = 0; i < arguments->operand_count && dea_signals_caught() == 0; i++)
        check_scene(arguments, arguments->operands[i].path, &tally);
    if (tally.disagreed > 0) {
        dea_complain("the engines disagree in %zu comparison%s", tally.disagreed, tally.disagreed == 1 ? "" : "s");
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
            "states differ.\n"
            "\n"
            "      --tolerance T     difference that still agrees; default: the scene's accuracy\n"
            "      --engine E        compare only this engine with the first\n"
            "      --model M         model instead of the scene's; several with commas between\n"
            "      --set KEY=VALUE   change a value of the scene; may be repeated\n"
            "  -j, --jobs N          worker processes, auto: one per core; default 1, so that\n"
            "                        the times of the engines compare\n"
            "  -q, --quiet           no table\n"
            "  -h, --help            this text\n"
            "  -V, --version         the version\n"
            "\n"
            "Exit status: 0 all agree, 1 an engine failed, 2 usage or a bad scene, 3 they\n"
            "disagree.\n"
            "\n"
            "Example:\n"
            "  deaspice check examples/*.yaml\n",
    .takes = DEA_TAKES_ENGINE | DEA_TAKES_SCENE | DEA_TAKES_JOBS | DEA_TAKES_QUIET | DEA_TAKES_TOLERANCE,
    .least = 1,
    .most = SIZE_MAX,
    .run = run,
};
