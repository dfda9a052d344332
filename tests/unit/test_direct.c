/* Engine `direct` over time and frequency, against closed forms, against the static model and against 80 digits
 * (tests/peers/direct.py). */
#include "scenes.h"

#include <complex.h>
#include <stdlib.h>

static const double pi = 3.14159265358979323846;

enum { MOST_SAMPLES = 20002 };

typedef struct transient {
    dea_sample samples[MOST_SAMPLES];
    dea_summary summary;
    size_t count;
    dea_status status;
    dea_error error;
} transient;

/* The dot of tests/peers/direct.py: Y = 1 MPa, so that lumped has K, f and m from Eqs. 19-21 and the density alone. */
static dea_scene moving_scene(double until, double every)
{
    dea_scene scene = paper_scene(DEA_DOT, 1.2, 0.5, (double)NAN);
    scene.study = DEA_STUDY_TRANSIENT;
    scene.material.modulus = 1e6;
    scene.transient.until = until;
    scene.transient.every = every;
    scene.drive.waveform.period = (double)NAN;
    scene.accuracy = 1e-12;
    scene.models[0] = dea_model_find("lumped");
    return scene;
}

static void add_branch(dea_scene *scene, double g, double tau)
{
    scene->material.prony[scene->material.prony_count++] = (dea_prony){g, tau};
}

static void drive_points(dea_scene *scene, double *times, double *voltages, size_t count)
{
    scene->drive.waveform.kind = DEA_WAVE_POINTS;
    scene->drive.waveform.times = times;
    scene->drive.waveform.voltages = voltages;
    scene->drive.waveform.point_count = count;
}

static void drive_step(dea_scene *scene, double on, double off, double voltage, double rise)
{
    scene->drive.waveform.kind = DEA_WAVE_STEP;
    scene->drive.waveform.step = (dea_step){on, off, voltage, rise};
}

static void drive_sine(dea_scene *scene, double offset, double amplitude, double frequency)
{
    scene->drive.waveform.kind = DEA_WAVE_SINE;
    scene->drive.waveform.sine = (dea_sine){.offset = offset, .amplitude = amplitude, .frequency = frequency};
}

/* A run that the caller frees. */
static transient *run_any(const dea_scene *scene)
{
    transient *t = calloc(1, sizeof *t);
    assert_non_null(t);
    t->count = dea_layout_of(scene).rows;
    assert_true(t->count <= MOST_SAMPLES);
    t->status = dea_engine_find("direct")->transient(NULL, scene, scene->models[0], t->samples, &t->summary, &t->error);
    return t;
}

static transient *run(const dea_scene *scene)
{
    transient *t = run_any(scene);
    if (t->status != DEA_OK) {
        fail_msg("%s", t->error.message);
    }
    return t;
}

static double peak_of(const transient *t)
{
    double peak = 0.0;
    for (size_t i = 0; i < t->count; i++) {
        peak = fmax(peak, fabs(t->samples[i].displacement));
    }
    return peak;
}

/* Coefficients of the scene's network. */
typedef struct coefficients {
    double m, r, k, soft, f;
} coefficients;

static coefficients coefficients_of(const dea_scene *scene)
{
    dea_point point;
    dea_linear linear;
    dea_film_prepare(scene, &point.film);
    dea_point_place(scene, &point);
    scene->models[0]->linear(&point, &linear);
    const double retardation = isnan(scene->material.retardation) ? 0.0 : scene->material.retardation;
    return (coefficients){dea_point_mass(scene, &point), retardation * linear.stiffness, linear.stiffness, linear.softening,
                          linear.force};
}

/* Energies balance, and those of the springs, masses and dampers by themselves: the film's capacitance holds far more. */
static void check_balance(const dea_summary *summary, const char *file, int line)
{
    const double moving = fabs(summary->elastic) + summary->kinetic + summary->dissipated;
    const double missing = summary->work - summary->electric - summary->elastic - summary->kinetic - summary->dissipated;
    if (!(summary->residual <= 1e-12) || !(fabs(missing) <= 1e-11 * moving + 4e-16 * fabs(summary->electric))) {
        print_error("residual %g, mechanical %g\n", summary->residual, missing / moving);
        _fail(file, line);
    }
}

#define assert_balanced(t) check_balance(&(t)->summary, __FILE__, __LINE__)

/* Rows of the reference: time, displacement [m], velocity [m/s]. */
static void check_rows(const transient *t, double every, const double reference[][3], size_t count, double displacement,
                       double velocity)
{
    double fastest = 0.0;
    double farthest = 0.0;
    for (size_t i = 0; i < count; i++) {
        farthest = fmax(farthest, fabs(reference[i][1]));
        fastest = fmax(fastest, fabs(reference[i][2]));
    }
    for (size_t i = 0; i < count; i++) {
        const dea_sample *sample = &t->samples[(size_t)lround(reference[i][0] / every)];
        assert_relative(sample->time, reference[i][0], 1e-15);
        assert_near(sample->displacement, reference[i][1], displacement * farthest);
        assert_near(sample->velocity, reference[i][2], velocity * fastest);
    }
}

static void set_wide(dea_scene *scene)
{
    add_branch(scene, 0.1, 1e-6);
    add_branch(scene, 0.15, 1e-3);
    add_branch(scene, 0.2, 1.0);
    add_branch(scene, 0.1, 1e3);
    add_branch(scene, 0.05, 1e6);
}

