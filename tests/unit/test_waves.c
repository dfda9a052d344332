/* Waveforms against their formulas, over seeds that change from run to run. */
#include "scenes.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

#include "deaspice/scene.h"
#include "drive/signal.h"
#include "drive/wave.h"
#include "network/thin.h"
#include "result/scales.h"

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
                 n[0], n[1], n[2], n[3], n[4], n[5], n[6], i % 2 ? "linear" : i % 4 ? "log" : "logarithmic");
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

/* A recorder's table: swings, and where @p noise is not 0, what its converter adds. */
static dea_scene record(double retardation, double noise)
{
    enum { ROWS = 4000 };
    dea_scene scene;
    dea_error error;
    assert_int_equal(parse("points: [[0 s, 0 V]]", "", &scene, &error), DEA_OK);
    free(scene.drive.waveform.times);
    free(scene.drive.waveform.voltages);
    scene.drive.waveform.times = malloc(ROWS * sizeof(double));
    scene.drive.waveform.voltages = malloc(ROWS * sizeof(double));
    scene.drive.waveform.point_count = ROWS;
    const double first = draw(20, 60), second = draw(100, 300), phase = draw(0, 6);
    for (int i = 0; i < ROWS; i++) {
        const double t = 0.05 * i / (ROWS - 1.0);
        scene.drive.waveform.times[i] = t;
        scene.drive.waveform.voltages[i] = 2000.0 + 800.0 * sin(2.0 * (double)pi * first * t) +
                                           200.0 * sin(2.0 * (double)pi * second * t + phase) + noise * draw(-1, 1);
    }
    scene.material.retardation = retardation;
    return scene;
}

static void runs_of_lines_leave_the_voltage_as_it_is(void **state)
{
    (void)state;
    for (int i = 0; i < 8; i++) {
        dea_scene scene = record(1e-4, i % 2 ? 5.0 : 0.0);
        dea_signal one, other;
        dea_error error;
        scene.accuracy = i % 4 < 2 ? 1e-3 : 1e-5;
        assert_int_equal(dea_signal_open(&scene, &one, &error), DEA_OK);
        assert_int_equal(dea_signal_open(&scene, &other, &error), DEA_OK);
        assert_int_equal(dea_signal_soften(&other, scene.accuracy, i >= 4 ? 1.0 : 0.0, &error), DEA_OK);
        assert_true(i >= 4 || i == 0 ? other.count < one.count / 20 : other.count <= one.count);
        for (int k = 0; k < PLACES; k++) {
            const double t = draw(0.0, 0.05);
            const dea_segment *a = &one.segments[dea_signal_find(&one, 0, t)];
            const dea_segment *b = &other.segments[dea_signal_find(&other, 0, t)];
            assert_true(dea_segment_voltage(&one, a, t) == dea_segment_voltage(&other, b, t));
            assert_true(dea_segment_slope(&one, a, t) == dea_segment_slope(&other, b, t));
        }
        assert_true(other.segments[other.count - 1].to == 0.05);
        dea_signal_close(&one);
        dea_signal_close(&other);
        dea_scene_free(&scene);
    }
}

/* Errors of an engine over what its columns promise, by the closed form, which takes each line of a record for itself. */
static void judge_record(const dea_scene *scene, const char *name)
{
    const dea_engine *engine = dea_engine_find(name);
    const dea_scales scales = dea_scales_open(scene, scene->models[0]);
    const size_t rows = dea_layout_of(scene).rows;
    dea_sample *want = malloc(rows * sizeof *want), *got = malloc(rows * sizeof *got);
    dea_error error = {0};
    dea_summary summary;
    void *session = NULL;
    double peak = 0.0, off = 0.0, fast = 0.0, off_fast = 0.0;
    assert_int_equal(dea_engine_find("direct")->transient(NULL, scene, scene->models[0], want, &summary, &error), DEA_OK);
    assert_int_equal(engine->begin(&session, &error), DEA_OK);
    if (engine->transient(session, scene, scene->models[0], got, &summary, &error) != DEA_OK) {
        fail_msg("%s: %s", name, error.message);
    }
    engine->end(session);
    for (size_t k = 0; k < rows; k++) {
        peak = fmax(peak, fabs(want[k].displacement));
        off = fmax(off, fabs(want[k].displacement - got[k].displacement));
        fast = fmax(fast, fabs(want[k].velocity));
        off_fast = fmax(off_fast, fabs(want[k].velocity - got[k].velocity));
        assert_true(fabs(got[k].voltage - want[k].voltage) <= 1e-12 * fabs(want[k].voltage));
    }
    fast = fmax(fast, peak * scales.pace);
    if (!(off <= summary.error * peak && summary.error <= scene->accuracy && off_fast <= 10.0 * scene->accuracy * fast)) {
        fail_msg("%s at %g: off by %.2g, %.2g told, velocity by %.2g", name, scene->accuracy, off / peak, summary.error, off_fast / fast);
    }
    assert_true(summary.residual <= 10.0 * scene->accuracy);
    free(want);
    free(got);
}

/* A film that swings, and films that their dampers hold, with mass and without. */
static void records_move_the_film_as_the_closed_form_says(void **state)
{
    (void)state;
    for (int i = 0; i < 7; i++) {
        dea_scene scene = record(i < 2 ? 1e-4 : 3e-3, i == 6 ? 50.0 : i % 2 ? 5.0 : 0.0);
        scene.reduction.mass = i >= 4;
        judge_record(&scene, "ida");
        scene.transient.every = 1e-3;
        scene.accuracy = 1e-3;
        judge_record(&scene, "ida");
        scene.accuracy = 1e-4;
        judge_record(&scene, "ida");
        if (i == 0 || i == 4) { /* the others take ngspice seconds */
            judge_record(&scene, "ngspice");
        }
        dea_scene_free(&scene);
    }
}

