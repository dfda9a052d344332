#include "netlist/part.h"

#include <math.h>
#include <stdarg.h>
#include <stdlib.h>
#include <string.h>

#include "expression/derivative.h"
#include "expression/formula.h"
#include "film/point.h"
#include "film/second.h"
#include "netlist/mobility.h"
#include "netlist/rings_part.h"
#include "support/memory_text.h"

/* The symbols of a part's network: parameters that the checks of the subcircuit have put into their ranges. */
enum {
    RADIUS,
    COVER,
    THICK,
    STRETCH,
    EPS_R,
    Y_GIVEN,
    Y_FREE,
    RHO,
    AREAL,
    LAYERS,
    VOLTAGE,  /* always replaced by a number */
    CONSTANT, /* the first of those of the law */
    DAMP = CONSTANT + DEA_LAW_CONSTANTS, /* made by the checks; of the membrane alone */
    EPS_SLOPE,                           /* of a permittivity that follows the strain */
    SKIN_THICK,
    SKIN_CONSTANT, /* the first of those of the skin's law */
    SYMBOLS = SKIN_CONSTANT + DEA_LAW_CONSTANTS
};

static const char *const symbol_names[SYMBOLS] = {"radius",  "cover",  "thick", "stretch", "eps_r",
                                                  "y_given", "y_free", "rho",   "areal",   "layer", "",
                                                  "film1",   "film2",  "film3", "film4",   "film5",
                                                  "film6",   "film7",  "film8", "damp",    "permittivity_per_stretch",
                                                  "skin",    "skin1",  "skin2", "skin3",   "skin4",
                                                  "skin5",   "skin6",  "skin7", "skin8"};
_Static_assert(DEA_LAW_CONSTANTS == 8, "one name a constant");

typedef struct part {
    const dea_dialect *dialect;
    FILE *out;
    dea_kind kind;
    const dea_law *law, *skin; /* of the film; of the electrodes' skin, NULL: there is none */
    size_t constants, skin_constants; /* of the laws, in use */
    bool follows;     /* the permittivity follows the strain */
    bool linear;
    bool joined; /* one of two films on an edge: a subcircuit inside the part, whose outputs are pins */
    size_t branches;
    dea_dynamics elements; /* which there are: all, whatever their numbers turn out to be */
    dea_mobility film;     /* owned; of the membrane that of `ring`, for ranges and numbers at rest. The voltage is taken out */
    dea_cards cards;       /* owned */
    dea_rings_part *rings; /* owned; NULL: one node */
    dea_expr push_slope;          /* of phi [N/V^2 m] */
    dea_expr c_rest;              /* C(0) [F] */
    dea_expr k_rest, k_film;      /* stiffness at rest, and of that what damps and relaxes [N/m] */
    dea_expr field;               /* true field of 1 V */
    dea_expr mass;                /* of film and electrodes */
    dea_expr divide, width;       /* r_a, r - r_a */
    dea_expr *taut;               /* owned; > 0 while taut, without voltage */
    dea_expr *loosen;             /* owned; what 1 V adds to it; grows with U^2 */
} part;

const char *dea_part_name_of(dea_kind kind, const dea_model *model, char name[DEA_PART_TITLE])
{
    const dea_model_part *of = model->part;
    if (!of) {
        return NULL;
    }
    snprintf(name, DEA_PART_TITLE, "%s%s", kind == DEA_DOT ? "dea_dot" : "dea_lens", of->ending);
    return name;
}

static dea_expr at_volts(dea_pool *pool, dea_expr ref, double volts)
{
    return dea_expr_put(pool, ref, DEA_SYMBOL, VOLTAGE, NUM(volts));
}

static dea_symbols symbols_of(dea_pool *pool, const part *p)
{
    dea_expr s[SYMBOLS];
    for (int i = 0; i < SYMBOLS; i++) {
        s[i] = dea_expr_symbol(pool, i);
    }
    dea_symbols symbols = {.pool = pool,
                           .kind = p->kind,
                           .law = p->law,
                           .frame_radius = s[RADIUS],
                           .coverage = s[COVER],
                           .film_thickness = MUL(s[LAYERS], s[THICK]),
                           .layers = s[LAYERS],
                           .prestretch = s[STRETCH],
                           .permittivity = MUL(SCALE(DEA_EPSILON_0, s[EPS_R]), SQUARE(s[LAYERS])),
                           .electrostriction = p->follows ? DIV(s[EPS_SLOPE], s[EPS_R]) : NUM(0.0),
                           .breakdown = NUM(INFINITY),
                           .loaded = p->joined,
                           .skin = p->skin,
                           .voltage = s[VOLTAGE]};
    for (size_t i = 0; i < DEA_LAW_CONSTANTS; i++) {
        symbols.constants[i] = i < p->constants ? s[(size_t)CONSTANT + i] : NUM(0.0);
        symbols.skin_constants[i] = i < p->skin_constants ? s[(size_t)SKIN_CONSTANT + i] : NUM(0.0);
    }
    symbols.skin_share = p->skin ? DIV(s[SKIN_THICK], symbols.film_thickness) : NUM(0.0);
    symbols.modulus = ADD(s[Y_GIVEN], MUL(s[Y_FREE], dea_symbols_modulus(&symbols)));
    return symbols;
}

/* Rayleigh's mass with Lame's shape: disc pi a^2/2, annulus 2 pi a^2 q/x^2 with x = 1 - B^2 and q = -ln B - x + (1 - B^4)/4; the
 * film with a = r_a/lambda_pre, its electrode with a = r_a. */
