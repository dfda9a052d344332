/* Modes of small motion: frequencies, damping ratios and shares against roots and systems that the code does not use. */
#include "scenes.h"

#include <complex.h>
#include <stdlib.h>

#include "network/membrane.h"
#include "support/lapack.h"

enum { MOST = DEA_MODES_MOST };

/* A scene of modes about a bias: the paper's film with its mass. */
static dea_scene modes_scene(dea_kind kind, double prestretch, double coverage, double bias, size_t count)
{
    dea_scene scene = paper_scene(kind, prestretch, coverage, (double)NAN);
    scene.material.density = 1080.0;
    scene.study = DEA_STUDY_MODES;
    scene.modes = (dea_modes_study){.count = count, .bias = bias};
    return scene;
}

/* Solves a point of any layout by `direct`; the caller frees it. */
static void *solve_point(const dea_scene *scene, const char *model, const dea_layout *layout)
{
    dea_error error = {0};
    void *point = calloc(1, layout->point_size);
    assert_non_null(point);
    const dea_engine *direct = dea_engine_find("direct");
    assert_null(dea_engine_refuses(direct, scene, dea_model_find(model)));
    assert_int_equal(direct->solves[scene->study](NULL, scene, dea_model_find(model), layout, point, &error), DEA_OK);
    return point;
}

static void solve_modes(const dea_scene *scene, const char *model, dea_mode modes[MOST])
{
    const dea_layout layout = dea_layout_of(scene);
    void *point = solve_point(scene, model, &layout);
    memcpy(modes, point, scene->modes.count * sizeof *modes);
    free(point);
}

static void frequencies_are_those_of_the_table(void **state)
{
    (void)state;
    static const struct {
        dea_kind kind;
        double prestretch, coverage, still[3], biased[3];
    } table[] = {
        {DEA_DOT, 1.1, 0.50, {661.974, 1212.028, 1757.59}, {629.520, 1177.549, 1698.65}},
        {DEA_DOT, 1.2, 0.25, {619.836, 1134.877, 1645.71}, {587.717, 1088.681, 1612.00}},
        {DEA_DOT, 1.3, 0.75, {622.721, 1140.159, 1653.37}, {596.617, 1075.283, 1553.98}},
        {DEA_LENS, 1.2, 0.50, {619.836, 1134.877, 1645.71}, {628.647, 1108.445, 1635.81}},
    };
    for (size_t i = 0; i < sizeof table / sizeof *table; i++) {
        for (int biased = 0; biased < 2; biased++) {
            const double *wanted = biased ? table[i].biased : table[i].still;
            dea_mode modes[MOST];
            const dea_scene scene = modes_scene(table[i].kind, table[i].prestretch, table[i].coverage, biased ? 4500.0 : 0.0, 3);
            solve_modes(&scene, "field", modes);
            for (int k = 0; k < 3; k++) {
                assert_true(fabs(modes[k].frequency - wanted[k]) <= (k < 2 ? 5.1e-4 : 5.1e-3));
                assert_true(modes[k].frequency == modes[k].undamped && modes[k].damping_ratio == 0.0);
                assert_int_equal(modes[k].state, DEA_STATE_OK);
            }
        }
    }
}

/* Zeros of J_1: modes of a clamped film without voltage, f = j lambda_pre/(2 pi r) sqrt(W11/rho), whatever the coverage. */
static const double bessel[] = {3.8317059702075123, 7.0155866698156188, 10.173468135062722, 13.323691936314223,
                                16.470630050877633, 19.615858510468242};

static double free_frequency(const dea_scene *scene, size_t mode)
{
    dea_film film;
    dea_film_prepare(scene, &film);
    return bessel[mode] * film.prestretch / (2.0 * DEA_PI * scene->actuator.frame_radius) * sqrt(film.w11 / scene->material.density);
}

