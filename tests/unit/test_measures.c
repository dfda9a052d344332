/* Figures of merit against closed forms: rise, settling, overshoot, resonance, bandwidth. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include "scenes.h"

#include "deaspice/measures.h"

enum { SAMPLES = 40001, RESPONSES = 4001 };

static dea_sample samples[SAMPLES];
static dea_response responses[RESPONSES];

/* Answers of a film to a unit step, t >= 0. */
typedef double answer(double t);

static const double lag = 0.05;               /* time constant of a first order [s] */
static const double omega = 60.0, zeta = 0.2; /* of a second order [rad/s] */

static double first_order(double t)
{
    return 1.0 - exp(-t / lag);
}

static double second_order(double t)
{
    const double free = omega * sqrt(1.0 - zeta * zeta);
    return 1.0 - exp(-zeta * omega * t) * (cos(free * t) + zeta * omega / free * sin(free * t));
}

/* A step of 1 V from 1 s to 3 s, and samples of 0 ... 5 s whose displacement is @p size times the answer to it. */
static dea_scene step_make(answer *answers, double size)
{
    dea_scene scene = {.study = DEA_STUDY_TRANSIENT, .transient = {.until = 5.0, .every = 5.0 / (SAMPLES - 1)}};
    scene.drive.waveform = (dea_waveform){.kind = DEA_WAVE_STEP, .step = {1.0, 3.0, 1.0, 0.0}, .period = (double)NAN};
    for (size_t i = 0; i < SAMPLES; i++) {
        const double t = (double)i * scene.transient.every;
        const double u = (t > 1.0 ? answers(t - 1.0) : 0.0) - (t > 3.0 ? answers(t - 3.0) : 0.0);
        samples[i] = (dea_sample){.time = t, .displacement = size * u, .strain = 3.0 * size * u};
    }
    return scene;
}

static void first_order_rises_in_tau_ln_9_and_settles_in_tau_ln_50(void **state)
{
    (void)state;
    static const double sizes[] = {1e-3, -2e-5};
    for (size_t i = 0; i < 2; i++) {
        const dea_scene scene = step_make(first_order, sizes[i]);
        dea_edge_answer edges[DEA_EDGES];
        assert_int_equal(dea_measure_edges(&scene, samples, SAMPLES, edges), 2);
        for (size_t edge = 0; edge < 2; edge++) {
            assert_true(edges[edge].rising == (edge == 0));
            assert_relative(edges[edge].time, edge == 0 ? 1.0 : 3.0, 1e-15);
            assert_relative(edges[edge].change, edge == 0 ? sizes[i] : -sizes[i], 1e-12);
            assert_relative(edges[edge].rise_time, lag * log(9.0), 1e-6);
            assert_relative(edges[edge].settling_time, lag * log(50.0), 1e-6);
            assert_near(edges[edge].overshoot, 0.0, 1e-12);
        }
    }
}

static void second_order_overshoots_by_its_damping(void **state)
{
    (void)state;
    const dea_scene scene = step_make(second_order, -1e-4);
    const double wanted = exp(-DEA_PI * zeta / sqrt(1.0 - zeta * zeta));
    dea_edge_answer edges[DEA_EDGES];
    assert_int_equal(dea_measure_edges(&scene, samples, SAMPLES, edges), 2);
    assert_relative(edges[0].overshoot, wanted, 1e-5);
    assert_relative(edges[1].overshoot, wanted, 1e-5);
    double last = 0.0; /* of the closed form outside of 2 % */
    for (double t = 0.0; t < 2.0; t += 1e-6) {
        last = fabs(second_order(t) - 1.0) > 0.02 ? t : last;
    }
    assert_relative(edges[0].settling_time, last, 1e-4);
    assert_relative(edges[1].settling_time, last, 1e-4);
}

static void rise_begins_where_the_answer_begins_not_where_it_returns(void **state)
{
    (void)state;
    const dea_scene scene = step_make(second_order, 1.0);
    double reached[2] = {0.0, 0.0};
    for (double t = 0.0; reached[1] <= 0.0; t += 1e-7) {
        for (int i = 0; i < 2; i++) {
            reached[i] = reached[i] <= 0.0 && second_order(t) >= (i == 0 ? 0.1 : 0.9) ? t : reached[i];
        }
    }
    dea_edge_answer edges[DEA_EDGES];
    dea_measure_edges(&scene, samples, SAMPLES, edges);
    assert_relative(edges[0].rise_time, reached[1] - reached[0], 1e-4);
}

