/* The membrane as cards of a netlist: numbers against physics and against the engine that integrates along the radius; the engine's
 * text against the export's. */
#include <stdlib.h>
#include <time.h>

#include "engine/ngspice/moving.h"
#include "engine/ngspice/rings_track.h"
#include "netlist/export.h"
#include "netlist/part.h"
#include "netlist/rings_line.h"
#include "netlist/rings_small.h"
#include "network/rings_band.h"
#include "network/rings_mesh.h"
#include "ngspice_child.h"
#include "random_scenes.h"

enum { MOST_ROWS = 64, FILMS = 12, POINTS = 6 };

typedef struct row_list {
    dea_row rows[MOST_ROWS];
    size_t count;
} row_list;

static dea_status take_rows(void *user, size_t first, const void *points, size_t count, dea_error *error)
{
    row_list *list = user;
    (void)error;
    assert_true(first + count <= MOST_ROWS);
    memcpy(&list->rows[first], points, count * sizeof *list->rows);
    list->count += count;
    return DEA_OK;
}

static row_list run(const dea_scene *scene)
{
    row_list list = {.count = 0};
    dea_error error = {0};
    const dea_run_options options = {.jobs = 1, .points = take_rows, .user = &list};
    if (dea_study_run(scene, dea_engine_find("ngspice"), &options, &error) != DEA_OK) {
        fail_msg("%s", error.message);
    }
    return list;
}

static void strains_at_4500_volts_are_those_of_the_membrane(void **state)
{
    static const struct {
        double prestretch, coverage, dot, lens;
    } films[] = {{1.1, 0.10, 0.03762647, -0.02932674},
                 {1.1, 0.50, 0.02651626, -0.02338631},
                 {1.2, 0.25, 0.06092621, -0.04432166},
                 {1.2, 0.50, 0.04503297, -0.03741631},
                 {1.3, 0.75, 0.03289753, -0.03263280}};
    (void)state;
    for (size_t i = 0; i < 2 * sizeof films / sizeof *films; i++) {
        const dea_kind kind = i % 2 == 0 ? DEA_DOT : DEA_LENS;
        dea_scene scene = paper_scene(kind, films[i / 2].prestretch, films[i / 2].coverage, 4500.0);
        scene.models[0] = dea_model_find("field");
        scene.accuracy = 1e-9;
        const row_list list = run(&scene);
        assert_int_equal(list.count, 1);
        assert_int_equal(list.rows[0].state, DEA_STATE_OK);
        assert_true(is_close(list.rows[0].strain, kind == DEA_DOT ? films[i / 2].dot : films[i / 2].lens, 0.0, 5.1e-9));
    }
}

/* Random films and axes: the integration along the radius knows no rings. */
static void random_films_are_those_of_the_integration_along_the_radius(void **state)
{
    uint64_t seed = (uint64_t)time(NULL);
    const uint64_t first = seed;
    (void)state;
    for (int i = 0; i < FILMS; i++) {
        double values[POINTS];
        dea_axis axis;
        dea_scene scene = random_scene(&seed);
        scene.models[0] = dea_model_find("field");
        scene.accuracy = 1e-8;
        scene.actuator.coverage = random_between(&seed, 0.08, 0.92);
        scene.drive.voltage = pull_in_voltage(&scene, "field") * random_between(&seed, 0.2, 0.75);
        dea_film film;
        dea_film_prepare(&scene, &film);
        if (film.w11 < 0.3 * fabs(film.w12)) {
            continue; /* all but unstable at rest: rings tell an instability within the annulus that the edge does not show */
        }
        double *field = swept_field(&scene, i % SWEPT_FIELDS);
        for (int k = 0; k < POINTS; k++) {
            values[k] = *field * (1.0 + 0.02 * k);
        }
        add_axis(&scene, &axis, field, values, POINTS);
        const row_list list = run(&scene);
        assert_int_equal(list.count, POINTS);
        for (int k = 0; k < POINTS; k++) {
            *field = values[k];
            const dea_row wanted = solve_direct(&scene, "field"), got = list.rows[k];
            if (wanted.state != DEA_STATE_OK) {
                continue; /* slack films may be refused: their rings end sooner than the integration does */
            }
            const bool close = got.state == wanted.state &&
                               (isnan(wanted.strain) || (is_close(got.strain, wanted.strain, 1e-8, 0.0) &&
                                                         is_close(got.force, wanted.force, 1e-8, 0.0) &&
                                                         is_close(got.capacitance, wanted.capacitance, 1e-8, 0.0)));
            if (!close) {
                fail_msg("seed %llu, film %d, point %d: strain %.12g (%s), wanted %.12g (%s), force %.12g, wanted %.12g",
                         (unsigned long long)first, i, k, got.strain, dea_state_name(got.state), wanted.strain,
                         dea_state_name(wanted.state), got.force, wanted.force);
            }
        }
    }
}

