/* The moving membrane on its network of rings: equilibria, modes and steps of physics.md, and its derivatives. */
#include "moving_membrane.h"
#include "random_scenes.h"

#include "network/membrane.h"
#include "network/pace.h"
#include "result/scales.h"

static dea_membrane membrane_of(const dea_scene *scene, size_t disc, size_t annulus)
{
    dea_membrane membrane;
    const dea_rings_mesh mesh = {disc, annulus, false};
    assert_int_equal(dea_membrane_open(scene, dea_model_find("field"), mesh, &membrane, NULL), DEA_OK);
    return membrane;
}

static double still_strain(const dea_membrane *membrane, double voltage)
{
    double u[DEA_RINGS_NODES];
    assert_true(dea_membrane_still(membrane, voltage, u));
    return u[membrane->rings.edge] / membrane->film.radius;
}

static void its_equilibria_are_those_of_the_field(void **state)
{
    (void)state;
    static const struct {
        dea_kind kind;
        double prestretch, coverage, strain;
    } table[] = {
        {DEA_DOT, 1.1, 0.50, 0.02651626},   {DEA_LENS, 1.1, 0.50, -0.02338631}, {DEA_DOT, 1.2, 0.25, 0.06092621},
        {DEA_LENS, 1.2, 0.25, -0.04432166}, {DEA_DOT, 1.3, 0.75, 0.03289753},   {DEA_LENS, 1.3, 0.75, -0.03263280},
    };
    for (size_t i = 0; i < sizeof table / sizeof *table; i++) {
        const dea_scene scene = paper_scene(table[i].kind, table[i].prestretch, table[i].coverage, 4500.0);
        const dea_membrane membrane = membrane_of(&scene, 3, 12);
        assert_true(fabs(still_strain(&membrane, 4500.0) - table[i].strain) <= 6e-9);
    }
}

/* Row of the static film against the boundary value problem along the radius, which knows no rings. */
static void its_rows_are_those_of_the_field(void **state)
{
    (void)state;
    for (int kind = DEA_DOT; kind <= DEA_LENS; kind++) {
        const dea_scene scene = paper_scene((dea_kind)kind, 1.2, 0.5, 4500.0);
        const dea_membrane membrane = membrane_of(&scene, 8, 14);
        const dea_row wanted = solve_direct(&scene, "field");
        double u[DEA_RINGS_NODES];
        dea_membrane_look look;
        dea_row row;
        assert_true(dea_membrane_still(&membrane, 4500.0, u));
        assert_true(dea_membrane_look_at(&membrane, u, &look));
        dea_membrane_row(&membrane, &look, 4500.0, u, &row);
        for (int c = 0; c < DEA_ROW_COLUMNS; c++) {
            const double have = *(const double *)((const char *)&row + dea_row_columns[c].offset);
            const double want = *(const double *)((const char *)&wanted + dea_row_columns[c].offset);
            assert_true(isnan(want) ? isnan(have) : fabs(have - want) <= 1e-9 * fabs(want));
        }
        assert_int_equal(row.state, wanted.state);
    }
}

/* Largest voltage that a film holds [V]. */
static double last_voltage(const dea_membrane *membrane)
{
    double low = 4500.0, high = 20000.0, u[DEA_RINGS_NODES];
    for (int i = 0; i < 40; i++) {
        const double middle = 0.5 * (low + high);
        *(dea_membrane_still(membrane, middle, u) ? &low : &high) = middle;
    }
    return low;
}

static dea_scene neo_hookean_scene(dea_kind kind)
{
    dea_scene scene = paper_scene(kind, 1.2, 0.5, 0.0);
    scene.material.constants[1] = scene.material.constants[2] = 0.0;
    return scene;
}

/* lambda_1 has an infinite slope at the edge there, which no polynomial follows quickly. */
static void a_strong_voltage_pulls_a_lens_in_as_the_field(void **state)
{
    (void)state;
    dea_scene scene = neo_hookean_scene(DEA_LENS);
    const dea_membrane membrane = membrane_of(&scene, 4, 20);
    const double last = last_voltage(&membrane);
    for (int side = 0; side < 2; side++) {
        scene.drive.voltage = last * (side == 0 ? 1.0 - 1e-3 : 1.0 + 1e-3);
        const dea_row row = solve_direct(&scene, "field");
        assert_int_equal(row.state == DEA_STATE_PULL_IN, side == 1);
    }
}

