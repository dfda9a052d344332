/* When two answers agree: what a phase, a zero and a sign count for. */
#include "scenes.h"

#include "child_program.h"
#include "judges.h"

#include "result/compare.h"

/* A response of the paper's film about a bias, of three frequencies. */
static dea_scene response_scene(double bias)
{
    dea_scene scene = paper_scene(DEA_DOT, 1.2, 0.5, (double)NAN);
    scene.models[0] = dea_model_find("lumped");
    scene.study = DEA_STUDY_AC;
    scene.ac = (dea_ac){.from = 10.0, .to = 1000.0, .points_per_decade = 1, .bias = bias};
    return scene;
}

/* Difference of two responses that are alike but for their displacement per volt. */
static double difference_of(double wanted, double wanted_phase, double found, double found_phase)
{
    const dea_scene scene = response_scene(3000.0);
    dea_response rows[8] = {{.frequency = 0.0}}; /* room for what stands behind the rows */
    dea_comparison comparison;
    assert_int_equal(dea_comparison_open(&comparison, &scene, NULL), DEA_OK);
    assert_int_equal(comparison.layout.rows, 3);
    for (int i = 0; i < 3; i++) {
        rows[i] = (dea_response){10.0, 1e-7, 0.0, 1e6, -90.0, DEA_STATE_OK};
    }
    rows[1].displacement = wanted;
    rows[1].displacement_phase = wanted_phase;
    assert_int_equal(dea_comparison_take(&comparison, 0, rows, 1, NULL), DEA_OK);
    comparison.filling = false;
    rows[1].displacement = found;
    rows[1].displacement_phase = found_phase;
    assert_int_equal(dea_comparison_take(&comparison, 0, rows, 1, NULL), DEA_OK);
    const double worst = dea_comparison_worst(&comparison);
    dea_comparison_close(&comparison);
    return worst;
}

static void phase_of_a_zero_is_any(void **state)
{
    (void)state;
    assert_true(difference_of(0.0, 0.0, 0.0, 180.0) == 0.0);
    assert_true(difference_of(0.0, 0.0, -0.0, -90.0) == 0.0);
    assert_true(difference_of(1e-24, 0.0, 1e-24, 180.0) < 1e-6); /* rounding beside 1e-7 */
    assert_relative(difference_of(1e-7, 90.0, 1e-7, 90.5), 0.5 * DEA_PI / 180.0, 1e-12);
    assert_relative(difference_of(1e-12, 0.0, 1e-12, 1.0), DEA_PI / 180.0, 1e-12); /* small, but a number */
    assert_true(difference_of(0.0, 0.0, 1e-12, 0.0) > 1e3);                        /* no zero at all */
    assert_true(isinf(difference_of(1e-7, 0.0, (double)NAN, (double)NAN)));
}

static void engines_agree_about_a_film_without_bias(void **state)
{
    (void)state;
    static const char scene[] =
        "actuator: {kind: dot, frame_radius: 30 mm, coverage: 0.5, film_thickness: 100 um, prestretch: 1.2}\n"
        "material: {base: elastosil-2030, retardation: 10 us}\n"
        "drive: {series_resistance: 100 kOhm}\n"
        "model: [lumped, lame, coverage]\n"
        "study: {ac: {from: 20 Hz, to: 10 kHz, points_per_decade: 5, bias: 0 V}}\n";
    file_write("zero.yaml", scene, strlen(scene));
    RUN("check", "zero.yaml");
    assert_status(0);
}

/* Rows whose states differ, of two runs that are alike but for one displacement and state. */
static size_t states_that_differ(double wanted, dea_state wanted_state, double found, dea_state found_state)
{
    dea_scene scene = paper_scene(DEA_DOT, 1.0, 0.5, (double)NAN);
    struct {
        dea_sample samples[3];
        dea_summary summary;
    } run = {.summary = dea_summary_failed()};
    dea_comparison comparison;
    scene.models[0] = dea_model_find("coverage");
    scene.study = DEA_STUDY_TRANSIENT;
    scene.transient = (dea_transient){.until = 2.0, .every = 1.0};
    scene.drive.waveform = (dea_waveform){.kind = DEA_WAVE_STEP, .step = {0.0, (double)NAN, 3000.0, 0.0}, .period = (double)NAN};
    assert_int_equal(dea_comparison_open(&comparison, &scene, NULL), DEA_OK);
    assert_int_equal(comparison.layout.point_size, sizeof run);
    for (int i = 0; i < 3; i++) {
        const double none = (double)NAN;
        run.samples[i] = (dea_sample){i, 3000.0, 1e-4, 1e-4 / 0.015, 0.0, 0.1, none, none, none, none, none, DEA_STATE_SLACK, {.field = 0.0}};
    }
    run.samples[1].displacement = wanted;
    run.samples[1].state = wanted_state;
    assert_int_equal(dea_comparison_take(&comparison, 0, &run, 1, NULL), DEA_OK);
    comparison.filling = false;
    run.samples[1].displacement = found;
    run.samples[1].state = found_state;
    assert_int_equal(dea_comparison_take(&comparison, 0, &run, 1, NULL), DEA_OK);
    dea_comparison_close(&comparison);
    return comparison.states;
}

static dea_scene slackening_scene(double voltage)
{
    static const char text[] = "actuator: {kind: dot, frame_radius: 30 mm, film_thickness: 100 um, prestretch: 1.01, coverage: 0.6}\n"
                               "material: {yeoh: {C1: 178426 Pa, C2: -6023 Pa, C3: 4234 Pa}, permittivity: 2.8}\n"
                               "model: field\ndrive: {voltage: 3 kV}\nstudy: {sweep: {}}\n";
    dea_scene scene;
    dea_error error = {0};
    if (dea_scene_parse(text, strlen(text), "t", ".", NULL, 0, NULL, &scene, &error) != DEA_OK) {
        fail_msg("%s", error.message);
    }
    scene.drive.voltage = voltage;
    return scene;
}

