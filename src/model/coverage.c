/* Eq. 18: hyperelastic disc and annulus, each under its own equi-biaxial stretch. */
#include <math.h>

#include "model/film_balance.h"
#include "expression/formula.h"
#include "network/hyperelastic.h"
#include "support/gauss.h"
#include "support/lanes.h"

/* int_1^{1+s} (1 - B x)^4/x dx/(1 - B)^4, what pushes the lens over its way: in closed form, but where its terms cancel, near B = 1
 * for a small strain, by quadrature. */
static double push_of_lens(double b, double s)
{
    const double e = -b * s / (1.0 - b);
    double sum = 0.0;
    if (b > 0.5 && fabs(s) < 0.5) {
        for (int i = 0; i < DEA_GAUSS_POINTS; i++) {
            const double t = dea_gauss_place(i), square = (1.0 + e * t) * (1.0 + e * t);
            sum += dea_gauss_weight(i) * square * square / (1.0 + s * t);
        }
        return s * sum;
    }
    const double b2 = b * b, rest = (1.0 - b) * (1.0 - b);
    const double second = s * (2.0 + s), third = s * (3.0 + s * (3.0 + s)), fourth = second * (2.0 + second);
    sum = log1p(s) - b * (4.0 * s + 4.0 / 3.0 * b2 * third) + b2 * (3.0 * second + 0.25 * b2 * fourth);
    return sum / (rest * rest);
}

/* int_1^{1+s} (1 + e)^4 e/x dx with 1 + e = (1 - B x)/(1 - B), where `push` is that without e: what a permittivity that is linear
 * in e adds. (1 + e)/x = 1/(x (1 - B)) - B/(1 - B). */
static double more_push_of_lens(double b, double e, double push)
{
    const double second = e * (2.0 + e), fifth = second * (2.0 + second) * (1.0 + e) + e; /* (1 + e)^5 - 1 */
    return push * b / (1.0 - b) + 0.2 * fifth;
}

/* Dot: C_0 lambda_a^4. Lens: C_0 + int 2 F/U^2 du, because the equi-biaxial annulus is not the true area [F]. */
DEA_INLINE double capacitance_of(const dea_point *point, double strain)
{
    if (point->kind == DEA_DOT) {
        return dea_point_disc_capacitance(point, strain);
    }
    const double b = point->coverage, active = -b * strain / (1.0 - b), push = push_of_lens(b, strain);
    const double rise = 1.25 * point->film.electrostriction * point->film.prestretch;
    const double first = dea_point_electric(point).first;
    return dea_point_full_capacitance(point) * (1.0 - b * b - 4.0 * b * b * (first * push + rise * more_push_of_lens(b, active, push)));
}

/* Strain that the passive film gives back per strain of the active one. */
DEA_INLINE double ratio_of(const dea_point *point)
{
    const double b = point->coverage;
    return point->kind == DEA_DOT ? b / (1.0 - b) : (1.0 - b) / b;
}

/* sigma - sigma_pre of the film at an equi-biaxial strain, @p coated: with what its skin adds [Pa]. */
static dea_change change_at(const dea_point *point, double strain, bool coated)
{
    dea_change change, skin;
    point->film.law->change(&point->film, 1, &strain, &change);
    if (coated && point->skin_share > 0.0) {
        const double share = point->skin_share * point->film.square;
        point->skin.law->change(&point->skin, 1, &strain, &skin);
        change.value += share * skin.value;
        change.slope += share * skin.slope;
    }
    return change;
}

/* Under a load the electroded film need not hold what the passive one does: is sigma_A - eps E^2 positive? */
static bool is_active_taut(const dea_point *point, double pressure, double active)
{
    const double square = (1.0 + active) * (1.0 + active), pull = pressure * square * square;
    const double electric = dea_film_electric(&point->film, point->film.square * square).first;
    return point->film.tension * point->film.prestretch + change_at(point, active, true).value - electric * pull > 0.0;
}

