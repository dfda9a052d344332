/** @file findings.h
 * What a run tells besides its result: averages as they come, and a summary at its end.
 */
#ifndef DEA_PROGRAM_FINDINGS_H
#define DEA_PROGRAM_FINDINGS_H

#include <stdio.h>

#include "deaspice/engine.h"
#include "deaspice/measures.h"
#include "program/answer.h"
#include "deaspice/result.h"
#include "deaspice/scene.h"

/* ---- Whether a run stretches its film beyond what the data of its material cover. */

/* The least and the largest stretch so far; zeroed: none. */
typedef struct dea_covered {
    double least, most;       /* [1] */
    size_t outside, at_worst; /* points outside of the data, and the one that is furthest */
    double worst;             /* how far that is [1] */
} dea_covered;

/* Takes point number @p number of the study; nothing where the material has no range. */
void dea_covered_take(dea_covered *covered, const dea_scene *scene, const dea_layout *layout, size_t number, const void *point);
/* One line on standard error where a point lies outside. */
void dea_covered_warn(const dea_covered *covered, const dea_scene *scene);

typedef struct dea_findings {
    const dea_scene *scene;
    dea_layout layout;
    FILE *averages;                 /**< where they are printed, NULL: nowhere */
    bool alone;                     /**< models are not held against the membrane */
    size_t points;                  /**< taken so far */
    struct {
        const dea_engine *engine; /**< NULL: none further */
        size_t count;             /**< points */
    } instead[DEA_ENGINES];       /**< who has solved what the first engine did not */
    size_t states[DEA_STATE_COUNT]; /**< rows in each state */
    double error, residual;         /**< the worst of all transients, NAN: none known */
    double velocity_error, current_error; /**< likewise */
    size_t reduced;                 /**< transients that leave something out */
    double omitted;                 /**< largest bound of what they leave out [1] */
    size_t pulled;                  /**< runs that pull in */
    double pull_in;                 /**< earliest time of that [s] */
    double resonance[2];            /**< lowest and highest of all frequency responses [Hz], NAN: none */
    dea_summary summary;            /**< of the last transient, as the edges */
    dea_edge_answer edges[DEA_EDGES];
    size_t edge_count;
    dea_answer answers[DEA_SCENE_MODELS]; /**< of each model */
    dea_covered covered; /**< of stretches, against the data of the material */
    dea_band band; /**< of the last frequency response */
    dea_weakest weakest; /**< of the last profile, or of all samples of the last transient */
    double weakest_times[2]; /**< in time, of the largest field and of the least tension [s] */
} dea_findings;

/** Findings of a study that has not begun; prints the head of the averages. The scene and the stream must outlive them. */
dea_findings dea_findings_begin(const dea_scene *scene, FILE *averages);
/** Takes points as a run hands them over; prints their averages. */
void dea_findings_take(dea_findings *findings, size_t first, const void *points, size_t count);
/** Takes that an engine solved so many points which the first one did not. */
void dea_findings_instead(dea_findings *findings, const dea_engine *engine, size_t count);
/** Prints the summary of the run on standard error. */
void dea_findings_print(const dea_findings *findings, double seconds);

#endif
