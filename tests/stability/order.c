/* Orders of convergence: error against the step, the tolerance or the accuracy that a method is given. */
#include "stability.h"

#include "../bench/bench.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "engine/ida/flight.h"
#include "engine/ngspice/track.h"
#include "model/field.h"

enum { MOST_RUNS = 8 };

/* What one method did at one knob after the other. */
typedef struct series {
    double knob[MOST_RUNS], error[MOST_RUNS];
    size_t count;
} series;

static void add(series *s, double knob, double error)
{
    s->knob[s->count] = knob;
    s->error[s->count++] = error;
}

/* Slope of log error over log knob by least squares. */
static double slope(const series *s)
{
    double x = 0.0, y = 0.0, xx = 0.0, xy = 0.0;
    for (size_t i = 0; i < s->count; i++) {
        const double a = log(s->knob[i]), b = log(s->error[i]);
        x += a, y += b, xx += a * a, xy += a * b;
    }
    const double n = (double)s->count;
    return (n * xy - x * y) / (n * xx - x * x);
}

static stability_order order_of(const stability_case *which, const series *s)
{
    return (stability_order){.which = which, .slope = slope(s), .largest = s->error[0], .least = s->error[s->count - 1]};
}

#define FILM "yeoh: {C1: 178426 Pa, C2: -6023 Pa, C3: 4234 Pa}, permittivity: 2.8"
#define DOT "actuator: {kind: dot, frame_radius: 30 mm, coverage: 0.5, film_thickness: 100 um, prestretch: 1.2}\n"
#define BRANCHES ", prony: [{g: 0.1, tau: 0.03 s}, {g: 0.1, tau: 0.3 s}, {g: 0.05, tau: 3 s}]"
#define STEP                                                                                                                     \
    "drive: {waveform: {step: {on: 10 ms, voltage: 4.5 kV, rise: 1 us}}}\nstudy: {transient: {until: 0.2 s, every: 1 ms}}\n"
#define SLOW                                                                                                                     \
    "drive: {waveform: {step: {on: 0 s, voltage: 4.5 kV, rise: 0 s}}}\nstudy: {transient: {until: 0.2 s, every: 20 ms}}\n"
#define JUMP                                                                                                                     \
    "drive: {waveform: {step: {on: 0 s, voltage: 4.5 kV, rise: 0 s}}}\nstudy: {transient: {until: 0.05 s, every: 10 ms}}\n"
#define SINE                                                                                                                     \
    "drive: {series_resistance: 10 MOhm, waveform: {sine: {offset: 2 kV, amplitude: 1 kV, frequency: 20 Hz}}}\n"                 \
    "study: {transient: {until: 0.5 s, every: 100 ms}}\n"
#define HEAVY DOT "material: {" FILM ", density: 1080 kg/m^3" BRANCHES "}\n"
#define LIGHT DOT "material: {" FILM BRANCHES "}\n"
#define VISCOUS DOT "material: {" FILM ", retardation: 5 ms" BRANCHES "}\n"
#define SWEEP DOT "material: {" FILM "}\ndrive: {voltage: 6 kV}\nstudy: {sweep: {prestretch: [1.1, 1.2, 1.3]}}\n"

/* Displacements at the samples, relative to the peak of the reference. */
static double apart(const double *u, const double *exact, size_t count)
{
    double worst = 0.0, peak = 0.0;
    for (size_t i = 0; i < count; i++) {
        worst = fmax(worst, fabs(u[i] - exact[i]));
        peak = fmax(peak, fabs(exact[i]));
    }
    return worst / peak;
}

/* Room for displacements; the caller frees it. */
static double *displacements(size_t count)
{
    double *u = calloc(count, sizeof *u);
    if (!u) {
        bench_give_up("out of memory for %zu displacements", count);
    }
    return u;
}

/* Displacements by another engine at its best; the caller frees them. */
static double *reference(const dea_scene *scene, const char *engine, double accuracy)
{
    dea_scene best = *scene;
    best.accuracy = accuracy;
    stability_answer answer = stability_run(&best, engine);
    const size_t rows = dea_layout_of(scene).rows;
    double *u = displacements(rows);
    const dea_sample *samples = (const dea_sample *)(const void *)answer.points;
    for (size_t i = 0; i < rows; i++) {
        u[i] = samples[i].displacement;
    }
    free(answer.points);
    return u;
}

