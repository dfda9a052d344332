/* Expressions of a network: one definition from which the netlist text, the value and the exact derivative are made.
 *
 * An expression is an index into its pool. Numbers fold while an expression is built, equal expressions share one index, and
 * operands always come before what uses them, so that one pass over the pool evaluates everything. */
#ifndef DEA_EXPRESSION_H
#define DEA_EXPRESSION_H

#include <stdbool.h>
#include <stddef.h>

#include "expression/operation.h"

typedef struct dea_term {
    dea_operation operation;
    dea_expr a, b; /* operands, of an operation of one both the same; of a symbol and a node: a is its index */
    double number; /* of a number */
    bool varies;   /* holds a symbol or a node */
} dea_term;

struct dea_pool {
    dea_term *terms; /* owned */
    int count;
    int capacity;
    int *slots;     /* owned: a hash table of 2 capacity places, index of a term + 1, 0: empty */
    bool exhausted; /* memory ran out: the pool is unusable, but safe to build on and to free */
};

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
/* An operation of one operand. */
dea_expr dea_expr_of(dea_pool *pool, dea_operation operation, dea_expr a);
/* a to the power b, a > 0. */
dea_expr dea_expr_pow(dea_pool *pool, dea_expr a, dea_expr b);
/* Any operation; of one operand a, @p b is a again. */
dea_expr dea_expr_apply(dea_pool *pool, dea_operation operation, dea_expr a, dea_expr b);

/* The same with the factors of every product that hold neither node nor symbol 0 drawn together in front, as one term: in a netlist
 * they are one parameter. */
dea_expr dea_expr_gathered(dea_pool *pool, dea_expr ref);

/* A number, or NAN where the expression varies. */
double dea_expr_constant(const dea_pool *pool, dea_expr ref);

/* A number times another term. */
bool dea_expr_is_scaled(const dea_pool *pool, dea_expr ref);

/* Values of symbols and nodes, 0 the first of each. */
typedef struct dea_point_values {
    const double *symbols, *nodes;
    int symbol_count, node_count;
} dea_point_values;

/* Values of all terms of the pool, into an array of pool->count: NAN where a symbol or node past the last stands; with one value for
 * all symbols and one for all nodes. */
void dea_pool_values_at(const dea_pool *pool, const dea_point_values *at, double *values);
void dea_pool_values_uniform(const dea_pool *pool, double symbols, double nodes, double *values);

#endif
