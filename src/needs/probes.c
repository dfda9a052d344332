#include "needs/nearness.h"

#include <math.h>

#include "scene/line.h"

static size_t probes_of_axis(const dea_axis *axis, size_t most)
{
    return most < axis->count ? most : axis->count;
}

size_t dea_probe_count(const dea_scene *scene, size_t most)
{
    size_t count = 1;
    for (size_t i = 0; i < scene->axis_count; i++) {
        count *= probes_of_axis(&scene->axes[i], most);
    }
    return count;
}

dea_scene dea_probe_scene(const dea_scene *scene, size_t most, size_t probe)
{
    dea_scene here = *scene;
    for (size_t i = scene->axis_count; i-- > 0;) {
        const dea_axis *axis = &scene->axes[i];
        const size_t count = probes_of_axis(axis, most);
        const size_t place = count > 1 ? probe % count * (axis->count - 1) / (count - 1) : 0;
        dea_axis_set(axis, &here, axis->values[place]);
        probe /= count;
    }
    return here;
}

double dea_probe_scale(const dea_scene *scene, const dea_model *truth, double accuracy, double strain)
{
    dea_scene still = *scene;
    still.drive.voltage = 0.0;
    const double rest = dea_scene_is_pulled(scene) ? dea_probe_row(&still, truth, accuracy).strain : 0.0;
    return copysign(fmax(fabs(strain), fabs(rest)), strain); /* of a NAN and a number the number */
}

dea_row dea_probe_row(const dea_scene *scene, const dea_model *model, double accuracy)
{
    dea_point point;
    dea_row row = dea_row_failed();
    dea_film_prepare(scene, &point.film);
    dea_point_place(scene, &point);
    if (dea_point_valid(&point)) {
        dea_model_solve(model, &point, accuracy, &row);
    }
    return row;
}
