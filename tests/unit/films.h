/* A film of every law, for tests that go over all of them. */
#ifndef DEA_TEST_FILMS_H
#define DEA_TEST_FILMS_H

#include "scenes.h"

typedef struct film {
    const char *law;
    double constants[DEA_LAW_CONSTANTS];
    size_t entries;
} film;

static const film films[] = {
    {"yeoh", {178426.0, -6023.0, 4234.0}, 1},
    {"neo_hookean", {44e3}, 1},
    {"mooney_rivlin", {16e3, 7.3e3}, 1},
    {"gent", {45e3, 120.0}, 1},
    {"ogden", {43.4e3, 1.445, 84.2, 4.248, -2.4e3, -1.5}, 3},
    {"arruda_boyce", {40e3, 5.99}, 1},
};
enum { FILMS = sizeof films / sizeof *films };

static inline void set_law(dea_scene *scene, const film *f)
{
    scene->material.law = dea_law_find(f->law);
    assert_non_null(scene->material.law);
    memcpy(scene->material.constants, f->constants, sizeof f->constants);
    scene->material.entry_count = f->entries;
}

#endif
