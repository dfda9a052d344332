/* The reading of a scene, step by step. */
#define _GNU_SOURCE
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "deaspice/model.h"
#include "deaspice/scene.h"
#include "drive/wave.h"
#include "support/file.h"
#include "scene/reader.h"

static dea_status scene_clear(dea_scene *scene)
{
    *scene = (dea_scene){
        .title = calloc(1, 1),
        .actuator = {.frame_radius = NAN,
                     .coverage = NAN,
                     .divide_radius = NAN,
                     .film_thickness = NAN,
                     .layers = 1.0,
                     .prestretch = NAN,
                     .electrode_mass = NAN,
                     .focal_length = NAN,
                     .refractive_index = NAN},
        .electrode = {.thickness = NAN, .density = NAN, .sheet_resistance = NAN},
        .antagonist = {.frame_radius = NAN, .coverage = NAN, .film_thickness = NAN, .layers = NAN, .prestretch = NAN, .voltage = 0.0},
        .material = dea_material_default(),
        .drive = {.voltage = NAN,
                  .waveform = dea_waveform_none(),
                  .series_resistance = NAN,
                  .leakage_resistance = NAN,
                  .current_limit = NAN},
        .transient = {.until = NAN, .every = NAN, .first = NAN},
        .ac = {.from = NAN, .to = NAN, .points_per_decade = 50, .bias = NAN},
        .modes = {.bias = NAN},
        .force = {.from = NAN, .to = NAN, .points = 61},
        .profile = {.points = 101},
        .model_error = 0.01,
        .accuracy = 1e-6,
        .files = scene->files,
    };
    dea_scene_unload(scene);
    return scene->title ? DEA_OK : DEA_ERROR_MEMORY;
}

/* The kind decides which keys there are, so it is read before its neighbours. */
static dea_status kind_read(dea_reader *reader)
{
    dea_ref ref;
    const dea_node *kind = dea_tree_child(dea_tree_child(reader->root, "actuator"), "kind");
    return kind && dea_key_find("actuator.kind", &ref) ? dea_read_kind(reader, &ref, kind) : DEA_OK;
}

/* `--model a,b` stands in the place of the scene's model, `--engine a,b` in that of its engine. */
static dea_status list_override(dea_reader *reader, const char *path, const char *names, const char *option, dea_origin *origin)
{
    dea_ref ref;
    if (!names || !dea_key_find(path, &ref)) {
        return DEA_OK;
    }
    *origin = (dea_origin){.name = option, .setting = true};
    const dea_place place = {.origin = origin, .line = 1, .column = 1};
    dea_node list = {.kind = DEA_NODE_SEQUENCE, .place = place, .key_at = place};
    for (const char *name = names; name; name = strchr(name, ',') ? strchr(name, ',') + 1 : NULL) {
        name += strspn(name, " ");
        const char *text = dea_arena_copy(&reader->arena, name, strcspn(name, ","));
        dea_node *node = text ? dea_tree_scalar(&reader->arena, origin, text) : NULL;
        if (!node) {
            return dea_reader_memory(reader);
        }
        *(list.last ? &list.last->next : &list.first) = node;
        list.last = node;
        list.count++;
    }
    return ref.key.read(reader, &ref, &list);
}

static dea_status reader_run(dea_reader *reader, const char *text, size_t length, const dea_origin *origin,
                             const dea_setting *settings, size_t count)
{
    dea_status status = dea_tree_parse(text, length, origin, &reader->arena, &reader->root, reader->error);
    if (status) {
        return status;
    }
    if (reader->root->kind != DEA_NODE_MAPPING) {
        return dea_place_fail(&reader->root->place, reader->error, "scene",
                              "not a mapping; accepted: keys such as actuator, material, drive");
    }
    status = dea_settings_graft(reader, settings, count);
    status = status ? status : kind_read(reader);
    status = status ? status : dea_reader_children(reader, "", reader->root);
    status = status ? status : dea_settings_apply(reader);
    status = status ? status : list_override(reader, "model", reader->model, "--model", &reader->model_origin);
    status = status ? status : list_override(reader, "engine", reader->engine, "--engine", &reader->engine_origin);
    status = status ? status : dea_reader_study(reader);
    return status ? status : dea_reader_finish(reader);
}

/* What one reading holds. */
typedef struct session {
    dea_reader *reader;
    dea_units *units;
} session;

/* Begins a reading of a scene, which it clears; the caller ends it also after a failure. */
static dea_status session_begin(session *s, dea_scene *scene, const char *what, dea_error *error)
{
    *s = (session){calloc(1, sizeof *s->reader), dea_units_open()};
    if (scene_clear(scene) != DEA_OK || !s->reader || !s->units) {
        return dea_fail(error, DEA_ERROR_MEMORY, "out of memory while reading the %s", what);
    }
    s->reader->scene = scene;
    s->reader->error = error;
    s->reader->units = s->units;
    return DEA_OK;
}

static void session_end(session *s)
{
    if (s->reader) {
        dea_arena_free(&s->reader->arena);
    }
    free(s->reader);
    dea_units_close(s->units);
}

