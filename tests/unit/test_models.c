/* The static models: printed numbers, statements of the base paper, limits, symmetries, and judges that solve the same equations
 * another way. */
#include "judges.h"

static const char *const all_models[] = {"pelrine", "constant_force", "lumped", "coverage", "lame", "ring", "field"};
static const char *const lens_models[] = {"lumped", "coverage", "lame", "ring", "field"};
enum { ALL_MODELS = 7, LENS_MODELS = 5 };

static double paper_strain(const char *model, dea_kind kind, double prestretch, double coverage, double voltage)
{
    const dea_row row = solve_paper(model, kind, prestretch, coverage, voltage);
    assert_state(row, DEA_STATE_OK);
    return row.strain;
}

static void strains_at_4500_volts_to_all_printed_digits(void **state)
{
    (void)state;
    static const struct {
        double prestretch, coverage, eq18, eq22, lame, field, lens_eq18, lens_field;
    } table[] = {
        {1.1, 0.10, 0.04587737, 0.04028821, 0.03511406, 0.03762647, -0.03568750, -0.02932674},
        {1.1, 0.50, 0.02218118, 0.02238234, 0.02593914, 0.02651626, -0.02218118, -0.02338631},
        {1.2, 0.25, 0.05973380, 0.05612602, 0.05689016, 0.06092621, -0.04860329, -0.04432166},
        {1.2, 0.50, 0.03569962, 0.03741735, 0.04400989, 0.04503297, -0.03569962, -0.03741631},
        {1.3, 0.75, 0.02204766, 0.02618038, 0.03411473, 0.03289753, -0.02597732, -0.03263280},
    };
    for (size_t i = 0; i < sizeof table / sizeof table[0]; i++) {
        const double l = table[i].prestretch;
        const double b = table[i].coverage;
        assert_printed(paper_strain("coverage", DEA_DOT, l, b, 4500.0), table[i].eq18, 8);
        assert_printed(paper_strain("lumped", DEA_DOT, l, b, 4500.0), table[i].eq22, 8);
        assert_printed(paper_strain("lame", DEA_DOT, l, b, 4500.0), table[i].lame, 8);
        assert_printed(paper_strain("field", DEA_DOT, l, b, 4500.0), table[i].field, 8);
        assert_printed(paper_strain("coverage", DEA_LENS, l, b, 4500.0), table[i].lens_eq18, 8);
        assert_printed(paper_strain("field", DEA_LENS, l, b, 4500.0), table[i].lens_field, 8);
    }
}

/* Relative error of the strain against the exact membrane: physics.md, section 7, and the bound over all films of the paper. */
static void rings_lie_next_to_the_membrane(void **state)
{
    (void)state;
    static const double printed[][3] = {{1.1, 0.1, 2e-5}, {1.2, 0.5, 6e-5}, {1.3, 0.75, 5e-5}};
    for (size_t i = 0; i < 3; i++) {
        const double field = paper_strain("field", DEA_DOT, printed[i][0], printed[i][1], 4500.0);
        const double error = paper_strain("ring", DEA_DOT, printed[i][0], printed[i][1], 4500.0) / field - 1.0;
        assert_printed(1e5 * error, 1e5 * printed[i][2], 0);
    }
    for (int kind = DEA_DOT; kind <= DEA_LENS; kind++) {
        for (double l = 1.1; l < 1.35; l += 0.1) {
            for (double b = 0.1; b < 0.95; b += 0.1) {
                const double field = paper_strain("field", (dea_kind)kind, l, b, 4500.0);
                assert_relative(paper_strain("ring", (dea_kind)kind, l, b, 4500.0), field, fmax(2e-4, 0.08 * field * field));
            }
        }
    }
}

static void free_film_strains_to_all_printed_digits(void **state)
{
    (void)state;
    static const double table[][3] = {
        {1.1, 0.05309062, 0.02316297}, {1.2, 0.08987201, 0.03965760}, {1.3, 0.11020732, 0.05686845}};
    for (size_t i = 0; i < 3; i++) {
        assert_printed(paper_strain("constant_force", DEA_DOT, table[i][0], 0.5, 4500.0), table[i][1], 8);
        assert_printed(paper_strain("pelrine", DEA_DOT, table[i][0], 0.5, 4500.0), table[i][2], 8);
    }
}

static double displacement(const char *model, double prestretch, double coverage, double voltage)
{
    return solve_paper(model, DEA_DOT, prestretch, coverage, voltage).displacement;
}

static void smaller_coverage_costs_what_the_paper_says(void **state)
{
    (void)state;
    const double at_50 = displacement("lumped", 1.2, 0.5, 4500.0);
    const double at_25 = displacement("lumped", 1.2, 0.25, 4500.0);
    assert_relative(1.0 - displacement("lumped", 1.2, 0.48, 4500.0) / at_50, 0.0016, 1e-10);
    assert_printed(100.0 * (1.0 - displacement("lumped", 1.2, 0.24, 4500.0) / at_25), 2.72, 2);
}

/* Coverage of the largest displacement, by golden section. */
static double best_coverage(const char *model, double prestretch, double voltage)
{
    const double golden = 0.5 * (sqrt(5.0) - 1.0);
    double low = 0.05;
    double high = 0.95;
    while (high - low > 1e-9) {
        const double x1 = high - golden * (high - low);
        const double x2 = low + golden * (high - low);
        *(displacement(model, prestretch, x1, voltage) > displacement(model, prestretch, x2, voltage) ? &high : &low) =
            displacement(model, prestretch, x1, voltage) > displacement(model, prestretch, x2, voltage) ? x2 : x1;
    }
    return 0.5 * (low + high);
}

static void displacement_peaks_at_half_coverage(void **state)
{
    (void)state;
    for (double l = 1.1; l < 1.35; l += 0.1) {
        assert_near(best_coverage("lumped", l, 4500.0), 0.5, 1e-7);
    }
}

static void hyperelastic_displacement_peaks_slightly_below_half_coverage(void **state)
{
    (void)state;
    for (double l = 1.1; l < 1.35; l += 0.1) {
        const double best = best_coverage("coverage", l, 4500.0);
        assert_true(best < 0.47 && best > 0.44);
    }
}

