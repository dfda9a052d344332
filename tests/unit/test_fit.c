/* Yeoh constants from data: exact data gives the constants back, noise stays within the standard errors, bad tables are named. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "deaspice/fit.h"

static const double paper[DEA_YEOH_TERMS] = {178426.0, -6023.0, 4234.0};

/* Uniform deviate, always the same sequence. */
static double deviate(uint64_t *seed)
{
    *seed ^= *seed << 13;
    *seed ^= *seed >> 7;
    *seed ^= *seed << 17;
    return (double)(*seed >> 11) / 9007199254740992.0;
}

/* Adds points of the paper's film, with normal noise of @p noise [Pa]. */
static void data_add(dea_fit_data *data, dea_load load, double to, int count, double noise, uint64_t *seed)
{
    for (int i = 1; i <= count; i++) {
        const double stretch = 1.0 + (to - 1.0) * i / count;
        double sum = -6.0;
        for (int j = 0; j < 12 && noise > 0.0; j++) {
            sum += deviate(seed);
        }
        const double stress = dea_fit_stress(paper, load, stretch) + (noise > 0.0 ? noise * sum : 0.0);
        assert_int_equal(dea_fit_add(data, (dea_fit_point){stretch, stress, load}, NULL), DEA_OK);
    }
}

static void nominal_stresses_follow_the_closed_forms(void **state)
{
    (void)state;
    for (double l = 0.7; l < 3.0; l += 0.1) {
        const double uniaxial_i = l * l + 2.0 / l - 3.0, biaxial_i = 2.0 * l * l + pow(l, -4.0) - 3.0;
        const double uniaxial =
            2.0 * (l - pow(l, -2.0)) * (paper[0] + 2.0 * paper[1] * uniaxial_i + 3.0 * paper[2] * uniaxial_i * uniaxial_i);
        const double biaxial =
            2.0 * (l - pow(l, -5.0)) * (paper[0] + 2.0 * paper[1] * biaxial_i + 3.0 * paper[2] * biaxial_i * biaxial_i);
        assert_true(fabs(dea_fit_stress(paper, DEA_LOAD_UNIAXIAL, l) - uniaxial) <= 1e-9 * (fabs(uniaxial) + 1.0));
        assert_true(fabs(dea_fit_stress(paper, DEA_LOAD_EQUIBIAXIAL, l) - biaxial) <= 1e-9 * (fabs(biaxial) + 1.0));
    }
}

static void exact_data_gives_the_constants_back(void **state)
{
    (void)state;
    for (int loads = 1; loads <= 3; loads++) {
        for (int relative = 0; relative < 2; relative++) {
            dea_fit_data data = {0};
            if (loads & 1) {
                data_add(&data, DEA_LOAD_UNIAXIAL, 2.0, 20, 0.0, NULL);
            }
            if (loads & 2) {
                data_add(&data, DEA_LOAD_EQUIBIAXIAL, 1.8, 15, 0.0, NULL);
            }
            dea_fit fit;
            assert_int_equal(dea_fit_yeoh(&data, 3, relative == 1, &fit, NULL), DEA_OK);
            for (int i = 0; i < DEA_YEOH_TERMS; i++) {
                assert_true(fabs(fit.yeoh[i] / paper[i] - 1.0) <= 1e-10);
            }
            assert_true(fit.r_squared > 1.0 - 1e-12 && fit.residual_relative < 1e-12);
            assert_int_equal(fit.count[DEA_LOAD_UNIAXIAL], loads & 1 ? 20 : 0);
            assert_int_equal(fit.count[DEA_LOAD_EQUIBIAXIAL], loads & 2 ? 15 : 0);
            assert_true(isnan(fit.unstable_stretch));
            dea_fit_data_free(&data);
        }
    }
}

