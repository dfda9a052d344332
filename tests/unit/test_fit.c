/* Constants from data: exact data gives them back, noise stays within the standard errors, bad tables are named. */
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
#include "deaspice/scene.h"
#include "material/fit/branches.h"

static const double paper[DEA_LAW_CONSTANTS] = {178426.0, -6023.0, 4234.0};

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
        const double stress = dea_fit_stress(dea_law_find("yeoh"), paper, load, stretch) + (noise > 0.0 ? noise * sum : 0.0);
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
        assert_true(fabs(dea_fit_stress(dea_law_find("yeoh"), paper, DEA_LOAD_UNIAXIAL, l) - uniaxial) <= 1e-9 * (fabs(uniaxial) + 1.0));
        assert_true(fabs(dea_fit_stress(dea_law_find("yeoh"), paper, DEA_LOAD_EQUIBIAXIAL, l) - biaxial) <= 1e-9 * (fabs(biaxial) + 1.0));
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
                assert_true(fabs(fit.constants[i] / paper[i] - 1.0) <= 1e-10);
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
        assert_true(fit.residual_rms >= 1300.0 && fit.residual_rms <= 2700.0);
        for (int i = 0; i < DEA_YEOH_TERMS; i++) {
            const double score = (fit.constants[i] - paper[i]) / fit.deviation[i];
            squares[i] += score * score / RUNS;
        }
        dea_fit_data_free(&data);
    }
    for (int i = 0; i < DEA_YEOH_TERMS; i++) {
        assert_true(squares[i] > 0.8 && squares[i] < 1.25); /* 1 in the mean, scatter sqrt(2/400) = 0.07 */
    }
}

/* Nothing is promised of C2 and C3 where the data do not tell them; what is taken scatters as it says. */
static void constants_that_the_data_do_not_tell_are_dropped(void **state)
{
    enum { RUNS = 200 };
    uint64_t seed = 6364136223846793005u;
    int more = 0, all = 0;
    double square = 0.0;
    (void)state;
    for (int run = 0; run < RUNS; run++) {
        dea_fit_data data = {0};
        dea_fit fit;
        for (int i = 1; i <= 25; i++) {
            const double stretch = 1.0 + 0.04 * i, stress = 2e4 * (stretch - 1.0 / (stretch * stretch)) + 50.0 * i * (deviate(&seed) - 0.5);
            assert_int_equal(dea_fit_add(&data, (dea_fit_point){stretch, stress, DEA_LOAD_UNIAXIAL}, NULL), DEA_OK);
        }
        assert_int_equal(dea_fit_yeoh(&data, 0, false, &fit, NULL), DEA_OK);
        more += fit.terms > 1;
        square += pow((fit.constants[0] - 1e4) / fit.deviation[0], 2.0) / RUNS;
        assert_true(isnan(fit.trials[0].p) && fit.trials[1].p >= 0.0 && fit.trials[2].p <= 1.0);
        data.count = 0;
        data_add(&data, DEA_LOAD_UNIAXIAL, 2.0, 30, 300.0, &seed);
        assert_int_equal(dea_fit_yeoh(&data, 0, false, &fit, NULL), DEA_OK);
        all += fit.terms == 3;
        dea_fit_data_free(&data);
    }
    assert_true(more <= 34); /* two tests at 5 %, and the noise grows along the test */
    assert_int_equal(all, RUNS);
    assert_true(square > 0.7 && square < 1.35);
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
    assert_true(fabs(fit.constants[0] * bottom / top - 1.0) < 1e-12);
    assert_true(fit.constants[1] == 0.0 && fit.constants[2] == 0.0);
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
    assert_int_equal(dea_fit_yeoh(&data, -1, false, &fit, &error), DEA_ERROR_USAGE);
    for (size_t i = 0; i < data.count; i++) {
        data.points[i].stress = 0.0;
    }
    assert_int_equal(dea_fit_yeoh(&data, 1, false, &fit, &error), DEA_ERROR_USAGE);
    dea_fit_data_free(&data);
}

static void softening_film_is_reported_as_unstable(void **state)
{
    (void)state;
    const double soft[DEA_LAW_CONSTANTS] = {1e5, -1.2e4, 0.0};
    dea_fit_data data = {0};
    for (int i = 1; i <= 20; i++) {
        const double stretch = 1.0 + 0.1 * i;
        dea_fit_add(&data, (dea_fit_point){stretch, dea_fit_stress(dea_law_find("yeoh"), soft, DEA_LOAD_UNIAXIAL, stretch), DEA_LOAD_UNIAXIAL}, NULL);
    }
    dea_fit fit;
    assert_int_equal(dea_fit_yeoh(&data, 2, false, &fit, NULL), DEA_OK);
    assert_true(fit.unstable_stretch > 1.2 && fit.unstable_stretch < 3.0);
    char text[2000] = "";
    FILE *stream = fmemopen(text, sizeof text, "w");
    assert_int_equal(dea_fit_print(&fit, NULL, NULL, stream, NULL), DEA_OK);
    fclose(stream);
    assert_non_null(strstr(text, "WARNING"));
    assert_non_null(strstr(text, "\nyeoh: {C1: 100000 Pa, C2: -12000 Pa}\n"));
    dea_fit_data_free(&data);
}

