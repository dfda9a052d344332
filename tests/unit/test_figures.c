/* Means over windows, which the engines integrate: closed forms, and each engine against the others. */
#include "random_transients.h"

#include <stdlib.h>

#include "network/dynamics.h"
#include "network/swing.h"

static const char *const engines[] = {"direct", "ida", "ngspice"};
enum { ENGINES = 3 };

/* Result of a run; the caller frees its point. */
typedef struct outcome {
    char *point;
    dea_layout layout;
} outcome;

static dea_status take(void *user, size_t first, const void *points, size_t count, dea_error *error)
{
    const outcome *o = user;
    (void)error;
    memcpy(o->point + first * o->layout.point_size, points, count * o->layout.point_size);
    return DEA_OK;
}

static outcome run(const dea_scene *scene, const char *engine)
{
    outcome o = {.layout = dea_layout_of(scene)};
    dea_error error = {0};
    o.point = calloc(dea_scene_point_count(scene), o.layout.point_size);
    assert_non_null(o.point);
    const dea_run_options options = {.jobs = 1, .points = take, .user = &o};
    if (dea_study_run(scene, dea_engine_find(engine), &options, &error) != DEA_OK) {
        fail_msg("%s: %s", engine, error.message);
    }
    return o;
}

static dea_summary summary_of(const outcome *o)
{
    return *dea_layout_summary(&o->layout, o->point);
}

static dea_sample sample_of(const outcome *o, size_t row)
{
    dea_sample sample;
    memcpy(&sample, o->point + row * o->layout.row_size, sizeof sample);
    return sample;
}

static dea_summary summary_by(const dea_scene *scene, const char *engine)
{
    const outcome o = run(scene, engine);
    const dea_summary summary = summary_of(&o);
    free(o.point);
    return summary;
}

/* The paper's film under a step. */
static dea_scene moving_scene(const char *model, dea_step step, double until, double every)
{
    dea_scene scene = paper_scene(DEA_DOT, 1.2, 0.5, (double)NAN);
    scene.models[0] = dea_model_find(model);
    scene.study = DEA_STUDY_TRANSIENT;
    scene.drive.waveform = (dea_waveform){.kind = DEA_WAVE_STEP, .step = step, .period = (double)NAN};
    scene.transient = (dea_transient){.until = until, .every = every};
    return scene;
}

static void add_window(dea_scene *scene, double from, double to)
{
    scene->transient.averages[scene->transient.average_count++] = (dea_window){from, to};
}

/* Mass [kg], stiffness [N/m], force per square of the voltage [N/V^2] of a film whose springs are linear. */
typedef struct film {
    double m, k, f;
} film;

static film film_of(const dea_scene *scene)
{
    dea_dynamics d;
    dea_error error = {0};
    assert_int_equal(dea_dynamics_open(scene, scene->models[0], &d, &error), DEA_OK);
    const film c = {d.mass, dea_dynamics_stiffness(&d, 0.0, 0.0, true), dea_dynamics_edge(&d, 0.0).push};
    dea_dynamics_close(&d);
    return c;
}

/* u = F/K (1 - cos w (t - t_0)) behind a jump at t_0; samples of a third of a period and less than one in a window. */
static void mean_of_an_undamped_swing_is_its_integral_whatever_the_samples(void **state)
{
    (void)state;
    dea_scene scene = moving_scene("lumped", (dea_step){1e-3, (double)NAN, 3000.0, 0.0}, 0.02, 4.7e-4);
    scene.material.density = 1080.0;
    add_window(&scene, 0.0, 0.02);
    add_window(&scene, 4.7e-3, 9.4e-3); /* at samples, but for rounding */
    add_window(&scene, 1.23e-3, 17.71e-3);
    add_window(&scene, 5.001e-3, 5.0013e-3); /* between two samples */
    add_window(&scene, 0.5e-3, 1.1e-3);      /* over the edge */
    add_window(&scene, 0.1e-3, 1e-3);        /* before it */
    const film c = film_of(&scene);
    const double omega = sqrt(c.k / c.m), rest = c.f * 9e6 / c.k;
    for (size_t e = 0; e < ENGINES; e++) {
        const dea_summary summary = summary_by(&scene, engines[e]);
        for (size_t i = 0; i < scene.transient.average_count; i++) {
            const dea_window w = scene.transient.averages[i];
            const double from = fmax(w.from - 1e-3, 0.0), to = fmax(w.to - 1e-3, 0.0);
            const double integral = rest * (to - from - (sin(omega * to) - sin(omega * from)) / omega);
            const dea_average mean = summary.averages[i];
            assert_near(mean.displacement, integral / (w.to - w.from), 2.0 * rest * scene.accuracy);
            assert_relative(mean.strain, mean.displacement / 0.015, 1e-14);
        }
        assert_true(isnan(summary.averages[scene.transient.average_count].displacement)); /* there is no such window */
    }
}

