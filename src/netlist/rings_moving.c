#include "netlist/rings_moving.h"
#include "netlist/rings_cards.h"


#include "expression/derivative.h"
#include "expression/formula.h"
#include "network/hyperelastic.h"

/* Nodes of the pool beside the strains: the rates of all three, the stresses with what branches and damper
 * add, the voltage's pressure; and a direction. */
enum { RATE1 = DEA_RINGS_VARIABLES, RATE2, RATE3, HELD1, HELD2, PRESSURE, VARIABLES, ALONG = VARIABLES };

/* Slope of a stress over time: along the rates of the strains. */
static dea_expr rate_of(dea_pool *pool, dea_expr stress)
{
    const dea_expr along = dea_expr_node(pool, ALONG);
    dea_expr moved = stress;
    for (int i = 0; i < 3; i++) {
        const dea_expr here = ADD(dea_expr_node(pool, i), MUL(along, dea_expr_node(pool, RATE1 + i)));
        moved = dea_expr_put(pool, moved, DEA_NODE, i, here);
    }
    return dea_expr_put(pool, dea_expr_derivative(pool, moved, DEA_NODE, ALONG), DEA_NODE, ALONG, NUM(0.0));
}

/* lambda_pre (P_a + x_a/lambda_a) - electrostatic part, from the sum of sigma_a and what is in HELD. */
static void make_nominal(const dea_symbols *symbols, dea_rings_moving *m, int strain)
{
    dea_pool *pool = symbols->pool;
    const dea_expr e[2] = {dea_expr_node(pool, DEA_RINGS_E1),
                           strain == DEA_RINGS_FRAME ? NUM(0.0) : dea_expr_node(pool, DEA_RINGS_E2)};
    const dea_expr l1 = ADD(NUM(1.0), e[0]), l2 = ADD(NUM(1.0), e[1]);
    const dea_expr pressure = MUL(dea_expr_node(pool, PRESSURE), dea_symbols_electric(symbols, l1, l2).first);
    for (int a = 0; a < 2; a++) {
        const dea_expr film = SUB(dea_expr_node(pool, HELD1 + a), MUL(m->rest, e[a])), l = a == 0 ? l1 : l2;
        const dea_expr coated = symbols->skin ? ADD(film, dea_hyperelastic_skin(symbols, e[a], e[1 - a])) : film;
        m->nominal[strain][0][a] = DIV(film, l);
        m->nominal[strain][1][a] = SUB(DIV(coated, l), MUL(pressure, a == 0 ? MUL(l1, SQUARE(l2)) : MUL(l2, SQUARE(l1))));
    }
}

/* Area of reference film over F^2 of a ring: 2 pi radius stretch weight = 2 pi along/radial. */
static dea_expr area_of(dea_pool *pool, const dea_rings_ring *ring)
{
    return SCALE(2.0 * DEA_PI, DIV(ring->along, ring->radial));
}

/* Masses of the nodes, and shares of the rings in the capacitance: both go with the area; number of rings is that of the cards. */
static void make_weights(const dea_symbols *symbols, dea_rings_moving *m, const dea_rings_numbers *numbers)
{
    dea_pool *pool = symbols->pool;
    const dea_expr b2 = SQUARE(symbols->coverage), r2 = SQUARE(symbols->frame_radius);
    const dea_expr whole = SCALE(DEA_PI, symbols->kind == DEA_DOT ? b2 : SUB(NUM(1.0), b2)); /* over F^2 */
    const dea_expr film = MUL(MUL(numbers->density, symbols->film_thickness), DIV(r2, SQUARE(symbols->prestretch)));
    const dea_expr skin = MUL(numbers->areal, r2); /* of the pre-stretched area */
    for (size_t q = 0; q < m->cards.ring_count; q++) {
        const dea_rings_ring *ring = &m->cards.rings[q];
        const dea_expr area = area_of(pool, ring);
        m->weights[q] = DIV(area, whole);
        if (ring->node <= m->cards.node_count) {
            dea_expr *mass = &m->masses[ring->node - 1];
            *mass = ADD(*mass, MUL(area, ring->electroded ? ADD(film, skin) : film));
        }
    }
}

/* The changes of the Cauchy stresses of a kind of ring, with those of branches that are springs alone. */
static void make_cauchy(const dea_symbols *symbols, dea_rings_moving *m, int strain, double held)
{
    dea_pool *pool = symbols->pool;
    dea_rings_cauchy(symbols, (dea_rings_strain)strain, m->cauchy[strain]);
    for (int a = 0; a < 2; a++) {
        m->cauchy[strain][a] = held > 0.0 ? SCALE(1.0 + held, m->cauchy[strain][a]) : m->cauchy[strain][a];
        m->rates[strain][a] = rate_of(pool, m->cauchy[strain][a]);
    }
}

