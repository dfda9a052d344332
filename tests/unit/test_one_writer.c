/* The engine `ngspice` runs the very text that is exported: byte for byte from the first line of the network to its last, over
 * models, laws, ports and studies. What comes before are its numbers, in the units of each, what comes after the deck. */
#include "films.h"

#include <stdlib.h>

#include "engine/ngspice/bands.h"
#include "engine/ngspice/deck.h"
#include "engine/ngspice/moving.h"
#include "netlist/export.h"
#include "netlist/netlist.h"

enum {
    MODELS = 4,
    WITH_MASS = 1,
    WITH_DAMPER = 2,
    WITH_BRANCHES = 4,
    WITH_SERIES = 8,
    WITH_LEAK = 16,
    WITH_SKIN = 32,
    WITH_LAYERS = 64,
    WITH_LOAD = 128,
    WITH_FOLLOWING = 256,
    WITH_SECOND = 512,
    WAYS = 1024
};

static const char *const models[MODELS] = {"lumped", "lame", "coverage", "ring"};

/* One of the ways in which a film can be built into a circuit. */
static dea_scene scene_of(const film *f, const char *model, dea_kind kind, int way)
{
    dea_scene scene = paper_scene(kind, 1.3, 0.45, (double)NAN);
    set_law(&scene, f);
    scene.models[0] = dea_model_find(model);
    scene.material.density = way & WITH_MASS ? 1080.0 : (double)NAN;
    scene.material.retardation = way & WITH_DAMPER ? 2e-4 : (double)NAN;
    scene.material.prony_count = way & WITH_BRANCHES ? 2 : 0;
    scene.material.prony[0] = (dea_prony){0.1, 5e-3};
    scene.material.prony[1] = (dea_prony){0.05, 0.2};
    scene.drive.series_resistance = way & WITH_SERIES ? 1e5 : (double)NAN;
    scene.drive.leakage_resistance = way & WITH_LEAK ? 1e11 : (double)NAN;
    scene.actuator.layers = way & WITH_LAYERS ? 3.0 : 1.0;
    if (way & WITH_SKIN) {
        scene.electrode = (dea_electrode){
            .law = dea_law_find("neo_hookean"), .constants = {150e3}, .entry_count = 1, .thickness = 2e-6, .density = 1000.0};
    }
    if (way & WITH_FOLLOWING && (strcmp(model, "ring") == 0 || strcmp(model, "coverage") == 0)) {
        scene.material.permittivity_per_stretch = -0.2;
        scene.material.permittivity_follows = true;
    }
    if (way & WITH_SECOND) {
        scene.antagonist = (dea_antagonist){.there = true,
                                            .kind = kind == DEA_DOT ? DEA_LENS : DEA_DOT,
                                            .frame_radius = scene.actuator.frame_radius,
                                            .coverage = scene.actuator.coverage,
                                            .film_thickness = 1.2e-4,
                                            .layers = 1.0,
                                            .prestretch = 1.25,
                                            .voltage = 300.0,
                                            .own_material = true,
                                            .material = scene.material};
    }
    if (way & WITH_LOAD) {
        *dea_scene_load(&scene, "mass") = 1e-4;
        *dea_scene_load(&scene, "stiffness") = 40.0;
        *dea_scene_load(&scene, "force") = 0.01;
        *dea_scene_load(&scene, "damping") = 0.1;
    }
    return scene;
}

/* From the first line of the network to its last; the caller frees it. */
static char *network_in(const char *text)
{
    const char *begin = strstr(text, DEA_CARDS_BEGIN), *end = begin ? strstr(begin, DEA_CARDS_END) : NULL;
    assert_non_null(end);
    assert_true(end > begin + strlen(DEA_CARDS_BEGIN));
    return strndup(begin, (size_t)(end - begin));
}

