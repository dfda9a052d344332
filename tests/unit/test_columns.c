/* Columns of transients that follow from displacement and charge: their scales, what engines promise for them, and that `check`
 * and `make promises` look at them. Truths are those of make promises. */
#include "scenes.h"

#include "child_program.h"

#include "../promises/promises.h"
#include "result/compare.h"
#include "result/scales.h"

enum { LINE = 512 };

/* ---- scales */

/* The paper's film under a step of 4500 V at 0.1 s. */
static dea_scene step_scene(double rise)
{
    dea_scene scene = paper_scene(DEA_DOT, 1.2, 0.5, (double)NAN);
    scene.models[0] = dea_model_find("lumped");
    scene.study = DEA_STUDY_TRANSIENT;
    scene.drive.waveform = (dea_waveform){.kind = DEA_WAVE_STEP,
                                          .step = {.on = 0.1, .off = (double)NAN, .voltage = 4500.0, .rise = rise},
                                          .period = (double)NAN};
    scene.transient = (dea_transient){.until = 2.0, .every = 0.1};
    return scene;
}

static double pace_of(const dea_scene *scene)
{
    return dea_scales_open(scene, scene->models[0]).pace;
}

static void the_fastest_time_is_that_of_the_edge_or_of_the_film(void **state)
{
    (void)state;
    dea_scene scene = step_scene(0.0);
    assert_relative(pace_of(&scene), 0.5, 1e-12); /* it follows a jump at once: the run itself */
    scene.material.prony_count = 1;
    scene.material.prony[0] = (dea_prony){.g = 0.2, .tau = 0.05};
    assert_relative(pace_of(&scene), 0.2 / 0.05, 1e-12);
    scene.material.retardation = 1e-3;
    assert_relative(pace_of(&scene), 1e3, 1e-12);
    scene.material.density = 1080.0;
    scene.material.retardation = 1e-9;
    scene.material.prony_count = 0;
    const double omega = 2.0 * DEA_PI * 825.5; /* of the film of examples/work-precision.yaml, which is this one */
    assert_true(pace_of(&scene) > 0.5 * omega && pace_of(&scene) < 2.0 * omega);
    scene.drive.waveform.step.rise = 0.25;
    assert_relative(pace_of(&scene), 4.0, 1e-12); /* a slow edge */
    scene.drive.series_resistance = 1e9;
    const dea_scales scales = dea_scales_open(&scene, scene.models[0]);
    assert_relative(scales.pace, 1.0 / 0.25237, 0.02); /* R C of 252 pF */
    assert_relative(scales.charging, scales.pace, 1e-12);
}

static void a_scale_is_the_peak_unless_samples_miss_it(void **state)
{
    (void)state;
    dea_scene scene = step_scene(0.0);
    scene.material.retardation = 1e-3;
    const dea_scales scales = dea_scales_open(&scene, scene.models[0]);
    dea_sample rows[2] = {dea_sample_refused(0.0, 0.0, DEA_STATE_OK), dea_sample_refused(0.1, 0.0, DEA_STATE_OK)};
    rows[0].displacement = -2e-3;
    rows[0].velocity = 0.5;
    rows[1].velocity = -7.0;
    assert_relative(dea_scales_of(&scales, rows, 2).displacement, 2e-3, 1e-15);
    assert_relative(dea_scales_of(&scales, rows, 2).velocity, 7.0, 1e-15);
    rows[1].velocity = 0.0;
    assert_relative(dea_scales_of(&scales, rows, 2).velocity, 2.0, 1e-12);
}

/* ---- promises */

static char *read_case(const char *name)
{
    char path[4200];
    size_t size;
    snprintf(path, sizeof path, "%s/tests/cases/%s.yaml", child_home, name);
    return file_read(path, &size);
}

static void hold(judged *j, const char *engine, double accuracy)
{
    char line[LINE] = "";
    tally counted = {0};
    if (judge_engine(j, dea_engine_find(engine), accuracy, &counted, line, sizeof line)) {
        fail_msg("%s: %s", j->scene.title, line);
    }
    if (counted.delivered != 1) {
        fail_msg("%s, %s, %g: %s", j->scene.title, engine, accuracy, counted.reasons[0].text);
    }
}

