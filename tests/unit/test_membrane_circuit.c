/* The moving membrane stepped by ngspice, and its netlist as a user runs it, against the table of steps, which a spectral code made,
 * and against the other engine, which knows no netlist. */
#include <stdlib.h>

#include "moving_membrane.h"
#include "netlist/export.h"
#include "ngspice_child.h"

enum { MOST_ROWS = 512 };

typedef struct run_list {
    dea_sample rows[MOST_ROWS];
    size_t count;
    char log[256]; /* the first line */
} run_list;

static dea_status take_rows(void *user, size_t first, const void *points, size_t count, dea_error *error)
{
    run_list *list = user;
    (void)first, (void)error;
    assert_int_equal(count, 1);
    memcpy(list->rows, points, list->count * sizeof *list->rows);
    return DEA_OK;
}

static void hear(void *user, const char *line)
{
    run_list *list = user;
    if (list->log[0] == '\0') {
        snprintf(list->log, sizeof list->log, "%s", line);
    }
}

static void run(const dea_scene *scene, const char *engine, run_list *list)
{
    dea_error error = {0};
    const dea_run_options options = {.jobs = 1, .points = take_rows, .log = hear, .user = list};
    *list = (run_list){.count = dea_layout_of(scene).rows};
    assert_true(list->count <= MOST_ROWS);
    if (dea_study_run(scene, dea_engine_find(engine), &options, &error) != DEA_OK) {
        fail_msg("%s: %s", engine, error.message);
    }
}

/* The paper's film with mass and damper under a step of 4.5 kV that rises in 0.1 ms. */
static dea_scene step_scene(dea_kind kind, double coverage)
{
    dea_scene scene = fe_step_scene(kind, 1.2, coverage, 4500.0, 1e-4);
    scene.models[0] = dea_model_find("field");
    scene.material.retardation = 5e-5;
    scene.accuracy = 1e-4;
    return scene;
}

static const struct {
    double coverage, peak, strain[4]; /* at 1, 2, 4, 8 ms */
} table[] = {
    {0.50, 0.0678036, {0.0674155, 0.0333990, 0.0443810, 0.0456962}},
    {0.25, 0.0756050, {0.0741705, 0.0518654, 0.0610839, 0.0613304}},
    {0.75, 0.0305977, {0.0290929, 0.0200565, 0.0239188, 0.0234764}},
};

static void a_step_is_that_of_the_table(void **state)
{
    (void)state;
    static run_list list;
    for (size_t i = 0; i < sizeof table / sizeof *table; i++) {
        dea_scene scene = step_scene(DEA_DOT, table[i].coverage);
        double peak = 0.0;
        scene.accuracy = i == 0 ? 1e-5 : 1e-3;
        run(&scene, "ngspice", &list);
        for (size_t k = 0; k < 4; k++) {
            assert_near(list.rows[50 << k].strain, table[i].strain[k], scene.accuracy * table[i].peak);
        }
        for (size_t k = 0; k < list.count; k++) {
            peak = fmax(peak, list.rows[k].strain);
        }
        assert_near(peak, table[i].peak, scene.accuracy * table[i].peak);
    }
}

/* Random films, against finite elements that know no rings: so many; "all" on the command line runs a hundred. */
static int scenes = 2;

static void random_steps_keep_their_promises(void **state)
{
    (void)state;
    static run_list list;
    uint64_t seed = UINT64_C(20260101);
    for (int i = 0; i < scenes; i++) {
        dea_scene scene = fe_random_step(&seed);
        scene.models[0] = dea_model_find("field");
        run(&scene, "ngspice", &list);
        if (list.rows[0].state == DEA_STATE_FAILED) {
            fail_msg("scene %d: %s", i, list.log);
        }
        const double broken = fe_broken(&scene, list.rows, list.count);
        if (!(broken <= 1.0)) {
            fail_msg("scene %d: %.3g times the accuracy, %g", i, broken, scene.accuracy);
        }
    }
}

