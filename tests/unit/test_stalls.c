/* Transients on which ngspice took steps of 1e-9 s for ever, drives of many corners, and films past their fold: solved, as `ida`
 * solves them, or refused at once. */
#include "scenes.h"

#include <stdlib.h>
#include <unistd.h>

#include "../promises/promises.h"

#define SILICONE_DOT                                                                                                             \
    "actuator: {kind: dot, frame_radius: 30 mm, coverage: 0.5, film_thickness: 100 um, prestretch: 1.2}\n"                       \
    "material: {base: elastosil-2030, density: 1080 kg/m^3, retardation: 1 ms}\n"

enum { MOST_SAMPLES = 70000, LINE = 1024 };

typedef struct outcome {
    dea_sample samples[MOST_SAMPLES];
    size_t count;
    char log[LINE]; /* the first line */
} outcome;

static outcome found, wanted; /* too large for a stack */

static dea_status take(void *user, size_t first, const void *points, size_t count, dea_error *error)
{
    outcome *o = user;
    (void)first, (void)error;
    assert_int_equal(count, 1);
    memcpy(o->samples, points, o->count * sizeof *o->samples);
    return DEA_OK;
}

static void hear(void *user, const char *line)
{
    outcome *o = user;
    if (o->log[0] == '\0') {
        snprintf(o->log, LINE, "%s", line);
    }
}

/* Runs a scene's text; accuracy 0: that of the scene. Returns the accuracy. */
static double run_text(const char *text, const char *engine, double accuracy, outcome *o)
{
    dea_error error = {0};
    dea_scene scene;
    const dea_run_options options = {.jobs = 1, .points = take, .log = hear, .user = o};
    if (dea_scene_parse(text, strlen(text), "stall", ".", NULL, 0, NULL, &scene, &error) != DEA_OK) {
        fail_msg("%s\n%s", error.message, text);
    }
    scene.accuracy = accuracy > 0.0 ? accuracy : scene.accuracy;
    const double asked = scene.accuracy;
    o->count = dea_layout_of(&scene).rows;
    o->log[0] = '\0';
    assert_true(o->count <= MOST_SAMPLES);
    assert_int_equal(dea_study_run(&scene, dea_engine_find(engine), &options, &error), DEA_OK);
    dea_scene_free(&scene);
    return asked;
}

/* ngspice delivers what ida finds at a hundredth of the accuracy: states, and displacements to the accuracy. */
static void agree(const char *text, double accuracy)
{
    const double asked = run_text(text, "ngspice", accuracy, &found);
    double peak = 0.0;
    run_text(text, "ida", fmax(1e-9, 0.01 * asked), &wanted);
    for (size_t i = 0; i < wanted.count; i++) {
        const double u = wanted.samples[i].displacement;
        peak = fmax(peak, isnan(u) ? 0.0 : fabs(u));
    }
    for (size_t i = 0; i < wanted.count; i++) {
        const dea_sample *a = &found.samples[i], *b = &wanted.samples[i];
        if (a->state != b->state || (!isnan(b->displacement) && !(fabs(a->displacement - b->displacement) <= asked * peak))) {
            fail_msg("sample %zu: %s %.9g, wanted %s %.9g within %g of %.9g (%s)\n%s", i, dea_state_name(a->state),
                     a->displacement, dea_state_name(b->state), b->displacement, asked, peak, found.log, text);
        }
    }
}

/* ---- steps that collapsed */

static void a_spring_on_its_branch_does_not_stall(void **state)
{
    (void)state;
    agree("actuator: {kind: dot, frame_radius: 30 mm, coverage: 0.4086956521739131, film_thickness: 100 um, prestretch: 1.2}\n"
          "material: {base: elastosil-2030, density: 1080 kg/m^3, retardation: 20 us, prony: [{g: 0.08, tau: 0.2 s}]}\n"
          "drive: {waveform: {step: {on: 0.1 s, off: 5 s, voltage: 3 kV}}, series_resistance: 1 MOhm}\n"
          "model: lumped\nstudy: {transient: {until: 10 s, every: 1 ms}}\n",
          1e-5);
}

