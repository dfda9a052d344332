/* Every law of the table: the check values of physics.md, twelve digits at tiny strains against plain formulas in long double, and
 * what happens at the end of an energy. */
#include "scenes.h"

/* A law by W = sum over principal stretches or invariants, in long double and without any factoring. */
typedef long double energy_function(const double *c, long double l1, long double l2);

static long double first(long double l1, long double l2)
{
    return l1 * l1 + l2 * l2 + 1.0L / (l1 * l1 * l2 * l2) - 3.0L;
}

static long double yeoh(const double *c, long double l1, long double l2)
{
    const long double j = first(l1, l2);
    return c[0] * j + c[1] * j * j + c[2] * j * j * j;
}

static long double neo_hookean(const double *c, long double l1, long double l2)
{
    return 0.5L * c[0] * first(l1, l2);
}

static long double mooney_rivlin(const double *c, long double l1, long double l2)
{
    return c[0] * first(l1, l2) + c[1] * first(1.0L / l1, 1.0L / l2);
}

static long double gent(const double *c, long double l1, long double l2)
{
    return -0.5L * c[0] * c[1] * logl(1.0L - first(l1, l2) / c[1]);
}

static long double ogden(const double *c, long double l1, long double l2)
{
    long double sum = 0.0L;
    for (int k = 0; k < 3; k++) {
        const long double a = c[2 * k + 1];
        sum += c[2 * k] / a * (powl(l1, a) + powl(l2, a) + powl(l1 * l2, -a) - 3.0L);
    }
    return sum;
}

static long double arruda_boyce(const double *c, long double l1, long double l2)
{
    static const long double shares[] = {0.5L, 1.0L / 20.0L, 11.0L / 1050.0L, 19.0L / 7000.0L, 519.0L / 673750.0L};
    const long double i1 = first(l1, l2) + 3.0L;
    long double sum = 0.0L;
    for (int i = 1; i <= 5; i++) {
        sum += shares[i - 1] * powl(c[1], 2.0L - 2.0L * i) * (powl(i1, i) - powl(3.0L, i));
    }
    return c[0] * sum;
}

static const struct {
    const char *name;
    energy_function *energy;
    double constants[DEA_LAW_CONSTANTS];
} laws[] = {
    {"yeoh", yeoh, {178426.0, -6023.0, 4234.0}},
    {"neo_hookean", neo_hookean, {44e3}},
    {"mooney_rivlin", mooney_rivlin, {16e3, 7.3e3}},
    {"gent", gent, {45e3, 120.0}},
    {"ogden", ogden, {43.4e3, 1.445, 84.2, 4.248, -2.4e3, -1.5}},
    {"arruda_boyce", arruda_boyce, {40e3, 5.99}},
};
enum { LAWS = sizeof laws / sizeof *laws };

static void every_law_is_tested(void **state)
{
    (void)state;
    assert_int_equal(dea_law_count(), LAWS);
    for (size_t i = 0; i < LAWS; i++) {
        assert_string_equal(dea_law_at(i)->name, laws[i].name);
        assert_true(dea_law_valid(dea_law_at(i), laws[i].constants));
    }
    assert_null(dea_law_find("hooke"));
}

static void check_values_to_all_printed_digits(void **state)
{
    (void)state;
    static const struct {
        size_t law;
        double stretch, p, y, w11, w12;
    } table[] = {{1, 1.2, 35117.386831, 176330.4527, 88206.5329, 29471.0219},
                 {3, 1.2, 36024.258416, 182037.5643, 90965.0260, 30712.7289},
                 {3, 3.0, 154092.191910, 362219.7158, 60440.5077, 8935.3336},
                 {2, 1.2, 42319.643621, 246053.6774, 106296.8909, 63481.4705},
                 {4, 1.2, 27786.053173, 143149.1101, 66049.6027, 30086.2781},
                 {4, 3.0, 94590.205011, 181713.4091, 17949.8355, 11091.2325},
                 {5, 3.0, 134153.403209, 303443.6858, 50635.3732, 5794.7210}};
    for (size_t i = 0; i < sizeof table / sizeof *table; i++) {
        const dea_law *law = dea_law_at(table[i].law);
        const double *c = laws[table[i].law].constants;
        const dea_stress at = dea_law_stress(law, c, table[i].stretch, table[i].stretch);
        assert_printed(at.p1, table[i].p, 6);
        assert_printed(at.p2, table[i].p, 6);
        assert_printed(dea_law_modulus(law, c, table[i].stretch), table[i].y, 4);
        assert_printed(at.w11, table[i].w11, 4);
        assert_printed(at.w22, table[i].w11, 4);
        assert_printed(at.w12, table[i].w12, 4);
    }
}

