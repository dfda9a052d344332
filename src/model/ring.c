/* Disc and annulus as one ring of film each, under their mean stretches, both linear in the displacement of the edge u = s r_a
 * (physics: section 7). With e the relative change of a stretch, A = r_a/lambda_pre and F = r/lambda_pre:
 *
 *     disc  e = s,    annulus  e1 = -s B/(1 - B),  e2 = s B/(1 + B),    lambda = lambda_pre (1 + e)
 *     2 pi A H s_disc + pi H [ (F - A) s_hoop - (F + A) s_radial ]_annulus = 0
 *
 * with the nominal stresses s_a = P_a - eps (U/H)^2 (lambda_1 lambda_2)^2/lambda_a where electroded: the gradient of one energy. A
 * permittivity that follows the strain scales them (dea_film_electric()).
 */
#include "expression/formula.h"
#include "model/models.h"
#include "model/path.h"
#include "network/hyperelastic.h"

/* One place of an iteration: the excess held - m weight, and its slope. */
typedef struct guess {
    double x, excess, slope;
} guess;

/* What does not change along the path of one point. */
typedef struct rings {
    const dea_point *point;
    const dea_film *film;
    bool dot;
    double radial, hoop; /* e1/s and e2/s of the annulus */
    double outer, inner; /* (F + A)/2A, (F - A)/2A */
    double aspect;       /* (F + A)/(F - A) */
    double load;         /* of a spring k at the edge, k lambda_pre/(2 pi H) [Pa] */
} rings;

/* Area stretch of the electroded film over lambda_pre^2. */
static inline double area_at(const rings *r, double s)
{
    return r->dot ? (1.0 + s) * (1.0 + s) : (1.0 + r->radial * s) * (1.0 + r->hoop * s);
}

/* One place of the path: both sides of the balance over 2 pi A H, against x = |s|. */
typedef struct ring_place {
    dea_path_place path;
    double x;
    dea_biaxial disc, annulus;
} ring_place;

/* The weight of the load is the edge's radius over r_a times the area stretch of the electroded film, and its electrostriction. */
static inline ring_place place_at(const rings *r, double x)
{
    const double s = r->dot ? x : -x;
    const double e1 = r->radial * s, e2 = r->hoop * s, edge = 1.0 + s;
    ring_place place = {.x = x, .disc = dea_film_biaxial(r->film, s, s), .annulus = dea_film_biaxial(r->film, e1, e2)};
    if (r->point->skin_share > 0.0) {
        dea_point_coat(r->point, r->dot ? s : e1, r->dot ? s : e2, r->dot ? &place.disc : &place.annulus);
    }
    const dea_biaxial *disc = &place.disc, *annulus = &place.annulus;
    const double held = disc->p1 + r->inner * annulus->p2 - r->outer * annulus->p1;
    place.path.held = (r->dot ? held : -held) + r->load * x;
    place.path.slope = r->film->prestretch *
                       (disc->w11 + disc->w12 + 0.5 * (annulus->w11 * r->aspect + annulus->w22 / r->aspect) - annulus->w12) + r->load;
    const double area = area_at(r, s);
    const double area_slope = r->dot ? 2.0 * edge : -(r->radial * (1.0 + e2) + r->hoop * (1.0 + e1)); /* over x */
    place.path.weight = edge * area;
    place.path.weight_slope = r->dot ? 3.0 * area : edge * area_slope - area;
    if (r->film->electrostriction != 0.0) {
        const dea_electric electric = dea_film_electric(r->film, r->film->square * area);
        place.path.weight_slope = electric.first * place.path.weight_slope + edge * (electric.second - electric.first) * area_slope;
        place.path.weight *= electric.first;
    }
    return place;
}

static dea_path_place path_place(const void *user, double x)
{
    return place_at(user, x).path;
}

