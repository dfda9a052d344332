/* A film at another temperature than that of its data. Judges are the shift laws written out here, and films at the temperature of
 * the data on a clock that runs as much slower, or of as much stiffer constants. */
#include "answers.h"

#include <stdlib.h>

#include "netlist/part.h"
#include "journal/journal.h"

#define HEAD "actuator: {kind: dot, frame_radius: 30 mm, coverage: 0.5, film_thickness: 100 um, prestretch: 1.2}\n"
#define CONSTANTS "yeoh: {C1: 178426 Pa, C2: -6023 Pa, C3: 4234 Pa}, permittivity: 2.8"
#define BRANCHES ", prony: [{g: 0.1, tau: 1 s}, {g: 0.2, tau: 5 s}]"
#define TABLE ", shift: [[0 degC, 20], [20 degC, 1], [40 degC, 0.1]]"
#define WLF ", shift: {wlf: {C1: 17.4, C2: 51.6 K, reference: 20 degC}}"
#define SLOPE ", modulus_slope: {per_kelvin: 0.2 %/K, reference: 20 degC}"
#define FILM(more) HEAD "material: {" CONSTANTS more "}\n"
#define STILL "drive: {voltage: 4 kV}\nstudy: {sweep: {}}\n"

static dea_material material_of(const char *text)
{
    dea_scene scene;
    read_scene(text, "lumped", &scene);
    const dea_material material = scene.material;
    dea_scene_free(&scene);
    return material;
}

static void times_shift_by_their_law(void **state)
{
    (void)state;
    const dea_material data = material_of(FILM(BRANCHES WLF) STILL), warm = material_of(FILM(BRANCHES WLF) STILL "temperature: 40 degC\n"),
                       cold = material_of(FILM(BRANCHES WLF) STILL "temperature: 273.15 K\n"),
                       between = material_of(FILM(BRANCHES TABLE) STILL "temperature: 30 °C\n"),
                       row = material_of(FILM(BRANCHES TABLE) STILL "temperature: 0 degC\n");
    assert_true(dea_material_shift(&data) == 1.0 && dea_material_branch(&data, 1).tau == 5.0);
    assert_relative(dea_material_shift(&warm), exp(-17.4 * 20.0 / 71.6 * log(10.0)), 1e-12);
    assert_relative(dea_material_shift(&cold), exp(17.4 * 20.0 / 31.6 * log(10.0)), 1e-12);
    assert_relative(dea_material_shift(&between), sqrt(0.1), 1e-12);
    assert_relative(dea_material_branch(&between, 1).tau, 5.0 * sqrt(0.1), 1e-12);
    assert_true(dea_material_branch(&between, 1).g == 0.2);
    assert_true(dea_material_shift(&row) == 20.0);
    assert_true(material_of("temperature: 20 degC\n" HEAD "material: {base: elastosil-2030" SLOPE "}\n" STILL).temperature == 293.15);
    assert_true(material_of("temperature: 68 degF\n" HEAD "material: {base: elastosil-2030" SLOPE "}\n" STILL).temperature == 293.15);
    assert_true(material_of("temperature: -40 °F\n" HEAD "material: {base: elastosil-2030" SLOPE "}\n" STILL).temperature ==
                material_of("temperature: -40 °C\n" HEAD "material: {base: elastosil-2030" SLOPE "}\n" STILL).temperature);
}

