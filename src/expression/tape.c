#include "expression/tape.h"

#include <stdlib.h>

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

static dea_tape_span join(dea_tape_span a, dea_tape_span b)
{
    if (a.count == 0 || b.count == 0) {
        return a.count == 0 ? b : a;
    }
    const int first = a.first < b.first ? a.first : b.first;
    const int end_a = a.first + a.count, end_b = b.first + b.count;
    return (dea_tape_span){.first = first, .count = (end_a > end_b ? end_a : end_b) - first};
}

/* Notes which nodes each term depends on; how many derivatives that makes in all. */
static size_t span(dea_tape *tape)
{
    size_t size = 0;
    for (int i = 0; i < tape->count; i++) {
        const dea_term *term = &tape->terms[i];
        dea_tape_span own = {0};
        if (term->operation == DEA_NODE) {
            own = (dea_tape_span){.first = term->a, .count = 1};
        } else if (term->operation >= DEA_ADD) {
            own = join(tape->spans[term->a], tape->spans[term->b]);
        }
        own.place = size;
        tape->spans[i] = own;
        size += (size_t)own.count;
    }
    return size;
}

static bool allocate(dea_tape *tape, size_t size, int outputs)
{
    tape->terms = calloc(size, sizeof *tape->terms);
    tape->values = calloc(size, sizeof *tape->values);
    tape->slopes = calloc(size, sizeof *tape->slopes);
    tape->spans = calloc(size, sizeof *tape->spans);
    tape->outputs = calloc((size_t)outputs + 1, sizeof *tape->outputs);
    return tape->terms && tape->values && tape->slopes && tape->spans && tape->outputs;
}

/* The terms of a tape that has room for them; false without memory for the gradients. */
static bool fill(const dea_pool *pool, const dea_expr *refs, int count, bool *needed, int *place, dea_tape *tape)
{
    mark_needed(pool, refs, count, needed);
    lay_out(pool, needed, place, tape);
    for (int i = 0; i < count; i++) {
        tape->outputs[i] = place[refs[i]];
    }
    tape->output_count = count;
    tape->gradients = calloc(span(tape) + 1, sizeof *tape->gradients);
    return tape->gradients != NULL;
}

static dea_status check_indices(const dea_tape *tape, int symbols, int nodes, dea_error *error)
{
    for (int i = tape->moving; i < tape->count; i++) {
        const dea_term *term = &tape->terms[i];
        const bool leaf = term->operation < DEA_ADD;
        const int most = term->operation == DEA_SYMBOL ? symbols : nodes;
        if (leaf && !(term->a >= 0 && term->a < most)) {
            return dea_fail(error, DEA_ERROR_USAGE, "an expression holds %s number %d, its network has %d",
                            dea_operation_of(term->operation)->name, term->a, most);
        }
    }
    return DEA_OK;
}

dea_status dea_tape_compile_many(const dea_pool *pool, const dea_expr *refs, int count, int symbols, int nodes, dea_tape *tape,
                                 dea_error *error)
{
    const size_t size = (size_t)pool->count + 1;
    bool *needed = calloc(size, sizeof *needed);
    int *place = calloc(size, sizeof *place);
    *tape = (dea_tape){0};
    const bool ready =
        !pool->exhausted && needed && place && allocate(tape, size, count) && fill(pool, refs, count, needed, place, tape);
    free(needed);
    free(place);
    const dea_status status = ready ? check_indices(tape, symbols, nodes, error)
                                    : dea_fail(error, DEA_ERROR_MEMORY, "out of memory while a network is built");
    if (status != DEA_OK) {
        dea_tape_free(tape);
    }
    return status;
}

dea_status dea_tape_compile(const dea_pool *pool, const dea_expr *refs, int count, dea_tape *tape, dea_error *error)
{
    return dea_tape_compile_many(pool, refs, count, 1, 1, tape, error);
}

void dea_tape_free(dea_tape *tape)
{
    if (tape) {
        free(tape->terms);
        free(tape->values);
        free(tape->slopes);
        free(tape->spans);
        free(tape->gradients);
        free(tape->outputs);
        *tape = (dea_tape){0};
    }
}

/* One term's operation: x and y are the values of its operands, dx and dy their slopes. */
#define OPERANDS                                                                                                                 \
    const double x = value[term->a], y = value[term->b];                                                                         \
    (void)y
