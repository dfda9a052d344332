/* The operations of expressions: one row each, so that no other place asks which operation it is. */
#ifndef DEA_OPERATION_H
#define DEA_OPERATION_H

#include <math.h>
#include <stdbool.h>

typedef int dea_expr;
typedef struct dea_pool dea_pool;

/* X(NAME, operands, value, slope, derivative, change)
 *
 * value: from the values x and y of the operands a and b. slope: from those, the own value v and the slopes dx and dy of the
 * operands. Both are C expressions, written out in the loops of a tape.
 *
 * derivative: an expression, of the own term `own`, the operands a and b and their derivatives da and db. change: own(u) -
 * own(rest) as an expression, of the value `rest` of the own term, those a0 and b0 of the operands at rest, those a1 and b1 at u,
 * and the changes da and db, so that no value is taken from another that is almost the same. Both use the short forms of
 * formula.h.
 *
 * A power is that of a base > 0. Of something positive (a length, what is left to a limit) the value is itself, or NAN where it
 * is not positive; in a netlist it is held above zero, as Newton's iterates pass by places where no film is. */
#define DEA_OPERATION_LIST(X)                                                                                                    \
    X(ADD, 2, x + y, dx + dy, ADD(da, db), ADD(da, db))                                                                          \
    X(SUB, 2, x - y, dx - dy, SUB(da, db), SUB(da, db))                                                                          \
    X(MUL, 2, x *y, dx *y + x * dy, ADD(MUL(da, b), MUL(a, db)),                                                                 \
      a0 == b0 && da == db ? MUL(da, ADD(a0, a1)) : ADD(MUL(da, b1), MUL(a0, db)))                                               \
    X(DIV, 2, x / y, (dx - v * dy) / y, DIV(SUB(da, MUL(own, db)), b), DIV(SUB(da, MUL(rest, db)), b1))                          \
    X(LN, 1, log(x), dx / x, DIV(da, a), LOG1P(DIV(da, a0)))                                                                     \
    X(EXP, 1, exp(x), v *dx, MUL(own, da), MUL(rest, EXPM1(da)))                                                                 \
    X(SQRT, 1, sqrt(x), 0.5 * dx / v, DIV(SCALE(0.5, da), own), DIV(da, ADD(rest, SQRT(a1))))                                    \
    X(LOG1P, 1, log1p(x), dx / (1.0 + x), DIV(da, ADD(NUM(1.0), a)), LOG1P(DIV(da, ADD(NUM(1.0), a0))))                          \
    X(EXPM1, 1, expm1(x), (1.0 + v) * dx, MUL(ADD(NUM(1.0), own), da), MUL(ADD(NUM(1.0), rest), EXPM1(da)))                      \
    X(POW, 2, pow(x, y), v *(y * dx / x + (dy != 0.0 ? dy * log(x) : 0.0)), MUL(own, ADD(DIV(MUL(b, da), a), MUL(db, LN(a)))),   \
      MUL(rest, EXPM1(ADD(MUL(b1, LOG1P(DIV(da, a0))), MUL(db, LN(a0))))))                                                       \
    X(POSITIVE, 1, x > 0.0 ? x : (double)NAN, dx, da, da)

/* Leaves first, DEA_ADD is the first operation. */
typedef enum dea_operation {
    DEA_NUMBER,
    DEA_SYMBOL,
    DEA_NODE,
#define X(NAME, OPERANDS, VALUE, SLOPE, DERIVATIVE, CHANGE) DEA_##NAME,
    DEA_OPERATION_LIST(X)
#undef X
        DEA_OPERATIONS
} dea_operation;

typedef struct dea_operation_row {
    const char *name;
    int operands;     /* 0, 1 or 2 */
    int precedence;   /* of its text: 1 a sum, 2 a product, 3 closed in itself */
    bool strict;      /* a right operand of the same precedence stands in brackets */
    const char *text; /* in netlists, `@` and `#` stand for the operands; a dialect may have its own */
    const char
        *held; /* what stands for the operand `@` where it moves, NULL: itself. An iterate can leave the range of the solution */
    bool afresh; /* the value at u is that of the operands there: the sum of rest and change has lost the digits of what falls to
                    a hundredth of it, or the range */
    bool inner;  /* its text stays within what uses it: a simulator's iteration follows nodes along their tangents, and that of a
                    logarithm as a node of its own leads the exponential behind it astray */
    double (*value)(double x, double y);
} dea_operation_row;

/* The row of an operation; leaves have rows without functions and text. */
const dea_operation_row *dea_operation_of(dea_operation operation);

#endif