static dea_expr moving_mass(const dea_symbols *symbols)
{
    dea_pool *pool = symbols->pool;
    const dea_expr one = NUM(1.0);
    const dea_expr b2 = SQUARE(symbols->coverage);
    const dea_expr x = SUB(one, b2);
    const dea_expr q = SUB(SUB(SCALE(0.25, SUB(one, SQUARE(b2))), x), LN(symbols->coverage));
    const dea_expr square = SQUARE(MUL(symbols->frame_radius, symbols->coverage));
    const dea_expr disc = SCALE(0.5 * DEA_PI, square);
    const dea_expr annulus = SCALE(2.0 * DEA_PI, MUL(square, DIV(q, SQUARE(x))));
    const dea_expr film = DIV(ADD(disc, annulus), SQUARE(symbols->prestretch));
    return ADD(MUL(MUL(dea_expr_symbol(pool, RHO), symbols->film_thickness), film),
               MUL(dea_expr_symbol(pool, AREAL), symbols->kind == DEA_DOT ? disc : annulus));
}

static dea_status tell_memory(dea_error *error)
{
    return dea_fail(error, DEA_ERROR_MEMORY, "out of memory while a part is written");
}

/* The rings of the membrane. */
static dea_status derive_rings(part *p, const dea_symbols *symbols, dea_error *error)
{
    dea_pool *pool = symbols->pool;
    p->rings = malloc(sizeof *p->rings);
    if (!p->rings) {
        return tell_memory(error);
    }
    const dea_rings_numbers numbers = {dea_expr_symbol(pool, RHO), dea_expr_symbol(pool, AREAL), dea_expr_symbol(pool, DAMP), 1e6, 0.0};
    dea_rings_part_make(symbols, &numbers, p->branches, p->rings);
    return DEA_OK;
}

/* What tells whether the film is taut. */
static dea_status derive_tensions(part *p, const dea_model_part *of, dea_error *error)
{
    const dea_network *network = &p->film.network;
    dea_pool *pool = &p->film.network.pool;
    p->taut = calloc((size_t)network->tension_count + 1, sizeof *p->taut);
    p->loosen = calloc((size_t)network->tension_count + 1, sizeof *p->loosen);
    if (!p->taut || !p->loosen) {
        return tell_memory(error);
    }
    for (int i = 0; i < network->tension_count; i++) {
        const dea_expr tension = SCALE(of->tension, network->tension[i]);
        p->taut[i] = at_volts(pool, tension, 0.0);
        const dea_expr loaded = at_volts(pool, tension, 1.0);
        p->loosen[i] = loaded == p->taut[i] ? NUM(0.0) : SCALE(1.0 / of->stress, SUB(loaded, p->taut[i]));
    }
    return DEA_OK;
}

/* All expressions of the part, from the model's network under a symbolic voltage. */
static dea_status derive(part *p, const dea_model *model, dea_error *error)
{
    const dea_model_part *of = model->part;
    dea_network *network = &p->film.network;
    dea_pool *pool = &network->pool;
    (void)NUM(0.0);
    if (pool->exhausted) {
        return tell_memory(error);
    }
    const dea_symbols symbols = symbols_of(pool, p);
    dea_status status = dea_network_build_symbols(&symbols, model->stand_in ? model->stand_in : model, network, error);
    if (status == DEA_OK) {
        dea_network_stress counted[DEA_STRESSES];
        p->elements.stress_count = (size_t)dea_network_stresses(network, counted);
        status = dea_mobility_take(&p->film, error);
    }
    if (status != DEA_OK) {
        return status;
    }
    p->film.push = at_volts(pool, p->film.push, 1.0);
    p->push_slope = dea_expr_slope(pool, p->film.push);
    p->k_rest =
        SCALE(of->stress, dea_expr_at_rest(pool, ADD(dea_expr_slope(pool, p->film.tension), p->film.resistance)));
    p->k_film = SCALE(of->stress, dea_expr_at_rest(pool, p->film.resistance));
    p->c_rest = dea_expr_at_rest(pool, network->capacitance);
    p->field = at_volts(pool, network->field, 1.0);
    p->mass = moving_mass(&symbols);
    p->divide = MUL(symbols.frame_radius, symbols.coverage);
    p->width = dea_symbols_annulus_width(&symbols);
    if (model->membrane && !pool->exhausted) {
        status = derive_rings(p, &symbols, error);
    }
    status = status ? status : derive_tensions(p, of, error);
    return status == DEA_OK && pool->exhausted ? tell_memory(error) : status;
}

static void line(const part *p, const char *format, ...) DEA_PRINTF(2, 3);

static void line(const part *p, const char *format, ...)
{
    va_list values;
    va_start(values, format);
    vfprintf(p->out, format, values);
    va_end(values);
    fputc('\n', p->out);
}

/* What stands before the names of a skin's parameters. */
#define SKIN "skin_"

/* A parameter of the subcircuit, the name under which it is used once it is in its range, and that range. */
typedef struct range {
    const char *raw, *name;
    const char *low, *high;
} range;

static void check(const part *p, const range *r, int *count)
{
    line(p, ".param %s={min(max(%s,%s),%s)}", r->name, r->raw, r->low, r->high);
    line(p, ".param ok%d={ok%d*(1-min(max(abs(%s-(%s))-1e-12*abs(%s),0)*1e30,1))}", *count, *count - 1, r->name, r->raw, r->name);
    ++*count;
}

static void check_branches(const part *p, int *count)
{
    char g[32], share[32], tau[32], time[32];
    line(p, ".param left0={1}");
    for (size_t i = 1; i <= p->branches; i++) {
        snprintf(g, sizeof g, "g%zu", i);
        snprintf(share, sizeof share, "part%zu", i);
        snprintf(tau, sizeof tau, "tau%zu", i);
        snprintf(time, sizeof time, "relax%zu", i);
        check(p, &(range){g, share, "0", "1"}, count);
        check(p, &(range){tau, time, "1e-12", "1e12"}, count);
        line(p, ".param left%zu={left%zu-g%zu}", i, i - 1, i);
    }
    snprintf(g, sizeof g, "left%zu", p->branches);
    check(p, &(range){g, "g_rest", "1e-9", "1"}, count);
    for (size_t i = 1; i <= p->branches; i++) {
        line(p, ".param share%zu={part%zu/g_rest}", i, i);
    }
}

