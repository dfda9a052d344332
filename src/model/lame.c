/* Plane elasticity about the pre-stretched film: Lame's disc and annulus, with electrostatic softening, both with the
 * electrostriction of the pre-stretched film where its permittivity follows the strain. */
#include "model/film_balance.h"
#include "expression/formula.h"
#include "network/network.h"

/* Are both nominal stresses positive at one place of a region with moduli a, b, under the changes d1, d2 of the radial and hoop
 * stretch? */
static bool is_taut(double rest, double a, double b, double d1, double d2)
{
    return rest + (a * d1 + b * d2) > 0.0 && rest + (b * d1 + a * d2) > 0.0;
}

/* Share of its terms below which a difference is computed again in long double: their rounding would be seen. */
static const double nearly = 1e-2;

/* 1/(2 pi H n) of a load, and with the skin: a + b on a disc, a q - b on an annulus, with its moduli [Pa]. */
static double load_stiffness(const dea_point *point)
{
    return point->load / (2.0 * DEA_PI * point->film_thickness);
}

static double beside_stiffness(const dea_point *point)
{
    const double b2 = point->coverage * point->coverage, q = (1.0 + b2) / (1.0 - b2);
    const dea_film *skin = &point->skin;
    const double coat = point->skin_share > 0.0 ? point->skin_share * (point->kind == DEA_DOT ? skin->w11 + skin->w12 : skin->w11 * q - skin->w12) : 0.0;
    return coat + load_stiffness(point);
}

/* Softening over M lambda_pre^2: a + b of the disc of a dot, a q - b of the annulus of a lens; 3 or q - 2 where eps is constant. */
static double softening_share(const dea_point *point)
{
    const double b2 = point->coverage * point->coverage, q = (1.0 + b2) / (1.0 - b2);
    const dea_electric electric = dea_point_electric(point);
    const double both = electric.first + electric.second;
    return point->kind == DEA_DOT ? both + electric.second : q * electric.second - both;
}

/* 1/(2 pi H n) of disc, annulus and softening together [Pa], in long double from the constants of the film: just before pull-in
 * the terms cancel. W11 + W12 + W11 (1 + B^2)/(1 - B^2) - W12 = 2 W11/(1 - B^2). */
static long double fine_stiffness(const dea_point *point)
{
    const dea_film *film = &point->film;
    const dea_law *law = film->law;
    const long double l = film->prestretch, y = l * l;
    const long double w11 = law->fine_w11 ? law->fine_w11(film->constants, l) : film->w11;
    const long double b2 = (long double)point->coverage * point->coverage,
                      field = (long double)point->voltage / point->film_thickness;
    const dea_electric electric = dea_point_electric(point);
    const long double both = (long double)electric.first + electric.second, q = (1.0L + b2) / (1.0L - b2);
    const long double share = point->kind == DEA_DOT ? both + electric.second : q * electric.second - both;
    return 2.0L * w11 / (1.0L - b2) + beside_stiffness(point) - share * film->permittivity * field * field * y;
}

/* Area of a lens' annulus over that at rest where the edge of the disc comes to the frame's radius on the other side of the centre,
 * as a linear film lets it: 1 - (B (1 + s))^2 cancels there. */
static double fine_area(const dea_point *point)
{
    const long double b = point->coverage, field = (long double)point->voltage / point->film_thickness;
    const long double first = dea_point_electric(point).first;
    const long double soft = point->film.permittivity * first * field * field * point->film.prestretch * point->film.prestretch;
    const long double edge = b * (1.0L - soft / fine_stiffness(point));
    return (double)((1.0L - edge) * (1.0L + edge) / (1.0L - b * b));
}

/* M lambda_pre^2 with M = eps (U/H)^2 [Pa]. */
static double softening_of(const dea_point *point)
{
    const double nominal = dea_point_nominal_field(point);
    return point->film.permittivity * nominal * nominal * point->film.square;
}

/* Tangent moduli of the two regions, those of the electroded one softened and with the skin [Pa]. */
typedef struct moduli {
    double disc1, disc2, annulus1, annulus2;
} moduli;

static moduli moduli_of(const dea_point *point)
{
    const dea_film *film = &point->film;
    const double soft = softening_of(point);
    const bool coated = point->skin_share > 0.0;
    const dea_electric electric = dea_point_electric(point);
    const double softened1 = film->w11 - electric.second * soft + (coated ? point->skin_share * point->skin.w11 : 0.0);
    const double softened2 = film->w12 - (electric.first + electric.second) * soft + (coated ? point->skin_share * point->skin.w12 : 0.0);
    return point->kind == DEA_DOT ? (moduli){softened1, softened2, film->w11, film->w12}
                                  : (moduli){film->w11, film->w12, softened1, softened2};
}

