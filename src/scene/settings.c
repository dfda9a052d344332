/* Settings of the command line: key=value. */
#include <stdio.h>
#include <string.h>

#include "drive/wave.h"
#include "scene/reader.h"
#include "study/study.h"

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
        dea_origin *origin = dea_arena_take(&reader->arena, sizeof *origin);
        if (!origin) {
            return dea_reader_memory(reader);
        }
        *origin = *self->origin;
        origin->text = self->value; /* its places are worth a caret, that of a plain text is plain */
        origin->length = strlen(self->value);
        return dea_tree_parse(self->value, origin->length, origin, &reader->arena, node, reader->error);
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

/* The mapping at the dotted @p path, made where there is none; the one that stops short of it where something else is on the way.
 * NULL without memory. */
static dea_node *path_enter(setting_reader *self, const char *path)
{
    char *key = dea_arena_copy(&self->reader->arena, path, strlen(path));
    dea_node *node = key ? self->reader->root : NULL;
    while (node && key && node->kind == DEA_NODE_MAPPING) {
        char *dot = strchr(key, '.');
        if (dot) {
            *dot = '\0';
        }
        node = mapping_enter(self, node, key);
        key = dot ? dot + 1 : NULL;
    }
    return node;
}

/* Of @p count keys of which a scene gives one, a setting of one, @p path, takes those of the file away. */
static void group_settle(setting_reader *self, const char *const *group, size_t count, const char *path)
{
    bool member = false;
    for (size_t i = 0; i < count; i++) {
        member = member || strcmp(group[i], path) == 0;
    }
    for (size_t i = 0; member && i < count; i++) {
        const char *dot = strrchr(group[i], '.');
        const dea_node *node = dea_tree_find(self->reader->root, group[i]);
        if (node && strcmp(group[i], path) != 0 && !node->place.origin->setting) {
            char parent[DEA_NAME_LENGTH];
            snprintf(parent, sizeof parent, "%.*s", (int)(dot - group[i]), group[i]);
            dea_tree_remove(path_enter(self, parent), dot + 1);
        }
    }
}

/* Places of the axes of runs; how many there are. */
static size_t list_overs(const char *overs[DEA_STUDIES + 1])
{
    size_t count = 0;
    overs[count++] = "study.over";
    for (dea_study_kind kind = 0; kind < DEA_STUDIES; kind++) {
        if (dea_study_at(kind)->along) {
            overs[count++] = dea_study_at(kind)->axes;
        }
    }
    return count;
}

static void alternatives_remove(setting_reader *self, const char *path)
{
    const char *waves[DEA_WAVE_SINES + 1] = {"drive.waveform.file"};
    size_t count = 1;
    for (dea_wave_kind kind = DEA_WAVE_NONE + 1; dea_wave_of(kind); kind++) {
        waves[count++] = dea_wave_of(kind)->path;
    }
    const char *kinds[DEA_STUDIES], *overs[DEA_STUDIES + 1];
    for (dea_study_kind kind = 0; kind < DEA_STUDIES; kind++) {
        kinds[kind] = dea_study_at(kind)->path;
    }
    group_settle(self, waves, count, path);
    group_settle(self, kinds, DEA_STUDIES, path);
    group_settle(self, overs, list_overs(overs), path);
}

/* A setting of one law takes the constants of another in the file away. */
static void laws_remove(setting_reader *self, const char *path)
{
    const char *name = strrchr(path, '.');
    const bool skin = strncmp(path, "electrode.", 10) == 0;
    dea_node *material = name && dea_law_find(name + 1) ? path_enter(self, skin ? "electrode" : "material") : NULL;
    for (size_t i = 0; material && dea_law_at(i); i++) {
        const char *other = dea_law_at(i)->name;
        const dea_node *node = dea_tree_child(material, other);
        if (node && strcmp(other, name + 1) != 0 && !node->place.origin->setting) {
            dea_tree_remove(material, other);
        }
    }
}

