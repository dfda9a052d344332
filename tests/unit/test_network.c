/* Expressions, tapes, networks, their balance of forces, and netlist text. */
#include "judges.h"
#include "random_scenes.h"

#include <ctype.h>
#include <stdlib.h>

#include "expression/derivative.h"
#include "netlist/netlist.h"
#include "network/balance.h"

static const double pi = 3.14159265358979323846;

/* Value and slope of an expression by its written form, in long double, and bounds of both: the same sums without cancellation.
 */
typedef struct dual {
    long double value, slope, most, most_slope;
} dual;

typedef struct tree {
    dea_expr expr;
    dual dual;
} tree;

static tree leaf(dea_pool *pool, uint64_t *seed, double symbol, double node)
{
    const double pick = random_unit(seed);
    if (pick < 0.3) {
        return (tree){dea_expr_node(pool, 0), {node, 1.0L, fabs(node), 1.0L}};
    }
    if (pick < 0.5) {
        return (tree){dea_expr_symbol(pool, 0), {symbol, 0.0L, fabs(symbol), 0.0L}};
    }
    const double numbers[] = {0.0, 1.0, -1.0, 2.0, 0.3, -1.7, 5.25};
    const double number = numbers[(int)(7.0 * random_unit(seed))];
    return (tree){dea_expr_number(pool, number), {number, 0.0L, fabs(number), 0.0L}};
}

static dual times(dual a, dual b)
{
    return (dual){a.value * b.value, a.slope * b.value + a.value * b.slope, a.most * b.most,
                  a.most_slope * b.most + a.most * b.most_slope};
}

/* a over 1 + b^2: a denominator that loses no digits. */
static tree quotient(dea_pool *pool, tree a, tree b)
{
    const dea_expr below = dea_expr_add(pool, dea_expr_number(pool, 1.0), dea_expr_square(pool, b.expr));
    const long double d = 1.0L + b.dual.value * b.dual.value;
    const long double slope = 2.0L * b.dual.value * b.dual.slope;
    const long double most = 1.0L + b.dual.most * b.dual.most;
    const long double most_slope = 2.0L * b.dual.most * b.dual.most_slope;
    const dual one_over = {1.0L / d, -slope / (d * d), most / (d * d), most_slope * most / (d * d * d)};
    return (tree){dea_expr_div(pool, a.expr, below), times(a.dual, one_over)};
}

static tree grow(dea_pool *pool, uint64_t *seed, int depth, double symbol, double node)
{
    if (depth == 0 || random_chance(seed, 0.1)) {
        return leaf(pool, seed, symbol, node);
    }
    const tree a = grow(pool, seed, depth - 1, symbol, node);
    const tree b = random_chance(seed, 0.15) ? a : grow(pool, seed, depth - 1, symbol, node);
    const dual sum = {a.dual.value + b.dual.value, a.dual.slope + b.dual.slope, a.dual.most + b.dual.most,
                      a.dual.most_slope + b.dual.most_slope};
    const dual less = {a.dual.value - b.dual.value, a.dual.slope - b.dual.slope, sum.most, sum.most_slope};
    switch ((int)(6.0 * random_unit(seed))) {
    case 0:
        return (tree){dea_expr_add(pool, a.expr, b.expr), sum};
    case 1:
        return (tree){dea_expr_sub(pool, a.expr, b.expr), less};
    case 2:
        return quotient(pool, a, b);
    case 3:
        return (tree){dea_expr_neg(pool, a.expr), {-a.dual.value, -a.dual.slope, a.dual.most, a.dual.most_slope}};
    case 4:
        return (tree){dea_expr_square(pool, a.expr), times(a.dual, a.dual)};
    default:
        return (tree){dea_expr_mul(pool, a.expr, b.expr), times(a.dual, b.dual)};
    }
}

static void tape_gives_value_and_exact_slope_of_any_expression(void **state)
{
    (void)state;
    uint64_t seed = 20260101;
    for (int i = 0; i < 3000; i++) {
        dea_pool pool = {0};
        dea_tape tape;
        const double symbol = random_between(&seed, -2.0, 2.0);
        const double node = random_between(&seed, -2.0, 2.0);
        (void)dea_expr_number(&pool, 0.0);
        const tree t = grow(&pool, &seed, 6, symbol, node);
        assert_int_equal(dea_tape_compile(&pool, &t.expr, 1, &tape, NULL), DEA_OK);
        dea_tape_run(&tape, symbol + 1.0, node - 1.0); /* what a run leaves behind must not show in the next */
        dea_tape_run(&tape, symbol, node);
        assert_near(dea_tape_value(&tape, 0), (double)t.dual.value, 1e-13 * (double)t.dual.most);
        assert_near(dea_tape_slope(&tape, 0), (double)t.dual.slope, 1e-13 * (double)t.dual.most_slope);
        dea_tape_run_values(&tape, symbol, node);
        assert_near(dea_tape_value(&tape, 0), (double)t.dual.value, 1e-13 * (double)t.dual.most);
        double *values = calloc((size_t)pool.count, sizeof *values);
        assert_non_null(values);
        dea_pool_values_at(&pool, &(dea_point_values){&symbol, &node, 1, 1}, values);
        assert_near(values[t.expr], (double)t.dual.value, 1e-13 * (double)t.dual.most);
        free(values);
        dea_tape_free(&tape);
        dea_pool_free(&pool);
    }
}