static void a_sweep_goes_on_behind_points_without_equilibrium(void **state)
{
    double values[] = {1000.0, 4000.0, 20000.0, 4500.0};
    dea_axis axis;
    dea_scene scene = paper_scene(DEA_LENS, 1.2, 0.5, 500.0);
    (void)state;
    scene.models[0] = dea_model_find("field");
    scene.accuracy = 1e-9;
    add_axis(&scene, &axis, &scene.drive.voltage, values, 4);
    const row_list list = run(&scene);
    assert_int_equal(list.rows[0].state, DEA_STATE_OK);
    assert_int_equal(list.rows[2].state, DEA_STATE_PULL_IN);
    assert_true(isnan(list.rows[2].strain));
    assert_true(is_close(list.rows[3].strain, -0.03741631, 0.0, 6e-9));
}

static dea_status take_responses(void *user, size_t first, const void *points, size_t count, dea_error *error)
{
    (void)error;
    assert_true(first + count <= MOST_ROWS);
    memcpy((dea_response *)user + first, points, count * sizeof(dea_response));
    return DEA_OK;
}

/* The scene of the table of frequency responses. */
static dea_scene swinging_scene(double frequency)
{
    dea_scene scene = paper_scene(DEA_DOT, 1.2, 0.5, 3000.0);
    scene.models[0] = dea_model_find("field");
    scene.accuracy = 1e-9;
    scene.study = DEA_STUDY_AC;
    scene.material.density = 1080.0;
    scene.material.retardation = 20e-6;
    scene.material.prony[0] = (dea_prony){0.1 / 1.1, 1e-3};
    scene.material.prony_count = 1;
    scene.ac = (dea_ac){.from = frequency, .to = frequency * 1.001, .points_per_decade = 1, .bias = 3000.0};
    return scene;
}

static void small_motion_about_a_bias_is_that_of_the_membrane(void **state)
{
    static const dea_response known[] = {
        {1.0, 1.958684830e-07, -0.061248, 5.081569720e8, -89.991833, DEA_STATE_OK},
        {600.0, 8.019089950e-07, -44.117392, 6.441899044e5, -73.197756, DEA_STATE_OK},
        {1200.0, 2.869630393e-08, -93.249076, 4.891210525e5, -88.709063, DEA_STATE_OK},
    };
    (void)state;
    for (size_t i = 0; i < sizeof known / sizeof *known; i++) {
        dea_response rows[MOST_ROWS];
        dea_error error = {0};
        const dea_scene scene = swinging_scene(known[i].frequency);
        const dea_run_options options = {.jobs = 1, .points = take_responses, .user = rows};
        if (dea_study_run(&scene, dea_engine_find("ngspice"), &options, &error) != DEA_OK) {
            fail_msg("%s", error.message);
        }
        assert_true(is_close(rows[0].displacement, known[i].displacement, 5.1e-10, 0.0));
        assert_true(is_close(rows[0].displacement_phase, known[i].displacement_phase, 0.0, 5.1e-7));
        assert_true(is_close(rows[0].impedance, known[i].impedance, 1.1e-9, 0.0));
        assert_true(is_close(rows[0].impedance_phase, known[i].impedance_phase, 0.0, 5.1e-7));
    }
}

static char *export_of(const dea_scene *scene, const char *dialect)
{
    char *text = NULL;
    size_t length = 0;
    dea_error error = {0};
    FILE *out = open_memstream(&text, &length);
    dea_export export = {.scene = scene, .dialect = dea_dialect_find(dialect), .analogy = dea_analogy_at(0), .out = out};
    if (dea_export_netlist(&export, &error) != DEA_OK) {
        fail_msg("%s: %s", dialect, error.message);
    }
    fclose(out);
    return text;
}