static void noise_scatters_as_the_standard_errors_say(void **state)
{
    (void)state;
    enum { RUNS = 400 };
    uint64_t seed = 88172645463325252u;
    double squares[DEA_YEOH_TERMS] = {0.0};
    for (int run = 0; run < RUNS; run++) {
        dea_fit_data data = {0};
        data_add(&data, DEA_LOAD_UNIAXIAL, 2.0, 30, 2000.0, &seed);
        data_add(&data, DEA_LOAD_EQUIBIAXIAL, 1.8, 30, 2000.0, &seed);
        dea_fit fit;
        assert_int_equal(dea_fit_yeoh(&data, 3, false, &fit, NULL), DEA_OK);
        assert_in_range((long)fit.residual_rms, 1300, 2700);
        for (int i = 0; i < DEA_YEOH_TERMS; i++) {
            const double score = (fit.yeoh[i] - paper[i]) / fit.deviation[i];
            squares[i] += score * score / RUNS;
        }
        dea_fit_data_free(&data);
    }
    for (int i = 0; i < DEA_YEOH_TERMS; i++) {
        assert_true(squares[i] > 0.8 && squares[i] < 1.25); /* 1 in the mean, scatter sqrt(2/400) = 0.07 */
    }
}

static void neo_hookean_is_the_weighted_mean_slope(void **state)
{
    (void)state;
    dea_fit_data data = {0};
    data_add(&data, DEA_LOAD_UNIAXIAL, 1.5, 10, 0.0, NULL);
    double top = 0.0, bottom = 0.0;
    for (size_t i = 0; i < data.count; i++) {
        const double l = data.points[i].stretch, a = 2.0 * (l - 1.0 / (l * l));
        top += a * data.points[i].stress;
        bottom += a * a;
    }
    dea_fit fit;
    assert_int_equal(dea_fit_yeoh(&data, 1, false, &fit, NULL), DEA_OK);
    assert_true(fabs(fit.yeoh[0] * bottom / top - 1.0) < 1e-12);
    assert_true(fit.yeoh[1] == 0.0 && fit.yeoh[2] == 0.0);
    assert_true(fabs(fit.condition - 1.0) < 1e-12);
    dea_fit_data_free(&data);
}

static void data_that_does_not_determine_the_constants_is_refused(void **state)
{
    (void)state;
    dea_error error = {0};
    dea_fit fit;
    dea_fit_data data = {0};
    data_add(&data, DEA_LOAD_UNIAXIAL, 1.5, 2, 0.0, NULL);
    assert_int_equal(dea_fit_yeoh(&data, 3, false, &fit, &error), DEA_ERROR_USAGE);
    assert_non_null(strstr(error.message, "2 points"));
    for (int i = 0; i < 8; i++) {
        dea_fit_add(&data, data.points[0], NULL);
    }
    assert_int_equal(dea_fit_yeoh(&data, 3, false, &fit, &error), DEA_ERROR_USAGE);
    assert_non_null(strstr(error.message, "condition number"));
    assert_int_equal(dea_fit_yeoh(&data, 2, false, &fit, &error), DEA_OK);
    assert_int_equal(dea_fit_yeoh(&data, 4, false, &fit, &error), DEA_ERROR_USAGE);
    assert_int_equal(dea_fit_yeoh(&data, 0, false, &fit, &error), DEA_ERROR_USAGE);
    for (size_t i = 0; i < data.count; i++) {
        data.points[i].stress = 0.0;
    }
    assert_int_equal(dea_fit_yeoh(&data, 1, false, &fit, &error), DEA_ERROR_USAGE);
    dea_fit_data_free(&data);
}

