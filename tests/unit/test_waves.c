/* Waveforms against their formulas, over seeds that change from run to run. */
#include "scenes.h"


#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

#include "deaspice/scene.h"
#include "drive/signal.h"
#include "drive/wave.h"

enum { SCENES = 40, PLACES = 200 };

static const long double pi = 3.14159265358979323846264338327950288L;

static uint64_t seed;

static double draw(double low, double high)
{
    seed = seed * 6364136223846793005u + 1442695040888963407u;
    return low + (high - low) * ((double)(seed >> 11) / 9007199254740992.0);
}

static int set_up(void **state)
{
    (void)state;
    const char *given = getenv("DEA_SEED");
    seed = given ? strtoull(given, NULL, 10) : (uint64_t)time(NULL) * 2654435761u;
    printf("seed %llu\n", (unsigned long long)seed);
    return 0;
}

/* A scene of one waveform; the caller frees it. */
static dea_status parse(const char *wave, const char *more, dea_scene *scene, dea_error *error)
{
    char text[1200];
    snprintf(text, sizeof text,
             "actuator: {kind: dot, frame_radius: 30 mm, coverage: 0.5, film_thickness: 100 um, prestretch: 1.2}\n"
             "material: {base: elastosil-2030, retardation: 0.2 ms}\n"
             "drive: {waveform: {%s}}\nmodel: lumped\naccuracy: 1e-5\n"
             "study: {transient: {until: 0.05 s, every: 0.05 ms}%s}\n",
             wave, more);
    return dea_scene_parse(text, strlen(text), "t", ".", NULL, 0, NULL, scene, error);
}

typedef long double formula(const double *n, long double t);

/* Largest difference of the segments to a formula away from its edges, over the amplitude; they leave no gap. */
static void judge(const char *wave, formula *is, const double *n, double edge, double amplitude)
{
    dea_scene scene;
    dea_signal signal;
    dea_error error;
    if (parse(wave, "", &scene, &error) != DEA_OK) {
        fail_msg("%s: %s", wave, error.message);
    }
    assert_int_equal(dea_signal_open(&scene, &signal, &error), DEA_OK);
    assert_true(signal.segments[0].from == 0.0 && signal.segments[signal.count - 1].to == 0.05);
    for (size_t i = 1; i < signal.count; i++) {
        assert_true(signal.segments[i].from == signal.segments[i - 1].to);
    }
    for (int i = 0; i < PLACES; i++) {
        const double t = draw(0.0, 0.05);
        const dea_segment *s = &signal.segments[dea_signal_find(&signal, 0, t)];
        const double got = dea_segment_voltage(&signal, s, t);
        const long double want = is(n, t);
        const bool on_edge = fabsl(is(n, t - 2.0 * edge) - is(n, t + 2.0 * edge)) > 1e-3L * amplitude && edge > 0.0;
        if (!on_edge && !(fabsl(got - want) <= 1e-9L * amplitude)) {
            fail_msg("%s at %.9g s: %.12g V, %.12Lg V wanted", wave, t, got, want);
        }
        assert_true(fabs(got) <= signal.largest * (1.0 + 1e-12));
        if (s->sine && t - 1e-6 > s->from && t + 1e-6 < s->to) {
            const long double slope = (is(n, t + 1e-7L) - is(n, t - 1e-7L)) / 2e-7L;
            const double turn = dea_segment_turn(&signal, s);
            assert_true(fabsl(dea_segment_slope(&signal, s, t) - slope) <= 1e-5L * amplitude * turn);
            const long double bend = (is(n, t + 1e-6L) - 2.0L * is(n, t) + is(n, t - 1e-6L)) / 1e-12L;
            assert_true(fabsl(dea_segment_curvature(&signal, s, t) - bend) <= 3e-4L * amplitude * turn * turn);
        }
    }
    dea_signal_close(&signal);
    dea_scene_free(&scene);
}

/* n: offset, voltage, frequency, duty, delay. */
static long double pulse(const double *n, long double t)
{
    const long double x = (t - n[4]) * n[2], part = x - floorl(x);
    return n[0] + (t > n[4] && part < n[3] ? n[1] : 0.0);
}

