#include "deaspice/model.h"
#include "engine/engines.h"
#include "study/study.h"
#include "support/named.h"

static const dea_engine *const engines[] = {&dea_engine_direct, &dea_engine_ngspice, &dea_engine_ida};

DEA_NAMED_ROWS(dea_engine, engines, engines[index])

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