static void tables_that_are_no_stretch_are_told(void **state)
{
    static const struct {
        double factor, shift, sign; /* of the stretch column, and of the stress */
        const char *says;
    } cases[] = {
        {100.0, 0.0, 1.0, "look like percent"},
        {100.0, -100.0, 1.0, "look like percent"},
        {1.0, -1.0, 1.0, "a strain is no stretch"},
        {1.0, 0.0, -1.0, "the data give no elasticity"},
    };
    (void)state;
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        dea_fit_data data = {0};
        dea_fit fit;
        dea_error error = {0};
        data_add(&data, DEA_LOAD_UNIAXIAL, 2.0, 20, 0.0, NULL);
        for (size_t k = 0; k < data.count; k++) {
            data.points[k].stretch = cases[i].factor * data.points[k].stretch + cases[i].shift;
            data.points[k].stress *= cases[i].sign;
        }
        assert_int_equal(dea_fit_yeoh(&data, 0, false, &fit, &error), DEA_ERROR_DATA);
        assert_non_null(strstr(error.message, cases[i].says));
        dea_fit_data_free(&data);
    }
}

static void elasticity_whose_sign_is_noise_is_none(void **state)
{
    static const double stresses[] = {120.0, -90.0, 60.0, -150.0, 100.0, -20.0, 40.0, -60.0};
    (void)state;
    dea_fit_data data = {0};
    dea_fit fit;
    dea_error error = {0};
    for (size_t i = 0; i < sizeof stresses / sizeof *stresses; i++) {
        dea_fit_add(&data, (dea_fit_point){1.1 + 0.1 * (double)i, stresses[i], DEA_LOAD_UNIAXIAL}, NULL);
    }
    assert_int_equal(dea_fit_yeoh(&data, 1, false, &fit, &error), DEA_ERROR_DATA);
    assert_non_null(strstr(error.message, "has to be above 0"));
    dea_fit_data_free(&data);
}

static void unloading_is_told_and_a_second_test_is_not(void **state)
{
    uint64_t seed = 1442695040888963407u;
    char text[2000] = "";
    (void)state;
    dea_fit_data data = {0};
    dea_fit fit;
    data_add(&data, DEA_LOAD_UNIAXIAL, 2.0, 40, 100.0, &seed);
    data_add(&data, DEA_LOAD_UNIAXIAL, 1.8, 40, 100.0, &seed);
    data_add(&data, DEA_LOAD_EQUIBIAXIAL, 1.5, 10, 100.0, &seed);
    assert_int_equal(dea_fit_yeoh(&data, 0, false, &fit, NULL), DEA_OK);
    assert_true(isnan(fit.unloads_from));
    for (int i = 1; i <= 15; i++) { /* back along a softer curve, on a stage that jitters */
        const double stretch = 1.5 - 0.02 * i + 0.01 * (i % 2);
        dea_fit_add(&data, (dea_fit_point){stretch, 0.8 * dea_fit_stress(dea_law_find("yeoh"), paper, DEA_LOAD_EQUIBIAXIAL, stretch), DEA_LOAD_EQUIBIAXIAL}, NULL);
    }
    assert_int_equal(dea_fit_yeoh(&data, 0, false, &fit, NULL), DEA_OK);
    assert_true(fabs(fit.unloads_from - 1.5) < 1e-12);
    FILE *stream = fmemopen(text, sizeof text, "w");
    assert_int_equal(dea_fit_print(&fit, NULL, NULL, stream, NULL), DEA_OK);
    fclose(stream);
    assert_non_null(strstr(text, "unload from stretch 1.5"));
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
        {"", "data.csv:1:1: no row of two or more numbers"},
        {"# only a comment\n", "data.csv:1:1: no row of two or more numbers"},
        {"stretch,stress_Pa\n", "no measured points"},
        {"strech,stress_Pa\n1,2\n", "data.csv:1:1: no column of stretch; did you mean \"strech\"?"},
        {"stretch,stress\n1,2\n", "data.csv:1:9: a column without unit (write e.g. stress_kPa)"},
        {"stretch,stress_Pa,force\n1,2,3\n", "data.csv:1:19: a column without unit (write e.g. force_kN)"},
        {"Time,Displacement,Force\n(s),(mm),(N)\n", "wants the length of the specimen at rest (--length"},
        {"1.1 2\n1.2 3\n", "data.csv:1:1: no header row that names the columns: stretch"},
        {"stretch,force_N\n1.1,2\n", "wants the area of the specimen at rest (--area"},
        {"stretch,stress_Pa\n1,1,2,5\n", "a decimal comma wants ; or a tab between the fields"},
        {"stretch;stress_mm\n1.1;2\n", "data.csv:1:9: the unit does not convert to Pa"},
        {"stretch,mode\n1.1,uniaxial\n", "data.csv:1:1: no column of stress"},
        {"stress_Pa\n1\n", "data.csv:1:1: no column of stretch"},
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
        {"stretch,stress_Pa\n1.1\n", "data.csv:2:1: 1 field where the header has 2"},
        {"stretch,stress_Pa\n1.1,2,3\n", "data.csv:2:1: 3 fields where the header has 2"},
        {"stretch,stress_Pa,mode\n1.1,2,shear\n", "data.csv:2:7: unknown mode"},
        {"stretch,stress_Pa\n\"1.1,2\n", "data.csv:2:1: a quote is not closed"},
        {"stretch,stress_Pa\n1.1,2\001\n", "data.csv:2:5: a control character"},
        {"stretch;stress_Pa\n1,1;2\n1.2;3\n", "data.csv:3:1: not a number (with decimal comma, as in the first rows): \"1.2\""},
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
    assert_non_null(strstr(error.message, "neither a regular file nor a pipe"));
    assert_int_equal(dea_fit_read("/", DEA_LOAD_UNIAXIAL, &data, &error), DEA_ERROR_IO);
    assert_int_equal(dea_fit_read("/no/such/file", DEA_LOAD_UNIAXIAL, &data, &error), DEA_ERROR_IO);
    assert_non_null(strstr(error.message, "No such file"));
    dea_fit_data_free(&data);
}