static void pulses_have_their_duty(void **state)
{
    (void)state;
    for (int i = 0; i < SCENES; i++) {
        const double n[] = {draw(-500, 500), draw(500, 4000), draw(100, 3000), i == 0 ? 0.0 : i == 1 ? 1.0 : draw(0.05, 0.95), draw(0, 0.01)};
        const double rise = i % 2 ? 1e-6 : 0.0;
        char wave[300];
        snprintf(wave, sizeof wave, "pulse: {offset: %.17g V, voltage: %.17g V, frequency: %.17g Hz, duty: %.17g, delay: %.17g s, rise: %g s}",
                 n[0], n[1], n[2], n[3], n[4], rise);
        judge(wave, pulse, n, 1e-6, fabs(n[0]) + n[1]);
    }
}

/* n: offset, amplitude, frequency, -, delay. */
static long double square(const double *n, long double t)
{
    const long double x = (t - n[4]) * n[2];
    return t <= n[4] ? n[0] : n[0] + (x - floorl(x) < 0.5L ? n[1] : -n[1]);
}

static void squares_go_up_first(void **state)
{
    (void)state;
    for (int i = 0; i < SCENES; i++) {
        const double n[] = {draw(-500, 500), draw(500, 4000), draw(100, 3000), 0.0, draw(0, 0.01)};
        char wave[300];
        snprintf(wave, sizeof wave, "square: {offset: %.17g V, amplitude: %.17g V, frequency: %.17g Hz, delay: %.17g s}", n[0], n[1],
                 n[2], n[4]);
        judge(wave, square, n, 1e-6, fabs(n[0]) + n[1]);
    }
}

/* n: offset, amplitude, frequency, symmetry, delay. */
static long double triangle(const double *n, long double t)
{
    const long double x = (t - n[4]) * n[2] + 0.5L * n[3], part = x - floorl(x);
    const long double up = -1.0L + 2.0L * part / n[3], down = 1.0L - 2.0L * (part - n[3]) / (1.0L - n[3]);
    return t <= n[4] ? n[0] : n[0] + n[1] * (part < n[3] ? up : down);
}

static void triangles_rise_over_their_symmetry(void **state)
{
    (void)state;
    for (int i = 0; i < SCENES; i++) {
        const double n[] = {draw(-500, 500), draw(500, 4000), draw(100, 3000), draw(0.05, 0.95), draw(0, 0.01)};
        char wave[300];
        snprintf(wave, sizeof wave, "triangle: {offset: %.17g V, amplitude: %.17g V, frequency: %.17g Hz, symmetry: %.17g, delay: %.17g s}",
                 n[0], n[1], n[2], n[3], n[4]);
        judge(wave, triangle, n, 0.0, fabs(n[0]) + n[1]);
    }
}

/* n: offset, amplitude, from, to, duration, phase, delay. */
static long double chirp(const double *n, long double t)
{
    const long double age = fminl(fmaxl(t - n[6], 0.0L), n[4]);
    const long double turns = n[2] * age + 0.5L * ((long double)n[3] - n[2]) / n[4] * age * age;
    return n[0] + n[1] * sinl(2.0L * pi * turns + n[5]);
}

static long double log_chirp(const double *n, long double t)
{
    const long double age = fminl(fmaxl(t - n[6], 0.0L), n[4]), growth = logl((long double)n[3] / n[2]) / n[4];
    return n[0] + n[1] * sinl(2.0L * pi * n[2] * (expl(growth * age) - 1.0L) / growth + n[5]);
}

static void chirps_run_from_one_frequency_to_another(void **state)
{
    (void)state;
    for (int i = 0; i < 2 * SCENES; i++) {
        const double n[] = {draw(-500, 500), draw(500, 4000), draw(10, 5000), draw(10, 5000), draw(0.01, 0.06), draw(0, 6), draw(0, 0.01)};
        char wave[400];
        snprintf(wave, sizeof wave,
                 "chirp: {offset: %.17g V, amplitude: %.17g V, from: %.17g Hz, to: %.17g Hz, duration: %.17g s, phase: %.17g rad, "
                 "delay: %.17g s, spacing: %s}",
                 n[0], n[1], n[2], n[3], n[4], n[5], n[6], i % 2 ? "linear" : "logarithmic");
        judge(wave, i % 2 ? chirp : log_chirp, n, 0.0, fabs(n[0]) + n[1]);
    }
}

