#include "program/program.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>

#include "journal/journal.h"
#include "program/audience.h"
#include "study/study.h"
#include "support/clock.h"

/* A run that goes into a journal, and from there to its audience. */
typedef struct recorder {
    const dea_arguments *arguments;
    dea_journal_study study;
    dea_shard shard;
    char *path; /* of the journal, owned; NULL: it has no name of its own */
    dea_journal *journal;
    size_t total, taken; /* points of the shard, and of those that were in the journal */
    size_t computed;     /* points that came since */
    size_t lost;         /* points of the block that comes next which were lost */
    dea_audience audience;
} recorder;

static bool recorder_wanted(void *user, size_t block)
{
    const recorder *run = user;
    return dea_journal_wants(run->journal, block);
}

static void recorder_lost(void *user, size_t count)
{
    recorder *run = user;
    run->lost = count;
}

static void recorder_instead(void *user, const dea_engine *engine, size_t count)
{
    recorder *run = user;
    dea_audience_instead(&run->audience, engine, count);
}

static dea_status recorder_points(void *user, size_t first, const void *points, size_t count, dea_error *error)
{
    recorder *run = user;
    const bool lost = run->lost > 0;
    run->lost = 0;
    run->computed += count;
    return dea_journal_append(run->journal, first, points, count, lost, error);
}

static dea_status recorder_replay(void *user, size_t first, const void *points, size_t count, dea_error *error)
{
    recorder *run = user;
    return dea_audience_points(&run->audience, first, points, count, error);
}

static void recorder_log(void *user, const char *line)
{
    recorder *run = user;
    dea_audience_log(&run->audience, line);
}

static void recorder_progress(void *user, size_t done, size_t total)
{
    recorder *run = user;
    dea_audience_progress(&run->audience, done, total);
}

static bool recorder_stop(void *user)
{
    const recorder *run = user;
    dea_journal_settle(run->journal);
    return dea_signals_stop(NULL);
}

static bool ends_in(const char *path, const char *ending)
{
    const size_t whole = strlen(path), part = strlen(ending);
    return whole > part && strcmp(path + whole - part, ending) == 0;
}

bool dea_journaled_fits(const dea_arguments *arguments)
{
    static const char *const formats[] = {".csv", ".nc", ".raw"};
    const char *option = arguments->shard > 0 ? "--shard" : "--resume";
    const char *output = arguments->output;
    struct stat about;
    if (arguments->shard == 0 && !arguments->resume) {
        return true;
    }
    if (!output || strcmp(output, "-") == 0 ||
        (stat(output, &about) == 0 && !S_ISREG(about.st_mode) && !S_ISDIR(about.st_mode))) {
        dea_complain("%s needs -o with a file, %s", option,
                     arguments->shard > 0 ? "for example -o part-1.dea" : "for example -o result.nc");
        return false;
    }
    if (arguments->shard > 0 && (arguments->format || arguments->plot)) {
        dea_complain("--shard writes a part, which has no format and no plot; give %s to deaspice merge",
                     arguments->format ? "--format" : "--plot");
        return false;
    }
    for (size_t i = 0; arguments->shard > 0 && i < sizeof formats / sizeof *formats; i++) {
        if (ends_in(output, formats[i])) {
            dea_complain("--shard writes a part, which is no %s file; call it for example part-%zu.dea", formats[i],
                         arguments->shard);
            return false;
        }
    }
    return true;
}

/* A part that is there already is gone on with; everything else has its journal beside the target. */
static char *journal_path(const dea_arguments *arguments)
{
    struct stat about;
    if (arguments->shard > 0 && stat(arguments->output, &about) == 0) {
        return strdup(arguments->output);
    }
    const size_t room = strlen(arguments->output) + sizeof ".journal";
    char *path = malloc(room);
    if (path) {
        snprintf(path, room, "%s.journal", arguments->output);
    }
    return path;
}

static dea_status open_journal(recorder *run, dea_error *error)
{
    const dea_arguments *arguments = run->arguments;
    if (!arguments->resume) {
        return dea_journal_create(&run->study, run->shard, arguments->output, &run->journal, error);
    }
    run->path = journal_path(arguments);
    if (!run->path) {
        return dea_fail(error, DEA_ERROR_MEMORY, "out of memory");
    }
    const bool apart = strcmp(run->path, arguments->output) != 0; /* of the result: no part that is gone on with */
    dea_files *files = run->study.scene->files;
    const dea_status status = apart ? dea_files_target(files, run->path, arguments->force, error) : DEA_OK;
    return status == DEA_OK ? dea_journal_open(&run->study, run->shard, run->path, &run->journal, error) : status;
}

static const char *noun(const recorder *run)
{
    return dea_study_of(run->study.scene)->points[1];
}

static void tell_taken(const recorder *run)
{
    if (run->arguments->quiet || !run->arguments->resume) {
        return;
    }
    dea_complain("%zu of %zu %s taken over from %s", run->taken, run->total, noun(run), run->path);
    if (dea_journal_tell(run->journal).damaged > 0) {
        dea_complain("%llu bytes in it are damaged; what they held is computed again, what follows them is kept",
                     (unsigned long long)dea_journal_tell(run->journal).damaged);
    }
    if (dea_journal_tell(run->journal).cut > 0) {
        dea_complain("its last %llu bytes are no whole block and were cut off",
                     (unsigned long long)dea_journal_tell(run->journal).cut);
    }
}

