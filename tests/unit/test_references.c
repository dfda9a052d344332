/* Every engine against references made elsewhere: tests/peers/transient_scipy.py solves the same scenes from the equations alone.
 */
#include "scenes.h"

#include <complex.h>
#include <stdlib.h>

#include "references.h"

enum { MOST_BRANCHES = 3 };

/* What differs from the base film; 0 where a scene leaves the base as it is. */
typedef struct moving_film {
    const char *name, *model;
    dea_kind kind;
    double coverage, prestretch;                     /* 0.5, 1.2 */
    double permittivity, permittivity_slope;         /* 2.8, 0 */
    double modulus, density, electrode, retardation; /* none */
    double series, leakage;                          /* none */
    dea_prony prony[MOST_BRANCHES];
    bool instantaneous, from_bias;
    dea_waveform wave;
    double until, every;
} moving_film;

static double ramp_times[] = {2e-3, 5e-3, 12e-3, 12.5e-3}, ramp_voltages[] = {0.0, 4000.0, 2000.0, 3000.0};
static double pulse_times[] = {0.0, 0.05, 0.2, 0.21}, pulse_voltages[] = {0.0, 4000.0, 4000.0, 0.0};
static double fall_times[] = {0.1, 0.2}, fall_voltages[] = {3500.0, 1000.0};
static double rise_times[] = {0.0, 5e-3, 5.5e-3}, rise_voltages[] = {3000.0, 3000.0, 4200.0};

#define ONCE .period = (double)NAN
#define STEP(on, off, voltage, rise)                                                                                             \
    {                                                                                                                            \
        .kind = DEA_WAVE_STEP, .step = {on, off, voltage, rise}, ONCE                                                            \
    }
#define NEVER (double)NAN
#define SINE(offset, amplitude, frequency, phase, delay)                                                                         \
    {                                                                                                                            \
        .kind = DEA_WAVE_SINE, .sine = {offset, amplitude, frequency, phase, delay}, ONCE                                        \
    }
#define POINTS(t, v, again)                                                                                                      \
    {                                                                                                                            \
        .kind = DEA_WAVE_POINTS, .times = t, .voltages = v, .point_count = sizeof(t) / sizeof *(t), again                        \
    }
#define PAPER_BRANCHES                                                                                                           \
    {                                                                                                                            \
        {0.1, 0.03}, {0.1, 0.3},                                                                                                 \
        {                                                                                                                        \
            0.05, 3.0                                                                                                            \
        }                                                                                                                        \
    }