static void expressions_fold_and_share(void **state)
{
    (void)state;
    dea_pool pool = {0};
    const dea_expr zero = dea_expr_number(&pool, 0.0);
    const dea_expr one = dea_expr_number(&pool, 1.0);
    const dea_expr x = dea_expr_node(&pool, 0);
    const dea_expr y = dea_expr_symbol(&pool, 0);
    assert_relative(dea_expr_constant(&pool, dea_expr_div(&pool, dea_expr_number(&pool, 1.0), dea_expr_number(&pool, 3.0))),
                    1.0 / 3.0, 0.0);
    assert_true(isnan(dea_expr_constant(&pool, x)));
    assert_int_equal(dea_expr_add(&pool, x, y), dea_expr_add(&pool, x, y));
    assert_int_equal(dea_expr_add(&pool, x, zero), x);
    assert_int_equal(dea_expr_add(&pool, zero, x), x);
    assert_int_equal(dea_expr_sub(&pool, x, zero), x);
    assert_int_equal(dea_expr_mul(&pool, one, x), x);
    assert_int_equal(dea_expr_mul(&pool, x, zero), zero);
    assert_int_equal(dea_expr_div(&pool, zero, x), zero);
    assert_int_equal(dea_expr_div(&pool, x, x), one);
    assert_int_equal(dea_expr_div(&pool, dea_expr_mul(&pool, x, y), y), x);
    assert_int_equal(dea_expr_mul(&pool, dea_expr_div(&pool, x, y), y), x);
    assert_int_equal(dea_expr_neg(&pool, dea_expr_neg(&pool, x)), x);
    assert_int_equal(pool.exhausted, false);
    dea_pool_free(&pool);
}

static void exhausted_pool_is_safe_and_told(void **state)
{
    (void)state;
    dea_pool pool = {0};
    dea_error error = {0};
    dea_tape tape;
    const dea_expr x = dea_expr_node(&pool, 0);
    pool.exhausted = true;
    const dea_expr sum = dea_expr_add(&pool, dea_expr_div(&pool, x, dea_expr_square(&pool, x)), dea_expr_neg(&pool, x));
    assert_true(isnan(dea_expr_constant(&pool, sum)));
    assert_int_equal(dea_tape_compile(&pool, &sum, 1, &tape, &error), DEA_ERROR_MEMORY);
    assert_true(error.message[0] != '\0');
    pool.exhausted = false;
    dea_pool_free(&pool);
}

/* 3 u1 - u0 on a tape of one node has no value. */
static void index_of_a_node_or_symbol_out_of_range_is_refused(void **state)
{
    (void)state;
    dea_pool pool = {0};
    dea_error error = {0};
    dea_tape tape;
    const dea_expr nodes = dea_expr_sub(&pool, dea_expr_scale(&pool, 3.0, dea_expr_node(&pool, 1)), dea_expr_node(&pool, 0));
    const dea_expr symbols = dea_expr_mul(&pool, dea_expr_symbol(&pool, 2), dea_expr_node(&pool, 0));
    const dea_expr both[] = {nodes, symbols};
    const dea_expr below = dea_expr_add(&pool, dea_expr_node(&pool, -1), dea_expr_node(&pool, 0));
    assert_int_equal(dea_tape_compile(&pool, &nodes, 1, &tape, &error), DEA_ERROR_USAGE);
    assert_non_null(strstr(error.message, "node number 1"));
    assert_int_equal(dea_tape_compile(&pool, &symbols, 1, &tape, &error), DEA_ERROR_USAGE);
    assert_non_null(strstr(error.message, "symbol number 2"));
    assert_int_equal(dea_tape_compile_many(&pool, both, 2, 2, 2, &tape, &error), DEA_ERROR_USAGE);
    assert_int_equal(dea_tape_compile_many(&pool, both, 2, 3, 1, &tape, &error), DEA_ERROR_USAGE);
    assert_int_equal(dea_tape_compile_many(&pool, &below, 1, 3, 2, &tape, &error), DEA_ERROR_USAGE);
    assert_null(tape.terms);
    assert_int_equal(dea_tape_compile_many(&pool, both, 2, 3, 2, &tape, &error), DEA_OK);
    const double at[] = {5.0, 7.0}, parameters[] = {11.0, 13.0, 17.0};
    for (int node = 0; node < 2; node++) {
        const double along[] = {node == 0, node == 1};
        dea_tape_along(&tape, parameters, at, NULL, along);
        assert_relative(dea_tape_value(&tape, 0), 16.0, 0.0);
        assert_relative(dea_tape_slope(&tape, 0), node == 0 ? -1.0 : 3.0, 0.0);
        assert_relative(dea_tape_slope(&tape, 1), node == 0 ? 17.0 : 0.0, 0.0);
    }
    dea_tape_free(&tape);
    double values[16];
    assert_true(pool.count <= 16);
    dea_pool_values_at(&pool, &(dea_point_values){parameters, at, 1, 1}, values);
    assert_true(isnan(values[nodes]) && isnan(values[symbols]));
    dea_pool_free(&pool);
}

/* A random expression of every operation over several nodes and symbols; `count` is how often it may branch. */
enum { MANY_NODES = 5, MANY_SYMBOLS = 3 };