static void softening_film_is_reported_as_unstable(void **state)
{
    (void)state;
    const double soft[DEA_YEOH_TERMS] = {1e5, -1.2e4, 0.0};
    dea_fit_data data = {0};
    for (int i = 1; i <= 20; i++) {
        const double stretch = 1.0 + 0.1 * i;
        dea_fit_add(&data, (dea_fit_point){stretch, dea_fit_stress(soft, DEA_LOAD_UNIAXIAL, stretch), DEA_LOAD_UNIAXIAL}, NULL);
    }
    dea_fit fit;
    assert_int_equal(dea_fit_yeoh(&data, 2, false, &fit, NULL), DEA_OK);
    assert_true(fit.unstable_stretch > 1.2 && fit.unstable_stretch < 3.0);
    char text[2000] = "";
    FILE *stream = fmemopen(text, sizeof text, "w");
    assert_int_equal(dea_fit_print(&fit, stream, NULL), DEA_OK);
    fclose(stream);
    assert_non_null(strstr(text, "WARNING"));
    assert_non_null(strstr(text, "\nyeoh: {C1: 100000 Pa, C2: -12000 Pa}\n"));
    dea_fit_data_free(&data);
}

static dea_status parse(const char *text, dea_load load, dea_fit_data *data, dea_error *error)
{
    *error = (dea_error){0};
    return dea_fit_parse(text, strlen(text), "data.csv", load, data, error);
}

static void tables_of_many_shapes_are_read(void **state)
{
    (void)state;
    static const char *const texts[] = {
        "stretch,stress_kPa,mode\n1.1,100,uniaxial\n1.2,200,equibiaxial\n",
        "\xef\xbb\xbf# a, b; c\r\n\r\n\"stretch\" , \"stress_kPa\", mode\r\n1.1, 100 ,\"uniaxial\"\r\n#\r\n1.2,2e2,equibiaxial",
        "mode;stress_Pa;stretch\nuniaxial;100000;1.1\nequibiaxial;+200000;1.2\n",
        "stretch\tstress_MPa\tmode\n1.1\t0.1\tuniaxial\n1.2\t0.2\tequibiaxial\n",
    };
    for (size_t i = 0; i < sizeof texts / sizeof *texts; i++) {
        dea_fit_data data = {0};
        dea_error error;
        assert_int_equal(parse(texts[i], DEA_LOAD_UNKNOWN, &data, &error), DEA_OK);
        assert_int_equal(data.count, 2);
        assert_true(data.points[0].stretch == 1.1 && fabs(data.points[0].stress - 1e5) < 1e-9);
        assert_true(data.points[1].stretch == 1.2 && fabs(data.points[1].stress - 2e5) < 1e-9);
        assert_int_equal(data.points[0].load, DEA_LOAD_UNIAXIAL);
        assert_int_equal(data.points[1].load, DEA_LOAD_EQUIBIAXIAL);
        dea_fit_data_free(&data);
    }
}

