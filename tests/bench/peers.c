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

static void run_peer(const char *name, const char *command)
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
    run_peer("SciPy", command);
    snprintf(command, sizeof command, "octave-cli --no-init-file --no-site-file '%s/sweep_octave.m' 2>/dev/null", peers);
    run_peer("Octave", command);
    snprintf(command, sizeof command, "'%s/sweep_ngspice.sh' 20 2>/dev/null", peers);
    run_peer("ngspice -b", command);
}