/* The scenes of the script, in its order. */
static const moving_film setups[] = {
    {.name = "lumped_dot_ringing",
     .model = "lumped",
     .density = 1080.0,
     .retardation = 2e-5,
     .wave = STEP(1e-3, 11e-3, 4500.0, 1e-6),
     .until = 0.02,
     .every = 1e-4},
    {.name = "lumped_dot_protocol",
     .model = "lumped",
     .prony = PAPER_BRANCHES,
     .wave = STEP(5.0, 15.0, 4500.0, 1e-6),
     .until = 25.0,
     .every = 0.01},
    {.name = "lumped_dot_jump",
     .model = "lumped",
     .retardation = 0.05,
     .leakage = 1e10,
     .wave = STEP(0.3, 0.7, 3000.0, 0.0),
     .until = 1.0,
     .every = 0.1},
    {.name = "lumped_lens_quasistatic",
     .model = "lumped",
     .kind = DEA_LENS,
     .coverage = 0.4,
     .prestretch = 1.1,
     .permittivity = 2.76,
     .permittivity_slope = -0.28,
     .modulus = 1.2e6,
     .wave = SINE(2000.0, 1500.0, 2.0, 0.5, 0.1),
     .until = 1.0,
     .every = 0.01},
    {.name = "lame_dot_instantaneous",
     .model = "lame",
     .coverage = 0.25,
     .prestretch = 1.1,
     .density = 1080.0,
     .electrode = 0.025,
     .retardation = 5e-5,
     .instantaneous = true,
     .prony = {{0.2, 0.002}, {0.1, 0.05}},
     .wave = STEP(1e-3, 21e-3, 3500.0, 1e-4),
     .until = 0.04,
     .every = 1e-4},
    {.name = "lame_lens_points",
     .model = "lame",
     .kind = DEA_LENS,
     .coverage = 0.4,
     .density = 1000.0,
     .electrode = 0.02,
     .prony = {{0.3, 0.004}},
     .wave = POINTS(ramp_times, ramp_voltages, ONCE),
     .until = 0.025,
     .every = 1e-4},
    {.name = "coverage_dot_sine",
     .model = "coverage",
     .coverage = 0.6,
     .density = 1080.0,
     .retardation = 3e-5,
     .prony = {{0.2, 0.01}},
     .wave = SINE(2500.0, 1500.0, 310.0, 0.0, 1e-3),
     .from_bias = true,
     .until = 0.02,
     .every = 1e-4},
    {.name = "coverage_lens_ringing",
     .model = "coverage",
     .kind = DEA_LENS,
     .prestretch = 1.3,
     .density = 1000.0,
     .electrode = 0.025,
     .retardation = 2e-5,
     .prony = {{0.1, 0.003}, {0.2, 0.1}},
     .wave = STEP(1e-3, NEVER, 4500.0, 1e-6),
     .until = 0.02,
     .every = 1e-4},
    {.name = "lumped_dot_port",
     .model = "lumped",
     .density = 1080.0,
     .retardation = 2e-5,
     .series = 1e6,
     .leakage = 1e11,
     .wave = STEP(1e-3, 11e-3, 4500.0, 1e-6),
     .until = 0.02,
     .every = 1e-4},
    {.name = "lame_lens_leaky",
     .model = "lame",
     .kind = DEA_LENS,
     .coverage = 0.7,
     .retardation = 2e-3,
     .series = 2e6,
     .leakage = 1e8,
     .wave = STEP(0.0, 20e-3, 4000.0, 1e-3),
     .until = 0.04,
     .every = 1e-4},
    {.name = "coverage_dot_creeping_port",
     .model = "coverage",
     .coverage = 0.3,
     .prony = {{0.2, 0.05}, {0.15, 0.5}},
     .series = 5e7,
     .leakage = 2e9,
     .wave = SINE(2000.0, 1500.0, 10.0, 0.3, 0.05),
     .from_bias = true,
     .until = 0.5,
     .every = 1e-3},
    {.name = "coverage_lens_port",
     .model = "coverage",
     .kind = DEA_LENS,
     .prestretch = 1.1,
     .density = 1080.0,
     .electrode = 0.025,
     .retardation = 1e-4,
     .series = 1e6,
     .prony = {{0.15, 0.02}},
     .wave = STEP(1e-3, 11e-3, 4000.0, 1e-5),
     .until = 0.02,
     .every = 1e-4},
    {.name = "coverage_dot_leakage",
     .model = "coverage",
     .prestretch = 1.3,
     .density = 1080.0,
     .retardation = 5e-5,
     .leakage = 1e9,
     .wave = SINE(1500.0, 1000.0, 120.0, 0.0, 0.0),
     .from_bias = true,
     .until = 0.03,
     .every = 1e-4},
    {.name = "coverage_dot_pulses",
     .model = "coverage",
     .coverage = 0.75,
     .retardation = 0.02,
     .prony = {{0.25, 0.2}},
     .wave = POINTS(pulse_times, pulse_voltages, .period = 0.4),
     .until = 1.0,
     .every = 0.01},
    {.name = "lame_dot_port",
     .model = "lame",
     .coverage = 0.6,
     .density = 1080.0,
     .retardation = 1e-5,
     .series = 3e5,
     .prony = PAPER_BRANCHES,
     .wave = POINTS(rise_times, rise_voltages, ONCE),
     .from_bias = true,
     .until = 0.02,
     .every = 1e-4},
    {.name = "lame_dot_from_rest",
     .model = "lame",
     .coverage = 0.4,
     .prestretch = 1.3,
     .density = 1080.0,
     .retardation = 5e-5,
     .series = 4e5,
     .leakage = 1e10,
     .wave = SINE(3000.0, 800.0, 150.0, 0.7, 0.0),
     .until = 0.02,
     .every = 1e-4},
    {.name = "coverage_lens_from_rest",
     .model = "coverage",
     .kind = DEA_LENS,
     .coverage = 0.6,
     .prony = {{0.3, 0.02}, {0.1, 0.2}},
     .leakage = 1e9,
     .wave = POINTS(fall_times, fall_voltages, ONCE),
     .until = 0.4,
     .every = 1e-3},
};

enum { SCENES = sizeof setups / sizeof *setups };

/* Accuracy that an engine is asked for, what it reaches within the time of a test, and how many of the transients it takes. */
typedef struct wanted {
    const char *engine;
    double accuracy;
    size_t transients;
} wanted;