/* An electroded disc thins somewhere as soon as its radial stiffness is gone: s11 = mu (1 + 3/lambda^6) - k lambda^2 = 0. */
static void a_disc_pulls_in_where_its_radial_stiffness_ends(void **state)
{
    (void)state;
    const dea_scene scene = neo_hookean_scene(DEA_DOT);
    const dea_membrane membrane = membrane_of(&scene, 6, 16);
    const double last = last_voltage(&membrane), field = last / scene.actuator.film_thickness;
    const double l = 1.2 * (1.0 + still_strain(&membrane, last)), k = DEA_EPSILON_0 * 2.8 * field * field;
    const double mu = 2.0 * scene.material.constants[0];
    assert_true(fabs(mu * (1.0 + 3.0 * pow(l, -6.0)) / (k * l * l) - 1.0) <= 1e-5);
}

static void mode_frequencies(const dea_membrane *membrane, double voltage, double frequencies[DEA_RINGS_NODES])
{
    double u[DEA_RINGS_NODES];
    static double stiffness[DEA_RINGS_NODES * DEA_RINGS_NODES], shapes[DEA_RINGS_NODES * DEA_RINGS_NODES];
    dea_membrane_look look;
    assert_true(dea_membrane_still(membrane, voltage, u));
    assert_true(dea_membrane_look_at(membrane, u, &look));
    dea_membrane_stiffness(membrane, &look, voltage, NULL, 0.0, stiffness);
    assert_true(dea_membrane_modes(membrane, stiffness, frequencies, shapes));
}

static void its_modes_are_those_of_the_table(void **state)
{
    (void)state;
    static const struct {
        dea_kind kind;
        double prestretch, coverage, modes[2][3];
    } table[] = {
        {DEA_DOT, 1.1, 0.50, {{661.974, 1212.028, 1757.59}, {629.520, 1177.549, 1698.65}}},
        {DEA_DOT, 1.2, 0.25, {{619.836, 1134.877, 1645.71}, {587.717, 1088.681, 1612.00}}},
        {DEA_DOT, 1.3, 0.75, {{622.721, 1140.159, 1653.37}, {596.617, 1075.283, 1553.98}}},
        {DEA_LENS, 1.2, 0.50, {{619.836, 1134.877, 1645.71}, {628.647, 1108.445, 1635.81}}},
    };
    for (size_t i = 0; i < sizeof table / sizeof *table; i++) {
        dea_scene scene = paper_scene(table[i].kind, table[i].prestretch, table[i].coverage, 4500.0);
        scene.material.density = 1080.0;
        const dea_membrane membrane = membrane_of(&scene, 10, 12);
        for (int biased = 0; biased < 2; biased++) {
            double frequencies[DEA_RINGS_NODES];
            mode_frequencies(&membrane, biased ? 4500.0 : 0.0, frequencies);
            for (int k = 0; k < 3; k++) {
                const double digit = k < 2 ? 1e-3 : 1e-2;
                assert_true(fabs(frequencies[k] / (2.0 * DEA_PI) - table[i].modes[biased][k]) <= 0.6 * digit);
            }
        }
    }
}

/* Frequencies of physics, section 7: with these masses the trapezoidal rule, which takes s for (2/h) tanh(s h/2), turns the slowest mode as
 * the film does, m (2/h)^2 tan(omega h/2)^2 = m_0 omega^2. */
static void masses_fit_the_steps_to_its_slowest_mode(void **state)
{
    (void)state;
    static const double volts[] = {0.0, 4500.0}, slowest[] = {619.836, 587.717}, turns[] = {0.01, 0.5, 1.5};
    dea_scene scene = paper_scene(DEA_DOT, 1.2, 0.25, 4500.0);
    scene.material.density = 1080.0;
    const dea_membrane membrane = membrane_of(&scene, 10, 12);
    for (int i = 0; i < 2; i++) {
        const double omega = 2.0 * DEA_PI * slowest[i];
        for (int k = 0; k < 3; k++) {
            const dea_matching fit = dea_matching_of_rings(&membrane, volts[i], turns[k] / omega);
            const double half = 0.5 * turns[k], mass = half / tan(half) * half / tan(half);
            assert_true(fabs(fit.mass / mass - 1.0) < 3e-6);
            assert_true(fabs(fit.resistance) < 1e-9 * omega);
        }
        assert_true(dea_matching_of_rings(&membrane, volts[i], 2.1 / omega).mass == 1.0);
    }
}

