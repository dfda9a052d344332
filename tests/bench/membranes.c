/* The membrane (`field`) in time: the paper's protocol as examples/protocol.yaml has it, and the step whose strains physics tells, each against
 * the engine that is the more exact. */
#include "bench.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

#include "deaspice/scene.h"

enum { TEXT = 256, MOST_SAMPLES = 4096 };

static const char film[] = "actuator: {kind: dot, frame_radius: 30 mm, coverage: 0.5, film_thickness: 100 um, prestretch: 1.2}\n"
                           "model: field\n";
static const char protocol[] = "material: {base: elastosil-2030, retardation: 20 us,\n"
                               "           prony: [{g: 0.08, tau: 0.2 s}, {g: 0.05, tau: 2 s}, {g: 0.03, tau: 20 s}]}\n"
                               "drive: {waveform: {step: {on: 5 s, off: 15 s, voltage: 4500 V, rise: 1 us}}}\n"
                               "study: {transient: {until: 25 s, every: 10 ms}}\n";
static const char step[] = "material: {base: elastosil-2030, retardation: 50 us}\n"
                           "drive: {waveform: {step: {on: 0 s, voltage: 4500 V, rise: 0.1 ms}}}\n"
                           "study: {transient: {until: 8 ms, every: 0.02 ms}}\n";

static const struct {
    const char *what, *text, *engine;
    double accuracy, milliseconds; /* goals */
} runs[] = {{"field, 25 s with mass, 2501 samples", protocol, "ida", 1e-4, 100.0},
            {"field, 25 s with mass, 2501 samples", protocol, "ngspice", 1e-4, 1000.0},
            {"field, step over 8 ms, 401 samples", step, "ida", 1e-6, 7.0},
            {"field, step over 8 ms, 401 samples", step, "ngspice", 1e-4, 1000.0}};

static dea_scene scene_of(const char *text, double accuracy)
{
    char whole[2048];
    dea_scene scene;
    dea_error error = {0};
    const int length = snprintf(whole, sizeof whole, "%s%saccuracy: %g\n", film, text, accuracy);
    if (dea_scene_parse(whole, (size_t)length, "bench", ".", NULL, 0, NULL, &scene, &error) != DEA_OK) {
        bench_give_up("%s", error.message);
    }
    return scene;
}

/* Largest difference of the displacement over its peak. */
static double apart(const dea_sample *samples, const dea_sample *exact, size_t count)
{
    double most = 0.0, peak = 0.0;
    for (size_t i = 0; i < count; i++) {
        const double off = fabs(samples[i].displacement - exact[i].displacement);
        peak = fmax(peak, fabs(exact[i].displacement));
        most = off <= most ? most : isnan(off) ? (double)INFINITY : off;
    }
    return most / peak;
}

void bench_membranes(void)
{
    dea_sample *samples = bench_shared(MOST_SAMPLES * sizeof *samples), *exact = bench_shared(MOST_SAMPLES * sizeof *exact);
    const char *before = NULL;
    for (size_t i = 0; i < sizeof runs / sizeof *runs; i++) {
        char what[TEXT], aim[TEXT], measured[TEXT], wrong[TEXT];
        dea_scene scene = scene_of(runs[i].text, runs[i].accuracy), truth = scene_of(runs[i].text, 1e-9);
        if (runs[i].text != before) {
            bench_transient(dea_engine_find("ida"), &truth, exact);
            before = runs[i].text;
        }
        const double seconds = bench_transient(dea_engine_find(runs[i].engine), &scene, samples);
        const double error = apart(samples, exact, dea_layout_of(&scene).rows);
        snprintf(what, sizeof what, "%s, accuracy %.0e, %s", runs[i].engine, runs[i].accuracy, runs[i].what);
        snprintf(aim, sizeof aim, "%g ms, %.0e of the peak", runs[i].milliseconds, runs[i].accuracy);
        snprintf(measured, sizeof measured, "%.3g ms", 1e3 * seconds);
        snprintf(wrong, sizeof wrong, "%.1e of the peak", error);
        bench_row(what, aim, 1e3 * seconds <= runs[i].milliseconds && error <= runs[i].accuracy, measured, wrong);
        dea_scene_free(&scene);
        dea_scene_free(&truth);
    }
}