/* A film under 50 Hz seen 100 times a second, always at 0 V: the force's mean is f A^2/2. */
static void mean_under_a_sine_is_that_of_the_film_not_of_its_samples(void **state)
{
    (void)state;
    dea_scene scene = moving_scene("lumped", (dea_step){0}, 0.2, 0.01);
    scene.drive.waveform =
        (dea_waveform){.kind = DEA_WAVE_SINE, .sine = {.amplitude = 4500.0, .frequency = 50.0}, .period = (double)NAN};
    scene.material.retardation = 2e-5;
    scene.accuracy = 1e-4;
    add_window(&scene, 0.1, 0.2);
    const film c = film_of(&scene);
    const double wanted = 0.5 * c.f * 4500.0 * 4500.0 / c.k;
    assert_near(wanted, 2.8e-4, 0.1e-4);
    for (size_t e = 0; e < ENGINES; e++) {
        const outcome o = run(&scene, engines[e]);
        assert_true(fabs(sample_of(&o, 15).displacement) < 1e-3 * wanted);
        assert_near(summary_of(&o).averages[0].displacement, wanted, 4e-4 * wanted);
        free(o.point);
    }
}

/* K int u dt = int F dt - m dv - r du: the balance of momentum over a window between two samples, lame's softening under a
 * constant voltage included. */
static void means_balance_the_momentum_of_the_film(void **state)
{
    (void)state;
    static const char *const models[] = {"lumped", "lame"};
    for (int i = 0; i < 4; i++) {
        dea_scene scene = moving_scene(models[i % 2], (dea_step){0.0, 7e-3, 3000.0, 0.0}, 0.01, 2.5e-5);
        scene.material.density = 1080.0;
        scene.material.retardation = i < 2 ? 3e-5 : 2e-3;
        add_window(&scene, 40 * 2.5e-5, 240 * 2.5e-5);
        dea_dynamics d;
        dea_error error = {0};
        assert_int_equal(dea_dynamics_open(&scene, scene.models[0], &d, &error), DEA_OK);
        const double k = dea_dynamics_stiffness(&d, 0.0, 3000.0, true), rest = dea_dynamics_stiffness(&d, 0.0, 0.0, true);
        const double force = dea_dynamics_edge(&d, 0.0).push * 9e6;
        for (size_t e = 0; e < ENGINES; e++) {
            const outcome o = run(&scene, engines[e]);
            const dea_sample a = sample_of(&o, 40), b = sample_of(&o, 240);
            const double width = 200 * 2.5e-5, drag = scene.material.retardation * rest; /* of the film's own springs */
            const double mean =
                (force - (d.mass * (b.velocity - a.velocity) + drag * (b.displacement - a.displacement)) / width) / k;
            assert_near(summary_of(&o).averages[0].displacement, mean, 2e-5 * force / k); /* as far as velocities are known */
            free(o.point);
        }
        dea_dynamics_close(&d);
    }
}

static double peak_of(const outcome *o)
{
    double peak = 0.0;
    for (size_t i = 0; i < o->layout.rows; i++) {
        peak = fmax(peak, fabs(sample_of(o, i).displacement));
    }
    return peak;
}

