/** @file program.h
 * What the commands of the program share: arguments, messages, exit status, signals.
 */
#ifndef DEA_PROGRAM_PROGRAM_H
#define DEA_PROGRAM_PROGRAM_H

#include "deaspice/engine.h"
#include "deaspice/fit.h"
#include "deaspice/needs.h"
#include "deaspice/plot.h"
#include "deaspice/scene.h"
#include "support/file.h"

/** Exit status of the program. */
typedef enum dea_exit {
    DEA_EXIT_DONE = 0,
    DEA_EXIT_FAILED = 1,   /**< a run failed */
    DEA_EXIT_USAGE = 2,    /**< usage, a bad scene, or an engine that cannot do it */
    DEA_EXIT_DISAGREED = 3 /**< a check disagreed */
} dea_exit;

/** What a command takes besides --help and --version; one bit each. */
typedef enum dea_takes {
    DEA_TAKES_ENGINE = 1 << 0,
    DEA_TAKES_SCENE = 1 << 1, /**< --model, --set, --no-files */
    DEA_TAKES_OUTPUT = 1 << 2,
    DEA_TAKES_FORMAT = 1 << 3,
    DEA_TAKES_PLOT = 1 << 4,
    DEA_TAKES_JOBS = 1 << 5,
    DEA_TAKES_QUIET = 1 << 6,
    DEA_TAKES_TOLERANCE = 1 << 7,
    DEA_TAKES_FIT = 1 << 8,      /**< data and how they are fitted, constants of the film */
    DEA_TAKES_EXPORT = 1 << 9,   /**< --as, --dialect, --analogy, --name */
    DEA_TAKES_JOURNAL = 1 << 10, /**< --shard, --resume */
    DEA_TAKES_FULL = 1 << 11,    /**< --full */
    DEA_TAKES_BENCH = 1 << 12,   /**< --runs, --budget */
    DEA_TAKES_CURVES = 1 << 13,  /**< --to */
    DEA_TAKES_LOG = 1 << 14      /**< --log, --no-truth */
} dea_takes;

/** Mode of a data file as the command line gives it. */
typedef enum dea_given_mode { DEA_GIVEN_NONE, DEA_GIVEN_UNIAXIAL, DEA_GIVEN_EQUIBIAXIAL } dea_given_mode;

/** A file of the command line. */
typedef struct dea_operand {
    const char *path;
    dea_given_mode mode; /**< fit only */
} dea_operand;

/** Arguments of a command; strings belong to argv, arrays to this. */
typedef struct dea_arguments {
    const char *engine; /**< NULL: the scene's */
    const char *model;  /**< NULL: the scene's */
    dea_setting *settings;
    size_t setting_count;
    const char *output;
    const char *format;
    const char *plot;
    dea_plot_options picture; /**< --size, --log, --loops, --columns; zeroed: not given */
    size_t jobs; /**< 0: not given; "auto" is already the number of cores */
    bool quiet;
    bool full, no_truth;
    bool force;       /**< targets may overwrite inputs */
    bool no_files;    /**< scenes may name no files */
    double tolerance; /**< NAN: not given */
    const char *law;  /**< of a fit, or "auto"; NULL: yeoh */
    size_t terms;     /**< 0: not given */
    bool relative;
    const char *tests[DEA_TESTS]; /**< --relaxation, --dma, --creep; NULL: not given */
    double ramp;            /**< [s], NAN: not given */
    dea_specimen specimen;  /* of the fit's tables, 0: not given */
    size_t branches;        /**< 0: not given */
    const char *as;         /**< NULL: not given */
    const char *dialect;    /**< NULL: not given */
    const char *analogy;    /**< NULL: not given */
    const char *name;       /**< of a part, NULL: not given */
    size_t runs;            /**< 0: not given */
    double budget;          /**< [s], NAN: not given */
    double to;              /**< largest stretch of curves, NAN: not given */
    double permittivity;    /**< of the film of a fit, NAN: not given */
    double density;         /**< the same [kg/m^3] */
    double breakdown;       /**< the same [V/m] */
    size_t shard, shards;   /**< --shard shard/shards, 1 <= shard <= shards; 0: not given */
    bool resume;
    dea_operand *operands;
    size_t operand_count;
} dea_arguments;

/** Word number @p index of a list, NULL past its end. */
typedef const char *dea_word(size_t index, char room[DEA_NAME_LENGTH]);

