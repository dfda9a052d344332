/* A second film on the edge, as a scene of its own: the same frame and study, its own film and static voltage, no load, no electrode
 * skin, no resistances. What it does not say is that of the first. */
#ifndef DEA_GEOMETRY_SECOND_H
#define DEA_GEOMETRY_SECOND_H

#include "deaspice/scene.h"

/* Borrows what the scene owns; only of a scene that has an antagonist. */
void dea_second_scene(const dea_scene *scene, dea_scene *second);
/* True where damper and branches of the first film are those of the second too: the material of both is one, and it relaxes. */
bool dea_second_relaxes(const dea_scene *scene);
/* The axis (borrowed values) as the second film's scene has it; false where it does not move that. */
bool dea_second_axis(const dea_scene *scene, const dea_axis *axis, dea_axis *second);

#endif