static const double wide_with_mass[][3] = {
    {5.0e-1, 0.0, 0.0},
    {1.0, 9.1433844687037917e-5, 1.5218693357082367e-5},
    {2.0, 1.0222483783704388e-4, 7.3201385741062159e-6},
    {4.5, 1.1063841713627496e-4, 1.1874022525356163e-6},
    {1.0e+1, 1.1231330487693824e-4, 4.0929880525189551e-8},
};
static const double wide_without_mass[][3] = {
    {5.0e-1, 0.0, 0.0},
    {1.0, 9.1433843964356058e-5, 1.5218693778144409e-5},
    {2.0, 1.0222483743762883e-4, 7.3201388147036396e-6},
    {4.5, 1.1063841705150921e-4, 1.1874023063338265e-6},
    {1.0e+1, 1.1231330487462043e-4, 4.0929882075713391e-8},
};
static const double wide_with_damper[][3] = {
    {5.0e-1, 0.0, 0.0},
    {1.0, 9.1416519865584486e-5, 1.5229213066056729e-5},
    {2.0, 1.0221546208445e-4, 7.3259532059511576e-6},
    {4.5, 1.1063647786750888e-4, 1.1886365084324329e-6},
    {1.0e+1, 1.123132253575183e-4, 4.0963641841644891e-8},
};
static const double wide_with_both[][3] = {
    {5.0e-1, 0.0, 0.0},
    {1.0, 9.141652058866911e-5, 1.5229212644904121e-5},
    {2.0, 1.0221546248416244e-4, 7.3259529652450525e-6},
    {4.5, 1.1063647795237136e-4, 1.1886364545851429e-6},
    {1.0e+1, 1.1231322535984042e-4, 4.0963640288516474e-8},
};
static const double ringing[][3] = {
    {5.0000000000000001e-4, 1.3630304176983644e-4, 1.2450498915913743e-1},
    {1.0e-3, 2.4671371769128741e-5, -2.0069226620013781e-1},
    {1.5e-3, 1.1627560518624519e-4, 2.7341401290397799e-1},
    {2.0e-3, 5.8074127703070037e-5, -3.0609022003239232e-1},
    {1.0e-2, 5.6208659142039653e-5, 8.49049267873707e-2},
};
static const double triangle[][3] = {
    {1.25e-1, 4.6614337326785497e-5, 7.5095837176065135e-4}, {2.5e-1, 1.8868009170554443e-4, 1.5256819289859792e-3},
    {5.0e-1, 2.9184483645399054e-5, -3.3029592339770069e-4}, {7.5e-1, 2.8036138650503734e-5, 3.2839920810939849e-4},
    {1.0, 1.1694944078010245e-5, 1.1961604768049473e-4},
};
static const double huddle[][3] = {
    {1.0e-4, 1.0351649989043917e-5, 1.9251785221784383e-1},
    {2.0000000000000001e-4, 3.4782193830971551e-5, 2.7804379657983286e-1},
    {2.9999999999999997e-4, 6.3053185185387225e-5, 2.7677718560795115e-1},
    {5.0000000000000001e-4, 1.0926549933379181e-4, 1.7760432091979947e-1},
    {2.0e-3, 1.5420576574828069e-4, 1.0893416777336778e-4},
};
static const double instant[][3] = {
    {1.0e-3, 2.3069602852009217e-4, -3.7401902906318408e-1},
    {2.0e-3, 7.386342214605978e-5, 4.3184372786999632e-1},
    {3.0000000000000001e-3, 2.7488106308903682e-5, -3.8349772878748336e-1},
    {4.0000000000000001e-3, 1.422926924803712e-4, 1.2493670971110636e-1},
    {5.0000000000000001e-3, -4.3860584619407979e-5, 6.9831108822990948e-2},
};
static const double late[][3] = {
    {4.0e+5, 2.2206822753030038e-5, 1.1177724382515339e-10}, {8.0e+5, 8.9880370915517023e-5, 2.2706876564476428e-10},
    {1.2e+6, 1.4332660649272296e-4, 9.6866594937010526e-12}, {1.6e+6, 1.4658732383075745e-4, 6.7883158672814111e-12},
    {2.0e+6, 1.4887240252676124e-4, 4.757185110506861e-12},
};

static double step_times[] = {0.0, 0.5, 0.5 + 1e-6, 10.0};
static double step_voltages[] = {0.0, 0.0, 2000.0, 2000.0};

static void check_wide(double density, double retardation, const double reference[][3])
{
    dea_scene scene = moving_scene(10.0, 0.25);
    set_wide(&scene);
    drive_points(&scene, step_times, step_voltages, 4);
    scene.material.density = density;
    scene.material.retardation = retardation;
    transient *t = run(&scene);
    check_rows(t, 0.25, reference, 5, 1e-13, 1e-12);
    assert_balanced(t);
    assert_true(t->summary.error < 1e-12);
    free(t);
}

static void five_branches_from_microseconds_to_days_with_mass(void **state)
{
    (void)state;
    check_wide(1080.0, (double)NAN, wide_with_mass);
}

static void five_branches_from_microseconds_to_days_without_mass(void **state)
{
    (void)state;
    check_wide((double)NAN, (double)NAN, wide_without_mass);
}

static void five_branches_from_microseconds_to_days_with_a_damper(void **state)
{
    (void)state;
    check_wide((double)NAN, 1e-3, wide_with_damper);
}

static void five_branches_from_microseconds_to_days_with_mass_and_damper(void **state)
{
    (void)state;
    check_wide(1080.0, 1e-3, wide_with_both);
}

static void a_jump_at_the_begin_rings_as_the_exact_film(void **state)
{
    (void)state;
    static double times[] = {0.0, 0.01};
    static double voltages[] = {2000.0, 2000.0};
    dea_scene scene = moving_scene(0.01, 0.0005);
    set_wide(&scene);
    scene.material.density = 1080.0;
    drive_points(&scene, times, voltages, 2);
    transient *t = run(&scene);
    check_rows(t, 0.0005, ringing, 5, 1e-12, 1e-12);
    assert_balanced(t);
    free(t);
}

