/* Every example, through the library and through the program, against facts that neither of them made. Run from the project's
 * folder; DEASPICE names the program, else build/deaspice. */
#include "scenes.h"

#include <dirent.h>
#include <stdlib.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

enum { PATH_LENGTH = 4096, LINE_LENGTH = 512, MOST_ROWS = 8192 };

static char folder[] = "/tmp/deaspice-test-XXXXXX";
static char program[PATH_LENGTH];

/* An example with its rows by the library. */
typedef struct example {
    char path[64];
    dea_scene scene;
    dea_row rows[MOST_ROWS];
    size_t count;
} example;

static example here;

static dea_status take(void *user, size_t first, const void *points, size_t count, dea_error *error)
{
    const dea_row *rows = points;
    (void)user, (void)error;
    assert_true(first == here.count && first + count <= MOST_ROWS);
    memcpy(here.rows + first, rows, count * sizeof *rows);
    here.count += count;
    return DEA_OK;
}

static void run_program(const char *words)
{
    char command[3 * PATH_LENGTH];
    snprintf(command, sizeof command, "'%s' %s >/dev/null", program, words);
    const int ended = system(command);
    if (!WIFEXITED(ended) || WEXITSTATUS(ended) != 0) {
        fail_msg("%s", command);
    }
}

/* A picture: its ending decides how it must begin. */
static void check_picture(const char *name)
{
    char path[PATH_LENGTH], head[5] = "";
    struct stat about;
    snprintf(path, sizeof path, "%s/%s", folder, name);
    FILE *file = fopen(path, "r");
    assert_non_null(file);
    assert_int_equal(fread(head, 1, 4, file), 4);
    assert_int_equal(fclose(file), 0);
    assert_string_equal(head, strstr(name, ".svg") ? "<?xm" : "\x89PNG");
    assert_int_equal(stat(path, &about), 0);
    assert_true(about.st_size > 10000);
    assert_int_equal(unlink(path), 0);
}

/* The last cells of a line: the numbers of the layout, NAN where empty, and the state. */
static dea_row parse_row(const dea_layout *layout, char *line)
{
    dea_row row = dea_row_failed();
    char *cell = strrchr(line, ',');
    for (int state = 0; state < DEA_STATE_COUNT; state++) {
        if (strcmp(cell + 1, dea_state_name((dea_state)state)) == 0) {
            row.state = (dea_state)state;
        }
    }
    for (size_t i = layout->column_count; i-- > 0;) {
        *cell = '\0';
        cell = strrchr(line, ',');
        const double number = cell[1] ? strtod(cell + 1, NULL) : (double)NAN;
        memcpy((char *)&row + layout->columns[i].offset, &number, sizeof number);
    }
    return row;
}

static bool same(const dea_layout *layout, const dea_row *a, const dea_row *b)
{
    bool equal = a->state == b->state;
    for (size_t i = 0; i < layout->column_count; i++) {
        double one, other;
        memcpy(&one, (const char *)a + layout->columns[i].offset, sizeof one);
        memcpy(&other, (const char *)b + layout->columns[i].offset, sizeof other);
        equal = equal && (isnan(one) ? isnan(other) : one == other);
    }
    return equal;
}

/* The program prints what the library found, to the last bit. */
static void compare_csv(void)
{
    char path[PATH_LENGTH], line[LINE_LENGTH];
    size_t count = 0;
    const dea_layout layout = dea_layout_of(&here.scene);
    snprintf(path, sizeof path, "%s/rows.csv", folder);
    FILE *file = fopen(path, "r");
    assert_non_null(file);
    assert_non_null(fgets(line, sizeof line, file));
    for (; fgets(line, sizeof line, file); count++) {
        line[strcspn(line, "\n")] = '\0';
        const dea_row got = parse_row(&layout, line);
        if (!same(&layout, &got, &here.rows[count])) {
            fail_msg("%s, row %zu: the program and the library differ", here.path, count);
        }
    }
    assert_int_equal(fclose(file), 0);
    assert_int_equal(count, here.count);
}

