/* One table of random scenes over all engines: equal numbers, equal states, and a balance of forces that neither engine computes.
 */
#include "judges.h"
#include "random_scenes.h"

#include <stdlib.h>

#include "scene/line.h"

enum { SCENES = 84, POINTS = 6, MOST_ROWS = 64 };

typedef struct row_list {
    dea_row rows[MOST_ROWS];
    size_t count;
} row_list;

static dea_status take_rows(void *user, size_t first, const void *points, size_t count, dea_error *error)
{
    const dea_row *rows = points;
    row_list *list = user;
    (void)error;
    assert_int_equal(first, list->count);
    assert_true(first + count <= MOST_ROWS);
    memcpy(&list->rows[first], rows, count * sizeof *rows);
    list->count += count;
    return DEA_OK;
}

static row_list run(const dea_scene *scene, const char *engine)
{
    row_list list = {.count = 0};
    dea_error error = {0};
    const dea_run_options options = {.jobs = 1, .points = take_rows, .user = &list};
    if (dea_study_run(scene, dea_engine_find(engine), &options, &error) != DEA_OK) {
        fail_msg("%s: %s", engine, error.message);
    }
    assert_int_equal(list.count, dea_scene_point_count(scene));
    return list;
}

typedef struct long_list {
    dea_row rows[3000];
    size_t count;
} long_list;

static dea_status take_long(void *user, size_t first, const void *points, size_t count, dea_error *error)
{
    const dea_row *rows = points;
    long_list *list = user;
    (void)error;
    assert_int_equal(first, list->count);
    memcpy(&list->rows[first], rows, count * sizeof *rows);
    list->count += count;
    return DEA_OK;
}

/* A scene of the table with its one axis. */
typedef struct table_entry {
    dea_scene scene;
    dea_axis axis;
    double values[POINTS];
} table_entry;

static double swept_value(uint64_t *seed, int kind, double value, double share)
{
    switch (kind) {
    case 0:
        return value * share;
    case 1:
        return random_coverage(seed);
    case 5:
        return random_between(seed, 1.0, 3.0);
    case 12:
        return random_between(seed, 0.01, 0.6);
    default:
        return value * random_between(seed, 0.6, 1.3);
    }
}

static bool is_slack_below(const dea_scene *scene)
{
    dea_scene half = *scene;
    half.drive.voltage *= 0.8;
    return solve_direct(&half, "field").state != DEA_STATE_OK && fabs(scene->drive.voltage) > 1e-3;
}

static void make_entry(table_entry *entry, int number, const char *model)
{
    uint64_t seed = 1000003u * (uint64_t)(number + 1);
    const int kind = number % SWEPT_FIELDS;
    entry->scene = random_scene(&seed);
    entry->scene.accuracy = 1e-9;
    if (!dea_model_find(model)->lens) {
        entry->scene.actuator.kind = DEA_DOT;
    }
    double *field = swept_field(&entry->scene, kind);
    entry->scene.drive.voltage = 2.0 * random_unit(&seed) * pull_in_voltage(&entry->scene, model);
    while (dea_model_find(model)->membrane && is_slack_below(&entry->scene)) {
        entry->scene.drive.voltage *= 0.7; /* a film so far past its tension takes IDA a minute or more */
    }
    if (number % 3 == 0) {
        entry->scene.drive.voltage *= -1e-3;
    }
    for (int i = 0; i < POINTS; i++) {
        entry->values[i] = swept_value(&seed, kind, *field, (double)i / (POINTS - 1));
    }
    add_axis(&entry->scene, &entry->axis, field, entry->values, POINTS);
    if (number % 2 == 0) {
        const double from = entry->values[0];
        const double to = entry->values[POINTS - 1];
        for (int i = 0; i < POINTS; i++) {
            entry->values[i] = from + (to - from) * i / (POINTS - 1);
        }
        entry->axis.uniform = true;
    }
    entry->scene.models[0] = dea_model_find(model);
}

static dea_scene point_of(const table_entry *entry, size_t point)
{
    dea_scene scene = entry->scene;
    dea_axis_set(&entry->axis, &scene, entry->values[point]);
    return scene;
}

