/* Reading of keys that need no more than their own value. */
#include <math.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "deaspice/model.h"
#include "deaspice/needs.h"
#include "scene/reader.h"
#include "study/study.h"

char *dea_reader_show(const dea_node *node, char out[DEA_TEXT_ROOM])
{
    if (node->kind == DEA_NODE_SCALAR) {
        return dea_text_clip(node->text, DEA_TEXT_SHOWN, out, DEA_TEXT_ROOM);
    }
    snprintf(out, DEA_TEXT_ROOM, "%s", node->kind == DEA_NODE_MAPPING ? "a mapping" : "a list");
    return out;
}

dea_status dea_reader_refuse(dea_reader *reader, const dea_ref *ref, const dea_node *node, const char *what)
{
    char shown[DEA_TEXT_ROOM];
    dea_reader_show(node, shown);
    return dea_place_fail(&node->place, reader->error, ref->path, "%s%s%s%s; accepted: %s", what, shown[0] ? " (" : "", shown,
                          shown[0] ? ")" : "", ref->key.accepted);
}

void dea_reader_names(const dea_node *node, dea_names *name, char names[DEA_KEY_ROOM], char meant[DEA_KEY_ROOM])
{
    size_t least = SIZE_MAX;
    names[0] = meant[0] = '\0';
    for (size_t i = 0, used = 0; name(i) && used < DEA_KEY_ROOM; i++) {
        const size_t distance = node->kind == DEA_NODE_SCALAR ? dea_text_distance(name(i), node->text) : 0;
        used += (size_t)snprintf(names + used, DEA_KEY_ROOM - used, "%s, ", name(i));
        if (distance > 0 && distance < least && dea_text_likely(name(i), distance)) {
            least = distance;
            snprintf(meant, DEA_KEY_ROOM, "did you mean %s? ", name(i));
        }
    }
}

dea_status dea_reader_memory(dea_reader *reader)
{
    return dea_fail(reader->error, DEA_ERROR_MEMORY, "out of memory while reading the scene");
}

dea_given *dea_reader_given(dea_reader *reader, size_t offset)
{
    return &reader->given[offset / sizeof(double)];
}

dea_status dea_reader_missing(dea_reader *reader, const char *parent, const char *path)
{
    dea_ref ref;
    const dea_node *holder = dea_tree_find(reader->root, parent);
    const dea_place *place = holder ? &holder->place : &reader->root->place;
    return dea_place_fail(place, reader->error, path, "missing; accepted: %s", dea_key_find(path, &ref) ? ref.key.accepted : "");
}

const dea_place *dea_reader_place(dea_reader *reader, size_t offset, const char *parent)
{
    const dea_given *given = dea_reader_given(reader, offset);
    const dea_node *holder = dea_tree_find(reader->root, parent);
    return given->node ? &given->node->place : holder ? &holder->place : &reader->root->place;
}

dea_status dea_reader_index(dea_reader *reader, const dea_ref *ref, const dea_place *place)
{
    const dea_holder holder = dea_reader_holder(reader, &ref->key);
    const dea_law *law = *holder.law;
    if (ref->key.law && ref->key.law != law) {
        return dea_place_fail(place, reader->error, ref->path,
                              "belongs to the law %s, but that of the %s is %s; accepted: constants of %s.%s, or all of %s.%s as %s",
                              ref->key.law->name, holder.name, law ? law->name : "not given", holder.name,
                              law ? law->name : ref->key.law->name, holder.name, ref->key.law->name, ref->key.law->accepted);
    }
    const bool window = strncmp(ref->path, "study.transient.average.", 24) == 0;
    const bool listed = strchr(ref->key.path, '#') != NULL;
    const bool sine = strncmp(ref->path, "drive.waveform.sines.", 21) == 0;
    const dea_material *material = &reader->scene->material;
    const size_t count = sine             ? reader->scene->drive.waveform.sine_count
                         : window         ? reader->scene->transient.average_count
                         : ref->key.law ? *holder.entry_count
                                        : material->prony_count;
    if (window && !listed && count > 1) {
        return dea_place_fail(place, reader->error, ref->path,
                              "the transient has %zu windows; name one of them, e.g. study.transient.average.0.from", count);
    }
    if (!listed || ref->index < count) {
        return DEA_OK;
    }
    return dea_place_fail(place, reader->error, ref->path, "the %s has %zu %s, counted from 0",
                          sine ? "waveform" : window ? "transient" : holder.name, count, sine ? "sines" : window ? "windows" : ref->key.law ? "terms" : "branches");
}