static char *exported(const dea_scene *scene)
{
    char *text = NULL;
    size_t length;
    dea_error error = {0};
    dea_export export = {.scene = scene, .dialect = dea_dialect_find("ngspice"), .analogy = dea_analogy_at(0)};
    export.out = open_memstream(&text, &length);
    assert_non_null(export.out);
    const dea_status status = dea_export_netlist(&export, &error);
    assert_int_equal(fclose(export.out), 0);
    if (status != DEA_OK) {
        fail_msg("%s", error.message);
    }
    return text;
}

/* Frees both. */
static void assert_one_text(char *ours, char *theirs, const char *what)
{
    char *engine = network_in(ours), *file = network_in(theirs);
    if (strcmp(engine, file) != 0) {
        fprintf(stderr, "%s\n---\n%s\n", engine, file);
        fail_msg("%s: the engine runs another network than is exported", what);
    }
    free(engine);
    free(file);
    free(ours);
    free(theirs);
}

static char *transient_of(const dea_scene *scene)
{
    dea_units units;
    dea_scene inside;
    dea_dynamics dynamics;
    dea_mobility mobility;
    dea_signal signal;
    char *text = NULL;
    assert_int_equal(dea_ngspice_units(scene, scene->models[0], &units, NULL), DEA_OK);
    assert_true(units.length != 1.0 && units.voltage != 1.0);
    assert_int_equal(dea_units_enter(&units, scene, &inside, NULL), DEA_OK);
    assert_int_equal(dea_mobility_prepare(&inside, inside.models[0], dea_analogy_at(0), &dynamics, &mobility, NULL), DEA_OK);
    assert_int_equal(dea_signal_open(&inside, &signal, NULL), DEA_OK);
    const dea_mobility_piece piece = {
        .signal = &signal, .to = inside.transient.until, .step = 1.0, .parts = 1.0, .loose = 1.0, .scale = 1.0, .force = 1.0, .mass = dynamics.mass};
    assert_int_equal(dea_mobility_write(&mobility, &piece, &text, NULL), DEA_OK);
    dea_signal_close(&signal);
    dea_mobility_close(&mobility);
    dea_dynamics_close(&dynamics);
    dea_units_leave(&inside);
    return text;
}

static void transients_are_one_text(void **state)
{
    (void)state;
    for (int n = 0; n < FILMS * MODELS * WAYS; n += n % WAYS % 89 + 1) {
        char what[80];
        const film *f = &films[n / WAYS % FILMS];
        const char *model = models[n / WAYS / FILMS];
        dea_scene scene = scene_of(f, model, n % 2 ? DEA_LENS : DEA_DOT, n % WAYS);
        scene.study = DEA_STUDY_TRANSIENT;
        scene.transient = (dea_transient){.until = 0.02, .every = 1e-3};
        scene.drive.waveform =
            (dea_waveform){.kind = DEA_WAVE_STEP, .step = {1e-3, (double)NAN, 700.0, 1e-4}, .period = (double)NAN};
        scene.accuracy = 1e-3;
        snprintf(what, sizeof what, "transient %d of %s, %s", n, f->law, model);
        assert_one_text(transient_of(&scene), exported(&scene), what);
    }
}

static char *response_of(const dea_scene *scene)
{
    const dea_units units = {1024.0, 4096.0, 0x1p-20, 0x1p-10, 128.0};
    dea_scene inside;
    dea_dynamics dynamics;
    dea_biased_film biased = {.dynamics = &dynamics};
    char *text = NULL;
    assert_int_equal(dea_units_enter(&units, scene, &inside, NULL), DEA_OK);
    assert_int_equal(dea_dynamics_open(&inside, inside.models[0], &dynamics, NULL), DEA_OK);
    biased.bias.voltage = inside.ac.bias / (1.0 + dynamics.series * dynamics.conductance);
    assert_true(dea_dynamics_equilibrium(&dynamics, biased.bias.voltage, &biased.bias.u));
    const dea_bands bands = dea_bands_of_film(&biased, &inside, NULL);
    const dea_mobility_band band = {.from = inside.ac.from, .to = inside.ac.to, .points_per_decade = 3};
    assert_int_equal(dea_bands_write(&bands, &band, &text, NULL), DEA_OK);
    dea_dynamics_close(&dynamics);
    dea_units_leave(&inside);
    return text;
}

