/** @file engine.h
 * Engines that solve a study, behind one table, and the runner that spreads a study over worker processes.
 */
#ifndef DEASPICE_ENGINE_H
#define DEASPICE_ENGINE_H

#include "deaspice/model.h"

#ifdef __cplusplus
extern "C" {
#endif

/** What a moving network can leave out; one bit each in `omits`. */
typedef enum dea_part {
    DEA_PART_MASS,
    DEA_PART_RING, /**< the mass once its ring has died away behind a corner of the voltage */
    DEA_PART_BRANCH,
    DEA_PART_DAMPER,
    DEA_PART_SERIES,
    DEA_PART_SOFTENING
} dea_part;

/** An engine. A session is the engine's mutable state inside one process; the table entry is const. */
typedef struct dea_engine {
    const char *name;    /**< e.g. "ngspice" */
    const char *summary; /**< one line for --help */
    bool isolated;       /**< runs only inside a worker process: a foreign library that can crash, hang or be poisoned */
    double patience;     /**< a worker that needs longer than this for one point, on average over its block, hangs [s] */
    double run_patience; /**< the same for one transient or frequency response [s] */
    size_t block;        /**< points that one call of sweep() takes best */
    unsigned omits;      /**< parts of a moving network that cost it time: 1 << dea_part */
    bool profiles;       /**< its transients of a membrane tell the film along the radius */
    /** What a static point, a transient or a frequency response of a model of each form takes, in orders of magnitude [s]. */
    double costs[DEA_STUDIES][DEA_FORMS];
    /** Writes name and version of the foreign library whose numbers these are. NULL: there is none. */
    void (*library)(char *text, size_t size);
    /** NULL where the engine can do this model and scene, else why not (one phrase, static). */
    const char *(*refuses)(const dea_scene *scene, const dea_model *model);
    /** Starts a session; the caller ends it with end(). */
    dea_status (*begin)(void **session, dea_error *error);
    /** Solves points first ... first + count - 1 of the scene's sweep for one model. Never stops at a point past a limit.
     * Anything but DEA_OK leaves the session unusable; rows are then undefined. */
    dea_status (*sweep)(void *session, const dea_scene *scene, const dea_model *model, size_t first, size_t count, dea_row *rows,
                        dea_error *error);
    /** Runs one transient: fills the samples of the layout, what stands behind them over the radius, and the summary (of its means those of windows that end before the
     * last row with numbers count). All axes of @p scene are at their place. A run that
     * ends early (pull_in, failed) is no failure of this call: the rows tell, and where they are failed the message of @p error
     * says why. NULL: the engine has no time domain. */
    dea_status (*transient)(void *session, const dea_scene *scene, const dea_model *model, dea_sample *samples,
                            dea_summary *summary, dea_error *error);
    /** Computes one frequency response: fills the rows of the layout, and the band unless @p band is NULL. NULL: the engine has
     * none. */
    dea_status (*ac)(void *session, const dea_scene *scene, const dea_model *model, dea_response *rows, dea_band *band,
                     dea_error *error);
    /** Solves one point of any other kind of study: fills its rows and what stands behind them. All axes of @p scene are at their
     * place. NULL: the engine has none of that kind. */
    dea_status (*solves[DEA_STUDIES])(void *session, const dea_scene *scene, const dea_model *model, const dea_layout *layout,
                                      void *point, dea_error *error);
    /** Ends a session; NULL is fine. */
    void (*end)(void *session);
} dea_engine;

/** NULL where the engine can do the scene's study with this model, else why not (one phrase, static). */
DEA_API const char *dea_engine_refuses(const dea_engine *engine, const dea_scene *scene, const dea_model *model);

/** Number of engines. */
DEA_API size_t dea_engine_count(void);
/** Engine number @p index, NULL past the end. The library owns it. */
DEA_API const dea_engine *dea_engine_at(size_t index);
/** Engine by name, NULL if there is none. */
DEA_API const dea_engine *dea_engine_find(const char *name);

/** Engines for a model in the order in which they are asked: one is asked where all before it could not deliver. */
typedef struct dea_crew {
    const dea_engine *engines[DEA_ENGINES];
    size_t count; /**< 0: nobody can */
} dea_crew;

/** Engines that can do a study of the scene with a model: @p engine alone, or where it is NULL those of the scene, without one
 * that needs worker processes for points that another one solves in this process. */
DEA_API dea_crew dea_crew_of(const dea_scene *scene, const dea_engine *engine, const dea_model *model);
/** Names the engines that are asked first, e.g. "direct" or "lumped by direct, coverage by ida". */
DEA_API void dea_crew_names(const dea_scene *scene, const dea_engine *engine, char *text, size_t size);

/** How a study is run and who listens. Every callback may be NULL except points. */
typedef struct dea_run_options {
    size_t jobs; /**< worker processes, >= 1; 1 keeps an engine that is not isolated in this process */
    /** Takes the results of @p count points in order, each as the scene's dea_layout says; @p first counts over models (slowest)
     * and points. A failure ends the run with its status. */
    dea_status (*points)(void *user, size_t first, const void *points, size_t count, dea_error *error);
    /** False: the points of block @p block of the study are neither computed nor handed over. Which points a block has depends on
     * scene and engine alone (src/engine/cut.h). NULL: all are wanted. The answer must stay the same until the block is handed
     * over. */
    bool (*wanted)(void *user, size_t block);
    /** Tells, before points() takes their block, that so many points of it are `failed` because their worker was lost or memory
     * ran out, which may go well in another run, and not by the engine's last word. */
    void (*lost)(void *user, size_t count);
    /** Tells, before points() takes their block, that so many points of it were solved by an engine that was not asked first. */
    void (*instead)(void *user, const dea_engine *engine, size_t count);
    bool any_order; /**< points() takes blocks as they are finished, not in order */
    /** Points handed over so far, of those that are wanted. */
    void (*progress)(void *user, size_t done, size_t total);
    void (*log)(void *user, const char *line); /**< what engines say about points that failed */
    /** Polled, true ends the run as interrupted: between points in this process, at least 10 times a second where workers solve. */
    bool (*stop)(void *user);
    bool apart; /**< workers for one job too where a point takes long (a transient), so that stop() is heard at once */
    void *user;
} dea_run_options;

/** Runs the scene's study: all models, all points, rows in order, by @p engine, or where it is NULL each model by its crew.
 *
 * Workers are forked; none is left behind, whatever way the run ends. A worker that crashes, hangs or fails costs only the points
 * that it cannot solve even alone: those rows are `failed`.
 * @return DEA_OK, DEA_ERROR_UNSUPPORTED (the engine refuses a model; nothing was run), DEA_ERROR_ENGINE (no session could begin),
 *         DEA_ERROR_INTERRUPTED, DEA_ERROR_MEMORY, or what the rows callback returned
 */
DEA_API dea_status dea_study_run(const dea_scene *scene, const dea_engine *engine, const dea_run_options *options,
                                 dea_error *error);

#ifdef __cplusplus
}
#endif
#endif
