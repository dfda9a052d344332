#include "expression/expression.h"

#include <limits.h>
#include <math.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

void dea_pool_free(dea_pool *pool)
{
    if (pool) {
        free(pool->terms);
        free(pool->slots);
        *pool = (dea_pool){0};
    }
}

static bool same_term(const dea_term *x, const dea_term *y)
{
    if (x->operation != y->operation) {
        return false;
    }
    return x->operation == DEA_NUMBER ? memcmp(&x->number, &y->number, sizeof x->number) == 0 : x->a == y->a && x->b == y->b;
}

/* Where the term stands in the table, or would stand: the search goes on from its hash to the first empty place. */
static int *slot_of(const dea_pool *pool, const dea_term *term)
{
    const uint64_t mix = 0x9e3779b97f4a7c15u;
    uint64_t key = ((uint64_t)(uint32_t)term->a << 32) | (uint32_t)term->b;
    if (term->operation == DEA_NUMBER) {
        memcpy(&key, &term->number, sizeof key);
    }
    uint64_t hash = (key ^ ((uint64_t)term->operation << 56)) * mix;
    const uint64_t mask = 2 * (uint64_t)pool->capacity - 1; /* the capacity is a power of 2 */
    for (hash ^= hash >> 32;; hash++) {
        int *slot = &pool->slots[hash & mask];
        if (*slot == 0 || same_term(&pool->terms[*slot - 1], term)) {
            return slot;
        }
    }
}

/* Twice the room, with the table made anew. */
static bool grow(dea_pool *pool)
{
    const int capacity = pool->capacity ? 2 * pool->capacity : 256;
    dea_term *terms = realloc(pool->terms, (size_t)capacity * sizeof *terms);
    pool->terms = terms ? terms : pool->terms;
    int *slots = calloc(2 * (size_t)capacity, sizeof *slots);
    if (!terms || !slots) {
        free(slots);
        pool->exhausted = true;
        return false;
    }
    free(pool->slots);
    pool->slots = slots;
    pool->capacity = capacity;
    for (int i = 0; i < pool->count; i++) {
        *slot_of(pool, &terms[i]) = i + 1;
    }
    return true;
}

static dea_expr intern(dea_pool *pool, dea_term term)
{
    if (pool->count == pool->capacity && !grow(pool)) {
        return 0;
    }
    int *slot = slot_of(pool, &term);
    if (*slot == 0) {
        pool->terms[pool->count++] = term;
        *slot = pool->count;
    }
    return *slot - 1;
}

dea_expr dea_expr_number(dea_pool *pool, double value)
{
    return intern(pool, (dea_term){.operation = DEA_NUMBER, .number = value});
}

dea_expr dea_expr_symbol(dea_pool *pool, int index)
{
    return intern(pool, (dea_term){.operation = DEA_SYMBOL, .a = index, .varies = true});
}

dea_expr dea_expr_node(dea_pool *pool, int index)
{
    return intern(pool, (dea_term){.operation = DEA_NODE, .a = index, .varies = true});
}

double dea_expr_constant(const dea_pool *pool, dea_expr ref)
{
    return pool->exhausted || pool->terms[ref].operation != DEA_NUMBER ? (double)NAN : pool->terms[ref].number;
}

bool dea_expr_is_scaled(const dea_pool *pool, dea_expr ref)
{
    const dea_term *term = &pool->terms[ref];
    return term->operation == DEA_MUL && pool->terms[term->a].operation == DEA_NUMBER;
}

static bool is_number(const dea_pool *pool, dea_expr ref, double value)
{
    return pool->terms[ref].operation == DEA_NUMBER && pool->terms[ref].number == value;
}

static double apply(dea_operation operation, double a, double b)
{
    return dea_operation_of(operation)->value(a, b);
}

