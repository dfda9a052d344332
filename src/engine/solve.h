/** @file solve.h
 * Points of a study by the engines of their model, one after the other until one delivers.
 */
#ifndef DEA_ENGINE_SOLVE_H
#define DEA_ENGINE_SOLVE_H

#include "engine/plan.h"

/** Points of a model. */
typedef struct dea_errand {
    const dea_model *model;
    size_t first; /**< counted within the model */
    size_t count; /**< >= 1 */
    size_t skip;  /**< so many engines of the model's crew are not asked */
} dea_errand;

/** A session that has begun, zeroed: none. */
typedef struct dea_session {
    const dea_engine *engine;
    void *state; /**< the engine's */
} dea_session;

/** Sessions of one process; each begins when it is needed. */
typedef struct dea_sessions {
    dea_session of[DEA_ENGINES];
} dea_sessions;

/** Begins the session that the first model needs. @return DEA_OK, or why the last engine that may be asked could not begin */
dea_status dea_sessions_begin(const dea_plan *plan, dea_sessions *sessions, dea_error *error);
/** Ends all that have begun. */
void dea_sessions_end(dea_sessions *sessions);
/** Solves a range into memory laid out as the plan says. A point whose numbers are out of range, as a
 * grid can hold, costs only its own rows where it is one of many. Points that an engine refuses or leaves `failed` go to the next
 * one of the model's crew; the message says so, and *@p hands who has solved how many. */
dea_status dea_plan_solve(const dea_plan *plan, dea_sessions *sessions, const dea_errand *range, void *points, dea_hands *hands,
                          dea_error *error);

#endif
