/* Films in motion: closed forms, limits and balances that the engine `ida` must meet, and its own estimate against the truth. */
#include "random_transients.h"

#include <limits.h>

#include "engine/ida/flight.h"
#include "network/swing.h"

enum { MOST_SAMPLES = 20000 };

typedef struct run {
    dea_sample samples[MOST_SAMPLES];
    dea_summary summary;
    size_t count;
} run;

static run last, other; /* too large for a stack */

static void fly_by(const char *name, const dea_scene *scene, run *out)
{
    const dea_engine *engine = dea_engine_find(name);
    dea_error error = {0};
    void *session = NULL;
    out->count = dea_layout_of(scene).rows;
    assert_true(out->count <= MOST_SAMPLES);
    if (engine->begin(&session, &error) != DEA_OK ||
        engine->transient(session, scene, scene->models[0], out->samples, &out->summary, &error) != DEA_OK) {
        fail_msg("%s: %s", name, error.message);
    }
    engine->end(session);
}

static void fly(const dea_scene *scene)
{
    fly_by("ida", scene, &last);
}

/* Rows that hold numbers. */
static size_t good_rows(const run *of)
{
    size_t count = 0;
    while (count < of->count && !isnan(of->samples[count].displacement)) {
        count++;
    }
    return count;
}

static double peak_of(const run *of)
{
    double peak = 0.0;
    for (size_t i = 0; i < good_rows(of); i++) {
        peak = fmax(peak, fabs(of->samples[i].displacement));
    }
    return peak;
}

/* Largest difference of the displacements over their peak. */
static double distance(const run *a, const run *b)
{
    double largest = 0.0;
    for (size_t i = 0; i < good_rows(b); i++) {
        largest = fmax(largest, fabs(a->samples[i].displacement - b->samples[i].displacement));
    }
    return largest > 0.0 ? largest / peak_of(b) : 0.0;
}

/* The paper's film under a step of 4500 V. */
static dea_scene moving_scene(const char *model, dea_kind kind, double until, double rise)
{
    dea_scene scene = paper_scene(kind, 1.2, 0.5, (double)NAN);
    scene.models[0] = dea_model_find(model);
    scene.study = DEA_STUDY_TRANSIENT;
    scene.drive.waveform = (dea_waveform){
        .kind = DEA_WAVE_STEP, .step = {.off = (double)NAN, .voltage = 4500.0, .rise = rise}, .period = (double)NAN};
    scene.transient = (dea_transient){.until = until, .every = until / 200.0};
    return scene;
}

static double static_displacement(const dea_scene *scene)
{
    dea_scene still = *scene;
    still.drive.voltage = 4500.0;
    return solve_direct(&still, scene->models[0]->name).displacement;
}

/* Compares a run with a tighter or an exact one: equal states, error within the estimate, estimate within the accuracy. */
static void judge(int number, double accuracy)
{
    const double error = distance(&last, &other);
    const dea_state end = last.samples[last.count - 1].state;
    if (good_rows(&last) != good_rows(&other) || end != other.samples[other.count - 1].state) {
        fail_msg("scene %d: %zu and %zu rows, then %s", number, good_rows(&last), good_rows(&other), dea_state_name(end));
    }
    if (!(last.summary.error <= accuracy) || !(error <= last.summary.error + other.summary.error)) {
        fail_msg("scene %d: error %g, estimate %g, accuracy %g", number, error, last.summary.error, accuracy);
    }
    if (good_rows(&last) == last.count && !(last.summary.residual <= 10.0 * accuracy)) {
        fail_msg("scene %d: energies off by %g, accuracy %g", number, last.summary.residual, accuracy);
    }
}

static void the_estimate_bounds_the_error_of_random_films(void **state)
{
    (void)state;
    int exact = 0;
    for (int number = 0; number < 110; number++) {
        uint64_t seed = 7919u * (uint64_t)(number + 1);
        dea_scene scene;
        random_transient(&seed, &scene);
        const double accuracy = random_decades(&seed, 1e-8, 1e-3);
        scene.accuracy = accuracy;
        fly(&scene);
        scene.accuracy = fmax(1e-2 * accuracy, 1e-9);
        const bool closed = !dea_engine_refuses(dea_engine_find("direct"), &scene, scene.models[0]);
        fly_by(closed ? "direct" : "ida", &scene, &other);
        exact += closed ? 1 : 0;
        judge(number, accuracy);
    }
    assert_true(exact > 15);
}

