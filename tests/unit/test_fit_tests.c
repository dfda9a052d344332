/* Prony branches from dynamic moduli and from creep. Judges are the complex modulus of the branches, and the strain of a film of
 * springs and dampers under a stress, integrated step by step: neither knows compliances nor the models of the fit. */
#include <complex.h>
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#include "deaspice/fit.h"

static const dea_prony film[] = {{0.2, 0.05}, {0.15, 1.0}, {0.1, 20.0}};
enum { BRANCHES = 3 };
static const double modulus = 1e6; /* instantaneous [Pa] */

/* Uniform deviate of 53 bits (xorshift), always the same sequence. */
static double deviate(uint64_t *seed)
{
    *seed ^= *seed << 13;
    *seed ^= *seed >> 7;
    *seed ^= *seed << 17;
    return ((double)(*seed >> 11) + 0.5) * 0x1p-53;
}

static double normal(uint64_t *seed)
{
    return sqrt(-2.0 * log(deviate(seed))) * cos(2.0 * DEA_PI * deviate(seed));
}

/* E* = E_0 (1 - sum g/(1 + i omega tau)). */
static double complex modulus_at(int branches, double omega)
{
    double complex share = 1.0;
    for (int k = 0; k < branches; k++) {
        share -= film[k].g / (1.0 + I * omega * film[k].tau);
    }
    return modulus * share;
}

/* @p count frequencies of 1 mHz to 100 Hz. */
static dea_relaxation_data dynamic_test(int branches, int count, double noise, uint64_t *seed)
{
    dea_relaxation_data data = {.kind = DEA_TEST_DYNAMIC};
    for (int i = 0; i < count; i++) {
        const double omega = 2.0 * DEA_PI * pow(10.0, -3.0 + 5.0 * i / (count - 1));
        const double complex e = modulus_at(branches, omega);
        const double off = noise > 0.0 ? noise * modulus * normal(seed) : 0.0, more = noise > 0.0 ? noise * modulus * normal(seed) : 0.0;
        const dea_relaxation_point point = {.time = omega, .stress = creal(e) + off, .loss = cimag(e) + more};
        assert_int_equal(dea_relaxation_add(&data, point, NULL), DEA_OK);
    }
    return data;
}

/* Strain of E_0 (e - sum g q) = stress, tau q' = e - q. */
static double strain_of(int branches, double stress, const double *q)
{
    double strain = stress / modulus;
    for (int k = 0; k < branches; k++) {
        strain += film[k].g * q[k];
    }
    return strain;
}

static void rates(int branches, double stress, const double *q, double *slope)
{
    const double strain = strain_of(branches, stress, q);
    for (int k = 0; k < branches; k++) {
        slope[k] = (strain - q[k]) / film[k].tau;
    }
}

/* Runge and Kutta over a time in which the stress goes evenly from one value to another. */
static void pass(int branches, double length, double from, double to, double *q)
{
    const int steps = (int)ceil(length / 0.004);
    const double h = length / steps;
    for (int i = 0; i < steps; i++) {
        const double s[] = {from + (to - from) * i / steps, from + (to - from) * (i + 0.5) / steps, from + (to - from) * (i + 1.0) / steps};
        double k[4][BRANCHES], at[BRANCHES];
        for (int stage = 0; stage < 4; stage++) {
            const double part = stage == 0 ? 0.0 : stage == 3 ? h : 0.5 * h;
            for (int b = 0; b < branches; b++) {
                at[b] = q[b] + (stage > 0 ? part * k[stage - 1][b] : 0.0);
            }
            rates(branches, s[(stage + 1) / 2], at, k[stage]);
        }
        for (int b = 0; b < branches; b++) {
            q[b] += h / 6.0 * (k[0][b] + 2.0 * k[1][b] + 2.0 * k[2][b] + k[3][b]);
        }
    }
}

/* Strain at 0 and @p count times of 10 ms to 300 s under 1 Pa, reached by a ramp. */
static dea_relaxation_data creep_test(int branches, double ramp, int count)
{
    dea_relaxation_data data = {.kind = DEA_TEST_CREEP, .ramp = ramp};
    double q[BRANCHES] = {0.0}, now = 0.0;
    pass(branches, ramp, 0.0, 1.0, q);
    for (int i = -1; i < count; i++) {
        const double time = i < 0 ? 0.0 : 0.01 * pow(3e4, (double)i / (count - 1));
        pass(branches, time - now, 1.0, 1.0, q);
        now = time;
        const dea_relaxation_point point = {.time = time, .stress = strain_of(branches, 1.0, q)};
        assert_int_equal(dea_relaxation_add(&data, point, NULL), DEA_OK);
    }
    return data;
}

