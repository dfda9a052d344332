/* Forces on an edge that is held, by the models' own equations. */
#include "engine/direct/direct.h"
#include "model/loaded.h"

static void hold(void *user, const dea_point *point, double displacement, dea_row *row)
{
    const dea_model *const *model = user;
    dea_model_hold(*model, point, displacement, row);
}

dea_status dea_direct_force(void *session, const dea_scene *scene, const dea_model *model, const dea_layout *layout, void *point,
                            dea_error *error)
{
    (void)session;
    (void)layout;
    return dea_loaded_curve(scene, hold, &model, point, error);
}