static dea_scene film_of(size_t law, dea_kind kind, double prestretch, double coverage, double voltage, double thickness)
{
    dea_scene scene = paper_scene(kind, prestretch, coverage, voltage);
    scene.material.law = dea_law_at(law);
    memcpy(scene.material.constants, laws[law].constants, sizeof laws[law].constants);
    scene.material.permittivity = 4.7;
    scene.actuator.film_thickness = thickness;
    return scene;
}

static dea_row solve(const dea_scene *scene, const char *model)
{
    dea_point point;
    dea_row row;
    dea_film_prepare(scene, &point.film);
    dea_point_place(scene, &point);
    assert_true(dea_point_valid(&point));
    dea_model_find(model)->solve(&point, 1e-9, &row);
    return row;
}

static void field_strains_to_all_printed_digits(void **state)
{
    (void)state;
    static const struct {
        size_t law;
        double prestretch, quarter, half;
    } table[] = {{1, 1.2, 0.133243925, 0.086303401}, {3, 1.2, 0.125225028, 0.082668409}, {3, 3.0, 0.019130848, 0.015170039},
                 {2, 1.2, 0.090688253, 0.064627546}, {4, 1.2, 0.292386280, 0.127274474}, {4, 3.0, 0.074849250, 0.057006838},
                 {5, 3.0, 0.023109621, 0.018275597}};
    for (size_t i = 0; i < sizeof table / sizeof *table; i++) {
        const bool thick = table[i].prestretch > 2.0;
        for (int k = 0; k < 2; k++) {
            const dea_scene scene = film_of(table[i].law, DEA_DOT, table[i].prestretch, k ? 0.5 : 0.25, thick ? 2500.0 : 4000.0,
                                            thick ? 1e-3 : 250e-6);
            assert_printed(solve(&scene, "field").strain, k ? table[i].half : table[i].quarter, 9);
        }
    }
}

/* Derivatives of the plain energy by central differences of order 8 in long double. */
static long double slope(energy_function *f, const double *c, long double l1, long double l2, int axis, long double h)
{
    static const long double weights[] = {4.0L / 5.0L, -1.0L / 5.0L, 4.0L / 105.0L, -1.0L / 280.0L};
    long double sum = 0.0L;
    for (int i = 1; i <= 4; i++) {
        const long double d1 = axis == 0 ? i * h : 0.0L, d2 = axis == 1 ? i * h : 0.0L;
        sum += weights[i - 1] * (f(c, l1 + d1, l2 + d2) - f(c, l1 - d1, l2 - d2));
    }
    return sum / h;
}

static void stresses_are_slopes_of_the_plain_energies(void **state)
{
    (void)state;
    static const double places[][2] = {{1.0, 1.0}, {1.2, 1.2}, {0.8, 1.4}, {1.4, 0.8}, {2.5, 3.0}, {1.0, 1.01}, {0.9, 0.9}};
    for (size_t i = 0; i < LAWS; i++) {
        for (size_t k = 0; k < sizeof places / sizeof *places; k++) {
            const double l1 = places[k][0], l2 = places[k][1];
            const double *c = laws[i].constants;
            const dea_law *law = dea_law_at(i);
            const dea_stress at = dea_law_stress(law, c, l1, l2), beside = dea_law_stress(law, c, l1 + 1e-3, l2);
            const double size = at.w11 + at.w22;
            assert_near(dea_law_energy(law, c, l1, l2), (double)laws[i].energy(c, l1, l2), 1e-13 * size);
            assert_near(at.p1, (double)slope(laws[i].energy, c, l1, l2, 0, 1e-2L), 1e-11 * size);
            assert_near(at.p2, (double)slope(laws[i].energy, c, l1, l2, 1, 1e-2L), 1e-11 * size);
            assert_near(at.shear, l1 == l2 ? at.w11 - at.w12 : (at.p2 - at.p1) / (l2 - l1), 1e-12 * size);
            assert_near(law->rise(c, l1, 1e-3, l2 - l1), beside.p1 - dea_law_stress(law, c, l1, l1).p1, 1e-13 * size);
            for (int axis = 0; axis < 2; axis++) { /* tangent moduli: slopes of the stresses */
                const double h = 1e-3;
                const double more = dea_law_stress(law, c, l1 + (axis ? 0.0 : h), l2 + (axis ? h : 0.0)).p1;
                const double less = dea_law_stress(law, c, l1 - (axis ? 0.0 : h), l2 - (axis ? h : 0.0)).p1;
                assert_near((more - less) / (2.0 * h), axis ? at.w12 : at.w11, 1e-4 * size);
            }
        }
    }
}

