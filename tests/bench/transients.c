/* The paper's switch-on/off protocol of 25 s: film with mass and three branches, 2501 samples. Time of the engines' calls, each
 * with the error that it delivers, beside what the solvers of Octave and SciPy deliver. */
#include "bench.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

enum { SAMPLES = 2501, ON = 500, OFF = 1500, MANY = 1000, FEW = 100, TEXT = 256, WORKS = 16 };

static const char *const form =
    "actuator: {kind: dot, frame_radius: 30 mm, coverage: 0.5, film_thickness: 100 um, prestretch: 1.2}\n"
    "material: {yeoh: {C1: 178426 Pa, C2: -6023 Pa, C3: 4234 Pa}, permittivity: 2.8, density: 1080 kg/m^3,\n"
    "           prony: [{g: 0.1, tau: 1 ms}, {g: 0.1, tau: 0.3 s}, {g: 0.05, tau: 3 s}]}\n"
    "drive: {waveform: {step: {on: 5 s, off: 15 s, voltage: 4500 V, rise: 1 us}}}\n"
    "model: lumped\naccuracy: %g\nstudy:\n  transient: {until: 25 s, every: 10 ms}\n%s";

static int write_text(char *text, size_t size, double accuracy, size_t voltages)
{
    char over[TEXT] = "";
    if (voltages > 1) {
        snprintf(over, sizeof over, "  over:\n    drive.waveform.step.voltage: {from: 450 V, to: 4500 V, points: %zu}\n",
                 voltages);
    }
    return snprintf(text, size, form, accuracy, over);
}

static dea_scene protocol(double accuracy, size_t voltages)
{
    char text[2048];
    dea_scene scene;
    dea_error error = {0};
    const int length = write_text(text, sizeof text, accuracy, voltages);
    if (dea_scene_parse(text, (size_t)length, "bench", ".", NULL, 0, NULL, &scene, &error) != DEA_OK) {
        bench_give_up("%s", error.message);
    }
    return scene;
}

/* ---- the answer by matrix exponentials in extended precision: x' = A x + b U^2 with x = (u, v/omega, branch forces/K), and
 * three states f = U^2, g, h that drive it: f' = pace g, g' = 2 pace h */

enum { FORCED = 5, STATES = FORCED + 3 };

typedef struct matrix {
    long double at[STATES][STATES];
} matrix;

static matrix product(const matrix *a, const matrix *b)
{
    matrix c = {.at = {{0.0L}}};
    for (int i = 0; i < STATES; i++) {
        for (int k = 0; k < STATES; k++) {
            for (int j = 0; j < STATES; j++) {
                c.at[i][j] += a->at[i][k] * b->at[k][j];
            }
        }
    }
    return c;
}

/* Taylor series of the exponent divided by 2^10, then squared back. */
static matrix exponential(const matrix *a, long double duration)
{
    enum { HALVINGS = 10, TERMS = 24 };
    matrix sum = {.at = {{0.0L}}}, small;
    for (int i = 0; i < STATES; i++) {
        sum.at[i][i] = 1.0L;
        for (int j = 0; j < STATES; j++) {
            small.at[i][j] = ldexpl(a->at[i][j] * duration, -HALVINGS);
        }
    }
    matrix term = sum;
    for (int n = 1; n <= TERMS; n++) {
        term = product(&term, &small);
        for (int i = 0; i < STATES; i++) {
            for (int j = 0; j < STATES; j++) {
                term.at[i][j] /= n;
                sum.at[i][j] += term.at[i][j];
            }
        }
    }
    for (int i = 0; i < HALVINGS; i++) {
        sum = product(&sum, &sum);
    }
    return sum;
}

/* K = Y A_cross (1/r_a + 1/(r - r_a)) and the force per U^2 of Eqs. 19-21; mass of physics.md, section 5. */
static matrix protocol_matrix(const dea_scene *scene)
{
    static const long double g[] = {0.1L, 0.1L, 0.05L}, tau[] = {0.001L, 0.3L, 3.0L};
    dea_point point;
    dea_film_prepare(scene, &point.film);
    dea_point_place(scene, &point);
    const long double edge = 0.015L, film = 1e-4L, pi = acosl(-1.0L), square = 1.2L * 1.2L;
    const long double section = 2.0L * pi * edge * film / square;
    const long double stiffness = (long double)point.film.modulus * section * (2.0L / edge);
    const long double force = (long double)point.film.permittivity * square * square / (film * film) * section;
    const long double in = 0.0125L, out = 0.025L, ratio = out * out - in * in;
    const long double annulus =
        out * out * out * out * logl(out / in) - out * out * ratio + (out * out * out * out - in * in * in * in) / 4.0L;
    const long double mass = pi * 1080.0L * film * in * in * (0.5L + 2.0L * annulus / (ratio * ratio));
    const long double omega = sqrtl(stiffness / mass);
    matrix a = {.at = {{0.0L}}};
    a.at[0][1] = omega;
    a.at[1][0] = -omega;
    a.at[1][FORCED] = omega * force / stiffness;
    for (int i = 0; i < 3; i++) {
        a.at[1][2 + i] = -omega;
        a.at[2 + i][1] = g[i] / 0.75L * omega;
        a.at[2 + i][2 + i] = -1.0L / tau[i];
    }
    return a;
}

