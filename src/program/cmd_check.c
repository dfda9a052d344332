#include <math.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "drive/signal.h"
#include "network/dynamics.h"
#include "program/program.h"

/* Rows of all runs that a check keeps as its reference. */
enum { MOST_ROWS = DEA_SAMPLES_MAX, COLUMNS = 5 };

/* Numbers below this share of a column's largest reference value are compared with that instead of with themselves. */
static const double negligible = 1e-9;

/* How the difference of two numbers counts. */
typedef enum dea_measure {
    DEA_OVER_ITSELF, /* relative to the reference's own number */
    DEA_OVER_PEAK,   /* relative to the largest of its column over the run */
    DEA_OVER_RADIAN  /* an angle in degrees: absolute, in radian, whole turns taken off */
} dea_measure;

/* One compared column: where it lies in a row, and how. */
typedef struct dea_compared {
    size_t column; /* of the layout */
    dea_measure measure;
    const char *head;
} dea_compared;

/* The reference points of one model, and what a second engine's points differ by. */
typedef struct dea_comparison {
    const dea_scene *scene;
    dea_layout layout;
    dea_compared columns[COLUMNS];
    size_t column_count;
    char *reference; /* points as the layout has them */
    size_t points;
    bool filling;          /* points are the reference itself */
    double least[COLUMNS]; /* magnitude that samples of a transient can miss altogether, where they fall between pulses */
    double scale[COLUMNS]; /* largest magnitude in the reference */
    double worst[COLUMNS]; /* largest difference */
    size_t states;         /* rows whose states differ */
    size_t failed;         /* rows not solved */
    double error;          /* largest error that the engine estimates, NAN: it does not tell */
    double residual;       /* largest residual of its energy balance, NAN */
} dea_comparison;

/* Figures of one check over all its scenes. */
typedef struct dea_tally {
    size_t disagreed, failed, unusable;
} dea_tally;

/* Columns that engines must agree on. Velocity and current of a film without mass or resistance are peaks at edges, which no
 * sample tells. */
static void choose_columns(dea_comparison *comparison)
{
    static const struct {
        dea_study_kind study;
        size_t offset;
        dea_measure measure;
        const char *head;
    } known[] = {
        {DEA_STUDY_SWEEP, offsetof(dea_row, strain), DEA_OVER_ITSELF, "strain"},
        {DEA_STUDY_SWEEP, offsetof(dea_row, displacement), DEA_OVER_ITSELF, "displacement"},
        {DEA_STUDY_SWEEP, offsetof(dea_row, force), DEA_OVER_ITSELF, "force"},
        {DEA_STUDY_SWEEP, offsetof(dea_row, field), DEA_OVER_ITSELF, "field"},
        {DEA_STUDY_TRANSIENT, offsetof(dea_sample, displacement), DEA_OVER_PEAK, "displacement"},
        {DEA_STUDY_TRANSIENT, offsetof(dea_sample, strain), DEA_OVER_PEAK, "strain"},
        {DEA_STUDY_TRANSIENT, offsetof(dea_sample, force), DEA_OVER_PEAK, "force"},
        {DEA_STUDY_TRANSIENT, offsetof(dea_sample, charge), DEA_OVER_PEAK, "charge"},
        {DEA_STUDY_TRANSIENT, offsetof(dea_sample, focal_length), DEA_OVER_PEAK, "focal_length"},
        {DEA_STUDY_AC, offsetof(dea_response, displacement), DEA_OVER_ITSELF, "displacement"},
        {DEA_STUDY_AC, offsetof(dea_response, displacement_phase), DEA_OVER_RADIAN, "phase"},
        {DEA_STUDY_AC, offsetof(dea_response, impedance), DEA_OVER_ITSELF, "impedance"},
        {DEA_STUDY_AC, offsetof(dea_response, impedance_phase), DEA_OVER_RADIAN, "phase"},
    };
    for (size_t i = 0; i < sizeof known / sizeof *known; i++) {
        for (size_t k = 0; known[i].study == comparison->scene->study && k < comparison->layout.column_count; k++) {
            if (comparison->layout.columns[k].offset == known[i].offset) {
                comparison->columns[comparison->column_count++] = (dea_compared){k, known[i].measure, known[i].head};
            }
        }
    }
}

static double value_of(const dea_comparison *comparison, const char *row, size_t number)
{
    double value;
    memcpy(&value, row + comparison->layout.columns[comparison->columns[number].column].offset, sizeof value);
    return value;
}

