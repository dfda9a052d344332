/* Every number of a B source stands in a .param: literals inside B expressions keep 11 digits only. Expressions use + - * /
 * alone. */
#include "netlist/netlist.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>

#include "support/number.h"

typedef struct writer {
    const dea_pool *pool;
    FILE *out;
    int *uses;    /* owned: how often an expression of the netlist uses the term */
    bool *named;  /* owned: it has a node of its own */
    double *rest; /* owned: values of all terms at the first point, film at rest */
} writer;

static void number(FILE *out, double value)
{
    char text[DEA_NUMBER_LENGTH];
    fputs(dea_number_text(text, value, 17), out);
}

/* Integers below 1e6 are exact as literals. */
static bool is_plain(double value)
{
    return value >= 0.0 && value < 1e6 && value == floor(value);
}

static int precedence(const dea_term *term)
{
    return term->operation == DEA_ADD || term->operation == DEA_SUB ? 1 : term->operation >= DEA_MUL ? 2 : 3;
}

static void expression(const writer *w, dea_expr ref, bool as_node);

static void operand(const writer *w, dea_expr ref, bool brackets)
{
    if (brackets && !w->named[ref]) {
        fputc('(', w->out);
        expression(w, ref, true);
        fputc(')', w->out);
    } else {
        expression(w, ref, true);
    }
}

/* Writes a term; as_node: by its node where it has one. A parameter is put in as text, so a negative one stands in brackets. */
static void expression(const writer *w, dea_expr ref, bool as_node)
{
    const dea_term *term = &w->pool->terms[ref];
    if (term->operation == DEA_NUMBER) {
        if (is_plain(term->number)) {
            fprintf(w->out, "%d", (int)term->number);
        } else {
            fprintf(w->out, term->number < 0.0 ? "({p%d})" : "{p%d}", ref);
        }
    } else if (term->operation == DEA_SYMBOL) {
        fputs("v(axis)", w->out);
    } else if (term->operation == DEA_NODE) {
        fputs("v(edge)", w->out);
    } else if (as_node && w->named[ref]) {
        fprintf(w->out, "v(x%d)", ref);
    } else {
        static const char signs[] = {[DEA_ADD] = '+', [DEA_SUB] = '-', [DEA_MUL] = '*', [DEA_DIV] = '/'};
        const int mine = precedence(term);
        const bool strict = term->operation == DEA_SUB || term->operation == DEA_DIV;
        const int right = precedence(&w->pool->terms[term->b]);
        operand(w, term->a, precedence(&w->pool->terms[term->a]) < mine);
        fputc(signs[term->operation], w->out);
        operand(w, term->b, right < mine || (right == mine && strict));
    }
}

static void count_uses(const writer *w, dea_expr ref)
{
    const dea_term *term = &w->pool->terms[ref];
    if (w->uses[ref]++ == 0 && term->operation >= DEA_ADD) {
        count_uses(w, term->a);
        count_uses(w, term->b);
    }
}

/* Terms that would otherwise be written out again get a node: ngspice differentiates every expression by each of its nodes, so
 * short ones are worth it, all but a mere number times another term. */
static void name_shared(const writer *w)
{
    for (int i = 0; i < w->pool->count; i++) {
        const dea_term *term = &w->pool->terms[i];
        if (term->operation >= DEA_ADD) {
            const bool scaled = term->operation == DEA_MUL && w->pool->terms[term->a].operation == DEA_NUMBER;
            w->named[i] = w->uses[i] > 1 && !scaled;
        }
    }
}

static void write_shared(const writer *w)
{
    for (int i = 0; i < w->pool->count; i++) {
        if (w->uses[i] > 0 && w->named[i]) {
            fprintf(w->out, "bx%d x%d 0 v=", i, i);
            expression(w, i, false);
            fputc('\n', w->out);
        }
    }
}

static void write_parameters(const writer *w)
{
    for (int i = 0; i < w->pool->count; i++) {
        const dea_term *term = &w->pool->terms[i];
        if (w->uses[i] > 0 && term->operation == DEA_NUMBER && !is_plain(term->number)) {
            fprintf(w->out, ".param p%d=", i);
            number(w->out, term->number);
            fputc('\n', w->out);
        }
    }
}