/* Neutral elements and products with 0 vanish; -1 where nothing does. */
static dea_expr simplify(const dea_pool *pool, dea_operation operation, dea_expr a, dea_expr b)
{
    if ((operation == DEA_ADD || operation == DEA_SUB) && is_number(pool, b, 0.0)) {
        return a;
    }
    if (operation == DEA_ADD && is_number(pool, a, 0.0)) {
        return b;
    }
    if ((operation == DEA_MUL || operation == DEA_DIV) && is_number(pool, b, 1.0)) {
        return a;
    }
    if (operation == DEA_MUL && (is_number(pool, a, 1.0) || is_number(pool, b, 0.0))) {
        return b;
    }
    if ((operation == DEA_MUL || operation == DEA_DIV) && is_number(pool, a, 0.0)) {
        return a;
    }
    return -1;
}

/* (x y)/y and (x/y) y are x; -1 where nothing cancels. A 0/0 at the start of an iteration is thus kept out of netlists. */
static dea_expr cancel(const dea_pool *pool, dea_operation operation, dea_expr a, dea_expr b)
{
    const dea_term *term = &pool->terms[a];
    if (operation == DEA_DIV && term->operation == DEA_MUL) {
        return term->b == b ? term->a : term->a == b ? term->b : -1;
    }
    if (operation == DEA_MUL && term->operation == DEA_DIV && term->b == b) {
        return term->a;
    }
    const dea_term *other = &pool->terms[b];
    if (operation == DEA_MUL && other->operation == DEA_DIV && other->b == a) {
        return other->a;
    }
    return -1;
}

static dea_expr combine(dea_pool *pool, dea_operation operation, dea_expr a, dea_expr b)
{
    if (pool->exhausted) {
        return 0;
    }
    if (pool->terms[a].operation == DEA_NUMBER && pool->terms[b].operation == DEA_NUMBER) {
        return dea_expr_number(pool, apply(operation, pool->terms[a].number, pool->terms[b].number));
    }
    if (operation == DEA_DIV && a == b) {
        return dea_expr_number(pool, 1.0);
    }
    const dea_expr cancelled = cancel(pool, operation, a, b);
    const dea_expr simple = cancelled >= 0 ? cancelled : simplify(pool, operation, a, b);
    return simple >= 0 ? simple : intern(pool, (dea_term){.operation = operation, .a = a, .b = b, .varies = true});
}

/* Splits a product into its numeric factor, which always stands first, and the rest; *rest is -1 where there is none. */
static double split(const dea_pool *pool, dea_expr ref, dea_expr *rest)
{
    const dea_term *term = &pool->terms[ref];
    if (term->operation == DEA_NUMBER) {
        *rest = -1;
        return term->number;
    }
    if (term->operation == DEA_MUL && pool->terms[term->a].operation == DEA_NUMBER) {
        *rest = term->b;
        return pool->terms[term->a].number;
    }
    *rest = ref;
    return 1.0;
}

/* Products and quotients with their numeric factors drawn together in front. */
static dea_expr multiply(dea_pool *pool, dea_operation operation, dea_expr a, dea_expr b)
{
    if (pool->exhausted) {
        return 0;
    }
    dea_expr rest_a, rest_b;
    const double number_a = split(pool, a, &rest_a);
    const double number_b = split(pool, b, &rest_b);
    const dea_expr number = dea_expr_number(pool, apply(operation, number_a, number_b));
    if (rest_b < 0) {
        return rest_a < 0 ? number : combine(pool, DEA_MUL, number, rest_a);
    }
    if (rest_a < 0) {
        return combine(pool, operation, number, rest_b);
    }
    return combine(pool, DEA_MUL, number, combine(pool, operation, rest_a, rest_b));
}

static dea_expr sum(dea_pool *pool, dea_operation operation, dea_expr a, dea_expr b);

