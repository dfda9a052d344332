#include "engine/solve.h"

#include "deaspice/needs.h"
#include "engine/line.h"
#include "network/swing.h"
#include "result/scales.h"

#include <math.h>
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

/* A transient whose energies do not add up says so, where the engine itself has said nothing. */
static void doubt_balance(const dea_scene *scene, const dea_summary *summary, dea_error *error)
{
    if (summary->residual > 10.0 * scene->accuracy && error->message[0] == '\0')
        dea_fail(
            error, DEA_OK,
            "its energy balance is off by %.2g, more than ten times the accuracy: current and energies are not to be trusted",
            summary->residual);
}

/* Of a window that reaches past the last row with numbers there is no mean. */
static void drop_means(const dea_scene *scene, const dea_sample *samples, size_t rows, dea_summary *summary)
{
    size_t good = 0;
    while (good < rows && isfinite(samples[good].displacement)) {
        good++;
    }
    const double last = good == rows ? scene->transient.until : good > 0 ? samples[good - 1].time : -1.0;
    for (size_t i = 0; i < DEA_WINDOWS; i++) {
        if (i >= scene->transient.average_count || scene->transient.averages[i].to > last) {
            summary->averages[i] = (dea_average){(double)NAN, (double)NAN};
        }
    }
}

/* The swing of the film with all that a run may leave out, unless the engine has found it in its own way. */
static void tell_swing(dea_swing swing, dea_summary *summary)
{
    if (isnan(summary->resonance)) {
        summary->resonance = swing.frequency;
        summary->decay = swing.decay;
    }
}

/* One transient, without what it does not need: the engine gets what accuracy that leaves. */
static dea_status run_transient(const dea_plan *plan, const dea_task *task, dea_scene *here, void *result, dea_error *error)
{
    const dea_engine *engine = task->engine;
    const dea_model *model = task->model;
    void *session = task->session;
    dea_summary *summary = dea_layout_summary(&plan->layout, result);
    dea_needs needs;
    if (here->full) {
        here->reduction.ring = (double)INFINITY;
        const dea_status whole = engine->transient(session, here, model, result, summary, error);
        tell_swing(dea_swing_free(here, model), summary);
        return whole;
    }
    dea_status status = dea_needs_find(here, model, engine, &needs, error);
    if (status == DEA_OK) {
        here->reduction = dea_needs_reduction(needs.omissions, needs.count);
        here->accuracy -= needs.bound;
        status = engine->transient(session, here, model, result, summary, error);
    }
    tell_swing((dea_swing){needs.resonance, needs.decay}, summary);
    summary->omitted = needs.bound;
    summary->error += needs.bound;
    summary->velocity_error += dea_scales_allowance(offsetof(dea_sample, velocity)) * needs.bound;
    summary->current_error += dea_scales_allowance(offsetof(dea_sample, current)) * needs.bound;
    return status;
}

/* One transient or frequency response. */
static dea_status run_point(const dea_plan *plan, const dea_task *task, size_t point, void *result, dea_error *error)
{
    dea_scene here = *plan->scene; /* shares title, waveform and axes, changes only scalars */
    dea_axes_place(&here, point);
    dea_status status;
    if (here.study == DEA_STUDY_TRANSIENT)
        status = run_transient(plan, task, &here, result, error);
    else
        status = task->engine->ac(task->session, &here, task->model, result, dea_layout_band(&plan->layout, result), error);
    if (status == DEA_ERROR_USAGE && plan->cut.total > 1) {
        dea_layout_fail(plan->scene, &plan->layout, result);
        return DEA_OK;
    }
    if (status == DEA_OK && here.study == DEA_STUDY_TRANSIENT) {
        dea_summary *summary = dea_layout_summary(&plan->layout, result);
        drop_means(&here, result, plan->layout.rows, summary);
        doubt_balance(&here, summary, error);
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
    const bool sweep = plan->scene->study == DEA_STUDY_SWEEP;
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

/* True where the numbers of the point are in their ranges: in a grid a corner can lie outside. */
static bool is_valid(const dea_plan *plan, size_t number)
{
    dea_point point;
    dea_scene here = *plan->scene;
    dea_axes_place(&here, number);
    dea_film_prepare(&here, &point.film);
    dea_point_place(&here, &point);
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
    char place[256];
    dea_plan_place(plan->scene, range->first + at, place, sizeof place);
    const char *why = is_valid(plan, range->first + at) ? "the engine found no answer that passes its own check"
                                                        : "a number is out of its range";
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
    if (plan->scene->study == DEA_STUDY_SWEEP)
        explain_rows(plan, range, points, error);
    hands->by[by] = range->count;
    solve_again(plan, sessions, &crew, by, range, points, hands, error);
    return DEA_OK;
}