/* Runs an example by the library and by the program, with both pictures; the rows of the one run last stay. */
static void run_example(const char *name)
{
    char path[sizeof here.path];
    snprintf(path, sizeof path, "examples/%s.yaml", name);
    if (strcmp(path, here.path) == 0 && here.count > 0) {
        return;
    }
    dea_error error = {0};
    const dea_run_options options = {.jobs = 1, .points = take};
    char words[2 * PATH_LENGTH];
    dea_scene_free(&here.scene);
    here.count = 0;
    memcpy(here.path, path, sizeof path);
    if (dea_scene_read(here.path, NULL, 0, NULL, &here.scene, &error) != DEA_OK) {
        here.scene = (dea_scene){0};
        fail_msg("%s", error.message);
    }
    assert_int_equal(dea_study_run(&here.scene, dea_engine_find("direct"), &options, &error), DEA_OK);
    assert_int_equal(here.count, dea_scene_point_count(&here.scene) * here.scene.model_count);
    for (int i = 0; i < 2; i++) {
        const char *picture = i == 0 ? "picture.svg" : "picture.png";
        snprintf(words, sizeof words, "run %s --quiet --engine direct -o %s/rows.csv --plot %s/%s", here.path, folder, folder,
                 picture);
        run_program(words);
        compare_csv();
        check_picture(picture);
    }
}

/* Index of a value on an axis, which must be there. */
static size_t index_of(const dea_axis *axis, double value)
{
    for (size_t i = 0; i < axis->count; i++) {
        if (is_close(axis->values[i], value, 1e-12, 1e-12)) {
            return i;
        }
    }
    fail_msg("%s: no %s of %g", here.path, axis->column, value);
    return 0;
}

/* Row of a model at the values of all axes in their order. */
static const dea_row *row_at(const char *model, double first, double second)
{
    const double values[] = {first, second};
    size_t row = 0;
    while (row < here.scene.model_count && strcmp(here.scene.models[row]->name, model) != 0) {
        row++;
    }
    assert_true(row < here.scene.model_count);
    for (size_t i = 0; i < here.scene.axis_count; i++) {
        row = row * here.scene.axes[i].count + index_of(&here.scene.axes[i], values[i]);
    }
    return &here.rows[row];
}

static double stress(const double c[3], double l)
{
    const double j = 2.0 * l * l + pow(l, -4.0) - 3.0;
    return 2.0 * (l * l - pow(l, -4.0)) * (c[0] + 2.0 * c[1] * j + 3.0 * c[2] * j * j);
}

/* What Eq. 18 leaves over, against the Maxwell stress; *passive gets lambda_P. */
static double left_over(const dea_scene *at, double strain, double *passive)
{
    const double pre = at->actuator.prestretch, b = at->actuator.coverage;
    const double nominal = at->drive.voltage / at->actuator.film_thickness;
    const double active = pre * (1.0 + strain);
    const double maxwell = 8.8541878128e-12 * at->material.permittivity * nominal * nominal * pow(active, 4.0);
    *passive = pre * (1.0 - b * (1.0 + strain)) / (1.0 - b);
    return (stress(at->material.constants, active) - maxwell - stress(at->material.constants, *passive)) / maxwell;
}

/* Every row of model number @p model with numbers balances the stresses of Eq. 18; returns how many do. */
static size_t check_balance(size_t model)
{
    const size_t points = dea_scene_point_count(&here.scene);
    size_t balanced = 0;
    for (size_t i = 0; i < points; i++) {
        const dea_row *row = &here.rows[model * points + i];
        dea_scene at = here.scene;
        size_t rest = i;
        for (size_t k = here.scene.axis_count; k-- > 0; rest /= here.scene.axes[k].count) {
            *(double *)((char *)&at + here.scene.axes[k].offset) = here.scene.axes[k].values[rest % here.scene.axes[k].count];
        }
        if (at.drive.voltage > 0.0 && row->state != DEA_STATE_PULL_IN) {
            double passive;
            assert_near(left_over(&at, row->strain, &passive), 0.0, 1e-8);
            assert_relative(row->displacement, row->strain * at.actuator.coverage * at.actuator.frame_radius, 1e-14);
            assert_int_equal(row->state == DEA_STATE_SLACK, row->state != DEA_STATE_BREAKDOWN && passive <= 1.0);
            balanced++;
        }
    }
    return balanced;
}