/* The conditions of Karush, Kuhn and Tucker: x >= 0, and no unknown that may move has a slope that lets the residual shrink. */
static void non_negative_least_squares_leave_no_way_down(void **state)
{
    enum { ROWS = 9, COLUMNS = 7, RUNS = 2000 };
    uint64_t seed = 2463534242u;
    int blocked = 0;
    (void)state;
    for (int run = 0; run < RUNS; run++) {
        double matrix[COLUMNS * ROWS], right[ROWS], x[COLUMNS], squares, sum = 0.0, residual[ROWS];
        const double common = 3.0 * deviate(&seed); /* from independent columns to nearly the same ones */
        for (int i = 0; i < ROWS; i++) {
            const double shared = common * deviate(&seed);
            right[i] = 2.0 * deviate(&seed) - 0.5;
            for (int j = 0; j < COLUMNS; j++) {
                matrix[j * ROWS + i] = shared + 2.0 * deviate(&seed) - 1.0;
            }
        }
        assert_int_equal(dea_nnls(ROWS, COLUMNS, matrix, right, x, &squares), DEA_OK);
        for (int i = 0; i < ROWS; i++) {
            residual[i] = right[i];
            for (int j = 0; j < COLUMNS; j++) {
                residual[i] -= matrix[j * ROWS + i] * x[j];
            }
            sum += residual[i] * residual[i];
        }
        assert_true(fabs(sum - squares) <= 1e-12);
        for (int j = 0; j < COLUMNS; j++) {
            double slope = 0.0;
            for (int i = 0; i < ROWS; i++) {
                slope += matrix[j * ROWS + i] * residual[i];
            }
            assert_true(x[j] >= 0.0);
            assert_true(slope <= 1e-10);
            assert_true(x[j] == 0.0 || slope >= -1e-10);
            blocked += x[j] == 0.0 && slope < -1e-3;
        }
    }
    assert_true(blocked > RUNS);
}

/* A film with three branches, of which the first ones are used. */
static const dea_prony film[] = {{0.3, 1.0}, {0.2, 15.0}, {0.15, 200.0}};

/* Normal deviate, as sum of twelve uniform ones. */
static double normal(uint64_t *seed)
{
    double sum = -6.0;
    for (int i = 0; i < 12; i++) {
        sum += deviate(seed);
    }
    return sum;
}

/* Stress of that film after a ramp of @p ramp, by the closed form of its branches. */
static double film_stress(int branches, double ramp, double time)
{
    double share = 1.0;
    for (int k = 0; k < branches; k++) {
        const double tau = film[k].tau;
        const double rise = ramp > 0.0 ? (1.0 - exp(-ramp / tau)) * tau / ramp : 1.0;
        share -= film[k].g * (1.0 - rise * exp(-time / tau));
    }
    return 8e4 * share;
}

/* A test of the film at @p count times from 0.1 s to 1000 s, and at 0 where @p zero, with noise of that share of each stress. */
static dea_relaxation_data film_test(int branches, double ramp, int count, bool zero, double noise, uint64_t *seed)
{
    dea_relaxation_data data = {.ramp = ramp};
    for (int i = zero ? -1 : 0; i < count; i++) {
        const double time = i < 0 ? 0.0 : 0.1 * pow(1e4, (double)i / (count - 1));
        const double stress = film_stress(branches, ramp, time) * (noise > 0.0 ? 1.0 + noise * normal(seed) : 1.0);
        assert_int_equal(dea_relaxation_add(&data, (dea_relaxation_point){.time = time, .stress = stress}, NULL), DEA_OK);
    }
    return data;
}

static void assert_near(double value, double wanted, double tolerance)
{
    if (!(fabs(value - wanted) <= tolerance * fabs(wanted))) {
        fail_msg("wanted %.12g, got %.12g", wanted, value);
    }
}

static void assert_shares_physical(const dea_relaxation *fit)
{
    double sum = 0.0;
    for (size_t i = 0; i < fit->prony_count; i++) {
        sum += fit->prony[i].g;
        assert_true(fit->prony[i].g > 0.0 && fit->prony[i].tau > 0.0);
        assert_true(i == 0 || fit->prony[i].tau > fit->prony[i - 1].tau);
    }
    assert_true(sum < 1.0 && fit->long_term > 0.0);
    assert_near(sum + fit->long_term, 1.0, 1e-12);
    assert_true(fit->prony_count <= (fit->count - 1) / 2);
}