/* Forces of a film with all that it can have, at any state. */
static void full_force(const dea_membrane *membrane, double voltage, const double *u, const double *v, const double *z,
                       double *force)
{
    double x[DEA_RINGS_MOST][2];
    dea_membrane_look look;
    assert_true(dea_membrane_look_at(membrane, u, &look));
    dea_membrane_viscous(membrane, &look, v, z, x);
    dea_membrane_force(membrane, &look, voltage, x, force);
}

static dea_scene viscous_scene(dea_kind kind)
{
    dea_scene scene = paper_scene(kind, 1.2, 0.4, 0.0);
    scene.material.density = 1080.0;
    scene.material.retardation = 5e-5;
    scene.material.prony_count = 2;
    scene.material.prony[0] = (dea_prony){0.1, 1e-3};
    scene.material.prony[1] = (dea_prony){0.05, 0.2};
    scene.reduction.branches[1] = DEA_BRANCH_SPRING;
    return scene;
}

/* Stiffness against differences of the force: with the branches held at z, at rest in time. */
static void its_stiffness_is_the_slope_of_its_force(void **state)
{
    (void)state;
    const double voltage = 4000.0, h = 1e-8;
    for (int kind = DEA_DOT; kind <= DEA_LENS; kind++) {
        const dea_scene scene = viscous_scene((dea_kind)kind);
        const dea_membrane m = membrane_of(&scene, 4, 5);
        const size_t n = m.rings.node_count;
        double u[DEA_RINGS_NODES], z[2 * DEA_RINGS_MOST], x[DEA_RINGS_MOST][2], stiffness[DEA_RINGS_NODES * DEA_RINGS_NODES];
        dea_membrane_look look;
        for (size_t i = 0; i < n; i++) {
            u[i] = 4e-4 * sin(1.0 + 3.0 * (double)i);
        }
        assert_true(dea_membrane_relaxed(&m) <= sizeof z / sizeof *z);
        for (size_t i = 0; i < dea_membrane_relaxed(&m); i++) {
            z[i] = 2e4 * cos((double)i);
        }
        assert_true(dea_membrane_look_at(&m, u, &look));
        dea_membrane_viscous(&m, &look, NULL, z, x);
        dea_membrane_stiffness(&m, &look, voltage, x, m.film.total_share, stiffness);
        for (size_t j = 0; j < n; j++) {
            double ahead[DEA_RINGS_NODES], behind[DEA_RINGS_NODES], largest = 0.0;
            const double at = u[j];
            u[j] = at + h;
            full_force(&m, voltage, u, NULL, z, ahead);
            u[j] = at - h;
            full_force(&m, voltage, u, NULL, z, behind);
            u[j] = at;
            for (size_t i = 0; i < n; i++) {
                largest = fmax(largest, fabs(stiffness[j * n + i]));
            }
            for (size_t i = 0; i < n; i++) {
                assert_true(fabs((behind[i] - ahead[i]) / (2.0 * h) - stiffness[j * n + i]) <= 1e-6 * largest);
            }
        }
    }
}

static void its_force_is_the_slope_of_its_capacitance(void **state)
{
    (void)state;
    const double h = 1e-7;
    for (int kind = DEA_DOT; kind <= DEA_LENS; kind++) {
        const dea_scene scene = paper_scene((dea_kind)kind, 1.2, 0.4, 0.0);
        const dea_membrane m = membrane_of(&scene, 4, 5);
        double u[DEA_RINGS_NODES], push[DEA_RINGS_NODES];
        dea_membrane_look look;
        for (size_t i = 0; i < m.rings.node_count; i++) {
            u[i] = 4e-4 * sin(1.0 + 3.0 * (double)i);
        }
        assert_true(dea_membrane_look_at(&m, u, &look));
        dea_membrane_push(&m, &look, push);
        for (size_t j = 0; j < m.rings.node_count; j++) {
            double capacitance[2];
            for (int side = 0; side < 2; side++) {
                const double at = u[j];
                u[j] += side ? h : -h;
                assert_true(dea_membrane_look_at(&m, u, &look));
                capacitance[side] = look.capacitance;
                u[j] = at;
            }
            assert_true(fabs((capacitance[1] - capacitance[0]) / (4.0 * h) - push[j]) <= 1e-6 * fabs(push[m.rings.edge]));
        }
    }
}

/* ---- in time, by ida */

enum { MOST_ROWS = 512, SCENES = 6 };