static void a_film_without_voltage_has_the_roots_of_bessel(void **state)
{
    (void)state;
    static const double coverages[] = {0.02, 0.05, 0.1, 0.5, 0.9, 0.98, 0.999};
    for (size_t i = 0; i < sizeof coverages / sizeof *coverages; i++) {
        dea_mode modes[MOST];
        const size_t count = coverages[i] < 0.1 ? 3 : 6; /* about a small disc there are not nodes enough for more */
        dea_scene scene = modes_scene(i % 2 ? DEA_LENS : DEA_DOT, 1.2, coverages[i], 0.0, count);
        scene.accuracy = 1e-7;
        solve_modes(&scene, "field", modes);
        for (size_t k = 0; k < count; k++) {
            assert_int_equal(modes[k].state, DEA_STATE_OK);
            assert_true(fabs(modes[k].frequency / free_frequency(&scene, k) - 1.0) <= 1e-7);
        }
    }
}

/* At 0 V the film is uniform: s^2 + w^2 [1 + (tau_KV s + sum c s tau/(1 + s tau)) v/W11] = 0 for each mode, v = W11 + P/lambda. */
static void losses_of_a_uniform_film_solve_its_own_equation(void **state)
{
    (void)state;
    dea_scene scene = modes_scene(DEA_DOT, 1.3, 0.4, 0.0, 4);
    scene.material.retardation = 3e-5;
    scene.material.prony_count = 2;
    scene.material.prony[0] = (dea_prony){.g = 0.2, .tau = 2e-4};
    scene.material.prony[1] = (dea_prony){.g = 0.1, .tau = 1e-2};
    dea_mode modes[MOST];
    solve_modes(&scene, "field", modes);
    dea_film film;
    dea_film_prepare(&scene, &film);
    const double share = 1.0 + film.tension / (film.prestretch * film.w11), rest = 0.7;
    for (size_t k = 0; k < 4; k++) {
        const double w = 2.0 * DEA_PI * free_frequency(&scene, k), damped = 2.0 * DEA_PI * modes[k].frequency;
        const double size = damped / sqrt(1.0 - modes[k].damping_ratio * modes[k].damping_ratio);
        const double complex s = -modes[k].damping_ratio * size + I * damped;
        double complex loss = 3e-5 * s;
        for (size_t i = 0; i < 2; i++) {
            loss += scene.material.prony[i].g / rest * s * scene.material.prony[i].tau / (1.0 + s * scene.material.prony[i].tau);
        }
        assert_true(modes[k].damping_ratio > 0.01 && modes[k].frequency > modes[k].undamped);
        assert_true(cabs(s * s + w * w * (1.0 + loss * share)) <= 3e-6 * w * w);
    }
}

/* The film under a bias as a system of first order on its nodes, u' = v, v' = -M^-1 [K u + tau V v + c V (u - y) + 2 U phi dU],
 * y' = (u - y)/tau_b, dU = (q - 2 U phi u)/C, q' = -dU (1/R_s + 1/R_p), by all its eigenvalues. */
