/* Every law in networks: engines that share no formula agree in statics, time and frequency, and tiny strains keep their digits.
 */
#include "films.h"

#include <stdlib.h>

#include "network/balance.h"

static const char *const models[] = {"lumped", "lame", "coverage", "ring", "constant_force"};
enum { MODELS = 5, MOVING = 4 };

static dea_scene scene_of(const film *f, dea_kind kind, const char *model, double prestretch, double coverage)
{
    dea_scene scene = paper_scene(kind, prestretch, coverage, 0.0);
    set_law(&scene, f);
    scene.material.permittivity = 4.7;
    scene.actuator.film_thickness = 250e-6;
    scene.models[0] = dea_model_find(model);
    scene.accuracy = 1e-8;
    return scene;
}

/* Least voltage that the model's own equation has no equilibrium for, or one with a strain past 0.4. */
static double most_voltage(dea_scene scene, const char *model)
{
    double below = 0.0, above = 1e6;
    for (int i = 0; i < 50; i++) {
        scene.drive.voltage = 0.5 * (below + above);
        const dea_row row = solve_direct(&scene, model);
        *(row.state == DEA_STATE_PULL_IN || fabs(row.strain) > 0.4 ? &above : &below) = scene.drive.voltage;
    }
    return above;
}

enum { MOST = 1 << 18 };

typedef struct answer {
    size_t size;
    _Alignas(16) char bytes[MOST];
} answer;

static dea_status take(void *user, size_t first, const void *points, size_t count, dea_error *error)
{
    answer *a = user;
    (void)error;
    const size_t size = count * a->size;
    assert_true((first + count) * a->size <= MOST);
    memcpy(a->bytes + first * a->size, points, size);
    return DEA_OK;
}

static void run(const dea_scene *scene, const char *engine, answer *a)
{
    dea_error error = {0};
    a->size = dea_layout_of(scene).point_size;
    const dea_run_options options = {.jobs = 1, .points = take, .user = a};
    if (dea_study_run(scene, dea_engine_find(engine), &options, &error) != DEA_OK) {
        fail_msg("%s, %s, %s: %s", engine, scene->material.law->name, scene->models[0]->name, error.message);
    }
}

static answer one, other;

static const char *const network_engines[] = {"ida", "ngspice"};

enum { VOLTAGES = 6 };

/* Up to and past the pull-in of the model's own equation. */
static void statics_of_every_law_agree(void **state)
{
    (void)state;
    for (size_t i = 0; i < FILMS; i++) {
        for (size_t m = 0; m < MODELS; m++) {
            const dea_kind kind = dea_model_find(models[m])->lens && (i + m) % 2 ? DEA_LENS : DEA_DOT;
            dea_scene scene = scene_of(&films[i], kind, models[m], i % 3 ? 1.2 : 2.0, 0.25 + 0.1 * (double)i);
            const double most = most_voltage(scene, models[m]);
            double voltages[VOLTAGES];
            dea_axis axis;
            for (int k = 0; k < VOLTAGES; k++) {
                voltages[k] = most * (double[]){0.0, 1e-3, 0.2, 0.6, 0.95, 1.1}[k];
            }
            add_axis(&scene, &axis, &scene.drive.voltage, voltages, VOLTAGES);
            run(&scene, "direct", &one);
            const dea_row *wanted = (const dea_row *)one.bytes;
            for (size_t e = 0; e < 2; e++) {
                run(&scene, network_engines[e], &other);
                const dea_row *rows = (const dea_row *)other.bytes;
                for (int k = 0; k < VOLTAGES; k++) {
                    if (e == 1 && voltages[k] > 5e4 && rows[k].state == DEA_STATE_FAILED && isnan(rows[k].strain)) {
                        continue;
                    }
                    if (rows[k].state != wanted[k].state ||
                        (wanted[k].state != DEA_STATE_PULL_IN && !is_close(rows[k].strain, wanted[k].strain, 1e-8, 1e-18))) {
                        fail_msg("%s, %s, %s, %g V: %s %.12g, direct %s %.12g", films[i].law, models[m], network_engines[e],
                                 voltages[k], dea_state_name(rows[k].state), rows[k].strain, dea_state_name(wanted[k].state),
                                 wanted[k].strain);
                    }
                }
            }
        }
    }
}