static void ramps_much_longer_than_some_times_and_much_shorter_than_others(void **state)
{
    (void)state;
    static double times[] = {0.0, 0.25, 0.75, 1.0};
    static double voltages[] = {0.0, 3000.0, -1000.0, 500.0};
    dea_scene scene = moving_scene(1.0, 0.125);
    set_wide(&scene);
    scene.material.density = 1080.0;
    scene.material.retardation = 1e-5;
    drive_points(&scene, times, voltages, 4);
    transient *t = run(&scene);
    check_rows(t, 0.125, triangle, 5, 1e-13, 1e-12);
    assert_balanced(t);
    free(t);
}

static void a_ramp_of_days_shows_the_slowest_branch(void **state)
{
    (void)state;
    static double times[] = {0.0, 1e6, 2e6};
    static double voltages[] = {0.0, 2000.0, 2000.0};
    dea_scene scene = moving_scene(2e6, 4e5);
    set_wide(&scene);
    scene.material.density = 1080.0;
    scene.material.retardation = 1e-5;
    drive_points(&scene, times, voltages, 3);
    transient *t = run(&scene);
    check_rows(t, 4e5, late, 5, 1e-13, 1e-5);
    free(t);
}

/* u = f U^2/K (1 - cos w t). */
static void an_undamped_film_rings_as_a_cosine_over_100000_cycles(void **state)
{
    (void)state;
    dea_scene scene = moving_scene(1.0, 1.0);
    scene.material.density = 1080.0;
    drive_step(&scene, 0.0, (double)NAN, 2000.0, 0.0);
    const coefficients c = coefficients_of(&scene);
    const double omega = sqrt(c.k / c.m);
    scene.transient.until = 100000.0 * 2.0 * pi / omega;
    scene.transient.every = scene.transient.until / 20000.25;
    transient *t = run(&scene);
    const double rest = c.f * 4e6 / c.k;
    for (size_t i = 0; i < t->count; i++) {
        const double angle = omega * t->samples[i].time;
        assert_near(t->samples[i].displacement, rest * (1.0 - cos(angle)), 1e-9 * rest);
        assert_near(t->samples[i].velocity, rest * omega * sin(angle), 1e-9 * rest * omega);
    }
    assert_relative(t->summary.resonance, omega / (2.0 * pi), 1e-14);
    assert_balanced(t);
    assert_true(t->summary.error > 1e-11 && t->summary.error < 1e-8);
    free(t);
}

/* Standard linear solid under a constant force: u = F/K [1 - k/(K + k) e^(-t K/((K + k) tau))]. */
static void one_branch_creeps_as_the_standard_linear_solid(void **state)
{
    (void)state;
    dea_scene scene = moving_scene(5.0, 0.01);
    add_branch(&scene, 0.25, 0.5);
    drive_step(&scene, 0.0, (double)NAN, 3000.0, 0.0);
    const coefficients c = coefficients_of(&scene);
    const double share = 0.25; /* k/(K + k) */
    transient *t = run(&scene);
    for (size_t i = 0; i < t->count; i++) {
        const double wanted = c.f * 9e6 / c.k * (1.0 - share * exp(-t->samples[i].time * (1.0 - share) / 0.5));
        assert_relative(t->samples[i].displacement, wanted, 1e-14);
    }
    assert_balanced(t);
    assert_true(isnan(t->summary.resonance));
    free(t);
}

/* Step response of m u'' + r u' + K u in long double: near critical damping by the series of sin(x)/x. */
static long double damped_step(long double m, long double r, long double k, long double t)
{
    const long double sigma = r / (2.0L * m);
    const long double square = (sigma * sigma - k / m) * t * t;
    long double even = 1.0L;
    long double odd = 1.0L;
    long double term = 1.0L;
    for (int i = 1; i < 400; i++) {
        term *= square / ((2 * i - 1) * (2.0L * i));
        even += term;
        odd += term / (2 * i + 1);
    }
    return (1.0L - expl(-sigma * t) * (even + sigma * t * odd)) / k;
}

static void check_damping(double ratio)
{
    dea_scene scene = moving_scene(0.01, 2e-5);
    scene.material.density = 1080.0;
    coefficients c = coefficients_of(&scene);
    scene.material.retardation = 2.0 * ratio / sqrt(c.k / c.m);
    drive_step(&scene, 0.0, (double)NAN, 2000.0, 0.0);
    c = coefficients_of(&scene);
    transient *t = run(&scene);
    const double rest = c.f * 4e6 / c.k;
    for (size_t i = 0; i < t->count; i++) {
        const long double wanted = damped_step(c.m, c.r, c.k, t->samples[i].time);
        assert_near(t->samples[i].displacement, (double)(wanted * c.f * 4e6L), 3e-14 * rest);
    }
    assert_balanced(t);
    assert_true(t->summary.error < 1e-12);
    free(t);
}

static void critical_damping_is_no_special_case(void **state)
{
    (void)state;
    static const double ratios[] = {1.0,        1.0 + 1e-12, 1.0 - 1e-8, 1.0 + 1e-8, 1.0 - 1e-5, 1.0 + 1e-5, 1.0 - 1e-3,
                                    1.0 + 1e-3, 1.01,        1.0013,     1.1,        0.9,        1.5};
    for (size_t i = 0; i < sizeof ratios / sizeof ratios[0]; i++) {
        check_damping(ratios[i]);
    }
}

