/* The parts of a study become its result again. */
#ifndef DEASPICE_OUTPUT_MERGE_H
#define DEASPICE_OUTPUT_MERGE_H

#include "output/journal.h"

/* Hands the points of all parts to options->points in order; options->stop ends it as interrupted. First all headers and places
 * of records are checked, then the points are verified as they come: one block of them is in memory, one file open at a time.
 * DEA_ERROR_USAGE: a part is missing, there twice, incomplete, damaged or of another study; the message names file and points. */
dea_status dea_merge_parts(const dea_journal_study *study, const char *const *paths, size_t count, const dea_run_options *options,
                           dea_error *error);

#endif
