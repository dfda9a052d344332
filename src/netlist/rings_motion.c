#include "netlist/rings_motion.h"

#include <math.h>
#include <stdlib.h>

#include "expression/formula.h"
#include "deaspice/model.h"
#include "film/edge.h"

static bool is_free(const dea_membrane *m)
{
    return !m->heavy && m->film.retardation == 0.0;
}

/* Damper and steady force of the loads stand as numbers. */
static void make_loads(const dea_scene *scene, dea_rings_motion_cards *c)
{
    dea_pool *pool = &c->pool;
    dea_symbols *s = &c->symbols;
    dea_expr *mass = &c->moving.masses[c->moving.cards.edge - 1];
    for (size_t i = 0; i < DEA_LOADS; i++) {
        const dea_load_kind *kind = dea_load_is_given(&scene->loads[i]) ? scene->loads[i].kind : NULL;
        const double weight = kind && c->membrane->heavy ? kind->adds.mass : 0.0;
        if (kind && (weight > 0.0 || kind->adds.stiffness > 0.0 || kind->spring)) {
            char name[DEA_QUANTITY_NAME];
            dea_expr number = NUM(scene->loads[i].number);
            dea_rings_quantity(&c->quantities, pool, dea_load_parameter(kind, name), kind->unit, &number);
            *mass = ADD(*mass, SCALE(weight, number));
            s->loads[i] = s->load_kinds[i] ? number : s->loads[i];
        }
    }
    c->springs = dea_symbols_springs(s, dea_expr_node(pool, DEA_RINGS_E1));
}

/* Symbols of the scene, and what else the rings are made of. */
static void make(const dea_scene *scene, dea_rings_motion_cards *c)
{
    const dea_membrane *m = c->membrane;
    dea_pool *pool = &c->pool;
    dea_rings_quantities *q = &c->quantities;
    dea_scene film = *scene; /* its voltage is that of a node */
    film.drive.voltage = (double)NAN;
    (void)NUM(0.0);
    dea_rings_quantities_of(&film, NULL, pool, &c->symbols, q);
    dea_rings_numbers numbers = {NUM(m->heavy && scene->material.density > 0.0 ? scene->material.density : 0.0),
                                 NUM(m->heavy ? dea_electrode_mass(scene) : 0.0), NUM(m->film.retardation), 1.0, m->film.held};
    if (m->heavy) {
        dea_rings_quantity(q, pool, "density", "kg/m^3", &numbers.density);
    }
    if (dea_expr_constant(pool, numbers.areal) > 0.0) {
        dea_rings_quantity(q, pool, "electrode_mass", "kg/m^2", &numbers.areal);
    }
    if (m->film.retardation > 0.0) {
        dea_rings_quantity(q, pool, "retardation", "s", &numbers.damp);
    }
    dea_rings_moving_make(&c->symbols, &numbers, m->rings.mesh, m->film.branch_count, &c->moving);
    c->moving.free = is_free(m);
    c->moving.whole = true;
    make_loads(scene, c);
    const dea_symbols *s = &c->symbols;
    c->per_r = DIV(NUM(1.0), s->frame_radius);
    c->newton = SCALE(2.0 * DEA_PI, MUL(s->film_thickness, DIV(s->frame_radius, SQUARE(s->prestretch))));
}

static void declare(dea_rings_motion_cards *c)
{
    dea_part_text *text = &c->text;
    const dea_membrane *m = c->membrane;
    dea_part_text_root(text, "film"); /* numbers of terms in the pool follow the units */
    dea_rings_moving_declare(&c->moving, true, text);
    dea_part_text_name(text, c->per_r, "per_r", "strain over displacement and radius");
    dea_part_text_use(text, c->per_r);
    dea_part_text_name(text, c->newton, "newton", "force over stress, 2 pi H F^2/r");
    dea_part_text_use(text, c->newton);
    for (size_t n = 0; n < m->rings.node_count && m->heavy; n++) {
        dea_rings_name(text, c->moving.masses[n], "mass", n + 1);
    }
    if (dea_expr_constant(text->pool, c->springs) != 0.0) {
        dea_part_text_use(text, c->springs);
    }
}

