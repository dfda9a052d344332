#include "netlist/rings_cards.h"


#include "expression/derivative.h"
#include "expression/formula.h"
#include "netlist/rings_text.h"
#include "network/hyperelastic.h"

/* Stresses are written in MPa: nodes that held 1e5 Pa would round by more than the tolerances that displacements want. */
static const double mega = 1e6;

/* Reference radius over F and dR/dx over F at a place x of [-1, 1] of an element. */
typedef struct place {
    dea_expr radius, stretch;
} place;

static place place_of(const dea_symbols *symbols, const dea_rings_mesh *mesh, bool disc, double x)
{
    dea_pool *pool = symbols->pool;
    const dea_expr b = symbols->coverage, one = NUM(1.0);
    if (disc) {
        return (place){SCALE(0.5 * (1.0 + x), b), SCALE(0.5, b)};
    }
    if (mesh->logarithmic) { /* R = F B^((1 - x)/2) */
        const dea_expr radius = x == 1.0 ? one : x == -1.0 ? b : EXP(SCALE(0.5 * (1.0 - x), LN(b)));
        return (place){radius, SCALE(-0.5, MUL(radius, LN(b)))};
    }
    const dea_expr half = SCALE(0.5, SUB(one, b));
    return (place){x == 1.0 ? one : ADD(b, SCALE(1.0 + x, half)), half};
}

static void make_element(dea_rings_cards *cards, bool disc)
{
    dea_pool *pool = cards->symbols.pool;
    const size_t degree = disc ? cards->mesh.disc : cards->mesh.annulus, first = disc ? 0 : cards->mesh.disc;
    const dea_rings_slopes *slopes = &cards->slopes[!disc];
    for (size_t q = 0; q <= degree; q++) {
        const place at = place_of(&cards->symbols, &cards->mesh, disc, slopes->places[q]);
        const bool frame = first + q > cards->node_count;
        if (first + q == 0) {
            continue; /* at the centre a ring has no volume */
        }
        dea_rings_ring *ring = &cards->rings[cards->ring_count++];
        *ring = (dea_rings_ring){.disc = disc,
                                 .electroded = disc == (cards->symbols.kind == DEA_DOT),
                                 .place = q,
                                 .first = first,
                                 .node = first + q,
                                 .strain = frame ? DEA_RINGS_FRAME : disc && degree == 1 ? DEA_RINGS_UNIFORM : DEA_RINGS_FREE};
        ring->radial = DIV(NUM(1.0), at.stretch);
        ring->hoop = DIV(NUM(1.0), at.radius);
        ring->along = SCALE(slopes->weights[q], at.radius);
        ring->across = SCALE(slopes->weights[q], at.stretch);
    }
}

/* e_2 of a kind of ring. */
static dea_expr hoop_of(dea_pool *pool, dea_rings_strain strain)
{
    return strain == DEA_RINGS_FRAME ? NUM(0.0) : dea_expr_node(pool, strain == DEA_RINGS_UNIFORM ? DEA_RINGS_E1 : DEA_RINGS_E2);
}

void dea_rings_cauchy(const dea_symbols *symbols, dea_rings_strain strain, dea_expr stress[2])
{
    dea_pool *pool = symbols->pool;
    const dea_expr e1 = dea_expr_node(pool, DEA_RINGS_E1), e2 = hoop_of(pool, strain), e3 = dea_expr_node(pool, DEA_RINGS_E3);
    dea_hyperelastic_cauchy(symbols, e1, e2, stress);
    /* lambda_3^2 = (1 + e_3)^2/lambda_pre^4 */
    const dea_expr fourth = SQUARE(SQUARE(symbols->prestretch)), own = MUL(DIV(NUM(1.0), fourth), MUL(e3, ADD(NUM(2.0), e3)));
    const dea_expr thin = dea_hyperelastic_thin(symbols, e1, e2), minus = SCALE(-1.0, thin);
    for (int a = 0; a < 2; a++) {
        stress[a] = dea_expr_replace(pool, stress[a], thin, own);
        stress[a] = dea_expr_replace(pool, stress[a], minus, SCALE(-1.0, own));
    }
}

