#include "engine/cut.h"
#include "study/study.h"

#include <stdint.h>

enum {
    MOST_HERE = 1024,    /* points of an engine that may run in this process, which cannot be stopped inside a block */
    SMALLEST_SHARE = 16, /* a block is not cut below this fraction of what the engine takes best */
    BLOCKS_WANTED = 64   /* so many workers have something to do, and end at about the same time */
};

static size_t divide_up(size_t a, size_t b)
{
    return a / b + (a % b != 0);
}

static size_t smaller(size_t a, size_t b)
{
    return a < b ? a : b;
}

static size_t larger(size_t a, size_t b)
{
    return a > b ? a : b;
}

/* What all who may be asked can take, and whether one of them is isolated. */
static size_t best_block(const dea_scene *scene, const dea_engine *engine, bool *isolated)
{
    size_t best = SIZE_MAX;
    *isolated = false;
    for (size_t m = 0; m < scene->model_count; m++) {
        const dea_crew crew = dea_crew_of(scene, engine, scene->models[m]);
        for (size_t i = 0; i < crew.count; i++) {
            best = smaller(best, larger(crew.engines[i]->block, 1));
            *isolated = *isolated || crew.engines[i]->isolated;
        }
    }
    return best;
}

static size_t block_size(const dea_scene *scene, size_t best, bool isolated, size_t points, size_t total)
{
    if (dea_study_of(scene)->solve)
        return 1; /* a point is a whole run */
    size_t block = smaller(best, larger(divide_up(total, BLOCKS_WANTED), divide_up(best, SMALLEST_SHARE)));
    if (!isolated)
        block = smaller(block, MOST_HERE);
    return smaller(block, points);
}

dea_status dea_cut_make(const dea_scene *scene, const dea_engine *engine, dea_cut *cut, dea_error *error)
{
    const size_t points = dea_scene_point_count(scene);
    if (scene->model_count == 0 || points == 0)
        return dea_fail(error, DEA_ERROR_USAGE, "the study has no point");
    if (points > SIZE_MAX / sizeof(dea_row) / scene->model_count)
        return dea_fail(error, DEA_ERROR_USAGE, "the study has more points than this machine can count");
    *cut = (dea_cut){.points = points, .total = points * scene->model_count};
    const size_t best = best_block(scene, engine, &cut->isolated);
    cut->block = block_size(scene, best, cut->isolated, points, cut->total);
    cut->blocks_per_model = divide_up(points, cut->block);
    cut->blocks = cut->blocks_per_model * scene->model_count;
    return DEA_OK;
}

dea_range dea_cut_range(const dea_cut *cut, size_t block)
{
    const size_t model = block / cut->blocks_per_model;
    const size_t first = (block % cut->blocks_per_model) * cut->block;
    return (dea_range){
        .model = model, .first = first, .place = model * cut->points + first, .count = smaller(cut->points - first, cut->block)};
}

size_t dea_cut_block(const dea_cut *cut, size_t place)
{
    return place / cut->points * cut->blocks_per_model + place % cut->points / cut->block;
}
