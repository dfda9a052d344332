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

static double first_speed(double t)
{
    return exp(-t / lag) / lag;
}

static double second_speed(double t)
{
    const double free = omega * sqrt(1.0 - zeta * zeta);
    return exp(-zeta * omega * t) * omega * omega / free * sin(free * t);
}

static size_t sample_count(const dea_scene *scene)
{
    return (size_t)(scene->transient.until / scene->transient.every) + 1;
}

/* A step of 1 V from 1 s to 3 s, and samples of 0 ... 5 s whose displacement is @p size times the answer to it. */
static dea_scene step_make(answer *answers, answer *speeds, double size, double every)
{
    dea_scene scene = {.study = DEA_STUDY_TRANSIENT, .transient = {.until = 5.0, .every = every}};
    scene.drive.waveform = (dea_waveform){.kind = DEA_WAVE_STEP, .step = {1.0, 3.0, 1.0, 0.0}, .period = (double)NAN};
    assert_true(sample_count(&scene) <= SAMPLES);
    for (size_t i = 0; i < sample_count(&scene); i++) {
        const double t = (double)i * every;
        const double u = (t > 1.0 ? answers(t - 1.0) : 0.0) - (t > 3.0 ? answers(t - 3.0) : 0.0);
        const double v = (t > 1.0 ? speeds(t - 1.0) : 0.0) - (t > 3.0 ? speeds(t - 3.0) : 0.0);
        samples[i] = (dea_sample){.time = t, .displacement = size * u, .velocity = size * v};
    }
    return scene;
}

/* The two edges of step_make(), whose answer of that size relaxes to it and back, and swings with that frequency if at all. */
static void measure(const dea_scene *scene, size_t count, double size, double swing, dea_edge_answer edges[DEA_EDGES])
{
    const dea_step *step = &scene->drive.waveform.step;
    const dea_step_edge on = {.from = step->on, .to = step->off, .final = size, .omega = swing, .rising = true};
    const dea_step_edge off = {.from = step->off, .to = scene->transient.until, .final = 0.0, .omega = swing};
    assert_true(dea_measure_edge(samples, count, &on, &edges[0]));
    assert_true(dea_measure_edge(samples, count, &off, &edges[1]));
}

static void assert_known(dea_interval time, double wanted, double tolerance)
{
    assert_true(time.late >= time.early && time.late - time.early <= 1e-9);
    assert_relative(time.early, wanted, tolerance);
}

static void first_order_rises_in_tau_ln_9_and_settles_in_tau_ln_50(void **state)
{
    (void)state;
    static const double sizes[] = {1e-3, -2e-5};
    for (size_t i = 0; i < 2; i++) {
        const dea_scene scene = step_make(first_order, first_speed, sizes[i], 0.5 * lag / 10.0);
        dea_edge_answer edges[DEA_EDGES];
        measure(&scene, sample_count(&scene), sizes[i], 0.0, edges);
        for (size_t edge = 0; edge < 2; edge++) {
            assert_true(edges[edge].rising == (edge == 0) && edges[edge].reached && edges[edge].settled);
            assert_relative(edges[edge].time, edge == 0 ? 1.0 : 3.0, 1e-15);
            assert_relative(edges[edge].change, edge == 0 ? sizes[i] : -sizes[i], 1e-12);
            assert_known(edges[edge].settling, lag * log(50.0), 1e-5);
            assert_near(edges[edge].overshoot, 0.0, 1e-12);
        }
    }
    const dea_scene fine = step_make(first_order, first_speed, 1.0, 0.01 * lag);
    dea_edge_answer edges[DEA_EDGES];
    measure(&fine, sample_count(&fine), 1.0, 0.0, edges);
    assert_known(edges[0].rise, lag * log(9.0), 1e-5);
}