/* True where the state changes within 1e-7 of the voltage. */
static bool at_a_limit(const table_entry *entry, size_t point)
{
    dea_scene scene = point_of(entry, point);
    const char *model = scene.models[0]->name;
    const double voltage = scene.drive.voltage;
    const dea_state state = solve_direct(&scene, model).state;
    scene.drive.voltage = voltage * (1.0 + 1e-7);
    const dea_state above = solve_direct(&scene, model).state;
    scene.drive.voltage = voltage * (1.0 - 1e-7);
    return above != state || solve_direct(&scene, model).state != state;
}

static void tell(const table_entry *entry, size_t point, const char *engine, const dea_row *row, const dea_row *wanted)
{
    const dea_scene scene = point_of(entry, point);
    const dea_actuator *a = &scene.actuator;
    const dea_material *m = &scene.material;
    print_error(
        "%s, %s %s, axis %zu: pre-stretch %.17g B %.17g r_a %.17g r %.17g H %.17g U %.17g C %.17g %.17g %.17g eps %.17g %.17g "
        "Y %.17g share %.17g\n",
        engine, scene.models[0]->name, a->kind == DEA_DOT ? "dot" : "lens", point, a->prestretch, a->coverage, a->divide_radius,
        a->frame_radius, a->film_thickness, scene.drive.voltage, m->constants[0], m->constants[1], m->constants[2], m->permittivity,
        m->permittivity_per_stretch, m->modulus, dea_material_long_term_share(m));
    print_error("  strain %.17g (%s), wanted %.17g (%s), force %.17g, %.17g, field %.17g, %.17g\n", row->strain,
                dea_state_name(row->state), wanted->strain, dea_state_name(wanted->state), row->force, wanted->force, row->field,
                wanted->field);
}

/* At strains beyond 0.3, where the film is long slack, the membrane's last digit is hard to come by: ten times the tolerance. */
static bool same_numbers(const dea_row *row, const dea_row *wanted, double tolerance)
{
    tolerance *= fabs(wanted->strain) > 0.3 ? 10.0 : 1.0;
    if (wanted->state == DEA_STATE_PULL_IN || wanted->state == DEA_STATE_FAILED) {
        return isnan(row->strain) && isnan(row->displacement) && isnan(row->force) && isnan(row->field);
    }
    tolerance += wanted->strain != 0.0 ? 4e-16 / fabs(wanted->strain)
                                       : 0.0; /* a solver with terms of the size of the stretch loses digits of a tiny strain */
    return is_close(row->strain, wanted->strain, tolerance, 0.0) &&
           is_close(row->displacement, wanted->displacement, tolerance, 0.0) &&
           is_close(row->force, wanted->force, tolerance, 0.0) && is_close(row->field, wanted->field, tolerance, 0.0);
}

/* Beyond the loss of tension the numbers are those of a film that could bear pressure: there an engine may refuse by name, with
 * no number. */
static bool refused_beyond_tension(const dea_row *a, const dea_row *b)
{
    const bool a_refused = isnan(a->strain);
    const bool b_refused = isnan(b->strain);
    return (a_refused && b_refused) || (a_refused && b->state == DEA_STATE_SLACK) || (b_refused && a->state == DEA_STATE_SLACK);
}

/* Forces of the row against each other, by formulas of the test. */
static bool balances(const dea_scene *scene, const dea_row *row)
{
    const char *model = scene->models[0]->name;
    const double b = judged_film_of(scene).coverage;
    if (isnan(row->strain) || row->strain == 0.0 || scene->models[0]->membrane) {
        return true;
    }
    if (!is_close(row->displacement, row->strain * b * scene->actuator.frame_radius, 1e-14, 0.0)) {
        return false;
    }
    if (!strcmp(model, "lumped") || !strcmp(model, "lame")) {
        return judge_linear(scene, row, !strcmp(model, "lame")) < 2e-9;
    }
    if (!strcmp(model, "ring")) {
        const judged_balance rings = judged_ring_of(scene);
        return is_close((double)judged_share(&rings, fabs(row->strain)), 1.0, 1e-8 + 1e-14 / fabs(row->strain), 0.0);
    }
    const judged_balance balance = judged_balance_of(scene, !strcmp(model, "constant_force"));
    const double active = scene->actuator.kind == DEA_DOT ? row->strain : -row->strain * b / (1.0 - b);
    return is_close((double)judged_share(&balance, active), 1.0, 1e-8 + 1e-14 / fabs(active), 0.0);
}

