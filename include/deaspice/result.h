/** @file result.h
 * One row of a static study.
 */
#ifndef DEASPICE_RESULT_H
#define DEASPICE_RESULT_H

#include "deaspice/status.h"

#ifdef __cplusplus
extern "C" {
#endif

/** States of a static point: code, name, meaning. */
#define DEA_STATE_LIST(X)                                                            \
    X(DEA_STATE_OK, "ok", "equilibrium within all limits")                           \
    X(DEA_STATE_SLACK, "slack", "a region lost its tension: the film wrinkles")      \
    X(DEA_STATE_PULL_IN, "pull_in", "no equilibrium connected to rest")              \
    X(DEA_STATE_BREAKDOWN, "breakdown", "true field above the breakdown strength")   \
    X(DEA_STATE_FAILED, "failed", "not solved")

typedef enum dea_state {
#define X(code, name, meaning) code,
    DEA_STATE_LIST(X)
#undef X
        DEA_STATE_COUNT
} dea_state;

/** Static result of one point; with pull_in and failed the four numbers are NAN. */
typedef struct dea_row {
    double strain;       /**< s, radial strain of the disc edge [1] */
    double displacement; /**< u, outward [m] */
    double force;        /**< F_DEA over the full circumference, outward [N] */
    double field;        /**< true field in the electroded film, its largest value [V/m] */
    dea_state state;
} dea_row;

/** A row that was not solved. */
DEA_API dea_row dea_row_failed(void);

/** Name of a state as results print it. */
DEA_API const char *dea_state_name(dea_state state);

/** Numeric columns of a row: name, unit, offset in dea_row; the state column follows them. */
typedef struct dea_column {
    const char *name;      /**< e.g. "displacement_m" */
    const char *long_name; /**< e.g. "radial displacement of the disc edge" */
    const char *unit;      /**< SI, "1" without dimension */
    size_t offset;         /**< of the double in dea_row */
} dea_column;

enum { DEA_ROW_COLUMNS = 4 };
DEA_API extern const dea_column dea_row_columns[DEA_ROW_COLUMNS];

#ifdef __cplusplus
}
#endif
#endif
