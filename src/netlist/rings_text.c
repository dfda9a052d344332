#include "netlist/rings_text.h"

#include <ctype.h>
#include <math.h>


dea_rings_label dea_rings_label_of(const char *name, size_t number)
{
    dea_rings_label l;
    snprintf(l.text, sizeof l.text, "%s%zu", name, number);
    return l;
}

dea_rings_label dea_rings_node(const dea_rings_writer *w, char kind, size_t node)
{
    const char name[] = {kind, '\0'};
    if (w->pinned && node == w->cards->edge) {
        return kind == 'v' ? (dea_rings_label){"edge"} : (dea_rings_label){"u"};
    }
    return dea_rings_label_of(name, node);
}

dea_rings_label dea_rings_parameter(const dea_rings_writer *w, dea_expr ref)
{
    char own[DEA_PART_NAME];
    dea_rings_label l;
    snprintf(l.text, sizeof l.text, "%s", dea_part_text_parameter(w->text, ref, own));
    return l;
}

/* Names of elements are in capitals: editors of circuits want that. */
static dea_rings_label capital(const char *name)
{
    dea_rings_label l;
    size_t i = 0;
    for (; name[i] && i + 1 < sizeof l.text; i++) {
        l.text[i] = (char)toupper((unsigned char)name[i]);
    }
    l.text[i] = '\0';
    return l;
}

void dea_rings_enter(const dea_rings_writer *w, dea_rings_place *place, size_t number, const char *mark)
{
    snprintf(place->suffix, sizeof place->suffix, "_%zu%s", number, mark);
    w->text->nodes = place->nodes;
    w->text->suffix = place->suffix;
}

void dea_rings_leave(const dea_rings_writer *w)
{
    dea_part_text_again(w->text);
    w->text->nodes = NULL;
    w->text->suffix = NULL;
}

void dea_rings_begin(const dea_rings_writer *w, const char *node)
{
    dea_dialect_source_begin(w->text->dialect, w->out, DEA_VOLTAGE, node, node, "0");
}

void dea_rings_end(const dea_rings_writer *w)
{
    dea_dialect_source_end(w->text->dialect, w->out);
}

void dea_rings_source(const dea_rings_writer *w, const char *node, dea_expr ref)
{
    dea_part_text_nodes_of(w->text, ref);
    dea_rings_begin(w, node);
    dea_part_text_write(w->text, ref);
    dea_rings_end(w);
}

void dea_rings_lever(const dea_rings_writer *w, const char *element, const char *from, const char *to, const char *control,
                     double slope, const char *factor)
{
    fprintf(w->out, "G%s %s %s %s 0 {", capital(element).text, from, to, control);
    dea_part_number(w->out, slope);
    fprintf(w->out, factor ? "*%s}\n" : "}\n", factor);
}

void dea_rings_sum(const dea_rings_writer *w, const char *node)
{
    fprintf(w->out, "R%s %s 0 1\n", capital(node).text, node);
}

/* Nodes that strain a ring: number, and its column of the slopes. */
static bool strains(const dea_rings_writer *w, const dea_rings_ring *ring, size_t column, size_t *node, double *slope)
{
    *node = ring->first + column;
    *slope = w->cards->slopes[!ring->disc].of[ring->place][column];
    return *node > 0 && *node <= w->cards->node_count && fabs(*slope) > 1e-12; /* else 0 but for rounding */
}

/* Levers between a node of the ring and the nodes that strain it. */
static void write_levers(const dea_rings_writer *w, const dea_rings_ring *ring, const char *own, char kind, bool out_of, const char *factor)
{
    const size_t degree = ring->disc ? w->cards->mesh.disc : w->cards->mesh.annulus;
    for (size_t i = 0; i <= degree; i++) {
        size_t node;
        double slope;
        if (strains(w, ring, i, &node, &slope)) {
            dea_rings_label element;
            const dea_rings_label other = dea_rings_node(w, kind, node);
            snprintf(element.text, sizeof element.text, "%.40s_%zu", own, node);
            dea_rings_lever(w, element.text, out_of ? other.text : "0", out_of ? "0" : own, out_of ? own : other.text, slope, factor);
        }
    }
}

void dea_rings_gradient(const dea_rings_writer *w, const dea_rings_ring *ring, const char *into, char kind, const char *factor)
{
    write_levers(w, ring, into, kind, false, factor);
    dea_rings_sum(w, into);
}

