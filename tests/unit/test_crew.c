/* Who is asked to solve what, and what becomes of points that the first cannot solve. */
#include "scenes.h"

#include <signal.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static const char *const texts[DEA_STUDIES] = {
    [DEA_STUDY_SWEEP] = "drive: {voltage: 4 kV}\nstudy: {sweep: {coverage: {from: 0.2, to: 0.8, points: 61}}}\n",
    [DEA_STUDY_TRANSIENT] = "drive: {waveform: {step: {on: 0 s, voltage: 3 kV}}}\nstudy: {transient: {until: 1 s}}\n",
    [DEA_STUDY_AC] = "drive: {}\nstudy: {ac: {from: 1 Hz, to: 1 kHz, bias: 3 kV}}\n",
    [DEA_STUDY_MODES] = "drive: {}\nstudy: {modes: {bias: 3 kV}}\n",
    [DEA_STUDY_PROFILE] = "drive: {voltage: 3 kV}\nstudy: {profile: {}}\n",
    [DEA_STUDY_FORCE] = "drive: {voltage: 3 kV}\nstudy: {force: {displacement: {from: 0 mm, to: 0.5 mm}}}\n"};

static dea_scene scene_read(dea_study_kind study, const char *rest)
{
    char text[2048];
    dea_scene scene;
    dea_error error = {0};
    snprintf(text, sizeof text,
             "actuator: {kind: dot, frame_radius: 30 mm, coverage: 0.5, film_thickness: 100 um, prestretch: 1.2}\n"
             "material: {base: elastosil-2030, density: 1080 kg/m^3}\nmodel: ring\n%s%s",
             texts[study], rest);
    if (dea_scene_parse(text, strlen(text), "crew", ".", NULL, 0, NULL, &scene, &error) != DEA_OK) {
        fail_msg("%s", error.message);
    }
    return scene;
}

/* "direct ida", the engines in order. */
static const char *crew_text(dea_study_kind study, const char *rest, const char *model)
{
    static char text[128];
    dea_scene scene = scene_read(study, rest);
    const dea_crew crew = dea_crew_of(&scene, NULL, dea_model_find(model));
    text[0] = '\0';
    for (size_t i = 0; i < crew.count; i++) {
        snprintf(text + strlen(text), sizeof text - strlen(text), "%s%s", i > 0 ? " " : "", crew.engines[i]->name);
    }
    dea_scene_free(&scene);
    return text;
}

static void the_cheapest_that_can_is_asked_first(void **state)
{
    (void)state;
    assert_string_equal(crew_text(DEA_STUDY_SWEEP, "", "pelrine"), "direct");
    assert_string_equal(crew_text(DEA_STUDY_SWEEP, "", "coverage"), "direct ida");
    assert_string_equal(crew_text(DEA_STUDY_SWEEP, "", "field"), "direct ida");
    assert_string_equal(crew_text(DEA_STUDY_SWEEP, "accuracy: 1e-11\n", "field"), "direct");
    assert_string_equal(crew_text(DEA_STUDY_SWEEP, "accuracy: 1e-13\n", "field"), "");
    assert_string_equal(crew_text(DEA_STUDY_TRANSIENT, "", "lumped"), "direct ida ngspice");
    assert_string_equal(crew_text(DEA_STUDY_TRANSIENT, "", "coverage"), "ida ngspice");
    assert_string_equal(crew_text(DEA_STUDY_TRANSIENT, "accuracy: 1e-8\n", "coverage"), "ida");
    assert_string_equal(crew_text(DEA_STUDY_AC, "", "coverage"), "direct ngspice");
}

