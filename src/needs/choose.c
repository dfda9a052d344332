/* The cheapest model that is good enough, for `model: auto`: models are held against the finest one at probes of the study. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "deaspice/needs.h"
#include "engine/line.h"
#include "needs/probes.h"
#include "needs/trial.h"
#include "study/study.h"

static const double safety = 1.5;       /* bound over the largest error of the probes */
static const double trial_share = 0.03; /* of the model error: what a run may be off by that a model is judged by */

enum { VOLTAGES = 4, MOST_MODELS = 16 };

/* Most probes of an axis. */
static size_t most_probes(const dea_scene *scene)
{
    static const size_t many[] = {17, 17, 9, 5};
    return scene->axis_count < 4 ? many[scene->axis_count] : scene->axis_count < 7 ? 3 : 2;
}

/* ---- statics */

static dea_row row_of(const dea_scene *scene, const dea_model *model)
{
    return dea_probe_row(scene, model, 1e-3 * scene->model_error);
}

/* Relative error of the strain; infinite where the states differ. */
static double static_error(const dea_scene *scene, const dea_model *model, const dea_model *truth)
{
    const dea_row row = row_of(scene, model), wanted = row_of(scene, truth);
    if (row.state != wanted.state) {
        return (double)INFINITY;
    }
    if (isnan(wanted.strain) || row.strain == wanted.strain) {
        return 0.0;
    }
    return fabs(row.strain - wanted.strain) / fabs(wanted.strain);
}

/* ---- in time: the static error up to the largest voltage of the run, and where that is small the runs themselves. A film swings
 * with a frequency of its own: a model that is off by a thousandth of it is off by all of the displacement after a few hundred
 * periods, whatever its static error. */

static double largest_error(const dea_scene *scene, const dea_model *model, const dea_model *truth, double largest)
{
    double change = 0.0;
    dea_scene still = *scene;
    for (int i = 1; i <= VOLTAGES; i++) {
        still.drive.voltage = largest * i / VOLTAGES;
        change = fmax(change, static_error(&still, model, truth));
    }
    return change;
}

/* Largest difference of the displacement over the truth's peak, and what both runs may be off by; infinite where the states
 * differ. */
static double swing_error(const dea_trial_run *run, const dea_trial_run *truth, size_t rows)
{
    double change = 0.0, peak = 0.0;
    for (size_t i = 0; i < rows; i++) {
        const dea_sample *a = &run->samples[i], *b = &truth->samples[i];
        if (a->state != b->state) {
            return (double)INFINITY;
        }
        peak = fmax(peak, fabs(b->displacement));
        change = fmax(change, fabs(a->displacement - b->displacement));
    }
    return run->error + truth->error + (change > 0.0 ? change / peak : 0.0);
}

/* Runs one model; false where no engine of this process solves it. */
static bool run_model(const dea_scene *scene, const dea_model *model, dea_trial_run *run, dea_status *status, dea_error *error)
{
    dea_trial trial;
    const dea_reduction all = {.ring = (double)INFINITY};
    *status = dea_trial_open(scene, model, &all, trial_share * scene->model_error, &trial, error);
    bool solved = *status == DEA_OK && trial.engine;
    if (solved) {
        run->samples = malloc(trial.layout.point_size);
        *status = run->samples ? DEA_OK : dea_fail(error, DEA_ERROR_MEMORY, "out of memory while a model is chosen");
        solved = run->samples && dea_trial_fly(&trial, &all, trial.scene.accuracy, run);
    }
    dea_trial_close(&trial);
    return solved;
}

static dea_status trial_error(const dea_scene *scene, const dea_model *model, const dea_model *truth, double *change,
                              dea_error *error)
{
    dea_trial_run run = {0}, wanted = {0};
    dea_status status;
    *change = (double)INFINITY;
    if (run_model(scene, model, &run, &status, error) && run_model(scene, truth, &wanted, &status, error)) {
        *change = swing_error(&run, &wanted, dea_layout_of(scene).rows);
    }
    free(run.samples);
    free(wanted.samples);
    return status;
}

/* A model that statics alone rule out is not run. */
static dea_status moving_error(const dea_scene *scene, const dea_model *model, const dea_model *truth, double enough,
                               double *change, dea_error *error)
{
    dea_signal signal;
    dea_status status = dea_signal_open(scene, &signal, error);
    if (status == DEA_OK) {
        *change = largest_error(scene, model, truth, signal.largest);
    }
    if (status == DEA_OK && safety * *change <= enough) {
        double moving;
        status = trial_error(scene, model, truth, &moving, error);
        *change = fmax(*change, moving);
    }
    dea_signal_close(&signal);
    return status;
}

/* ---- in frequency: the responses themselves */

static double response_error(const dea_response *a, const dea_response *b, size_t count)
{
    double change = 0.0;
    for (size_t i = 0; i < count; i++) {
        const double turns[2] = {a[i].displacement_phase - b[i].displacement_phase, a[i].impedance_phase - b[i].impedance_phase};
        const double here[] = {fabs(a[i].displacement / b[i].displacement - 1.0), fabs(a[i].impedance / b[i].impedance - 1.0),
                               fabs(remainder(turns[0], 360.0)) * DEA_PI / 180.0,
                               fabs(remainder(turns[1], 360.0)) * DEA_PI / 180.0};
        for (size_t k = 0; k < sizeof here / sizeof *here; k++) {
            change = here[k] <= change ? change : (double)fmax(here[k], isnan(here[k]) ? (double)INFINITY : 0.0);
        }
    }
    return change;
}

