/* The moving examples, by every engine that can do them, against numbers that none of them made: tests/peers/examples_scipy.py
 * solves the same actuators from the equations alone. Run from the project's folder. */
#include "scenes.h"

#include <stdlib.h>

/* Mean of the strain over a window, in the place of a column. */
#define MEAN_STRAIN ((size_t)-1)

typedef struct fact {
    const char *example;
    size_t point;  /* of the study: models times axes */
    double at, to; /* time, or window [s] */
    size_t column; /* offset in dea_sample, or MEAN_STRAIN */
    double value;
} fact;

static const fact facts[] = {
    {"protocol", 0, 6, 8, MEAN_STRAIN, 0.0566820628934},
    {"protocol", 1, 6, 8, MEAN_STRAIN, 0.0354262893084},
    {"protocol", 2, 6, 8, MEAN_STRAIN, 0.0141705157234},
    {"vhb-creep", 0, 1, 0, offsetof(dea_sample, strain), 0.0687915314237},
    {"vhb-creep", 0, 10, 0, offsetof(dea_sample, strain), 0.113880391775},
    {"vhb-creep", 0, 100, 0, offsetof(dea_sample, strain), 0.20327780749},
    {"vhb-creep", 0, 600, 0, offsetof(dea_sample, strain), 0.250930615698},
    {"vhb-creep", 1, 1, 0, offsetof(dea_sample, strain), 0.0250285230808},
    {"vhb-creep", 1, 10, 0, offsetof(dea_sample, strain), 0.0438686844229},
    {"vhb-creep", 1, 100, 0, offsetof(dea_sample, strain), 0.0907553529487},
    {"vhb-creep", 1, 600, 0, offsetof(dea_sample, strain), 0.130282526896},
    {"fast-lens", 0, 0.00013, 0, offsetof(dea_sample, strain), -0.0399989618939},
    {"fast-lens", 0, 0.00013, 0, offsetof(dea_sample, focal_length), 0.00854291668842},
    {"fast-lens", 0, 0.00016, 0, offsetof(dea_sample, strain), -0.0652222688949},
    {"fast-lens", 0, 0.00016, 0, offsetof(dea_sample, focal_length), 0.00771515821336},
    {"fast-lens", 0, 0.000234, 0, offsetof(dea_sample, strain), -0.055650972053},
    {"fast-lens", 0, 0.000234, 0, offsetof(dea_sample, focal_length), 0.00802127432834},
    {"fast-lens", 0, 0.0006, 0, offsetof(dea_sample, strain), -0.0567801918905},
    {"fast-lens", 0, 0.0006, 0, offsetof(dea_sample, focal_length), 0.00798465634519},
    {"sine-supply", 0, 0.005, 0, offsetof(dea_sample, strain), 0.00370148051218},
    {"sine-supply", 0, 0.005, 0, offsetof(dea_sample, charge), 4.1503673699e-07},
    {"sine-supply", 0, 0.005, 0, offsetof(dea_sample, current), 4.6721957388e-05},
    {"sine-supply", 0, 0.05, 0, offsetof(dea_sample, strain), 0.00217508691591},
    {"sine-supply", 0, 0.05, 0, offsetof(dea_sample, charge), 3.07383288657e-07},
    {"sine-supply", 0, 0.05, 0, offsetof(dea_sample, current), 2.92452567143e-05},
    {"sine-supply", 0, 0.265, 0, offsetof(dea_sample, strain), 0.00897262583883},
    {"sine-supply", 0, 0.265, 0, offsetof(dea_sample, charge), 6.39384260034e-07},
    {"sine-supply", 0, 0.265, 0, offsetof(dea_sample, current), 6.25975225202e-07},
    {"sine-supply", 0, 0.5, 0, offsetof(dea_sample, strain), 0.0024319945029},
    {"sine-supply", 0, 0.5, 0, offsetof(dea_sample, charge), 3.07641426088e-07},
    {"sine-supply", 0, 0.5, 0, offsetof(dea_sample, current), 2.92676946003e-05},
    {"lens-optics", 0, 1, 1.5, MEAN_STRAIN, -0.00849926916875},
    {"lens-optics", 0, 1.5, 0, offsetof(dea_sample, focal_length), 0.0213838804666},
    {"lens-optics", 1, 1, 1.5, MEAN_STRAIN, -0.033997076675},
    {"lens-optics", 1, 1.5, 0, offsetof(dea_sample, focal_length), 0.0196392117142},
    {"lens-optics", 2, 1, 1.5, MEAN_STRAIN, -0.0764934225188},
    {"lens-optics", 2, 1.5, 0, offsetof(dea_sample, focal_length), 0.017060358758},
    {"constant-current", 0, 0.01, 0, offsetof(dea_sample, charge), 4.999988888889e-07}, /* I t, less half of the rise to the limit */
    {"constant-current", 0, 0.04, 0, offsetof(dea_sample, film_voltage), 4500.0},
    {"switch-on", 2, 0.001, 0, offsetof(dea_sample, strain), 0.0741705}, /* by a method of lines */
    {"switch-on", 2, 0.002, 0, offsetof(dea_sample, strain), 0.0518654},
    {"switch-on", 2, 0.004, 0, offsetof(dea_sample, strain), 0.0610839},
    {"switch-on", 2, 0.008, 0, offsetof(dea_sample, strain), 0.0613304},
};