/* Zero of the cubic that has the values and slopes of x over the excess at two places. */
static double between(const guess *a, const guess *b)
{
    const double over = 1.0 / (b->excess - a->excess);
    const double chord = (b->x - a->x) * over, slope = 1.0 / b->slope;
    const double second = (slope - chord) * over, first = (chord - 1.0 / a->slope) * over;
    return b->x - b->excess * (slope - b->excess * (second - a->excess * (second - first) * over));
}

/* Share of the load that may be left at the last place before a root. */
static const double little = 0.1;

/* False where the iteration from rest does not settle; @p at is the last place but the root, which lies next to it. The error of
 * the cubic goes with the square of both last steps: where that is below rounding no further one is needed. */
static bool settle(const rings *r, const dea_path *path, double m, double *x, ring_place *at)
{
    guess a = {0.0, -m, path->rest - m * (r->dot ? 3.0 : -1.0 - r->radial - r->hoop)};
    double next = m / a.slope, last = next;
    for (int i = 0; i < 12 && next >= 0.0 && next < path->end; i++) {
        *at = place_at(r, next);
        const guess b = {next, at->path.held - m * at->path.weight, at->path.slope - m * at->path.weight_slope};
        if (!(b.slope > 0.0)) {
            return false;
        }
        *x = next = b.excess != a.excess ? between(&a, &b) : b.x - b.excess / b.slope;
        const double step = next - b.x;
        const double left = step * last / path->share;
        /* next to the end steps are short, too, or none at all where a cubic goes through values of sizes too far apart */
        const bool is_root = fabs(b.excess) <= fmin(2.0 * fabs(b.slope * step), little * m * at->path.weight);
        if (is_root && fabs(step) <= 1e-3 * next && left * left <= 1e-17 * next * path->share) {
            return next < path->end;
        }
        a = b;
        last = step;
    }
    return false;
}

/* Equilibrium x = |s| under the load m = eps (U/H)^2 lambda_pre^3 and the place there; false where none is connected to rest. */
static bool balance(const rings *r, double m, double *x, ring_place *at)
{
    const dea_film *film = r->film;
    const double both = r->aspect + 1.0 / r->aspect, lame = film->w11 + 0.5 * film->w11 * both;
    const dea_film *skin = &r->point->skin;
    const double coat = r->dot ? skin->w11 + skin->w12 : 0.5 * skin->w11 * both - skin->w12;
    const double held = r->point->skin_share > 0.0 ? lame + r->point->skin_share * coat : lame;
    const dea_path path = {path_place, r, film->prestretch * held + r->load, r->dot ? 2.0 * r->inner : 1.0, r->inner / (r->inner + 0.5), 0.0};
    if (!isfinite(m) || !(path.rest > 0.0)) {
        return false;
    }
    const bool constant = film->electrostriction == 0.0; /* the iteration knows how the weight of such a film begins */
    if (constant && settle(r, &path, m, x, at) && (dea_path_cannot_fold(&path, m, *x, &at->path) || dea_path_grows(&path, *x))) {
        return true;
    }
    const bool found = dea_path_trace(&path, m, x);
    *at = place_at(r, *x);
    return found;
}

/* Smallest in-plane nominal stress of disc and annulus, each with its electrical part eps (U/H)^2 (l1 l2)^2/l_a, is positive. The
 * stresses are those of a place so near that its tangents lead to x. */
static bool is_taut(const rings *r, double k, double x, double area, const ring_place *at)
{
    const double s = r->dot ? x : -x, l0 = r->film->prestretch;
    const double change = l0 * (r->dot ? x - at->x : at->x - x), pull = k * dea_film_electric(r->film, l0 * l0 * area).first * l0 * l0 * l0 * area * area;
    const dea_biaxial *disc = &at->disc, *annulus = &at->annulus;
    double p = disc->p1 + (disc->w11 + disc->w12) * change;
    double radial = annulus->p1 + (annulus->w11 * r->radial + annulus->w12 * r->hoop) * change;
    double hoop = annulus->p2 + (annulus->w12 * r->radial + annulus->w22 * r->hoop) * change;
    if (r->dot) {
        p -= pull / (1.0 + s);
    } else {
        radial -= pull / (1.0 + r->radial * s);
        hoop -= pull / (1.0 + r->hoop * s);
    }
    return r->film->tension + fmin(p, fmin(radial, hoop)) > 0.0;
}