/* The cards of the film, from `.subckt` to the instance. */
static void what_is_exported_is_the_text_that_the_engine_runs(void **state)
{
    double values[] = {500.0, 1500.0, 2500.0, 3500.0, 4500.0};
    dea_axis axis;
    dea_scene scene = paper_scene(DEA_DOT, 1.2, 0.5, 500.0);
    (void)state;
    scene.models[0] = dea_model_find("field");
    add_axis(&scene, &axis, &scene.drive.voltage, values, 5);
    char *whole = export_of(&scene, "ngspice");
    dea_rings_line line = {.scene = &scene, .axis = &axis, .to = 5, .number = 1};
    char *own = NULL;
    size_t length = 0;
    FILE *out = open_memstream(&own, &length);
    dea_rings_line_choose(&line);
    assert_int_equal(dea_rings_line_write(&line, dea_dialect_at(0), out, NULL), DEA_OK);
    fclose(out);
    assert_true(length > 4000);
    assert_non_null(strstr(whole, own));
    free(own);
    free(whole);
}

/* What a swept geometry needs at the start of Newton's iteration is told of nodes that the circuit has: without it the first matrix
 * of a sweep is singular, and every point of it would need a circuit of its own. */
static void newton_starts_at_nodes_that_the_circuit_has(void **state)
{
    double values[2][3] = {{0.3, 0.5, 0.7}, {1.1, 1.2, 1.3}};
    dea_axis axis;
    (void)state;
    for (size_t i = 0; i < 2; i++) {
        dea_scene scene = paper_scene(i == 0 ? DEA_DOT : DEA_LENS, 1.2, 0.5, 500.0);
        scene.models[0] = dea_model_find("field");
        add_axis(&scene, &axis, i == 0 ? &scene.actuator.coverage : &scene.actuator.prestretch, values[i], 3);
        char *text = export_of(&scene, "ngspice"), *guesses = strstr(text, "\n.nodeset "), *rest = NULL;
        assert_non_null(guesses);
        *guesses++ = '\0';
        size_t count = 0;
        char *guess = strtok_r(strtok_r(guesses, "\n", &rest), " ", &rest);
        while ((guess = strtok_r(NULL, " ", &rest)) && strncmp(guess, "v(xline1.", 9) == 0) {
            char node[64];
            snprintf(node, sizeof node, " %.*s 0 ", (int)strcspn(guess + 9, ")"), guess + 9);
            assert_non_null(strstr(text, node));
            count++;
        }
        assert_true(count > 3);
        free(text);
    }
}

/* Of the network alone; the caller frees it. */
static char *network_in(const char *text)
{
    const char *begin = strstr(text, DEA_CARDS_BEGIN), *end = begin ? strstr(begin, DEA_CARDS_END) : NULL;
    assert_non_null(end);
    assert_true(end > begin + 1000);
    return strndup(begin, (size_t)(end - begin));
}

enum { WITH_MASS = 1, WITH_DAMPER = 2, WITH_BRANCHES = 4, WITH_SERIES = 8, WITH_LEAK = 16, WITH_SKIN = 32, WITH_LOAD = 64, WAYS = 128 };