static void exact_relaxation_gives_the_branches_back(void **state)
{
    static const double ramps[] = {0.0, 2.0, 20.0};
    (void)state;
    for (int branches = 1; branches <= 3; branches++) {
        for (int kind = 0; kind < 12; kind++) {
            dea_relaxation_data data = film_test(branches, ramps[kind % 3], 30, kind & 1, 0.0, NULL);
            dea_relaxation fit;
            assert_int_equal(dea_fit_relaxation(&data, 0, kind >= 6, &fit, NULL), DEA_OK);
            assert_int_equal(fit.prony_count, branches);
            assert_int_equal(fit.end, DEA_RELAXATION_EXACT);
            assert_near(fit.instantaneous, 8e4, 1e-6);
            for (int k = 0; k < branches; k++) {
                assert_near(fit.prony[k].g, film[k].g, 1e-6);
                assert_near(fit.prony[k].tau, film[k].tau, 1e-6);
            }
            assert_shares_physical(&fit);
            assert_true(fit.residual_relative < 1e-9);
            assert_near(dea_relaxation_stress(&fit, 7.0), film_stress(branches, data.ramp, 7.0), 1e-8);
            dea_relaxation_data_free(&data);
        }
    }
}

static void ramp_is_the_mean_of_the_steps_that_make_it_up(void **state)
{
    enum { STEPS = 2000 };
    (void)state;
    dea_relaxation fit = {.prony_count = 3, .long_term = 0.35, .instantaneous = 8e4};
    memcpy(fit.prony, film, sizeof film);
    for (double ramp = 0.5; ramp < 100.0; ramp *= 3.0) {
        for (double time = 0.0; time < 300.0; time = 3.0 * time + 0.3) {
            double mean = 0.0;
            for (int i = 0; i < STEPS; i++) {
                fit.ramp = 0.0;
                mean += dea_relaxation_stress(&fit, time + ramp * (i + 0.5) / STEPS) / STEPS;
            }
            fit.ramp = ramp;
            assert_near(dea_relaxation_stress(&fit, time), mean, 2e-4 * ramp * ramp / STEPS + 1e-9);
        }
    }
}

static void ramp_taken_for_a_step_hides_the_fast_branch(void **state)
{
    (void)state;
    dea_relaxation_data data = film_test(2, 5.0, 30, true, 0.0, NULL);
    dea_relaxation fit;
    data.ramp = 0.0;
    assert_int_equal(dea_fit_relaxation(&data, 2, false, &fit, NULL), DEA_OK);
    assert_near(fit.prony[0].tau, 1.0, 1e-6);
    assert_near(fit.instantaneous, film_stress(2, 5.0, 0.0), 1e-6);
    assert_true(fit.prony[0].g < 0.1); /* a fifth of its stress outlives the ramp */
    dea_relaxation_data_free(&data);
}

static void noise_adds_no_branch(void **state)
{
    enum { RUNS = 100 };
    uint64_t seed = 88172645463325252u;
    (void)state;
    for (int branches = 0; branches <= 3; branches++) {
        int more = 0;
        for (int run = 0; run < RUNS; run++) {
            dea_relaxation_data data = film_test(branches, run % 2 ? 2.0 : 0.0, 60, true, 0.005, &seed);
            dea_relaxation fit;
            assert_int_equal(dea_fit_relaxation(&data, 0, run % 4 > 1, &fit, NULL), DEA_OK);
            assert_true(fit.prony_count >= (size_t)branches);
            more += fit.prony_count > (size_t)branches;
            assert_shares_physical(&fit);
            assert_true(fit.residual_relative > 0.002 && fit.residual_relative < 0.01);
            dea_relaxation_data_free(&data);
        }
        assert_true(more <= 12); /* the test allows 5 %: 12 of 100 are three standard deviations above */
    }
}

static void noisy_branches_scatter_as_their_standard_errors_say(void **state)
{
    enum { RUNS = 300, BRANCHES = 2 };
    uint64_t seed = 1181783497276652981u;
    double tau[BRANCHES] = {0.0}, g[BRANCHES] = {0.0}, rest = 0.0;
    (void)state;
    for (int run = 0; run < RUNS; run++) {
        dea_relaxation_data data = film_test(BRANCHES, 2.0, 60, true, 0.005, &seed);
        dea_relaxation fit;
        assert_int_equal(dea_fit_relaxation(&data, BRANCHES, true, &fit, NULL), DEA_OK);
        for (int k = 0; k < BRANCHES; k++) {
            tau[k] += pow((fit.prony[k].tau - film[k].tau) / fit.deviation[k].tau, 2.0) / RUNS;
            g[k] += pow((fit.prony[k].g - film[k].g) / fit.deviation[k].g, 2.0) / RUNS;
        }
        rest += pow((fit.long_term - 0.5) / fit.long_term_deviation, 2.0) / RUNS;
        dea_relaxation_data_free(&data);
    }
    for (int k = 0; k < BRANCHES; k++) { /* 1 in the mean, scatter sqrt(2/300) = 0.08 */
        assert_true(tau[k] > 0.75 && tau[k] < 1.3);
        assert_true(g[k] > 0.75 && g[k] < 1.3);
    }
    assert_true(rest > 0.75 && rest < 1.3);
}

