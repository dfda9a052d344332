/* Speed of the engines inside one process, each with the error of the same rows. */
#include "bench.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <ngspice/sharedspice.h>

#include "engine/ngspice/library.h"

enum { MANY = 100000, ALTERED = 400, COLUMN = 128 };

static const char *const coverages = "    coverage: {from: 0.05, to: 0.95, points: %zu}\n";
static const char *const voltages = "    voltage: {from: 45 V, to: 4500 V, points: %zu}\n";

static dea_scene line_scene(const char *model, const char *axis, size_t points)
{
    char sweep[COLUMN];
    snprintf(sweep, sizeof sweep, axis, points);
    return bench_scene("dot", model, 1.2, 1e-6, sweep);
}

/* Largest relative error of the strain at some hundred points: against extended precision, or against a finer mesh. */
static double error_of(const dea_scene *scene, const dea_row *rows, size_t count)
{
    const dea_model *model = scene->models[0];
    double worst = 0.0;
    for (size_t i = 0; i < count; i += count / 128 + 1) {
        dea_scene here = *scene;
        *(double *)((char *)&here + scene->axes[0].offset) = scene->axes[0].values[i];
        dea_point point;
        dea_film_prepare(&here, &point.film);
        dea_point_place(&here, &point);
        long double exact = bench_strain(model->name, &point);
        if (isnan(exact)) {
            dea_row row;
            model->solve(&point, 1e-12, &row);
            exact = row.strain;
        }
        const double error = (double)(fabsl((long double)rows[i].strain - exact) / fabsl(exact));
        worst = error <= worst ? worst : isnan(error) ? INFINITY : error;
    }
    return worst;
}

/* The engine direct over coverage and over voltage; the slower counts. */
static void direct_row(const char *model, size_t points, double goal, const char *goal_text)
{
    const char *const axes[] = {coverages, voltages};
    double rate[2], error = 0.0;
    dea_row *rows = calloc(points, sizeof *rows);
    for (int k = 0; rows && k < 2; k++) {
        double seconds[BENCH_RUNS + 2];
        dea_scene scene = line_scene(model, axes[k], points);
        bench_sweep(dea_engine_find("direct"), &scene, rows);
        for (int i = 0; i < BENCH_RUNS + 2; i++) {
            seconds[i] = bench_sweep(dea_engine_find("direct"), &scene, rows);
        }
        rate[k] = (double)points / bench_median(seconds, BENCH_RUNS + 2);
        error = fmax(error, error_of(&scene, rows, points));
        dea_scene_free(&scene);
    }
    free(rows);
    char what[COLUMN], measured[COLUMN], wrong[COLUMN];
    snprintf(what, sizeof what, "direct, one core, %s, over coverage; over voltage", model);
    snprintf(measured, sizeof measured, "%.3g; %.3g points/s", rate[0], rate[1]);
    snprintf(wrong, sizeof wrong, "%.1e %s", error, strcmp(model, "field") == 0 ? "against a finer mesh" : "relative");
    bench_row(what, goal_text, fmin(rate[0], rate[1]) >= goal, measured, wrong);
}

/* What a user of libngspice would do: three values altered, `op`, one value read. */
typedef struct alter_job {
    double seconds; /* a point, NAN where it failed */
    double error;
} alter_job;

static void alter(const char *element, double value)
{
    char line[COLUMN];
    snprintf(line, sizeof line, "alter %s=%.17g", element, value);
    ngSpice_Command(line);
}

static bool load_pair(void)
{
    char *cards[] = {"* two springs and a force", "ra edge 0 1", "rp edge 0 1", "if 0 edge 1", ".end", NULL};
    return ngSpice_Circ(cards) == 0;
}

static void run_altered(void *argument)
{
    alter_job *job = argument;
    dea_error error = {0};
    dea_ngspice *library;
    dea_scene scene = line_scene("lumped", coverages, ALTERED);
    dea_point point;
    if (dea_ngspice_open(&library, &error) != DEA_OK || !load_pair()) {
        return;
    }
    dea_film_prepare(&scene, &point.film);
    const double from = bench_now();
    for (size_t i = 0; i < ALTERED; i++) {
        scene.actuator.coverage = scene.axes[0].values[i];
        dea_point_place(&scene, &point);
        const double divide = point.coverage * point.frame_radius, nominal = point.voltage / point.film_thickness;
        const double section = 2.0 * acos(-1.0) * divide * point.film_thickness / point.film.square;
        const double tensile = point.film.modulus * section;
        alter("ra", divide / tensile);
        alter("rp", (point.frame_radius - divide) / tensile);
        alter("if", point.film.permittivity * pow(point.film.square * nominal, 2.0) * section);
        char op[] = "op", edge[] = "edge", destroy[] = "destroy all";
        ngSpice_Command(op);
        const pvector_info info = ngGet_Vec_Info(edge);
        const double strain = info && info->v_length == 1 ? info->v_realdata[0] / divide : NAN;
        ngSpice_Command(destroy);
        ngSpice_Command(NULL);
        job->error = fmax(job->error, (double)fabsl(strain / bench_strain("lumped", &point) - 1.0L));
    }
    job->seconds = (bench_now() - from) / ALTERED;
}

/* Microseconds a point of the script that starts ngspice once a point, NAN without the program. */
static double batch_seconds(const char *peers)
{
    char command[4096], line[COLUMN], model[16];
    double microseconds = NAN;
    snprintf(command, sizeof command, "command -v ngspice >/dev/null && '%s/sweep_ngspice.sh' 20 2>/dev/null", peers);
    FILE *pipe = popen(command, "r");
    while (pipe && fgets(line, sizeof line, pipe)) {
        sscanf(line, "%15[^,],%lf", model, &microseconds);
    }
    if (pipe) {
        pclose(pipe);
    }
    return 1e-6 * microseconds;
}