/* A hundredth of what the largest voltage of the run would do at rest. */
static void set_least(dea_comparison *comparison)
{
    dea_dynamics dynamics;
    dea_signal signal = {0};
    const dea_scene *scene = comparison->scene;
    if (dea_dynamics_open(scene, scene->models[0], &dynamics, NULL) == DEA_OK &&
        dea_signal_open(scene, &signal, NULL) == DEA_OK && signal.largest > 0.0) {
        const double u = dea_dynamics_scale(&dynamics, signal.largest);
        const dea_edge at = dea_dynamics_edge(&dynamics, 0.0);
        const dea_sample swing = {.displacement = u,
                                  .strain = u / dynamics.radius,
                                  .force = fabs(at.push) * signal.largest * signal.largest,
                                  .charge = at.capacitance * signal.largest,
                                  .focal_length = fmax(0.0, dynamics.focal_length)};
        for (size_t c = 0; c < comparison->column_count; c++) {
            comparison->least[c] = 0.01 * value_of(comparison, (const char *)&swing, c);
        }
    }
    dea_signal_close(&signal);
    dea_dynamics_close(&dynamics);
}

/* Largest magnitude of a column over the rows of a point. */
static double peak_of(const dea_comparison *comparison, const char *point, size_t number)
{
    double peak = 0.0;
    for (size_t i = 0; i < comparison->layout.rows; i++) {
        peak = fmax(peak, fabs(value_of(comparison, point + i * comparison->layout.row_size, number)));
    }
    return peak;
}

static double angle_between(double a, double b)
{
    return fabs(remainder(a - b, 360.0)) * DEA_PI / 180.0;
}

/* |a - b| over @p scale, with b the reference; a number that only one of them has differs without bound. */
static double difference(dea_measure measure, double a, double b, double scale, double peak)
{
    if (isnan(a) && isnan(b)) {
        return 0.0;
    }
    const double gap = measure == DEA_OVER_RADIAN ? angle_between(a, b) : fabs(a - b);
    if (gap <= 0.0) {
        return 0.0;
    }
    const double over = measure == DEA_OVER_RADIAN ? 1.0
                        : measure == DEA_OVER_PEAK ? fmax(peak, negligible * scale)
                                                   : fmax(fabs(b), negligible * scale);
    return isfinite(gap) ? gap / over : (double)INFINITY;
}

static bool is_failed(const dea_comparison *comparison, const char *row)
{
    return dea_layout_state(&comparison->layout, row) == DEA_STATE_FAILED;
}

/* Rows that one of the two did not solve are counted elsewhere: they are no disagreement. */
static void compare_rows(dea_comparison *comparison, const char *point, const char *reference, const double peaks[COLUMNS])
{
    const dea_layout *layout = &comparison->layout;
    for (size_t i = 0; i < layout->rows; i++) {
        const char *row = point + i * layout->row_size, *wanted = reference + i * layout->row_size;
        if (is_failed(comparison, row) || is_failed(comparison, wanted)) {
            continue;
        }
        if (dea_layout_state(layout, row) != dea_layout_state(layout, wanted)) {
            comparison->states++;
            continue;
        }
        for (size_t c = 0; c < comparison->column_count; c++) {
            const double found = difference(comparison->columns[c].measure, value_of(comparison, row, c),
                                            value_of(comparison, wanted, c), comparison->scale[c], peaks[c]);
            comparison->worst[c] = fmax(comparison->worst[c], found);
        }
    }
}

static void take_point(dea_comparison *comparison, size_t number, const char *point)
{
    const dea_layout *layout = &comparison->layout;
    char *reference = comparison->reference + number * layout->point_size;
    for (size_t i = 0; i < layout->rows; i++) {
        comparison->failed += is_failed(comparison, point + i * layout->row_size) ? 1 : 0;
    }
    if (comparison->scene->study == DEA_STUDY_TRANSIENT) {
        dea_summary summary;
        memcpy(&summary, point + layout->rows * layout->row_size, sizeof summary);
        comparison->error = fmax(comparison->error, summary.error);
        comparison->residual = fmax(comparison->residual, summary.residual);
    }
    double peaks[COLUMNS];
    if (comparison->filling) {
        memcpy(reference, point, layout->point_size);
    }
    for (size_t c = 0; c < comparison->column_count; c++) {
        peaks[c] = fmax(peak_of(comparison, reference, c), comparison->least[c]);
        comparison->scale[c] = fmax(comparison->scale[c], peaks[c]);
    }
    if (!comparison->filling) {
        compare_rows(comparison, point, reference, peaks);
    }
}

static dea_status take_points(void *user, size_t first, const void *points, size_t count, dea_error *error)
{
    dea_comparison *comparison = user;
    if (count > comparison->points - first) {
        return dea_fail(error, DEA_ERROR_ENGINE, "more points than the study has");
    }
    for (size_t i = 0; i < count; i++) {
        take_point(comparison, first + i, (const char *)points + i * comparison->layout.point_size);
    }
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
    for (size_t c = 0; c < comparison->column_count; c++) {
        all = all && comparison->worst[c] <= tolerance;
    }
    return all;
}