/* A lens liquid of fixed volume under a cap of radius R_c: h_0 = a^2/(R_c + sqrt(R_c^2 - a^2)). */
static void check_optics(const part *p, int *count)
{
    line(p, "* optics: radius of the cap at rest, its height [m] and (height/r_a)^2; lens_on is 0 without a focal length");
    check(p, &(range){"focal_length", "focus", "0", "1e3"}, count);
    check(p, &(range){"refractive_index", "refract", "1.000001", "10"}, count);
    line(p, ".param lens_on={min(focus*1e30,1)}");
    line(p, ".param a_lens={radius*cover}");
    line(p, ".param bend={lens_on*focus*(refract-1)+(1-lens_on)*2*a_lens}");
    check(p, &(range){"bend", "cap", "a_lens", "1e9"}, count);
    line(p, ".param height={a_lens*a_lens/(cap+sqrt((cap-a_lens)*(cap+a_lens)))}");
    line(p, ".param flat={height*height/(a_lens*a_lens)}");
}

/* @p used constants of a law, moduli in the part's unit of stress: those with a bound of their own are put behind it. @p whose
 * stands before their names. */
static void check_law(const part *p, double stress, const dea_law *law, size_t used, const char *whose, const char *const *symbols, int *count)
{
    char name[DEA_QUANTITY_NAME], raw[2 * DEA_PART_NAME];
    for (size_t i = 0; i < used; i++) {
        const dea_constant *constant = &law->constants[i % law->constant_count];
        dea_constant_name(law, i, name);
        snprintf(raw, sizeof raw, constant->modulus ? "%s%s/%.0f" : "%s%s", whose, name, stress);
        if (constant->low == 0.0) {
            const bool small = constant->modulus && stress > 1.0;
            check(p, &(range){raw, symbols[i], small ? "1e-6" : "1e-3", small ? "1e6" : "1e12"}, count);
        } else {
            line(p, ".param %s={%s}", symbols[i], raw);
        }
    }
}

static void check_laws(const part *p, double stress, int *count)
{
    line(p, "* constants of the law, moduli in units of %.0f Pa", stress);
    check_law(p, stress, p->law, p->constants, "", &symbol_names[CONSTANT], count);
    if (p->skin) {
        line(p, "* skin of the electrodes: its thickness, constants of its law");
        check(p, &(range){"skin_thickness", symbol_names[SKIN_THICK], "1e-12", "1"}, count);
        check_law(p, stress, p->skin, p->skin_constants, SKIN, &symbol_names[SKIN_CONSTANT], count);
    }
}

/* True of what the parameters decide, not the film's motion, and is neither a number nor one of them, which its own card checks. */
static bool is_made(const part *p, dea_expr ref)
{
    return p->film.network.pool.terms[ref].operation >= DEA_ADD && !p->cards.text.terms[ref].moves;
}

/* What else must be positive, from the network: the constants fit together, and the pre-stretch lies where the law holds. */
static void check_ranges(const part *p, int count)
{
    char name[DEA_PART_NAME];
    for (int i = 0; i < p->film.network.range_count; i++) {
        if (is_made(p, p->film.network.range[i])) {
            line(p, ".param ok%d={ok%d*min(max(%s*1e30,0),1)}", count, count - 1,
                 dea_part_text_parameter(&p->cards.text, p->film.network.range[i], name));
            count++;
        }
    }
    line(p, ".param ok={ok%d}", count - 1);
}

/* Every number that the network uses is in its range; how many checks that makes. */
static int write_checks(const part *p, const dea_model_part *of)
{
    static const range ranges[] = {
        {"frame_radius", "radius", "1e-6", "1e3"},
        {"coverage", "cover", "1e-6", "0.999999"},
        {"film_thickness", "thick", "1e-9", "1"},
        {"layers", "layer", "1", "1e6"},
        {"prestretch", "stretch", "1", "100"},
        {"permittivity+permittivity_per_stretch*prestretch", "eps_r", "1e-3", "1e9"},
        {"density", "rho", "0", "1e6"},
        {"electrode_mass", "areal", "0", "1e6"},
        {"retardation", "retard", "0", "1e9"},
        {"leakage_resistance", "r_leak", "0", "1e30"},
        {"m", "many", "1e-9", "1e9"},
    };
    int count = 1;
    line(p, "* parameters put into their ranges; ok is 1 where all were there already, else 0");
    line(p, ".param ok0={1}");
    for (size_t i = 0; i < sizeof ranges / sizeof *ranges; i++) {
        check(p, &ranges[i], &count);
    }
    if (p->follows) {
        check(p, &(range){"permittivity+1.25*permittivity_per_stretch*prestretch", "eps_pull", "1e-3", "1e9"}, &count);
    }
    check_laws(p, of->stress, &count);
    if (of->modulus) {
        check(p, &(range){"modulus", "y_given", "0", "1e15"}, &count);
        line(p, ".param y_free={1-min(y_given*1e30,1)}");
    }
    check_branches(p, &count);
    if (p->kind == DEA_LENS) {
        check_optics(p, &count);
    }
    return count;
}

/* What is written beside the network of one node; its own text is declared behind it. */
static void declare_node(part *p)
{
    dea_part_text *text = &p->cards.text;
    dea_part_text_root(text, "field");
    dea_part_text_use(text, p->field);
    dea_part_text_root(text, "mass");
    dea_part_text_use(text, p->mass);
    if (p->linear) {
        dea_part_text_root(text, "rest");
        dea_part_text_use(text, p->push_slope);
        dea_part_text_use(text, p->k_film);
    }
    for (int i = 0; i < p->film.network.tension_count; i++) {
        dea_part_text_root(text, "taut");
        dea_part_text_use(text, p->taut[i]);
        dea_part_text_use(text, p->loosen[i]);
    }
    dea_cards_declare(&p->cards);
}

