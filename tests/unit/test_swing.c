/* The damped swing of the free film: closed forms, LAPACK's eigenvalues, the closed form of `direct`, and the film's own trace.
 */
#include "random_transients.h"

#include <complex.h>
#include <stdlib.h>

#include "network/swing.h"
#include "support/lapack.h"

static const char *const models[] = {"lumped", "lame", "coverage"};

/* The paper's film with mass, about to be switched on. */
static dea_scene heavy_scene(const char *model, dea_kind kind)
{
    dea_scene scene = paper_scene(kind, 1.2, 0.5, (double)NAN);
    scene.models[0] = dea_model_find(model);
    scene.study = DEA_STUDY_TRANSIENT;
    scene.material.density = 1080.0;
    scene.transient = (dea_transient){.until = 0.02, .every = 2e-5};
    scene.drive.waveform = (dea_waveform){
        .kind = DEA_WAVE_STEP, .step = {.on = 1e-3, .off = (double)NAN, .voltage = 3000.0, .rise = 1e-6}, .period = (double)NAN};
    return scene;
}

static void open_dynamics(const dea_scene *scene, dea_dynamics *dynamics)
{
    dea_error error = {0};
    if (dea_dynamics_open(scene, scene->models[0], dynamics, &error) != DEA_OK) {
        fail_msg("%s", error.message);
    }
}

/* Mass and stiffness of the relaxed film at rest. */
typedef struct oscillator {
    double m, k;
} oscillator;

static oscillator oscillator_of(const dea_scene *scene)
{
    dea_dynamics dynamics;
    open_dynamics(scene, &dynamics);
    const oscillator o = {dynamics.mass, dea_dynamics_stiffness(&dynamics, 0.0, 0.0, true)};
    dea_dynamics_close(&dynamics);
    return o;
}

/* m s^2 + r s + K: decay d = r/2m, frequency sqrt(K/m - d^2)/(2 pi); r = tau_KV K. */
static void a_damper_slows_the_swing_and_ends_it_at_critical_damping(void **state)
{
    (void)state;
    for (size_t i = 0; i < 6; i++) {
        dea_scene scene = heavy_scene(models[i % 3], i < 3 ? DEA_DOT : DEA_LENS);
        const oscillator o = oscillator_of(&scene);
        const double omega = sqrt(o.k / o.m);
        const dea_swing bare = dea_swing_free(&scene, scene.models[0]);
        assert_relative(bare.frequency, omega / (2.0 * DEA_PI), 1e-14);
        assert_true(bare.decay == 0.0);
        for (double zeta = 0.01; zeta < 0.999; zeta += 0.0706) {
            scene.material.retardation = 2.0 * zeta / omega;
            const dea_swing swing = dea_swing_free(&scene, scene.models[0]);
            assert_relative(swing.frequency, omega * sqrt(1.0 - zeta * zeta) / (2.0 * DEA_PI), 1e-12);
            assert_relative(swing.decay, zeta * omega, 1e-13);
        }
        scene.material.retardation = 2.0001 / omega;
        assert_true(isnan(dea_swing_free(&scene, scene.models[0]).frequency));
        scene.material.density = (double)NAN;
        scene.material.retardation = (double)NAN;
        assert_true(isnan(dea_swing_free(&scene, scene.models[0]).frequency));
    }
}

/* What a run leaves out is no part of it: the swing is that of the whole film. */
static void a_reduction_changes_no_swing(void **state)
{
    (void)state;
    dea_scene scene = heavy_scene("lumped", DEA_DOT);
    scene.material.prony[scene.material.prony_count++] = (dea_prony){0.3, 2e-4};
    scene.material.retardation = 1e-5;
    const dea_swing whole = dea_swing_free(&scene, scene.models[0]);
    scene.reduction = (dea_reduction){.mass = true, .damper = true, .branches = {DEA_BRANCH_OUT}};
    const dea_swing reduced = dea_swing_free(&scene, scene.models[0]);
    assert_true(whole.frequency > 0.0 && reduced.frequency == whole.frequency && reduced.decay == whole.decay);
}

enum { MOST = DEA_PRONY_MAX + 3 };

/* Eigenvalues of u' = v, m v' = -K_inf u - r v - sum k_i (u - z_i) + 2 phi U y, z_i' = (u - z_i)/tau_i, and with a series
 * resistance the film voltage's change y: C y' = -2 phi U v - (1/R_s + 1/R_p) y. The complex pair, 0: none. Times are in units of
 * 1/omega. */