static void plane_elastic_displacement_peaks_at_one_over_root_three(void **state)
{
    (void)state;
    assert_near(best_coverage("lame", 1.2, 1.0), 1.0 / sqrt(3.0), 1e-6);
    assert_near(best_coverage("ring", 1.2, 1.0), 1.0 / sqrt(3.0), 1e-6);
    assert_near(best_coverage("field", 1.2, 1.0), 1.0 / sqrt(3.0), 1e-6);
}

static void small_electrode_strains_as_under_a_constant_bias_force(void **state)
{
    (void)state;
    for (double l = 1.1; l < 1.35; l += 0.1) {
        const double bound = paper_strain("constant_force", DEA_DOT, l, 0.5, 4500.0);
        const double at_4 = bound - paper_strain("coverage", DEA_DOT, l, 1e-4, 4500.0);
        const double at_5 = bound - paper_strain("coverage", DEA_DOT, l, 1e-5, 4500.0);
        assert_true(at_5 > 0.0 && at_5 < 1e-5);
        assert_relative(at_4 / at_5, 10.0, 1e-2);
    }
}

static void full_coverage_leaves_no_strain(void **state)
{
    (void)state;
    for (size_t i = 0; i < LENS_MODELS; i++) {
        const double at_3 = paper_strain(lens_models[i], DEA_DOT, 1.2, 1.0 - 1e-3, 4500.0);
        const double at_4 = paper_strain(lens_models[i], DEA_DOT, 1.2, 1.0 - 1e-4, 4500.0);
        assert_true(at_3 > 0.0 && at_3 < 2e-4);
        assert_relative(at_3 / at_4, 10.0, 1e-2);
    }
}

static void linear_strain_is_below_hyperelastic_at_small_coverage_least_at_the_largest_pre_stretch(void **state)
{
    (void)state;
    for (double b = 0.02; b < 0.2; b += 0.02) {
        double gap[3];
        for (int i = 0; i < 3; i++) {
            const double full = paper_strain("coverage", DEA_DOT, 1.1 + 0.1 * i, b, 4500.0);
            gap[i] = 1.0 - paper_strain("lumped", DEA_DOT, 1.1 + 0.1 * i, b, 4500.0) / full;
        }
        assert_true(gap[2] > 0.0 && gap[2] < 0.5 * gap[0] && gap[2] < 0.5 * gap[1]);
    }
}

/* mu (l^2 - l^-4) = eps l^4 (U/H)^2 folds at l^6 = 4, U/H = 0.6874 sqrt(mu/eps); near it l = l_c -+ sqrt(4 d f/|f''|) at
 * U = U_c (1 - d), f = l^-2 - l^-8. */
static void free_neo_hookean_film_pulls_in_at_the_known_stretch(void **state)
{
    (void)state;
    const double critical = pow(4.0, 1.0 / 6.0);
    const double f = pow(critical, -2.0) - pow(critical, -8.0);
    const double bend = fabs(6.0 * pow(critical, -4.0) - 72.0 * pow(critical, -10.0));
    const double mu = 40e3;
    dea_scene scene = paper_scene(DEA_DOT, 1.0, 0.5, 0.0);
    scene.material.constants[0] = 0.5 * mu;
    scene.material.constants[1] = scene.material.constants[2] = 0.0;
    const double nominal = sqrt(mu * f / (2.8 * DEA_EPSILON_0));
    assert_printed(nominal / sqrt(mu / (2.8 * DEA_EPSILON_0)), 0.6874, 4);
    for (double d = 1e-4; d > 5e-12; d *= 0.1) {
        scene.drive.voltage = nominal * 1e-4 * (1.0 - d);
        dea_row row = solve_direct(&scene, "constant_force");
        assert_state(row, DEA_STATE_OK);
        const double below = sqrt(4.0 * d * f / bend);
        assert_near(1.0 + row.strain, critical - below, 5.0 * below * below + 1e-9);
        scene.drive.voltage = nominal * 1e-4 * (1.0 + d);
        row = solve_direct(&scene, "constant_force");
        assert_state(row, DEA_STATE_PULL_IN);
        assert_true(isnan(row.strain) && isnan(row.displacement) && isnan(row.force) && isnan(row.field));
    }
}

static double defect(const char *model, dea_kind kind, double coverage, double voltage)
{
    return paper_strain(model, kind, 1.2, coverage, voltage) / paper_strain("field", kind, 1.2, coverage, voltage) - 1.0;
}

static void plane_elasticity_approaches_the_field_with_second_order(void **state)
{
    (void)state;
    for (int kind = DEA_DOT; kind <= DEA_LENS; kind++) {
        for (double b = 0.15; b < 0.95; b += 0.25) {
            const double coarse = defect("lame", (dea_kind)kind, b, 400.0);
            const double fine = defect("lame", (dea_kind)kind, b, 200.0);
            assert_relative(coarse / fine, 4.0, 0.01);
            assert_true(fabs(fine) < 1e-3);
        }
    }
}

static void lens_is_the_opposite_of_a_dot_at_small_voltage(void **state)
{
    (void)state;
    static const char *const models[] = {"lame", "ring", "field"};
    for (size_t i = 0; i < 3; i++) {
        for (double b = 0.1; b < 0.95; b += 0.2) {
            double sum[2];
            for (int k = 0; k < 2; k++) {
                const double voltage = k ? 100.0 : 200.0;
                sum[k] =
                    paper_strain(models[i], DEA_DOT, 1.2, b, voltage) / paper_strain(models[i], DEA_LENS, 1.2, b, voltage) + 1.0;
            }
            assert_true(fabs(sum[0]) < 2e-3);
            assert_relative(sum[0] / sum[1], 4.0, 0.01);
        }
    }
}

/* C = eps pi r_a^2 lambda_pre^2 lambda_a^4/H of a dot, eps pi lambda_pre^2 (r^2 - r_l^2 lambda_c^2)^2/((r^2 - r_l^2) H) of a
 * lens. */
static double true_capacitance(const dea_scene *scene, double u)
{
    const dea_actuator *a = &scene->actuator;
    const double r = a->frame_radius;
    const double divide = a->coverage * r;
    const double edge = divide + u;
    const double eps = DEA_EPSILON_0 * dea_material_permittivity(&scene->material, a->prestretch);
    const double film = eps * 3.14159265358979323846 * a->prestretch * a->prestretch / a->film_thickness;
    if (a->kind == DEA_DOT) {
        return film * pow(edge, 4.0) / (divide * divide);
    }
    return film * pow(r * r - edge * edge, 2.0) / (r * r - divide * divide);
}