static size_t first_order(const dea_scene *scene, double voltage, double *real, double *imaginary)
{
    static double k[DEA_RINGS_NODES * DEA_RINGS_NODES], v[DEA_RINGS_NODES * DEA_RINGS_NODES];
    dea_membrane m;
    dea_membrane_look look;
    double u[DEA_RINGS_NODES], push[DEA_RINGS_NODES];
    assert_int_equal(dea_membrane_open(scene, dea_model_find("field"), (dea_rings_mesh){10, 12, false}, &m, NULL), DEA_OK);
    assert_true(dea_membrane_still(&m, voltage, u) && dea_membrane_look_at(&m, u, &look));
    dea_membrane_stiffness(&m, &look, voltage, NULL, 0.0, k);
    dea_membrane_stiffness(&m, &look, voltage, NULL, 1.0, v);
    dea_membrane_push(&m, &look, push);
    const size_t n = m.rings.node_count, all = 3 * n + 1;
    const double c = m.film.branches[0].share, tau = m.film.branches[0].tau, retardation = m.film.retardation;
    double *a = calloc(all * all, sizeof *a);
    assert_non_null(a);
    for (size_t j = 0; j < n; j++) {
        a[(n + j) * all + j] = 1.0;
        a[j * all + 2 * n + j] = 1.0 / tau;
        a[(2 * n + j) * all + 2 * n + j] = -1.0 / tau;
        for (size_t i = 0; i < n; i++) {
            const double viscous = v[j * n + i] - k[j * n + i], charge = 4.0 * voltage * voltage / look.capacitance * push[i] * push[j];
            a[j * all + n + i] = -(k[j * n + i] + c * viscous + charge) / m.masses[i];
            a[(n + j) * all + n + i] = -retardation * viscous / m.masses[i];
            a[(2 * n + j) * all + n + i] = c * viscous / m.masses[i];
        }
        a[3 * n * all + n + j] = 2.0 * voltage * push[j] / look.capacitance / m.masses[j];
        const double rate = (1.0 / m.film.series + m.film.conductance) / look.capacitance;
        a[j * all + 3 * n] = 2.0 * voltage * push[j] * rate;
        a[3 * n * all + 3 * n] = -rate;
    }
    assert_int_equal(dea_lapacke_dgeev(LAPACK_COL_MAJOR, 'N', 'N', (lapack_int)all, a, (lapack_int)all, real, imaginary, NULL, 1, NULL, 1), 0);
    free(a);
    return all;
}

static void losses_under_a_bias_are_eigenvalues_of_the_whole_system(void **state)
{
    (void)state;
    for (int kind = DEA_DOT; kind <= DEA_LENS; kind++) {
        dea_scene scene = modes_scene((dea_kind)kind, 1.2, 0.5, 4500.0, 3);
        scene.material.retardation = 2e-5;
        scene.material.prony_count = 1;
        scene.material.prony[0] = (dea_prony){.g = 0.3, .tau = 1e-4};
        scene.drive.series_resistance = 1e6;
        scene.drive.leakage_resistance = 1e8;
        dea_mode modes[MOST];
        static double real[3 * DEA_RINGS_NODES + 1], imaginary[3 * DEA_RINGS_NODES + 1];
        solve_modes(&scene, "field", modes);
        const size_t count = first_order(&scene, 4500.0 / 1.01, real, imaginary);
        for (size_t k = 0; k < 3; k++) {
            const double damped = 2.0 * DEA_PI * modes[k].frequency, ratio = modes[k].damping_ratio;
            const double complex s = (-ratio / sqrt(1.0 - ratio * ratio) + I) * damped;
            double nearest = INFINITY;
            for (size_t i = 0; i < count; i++) {
                nearest = fmin(nearest, cabs(s - (real[i] + I * imaginary[i])));
            }
            assert_true(ratio > 0.02 && nearest <= 1e-5 * cabs(s));
        }
    }
}

/* Near a resonance of a film without losses u/U goes as share u_0/U (1 - (f/f_k)^2)^-1, by the equation along the radius. */
static void the_share_of_a_mode_is_the_residue_of_the_response(void **state)
{
    (void)state;
    for (int kind = DEA_DOT; kind <= DEA_LENS; kind++) {
        dea_mode modes[MOST];
        dea_scene scene = modes_scene((dea_kind)kind, 1.2, 0.3, 3000.0, 3);
        scene.accuracy = 1e-9;
        solve_modes(&scene, "field", modes);
        for (int k = 0; k < 3; k++) {
            const double near = 1e-5;
            dea_response still, rows[2];
            scene.study = DEA_STUDY_AC;
            for (int side = 0; side < 2; side++) {
                const double f = modes[k].frequency * (side ? 1.0 + near : 1.0 - near);
                scene.ac = (dea_ac){.from = f, .to = f, .points_per_decade = 1, .bias = 3000.0};
                assert_int_equal(dea_engine_find("direct")->ac(NULL, &scene, dea_model_find("field"), &rows[side], NULL, NULL), DEA_OK);
            }
            scene.ac.from = scene.ac.to = 1e-3;
            assert_int_equal(dea_engine_find("direct")->ac(NULL, &scene, dea_model_find("field"), &still, NULL, NULL), DEA_OK);
            scene.study = DEA_STUDY_MODES;
            /* the difference of both sides, which have opposite signs: the other modes cancel */
            const double pole = rows[0].displacement + rows[1].displacement;
            const double share = pole / still.displacement / (1.0 / (1.0 - (1.0 - near) * (1.0 - near)) + 1.0 / ((1.0 + near) * (1.0 + near) - 1.0));
            assert_true(fabs(share - fabs(modes[k].edge_share)) <= 1e-5);
        }
    }
}

