/** @file measures.h
 * Figures of merit of a transient and of a frequency response, from their samples. What is not defined, not reached, or needs a
 * sample that has no number, is NAN; a time that samples are too coarse for is an interval.
 */
#ifndef DEASPICE_MEASURES_H
#define DEASPICE_MEASURES_H

#include "deaspice/result.h"
#include "deaspice/scene.h"

#ifdef __cplusplus
extern "C" {
#endif

/** Where a time lies: early == late where it is known. */
typedef struct dea_interval {
    double early, late; /**< [s] */
} dea_interval;

/** An edge of the voltage and the plateau behind it. */
typedef struct dea_step_edge {
    double from, to; /**< begin of the edge, end of the plateau [s] */
    double rise;     /**< how long the edge takes [s] */
    double final;    /**< displacement that the film relaxes to under the new voltage [m] */
    double omega;    /**< of a swing that the samples show [rad/s], 0: there is none */
    double error;    /**< of the displacement, relative to the change [1], < 0.02 */
    bool rising;     /**< the edge `on`, not the edge `off` */
} dea_step_edge;

/** The answer of the displacement to an edge. It rests on the samples and their velocities, a cubic between two of them, and on
 * the static displacement under the new voltage as the final value, which a creeping film may not reach within the run. */
typedef struct dea_edge_answer {
    double time;           /**< where the edge begins [s] */
    bool rising;           /**< the edge `on`, not the edge `off` */
    bool reached;          /**< the displacement comes within 2 % of the change of the final value */
    bool settled;          /**< and at the end stays there: what still swings is smaller */
    double change;         /**< final value less the value at the edge [m] */
    double overshoot;      /**< largest excess over the final value, relative to the change [1], >= 0; NAN: not reached */
    dea_interval rise;     /**< from 10 % to 90 % of the change, each reached for the first time; NAN: not reached */
    dea_interval settling; /**< from the edge until it stays within 2 % of the change around the final value; NAN: not settled */
} dea_edge_answer;

/** Samples of a swing that show it. */
enum { DEA_SAMPLES_A_SWING = 20 };
enum { DEA_EDGES = 2 };

/** Magnitudes of the displacement per volt at @p count >= 2 frequencies evenly from @p from to @p to [Hz]; false: none. */
typedef bool dea_magnitudes(void *user, double from, double to, size_t count, double *magnitudes);

/** Harmonics of a sine that are told. */
enum { DEA_HARMONICS = 5 };

/** What a window of a transient holds, of the displacement: within ten times the accuracy of its peak over the run. NAN where the
 * samples are too coarse for that or for the drive, or have no number. */
typedef struct dea_window_figures {
    double least, largest, range; /**< range: from peak to peak [m] */
    /** Of a drive that is a sine, over the whole periods from the begin of the window on: u = mean + sum A_k sin(k theta + phi_k),
     * theta = 2 pi f (t - delay) + phase the argument of the drive's sine; a phase is NAN where its amplitude is no more than the
     * error may be. A_1 first, the fundamental [m], [degree]. */
    double amplitude[DEA_HARMONICS], phase[DEA_HARMONICS];
} dea_window_figures;

/** Columns of dea_window_figures, those of harmonics only where the drive is a sine; @p count gets how many. */
DEA_API const dea_column *dea_window_columns(const dea_scene *scene, size_t *count);
/** Figures of window number @p window; all axes of @p scene are at their place. */
DEA_API dea_window_figures dea_measure_window(const dea_scene *scene, const dea_sample *samples, size_t count,
                                              const dea_summary *summary, size_t window);
/** The answer to one edge; false where no sample lies behind it. */
DEA_API bool dea_measure_edge(const dea_sample *samples, size_t count, const dea_step_edge *edge, dea_edge_answer *answer);
/** Answers to the edges of the scene's step, those of its first period where it repeats; returns how many, 0 for every other
 * waveform. An edge with no sample behind it is left out. All axes of @p scene are at their place, its first model is the run's.
 */
DEA_API size_t dea_measure_edges(const dea_scene *scene, const dea_sample *samples, size_t count, const dea_summary *summary,
                                 dea_edge_answer answers[DEA_EDGES]);
/** Longest interval of the samples that see the swing behind a step [s]. */
DEA_API double dea_measure_interval(const dea_scene *scene, const dea_summary *summary);
/** True where the film swings and a sample behind an edge can still see that. */
DEA_API bool dea_measure_lives(const dea_scene *scene, const dea_summary *summary);
/** True where the film swings and its samples show how: DEA_SAMPLES_A_SWING of them or more. */
DEA_API bool dea_measure_shows(const dea_scene *scene, const dea_summary *summary);
/** Resonance and bandwidth: found among the rows, then between them by asking for more and more frequencies there. Where nobody
 * answers (@p ask NULL), as far as the rows tell: by a parabola through the highest peak and its neighbours in logarithms, and by
 * a straight line in logarithms. */
DEA_API dea_band dea_measure_band(const dea_response *rows, size_t count, dea_magnitudes *ask, void *user);

#ifdef __cplusplus
}
#endif
#endif
