/* CSV: one header row, full double precision, empty fields for numbers that are not there. Of a transient or a frequency response
 * every sample is a row, behind the axes of its run. */
#include "output/writer.h"
#include "scene/line.h"
#include "support/number.h"

#include "deaspice/model.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { CSV_BUFFER = 1 << 16, CSV_TAIL = (DEA_LAYOUT_COLUMNS + DEA_SPREAD_COLUMNS + 3) * DEA_NUMBER_LENGTH + 16 };

typedef struct csv {
    const dea_scene *scene;
    dea_layout layout;
    dea_atomic *file;
    char *prefix;         /* model and all axes, as text */
    size_t prefix_length; /* of the model and all axes but the last; stays for a whole run of the last axis */
    char *buffer;         /* CSV_BUFFER and room for one row more */
    size_t used;
} csv;

static dea_status csv_flush(csv *sheet, dea_error *error)
{
    const size_t used = sheet->used;
    sheet->used = 0;
    return dea_atomic_write(sheet->file, sheet->buffer, used, error);
}

static void csv_put(csv *sheet, const char *text, size_t length)
{
    memcpy(sheet->buffer + sheet->used, text, length);
    sheet->used += length;
}

/* A word and what parts it from the next. */
static void csv_word(csv *sheet, const char *text)
{
    csv_put(sheet, text, strlen(text));
    csv_put(sheet, ",", 1);
}

static size_t prefix_room(const dea_scene *scene)
{
    return 2 * DEA_NAME_LENGTH + scene->axis_count * (DEA_NAME_LENGTH + 1);
}

/* Model and axes of a point, but for the last axis. */
static void csv_prefix(csv *sheet, size_t point)
{
    const dea_scene *scene = sheet->scene;
    char *out = sheet->prefix;
    if (scene->model_count > 1) {
        out += sprintf(out, "%s,", scene->models[point / dea_scene_point_count(scene)]->name);
    }
    for (size_t i = 0; i + 1 < scene->axis_count; i++) {
        out += dea_number_write(out, scene->axes[i].values[dea_axis_index(scene, i, point)]);
        *out++ = ',';
    }
    sheet->prefix_length = (size_t)(out - sheet->prefix);
}

/* Completes the prefix by the last axis; returns its whole length. */
static size_t csv_lead(csv *sheet, size_t point)
{
    const dea_scene *scene = sheet->scene;
    const dea_axis *last = scene->axis_count > 0 ? &scene->axes[scene->axis_count - 1] : NULL;
    const size_t index = last ? point % last->count : 0;
    if (index == 0) {
        csv_prefix(sheet, point);
    }
    char *out = sheet->prefix + sheet->prefix_length;
    if (last) {
        out += dea_number_write(out, last->values[index]);
        *out++ = ',';
    }
    return (size_t)(out - sheet->prefix);
}

/* A row, and of what it tells over the radius the entry at one radius (NULL: it tells nothing). */
static void csv_row(csv *sheet, size_t lead, const char *row, double radius, const double *entry)
{
    const dea_layout *layout = &sheet->layout;
    csv_put(sheet, sheet->prefix, lead);
    char *const start = sheet->buffer + sheet->used;
    char *out = start;
    for (size_t i = 0; i < layout->column_count; i++) {
        out += dea_number_write(out, dea_layout_number(row, layout->columns[i].offset));
        *out++ = ',';
    }
    for (size_t i = 0; entry && i <= layout->spread_count; i++) {
        out += dea_number_write(out, i == 0 ? radius : entry[i - 1]);
        *out++ = ',';
    }
    sheet->used += (size_t)(out - start);
    const char *state = dea_state_name(dea_layout_state(layout, row));
    csv_put(sheet, state, strlen(state));
    csv_put(sheet, "\n", 1);
}

static void csv_header(csv *sheet)
{
    const dea_scene *scene = sheet->scene;
    if (scene->model_count > 1) {
        csv_word(sheet, "model");
    }
    for (size_t i = 0; i < scene->axis_count; i++) {
        csv_word(sheet, scene->axes[i].column);
    }
    for (size_t i = 0; i < sheet->layout.column_count; i++) {
        csv_word(sheet, sheet->layout.columns[i].name);
    }
    for (size_t i = 0; sheet->layout.spread_count > 0 && i <= sheet->layout.spread_count; i++) {
        csv_word(sheet, i == 0 ? "radius_m" : sheet->layout.spread[i - 1].name);
    }
    csv_put(sheet, "state\n", 6);
}

static dea_status csv_close(void *state, bool keep, dea_error *error)
{
    csv *sheet = state;
    if (!sheet) {
        return DEA_OK;
    }
    const dea_status status = keep ? csv_flush(sheet, error) : DEA_OK;
    free(sheet->prefix);
    free(sheet->buffer);
    free(sheet);
    return status;
}

static dea_status csv_open(const dea_scene *scene, const char *engine, dea_atomic *file, void **state, dea_error *error)
{
    (void)engine;
    csv *sheet = calloc(1, sizeof *sheet);
    if (sheet) {
        sheet->scene = scene;
        sheet->layout = dea_layout_of(scene);
        sheet->file = file;
        sheet->prefix = malloc(prefix_room(scene));
        sheet->buffer = malloc(CSV_BUFFER + prefix_room(scene) + CSV_TAIL);
    }
    if (!sheet || !sheet->prefix || !sheet->buffer) {
        csv_close(sheet, false, NULL);
        return dea_fail(error, DEA_ERROR_MEMORY, "out of memory");
    }
    csv_header(sheet);
    *state = sheet;
    return DEA_OK;
}

static dea_status csv_point(csv *sheet, size_t number, const char *point, dea_error *error)
{
    const dea_layout *layout = &sheet->layout;
    const size_t lead = csv_lead(sheet, number), each = layout->spread_count > 0 ? layout->spread_points : 1;
    for (size_t i = 0; i < layout->rows * each; i++) {
        const bool spread = layout->spread_count > 0;
        csv_row(sheet, lead, point + i / each * layout->row_size, spread ? dea_layout_radius(sheet->scene, layout, i % each) : 0.0,
                spread ? dea_layout_entry(layout, point, i / each, i % each) : NULL);
        if (sheet->used >= CSV_BUFFER) {
            const dea_status status = csv_flush(sheet, error);
            if (status != DEA_OK) {
                return status;
            }
        }
    }
    return DEA_OK;
}

static dea_status csv_points(void *state, size_t first, const void *points, size_t count, dea_error *error)
{
    csv *sheet = state;
    for (size_t i = 0; i < count; i++) {
        const dea_status status = csv_point(sheet, first + i, (const char *)points + i * sheet->layout.point_size, error);
        if (status != DEA_OK) {
            return status;
        }
    }
    return sheet->file->direct ? csv_flush(sheet, error) : DEA_OK; /* a reader at the other end sees points as they come */
}

const dea_format dea_format_csv = {.name = "csv", .straight = true, .open = csv_open, .points = csv_points, .close = csv_close};