static rings rings_of(const dea_point *point)
{
    const double b = point->coverage;
    return (rings){.point = point,
                   .film = &point->film,
                   .dot = point->kind == DEA_DOT,
                   .radial = -b / (1.0 - b),
                   .hoop = b / (1.0 + b),
                   .outer = 0.5 * (1.0 + b) / b,
                   .inner = 0.5 * (1.0 - b) / b,
                   .aspect = (1.0 + b) / (1.0 - b),
                   .load = point->load * point->film.prestretch / (2.0 * DEA_PI * point->film_thickness)};
}

/* eps (U/H)^2 [Pa]. */
static double pressure_of(const dea_point *point)
{
    const double nominal = dea_point_nominal_field(point);
    return point->film.permittivity * nominal * nominal;
}

/* 2 pi H A [m^2], on which the sides of the balance act. */
static double lever_of(const dea_point *point)
{
    return 2.0 * DEA_PI * point->film_thickness * (dea_point_divide(point) / point->film.prestretch);
}

static dea_found found_at(const rings *r, double x, const ring_place *at)
{
    const dea_point *point = r->point;
    const dea_film *film = r->film;
    const double k = pressure_of(point), m = k * film->square * film->prestretch;
    const double sign = dea_point_sign(point), s = sign * x, area = area_at(r, s);
    const dea_electric electric = dea_film_electric(film, film->square * area);
    return (dea_found){.strain = s,
                       .force = sign * lever_of(point) * m * electric.first * (1.0 + s) * area,
                       .stretch = film->square * area,
                       .capacitance = dea_point_capacitance(point) * electric.own * area * area,
                       .taut = is_taut(r, k, x, area, at)};
}

static void solve(const dea_point *point, double accuracy, dea_row *row)
{
    (void)accuracy;
    const rings r = rings_of(point);
    const double m = pressure_of(point) * point->film.square * point->film.prestretch;
    double x = 0.0;
    ring_place at = {0};
    if (m != 0.0 && !balance(&r, m, &x, &at)) {
        dea_row_refuse(row, DEA_STATE_PULL_IN);
        return;
    }
    dea_row_fill(row, point, found_at(&r, x, &at));
}

static bool hold(const dea_point *point, double strain, dea_hold *hold)
{
    rings r = rings_of(point);
    r.load = 0.0;
    const double sign = dea_point_sign(point), lever = lever_of(point), radius = dea_point_divide(point);
    const ring_place at = place_at(&r, sign * strain);
    hold->found = found_at(&r, at.x, &at);
    hold->held = sign * lever * at.path.held;
    hold->held_slope = lever / radius * at.path.slope;
    hold->push = hold->found.force;
    hold->push_slope = sign * hold->push / radius * at.path.weight_slope / at.path.weight;
    return 1.0 + strain > 0.0 && 1.0 + r.radial * strain > 0.0 && isfinite(hold->held);
}

/* Relative changes of the stretches, and what area stretch the electroded film has over lambda_pre^2. */
typedef struct ring_strains {
    dea_expr disc, radial, hoop, area;
} ring_strains;

static ring_strains strains_of(const dea_symbols *symbols, dea_expr disc)
{
    dea_pool *pool = symbols->pool;
    const dea_expr one = NUM(1.0), width = MUL(symbols->frame_radius, ADD(one, symbols->coverage)); /* r + r_a */
    ring_strains e = {disc, dea_symbols_annulus_strain(symbols), DIV(dea_expr_node(pool, 0), width), 0};
    e.area = symbols->kind == DEA_DOT ? SQUARE(ADD(one, disc)) : MUL(ADD(one, e.radial), ADD(one, e.hoop));
    return e;
}