DEA_INLINE dea_found found_at(const dea_point *point, double pressure, double active, bool alone)
{
    const bool dot = point->kind == DEA_DOT;
    const double passive = -ratio_of(point) * active;
    const double strain = dot ? active : passive;
    const double stretch = 1.0 + active;
    const double square = stretch * stretch;
    const dea_electric electric = dea_film_electric(&point->film, point->film.square * square);
    const double area = dea_point_cross_section(point) / (1.0 + strain); /* A(lambda_a) = 2 pi r_a H/(lambda_pre^2 lambda_a) */
    const bool taut = point->film.prestretch * (1.0 + passive) > 1.0;
    return (dea_found){.strain = strain,
                       .force = dea_point_sign(point) * area * pressure * square * square * electric.first,
                       .stretch = point->film.square * square,
                       .capacitance = capacitance_of(point, strain),
                       .taut = taut && (alone || is_active_taut(point, pressure, active))};
}

static void fill(const dea_point *point, double pressure, double active, dea_row *row)
{
    dea_row_fill(row, point, found_at(point, pressure, active, !dea_point_is_loaded(point)));
}

/* A (sigma_disc - sigma_annulus) inward, A eps E^2 outward from the disc or inward from the annulus, A = A_cross/(1 + s). */
static bool hold(const dea_point *point, double strain, dea_hold *hold)
{
    const bool dot = point->kind == DEA_DOT;
    const double b = point->coverage, annulus = -b * strain / (1.0 - b), turn = -b / (1.0 - b);
    const double active = dot ? strain : annulus, active_turn = dot ? 1.0 : turn;
    const dea_change in = change_at(point, strain, dot), out = change_at(point, annulus, !dot);
    const double square = (1.0 + active) * (1.0 + active);
    const dea_electric electric = dea_film_electric(&point->film, point->film.square * square);
    const double edge = 1.0 + strain, area = dea_point_cross_section(point) / edge, radius = dea_point_divide(point);
    const double stress = in.value - out.value;
    hold->found = found_at(point, dea_point_pressure(point), active, false);
    hold->held = area * stress;
    hold->held_slope = area / radius * (in.slope - turn * out.slope - stress / edge);
    hold->push = hold->found.force;
    hold->push_slope = hold->push / radius * (2.0 * (1.0 + electric.second / electric.first) * active_turn / (1.0 + active) - 1.0 / edge);
    return edge > 0.0 && 1.0 + annulus > 0.0 && isfinite(hold->held);
}

static void solve_many(const dea_point *points, size_t count, double accuracy, dea_row *rows)
{
    (void)accuracy;
    dea_film_balances_solve(points, count, ratio_of, fill, rows);
}

static void solve(const dea_point *point, double accuracy, dea_row *row)
{
    solve_many(point, 1, accuracy, row);
}

/* s int_0^1 (1 + e t)^4/(1 + s t) dt with e = -B s/(1 - B), by quadrature: right for all B, also where that is a symbol, as long
 * as |s| is no more than some 0.6. For parts, whose texts stay short by it. */
static dea_expr push_by_rule(const dea_symbols *symbols, dea_expr s)
{
    dea_pool *pool = symbols->pool;
    const dea_expr one = NUM(1.0);
    const dea_expr e = dea_symbols_annulus_strain(symbols);
    dea_expr sum = NUM(0.0);
    for (int i = 0; i < DEA_GAUSS_POINTS; i++) {
        const double t = dea_gauss_place(i);
        const dea_expr fourth = SQUARE(SQUARE(ADD(one, SCALE(t, e))));
        sum = ADD(sum, SCALE(dea_gauss_weight(i), DIV(fourth, ADD(one, SCALE(t, s)))));
    }
    return MUL(s, sum);
}

/* The same in closed form, int_1^x (1 - B x)^4/x dx/(1 - B)^4 with x = 1 + s: right for all s, but its terms cancel as B nears 1.
 */
static dea_expr push_by_logarithm(const dea_symbols *symbols, dea_expr s)
{
    dea_pool *pool = symbols->pool;
    const dea_expr b = symbols->coverage;
    const dea_expr b2 = SQUARE(b);
    const dea_expr second = MUL(s, ADD(NUM(2.0), s));                       /* x^2 - 1 */
    const dea_expr third = MUL(s, ADD(NUM(3.0), MUL(s, ADD(NUM(3.0), s)))); /* x^3 - 1 */
    const dea_expr fourth = MUL(second, ADD(NUM(2.0), second));             /* x^4 - 1 */
    const dea_expr odd = MUL(b, ADD(SCALE(4.0, s), SCALE(4.0 / 3.0, MUL(b2, third))));
    const dea_expr even = MUL(b2, ADD(SCALE(3.0, second), SCALE(0.25, MUL(b2, fourth))));
    return DIV(SUB(ADD(LN(ADD(NUM(1.0), s)), even), odd), SQUARE(SQUARE(SUB(NUM(1.0), b))));
}