/* n: offset, amplitude, frequency, cycles, delay, period. */
static long double burst(const double *n, long double t)
{
    const long double x = t - n[5] * floorl(t / n[5]) - n[4];
    return n[0] + (x > 0.0L && x < n[3] / (long double)n[2] ? n[1] * sinl(2.0L * pi * n[2] * x) : 0.0L);
}

static void bursts_repeat_with_their_period(void **state)
{
    (void)state;
    for (int i = 0; i < SCENES; i++) {
        const double n[] = {draw(-500, 500), draw(500, 4000), draw(500, 5000), 0.5 * floor(draw(1, 9)), draw(0, 0.002), draw(0.011, 0.02)};
        char wave[300];
        snprintf(wave, sizeof wave,
                 "burst: {offset: %.17g V, amplitude: %.17g V, frequency: %.17g Hz, cycles: %.17g, delay: %.17g s}, period: %.17g s", n[0],
                 n[1], n[2], n[3], n[4], n[5]);
        judge(wave, burst, n, 0.0, fabs(n[0]) + n[1]);
    }
}

/* n: three times offset, amplitude, frequency, phase. */
static long double three(const double *n, long double t)
{
    long double sum = 0.0L;
    for (int i = 0; i < 3; i++, n += 4) {
        sum += n[0] + n[1] * sinl(2.0L * pi * n[2] * t + n[3]);
    }
    return sum;
}

static void sines_and_their_offsets_add_up(void **state)
{
    (void)state;
    for (int i = 0; i < SCENES; i++) {
        double n[12], largest = 0.0;
        char wave[600] = "sines: [";
        for (int k = 0; k < 3; k++) {
            double *one = n + 4 * k;
            one[0] = draw(-500, 500), one[1] = draw(100, 1000), one[2] = draw(10, 5000), one[3] = draw(0, 6);
            largest += fabs(one[0]) + one[1];
            snprintf(wave + strlen(wave), sizeof wave - strlen(wave),
                     "{offset: %.17g V, amplitude: %.17g V, frequency: %.17g Hz, phase: %.17g rad}%s", one[0], one[1], one[2], one[3],
                     k < 2 ? ", " : "]");
        }
        judge(wave, three, n, 0.0, largest);
    }
}

/* What a scene's own numbers allow, an axis can break: the run says so. */
static void axes_are_checked_too(void **state)
{
    (void)state;
    dea_scene scene;
    dea_error error;
    const char *wave = "chirp: {amplitude: 1 kV, from: 1 kHz, to: 2 kHz, duration: 20 ms}";
    assert_int_equal(parse(wave, ", over: {to: [2 kHz, 20 kHz]}", &scene, &error), DEA_ERROR_SCENE);
    assert_non_null(strstr(error.message, "drive.waveform.chirp.to: past what the samples resolve"));
    assert_int_equal(parse(wave, ", over: {to: [2 kHz, 8 kHz]}", &scene, &error), DEA_OK);
    assert_string_equal(scene.axes[0].column, "chirp_to_Hz");
    scene.drive.waveform.numbers[3] = 20e3;
    dea_signal signal;
    assert_int_equal(dea_signal_open(&scene, &signal, &error), DEA_ERROR_USAGE);
    assert_non_null(strstr(error.message, "past what the samples resolve"));
    dea_scene_free(&scene);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(pulses_have_their_duty),
        cmocka_unit_test(squares_go_up_first),
        cmocka_unit_test(triangles_rise_over_their_symmetry),
        cmocka_unit_test(chirps_run_from_one_frequency_to_another),
        cmocka_unit_test(bursts_repeat_with_their_period),
        cmocka_unit_test(sines_and_their_offsets_add_up),
        cmocka_unit_test(axes_are_checked_too),
    };
    return cmocka_run_group_tests(tests, set_up, NULL);
}
