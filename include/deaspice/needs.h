/** @file needs.h
 * What a moving scene needs at its accuracy: which elements of the network cannot change its samples by more than that, and the
 * cheapest model that is good enough.
 *
 * Displacement, its means over the scene's windows, and film voltage count, each relative to its largest value over the samples. Every omission has a bound; the sum
 * of the bounds stays below a quarter of the accuracy, and the engine gets the rest of it.
 */
#ifndef DEASPICE_NEEDS_H
#define DEASPICE_NEEDS_H

#include "deaspice/engine.h"
#include "deaspice/scene.h"

#ifdef __cplusplus
extern "C" {
#endif

/** One omission. */
typedef struct dea_omission {
    dea_part part;
    size_t branch;        /**< of the material's prony, from 0, where the part is a branch */
    dea_branch_form form; /**< of that branch */
    double from;          /**< time behind a corner of the voltage from which on [s], where the part is the ring */
    double bound;         /**< of what it changes [1] */
} dea_omission;

enum { DEA_OMISSIONS = DEA_PRONY_MAX + 8 };

/** What is left out of one run. */
typedef struct dea_needs {
    dea_omission omissions[DEA_OMISSIONS];
    size_t count;
    double bound;     /**< sum of theirs [1], below accuracy/4 */
    double resonance; /**< of the free film [Hz] and its decay [1/s], as in dea_summary; NAN also where nothing can be told */
    double decay;
} dea_needs;

/** Finds what a transient leaves out; nothing for other studies and for parts that cost the engine nothing. All axes of @p scene
 * are at their place; its reduction is not looked at.
 * @return DEA_OK, also where nothing can be told and so nothing is left out; DEA_ERROR_MEMORY */
DEA_API dea_status dea_needs_find(const dea_scene *scene, const dea_model *model, const dea_engine *engine, dea_needs *needs,
                                  dea_error *error);
/** The reduction that leaves out @p count omissions. */
DEA_API dea_reduction dea_needs_reduction(const dea_omission *omissions, size_t count);

/** What a judge says of a bound. */
typedef enum dea_verdict {
    DEA_NOT_JUDGED, /**< no engine can tell, or the judge's own error hides what it looks for */
    DEA_HELD,
    DEA_BROKEN
} dea_verdict;

/** What an omission truly changes. */
typedef struct dea_measured {
    double change; /**< of the samples, on top of the omissions before it [1]; infinite where only one of the runs ends early, NAN
                      where no engine could tell */
    double error;  /**< that the change may have: by how much the judge's runs at two accuracies differ [1] */
    double ended;  /**< time at which only one of the two runs ends [s], else NAN */
    dea_verdict verdict;
    const char *why; /**< static text where it is not judged, else NULL */
} dea_measured;

/** Measures what each omission of a run truly changes, by running it with and without by an engine of this process, each at two
 * accuracies. A bound is judged only where the judge's error is below it, or below what the change exceeds it by. Of a ring the
 * swing counts that is left behind its time, by its velocity: no judge drops the mass within a run, and a film without mass
 * forgets what its swing did to slow branches.
 * @param[out] measured needs->count of them
 * @return DEA_OK, DEA_ERROR_MEMORY or what the engine's session said */
DEA_API dea_status dea_needs_measure(const dea_scene *scene, const dea_model *model, const dea_needs *needs,
                                     dea_measured *measured, dea_error *error);

/** A model chosen for `model: auto`. */
typedef struct dea_model_choice {
    const dea_model *model; /**< NULL: none that the engine can do is good enough */
    const dea_model *truth; /**< what it is held against */
    double bound;           /**< of its model error [1], 0 for the truth itself */
    bool unsolved;          /**< at a probe no engine of this process ran the finest model: truth is the next, how far that is off is not known */
    const dea_model *next;  /**< where model is NULL: the best that the engine can do, NULL: there is none; bound is its */
} dea_model_choice;

/** The finest model for a kind of study, which `model: auto` holds the others against. */
DEA_API const dea_model *dea_needs_truth(dea_study_kind study);
/** Chooses the cheapest model whose error is below the scene's model error at every point of the study, from probes over its
 * axes. The truth is `field`. Of models that cost the same the nearest to the membrane comes first. The error is that of the strain
 * relative to itself, of the displacement relative to its peak in time, of the response relative to itself.
 * In time a model that static errors do not rule out is run, as the truth is, at up to 17 probes of each axis; a model whose run
 * cannot be told from there, or has other states, is not chosen.
 * @param engine NULL: of all models, whoever can do them */
DEA_API dea_status dea_needs_model(const dea_scene *scene, const dea_engine *engine, dea_model_choice *choice, dea_error *error);

#ifdef __cplusplus
}
#endif
#endif