static void ramp_of_one_branch(double rise, double tau)
{
    dea_scene scene = moving_scene(2.0 * rise, rise / 50.0);
    add_branch(&scene, 0.25, tau);
    drive_step(&scene, 0.0, (double)NAN, 3000.0, rise);
    const coefficients c = coefficients_of(&scene);
    transient *t = run(&scene);
    const long double s = -0.75L / tau;
    const double held = c.k / 0.75;
    for (size_t i = 1; i < t->count && t->samples[i].time <= rise; i++) {
        /* F = a t^2; the mode adds a/(K + k) (q + s) int e^(s x) (t - x)^2 dx with q + s = 0.25/tau */
        const long double x = s * t->samples[i].time;
        long double third = 1.0L; /* 3! phi_3 */
        long double term = 1.0L;
        for (int n = 4; n < 200; n++) {
            term *= x / n;
            third += term;
        }
        if (x < -20.0L) {
            third = 6.0L * (((expl(x) - 1.0L) / x - 1.0L) / x - 0.5L) / x;
        }
        const long double time = t->samples[i].time;
        const long double force = c.f * powl(3000.0L / rise, 2.0L);
        const long double wanted = force / held * (time * time + 0.25L / tau * powl(time, 3.0L) * third / 3.0L);
        assert_relative(t->samples[i].displacement, (double)wanted, 1e-13);
    }
    assert_balanced(t);
    free(t);
}

static void ramps_keep_their_digits_whatever_the_relaxation_time(void **state)
{
    (void)state;
    static const double ratios[] = {1e-12, 1e-9, 1e-6, 1e-3, 0.1, 0.9, 1.1, 2.0, 10.0, 1e3, 1e6, 1e9};
    for (size_t i = 0; i < sizeof ratios / sizeof ratios[0]; i++) {
        ramp_of_one_branch(0.01, 0.01 / ratios[i]);
    }
}

static void check_settles(const char *model, dea_kind kind)
{
    dea_scene scene = moving_scene(1e4, 1e4 / 3.0);
    scene.actuator.kind = kind;
    scene.models[0] = dea_model_find(model);
    scene.material.density = 1080.0;
    scene.material.retardation = 1e-4;
    add_branch(&scene, 0.3, 0.02);
    add_branch(&scene, 0.2, 20.0);
    drive_step(&scene, 1.0, (double)NAN, 2500.0, 0.0);
    transient *t = run(&scene);
    dea_scene still = scene;
    still.drive.voltage = 2500.0;
    const dea_row row = solve_direct(&still, model);
    assert_relative(t->samples[3].displacement, row.displacement, 1e-13);
    assert_relative(t->samples[3].strain, row.strain, 1e-13);
    assert_relative(t->samples[3].force, row.force, 1e-12);
    assert_int_equal(t->samples[3].state, row.state);
    assert_balanced(t);
    free(t);
}

static void the_film_settles_at_the_static_displacement(void **state)
{
    (void)state;
    check_settles("lumped", DEA_DOT);
    check_settles("lumped", DEA_LENS);
    check_settles("lame", DEA_DOT);
    check_settles("lame", DEA_LENS);
}

/* p(s) as physics.md writes the edge equation. */
static double complex stiffness_at(const dea_scene *scene, const coefficients *c, double square, double complex s)
{
    double rest = 1.0;
    for (size_t i = 0; i < scene->material.prony_count; i++) {
        rest -= scene->material.prony[i].g;
    }
    double complex sum = c->m * s * s + c->r * s + c->k + c->soft * square;
    for (size_t i = 0; i < scene->material.prony_count; i++) {
        const double complex st = s * scene->material.prony[i].tau;
        sum += c->k * scene->material.prony[i].g / rest * st / (1.0 + st);
    }
    return sum;
}

static void a_sine_ends_in_the_steady_state_of_its_two_harmonics(void **state)
{
    (void)state;
    dea_scene scene = moving_scene(3.0, 0.0007);
    scene.material.density = 1080.0;
    scene.material.retardation = 2e-5;
    add_branch(&scene, 0.2, 0.01);
    add_branch(&scene, 0.1, 1e-4);
    drive_sine(&scene, 1500.0, 800.0, 330.0);
    scene.drive.waveform.sine.phase = 0.4;
    const coefficients c = coefficients_of(&scene);
    transient *t = run(&scene);
    const double peak = peak_of(t);
    for (size_t i = 0; i < t->count; i++) {
        const double turns = 330.0 * t->samples[i].time;
        const double complex e = cexp(I * (2.0 * pi * (turns - floor(turns)) + 0.4));
        const double omega = 2.0 * pi * 330.0;
        const double complex first = -2.0 * I * 1500.0 * 800.0 * e / stiffness_at(&scene, &c, 0.0, I * omega);
        const double complex second = -0.5 * 800.0 * 800.0 * e * e / stiffness_at(&scene, &c, 0.0, 2.0 * I * omega);
        const double wanted = c.f * ((1500.0 * 1500.0 + 0.5 * 800.0 * 800.0) / c.k + creal(first + second));
        if (t->samples[i].time > 2.0) {
            assert_near(t->samples[i].displacement, wanted, 1e-12 * peak);
        }
    }
    assert_balanced(t);
    free(t);
}

/* A sine of a whole run is also 20000 short chords of it: the error falls with the square of their length. */
static void a_sine_starts_as_its_chords_do(void **state)
{
    (void)state;
    enum { CHORDS = 4000 };
    static double times[CHORDS + 1], voltages[CHORDS + 1];
    dea_scene scene = moving_scene(0.02, 0.001);
    scene.material.density = 1080.0;
    scene.material.retardation = 2e-5;
    add_branch(&scene, 0.2, 0.01);
    drive_sine(&scene, 500.0, 2000.0, 90.0);
    transient *sine = run(&scene);
    for (int i = 0; i <= CHORDS; i++) {
        times[i] = 0.02 * i / CHORDS;
        voltages[i] = 500.0 + 2000.0 * sin(2.0 * pi * 90.0 * times[i]);
    }
    drive_points(&scene, times, voltages, CHORDS + 1);
    transient *chords = run(&scene);
    const double peak = peak_of(sine);
    for (size_t i = 0; i < sine->count; i++) {
        assert_near(chords->samples[i].displacement, sine->samples[i].displacement, 3e-6 * peak);
    }
    assert_relative(chords->summary.work, sine->summary.work, 1e-5);
    assert_relative(chords->summary.dissipated, sine->summary.dissipated, 1e-5);
    assert_balanced(sine);
    assert_balanced(chords);
    free(sine);
    free(chords);
}