void dea_rings_spread(const dea_rings_writer *w, const dea_rings_ring *ring, const char *control, char kind, const char *factor)
{
    write_levers(w, ring, control, kind, true, factor);
}

/* (1 + e_1)(1 + e_2)(1 + e_3) = 1, solved by Newton with all else: a quotient has long derivatives. */
void dea_rings_thickness(const dea_rings_writer *w, dea_rings_strain strain, size_t q)
{
    const char hoop = strain == DEA_RINGS_UNIFORM ? 'a' : 'b';
    dea_rings_begin(w, dea_rings_label_of("w", q).text);
    if (strain == DEA_RINGS_FRAME) {
        fprintf(w->out, "-v(a%zu)*(1+v(w%zu))", q, q);
    } else {
        fprintf(w->out, "-(v(a%zu)+v(%c%zu)*(1+v(a%zu)))*(1+v(w%zu))", q, hoop, q, q, q);
    }
    dea_rings_end(w);
}

void dea_rings_spring(const dea_rings_writer *w, const char *from, const char *u, dea_expr ref)
{
    char voltage[2 * DEA_PART_NAME];
    const char *const nodes[DEA_RINGS_VARIABLES] = {[DEA_RINGS_E1] = voltage};
    dea_rings_place here = {.nodes = nodes};
    snprintf(voltage, sizeof voltage, "v(%s)", u);
    dea_rings_enter(w, &here, w->cards->edge, "load");
    dea_part_text_nodes_of(w->text, ref);
    dea_dialect_source_begin(w->text->dialect, w->out, DEA_CURRENT, "load", from, "0");
    dea_part_text_write(w->text, ref);
    dea_dialect_source_end(w->text->dialect, w->out);
    dea_rings_leave(w);
}

void dea_rings_name(dea_part_text *text, dea_expr ref, const char *what, size_t number)
{
    dea_part_text_name(text, ref, dea_rings_label_of(what, number).text, "");
    dea_part_text_use(text, ref);
}

void dea_rings_quantity(dea_rings_quantities *q, dea_pool *pool, const char *name, const char *unit, dea_expr *ref)
{
    const double value = dea_expr_constant(pool, *ref);
    if (!isnan(value)) {
        snprintf(q->names[q->count], sizeof q->names[q->count], "%s", name);
        q->units[q->count] = unit;
        q->values[q->count] = value;
        *ref = dea_expr_symbol(pool, (int)q->count++);
    }
}

static void name_constants(const dea_law *law, size_t entries, const char *prefix, dea_pool *pool, dea_expr *constants,
                           dea_rings_quantities *q)
{
    const size_t count = law->constant_count * (law->entries > 1 ? entries : 1);
    for (size_t i = 0; i < count; i++) {
        char own[DEA_QUANTITY_NAME], name[DEA_PART_NAME];
        dea_constant_name(law, i, own);
        snprintf(name, sizeof name, "%s%s", prefix, own);
        dea_rings_quantity(q, pool, name, law->constants[i % law->constant_count].unit, &constants[i]);
    }
}

void dea_rings_quantities_of(const dea_scene *scene, const dea_axis *axis, dea_pool *pool, dea_symbols *s, dea_rings_quantities *q)
{
    *s = dea_symbols_of(scene, axis, pool);
    *q = (dea_rings_quantities){.names = {"v(axis)"}, .count = 1};
    dea_rings_quantity(q, pool, "frame_radius", "m", &s->frame_radius);
    dea_rings_quantity(q, pool, "coverage", "1", &s->coverage);
    dea_rings_quantity(q, pool, "film_thickness", "m", &s->film_thickness);
    dea_rings_quantity(q, pool, "prestretch", "1", &s->prestretch);
    dea_rings_quantity(q, pool, "permittivity", "F/m", &s->permittivity);
    dea_rings_quantity(q, pool, "voltage", "V", &s->voltage);
    name_constants(s->law, scene->material.entry_count, "", pool, s->constants, q);
    if (s->skin) {
        dea_rings_quantity(q, pool, "skin_share", "1", &s->skin_share);
        name_constants(s->skin, scene->electrode.entry_count, "skin_", pool, s->skin_constants, q);
    }
}

void dea_rings_quantities_write(const dea_rings_quantities *q, FILE *out)
{
    for (size_t i = 1; i < q->count; i++) {
        fprintf(out, "* %s [%s]\n", q->names[i], q->units[i]);
        dea_part_value(out, q->names[i], q->values[i]);
    }
}
