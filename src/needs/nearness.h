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

/* ---- The first peak of a film behind the first edge of its voltage, by few steps and without a library: how far a model is from the
 * membrane once both swing. */

/* Peak of a model's displacement over that of the membrane, less 1 [1], right to 0.5 %. NAN where there is none, or it is not cheap: without
 * a voltage that rises along one line from 0 and stands for the first period of the swing, a swing or rest at the begin; with a skin, a load,
 * steep waves, stiff dampers, or an end in between. All axes of @p scene are at their place.
 * @param[in,out] steps that may be taken, some 4 us each; those that were taken are subtracted */
double dea_first_peak_deviation(const dea_scene *scene, const dea_model *model, const dea_model *truth, int *steps);

/* ---- Probes of a study: places spread evenly over every axis, its ends included. */

/* Probes where every axis has at most @p most of them. */
size_t dea_probe_count(const dea_scene *scene, size_t most);
/* The scene at probe number @p probe; shares what the scene owns. */
dea_scene dea_probe_scene(const dea_scene *scene, size_t most, size_t probe);
/* The model's own static answer there. */
dea_row dea_probe_row(const dea_scene *scene, const dea_model *model, double accuracy);
/* What a model's error of a strain is told relative to: the strain, or with its sign that of a film at rest that something else than
 * its voltage pulls, if that is larger. */
double dea_probe_scale(const dea_scene *scene, const dea_model *truth, double accuracy, double strain);

#endif
