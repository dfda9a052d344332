/* Sources, samples and figures of motion against closed forms. */
#include "drive/signal.h"
#include "network/peak.h"
#include "scenes.h"

#include <complex.h>
#include <stdlib.h>
#include <unistd.h>

/* The paper's film without mass, the last of its accuracy and engine; the caller frees it. */
static dea_status parse(const char *drive, const char *model, const char *transient, dea_scene *scene, dea_error *error)
{
    char text[1500];
    snprintf(text, sizeof text,
             "actuator: {kind: dot, frame_radius: 30 mm, coverage: 0.5, film_thickness: 100 um, prestretch: 1.2}\n"
             "material: {yeoh: {C1: 178426 Pa, C2: -6023 Pa, C3: 4234 Pa}, permittivity: 2.8, retardation: 1 ms}\n"
             "drive: {%s}\nmodel: %s\nstudy: {transient: {%s}}\n",
             drive, model, transient);
    return dea_scene_parse(text, strlen(text), "t", ".", NULL, 0, NULL, scene, error);
}

static dea_status take(void *user, size_t first, const void *points, size_t count, dea_error *error)
{
    const dea_layout *layout = ((void **)user)[0];
    (void)error;
    assert_true(first == 0 && count == 1);
    memcpy(((void **)user)[1], points, layout->point_size);
    return DEA_OK;
}

/* The one point of a scene; the caller frees it. */
static void *solve(const dea_scene *scene, const char *engine)
{
    dea_layout layout = dea_layout_of(scene);
    void *user[2] = {&layout, calloc(1, layout.point_size)};
    const dea_run_options options = {.jobs = 1, .points = take, .user = user};
    dea_error error = {0};
    assert_non_null(user[1]);
    if (dea_study_run(scene, dea_engine_find(engine), &options, &error) != DEA_OK) {
        fail_msg("%s: %s", engine, error.message);
    }
    return user[1];
}

static const char *const engines[] = {"direct", "ida", "ngspice"};

/* Eq. 22 of the paper: a film without mass whose damper retards it by tau follows 1 - exp(-t/tau). */
static void logarithmic_samples_see_a_film_relax_over_decades(void **state)
{
    (void)state;
    const double eq22 = 0.03741735, tau = 1e-3;
    dea_scene scene;
    dea_error error;
    assert_int_equal(parse("waveform: {step: {on: 0 s, voltage: 4500 V, rise: 0 s}}", "lumped",
                           "until: 30 ms, samples: log, from: 1 us, points_per_decade: 7", &scene, &error),
                     DEA_OK);
    const size_t rows = dea_layout_of(&scene).rows;
    assert_int_equal(rows, 1 + 32 + 1); /* at 0, 7 log10(30000) = 31.3 of the grid behind its first, the end */
    for (size_t e = 0; e < 3; e++) {
        dea_sample *samples = solve(&scene, engines[e]);
        assert_true(samples[0].time == 0.0 && samples[0].strain == 0.0);
        assert_true(samples[rows - 1].time == 0.03);
        for (size_t i = 1; i < rows; i++) {
            const double t = fmin(1e-6 * pow(10.0, ((double)i - 1.0) / 7.0), 0.03);
            assert_true(fabs(samples[i].time / t - 1.0) < 1e-14);
            if (!(fabs(samples[i].strain + eq22 * expm1(-t / tau)) < 2e-6 * eq22)) {
                fail_msg("%s at %g s: %.10g", engines[e], t, samples[i].strain);
            }
        }
        free(samples);
    }
    dea_scene_free(&scene);
}

