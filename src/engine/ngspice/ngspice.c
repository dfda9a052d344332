/* Engine `ngspice`: the network in libngspice; the exact membrane as a network of rings (still.c). A line of points is one circuit and one DC sweep over the index of the points;
 * each answer is then checked against the network (force balance, no fold between rest and it). What does not pass is solved
 * again alone, with the load growing from rest. */
#include <math.h>
#include <stdlib.h>

#include "engine/engines.h"
#include "scene/line.h"
#include "engine/ngspice/library.h"
#include "engine/ngspice/moving.h"
#include "engine/ngspice/stretch.h"
#include "netlist/netlist.h"
#include "network/balance.h"
#include "network/membrane.h"
#include "study/study.h"

enum {
    RAMP_STEPS = 50,
    RAMP_REFINED = 16,
    RAMP_STEPS_MOST = RAMP_STEPS * RAMP_REFINED * RAMP_REFINED,
    LONGEST_SWEEP = 100000
};

typedef struct visit_state {
    dea_ngspice *library;
    const dea_model *model;
    dea_row *rows;
} visit_state;

/* One line with its network. */
typedef struct line_job {
    visit_state *state;
    const dea_scene *scene; /* axes at the first point */
    const dea_line *line;
    dea_network network;
    dea_balance balance;
} line_job;

static const char *refuses(const dea_scene *scene, const dea_model *model)
{
    if (!model->network && !model->membrane) {
        return "it has no network form that ngspice could solve";
    }
    const bool still = !dea_study_of(scene)->along || dea_study_of(scene)->still;
    if (model->membrane && !still && scene->antagonist.there) {
        return "its moving membrane has no second film";
    }
    if (model->membrane && still && scene->antagonist.there) {
        return "its membrane at rest has no second film";
    }
    if (model->membrane && dea_study_of(scene)->holds) {
        return "it does not hold the edge of the membrane";
    }
    if (model->membrane && dea_study_of(scene)->timed && dea_load_stalls(scene)) {
        return dea_load_stalled;
    }
    if (dea_study_of(scene)->timed && scene->accuracy < 1e-6) {
        return "its trapezoidal rule is good to 1e-6 in a transient, the scene wants more";
    }
    if (dea_study_of(scene)->along && model->membrane && scene->electrode.sheet_resistance > 0.0) {
        return "its rings have one potential, not one along a sheet resistance";
    }
    return scene->accuracy < 1e-9 ? "its answers are good to 1e-9, the scene wants more" : NULL;
}

static dea_status begin(void **session, dea_error *error)
{
    dea_ngspice *library;
    const dea_status status = dea_ngspice_open(&library, error);
    *session = library;
    return status;
}

static void end(void *session)
{
    dea_ngspice_close(session);
}

static double symbol_at(const line_job *job, size_t i)
{
    return job->line->axis ? job->line->axis->values[job->line->from + i] : 0.0;
}

static dea_row *row_at(const line_job *job, size_t i)
{
    return &job->state->rows[job->line->row + i * job->line->stride];
}

/* Tolerance, and the sizes of force and displacement that go with it: what a stretch by its own size would take. */
static void set_scales(line_job *job, size_t i, dea_netlist_study *study)
{
    const dea_actuator *actuator = &job->scene->actuator;
    const dea_forces f = dea_balance_forces(&job->balance, symbol_at(job, i), 0.0);
    study->tolerance = fmin(1e-8, 0.1 * job->scene->accuracy);
    study->length_scale = actuator->frame_radius;
    study->force_scale = fabs(f.elastic_slope) * actuator->frame_radius;
}

/* Fills the row of point i where u is its answer to a tenth of the wanted accuracy. */
static bool accept(line_job *job, size_t i, double u)
{
    return dea_balance_accept(&job->balance, symbol_at(job, i), u, 0.1 * job->scene->accuracy, row_at(job, i));
}

/* Solves the network of one point with its load growing from rest in so many steps; *accepted says whether its answer passes. */
static dea_status climb(line_job *job, size_t i, const dea_scene *here, size_t steps, bool *accepted, dea_error *error)
{
    char *netlist = NULL;
    const char *const edge = "edge";
    dea_ngspice_table table = {0};
    dea_netlist_study study = {.scene = here, .model = job->state->model, .ramp = steps};
    set_scales(job, i, &study);
    dea_status status = dea_netlist_write(&study, &netlist, error);
    if (status == DEA_OK) {
        status = dea_ngspice_run_all(job->state->library, netlist, &edge, 1, &table, error);
    }
    *accepted = status == DEA_OK && table.count == steps + 1 && accept(job, i, table.columns[0][steps]);
    dea_ngspice_table_free(&table);
    free(netlist);
    return status;
}

/* Solves one point alone, its load growing from rest; where a step of it takes Newton's iteration past the film's end or to
 * another equilibrium, in finer ones. */
