/* The model table, from the cheapest to the truth. A model is one file and one line here. */
#include <string.h>

#include "model/models.h"

static const dea_model *const models[] = {
    &dea_model_pelrine, &dea_model_constant_force, &dea_model_lumped, &dea_model_coverage, &dea_model_lame, &dea_model_ring, &dea_model_field,
};

size_t dea_model_count(void)
{
    return sizeof models / sizeof models[0];
}

const dea_model *dea_model_at(size_t index)
{
    return index < dea_model_count() ? models[index] : NULL;
}

dea_form dea_model_form(const dea_model *model)
{
    return model->membrane  ? DEA_FORM_MEMBRANE
           : model->linear  ? DEA_FORM_LINEAR
           : model->network ? DEA_FORM_HYPERELASTIC
                            : DEA_FORM_CLOSED;
}

const dea_model *dea_model_find(const char *name)
{
    for (size_t i = 0; i < dea_model_count(); i++) {
        if (strcmp(models[i]->name, name) == 0) {
            return models[i];
        }
    }
    return NULL;
}
