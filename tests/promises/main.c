/* Broken promises of accuracy over random scenes, all engines and accuracies, as a Markdown table. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

#include "promises.h"

enum { LINE = 512 };

typedef struct arguments {
    uint64_t seed;
    size_t first, count;
    long dump;          /* -1: none */
    const char *engine; /* NULL: all */
    char *(*draw)(uint64_t seed, size_t number);
    double accuracy; /* 0: 1e-2, 1e-4, 1e-6 and the best */
    bool verbose;
} arguments;

static const char *const usage =
    "Usage: promises [--seed S] [--scenes N] [--first K] [--scene K] [--engine E] [--accuracy A] [--dump K] [--films] [--stalls] "
    "[--verbose]\n"
    "S is the date, 20250131, unless given; --scene K is --first K --scenes 1; A stands for 1e-2, 1e-4, 1e-6 and "
    "the best of each engine. Scenes are sweeps, transients and responses of all models; --films: moving membranes alone, with "
    "loads, skins,\nlayers and the like, in time and in frequency; --stalls: transients at which steps of ngspice once collapsed.\n";

/* Delivered over wanted error of each promise that was judged. */
typedef struct shares {
    double *values; /* owned */
    size_t count;
} shares;

/* What is found, by engine, study and, of the shares, accuracy. */
typedef struct record {
    tally tallies[MOST_ENGINES][STUDIES];
    shares delivered[MOST_ENGINES][STUDIES][ACCURACIES];
} record;

/* The date as a number, 20250131: nobody chose it, and it can be said again. */
static uint64_t today(void)
{
    const time_t seconds = time(NULL);
    struct tm date;
    gmtime_r(&seconds, &date);
    return (uint64_t)(10000 * (date.tm_year + 1900) + 100 * (date.tm_mon + 1) + date.tm_mday);
}

static bool parse(int count, char **words, arguments *a)
{
    *a = (arguments){.seed = today(), .count = 500, .dump = -1, .draw = draw_scene};
    for (int i = 1; i < count; i++) {
        if (strcmp(words[i], "--verbose") == 0) {
            a->verbose = true;
            continue;
        }
        if (strcmp(words[i], "--films") == 0) {
            a->draw = draw_moving_film;
            continue;
        }
        if (strcmp(words[i], "--stalls") == 0) {
            a->draw = draw_stall;
            continue;
        }
        char *end = NULL;
        const char *value = i + 1 < count ? words[i + 1] : "";
        const unsigned long long number = strtoull(value, &end, 10);
        const bool whole = end != value && *end == '\0';
        if (strcmp(words[i], "--scenes") == 0 && whole) {
            a->count = (size_t)number;
        } else if (strcmp(words[i], "--first") == 0 && whole) {
            a->first = (size_t)number;
        } else if (strcmp(words[i], "--scene") == 0 && whole) {
            a->first = (size_t)number;
            a->count = 1;
        } else if (strcmp(words[i], "--seed") == 0 && whole) {
            a->seed = number;
        } else if (strcmp(words[i], "--dump") == 0 && whole) {
            a->dump = (long)number;
        } else if (strcmp(words[i], "--accuracy") == 0 && strtod(value, &end) > 0.0 && *end == '\0') {
            a->accuracy = strtod(value, NULL);
        } else if (strcmp(words[i], "--engine") == 0 && dea_engine_find(value)) {
            a->engine = value;
        } else {
            fputs(usage, stderr);
            return false;
        }
        i++;
    }
    return true;
}

static double now(void)
{
    struct timespec t;
    clock_gettime(CLOCK_MONOTONIC, &t);
    return (double)t.tv_sec + 1e-9 * (double)t.tv_nsec;
}

static void add_share(shares *s, double share)
{
    double *wider = realloc(s->values, (s->count + 1) * sizeof *wider);
    if (wider) {
        s->values = wider;
        s->values[s->count++] = share;
    }
}

static int by_size(const void *a, const void *b)
{
    const double x = *(const double *)a, y = *(const double *)b;
    return (x > y) - (x < y);
}

static double median(shares *s)
{
    qsort(s->values, s->count, sizeof *s->values, by_size);
    return 0.5 * (s->values[(s->count - 1) / 2] + s->values[s->count / 2]);
}

static const char *const studies[STUDIES] = {"sweep", "transient", "ac"};

static void print_medians(const arguments *a, record *found)
{
    puts("\nMedian of delivered/wanted:\n");
    if (a->accuracy > 0.0) {
        printf("| engine | study | %.0e |\n|---|---|---|\n", a->accuracy);
    } else {
        puts("| engine | study | 1e-2 | 1e-4 | 1e-6 | best |\n|---|---|---|---|---|---|");
    }
    for (size_t e = 0; e < dea_engine_count() && e < MOST_ENGINES; e++) {
        for (int s = 0; s < STUDIES; s++) {
            if (found->tallies[e][s].delivered == 0) {
                continue;
            }
            printf("| %s | %s |", dea_engine_at(e)->name, studies[s]);
            for (int k = 0; k < (a->accuracy > 0.0 ? 1 : ACCURACIES); k++) {
                shares *all = &found->delivered[e][s][k];
                if (all->count > 0) {
                    printf(" %.2g of %zu |", median(all), all->count);
                } else {
                    printf(" |");
                }
            }
            putchar('\n');
        }
    }
}