static double peak_coverage(const char *model, double prestretch)
{
    const dea_axis *axis = &here.scene.axes[1];
    size_t best = 0;
    for (size_t i = 0; i < axis->count; i++) {
        if (row_at(model, prestretch, axis->values[i])->displacement >
            row_at(model, prestretch, axis->values[best])->displacement) {
            best = i;
        }
    }
    return axis->values[best];
}

static void figure_8_gives_the_modulus_at_the_pre_stretches(void **state)
{
    static const double modulus[] = {1641976.87, 1391085.27, 1369207.21};
    char words[2 * PATH_LENGTH], path[PATH_LENGTH], line[LINE_LENGTH];
    size_t found = 0;
    (void)state;
    for (int i = 0; i < 2; i++) {
        snprintf(words, sizeof words, "materials elastosil-2030 -o %s/material.csv --plot %s/material.%s", folder, folder,
                 i ? "png" : "svg");
        run_program(words);
        check_picture(i ? "material.png" : "material.svg");
    }
    snprintf(path, sizeof path, "%s/material.csv", folder);
    FILE *file = fopen(path, "r");
    assert_non_null(file);
    while (fgets(line, sizeof line, file)) {
        const double stretch = strtod(line, NULL);
        for (int i = 0; i < 3; i++) {
            if (is_close(stretch, 1.1 + 0.1 * i, 0.0, 1e-9)) {
                assert_printed(strtod(strrchr(line, ',') + 1, NULL), modulus[i], 2);
                found++;
            }
        }
    }
    assert_int_equal(fclose(file), 0);
    assert_int_equal(unlink(path), 0);
    assert_int_equal(found, 3);
}

static void figure_9_ends_at_the_strains_of_equations_13_and_4(void **state)
{
    static const double force[] = {0.05309062, 0.08987201, 0.11020732}, pelrine[] = {0.02316297, 0.03965760, 0.05686845};
    (void)state;
    run_example("figure9");
    for (int i = 0; i < 3; i++) {
        assert_printed(row_at("constant_force", 1.1 + 0.1 * i, 4500.0)->strain, force[i], 8);
        assert_printed(row_at("pelrine", 1.1 + 0.1 * i, 4500.0)->strain, pelrine[i], 8);
    }
}

static void figure_10_passes_through_the_reference_strains(void **state)
{
    static const double table[][5] = {{1.1, 0.10, 0.04587737, 0.04028821, 0.03762647},
                                      {1.1, 0.50, 0.02218118, 0.02238234, 0.02651626},
                                      {1.2, 0.25, 0.05973380, 0.05612602, 0.06092621},
                                      {1.2, 0.50, 0.03569962, 0.03741735, 0.04503297},
                                      {1.3, 0.75, 0.02204766, 0.02618038, 0.03289753}};
    (void)state;
    run_example("figure10");
    for (size_t i = 0; i < sizeof table / sizeof *table; i++) {
        assert_printed(row_at("coverage", table[i][0], table[i][1])->strain, table[i][2], 8);
        assert_printed(row_at("lumped", table[i][0], table[i][1])->strain, table[i][3], 8);
        assert_printed(row_at("field", table[i][0], table[i][1])->strain, table[i][4], 8);
    }
    assert_int_equal(check_balance(1), 543);
}

static void figure_10_has_the_sensitivities_of_the_paper(void **state)
{
    (void)state;
    run_example("figure10");
    for (int i = 0; i < 3; i++) {
        const double pre = 1.1 + 0.1 * i;
        assert_printed(100.0 - 100.0 * row_at("lumped", pre, 0.48)->displacement / row_at("lumped", pre, 0.5)->displacement, 0.16,
                       2);
        assert_printed(100.0 - 100.0 * row_at("lumped", pre, 0.24)->displacement / row_at("lumped", pre, 0.25)->displacement,
                       2.72, 2);
    }
}

static void displacement_peaks_below_half_coverage_in_equation_18_and_above_it_in_the_field(void **state)
{
    (void)state;
    run_example("figure10");
    for (int i = 0; i < 3; i++) {
        const double pre = 1.1 + 0.1 * i;
        assert_near(peak_coverage("lumped", pre), 0.5, 1e-9);
        assert_true(peak_coverage("coverage", pre) < 0.4951 && peak_coverage("coverage", pre) > 0.4);
        assert_true(peak_coverage("field", pre) > 0.5049 && peak_coverage("field", pre) < 1.0 / sqrt(3.0));
    }
}

