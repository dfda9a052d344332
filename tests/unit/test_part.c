/* The parts for circuit designers in standalone ngspice, against the models and engines of the library. */
#include "ngspice_child.h"
#include "random_scenes.h"

#include <complex.h>
#include <ctype.h>

#include "film/point.h"
#include "film/second.h"
#include "netlist/part.h"
#include "netlist/symbol.h"
#include "network/dynamics.h"

enum { KINDS = 8 };

static const struct kind {
    dea_kind kind;
    const char *model, *name;
} kinds[KINDS] = {{DEA_DOT, "lumped", "dea_dot"},         {DEA_LENS, "lumped", "dea_lens"},
                  {DEA_DOT, "lame", "dea_dot_lame"},      {DEA_LENS, "lame", "dea_lens_lame"},
                  {DEA_DOT, "coverage", "dea_dot_hyper"}, {DEA_LENS, "coverage", "dea_lens_hyper"},
                  {DEA_LENS, "ring", "dea_lens_ring"},    {DEA_DOT, "ring", "dea_dot_ring"}};

static void write_library(const char *name, const char *dialect)
{
    dea_error error = {0};
    FILE *file = child_open(name, "w");
    assert_int_equal(dea_part_library(dea_dialect_find(dialect), file, &error), DEA_OK);
    assert_int_equal(fclose(file), 0);
}

static int setup(void **state)
{
    const int failed = child_setup(state);
    write_library("dea.lib", "ngspice");
    return failed;
}

/* Opens circuit.cir with its title and the library. */
static FILE *begin_circuit(void)
{
    FILE *file = child_open("circuit.cir", "w");
    fputs("* circuit\n.include dea.lib\n", file);
    return file;
}

static void run_circuit(FILE *file, child_run *run)
{
    fputs(".end\n", file);
    assert_int_equal(fclose(file), 0);
    child_must_run("circuit.cir", run);
}

/* What a scene has beside a film, of which the library has no part. */
typedef void dress(dea_scene *scene);

/* Two layers with a skin on them, which neither damps nor relaxes. */
static void coat(dea_scene *scene)
{
    scene->actuator.layers = 2.0;
    scene->electrode = (dea_electrode){.law = dea_law_find("gent"),
                                       .constants = {30e3, 20.0},
                                       .entry_count = 1,
                                       .thickness = 25e-6,
                                       .density = 1010.0,
                                       .sheet_resistance = (double)NAN};
    scene->actuator.electrode_mass = (double)NAN;
}

/* A second film of the other kind and another material, at a voltage of its own; both are elastic. */
static void pair(dea_scene *scene)
{
    const double none = (double)NAN;
    scene->antagonist = (dea_antagonist){true, scene->actuator.kind == DEA_DOT ? DEA_LENS : DEA_DOT, none, none, 8e-5, 2.0, 1.3, 2500.0, true,
                                         dea_material_default()};
    scene->antagonist.material.law = dea_law_find("neo_hookean");
    scene->antagonist.material.constants[0] = 350e3;
    scene->antagonist.material.permittivity = 3.0;
    scene->antagonist.material.density = 1000.0;
}

/* A second film of the same material, which damps and relaxes as the first. */
static void twin(dea_scene *scene)
{
    pair(scene);
    scene->antagonist.own_material = false;
}

/* The name of the part of a scene: of the library, or of its own one, which is written. */
static const char *name_part(FILE *file, const dea_scene *scene, const struct kind *kind, char own[16])
{
    dea_error error = {0};
    if (!scene->electrode.law && !scene->antagonist.there) {
        return kind->name;
    }
    snprintf(own, 16, "own%d", (int)(kind - kinds));
    if (dea_part_write(scene, scene->models[0], own, dea_dialect_find("ngspice"), file, &error) != DEA_OK) {
        fail_msg("%s", error.message);
    }
    return own;
}

/* The parameters of a scene behind the name of its part. */
static void write_parameters(FILE *file, const dea_scene *scene)
{
    dea_part_parameter list[DEA_PART_PARAMETERS];
    const size_t count = dea_part_parameters(scene, scene->models[0], list);
    for (size_t i = 0; i < count; i++) {
        fprintf(file, "%s %s=%.17g", i % 4 == 3 ? "\n+" : "", list[i].name, list[i].value);
    }
    fputc('\n', file);
}

static dea_scene scene_of(const struct kind *kind, double voltage)
{
    dea_scene scene = paper_scene(kind->kind, 1.2, 0.5, voltage);
    scene.models[0] = dea_model_find(kind->model);
    return scene;
}

static void statics_are_those_of_the_models(void **state)
{
    (void)state;
    enum { SCENES = 120 };
    static dea_row rows[SCENES];
    uint64_t seed = 20u;
    child_run run;
    FILE *file = begin_circuit();
    fputs(".save", file);
    for (int i = 0; i < SCENES; i++) {
        fprintf(file, "\n+ v(x%d.u) v(x%d.bad) v(x%d.slack) v(x%d.force) v(x%d.field)", i, i, i, i, i);
        if (i % 10 == 9 && i + 1 < SCENES) {
            fputs("\n.save", file);
        }
    }
    fputc('\n', file);
    for (int i = 0; i < SCENES; i++) {
        dea_scene scene;
        do {
            scene = scene_of(&kinds[i % KINDS], random_between(&seed, 500.0, 5000.0));
            scene.actuator.coverage = random_between(&seed, 0.1, 0.9);
            scene.actuator.prestretch = random_between(&seed, 1.0, 1.8);
            scene.actuator.film_thickness = random_between(&seed, 6e-5, 2e-4);
            scene.actuator.frame_radius = random_decades(&seed, 1e-3, 1e-1);
            scene.material.permittivity = 3.2;
            scene.material.permittivity_per_stretch = random_between(&seed, -0.3, 0.1);
            scene.material.modulus = random_chance(&seed, 0.3) ? 1e6 : (double)NAN;
            rows[i] = solve_direct(&scene, kinds[i % KINDS].model);
        } while (isnan(rows[i].displacement));
        fprintf(file, "v%d a%d 0 %.17g\nx%d a%d 0 edge%d %s", i, i, scene.drive.voltage, i, i, i, kinds[i % KINDS].name);
        write_parameters(file, &scene);
    }
    fputs(".options reltol=1e-6\n.op\n", file);
    run_circuit(file, &run);
    int slack = 0;
    for (int i = 0; i < SCENES; i++) {
        char name[32];
        snprintf(name, sizeof name, "v(x%d.u)", i);
        assert_relative(1e-6 * child_value(&run, name, 0), rows[i].displacement, 1e-6);
        snprintf(name, sizeof name, "v(x%d.force)", i);
        if (strcmp(kinds[i % KINDS].model, "lame") != 0) { /* whose row gives the force at rest, without softening */
            assert_relative(child_value(&run, name, 0), rows[i].force, 1e-6);
        }
        snprintf(name, sizeof name, "v(x%d.bad)", i);
        assert_true(child_value(&run, name, 0) == 0.0);
        snprintf(name, sizeof name, "v(x%d.slack)", i);
        assert_near(child_value(&run, name, 0), rows[i].state == DEA_STATE_SLACK ? 1.0 : 0.0, 1e-9);
        slack += rows[i].state == DEA_STATE_SLACK ? 1 : 0;
        snprintf(name, sizeof name, "v(x%d.field)", i);
        assert_relative(1e6 * child_value(&run, name, 0), rows[i].field, 1e-6);
    }
    assert_true(slack > 0 && slack < SCENES / 2);
    child_end(&run);
}

enum { SAMPLES = 41 };

static const double moving_end = 8e-3; /* five periods of the film and two of its quicker branch behind the ramp */

/* A damped film with branches, load of its electrodes, series and leakage resistance, under a ramp of 0.2 ms to 4 kV. */
static dea_scene moving_scene(const struct kind *kind, dress *more)
{
    static double times[] = {1e-3, 1.2e-3}, volts[] = {0.0, 4000.0};
    dea_scene scene = scene_of(kind, (double)NAN);
    scene.material.density = 1080.0;
    scene.actuator.electrode_mass = 1.0;
    scene.material.retardation = 1e-3;
    scene.material.prony_count = 2;
    scene.material.prony[0] = (dea_prony){.g = 0.15, .tau = 5e-3};
    scene.material.prony[1] = (dea_prony){.g = 0.1, .tau = 0.3};
    scene.drive.series_resistance = 2e6;
    scene.drive.leakage_resistance = 1e10;
    scene.drive.waveform =
        (dea_waveform){.kind = DEA_WAVE_POINTS, .times = times, .voltages = volts, .point_count = 2, .period = (double)NAN};
    if (kind->kind == DEA_LENS) {
        scene.actuator.focal_length = 0.05;
        scene.actuator.refractive_index = 1.4;
    }
    scene.study = DEA_STUDY_TRANSIENT;
    scene.transient = (dea_transient){.until = moving_end, .every = moving_end / (SAMPLES - 1)};
    scene.accuracy = 1e-9;
    if (more) {
        more(&scene);
    }
    return scene;
}

static void fly(const dea_scene *scene, dea_sample *samples)
{
    const dea_engine *engine = dea_engine_find("ida");
    dea_summary summary;
    dea_error error = {0};
    void *session = NULL;
    assert_int_equal(dea_layout_of(scene).rows, SAMPLES);
    if (engine->begin(&session, &error) != DEA_OK ||
        engine->transient(session, scene, scene->models[0], samples, &summary, &error) != DEA_OK) {
        fail_msg("%s", error.message);
    }
    engine->end(session);
}

