/** @file cut.h
 * How a study is cut into blocks, the unit in which workers get it, journals keep it and shards share it. The cut depends on
 * scene and engines alone, so that a block's number means the same points in every run of a study.
 */
#ifndef DEA_ENGINE_CUT_H
#define DEA_ENGINE_CUT_H

#include "deaspice/engine.h"

/** A study cut into blocks that never cross from one model to the next. */
typedef struct dea_cut {
    size_t points; /**< points of one model */
    size_t total;  /**< points of the study: of all models */
    size_t block;  /**< most points in a block */
    bool isolated; /**< an engine that may be asked runs only in worker processes */
    size_t blocks_per_model;
    size_t blocks; /**< of the study */
} dea_cut;

/** Points of a block. */
typedef struct dea_range {
    size_t model; /**< number of its model in the scene */
    size_t first; /**< first point, counted within its model */
    size_t place; /**< first point, counted over the study */
    size_t count; /**< points, >= 1 */
} dea_range;

/** Cuts a study for an engine, or where it is NULL for the crews of its models. @return DEA_OK, DEA_ERROR_USAGE (no point, or too many to count) */
dea_status dea_cut_make(const dea_scene *scene, const dea_engine *engine, dea_cut *cut, dea_error *error);
/** Points of block number @p block. */
dea_range dea_cut_range(const dea_cut *cut, size_t block);
/** Number of the block that begins with point @p place, counted over the study. */
size_t dea_cut_block(const dea_cut *cut, size_t place);

#endif