/* base^n. */
static dea_expr power(dea_pool *pool, dea_expr base, unsigned n)
{
    dea_expr product = NUM(1.0);
    for (; n > 0; n /= 2, base = SQUARE(base)) {
        product = n % 2 ? MUL(product, base) : product;
    }
    return product;
}

/* K_4 = int_0^1 t^4/(1 + s t) dt = [ln(1 + s) - s + s^2/2 - s^3/3 + s^4/4]/s^5. The rule is right near rest, where these terms
 * cancel, and the terms are where the film nears its centre, so that the rule misses the pole: weights 1/(1 + r) and r/(1 + r),
 * r = (s/0.45)^32, leave no more than 4e-13 of either's error for all s > -0.99. */
static dea_expr fourth_moment(dea_pool *pool, dea_expr s)
{
    const double middle = 0.45;
    const dea_expr one = NUM(1.0), x = SCALE(1.0 / middle, s), weight = DIV(one, ADD(one, power(pool, x, 32)));
    dea_expr rule = NUM(0.0);
    for (int i = 0; i < DEA_GAUSS_POINTS; i++) {
        const double t = dea_gauss_place(i);
        rule = ADD(rule, DIV(NUM(dea_gauss_weight(i) * t * t * t * t), ADD(one, SCALE(t, s))));
    }
    const dea_expr tail = MUL(s, SUB(one, MUL(s, SUB(NUM(0.5), MUL(s, SUB(NUM(1.0 / 3.0), SCALE(0.25, s)))))));
    const dea_expr terms = SCALE(pow(middle, -5.0), MUL(power(pool, x, 27), SUB(LN(ADD(one, s)), tail)));
    return MUL(weight, ADD(rule, terms));
}

/* The same for a wide lens, whose strain is at most (1 - B)/B: by the moments K_k = int_0^1 t^k/(1 + s t) dt = 1/(k + 1) - s
 * K_(k+1). Where the disc shrinks, no two terms of the sum cancel. */
static dea_expr push_by_moments(const dea_symbols *symbols, dea_expr s)
{
    static const double binomial[] = {1.0, 4.0, 6.0, 4.0};
    dea_pool *pool = symbols->pool;
    const dea_expr e = dea_symbols_annulus_strain(symbols);
    dea_expr moment = fourth_moment(pool, s), sum = MUL(power(pool, e, 4), moment);
    for (unsigned k = 4; k-- > 0;) {
        moment = SUB(NUM(1.0 / (k + 1)), MUL(s, moment));
        sum = ADD(sum, SCALE(binomial[k], MUL(power(pool, e, k), moment)));
    }
    return MUL(s, sum);
}

/* The push where the permittivity follows the strain, of that where it does not and more_push_of_lens(). */
static dea_expr following_push(const dea_symbols *symbols, dea_expr push)
{
    dea_pool *pool = symbols->pool;
    const dea_expr b = symbols->coverage, e = dea_symbols_annulus_strain(symbols);
    const dea_expr second = MUL(e, ADD(NUM(2.0), e)), fourth = MUL(second, ADD(NUM(2.0), second));
    const dea_expr fifth = ADD(MUL(fourth, ADD(NUM(1.0), e)), e);
    const dea_expr more = ADD(DIV(MUL(push, b), SUB(NUM(1.0), b)), SCALE(0.2, fifth));
    const dea_expr first = dea_symbols_electric(symbols, NUM(1.0), NUM(1.0)).first;
    return ADD(MUL(first, push), MUL(SCALE(1.25, MUL(symbols->electrostriction, symbols->prestretch)), more));
}

/* Dot: C = C_0 lambda_a^4. Lens: C = C_0 + int 2 F/U^2 du because the equi-biaxial annulus is not the true area, with
 * F/U^2 = -2 pi r_a eps lambda_pre^2 (1 + e)^4/(H (1 + s)), s and e the strains of disc and annulus, both proportional to u. */