/* The part of a scene behind a resistor at node a, its second film, if it has one, at a source of its own. */
static void write_driven(FILE *file, const dea_scene *scene, int i)
{
    char own[16];
    const char *name = name_part(file, scene, &kinds[i], own);
    const char *second = scene->antagonist.there ? "other 0" : "";
    fprintf(file, ".save v(x%d.u) i(vi%d)\nr%d a c%d 2e6\nvi%d c%d b%d 0\nx%d b%d 0 e%d %s %s", i, i, i, i, i, i, i, i, i, i, second, name);
    write_parameters(file, scene);
}

/* All parts under one source, each with its resistor; all that a test wants to see is saved. */
static FILE *begin_moving_circuit(double step, const char *uic, dress *more)
{
    FILE *file = begin_circuit();
    fputs("vsource a 0 pwl(0 0 1e-3 0 1.2e-3 4000)\nvother other 0 2500\n", file);
    for (int i = 0; i < KINDS; i++) {
        const dea_scene scene = moving_scene(&kinds[i], more);
        write_driven(file, &scene, i);
        fprintf(file, ".save v(e%d) v(x%d.q) v(x%d.c) v(b%d)\n", i, i, i, i);
    }
    fprintf(file, ".save v(x1.focal)\n.options reltol=1e-6\n.tran %g %g 0 %g %s\n", step, moving_end, step, uic);
    return file;
}

/* A vector at a time that lies between two points: cubic, through its slopes where they are given, else linear. */
static double at_time(const child_run *run, const char *name, const char *slope, double scale, double time)
{
    const size_t t = child_vector(run, "time"), v = child_vector(run, name);
    size_t low = 0, high = run->points - 1;
    while (high - low > 1) {
        const size_t middle = (low + high) / 2;
        *(run->values[middle * run->vectors + t] <= time ? &low : &high) = middle;
    }
    const double *a = run->values + low * run->vectors, *b = run->values + high * run->vectors;
    const double h = b[t] - a[t], x = (time - a[t]) / h;
    if (!slope) {
        return a[v] + x * (b[v] - a[v]);
    }
    const size_t w = child_vector(run, slope);
    return a[v] + x * x * (3.0 - 2.0 * x) * (b[v] - a[v]) + h * scale * x * (1.0 - x) * ((1.0 - x) * a[w] - x * b[w]);
}

/* Of the trapezoidal rule, whose error falls with the square of the step [s]. */
static const double fine_step = 2e-6, step_error = 4e-6;

static void compare_motion(const child_run *run, int kind, dress *more)
{
    static dea_sample samples[SAMPLES];
    const dea_scene scene = moving_scene(&kinds[kind], more);
    double peak = 0.0, current = 0.0, most = 0.0;
    char u[32], velocity[32], i[32], q[32], c[32], b[32];
    snprintf(u, sizeof u, "v(x%d.u)", kind);
    snprintf(velocity, sizeof velocity, "v(e%d)", kind);
    snprintf(i, sizeof i, "i(vi%d)", kind);
    snprintf(q, sizeof q, "v(x%d.q)", kind);
    snprintf(c, sizeof c, "v(x%d.c)", kind);
    snprintf(b, sizeof b, "v(b%d)", kind);
    fly(&scene, samples);
    for (int k = 0; k < SAMPLES; k++) {
        most = fmax(most, fabs(samples[k].charge));
        peak = fmax(peak, fabs(samples[k].displacement));
        current = fmax(current, fabs(samples[k].current));
    }
    for (int k = 1; k < SAMPLES; k++) {
        const double time = samples[k].time;
        assert_near(1e-6 * at_time(run, u, velocity, 1e6, time), samples[k].displacement, step_error * peak);
        assert_near(at_time(run, i, NULL, 0.0, time), samples[k].current, 2.0 * step_error * current);
        const double film = 1e-12 * at_time(run, c, NULL, 0.0, time) * at_time(run, b, NULL, 0.0, time);
        assert_near(1e-9 * at_time(run, q, NULL, 0.0, time), samples[k].charge, 2.0 * step_error * most);
        assert_near(film, samples[k].charge, 2.0 * step_error * most);
        if (kind == 1) {
            assert_relative(1e-3 * at_time(run, "v(x1.focal)", NULL, 0.0, time), samples[k].focal_length, step_error);
        }
    }
}

static void compare_motions(dress *more)
{
    simulate_without_sanitizers();
    child_run run;
    run_circuit(begin_moving_circuit(fine_step, "", more), &run);
    for (int i = 0; i < KINDS; i++) {
        compare_motion(&run, i, more);
    }
    child_end(&run);
}

static void motion_is_that_of_the_engine_ida(void **state)
{
    (void)state;
    compare_motions(NULL);
}

static void coated_films_and_pairs_of_films_move_as_in_the_engine_ida(void **state)
{
    (void)state;
    compare_motions(coat);
    compare_motions(pair);
    compare_motions(twin);
}

/* Displacement and current per volt about 3 kV, through the series resistance. */
static void compare_responses(dress *more)
{
    child_run run;
    FILE *file = begin_circuit();
    dea_scene scenes[KINDS];
    fputs("vsource a 0 dc 3000 ac 1\nvother other 0 2500\n.options reltol=1e-6\n", file);
    for (int i = 0; i < KINDS; i++) {
        scenes[i] = moving_scene(&kinds[i], more);
        scenes[i].drive.waveform = (dea_waveform){.kind = DEA_WAVE_NONE, .period = (double)NAN};
        scenes[i].study = DEA_STUDY_AC;
        scenes[i].ac = (dea_ac){.from = 0.1, .to = 1e4, .points_per_decade = 10, .bias = 3000.0};
        write_driven(file, &scenes[i], i);
    }
    fputs(".ac dec 10 0.1 1e4\n", file);
    run_circuit(file, &run);
    for (int i = 0; i < KINDS; i++) {
        static dea_response rows[64];
        const dea_engine *engine = dea_engine_find("direct");
        char u[32], current[32];
        dea_error error = {0};
        void *session = NULL;
        snprintf(u, sizeof u, "v(x%d.u)", i);
        snprintf(current, sizeof current, "i(vi%d)", i);
        assert_int_equal(dea_layout_of(&scenes[i]).rows, run.points);
        assert_int_equal(engine->begin(&session, &error), DEA_OK);
        assert_int_equal(engine->ac(session, &scenes[i], scenes[i].models[0], rows, NULL, &error), DEA_OK);
        engine->end(session);
        for (size_t k = 0; k < run.points; k++) {
            const double complex response = 1e-6 * (child_value(&run, u, k) + I * child_imaginary(&run, u, k));
            const double complex impedance = 1.0 / (child_value(&run, current, k) + I * child_imaginary(&run, current, k));
            const double complex wanted = cexp(I * DEA_PI / 180.0 * rows[k].displacement_phase) * rows[k].displacement;
            const double complex load = cexp(I * DEA_PI / 180.0 * rows[k].impedance_phase) * rows[k].impedance;
            assert_near(cabs(response - wanted), 0.0, 1e-6 * cabs(wanted));
            assert_near(cabs(impedance - load), 0.0, 1e-6 * cabs(load));
        }
    }
    child_end(&run);
}

static void responses_are_those_of_the_linearised_equations(void **state)
{
    (void)state;
    compare_responses(NULL);
    compare_responses(coat);
    compare_responses(pair);
    compare_responses(twin);
}

/* A spring of the library, and its stiffness, beside a part: K u + k u = phi U^2. */
static void springs_in_parallel_share_the_force_at_the_operating_point(void **state)
{
    (void)state;
    child_run run;
    FILE *file = begin_circuit();
    fputs("va a 0 4000\n.options reltol=1e-6\n.op\n", file);
    for (int i = 0; i < KINDS; i++) {
        fprintf(file, ".save v(x%d.u)\nx%d a 0 e%d %s\n", i, i, i, kinds[i].name);
        fprintf(file, "xs%d e%d 0 dea_spring stiffness=700\nxt%d e%d 0 dea_spring stiffness=55.5\nrd%d e%d 0 0.1\n", i, i, i, i,
                i, i);
    }
    run_circuit(file, &run);
    for (int i = 0; i < KINDS; i++) {
        char name[32];
        dea_dynamics dynamics;
        dea_error error = {0};
        const dea_scene scene = scene_of(&kinds[i], 4000.0);
        double low = -0.005, high = 0.005;
        assert_int_equal(dea_dynamics_open(&scene, scene.models[0], &dynamics, &error), DEA_OK);
        for (int k = 0; k < 100; k++) {
            const double u = 0.5 * (low + high);
            const dea_edge e = dea_dynamics_edge(&dynamics, u);
            *(e.push * 1.6e7 - dea_edge_held(&dynamics, &e, NULL) - 755.5 * u > 0.0 ? &low : &high) = u;
        }
        dea_dynamics_close(&dynamics);
        snprintf(name, sizeof name, "v(x%d.u)", i);
        assert_relative(1e-6 * child_value(&run, name, 0), low, 1e-6);
    }
    child_end(&run);
}

/* Energy that flows into a part, and where it is at the end: film on its own voltage and current, edge with mass, damper and
 * spring of a user beside. */