static double capacitance_slope(const dea_scene *scene, double u)
{
    const double h = 1e-4 * scene->actuator.coverage * scene->actuator.frame_radius;
    const double coarse = (true_capacitance(scene, u + 2.0 * h) - true_capacitance(scene, u - 2.0 * h)) / (4.0 * h);
    const double fine = (true_capacitance(scene, u + h) - true_capacitance(scene, u - h)) / (2.0 * h);
    return (4.0 * fine - coarse) / 3.0;
}

static void force_of_a_dot_is_the_slope_of_its_electric_energy(void **state)
{
    (void)state;
    static const char *const models[] = {"constant_force", "coverage", "ring", "field"};
    for (size_t i = 0; i < 4; i++) {
        for (double b = 0.1; b < 0.95; b += 0.2) {
            dea_scene scene = paper_scene(DEA_DOT, 1.2, b, 4500.0);
            scene.material.permittivity_per_stretch = -0.28;
            const dea_row row = solve_direct(&scene, models[i]);
            assert_relative(row.force, 0.5 * 4500.0 * 4500.0 * capacitance_slope(&scene, row.displacement), 1e-10);
        }
    }
}

static void force_at_rest_is_the_slope_of_the_electric_energy(void **state)
{
    (void)state;
    for (int kind = DEA_DOT; kind <= DEA_LENS; kind++) {
        for (size_t i = 0; i < LENS_MODELS; i++) {
            const dea_scene scene = paper_scene((dea_kind)kind, 1.2, 0.4, 0.01);
            const dea_row row = solve_direct(&scene, lens_models[i]);
            assert_relative(row.force, 0.5 * 1e-4 * capacitance_slope(&scene, 0.0), 1e-10);
        }
    }
}

static void capacitance_at_rest_is_the_size_of_the_paper_s_actuator(void **state)
{
    (void)state;
    const dea_scene scene = paper_scene(DEA_DOT, 1.2, 0.5, 0.0);
    assert_near(true_capacitance(&scene, 0.0), 252e-12, 0.5e-12);
}

/* A number that another program found. */
static void charge_of_the_membrane_to_all_printed_digits(void **state)
{
    (void)state;
    assert_printed(1e6 * solve_paper("field", DEA_DOT, 1.2, 0.5, 4500.0).charge, 1.354360, 6);
}

static void charge_is_what_the_film_takes_at_its_voltage(void **state)
{
    (void)state;
    for (size_t i = 0; i < ALL_MODELS; i++) {
        dea_scene scene = paper_scene(DEA_DOT, 1.2, 0.4, 3000.0);
        const dea_row plain = solve_direct(&scene, all_models[i]);
        assert_relative(plain.charge, 3000.0 * plain.capacitance, 1e-15);
        scene.drive = (dea_drive){.voltage = 4500.0, .series_resistance = 1e9, .leakage_resistance = 2e9};
        const dea_row leaking = solve_direct(&scene, all_models[i]);
        assert_relative(leaking.charge, plain.charge, 1e-15);
        assert_relative(leaking.capacitance, plain.capacitance, 1e-15);
    }
}

/* F_DEA = U^2/2 dC/du where the displacement alone tells the capacitance. */
static void force_is_the_slope_of_the_capacitance_column(void **state)
{
    (void)state;
    static const char *const models[] = {"lumped", "coverage", "lame"};
    for (size_t i = 0; i < 3; i++) {
        for (int kind = DEA_DOT; kind <= DEA_LENS; kind++) {
            for (double b = 0.15; b < 1.0; b += 0.2) {
                const dea_row low = solve_paper(models[i], (dea_kind)kind, 1.2, b, 2999.0);
                const dea_row high = solve_paper(models[i], (dea_kind)kind, 1.2, b, 3001.0);
                const dea_row row = solve_paper(models[i], (dea_kind)kind, 1.2, b, 3000.0);
                const double slope = (high.capacitance - low.capacitance) / (high.displacement - low.displacement);
                const double softening = strcmp(models[i], "lame") == 0 ? 0.3 : 1e-6; /* its force is that at rest */
                assert_relative(row.force, 0.5 * 3000.0 * 3000.0 * slope, softening);
            }
        }
    }
}

static void area_strain_is_that_of_the_electroded_film(void **state)
{
    (void)state;
    for (size_t i = 0; i < LENS_MODELS; i++) {
        const dea_row dot = solve_paper(lens_models[i], DEA_DOT, 1.2, 0.5, 4500.0);
        const dea_row lens = solve_paper(lens_models[i], DEA_LENS, 1.2, 0.5, 4500.0);
        assert_relative(1.0 + dot.area_strain, (1.0 + dot.strain) * (1.0 + dot.strain), 1e-15);
        const double inner = 0.5 * (1.0 + lens.strain);
        assert_relative(1.0 + lens.area_strain, (1.0 - inner * inner) / 0.75, 1e-15);
        assert_true(dot.area_strain > 0.0 && lens.area_strain > 0.0);
    }
}

static void strain_does_not_depend_on_size(void **state)
{
    (void)state;
    for (size_t i = 0; i < LENS_MODELS; i++) {
        for (int kind = DEA_DOT; kind <= DEA_LENS; kind++) {
            const dea_row here = solve_paper(lens_models[i], (dea_kind)kind, 1.2, 0.375, 4500.0);
            for (double scale = 0x1p-15; scale < 100.0; scale *= 8.0) {
                dea_scene scene = paper_scene((dea_kind)kind, 1.2, 0.375, 4500.0 * scale);
                scene.actuator.film_thickness *= scale;
                scene.actuator.frame_radius *= 3.0 * scale;
                const dea_row row = solve_direct(&scene, lens_models[i]);
                assert_relative(row.strain, here.strain, 1e-14);
                assert_relative(row.displacement, 3.0 * scale * here.displacement, 1e-14);
                assert_relative(row.force, 3.0 * scale * scale * here.force, 1e-14);
                assert_relative(row.field, here.field, 1e-14);
            }
        }
    }
}

