/* Fits of every law to data that a film of it has given, with noise and without. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "deaspice/fit.h"
#include "deaspice/scene.h"

static const struct {
    const char *law;
    int terms, used;
    double constants[DEA_LAW_CONSTANTS];
    double to; /* largest stretch */
} films[] = {
    {"yeoh", 3, 3, {178426.0, -6023.0, 4234.0}, 2.0}, {"neo_hookean", 0, 1, {44e3}, 2.0},
    {"mooney_rivlin", 0, 2, {16e3, 7.3e3}, 2.0},      {"gent", 0, 2, {45e3, 20.0}, 2.8},
    {"ogden", 1, 2, {30e3, 2.6}, 3.0},                {"ogden", 2, 4, {43.4e3, 1.445, 84.2, 4.248}, 4.5},
    {"arruda_boyce", 0, 2, {40e3, 2.5}, 3.0},
};
enum { FILMS = sizeof films / sizeof *films };

/* Uniform deviate, always the same sequence. */
static double deviate(uint64_t *seed)
{
    *seed ^= *seed << 13;
    *seed ^= *seed >> 7;
    *seed ^= *seed << 17;
    return (double)(*seed >> 11) / 9007199254740992.0;
}

/* Both loads up to the largest stretch, with normal noise of @p noise [Pa]. */
static dea_fit_data data_of(size_t film, double noise, uint64_t *seed)
{
    dea_fit_data data = {0};
    for (int load = 0; load < DEA_LOAD_COUNT; load++) {
        for (int i = 1; i <= 30; i++) {
            const double stretch = 1.0 + (films[film].to - 1.0) * (load == DEA_LOAD_EQUIBIAXIAL ? 0.7 : 1.0) * i / 30;
            double sum = -6.0;
            for (int j = 0; j < 12; j++) {
                sum += deviate(seed);
            }
            const double stress = dea_fit_stress(dea_law_find(films[film].law), films[film].constants, (dea_load)load, stretch);
            assert_int_equal(dea_fit_add(&data, (dea_fit_point){stretch, stress + noise * sum, (dea_load)load}, NULL), DEA_OK);
        }
    }
    return data;
}

/* Entries of a list come in any order: the distance of a constant from that of the entry that is nearest by its last constant. */
static double meant(size_t film, const dea_fit *fit, int index)
{
    const size_t stride = fit->law->constant_count;
    size_t best = 0;
    for (size_t k = 1; fit->law->entries > 1 && k < (size_t)fit->terms / stride; k++) {
        const double wanted = fit->constants[(size_t)index / stride * stride + stride - 1];
        const double here = fabs(films[film].constants[k * stride + stride - 1] - wanted);
        best = here < fabs(films[film].constants[best * stride + stride - 1] - wanted) ? k : best;
    }
    return films[film].constants[fit->law->entries > 1 ? best * stride + (size_t)index % stride : (size_t)index];
}

static void exact_data_gives_the_constants_back(void **state)
{
    (void)state;
    for (size_t i = 0; i < FILMS; i++) {
        for (int relative = 0; relative < 2; relative++) {
            uint64_t seed = 88172645463325252u;
            dea_fit_data data = data_of(i, 0.0, &seed);
            dea_fit fit;
            assert_int_equal(dea_fit_law(&data, dea_law_find(films[i].law), films[i].terms, relative == 1, &fit, NULL), DEA_OK);
            assert_int_equal(fit.terms, films[i].used);
            for (int k = 0; k < films[i].used; k++) {
                assert_true(fabs(fit.constants[k] / meant(i, &fit, k) - 1.0) <= 1e-5);
            }
            assert_true(fit.residual_relative < 1e-7);
            assert_true(fabs(fit.stretch_max - films[i].to) < 1e-12);
            dea_fit_data_free(&data);
        }
    }
}