static void declare(part *p)
{
    dea_part_text *text = &p->cards.text;
    const dea_network *network = &p->film.network;
    const struct {
        const char *root;
        dea_expr ref;
    } all[] = {{"capacity", p->c_rest}, {"stiffness", p->k_rest}, {"size", p->divide}, {"size", p->width}};
    if (p->rings) {
        dea_part_text_root(text, "membrane");
        dea_rings_part_declare(p->rings, text);
    } else {
        dea_part_text_call(text, network);
    }
    for (size_t i = 0; i < sizeof all / sizeof *all; i++) {
        dea_part_text_root(text, all[i].root);
        dea_part_text_use(text, all[i].ref);
    }
    dea_part_text_root(text, "range");
    for (int i = 0; i < network->range_count; i++) {
        if (is_made(p, network->range[i])) {
            dea_part_text_use(text, network->range[i]);
        }
    }
    if (!p->rings) {
        declare_node(p);
    }
}

/* Names for what a designer knows by name. */
static void give_names(part *p)
{
    dea_part_text *text = &p->cards.text;
    dea_part_text_name(text, p->divide, "r_a", "radius of the disc edge [m]");
    dea_part_text_name(text, p->width, "r_ring", "width of the annulus [m]");
    for (int i = 0; i < p->film.network.element_count; i++) {
        const dea_element *element = &p->film.network.elements[i];
        char name[DEA_PART_NAME], meaning[96];
        snprintf(name, sizeof name, "k%s", strchr(element->name, '_'));
        snprintf(meaning, sizeof meaning, "1/%s: %s", element->name, element->meaning);
        if (element->role == DEA_ROLE_SPRING) {
            dea_part_text_name(text, element->value, name, meaning);
        }
    }
    dea_part_text_name(text, p->k_rest, "k_rest", "stiffness of the relaxed film at rest [N/m]");
    dea_part_text_name(text, p->k_film, "k_film", "of that what damps and relaxes [N/m]");
    dea_part_text_name(text, p->c_rest, "c_rest", "capacitance of the film at rest [F]");
    dea_part_text_name(text, p->mass, "m_film", "mass that moves with the edge [kg]");
    dea_part_text_name(text, p->film.push, "push", "force on the edge per square of the voltage, (1/2) dC/du [N/V^2], Eq. 21");
}

/* Numbers of the network that are not its own. A film without mass and damper keeps 1 ns of damping: its edge would have no velocity
 * at an edge of the voltage otherwise. A branch without a share follows at once: its state would only be one more pole. */
static void write_numbers(const part *p)
{
    const dea_cures *cures = &dea_part_cures;
    const char *reach = p->linear ? "1e6" : "0.99e6"; /* of the way [um/m] */
    line(p, ".param per_um={1e-6/r_a}\n.param u_low={-%s*r_a}\n.param u_high={%s*r_ring}", reach, reach);
    line(p, "* what holds the edge where a parameter is out of its range [N/um]\n.param hold={1-ok}");
    line(p, ".param still={max(1-rho*1e30,0)*max(1-areal*1e30,0)*max(1-retard*1e30,0)}\n.param damp={retard+1e-9*still}");
    line(p, ".param f_mass={%.15g*many}", 1.0 / cures->inertia);
    for (size_t i = 1; i <= p->branches; i++) {
        line(p, ".param c_relax%zu={relax%zu*min(part%zu*1e30,1)+1e-30}", i, i, i);
    }
    line(p, ".param i_film={%.15g*many}\n.param leak={many*r_leak/(r_leak*r_leak+1e-30)}", cures->sense);
}

/* Those of a film of one node. */
static void write_node_numbers(const part *p)
{
    const dea_cures *cures = &dea_part_cures;
    char k[DEA_PART_NAME], film[DEA_PART_NAME];
    (void)dea_part_text_parameter(&p->cards.text, p->k_rest, k);
    (void)dea_part_text_parameter(&p->cards.text, p->k_film, film);
    line(p, ".param inertia={m_film+%.15g*%s}", cures->lightest, k);
    if (p->linear) {
        line(p, "* springs of film and branches [N/um], damper [N s/m]");
        line(p, ".param k_um={many*%s/%.15g}\n.param r_damp={many*damp*%s}", k, cures->per_metre, film);
        for (size_t i = 1; i <= p->branches; i++) {
            line(p, ".param k_um%zu={share%zu*many*%s/%.15g}", i, i, film, cures->per_metre);
        }
    } else {
        line(p, "* areas in um^2, stop behind the reach of the film [N/um]");
        line(p, ".param a_um={1e6*many}\n.param r_damp={damp*a_um}\n.param k_stop={%.15g*many*%s}", cures->stop, k);
    }
}

/* Node of what is positive while all of the film is taut, t0, t1, ... each the least so far. */
static void write_tautness(const part *p, char node[24])
{
    const dea_part_text *text = &p->cards.text;
    for (int i = 0; i < p->film.network.tension_count; i++) {
        char name[24], least[64] = "[]+[]*v(p,n)*v(p,n)";
        if (i > 0) {
            snprintf(least, sizeof least, "min(v(%s),[]+[]*v(p,n)*v(p,n))", node);
        }
        snprintf(name, sizeof name, "taut%d", i);
        snprintf(node, 24, "t%d", i);
        dea_part_text_source(text, DEA_VOLTAGE, name, node, "0", least, p->taut[i], p->loosen[i]);
    }
}