dea_status dea_rings_motion_cards_open(const dea_scene *scene, const dea_membrane *membrane, const dea_cards_form *form, FILE *out,
                                       dea_rings_motion_cards *c, dea_error *error)
{
    static const double rest[16] = {0.0};
    *c = (dea_rings_motion_cards){.membrane = membrane};
    make(scene, c);
    c->values = calloc((size_t)c->pool.count + 1, sizeof *c->values);
    if (!dea_part_text_open(&c->text, &c->pool, form->dialect, out) || !c->values) {
        return dea_fail(error, DEA_ERROR_MEMORY, "out of memory while a netlist is written");
    }
    const dea_rings_quantities *q = &c->quantities;
    for (size_t i = 0; i < q->count; i++) {
        c->names[i] = q->names[i];
    }
    c->text.symbols = c->names;
    dea_pool_values_at(&c->pool, &(dea_point_values){q->values, rest, (int)q->count, (int)(sizeof rest / sizeof *rest)}, c->values);
    c->text.values = form->numbers ? c->values : NULL;
    declare(c);
    return c->text.exhausted ? dea_fail(error, DEA_ERROR_MEMORY, "out of memory while a netlist is written") : DEA_OK;
}

void dea_rings_motion_cards_close(dea_rings_motion_cards *c)
{
    dea_part_text_close(&c->text);
    dea_pool_free(&c->pool);
    free(c->values);
}

static void indexed(const dea_rings_motion_cards *c, const char *name, size_t number, double value)
{
    dea_part_value(c->text.out, dea_rings_label_of(name, number).text, value);
}

void dea_rings_motion_cards_write_numbers(dea_rings_motion_cards *c, const dea_rings_port *port)
{
    const dea_dynamics *film = &c->membrane->film;
    for (size_t i = 1; i < c->quantities.count && !c->text.values; i++) {
        dea_part_value(c->text.out, c->quantities.names[i], c->quantities.values[i]);
    }
    dea_part_text_parameters(&c->text);
    for (size_t i = 0; i < film->branch_count; i++) {
        indexed(c, "share", i + 1, film->branches[i].share);
        indexed(c, "c_relax", i + 1, film->branches[i].tau);
    }
    if (film->conductance > 0.0) {
        dea_part_value(c->text.out, "r_leak", port->leak);
    }
    if (film->series > 0.0) {
        dea_part_value(c->text.out, "r_series", port->series);
        dea_part_value(c->text.out, "c_rest", port->rest);
    }
}

/* Displacement as the integral of the velocity, mass; a film without mass and damper has displacements alone. */
static void write_node(const dea_rings_motion_cards *c, const dea_rings_writer *w, size_t node)
{
    const dea_rings_label v = dea_rings_node(w, 'v', node), u = dea_rings_node(w, 'u', node);
    if (!c->moving.free) {
        fprintf(w->out, "GDISP%zu 0 %s %s 0 1\nCDISP%zu %s 0 1\n", node, u.text, v.text, node, u.text);
    }
    if (c->membrane->heavy) {
        fprintf(w->out, "CMASS%zu %s 0 {%s}\n", node, v.text, dea_rings_parameter(w, c->moving.masses[node - 1]).text);
    }
}

static void write_load(const dea_rings_motion_cards *c, const dea_rings_writer *w)
{
    const dea_dynamics *film = &c->membrane->film;
    const char *edge = c->moving.free ? "u" : "edge";
    if (dea_expr_constant(&c->pool, c->springs) != 0.0) {
        fputs("* spring of the load between edge and frame\n", w->out);
        dea_rings_spring(w, edge, "u", c->springs);
    }
    if (film->damping > 0.0) {
        dea_part_print(w->out, "* mechanical resistance of the load [N s/m], whose inverse is the resistor\nRLOAD %s 0 %g\n",
                       edge, 1.0 / film->damping);
    }
    if (film->point.force != 0.0) {
        dea_part_print(w->out, "* force of the load onto the edge [N], outward\nILOAD 0 %s %g\n", edge, film->point.force);
    }
}

