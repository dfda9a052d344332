#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include "journal/journal.h"
#include "program/audience.h"
#include "support/clock.h"

typedef struct merging {
    dea_audience audience;
    size_t total;
} merging;

static dea_status take_points(void *user, size_t first, const void *points, size_t count, dea_error *error)
{
    merging *merge = user;
    const dea_status status = dea_audience_points(&merge->audience, first, points, count, error);
    dea_audience_progress(&merge->audience, first + count, merge->total);
    return status;
}

static void take_line(void *user, const char *line)
{
    merging *merge = user;
    dea_audience_log(&merge->audience, line);
}

static const char **list_paths(const dea_arguments *arguments)
{
    const char **paths = calloc(arguments->operand_count, sizeof *paths);
    for (size_t i = 1; paths && i < arguments->operand_count; i++) {
        paths[i - 1] = arguments->operands[i].path;
    }
    return paths;
}

static dea_status merge_parts(const dea_arguments *arguments, const dea_journal_study *study, merging *merge, dea_error *error)
{
    const char **paths = list_paths(arguments);
    if (!paths) {
        return dea_fail(error, DEA_ERROR_MEMORY, "out of memory");
    }
    const dea_run_options options = {.points = take_points, .log = take_line, .stop = dea_signals_stop, .user = merge};
    const dea_status status = dea_merge_parts(study, paths, arguments->operand_count - 1, &options, error);
    free(paths);
    return status;
}

static dea_exit merge_scene(const dea_arguments *arguments, const dea_scene *scene)
{
    dea_error error = {0};
    dea_journal_study study = {0};
    merging merge = {0};
    dea_signals_catch();
    const double start = dea_clock();
    dea_status status = dea_journal_study_make(scene, NULL, &study, &error);
    status = status ? status : dea_audience_open(arguments, scene, &merge.audience, &error);
    if (status == DEA_OK) {
        merge.audience.progress = arguments->quiet ? NULL : dea_progress_begin();
        merge.total = study.cut.total;
        status = merge_parts(arguments, &study, &merge, &error);
    }
    dea_journal_study_free(&study);
    if (status != DEA_OK && dea_signals_caught()) {
        dea_audience_interrupted(&merge.audience, arguments);
    }
    status = dea_audience_close(&merge.audience, status, &error);
    if (status != DEA_OK) {
        return dea_complain_error(&error);
    }
    return dea_audience_tell(arguments, &merge.audience.findings, dea_clock() - start);
}

static dea_exit merge(const dea_arguments *arguments)
{
    dea_scene scene;
    dea_exit outcome = DEA_EXIT_USAGE;
    if (!dea_scene_open(arguments, arguments->operands[0].path, &scene, &outcome)) {
        return outcome;
    }
    dea_model_choice choice;
    if (dea_model_settle(&scene, NULL, arguments->quiet, &choice, &outcome) && !dea_engines_unfit(&scene)) {
        outcome = merge_scene(arguments, &scene);
    }
    dea_scene_free(&scene);
    return outcome;
}

const dea_command dea_command_merge = {
    .name = "merge",
    .summary = "join the parts of a study that ran in shards",
    .help = "Usage: deaspice merge [OPTION]... SCENE PART...\n"
            "\n"
            "Joins the parts that deaspice run --shard wrote, in any order. The result is the\n"
            "same, byte by byte, as that of one run of the whole study. It goes to standard\n"
            "output as CSV unless -o or --plot is given.\n"
            "\n",
    .further = "A part that is missing, there twice, not complete, damaged, or of another scene,\n"
               "engine or version is named, with its points, and nothing is written.\n"
               "Exit status: 0 done, 1 points not solved or a file not written, 2 usage, a bad\n"
               "scene or parts that do not fit.\n"
               "\n"
               "Examples:\n"
               "  for i in 1 2 3 4; do deaspice run dot.yaml --shard $i/4 -o part-$i.dea; done\n"
               "  deaspice merge dot.yaml part-*.dea -o dot.nc\n",
    .takes = DEA_TAKES_ENGINE | DEA_TAKES_SCENE | DEA_TAKES_OUTPUT | DEA_TAKES_FORMAT | DEA_TAKES_PLOT | DEA_TAKES_LOG | DEA_TAKES_QUIET |
             DEA_TAKES_FULL,
    .least = 2,
    .most = SIZE_MAX,
    .files = "",
    .run = merge,
};
