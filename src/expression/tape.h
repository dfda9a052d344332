/* What a set of expressions needs, in order, ready to evaluate: values, with the derivative along a direction, or with the
 * gradient over all nodes. */
#ifndef DEA_TAPE_H
#define DEA_TAPE_H

#include "deaspice/status.h"
#include "expression/expression.h"

/* The nodes that a term depends on, from the first to the last, and where its gradient over them stands. */
typedef struct dea_tape_span {
    int first, count;
    size_t place;
} dea_tape_span;

typedef struct dea_tape {
    dea_term *terms;      /* owned; operands renumbered to this tape */
    double *values;       /* owned: computed by every run */
    double *slopes;       /* owned: computed by dea_tape_run() and dea_tape_along() */
    dea_tape_span *spans; /* owned */
    double *gradients;    /* owned: computed by dea_tape_gradients(), count doubles a span */
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
/* Values, and gradients over all nodes. The cost goes with the nodes that the terms depend on: neighbours in space should be
 * neighbours in number. */
void dea_tape_gradients(dea_tape *tape, const double *symbols, const double *nodes);

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
/* The nodes that an output depends on; its derivative over any node. */
static inline dea_tape_span dea_tape_span_of(const dea_tape *tape, int output)
{
    return tape->spans[tape->outputs[output]];
}
static inline double dea_tape_gradient(const dea_tape *tape, int output, int node)
{
    const dea_tape_span span = dea_tape_span_of(tape, output);
    const int at = node - span.first;
    return at >= 0 && at < span.count ? tape->gradients[span.place + (size_t)at] : 0.0;
}

#endif
