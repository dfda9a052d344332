/* Work against precision: what is marked, what stands for what, and whether settings deliver what they promise. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/wait.h>
#include <unistd.h>

#include "bench/work.h"
#include "deaspice/deaspice.h"
#include "judges.h"

enum { SETTINGS = 8, TEXT_LENGTH = 1 << 15 };

#define FILM "actuator: {kind: dot, frame_radius: 30 mm, coverage: 0.5, film_thickness: 100 um, prestretch: 1.2}\n"

static const char sweep_scene[] = FILM "material: {yeoh: {C1: 178426 Pa, C2: -6023 Pa, C3: 4234 Pa}, permittivity: 2.8}\n"
                                       "drive: {voltage: 4500 V}\nmodel: lumped\n"
                                       "study: {sweep: {coverage: [0.25, 0.5]}}\n";
static const char step_scene[] = FILM "material: {base: elastosil-2030, retardation: 0.5 ms}\n"
                                      "drive: {waveform: {step: {on: 1 ms, voltage: 4500 V, rise: 1 us}}}\nmodel: coverage\n"
                                      "study: {transient: {until: 20 ms, every: 0.2 ms}}\n";
static const char response_scene[] = FILM "material: {base: elastosil-2030, retardation: 0.1 ms}\n"
                                          "drive: {voltage: 3 kV}\nmodel: lame\n"
                                          "study: {ac: {from: 1 Hz, to: 10 kHz, points_per_decade: 10}}\n";

static dea_scene parse(const char *text)
{
    dea_scene scene;
    dea_error error = {0};
    if (dea_scene_parse(text, strlen(text), "test", ".", NULL, 0, NULL, &scene, &error) != DEA_OK) {
        fail_msg("%s", error.message);
    }
    return scene;
}

/* A budget [s] that a loaded machine under sanitizers does not use up: each ladder ends by its own rungs. */
static const double ample = 1000.0;

static dea_bench run_bench(const dea_scene *scene, double budget, const char *engine)
{
    dea_bench bench;
    dea_error error = {0};
    dea_bench_options options = dea_bench_options_default();
    options.runs = 2;
    options.enough = 0.0;
    options.budget = budget;
    options.engine = engine ? dea_engine_find(engine) : NULL;
    if (dea_bench_run(scene, &options, &bench, &error) != DEA_OK) {
        fail_msg("%s", error.message);
    }
    return bench;
}

/* ---- made-up numbers */

static dea_bench_setting made_up(const char *engine, double accuracy, double seconds, double error)
{
    return (dea_bench_setting){.engine = dea_engine_find(engine),
                               .loosest = accuracy,
                               .accuracy = accuracy,
                               .state = DEA_BENCH_MEASURED,
                               .seconds = seconds,
                               .error = error};
}

static dea_bench conclude(dea_bench_setting *settings, size_t count, dea_bench_model *models, size_t model_count)
{
    dea_bench bench = {.models = models, .model_count = model_count, .settings = settings, .setting_count = count};
    dea_bench_conclude(&bench);
    return bench;
}

static void a_setting_is_dominated_by_one_that_is_faster_and_no_worse_or_better_and_no_slower(void **state)
{
    (void)state;
    dea_bench_model models[] = {{.reference = dea_engine_find("direct"), .exact = true},
                                {.reference = dea_engine_find("direct"), .exact = true}};
    dea_bench_setting settings[] = {
        made_up("ida", 1e-2, 1.0, 1e-3),     /* nothing is faster */
        made_up("ida", 1e-3, 2.0, 1e-4),     /* on the front */
        made_up("ida", 1e-4, 3.0, 1e-4),     /* slower, no better: dominated */
        made_up("ngspice", 1e-2, 1.0, 2e-3), /* as fast, worse: dominated */
        made_up("ngspice", 1e-3, 2.0, 1e-4), /* equal in both: neither beats the other */
        made_up("ngspice", 1e-6, 9.0, 1e-9), /* slowest, but best */
        made_up("direct", 1e-6, 0.5, 1e-12), /* of another model: beats nobody here */
    };
    const bool dominated[] = {false, false, true, true, false, false, false};
    settings[6].model = 1;
    conclude(settings, 7, models, 2);
    for (size_t i = 0; i < 7; i++) {
        assert_int_equal(settings[i].dominated, dominated[i]);
    }
}

