#include "expression/derivative.h"

#include <limits.h>
#include <stdlib.h>
#include <string.h>

#include "expression/formula.h"

/* What stands in an expression beside its operands: their derivatives, or their values at rest and their changes. */
typedef struct operand_change {
    dea_expr rest, now, change;
} operand_change;

/* The rules of an operation for derivatives and for changes, in its row of DEA_OPERATION_LIST. */
#define X(NAME, OPERANDS, VALUE, SLOPE, DERIVATIVE, CHANGE)                                                                      \
    static dea_expr derivative_##NAME(dea_pool *pool, dea_expr own, dea_expr a, dea_expr b, dea_expr da, dea_expr db)            \
    {                                                                                                                            \
        (void)pool, (void)own, (void)a, (void)b, (void)da, (void)db;                                                             \
        return DERIVATIVE;                                                                                                       \
    }                                                                                                                            \
    static dea_expr change_##NAME(dea_pool *pool, dea_expr rest, const operand_change *left,                                 \
                                  const operand_change *right)                                                               \
    {                                                                                                                            \
        const dea_expr a0 = left->rest, a1 = left->now, da = left->change;                                                       \
        const dea_expr b0 = right->rest, b1 = right->now, db = right->change;                                                    \
        (void)pool, (void)rest, (void)a0, (void)a1, (void)da, (void)b0, (void)b1, (void)db;                                      \
        return CHANGE;                                                                                                           \
    }
DEA_OPERATION_LIST(X)
#undef X

static const struct {
    dea_expr (*derivative)(dea_pool *pool, dea_expr own, dea_expr a, dea_expr b, dea_expr da, dea_expr db);
    dea_expr (*change)(dea_pool *pool, dea_expr rest, const operand_change *a, const operand_change *b);
} rules[DEA_OPERATIONS] = {
#define X(NAME, OPERANDS, VALUE, SLOPE, DERIVATIVE, CHANGE) [DEA_##NAME] = {derivative_##NAME, change_##NAME},
    DEA_OPERATION_LIST(X)
#undef X
};

/* An array for the terms that there are, every byte 0xff: each number in it is -1, not made. NULL without memory, which the pool
 * then tells. */
static void *blank(dea_pool *pool, size_t size)
{
    const size_t whole = size * ((size_t)pool->count + 1);
    void *made = pool->exhausted ? NULL : malloc(whole);
    if (!made) {
        pool->exhausted = true;
        return NULL;
    }
    return memset(made, 0xff, whole);
}

/* The leaf that is differentiated over, or replaced. */
typedef struct leaf {
    dea_operation kind;
    int index; /* -1: any */
    dea_expr by;
} leaf;

static bool is_leaf(const dea_term *term, const leaf *sought)
{
    return term->operation == sought->kind && (sought->index < 0 || term->a == sought->index);
}

static dea_expr derive(dea_pool *pool, dea_expr ref, const leaf *over, dea_expr *made)
{
    if (made[ref] >= 0) {
        return made[ref];
    }
    const dea_term term = pool->terms[ref]; /* a copy: the pool grows */
    dea_expr result = NUM(is_leaf(&term, over) ? 1.0 : 0.0);
    if (term.operation >= DEA_ADD) {
        const dea_expr a = derive(pool, term.a, over, made);
        const dea_expr b = derive(pool, term.b, over, made);
        result = rules[term.operation].derivative(pool, ref, term.a, term.b, a, b);
    }
    made[ref] = result;
    return result;
}

dea_expr dea_expr_derivative(dea_pool *pool, dea_expr ref, dea_operation kind, int index)
{
    dea_expr *made = blank(pool, sizeof *made);
    const leaf over = {kind, index, 0};
    const dea_expr result = made ? derive(pool, ref, &over, made) : 0;
    free(made);
    return result;
}

dea_expr dea_expr_slope(dea_pool *pool, dea_expr ref)
{
    return dea_expr_derivative(pool, ref, DEA_NODE, 0);
}

static dea_expr put(dea_pool *pool, dea_expr ref, const leaf *out, dea_expr *made)
{
    if (made[ref] >= 0) {
        return made[ref];
    }
    const dea_term term = pool->terms[ref]; /* a copy: the pool grows */
    dea_expr result = is_leaf(&term, out) ? out->by : ref;
    if (term.operation >= DEA_ADD) {
        const dea_expr a = put(pool, term.a, out, made);
        const dea_expr b = put(pool, term.b, out, made);
        result = a == term.a && b == term.b ? ref : dea_expr_apply(pool, term.operation, a, b);
    }
    made[ref] = result;
    return result;
}

dea_expr dea_expr_put(dea_pool *pool, dea_expr ref, dea_operation kind, int index, dea_expr by)
{
    dea_expr *made = blank(pool, sizeof *made);
    const leaf out = {kind, index, by};
    const dea_expr result = made ? put(pool, ref, &out, made) : 0;
    free(made);
    return result;
}

dea_expr dea_expr_replace(dea_pool *pool, dea_expr ref, dea_expr term, dea_expr by)
{
    dea_expr *made = blank(pool, sizeof *made);
    const leaf none = {DEA_SYMBOL, INT_MAX, 0};
    if (made) {
        made[term] = by;
    }
    const dea_expr result = made ? put(pool, ref, &none, made) : 0;
    free(made);
    return result;
}

dea_expr dea_expr_at_rest(dea_pool *pool, dea_expr ref)
{
    return dea_expr_put(pool, ref, DEA_NODE, -1, NUM(0.0));
}

/* Pairs of the terms that there were: value at rest, change, and their sum. */
static operand_change change(dea_pool *pool, dea_expr ref, operand_change *made)
{
    if (made[ref].rest >= 0) {
        return made[ref];
    }
    const dea_term term = pool->terms[ref]; /* a copy: the pool grows */
    operand_change result = {ref, ref, NUM(0.0)};
    if (term.operation == DEA_NODE) {
        result = (operand_change){result.change, ref, ref};
    } else if (term.operation >= DEA_ADD) {
        const bool afresh = dea_operation_of(term.operation)->afresh;
        const operand_change a = change(pool, term.a, made);
        const operand_change b = change(pool, term.b, made);
        if (a.now != a.rest || b.now != b.rest) {
            result.rest = dea_expr_apply(pool, term.operation, a.rest, b.rest);
            result.change = rules[term.operation].change(pool, result.rest, &a, &b);
            result.now = afresh ? dea_expr_apply(pool, term.operation, a.now, b.now) : ADD(result.rest, result.change);
        }
    }
    made[ref] = result;
    return result;
}

dea_expr dea_expr_change(dea_pool *pool, dea_expr ref)
{
    operand_change *made = blank(pool, sizeof *made);
    const dea_expr result = made ? change(pool, ref, made).change : 0;
    free(made);
    return result;
}