static const wanted engines[] = {{"direct", 1e-9, 4}, {"ida", 1e-7, SCENES}, {"ngspice", 1e-4, SCENES}};

static double or_none(double value)
{
    return value > 0.0 ? value : (double)NAN;
}

static dea_scene scene_of(const moving_film *setup, double accuracy)
{
    dea_scene scene = paper_scene(setup->kind, setup->prestretch > 0.0 ? setup->prestretch : 1.2,
                                  setup->coverage > 0.0 ? setup->coverage : 0.5, (double)NAN);
    dea_material *material = &scene.material;
    scene.actuator.electrode_mass = or_none(setup->electrode);
    material->permittivity = setup->permittivity > 0.0 ? setup->permittivity : 2.8;
    material->permittivity_per_stretch = setup->permittivity_slope;
    material->modulus = or_none(setup->modulus);
    material->density = or_none(setup->density);
    material->retardation = or_none(setup->retardation);
    material->instantaneous = setup->instantaneous;
    while (material->prony_count < MOST_BRANCHES && setup->prony[material->prony_count].g > 0.0) {
        material->prony[material->prony_count] = setup->prony[material->prony_count];
        material->prony_count++;
    }
    scene.drive.series_resistance = or_none(setup->series);
    scene.drive.leakage_resistance = or_none(setup->leakage);
    scene.drive.waveform = setup->wave;
    scene.models[0] = dea_model_find(setup->model);
    scene.accuracy = accuracy;
    scene.study = DEA_STUDY_TRANSIENT;
    scene.transient = (dea_transient){.until = setup->until, .every = setup->every, .from_bias = setup->from_bias};
    return scene;
}

/* Copy of the one point that a study delivers. */
typedef struct heard {
    size_t size;
    unsigned char *point;
} heard;

static dea_status hear(void *user, size_t first, const void *points, size_t count, dea_error *error)
{
    heard *listener = user;
    (void)error;
    assert_true(first == 0 && count == 1);
    memcpy(listener->point, points, listener->size);
    return DEA_OK;
}

static void tell(void *user, const char *line)
{
    (void)user;
    print_error("%s\n", line);
}

/* The point of a study, freed by the caller; NULL where the engine refuses it. */
static unsigned char *run(const dea_scene *scene, const dea_engine *engine, const char *name)
{
    if (dea_engine_refuses(engine, scene, scene->models[0])) {
        return NULL;
    }
    const dea_layout layout = dea_layout_of(scene);
    dea_error error = {0};
    heard listener = {layout.point_size, calloc(1, layout.point_size)};
    assert_non_null(listener.point);
    const dea_run_options options = {.jobs = 1, .points = hear, .log = tell, .user = &listener};
    if (dea_study_run(scene, engine, &options, &error) != DEA_OK) {
        print_error("%s by %s: %s\n", name, engine->name, error.message);
        fail();
    }
    return listener.point;
}

/* Largest differences of one run, relative to the peaks: of the displacement, and of velocity, charge and current. */
typedef struct difference {
    double displacement, others;
} difference;

static double larger(double a, double b)
{
    return b <= a ? a : isnan(b) ? INFINITY : b;
}

static void compare(const known_run *reference, const dea_sample *samples, bool port, difference *most)
{
    for (size_t i = 0; i < reference->count; i++) {
        const known_row *row = &reference->rows[i];
        const dea_sample *sample = &samples[row->sample];
        const double values[] = {sample->displacement, sample->velocity, sample->charge, sample->current};
        most->displacement = larger(most->displacement, fabs(values[0] - row->values[0]) / reference->peak[0]);
        for (int k = 1; k < (port ? 4 : 2); k++) {
            most->others = larger(most->others, fabs(values[k] - row->values[k]) / reference->peak[k]);
        }
    }
}

/* Without series resistance the source charges the film at once: what it puts in then is another matter. */
static bool work_agrees(const known_run *reference, const dea_summary *summary, double accuracy)
{
    const double off = fabs(summary->work / reference->work - 1.0);
    if (!(off <= 100.0 * accuracy)) {
        print_error("  work %.17g J, wanted %.17g, off by %.2e\n", summary->work, reference->work, off);
        return false;
    }
    return true;
}

