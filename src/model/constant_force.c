/* Eq. 13: hyperelastic film under a bias force that does not change. */
#include "model/film_balance.h"
#include "expression/formula.h"
#include "network/hyperelastic.h"

static double free_edge(const dea_point *point)
{
    (void)point;
    return 0.0;
}

static void fill(const dea_point *point, double pressure, double strain, dea_row *row)
{
    const double stretch = 1.0 + strain;
    const double electric = dea_film_electric(&point->film, point->film.square * stretch * stretch).first;
    const double force = pressure * electric * stretch * stretch * stretch * dea_point_cross_section(point); /* A(lambda_a) eps E^2 */
    dea_row_fill(row, point,
                 (dea_found){.strain = strain,
                             .force = force,
                             .stretch = point->film.square * stretch * stretch,
                             .capacitance = dea_point_disc_capacitance(point, strain),
                             .taut = true});
}

static void solve_many(const dea_point *points, size_t count, double accuracy, dea_row *rows)
{
    (void)accuracy;
    dea_film_balances_solve(points, count, free_edge, fill, rows);
}

static void solve(const dea_point *point, double accuracy, dea_row *row)
{
    solve_many(point, 1, accuracy, row);
}

/* The disc alone as a spring: the bias force is in its measure from the pre-stretch. */
static void build(const dea_symbols *symbols, dea_network *network)
{
    dea_pool *pool = symbols->pool;
    const dea_expr area = dea_hyperelastic_area(symbols, network->strain);
    dea_network_call(network, ADD(NUM(1.0), network->strain), "stretch_disc", "stretch of the disc over the pre-stretch [1]");
    dea_network_add_stress(network, "n_disc", "disc, sigma - sigma_pre [Pa] on the area A, Eq. 13",
                           dea_hyperelastic_change(symbols, network->strain), area);
    if (symbols->skin) {
        dea_network_add(network, DEA_ROLE_TENSION, "n_skin", "skin of the electrodes, its stress on the area A [N]",
                        MUL(area, dea_hyperelastic_skin(symbols, network->strain, network->strain)));
    }
    dea_network_add(network, DEA_ROLE_SOURCE, "f_dea", "electrostatic force, A eps E^2, Eq. 13 [N]",
                    dea_hyperelastic_force(symbols, network->strain, network->strain));
    const dea_expr stretch = ADD(NUM(1.0), network->strain);
    const dea_expr rest = MUL(dea_symbols_capacitance(symbols), dea_symbols_electric(symbols, stretch, stretch).own);
    network->capacitance = MUL(rest, SQUARE(SQUARE(stretch))); /* C_0 lambda_a^4 */
    network->field = dea_hyperelastic_field(symbols, network->strain);
    dea_network_insulate(symbols, network, stretch, stretch);
    network->length = MUL(symbols->coverage, symbols->frame_radius);
}

const dea_model dea_model_constant_force = {
    .name = "constant_force",
    .equation = "Eq. 13",
    .leaves_out = "loss of bias force; an upper bound",
    .lens = false,
    .solve = solve,
    .solve_many = solve_many,
    .network = build,
};