static void a_lens_behind_a_small_resistance_does_not_stall(void **state)
{
    (void)state;
    agree("actuator:\n  kind: lens\n  frame_radius: 0.007393245471603476 m\n  coverage: 0.13701295487032442\n"
          "  film_thickness: 2.4094234875992994e-05 m\n  prestretch: 1.4770596688681352\n"
          "material:\n  yeoh: {C1: 207274.77703337296 Pa, C2: -6092.811652275976 Pa, C3: 2840.3590731495256 Pa}\n"
          "  permittivity: 3.886525759447005\n  density: 1049.890241854483 kg/m^3\n"
          "  prony: [{g: 0.13743910955179323, tau: 0.04229569800800095 s}, {g: 0.119545110171, tau: 0.000158152073603 s}]\n"
          "drive:\n  series_resistance: 344.99332066446283 Ohm\n  waveform:\n"
          "    points: [[0 s, 283 V], [3.11e-5 s, 213.4 V], [5.34e-5 s, 426.3 V], [4.189e-4 s, 296 V], [7.271e-4 s, 318 V]]\n"
          "    period: 8.059399787768e-4 s\n"
          "model: lumped\nstudy: {transient: {until: 0.0013849058979167046 s, every: 2.826338567176948e-05 s}}\n",
          1e-5);
}

static void random_stalls_are_solved(void **state)
{
    (void)state;
    for (size_t number = 0; number < 10; number++) {
        char *text = draw_stall(1, number);
        assert_non_null(text);
        agree(text, number % 2 ? 1e-3 : 1e-4);
        free(text);
    }
}

/* A damper outweighs the mass, whose time no step resolves: velocities are those of the network, to ten times the accuracy, also
 * where a piece begins and its steps grow. */
static void a_heavily_damped_film_keeps_its_velocity(void **state)
{
    (void)state;
    char *text = draw_stall(20261201, 193);
    assert_non_null(text);
    agree(text, 1e-6);
    free(text);
    double fastest = 0.0, off = 0.0;
    for (size_t i = 0; i < wanted.count; i++) {
        fastest = fmax(fastest, fabs(wanted.samples[i].velocity));
        off = fmax(off, fabs(found.samples[i].velocity - wanted.samples[i].velocity));
    }
    assert_true(off <= 1e-5 * fastest);
}

/* Chains that are straight before the film has left its frame throw it back: steps that pass their end are too long, and say nothing of a
 * film that runs away. */
static void a_film_is_thrown_back_where_its_chains_are_straight(void **state)
{
    (void)state;
    agree("actuator: {kind: dot, frame_radius: 0.012111625400694348 m, coverage: 0.041510757912899036,\n"
          "  film_thickness: 0.00089249048422401474 m, prestretch: 1.4813213614713274}\n"
          "material: {gent: {mu: 933212.55281984177 Pa, Jm: 9.7730777743091615}, density: 1064.3549953167417 kg/m^3,\n"
          "  permittivity: {constant: 5.6608204844486645, per_stretch: 0.10949028891708068}, modulus: 3483618.790265169 Pa}\n"
          "drive: {waveform: {step: {on: 0 s, voltage: 145 kV, rise: 2.8343336980102266e-09 s}}}\n"
          "model: coverage\nstudy: {transient: {until: 7e-5 s, every: 7e-5 s, start: rest}}\n",
          1e-2);
}

/* ---- drives of many corners */

static void a_bridge_of_short_edges_is_solved(void **state)
{
    (void)state;
    agree(SILICONE_DOT "drive: {waveform: {step: {on: 0 s, off: 0.1 ms, rise: 1 us, voltage: 3 kV}, period: 0.2 ms}}\n"
                       "model: coverage\nstudy: {transient: {until: 12 ms, every: 0.05 ms}}\n",
          1e-4);
}

/* 10,000 edges and ramps: refused before anything is run, with the limit and what to do. */
static void what_takes_too_long_is_refused_at_once(void **state)
{
    (void)state;
    run_text(SILICONE_DOT "drive: {waveform: {step: {on: 0 s, off: 0.01 ms, rise: 1 us, voltage: 3 kV}, period: 0.02 ms}}\n"
                          "model: coverage\nstudy: {transient: {until: 1 s, every: 1 ms}}\n",
             "ngspice", 1e-4, &found);
    assert_int_equal(found.samples[1].state, DEA_STATE_FAILED);
    assert_non_null(strstr(found.log, "edges and ramps"));
    assert_non_null(strstr(found.log, "at most"));
    assert_non_null(strstr(found.log, "--engine ida"));
}