typedef struct membrane_run {
    dea_sample samples[MOST_ROWS];
    dea_summary summary;
    size_t rows;
} membrane_run;

static void run_field(const dea_scene *scene, membrane_run *run)
{
    const dea_engine *ida = dea_engine_find("ida");
    const dea_layout layout = dea_layout_of(scene);
    dea_error error = {0};
    void *session = NULL;
    run->rows = layout.rows;
    assert_true(layout.rows <= MOST_ROWS);
    assert_int_equal(ida->begin(&session, &error), DEA_OK);
    assert_int_equal(ida->transient(session, scene, dea_model_find("field"), run->samples, &run->summary, &error), DEA_OK);
    ida->end(session);
    if (error.message[0]) {
        print_error("%s\n", error.message);
    }
}

static void a_step_is_that_of_the_table(void **state)
{
    (void)state;
    static const struct {
        double coverage, peak, strain[4]; /* at 1, 2, 4, 8 ms */
    } table[] = {
        {0.25, 0.0756050, {0.0741705, 0.0518654, 0.0610839, 0.0613304}},
        {0.50, 0.0678036, {0.0674155, 0.0333990, 0.0443810, 0.0456962}},
        {0.75, 0.0305977, {0.0290929, 0.0200565, 0.0239188, 0.0234764}},
    };
    static membrane_run run;
    for (size_t i = 0; i < sizeof table / sizeof *table; i++) {
        dea_scene scene = fe_step_scene(DEA_DOT, 1.2, table[i].coverage, 4500.0, 1e-4);
        double peak = 0.0;
        scene.material.retardation = 5e-5;
        run_field(&scene, &run);
        for (size_t k = 0; k < 4; k++) {
            assert_near(run.samples[50 << k].strain, table[i].strain[k], 0.6e-7);
        }
        for (size_t k = 0; k < run.rows; k++) {
            peak = fmax(peak, run.samples[k].strain);
        }
        assert_near(peak, table[i].peak, 0.6e-7);
        assert_true(run.summary.residual <= 10.0 * scene.accuracy);
    }
}

/* A film without mass and damper that follows a slow ramp of the voltage. */
static dea_scene slow_scene(dea_kind kind, double voltage)
{
    dea_scene scene = fe_step_scene(kind, 1.2, 0.4, voltage, 1.0);
    scene.material.density = (double)NAN;
    scene.material.breakdown = 1.1e8;
    scene.transient = (dea_transient){.until = 1.0, .every = 1.0 / 128.0};
    scene.drive.leakage_resistance = 1e9;
    return scene;
}

static void a_film_without_mass_follows_the_field_in_every_state(void **state)
{
    (void)state;
    static membrane_run run;
    size_t seen[DEA_STATE_COUNT] = {0};
    for (int kind = DEA_DOT; kind <= DEA_LENS; kind++) {
        dea_scene scene = slow_scene((dea_kind)kind, 7000.0);
        run_field(&scene, &run);
        scene.accuracy = 1e-9;
        scene.drive.leakage_resistance = (double)NAN;
        for (size_t i = 0; i < run.rows; i++) {
            scene.drive.voltage = run.samples[i].voltage;
            const dea_row row = solve_direct(&scene, "field");
            seen[run.samples[i].state]++;
            assert_int_equal(run.samples[i].state, row.state);
            assert_near(run.samples[i].displacement, row.displacement, 1e-6 * 2e-3);
            assert_near(run.samples[i].charge, row.charge, 1e-5 * 4e-6);
            assert_near(run.samples[i].force, row.force, 1e-5 * 2.0);
        }
        assert_true(run.summary.residual <= 1e-5);
    }
    assert_true(seen[DEA_STATE_OK] > 0 && seen[DEA_STATE_SLACK] > 0 && seen[DEA_STATE_BREAKDOWN] > 0);
}