static dea_status fail_unknown(dea_reader *reader, const char *path, const dea_node *node)
{
    char subject[DEA_TEXT_ROOM];
    char shown[DEA_TEXT_ROOM];
    char help[DEA_KEY_ROOM];
    dea_text_clip(node->key, DEA_TEXT_SHOWN, shown, sizeof shown);
    snprintf(subject, sizeof subject, "%s%s%.*s", path, path[0] ? "." : "", (int)(sizeof subject - DEA_NAME_LENGTH - 2), shown);
    dea_key_suggest(path, node->key, help);
    return dea_place_fail(&node->key_at, reader->error, subject, "unknown key%s", help);
}

dea_status dea_reader_children(dea_reader *reader, const char *path, const dea_node *node)
{
    for (const dea_node *child = node->first; child; child = child->next) {
        char whole[DEA_NAME_LENGTH];
        dea_ref ref;
        const int length = snprintf(whole, sizeof whole, "%s%s%s", path, path[0] ? "." : "", child->key);
        if (length < 0 || (size_t)length >= sizeof whole || strpbrk(child->key, ".#") || !dea_key_find(whole, &ref)) {
            return fail_unknown(reader, path, child);
        }
        const dea_status status = ref.key.read(reader, &ref, child);
        if (status) {
            return status;
        }
    }
    return DEA_OK;
}

dea_status dea_read_mapping(dea_reader *reader, const dea_ref *ref, const dea_node *node)
{
    if (node->kind != DEA_NODE_MAPPING) {
        return dea_reader_refuse(reader, ref, node, "not a mapping");
    }
    return dea_reader_children(reader, ref->path, node);
}

static dea_status kind_check(dea_reader *reader, const dea_ref *ref, const dea_node *node)
{
    const bool lens = reader->scene->actuator.kind == DEA_LENS;
    if (!reader->kind_known || ref->key.kinds & (lens ? DEA_KEY_LENS : DEA_KEY_DOT)) {
        return DEA_OK;
    }
    const bool divide = dea_ref_offset(ref) == offsetof(dea_scene, actuator.divide_radius);
    const char *instead = !divide ? ""
                          : lens  ? "; accepted: lens_radius or coverage"
                                  : "; accepted: electrode_radius or coverage";
    return dea_place_fail(&node->key_at, reader->error, ref->path, "belongs to a %s, but the actuator is a %s%s",
                          lens ? "dot" : "lens", lens ? "lens" : "dot", instead);
}

static bool in_range(const dea_key *key, double value)
{
    const bool inside = key->open ? value > key->low && value < key->high : value >= key->low && value <= key->high;
    return inside && !(key->whole && floor(value) != value);
}

dea_status dea_reader_number(dea_reader *reader, const dea_ref *ref, const dea_node *node, double *value)
{
    char reason[DEA_REASON_LENGTH];
    const dea_status status = kind_check(reader, ref, node);
    if (status) {
        return status;
    }
    if (node->kind != DEA_NODE_SCALAR) {
        const bool axis = ref->key.words > 0 && (node->kind == DEA_NODE_SEQUENCE || dea_tree_child(node, "from"));
        return dea_reader_refuse(reader, ref, node, axis ? "several values are an axis of study.sweep" : "not a number");
    }
    if (!dea_quantity_read(reader->units, node->text, ref->key.unit, value, reason)) {
        return dea_reader_refuse(reader, ref, node, reason);
    }
    return in_range(&ref->key, *value) ? DEA_OK : dea_reader_refuse(reader, ref, node, "out of range");
}

static dea_status fail_both(dea_reader *reader, const dea_ref *ref, const dea_node *node, const dea_given *other)
{
    if (other->node->place.origin->setting && !node->place.origin->setting) {
        return dea_place_fail(&other->node->place, reader->error, other->ref.path,
                              "contradicts %s, which the scene sweeps; set %s too", ref->path, reader->axes);
    }
    return dea_place_fail(&node->key_at, reader->error, ref->path, "contradicts %s, which is %s too; give one of them",
                          other->ref.path, other->swept ? "swept" : "given");
}

