/* The circuits of examples/circuits as a user runs them, against facts that the simulator did not make. Run from the project's
 * folder. */
#include "ngspice_child.h"

#include <complex.h>

#include "netlist/part.h"
#include "network/dynamics.h"

static char project[4096];

static void copy_case(const char *name)
{
    char command[sizeof project + 2 * CHILD_PATH];
    snprintf(command, sizeof command, "cp '%s/tests/cases/%s' '%s'", project, name, child_folder);
    assert_int_equal(system(command), 0);
}

static int setup(void **state)
{
    dea_error error = {0};
    if (!getcwd(project, sizeof project) || child_setup(state) != 0) {
        return -1;
    }
    FILE *library = child_open("dea.lib", "w");
    const dea_status status = dea_part_library(dea_dialect_find("ngspice"), library, &error);
    return fclose(library) != 0 || status != DEA_OK ? -1 : 0;
}

/* Runs a circuit in the folder of the child as a user does, and reads what it says. */
static void run_file(const char *path, child_run *run)
{
    simulate_without_sanitizers();
    char command[sizeof project + 4 * CHILD_PATH];
    *run = (child_run){.width = 1};
    snprintf(command, sizeof command, "cd '%s' && ulimit -t 100 && ngspice -b '%s' >log 2>&1", child_folder, path);
    const int ended = system(command);
    run->status = WIFEXITED(ended) ? WEXITSTATUS(ended) : -1;
    child_read_log(run);
}

/* Runs an example where it lies, apart from the files that a run may leave; it must end well and without a warning. */
static void run_example(const char *name, child_run *run)
{
    static const char *const words[] = {"arning", "rror", "fail", "ignored", "oo small"};
    char path[sizeof project + 64];
    snprintf(path, sizeof path, "%s/examples/circuits/%s.cir", project, name);
    run_file(path, run);
    for (size_t i = 0; i < sizeof words / sizeof *words; i++) {
        const char *found = strstr(run->log, words[i]);
        if (found) {
            fail_msg("%s says: %.80s", name, found);
        }
    }
    if (run->status != 0) {
        fail_msg("%s ends with %d", name, run->status);
    }
}

/* A result of a .meas card. */
static double measured(const child_run *run, const char *name)
{
    const size_t length = strlen(name);
    for (const char *line = run->log; line; line = strchr(line, '\n')) {
        line += *line == '\n' ? 1 : 0;
        if (strncmp(line, name, length) == 0 && line[length] == ' ') {
            return strtod(strchr(line, '=') + 1, NULL);
        }
    }
    fail_msg("no result %s", name);
    return 0.0;
}

/* The film of the library's defaults under a voltage, opened for its capacitance; the caller closes it. */
static dea_scene scene_of(dea_kind kind, const char *model, double voltage)
{
    dea_scene scene = paper_scene(kind, 1.2, 0.5, voltage);
    scene.models[0] = dea_model_find(model);
    return scene;
}

static double charge_of(const dea_scene *scene)
{
    dea_dynamics d;
    dea_error error = {0};
    assert_int_equal(dea_dynamics_open(scene, scene->models[0], &d, &error), DEA_OK);
    const double u = solve_direct(scene, scene->models[0]->name).displacement;
    const double charge = dea_dynamics_edge(&d, u).capacitance * scene->drive.voltage;
    dea_dynamics_close(&d);
    return charge;
}

static void a_boost_supply_charges_the_dot_to_the_static_answer_and_the_bleed_lets_it_go(void **state)
{
    (void)state;
    child_run run;
    run_example("boost-supply", &run);
    const double volts = measured(&run, "dot_volts");
    const dea_scene scene = scene_of(DEA_DOT, "coverage", volts);
    assert_relative(volts, 4500.0, 0.02);
    assert_relative(measured(&run, "supply_volts"), volts, 1e-3);
    assert_relative(measured(&run, "strain_on"), solve_direct(&scene, "coverage").strain, 1e-3);
    assert_relative(measured(&run, "charge"), charge_of(&scene), 1e-3);
    /* the current cannot be more than the supply drives through the series resistor; the strain lags behind the charge */
    assert_true(measured(&run, "charge_current") > 0.3 * volts / 5e6 && measured(&run, "charge_current") < volts / 5e6);
    assert_true(measured(&run, "rise_time") > 2.2 * 5e6 * 252e-12);
    assert_relative(measured(&run, "rise_time"), measured(&run, "nine_tenths") - measured(&run, "tenth"), 1e-4);
    assert_near(measured(&run, "strain_off"), 0.0, 1e-3 * measured(&run, "strain_on"));
    assert_true(measured(&run, "flag") == 0.0);
}