static void a_lens_that_pulls_in_ends_where_the_field_does(void **state)
{
    (void)state;
    static membrane_run run;
    dea_scene scene = slow_scene(DEA_LENS, 13000.0), still = neo_hookean_scene(DEA_LENS);
    memcpy(scene.material.constants, still.material.constants, sizeof scene.material.constants);
    scene.material.breakdown = (double)NAN;
    scene.accuracy = 1e-4;
    run_field(&scene, &run);
    size_t last = 0;
    while (last + 1 < run.rows && run.samples[last + 1].state != DEA_STATE_PULL_IN) {
        last++;
    }
    assert_true(last + 1 < run.rows && isfinite(run.samples[last].displacement));
    for (size_t i = last + 1; i < run.rows; i++) {
        assert_int_equal(run.samples[i].state, DEA_STATE_PULL_IN);
        assert_true(isnan(run.samples[i].displacement));
    }
    scene.drive.leakage_resistance = (double)NAN;
    scene.drive.voltage = run.samples[last].voltage;
    assert_int_not_equal(solve_direct(&scene, "field").state, DEA_STATE_PULL_IN);
    scene.drive.voltage = run.samples[last + 1].voltage;
    assert_state(solve_direct(&scene, "field"), DEA_STATE_PULL_IN);
}

static void a_film_at_its_bias_rests(void **state)
{
    (void)state;
    static membrane_run run;
    double times[] = {0.0, 1e-2}, voltages[] = {3000.0, 3000.0};
    dea_scene scene = fe_step_scene(DEA_DOT, 1.2, 0.5, 0.0, 0.0);
    scene.drive.waveform = (dea_waveform){
        .kind = DEA_WAVE_POINTS, .times = times, .voltages = voltages, .point_count = 2, .period = (double)NAN};
    scene.material.retardation = 2e-5;
    scene.material.prony_count = 1;
    scene.material.prony[0] = (dea_prony){0.1, 1e-3};
    scene.drive.series_resistance = 1e5;
    scene.transient = (dea_transient){.until = 1e-2, .every = 1e-3, .from_bias = true};
    run_field(&scene, &run);
    const dea_row row = solve_paper("field", DEA_DOT, 1.2, 0.5, 3000.0);
    for (size_t i = 0; i < run.rows; i++) {
        assert_relative(run.samples[i].displacement, row.displacement, 1e-7);
        assert_near(run.samples[i].velocity, 0.0, 1e-6);
        assert_near(run.samples[i].current, 0.0, 1e-9);
    }
}

static void random_steps_keep_their_promises(void **state)
{
    (void)state;
    static membrane_run run;
    uint64_t seed = UINT64_C(20250713);
    for (int i = 0; i < SCENES; i++) {
        const dea_scene scene = fe_random_step(&seed);
        run_field(&scene, &run);
        assert_int_not_equal(run.samples[run.rows - 1].state, DEA_STATE_FAILED);
        const double broken = fe_broken(&scene, run.samples, run.rows);
        if (!(broken <= 1.0)) {
            fail_msg("scene %d: %.3g times the accuracy", i, broken);
        }
        assert_true(run.summary.residual <= 10.0 * scene.accuracy);
    }
}

/* Beside a wide disc the annulus takes a small share of the nodes: a mesh that cuts it as the last one did tells nothing of it, and the
 * next one is asked instead of none. */
static void a_wide_disc_gets_meshes_that_differ_in_both_elements(void **state)
{
    (void)state;
    static membrane_run run;
    for (int i = 0; i < 2; i++) {
        dea_scene scene = fe_step_scene(DEA_DOT, 1.2, i == 0 ? 0.9585 : 0.0415, 2000.0, 5e-4);
        scene.material.retardation = 3e-4;
        scene.transient = (dea_transient){.until = 1.5e-3, .every = 1e-4};
        scene.accuracy = 1e-3;
        run_field(&scene, &run);
        assert_int_equal(run.samples[run.rows - 1].state, DEA_STATE_OK);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(its_equilibria_are_those_of_the_field),
        cmocka_unit_test(its_rows_are_those_of_the_field),
        cmocka_unit_test(a_strong_voltage_pulls_a_lens_in_as_the_field),
        cmocka_unit_test(a_disc_pulls_in_where_its_radial_stiffness_ends),
        cmocka_unit_test(its_modes_are_those_of_the_table),
        cmocka_unit_test(masses_fit_the_steps_to_its_slowest_mode),
        cmocka_unit_test(its_stiffness_is_the_slope_of_its_force),
        cmocka_unit_test(its_force_is_the_slope_of_its_capacitance),
        cmocka_unit_test(a_step_is_that_of_the_table),
        cmocka_unit_test(a_film_without_mass_follows_the_field_in_every_state),
        cmocka_unit_test(a_lens_that_pulls_in_ends_where_the_field_does),
        cmocka_unit_test(a_film_at_its_bias_rests),
        cmocka_unit_test(random_steps_keep_their_promises),
        cmocka_unit_test(a_wide_disc_gets_meshes_that_differ_in_both_elements),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