/* States of rows whose strains are that far apart. */
static size_t still_states_that_differ(double voltage, double apart)
{
    dea_comparison comparison;
    dea_scene scene = slackening_scene(voltage);
    dea_row row = dea_row_failed();
    row.strain = 9.1e-3;
    row.displacement = row.force = row.field = row.capacitance = row.charge = row.area_strain = 1.0;
    row.state = DEA_STATE_SLACK;
    assert_int_equal(dea_comparison_open(&comparison, &scene, NULL), DEA_OK);
    assert_int_equal(dea_comparison_take(&comparison, 0, &row, 1, NULL), DEA_OK);
    comparison.filling = false;
    row.strain *= 1.0 + apart;
    row.state = DEA_STATE_OK;
    assert_int_equal(dea_comparison_take(&comparison, 0, &row, 1, NULL), DEA_OK);
    dea_comparison_close(&comparison);
    dea_scene_free(&scene);
    return comparison.states;
}

/* By Runge-Kutta over the radius. */
static dea_state judged_state(double voltage)
{
    dea_scene scene = slackening_scene(voltage);
    const dea_state state = judge_membrane(&scene).state;
    dea_scene_free(&scene);
    return state;
}

/* On both sides of a limit where the strains leave it open on which side they are, and nowhere else. */
static void still_states_on_two_sides_of_a_limit_are_no_disagreement(void **state)
{
    (void)state;
    const double onset = 3865.68; /* V; the film is slack from there on */
    assert_int_equal(judged_state(0.99995 * onset), DEA_STATE_OK);
    assert_int_equal(judged_state(1.00005 * onset), DEA_STATE_SLACK);
    assert_int_equal(still_states_that_differ(onset, 2e-5), 0);
    assert_int_equal(still_states_that_differ(1.001 * onset, 1e-5), 1);
    assert_int_equal(still_states_that_differ(0.999 * onset, 1e-5), 1);
    assert_int_equal(still_states_that_differ(1.001 * onset, 2e-4), 0);
}

/* Without pre-stretch the passive ring is slack as soon as the disc grows. */
static void states_on_two_sides_of_a_limit_are_no_disagreement(void **state)
{
    (void)state;
    assert_int_equal(states_that_differ(1e-9, DEA_STATE_SLACK, -2e-9, DEA_STATE_OK), 0);
    assert_int_equal(states_that_differ(1e-9, DEA_STATE_SLACK, 2e-9, DEA_STATE_OK), 1);
    assert_int_equal(states_that_differ(1e-9, DEA_STATE_SLACK, -2e-9, DEA_STATE_BREAKDOWN), 1);
    assert_int_equal(states_that_differ(1e-9, DEA_STATE_SLACK, (double)NAN, DEA_STATE_PULL_IN), 1);
}

/* Without pre-stretch: behind an edge of 3 kV films of one node get out of step, under 300 V that rise within 20 ms they do not, and
 * check measures that. A film that comes back to rest passes its limit there. */
static void check_measures_the_model_that_auto_chose(void **state)
{
    (void)state;
    static const char scene[] =
        "actuator: {kind: dot, frame_radius: 30 mm, coverage: 0.5, film_thickness: 100 um, prestretch: 1}\n"
        "material: {base: elastosil-2030, density: 1080 kg/m^3, retardation: 20 us}\n"
        "drive: {waveform: {step: {on: 1 ms, voltage: 3 kV, rise: 1 us}}}\n"
        "model: auto\nmodel_error: 5 %\naccuracy: 0.1\n"
        "study: {transient: {until: 50 ms, every: 0.1 ms}}\n";
    file_write("swing.yaml", scene, strlen(scene));
    RUN("check", "--set", "until=4 ms", "swing.yaml");
    assert_status(0);
    assert_says("model auto: field, nothing cheaper is good enough");
    RUN("check", "--set", "voltage=300 V", "--set", "rise=20 ms", "swing.yaml");
    assert_status(0);
    assert_non_null(strstr(child_out, "lame instead of field (<= "));
    assert_non_null(strstr(child_out, ", measured "));
}

/* A ring without damping has more periods than ngspice can follow at that accuracy. */
static void a_summary_names_who_solved(void **state)
{
    (void)state;
    static const char scene[] =
        "actuator: {kind: dot, frame_radius: 30 mm, coverage: 0.5, film_thickness: 100 um, prestretch: 1.2}\n"
        "material: {base: elastosil-2030, density: 1080 kg/m^3}\n"
        "drive: {waveform: {step: {on: 1 ms, voltage: 3 kV, rise: 1 us}}}\n"
        "model: lumped\nstudy: {transient: {until: 200 s, every: 100 ms}}\n";
    file_write("long.yaml", scene, strlen(scene));
    RUN("run", "--engine", "ngspice,direct", "long.yaml", "-o", "long.csv");
    assert_status(0);
    assert_says("direct was asked instead");
    assert_says("(ngspice; 1 of 1 by direct instead)");
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(phase_of_a_zero_is_any),
        cmocka_unit_test(engines_agree_about_a_film_without_bias),
        cmocka_unit_test(check_measures_the_model_that_auto_chose),
        cmocka_unit_test(a_summary_names_who_solved),
        cmocka_unit_test(states_on_two_sides_of_a_limit_are_no_disagreement),
        cmocka_unit_test(still_states_on_two_sides_of_a_limit_are_no_disagreement),
    };
    return cmocka_run_group_tests(tests, child_enter, child_leave);
}