/* Coverage and the dividing radius say the same: a setting replaces the one of the file, else both together are an error. */
static dea_status partner_settle(dea_reader *reader, const dea_ref *ref, const dea_node *node)
{
    const size_t coverage = offsetof(dea_scene, actuator.coverage);
    const size_t divide = offsetof(dea_scene, actuator.divide_radius);
    const size_t own = dea_ref_offset(ref);
    if (own != coverage && own != divide) {
        return DEA_OK;
    }
    dea_given *other = dea_reader_given(reader, own == coverage ? divide : coverage);
    if (!other->node) {
        return DEA_OK;
    }
    if (other->swept || !node->place.origin->setting || other->node->place.origin->setting) {
        return fail_both(reader, ref, node, other);
    }
    other->node = NULL;
    *(own == coverage ? &reader->scene->actuator.divide_radius : &reader->scene->actuator.coverage) = NAN;
    return DEA_OK;
}

dea_status dea_reader_claim(dea_reader *reader, const dea_ref *ref, const dea_node *node, bool swept)
{
    const dea_status status = partner_settle(reader, ref, node);
    if (!status) {
        *dea_reader_given(reader, dea_ref_offset(ref)) = (dea_given){.node = node, .ref = *ref, .swept = swept};
    }
    return status;
}

dea_status dea_read_scalar(dea_reader *reader, const dea_ref *ref, const dea_node *node)
{
    double value = NAN;
    dea_status status = dea_reader_number(reader, ref, node, &value);
    status = status ? status : dea_reader_claim(reader, ref, node, false);
    if (!status) {
        memcpy((char *)reader->scene + dea_ref_offset(ref), &value, sizeof value);
    }
    return status;
}

dea_status dea_reader_word(dea_reader *reader, const dea_ref *ref, const dea_node *node, const char *const *words, size_t *index)
{
    char what[DEA_WORD_ROOM] = "unknown";
    if (node->kind != DEA_NODE_SCALAR) {
        return dea_reader_refuse(reader, ref, node, "not a word");
    }
    for (size_t i = 0; words[i]; i++) {
        const size_t distance = dea_text_distance(node->text, words[i]);
        if (strcmp(node->text, words[i]) == 0) {
            *index = i;
            return DEA_OK;
        }
        if (node->text[0] && dea_text_likely(words[i], distance)) {
            snprintf(what, sizeof what, "unknown, did you mean %s?", words[i]);
        }
    }
    return dea_reader_refuse(reader, ref, node, node->text[0] ? what : "has no value");
}

dea_status dea_read_count(dea_reader *reader, const dea_ref *ref, const dea_node *node)
{
    size_t *count = (size_t *)(void *)((char *)reader->scene + ref->key.place);
    const bool read = node->kind == DEA_NODE_SCALAR && dea_count_read(node->text, (size_t)ref->key.high, count);
    return read && *count >= (size_t)ref->key.low ? DEA_OK : dea_reader_refuse(reader, ref, node, "out of range");
}

dea_status dea_read_choice(dea_reader *reader, const dea_ref *ref, const dea_node *node)
{
    size_t index = 0;
    const dea_status status = dea_reader_word(reader, ref, node, ref->key.choice, &index);
    *((bool *)reader->scene + ref->key.place) = !status && index == 1;
    return status;
}

dea_status dea_reader_kind(dea_reader *reader, const dea_ref *ref, const dea_node *node, dea_kind *kind)
{
    static const char *const words[] = {"dot", "lens", NULL};
    size_t index = 0;
    const dea_status status = dea_reader_word(reader, ref, node, words, &index);
    *kind = index == 0 ? DEA_DOT : DEA_LENS;
    return status;
}

dea_status dea_read_kind(dea_reader *reader, const dea_ref *ref, const dea_node *node)
{
    const dea_status status = dea_reader_kind(reader, ref, node, &reader->scene->actuator.kind);
    reader->kind_known = reader->kind_known || !status;
    return status;
}

dea_status dea_read_title(dea_reader *reader, const dea_ref *ref, const dea_node *node)
{
    if (node->kind != DEA_NODE_SCALAR) {
        return dea_reader_refuse(reader, ref, node, "not a text");
    }
    size_t length = strlen(node->text);
    length -= length > 0 && node->text[length - 1] == '\n';
    if (length > 1000 || strcspn(node->text, "\n\r\t") < length) {
        return dea_reader_refuse(reader, ref, node, length > 1000 ? "too long" : "more than one line");
    }
    char *title = strndup(node->text, length);
    if (!title) {
        return dea_reader_memory(reader);
    }
    free(reader->scene->title);
    reader->scene->title = title;
    return DEA_OK;
}