/* One of the ways in which a film can be built and driven. */
enum { MASS = 1, DAMPER = 2, BRANCHES = 4, SERIES = 8, LEAK = 16, SKIN = 32, LOAD = 64, LAYERS = 128, LENS = 256, BIAS = 512 };

static dea_scene way_scene(unsigned way)
{
    dea_scene scene = step_scene(way & LENS ? DEA_LENS : DEA_DOT, way & LENS ? 0.45 : 0.4);
    scene.accuracy = 1e-3;
    scene.transient = (dea_transient){.until = 2e-3, .every = 1e-4, .from_bias = way & BIAS};
    scene.material.density = way & MASS ? 1080.0 : (double)NAN;
    scene.material.retardation = way & DAMPER ? 1e-4 : (double)NAN;
    scene.material.prony_count = way & BRANCHES ? 2 : 0;
    scene.material.prony[0] = (dea_prony){0.1, 3e-4};
    scene.material.prony[1] = (dea_prony){0.05, 0.2};
    scene.drive.series_resistance = way & SERIES ? 1e6 : (double)NAN;
    scene.drive.leakage_resistance = way & LEAK ? 1e8 : (double)NAN;
    scene.actuator.layers = way & LAYERS ? 3.0 : 1.0;
    if (way & SKIN) {
        scene.electrode = (dea_electrode){.law = dea_law_find("neo_hookean"), .entry_count = 1, .constants = {2e5},
                                          .thickness = 25e-6, .density = 1010.0, .sheet_resistance = (double)NAN};
    }
    if (way & LOAD) {
        *dea_scene_load(&scene, "mass") = 1e-4;
        *dea_scene_load(&scene, "stiffness") = 300.0;
    }
    return scene;
}

static double largest_of(const run_list *list, size_t column)
{
    double largest = 0.0;
    for (size_t i = 0; i < list->count; i++) {
        largest = fmax(largest, fabs(*(const double *)((const char *)&list->rows[i] + column)));
    }
    return largest;
}

/* Columns of a sample and what they may be off by, in accuracies. */
static const struct {
    size_t offset;
    double allowed;
} columns[] = {{offsetof(dea_sample, displacement), 1.0}, {offsetof(dea_sample, velocity), 10.0}, {offsetof(dea_sample, force), 10.0},
               {offsetof(dea_sample, film_voltage), 10.0}, {offsetof(dea_sample, charge), 10.0}, {offsetof(dea_sample, current), 10.0}};

static void every_way_is_that_of_the_other_engine(void **state)
{
    static const unsigned ways[] = {BRANCHES, BRANCHES | SERIES | LEAK, DAMPER, DAMPER | BRANCHES | LENS, MASS | DAMPER | BRANCHES,
                                    MASS | DAMPER | SERIES | SKIN, BRANCHES | SKIN | LOAD, DAMPER | LAYERS | LEAK | LENS,
                                    MASS | DAMPER | LOAD | LENS, BRANCHES | BIAS, DAMPER | SERIES | BIAS};
    static double times[] = {0.0, 1e-3, 2e-3}, voltages[] = {3000.0, 3800.0, 1000.0};
    static run_list mine, theirs;
    (void)state;
    for (size_t w = 0; w < sizeof ways / sizeof *ways; w++) {
        dea_scene scene = way_scene(ways[w]);
        if (ways[w] & BIAS) {
            scene.drive.waveform = (dea_waveform){
                .kind = DEA_WAVE_POINTS, .times = times, .voltages = voltages, .point_count = 3, .period = (double)NAN};
        }
        run(&scene, "ngspice", &mine);
        const double accuracy = scene.accuracy;
        scene.accuracy = 1e-5;
        run(&scene, "ida", &theirs);
        for (size_t c = 0; c < sizeof columns / sizeof *columns; c++) {
            const double scale = largest_of(&theirs, columns[c].offset);
            for (size_t i = 0; i < mine.count && scale > 0.0; i++) {
                const double got = *(const double *)((const char *)&mine.rows[i] + columns[c].offset);
                const double wanted = *(const double *)((const char *)&theirs.rows[i] + columns[c].offset);
                if (!(fabs(got - wanted) <= 1.1 * columns[c].allowed * accuracy * scale) && !(isnan(got) && isnan(wanted))) {
                    fail_msg("way %u, row %zu, column %zu: %.9g, wanted %.9g, of %.3g", ways[w], i, c, got, wanted, scale);
                }
                assert_int_equal(mine.rows[i].state, theirs.rows[i].state);
            }
        }
    }
}