/* The network over one interval in which the voltage runs from start to end. */
typedef struct interval {
    matrix flow;
    long double drive[3]; /* f, g, h at its begin */
} interval;

static interval interval_of(const matrix *network, long double duration, long double start, long double end)
{
    matrix grown = *network;
    grown.at[FORCED][FORCED + 1] = 1.0L / duration;
    grown.at[FORCED + 1][FORCED + 2] = 2.0L / duration;
    const long double change = end - start;
    return (interval){exponential(&grown, duration), {start * start, 2.0L * start * change, change * change}};
}

static void pass(const interval *over, long double x[STATES])
{
    long double next[STATES] = {0.0L};
    for (int i = 0; i < 3; i++) {
        x[FORCED + i] = over->drive[i];
    }
    for (int i = 0; i < STATES; i++) {
        for (int j = 0; j < STATES; j++) {
            next[i] += over->flow.at[i][j] * x[j];
        }
    }
    memcpy(x, next, sizeof next);
}

/* Displacements at all samples; returns their peak. */
static double solve_exactly(const dea_scene *scene, double *u)
{
    const long double every = 0.01L, rise = 1e-6L, volts = 4500.0L;
    const matrix network = protocol_matrix(scene);
    const interval rest = interval_of(&network, every, 0.0L, 0.0L), held = interval_of(&network, every, volts, volts);
    const interval up = interval_of(&network, rise, 0.0L, volts), on = interval_of(&network, every - rise, volts, volts);
    const interval down = interval_of(&network, rise, volts, 0.0L), off = interval_of(&network, every - rise, 0.0L, 0.0L);
    long double x[STATES] = {0.0L};
    double peak = 0.0;
    u[0] = 0.0;
    for (int i = 1; i < SAMPLES; i++) {
        const bool edge = i == ON + 1 || i == OFF + 1;
        const bool charged = i > ON && i <= OFF;
        if (edge) {
            pass(charged ? &up : &down, x);
            pass(charged ? &on : &off, x);
        } else {
            pass(charged ? &held : &rest, x);
        }
        u[i] = (double)x[0];
        peak = fmax(peak, fabs(u[i]));
    }
    return peak;
}

/* ---- the engines */

/* Seconds of one transient and the error that it delivers: the largest over all samples, relative to the peak. */
typedef struct work {
    double seconds, error;
} work;

static work run_protocol(const char *engine, double accuracy, const double *exact, double peak)
{
    dea_scene scene = protocol(accuracy, 1);
    dea_sample *samples = bench_shared(SAMPLES * sizeof *samples);
    work done = {bench_transient(dea_engine_find(engine), &scene, samples), 0.0};
    for (int i = 0; i < SAMPLES; i++) {
        const double off = fabs(samples[i].displacement - exact[i]) / peak;
        done.error = off <= done.error ? done.error : isnan(off) ? INFINITY : off;
    }
    dea_scene_free(&scene);
    return done;
}

/* Settings of the engines, and what they shall take and deliver. */
typedef struct own_setting {
    const char *engine;
    double accuracy;
    double milliseconds, error; /* goals */
} own_setting;

static const own_setting own_settings[] = {
    {"direct", 1e-6, 0.3, 1e-11}, {"ida", 1e-2, 10.0, 1e-2},     {"ida", 1e-4, 10.0, 1e-4},      {"ida", 1e-6, 25.0, 1e-6},
    {"ida", 1e-8, 80.0, 1e-8},    {"ngspice", 1e-3, 30.0, 1e-3}, {"ngspice", 1e-5, 300.0, 1e-5},
};
enum { OWN = sizeof own_settings / sizeof *own_settings };

