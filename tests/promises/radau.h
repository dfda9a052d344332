/* Radau IIA with six stages, order 11, in long double. */
#ifndef DEA_RADAU_H
#define DEA_RADAU_H

#include <stdbool.h>

enum { STAGES = 6, STAGE_UNKNOWNS = 2 * STAGES };

typedef struct square {
    long double at[STAGES][STAGES];
} square;

/* The method: places of the stages, their weights, and the inverse of these. */
typedef struct method {
    long double place[STAGES];
    square weight, slope;
} method;

method radau_method(void);

/* A branch that relaxes with the pace h/tau from z under the stress S of the stages: Z = rest z + gain S, with rest = (1 + pace A)^-1
 * and gain = rest pace A. */
typedef struct lag {
    square rest, gain;
} lag;

lag lag_of(const method *radau, long double pace);

/* a x = b by elimination with pivots, b in x; false where a pivot is 0. */
bool dense_solve(int n, long double a[STAGE_UNKNOWNS][STAGE_UNKNOWNS], long double *x);

#endif