static void a_setting_that_lost_rows_dominates_nobody(void **state)
{
    (void)state;
    dea_bench_model model = {.reference = dea_engine_find("direct"), .exact = true};
    dea_bench_setting settings[] = {made_up("ida", 1e-2, 1.0, 1e-9), made_up("ida", 1e-3, 2.0, 1e-4),
                                    made_up("ngspice", 1e-3, 1.0, 1e-9)};
    settings[0].failed = 1;
    settings[2].states = 1;
    conclude(settings, 3, &model, 1);
    assert_false(settings[1].dominated);
}

static void an_error_above_the_accuracy_breaks_the_promise(void **state)
{
    (void)state;
    dea_bench_model model = {.reference = dea_engine_find("direct"), .reference_accuracy = 1e-12, .exact = true};
    dea_bench_setting settings[] = {made_up("ida", 1e-3, 1.0, 0.9e-3), made_up("ida", 1e-4, 1.0, 1.1e-4),
                                    made_up("ida", 1e-5, 1.0, (double)NAN), made_up("ida", 1e-6, 1.0, 0.0)};
    settings[3].states = 1;
    conclude(settings, 4, &model, 1);
    assert_false(settings[0].broken);
    assert_true(settings[1].broken);
    assert_true(settings[2].broken);
    assert_true(settings[3].broken);
}

static void an_inexact_reference_may_be_off_by_its_own_accuracy(void **state)
{
    (void)state;
    dea_bench_model model = {.reference = dea_engine_find("ida"), .reference_accuracy = 1e-6};
    dea_bench_setting settings[] = {made_up("ngspice", 1e-6, 1.0, 1.9e-6), made_up("ngspice", 1e-6, 1.0, 2.1e-6)};
    conclude(settings, 2, &model, 1);
    assert_false(settings[0].broken);
    assert_true(settings[1].broken);
}

static void the_nearest_other_engine_checks_the_reference(void **state)
{
    (void)state;
    dea_bench_model model = {.reference = dea_engine_find("ida"), .reference_accuracy = 1e-9};
    dea_bench_setting settings[] = {made_up("ngspice", 1e-3, 1.0, 1e-4), made_up("ngspice", 1e-6, 2.0, 2e-8),
                                    made_up("ida", 1e-8, 1.0, 1e-10)};
    conclude(settings, 3, &model, 1);
    assert_ptr_equal(model.check, dea_engine_find("ngspice"));
    assert_true(model.apart == 2e-8 && model.check_accuracy == 1e-6);
}

static void settings_with_the_same_numbers_share_one_row(void **state)
{
    (void)state;
    dea_bench_setting settings[SETTINGS];
    dea_bench_times times[SETTINGS];
    dea_bench bench = {.settings = settings};
    const struct {
        double accuracy;
        uint64_t digest;
    } rungs[] = {{1e-2, 7}, {1e-3, 7}, {1e-4, 9}, {1e-5, 7}, {1e-6, 7}};
    for (size_t i = 0; i < 5; i++) {
        const dea_bench_setting setting = made_up("ida", rungs[i].accuracy, 1.0, 0.0);
        const dea_bench_times time = {.digest = rungs[i].digest};
        dea_bench_take(&bench, times, &setting, &time);
    }
    const dea_bench_setting other = made_up("ngspice", 1e-2, 1.0, 0.0);
    const dea_bench_times time = {.digest = 7};
    dea_bench_take(&bench, times, &other, &time);
    assert_int_equal(bench.setting_count, 4);
    assert_true(settings[0].loosest == 1e-2 && settings[0].accuracy == 1e-3);
    assert_true(settings[1].loosest == 1e-4 && settings[1].accuracy == 1e-4);
    assert_true(settings[2].loosest == 1e-5 && settings[2].accuracy == 1e-6);
    assert_ptr_equal(settings[3].engine, other.engine);
}