typedef struct tally {
    size_t slack;                               /* rows that one engine refuses beyond the loss of tension */
    size_t compared, strained, refused, limits; /* rows; of them with strain; without numbers; near limits or given up past one */
    size_t wrong;
} tally;

static void compare_entry(const table_entry *entry, const char *engine, double tolerance, tally *count)
{
    const row_list wanted = run(&entry->scene, "direct");
    const row_list got = run(&entry->scene, engine);
    for (size_t i = 0; i < POINTS; i++) {
        const bool same_state = got.rows[i].state == wanted.rows[i].state;
        count->compared++;
        count->strained += wanted.rows[i].strain != 0.0 && !isnan(wanted.rows[i].strain);
        count->refused += isnan(wanted.rows[i].strain) ? 1 : 0;
        const dea_scene scene = point_of(entry, i);
        if (same_state && same_numbers(&got.rows[i], &wanted.rows[i], tolerance) && balances(&scene, &got.rows[i])) {
            continue;
        }
        const bool given_up = got.rows[i].state == DEA_STATE_FAILED && wanted.rows[i].state == DEA_STATE_PULL_IN;
        if (at_a_limit(entry, i) || given_up) {
            count->limits++;
            continue;
        }
        if (refused_beyond_tension(&got.rows[i], &wanted.rows[i])) {
            count->slack++;
            continue;
        }
        tell(entry, i, engine, &got.rows[i], &wanted.rows[i]);
        count->wrong++;
    }
}

/* One in refused_share rows at most may be refused beyond the loss of tension. */
static void compare_engines(const char *engine, const char *model, double tolerance, size_t refused_share)
{
    tally count = {0};
    for (int i = 0; i < SCENES; i++) {
        table_entry entry;
        make_entry(&entry, i, model);
        compare_entry(&entry, engine, tolerance, &count);
    }
    assert_int_equal(count.wrong, 0);
    assert_int_equal(count.compared, SCENES * POINTS);
    assert_true(count.strained > count.compared / 3);
    assert_true(count.limits < 8);
    assert_true(count.slack < count.compared / refused_share);
}

static void ngspice_solves_lumped_as_the_equation_does(void **state)
{
    (void)state;
    compare_engines("ngspice", "lumped", 1e-9, 20);
}

static void ngspice_solves_plane_elasticity_as_the_equation_does(void **state)
{
    (void)state;
    compare_engines("ngspice", "lame", 1e-9, 20);
}

static void ngspice_solves_coverage_and_ring_as_the_equation_does(void **state)
{
    (void)state;
    compare_engines("ngspice", "coverage", 1e-8, 20);
    compare_engines("ngspice", "ring", 1e-8, 20);
}

static void ngspice_solves_constant_force_as_the_equation_does(void **state)
{
    (void)state;
    compare_engines("ngspice", "constant_force", 1e-8, 20);
}

static void ida_solves_lumped_and_plane_elasticity_as_the_equation_does(void **state)
{
    (void)state;
    compare_engines("ida", "lumped", 1e-9, 20);
    compare_engines("ida", "lame", 1e-9, 20);
}

static void ida_solves_hyperelastic_models_as_the_equation_does(void **state)
{
    (void)state;
    compare_engines("ida", "coverage", 1e-9, 20);
    compare_engines("ida", "ring", 1e-9, 20);
    compare_engines("ida", "constant_force", 1e-9, 20);
}

static void ida_solves_the_field_as_shooting_does(void **state)
{
    (void)state;
    compare_engines("ida", "field", 1e-9, 5);
}

static const char *const engines[] = {"direct", "ngspice", "ida"};
static const char *const swept_models[] = {"lumped", "coverage", "lame", "ring", "constant_force", "field"};
enum { ENGINES = 3, SWEPT_MODELS = 6 };

static bool does(const char *engine, const dea_scene *scene)
{
    return !dea_engine_find(engine)->refuses(scene, scene->models[0]);
}

