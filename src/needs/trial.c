#include "needs/trial.h"

#include <math.h>

static const double loosest = 1e-3; /* accuracy that does for a trial where an engine does not promise what is wanted [1] */

/* Loosens to what the engine promises, from wanted on; false where it can do nothing of it. */
static bool can_do(dea_trial *trial, const dea_engine *engine, const dea_reduction *reduction, double wanted)
{
    dea_scene reduced = trial->scene;
    reduced.reduction = *reduction;
    for (double accuracy = wanted; accuracy <= fmax(wanted, loosest); accuracy *= 10.0) {
        trial->scene.accuracy = reduced.accuracy = accuracy;
        if (!dea_engine_refuses(engine, &trial->scene, trial->model) && !dea_engine_refuses(engine, &reduced, trial->model)) {
            return true;
        }
    }
    return false;
}

static const dea_engine *appoint(dea_trial *trial, const dea_reduction *reduction, double wanted)
{
    for (size_t i = 0; i < dea_engine_count(); i++) {
        const dea_engine *engine = dea_engine_at(i);
        if (!engine->isolated && engine->transient && can_do(trial, engine, reduction, wanted)) {
            return engine;
        }
    }
    return NULL;
}

dea_status dea_trial_open(const dea_scene *scene, const dea_model *model, const dea_reduction *reduction, double accuracy,
                          dea_trial *trial, dea_error *error)
{
    *trial = (dea_trial){.scene = *scene, .model = model};
    trial->scene.reduction = (dea_reduction){.ring = (double)INFINITY};
    trial->scene.transient.points = 0;
    trial->layout = dea_layout_of(&trial->scene);
    trial->engine = appoint(trial, reduction, accuracy);
    dea_status status = dea_signal_open(scene, &trial->signal, error);
    if (status == DEA_OK && trial->engine) {
        status = trial->engine->begin(&trial->session, error);
    }
    return status;
}

void dea_trial_close(dea_trial *trial)
{
    if (trial->session) {
        trial->engine->end(trial->session);
    }
    dea_signal_close(&trial->signal);
}

bool dea_trial_fly(dea_trial *trial, const dea_reduction *reduction, double accuracy, dea_trial_run *run)
{
    dea_error error = {0};
    dea_scene here = trial->scene;
    dea_summary *summary = dea_layout_summary(&trial->layout, run->samples);
    here.reduction = *reduction;
    here.accuracy = accuracy;
    if (trial->engine->transient(trial->session, &here, trial->model, run->samples, summary, &error) != DEA_OK) {
        return false;
    }
    run->error = summary->error;
    for (run->end = 0; run->end < trial->layout.rows && !isnan(run->samples[run->end].displacement); run->end++) {
    }
    return run->end == trial->layout.rows || run->samples[run->end].state != DEA_STATE_FAILED;
}
