/* The moving film along its radius: against finite elements that know no rings, the balance of momentum, and the static film. */
#include "moving_membrane.h"

enum { POINTS = 301 };

/* Numbers of an entry. */
enum { DISPLACEMENT, VELOCITY, RADIAL, HOOP, THICKNESS, RADIAL_STRESS, HOOP_STRESS, FIELD };

static dea_scene profiled_scene(dea_kind kind, double until, size_t samples)
{
    dea_scene scene = paper_scene(kind, 1.2, 0.5, (double)NAN);
    scene.models[0] = dea_model_find("field");
    scene.study = DEA_STUDY_TRANSIENT;
    scene.accuracy = 1e-5;
    scene.material.density = 1080.0;
    scene.material.retardation = 5e-5;
    scene.drive.waveform = (dea_waveform){
        .kind = DEA_WAVE_STEP, .step = {.off = (double)NAN, .voltage = 4500.0, .rise = 1e-4}, .period = (double)NAN};
    scene.transient = (dea_transient){.until = until, .every = until / (double)samples, .points = POINTS};
    return scene;
}

/* Value of the finite elements at R, and its slope. */
static double fe_at(const fe_film *f, const double *u, double radius, double *slope)
{
    const double rim = f->frame / f->prestretch, edge = f->coverage * rim;
    const bool disc = radius <= edge;
    const size_t count = disc ? f->disc_elements : FE_ELEMENTS - f->disc_elements;
    const double from = disc ? 0.0 : edge, length = (disc ? edge : rim - edge) / (double)count;
    const size_t e = (size_t)fmin((double)count - 1.0, floor((radius - from) / length));
    const size_t first = (disc ? e : f->disc_elements + e) * FE_DEGREE;
    double value = 0.0;
    *slope = 0.0;
    for (int n = 0; n <= FE_DEGREE; n++) {
        double tilt;
        value += fe_polynomial(n, (radius - from) / length - (double)e, &tilt) * u[first + (size_t)n];
        *slope += tilt / length * u[first + (size_t)n];
    }
    return value;
}

static void the_film_moves_as_finite_elements_do(void **state)
{
    (void)state;
    for (int kind = DEA_DOT; kind <= DEA_LENS; kind++) {
        const dea_scene scene = profiled_scene((dea_kind)kind, 1e-3, 4);
        dea_layout layout;
        dea_sample *samples = fly(&scene, &layout);
        static fe_film f;
        static fe_state s;
        fe_open(&scene, &f);
        fe_rest(&f, &s);
        const size_t steps = 10000; /* the rise ends with one */
        for (size_t i = 0; i < steps; i++) {
            fe_step(&f, 1e-3 * (double)i / (double)steps, 1e-3 / (double)steps, &s);
        }
        for (size_t i = 1; i < POINTS; i++) {
            const double radius = dea_layout_radius(&scene, &layout, i) / 1.2, *entry = dea_layout_entry(&layout, samples, 4, i);
            double slope, tilt;
            const double u = fe_at(&f, s.u, radius, &slope), v = fe_at(&f, s.v, radius, &tilt);
            assert_true(fabs(entry[DISPLACEMENT] - u) <= 2e-5 * 1e-3);
            assert_true(fabs(entry[VELOCITY] - v) <= 2e-4 * 2.0);
            assert_true(fabs(entry[RADIAL] - 1.2 - slope) <= 2e-4 * 0.1);
            assert_true(fabs(entry[HOOP] - 1.2 - u / radius) <= 2e-4 * 0.1);
            assert_true(fabs(entry[THICKNESS] * entry[RADIAL] * entry[HOOP] / 1e-4 - 1.0) <= 1e-12);
            const bool electroded = (radius <= f.coverage * f.frame / 1.2) == (kind == DEA_DOT);
            const double field = electroded ? 4500.0 / entry[THICKNESS] : 0.0;
            assert_true(fabs(entry[FIELD] - field) <= 1e-12 * field);
        }
        free(samples);
    }
}

/* d/dR (R s_1) - s_2 = rho R v' with the nominal stresses s = true stress/stretch, over the annulus and over time: what a film gains in
 * momentum is what pulls at it, damper and branch in it. */