/* Slopes of the first output over all nodes. */
static void gradient_of(dea_tape *tape, const double *symbols, const double *nodes, double gradient[MANY_NODES])
{
    for (int k = 0; k < MANY_NODES; k++) {
        double along[MANY_NODES] = {0.0};
        along[k] = 1.0;
        dea_tape_along(tape, symbols, nodes, NULL, along);
        gradient[k] = dea_tape_slope(tape, 0);
    }
}

static dea_expr bounded(dea_pool *pool, dea_expr a)
{
    const dea_expr one = dea_expr_number(pool, 1.0);
    return dea_expr_div(pool, a, dea_expr_add(pool, one, dea_expr_square(pool, a))); /* -1/2 ... 1/2 */
}

static dea_expr random_expression(dea_pool *pool, uint64_t *seed, int depth)
{
    if (depth == 0) {
        const double pick = random_unit(seed);
        return pick < 0.5   ? dea_expr_node(pool, (int)(MANY_NODES * random_unit(seed)))
               : pick < 0.8 ? dea_expr_symbol(pool, (int)(MANY_SYMBOLS * random_unit(seed)))
                            : dea_expr_number(pool, random_between(seed, 0.3, 2.0));
    }
    const dea_expr a = random_expression(pool, seed, depth - 1);
    const dea_expr b = random_expression(pool, seed, depth - 1);
    const dea_expr above = dea_expr_add(pool, dea_expr_number(pool, 1.0), bounded(pool, a)); /* 1/2 ... 3/2 */
    const dea_operation operation = DEA_ADD + (dea_operation)((DEA_OPERATIONS - DEA_ADD) * random_unit(seed));
    const bool plain = operation == DEA_ADD || operation == DEA_SUB || operation == DEA_MUL;
    const bool small = operation == DEA_LOG1P || operation == DEA_EXPM1 || operation == DEA_EXP;
    const dea_expr left = plain ? a : small ? bounded(pool, a) : above;
    const dea_expr right = operation == DEA_DIV ? dea_expr_add(pool, dea_expr_number(pool, 2.0), bounded(pool, b)) : b;
    return dea_expr_apply(pool, operation, left, dea_operation_of(operation)->operands == 2 ? bounded(pool, right) : left);
}

/* Directions, derivatives as expressions, and a symmetric difference are one thing. */
static void derivatives_over_many_nodes_and_symbols_agree(void **state)
{
    (void)state;
    uint64_t seed = 5;
    for (int i = 0; i < 400; i++) {
        dea_pool pool = {0};
        dea_tape tape;
        double nodes[MANY_NODES], symbols[MANY_SYMBOLS], along[MANY_NODES], over[MANY_SYMBOLS],
            moved[2][MANY_NODES + MANY_SYMBOLS];
        const double h = 1e-5;
        (void)dea_expr_number(&pool, 0.0);
        dea_expr refs[1 + MANY_NODES] = {random_expression(&pool, &seed, 5)};
        for (int k = 0; k < MANY_NODES; k++) {
            refs[1 + k] = dea_expr_derivative(&pool, refs[0], DEA_NODE, k);
            nodes[k] = random_between(&seed, -1.0, 1.0);
            along[k] = random_between(&seed, -1.0, 1.0);
            moved[0][k] = nodes[k] - h * along[k];
            moved[1][k] = nodes[k] + h * along[k];
        }
        for (int k = 0; k < MANY_SYMBOLS; k++) {
            symbols[k] = random_between(&seed, 0.3, 2.0);
            over[k] = random_between(&seed, -1.0, 1.0);
            moved[0][MANY_NODES + k] = symbols[k] - h * over[k];
            moved[1][MANY_NODES + k] = symbols[k] + h * over[k];
        }
        assert_int_equal(dea_tape_compile_many(&pool, refs, 1 + MANY_NODES, MANY_SYMBOLS, MANY_NODES, &tape, NULL), DEA_OK);
        dea_tape_values(&tape, moved[0] + MANY_NODES, moved[0]);
        const double before = dea_tape_value(&tape, 0);
        dea_tape_values(&tape, moved[1] + MANY_NODES, moved[1]);
        const double difference = (dea_tape_value(&tape, 0) - before) / (2.0 * h);
        dea_tape_along(&tape, symbols, nodes, over, along);
        const double value = dea_tape_value(&tape, 0), slope = dea_tape_slope(&tape, 0);
        dea_tape_along(&tape, symbols, nodes, NULL, along);
        const double by_nodes = dea_tape_slope(&tape, 0);
        double gradient[MANY_NODES], sum = 0.0, most = 0.0;
        gradient_of(&tape, symbols, nodes, gradient);
        for (int k = 0; k < MANY_NODES; k++) {
            const double own = gradient[k];
            sum += own * along[k];
            most += fabs(own);
            assert_near(own, dea_tape_value(&tape, 1 + k), 1e-11 * (1.0 + fabs(own)));
        }
        assert_relative(dea_tape_value(&tape, 0), value, 0.0);
        assert_near(sum, by_nodes, 1e-12 * (1.0 + most));
        assert_near(difference, slope, 1e-6 * (1.0 + most + fabs(slope)));
        dea_tape_free(&tape);
        dea_pool_free(&pool);
    }
}