/* Newton's step from the model's own answer is no more than rounding of it. */
static void tiny_strains_keep_twelve_digits_in_networks(void **state)
{
    (void)state;
    static const double strains[] = {1e-6, 1e-9, 1e-12};
    for (size_t i = 0; i < FILMS; i++) {
        for (size_t m = 0; m < MODELS; m++) {
            for (size_t k = 0; k < sizeof strains / sizeof *strains; k++) {
                dea_scene scene = scene_of(&films[i], DEA_DOT, models[m], 1.3, 0.4);
                scene.drive.voltage = 100.0;
                const double there = solve_direct(&scene, models[m]).strain;
                scene.drive.voltage *= sqrt(strains[k] / there);
                const dea_row wanted = solve_direct(&scene, models[m]);
                assert_relative(wanted.strain, strains[k], 0.01);
                dea_network network;
                dea_balance balance;
                assert_int_equal(dea_network_build(&scene, scene.models[0], NULL, &network, NULL), DEA_OK);
                assert_int_equal(dea_balance_open(&network, &balance, NULL), DEA_OK);
                const dea_forces f = dea_balance_forces(&balance, 0.0, wanted.displacement);
                const double step = (f.elastic - f.load) / (f.elastic_slope - f.load_slope);
                if (!(fabs(step) <= 1e-12 * wanted.displacement)) {
                    fail_msg("%s, %s, strain %g: relative step %g", films[i].law, models[m], strains[k],
                             step / wanted.displacement);
                }
                dea_balance_close(&balance);
                dea_network_free(&network);
            }
        }
    }
}

static dea_scene moving_scene(const film *f, const char *model, dea_kind kind)
{
    dea_scene scene = scene_of(f, kind, model, 1.3, 0.5);
    scene.material.density = 1000.0;
    scene.material.retardation = 2e-4;
    scene.material.prony_count = 1;
    scene.material.prony[0] = (dea_prony){0.1, 5e-3};
    scene.drive.series_resistance = 1e5;
    scene.accuracy = 1e-5;
    return scene;
}

static void transients_of_every_law_agree(void **state)
{
    (void)state;
    for (size_t i = 0; i < FILMS; i++) {
        const char *model = models[i % 2 ? 2 : 3];
        dea_scene scene = moving_scene(&films[i], model, i % 3 ? DEA_DOT : DEA_LENS);
        const double voltage = 0.5 * most_voltage(scene, model);
        scene.study = DEA_STUDY_TRANSIENT;
        scene.drive.voltage = (double)NAN;
        scene.transient = (dea_transient){.until = 0.02, .every = 1e-3};
        scene.drive.waveform = (dea_waveform){.kind = DEA_WAVE_STEP,
                                              .step = {.on = 1e-3, .off = (double)NAN, .voltage = voltage, .rise = 1e-4},
                                              .period = (double)NAN};
        run(&scene, "ida", &one);
        run(&scene, "ngspice", &other);
        const dea_layout layout = dea_layout_of(&scene);
        const dea_sample *a = (const dea_sample *)one.bytes, *b = (const dea_sample *)other.bytes;
        double peak = 0.0;
        for (size_t k = 0; k < layout.rows; k++) {
            peak = fmax(peak, fabs(a[k].displacement));
        }
        assert_true(peak > 1e-5);
        for (size_t k = 0; k < layout.rows; k++) {
            if (a[k].state != b[k].state || !is_close(a[k].displacement, b[k].displacement, 0.0, 2e-5 * peak)) {
                fail_msg("%s, %s, %g s: ida %s %.9g, ngspice %s %.9g", films[i].law, model, a[k].time, dea_state_name(a[k].state),
                         a[k].displacement, dea_state_name(b[k].state), b[k].displacement);
            }
        }
    }
}

static void responses_of_every_law_agree(void **state)
{
    (void)state;
    for (size_t i = 0; i < FILMS; i++) {
        for (size_t m = 0; m < MOVING; m++) {
            dea_scene scene = moving_scene(&films[i], models[m], (i + m) % 2 ? DEA_DOT : DEA_LENS);
            scene.study = DEA_STUDY_AC;
            scene.ac = (dea_ac){.from = 10.0, .to = 2000.0, .points_per_decade = 3, .bias = 0.5 * most_voltage(scene, models[m])};
            scene.drive.voltage = (double)NAN;
            run(&scene, "direct", &one);
            run(&scene, "ngspice", &other);
            const dea_layout layout = dea_layout_of(&scene);
            const dea_response *a = (const dea_response *)one.bytes, *b = (const dea_response *)other.bytes;
            for (size_t k = 0; k < layout.rows; k++) {
                if (a[k].state != b[k].state || !is_close(b[k].displacement, a[k].displacement, 1e-7, 0.0) ||
                    !is_close(b[k].impedance, a[k].impedance, 1e-7, 0.0)) {
                    fail_msg("%s, %s, %g Hz: direct %s %.9g, ngspice %s %.9g", films[i].law, models[m], a[k].frequency,
                             dea_state_name(a[k].state), a[k].displacement, dea_state_name(b[k].state), b[k].displacement);
                }
            }
        }
    }
}

/* A film of Gent's law whose chains are straight soon: driven far past what it bears it stops short of that stretch, pulls in, or
 * is not one at all, and every engine says the same; within a hundredth of the end ngspice may say failed. */
