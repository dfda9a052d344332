/** @file measures.h
 * Figures of merit of a transient and of a frequency response, from their samples. Their resolution is that of the samples:
 * between two samples the answer counts as a straight line, so that what happens within one interval is not seen. What is not
 * defined, or needs a sample that has no number, is NAN.
 */
#ifndef DEASPICE_MEASURES_H
#define DEASPICE_MEASURES_H

#include "deaspice/result.h"
#include "deaspice/scene.h"

#ifdef __cplusplus
extern "C" {
#endif

/** The answer of the displacement to one edge of a step. The final value is the last one before the next edge or the end of the
 * run: with a slow creep it is no equilibrium. */
typedef struct dea_edge_answer {
    double time;          /**< where the edge begins [s] */
    bool rising;          /**< the edge `on`, not the edge `off` */
    double change;        /**< final value less the value before the edge [m] */
    double rise_time;     /**< from 10 % to 90 % of the change, each reached for the first time [s] */
    double settling_time; /**< from the edge until the answer stays within 2 % of the change around the final value [s] */
    double overshoot;     /**< largest excess over the final value, relative to the change [1], >= 0 */
} dea_edge_answer;

enum { DEA_EDGES = 2 };

/** What a frequency response tells. */
typedef struct dea_band {
    double resonance; /**< highest peak of the displacement per volt inside the range [Hz] */
    double bandwidth; /**< where it first falls to 1/sqrt(2) of its value at the lowest frequency [Hz] */
} dea_band;

/** Answers to the edges of the scene's step, those of its first period where it repeats; returns how many, 0 for every other
 * waveform. An edge with no sample behind it is left out. All axes of @p scene are at their place. */
DEA_API size_t dea_measure_edges(const dea_scene *scene, const dea_sample *samples, size_t count,
                                 dea_edge_answer edges[DEA_EDGES]);
/** Resonance, by a parabola through the highest peak and its neighbours in logarithms, and bandwidth. */
DEA_API dea_band dea_measure_band(const dea_response *rows, size_t count);

#ifdef __cplusplus
}
#endif
#endif