static void stresses_move_the_film(void **state)
{
    (void)state;
    enum { SAMPLES = 200 };
    dea_scene scene = profiled_scene(DEA_DOT, 1e-3, SAMPLES);
    dea_prony branch = {.g = 0.2, .tau = 2e-4};
    scene.material.prony[0] = branch;
    scene.material.prony_count = 1;
    dea_layout layout;
    dea_sample *samples = fly(&scene, &layout);
    const size_t from = 181, to = POINTS - 1; /* outside of the edge, an even number of steps apart but for one */
    const double dr = dea_layout_radius(&scene, &layout, 1) / 1.2, dt = scene.transient.every;
    double impulse = 0.0, before = 0.0, largest = 0.0;
    for (size_t k = 40; k <= SAMPLES; k++) { /* once the voltage has risen */
        double momentum = 0.0, hoop = 0.0;
        for (size_t i = from; i <= to; i++) {
            const double *entry = dea_layout_entry(&layout, samples, k, i);
            const double weight = i == from || i == to ? 0.5 : 1.0; /* trapezoidal */
            momentum += weight * dr * 1080.0 * dr * (double)i * entry[VELOCITY];
            hoop += weight * dr * entry[HOOP_STRESS] / entry[HOOP];
        }
        const double *in = dea_layout_entry(&layout, samples, k, from), *out = dea_layout_entry(&layout, samples, k, to);
        const double pull = dr * ((double)to * out[RADIAL_STRESS] / out[RADIAL] - (double)from * in[RADIAL_STRESS] / in[RADIAL]) - hoop;
        if (k == 40) {
            before = momentum;
        }
        const double half = k == 40 ? 0.5 : 1.0;
        impulse += half * dt * pull;
        largest = fmax(largest, fabs(momentum));
        assert_true(k == 40 || fabs(momentum - before - (impulse - 0.5 * dt * pull)) <= 2e-3 * largest);
    }
    assert_true(largest > 0.0);
    free(samples);
}

/* Long after a step the film lies as the static one does. */
static void it_comes_to_rest_as_the_static_film(void **state)
{
    (void)state;
    for (int variant = 0; variant < 3; variant++) {
        const dea_kind kind = variant == 1 ? DEA_LENS : DEA_DOT;
        dea_scene scene = profiled_scene(kind, 0.1, 2);
        scene.material.retardation = 5e-4;
        if (variant == 2) { /* electrostriction of physics.md, section 8 */
            scene.material.permittivity = 2.76;
            scene.material.permittivity_per_stretch = -0.28;
            scene.material.permittivity_follows = true;
        }
        dea_layout layout;
        dea_sample *samples = fly(&scene, &layout);
        dea_scene still = scene;
        dea_error error = {0};
        still.study = DEA_STUDY_PROFILE;
        still.profile.points = POINTS;
        still.drive.voltage = 4500.0;
        const dea_layout other = dea_layout_of(&still);
        dea_station *stations = calloc(1, other.point_size);
        const dea_engine *direct = dea_engine_find("direct");
        assert_int_equal(direct->solves[DEA_STUDY_PROFILE](NULL, &still, still.models[0], &other, stations, &error), DEA_OK);
        for (size_t i = 0; i < POINTS; i++) {
            const double *entry = dea_layout_entry(&layout, samples, 2, i);
            const dea_station *at = &stations[i];
            const double wanted[] = {at->displacement, 0.0, at->stretch[0], at->stretch[1], at->thickness, at->stress[0], at->stress[1], at->field};
            const double scale[] = {1e-3, 1.0, 0.1, 0.1, 1e-4, 4e5, 4e5, 1e8};
            for (size_t k = 0; k < DEA_SPREAD_COLUMNS; k++) {
                assert_true(fabs(entry[k] - wanted[k]) <= (k == 0 ? 1e-5 : 1e-4) * scale[k]);
            }
        }
        const dea_weakest *told = &samples[2].weakest, *wanted = dea_layout_weakest(&other, stations);
        assert_true(is_close(told->field, wanted->field, 1e-4, 0.0) && is_close(told->tension, wanted->tension, 1e-4, 0.0));
        assert_true(isnan(told->field_radius) == (kind == DEA_DOT)); /* the disc is uniform */
        assert_true(kind == DEA_DOT || is_close(told->field_radius, wanted->field_radius, 0.0, 3e-4));
        free(stations);
        free(samples);
    }
}

