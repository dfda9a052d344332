/* Answers of engines to scenes written out, kept in memory. */
#ifndef DEA_TEST_ANSWERS_H
#define DEA_TEST_ANSWERS_H

#include "scenes.h"

static const char *const engines[] = {"direct", "ida", "ngspice"};
enum { ENGINES = 3, MOST = 1 << 18 };

typedef struct answer {
    size_t size, rows; /* of a point: bytes, and rows */
    _Alignas(16) char bytes[MOST];
} answer;

static answer one, other;

static dea_status take(void *user, size_t first, const void *points, size_t count, dea_error *error)
{
    answer *a = user;
    (void)error;
    assert_true((first + count) * a->size <= MOST);
    memcpy(a->bytes + first * a->size, points, count * a->size);
    return DEA_OK;
}

static void read_scene(const char *text, const char *model, dea_scene *scene)
{
    dea_error error = {0};
    if (dea_scene_parse(text, strlen(text), "test", ".", NULL, 0, model, scene, &error) != DEA_OK) {
        fail_msg("%s: %s", text, error.message);
    }
}

/* False where the engine cannot do it. */
static bool run(const char *text, const char *model, const char *engine, answer *a)
{
    dea_scene scene;
    dea_error error = {0};
    read_scene(text, model, &scene);
    a->size = dea_layout_of(&scene).point_size;
    a->rows = dea_layout_of(&scene).rows;
    const dea_run_options options = {.jobs = 1, .points = take, .user = a};
    const bool able = !dea_engine_refuses(dea_engine_find(engine), &scene, scene.models[0]);
    if (able && dea_study_run(&scene, dea_engine_find(engine), &options, &error) != DEA_OK) {
        fail_msg("%s, %s: %s", engine, model, error.message);
    }
    dea_scene_free(&scene);
    return able;
}

#endif