static void lens_shrinks_as_the_reference_strains_say(void **state)
{
    (void)state;
    run_example("lens-sweep");
    assert_printed(row_at("coverage", 0.25, 0.0)->strain, -0.04860329, 8);
    assert_printed(row_at("coverage", 0.50, 0.0)->strain, -0.03569962, 8);
    assert_printed(row_at("field", 0.25, 0.0)->strain, -0.04432166, 8);
    assert_printed(row_at("field", 0.50, 0.0)->strain, -0.03741631, 8);
    assert_printed(row_at("lumped", 0.50, 0.0)->strain, -0.03741735, 8); /* the dot's with its sign turned */
    for (size_t i = 0; i < here.count; i++) {
        assert_true(here.rows[i].strain < 0.0 && here.rows[i].state == DEA_STATE_OK);
    }
}

static void every_point_of_the_map_balances_its_stresses(void **state)
{
    (void)state;
    run_example("voltage-coverage-map");
    assert_int_equal(check_balance(0), 61 * 60); /* all but the row of no voltage */
    assert_int_equal(row_at("coverage", 0.5, 9000.0)->state, DEA_STATE_SLACK);
    assert_int_equal(row_at("coverage", 0.05, 9000.0)->state, DEA_STATE_OK);
}

static void soft_film_without_pre_stretch_pulls_in_at_the_voltage_of_a_free_edge(void **state)
{
    /* neo-Hookean, free edge: U/H = 0.6874 sqrt(mu/eps) at lambda = 4^(1/6), mu = 2 C1 */
    const double voltage = 0.6874 * sqrt(50e3 / (2.8 * 8.8541878128e-12)) * 1e-4;
    const dea_axis *axis;
    size_t states[DEA_STATE_COUNT] = {0};
    (void)state;
    run_example("pull-in");
    axis = &here.scene.axes[1];
    for (size_t i = 0; i < axis->count; i++) {
        const dea_row *row = row_at("constant_force", 1.0, axis->values[i]);
        assert_int_equal(row->state == DEA_STATE_PULL_IN, axis->values[i] > voltage);
        assert_true(row->state == DEA_STATE_PULL_IN ? isnan(row->strain) : row->strain < pow(4.0, 1.0 / 6.0) - 1.0);
    }
    check_balance(0);
    for (size_t i = 0; i < here.count; i++) {
        states[here.rows[i].state]++;
    }
    assert_true(states[DEA_STATE_OK] && states[DEA_STATE_SLACK] && states[DEA_STATE_PULL_IN] && states[DEA_STATE_BREAKDOWN]);
    assert_int_equal(states[DEA_STATE_FAILED], 0);
}

/* More film shares the skin; force and charge count five times. */
static void a_stack_strains_more_between_the_same_electrodes(void **state)
{
    (void)state;
    run_example("stack");
    const dea_row *film = row_at("field", 1.0, 4500.0), *five = row_at("field", 5.0, 4500.0);
    const double bare = 0.0450329722; /* without a skin (physics, section 8) */
    assert_true(film->strain < five->strain && five->strain < bare);
    assert_relative(bare - film->strain, 5.0 * (bare - five->strain), 0.2);
    assert_relative(five->force, 5.0 * film->force, 0.03);
}

/* What the film gives up goes into the spring: the force on the edge is that of the free film less its own stiffness. */
static void a_bias_spring_takes_what_the_film_leaves(void **state)
{
    (void)state;
    run_example("bias-spring");
    const dea_row *stiff = row_at("field", 1e4, 4500.0), *soft = row_at("field", 1.0, 4500.0);
    assert_relative(soft->strain, 0.0450329722, 2e-3);
    assert_relative(stiff->displacement, stiff->force / (1e4 + soft->force / soft->displacement), 0.02);
}

/* Two films alike but for their kind: each under its own voltage moves the edge half as far as it would alone, less what stiffens it,
 * and the one outward what the other does inward. */