static void the_energy_drawn_is_work_and_stores_and_losses(void **state)
{
    (void)state;
    simulate_without_sanitizers();
    for (int kind = 0; kind < KINDS; kind++) {
        child_run run;
        dea_dynamics d;
        dea_error error = {0};
        dea_scene scene = moving_scene(&kinds[kind], NULL);
        scene.material.prony_count = 0;
        scene.material.retardation = 2e-4;
        scene.drive.leakage_resistance = (double)NAN;
        FILE *file = begin_circuit();
        fputs("vsource a 0 pwl(0 0 1e-3 0 1.2e-3 4000 8e-3 4000 8.5e-3 1000)\nrs a b 2e6\nvi b f 0\n", file);
        fprintf(file, "xpart f 0 edge %s", kinds[kind].name);
        write_parameters(file, &scene);
        fputs("cload edge 0 1e-3\nrload edge 0 2\nxspring edge 0 dea_spring stiffness=400\n", file);
        fputs(".save v(f) i(vi) v(edge) v(xpart.u) v(xpart.force) v(xspring.u)\n.tran 4e-6 12e-3 0 4e-6\n", file);
        run_circuit(file, &run);
        assert_int_equal(dea_dynamics_open(&scene, scene.models[0], &d, &error), DEA_OK);
        double drawn = 0.0, work = 0.0, losses = 0.0, elastic = 0.0;
        for (size_t k = 1; k < run.points; k++) {
            const double h = child_value(&run, "time", k) - child_value(&run, "time", k - 1);
            for (size_t n = k - 1; n <= k; n++) {
                const double v = child_value(&run, "v(edge)", n);
                const dea_edge e = dea_dynamics_edge(&d, 1e-6 * child_value(&run, "v(xpart.u)", n));
                drawn += 0.5 * h * child_value(&run, "v(f)", n) * child_value(&run, "i(vi)", n);
                work += 0.5 * h * child_value(&run, "v(xpart.force)", n) * v;
                losses += 0.5 * h * (d.retardation * dea_edge_viscous(&d, &e) + 0.5) * v * v;
                elastic += 0.5 * h * dea_edge_held(&d, &e, NULL) * v;
            }
        }
        const double u = 1e-6 * child_last(&run, "v(xpart.u)"), v = child_last(&run, "v(edge)"), film = child_last(&run, "v(f)");
        const double electric = 0.5 * dea_dynamics_edge(&d, u).capacitance * film * film;
        const double mechanical = elastic + 0.5 * (d.mass + 1e-3) * v * v + 0.5 * 400.0 * u * u + losses;
        assert_relative(1e-6 * child_last(&run, "v(xspring.u)"), u, 1e-6);
        assert_relative(drawn, electric + mechanical, 1e-4);
        assert_relative(drawn, electric + work, 1e-4);
        assert_relative(work, mechanical, 1e-4);
        assert_true(mechanical > 0.05 * drawn); /* the balance is not one of the capacitor alone */
        dea_dynamics_close(&d);
        child_end(&run);
    }
}

#define LONG_NAME "xactuator_that_has_a_rather_long_name_for_an_instance_of_a_subcircuit"

static void instances_of_different_numbers_nest_two_deep_under_long_names(void **state)
{
    (void)state;
    child_run run;
    FILE *file = begin_circuit();
    fputs(".subckt inner p edge\n+ params: cover=0.5 lambda=1.2\n" LONG_NAME " p 0 edge dea_dot_hyper coverage={cover}\n"
          "+ prestretch={lambda}\n.ends inner\n"
          ".subckt outer p e1 e2\n+ params: lambda=1.3\nxa p e1 inner cover=0.3 lambda={lambda}\nxb p e2 inner cover=0.6\n"
          ".ends outer\n"
          "va a 0 3000\nxlong_outer a m1 m2 outer lambda=1.25\n.options reltol=1e-6\n"
          ".save v(xlong_outer.xa." LONG_NAME ".u) v(xlong_outer.xb." LONG_NAME ".u)\n.op\n",
          file);
    run_circuit(file, &run);
    dea_scene scene = scene_of(&kinds[4], 3000.0);
    scene.actuator.coverage = 0.6;
    const double second = solve_direct(&scene, "coverage").displacement;
    scene.actuator.coverage = 0.3;
    scene.actuator.prestretch = 1.25;
    const double first = solve_direct(&scene, "coverage").displacement;
    assert_relative(1e-6 * child_last(&run, "v(xlong_outer.xa." LONG_NAME ".u)"), first, 1e-6);
    assert_relative(1e-6 * child_last(&run, "v(xlong_outer.xb." LONG_NAME ".u)"), second, 1e-6);
    child_end(&run);
}

/* 4.5 kV within 1 ns on parts with and without mass, damper and branches, at default tolerances, in an order of theirs. */
static void write_quick_step(FILE *file, const int order[KINDS], double end)
{
    fprintf(file, "va a 0 pulse(0 4500 1e-3 1e-9 1e-9 0.1 1)\n.tran 1e-4 %g\n", end);
    for (int k = 0; k < KINDS; k++) {
        const int i = order[k];
        fprintf(file, ".save v(x%d.u) v(xm%d.u)\nx%d a 0 e%d %s\nxm%d a 0 em%d %s density=1080 retardation=1e-3\n", i, i, i, i,
                kinds[i].name, i, i, kinds[i].name);
        fprintf(file, "xz%d a 0 ez%d %s density=1080 g1=0.2 tau1=1e-2\n", i, i, kinds[i].name);
    }
}

static double shortest_step(const child_run *run)
{
    double shortest = INFINITY;
    for (size_t k = 1; k < run->points; k++) {
        shortest = fmin(shortest, child_value(run, "time", k) - child_value(run, "time", k - 1));
    }
    return shortest;
}

static void a_step_of_a_nanosecond_converges(void **state)
{
    (void)state;
    simulate_without_sanitizers();
    static const int order[KINDS] = {0, 1, 2, 3, 4, 5, 6, 7};
    child_run run;
    FILE *file = begin_circuit();
    write_quick_step(file, order, 60e-3);
    run_circuit(file, &run);
    for (int i = 0; i < KINDS; i++) {
        char name[32];
        const dea_scene scene = scene_of(&kinds[i], 4500.0);
        const double rest = solve_direct(&scene, kinds[i].model).displacement;
        snprintf(name, sizeof name, "v(x%d.u)", i);
        assert_relative(1e-6 * child_last(&run, name), rest, 1e-4);
        snprintf(name, sizeof name, "v(xm%d.u)", i);
        assert_relative(1e-6 * child_last(&run, name), rest, 1e-3);
    }
    assert_true(child_last(&run, "time") >= 60e-3 * (1.0 - 1e-9));
    child_end(&run);
}

/* A film without mass follows the edge at 1e5 m/s, and no bound of its velocity makes a kink there: the steps stay far above those
 * in which the digits of 4.5 kV end. */
static void a_step_of_a_nanosecond_converges_in_every_order_of_the_parts(void **state)
{
    (void)state;
    simulate_without_sanitizers();
    static const int orders[][KINDS] = {{6, 0, 2, 4, 3, 5, 1, 7}, {7, 5, 4, 1, 2, 3, 0, 6}, {3, 5, 2, 6, 1, 0, 4, 7}, {7, 6, 5, 4, 3, 2, 1, 0}};
    for (size_t k = 0; k < sizeof orders / sizeof *orders; k++) {
        child_run run;
        FILE *file = begin_circuit();
        write_quick_step(file, orders[k], 1.01e-3);
        run_circuit(file, &run);
        assert_true(child_last(&run, "time") >= 1.01e-3 * (1.0 - 1e-9));
        assert_true(shortest_step(&run) > 1e-12);
        child_end(&run);
    }
}

/* KiCad and others put ngspice into modes that read expressions in another way; a run with uic begins at rest as one from the
 * operating point does. */
static void neither_compatibility_modes_nor_uic_change_a_number(void **state)
{
    (void)state;
    simulate_without_sanitizers();
    static const char *const modes[] = {"", "set ngbehavior=psa\n", "set ngbehavior=lta\n", "set ngbehavior=kiltpsa\n", ""};
    static double first[KINDS][SAMPLES];
    for (size_t m = 0; m < sizeof modes / sizeof *modes; m++) {
        child_run run;
        FILE *start = child_open(".spiceinit", "w");
        fputs(modes[m], start);
        fclose(start);
        const bool uic = m + 1 == sizeof modes / sizeof *modes;
        const double same = uic ? 1e-5 : 1e-6; /* its steps begin otherwise */
        run_circuit(begin_moving_circuit(2e-5, uic ? "uic" : "", NULL), &run);
        for (int i = 0; i < KINDS; i++) {
            char u[32], velocity[32];
            snprintf(u, sizeof u, "v(x%d.u)", i);
            snprintf(velocity, sizeof velocity, "v(e%d)", i);
            double peak = 0.0;
            for (int k = 1; k < SAMPLES; k++) {
                const double here = at_time(&run, u, velocity, 1e6, moving_end * k / (SAMPLES - 1));
                first[i][k] = m == 0 ? here : first[i][k];
                peak = fmax(peak, fabs(first[i][k]));
                assert_near(here, first[i][k], same * peak);
            }
            assert_true(peak > 100.0);
        }
        assert_true(!*modes[m] || strstr(run.log, "ompatibility"));
        child_end(&run);
    }
    fclose(child_open(".spiceinit", "w"));
}

#define FILM "density=1080 retardation=2e-4 g1=0.1 tau1=1e-3 leakage_resistance=1e9"

/* Three circuits of one kind, each with a resistor and a load: one part by m=3, three parts, three by m=3 of a subcircuit round
 * the part. */
