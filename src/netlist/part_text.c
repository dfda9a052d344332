#include "netlist/part_text.h"

#include <math.h>
#include <stdarg.h>
#include <stdlib.h>
#include <string.h>

#include "support/number.h"

void dea_part_number(FILE *out, double value)
{
    char text[DEA_NUMBER_LENGTH];
    int digits = 15; /* any decimal of so few is given back by them */
    while (digits < 17 && strtod(dea_number_text(text, value, digits), NULL) != value) {
        digits++;
    }
    fputs(dea_number_text(text, value, digits), out);
}

void dea_part_print(FILE *out, const char *format, ...)
{
    va_list values;
    va_start(values, format);
    for (const char *c = format; *c; c++) {
        if (*c != '%') {
            fputc(*c, out);
        } else if (*++c == 'g') {
            dea_part_number(out, va_arg(values, double));
        } else if (*c == 's') {
            fputs(va_arg(values, const char *), out);
        } else if (*c == 'z') { /* %zu */
            fprintf(out, "%zu", va_arg(values, size_t));
            c++;
        } else if (*c == 'd') {
            fprintf(out, "%d", va_arg(values, int));
        } else {
            fputc(*c == 'c' ? va_arg(values, int) : *c, out);
        }
    }
    va_end(values);
}

void dea_part_value(FILE *out, const char *name, double value)
{
    dea_part_print(out, ".param %s=%g\n", name, value);
}

/* Places of the displacement in a term, up to MANY: what is worth a node. */
enum { WORTH = 2, MANY = 100 };

/* Which terms move, and which of those may become nodes. Newton starts with every node at 0, so a node must be 0 at rest, as
 * products of the displacement are: 0.37 stands for every symbol. */
static void mark_moving(const dea_pool *pool, dea_part_text *text, double *rest)
{
    dea_pool_values_uniform(pool, 0.37, 0.0, rest);
    for (int i = 0; i < pool->count; i++) {
        const dea_term *term = &pool->terms[i];
        const bool made = term->operation >= DEA_ADD;
        const int places = made ? text->terms[term->a].places + text->terms[term->b].places : term->operation == DEA_NODE;
        text->terms[i].places = places < MANY ? places : MANY;
        text->terms[i].moves = places > 0;
        text->terms[i].nodal = places >= WORTH && rest[i] == 0.0;
    }
    for (int i = pool->count - 1; i >= 0; i--) { /* terms stand behind those that they are made of */
        const dea_term *term = &pool->terms[i];
        if (term->operation >= DEA_ADD) {
            text->terms[term->a].divides = text->terms[term->a].divides || text->terms[i].divides || term->operation == DEA_LN;
            text->terms[term->b].divides = text->terms[term->b].divides || text->terms[i].divides || term->operation == DEA_DIV;
        }
    }
}

bool dea_part_text_open(dea_part_text *text, const dea_pool *pool, const dea_dialect *dialect, FILE *out)
{
    const size_t size = (size_t)pool->count + 1;
    *text = (dea_part_text){.pool = pool, .dialect = dialect, .out = out};
    text->terms = calloc(size, sizeof *text->terms);
    double *rest = calloc(size, sizeof *rest);
    const bool ready = !pool->exhausted && text->terms && rest;
    if (ready) {
        mark_moving(pool, text, rest);
    }
    free(rest);
    return ready;
}

void dea_part_text_close(dea_part_text *text)
{
    free(text->names);
    free(text->terms);
    free(text->roots);
    *text = (dea_part_text){0};
}

/* A parameter times or below another term. */
static bool is_scaled(const dea_part_text *text, const dea_term *term)
{
    const bool product = term->operation == DEA_MUL, quotient = term->operation == DEA_DIV;
    return ((product || quotient) && !text->terms[term->b].moves) || (product && !text->terms[term->a].moves);
}

