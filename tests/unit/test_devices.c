/* Films as they are built: stacks of layers. Judges are one film alone, figures from elsewhere, and other engines. */
#include "scenes.h"

#include <stdlib.h>

#define FILM(kind, more)                                                                                                        \
    "actuator: {kind: " kind ", frame_radius: 30 mm, coverage: 0.5, film_thickness: 100 um, prestretch: 1.2" more "}\n"
#define PAPER "material: {base: elastosil-2030, yeoh: {C1: 178426 Pa, C2: -6023 Pa, C3: 4234 Pa}, permittivity: 2.8}\n"
#define STILL "drive: {voltage: 4500 V}\nstudy: {sweep: {}}\n"

static const char *const engines[] = {"direct", "ida", "ngspice"};
enum { ENGINES = 3, MOST = 1 << 18 };

typedef struct answer {
    size_t size, rows, count;
    _Alignas(16) char bytes[MOST];
} answer;

static answer one, other;

static dea_status take(void *user, size_t first, const void *points, size_t count, dea_error *error)
{
    answer *a = user;
    (void)error;
    assert_true((first + count) * a->size <= MOST);
    memcpy(a->bytes + first * a->size, points, count * a->size);
    a->count = first + count;
    return DEA_OK;
}

static void read_scene(const char *text, const char *model, dea_scene *scene)
{
    dea_error error = {0};
    if (dea_scene_parse(text, strlen(text), "test", ".", NULL, 0, model, scene, &error) != DEA_OK) {
        fail_msg("%s: %s", text, error.message);
    }
}

static void run(const char *text, const char *model, const char *engine, answer *a)
{
    dea_scene scene;
    dea_error error = {0};
    read_scene(text, model, &scene);
    a->size = dea_layout_of(&scene).point_size;
    a->rows = dea_layout_of(&scene).rows;
    const dea_run_options options = {.jobs = 1, .points = take, .user = a};
    if (dea_study_run(&scene, dea_engine_find(engine), &options, &error) != DEA_OK) {
        fail_msg("%s, %s: %s", engine, model, error.message);
    }
    dea_scene_free(&scene);
}

static dea_row row_of(const char *text, const char *model, const char *engine)
{
    run(text, model, engine, &one);
    return *(const dea_row *)one.bytes;
}

/* True where the engine can do the scene with the model. */
static bool can(const char *text, const char *model, const char *engine)
{
    dea_scene scene;
    read_scene(text, model, &scene);
    const bool able = !dea_engine_refuses(dea_engine_find(engine), &scene, scene.models[0]);
    dea_scene_free(&scene);
    return able;
}

/* Strain and field as of one layer, force, capacitance and charge five times. */
static void a_stack_is_as_many_films_side_by_side(void **state)
{
    (void)state;
    for (size_t e = 0; e < ENGINES; e++) {
        for (size_t m = 0; m < dea_model_count(); m++) {
            const dea_model *model = dea_model_at(m);
            for (int lens = 0; lens <= (int)model->lens; lens++) {
                const char *single = lens ? FILM("lens", "") PAPER STILL : FILM("dot", "") PAPER STILL;
                const char *stack = lens ? FILM("lens", ", layers: 5") PAPER STILL : FILM("dot", ", layers: 5") PAPER STILL;
                if (!can(single, model->name, engines[e])) {
                    continue;
                }
                const dea_row film = row_of(single, model->name, engines[e]), five = row_of(stack, model->name, engines[e]);
                assert_int_equal(five.state, film.state);
                assert_relative(five.strain, film.strain, 1e-10);
                assert_relative(five.field, film.field, 1e-10);
                assert_relative(five.force, 5.0 * film.force, 1e-10);
                assert_relative(five.capacitance, 5.0 * film.capacitance, 1e-10);
                assert_relative(five.charge, 5.0 * film.charge, 1e-10);
            }
        }
    }
}

static void charge_of_a_stack_is_the_printed_one(void **state)
{
    (void)state;
    assert_printed(1e6 * row_of(FILM("dot", "") PAPER STILL, "field", "direct").charge, 1.354360, 6);
    assert_printed(1e6 * row_of(FILM("dot", ", layers: 5") PAPER STILL, "field", "direct").charge, 6.771800, 6);
    assert_printed(1e6 * row_of(FILM("dot", ", layers: 5") PAPER STILL, "field", "ida").charge, 6.771800, 6);
}

#define LOSSY "material: {base: elastosil-2030, density: 1080 kg/m^3, retardation: 0.1 ms, prony: [{g: 0.1, tau: 2 ms}]}\n"
#define SWITCHED(resistance) "drive: {waveform: {step: {on: 0 s, voltage: 4 kV, rise: 0.1 ms}}, series_resistance: " resistance "}\n"
#define MOVED "accuracy: 1e-5\nstudy: {transient: {until: 4 ms, every: 0.1 ms}}\n"
#define SHAKEN "study: {ac: {from: 10 Hz, to: 1 kHz, points_per_decade: 3, bias: 3 kV}}\n"

/* Behind a fifth of the resistance five layers move as one does, and take five times the current. */
static void a_stack_moves_as_one_film(void **state)
{
    (void)state;
    static const char *const models[] = {"lumped", "lame", "coverage", "ring"};
    for (size_t e = 0; e < ENGINES; e++) {
        for (size_t m = 0; m < 4; m++) {
            const char *single = FILM("dot", "") LOSSY SWITCHED("1 MOhm") MOVED;
            if (!can(single, models[m], engines[e])) {
                continue;
            }
            run(single, models[m], engines[e], &one);
            run(FILM("dot", ", layers: 5") LOSSY SWITCHED("200 kOhm") MOVED, models[m], engines[e], &other);
            const dea_sample *film = (const dea_sample *)one.bytes, *five = (const dea_sample *)other.bytes;
            assert_true(one.rows == 41 && film[40].displacement > 1e-4);
            for (size_t i = 0; i < one.rows; i++) {
                assert_near(five[i].displacement, film[i].displacement, 1e-5 * film[40].displacement);
                assert_near(five[i].force, 5.0 * film[i].force, 1e-4 * film[40].force);
                assert_near(five[i].charge, 5.0 * film[i].charge, 1e-4 * film[40].charge);
            }
        }
    }
}

static void a_stack_answers_with_a_fifth_of_the_impedance(void **state)
{
    (void)state;
    static const char *const models[] = {"lumped", "lame", "coverage", "ring"};
    for (size_t e = 0; e < ENGINES; e++) {
        for (size_t m = 0; m < 4; m++) {
            const char *single = FILM("dot", "") LOSSY "drive: {series_resistance: 1 MOhm}\n" SHAKEN;
            if (!can(single, models[m], engines[e])) {
                continue;
            }
            run(single, models[m], engines[e], &one);
            run(FILM("dot", ", layers: 5") LOSSY "drive: {series_resistance: 200 kOhm}\n" SHAKEN, models[m], engines[e], &other);
            const dea_response *film = (const dea_response *)one.bytes, *five = (const dea_response *)other.bytes;
            for (size_t i = 0; i < one.rows; i++) {
                assert_relative(five[i].displacement, film[i].displacement, 1e-5);
                assert_relative(five[i].impedance, film[i].impedance / 5.0, 1e-5);
            }
        }
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_stack_is_as_many_films_side_by_side),
        cmocka_unit_test(charge_of_a_stack_is_the_printed_one),
        cmocka_unit_test(a_stack_moves_as_one_film),
        cmocka_unit_test(a_stack_answers_with_a_fifth_of_the_impedance),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
