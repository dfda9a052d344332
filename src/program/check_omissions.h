/** @file check_omissions.h
 * What was left out, measured: did it change more than its bound says?
 */
#ifndef DEA_PROGRAM_CHECK_OMISSIONS_H
#define DEA_PROGRAM_CHECK_OMISSIONS_H

#include "program/program.h"

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