void dea_part_text_share(dea_part_text *text)
{
    text->dividing = true;
    for (int i = 0; i < text->pool->count; i++) {
        const dea_term *term = &text->pool->terms[i];
        text->terms[i].nodal = text->terms[i].moves && term->operation >= DEA_ADD && !dea_operation_of(term->operation)->inner && !is_scaled(text, term);
    }
}

void dea_part_text_root(dea_part_text *text, const char *name)
{
    for (text->root = 1; text->root <= text->root_count; text->root++) {
        if (strcmp(text->roots[text->root - 1].name, name) == 0) {
            return;
        }
    }
    dea_part_root *roots = realloc(text->roots, ((size_t)text->root_count + 1) * sizeof *roots);
    if (!roots) {
        text->exhausted = true;
        text->root = 0;
        return;
    }
    text->roots = roots;
    dea_part_root *root = &roots[text->root_count++];
    root->count = 0;
    snprintf(root->name, sizeof root->name, "%s", name);
}

/* Integers below 1e6 are exact as literals. */
static bool is_plain(const dea_term *term)
{
    return term->operation == DEA_NUMBER && term->number >= 0.0 && term->number < 1e6 && term->number == floor(term->number);
}

static const dea_part_name *name_of(const dea_part_text *text, dea_expr ref)
{
    for (size_t i = 0; i < text->name_count; i++) {
        if (text->names[i].ref == ref) {
            return &text->names[i];
        }
    }
    return NULL;
}

void dea_part_text_name(dea_part_text *text, dea_expr ref, const char *name, const char *meaning)
{
    if (text->pool->terms[ref].operation < DEA_ADD || name_of(text, ref)) {
        return;
    }
    dea_part_name *names = realloc(text->names, (text->name_count + 1) * sizeof *names);
    if (!names) {
        text->exhausted = true;
        return;
    }
    dea_part_name *entry = &names[text->name_count++];
    entry->ref = ref;
    snprintf(entry->name, sizeof entry->name, "%s", name);
    snprintf(entry->meaning, sizeof entry->meaning, "%s", meaning);
    text->names = names;
}

static void claim(dea_part_text *text, dea_expr ref)
{
    const dea_term *term = &text->pool->terms[ref];
    if (text->terms[ref].owner == 0) {
        text->terms[ref].owner = text->root;
        if (term->operation >= DEA_ADD) {
            claim(text, term->a);
            claim(text, term->b);
        }
    }
}

void dea_part_text_call(dea_part_text *text, const dea_network *network)
{
    for (int i = 0; i < network->named_count; i++) {
        dea_part_text_name(text, network->named[i].ref, network->named[i].name, network->named[i].meaning);
    }
    for (int i = 0; i < network->element_count; i++) {
        const char *name = network->elements[i].name;
        const bool word = strncmp(name, "n_", 2) == 0 && strlen(name) > 3; /* n_a stays as it is */
        dea_part_text_root(text, word ? name + 2 : name);
        claim(text, network->elements[i].value);
    }
}

static void use(dea_part_text *text, dea_expr ref, bool in_source)
{
    const dea_term *term = &text->pool->terms[ref];
    const bool moves = text->terms[ref].moves;
    text->terms[ref].owner = text->terms[ref].owner ? text->terms[ref].owner : text->root;
    text->terms[ref].carded = text->terms[ref].carded || (in_source && !moves);
    const bool again = text->terms[ref].uses++ > 0 && (!moves || text->terms[ref].nodal); /* else it is written out each time */
    if (!again && term->operation >= DEA_ADD) {
        use(text, term->a, moves);
        if (dea_operation_of(term->operation)->operands == 2) {
            use(text, term->b, moves);
        }
    }
}

void dea_part_text_use(dea_part_text *text, dea_expr ref)
{
    use(text, ref, true);
}

/* Terms that are used already stay as they are, and so does all of a divisor: Newton starts with every node at 0. */
static void allow_nodes(dea_part_text *text, dea_expr ref)
{
    const dea_term *term = &text->pool->terms[ref];
    if (term->operation >= DEA_ADD && text->terms[ref].uses == 0) {
        text->terms[ref].nodal = text->terms[ref].nodal || (text->terms[ref].places >= WORTH && !text->terms[ref].divides);
        allow_nodes(text, term->a);
        allow_nodes(text, term->b);
    }
}

