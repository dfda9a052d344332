/* Probes of a study: places spread evenly over every axis, its ends included. */
#ifndef DEA_PROBES_H
#define DEA_PROBES_H

#include "deaspice/model.h"
#include "deaspice/scene.h"

/* Probes where every axis has at most @p most of them. */
size_t dea_probe_count(const dea_scene *scene, size_t most);
/* The scene at probe number @p probe; shares what the scene owns. */
dea_scene dea_probe_scene(const dea_scene *scene, size_t most, size_t probe);
/* The model's own static answer there. */
dea_row dea_probe_row(const dea_scene *scene, const dea_model *model, double accuracy);
/* What a model's error of a strain is told relative to: the strain, or with its sign that of a film at rest that something else than
 * its voltage pulls, if that is larger. */
double dea_probe_scale(const dea_scene *scene, const dea_model *truth, double accuracy, double strain);

#endif
