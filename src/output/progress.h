/** @file progress.h
 * Progress bar of a program on standard error. It writes only to a terminal; every function takes NULL, the bar that stays
 * silent.
 */
#ifndef DEASPICE_OUTPUT_PROGRESS_H
#define DEASPICE_OUTPUT_PROGRESS_H

#include <stddef.h>

#include "deaspice/status.h"

typedef struct dea_progress dea_progress;

/** A bar, NULL where standard error is not a terminal that can erase a line. The caller ends it with dea_progress_end(). */
DEA_API dea_progress *dea_progress_begin(void);
/** Tells that @p done was done before: the time that is left goes by what comes now. */
DEA_API void dea_progress_from(dea_progress *bar, size_t done);
/** Shows how far the work is, at most ten times a second, and not within the first moments of it. */
DEA_API void dea_progress_show(dea_progress *bar, size_t done, size_t total);
/** Erases the bar before other text goes to the terminal; the next dea_progress_show() draws it anew. */
DEA_API void dea_progress_clear(dea_progress *bar);
/** Erases the bar and frees it. */
DEA_API void dea_progress_end(dea_progress *bar);

#endif