/** A command. */
typedef struct dea_command {
    const char *name;
    const char *summary; /**< one line */
    const char *help;    /**< text of --help up to the options, which follow from their table */
    const char *further; /**< behind them, NULL: nothing */
    unsigned takes;      /**< dea_takes */
    size_t least, most;  /**< operands */
    dea_word *words;     /**< that an operand may be, NULL: none */
    const char *files;   /**< what a file that an operand may be ends in, "": anything, NULL: no file */
    dea_exit (*run)(const dea_arguments *arguments);
} dea_command;

/** Command number @p index, NULL past the end. */
const dea_command *dea_command_at(size_t index);
/** Kinds of export, dialects, analogies; laws, engines and models, and auto. */
dea_word dea_export_word, dea_dialect_word, dea_analogy_word, dea_law_word, dea_engine_word, dea_model_word;

extern const dea_command dea_command_run;
extern const dea_command dea_command_merge;
extern const dea_command dea_command_check;
extern const dea_command dea_command_bench;
extern const dea_command dea_command_export;
extern const dea_command dea_command_fit;
extern const dea_command dea_command_materials;
extern const dea_command dea_command_init;
extern const dea_command dea_command_completion;

/** How parsing ended. */
typedef enum dea_parsed { DEA_PARSED_FINE, DEA_PARSED_HELP, DEA_PARSED_VERSION, DEA_PARSED_WRONG } dea_parsed;

/** Parses what follows the command's name (argv[0]); tells what is wrong. The caller frees with dea_arguments_free(). */
dea_parsed dea_arguments_parse(const dea_command *command, int argc, char **argv, dea_arguments *arguments);
/** Prints the text of --help. */
void dea_help_print(const dea_command *command);
/** Frees the arrays. */
void dea_arguments_free(dea_arguments *arguments);
/** Cores that this process may use, at least 1. */
size_t dea_core_count(void);

/** Prints "deaspice: message" on standard error. */
void dea_complain(const char *format, ...) DEA_PRINTF(1, 2);
/** Complains about @p error unless a signal ended the work; returns the exit status that goes with it. */
dea_exit dea_complain_error(const dea_error *error);
/** Complains about an unknown @p what, with a guess among @p count names. */
void dea_complain_unknown(const char *what, const char *given, const char *const *names, size_t count);
/** Number of the given word among those of a list that needs no room; false with a complaint about an unknown @p what, where it is none of
 * them. */
bool dea_word_choose(const char *what, const char *given, dea_word *words, size_t *index);
/** True where the scene names the engine, or none. */
bool dea_engine_named(const dea_scene *scene, const dea_engine *engine);
/** Notes the files of the command line as read; false, with a complaint, without memory. */
bool dea_inputs_note(const dea_arguments *arguments, dea_files *files);
/** False, with a complaint, where a target of the arguments is one of the files that were read, or another target; see
 * dea_files_target(). */
bool dea_targets_free(const dea_arguments *arguments, dea_files *files);
/** Reads a scene with the settings of the command line, and sees to it that no target is one of its files; on failure says so
 * and sets @p outcome. */
bool dea_scene_open(const dea_arguments *arguments, const char *path, dea_scene *scene, dea_exit *outcome);
/** Complains where all engines of the scene refuse a model and names those that can do it; true where they do. */
bool dea_engines_unfit(const dea_scene *scene);
/** Settles `model: auto`: sets the first model; says which unless @p quiet. False, with a complaint and @p outcome, where no
 * model that the engine (NULL: those of the scene) can do is good enough. @p choice: what was chosen, zeroed where the scene names
 * its models. */
bool dea_model_settle(dea_scene *scene, const dea_engine *engine, bool quiet, dea_model_choice *choice, dea_exit *outcome);

/** Lets SIGINT, SIGTERM, SIGHUP and SIGPIPE end the work cleanly from now on; a second one kills at once. */
void dea_signals_catch(void);
/** The signal that came, 0: none. */
int dea_signals_caught(void);
/** True when what came is a reader that went away, which is nothing to talk about. */
bool dea_signals_broken_pipe(void);
/** Same as a stop callback of a run. */
bool dea_signals_stop(void *user);
/** Ends this process by the signal that came, if one did. */
void dea_signals_raise(void);

/* ---- Runs that keep their finished blocks in a journal: to go on after a crash, or as a shard. */

/** False, with a complaint, where --shard or --resume are given and other arguments do not go with them. */
bool dea_journaled_fits(const dea_arguments *arguments);
/** Runs a scene with --shard or --resume. */
dea_exit dea_run_journaled(const dea_arguments *arguments, const dea_scene *scene);

#endif