/* s_1 and s_2 of a kind of ring; @p pressure lambda_pre^4 M [MPa]. */
static void make_stress(const dea_symbols *symbols, dea_rings_strain strain, bool electroded, dea_expr pressure, dea_expr stress[2])
{
    dea_pool *pool = symbols->pool;
    const dea_expr e1 = dea_expr_node(pool, DEA_RINGS_E1);
    const dea_expr e2 = hoop_of(pool, strain), rest = dea_symbols_rest_stress(symbols);
    const dea_expr l1 = ADD(NUM(1.0), e1), l2 = ADD(NUM(1.0), e2), l3 = ADD(NUM(1.0), dea_expr_node(pool, DEA_RINGS_E3));
    dea_rings_cauchy(symbols, strain, stress);
    stress[0] = MUL(MUL(SUB(stress[0], MUL(rest, e1)), l2), l3); /* 1/(1 + e_1) */
    stress[1] = MUL(MUL(SUB(stress[1], MUL(rest, e2)), l1), l3);
    if (electroded && symbols->skin) {
        stress[0] = ADD(stress[0], DIV(dea_hyperelastic_skin(symbols, e1, e2), l1));
        stress[1] = ADD(stress[1], DIV(dea_hyperelastic_skin(symbols, e2, e1), l2));
    }
    if (electroded) {
        pressure = MUL(pressure, dea_symbols_electric(symbols, l1, l2).first);
        stress[0] = SUB(stress[0], MUL(pressure, MUL(l1, SQUARE(l2))));
        stress[1] = SUB(stress[1], MUL(pressure, MUL(l2, SQUARE(l1))));
    }
}

/* Moduli in MPa. */
static void scale_law(dea_pool *pool, const dea_law *law, const dea_expr *constants, dea_expr *scaled)
{
    for (size_t i = 0; i < DEA_LAW_CONSTANTS; i++) {
        scaled[i] = law->constants[i % law->constant_count].modulus ? SCALE(1.0 / mega, constants[i]) : constants[i];
    }
}

void dea_rings_cards_make(const dea_symbols *symbols, dea_rings_mesh mesh, dea_rings_cards *cards)
{
    dea_pool *pool = symbols->pool;
    *cards = (dea_rings_cards){.symbols = *symbols, .mesh = mesh, .node_count = mesh.disc + mesh.annulus - 1, .edge = mesh.disc};
    scale_law(pool, symbols->law, symbols->constants, cards->symbols.constants);
    if (symbols->skin) {
        scale_law(pool, symbols->skin, symbols->skin_constants, cards->symbols.skin_constants);
    }
    const dea_expr pressure = SCALE(1.0 / mega, MUL(dea_symbols_pressure(symbols), SQUARE(SQUARE(symbols->prestretch))));
    for (int strain = 0; strain < DEA_RINGS_STRAINS; strain++) {
        make_stress(&cards->symbols, (dea_rings_strain)strain, false, pressure, cards->stress[strain][0]);
        make_stress(&cards->symbols, (dea_rings_strain)strain, true, pressure, cards->stress[strain][1]);
    }
    const dea_expr thickness = DIV(SQUARE(symbols->prestretch), symbols->film_thickness);
    const dea_expr held = dea_symbols_springs(symbols, MUL(symbols->frame_radius, dea_expr_node(pool, DEA_RINGS_E1)));
    const dea_expr load = SUB(held, dea_symbols_force(symbols));
    cards->load = SCALE(0.5 / (DEA_PI * mega), MUL(DIV(load, symbols->frame_radius), thickness));
    dea_rings_slopes_of(mesh.disc, &cards->slopes[0]);
    dea_rings_slopes_of(mesh.annulus, &cards->slopes[1]);
    make_element(cards, true);
    make_element(cards, false);
}