/* v(bad) and v(slack) rise from 0 to 1 within a millionth of what they watch. */
static void write_outputs(const part *p)
{
    const dea_part_text *text = &p->cards.text;
    char taut[24] = "tension", slack[64];
    line(p, "* to be read: strain [1], true field [V/um], of rings at r_a");
    line(p, "ESTRAIN strain 0 u 0 {per_um}");
    dea_part_text_source(text, DEA_VOLTAGE, "field", "field", "0", p->rings ? "[ok]*v(stretched)*v(p,n)" : "[ok]*1e-6*[]*v(p,n)", p->field);
    line(p, "* capacitance [pF] and charge [nC] of all films side by side");
    line(p, ".param c_scale={1e12*many}\n.param q_scale={1e9*many*c_rest}\nESTORED q 0 film plate {q_scale}");
    dea_part_text_source(text, DEA_VOLTAGE, "capacity", "c", "0", p->rings ? "[c_scale]*[c_rest]*(1+v(swell))" : "[c_scale]*[]",
           p->film.network.capacitance);
    line(p, "* bad = 1: a parameter out of its range, the edge past centre or frame, or of linear springs no stable equilibrium of the");
    line(p, "* relaxed film here (pull-in)");
    dea_part_text_source(text, DEA_VOLTAGE, "outside", "outside", "0", "max(v(u)-[u_high],[u_low]-v(u))");
    if (p->linear && p->joined) {
        dea_part_text_source(text, DEA_VOLTAGE, "net", "net", "0", "[]-[]*v(p,n)*v(p,n)", p->k_rest, p->push_slope);
    } else if (p->linear) {
        dea_part_text_source(text, DEA_VOLTAGE, "net", "net", "0", "([]-[]*v(p,n)*v(p,n))/[k_rest]", p->k_rest, p->push_slope);
        dea_part_text_source(text, DEA_VOLTAGE, "bad", "bad", "0", "min(max(max(1-[ok],-1e6*v(net)),max(1e3*v(outside),0)),1)");
    }
    if (!p->linear || p->joined) {
        dea_part_text_source(text, DEA_VOLTAGE, "bad", "bad", "0", "min(max(1-[ok],max(1e3*v(outside),0)),1)");
    }
    line(p, "* slack = 1: a region lost its tension, the film wrinkles");
    if (!p->rings) {
        write_tautness(p, taut);
    }
    snprintf(slack, sizeof slack, "1-min(max(1e6*v(%s),0),1)", taut);
    dea_part_text_source(text, DEA_VOLTAGE, "slack", "slack", "0", slack);
}

/* Cap of constant volume: eta = h/h_0 from h (3 a^2 + h^2) = const, f = (a^2 + h^2)/(2 h (n - 1)). */
static void write_optics(const part *p)
{
    const dea_part_text *text = &p->cards.text;
    line(p, "* eta = height of the liquid's cap over its height at rest; focal = focal length [mm], 0 without optics");
    dea_part_text_source(text, DEA_VOLTAGE, "eta", "eta", "0", "(3+[flat])/(3*(1+v(strain))*(1+v(strain))+[flat]*v(eta)*v(eta))");
    line(p, ".param f_height={lens_on*1e3*height/(2*flat*(refract-1))}");
    dea_part_text_source(text, DEA_VOLTAGE, "focal", "focal", "0",
           "[f_height]*((1+v(strain))*(1+v(strain))+[flat]*v(eta)*v(eta))/max(v(eta),1e-3)");
}

/* The membrane and its film; v(swell) = C/c_rest - 1. */
static void write_rings(part *p)
{
    const dea_part_text *text = &p->cards.text;
    dea_rings_part_write(p->rings, &p->cards.text);
    line(p, "* film: v(film) = charge/c_rest on a capacitor of c_rest; v(plate) is its current [mA]");
    dea_part_text_source(text, DEA_VOLTAGE, "charge", "film", "0", "v(plate)+[ok]*v(p,n)*(1+v(swell))");
    dea_cards_write_capacitor(&dea_part_cures, p->out);
    dea_part_text_source(text, DEA_VOLTAGE, "force", "force", "0", "[ok]*v(pull)*v(p,n)*v(p,n)");
}

static void write_body(part *p, const dea_model_part *of)
{
    declare(p);
    give_names(p);
    const int checks = write_checks(p, of);
    dea_part_text_parameters(&p->cards.text);
    check_ranges(p, checks);
    write_numbers(p);
    if (p->rings) {
        write_rings(p);
    } else {
        write_node_numbers(p);
        dea_cards_write_network(&p->cards);
    }
    write_outputs(p);
    if (p->kind == DEA_LENS) {
        write_optics(p);
    }
}

/* Branches that a part has at least. */
enum { PART_BRANCHES = 3 };

static double or_zero(double value)
{
    return isnan(value) ? 0.0 : value;
}

static void add(dea_part_parameter *list, size_t *count, const char *name, const char *unit, const char *meaning, double value)
{
    dea_part_parameter *entry = &list[(*count)++];
    *entry = (dea_part_parameter){.unit = unit, .value = value};
    snprintf(entry->name, sizeof entry->name, "%s", name);
    snprintf(entry->meaning, sizeof entry->meaning, "%s", meaning);
}

static size_t constants_in_use(const dea_law *law, size_t entries)
{
    return law ? law->constant_count * (law->entries > 1 ? entries : 1) : 0;
}

static void add_constants(const dea_law *law, const double *constants, size_t used, const char *whose, dea_part_parameter *list, size_t *count)
{
    for (size_t i = 0; i < used; i++) {
        const dea_constant *constant = &law->constants[i % law->constant_count];
        char own[DEA_QUANTITY_NAME], name[DEA_PART_NAME];
        dea_constant_name(law, i, own);
        snprintf(name, sizeof name, "%s%s", whose, own);
        add(list, count, name, constant->unit, "", constants[i]);
        dea_part_parameter *entry = &list[*count - 1];
        snprintf(entry->meaning, sizeof entry->meaning, "%s constant %s%s", law->title, constant->name,
                 constant->modulus && !*whose ? ", long-term" : "");
    }
}

static void add_skin(const dea_electrode *electrode, dea_part_parameter *list, size_t *count)
{
    if (electrode->law) {
        add(list, count, SKIN "thickness", "m", "of all electrodes together, as laid on the pre-stretched film", electrode->thickness);
        add_constants(electrode->law, electrode->constants, constants_in_use(electrode->law, electrode->entry_count), SKIN, list, count);
    }
}