void dea_part_text_use_as_factor(dea_part_text *text, dea_expr ref)
{
    allow_nodes(text, ref);
    use(text, ref, true);
}

const char *dea_part_text_parameter(const dea_part_text *text, dea_expr ref, char name[DEA_PART_NAME])
{
    const dea_term *term = &text->pool->terms[ref];
    const dea_part_name *own = name_of(text, ref);
    if (is_plain(term)) {
        snprintf(name, DEA_PART_NAME, "%d", (int)term->number);
    } else if (term->operation == DEA_SYMBOL) {
        snprintf(name, DEA_PART_NAME, "%s", text->symbols[term->a]);
    } else if (own) {
        snprintf(name, DEA_PART_NAME, "%s", own->name);
    } else if (text->terms[ref].owner) {
        snprintf(name, DEA_PART_NAME, "%s_%d", text->roots[text->terms[ref].owner - 1].name, text->terms[ref].number);
    } else {
        snprintf(name, DEA_PART_NAME, "%c%d", text->terms[ref].moves ? 'x' : 'p', ref);
    }
    return name;
}

static int precedence(const dea_term *term)
{
    return dea_operation_of(term->operation)->precedence;
}

/* An expression on its way out: a behavioural source refers to parameters otherwise than a .param card, and in a divisor nothing
 * is a node of its own, since an iterate of a node can pass through 0 where its square of the displacement cannot. */
typedef struct stream {
    const dea_part_text *text;
    bool source;
    bool divisor;
} stream;

static void write_term(const stream *s, dea_expr ref);

/* Terms that move with the swept scalar alone are the same for all nodes. */
static const char *suffix_of(const dea_part_text *text, dea_expr ref)
{
    return text->suffix && text->terms[ref].places > 0 ? text->suffix : "";
}

static void write_operand(const stream *s, dea_expr ref, bool brackets)
{
    const dea_part_text *t = s->text;
    const dea_term *term = &t->pool->terms[ref];
    char name[DEA_PART_NAME];
    if (t->terms[ref].moves && t->terms[ref].written && (t->dividing || !s->divisor || t->terms[ref].places == 0)) {
        fprintf(t->out, "v(%s%s)", dea_part_text_parameter(t, ref, name), suffix_of(t, ref));
    } else if (term->operation == DEA_NODE) {
        fputs(t->nodes ? t->nodes[term->a] : t->node, t->out);
    } else if (is_plain(term)) {
        fprintf(t->out, "%d", (int)term->number);
    } else if (term->operation == DEA_SYMBOL && t->terms[ref].moves) {
        fputs(t->symbols[term->a], t->out);
    } else if (s->source && !t->terms[ref].moves) {
        dea_dialect_parameter(t->dialect, t->out, dea_part_text_parameter(t, ref, name));
    } else if (term->operation == DEA_SYMBOL || (t->terms[ref].written && !t->terms[ref].moves)) {
        fputs(dea_part_text_parameter(t, ref, name), t->out);
    } else if (term->operation == DEA_NUMBER) {
        fputs(term->number < 0.0 ? "(" : "", t->out);
        dea_part_number(t->out, term->number);
        fputs(term->number < 0.0 ? ")" : "", t->out);
    } else {
        fputs(brackets ? "(" : "", t->out);
        write_term(s, ref);
        fputs(brackets ? ")" : "", t->out);
    }
}

/* A term whose operands are to be written. */
typedef struct written_term {
    const stream *stream;
    const dea_term *term;
} written_term;