static void the_digest_sees_the_last_bit_and_the_state(void **state)
{
    (void)state;
    const dea_scene scene = parse(sweep_scene);
    const dea_layout layout = dea_layout_of(&scene);
    const dea_row row = {.strain = 0.1, .displacement = 1e-4, .force = 2.0, .field = 3e7, .state = DEA_STATE_OK};
    dea_row changed = row, past = row;
    changed.force = nextafter(row.force, 3.0);
    past.state = DEA_STATE_SLACK;
    const uint64_t digest = dea_bench_digest(&layout, (const char *)&row, 1);
    assert_true(digest == dea_bench_digest(&layout, (const char *)&row, 1));
    assert_true(digest != dea_bench_digest(&layout, (const char *)&changed, 1));
    assert_true(digest != dea_bench_digest(&layout, (const char *)&past, 1));
    dea_scene_free((dea_scene *)(uintptr_t)&scene);
}

static void times_are_told_by_their_quartiles(void **state)
{
    (void)state;
    double seconds[] = {5.0, 1.0, 4.0, 2.0, 3.0}, one[] = {7.0}, two[] = {2.0, 1.0};
    dea_bench_setting setting = {0};
    dea_bench_summarise(&setting, seconds, 5);
    assert_true(setting.runs == 5 && setting.seconds == 3.0 && setting.fastest == 1.0 && setting.slowest == 5.0);
    assert_true(setting.lower == 2.0 && setting.upper == 4.0);
    dea_bench_summarise(&setting, one, 1);
    assert_true(setting.runs == 1 && setting.seconds == 7.0 && setting.lower == 7.0 && setting.slowest == 7.0);
    dea_bench_summarise(&setting, two, 2);
    assert_true(setting.seconds == 1.5);
}

/* ---- references */

static const char *best_of(const char *text, const char *model)
{
    dea_scene scene = parse(text);
    scene.models[0] = dea_model_find(model);
    const dea_engine *best = dea_bench_best(&scene);
    dea_scene_free(&scene);
    return best ? best->name : "";
}

static void the_reference_is_the_engine_that_promises_most(void **state)
{
    (void)state;
    assert_string_equal(best_of(sweep_scene, "lumped"), "direct");
    assert_string_equal(best_of(sweep_scene, "field"), "direct");
    assert_string_equal(best_of(step_scene, "lumped"), "direct");
    assert_string_equal(best_of(step_scene, "coverage"), "ida"); /* no closed form; ngspice promises 1e-6 */
    assert_string_equal(best_of(response_scene, "lame"), "direct");
    assert_string_equal(best_of(step_scene, "pelrine"), "");
}

/* ---- studies from end to end */

/* Every setting is measured or says why not, and what is measured keeps its promise. */
static void check_promises(const dea_bench *bench)
{
    assert_true(bench->setting_count > 0);
    for (size_t i = 0; i < bench->setting_count; i++) {
        const dea_bench_setting *setting = &bench->settings[i];
        if (setting->state != DEA_BENCH_MEASURED) {
            assert_true(setting->reason[0] != '\0');
            continue;
        }
        assert_true(setting->runs >= 1 && setting->fastest > 0.0 && setting->fastest <= setting->lower);
        assert_true(setting->lower <= setting->seconds && setting->seconds <= setting->upper);
        assert_true(setting->upper <= setting->slowest && setting->start >= 0.0 && setting->loosest >= setting->accuracy);
        assert_false(setting->broken);
        assert_int_equal(setting->states, 0);
        assert_int_equal(setting->failed, 0);
        if (!(setting->error <= setting->accuracy)) {
            fail_msg("%s, %s at %g delivers %g", bench->models[setting->model].model->name, setting->engine->name,
                     setting->accuracy, setting->error);
        }
    }
}

static const dea_bench_setting *find(const dea_bench *bench, const char *model, const char *engine)
{
    for (size_t i = 0; i < bench->setting_count; i++) {
        const dea_bench_setting *setting = &bench->settings[i];
        if (strcmp(bench->models[setting->model].model->name, model) == 0 && strcmp(setting->engine->name, engine) == 0) {
            return setting;
        }
    }
    fail_msg("no row of %s and %s", model, engine);
    return NULL;
}

static const dea_bench_model *model_of(const dea_bench *bench, const char *name)
{
    for (size_t i = 0; i < bench->model_count; i++) {
        if (strcmp(bench->models[i].model->name, name) == 0) {
            return &bench->models[i];
        }
    }
    fail_msg("no model %s", name);
    return NULL;
}