static void antagonists_share_the_way_of_each(void **state)
{
    (void)state;
    run_example("antagonists");
    const dea_row *still = row_at("ring", 0.0, 0.0), *pushed = row_at("ring", 0.0, 4500.0), *pulled = row_at("ring", 4500.0, 0.0);
    const double alone = 0.0450329722, lens = -0.0374163; /* physics, section 3 */
    assert_true(still->strain == 0.0);
    assert_true(0.4 * alone < pushed->strain && pushed->strain < 0.5 * alone);
    assert_true(0.55 * lens < pulled->strain && pulled->strain < 0.45 * lens);
    const dea_row *both = row_at("ring", 4500.0, 4500.0);
    assert_true(pulled->strain < both->strain && both->strain < pushed->strain);
    assert_true(both->second_field > 5e7);
}

static void vhb_follows_the_closed_form_of_a_neo_hookean(void **state)
{
    const double c1 = 15.36e3 / 2.0;
    (void)state;
    run_example("vhb");
    for (size_t i = 0; i < here.scene.axes[1].count; i++) {
        const double pre = here.scene.axes[1].values[i], voltage = 2500.0;
        const double modulus = 4.0 * c1 * (pre + 2.0 * pow(pre, -5.0));
        const double maxwell = 4.8 * 8.8541878128e-12 * pow(voltage / 1e-3, 2.0) * pow(pre, 4.0);
        assert_relative(row_at("lumped", voltage, pre)->strain, 0.75 * maxwell / modulus, 1e-12);
        assert_true(row_at("field", voltage, pre)->strain > row_at("coverage", voltage, pre)->strain);
    }
    here.scene.material.constants[0] = c1; /* long-term */
    assert_true(check_balance(1) > 0);
}

static void sample_data_gives_back_the_constants_it_was_made_from(void **state)
{
    static const double wanted[] = {178426.0, -6023.0, 4234.0};
    char words[2 * PATH_LENGTH];
    dea_scene scene;
    dea_error error = {0};
    (void)state;
    snprintf(words, sizeof words, "fit examples/data/elastosil-2030.csv --quiet -o %s/film.yaml --plot %s/fit.svg", folder,
             folder);
    run_program(words);
    check_picture("fit.svg");
    char path[PATH_LENGTH];
    static const char text[] =
        "actuator: {kind: dot, frame_radius: 30 mm, coverage: 0.5, film_thickness: 100 um, prestretch: 1.2}\n"
        "material: {base: ./film.yaml, permittivity: 2.8}\n"
        "drive: {voltage: 1 V}\nmodel: lumped\nstudy: {sweep: {}}\n";
    if (dea_scene_parse(text, strlen(text), "fit", folder, NULL, 0, NULL, &scene, &error) != DEA_OK) {
        fail_msg("%s", error.message);
    }
    for (int i = 0; i < 3; i++) {
        assert_relative(scene.material.constants[i], wanted[i], 2e-2);
    }
    dea_scene_free(&scene);
    snprintf(path, sizeof path, "%s/film.yaml", folder);
    assert_int_equal(unlink(path), 0);
}

/* Runs a moving or a local example by the program, with both pictures; calls @p row with the cells of each. */
static size_t run_rows(const char *name, void (*row)(char *const *cells, size_t count))
{
    char words[2 * PATH_LENGTH], path[PATH_LENGTH], line[LINE_LENGTH];
    size_t rows = 0;
    snprintf(path, sizeof path, "%s/rows.csv", folder);
    for (int i = 0; i < 2; i++) {
        const char *picture = i == 0 ? "picture.svg" : "picture.png";
        snprintf(words, sizeof words, "run examples/%s.yaml --quiet -o %s --plot %s/%s", name, path, folder, picture);
        run_program(words);
        check_picture(picture);
    }
    FILE *file = fopen(path, "r");
    assert_non_null(file);
    assert_non_null(fgets(line, sizeof line, file));
    for (; fgets(line, sizeof line, file); rows++) {
        char *cells[32];
        size_t count = 0;
        for (char *cell = strtok(line, ",\n"); cell && count < 32; cell = strtok(NULL, ",\n")) {
            cells[count++] = cell;
        }
        row(cells, count);
    }
    assert_int_equal(fclose(file), 0);
    return rows;
}

/* displacement: at 0 the electrostatic force at rest, M lambda_pre^3 R_a 2 pi H of the exact film too; it falls as the film is let go,
 * to 0 where the free film rests. */