static double complex eigenvalue_of(dea_dynamics *d, double u, double voltage)
{
    const dea_edge e = dea_dynamics_edge(d, u);
    const double stiffness = dea_dynamics_stiffness(d, u, voltage, true), viscous = dea_edge_viscous(d, &e);
    const double omega = sqrt(stiffness / d->mass);
    const int port = d->series > 0.0 ? 1 : 0, n = 2 + (int)d->branch_count + port;
    double a[MOST * MOST] = {0}, real[MOST], imaginary[MOST];
    const double push = 2.0 * e.push * voltage / stiffness; /* times y, of size 1 */
    a[n] = 1.0;                                             /* u' = v */
    a[1] = -1.0;
    a[n + 1] = -d->retardation * viscous * omega / stiffness;
    for (size_t i = 0; i < d->branch_count; i++) {
        const int z = 2 + (int)i;
        const double share = d->branches[i].share * viscous / stiffness;
        a[1] -= share;
        a[z * n + 1] = share;
        a[z] = 1.0 / (d->branches[i].tau * omega);
        a[z * n + z] = -a[z];
    }
    if (port) {
        a[(n - 1) * n + 1] = push;
        a[n + n - 1] = -2.0 * e.push * voltage / e.capacitance;
        a[(n - 1) * n + n - 1] = -(1.0 / d->series + d->conductance) / (e.capacitance * omega);
    }
    assert_int_equal(dea_lapacke_dgeev(LAPACK_COL_MAJOR, 'N', 'N', n, a, n, real, imaginary, NULL, 1, NULL, 1), 0);
    double complex pair = 0.0;
    for (int i = 0; i < n; i++) {
        if (imaginary[i] > 1e-6) {
            assert_true(pair == 0.0); /* there is no other */
            pair = omega * (real[i] + imaginary[i] * I);
        }
    }
    return pair;
}

static void random_film(uint64_t *seed, dea_scene *scene)
{
    random_transient(seed, scene);
    dea_material *material = &scene->material;
    material->density = random_between(seed, 900.0, 1200.0);
    const double omega = 2.0 * DEA_PI * random_frequency(scene);
    material->retardation = random_chance(seed, 0.6) ? random_decades(seed, 1e-3, 10.0) / omega : (double)NAN;
    material->prony_count = (size_t)(8.0 * random_unit(seed));
    for (size_t i = 0; i < material->prony_count; i++) {
        material->prony[i] = (dea_prony){random_decades(seed, 1e-3, 0.12), random_decades(seed, 1e-3, 1e3) / omega};
    }
}

static void check_pair(dea_swing swing, double complex pair, int number)
{
    if (isnan(swing.frequency) != (pair == 0.0)) {
        fail_msg("film %d: swing at %g Hz, eigenvalue %g %+gi", number, swing.frequency, creal(pair), cimag(pair));
    }
    if (pair != 0.0) {
        assert_near(2.0 * DEA_PI * swing.frequency, cimag(pair), 1e-9 * cabs(pair));
        assert_near(swing.decay, -creal(pair), 1e-9 * cabs(pair));
    }
}

static void random_films_swing_as_their_eigenvalues_say(void **state)
{
    (void)state;
    int swinging = 0, overdamped = 0;
    for (int number = 0; number < 400; number++) {
        uint64_t seed = 104729u * (uint64_t)(number + 1);
        dea_scene scene;
        dea_dynamics dynamics;
        double u = 0.0, voltage = 0.0;
        random_film(&seed, &scene);
        const bool loaded = number % 3 == 0 && random_unit(&seed) < 0.9;
        scene.drive.series_resistance = loaded ? random_decades(&seed, 1e4, 1e8) : (double)NAN;
        open_dynamics(&scene, &dynamics);
        voltage = loaded ? 0.5 * pull_in_voltage(&scene, scene.models[0]->name) : 0.0;
        if (!(dea_dynamics_stiffness(&dynamics, 0.0, 0.0, true) > 0.0) || !dea_dynamics_equilibrium(&dynamics, voltage, &u)) {
            dea_dynamics_close(&dynamics);
            continue;
        }
        const dea_swing swing = dea_swing_of(&dynamics, u, voltage);
        check_pair(swing, eigenvalue_of(&dynamics, u, voltage), number);
        swinging += isnan(swing.frequency) ? 0 : 1;
        overdamped += isnan(swing.frequency) ? 1 : 0;
        dea_dynamics_close(&dynamics);
    }
    assert_true(swinging > 200 && overdamped > 25);
}

/* m s^2 + r s + K + sum k_i s/(s + q_i) in long double, over the sum of its parts. */
static double residual_of(dea_dynamics *d, long double complex s)
{
    const dea_edge e = dea_dynamics_edge(d, 0.0);
    const long double viscous = dea_edge_viscous(d, &e);
    long double complex sum = dea_dynamics_stiffness(d, 0.0, 0.0, true) + d->mass * s * s + d->retardation * viscous * s;
    long double parts = cabsl(d->mass * s * s) + cabsl(d->retardation * viscous * s) + cabsl(sum);
    for (size_t i = 0; i < d->branch_count; i++) {
        const long double complex part = viscous * d->branches[i].share * s / (s + 1.0L / d->branches[i].tau);
        sum += part;
        parts += cabsl(part);
    }
    return (double)(cabsl(sum) / parts);
}