static void edges_that_a_run_does_not_show_have_no_figures(void **state)
{
    (void)state;
    dea_edge_answer edges[DEA_EDGES];
    dea_scene scene = step_make(first_order, 1.0);
    for (size_t i = SAMPLES / 2; i < SAMPLES; i++) {
        samples[i].displacement = (double)NAN; /* pulled in */
    }
    assert_int_equal(dea_measure_edges(&scene, samples, SAMPLES, edges), 2);
    assert_true(isnan(edges[0].rise_time) && isnan(edges[0].overshoot) && isnan(edges[1].settling_time));
    scene = step_make(first_order, 0.0);
    assert_int_equal(dea_measure_edges(&scene, samples, SAMPLES, edges), 2);
    assert_true(isnan(edges[0].rise_time));
    scene = step_make(first_order, 1.0);
    scene.drive.waveform.step.off = (double)NAN;
    assert_int_equal(dea_measure_edges(&scene, samples, SAMPLES, edges), 1);
    scene.drive.waveform.step.off = 3.0;
    scene.drive.waveform.period = 3.0; /* the next one begins at 4 s */
    assert_int_equal(dea_measure_edges(&scene, samples, SAMPLES, edges), 2);
    assert_relative(edges[1].change, -1.0 + exp(-1.0 / lag), 1e-12);
    scene.drive.waveform.step.on = 7.0;
    scene.drive.waveform.period = (double)NAN;
    scene.drive.waveform.step.off = 9.0;
    assert_int_equal(dea_measure_edges(&scene, samples, SAMPLES, edges), 0);
    scene.drive.waveform.kind = DEA_WAVE_SINE;
    assert_int_equal(dea_measure_edges(&scene, samples, SAMPLES, edges), 0);
}

/* Magnitudes of 1/(1 + 2 i damping f/f0 - (f/f0)^2) for 1 ... 10^4 Hz. */
static void band_make(double natural, double damping)
{
    for (size_t i = 0; i < RESPONSES; i++) {
        const double f = pow(10.0, 4.0 * (double)i / (RESPONSES - 1));
        const double x = f / natural;
        responses[i] = (dea_response){.frequency = f, .displacement = 1e-9 / hypot(1.0 - x * x, 2.0 * damping * x)};
    }
}

static void resonance_and_bandwidth_are_those_of_a_second_order(void **state)
{
    (void)state;
    static const double dampings[] = {0.01, 0.1, 0.3, 0.6};
    for (size_t i = 0; i < 4; i++) {
        const double q = 1.0 - 2.0 * dampings[i] * dampings[i];
        band_make(713.0, dampings[i]);
        const dea_band band = dea_measure_band(responses, RESPONSES);
        assert_relative(band.resonance, 713.0 * sqrt(q), 1e-5);
        assert_relative(band.bandwidth, 713.0 * sqrt(q + sqrt(q * q + 1.0)), 1e-5);
    }
}

static void overdamped_film_has_a_bandwidth_and_no_resonance(void **state)
{
    (void)state;
    band_make(5000.0, 5.0);
    const double q = 1.0 - 2.0 * 25.0;
    const dea_band band = dea_measure_band(responses, RESPONSES);
    assert_true(isnan(band.resonance));
    assert_relative(band.bandwidth, 5000.0 * sqrt(q + sqrt(q * q + 1.0)), 1e-5);
}

static void peak_below_a_creeping_start_is_the_resonance(void **state)
{
    (void)state;
    band_make(713.0, 0.2);
    for (size_t i = 0; i < RESPONSES; i++) {
        responses[i].displacement *= 1.0 + 20.0 / (1.0 + responses[i].frequency);
    }
    assert_true(responses[0].displacement > 4.0 * 1e-9 / (2.0 * 0.2)); /* far above the peak */
    assert_relative(dea_measure_band(responses, RESPONSES).resonance, 713.0 * sqrt(1.0 - 0.08), 1e-2);
}

static void flat_or_broken_responses_have_no_figures(void **state)
{
    (void)state;
    band_make(1e9, 0.5);
    for (size_t i = 0; i < RESPONSES; i++) {
        responses[i].displacement = 1e-9 * (1.0 + 1e-13 * (double)(i * 7919 % 13)); /* rounding */
    }
    dea_band band = dea_measure_band(responses, RESPONSES);
    assert_true(isnan(band.resonance) && isnan(band.bandwidth));
    for (size_t i = 0; i < RESPONSES; i++) {
        responses[i].displacement = (double)NAN;
    }
    band = dea_measure_band(responses, RESPONSES);
    assert_true(isnan(band.resonance) && isnan(band.bandwidth));
    band = dea_measure_band(responses, 0);
    assert_true(isnan(band.resonance) && isnan(band.bandwidth));
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(first_order_rises_in_tau_ln_9_and_settles_in_tau_ln_50),
        cmocka_unit_test(second_order_overshoots_by_its_damping),
        cmocka_unit_test(rise_begins_where_the_answer_begins_not_where_it_returns),
        cmocka_unit_test(edges_that_a_run_does_not_show_have_no_figures),
        cmocka_unit_test(resonance_and_bandwidth_are_those_of_a_second_order),
        cmocka_unit_test(overdamped_film_has_a_bandwidth_and_no_resonance),
        cmocka_unit_test(peak_below_a_creeping_start_is_the_resonance),
        cmocka_unit_test(flat_or_broken_responses_have_no_figures),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