/* Two windows anywhere, one of them as narrow as a part of a sample. */
static void add_windows(uint64_t *seed, dea_scene *scene)
{
    const double until = scene->transient.until;
    const double from = until * random_between(seed, 0.0, 0.8), width = scene->transient.every * random_decades(seed, 0.01, 1.0);
    add_window(scene, from, from + random_between(seed, 0.05, 1.0) * (until - from));
    add_window(scene, from, fmin(from + width, until));
}

static void check_means(const dea_scene *scene, const char *engine, const outcome *truth, double accuracy, int number)
{
    dea_scene own = *scene;
    own.accuracy = accuracy;
    const outcome o = run(&own, engine);
    const dea_summary a = summary_of(&o), b = summary_of(truth);
    for (size_t i = 0; i < scene->transient.average_count; i++) {
        const double gap = fabs(a.averages[i].displacement - b.averages[i].displacement);
        const bool none = isnan(a.averages[i].displacement) && isnan(b.averages[i].displacement);
        if (!none && !(gap <= accuracy * fmax(peak_of(truth), fabs(b.averages[i].displacement)))) {
            fail_msg("scene %d, %s: mean %zu %.9g, wanted %.9g: %.2g of the peak, accuracy %g", number, engine, i,
                     a.averages[i].displacement, b.averages[i].displacement, gap / peak_of(truth), accuracy);
        }
    }
    free(o.point);
}

static void means_of_random_films_keep_the_accuracy(void **state)
{
    (void)state;
    int compared = 0, closed = 0;
    for (int number = 0; number < 14; number++) {
        uint64_t seed = 2750159u * (uint64_t)(number + 1);
        dea_scene scene;
        random_transient(&seed, &scene);
        add_windows(&seed, &scene);
        if (number % 3 == 0) {
            random_blur(&seed, &scene);
            for (size_t i = 0; i < 2; i++) {
                scene.transient.averages[i].to *= 0.5;
                scene.transient.averages[i].from *= 0.5;
            }
        }
        const double accuracy = random_decades(&seed, 1e-6, 1e-3);
        scene.accuracy = 1e-2 * accuracy;
        const bool direct = !dea_engine_refuses(dea_engine_find("direct"), &scene, scene.models[0]);
        const outcome truth = run(&scene, direct ? "direct" : "ida");
        if (isfinite(sample_of(&truth, truth.layout.rows - 1).displacement)) {
            check_means(&scene, "ida", &truth, accuracy, number);
            compared++;
            closed += direct ? 1 : 0;
        }
        free(truth.point);
    }
    assert_true(compared > 8 && closed > 1);
}

static void means_of_random_films_are_those_of_ngspice(void **state)
{
    (void)state;
    int compared = 0;
    for (int number = 0; number < 6; number++) {
        uint64_t seed = 86028121u * (uint64_t)(number + 1);
        dea_scene scene;
        random_transient(&seed, &scene);
        add_windows(&seed, &scene);
        scene.accuracy = 1e-7;
        const outcome truth = run(&scene, "ida");
        scene.accuracy = 1e-4;
        const outcome o = run(&scene, "ngspice");
        if (isfinite(sample_of(&truth, truth.layout.rows - 1).displacement) && sample_of(&o, 0).state != DEA_STATE_FAILED &&
            isfinite(sample_of(&o, o.layout.rows - 1).displacement)) {
            check_means(&scene, "ngspice", &truth, 1e-4, number);
            compared++;
        }
        free(truth.point);
        free(o.point);
    }
    assert_true(compared > 3);
}

/* Samples that do not see a swing let an engine leave the mass out; a window that does see it needs it. */
static void a_window_behind_an_edge_keeps_the_swing_that_samples_miss(void **state)
{
    (void)state;
    dea_scene scene = moving_scene("lumped", (dea_step){1.0, (double)NAN, 4500.0, 1e-6}, 3.0, 0.1);
    scene.material.density = 1080.0;
    scene.material.retardation = 1e-4;
    scene.accuracy = 1e-5;
    assert_true(summary_by(&scene, "ida").omitted > 0.0); /* without a window it goes */
    add_window(&scene, 1.0001, 1.0006);
    add_window(&scene, 0.9, 1.0004);
    const outcome truth = run(&scene, "direct");
    check_means(&scene, "ida", &truth, 1e-5, 0);
    check_means(&scene, "ngspice", &truth, 1e-5, 0);
    free(truth.point);
}

