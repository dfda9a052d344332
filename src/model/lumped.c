/* Eqs. 19-23: two linear springs and a force source. */
#include "model/film_balance.h"
#include "expression/formula.h"
#include "network/network.h"

/* A difference of terms of size 1 below which it is computed again in long double. */
static const double nearly = 1e-2;

/* Modulus of one spring that is as stiff as all: (1 - B) Y_disc + B Y_annulus, one of them with the skin, and a load k, which is
 * (1 - B) k r_a/A_cross. */
static double modulus_of(const dea_point *point)
{
    const double b = point->coverage, share = point->kind == DEA_DOT ? 1.0 - b : b;
    const double load = (1.0 - b) * point->load * dea_point_divide(point) / dea_point_cross_section(point);
    return point->film.modulus + share * dea_point_skin_modulus(point) + load;
}

/* Area of a lens' annulus over that at rest where the edge of the disc comes to the frame's radius on the other side of the centre,
 * as a linear film lets it: 1 - (B (1 + s))^2 cancels there. */
static double fine_area(const dea_point *point)
{
    const dea_film *film = &point->film;
    const long double b = point->coverage, field = (long double)point->voltage / point->film_thickness,
                      y = (long double)film->prestretch * film->prestretch;
    const long double pull = film->permittivity * dea_point_electric(point).first * field * field * y * y;
    const long double edge = b * (1.0L - (1.0L - b) * pull / modulus_of(point));
    return (double)((1.0L - edge) * (1.0L + edge) / (1.0L - b * b));
}

/* Under a load the electroded film is taut where the strain that its stress stands for, [(Y + Y_skin) e - M lambda_pre^4]/Y, leaves a
 * stretch above 1; alone it is that of the passive film. */
static bool is_active_taut(const dea_point *point, double strain)
{
    const double b = point->coverage, e = point->kind == DEA_DOT ? strain : -b * strain / (1.0 - b);
    const double modulus = point->film.modulus + dea_point_skin_modulus(point);
    const double maxwell = dea_point_pressure(point) * dea_point_electric(point).first;
    return point->film.prestretch * (1.0 + (modulus * e - maxwell) / point->film.modulus) > 1.0;
}

/* The film at a strain; @p alone: in balance with its own force. */
static dea_found found_at(const dea_point *point, double strain, bool alone)
{
    const dea_film *film = &point->film;
    const double electric = dea_point_electric(point).first, pressure = dea_point_pressure(point) * electric, sign = dea_point_sign(point);
    const double b = point->coverage;
    const double stretch = 1.0 + strain;
    const double edge = b * stretch;
    /* passive stretch: Eq. 17 of a dot, the disc of a lens; electroded area: the disc of a dot, the annulus of a lens */
    const bool dot = point->kind == DEA_DOT;
    const bool taut = dot ? film->prestretch * (1.0 - edge) > 1.0 - b : film->prestretch * stretch > 1.0;
    const double left = 1.0 - edge * edge;
    const double area = dot ? stretch * stretch : alone && fabs(left) < nearly ? fine_area(point) : left / (1.0 - b * b);
    /* C_0 + C_1 u with C_1 u = 2 F_DEA/U^2 u = +-4 pi eps lambda_pre^2 r_a^2 s/H */
    const double rest = dot ? b * b : 1.0 - b * b;
    const double capacitance = dea_point_full_capacitance(point) * (rest + 4.0 * sign * b * b * electric * strain);
    return (dea_found){.strain = strain,
                       .force = sign * pressure * dea_point_cross_section(point),
                       .stretch = film->square * area,
                       .capacitance = capacitance,
                       .taut = taut && ((alone && !dea_point_is_loaded(point)) || is_active_taut(point, strain))};
}

static void solve(const dea_point *point, double accuracy, dea_row *row)
{
    (void)accuracy;
    const double pressure = dea_point_pressure(point) * dea_point_electric(point).first;
    if (pressure > 0.0 && !(modulus_of(point) > 0.0)) {
        dea_row_refuse(row, DEA_STATE_PULL_IN);
        return;
    }
    const double strain = dea_point_sign(point) * (1.0 - point->coverage) * pressure / modulus_of(point); /* Eq. 22 */
    dea_row_fill(row, point, found_at(point, strain, true));
}