/* Behind a resistance the charge is a state; it counts as the voltage that it would make at rest. */
static void write_port(const dea_rings_motion_cards *c, FILE *out)
{
    if (c->membrane->film.conductance > 0.0) {
        fputs("* leakage resistance of the film [Ohm]\nRLEAK film 0 {r_leak}\n", out);
    }
    if (c->membrane->film.series > 0.0) {
        fputs("* series resistance of source and electrodes [Ohm]\nRSERIES source film {r_series}\n"
              "* film: its current into its capacitance at rest [F], whose charge over C(u) is its voltage, i = d(C U)/dt\n"
              "VFILM film plate 0\nFCHARGE 0 charge VFILM 1\nCCHARGE charge 0 {c_rest}\n",
              out);
        dea_dialect_source_begin(c->text.dialect, out, DEA_VOLTAGE, "film", "plate", "0");
        fputs("v(charge)/(1+v(swell))", out);
        dea_dialect_source_end(c->text.dialect, out);
    }
}

void dea_rings_motion_cards_write_network(dea_rings_motion_cards *c)
{
    const dea_rings_writer w = {.cards = &c->moving.cards, .text = &c->text, .out = c->text.out, .pinned = true};
    fputs(DEA_CARDS_BEGIN, w.out);
    for (size_t n = 1; n <= w.cards->node_count; n++) {
        write_node(c, &w, n);
    }
    dea_rings_moving_write(&c->moving, "v(film)", "*per_r", NULL, NULL, &c->text);
    write_load(c, &w);
    if (c->membrane->film.series > 0.0) {
        dea_rings_moving_swell(&c->moving, &c->text);
    }
    write_port(c, w.out);
    fputs(DEA_CARDS_END, w.out);
}

void dea_rings_motion_cards_write_swell(dea_rings_motion_cards *c)
{
    if (!(c->membrane->film.series > 0.0)) {
        dea_rings_moving_swell(&c->moving, &c->text);
    }
}

size_t dea_rings_states(const dea_membrane *m)
{
    return m->rings.node_count * (m->heavy ? 2 : 1) + dea_membrane_relaxed(m) + (m->film.series > 0.0 ? 1 : 0);
}

dea_rings_label dea_rings_state_node(const dea_membrane *m, size_t index)
{
    const size_t nodes = m->rings.node_count, moving = m->heavy ? 2 * nodes : nodes, branches = m->film.branch_count;
    if (index < moving) {
        const size_t node = index % nodes;
        const bool edge = node == m->rings.edge, still = index < nodes;
        return edge ? (still ? (dea_rings_label){"u"} : (dea_rings_label){"edge"}) : dea_rings_label_of(still ? "u" : "v", node + 1);
    }
    const size_t k = index - moving;
    if (k < dea_membrane_relaxed(m)) {
        dea_rings_label l;
        snprintf(l.text, sizeof l.text, "z%zu%s%zu", k % branches + 1, k / branches % 2 == 0 ? "s" : "t", k / branches / 2 + 1);
        return l;
    }
    return (dea_rings_label){"charge"};
}

dea_rings_label dea_rings_state_element(const dea_membrane *m, size_t index)
{
    const size_t nodes = m->rings.node_count, moving = m->heavy ? 2 * nodes : nodes;
    if (index < moving) {
        return dea_rings_label_of(index < nodes ? "CDISP" : "CMASS", index % nodes + 1);
    }
    dea_rings_label l;
    snprintf(l.text, sizeof l.text, "C%.40s", dea_rings_state_node(m, index).text);
    return l;
}