static void every_column_is_within_ten_times_the_accuracy(void **state)
{
    (void)state;
    static const struct {
        const char *name;
        double ida, ngspice; /* accuracies */
    } cases[] = {
        {"move1", 1e-8, 1e-4},           {"move1223", 1e-6, 1e-2},       {"columns_charging", 1e-8, 1e-4},
        {"columns_damper", 1e-8, 1e-4},  {"columns_branches", 1e-4, 1e-2}, {"columns_corners", 1e-4, 1e-2},
        {"columns_bias", 1e-6, 1e-4},    {"columns_held", 1e-6, 1e-2},   {"force_ngspice", 1e-6, 1e-6},
        {"columns_ohms", 1e-8, 1e-6},    {"columns_turning", 1e-4, 1e-2}, {"columns_film_voltage", 1e-8, 1e-4},
        {"columns_pulled", 1e-4, 1e-4},
    };
    for (size_t c = 0; c < sizeof cases / sizeof *cases; c++) {
        char *text = read_case(cases[c].name);
        judged j;
        assert_true(judge_open(&j, text, c));
        hold(&j, "ida", 1e-2);
        hold(&j, "ida", cases[c].ida);
        hold(&j, "ngspice", cases[c].ngspice);
        judge_close(&j);
        free(text);
    }
}

/* Every column of a point at rest, by every engine that can do the model, against its truth. */
static void every_column_at_rest_is_within_the_accuracy(void **state)
{
    (void)state;
    static const struct {
        const char *name;
        double accuracy;
    } engines[] = {{"direct", 1e-12}, {"ngspice", 1e-9}, {"ida", 1e-9}, {"ida", 1e-4}};
    static const char *const models[] = {"pelrine", "constant_force", "lumped", "coverage", "lame", "field"};
    for (size_t m = 0; m < 6; m++) {
        for (int lens = m < 2 ? 0 : 1; lens >= 0; lens--) {
            char *text = read_case(lens ? "columns_still_lens" : "columns_still_dot"), line[4 * LINE];
            snprintf(line, sizeof line, "%smodel: %s\n", text, models[m]);
            judged j;
            assert_true(judge_open(&j, line, m));
            for (size_t e = 0; e < 4; e++) {
                if (!dea_engine_find(engines[e].name)->refuses(&j.scene, j.scene.models[0])) {
                    hold(&j, engines[e].name, engines[e].accuracy);
                }
            }
            judge_close(&j);
            free(text);
        }
    }
}

/* Rows of one run of a case. */
static dea_status take_points(void *user, size_t first, const void *points, size_t count, dea_error *error)
{
    (void)error;
    const judged *j = ((void **)user)[0];
    memcpy((char *)((void **)user)[1] + first * j->layout.point_size, points, count * j->layout.point_size);
    return DEA_OK;
}

static dea_sample *run_case(judged *j, const char *engine, double accuracy)
{
    dea_error error = {0};
    dea_sample *rows = malloc(j->layout.point_size);
    void *user[2] = {j, rows};
    const dea_run_options options = {.jobs = 1, .points = take_points, .user = user};
    assert_non_null(rows);
    judge_find(j);
    j->scene.accuracy = accuracy;
    assert_int_equal(dea_study_run(&j->scene, dea_engine_find(engine), &options, &error), DEA_OK);
    return rows;
}

/* The velocity against the peak that the samples behind the start show, whatever the scale. */
static void the_velocity_of_a_slow_film_has_its_sign_and_size(void **state)
{
    (void)state;
    static const char *const cases[] = {"move1", "move1223", "columns_damper", "columns_held"};
    for (size_t c = 0; c < 4; c++) {
        for (int e = 0; e < 2; e++) {
            char *text = read_case(cases[c]);
            judged j;
            assert_true(judge_open(&j, text, 0));
            dea_sample *rows = run_case(&j, e == 0 ? "ngspice" : "ida", 1e-2);
            double peak = 0.0;
            for (size_t i = 1; i < j.layout.rows; i++) {
                peak = fmax(peak, fabs(j.runs[0].samples[i].velocity));
            }
            assert_true(peak > 0.0);
            for (size_t i = 1; i < j.layout.rows; i++) {
                if (!(fabs(rows[i].velocity - j.runs[0].samples[i].velocity) <= 0.1 * peak)) {
                    fail_msg("%s, row %zu: %g, not %g", cases[c], i, rows[i].velocity, j.runs[0].samples[i].velocity);
                }
            }
            free(rows);
            judge_close(&j);
            free(text);
        }
    }
}

/* What a run says of its velocity and, where there is one, of its current covers the truth, times what estimates of the
 * displacement are held to. */