/* Rest under a voltage, reached through damper, branches, mass and resistance, is the static answer. */
static void a_film_comes_to_rest_where_statics_says(void **state)
{
    (void)state;
    const char *const models[] = {"lumped", "lame", "coverage", "ring"};
    for (int i = 0; i < 16; i++) {
        dea_scene scene = moving_scene(models[i / 4], i % 2 ? DEA_LENS : DEA_DOT, 20.0, 1e-3);
        scene.material.density = i % 8 < 5 ? 1080.0 : (double)NAN;
        scene.material.retardation = i % 4 < 2 ? 1e-3 : (double)NAN;
        scene.material.prony_count = 2;
        scene.material.prony[0] = (dea_prony){.g = 0.2, .tau = 0.01};
        scene.material.prony[1] = (dea_prony){.g = 0.1, .tau = 0.5};
        scene.drive.series_resistance = i % 4 == 1 ? 1e7 : (double)NAN;
        fly(&scene);
        assert_relative(last.samples[last.count - 1].displacement, static_displacement(&scene), 1e-6);
        assert_near(last.samples[last.count - 1].velocity, 0.0, 1e-6 * peak_of(&last));
        assert_true(last.summary.residual <= 1e-5);
    }
}

/* A step on an undamped linear film: u = u_static (1 - cos omega t), for ever. */
static void an_undamped_film_rings_over_ten_thousand_periods(void **state)
{
    (void)state;
    dea_scene scene = moving_scene("lumped", DEA_DOT, 1.0, 0.0);
    scene.material.density = 1080.0;
    const double resonance = dea_swing_free(&scene, scene.models[0]).frequency;
    const double omega = 2.0 * DEA_PI * resonance;
    scene.transient.until = 1e4 / resonance;
    scene.transient.every = scene.transient.until / 9973.0;
    fly(&scene);
    const double rest = static_displacement(&scene);
    for (size_t i = 0; i < last.count; i++) {
        const dea_sample *s = &last.samples[i];
        assert_near(s->displacement, rest * (1.0 - cos(omega * s->time)), 2.0 * rest * scene.accuracy);
        assert_near(s->velocity, rest * omega * sin(omega * s->time), 2.0 * rest * omega * scene.accuracy);
    }
    assert_true(last.summary.dissipated == 0.0);
    assert_true(last.summary.residual <= 10.0 * scene.accuracy);
}

/* The largest displacement of a hyperelastic film that nothing damps is as large after a thousand periods as in the first ones.
 */
static void an_undamped_hyperelastic_film_keeps_its_amplitude(void **state)
{
    (void)state;
    dea_scene scene = moving_scene("coverage", DEA_DOT, 1.0, 0.0);
    double first = 0.0, late = 0.0;
    scene.material.density = 1080.0;
    scene.accuracy = 1e-5;
    scene.transient.every = 1.3e-4; /* about 8 samples a period, at all its phases */
    fly(&scene);
    for (size_t i = 0; i < 1000; i++) {
        first = fmax(first, last.samples[i].displacement);
        late = fmax(late, last.samples[last.count - 1 - i].displacement);
    }
    assert_relative(late, first, 1e-4);
    assert_true(last.summary.dissipated == 0.0);
    assert_true(last.summary.residual <= 10.0 * scene.accuracy);
}

static void a_tiny_mass_changes_nothing(void **state)
{
    (void)state;
    dea_scene scene = moving_scene("coverage", DEA_LENS, 0.5, 1e-2);
    scene.material.retardation = 5e-3;
    scene.material.prony_count = 1;
    scene.material.prony[0] = (dea_prony){.g = 0.2, .tau = 0.05};
    fly(&scene);
    other = last;
    scene.material.density = 1e-6;
    fly(&scene);
    assert_true(distance(&last, &other) <= 3.0 * scene.accuracy);
}

/* Without mass u = F/K [1 - c/(1 + c) e^(-t/((1 + c) tau))], c = g/(1 - g); the jump at t = 0 is in the first row. */
static void one_branch_creeps_as_its_closed_form(void **state)
{
    (void)state;
    const double g = 0.3, tau = 2.0;
    dea_scene scene = moving_scene("lumped", DEA_DOT, 20.0, 0.0);
    scene.material.prony_count = 1;
    scene.material.prony[0] = (dea_prony){.g = g, .tau = tau};
    fly(&scene);
    const double rest = static_displacement(&scene);
    const double rate = (1.0 - g) / tau;
    for (size_t i = 0; i < last.count; i++) {
        const double lag = g * exp(-rate * last.samples[i].time);
        assert_near(last.samples[i].displacement, rest * (1.0 - lag), rest * scene.accuracy);
        assert_near(last.samples[i].velocity, rest * rate * lag, rest * rate * scene.accuracy);
    }
}

