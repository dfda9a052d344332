/* Engine `ida`: networks and the exact membrane by SUNDIALS. */
#include <stdio.h>
#include <stdlib.h>

#include "engine/engines.h"
#include "engine/ida/sundials.h"
#include "scene/line.h"
#include "model/loaded.h"
#include "network/membrane.h"
#include "network/balance.h"
#include "study/study.h"

typedef struct session_state {
    dea_sundials sundials; /* owned, as all */
    dea_ramp *ramp;
    dea_shooting *shooting;
} session_state;

typedef struct visit_state {
    session_state *session;
    const dea_model *model;
    dea_row *rows;
} visit_state;

static const char *refuses(const dea_scene *scene, const dea_model *model)
{
    if (!model->network && !model->membrane) {
        return "it is neither a network nor a membrane that IDA could solve";
    }
    if (!model->membrane && dea_study_of(scene)->holds) {
        return "of a network whose edge is held no equation is left to solve";
    }
    if (model->membrane && dea_study_of(scene)->timed && dea_load_stalls(scene)) {
        return dea_load_stalled;
    }
    return scene->accuracy < 1e-9 ? "its answers are good to 1e-9, the scene wants more" : NULL;
}

static void end(void *session)
{
    session_state *state = session;
    if (state) {
        dea_ramp_close(state->ramp);
        dea_shooting_close(state->shooting);
        dea_sundials_close(&state->sundials);
        free(state);
    }
}

static dea_status begin(void **session, dea_error *error)
{
    session_state *state = calloc(1, sizeof *state);
    *session = NULL;
    if (!state) {
        return dea_fail(error, DEA_ERROR_MEMORY, "out of memory while IDA starts");
    }
    dea_status status = dea_sundials_open(&state->sundials, error);
    if (status == DEA_OK) {
        status = dea_ramp_open(&state->sundials, &state->ramp, error);
    }
    if (status == DEA_OK) {
        status = dea_shooting_open(&state->sundials, &state->shooting, error);
    }
    if (status != DEA_OK) {
        end(state);
        return status;
    }
    *session = state;
    return DEA_OK;
}

static dea_status solve_network(visit_state *state, const dea_scene *scene, const dea_line *line, dea_error *error)
{
    dea_network network;
    dea_balance balance;
    dea_status status = dea_network_build(scene, state->model, line->axis, &network, error);
    if (status == DEA_OK) {
        status = dea_balance_open(&network, &balance, error);
    }
    dea_network_free(&network);
    if (status != DEA_OK) {
        return status;
    }
    for (size_t i = 0; i < line->count; i++) {
        const double symbol = line->axis ? line->axis->values[line->from + i] : 0.0;
        dea_ramp_solve(state->session->ramp, &balance, symbol, scene->accuracy, &state->rows[line->row + i * line->stride]);
    }
    dea_balance_close(&balance);
    return DEA_OK;
}

static void solve_membrane(visit_state *state, const dea_scene *scene, const dea_line *line)
{
    dea_scene here = *scene;
    dea_point point;
    for (size_t i = 0; i < line->count; i++) {
        dea_row *row = &state->rows[line->row + i * line->stride];
        if (line->axis) {
            dea_axis_set(line->axis, &here, line->axis->values[line->from + i]);
        }
        dea_film_prepare(&here, &point.film);
        dea_point_place(&here, &point);
        *row = dea_row_failed();
        if (dea_point_valid(&point)) {
            dea_shooting_solve(state->session->shooting, &point, scene->accuracy, row);
        }
    }
}

static dea_status solve_line(void *user, const dea_scene *scene, const dea_line *line, dea_error *error)
{
    visit_state *state = user;
    if (state->model->network) {
        return solve_network(state, scene, line, error);
    }
    solve_membrane(state, scene, line);
    return DEA_OK;
}

static dea_status sweep(void *session, const dea_scene *scene, const dea_model *model, size_t first, size_t count, dea_row *rows,
                        dea_error *error)
{
    visit_state state = {session, model, rows};
    return dea_lines_visit(scene, first, count, solve_line, &state, error);
}

typedef struct held_edge {
    dea_shooting *shooting;
    double accuracy;
} held_edge;

static void hold(void *user, const dea_point *point, double displacement, dea_row *row)
{
    const held_edge *held = user;
    dea_shooting_hold(held->shooting, point, displacement, held->accuracy, row);
}

static dea_status force(void *session, const dea_scene *scene, const dea_model *model, const dea_layout *layout, void *point,
                        dea_error *error)
{
    const session_state *state = session;
    held_edge held = {state->shooting, scene->accuracy};
    (void)model, (void)layout;
    return dea_loaded_curve(scene, hold, &held, point, error);
}

static dea_status transient(void *session, const dea_scene *scene, const dea_model *model, dea_sample *samples,
                            dea_summary *summary, dea_error *error)
{
    const session_state *state = session;
    const bool membrane = model->membrane;
    return (membrane ? dea_rings_transient_solve : dea_transient_solve)(&state->sundials, scene, model, samples, summary, error);
}

static void library(char *text, size_t size)
{
    char version[32];
    snprintf(text, size, "SUNDIALS %s", dea_sundials_version(version, sizeof version));
}

const dea_engine dea_engine_ida = {
    .name = "ida",
    .summary = "the network, or the exact membrane, by SUNDIALS IDA",
    .isolated = false,
    .patience = 0.5,
    .run_patience = 300.0,
    .block = 64,
    .omits =
        1u << DEA_PART_MASS | 1u << DEA_PART_BRANCH | 1u << DEA_PART_DAMPER | 1u << DEA_PART_SERIES | 1u << DEA_PART_SOFTENING,
    .profiles = true,
    .costs = {[DEA_STUDY_SWEEP] = {0, 5e-5, 2e-4, 2e-3},
              [DEA_STUDY_FORCE] = {[DEA_FORM_MEMBRANE] = 0.5},
              [DEA_STUDY_TRANSIENT] = {[DEA_FORM_LINEAR] = 1e-2, [DEA_FORM_HYPERELASTIC] = 2e-2, [DEA_FORM_MEMBRANE] = 0.1}},
    .library = library,
    .refuses = refuses,
    .begin = begin,
    .sweep = sweep,
    .transient = transient,
    .solves = {[DEA_STUDY_FORCE] = force},
    .end = end,
};