/* ---- ngspice: time steps halved from run to run */

typedef struct ngspice_job {
    const dea_scene *scene;
    const double *exact;
    series plain, extrapolated; /* of second and fourth order */
} ngspice_job;

static void read_track(const dea_track *track, size_t count, double *u)
{
    for (size_t i = 0; i < count; i++) {
        u[i] = track->points[i].u;
    }
}

static dea_status run_tracks(ngspice_job *job, const dea_route *route, dea_error *error)
{
    const size_t count = route->samples;
    double *before = displacements(3 * count), *now = before + count, *better = now + count;
    dea_status status = DEA_OK;
    double fineness = 0.5;
    for (int i = 0; i < 5 && status == DEA_OK; i++, fineness *= 0.5) {
        dea_track track;
        status = dea_track_run(route, fineness, &track, error);
        if (status == DEA_OK) {
            read_track(&track, count, now);
            add(&job->plain, fineness, apart(now, job->exact, count));
            for (size_t k = 0; k < count && i > 0; k++) {
                better[k] = now[k] + (now[k] - before[k]) / 3.0;
            }
            if (i > 0) {
                add(&job->extrapolated, fineness, apart(better, job->exact, count));
            }
            memcpy(before, now, count * sizeof *now);
        }
        free(track.points);
    }
    free(before);
    return status;
}

/* The engine's own way to a run. */
static dea_status lay_route(ngspice_job *job, dea_error *error)
{
    dea_dynamics dynamics;
    dea_mobility mobility = {0};
    dea_signal signal = {0};
    dea_pieces pieces = {0};
    dea_ngspice *library = NULL;
    dea_status status = dea_dynamics_open(job->scene, job->scene->models[0], &dynamics, error);
    status = status == DEA_OK ? dea_mobility_open(job->scene, &dynamics, &mobility, error) : status;
    status = status == DEA_OK ? dea_signal_open(job->scene, &signal, error) : status;
    status = status == DEA_OK ? dea_ngspice_open(&library, error) : status;
    if (status == DEA_OK) {
        const dea_pace pace = dea_pace_of(&dynamics, 0.0, 0.0);
        dea_dynamics slow = dynamics;
        slow.mass = slow.retardation = 0.0;
        if (!(dynamics.mass > 0.0)) {
            dea_mobility_displace(&mobility);
        }
        dea_route route = {.library = library,
                           .scene = job->scene,
                           .dynamics = &dynamics,
                           .slow = &slow,
                           .mobility = &mobility,
                           .signal = &signal,
                           .pieces = &pieces,
                           .samples = dea_layout_of(job->scene).rows,
                           .voltage = signal.largest,
                           .scale = dea_dynamics_scale(&dynamics, signal.largest),
                           .omega = pace.omega,
                           .unit = 1.0};
        status = dea_pieces_cut(&signal, &pace, 1e-6, 0.0, true, &pieces, error);
        status = status == DEA_OK ? run_tracks(job, &route, error) : status;
    }
    free(pieces.pieces);
    dea_signal_close(&signal);
    dea_mobility_close(&mobility);
    dea_dynamics_close(&dynamics);
    dea_ngspice_close(library);
    return status;
}

/* In a child, which the library changes. */
static void run_in_child(void *argument)
{
    dea_error error = {0};
    if (lay_route(argument, &error) != DEA_OK) {
        bench_give_up("ngspice: %s", error.message);
    }
}

static stability_order measure_ngspice(const stability_case *which, bool extrapolated)
{
    dea_scene scene = stability_scene(which->scene);
    const bool linear = scene.models[0]->linear != NULL;
    double *exact = reference(&scene, linear ? "direct" : "ida", linear ? 1e-12 : 1e-9);
    ngspice_job *job = bench_shared(sizeof *job);
    *job = (ngspice_job){.scene = &scene, .exact = exact};
    if (!bench_fork(run_in_child, job)) {
        bench_give_up("ngspice does not run: %s", which->name);
    }
    free(exact);
    dea_scene_free(&scene);
    return order_of(which, extrapolated ? &job->extrapolated : &job->plain);
}

static stability_order measure_plain(const stability_case *which)
{
    return measure_ngspice(which, false);
}

static stability_order measure_extrapolated(const stability_case *which)
{
    return measure_ngspice(which, true);
}