/* Past the voltage where nothing holds it a film leaves its frame within a period: what comes before has a mean. */
static void a_film_that_pulls_in_has_means_up_to_there(void **state)
{
    (void)state;
    dea_scene scene = moving_scene("lame", (dea_step){1e-3, (double)NAN, 0.0, 0.0}, 0.02, 1e-4);
    scene.material.density = 1080.0;
    scene.accuracy = 1e-4;
    scene.drive.waveform.step.voltage = 1.2 * pull_in_voltage(&scene, "lame");
    add_window(&scene, 0.0, 9e-4);
    add_window(&scene, 1e-3, 1.05e-3);
    add_window(&scene, 1e-3, 0.02);
    for (size_t e = 0; e < ENGINES; e++) {
        const outcome o = run(&scene, engines[e]);
        const dea_summary summary = summary_of(&o);
        assert_int_equal(sample_of(&o, o.layout.rows - 1).state, DEA_STATE_PULL_IN);
        assert_true(summary.averages[0].displacement == 0.0);
        assert_true(summary.averages[1].displacement > 0.0);
        assert_true(isnan(summary.averages[2].displacement) && isnan(summary.averages[2].strain));
        free(o.point);
    }
}

/* With or without its mass, by any engine: the swing of the whole film. */
static void every_engine_names_the_same_swing(void **state)
{
    (void)state;
    dea_scene scene = moving_scene("lumped", (dea_step){1.0, (double)NAN, 4500.0, 1e-6}, 3.0, 0.1);
    scene.material.density = 1080.0;
    scene.material.retardation = 1e-4;
    scene.accuracy = 1e-5;
    const dea_swing swing = dea_swing_free(&scene, scene.models[0]);
    assert_true(swing.frequency > 600.0 && swing.frequency < 716.0);
    for (int full = 0; full < 2; full++) {
        scene.full = full;
        for (size_t e = 0; e < ENGINES; e++) {
            const dea_summary summary = summary_by(&scene, engines[e]);
            assert_relative(summary.resonance, swing.frequency, 1e-12);
            assert_relative(summary.decay, swing.decay, 1e-12);
        }
    }
}

/* A film that hardly moves charges as a capacitor: at the end of the rise T the current through R_s is C U/T (1 - e^-T/RC), and
 * samples miss it; under a sine it turns at U w C/sqrt(1 + (w R C)^2) and a transient that decays. */
static void peak_current_is_that_between_the_samples(void **state)
{
    (void)state;
    dea_scene scene = moving_scene("lumped", (dea_step){1e-3, (double)NAN, 30.0, 5e-5}, 0.01, 3.3e-4);
    scene.material.density = 1080.0;
    scene.material.retardation = 1e-4;
    scene.drive.series_resistance = 1e5;
    scene.full = true;
    dea_dynamics d;
    dea_error error = {0};
    assert_int_equal(dea_dynamics_open(&scene, scene.models[0], &d, &error), DEA_OK);
    const double c = dea_dynamics_edge(&d, 0.0).capacitance, lag = 1e5 * c;
    dea_dynamics_close(&d);
    for (size_t e = 1; e < ENGINES; e++) {
        const dea_summary step = summary_by(&scene, engines[e]);
        assert_relative(step.peak_current, c * 30.0 / 5e-5 * -expm1(-5e-5 / lag), 2e-5); /* it moves by 1e-8 of its size */
        assert_relative(step.peak_time, 1.05e-3, 1e-9);
    }
    scene.drive.waveform =
        (dea_waveform){.kind = DEA_WAVE_SINE, .sine = {.amplitude = 30.0, .frequency = 440.0}, .period = (double)NAN};
    scene.transient.from_bias = true;
    const double omega = 2.0 * DEA_PI * 440.0, turn = omega * lag;
    for (size_t e = 1; e < ENGINES; e++) {
        const dea_summary sine = summary_by(&scene, engines[e]);
        assert_relative(sine.peak_current, 30.0 * omega * c / sqrt(1.0 + turn * turn), 2e-5);
    }
    scene.drive.series_resistance = (double)NAN; /* a sine jumps nowhere: U sqrt((w C)^2 + G^2) */
    scene.drive.leakage_resistance = 1e6;
    for (size_t e = 0; e < ENGINES; e++) {
        const dea_summary sine = summary_by(&scene, engines[e]);
        assert_relative(sine.peak_current, 30.0 * hypot(omega * c, 1e-6), 2e-5);
    }
    scene.drive.leakage_resistance = (double)NAN; /* no port */
    assert_true(isnan(summary_by(&scene, "ida").peak_current));
}