static void sign_of_the_voltage_does_not_matter(void **state)
{
    (void)state;
    for (size_t i = 0; i < ALL_MODELS; i++) {
        const dea_row plus = solve_paper(all_models[i], DEA_DOT, 1.2, 0.4, 3000.0);
        dea_row minus = solve_paper(all_models[i], DEA_DOT, 1.2, 0.4, -3000.0);
        assert_state(minus, DEA_STATE_OK);
        assert_true(minus.charge < 0.0);
        minus.charge = -minus.charge;
        assert_memory_equal(&plus, &minus, offsetof(dea_row, state));
        assert_true(minus.field > 0.0);
    }
}

static void no_voltage_gives_no_strain(void **state)
{
    (void)state;
    for (size_t i = 0; i < ALL_MODELS; i++) {
        const dea_row row = solve_paper(all_models[i], DEA_DOT, 1.2, 0.4, 0.0);
        assert_state(row, DEA_STATE_OK);
        assert_true(row.strain == 0.0 && row.displacement == 0.0 && row.force == 0.0 && row.field == 0.0);
    }
    for (size_t i = 0; i < LENS_MODELS; i++) {
        const dea_row row = solve_paper(lens_models[i], DEA_LENS, 1.2, 0.4, 0.0);
        assert_state(row, DEA_STATE_OK);
        assert_true(row.strain == 0.0 && row.force == 0.0);
    }
}

static void tiny_voltages_keep_twelve_digits(void **state)
{
    (void)state;
    for (int kind = DEA_DOT; kind <= DEA_LENS; kind++) {
        for (size_t i = 0; i < ALL_MODELS; i++) {
            if (kind == DEA_LENS && !dea_model_find(all_models[i])->lens) {
                continue;
            }
            const double slope = paper_strain(all_models[i], (dea_kind)kind, 1.2, 0.3, 1e-3) / 1e-6;
            assert_true(slope != 0.0);
            for (double voltage = 2e-3; voltage > 1e-10; voltage *= 0.05) {
                assert_relative(paper_strain(all_models[i], (dea_kind)kind, 1.2, 0.3, voltage) / (voltage * voltage), slope,
                                1e-12);
            }
        }
    }
}

static void true_field_follows_the_thinner_film(void **state)
{
    (void)state;
    static const char *const models[] = {"pelrine", "constant_force", "lumped", "coverage", "lame", "ring"};
    for (size_t i = 0; i < 6; i++) {
        const dea_row row = solve_paper(models[i], DEA_DOT, 1.2, 0.4, 4500.0);
        assert_relative(row.field, 45e6 * pow(1.2 * (1.0 + row.strain), 2.0), 1e-13);
    }
    const dea_row lens = solve_paper("coverage", DEA_LENS, 1.2, 0.4, 4500.0);
    assert_relative(lens.field, 45e6 * pow(1.2 * (1.0 - 0.4 * (1.0 + lens.strain)) / 0.6, 2.0), 1e-13);
    const dea_row ring = solve_paper("ring", DEA_LENS, 1.2, 0.4, 4500.0); /* the true area of the annulus */
    assert_relative(ring.field, 45e6 * 1.44 * (1.0 - 0.16 * pow(1.0 + ring.strain, 2.0)) / 0.84, 1e-13);
}

static void breakdown_is_named_above_its_field_and_keeps_the_numbers(void **state)
{
    (void)state;
    for (size_t i = 0; i < ALL_MODELS; i++) {
        dea_scene scene = paper_scene(DEA_DOT, 1.2, 0.4, 4500.0);
        const dea_row free_row = solve_direct(&scene, all_models[i]);
        scene.material.breakdown = free_row.field * (1.0 + 1e-12);
        assert_state(solve_direct(&scene, all_models[i]), DEA_STATE_OK);
        scene.material.breakdown = free_row.field * (1.0 - 1e-12);
        const dea_row row = solve_direct(&scene, all_models[i]);
        assert_state(row, DEA_STATE_BREAKDOWN);
        assert_relative(row.strain, free_row.strain, 0.0);
    }
}

/* Voltage at which the state changes away from ok, by bisection. */
static double last_fine_voltage(const char *model, dea_scene *scene, dea_state *beyond)
{
    double low = 0.0;
    double high = 1e6;
    while (high - low > 1e-9 * high) {
        scene->drive.voltage = 0.5 * (low + high);
        const dea_row row = solve_direct(scene, model);
        *(row.state == DEA_STATE_OK ? &low : &high) = scene->drive.voltage;
    }
    scene->drive.voltage = high;
    *beyond = solve_direct(scene, model).state;
    scene->drive.voltage = low;
    return low;
}

static void passive_film_is_slack_where_its_stretch_falls_to_one(void **state)
{
    (void)state;
    static const char *const models[] = {"lumped", "coverage"};
    for (size_t i = 0; i < 2; i++) {
        for (int kind = DEA_DOT; kind <= DEA_LENS; kind++) {
            dea_scene scene = paper_scene((dea_kind)kind, 1.05, kind == DEA_DOT ? 0.7 : 0.3, 0.0);
            const double b = scene.actuator.coverage;
            dea_state beyond = DEA_STATE_OK;
            (void)last_fine_voltage(models[i], &scene, &beyond);
            assert_int_equal(beyond, DEA_STATE_SLACK);
            const double s = solve_direct(&scene, models[i]).strain;
            assert_near(1.05 * (kind == DEA_DOT ? (1.0 - b * (1.0 + s)) / (1.0 - b) : 1.0 + s), 1.0, 1e-7);
        }
    }
}

static void film_without_pre_stretch_is_slack(void **state)
{
    (void)state;
    for (size_t i = 0; i < LENS_MODELS; i++) {
        for (double voltage = 0.0; voltage < 2500.0; voltage += 1000.0) {
            assert_state(solve_paper(lens_models[i], DEA_DOT, 1.0, 0.4, voltage), DEA_STATE_SLACK);
            assert_state(solve_paper(lens_models[i], DEA_LENS, 1.0, 0.4, voltage), DEA_STATE_SLACK);
        }
    }
}

