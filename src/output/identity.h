/* All of a scene, its engine and their versions that decides the numbers of a study, as text: lines "name=value". Two studies
 * with the same text have the same numbers, bit by bit, on machines whose libraries compute alike. */
#ifndef DEASPICE_OUTPUT_IDENTITY_H
#define DEASPICE_OUTPUT_IDENTITY_H

#include "deaspice/engine.h"

enum { DEA_IDENTITY_DIFFERENCE = 256 };

/* Writes the text into @p text, which the caller frees. @return DEA_OK, DEA_ERROR_MEMORY */
dea_status dea_identity_write(const dea_scene *scene, const dea_engine *engine, char **text, dea_error *error);
/* First difference of two texts, in words: "actuator.prestretch is 1.3 there and 1.2 here". */
void dea_identity_compare(const char *there, const char *here, char difference[DEA_IDENTITY_DIFFERENCE]);

#endif