/* The two rows of prestretch 1.2 in physics.md, section 3. */
static void check_model_error(const dea_bench *bench, const char *name, double quarter, double half)
{
    const double field[] = {0.06092621, 0.04503297};
    const double first = fabs(quarter / field[0] - 1.0), second = fabs(half / field[1] - 1.0);
    const dea_bench_model *model = model_of(bench, name);
    assert_int_equal(model->error_points, 2);
    assert_int_equal(model->error_left_out, 0);
    assert_true(fabs(model->error_median - 0.5 * (first + second)) < 1e-6);
    assert_true(fabs(model->error_worst - fmax(first, second)) < 1e-6);
}

static void a_sweep_tells_numerical_errors_and_those_of_the_models(void **state)
{
    (void)state;
    dea_scene scene = parse(sweep_scene);
    dea_bench_all_models(&scene);
    assert_int_equal(scene.model_count, dea_model_count());
    dea_bench bench = run_bench(&scene, ample, NULL);
    check_promises(&bench);
    check_model_error(&bench, "coverage", 0.05973380, 0.03569962);
    check_model_error(&bench, "lumped", 0.05612602, 0.03741735);
    check_model_error(&bench, "lame", 0.05689016, 0.04400989);
    assert_true(isnan(model_of(&bench, "field")->error_worst));
    assert_true(bench.units == 2.0 && strcmp(bench.unit, "point") == 0);
    const dea_bench_setting *closed = find(&bench, "lumped", "direct");
    assert_true(closed->any && closed->reference && model_of(&bench, "lumped")->exact);
    assert_false(model_of(&bench, "field")->exact);
    const dea_bench_setting *refused = find(&bench, "pelrine", "ngspice");
    assert_int_equal(refused->state, DEA_BENCH_REFUSED);
    assert_non_null(strstr(refused->reason, "no network form"));
    dea_bench_free(&bench);
    dea_scene_free(&scene);
}

static void a_transient_without_a_closed_form_is_judged_by_ida_and_checked_by_ngspice(void **state)
{
    (void)state;
    dea_scene scene = parse(step_scene);
    dea_bench_all_models(&scene);
    assert_int_equal(scene.model_count, 5);
    scene.model_count = 4; /* the membrane is the last */
    dea_bench bench = run_bench(&scene, ample, NULL);
    check_promises(&bench);
    const dea_bench_model *coverage = model_of(&bench, "coverage");
    assert_string_equal(coverage->reference->name, "ida");
    assert_true(coverage->reference_accuracy <= 1.1e-6 && !coverage->exact);
    assert_string_equal(coverage->check->name, "ngspice");
    assert_true(coverage->apart > 0.0 && coverage->apart < 1e-4);
    assert_true(coverage->error_worst > coverage->error_rms && coverage->error_rms > 0.0);
    assert_string_equal(model_of(&bench, "lumped")->reference->name, "direct");
    assert_int_equal(find(&bench, "coverage", "direct")->state, DEA_BENCH_REFUSED);
    assert_true(fabs(bench.units / 0.02 - 1.0) < 1e-12 && strcmp(bench.unit, "simulated_second") == 0);
    dea_bench_free(&bench);
    dea_scene_free(&scene);
}

static void a_frequency_response_is_judged_row_by_row(void **state)
{
    (void)state;
    dea_scene scene = parse(response_scene);
    dea_bench bench = run_bench(&scene, ample, NULL);
    check_promises(&bench);
    assert_int_equal(bench.model_count, 1);
    assert_int_equal(bench.rows, 41);
    assert_true(bench.units == 41.0 && strcmp(bench.unit, "frequency") == 0);
    assert_int_equal(find(&bench, "lame", "ida")->state, DEA_BENCH_REFUSED);
    assert_int_equal(find(&bench, "lame", "ngspice")->state, DEA_BENCH_MEASURED);
    dea_bench_free(&bench);
    dea_scene_free(&scene);
}

