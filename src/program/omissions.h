/** @file omissions.h
 * What a run leaves out, in words.
 */
#ifndef DEA_PROGRAM_OMISSIONS_H
#define DEA_PROGRAM_OMISSIONS_H

#include "deaspice/needs.h"
#include "program/program.h"

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

/* ---- What was left out, measured: did it change more than its bound says? */

/** What checking bounds came to. */
typedef struct dea_bounds {
    size_t broken;   /**< bounds that are too small */
    size_t unjudged; /**< omissions that no engine could measure */
} dea_bounds;

/** Measures what the first model's runs leave out for each engine that takes part, and prints it unless @p arguments are quiet.
 */
dea_bounds dea_check_omissions(const dea_arguments *arguments, const dea_scene *scene);
/** Measures the model error of the scene's first model against what it was chosen against, and prints it. */
dea_bounds dea_check_choice(const dea_arguments *arguments, const dea_scene *scene, const dea_model_choice *choice);

#endif
