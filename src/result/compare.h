/* How far the points of a study, solved one way, are from reference points of the same study and model, solved another way. */
#ifndef DEASPICE_RESULT_COMPARE_H
#define DEASPICE_RESULT_COMPARE_H

#include "deaspice/result.h"
#include "study/study.h"
#include "deaspice/model.h"

enum { DEA_COMPARED_COLUMNS = 10 };

/* One compared column: where it lies in a row, and how. */
typedef struct dea_compared {
    size_t column; /* of the layout */
    dea_measure measure;
    const char *head;
    double allowance; /* accuracies that the column promises */
} dea_compared;

/* The reference points of one model, and what the points that come after them differ by. */
typedef struct dea_comparison {
    const dea_scene *scene; /* its first model counts; outlives this */
    dea_layout layout;
    dea_compared columns[DEA_COMPARED_COLUMNS];
    size_t column_count;
    char *reference; /* points as the layout has them; owned */
    size_t points;
    bool filling;    /* points are the reference itself; the caller ends this */
    double at_limit; /* states may differ where a limit is that near, over the peak of the displacement; rounding unless set */
    /* magnitude that samples of a transient can miss altogether, where they fall between pulses */
    double least[DEA_COMPARED_COLUMNS];
    double scale[DEA_COMPARED_COLUMNS]; /* largest magnitude in the reference */
    /* since dea_comparison_forget(): */
    double worst[DEA_COMPARED_COLUMNS]; /* largest difference */
    double mean;                        /* largest difference of the means over windows, over the displacement's peak */
    double swing;                       /* largest difference of the film's swing, over its size; infinite: only one has it */
    size_t states;                      /* rows whose states differ */
    size_t failed;                      /* rows not solved */
    double error;                       /* largest error that the engine estimates, NAN: it does not tell */
    double residual;                    /* largest residual of its energy balance, NAN */
} dea_comparison;

/* Begins a comparison for the first model of the scene, waiting for its reference. The caller ends it with
 * dea_comparison_close(). @return DEA_OK, DEA_ERROR_MEMORY */
dea_status dea_comparison_open(dea_comparison *comparison, const dea_scene *scene, dea_error *error);
/* Frees the reference; a zeroed comparison is fine. */
void dea_comparison_close(dea_comparison *comparison);
/* Forgets all differences, before the points of the next engine. */
void dea_comparison_forget(dea_comparison *comparison);
/* Takes points in any order: into the reference, or against it. Rows that one of the two did not solve are not compared.
 * @return DEA_OK, DEA_ERROR_ENGINE (more points than the study has), DEA_ERROR_MEMORY */
dea_status dea_comparison_take(dea_comparison *comparison, size_t first, const void *points, size_t count, dea_error *error);
/* Largest difference over the compared columns and figures, each over its allowance; rows whose states differ do not count here. */
double dea_comparison_worst(const dea_comparison *comparison);

/* ---- States of samples against their numbers: near a limit, answers that agree may have different states. */

/* True where a sample's state is that of the film at its displacement, or within @p slack of it [m], under its voltage or charge.
 * All axes of the scene are at their place. False where the sample has no numbers. */
bool dea_state_follows(const dea_scene *scene, const dea_sample *sample, double slack);
/* True where the model's own static states at voltages that are @p share less and more than that of the scene are these two: a limit lies
 * between. All axes of the scene are at their place. */
bool dea_state_between(const dea_scene *scene, double share, dea_state one, dea_state other);

#endif
