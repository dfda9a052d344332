/* The same sweeps by the tools that users have at hand: time a point, and how far their strain is from that of direct. */
#include "bench.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { TEXT = 256 };

/* What a peer script printed of one model: the median of several runs. */
typedef struct peer_result {
    char model[16];
    double microseconds[BENCH_RUNS];
    size_t runs;
    double worst; /* relative difference of the strain to direct */
} peer_result;

static double strain_of(const char *model, double coverage)
{
    char sweep[64];
    dea_row row;
    snprintf(sweep, sizeof sweep, "    coverage: [%.17g]\n", coverage);
    dea_scene scene = bench_scene("dot", model, 1.2, 1e-9, sweep);
    bench_sweep(dea_engine_find("direct"), &scene, &row);
    dea_scene_free(&scene);
    return row.strain;
}

static void take_line(peer_result results[3], const char *line, size_t run)
{
    char model[16];
    double microseconds, coverage, strain;
    if (sscanf(line, "%15[^,],%lf,%lf,%lf", model, &microseconds, &coverage, &strain) != 4) {
        return;
    }
    for (size_t i = 0; i < 3; i++) {
        peer_result *result = &results[i];
        if (strcmp(result->model, model) == 0) {
            result->microseconds[run] = microseconds;
            result->runs = run + 1;
            result->worst = fmax(result->worst, fabs(strain / strain_of(model, coverage) - 1.0));
        }
    }
}

/* Microseconds a point of direct over the peers' sweep, and its error at their points: median of runs of this moment. */
static double direct_time(const char *model, double *error)
{
    enum { POINTS = 401, TURNS = 2 * BENCH_RUNS + 1 };
    double seconds[TURNS];
    dea_row rows[POINTS];
    dea_scene scene = bench_scene("dot", model, 1.2, 1e-6, "    coverage: {from: 0.1, to: 0.9, points: 401}\n");
    for (int i = 0; i < TURNS; i++) {
        seconds[i] = bench_sweep(dea_engine_find("direct"), &scene, rows);
    }
    *error = 0.0;
    for (size_t i = 0; i < POINTS; i += 100) {
        scene.actuator.coverage = scene.axes[0].values[i];
        dea_point point;
        dea_film_prepare(&scene, &point.film);
        dea_point_place(&scene, &point);
        *error = fmax(*error, (double)fabsl((long double)rows[i].strain / bench_strain(model, &point) - 1.0L));
    }
    dea_scene_free(&scene);
    return 1e6 * bench_median(seconds, TURNS) / POINTS;
}

/* direct against a peer on the model `coverage`, where both are good to rounding. */
static void ratio_row(const char *name, const peer_result *result, double goal)
{
    char what[TEXT], aim[TEXT], measured[TEXT], wrong[TEXT];
    double error, microseconds[BENCH_RUNS];
    memcpy(microseconds, result->microseconds, sizeof microseconds);
    const double ratio = bench_median(microseconds, result->runs) / direct_time("coverage", &error);
    snprintf(what, sizeof what, "best engine (direct) against %s, coverage", name);
    snprintf(aim, sizeof aim, "%g times", goal);
    snprintf(measured, sizeof measured, "%.0f times", ratio);
    snprintf(wrong, sizeof wrong, "%.1e against %.1e", error, result->worst);
    bench_row(what, aim, ratio >= goal, measured, wrong);
}

/* @p goal is that of `coverage`, 0: none. */
static void run_peer(const char *name, const char *command, double goal)
{
    peer_result results[3] = {{.model = "lumped"}, {.model = "coverage"}, {.model = "field"}};
    char line[TEXT], what[TEXT], measured[TEXT], wrong[TEXT];
    for (size_t run = 0; run < BENCH_RUNS; run++) {
        FILE *pipe = popen(command, "r");
        while (pipe && fgets(line, sizeof line, pipe)) {
            take_line(results, line, run);
        }
        if (pipe) {
            pclose(pipe);
        }
    }
    for (size_t i = 0; i < 3; i++) {
        snprintf(what, sizeof what, "peer: %s, %s", name, results[i].model);
        if (results[i].runs > 0) {
            snprintf(measured, sizeof measured, "%.4g us a point", bench_median(results[i].microseconds, results[i].runs));
            snprintf(wrong, sizeof wrong, "%.1e against direct", results[i].worst);
            bench_row(what, "", -1, measured, wrong);
        }
    }
    if (goal > 0.0 && results[1].runs > 0) {
        ratio_row(name, &results[1], goal);
    }
    if (results[0].runs == 0) {
        snprintf(what, sizeof what, "peer: %s", name);
        bench_row(what, "", -1, "not installed", "");
    }
}

void bench_peers(const char *peers)
{
    char command[4096];
    snprintf(command, sizeof command,
             "for p in python3 /usr/bin/python3; do $p -c 'import scipy' 2>/dev/null && exec $p '%s/sweep_scipy.py'; done",
             peers);
    run_peer("SciPy", command, 50.0);
    snprintf(command, sizeof command, "octave-cli --no-init-file --no-site-file '%s/sweep_octave.m' 2>/dev/null", peers);
    run_peer("Octave", command, 5000.0);
    snprintf(command, sizeof command, "'%s/sweep_ngspice.sh' 20 2>/dev/null", peers);
    run_peer("ngspice -b", command, 0.0);
}
