/* Settings of the command line: key=value. */
#include <stdio.h>
#include <string.h>

#include "scene/reader.h"

/* A setting being parsed. */
typedef struct setting_reader {
    dea_reader *reader;
    dea_origin *origin;
    dea_place place;
    char *name;  /* before "=" */
    char *value; /* after it */
} setting_reader;

static char *trim(char *text)
{
    text += strspn(text, " \t\r\n");
    for (size_t length = strlen(text); length > 0 && strchr(" \t\r\n", text[length - 1]); length--) {
        text[length - 1] = '\0';
    }
    return text;
}

static dea_status setting_split(setting_reader *self, const char *text)
{
    dea_arena *arena = &self->reader->arena;
    char shown[DEA_TEXT_ROOM];
    char name[DEA_TEXT_ROOM + 8];
    int line = 0;
    int column = 0;
    snprintf(name, sizeof name, "--set %s", dea_text_clip(text, DEA_TEXT_SHOWN, shown, sizeof shown));
    self->origin = dea_arena_take(arena, sizeof *self->origin);
    char *copy = dea_arena_copy(arena, text, strlen(text));
    char *origin_name = dea_arena_copy(arena, name, strlen(name));
    if (!self->origin || !copy || !origin_name) {
        return dea_reader_memory(self->reader);
    }
    *self->origin = (dea_origin){.name = origin_name, .folder = self->reader->root->place.origin->folder, .setting = true};
    self->place = (dea_place){.origin = self->origin, .line = 1, .column = 1};
    if (!dea_tree_text_clean(text, strlen(text), &line, &column)) {
        return dea_place_fail(&self->place, self->reader->error, "setting", "a control character, or bytes that are not UTF-8");
    }
    char *equals = strchr(copy, '=');
    if (!equals || equals == copy) {
        return dea_place_fail(&self->place, self->reader->error, "setting",
                              "not of the form key=value, e.g. actuator.prestretch=1.3");
    }
    *equals = '\0';
    self->name = trim(copy);
    self->value = trim(equals + 1);
    return DEA_OK;
}

/* Lists, mappings and quoted texts are YAML; everything else is the plain text of a scalar. */
static dea_status value_parse(setting_reader *self, dea_node **node)
{
    dea_reader *reader = self->reader;
    if (self->value[0] != '\0' && strchr("[{\"'", self->value[0])) {
        return dea_tree_parse(self->value, strlen(self->value), self->origin, &reader->arena, node, reader->error);
    }
    *node = dea_tree_scalar(&reader->arena, self->origin, self->value);
    return *node ? DEA_OK : dea_reader_memory(reader);
}

/* The mapping below @p parent at @p key, made where there is none. `material: NAME` becomes `material: {base: NAME}`. */
static dea_node *mapping_enter(setting_reader *self, dea_node *parent, const char *key)
{
    dea_arena *arena = &self->reader->arena;
    dea_node *old = dea_tree_child(parent, key);
    const bool named = old && old->kind == DEA_NODE_SCALAR && parent == self->reader->root && strcmp(key, "material") == 0;
    if (old && !named) {
        return old;
    }
    dea_node *made = dea_tree_mapping(arena, old ? &old->place : &self->place);
    if (made) {
        made->key_at = old ? old->key_at : self->place;
        dea_tree_put(parent, key, made);
        if (named) {
            dea_tree_put(made, "base", old);
        }
    }
    return made;
}

/* Puts @p node at the dotted @p path of the tree. Where a file has no mapping on the way, reading the file will say so. */
static dea_status graft(setting_reader *self, const char *path, dea_node *node)
{
    dea_arena *arena = &self->reader->arena;
    char *key = dea_arena_copy(arena, path, strlen(path));
    dea_node *parent = self->reader->root;
    while (key && parent && parent->kind == DEA_NODE_MAPPING) {
        char *dot = strchr(key, '.');
        if (!dot) {
            dea_tree_put(parent, key, node);
            return DEA_OK;
        }
        *dot = '\0';
        parent = mapping_enter(self, parent, key);
        key = dot + 1;
    }
    return key && parent ? DEA_OK : dea_reader_memory(self->reader);
}

