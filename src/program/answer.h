/** @file answer.h
 * What a run says of the actuator, model by model: how far it moves and where, how near it is to breakdown, what it takes
 * electrically, and where its states begin.
 */
#ifndef DEA_PROGRAM_ANSWER_H
#define DEA_PROGRAM_ANSWER_H

#include "deaspice/result.h"
#include "deaspice/scene.h"

/** A row of a study. */
typedef struct dea_spot {
    double value;  /**< what was looked for there, by magnitude the largest; NAN: none yet */
    size_t number; /**< of its point, counted within its model */
    size_t row;
    dea_state state;
} dea_spot;

/** What was seen of one model. */
typedef struct dea_answer {
    dea_spot strain;       /**< [1], of rows that are `ok` where there are any */
    dea_spot displacement; /**< [m], likewise */
    dea_spot field;        /**< true field [V/m], of all rows */
    dea_spot charge;       /**< of the film [C], of all rows */
    double capacitance;    /**< in that row [F], NAN: not told */
    size_t states[DEA_STATE_COUNT];
    dea_spot firsts[DEA_STATE_COUNT];
} dea_answer;

/** An answer that has seen nothing. */
dea_answer dea_answer_begin(void);
/** Takes the rows of point number @p number, counted within its model. */
void dea_answer_take(dea_answer *answer, const dea_layout *layout, size_t number, const void *point);
/** Number of the column of that name in a row, NAN where the study has no such column. */
double dea_answer_column(const dea_layout *layout, const void *row, const char *name);
/** Prints @p before, "coverage = 0.5, voltage = 4.5 kV"; what is to stand before a further number, @p before itself where there is no
 * axis. */
const char *dea_answer_place(const dea_scene *scene, size_t number, const char *before);
/** Prints what model number @p model has shown on standard error, of a frequency response its electrical side only, and with
 * @p truth how far the model is from the membrane. */
void dea_answer_print(const dea_answer *answer, const dea_scene *scene, size_t model, bool truth);

#endif