static void an_undamped_film_in_resonance_is_refused(void **state)
{
    (void)state;
    dea_scene scene = moving_scene(0.02, 0.001);
    scene.material.density = 1080.0;
    const coefficients c = coefficients_of(&scene);
    drive_sine(&scene, 1000.0, 100.0, sqrt(c.k / c.m) / (2.0 * pi));
    transient *t = run_any(&scene);
    assert_int_equal(t->status, DEA_ERROR_UNSUPPORTED);
    assert_non_null(strstr(t->error.message, "resonance"));
    free(t);
}

static void a_film_under_bias_stays_where_it_is(void **state)
{
    (void)state;
    static const char *models[] = {"lumped", "lame"};
    for (size_t i = 0; i < 2; i++) {
        dea_scene scene = moving_scene(1000.0, 1.0);
        set_wide(&scene);
        scene.models[0] = dea_model_find(models[i]);
        scene.material.density = 1080.0;
        scene.transient.from_bias = true;
        static double times[] = {0.0, 1000.0};
        static double voltages[] = {2000.0, 2000.0};
        drive_points(&scene, times, voltages, 2);
        transient *t = run(&scene);
        scene.drive.voltage = 2000.0;
        const dea_row row = solve_direct(&scene, models[i]);
        for (size_t k = 0; k < t->count; k++) {
            assert_relative(t->samples[k].displacement, row.displacement, 2e-14);
            assert_near(t->samples[k].velocity, 0.0, 1e-12 * row.displacement * 4000.0);
        }
        assert_near(t->summary.elastic, 0.0, 1e-13 * row.displacement * row.force);
        assert_true(t->summary.residual < 1e-13);
        free(t);
    }
}

static void the_order_of_the_branches_does_not_matter(void **state)
{
    (void)state;
    static const double g[] = {0.1, 0.05, 0.2, 0.15, 0.02};
    static const double tau[] = {1e-3, 2.0, 1e-3, 30.0, 0.1};
    static const int order[] = {3, 0, 4, 2, 1};
    dea_scene scene = moving_scene(1.0, 0.001);
    scene.material.density = 1080.0;
    drive_step(&scene, 0.1, 0.6, 2500.0, 1e-3);
    dea_scene other = scene;
    for (int i = 0; i < 5; i++) {
        add_branch(&scene, g[i], tau[i]);
        add_branch(&other, g[order[i]], tau[order[i]]);
    }
    transient *t = run(&scene);
    transient *shuffled = run(&other);
    const double peak = peak_of(t);
    for (size_t i = 0; i < t->count; i++) {
        assert_near(shuffled->samples[i].displacement, t->samples[i].displacement, 1e-12 * peak);
    }
    free(t);
    free(shuffled);
}

/* Branches of nearly one time act as one of it. */
static void branches_of_nearly_equal_time_act_as_one(void **state)
{
    (void)state;
    dea_scene scene = moving_scene(1.0, 0.001);
    scene.material.density = 1080.0;
    drive_step(&scene, 0.1, 0.6, 2500.0, 1e-3);
    dea_scene other = scene;
    add_branch(&scene, 0.3, 0.05);
    for (int i = 0; i < 10; i++) {
        add_branch(&other, 0.03, 0.05 * (1.0 + (i - 4.5) * 1e-13));
    }
    transient *t = run(&scene);
    transient *split = run(&other);
    const double peak = peak_of(t);
    for (size_t i = 0; i < t->count; i++) {
        assert_near(split->samples[i].displacement, t->samples[i].displacement, 1e-12 * peak);
    }
    assert_balanced(split);
    free(t);
    free(split);
}

/* Forty branches: the film settles, and the energies balance. */
static void forty_branches_keep_the_energy(void **state)
{
    (void)state;
    dea_scene scene = moving_scene(100.0, 0.1);
    for (int i = 0; i < 40; i++) {
        add_branch(&scene, 0.015 + 0.0001 * i, pow(10.0, -6.0 + 0.18 * i));
    }
    drive_step(&scene, 0.5, 50.0, 3000.0, 1e-3);
    for (int kind = 0; kind < 4; kind++) {
        scene.material.density = kind % 2 ? 1080.0 : (double)NAN;
        scene.material.retardation = kind / 2 ? 1e-4 : (double)NAN;
        transient *t = run(&scene);
        const coefficients c = coefficients_of(&scene);
        double held = 0.0;
        for (size_t i = 0; i < 40; i++) {
            held += scene.material.prony[i].g;
        }
        assert_true(t->samples[499].displacement > (1.0 - held) * c.f * 9e6 / c.k);
        assert_true(t->samples[499].displacement < c.f * 9e6 / c.k);
        assert_balanced(t);
        free(t);
    }
}

static void a_branch_far_faster_than_the_film_keeps_its_digits(void **state)
{
    (void)state;
    static double times[] = {0.0, 5e-3};
    static double voltages[] = {2000.0, 1000.0};
    dea_scene scene = moving_scene(5e-3, 1e-3);
    add_branch(&scene, 0.9, 5e-11);
    scene.material.density = 1080.0;
    scene.material.retardation = 1.65e-5;
    drive_points(&scene, times, voltages, 2);
    transient *t = run(&scene);
    check_rows(t, 1e-3, instant, 5, 1e-13, 1e-12);
    assert_balanced(t);
    free(t);
}

static void three_roots_close_together_cost_no_more_digits_than_the_summary_tells(void **state)
{
    (void)state;
    static double times[] = {0.0, 2e-3};
    static double voltages[] = {2000.0, 2000.0};
    dea_scene scene = moving_scene(2e-3, 1e-4);
    add_branch(&scene, 0.8888, 5.045e-5);
    scene.material.density = 1080.0;
    drive_points(&scene, times, voltages, 2);
    transient *t = run(&scene);
    assert_true(t->summary.error < 1e-10);
    check_rows(t, 1e-4, huddle, 5, t->summary.error, 10.0 * t->summary.error);
    free(t);
}

