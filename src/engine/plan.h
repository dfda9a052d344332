/** @file plan.h
 * How a study is cut into blocks, and how the points that an engine cannot solve are found inside a block.
 */
#ifndef DEA_ENGINE_PLAN_H
#define DEA_ENGINE_PLAN_H

#include "engine/cut.h"

/** A study and what of it is to be computed. */
typedef struct dea_plan {
    const dea_scene *scene;
    const dea_engine *engine; /**< NULL: each model by its crew */
    const dea_run_options *options;
    dea_layout layout; /**< of a point's result */
    dea_cut cut;
    size_t blocks; /**< that are wanted */
    size_t points; /**< in those */
} dea_plan;

/** One block. */
typedef struct dea_span {
    const dea_model *model;
    size_t first; /**< first point, counted within its model */
    size_t place; /**< first point, counted over the study */
    size_t count; /**< points, >= 1 */
} dea_span;

/** Why a range was not solved. How often it is tried and whether that is the last word stands in one table, in plan.c. */
typedef enum dea_fault {
    DEA_FAULT_REFUSED, /**< the engine said so: it would again, in every run */
    DEA_FAULT_OVERDUE, /**< the worker used up the engine's patience and was killed */
    DEA_FAULT_CRASHED, /**< the worker ended by a fault of its own, or memory or disk ran out */
    DEA_FAULT_KILLED   /**< the worker was killed or stopped from outside, which says nothing about its points */
} dea_fault;

/** Points by who has delivered them: engines of the model's crew in its order. */
typedef struct dea_hands {
    size_t by[DEA_ENGINES];
} dea_hands;

/** Progress inside one block: points before `next` are settled, and `suspect` > next ends a range known to fail. A block of which
 * no point is lost or left to the next engine comes from the same calls of the engine as in a run without a loss, so that it has the same bits. */
typedef struct dea_attempt {
    size_t count;   /**< points of the block */
    size_t next;    /**< first point that is not settled */
    size_t end;     /**< end of the range that is tried now */
    size_t suspect; /**< end of a range from next on that failed as a whole, 0: none */
    size_t tries;   /**< of the range that is tried now, which failed */
    size_t skip;    /**< engines of the crew that the range that is tried now has cost a worker */
    size_t lost;    /**< points that were given up without the engine's last word */
    bool cut;       /**< a range was halved that the engine had not refused */
    bool again;     /**< the whole is tried once more after it was cut without need */
    dea_hands hands;
} dea_attempt;

/** What went wrong so far in a run; bounds the time that a broken engine can take. */
typedef struct dea_damage {
    size_t alone;  /**< points that failed alone */
    size_t losses; /**< workers that hung or were stopped, or went while they had nothing to do */
    size_t streak; /**< ranges given up since the last one that was solved, after isolating ended */
    size_t lines;  /**< lines written to the log */
} dea_damage;

/** Cuts the study and counts what of it is wanted. */
dea_status dea_plan_make(const dea_scene *scene, const dea_engine *engine, const dea_run_options *options, dea_plan *plan,
                         dea_error *error);
/** True where the study runs in this process, not in workers. */
bool dea_plan_here(const dea_plan *plan);
/** The first wanted block from number *@p block on, which steps behind it. There is one as long as not all were taken. */
dea_span dea_plan_next(const dea_plan *plan, size_t *block);

/** Starts a block of @p count points; the whole of it is tried first. */
dea_attempt dea_attempt_start(size_t count);
/** True when every point of the block is settled. */
bool dea_attempt_over(const dea_attempt *attempt);
/** The range next ... end - 1 was solved. */
void dea_attempt_solved(dea_attempt *attempt, const dea_hands *hands, dea_damage *damage);
/** What a status that an engine returned says. */
dea_fault dea_fault_of(dea_status status);
/** The range next ... end - 1 failed for the reason @p why: tries it again, halves it, leaves it to the next engine, or marks its rows (in the @p points of the
 * block) as failed and tells the log. */
void dea_attempt_failed(dea_attempt *attempt, const dea_plan *plan, const dea_span *span, void *points, dea_fault fault,
                        const char *why, dea_damage *damage);
/** Gives up what is left of the block, in whose @p points it makes those rows failed. */
void dea_attempt_abandon(dea_attempt *attempt, const dea_plan *plan, void *points);
/** Tells the log why rows of the range next ... end - 1, which was solved, are `failed`; nothing where @p why is empty. */
void dea_attempt_remark(const dea_attempt *attempt, const dea_plan *plan, const dea_span *span, const char *why,
                        dea_damage *damage);
/** True when the engine is past hope: nothing more is tried, the remaining rows are failed. */
bool dea_damage_hopeless(const dea_damage *damage);
/** Hands a block that is over to the caller, adds its points to *@p done and tells progress. */
dea_status dea_plan_deliver(const dea_plan *plan, const dea_span *span, const void *points, const dea_attempt *attempt, size_t *done,
                            dea_error *error);
/** Time that a worker may take for so many points of a model before it hangs, beyond what every worker gets [s]. */
double dea_plan_patience(const dea_plan *plan, const dea_model *model, size_t count);
/** Writes where a point lies, e.g. " (coverage=0.5, voltage_V=4500)", nothing without axes; the last axis varies fastest. */
void dea_plan_place(const dea_scene *scene, size_t point, char *text, size_t size);
/** True when the caller wants the run to end. */
bool dea_plan_stopped(const dea_plan *plan);
/** One line for the caller's log. */
void dea_plan_log(const dea_plan *plan, dea_damage *damage, const char *format, ...) DEA_PRINTF(3, 4);

/* ---- A study on worker processes. */

/** Runs the plan on up to plan->options->jobs forked workers and reaps them all before it returns.
 * @param beyond time that a worker may take on top of its engine's patience [s] */
dea_status dea_pool_run(const dea_plan *plan, double beyond, dea_error *error);

#endif
