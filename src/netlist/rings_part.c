#include "netlist/rings_part.h"

#include "expression/formula.h"
#include "netlist/mobility.h"

/* For coverages 0.15 ... 0.85 and pre-stretches 1.1 ... 1.3 its static strain at 4.5 kV is good to 1e-8, its first two modes to 1e-5
 * and 1e-3 (measured on the paper's film, against 14 and 18 degrees). */
static const dea_rings_mesh fixed_mesh = {5, 7, true};

void dea_rings_part_make(const dea_symbols *symbols, const dea_rings_numbers *numbers, size_t branches, dea_rings_part *part)
{
    dea_pool *pool = symbols->pool;
    dea_rings_moving_make(symbols, numbers, fixed_mesh, branches, &part->moving);
    part->moving.stops = true;
    const dea_expr l1 = ADD(NUM(1.0), dea_expr_node(pool, DEA_RINGS_E1)), l2 = ADD(NUM(1.0), dea_expr_node(pool, DEA_RINGS_E2));
    const dea_symbols_factors electric = dea_symbols_electric(symbols, l1, l2);
    const dea_expr square = SQUARE(symbols->prestretch), r_a = MUL(symbols->frame_radius, symbols->coverage);
    part->frame_radius = symbols->frame_radius;
    part->field = MUL(SCALE(1e-6, DIV(MUL(symbols->layers, square), symbols->film_thickness)), MUL(l1, l2));
    const dea_expr size = SCALE(symbols->kind == DEA_DOT ? 2.0 * DEA_PI : -2.0 * DEA_PI, MUL(symbols->permittivity, DIV(square, symbols->film_thickness)));
    part->force = MUL(MUL(MUL(size, electric.first), r_a), MUL(l1, SQUARE(l2)));
}

/* Rings on both sides of r_a, and that of the electrode there. */
static size_t edge_ring(const dea_rings_cards *cards)
{
    size_t q = 0;
    while (cards->rings[q + 1].disc) {
        q++;
    }
    return q;
}

static size_t electrode_ring(const dea_rings_cards *cards)
{
    const size_t q = edge_ring(cards);
    return cards->rings[q].electroded ? q : q + 1;
}

void dea_rings_part_declare(const dea_rings_part *part, dea_part_text *text)
{
    const dea_rings_moving *m = &part->moving;
    dea_rings_moving_declare(m, true, text);
    for (size_t n = 0; n < m->cards.node_count; n++) {
        dea_rings_name(text, m->masses[n], "mass", n + 1);
    }
    const dea_expr rest[] = {part->field, part->force, m->rest, part->frame_radius};
    for (size_t i = 0; i < sizeof rest / sizeof *rest; i++) {
        dea_part_text_use(text, rest[i]);
    }
}

/* Displacement, mass and hold with the cures of the other parts. */
static void write_node(const dea_rings_writer *w, const dea_rings_moving *m, size_t node)
{
    const dea_rings_label v = dea_rings_node(w, 'v', node), u = dea_rings_node(w, 'u', node), tag = dea_rings_label_of("", node);
    char mass[3 * DEA_PART_NAME];
    snprintf(mass, sizeof mass, "%s+%.15g*k_rest", dea_rings_parameter(w, m->masses[node - 1]).text, dea_part_cures.lightest);
    dea_cards_write_integral(&dea_part_cures, tag.text, u.text, v.text, "0", w->out);
    dea_cards_write_inertia(&dea_part_cures, tag.text, v.text, mass, w->out);
    fprintf(w->out, "GSAFE%zu %s 0 %s 0 {hold}\n", node, v.text, u.text);
}

/* Field and force per volt at the electroded ring of the edge. */
static void write_outputs(const void *user, const dea_rings_writer *w, size_t ring)
{
    const dea_rings_part *part = user;
    if (ring == electrode_ring(w->cards)) {
        dea_rings_source(w, "stretched", part->field);
        dea_rings_source(w, "pull", part->force);
    }
}

static void write_tension(const dea_rings_writer *w, const dea_rings_moving *m)
{
    const size_t q = edge_ring(w->cards) + 1, last = w->cards->ring_count;
    fputs("* least stress at r_a and at the frame [MPa]\n", w->out);
    dea_rings_begin(w, "tension");
    dea_part_text_write(w->text, m->rest);
    fprintf(w->out, "+min(min(min(v(f%zu),v(g%zu)),min(v(f%zu),v(g%zu))),v(f%zu))", q, q, q + 1, q + 1, last);
    dea_rings_end(w);
}

void dea_rings_part_write(const dea_rings_part *part, dea_part_text *text)
{
    const dea_rings_moving *m = &part->moving;
    const dea_rings_writer w = {.cards = &m->cards, .text = text, .out = text->out, .pinned = true};
    fprintf(w.out, "* the membrane as %zu moving nodes, degrees of disc and annulus %zu and %zu; strain good to 1e-8 at rest, first modes\n",
            m->cards.node_count, m->cards.mesh.disc, m->cards.mesh.annulus);
    fputs("* to 1e-5 and 1e-3, for coverages 0.15 to 0.85 and pre-stretches 1.1 to 1.3\n", w.out);
    fputs(".param per_r={1e-6/radius}\n.param newton={6.283185307179586e6*many*layer*thick*radius/(stretch*stretch)}\n",
          w.out);
    for (size_t n = 1; n <= m->cards.node_count; n++) {
        write_node(&w, m, n);
    }
    dea_rings_moving_write(m, "[ok]*v(p,n)", "/radius", write_outputs, part, text);
    dea_rings_moving_swell(m, text);
    write_tension(&w, m);
}
