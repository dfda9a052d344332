/* How far a lumped model is said to be from the membrane, against the table of the film of the base paper at 4.5 kV. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdio.h>
#include <string.h>

#include <cmocka.h>

#include "moving_membrane.h"
#include "needs/nearness.h"
#include "network/membrane.h"

#define FILM                                                                                                                     \
    "actuator: {kind: dot, frame_radius: 30 mm, coverage: 0.1, film_thickness: 100 um, prestretch: 1.1}\n"                       \
    "material: elastosil-2030\nmodel: lumped\n"
#define STATIC "drive: {voltage: 4500 V}\n"

static dea_nearness nearness_of(const char *text, const char *model)
{
    dea_scene scene;
    dea_error error = {0};
    dea_nearness near;
    if (dea_scene_parse(text, strlen(text), "t", NULL, NULL, 0, NULL, &scene, &error) != DEA_OK) {
        fail_msg("%s", error.message);
    }
    assert_int_equal(dea_nearness_measure(&scene, dea_model_find(model), &near, &error), DEA_OK);
    dea_scene_free(&scene);
    return near;
}

/* Strains of the membrane, of Eq. 22 and of Eq. 18 at pre-stretch 1.1, coverage 0.1. */
static const double field = 0.03762647, lumped = 0.04028821, coverage = 0.04587737;

static void a_point_is_off_as_its_table_says(void **state)
{
    (void)state;
    const dea_nearness near = nearness_of(FILM STATIC "study: {sweep: {}}\n", "lumped");
    assert_true(near.whole && near.compared == 1 && near.unlike == 0);
    assert_true(fabs(near.low - (lumped / field - 1.0)) < 1e-6 && near.low == near.high);
    const dea_nearness other = nearness_of(FILM STATIC "study: {sweep: {}}\n", "coverage");
    assert_true(fabs(other.low - (coverage / field - 1.0)) < 1e-6);
    const dea_nearness ring = nearness_of(FILM STATIC "study: {sweep: {}}\n", "ring");
    assert_true(fabs(ring.low) < 1e-4 && ring.low != 0.0);
}

static void a_run_is_compared_under_its_largest_voltage(void **state)
{
    static const char *const texts[] = {
        FILM
        "drive: {waveform: {points: [[0 s, 0 V], [1 s, -4500 V], [2 s, 3 kV]]}}\nstudy: {transient: {until: 2 s, every: 1 s}}\n",
        FILM "study: {ac: {from: 1 Hz, to: 10 Hz, bias: 4500 V}}\n",
    };
    (void)state;
    for (size_t i = 0; i < sizeof texts / sizeof *texts; i++) {
        const dea_nearness near = nearness_of(texts[i], "lumped");
        assert_int_equal(near.compared, 1);
        assert_true(fabs(near.low - (lumped / field - 1.0)) < 1e-6);
    }
    assert_int_equal(nearness_of(FILM "study: {ac: {from: 1 Hz, to: 10 Hz, bias: 0 V}}\n", "lumped").compared, 0);
}

static void a_sweep_is_compared_at_its_ends_and_between(void **state)
{
    (void)state;
    const dea_nearness near = nearness_of(
        FILM STATIC "study: {sweep: {coverage: {from: 0.1, to: 0.9, points: 81}, prestretch: [1.1, 1.2, 1.3]}}\n", "lumped");
    assert_int_equal(near.compared, 15);
    assert_false(near.whole);
    assert_true(near.low < -0.2 && near.high > 0.07 && near.high < 0.2);
}

/* A soft film pulls in, but not by Eq. 22, which knows no fold. */
static void pull_in_of_one_alone_is_counted(void **state)
{
    (void)state;
    const dea_nearness near = nearness_of(
        "actuator: {kind: dot, frame_radius: 30 mm, coverage: 0.3, film_thickness: 100 um, prestretch: 1.1}\n"
        "material: {neo_hookean: {mu: 40 kPa}, permittivity: 4.7}\nmodel: lumped\ndrive: {voltage: 10 kV}\nstudy: {sweep: {}}\n",
        "lumped");
    assert_true(near.compared == 0 && near.unlike == 1);
}