static void assert_near(double value, double wanted, double tolerance)
{
    if (!(fabs(value - wanted) <= tolerance * fabs(wanted))) {
        fail_msg("wanted %.12g, got %.12g", wanted, value);
    }
}

static void assert_film(const dea_relaxation *fit, int branches, double tolerance)
{
    double rest = 1.0;
    assert_int_equal(fit->prony_count, branches);
    for (int k = 0; k < branches; k++) {
        assert_near(fit->prony[k].g, film[k].g, tolerance);
        assert_near(fit->prony[k].tau, film[k].tau, tolerance);
        rest -= film[k].g;
    }
    assert_near(fit->long_term, rest, tolerance);
}

static void exact_moduli_give_the_branches_back(void **state)
{
    (void)state;
    for (int branches = 1; branches <= BRANCHES; branches++) {
        for (int relative = 0; relative < 2; relative++) {
            dea_relaxation_data data = dynamic_test(branches, 40, 0.0, NULL);
            dea_relaxation fit;
            assert_int_equal(dea_fit_relaxation(&data, 0, relative == 1, &fit, NULL), DEA_OK);
            assert_film(&fit, branches, 1e-6);
            assert_near(fit.instantaneous, modulus, 1e-7);
            assert_near(dea_relaxation_stress(&fit, 3.0), creal(modulus_at(branches, 3.0)), 1e-8);
            assert_near(dea_relaxation_loss(&fit, 3.0), cimag(modulus_at(branches, 3.0)), 1e-7);
            dea_relaxation_data_free(&data);
        }
    }
}

/* The times of retardation are longer than those of relaxation, and their shares others. */
static void exact_creep_gives_the_branches_of_the_modulus(void **state)
{
    (void)state;
    for (int branches = 1; branches <= BRANCHES; branches++) {
        for (int ramped = 0; ramped < 2; ramped++) {
            dea_relaxation_data data = creep_test(branches, 0.5 * ramped, 60);
            dea_relaxation fit;
            assert_int_equal(dea_fit_relaxation(&data, 0, false, &fit, NULL), DEA_OK);
            assert_film(&fit, branches, 1e-5);
            assert_near(fit.instantaneous, 1.0 / modulus, 1e-5);
            assert_true(fit.retardation[0].tau > 1.1 * fit.prony[0].tau);
            assert_near(dea_relaxation_stress(&fit, data.points[30].time), data.points[30].stress, 1e-7);
            dea_relaxation_data_free(&data);
        }
    }
}

/* Coverage of the printed standard errors over 200 sets: 68 % of the truths within one, 95 % within two. */
static void assert_coverage(dea_relaxation_data data, double noise, uint64_t *seed)
{
    enum { RUNS = 200, TWO = 2 };
    int printed = 0, one = 0, two = 0;
    dea_relaxation_point *clean = malloc(data.count * sizeof *clean);
    memcpy(clean, data.points, data.count * sizeof *clean);
    for (int run = 0; run < RUNS; run++) {
        dea_relaxation fit;
        for (size_t i = 0; i < data.count; i++) {
            data.points[i].stress = clean[i].stress + noise * normal(seed);
            data.points[i].loss = clean[i].loss + (data.kind == DEA_TEST_DYNAMIC ? noise * normal(seed) : 0.0);
        }
        assert_int_equal(dea_fit_relaxation(&data, 0, false, &fit, NULL), DEA_OK);
        double off[2 * TWO + 1] = {fabs(fit.long_term - 0.65) / fit.long_term_deviation};
        for (size_t k = 0; k < TWO && fit.prony_count == TWO; k++) {
            off[1 + 2 * k] = fabs(fit.prony[k].g - film[k].g) / fit.deviation[k].g;
            off[2 + 2 * k] = fabs(fit.prony[k].tau - film[k].tau) / fit.deviation[k].tau;
        }
        for (size_t k = 0; k < 2 * TWO + 1 && fit.prony_count == TWO; k++) {
            printed += isfinite(off[k]);
            one += off[k] <= 1.0;
            two += off[k] <= 2.0;
        }
    }
    free(clean);
    assert_true(printed > (2 * TWO + 1) * RUNS * 8 / 10);
    assert_true(one > 0.62 * printed && one < 0.76 * printed);
    assert_true(two > 0.92 * printed);
}

