/* States of samples against their numbers: near a limit, answers that agree may have different states. */
#ifndef DEASPICE_RESULT_STATE_H
#define DEASPICE_RESULT_STATE_H

#include "deaspice/model.h"

/* True where a sample's state is that of the film at its displacement, or within @p slack of it [m], under its voltage or charge.
 * All axes of the scene are at their place. False where the sample has no numbers. */
bool dea_state_follows(const dea_scene *scene, const dea_sample *sample, double slack);
/* True where the model's own static states at voltages that are @p share less and more than that of the scene are these two: a limit lies
 * between. All axes of the scene are at their place. */
bool dea_state_between(const dea_scene *scene, double share, dea_state one, dea_state other);

#endif