/* In long double, from the rest at which all nodes are 0: what the change of an expression is. */
static long double exactly(const dea_pool *pool, dea_expr ref, const double *symbols, const double *nodes, long double size)
{
    const dea_term *term = &pool->terms[ref];
    const long double x = term->operation >= DEA_ADD ? exactly(pool, term->a, symbols, nodes, size) : 0.0L;
    const long double y = term->operation >= DEA_ADD ? exactly(pool, term->b, symbols, nodes, size) : 0.0L;
    switch (term->operation) {
    case DEA_NUMBER:
        return term->number;
    case DEA_SYMBOL:
        return symbols[term->a];
    case DEA_NODE:
        return size * nodes[term->a];
    case DEA_ADD:
        return x + y;
    case DEA_SUB:
        return x - y;
    case DEA_MUL:
        return x * y;
    case DEA_DIV:
        return x / y;
    case DEA_LN:
        return logl(x);
    case DEA_EXP:
        return expl(x);
    case DEA_SQRT:
        return sqrtl(x);
    case DEA_LOG1P:
        return log1pl(x);
    case DEA_EXPM1:
        return expm1l(x);
    case DEA_POW:
        return powl(x, y);
    default:
        return x;
    }
}

/* The change of any expression: to first order the slope at rest times the way, which is all of it but 1e-13 at nodes of 1e-13;
 * and at nodes of size 1 the plain difference. */
static void change_keeps_its_digits_however_small_it_is(void **state)
{
    (void)state;
    uint64_t seed = 17;
    for (int i = 0; i < 300; i++) {
        dea_pool pool = {0};
        dea_tape tape;
        double nodes[MANY_NODES], symbols[MANY_SYMBOLS], rest[MANY_NODES] = {0.0};
        (void)dea_expr_number(&pool, 0.0);
        const dea_expr ref = random_expression(&pool, &seed, 4);
        const dea_expr refs[] = {ref, dea_expr_change(&pool, ref), dea_expr_at_rest(&pool, ref)};
        for (int k = 0; k < MANY_NODES; k++) {
            nodes[k] = random_between(&seed, -1.0, 1.0);
        }
        for (int k = 0; k < MANY_SYMBOLS; k++) {
            symbols[k] = random_between(&seed, 0.3, 2.0);
        }
        assert_int_equal(dea_tape_compile_many(&pool, refs, 3, MANY_SYMBOLS, MANY_NODES, &tape, NULL), DEA_OK);
        dea_tape_values(&tape, symbols, rest);
        assert_relative(dea_tape_value(&tape, 1), 0.0, 0.0);
        assert_near(dea_tape_value(&tape, 2), dea_tape_value(&tape, 0), 1e-14 * (1.0 + fabs(dea_tape_value(&tape, 0))));
        double gradient[MANY_NODES], most = 0.0, first = 0.0;
        gradient_of(&tape, symbols, rest, gradient);
        for (int k = 0; k < MANY_NODES; k++) {
            most += fabs(gradient[k]);
            first += gradient[k] * nodes[k];
        }
        for (double size = 1.0; size > 1e-14; size *= 1e-4) {
            double small[MANY_NODES];
            for (int k = 0; k < MANY_NODES; k++) {
                small[k] = size * nodes[k];
            }
            const long double truth = exactly(&pool, ref, symbols, nodes, size) - exactly(&pool, ref, symbols, nodes, 0.0L);
            dea_tape_values(&tape, symbols, small);
            const double lost = (size == 1.0 ? 1e-13 : 1e-18) * (1.0 + fabs(dea_tape_value(&tape, 0)));
            assert_near(dea_tape_value(&tape, 1), (double)truth, 1e-12 * size * (1.0 + most) + lost);
            if (size < 1e-11) { /* below what the truth can tell: first order */
                assert_near(dea_tape_value(&tape, 1), size * first, 1e-11 * size * (1.0 + most));
            }
        }
        dea_tape_free(&tape);
        dea_pool_free(&pool);
    }
}

static dea_network network_of(const dea_scene *scene, const char *model, const dea_axis *axis)
{
    dea_network network;
    dea_error error = {0};
    if (dea_network_build(scene, dea_model_find(model), axis, &network, &error) != DEA_OK) {
        fail_msg("%s", error.message);
    }
    return network;
}

static dea_balance balance_of(dea_network *network)
{
    dea_balance balance;
    assert_int_equal(dea_balance_open(network, &balance, NULL), DEA_OK);
    return balance;
}

static const char *const network_models[] = {"constant_force", "lumped", "coverage", "lame"};
enum { NETWORK_MODELS = 4 };

static bool can_do(const char *model, const dea_scene *scene)
{
    return scene->actuator.kind == DEA_DOT || dea_model_find(model)->lens;
}

static double divide_radius_of(const dea_scene *scene)
{
    const dea_actuator *a = &scene->actuator;
    return isnan(a->divide_radius) ? a->coverage * a->frame_radius : a->divide_radius;
}

