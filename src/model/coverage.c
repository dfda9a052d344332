/* Eq. 18: hyperelastic disc and annulus, each under its own equi-biaxial stretch. */
#include "model/film_balance.h"
#include "network/formula.h"
#include "network/hyperelastic.h"
#include "support/gauss.h"

static void solve(const dea_point *point, double accuracy, dea_row *row)
{
    (void)accuracy;
    const bool dot = point->kind == DEA_DOT;
    const double b = point->coverage;
    const double ratio = dot ? b / (1.0 - b) : (1.0 - b) / b;
    const double pressure = dea_point_pressure(point);
    double active; /* strain of the electroded film */
    if (!dea_film_balance(&point->film, ratio, pressure, &active)) {
        dea_row_refuse(row, DEA_STATE_PULL_IN);
        return;
    }
    const double passive = -ratio * active;
    const double strain = dot ? active : passive;
    const double stretch = 1.0 + active;
    const double square = stretch * stretch;
    const double area = dea_point_cross_section(point) / (1.0 + strain); /* A(lambda_a) = 2 pi r_a H/(lambda_pre^2 lambda_a) */
    const bool taut = point->film.prestretch * (1.0 + passive) > 1.0;
    dea_row_fill(row, point, strain, dea_point_sign(point) * area * pressure * square * square, point->film.square * square,
                 taut);
}

/* int_0^1 (1 + e t)^4/(1 + s t) dt by the rule: in closed form it takes a logarithm and loses all digits as B nears 1. */
static dea_expr mean_push(dea_pool *pool, dea_expr s, dea_expr e)
{
    const dea_expr one = NUM(1.0);
    dea_expr sum = NUM(0.0);
    for (int i = 0; i < DEA_GAUSS_POINTS; i++) {
        const double t = dea_gauss_place(i);
        const dea_expr fourth = SQUARE(SQUARE(ADD(one, SCALE(t, e))));
        sum = ADD(sum, SCALE(dea_gauss_weight(i), DIV(fourth, ADD(one, SCALE(t, s)))));
    }
    return sum;
}

/* Dot: C = C_0 lambda_a^4. Lens: C = C_0 + int 2 F/U^2 du because the equi-biaxial annulus is not the true area, with
 * F/U^2 = -2 pi r_a eps lambda_pre^2 (1 + e)^4/(H (1 + s)), s and e the strains of disc and annulus, both proportional to u. */
static dea_expr capacitance(const dea_symbols *symbols, dea_expr strain)
{
    dea_pool *pool = symbols->pool;
    const dea_expr rest = dea_symbols_capacitance(symbols);
    if (symbols->kind == DEA_DOT) {
        return MUL(rest, SQUARE(SQUARE(ADD(NUM(1.0), strain))));
    }
    const dea_expr radius = MUL(symbols->coverage, symbols->frame_radius);
    const dea_expr front = MUL(symbols->permittivity, DIV(SQUARE(MUL(radius, symbols->prestretch)), symbols->film_thickness));
    const dea_expr mean = mean_push(pool, strain, dea_symbols_annulus_strain(symbols));
    return SUB(rest, MUL(SCALE(4.0 * DEA_PI, front), MUL(strain, mean)));
}

/* Edge equation of physics.md, section 5: A(lambda_a) times the stress differences to the pre-stretch, as two springs and a
 * source. */
static void build(const dea_symbols *symbols, dea_network *network)
{
    dea_pool *pool = symbols->pool;
    const bool dot = symbols->kind == DEA_DOT;
    const dea_expr one = NUM(1.0);
    const dea_expr disc = network->strain;
    const dea_expr annulus = dea_symbols_annulus_strain(symbols);
    const dea_expr active = dot ? disc : annulus;
    const dea_expr passive = dot ? annulus : disc;
    network->area = dea_hyperelastic_area(symbols, disc);
    network->capacitance = capacitance(symbols, disc);
    dea_network_add(network, DEA_ROLE_HYPERELASTIC, "n_disc", "disc, sigma - sigma_pre [Pa] on the area A, Eq. 18",
                    dea_hyperelastic_change(symbols, disc));
    dea_network_add(network, DEA_ROLE_HYPERELASTIC, "n_annulus", "annulus, sigma_pre - sigma [Pa] on the area A, Eqs. 17, 18",
                    NEG(dea_hyperelastic_change(symbols, annulus)));
    dea_network_add(network, DEA_ROLE_SOURCE, "f_dea", "electrostatic force, A eps E^2, Eq. 18 [N]",
                    SCALE(network->sign, dea_hyperelastic_force(symbols, disc, active)));
    network->end = dot ? dea_symbols_annulus_width(symbols) : MUL(symbols->coverage, symbols->frame_radius);
    network->field = dea_hyperelastic_field(symbols, active);
    dea_network_taut(network, SUB(MUL(symbols->prestretch, ADD(one, passive)), one));
}

const dea_model dea_model_coverage = {
    .name = "coverage",
    .equation = "Eq. 18",
    .leaves_out = "non-uniform passive stress",
    .lens = true,
    .solve = solve,
    .network = build,
    .dynamic = true,
};