static void write_multiples(FILE *file, const char *part)
{
    fprintf(file, ".subckt stack p n edge\nxin p n edge %s " FILM "\n.ends stack\n", part);
    fprintf(file, "x0 b0 0 e0 %s " FILM " m=3\nx1 b1 0 e1 %s " FILM "\nxp b1 0 e1 %s " FILM "\nxq b1 0 e1 %s " FILM "\n", part,
            part, part, part);
    fputs("x2 b2 0 e2 stack m=3\nxs0 e0 0 dea_spring stiffness=90 m=2\n.save v(x0.u) v(x1.u) v(x2.xin.u)\n", file);
    for (int i = 0; i < 3; i++) {
        fprintf(file, "r%d a b%d 5e5\nc%d e%d 0 3e-4\n.save v(b%d)\n", i, i, i, i, i);
        fputs(i > 0 ? i > 1 ? "xs2 e2 0 dea_spring stiffness=180\n" : "xs1 e1 0 dea_spring stiffness=180\n" : "", file);
    }
}

static void m_parts_in_one_are_as_many_side_by_side(void **state)
{
    (void)state;
    simulate_without_sanitizers();
    static const char *const moves[] = {"v(x0.u)", "v(x1.u)", "v(x2.xin.u)"}, *const volts[] = {"v(b0)", "v(b1)", "v(b2)"};
    for (int kind = 0; kind < KINDS; kind++) {
        child_run run;
        FILE *file = begin_circuit();
        fputs("va a 0 pulse(500 3500 1e-3 1e-5 1e-5 1 2)\n.options reltol=1e-5 abstol=1e-9\n.tran 2e-5 1e-2 0 2e-5\n", file);
        write_multiples(file, kinds[kind].name);
        run_circuit(file, &run);
        const double u = fabs(child_last(&run, moves[1]));
        assert_true(u > 100.0);
        for (size_t k = 0; k < run.points; k++) {
            for (int i = 0; i < 3; i += 2) {
                assert_near(child_value(&run, moves[i], k), child_value(&run, moves[1], k), 1e-4 * u);
                assert_near(child_value(&run, volts[i], k), child_value(&run, volts[1], k), 1e-4 * 3500.0);
            }
        }
        child_end(&run);
    }
}

/* What a user sets for the whole circuit, with operating point first: the motion stays the same within its tolerance. */
static void options_of_the_circuit_change_no_answer(void **state)
{
    (void)state;
    simulate_without_sanitizers();
    static const char *const options[] = {
        "",           "rshunt=1e12",  "cshunt=1e-13", "gmin=1e-15", "gmin=1e-9", "method=gear", "abstol=1e-10",
        "vntol=1e-4", "chgtol=1e-16", "pivrel=0.1",   "xmu=0.49",   "itl1=50",   "noopiter",    "trtol=1"};
    double first[KINDS];
    for (size_t o = 0; o < sizeof options / sizeof *options; o++) {
        child_run run;
        FILE *file = begin_circuit();
        fprintf(file, "va a 0 pulse(1000 3000 1e-3 1e-6 1e-6 1 2)\n.options reltol=1e-4 %s\n", options[o]);
        for (int i = 0; i < KINDS; i++) {
            fprintf(file, ".save v(x%d.u)\nr%d a b%d 1e6\nx%d b%d 0 e%d %s density=1080 retardation=%g g1=0.2 tau1=0.1\n", i, i,
                    i, i, i, i, kinds[i].name, i % 2 ? 1e-3 : 1e-4);
        }
        fputs(".tran 1e-4 2e-2 0 1e-4\n", file);
        run_circuit(file, &run);
        for (int i = 0; i < KINDS; i++) {
            char name[32];
            snprintf(name, sizeof name, "v(x%d.u)", i);
            const double u = child_last(&run, name);
            first[i] = o == 0 ? u : first[i];
            if (fabs(u - first[i]) > 1e-3 * fabs(first[i])) {
                fail_msg("%s, %s: %g instead of %g", options[o], kinds[i].name, u, first[i]);
            }
        }
        child_end(&run);
    }
}

static void parameters_out_of_range_are_flagged_and_move_nothing(void **state)
{
    (void)state;
    static const char *const wrong[] = {"coverage=1.2",
                                        "coverage=0",
                                        "coverage=-0.5",
                                        "film_thickness=0",
                                        "film_thickness=-1e-4",
                                        "prestretch=0.9",
                                        "frame_radius=0",
                                        "c1=0",
                                        "permittivity=0",
                                        "permittivity=-3",
                                        "density=-1",
                                        "electrode_mass=-1",
                                        "retardation=-1e-3",
                                        "g1=0.5 g2=0.6",
                                        "g1=-0.1",
                                        "tau1=0",
                                        "leakage_resistance=-1",
                                        "m=0",
                                        "m=-2",
                                        "permittivity_per_stretch=-3"};
    static const char *const membranes[] = {"dea_dot_field", "dea_lens_field"};
    enum { WRONG = sizeof wrong / sizeof *wrong, ALL = KINDS + 2 };
    child_run run;
    FILE *file = begin_circuit();
    fputs("va a 0 4000\n.op\n", file);
    for (int i = 0; i < WRONG * ALL; i++) {
        const int kind = i % ALL;
        fprintf(file, ".save v(x%d.bad) v(x%d.u) v(x%d.force) v(x%d.q)\nx%d a 0 e%d %s %s\n", i, i, i, i, i, i,
                kind < KINDS ? kinds[kind].name : membranes[kind - KINDS], wrong[i / ALL]);
    }
    fputs(".save v(xgood.bad) v(xlens.bad) v(xflat.bad)\nxgood a 0 eg dea_dot_hyper coverage=0.999999 prestretch=1\n", file);
    fputs("xlens a 0 el dea_lens focal_length=1e-2\nxflat a 0 ef dea_lens modulus=-1\n", file);
    run_circuit(file, &run);
    for (int i = 0; i < WRONG * ALL; i++) {
        static const char *const still[] = {"u", "force", "q"};
        char name[32];
        snprintf(name, sizeof name, "v(x%d.bad)", i);
        if (child_value(&run, name, 0) != 1.0) {
            fail_msg("%s of part %d is not flagged", wrong[i / ALL], i % ALL);
        }
        for (size_t k = 0; k < 3; k++) {
            snprintf(name, sizeof name, "v(x%d.%s)", i, still[k]);
            assert_near(child_value(&run, name, 0), 0.0, 1e-12);
        }
    }
    assert_true(child_value(&run, "v(xgood.bad)", 0) == 0.0);
    assert_true(child_value(&run, "v(xlens.bad)", 0) == 1.0); /* no cap is so round */
    assert_true(child_value(&run, "v(xflat.bad)", 0) == 1.0);
    child_end(&run);
}

/* The constants of any law are parameters of its part, under their names. */
static void a_part_of_any_law_stands_where_the_model_does(void **state)
{
    (void)state;
    static const struct {
        const char *law;
        double constants[DEA_LAW_CONSTANTS];
        size_t entries;
        const char *parameters;
    } films[] = {{"neo_hookean", {44e3}, 1, "mu=44000"},
                 {"mooney_rivlin", {16e3, 7.3e3}, 1, "c10=16000 c01=7300"},
                 {"gent", {45e3, 12.0}, 1, "mu=45000 jm=12"},
                 {"ogden", {43.4e3, 1.445, 84.2, 4.248}, 2, "mu1=43400 alpha1=1.445 mu2=84.2 alpha2=4.248"},
                 {"arruda_boyce", {40e3, 5.99}, 1, "mu=40000 lambda_m=5.99"}};
    static const char *const models[] = {"lumped", "lame", "coverage"};
    enum { FILMS = sizeof films / sizeof *films, PARTS = 3 * FILMS };
    double wanted[PARTS];
    child_run run;
    FILE *file = begin_circuit();
    fputs("va a 0 1500\n.options reltol=1e-7\n.op\n", file);
    for (int i = 0; i < PARTS; i++) {
        char name[32];
        dea_scene scene = paper_scene(i % 2 ? DEA_LENS : DEA_DOT, 1.3, 0.5, 1500.0);
        scene.material.law = dea_law_find(films[i / 3].law);
        memcpy(scene.material.constants, films[i / 3].constants, sizeof scene.material.constants);
        scene.material.entry_count = films[i / 3].entries;
        wanted[i] = solve_direct(&scene, models[i % 3]).displacement;
        scene.material.constants[0] *= 2.0; /* the default, which the instance does not keep */
        snprintf(name, sizeof name, "film%d", i);
        assert_int_equal(dea_part_write(&scene, dea_model_find(models[i % 3]), name, dea_dialect_find("ngspice"), file, NULL),
                         DEA_OK);
        fprintf(file, ".save v(x%d.u) v(x%d.bad)\nx%d a 0 e%d %s %s\n", i, i, i, i, name, films[i / 3].parameters);
    }
    run_circuit(file, &run);
    for (int i = 0; i < PARTS; i++) {
        char name[32];
        snprintf(name, sizeof name, "v(x%d.u)", i);
        assert_relative(1e-6 * child_value(&run, name, 0), wanted[i], 1e-6);
        snprintf(name, sizeof name, "v(x%d.bad)", i);
        assert_true(child_value(&run, name, 0) == 0.0);
    }
    child_end(&run);
}