/* f c + g c, c the factor that both share, as (f + g) c; -1 where they share none. */
static dea_expr draw_out(dea_pool *pool, dea_operation operation, dea_expr a, dea_expr b)
{
    dea_expr rest_a, rest_b;
    const double number_a = split(pool, a, &rest_a);
    const double number_b = split(pool, b, &rest_b);
    if (rest_a < 0 || rest_b < 0 || pool->terms[rest_a].operation != DEA_MUL || pool->terms[rest_b].operation != DEA_MUL) {
        return -1;
    }
    const dea_expr of_a[] = {pool->terms[rest_a].a, pool->terms[rest_a].b};
    const dea_expr of_b[] = {pool->terms[rest_b].a, pool->terms[rest_b].b};
    for (int i = 0; i < 4; i++) {
        const dea_expr shared = of_a[i / 2];
        if (shared == of_b[i % 2]) {
            const dea_expr f = dea_expr_scale(pool, number_a, of_a[1 - i / 2]);
            const dea_expr g = dea_expr_scale(pool, number_b, of_b[1 - i % 2]);
            return multiply(pool, DEA_MUL, shared, sum(pool, operation, f, g));
        }
    }
    return -1;
}

static bool is_sum(const dea_term *term)
{
    return term->operation == DEA_ADD || term->operation == DEA_SUB;
}

/* m + (n + x), m - (n + x), m + (n - x), m - (n - x) with numbers m, n, as one number and x; -1 where nothing is to be gathered.
 */
static dea_expr gather(dea_pool *pool, dea_operation operation, dea_expr a, dea_expr b)
{
    const dea_term inner = pool->terms[b]; /* a copy: the pool grows */
    if (!is_sum(&inner) || pool->terms[a].operation != DEA_NUMBER || pool->terms[inner.a].operation != DEA_NUMBER) {
        return -1;
    }
    const dea_expr number = dea_expr_number(pool, apply(operation, pool->terms[a].number, pool->terms[inner.a].number));
    return sum(pool, operation == inner.operation ? DEA_ADD : DEA_SUB, number, inner.b);
}

/* factor shared + sign other, factor -2, 0 or 2. */
static dea_expr weighted(dea_pool *pool, int factor, dea_expr shared, int sign, dea_expr other)
{
    if (factor == 0) {
        return sign > 0 ? other : dea_expr_neg(pool, other);
    }
    const dea_expr twice = dea_expr_scale(pool, 2.0, shared);
    return factor < 0 ? sum(pool, DEA_SUB, other, twice) : sum(pool, sign > 0 ? DEA_ADD : DEA_SUB, twice, other);
}

/* A sum of one term and a sum that holds it: a + (a + x) = 2 a + x, (a - x) + x = a; -1 where it does not. */
static dea_expr repeated(dea_pool *pool, dea_operation operation, dea_expr a, dea_expr b)
{
    const int sign = operation == DEA_ADD ? 1 : -1;
    const dea_term left = pool->terms[a], right = pool->terms[b]; /* copies: the pool grows */
    if (is_sum(&right)) {
        const int inner = right.operation == DEA_ADD ? sign : -sign;
        if (right.a == a) {
            return weighted(pool, 1 + sign, a, inner, right.b);
        }
        if (right.b == a) {
            return weighted(pool, 1 + inner, a, sign, right.a);
        }
    }
    if (is_sum(&left)) {
        const int inner = left.operation == DEA_ADD ? 1 : -1;
        if (left.a == b) {
            return weighted(pool, 1 + sign, b, inner, left.b);
        }
        if (left.b == b) {
            return weighted(pool, inner + sign, b, 1, left.a);
        }
    }
    return -1;
}

/* Sums; a negative factor of the second term turns the sign instead. */
static dea_expr sum(dea_pool *pool, dea_operation operation, dea_expr a, dea_expr b)
{
    dea_expr rest = -1;
    const double factor = pool->exhausted ? 1.0 : split(pool, b, &rest);
    if (rest >= 0 && factor < 0.0) {
        return sum(pool, operation == DEA_ADD ? DEA_SUB : DEA_ADD, a,
                   multiply(pool, DEA_MUL, dea_expr_number(pool, -factor), rest));
    }
    if (a == b) {
        return dea_expr_scale(pool, operation == DEA_ADD ? 2.0 : 0.0, a);
    }
    if (!pool->exhausted && operation == DEA_SUB && is_number(pool, a, 0.0)) {
        return dea_expr_neg(pool, b);
    }
    const dea_expr gathered = pool->exhausted ? -1 : gather(pool, operation, a, b);
    const dea_expr twice = pool->exhausted || gathered >= 0 ? gathered : repeated(pool, operation, a, b);
    if (twice >= 0) {
        return twice;
    }
    const dea_expr drawn = pool->exhausted ? -1 : draw_out(pool, operation, a, b);
    return drawn >= 0 ? drawn : combine(pool, operation, a, b);
}