/* Time-temperature superposition: ten times faster at 40 degC. */
static void a_warm_film_creeps_as_a_film_on_a_faster_clock(void **state)
{
    (void)state;
    static const char *const models[] = {"lumped", "lame", "coverage", "ring", "field"};
    static const char *const warm = FILM(BRANCHES TABLE) "temperature: 40 degC\naccuracy: 1e-5\ndrive: {waveform: {step: {on: 0 s, voltage: 4 kV, rise: 1 ms}}}\n"
                                    "study: {transient: {until: 2 s, every: 0.1 s}}\n";
    static const char *const data = FILM(BRANCHES TABLE) "accuracy: 1e-5\ndrive: {waveform: {step: {on: 0 s, voltage: 4 kV, rise: 10 ms}}}\n"
                                    "study: {transient: {until: 20 s, every: 1 s}}\n";
    size_t done = 0;
    for (size_t m = 0; m < 5; m++) {
        for (size_t e = 0; e < ENGINES; e++) {
            if (!run(warm, models[m], engines[e], &one) || !run(data, models[m], engines[e], &other)) {
                continue;
            }
            const dea_sample *fast = (const dea_sample *)one.bytes, *slow = (const dea_sample *)other.bytes;
            for (size_t i = 0; i < 21; i++) {
                assert_near(fast[i].displacement, slow[i].displacement, 4e-5 * slow[20].displacement);
            }
            done++;
        }
    }
    assert_true(done >= 9);
}

static void a_warm_film_answers_as_at_a_lower_frequency(void **state)
{
    (void)state;
    static const char *const models[] = {"lumped", "ring", "field"};
    static const char *const warm = FILM(BRANCHES TABLE) "temperature: 40 degC\ndrive: {leakage_resistance: 1 TOhm}\n"
                                    "study: {ac: {from: 0.1 Hz, to: 1 Hz, points_per_decade: 3, bias: 3 kV}}\n";
    static const char *const data = FILM(BRANCHES TABLE) "drive: {leakage_resistance: 1 TOhm}\n"
                                    "study: {ac: {from: 0.01 Hz, to: 0.1 Hz, points_per_decade: 3, bias: 3 kV}}\n";
    for (size_t m = 0; m < 3; m++) {
        for (size_t e = 0; e < ENGINES; e += 2) {
            assert_true(run(warm, models[m], engines[e], &one) && run(data, models[m], engines[e], &other));
            const dea_response *fast = (const dea_response *)one.bytes, *slow = (const dea_response *)other.bytes;
            for (size_t i = 0; i < 4; i++) {
                assert_relative(fast[i].displacement, slow[i].displacement, 1e-6);
                assert_relative(fast[i].displacement_phase, slow[i].displacement_phase, 1e-6);
            }
        }
    }
}

/* 0.2 % a kelvin over 30 K: moduli of 1.06; and over an axis, whose engines see an expression of it. */
static void a_warm_film_is_one_of_stiffer_constants(void **state)
{
    (void)state;
    for (size_t m = 0; m < dea_model_count(); m++) {
        const char *model = dea_model_at(m)->name;
        for (size_t e = 0; e < ENGINES; e++) {
            if (!run(FILM(SLOPE) STILL "temperature: 50 degC\n", model, engines[e], &one)) {
                continue;
            }
            const dea_row warm = *(const dea_row *)one.bytes;
            run(HEAD "material: {yeoh: {C1: 189131.56 Pa, C2: -6384.38 Pa, C3: 4488.04 Pa}, permittivity: 2.8}\n" STILL, model, engines[e], &one);
            assert_relative(warm.strain, ((const dea_row *)one.bytes)->strain, 1e-8);
            run(FILM(SLOPE) "drive: {voltage: 4 kV}\nstudy: {sweep: {temperature: [20 degC, 50 degC]}}\n", model, engines[e], &one);
            assert_relative(((const dea_row *)one.bytes)[1].strain, warm.strain, 1e-8);
            run(FILM("") STILL, model, engines[e], &other);
            assert_relative(((const dea_row *)one.bytes)[0].strain, ((const dea_row *)other.bytes)->strain, 1e-8);
        }
    }
    const dea_material given = material_of(FILM(", modulus: 1.2 MPa" SLOPE) STILL "temperature: 50 degC\n");
    assert_relative(dea_material_long_term_share(&given) * given.modulus, 1.272e6, 1e-12);
}