static void free_record(record *found)
{
    for (int e = 0; e < MOST_ENGINES; e++) {
        for (int s = 0; s < STUDIES; s++) {
            for (int k = 0; k < ACCURACIES; k++) {
                free(found->delivered[e][s][k].values);
            }
        }
    }
}

static void print_table(const tally tallies[MOST_ENGINES][STUDIES])
{
    puts("\n| engine | study | runs | delivered | refused | failed | not judged | worst delivered/wanted | broken | worst "
         "error/told | processor time [s] |");
    puts("|---|---|---|---|---|---|---|---|---|---|---|");
    for (size_t e = 0; e < dea_engine_count() && e < MOST_ENGINES; e++) {
        for (int s = 0; s < STUDIES; s++) {
            const tally *t = &tallies[e][s];
            if (t->scenes > 0) {
                printf("| %s | %s | %zu | %zu | %zu | %zu | %zu | %.2g | %zu | %.2g | %.1f |\n", dea_engine_at(e)->name, studies[s],
                       t->scenes, t->delivered, t->refused, t->failed, t->unjudged, t->worst, t->broken, t->told.error, t->seconds);
            }
        }
    }
    for (size_t e = 0; e < dea_engine_count() && e < MOST_ENGINES; e++) {
        for (int s = 0; s < STUDIES; s++) {
            for (int i = 0; i < MOST_REASONS && tallies[e][s].reasons[i].count > 0; i++) {
                printf("- %s, %s, %zu times %s\n", dea_engine_at(e)->name, studies[s], tallies[e][s].reasons[i].count,
                       tallies[e][s].reasons[i].text);
            }
        }
    }
}

/* One scene by all engines and accuracies; returns how many promises it broke. */
static size_t judge_scene(const arguments *a, size_t number, record *found)
{
    static const double asked[] = {1e-2, 1e-4, 1e-6};
    char *text = a->draw(a->seed, number), line[LINE];
    size_t broken = 0;
    judged j;
    const double start = now();
    if (!text || !judge_open(&j, text, number)) {
        free(text);
        return 1;
    }
    j.tightest = a->accuracy > 0.0 ? a->accuracy : j.tightest;
    for (size_t e = 0; e < dea_engine_count() && e < MOST_ENGINES; e++) {
        const dea_engine *engine = dea_engine_at(e);
        const double best = best_accuracy(engine, &j.scene);
        for (size_t k = 0; k < ACCURACIES && (!a->engine || strcmp(a->engine, engine->name) == 0); k++) {
            const double accuracy = a->accuracy > 0.0 ? a->accuracy : k < 3 ? asked[k] : best;
            if ((k == 3 && best >= 1e-6) || (k > 0 && a->accuracy > 0.0)) {
                continue;
            }
            tally *t = &found->tallies[e][j.scene.study];
            const tally before = *t;
            t->worst = 0.0;
            t->told = (column_error){.column = ""};
            const bool breaks = judge_engine(&j, engine, accuracy, t, line, sizeof line);
            if (a->verbose) {
                fprintf(stderr, "%zu %s %.0e: %.4f s, %.2g of it, %.2g of the %s told\n", number, engine->name, accuracy,
                        t->seconds - before.seconds, t->worst, t->told.error, t->told.error > 0.0 ? t->told.column : "error");
            }
            if (t->delivered > before.delivered) {
                add_share(&found->delivered[e][j.scene.study][k], t->worst);
            }
            t->worst = fmax(t->worst, before.worst);
            t->told = t->told.error > before.told.error ? t->told : before.told;
            if (breaks) {
                printf("- broken: %s\n", line);
                fflush(stdout);
                broken++;
            }
        }
    }
    if (a->verbose) {
        fprintf(stderr, "%zu: study %d, truth to %.1g%s%s, all %.2g s\n", number, (int)j.scene.study, j.errors[0],
                j.why ? ", " : "", j.why ? j.why : "", now() - start);
    }
    judge_close(&j);
    free(text);
    return broken;
}

int main(int count, char **words)
{
    static record found;
    arguments a;
    size_t broken = 0;
    if (!parse(count, words, &a)) {
        return 2;
    }
    if (a.dump >= 0) {
        char *text = a.draw(a.seed, (size_t)a.dump);
        fputs(text ? text : "", stdout);
        free(text);
        return 0;
    }
    const unsigned long long seed = a.seed;
    const char *kind = a.draw == draw_stall ? " --stalls" : a.draw == draw_moving_film ? " --films" : "";
    printf("%zu random scenes from number %zu, seed %llu; a broken one again: %s%s --seed %llu --scene K; its scene: the same "
           "with --dump K\n\n",
           a.count, a.first, seed, words[0], kind, seed);
    for (size_t i = 0; i < a.count; i++) {
        broken += judge_scene(&a, a.first + i, &found);
    }
    print_table((const tally (*)[STUDIES])found.tallies);
    print_medians(&a, &found);
    free_record(&found);
    printf("\nBroken accuracy promises over %zu random scenes x engines x accuracies: %zu; again: %s%s --seed %llu --first %zu "
           "--scenes %zu\n",
           a.count, broken, words[0], kind, seed, a.first, a.count);
    return broken > 0 ? 3 : 0;
}