static dea_point place_of(const dea_scene *scene)
{
    dea_point point;
    dea_film_prepare(scene, &point.film);
    dea_point_place(scene, &point);
    return point;
}

static dea_scene moving_scene(const char *more)
{
    char text[1024];
    dea_scene scene;
    dea_error error = {0};
    snprintf(text, sizeof text,
             "actuator: {frame_radius: 30 mm, film_thickness: 100 um, %s}\n"
             "material: {base: elastosil-2030, density: 1080 kg/m^3, prony: [{g: 0.2, tau: 1 s}]}\nmodel: lumped\n"
             "drive: {waveform: {step: {on: 1 ms, voltage: 4 kV}}}\nstudy: {transient: {until: 10 ms, every: 1 ms}}\n", more);
    if (dea_scene_parse(text, strlen(text), "t", NULL, NULL, 0, NULL, &scene, &error) != DEA_OK) {
        fail_msg("%s", error.message);
    }
    return scene;
}

/* Without electrodes k F = 3.8317; with them the modes of a film of rings, which shares nothing with Bessel functions. */
static void the_first_resonance_is_that_of_the_exact_film(void **state)
{
    (void)state;
    static const char *const films[] = {
        "kind: dot, coverage: 0.5, prestretch: 1.2, electrode_mass: 25 g/m^2",
        "kind: lens, coverage: 0.5, prestretch: 1.2, electrode_mass: 25 g/m^2",
        "kind: dot, coverage: 0.3, prestretch: 1.1, electrode_mass: 2 kg/m^2", /* 30 times the film's own */
        "kind: dot, coverage: 0.8, prestretch: 1.3",
    };
    for (size_t i = 0; i < sizeof films / sizeof *films; i++) {
        dea_scene scene = moving_scene(films[i]);
        static double stiffness[DEA_RINGS_NODES * DEA_RINGS_NODES], shapes[DEA_RINGS_NODES * DEA_RINGS_NODES];
        double u[DEA_RINGS_NODES] = {0.0}, frequencies[DEA_RINGS_NODES];
        dea_membrane membrane;
        dea_membrane_look look;
        const dea_point point = place_of(&scene);
        assert_int_equal(dea_membrane_open(&scene, dea_model_find("field"), (dea_rings_mesh){12, 14, false}, &membrane, NULL), DEA_OK);
        assert_true(dea_membrane_look_at(&membrane, u, &look));
        dea_membrane_stiffness(&membrane, &look, 0.0, NULL, 0.0, stiffness);
        assert_true(dea_membrane_modes(&membrane, stiffness, frequencies, shapes));
        assert_true(fabs(dea_point_resonance(&scene, &point) * 2.0 * DEA_PI / frequencies[0] - 1.0) < 1e-9);
        dea_scene_free(&scene);
    }
}

/* A film that moves as at rest swings 12 to 13 % faster than the exact one at B = 0.5 ... 0.6, and 49 % at 0.25. */
static void a_film_of_one_node_swings_too_fast(void **state)
{
    (void)state;
    static const struct {
        const char *film;
        double low, high;
    } known[] = {{"kind: dot, coverage: 0.5, prestretch: 1.2", 0.12, 0.135}, {"kind: dot, coverage: 0.25, prestretch: 1.2", 0.48, 0.50}};
    for (size_t i = 0; i < 2; i++) {
        dea_scene scene = moving_scene(known[i].film);
        dea_nearness near;
        assert_int_equal(dea_nearness_measure(&scene, dea_model_find("lame"), &near, NULL), DEA_OK);
        assert_true(near.slow == near.fast && near.slow > known[i].low && near.slow < known[i].high);
        dea_scene_free(&scene);
    }
    assert_true(isnan(nearness_of(FILM STATIC "study: {sweep: {}}\n", "lumped").slow));
}