void dea_rings_moving_make(const dea_symbols *symbols, const dea_rings_numbers *numbers, dea_rings_mesh mesh, size_t branches,
                           dea_rings_moving *m)
{
    dea_pool *pool = symbols->pool;
    dea_symbols bare = *symbols; /* the cards' own stresses are not written */
    bare.voltage = NUM(0.0);
    *m = (dea_rings_moving){.branches = branches, .rest = dea_symbols_rest_stress(symbols)};
    dea_rings_cards_make(&bare, mesh, &m->cards);
    m->damp = numbers->damp;
    m->damped = dea_expr_constant(pool, numbers->damp) != 0.0;
    const dea_expr fourth = SQUARE(SQUARE(symbols->prestretch)), square = SQUARE(symbols->film_thickness);
    m->push = SCALE(1.0 / numbers->stress, MUL(symbols->permittivity, DIV(fourth, square)));
    for (size_t q = 0; q < m->cards.ring_count; q++) {
        dea_rings_ring *ring = &m->cards.rings[q];
        ring->strain = ring->strain == DEA_RINGS_UNIFORM ? DEA_RINGS_FREE : ring->strain; /* its two strains happen to be one */
    }
    for (int strain = 0; strain < DEA_RINGS_UNIFORM; strain++) {
        make_cauchy(symbols, m, strain, numbers->held);
        make_nominal(symbols, m, strain);
    }
    for (size_t n = 0; n < m->cards.node_count; n++) {
        m->masses[n] = NUM(0.0);
    }
    make_weights(symbols, m, numbers);
    const dea_expr l1 = ADD(NUM(1.0), dea_expr_node(pool, DEA_RINGS_E1)), l2 = ADD(NUM(1.0), dea_expr_node(pool, DEA_RINGS_E2));
    m->swell = dea_expr_change(pool, MUL(dea_symbols_electric(symbols, l1, l2).own, MUL(SQUARE(l1), SQUARE(l2))));
}

static const char *const damper_names[2] = {"dx", "dy"};
static const char *const stress_names[2] = {"s", "t"}, *const held_names[2] = {"x", "y"}, *const film_names[2] = {"f", "g"};

/* Stresses that act on nodes. */
static int components(const dea_rings_ring *ring)
{
    return ring->strain == DEA_RINGS_FRAME ? 1 : 2;
}

/* Stresses that are written. */
static int stresses(const dea_rings_moving *m, const dea_rings_ring *ring)
{
    return m->whole && m->branches > 0 ? 2 : components(ring);
}

void dea_rings_moving_declare(const dea_rings_moving *m, bool charged, dea_part_text *text)
{
    const dea_rings_cards *cards = &m->cards;
    dea_rings_cards_share(text);
    for (size_t q = 0; q < cards->ring_count; q++) {
        const dea_rings_ring *ring = &cards->rings[q];
        dea_rings_name(text, ring->radial, "radial", q + 1);
        dea_rings_name(text, ring->hoop, "hoop", q + 1);
        dea_rings_name(text, ring->along, "along", q + 1);
        dea_rings_name(text, ring->across, "across", q + 1);
        if (ring->electroded && charged) {
            dea_rings_name(text, m->weights[q], "weight", q + 1);
        }
    }
    for (int strain = 0; strain < DEA_RINGS_UNIFORM; strain++) {
        for (int a = 0; a < (strain == DEA_RINGS_FRAME && !m->whole ? 1 : 2); a++) {
            dea_part_text_use(text, m->cauchy[strain][a]);
        }
        for (int a = 0; a < (strain == DEA_RINGS_FRAME ? 1 : 2); a++) {
            if (m->damped) {
                dea_part_text_use(text, m->rates[strain][a]);
            }
            dea_part_text_use(text, m->nominal[strain][0][a]);
            dea_part_text_use(text, m->nominal[strain][1][a]);
        }
    }
    dea_part_text_use(text, m->push);
    if (m->damped) {
        dea_part_text_use(text, m->damp);
    }
    if (charged) {
        dea_part_text_use(text, m->swell);
    }
}

typedef struct writer {
    dea_rings_writer base;
    const dea_rings_moving *moving;
    const char *rate;
} writer;