/* A film that hardly moves is a capacitor: U = U_s (1 - e^(-t/RC)), with a leak both less and sooner. */
static void a_stiff_film_charges_through_its_resistance(void **state)
{
    (void)state;
    const double series = 1e7, leak = 4e7, full = 4500.0;
    dea_scene scene = moving_scene("lumped", DEA_DOT, 0.02, 0.0);
    dea_point point;
    dea_linear linear;
    scene.material.modulus = 1e15;
    scene.drive.series_resistance = series;
    scene.drive.leakage_resistance = leak;
    dea_film_prepare(&scene, &point.film);
    dea_point_place(&scene, &point);
    scene.models[0]->linear(&point, &linear);
    fly(&scene);
    const double kept = leak / (series + leak);
    for (size_t i = 0; i < last.count; i++) {
        const double decay = exp(-last.samples[i].time / (kept * series * linear.capacitance[0]));
        const double voltage = kept * full * (1.0 - decay);
        assert_near(last.samples[i].charge, linear.capacitance[0] * voltage, linear.capacitance[0] * full * scene.accuracy);
        assert_near(last.samples[i].current, (full - voltage) / series, full / series * scene.accuracy);
    }
    assert_true(last.summary.residual <= 10.0 * scene.accuracy);
}

/* u goes with U^2, which stays a ten-thousandth of the source's: the answer is small, its digits are not. */
static void a_film_that_hardly_charges_keeps_its_digits(void **state)
{
    (void)state;
    dea_scene scene = moving_scene("lumped", DEA_DOT, 0.02, 0.0);
    dea_point point;
    dea_linear linear;
    dea_film_prepare(&scene, &point.film);
    dea_point_place(&scene, &point);
    scene.models[0]->linear(&point, &linear);
    const double time = 200.0;
    scene.drive.series_resistance = time / linear.capacitance[0];
    const double full = static_displacement(&scene);
    fly(&scene);
    assert_int_equal(good_rows(&last), last.count);
    const double most = full * pow(expm1(-scene.transient.until / time), 2.0);
    for (size_t i = 0; i < last.count; i++) {
        const double wanted = full * pow(expm1(-last.samples[i].time / time), 2.0);
        assert_near(last.samples[i].displacement, wanted, scene.accuracy * most);
    }
}

/* A branch of less than a millisecond under what takes hours hardly changes u': it is one damper more. Told by (S - z)/tau, what it leaves of
 * u' is rounding. Without it the others have g/(1 - g_fast), so that c = g/(1 - sum g) stays. */
static void a_velocity_behind_a_slow_charge_keeps_its_promise(void **state)
{
    (void)state;
    static const double g[] = {0.08, 0.05, 0.1}, tau[] = {580.0, 1.6e5, 12.0}, fast = 0.05;
    static const double fastest[] = {1e-4, 4e-6, 1e-7, 1e-9}, accuracies[] = {1e-3, 1e-6, 1e-8};
    dea_scene scene = moving_scene("lumped", DEA_LENS, 28504.0, 0.0);
    scene.material.instantaneous = false;
    scene.drive.series_resistance = 1e14;
    scene.drive.waveform.kind = DEA_WAVE_SINE;
    scene.drive.waveform.sine = (dea_sine){.offset = 4000.0, .amplitude = 2000.0, .frequency = 5.68e-5, .phase = 1.3};
    scene.material.prony_count = 3;
    for (size_t i = 0; i < 3; i++) {
        scene.material.prony[i] = (dea_prony){.g = g[i] / (1.0 - fast), .tau = tau[i]};
    }
    scene.accuracy = 1e-9;
    fly_by("ida", &scene, &other);
    double peak = 0.0;
    for (size_t i = 0; i < other.count; i++) {
        peak = fmax(peak, fabs(other.samples[i].velocity));
    }
    for (size_t i = 0; i < 3; i++) {
        scene.material.prony[i].g = g[i];
    }
    scene.material.prony_count = 4;
    for (int k = 0; k < 12; k++) {
        scene.material.prony[3] = (dea_prony){.g = fast, .tau = fastest[k / 3]};
        scene.accuracy = accuracies[k % 3];
        fly(&scene);
        assert_int_equal(good_rows(&last), last.count);
        assert_true(last.summary.velocity_error <= 10.0 * scene.accuracy);
        for (size_t i = 0; i < last.count; i++) {
            const double told = last.summary.velocity_error + other.summary.velocity_error;
            assert_near(last.samples[i].velocity, other.samples[i].velocity, told * peak);
        }
    }
}