/* Its slope is a parameter as the permittivity is; charge and displacement tell force and capacitance. */
static void a_part_whose_permittivity_follows_the_strain_stands_where_the_model_does(void **state)
{
    (void)state;
    static const char *const models[] = {"lumped", "lame", "coverage", "ring", "field"};
    enum { MODELS = 5, PARTS = 2 * MODELS };
    dea_row wanted[PARTS];
    child_run run;
    FILE *file = begin_circuit();
    fputs("va a 0 4000\n.options reltol=1e-7\n.op\n", file);
    for (int i = 0; i < PARTS; i++) {
        char name[32];
        dea_scene scene = paper_scene(i % 2 ? DEA_LENS : DEA_DOT, 1.2, 0.5, 4000.0);
        scene.material.permittivity_follows = true;
        scene.material.permittivity = 2.76;
        scene.material.permittivity_per_stretch = -0.28;
        wanted[i] = solve_direct(&scene, models[i / 2]);
        scene.material.permittivity_per_stretch = -0.5; /* the default, which the instance does not keep */
        snprintf(name, sizeof name, "film%d", i);
        assert_int_equal(dea_part_write(&scene, dea_model_find(models[i / 2]), name, dea_dialect_find("ngspice"), file, NULL),
                         DEA_OK);
        fprintf(file, ".save v(x%d.u) v(x%d.q) v(x%d.bad)\nx%d a 0 e%d %s permittivity_per_stretch=-0.28\n", i, i, i, i, i, name);
    }
    run_circuit(file, &run);
    for (int i = 0; i < PARTS; i++) {
        char name[32];
        snprintf(name, sizeof name, "v(x%d.u)", i);
        assert_relative(1e-6 * child_value(&run, name, 0), wanted[i].displacement, 2e-6);
        snprintf(name, sizeof name, "v(x%d.q)", i);
        assert_relative(1e-9 * child_value(&run, name, 0), wanted[i].charge, 2e-6);
        snprintf(name, sizeof name, "v(x%d.bad)", i);
        assert_true(child_value(&run, name, 0) == 0.0);
    }
    child_end(&run);
}

/* Thickness and law of a skin are parameters; the membrane has the strains of physics.md, section 8, where one has the default. */
static void a_part_with_a_skin_stands_where_the_model_does(void **state)
{
    (void)state;
    static const char *const models[] = {"lumped", "lame", "coverage", "ring", "field"};
    enum { MODELS = 5, PARTS = 2 * MODELS };
    dea_row wanted[PARTS];
    child_run run;
    FILE *file = begin_circuit();
    fputs("va a 0 4500\n.options reltol=1e-7 rshunt=1e12\n.op\n", file);
    for (int i = 0; i < PARTS; i++) {
        char name[32];
        dea_scene scene = paper_scene(i % 2 ? DEA_LENS : DEA_DOT, 1.2, 0.5, 4500.0);
        scene.electrode = (dea_electrode){.law = dea_law_find("neo_hookean"), .constants = {20e3}, .entry_count = 1, .thickness = 25e-6};
        wanted[i] = solve_direct(&scene, models[i / 2]);
        scene.electrode.thickness = 5e-5; /* defaults, which the instances do not keep */
        scene.electrode.constants[0] = 99e3;
        snprintf(name, sizeof name, "coated%d", i);
        assert_int_equal(dea_part_write(&scene, dea_model_find(models[i / 2]), name, dea_dialect_find("ngspice"), file, NULL), DEA_OK);
        fprintf(file, ".save v(x%d.strain) v(x%d.c) v(x%d.q) v(x%d.bad)\n", i, i, i, i);
        fprintf(file, "x%d a 0 e%d %s skin_thickness=25e-6 skin_mu=20e3\n", i, i, name);
        fprintf(file, "xy%d a 0 f%d %s skin_thickness=25e-6 skin_mu=20e3 m=2\n.save v(xy%d.u) v(xy%d.q)\n", i, i, name, i, i);
        fprintf(file, "xz%d a 0 g%d %s skin_thickness=0\n.save v(xz%d.bad) v(xz%d.u)\n", i, i, name, i, i);
    }
    run_circuit(file, &run);
    for (int i = 0; i < PARTS; i++) {
        char name[32];
        snprintf(name, sizeof name, "v(x%d.strain)", i);
        assert_relative(child_value(&run, name, 0), wanted[i].strain, 1e-6);
        snprintf(name, sizeof name, "v(x%d.c)", i);
        assert_relative(1e-12 * child_value(&run, name, 0), wanted[i].capacitance, 1e-6);
        snprintf(name, sizeof name, "v(x%d.q)", i);
        assert_relative(1e-9 * child_value(&run, name, 0), wanted[i].charge, 1e-6);
        snprintf(name, sizeof name, "v(x%d.bad)", i);
        assert_true(child_value(&run, name, 0) == 0.0);
        snprintf(name, sizeof name, "v(xy%d.u)", i);
        assert_relative(1e-6 * child_value(&run, name, 0), wanted[i].displacement, 1e-6);
        snprintf(name, sizeof name, "v(xy%d.q)", i);
        assert_relative(1e-9 * child_value(&run, name, 0), 2.0 * wanted[i].charge, 1e-6);
        snprintf(name, sizeof name, "v(xz%d.bad)", i);
        assert_true(child_value(&run, name, 0) == 1.0);
        snprintf(name, sizeof name, "v(xz%d.u)", i);
        assert_near(child_value(&run, name, 0), 0.0, 1e-12);
    }
    assert_relative(child_value(&run, "v(x8.strain)", 0), 0.0442776413, 1e-6);
    assert_relative(child_value(&run, "v(x9.strain)", 0), -0.0370009643, 1e-6);
    child_end(&run);
}

/* Two films in one part, each at its own port; m of it; and what is read of both. The second's numbers are parameters too. */
static void a_part_of_two_films_stands_where_the_scene_does(void **state)
{
    (void)state;
    static const char *const models[] = {"lumped", "lame", "coverage", "ring", "field"};
    enum { MODELS = 5, PARTS = 2 * MODELS };
    dea_row wanted[PARTS], other[PARTS];
    child_run run;
    FILE *file = begin_circuit();
    fputs("va a 0 4000\nvb b 0 2500\n.options reltol=1e-7 rshunt=1e12\n.op\n", file);
    for (int i = 0; i < PARTS; i++) {
        char name[32];
        dea_scene scene = paper_scene(i % 2 ? DEA_LENS : DEA_DOT, 1.2, 0.5, 4000.0), second;
        pair(&scene);
        wanted[i] = solve_direct(&scene, models[i / 2]);
        dea_second_scene(&scene, &second);
        dea_point point;
        dea_film_prepare(&second, &point.film);
        dea_point_place(&second, &point);
        dea_model_hold(dea_model_find(models[i / 2]), &point, wanted[i].displacement, &other[i]);
        scene.antagonist.film_thickness = 2e-4; /* defaults, which the instances do not keep */
        scene.antagonist.material.constants[0] = 99e3;
        snprintf(name, sizeof name, "pair%d", i);
        assert_int_equal(dea_part_write(&scene, dea_model_find(models[i / 2]), name, dea_dialect_find("ngspice"), file, NULL), DEA_OK);
        fprintf(file, ".save v(x%d.u) v(x%d.c) v(x%d.q) v(x%d.c2) v(x%d.q2) v(x%d.field2) v(x%d.slack) v(x%d.bad)\n", i, i, i, i, i, i, i, i);
        fprintf(file, "x%d a 0 e%d b 0 %s second_film_thickness=8e-5 second_mu=350e3\n", i, i, name);
        fprintf(file, "xy%d a 0 f%d b 0 %s second_film_thickness=8e-5 second_mu=350e3 m=2\n.save v(xy%d.u) v(xy%d.q) v(xy%d.q2)\n", i, i, name, i, i, i);
        fprintf(file, "xz%d a 0 g%d b 0 %s second_prestretch=0.5\n.save v(xz%d.bad)\n", i, i, name, i);
    }
    run_circuit(file, &run);
    for (int i = 0; i < PARTS; i++) {
        const struct {
            const char *format;
            double scale, wanted;
        } reads[] = {{"v(x%d.u)", 1e-6, wanted[i].displacement}, {"v(x%d.c)", 1e-12, wanted[i].capacitance},
                     {"v(x%d.q)", 1e-9, wanted[i].charge},       {"v(x%d.c2)", 1e-12, other[i].capacitance},
                     {"v(x%d.q2)", 1e-9, other[i].charge},       {"v(x%d.field2)", 1e6, wanted[i].second_field},
                     {"v(xy%d.u)", 1e-6, wanted[i].displacement}, {"v(xy%d.q)", 1e-9, 2.0 * wanted[i].charge},
                     {"v(xy%d.q2)", 1e-9, 2.0 * other[i].charge}, {"v(xz%d.bad)", 1.0, 1.0}};
        char name[32];
        for (size_t k = 0; k < sizeof reads / sizeof *reads; k++) {
            snprintf(name, sizeof name, reads[k].format, i);
            const bool at_edge = i / 2 == 4 && strstr(name, "field2"); /* the membrane's part reads its field at r_a, which is not the largest */
            assert_relative(reads[k].scale * child_value(&run, name, 0), reads[k].wanted, at_edge ? 1e-4 : 1e-6);
        }
        snprintf(name, sizeof name, "v(x%d.bad)", i);
        assert_true(child_value(&run, name, 0) == 0.0);
        snprintf(name, sizeof name, "v(x%d.slack)", i);
        assert_near(child_value(&run, name, 0), wanted[i].state == DEA_STATE_SLACK ? 1.0 : 0.0, 1e-9);
    }
    child_end(&run);
}