/* The stresses of a ring; a uniform disc has one. */
static const dea_expr *stress_of(const dea_rings_cards *cards, const dea_rings_ring *ring)
{
    return cards->stress[ring->strain][ring->electroded];
}

static int stresses_of(const dea_rings_ring *ring)
{
    return ring->strain == DEA_RINGS_FREE ? 2 : 1; /* at the frame nothing moves with s_2 */
}

static bool is_scaled(const dea_part_text *text, const dea_term *term)
{
    return term->operation == DEA_MUL && !(text->terms[term->a].moves && text->terms[term->b].moves);
}

/* A term is worth a node of its own where the strains stand in it so often, and more than a number times another: a source's
 * expression is differentiated by each of its nodes, and each node costs a row of the matrix. Measured with Yeoh's law. */
enum { WORTH = 3 };

void dea_rings_cards_share(dea_part_text *text)
{
    for (int i = 0; i < text->pool->count; i++) {
        const int places = text->terms[i].places;
        text->terms[i].nodal = text->terms[i].nodal && (places == 0 || (places >= WORTH && !is_scaled(text, &text->pool->terms[i])));
    }
}

static void mark_factor(dea_part_text *text, dea_expr ref)
{
    const dea_term *term = &text->pool->terms[ref];
    if (is_scaled(text, term)) {
        mark_factor(text, text->terms[term->a].moves ? term->a : term->b);
    } else {
        text->terms[ref].factor = true;
    }
}

/* The derivative of a product repeats what its other factors are, so that each of them in which the strains stand more than once is
 * worth a node, shared or not. At rest alone: what moves has as many rows again. Measured with Yeoh's law. */
static void share_still(dea_part_text *text)
{
    for (int i = 0; i < text->pool->count; i++) {
        const dea_term *term = &text->pool->terms[i];
        if (term->operation == DEA_MUL && text->terms[term->a].places > 0 && text->terms[term->b].places > 0) {
            mark_factor(text, term->a);
            mark_factor(text, term->b);
        }
        text->terms[i].nodal = text->terms[i].nodal && !is_scaled(text, term);
    }
}

void dea_rings_cards_declare(const dea_rings_cards *cards, dea_part_text *text)
{
    share_still(text);
    bool declared[DEA_RINGS_STRAINS][2] = {{false}};
    for (size_t q = 0; q < cards->ring_count; q++) {
        const dea_rings_ring *ring = &cards->rings[q];
        dea_rings_name(text, ring->radial, "radial", q + 1);
        dea_rings_name(text, ring->along, "along", q + 1);
        if (ring->strain != DEA_RINGS_FRAME) {
            dea_rings_name(text, ring->hoop, "hoop", q + 1);
            dea_rings_name(text, ring->across, "across", q + 1);
        }
        bool *done = &declared[ring->strain][ring->electroded];
        for (int a = 0; a < stresses_of(ring) && !*done; a++) {
            dea_part_text_use(text, stress_of(cards, ring)[a]);
        }
        *done = true;
    }
    dea_part_text_use(text, cards->load);
}

/* Strains of a ring; their radii may move with the swept scalar. */
static void write_swept_strains(const dea_rings_writer *w, const dea_rings_ring *ring, size_t number)
{
    const dea_rings_label d = dea_rings_label_of("d", number);
    dea_rings_gradient(w, ring, d.text, 'u', NULL);
    dea_rings_begin(w, dea_rings_label_of("a", number).text);
    dea_part_text_write(w->text, ring->radial);
    fprintf(w->out, "*v(%s)", d.text);
    dea_rings_end(w);
    if (ring->strain == DEA_RINGS_FREE) {
        dea_rings_begin(w, dea_rings_label_of("b", number).text);
        dea_part_text_write(w->text, ring->hoop);
        fprintf(w->out, "*v(u%zu)", ring->node);
        dea_rings_end(w);
    }
}