static void a_scene_names_engines_in_its_own_order(void **state)
{
    (void)state;
    assert_string_equal(crew_text(DEA_STUDY_SWEEP, "engine: auto\n", "coverage"), "direct ida");
    assert_string_equal(crew_text(DEA_STUDY_SWEEP, "engine: ngspice\n", "coverage"), "ngspice");
    assert_string_equal(crew_text(DEA_STUDY_SWEEP, "engine: ngspice\n", "field"), "ngspice");
    assert_string_equal(crew_text(DEA_STUDY_SWEEP, "engine: [ngspice, direct]\n", "lumped"), "ngspice direct");
    assert_string_equal(crew_text(DEA_STUDY_SWEEP, "engine: [ngspice, direct]\n", "field"), "ngspice direct");
}

/* An engine that takes a model and says nothing of its cost would be asked before all others. */
static void every_engine_says_what_its_studies_cost(void **state)
{
    (void)state;
    for (int study = 0; study < (int)DEA_STUDIES; study++) {
        dea_scene scene = scene_read((dea_study_kind)study, "");
        for (size_t e = 0; dea_engine_at(e); e++) {
            for (size_t m = 0; dea_model_at(m); m++) {
                if (!dea_engine_refuses(dea_engine_at(e), &scene, dea_model_at(m))) {
                    assert_true(dea_engine_at(e)->costs[study][dea_model_form(dea_model_at(m))] > 0.0);
                }
            }
        }
        dea_scene_free(&scene);
    }
}

/* ---- an engine that does not deliver, before `direct` */

enum { POINTS = 61, EVERY = 7 };

static dea_status begin_fine(void **session, dea_error *error)
{
    (void)session, (void)error;
    return DEA_OK;
}

static dea_status begin_never(void **session, dea_error *error)
{
    (void)session;
    return dea_fail(error, DEA_ERROR_MISSING, "no licence today");
}

static void end_fine(void *session)
{
    (void)session;
}

static dea_status sweep_refuse(void *session, const dea_scene *scene, const dea_model *model, size_t first, size_t count,
                               dea_row *rows, dea_error *error)
{
    (void)session, (void)scene, (void)model, (void)first, (void)count, (void)rows;
    return dea_fail(error, DEA_ERROR_ENGINE, "singular matrix");
}

static dea_status sweep_gaps(void *session, const dea_scene *scene, const dea_model *model, size_t first, size_t count,
                             dea_row *rows, dea_error *error)
{
    (void)session, (void)scene, (void)model, (void)error;
    for (size_t i = 0; i < count; i++) {
        rows[i] = (first + i) % EVERY == 0 ? dea_row_failed() : (dea_row){.strain = 7.0};
    }
    return DEA_OK;
}

/* Brings its worker down at every EVERYth point. */
static dea_status sweep_crash(void *session, const dea_scene *scene, const dea_model *model, size_t first, size_t count,
                              dea_row *rows, dea_error *error)
{
    sweep_gaps(session, scene, model, first, count, rows, error);
    for (size_t i = 0; i < count; i++) {
        if (rows[i].state == DEA_STATE_FAILED) {
            raise(SIGSEGV);
        }
    }
    return DEA_OK;
}

typedef struct listener {
    dea_row rows[POINTS];
    size_t instead; /* points that direct solved */
    char line[1024];
} listener;

static dea_status take_rows(void *user, size_t first, const void *points, size_t count, dea_error *error)
{
    listener *heard = user;
    (void)error;
    memcpy(heard->rows + first, points, count * sizeof *heard->rows);
    return DEA_OK;
}

static void take_instead(void *user, const dea_engine *engine, size_t count)
{
    listener *heard = user;
    assert_string_equal(engine->name, "direct");
    heard->instead += count;
}

static void take_line(void *user, const char *line)
{
    listener *heard = user;
    snprintf(heard->line, sizeof heard->line, "%s", line);
}

static listener heard_of(const dea_engine *fake, size_t jobs)
{
    static listener heard;
    dea_error error = {0};
    dea_scene scene = scene_read(DEA_STUDY_SWEEP, "engine: [ida, direct]\n");
    const dea_run_options options = {.jobs = jobs, .points = take_rows, .instead = take_instead, .log = take_line, .user = &heard};
    scene.engines[0] = fake;
    heard = (listener){.line = ""};
    if (dea_study_run(&scene, NULL, &options, &error) != DEA_OK) {
        fail_msg("%s", error.message);
    }
    dea_scene_free(&scene);
    return heard;
}

