/* The static film along its radius against what holds of it: its geometry, the balance of its forces, its charge, its static row. */
#include "scenes.h"

#include <stdlib.h>

enum { POINTS = 4001 };

static dea_scene profile_scene(dea_kind kind, double prestretch, double coverage, double voltage)
{
    dea_scene scene = paper_scene(kind, prestretch, coverage, voltage);
    scene.study = DEA_STUDY_PROFILE;
    scene.profile.points = POINTS;
    return scene;
}

/* Stations of a model; the caller frees them. */
static dea_station *solve_profile(const dea_scene *scene, const char *model, dea_weakest *weakest)
{
    dea_error error = {0};
    const dea_layout layout = dea_layout_of(scene);
    dea_station *stations = calloc(1, layout.point_size);
    const dea_engine *direct = dea_engine_find("direct");
    assert_non_null(stations);
    assert_null(dea_engine_refuses(direct, scene, dea_model_find(model)));
    assert_int_equal(direct->solves[scene->study](NULL, scene, dea_model_find(model), &layout, stations, &error), DEA_OK);
    *weakest = *dea_layout_weakest(&layout, stations);
    return stations;
}

static const struct {
    dea_kind kind;
    double prestretch, coverage, voltage;
} films[] = {{DEA_DOT, 1.2, 0.5, 4500.0}, {DEA_LENS, 1.2, 0.5, 4500.0}, {DEA_DOT, 1.1, 0.25, 3000.0}, {DEA_LENS, 1.3, 0.75, 5000.0}};

enum { FILMS = sizeof films / sizeof *films };

static size_t edge_index(double coverage)
{
    return (size_t)lround(coverage * (POINTS - 1));
}

/* lambda_2 = r/R, lambda_1 = dr/dR by differences, H = h lambda_1 lambda_2. */
static void stretches_are_those_of_the_displacement(void **state)
{
    (void)state;
    for (size_t f = 0; f < FILMS; f++) {
        const dea_scene scene = profile_scene(films[f].kind, films[f].prestretch, films[f].coverage, films[f].voltage);
        const double pre = films[f].prestretch;
        dea_weakest weakest;
        dea_station *s = solve_profile(&scene, "field", &weakest);
        const size_t edge = edge_index(films[f].coverage);
        for (size_t i = 1; i + 1 < POINTS; i++) {
            const double hoop = pre * (s[i].radius + s[i].displacement) / s[i].radius;
            const double slope = (s[i + 1].displacement - s[i - 1].displacement) / (s[i + 1].radius - s[i - 1].radius);
            assert_true(fabs(s[i].stretch[1] - hoop) <= 1e-8);
            assert_true(i == edge || i == edge + 1 || fabs(s[i].stretch[0] - pre * (1.0 + slope)) <= 3e-6);
            assert_true(fabs(s[i].thickness * s[i].stretch[0] * s[i].stretch[1] - 1e-4) <= 1e-14);
        }
        assert_true(s[0].displacement == 0.0 && s[POINTS - 1].displacement == 0.0);
        free(s);
    }
}

/* R s_1 from one radius to another grows by int s_2 dR, of the nominal stresses s = true stress/stretch; so does it over the edge. */
static void forces_balance_along_the_radius(void **state)
{
    (void)state;
    for (size_t f = 0; f < FILMS; f++) {
        const dea_scene scene = profile_scene(films[f].kind, films[f].prestretch, films[f].coverage, films[f].voltage);
        dea_weakest weakest;
        dea_station *s = solve_profile(&scene, "field", &weakest);
        double sum = 0.0;
        const size_t first = 1 + edge_index(films[f].coverage) / 2 * 2; /* Simpson's rule over an even number of steps */
        for (size_t i = first; i + 2 < POINTS; i += 2) {
            const double hoop[3] = {s[i].stress[1] / s[i].stretch[1], s[i + 1].stress[1] / s[i + 1].stretch[1],
                                    s[i + 2].stress[1] / s[i + 2].stretch[1]};
            sum += (s[i + 2].radius - s[i].radius) / 6.0 * (hoop[0] + 4.0 * hoop[1] + hoop[2]);
            const double grown = s[i + 2].radius * s[i + 2].stress[0] / s[i + 2].stretch[0] -
                                 s[first].radius * s[first].stress[0] / s[first].stretch[0];
            assert_true(fabs(grown - sum) <= 1e-7 * fabs(grown));
        }
        const dea_station *in = &s[edge_index(films[f].coverage)], *out = in + 1; /* the edge belongs to the disc */
        assert_true(fabs(in->stress[0] / in->stretch[0] / (out->stress[0] / out->stretch[0]) - 1.0) <= 1e-3);
        free(s);
    }
}