static void an_overdamped_film_with_three_roots_in_a_row_is_solved_or_refused(void **state)
{
    (void)state;
    /* m s^2 + r s + K + k s/(s + q) with a triple root at -w: (s + q) p/m = (s + w)^3 */
    dea_scene scene = moving_scene(0.05, 1e-4);
    scene.material.density = 1080.0;
    const coefficients c = coefficients_of(&scene);
    const double natural = c.k / c.m;
    int refused = 0;
    for (int i = 0; i <= 40; i++) {
        /* no damper: q = 3 w, K + k = 3 m w^2, K q/m = w^3: K/m = w^2/3, k/K = 8 */
        const double w = sqrt(3.0 * natural);
        const double away = pow(10.0, -0.35 * i);
        dea_scene one = scene;
        add_branch(&one, 8.0 / 9.0 * (1.0 - 0.5 * away), 1.0 / (3.0 * w));
        drive_step(&one, 0.0, (double)NAN, 2000.0, 0.0);
        transient *t = run_any(&one);
        if (t->status == DEA_OK) {
            assert_true(t->summary.residual < 1e5 * t->summary.error && t->summary.error < 1e-9);
        } else {
            assert_int_equal(t->status, DEA_ERROR_UNSUPPORTED);
            assert_non_null(strstr(t->error.message, "coincide"));
            refused++;
        }
        free(t);
    }
    assert_true(refused > 5 && refused < 36);
}

/* Without mass and damper the film follows an edge at once; the row at the edge shows the state before, but at t = 0 behind it.
 */
static void a_film_without_inertia_jumps_at_an_edge(void **state)
{
    (void)state;
    dea_scene scene = moving_scene(2.0, 0.25);
    add_branch(&scene, 0.5, 1e3);
    static double times[] = {0.0, 2.0};
    static double voltages[] = {1000.0, 1000.0};
    drive_points(&scene, times, voltages, 2);
    const coefficients c = coefficients_of(&scene);
    transient *t = run(&scene);
    assert_relative(t->samples[0].displacement, c.f * 1e6 / (2.0 * c.k), 1e-14);
    assert_relative(t->samples[0].voltage, 1000.0, 0.0);
    free(t);
    drive_step(&scene, 0.5, 1.5, 1000.0, 0.0);
    t = run(&scene);
    assert_near(t->samples[2].displacement, 0.0, 0.0);
    assert_near(t->samples[2].voltage, 0.0, 0.0);
    assert_true(t->samples[3].displacement > c.f * 1e6 / (2.0 * c.k));
    assert_relative(t->samples[6].voltage, 1000.0, 0.0);
    assert_true(t->samples[6].displacement > 0.99 * t->samples[5].displacement);
    assert_balanced(t);
    free(t);
}

static void leakage_adds_its_current_and_its_loss(void **state)
{
    (void)state;
    dea_scene scene = moving_scene(1.0, 0.1);
    add_branch(&scene, 0.2, 0.01);
    drive_step(&scene, 0.0, 0.5, 1000.0, 0.0);
    transient *dry = run(&scene);
    scene.drive.leakage_resistance = 1e9;
    transient *leaks = run(&scene);
    assert_relative(leaks->summary.work - dry->summary.work, 0.5 * 1e6 / 1e9, 1e-10);
    assert_relative(leaks->summary.dissipated - dry->summary.dissipated, 0.5 * 1e6 / 1e9, 1e-10);
    assert_true(isnan(dry->samples[4].current));
    assert_relative(leaks->samples[4].displacement, dry->samples[4].displacement, 0.0);
    assert_true(leaks->samples[4].current > 1e-6);
    assert_relative(leaks->samples[4].current, 1e-6, 1e-6);
    assert_balanced(leaks);
    free(dry);
    free(leaks);
}

/* lame at 0, 2 and 3 kV: between the edges it rings about each equilibrium with the frequency of the softened film. */
static void softening_lowers_the_frequency_while_the_voltage_is_on(void **state)
{
    (void)state;
    dea_scene scene = moving_scene(0.2, 1e-5);
    scene.models[0] = dea_model_find("lame");
    scene.material.density = 1080.0;
    drive_step(&scene, 0.05, 0.1, 3000.0, 0.0);
    const coefficients c = coefficients_of(&scene);
    transient *t = run(&scene);
    const double k = c.k + c.soft * 9e6;
    const double rest = c.f * 9e6 / k;
    const double on = sqrt(k / c.m);
    const double off = sqrt(c.k / c.m);
    const double u = rest * (1.0 - cos(on * 0.05));
    const double v = rest * on * sin(on * 0.05);
    assert_true(k < 0.95 * c.k);
    for (size_t i = 0; i < t->count; i++) {
        const double time = t->samples[i].time;
        const double later = time - 0.1;
        double wanted = time <= 0.05 ? 0.0 : rest * (1.0 - cos(on * (time - 0.05)));
        if (later > 0.0) {
            wanted = u * cos(off * later) + v / off * sin(off * later);
        }
        assert_near(t->samples[i].displacement, wanted, 1e-12 * rest);
    }
    assert_balanced(t);
    assert_relative(t->summary.resonance, off / (2.0 * pi), 1e-14);
    free(t);
}

