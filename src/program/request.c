/* From the arguments to the scene and the engine that they ask for. */
#include <stdio.h>

#include "program/program.h"

enum { MOST_ENGINES = 16 };

const dea_engine *dea_engine_choose(const char *name)
{
    const char *names[MOST_ENGINES];
    size_t count = 0;
    const dea_engine *engine = dea_engine_find(name);
    while (count < MOST_ENGINES && dea_engine_at(count)) {
        names[count] = dea_engine_at(count)->name;
        count++;
    }
    if (!engine) {
        dea_complain_unknown("engine", name, names, count);
    }
    return engine;
}

bool dea_scene_open(const dea_arguments *arguments, const char *path, dea_scene *scene, dea_exit *outcome)
{
    dea_error error = {0};
    dea_status status = dea_scene_read(path, arguments->settings, arguments->setting_count, arguments->model, scene, &error);
    if (status == DEA_OK) {
        return true;
    }
    *outcome = dea_complain_error(&error);
    if (status == DEA_ERROR_IO) {
        *outcome = DEA_EXIT_USAGE;
    }
    return false;
}

static bool can_do_all(const dea_engine *engine, const dea_scene *scene)
{
    for (size_t i = 0; i < scene->model_count; i++) {
        if (dea_engine_refuses(engine, scene, scene->models[i])) {
            return false;
        }
    }
    return true;
}

bool dea_engine_unfit(const dea_engine *engine, const dea_scene *scene)
{
    if (can_do_all(engine, scene)) {
        return false;
    }
    for (size_t i = 0; i < scene->model_count; i++) {
        const char *why = dea_engine_refuses(engine, scene, scene->models[i]);
        if (why) {
            dea_complain("engine %s cannot do model %s: %s", engine->name, scene->models[i]->name, why);
        }
    }
    for (size_t i = 0; i < dea_engine_count(); i++) {
        if (can_do_all(dea_engine_at(i), scene)) {
            dea_complain("--engine %s can do it", dea_engine_at(i)->name);
        }
    }
    return true;
}