/* Three samples a time constant tell a time at which it has risen, not which. */
static void samples_too_coarse_for_a_rise_bound_it(void **state)
{
    (void)state;
    const double coarse[] = {0.3, 1.0, 5.0, 40.0};
    for (size_t i = 0; i < 4; i++) {
        const dea_scene scene = step_make(first_order, first_speed, 1.0, coarse[i] * lag);
        dea_edge_answer edges[DEA_EDGES];
        measure(&scene, sample_count(&scene), 1.0, 0.0, edges);
        assert_true(edges[0].rise.early <= lag * log(9.0) && edges[0].rise.late >= lag * log(9.0));
        assert_true(edges[0].rise.late > edges[0].rise.early);
        assert_true(edges[0].settling.early <= lag * log(50.0) * (1.0 + 1e-3) &&
                    edges[0].settling.late >= lag * log(50.0) * (1.0 - 1e-3));
    }
}

/* Last time at which the closed form is outside of 2 % [s]. */
static double second_settles(void)
{
    double last = 0.0;
    for (double t = 0.0; t < 2.0; t += 1e-6) {
        last = fabs(second_order(t) - 1.0) > 0.02 ? t : last;
    }
    return last;
}

/* From twenty samples a period on, wherever they lie. */
static void second_order_overshoots_by_its_damping(void **state)
{
    (void)state;
    const double wanted = exp(-DEA_PI * zeta / sqrt(1.0 - zeta * zeta)),
                 period = 2.0 * DEA_PI / (omega * sqrt(1.0 - zeta * zeta));
    const double rates[] = {20.0, 20.37, 23.1, 57.7, 400.0};
    for (size_t i = 0; i < 5; i++) {
        const dea_scene scene = step_make(second_order, second_speed, -1e-4, period / rates[i]);
        dea_edge_answer edges[DEA_EDGES];
        measure(&scene, sample_count(&scene), -1e-4, omega, edges);
        for (size_t edge = 0; edge < 2; edge++) {
            assert_near(edges[edge].overshoot, wanted, 1e-4);
            assert_known(edges[edge].settling, second_settles(), 1e-3);
        }
    }
}

static void rise_begins_where_the_answer_begins_not_where_it_returns(void **state)
{
    (void)state;
    const dea_scene scene = step_make(second_order, second_speed, 1.0, 1e-3);
    double reached[2] = {0.0, 0.0};
    for (double t = 0.0; reached[1] <= 0.0; t += 1e-7) {
        for (int i = 0; i < 2; i++) {
            reached[i] = reached[i] <= 0.0 && second_order(t) >= (i == 0 ? 0.1 : 0.9) ? t : reached[i];
        }
    }
    dea_edge_answer edges[DEA_EDGES];
    measure(&scene, sample_count(&scene), 1.0, omega, edges);
    assert_known(edges[0].rise, reached[1] - reached[0], 1e-4);
}

static double undamped(double t)
{
    return 1.0 - cos(omega * t);
}

static double undamped_speed(double t)
{
    return omega * sin(omega * t);
}

/* Wherever the run happens to end. */
static void an_undamped_film_overshoots_by_all_and_never_settles(void **state)
{
    (void)state;
    dea_scene scene = step_make(undamped, undamped_speed, 1e-3, 2.0 * DEA_PI / omega / 25.3);
    for (double until = 3.5; until <= 5.0; until += 0.0137) {
        dea_edge_answer edges[DEA_EDGES];
        scene.transient.until = until;
        measure(&scene, sample_count(&scene), 1e-3, omega, edges);
        assert_true(edges[0].reached && !edges[0].settled && isnan(edges[0].settling.late));
        assert_near(edges[0].overshoot, 1.0, 1e-4);
        assert_known(edges[0].rise, (acos(0.1) - acos(0.9)) / omega, 1e-3);
    }
}

/* A film on its way to twice what the run sees of it. */
static void a_creeping_film_has_no_figures(void **state)
{
    (void)state;
    const dea_scene scene = step_make(first_order, first_speed, 1.0, 0.01);
    dea_edge_answer edges[DEA_EDGES];
    measure(&scene, sample_count(&scene), 2.0, 0.0, edges);
    assert_true(!edges[0].reached && !edges[0].settled && edges[1].settled);
    assert_true(isnan(edges[0].rise.late) && isnan(edges[0].settling.late) && isnan(edges[0].overshoot));
}

