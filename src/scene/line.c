#include "scene/line.h"

/* Points between neighbours along axis number @p axis: product of the lengths of the faster axes. */
static size_t stride_of(const dea_scene *scene, size_t axis)
{
    size_t stride = 1;
    for (size_t i = axis + 1; i < scene->axis_count; i++) {
        stride *= scene->axes[i].count;
    }
    return stride;
}

/* Longest lines that a block of count points holds along that axis. */
static size_t reach_of(const dea_scene *scene, size_t axis, size_t count)
{
    const size_t reach = count / stride_of(scene, axis);
    return reach < scene->axes[axis].count ? reach : scene->axes[axis].count;
}

static size_t longest_axis(const dea_scene *scene, size_t count)
{
    size_t best = scene->axis_count - 1;
    for (size_t i = scene->axis_count - 1; i-- > 0;) {
        if (reach_of(scene, i, count) > reach_of(scene, best, count)) {
            best = i;
        }
    }
    return best;
}

size_t dea_axis_index(const dea_scene *scene, size_t axis, size_t point)
{
    return point / stride_of(scene, axis) % scene->axes[axis].count;
}

void dea_axes_place(dea_scene *scene, size_t point)
{
    for (size_t i = scene->axis_count; i-- > 0;) {
        const dea_axis *axis = &scene->axes[i];
        dea_axis_set(axis, scene, axis->values[point % axis->count]);
        point /= axis->count;
    }
}

dea_status dea_lines_visit(const dea_scene *scene, size_t first, size_t count, dea_line_visit *visit, void *user,
                           dea_error *error)
{
    dea_scene here = *scene; /* shares title and axes, changes only scalars */
    if (scene->axis_count == 0) {
        return visit(user, &here, &(dea_line){.count = 1, .stride = 1}, error);
    }
    const size_t number = longest_axis(scene, count);
    const dea_axis *axis = &scene->axes[number];
    const size_t stride = stride_of(scene, number);
    const size_t sheet = stride * axis->count; /* points that share the slower axes */
    const size_t end = first + count;
    dea_status status = DEA_OK;
    for (size_t base = first / sheet * sheet; base < end && status == DEA_OK; base += sheet) {
        for (size_t offset = 0; offset < stride && status == DEA_OK; offset++) {
            const size_t zero = base + offset; /* index 0 on the axis */
            const size_t from = first > zero ? (first - zero + stride - 1) / stride : 0;
            const size_t past = end > zero ? (end - zero + stride - 1) / stride : 0;
            const size_t to = past < axis->count ? past : axis->count;
            if (from < to) {
                const size_t point = zero + from * stride;
                dea_axes_place(&here, point);
                status = visit(user, &here, &(dea_line){axis, from, to - from, point - first, stride}, error);
            }
        }
    }
    return status;
}