static void add_film(const dea_scene *scene, dea_part_parameter *list, size_t *count)
{
    const dea_material *material = &scene->material;
    double constants[DEA_LAW_CONSTANTS];
    dea_material_long_term(material, constants);
    add_constants(material->law, constants, constants_in_use(material->law, material->entry_count), "", list, count);
    add(list, count, "permittivity", "1", "relative permittivity at stretch 0", material->permittivity);
    add(list, count, "permittivity_per_stretch", "1",
        material->permittivity_follows ? "its slope over the stretch, which it follows" : "its slope over the stretch",
        material->permittivity_per_stretch);
    add(list, count, "density", "kg/m^3", "density of the film, 0: no inertia", or_zero(material->density));
    add(list, count, "electrode_mass", "kg/m^2", "mass per area of the electrodes", or_zero(dea_electrode_mass(scene)));
    add(list, count, "retardation", "s", "Kelvin-Voigt retardation time, 0: none", or_zero(material->retardation));
    for (size_t i = 0; i < material->prony_count || i < PART_BRANCHES; i++) {
        const dea_prony branch = i < material->prony_count ? dea_material_branch(material, i) : (dea_prony){0.0, 1.0};
        char name[32];
        snprintf(name, sizeof name, "g%zu", i + 1);
        add(list, count, name, "1", "share of the branch in the instantaneous modulus, 0: none", branch.g);
        snprintf(name, sizeof name, "tau%zu", i + 1);
        add(list, count, name, "s", "relaxation time of the branch", branch.tau);
    }
}

/* Those of one film. */
static size_t film_parameters(const dea_scene *scene, const dea_model *model, dea_part_parameter *list)
{
    const dea_actuator *actuator = &scene->actuator;
    const double coverage = isnan(actuator->coverage) ? actuator->divide_radius / actuator->frame_radius : actuator->coverage;
    const bool dot = actuator->kind == DEA_DOT;
    size_t count = 0;
    add(list, &count, "frame_radius", "m", "inner radius of the rigid frame, r", actuator->frame_radius);
    add(list, &count, "coverage", "1", dot ? "electrode radius over frame radius, B" : "lens radius over frame radius, B",
        coverage);
    add(list, &count, "film_thickness", "m", "thickness before pre-stretch, H", actuator->film_thickness);
    add(list, &count, "layers", "1", "films of that thickness, electrically parallel", actuator->layers);
    add(list, &count, "prestretch", "1", "equi-biaxial pre-stretch", actuator->prestretch);
    add_film(scene, list, &count);
    add_skin(&scene->electrode, list, &count);
    if (model->part->modulus) {
        const double share = dea_material_long_term_share(&scene->material);
        add(list, &count, "modulus", "Pa", "operating modulus Y, 0: from the constants of the law",
            share * or_zero(scene->material.modulus));
    }
    add(list, &count, "leakage_resistance", "ohm", "of the film, 0: none", or_zero(scene->drive.leakage_resistance));
    add(list, &count, "m", "1", "how many of it act side by side on the same pins", 1.0);
    if (!dot) {
        const double refractive = actuator->refractive_index;
        add(list, &count, "focal_length", "m", "of the lens at rest, 0: no optics", or_zero(actuator->focal_length));
        add(list, &count, "refractive_index", "1", "of the lens liquid", isnan(refractive) ? 1.4 : refractive);
    }
    return count;
}

/* True of what both films of a part have in common. */
static bool is_shared(const dea_part_parameter *parameter)
{
    static const char *const shared[] = {"frame_radius", "coverage", "m"};
    bool found = false;
    for (size_t i = 0; i < sizeof shared / sizeof *shared; i++) {
        found = found || strcmp(parameter->name, shared[i]) == 0;
    }
    return found;
}

/* What stands before the names of the second film's parameters. */
#define SECOND "second_"

size_t dea_part_parameters(const dea_scene *scene, const dea_model *model, dea_part_parameter list[DEA_PART_PARAMETERS])
{
    size_t count = film_parameters(scene, model, list);
    if (scene->antagonist.there) {
        dea_part_parameter own[DEA_FILM_PARAMETERS];
        dea_scene second;
        dea_second_scene(scene, &second);
        const size_t all = film_parameters(&second, model, own);
        for (size_t i = 0; i < all; i++) {
            if (!is_shared(&own[i])) {
                list[count] = own[i];
                snprintf(list[count++].name, sizeof own[i].name, SECOND "%.*s", (int)(sizeof own[i].name - sizeof SECOND), own[i].name);
            }
        }
    }
    return count;
}

/* What can be read of one of two films, its pins beside p, n and edge; names end in @p read, of flags in @p watched. */
static void write_pins(FILE *out, dea_kind kind, bool linear, const char *read, const char *watched)
{
    static const char *const names[] = {"u", "strain", "force", "field", "c", "q"};
    for (size_t i = 0; i < sizeof names / sizeof *names; i++) {
        fprintf(out, " %s%s", names[i], read);
    }
    if (kind == DEA_LENS) {
        fprintf(out, " focal%s", read);
    }
    fprintf(out, " bad%s slack%s", watched, watched);
    if (linear) {
        fprintf(out, " net%s", watched);
    }
}

/* The parameters of `.subckt` and their defaults, in lines that every simulator takes. */
static void write_parameters(FILE *out, const dea_part_parameter *list, size_t count)
{
    fputs("\n+ params:", out);
    for (size_t i = 0; i < count; i++) {
        fprintf(out, "%s %s=", i > 0 && i % 4 == 0 ? "\n+" : "", list[i].name);
        dea_part_number(out, list[i].value);
    }
    fputc('\n', out);
}

static dea_status write_part(part *p, const dea_scene *defaults, const dea_model *model, const char *name, dea_error *error)
{
    dea_part_parameter list[DEA_FILM_PARAMETERS];
    const dea_status status = derive(p, model, error);
    if (status != DEA_OK) {
        return status;
    }
    const dea_cards_form cured = {.dialect = p->dialect, .analogy = dea_analogy_at(0), .cures = &dea_part_cures};
    if (!dea_cards_open(&p->film, &cured, p->out, &p->cards)) {
        return tell_memory(error);
    }
    p->cards.text.symbols = symbol_names;
    line(p, "* %s: %s", name, model->part->meaning);
    fprintf(p->out, ".subckt %s p n edge", name);
    if (p->joined) {
        write_pins(p->out, p->kind, p->linear, "", "");
    }
    write_parameters(p->out, list, film_parameters(defaults, model, list));
    write_body(p, model->part);
    line(p, ".ends %s", name);
    return p->cards.text.exhausted ? tell_memory(error) : DEA_OK;
}