/* Times of decimal places: an edge may begin where another ends, though the sum of two is off the third by rounding (0.1 + 0.2). */
static void edges_may_touch_whatever_the_decimals(void **state)
{
    (void)state;
    for (int on = 0; on < 10; on++) {
        for (int rise = 1; rise < 10; rise++) {
            char drive[200];
            dea_scene scene;
            dea_signal signal;
            dea_error error = {0};
            snprintf(drive, sizeof drive, "waveform: {step: {on: 0.%d ms, rise: 0.%d ms, off: %.1f ms, voltage: 1 kV}, period: %.1f ms}", on, rise,
                     0.1 * (on + rise), 0.1 * (on + 2 * rise));
            if (parse(drive, "lumped", "until: 100 ms, every: 0.37 ms", &scene, &error) != DEA_OK) {
                fail_msg("%s: %s", drive, error.message);
            }
            if (dea_signal_open(&scene, &signal, &error) != DEA_OK) {
                fail_msg("%s: %s", drive, error.message);
            }
            for (size_t i = 0; i < signal.count; i++) {
                if (!(signal.segments[i].to - signal.segments[i].from > 1e-5)) {
                    fail_msg("%s: segment %zu from %.17g to %.17g s", drive, i, signal.segments[i].from, signal.segments[i].to);
                }
            }
            dea_signal_close(&signal);
            dea_scene_free(&scene);
        }
    }
}

/* Dot in true geometry (physics: section 5): C = eps pi r_a^2 lambda_pre^2 lambda_a^4/H. */
static void capacitance_over_time_is_that_of_the_stretched_disc(void **state)
{
    (void)state;
    const double rest = 2.8 * 8.8541878128e-12 * acos(-1.0) * 0.015 * 0.015 * 1.44 / 1e-4;
    dea_scene scene;
    dea_error error;
    assert_int_equal(parse("leakage_resistance: 10 GOhm, waveform: {step: {on: 1 ms, voltage: 4500 V}}", "coverage",
                           "until: 10 ms, every: 0.5 ms", &scene, &error),
                     DEA_OK);
    for (size_t e = 1; e < 3; e++) {
        dea_sample *samples = solve(&scene, engines[e]);
        for (size_t i = 0; i < dea_layout_of(&scene).rows; i++) {
            assert_true(fabs(samples[i].capacitance / (rest * pow(1.0 + samples[i].strain, 4.0)) - 1.0) < 1e-12);
            assert_true(fabs(samples[i].charge - samples[i].capacitance * samples[i].voltage) <= 1e-14 * rest * 4500.0);
        }
        assert_true(samples[20].strain > 0.03);
        free(samples);
    }
    dea_scene_free(&scene);
}

/* C U^2/2 from the charges of physics, section 8: one film, and five in a stack. */
static void field_energy_is_half_of_charge_times_voltage(void **state)
{
    (void)state;
    dea_scene scene = paper_scene(DEA_DOT, 1.2, 0.5, 4500.0);
    assert_true(fabs(solve_direct(&scene, "field").energy / (0.5 * 4500.0 * 1.354360e-6) - 1.0) < 5e-7);
    scene.drive.voltage = -4500.0;
    scene.actuator.layers = 5.0;
    assert_true(fabs(solve_direct(&scene, "field").energy / (0.5 * 4500.0 * 6.771800e-6) - 1.0) < 5e-7);
}

/* I1 - 3 = 2 lambda^2 + lambda^-4 - 3 of the film at rest reaches Jm between two points of the sweep. */
static void a_film_stretched_past_its_chains_names_them(void **state)
{
    (void)state;
    char fault[DEA_FAULT_LENGTH];
    const double constants[DEA_LAW_CONSTANTS] = {45e3, 10.0};
    const dea_film film = dea_law_film(dea_law_find("gent"), constants, 3.0);
    assert_false(film.valid);
    assert_string_equal(dea_film_fault(&film, fault),
                        "Jm = 10 is too small for the pre-stretch 3, where I1 - 3 is 15.0123: the chains are straight at 10");
}

/* A film too stiff to move: its capacitance stays. */
#define STIFF "{yeoh: {C1: 178426 TPa, C2: -6023 TPa, C3: 4234 TPa}, permittivity: 2.8, retardation: 1 us}"

static void read_limited(const char *material, const char *drive, const char *model, const char *transient, dea_scene *scene)
{
    char text[1500];
    dea_error error = {0};
    snprintf(text, sizeof text,
             "actuator: {kind: dot, frame_radius: 30 mm, coverage: 0.5, film_thickness: 100 um, prestretch: 1.2}\n"
             "material: %s\ndrive: {%s}\nmodel: %s\nstudy: {transient: {%s}}\n",
             material, drive, model, transient);
    if (dea_scene_parse(text, strlen(text), "t", ".", NULL, 0, NULL, scene, &error) != DEA_OK) {
        fail_msg("%s: %s", text, error.message);
    }
}