/* The displacement is as good as asked for, the others within ten times of it. */
static bool transient_agrees(const moving_film *setup, const known_run *reference, const wanted *by, size_t *runs)
{
    const dea_scene scene = scene_of(setup, by->accuracy);
    const dea_layout layout = dea_layout_of(&scene);
    unsigned char *point = run(&scene, dea_engine_find(by->engine), setup->name);
    if (!point) {
        return true;
    }
    const dea_sample *samples = (const dea_sample *)(const void *)point;
    difference most = {0.0, 0.0};
    compare(reference, samples, setup->series + setup->leakage > 0.0, &most);
    bool right = most.displacement <= by->accuracy + reference->error && most.others <= 10.0 * by->accuracy + reference->error;
    print_message("%s by %s: displacement off by %.1e, others %.1e, energy %.1e, at the end %s\n", setup->name, by->engine,
                  most.displacement, most.others, dea_layout_summary(&layout, point)->residual,
                  dea_state_name(samples[layout.rows - 1].state));
    right = dea_layout_summary(&layout, point)->residual <= 100.0 * by->accuracy && right;
    if (setup->series > 0.0) {
        right = work_agrees(reference, dea_layout_summary(&layout, point), by->accuracy) && right;
    }
    free(point);
    ++*runs;
    return right;
}

static void all_transients_agree(const wanted *by)
{
    size_t wrong = 0, runs = 0;
    for (size_t i = 0; i < SCENES; i++) {
        assert_string_equal(setups[i].name, references[i].name);
        wrong += transient_agrees(&setups[i], &references[i], by, &runs) ? 0 : 1;
    }
    assert_int_equal(wrong, 0);
    assert_true(runs >= by->transients);
}

static void direct_follows_the_equations_in_time(void **state)
{
    (void)state;
    all_transients_agree(&engines[0]);
}

static void ida_follows_the_equations_in_time(void **state)
{
    (void)state;
    all_transients_agree(&engines[1]);
}

static void ngspice_follows_the_equations_in_time(void **state)
{
    (void)state;
    all_transients_agree(&engines[2]);
}

static bool close_to(const char *what, double frequency, double magnitude, double phase, const double *parts, double tolerance)
{
    const double complex value = magnitude * cexp(I * phase * DEA_PI / 180.0);
    const double complex exact = parts[0] + I * parts[1];
    const double off = cabs(value - exact) / cabs(exact);
    if (!(off <= tolerance) || !(phase > -180.0 && phase <= 180.0)) {
        print_error("  %s at %g Hz: %.17g at %.17g deg, wanted %.17g at %.17g deg, off by %.2e\n", what, frequency, magnitude,
                    phase, cabs(exact), carg(exact) * 180.0 / DEA_PI, off);
        return false;
    }
    return true;
}

static bool response_agrees(const moving_film *setup, const known_response *reference, const wanted *by)
{
    dea_scene scene = scene_of(setup, by->accuracy);
    scene.study = DEA_STUDY_AC;
    scene.ac = (dea_ac){.from = 1.0, .to = 1e4, .points_per_decade = 1, .bias = 3000.0};
    scene.drive.waveform = (dea_waveform){.kind = DEA_WAVE_NONE, ONCE};
    assert_int_equal(dea_layout_of(&scene).rows, REFERENCE_FREQUENCIES);
    unsigned char *point = run(&scene, dea_engine_find(by->engine), setup->name);
    assert_non_null(point);
    const dea_response *rows = (const dea_response *)(const void *)point;
    bool right = true;
    for (size_t i = 0; i < REFERENCE_FREQUENCIES; i++) {
        const dea_response *row = &rows[i];
        const double *parts = reference->rows[i];
        right = close_to("displacement", row->frequency, row->displacement, row->displacement_phase, parts, 1e-8) && right;
        right = close_to("impedance", row->frequency, row->impedance, row->impedance_phase, parts + 2, 1e-8) && right;
    }
    free(point);
    return right;
}

static void all_responses_agree(const wanted *by)
{
    size_t wrong = 0;
    for (size_t i = 0; i < SCENES; i++) {
        assert_string_equal(setups[i].name, reference_responses[i].name);
        wrong += response_agrees(&setups[i], &reference_responses[i], by) ? 0 : 1;
    }
    assert_int_equal(wrong, 0);
}

static void direct_follows_the_equations_over_frequency(void **state)
{
    (void)state;
    all_responses_agree(&engines[0]);
}

static void ngspice_follows_the_equations_over_frequency(void **state)
{
    (void)state;
    all_responses_agree(&engines[2]);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(direct_follows_the_equations_in_time),
        cmocka_unit_test(ida_follows_the_equations_in_time),
        cmocka_unit_test(ngspice_follows_the_equations_in_time),
        cmocka_unit_test(direct_follows_the_equations_over_frequency),
        cmocka_unit_test(ngspice_follows_the_equations_over_frequency),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