static void standard_errors_of_moduli_cover_the_truth(void **state)
{
    uint64_t seed = 2862933555777941757u;
    (void)state;
    dea_relaxation_data data = dynamic_test(2, 40, 0.0, NULL);
    assert_coverage(data, 0.003 * modulus, &seed);
    dea_relaxation_data_free(&data);
}

static void standard_errors_of_creep_cover_the_truth(void **state)
{
    uint64_t seed = 1181783497276652981u;
    (void)state;
    for (int ramped = 0; ramped < 2; ramped++) {
        dea_relaxation_data data = creep_test(2, 0.2 * ramped, 60);
        assert_coverage(data, 0.002 / modulus, &seed);
        dea_relaxation_data_free(&data);
    }
}

static dea_status read_table(const char *text, dea_test_kind kind, dea_relaxation_data *data, dea_error *error)
{
    *data = (dea_relaxation_data){.kind = kind};
    return dea_relaxation_parse(text, strlen(text), "t.csv", data, error);
}

/* Hertz and radians per second by the header, in any order of the rows; rows of one frequency are their mean. */
static void tables_say_what_their_frequencies_are(void **state)
{
    static const char *const tables[] = {
        "Frequency (Hz),Storage Modulus (kPa),Loss Modulus (kPa),T\n1,500,50,23\n10,600,60,23\n100,700,70,23\n",
        "frequency_rad/s;G' (MPa);G'' (kPa)\n628,318530717958648;0,7;70\n62,8318530717958648;0,6;60\n6,28318530717958648;0,5;50\n",
        "f (kHz)\ttan delta (%)\tE' (Pa)\n0.001\t10\t5e5\n0.01\t10\t6e5\n0.1\t10\t7e5\n",
        "omega (rad/s),storage (Pa),loss (Pa)\n6.283185307179586,4e5,4e4\n6.283185307179586,6e5,6e4\n62.83185307179586,6e5,6e4\n628.3185307179586,7e5,7e4\n"};
    (void)state;
    for (size_t i = 0; i < sizeof tables / sizeof *tables; i++) {
        dea_relaxation_data data;
        dea_error error = {0};
        if (read_table(tables[i], DEA_TEST_DYNAMIC, &data, &error) != DEA_OK) {
            fail_msg("%s", error.message);
        }
        assert_int_equal(data.count, 3);
        for (int k = 0; k < 3; k++) {
            assert_near(data.points[k].time, 2.0 * DEA_PI * pow(10.0, k), 1e-12);
            assert_near(data.points[k].stress, 5e5 + 1e5 * k, 1e-12);
            assert_near(data.points[k].loss, 5e4 + 1e4 * k, 1e-12);
        }
        dea_relaxation_data_free(&data);
    }
    static const char *const creeps[] = {"time_s,strain (%)\n0,1\n1,2\n2,2.5\n", "t (ms),stretch\n0,1.01\n1000,1.02\n2000,1.025\n",
                                         "time_s,compliance (1/MPa)\n0,0.01\n1,0.02\n2,0.025\n"};
    for (size_t i = 0; i < sizeof creeps / sizeof *creeps; i++) {
        dea_relaxation_data data;
        dea_error error = {0};
        if (read_table(creeps[i], DEA_TEST_CREEP, &data, &error) != DEA_OK) {
            fail_msg("%s", error.message);
        }
        assert_near(data.points[2].stress / data.points[0].stress, 2.5, 1e-9);
        assert_near(data.points[2].time, 2.0, 1e-12);
        dea_relaxation_data_free(&data);
    }
}

