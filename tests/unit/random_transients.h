/* Random moving scenes from a fixed seed, for the engines in the time domain. */
#ifndef DEA_TEST_RANDOM_TRANSIENTS_H
#define DEA_TEST_RANDOM_TRANSIENTS_H

#include "random_scenes.h"

enum { RANDOM_POINTS = 5 };

/* First resonance of a film of that frame, roughly [Hz]. */
static inline double random_frequency(const dea_scene *scene)
{
    return 0.6 * scene->actuator.prestretch / scene->actuator.frame_radius *
           sqrt(6.0 * scene->material.constants[0] / scene->material.density);
}

/* Inertia, Kelvin-Voigt damper and up to three branches, whose times lie within some decades of the run. */
static inline void random_motion(uint64_t *seed, dea_scene *scene)
{
    dea_material *material = &scene->material;
    material->prony_count = (size_t)(4.0 * random_unit(seed));
    material->instantaneous = random_chance(seed, 0.3);
    for (size_t i = 0; i < material->prony_count; i++) {
        material->prony[i].g = random_between(seed, 0.02, 0.2);
        material->prony[i].tau = scene->transient.until * random_decades(seed, 1e-4, 1e2);
    }
    if (random_chance(seed, 0.4)) {
        material->retardation = scene->transient.until * random_decades(seed, 1e-5, 1e-1);
    }
}

static inline void random_wave(uint64_t *seed, dea_scene *scene, double voltage)
{
    static double times[RANDOM_POINTS], voltages[RANDOM_POINTS]; /* of the scene made last */
    dea_waveform *wave = &scene->drive.waveform;
    const double until = scene->transient.until;
    const double kind = random_unit(seed);
    *wave = (dea_waveform){.period = (double)NAN};
    if (kind < 0.5) {
        const double rise = random_chance(seed, 0.3) ? 0.0 : until * random_decades(seed, 1e-6, 0.1);
        const double on = random_chance(seed, 0.3) ? 0.0 : until * random_between(seed, 0.0, 0.3);
        const double off = random_chance(seed, 0.3) ? (double)NAN : on + rise + until * random_between(seed, 0.1, 0.5);
        wave->kind = DEA_WAVE_STEP;
        wave->step = (dea_step){.on = on, .off = off, .voltage = voltage, .rise = rise};
    } else if (kind < 0.75) {
        wave->kind = DEA_WAVE_POINTS;
        wave->times = times;
        wave->voltages = voltages;
        wave->point_count = RANDOM_POINTS;
        for (int i = 0; i < RANDOM_POINTS; i++) {
            times[i] = until * (i + 0.8 * random_unit(seed)) / RANDOM_POINTS;
            voltages[i] = voltage * random_between(seed, -1.0, 1.0);
        }
    } else {
        const double share = random_between(seed, 0.3, 1.0);
        wave->kind = DEA_WAVE_SINE;
        wave->sine = (dea_sine){.offset = voltage * (1.0 - share),
                                .amplitude = voltage * share,
                                .frequency = random_between(seed, 0.5, 8.0) / until,
                                .phase = random_between(seed, 0.0, 6.0),
                                .delay = random_chance(seed, 0.5) ? 0.0 : 0.1 * until};
    }
}

/* Static strain at a voltage, or a strain of 1 where there is none. */
static inline double static_strain(const dea_scene *scene, const char *model, double voltage)
{
    dea_scene still = *scene;
    still.drive.voltage = voltage;
    const dea_row row = solve_direct(&still, model);
    return row.state == DEA_STATE_PULL_IN ? 1.0 : fabs(row.strain);
}

/* Up to 0.6 of the pull-in voltage and no more than a strain of 0.3; a film that is not stable at rest is made stable. */
static inline double random_voltage(uint64_t *seed, dea_scene *scene, const char *model)
{
    double voltage = pull_in_voltage(scene, model);
    if (static_strain(scene, model, 1e-3 * voltage) == 1.0) {
        scene->material.constants[1] = 0.0;
        voltage = pull_in_voltage(scene, model);
    }
    voltage *= random_between(seed, 0.05, 0.6);
    return voltage * sqrt(fmin(1.0, 0.3 / static_strain(scene, model, voltage)));
}

