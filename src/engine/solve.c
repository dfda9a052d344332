#include "engine/solve.h"

#include "scene/line.h"
#include "study/study.h"

#include <stddef.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* A model in the hands of an engine. */
typedef struct dea_task {
    const dea_engine *engine;
    void *session;
    const dea_model *model;
} dea_task;

/* ---- sessions */

/* The engine's session, or a free one for it: a scene names no more engines than there are places. */
static dea_session *session_of(dea_sessions *sessions, const dea_engine *engine)
{
    size_t place = 0;
    while (place + 1 < DEA_ENGINES && sessions->of[place].engine && sessions->of[place].engine != engine)
        place++;
    return &sessions->of[place];
}

static dea_status session_begin(dea_sessions *sessions, const dea_engine *engine, dea_error *error)
{
    dea_session *session = session_of(sessions, engine);
    if (session->engine == engine)
        return DEA_OK;
    const dea_status status = engine->begin(&session->state, error);
    session->engine = status == DEA_OK ? engine : NULL;
    return status;
}

static void session_end(dea_session *session)
{
    if (session->engine)
        session->engine->end(session->state);
    *session = (dea_session){0};
}

dea_status dea_sessions_begin(const dea_plan *plan, dea_sessions *sessions, dea_error *error)
{
    dea_status status = DEA_ERROR_UNSUPPORTED;
    const dea_crew crew = dea_crew_of(plan->scene, plan->engine, plan->scene->models[0]);
    *sessions = (dea_sessions){0};
    for (size_t i = 0; i < crew.count && status != DEA_OK; i++)
        status = session_begin(sessions, crew.engines[i], error);
    return status;
}

void dea_sessions_end(dea_sessions *sessions)
{
    for (size_t i = 0; i < DEA_ENGINES; i++)
        session_end(&sessions->of[i]);
}

/* ---- one engine */

/* One point of those that are solved one by one. */
static dea_status run_point(const dea_plan *plan, const dea_task *task, size_t point, void *result, dea_error *error)
{
    dea_scene here = *plan->scene; /* shares title, waveform and axes, changes only scalars */
    dea_axes_place(&here, point);
    const dea_status status =
        dea_study_of(&here)->solve(task->engine, task->session, &here, task->model, &plan->layout, result, error);
    if (status == DEA_ERROR_USAGE && plan->cut.total > 1) {
        dea_layout_fail(plan->scene, &plan->layout, result);
        return DEA_OK;
    }
    return status;
}

static char *point_at(const dea_plan *plan, void *points, size_t index)
{
    return (char *)points + index * plan->layout.point_size;
}

/* A range by one engine; a session that fails ends. */
static dea_status solve_by(const dea_plan *plan, dea_sessions *sessions, const dea_engine *engine, const dea_errand *range,
                           void *points, dea_error *error)
{
    const bool sweep = !dea_study_of(plan->scene)->solve;
    dea_status status = session_begin(sessions, engine, error);
    const dea_task task = {engine, session_of(sessions, engine)->state, range->model};
    if (status == DEA_OK && sweep)
        status = engine->sweep(task.session, plan->scene, range->model, range->first, range->count, points, error);
    for (size_t i = 0; i < range->count && status == DEA_OK && !sweep; i++)
        status = run_point(plan, &task, range->first + i, point_at(plan, points, i), error);
    if (status != DEA_OK)
        session_end(session_of(sessions, engine));
    return status;
}

/* ---- one engine after the other */

static dea_point placed(const dea_plan *plan, size_t number)
{
    dea_point point;
    dea_scene here = *plan->scene;
    dea_axes_place(&here, number);
    dea_film_prepare(&here, &point.film);
    dea_point_place(&here, &point);
    return point;
}

/* True where the numbers of the point are in their ranges: in a grid a corner can lie outside. */
static bool is_valid(const dea_plan *plan, size_t number)
{
    const dea_point point = placed(plan, number);
    return dea_point_valid(&point);
}

/* Rows of a point that failed. */
static size_t failed_rows(const dea_plan *plan, const char *point)
{
    size_t failed = 0;
    for (size_t i = 0; i < plan->layout.rows; i++)
        failed += dea_layout_state(&plan->layout, point + i * plan->layout.row_size) == DEA_STATE_FAILED;
    return failed;
}

