/** @file bench.h
 * Work against precision: what each setting of each engine costs on a scene, how large its error really is, and how far each
 * model is from the exact membrane.
 */
#ifndef DEASPICE_BENCH_H
#define DEASPICE_BENCH_H

#include "deaspice/engine.h"
#include "deaspice/plot.h"

#ifdef __cplusplus
extern "C" {
#endif

enum { DEA_BENCH_REASON = 256 };

/** What became of a setting. */
typedef enum dea_bench_state {
    DEA_BENCH_MEASURED,
    DEA_BENCH_REFUSED, /**< the engine cannot do this model and study at any accuracy */
    DEA_BENCH_SKIPPED, /**< would take more time than is left */
    DEA_BENCH_FAILED   /**< the run ended with an error */
} dea_bench_state;

/** One setting of one engine on one model: an accuracy, or several that give the very same numbers. */
typedef struct dea_bench_setting {
    size_t model;             /**< number of its dea_bench_model */
    const dea_engine *engine; /**< never NULL */
    double loosest, accuracy; /**< wanted relative error from the loosest to the tightest [1]; NAN where refused */
    bool any;                 /**< every accuracy that the engine takes gives these very numbers */
    dea_bench_state state;
    char reason[DEA_BENCH_REASON]; /**< why it was not measured, else empty */
    /* Where measured: */
    size_t runs;           /**< timed runs, >= 1 */
    double seconds;        /**< median wall time of a run, start of the engine included [s] */
    double fastest, lower; /**< shortest time, lower quartile [s] */
    double upper, slowest; /**< upper quartile, longest time [s] */
    double start;          /**< start of the engine, its worker process included, out of this time [s] */
    double error;          /**< largest difference to the model's reference, as `deaspice check` counts it [1] */
    bool reference;        /**< its numbers are the reference's own, bit for bit: the error is not known */
    size_t states;         /**< rows whose state is not the reference's */
    size_t failed;         /**< rows that were not solved */
    bool broken;           /**< error above accuracy (plus that of an inexact reference), or another state */
    bool dominated;        /**< another setting of the model is at least as fast and as accurate, and better in one of both */
} dea_bench_setting;

/** One model: what its settings are judged by, and its own error. */
typedef struct dea_bench_model {
    const dea_model *model;
    const dea_engine *reference;      /**< engine of the reference, NULL: none could be run */
    double reference_accuracy;        /**< [1] */
    bool exact;                       /**< closed form: the reference's engine gives the same numbers at every accuracy */
    const dea_engine *check;          /**< another engine whose measured numbers are nearest to the reference, NULL: none */
    double check_accuracy, apart;     /**< its accuracy, and how far it is from the reference [1] */
    size_t states[DEA_STATE_COUNT];   /**< rows of the reference by state */
    /** Of the strain, relative to model `field`; over time of the displacement, over the peak of its run; over frequency of the
     * displacement per volt: median, largest and root of the mean square over all rows [1]. NAN: modes or profiles, the field itself, or
     * nobody solved it. */
    double error_median, error_worst, error_rms;
    size_t error_points, error_left_out; /**< rows that count, and those that are not ok (over time: that have no number) in one of both */
} dea_bench_model;

/** A work-precision study; zeroed: none. Free with dea_bench_free(). */
typedef struct dea_bench {
    const dea_scene *scene;  /**< borrowed: must outlive this */
    dea_bench_model *models; /**< model_count of them, in the order of the scene */
    size_t model_count;
    dea_bench_setting *settings; /**< setting_count of them: by model, engine, from the loosest accuracy on */
    size_t setting_count;
    double units;     /**< points, simulated seconds or frequencies of one run */
    const char *unit; /**< "point", "simulated_second" or "frequency" */
    size_t rows;      /**< rows of one model's study */
} dea_bench;

/** How to measure. */
typedef struct dea_bench_options {
    const dea_engine *engine; /**< the only one to measure; NULL: all */
    size_t jobs;              /**< worker processes, >= 1, default 1 */
    size_t runs;              /**< timed runs of a setting, more where they are short, fewer where the budget ends, default 5 */
    double enough;            /**< short runs are repeated until they take so long together [s], >= 0, default 0.2 */
    double budget;            /**< time that all may take, roughly [s], > 0, default 60 */
    void (*progress)(void *user, size_t done, size_t total);
    void (*log)(void *user, const char *line); /**< what engines say about points that failed */
    bool (*stop)(void *user);                  /**< as in dea_run_options */
    void *user;
} dea_bench_options;

/** The defaults. */
DEA_API dea_bench_options dea_bench_options_default(void);
/** Gives the scene every model that can do its actuator and study, from the cheapest up. */
DEA_API void dea_bench_all_models(dea_scene *scene);
/** Measures all models of the scene; its accuracy does not count. A setting that fails, is refused or skipped says why and stops
 * nothing. @p bench is valid only on DEA_OK.
 * @return DEA_OK, DEA_ERROR_USAGE (too many rows to keep; options out of range), DEA_ERROR_INTERRUPTED, DEA_ERROR_MEMORY */
DEA_API dea_status dea_bench_run(const dea_scene *scene, const dea_bench_options *options, dea_bench *bench, dea_error *error);
/** Frees what the study owns; NULL and a zeroed one are fine. */
DEA_API void dea_bench_free(dea_bench *bench);

typedef struct dea_bench_output dea_bench_output;

/** Opens what a study is to be written to, before the work: a target that cannot be written fails here.
 *
 * @param table   CSV with a row a setting, "-" is standard output; NULL: none
 * @param picture through gnuplot, by its ending as plot.h says: error over time, a curve for each engine and model, and beside it the
 *                models' errors over time a point; NULL: none
 * @param options of the picture, NULL: none
 * @param[out] output the caller ends it with dea_bench_output_finish()
 * @return DEA_OK, DEA_ERROR_USAGE (ending of the picture), DEA_ERROR_IO, DEA_ERROR_MISSING (no gnuplot), DEA_ERROR_MEMORY */
DEA_API dea_status dea_bench_output_open(const char *table, const char *picture, const dea_plot_options *options,
                                         dea_bench_output **output, dea_error *error);
/** Writes the study and frees the output; where @p bench is NULL, nothing is written. A NULL output is fine.
 * @return DEA_OK, DEA_ERROR_USAGE (nothing to draw), DEA_ERROR_IO, DEA_ERROR_ENGINE (gnuplot failed: its words),
 * DEA_ERROR_MISSING, DEA_ERROR_MEMORY */
DEA_API dea_status dea_bench_output_finish(dea_bench_output *output, const dea_bench *bench, dea_error *error);

#ifdef __cplusplus
}
#endif
#endif