/* eps E over the deformed electrode is the charge, the edge and the largest field those of the static row. */
static void charge_field_and_edge_are_those_of_the_row(void **state)
{
    (void)state;
    static const char *const models[] = {"field", "ring"};
    for (size_t f = 0; f < FILMS; f++) {
        for (int m = 0; m < 2; m++) {
            dea_scene scene = profile_scene(films[f].kind, films[f].prestretch, films[f].coverage, films[f].voltage);
            dea_weakest weakest;
            dea_station *s = solve_profile(&scene, models[m], &weakest);
            scene.study = DEA_STUDY_SWEEP;
            const dea_row row = solve_direct(&scene, models[m]);
            double charge = 0.0;
            for (size_t i = 0; i + 1 < POINTS; i++) {
                const double inner = s[i].radius + s[i].displacement, outer = s[i + 1].radius + s[i + 1].displacement;
                const double both = fmax(s[i].field, s[i + 1].field) > 0.0 ? 0.5 * (s[i].field + s[i + 1].field) : 0.0;
                charge += DEA_EPSILON_0 * 2.8 * both * DEA_PI * (outer * outer - inner * inner);
            }
            assert_true(fabs(s[edge_index(films[f].coverage)].displacement / row.displacement - 1.0) <= 1e-7);
            assert_true(m == 1 || fabs(charge / row.charge - 1.0) <= 2e-3); /* half a step at the edge */
            assert_true(fabs(weakest.field / row.field - 1.0) <= 1e-7);
            assert_int_equal(row.state, DEA_STATE_OK);
            free(s);
        }
    }
}

/* The weakest places are as weak as any station, and not much weaker than the weakest of them. */
static void the_weakest_places_are_among_the_stations(void **state)
{
    (void)state;
    for (size_t f = 0; f < FILMS; f++) {
        const dea_scene scene = profile_scene(films[f].kind, films[f].prestretch, films[f].coverage, films[f].voltage);
        dea_weakest weakest;
        dea_station *s = solve_profile(&scene, "field", &weakest);
        double field = 0.0, tension = INFINITY, width = s[1].radius;
        size_t at[2] = {0, 0};
        for (size_t i = 0; i < POINTS; i++) {
            if (s[i].field > field * (1.0 + 1e-12)) {
                field = s[i].field;
                at[0] = i;
            }
            if (fmin(s[i].stress[0], s[i].stress[1]) < tension * (1.0 - 1e-12)) {
                tension = fmin(s[i].stress[0], s[i].stress[1]);
                at[1] = i;
            }
        }
        assert_true(weakest.field >= field * (1.0 - 1e-12) && weakest.field <= field * (1.0 + 1e-3));
        assert_true(weakest.tension <= tension * (1.0 + 1e-12) && weakest.tension >= tension * (1.0 - 1e-3));
        assert_true(fabs(weakest.tension_radius - s[at[1]].radius) <= 2.0 * width || at[1] == 0);
        assert_true(fabs(weakest.field_radius - s[at[0]].radius) <= 40.0 * width || films[f].kind == DEA_DOT);
        free(s);
    }
}