/* ---- ida: tolerances */

static double *fly(dea_flight *flight, double tolerance)
{
    const size_t rows = flight->rows;
    dea_trace trace = {.moments = malloc(rows * sizeof *trace.moments)};
    double *u = displacements(rows);
    if (!trace.moments) {
        bench_give_up("out of memory");
    }
    dea_flight_run(flight, tolerance, &trace, NULL);
    if (trace.end != DEA_STATE_OK || trace.count != rows) {
        bench_give_up("a run of SUNDIALS ended early: %s", flight->why.message);
    }
    for (size_t i = 0; i < rows; i++) {
        u[i] = trace.moments[i].u;
    }
    free(trace.moments);
    return u;
}

static stability_order run_flights(const stability_case *which, dea_flight *flight, const double *exact)
{
    series s = {.count = 0};
    for (double tolerance = 1e-5; tolerance > 0.5e-10; tolerance *= 0.1) {
        double *u = fly(flight, tolerance);
        const double error = apart(u, exact, flight->rows);
        add(&s, which->knob == STABILITY_STEPS ? 1.0 / (double)flight->steps : tolerance, error);
        free(u);
    }
    return order_of(which, &s);
}

static stability_order measure_flight(const stability_case *which)
{
    dea_scene scene = stability_scene(which->scene);
    dea_error error = {0};
    dea_dynamics dynamics;
    dea_signal signal = {0};
    dea_flight flight = {0};
    dea_sundials sundials;
    dea_status status = dea_sundials_open(&sundials, &error);
    status = status == DEA_OK ? dea_dynamics_open(&scene, scene.models[0], &dynamics, &error) : status;
    status = status == DEA_OK ? dea_signal_open(&scene, &signal, &error) : status;
    status = status == DEA_OK ? dea_flight_open(&sundials, &scene, &dynamics, &signal, &flight, &error) : status;
    if (status != DEA_OK) {
        bench_give_up("%s", error.message);
    }
    double *exact = scene.models[0]->linear ? reference(&scene, "direct", 1e-12) : fly(&flight, 1e-13);
    const stability_order order = run_flights(which, &flight, exact);
    free(exact);
    dea_flight_close(&flight);
    dea_signal_close(&signal);
    dea_dynamics_close(&dynamics);
    dea_sundials_close(&sundials);
    dea_scene_free(&scene);
    return order;
}

/* ---- statics: strain over the accuracy asked for */

static double static_error(const dea_scene *scene, const char *engine, double accuracy, const stability_answer *exact)
{
    static const stability_units none = {.length = 1, .thickness = 1, .stress = 1, .permittivity = 1, .time = 1};
    dea_scene here = *scene;
    here.accuracy = accuracy;
    stability_answer answer = stability_run(&here, engine);
    const double error = stability_difference(exact, &answer, &none);
    free(answer.points);
    return error;
}

static stability_order measure_static(const stability_case *which)
{
    dea_scene scene = stability_scene(which->scene);
    dea_scene best = scene;
    best.accuracy = 1e-12;
    stability_answer exact = stability_run(&best, "direct");
    series s = {.count = 0};
    for (double accuracy = 1e-2; accuracy > 0.5e-8; accuracy *= 0.1) {
        add(&s, accuracy, static_error(&scene, which->engine, accuracy, &exact));
    }
    free(exact.points);
    dea_scene_free(&scene);
    return order_of(which, &s);
}

static double field_strain(const dea_scene *scene, double steps)
{
    dea_point point;
    dea_row row;
    dea_film_prepare(scene, &point.film);
    dea_point_place(scene, &point);
    dea_field_solve(&point, (dea_field_mesh){-log(point.coverage) / steps, (double)INFINITY}, &row);
    return row.strain;
}

/* Meshes of 5, 6, ... steps against one that ends at rounding. */
static stability_order measure_mesh(const stability_case *which)
{
    dea_scene scene = stability_scene(which->scene);
    const double exact = field_strain(&scene, 40.0);
    series s = {.count = 0};
    for (int steps = 5; steps <= 12; steps++) {
        add(&s, 1.0 / steps, fabs(field_strain(&scene, steps) / exact - 1.0));
    }
    dea_scene_free(&scene);
    return order_of(which, &s);
}