static void shares_of_all_modes_are_the_whole(void **state)
{
    (void)state;
    dea_mode modes[MOST];
    double sum = 0.0;
    const dea_scene scene = modes_scene(DEA_DOT, 1.2, 0.5, 4500.0, MOST);
    solve_modes(&scene, "field", modes);
    for (size_t k = 0; k < MOST; k++) {
        assert_int_equal(modes[k].state, DEA_STATE_OK);
        assert_true(k == 0 || modes[k].frequency > modes[k - 1].frequency);
        sum += modes[k].edge_share;
    }
    assert_true(sum > 0.95 && sum < 1.0);
}

/* int 2 pi rho H phi_j phi_k R dR = 1 where j = k, else 0; phi at the edge gives the mass of the mode there. */
static void shapes_have_mass_one_and_none_in_common(void **state)
{
    (void)state;
    enum { POINTS = 2001 };
    dea_scene scene = modes_scene(DEA_DOT, 1.2, 0.5, 4500.0, 3);
    scene.modes.points = POINTS;
    const dea_layout layout = dea_layout_of(&scene);
    void *point = solve_point(&scene, "field", &layout);
    const dea_mode *modes = point;
    for (size_t j = 0; j < 3; j++) {
        for (size_t k = 0; k <= j; k++) {
            double sum = 0.0;
            for (size_t i = 0; i < POINTS; i++) {
                const double weight = i == 0 || i + 1 == POINTS ? 1.0 : i % 2 ? 4.0 : 2.0, r = dea_layout_radius(&scene, &layout, i) / 1.2;
                sum += weight * r * *dea_layout_entry(&layout, point, j, i) * *dea_layout_entry(&layout, point, k, i);
            }
            sum *= 2.0 * DEA_PI * 1080.0 * 1e-4 * (0.03 / 1.2) / (POINTS - 1) / 3.0;
            assert_true(fabs(sum - (j == k ? 1.0 : 0.0)) <= 1e-6);
        }
        const double edge = *dea_layout_entry(&layout, point, j, POINTS / 2);
        assert_true(fabs(modes[j].edge_mass * edge * edge - 1.0) <= 1e-5);
    }
    free(point);
}

static void a_film_with_one_node_has_one_mode(void **state)
{
    (void)state;
    static const char *const models[] = {"lumped", "coverage", "ring"}; /* the force of lame leaves out its softening */
    for (size_t i = 0; i < sizeof models / sizeof *models; i++) {
        dea_mode mode[MOST];
        const dea_scene scene = modes_scene(DEA_DOT, 1.2, 0.5, 3000.0, 1);
        dea_point point;
        dea_film_prepare(&scene, &point.film);
        dea_point_place(&scene, &point);
        solve_modes(&scene, models[i], mode);
        const double mass = dea_point_mass(&scene, &point), w = 2.0 * DEA_PI * mode->frequency;
        /* K = d(force of the springs - F_DEA)/du: a force f at the edge moves it by f/K, the voltage by 2 phi U dU/K */
        const double step = 1e-3;
        dea_row rows[2];
        for (int side = 0; side < 2; side++) {
            point.voltage = 3000.0 + (side ? step : -step);
            dea_model_find(models[i])->solve(&point, 1e-12, &rows[side]);
        }
        const double slope = (rows[1].displacement - rows[0].displacement) / (2.0 * step);
        const double middle = 0.5 * (rows[1].force + rows[0].force); /* phi U^2 */
        assert_true(fabs(slope * w * w * mass / (2.0 * middle / 3000.0) - 1.0) <= 1e-5);
        assert_true(mode->edge_share == 1.0 && fabs(mode->edge_mass / mass - 1.0) <= 1e-12);
    }
}