static void hold_estimates(judged *j, const char *engine, double accuracy)
{
    dea_sample *rows = run_case(j, engine, accuracy);
    const dea_summary *summary = dea_layout_summary(&j->layout, rows);
    const dea_scales scales = dea_scales_open(&j->scene, j->scene.models[0]);
    const dea_sample scale = dea_scales_of(&scales, rows, j->layout.rows);
    const bool port = !isnan(rows[0].current);
    double v = 0.0, i = 0.0;
    for (size_t k = 0; k < j->layout.rows; k++) {
        v = fmax(v, fabs(rows[k].velocity - j->runs[0].samples[k].velocity) / scale.velocity);
        i = fmax(i, fabs(rows[k].current - j->runs[0].samples[k].current) / scale.current);
    }
    assert_true(v > 0.0 && v <= summary->velocity_error && summary->velocity_error <= 10.0 * accuracy);
    assert_true(!port || (i > 0.0 && i <= summary->current_error && summary->current_error <= 10.0 * accuracy));
    free(rows);
}

static void the_estimate_tells_the_error_of_a_rate(void **state)
{
    (void)state;
    static const struct {
        const char *name;
        double accuracy;
        bool ngspice;
    } cases[] = {{"move1", 1e-4, true}, {"columns_kicked", 1e-2, true}, {"columns_squeezed", 1e-2, true}, {"columns_narrow", 1e-3, false}};
    for (size_t c = 0; c < sizeof cases / sizeof *cases; c++) {
        char *text = read_case(cases[c].name);
        judged j;
        assert_true(judge_open(&j, text, c));
        if (cases[c].ngspice) {
            hold_estimates(&j, "ngspice", cases[c].accuracy);
        }
        hold_estimates(&j, "ida", cases[c].accuracy);
        judge_close(&j);
        free(text);
    }
}

/* A jump at the start past what its regions bear: the film has not moved yet, and runs away from there on. */
static void a_film_with_mass_is_at_rest_in_its_first_row(void **state)
{
    (void)state;
    char *text = read_case("columns_gone_at_once");
    judged j;
    assert_true(judge_open(&j, text, 0));
    hold(&j, "ngspice", 1e-3);
    assert_int_equal(j.runs[0].good, 1);
    assert_true(j.runs[0].samples[0].displacement == 0.0);
    judge_close(&j);
    free(text);
}

/* The electrical port by its own two laws: what the resistance leaves, and q = C U. */
static void film_voltage_is_what_the_resistance_leaves(void **state)
{
    (void)state;
    for (int e = 0; e < 2; e++) {
        char *text = read_case("columns_film_voltage");
        judged j;
        assert_true(judge_open(&j, text, 0));
        j.scene.full = true;
        dea_sample *rows = run_case(&j, e == 0 ? "ngspice" : "ida", 1e-4);
        dea_dynamics film;
        assert_int_equal(dea_dynamics_open(&j.scene, j.scene.models[0], &film, NULL), DEA_OK);
        double most = 0.0;
        for (size_t i = 0; i < j.layout.rows; i++) {
            const double drop = j.scene.drive.series_resistance * rows[i].current;
            assert_near(rows[i].film_voltage, rows[i].voltage - drop, 1e-9 * 4500.0);
            const double capacitance = dea_dynamics_edge(&film, rows[i].displacement).capacitance;
            assert_near(rows[i].charge, capacitance * rows[i].film_voltage, 1e-9 * capacitance * 4500.0);
            most = fmax(most, fabs(drop));
        }
        assert_true(most > 10.0); /* volts: there is something to see */
        dea_dynamics_close(&film);
        free(rows);
        judge_close(&j);
        free(text);
    }
}

/* Liquid of fixed volume under a lens: 22 mm at rest. */
static void focal_length_shortens_with_the_voltage(void **state)
{
    (void)state;
    static const double wanted[] = {22.0, 21.4708, 19.8397, 17.0122};
    static const char *const engines[] = {"direct", "ngspice", "ida"};
    char *text = read_case("lens_focal_sweep");
    judged j;
    assert_true(judge_open(&j, text, 0));
    for (size_t e = 0; e < 3; e++) {
        dea_error error = {0};
        dea_row rows[4];
        void *user[2] = {&j, rows};
        const dea_run_options options = {.jobs = 1, .points = take_points, .user = user};
        assert_int_equal(dea_study_run(&j.scene, dea_engine_find(engines[e]), &options, &error), DEA_OK);
        for (size_t i = 0; i < 4; i++) {
            assert_printed(1e3 * rows[i].focal_length, wanted[i], 4);
        }
    }
    judge_close(&j);
    free(text);
}