static void write_strains(const dea_rings_writer *w, const dea_rings_ring *ring, size_t number)
{
    dea_rings_gradient(w, ring, dea_rings_label_of("a", number).text, 'u', dea_rings_parameter(w, ring->radial).text);
    if (ring->strain == DEA_RINGS_FREE) {
        const dea_rings_label b = dea_rings_label_of("b", number);
        dea_rings_lever(w, b.text, "0", b.text, dea_rings_node(w, 'u', ring->node).text, 1.0, dea_rings_parameter(w, ring->hoop).text);
        dea_rings_sum(w, b.text);
    }
}

/* Stresses s and t; of a ring whose levers are swept times those. */
static void write_stresses(const dea_rings_writer *w, const dea_rings_ring *ring, size_t number)
{
    const dea_expr *stress = stress_of(w->cards, ring), levers[2] = {ring->along, ring->across};
    for (int a = 0; a < stresses_of(ring); a++) {
        dea_part_text_nodes_of(w->text, stress[a]);
    }
    for (int a = 0; a < stresses_of(ring); a++) {
        dea_rings_begin(w, dea_rings_label_of(a == 0 ? "s" : "t", number).text);
        dea_part_text_write(w->text, stress[a]);
        if (w->text->terms[levers[a]].moves) {
            fputc('*', w->out);
            dea_part_text_write(w->text, levers[a]);
        }
        dea_rings_end(w);
    }
}

/* Forces of a ring on its nodes, as currents out of them. */
static void write_forces(const dea_rings_writer *w, const dea_rings_ring *ring, size_t number)
{
    const bool swept = w->text->terms[ring->along].moves;
    const dea_rings_label s = dea_rings_label_of("s", number), t = dea_rings_label_of(ring->strain == DEA_RINGS_FREE ? "t" : "s", number);
    dea_rings_spread(w, ring, s.text, 'u', swept ? NULL : dea_rings_parameter(w, ring->along).text);
    if (ring->strain != DEA_RINGS_FRAME) {
        const double share = swept && ring->strain == DEA_RINGS_UNIFORM ? 0.5 : 1.0; /* across over along, where s holds along s_1 */
        dea_rings_lever(w, dea_rings_label_of("h", number).text, dea_rings_node(w, 'u', ring->node).text, "0", t.text, share,
                        swept ? NULL : dea_rings_parameter(w, ring->across).text);
    }
}

/* The springs between edge and frame, and the force on the edge. */
static void write_load(const dea_rings_writer *w)
{
    if (dea_expr_constant(w->cards->symbols.pool, w->cards->load) == 0.0) {
        return;
    }
    const dea_rings_label u = dea_rings_node(w, 'u', w->cards->edge);
    dea_rings_spring(w, u.text, u.text, w->cards->load);
}

void dea_rings_cards_write(const dea_rings_cards *cards, dea_part_text *text)
{
    const dea_rings_writer w = {.cards = cards, .text = text, .out = text->out};
    for (size_t q = 0; q < cards->ring_count; q++) {
        const dea_rings_ring *ring = &cards->rings[q];
        char names[DEA_RINGS_VARIABLES][DEA_PART_NAME];
        const char *nodes[DEA_RINGS_VARIABLES];
        for (int i = 0; i < DEA_RINGS_VARIABLES; i++) {
            snprintf(names[i], sizeof names[i], "v(%c%zu)", "abw"[i], q + 1);
            nodes[i] = names[i];
        }
        dea_rings_place here = {.nodes = nodes};
        dea_rings_enter(&w, &here, q + 1, "");
        (text->terms[ring->radial].moves ? write_swept_strains : write_strains)(&w, ring, q + 1);
        dea_rings_thickness(&w, ring->strain, q + 1);
        write_stresses(&w, ring, q + 1);
        write_forces(&w, ring, q + 1);
        dea_rings_leave(&w);
    }
    write_load(&w);
}