static dea_status refuse_what_is_no_part(const dea_scene *scene, const dea_model *model, dea_error *error)
{
    if (model->membrane && scene->electrode.sheet_resistance > 0.0) {
        return dea_fail(error, DEA_ERROR_UNSUPPORTED, "the potential along a sheet resistance of the model %s is no part: --model ring is one, with "
                                                      "one resistance before it", model->name);
    }
    return DEA_OK;
}

static dea_status write_film(const dea_scene *defaults, const dea_model *model, const char *name, bool joined, const dea_dialect *dialect,
                             FILE *out, dea_error *error)
{
    const size_t branches = defaults->material.prony_count;
    dea_memory_text text;
    dea_status status = dea_memory_text_begin(&text, error);
    part p = {.dialect = dialect,
              .out = text.out,
              .kind = defaults->actuator.kind,
              .law = defaults->material.law,
              .skin = defaults->electrode.law,
              .constants = constants_in_use(defaults->material.law, defaults->material.entry_count),
              .skin_constants = constants_in_use(defaults->electrode.law, defaults->electrode.entry_count),
              .follows = defaults->material.permittivity_follows,
              .linear = model->linear != NULL,
              .joined = joined,
              .branches = branches > PART_BRANCHES ? branches : PART_BRANCHES};
    p.elements = (dea_dynamics){.model = model,
                                .linear = p.linear,
                                .softens = true,
                                .branch_count = p.branches,
                                .mass = 1.0,
                                .retardation = 1.0,
                                .limit = (double)INFINITY};
    p.film = (dea_mobility){.dynamics = &p.elements, .stiffness = p.linear ? 1.0 : (double)NAN};
    status = status ? status : write_part(&p, defaults, model, name, error);
    status = dea_memory_text_end(&text, status, error);
    if (status == DEA_OK) {
        dea_dialect_wrap(out, text.text);
    }
    free(text.text);
    dea_cards_close(&p.cards);
    dea_mobility_close(&p.film);
    free(p.rings);
    free(p.taut);
    free(p.loosen);
    return status;
}

/* Behind the nodes of an instance: the film that it is, its parameters those of the whole part under the names that they have there. */
static void write_instance(FILE *out, const dea_scene *scene, const dea_model *model, const char *name, const char *which, const char *whose)
{
    dea_part_parameter list[DEA_FILM_PARAMETERS];
    const size_t count = film_parameters(scene, model, list);
    fprintf(out, " %s_%s params:", name, which);
    for (size_t i = 0; i < count; i++) {
        fprintf(out, " %s={%s%s}", list[i].name, is_shared(&list[i]) ? "" : whose, list[i].name);
    }
    fputc('\n', out);
}

static void write_flag(const dea_dialect *dialect, FILE *out, const char *name, const char *expression)
{
    dea_dialect_source_begin(dialect, out, DEA_VOLTAGE, name, name, "0");
    fputs(expression, out);
    dea_dialect_source_end(dialect, out);
}

/* Two films on one edge. Of linear ones the springs of both have to hold what both soften. */
static void write_pair(const dea_scene *scene, const dea_scene *second, const dea_model *model, const char *name, const dea_dialect *dialect, FILE *out)
{
    const bool linear = model->linear != NULL;
    dea_part_parameter list[DEA_PART_PARAMETERS];
    fprintf(out, "* %s: two films on one edge, p2 and n2 are those of the second; to be read of it: force2, field2, c2, q2\n", name);
    fprintf(out, ".subckt %s p n edge p2 n2", name);
    write_parameters(out, list, dea_part_parameters(scene, model, list));
    fputs("XFIRST p n edge", out);
    write_pins(out, scene->actuator.kind, linear, "", "1");
    write_instance(out, scene, model, name, "first", "");
    fputs("XSECOND p2 n2 edge", out);
    write_pins(out, second->actuator.kind, linear, "2", "2");
    write_instance(out, second, model, name, "second", SECOND);
    write_flag(dialect, out, "bad", linear ? "min(max(max(v(bad1),v(bad2)),-1e6*(v(net1)+v(net2))),1)" : "max(v(bad1),v(bad2))");
    write_flag(dialect, out, "slack", "max(v(slack1),v(slack2))");
    fprintf(out, ".ends %s\n", name);
}

/* Each film is a subcircuit, and the part joins them. */
static dea_status write_films(const dea_scene *scene, const dea_model *model, const char *name, const dea_dialect *dialect, FILE *out, dea_error *error)
{
    char own[DEA_PART_TITLE + 8];
    dea_scene second;
    dea_memory_text text;
    dea_second_scene(scene, &second);
    snprintf(own, sizeof own, "%s_first", name);
    dea_status status = write_film(scene, model, own, true, dialect, out, error);
    snprintf(own, sizeof own, "%s_second", name);
    status = status ? status : write_film(&second, model, own, true, dialect, out, error);
    status = status ? status : dea_memory_text_begin(&text, error);
    if (status == DEA_OK) {
        write_pair(scene, &second, model, name, dialect, text.out);
        status = dea_memory_text_end(&text, DEA_OK, error);
        if (status == DEA_OK) {
            dea_dialect_wrap(out, text.text);
        }
        free(text.text);
    }
    return status;
}

dea_status dea_part_write(const dea_scene *defaults, const dea_model *model, const char *name, const dea_dialect *dialect,
                          FILE *out, dea_error *error)
{
    char own[DEA_PART_TITLE];
    if (!model->part) {
        return dea_fail(error, DEA_ERROR_UNSUPPORTED, "the model %s is no circuit part: lumped, lame, coverage, ring and field are",
                        model->name);
    }
    const dea_status outside = refuse_what_is_no_part(defaults, model, error);
    if (outside) {
        return outside;
    }
    name = name ? name : dea_part_name_of(defaults->actuator.kind, model, own);
    return defaults->antagonist.there ? write_films(defaults, model, name, dialect, out, error)
                                      : write_film(defaults, model, name, false, dialect, out, error);
}