/* Forty branches over thirty decades, where a matrix of them has no digits: a root it is. */
static void many_branches_of_any_time_leave_a_root(void **state)
{
    (void)state;
    for (int number = 0; number < 50; number++) {
        uint64_t seed = 15485863u * (uint64_t)(number + 1);
        dea_scene scene = heavy_scene(models[number % 3], DEA_DOT);
        dea_dynamics dynamics;
        scene.material.prony_count = DEA_PRONY_MAX;
        for (size_t i = 0; i < DEA_PRONY_MAX; i++) {
            scene.material.prony[i] = (dea_prony){random_decades(&seed, 1e-9, 0.02), random_decades(&seed, 1e-15, 1e15)};
        }
        open_dynamics(&scene, &dynamics);
        const dea_swing swing = dea_swing_of(&dynamics, 0.0, 0.0);
        assert_true(swing.frequency > 500.0 && swing.frequency < 2000.0 && swing.decay > 0.0);
        const double omega = 2.0 * DEA_PI * swing.frequency;
        assert_true(residual_of(&dynamics, -(long double)swing.decay + (long double)omega * I) < 1e-13);
        dea_dynamics_close(&dynamics);
    }
}

static dea_summary summary_by(const char *name, const dea_scene *scene, dea_sample *samples)
{
    const dea_engine *engine = dea_engine_find(name);
    dea_error error = {0};
    void *session = NULL;
    dea_summary summary = dea_summary_failed();
    if (engine->begin(&session, &error) != DEA_OK ||
        engine->transient(session, scene, scene->models[0], samples, &summary, &error) != DEA_OK) {
        fail_msg("%s: %s", name, error.message);
    }
    engine->end(session);
    return summary;
}

/* `direct` finds it among the modes of its closed form. */
static void the_closed_form_of_direct_agrees(void **state)
{
    (void)state;
    int seen = 0;
    for (int number = 0; number < 200; number++) {
        uint64_t seed = 32452843u * (uint64_t)(number + 1);
        dea_scene scene;
        random_film(&seed, &scene);
        if (dea_engine_refuses(dea_engine_find("direct"), &scene, scene.models[0])) {
            continue;
        }
        dea_sample *samples = malloc(dea_layout_of(&scene).point_size);
        assert_non_null(samples);
        const dea_summary summary = summary_by("direct", &scene, samples);
        const dea_swing swing = dea_swing_free(&scene, scene.models[0]);
        assert_true(isnan(summary.resonance) == isnan(swing.frequency));
        if (!isnan(swing.frequency)) {
            const double size = hypot(2.0 * DEA_PI * swing.frequency, swing.decay);
            assert_near(2.0 * DEA_PI * summary.resonance, 2.0 * DEA_PI * swing.frequency, 1e-10 * size);
            assert_near(summary.decay, swing.decay, 1e-10 * size);
            seen++;
        }
        free(samples);
    }
    assert_true(seen > 40);
}

/* Half periods and logarithmic decrement of the trace after it is switched off. */
static void the_film_is_seen_to_swing_so(void **state)
{
    (void)state;
    for (size_t i = 0; i < 3; i++) {
        dea_scene scene = heavy_scene(models[i], DEA_DOT);
        scene.material.prony[scene.material.prony_count++] = (dea_prony){i == 1 ? 0.02 : 0.5, i == 1 ? 3e-4 : 3e-6};
        scene.material.retardation = 2e-6;
        scene.drive.waveform.step = (dea_step){.on = 0.0, .off = 5e-3, .voltage = 30.0, .rise = 0.0};
        scene.transient = (dea_transient){.until = 0.025, .every = 1e-6};
        const size_t rows = dea_layout_of(&scene).rows;
        dea_sample *samples = malloc(dea_layout_of(&scene).point_size);
        assert_non_null(samples);
        summary_by("ida", &scene, samples);
        double tops[2] = {0.0, 0.0}, times[2] = {0.0, 0.0};
        int found = 0;
        for (size_t k = rows / 5 + 3000; k + 1 < rows && found < 4; k++) { /* from the first top to the third */
            const double before = samples[k].velocity, after = samples[k + 1].velocity;
            if (before > 0.0 && after <= 0.0) {
                tops[found > 0] = samples[k].displacement;
                times[found > 0] = samples[k].time + 1e-6 * before / (before - after);
                found++;
            }
        }
        const dea_swing swing = dea_swing_free(&scene, scene.models[0]);
        assert_int_equal(found, 4);
        assert_relative(swing.frequency, 3.0 / (times[1] - times[0]), 1e-4);
        assert_relative(swing.decay, log(tops[0] / tops[1]) / (times[1] - times[0]), 1e-2);
        free(samples);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_damper_slows_the_swing_and_ends_it_at_critical_damping),
        cmocka_unit_test(a_reduction_changes_no_swing),
        cmocka_unit_test(random_films_swing_as_their_eigenvalues_say),
        cmocka_unit_test(many_branches_of_any_time_leave_a_root),
        cmocka_unit_test(the_closed_form_of_direct_agrees),
        cmocka_unit_test(the_film_is_seen_to_swing_so),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
