/* CSV: one header row, full double precision, empty fields for numbers that are not there. */
#include "support/number.h"
#include "output/writer.h"

#include "deaspice/model.h"

#include <stdlib.h>
#include <string.h>

enum { CSV_BUFFER = 1 << 16, CSV_TAIL = (DEA_ROW_COLUMNS + 2) * DEA_NUMBER_LENGTH + 16 };

typedef struct csv {
    const dea_scene *scene;
    dea_atomic *file;
    size_t model;  /* of the row that comes next */
    size_t *index; /* of the row that comes next along each axis */
    char *prefix;  /* model and all axes but the last, as text; stays for a whole run of the last axis */
    size_t prefix_length;
    char *buffer; /* CSV_BUFFER and room for one row more */
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

static size_t prefix_room(const dea_scene *scene)
{
    return 2 * DEA_NAME_LENGTH + scene->axis_count * (DEA_NAME_LENGTH + 1);
}

static void csv_prefix(csv *sheet)
{
    const dea_scene *scene = sheet->scene;
    char *out = sheet->prefix;
    if (scene->model_count > 1) {
        const char *name = scene->models[sheet->model]->name;
        const size_t length = strlen(name);
        memcpy(out, name, length);
        out += length;
        *out++ = ',';
    }
    for (size_t i = 0; i + 1 < scene->axis_count; i++) {
        out += dea_number_write(out, scene->axes[i].values[sheet->index[i]]);
        *out++ = ',';
    }
    sheet->prefix_length = (size_t)(out - sheet->prefix);
}

/* Steps to the next row: last axis fastest, model slowest. */
static void csv_step(csv *sheet)
{
    const dea_scene *scene = sheet->scene;
    size_t axis = scene->axis_count;
    while (axis > 0) {
        axis--;
        if (++sheet->index[axis] < scene->axes[axis].count) {
            if (axis + 1 < scene->axis_count) {
                csv_prefix(sheet);
            }
            return;
        }
        sheet->index[axis] = 0;
    }
    if (++sheet->model < scene->model_count) {
        csv_prefix(sheet);
    }
}

static void csv_row(csv *sheet, const dea_row *row)
{
    const dea_scene *scene = sheet->scene;
    csv_put(sheet, sheet->prefix, sheet->prefix_length);
    char *const start = sheet->buffer + sheet->used;
    char *out = start;
    if (scene->axis_count > 0) {
        const dea_axis *last = &scene->axes[scene->axis_count - 1];
        out += dea_number_write(out, last->values[sheet->index[scene->axis_count - 1]]);
        *out++ = ',';
    }
    for (size_t i = 0; i < DEA_ROW_COLUMNS; i++) {
        double value;
        memcpy(&value, (const char *)row + dea_row_columns[i].offset, sizeof value);
        out += dea_number_write(out, value);
        *out++ = ',';
    }
    sheet->used += (size_t)(out - start);
    const char *state = dea_state_name(row->state);
    csv_put(sheet, state, strlen(state));
    csv_put(sheet, "\n", 1);
}

static void csv_header(csv *sheet)
{
    const dea_scene *scene = sheet->scene;
    if (scene->model_count > 1) {
        csv_put(sheet, "model,", 6);
    }
    for (size_t i = 0; i < scene->axis_count; i++) {
        csv_put(sheet, scene->axes[i].column, strlen(scene->axes[i].column));
        csv_put(sheet, ",", 1);
    }
    for (size_t i = 0; i < DEA_ROW_COLUMNS; i++) {
        csv_put(sheet, dea_row_columns[i].name, strlen(dea_row_columns[i].name));
        csv_put(sheet, ",", 1);
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
    free(sheet->index);
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
        sheet->file = file;
        sheet->index = calloc(scene->axis_count + 1, sizeof *sheet->index);
        sheet->prefix = malloc(prefix_room(scene));
        sheet->buffer = malloc(CSV_BUFFER + prefix_room(scene) + CSV_TAIL);
    }
    if (!sheet || !sheet->index || !sheet->prefix || !sheet->buffer) {
        csv_close(sheet, false, NULL);
        return dea_fail(error, DEA_ERROR_MEMORY, "out of memory");
    }
    csv_header(sheet);
    csv_prefix(sheet);
    *state = sheet;
    return DEA_OK;
}

static dea_status csv_rows(void *state, size_t first, const dea_row *rows, size_t count, dea_error *error)
{
    (void)first;
    csv *sheet = state;
    for (size_t i = 0; i < count; i++) {
        csv_row(sheet, &rows[i]);
        csv_step(sheet);
        if (sheet->used >= CSV_BUFFER) {
            const dea_status status = csv_flush(sheet, error);
            if (status != DEA_OK) {
                return status;
            }
        }
    }
    return sheet->file->direct ? csv_flush(sheet, error) : DEA_OK; /* a reader at the other end sees rows as they come */
}

const dea_format dea_format_csv = {.name = "csv", .straight = true, .open = csv_open, .rows = csv_rows, .close = csv_close};