/* The weakest places of a sample are as weak as any radius, and breakdown begins there. */
static void a_moving_film_breaks_down_where_its_field_is_largest(void **state)
{
    (void)state;
    dea_scene scene = profiled_scene(DEA_DOT, 1e-3, 50);
    scene.material.breakdown = 7e7;
    dea_layout layout;
    dea_sample *samples = fly(&scene, &layout);
    bool broken = false;
    assert_true(isnan(samples[0].weakest.field_radius) && isnan(samples[0].weakest.tension_radius)); /* at rest it is uniform */
    for (size_t k = 0; k < layout.rows; k++) {
        double field = 0.0, tension = INFINITY, radius = 0.0;
        for (size_t i = 0; i < POINTS; i++) {
            const double *entry = dea_layout_entry(&layout, samples, k, i);
            radius = entry[FIELD] > field ? dea_layout_radius(&scene, &layout, i) : radius;
            field = fmax(field, entry[FIELD]);
            tension = fmin(tension, fmin(entry[RADIAL_STRESS], entry[HOOP_STRESS]));
        }
        const dea_weakest *told = &samples[k].weakest;
        assert_true(told->field >= field * (1.0 - 1e-4) && told->field <= field * (1.0 + 1e-3));
        assert_true(told->tension <= tension + 1e-4 * fabs(tension) && told->tension >= tension - 2e-2 * fabs(tension));
        assert_true(isnan(told->field_radius) || fabs(told->field_radius - radius) <= 1e-3);
        assert_int_equal(samples[k].state, told->field > 7e7 ? DEA_STATE_BREAKDOWN : DEA_STATE_OK);
        broken = broken || samples[k].state == DEA_STATE_BREAKDOWN;
    }
    assert_true(broken && samples[0].state == DEA_STATE_OK);
    free(samples);
}

/* examples/wave.yaml: displacement and stretch by the finite elements, and the fronts at the speed of sound, sqrt(W11/rho) of reference
 * film, whose W11 physics.md has. */
static void the_waves_of_the_example_are_those_of_finite_elements(void **state)
{
    (void)state;
    dea_scene scene;
    dea_layout layout;
    dea_error error = {0};
    static fe_film f;
    static fe_state s;
    assert_int_equal(dea_scene_read("examples/wave.yaml", NULL, 0, NULL, &scene, &error), DEA_OK);
    dea_sample *samples = fly(&scene, &layout);
    fe_open(&scene, &f);
    fe_rest(&f, &s);
    const double h = 2.5e-7;
    for (size_t k = 1; k <= 60; k++) {
        for (size_t i = 0; i < 40; i++) {
            fe_step(&f, 1e-5 * (double)(k - 1) + h * (double)i, h, &s);
        }
        for (size_t i = 1; i < layout.spread_points; i++) {
            const double radius = dea_layout_radius(&scene, &layout, i) / 1.2, *entry = dea_layout_entry(&layout, samples, k, i);
            double slope;
            const double u = fe_at(&f, s.u, radius, &slope);
            assert_true(fabs(entry[DISPLACEMENT] - u) <= 2e-3 * 1.2e-3);
            assert_true(k < 10 || fabs(entry[RADIAL] - 1.2 - slope) <= 2e-2 * 0.13); /* before, the elements are too long for the front */
        }
    }
    const double arrival = 7.5e-3 / 1.2 / sqrt(697321.54 / 1080.0); /* half way to the centre */
    size_t first = 0;
    while (dea_layout_entry(&layout, samples, first, 30)[RADIAL] < 1.23) { /* half of the front */
        first++;
    }
    assert_near(samples[first].time, arrival, 2e-5);
    free(samples);
    dea_scene_free(&scene);
}

static void only_engines_that_have_profiles_are_asked(void **state)
{
    (void)state;
    const dea_scene scene = profiled_scene(DEA_DOT, 1e-3, 4);
    const dea_crew crew = dea_crew_of(&scene, NULL, scene.models[0]);
    assert_true(crew.count == 1 && crew.engines[0] == dea_engine_find("ida"));
    assert_string_equal(dea_engine_refuses(dea_engine_find("ngspice"), &scene, scene.models[0]), "its transients have no profiles");
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(the_film_moves_as_finite_elements_do),
        cmocka_unit_test(stresses_move_the_film),
        cmocka_unit_test(it_comes_to_rest_as_the_static_film),
        cmocka_unit_test(a_moving_film_breaks_down_where_its_field_is_largest),
        cmocka_unit_test(the_waves_of_the_example_are_those_of_finite_elements),
        cmocka_unit_test(only_engines_that_have_profiles_are_asked),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