static void what_does_not_swing_has_no_damping_ratio(void **state)
{
    (void)state;
    dea_mode modes[MOST];
    dea_scene scene = modes_scene(DEA_DOT, 1.2, 0.5, 3000.0, 3);
    scene.material.retardation = 2e-4;
    solve_modes(&scene, "field", modes);
    assert_true(modes[0].frequency > 0.0 && modes[0].damping_ratio < 1.0);
    assert_true(modes[2].frequency == 0.0 && isnan(modes[2].damping_ratio) && modes[2].undamped > 1000.0);
    assert_int_equal(modes[2].state, DEA_STATE_OK);
}

static void past_pull_in_there_is_no_mode(void **state)
{
    (void)state;
    static const char *const models[] = {"field", "ring", "coverage"};
    for (size_t i = 0; i < sizeof models / sizeof *models; i++) {
        dea_mode modes[MOST];
        dea_scene scene = modes_scene(DEA_DOT, 1.0, 0.1, 40000.0, i == 0 ? 2 : 1);
        scene.material.constants[1] = scene.material.constants[2] = 0.0;
        solve_modes(&scene, models[i], modes);
        assert_int_equal(modes[0].state, DEA_STATE_PULL_IN);
        assert_true(isnan(modes[0].frequency) && isnan(modes[0].undamped) && modes[0].number == 1.0);
    }
}

/* Towards pull-in the film softens to nothing: w^2 goes to 0 linearly in sqrt(1 - U/U_c). */
static void the_first_mode_stops_at_pull_in(void **state)
{
    (void)state;
    dea_scene scene = modes_scene(DEA_DOT, 1.0, 0.1, 0.0, 1);
    scene.material.constants[1] = scene.material.constants[2] = 0.0;
    double low = 1000.0, high = 40000.0;
    dea_mode mode[MOST];
    for (int i = 0; i < 40; i++) {
        scene.modes.bias = 0.5 * (low + high);
        solve_modes(&scene, "ring", mode);
        *(mode->state == DEA_STATE_PULL_IN ? &high : &low) = scene.modes.bias;
    }
    double squares[2];
    for (int i = 0; i < 2; i++) {
        scene.modes.bias = low * (1.0 - (i ? 4e-5 : 1e-5));
        solve_modes(&scene, "ring", mode);
        squares[i] = mode->frequency * mode->frequency;
    }
    assert_true(fabs(squares[1] / squares[0] - 2.0) <= 0.05);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(frequencies_are_those_of_the_table),
        cmocka_unit_test(a_film_without_voltage_has_the_roots_of_bessel),
        cmocka_unit_test(losses_of_a_uniform_film_solve_its_own_equation),
        cmocka_unit_test(losses_under_a_bias_are_eigenvalues_of_the_whole_system),
        cmocka_unit_test(the_share_of_a_mode_is_the_residue_of_the_response),
        cmocka_unit_test(shares_of_all_modes_are_the_whole),
        cmocka_unit_test(shapes_have_mass_one_and_none_in_common),
        cmocka_unit_test(a_film_with_one_node_has_one_mode),
        cmocka_unit_test(what_does_not_swing_has_no_damping_ratio),
        cmocka_unit_test(past_pull_in_there_is_no_mode),
        cmocka_unit_test(the_first_mode_stops_at_pull_in),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