static void a_wrong_answer_breaks_the_promise_of_a_whole_study(void **state)
{
    (void)state;
    dea_scene scene = parse(sweep_scene);
    dea_bench bench = {.scene = &scene};
    dea_bench_model model = {.model = scene.models[0], .reference = dea_engine_find("direct"), .exact = true};
    dea_bench_setting setting = made_up("ida", 1e-3, 1.0, (double)NAN);
    dea_bench_truth truth = {.scene = scene, .known = true};
    dea_row rows[2] = {{.strain = 0.1, .displacement = 1e-3, .force = 1.0, .field = 1e7, .state = DEA_STATE_OK},
                       {.strain = 0.2, .displacement = 2e-3, .force = 1.0, .field = 1e7, .state = DEA_STATE_OK}};
    dea_bench_work work = {
        .bench = &bench, .layout = dea_layout_of(&scene), .points = 2, .buffer = (char *)rows, .truths = &truth};
    bench.models = &model;
    bench.model_count = 1;
    bench.settings = &setting;
    bench.setting_count = 1;
    bench.rows = 2;
    assert_int_equal(dea_comparison_open(&truth.comparison, &scene, NULL), DEA_OK);
    dea_comparison_take(&truth.comparison, 0, rows, 2, NULL);
    truth.comparison.filling = false;
    rows[1].strain *= 1.002;
    dea_bench_judge(&work, &setting, 1);
    dea_bench_conclude(&bench);
    assert_true(fabs(setting.error - 0.002) < 1e-12);
    assert_true(setting.broken);
    dea_comparison_close(&truth.comparison);
    dea_scene_free(&scene);
}

static void what_the_budget_does_not_reach_is_listed_as_skipped(void **state)
{
    (void)state;
    dea_scene scene = parse(step_scene);
    dea_bench bench = run_bench(&scene, 1e-3, "ngspice");
    assert_int_equal(bench.setting_count, 2); /* the loosest runs in any case */
    assert_int_equal(bench.settings[0].state, DEA_BENCH_MEASURED);
    assert_int_equal(bench.settings[0].runs, 1);
    assert_int_equal(bench.settings[1].state, DEA_BENCH_SKIPPED);
    assert_true(bench.settings[1].loosest == 1e-3 && bench.settings[1].accuracy == 1e-6);
    assert_non_null(strstr(bench.settings[1].reason, "expected"));
    dea_bench_free(&bench);
    dea_scene_free(&scene);
}

static bool at_once(void *user)
{
    (void)user;
    return true;
}

static void an_interrupt_ends_the_study_and_leaves_nothing(void **state)
{
    (void)state;
    dea_scene scene = parse(sweep_scene);
    dea_bench bench;
    dea_error error = {0};
    dea_bench_options options = dea_bench_options_default();
    options.stop = at_once;
    assert_int_equal(dea_bench_run(&scene, &options, &bench, &error), DEA_ERROR_INTERRUPTED);
    assert_null(bench.settings);
    dea_scene_free(&scene);
}

/* ---- CSV, picture, program */

static void read_text(const char *path, char *text)
{
    FILE *file = fopen(path, "r");
    assert_non_null(file);
    text[fread(text, 1, TEXT_LENGTH - 1, file)] = '\0';
    fclose(file);
}

static size_t fields_of(const char *line)
{
    size_t fields = 1;
    bool quoted = false;
    for (; *line && *line != '\n'; line++) {
        quoted = quoted != (*line == '"');
        fields += *line == ',' && !quoted;
    }
    return fields;
}

/* Step of 4.5 kV within 0.1 ms: Eqs. 19-23 by Runge-Kutta against the membrane's strains at 1 and 2 ms (physics: section 7). */
static void a_transient_tells_what_its_models_are_off_by(void **state)
{
    (void)state;
    static const double field[] = {0.0, 0.0674155, 0.0333990};
    dea_scene scene = parse(FILM "material: {base: elastosil-2030, density: 1080 kg/m^3, retardation: 50 us}\n"
                                 "drive: {waveform: {step: {on: 0 s, voltage: 4500 V, rise: 0.1 ms}}}\nmodel: lumped\n"
                                 "study: {transient: {until: 2 ms, every: 1 ms}}\n");
    dea_bench bench = run_bench(&scene, ample, "direct");
    const dea_bench_model *lumped = model_of(&bench, "lumped");
    double worst = 0.0, squares = 0.0;
    lumped_state at = {0.0, 0.0};
    for (int i = 1; i <= 2000; i++) {
        at = lumped_move(&scene, 1391085.27, 1e-6 * (i - 1), 1e-6 * i, at);
        if (i % 1000 == 0) {
            const double error = fabs(at.u / 15e-3 - field[i / 1000]) / field[1];
            worst = fmax(worst, error);
            squares += error * error;
        }
    }
    assert_int_equal(lumped->error_points, 3);
    assert_true(worst > 0.02);
    assert_true(fabs(lumped->error_worst - worst) < 1e-4);
    assert_true(fabs(lumped->error_rms - sqrt(squares / 3.0)) < 1e-4);
    dea_bench_free(&bench);
    dea_scene_free(&scene);
}