dea_status dea_read_later(dea_reader *reader, const dea_ref *ref, const dea_node *node)
{
    (void)ref;
    (void)node;
    (void)reader;
    return DEA_OK;
}

static const char automatic[] = "auto"; /* the name of no model: the cheapest that is good enough */

/* What a model must be able to do. */
typedef struct ability {
    bool lens, edge;
    const dea_study *study; /* NULL: any */
} ability;

static void model_list(ability wanted, char *out, size_t room)
{
    size_t used = 0;
    out[0] = '\0';
    for (size_t i = 0; i < dea_model_count() && used < room; i++) {
        const dea_model *model = dea_model_at(i);
        if ((!wanted.lens || model->lens) && (!wanted.study || dea_study_takes(wanted.study, model)) &&
            (!wanted.edge || model->edge)) {
            used += (size_t)snprintf(out + used, room - used, "%s, ", model->name);
        }
    }
    snprintf(out + used, used < room ? room - used : 0, "%s", automatic);
}

/* Several models in one text, as the list that they should be: "[lumped, field]", of an option "lumped,field"; "" for one. */
static void model_split(const dea_node *node, char out[DEA_KEY_ROOM])
{
    static const char between[] = " ,;+/&\t";
    const bool option = node->place.origin->setting;
    const char *text = node->text + strspn(node->text, between);
    size_t used = 0;
    size_t count = 0;
    for (; *text && used + DEA_NAME_LENGTH < DEA_KEY_ROOM; count++) {
        const size_t length = strcspn(text, between);
        const char *joint = count == 0 ? "" : option ? "," : ", ";
        used += (size_t)snprintf(out + used, DEA_KEY_ROOM - used, "%s%.*s", joint,
                                 (int)(length < DEA_NAME_LENGTH / 2 ? length : DEA_NAME_LENGTH / 2), text);
        text += length;
        text += strspn(text, between);
    }
    out[count > 1 ? used : 0] = '\0';
}

static const char *model_name(size_t index)
{
    return index < dea_model_count() ? dea_model_at(index)->name : NULL;
}

static dea_status model_fail(dea_reader *reader, const dea_node *node, const char *what, ability wanted)
{
    char shown[DEA_TEXT_ROOM];
    char names[DEA_KEY_ROOM];
    char meant[DEA_KEY_ROOM] = "";
    const bool any = !wanted.lens && !wanted.study && !wanted.edge;
    if (any) {
        dea_reader_names(node, model_name, names, meant);
    }
    model_list(wanted, names, sizeof names);
    if (node->kind == DEA_NODE_SCALAR && any && !meant[0]) {
        char several[DEA_KEY_ROOM];
        model_split(node, several);
        if (several[0]) {
            const bool option = node->place.origin->setting;
            snprintf(meant, sizeof meant, "several are written %s%.400s%s; ", option ? "" : "[", several, option ? "" : "]");
        }
    }
    return dea_place_fail(&node->place, reader->error, "model", "%s (%s); %saccepted: %s", what, dea_reader_show(node, shown),
                          meant, names);
}

dea_status dea_models_finish(dea_reader *reader)
{
    dea_scene *scene = reader->scene;
    const dea_study *study = dea_study_of(scene);
    if (scene->automatic) {
        scene->models[0] = dea_needs_truth(scene->study);
    }
    const bool loaded = dea_tree_child(reader->root, "load") || scene->antagonist.there;
    for (size_t i = 0; i < scene->model_count && loaded; i++) {
        if (!scene->models[i]->edge) {
            return model_fail(reader, reader->model_names[i],
                              scene->antagonist.there ? "has no edge that a second film acts on" : "has no edge that a load acts on",
                              (ability){.lens = scene->actuator.kind == DEA_LENS, .study = study, .edge = true});
        }
    }
    for (size_t i = 0; i < scene->model_count; i++) {
        if (!dea_study_takes(study, scene->models[i])) {
            return model_fail(reader, reader->model_names[i], study->model_fails,
                              (ability){.lens = scene->actuator.kind == DEA_LENS, .study = study});
        }
    }
    return DEA_OK;
}

/* `auto` alone: the finest model stands in until one is chosen, once the study is known. */
static dea_status model_auto(dea_reader *reader, const dea_node *node)
{
    reader->model_names[0] = node;
    reader->scene->automatic = true;
    reader->scene->models[0] = dea_needs_truth(reader->scene->study);
    reader->scene->model_count = 1;
    return DEA_OK;
}

