
#include "program/audience.h"
#include "program/program.h"
#include "study/study.h"
#include "support/clock.h"

static dea_exit run_scene(const dea_arguments *arguments, const dea_scene *scene)
{
    dea_error error = {0};
    dea_audience audience = {0};
    dea_signals_catch();
    dea_status status = dea_audience_open(arguments, scene, &audience, &error);
    audience.progress = arguments->quiet ? NULL : dea_progress_begin();
    const dea_run_options options = {.jobs = arguments->jobs ? arguments->jobs : dea_core_count(),
                                     .points = dea_audience_points,
                                     .lost = dea_audience_lost,
                                     .instead = dea_audience_instead,
                                     .progress = dea_audience_progress,
                                     .log = dea_audience_log,
                                     .stop = dea_signals_stop,
                                     .apart = true,
                                     .user = &audience};
    const double start = dea_clock();
    status = status ? status : dea_study_run(scene, NULL, &options, &error);
    const double seconds = dea_clock() - start;
    if (status != DEA_OK && dea_signals_caught()) {
        dea_audience_interrupted(&audience, arguments);
    }
    status = dea_audience_close(&audience, status, &error);
    if (status == DEA_OK && audience.lost > 0) {
        dea_complain("%zu %s lost their workers and may go well in another run", audience.lost,
                     dea_study_of(scene)->points[1]);
    }
    if (status == DEA_OK) {
        return dea_audience_tell(arguments, &audience.findings, seconds);
    }
    const dea_exit outcome = dea_complain_error(&error);
    return audience.findings.states[DEA_STATE_FAILED] > 0 ? DEA_EXIT_FAILED : outcome; /* why there is nothing to draw */
}

static dea_exit run(const dea_arguments *arguments)
{
    dea_scene scene;
    dea_exit outcome = DEA_EXIT_USAGE;
    if (!dea_journaled_fits(arguments)) {
        return DEA_EXIT_USAGE;
    }
    if (!dea_scene_open(arguments, arguments->operands[0].path, &scene, &outcome)) {
        return outcome;
    }
    dea_model_choice choice;
    if (dea_model_settle(&scene, NULL, arguments->quiet, &choice, &outcome) && !dea_engines_unfit(&scene)) {
        const bool journaled = arguments->resume || arguments->shard > 0;
        outcome = journaled ? dea_run_journaled(arguments, &scene) : run_scene(arguments, &scene);
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
            "or --plot is given. SCENE is a YAML file, - is standard input. Unless --jobs says\n"
            "less, a worker process on each core solves a part of the points.\n"
            "\n",
    .further = "Points past a limit (slack, pull_in, breakdown) are told in the state column.\n"
               "Averages of a transient go to standard output, or to standard error where the\n"
               "result goes there, with extremes and, of a sine, five harmonics of the\n"
               "displacement where the samples are dense enough for them.\n"
               "Exit status: 0 done, 1 points not solved or a file not written, 2 usage or a bad\n"
               "scene.\n"
               "\n"
               "Examples:\n"
               "  deaspice run dot.yaml -o dot.csv --plot dot.svg\n"
               "  deaspice run dot.yaml --engine direct --model lumped,field --set drive.voltage='3 kV'\n"
               "  deaspice run dot.yaml -o dot.nc --resume\n"
               "  deaspice run dot.yaml --shard 3/10 -o part-3.dea\n",
    .takes = DEA_TAKES_ENGINE | DEA_TAKES_SCENE | DEA_TAKES_OUTPUT | DEA_TAKES_FORMAT | DEA_TAKES_PLOT | DEA_TAKES_LOG | DEA_TAKES_JOBS |
             DEA_TAKES_QUIET | DEA_TAKES_FULL | DEA_TAKES_JOURNAL,
    .least = 1,
    .most = 1,
    .files = ".yaml",
    .run = run,
};