static dea_status scene_parse(const char *text, size_t length, const char *name, const char *folder, const dea_reading *how,
                              dea_scene *scene, dea_error *error)
{
    char shown[10 * 256 + 8];
    const dea_origin origin = {
        .name = dea_text_clip(name, 256, shown, sizeof shown), .folder = folder, .text = text, .length = length};
    session s;
    dea_status status = session_begin(&s, scene, "scene", error);
    if (status == DEA_OK) {
        s.reader->model = how->model;
        s.reader->engine = how->engine;
        s.reader->no_files = how->no_files;
        status = reader_run(s.reader, text, length, &origin, how->settings, how->setting_count);
    }
    session_end(&s);
    if (status) {
        dea_scene_free(scene);
    }
    return status;
}

dea_status dea_scene_parse(const char *text, size_t length, const char *name, const char *folder, const dea_setting *settings,
                           size_t setting_count, const char *model, dea_scene *scene, dea_error *error)
{
    const dea_reading how = {.settings = settings, .setting_count = setting_count, .model = model};
    *scene = (dea_scene){0};
    return scene_parse(text, length, name, folder, &how, scene, error);
}

/* Bytes of the scene's file, and the folder that it lies in; both malloc'd. */
static dea_status scene_load(const char *path, dea_files *files, char **text, size_t *length, char **folder, dea_error *error)
{
    char shown[10 * 256 + 8];
    const bool input = strcmp(path, "-") == 0;
    const char *slash = input ? NULL : strrchr(path, '/');
    const char *refused = NULL;
    const dea_status read = dea_file_read(path, true, DEA_FILE_MAX, text, length, files, &refused);
    if (read) {
        return dea_fail(error, read, "%s: cannot read the scene: %s",
                        input ? "standard input" : dea_text_clip(path, 256, shown, sizeof shown), refused);
    }
    *folder = slash ? strndup(path, slash == path ? 1 : (size_t)(slash - path)) : strdup(".");
    return *folder ? DEA_OK : dea_fail(error, DEA_ERROR_MEMORY, "out of memory while reading the scene");
}

dea_status dea_scene_read_as(const char *path, const dea_reading *how, dea_scene *scene, dea_error *error)
{
    char *text = NULL, *folder = NULL;
    size_t length = 0;
    *scene = (dea_scene){.files = calloc(1, sizeof *scene->files)};
    if (!scene->files) {
        return dea_fail(error, DEA_ERROR_MEMORY, "out of memory while reading the scene");
    }
    dea_status status = scene_load(path, scene->files, &text, &length, &folder, error);
    if (status) {
        dea_scene_free(scene);
    } else {
        const bool input = strcmp(path, "-") == 0;
        status = scene_parse(text, length, input ? "standard input" : path, folder, how, scene, error);
    }
    free(folder);
    free(text);
    return status;
}

dea_status dea_scene_read(const char *path, const dea_setting *settings, size_t setting_count, const char *model,
                          dea_scene *scene, dea_error *error)
{
    const dea_reading how = {.settings = settings, .setting_count = setting_count, .model = model};
    return dea_scene_read_as(path, &how, scene, error);
}

static dea_status material_run(dea_reader *reader, const char *path, const dea_origin *origin)
{
    dea_ref ref;
    const dea_place place = {.origin = origin, .line = 1, .column = 1};
    reader->root = dea_tree_mapping(&reader->arena, &place);
    dea_node *name = dea_tree_scalar(&reader->arena, origin, path);
    if (!reader->root || !name || !dea_key_find("material", &ref)) {
        return dea_reader_memory(reader);
    }
    dea_tree_put(reader->root, "material", name);
    const dea_status status = dea_read_material(reader, &ref, name);
    return status ? status : dea_material_finish(reader);
}

dea_status dea_material_read(const char *path, dea_material *material, dea_error *error)
{
    char shown[10 * 256 + 8];
    char *named = NULL;
    dea_files files = {0};
    dea_scene scene = {.files = &files};
    const dea_origin origin = {.name = dea_text_clip(path, 256, shown, sizeof shown), .folder = "", .setting = true};
    session s;
    dea_status status = session_begin(&s, &scene, "material", error);
    if (status == DEA_OK && asprintf(&named, "%s%s", strchr(path, '/') ? "" : "./", path) < 0) {
        named = NULL;
        status = dea_reader_memory(s.reader);
    }
    if (status == DEA_OK) {
        status = material_run(s.reader, named, &origin);
        *material = scene.material;
    }
    session_end(&s);
    free(named);
    free(scene.title);
    dea_files_free(&files);
    return status;
}

void dea_scene_free(dea_scene *scene)
{
    if (scene) {
        for (size_t i = 0; i < scene->axis_count; i++) {
            free(scene->axes[i].values);
        }
        free(scene->axes);
        free(scene->drive.waveform.times);
        free(scene->drive.waveform.voltages);
        free(scene->title);
        if (scene->files) {
            dea_files_free(scene->files);
            free(scene->files);
        }
        *scene = (dea_scene){0};
    }
}

size_t dea_scene_point_count(const dea_scene *scene)
{
    size_t count = 1;
    for (size_t i = 0; i < scene->axis_count; i++) {
        count *= scene->axes[i].count;
    }
    return count;
}
