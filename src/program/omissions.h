/** @file omissions.h
 * What a run leaves out, in words.
 */
#ifndef DEA_PROGRAM_OMISSIONS_H
#define DEA_PROGRAM_OMISSIONS_H

#include "deaspice/needs.h"

enum { DEA_OMISSION_LENGTH = 128, DEA_QUANTITY_LENGTH = 64 };

/** Writes e.g. "branch 4 (tau 215 s, <= 2.1e-05)"; returns @p text. */
const char *dea_omission_text(const dea_omission *omission, const dea_scene *scene, char text[DEA_OMISSION_LENGTH]);
/** Writes a bound rounded up to two digits, e.g. "2.1e-05"; returns @p text. */
const char *dea_bound_text(double bound, char text[32]);
/** Writes e.g. "1.234 ms", long times in min and h; returns @p text. */
const char *dea_quantity_text(double value, const char *unit, int digits, char text[DEA_QUANTITY_LENGTH]);
/** The same in a text of its own, which stands as long as the block. */
#define DEA_QUANTITY(value, unit, digits) dea_quantity_text(value, unit, digits, (char[DEA_QUANTITY_LENGTH]){""})
/** The scene of run number @p number of its study, all axes at their place; its lists still belong to @p scene. */
dea_scene dea_scene_of_run(const dea_scene *scene, size_t number);

#endif