/* Step of 4.5 kV within 0.1 ms (physics: section 7): what the models of one node are off by at the first peak, in percent. */
static void the_first_peak_is_off_as_its_table_says(void **state)
{
    (void)state;
    static const char *const models[] = {"lumped", "lame", "coverage"};
    static const double coverages[] = {0.25, 0.50, 0.75}, off[3][3] = {{22, 21, 28}, {-6, 9, -12}, {1, 33, -15}};
    for (size_t i = 0; i < 9; i++) {
        char text[1024];
        snprintf(text, sizeof text,
                 "actuator: {kind: dot, frame_radius: 30 mm, film_thickness: 100 um, prestretch: 1.2, coverage: %g}\n"
                 "material: {base: elastosil-2030, density: 1080 kg/m^3, retardation: 50 us}\nmodel: lumped\n"
                 "drive: {waveform: {step: {on: 5 ms, voltage: 4500 V, rise: 0.1 ms}}}\n"
                 "study: {transient: {until: 13 ms, every: 1 ms}}\n", coverages[i / 3]);
        const dea_nearness near = nearness_of(text, models[i % 3]);
        assert_true(near.least_peak == near.largest_peak);
        assert_true(fabs(100.0 * near.least_peak - off[i / 3][i % 3]) < 0.75);
    }
}

/* Of a lens: Eqs. 19-23 against finite elements of the membrane, which know no rings. */
static void the_first_peak_of_a_lens_is_off_as_finite_elements_say(void **state)
{
    (void)state;
    static fe_film film;
    static fe_state at;
    dea_scene scene = moving_scene("kind: lens, coverage: 0.5, prestretch: 1.2");
    dea_nearness near;
    scene.material.prony_count = 0;
    scene.material.retardation = 5e-5;
    scene.drive.waveform.step.on = 0.0;
    scene.drive.waveform.step.rise = 1e-4;
    assert_int_equal(dea_nearness_measure(&scene, dea_model_find("lumped"), &near, NULL), DEA_OK);
    fe_open(&scene, &film);
    fe_rest(&film, &at);
    double peak = 0.0;
    for (int i = 0; i < 8000; i++) {
        fe_step(&film, 2e-7 * i, 2e-7, &at);
        peak = fmax(peak, fabs(at.u[fe_edge(&film)]));
    }
    double own = 0.0;
    lumped_state move = {0};
    for (int i = 0; i < 1600; i++) {
        move = lumped_move(&scene, 1391085.27, 1e-6 * i, 1e-6 * (i + 1), move); /* Y at 1.2: physics, section 2 */
        own = fmax(own, fabs(move.u));
    }
    assert_true(isfinite(peak) && peak > 1e-5);
    assert_true(fabs(near.least_peak - (own / peak - 1.0)) < 0.006);
    dea_scene_free(&scene);
}

/* Nothing that swings, no edge, or an end before the peak: no first peak. */
static void a_run_without_a_first_peak_tells_none(void **state)
{
    (void)state;
    static const char *const drives[] = {"step: {on: 0 s, voltage: 4 kV, rise: 0.1 ms, off: 0.5 ms}", "sine: {amplitude: 4 kV, frequency: 600 Hz}",
                                         "points: [[0 s, 0 V], [1 ms, 2 kV], [2 ms, 4 kV]]"};
    char text[1024];
    for (size_t i = 0; i < 3; i++) {
        snprintf(text, sizeof text, FILM "drive: {waveform: {%s}}\nstudy: {transient: {until: 8 ms, every: 1 ms}}\n", drives[i]);
        const dea_nearness near = nearness_of(text, "lumped");
        assert_true(near.compared == 1 && isnan(near.least_peak) && isnan(near.largest_peak));
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_point_is_off_as_its_table_says),
        cmocka_unit_test(a_run_is_compared_under_its_largest_voltage),
        cmocka_unit_test(a_sweep_is_compared_at_its_ends_and_between),
        cmocka_unit_test(pull_in_of_one_alone_is_counted),
        cmocka_unit_test(the_first_resonance_is_that_of_the_exact_film),
        cmocka_unit_test(a_film_of_one_node_swings_too_fast),
        cmocka_unit_test(the_first_peak_is_off_as_its_table_says),
        cmocka_unit_test(the_first_peak_of_a_lens_is_off_as_finite_elements_say),
        cmocka_unit_test(a_run_without_a_first_peak_tells_none),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