/* Plano-convex cap of the volume at rest over the strained aperture. */
static double focal_length(double f, double n, double radius, double strain)
{
    const double bend = f * (n - 1.0);
    const double h0 = bend - sqrt(bend * bend - radius * radius);
    const double volume = h0 * (3.0 * radius * radius + h0 * h0);
    const double a = radius * (1.0 + strain);
    double low = 0.0, high = 10.0 * h0;
    for (int i = 0; i < 100; i++) {
        const double h = 0.5 * (low + high);
        *(h * (3.0 * a * a + h * h) < volume ? &low : &high) = h;
    }
    return (a * a + low * low) / (2.0 * low * (n - 1.0));
}

static void a_half_bridge_switches_a_lens_between_two_focal_lengths(void **state)
{
    (void)state;
    child_run run;
    run_example("half-bridge-lens", &run);
    dea_scene scene = scene_of(DEA_LENS, "coverage", measured(&run, "volts_on"));
    scene.actuator.frame_radius = 0.01;
    scene.actuator.coverage = 0.6;
    scene.actuator.film_thickness = 8e-5;
    const double strain = solve_direct(&scene, "coverage").strain;
    assert_relative(scene.drive.voltage, 5000.0, 1e-5);
    assert_relative(measured(&run, "strain_on"), strain, 1e-4);
    assert_relative(measured(&run, "focal_on"), 1e3 * focal_length(0.03, 1.4, 0.006, strain), 1e-4);
    assert_relative(measured(&run, "focal_rest"), 30.0, 1e-6);
    assert_relative(measured(&run, "focal_off"), 30.0, 1e-4);
    assert_relative(measured(&run, "peak_current"), 5000.0 / (5e5 + 100.0), 1e-3);
    assert_relative(-measured(&run, "rail_charge"), charge_of(&scene), 1e-3); /* once a period */
    assert_true(measured(&run, "focal_ready") > 10e-3 && measured(&run, "focal_ready") < 15e-3);
    assert_true(measured(&run, "flag") == 0.0);
}

/* phi (U1^2 - U2^2) = 4 phi U_bias u_signal: linear in the signal, through mass, damper, relaxation of the charge and springs. */
static void antagonists_move_their_load_in_proportion_to_the_signal(void **state)
{
    (void)state;
    child_run run;
    dea_dynamics d;
    dea_error error = {0};
    dea_scene scene = scene_of(DEA_DOT, "lumped", 2500.0);
    scene.material.density = 1080.0;
    scene.material.retardation = 1e-3;
    run_example("antagonists", &run);
    assert_int_equal(dea_dynamics_open(&scene, scene.models[0], &d, &error), DEA_OK);
    const dea_edge e = dea_dynamics_edge(&d, 0.0);
    const double complex s = I * 2.0 * DEA_PI * 5.0;
    /* each film sees its source through 1 Mohm: s (C U + 2 phi U_bias u) = (U_source - U)/R */
    const double complex lag = 1.0 + s * 1e6 * e.capacitance;
    const double back = 2.0 * e.push * 2500.0;
    const double complex spring =
        2.0 * e.stress_slope[0] * (1.0 + s * d.retardation) + 200.0 + 0.05 * s + s * s * (2.0 * d.mass + 2e-4);
    const double complex u = 2.0 * back * 1000.0 / lag / (spring + 2.0 * back * back * s * 1e6 / lag);
    dea_dynamics_close(&d);
    assert_relative(1e-6 * measured(&run, "stroke_high"), cabs(u), 2e-3);
    assert_relative(1e-6 * measured(&run, "stroke_low"), -cabs(u), 2e-3);
    assert_relative(measured(&run, "opposite"), -measured(&run, "stroke_high"), 1e-5);
    assert_relative(measured(&run, "spring_high"), measured(&run, "stroke_high"), 1e-5);
    const char *distortion = strstr(run.log, "THD:");
    assert_non_null(distortion);
    assert_true(strtod(distortion + 4, NULL) < 0.05); /* in percent */
    assert_true(measured(&run, "flag") == 0.0);
}

/* Displacement per volt about the bias, with source resistance and cable. */
static void a_response_through_the_supply_has_its_corner_and_resonance(void **state)
{
    (void)state;
    child_run run;
    dea_dynamics d;
    dea_error error = {0};
    double u, peak = 0.0, peak_at = 0.0;
    int rows = 0;
    dea_scene scene = scene_of(DEA_DOT, "lame", 3000.0);
    scene.material.density = 1080.0;
    scene.material.retardation = 1e-4;
    scene.actuator.electrode_mass = 0.05;
    run_example("supply-response", &run);
    assert_int_equal(dea_dynamics_open(&scene, scene.models[0], &d, &error), DEA_OK);
    assert_true(dea_dynamics_equilibrium(&d, 3000.0, &u));
    const dea_edge e = dea_dynamics_edge(&d, u);
    const double stiffness = dea_dynamics_stiffness(&d, u, 3000.0, true);
    const double back = 2.0 * e.push * 3000.0;
    for (const char *line = run.log; line; line = strchr(line, '\n')) {
        double frequency, magnitude, film;
        line += *line == '\n' ? 1 : 0;
        if (sscanf(line, "%*d\t%lf\t%lf\t%lf", &frequency, &magnitude, &film) == 3) {
            const double complex s = I * 2.0 * DEA_PI * frequency;
            const double complex mobility = back / (stiffness + s * d.retardation * e.stress_slope[0] + s * s * d.mass);
            const double complex seen = 1.0 / (1.0 + s * 5e5 * (1e-10 + e.capacitance + back * mobility));
            assert_relative(film, cabs(seen), 1e-5);
            assert_relative(1e-6 * magnitude, cabs(mobility * seen), 1e-5);
            peak_at = magnitude > peak ? frequency : peak_at;
            peak = fmax(peak, magnitude);
            rows++;
        }
    }
    assert_int_equal(rows, 81);
    assert_relative(peak_at, sqrt(stiffness / d.mass) / (2.0 * DEA_PI), 0.1);
    dea_dynamics_close(&d);
}