static void a_ring_of_too_many_steps_says_so(void **state)
{
    (void)state;
    dea_scene scene = moving_scene("coverage", DEA_LENS, 1e5, 0.0);
    const dea_engine *engine = dea_engine_find("ida");
    dea_error error = {0};
    void *session = NULL;
    scene.material.density = 1080.0;
    assert_int_equal(engine->begin(&session, &error), DEA_OK);
    assert_int_equal(engine->transient(session, &scene, scene.models[0], last.samples, &last.summary, &error), DEA_OK);
    engine->end(session);
    last.count = dea_layout_of(&scene).rows;
    assert_int_equal(last.samples[last.count - 1].state, DEA_STATE_FAILED);
    assert_non_null(strstr(error.message, "steps"));
}

/* An undamped film that bounces off its narrow annulus: what one tolerance is off by, the next is off by too. */
static void a_film_that_bounces_keeps_its_accuracy(void **state)
{
    (void)state;
    dea_scene scene = moving_scene("coverage", DEA_DOT, 0.0016988110582901819, 0.0);
    scene.actuator = (dea_actuator){.kind = DEA_DOT,
                                    .frame_radius = 0.0013793006894120407,
                                    .coverage = 0.90996361472559584,
                                    .divide_radius = (double)NAN,
                                    .film_thickness = 0.00020965386804276223,
                                    .prestretch = 1.0725777575308943,
                                    .layers = 1.0,
                                    .electrode_mass = (double)NAN,
                                    .focal_length = (double)NAN,
                                    .refractive_index = (double)NAN};
    scene.material.constants[0] = 166711.18693636474;
    scene.material.constants[1] = 8244.6926419412848;
    scene.material.constants[2] = 0.0;
    scene.material.permittivity = 3.142503678239164;
    scene.material.density = 1156.4860494269196;
    scene.drive.waveform.step.on = 0.00049864304210081958;
    scene.drive.waveform.step.off = 0.0012366720119295713;
    scene.drive.waveform.step.voltage = 46386.506593988168;
    scene.transient.every = 0.1 * scene.transient.until;
    scene.accuracy = 1e-7;
    fly(&scene);
    other = last;
    scene.accuracy = 1e-6;
    fly(&scene);
    assert_true(distance(&last, &other) <= 0.5e-6);
}

/* A film without mass and branches follows its voltage through the equilibria, up to the fold. */
static void a_film_that_pulls_in_keeps_the_rows_before(void **state)
{
    (void)state;
    dea_scene scene = moving_scene("coverage", DEA_DOT, 1.0, 1.0);
    scene.actuator.coverage = 0.1;
    scene.material.constants[1] = scene.material.constants[2] = 0.0;
    const double fold = pull_in_voltage(&scene, "coverage");
    scene.drive.waveform.step.voltage = 1.5 * fold;
    fly(&scene);
    const size_t good = good_rows(&last);
    assert_int_equal(good, (size_t)ceil((double)(last.count - 1) / 1.5 * 0.9999));
    for (size_t i = 0; i < last.count; i++) {
        dea_scene still = scene;
        still.drive.voltage = 1.5 * fold * last.samples[i].time;
        assert_relative(last.samples[i].voltage, still.drive.voltage, 1e-14);
        if (i < good) {
            assert_near(last.samples[i].displacement, solve_direct(&still, "coverage").displacement, 1e-6 * peak_of(&last));
        } else {
            assert_int_equal(last.samples[i].state, DEA_STATE_PULL_IN);
            assert_true(isnan(last.samples[i].displacement));
        }
    }
}

/* A film at its bias begins at rest, to the last digit, however fast a branch or a damper would turn what rounding leaves of its
 * forces into a velocity; where nothing holds it, it begins with that of its springs, those of the branches too. */