/* Mean square of the error over its standard error: 1, with a scatter of sqrt(2/200) = 0.1. */
static void noise_scatters_as_the_standard_errors_say(void **state)
{
    (void)state;
    enum { RUNS = 200 };
    for (size_t i = 1; i < FILMS; i++) {
        uint64_t seed = 88172645463325252u;
        double squares[DEA_LAW_CONSTANTS] = {0.0};
        const double largest = dea_fit_stress(dea_law_find(films[i].law), films[i].constants, DEA_LOAD_UNIAXIAL, films[i].to);
        for (int run = 0; run < RUNS; run++) {
            dea_fit_data data = data_of(i, 0.003 * largest, &seed);
            dea_fit fit;
            assert_int_equal(dea_fit_law(&data, dea_law_find(films[i].law), films[i].terms, false, &fit, NULL), DEA_OK);
            for (int k = 0; k < films[i].used; k++) {
                const double score = (fit.constants[k] - meant(i, &fit, k)) / fit.deviation[k];
                squares[k] += score * score / RUNS;
            }
            dea_fit_data_free(&data);
        }
        for (int k = 0; k < films[i].used; k++) {
            if (!(squares[k] > 0.65 && squares[k] < 1.4)) {
                fail_msg("%s, constant %d: mean square %g", films[i].law, k, squares[k]);
            }
        }
    }
}

static void the_criterion_finds_the_law_behind_the_data(void **state)
{
    (void)state;
    for (size_t i = 0; i < FILMS; i++) {
        uint64_t seed = 1234567u;
        const double largest = dea_fit_stress(dea_law_find(films[i].law), films[i].constants, DEA_LOAD_UNIAXIAL, films[i].to);
        dea_fit_data data = data_of(i, 1e-4 * largest, &seed);
        dea_fit fit;
        assert_int_equal(dea_fit_auto(&data, false, &fit, NULL), DEA_OK);
        if (strcmp(fit.law->name, films[i].law) != 0) {
            fail_msg("data of %s gave %s", films[i].law, fit.law->name);
        }
        assert_true(fit.choice_count >= 2);
        for (size_t k = 0; k < fit.choice_count; k++) {
            assert_true(!(fit.choices[k].criterion < fit.criterion));
        }
        dea_fit_data_free(&data);
    }
}

/* What is printed is a material that a scene reads. */
static void printed_fits_are_materials(void **state)
{
    (void)state;
    for (size_t i = 0; i < FILMS; i++) {
        uint64_t seed = 99u;
        dea_fit_data data = data_of(i, 10.0, &seed);
        dea_fit fit;
        char *text = NULL, *scene_text = NULL;
        size_t length;
        assert_int_equal(dea_fit_law(&data, dea_law_find(films[i].law), films[i].terms, false, &fit, NULL), DEA_OK);
        FILE *stream = open_memstream(&text, &length);
        assert_int_equal(dea_fit_print(&fit, NULL, NULL, stream, NULL), DEA_OK);
        assert_int_equal(fclose(stream), 0);
        stream = open_memstream(&scene_text, &length);
        fputs("actuator: {kind: dot, frame_radius: 30 mm, coverage: 0.5, film_thickness: 1 mm, prestretch: 1.2}\n"
              "drive: {voltage: 1 kV}\nmodel: lumped\nstudy: {sweep: {}}\nmaterial:\n  permittivity: 3\n",
              stream);
        for (const char *line = strtok(text, "\n"); line; line = strtok(NULL, "\n")) {
            fprintf(stream, "  %s\n", line);
        }
        fclose(stream);
        dea_scene scene;
        dea_error error = {0};
        if (dea_scene_parse(scene_text, length, "scene", ".", NULL, 0, NULL, &scene, &error) != DEA_OK) {
            fail_msg("%s", error.message);
        }
        assert_string_equal(scene.material.law->name, films[i].law);
        for (int k = 0; k < fit.terms; k++) {
            assert_true(fabs(scene.material.constants[k] / fit.constants[k] - 1.0) < 1e-7);
        }
        assert_true(fabs(scene.material.stretches[1] - films[i].to) < 1e-5);
        dea_scene_free(&scene);
        free(text);
        free(scene_text);
        dea_fit_data_free(&data);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(exact_data_gives_the_constants_back),
        cmocka_unit_test(noise_scatters_as_the_standard_errors_say),
        cmocka_unit_test(the_criterion_finds_the_law_behind_the_data),
        cmocka_unit_test(printed_fits_are_materials),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