static void edges_that_a_run_does_not_show_have_no_figures(void **state)
{
    (void)state;
    const dea_scene scene = step_make(first_order, first_speed, 1.0, 0.001);
    const size_t count = sample_count(&scene);
    const dea_step_edge late = {.from = 7.0, .to = 9.0, .final = 1.0};
    dea_edge_answer edges[DEA_EDGES];
    for (size_t i = count / 2; i < count; i++) {
        samples[i].displacement = (double)NAN; /* pulled in */
    }
    measure(&scene, count, 1.0, 0.0, edges);
    assert_true(isnan(edges[0].rise.late) && isnan(edges[0].overshoot) && isnan(edges[1].settling.late));
    assert_false(dea_measure_edge(samples, count, &late, &edges[0]));
    assert_false(dea_measure_edge(samples, 0, &late, &edges[0]));
}

/* Which edges a waveform has, on the paper's film, which relaxes to what statics says. */
static void edges_are_those_of_the_first_period(void **state)
{
    (void)state;
    dea_scene scene = paper_scene(DEA_DOT, 1.2, 0.5, (double)NAN);
    scene.models[0] = dea_model_find("lumped");
    const double final = solve_paper("lumped", DEA_DOT, 1.2, 0.5, 3000.0).displacement;
    const dea_scene made = step_make(first_order, first_speed, final, 0.001);
    const dea_summary summary = {.resonance = (double)NAN, .error = 1e-9};
    const size_t count = sample_count(&made);
    dea_edge_answer edges[DEA_EDGES];
    scene.study = DEA_STUDY_TRANSIENT;
    scene.transient = made.transient;
    scene.drive.waveform = made.drive.waveform;
    scene.drive.waveform.step.voltage = 3000.0;
    assert_int_equal(dea_measure_edges(&scene, samples, count, &summary, edges), 2);
    for (int i = 0; i < 2; i++) {
        assert_relative(edges[i].change, i == 0 ? final : -final, 1e-12);
        assert_relative(edges[i].settling.late, lag * log(50.0), 1e-5);
    }
    scene.drive.waveform.step.off = (double)NAN;
    assert_int_equal(dea_measure_edges(&scene, samples, count, &summary, edges), 1);
    scene.drive.waveform.step.off = 3.0;
    scene.drive.waveform.period = 2.1; /* the next one begins at 3.1 s: too soon to settle */
    assert_int_equal(dea_measure_edges(&scene, samples, count, &summary, edges), 2);
    assert_true(edges[0].settled && !edges[1].settled);
    scene.drive.waveform.step.on = 7.0;
    scene.drive.waveform.period = (double)NAN;
    scene.drive.waveform.step.off = 9.0;
    assert_int_equal(dea_measure_edges(&scene, samples, count, &summary, edges), 0);
    scene.drive.waveform.kind = DEA_WAVE_SINE;
    assert_int_equal(dea_measure_edges(&scene, samples, count, &summary, edges), 0);
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
        const dea_band band = dea_measure_band(responses, RESPONSES, NULL, NULL);
        assert_relative(band.resonance, 713.0 * sqrt(q), 1e-5);
        assert_relative(band.bandwidth, 713.0 * sqrt(q + sqrt(q * q + 1.0)), 1e-5);
    }
}

/* That response anywhere. */
typedef struct second {
    double natural, damping;
    int asked;
} second;

static bool answer_second(void *user, double from, double to, size_t count, double *magnitudes)
{
    second *s = user;
    s->asked++;
    for (size_t i = 0; i < count; i++) {
        const double x = (from + (to - from) * (double)i / (double)(count - 1)) / s->natural;
        magnitudes[i] = 1e-9 / hypot(1.0 - x * x, 2.0 * s->damping * x);
    }
    return true;
}

static bool answer_nothing(void *user, double from, double to, size_t count, double *magnitudes)
{
    (void)user, (void)from, (void)to, (void)count, (void)magnitudes;
    return false;
}