/* The swept scalar as a symbol gives the forces of the same scalar as a number. */
static void swept_scalar_enters_as_its_number_would(void **state)
{
    (void)state;
    uint64_t seed = 7;
    for (int i = 0; i < 40 * SWEPT_FIELDS; i++) {
        dea_scene scene = random_scene(&seed);
        const char *model = network_models[i % NETWORK_MODELS];
        scene.drive.voltage = 1000.0;
        dea_axis axis;
        double *field = swept_field(&scene, i / 40);
        double value = *field;
        add_axis(&scene, &axis, field, &value, 1);
        if (!can_do(model, &scene)) {
            continue;
        }
        dea_network swept = network_of(&scene, model, &axis);
        dea_network fixed = network_of(&scene, model, NULL);
        dea_balance of_swept = balance_of(&swept);
        dea_balance of_fixed = balance_of(&fixed);
        const double u = swept.sign * 0.02 * divide_radius_of(&scene);
        const dea_forces f = dea_balance_forces(&of_swept, value, u);
        const dea_forces g = dea_balance_forces(&of_fixed, (double)NAN, u);
        assert_near(f.elastic, g.elastic, 1e-11 * fabs(g.elastic_slope * u));
        assert_near(f.elastic_slope, g.elastic_slope, 1e-10 * fabs(g.elastic_slope));
        assert_relative(f.load, g.load, 1e-12);
        assert_near(f.load_slope, g.load_slope, 1e-11 * (fabs(g.load_slope) + fabs(g.load / u)));
        assert_true(g.elastic != 0.0 && g.load != 0.0);
        assert_int_equal(dea_balance_valid(&of_swept, value), dea_balance_valid(&of_fixed, (double)NAN));
        dea_balance_close(&of_swept);
        dea_balance_close(&of_fixed);
        dea_network_free(&swept);
        dea_network_free(&fixed);
    }
}

static double stiffness_of(const dea_network *network, const char *name)
{
    for (int i = 0; i < network->element_count; i++) {
        if (strcmp(network->elements[i].name, name) == 0) {
            return dea_expr_constant(&network->pool, network->elements[i].value);
        }
    }
    fail_msg("no element %s", name);
    return (double)NAN;
}

static void lumped_network_is_two_springs_and_a_source(void **state)
{
    (void)state;
    for (int kind = DEA_DOT; kind <= DEA_LENS; kind++) {
        const dea_scene scene = paper_scene((dea_kind)kind, 1.2, 0.3, 4500.0);
        dea_network network = network_of(&scene, "lumped", NULL);
        const double section = 2.0 * pi * 0.009 * 1e-4 / 1.44;
        assert_int_equal(network.element_count, 3);
        assert_relative(stiffness_of(&network, "n_a"), 1391085.27 * section / 0.009, 1e-8);
        assert_relative(stiffness_of(&network, "n_p"), 1391085.27 * section / 0.021, 1e-8);
        const double field = 4500.0 * 1.44 / 1e-4;
        const double force = 2.8 * DEA_EPSILON_0 * field * field * section;
        assert_relative(stiffness_of(&network, "f_dea"), kind == DEA_DOT ? force : -force, 1e-13);
        dea_network_free(&network);
    }
}

/* 1/n_disc = 2 pi H (a + b), 1/n_annulus = 2 pi H (a (1 + B^2)/(1 - B^2) - b); the printed moduli at 1.2. */
static void lame_network_has_the_two_stiffnesses_of_plane_elasticity(void **state)
{
    (void)state;
    for (double b = 0.1; b < 0.95; b += 0.2) {
        const dea_scene scene = paper_scene(DEA_DOT, 1.2, b, 4500.0);
        dea_network network = network_of(&scene, "lame", NULL);
        const double q = (1.0 + b * b) / (1.0 - b * b);
        assert_relative(stiffness_of(&network, "n_disc"), 2.0 * pi * 1e-4 * (697321.54 + 228160.57), 2e-8);
        assert_relative(stiffness_of(&network, "n_annulus"), 2.0 * pi * 1e-4 * (697321.54 * q - 228160.57), 2e-8);
        dea_network_free(&network);
    }
}

/* 6 pi eps U^2 lambda_pre^2/H of a dot, -2 pi eps U^2 lambda_pre^2 (1 - 3 B^2)/((1 - B^2) H) of a lens: 1/2 U^2 of the second
 * derivative of the true capacitance at rest. */
static void softening_is_the_curvature_of_the_capacitance(void **state)
{
    (void)state;
    for (double b = 0.1; b < 0.95; b += 0.1) {
        const double scale = 2.8 * DEA_EPSILON_0 * pi * 1.44 * 4500.0 * 4500.0 / 1e-4;
        const dea_scene dot = paper_scene(DEA_DOT, 1.2, b, 4500.0);
        const dea_scene lens = paper_scene(DEA_LENS, 1.2, b, 4500.0);
        dea_network network = network_of(&dot, "lame", NULL);
        assert_relative(stiffness_of(&network, "n_el"), -6.0 * scale, 1e-12);
        dea_network_free(&network);
        network = network_of(&lens, "lame", NULL);
        assert_near(stiffness_of(&network, "n_el"), 2.0 * scale * (1.0 - 3.0 * b * b) / (1.0 - b * b), 1e-12 * scale / (1.0 - b));
        dea_network_free(&network);
    }
}

static void models_without_network_say_so(void **state)
{
    (void)state;
    const dea_scene scene = paper_scene(DEA_DOT, 1.2, 0.3, 4500.0);
    dea_network network;
    dea_error error = {0};
    assert_int_equal(dea_network_build(&scene, dea_model_find("field"), NULL, &network, &error), DEA_ERROR_UNSUPPORTED);
    assert_non_null(strstr(error.message, "field"));
    dea_network_free(&network);
}

