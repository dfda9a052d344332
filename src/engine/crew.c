/* Who solves which model: the engines that can, in the scene's order or by what they cost. */
#include <stdio.h>

#include "study/study.h"

/* Engines that the scene names, else all. */
static const dea_engine *candidate(const dea_scene *scene, size_t index)
{
    if (scene->engine_count > 0) {
        return index < scene->engine_count ? scene->engines[index] : NULL;
    }
    return dea_engine_at(index);
}

static double cost_of(const dea_engine *engine, const dea_scene *scene, const dea_model *model)
{
    return engine->costs[scene->study][dea_model_form(model)];
}

static void insert(dea_crew *crew, size_t place, const dea_engine *engine)
{
    for (size_t i = crew->count; i > place; i--) {
        crew->engines[i] = crew->engines[i - 1];
    }
    crew->engines[place] = engine;
    crew->count++;
}

/* Every static answer is held against the same balance of forces: what engines of this process find no root of, nobody does, and
 * none of them shall wait for workers. */
static void keep_here(dea_crew *crew)
{
    size_t kept = 0;
    for (size_t i = 0; i < crew->count; i++) {
        if (i == 0 || !crew->engines[i]->isolated || crew->engines[0]->isolated) {
            crew->engines[kept++] = crew->engines[i];
        }
    }
    crew->count = kept;
}

dea_crew dea_crew_of(const dea_scene *scene, const dea_engine *engine, const dea_model *model)
{
    dea_crew crew = {0};
    if (engine) {
        crew.engines[0] = engine;
        crew.count = dea_engine_refuses(engine, scene, model) ? 0 : 1;
        return crew;
    }
    for (size_t i = 0; crew.count < DEA_ENGINES && candidate(scene, i); i++) {
        const dea_engine *next = candidate(scene, i);
        if (dea_engine_refuses(next, scene, model)) {
            continue;
        }
        size_t place = crew.count;
        while (scene->engine_count == 0 && place > 0 &&
               cost_of(crew.engines[place - 1], scene, model) > cost_of(next, scene, model)) {
            place--;
        }
        insert(&crew, place, next);
    }
    if (!dea_study_of(scene)->along) {
        keep_here(&crew);
    }
    return crew;
}

static const char *first_name(const dea_scene *scene, const dea_engine *engine, size_t model)
{
    const dea_crew crew = dea_crew_of(scene, engine, scene->models[model]);
    return crew.count > 0 ? crew.engines[0]->name : "none";
}

void dea_crew_names(const dea_scene *scene, const dea_engine *engine, char *text, size_t size)
{
    size_t used = 0;
    const char *name = first_name(scene, engine, 0);
    bool same = true;
    for (size_t i = 0; i < scene->model_count; i++) {
        same = same && first_name(scene, engine, i) == name;
    }
    for (size_t i = 0; i < scene->model_count && !same && used < size; i++) {
        name = first_name(scene, engine, i);
        const bool last = i + 1 == scene->model_count || first_name(scene, engine, i + 1) != name;
        used += (size_t)snprintf(text + used, size - used, "%s%s%s%s", i > 0 ? ", " : "", scene->models[i]->name,
                                 last ? " by " : "", last ? name : "");
    }
    if (same) {
        snprintf(text, size, "%s", name);
    }
}