/* Coverage of the printed standard errors over 200 sets: 68 % of the truths within one, 95 % within two. */
static void printed_standard_errors_cover_the_truth(void **state)
{
    enum { RUNS = 200 };
    static const struct {
        double ramp, noise; /* noise as a share of the largest stress */
        int count;
    } cases[] = {{2.0, 0.003, 60}, {0.0, 0.01, 60}, {50.0, 2e-4, 80}, {100.0, 1e-5, 120}};
    uint64_t seed = 2862933555777941757u;
    (void)state;
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        int printed = 0, one = 0, two = 0;
        for (int run = 0; run < RUNS; run++) {
            dea_relaxation_data data = film_test(1, cases[i].ramp, cases[i].count, true, 0.0, NULL);
            dea_relaxation fit;
            for (size_t k = 0; k < data.count; k++) {
                data.points[k].stress += 8e4 * cases[i].noise * normal(&seed);
            }
            assert_int_equal(dea_fit_relaxation(&data, 0, false, &fit, NULL), DEA_OK);
            const double off[] = {fabs(fit.prony[0].g - film[0].g) / fit.deviation[0].g,
                                  fabs(fit.prony[0].tau - film[0].tau) / fit.deviation[0].tau,
                                  fabs(fit.long_term - 0.7) / fit.long_term_deviation};
            for (size_t k = 0; k < 3 && fit.prony_count == 1; k++) {
                printed += isfinite(off[k]);
                one += off[k] <= 1.0;
                two += off[k] <= 2.0;
            }
            dea_relaxation_data_free(&data);
        }
        assert_true(printed > 3 * RUNS * 8 / 10);
        assert_true(one > 0.6 * printed && one < 0.78 * printed); /* 600 numbers, of which 400 are free: 2.3 % of scatter */
        assert_true(two > 0.91 * printed);
    }
}

static void branch_that_the_ramp_hides_has_no_standard_error(void **state)
{
    uint64_t seed = 3935559000370003845u;
    int wrong = 0;
    (void)state;
    for (int run = 0; run < 50; run++) {
        dea_relaxation_data data = film_test(1, 100.0, 60, true, 0.0, NULL);
        dea_relaxation fit;
        for (size_t k = 0; k < data.count; k++) {
            data.points[k].stress += 8e4 * 2e-3 * normal(&seed); /* the ramp leaves 3e-3 of them */
        }
        assert_int_equal(dea_fit_relaxation(&data, 0, false, &fit, NULL), DEA_OK);
        wrong += fit.prony_count > 0 && fabs(fit.prony[0].tau - film[0].tau) > 3.0 * fit.deviation[0].tau;
        dea_relaxation_data_free(&data);
    }
    assert_true(wrong <= 2);
}

static void scattered_points_never_give_shares_beyond_the_whole(void **state)
{
    uint64_t seed = 362436069362436069u;
    int fits = 0;
    (void)state;
    for (int run = 0; run < 200; run++) {
        dea_relaxation_data data = {.ramp = run % 3};
        double time = 0.0;
        const int count = 3 + run % 20;
        for (int i = 0; i < count; i++) {
            const double stress = 1e4 * (deviate(&seed) + 3.0 / (1.0 + time));
            assert_int_equal(dea_relaxation_add(&data, (dea_relaxation_point){.time = time, .stress = stress}, NULL), DEA_OK);
            time += 0.01 + 3.0 * deviate(&seed);
        }
        dea_relaxation fit;
        dea_error error = {0};
        const dea_status status = dea_fit_relaxation(&data, 0, run % 2 == 1, &fit, &error);
        if (status == DEA_OK) {
            assert_shares_physical(&fit);
            fits++;
        } else {
            assert_int_equal(status, DEA_ERROR_USAGE);
            assert_true(strstr(error.message, "no long-term stress") || strstr(error.message, "the stress grows"));
        }
        dea_relaxation_data_free(&data);
    }
    assert_true(fits > 100);
}

/* Points at 0, 1, 2, ... s. */
static dea_relaxation_data seconds_of(const double *stresses, size_t count)
{
    dea_relaxation_data data = {0};
    for (size_t i = 0; i < count; i++) {
        assert_int_equal(dea_relaxation_add(&data, (dea_relaxation_point){.time = (double)i, .stress = stresses[i]}, NULL), DEA_OK);
    }
    return data;
}

static void held_stress_that_stays_has_no_branch(void **state)
{
    static const double stresses[] = {3e4, 3e4, 3e4, 3e4, 3e4, 3e4};
    char text[2000] = "";
    (void)state;
    for (size_t count = 3; count <= 6; count++) {
        dea_relaxation_data data = seconds_of(stresses, count);
        dea_relaxation fit;
        assert_int_equal(dea_fit_relaxation(&data, 0, false, &fit, NULL), DEA_OK);
        assert_int_equal(fit.prony_count, 0);
        assert_true(fit.long_term == 1.0);
        assert_near(fit.instantaneous, 3e4, 1e-12);
        FILE *stream = fmemopen(text, sizeof text, "w");
        assert_int_equal(dea_fit_print(NULL, &fit, NULL, stream, NULL), DEA_OK);
        fclose(stream);
        assert_non_null(strstr(text, "\nprony: []\n"));
        dea_relaxation_data_free(&data);
    }
}

static void tests_that_are_no_relaxation_are_refused(void **state)
{
    static const struct {
        double stresses[8];
        size_t count, branches;
        double ramp;
        const char *says;
    } cases[] = {
        {{1e4, 1.1e4, 1.2e4, 1.3e4, 1.4e4, 1.5e4}, 6, 0, 0.0, "the stress grows from 10000 Pa to 15000 Pa"},
        {{1e4, 1.1e4, 1.3e4}, 3, 0, 0.0, "the stress grows"},
        {{0.0, 0.0, 0.0}, 3, 0, 0.0, "all 3 measured stresses are 0"},
        {{1.0, 0.5, 0.25, 0.125, 0.0625, 0.03125}, 6, 0, 0.0, "no long-term stress"},
        {{1e4, 9e3}, 2, 0, 0.0, "2 points"},
        {{1e4, 9e3, 8.5e3}, 3, 2, 0.0, "3 points determine 1 at most"},
        {{1.5, 1.25, 1.125, 1.0625, 1.03125, 1.015625, 1.0078125},
         7,
         2,
         0.0,
         "2 branches were asked for, the data tells 1 apart"},
        {{1e4, 9e3, 8.5e3}, 3, 0, -1.0, "duration of the ramp"},
        {{1e4, 9e3, 8.5e3}, 3, 0, INFINITY, "duration of the ramp"},
    };
    (void)state;
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        dea_relaxation_data data = seconds_of(cases[i].stresses, cases[i].count);
        dea_relaxation fit;
        dea_error error = {0};
        data.ramp = cases[i].ramp;
        assert_int_equal(dea_fit_relaxation(&data, cases[i].branches, false, &fit, &error), DEA_ERROR_USAGE);
        if (!strstr(error.message, cases[i].says)) {
            fail_msg("wanted \"%s\", got \"%s\"", cases[i].says, error.message);
        }
        dea_relaxation_data_free(&data);
    }
}