/* A run of 10 to 60 periods where the film has inertia, else of a microsecond to a day; at up to 0.6 of the pull-in voltage,
 * which a ring overshoots up to twice. The scene owns nothing; its waveform is valid until the next one is made. */
static inline void random_transient(uint64_t *seed, dea_scene *scene)
{
    static const char *const models[] = {"lumped", "lame", "coverage", "ring"};
    const char *model = models[(int)(4.0 * random_unit(seed))];
    *scene = random_scene(seed);
    scene->actuator.coverage = random_between(seed, 0.1, 0.9);
    scene->actuator.prestretch = random_between(seed, 1.05, 2.0);
    scene->material.modulus = (double)NAN;
    scene->material.prony_count = 0;
    scene->drive.series_resistance = scene->drive.leakage_resistance = (double)NAN;
    scene->models[0] = dea_model_find(model);
    const bool heavy = random_chance(seed, 0.6);
    scene->material.density = heavy ? random_between(seed, 900.0, 1200.0) : (double)NAN;
    scene->study = DEA_STUDY_TRANSIENT;
    scene->transient.until =
        heavy ? random_between(seed, 10.0, 60.0) / random_frequency(scene) : random_decades(seed, 1e-6, 86400.0);
    scene->transient.every = scene->transient.until / (double)(int)random_between(seed, 20.0, 400.0);
    scene->transient.from_bias = random_chance(seed, 0.2);
    random_motion(seed, scene);
    random_wave(seed, scene, random_voltage(seed, scene, model));
    scene->drive.voltage = (double)NAN;
    if (random_chance(seed, 0.3)) {
        const double capacitance =
            3e-11 * 3.0 * pow(scene->actuator.frame_radius * scene->actuator.prestretch, 2.0) / scene->actuator.film_thickness;
        scene->drive.series_resistance =
            random_chance(seed, 0.2) ? (double)NAN : scene->transient.until * random_decades(seed, 1e-4, 0.3) / capacitance;
        scene->drive.leakage_resistance =
            random_chance(seed, 0.5) ? (double)NAN : scene->transient.until * random_decades(seed, 1.0, 1e3) / capacitance;
    }
    if (scene->actuator.kind == DEA_LENS && random_chance(seed, 0.3)) {
        scene->actuator.refractive_index = 1.4;
        scene->actuator.focal_length = 4.0 * scene->actuator.coverage * scene->actuator.frame_radius / 0.4;
    }
}

/* Runs sampled so coarsely, or behind so long a wait, that much of the film's physics cannot be seen. */
static inline void random_blur(uint64_t *seed, dea_scene *scene)
{
    dea_material *material = &scene->material;
    if (!isnan(material->density)) {
        const double longer = random_decades(seed, 1.0, scene->models[0]->linear ? 1e3 : 10.0);
        scene->transient.until *= longer;
        scene->transient.every *= longer;
        scene->drive.waveform.step.on *= longer;
        scene->drive.waveform.step.off *= longer;
        scene->drive.waveform.sine.frequency /= longer;
        scene->drive.waveform.sine.delay *= longer;
        for (size_t i = 0; scene->drive.waveform.kind == DEA_WAVE_POINTS && i < scene->drive.waveform.point_count; i++) {
            scene->drive.waveform.times[i] *= longer;
        }
        material->retardation =
            isnan(material->retardation) ? material->retardation : random_decades(seed, 0.02, 30.0) / random_frequency(scene);
    }
    for (size_t i = 0; i < material->prony_count; i++) {
        material->prony[i].tau = scene->transient.until * random_decades(seed, 1e-7, 1e6);
        material->prony[i].g *= random_decades(seed, 1e-4, 1.0);
    }
    if (scene->drive.series_resistance > 0.0) {
        scene->drive.series_resistance *= random_decades(seed, 1e-7, 1.0);
    }
}

#endif
