/* The examples by programs of different compilers and flags: what their numbers differ by. */
#include "stability.h"

#include "../bench/bench.h"

#include <fcntl.h>
#include <glob.h>
#include <math.h>
#include <spawn.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/wait.h>
#include <unistd.h>

extern char **environ;

enum { MOST_COLUMNS = 32, MOST_LINE = 4096 };

/* A table as a program wrote it. */
typedef struct table {
    char **lines; /* owned, with all they hold; the first is the header */
    size_t count;
} table;

static void free_table(table *t)
{
    for (size_t i = 0; i < t->count; i++) {
        free(t->lines[i]);
    }
    free(t->lines);
    *t = (table){0};
}

static table read_table(const char *path)
{
    char line[MOST_LINE];
    table t = {0};
    FILE *file = fopen(path, "r");
    while (file && fgets(line, sizeof line, file)) {
        char **more = realloc(t.lines, (t.count + 1) * sizeof *more);
        if (!more) {
            bench_give_up("out of memory for %s", path);
        }
        t.lines = more;
        line[strcspn(line, "\n")] = '\0';
        t.lines[t.count++] = strdup(line);
    }
    if (file) {
        fclose(file);
    }
    return t;
}

/* The study of an example by one program; false where it refuses. */
static bool run_program(const char *program, const char *example, const char *engine, const char *output)
{
    char *arguments[] = {(char *)program, "run", (char *)example, "--engine", (char *)engine, "-j", "1",
                         "--quiet",       "-o",  (char *)output,  NULL};
    posix_spawn_file_actions_t actions;
    pid_t child;
    int ended = 1;
    posix_spawn_file_actions_init(&actions);
    posix_spawn_file_actions_addopen(&actions, STDOUT_FILENO, "/dev/null", O_WRONLY, 0);
    posix_spawn_file_actions_addopen(&actions, STDERR_FILENO, "/dev/null", O_WRONLY, 0);
    if (posix_spawn(&child, program, &actions, NULL, arguments, environ) != 0 || waitpid(child, &ended, 0) != child) {
        bench_give_up("%s does not run", program);
    }
    posix_spawn_file_actions_destroy(&actions);
    return WIFEXITED(ended) && WEXITSTATUS(ended) == 0;
}

/* Cell number @p column, copied; a line has at most MOST_COLUMNS. */
static void cell(const char *line, size_t column, char *text, size_t size)
{
    for (; column > 0 && line; column--) {
        line = strchr(line, ',');
        line = line ? line + 1 : NULL;
    }
    snprintf(text, size, "%.*s", line ? (int)strcspn(line, ",") : 0, line ? line : "");
}

/* One column of two tables, over its peak; infinite where words differ. */
static double column_difference(const table *a, const table *b, size_t column)
{
    char x[64], y[64], name[64];
    cell(a->lines[0], column, name, sizeof name);
    const bool turns = strstr(name, "_deg") != NULL;
    double peak = turns ? 180.0 : 0.0, worst = 0.0;
    for (size_t i = 1; i < a->count; i++) {
        char *end_x, *end_y;
        cell(a->lines[i], column, x, sizeof x);
        cell(b->lines[i], column, y, sizeof y);
        const double p = strtod(x, &end_x), q = strtod(y, &end_y);
        if (end_x == x || *end_x || end_y == y || *end_y) {
            worst = strcmp(x, y) == 0 ? worst : (double)INFINITY;
            continue;
        }
        worst = fmax(worst, turns ? fabs(remainder(p - q, 360.0)) : fabs(p - q));
        peak = fmax(peak, fabs(p));
    }
    return worst > 0.0 ? worst / peak : 0.0;
}

static double table_difference(const table *a, const table *b)
{
    if (a->count != b->count || a->count < 2 || strcmp(a->lines[0], b->lines[0]) != 0) {
        return (double)INFINITY;
    }
    size_t columns = 1;
    double worst = 0.0;
    for (const char *at = a->lines[0]; *at; at++) {
        columns += *at == ',';
    }
    for (size_t k = 0; k < columns; k++) {
        worst = fmax(worst, column_difference(a, b, k));
    }
    return worst;
}

/* Both files are in a folder of this run. */
typedef struct bench {
    char folder[64], reference[96], other[96];
} bench;

/* Adds what one example says to the differences of all programs. */
static void compare(const bench *b, const char *const *programs, size_t count, const char *example, const char *engine,
                    stability_difference_found *found)
{
    if (!run_program(programs[0], example, engine, b->reference)) {
        return;
    }
    table reference = read_table(b->reference);
    const char *slash = strrchr(example, '/');
    for (size_t i = 1; i < count; i++) {
        (void)unlink(b->other);
        const bool ran = run_program(programs[i], example, engine, b->other);
        table other = read_table(b->other);
        const double apart = ran ? table_difference(&reference, &other) : (double)INFINITY;
        if (!(apart <= found[i].largest)) {
            found[i].largest = apart;
            snprintf(found[i].where, sizeof found[i].where, "%s", slash ? slash + 1 : example);
        }
        found[i].examples++;
        free_table(&other);
    }
    free_table(&reference);
}

void stability_compare_programs(const char *const *programs, size_t count, const char *folder, const char *engine,
                                stability_difference_found *found)
{
    char pattern[MOST_LINE];
    glob_t list;
    bench b = {.folder = "/tmp/deaspice-stability-XXXXXX"};
    snprintf(pattern, sizeof pattern, "%s/*.yaml", folder);
    if (!mkdtemp(b.folder) || glob(pattern, 0, NULL, &list) != 0) {
        bench_give_up("no scenes in %s", folder);
    }
    snprintf(b.reference, sizeof b.reference, "%s/a.csv", b.folder);
    snprintf(b.other, sizeof b.other, "%s/b.csv", b.folder);
    memset(found, 0, count * sizeof *found);
    for (size_t i = 0; i < list.gl_pathc; i++) {
        compare(&b, programs, count, list.gl_pathv[i], engine, found);
    }
    globfree(&list);
    (void)unlink(b.reference);
    (void)unlink(b.other);
    (void)rmdir(b.folder);
}
