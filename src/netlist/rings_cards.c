#include "netlist/rings_cards.h"

#include <ctype.h>
#include <math.h>

#include "expression/formula.h"
#include "network/hyperelastic.h"

/* Stresses are written in MPa: nodes that held 1e5 Pa would round by more than the tolerances that displacements want. */
static const double mega = 1e6;

enum { NAME = 24 };

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

/* s_1 and s_2 of a kind of ring; @p pressure lambda_pre^4 M [MPa]. */
static void make_stress(const dea_symbols *symbols, dea_rings_strain strain, bool electroded, dea_expr pressure, dea_expr stress[2])
{
    dea_pool *pool = symbols->pool;
    const dea_expr e1 = dea_expr_node(pool, DEA_RINGS_E1);
    const dea_expr e2 = strain == DEA_RINGS_FRAME ? NUM(0.0) : strain == DEA_RINGS_UNIFORM ? e1 : dea_expr_node(pool, DEA_RINGS_E2);
    const dea_expr l1 = ADD(NUM(1.0), e1), l2 = ADD(NUM(1.0), e2);
    dea_hyperelastic_nominal(symbols, e1, e2, stress);
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

/* Number of a ring, from 1 at the centre. */
static size_t number_of(const dea_rings_cards *cards, const dea_rings_ring *ring)
{
    return (size_t)(ring - cards->rings) + 1;
}

static void name(dea_part_text *text, dea_expr ref, const char *what, size_t number)
{
    char whole[DEA_PART_NAME];
    snprintf(whole, sizeof whole, "%s%zu", what, number);
    dea_part_text_name(text, ref, whole, "");
    dea_part_text_use(text, ref);
}

/* A term is worth a node of its own where the strains stand in it so often, and more than a number times another: a source's
 * expression is differentiated by each of its nodes, and each node costs a row of the matrix. Measured with Yeoh's law. */
enum { WORTH = 3 };

static bool is_worth(const dea_part_text *text, dea_expr ref)
{
    const dea_term *term = &text->pool->terms[ref];
    const bool scaled = term->operation == DEA_MUL && (!text->moves[term->a] || !text->moves[term->b]);
    return text->places[ref] == 0 || (text->places[ref] >= WORTH && !scaled);
}

void dea_rings_cards_share(dea_part_text *text)
{
    for (int i = 0; i < text->pool->count; i++) {
        text->nodal[i] = text->nodal[i] && is_worth(text, i);
    }
}

void dea_rings_cards_declare(const dea_rings_cards *cards, dea_part_text *text)
{
    dea_rings_cards_share(text);
    bool declared[DEA_RINGS_STRAINS][2] = {{false}};
    for (size_t q = 0; q < cards->ring_count; q++) {
        const dea_rings_ring *ring = &cards->rings[q];
        name(text, ring->radial, "radial", q + 1);
        name(text, ring->along, "along", q + 1);
        if (ring->strain != DEA_RINGS_FRAME) {
            name(text, ring->hoop, "hoop", q + 1);
            name(text, ring->across, "across", q + 1);
        }
        bool *done = &declared[ring->strain][ring->electroded];
        for (int a = 0; a < stresses_of(ring) && !*done; a++) {
            dea_part_text_use(text, stress_of(cards, ring)[a]);
        }
        *done = true;
    }
}

typedef struct writer {
    const dea_rings_cards *cards;
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

/* A transconductance of @p slope times a parameter, from a control node into another; without parameter, NULL. */
static void write_lever(const writer *w, const char *element, const char *into, bool out_of, const char *control, double slope,
                        const char *factor)
{
    fprintf(w->out, "G%s %s %s %s 0 {", element, out_of ? into : "0", out_of ? "0" : into, control);
    dea_part_number(w->out, slope);
    fprintf(w->out, factor ? "*%s}\n" : "}\n", factor);
}

/* A node of the ring: that name and the ring's number. */
typedef struct label {
    char text[NAME];
} label;

static label label_of(const char *name, size_t number)
{
    label l;
    snprintf(l.text, sizeof l.text, "%s%zu", name, number);
    return l;
}

/* A parameter as text of a card, or what stands for one where it is swept. */
static const char *parameter(const writer *w, dea_expr ref, char name[DEA_PART_NAME])
{
    return dea_part_text_parameter(w->text, ref, name);
}

/* Nodes that strain a ring: number, and its column of the slopes. */
static bool strains(const writer *w, const dea_rings_ring *ring, size_t column, size_t *node, double *slope)
{
    *node = ring->first + column;
    *slope = w->cards->slopes[!ring->disc].of[ring->place][column];
    return *node > 0 && *node <= w->cards->node_count && fabs(*slope) > 1e-12; /* else 0 but for rounding */
}

static size_t columns_of(const writer *w, const dea_rings_ring *ring)
{
    return (ring->disc ? w->cards->mesh.disc : w->cards->mesh.annulus) + 1;
}

/* v(into) = the slopes' sum of the displacements, times a factor. */
static void write_gradient(const writer *w, const dea_rings_ring *ring, const char *into, const char *factor)
{
    for (size_t i = 0; i < columns_of(w, ring); i++) {
        size_t node;
        double slope;
        if (strains(w, ring, i, &node, &slope)) {
            label element;
            snprintf(element.text, sizeof element.text, "%s_%zu", into, node);
            write_lever(w, element.text, into, false, label_of("u", node).text, slope, factor);
        }
    }
    fprintf(w->out, "R%s %s 0 1\n", into, into);
}

/* Strains of a ring whose radii move with the swept scalar. */
static void write_swept_strains(const writer *w, const dea_rings_ring *ring, size_t number)
{
    const label d = label_of("d", number), a = label_of("a", number), b = label_of("b", number);
    write_gradient(w, ring, d.text, NULL);
    begin(w, a.text);
    dea_part_text_write(w->text, ring->radial);
    fprintf(w->out, "*v(%s)", d.text);
    end(w);
    if (ring->strain == DEA_RINGS_FREE) {
        begin(w, b.text);
        dea_part_text_write(w->text, ring->hoop);
        fprintf(w->out, "*v(u%zu)", ring->node);
        end(w);
    }
}

static void write_strains(const writer *w, const dea_rings_ring *ring, size_t number)
{
    char factor[DEA_PART_NAME];
    const label a = label_of("a", number), b = label_of("b", number);
    write_gradient(w, ring, a.text, parameter(w, ring->radial, factor));
    if (ring->strain == DEA_RINGS_FREE) {
        write_lever(w, b.text, b.text, false, label_of("u", ring->node).text, 1.0, parameter(w, ring->hoop, factor));
        fprintf(w->out, "R%s %s 0 1\n", b.text, b.text);
    }
}

static bool is_swept(const writer *w, dea_expr ref)
{
    return w->text->moves[ref];
}

/* Stresses s and t; of a ring whose levers are swept times those. */
static void write_stresses(const writer *w, const dea_rings_ring *ring, size_t number)
{
    const dea_expr *stress = stress_of(w->cards, ring), levers[2] = {ring->along, ring->across};
    for (int a = 0; a < stresses_of(ring); a++) {
        dea_part_text_nodes_of(w->text, stress[a]);
    }
    for (int a = 0; a < stresses_of(ring); a++) {
        begin(w, label_of(a == 0 ? "s" : "t", number).text);
        dea_part_text_write(w->text, stress[a]);
        if (is_swept(w, levers[a])) {
            fputc('*', w->out);
            dea_part_text_write(w->text, levers[a]);
        }
        end(w);
    }
}

/* Forces of a ring on its nodes, as currents out of them. */
static void write_forces(const writer *w, const dea_rings_ring *ring, size_t number)
{
    char name[DEA_PART_NAME];
    const bool swept = is_swept(w, ring->along);
    const label s = label_of("s", number), t = label_of(ring->strain == DEA_RINGS_FREE ? "t" : "s", number);
    for (size_t i = 0; i < columns_of(w, ring); i++) {
        size_t node;
        double slope;
        if (strains(w, ring, i, &node, &slope)) {
            label element;
            snprintf(element.text, sizeof element.text, "f%zu_%zu", number, node);
            write_lever(w, element.text, label_of("u", node).text, true, s.text, slope, swept ? NULL : parameter(w, ring->along, name));
        }
    }
    if (ring->strain != DEA_RINGS_FRAME) {
        const double share = swept && ring->strain == DEA_RINGS_UNIFORM ? 0.5 : 1.0; /* across over along, where s holds along s_1 */
        write_lever(w, label_of("h", number).text, label_of("u", ring->node).text, true, t.text, share,
                    swept ? NULL : parameter(w, ring->across, name));
    }
}

void dea_rings_cards_write(const dea_rings_cards *cards, dea_part_text *text)
{
    writer w = {cards, text, text->out};
    for (size_t q = 0; q < cards->ring_count; q++) {
        const dea_rings_ring *ring = &cards->rings[q];
        const size_t number = number_of(cards, ring);
        char suffix[NAME], a[NAME], b[NAME];
        snprintf(suffix, sizeof suffix, "_%zu", number);
        snprintf(a, sizeof a, "v(a%zu)", number);
        snprintf(b, sizeof b, "v(b%zu)", number);
        const char *const nodes[] = {a, b};
        text->nodes = nodes;
        text->suffix = suffix;
        (is_swept(&w, ring->radial) ? write_swept_strains : write_strains)(&w, ring, number);
        write_stresses(&w, ring, number);
        write_forces(&w, ring, number);
        dea_part_text_again(text);
        text->nodes = NULL;
    }
}
