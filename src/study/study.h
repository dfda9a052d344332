/* Kinds of study, behind one table: a kind is one file here and one line in DEA_STUDY_LIST (deaspice/scene.h). A row tells what
 * reader, runner, writers, pictures and messages need to know of it; none of them knows the kinds themselves. */
#ifndef DEA_STUDY_H
#define DEA_STUDY_H

#include "deaspice/engine.h"

struct dea_drawer;
struct dea_export;
struct dea_key;
struct dea_reader;

/* How the difference of two numbers counts. */
typedef enum dea_measure {
    DEA_OVER_ITSELF, /* relative to the reference's own number */
    DEA_OVER_PEAK,   /* relative to the scale of its column over the run (result/scales.h) */
    DEA_OVER_RADIAN  /* an angle in degrees: absolute, in radian, whole turns taken off */
} dea_measure;

/* A column that engines must agree on. */
typedef struct dea_study_column {
    size_t offset; /* of the double in a row */
    dea_measure measure;
    const char *head; /* of the table that shows the differences */
} dea_study_column;

/* One thing, and several. */
typedef const char *const dea_words[2];

typedef struct dea_study {
    const char *name;  /* key in `study`, e.g. "transient" */
    const char *path;  /* of that key */
    const char *axes;  /* path of the mapping in it that the axes stand in */
    const char *title; /* e.g. "transient study" */
    dea_words points, rows; /* what a point and a row are: "run", "runs", "sample", "samples" */

    /* What its rows are. */
    bool along;    /* rows of a point lie along a coordinate, their first column; else a point is one row, a dea_row */
    bool timed;    /* rows are dea_sample, and a dea_summary stands behind them */
    bool phasors;  /* rows are dea_response, and a dea_band stands behind them */
    bool still;    /* the film rests: no current flows */
    bool holds;    /* the edge is held */
    bool stations; /* rows are dea_station, and a dea_weakest stands behind them */
    bool waveform; /* takes a waveform instead of drive.voltage */
    const char *bias;      /* key of the voltage that it has instead of drive.voltage, NULL: none */
    const char *sign;      /* of the coordinate in messages, e.g. "t"; NULL: places are not told */
    const char *model_fails, *model_lacks; /* why a model cannot do it, in a sentence that begins with its name, and alone */
    const char *engine_fails;              /* why an engine cannot */
    const char *at;        /* where a model is held against the membrane, e.g. " at the bias"; NULL: that goes without saying */
    const char *plot_name; /* of a SPICE raw file */

    /* How a bench counts: the unit of work, head and factor of its time in the table, and what that is called. */
    const char *unit, *unit_head, *unit_label;
    double unit_scale;

    /* Keys of its mapping, which stand behind `study` in the table of keys. */
    const struct dea_key *keys;
    size_t key_count;

    const dea_column *columns; /* of its rows, column_count of them; what lay() adds stands behind them */
    size_t column_count;
    size_t row_size, state_offset; /* 0: those of a dea_row */
    size_t behind;                 /* bytes behind the rows */
    const dea_study_column *compared; /* by the engines' agreement, compared_count of them */
    size_t compared_count;
    const dea_column *figures; /* numbers of a point, which stand behind its rows: variables over the axes, figure_count of them */
    size_t figure_count;
    const size_t *drawn; /* columns of a picture over the coordinate, the first in the largest panel, drawn_count of them */
    size_t drawn_count;

    size_t resonance; /* column that is a resonance in the first row, 0: none */
    const struct dea_drawer *drawer; /* of its pictures */
    const struct dea_drawer *spread_drawer; /* of those of rows that tell something over the radius; NULL: the same */

    /* True where it can be asked of a model; NULL: of all. */
    bool (*takes)(const dea_model *model);
    /* Puts defaults in and checks it as a whole; NULL: nothing to do. */
    dea_status (*finish)(struct dea_reader *reader);
    /* Puts the voltage at which models are held against the membrane into the drive; NULL: it is there. */
    dea_status (*rest)(dea_scene *scene, dea_error *error);
    /* Writes what decides its numbers and is no scalar of the table of keys; NULL: nothing. */
    void (*identify)(FILE *out, const dea_scene *scene);
    /* Further columns, the number of rows (1) and what they tell over the radius; NULL: nothing of that. */
    void (*lay)(const dea_scene *scene, dea_layout *layout);
    /* Coordinate of row @p index; NULL where rows do not lie along one. */
    double (*place)(const dea_scene *scene, size_t index);
    /* Its inverse, between rows and past the last one too; NULL where nobody asks. */
    double (*index)(const dea_scene *scene, double place);
    /* Makes what stands behind the rows of a failed point; NULL: nothing stands there. */
    void (*fail)(const dea_layout *layout, void *point);
    /* True where the engine has it; NULL: where it has one of its solves[]. */
    bool (*offered)(const dea_engine *engine);
    /* Solves one point, whose axes are at their place; NULL: many at once, by the engine's sweep(). */
    dea_status (*solve)(const dea_engine *engine, void *session, dea_scene *here, const dea_model *model, const dea_layout *layout,
                        void *point, dea_error *error);
    /* Writes it as a netlist; NULL: none does it. */
    dea_status (*netlist)(struct dea_export *export, dea_error *error);
} dea_study;

/* Row of a kind. */
const dea_study *dea_study_at(dea_study_kind kind);

/* True where the study can be asked of a model. */
bool dea_study_takes(const dea_study *study, const dea_model *model);
/* For takes: it moves. */
bool dea_study_moves(const dea_model *model);
/* Solves one point by the engine's solves[]. */
dea_status dea_study_solve(const dea_engine *engine, void *session, dea_scene *here, const dea_model *model, const dea_layout *layout,
                           void *point, dea_error *error);

/* Row of the scene's study. */
static inline const dea_study *dea_study_of(const dea_scene *scene)
{
    return dea_study_at(scene->study);
}

#endif
