/* The program from outside: workers, memory, start-up. */
#include "bench.h"

#include <fcntl.h>
#include <math.h>
#include <spawn.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

extern char **environ;

enum { MILLION = 1000000, STARTS = 21, TEXT = 128 };

static char folder[] = "/tmp/deaspice-bench-XXXXXX";

typedef struct heard {
    const dea_row *reference;
    double worst;
} heard;

static dea_status hear(void *user, size_t first, const void *points, size_t count, dea_error *error)
{
    const dea_row *rows = points;
    heard *listener = user;
    (void)error;
    listener->worst = fmax(listener->worst, bench_difference(rows, listener->reference + first, count));
    return DEA_OK;
}

static double seconds_with(const dea_scene *scene, size_t jobs, heard *listener)
{
    dea_error error = {0};
    const dea_run_options options = {.jobs = jobs, .points = hear, .user = listener};
    const double from = bench_now();
    if (dea_study_run(scene, dea_engine_find("ngspice"), &options, &error) != DEA_OK) {
        bench_give_up("%s", error.message);
    }
    return bench_now() - from;
}

void bench_workers(void)
{
    double ratio[BENCH_RUNS];
    dea_scene scene = bench_scene("dot", "coverage", 1.2, 1e-6, "    coverage: {from: 0.05, to: 0.95, points: 1000000}\n");
    dea_row *reference = malloc(MILLION * sizeof *reference);
    if (!reference) {
        bench_give_up("out of memory");
    }
    bench_sweep(dea_engine_find("direct"), &scene, reference);
    heard listener = {reference, 0.0};
    double one = 0.0, two = 0.0;
    for (int i = 0; i < BENCH_RUNS; i++) {
        one = seconds_with(&scene, 1, &listener);
        two = seconds_with(&scene, 2, &listener);
        ratio[i] = one / two;
    }
    char measured[TEXT], wrong[TEXT];
    const double times = bench_median(ratio, BENCH_RUNS);
    snprintf(measured, sizeof measured, "%.2f times (last: %.1f s, %.1f s)", times, one, two);
    snprintf(wrong, sizeof wrong, "%.1e against direct", listener.worst);
    bench_row("-j 2 against -j 1, 1,000,000 points, coverage, ngspice", "1.8 times", times >= 1.8, measured, wrong);
    free(reference);
    dea_scene_free(&scene);
}

double bench_program_seconds(char *const *arguments, double *megabytes)
{
    posix_spawn_file_actions_t actions;
    struct rusage usage;
    pid_t child;
    int ended = 1;
    posix_spawn_file_actions_init(&actions);
    posix_spawn_file_actions_addopen(&actions, STDOUT_FILENO, "/dev/null", O_WRONLY, 0);
    const double from = bench_now();
    if (posix_spawn(&child, arguments[0], &actions, NULL, arguments, environ) != 0 || wait4(child, &ended, 0, &usage) != child ||
        ended != 0) {
        bench_give_up("%s %s failed", arguments[0], arguments[1]);
    }
    const double seconds = bench_now() - from;
    posix_spawn_file_actions_destroy(&actions);
    *megabytes = (double)usage.ru_maxrss / 1024.0;
    return seconds;
}

static void write_scene(char *path, size_t size, const char *name, const char *sweep)
{
    snprintf(path, size, "%s/%s", folder, name);
    FILE *file = fopen(path, "w");
    if (!file ||
        fprintf(file,
                "actuator:\n  kind: dot\n  frame_radius: 30 mm\n  coverage: 0.5\n  film_thickness: 100 um\n  prestretch: 1.2\n"
                "material: elastosil-2030\ndrive: {voltage: 4500 V}\nmodel: lumped\nstudy:\n  sweep: %s\n",
                sweep) < 0 ||
        fclose(file) != 0) {
        bench_give_up("cannot write %s", path);
    }
}

static void memory_row(char *program)
{
    char scene[TEXT], output[TEXT], measured[TEXT];
    double megabytes;
    write_scene(scene, sizeof scene, "long.yaml",
                "{coverage: {from: 0.05, to: 0.95, points: 10000}, voltage: {from: 0 V, to: 4500 V, points: 1000}}");
    snprintf(output, sizeof output, "%s/long.nc", folder);
    char *arguments[] = {program, "run", scene, "--engine", "direct", "--quiet", "-o", output, NULL};
    const double seconds = bench_program_seconds(arguments, &megabytes);
    snprintf(measured, sizeof measured, "%.0f MB (%.1f s)", megabytes, seconds);
    bench_row("memory of a direct sweep of 10,000,000 points to .nc", "150 MB", megabytes < 150.0, measured, "");
    unlink(output);
    unlink(scene);
}

static double median_start(char *const *arguments)
{
    double seconds[STARTS], megabytes;
    for (int i = 0; i < STARTS; i++) {
        seconds[i] = bench_program_seconds(arguments, &megabytes);
    }
    return 1e3 * bench_median(seconds, STARTS);
}

static void start_row(char *program)
{
    char scene[TEXT], measured[TEXT];
    write_scene(scene, sizeof scene, "point.yaml", "{}");
    char *run[] = {program, "run", scene, "--engine", "ngspice", "--quiet", NULL};
    char *version[] = {program, "--version", NULL};
    const double point = median_start(run), start = median_start(version);
    snprintf(measured, sizeof measured, "%.1f ms; %.1f ms", point, start);
    bench_row("deaspice run of one point by ngspice; --version", "50 ms; 15 ms", point < 50.0 && start < 15.0, measured, "");
    unlink(scene);
}

void bench_program(const char *program)
{
    char name[4096];
    snprintf(name, sizeof name, "%s", program);
    if (!mkdtemp(folder)) {
        bench_give_up("no folder under /tmp");
    }
    memory_row(name);
    start_row(name);
    rmdir(folder);
}