/* Puts @p node at the place of a key that is no scalar. Where a file has no mapping on the way, reading the file will say so. */
static dea_status graft(setting_reader *self, const dea_ref *ref, dea_node *node)
{
    char parent[DEA_NAME_LENGTH];
    const char *dot = strrchr(ref->path, '.');
    snprintf(parent, sizeof parent, "%.*s", dot ? (int)(dot - ref->path) : 0, ref->path);
    if (strchr(ref->key.path, '#')) {
        return dea_place_fail(&self->place, self->reader->error, ref->path,
                              "cannot be set as a whole; accepted: all of %s, or its "
                              "scalars",
                              parent);
    }
    dea_node *holder = dot ? path_enter(self, parent) : self->reader->root;
    const char *key = dea_arena_copy(&self->reader->arena, dot ? dot + 1 : ref->path, strlen(dot ? dot + 1 : ref->path));
    if (!holder || !key) {
        return dea_reader_memory(self->reader);
    }
    if (holder->kind == DEA_NODE_MAPPING) {
        dea_tree_put(holder, key, node);
        alternatives_remove(self, ref->path);
        laws_remove(self, ref->path);
    }
    return DEA_OK;
}

/* Where the axes of `over` stand: where the scene has them, else where the setting says. */
static const char *axes_path(const setting_reader *self, const char *said)
{
    const char *overs[DEA_STUDIES + 1];
    const size_t count = list_overs(overs);
    bool member = false;
    for (size_t i = 0; i < count; i++) {
        member = member || strcmp(said, overs[i]) == 0;
    }
    for (size_t i = 0; member && i < count; i++) {
        if (dea_tree_find(self->reader->root, overs[i])) {
            return overs[i];
        }
    }
    return said;
}

/* Puts an axis among those of the scene, in the place of the axis of the same key if there is one. */
static dea_status graft_axis(setting_reader *self, const char *said, const dea_ref *ref, dea_node *node)
{
    dea_node *axes = path_enter(self, axes_path(self, said));
    const char *key = dea_arena_copy(&self->reader->arena, ref->path, strlen(ref->path));
    if (!axes || !key) {
        return dea_reader_memory(self->reader);
    }
    for (const dea_node *axis = axes->kind == DEA_NODE_MAPPING ? axes->first : NULL; axis; axis = axis->next) {
        dea_ref other;
        if (dea_key_resolve(axis->key, self->reader->root, &other) && strcmp(other.path, ref->path) == 0) {
            key = axis->key;
        }
    }
    if (axes->kind == DEA_NODE_MAPPING) {
        dea_tree_put(axes, key, node);
    }
    return DEA_OK;
}

/* Fails because no key has the name, or several have. @p parent: the mapping that it stands in; NULL: it may be short. */
static dea_status fail_key(setting_reader *self, const char *parent, const char *name)
{
    char shown[DEA_TEXT_ROOM];
    char help[DEA_KEY_ROOM];
    dea_text_clip(self->name, DEA_TEXT_SHOWN, shown, sizeof shown);
    if (!parent && dea_key_ambiguous(name, help)) {
        return dea_place_fail(&self->place, self->reader->error, shown, "could mean several keys; accepted: one of %s", help);
    }
    if (parent) {
        dea_key_suggest(parent, name, help);
    } else {
        dea_key_suggest_short(name, self->reader->root, "keys of the scene, e.g. actuator.prestretch, or short prestretch", help);
    }
    return dea_place_fail(&self->place, self->reader->error, shown, "unknown key%s", help);
}

/* "actuator.covrage": a slip of a key of actuator, where that is one. */
static dea_status fail_unknown(setting_reader *self)
{
    char parent[DEA_NAME_LENGTH] = "";
    const char *dot = strrchr(self->name, '.');
    dea_ref ref;
    if (dot && dot - self->name < DEA_NAME_LENGTH) {
        snprintf(parent, sizeof parent, "%.*s", (int)(dot - self->name), self->name);
    }
    const bool found = parent[0] && dea_key_find(parent, &ref);
    return fail_key(self, found ? parent : NULL, found ? dot + 1 : self->name);
}

