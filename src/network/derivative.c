#include "network/derivative.h"

#include <stdlib.h>

#include "network/formula.h"

/* Slopes of the terms before the new ones, -1 where not yet made. */
static dea_expr slope(dea_pool *pool, dea_expr ref, dea_expr *made)
{
    if (made[ref] >= 0) {
        return made[ref];
    }
    const dea_term term = pool->terms[ref]; /* a copy: the pool grows */
    dea_expr result = NUM(term.operation == DEA_NODE ? 1.0 : 0.0);
    if (term.operation >= DEA_ADD) {
        const dea_expr a = slope(pool, term.a, made);
        const dea_expr b = slope(pool, term.b, made);
        if (term.operation == DEA_ADD) {
            result = ADD(a, b);
        } else if (term.operation == DEA_SUB) {
            result = SUB(a, b);
        } else if (term.operation == DEA_MUL) {
            result = ADD(MUL(a, term.b), MUL(term.a, b));
        } else if (term.operation == DEA_DIV) {
            result = DIV(SUB(a, MUL(ref, b)), term.b);
        } else {
            result = DIV(a, term.a);
        }
    }
    made[ref] = result;
    return result;
}

dea_expr dea_expr_slope(dea_pool *pool, dea_expr ref)
{
    const size_t size = (size_t)pool->count + 1;
    dea_expr *made = pool->exhausted ? NULL : malloc(size * sizeof *made);
    if (!made) {
        pool->exhausted = true;
        return 0;
    }
    for (size_t i = 0; i < size; i++) {
        made[i] = -1;
    }
    const dea_expr result = slope(pool, ref, made);
    free(made);
    return result;
}