/* A circuit of tests/cases, and one of its results; a tolerance below 0 is absolute. */
typedef struct expected {
    const char *circuit, *result;
    double value, tolerance;
} expected;

/* Circuits that went wrong in the hands of users: many parts by m=, charge on isolated films, shunts at every node, MOSFETs, lines
 * and edges of an ideal source. */
static void circuits_of_users_give_the_right_answers(void **state)
{
    (void)state;
    static const expected all[] = {
        {"mult_static", "v(x1.u)", 220.1642, 1e-5},
        {"mult_static", "v(xm.u)", 220.1642, 1e-5},
        {"mult_charging", "half1", 2.782e-3, 1e-3},
        {"mult_charging", "halfm", 2.782e-3, 1e-3},
        {"rshunt_hold", "film", 2978.0, 0.01}, /* the plain capacitor's voltage */
        {"current_charge", "volts", 1553.4, 0.01},
        {"op_rshunt1e12", "u0", 249.449, 1e-5},
        {"op_rshunt1e12", "u1", 273.349, 1e-5},
        {"op_rshunt1e12", "u2", 220.164, 1e-5},
        {"readme_pulse", "um", 214.776, 1e-4},
        {"hyper_stall", "um", 110.796, 1e-4}, /* of a run with a tenth of the step and of the tolerance */
        {"hyper_stall_tline", "um", 220.164, 1e-4},
        {"mos_bridge", "u0", 220.164, 5e-3},
        {"mos_bridge", "uoff", 0.0, -1e-3},
    };
    const char *last = "";
    child_run run;
    for (size_t i = 0; i < sizeof all / sizeof *all; i++) {
        char name[64];
        snprintf(name, sizeof name, "%s.cir", all[i].circuit);
        if (strcmp(last, all[i].circuit) != 0) {
            copy_case(name);
            run_file(name, &run);
        }
        const double value = measured(&run, all[i].result);
        const double scale = all[i].tolerance < 0.0 ? -1.0 : fabs(all[i].value);
        print_message("%s: %s = %g\n", name, all[i].result, value);
        assert_near(value, all[i].value, scale * all[i].tolerance);
        last = all[i].circuit;
    }
}

/* m s^2 + tau k s + k = 0. */
static void the_mechanical_poles_are_those_of_mass_damper_and_spring(void **state)
{
    (void)state;
    child_run run;
    dea_dynamics d;
    dea_error error = {0};
    double real, imaginary;
    dea_scene scene = scene_of(DEA_DOT, "lumped", 3000.0);
    scene.material.density = 1080.0;
    scene.material.retardation = 1e-4;
    assert_int_equal(dea_dynamics_open(&scene, scene.models[0], &d, &error), DEA_OK);
    const double square = dea_dynamics_stiffness(&d, 0.0, 0.0, true) / d.mass;
    dea_dynamics_close(&d);
    copy_case("pz.cir");
    run_file("pz.cir", &run);
    const char *first = strstr(run.log, "pole(1) = ");
    assert_non_null(first);
    assert_int_equal(sscanf(first, "pole(1) = %lf,%lf", &real, &imaginary), 2);
    assert_relative(real, -0.5e-4 * square, 1e-5);
    assert_relative(fabs(imaginary), sqrt(square - 0.25e-8 * square * square), 1e-5);
    assert_true(strstr(run.log, "pole(2)") && !strstr(run.log, "pole(3)"));
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(circuits_of_users_give_the_right_answers),
        cmocka_unit_test(the_mechanical_poles_are_those_of_mass_damper_and_spring),
        cmocka_unit_test(a_boost_supply_charges_the_dot_to_the_static_answer_and_the_bleed_lets_it_go),
        cmocka_unit_test(a_half_bridge_switches_a_lens_between_two_focal_lengths),
        cmocka_unit_test(antagonists_move_their_load_in_proportion_to_the_signal),
        cmocka_unit_test(a_response_through_the_supply_has_its_corner_and_resonance),
    };
    return cmocka_run_group_tests(tests, setup, child_teardown);
}