/* At the limit that a dot of a membrane meets first, the disc's nominal stress w a1 - M lambda_A^3 is 0. */
static void disc_of_a_membrane_is_slack_where_its_stress_vanishes(void **state)
{
    (void)state;
    static const char *const models[] = {"ring", "field"};
    for (size_t i = 0; i < 2; i++) {
        dea_scene scene = paper_scene(DEA_DOT, 1.1, 0.8, 0.0);
        dea_state beyond = DEA_STATE_OK;
        const double voltage = last_fine_voltage(models[i], &scene, &beyond);
        assert_int_equal(beyond, DEA_STATE_SLACK);
        const double l = 1.1 * (1.0 + solve_direct(&scene, models[i]).strain);
        const double maxwell = 2.8 * DEA_EPSILON_0 * pow(voltage / 1e-4, 2.0) * l * l * l;
        assert_relative(dea_law_stress(scene.material.law, scene.material.constants, l, l).p1, maxwell, 1e-6);
    }
}

/* Where a lens loses its tension one of the two stresses of its annulus under voltage, or that of its disc, is 0. */
static void lens_of_rings_is_slack_where_a_stress_vanishes(void **state)
{
    (void)state;
    for (double b = 0.2; b < 0.9; b += 0.15) {
        dea_scene scene = paper_scene(DEA_LENS, 1.15, b, 0.0);
        dea_state beyond = DEA_STATE_OK;
        const double voltage = last_fine_voltage("ring", &scene, &beyond);
        assert_int_equal(beyond, DEA_STATE_SLACK);
        const double s = solve_direct(&scene, "ring").strain;
        const double disc = 1.15 * (1.0 + s), l1 = 1.15 * (1.0 - b * (1.0 + s)) / (1.0 - b);
        const double l2 = 1.15 * (1.0 + b * (1.0 + s)) / (1.0 + b);
        const double maxwell = 2.8 * DEA_EPSILON_0 * pow(voltage / 1e-4, 2.0) * l1 * l1 * l2 * l2;
        const dea_stress annulus = dea_law_stress(scene.material.law, scene.material.constants, l1, l2);
        const double least = fmin(annulus.p1 - maxwell / l1, annulus.p2 - maxwell / l2);
        assert_near(fmin(least, dea_law_stress(scene.material.law, scene.material.constants, disc, disc).p1), 0.0, 1e-6 * annulus.p1);
    }
}

static void pull_in_stays_pull_in_at_any_higher_voltage(void **state)
{
    (void)state;
    for (size_t i = 0; i < ALL_MODELS; i++) {
        bool seen = false;
        for (double voltage = 100.0; voltage < 1e6; voltage *= 1.05) {
            dea_scene scene = paper_scene(DEA_DOT, 1.2, 0.3, voltage);
            scene.material.constants[1] = scene.material.constants[2] = 0.0;
            const dea_row row = solve_direct(&scene, all_models[i]);
            assert_true(row.state != DEA_STATE_FAILED);
            assert_true(!seen || row.state == DEA_STATE_PULL_IN);
            seen = row.state == DEA_STATE_PULL_IN;
        }
        const bool linear = strcmp(all_models[i], "lumped") == 0; /* Eq. 22 is linear in the load */
        assert_true(seen != linear);
    }
}

static dea_scene soft_scene(dea_kind kind, double prestretch, double coverage, double voltage)
{
    dea_scene scene = paper_scene(kind, prestretch, coverage, voltage);
    scene.material.constants[0] = 40e3;
    scene.material.constants[1] = -8e3;
    scene.material.constants[2] = 1.2e3;
    return scene;
}

static double active_strain(const dea_scene *scene, double strain)
{
    const double b = scene->actuator.coverage;
    return scene->actuator.kind == DEA_DOT ? strain : -strain * b / (1.0 - b);
}

/* Lame's disc a part in 1e5 before pull-in, where what holds it is the small difference of film and softening: in long double. */
static void lame_keeps_its_digits_before_pull_in(void **state)
{
    (void)state;
    for (int k = 0; k < 20; k++) {
        dea_scene scene = paper_scene(DEA_DOT, 1.05 + 0.02 * k, 0.5, 1.0);
        scene.material.constants[1] = -0.1 * scene.material.constants[0];
        const long double l = scene.actuator.prestretch, y = l * l, j = 2.0L * y + 1.0L / (y * y) - 3.0L,
                          a = 2.0L * (l - 1.0L / (l * y * y));
        const long double c1 = scene.material.constants[0], c2 = scene.material.constants[1], c3 = scene.material.constants[2];
        const long double w = c1 + 2.0L * c2 * j + 3.0L * c3 * j * j, q = 2.0L * c2 + 6.0L * c3 * j;
        const long double w11 = w * (2.0L + 6.0L / (y * y * y)) + q * a * a, held = 2.0L * w11 / 0.75L;
        const long double unit =
            2.8 * DEA_EPSILON_0 / (scene.actuator.film_thickness * (long double)scene.actuator.film_thickness) * y;
        scene.drive.voltage = (double)sqrtl(held / (3.0L * unit) * (1.0L - 1e-5L));
        const long double soft = unit * scene.drive.voltage * scene.drive.voltage;
        assert_relative(solve_direct(&scene, "lame").strain, (double)(soft / (held - 3.0L * soft)), 1e-12);
    }
}

/* A material that softens and stiffens again has equilibria behind its fold; a film driven from rest never gets there smoothly.
 */
static void judge_folds(bool ring)
{
    int snapped = 0;
    int taken = 0;
    for (double l = 1.0; l < 2.05; l += 0.1) {
        for (double b = 0.05; b < 0.96; b += 0.1) {
            for (double voltage = 500.0; voltage < 20000.0; voltage *= 1.15) {
                const dea_scene scene = soft_scene(voltage > 3000.0 ? DEA_DOT : DEA_LENS, l, b, voltage);
                const judged_balance balance = ring ? judged_ring_of(&scene) : judged_balance_of(&scene, false);
                const judgement found = judge_balance(&balance, 10000);
                if (fabs(found.fold - 1.0) < 1e-5) {
                    continue; /* too near the fold for the scan */
                }
                const dea_row row = solve_direct(&scene, ring ? "ring" : "coverage");
                assert_true((row.state == DEA_STATE_PULL_IN) == (bool)isnan(found.strain));
                snapped += isnan(found.strain) && found.later;
                if (!isnan(found.strain)) {
                    taken++;
                    assert_relative(ring ? fabs(row.strain) : active_strain(&scene, row.strain), found.strain, 1e-12);
                }
            }
        }
    }
    assert_true(snapped >= 20);
    assert_true(taken >= 200);
}

