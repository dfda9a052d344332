/* Derivatives of expressions, as expressions: for elements whose law needs a slope in its text. */
#ifndef DEA_DERIVATIVE_H
#define DEA_DERIVATIVE_H

#include "network/expression.h"

/* Derivative over node 0, built in the same pool; an exhausted pool tells of missing memory. */
dea_expr dea_expr_slope(dea_pool *pool, dea_expr ref);

#endif