/* Behind a corner the steps of ngspice grow by jumps, so that what is left after extrapolation holds odd powers too: order 3
 * where the decay behind a corner is all there is. The extrapolated midpoint rule is of order 14, and better than that on the
 * coarse meshes that alone leave an error above rounding. */
static const stability_case cases[] = {
    {"ring, trapezoidal rule", "ngspice", STABILITY_STEP, "2", 1.7, 2.3, measure_plain, HEAVY STEP "model: coverage\n"},
    {"ring, extrapolated", "ngspice", STABILITY_STEP, "4", 3.4, 4.6, measure_extrapolated, HEAVY STEP "model: coverage\n"},
    {"linear ring, roots matched", "ngspice", STABILITY_STEP, "2", 1.7, 2.8, measure_plain, HEAVY STEP "model: lumped\n"},
    {"linear ring, extrapolated", "ngspice", STABILITY_STEP, "3", 2.4, 3.6, measure_extrapolated, HEAVY STEP "model: lumped\n"},
    {"creep, trapezoidal rule", "ngspice", STABILITY_STEP, "2", 1.6, 2.3, measure_plain, LIGHT SLOW "model: lumped\n"},
    {"creep, extrapolated", "ngspice", STABILITY_STEP, "3", 2.4, 3.6, measure_extrapolated, LIGHT SLOW "model: lumped\n"},
    {"ring, Runge-Kutta", "ida", STABILITY_STEPS, "6", 5.3, 7.5, measure_flight, HEAVY JUMP "model: coverage\n"},
    {"ring, Runge-Kutta", "ida", STABILITY_TOLERANCE, "1", 0.5, 1.5, measure_flight, HEAVY JUMP "model: coverage\n"},
    {"linear ring in its turning frame, BDF", "ida", STABILITY_TOLERANCE, "1", 0.5, 1.5, measure_flight,
     HEAVY JUMP "model: lumped\n"},
    {"creep, BDF", "ida", STABILITY_TOLERANCE, "1", 0.5, 1.5, measure_flight, LIGHT SLOW "model: coverage\n"},
    {"creep behind a resistance, BDF", "ida", STABILITY_TOLERANCE, "1", 0.5, 1.5, measure_flight, LIGHT SINE "model: coverage\n"},
    {"damper, BDF", "ida", STABILITY_TOLERANCE, "1", 0.5, 1.5, measure_flight, VISCOUS SLOW "model: coverage\n"},
    {"equilibrium along the displacement", "ida", STABILITY_ACCURACY, "1", 0.5, 1.5, measure_static, SWEEP "model: coverage\n"},
    {"membrane by shooting", "ida", STABILITY_ACCURACY, "1", 0.5, 1.5, measure_static, SWEEP "model: field\n"},
    {"membrane, extrapolated midpoint rule", "direct", STABILITY_STEP, ">= 14", 13.0, 20.0, measure_mesh,
     "actuator: {kind: dot, frame_radius: 30 mm, coverage: 0.001, film_thickness: 100 um, prestretch: 1.2}\n"
     "material: {" FILM "}\ndrive: {voltage: 4 kV}\nstudy: {sweep: {}}\nmodel: field\n"},
};

double stability_rounding(const char *model, dea_kind kind)
{
    dea_scene scene = stability_scene(SWEEP "model: lumped\n");
    double worst = 0.0;
    scene.actuator.kind = kind;
    for (int i = 0; i < 500; i++) {
        dea_point point;
        dea_row row;
        scene.actuator.coverage = 0.05 + 0.9 * (i % 10) / 9.0;
        scene.actuator.prestretch = 1.05 + 0.05 * (i / 10 % 10);
        scene.drive.voltage = pow(10.0, 2.0 + 0.4 * (i / 100));
        dea_film_prepare(&scene, &point.film);
        dea_point_place(&scene, &point);
        dea_model_find(model)->solve(&point, 1e-12, &row);
        if (row.state != DEA_STATE_PULL_IN) {
            const long double exact = bench_strain(model, &point);
            worst = fmax(worst, (double)fabsl((row.strain - exact) / exact));
        }
    }
    dea_scene_free(&scene);
    return worst;
}

size_t stability_case_count(void)
{
    return sizeof cases / sizeof cases[0];
}

stability_order stability_order_of(size_t index)
{
    return cases[index].measure(&cases[index]);
}