static void gent_film_past_its_limit_has_a_named_state(void **state)
{
    (void)state;
    const film stiff = {"gent", {45e3, 2.0}, 1};
    for (int n = 0; n < 12; n++) {
        const char *model = models[n % 2 ? 2 + n / 2 % 2 : 4];
        const dea_kind kind = n % 2 && n > 5 ? DEA_LENS : DEA_DOT;
        dea_scene scene = scene_of(&stiff, kind, model, n % 4 < 2 ? 1.3 : 1.55, 0.2 + 0.06 * n);
        scene.accuracy = 1e-7;
        double voltages[VOLTAGES] = {1e3, 5e3, 1e4, 2e4, 1e5, 1e6};
        dea_axis axis;
        add_axis(&scene, &axis, &scene.drive.voltage, voltages, VOLTAGES);
        run(&scene, "direct", &one);
        const dea_row *wanted = (const dea_row *)one.bytes;
        for (size_t e = 0; e < 2; e++) {
            run(&scene, network_engines[e], &other);
            const dea_row *rows = (const dea_row *)other.bytes;
            for (int k = 0; k < VOLTAGES; k++) {
                const bool numbers = wanted[k].state != DEA_STATE_PULL_IN && wanted[k].state != DEA_STATE_FAILED;
                if (e == 1 && voltages[k] > 5e4 && rows[k].state == DEA_STATE_FAILED && isnan(rows[k].strain)) {
                    continue;
                }
                if (rows[k].state != wanted[k].state || (numbers && !is_close(rows[k].strain, wanted[k].strain, 1e-6, 0.0))) {
                    fail_msg("%d, %s, %s, %g V: %s %.12g, direct %s %.12g", n, model, network_engines[e], voltages[k],
                             dea_state_name(rows[k].state), rows[k].strain, dea_state_name(wanted[k].state), wanted[k].strain);
                }
            }
        }
    }
}

/* The state of a response is that of the film under its bias, not at rest: with a mass it hangs on the bias like a row of a sweep. */
static void a_response_has_the_state_of_its_bias(void **state)
{
    (void)state;
    static const char *const engines[] = {"direct", "ngspice"};
    const double voltages[] = {3e3, 10e3, 20e3, 30e3, 50e3};
    size_t states[DEA_STATE_FAILED + 1] = {0};
    for (size_t k = 0; k < 2 * sizeof voltages / sizeof *voltages; k++) {
        dea_scene scene = moving_scene(&films[0], "lumped", DEA_DOT);
        scene.study = DEA_STUDY_AC;
        scene.ac = (dea_ac){.from = 10.0, .to = 20.0, .points_per_decade = 3, .bias = voltages[k / 2]};
        scene.drive.voltage = scene.ac.bias;
        const dea_row row = solve_direct(&scene, "lumped");
        const bool framed = row.displacement < scene.actuator.frame_radius * (1.0 - scene.actuator.coverage);
        run(&scene, engines[k % 2], &one);
        const dea_state found = ((const dea_response *)one.bytes)->state, wanted = framed ? row.state : DEA_STATE_PULL_IN;
        assert_int_equal(found, wanted);
        states[found]++;
    }
    assert_true(states[DEA_STATE_OK] > 0 && states[DEA_STATE_OK] < 10);
}

/* A film of Ogden's whose exponent is just above 4 holds any voltage without a frame, at a thousand times its size: no fold, however
 * coarse the accuracy. */
static void a_film_without_a_fold_is_followed_far(void **state)
{
    (void)state;
    const film soft = {"ogden", {22862.88, 4.25955}, 1};
    dea_scene scene = scene_of(&soft, DEA_DOT, "constant_force", 1.344, 0.5);
    double voltages[VOLTAGES] = {1e3, 3e3, 1e4, 1.1e4, 1.3e4, 1.6e4};
    const double accuracies[] = {1e-2, 1e-8};
    dea_axis axis;
    add_axis(&scene, &axis, &scene.drive.voltage, voltages, VOLTAGES);
    run(&scene, "direct", &one);
    const dea_row *wanted = (const dea_row *)one.bytes;
    assert_true(wanted[VOLTAGES - 1].strain > 1000.0);
    for (int k = 0; k < 2; k++) {
        scene.accuracy = accuracies[k];
        run(&scene, "ida", &other);
        const dea_row *rows = (const dea_row *)other.bytes;
        for (int i = 0; i < VOLTAGES; i++) {
            assert_int_equal(rows[i].state, wanted[i].state);
            assert_true(is_close(rows[i].strain, wanted[i].strain, accuracies[k], 0.0));
        }
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(statics_of_every_law_agree),
        cmocka_unit_test(tiny_strains_keep_twelve_digits_in_networks),
        cmocka_unit_test(transients_of_every_law_agree),
        cmocka_unit_test(responses_of_every_law_agree),
        cmocka_unit_test(a_response_has_the_state_of_its_bias),
        cmocka_unit_test(a_film_without_a_fold_is_followed_far),
        cmocka_unit_test(gent_film_past_its_limit_has_a_named_state),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
