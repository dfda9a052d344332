#include <stdio.h>
#include <string.h>
#include <unistd.h>

#include "deaspice/output.h"
#include "deaspice/plot.h"
#include "output/progress.h"
#include "program/findings.h"
#include "program/program.h"

/* Everyone who listens to the points of a run. */
typedef struct dea_audience {
    dea_writer *writer; /* NULL: none */
    dea_plot *plot;     /* NULL: none */
    dea_progress *progress;
    dea_findings findings;
} dea_audience;

static dea_status take_points(void *user, size_t first, const void *points, size_t count, dea_error *error)
{
    dea_audience *audience = user;
    if (audience->findings.averages) {
        dea_progress_clear(audience->progress); /* they may go to the same terminal */
    }
    dea_findings_take(&audience->findings, first, points, count);
    const dea_status status = audience->writer ? dea_writer_points(audience->writer, first, points, count, error) : DEA_OK;
    if (status == DEA_OK && audience->plot) {
        dea_plot_points(audience->plot, first, points, count);
    }
    return status;
}

static void take_log(void *user, const char *line)
{
    const dea_audience *audience = user;
    dea_progress_clear(audience->progress);
    dea_complain("%s", line);
}

static void take_progress(void *user, size_t done, size_t total)
{
    const dea_audience *audience = user;
    dea_progress_show(audience->progress, done, total);
}

/* Does the result itself go to standard output? */
static bool is_straight(const dea_arguments *arguments)
{
    const char *output = arguments->output;
    return output ? strcmp(output, "-") == 0 || strcmp(output, "/dev/stdout") == 0 : !arguments->plot;
}

/* Averages go to standard output, or beside it where that holds the result. */
static FILE *averages_stream(const dea_arguments *arguments)
{
    return !is_straight(arguments) ? stdout : arguments->quiet ? NULL : stderr;
}

static dea_status open_audience(const dea_arguments *arguments, const dea_scene *scene, const dea_engine *engine,
                                dea_audience *audience, dea_error *error)
{
    const char *output = arguments->output ? arguments->output : arguments->plot ? NULL : "-";
    dea_status status = DEA_OK;
    if (output) {
        status = dea_writer_open(scene, engine->name, output, arguments->format, &audience->writer, error);
    }
    if (status == DEA_OK && arguments->plot) {
        status = dea_plot_begin(scene, arguments->plot, &audience->plot, error);
    }
    if (status == DEA_OK) {
        audience->findings = dea_findings_begin(scene, averages_stream(arguments));
    }
    return status;
}

/* Ends outputs: kept when all went well, else removed. The first failure counts. */
static dea_status close_audience(dea_audience *audience, dea_status status, dea_error *error)
{
    dea_progress_end(audience->progress);
    const dea_status written = dea_writer_finish(audience->writer, status == DEA_OK, status == DEA_OK ? error : NULL);
    if (status == DEA_OK) {
        status = written;
    }
    const dea_status plotted = dea_plot_finish(audience->plot, status == DEA_OK, status == DEA_OK ? error : NULL);
    return status != DEA_OK ? status : plotted;
}

static void tell_interrupted(const dea_audience *audience, const dea_arguments *arguments)
{
    const bool straight = audience->writer && is_straight(arguments);
    if (dea_signals_caught() != 0 && !dea_signals_broken_pipe()) {
        dea_complain("%s", straight ? "interrupted" : "interrupted, nothing written");
    }
}

static dea_exit tell_findings(const dea_arguments *arguments, const dea_scene *scene, const dea_engine *engine,
                              const dea_findings *findings, double seconds)
{
    const size_t failed = findings->states[DEA_STATE_FAILED];
    if (!arguments->quiet && (arguments->output || arguments->plot || isatty(STDERR_FILENO))) {
        dea_findings_print(findings, engine, seconds);
    }
    if (failed > 0) {
        dea_complain("%zu %s were not solved", failed, scene->study == DEA_STUDY_SWEEP ? "points" : "rows");
    }
    return failed > 0 ? DEA_EXIT_FAILED : DEA_EXIT_DONE;
}