static void a_part_has_the_numbers_of_its_temperature(void **state)
{
    (void)state;
    dea_part_parameter list[DEA_PART_PARAMETERS];
    dea_scene scene;
    size_t found = 0;
    read_scene(FILM(BRANCHES TABLE SLOPE) STILL "temperature: 40 degC\n", "ring", &scene);
    const size_t count = dea_part_parameters(&scene, scene.models[0], list);
    for (size_t i = 0; i < count; i++) {
        const double wanted = strcmp(list[i].name, "tau2") == 0 ? 0.5 : strcmp(list[i].name, "c1") == 0 ? 1.04 * 178426.0 : 0.0;
        if (wanted > 0.0) {
            assert_relative(list[i].value, wanted, 1e-12);
            found++;
        }
    }
    assert_int_equal(found, 2);
    dea_scene_free(&scene);
}

#define SECOND(more) "antagonist: {actuator: {kind: lens}, drive: {voltage: 2 kV}, material: {neo_hookean: {mu: 60 kPa}, permittivity: 3" more "}}\n"

/* Both films are at the temperature, each by its own slope: the second of 120 % at 40 degC is one of stiffer constants. */
static void a_second_film_is_at_the_same_temperature(void **state)
{
    (void)state;
    static const char *const stiffer = "antagonist: {actuator: {kind: lens}, drive: {voltage: 2 kV}, material: {neo_hookean: {mu: 72 kPa}, permittivity: 3}}\n";
    static const char *const models[] = {"ring", "field"};
    char wanted[1024];
    snprintf(wanted, sizeof wanted, "%s%s", FILM(SLOPE) STILL "temperature: 40 degC\n", stiffer);
    for (size_t m = 0; m < 2; m++) {
        for (size_t e = 0; e < ENGINES; e++) {
            const char *warm = FILM(SLOPE) STILL "temperature: 40 degC\n" SECOND(", modulus_slope: {per_kelvin: 1 %/K, reference: 20 degC}");
            const char *swept = FILM(SLOPE) "drive: {voltage: 4 kV}\nstudy: {sweep: {temperature: [20 degC, 40 degC]}}\n" SECOND(", modulus_slope: {per_kelvin: 1 %/K, reference: 20 degC}");
            if (run(wanted, models[m], engines[e], &one) && run(warm, models[m], engines[e], &other)) {
                const double strain = ((const dea_row *)one.bytes)->strain;
                assert_relative(((const dea_row *)other.bytes)->strain, strain, 1e-8);
                run(swept, models[m], engines[e], &other);
                assert_relative(((const dea_row *)other.bytes)[1].strain, strain, 1e-8);
            }
        }
    }
}

/* Journals, shards and results are of one temperature and one table. */
static void another_temperature_is_another_run(void **state)
{
    (void)state;
    static const char *const scenes[] = {FILM(BRANCHES TABLE) STILL "temperature: 40 degC\n", FILM(BRANCHES TABLE) STILL "temperature: 39 degC\n",
                                         FILM(BRANCHES WLF) STILL "temperature: 40 degC\n",
                                         FILM(BRANCHES ", shift: [[0 degC, 20], [20 degC, 1], [40 degC, 0.2]]") STILL "temperature: 40 degC\n",
                                         FILM(SLOPE) STILL "temperature: 40 degC\n" SECOND(", modulus_slope: {per_kelvin: 0.3 %/K, reference: 20 degC}"),
                                         FILM(SLOPE) STILL "temperature: 40 degC\n" SECOND(", modulus_slope: {per_kelvin: 0.4 %/K, reference: 20 degC}"),
                                         FILM(SLOPE) STILL "temperature: 40 degC\n" SECOND("")};
    enum { SCENES = sizeof scenes / sizeof *scenes };
    char *texts[SCENES];
    for (size_t i = 0; i < SCENES; i++) {
        dea_scene scene;
        read_scene(scenes[i], "ring", &scene);
        assert_int_equal(dea_identity_write(&scene, dea_engine_find("direct"), &texts[i], NULL), DEA_OK);
        for (size_t k = 0; k < i; k++) {
            assert_string_not_equal(texts[k], texts[i]);
        }
        dea_scene_free(&scene);
    }
    for (size_t i = 0; i < SCENES; i++) {
        free(texts[i]);
    }
}