static void tables_of_another_kind_are_refused_by_name(void **state)
{
    static const struct {
        dea_test_kind kind;
        const char *table, *says;
    } wrong[] = {
        {DEA_TEST_DYNAMIC, "frequency,storage_kPa,loss_kPa\n1,2,3\n2,3,4\n3,4,5\n", "a column without unit (write e.g. frequency_kHz)"},
        {DEA_TEST_DYNAMIC, "frequency_V,storage_kPa,loss_kPa\n1,2,3\n2,3,4\n3,4,5\n", "the unit does not convert to Hz"},
        {DEA_TEST_DYNAMIC, "storage_kPa,loss_kPa\n1,2\n2,3\n3,4\n", "no column of frequency"},
        {DEA_TEST_DYNAMIC, "frequency_Hz,storage_kPa\n1,2\n2,3\n3,4\n", "no column of loss modulus"},
        {DEA_TEST_DYNAMIC, "frequency_Hz,loss_kPa\n1,2\n2,3\n3,4\n", "no column of storage modulus"},
        {DEA_TEST_DYNAMIC, "frequency_Hz,storage_kPa,loss_kPa\n1,2,3\n0,3,4\n3,4,5\n", "t.csv:3:1: a frequency is above 0: \"0\""},
        {DEA_TEST_DYNAMIC, "frequency_Hz,storage_kPa,loss_kPa\n1,2,3\n-1,3,4\n3,4,5\n", "a frequency is above 0: \"-1\""},
        {DEA_TEST_DYNAMIC, "frequency_Hz,storage_kPa,loss_kPa\n1,2,3\n1,3,4\n3,4,5\n", "2 points; a dynamic test needs at least 3"},
        {DEA_TEST_DYNAMIC, "frequency_Hz,storage_kPa,loss_kPa\n1,2,3\n2,nan,4\n3,4,5\n", "t.csv:3:"},
        {DEA_TEST_CREEP, "time_s,stress_kPa\n0,2\n1,3\n2,4\n", "no column of strain"},
        {DEA_TEST_CREEP, "strain,stress_kPa\n0,2\n1,3\n2,4\n", "no column of time"},
        {DEA_TEST_CREEP, "time_s,strain\n0,0.1\n1,0.2\n0.5,0.3\n", "time does not increase"},
        {DEA_TEST_CREEP, "time_s,strain\n-1,0.1\n1,0.2\n2,0.3\n", "a time is not negative"},
        {DEA_TEST_CREEP, "time_s,strain\n0,-0.1\n1,-0.2\n2,0.3\n", "t.csv:3:3: a strain is not negative"},
    };
    (void)state;
    for (size_t i = 0; i < sizeof wrong / sizeof *wrong; i++) {
        dea_relaxation_data data;
        dea_error error = {0};
        assert_int_equal(read_table(wrong[i].table, wrong[i].kind, &data, &error), DEA_ERROR_SCENE);
        if (!strstr(error.message, wrong[i].says)) {
            fail_msg("wanted \"%s\", got \"%s\"", wrong[i].says, error.message);
        }
        dea_relaxation_data_free(&data);
    }
}

static void tests_that_no_film_gives_are_refused(void **state)
{
    static const struct {
        dea_test_kind kind;
        double stresses[8], losses[8];
        size_t branches;
        const char *says;
    } wrong[] = {
        {DEA_TEST_DYNAMIC, {8e5, 7e5, 6e5, 5e5, 4.5e5, 4e5, 3e5, 2e5}, {0}, 0, "the storage modulus falls from 800000 Pa to 200000 Pa"},
        {DEA_TEST_DYNAMIC, {2e5, 3e5, 4e5, 5e5, 6e5, 7e5, 8e5, 9e5}, {1e5, -2e5}, 0, "a loss modulus of -200000 Pa"},
        {DEA_TEST_DYNAMIC, {2e5, -3e5, 4e5, 5e5, 6e5, 7e5, 8e5, 9e5}, {1e5}, 0, "a storage modulus of -300000 Pa"},
        {DEA_TEST_DYNAMIC, {0}, {0}, 0, "all 8 measured values are 0"},
        {DEA_TEST_DYNAMIC, {2e5, 3e5, 4e5, 5e5, 6e5, 7e5, 8e5, 9e5}, {1e5}, 8, "determine 7 at most"},
        {DEA_TEST_CREEP, {0.8, 0.7, 0.6, 0.5, 0.45, 0.42, 0.41, 0.4}, {0}, 0, "the strain falls from 0.8 to 0.4"},
        {DEA_TEST_CREEP, {0.4, 0.5, 0.6, 0.7, 0.8, 0.3, 0.2, 0.1}, {0}, 0, "the strain grows to 0.8 at 4 s and then falls to 0.1"},
        {DEA_TEST_CREEP, {0.0, 0.5, 0.75, 0.875, 0.9375, 0.96875, 0.984375, 0.9921875}, {0}, 0, "leaves no strain at the start"},
    };
    (void)state;
    for (size_t i = 0; i < sizeof wrong / sizeof *wrong; i++) {
        dea_relaxation_data data = {.kind = wrong[i].kind};
        dea_relaxation fit;
        dea_error error = {0};
        for (size_t k = 0; k < 8; k++) {
            const double at = wrong[i].kind == DEA_TEST_CREEP ? (double)k : (double)k + 1.0;
            const dea_relaxation_point point = {.time = at, .stress = wrong[i].stresses[k], .loss = wrong[i].losses[k]};
            assert_int_equal(dea_relaxation_add(&data, point, NULL), DEA_OK);
        }
        if (dea_fit_relaxation(&data, wrong[i].branches, false, &fit, &error) == DEA_OK) {
            fail_msg("not refused: %s", wrong[i].says);
        }
        if (!strstr(error.message, wrong[i].says)) {
            fail_msg("wanted \"%s\", got \"%s\"", wrong[i].says, error.message);
        }
        dea_relaxation_data_free(&data);
    }
}

