/* The cheapest model that is good enough, for `model: auto`: models are held against the finest one at probes of the study. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "deaspice/needs.h"
#include "needs/nearness.h"
#include "needs/trial.h"
#include "study/study.h"

static const double safety = 1.5;       /* bound over the largest error of the probes */
static const double still_share = 1e-3; /* of the model error: accuracy of answers at rest and in frequency */
static const double coarsest = 0.1;     /* accuracy of the first runs that a model is judged by, or the model error [1] */
static const double fine_share = 0.03;  /* of that: accuracy of the second ones */

enum { VOLTAGES = 4, MOST_MODELS = 16 };

enum { COARSE, FINE, RUNGS }; /* runs of a trial */

/* Most probes of an axis. */
static size_t most_probes(const dea_scene *scene)
{
    static const size_t many[] = {17, 17, 9, 5};
    return scene->axis_count < 4 ? many[scene->axis_count] : scene->axis_count < 7 ? 3 : 2;
}

/* ---- statics */

static dea_row row_of(const dea_scene *scene, const dea_model *model)
{
    return dea_probe_row(scene, model, still_share * scene->model_error);
}

/* Error of the strain relative to dea_probe_scale(); infinite where the states differ. */
static double static_error(const dea_scene *scene, const dea_model *model, const dea_model *truth)
{
    const dea_row row = row_of(scene, model), wanted = row_of(scene, truth);
    if (row.state != wanted.state) {
        return (double)INFINITY;
    }
    if (isnan(wanted.strain) || row.strain == wanted.strain) {
        return 0.0;
    }
    return fabs((row.strain - wanted.strain) / dea_probe_scale(scene, truth, still_share * scene->model_error, wanted.strain));
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

/* What the truth answers at a probe, found once for all models that are held against it. */
typedef struct standard {
    const dea_scene *scene; /* borrowed; all axes at their place */
    const dea_model *truth;
    dea_trial_run runs[RUNGS]; /* owned samples: in time, coarse and fine */
    bool flown[RUNGS];
    bool unsolved;         /* no engine of this process solved the truth */
    dea_response *responses; /* owned, in frequency */
} standard;

static void standard_close(standard *s)
{
    for (int i = 0; i < RUNGS; i++) {
        free(s->runs[i].samples);
    }
    free(s->responses);
}

/* Runs one model; *solved false where no engine of this process does. */
static dea_status run_model(const dea_scene *scene, const dea_model *model, int rung, dea_trial_run *run, bool *solved,
                            dea_error *error)
{
    dea_trial trial;
    const dea_reduction all = {.ring = (double)INFINITY};
    const double coarse = fmin(scene->model_error, coarsest);
    dea_status status = dea_trial_open(scene, model, &all, rung == COARSE ? coarse : fine_share * coarse, &trial, error);
    *solved = status == DEA_OK && trial.engine;
    if (*solved) {
        run->samples = malloc(trial.layout.point_size);
        status = run->samples ? DEA_OK : dea_fail(error, DEA_ERROR_MEMORY, "out of memory while a model is chosen");
        *solved = run->samples && dea_trial_fly(&trial, &all, trial.scene.accuracy, run);
    }
    dea_trial_close(&trial);
    return status;
}

/* Largest difference of the displacement, and what both runs may be off by, over the truth's peak. */
typedef struct gap {
    double change, doubt; /* infinite where the states differ; where one of the runs was not solved */
} gap;

static gap gap_of(const dea_trial_run *run, const dea_trial_run *truth, size_t rows)
{
    double change = 0.0, peak = 0.0;
    for (size_t i = 0; i < rows; i++) {
        const dea_sample *a = &run->samples[i], *b = &truth->samples[i];
        if (a->state != b->state) {
            return (gap){.change = (double)INFINITY};
        }
        peak = fmax(peak, fabs(b->displacement));
        change = fmax(change, fabs(a->displacement - b->displacement));
    }
    return (gap){change > 0.0 ? change / peak : 0.0, run->error + truth->error};
}

static dea_status trial_gap(standard *s, const dea_model *model, int rung, gap *apart, dea_error *error)
{
    dea_status status = DEA_OK;
    *apart = (gap){.doubt = (double)INFINITY};
    if (!s->flown[rung] && !s->unsolved) {
        bool solved;
        status = run_model(s->scene, s->truth, rung, &s->runs[rung], &solved, error);
        s->flown[rung] = status == DEA_OK;
        s->unsolved = !solved;
    }
    if (status == DEA_OK && !s->unsolved) {
        dea_trial_run run = {0};
        bool solved;
        status = run_model(s->scene, model, rung, &run, &solved, error);
        *apart = solved ? gap_of(&run, &s->runs[rung], dea_layout_of(s->scene).rows) : *apart;
        free(run.samples);
    }
    return status;
}

/* Coarse runs rule most models out: fine ones of the membrane cost ten times that. */
static dea_status trial_error(standard *s, const dea_model *model, double enough, double *change, dea_error *error)
{
    gap apart;
    dea_status status = trial_gap(s, model, COARSE, &apart, error);
    if (status == DEA_OK && isfinite(apart.doubt) && !(safety * (apart.change - apart.doubt) > enough)) {
        status = trial_gap(s, model, FINE, &apart, error);
    }
    *change = apart.change + apart.doubt;
    return status;
}

/* A model that statics alone rule out is not run. */
static dea_status moving_error(standard *s, const dea_model *model, double enough, double *change, dea_error *error)
{
    dea_signal signal;
    dea_status status = dea_signal_open(s->scene, &signal, error);
    if (status == DEA_OK) {
        *change = largest_error(s->scene, model, s->truth, signal.largest);
    }
    if (status == DEA_OK && safety * *change <= enough) {
        double moving;
        status = trial_error(s, model, enough, &moving, error);
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
        if (a[i].state != b[i].state) {
            return (double)INFINITY;
        }
        const double here[] = {fabs(a[i].displacement / b[i].displacement - 1.0), fabs(a[i].impedance / b[i].impedance - 1.0),
                               fabs(remainder(turns[0], 360.0)) * DEA_PI / 180.0,
                               fabs(remainder(turns[1], 360.0)) * DEA_PI / 180.0};
        for (size_t k = 0; k < sizeof here / sizeof *here; k++) {
            change = here[k] <= change ? change : (double)fmax(here[k], isnan(here[k]) ? (double)INFINITY : 0.0);
        }
    }
    return change;
}

/* Responses of a model, by the first engine that has a frequency domain; the caller frees them. */
static dea_status respond(const dea_scene *scene, const dea_model *model, dea_response **responses, dea_error *error)
{
    const dea_engine *engine = NULL;
    dea_scene here = *scene; /* borrows what the scene owns */
    here.accuracy = still_share * scene->model_error;
    for (size_t i = 0; i < dea_engine_count() && !engine; i++) {
        engine = dea_engine_at(i)->ac && !dea_engine_at(i)->isolated ? dea_engine_at(i) : NULL;
    }
    *responses = malloc(dea_layout_of(scene).rows * sizeof **responses);
    if (!*responses || !engine) {
        return dea_fail(error, DEA_ERROR_MEMORY, "out of memory while a model is chosen");
    }
    void *session = NULL;
    dea_status status = engine->begin(&session, error);
    if (status == DEA_OK) {
        status = engine->ac(session, &here, model, *responses, NULL, error);
        engine->end(session);
    }
    return status;
}

static dea_status small_error(standard *s, const dea_model *model, double *change, dea_error *error)
{
    dea_response *responses = NULL;
    dea_status status = s->responses ? DEA_OK : respond(s->scene, s->truth, &s->responses, error);
    if (status == DEA_OK) {
        status = respond(s->scene, model, &responses, error);
    }
    *change = status == DEA_OK ? response_error(responses, s->responses, dea_layout_of(s->scene).rows) : (double)INFINITY;
    free(responses);
    return status;
}

/* ---- the choice */

static dea_status error_at(standard *s, const dea_model *model, double enough, double *change, dea_error *error)
{
    const dea_study *study = dea_study_of(s->scene);
    if (study->timed) {
        return moving_error(s, model, enough, change, error);
    }
    if (study->phasors) {
        return small_error(s, model, change, error);
    }
    *change = study->along ? (double)INFINITY : static_error(s->scene, model, s->truth);
    return DEA_OK;
}

/* A model that may be chosen; bound of its error over the probes so far, which from what is enough on may be any number that
 * large. */
typedef struct candidate {
    const dea_model *model;
    double bound;
} candidate;

/* Raises the bounds by the errors at one probe. A probe whose numbers are out of range says nothing. */
static dea_status probe(standard *s, candidate *list, size_t count, double enough, dea_error *error)
{
    for (size_t i = 0; i < count; i++) {
        double change = 0.0;
        if (list[i].model == s->truth || list[i].bound > enough) {
            continue;
        }
        const dea_status status = error_at(s, list[i].model, enough, &change, error);
        if (status != DEA_OK && status != DEA_ERROR_USAGE) {
            return status;
        }
        list[i].bound = fmax(list[i].bound, status == DEA_OK ? safety * change : 0.0);
    }
    return DEA_OK;
}

static bool fits(const dea_scene *scene, const dea_engine *engine, const dea_model *model)
{
    const bool kind = (model->lens || scene->actuator.kind == DEA_DOT) && dea_study_takes(dea_study_of(scene), model);
    return kind && dea_crew_of(scene, engine, model).count > 0;
}

/* Models that fit, the cheapest first, and of those that cost the same the nearest to the membrane: the last of the table. */
static size_t list_models(const dea_scene *scene, const dea_engine *engine, candidate list[MOST_MODELS])
{
    size_t count = 0;
    for (int form = 0; form < DEA_FORMS; form++) {
        for (size_t i = dea_model_count(); i-- > 0 && count < MOST_MODELS;) {
            const dea_model *model = dea_model_at(i);
            if ((int)dea_model_form(model) == form && fits(scene, engine, model)) {
                list[count++] = (candidate){.model = model};
            }
        }
    }
    return count;
}

static bool includes(const candidate *list, size_t count, const dea_model *model)
{
    for (size_t i = 0; i < count; i++) {
        if (list[i].model == model) {
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
        truth = finer && dea_study_takes(dea_study_at(study), model) ? model : truth;
    }
    return truth;
}

static void choose(const candidate *list, size_t count, double wanted, dea_model_choice *choice)
{
    for (size_t i = 0; i < count && !choice->model; i++) {
        if (list[i].bound < choice->bound || !choice->next) {
            choice->next = list[i].model;
            choice->bound = list[i].bound;
        }
        if (list[i].bound <= wanted) {
            choice->model = list[i].model;
        }
    }
}

/* Finest of the models but @p truth, NULL: there is none. */
static const dea_model *next_finest(const candidate *list, size_t count, const dea_model *truth)
{
    const dea_model *finest = NULL;
    for (size_t i = 0; i < count; i++) {
        const bool finer = !finest || dea_model_form(list[i].model) > dea_model_form(finest);
        finest = finer && list[i].model != truth ? list[i].model : finest;
    }
    return finest;
}

static dea_status hold_against(const dea_scene *scene, const dea_model *truth, candidate *list, size_t count,
                               dea_model_choice *choice, dea_error *error)
{
    const size_t probes = dea_probe_count(scene, most_probes(scene));
    *choice = (dea_model_choice){.truth = truth, .bound = (double)INFINITY};
    /* who cannot do the truth itself is told how good the best of the others is */
    const double wanted = scene->model_error;
    const double enough = includes(list, count, truth) ? wanted : (double)INFINITY;
    dea_status status = DEA_OK;
    for (size_t i = 0; i < probes && status == DEA_OK; i++) {
        const dea_scene here = dea_probe_scene(scene, most_probes(scene), i);
        standard s = {.scene = &here, .truth = truth};
        status = probe(&s, list, count, enough, error);
        choice->unsolved = choice->unsolved || s.unsolved;
        standard_close(&s);
    }
    choose(list, count, wanted, choice);
    return status;
}

dea_status dea_needs_model(const dea_scene *scene, const dea_engine *engine, dea_model_choice *choice, dea_error *error)
{
    candidate list[MOST_MODELS];
    const dea_model *truth = dea_needs_truth(scene->study);
    size_t count = list_models(scene, engine, list);
    dea_status status = hold_against(scene, truth, list, count, choice, error);
    const dea_model *next = next_finest(list, count, truth);
    if (status == DEA_OK && choice->unsolved && choice->model == truth && next) {
        /* without the truth the finest of the others is held to be it */
        count = list_models(scene, engine, list);
        for (size_t i = 0; i < count; i++) {
            list[i].bound = list[i].model == truth ? (double)INFINITY : 0.0;
        }
        status = hold_against(scene, next, list, count, choice, error);
        choice->unsolved = true;
    }
    return status;
}