static dea_expr capacitance(const dea_symbols *symbols, dea_expr strain)
{
    dea_pool *pool = symbols->pool;
    const dea_expr rest = dea_symbols_capacitance(symbols);
    if (symbols->kind == DEA_DOT) {
        const dea_expr stretch = ADD(NUM(1.0), strain);
        return MUL(MUL(rest, dea_symbols_electric(symbols, stretch, stretch).own), SQUARE(SQUARE(stretch)));
    }
    const dea_expr radius = MUL(symbols->coverage, symbols->frame_radius);
    const dea_expr front = MUL(symbols->permittivity, DIV(SQUARE(MUL(radius, symbols->prestretch)), symbols->film_thickness));
    const double coverage = dea_expr_constant(pool, symbols->coverage); /* NAN where it is a symbol */
    const bool part = isnan(coverage) && isnan(dea_expr_constant(pool, symbols->film_thickness)); /* all its scalars are symbols */
    const dea_expr push = coverage < 0.5 ? push_by_logarithm(symbols, strain)
                          : part         ? push_by_rule(symbols, strain)
                                         : push_by_moments(symbols, strain);
    const bool constant = dea_expr_constant(pool, symbols->electrostriction) == 0.0;
    return SUB(rest, MUL(SCALE(4.0 * DEA_PI, front), constant ? push : following_push(symbols, push)));
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
    const dea_expr area = dea_hyperelastic_area(symbols, disc);
    network->capacitance = capacitance(symbols, disc);
    dea_network_call(network, ADD(one, disc), "stretch_disc", "stretch of the disc over the pre-stretch [1]");
    dea_network_call(network, ADD(one, annulus), "stretch_annulus", "stretch of the annulus over the pre-stretch, Eq. 17 [1]");
    dea_network_add_stress(network, "n_disc", "disc, sigma - sigma_pre [Pa] on the area A, Eq. 18",
                           dea_hyperelastic_change(symbols, disc), area);
    dea_network_add_stress(network, "n_annulus", "annulus, sigma_pre - sigma [Pa] on the area A, Eqs. 17, 18",
                           NEG(dea_hyperelastic_change(symbols, annulus)), area);
    if (symbols->skin) {
        dea_network_add(network, DEA_ROLE_TENSION, "n_skin", "skin of the electrodes, its stress on the area A [N]",
                        SCALE(network->sign, MUL(area, dea_hyperelastic_skin(symbols, active, active))));
    }
    dea_network_add(network, DEA_ROLE_SOURCE, "f_dea", "electrostatic force, A eps E^2, Eq. 18 [N]",
                    SCALE(network->sign, dea_hyperelastic_force(symbols, disc, active)));
    network->ends = true;
    network->field = dea_hyperelastic_field(symbols, active);
    dea_network_insulate(symbols, network, ADD(one, active), ADD(one, active));
    dea_network_taut(network, SUB(MUL(symbols->prestretch, ADD(one, passive)), one));
    if (symbols->loaded) {
        const dea_expr electric = dea_symbols_electric(symbols, ADD(one, active), ADD(one, active)).first;
        const dea_expr fourth = SQUARE(SQUARE(MUL(symbols->prestretch, ADD(one, active))));
        const dea_expr pull = MUL(MUL(dea_symbols_pressure(symbols), electric), fourth);
        const dea_expr film = ADD(dea_symbols_rest_stress(symbols), dea_hyperelastic_change(symbols, active));
        const dea_expr coated = symbols->skin ? ADD(film, dea_hyperelastic_skin(symbols, active, active)) : film;
        dea_network_taut(network, SUB(coated, pull));
    }
}

/* Equi-biaxial, whatever the place: lambda_P of Eq. 18. */
static bool along(const dea_point *point, double strain, size_t count, const double *x, dea_stretches *stretches)
{
    const double pre = point->film.prestretch, b = point->coverage, passive = pre * (1.0 - b * strain / (1.0 - b));
    (void)x;
    for (size_t i = 0; i < count; i++) {
        stretches[i] = (dea_stretches){passive, passive};
    }
    return true;
}

const dea_model dea_model_coverage = {
    .name = "coverage",
    .equation = "Eq. 18",
    .leaves_out = "non-uniform passive stress",
    .lens = true,
    .edge = true,
    .solve = solve,
    .solve_many = solve_many,
    .along = along,
    .hold = hold,
    .network = build,
    .dynamic = true,
    .part = &(const dea_model_part){"_hyper", "hyperelastic disc and annulus, Eq. 18, quasi-linear relaxation", false, 1e6, 1.0},
};