static void frequency_responses_are_one_text(void **state)
{
    (void)state;
    for (int n = 0; n < FILMS * MODELS * WAYS; n += n % WAYS % 97 + 1) {
        char what[80];
        const film *f = &films[n / WAYS % FILMS];
        const char *model = models[n / WAYS / FILMS];
        dea_scene scene = scene_of(f, model, n % 2 ? DEA_LENS : DEA_DOT, n % WAYS);
        scene.study = DEA_STUDY_AC;
        scene.ac = (dea_ac){.from = 10.0, .to = 2000.0, .points_per_decade = 3, .bias = 500.0};
        snprintf(what, sizeof what, "response %d of %s, %s", n, f->law, model);
        assert_one_text(response_of(&scene), exported(&scene), what);
    }
}

/* A bare number is one of the scene under its name, or of the axis; all others are formulas. */
static void assert_numbers_are_named(const char *text, const dea_scene *scene)
{
    static const char *const names[] = {"frame_radius", "film_thickness", "permittivity", "modulus", "voltage", "load_stiffness", "load_force"};
    for (const char *card = strstr(text, ".param "); card; card = strstr(card + 1, ".param ")) {
        const char *name = card + strlen(".param ");
        const size_t length = strcspn(name, "=");
        bool known = name[length + 1] == '{' || strncmp(name, "axis_", 5) == 0 || strncmp(name, "skin_", 5) == 0 || strncmp(name, "second_", 7) == 0;
        for (size_t i = 0; i < sizeof names / sizeof *names; i++) {
            known = known || (strlen(names[i]) == length && strncmp(name, names[i], length) == 0);
        }
        for (size_t i = 0; i < DEA_LAW_CONSTANTS; i++) {
            char own[DEA_QUANTITY_NAME];
            dea_constant_name(scene->material.law, i, own);
            known = known || (strlen(own) == length && strncmp(name, own, length) == 0);
        }
        if (!known) {
            fail_msg("a bare number: %.40s", card);
        }
    }
}

static void sweeps_are_one_text(void **state)
{
    (void)state;
    enum { POINTS = 5 };
    for (int n = 0; n < FILMS * MODELS * 3; n++) {
        static const int ways[] = {0, WITH_SKIN, WITH_LAYERS, WITH_LOAD, WITH_SKIN | WITH_LAYERS | WITH_LOAD, WITH_FOLLOWING, WITH_SECOND};
        char what[80];
        const film *f = &films[n / 3 % FILMS];
        const char *model = models[n / 3 / FILMS];
        dea_scene scene = scene_of(f, model, n % 2 ? DEA_LENS : DEA_DOT, ways[n % 7]);
        double *const fields[] = {&scene.drive.voltage, &scene.actuator.coverage, &scene.actuator.prestretch};
        double values[POINTS];
        dea_axis axis;
        scene.drive.voltage = 500.0;
        for (int k = 0; k < POINTS; k++) {
            values[k] = *fields[n % 3] * (1.0 + 0.02 * k);
        }
        add_axis(&scene, &axis, fields[n % 3], values, POINTS);
        char *text = NULL;
        const dea_netlist_study study = {.scene = &scene, .model = scene.models[0], .axis = &axis, .count = POINTS, .force_scale = 1.0, .length_scale = 1.0};
        assert_int_equal(dea_netlist_write(&study, &text, NULL), DEA_OK);
        snprintf(what, sizeof what, "sweep %d of %s, %s", n, f->law, model);
        char *file = exported(&scene);
        assert_numbers_are_named(file, &scene);
        assert_one_text(text, file, what);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(transients_are_one_text),
        cmocka_unit_test(frequency_responses_are_one_text),
        cmocka_unit_test(sweeps_are_one_text),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