/* A strain or rate: what the nodes make of it. */
static void write_hoop(const writer *w, const dea_rings_ring *ring, const char *node, char kind, const char *unit)
{
    char factor[2 * DEA_PART_NAME];
    snprintf(factor, sizeof factor, "%.40s%s", dea_rings_parameter(&w->base, ring->hoop).text, unit);
    dea_rings_lever(&w->base, node, "0", node, dea_rings_node(&w->base, kind, ring->node).text, 1.0, factor);
    dea_rings_sum(&w->base, node);
}

static void write_radial(const writer *w, const dea_rings_ring *ring, const char *node, char kind, const char *unit)
{
    char factor[2 * DEA_PART_NAME];
    snprintf(factor, sizeof factor, "%.40s%s", dea_rings_parameter(&w->base, ring->radial).text, unit);
    dea_rings_gradient(&w->base, ring, node, kind, factor);
}

static void write_stop(const writer *w, const char *node, const char *strain)
{
    dea_rings_begin(&w->base, node);
    fprintf(w->base.out, "min(max(v(%s),-9e-1),9)", strain);
    dea_rings_end(&w->base);
}

/* Rate of the thickness, -(1 + e_3)^2 (e_1' (1 + e_2) + e_2' (1 + e_1)). */
static void write_thinning(const writer *w, bool both, size_t q)
{
    dea_rings_begin(&w->base, dea_rings_label_of("r", q).text);
    fprintf(w->base.out, "-(1+v(w%zu))*(1+v(w%zu))*", q, q);
    if (both) {
        fprintf(w->base.out, "(v(c%zu)*(1+v(b%zu))+v(d%zu)*(1+v(a%zu)))", q, q, q, q);
    } else {
        fprintf(w->base.out, "v(c%zu)", q);
    }
    dea_rings_end(&w->base);
}

static void write_strains(const writer *w, const dea_rings_ring *ring, size_t number)
{
    const bool stops = w->moving->stops, both = components(ring) == 2;
    const dea_rings_label a = dea_rings_label_of("a", number), b = dea_rings_label_of("b", number);
    const dea_rings_label e = stops ? dea_rings_label_of("e", number) : a, k = stops ? dea_rings_label_of("k", number) : b;
    write_radial(w, ring, e.text, 'u', "*per_r");
    if (both) {
        write_hoop(w, ring, k.text, 'u', "*per_r");
    }
    if (stops) {
        write_stop(w, a.text, e.text);
        if (both) {
            write_stop(w, b.text, k.text);
        }
    }
    dea_rings_thickness(&w->base, ring->strain, number);
    if (w->moving->damped) {
        write_radial(w, ring, dea_rings_label_of("c", number).text, 'v', w->rate);
        if (both) {
            write_hoop(w, ring, dea_rings_label_of("d", number).text, 'v', w->rate);
        }
        write_thinning(w, both, number);
    }
}

static bool has_sum(const dea_rings_moving *m)
{
    return m->branches > 0 || m->damped;
}

/* The stress with what its branches add; z relaxes to the stress with the time of the branch. */
static void write_branches(const writer *w, int a, size_t number)
{
    FILE *out = w->base.out;
    const char *held = a == 0 ? "x" : "y", *element = a == 0 ? "X" : "Y", *stress = a == 0 ? "s" : "t", *big = a == 0 ? "S" : "T";
    if (!has_sum(w->moving)) {
        return;
    }
    fprintf(out, "G%s%zu 0 %s%zu %s%zu 0 1\nR%s%zu %s%zu 0 1\n", element, number, held, number, stress, number, element, number, held,
            number);
    for (size_t i = 1; i <= w->moving->branches; i++) {
        char z[2 * DEA_PART_NAME], name[2 * DEA_PART_NAME];
        snprintf(z, sizeof z, "z%zu%s%zu", i, stress, number);
        snprintf(name, sizeof name, "Z%zu%s%zu", i, big, number);
        fprintf(out, "G%s 0 %s %s%zu %s 1\nC%s %s 0 {c_relax%zu}\nGB%s 0 %s%zu %s%zu %s {share%zu}\n", name, z, stress, number, z, name, z,
                i, name, held, number, stress, number, z, i);
    }
}

/* The damper: tau_KV times the rate of the stress. */
static void write_damper(const writer *w, const dea_rings_ring *ring, int a, size_t number)
{
    const dea_expr rate = w->moving->rates[ring->strain][a];
    if (!w->moving->damped || a >= components(ring)) {
        return;
    }
    dea_part_text_nodes_of(w->base.text, rate);
    dea_dialect_source_begin(w->base.text->dialect, w->base.out, DEA_CURRENT, dea_rings_label_of(damper_names[a], number).text, "0",
                             dea_rings_label_of(held_names[a], number).text);
    dea_part_text_write(w->base.text, w->moving->damp);
    fputc('*', w->base.out);
    dea_part_text_write(w->base.text, rate);
    dea_rings_end(&w->base);
}