/* One capacitor C with its leakage G behind R, under a source of U that gives at most I. */
typedef struct limited {
    double u, i, r, g, c;
} limited;

/* At the limit C U' = I - G U; from U - R I on C U' = (U_s - U)/R - G U. */
static double charged(const limited *of, double t, double *current)
{
    const double slow = of->c / of->g, top = of->i / of->g, knee = of->u - of->r * of->i;
    const double at = -slow * log1p(-knee / top);
    if (t < at) {
        *current = of->i;
        return -top * expm1(-t / slow);
    }
    const double total = 1.0 / of->r + of->g, end = of->u / of->r / total;
    const double voltage = end + (knee - end) * exp(-(t - at) * total / of->c);
    *current = (of->u - voltage) / of->r;
    return voltage;
}

static void a_source_at_its_limit_charges_a_stiff_film_evenly(void **state)
{
    (void)state;
    const limited of = {.u = 3000.0, .i = 50e-6, .r = 10e6, .g = 1e-9, .c = 2.8 * 8.8541878128e-12 * acos(-1.0) * 0.015 * 0.015 * 1.44 / 1e-4};
    for (int sign = -1; sign < 2; sign += 2) {
        char drive[300];
        dea_scene scene;
        snprintf(drive, sizeof drive,
                 "waveform: {step: {on: 0 s, voltage: %d V, rise: 0 s}}, series_resistance: 10 MOhm, leakage_resistance: 1 GOhm, "
                 "current_limit: 50 uA", sign * 3000);
        read_limited(STIFF, drive, "coverage", "until: 40 ms, every: 0.7 ms", &scene);
        const size_t rows = dea_layout_of(&scene).rows;
        for (size_t e = 1; e < 3; e++) {
            dea_sample *samples = solve(&scene, engines[e]);
            size_t limits = 0;
            for (size_t i = 0; i < rows; i++) {
                double current;
                const double voltage = charged(&of, samples[i].time, &current);
                assert_true(fabs(samples[i].film_voltage - sign * voltage) < 1e-6 * of.u);
                assert_true(fabs(samples[i].current - sign * current) < 1e-5 * of.i);
                assert_true(fabs(samples[i].current) <= of.i * (1.0 + 1e-15));
                limits += (fabs(samples[i].current) > of.i * (1.0 - 1e-15)) == (current == of.i);
            }
            assert_int_equal(limits, rows);
            const dea_layout layout = dea_layout_of(&scene);
            assert_true(dea_layout_summary(&layout, samples)->residual < 1e-5);
            free(samples);
        }
        dea_scene_free(&scene);
    }
}

typedef struct looked {
    double slope, bend;
    size_t times;
} looked;

static double look(void *user, double time)
{
    looked *of = user;
    of->times++;
    return 1.0 + of->slope * time - of->bend * (time - 0.3) * (time - 0.3);
}

/* A source at its limit would have each of its steps searched for a top; a current that has one must be. */
static void a_constant_current_is_not_searched_for_its_top(void **state)
{
    (void)state;
    looked held = {.times = 0}, bent = {.bend = 1e-6}, rising = {.slope = 1e-6};
    dea_peak peak = {0};
    dea_peak_search(&peak, 0.0, 1.0, look, &held);
    assert_true(held.times <= 5 && peak.current == 1.0);
    dea_peak_search(&peak, 0.0, 1.0, look, &bent);
    assert_true(peak.current == 1.0 && bent.times > 5);
    peak = (dea_peak){0};
    dea_peak_search(&peak, 0.0, 1.0, look, &rising);
    assert_true(fabs(peak.current - 1.0 - 1e-6) < 1e-12 && fabs(peak.time - 1.0) < 1e-6);
}