static void equilibrium_behind_a_fold_is_pull_in(void **state)
{
    (void)state;
    judge_folds(false);
    judge_folds(true);
}

/* A lens deep in slack, whose share of the load jumps beside its root: the branch from rest is followed by the edge, and the next
 * place on it lies near. */
static void field_takes_no_jump_for_a_root(void **state)
{
    (void)state;
    dea_scene scene = paper_scene(DEA_LENS, 1.5895610256561299, 0.49023940686523815,
                                  978.26643008529243 * 59168127.18355266 / 61615555.18254153);
    scene.material.constants[0] = 55662.985616793507;
    scene.material.constants[1] = 4354.6293936129632;
    scene.material.constants[2] = 443.80498486226236;
    scene.material.permittivity = 7.0070261164158074;
    scene.actuator.film_thickness = 1.3626718245572231e-05;
    const dea_row row = solve_direct(&scene, "field");
    assert_state(row, DEA_STATE_SLACK);
    assert_relative(row.strain, -0.47087787021, 1e-10);
}

/* A lens of rings far in slack: the second-order answer lies next to the film's end, where the load is so large that a cubic
 * through it and rest does not move. The strain grows with the voltage, past it and around it. */
static void a_lens_of_rings_takes_no_standstill_for_a_root(void **state)
{
    (void)state;
    dea_scene scene = paper_scene(DEA_LENS, 1.2746296253123925, 0.35482306232900773, 999.35213887746715);
    scene.material.constants[0] = 22538.403520823504;
    scene.material.constants[1] = -3818.7038979733816;
    scene.material.constants[2] = 654.14895958021577;
    scene.material.permittivity = 8.6512402408187832 - 0.47491610590986211 * 1.2746296253123925;
    scene.actuator.film_thickness = 1.8486513392511577e-05;
    const judged_balance balance = judged_ring_of(&scene);
    assert_relative(solve_direct(&scene, "ring").strain, -judge_balance(&balance, 10000).strain, 1e-12);
    double before = 0.0;
    for (scene.drive.voltage = 700.0; scene.drive.voltage < 2000.0; scene.drive.voltage += 0.5) {
        const double strain = solve_direct(&scene, "ring").strain;
        assert_true(strain < before && strain > -0.6);
        before = strain;
    }
}

/* Linear films let the edge of a lens' disc pass the centre. Where it comes to the frame's radius on the other side, the annulus has
 * lost its area, and its true field E = U lambda_pre^2/H (1 - B^2 (1 + s)^2)/(1 - B^2) its leading digits: in long double from the
 * constants, s = -(1 - B) eps lambda_pre^4 (U/H)^2/Y of `lumped`. */
static void a_vanishing_annulus_keeps_the_digits_of_its_field(void **state)
{
    (void)state;
    for (int k = 0; k < 20; k++) {
        dea_scene scene = paper_scene(DEA_LENS, 1.3 + 0.03 * k, 0.5, 1.0);
        scene.material.modulus = 1e6;
        const long double h = scene.actuator.film_thickness, y = (long double)scene.actuator.prestretch * scene.actuator.prestretch;
        const long double unit = 0.5L * (2.8 * DEA_EPSILON_0) * y * y / (h * h) / 1e6L; /* -s per U^2 */
        scene.drive.voltage = (double)sqrtl((3.0L + 1e-3L) / unit);
        const long double volts = scene.drive.voltage, edge = 0.5L * (1.0L - unit * volts * volts);
        const long double field = fabsl(volts * y / h * (1.0L - edge) * (1.0L + edge) / 0.75L);
        assert_relative(solve_direct(&scene, "lumped").field, (double)field, 5e-13);
    }
}

/* An iteration that dawdles at the top of the load curve, 3 % below the load, must not be taken for an equilibrium. */
static void load_above_the_fold_is_pull_in_however_close(void **state)
{
    (void)state;
    dea_scene scene = paper_scene(DEA_DOT, 1.2, 0.5, 2800.0);
    scene.material.constants[0] = 60e3;
    scene.material.constants[1] = -4e3;
    scene.material.constants[2] = 0.0;
    for (int i = 0; i < 10000; i++) {
        scene.actuator.coverage = 0.05 + 0.05 * i / 10000.0;
        const dea_row row = solve_direct(&scene, "coverage");
        assert_int_equal(row.state, DEA_STATE_PULL_IN);
    }
}

static void snap_through_without_a_fold_is_followed(void **state)
{
    (void)state;
    for (double voltage = 100.0; voltage < 30000.0; voltage *= 1.1) {
        for (double b = 0.2; b < 0.95; b += 0.3) {
            const dea_scene scene = paper_scene(DEA_DOT, 1.3, b, voltage);
            for (int ring = 0; ring < 2; ring++) {
                const judged_balance balance = ring ? judged_ring_of(&scene) : judged_balance_of(&scene, false);
                const judgement found = judge_balance(&balance, 20000);
                const dea_row row = solve_direct(&scene, ring ? "ring" : "coverage");
                assert_true((row.state == DEA_STATE_PULL_IN) == (bool)isnan(found.strain));
                if (!isnan(found.strain)) {
                    assert_relative(row.strain, found.strain, 1e-12);
                }
            }
        }
    }
}