/* At the frame the stress of a negative exponent grows so steeply that forty thousand steps go through the point where the film turns
 * back: no finer run is worth half a minute. */
static void a_bounce_that_is_too_steep_is_refused_early(void **state)
{
    (void)state;
    run_text("actuator: {kind: lens, frame_radius: 5.56 mm, coverage: 0.94477841005180463, film_thickness: 95.3 um, "
             "prestretch: 1.0719181338268406}\n"
             "material:\n  ogden: [{mu: -376267.4 Pa, alpha: -0.55194281545337898}]\n  permittivity: 8.395\n  density: 914 kg/m^3\n"
             "  retardation: 13.09 us\n  modulus: 482102 Pa\n"
             "drive: {waveform: {step: {on: 0.58 ms, voltage: 2892 V, rise: 0 s}}}\n"
             "model: coverage\nstudy: {transient: {until: 2.668 ms, every: 8.748 us}}\n",
             "ngspice", 1e-4, &found);
    assert_int_equal(found.samples[1].state, DEA_STATE_FAILED);
    assert_non_null(strstr(found.log, "turns back"));
    assert_non_null(strstr(found.log, "at most 12 s"));
    assert_non_null(strstr(found.log, "--engine ida"));
}

/* A record of a sine with noise, of which a film with a damper sees much: a netlist of a film that is not linear costs milliseconds. */
static void a_noisy_record_that_takes_too_long_is_refused_at_once(void **state)
{
    (void)state;
    enum { ROWS = 200000 };
    char path[] = "/tmp/deaspice-noise-XXXXXX", text[LINE];
    FILE *file = fdopen(mkstemp(path), "w");
    assert_non_null(file);
    unsigned seed = 3;
    fputs("time_s,voltage_V\n", file);
    for (int i = 0; i < ROWS; i++) {
        const double time = i / (ROWS - 1.0);
        seed = 1664525u * seed + 1013904223u;
        fprintf(file, "%.9g,%.6g\n", time, 2000.0 + 1500.0 * sin(6.0 * DEA_PI * time) + 20.0 * (seed / 4294967296.0 - 0.5));
    }
    assert_int_equal(fclose(file), 0);
    snprintf(text, sizeof text, SILICONE_DOT "drive: {waveform: {file: %s}}\nmodel: ring\nstudy: {transient: {until: 1 s, every: 1 ms}}\n", path);
    run_text(text, "ngspice", 1e-4, &found);
    remove(path);
    assert_int_equal(found.samples[1].state, DEA_STATE_FAILED);
    assert_non_null(strstr(found.log, "netlists"));
    assert_non_null(strstr(found.log, "at most"));
    assert_non_null(strstr(found.log, "--engine ida"));
}

/* ---- past the fold in time */

static const char *snap(char *text, const char *film, double voltage, const char *times)
{
    snprintf(text, LINE, "%s  permittivity: 3.0\ndrive: {waveform: {step: {on: 0 s, voltage: %.17g V, rise: 0 s}}}\nmodel: coverage\n"
                         "study: {transient: {%s}}\n",
             film, voltage, times);
    return text;
}

static size_t rows_of(const outcome *o, dea_state state)
{
    size_t count = 0;
    for (size_t i = 0; i < o->count; i++) {
        count += o->samples[i].state == state;
    }
    return count;
}

/* A ring of 1e4 periods that is not linear: the begin of it tells that its phase takes too many steps. */
static void a_ring_that_loses_its_phase_is_refused_by_its_begin(void **state)
{
    (void)state;
    static const char text[] = "actuator: {kind: dot, frame_radius: 30 mm, coverage: 0.5, film_thickness: 100 um, prestretch: 1.2}\n"
                               "material: {base: elastosil-2030, density: 1080 kg/m^3, retardation: 30 ns}\n"
                               "drive: {waveform: {step: {on: 1 ms, voltage: 3000 V, rise: 0.1 ms}}}\nmodel: coverage\n"
                               "study: {transient: {until: 15 s, every: 0.37 ms}}\n";
    run_text(text, "ngspice", 1e-6, &found);
    assert_int_equal(found.samples[found.count - 1].state, DEA_STATE_FAILED);
    assert_non_null(strstr(found.log, "the ring of this film would lose a phase"));
    assert_non_null(strstr(found.log, "at most"));
}

