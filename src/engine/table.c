#include "deaspice/model.h"
#include "engine/engines.h"
#include "study/study.h"

#include <string.h>

static const dea_engine *const engines[] = {&dea_engine_direct, &dea_engine_ngspice, &dea_engine_ida};

size_t dea_engine_count(void)
{
    return sizeof engines / sizeof engines[0];
}

const dea_engine *dea_engine_at(size_t index)
{
    return index < dea_engine_count() ? engines[index] : NULL;
}

const char *dea_engine_refuses(const dea_engine *engine, const dea_scene *scene, const dea_model *model)
{
    const dea_study *study = dea_study_of(scene);
    if (!(study->offered ? study->offered(engine) : engine->solves[scene->study] != NULL))
        return study->engine_fails;
    if (!dea_study_takes(study, model))
        return study->model_lacks;
    if (!model->edge && dea_scene_is_loaded(scene))
        return "the model has no edge that a load or a second film acts on";
    if (study->timed && scene->transient.points > 0 && !engine->profiles)
        return "its transients have no profiles";
    if (model->membrane && scene->drive.current_limit > 0.0)
        return "its rings of film take no current limit; ring does";
    return engine->refuses ? engine->refuses(scene, model) : NULL;
}

const dea_engine *dea_engine_find(const char *name)
{
    for (size_t i = 0; i < dea_engine_count(); i++) {
        if (strcmp(engines[i]->name, name) == 0)
            return engines[i];
    }
    return NULL;
}
