/* What acts on the edge of a scene beside its film. */
#include "film/edge.h"

#include <math.h>
#include <string.h>

#include "deaspice/model.h"

dea_edge_terms dea_scene_edge(const dea_scene *scene)
{
    dea_edge_terms sum = {0};
    for (size_t i = 0; i < DEA_LOADS; i++) {
        const dea_edge_load *load = &scene->loads[i];
        if (dea_load_is_given(load)) {
            sum.mass += load->kind->adds.mass * load->number;
            sum.stiffness += load->kind->adds.stiffness * load->number;
            sum.damping += load->kind->adds.damping * load->number;
            sum.force += load->kind->adds.force * load->number;
            sum.bent = sum.bent || load->kind->spring;
        }
    }
    return sum;
}

double *dea_scene_load(dea_scene *scene, const char *name)
{
    for (size_t i = 0; i < dea_load_count(); i++) {
        if (strcmp(dea_load_at(i)->name, name) == 0) {
            scene->loads[i].kind = dea_load_at(i);
            return &scene->loads[i].number;
        }
    }
    return NULL;
}

void dea_scene_unload(dea_scene *scene)
{
    for (size_t i = 0; i < DEA_LOADS; i++) {
        scene->loads[i] = (dea_edge_load){dea_load_at(i), (double)NAN};
    }
}

/* True where an axis moves a load that adds a force. */
static bool sweeps_force(const dea_scene *scene)
{
    bool swept = false;
    for (size_t i = 0; i < scene->axis_count * DEA_LOADS; i++) {
        const dea_edge_load *load = &scene->loads[i % DEA_LOADS];
        const size_t place = (size_t)((const char *)&load->number - (const char *)scene);
        swept = swept || (load->kind && load->kind->adds.force != 0.0 && scene->axes[i / DEA_LOADS].offset == place);
    }
    return swept;
}

bool dea_scene_is_pulled(const dea_scene *scene)
{
    return dea_scene_edge(scene).force != 0.0 || scene->antagonist.there || sweeps_force(scene);
}

bool dea_scene_is_loaded(const dea_scene *scene)
{
    const dea_edge_terms edge = dea_scene_edge(scene);
    return edge.mass > 0.0 || edge.stiffness > 0.0 || edge.damping > 0.0 || edge.bent || dea_scene_is_pulled(scene);
}