static void write_side(void *user, int side)
{
    const written_term *w = user;
    const dea_part_text *t = w->stream->text;
    const dea_operation_row *row = dea_operation_of(w->term->operation);
    const dea_expr ref = side == 0 ? w->term->a : w->term->b;
    const int its = precedence(&t->pool->terms[ref]);
    const bool brackets = row->precedence < 3 && (its < row->precedence || (side == 1 && row->strict && its == row->precedence));
    const stream behind = {t, w->stream->source, w->stream->divisor || (side == 1 && w->term->operation == DEA_DIV)};
    write_operand(&behind, ref, brackets);
}

/* Writes what a term is made of. */
static void write_term(const stream *s, dea_expr ref)
{
    const dea_part_text *t = s->text;
    const dea_term *term = &t->pool->terms[ref];
    if (term->operation < DEA_ADD) {
        write_operand(s, ref, false);
    } else {
        dea_dialect_operation(t->dialect, t->out, term->operation, t->terms[ref].moves, write_side, &(written_term){s, term});
    }
}

/* Named, shared, or used by a source; numbers and symbols only where a source needs them and they are not names already. Of
 * numbers only what sources use is of use. */
static bool gets_card(const dea_part_text *text, dea_expr ref)
{
    const dea_term *term = &text->pool->terms[ref];
    if (text->terms[ref].uses == 0 || text->terms[ref].moves || is_plain(term) || (term->operation == DEA_SYMBOL && !text->values)) {
        return false;
    }
    return text->terms[ref].carded ||
           (!text->values && term->operation >= DEA_ADD && (text->terms[ref].uses > 1 || name_of(text, ref)));
}

static void write_meaning(const dea_part_text *text, dea_expr ref)
{
    const dea_part_name *own = name_of(text, ref);
    if (own && *own->meaning) {
        dea_dialect_comment(text->out, own->meaning);
    }
}

/* Its number among those of its root. */
static void give_number(dea_part_text *text, dea_expr ref)
{
    if (text->terms[ref].owner && text->terms[ref].number == 0 && text->pool->terms[ref].operation != DEA_SYMBOL && !name_of(text, ref)) {
        text->terms[ref].number = ++text->roots[text->terms[ref].owner - 1].count;
    }
}

static bool gets_node(const dea_part_text *text, dea_expr ref)
{
    return text->terms[ref].nodal && (text->terms[ref].factor || text->terms[ref].uses > 1);
}

/* What sources refer to first, so that they read the same with numbers and with formulas. */
static void number_terms(dea_part_text *text)
{
    for (int pass = 0; pass < 3; pass++) {
        for (int i = 0; i < text->pool->count; i++) {
            const bool its = pass == 0 ? gets_node(text, i) : gets_card(text, i) && text->terms[i].carded == (pass == 1);
            if (its) {
                give_number(text, i);
            }
        }
    }
}

/* Cards for the parameters at the border of what moves. */
static void card_aside(dea_part_text *text, dea_expr ref)
{
    const dea_term *term = &text->pool->terms[ref];
    if (!text->terms[ref].moves) {
        use(text, ref, true);
    } else if (term->operation >= DEA_ADD) {
        card_aside(text, term->a);
        card_aside(text, term->b);
    }
}

void dea_part_text_use_aside(dea_part_text *text, dea_expr ref)
{
    number_terms(text);
    card_aside(text, ref);
}

static void write_card(const dea_part_text *text, dea_expr ref)
{
    const stream s = {text, false, false};
    char name[DEA_PART_NAME];
    (void)dea_part_text_parameter(text, ref, name);
    if (text->values) {
        dea_part_value(text->out, name, text->values[ref]);
        return;
    }
    fprintf(text->out, ".param %s={", name);
    write_term(&s, ref);
    fputs("}\n", text->out);
}

void dea_part_text_parameters(dea_part_text *text)
{
    number_terms(text);
    for (int i = 0; i < text->pool->count; i++) {
        if (gets_card(text, i)) {
            write_meaning(text, i);
            write_card(text, i);
            text->terms[i].written = true;
        }
    }
}