/* Computes what is not in the journal. */
static dea_status compute(recorder *run, dea_error *error)
{
    run->taken = dea_journal_tell(run->journal).points;
    run->total = dea_shard_points(&run->study, run->shard).count;
    tell_taken(run);
    run->audience.before = run->taken;
    run->audience.progress = run->arguments->quiet ? NULL : dea_progress_begin();
    dea_progress_from(run->audience.progress, run->taken);
    const dea_run_options options = {.jobs = run->arguments->jobs ? run->arguments->jobs : dea_core_count(),
                                     .points = recorder_points,
                                     .wanted = recorder_wanted,
                                     .lost = recorder_lost,
                                     .instead = recorder_instead,
                                     .any_order = true,
                                     .progress = recorder_progress,
                                     .log = recorder_log,
                                     .stop = recorder_stop,
                                     .apart = true,
                                     .user = run};
    return dea_study_run(run->study.scene, NULL, &options, error);
}

/* Hands the whole journal to the audience; a shard has only findings. */
static dea_status replay(recorder *run, dea_error *error)
{
    const dea_run_options options = {.points = recorder_replay, .stop = dea_signals_stop, .user = run};
    dea_status status = DEA_OK;
    dea_progress_clear(run->audience.progress);
    if (run->arguments->shard > 0) {
        run->audience.findings = dea_findings_begin(run->study.scene, NULL);
    } else {
        status = dea_audience_open(run->arguments, run->study.scene, &run->audience, error);
    }
    return status == DEA_OK ? dea_journal_replay(run->journal, &options, error) : status;
}

static void tell_interrupted(const recorder *run)
{
    if (dea_signals_caught() == 0) {
        return;
    }
    if (!run->arguments->resume || !run->journal || dea_journal_tell(run->journal).points == 0) {
        dea_complain("interrupted, nothing written");
        return;
    }
    dea_complain("interrupted; %zu of %zu %s are kept in %s, --resume goes on with them", dea_journal_tell(run->journal).points,
                 run->total, noun(run), run->path);
}

/* Blocks that lost points are computed again by the next run: their rows are `failed` in the result, not in the journal. */
static void tell_lost(const recorder *run, size_t points)
{
    if (points > 0) {
        dea_complain("the blocks of %zu %s lost their workers; a run with --resume computes them again", points, noun(run));
    }
}

static dea_status close_journal(recorder *run, dea_status status, dea_error *error)
{
    const bool whole = !run->journal || dea_journal_tell(run->journal).lost == 0;
    const dea_journal_end done = run->arguments->shard > 0 ? DEA_JOURNAL_IS_PART : whole ? DEA_JOURNAL_GOES : DEA_JOURNAL_STAYS;
    const dea_status closed = dea_journal_close(run->journal, status == DEA_OK ? done : DEA_JOURNAL_STAYS, run->arguments->output,
                                                status == DEA_OK ? error : NULL);
    return status != DEA_OK ? status : closed;
}

static void tell_share(const recorder *run)
{
    const dea_stretch points = dea_shard_points(&run->study, run->shard);
    if (run->arguments->quiet) {
        return;
    }
    if (run->arguments->resume) {
        fprintf(stderr, "%zu %s taken over, %zu computed\n", run->taken, noun(run), run->computed);
    }
    if (run->shard.count > 1 && points.count > 0) {
        fprintf(stderr, "shard %zu/%zu, %s %zu to %zu of %zu: ", run->shard.number, run->shard.count, noun(run), points.first,
                points.first + points.count - 1, run->study.cut.total);
    }
}

dea_exit dea_run_journaled(const dea_arguments *arguments, const dea_scene *scene)
{
    dea_error error = {0};
    recorder run = {.arguments = arguments, .shard = {1, 1}};
    if (arguments->shard > 0) {
        run.shard = (dea_shard){arguments->shard, arguments->shards};
    }
    dea_signals_catch();
    const double start = dea_clock();
    dea_status status = dea_journal_study_make(scene, NULL, &run.study, &error);
    if (status == DEA_OK && arguments->shard == 0) {
        status = dea_audience_try(arguments, scene, &error);
    }
    status = status ? status : open_journal(&run, &error);
    status = status ? status : compute(&run, &error);
    status = status ? status : replay(&run, &error);
    status = dea_audience_close(&run.audience, status, &error);
    if (status != DEA_OK) {
        tell_interrupted(&run);
    }
    const size_t lost = run.journal ? dea_journal_tell(run.journal).lost : 0;
    status = close_journal(&run, status, &error);
    if (status == DEA_OK) {
        tell_share(&run);
        tell_lost(&run, lost);
    }
    const dea_exit outcome = status == DEA_OK
                                 ? dea_audience_tell(arguments, &run.audience.findings, dea_clock() - start)
                                 : dea_complain_error(&error);
    dea_journal_study_free(&run.study);
    free(run.path);
    return outcome;
}