/* P1 of a plain energy in closed form, for differences at tiny strains: by long double and exact derivatives of W. */
static long double plain_stress(size_t law, const double *c, long double l1, long double l2)
{
    const long double thin = 1.0L / (l1 * l1 * l2 * l2), a = 2.0L * (l1 - thin / l1), j = first(l1, l2);
    long double sum = 0.0L;
    switch (law) {
    case 0:
        return a * (c[0] + 2.0L * c[1] * j + 3.0L * c[2] * j * j);
    case 1:
        return a * 0.5L * c[0];
    case 2:
        return a * (c[0] + c[1] * l2 * l2);
    case 3:
        return a * 0.5L * c[0] * c[1] / (c[1] - j);
    case 4:
        for (int k = 0; k < 3; k++) {
            sum += c[2 * k] * (powl(l1, c[2 * k + 1]) - powl(l1 * l2, -c[2 * k + 1])) / l1;
        }
        return sum;
    default:
        for (int i = 1; i <= 5; i++) {
            static const long double shares[] = {0.5L, 1.0L / 20.0L, 11.0L / 1050.0L, 19.0L / 7000.0L, 519.0L / 673750.0L};
            sum += i * shares[i - 1] * powl(c[1], 2.0L - 2.0L * i) * powl(j + 3.0L, i - 1);
        }
        return a * c[0] * sum;
    }
}

/* The plain difference has an error of some 1e-19 of the stress: at a strain e it is good to 1e-19/e, which the step e (1 + e)
 * larger than 1e-7 allows to compare to 1e-12. Below that the law must be linear plus quadratic in e. */
static void changes_keep_twelve_digits_at_any_strain(void **state)
{
    (void)state;
    static const double strains[] = {1e-2, 1e-4, 1e-6, 1e-9, 1e-12};
    static const double prestretches[] = {1.0, 1.2, 3.0};
    for (size_t i = 0; i < LAWS; i++) {
        for (size_t k = 0; k < 3; k++) {
            const double *c = laws[i].constants, l = prestretches[k];
            const dea_law *law = dea_law_at(i);
            const dea_film film = dea_law_film(law, c, l);
            const dea_stress rest = dea_law_stress(law, c, l, l);
            for (size_t n = 0; n < 5; n++) {
                const double e = strains[n];
                dea_change change;
                law->change(&film, 1, &e, &change);
                const double rise = law->rise(c, l, l * e, 0.0);
                const long double up = l * (1.0L + e);
                if (e >= 1e-6) {
                    const long double plain = up * plain_stress(i, c, up, up) - l * plain_stress(i, c, l, l);
                    assert_relative(change.value, (double)plain, 1e-12);
                    assert_relative(rise, (double)(plain_stress(i, c, up, l) - plain_stress(i, c, l, l)), 1e-12);
                } else {
                    assert_relative(change.value, e * l * film.slope * (1.0 + 0.5 * e * l * film.curvature / film.slope), 1e-12);
                    const double near = 1e-6, bend = (law->rise(c, l, l * near, 0.0) / (l * near * rest.w11) - 1.0) / near;
                    assert_relative(rise, l * e * rest.w11 * (1.0 + bend * e), 1e-12);
                }
            }
        }
    }
}

/* A stretch that is a small difference of the pre-stretch and its change: the power of it, not of that difference, counts. */
static void a_film_squeezed_to_a_tenth_keeps_its_digits(void **state)
{
    (void)state;
    static const double strains[] = {-0.5, -0.8, -0.88, -0.95};
    size_t compared = 0;
    for (size_t i = 0; i < LAWS; i++) {
        const double *c = laws[i].constants, l = 2.6;
        const dea_film film = dea_law_film(dea_law_at(i), c, l);
        for (size_t n = 0; n < 4; n++) {
            const long double there = l * (1.0L + strains[n]);
            dea_change change;
            dea_law_at(i)->change(&film, 1, &strains[n], &change);
            if (-strains[n] < film.shrinks) {
                const long double plain = there * plain_stress(i, c, there, there) - l * plain_stress(i, c, l, l);
                assert_relative(change.value, (double)plain, 2e-14);
                compared++;
            }
        }
    }
    assert_true(compared > 4 * LAWS - 4);
}