static void write_ring(const writer *w, size_t index)
{
    const dea_rings_moving *m = w->moving;
    const dea_rings_ring *ring = &m->cards.rings[index];
    const size_t number = index + 1;
    const char kind = m->free ? 'u' : 'v';
    char factor[2 * DEA_PART_NAME];
    fprintf(w->base.out, "* ring %zu\n", number);
    write_strains(w, ring, number);
    for (int a = 0; a < stresses(m, ring); a++) {
        dea_rings_source(&w->base, dea_rings_label_of(stress_names[a], number).text, m->cauchy[ring->strain][a]);
        write_branches(w, a, number);
        write_damper(w, ring, a, number);
    }
    for (int a = 0; a < components(ring); a++) {
        dea_rings_source(&w->base, dea_rings_label_of(film_names[a], number).text, m->nominal[ring->strain][ring->electroded][a]);
    }
    snprintf(factor, sizeof factor, "%.40s*newton", dea_rings_parameter(&w->base, ring->along).text);
    dea_rings_spread(&w->base, ring, dea_rings_label_of("f", number).text, kind, factor);
    if (components(ring) == 2) {
        const dea_rings_label g = dea_rings_label_of("g", number);
        snprintf(factor, sizeof factor, "%.40s*newton", dea_rings_parameter(&w->base, ring->across).text);
        dea_rings_lever(&w->base, dea_rings_label_of("gg", number).text, dea_rings_node(&w->base, kind, ring->node).text, "0", g.text, 1.0,
                        factor);
    }
}

/* What stands for the nodes of the pool at a ring. */
typedef struct stand {
    char names[VARIABLES][DEA_PART_NAME];
    const char *nodes[VARIABLES];
} stand;

static void stand_at(const dea_rings_moving *m, size_t q, stand *at)
{
    const bool frame = m->cards.rings[q].strain == DEA_RINGS_FRAME;
    for (int i = 0; i < VARIABLES; i++) {
        const bool gone = frame && (i == DEA_RINGS_E2 || i == RATE2), stress = (i == HELD1 || i == HELD2) && !has_sum(m);
        const char *letters = stress ? "......st" : "abwcdrxy";
        snprintf(at->names[i], DEA_PART_NAME, gone ? "0" : i == PRESSURE ? "v(pressure)" : "v(%c%zu)", letters[i], q + 1);
        at->nodes[i] = at->names[i];
    }
}

void dea_rings_moving_write(const dea_rings_moving *m, const char *volts, const char *rate, dea_rings_extra *extra, const void *user,
                            dea_part_text *text)
{
    const writer w = {.base = {.cards = &m->cards, .text = text, .out = text->out, .pinned = true}, .moving = m, .rate = rate};
    dea_rings_begin(&w.base, "pressure");
    dea_part_text_write(text, m->push);
    for (int factor = 0; factor < 2; factor++) {
        fputc('*', text->out);
        dea_part_text_format(text, volts);
    }
    dea_rings_end(&w.base);
    for (size_t q = 0; q < m->cards.ring_count; q++) {
        stand at;
        stand_at(m, q, &at);
        dea_rings_place place = {.nodes = at.nodes};
        dea_rings_enter(&w.base, &place, q + 1, "");
        write_ring(&w, q);
        if (extra) {
            extra(user, &w.base, q);
        }
        dea_rings_leave(&w.base);
    }
}

void dea_rings_moving_swell(const dea_rings_moving *m, dea_part_text *text)
{
    const dea_rings_writer w = {.cards = &m->cards, .text = text, .out = text->out, .pinned = true};
    fputs("RSWELL swell 0 1\n", w.out);
    for (size_t q = 0; q < m->cards.ring_count; q++) {
        if (m->cards.rings[q].electroded) {
            stand at;
            stand_at(m, q, &at);
            dea_rings_place place = {.nodes = at.nodes};
            dea_rings_enter(&w, &place, q + 1, "h"); /* not the nodes of the ring */
            dea_rings_source(&w, dea_rings_label_of("h", q + 1).text, m->swell);
            dea_rings_leave(&w);
            fprintf(w.out, "GH%zu 0 swell h%zu 0 {%s}\n", q + 1, q + 1, dea_rings_parameter(&w, m->weights[q]).text);
        }
    }
}