/* A slow ramp takes a film without mass through slack to pull-in: statics say where. */
static void a_slow_lens_ends_where_statics_say(void **state)
{
    (void)state;
    static run_list list;
    dea_scene scene = step_scene(DEA_LENS, 0.4);
    scene.material = paper_material();
    scene.material.constants[0] = 22e3;
    scene.material.constants[1] = scene.material.constants[2] = 0.0;
    scene.drive.waveform.step.voltage = 13000.0;
    scene.drive.waveform.step.rise = 1.0;
    scene.transient = (dea_transient){.until = 1.0, .every = 1.0 / 64.0};
    run(&scene, "ngspice", &list);
    size_t last = 0;
    while (last + 1 < list.count && list.rows[last + 1].state != DEA_STATE_PULL_IN) {
        last++;
    }
    assert_true(last > 8 && last + 1 < list.count);
    for (size_t i = 1; i < list.count; i++) {
        scene.drive.voltage = list.rows[i].voltage;
        const dea_row row = solve_direct(&scene, "field");
        assert_int_equal(list.rows[i].state, row.state);
        if (i <= last) {
            assert_near(list.rows[i].displacement, row.displacement, scene.accuracy * fabs(list.rows[last].displacement));
        } else {
            assert_true(isnan(list.rows[i].displacement));
        }
    }
}

static void a_swing_of_too_many_steps_says_so(void **state)
{
    (void)state;
    static run_list list;
    dea_scene scene = step_scene(DEA_DOT, 0.5);
    scene.material.retardation = (double)NAN;
    scene.transient = (dea_transient){.until = 20.0, .every = 0.1};
    run(&scene, "ngspice", &list);
    assert_int_equal(list.rows[0].state, DEA_STATE_FAILED);
    assert_non_null(strstr(list.log, "time steps"));
    assert_non_null(strstr(list.log, "--engine ida"));
}

/* The netlist by `ngspice -b`: its time step is one for the whole run, its error that of the accuracy. */
static void an_exported_step_runs_by_itself(void **state)
{
    (void)state;
    child_run child;
    dea_error error = {0};
    dea_scene scene = step_scene(DEA_DOT, 0.5);
    scene.accuracy = 1e-3;
    scene.transient.until = 1e-3;
    dea_export export = {.scene = &scene, .dialect = dea_dialect_at(0), .analogy = dea_analogy_at(0), .out = child_open("step.cir", "w")};
    if (dea_export_netlist(&export, &error) != DEA_OK) {
        fail_msg("%s", error.message);
    }
    assert_int_equal(fclose(export.out), 0);
    child_must_run("step.cir", &child);
    assert_near(child_last(&child, "v(disp)"), 0.015 * table[0].strain[0], 1e-3 * 0.015 * table[0].peak);
    child_end(&child);
}

int main(int argc, char **argv)
{
    scenes = argc > 2 && strcmp(argv[2], "all") == 0 ? 100 : scenes;
    cmocka_set_test_filter(argc > 1 ? argv[1] : NULL);
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_step_is_that_of_the_table),
        cmocka_unit_test(random_steps_keep_their_promises),
        cmocka_unit_test(every_way_is_that_of_the_other_engine),
        cmocka_unit_test(a_slow_lens_ends_where_statics_say),
        cmocka_unit_test(a_swing_of_too_many_steps_says_so),
        cmocka_unit_test(an_exported_step_runs_by_itself),
    };
    return cmocka_run_group_tests(tests, child_setup, child_teardown);
}