void dea_part_text_move_symbol(dea_part_text *text, int index)
{
    for (int i = 0; i < text->pool->count; i++) {
        const dea_term *term = &text->pool->terms[i];
        const bool made = term->operation >= DEA_ADD;
        const bool swept = made ? text->terms[term->a].moves || text->terms[term->b].moves : term->operation == DEA_SYMBOL && term->a == index;
        text->terms[i].moves = text->terms[i].moves || swept;
        text->terms[i].nodal = text->terms[i].nodal || (made && swept && text->terms[i].places == 0 && !dea_expr_is_scaled(text->pool, i));
    }
}

static void write_node(dea_part_text *text, dea_expr ref)
{
    const stream s = {text, true, false};
    char own[DEA_PART_NAME], name[2 * DEA_PART_NAME];
    write_meaning(text, ref);
    snprintf(name, sizeof name, "%s%s", dea_part_text_parameter(text, ref, own), suffix_of(text, ref));
    dea_dialect_source_begin(text->dialect, text->out, DEA_VOLTAGE, name, name, "0");
    write_term(&s, ref);
    dea_dialect_source_end(text->dialect, text->out);
    text->terms[ref].written = true;
}

void dea_part_text_nodes(dea_part_text *text)
{
    for (int i = 0; i < text->pool->count; i++) {
        if (gets_node(text, i)) {
            write_node(text, i);
        }
    }
}

void dea_part_text_start(const dea_part_text *text, const char *inside, const double *values)
{
    for (int i = 0; i < text->pool->count; i++) {
        if (text->terms[i].written && text->terms[i].moves) {
            char name[DEA_PART_NAME];
            fprintf(text->out, " v(%s%s)=", inside, dea_part_text_parameter(text, i, name));
            dea_part_number(text->out, values[i]);
        }
    }
}

void dea_part_text_swept(dea_part_text *text)
{
    for (int i = 0; i < text->pool->count; i++) {
        if (text->terms[i].nodal && text->terms[i].places == 0 && text->terms[i].uses > 0) {
            write_node(text, i);
        }
    }
}

void dea_part_text_nodes_of(dea_part_text *text, dea_expr ref)
{
    const dea_term *term = &text->pool->terms[ref];
    if (text->terms[ref].moves && !text->terms[ref].written && term->operation >= DEA_ADD) {
        dea_part_text_nodes_of(text, term->a);
        dea_part_text_nodes_of(text, term->b);
        if (gets_node(text, ref)) {
            write_node(text, ref);
        }
    }
}

void dea_part_text_again(dea_part_text *text)
{
    for (int i = 0; i < text->pool->count; i++) {
        text->terms[i].written = text->terms[i].written && !(text->terms[i].moves && text->terms[i].places > 0);
    }
}

void dea_part_text_write(const dea_part_text *text, dea_expr ref)
{
    const stream s = {text, true, false};
    write_operand(&s, ref, precedence(&text->pool->terms[ref]) < 2);
}

static void write_format(const dea_part_text *text, const char *format, va_list terms)
{
    for (const char *c = format; *c; c++) {
        const char *end = *c == '[' ? strchr(c, ']') : NULL;
        if (!end) {
            fputc(*c, text->out);
            continue;
        }
        if (end == c + 1) {
            dea_part_text_write(text, va_arg(terms, dea_expr));
        } else {
            char name[DEA_PART_NAME];
            snprintf(name, sizeof name, "%.*s", (int)(end - c - 1), c + 1);
            dea_dialect_parameter(text->dialect, text->out, name);
        }
        c = end;
    }
}

void dea_part_text_format(const dea_part_text *text, const char *format, ...)
{
    va_list terms;
    va_start(terms, format);
    write_format(text, format, terms);
    va_end(terms);
}

void dea_part_text_source(const dea_part_text *text, dea_quantity quantity, const char *name, const char *plus, const char *minus,
                          const char *format, ...)
{
    va_list terms;
    va_start(terms, format);
    dea_dialect_source_begin(text->dialect, text->out, quantity, name, plus, minus);
    write_format(text, format, terms);
    dea_dialect_source_end(text->dialect, text->out);
    va_end(terms);
}
