/** @file load.h
 * What acts on the edge at r_a beside the film, all round: kinds of load, one row of a table each (src/load/table.c).
 */
#ifndef DEASPICE_LOAD_H
#define DEASPICE_LOAD_H

#include <stdbool.h>
#include <stddef.h>

#include "deaspice/status.h"

#ifdef __cplusplus
extern "C" {
#endif

struct dea_pool;

/** Most loads of a scene. */
enum { DEA_LOADS = 8 };

/** What loads add to the motion of the edge, m u'' + r u' + K u + springs(u) = F. */
typedef struct dea_edge_terms {
    double mass;      /**< m [kg] */
    double stiffness; /**< K [N/m] */
    double damping;   /**< r [N s/m] */
    double force;     /**< F, static, outward positive [N] */
    bool bent;        /**< there are springs that are no K u */
} dea_edge_terms;

/** What a spring holds against u, and its slope. */
typedef struct dea_spring {
    double force; /**< [N] */
    double slope; /**< [N/m] */
} dea_spring;

/** A kind of load: the number that a scene gives, and what that does at the edge. */
typedef struct dea_load_kind {
    const char *name;     /**< of its key load.<name>, and of its parameter in netlists, load_<name> */
    const char *unit;     /**< SI, e.g. "N/m" */
    const char *suffix;   /**< of its result column, e.g. "_N_per_m" */
    double low, high;     /**< its range, without the ends [unit] */
    const char *accepted; /**< range and an example, for messages */
    const char *element;  /**< of what it adds to the stiffness, the force or as a spring, in netlists, e.g. "n_load" */
    const char *meaning;  /**< what that is, with its unit */
    int length, time;     /**< its unit is that of a force over length, times length and time to these powers */
    dea_edge_terms adds;  /**< of 1 [unit] */
    /** A spring that is no K u, at rest where u is 0. NULL: it is none. */
    dea_spring (*spring)(double number, double u);
    /** Its force as an expression (src/expression/formula.h) of number and u. NULL where `spring` is. */
    int (*form)(struct dea_pool *pool, int number, int u);
} dea_load_kind;

/** A load of a scene; one without a kind, or of number NAN, is none. */
typedef struct dea_edge_load {
    const dea_load_kind *kind;
    double number; /**< in the unit of its kind */
} dea_edge_load;

/** Number of kinds in the table; a scene's load number i is of the kind number i, those behind are free for other kinds. */
DEA_API size_t dea_load_count(void);
/** Kind number @p index, NULL past the end. The library owns it. */
DEA_API const dea_load_kind *dea_load_at(size_t index);

#ifdef __cplusplus
}
#endif
#endif
