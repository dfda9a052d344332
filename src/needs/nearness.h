/* How near a lumped model is to the membrane (`field`), at some probes of a study. */
#ifndef DEA_NEARNESS_H
#define DEA_NEARNESS_H

#include "deaspice/model.h"
#include "deaspice/scene.h"

typedef struct dea_nearness {
    size_t compared;  /* probes at which both models have a strain and it is not 0 */
    size_t unlike;    /* probes at which one of both has pulled in */
    double low, high; /* least and largest relative deviation of the strain from the membrane's [1], over the compared ones */
    double slow, fast; /* least and largest relative deviation of the first resonance from the membrane's [1]; NAN: no swing, or statics */
    double least_peak, largest_peak; /* the same of the first peak behind the first edge, right to 0.5 % [1]; NAN: a run has none, or it is
                                        not cheap */
    bool whole;        /* the probes are all points of the study */
} dea_nearness;

/* Deviation of the model's strain at rest under the drive of the study: of a sweep under its voltage, of a transient under the
 * largest voltage of its waveform, of a frequency response under its bias; of the last two the undamped first resonance at rest and 0 V too, of few runs the first peak. At most some 30 probes, each good to 1e-6, over the
 * axes' ends and places between. DEA_ERROR_MEMORY. */
dea_status dea_nearness_measure(const dea_scene *scene, const dea_model *model, dea_nearness *nearness, dea_error *error);

#endif