/* Rows of resonance.yaml. */
typedef struct tone {
    size_t row;
    dea_response response;
} tone;

static const tone tones[] = {
    {0, {0.0, 1.91161038202e-07, -0.990795965546, 510206378.468, -89.8609655826, DEA_STATE_OK}},
    {200, {0.0, 1.82243253863e-07, -3.01200572103, 5134743.80349, -88.6467702029, DEA_STATE_OK}},
    {286, {0.0, 2.41339590685e-06, -100.528544932, 413434.135403, -12.3054885924, DEA_STATE_OK}},
    {400, {0.0, 4.57755417675e-10, 120.599162348, 115964.316795, -30.4201837312, DEA_STATE_OK}},
};

/* All points of a study. */
typedef struct outcome {
    dea_scene scene;
    dea_layout layout;
    char *points; /* owned */
} outcome;

static dea_status take(void *user, size_t first, const void *points, size_t count, dea_error *error)
{
    outcome *out = user;
    (void)error;
    memcpy(out->points + first * out->layout.point_size, points, count * out->layout.point_size);
    return DEA_OK;
}

static void read_example(const char *name, outcome *out)
{
    char path[128];
    dea_error error = {0};
    snprintf(path, sizeof path, "examples/%s.yaml", name);
    if (dea_scene_read(path, NULL, 0, NULL, &out->scene, &error) != DEA_OK) {
        fail_msg("%s", error.message);
    }
    out->layout = dea_layout_of(&out->scene);
    out->points = calloc(out->scene.model_count * dea_scene_point_count(&out->scene), out->layout.point_size);
    assert_non_null(out->points);
}

static void close_example(outcome *out)
{
    free(out->points);
    dea_scene_free(&out->scene);
}

/* False where the engine refuses a model of the scene. */
static bool solve_example(outcome *out, const dea_engine *engine)
{
    const dea_run_options options = {.jobs = 1, .points = take, .user = out};
    dea_error error = {0};
    for (size_t i = 0; i < out->scene.model_count; i++) {
        if (dea_engine_refuses(engine, &out->scene, out->scene.models[i])) {
            return false;
        }
    }
    if (dea_study_run(&out->scene, engine, &options, &error) != DEA_OK) {
        fail_msg("%s: %s", engine->name, error.message);
    }
    return true;
}

static const dea_sample *samples_of(const outcome *out, size_t point)
{
    return (const dea_sample *)(const void *)(out->points + point * out->layout.point_size);
}

static double found(const outcome *out, const fact *f)
{
    const dea_sample *samples = samples_of(out, f->point);
    if (f->column == MEAN_STRAIN) { /* the example's first window */
        const dea_transient *transient = &out->scene.transient;
        assert_true(transient->averages[0].from == f->at && transient->averages[0].to == f->to);
        return dea_layout_summary(&out->layout, out->points + f->point * out->layout.point_size)->averages[0].strain;
    }
    const size_t row = (size_t)lround(dea_layout_index(&out->scene, f->at));
    double value;
    memcpy(&value, (const char *)&samples[row] + f->column, sizeof value);
    return value;
}

/* Peak of a column over its run: what an error is measured by. */
static double peak(const outcome *out, const fact *f)
{
    const size_t column = f->column == MEAN_STRAIN ? offsetof(dea_sample, strain) : f->column;
    double largest = 0.0;
    for (size_t i = 0; i < out->layout.rows; i++) {
        double value;
        memcpy(&value, (const char *)&samples_of(out, f->point)[i] + column, sizeof value);
        largest = fmax(largest, fabs(value));
    }
    return largest;
}

static void check_facts(const char *name, const char *engine, const outcome *out)
{
    size_t count = 0;
    for (size_t i = 0; i < sizeof facts / sizeof *facts; i++) {
        if (strcmp(facts[i].example, name) == 0) {
            /* an error of the displacement counts five times in the focal length; the script's own numbers hold to 1e-6 */
            const double tolerance = 5.0 * out->scene.accuracy + 1e-6;
            const double value = found(out, &facts[i]);
            if (!(fabs(value - facts[i].value) <= tolerance * peak(out, &facts[i]))) {
                fail_msg("%s by %s, fact %zu: %.12g, wanted %.12g", name, engine, i, value, facts[i].value);
            }
            count++;
        }
    }
    assert_true(count > 0);
}