static void hyperelastic_models_balance_their_forces_at_random_points(void **state)
{
    (void)state;
    for (int i = 0; i < 400; i++) {
        const double l = 1.0 + 0.0025 * i;
        const double b = 0.002 + 0.99 * fabs(sin(7.0 * i));
        const double voltage = 4500.0 * pow(fabs(cos(3.0 * i)), 3.0);
        const dea_scene scene = paper_scene(i % 2 ? DEA_LENS : DEA_DOT, l, b, voltage);
        const judged_balance balance = judged_balance_of(&scene, false);
        const dea_row row = solve_direct(&scene, "coverage");
        const double rounding = 1e-15 / fabs(row.strain); /* of the judge, that takes differences of stresses */
        if (row.state != DEA_STATE_PULL_IN) {
            assert_near((double)judged_share(&balance, active_strain(&scene, row.strain)), 1.0, 1e-11 + rounding);
        }
        const judged_balance rings = judged_ring_of(&scene);
        const dea_row ring = solve_direct(&scene, "ring");
        if (ring.state != DEA_STATE_PULL_IN) {
            assert_near((double)judged_share(&rings, fabs(ring.strain)), 1.0, 1e-11 + 1e-15 / fabs(ring.strain));
        }
        const judged_balance bias = judged_balance_of(&scene, true);
        const dea_row upper = solve_direct(&scene, "constant_force");
        if (upper.state != DEA_STATE_PULL_IN) {
            assert_near((double)judged_share(&bias, upper.strain), 1.0, 1e-11 + 1e-15 / upper.strain);
        }
    }
}

static void field_agrees_with_runge_kutta_over_the_radius(void **state)
{
    (void)state;
    static const double points[][3] = {{1.1, 0.10, 4500.0}, {1.2, 0.25, 4500.0}, {1.2, 0.50, 3000.0},  {1.3, 0.75, 4500.0},
                                       {1.3, 0.40, 5500.0}, {1.5, 0.90, 5000.0}, {1.05, 0.30, 2000.0}, {2.0, 0.20, 2500.0}};
    for (int kind = DEA_DOT; kind <= DEA_LENS; kind++) {
        for (size_t i = 0; i < sizeof points / sizeof points[0]; i++) {
            const dea_scene scene = paper_scene((dea_kind)kind, points[i][0], points[i][1], points[i][2]);
            const dea_row judged = judge_membrane(&scene);
            const dea_row row = solve_direct(&scene, "field");
            assert_relative(row.strain, judged.strain, 1e-8);
            assert_relative(row.field, judged.field, 1e-8);
            assert_state(row, judged.state);
        }
    }
}

/* Far past the loss of tension the annulus is squeezed to a tenth of its radial stretch, or pulled to three times it; the
 * answer must still hold the frame, on a mesh fine enough for that. */
static void slack_film_far_past_its_tension_still_balances(void **state)
{
    (void)state;
    static const struct {
        dea_kind kind;
        double prestretch, coverage, voltage, yeoh[DEA_YEOH_TERMS], strain;
    } table[] = {
        {DEA_DOT,
         2.8546791505449742,
         0.76268500816809603,
         6036.2027361005921,
         {14257.268820654581, 47.207722112250089, 0.0},
         0.30094011459},
        {DEA_LENS, 1.47769, 0.992198, 19854.5, {226828.0, 0.0, 9878.32}, 0.0},
        {DEA_LENS, 1.62045, 0.806394, 26008.1, {238045.0, 20012.2, 0.0}, 0.0},
        {DEA_LENS, 2.96595, 0.711474, 7535.5, {54517.3, -1484.61, 32.3794}, 0.0},
    };
    for (size_t i = 0; i < sizeof table / sizeof table[0]; i++) {
        dea_scene scene = paper_scene(table[i].kind, table[i].prestretch, table[i].coverage, table[i].voltage);
        memcpy(scene.material.constants, table[i].yeoh, sizeof table[i].yeoh);
        scene.material.permittivity = 3.0870724055123651;
        scene.actuator.film_thickness = 0.00010728262699271607;
        const dea_row row = solve_direct(&scene, "field");
        assert_state(row, DEA_STATE_SLACK);
        judged_membrane m = judged_membrane_of(&scene);
        const double l = table[i].prestretch;
        const double coarse = membrane_miss_on(&m, l * (1.0 + row.strain), 8000);
        const double fine = membrane_miss_on(&m, l * (1.0 + row.strain), 16000);
        assert_near(fine + (fine - coarse) / 15.0, 0.0, 1e-8 * fabs(row.strain));
        assert_true(m.least_stress < 0.0);
        if (table[i].strain > 0.0) {
            assert_relative(row.strain, table[i].strain, 1e-9);
        }
    }
}

/* Voltage of the load M = share W11. */
static double voltage_of(const dea_scene *scene, double share)
{
    const double l = scene->actuator.prestretch;
    const double modulus = dea_law_stress(scene->material.law, scene->material.constants, l, l).w11;
    return scene->actuator.film_thickness * sqrt(share * modulus / (scene->material.permittivity * DEA_EPSILON_0));
}

/* Lenses whose annulus has a second equilibrium with another jump of the radial stretch at the edge. Followed by the judge in
 * small steps of the load from rest, the first holds its full load; the others lose their film at 0.095 and 0.772 of it. */
static void membrane_stays_on_the_branch_from_rest(void **state)
{
    (void)state;
    static const struct {
        double prestretch, coverage, load, yeoh[DEA_YEOH_TERMS];
        dea_state state;
    } table[] = {
        {1.7216997561242819,
         0.43797968969558837,
         0.7410484,
         {23203.486392539551, 1356.6555220287153, 513.27121128343083},
         DEA_STATE_SLACK},
        {1.2859763351025995,
         0.98954728292069138,
         0.6797873,
         {15226.192907002162, -1875.0667185962031, 123.12467806927516},
         DEA_STATE_PULL_IN},
        {1.8228925479454063,
         0.15533851988654324,
         0.1933061,
         {500775.35734473693, -95046.027931475925, 10927.810375094698},
         DEA_STATE_PULL_IN},
    };
    for (size_t i = 0; i < sizeof table / sizeof table[0]; i++) {
        dea_scene scene = paper_scene(DEA_LENS, table[i].prestretch, table[i].coverage, 0.0);
        memcpy(scene.material.constants, table[i].yeoh, sizeof table[i].yeoh);
        scene.drive.voltage = voltage_of(&scene, table[i].load);
        const dea_row row = solve_direct(&scene, "field");
        assert_state(row, table[i].state);
        assert_true(i > 0 || is_close(row.strain, -0.533103, 0.0, 3e-6));
    }
}

/* Strains of a softening film in which the radial stiffness behind the edge has fallen to a tenth, by SciPy's DOP853 over the
 * radius; at the next voltage it is gone, and what lies past it is another film. */