/* An electrode that is as large as the frame, or larger, fails alone. */
static void corners_without_a_film_fail_alone(void **state)
{
    (void)state;
    double radii[] = {0.01, 0.02, 0.03, 0.04, 0.015, 0.0, 0.029};
    for (size_t i = 0; i < ENGINES * SWEPT_MODELS; i++) {
        dea_scene scene = paper_scene(DEA_DOT, 1.2, (double)NAN, 3000.0);
        dea_axis axis;
        scene.models[0] = dea_model_find(swept_models[i / ENGINES]);
        add_axis(&scene, &axis, &scene.actuator.divide_radius, radii, 7);
        if (!does(engines[i % ENGINES], &scene)) {
            continue;
        }
        const row_list list = run(&scene, engines[i % ENGINES]);
        for (size_t k = 0; k < list.count; k++) {
            const bool fits = radii[k] > 0.0 && radii[k] < 0.03;
            assert_state(list.rows[k], fits ? DEA_STATE_OK : DEA_STATE_FAILED);
            assert_true(fits == (list.rows[k].strain > 0.0));
        }
    }
}

static void sweep_from_no_voltage_starts_at_rest(void **state)
{
    (void)state;
    double voltages[] = {0.0, 1000.0, 0.0, -2000.0, 0.0};
    for (size_t i = 0; i < ENGINES * SWEPT_MODELS; i++) {
        dea_scene scene = paper_scene(DEA_DOT, 1.2, 0.4, 0.0);
        dea_axis axis;
        scene.models[0] = dea_model_find(swept_models[i / ENGINES]);
        add_axis(&scene, &axis, &scene.drive.voltage, voltages, 5);
        if (!does(engines[i % ENGINES], &scene)) {
            continue;
        }
        const row_list list = run(&scene, engines[i % ENGINES]);
        for (size_t k = 0; k < list.count; k++) {
            const dea_row *row = &list.rows[k];
            assert_state(*row, DEA_STATE_OK);
            assert_true((voltages[k] == 0.0) ==
                        (row->strain == 0.0 && row->force == 0.0 && row->field == 0.0 && row->displacement == 0.0));
            assert_true(row->strain >= 0.0 && row->field >= 0.0);
        }
    }
}

/* Three axes of 3, 4 and 5 values. */
typedef struct grid {
    dea_scene scene;
    dea_axis axes[3];
    double coverages[3], voltages[4], prestretches[5];
} grid;

static void make_grid(grid *g, const char *model)
{
    *g = (grid){.scene = paper_scene(DEA_LENS, 1.2, 0.4, 0.0),
                .coverages = {0.2, 0.5, 0.8},
                .voltages = {500.0, 4500.0, 2000.0, 3000.0},
                .prestretches = {1.05, 1.1, 1.15, 1.2, 1.25}};
    dea_scene *scene = &g->scene;
    scene->accuracy = 1e-8;
    scene->models[0] = dea_model_find(model);
    add_axis(scene, &g->axes[0], &scene->actuator.coverage, g->coverages, 3);
    add_axis(scene, &g->axes[1], &scene->drive.voltage, g->voltages, 4);
    add_axis(scene, &g->axes[2], &scene->actuator.prestretch, g->prestretches, 5);
    g->axes[2].uniform = true;
    scene->axes = g->axes;
    scene->axis_count = 3;
}

static dea_row row_of_grid(const grid *g, size_t point)
{
    dea_scene scene = g->scene;
    scene.actuator.coverage = g->coverages[point / 20];
    scene.drive.voltage = g->voltages[point / 5 % 4];
    scene.actuator.prestretch = g->prestretches[point % 5];
    return solve_direct(&scene, scene.models[0]->name);
}

static void grid_has_its_last_axis_fastest(void **state)
{
    (void)state;
    for (size_t i = 0; i < ENGINES * SWEPT_MODELS; i++) {
        grid g;
        make_grid(&g, swept_models[i / ENGINES]);
        if (!g.scene.models[0]->lens || !does(engines[i % ENGINES], &g.scene)) {
            continue;
        }
        const row_list list = run(&g.scene, engines[i % ENGINES]);
        assert_int_equal(list.count, 60);
        for (size_t k = 0; k < list.count; k++) {
            const dea_row wanted = row_of_grid(&g, k);
            assert_state(list.rows[k], wanted.state);
            assert_relative(list.rows[k].strain, wanted.strain, 1e-8);
            assert_relative(list.rows[k].force, wanted.force, 1e-8);
        }
    }
}