static dea_symbols_factors electric_of(const dea_symbols *symbols, const ring_strains *e)
{
    dea_pool *pool = symbols->pool;
    const bool dot = symbols->kind == DEA_DOT;
    return dea_symbols_electric(symbols, ADD(NUM(1.0), dot ? e->disc : e->radial), ADD(NUM(1.0), dot ? e->disc : e->hoop));
}

/* Levers of the three stresses: 2 pi A H/lambda and pi H (F +- A)/lambda_a [m^2]. */
typedef struct ring_levers {
    dea_expr disc, radial, hoop;
} ring_levers;

static ring_levers levers_of(const dea_symbols *symbols, const ring_strains *e)
{
    dea_pool *pool = symbols->pool;
    const dea_expr one = NUM(1.0);
    const dea_expr unit = SCALE(DEA_PI, DIV(MUL(symbols->frame_radius, symbols->film_thickness), SQUARE(symbols->prestretch)));
    return (ring_levers){dea_hyperelastic_area(symbols, e->disc),
                         DIV(MUL(unit, ADD(one, symbols->coverage)), ADD(one, e->radial)),
                         DIV(MUL(unit, SUB(one, symbols->coverage)), ADD(one, e->hoop))};
}

/* sigma_pre on levers that change: at rest their forces cancel, and B = B_0/(1 + e) leaves -B e of each. */
static dea_expr tension_of(const dea_symbols *symbols, const ring_strains *e, const ring_levers *lever)
{
    dea_pool *pool = symbols->pool;
    const dea_expr annulus = SUB(MUL(lever->radial, e->radial), MUL(lever->hoop, e->hoop));
    return MUL(dea_symbols_rest_stress(symbols), SUB(annulus, MUL(lever->disc, e->disc)));
}

/* The skin's stresses on the levers of the electroded region. */
static void add_skin(const dea_symbols *symbols, dea_network *network, const ring_strains *e, const ring_levers *lever)
{
    dea_pool *pool = symbols->pool;
    dea_expr force;
    if (symbols->kind == DEA_DOT) {
        force = MUL(lever->disc, dea_hyperelastic_skin(symbols, e->disc, e->disc));
    } else {
        const dea_expr radial = MUL(lever->radial, dea_hyperelastic_skin(symbols, e->radial, e->hoop));
        force = SUB(MUL(lever->hoop, dea_hyperelastic_skin(symbols, e->hoop, e->radial)), radial);
    }
    dea_network_add(network, DEA_ROLE_TENSION, "n_skin", "skin of the electrodes, on these levers [N]", force);
}

static void limit_tension(const dea_symbols *symbols, dea_network *network, const ring_strains *e)
{
    dea_pool *pool = symbols->pool;
    const dea_expr rest = dea_symbols_rest_stress(symbols);
    const dea_expr square = MUL(dea_symbols_pressure(symbols), SQUARE(MUL(SQUARE(symbols->prestretch), e->area)));
    const dea_expr pull = MUL(electric_of(symbols, e).first, square);
    const bool dot = symbols->kind == DEA_DOT;
    dea_expr disc = ADD(rest, dea_hyperelastic_change(symbols, e->disc));
    dea_expr radial = ADD(rest, dea_hyperelastic_principal(symbols, e->radial, e->hoop));
    dea_expr hoop = ADD(rest, dea_hyperelastic_principal(symbols, e->hoop, e->radial));
    if (symbols->skin && dot) {
        disc = ADD(disc, dea_hyperelastic_skin(symbols, e->disc, e->disc));
    } else if (symbols->skin) {
        radial = ADD(radial, dea_hyperelastic_skin(symbols, e->radial, e->hoop));
        hoop = ADD(hoop, dea_hyperelastic_skin(symbols, e->hoop, e->radial));
    }
    dea_network_taut(network, dot ? SUB(disc, pull) : disc);
    dea_network_taut(network, dot ? radial : SUB(radial, pull));
    dea_network_taut(network, dot ? hoop : SUB(hoop, pull));
}

