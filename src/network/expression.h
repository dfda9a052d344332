/* Expressions of a network: one definition from which the netlist text, the value and the exact derivative are made.
 *
 * An expression is an index into its pool. Numbers fold while an expression is built, equal expressions share one index, and
 * operands always come before what uses them, so that one pass over the pool evaluates everything. */
#ifndef DEA_EXPRESSION_H
#define DEA_EXPRESSION_H

#include <stdbool.h>
#include <stddef.h>

#include "deaspice/status.h"

typedef int dea_expr;

typedef enum dea_operation { DEA_NUMBER, DEA_SYMBOL, DEA_NODE, DEA_ADD, DEA_SUB, DEA_MUL, DEA_DIV, DEA_LN } dea_operation;

typedef struct dea_term {
    dea_operation operation;
    dea_expr a, b; /* operands, of a logarithm both the same; of a symbol and a node: a is its index */
    double number; /* of a number */
    bool varies;   /* holds a symbol or a node */
} dea_term;

typedef struct dea_pool {
    dea_term *terms; /* owned */
    int count;
    int capacity;
    bool exhausted; /* memory ran out: the pool is unusable, but safe to build on and to free */
} dea_pool;

void dea_pool_free(dea_pool *pool);

dea_expr dea_expr_number(dea_pool *pool, double value);
/* Symbol @p index stands for a number that is known only at evaluation: the swept scalar. */
dea_expr dea_expr_symbol(dea_pool *pool, int index);
/* Node @p index is an unknown of the network: a displacement. */
dea_expr dea_expr_node(dea_pool *pool, int index);
dea_expr dea_expr_add(dea_pool *pool, dea_expr a, dea_expr b);
dea_expr dea_expr_sub(dea_pool *pool, dea_expr a, dea_expr b);
dea_expr dea_expr_mul(dea_pool *pool, dea_expr a, dea_expr b);
dea_expr dea_expr_div(dea_pool *pool, dea_expr a, dea_expr b);
dea_expr dea_expr_square(dea_pool *pool, dea_expr a);
/* factor times a. */
dea_expr dea_expr_scale(dea_pool *pool, double factor, dea_expr a);
dea_expr dea_expr_neg(dea_pool *pool, dea_expr a);
/* Natural logarithm. */
dea_expr dea_expr_ln(dea_pool *pool, dea_expr a);

/* A number, or NAN where the expression varies. */
double dea_expr_constant(const dea_pool *pool, dea_expr ref);

/* Values of all terms of the pool at symbol 0 and node 0, into an array of pool->count. */
void dea_pool_values(const dea_pool *pool, double symbol, double node, double *values);

enum { DEA_TAPE_OUTPUTS = 24 };

/* What a set of expressions needs, in order, ready to evaluate with the derivative over node 0. */
typedef struct dea_tape {
    dea_term *terms; /* owned; operands renumbered to this tape */
    double *values;  /* owned: computed by dea_tape_run() */
    double *slopes;  /* owned: computed by dea_tape_run(): derivative over node 0 */
    int count;
    int moving; /* terms from this one on depend on node or symbol; those before hold their values already */
    int outputs[DEA_TAPE_OUTPUTS];
    int output_count;
} dea_tape;

/* Compiles @p count expressions (at most DEA_TAPE_OUTPUTS) to a tape that the caller ends with dea_tape_free(). */
dea_status dea_tape_compile(const dea_pool *pool, const dea_expr *refs, int count, dea_tape *tape, dea_error *error);
void dea_tape_free(dea_tape *tape);
/* Evaluates all outputs at symbol 0 = @p symbol and node 0 = @p node, with slopes or without. */
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