/* A polynomial has the integral of the square that it stands for, and a sample sees the record. */
static void thinned_records_push_as_the_record(void **state)
{
    (void)state;
    for (int i = 0; i < 4; i++) {
        dea_scene scene = record(1e-4, i % 2 ? 0.5 : 0.0);
        dea_dynamics dynamics;
        dea_signal one, thin;
        dea_error error;
        scene.accuracy = i < 2 ? 1e-2 : 1e-4;
        assert_int_equal(dea_dynamics_open(&scene, scene.models[0], &dynamics, &error), DEA_OK);
        assert_int_equal(dea_signal_open(&scene, &one, &error), DEA_OK);
        assert_int_equal(dea_signal_open(&scene, &thin, &error), DEA_OK);
        assert_int_equal(dea_signal_thin(&thin, &scene, &dynamics, 5e3, &error), DEA_OK);
        assert_true(thin.count < one.count / 20);
        assert_true(thin.thinned > 0.0 && thin.thinned <= 0.1 * scene.accuracy);
        assert_true(thin.segments[0].from == 0.0 && thin.segments[thin.count - 1].to == scene.transient.until);
        for (size_t k = 0; k < thin.count; k++) {
            const dea_segment *s = &thin.segments[k];
            enum { PANELS = 20000 };
            double sum = 0.0, want = 0.0;
            size_t near = 0;
            assert_true(k == 0 || s->from == s[-1].to);
            for (int n = 0; n < PANELS && s->terms; n++) {
                const double t = s->from + (s->to - s->from) * (n + 0.5) / PANELS, u = dea_segment_voltage(&thin, s, t);
                near = dea_signal_find(&one, near, t);
                const double true_u = dea_segment_voltage(&one, &one.segments[near], t);
                assert_true(dea_segment_voltage(&thin, dea_segment_seen(s, t), t) == true_u);
                sum += u * u;
                want += true_u * true_u;
            }
            assert_true(fabs(sum - want) <= 1e-7 * want);
        }
        dea_signal_close(&one);
        dea_signal_close(&thin);
        dea_dynamics_close(&dynamics);
        dea_scene_free(&scene);
    }
}

static dea_sample *move_membrane(dea_scene *scene)
{
    const dea_engine *ida = dea_engine_find("ida");
    dea_error error = {0};
    dea_summary summary;
    void *session = NULL;
    scene->models[0] = dea_model_find("field");
    scene->accuracy = 1e-4;
    scene->transient.until = 1e-2;
    scene->transient.every = 1e-4;
    scene->material.density = 1080.0;
    scene->material.retardation = 1e-4;
    dea_sample *samples = malloc(dea_layout_of(scene).point_size);
    assert_int_equal(ida->begin(&session, &error), DEA_OK);
    assert_int_equal(ida->transient(session, scene, scene->models[0], samples, &summary, &error), DEA_OK);
    assert_true(summary.error <= scene->accuracy && summary.residual <= 10.0 * scene->accuracy);
    ida->end(session);
    return samples;
}

/* Chords of a sine of 100 Hz, 5 us long, leave it by 1e-6. */
static void the_record_of_a_sine_moves_the_membrane_as_the_sine(void **state)
{
    (void)state;
    enum { ROWS = 2001 };
    dea_scene sine, record;
    dea_error error;
    double peak = 0.0;
    assert_int_equal(parse("sine: {offset: 2 kV, amplitude: 1.5 kV, frequency: 100 Hz}", "", &sine, &error), DEA_OK);
    assert_int_equal(parse("points: [[0 s, 0 V]]", "", &record, &error), DEA_OK);
    free(record.drive.waveform.times);
    free(record.drive.waveform.voltages);
    record.drive.waveform.times = malloc(ROWS * sizeof(double));
    record.drive.waveform.voltages = malloc(ROWS * sizeof(double));
    record.drive.waveform.point_count = ROWS;
    for (int i = 0; i < ROWS; i++) {
        record.drive.waveform.times[i] = 5e-6 * i;
        record.drive.waveform.voltages[i] = 2000.0 + 1500.0 * sin(2.0 * (double)pi * 100.0 * 5e-6 * i);
    }
    dea_sample *want = move_membrane(&sine), *got = move_membrane(&record);
    for (int k = 0; k <= 100; k++) {
        peak = fmax(peak, fabs(want[k].displacement));
    }
    for (int k = 0; k <= 100; k++) {
        assert_true(fabs(want[k].displacement - got[k].displacement) <= 2e-4 * peak);
    }
    assert_true(peak > 1e-4);
    free(want);
    free(got);
    dea_scene_free(&sine);
    dea_scene_free(&record);
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
        cmocka_unit_test(runs_of_lines_leave_the_voltage_as_it_is),
        cmocka_unit_test(records_move_the_film_as_the_closed_form_says),
        cmocka_unit_test(thinned_records_push_as_the_record),
        cmocka_unit_test(the_record_of_a_sine_moves_the_membrane_as_the_sine),
    };
    return cmocka_run_group_tests(tests, set_up, NULL);
}