static void ramp_inside_the_data_is_told(void **state)
{
    uint64_t seed = 4768777513237032717u;
    (void)state;
    for (int noisy = 0; noisy < 2; noisy++) {
        dea_relaxation_data data = {.ramp = 2.0};
        for (int i = 0; i < 60; i++) {
            const double time = 0.2 * i, clean = time < 2.0 ? 2e4 * time : 2e4 + 2e4 * exp(2.0 - time);
            assert_int_equal(dea_relaxation_add(&data, (dea_relaxation_point){.time = time, .stress = clean + 300.0 * noisy * normal(&seed)}, NULL), DEA_OK);
        }
        dea_relaxation fit;
        dea_error error = {0};
        assert_int_equal(dea_fit_relaxation(&data, 0, false, &fit, &error), DEA_ERROR_DATA);
        assert_non_null(strstr(error.message, "Pa at 2 s before it falls"));
        assert_non_null(strstr(error.message, "leave out the 10 rows before and subtract 2 s"));
        dea_relaxation_data_free(&data);
    }
}

static void noise_about_zero_is_a_measurement(void **state)
{
    uint64_t seed = 1865811235122147685u;
    (void)state;
    dea_relaxation_data data = {0};
    size_t below = 0;
    for (int i = 0; i < 60; i++) {
        const double stress = 2e4 * (0.01 + 0.99 * exp(-0.2 * i)) + 300.0 * normal(&seed);
        below += stress < 0.0;
        assert_int_equal(dea_relaxation_add(&data, (dea_relaxation_point){.time = i, .stress = stress}, NULL), DEA_OK);
    }
    dea_relaxation fit;
    assert_true(below > 0);
    assert_int_equal(dea_fit_relaxation(&data, 0, false, &fit, NULL), DEA_OK);
    assert_true(fabs(fit.prony[0].tau - 5.0) < 3.0 * fit.deviation[0].tau);
    dea_relaxation_data_free(&data);
}

static void clock_that_was_not_set_to_zero_is_refused(void **state)
{
    (void)state;
    dea_relaxation_data data = {0};
    for (int i = 0; i < 6; i++) {
        assert_int_equal(dea_relaxation_add(&data, (dea_relaxation_point){.time = 1000.0 + i, .stress = 1e4 + 1e3 * exp(-i)}, NULL), DEA_OK);
    }
    dea_relaxation fit;
    dea_error error = {0};
    assert_int_equal(dea_fit_relaxation(&data, 0, false, &fit, &error), DEA_ERROR_USAGE);
    assert_non_null(strstr(error.message, "time counts from the end of the ramp"));
    dea_relaxation_data_free(&data);
}

static void three_points_determine_one_branch(void **state)
{
    static const double stresses[] = {3.0, 2.0, 1.5}; /* 1 + 2 * 2^-t */
    (void)state;
    dea_relaxation_data data = seconds_of(stresses, 3);
    dea_relaxation fit;
    assert_int_equal(dea_fit_relaxation(&data, 0, false, &fit, NULL), DEA_OK);
    assert_int_equal(fit.prony_count, 1);
    assert_near(fit.prony[0].tau, 1.0 / log(2.0), 1e-6);
    assert_near(fit.prony[0].g, 2.0 / 3.0, 1e-6);
    assert_true(isnan(fit.deviation[0].tau) && isnan(fit.trials[1].p));
    dea_relaxation_data_free(&data);
}

static dea_status parse_held(const char *text, dea_relaxation_data *data, dea_error *error)
{
    *error = (dea_error){0};
    return dea_relaxation_parse(text, strlen(text), "hold.csv", data, error);
}

static void relaxation_tables_are_read_in_their_units(void **state)
{
    static const char *const texts[] = {
        "time_s,stress_Pa\n0,3000\n30,2000\n60,1500\n",
        "# held\nstress_kPa;time_min\n3;0\n2;0.5\n\n1.5;1\n",
        "time_ms\tstress_MPa\n0\t0.003\n3e4\t0.002\n6e4\t0.0015",
    };
    (void)state;
    for (size_t i = 0; i < sizeof texts / sizeof *texts; i++) {
        dea_relaxation_data data = {0};
        dea_error error;
        assert_int_equal(parse_held(texts[i], &data, &error), DEA_OK);
        assert_int_equal(data.count, 3);
        assert_near(data.points[1].time, 30.0, 1e-12);
        assert_near(data.points[2].stress, 1500.0, 1e-12);
        assert_int_equal(parse_held(texts[i], &data, &error), DEA_ERROR_USAGE);
        assert_int_equal(data.count, 3);
        dea_relaxation_data_free(&data);
    }
}