static void any_part_of_a_sweep_has_the_rows_of_the_whole(void **state)
{
    (void)state;
    uint64_t seed = 31;
    for (int i = 0; i < 300; i++) {
        grid g;
        make_grid(&g, swept_models[i % 3]);
        dea_row rows[62];
        const size_t first = (size_t)(60.0 * random_unit(&seed));
        const size_t count = 1 + (size_t)((double)(60 - first) * random_unit(&seed));
        memset(rows, 0x5a, sizeof rows);
        const dea_row untouched = rows[61];
        assert_int_equal(dea_engine_find("direct")->sweep(NULL, &g.scene, g.scene.models[0], first, count, rows + 1, NULL),
                         DEA_OK);
        assert_memory_equal(&rows[0], &untouched, sizeof untouched);
        assert_memory_equal(&rows[count + 1], &untouched, sizeof untouched);
        for (size_t k = 0; k < count; k++) {
            const dea_row wanted = row_of_grid(&g, first + k);
            assert_memory_equal(&rows[k + 1], &wanted, offsetof(dea_row, state));
            assert_state(rows[k + 1], wanted.state);
        }
    }
}

/* The last of many points along an axis that ngspice steps through, some 3000 in one circuit, is as good as the first. */
static void long_sweep_does_not_drift(void **state)
{
    (void)state;
    enum { LONG = 3000 };
    static double values[LONG];
    static dea_row rows[LONG];
    const dea_engine *direct = dea_engine_find("direct");
    for (size_t i = 0; i < LONG; i++) {
        values[i] = 10.0 + (4500.0 - 10.0) * (double)i / (LONG - 1);
    }
    for (size_t m = 0; m < 4; m++) {
        dea_scene scene = paper_scene(DEA_DOT, 1.2, 0.4, 0.0);
        dea_axis axis;
        scene.models[0] = dea_model_find(swept_models[m]);
        add_axis(&scene, &axis, &scene.drive.voltage, values, LONG);
        axis.uniform = true;
        long_list got = {.count = 0};
        const dea_run_options options = {.jobs = 2, .points = take_long, .user = &got};
        assert_int_equal(dea_study_run(&scene, dea_engine_find("ngspice"), &options, NULL), DEA_OK);
        assert_int_equal(direct->sweep(NULL, &scene, scene.models[0], 0, LONG, rows, NULL), DEA_OK);
        assert_int_equal(got.count, LONG);
        for (size_t i = 0; i < LONG; i++) {
            assert_relative(got.rows[i].strain, rows[i].strain, 1e-9);
            assert_state(got.rows[i], DEA_STATE_OK);
        }
    }
}

/* An argument is a pattern of the tests to run. */
int main(int argc, char **argv)
{
    cmocka_set_test_filter(argc > 1 ? argv[1] : NULL);
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(ngspice_solves_lumped_as_the_equation_does),
        cmocka_unit_test(ngspice_solves_plane_elasticity_as_the_equation_does),
        cmocka_unit_test(ngspice_solves_coverage_and_ring_as_the_equation_does),
        cmocka_unit_test(ngspice_solves_constant_force_as_the_equation_does),
        cmocka_unit_test(ida_solves_lumped_and_plane_elasticity_as_the_equation_does),
        cmocka_unit_test(ida_solves_hyperelastic_models_as_the_equation_does),
        cmocka_unit_test(ida_solves_the_field_as_shooting_does),
        cmocka_unit_test(corners_without_a_film_fail_alone),
        cmocka_unit_test(sweep_from_no_voltage_starts_at_rest),
        cmocka_unit_test(grid_has_its_last_axis_fastest),
        cmocka_unit_test(any_part_of_a_sweep_has_the_rows_of_the_whole),
        cmocka_unit_test(long_sweep_does_not_drift),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