/* The film at a strain; @p alone: in balance with its own force. */
static dea_found found_at(const dea_point *point, double strain, bool alone)
{
    const dea_film *film = &point->film;
    const bool dot = point->kind == DEA_DOT;
    const double b2 = point->coverage * point->coverage, inverse = 1.0 / (1.0 - b2), q = (1.0 + b2) * inverse;
    const moduli w = moduli_of(point);
    const dea_electric electric = dea_point_electric(point);
    const double soft = softening_of(point), load = dea_point_sign(point) * electric.first * soft; /* F_DEA/(2 pi H r_a) */
    const double change = strain * film->prestretch; /* of the hoop stretch at r_a */
    const double edge = point->coverage * (1.0 + strain);
    const double maxwell = electric.first * soft * film->prestretch;
    const double disc_rest = film->tension - (dot ? maxwell : 0.0);
    const double annulus_rest = film->tension - (dot ? 0.0 : maxwell);
    /* annulus: d1 = -c (F^2/R^2 + 1), d2 = c (F^2/R^2 - 1) with d2 = change at r_a; linear in F^2/R^2, so its ends decide */
    const double rim = -2.0 * change * b2 * inverse;
    const bool taut = is_taut(disc_rest, w.disc1, w.disc2, change, change) &&
                      is_taut(annulus_rest, w.annulus1, w.annulus2, -q * change, change) &&
                      is_taut(annulus_rest, w.annulus1, w.annulus2, rim, 0.0);
    const bool cancels = alone && !dot && fabs(1.0 - edge * edge) < nearly;
    const double area = dot ? (1.0 + strain) * (1.0 + strain) : cancels ? fine_area(point) : (1.0 - edge * edge) * inverse;
    const double force = 2.0 * DEA_PI * point->film_thickness * load * dea_point_divide(point);
    /* C_0 + C_1 u + C_2 u^2/2 with C_1 = 2 F_DEA/U^2, C_2 = -2/(n_el U^2) */
    const double rest = dot ? b2 : 1.0 - b2;
    const double bend = 2.0 * b2 * strain * (2.0 * dea_point_sign(point) * electric.first + softening_share(point) * strain);
    const double capacitance = dea_point_full_capacitance(point) * (rest + bend);
    return (dea_found){.strain = strain,
                       .force = force,
                       .stretch = film->square * area,
                       .capacitance = capacitance,
                       .taut = taut};
}

static void solve(const dea_point *point, double accuracy, dea_row *row)
{
    (void)accuracy;
    const double b2 = point->coverage * point->coverage, inverse = 1.0 / (1.0 - b2), q = (1.0 + b2) * inverse;
    const moduli w = moduli_of(point);
    const double soft = softening_of(point);

    /* 1/n over 2 pi H: disc a + b, annulus a (1 + B^2)/(1 - B^2) - b */
    double stiffness = w.disc1 + w.disc2 + w.annulus1 * q - w.annulus2 + load_stiffness(point);
    if (fabs(stiffness) < nearly * point->film.w11 * inverse) {
        stiffness = (double)fine_stiffness(point);
    }
    if (soft > 0.0 && !(stiffness > 0.0)) {
        dea_row_refuse(row, DEA_STATE_PULL_IN);
        return;
    }
    dea_row_fill(row, point, found_at(point, soft > 0.0 ? dea_point_sign(point) * dea_point_electric(point).first * soft / stiffness : 0.0, true));
}

/* Moduli of one region: W11, W12 and what the voltage takes off where it carries the electrode. */
typedef struct region {
    dea_expr a, b; /* tangent moduli with softening [Pa] */
    dea_expr rest; /* nominal stress at rest under voltage [Pa] */
} region;

/* Smaller of the two in-plane stresses: both must stay positive. */
static void limit_region(dea_pool *pool, dea_network *network, region r, dea_expr d1, dea_expr d2)
{
    dea_network_taut(network, ADD(r.rest, ADD(MUL(r.a, d1), MUL(r.b, d2))));
    dea_network_taut(network, ADD(r.rest, ADD(MUL(r.b, d1), MUL(r.a, d2))));
}

static void limit_tension(const dea_symbols *symbols, dea_network *network, region disc, region annulus)
{
    dea_pool *pool = symbols->pool;
    const dea_expr one = NUM(1.0);
    const dea_expr b2 = SQUARE(symbols->coverage);
    const dea_expr rest = SUB(one, b2);
    const dea_expr q = DIV(ADD(one, b2), rest);
    const dea_expr change = MUL(symbols->prestretch, network->strain);
    limit_region(pool, network, disc, change, change);
    limit_region(pool, network, annulus, NEG(MUL(q, change)), change);
    limit_region(pool, network, annulus, SCALE(-2.0, MUL(change, DIV(b2, rest))), NUM(0.0));
}