static void a_film_at_its_bias_begins_with_its_own_velocity(void **state)
{
    (void)state;
    double times[] = {0.0, 1.0, 2.0}, volts[] = {3000.0, 3000.0, 4000.0};
    for (int sloped = 0; sloped < 2; sloped++) {
        for (int damped = 0; damped < 2; damped++) {
            dea_scene scene = moving_scene("lame", DEA_LENS, 2.0, 0.0);
            scene.material.prony_count = 1;
            scene.material.prony[0] = (dea_prony){.g = 0.2, .tau = 1e-6};
            scene.material.retardation = damped ? 1e-6 : (double)NAN;
            volts[1] = sloped ? 3500.0 : 3000.0;
            scene.drive.waveform = (dea_waveform){
                .kind = DEA_WAVE_POINTS, .point_count = 3, .times = times, .voltages = volts, .period = (double)NAN};
            scene.transient.from_bias = true;
            fly(&scene);
            dea_scene still = scene;
            still.drive.voltage = 3001.0;
            const double more = solve_direct(&still, "lame").displacement;
            still.drive.voltage = 2999.0;
            const double rise = 0.5 * (more - solve_direct(&still, "lame").displacement); /* du/dU of the relaxed film */
            const double v = last.samples[0].velocity;
            if (sloped && !damped) {
                assert_true(v / (500.0 * rise) > 0.75 && v / (500.0 * rise) < 0.85); /* 1 - g, and a little softening */
            } else {
                assert_true(v == 0.0);
            }
        }
    }
}

/* Rows at the time of an edge show what was before it; the first row shows what is behind an edge at its time. */
static void an_edge_shows_behind_its_row(void **state)
{
    (void)state;
    dea_scene scene = moving_scene("coverage", DEA_DOT, 1.0, 0.0);
    scene.drive.waveform.step.off = 0.5;
    scene.transient.every = 0.25;
    fly(&scene);
    const double rest = static_displacement(&scene);
    const double wanted[] = {rest, rest, rest, 0.0, 0.0};
    assert_int_equal(last.count, 5);
    for (size_t i = 0; i < 5; i++) {
        assert_near(last.samples[i].displacement, wanted[i], 1e-9 * rest);
        assert_near(last.samples[i].voltage, wanted[i] > 0.0 ? 4500.0 : 0.0, 1e-9);
    }
    assert_true(last.summary.residual <= 1e-9);
}

static void a_film_at_its_bias_stays_there(void **state)
{
    (void)state;
    for (int i = 0; i < 4; i++) {
        dea_scene scene = moving_scene("coverage", i % 2 ? DEA_LENS : DEA_DOT, 5.0, 0.0);
        scene.transient.from_bias = true;
        scene.material.density = i < 2 ? 1080.0 : (double)NAN;
        scene.material.prony_count = 1;
        scene.material.prony[0] = (dea_prony){.g = 0.3, .tau = 1.0};
        fly(&scene);
        for (size_t k = 0; k < last.count; k++) {
            assert_relative(last.samples[k].displacement, static_displacement(&scene), 1e-9);
        }
    }
}

/* Late in a run, an edge of a microsecond is as good as a jump to a film that creeps over hours. */
static void a_short_edge_late_in_a_run_keeps_its_digits(void **state)
{
    (void)state;
    dea_scene scene = moving_scene("coverage", DEA_DOT, 2e5, 0.0);
    scene.drive.waveform.step.on = 1e5;
    scene.material.prony_count = 1;
    scene.material.prony[0] = (dea_prony){.g = 0.3, .tau = 1e4};
    fly(&scene);
    other = last;
    scene.drive.waveform.step.rise = 1e-6;
    fly(&scene);
    assert_true(distance(&last, &other) <= 2.0 * scene.accuracy);
}

/* In a film that is not linear an explicit method carries the ring and BDF what is left of it; the creep behind it is that of a
 * film without mass. */
static void the_creep_behind_a_ring_is_that_of_a_film_without_mass(void **state)
{
    (void)state;
    dea_scene scene = moving_scene("coverage", DEA_DOT, 40.0, 0.0);
    scene.material.prony_count = 2;
    scene.material.prony[0] = (dea_prony){.g = 0.2, .tau = 1e-3};
    scene.material.prony[1] = (dea_prony){.g = 0.2, .tau = 10.0};
    fly(&scene);
    other = last;
    scene.material.density = 1080.0;
    fly(&scene);
    for (size_t i = 10; i < last.count; i++) {
        assert_near(last.samples[i].displacement, other.samples[i].displacement, 2e-6 * peak_of(&other));
    }
    assert_true(last.summary.residual <= 10.0 * scene.accuracy);
}