/* Where the voltage jumps nothing limits the current, and of a film that runs without its mass it is not known. */
static void peak_current_that_is_not_known_is_not_told(void **state)
{
    (void)state;
    for (size_t e = 0; e < ENGINES; e++) {
        dea_scene scene = moving_scene("lumped", (dea_step){1e-3, (double)NAN, 3000.0, 0.0}, 0.01, 3.3e-4);
        scene.material.density = 1080.0;
        scene.material.retardation = 1e-4;
        scene.drive.leakage_resistance = 1e9;
        scene.full = true;
        assert_true(isnan(summary_by(&scene, engines[e]).peak_current));
        scene.drive.waveform.step.rise = 1e-4;
        assert_true(summary_by(&scene, engines[e]).peak_current > 0.0);
        scene.reduction.mass = true;
        assert_true(isnan(summary_by(&scene, engines[e]).peak_current));
    }
}

/* A film that swings on the source itself, through corners and with a branch: the closed form and both networks see one peak. */
static void peak_current_of_a_swinging_film_is_that_of_its_closed_form(void **state)
{
    (void)state;
    double times[] = {0.0, 1e-3, 1.1e-3, 2e-3, 2.05e-3, 0.01}, volts[] = {0.0, 0.0, 4000.0, 4000.0, -3000.0, -2000.0};
    for (int i = 0; i < 3; i++) {
        dea_scene scene = moving_scene("lumped", (dea_step){0.0, (double)NAN, 4000.0, 0.0}, 0.01, 3.3e-4);
        scene.drive.waveform = (dea_waveform){
            .kind = DEA_WAVE_POINTS, .point_count = 6, .times = times, .voltages = volts, .period = (double)NAN};
        if (i == 2) {
            scene.drive.waveform = (dea_waveform){
                .kind = DEA_WAVE_SINE, .sine = {.amplitude = 3000.0, .frequency = 440.0}, .period = (double)NAN};
        }
        scene.material.density = 1080.0;
        scene.material.retardation = i == 0 ? 5e-5 : (double)NAN;
        scene.material.prony_count = 1;
        scene.material.prony[0] = (dea_prony){.g = 0.2, .tau = 2e-3};
        scene.drive.leakage_resistance = 1e8;
        scene.accuracy = 1e-6;
        scene.full = true;
        const dea_summary wanted = summary_by(&scene, "direct");
        for (size_t e = 1; e < ENGINES; e++) {
            const dea_summary got = summary_by(&scene, engines[e]);
            assert_relative(got.peak_current, wanted.peak_current, 1e-5);
            assert_near(got.peak_time, wanted.peak_time, 1e-6);
        }
    }
}

/* A film that swings behind its resistance: both engines see the same peak. */
static void peak_current_of_a_moving_film_is_that_of_either_engine(void **state)
{
    (void)state;
    for (int i = 0; i < 3; i++) {
        static const char *const models[] = {"lumped", "lame", "coverage"};
        dea_scene scene = moving_scene(models[i], (dea_step){1e-3, 6e-3, 4000.0, i == 1 ? 0.0 : 1e-4}, 0.01, 3.3e-4);
        scene.material.density = 1080.0;
        scene.material.retardation = 1e-4;
        scene.drive.series_resistance = 2e6;
        scene.accuracy = 1e-5;
        scene.full = true;
        const dea_summary a = summary_by(&scene, "ida"), b = summary_by(&scene, "ngspice");
        assert_relative(b.peak_current, a.peak_current, 1e-4);
        assert_near(b.peak_time, a.peak_time, 1e-5);
        if (i == 1) {
            assert_relative(a.peak_current, 2e-3, 1e-9); /* U/R_s at the jump */
        }
    }
}