static void field_holds_its_digits_up_to_the_loss_of_ellipticity(void **state)
{
    (void)state;
    static const struct {
        double coverage, voltage, strain;
    } last[] = {{0.1, 4000.0, -0.0619592244578}, {0.3, 3500.0, -0.0496512075795}, {0.6, 3000.0, -0.0341166805967}};
    for (size_t i = 0; i < 3; i++) {
        dea_scene scene = paper_scene(DEA_LENS, 1.2, last[i].coverage, last[i].voltage);
        scene.material.constants[1] = -60000.0;
        scene.material.constants[2] = 8000.0;
        assert_relative(solve_direct(&scene, "field").strain, last[i].strain, 1e-10);
        for (double voltage = last[i].voltage + 500.0; voltage <= 9000.0; voltage += 500.0) {
            scene.drive.voltage = voltage;
            assert_state(solve_direct(&scene, "field"), DEA_STATE_PULL_IN);
        }
    }
}

static void field_agrees_with_itself_on_a_finer_mesh(void **state)
{
    (void)state;
    for (int i = 0; i < 200; i++) {
        dea_scene scene =
            paper_scene(i % 2 ? DEA_LENS : DEA_DOT, 1.02 + 0.005 * i, 0.002 + 0.99 * fabs(sin(7.0 * i)), 50.0 * (i % 90));
        scene.accuracy = i % 3 == 0 ? 1e-4 : i % 3 == 1 ? 1e-6 : 1e-9;
        const double wanted = scene.accuracy;
        const dea_row row = solve_direct(&scene, "field");
        scene.accuracy = 1e-12;
        const dea_row finer = solve_direct(&scene, "field");
        assert_state(finer, row.state);
        if (row.state != DEA_STATE_PULL_IN) {
            assert_near(row.strain, finer.strain, wanted * fabs(finer.strain));
            assert_near(row.field, finer.field, wanted * finer.field);
            assert_near(row.capacitance, finer.capacitance, wanted * finer.capacitance);
        }
    }
}

static void every_model_says_which_actuators_it_can_do(void **state)
{
    (void)state;
    assert_int_equal(dea_model_count(), ALL_MODELS);
    assert_null(dea_model_at(ALL_MODELS));
    assert_null(dea_model_find("ideal"));
    for (size_t i = 0; i < ALL_MODELS; i++) {
        const dea_model *model = dea_model_at(i);
        assert_string_equal(model->name, all_models[i]);
        assert_ptr_equal(dea_model_find(all_models[i]), model);
        assert_int_equal(model->lens, i >= 2);
        assert_int_equal(model->membrane, i == 6);
        assert_true(model->equation[0] && model->leaves_out[0]);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(strains_at_4500_volts_to_all_printed_digits),
        cmocka_unit_test(rings_lie_next_to_the_membrane),
        cmocka_unit_test(free_film_strains_to_all_printed_digits),
        cmocka_unit_test(smaller_coverage_costs_what_the_paper_says),
        cmocka_unit_test(displacement_peaks_at_half_coverage),
        cmocka_unit_test(hyperelastic_displacement_peaks_slightly_below_half_coverage),
        cmocka_unit_test(plane_elastic_displacement_peaks_at_one_over_root_three),
        cmocka_unit_test(small_electrode_strains_as_under_a_constant_bias_force),
        cmocka_unit_test(full_coverage_leaves_no_strain),
        cmocka_unit_test(linear_strain_is_below_hyperelastic_at_small_coverage_least_at_the_largest_pre_stretch),
        cmocka_unit_test(free_neo_hookean_film_pulls_in_at_the_known_stretch),
        cmocka_unit_test(plane_elasticity_approaches_the_field_with_second_order),
        cmocka_unit_test(lens_is_the_opposite_of_a_dot_at_small_voltage),
        cmocka_unit_test(force_of_a_dot_is_the_slope_of_its_electric_energy),
        cmocka_unit_test(force_at_rest_is_the_slope_of_the_electric_energy),
        cmocka_unit_test(capacitance_at_rest_is_the_size_of_the_paper_s_actuator),
        cmocka_unit_test(charge_of_the_membrane_to_all_printed_digits),
        cmocka_unit_test(charge_is_what_the_film_takes_at_its_voltage),
        cmocka_unit_test(force_is_the_slope_of_the_capacitance_column),
        cmocka_unit_test(area_strain_is_that_of_the_electroded_film),
        cmocka_unit_test(strain_does_not_depend_on_size),
        cmocka_unit_test(sign_of_the_voltage_does_not_matter),
        cmocka_unit_test(no_voltage_gives_no_strain),
        cmocka_unit_test(tiny_voltages_keep_twelve_digits),
        cmocka_unit_test(true_field_follows_the_thinner_film),
        cmocka_unit_test(breakdown_is_named_above_its_field_and_keeps_the_numbers),
        cmocka_unit_test(passive_film_is_slack_where_its_stretch_falls_to_one),
        cmocka_unit_test(film_without_pre_stretch_is_slack),
        cmocka_unit_test(disc_of_a_membrane_is_slack_where_its_stress_vanishes),
        cmocka_unit_test(lens_of_rings_is_slack_where_a_stress_vanishes),
        cmocka_unit_test(pull_in_stays_pull_in_at_any_higher_voltage),
        cmocka_unit_test(lame_keeps_its_digits_before_pull_in),
        cmocka_unit_test(equilibrium_behind_a_fold_is_pull_in),
        cmocka_unit_test(load_above_the_fold_is_pull_in_however_close),
        cmocka_unit_test(field_takes_no_jump_for_a_root),
        cmocka_unit_test(a_lens_of_rings_takes_no_standstill_for_a_root),
        cmocka_unit_test(a_vanishing_annulus_keeps_the_digits_of_its_field),
        cmocka_unit_test(snap_through_without_a_fold_is_followed),
        cmocka_unit_test(hyperelastic_models_balance_their_forces_at_random_points),
        cmocka_unit_test(field_agrees_with_runge_kutta_over_the_radius),
        cmocka_unit_test(slack_film_far_past_its_tension_still_balances),
        cmocka_unit_test(membrane_stays_on_the_branch_from_rest),
        cmocka_unit_test(field_holds_its_digits_up_to_the_loss_of_ellipticity),
        cmocka_unit_test(field_agrees_with_itself_on_a_finer_mesh),
        cmocka_unit_test(every_model_says_which_actuators_it_can_do),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