/* Past the voltage at which softening beats the springs there is no equilibrium, whatever the simulator finds. */
static void a_film_past_pull_in_is_flagged(void **state)
{
    (void)state;
    child_run run;
    dea_scene scene = scene_of(&kinds[2], 1.0);
    dea_point point = {.voltage = 1.0};
    dea_linear linear;
    dea_film_prepare(&scene, &point.film);
    dea_point_place(&scene, &point);
    scene.models[0]->linear(&point, &linear);
    const double limit = sqrt(-linear.stiffness / linear.softening);
    FILE *file = begin_circuit();
    fprintf(file, "va a 0 %.17g\nvb b 0 %.17g\n", 0.999 * limit, 1.001 * limit);
    fputs("x1 a 0 e1 dea_dot_lame\nxs e1 0 dea_spring stiffness=1e5\nx2 b 0 e2 dea_dot_lame\n", file);
    scene.antagonist = (dea_antagonist){.there = true, .kind = DEA_LENS, .film_thickness = 2e-4, .layers = 1.0, .prestretch = 1.2, .voltage = 0.0};
    assert_int_equal(dea_part_write(&scene, scene.models[0], "held", dea_dialect_find("ngspice"), file, NULL), DEA_OK);
    const double both = limit * sqrt(3.0); /* the second film is as stiff as two of the first */
    fprintf(file, "vc c 0 %.17g\nvd d 0 %.17g\nx3 c 0 e3 0 0 held\nx4 d 0 e4 0 0 held\nxt e3 0 dea_spring stiffness=1e5\n", 0.999 * both, 1.001 * both);
    fputs("xu e4 0 dea_spring stiffness=1e5\n.save v(x1.bad) v(x2.bad) v(x3.bad) v(x4.bad)\n.op\n", file);
    run_circuit(file, &run);
    assert_true(child_value(&run, "v(x1.bad)", 0) == 0.0);
    assert_true(child_value(&run, "v(x2.bad)", 0) == 1.0);
    assert_true(child_value(&run, "v(x3.bad)", 0) == 0.0);
    assert_true(child_value(&run, "v(x4.bad)", 0) == 1.0);
    child_end(&run);
}

/* The load of a scene is a spring on the edge of its part. */
static void a_spring_on_the_edge_is_the_load_of_a_scene(void **state)
{
    (void)state;
    static const struct {
        const char *part;
        dea_kind kind;
        const char *model;
    } parts[] = {{"dea_dot", DEA_DOT, "lumped"},          {"dea_lens", DEA_LENS, "lumped"},
                 {"dea_dot_lame", DEA_DOT, "lame"},       {"dea_lens_lame", DEA_LENS, "lame"},
                 {"dea_dot_hyper", DEA_DOT, "coverage"},  {"dea_lens_hyper", DEA_LENS, "coverage"},
                 {"dea_dot_ring", DEA_DOT, "ring"},       {"dea_lens_ring", DEA_LENS, "ring"}};
    enum { PARTS = sizeof parts / sizeof *parts };
    child_run run;
    FILE *file = begin_circuit();
    fputs("va a 0 4000\n.save", file);
    for (int i = 0; i < PARTS; i++) {
        fprintf(file, " v(x%d.u)", i);
    }
    fputc('\n', file);
    for (int i = 0; i < PARTS; i++) {
        fprintf(file, "x%d a 0 e%d %s layers=2\nxs%d e%d 0 dea_spring stiffness=800\n", i, i, parts[i].part, i, i);
    }
    fputs(".op\n", file);
    run_circuit(file, &run);
    for (int i = 0; i < PARTS; i++) {
        char name[24];
        dea_scene scene = paper_scene(parts[i].kind, 1.2, 0.5, 4000.0);
        scene.actuator.layers = 2.0;
        *dea_scene_load(&scene, "stiffness") = 800.0;
        snprintf(name, sizeof name, "v(x%d.u)", i);
        assert_relative(1e-6 * child_value(&run, name, 0), solve_direct(&scene, parts[i].model).displacement, 1e-6);
    }
    child_end(&run);
}

/* So is a current its force, and a lens beside a dot its second film. */
static void a_force_and_a_film_on_the_edge_are_those_of_a_scene(void **state)
{
    (void)state;
    static const struct {
        const char *dot, *lens, *model;
    } parts[] = {{"dea_dot", "dea_lens", "lumped"},
                 {"dea_dot_lame", "dea_lens_lame", "lame"},
                 {"dea_dot_hyper", "dea_lens_hyper", "coverage"},
                 {"dea_dot_ring", "dea_lens_ring", "ring"}};
    enum { PARTS = sizeof parts / sizeof *parts };
    child_run run;
    FILE *file = begin_circuit();
    fputs("va a 0 4000\nvb b 0 2500\n.save", file);
    for (int i = 0; i < PARTS; i++) {
        fprintf(file, " v(x%d.u) v(xy%d.u)", i, i);
    }
    fputc('\n', file);
    for (int i = 0; i < PARTS; i++) {
        fprintf(file, "x%d a 0 e%d %s\nix%d 0 e%d -0.2\n", i, i, parts[i].dot, i, i);
        fprintf(file, "xy%d a 0 f%d %s\nxz%d b 0 f%d %s\niy%d 0 f%d 0.05\n", i, i, parts[i].dot, i, i, parts[i].lens, i, i);
    }
    fputs(".op\n", file);
    run_circuit(file, &run);
    for (int i = 0; i < PARTS; i++) {
        char name[24];
        dea_scene scene = paper_scene(DEA_DOT, 1.2, 0.5, 4000.0);
        *dea_scene_load(&scene, "force") = -0.2;
        snprintf(name, sizeof name, "v(x%d.u)", i);
        assert_relative(1e-6 * child_value(&run, name, 0), solve_direct(&scene, parts[i].model).displacement, 1e-6);
        const double none = (double)NAN;
        *dea_scene_load(&scene, "force") = 0.05;
        scene.antagonist = (dea_antagonist){true, DEA_LENS, none, none, none, none, none, 2500.0, false, dea_material_default()};
        snprintf(name, sizeof name, "v(xy%d.u)", i);
        assert_relative(1e-6 * child_value(&run, name, 0), solve_direct(&scene, parts[i].model).displacement, 1e-6);
    }
    child_end(&run);
}

static void a_lever_of_minus_one_sets_two_dots_against_each_other(void **state)
{
    (void)state;
    child_run run;
    FILE *file = begin_circuit();
    fputs("va a 0 4000\nvb b 0 2500\nx1 a 0 e1 dea_dot\nxl e1 e2 dea_lever\nx2 b 0 e2 dea_dot coverage=0.4\n"
          "x3 a 0 e3 dea_dot\nxm e3 e4 dea_lever ratio=0.5\nxs e4 0 dea_spring stiffness=800\n"
          ".save v(x1.u) v(x2.u) v(x3.u)\n.op\n",
          file);
    run_circuit(file, &run);
    dea_linear parts[2];
    for (int i = 0; i < 2; i++) {
        dea_scene scene = scene_of(&kinds[0], 1.0);
        dea_point point = {.voltage = 1.0};
        scene.actuator.coverage = i == 0 ? 0.5 : 0.4;
        dea_film_prepare(&scene, &point.film);
        dea_point_place(&scene, &point);
        scene.models[0]->linear(&point, &parts[i]);
    }
    const double push = parts[0].force * 1.6e7;
    const double u = (push - parts[1].force * 6.25e6) / (parts[0].stiffness + parts[1].stiffness);
    assert_relative(1e-6 * child_value(&run, "v(x1.u)", 0), u, 1e-6);
    assert_relative(1e-6 * child_value(&run, "v(x2.u)", 0), -u, 1e-6);
    assert_relative(1e-6 * child_value(&run, "v(x3.u)", 0), push / (parts[0].stiffness + 0.25 * 800.0), 1e-6);
    child_end(&run);
}

/* The part of a scene has the scene's numbers as defaults, and its title is a comment, whatever it says. */
static void a_scene_becomes_a_part_with_its_numbers_and_a_harmless_title(void **state)
{
    (void)state;
    static char title[] = "film\n.control\nshell touch owned\n.endc\r+ \\\\\xC3\xA4";
    child_run run;
    dea_error error = {0};
    dea_scene scene = scene_of(&kinds[5], 2000.0);
    scene.title = title;
    scene.actuator.coverage = (double)NAN;
    scene.actuator.divide_radius = 0.012;
    scene.material = *dea_material_find("vhb-4910-neo-hookean");
    scene.material.instantaneous = true;
    FILE *file = child_open("scene.lib", "w");
    assert_int_equal(dea_part_of_scene(&scene, scene.models[0], NULL, dea_dialect_find("ngspice"), file, &error), DEA_OK);
    fclose(file);
    file = child_open("scene.lib", "r");
    char line[256];
    for (int i = 0; fgets(line, sizeof line, file); i++) {
        assert_true(i != 0 || strncmp(line, "* film .control shell touch owned .endc +", 41) == 0);
        assert_true(strncmp(line, ".control", 8) != 0 && strncmp(line, "shell", 5) != 0);
    }
    fclose(file);
    file = child_open("circuit.cir", "w");
    fputs("* scene\n.include scene.lib\nva a 0 2000\nx1 a 0 e dea_lens_hyper\n.options reltol=1e-6\n.save v(x1.u)\n.op\n", file);
    run_circuit(file, &run);
    assert_relative(1e-6 * child_value(&run, "v(x1.u)", 0), solve_direct(&scene, "coverage").displacement, 1e-6);
    child_end(&run);
    const dea_model *none = dea_model_find("pelrine");
    file = child_open("none.lib", "w");
    assert_int_equal(dea_part_of_scene(&scene, none, NULL, dea_dialect_find("ngspice"), file, &error), DEA_ERROR_UNSUPPORTED);
    fclose(file);
}

