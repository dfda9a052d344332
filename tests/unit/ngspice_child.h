/* The simulator as a user runs it: `ngspice -b` as a child, its vectors read back from its binary file. Folder and files go when
 * the caller says so. */
#ifndef DEA_TEST_NGSPICE_CHILD_H
#define DEA_TEST_NGSPICE_CHILD_H

#include "scenes.h"

#include <stdlib.h>
#include <sys/wait.h>
#include <unistd.h>

enum { CHILD_VECTORS = 960, CHILD_NAME = 192, CHILD_PATH = 512, CHILD_LOG = 1 << 16 };

/* What a run left: point p of vector v is values[width (p vectors + v)], width 2 (real, imaginary) where complex. */
typedef struct child_run {
    int status; /* exit status */
    char log[CHILD_LOG];
    char names[CHILD_VECTORS][CHILD_NAME];
    size_t vectors, points, width;
    double *values; /* owned */
} child_run;

static char child_folder[] = "/tmp/deaspice-ngspice-XXXXXX";

static inline void child_path(const char *name, char path[CHILD_PATH])
{
    snprintf(path, CHILD_PATH, "%s/%s", child_folder, name);
}

static inline FILE *child_open(const char *name, const char *mode)
{
    char path[CHILD_PATH];
    child_path(name, path);
    FILE *file = fopen(path, mode);
    if (!file) {
        fail_msg("%s cannot be opened", path);
    }
    return file;
}

/* The folder holds a start-up file of its own, so that none of the user's is read. */
static inline int child_setup(void **state)
{
    (void)state;
    if (!mkdtemp(child_folder)) {
        return -1;
    }
    return fclose(child_open(".spiceinit", "w"));
}

static inline int child_teardown(void **state)
{
    (void)state;
    char command[CHILD_PATH + 16];
    snprintf(command, sizeof command, "rm -rf '%s'", child_folder);
    return system(command);
}

static inline void child_read_log(child_run *run)
{
    FILE *file = child_open("log", "r");
    run->log[fread(run->log, 1, sizeof run->log - 1, file)] = '\0';
    fclose(file);
}

/* Header in text, then the doubles. */
static inline void child_read_vectors(child_run *run)
{
    char line[512];
    FILE *file = child_open("out.raw", "r");
    while (fgets(line, sizeof line, file) && strcmp(line, "Binary:\n") != 0) {
        size_t index;
        char name[CHILD_NAME];
        if (strncmp(line, "Flags: complex", 14) == 0) {
            run->width = 2;
        } else if (sscanf(line, "No. Variables: %zu", &run->vectors) == 1 || sscanf(line, "No. Points: %zu", &run->points) == 1) {
            assert_true(run->vectors <= CHILD_VECTORS);
        } else if (sscanf(line, "\t%zu\t%191s", &index, name) == 2) {
            assert_true(index < CHILD_VECTORS);
            memcpy(run->names[index], name, sizeof name);
        }
    }
    const size_t count = run->vectors * run->points * run->width;
    run->values = malloc(count * sizeof *run->values + 1);
    assert_non_null(run->values);
    assert_int_equal(fread(run->values, sizeof *run->values, count, file), count);
    fclose(file);
}

/* Runs @p file of the folder, for 300 s of the processor at most however busy the machine is; the caller ends the run with child_end().
 * A run that fails has no vectors. */
static inline void child_start(const char *file, child_run *run)
{
    char command[4 * CHILD_PATH];
    *run = (child_run){.width = 1};
    snprintf(command, sizeof command, "cd '%s' && rm -f out.raw && ulimit -t 300 && ngspice -b -r out.raw '%s' >log 2>&1",
             child_folder, file);
    const int ended = system(command);
    run->status = WIFEXITED(ended) ? WEXITSTATUS(ended) : -1;
    child_read_log(run);
    if (run->status == 0) {
        child_read_vectors(run);
    }
}

static inline void child_end(child_run *run)
{
    free(run->values);
    *run = (child_run){0};
}

/* Runs a netlist that must do. */
static inline void child_must_run(const char *file, child_run *run)
{
    child_start(file, run);
    if (run->status != 0 || run->points == 0) {
        print_error("%s\n", run->log);
        fail_msg("ngspice -b %s: exit status %d", file, run->status);
    }
}

static inline size_t child_vector(const child_run *run, const char *name)
{
    for (size_t i = 0; i < run->vectors; i++) {
        if (strcmp(run->names[i], name) == 0) {
            return i;
        }
    }
    fail_msg("no vector %s", name);
    return 0;
}

static inline double child_value(const child_run *run, const char *name, size_t point)
{
    return run->values[run->width * (point * run->vectors + child_vector(run, name))];
}

static inline double child_imaginary(const child_run *run, const char *name, size_t point)
{
    return run->values[run->width * (point * run->vectors + child_vector(run, name)) + 1];
}

static inline double child_last(const child_run *run, const char *name)
{
    return child_value(run, name, run->points - 1);
}

#endif
