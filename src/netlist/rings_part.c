#include "netlist/rings_part.h"

#include <math.h>

#include "expression/derivative.h"
#include "expression/formula.h"
#include "network/hyperelastic.h"

const dea_rings_mesh dea_rings_part_mesh = {5, 7, true};

/* Nodes of the pool beside the strains: their rates, the stresses with what branches add, the film's voltage, and a direction. */
enum { RATE1 = DEA_RINGS_VARIABLES, RATE2, HELD1, HELD2, VOLTS, VARIABLES, ALONG = VARIABLES };

/* Slope of a stress over time: along the rates of the strains. */
static dea_expr rate_of(dea_pool *pool, dea_expr stress)
{
    const dea_expr along = dea_expr_node(pool, ALONG);
    dea_expr moved = stress;
    for (int i = 0; i < 2; i++) {
        const dea_expr here = ADD(dea_expr_node(pool, i), MUL(along, dea_expr_node(pool, RATE1 + i)));
        moved = dea_expr_put(pool, moved, DEA_NODE, i, here);
    }
    return dea_expr_put(pool, dea_expr_derivative(pool, moved, DEA_NODE, ALONG), DEA_NODE, ALONG, NUM(0.0));
}

/* lambda_pre (P_a + x_a/lambda_a) - electrostatic part, from the sum of sigma_a and its branches in HELD and the damper's rate. */
static void make_nominal(const dea_symbols *symbols, dea_rings_part *part, int strain, dea_expr damp)
{
    dea_pool *pool = symbols->pool;
    const dea_expr e[2] = {dea_expr_node(pool, DEA_RINGS_E1),
                           strain == DEA_RINGS_FRAME ? NUM(0.0) : dea_expr_node(pool, DEA_RINGS_E2)};
    const dea_expr l1 = ADD(NUM(1.0), e[0]), l2 = ADD(NUM(1.0), e[1]);
    const dea_expr fourth = SQUARE(SQUARE(symbols->prestretch));
    const dea_expr push = SCALE(1e-6, MUL(symbols->permittivity, DIV(fourth, SQUARE(symbols->film_thickness))));
    const dea_expr electric = dea_symbols_electric(symbols, l1, l2).first;
    const dea_expr square = MUL(MUL(push, electric), SQUARE(dea_expr_node(pool, VOLTS)));
    for (int a = 0; a < 2; a++) {
        const dea_expr held = ADD(dea_expr_node(pool, HELD1 + a), MUL(damp, part->rates[strain][a]));
        const dea_expr film = DIV(SUB(held, MUL(part->rest, e[a])), ADD(NUM(1.0), e[a]));
        part->nominal[strain][0][a] = film;
        part->nominal[strain][1][a] = SUB(film, MUL(square, a == 0 ? MUL(l1, SQUARE(l2)) : MUL(l2, SQUARE(l1))));
    }
}

/* Area of reference film over F^2 of a ring: 2 pi radius stretch weight = 2 pi along/radial. */
static dea_expr area_of(dea_pool *pool, const dea_rings_ring *ring)
{
    return SCALE(2.0 * DEA_PI, DIV(ring->along, ring->radial));
}

/* Masses of the nodes, and shares of the rings in the capacitance: both go with the area; number of rings is that of the cards. */
static void make_weights(const dea_symbols *symbols, dea_rings_part *part, dea_expr density, dea_expr areal)
{
    dea_pool *pool = symbols->pool;
    const dea_expr b2 = SQUARE(symbols->coverage), r2 = SQUARE(symbols->frame_radius);
    const dea_expr whole = SCALE(DEA_PI, symbols->kind == DEA_DOT ? b2 : SUB(NUM(1.0), b2)); /* over F^2 */
    const dea_expr film = MUL(MUL(density, symbols->film_thickness), DIV(r2, SQUARE(symbols->prestretch)));
    const dea_expr skin = MUL(areal, r2); /* of the pre-stretched area */
    for (size_t q = 0; q < part->cards.ring_count; q++) {
        const dea_rings_ring *ring = &part->cards.rings[q];
        const dea_expr area = area_of(pool, ring);
        part->weights[q] = DIV(area, whole);
        if (ring->node <= part->cards.node_count) {
            dea_expr *mass = &part->masses[ring->node - 1];
            *mass = ADD(*mass, MUL(area, ring->electroded ? ADD(film, skin) : film));
        }
    }
}