/* A film that does not creep has no branch, and a flow without an end says that its last share is extrapolated. */
static void creep_without_an_end_is_extrapolated(void **state)
{
    (void)state;
    dea_relaxation_data still = {.kind = DEA_TEST_CREEP}, flow = {.kind = DEA_TEST_CREEP};
    dea_relaxation fit;
    for (int i = 0; i < 20; i++) {
        const dea_relaxation_point held = {.time = i, .stress = 0.1}, flowing = {.time = i, .stress = 0.1 + 0.01 * i};
        assert_int_equal(dea_relaxation_add(&still, held, NULL), DEA_OK);
        assert_int_equal(dea_relaxation_add(&flow, flowing, NULL), DEA_OK);
    }
    assert_int_equal(dea_fit_relaxation(&still, 0, false, &fit, NULL), DEA_OK);
    assert_int_equal(fit.prony_count, 0);
    assert_int_equal(dea_fit_relaxation(&flow, 0, false, &fit, NULL), DEA_OK);
    assert_true(fit.prony_count > 0 && dea_relaxation_slow(&fit));
    dea_relaxation_data_free(&still);
    dea_relaxation_data_free(&flow);
}

/* Times whose ratios overflow leave nothing of a branch, or all of it. */
static void times_over_all_decades_are_fitted(void **state)
{
    (void)state;
    for (dea_test_kind kind = DEA_TEST_RELAXATION; kind < DEA_TESTS; kind++) {
        static const double times[] = {1e-300, 1.0, 2.0, 1e300}, falling[] = {1.0, 0.5, 0.25, 0.24}, rising[] = {0.1, 0.2, 0.25, 0.26};
        dea_relaxation_data data = {.kind = kind};
        dea_relaxation fit;
        for (int i = 0; i < 4; i++) {
            const dea_relaxation_point point = {.time = times[i], .stress = kind == DEA_TEST_RELAXATION ? falling[i] : rising[i]};
            assert_int_equal(dea_relaxation_add(&data, point, NULL), DEA_OK);
        }
        assert_int_equal(dea_fit_relaxation(&data, 0, false, &fit, NULL), DEA_OK);
        assert_true(fit.long_term > 0.0 && fit.long_term <= 1.0);
        dea_relaxation_data_free(&data);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(exact_moduli_give_the_branches_back),
        cmocka_unit_test(exact_creep_gives_the_branches_of_the_modulus),
        cmocka_unit_test(standard_errors_of_moduli_cover_the_truth),
        cmocka_unit_test(standard_errors_of_creep_cover_the_truth),
        cmocka_unit_test(tables_say_what_their_frequencies_are),
        cmocka_unit_test(tables_of_another_kind_are_refused_by_name),
        cmocka_unit_test(tests_that_no_film_gives_are_refused),
        cmocka_unit_test(creep_without_an_end_is_extrapolated),
        cmocka_unit_test(times_over_all_decades_are_fitted),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
