#include "bench.h"

#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/mman.h>
#include <sys/wait.h>
#include <time.h>
#include <unistd.h>

void bench_row(const char *what, const char *goal, int met, const char *measured, const char *error)
{
    printf("| %-58s | %-42s | %-44s | %-34s | %-6s |\n", what, goal, measured, error, met < 0 ? "" : met ? "met" : "MISSED");
    fflush(stdout);
}

void bench_give_up(const char *format, ...)
{
    va_list arguments;
    va_start(arguments, format);
    vfprintf(stderr, format, arguments);
    va_end(arguments);
    fputc('\n', stderr);
    exit(1);
}

double bench_now(void)
{
    struct timespec now;
    clock_gettime(CLOCK_MONOTONIC, &now);
    return (double)now.tv_sec + 1e-9 * (double)now.tv_nsec;
}

static int compare(const void *left, const void *right)
{
    const double a = *(const double *)left, b = *(const double *)right;
    return (a > b) - (a < b);
}

double bench_median(double *values, size_t count)
{
    qsort(values, count, sizeof *values, compare);
    return count % 2 ? values[count / 2] : 0.5 * (values[count / 2 - 1] + values[count / 2]);
}

void *bench_shared(size_t size)
{
    void *memory = mmap(NULL, size, PROT_READ | PROT_WRITE, MAP_SHARED | MAP_ANONYMOUS, -1, 0);
    if (memory == MAP_FAILED) {
        bench_give_up("no shared memory of %zu bytes", size);
    }
    return memory;
}

bool bench_fork(void (*function)(void *), void *argument)
{
    fflush(NULL);
    const pid_t child = fork();
    if (child == 0) {
        function(argument);
        _exit(0);
    }
    int ended = 1;
    return child > 0 && waitpid(child, &ended, 0) == child && ended == 0;
}

dea_scene bench_scene(const char *kind, const char *model, double prestretch, double accuracy, const char *sweep)
{
    static const char *const form =
        "actuator:\n  kind: %s\n  frame_radius: 30 mm\n  coverage: 0.5\n  film_thickness: 100 um\n"
        "  prestretch: %.17g\nmaterial: elastosil-2030\ndrive: {voltage: 4500 V}\nmodel: %s\naccuracy: %g\n"
        "study:\n  sweep:\n%s";
    char text[2048];
    dea_scene scene;
    dea_error error = {0};
    const int length = snprintf(text, sizeof text, form, kind, prestretch, model, accuracy, sweep);
    if (dea_scene_parse(text, (size_t)length, "bench", ".", NULL, 0, NULL, &scene, &error) != DEA_OK) {
        bench_give_up("%s", error.message);
    }
    return scene;
}

typedef struct sweep_job {
    const dea_engine *engine;
    const dea_scene *scene;
    dea_row *rows;
    double *seconds; /* shared with the parent; stays NAN where the engine failed */
} sweep_job;

/* Blocks as the runner cuts them. */
static void sweep(void *argument)
{
    const sweep_job *job = argument;
    const size_t count = dea_scene_point_count(job->scene);
    const size_t block = job->engine->isolated ? job->engine->block : 1024;
    dea_error error = {0};
    void *session = NULL;
    dea_status status = job->engine->begin(&session, &error);
    const double from = bench_now();
    for (size_t first = 0; first < count && status == DEA_OK; first += block) {
        const size_t size = count - first < block ? count - first : block;
        status = job->engine->sweep(session, job->scene, job->scene->models[0], first, size, job->rows + first, &error);
    }
    if (status == DEA_OK) {
        *job->seconds = bench_now() - from;
        job->engine->end(session);
    } else {
        fprintf(stderr, "%s: %s\n", job->engine->name, error.message);
    }
}

double bench_sweep(const dea_engine *engine, const dea_scene *scene, dea_row *rows)
{
    static double *seconds;
    seconds = seconds ? seconds : bench_shared(sizeof *seconds);
    *seconds = NAN;
    sweep_job job = {engine, scene, rows, seconds};
    if (engine->isolated) {
        bench_fork(sweep, &job);
    } else {
        sweep(&job);
    }
    return *seconds;
}

double bench_difference(const dea_row *rows, const dea_row *reference, size_t count)
{
    double worst = 0.0;
    for (size_t i = 0; i < count; i++) {
        if (rows[i].state != reference[i].state) {
            return INFINITY;
        }
        for (size_t k = 0; k < DEA_ROW_COLUMNS; k++) {
            const double a = *(const double *)((const char *)&rows[i] + dea_row_columns[k].offset);
            const double b = *(const double *)((const char *)&reference[i] + dea_row_columns[k].offset);
            const double difference = a == b ? 0.0 : fabs(a - b) / fabs(b);
            if (!(difference <= worst)) {
                worst = isnan(difference) ? INFINITY : difference;
            }
        }
    }
    return worst;
}

/* Runs of one transient. */
typedef struct run_job {
    const dea_engine *engine;
    const dea_scene *scene;
    dea_sample *samples; /* shared with the parent, as the rest */
    dea_summary summary;
    double seconds[BENCH_RUNS]; /* NAN where the engine failed */
} run_job;

static void run(void *argument)
{
    run_job *job = argument;
    dea_error error = {0};
    void *session = NULL;
    dea_status status = job->engine->begin(&session, &error);
    for (int i = -1; i < BENCH_RUNS && status == DEA_OK; i++) { /* the first one warms up */
        const double from = bench_now();
        status = job->engine->transient(session, job->scene, job->scene->models[0], job->samples, &job->summary, &error);
        if (status == DEA_OK && i >= 0) {
            job->seconds[i] = bench_now() - from;
        }
    }
    if (status == DEA_OK) {
        job->engine->end(session);
    } else {
        fprintf(stderr, "%s: %s\n", job->engine->name, error.message);
    }
}

double bench_transient(const dea_engine *engine, const dea_scene *scene, dea_sample *samples)
{
    run_job *job = bench_shared(sizeof *job);
    *job = (run_job){.engine = engine, .scene = scene, .samples = samples};
    for (int i = 0; i < BENCH_RUNS; i++) {
        job->seconds[i] = NAN;
    }
    if (engine->isolated) {
        bench_fork(run, job);
    } else {
        run(job);
    }
    return isnan(job->seconds[BENCH_RUNS - 1]) ? (double)NAN : bench_median(job->seconds, BENCH_RUNS);
}
