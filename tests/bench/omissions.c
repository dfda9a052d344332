/* What leaving out pays: runs with and without what their samples cannot see, and whether the bounds hold. */
#include "bench.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "deaspice/needs.h"

#include "../unit/random_transients.h"

enum { SCENES = 200, FEW = 40, TEXT = 128 };

/* One run: its seconds, NAN where it was not solved, and its displacements. */
typedef struct timed {
    const dea_scene *scene;
    double seconds;
    double *u; /* owned: of all samples */
} timed;

static dea_status take(void *user, size_t first, const void *points, size_t count, dea_error *error)
{
    timed *run = user;
    const dea_sample *samples = points;
    (void)first, (void)count, (void)error;
    for (size_t i = 0; i < dea_layout_of(run->scene).rows; i++) {
        run->u[i] = samples[i].state == DEA_STATE_FAILED ? (double)NAN : samples[i].displacement;
    }
    return DEA_OK;
}

static timed run(const dea_scene *scene, const char *engine, bool full)
{
    timed result = {.scene = scene, .u = calloc(dea_layout_of(scene).rows, sizeof(double))};
    const dea_run_options options = {.jobs = 1, .points = take, .user = &result};
    dea_scene here = *scene;
    here.full = full;
    const double from = bench_now();
    const dea_status status = dea_study_run(&here, dea_engine_find(engine), &options, NULL);
    result.seconds = status == DEA_OK && !isnan(result.u[0]) ? bench_now() - from : (double)NAN;
    return result;
}

static double difference(const timed *a, const timed *b)
{
    double worst = 0.0, peak = 0.0;
    for (size_t i = 0; i < dea_layout_of(a->scene).rows; i++) {
        worst = fmax(worst, fabs(a->u[i] - b->u[i]));
        peak = fmax(peak, fabs(b->u[i]));
    }
    return worst / peak;
}

/* The paper's protocol of the examples, one run, at its accuracy. */
static void protocol_row(const char *path, const char *engine, double goal)
{
    static const dea_setting settings[] = {{"study.over={}"}, {"actuator.coverage=0.5"}};
    double ratios[BENCH_RUNS], times[BENCH_RUNS], error = 0.0;
    char what[TEXT], measured[TEXT], wrong[TEXT], wanted[TEXT] = "";
    dea_scene scene;
    dea_error why = {0};
    if (dea_scene_read(path, settings, 2, NULL, &scene, &why) != DEA_OK) {
        bench_give_up("%s", why.message);
    }
    timed exact = run(&scene, "direct", true);
    for (int i = 0; i < BENCH_RUNS; i++) {
        timed whole = run(&scene, engine, true), part = run(&scene, engine, false);
        times[i] = part.seconds;
        ratios[i] = whole.seconds / part.seconds;
        error = fmax(error, difference(&part, &exact));
        free(whole.u);
        free(part.u);
    }
    const double times_faster = bench_median(ratios, BENCH_RUNS);
    snprintf(what, sizeof what, "protocol, 100 frames/s, %s: what samples need / all", engine);
    snprintf(measured, sizeof measured, "%.1f times, %.3g ms", times_faster, 1e3 * bench_median(times, BENCH_RUNS));
    snprintf(wrong, sizeof wrong, "%.1e, %g wanted", error, scene.accuracy);
    wanted[0] = '\0';
    if (goal > 0.0) {
        snprintf(wanted, sizeof wanted, "%g times", goal);
    }
    bench_row(what, wanted, goal > 0.0 ? times_faster >= goal : -1, measured, wrong);
    free(exact.u);
    dea_scene_free(&scene);
}

typedef struct tally {
    double ratios[SCENES]; /* of runs that leave something out */
    size_t reduced, omissions, unjudged, broken;
    double closest; /* measured change over bound */
} tally;

static void count_bounds(const dea_scene *scene, const dea_needs *needs, tally *t)
{
    dea_measured measured[DEA_OMISSIONS];
    if (dea_needs_measure(scene, scene->models[0], needs, measured, NULL) != DEA_OK) {
        bench_give_up("omissions could not be measured");
    }
    for (size_t i = 0; i < needs->count; i++) {
        const bool judged = measured[i].verdict != DEA_NOT_JUDGED;
        t->omissions++;
        t->unjudged += judged ? 0 : 1;
        t->broken += measured[i].verdict == DEA_BROKEN ? 1 : 0;
        t->closest = fmax(t->closest, judged ? measured[i].change / needs->omissions[i].bound : 0.0);
    }
}

static void random_rows(const char *engine, uint64_t scenes)
{
    static tally t;
    t = (tally){.closest = 0.0};
    for (uint64_t i = 1; i <= scenes; i++) {
        uint64_t seed = 7000003u * i;
        dea_scene scene;
        dea_needs needs;
        random_transient(&seed, &scene);
        random_blur(&seed, &scene);
        scene.accuracy = random_decades(&seed, 1e-5, 1e-2);
        if (dea_needs_find(&scene, scene.models[0], dea_engine_find(engine), &needs, NULL) != DEA_OK || needs.count == 0) {
            continue;
        }
        count_bounds(&scene, &needs, &t);
        timed whole = run(&scene, engine, true), part = run(&scene, engine, false);
        if (whole.seconds > 0.0 && part.seconds > 0.0) {
            t.ratios[t.reduced++] = whole.seconds / part.seconds;
        }
        free(whole.u);
        free(part.u);
    }
    char what[TEXT], measured[TEXT], wrong[TEXT];
    const double median = bench_median(t.ratios, t.reduced);
    snprintf(what, sizeof what, "%d random transients, %s: what samples need / all", (int)scenes, engine);
    snprintf(measured, sizeof measured, "median %.2f times (%zu runs), most %.0f", median, t.reduced, t.ratios[t.reduced - 1]);
    snprintf(wrong, sizeof wrong, "%zu of %zu bounds broken, %zu unjudged; change/bound <= %.2g", t.broken, t.omissions,
             t.unjudged, t.closest);
    bench_row(what, "no bound broken", t.broken == 0, measured, wrong);
}

void bench_omissions(const char *examples)
{
    char path[4096];
    snprintf(path, sizeof path, "%s/protocol.yaml", examples);
    protocol_row(path, "ngspice", 20.0);
    protocol_row(path, "ida", 0.0);
    random_rows("ida", SCENES);
    random_rows("ngspice", FEW); /* takes minutes with all parts */
}