static void engine_row(const own_setting *setting, const work *done)
{
    char what[TEXT], aim[TEXT], measured[TEXT], wrong[TEXT];
    snprintf(what, sizeof what, "%s, accuracy %.0e, 2501 samples, 25 s", setting->engine, setting->accuracy);
    snprintf(aim, sizeof aim, "%g ms, %.0e of the peak", setting->milliseconds, setting->error);
    snprintf(measured, sizeof measured, "%.3g ms", 1e3 * done->seconds);
    snprintf(wrong, sizeof wrong, "%.1e of the peak", done->error);
    bench_row(what, aim, 1e3 * done->seconds <= setting->milliseconds && done->error <= setting->error, measured, wrong);
}

/* ---- the peers */

#define SCIPY                                                                                                                    \
    "for p in python3 /usr/bin/python3; do $p -c 'import scipy' 2>/dev/null && "                                                 \
    "exec $p '%s/transient_scipy.py' protocol "

static size_t hear_peer(const char *command, work *works)
{
    char line[TEXT];
    size_t count = 0;
    FILE *pipe = popen(command, "r");
    while (pipe && fgets(line, sizeof line, pipe)) {
        double tolerance, milliseconds, error;
        if (count < WORKS && sscanf(line, "%*[^,],%lf,%lf,%lf", &tolerance, &milliseconds, &error) == 3) {
            works[count++] = (work){1e-3 * milliseconds, error};
        }
    }
    if (pipe) {
        pclose(pipe);
    }
    return count;
}

/* Number of the cheapest setting that is no worse than @p error and, where @p engine is not NULL, of that engine; OWN: none. */
static size_t cheapest(const work own[OWN], double error, const char *engine)
{
    size_t best = OWN;
    for (size_t i = 0; i < OWN; i++) {
        const bool counts = own[i].error <= error && (!engine || strcmp(own_settings[i].engine, engine) == 0);
        best = counts && (best == OWN || own[i].seconds < own[best].seconds) ? i : best;
    }
    return best;
}

/* Each run of a peer against the cheapest setting that is no worse; the least ratio counts. */
static void best_row(const char *name, const work *works, size_t count, const work own[OWN], const char *engine, double goal)
{
    char what[TEXT], measured[TEXT], wrong[TEXT], aim[TEXT] = "";
    double least = INFINITY;
    size_t run = 0, setting = OWN;
    for (size_t i = 0; i < count; i++) {
        const size_t best = cheapest(own, works[i].error, engine);
        const double ratio = best < OWN ? works[i].seconds / own[best].seconds : 0.0;
        if (ratio < least) {
            least = ratio;
            run = i;
            setting = best;
        }
    }
    snprintf(what, sizeof what, "%s against %s, error no larger", engine ? engine : "best engine", name);
    snprintf(measured, sizeof measured, "%.0f times%s%s", least, setting < OWN ? " " : "",
             setting < OWN ? own_settings[setting].engine : "");
    snprintf(wrong, sizeof wrong, "%.1e against %.1e", setting < OWN ? own[setting].error : NAN, works[run].error);
    if (goal > 0.0) {
        snprintf(aim, sizeof aim, "%g times", goal);
    }
    bench_row(what, aim, goal > 0.0 ? least >= goal : -1, measured, wrong);
}

static void peer_rows(const char *name, const char *command, const work own[OWN], double best, double ida)
{
    work works[WORKS];
    char what[TEXT], measured[TEXT], wrong[TEXT];
    const size_t count = hear_peer(command, works);
    snprintf(what, sizeof what, "  beside it: %s", name);
    if (count == 0) {
        bench_row(what, "", -1, "not installed", "");
        return;
    }
    for (size_t i = 0; i < count; i++) {
        snprintf(measured, sizeof measured, "%.4g ms", 1e3 * works[i].seconds);
        snprintf(wrong, sizeof wrong, "%.1e of the peak", works[i].error);
        bench_row(what, "", -1, measured, wrong);
    }
    best_row(name, works, count, own, NULL, best);
    best_row(name, works, count, own, "ida", ida);
}

/* ---- many transients */

typedef struct tally {
    size_t points, lost;
    size_t point_size;
} tally;

static dea_status hear(void *user, size_t first, const void *points, size_t count, dea_error *error)
{
    tally *heard = user;
    (void)first;
    (void)error;
    for (size_t i = 0; i < count; i++) {
        const dea_sample *samples = (const void *)((const char *)points + i * heard->point_size);
        heard->points++;
        heard->lost += samples[SAMPLES - 1].state == DEA_STATE_OK ? 0 : 1;
    }
    return DEA_OK;
}

static double seconds_with(const dea_scene *scene, const char *engine, size_t jobs)
{
    dea_error error = {0};
    tally heard = {.point_size = dea_layout_of(scene).point_size};
    const dea_run_options options = {.jobs = jobs, .points = hear, .user = &heard};
    const double from = bench_now();
    if (dea_study_run(scene, dea_engine_find(engine), &options, &error) != DEA_OK) {
        bench_give_up("%s", error.message);
    }
    const double seconds = bench_now() - from;
    if (heard.points != MANY || heard.lost > 0) {
        bench_give_up("%s lost %zu of %zu transients", engine, heard.lost, heard.points);
    }
    return seconds;
}

