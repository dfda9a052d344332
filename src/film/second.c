/* A second film on the edge, as a scene of its own. */
#include <math.h>
#include <stddef.h>
#include <stdint.h>

#include "deaspice/model.h"
#include "film/second.h"

/* A scalar of the second film, in whose place in its own scene it stands. */
typedef struct pair {
    size_t second, first;
} pair;

static const pair pairs[] = {
    {offsetof(dea_scene, antagonist.film_thickness), offsetof(dea_scene, actuator.film_thickness)},
    {offsetof(dea_scene, antagonist.layers), offsetof(dea_scene, actuator.layers)},
    {offsetof(dea_scene, antagonist.prestretch), offsetof(dea_scene, actuator.prestretch)},
    {offsetof(dea_scene, antagonist.voltage), offsetof(dea_scene, drive.voltage)},
};

enum { PAIRS = sizeof pairs / sizeof *pairs };

static double *scalar_of(const dea_scene *scene, size_t offset)
{
    return (double *)(void *)((char *)(uintptr_t)scene + offset);
}

void dea_second_scene(const dea_scene *scene, dea_scene *second)
{
    const dea_antagonist *own = &scene->antagonist;
    const double none = (double)NAN;
    *second = *scene;
    second->antagonist.there = false;
    second->actuator.kind = own->kind;
    second->actuator.electrode_mass = second->actuator.focal_length = second->actuator.refractive_index = none;
    second->electrode = (dea_electrode){.thickness = none, .density = none, .sheet_resistance = none};
    dea_scene_unload(second);
    second->material = own->own_material ? own->material : scene->material;
    second->material.temperature = scene->material.temperature;
    second->drive.series_resistance = second->drive.leakage_resistance = none;
    for (size_t i = 0; i < PAIRS; i++) {
        const double value = *scalar_of(scene, pairs[i].second);
        if (!isnan(value)) {
            *scalar_of(second, pairs[i].first) = value;
        }
    }
}

bool dea_second_relaxes(const dea_scene *scene)
{
    return scene->antagonist.there && !scene->antagonist.own_material && (scene->material.prony_count > 0 || !isnan(scene->material.retardation));
}

bool dea_second_axis(const dea_scene *scene, const dea_axis *axis, dea_axis *second)
{
    const size_t material = offsetof(dea_scene, material), end = material + sizeof scene->material;
    *second = *axis;
    for (size_t i = 0; i < PAIRS; i++) {
        if (axis->offset == pairs[i].second) {
            second->offset = pairs[i].first;
            return true;
        }
        if (axis->offset == pairs[i].first && !isnan(*scalar_of(scene, pairs[i].second))) {
            return false;
        }
    }
    const bool warms = axis->offset == offsetof(dea_scene, material.temperature); /* both films */
    return warms || !(scene->antagonist.own_material && axis->offset >= material && axis->offset < end);
}
