#include "network/expression.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

void dea_pool_free(dea_pool *pool)
{
    if (pool) {
        free(pool->terms);
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

static dea_expr intern(dea_pool *pool, dea_term term)
{
    for (int i = 0; i < pool->count; i++) {
        if (same_term(&pool->terms[i], &term)) {
            return i;
        }
    }
    if (pool->count == pool->capacity) {
        const int capacity = pool->capacity ? 2 * pool->capacity : 256;
        dea_term *terms = realloc(pool->terms, (size_t)capacity * sizeof *terms);
        if (!terms) {
            pool->exhausted = true;
            return 0;
        }
        pool->terms = terms;
        pool->capacity = capacity;
    }
    pool->terms[pool->count] = term;
    return pool->count++;
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

static bool is_number(const dea_pool *pool, dea_expr ref, double value)
{
    return pool->terms[ref].operation == DEA_NUMBER && pool->terms[ref].number == value;
}

static double apply(dea_operation operation, double a, double b)
{
    return operation == DEA_ADD   ? a + b
           : operation == DEA_SUB ? a - b
           : operation == DEA_MUL ? a * b
           : operation == DEA_DIV ? a / b
                                  : log(a);
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

/* Sums; a negative factor of the second term turns the sign instead. */
static dea_expr sum(dea_pool *pool, dea_operation operation, dea_expr a, dea_expr b)
{
    dea_expr rest = -1;
    const double factor = pool->exhausted ? 1.0 : split(pool, b, &rest);
    if (rest >= 0 && factor < 0.0) {
        return sum(pool, operation == DEA_ADD ? DEA_SUB : DEA_ADD, a,
                   multiply(pool, DEA_MUL, dea_expr_number(pool, -factor), rest));
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

dea_expr dea_expr_square(dea_pool *pool, dea_expr a)
{
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

dea_expr dea_expr_ln(dea_pool *pool, dea_expr a)
{
    return combine(pool, DEA_LN, a, a);
}

/* Values of the terms from number @p first on. */
static void evaluate(const dea_term *terms, int first, int count, double symbol, double node, double *values)
{
    for (int i = first; i < count; i++) {
        const dea_term *term = &terms[i];
        values[i] = term->operation >= DEA_ADD      ? apply(term->operation, values[term->a], values[term->b])
                    : term->operation == DEA_NUMBER ? term->number
                    : term->operation == DEA_SYMBOL ? symbol
                                                    : node;
    }
}

void dea_pool_values(const dea_pool *pool, double symbol, double node, double *values)
{
    evaluate(pool->terms, 0, pool->count, symbol, node, values);
}

static void mark_needed(const dea_pool *pool, const dea_expr *refs, int count, bool *needed)
{
    for (int i = 0; i < count; i++) {
        needed[refs[i]] = true;
    }
    for (int i = pool->count - 1; i >= 0; i--) {
        if (needed[i] && pool->terms[i].operation >= DEA_ADD) {
            needed[pool->terms[i].a] = true;
            needed[pool->terms[i].b] = true;
        }
    }
}

/* Copies the needed terms, numbers first, and renumbers their operands through @p place. */
static void lay_out(const dea_pool *pool, const bool *needed, int *place, dea_tape *tape)
{
    for (int pass = 0; pass < 2; pass++) {
        for (int i = 0; i < pool->count; i++) {
            const bool number = pool->terms[i].operation == DEA_NUMBER;
            if (!needed[i] || number != (pass == 0)) {
                continue;
            }
            dea_term term = pool->terms[i];
            if (term.operation >= DEA_ADD) {
                term.a = place[term.a];
                term.b = place[term.b];
            }
            tape->values[tape->count] = term.number;
            place[i] = tape->count;
            tape->terms[tape->count++] = term;
        }
        if (pass == 0) {
            tape->moving = tape->count;
        }
    }
}

dea_status dea_tape_compile(const dea_pool *pool, const dea_expr *refs, int count, dea_tape *tape, dea_error *error)
{
    *tape = (dea_tape){0};
    if (count > DEA_TAPE_OUTPUTS) {
        return dea_fail(error, DEA_ERROR_USAGE, "a tape has at most %d outputs", DEA_TAPE_OUTPUTS);
    }
    const size_t size = (size_t)pool->count + 1;
    bool *needed = calloc(size, sizeof *needed);
    int *place = calloc(size, sizeof *place);
    tape->terms = calloc(size, sizeof *tape->terms);
    tape->values = calloc(size, sizeof *tape->values);
    tape->slopes = calloc(size, sizeof *tape->slopes);
    const bool ready = !pool->exhausted && needed && place && tape->terms && tape->values && tape->slopes;
    if (ready) {
        mark_needed(pool, refs, count, needed);
        lay_out(pool, needed, place, tape);
        for (int i = 0; i < count; i++) {
            tape->outputs[i] = place[refs[i]];
        }
        tape->output_count = count;
    }
    free(needed);
    free(place);
    if (!ready) {
        dea_tape_free(tape);
        return dea_fail(error, DEA_ERROR_MEMORY, "out of memory while a network is built");
    }
    return DEA_OK;
}

void dea_tape_free(dea_tape *tape)
{
    if (tape) {
        free(tape->terms);
        free(tape->values);
        free(tape->slopes);
        *tape = (dea_tape){0};
    }
}

void dea_tape_run(dea_tape *tape, double symbol, double node)
{
    double *restrict value = tape->values;
    double *restrict slope = tape->slopes;
    for (int i = tape->moving; i < tape->count; i++) {
        const dea_term *term = &tape->terms[i];
        const int a = term->a;
        const int b = term->b;
        switch (term->operation) {
        case DEA_NUMBER:
            break;
        case DEA_SYMBOL:
            value[i] = symbol;
            break;
        case DEA_NODE:
            value[i] = node;
            slope[i] = 1.0;
            break;
        case DEA_ADD:
            value[i] = value[a] + value[b];
            slope[i] = slope[a] + slope[b];
            break;
        case DEA_SUB:
            value[i] = value[a] - value[b];
            slope[i] = slope[a] - slope[b];
            break;
        case DEA_MUL:
            value[i] = value[a] * value[b];
            slope[i] = slope[a] * value[b] + value[a] * slope[b];
            break;
        case DEA_DIV:
            value[i] = value[a] / value[b];
            slope[i] = (slope[a] - value[i] * slope[b]) / value[b];
            break;
        case DEA_LN:
            value[i] = log(value[a]);
            slope[i] = slope[a] / value[a];
            break;
        }
    }
}

void dea_tape_run_values(dea_tape *tape, double symbol, double node)
{
    evaluate(tape->terms, tape->moving, tape->count, symbol, node, tape->values);
}
