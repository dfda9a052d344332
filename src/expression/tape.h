/* What a set of expressions needs, in order, ready to evaluate: values, with the derivative along a direction where it is wanted.
 */
#ifndef DEA_TAPE_H
#define DEA_TAPE_H

#include "deaspice/status.h"
#include "expression/expression.h"

typedef struct dea_tape {
    dea_term *terms;      /* owned; operands renumbered to this tape */
    double *values;       /* owned: computed by every run */
    double *slopes;       /* owned: computed by dea_tape_run() and dea_tape_along() */
    int count;
    int moving;   /* terms from this one on depend on nodes or symbols; those before hold their values already */
    int *outputs; /* owned */
    int output_count;
} dea_tape;

/* Compiles @p count expressions of @p symbols symbols and @p nodes nodes to a tape that the caller ends with dea_tape_free(),
 * also after a failure. DEA_ERROR_USAGE where an expression holds a symbol or a node of a higher index, DEA_ERROR_MEMORY. */
dea_status dea_tape_compile_many(const dea_pool *pool, const dea_expr *refs, int count, int symbols, int nodes, dea_tape *tape,
                                 dea_error *error);
/* The same with one symbol and one node. */
dea_status dea_tape_compile(const dea_pool *pool, const dea_expr *refs, int count, dea_tape *tape, dea_error *error);
void dea_tape_free(dea_tape *tape);

/* Values at @p symbols and @p nodes, as many of them as the tape was compiled for. */
void dea_tape_values(dea_tape *tape, const double *symbols, const double *nodes);
/* Values, and slopes along a direction: one component a symbol and a node; NULL: 0. */
void dea_tape_along(dea_tape *tape, const double *symbols, const double *nodes, const double *symbol_direction,
                    const double *node_direction);
/* Of a tape with one symbol and one node: values with slopes over the node, or without. */
void dea_tape_run(dea_tape *tape, double symbol, double node);
void dea_tape_run_values(dea_tape *tape, double symbol, double node);

static inline double dea_tape_value(const dea_tape *tape, int output)
{
    return tape->values[tape->outputs[output]];
}
static inline double dea_tape_slope(const dea_tape *tape, int output)
{
    return tape->slopes[tape->outputs[output]];
}

#endif