static void temperatures_that_make_no_film_are_refused(void **state)
{
    (void)state;
    static const char *const wrong[][2] = {
        {FILM("") STILL "temperature: 40 degC\n", "temperature: changes nothing"},
        {FILM(BRANCHES WLF) STILL "temperature: -31.6 degC\n", "below the pole of the WLF law"},
        {FILM(BRANCHES WLF) STILL "temperature: -300 degC\n", "out of range (-300 degC)"},
        {FILM(BRANCHES WLF) STILL "temperature: 0 K\n", "out of range (0 K)"},
        {FILM(BRANCHES WLF) STILL "temperature: 40\n", "needs a unit"},
        {FILM(BRANCHES WLF) STILL "temperature: 40 C\n", "does not convert to K"},
        {FILM(BRANCHES ", shift: {wlf: {C1: 17.4, C2: 51.6 degC, reference: 20 degC}}") STILL, "does not convert to kelvin"},
        {FILM(BRANCHES ", shift: {wlf: {C1: 17.4, C2: 51.6 K}}") STILL, "material.shift.wlf.reference: missing"},
        {FILM(BRANCHES ", shift: [[20 degC, 1], [20 degC, 0.1]]") STILL, "not above the one before"},
        {FILM(BRANCHES ", shift: [[20 degC, 1], [40 degC, 0]]") STILL, "out of range (0)"},
        {FILM(BRANCHES ", shift: [[20 degC, 1]]") STILL, "less than two rows"},
        {FILM(BRANCHES ", shift: [[20 degC, 1], [40 degC]]") STILL, "not a pair of a temperature and a factor"},
        {FILM(BRANCHES TABLE) STILL "temperature: 41 degC\n", "out of the table of shift factors (314.15 K); accepted: 273.15 to 313.15 K"},
        {FILM(", modulus_slope: {per_kelvin: -5 %/K, reference: 20 degC}") STILL "temperature: 40 degC\n", "leaves the film no modulus"},
        {FILM(", modulus_slope: {per_kelvin: 0.2 %/K}") STILL, "material.modulus_slope.reference: missing"},
        {FILM(", modulus_slope: {per_kelvin: 0.2 %, reference: 20 degC}") STILL, "does not convert to kelvin-1"},
    };
    for (size_t i = 0; i < sizeof wrong / sizeof *wrong; i++) {
        dea_scene scene;
        dea_error error = {0};
        const char *text = wrong[i][0];
        assert_int_equal(dea_scene_parse(text, strlen(text), "test", ".", NULL, 0, "ring", &scene, &error), DEA_ERROR_SCENE);
        if (!strstr(error.message, wrong[i][1])) {
            fail_msg("%s", error.message);
        }
    }
    /* over an axis the points past a limit say so, the others stand */
    const char *swept = FILM(", modulus_slope: {per_kelvin: -5 %/K, reference: 20 degC}") "drive: {voltage: 4 kV}\nstudy: {sweep: {temperature: [20 degC, 50 degC]}}\n";
    for (size_t e = 0; e < ENGINES; e++) {
        assert_true(run(swept, "ring", engines[e], &one));
        assert_int_equal(((const dea_row *)one.bytes)[0].state, DEA_STATE_OK);
        assert_int_equal(((const dea_row *)one.bytes)[1].state, DEA_STATE_FAILED);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(times_shift_by_their_law),
        cmocka_unit_test(a_warm_film_creeps_as_a_film_on_a_faster_clock),
        cmocka_unit_test(a_warm_film_answers_as_at_a_lower_frequency),
        cmocka_unit_test(a_warm_film_is_one_of_stiffer_constants),
        cmocka_unit_test(a_part_has_the_numbers_of_its_temperature),
        cmocka_unit_test(a_second_film_is_at_the_same_temperature),
        cmocka_unit_test(another_temperature_is_another_run),
        cmocka_unit_test(temperatures_that_make_no_film_are_refused),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
