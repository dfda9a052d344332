#include "material/law.h"
#include "support/named.h"

static const dea_law *const laws[] = {&dea_law_yeoh, &dea_law_neo_hookean, &dea_law_mooney_rivlin,
                                     &dea_law_gent, &dea_law_ogden,       &dea_law_arruda_boyce};

DEA_NAMED_ROWS(dea_law, laws, laws[index])