dea_expr dea_expr_add(dea_pool *pool, dea_expr a, dea_expr b)
{
    return sum(pool, DEA_ADD, a, b);
}

dea_expr dea_expr_sub(dea_pool *pool, dea_expr a, dea_expr b)
{
    return sum(pool, DEA_SUB, a, b);
}

dea_expr dea_expr_mul(dea_pool *pool, dea_expr a, dea_expr b)
{
    return multiply(pool, DEA_MUL, a, b);
}

dea_expr dea_expr_div(dea_pool *pool, dea_expr a, dea_expr b)
{
    return multiply(pool, DEA_DIV, a, b);
}

/* Of a product, the product of its squares, so that those of numbers and parameters fold. */
dea_expr dea_expr_square(dea_pool *pool, dea_expr a)
{
    const dea_term term = pool->exhausted ? (dea_term){0} : pool->terms[a]; /* a copy: the pool grows */
    if (term.operation == DEA_MUL && term.a != term.b) {
        return dea_expr_mul(pool, dea_expr_square(pool, term.a), dea_expr_square(pool, term.b));
    }
    return dea_expr_mul(pool, a, a);
}

dea_expr dea_expr_scale(dea_pool *pool, double factor, dea_expr a)
{
    return dea_expr_mul(pool, dea_expr_number(pool, factor), a);
}

dea_expr dea_expr_neg(dea_pool *pool, dea_expr a)
{
    return dea_expr_scale(pool, -1.0, a);
}

dea_expr dea_expr_of(dea_pool *pool, dea_operation operation, dea_expr a)
{
    return combine(pool, operation, a, a);
}

dea_expr dea_expr_pow(dea_pool *pool, dea_expr a, dea_expr b)
{
    if (!pool->exhausted && is_number(pool, b, 1.0)) {
        return a;
    }
    return combine(pool, DEA_POW, a, b);
}

dea_expr dea_expr_apply(dea_pool *pool, dea_operation operation, dea_expr a, dea_expr b)
{
    static dea_expr (*const sums[])(dea_pool *, dea_expr, dea_expr) = {[DEA_ADD] = dea_expr_add,
                                                                       [DEA_SUB] = dea_expr_sub,
                                                                       [DEA_MUL] = dea_expr_mul,
                                                                       [DEA_DIV] = dea_expr_div,
                                                                       [DEA_POW] = dea_expr_pow};
    const size_t known = sizeof sums / sizeof *sums;
    return (size_t)operation < known && sums[operation] ? sums[operation](pool, a, b) : combine(pool, operation, a, b);
}

/* A term as a factor that holds neither node nor symbol 0, and what does, -1: nothing. */
typedef struct factored {
    dea_expr factor, rest;
} factored;

static dea_expr whole(dea_pool *pool, factored f)
{
    return f.rest < 0 ? f.factor : combine(pool, DEA_MUL, f.factor, f.rest);
}

/* Neither node nor symbol 0 in it. */
static bool is_fixed(const dea_pool *pool, dea_expr ref)
{
    const dea_term *term = &pool->terms[ref];
    return term->operation >= DEA_ADD ? is_fixed(pool, term->a) && is_fixed(pool, term->b)
                                      : term->operation == DEA_NUMBER || (term->operation == DEA_SYMBOL && term->a > 0);
}

