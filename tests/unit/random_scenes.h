/* Random scenes from a fixed seed. */
#ifndef DEA_TEST_RANDOM_SCENES_H
#define DEA_TEST_RANDOM_SCENES_H

#include "scenes.h"

/* xorshift64*, so that the scenes are the same on every machine. */
static inline double random_unit(uint64_t *seed)
{
    *seed ^= *seed >> 12;
    *seed ^= *seed << 25;
    *seed ^= *seed >> 27;
    return (double)((*seed * UINT64_C(2685821657736338717)) >> 11) * 0x1p-53;
}

static inline double random_between(uint64_t *seed, double low, double high)
{
    return low + (high - low) * random_unit(seed);
}

static inline double random_decades(uint64_t *seed, double low, double high)
{
    return exp(random_between(seed, log(low), log(high)));
}

static inline bool random_chance(uint64_t *seed, double share)
{
    return random_unit(seed) < share;
}

static inline void random_material(uint64_t *seed, dea_material *material)
{
    *material = dea_material_default();
    material->constants[0] = random_decades(seed, 1e4, 1e6);
    material->constants[1] = random_chance(seed, 0.2) ? 0.0 : material->constants[0] * random_between(seed, -0.2, 0.1);
    material->constants[2] = random_chance(seed, 0.3) ? 0.0 : material->constants[0] * random_between(seed, 0.0, 0.05);
    material->permittivity = random_between(seed, 2.0, 10.0);
    if (random_chance(seed, 0.3)) {
        material->permittivity_per_stretch = random_between(seed, -0.5, 0.5);
    }
    if (random_chance(seed, 0.2)) {
        material->modulus = material->constants[0] * random_between(seed, 3.0, 10.0);
    }
    if (random_chance(seed, 0.3)) {
        material->prony_count = 2;
        material->prony[0] = (dea_prony){.g = random_between(seed, 0.05, 0.3), .tau = 1.0};
        material->prony[1] = (dea_prony){.g = random_between(seed, 0.05, 0.3), .tau = 10.0};
        material->instantaneous = random_chance(seed, 0.7);
    }
}

/* Ratios near 0, in the middle, and near 1. */
static inline double random_coverage(uint64_t *seed)
{
    const double where = random_unit(seed);
    return where < 0.2   ? random_decades(seed, 1e-3, 0.1)
           : where < 0.4 ? 1.0 - random_decades(seed, 1e-3, 0.1)
                         : random_between(seed, 0.05, 0.95);
}

/* A scene without voltage and axes. */
static inline dea_scene random_scene(uint64_t *seed)
{
    dea_scene scene =
        paper_scene(random_chance(seed, 0.5) ? DEA_LENS : DEA_DOT, random_between(seed, 1.0, 3.0), random_coverage(seed), 0.0);
    scene.actuator.film_thickness = random_decades(seed, 1e-6, 1e-2);
    scene.actuator.frame_radius = random_decades(seed, 1e-4, 1.0);
    random_material(seed, &scene.material);
    if (random_chance(seed, 0.3)) {
        scene.drive.series_resistance = random_decades(seed, 1e3, 1e8);
        scene.drive.leakage_resistance = random_decades(seed, 1e7, 1e11);
    }
    return scene;
}

/* Voltage at which the model pulls in, below @p most; where it never does, that; where the film is unstable at rest, a millionth of
 * it. */
static inline double pull_in_below(const dea_scene *scene, const char *model, double most)
{
    dea_scene here = *scene;
    double high = most;
    double low = 0.0;
    here.drive.voltage = most;
    if (solve_direct(&here, model).state != DEA_STATE_PULL_IN) {
        return most;
    }
    while (high - low > 1e-3 * high && high > 1e-6 * most) {
        here.drive.voltage = 0.5 * (low + high);
        *(solve_direct(&here, model).state == DEA_STATE_PULL_IN ? &high : &low) = here.drive.voltage;
    }
    return high;
}

/* The same of a Yeoh film, below a voltage that strains it well. */
static inline double pull_in_voltage(const dea_scene *scene, const char *model)
{
    const double most =
        scene->actuator.film_thickness * sqrt(3.0 * scene->material.constants[0] / DEA_EPSILON_0) / scene->actuator.prestretch;
    return pull_in_below(scene, model, most);
}

enum { SWEPT_FIELDS = 14 };

/* Every kind of scalar that a static scene can sweep; the scene is made to give it a value. */
static inline double *swept_field(dea_scene *scene, int kind)
{
    dea_actuator *actuator = &scene->actuator;
    dea_material *material = &scene->material;
    if (kind == 2 && isnan(actuator->divide_radius)) {
        actuator->divide_radius = actuator->coverage * actuator->frame_radius;
        actuator->coverage = (double)NAN;
    }
    if (kind >= 9 && kind <= 10 && isnan(scene->drive.series_resistance)) {
        scene->drive.series_resistance = 1e6;
        scene->drive.leakage_resistance = 1e7;
    }
    if (kind == 11 && isnan(material->modulus)) {
        material->modulus = 6.0 * material->constants[0];
    }
    if (kind == 12 && material->prony_count == 0) {
        material->prony_count = 1;
        material->prony[0] = (dea_prony){.g = 0.3, .tau = 1.0};
        material->instantaneous = true;
    }
    if (kind == 13) {
        material->permittivity_per_stretch = -0.1;
    }
    double *const fields[SWEPT_FIELDS] = {
        &scene->drive.voltage,
        &actuator->coverage,
        &actuator->divide_radius,
        &actuator->frame_radius,
        &actuator->film_thickness,
        &actuator->prestretch,
        &material->constants[0],
        &material->constants[1],
        &material->constants[2],
        &scene->drive.series_resistance,
        &scene->drive.leakage_resistance,
        &material->modulus,
        &material->prony[0].g,
        &material->permittivity_per_stretch,
    };
    if (kind == 1 && isnan(actuator->coverage)) {
        actuator->coverage = actuator->divide_radius / actuator->frame_radius;
        actuator->divide_radius = (double)NAN;
    }
    return fields[kind];
}

#endif