static void check_balance(const outcome *out)
{
    for (size_t i = 0; i < out->scene.model_count * dea_scene_point_count(&out->scene); i++) {
        const dea_summary *summary = dea_layout_summary(&out->layout, out->points + i * out->layout.point_size);
        assert_true(summary->residual <= 10.0 * out->scene.accuracy);
        assert_true(summary->error <= out->scene.accuracy);
    }
}

/* Runs an example by every engine; returns how many could. */
static size_t check_example(const char *name)
{
    size_t able = 0;
    for (size_t i = 0; i < dea_engine_count(); i++) {
        outcome out;
        read_example(name, &out);
        if (solve_example(&out, dea_engine_at(i))) {
            check_facts(name, dea_engine_at(i)->name, &out);
            check_balance(&out);
            able++;
        }
        close_example(&out);
    }
    return able;
}

static void protocol_of_the_paper_gives_its_mean_strains(void **state)
{
    (void)state;
    assert_int_equal(check_example("protocol"), 3);
}

static void vhb_creeps_on_three_branches(void **state)
{
    (void)state;
    assert_int_equal(check_example("vhb-creep"), 2);
}

static void sine_through_10_MOhm_moves_film_and_charge(void **state)
{
    (void)state;
    assert_int_equal(check_example("sine-supply"), 2);
}

static void a_source_at_its_limit_charges_evenly(void **state)
{
    (void)state;
    assert_int_equal(check_example("constant-current"), 2);
}

static void liquid_lens_focuses_as_its_aperture_shrinks(void **state)
{
    (void)state;
    assert_int_equal(check_example("lens-optics"), 3);
}

/* 20 % of focal change within 175 us. */
static void fast_lens_settles_within_175_microseconds(void **state)
{
    (void)state;
    assert_int_equal(check_example("fast-lens"), 2);
    outcome out;
    read_example("fast-lens", &out);
    assert_true(solve_example(&out, dea_engine_find("ida")));
    const dea_sample *samples = samples_of(&out, 0);
    const double last = samples[out.layout.rows - 1].focal_length;
    assert_near(last / samples[0].focal_length, 0.8, 0.005);
    for (size_t i = 0; i < out.layout.rows; i++) {
        const bool settled = samples[i].time > 100e-6 + 175e-6;
        assert_true(!settled || fabs(samples[i].focal_length - last) < 0.02 * (samples[0].focal_length - last));
    }
    close_example(&out);
}

static double first_peak(const outcome *out, size_t point)
{
    double largest = 0.0;
    for (size_t i = 0; i < out->layout.rows; i++) {
        largest = fmax(largest, samples_of(out, point)[i].strain);
    }
    return largest;
}

/* Of the linear network 22 % above that of the membrane. */
static void switch_on_of_the_membrane_peaks_below_that_of_the_linear_network(void **state)
{
    (void)state;
    assert_true(check_example("switch-on") >= 1);
    outcome out;
    read_example("switch-on", &out);
    assert_true(solve_example(&out, dea_engine_find("ida")));
    assert_near(first_peak(&out, 0) / first_peak(&out, 2) - 1.0, 0.22, 0.005);
    assert_near(first_peak(&out, 2), 0.0756050, 1e-6);
    close_example(&out);
}

static void resonance_has_its_magnitudes_and_phases(void **state)
{
    (void)state;
    for (size_t i = 0; i < 2; i++) {
        outcome out;
        read_example("resonance", &out);
        assert_true(solve_example(&out, dea_engine_find(i == 0 ? "direct" : "ngspice")));
        for (size_t k = 0; k < sizeof tones / sizeof *tones; k++) {
            const dea_response *got = (const dea_response *)(const void *)out.points + tones[k].row;
            const dea_response *want = &tones[k].response;
            assert_relative(got->displacement, want->displacement, 1e-6);
            assert_relative(got->impedance, want->impedance, 1e-6);
            assert_near(got->displacement_phase, want->displacement_phase, 1e-4);
            assert_near(got->impedance_phase, want->impedance_phase, 1e-4);
        }
        close_example(&out);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(protocol_of_the_paper_gives_its_mean_strains),
        cmocka_unit_test(vhb_creeps_on_three_branches),
        cmocka_unit_test(sine_through_10_MOhm_moves_film_and_charge),
        cmocka_unit_test(a_source_at_its_limit_charges_evenly),
        cmocka_unit_test(liquid_lens_focuses_as_its_aperture_shrinks),
        cmocka_unit_test(switch_on_of_the_membrane_peaks_below_that_of_the_linear_network),
        cmocka_unit_test(fast_lens_settles_within_175_microseconds),
        cmocka_unit_test(resonance_has_its_magnitudes_and_phases),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