/* As many rows a decade as there may be; a resonance between the last two of them too. */
static void figures_between_frequencies_are_asked_for(void **state)
{
    (void)state;
    static const double dampings[] = {0.0, 1e-6, 1e-3, 0.05, 0.3, 0.6};
    static const size_t rates[] = {1, 3, 7, 50, 1000};
    static const double ends[] = {1e4, 1e4, 737.0};
    for (size_t i = 0; i < sizeof dampings / sizeof *dampings * 5 * 3; i++) {
        second s = {.natural = 713.0, .damping = dampings[i / 15]};
        const size_t rate = rates[i % 5];
        const double end = ends[i / 5 % 3];
        size_t count = 0;
        for (double f = 1.0; count == 0 || responses[count - 1].frequency < end; count++) {
            f = fmin(pow(10.0, (double)count / (double)rate), end);
            responses[count] = (dea_response){.frequency = f};
            const double x = f / s.natural;
            responses[count].displacement = 1e-9 / hypot(1.0 - x * x, 2.0 * s.damping * x);
        }
        const double q = 1.0 - 2.0 * s.damping * s.damping;
        s.asked = 0;
        const dea_band band = dea_measure_band(responses, count, answer_second, &s);
        assert_relative(band.resonance, 713.0 * sqrt(q), 1e-8);
        if (end > 2000.0) { /* y^2 - 2 q y + 1 = 2/first^2 with y = x^2 */
            const double first = 1e9 * responses[0].displacement;
            assert_relative(band.bandwidth, 713.0 * sqrt(q + sqrt(q * q - 1.0 + 2.0 / (first * first))), 1e-8);
        }
        assert_true(s.asked < 30);
        const dea_band none = dea_measure_band(responses, count, answer_nothing, NULL);
        assert_true(isnan(none.resonance) && isnan(none.bandwidth));
    }
}

static void overdamped_film_has_a_bandwidth_and_no_resonance(void **state)
{
    (void)state;
    band_make(5000.0, 5.0);
    const double q = 1.0 - 2.0 * 25.0;
    const dea_band band = dea_measure_band(responses, RESPONSES, NULL, NULL);
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
    assert_relative(dea_measure_band(responses, RESPONSES, NULL, NULL).resonance, 713.0 * sqrt(1.0 - 0.08), 1e-2);
}

static void flat_or_broken_responses_have_no_figures(void **state)
{
    (void)state;
    band_make(1e9, 0.5);
    for (size_t i = 0; i < RESPONSES; i++) {
        responses[i].displacement = 1e-9 * (1.0 + 1e-13 * (double)(i * 7919 % 13)); /* rounding */
    }
    dea_band band = dea_measure_band(responses, RESPONSES, NULL, NULL);
    assert_true(isnan(band.resonance) && isnan(band.bandwidth));
    for (size_t i = 0; i < RESPONSES; i++) {
        responses[i].displacement = (double)NAN;
    }
    band = dea_measure_band(responses, RESPONSES, NULL, NULL);
    assert_true(isnan(band.resonance) && isnan(band.bandwidth));
    band = dea_measure_band(responses, 0, NULL, NULL);
    assert_true(isnan(band.resonance) && isnan(band.bandwidth));
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(first_order_rises_in_tau_ln_9_and_settles_in_tau_ln_50),
        cmocka_unit_test(second_order_overshoots_by_its_damping),
        cmocka_unit_test(rise_begins_where_the_answer_begins_not_where_it_returns),
        cmocka_unit_test(samples_too_coarse_for_a_rise_bound_it),
        cmocka_unit_test(an_undamped_film_overshoots_by_all_and_never_settles),
        cmocka_unit_test(a_creeping_film_has_no_figures),
        cmocka_unit_test(edges_that_a_run_does_not_show_have_no_figures),
        cmocka_unit_test(edges_are_those_of_the_first_period),
        cmocka_unit_test(resonance_and_bandwidth_are_those_of_a_second_order),
        cmocka_unit_test(figures_between_frequencies_are_asked_for),
        cmocka_unit_test(overdamped_film_has_a_bandwidth_and_no_resonance),
        cmocka_unit_test(peak_below_a_creeping_start_is_the_resonance),
        cmocka_unit_test(flat_or_broken_responses_have_no_figures),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
