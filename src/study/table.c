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
