/* The Yeoh film: numbers of the base paper's material, and stresses and moduli against the energy they come from. */
#include "scenes.h"

static const double elastosil[DEA_LAW_CONSTANTS] = {178426.0, -6023.0, 4234.0};
static const double softening[DEA_LAW_CONSTANTS] = {40e3, -8e3, 1.2e3};

static dea_stress stress_of(const double *yeoh, double l1, double l2)
{
    return dea_law_stress(dea_law_find("yeoh"), yeoh, l1, l2);
}

static double energy_of(const double *yeoh, double l1, double l2)
{
    return dea_law_energy(dea_law_find("yeoh"), yeoh, l1, l2);
}

static double cauchy_of(const double *yeoh, double l)
{
    return dea_law_equibiaxial(dea_law_find("yeoh"), yeoh, l);
}

static double modulus_of(const double *yeoh, double l)
{
    return dea_law_modulus(dea_law_find("yeoh"), yeoh, l);
}

/* Central difference of order 2 at h and h/2, and the rate at which it approaches @p exact: 4 where the derivative is right. */
typedef double scalar_function(const double *yeoh, double l1, double l2);

static double difference(scalar_function *f, const double *yeoh, double l1, double l2, bool first, double h)
{
    return first ? (f(yeoh, l1 + h, l2) - f(yeoh, l1 - h, l2)) / (2.0 * h)
                 : (f(yeoh, l1, l2 + h) - f(yeoh, l1, l2 - h)) / (2.0 * h);
}

static void check_derivative(scalar_function *f, const double *yeoh, double l1, double l2, bool first, double exact)
{
    const double coarse = difference(f, yeoh, l1, l2, first, 2e-3) - exact;
    const double fine = difference(f, yeoh, l1, l2, first, 1e-3) - exact;
    const double extrapolated = exact + (4.0 * fine - coarse) / 3.0;
    const double scale = fabs(exact) + yeoh[0];
    assert_near(extrapolated, exact, 1e-8 * scale);
    if (fabs(fine) > 1e-8 * scale) {
        assert_near(coarse / fine, 4.0, 0.05);
    }
}

static double stress_1(const double *yeoh, double l1, double l2)
{
    return stress_of(yeoh, l1, l2).p1;
}

static double stress_2(const double *yeoh, double l1, double l2)
{
    return stress_of(yeoh, l1, l2).p2;
}

static double equibiaxial_stress(const double *yeoh, double l1, double l2)
{
    (void)l2;
    return cauchy_of(yeoh, l1);
}

static const double stretches[][2] = {{1.0, 1.0}, {1.1, 1.1}, {1.3, 1.3},  {0.8, 1.4},
                                      {1.4, 0.8}, {2.0, 1.2}, {1.02, 1.0}, {3.0, 2.5}};
enum { STRETCHES = sizeof stretches / sizeof stretches[0] };

static void stresses_are_slopes_of_the_energy(void **state)
{
    (void)state;
    for (size_t i = 0; i < STRETCHES; i++) {
        const double l1 = stretches[i][0];
        const double l2 = stretches[i][1];
        const dea_stress at = stress_of(elastosil, l1, l2);
        check_derivative(energy_of, elastosil, l1, l2, true, at.p1);
        check_derivative(energy_of, elastosil, l1, l2, false, at.p2);
        const dea_stress soft = stress_of(softening, l1, l2);
        check_derivative(energy_of, softening, l1, l2, true, soft.p1);
    }
}

static void moduli_are_slopes_of_the_stresses(void **state)
{
    (void)state;
    for (size_t i = 0; i < STRETCHES; i++) {
        const double l1 = stretches[i][0];
        const double l2 = stretches[i][1];
        const dea_stress at = stress_of(elastosil, l1, l2);
        check_derivative(stress_1, elastosil, l1, l2, true, at.w11);
        check_derivative(stress_1, elastosil, l1, l2, false, at.w12);
        check_derivative(stress_2, elastosil, l1, l2, true, at.w12);
        check_derivative(stress_2, elastosil, l1, l2, false, at.w22);
    }
}

static void operating_modulus_is_the_slope_of_the_cauchy_stress(void **state)
{
    (void)state;
    for (double l = 1.0; l < 3.0; l += 0.1) {
        check_derivative(equibiaxial_stress, elastosil, l, l, true, modulus_of(elastosil, l));
        check_derivative(equibiaxial_stress, softening, l, l, true, modulus_of(softening, l));
    }
}

static void moduli_of_the_base_paper_to_all_printed_digits(void **state)
{
    (void)state;
    static const double table[][4] = {{1.1, 1641976.87, 946538.03, 391713.34},
                                      {1.2, 1391085.27, 697321.54, 228160.57},
                                      {1.3, 1369207.21, 599710.82, 173813.87}};
    for (size_t i = 0; i < 3; i++) {
        const double l = table[i][0];
        const dea_stress at = stress_of(elastosil, l, l);
        assert_printed(modulus_of(elastosil, l), table[i][1], 2);
        assert_printed(at.w11, table[i][2], 2);
        assert_printed(at.w12, table[i][3], 2);
    }
}