static void rows_of_a_rounded_clock_become_their_mean(void **state)
{
    (void)state;
    dea_relaxation_data data = {0};
    dea_error error;
    assert_int_equal(parse_held("time_s,stress_Pa\n0,9\n0,7\n0,5\n1,3\n2,2\n2,1\n", &data, &error), DEA_OK);
    assert_int_equal(data.count, 3);
    assert_near(data.points[0].stress, 7.0, 1e-15);
    assert_near(data.points[2].stress, 1.5, 1e-15);
    dea_relaxation_data_free(&data);
}

static void bad_relaxation_tables_are_named_by_line_and_column(void **state)
{
    static const struct {
        const char *text, *says;
    } cases[] = {
        {"", "hold.csv:1:1: no row of two or more numbers"},
        {"times,stress_Pa\n0,3\n1,2\n2,1\n", "hold.csv:1:1: no column of time; did you mean \"times\"?"},
        {"time_s\n0\n", "hold.csv:1:1: no column of stress"},
        {"stress_Pa\n3\n", "hold.csv:1:1: no column of time"},
        {"time_s,time_ms,stress_Pa\n", "hold.csv:1:8: a second column"},
        {"time_s,stress_Pa\n0,3\n1,2\n", "hold.csv:3:1: 2 points; a relaxation test needs at least 3"},
        {"time_s,stress_Pa\n", "hold.csv:1:1: 0 points"},
        {"time_s,stress_Pa\n0,3\n1,-2\n2,1\n", "hold.csv:3:3: a stress is not negative, in compression too: -2 Pa"},
        {"time_s,stress_Pa\n-1,3\n1,2\n2,1\n", "hold.csv:2:1: a time is not negative"},
        {"time_s,stress_Pa\n0,3\n1,2\n1,1\n", "2 points"},
        {"time_s,stress_Pa\n0,3\n2,2\n1,1\n", "hold.csv:4:1: time does not increase: \"1\""},
        {"time_s,stress_Pa\n0,3\n1,nan\n2,1\n", "hold.csv:3:3: not a number: \"nan\""},
        {"time_s,stress_Pa\n0,3\ninf,2\n2,1\n", "hold.csv:3:1: not a number"},
        {"time_s,stress_Pa\n0,3\n1,soft\n2,1\n", "hold.csv:3:3: not a number: \"soft\""},
        {"time_s,stress_Pa\n0,3\n1\n2,1\n", "hold.csv:3:1: 1 field where the header has 2"},
        {"time_min,stress_MPa\n0,3\n1e308,2\n", "hold.csv:3:1: this number is too large"},
    };
    (void)state;
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        dea_relaxation_data data = {0};
        dea_error error;
        assert_int_equal(parse_held(cases[i].text, &data, &error), DEA_ERROR_SCENE);
        if (!strstr(error.message, cases[i].says)) {
            fail_msg("wanted \"%s\", got \"%s\"", cases[i].says, error.message);
        }
        assert_int_equal(data.count, 0);
        dea_relaxation_data_free(&data);
    }
}

/* What tests/peers/relaxation.py gives: SciPy's nnls inside least_squares from 60 random starts. */
static void acrylic_film_relaxes_as_an_independent_fit_says(void **state)
{
    static const struct {
        const char *path;
        double ramp;
        double rms[4], p[4], long_term[4]; /* of 0 to 3 branches; rms in percent */
        dea_prony two[2], three[3];
    } cases[] = {
        {"examples/data/vhb4910-relaxation-1.5.csv",
         2.0,
         {42.675163, 10.785183, 2.7403771, 0.40320986},
         {NAN, 0.001031, 0.0164, 0.1471},
         {1.0, 0.30774692, 0.20044689, 0.1629669},
         {{0.57704444, 1.3781981}, {0.22250867, 37.88113}},
         {{0.52011132, 0.78394496}, {0.19283341, 7.5760223}, {0.12408836, 100.6305}}},
        {"examples/data/vhb4910-relaxation-3.0.csv",
         8.0,
         {31.446305, 5.207349, 1.3961192, 0.4127359},
         {NAN, 0.0001245, 0.01927, 0.2956},
         {1.0, 0.40332744, 0.2975054, 0.22045271},
         {{0.46419649, 5.0216476}, {0.23829811, 79.215128}},
         {{0.37912477, 0.978448}, {0.24793993, 9.1130073}, {0.1524826, 101.99229}}},
    };
    (void)state;
    for (size_t i = 0; i < 2; i++) {
        dea_relaxation_data data = {.ramp = cases[i].ramp};
        dea_relaxation fit;
        assert_int_equal(dea_relaxation_read(cases[i].path, &data, NULL), DEA_OK);
        assert_int_equal(data.count, 8);
        for (size_t branches = 3; branches != 1; branches = branches == 3 ? 0 : 1) {
            assert_int_equal(dea_fit_relaxation(&data, branches, false, &fit, NULL), DEA_OK);
            assert_int_equal(fit.prony_count, branches == 3 ? 3 : 2);
            assert_int_equal(fit.trial_count, 4);
            for (size_t k = 0; k < fit.trial_count; k++) {
                assert_near(fit.trials[k].residual_relative, 0.01 * cases[i].rms[k], 1e-6);
                assert_near(fit.trials[k].long_term, cases[i].long_term[k], 1e-4);
                if (k > 0) {
                    assert_near(fit.trials[k].p, cases[i].p[k], 1e-3);
                }
            }
            const dea_prony *wanted = branches == 3 ? cases[i].three : cases[i].two;
            for (size_t k = 0; k < fit.prony_count; k++) {
                assert_near(fit.prony[k].g, wanted[k].g, 1e-4);
                assert_near(fit.prony[k].tau, wanted[k].tau, 1e-4);
            }
        }
        dea_relaxation_data_free(&data);
    }
}