void dea_part_write_mechanics(const char *prefix, FILE *out)
{
    fprintf(out,
            "* %s_spring: a spring between a and b that has an operating point beside the parts; v(x.u) = its stretch [um]\n"
            ".subckt %s_spring a b\n"
            "+ params: stiffness=100 m=1\n"
            ".param k_um={1e-6*stiffness*m}\n",
            prefix, prefix);
    dea_cards_write_integral(&dea_part_cures, "", "u", "a", "b", out);
    fprintf(out, "GSPRING a b u 0 {k_um}\n.ends %s_spring\n", prefix);
    fprintf(
        out,
        "* %s_lever: v(b) = ratio v(a), force on a = ratio times force on b; ratio = -1 turns the sense of an edge; m levers\n"
        "* side by side are one\n"
        ".subckt %s_lever a b\n"
        "+ params: ratio=-1 m=1\n"
        "ELEVER turned 0 a 0 {ratio}\n"
        "VSENSE turned b 0\n"
        "FLEVER a 0 VSENSE {ratio}\n"
        ".ends %s_lever\n",
        prefix, prefix, prefix);
}

static void write_preamble(const dea_dialect *dialect, const char *title, const char *prefix, FILE *out)
{
    dea_dialect_comment(out, title);
    fprintf(out, "* dielectric elastomer actuators for %s\n", dialect->title);
    fprintf(
        out,
        "* p, n: film. edge: v(edge) = velocity of the disc edge, outward [m/s], current = force [N]; the frame is node 0.\n"
        "* mass m [kg]: capacitor of m to 0. damper r [N s/m]: resistor of 1/r. spring: %s_spring. all parameters in SI units.\n"
        "* to be read inside an instance x1, as v(x1%su): u [um], strain [1], force [N], field [V/um], c [pF], q [nC], bad,\n* slack [0 or 1]\n",
        prefix, dialect->inside);
}

#define LETTERS "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ"
static const char marks[] = LETTERS "0123456789_";

bool dea_part_name_valid(const char *name)
{
    return *name && strchr(LETTERS, *name) && strspn(name, marks) == strlen(name) && strlen(name) <= DEA_PART_NAME_LENGTH;
}

bool dea_part_name_after(const char *path, char name[DEA_PART_NAME_LENGTH + 1])
{
    const char *slash = strrchr(path, '/');
    const char *file = slash ? slash + 1 : path;
    const size_t length = strcspn(file, ".");
    if (length == 0 || strcmp(file, "-") == 0) {
        return false;
    }
    const char *prefix = strchr(LETTERS, *file) ? "" : DEA_PART_PREFIX "_";
    snprintf(name, DEA_PART_NAME_LENGTH + 1, "%s%.*s", prefix, (int)fmin((double)length, DEA_PART_NAME_LENGTH), file);
    for (char *c = name; *c; c++) {
        *c = strchr(marks, *c) ? *c : '_';
    }
    return true;
}

dea_status dea_part_of_scene(const dea_scene *scene, const dea_model *model, const char *name, const dea_dialect *dialect,
                             FILE *out, dea_error *error)
{
    char own[DEA_PART_TITLE];
    const char *prefix = name ? name : DEA_PART_PREFIX;
    if (dea_part_name_of(scene->actuator.kind, model, own)) { /* else nothing is written */
        write_preamble(dialect, scene->title, prefix, out);
    }
    const dea_status status = dea_part_write(scene, model, name, dialect, out, error);
    if (status == DEA_OK) {
        dea_part_write_mechanics(prefix, out);
    }
    return status;
}

void dea_part_note(const dea_scene *scene, char *note, size_t size)
{
    const double series = dea_series_resistance(scene);
    char resistor[64] = "";
    dea_scene alone = *scene;
    alone.antagonist.there = false;
    const bool loaded = dea_scene_is_loaded(&alone);
    if (series > 0.0) {
        snprintf(resistor, sizeof resistor, "a resistor of %g Ohm before its pin p", series);
    }
    *note = '\0';
    if (loaded || *resistor) {
        snprintf(note, size, "the part is the film and its leak, the circuit has the rest of the scene: %s%s%s", resistor,
                 loaded && *resistor ? ", and " : "", loaded ? "the load at its pin edge" : "");
    }
}

dea_scene dea_part_paper(dea_kind kind)
{
    static char title[] = "";
    const double none = (double)NAN;
    dea_scene scene = {
        .title = title,
        .actuator = {.kind = kind,
                     .frame_radius = 0.03,
                     .coverage = 0.5,
                     .divide_radius = none,
                     .film_thickness = 1e-4,
                     .layers = 1.0,
                     .prestretch = 1.2,
                     .electrode_mass = none,
                     .focal_length = none,
                     .refractive_index = none},
        .material = *dea_material_find("elastosil-2030"),
        .drive = {.voltage = none, .series_resistance = none, .leakage_resistance = none, .current_limit = none},
    };
    scene.material.density = none;
    return scene;
}

dea_status dea_part_library(const dea_dialect *dialect, FILE *out, dea_error *error)
{
    write_preamble(dialect, "library of deaspice parts; the defaults are the film of 100 um in a frame of 30 mm, Elastosil 2030",
                   DEA_PART_PREFIX, out);
    for (size_t i = 0; i < dea_model_count(); i++) {
        for (int kind = DEA_DOT; dea_model_at(i)->part && kind <= DEA_LENS; kind++) {
            const dea_scene scene = dea_part_paper((dea_kind)kind);
            const dea_status status = dea_part_write(&scene, dea_model_at(i), NULL, dialect, out, error);
            if (status != DEA_OK) {
                return status;
            }
        }
    }
    dea_part_write_mechanics(DEA_PART_PREFIX, out);
    return DEA_OK;
}
