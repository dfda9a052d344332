#include "engine/plan.h"
#include "engine/pool.h"

#include <stdlib.h>

static const double patience_beyond = 10; /* [s] a worker may take on top of its engine's patience */

static dea_status check_request(const dea_scene *scene, const dea_engine *engine, const dea_run_options *options,
                                dea_error *error)
{
    if (options->jobs == 0 || !options->points)
        return dea_fail(error, DEA_ERROR_USAGE, "a run needs at least one job and someone who takes the points");
    for (size_t i = 0; i < scene->model_count; i++) {
        const char *why = dea_engine_refuses(engine, scene, scene->models[i]);
        if (why)
            return dea_fail(error, DEA_ERROR_UNSUPPORTED, "engine %s cannot do model %s: %s", engine->name,
                            scene->models[i]->name, why);
    }
    return DEA_OK;
}

static dea_status session_renew(const dea_engine *engine, void **session, dea_error *error)
{
    engine->end(*session);
    *session = NULL;
    return engine->begin(session, error);
}

/* Solves one block in this process; a session that failed is replaced. */
static dea_status solve_block(const dea_plan *plan, const dea_span *span, void **session, dea_attempt *attempt, char *points,
                              dea_damage *damage, dea_error *error)
{
    while (!dea_attempt_over(attempt)) {
        if (dea_plan_stopped(plan))
            return dea_fail(error, DEA_ERROR_INTERRUPTED, "interrupted");
        if (dea_damage_hopeless(damage)) {
            dea_attempt_abandon(attempt, plan, points);
            return DEA_OK;
        }
        dea_error reason = {0};
        dea_status status = dea_plan_solve(plan, *session, span->model, span->first + attempt->next, attempt->end - attempt->next,
                                           points + attempt->next * plan->layout.point_size, &reason);
        if (status == DEA_OK) {
            dea_attempt_remark(attempt, plan, span, reason.message, damage);
            dea_attempt_solved(attempt, damage);
            continue;
        }
        const char *why = reason.message[0] ? reason.message : dea_status_text(status);
        dea_attempt_failed(attempt, plan, span, points, dea_fault_of(status), why, damage);
        status = session_renew(plan->engine, session, error);
        if (status != DEA_OK)
            return status;
    }
    return DEA_OK;
}

static dea_status run_here(const dea_plan *plan, dea_error *error)
{
    char *points = malloc(plan->cut.block * plan->layout.point_size);
    if (!points)
        return dea_fail(error, DEA_ERROR_MEMORY, "out of memory for a block of %zu points", plan->cut.block);
    void *session = NULL;
    dea_damage damage = {0};
    dea_status status = plan->engine->begin(&session, error);
    size_t next = 0, done = 0;
    while (status == DEA_OK && done < plan->points) {
        dea_span span = dea_plan_next(plan, &next);
        dea_attempt attempt = dea_attempt_start(span.count);
        status = solve_block(plan, &span, &session, &attempt, points, &damage, error);
        if (status == DEA_OK)
            status = dea_plan_deliver(plan, &span, points, attempt.lost, &done, error);
    }
    plan->engine->end(session);
    free(points);
    return status;
}

dea_status dea_study_run(const dea_scene *scene, const dea_engine *engine, const dea_run_options *options, dea_error *error)
{
    dea_plan plan;
    dea_status status = check_request(scene, engine, options, error);
    if (status == DEA_OK)
        status = dea_plan_make(scene, engine, options, &plan, error);
    if (status != DEA_OK || plan.blocks == 0)
        return status;
    return dea_plan_here(&plan) ? run_here(&plan, error) : dea_pool_run(&plan, patience_beyond, error);
}