/* Puts an axis into study.sweep, in the place of the axis of the same key if there is one. */
static dea_status graft_axis(setting_reader *self, const dea_ref *ref, dea_node *node)
{
    dea_node *study = mapping_enter(self, self->reader->root, "study");
    dea_node *sweep = study && study->kind == DEA_NODE_MAPPING ? mapping_enter(self, study, "sweep") : study;
    const char *key = dea_arena_copy(&self->reader->arena, ref->path, strlen(ref->path));
    if (!sweep || !key) {
        return dea_reader_memory(self->reader);
    }
    for (const dea_node *axis = sweep->kind == DEA_NODE_MAPPING ? sweep->first : NULL; axis; axis = axis->next) {
        dea_ref other;
        if (dea_key_resolve(axis->key, &other) && strcmp(other.path, ref->path) == 0) {
            key = axis->key;
        }
    }
    if (sweep->kind == DEA_NODE_MAPPING) {
        dea_tree_put(sweep, key, node);
    }
    return DEA_OK;
}

static dea_status fail_key(setting_reader *self, const char *parent, const char *name)
{
    char shown[DEA_TEXT_ROOM];
    char help[DEA_KEY_ROOM];
    dea_key_suggest(parent, name, help);
    dea_text_clip(self->name, DEA_TEXT_SHOWN, shown, sizeof shown);
    return dea_place_fail(&self->place, self->reader->error, shown, "unknown key%s", help);
}

/* "actuator.covrage": parent "actuator" where the scene has one, and what comes after it. */
static dea_status fail_unknown(setting_reader *self)
{
    char parent[DEA_NAME_LENGTH] = "";
    const char *dot = strrchr(self->name, '.');
    dea_ref ref;
    if (dot && dot - self->name < DEA_NAME_LENGTH) {
        snprintf(parent, sizeof parent, "%.*s", (int)(dot - self->name), self->name);
    }
    if (parent[0] && !dea_key_find(parent, &ref)) {
        parent[0] = '\0';
    }
    return fail_key(self, parent, dot ? dot + 1 : self->name);
}

/* Name of the axis in "study.sweep.AXIS" or "sweep.AXIS", NULL for other keys. */
static const char *axis_name(const char *name)
{
    static const char *const fronts[] = {"study.sweep.", "sweep."};
    for (size_t i = 0; i < sizeof fronts / sizeof *fronts; i++) {
        if (strncmp(name, fronts[i], strlen(fronts[i])) == 0) {
            return name + strlen(fronts[i]);
        }
    }
    return NULL;
}

static dea_status setting_graft(dea_reader *reader, const char *text, dea_override **last)
{
    setting_reader self = {.reader = reader};
    dea_ref ref;
    dea_node *node = NULL;
    dea_status status = setting_split(&self, text);
    if (status) {
        return status;
    }
    const char *axis = axis_name(self.name);
    if (!dea_key_resolve(axis ? axis : self.name, &ref)) {
        return axis ? fail_key(&self, "study.sweep", axis) : fail_unknown(&self);
    }
    status = value_parse(&self, &node);
    if (status) {
        return status;
    }
    if (axis) {
        return graft_axis(&self, &ref, node);
    }
    if (ref.key->offset == DEA_KEY_NOWHERE) {
        return graft(&self, ref.path, node);
    }
    dea_override *override = dea_arena_take(&reader->arena, sizeof *override);
    if (!override) {
        return dea_reader_memory(reader);
    }
    *override = (dea_override){.ref = ref, .node = node};
    if (*last) {
        (*last)->next = override;
    } else {
        reader->overrides = override;
    }
    *last = override;
    return DEA_OK;
}

dea_status dea_settings_graft(dea_reader *reader, const dea_setting *settings, size_t count)
{
    dea_override *last = NULL;
    for (size_t i = 0; i < count; i++) {
        const dea_status status = setting_graft(reader, settings[i].text, &last);
        if (status) {
            return status;
        }
    }
    return DEA_OK;
}

dea_status dea_settings_apply(dea_reader *reader)
{
    for (const dea_override *override = reader->overrides; override; override = override->next) {
        const dea_ref *ref = &override->ref;
        if (strchr(ref->key->path, '#') && ref->index >= reader->scene->material.prony_count) {
            return dea_place_fail(&override->node->place, reader->error, ref->path,
                                  "the material has %zu branches, counted from 0", reader->scene->material.prony_count);
        }
        const dea_status status = ref->key->read(reader, ref, override->node);
        if (status) {
            return status;
        }
    }
    return DEA_OK;
}