/* The mass carries a dot through its fold into slack, where it turns back before the frame and swings. */
static void a_film_is_followed_past_its_fold(void **state)
{
    (void)state;
    char text[LINE];
    static const char small[] =
        "actuator: {kind: dot, frame_radius: 7.257726633171021 mm, coverage: 0.055658373381054525, film_thickness: 100 um, "
        "prestretch: 1.1279595072600181}\n"
        "material:\n  yeoh: {C1: 30728.961394946775 Pa, C2: 0 Pa, C3: 0 Pa}\n  density: 1050 kg/m^3\n  retardation: 0.65165 us\n";
    static const char large[] =
        "actuator: {kind: dot, frame_radius: 43.430555803523514 mm, coverage: 0.07776089090578293, film_thickness: 100 um, "
        "prestretch: 1.4024233763785172}\n"
        "material:\n  yeoh: {C1: 88580.09114559939 Pa, C2: 0 Pa, C3: 0 Pa}\n  density: 1050 kg/m^3\n  retardation: 6.0929 us\n";
    agree(snap(text, small, 3449.7588332758273, "until: 2.5409 ms, every: 0.025409 ms"), 1e-2);
    assert_int_equal(rows_of(&found, DEA_STATE_PULL_IN), 0);
    assert_true(rows_of(&found, DEA_STATE_SLACK) > 80);
    agree(snap(text, large, 4090.388178557825, "until: 9.235 ms, every: 0.030783 ms"), 1e-3);
    assert_int_equal(rows_of(&found, DEA_STATE_PULL_IN), 0);
    assert_true(rows_of(&found, DEA_STATE_SLACK) > 250);
}

/* Where the material softens without bounds no motion is left to follow, in a finite time: with mass it gets infinitely fast, with a
 * damper alone nothing holds it. */
static void a_film_that_runs_away_is_pulled_in(void **state)
{
    (void)state;
    char text[LINE];
    static const char heavy[] =
        "actuator: {kind: dot, frame_radius: 18.148135878465144 mm, coverage: 0.21609926738997037, film_thickness: 65.589 um, "
        "prestretch: 1.3465909201603221}\n"
        "material:\n  yeoh: {C1: 55531.49 Pa, C2: -2776.57 Pa, C3: 0 Pa}\n  density: 1050 kg/m^3\n  retardation: 2.1777 us\n";
    static const char light[] =
        "actuator: {kind: dot, frame_radius: 21.355802725988353 mm, coverage: 0.61538358513075153, film_thickness: 90.893 um, "
        "prestretch: 1.1379231902021159}\n"
        "material:\n  yeoh: {C1: 22961.07 Pa, C2: -1148.05 Pa, C3: 0 Pa}\n  retardation: 7.161 us\n";
    agree(snap(text, heavy, 1528.96, "until: 7.6253 ms, every: 0.038126 ms"), 1e-3);
    assert_true(rows_of(&found, DEA_STATE_PULL_IN) > 100);
    agree(snap(text, light, 4149.06, "until: 18.17 ms, every: 0.09085 ms"), 1e-3);
    assert_int_equal(rows_of(&found, DEA_STATE_PULL_IN), found.count - 1);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_spring_on_its_branch_does_not_stall),
        cmocka_unit_test(a_lens_behind_a_small_resistance_does_not_stall),
        cmocka_unit_test(random_stalls_are_solved),
        cmocka_unit_test(a_heavily_damped_film_keeps_its_velocity),
        cmocka_unit_test(a_film_is_thrown_back_where_its_chains_are_straight),
        cmocka_unit_test(a_bridge_of_short_edges_is_solved),
        cmocka_unit_test(what_takes_too_long_is_refused_at_once),
        cmocka_unit_test(a_bounce_that_is_too_steep_is_refused_early),
        cmocka_unit_test(a_noisy_record_that_takes_too_long_is_refused_at_once),
        cmocka_unit_test(a_ring_that_loses_its_phase_is_refused_by_its_begin),
        cmocka_unit_test(a_film_is_followed_past_its_fold),
        cmocka_unit_test(a_film_that_runs_away_is_pulled_in),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
