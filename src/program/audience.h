/** @file audience.h
 * Everyone who listens to the points of a run: the file, the picture, the progress bar and what is told at its end.
 */
#ifndef DEA_PROGRAM_AUDIENCE_H
#define DEA_PROGRAM_AUDIENCE_H

#include "deaspice/output.h"
#include "deaspice/plot.h"
#include "output/progress.h"
#include "program/findings.h"
#include "program/program.h"

typedef struct dea_audience {
    dea_writer *writer; /**< NULL: none */
    dea_plot *plot;     /**< NULL: none */
    dea_progress *progress;
    size_t before; /**< points that were there when the run began */
    size_t lost;   /**< points that are failed because of lost workers */
    dea_findings findings;
} dea_audience;

/** Opens what the arguments ask for; fails before any work where a target cannot be written. The caller ends it with
 * dea_audience_close(), also after a failure. */
dea_status dea_audience_open(const dea_arguments *arguments, const dea_scene *scene,
                             dea_audience *audience, dea_error *error);
/** Tells whether dea_audience_open() would do, without leaving anything. */
dea_status dea_audience_try(const dea_arguments *arguments, const dea_scene *scene, dea_error *error);
/** Callbacks of a run whose user is the audience. */
dea_status dea_audience_points(void *user, size_t first, const void *points, size_t count, dea_error *error);
void dea_audience_lost(void *user, size_t count);
void dea_audience_instead(void *user, const dea_engine *engine, size_t count);
void dea_audience_log(void *user, const char *line);
void dea_audience_progress(void *user, size_t done, size_t total);
/** Ends outputs: kept when @p status is DEA_OK, else removed. The first failure counts. */
dea_status dea_audience_close(dea_audience *audience, dea_status status, dea_error *error);
/** Tells on standard error that a signal ended the run. */
void dea_audience_interrupted(const dea_audience *audience, const dea_arguments *arguments);
/** Prints the summary; returns the exit status. */
dea_exit dea_audience_tell(const dea_arguments *arguments, const dea_findings *findings,
                           double seconds);

#endif