/* Two springs in parallel at the edge of the electrode, driven by the force source. */
static void build(const dea_symbols *symbols, dea_network *network)
{
    dea_pool *pool = symbols->pool;
    const dea_expr one = NUM(1.0);
    const dea_expr section = dea_symbols_cross_section(symbols);
    const dea_expr tensile = MUL(symbols->modulus, section); /* Y A_cross */
    const dea_expr divide = MUL(symbols->frame_radius, symbols->coverage);
    const dea_expr square = SQUARE(symbols->prestretch);
    const dea_expr electric = dea_symbols_electric(symbols, one, one).first;
    const dea_expr maxwell = MUL(MUL(dea_symbols_pressure(symbols), electric), SQUARE(square));
    dea_network_add(network, DEA_ROLE_SPRING, "n_a", "compliance of the disc, Eq. 19 [m/N]", DIV(tensile, divide));
    dea_network_add(network, DEA_ROLE_SPRING, "n_p", "compliance of the annulus, Eq. 20 [m/N]",
                    DIV(tensile, dea_symbols_annulus_width(symbols)));
    if (symbols->skin) {
        const dea_expr way = symbols->kind == DEA_DOT ? divide : dea_symbols_annulus_width(symbols);
        dea_network_add(network, DEA_ROLE_BESIDE, "n_skin", "compliance of the electrodes' skin beside its film [m/N]",
                        DIV(MUL(dea_symbols_skin_modulus(symbols), section), way));
    }
    dea_network_add(network, DEA_ROLE_SOURCE, "f_dea", "electrostatic force, Eq. 21 [N]",
                    SCALE(network->sign, MUL(maxwell, section)));
    /* C = C_0 + C_1 u with C_1 = 2 F_DEA/U^2 */
    const dea_expr slope = SCALE(2.0 * network->sign, MUL(dea_symbols_stress_per_volt(symbols), section));
    network->capacitance = ADD(dea_symbols_capacitance(symbols), MUL(slope, network->edge));
    const dea_expr passive = symbols->kind == DEA_DOT ? dea_symbols_annulus_strain(symbols) : network->strain;
    dea_network_taut(network, SUB(MUL(symbols->prestretch, ADD(one, passive)), one));
    if (symbols->loaded) {
        const dea_expr active = symbols->kind == DEA_DOT ? network->strain : dea_symbols_annulus_strain(symbols);
        const dea_expr modulus = symbols->skin ? ADD(symbols->modulus, dea_symbols_skin_modulus(symbols)) : symbols->modulus;
        const dea_expr strain = DIV(SUB(MUL(modulus, active), maxwell), symbols->modulus);
        dea_network_taut(network, SUB(MUL(symbols->prestretch, ADD(one, strain)), one));
    }
    dea_network_limit_area(symbols, network);
}

static void linear(const dea_point *point, dea_linear *linear)
{
    const double section = dea_point_cross_section(point);
    const double width = (1.0 - point->coverage) * point->frame_radius;
    *linear = (dea_linear){.stiffness = point->film.modulus * section * (1.0 / dea_point_divide(point) + 1.0 / width),
                           .force = dea_point_sign(point) * dea_point_stress_per_volt(point) * section};
    linear->beside = dea_point_skin_modulus(point) * section / (point->kind == DEA_DOT ? dea_point_divide(point) : width) + point->load;
    linear->capacitance[0] = dea_point_capacitance(point);
    linear->capacitance[1] = 2.0 * linear->force;
}

static bool hold(const dea_point *point, double strain, dea_hold *hold)
{
    dea_linear l;
    linear(point, &l);
    const dea_found found = found_at(point, strain, false);
    const double stiffness = l.stiffness + l.beside - point->load;
    *hold = (dea_hold){false, found, stiffness * strain * dea_point_divide(point), stiffness, found.force, 0.0};
    return stiffness > 0.0;
}

const dea_model dea_model_lumped = {
    .name = "lumped",
    .equation = "Eqs. 19-23",
    .leaves_out = "hyperelasticity, hoop stress",
    .lens = true,
    .edge = true,
    .solve = solve,
    .network = build,
    .linear = linear,
    .hold = hold,
    .dynamic = true,
    .part = &(const dea_model_part){"", "two linear springs and a force, Eqs. 19-23", true, 1.0, 1.0},
};