/* Disc and annulus as springs, softening as a negative one, and the force of Eq. 21 over the circumference. */
static void build(const dea_symbols *symbols, dea_network *network)
{
    dea_pool *pool = symbols->pool;
    const bool dot = symbols->kind == DEA_DOT;
    const dea_expr one = NUM(1.0);
    const dea_tangent tangent = dea_symbols_tangent(symbols);
    const dea_expr w11 = tangent.w11, w12 = tangent.w12;
    const dea_expr l = symbols->prestretch;
    const dea_expr thickness = SCALE(2.0 * DEA_PI, symbols->film_thickness);
    const dea_expr b2 = SQUARE(symbols->coverage);
    const dea_expr q = DIV(ADD(one, b2), SUB(one, b2));
    const dea_expr soft = MUL(dea_symbols_pressure(symbols), SQUARE(l)); /* M lambda_pre^2 */
    const dea_symbols_factors electric = dea_symbols_electric(symbols, one, one);
    const dea_expr both = ADD(electric.first, electric.second), maxwell = MUL(MUL(soft, electric.first), l);
    const dea_expr rest = DIV(dea_symbols_rest_stress(symbols), l); /* nominal */

    dea_network_add(network, DEA_ROLE_SPRING, "n_disc", "compliance of the disc, 1/n = 2 pi H (W11 + W12) [m/N]",
                    MUL(thickness, ADD(w11, w12)));
    dea_network_add(network, DEA_ROLE_SPRING, "n_annulus",
                    "compliance of the annulus, 1/n = 2 pi H (W11 (1+B^2)/(1-B^2) - W12) [m/N]",
                    MUL(thickness, SUB(MUL(w11, q), w12)));
    const dea_expr share = dot ? ADD(both, electric.second) : SUB(MUL(q, electric.second), both);
    dea_network_add(network, DEA_ROLE_SOFTENING, "n_el", "electrostatic softening, a negative compliance [m/N]",
                    NEG(MUL(thickness, MUL(soft, share))));
    const dea_expr radius = DIV(MUL(symbols->coverage, symbols->frame_radius), l); /* R_a */
    dea_network_add(network, DEA_ROLE_SOURCE, "f_dea", "electrostatic force 2 pi H M lambda_pre^3 R_a, Eq. 21 [N]",
                    SCALE(network->sign, MUL(thickness, MUL(maxwell, radius))));
    /* C = C_0 + C_1 u + C_2 u^2/2 with C_1 = 2 F_DEA/U^2 and C_2 = -2/(n_el U^2) */
    const dea_expr unit = MUL(thickness, MUL(DIV(symbols->permittivity, SQUARE(symbols->film_thickness)), SQUARE(l)));
    const dea_expr first = SCALE(2.0 * network->sign, MUL(MUL(unit, electric.first), MUL(l, radius)));
    const dea_expr second = SCALE(2.0, MUL(unit, share));
    network->capacitance =
        ADD(dea_symbols_capacitance(symbols), MUL(network->edge, ADD(first, SCALE(0.5, MUL(second, network->edge)))));
    const region passive = {w11, w12, rest};
    region active = {SUB(w11, MUL(soft, electric.second)), SUB(w12, MUL(soft, both)), SUB(rest, maxwell)};
    if (symbols->skin) {
        const dea_tangent skin = dea_symbols_skin_tangent(symbols);
        const dea_expr coat = dot ? ADD(skin.w11, skin.w12) : SUB(MUL(skin.w11, q), skin.w12);
        active.a = ADD(active.a, skin.w11);
        active.b = ADD(active.b, skin.w12);
        dea_network_add(network, DEA_ROLE_BESIDE, "n_skin", "compliance of the electrodes' skin beside its film [m/N]",
                        MUL(thickness, coat));
    }
    limit_tension(symbols, network, dot ? active : passive, dot ? passive : active);
    dea_network_limit_area(symbols, network);
}

static void linear(const dea_point *point, dea_linear *linear)
{
    const dea_film *film = &point->film;
    const double b2 = point->coverage * point->coverage;
    const double q = (1.0 + b2) / (1.0 - b2);
    const double thickness = 2.0 * DEA_PI * point->film_thickness;
    const double unit = thickness * film->permittivity / (point->film_thickness * point->film_thickness) * film->square;
    const double share = softening_share(point);
    *linear = (dea_linear){.stiffness = thickness * (film->w11 + film->w12 + film->w11 * q - film->w12),
                           .softening = -unit * share,
                           .force = dea_point_sign(point) * unit * dea_point_electric(point).first * dea_point_divide(point)};
    linear->beside = thickness * beside_stiffness(point);
    linear->capacitance[0] = dea_point_capacitance(point);
    linear->capacitance[1] = 2.0 * linear->force;
    linear->capacitance[2] = 2.0 * unit * share;
}

static bool hold(const dea_point *point, double strain, dea_hold *hold)
{
    dea_linear l;
    linear(point, &l);
    const double square = point->voltage * point->voltage, u = strain * dea_point_divide(point);
    const double stiffness = l.stiffness + l.beside - point->load, softening = l.softening * square;
    *hold = (dea_hold){false, found_at(point, strain, false), stiffness * u, stiffness, l.force * square - softening * u, -softening};
    return stiffness > 0.0;
}

const dea_model dea_model_lame = {
    .name = "lame",
    .equation = "Lame's disc and annulus",
    .leaves_out = "finite strain",
    .lens = true,
    .edge = true,
    .solve = solve,
    .network = build,
    .linear = linear,
    .hold = hold,
    .dynamic = true,
    .part = &(const dea_model_part){"_lame", "Lame's disc and annulus with electrostatic softening", false, 1.0, 1e-6},
};