static void the_csv_has_a_row_a_setting_and_empty_fields_where_there_is_no_number(void **state)
{
    (void)state;
    dea_bench_output *output;
    static char text[TEXT_LENGTH];
    char path[] = "/tmp/deaspice-bench-XXXXXX";
    dea_scene scene = parse(sweep_scene);
    dea_bench_model model = {.model = scene.models[0],
                             .reference = dea_engine_find("direct"),
                             .reference_accuracy = 1e-12,
                             .error_median = 0.25,
                             .error_worst = 0.5,
                             .error_rms = 0.375,
                             .error_points = 2};
    dea_bench_setting settings[] = {made_up("direct", 1e-12, 0.5, 0.0), made_up("ida", 1e-3, 0.25, 0.125),
                                    made_up("ngspice", (double)NAN, 0.0, (double)NAN)};
    settings[0].reference = true;
    settings[2].state = DEA_BENCH_REFUSED;
    snprintf(settings[2].reason, sizeof settings[2].reason, "a \"reason\", of words");
    dea_bench bench = {.scene = &scene,
                       .models = &model,
                       .model_count = 1,
                       .settings = settings,
                       .setting_count = 3,
                       .units = 2.0,
                       .unit = "point"};
    dea_bench_conclude(&bench);
    const int file = mkstemp(path);
    assert_true(file >= 0);
    close(file);
    assert_int_equal(dea_bench_output_open(path, NULL, NULL, &output, NULL), DEA_OK);
    assert_int_equal(dea_bench_output_finish(output, &bench, NULL), DEA_OK);
    read_text(path, text);
    unlink(path);
    assert_memory_equal(text, "model,engine,accuracy_loosest,accuracy,outcome,runs,time_s,", 59);
    size_t lines = 0;
    const size_t columns = fields_of(text);
    for (const char *line = text; *line; line = strchr(line, '\n') + 1) {
        assert_int_equal(fields_of(line), columns);
        lines++;
    }
    assert_int_equal(lines, 4);
    assert_non_null(strstr(text, ",point,0.25,,itself,"));
    assert_non_null(strstr(text, ",point,0.125,0.125,direct,"));
    assert_non_null(strstr(text, ",broken,0,0,0,0.25,0.5,2,,0.375,125\n"));
    assert_non_null(strstr(text, "lumped,ngspice,,,refused,"));
    assert_non_null(strstr(text, ",\"a \"\"reason\"\", of words\",0.375,\n"));
    dea_scene_free(&scene);
}

static void the_diagram_names_engines_models_and_accuracies(void **state)
{
    (void)state;
    static char text[1 << 20];
    char path[] = "/tmp/deaspice-bench-XXXXXX.svg";
    dea_error error = {0};
    dea_scene scene = parse(sweep_scene);
    scene.models[scene.model_count++] = dea_model_find("coverage");
    dea_bench bench = run_bench(&scene, ample, NULL);
    const int file = mkstemps(path, 4);
    assert_true(file >= 0);
    close(file);
    dea_bench_output *output;
    if (dea_bench_output_open(NULL, path, NULL, &output, &error) != DEA_OK ||
        dea_bench_output_finish(output, &bench, &error) != DEA_OK) {
        fail_msg("%s", error.message);
    }
    FILE *picture = fopen(path, "r");
    assert_non_null(picture);
    text[fread(text, 1, sizeof text - 1, picture)] = '\0';
    fclose(picture);
    unlink(path);
    const char *const words[] = {"direct",          "ngspice", "ida",  "lumped", "coverage", "Wall time per point",
                                 "Numerical error", "10⁻²",    "ref.", "</svg>"};
    for (size_t i = 0; i < sizeof words / sizeof *words; i++) {
        if (!strstr(text, words[i])) {
            fail_msg("the picture has no \"%s\"", words[i]);
        }
    }
    assert_int_equal(dea_bench_output_open(NULL, "/tmp/bench.jpg", NULL, &output, &error), DEA_ERROR_USAGE);
    assert_int_equal(dea_bench_output_open("/nowhere/bench.csv", NULL, NULL, &output, &error), DEA_ERROR_IO);
    assert_int_equal(dea_bench_output_finish(NULL, &bench, &error), DEA_OK);
    dea_bench_free(&bench);
    dea_scene_free(&scene);
}