/* The model's own answer balances the network, and the row made of it is the model's row. */
static void network_balances_at_the_answer_of_the_model(void **state)
{
    (void)state;
    uint64_t seed = 99;
    int accepted = 0;
    for (int i = 0; i < 800; i++) {
        dea_scene scene = random_scene(&seed);
        const char *model = network_models[i % NETWORK_MODELS];
        if (!can_do(model, &scene)) {
            continue;
        }
        scene.drive.voltage = 2.0 * random_unit(&seed) * pull_in_voltage(&scene, model);
        const dea_row wanted = solve_direct(&scene, model);
        dea_network network = network_of(&scene, model, NULL);
        dea_balance balance = balance_of(&network);
        dea_row row;
        double share, fold;
        if (wanted.state == DEA_STATE_PULL_IN) {
            const bool stiff = dea_balance_forces(&balance, 0.0, 0.0).elastic_slope > 0.0;
            assert_true(!stiff || dea_balance_folds(&balance, 0.0, &share, &fold));
        } else {
            assert_true(dea_balance_accept(&balance, 0.0, wanted.displacement, 1e-10, &row));
            assert_false(dea_balance_accept(&balance, 0.0, 1.001 * wanted.displacement, 1e-10, &row));
            assert_true(dea_balance_accept(&balance, 0.0, wanted.displacement, 1e-10, &row));
            assert_state(row, wanted.state);
            assert_relative(row.strain, wanted.strain, 1e-13);
            assert_relative(row.force, wanted.force, 1e-12);
            assert_relative(row.field, wanted.field, 1e-12);
            accepted++;
        }
        dea_balance_close(&balance);
        dea_network_free(&network);
    }
    assert_true(accepted > 200);
}

static void slope_of_the_forces_is_their_derivative(void **state)
{
    (void)state;
    for (size_t i = 0; i < NETWORK_MODELS; i++) {
        const dea_scene scene = paper_scene(DEA_DOT, 1.2, 0.4, 4500.0);
        dea_network network = network_of(&scene, network_models[i], NULL);
        dea_balance balance = balance_of(&network);
        const double u = 3e-4;
        const double h = 1e-7;
        const dea_forces at = dea_balance_forces(&balance, 0.0, u);
        const dea_forces above = dea_balance_forces(&balance, 0.0, u + h);
        const dea_forces below = dea_balance_forces(&balance, 0.0, u - h);
        assert_relative((above.elastic - below.elastic) / (2.0 * h), at.elastic_slope, 1e-7);
        assert_near((above.load - below.load) / (2.0 * h), at.load_slope, 1e-7 * at.elastic_slope);
        assert_relative(dea_forces_stiffness(&at), at.elastic_slope - at.elastic / at.load * at.load_slope, 1e-15);
        dea_balance_close(&balance);
        dea_network_free(&network);
    }
}

static dea_scene soft_scene(double voltage)
{
    dea_scene scene = paper_scene(DEA_DOT, 1.1, 0.05, voltage);
    scene.material.constants[0] = 40e3;
    scene.material.constants[1] = -8e3;
    scene.material.constants[2] = 1.2e3;
    return scene;
}

/* At 3 kV the load passes the fold; a second equilibrium lies behind it, which balances all forces and must still be refused. */
static void balance_behind_a_fold_is_refused(void **state)
{
    (void)state;
    const dea_scene scene = soft_scene(3000.0);
    const judged_balance judged = judged_balance_of(&scene, false);
    const judgement found = judge_balance(&judged, 100000);
    assert_true(isnan(found.strain) && found.later);
    dea_network network = network_of(&scene, "coverage", NULL);
    dea_balance balance = balance_of(&network);
    double share, fold;
    assert_true(dea_balance_folds(&balance, 0.0, &share, &fold));
    assert_near(share, found.fold, 1e-6);
    long double low = fold / divide_radius_of(&scene) * 1.5;
    long double high = 10.0L;
    assert_true(judged_share(&judged, low) < 1.0L && judged_share(&judged, high) > 1.0L);
    for (int i = 0; i < 100; i++) {
        const long double middle = 0.5L * (low + high);
        *(judged_share(&judged, middle) < 1.0L ? &low : &high) = middle;
    }
    const double u = (double)low * divide_radius_of(&scene);
    const dea_forces f = dea_balance_forces(&balance, 0.0, u);
    dea_row row;
    assert_relative(f.elastic, f.load, 1e-10);
    assert_false(dea_balance_accept(&balance, 0.0, u, 1e-6, &row));
    dea_balance_close(&balance);
    dea_network_free(&network);
}

static void fold_of_a_free_neo_hookean_film_is_where_theory_says(void **state)
{
    (void)state;
    dea_scene scene = paper_scene(DEA_DOT, 1.0, 0.5, 0.0);
    scene.material.constants[1] = scene.material.constants[2] = 0.0;
    const double critical = pow(4.0, 1.0 / 6.0);
    const double mu = 2.0 * scene.material.constants[0];
    const double least = mu * (pow(critical, -2.0) - pow(critical, -8.0)) / (2.8 * DEA_EPSILON_0);
    for (double over = 1.5; over > 1.0 + 1e-12; over = 1.0 + (over - 1.0) * 0.1) {
        scene.drive.voltage = 1e-4 * sqrt(over * least);
        dea_network network = network_of(&scene, "constant_force", NULL);
        dea_balance balance = balance_of(&network);
        double share, fold;
        assert_true(dea_balance_folds(&balance, 0.0, &share, &fold));
        assert_relative(share, 1.0 / over, 1e-13);
        assert_relative(1.0 + fold / 0.015, critical, 1e-7);
        dea_balance_close(&balance);
        dea_network_free(&network);
    }
    scene.drive.voltage = 1e-4 * sqrt((1.0 - 1e-12) * least);
    dea_network network = network_of(&scene, "constant_force", NULL);
    dea_balance balance = balance_of(&network);
    double share, fold;
    assert_false(dea_balance_folds(&balance, 0.0, &share, &fold));
    dea_balance_close(&balance);
    dea_network_free(&network);
}