void dea_rings_part_make(const dea_symbols *symbols, const dea_rings_numbers *numbers, size_t branches, dea_rings_part *part)
{
    dea_pool *pool = symbols->pool;
    dea_symbols bare = *symbols; /* the cards' own stresses are not written */
    bare.voltage = NUM(0.0);
    dea_rings_cards_make(&bare, dea_rings_part_mesh, &part->cards);
    part->branches = branches;
    const dea_symbols *s = symbols;
    part->rest = dea_symbols_rest_stress(s);
    for (int strain = 0; strain < DEA_RINGS_UNIFORM; strain++) {
        const dea_expr e1 = dea_expr_node(pool, DEA_RINGS_E1);
        const dea_expr e2 = strain == DEA_RINGS_FRAME ? NUM(0.0) : dea_expr_node(pool, DEA_RINGS_E2);
        dea_hyperelastic_cauchy(s, e1, e2, part->cauchy[strain]);
        for (int a = 0; a < 2; a++) {
            part->rates[strain][a] = rate_of(pool, part->cauchy[strain][a]);
        }
        make_nominal(symbols, part, strain, numbers->damp);
    }
    for (size_t n = 0; n < part->cards.node_count; n++) {
        part->masses[n] = NUM(0.0);
    }
    make_weights(symbols, part, numbers->density, numbers->areal);
    const dea_expr l1 = ADD(NUM(1.0), dea_expr_node(pool, DEA_RINGS_E1)), l2 = ADD(NUM(1.0), dea_expr_node(pool, DEA_RINGS_E2));
    const dea_symbols_factors electric = dea_symbols_electric(symbols, l1, l2);
    part->swell = dea_expr_change(pool, MUL(electric.own, MUL(SQUARE(l1), SQUARE(l2))));
    const dea_expr square = SQUARE(symbols->prestretch), r_a = MUL(symbols->frame_radius, symbols->coverage);
    part->frame_radius = symbols->frame_radius;
    part->field = MUL(SCALE(1e-6, DIV(MUL(symbols->layers, square), symbols->film_thickness)), MUL(l1, l2));
    const dea_expr size = SCALE(symbols->kind == DEA_DOT ? 2.0 * DEA_PI : -2.0 * DEA_PI, MUL(symbols->permittivity, DIV(square, symbols->film_thickness)));
    part->force = MUL(MUL(MUL(size, electric.first), r_a), MUL(l1, SQUARE(l2)));
}

static const char *const stress_names[2] = {"s", "t"}, *const held_names[2] = {"x", "y"}, *const film_names[2] = {"f", "g"};

enum { NAME = 32 };

typedef struct label {
    char text[NAME];
} label;

static label label_of(const char *name, size_t number)
{
    label l;
    snprintf(l.text, sizeof l.text, "%s%zu", name, number);
    return l;
}

