/** @file journaled.h
 * Runs that keep their finished blocks in a journal: to go on after a crash, or as a shard.
 */
#ifndef DEA_PROGRAM_JOURNALED_H
#define DEA_PROGRAM_JOURNALED_H

#include "program/program.h"

/** False, with a complaint, where --shard or --resume are given and other arguments do not go with them. */
bool dea_journaled_fits(const dea_arguments *arguments);
/** Runs a scene with --shard or --resume. */
dea_exit dea_run_journaled(const dea_arguments *arguments, const dea_scene *scene);

#endif