/* One of the ways in which a film can move. */
static dea_scene moving_scene(const dea_law *law, int way)
{
    static const double constants[][DEA_LAW_CONSTANTS] = {{178426.0, -6023.0, 4234.0}, {44e3}, {16e3, 7.3e3}, {45e3, 120.0}, {43.4e3, 1.445}, {40e3, 5.99}};
    static const char *const names[] = {"yeoh", "neo_hookean", "mooney_rivlin", "gent", "ogden", "arruda_boyce"};
    dea_scene scene = paper_scene(way % 3 ? DEA_DOT : DEA_LENS, 1.2, way % 2 ? 0.5 : 0.3, (double)NAN);
    scene.models[0] = dea_model_find("field");
    for (size_t i = 0; i < 6; i++) {
        if (strcmp(names[i], law->name) == 0) {
            memcpy(scene.material.constants, constants[i], sizeof constants[i]);
        }
    }
    scene.material.law = law;
    scene.material.entry_count = 1;
    scene.study = DEA_STUDY_TRANSIENT;
    scene.transient = (dea_transient){.until = 0.02, .every = 1e-3};
    scene.drive.waveform = (dea_waveform){.kind = DEA_WAVE_STEP, .step = {1e-3, (double)NAN, 700.0, 1e-4}, .period = (double)NAN};
    scene.accuracy = 1e-3;
    scene.material.density = way & WITH_MASS ? 1080.0 : (double)NAN;
    scene.material.retardation = way & WITH_DAMPER ? 2e-4 : (double)NAN;
    scene.material.prony_count = way & WITH_BRANCHES ? 2 : 0;
    scene.material.prony[0] = (dea_prony){0.1, 5e-3};
    scene.material.prony[1] = (dea_prony){0.05, 0.2};
    scene.drive.series_resistance = way & WITH_SERIES ? 1e5 : (double)NAN;
    scene.drive.leakage_resistance = way & WITH_LEAK ? 1e11 : (double)NAN;
    if (way & WITH_SKIN) {
        scene.electrode = (dea_electrode){.law = law, .entry_count = 1, .thickness = 25e-6, .density = 1010.0, .sheet_resistance = (double)NAN};
        memcpy(scene.electrode.constants, scene.material.constants, sizeof scene.electrode.constants);
    }
    if (way & WITH_LOAD) {
        *dea_scene_load(&scene, "mass") = 1e-3;
        *dea_scene_load(&scene, "stiffness") = 100.0;
    }
    return scene;
}

/* Byte for byte, in the units of the engine and in those of the file, on the nodes that the file names. */
static void transients_are_one_text(void **state)
{
    (void)state;
    for (int n = 0; n < 6 * WAYS; n += 7) {
        const char *names[] = {"yeoh", "neo_hookean", "mooney_rivlin", "gent", "ogden", "arruda_boyce"};
        const dea_scene scene = moving_scene(dea_law_find(names[n / WAYS]), n % WAYS);
        static dea_membrane membrane;
        dea_units units;
        dea_scene inside;
        dea_rings_mesh mesh = dea_rings_mesh_of(&scene, 8.0);
        char *text = NULL, *whole = export_of(&scene, "ngspice");
        const char *degrees = strstr(whole, "degrees of disc and annulus: ");
        assert_non_null(degrees);
        assert_non_null(strstr(whole, "expected error"));
        assert_int_equal(sscanf(degrees, "degrees of disc and annulus: %zu, %zu", &mesh.disc, &mesh.annulus), 2);
        assert_int_equal(dea_ngspice_units_rings(&scene, scene.models[0], &units, NULL), DEA_OK);
        assert_int_equal(dea_units_enter(&units, &scene, &inside, NULL), DEA_OK);
        assert_int_equal(dea_membrane_open(&inside, inside.models[0], mesh, &membrane, NULL), DEA_OK);
        assert_int_equal(dea_rings_deck_network(&inside, &membrane, 0.5, &text, NULL), DEA_OK);
        char *ours = network_in(text), *theirs = network_in(whole);
        if (strcmp(ours, theirs) != 0) {
            size_t i = 0;
            while (ours[i] == theirs[i]) {
                i++;
            }
            fail_msg("way %d of %s: the engine has\n%.200s\nthe file\n%.200s", n % WAYS, names[n / WAYS], ours + i, theirs + i);
        }
        dea_units_leave(&inside);
        free(ours);
        free(theirs);
        free(text);
        free(whole);
    }
}

static void frequency_responses_are_one_text(void **state)
{
    (void)state;
    static dea_rings_biased biased;
    dea_scene scene = swinging_scene(100.0);
    double gap;
    char *own = NULL, *whole;
    size_t length = 0;
    scene.ac.to = 2000.0;
    scene.accuracy = 1e-6;
    whole = export_of(&scene, "ngspice");
    FILE *out = open_memstream(&own, &length);
    assert_int_equal(dea_rings_band(&scene, scene.models[0], &biased, &gap, NULL), DEA_OK);
    assert_true(gap > 0.0 && gap <= scene.accuracy);
    const dea_rings_small small = {&biased.membrane, biased.u, biased.voltage};
    dea_rings_small_write(&small, out);
    fclose(out);
    assert_true(length > 4000);
    assert_non_null(strstr(whole, own));
    free(own);
    free(whole);
}