/* Past the voltage at which the softened stiffness is negative the film runs away. */
static void a_film_that_softens_too_far_pulls_in(void **state)
{
    (void)state;
    for (int inertia = 0; inertia < 2; inertia++) {
        dea_scene scene = moving_scene(0.2, 1e-4);
        scene.models[0] = dea_model_find("lame");
        scene.material.density = inertia ? 1080.0 : (double)NAN;
        const coefficients c = coefficients_of(&scene);
        const double voltage = 1.1 * sqrt(c.k / -c.soft);
        drive_step(&scene, 0.05, 0.1, voltage, 0.0);
        transient *t = run(&scene);
        assert_int_equal(t->samples[500].state, DEA_STATE_OK);
        assert_int_equal(t->samples[900].state, DEA_STATE_PULL_IN);
        assert_int_equal(t->samples[2000].state, DEA_STATE_PULL_IN);
        assert_true(isnan(t->samples[900].displacement));
        assert_relative(t->samples[900].voltage, voltage, 0.0);
        free(t);
        scene.transient.from_bias = true;
        static double times[] = {0.0, 1.0};
        double voltages[] = {voltage, voltage};
        drive_points(&scene, times, voltages, 2);
        t = run(&scene);
        assert_int_equal(t->samples[0].state, DEA_STATE_PULL_IN);
        free(t);
    }
}

static void check_refused(const dea_scene *scene, const char *word)
{
    const char *why = dea_engine_refuses(dea_engine_find("direct"), scene, scene->models[0]);
    if (!why || !strstr(why, word)) {
        fail_msg("wanted a refusal with \"%s\", got \"%s\"", word, why ? why : "none");
    }
}

static void what_has_no_closed_form_is_refused_by_name(void **state)
{
    (void)state;
    dea_scene scene = moving_scene(1.0, 0.1);
    drive_step(&scene, 0.1, 0.5, 1000.0, 1e-6);
    assert_null(dea_engine_refuses(dea_engine_find("direct"), &scene, scene.models[0]));
    scene.models[0] = dea_model_find("lame");
    check_refused(&scene, "softens");
    scene.drive.waveform.step.rise = 0.0;
    assert_null(dea_engine_refuses(dea_engine_find("direct"), &scene, scene.models[0]));
    drive_sine(&scene, 100.0, 10.0, 5.0);
    check_refused(&scene, "softens");
    scene.models[0] = dea_model_find("coverage");
    check_refused(&scene, "not linear");
    scene.models[0] = dea_model_find("field");
    check_refused(&scene, "moving membrane");
    scene.models[0] = dea_model_find("lumped");
    scene.drive.series_resistance = 1e6;
    check_refused(&scene, "charging");
    scene.drive.series_resistance = 0.0;
    assert_null(dea_engine_refuses(dea_engine_find("direct"), &scene, scene.models[0]));
    scene.accuracy = 1e-13;
    check_refused(&scene, "1e-12");
}

/* Frequency response. */
static dea_scene ac_scene(const char *model, double bias)
{
    dea_scene scene = moving_scene(1.0, 1.0);
    scene.study = DEA_STUDY_AC;
    scene.models[0] = dea_model_find(model);
    scene.material.modulus = (double)NAN;
    scene.material.density = 1080.0;
    scene.material.retardation = 1e-5;
    add_branch(&scene, 0.2, 0.01);
    scene.ac = (dea_ac){.from = 1.0, .to = 1e4, .points_per_decade = 20, .bias = bias};
    scene.drive.voltage = bias;
    return scene;
}

static void respond(const dea_scene *scene, dea_response *rows, size_t count)
{
    dea_error error = {0};
    assert_int_equal(dea_layout_of(scene).rows, count);
    assert_null(dea_engine_refuses(dea_engine_find("direct"), scene, scene->models[0]));
    assert_int_equal(dea_engine_find("direct")->ac(NULL, scene, scene->models[0], rows, NULL, &error), DEA_OK);
}

static double complex phasor(double magnitude, double phase)
{
    return magnitude * cexp(I * phase * pi / 180.0);
}

/* u = 2 f U/p(i w) with C = C0 + C1 u, whose slope is 2 f, and lame's C2. */
static void check_response(const char *model, dea_kind kind, double series, double leakage)
{
    enum { ROWS = 81 };
    dea_response rows[ROWS];
    dea_scene scene = ac_scene(model, 2500.0);
    scene.actuator.kind = kind;
    scene.drive.series_resistance = series;
    scene.drive.leakage_resistance = leakage;
    respond(&scene, rows, ROWS);
    dea_point point;
    dea_linear linear;
    dea_film_prepare(&scene, &point.film);
    dea_point_place(&scene, &point);
    scene.models[0]->linear(&point, &linear);
    const coefficients c = coefficients_of(&scene);
    const double rs = isnan(series) ? 0.0 : series;
    const double leak = isnan(leakage) ? 0.0 : 1.0 / leakage;
    const double film = 2500.0 / (1.0 + rs * leak);
    const double rest = c.f * film * film / (c.k + c.soft * film * film);
    const double *cap = linear.capacitance;
    const double slope = cap[1] + cap[2] * rest;
    const double capacitance = cap[0] + cap[1] * rest + 0.5 * cap[2] * rest * rest;
    for (int i = 0; i < ROWS; i++) {
        const double complex s = 2.0 * I * pi * rows[i].frequency;
        const double complex u = slope * film / stiffness_at(&scene, &c, film * film, s);
        const double complex current = s * (capacitance + slope * film * u) + leak;
        const double complex gain = u / (1.0 + rs * current);
        const double complex impedance = rs + 1.0 / current;
        assert_true(cabs(phasor(rows[i].displacement, rows[i].displacement_phase) - gain) <= 1e-11 * cabs(gain));
        assert_true(cabs(phasor(rows[i].impedance, rows[i].impedance_phase) - impedance) <= 1e-11 * cabs(impedance));
        assert_int_equal(rows[i].state, DEA_STATE_OK);
    }
    assert_relative(rows[0].frequency, 1.0, 0.0);
    assert_relative(rows[ROWS - 1].frequency, 1e4, 0.0);
}

