/* Promises of accuracy: rows that an engine delivers, against truths that are found another way. */
#ifndef DEA_PROMISES_H
#define DEA_PROMISES_H

#include <stdint.h>

#include "truths.h"

/* ---- random scenes (draw.c) */

/* YAML of the scene of that number; freed by the caller. */
char *draw_scene(uint64_t seed, size_t number);
/* The same of membranes that move (films.c). */
char *draw_moving_film(uint64_t seed, size_t number);
/* The same of one kind of transients, which names its accuracy (stalls.c). */
char *draw_stall(uint64_t seed, size_t number);

/* ---- judging (judge.c) */

enum { MOST_REASONS = 48, REASON_LENGTH = 320, ACCURACIES = 4, STUDIES = 3, MOST_ENGINES = 4 };

/* What a column of transients is off by (columns.c). */
typedef struct column_error {
    const char *column;
    size_t row;
    double error; /* over what the column promises for an accuracy of 1, or over what is told */
} column_error;

/* How often something was said. */
typedef struct reason {
    char text[REASON_LENGTH];
    size_t count;
} reason;

typedef struct tally {
    size_t scenes;    /* runs: scene x accuracy */
    size_t delivered; /* with all rows judged */
    size_t refused, failed, unjudged, broken;
    double worst;   /* delivered over wanted error, of promises that were kept */
    column_error told; /* delivered over told error of the worst of them */
    double seconds; /* of processors */
    reason reasons[MOST_REASONS];
} tally;

/* One scene with what is true of it, by all accuracies. */
typedef struct judged {
    dea_scene scene;
    size_t number;
    double tightest; /* accuracy that it will be judged at; a truth need not be much better */
    bool found;     /* the truth, which is looked for once an engine takes the scene */
    void *truth;    /* points as the layout has them */
    double *errors; /* of each point */
    dea_layout layout;
    size_t points;
    true_run *runs;  /* of transients */
    const char *why; /* NULL, or why nothing is judged */
} judged;

bool judge_open(judged *j, const char *text, size_t number);
/* Finds the truth, unless it is found already; judge_engine() does so once an engine takes the scene. */
void judge_find(judged *j);
void judge_close(judged *j);
/* Runs an engine at one accuracy; adds to the tally. True where the promise was broken; *text then says how. */
bool judge_engine(judged *j, const dea_engine *engine, double accuracy, tally *t, char *text, size_t size);

/* Worst of them in the rows of a point, of those whose truth is good to a tenth of what it judges. */
column_error columns_error(const judged *j, size_t point, const dea_sample *rows, double accuracy);

/* Worst mean of a point's windows that its rows cover, over the peak; INFINITY where a film that never ends has none. */
column_error means_error(const judged *j, size_t point, const dea_summary *summary, double peak, double accuracy);

/* Worst error over the one that the summary tells, of the columns that it tells one of and whose truth is good to a tenth of that. */
column_error told_error(const judged *j, size_t point, const dea_sample *rows, const dea_summary *summary);

/* The tightest accuracy that the engine promises for such a study. */
double best_accuracy(const dea_engine *engine, const dea_scene *scene);

#endif