/* Charged and discharged at the limit, with mass and a film that gives way; a sine that the limit clips. */
static void engines_agree_on_limited_films(void **state)
{
    (void)state;
    static const char film[] = "{base: elastosil-2030, density: 1080 kg/m^3, retardation: 0.3 ms}";
    static const char *const drives[] = {
        "waveform: {step: {on: 1 ms, off: 25 ms, voltage: 4 kV}}, series_resistance: 5 MOhm, current_limit: 100 uA",
        "waveform: {sine: {amplitude: 3 kV, frequency: 50 Hz}}, series_resistance: 20 MOhm, leakage_resistance: 1 GOhm, "
        "current_limit: 120 uA"};
    static const char *const models[] = {"lame", "ring"};
    for (size_t k = 0; k < 2; k++) {
        dea_scene scene;
        read_limited(film, drives[k], models[k], "until: 40 ms, every: 0.2 ms", &scene);
        const dea_layout layout = dea_layout_of(&scene);
        dea_sample *ida = solve(&scene, "ida"), *ngspice = solve(&scene, "ngspice");
        double most = 0.0;
        for (size_t i = 0; i < layout.rows; i++) {
            assert_true(fabs(ida[i].strain - ngspice[i].strain) < 2e-6 * 0.03);
            assert_true(fabs(ida[i].film_voltage - ngspice[i].film_voltage) < 2e-5 * 3000.0);
            assert_true(fabs(ida[i].current - ngspice[i].current) < 2e-5 * 1e-4);
            most = fmax(most, fabs(ida[i].strain));
        }
        assert_true(most > 0.004);
        assert_true(dea_layout_summary(&layout, ida)->residual <= 1e-5);
        assert_true(dea_layout_summary(&layout, ngspice)->residual <= 1e-5);
        free(ida);
        free(ngspice);
        dea_scene_free(&scene);
    }
}

/* The script of a picture holds voltage and strain in pairs, in V and percent, on the way up and on the way down. */
static void loops_lie_over_the_voltage(void **state)
{
    (void)state;
    char path[] = "/tmp/loopsXXXXXX.gp", line[200];
    const int made = mkstemps(path, 3);
    assert_true(made >= 0);
    close(made);
    dea_scene scene;
    dea_error error = {0};
    dea_plot *plot;
    assert_int_equal(parse("waveform: {points: [[0 s, 0 V], [10 ms, 900 V], [20 ms, 0 V]]}", "lumped", "until: 20 ms, every: 5 ms", &scene, &error), DEA_OK);
    dea_sample *samples = solve(&scene, "direct");
    const dea_plot_options options = {.loops = true};
    assert_int_equal(dea_plot_begin(&scene, path, &options, &plot, &error), DEA_OK);
    dea_plot_points(plot, 0, samples, 1);
    assert_int_equal(dea_plot_finish(plot, true, &error), DEA_OK);
    FILE *script = fopen(path, "r");
    size_t found = 0;
    while (script && fgets(line, sizeof line, script)) {
        double voltage, strain;
        if (sscanf(line, "%lf %lf", &voltage, &strain) == 2 && found < 5) {
            assert_true(fabs(voltage - samples[found].voltage) < 1e-9 * 900.0);
            assert_true(fabs(strain - 100.0 * samples[found].strain) < 1e-9);
            found++;
        }
    }
    assert_int_equal(found, 5);
    assert_true(samples[3].strain > samples[1].strain && fabs(samples[3].voltage - samples[1].voltage) < 1e-9);
    fclose(script);
    remove(path);
    free(samples);
    scene.study = DEA_STUDY_SWEEP;
    assert_int_equal(dea_plot_begin(&scene, path, &options, &plot, &error), DEA_ERROR_USAGE);
    dea_scene_free(&scene);
}

/* Eq. 22 behind a damper: tau u' + u = K U^2 turns each part of U^2 = c + 2 U_0 a sin - a^2/2 cos 2 by 1/(1 + i k omega tau). */
static double complex harmonic(int k)
{
    const double squared[] = {2.0 * 2000.0 * 500.0, 0.5 * 500.0 * 500.0}, unit = 0.03741735 * 0.015 / (4500.0 * 4500.0);
    const double complex turned = k == 1 ? 1.0 : -I; /* -cos = sin(. - 90 deg) */
    return k > 2 ? 0.0 : unit * squared[k - 1] * turned / (1.0 + I * (2.0 * acos(-1.0) * k * 100.0 * 1e-3));
}