/* All three ways in one run, BENCH_RUNS times. */
static void ngspice_lumped_row(const char *peers)
{
    double engine[BENCH_RUNS], batch[BENCH_RUNS], altered[BENCH_RUNS], to_batch[BENCH_RUNS], to_altered[BENCH_RUNS];
    dea_scene scene = line_scene("lumped", coverages, MANY);
    dea_row *rows = bench_shared(MANY * sizeof *rows);
    alter_job *job = bench_shared(sizeof *job);
    for (int i = 0; i < BENCH_RUNS; i++) {
        engine[i] = bench_sweep(dea_engine_find("ngspice"), &scene, rows) / MANY;
        *job = (alter_job){.seconds = NAN};
        bench_fork(run_altered, job);
        altered[i] = job->seconds;
        batch[i] = batch_seconds(peers);
        to_batch[i] = batch[i] / engine[i];
        to_altered[i] = altered[i] / engine[i];
    }
    const double time = 1e6 * bench_median(engine, BENCH_RUNS);
    const double times[2] = {bench_median(to_batch, BENCH_RUNS), bench_median(to_altered, BENCH_RUNS)};
    char measured[COLUMN], wrong[COLUMN];
    snprintf(measured, sizeof measured, "%.2f us, %.0f times, %.1f times", time, times[0], times[1]);
    snprintf(wrong, sizeof wrong, "%.1e relative", error_of(&scene, rows, MANY));
    bench_row("ngspice, 100,000 points, one core, lumped", "4 us; 1000 x `ngspice -b`; 5 x alter + op",
              time <= 4.0 && !(times[0] < 1000.0) && times[1] >= 5.0, measured, wrong);
    snprintf(measured, sizeof measured, "%.0f us", 1e6 * bench_median(batch, BENCH_RUNS));
    bench_row("  beside it: `ngspice -b` once a point", "", -1, measured, "");
    snprintf(measured, sizeof measured, "%.1f us", 1e6 * bench_median(altered, BENCH_RUNS));
    snprintf(wrong, sizeof wrong, "%.1e relative", job->error);
    bench_row("  beside it: libngspice, 3 alter + op + read", "", -1, measured, wrong);
    dea_scene_free(&scene);
}

/* One core of ngspice over many points of an axis, against a goal in microseconds a point. */
static void ngspice_row(const char *model, const char *axis, const char *along, double accuracy, double goal)
{
    double seconds[BENCH_RUNS];
    dea_scene scene = line_scene(model, axis, MANY);
    dea_row *rows = bench_shared(MANY * sizeof *rows);
    scene.accuracy = accuracy;
    for (int i = 0; i < BENCH_RUNS; i++) {
        seconds[i] = bench_sweep(dea_engine_find("ngspice"), &scene, rows);
    }
    char what[COLUMN], aim[COLUMN], measured[COLUMN], wrong[COLUMN];
    const double time = 1e6 * bench_median(seconds, BENCH_RUNS) / MANY, error = error_of(&scene, rows, MANY);
    snprintf(what, sizeof what, "ngspice, 100,000 points, one core, %s over %s, %.0e", model, along, accuracy);
    snprintf(aim, sizeof aim, "%g us", goal);
    snprintf(measured, sizeof measured, "%.2f us", time);
    snprintf(wrong, sizeof wrong, "%.1e relative", error);
    bench_row(what, aim, time <= goal && error <= accuracy, measured, wrong);
    dea_scene_free(&scene);
}

/* Is the closed form of lame as cheap as that of lumped? Both in turn, over coverage and over voltage; the worse counts. */
static void lame_row(void)
{
    enum { POINTS = 500000, TURNS = 2 * BENCH_RUNS + 1 };
    const char *const axes[] = {coverages, voltages}, *const models[] = {"lumped", "lame"};
    double ratio[2], error = 0.0;
    dea_row *rows = calloc(POINTS, sizeof *rows);
    for (int k = 0; rows && k < 2; k++) {
        double seconds[2][TURNS];
        dea_scene scenes[2] = {line_scene(models[0], axes[k], POINTS), line_scene(models[1], axes[k], POINTS)};
        bench_sweep(dea_engine_find("direct"), &scenes[0], rows);
        for (int i = 0; i < 2 * TURNS; i++) {
            seconds[i % 2][i / 2] = bench_sweep(dea_engine_find("direct"), &scenes[i % 2], rows);
        }
        ratio[k] = bench_median(seconds[1], TURNS) / bench_median(seconds[0], TURNS);
        error = fmax(error, error_of(&scenes[1], rows, POINTS));
        dea_scene_free(&scenes[0]);
        dea_scene_free(&scenes[1]);
    }
    free(rows);
    char measured[COLUMN], wrong[COLUMN];
    snprintf(measured, sizeof measured, "%.2f; %.2f times", ratio[0], ratio[1]);
    snprintf(wrong, sizeof wrong, "%.1e relative", error);
    bench_row("direct, lame against lumped, over coverage; over voltage", "at most 2 times", fmax(ratio[0], ratio[1]) <= 2.0,
              measured, wrong);
}

void bench_engines(const char *peers)
{
    ngspice_lumped_row(peers);
    ngspice_row("coverage", coverages, "coverage", 1e-6, 10.0);
    ngspice_row("field", voltages, "voltage", 1e-9, 50.0);
    ngspice_row("field", coverages, "coverage", 1e-6, 1000.0);
    direct_row("lumped", 2000000, 50e6, "50 M points/s");
    lame_row();
    direct_row("coverage", 500000, 5e6, "5 M points/s");
    direct_row("field", 10000, 20e3, "20 k points/s");
}
