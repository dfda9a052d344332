/* Expressions made from expressions: derivatives, values at a place, changes from rest. All are built in the same pool; an
 * exhausted pool tells of missing memory. */
#ifndef DEA_DERIVATIVE_H
#define DEA_DERIVATIVE_H

#include "expression/expression.h"

/* Derivative over node 0; over node or symbol number @p index: @p kind is DEA_NODE or DEA_SYMBOL. */
dea_expr dea_expr_slope(dea_pool *pool, dea_expr ref);
dea_expr dea_expr_derivative(dea_pool *pool, dea_expr ref, dea_operation kind, int index);

/* @p ref with node or symbol number @p index replaced by an expression; the same term where it holds none. */
dea_expr dea_expr_put(dea_pool *pool, dea_expr ref, dea_operation kind, int index, dea_expr by);
/* The same of one term wherever it stands. */
dea_expr dea_expr_replace(dea_pool *pool, dea_expr ref, dea_expr term, dea_expr by);
/* @p ref with all nodes at 0. */
dea_expr dea_expr_at_rest(dea_pool *pool, dea_expr ref);

/* ref - its value where all nodes are 0, by rules for pairs of (value at rest, change from rest): no value is taken from one that
 * is almost the same, so that it keeps its digits however small the nodes are. Exactly 0 at rest. */
dea_expr dea_expr_change(dea_pool *pool, dea_expr ref);

#endif
