#include <string.h>

#include "material/law.h"

static const dea_law *const laws[] = {&dea_law_yeoh, &dea_law_neo_hookean, &dea_law_mooney_rivlin,
                                     &dea_law_gent, &dea_law_ogden,       &dea_law_arruda_boyce};

enum { LAW_COUNT = sizeof laws / sizeof *laws };

size_t dea_law_count(void)
{
    return LAW_COUNT;
}

const dea_law *dea_law_at(size_t index)
{
    return index < LAW_COUNT ? laws[index] : NULL;
}

const dea_law *dea_law_find(const char *name)
{
    for (size_t i = 0; name && i < LAW_COUNT; i++) {
        if (strcmp(laws[i]->name, name) == 0) {
            return laws[i];
        }
    }
    return NULL;
}