static void take_force(char *const *cells, size_t count)
{
    const double voltage = strtod(cells[0], NULL), moved = strtod(cells[1], NULL), force = strtod(cells[2], NULL);
    const double nominal = voltage / 1e-4, push = 2.0 * DEA_PI * 1e-4 * 2.8 * 8.8541878128e-12 * nominal * nominal * 1.44 * 0.015;
    assert_int_equal(count, 7);
    assert_true(force <= push * (1.0 + 1e-9));
    if (moved == 0.0) {
        assert_relative(force, push, 1e-12);
    } else if (voltage == 4500.0) {
        assert_true((force > 0.0) == (moved < 0.0450329722 * 0.015));
    }
}

static void a_blocked_dot_pushes_with_its_electrostatic_force(void **state)
{
    (void)state;
    assert_int_equal(run_rows("force", take_force), 3 * 36);
}

/* bias_V, frequency_Hz, displacement_m_per_V, displacement_phase_deg, impedance_Ohm, ...: at 1 Hz, far below the first mode and far
 * above the leak, what charge and stroke of the static film gain by a volt; at 10 kHz the series resistance alone. */
static void take_datasheet(char *const *cells, size_t count)
{
    const double bias = strtod(cells[0], NULL), frequency = strtod(cells[1], NULL), impedance = strtod(cells[4], NULL);
    const dea_row *above = row_at("field", bias + 100.0, 0.0), *below = row_at("field", bias - 100.0, 0.0);
    assert_int_equal(count, 7);
    if (is_close(frequency, 1.0, 0.0, 1e-9)) {
        const double slope = (above->charge - below->charge) / 200.0;
        assert_relative(strtod(cells[2], NULL), (above->displacement - below->displacement) / 200.0, 2e-3);
        assert_relative(1.0 / (2.0 * DEA_PI * impedance), slope, 2e-3);
    } else if (is_close(frequency, 1e4, 0.0, 1e-6)) {
        assert_relative(impedance, 1e6, 2e-2);
    }
}

static void the_datasheet_tells_one_device_at_rest_and_in_frequency(void **state)
{
    (void)state;
    run_example("datasheet");
    const double area = DEA_PI * 0.015 * 0.015, rest = 2.8 * 8.8541878128e-12 * area / (1e-4 / 1.44);
    assert_relative(row_at("field", 0.0, 0.0)->capacitance, rest, 1e-12);
    for (size_t i = 0; i < here.count; i++) {
        assert_int_equal(here.rows[i].state, here.rows[i].field > 1e8 ? DEA_STATE_BREAKDOWN : DEA_STATE_OK);
    }
    assert_int_equal(run_rows("datasheet-response", take_datasheet), 3 * 176);
}

/* bias_V, coverage, mode, frequency_Hz, damping_ratio, undamped_frequency_Hz, ...: frequencies of physics, section 7. */
static void take_mode(char *const *cells, size_t count)
{
    static const double still[] = {619.836, 1134.877, 1645.71}, quarter[] = {587.717, 1088.681, 1612.00};
    const double bias = strtod(cells[0], NULL), coverage = strtod(cells[1], NULL), undamped = strtod(cells[5], NULL);
    const size_t mode = (size_t)strtod(cells[2], NULL) - 1;
    assert_int_equal(count, 9);
    assert_true(strtod(cells[3], NULL) < undamped && strtod(cells[4], NULL) > 0.0);
    if (bias == 0.0) {
        assert_printed(undamped, still[mode], mode < 2 ? 3 : 2);
    } else if (bias == 4500.0 && coverage == 0.25) {
        assert_printed(undamped, quarter[mode], mode < 2 ? 3 : 2);
    }
    if (mode == 0) {
        assert_near(strtod(cells[6], NULL), coverage == 0.5 ? 0.77 : 0.38, 0.07);
    }
}

static void modes_are_those_of_the_table(void **state)
{
    (void)state;
    assert_int_equal(run_rows("modes", take_mode), 19 * 2 * 3);
}

/* voltage_V, radius_m, displacement_m, stretch_radial, stretch_hoop, thickness_m, stress_radial_Pa, stress_hoop_Pa, field: the disc
 * of a lens shrinks evenly and has no field, the annulus has one. */