static int components(const dea_rings_ring *ring)
{
    return ring->strain == DEA_RINGS_FRAME ? 1 : 2;
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

static void name(dea_part_text *text, dea_expr ref, const char *what, size_t number)
{
    dea_part_text_name(text, ref, label_of(what, number).text, "");
    dea_part_text_use(text, ref);
}

void dea_rings_part_declare(const dea_rings_part *part, dea_part_text *text)
{
    const dea_rings_cards *cards = &part->cards;
    dea_rings_cards_share(text);
    for (size_t q = 0; q < cards->ring_count; q++) {
        const dea_rings_ring *ring = &cards->rings[q];
        name(text, ring->radial, "radial", q + 1);
        name(text, ring->hoop, "hoop", q + 1);
        name(text, ring->along, "along", q + 1);
        name(text, ring->across, "across", q + 1);
        if (ring->electroded) {
            name(text, part->weights[q], "weight", q + 1);
        }
    }
    for (size_t n = 0; n < cards->node_count; n++) {
        name(text, part->masses[n], "mass", n + 1);
    }
    for (int strain = 0; strain < DEA_RINGS_UNIFORM; strain++) {
        for (int a = 0; a < (strain == DEA_RINGS_FRAME ? 1 : 2); a++) {
            dea_part_text_use(text, part->cauchy[strain][a]);
            dea_part_text_use(text, part->nominal[strain][0][a]);
            dea_part_text_use(text, part->nominal[strain][1][a]);
        }
    }
    const dea_expr rest[] = {part->swell, part->field, part->force, part->rest, part->frame_radius};
    for (size_t i = 0; i < sizeof rest / sizeof *rest; i++) {
        dea_part_text_use(text, rest[i]);
    }
}

typedef struct writer {
    const dea_rings_part *part;
    dea_part_text *text;
    FILE *out;
} writer;

static void begin(const writer *w, const char *node)
{
    dea_dialect_source_begin(w->text->dialect, w->out, DEA_VOLTAGE, node, node, "0");
}

static void end(const writer *w)
{
    dea_dialect_source_end(w->text->dialect, w->out);
}

/* A term as a source of its own. */
static void source(const writer *w, const char *node, dea_expr ref)
{
    dea_part_text_nodes_of(w->text, ref);
    begin(w, node);
    dea_part_text_write(w->text, ref);
    end(w);
}

/* Name of the parameter of a declared term: rings of one element share theirs. */
static label parameter(const writer *w, dea_expr ref)
{
    char own[DEA_PART_NAME];
    label l;
    snprintf(l.text, sizeof l.text, "%s", dea_part_text_parameter(w->text, ref, own));
    return l;
}

static label velocity_node(const writer *w, size_t node)
{
    return node == w->part->cards.edge ? (label){"edge"} : label_of("v", node);
}

static label displacement_node(const writer *w, size_t node)
{
    return node == w->part->cards.edge ? (label){"u"} : label_of("u", node);
}

/* Sums over the moving nodes that strain a ring: into a node of the ring, or from it out of the nodes of velocity. */
static void write_sum(const writer *w, const dea_rings_ring *ring, const char *ring_node, const char *factor, bool rates, bool force)
{
    const dea_rings_slopes *slopes = &w->part->cards.slopes[!ring->disc];
    const size_t degree = ring->disc ? w->part->cards.mesh.disc : w->part->cards.mesh.annulus;
    for (size_t i = 0; i <= degree; i++) {
        const size_t node = ring->first + i;
        const double slope = slopes->of[ring->place][i];
        if (node == 0 || node > w->part->cards.node_count || !(fabs(slope) > 1e-12)) {
            continue;
        }
        const label of = rates || force ? velocity_node(w, node) : displacement_node(w, node);
        if (force) {
            fprintf(w->out, "G%s_%zu %s 0 %s 0 {", ring_node, node, of.text, ring_node);
        } else {
            fprintf(w->out, "G%s_%zu 0 %s %s 0 {", ring_node, node, ring_node, of.text);
        }
        dea_part_number(w->out, slope);
        fprintf(w->out, "*%s}\n", factor);
    }
}

/* Strains with stops: an iterate of Newton's method may go where no film is. */
static void write_strains(const writer *w, const dea_rings_ring *ring, size_t number)
{
    char factor[2 * NAME];
    const label e = label_of("e", number), k = label_of("k", number), a = label_of("a", number), b = label_of("b", number);
    const label c = label_of("c", number), d = label_of("d", number);
    const label radial = parameter(w, ring->radial), hoop = parameter(w, ring->hoop);
    snprintf(factor, sizeof factor, "%s*per_r", radial.text);
    write_sum(w, ring, e.text, factor, false, false);
    snprintf(factor, sizeof factor, "%s/radius", radial.text);
    write_sum(w, ring, c.text, factor, true, false);
    fprintf(w->out, "R%s %s 0 1\nR%s %s 0 1\n", e.text, e.text, c.text, c.text);
    begin(w, a.text);
    fprintf(w->out, "min(max(v(%s),-9e-1),9)", e.text);
    end(w);
    if (components(ring) == 2) {
        fprintf(w->out, "G%s 0 %s %s 0 {%s*per_r}\nR%s %s 0 1\n", k.text, k.text, displacement_node(w, ring->node).text,
                hoop.text, k.text, k.text);
        fprintf(w->out, "G%s 0 %s %s 0 {%s/radius}\nR%s %s 0 1\n", d.text, d.text, velocity_node(w, ring->node).text,
                hoop.text, d.text, d.text);
        begin(w, b.text);
        fprintf(w->out, "min(max(v(%s),-9e-1),9)", k.text);
        end(w);
    }
}

/* The stress with what its branches add; z relaxes to the stress with the time of the branch. */
static void write_branches(const writer *w, int a, size_t number)
{
    const label s = label_of(stress_names[a], number), x = label_of(held_names[a], number);
    fprintf(w->out, "G%s 0 %s %s 0 1\nR%s %s 0 1\n", x.text, x.text, s.text, x.text, x.text);
    for (size_t i = 1; i <= w->part->branches; i++) {
        char z[2 * NAME];
        snprintf(z, sizeof z, "z%zu%s", i, s.text);
        fprintf(w->out, "G%s 0 %s %s %s 1\nC%s %s 0 {c_relax%zu}\nGB%s 0 %s %s %s {share%zu}\n", z, z, s.text, z, z, z, i, z, x.text,
                s.text, z, i);
    }
}

static void write_ring(const writer *w, size_t index)
{
    const dea_rings_part *p = w->part;
    const dea_rings_ring *ring = &p->cards.rings[index];
    const size_t number = index + 1;
    char factor[2 * NAME];
    fprintf(w->out, "* ring %zu\n", number);
    write_strains(w, ring, number);
    for (int a = 0; a < components(ring); a++) {
        source(w, label_of(stress_names[a], number).text, p->cauchy[ring->strain][a]);
        write_branches(w, a, number);
    }
    for (int a = 0; a < components(ring); a++) {
        source(w, label_of(film_names[a], number).text, p->nominal[ring->strain][ring->electroded][a]);
    }
    snprintf(factor, sizeof factor, "%s*newton", parameter(w, ring->along).text);
    write_sum(w, ring, label_of("f", number).text, factor, false, true);
    if (components(ring) == 2) {
        fprintf(w->out, "GG%zu %s 0 g%zu 0 {%s*newton}\n", number, velocity_node(w, ring->node).text, number,
                parameter(w, ring->across).text);
    }
    if (ring->electroded) {
        source(w, label_of("h", number).text, p->swell);
        fprintf(w->out, "GH%zu 0 swell h%zu 0 {%s}\n", number, number, parameter(w, p->weights[index]).text);
    }
    if (index == electrode_ring(&p->cards)) {
        source(w, "stretched", p->field);
        source(w, "pull", p->force);
    }
}

/* Displacement [um] as the integral of the velocity, its leak, mass and hold as those of the other parts. */
static void write_node(const writer *w, size_t node)
{
    const label v = velocity_node(w, node), u = displacement_node(w, node);
    fprintf(w->out, "GDISP%zu 0 %s %s 0 1e6\nCDISP%zu %s 0 1\nGDRIFT%zu %s 0 %s 0 1e-9\nGSAFE%zu %s 0 %s 0 {hold}\n", node, u.text, v.text,
            node, u.text, node, u.text, u.text, node, v.text, u.text);
    fprintf(w->out, "EMASS%zu ma%zu 0 %s 0 1e-6\nCMASS%zu ma%zu mb%zu {%s+1e-24*k_rest}\nVMASS%zu mb%zu 0 0\nFMASS%zu %s 0 VMASS%zu {f_mass}\n",
            node, node, v.text, node, node, node, parameter(w, w->part->masses[node - 1]).text, node, node, node, v.text, node);
}

static void write_tension(const writer *w)
{
    const size_t q = edge_ring(&w->part->cards) + 1, last = w->part->cards.ring_count;
    fputs("* least stress at r_a and at the frame [MPa]\n", w->out);
    begin(w, "tension");
    dea_part_text_write(w->text, w->part->rest);
    fprintf(w->out, "+min(min(min(v(f%zu),v(g%zu)),min(v(f%zu),v(g%zu))),v(f%zu))", q, q, q + 1, q + 1, last);
    end(w);
}

void dea_rings_part_write(const dea_rings_part *part, dea_part_text *text)
{
    writer w = {part, text, text->out};
    const dea_rings_cards *cards = &part->cards;
    fprintf(w.out, "* the membrane as %zu moving nodes, degrees of disc and annulus %zu and %zu; strain good to 1e-8 at rest, first modes\n",
            cards->node_count, cards->mesh.disc, cards->mesh.annulus);
    fputs("* to 1e-5 and 1e-3, for coverages 0.15 to 0.85 and pre-stretches 1.1 to 1.3\n", w.out);
    fputs(".param per_r={1e-6/radius}\n.param newton={6.283185307179586e6*many*layer*thick*radius/(stretch*stretch)}\n.param hold={1-ok}\n"
          ".param f_mass={1e6*many}\nRSWELL swell 0 1\n",
          w.out);
    for (size_t n = 1; n <= cards->node_count; n++) {
        write_node(&w, n);
    }
    for (size_t q = 0; q < cards->ring_count; q++) {
        char names[4][NAME], suffix[NAME];
        char held[2][NAME];
        for (int i = 0; i < 4; i++) {
            snprintf(names[i], NAME, "v(%c%zu)", "abcd"[i], q + 1);
        }
        for (int i = 0; i < 2; i++) {
            snprintf(held[i], NAME, "v(%s%zu)", held_names[i], q + 1);
        }
        const bool frame = cards->rings[q].strain == DEA_RINGS_FRAME;
        const char *const nodes[] = {names[0], frame ? "0" : names[1], names[2], frame ? "0" : names[3], held[0], held[1], "v(p,n)"};
        snprintf(suffix, sizeof suffix, "_%zu", q + 1);
        text->nodes = nodes;
        text->suffix = suffix;
        write_ring(&w, q);
        dea_part_text_again(text);
        text->nodes = NULL;
    }
    write_tension(&w);
}
