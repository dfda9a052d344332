#include "output/writer.h"

#include <stdlib.h>
#include <string.h>
#include <strings.h>

static const dea_format *const formats[] = {&dea_format_csv, &dea_format_netcdf, &dea_format_raw};

struct dea_writer {
    const dea_format *format;
    dea_atomic file;
    void *state;
    size_t next;  /* point that comes next */
    size_t total; /* points of the study, over all models */
};

static const dea_format *format_find(const char *name)
{
    for (size_t i = 0; i < sizeof formats / sizeof *formats; i++) {
        if (strcasecmp(formats[i]->name, name) == 0) {
            return formats[i];
        }
    }
    return NULL;
}

/* The wanted format, or the one of the ending, or csv where there is no ending to go by. */
static dea_status format_choose(const char *path, const char *wanted, const dea_format **format, dea_error *error)
{
    const char *slash = strrchr(path, '/');
    const char *name = slash ? slash + 1 : path;
    const char *dot = strrchr(name, '.');
    const bool device = strncmp(path, "/dev/", 5) == 0 || strcmp(path, "-") == 0;
    const char *ending = dot && dot > name && !device ? dot + 1 : "csv";
    *format = format_find(wanted ? wanted : ending);
    if (*format) {
        return DEA_OK;
    }
    if (wanted) {
        return dea_fail(error, DEA_ERROR_USAGE, "unknown format \"%.40s\"; accepted: csv, nc, raw", wanted);
    }
    return dea_fail(error, DEA_ERROR_USAGE,
                    "%.400s: the ending \".%.40s\" names no format; accepted: .csv, .nc, .raw, or give the format", path, ending);
}

static dea_status writer_start(dea_writer *writer, const dea_scene *scene, const char *engine, const char *path, dea_error *error)
{
    writer->total = dea_scene_point_count(scene) * scene->model_count;
    const dea_status status = dea_atomic_open(&writer->file, path, error);
    if (status != DEA_OK) {
        return status;
    }
    if (writer->file.direct && !writer->format->straight) {
        return dea_fail(error, DEA_ERROR_USAGE, "%s: format %s needs a regular file; use csv there", writer->file.target,
                        writer->format->name);
    }
    return writer->format->open(scene, engine, &writer->file, &writer->state, error);
}

dea_status dea_writer_open(const dea_scene *scene, const char *engine, const char *path, const char *format, dea_writer **writer,
                           dea_error *error)
{
    *writer = NULL;
    const dea_format *chosen;
    dea_status status = format_choose(path, format, &chosen, error);
    if (status != DEA_OK) {
        return status;
    }
    dea_writer *opened = calloc(1, sizeof *opened);
    if (!opened) {
        return dea_fail(error, DEA_ERROR_MEMORY, "out of memory");
    }
    opened->format = chosen;
    status = writer_start(opened, scene, engine, path, error);
    if (status != DEA_OK) {
        dea_writer_finish(opened, false, NULL);
        return status;
    }
    *writer = opened;
    return DEA_OK;
}

bool dea_writer_note(const dea_writer *writer, char text[DEA_NOTE_LENGTH])
{
    return writer->format->note && writer->format->note(writer->state, text);
}

dea_status dea_writer_points(dea_writer *writer, size_t first, const void *points, size_t count, dea_error *error)
{
    if (first != writer->next || count > writer->total - first) {
        return dea_fail(error, DEA_ERROR_USAGE, "points %zu to %zu came where point %zu of %zu was due", first, first + count,
                        writer->next, writer->total);
    }
    writer->next += count;
    return writer->format->points(writer->state, first, points, count, error);
}

dea_status dea_writer_finish(dea_writer *writer, bool keep, dea_error *error)
{
    if (!writer) {
        return DEA_OK;
    }
    dea_status status = DEA_OK;
    bool whole = keep;
    if (keep && writer->next != writer->total) {
        status = dea_fail(error, DEA_ERROR_USAGE, "%s: only %zu of %zu points were written", writer->file.target, writer->next,
                          writer->total);
        whole = false;
    }
    const dea_status ended = writer->format->close(writer->state, whole, error);
    whole = whole && ended == DEA_OK;
    const dea_status closed = dea_atomic_close(&writer->file, whole, error);
    free(writer);
    return status != DEA_OK ? status : ended != DEA_OK ? ended : closed;
}