static void film_holds_the_moduli_of_its_material(void **state)
{
    (void)state;
    for (double l = 1.0; l < 2.0; l += 0.125) {
        dea_scene scene = paper_scene(DEA_DOT, l, 0.5, 0.0);
        dea_film film;
        dea_film_prepare(&scene, &film);
        const dea_stress at = stress_of(elastosil, l, l);
        assert_relative(film.slope, modulus_of(elastosil, l), 1e-14);
        assert_relative(film.modulus, film.slope, 0.0);
        assert_relative(film.w11, at.w11, 1e-14);
        assert_relative(film.w12, at.w12, 1e-14);
        assert_near(film.tension, at.p1, 1e-14 * at.w11);
        const double h =
            1e-4; /* error of the difference: h^2/6 of the fourth derivative of the stress, below 2e-7 of the slope */
        const double bend = (modulus_of(elastosil, l + h) - modulus_of(elastosil, l - h)) / (2.0 * h);
        assert_near(film.curvature, bend, 1e-5 * film.slope);
        scene.material.modulus = 1.2e6;
        dea_film_prepare(&scene, &film);
        assert_relative(film.modulus, 1.2e6, 0.0);
    }
}

static void cauchy_stress_is_stretch_times_nominal_stress(void **state)
{
    (void)state;
    for (double l = 0.7; l < 3.0; l += 0.1) {
        assert_near(cauchy_of(elastosil, l), l * stress_of(elastosil, l, l).p1,
                    1e-13 * modulus_of(elastosil, l));
    }
}

/* W = C1 (4 (e1^2 + e1 e2 + e2^2)) to second order in small e; sigma = 12 C1 e. */
static void small_stretches_keep_their_digits(void **state)
{
    (void)state;
    for (double e = 1e-3; e > 1e-14; e *= 0.1) {
        const double l = 1.0 + e;
        const double strain = l - 1.0; /* what l holds after rounding */
        assert_relative(cauchy_of(elastosil, l), 12.0 * elastosil[0] * strain, 5.0 * strain + 1e-14);
        assert_relative(energy_of(elastosil, l, l), 12.0 * elastosil[0] * strain * strain, 5.0 * strain + 1e-14);
        assert_relative(stress_of(elastosil, l, 1.0).p1, 8.0 * elastosil[0] * strain, 5.0 * strain + 2e-16 / strain);
    }
}

static void uniaxial_energy_is_that_of_the_invariant(void **state)
{
    (void)state;
    for (double l = 0.5; l < 3.0; l += 0.25) {
        const double i = l * l + 2.0 / l - 3.0;
        const double energy = elastosil[0] * i + elastosil[1] * i * i + elastosil[2] * i * i * i;
        assert_near(energy_of(elastosil, l, 1.0 / sqrt(l)), energy, 1e-13 * (energy + elastosil[0]));
    }
}

static void instantaneous_constants_relax_to_their_long_term_share(void **state)
{
    (void)state;
    dea_material material = paper_material();
    double yeoh[DEA_LAW_CONSTANTS];
    material.prony_count = 2;
    material.prony[0] = (dea_prony){.g = 0.2, .tau = 0.5};
    material.prony[1] = (dea_prony){.g = 0.15, .tau = 5.0};
    assert_relative(dea_material_long_term_share(&material), 1.0, 0.0);
    material.instantaneous = true;
    assert_relative(dea_material_long_term_share(&material), 0.65, 1e-15);
    dea_material_long_term(&material, yeoh);
    for (int i = 0; i < DEA_YEOH_TERMS; i++) {
        assert_relative(yeoh[i], 0.65 * elastosil[i], 1e-15);
    }
}

static void permittivity_falls_with_stretch(void **state)
{
    (void)state;
    dea_material material = paper_material();
    assert_relative(dea_material_permittivity(&material, 1.7), 2.8, 0.0);
    material.permittivity = 2.76;
    material.permittivity_per_stretch = -0.28;
    assert_relative(dea_material_permittivity(&material, 1.5), 2.34, 1e-15);
    dea_scene scene = paper_scene(DEA_DOT, 1.5, 0.5, 0.0);
    scene.material = material;
    dea_film film;
    dea_film_prepare(&scene, &film);
    assert_relative(film.permittivity, 2.34 * 8.8541878128e-12, 1e-15);
}

static void built_in_elastosil_is_that_of_the_base_paper(void **state)
{
    (void)state;
    const dea_material *material = dea_material_find("elastosil-2030");
    assert_non_null(material);
    for (int i = 0; i < DEA_YEOH_TERMS; i++) {
        assert_relative(material->constants[i], elastosil[i], 0.0);
    }
    assert_relative(material->permittivity, 2.8, 0.0);
    assert_false(material->instantaneous);
    assert_null(dea_material_find("rubber of nobody"));
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(stresses_are_slopes_of_the_energy),
        cmocka_unit_test(moduli_are_slopes_of_the_stresses),
        cmocka_unit_test(operating_modulus_is_the_slope_of_the_cauchy_stress),
        cmocka_unit_test(moduli_of_the_base_paper_to_all_printed_digits),
        cmocka_unit_test(film_holds_the_moduli_of_its_material),
        cmocka_unit_test(cauchy_stress_is_stretch_times_nominal_stress),
        cmocka_unit_test(small_stretches_keep_their_digits),
        cmocka_unit_test(uniaxial_energy_is_that_of_the_invariant),
        cmocka_unit_test(instantaneous_constants_relax_to_their_long_term_share),
        cmocka_unit_test(permittivity_falls_with_stretch),
        cmocka_unit_test(built_in_elastosil_is_that_of_the_base_paper),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