/* Name of the axis in "study.sweep.AXIS", "sweep.AXIS", "over.AXIS" and so on, and the mapping it stands in; NULL for other keys.
 */
static const char *axis_name(const char *name, const char **path)
{
    const size_t front = strlen("study.");
    for (int kind = -1; kind < DEA_STUDIES; kind++) {
        *path = kind < 0 ? "study.over" : dea_study_at((dea_study_kind)kind)->axes;
        const char *start = strncmp(name, "study.", front) == 0 ? *path : *path + front;
        const size_t length = strlen(start);
        if (strncmp(name, start, length) == 0 && name[length] == '.') {
            return name + length + 1;
        }
    }
    return NULL;
}

static dea_status override_add(dea_reader *reader, const dea_ref *ref, dea_node *node)
{
    dea_override **last = &reader->overrides;
    while (*last) {
        last = &(*last)->next;
    }
    *last = dea_arena_take(&reader->arena, sizeof **last);
    if (!*last) {
        return dea_reader_memory(reader);
    }
    **last = (dea_override){.ref = *ref, .node = node};
    return DEA_OK;
}

/* Parses a setting and puts it where it belongs; one that is no structure waits for the @p last round. */
static dea_status setting_graft(dea_reader *reader, const char *text, bool last, bool *done)
{
    setting_reader self = {.reader = reader};
    dea_ref ref;
    dea_node *node = NULL;
    const char *path = NULL;
    dea_status status = setting_split(&self, text);
    if (status) {
        return status;
    }
    const char *axis = axis_name(self.name, &path);
    const bool found = dea_key_resolve(axis ? axis : self.name, reader->root, &ref);
    const bool structure = found && (axis || ref.key.offset == DEA_KEY_NOWHERE);
    if (!structure && !last) {
        return DEA_OK;
    }
    *done = true;
    if (!found) {
        return axis ? fail_key(&self, NULL, axis) : fail_unknown(&self);
    }
    status = value_parse(&self, &node);
    if (status) {
        return status;
    }
    return axis ? graft_axis(&self, path, &ref, node) : structure ? graft(&self, &ref, node) : override_add(reader, &ref, node);
}

/* Two rounds, first of structures: which scalar a short name means depends on the rest of the scene. */
dea_status dea_settings_graft(dea_reader *reader, const dea_setting *settings, size_t count)
{
    bool *done = dea_arena_take(&reader->arena, count + 1);
    dea_status status = done ? DEA_OK : dea_reader_memory(reader);
    for (size_t i = 0; i < 2 * count && !status; i++) {
        const size_t at = i % count;
        status = done[at] ? DEA_OK : setting_graft(reader, settings[at].text, i >= count, &done[at]);
    }
    return status;
}

/* A scalar of a part is set where the scene has that part. */
static dea_status part_check(dea_reader *reader, const dea_override *override)
{
    const dea_ref *ref = &override->ref;
    dea_ref part;
    const dea_status status = dea_reader_index(reader, ref, &override->node->place);
    const char *within = ref->key.within;
    if (status || !within || dea_tree_find(reader->root, within) || !dea_key_find(within, &part)) {
        return status;
    }
    return dea_place_fail(&override->node->place, reader->error, ref->path, "the scene has no %s; accepted for that: %s", within,
                          part.key.accepted);
}

dea_status dea_settings_apply(dea_reader *reader)
{
    for (const dea_override *override = reader->overrides; override; override = override->next) {
        dea_status status = part_check(reader, override);
        status = status ? status : override->ref.key.read(reader, &override->ref, override->node);
        if (status) {
            return status;
        }
    }
    return DEA_OK;
}