/* Two scenes of different material in one circuit, beside the library, each with its own helpers. */
static void parts_of_different_names_share_a_circuit(void **state)
{
    (void)state;
    static const char *const names[] = {"silicone", "soft_2"};
    child_run run;
    double wanted[2];
    FILE *file = child_open("circuit.cir", "w");
    fputs("* two\n.include dea.lib\n.include silicone.lib\n.include soft_2.lib\nva a 0 2000\n.options reltol=1e-6\n.op\n", file);
    for (int i = 0; i < 2; i++) {
        char library[32];
        dea_error error = {0};
        dea_scene scene = scene_of(&kinds[4], 2000.0);
        if (i == 1) {
            scene.material.constants[0] = 60e3;
            scene.material.constants[1] = scene.material.constants[2] = 0.0;
            scene.material.permittivity = 4.8;
        }
        wanted[i] = solve_direct(&scene, "coverage").displacement;
        snprintf(library, sizeof library, "%s.lib", names[i]);
        FILE *part = child_open(library, "w");
        assert_int_equal(dea_part_of_scene(&scene, scene.models[0], names[i], dea_dialect_find("ngspice"), part, &error), DEA_OK);
        fclose(part);
        fprintf(file, "x%d a 0 e%d %s\nxk%d k%d 0 %s_spring\nxl%d e%d k%d %s_lever\n.save v(x%d.u) v(xk%d.u)\n", i, i, names[i],
                i, i, names[i], i, i, i, names[i], i, i);
    }
    fputs("xp a 0 ep dea_dot_hyper\n.save v(xp.u)\n", file);
    run_circuit(file, &run);
    assert_relative(1e-6 * child_last(&run, "v(xp.u)"), wanted[0], 1e-6);
    assert_true(child_last(&run, "v(x0.u)") < child_last(&run, "v(xp.u)")); /* held by its spring of 100 N/m */
    assert_true(child_last(&run, "v(x1.u)") > 2.0 * child_last(&run, "v(x0.u)"));
    assert_relative(child_last(&run, "v(xk1.u)"), -child_last(&run, "v(x1.u)"), 1e-6);
    assert_true(1e-6 * child_last(&run, "v(x1.u)") < wanted[1]);
    child_end(&run);
}

static void names_of_parts_are_those_that_simulators_take(void **state)
{
    (void)state;
    assert_true(dea_part_name_valid("a") && dea_part_name_valid("Soft_2") &&
                dea_part_name_valid("abcdefghijklmnopqrstuvwxyz012345"));
    assert_false(dea_part_name_valid("") || dea_part_name_valid("2soft") || dea_part_name_valid("_soft") ||
                 dea_part_name_valid("so ft") || dea_part_name_valid("soft\n.control") || dea_part_name_valid("soft.lib") ||
                 dea_part_name_valid("abcdefghijklmnopqrstuvwxyz0123456"));
}

/* Numbers with the suffixes of SPICE; returns how many there were. */
static int read_suffixed(const char *text, double values[3])
{
    static const char suffixes[] = "funmKM";
    static const double factors[] = {1e-15, 1e-6, 1e-9, 1e-3, 1e3, 1e6};
    int count = 0;
    for (char *end; count < 3; count++) {
        values[count] = strtod(text, &end);
        if (end == text) {
            break;
        }
        const char *suffix = *end ? strchr(suffixes, *end) : NULL;
        values[count] *= suffix ? factors[suffix - suffixes] : 1.0;
        text = suffix ? end + 1 : end;
    }
    return count;
}

/* gnucap has no behavioural sources: the mechanical parts, in its own frequency response. */
static void gnucap_gives_the_same_mechanics(void **state)
{
    (void)state;
    if (system("command -v gnucap >/dev/null 2>&1") != 0) {
        print_message("gnucap is not installed: its test is left out\n");
        skip();
    }
    char command[512], line[256];
    FILE *file = child_open("mechanics.lib", "w");
    dea_part_write_mechanics("dea", file);
    fclose(file);
    file = child_open("gnucap.cir", "w");
    fputs("* mechanics\n.include mechanics.lib\ni1 0 a dc 0 ac 1\ncm a 0 0.001\nrd a 0 2\nx1 a 0 dea_spring stiffness=1000\n"
          "x2 a b dea_lever\ncm2 b 0 0.002\nx3 b 0 dea_spring stiffness=500\n.options numdgt=10 short=1e-12\n"
          ".print ac vr(a) vi(a)\n.ac 10 1000 * 10\n.end\n",
          file);
    fclose(file);
    snprintf(command, sizeof command, "cd '%s' && ulimit -t 20 && gnucap -b gnucap.cir", child_folder);
    FILE *answer = popen(command, "r");
    int rows = 0;
    assert_non_null(answer);
    while (fgets(line, sizeof line, answer)) {
        const double frequency = pow(10.0, rows + 1);
        double values[3];
        if (line[0] == ' ' && read_suffixed(line, values) == 3 && fabs(values[0] - frequency) < 1e-6 * frequency) {
            const double complex s = I * 2.0 * DEA_PI * frequency;
            const double complex wanted = 1.0 / (0.003 * s + 0.5 + 1500.0 / s);
            assert_near(cabs(values[1] + I * values[2] - wanted), 0.0, 1e-4 * cabs(wanted));
            rows++;
        }
    }
    pclose(answer);
    assert_int_equal(rows, 3);
}

static bool is_name(int c)
{
    return isalnum(c) || c == '_';
}

/* Names that some simulator takes for a constant or a function, wherever they stand. */
static bool is_reserved(const char *word, size_t length)
{
    static const char *const names[] = {"e",       "i",      "pi",  "c",   "time", "temp",  "temper", "hertz",  "freq",
                                        "omega",   "gmin",   "vt",  "yes", "no",   "true",  "false",  "kelvin", "boltz",
                                        "echarge", "planck", "x",   "y",   "z",    "min",   "max",    "abs",    "sqrt",
                                        "exp",     "ln",     "log", "sgn", "sqr",  "gauss", "pow",    "pwr",    "int",
                                        "limit",   "table",  "if",  "mc",  "ceil", "floor", "sin",    "cos",    "tan"};
    for (size_t i = 0; i < sizeof names / sizeof *names; i++) {
        if (strlen(names[i]) == length && strncmp(names[i], word, length) == 0) {
            return true;
        }
    }
    return false;
}

/* No number ends in a letter, none has a capital or a bare exponent. */
static bool has_suffix(const char *text)
{
    for (const char *c = text; *c; c++) {
        if (isdigit((unsigned char)*c) && (c == text || (!is_name((unsigned char)c[-1]) && c[-1] != '.'))) {
            char *end;
            (void)strtod(c, &end);
            if (is_name((unsigned char)*end)) {
                return true;
            }
            c = end - 1;
        }
    }
    return false;
}

static bool braces_match(const char *text)
{
    int depth = 0;
    for (; *text; text++) {
        depth += *text == '{' ? 1 : *text == '}' ? -1 : 0;
        if (depth < 0 || depth > 1) {
            return false;
        }
    }
    return depth == 0;
}

/* One card, its continuations drawn in. */
static void check_card(const char *card, const dea_dialect *dialect)
{
    const bool source = strstr(card, " v=") || strstr(card, " i=") || strstr(card, " value=");
    const bool behind = strncmp(dialect->name, "xyce", 4) == 0 || strncmp(dialect->name, "pspice", 6) == 0;
    bool good = !strchr(card, '^') && !strstr(card, "**") && !strchr(card, ';') && !strchr(card, '$') && !strchr(card, '?') &&
                !strstr(card, "log10") && !strchr(card, '\t') && !has_suffix(card) && braces_match(card);
    good = good && (strcmp(dialect->name, "pspice") == 0 ? card[0] != 'B' && !strstr(card, "ln(") : !strstr(card, "log("));
    good = good && strchr(".RCGEFHVBX", card[0]) && card[0] != '\0';
    for (const char *c = card; card[0] != '.' && *c && *c != ' '; c++) { /* some libraries refuse elements in small letters */
        good = good && !islower((unsigned char)*c);
    }
    if (source && behind) {
        good = good && strstr(card, "={") && card[strlen(card) - 1] == '}';
    } else if (source) {
        good = good && card[0] == 'B';
    }
    const char *equals = strncmp(card, ".param ", 7) == 0 ? strchr(card, '=') : NULL;
    good = good && (!equals || (!is_reserved(card + 7, (size_t)(equals - card - 7)) && equals[1] == '{'));
    if (!good) {
        fail_msg("%s: %s", dialect->name, card);
    }
}

/* Parameters of a .subckt card. */
static void check_parameters(const char *card)
{
    for (const char *c = strstr(card, "params:"); c && (c = strchr(c, '=')); c++) {
        const char *start = c;
        while (is_name((unsigned char)start[-1])) {
            start--;
        }
        if (is_reserved(start, (size_t)(c - start))) {
            fail_msg("%s", card);
        }
    }
}