/* Of a small equi-biaxial strain e: sigma = 6 mu e, W = 6 mu e^2, W11 = 4 mu at rest. */
static void energies_keep_their_digits_near_rest(void **state)
{
    (void)state;
    for (size_t i = 0; i < LAWS; i++) {
        const double *c = laws[i].constants;
        const dea_law *law = dea_law_at(i);
        const double w11 = dea_law_stress(law, c, 1.0, 1.0).w11; /* 4 mu */
        for (double e = 1e-6; e > 1e-13; e *= 1e-3) {
            const double l = 1.0 + e, strain = l - 1.0;
            assert_relative(dea_law_energy(law, c, l, l), 1.5 * w11 * strain * strain, 20.0 * strain + 1e-12);
            assert_relative(dea_law_equibiaxial(law, c, l), 1.5 * w11 * strain, 20.0 * strain + 1e-12);
        }
    }
}

/* Under a voltage that gives the strain e the models are linear: load over stiffness, and the next order from a load ten times
 * larger is no more than ten times e. */
static void models_keep_twelve_digits_at_tiny_strains(void **state)
{
    (void)state;
    static const char *const models[] = {"pelrine", "constant_force", "lumped", "coverage", "lame", "ring", "field"};
    for (size_t i = 0; i < LAWS; i++) {
        for (size_t m = 0; m < 7; m++) {
            for (int kind = DEA_DOT; kind <= DEA_LENS; kind++) {
                const dea_model *model = dea_model_find(models[m]);
                if (kind == DEA_LENS && !model->lens) {
                    continue;
                }
                dea_scene scene = film_of(i, (dea_kind)kind, 1.2, 0.4, 1.0, 1e-4);
                const double unit = fabs(solve(&scene, models[m]).strain); /* at 1 V some 1e-9 */
                double ratio[4];
                static const double targets[] = {1e-6, 1e-9, 1e-12, 1e-15};
                for (int k = 0; k < 4; k++) {
                    scene.drive.voltage = sqrt(targets[k] / unit);
                    const double square = scene.drive.voltage * scene.drive.voltage;
                    ratio[k] = solve(&scene, models[m]).strain / square;
                }
                /* strain/U^2 = a + b strain: b from the largest, and the others agree */
                const double bend = (ratio[0] - ratio[3]) / targets[0];
                assert_relative(ratio[1], ratio[3] + bend * targets[1], 1e-12);
                assert_relative(ratio[2], ratio[3] + bend * targets[2], 1e-12);
                assert_true(fabs(bend) < 100.0 * fabs(ratio[3]));
            }
        }
    }
}

/* A film of Gent near its end: whatever the voltage a row is a strain below the end, or a state; past Jm it is no film. */
static void gent_ends_in_a_state_and_never_in_nan(void **state)
{
    (void)state;
    static const char *const models[] = {"pelrine", "constant_force", "lumped", "coverage", "lame", "ring", "field"};
    for (double jm = 3.0; jm < 30.0; jm *= 1.7) {
        for (size_t m = 0; m < 7; m++) {
            for (double voltage = 500.0; voltage < 2e5; voltage *= 1.7) {
                dea_scene scene = film_of(3, DEA_DOT, 1.3, 0.3, voltage, 1e-4);
                scene.material.constants[1] = jm;
                const dea_row row = solve(&scene, models[m]);
                if (isnan(row.strain)) {
                    assert_true(row.state == DEA_STATE_PULL_IN);
                } else if (strcmp(models[m], "coverage") == 0 || strcmp(models[m], "field") == 0) {
                    const double l = 1.3 * (1.0 + row.strain);
                    assert_true(2.0 * l * l + 1.0 / (l * l * l * l) - 3.0 < jm);
                }
            }
        }
    }
    dea_scene scene = film_of(3, DEA_DOT, 3.0, 0.3, 100.0, 1e-4);
    dea_point point;
    scene.material.constants[1] = 15.0;
    dea_film_prepare(&scene, &point.film);
    dea_point_place(&scene, &point);
    assert_false(dea_point_valid(&point));
    assert_true(isnan(dea_law_stress(dea_law_find("gent"), scene.material.constants, 3.0, 3.0).p1));
}

static void long_term_share_scales_moduli_alone(void **state)
{
    (void)state;
    for (size_t i = 0; i < LAWS; i++) {
        dea_scene scene = film_of(i, DEA_DOT, 1.2, 0.5, 0.0, 1e-4);
        double constants[DEA_LAW_CONSTANTS];
        scene.material.instantaneous = true;
        scene.material.prony_count = 1;
        scene.material.prony[0] = (dea_prony){.g = 0.25, .tau = 1.0};
        dea_material_long_term(&scene.material, constants);
        const dea_stress given = dea_law_stress(dea_law_at(i), laws[i].constants, 1.5, 1.2);
        const dea_stress relaxed = dea_law_stress(dea_law_at(i), constants, 1.5, 1.2);
        assert_relative(relaxed.p1, 0.75 * given.p1, 1e-14);
        assert_relative(relaxed.w12, 0.75 * given.w12, 1e-14);
    }
}