/* With the voltage a film loses its tension first at the weakest place, and there alone. */
static void tension_is_lost_where_it_was_least(void **state)
{
    (void)state;
    double low = 4500.0, high = 12000.0;
    dea_weakest weakest;
    for (int i = 0; i < 40; i++) {
        dea_scene scene = profile_scene(DEA_DOT, 1.1, 0.5, 0.5 * (low + high));
        scene.profile.points = 2;
        free(solve_profile(&scene, "field", &weakest));
        *(weakest.tension > 0.0 ? &low : &high) = scene.drive.voltage;
    }
    const dea_scene scene = profile_scene(DEA_DOT, 1.1, 0.5, high * (1.0 + 1e-4));
    dea_station *s = solve_profile(&scene, "field", &weakest);
    size_t slack = 0, ok = 0, first = POINTS;
    for (size_t i = 0; i < POINTS; i++) {
        slack += s[i].state == DEA_STATE_SLACK;
        ok += s[i].state == DEA_STATE_OK;
        first = s[i].state == DEA_STATE_SLACK && first == POINTS ? i : first;
    }
    assert_true(slack > 0 && ok > POINTS / 4);
    assert_true(weakest.tension < 0.0 && fabs(s[first].radius - weakest.tension_radius) <= (double)slack * s[1].radius);
    free(s);
}

/* Breakdown shows where the film is electroded and nowhere else. */
static void breakdown_is_local(void **state)
{
    (void)state;
    dea_scene scene = profile_scene(DEA_LENS, 1.2, 0.5, 4500.0);
    scene.material.breakdown = 50e6;
    dea_weakest weakest;
    dea_station *s = solve_profile(&scene, "field", &weakest);
    assert_true(weakest.field > 50e6);
    for (size_t i = 0; i < POINTS; i++) {
        assert_int_equal(s[i].state, i <= edge_index(0.5) ? DEA_STATE_OK : DEA_STATE_BREAKDOWN);
    }
    free(s);
}

static void layers_have_their_own_thickness_and_field(void **state)
{
    (void)state;
    dea_scene one = profile_scene(DEA_DOT, 1.2, 0.5, 4500.0), five = one;
    dea_weakest weakest[2];
    five.actuator.layers = 5.0;
    dea_station *s[2] = {solve_profile(&one, "field", &weakest[0]), solve_profile(&five, "field", &weakest[1])};
    for (size_t i = 0; i < POINTS; i += 100) {
        assert_true(fabs(s[0][i].thickness / s[1][i].thickness - 1.0) <= 1e-9);
        assert_true(fabs(s[0][i].field - s[1][i].field) <= 1e-9 * s[0][0].field);
        assert_true(fabs(s[0][i].stress[0] / s[1][i].stress[0] - 1.0) <= 1e-7);
    }
    free(s[0]);
    free(s[1]);
}

static void past_pull_in_there_is_no_profile(void **state)
{
    (void)state;
    dea_scene scene = profile_scene(DEA_DOT, 1.0, 0.1, 40000.0);
    scene.material.constants[1] = scene.material.constants[2] = 0.0;
    dea_weakest weakest;
    dea_station *s = solve_profile(&scene, "field", &weakest);
    for (size_t i = 0; i < POINTS; i += 500) {
        assert_int_equal(s[i].state, DEA_STATE_PULL_IN);
        assert_true(isnan(s[i].displacement) && !isnan(s[i].radius));
    }
    assert_true(isnan(weakest.field) && isnan(weakest.tension));
    free(s);
}

static void models_without_an_annulus_of_two_stretches_are_refused(void **state)
{
    (void)state;
    static const char *const models[] = {"pelrine", "constant_force", "lumped", "lame"};
    const dea_scene scene = profile_scene(DEA_DOT, 1.2, 0.5, 4500.0);
    for (size_t i = 0; i < sizeof models / sizeof *models; i++) {
        assert_string_equal(dea_engine_refuses(dea_engine_find("direct"), &scene, dea_model_find(models[i])), "the model has no profile");
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(stretches_are_those_of_the_displacement),
        cmocka_unit_test(forces_balance_along_the_radius),
        cmocka_unit_test(charge_field_and_edge_are_those_of_the_row),
        cmocka_unit_test(the_weakest_places_are_among_the_stations),
        cmocka_unit_test(tension_is_lost_where_it_was_least),
        cmocka_unit_test(breakdown_is_local),
        cmocka_unit_test(layers_have_their_own_thickness_and_field),
        cmocka_unit_test(past_pull_in_there_is_no_profile),
        cmocka_unit_test(models_without_an_annulus_of_two_stretches_are_refused),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
