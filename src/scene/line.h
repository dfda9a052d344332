/** @file line.h
 * A block of a sweep as straight lines of points: along a line only one axis moves, so that one network serves all of its points.
 */
#ifndef DEA_SCENE_LINE_H
#define DEA_SCENE_LINE_H

#include "deaspice/scene.h"

/** A line of points. */
typedef struct dea_line {
    const dea_axis *axis; /**< the axis that moves, NULL: a single point of a scene without axes */
    size_t from;          /**< index on that axis of the first point */
    size_t count;         /**< points, >= 1 */
    size_t row;           /**< row of the first point in the block */
    size_t stride;        /**< rows from one point to the next */
} dea_line;

/** Takes one line; @p scene has all axes at the line's first point. */
typedef dea_status dea_line_visit(void *user, const dea_scene *scene, const dea_line *line, dea_error *error);

/** Visits the lines of the points first ... first + count - 1; along the axis that makes them longest. Stops at the first
 * failure. */
dea_status dea_lines_visit(const dea_scene *scene, size_t first, size_t count, dea_line_visit *visit, void *user,
                           dea_error *error);

/** Index on axis number @p axis of a point, or of one of a further model. */
size_t dea_axis_index(const dea_scene *scene, size_t axis, size_t point);
/** Moves all axes of a scene to the point of that number. */
void dea_axes_place(dea_scene *scene, size_t point);

/** Sets one scalar of a scene: the swept one of @p axis. */
static inline void dea_axis_set(const dea_axis *axis, dea_scene *scene, double value)
{
    *(double *)((char *)scene + axis->offset) = value;
}

#endif