/* Largest difference between the Jacobian and central differences of the rates at y, over the largest of its column. */
static double jacobian_error(const dea_motion *motion, const double *y)
{
    static double jacobian[DEA_MOTION_MOST * DEA_MOTION_MOST];
    const int n = motion->count;
    double worst = 0.0;
    dea_motion_jacobian(motion, 0.0, y, jacobian);
    for (int k = 0; k < n; k++) {
        double moved[DEA_MOTION_MOST], up[DEA_MOTION_MOST], down[DEA_MOTION_MOST];
        double error = 0.0, largest = 0.0;
        memcpy(moved, y, sizeof moved);
        moved[k] = y[k] + 1e-5;
        assert_true(dea_motion_rates(motion, 0.0, moved, up));
        moved[k] = y[k] - 1e-5;
        assert_true(dea_motion_rates(motion, 0.0, moved, down));
        for (int i = 0; i < n; i++) {
            const double slope = (up[i] - down[i]) / 2e-5;
            error = fmax(error, fabs(jacobian[k * n + i] - slope));
            largest = fmax(largest, fabs(slope));
        }
        worst = fmax(worst, largest > 0.0 ? error / largest : 0.0);
    }
    return worst;
}

/* But for the second derivative of the stress in the damper's force, which is left out. */
static void the_jacobian_is_the_slope_of_the_rates(void **state)
{
    (void)state;
    for (int number = 0; number < 100; number++) {
        uint64_t seed = 104729u * (uint64_t)(number + 1);
        dea_scene scene;
        dea_dynamics dynamics;
        dea_signal signal;
        dea_motion motion;
        dea_error error = {0};
        double y[DEA_MOTION_MOST] = {0.0};
        random_transient(&seed, &scene);
        if (!scene.models[0]->linear) {
            scene.material.retardation = (double)NAN;
        }
        assert_int_equal(dea_dynamics_open(&scene, scene.models[0], &dynamics, &error), DEA_OK);
        assert_int_equal(dea_signal_open(&scene, &signal, &error), DEA_OK);
        dea_motion_open(&dynamics, &signal, &motion);
        for (int i = 0; i < motion.count; i++) {
            y[i] = random_between(&seed, 0.1, 0.5);
        }
        const double worst = jacobian_error(&motion, y);
        if (!(worst <= 1e-6)) {
            fail_msg("scene %d: %g", number, worst);
        }
        dea_signal_close(&signal);
        dea_dynamics_close(&dynamics);
    }
}

/* A linear film that rings under a slow ramp, 12 samples a period: the steps of the explicit method end at samples whatever the
 * tolerance. */
static void samples_that_cut_all_steps_hide_no_error(void **state)
{
    (void)state;
    double times[] = {0.0, 1.0}, voltages[] = {1000.0, 4000.0};
    dea_scene scene = moving_scene("lumped", DEA_DOT, 1e-3, 0.0);
    scene.material.density = 1080.0;
    scene.accuracy = 1e-3;
    const double period = 1.0 / dea_swing_free(&scene, scene.models[0]).frequency;
    scene.transient = (dea_transient){.until = 1600.0 * period, .every = period / 12.0};
    times[1] = scene.transient.until;
    scene.drive.waveform =
        (dea_waveform){.kind = DEA_WAVE_POINTS, .times = times, .voltages = voltages, .point_count = 2, .period = (double)NAN};
    fly(&scene);
    fly_by("direct", &scene, &other);
    judge(0, scene.accuracy);
}

/* A ring of 100 periods behind a resistance over which the film charges within a thousandth of a sample: the resistance damps it.
 */
static void a_small_resistance_damps_a_ring(void **state)
{
    (void)state;
    dea_scene scene = moving_scene("lumped", DEA_DOT, 6e-3, 8e-5);
    scene.actuator = (dea_actuator){.kind = DEA_DOT,
                                    .frame_radius = 1.5472e-3,
                                    .coverage = 0.92522,
                                    .divide_radius = (double)NAN,
                                    .film_thickness = 3.0533e-4,
                                    .prestretch = 1.05,
                                    .layers = 1.0,
                                    .electrode_mass = (double)NAN,
                                    .focal_length = (double)NAN,
                                    .refractive_index = (double)NAN};
    scene.material.constants[0] = 52955.9;
    scene.material.constants[1] = 3822.66;
    scene.material.constants[2] = 0.0;
    scene.material.permittivity = 3.3864;
    scene.material.density = 1130.0;
    scene.drive.series_resistance = 97e3;
    scene.drive.waveform.step.voltage = 23697.0;
    scene.transient.every = 4.3e-5;
    scene.accuracy = 1e-6;
    fly(&scene);
    other = last;
    scene.accuracy = 1e-2;
    fly(&scene);
    judge(0, scene.accuracy);
}

