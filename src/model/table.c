/* The model table, from the cheapest to the truth. A model is one file and one line here. */

#include "model/models.h"
#include "support/named.h"

static const dea_model *const models[] = {
    &dea_model_pelrine, &dea_model_constant_force, &dea_model_lumped, &dea_model_coverage, &dea_model_lame, &dea_model_ring, &dea_model_field,
};

DEA_NAMED_ROWS(dea_model, models, models[index])

dea_form dea_model_form(const dea_model *model)
{
    return model->membrane  ? DEA_FORM_MEMBRANE
           : model->linear  ? DEA_FORM_LINEAR
           : model->network ? DEA_FORM_HYPERELASTIC
                            : DEA_FORM_CLOSED;
}