static dea_status solve_alone(void *user, size_t i, dea_error *error)
{
    line_job *job = user;
    double share, fold;
    const double symbol = symbol_at(job, i);
    *row_at(job, i) = dea_row_failed();
    if (!dea_balance_valid(&job->balance, symbol)) {
        return DEA_OK;
    }
    if (!job->balance.steady && dea_balance_forces(&job->balance, symbol, 0.0).load == 0.0 && accept(job, i, 0.0)) {
        return DEA_OK;
    }
    if (dea_balance_folds(&job->balance, symbol, &share, &fold)) {
        row_at(job, i)->state = DEA_STATE_PULL_IN;
        return DEA_OK;
    }
    dea_scene here = *job->scene;
    if (job->line->axis) {
        dea_axis_set(job->line->axis, &here, symbol);
    }
    bool accepted = false;
    dea_status status = DEA_OK;
    for (size_t steps = RAMP_STEPS; status == DEA_OK && !accepted && steps <= RAMP_STEPS_MOST; steps *= RAMP_REFINED) {
        status = climb(job, i, &here, steps, &accepted, error);
    }
    return status;
}

/* One circuit for count points from number @p from of the line on. */
static dea_status sweep_circuit(line_job *job, size_t from, size_t count, dea_ngspice_table *table, dea_error *error)
{
    const char *const edge = "edge";
    char *netlist;
    dea_netlist_study study = {.scene = job->scene,
                               .model = job->state->model,
                               .axis = job->line->axis,
                               .from = job->line->from + from,
                               .count = count};
    set_scales(job, from, &study);
    dea_status status = dea_netlist_write(&study, &netlist, error);
    if (status == DEA_OK) {
        status = dea_ngspice_run_all(job->state->library, netlist, &edge, 1, table, error);
        free(netlist);
    }
    return status;
}

static bool can_start(void *user, size_t i)
{
    line_job *job = user;
    double share, fold;
    const double symbol = symbol_at(job, i);
    const bool moves = job->balance.steady || dea_balance_forces(&job->balance, symbol, 0.0).load != 0.0;
    return dea_balance_valid(&job->balance, symbol) && moves && !dea_balance_folds(&job->balance, symbol, &share, &fold);
}

static dea_status sweep_stretch(void *user, size_t from, size_t count, size_t *good, dea_error *error)
{
    line_job *job = user;
    dea_ngspice_table table = {0};
    *good = 0;
    const dea_status status = sweep_circuit(job, from, count, &table, error);
    while (*good < table.count && accept(job, from + *good, table.columns[0][*good])) {
        ++*good;
    }
    dea_ngspice_table_free(&table);
    return status;
}

static dea_status solve_points(line_job *job, dea_error *error)
{
    const dea_axis *axis = job->line->axis;
    const dea_stretch stretch = {.user = job,
                                 .count = job->line->count,
                                 .longest = axis && !axis->uniform ? DEA_NETLIST_LIST : LONGEST_SWEEP,
                                 .can_start = can_start,
                                 .sweep = sweep_stretch,
                                 .alone = solve_alone};
    return dea_stretch_solve(&stretch, error);
}

static dea_status solve_line(void *user, const dea_scene *scene, const dea_line *line, dea_error *error)
{
    line_job job = {.state = user, .scene = scene, .line = line};
    if (job.state->model->membrane) {
        return dea_ngspice_still(job.state->library, scene, job.state->model, line, job.state->rows, error);
    }
    dea_status status = dea_network_build(scene, job.state->model, line->axis, &job.network, error);
    if (status == DEA_OK) {
        status = dea_balance_open(&job.network, &job.balance, error);
    }
    if (status == DEA_OK) {
        status = solve_points(&job, error);
        dea_balance_close(&job.balance);
    }
    dea_network_free(&job.network);
    return status;
}

static dea_status sweep(void *session, const dea_scene *scene, const dea_model *model, size_t first, size_t count, dea_row *rows,
                        dea_error *error)
{
    visit_state state = {session, model, rows};
    return dea_lines_visit(scene, first, count, solve_line, &state, error);
}

static dea_status transient(void *session, const dea_scene *scene, const dea_model *model, dea_sample *samples,
                            dea_summary *summary, dea_error *error)
{
    return dea_ngspice_transient(session, scene, model, samples, summary, error);
}

static dea_status ac(void *session, const dea_scene *scene, const dea_model *model, dea_response *rows, dea_band *band,
                     dea_error *error)
{
    return (model->membrane ? dea_ngspice_ac_rings : dea_ngspice_ac)(session, scene, model, rows, band, error);
}

const dea_engine dea_engine_ngspice = {
    .name = "ngspice",
    .summary = "the network in libngspice, in worker processes",
    .isolated = true,
    .patience = 0.004,
    .run_patience = 120.0,
    .block = 5000,
    .omits = ~0u,
    .costs = {[DEA_STUDY_SWEEP] = {0, 4e-6, 1e-5, 1e-4},
              [DEA_STUDY_TRANSIENT] = {[DEA_FORM_LINEAR] = 0.1, [DEA_FORM_HYPERELASTIC] = 0.2, [DEA_FORM_MEMBRANE] = 4.0},
              [DEA_STUDY_FORCE] = {[DEA_FORM_LINEAR] = 1e-2, [DEA_FORM_HYPERELASTIC] = 1e-2},
              [DEA_STUDY_AC] = {[DEA_FORM_LINEAR] = 1e-2, [DEA_FORM_HYPERELASTIC] = 1e-2, [DEA_FORM_MEMBRANE] = 0.1}},
    .library = dea_ngspice_name,
    .refuses = refuses,
    .begin = begin,
    .sweep = sweep,
    .transient = transient,
    .ac = ac,
    .solves = {[DEA_STUDY_FORCE] = dea_ngspice_force},
    .end = end,
};
