/* Eqs. 19-23: two linear springs and a force source. */
#include "model/film_balance.h"
#include "network/network.h"

static void solve(const dea_point *point, double accuracy, dea_row *row)
{
    (void)accuracy;
    const dea_film *film = &point->film;
    const double pressure = dea_point_pressure(point);
    if (pressure > 0.0 && !(film->modulus > 0.0)) {
        dea_row_refuse(row, DEA_STATE_PULL_IN);
        return;
    }
    const double sign = dea_point_sign(point);
    const double b = point->coverage;
    const double strain = sign * (1.0 - b) * pressure / film->modulus; /* Eq. 22 */
    const double stretch = 1.0 + strain;
    const double edge = b * stretch;
    /* passive stretch: Eq. 17 of a dot, the disc of a lens; electroded area: the disc of a dot, the annulus of a lens */
    const bool dot = point->kind == DEA_DOT;
    const bool taut = dot ? film->prestretch * (1.0 - edge) > 1.0 - b : film->prestretch * stretch > 1.0;
    const double area = dot ? stretch * stretch : (1.0 - edge * edge) / (1.0 - b * b);
    dea_row_fill(row, point, strain, sign * pressure * dea_point_cross_section(point), film->square * area, taut);
}

/* Two springs in parallel at the edge of the electrode, driven by the force source. */
static void build(const dea_symbols *symbols, dea_network *network)
{
    dea_pool *pool = symbols->pool;
    const dea_ref one = dea_number(pool, 1.0);
    const dea_ref section = dea_symbols_cross_section(symbols);
    const dea_ref tensile = dea_mul(pool, symbols->modulus, section); /* Y A_cross */
    const dea_ref divide = dea_mul(pool, symbols->frame_radius, symbols->coverage);
    const dea_ref square = dea_square(pool, symbols->prestretch);
    const dea_ref maxwell = dea_mul(pool, dea_symbols_pressure(symbols), dea_square(pool, square));
    dea_network_add(network, DEA_ROLE_SPRING, "n_a", "compliance of the disc, Eq. 19 [m/N]", dea_div(pool, tensile, divide));
    dea_network_add(network, DEA_ROLE_SPRING, "n_p", "compliance of the annulus, Eq. 20 [m/N]",
                    dea_div(pool, tensile, dea_symbols_annulus_width(symbols)));
    dea_network_add(network, DEA_ROLE_SOURCE, "f_dea", "electrostatic force, Eq. 21 [N]",
                    dea_scale(pool, network->sign, dea_mul(pool, maxwell, section)));
    const dea_ref passive = symbols->kind == DEA_DOT ? dea_symbols_annulus_strain(symbols) : network->strain;
    dea_network_taut(network, dea_sub(pool, dea_mul(pool, symbols->prestretch, dea_add(pool, one, passive)), one));
    dea_network_limit_area(symbols, network);
}

const dea_model dea_model_lumped = {
    .name = "lumped",
    .equation = "Eqs. 19-23",
    .leaves_out = "hyperelasticity, hoop stress",
    .lens = true,
    .solve = solve,
    .network = build,
};
