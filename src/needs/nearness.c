#include "needs/nearness.h"

#include <math.h>

#include "network/swing.h"
#include "study/study.h"

/* Of the solutions that are compared: the membrane costs some 20 us a probe then, and no printed digit is of it. */
static const double accuracy = 1e-6;

enum { MOST_STEPS = 350 }; /* of all first peaks: some 2 ms */

/* Most probes of an axis where the study has so many of them: some 30 in all. */
static size_t most_probes(const dea_scene *scene)
{
    static const size_t most[] = {1, 17, 5, 3, 2};
    return scene->axis_count < sizeof most / sizeof *most ? most[scene->axis_count] : 1;
}

static void compare(const dea_scene *scene, const dea_model *model, const dea_model *truth, dea_nearness *nearness)
{
    const double strain = dea_probe_row(scene, model, accuracy).strain, wanted = dea_probe_row(scene, truth, accuracy).strain;
    nearness->unlike += isnan(strain) != isnan(wanted);
    if (isnan(strain) || isnan(wanted) || wanted == 0.0) {
        return;
    }
    const double deviation = (strain - wanted) / dea_probe_scale(scene, truth, accuracy, wanted);
    nearness->low = nearness->compared > 0 ? fmin(nearness->low, deviation) : deviation;
    nearness->high = nearness->compared > 0 ? fmax(nearness->high, deviation) : deviation;
    nearness->compared++;
}

/* The swing of a film that has one, relaxed and undamped: branches and dampers change it and the membrane's alike. */
static dea_status compare_swings(const dea_scene *scene, const dea_model *model, dea_nearness *nearness, dea_error *error)
{
    dea_dynamics dynamics;
    dea_status status = dea_dynamics_open(scene, model, &dynamics, error);
    if (status == DEA_OK && !isnan(dea_swing_of(&dynamics, 0.0, 0.0).frequency)) {
        const double omega = sqrt(dea_dynamics_stiffness(&dynamics, 0.0, 0.0, true) / dynamics.mass);
        const double deviation = omega / (2.0 * DEA_PI * dea_point_resonance(scene, &dynamics.point)) - 1.0;
        nearness->slow = fmin(nearness->slow, deviation); /* of a NAN and a number the number */
        nearness->fast = fmax(nearness->fast, deviation);
    }
    dea_dynamics_close(&dynamics);
    return status;
}

/* False where there is no peak to compare. */
static bool compare_peaks(const dea_scene *scene, const dea_model *model, const dea_model *truth, int *steps, dea_nearness *nearness)
{
    const double deviation = dea_first_peak_deviation(scene, model, truth, steps);
    nearness->least_peak = fmin(nearness->least_peak, deviation); /* of a NAN and a number the number */
    nearness->largest_peak = fmax(nearness->largest_peak, deviation);
    return !isnan(deviation);
}

dea_status dea_nearness_measure(const dea_scene *scene, const dea_model *model, dea_nearness *nearness, dea_error *error)
{
    const dea_model *truth = dea_model_at(dea_model_count() - 1); /* the finest */
    const size_t most = most_probes(scene), count = dea_probe_count(scene, most);
    dea_status (*const rest)(dea_scene *, dea_error *) = dea_study_of(scene)->rest;
    dea_status status = DEA_OK;
    *nearness = (dea_nearness){.slow = (double)NAN, .fast = (double)NAN, .least_peak = (double)NAN, .largest_peak = (double)NAN,
                                .whole = count == dea_scene_point_count(scene)};
    bool peaks = nearness->whole && dea_study_of(scene)->timed;
    int steps = MOST_STEPS;
    for (size_t i = 0; i < count && status == DEA_OK; i++) {
        dea_scene here = dea_probe_scene(scene, most, i);
        status = rest ? rest(&here, error) : DEA_OK;
        if (status == DEA_OK) {
            compare(&here, model, truth, nearness);
        }
        if (status == DEA_OK && rest) {
            status = compare_swings(&here, model, nearness, error);
        }
        peaks = status == DEA_OK && peaks && compare_peaks(&here, model, truth, &steps, nearness);
    }
    if (!peaks) {
        nearness->least_peak = nearness->largest_peak = (double)NAN;
    }
    return status;
}