static listener truth(void)
{
    return heard_of(&(dea_engine){.name = "fake", .block = 16, .refuses = NULL, .begin = begin_never, .end = end_fine}, 1);
}

/* The rows but for what pads them. */
static void assert_rows_equal(const dea_row *heard, const dea_row *wanted)
{
    for (size_t i = 0; i < POINTS; i++) {
        assert_memory_equal(&heard[i], &wanted[i], offsetof(dea_row, state) + sizeof heard->state);
    }
}

static void what_cannot_begin_is_passed_over(void **state)
{
    (void)state;
    const listener heard = truth();
    for (size_t i = 0; i < POINTS; i++) {
        assert_int_equal(heard.rows[i].state, DEA_STATE_OK);
        assert_true(heard.rows[i].strain > 0.0 && heard.rows[i].strain < 1.0);
    }
    assert_non_null(strstr(heard.line, "no licence today; direct was asked instead"));
}

static void what_is_refused_goes_to_the_next(void **state)
{
    (void)state;
    static const dea_engine fake = {
        .name = "fake", .block = 16, .patience = 1.0, .begin = begin_fine, .sweep = sweep_refuse, .end = end_fine};
    const listener wanted = truth();
    for (size_t jobs = 1; jobs < 4; jobs += 2) {
        const listener heard = heard_of(&fake, jobs);
        assert_rows_equal(heard.rows, wanted.rows);
        assert_non_null(strstr(heard.line, "singular matrix; direct was asked instead"));
        assert_int_equal(heard.instead, POINTS);
    }
}

static void points_that_fail_go_to_the_next_and_only_they(void **state)
{
    (void)state;
    static const dea_engine fake = {
        .name = "fake", .block = 256, .patience = 1.0, .begin = begin_fine, .sweep = sweep_gaps, .end = end_fine};
    const listener wanted = truth();
    for (size_t jobs = 1; jobs < 4; jobs += 2) {
        const listener heard = heard_of(&fake, jobs);
        for (size_t i = 0; i < POINTS; i++) {
            assert_true(heard.rows[i].strain == (i % EVERY == 0 ? wanted.rows[i].strain : 7.0));
        }
        assert_non_null(strstr(heard.line, "; solved by direct instead where that failed"));
        assert_int_equal(heard.instead, (POINTS + EVERY - 1) / EVERY);
    }
}

static void points_that_cost_a_worker_go_to_the_next_and_only_they(void **state)
{
    (void)state;
    static const dea_engine fake = {
        .name = "fake", .isolated = true, .block = 256, .patience = 1.0, .begin = begin_fine, .sweep = sweep_crash, .end = end_fine};
    const listener wanted = truth();
    for (size_t jobs = 1; jobs < 4; jobs += 2) {
        const listener heard = heard_of(&fake, jobs);
        for (size_t i = 0; i < POINTS; i++) {
            assert_true(heard.rows[i].strain == (i % EVERY == 0 ? wanted.rows[i].strain : 7.0));
        }
        assert_non_null(strstr(heard.line, "; direct is asked instead"));
        assert_int_equal(heard.instead, (POINTS + EVERY - 1) / EVERY);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(the_cheapest_that_can_is_asked_first),
        cmocka_unit_test(a_scene_names_engines_in_its_own_order),
        cmocka_unit_test(every_engine_says_what_its_studies_cost),
        cmocka_unit_test(what_cannot_begin_is_passed_over),
        cmocka_unit_test(what_is_refused_goes_to_the_next),
        cmocka_unit_test(points_that_fail_go_to_the_next_and_only_they),
        cmocka_unit_test(points_that_cost_a_worker_go_to_the_next_and_only_they),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