/* By the first engine that has a frequency domain. */
static dea_status small_error(const dea_scene *scene, const dea_model *model, const dea_model *truth, double *change,
                              dea_error *error)
{
    const size_t rows = dea_layout_of(scene).rows;
    const dea_engine *engine = NULL;
    for (size_t i = 0; i < dea_engine_count() && !engine; i++) {
        const dea_engine *here = dea_engine_at(i);
        engine = here->ac && !here->isolated ? here : NULL;
    }
    dea_response *responses = malloc(2 * rows * sizeof *responses);
    if (!responses || !engine) {
        free(responses);
        return dea_fail(error, DEA_ERROR_MEMORY, "out of memory while a model is chosen");
    }
    void *session = NULL;
    dea_status status = engine->begin(&session, error);
    if (status == DEA_OK) {
        status = engine->ac(session, scene, model, responses, NULL, error);
        status = status == DEA_OK ? engine->ac(session, scene, truth, responses + rows, NULL, error) : status;
        engine->end(session);
    }
    *change = status == DEA_OK ? response_error(responses, responses + rows, rows) : (double)INFINITY;
    free(responses);
    return status;
}

/* ---- the choice */

static dea_status error_at(const dea_scene *here, const dea_model *model, const dea_model *truth, double enough, double *change,
                           dea_error *error)
{
    if (dea_study_of(here)->timed) {
        return moving_error(here, model, truth, enough, change, error);
    }
    if (dea_study_of(here)->phasors) {
        return small_error(here, model, truth, change, error);
    }
    *change = dea_study_of(here)->along ? (double)INFINITY : static_error(here, model, truth);
    return DEA_OK;
}

/* Bound of a model's error over the study; from @p enough on it may be any number that large. A probe whose numbers are out of
 * range says nothing. */
static dea_status bound_of(const dea_scene *scene, const dea_model *model, const dea_model *truth, double enough, double *bound,
                           dea_error *error)
{
    const size_t count = dea_probe_count(scene, most_probes(scene));
    *bound = 0.0;
    for (size_t i = 0; model != truth && i < count && *bound <= enough; i++) {
        double change = 0.0;
        const dea_scene here = dea_probe_scene(scene, most_probes(scene), i);
        const dea_status status = error_at(&here, model, truth, enough, &change, error);
        if (status != DEA_OK && status != DEA_ERROR_USAGE) {
            return status;
        }
        *bound = fmax(*bound, status == DEA_OK ? safety * change : 0.0);
    }
    return DEA_OK;
}

static bool fits(const dea_scene *scene, const dea_engine *engine, const dea_model *model)
{
    const bool kind = (model->lens || scene->actuator.kind == DEA_DOT) && dea_study_takes(dea_study_of(scene), model);
    const bool loaded = scene->load.stiffness > 0.0 || scene->load.mass > 0.0;
    return kind && (model->edge || !loaded) && dea_crew_of(scene, engine, model).count > 0;
}

/* Models that fit, the cheapest first, and of those that cost the same the nearest to the membrane: the last of the table. */
static size_t list_models(const dea_scene *scene, const dea_engine *engine, const dea_model *list[MOST_MODELS])
{
    size_t count = 0;
    for (int form = 0; form < DEA_FORMS; form++) {
        for (size_t i = dea_model_count(); i-- > 0 && count < MOST_MODELS;) {
            const dea_model *model = dea_model_at(i);
            if ((int)dea_model_form(model) == form && fits(scene, engine, model)) {
                list[count++] = model;
            }
        }
    }
    return count;
}

static bool includes(const dea_model *const *list, size_t count, const dea_model *model)
{
    for (size_t i = 0; i < count; i++) {
        if (list[i] == model) {
            return true;
        }
    }
    return false;
}

const dea_model *dea_needs_truth(dea_study_kind study)
{
    const dea_model *truth = NULL;
    for (size_t i = 0; i < dea_model_count(); i++) {
        const dea_model *model = dea_model_at(i);
        const bool finer = !truth || dea_model_form(model) >= dea_model_form(truth);
        const bool costly = dea_study_at(study)->timed && model->membrane; /* a run of it at every probe */
        truth = finer && !costly && dea_study_takes(dea_study_at(study), model) ? model : truth;
    }
    return truth;
}

dea_status dea_needs_model(const dea_scene *scene, const dea_engine *engine, dea_model_choice *choice, dea_error *error)
{
    const dea_model *list[MOST_MODELS];
    const size_t count = list_models(scene, engine, list);
    *choice = (dea_model_choice){.truth = dea_needs_truth(scene->study), .bound = (double)INFINITY};
    /* who cannot do the truth itself is told how good the best of the others is */
    const double wanted = scene->model_error;
    const double enough = includes(list, count, choice->truth) ? wanted : (double)INFINITY;
    for (size_t i = 0; i < count && !choice->model; i++) {
        double bound;
        const dea_status status = bound_of(scene, list[i], choice->truth, enough, &bound, error);
        if (status != DEA_OK) {
            return status;
        }
        if (bound < choice->bound || !choice->next) {
            choice->next = list[i];
            choice->bound = bound;
        }
        if (bound <= wanted) {
            choice->model = list[i];
        }
    }
    return DEA_OK;
}
