/* The parts of engine `direct`. */
#ifndef DEA_DIRECT_H
#define DEA_DIRECT_H

#include "deaspice/engine.h"

/* NULL where the scene's transient has a closed form with this model, else why not. */
const char *dea_direct_refuses_transient(const dea_scene *scene, const dea_model *model);
/* As the engine's transient() and ac(). */
dea_status dea_direct_transient(void *session, const dea_scene *scene, const dea_model *model, dea_sample *samples,
                                dea_summary *summary, dea_error *error);
dea_status dea_direct_ac(void *session, const dea_scene *scene, const dea_model *model, dea_response *rows, dea_band *band,
                         dea_error *error);
/* As the engine's solves[] of modes and profiles. */
dea_status dea_direct_modes(void *session, const dea_scene *scene, const dea_model *model, const dea_layout *layout, void *point,
                            dea_error *error);
dea_status dea_direct_force(void *session, const dea_scene *scene, const dea_model *model, const dea_layout *layout, void *point,
                            dea_error *error);
dea_status dea_direct_profile(void *session, const dea_scene *scene, const dea_model *model, const dea_layout *layout, void *point,
                              dea_error *error);

#endif