static void take_station(char *const *cells, size_t count)
{
    const double voltage = strtod(cells[0], NULL), radius = strtod(cells[1], NULL), moved = strtod(cells[2], NULL);
    const bool disc = radius <= 0.015 * (1.0 + 1e-12);
    dea_scene scene = paper_scene(DEA_LENS, 1.2, 0.5, voltage);
    const dea_row row = solve_direct(&scene, "field");
    assert_int_equal(count, 10);
    assert_true(disc == (strtod(cells[8], NULL) == 0.0));
    if (disc) {
        assert_near(moved, row.strain * radius, 1e-9 * radius);
        assert_relative(strtod(cells[3], NULL), 1.2 * (1.0 + row.strain), 1e-8);
    } else {
        assert_relative(strtod(cells[4], NULL), 1.2 * (1.0 + moved / radius), 1e-8);
        assert_relative(strtod(cells[8], NULL), voltage * strtod(cells[3], NULL) * strtod(cells[4], NULL) / 1e-4, 1e-12);
    }
    assert_string_equal(cells[9], "ok");
}

static void the_disc_of_a_lens_shrinks_evenly_and_the_annulus_fills_the_rest(void **state)
{
    (void)state;
    assert_int_equal(run_rows("profile", take_station), 3 * 201);
}

/* Runs a command as the user would, beside a folder `examples`. */
static void run_told(const char *command)
{
    char line[4 * PATH_LENGTH], project[PATH_LENGTH];
    assert_non_null(getcwd(project, sizeof project));
    snprintf(line, sizeof line, "mkdir %s/told && cd %s/told && ln -s '%s/examples' examples && '%s' %s --quiet >/dev/null",
             folder, folder, project, program, command);
    const int ended = system(line);
    snprintf(line, sizeof line, "rm -r %s/told", folder);
    assert_int_equal(system(line), 0);
    if (!WIFEXITED(ended) || WEXITSTATUS(ended) != 0) {
        fail_msg("deaspice %s", command);
    }
}

/* `#` lines first, and among them a command that runs this very file. */
static void check_opening(const char *name)
{
    char path[PATH_LENGTH], line[LINE_LENGTH], command[PATH_LENGTH];
    bool told = false;
    snprintf(path, sizeof path, "examples/%s", name);
    snprintf(command, sizeof command, "#   deaspice run examples/%s ", name);
    FILE *file = fopen(path, "r");
    assert_non_null(file);
    for (size_t i = 0; fgets(line, sizeof line, file) && line[0] == '#'; i++) {
        if (i > 0 && strncmp(line, command, strlen(command)) == 0) {
            line[strcspn(line, "\n")] = '\0';
            run_told(strstr(line, "run "));
            told = true;
        }
    }
    assert_int_equal(fclose(file), 0);
    if (!told) {
        fail_msg("%s does not open with what it shows and its command", path);
    }
}

static void every_example_opens_with_a_command_that_works(void **state)
{
    size_t count = 0;
    DIR *open = opendir("examples");
    (void)state;
    assert_non_null(open);
    for (const struct dirent *entry; (entry = readdir(open));) {
        if (strstr(entry->d_name, ".yaml")) {
            check_opening(entry->d_name);
            count++;
        }
    }
    closedir(open);
    assert_true(count >= 6);
}

static int enter(void **state)
{
    (void)state;
    const char *given = getenv("DEASPICE");
    return realpath(given ? given : "build/deaspice", program) && mkdtemp(folder) ? 0 : -1;
}

static int leave(void **state)
{
    char path[PATH_LENGTH];
    (void)state;
    dea_scene_free(&here.scene);
    snprintf(path, sizeof path, "%s/rows.csv", folder);
    unlink(path);
    return rmdir(folder);
}

/* One cell: words to the letter, numbers to 12 digits. */
static bool same_cell(const char *got, const char *wanted)
{
    char *after, *after_wanted;
    const double number = strtod(got, &after), known = strtod(wanted, &after_wanted);
    return after_wanted > wanted && *after_wanted == '\0' ? *after == '\0' && fabs(number - known) <= 1e-12 * fabs(known)
                                                         : strcmp(got, wanted) == 0;
}