static void windows_tell_extremes_and_harmonics_of_a_sine(void **state)
{
    (void)state;
    const double mean = 0.03741735 * 0.015 / (4500.0 * 4500.0) * (2000.0 * 2000.0 + 0.5 * 500.0 * 500.0);
    double low = INFINITY, high = -INFINITY;
    for (int i = 0; i < 100000; i++) {
        const double angle = 2.0 * acos(-1.0) * i / 100000.0;
        const double u = mean + cimag(harmonic(1) * cexp(I * angle)) + cimag(harmonic(2) * cexp(2.0 * I * angle));
        low = fmin(low, u);
        high = fmax(high, u);
    }
    dea_scene scene;
    dea_error error;
    assert_int_equal(parse("waveform: {sine: {offset: 2 kV, amplitude: 500 V, frequency: 100 Hz, phase: 30 deg, delay: 3 ms}}", "lumped",
                           "until: 0.08 s, every: 0.13 ms, average: {from: 37.7 ms, to: 71 ms}", &scene, &error),
                     DEA_OK);
    for (size_t e = 0; e < 3; e++) {
        dea_sample *samples = solve(&scene, engines[e]);
        const dea_layout layout = dea_layout_of(&scene);
        const dea_summary *summary = dea_layout_summary(&layout, samples);
        const dea_window_figures f = dea_measure_window(&scene, samples, layout.rows, summary, 0);
        assert_true(fabs(f.least - low) < 2e-6 * high && fabs(f.largest - high) < 2e-6 * high);
        for (int k = 1; k <= DEA_HARMONICS; k++) {
            assert_true(fabs(f.amplitude[k - 1] - cabs(harmonic(k))) < 2e-6 * high);
            assert_true(k > 2 ? isnan(f.phase[k - 1]) : fabs(f.phase[k - 1] - carg(harmonic(k)) * 180.0 / acos(-1.0)) < 1e-2);
        }
        scene.transient.averages[0].to = 0.081; /* past the last sample */
        assert_true(isnan(dea_measure_window(&scene, samples, layout.rows, summary, 0).largest));
        scene.transient.averages[0].to = 71e-3;
        samples[400].displacement = (double)NAN;
        assert_true(isnan(dea_measure_window(&scene, samples, layout.rows, summary, 0).amplitude[0]));
        free(samples);
    }
    dea_scene_free(&scene);
}

/* A pulse between two samples, and a sine that they alias, are not made up. */
static void coarse_samples_tell_no_extremes(void **state)
{
    (void)state;
    static const char *const drives[] = {"waveform: {pulse: {voltage: 3 kV, frequency: 1 kHz, duty: 0.3}}",
                                         "waveform: {sine: {amplitude: 1 kV, frequency: 100 Hz}}"};
    for (size_t k = 0; k < 2; k++) {
        dea_scene scene;
        dea_error error;
        assert_int_equal(parse(drives[k], "lumped", "until: 0.1 s, every: 1 ms, average: {from: 50 ms, to: 100 ms}", &scene, &error), DEA_OK);
        dea_sample *samples = solve(&scene, "ida");
        const dea_layout layout = dea_layout_of(&scene);
        const dea_window_figures f = dea_measure_window(&scene, samples, layout.rows, dea_layout_summary(&layout, samples), 0);
        assert_true(isnan(f.least) && isnan(f.largest) && isnan(f.amplitude[0]));
        free(samples);
        dea_scene_free(&scene);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(logarithmic_samples_see_a_film_relax_over_decades),
        cmocka_unit_test(edges_may_touch_whatever_the_decimals),
        cmocka_unit_test(capacitance_over_time_is_that_of_the_stretched_disc),
        cmocka_unit_test(a_film_stretched_past_its_chains_names_them),
        cmocka_unit_test(a_source_at_its_limit_charges_a_stiff_film_evenly),
        cmocka_unit_test(a_constant_current_is_not_searched_for_its_top),
        cmocka_unit_test(engines_agree_on_limited_films),
        cmocka_unit_test(loops_lie_over_the_voltage),
        cmocka_unit_test(windows_tell_extremes_and_harmonics_of_a_sine),
        cmocka_unit_test(coarse_samples_tell_no_extremes),
        cmocka_unit_test(field_energy_is_half_of_charge_times_voltage),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