static void the_response_of_a_linear_film_is_its_closed_form(void **state)
{
    (void)state;
    check_response("lumped", DEA_DOT, (double)NAN, (double)NAN);
    check_response("lumped", DEA_LENS, 1e6, (double)NAN);
    check_response("lame", DEA_DOT, 1e7, 1e9);
    check_response("lame", DEA_LENS, (double)NAN, 1e8);
}

static void the_response_at_low_frequency_is_the_slope_of_the_static_curve(void **state)
{
    (void)state;
    static const char *models[] = {"lumped", "coverage", "lame"};
    for (size_t i = 0; i < 6; i++) {
        dea_response row;
        dea_scene scene = ac_scene(models[i / 2], 2500.0);
        scene.actuator.kind = i % 2 ? DEA_LENS : DEA_DOT;
        scene.ac.from = scene.ac.to = 1e-6;
        respond(&scene, &row, 1);
        dea_scene high = scene;
        dea_scene low = scene;
        high.drive.voltage = 2500.1;
        low.drive.voltage = 2499.9;
        const double slope =
            (solve_direct(&high, models[i / 2]).displacement - solve_direct(&low, models[i / 2]).displacement) / 0.2;
        assert_relative(row.displacement, fabs(slope), 1e-7);
        assert_near(row.displacement_phase, i % 2 ? 180.0 : 0.0, 1e-3);
        assert_near(row.impedance_phase, -90.0, 1e-3);
    }
}

/* Steady state under bias and small sine over the amplitude: its first harmonic. */
static void the_response_is_the_transient_of_a_small_sine(void **state)
{
    (void)state;
    static const double frequency = 200.0;
    dea_response row;
    dea_scene scene = ac_scene("lumped", 2000.0);
    scene.ac.from = scene.ac.to = frequency;
    respond(&scene, &row, 1);
    scene.study = DEA_STUDY_TRANSIENT;
    scene.transient = (dea_transient){.until = 2.0, .every = 1.0 / (16.0 * frequency)};
    drive_sine(&scene, 2000.0, 0.5, frequency);
    transient *t = run(&scene);
    double complex sum = 0.0;
    for (size_t i = t->count - 160; i < t->count; i++) {
        sum += t->samples[i].displacement * cexp(-2.0 * I * pi * frequency * t->samples[i].time) / 80.0;
    }
    sum *= I / 0.5; /* sin is the real part of -i e^(i w t) */
    assert_true(cabs(sum - phasor(row.displacement, row.displacement_phase)) <= 1e-9 * row.displacement);
    free(t);
}

static void a_bias_without_equilibrium_has_no_response(void **state)
{
    (void)state;
    static const char *models[] = {"coverage", "lame"};
    for (size_t i = 0; i < 2; i++) {
        dea_response rows[81];
        dea_scene scene = ac_scene(models[i], 20000.0);
        scene.material.constants[1] = scene.material.constants[2] = 0.0;
        scene.actuator.coverage = 0.05;
        respond(&scene, rows, 81);
        assert_relative(rows[80].frequency, 1e4, 0.0);
        for (size_t k = 0; k < 81; k++) {
            assert_int_equal(rows[k].state, DEA_STATE_PULL_IN);
            assert_true(isnan(rows[k].displacement) && isnan(rows[k].impedance) && isnan(rows[k].impedance_phase));
        }
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(five_branches_from_microseconds_to_days_with_mass),
        cmocka_unit_test(five_branches_from_microseconds_to_days_without_mass),
        cmocka_unit_test(five_branches_from_microseconds_to_days_with_a_damper),
        cmocka_unit_test(five_branches_from_microseconds_to_days_with_mass_and_damper),
        cmocka_unit_test(a_jump_at_the_begin_rings_as_the_exact_film),
        cmocka_unit_test(ramps_much_longer_than_some_times_and_much_shorter_than_others),
        cmocka_unit_test(a_ramp_of_days_shows_the_slowest_branch),
        cmocka_unit_test(an_undamped_film_rings_as_a_cosine_over_100000_cycles),
        cmocka_unit_test(one_branch_creeps_as_the_standard_linear_solid),
        cmocka_unit_test(critical_damping_is_no_special_case),
        cmocka_unit_test(ramps_keep_their_digits_whatever_the_relaxation_time),
        cmocka_unit_test(the_film_settles_at_the_static_displacement),
        cmocka_unit_test(a_sine_ends_in_the_steady_state_of_its_two_harmonics),
        cmocka_unit_test(a_sine_starts_as_its_chords_do),
        cmocka_unit_test(an_undamped_film_in_resonance_is_refused),
        cmocka_unit_test(a_film_under_bias_stays_where_it_is),
        cmocka_unit_test(the_order_of_the_branches_does_not_matter),
        cmocka_unit_test(branches_of_nearly_equal_time_act_as_one),
        cmocka_unit_test(forty_branches_keep_the_energy),
        cmocka_unit_test(a_branch_far_faster_than_the_film_keeps_its_digits),
        cmocka_unit_test(three_roots_close_together_cost_no_more_digits_than_the_summary_tells),
        cmocka_unit_test(an_overdamped_film_with_three_roots_in_a_row_is_solved_or_refused),
        cmocka_unit_test(a_film_without_inertia_jumps_at_an_edge),
        cmocka_unit_test(leakage_adds_its_current_and_its_loss),
        cmocka_unit_test(softening_lowers_the_frequency_while_the_voltage_is_on),
        cmocka_unit_test(a_film_that_softens_too_far_pulls_in),
        cmocka_unit_test(what_has_no_closed_form_is_refused_by_name),
        cmocka_unit_test(the_response_of_a_linear_film_is_its_closed_form),
        cmocka_unit_test(the_response_at_low_frequency_is_the_slope_of_the_static_curve),
        cmocka_unit_test(the_response_is_the_transient_of_a_small_sine),
        cmocka_unit_test(a_bias_without_equilibrium_has_no_response),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