/* Writes a fit of both kinds, or of the relaxation alone, into a material file, under a first line. */
static void write_film(const char *path, const char *line, bool both)
{
    dea_fit_data stretch = {0};
    dea_relaxation_data held = film_test(2, 2.0, 30, true, 0.0, NULL);
    dea_fit yeoh;
    dea_relaxation prony;
    data_add(&stretch, DEA_LOAD_UNIAXIAL, 2.0, 20, 0.0, NULL);
    assert_int_equal(dea_fit_yeoh(&stretch, 3, false, &yeoh, NULL), DEA_OK);
    assert_int_equal(dea_fit_relaxation(&held, 0, false, &prony, NULL), DEA_OK);
    FILE *stream = fopen(path, "w");
    assert_non_null(stream);
    fputs(line, stream);
    assert_int_equal(dea_fit_print(both ? &yeoh : NULL, &prony, NULL, stream, NULL), DEA_OK);
    assert_int_equal(fclose(stream), 0);
    dea_fit_data_free(&stretch);
    dea_relaxation_data_free(&held);
}

static void fitted_relaxation_serves_as_the_material_of_a_scene(void **state)
{
    static const struct {
        const char *line;
        bool both;
        const char *material;
        double c1;
    } cases[] = {
        {"", true, "{base: ./film.yaml, permittivity: 2.8}", 178426.0},
        {"", false, "{base: ./film.yaml, yeoh: {C1: 90 kPa}, permittivity: 2.8}", 9e4},
        {"base: elastosil-2030\n", false, "./film.yaml", 178426.0},
        {"", true, "{base: elastosil-2030, prony: [{g: 0.3, tau: 1 s}, {g: 0.2, tau: 15 s}]}", 178426.0},
    };
    char folder[] = "/tmp/dea_fit_XXXXXX", path[64];
    (void)state;
    assert_non_null(mkdtemp(folder));
    snprintf(path, sizeof path, "%s/film.yaml", folder);
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        char text[600];
        dea_scene scene;
        dea_error error = {0};
        write_film(path, cases[i].line, cases[i].both);
        snprintf(text, sizeof text,
                 "actuator: {kind: dot, frame_radius: 30 mm, coverage: 0.5, film_thickness: 100 um, prestretch: 1.2}\n"
                 "material: %s\ndrive: {voltage: 1 V}\nmodel: lumped\nstudy: {sweep: {}}\n",
                 cases[i].material);
        if (dea_scene_parse(text, strlen(text), "fit", folder, NULL, 0, NULL, &scene, &error) != DEA_OK) {
            fail_msg("%s", error.message);
        }
        assert_near(scene.material.constants[0], cases[i].c1, 1e-6);
        assert_false(scene.material.instantaneous);
        assert_int_equal(scene.material.prony_count, 2);
        for (int k = 0; k < 2; k++) {
            assert_near(scene.material.prony[k].g, film[k].g, 1e-6);
            assert_near(scene.material.prony[k].tau, film[k].tau, 1e-6);
        }
        dea_scene_free(&scene);
    }
    assert_int_equal(unlink(path), 0);
    assert_int_equal(rmdir(folder), 0);
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
        cmocka_unit_test(non_negative_least_squares_leave_no_way_down),
        cmocka_unit_test(exact_relaxation_gives_the_branches_back),
        cmocka_unit_test(ramp_is_the_mean_of_the_steps_that_make_it_up),
        cmocka_unit_test(ramp_taken_for_a_step_hides_the_fast_branch),
        cmocka_unit_test(noise_adds_no_branch),
        cmocka_unit_test(noisy_branches_scatter_as_their_standard_errors_say),
        cmocka_unit_test(scattered_points_never_give_shares_beyond_the_whole),
        cmocka_unit_test(held_stress_that_stays_has_no_branch),
        cmocka_unit_test(tests_that_are_no_relaxation_are_refused),
        cmocka_unit_test(clock_that_was_not_set_to_zero_is_refused),
        cmocka_unit_test(three_points_determine_one_branch),
        cmocka_unit_test(relaxation_tables_are_read_in_their_units),
        cmocka_unit_test(bad_relaxation_tables_are_named_by_line_and_column),
        cmocka_unit_test(acrylic_film_relaxes_as_an_independent_fit_says),
        cmocka_unit_test(constants_that_the_data_do_not_tell_are_dropped),
        cmocka_unit_test(tables_that_are_no_stretch_are_told),
        cmocka_unit_test(elasticity_whose_sign_is_noise_is_none),
        cmocka_unit_test(unloading_is_told_and_a_second_test_is_not),
        cmocka_unit_test(printed_standard_errors_cover_the_truth),
        cmocka_unit_test(branch_that_the_ramp_hides_has_no_standard_error),
        cmocka_unit_test(ramp_inside_the_data_is_told),
        cmocka_unit_test(noise_about_zero_is_a_measurement),
        cmocka_unit_test(rows_of_a_rounded_clock_become_their_mean),
        cmocka_unit_test(fitted_relaxation_serves_as_the_material_of_a_scene),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