static void network_out_of_range_is_not_valid(void **state)
{
    (void)state;
    static const double radii[] = {-0.01, 0.0, 0.01, 0.0299999, 0.03, 0.05, (double)NAN};
    double swept = 0.01;
    dea_scene scene = paper_scene(DEA_DOT, 1.2, (double)NAN, 4500.0);
    dea_axis axis;
    scene.actuator.divide_radius = 0.01;
    add_axis(&scene, &axis, &scene.actuator.divide_radius, &swept, 1);
    dea_network network = network_of(&scene, "lumped", &axis);
    dea_balance balance = balance_of(&network);
    for (size_t i = 0; i < sizeof radii / sizeof radii[0]; i++) {
        assert_int_equal(dea_balance_valid(&balance, radii[i]), radii[i] > 0.0 && radii[i] < 0.03);
    }
    dea_balance_close(&balance);
    dea_network_free(&network);
}

static bool is_name(int c)
{
    return isalnum(c) || c == '_';
}

/* What is wrong with one word of a B source, NULL: nothing. Numbers are integers below 1e6; parameters and nodes exist. */
static const char *fault_of_word(const char *at, size_t length, const char *netlist)
{
    char sought[80];
    if (isdigit((unsigned char)*at)) {
        return strspn(at, "0123456789") != length || length > 6 ? "a literal that is no small integer" : NULL;
    }
    if (at[-1] == '{') {
        snprintf(sought, sizeof sought, " %.*s=", (int)length, at);
        const char *given = strstr(netlist, sought);
        if (given && given[strlen(sought)] == '-' && !strchr("(,", at[-2])) {
            return "a negative parameter without brackets"; /* it is put in as text */
        }
        return given ? NULL : "an unknown parameter";
    }
    if (at[-1] == '(' && at[-2] == 'v') {
        snprintf(sought, sizeof sought, " %.*s 0 ", (int)length, at);
        return strstr(netlist, sought) ? NULL : "an unknown node";
    }
    const bool function = strncmp(at, "v(", 2) == 0 || strncmp(at, "min(", 4) == 0 || strncmp(at, "max(", 4) == 0 ||
                          strncmp(at, "pwl(", 4) == 0;
    const bool output = strncmp(at - 1, " v=", 3) == 0 || strncmp(at - 1, " i=", 3) == 0;
    return function || output ? NULL : "an unknown function";
}

static const char *fault_of_source(const char *card, const char *netlist)
{
    for (const char *at = strchr(card, '=') - 1; *at; at++) {
        if (is_name((unsigned char)*at) && !is_name((unsigned char)at[-1])) {
            const size_t length = strspn(at, "abcdefghijklmnopqrstuvwxyz0123456789_.");
            const char *fault = fault_of_word(at, length, netlist);
            if (fault) {
                return fault;
            }
            at += length - 1;
        }
    }
    return strpbrk(card, "^;$`\"'") || strstr(card, "**") || strstr(card, "//") ? "an operator that means different things"
                                                                                : NULL;
}

/* name=number pairs: plain numbers with plain exponents. */
static const char *fault_of_parameters(const char *card)
{
    const char *at = card + strlen(".param");
    while (*at == ' ') {
        at += strcspn(at, "=") + 1;
        char *end;
        (void)strtod(at, &end);
        if (end == at || strspn(at, "0123456789.+-e") != (size_t)(end - at)) {
            return "not a plain number";
        }
        at = end;
    }
    return *at ? "not a list of numbers" : NULL;
}

static const char *fault_of_card(const char *card, const char *netlist)
{
    if (*card == '\0' || strchr(" \t+", *card)) {
        return "an empty, indented or continued card";
    }
    for (const char *at = card; *at; at++) {
        if (!isprint((unsigned char)*at)) {
            return "a character that is not plain";
        }
    }
    if (*card == 'B') {
        return fault_of_source(card, netlist);
    }
    if (strncmp(card, ".param", 6) == 0) {
        return fault_of_parameters(card);
    }
    static const char *const cards[] = {"* ", "VINDEX k 0 0", ".nodeset ", ".options ", ".save v(edge)", ".dc VINDEX ", ".end"};
    for (size_t i = 0; i < sizeof cards / sizeof cards[0]; i++) {
        if (strncmp(card, cards[i], strlen(cards[i])) == 0) {
            return NULL;
        }
    }
    return "a card that none of our netlists needs";
}

static void check_netlist(const char *netlist)
{
    char *copy = strdup(netlist);
    char *rest = copy;
    assert_non_null(copy);
    const size_t length = strlen(netlist);
    assert_int_equal(strncmp(netlist, "* ", 2), 0);
    assert_string_equal(netlist + length - 6, "\n.end\n");
    copy[length - 1] = '\0';
    for (char *card = strsep(&rest, "\n"); card; card = strsep(&rest, "\n")) {
        const char *fault = fault_of_card(card, netlist);
        if (fault) {
            fail_msg("%s: %.300s", fault, card);
        }
    }
    free(copy);
}

