/* Runs of a transient in this process, by the first engine of the table that can do them: what a cheaper model, or a film without
 * some of its parts, is held against. */
#ifndef DEA_TRIAL_H
#define DEA_TRIAL_H

#include "deaspice/engine.h"
#include "deaspice/scene.h"
#include "drive/signal.h"

typedef struct dea_trial {
    dea_scene scene; /* borrows what the scene owns; all axes at their place */
    const dea_model *model;
    const dea_engine *engine; /* NULL: none can do it */
    void *session;            /* owned */
    dea_layout layout;
    dea_signal signal; /* owned */
} dea_trial;

/* One run. */
typedef struct dea_trial_run {
    dea_sample *samples; /* owned by who made the room: layout.point_size bytes */
    double error;        /* of the displacement over its peak, as the engine tells [1] */
    size_t end;          /* samples with numbers: all, or those before the film pulled in */
} dea_trial_run;

/* Appoints the engine for runs of the scene with and without @p reduction, at that accuracy or at the tightest above it that it
 * promises; the scene's accuracy becomes that. trial->engine is NULL where there is none. The caller ends it with
 * dea_trial_close(), also after a failure. */
dea_status dea_trial_open(const dea_scene *scene, const dea_model *model, const dea_reduction *reduction, double accuracy,
                          dea_trial *trial, dea_error *error);
void dea_trial_close(dea_trial *trial);
/* Runs; false where the engine does not solve every sample. */
bool dea_trial_fly(dea_trial *trial, const dea_reduction *reduction, double accuracy, dea_trial_run *run);

#endif
