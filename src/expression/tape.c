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

static bool allocate(dea_tape *tape, size_t size, int outputs)
{
    tape->terms = calloc(size, sizeof *tape->terms);
    tape->values = calloc(size, sizeof *tape->values);
    tape->slopes = calloc(size, sizeof *tape->slopes);
    tape->outputs = calloc((size_t)outputs + 1, sizeof *tape->outputs);
    return tape->terms && tape->values && tape->slopes && tape->outputs;
}

/* The terms of a tape that has room for them. */
static void fill(const dea_pool *pool, const dea_expr *refs, int count, bool *needed, int *place, dea_tape *tape)
{
    mark_needed(pool, refs, count, needed);
    lay_out(pool, needed, place, tape);
    for (int i = 0; i < count; i++) {
        tape->outputs[i] = place[refs[i]];
    }
    tape->output_count = count;
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
    const bool ready = !pool->exhausted && needed && place && allocate(tape, size, count);
    if (ready) {
        fill(pool, refs, count, needed, place, tape);
    }
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

void dea_tape_run(dea_tape *tape, double symbol, double node)
{
    static const double along = 1.0;
    dea_tape_along(tape, &symbol, &node, NULL, &along);
}

void dea_tape_run_values(dea_tape *tape, double symbol, double node)
{
    dea_tape_values(tape, &symbol, &node);
}