/* A spring and a mass on the edge, against `direct`, which integrates along the radius. */
static void a_load_is_carried(void **state)
{
    (void)state;
    dea_scene scene = paper_scene(DEA_DOT, 1.2, 0.5, 4500.0);
    scene.models[0] = dea_model_find("field");
    scene.accuracy = 1e-9;
    *dea_scene_load(&scene, "stiffness") = 200.0;
    const dea_row wanted = solve_direct(&scene, "field"), free = solve_paper("field", DEA_DOT, 1.2, 0.5, 4500.0);
    const row_list list = run(&scene);
    assert_true(wanted.strain < 0.9 * free.strain);
    assert_true(is_close(list.rows[0].strain, wanted.strain, 1e-9, 0.0));
    dea_scene swings = swinging_scene(200.0);
    swings.accuracy = 1e-7;
    *dea_scene_load(&swings, "stiffness") = 200.0;
    *dea_scene_load(&swings, "mass") = 2e-3;
    dea_response rows[2][MOST_ROWS];
    static const char *const engines[] = {"ngspice", "direct"};
    for (int i = 0; i < 2; i++) {
        dea_error error = {0};
        const dea_run_options options = {.jobs = 1, .points = take_responses, .user = rows[i]};
        if (dea_study_run(&swings, dea_engine_find(engines[i]), &options, &error) != DEA_OK) {
            fail_msg("%s", error.message);
        }
    }
    assert_true(is_close(rows[0][0].displacement, rows[1][0].displacement, 1e-7, 0.0));
    assert_true(is_close(rows[0][0].impedance, rows[1][0].impedance, 1e-7, 0.0));
}

static void every_dialect_says_how_many_nodes_and_how_good(void **state)
{
    (void)state;
    for (size_t i = 0; i < dea_dialect_count(); i++) {
        dea_scene scene = paper_scene(DEA_LENS, 1.2, 0.5, 3000.0);
        scene.models[0] = dea_model_find("field");
        char *text = export_of(&scene, dea_dialect_at(i)->name);
        size_t cards = 0;
        for (const char *line = text; line && *line; line = strchr(line, '\n') ? strchr(line, '\n') + 1 : NULL) {
            cards += *line == 'G';
            assert_true(*line != ' ');
            for (const char *c = line; *c > ' ' && *line != '.' && *line != '*' && *line != '+'; c++) {
                assert_false(*c >= 'a' && *c <= 'z'); /* names of elements */
            }
        }
        assert_true(cards > 40);
        assert_non_null(strstr(text, "expected error"));
        assert_non_null(strstr(text, "moving nodes"));
        free(text);
    }
}

/* Opens circuit.cir with its title and the part of the membrane. */
static FILE *begin_circuit(dea_kind kind)
{
    FILE *file = child_open("circuit.cir", "w");
    const dea_scene scene = dea_part_paper(kind);
    fputs("* circuit\n", file);
    assert_int_equal(dea_part_write(&scene, dea_model_find("field"), NULL, dea_dialect_at(0), file, NULL), DEA_OK);
    return file;
}

static void run_circuit(FILE *file, child_run *run)
{
    fputs(".end\n", file);
    assert_int_equal(fclose(file), 0);
    child_must_run("circuit.cir", run);
}

