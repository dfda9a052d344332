/* Short forms for writing formulas of expressions. They build in the pool that the local variable `pool` points to. */
#ifndef DEA_FORMULA_H
#define DEA_FORMULA_H

#include "expression/expression.h"

#define NUM(value) dea_expr_number(pool, value)
#define ADD(a, b) dea_expr_add(pool, a, b)
#define SUB(a, b) dea_expr_sub(pool, a, b)
#define MUL(a, b) dea_expr_mul(pool, a, b)
#define DIV(a, b) dea_expr_div(pool, a, b)
#define NEG(a) dea_expr_neg(pool, a)
#define SQUARE(a) dea_expr_square(pool, a)
#define SCALE(factor, a) dea_expr_scale(pool, factor, a)
#define LN(a) dea_expr_of(pool, DEA_LN, a)
#define EXP(a) dea_expr_of(pool, DEA_EXP, a)
#define SQRT(a) dea_expr_of(pool, DEA_SQRT, a)
#define LOG1P(a) dea_expr_of(pool, DEA_LOG1P, a)
#define EXPM1(a) dea_expr_of(pool, DEA_EXPM1, a)
#define POW(a, b) dea_expr_pow(pool, a, b)
#define POSITIVE(a) dea_expr_of(pool, DEA_POSITIVE, a)

#endif
