#include "engine/plan.h"
#include "engine/solve.h"

#include <stdlib.h>

static const double patience_beyond = 10; /* [s] a worker may take on top of its engine's patience */

static dea_status check_request(const dea_scene *scene, const dea_engine *engine, const dea_run_options *options,
                                dea_error *error)
{
    if (options->jobs == 0 || !options->points)
        return dea_fail(error, DEA_ERROR_USAGE, "a run needs at least one job and someone who takes the points");
    for (size_t i = 0; i < scene->model_count; i++) {
        if (dea_crew_of(scene, engine, scene->models[i]).count == 0 && engine)
            return dea_fail(error, DEA_ERROR_UNSUPPORTED, "engine %s cannot do model %s: %s", engine->name,
                            scene->models[i]->name, dea_engine_refuses(engine, scene, scene->models[i]));
        if (dea_crew_of(scene, engine, scene->models[i]).count == 0)
            return dea_fail(error, DEA_ERROR_UNSUPPORTED, "no engine can do model %s in this study at this accuracy",
                            scene->models[i]->name);
    }
    return DEA_OK;
}

static dea_status sessions_renew(const dea_plan *plan, dea_sessions *sessions, dea_error *error)
{
    dea_sessions_end(sessions);
    return dea_sessions_begin(plan, sessions, error);
}

/* Solves one block in this process; a session that failed is replaced. */
static dea_status solve_block(const dea_plan *plan, const dea_span *span, dea_sessions *sessions, dea_attempt *attempt,
                              char *points, dea_damage *damage, dea_error *error)
{
    while (!dea_attempt_over(attempt)) {
        if (dea_plan_stopped(plan))
            return dea_fail(error, DEA_ERROR_INTERRUPTED, "interrupted");
        if (dea_damage_hopeless(damage)) {
            dea_attempt_abandon(attempt, plan, points);
            return DEA_OK;
        }
        dea_error reason = {0};
        const dea_errand errand = {span->model, span->first + attempt->next, attempt->end - attempt->next, attempt->skip};
        dea_hands hands;
        dea_status status =
            dea_plan_solve(plan, sessions, &errand, points + attempt->next * plan->layout.point_size, &hands, &reason);
        if (status == DEA_OK) {
            dea_attempt_remark(attempt, plan, span, reason.message, damage);
            dea_attempt_solved(attempt, &hands, damage);
            continue;
        }
        const char *why = reason.message[0] ? reason.message : dea_status_text(status);
        dea_attempt_failed(attempt, plan, span, points, dea_fault_of(status), why, damage);
        status = sessions_renew(plan, sessions, error);
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
    dea_sessions sessions;
    dea_damage damage = {0};
    dea_status status = dea_sessions_begin(plan, &sessions, error);
    size_t next = 0, done = 0;
    while (status == DEA_OK && done < plan->points) {
        dea_span span = dea_plan_next(plan, &next);
        dea_attempt attempt = dea_attempt_start(span.count);
        status = solve_block(plan, &span, &sessions, &attempt, points, &damage, error);
        if (status == DEA_OK)
            status = dea_plan_deliver(plan, &span, points, &attempt, &done, error);
    }
    dea_sessions_end(&sessions);
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