/* Runs the program on the sweep; its standard output and exit status. */
static int run_program(const char *arguments, char *output)
{
    char path[] = "/tmp/deaspice-bench-XXXXXX.yaml", command[4096];
    const char *program = getenv("DEASPICE");
    const int file = mkstemps(path, 5);
    assert_true(file >= 0);
    assert_int_equal(write(file, sweep_scene, sizeof sweep_scene - 1), (ssize_t)sizeof sweep_scene - 1);
    close(file);
    snprintf(command, sizeof command, "%s bench %s %s 2>/dev/null", program ? program : "build/deaspice", arguments, path);
    FILE *pipe = popen(command, "r");
    assert_non_null(pipe);
    output[fread(output, 1, TEXT_LENGTH - 1, pipe)] = '\0';
    const int ended = pclose(pipe);
    unlink(path);
    return WIFEXITED(ended) ? WEXITSTATUS(ended) : -1;
}

static void the_program_prints_a_table_or_writes_csv(void **state)
{
    (void)state;
    static char output[TEXT_LENGTH];
    assert_int_equal(run_program("--budget 2 --runs 2 --model pelrine,lumped", output), 0);
    assert_non_null(strstr(output, "cannot: it has no network form"));
    assert_non_null(strstr(output, "any"));
    assert_non_null(strstr(output, "dominated"));
    assert_non_null(strstr(output, "error of the model: strain off from field by"));
    assert_int_equal(run_program("--budget 2 --runs 2 --model lumped --engine direct -o -", output), 0);
    assert_memory_equal(output, "model,engine,", 13);
    assert_int_equal(run_program("--budget 0", output), 2);
    assert_int_equal(run_program("--runs 0", output), 2);
    assert_int_equal(run_program("--plot x.jpg", output), 2);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_setting_is_dominated_by_one_that_is_faster_and_no_worse_or_better_and_no_slower),
        cmocka_unit_test(a_setting_that_lost_rows_dominates_nobody),
        cmocka_unit_test(an_error_above_the_accuracy_breaks_the_promise),
        cmocka_unit_test(an_inexact_reference_may_be_off_by_its_own_accuracy),
        cmocka_unit_test(the_nearest_other_engine_checks_the_reference),
        cmocka_unit_test(settings_with_the_same_numbers_share_one_row),
        cmocka_unit_test(the_digest_sees_the_last_bit_and_the_state),
        cmocka_unit_test(times_are_told_by_their_quartiles),
        cmocka_unit_test(the_reference_is_the_engine_that_promises_most),
        cmocka_unit_test(a_sweep_tells_numerical_errors_and_those_of_the_models),
        cmocka_unit_test(a_transient_without_a_closed_form_is_judged_by_ida_and_checked_by_ngspice),
        cmocka_unit_test(a_frequency_response_is_judged_row_by_row),
        cmocka_unit_test(a_wrong_answer_breaks_the_promise_of_a_whole_study),
        cmocka_unit_test(what_the_budget_does_not_reach_is_listed_as_skipped),
        cmocka_unit_test(an_interrupt_ends_the_study_and_leaves_nothing),
        cmocka_unit_test(a_transient_tells_what_its_models_are_off_by),
        cmocka_unit_test(the_csv_has_a_row_a_setting_and_empty_fields_where_there_is_no_number),
        cmocka_unit_test(the_diagram_names_engines_models_and_accuracies),
        cmocka_unit_test(the_program_prints_a_table_or_writes_csv),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