static void more_digits_than_it_has_are_refused(void **state)
{
    (void)state;
    dea_scene scene = moving_scene("lumped", DEA_DOT, 1.0, 0.0);
    const dea_engine *engine = dea_engine_find("ida");
    assert_null(dea_engine_refuses(engine, &scene, scene.models[0]));
    scene.accuracy = 1e-10;
    assert_non_null(dea_engine_refuses(engine, &scene, scene.models[0]));
}

/* Steps of one run of a hyperelastic film that rings at 716 Hz for a tenth of a second within a creep of 25 s. */
static long steps_at(double tolerance)
{
    static dea_moment moments[MOST_SAMPLES];
    dea_error error = {0};
    dea_scene scene;
    dea_dynamics dynamics;
    dea_signal signal;
    dea_flight flight;
    dea_sundials sundials;
    dea_trace trace = {.moments = moments};
    assert_int_equal(dea_scene_read("examples/work-precision.yaml", NULL, 0, "coverage", &scene, &error), DEA_OK);
    assert_int_equal(dea_sundials_open(&sundials, &error), DEA_OK);
    assert_int_equal(dea_dynamics_open(&scene, scene.models[0], &dynamics, &error), DEA_OK);
    assert_int_equal(dea_signal_open(&scene, &signal, &error), DEA_OK);
    assert_int_equal(dea_flight_open(&sundials, &scene, &dynamics, &signal, &flight, &error), DEA_OK);
    dea_flight_run(&flight, tolerance, &trace, NULL);
    const long steps = trace.count == flight.rows ? flight.steps : LONG_MAX;
    dea_flight_close(&flight);
    dea_signal_close(&signal);
    dea_dynamics_close(&dynamics);
    dea_sundials_close(&sundials);
    dea_scene_free(&scene);
    return steps;
}

/* A step a radian would be 110,000 steps. */
static void the_tail_of_a_ring_does_not_set_the_steps_behind_it(void **state)
{
    (void)state;
    assert_true(steps_at(1e-5) < 5000);
    assert_true(steps_at(1e-7) < 10000);
    assert_true(steps_at(1e-9) < 25000);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(the_estimate_bounds_the_error_of_random_films),
        cmocka_unit_test(a_film_comes_to_rest_where_statics_says),
        cmocka_unit_test(an_undamped_film_rings_over_ten_thousand_periods),
        cmocka_unit_test(an_undamped_hyperelastic_film_keeps_its_amplitude),
        cmocka_unit_test(a_tiny_mass_changes_nothing),
        cmocka_unit_test(one_branch_creeps_as_its_closed_form),
        cmocka_unit_test(a_stiff_film_charges_through_its_resistance),
        cmocka_unit_test(a_film_that_hardly_charges_keeps_its_digits),
        cmocka_unit_test(a_velocity_behind_a_slow_charge_keeps_its_promise),
        cmocka_unit_test(a_ring_of_too_many_steps_says_so),
        cmocka_unit_test(a_film_that_bounces_keeps_its_accuracy),
        cmocka_unit_test(a_film_that_pulls_in_keeps_the_rows_before),
        cmocka_unit_test(a_film_at_its_bias_begins_with_its_own_velocity),
        cmocka_unit_test(an_edge_shows_behind_its_row),
        cmocka_unit_test(a_film_at_its_bias_stays_there),
        cmocka_unit_test(a_short_edge_late_in_a_run_keeps_its_digits),
        cmocka_unit_test(the_creep_behind_a_ring_is_that_of_a_film_without_mass),
        cmocka_unit_test(the_tail_of_a_ring_does_not_set_the_steps_behind_it),
        cmocka_unit_test(the_jacobian_is_the_slope_of_the_rates),
        cmocka_unit_test(samples_that_cut_all_steps_hide_no_error),
        cmocka_unit_test(a_small_resistance_damps_a_ring),
        cmocka_unit_test(more_digits_than_it_has_are_refused),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
