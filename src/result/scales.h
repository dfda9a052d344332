/* What the numbers of a transient's columns are measured by: an error counts relative to these.
 *
 *   displacement, strain, force, charge, focal length, film voltage   their own peak over the samples, no less than a hundredth of what the
 *                   largest voltage of the run does at rest
 *   velocity, current   their own peak over the samples, no less than displacement and charge over the run's fastest time T
 *
 * The samples may miss the peak of a velocity behind an edge; T tells what it was. With a segment of the drive that changes the
 * voltage by dU within w (a jump: w = 0; a sine of angular frequency f: its amplitude within 1/f),
 *
 *   1/T = max over the segments of (dU/U_max)/max(w, t)
 *
 * t is the time in which the film answers: the largest of sqrt(m/K), tau_KV and R C of those that it has, as each holds back what
 * is faster (current: R C alone). A film that has none of them follows its voltage, so that its velocity in a jump is no number
 * of the run; it creeps behind it in t = 1/sum(g_i/tau_i), its g of the instantaneous modulus. T is at
 * most the run itself: what rounding does to a film at rest is nothing. */
#ifndef DEA_SCALES_H
#define DEA_SCALES_H

#include "drive/signal.h"
#include "network/dynamics.h"

typedef struct dea_scales {
    dea_sample least; /* of the columns that are no rates */
    double pace;      /* 1/T of the displacement [1/s] */
    double charging;  /* 1/T of the charge [1/s] */
    double motional;  /* C' U_max: current of a velocity [A s/m] */
    dea_status status; /* DEA_OK, or why there are no scales: DEA_ERROR_MEMORY, or a model that does not move */
} dea_scales;

/* Largest difference that a column may have from the truth, in its unit. */
typedef struct dea_rate_errors {
    double velocity, current; /* [m/s], [A] */
} dea_rate_errors;

/* Accuracies that a column of a transient promises, relative to its scale: 1 for displacement and strain, 10 for the others. */
double dea_scales_allowance(size_t offset);

/* Of the scene's full network under its drive, axes at their place; where that cannot be built all are 0, and the status says why. */
dea_scales dea_scales_open(const dea_scene *scene, const dea_model *model);
/* Scales of the columns over the rows of a run that have numbers, in the fields of a sample; time and voltage 0. */
dea_sample dea_scales_of(const dea_scales *scales, const dea_sample *samples, size_t count);

/* Largest differences of two runs, column by column, and the largest numbers of the second. */
typedef struct dea_columns_gap {
    dea_sample most, peak;
} dea_columns_gap;

/* Widens a gap, at first all 0, by a sample of both runs; rows without numbers widen nothing. */
void dea_columns_widen(dea_columns_gap *gap, const dea_sample *a, const dea_sample *b);
/* Of the column that is worst against what it promises, times its allowance, over its scale [1]. */
double dea_columns_worst(const dea_scales *scales, const dea_columns_gap *gap);

/* Errors of velocity and current over their scales, into the summary, none less than @p least: what runs may be off by alike [1]. */
void dea_scales_tell(const dea_scales *scales, const dea_sample *samples, size_t count, dea_rate_errors errors, double least,
                     dea_summary *summary);

#endif