/* The principal Cauchy stresses with their levers. */
static void build(const dea_symbols *symbols, dea_network *network)
{
    dea_pool *pool = symbols->pool;
    const dea_expr one = NUM(1.0);
    const ring_strains e = strains_of(symbols, network->strain);
    const ring_levers lever = levers_of(symbols, &e);
    dea_network_call(network, ADD(one, e.disc), "stretch_disc", "stretch of the disc over the pre-stretch [1]");
    dea_network_call(network, ADD(one, e.radial), "stretch_radial", "radial stretch of the annulus over the pre-stretch [1]");
    dea_network_call(network, ADD(one, e.hoop), "stretch_hoop", "hoop stretch of the annulus over the pre-stretch [1]");
    dea_network_add_stress(network, "n_disc", "disc, sigma - sigma_pre [Pa] on 2 pi A H/lambda",
                           dea_hyperelastic_change(symbols, e.disc), lever.disc);
    dea_network_add_stress(network, "n_radial", "annulus, radial sigma_pre - sigma [Pa] on pi H (F + A)/lambda",
                           NEG(dea_hyperelastic_principal(symbols, e.radial, e.hoop)), lever.radial);
    dea_network_add_stress(network, "n_hoop", "annulus, hoop sigma - sigma_pre [Pa] on pi H (F - A)/lambda",
                           dea_hyperelastic_principal(symbols, e.hoop, e.radial), lever.hoop);
    dea_network_add(network, DEA_ROLE_TENSION, "n_tension", "pre-stress sigma_pre on the change of these areas [N]",
                    tension_of(symbols, &e, &lever));
    if (symbols->skin) {
        add_skin(symbols, network, &e, &lever);
    }
    const dea_expr rest = MUL(dea_symbols_pressure(symbols), SQUARE(SQUARE(symbols->prestretch)));
    const dea_symbols_factors electric = electric_of(symbols, &e);
    const dea_expr growth = MUL(ADD(one, e.disc), e.area);
    const dea_expr force = MUL(MUL(dea_symbols_cross_section(symbols), MUL(electric.first, rest)), growth);
    dea_network_add(network, DEA_ROLE_SOURCE, "f_dea", "electrostatic force U^2/2 dC/du of the true area [N]",
                    SCALE(network->sign, force));
    network->capacitance = MUL(dea_symbols_capacitance(symbols), MUL(electric.own, SQUARE(e.area)));
    network->ends = true;
    network->field = MUL(MUL(dea_symbols_nominal_field(symbols), SQUARE(symbols->prestretch)), e.area);
    dea_network_insulate(symbols, network, e.area, one);
    limit_tension(symbols, network, &e);
}

/* One ring: lambda_1 = dr/dR, lambda_2 = sum r/sum R between its edges. */
static bool along(const dea_point *point, double strain, size_t count, const double *x, dea_stretches *stretches)
{
    const double pre = point->film.prestretch, b = point->coverage;
    (void)x;
    for (size_t i = 0; i < count; i++) {
        stretches[i] = (dea_stretches){pre * (1.0 - b * strain / (1.0 - b)), pre * (1.0 + b * strain / (1.0 + b))};
    }
    return true;
}

const dea_model dea_model_ring = {
    .name = "ring",
    .equation = "one ring of film each for disc and annulus",
    .leaves_out = "how stress and stretch vary across the annulus",
    .lens = true,
    .edge = true,
    .solve = solve,
    .along = along,
    .hold = hold,
    .network = build,
    .dynamic = true,
    .part = &(const dea_model_part){"_ring", "hyperelastic disc and annulus, one ring of membrane each, quasi-linear relaxation", false, 1e6, 1.0},
};