static void bad_tables_are_named_by_line_and_column(void **state)
{
    (void)state;
    static const struct {
        const char *text, *says;
    } cases[] = {
        {"", "data.csv:0:1: no header row"},
        {"# only a comment\n", "data.csv:1:1: no header row"},
        {"stretch,stress_Pa\n", "no measured points"},
        {"strech,stress_Pa\n1,2\n", "data.csv:1:1: unknown column (did you mean stretch?)"},
        {"stretch,stress\n1,2\n", "data.csv:1:9: unknown column"},
        {"stretch,stress_Pa,force\n1,2,3\n", "data.csv:1:19: unknown column"},
        {"stretch,mode\n1.1,uniaxial\n", "data.csv:1:1: no column stress_Pa"},
        {"stress_Pa\n1\n", "data.csv:1:1: no column stretch"},
        {"stretch,stress_Pa,stress_kPa\n1,2,3\n", "data.csv:1:19: a second column"},
        {"stretch,stress_Pa\n1.1,abc\n", "data.csv:2:5: not a number: \"abc\""},
        {"stretch,stress_Pa\n1.1,1 2\n", "data.csv:2:5: not a number: \"1 2\""},
        {"stretch,stress_Pa\n1.1,0x10\n", "data.csv:2:5: not a number"},
        {"stretch,stress_Pa\n1.1,nan\n", "data.csv:2:5: not a number"},
        {"stretch,stress_Pa\n1.1,inf\n", "data.csv:2:5: not a number"},
        {"stretch,stress_Pa\n1.1,1e999\n", "data.csv:2:5: this number is too large"},
        {"stretch,stress_Pa\n1.1,\n", "data.csv:2:5: an empty field"},
        {"stretch,stress_Pa\n\n0,5\n", "data.csv:3:1: a stretch is above 0"},
        {"stretch,stress_Pa\n-1.5,5\n", "data.csv:2:1: a stretch is above 0"},
        {"stretch,stress_Pa\n1.1\n", "data.csv:2:1: 1 fields where the header has 2"},
        {"stretch,stress_Pa\n1.1,2,3\n", "data.csv:2:1: 3 fields where the header has 2"},
        {"stretch,stress_Pa,mode\n1.1,2,shear\n", "data.csv:2:7: unknown mode"},
        {"stretch,stress_Pa\n\"1.1,2\n", "data.csv:2:1: a quote is not closed"},
        {"stretch,stress_Pa\n1.1,2\001\n", "data.csv:2:6: a control character"},
        {"stretch;stress_Pa\n1,1;2\n", "data.csv:2:1: not a number: \"1,1\""},
    };
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        dea_fit_data data = {0};
        dea_error error;
        assert_int_equal(parse(cases[i].text, DEA_LOAD_UNIAXIAL, &data, &error), DEA_ERROR_SCENE);
        if (!strstr(error.message, cases[i].says)) {
            fail_msg("wanted \"%s\", got \"%s\"", cases[i].says, error.message);
        }
        assert_int_equal(data.count, 0);
        dea_fit_data_free(&data);
    }
    dea_fit_data data = {0};
    dea_error error;
    assert_int_equal(parse("stretch,stress_Pa\n1.1,2\n", DEA_LOAD_UNKNOWN, &data, &error), DEA_ERROR_SCENE);
    assert_non_null(strstr(error.message, "no load given"));
    dea_fit_data_free(&data);
}

static void failed_file_leaves_earlier_points_alone(void **state)
{
    (void)state;
    dea_fit_data data = {0};
    dea_error error;
    assert_int_equal(parse("stretch,stress_Pa\n1.1,2\n", DEA_LOAD_UNIAXIAL, &data, &error), DEA_OK);
    assert_int_equal(parse("stretch,stress_Pa\n1.1,2\n1.2,x\n", DEA_LOAD_UNIAXIAL, &data, &error), DEA_ERROR_SCENE);
    assert_int_equal(data.count, 1);
    dea_fit_data_free(&data);
}

static void only_files_and_pipes_are_read(void **state)
{
    (void)state;
    dea_fit_data data = {0};
    dea_error error = {0};
    assert_int_equal(dea_fit_read("/dev/zero", DEA_LOAD_UNIAXIAL, &data, &error), DEA_ERROR_IO);
    assert_non_null(strstr(error.message, "neither a file nor a pipe"));
    assert_int_equal(dea_fit_read("/", DEA_LOAD_UNIAXIAL, &data, &error), DEA_ERROR_IO);
    assert_int_equal(dea_fit_read("/no/such/file", DEA_LOAD_UNIAXIAL, &data, &error), DEA_ERROR_IO);
    assert_non_null(strstr(error.message, "No such file"));
    dea_fit_data_free(&data);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(nominal_stresses_follow_the_closed_forms),
        cmocka_unit_test(exact_data_gives_the_constants_back),
        cmocka_unit_test(noise_scatters_as_the_standard_errors_say),
        cmocka_unit_test(neo_hookean_is_the_weighted_mean_slope),
        cmocka_unit_test(data_that_does_not_determine_the_constants_is_refused),
        cmocka_unit_test(softening_film_is_reported_as_unstable),
        cmocka_unit_test(tables_of_many_shapes_are_read),
        cmocka_unit_test(bad_tables_are_named_by_line_and_column),
        cmocka_unit_test(failed_file_leaves_earlier_points_alone),
        cmocka_unit_test(only_files_and_pipes_are_read),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
