#include "program/audience.h"
#include "study/study.h"

#include <stdio.h>
#include <string.h>
#include <unistd.h>

dea_status dea_audience_points(void *user, size_t first, const void *points, size_t count, dea_error *error)
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

void dea_audience_lost(void *user, size_t count)
{
    dea_audience *audience = user;
    audience->lost += count;
}

void dea_audience_instead(void *user, const dea_engine *engine, size_t count)
{
    dea_audience *audience = user;
    dea_findings_instead(&audience->findings, engine, count);
}

void dea_audience_log(void *user, const char *line)
{
    const dea_audience *audience = user;
    dea_progress_clear(audience->progress);
    dea_complain("%s", line);
}

void dea_audience_progress(void *user, size_t done, size_t total)
{
    const dea_audience *audience = user;
    dea_progress_show(audience->progress, audience->before + done, audience->before + total);
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

static dea_status open_outputs(const dea_arguments *arguments, const dea_scene *scene,
                               dea_audience *audience, dea_error *error)
{
    const char *output = arguments->output ? arguments->output : arguments->plot ? NULL : "-";
    dea_status status = DEA_OK;
    if (output) {
        char names[512];
        dea_crew_names(scene, NULL, names, sizeof names);
        status = dea_writer_open(scene, names, output, arguments->format, &audience->writer, error);
    }
    if (status == DEA_OK && arguments->plot) {
        status = dea_plot_begin(scene, arguments->plot, &arguments->picture, &audience->plot, error);
    }
    return status;
}

dea_status dea_audience_open(const dea_arguments *arguments, const dea_scene *scene,
                             dea_audience *audience, dea_error *error)
{
    const dea_status status = open_outputs(arguments, scene, audience, error);
    char note[DEA_NOTE_LENGTH];
    if (status == DEA_OK && !arguments->quiet && audience->writer && dea_writer_note(audience->writer, note)) {
        dea_complain("%s", note);
    }
    if (status == DEA_OK) {
        audience->findings = dea_findings_begin(scene, averages_stream(arguments));
        audience->findings.alone = arguments->no_truth;
    }
    return status;
}

dea_status dea_audience_try(const dea_arguments *arguments, const dea_scene *scene, dea_error *error)
{
    dea_audience audience = {0};
    const dea_status status = open_outputs(arguments, scene, &audience, error);
    dea_writer_finish(audience.writer, false, NULL);
    dea_plot_finish(audience.plot, false, NULL);
    return status;
}

dea_status dea_audience_close(dea_audience *audience, dea_status status, dea_error *error)
{
    dea_progress_end(audience->progress);
    const dea_status written = dea_writer_finish(audience->writer, status == DEA_OK, status == DEA_OK ? error : NULL);
    status = status ? status : written;
    const dea_status plotted = dea_plot_finish(audience->plot, status == DEA_OK, status == DEA_OK ? error : NULL);
    return status != DEA_OK ? status : plotted;
}

void dea_audience_interrupted(const dea_audience *audience, const dea_arguments *arguments)
{
    const bool straight = audience->writer && is_straight(arguments);
    if (dea_signals_caught() != 0 && !dea_signals_broken_pipe()) {
        dea_complain("%s", straight ? "interrupted" : "interrupted, nothing written");
    }
}

dea_exit dea_audience_tell(const dea_arguments *arguments, const dea_findings *findings, double seconds)
{
    const size_t failed = findings->states[DEA_STATE_FAILED];
    if (!arguments->quiet && (arguments->output || arguments->plot || isatty(STDERR_FILENO))) {
        dea_findings_print(findings, seconds);
    }
    if (!arguments->quiet) {
        dea_covered_warn(&findings->covered, findings->scene);
    }
    if (failed > 0) {
        dea_complain("%zu %s were not solved", failed, dea_study_of(findings->scene)->along ? "rows" : "points");
    }
    return failed > 0 ? DEA_EXIT_FAILED : DEA_EXIT_DONE;
}