static void scenes_settings_and_axes_name_the_constants_of_a_law(void **state)
{
    (void)state;
    static const char text[] =
        "actuator: {kind: dot, frame_radius: 30 mm, coverage: 0.5, film_thickness: 250 um, prestretch: 1.2}\n"
        "material: {ogden: [{mu: 43.4 kPa, alpha: 1.445}, {mu: -2.4 kPa, alpha: -1.5}], permittivity: 4.7}\n"
        "drive: {voltage: 4 kV}\nmodel: lumped\nstudy: {sweep: {ogden.1.mu: [-2 kPa, -1 kPa]}}\n";
    const dea_setting one = {"material.ogden.0.alpha=1.5"};
    const dea_setting other[] = {{"material.gent={mu: 45 kPa, Jm: 120}"}, {"Jm=30"}, {"study.sweep={gent.mu: [40 kPa, 50 kPa]}"}};
    const dea_setting wrong = {"material.gent.mu=45 kPa"};
    dea_scene scene;
    dea_error error = {0};
    assert_int_equal(dea_scene_parse(text, strlen(text), "scene", ".", &one, 1, NULL, &scene, &error), DEA_OK);
    assert_ptr_equal(scene.material.law, dea_law_find("ogden"));
    assert_int_equal(scene.material.entry_count, 2);
    const double wanted[DEA_LAW_CONSTANTS] = {43.4e3, 1.5, -2.4e3, -1.5};
    assert_memory_equal(scene.material.constants, wanted, sizeof wanted);
    assert_int_equal(scene.axes[0].offset, offsetof(dea_scene, material.constants[2]));
    assert_string_equal(scene.axes[0].column, "ogden_1_mu_Pa");
    assert_true(scene.axes[0].changes_film);
    dea_scene_free(&scene);
    assert_int_equal(dea_scene_parse(text, strlen(text), "scene", ".", other, 3, NULL, &scene, &error), DEA_OK);
    assert_ptr_equal(scene.material.law, dea_law_find("gent"));
    assert_true(scene.material.constants[0] == 45e3 && scene.material.constants[1] == 30.0 && scene.material.constants[2] == 0.0);
    assert_string_equal(scene.axes[0].column, "mu_Pa");
    dea_scene_free(&scene);
    assert_int_equal(dea_scene_parse(text, strlen(text), "scene", ".", &wrong, 1, NULL, &scene, &error), DEA_ERROR_SCENE);
    assert_non_null(strstr(error.message, "--set material.gent.mu=45 kPa: material.gent.mu: belongs to the law gent, but that of the "
                                          "material is ogden; accepted: constants of material.ogden, or all of material.gent as "));
}

static void constants_that_give_no_film_are_refused(void **state)
{
    (void)state;
    static const struct {
        const char *law;
        double constants[DEA_LAW_CONSTANTS];
    } table[] = {{"yeoh", {0.0, 1.0, 1.0}},   {"neo_hookean", {-1.0}},        {"mooney_rivlin", {1.0, -1.0}}, {"gent", {1.0, 0.0}},
                 {"gent", {0.0, 10.0}},       {"ogden", {-1.0, 2.0}},         {"ogden", {1.0, 0.0}},          {"ogden", {0.0, 0.0}},
                 {"arruda_boyce", {1.0, 1.0}}, {"arruda_boyce", {(double)NAN, 2.0}}};
    for (size_t i = 0; i < sizeof table / sizeof *table; i++) {
        assert_false(dea_law_valid(dea_law_find(table[i].law), table[i].constants));
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(every_law_is_tested),
        cmocka_unit_test(check_values_to_all_printed_digits),
        cmocka_unit_test(field_strains_to_all_printed_digits),
        cmocka_unit_test(stresses_are_slopes_of_the_plain_energies),
        cmocka_unit_test(changes_keep_twelve_digits_at_any_strain),
        cmocka_unit_test(a_film_squeezed_to_a_tenth_keeps_its_digits),
        cmocka_unit_test(energies_keep_their_digits_near_rest),
        cmocka_unit_test(models_keep_twelve_digits_at_tiny_strains),
        cmocka_unit_test(gent_ends_in_a_state_and_never_in_nan),
        cmocka_unit_test(long_term_share_scales_moduli_alone),
        cmocka_unit_test(scenes_settings_and_axes_name_the_constants_of_a_law),
        cmocka_unit_test(constants_that_give_no_film_are_refused),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