static factored factor_of(dea_pool *pool, dea_operation operation, factored a, factored b)
{
    const dea_expr one = dea_expr_number(pool, 1.0);
    const dea_expr factor = operation == DEA_MUL || operation == DEA_DIV ? dea_expr_apply(pool, operation, a.factor, b.factor) : one;
    if (operation == DEA_MUL && a.rest >= 0 && b.rest >= 0) {
        return (factored){factor, dea_expr_mul(pool, a.rest, b.rest)};
    }
    if (operation == DEA_MUL || (operation == DEA_DIV && b.rest < 0)) {
        return (factored){factor, a.rest >= 0 ? a.rest : b.rest};
    }
    if (operation == DEA_DIV) {
        return (factored){factor, dea_expr_div(pool, a.rest >= 0 ? a.rest : one, b.rest)};
    }
    const bool sum = operation == DEA_ADD || operation == DEA_SUB;
    if (sum && a.rest >= 0 && a.rest == b.rest) {
        return (factored){dea_expr_apply(pool, operation, a.factor, b.factor), a.rest};
    }
    if (sum && a.rest >= 0 && b.rest >= 0 && a.factor == b.factor) {
        return (factored){a.factor, dea_expr_apply(pool, operation, a.rest, b.rest)};
    }
    const dea_expr left = whole(pool, a), right = whole(pool, b);
    const dea_term inner = pool->terms[left]; /* a copy: the pool grows */
    if (sum && b.rest < 0 && is_sum(&inner) && is_fixed(pool, inner.a)) {
        return (factored){one, dea_expr_apply(pool, inner.operation, dea_expr_apply(pool, operation, inner.a, right), inner.b)};
    }
    return (factored){one, dea_expr_apply(pool, operation, left, right)};
}

static factored factor_out(dea_pool *pool, dea_expr ref, factored *made)
{
    const dea_term term = pool->terms[ref]; /* a copy: the pool grows */
    if (made[ref].factor >= 0) {
        return made[ref];
    }
    factored result = {ref, -1};
    if (term.operation == DEA_NODE || (term.operation == DEA_SYMBOL && term.a == 0)) {
        result = (factored){dea_expr_number(pool, 1.0), ref};
    } else if (term.operation >= DEA_ADD) {
        const factored a = factor_out(pool, term.a, made), b = factor_out(pool, term.b, made);
        result = a.rest < 0 && b.rest < 0 ? result : factor_of(pool, term.operation, a, b);
    }
    made[ref] = result;
    return result;
}

dea_expr dea_expr_gathered(dea_pool *pool, dea_expr ref)
{
    const size_t size = ((size_t)pool->count + 1) * sizeof(factored);
    factored *made = pool->exhausted ? NULL : malloc(size);
    if (!made) {
        pool->exhausted = true;
        return 0;
    }
    memset(made, 0xff, size); /* -1: not made */
    const dea_expr result = whole(pool, factor_out(pool, ref, made));
    free(made);
    return result;
}

/* What a leaf is worth: one of several values, NAN past the last; a stride of 0 gives the same to all. */
static double pick(const double *values, int count, int stride, int index)
{
    return index >= 0 && index < count ? values[stride * index] : (double)NAN;
}

static void evaluate(const dea_pool *pool, const dea_point_values *at, int stride, double *values)
{
    for (int i = 0; i < pool->count; i++) {
        const dea_term *term = &pool->terms[i];
        values[i] = term->operation >= DEA_ADD      ? apply(term->operation, values[term->a], values[term->b])
                    : term->operation == DEA_NUMBER ? term->number
                    : term->operation == DEA_SYMBOL ? pick(at->symbols, at->symbol_count, stride, term->a)
                                                    : pick(at->nodes, at->node_count, stride, term->a);
    }
}

void dea_pool_values_at(const dea_pool *pool, const dea_point_values *at, double *values)
{
    evaluate(pool, at, 1, values);
}

void dea_pool_values_uniform(const dea_pool *pool, double symbols, double nodes, double *values)
{
    evaluate(pool, &(dea_point_values){&symbols, &nodes, INT_MAX, INT_MAX}, 0, values);
}