static void every_line_of_every_dialect_keeps_to_what_simulators_share(void **state)
{
    (void)state;
    static char card[1 << 16];
    for (size_t d = 0; d < dea_dialect_count(); d++) {
        char line[512];
        int depth = 0, cards = 0;
        write_library("lint.lib", dea_dialect_at(d)->name);
        FILE *file = child_open("lint.lib", "a");
        for (int i = 0; i < KINDS; i++) {
            dea_scene scene = scene_of(&kinds[i], 0.0);
            char own[16];
            coat(&scene);
            pair(&scene);
            snprintf(own, sizeof own, "pair%d", i);
            assert_int_equal(dea_part_write(&scene, scene.models[0], own, dea_dialect_at(d), file, NULL), DEA_OK);
        }
        fclose(file);
        file = child_open("lint.lib", "r");
        card[0] = '\0';
        for (bool more = true; more;) {
            more = fgets(line, sizeof line, file) != NULL;
            line[more ? strcspn(line, "\n") : 0] = '\0';
            assert_true(strlen(line) <= 132);
            if (more && line[0] == '+') {
                assert_true(card[0] != '\0' && card[0] != '*');
                strcat(card, line + 1);
                continue;
            }
            if (card[0] && card[0] != '*') {
                check_card(card, dea_dialect_at(d));
                check_parameters(strncmp(card, ".subckt", 7) == 0 ? card : "");
                depth += strncmp(card, ".subckt", 7) == 0 ? 1 : strncmp(card, ".ends", 5) == 0 ? -1 : 0;
                assert_true(depth == 1 || (depth == 0 && strncmp(card, ".ends", 5) == 0)); /* nothing at the top level */
                cards++;
            }
            assert_true(!more || (line[0] != '\0' && line[0] != ' '));
            snprintf(card, sizeof card, "%s", line);
        }
        fclose(file);
        assert_true(depth == 0 && cards > 500);
    }
}

static void the_lint_finds_what_simulators_read_differently(void **state)
{
    (void)state;
    assert_true(has_suffix("r1 a 0 5k") && has_suffix("{1meg*x}") && has_suffix("c1 a 0 2.2u"));
    assert_false(has_suffix("r1 a 0 5e3") || has_suffix("v(x12)*1e-6+p3") || has_suffix("k_um1 1.5"));
    assert_true(is_reserved("temp", 4) && is_reserved("max", 3));
    assert_false(is_reserved("k_a", 3));
    assert_false(braces_match("a={b") || braces_match("{{a}}") || braces_match("}a{"));
    assert_true(braces_match("v=({a})*({b})"));
}

/* The pins of a .subckt card, "p n edge", into @p pins; false where the library has no such part. */
static bool pins_of(const char *part, char pins[64])
{
    char line[512], card[64];
    bool found = false;
    FILE *file = child_open("dea.lib", "r");
    snprintf(card, sizeof card, ".subckt %s ", part);
    while (!found && fgets(line, sizeof line, file)) {
        found = strncmp(line, card, strlen(card)) == 0;
    }
    fclose(file);
    snprintf(pins, 64, "%.*s", found ? (int)strcspn(line + strlen(card), "\n") : 0, line + strlen(card));
    return found;
}

static void symbols_name_the_pins_of_their_parts_in_order(void **state)
{
    (void)state;
    dea_symbol others[] = {dea_symbol_spring("dea"), dea_symbol_lever("dea"), {.name = ""}};
    dea_scene two = scene_of(&kinds[0], 0.0);
    pair(&two);
    FILE *library = child_open("dea.lib", "a");
    assert_int_equal(dea_part_write(&two, two.models[0], "two_films", dea_dialect_find("ngspice"), library, NULL), DEA_OK);
    fclose(library);
    assert_true(dea_symbol_of_part(&two, two.models[0], "two_films", &others[2]));
    for (int i = 0; i < KINDS + 3; i++) {
        char pins[64], text[4096], wanted[128] = "", *order;
        dea_symbol symbol;
        const dea_scene scene = scene_of(&kinds[i % KINDS], 0.0);
        assert_true(i >= KINDS || dea_symbol_of_part(&scene, scene.models[0], NULL, &symbol));
        symbol = i < KINDS ? symbol : others[i - KINDS];
        assert_true(pins_of(symbol.name, pins));
        FILE *file = child_open("symbol", "w+");
        dea_symbol_kicad_begin(file);
        dea_symbol_kicad(file, &symbol, "dea.lib");
        dea_symbol_kicad_end(file);
        rewind(file);
        text[fread(text, 1, sizeof text - 1, file)] = '\0';
        fclose(file);
        size_t number = 1;
        for (char *pin = strtok(pins, " "); pin; pin = strtok(NULL, " "), number++) {
            snprintf(wanted + strlen(wanted), sizeof wanted - strlen(wanted), "%s%zu=%s", number > 1 ? " " : "\"", number, pin);
            assert_string_equal(pin, symbol.pins[number - 1]);
        }
        assert_int_equal(number - 1, symbol.pin_count);
        assert_non_null(strstr(text, wanted));
        int depth = 0;
        for (const char *c = text; *c; c++) {
            depth += *c == '(' ? 1 : *c == ')' ? -1 : 0;
            assert_true(depth > 0 || c[1] == '\n' || c[1] == '\0');
        }
        assert_int_equal(depth, 0);
        file = child_open("symbol", "w+");
        dea_symbol_ltspice(file, &symbol, "dea.lib");
        rewind(file);
        text[fread(text, 1, sizeof text - 1, file)] = '\0';
        fclose(file);
        order = text;
        for (size_t k = 0; k < symbol.pin_count; k++) {
            snprintf(wanted, sizeof wanted, "PINATTR PinName %s\nPINATTR SpiceOrder %zu\n", symbol.pins[k], k + 1);
            order = strstr(order, wanted);
            assert_non_null(order);
        }
    }
}

static void compare_file(const char *kept, const char *made)
{
    char path[CHILD_PATH + 64];
    int a, b;
    snprintf(path, sizeof path, "netlists/%s", kept);
    FILE *old = fopen(path, "r");
    FILE *new = child_open(made, "r");
    if (!old) {
        fail_msg("%s is missing: run make netlists", path);
    }
    do {
        a = fgetc(old);
        b = fgetc(new);
    } while (a == b && a != EOF);
    fclose(old);
    fclose(new);
    if (a != b) {
        fail_msg("%s is not what the program makes: run make netlists", path);
    }
}

/* The checked-in library is the one that this source makes, file by file. */
static void the_ready_made_library_is_up_to_date(void **state)
{
    (void)state;
    char folder[CHILD_PATH], command[2 * CHILD_PATH], line[CHILD_PATH / 2];
    dea_error error = {0};
    int files = 0;
    child_path("netlists", folder);
    assert_int_equal(dea_library_write(folder, &error), DEA_OK);
    snprintf(command, sizeof command, "cd '%s' && find * -type f", folder);
    FILE *list = popen(command, "r");
    assert_non_null(list);
    while (fgets(line, sizeof line, list)) {
        char made[CHILD_PATH - 32];
        line[strcspn(line, "\n")] = '\0';
        snprintf(made, sizeof made, "netlists/%s", line);
        compare_file(line, made);
        files++;
    }
    pclose(list);
    assert_int_equal(files, 18);
    FILE *stale = popen("find netlists -type f | wc -l", "r");
    assert_non_null(stale);
    assert_int_equal(fscanf(stale, "%d", &files), 1);
    pclose(stale);
    assert_int_equal(files, 19); /* with its README */
    assert_int_equal(dea_library_write("/nonexistent/netlists", &error), DEA_ERROR_IO);
}

int main(int argc, char **argv)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(statics_are_those_of_the_models),
        cmocka_unit_test(motion_is_that_of_the_engine_ida),
        cmocka_unit_test(coated_films_and_pairs_of_films_move_as_in_the_engine_ida),
        cmocka_unit_test(responses_are_those_of_the_linearised_equations),
        cmocka_unit_test(springs_in_parallel_share_the_force_at_the_operating_point),
        cmocka_unit_test(the_energy_drawn_is_work_and_stores_and_losses),
        cmocka_unit_test(instances_of_different_numbers_nest_two_deep_under_long_names),
        cmocka_unit_test(a_step_of_a_nanosecond_converges),
        cmocka_unit_test(a_step_of_a_nanosecond_converges_in_every_order_of_the_parts),
        cmocka_unit_test(neither_compatibility_modes_nor_uic_change_a_number),
        cmocka_unit_test(m_parts_in_one_are_as_many_side_by_side),
        cmocka_unit_test(options_of_the_circuit_change_no_answer),
        cmocka_unit_test(parameters_out_of_range_are_flagged_and_move_nothing),
        cmocka_unit_test(a_part_of_any_law_stands_where_the_model_does),
        cmocka_unit_test(a_part_whose_permittivity_follows_the_strain_stands_where_the_model_does),
        cmocka_unit_test(a_part_with_a_skin_stands_where_the_model_does),
        cmocka_unit_test(a_part_of_two_films_stands_where_the_scene_does),
        cmocka_unit_test(a_film_past_pull_in_is_flagged),
        cmocka_unit_test(a_spring_on_the_edge_is_the_load_of_a_scene),
        cmocka_unit_test(a_force_and_a_film_on_the_edge_are_those_of_a_scene),
        cmocka_unit_test(a_lever_of_minus_one_sets_two_dots_against_each_other),
        cmocka_unit_test(a_scene_becomes_a_part_with_its_numbers_and_a_harmless_title),
        cmocka_unit_test(parts_of_different_names_share_a_circuit),
        cmocka_unit_test(names_of_parts_are_those_that_simulators_take),
        cmocka_unit_test(gnucap_gives_the_same_mechanics),
        cmocka_unit_test(every_line_of_every_dialect_keeps_to_what_simulators_share),
        cmocka_unit_test(the_lint_finds_what_simulators_read_differently),
        cmocka_unit_test(symbols_name_the_pins_of_their_parts_in_order),
        cmocka_unit_test(the_ready_made_library_is_up_to_date),
    };
    cmocka_set_test_filter(argc > 1 ? argv[1] : NULL);
    return cmocka_run_group_tests(tests, setup, child_teardown);
}