/* |1/(1 + 2 i zeta x - x^2)|: its top at x^2 = 1 - 2 zeta^2, and where it falls to 1/sqrt(2). Frequencies far apart. */
static void resonance_and_bandwidth_are_right_between_frequencies(void **state)
{
    (void)state;
    static const double dampings[] = {1e-4, 0.02, 0.3, 0.65};
    static const char *const able[] = {"direct", "ngspice"};
    for (size_t i = 0; i < 8; i++) {
        dea_scene scene = moving_scene("lumped", (dea_step){0}, 1.0, 1.0);
        scene.material.density = 1080.0;
        const film c = film_of(&scene);
        const double natural = sqrt(c.k / c.m), zeta = dampings[i / 2], q = 1.0 - 2.0 * zeta * zeta;
        scene.material.retardation = 2.0 * zeta / natural;
        scene.study = DEA_STUDY_AC;
        scene.ac = (dea_ac){.from = 1.0, .to = 5000.0, .points_per_decade = i % 2 ? 3 : 40, .bias = 2000.0};
        for (size_t e = 0; e < 2; e++) {
            const outcome o = run(&scene, able[e]);
            const dea_band band = *dea_layout_band(&o.layout, o.point);
            const double first = 1.0 / hypot(1.0 - pow(2.0 * DEA_PI / natural, 2.0), 4.0 * DEA_PI * zeta / natural);
            assert_relative(band.resonance, natural / (2.0 * DEA_PI) * sqrt(q), scene.accuracy);
            /* falls to 1/sqrt(2) of that at 1 Hz: y^2 - 2 q y + 1 = 2/first^2 with y = x^2 */
            const double y = q + sqrt(q * q - 1.0 + 2.0 / (first * first));
            assert_relative(band.bandwidth, natural / (2.0 * DEA_PI) * sqrt(y), scene.accuracy);
            free(o.point);
        }
    }
}

/* Past the fold nothing is there; without a bias nothing answers; below its resonance a film has none. */
static void responses_without_a_peak_name_none(void **state)
{
    (void)state;
    static const char *const able[] = {"direct", "ngspice"};
    dea_scene scene = moving_scene("lame", (dea_step){0}, 1.0, 1.0);
    scene.study = DEA_STUDY_AC;
    scene.material.density = 1080.0;
    const double biases[] = {1.2 * pull_in_voltage(&scene, "lame"), 0.0, 2000.0};
    for (size_t i = 0; i < 3; i++) {
        scene.ac = (dea_ac){.from = 1.0, .to = 300.0, .points_per_decade = 5, .bias = biases[i]};
        for (size_t e = 0; e < 2; e++) {
            const outcome o = run(&scene, able[e]);
            const dea_band band = *dea_layout_band(&o.layout, o.point);
            assert_true(isnan(band.resonance) && isnan(band.bandwidth));
            free(o.point);
        }
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(mean_of_an_undamped_swing_is_its_integral_whatever_the_samples),
        cmocka_unit_test(mean_under_a_sine_is_that_of_the_film_not_of_its_samples),
        cmocka_unit_test(means_balance_the_momentum_of_the_film),
        cmocka_unit_test(means_of_random_films_keep_the_accuracy),
        cmocka_unit_test(means_of_random_films_are_those_of_ngspice),
        cmocka_unit_test(a_window_behind_an_edge_keeps_the_swing_that_samples_miss),
        cmocka_unit_test(a_film_that_pulls_in_has_means_up_to_there),
        cmocka_unit_test(every_engine_names_the_same_swing),
        cmocka_unit_test(peak_current_is_that_between_the_samples),
        cmocka_unit_test(peak_current_of_a_moving_film_is_that_of_either_engine),
        cmocka_unit_test(peak_current_that_is_not_known_is_not_told),
        cmocka_unit_test(peak_current_of_a_swinging_film_is_that_of_its_closed_form),
        cmocka_unit_test(resonance_and_bandwidth_are_right_between_frequencies),
        cmocka_unit_test(responses_without_a_peak_name_none),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