#define SLOPES                                                                                                                   \
    const double dx = slope[term->a], dy = slope[term->b];                                                                       \
    (void)dy

void dea_tape_along(dea_tape *tape, const double *symbols, const double *nodes, const double *symbol_direction,
                    const double *node_direction)
{
    double *restrict value = tape->values;
    double *restrict slope = tape->slopes;
    for (int i = tape->moving; i < tape->count; i++) {
        const dea_term *term = &tape->terms[i];
        switch (term->operation) {
        case DEA_SYMBOL:
            value[i] = symbols[term->a];
            slope[i] = symbol_direction ? symbol_direction[term->a] : 0.0;
            break;
        case DEA_NODE:
            value[i] = nodes[term->a];
            slope[i] = node_direction ? node_direction[term->a] : 0.0;
            break;
#define X(NAME, COUNT, VALUE, SLOPE, DERIVATIVE, CHANGE)                                                                         \
    case DEA_##NAME: {                                                                                                           \
        OPERANDS;                                                                                                                \
        SLOPES;                                                                                                                  \
        const double v = VALUE;                                                                                                  \
        value[i] = v;                                                                                                            \
        slope[i] = SLOPE;                                                                                                        \
        break;                                                                                                                   \
    }
            DEA_OPERATION_LIST(X)
#undef X
        case DEA_NUMBER:
        case DEA_OPERATIONS:
            break;
        }
    }
}

void dea_tape_values(dea_tape *tape, const double *symbols, const double *nodes)
{
    double *restrict value = tape->values;
    for (int i = tape->moving; i < tape->count; i++) {
        const dea_term *term = &tape->terms[i];
        switch (term->operation) {
        case DEA_SYMBOL:
            value[i] = symbols[term->a];
            break;
        case DEA_NODE:
            value[i] = nodes[term->a];
            break;
#define X(NAME, COUNT, VALUE, SLOPE, DERIVATIVE, CHANGE)                                                                         \
    case DEA_##NAME: {                                                                                                           \
        OPERANDS;                                                                                                                \
        value[i] = VALUE;                                                                                                        \
        break;                                                                                                                   \
    }
            DEA_OPERATION_LIST(X)
#undef X
        case DEA_NUMBER:
        case DEA_OPERATIONS:
            break;
        }
    }
}

/* Derivative of a term over one node, 0 where it does not depend on it. */
static inline double derivative_over(const dea_tape *tape, int term, int node)
{
    const dea_tape_span span = tape->spans[term];
    const int at = node - span.first;
    return at >= 0 && at < span.count ? tape->gradients[span.place + (size_t)at] : 0.0;
}

void dea_tape_gradients(dea_tape *tape, const double *symbols, const double *nodes)
{
    const double *value = tape->values;
    dea_tape_values(tape, symbols, nodes);
    for (int i = tape->moving; i < tape->count; i++) {
        const dea_term *term = &tape->terms[i];
        const dea_tape_span span = tape->spans[i];
        double *own = tape->gradients + span.place;
        switch (term->operation) {
        case DEA_NODE:
            own[0] = 1.0;
            break;
#define X(NAME, COUNT, VALUE, SLOPE, DERIVATIVE, CHANGE)                                                                         \
    case DEA_##NAME: {                                                                                                           \
        OPERANDS;                                                                                                                \
        const double v = value[i];                                                                                               \
        (void)v, (void)x;                                                                                                        \
        for (int k = 0; k < span.count; k++) {                                                                                   \
            const double dx = derivative_over(tape, term->a, span.first + k);                                                    \
            const double dy = COUNT == 2 ? derivative_over(tape, term->b, span.first + k) : 0.0;                                 \
            (void)dy;                                                                                                            \
            own[k] = SLOPE;                                                                                                      \
        }                                                                                                                        \
        break;                                                                                                                   \
    }
            DEA_OPERATION_LIST(X)
#undef X
        case DEA_NUMBER:
        case DEA_SYMBOL:
        case DEA_OPERATIONS:
            break;
        }
    }
}

void dea_tape_run(dea_tape *tape, double symbol, double node)
{
    static const double along = 1.0;
    dea_tape_along(tape, &symbol, &node, NULL, &along);
}

void dea_tape_run_values(dea_tape *tape, double symbol, double node)
{
    dea_tape_values(tape, &symbol, &node);
}