static dea_status model_add(dea_reader *reader, const dea_node *node)
{
    dea_scene *scene = reader->scene;
    if (scene->automatic || (node->kind == DEA_NODE_SCALAR && strcmp(node->text, automatic) == 0)) {
        return scene->model_count == 0 ? model_auto(reader, node) : model_fail(reader, node, "auto stands alone", (ability){0});
    }
    const dea_model *model = node->kind == DEA_NODE_SCALAR ? dea_model_find(node->text) : NULL;
    if (!model) {
        return model_fail(reader, node, "unknown model", (ability){0});
    }
    for (size_t i = 0; i < scene->model_count; i++) {
        if (scene->models[i] == model) {
            return model_fail(reader, node, "named twice", (ability){0});
        }
    }
    if (scene->model_count == DEA_SCENE_MODELS) {
        return model_fail(reader, node, "too many models", (ability){0});
    }
    if (scene->actuator.kind == DEA_LENS && !model->lens) {
        return model_fail(reader, node, "cannot do a lens", (ability){.lens = true});
    }
    reader->model_names[scene->model_count] = node;
    scene->models[scene->model_count++] = model;
    return DEA_OK;
}

dea_status dea_read_model(dea_reader *reader, const dea_ref *ref, const dea_node *node)
{
    (void)ref;
    if (reader->model && node->place.origin != &reader->model_origin) {
        return DEA_OK;
    }
    reader->scene->model_count = 0;
    reader->scene->automatic = false;
    if (node->kind == DEA_NODE_SCALAR) {
        return model_add(reader, node);
    }
    if (node->kind == DEA_NODE_MAPPING || node->count == 0) {
        return model_fail(reader, node, "not a model name", (ability){0});
    }
    for (const dea_node *name = node->first; name; name = name->next) {
        const dea_status status = model_add(reader, name);
        if (status) {
            return status;
        }
    }
    return DEA_OK;
}

static const char *engine_name(size_t index)
{
    return index < dea_engine_count() ? dea_engine_at(index)->name : NULL;
}

static dea_status engine_fail(dea_reader *reader, const dea_node *node, const char *what)
{
    char shown[DEA_TEXT_ROOM];
    char names[DEA_KEY_ROOM];
    char meant[DEA_KEY_ROOM];
    dea_reader_names(node, engine_name, names, meant);
    return dea_place_fail(&node->place, reader->error, "engine", "%s (%s); %saccepted: %s%s", what, dea_reader_show(node, shown),
                          meant, names, automatic);
}

static dea_status engine_add(dea_reader *reader, const dea_node *node)
{
    dea_scene *scene = reader->scene;
    const dea_engine *engine = node->kind == DEA_NODE_SCALAR ? dea_engine_find(node->text) : NULL;
    if (!engine) {
        const bool all = node->kind == DEA_NODE_SCALAR && strcmp(node->text, automatic) == 0;
        return engine_fail(reader, node, all ? "auto stands alone" : "unknown engine");
    }
    for (size_t i = 0; i < scene->engine_count; i++) {
        if (scene->engines[i] == engine) {
            return engine_fail(reader, node, "named twice");
        }
    }
    scene->engines[scene->engine_count++] = engine;
    return DEA_OK;
}

dea_status dea_read_engine(dea_reader *reader, const dea_ref *ref, const dea_node *node)
{
    (void)ref;
    if (reader->engine && node->place.origin != &reader->engine_origin) {
        return DEA_OK;
    }
    const dea_node *alone = node->kind == DEA_NODE_SCALAR ? node : node->count == 1 ? node->first : NULL;
    reader->scene->engine_count = 0;
    if (alone && alone->kind == DEA_NODE_SCALAR && strcmp(alone->text, automatic) == 0) {
        return DEA_OK;
    }
    if (node->kind == DEA_NODE_MAPPING || (node->kind == DEA_NODE_SEQUENCE && node->count == 0)) {
        return engine_fail(reader, node, "not an engine");
    }
    dea_status status = node->kind == DEA_NODE_SCALAR ? engine_add(reader, node) : DEA_OK;
    for (const dea_node *name = node->kind == DEA_NODE_SEQUENCE ? node->first : NULL; name && !status; name = name->next) {
        status = engine_add(reader, name);
    }
    return status;
}
