#include "netlist/expression_text.h"

#include <math.h>
#include <stdlib.h>

#include "support/number.h"

void dea_netlist_number(FILE *out, double value)
{
    char text[DEA_NUMBER_LENGTH];
    fputs(dea_number_text(text, value, 17), out);
}

bool dea_expression_text_open(dea_expression_text *text, const dea_pool *pool, FILE *out, const char *node)
{
    const size_t size = (size_t)pool->count + 1;
    *text = (dea_expression_text){.pool = pool, .dialect = dea_dialect_at(0), .out = out, .node = node};
    text->uses = calloc(size, sizeof *text->uses);
    text->named = calloc(size, sizeof *text->named);
    text->rest = calloc(size, sizeof *text->rest);
    return !pool->exhausted && text->uses && text->named && text->rest;
}

void dea_expression_text_close(dea_expression_text *text)
{
    free(text->uses);
    free(text->named);
    free(text->rest);
    *text = (dea_expression_text){0};
}

/* Integers below 1e6 are exact as literals. */
static bool is_plain(double value)
{
    return value >= 0.0 && value < 1e6 && value == floor(value);
}

static int precedence(const dea_term *term)
{
    return dea_operation_of(term->operation)->precedence;
}

static void expression(const dea_expression_text *t, dea_expr ref, bool as_node);

static void operand(const dea_expression_text *t, dea_expr ref, bool brackets)
{
    if (brackets && !t->named[ref]) {
        fputc('(', t->out);
        expression(t, ref, true);
        fputc(')', t->out);
    } else {
        expression(t, ref, true);
    }
}

/* A term whose operands are to be written. */
typedef struct written_term {
    const dea_expression_text *text;
    const dea_term *term;
} written_term;

static void write_side(void *user, int side)
{
    const written_term *w = user;
    const dea_operation_row *row = dea_operation_of(w->term->operation);
    const dea_expr ref = side == 0 ? w->term->a : w->term->b;
    const int its = precedence(&w->text->pool->terms[ref]);
    const bool brackets = row->precedence < 3 && (its < row->precedence || (side == 1 && row->strict && its == row->precedence));
    operand(w->text, ref, brackets);
}

/* Writes a term; as_node: by its node where it has one. A parameter is put in as text, so a negative one stands in brackets. */
static void expression(const dea_expression_text *t, dea_expr ref, bool as_node)
{
    const dea_term *term = &t->pool->terms[ref];
    if (term->operation == DEA_NUMBER) {
        if (is_plain(term->number)) {
            fprintf(t->out, "%d", (int)term->number);
        } else {
            fprintf(t->out, term->number < 0.0 ? "({p%d})" : "{p%d}", ref);
        }
    } else if (term->operation == DEA_SYMBOL) {
        fputs("v(axis)", t->out);
    } else if (term->operation == DEA_NODE) {
        fputs(t->node, t->out);
    } else if (as_node && t->named[ref]) {
        fprintf(t->out, "v(x%d)", ref);
    } else {
        dea_dialect_operation(t->dialect, t->out, term->operation, true, write_side, &(written_term){t, term});
    }
}

void dea_expression_text_write(const dea_expression_text *text, dea_expr ref)
{
    expression(text, ref, true);
}

void dea_expression_text_factor(const dea_expression_text *text, dea_expr ref)
{
    operand(text, ref, precedence(&text->pool->terms[ref]) < 2);
}

void dea_expression_text_use(dea_expression_text *text, dea_expr ref)
{
    const dea_term *term = &text->pool->terms[ref];
    const bool again = text->uses[ref]++ > 0 && !dea_expr_is_scaled(text->pool, ref); /* that is written out each time */
    if (!again && term->operation >= DEA_ADD) {
        dea_expression_text_use(text, term->a);
        if (dea_operation_of(term->operation)->operands == 2) {
            dea_expression_text_use(text, term->b);
        }
    }
}

/* Terms that would otherwise be written out again get a node: ngspice differentiates every expression by each of its nodes, so
 * short ones are worth it, all but a mere number times another term. */
void dea_expression_text_share(dea_expression_text *text)
{
    for (int i = 0; i < text->pool->count; i++) {
        if (text->pool->terms[i].operation >= DEA_ADD) {
            text->named[i] = text->uses[i] > 1 && !dea_expr_is_scaled(text->pool, i);
        }
    }
}

static bool has_node(const dea_expression_text *text, int term)
{
    return text->uses[term] > 0 && text->named[term];
}

void dea_expression_text_nodes(const dea_expression_text *text)
{
    for (int i = 0; i < text->pool->count; i++) {
        if (has_node(text, i)) {
            fprintf(text->out, "BX%d x%d 0 v=", i, i);
            expression(text, i, false);
            fputc('\n', text->out);
        }
    }
}

void dea_expression_text_parameters(const dea_expression_text *text)
{
    for (int i = 0; i < text->pool->count; i++) {
        const dea_term *term = &text->pool->terms[i];
        if (text->uses[i] > 0 && term->operation == DEA_NUMBER && !is_plain(term->number)) {
            fprintf(text->out, ".param p%d=", i);
            dea_netlist_number(text->out, term->number);
            fputc('\n', text->out);
        }
    }
}

void dea_expression_text_start(dea_expression_text *text, double symbol, double node)
{
    dea_pool_values(text->pool, symbol, node, text->rest);
    for (int i = 0; i < text->pool->count; i++) {
        if (has_node(text, i)) {
            fprintf(text->out, " v(x%d)=", i);
            dea_netlist_number(text->out, text->rest[i]);
        }
    }
}