static void print_heading(const char *path, const dea_comparison *comparison, double tolerance)
{
    const dea_scene *scene = comparison->scene;
    const bool sweep = scene->study == DEA_STUDY_SWEEP;
    printf("%s: %s (%s), %zu %s%s", path, scene->models[0]->name, scene->models[0]->equation, comparison->points,
           sweep ? "point" : "run", comparison->points == 1 ? "" : "s");
    if (!sweep) {
        printf(" of %zu %s", comparison->layout.rows, scene->study == DEA_STUDY_AC ? "frequencies" : "samples");
    }
    printf(", tolerance %g\n  %-10s %9s %9s", tolerance, "engine", "time_s", sweep ? "us/point" : "us/run");
    for (size_t c = 0; c < comparison->column_count; c++) {
        printf(" %12s", comparison->columns[c].head);
    }
    printf(" %8s", "states");
    if (scene->study == DEA_STUDY_TRANSIENT) {
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
    if (comparison->filling) {
        printf(" %8s", "-");
    } else {
        printf(" %8zu", comparison->states);
    }
    if (comparison->scene->study == DEA_STUDY_TRANSIENT) {
        print_cell(9, true, comparison->error);
        print_cell(9, true, comparison->residual);
    }
    printf("  %s\n", verdict);
}

static const char *judge(const dea_comparison *comparison, double tolerance, dea_tally *tally)
{
    const char *verdict = comparison->filling ? "reference" : "agrees";
    if (!comparison->filling && !agrees(comparison, tolerance)) {
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
                                     .user = comparison};
    const double start = dea_seconds();
    const dea_status status = dea_study_run(comparison->scene, engine, &options, &error);
    const double seconds = dea_seconds() - start;
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

static bool takes_part(const dea_arguments *arguments, const dea_engine *engine, size_t index)
{
    return index == 0 || !arguments->engine || strcmp(arguments->engine, engine->name) == 0;
}

static void forget(dea_comparison *comparison)
{
    memset(comparison->worst, 0, sizeof comparison->worst);
    comparison->states = 0;
    comparison->failed = 0;
    comparison->error = (double)NAN;
    comparison->residual = (double)NAN;
}

static void check_engines(const dea_arguments *arguments, dea_comparison *comparison, double tolerance, dea_tally *tally)
{
    const dea_scene *scene = comparison->scene;
    for (size_t i = 0; i < dea_engine_count() && dea_signals_caught() == 0; i++) {
        const dea_engine *engine = dea_engine_at(i);
        if (!takes_part(arguments, engine, i)) {
            continue;
        }
        const char *why = dea_engine_refuses(engine, scene, scene->models[0]);
        forget(comparison);
        if (why && !arguments->quiet) {
            printf("  %-10s cannot: %s\n", engine->name, why);
        }
        if (!why && check_engine(arguments, engine, comparison, tolerance, tally)) {
            comparison->filling = false;
        }
        fflush(stdout);
    }
}

/* Checks the first model of the scene. */
static void check_model(const dea_arguments *arguments, const char *path, const dea_scene *scene, double tolerance,
                        dea_tally *tally)
{
    dea_comparison comparison = {
        .scene = scene, .layout = dea_layout_of(scene), .points = dea_scene_point_count(scene), .filling = true};
    choose_columns(&comparison);
    if (scene->study == DEA_STUDY_TRANSIENT) {
        set_least(&comparison);
    }
    comparison.reference = malloc(comparison.points * comparison.layout.point_size);
    if (!comparison.reference) {
        dea_complain("out of memory for %zu points", comparison.points);
        tally->failed++;
        return;
    }
    if (!arguments->quiet) {
        print_heading(path, &comparison, tolerance);
    }
    check_engines(arguments, &comparison, tolerance, tally);
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
    const size_t rows = dea_scene_point_count(&scene) * dea_layout_of(&scene).rows;
    if (rows > MOST_ROWS) {
        dea_complain("%s: a check keeps its reference in memory and takes at most %d rows; this study has %zu, give it fewer",
                     path, MOST_ROWS, rows);
        tally->unusable++;
        dea_scene_free(&scene);
        return;
    }
    const double both = scene.study == DEA_STUDY_TRANSIENT ? 2.0 : 1.0; /* each engine may be off by the accuracy */
    const double tolerance = isnan(arguments->tolerance) ? both * scene.accuracy : arguments->tolerance;
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
    for (size_t i = 0; i < arguments->operand_count && dea_signals_caught() == 0; i++) {
        check_scene(arguments, arguments->operands[i].path, &tally);
    }
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
            "states differ. In a transient the difference is relative to the largest value\n"
            "of the run, and the columns estimate and balance show what the engine itself\n"
            "says of its error and of its energy balance. Phases differ in radian.\n"
            "\n"
            "      --tolerance T     difference that still agrees; default: the scene's accuracy,\n"
            "                        in a transient twice that, as both engines may be off by it\n"
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