/* Points by the first of the crew that takes them, whose number is *@p by; the message says why those before it did not. */
static dea_status solve_first(const dea_plan *plan, dea_sessions *sessions, const dea_crew *crew, const dea_errand *range,
                              size_t *by, void *points, dea_error *error)
{
    dea_status status = dea_fail(error, DEA_ERROR_UNSUPPORTED, "no engine can do the model");
    dea_error first = {0};
    for (*by = range->skip; *by < crew->count; ++*by) {
        error->message[0] = '\0';
        status = solve_by(plan, sessions, crew->engines[*by], range, points, error);
        if (status == DEA_OK)
            break;
        if (*by == range->skip)
            first = *error;
    }
    if (status == DEA_OK && *by > range->skip)
        dea_fail(error, DEA_OK, "%.*s; %s was asked instead", DEA_ERROR_LENGTH / 2,
                 first.message[0] ? first.message : dea_status_text(first.status), crew->engines[*by]->name);
    else if (status != DEA_OK && crew->count > 1)
        *error = first;
    return status;
}

/* One point whose rows failed, by the rest of the crew; the number of who solved it, @p by: nobody. */
static size_t solve_point_again(const dea_plan *plan, dea_sessions *sessions, const dea_crew *crew, size_t by,
                                           const dea_errand *one, char *point)
{
    char *room = malloc(plan->layout.point_size);
    size_t solver = by;
    for (size_t e = by + 1; room && e < crew->count && solver == by; e++) {
        dea_error unheard = {0};
        if (solve_by(plan, sessions, crew->engines[e], one, room, &unheard) == DEA_OK && failed_rows(plan, room) == 0) {
            memcpy(point, room, plan->layout.point_size);
            solver = e;
        }
    }
    free(room);
    return solver;
}

/* What number @p by of the crew has left `failed`, by those behind it; the message, why it failed, then says how many of the
 * points were solved instead. */
static void solve_again(const dea_plan *plan, dea_sessions *sessions, const dea_crew *crew, size_t by, const dea_errand *range,
                        void *points, dea_hands *hands, dea_error *error)
{
    size_t solved = 0, last = by;
    for (size_t i = 0; by + 1 < crew->count && i < range->count; i++) {
        const dea_errand one = {.model = range->model, .first = range->first + i, .count = 1};
        char *point = point_at(plan, points, i);
        const bool again = failed_rows(plan, point) > 0 && is_valid(plan, one.first);
        const size_t solver = again ? solve_point_again(plan, sessions, crew, by, &one, point) : by;
        last = solver != by ? solver : last;
        solved += solver != by ? 1 : 0;
        hands->by[solver]++;
        hands->by[by]--;
    }
    const size_t used = strlen(error->message);
    if (solved > 0)
        snprintf(error->message + used, sizeof error->message - used, "; solved by %s instead%s", crew->engines[last]->name,
                 range->count > solved ? " where that failed" : "");
}

/* Of the rows of a sweep that failed, the first and how many there are. */
static void explain_rows(const dea_plan *plan, const dea_errand *range, const dea_row *rows, dea_error *error)
{
    size_t failed = 0;
    size_t at = 0;
    for (size_t i = range->count; i-- > 0;) {
        if (rows[i].state == DEA_STATE_FAILED) {
            failed++;
            at = i;
        }
    }
    if (failed == 0)
        return;
    char place[256], fault[DEA_FAULT_LENGTH];
    dea_plan_place(plan->scene, range->first + at, place, sizeof place);
    const dea_point point = placed(plan, range->first + at);
    const char *why =
        dea_point_valid(&point) ? "the engine found no answer that passes its own check" : dea_film_fault(&point.film, fault);
    dea_fail(error, DEA_OK, "%zu of %zu points failed, the first at %zu%s: %s", failed, range->count, range->first + at, place,
             why);
}

dea_status dea_plan_solve(const dea_plan *plan, dea_sessions *sessions, const dea_errand *range, void *points, dea_hands *hands,
                          dea_error *error)
{
    size_t by;
    *hands = (dea_hands){0};
    const dea_crew crew = dea_crew_of(plan->scene, plan->engine, range->model);
    const dea_status status = solve_first(plan, sessions, &crew, range, &by, points, error);
    if (status != DEA_OK)
        return status;
    if (!dea_study_of(plan->scene)->along)
        explain_rows(plan, range, points, error);
    hands->by[by] = range->count;
    solve_again(plan, sessions, &crew, by, range, points, hands, error);
    return DEA_OK;
}
