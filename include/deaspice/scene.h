/** @file scene.h
 * The scene: one actuator, one material, one drive, one study. Read from YAML, changed by dotted keys.
 *
 * Every scalar of a scene has one entry in the key table (src/scene/key_table.c): its dotted path, its place in the struct,
 * its unit and range. The reader, --set, sweep axes and result columns all work from that table.
 */
#ifndef DEASPICE_SCENE_H
#define DEASPICE_SCENE_H

#include <stdbool.h>
#include <stdio.h>

#include "deaspice/load.h"
#include "deaspice/material.h"
#include "deaspice/status.h"

#ifdef __cplusplus
extern "C" {
#endif

struct dea_model;
struct dea_engine;
struct dea_files;

/** Most models that one scene compares (`model: [lumped, coverage]`). */
enum { DEA_SCENE_MODELS = 8 };
/** Most engines that there are. */
enum { DEA_ENGINES = 4 };

/** Where the electrode is: on the disc (dot) or on the annulus (lens). */
typedef enum dea_kind { DEA_DOT, DEA_LENS } dea_kind;

/** Geometry as the scene gives it; exactly one of coverage and divide_radius is given. */
typedef struct dea_actuator {
    dea_kind kind;
    double frame_radius;     /**< r [m], > 0 */
    double coverage;         /**< B = r_a/r [1], 0 < B < 1, NAN where divide_radius is given */
    double divide_radius;    /**< r_a [m]: electrode_radius of a dot, lens_radius of a lens, NAN where coverage is given */
    double film_thickness;   /**< H before pre-stretch [m], > 0 */
    double prestretch;       /**< equi-biaxial pre-stretch [1], >= 1 */
    double electrode_mass;   /**< mass per area of the electrodes [kg/m^2], >= 0, NAN: none */
    double focal_length;     /**< lens optics at rest [m], > 0, NAN: none */
    double refractive_index; /**< of the lens liquid [1], > 1, NAN: none */
    double layers;           /**< films of that thickness in a stack, electrically parallel [1], whole, >= 1, default 1 */
} dea_actuator;

/** Electrodes of the electroded region: a skin with an energy of its own, stress-free at the pre-stretch (physics: section 8), and
 * what they weigh. All of a stack together, as laid on the pre-stretched film. */
typedef struct dea_electrode {
    const dea_law *law;                  /**< of the skin, NULL: none */
    double constants[DEA_LAW_CONSTANTS]; /**< of the law, 0 beyond those in use */
    size_t entry_count;                  /**< entries in use of a law that is a list, else 1 */
    double thickness;                    /**< t [m], > 0, NAN: none */
    double density;                      /**< [kg/m^3], > 0, NAN: no mass but actuator.electrode_mass */
    double sheet_resistance;             /**< of one electrode [Ohm per square], > 0, NAN: none */
} dea_electrode;

/** A second film in the same frame, joined to the first at r_a by a rigid ring, so that both edges move by the same u; a dot beside a
 * lens pushes against it. What is NAN is that of the first film. */
typedef struct dea_antagonist {
    bool there;
    dea_kind kind;
    double frame_radius;   /**< r [m], that of the first film */
    double coverage;       /**< B [1], that of the first film */
    double film_thickness; /**< H before pre-stretch [m], > 0 */
    double layers;         /**< films of that thickness [1], whole, >= 1 */
    double prestretch;     /**< [1], >= 1 */
    double voltage;        /**< static, across it [V], default 0 */
    bool own_material;     /**< it has one, else that of the first film */
    dea_material material;
} dea_antagonist;

/** Kinds of waveform, in the order of the table src/drive/waves.c. A file and a list of points are both points. */
typedef enum dea_wave_kind {
    DEA_WAVE_NONE,
    DEA_WAVE_STEP,
    DEA_WAVE_POINTS,
    DEA_WAVE_SINE,
    DEA_WAVE_PULSE,
    DEA_WAVE_SQUARE,
    DEA_WAVE_TRIANGLE,
    DEA_WAVE_CHIRP,
    DEA_WAVE_BURST,
    DEA_WAVE_SINES
} dea_wave_kind;

enum { DEA_WAVES = DEA_WAVE_SINES + 1 };

/** Most numbers of a waveform without a struct of its own, and most sines of a sum. */
enum { DEA_WAVE_NUMBERS = 8, DEA_SINES = 8 };

/** 0 V, then @p voltage from @p on to @p off; each edge rises or falls linearly within @p rise. */
typedef struct dea_step {
    double on;      /**< begin of the rising edge [s], >= 0 */
    double off;     /**< begin of the falling edge [s], >= on + rise, NAN: never */
    double voltage; /**< [V] */
    double rise;    /**< [s], >= 0, default 1 us; 0 is a jump */
} dea_step;

/** offset + amplitude sin(2 pi frequency (t - delay) + phase), held at its first value before the delay. */
typedef struct dea_sine {
    double offset;    /**< [V], default 0 */
    double amplitude; /**< [V] */
    double frequency; /**< [Hz], > 0 */
    double phase;     /**< [rad], default 0 */
    double delay;     /**< [s], >= 0, default 0 */
} dea_sine;

/** Voltage of the source over time. */
typedef struct dea_waveform {
    dea_wave_kind kind;
    dea_step step;
    dea_sine sine;
    dea_sine sines[DEA_SINES]; /**< their sum, sine_count of them, without delays */
    size_t sine_count;
    double numbers[DEA_WAVE_NUMBERS]; /**< of pulse, square, triangle, chirp and burst, each as its file in src/drive says */
    size_t choice;                    /**< of the words that the kind has a choice of (spacing of a chirp) */
    double *times;    /**< points, not decreasing, point_count of them [s]; two of one time are a jump; owned by the scene */
    double *voltages; /**< their voltages, linear in between and held before the first and after the last [V]; owned too */
    size_t point_count;
    double period; /**< what step, points or burst say before this time repeats [s], NAN: once */
    char columns[DEA_SOURCE_LENGTH]; /**< of points from a file: what each of its columns was taken for, in words; else "" */
} dea_waveform;

/** Electrical side. */
typedef struct dea_drive {
    double voltage;            /**< static voltage U of the source [V], NAN: a transient, or an AC study with a bias */
    dea_waveform waveform;     /**< of a transient */
    double series_resistance;  /**< R_s, source and electrodes [Ohm], >= 0, NAN: none */
    double leakage_resistance; /**< R_p of the film [Ohm], > 0, NAN: none */
    double current_limit;      /**< most that the source gives or takes [A], > 0, NAN or 0: any; of a transient, behind R_s > 0 */
} dea_drive;

/** One axis of a sweep. */
typedef struct dea_axis {
    char key[DEA_NAME_LENGTH];    /**< dotted path in the key table */
    char column[DEA_NAME_LENGTH]; /**< result column with its unit, e.g. voltage_V */
    char unit[16];                /**< SI unit, "1" where the quantity has no dimension */
    size_t offset;                /**< place of the scalar inside dea_scene, a double */
    bool changes_film;            /**< moves the material, the pre-stretch or the layers, not only geometry or drive */
    bool uniform;                 /**< values[i] = from + (to - from) i/(count - 1) */
    double *values;               /**< count values [unit], owned by the scene */
    size_t count;                 /**< >= 1 */
} dea_axis;

/** Kinds of study: code, and name of the row that tells all of it (src/study), which is its key too. */
#define DEA_STUDY_LIST(X)                                                                                                        \
    X(DEA_STUDY_SWEEP, sweep)                                                                                                    \
    X(DEA_STUDY_TRANSIENT, transient)                                                                                            \
    X(DEA_STUDY_AC, ac)                                                                                                          \
    X(DEA_STUDY_MODES, modes)                                                                                                    \
    X(DEA_STUDY_PROFILE, profile)                                                                                                \
    X(DEA_STUDY_FORCE, force)

/** What a study asks for. */
typedef enum dea_study_kind {
#define X(code, name) code,
    DEA_STUDY_LIST(X)
#undef X
        DEA_STUDIES
} dea_study_kind;

/** Most modes, and most radii of a shape or profile. */
enum { DEA_MODES_MOST = 12, DEA_RADII_MAX = 10001 };

/** Most windows over which a transient averages, and most samples of one. */
enum { DEA_WINDOWS = 8, DEA_SAMPLES_MAX = 4000000 };

/** A window of time. */
typedef struct dea_window {
    double from, to; /**< [s], 0 <= from < to <= until */
} dea_window;

/** A transient from t = 0 on. */
typedef struct dea_transient {
    double until;   /**< end [s], > 0 */
    double every;   /**< interval of the samples, of logarithmic ones the longest [s], 0 < every <= until, default until/1000 */
    bool logarithmic; /**< samples at 0, at `first`, and from there evenly in the logarithm of time; default false */
    double first;     /**< of logarithmic samples, the first behind 0 [s], 0 < first < until, default until/1e6 */
    size_t points_per_decade; /**< of logarithmic samples, 1 ... 10000, default 50; 0: not given */
    double grid;    /**< power of ten that makes a whole number of `every`: sample i lies at (every grid) i/grid [1/s]; 0: none */
    bool from_bias; /**< starts in the relaxed equilibrium under the first voltage (true), or at rest (default) */
    dea_window averages[DEA_WINDOWS];
    size_t average_count;
    size_t points; /**< radii at which every sample tells the film, 2 ... DEA_RADII_MAX; 0 (default): it is not told */
} dea_transient;

/** A frequency response about the equilibrium under the bias. */
typedef struct dea_ac {
    double from, to;          /**< [Hz], 0 < from <= to */
    size_t points_per_decade; /**< >= 1, default 50 */
    double bias;              /**< source voltage [V], default drive.voltage */
} dea_ac;

/** Modes of small motion about the equilibrium under the bias. */
typedef struct dea_modes_study {
    size_t count;  /**< modes, slowest first, 1 ... DEA_MODES_MOST, default 3 of a membrane, 1 of a film with one node */
    size_t points; /**< radii at which shapes are told, 2 ... DEA_RADII_MAX; 0 (default): shapes are not told */
    double bias;   /**< source voltage [V], default drive.voltage, or 0 without one */
} dea_modes_study;

/** The static film along its radius. */
typedef struct dea_profile {
    size_t points; /**< radii from the centre to the frame, 2 ... DEA_RADII_MAX, default 101 */
} dea_profile;

/** Displacements at which the edge is held, to - from apart in even steps. */
typedef struct dea_force_study {
    double from, to; /**< [m], both between -r_a and r - r_a */
    size_t points;   /**< 2 ... DEA_RADII_MAX, default 61 */
} dea_force_study;

/** How a branch of the Prony series enters a moving network. */
typedef enum dea_branch_form {
    DEA_BRANCH_WHOLE,  /**< spring and damper in series */
    DEA_BRANCH_OUT,    /**< not at all */
    DEA_BRANCH_SPRING, /**< a spring alone: too slow to relax */
    DEA_BRANCH_DAMPER  /**< a damper alone: relaxed but for what its velocity takes */
} dea_branch_form;

/** What a moving network leaves out; zeroed: nothing. See needs.h. */
typedef struct dea_reduction {
    bool mass;      /**< no inertia */
    bool damper;    /**< no Kelvin-Voigt damper */
    bool softening; /**< the voltage does not change the stiffness */
    bool series;    /**< the film sees the source: no series resistance */
    double ring;    /**< time behind a corner of the voltage from which on the mass counts no more [s], > 0; 0: an engine may set
                       one itself, +inf: it always counts */
    dea_branch_form branches[DEA_PRONY_MAX]; /**< of the material's prony, in its order */
} dea_reduction;

/** A scene. Owns its title, waveform and axes; free with dea_scene_free(). */
typedef struct dea_scene {
    char *title; /**< may be empty, never NULL */
    dea_actuator actuator;
    dea_electrode electrode;
    dea_edge_load loads[DEA_LOADS];
    dea_antagonist antagonist;
    dea_material material;
    dea_drive drive;
    const struct dea_model *models[DEA_SCENE_MODELS]; /**< models to run one after the other, model_count of them */
    size_t model_count;                               /**< >= 1 */
    bool automatic;          /**< `model: auto`: the first model is the finest there is until dea_needs_model() has chosen one */
    double model_error;      /**< what the model that `auto` chooses may be off from the finest [1], 0 ... 1, default 0.01 */
    const struct dea_engine *engines[DEA_ENGINES]; /**< those that may solve it, in the order in which they are asked */
    size_t engine_count;                           /**< 0 (`engine: auto`): all of them, the cheapest first */
    bool full;               /**< a transient leaves out nothing (see needs.h), default false; never read from a file */
    dea_reduction reduction; /**< never read from a file: set by dea_needs_find() */
    double accuracy;         /**< wanted relative error of the solution of the chosen model [1], 0 < accuracy < 1, default 1e-6 */
    dea_study_kind study;    /**< what is asked for */
    dea_transient transient; /**< of a transient */
    dea_ac ac;               /**< of an AC study */
    dea_modes_study modes;   /**< of a study of modes */
    dea_profile profile;     /**< of a study of profiles */
    dea_force_study force;   /**< of a study of forces */
    dea_axis *axes;          /**< axes of the sweep, or of `over`, in the order of the file; none is one point */
    size_t axis_count;
    struct dea_files *files; /**< those that were read for it, owned; NULL: none */
} dea_scene;

/** One `key=value` of the command line. */
typedef struct dea_setting {
    const char *text; /**< e.g. "actuator.prestretch=1.3" */
} dea_setting;

/** How a scene is read; zeroed: as its file says. */
typedef struct dea_reading {
    const dea_setting *settings; /**< setting_count of them, which replace what the file says; NULL: none */
    size_t setting_count;
    const char *model; /**< model name, or names with commas between, that replaces the scene's; NULL: the scene's */
    const char *engine; /**< the same for engines; NULL: the scene's */
    bool no_files;     /**< true: a scene that names another file (material, waveform) is refused; default false */
} dea_reading;

/** Reads a scene.
 *
 * A setting names its key by the whole dotted path or by the end of it (`prestretch`, `yeoh.C1`) and replaces what the file
 * says; coverage and a radius replace each other. Of several settings of one key the last holds. A key that the scene sweeps
 * takes no scalar setting: set its axis, `study.sweep.prestretch=[1.3]`, or `study.sweep={}` for none. A swept key counts as
 * given: without a scalar of its own it holds the first value of its axis. An axis of one point is `from`, with `to` left out or
 * equal.
 *
 * An end of a path that fits several keys means the one that the scene has: `voltage` is the step's beside a step. A setting of
 * one alternative takes the place of the other: sweep, transient, ac; step, points, sine, file; waveform and static voltage.
 *
 * @param path     file name, "-" for standard input; only regular files and pipes are read, at most 16 MiB
 * @param settings overrides with the same checks and units as the file, may be NULL when @p setting_count is 0
 * @param model    model name, or names with commas between, that replaces the scene's; or NULL
 * @param[out] scene valid only on DEA_OK; the caller frees it with dea_scene_free()
 * @return DEA_OK, DEA_ERROR_SCENE (message "file:line:column: key: ..."), DEA_ERROR_IO, DEA_ERROR_MEMORY
 */
DEA_API dea_status dea_scene_read(const char *path, const dea_setting *settings, size_t setting_count, const char *model,
                                  dea_scene *scene, dea_error *error);
/** Same, with more to say about how. */
DEA_API dea_status dea_scene_read_as(const char *path, const dea_reading *how, dea_scene *scene, dea_error *error);
/** Same from memory; @p name stands in messages and relative material files are found beside @p folder. */
DEA_API dea_status dea_scene_parse(const char *text, size_t length, const char *name, const char *folder,
                                   const dea_setting *settings, size_t setting_count, const char *model, dea_scene *scene,
                                   dea_error *error);
/** Reads a material file, as a scene that names it would; what it does not give is NAN (C1 and permittivity too).
 * @param[out] material valid only on DEA_OK
 * @return DEA_OK, DEA_ERROR_SCENE (message "file:line:column: key: ...", or the file cannot be read), DEA_ERROR_MEMORY
 */
DEA_API dea_status dea_material_read(const char *path, dea_material *material, dea_error *error);
/** Frees what the scene owns; NULL and a zeroed scene are fine. */
DEA_API void dea_scene_free(dea_scene *scene);
/** Points of the scene's sweep for one model: product of the axis lengths, 1 without axes. */
DEA_API size_t dea_scene_point_count(const dea_scene *scene);

#ifdef __cplusplus
}
#endif
#endif