/* ---- judges */

static dea_status ida_run(void *session, const dea_scene *scene, const dea_model *model, dea_sample *samples,
                          dea_summary *summary, dea_error *error)
{
    return dea_engine_find("ida")->transient(session, scene, model, samples, summary, error);
}

static dea_status run_badly(void *session, const dea_scene *scene, const dea_model *model, dea_sample *samples,
                            dea_summary *summary, dea_error *error)
{
    const dea_status status = ida_run(session, scene, model, samples, summary, error);
    for (size_t i = 0; i < dea_layout_of(scene).rows; i++) {
        samples[i].velocity *= 1.0 + 30.0 * scene->accuracy;
    }
    return status;
}

static void a_velocity_off_by_thirty_times_the_accuracy_is_found(void **state)
{
    (void)state;
    char *text = read_case("columns_damper"), line[LINE] = "";
    dea_engine bad = *dea_engine_find("ida");
    bad.transient = run_badly;
    judged j;
    tally counted = {0};
    assert_true(judge_open(&j, text, 0));
    assert_true(judge_engine(&j, &bad, 1e-4, &counted, line, sizeof line));
    assert_non_null(strstr(line, "velocity"));
    assert_true(counted.worst > 2.8 && counted.worst < 3.2);
    judge_close(&j);
    free(text);
}

static void check_compares_velocity_by_its_scale(void **state)
{
    (void)state;
    dea_scene scene = step_scene(0.0);
    scene.material.retardation = 1e-3;
    dea_comparison comparison;
    assert_int_equal(dea_comparison_open(&comparison, &scene, NULL), DEA_OK);
    char *point = calloc(1, comparison.layout.point_size);
    dea_sample *rows = (dea_sample *)(void *)point;
    for (size_t i = 0; i < comparison.layout.rows; i++) {
        rows[i] = (dea_sample){.displacement = 1e-3, .velocity = 4.0, .state = DEA_STATE_OK};
    }
    *dea_layout_summary(&comparison.layout, point) = dea_summary_failed();
    assert_int_equal(dea_comparison_take(&comparison, 0, point, 1, NULL), DEA_OK);
    comparison.filling = false;
    rows[3].velocity = 4.4;
    assert_int_equal(dea_comparison_take(&comparison, 0, point, 1, NULL), DEA_OK);
    assert_relative(dea_comparison_worst(&comparison), 0.01, 1e-12); /* a tenth of its peak, of ten promised */
    rows[3].velocity = 4.0;
    rows[3].displacement = 1.02e-3;
    dea_comparison_forget(&comparison);
    assert_int_equal(dea_comparison_take(&comparison, 0, point, 1, NULL), DEA_OK);
    assert_relative(dea_comparison_worst(&comparison), 0.02, 1e-10);
    dea_comparison_close(&comparison);
    free(point);
}

static void the_program_tells_and_compares_rates(void **state)
{
    (void)state;
    char *text = read_case("move1");
    file_write("move1.yaml", text, strlen(text));
    free(text);
    RUN("run", "move1.yaml", "--engine", "ngspice", "-o", "move1.csv");
    assert_status(0);
    assert_non_null(strstr(child_err, " of the largest displacement (velocity "));
    assert_non_null(strstr(child_err, ", current "));
    RUN("check", "move1.yaml");
    assert_status(0);
    assert_non_null(strstr(child_out, "velocity"));
    assert_non_null(strstr(child_out, "current"));
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(the_fastest_time_is_that_of_the_edge_or_of_the_film),
        cmocka_unit_test(a_scale_is_the_peak_unless_samples_miss_it),
        cmocka_unit_test(every_column_is_within_ten_times_the_accuracy),
        cmocka_unit_test(every_column_at_rest_is_within_the_accuracy),
        cmocka_unit_test(film_voltage_is_what_the_resistance_leaves),
        cmocka_unit_test(focal_length_shortens_with_the_voltage),
        cmocka_unit_test(the_velocity_of_a_slow_film_has_its_sign_and_size),
        cmocka_unit_test(the_estimate_tells_the_error_of_a_rate),
        cmocka_unit_test(a_film_with_mass_is_at_rest_in_its_first_row),
        cmocka_unit_test(a_velocity_off_by_thirty_times_the_accuracy_is_found),
        cmocka_unit_test(check_compares_velocity_by_its_scale),
        cmocka_unit_test(the_program_tells_and_compares_rates),
    };
    return cmocka_run_group_tests(tests, child_enter, child_leave);
}