static dea_exit run_scene(const dea_arguments *arguments, const dea_scene *scene, const dea_engine *engine)
{
    dea_error error = {0};
    dea_audience audience = {0};
    dea_signals_catch();
    dea_status status = open_audience(arguments, scene, engine, &audience, &error);
    audience.progress = arguments->quiet ? NULL : dea_progress_begin();
    const dea_run_options options = {.jobs = arguments->jobs ? arguments->jobs : dea_core_count(),
                                     .full = arguments->full,
                                     .points = take_points,
                                     .progress = take_progress,
                                     .log = take_log,
                                     .stop = dea_signals_stop,
                                     .user = &audience};
    const double start = dea_seconds();
    if (status == DEA_OK) {
        status = dea_study_run(scene, engine, &options, &error);
    }
    const double seconds = dea_seconds() - start;
    if (status != DEA_OK && dea_signals_caught()) {
        tell_interrupted(&audience, arguments);
    }
    status = close_audience(&audience, status, &error);
    if (status == DEA_OK) {
        return tell_findings(arguments, scene, engine, &audience.findings, seconds);
    }
    const dea_exit outcome = dea_complain_error(&error);
    return audience.findings.states[DEA_STATE_FAILED] > 0 ? DEA_EXIT_FAILED : outcome; /* why there is nothing to draw */
}

static dea_exit run(const dea_arguments *arguments)
{
    const dea_engine *engine = dea_engine_choose(arguments->engine ? arguments->engine : "ngspice");
    dea_scene scene;
    dea_exit outcome = DEA_EXIT_USAGE;
    if (arguments->plot && arguments->output && strcmp(arguments->plot, arguments->output) == 0) {
        dea_complain("%s is the target of both the result and the plot", arguments->plot);
        return DEA_EXIT_USAGE;
    }
    if (!engine || !dea_scene_open(arguments, arguments->operands[0].path, &scene, &outcome)) {
        return outcome;
    }
    double bound;
    if (dea_model_settle(&scene, engine, arguments->quiet, &bound, &outcome) && !dea_engine_unfit(engine, &scene)) {
        outcome = run_scene(arguments, &scene, engine);
    }
    dea_scene_free(&scene);
    return outcome;
}

const dea_command dea_command_run = {
    .name = "run",
    .summary = "do what a scene's study asks",
    .help = "Usage: deaspice run [OPTION]... SCENE\n"
            "\n"
            "Solves the study of a scene. The result goes to standard output as CSV unless -o\n"
            "or --plot is given. SCENE is a YAML file, - is standard input.\n"
            "\n"
            "  -o, --output FILE     write the result to FILE, - is standard output\n"
            "      --format F        csv, nc or raw; default: from the ending of FILE\n"
            "      --plot FILE       draw the result, FILE ends in .svg or .png\n"
            "      --engine E        direct, ngspice (default) or ida\n"
            "      --model M         model instead of the scene's; several with commas between;\n"
            "                        auto: the cheapest that is within the accuracy of the finest\n"
            "      --set KEY=VALUE   change a value of the scene, e.g. actuator.prestretch=1.3;\n"
            "                        may be repeated\n"
            "      --full            a transient leaves out nothing, whatever its accuracy\n"
            "  -j, --jobs N          worker processes, default auto: one per core\n"
            "  -q, --quiet           no summary and no progress\n"
            "  -h, --help            this text\n"
            "  -V, --version         the version\n"
            "\n"
            "Points past a limit (slack, pull_in, breakdown) are told in the state column.\n"
            "Averages of a transient go to standard output, or to standard error where the\n"
            "result goes there.\n"
            "Exit status: 0 done, 1 points not solved or a file not written, 2 usage or a bad\n"
            "scene.\n"
            "\n"
            "Examples:\n"
            "  deaspice run dot.yaml -o dot.csv --plot dot.svg\n"
            "  deaspice run dot.yaml --engine direct --model lumped,field --set drive.voltage='3 kV'\n",
    .takes = DEA_TAKES_ENGINE | DEA_TAKES_SCENE | DEA_TAKES_OUTPUT | DEA_TAKES_FORMAT | DEA_TAKES_PLOT | DEA_TAKES_JOBS |
             DEA_TAKES_QUIET | DEA_TAKES_FULL,
    .least = 1,
    .most = 1,
    .run = run,
};
