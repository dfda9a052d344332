#include "study/study.h"

#define X(code, name) extern const dea_study dea_study_##name;
DEA_STUDY_LIST(X)
#undef X

static const dea_study *const studies[] = {
#define X(code, name) [code] = &dea_study_##name,
    DEA_STUDY_LIST(X)
#undef X
};

const dea_study *dea_study_at(dea_study_kind kind)
{
    return studies[kind];
}

bool dea_study_takes(const dea_study *study, const dea_model *model)
{
    return !study->takes || study->takes(model);
}

bool dea_study_moves(const dea_model *model)
{
    return model->dynamic;
}

dea_status dea_study_solve(const dea_engine *engine, void *session, dea_scene *here, const dea_model *model, const dea_layout *layout,
                           void *point, dea_error *error)
{
    return engine->solves[here->study](session, here, model, layout, point, error);
}