/* On its fixed mesh, two of them side by side too. */
static void parts_stand_where_the_membrane_does(void **state)
{
    static const double coverages[] = {0.15, 0.5, 0.85};
    (void)state;
    for (int kind = DEA_DOT; kind <= DEA_LENS; kind++) {
        const char *part = kind == DEA_DOT ? "dea_dot_field" : "dea_lens_field";
        child_run run;
        FILE *file = begin_circuit((dea_kind)kind);
        fputs("va a 0 4000\n.options reltol=1e-6\n.op\n", file);
        for (int i = 0; i < 3; i++) {
            fprintf(file, "x%d a 0 e%d %s coverage=%g m=%d\n", i, i, part, coverages[i], i + 1);
            fprintf(file, ".save v(x%d.strain) v(x%d.force) v(x%d.c) v(x%d.q) v(x%d.bad) v(x%d.slack)\n", i, i, i, i, i, i);
        }
        run_circuit(file, &run);
        for (int i = 0; i < 3; i++) {
            const dea_scene scene = paper_scene((dea_kind)kind, 1.2, coverages[i], 4000.0);
            const dea_row wanted = solve_direct(&scene, "field");
            const char *const names[] = {"strain", "force", "c", "q", "bad", "slack"};
            const double values[] = {wanted.strain, wanted.force, 1e12 * (i + 1) * wanted.capacitance, 1e9 * (i + 1) * wanted.charge, 0.0, 0.0};
            for (int k = 0; k < 6; k++) {
                char name[32];
                snprintf(name, sizeof name, "v(x%d.%s)", i, names[k]);
                assert_true(is_close(child_last(&run, name), values[k], 3e-6, 1e-9));
            }
        }
        child_end(&run);
    }
}

static void parts_swing_as_the_membrane_does(void **state)
{
    (void)state;
    child_run run;
    FILE *file = begin_circuit(DEA_DOT);
    fputs("va a 0 dc 3000 ac 1\nx0 a 0 e0 dea_dot_field density=1080 retardation=20e-6 g1=0.090909090909090909 tau1=1e-3\n"
          ".options reltol=1e-6\n.save v(x0.u) i(va)\n.ac lin 4 600 2400\n",
          file);
    run_circuit(file, &run);
    const double known[][2] = {{8.019089950e-07, 6.441899044e5}, {2.869630393e-08, 4.891210525e5}};
    for (size_t i = 0; i < 2; i++) {
        const double u = 1e-6 * hypot(child_value(&run, "v(x0.u)", i), child_imaginary(&run, "v(x0.u)", i));
        const double current = hypot(child_value(&run, "i(va)", i), child_imaginary(&run, "i(va)", i));
        assert_true(is_close(u, known[i][0], 1e-4, 0.0));
        assert_true(is_close(1.0 / current, known[i][1], 1e-5, 0.0));
    }
    child_end(&run);
}

/* The netlist as a user runs it. */
static void exported_small_motion_runs_by_itself(void **state)
{
    (void)state;
    dea_scene scene = swinging_scene(600.0);
    scene.ac.to = 6000.0;
    scene.accuracy = 1e-6;
    child_run run;
    char *text = export_of(&scene, "ngspice");
    const char *results = strstr(text, "results: displacement v(u");
    char name[32];
    assert_non_null(results);
    assert_non_null(strstr(text, "expected error"));
    snprintf(name, sizeof name, "v(u%d)", atoi(results + strlen("results: displacement v(u")));
    FILE *file = child_open("study.cir", "w");
    fputs(text, file);
    fclose(file);
    free(text);
    child_must_run("study.cir", &run);
    assert_true(is_close(hypot(child_value(&run, name, 0), child_imaginary(&run, name, 0)), 8.019089950e-07, 1e-6, 0.0));
    child_end(&run);
}

int main(int argc, char **argv)
{
    cmocka_set_test_filter(argc > 1 ? argv[1] : NULL);
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(strains_at_4500_volts_are_those_of_the_membrane),
        cmocka_unit_test(random_films_are_those_of_the_integration_along_the_radius),
        cmocka_unit_test(a_sweep_goes_on_behind_points_without_equilibrium),
        cmocka_unit_test(small_motion_about_a_bias_is_that_of_the_membrane),
        cmocka_unit_test(what_is_exported_is_the_text_that_the_engine_runs),
        cmocka_unit_test(newton_starts_at_nodes_that_the_circuit_has),
        cmocka_unit_test(transients_are_one_text),
        cmocka_unit_test(frequency_responses_are_one_text),
        cmocka_unit_test(a_load_is_carried),
        cmocka_unit_test(every_dialect_says_how_many_nodes_and_how_good),
        cmocka_unit_test(parts_stand_where_the_membrane_does),
        cmocka_unit_test(parts_swing_as_the_membrane_does),
        cmocka_unit_test(exported_small_motion_runs_by_itself),
    };
    return cmocka_run_group_tests(tests, child_setup, child_teardown);
}