static void workers_row(const char *engine, double accuracy, double goal, int runs)
{
    double ratio[BENCH_RUNS], one = 0.0, two = 0.0;
    dea_scene scene = protocol(accuracy, MANY);
    for (int i = 0; i < runs; i++) {
        one = seconds_with(&scene, engine, 1);
        two = seconds_with(&scene, engine, 2);
        ratio[i] = one / two;
    }
    char what[TEXT], aim[TEXT] = "", measured[TEXT];
    const double times = bench_median(ratio, (size_t)runs);
    snprintf(what, sizeof what, "-j 2 against -j 1, 1000 transients, %s at %.0e", engine, accuracy);
    if (goal > 0.0) {
        snprintf(aim, sizeof aim, "%g times", goal);
    }
    snprintf(measured, sizeof measured, "%.2f times (last: %.2f s, %.2f s)", times, one, two);
    bench_row(what, aim, goal > 0.0 ? times >= goal : -1, measured, "");
    dea_scene_free(&scene);
}

static double megabytes_of(char *program, size_t transients)
{
    char folder[] = "/tmp/deaspice-bench-XXXXXX", scene[TEXT], output[TEXT], text[2048];
    double megabytes;
    if (!mkdtemp(folder)) {
        bench_give_up("no folder under /tmp");
    }
    snprintf(scene, sizeof scene, "%s/many.yaml", folder);
    snprintf(output, sizeof output, "%s/many.nc", folder);
    write_text(text, sizeof text, 1e-6, transients);
    FILE *file = fopen(scene, "w");
    if (!file || fputs(text, file) < 0 || fclose(file) != 0) {
        bench_give_up("cannot write %s", scene);
    }
    char *arguments[] = {program, "run", scene, "--engine", "direct", "-j", "2", "--quiet", "-o", output, NULL};
    bench_program_seconds(arguments, &megabytes);
    unlink(output);
    unlink(scene);
    rmdir(folder);
    return megabytes;
}

static void memory_row(char *program)
{
    char measured[TEXT];
    const double few = megabytes_of(program, FEW), many = megabytes_of(program, MANY);
    snprintf(measured, sizeof measured, "%.0f MB, %.0f MB", few, many);
    bench_row("memory of 100 and of 1000 transients to .nc, -j 2", "1.1 times", many <= 1.1 * few, measured, "");
}

/* The peers; each finds the engines' times taken anew beside it, so that a drift of the machine hits both. */
static void peers_group(const char *peers, const double *exact, double peak)
{
    static const struct {
        const char *name, *command; /* the folder of the scripts stands for %s */
        double ida;                 /* goal of ida alone, 0: none */
    } others[] = {
        {"Octave ode15s", "octave-cli --no-init-file --no-site-file '%s/transient_octave.m' 1e-4 1e-5 1e-6 2>/dev/null", 25.0},
        {"SciPy DOP853", SCIPY "DOP853 1e-5 1e-7 1e-9; done", 0.0},
        {"SciPy Radau", SCIPY "Radau 1e-3 1e-4; done", 0.0},
        {"SciPy LSODA", SCIPY "LSODA 1e-3 1e-5 1e-7 1e-9; done", 0.0},
    };
    for (size_t i = 0; i < sizeof others / sizeof *others; i++) {
        char command[4096];
        work own[OWN];
        for (size_t k = 0; k < OWN; k++) {
            own[k] = run_protocol(own_settings[k].engine, own_settings[k].accuracy, exact, peak);
        }
        snprintf(command, sizeof command, others[i].command, peers);
        peer_rows(others[i].name, command, own, 50.0, others[i].ida);
    }
}

void bench_transients(const char *program, const char *peers)
{
    static double exact[SAMPLES];
    char name[4096];
    dea_scene scene = protocol(1e-6, 1);
    const double peak = solve_exactly(&scene, exact);
    dea_scene_free(&scene);
    for (size_t i = 0; i < OWN; i++) {
        const work done = run_protocol(own_settings[i].engine, own_settings[i].accuracy, exact, peak);
        engine_row(&own_settings[i], &done);
    }
    peers_group(peers, exact, peak);
    workers_row("ida", 1e-4, 1.8, 3);
    workers_row("direct", 1e-6, 0.0, BENCH_RUNS);
    snprintf(name, sizeof name, "%s", program);
    memory_row(name);
}