/* The swept scalar as a voltage of the index k, so that no rounding adds up along a sweep. */
static void write_axis(const writer *w, const dea_netlist_study *study)
{
    const dea_axis *axis = study->axis;
    fputs("vindex k 0 0\n", w->out);
    if (!axis) {
        return;
    }
    if (axis->uniform && axis->count > 1) {
        fputs(".param axis_from=", w->out);
        number(w->out, axis->values[0]);
        fputs(" axis_span=", w->out);
        number(w->out, axis->values[axis->count - 1] - axis->values[0]);
        fputs(" axis_last=", w->out);
        number(w->out, (double)(axis->count - 1));
        fputs("\nbaxis axis 0 v=({axis_from})+({axis_span})*v(k)/{axis_last}\n", w->out);
        return;
    }
    for (size_t i = 0; i < study->count; i++) {
        fprintf(w->out, ".param a%zu=", i);
        number(w->out, axis->values[study->from + i]);
        fputc('\n', w->out);
    }
    if (study->count == 1) {
        fputs("vaxis axis 0 {a0}\n", w->out);
        return;
    }
    fputs("baxis axis 0 v=pwl(v(k)", w->out);
    for (size_t i = 0; i < study->count; i++) {
        fprintf(w->out, ",%zu,{a%zu}", study->from + i, i);
    }
    fputs(")\n", w->out);
}

/* The springs are parallel and nobody asks for their single forces, so they are written as one. */
static void write_forces(const writer *w, const dea_network *network, dea_expr elastic, dea_expr load,
                         const dea_netlist_study *study)
{
    for (int i = 0; i < network->element_count; i++) {
        fprintf(w->out, "* %s: %s\n", network->elements[i].name, network->elements[i].meaning);
    }
    fputs("* elastic force of all springs [N], from the edge to the frame\nbspring edge 0 i=", w->out);
    expression(w, elastic, true);
    fputs("\n* electrostatic force f_dea [N], onto the edge\nbforce 0 edge i=", w->out);
    const bool sum = precedence(&w->pool->terms[load]) < 2;
    if (study->ramp) {
        operand(w, load, sum);
        fprintf(w->out, "*v(k)/%zu", study->ramp);
    } else {
        expression(w, load, true);
    }
    fputc('\n', w->out);
}

/* Where Newton starts: the first point at rest, without voltage on the mechanics. Zeros would be divided by. */
static void write_start(const writer *w, const dea_netlist_study *study)
{
    fputs(".nodeset v(edge)=0", w->out);
    if (study->axis) {
        fputs(" v(axis)=", w->out);
        number(w->out, study->axis->values[study->from]);
    }
    for (int i = 0; i < w->pool->count; i++) {
        if (w->uses[i] > 0 && w->named[i]) {
            fprintf(w->out, " v(x%d)=", i);
            number(w->out, w->rest[i]);
        }
    }
    fputc('\n', w->out);
}

static void write_all(writer *w, const dea_network *network, dea_expr elastic, dea_expr load, const dea_netlist_study *study)
{
    fputs("* dielectric elastomer actuator: v(edge) = displacement of the disc edge [m], current = force [N]\n", w->out);
    write_parameters(w);
    write_axis(w, study);
    write_shared(w);
    write_forces(w, network, elastic, load, study);
    write_start(w, study);
    fputs(".options itl1=60 itl2=60 gminsteps=0 srcsteps=0 reltol=", w->out);
    number(w->out, study->tolerance);
    fputs(" vntol=", w->out);
    number(w->out, 1e-21 * study->length_scale);
    fputs(" abstol=", w->out);
    number(w->out, 1e-21 * study->force_scale);
    fputs("\n.save v(edge)\n", w->out);
    const size_t last = study->ramp ? study->ramp : study->from + study->count - 1;
    fprintf(w->out, ".dc vindex %zu %zu 1\n.end\n", study->ramp ? 0 : study->from, last);
}

dea_status dea_netlist_write(dea_network *network, const dea_netlist_study *study, char **text, dea_error *error)
{
    const dea_expr elastic = dea_network_elastic(network);
    const dea_expr load = dea_network_load(network);
    const size_t size = (size_t)network->pool.count;
    size_t length = 0;
    writer w = {.pool = &network->pool};
    *text = NULL;
    w.uses = calloc(size, sizeof *w.uses);
    w.named = calloc(size, sizeof *w.named);
    w.rest = calloc(size, sizeof *w.rest);
    w.out = open_memstream(text, &length);
    const bool ready = !network->pool.exhausted && w.uses && w.named && w.rest && w.out;
    if (ready) {
        count_uses(&w, elastic);
        count_uses(&w, load);
        name_shared(&w);
        dea_pool_values(w.pool, study->axis ? study->axis->values[study->from] : 0.0, 0.0, w.rest);
        write_all(&w, network, elastic, load, study);
    }
    const bool written = w.out && !ferror(w.out) && fclose(w.out) == 0;
    free(w.uses);
    free(w.named);
    free(w.rest);
    if (!ready || !written) {
        free(*text);
        *text = NULL;
        return dea_fail(error, DEA_ERROR_MEMORY, "out of memory while a netlist is written");
    }
    return DEA_OK;
}