static void judge_of_netlists_finds_what_it_forbids(void **state)
{
    (void)state;
    static const char *const netlist = " p1=1.5\n p4=-1.5\nBX3 x3 0 \nBSPRING edge 0 \n";
    assert_null(fault_of_card("BX3 x3 0 v={p1}*v(edge)-3*v(x3)", netlist));
    assert_null(fault_of_card(".param p1=1.5e-300 p2=-3", netlist));
    static const char *const bad[] = {"BX3 x3 0 v=1.5*v(edge)",
                                      "BX3 x3 0 v=1-{p4}",
                                      "BX3 x3 0 v={p2}",
                                      "BX3 x3 0 v=v(x4)",
                                      "BX3 x3 0 v=v(edge)^2",
                                      "BX3 x3 0 v=log(v(edge))",
                                      "BX3 x3 0 v=1e5",
                                      "BX3 x3 0 v=v(edge)**2",
                                      " v1 a 0 1",
                                      "",
                                      "bx3 x3 0 v=1",
                                      ".param p1=1k",
                                      ".param p1=1,5",
                                      ".control",
                                      "r1 a 0 1",
                                      ".include x"};
    for (size_t i = 0; i < sizeof bad / sizeof bad[0]; i++) {
        assert_non_null(fault_of_card(bad[i], netlist));
    }
}

static char *netlist_of(const dea_netlist_study *study)
{
    char *text = NULL;
    assert_int_equal(dea_netlist_write(study, &text, NULL), DEA_OK);
    assert_non_null(text);
    return text;
}

static void netlist_of_any_line_is_plain_and_complete(void **state)
{
    (void)state;
    uint64_t seed = 4711;
    double values[40];
    static char title[] = "secret of the title\n.control\nshell true\n.endc";
    for (int i = 0; i < 30 * SWEPT_FIELDS; i++) {
        dea_scene scene = random_scene(&seed);
        const char *model = network_models[i % NETWORK_MODELS];
        if (!can_do(model, &scene)) {
            continue;
        }
        scene.title = title;
        snprintf(scene.material.name, sizeof scene.material.name, "secret of the material");
        scene.drive.voltage = 1234.5;
        dea_axis axis;
        double *field = swept_field(&scene, i / 30);
        for (int k = 0; k < 40; k++) {
            values[k] = *field * (0.5 + 0.01 * k);
        }
        add_axis(&scene, &axis, field, values, 40);
        axis.uniform = i % 3 == 0;
        const bool ramp = i % 5 == 0;
        const size_t count = i % 7 == 0 ? 1 : 30;
        const dea_netlist_study study = {.scene = &scene,
                                         .model = dea_model_find(model),
                                         .axis = ramp ? NULL : &axis,
                                         .from = 5,
                                         .count = count,
                                         .ramp = ramp ? 50 : 0,
                                         .force_scale = 1e-3,
                                         .length_scale = 1e-2};
        char *text = netlist_of(&study);
        assert_null(strstr(text, "secret"));
        assert_null(strstr(text, ".control"));
        check_netlist(text);
        free(text);
    }
}

/* Every element of the network and its unit can be read in the netlist. */
static void netlist_names_its_elements(void **state)
{
    (void)state;
    const dea_scene scene = paper_scene(DEA_DOT, 1.2, 0.4, 4500.0);
    for (size_t i = 0; i < NETWORK_MODELS; i++) {
        dea_network network = network_of(&scene, network_models[i], NULL);
        const dea_netlist_study study = {
            .scene = &scene, .model = dea_model_find(network_models[i]), .count = 1, .force_scale = 1.0, .length_scale = 1.0};
        char *text = netlist_of(&study);
        for (int k = 0; k < network.element_count; k++) {
            char line[512];
            snprintf(line, sizeof line, "\n* %s: %s\n", network.elements[k].name, network.elements[k].meaning);
            assert_non_null(strstr(text, line));
        }
        free(text);
        dea_network_free(&network);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(tape_gives_value_and_exact_slope_of_any_expression),
        cmocka_unit_test(expressions_fold_and_share),
        cmocka_unit_test(exhausted_pool_is_safe_and_told),
        cmocka_unit_test(index_of_a_node_or_symbol_out_of_range_is_refused),
        cmocka_unit_test(derivatives_over_many_nodes_and_symbols_agree),
        cmocka_unit_test(change_keeps_its_digits_however_small_it_is),
        cmocka_unit_test(swept_scalar_enters_as_its_number_would),
        cmocka_unit_test(lumped_network_is_two_springs_and_a_source),
        cmocka_unit_test(lame_network_has_the_two_stiffnesses_of_plane_elasticity),
        cmocka_unit_test(softening_is_the_curvature_of_the_capacitance),
        cmocka_unit_test(models_without_network_say_so),
        cmocka_unit_test(network_balances_at_the_answer_of_the_model),
        cmocka_unit_test(slope_of_the_forces_is_their_derivative),
        cmocka_unit_test(balance_behind_a_fold_is_refused),
        cmocka_unit_test(fold_of_a_free_neo_hookean_film_is_where_theory_says),
        cmocka_unit_test(network_out_of_range_is_not_valid),
        cmocka_unit_test(judge_of_netlists_finds_what_it_forbids),
        cmocka_unit_test(netlist_of_any_line_is_plain_and_complete),
        cmocka_unit_test(netlist_names_its_elements),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