/* Rows that the program printed into a file, against the indented lines of a text. */
static void compare_printed(const char *path, const char *text)
{
    char line[LINE_LENGTH], wanted[LINE_LENGTH];
    FILE *file = fopen(path, "r");
    assert_non_null(file);
    while (fgets(line, sizeof line, file)) {
        char *left, *right;
        snprintf(wanted, sizeof wanted, "%.*s", (int)strcspn(text, "\n"), text);
        text += strcspn(text, "\n") + 1;
        assert_int_equal(strncmp(wanted, "    ", 4), 0);
        const char *got = strtok_r(line, ",\n", &left), *known = strtok_r(wanted + 4, ",", &right);
        for (; got && known; got = strtok_r(NULL, ",\n", &left), known = strtok_r(NULL, ",", &right)) {
            if (!same_cell(got, known)) {
                fail_msg("the program prints %s, README %s", got, known);
            }
        }
        assert_true(!got && !known);
    }
    assert_int_equal(*text, '\n');
    assert_int_equal(fclose(file), 0);
}

/* README's scenes as a reader types them in: every block of YAML that has an actuator. */
static void scenes_of_the_readme_run_as_written(void **state)
{
    static char text[1 << 16];
    size_t scenes = 0, printed = 0;
    (void)state;
    FILE *file = fopen("README.md", "r");
    assert_non_null(file);
    text[fread(text, 1, sizeof text - 1, file)] = '\0';
    assert_int_equal(fclose(file), 0);
    for (char *block = strstr(text, "```yaml\n"); block; block = strstr(block, "```yaml\n")) {
        block += strlen("```yaml\n");
        char *end = strstr(block, "```");
        assert_non_null(end);
        *end = '\0';
        if (strncmp(block, "actuator:", 9) == 0 || strstr(block, "\nactuator:")) {
            char path[PATH_LENGTH], rows[PATH_LENGTH], words[3 * PATH_LENGTH];
            snprintf(path, sizeof path, "%s/readme.yaml", folder);
            file = fopen(path, "w");
            assert_non_null(file);
            assert_true(fputs(block, file) >= 0);
            assert_int_equal(fclose(file), 0);
            snprintf(rows, sizeof rows, "%s/rows.csv", folder);
            snprintf(words, sizeof words, "run --quiet --no-files %s -o %s", path, rows);
            run_program(words);
            static const char prompt[] = "``\n\n    $ build/deaspice run dot.yaml\n"; /* and what it prints below */
            if (strncmp(end + 1, prompt, sizeof prompt - 1) == 0) {
                compare_printed(rows, end + sizeof prompt);
                printed++;
            }
            assert_int_equal(unlink(path) + unlink(rows), 0);
            scenes++;
        }
        block = end + 1;
    }
    assert_true(scenes > 0 && printed > 0);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(figure_8_gives_the_modulus_at_the_pre_stretches),
        cmocka_unit_test(figure_9_ends_at_the_strains_of_equations_13_and_4),
        cmocka_unit_test(figure_10_passes_through_the_reference_strains),
        cmocka_unit_test(figure_10_has_the_sensitivities_of_the_paper),
        cmocka_unit_test(displacement_peaks_below_half_coverage_in_equation_18_and_above_it_in_the_field),
        cmocka_unit_test(lens_shrinks_as_the_reference_strains_say),
        cmocka_unit_test(every_point_of_the_map_balances_its_stresses),
        cmocka_unit_test(soft_film_without_pre_stretch_pulls_in_at_the_voltage_of_a_free_edge),
        cmocka_unit_test(a_stack_strains_more_between_the_same_electrodes),
        cmocka_unit_test(a_bias_spring_takes_what_the_film_leaves),
        cmocka_unit_test(antagonists_share_the_way_of_each),
        cmocka_unit_test(a_blocked_dot_pushes_with_its_electrostatic_force),
        cmocka_unit_test(vhb_follows_the_closed_form_of_a_neo_hookean),
        cmocka_unit_test(sample_data_gives_back_the_constants_it_was_made_from),
        cmocka_unit_test(the_datasheet_tells_one_device_at_rest_and_in_frequency),
        cmocka_unit_test(modes_are_those_of_the_table),
        cmocka_unit_test(the_disc_of_a_lens_shrinks_evenly_and_the_annulus_fills_the_rest),
        cmocka_unit_test(every_example_opens_with_a_command_that_works),
        cmocka_unit_test(scenes_of_the_readme_run_as_written),
    };
    return cmocka_run_group_tests(tests, enter, leave);
}
