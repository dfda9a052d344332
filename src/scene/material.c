/* Reading of the material: by name, from a file, or written out. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "support/file.h"
#include "scene/reader.h"

static dea_status base_read(dea_reader *reader, const dea_ref *ref, const dea_node *node);

/* Names of all laws, with commas between. */
static void laws_list(char out[DEA_KEY_ROOM])
{
    size_t used = 0;
    out[0] = '\0';
    for (size_t i = 0; dea_law_at(i) && used < DEA_KEY_ROOM; i++) {
        used += (size_t)snprintf(out + used, DEA_KEY_ROOM - used, "%s%s", i ? ", " : "", dea_law_at(i)->name);
    }
}

dea_holder dea_reader_holder(dea_reader *reader, const dea_key *key)
{
    dea_scene *scene = reader->scene;
    const bool skin = key->within && strcmp(key->within, "electrode") == 0;
    return skin ? (dea_holder){"electrode", &scene->electrode.law, scene->electrode.constants, &scene->electrode.entry_count}
                : (dea_holder){"material", &scene->material.law, scene->material.constants, &scene->material.entry_count};
}

/* The law among the keys of a material or an electrode, NULL where it has none; two are refused. */
static dea_status law_find(dea_reader *reader, const char *holder, const dea_node *material, const dea_node **law)
{
    for (const dea_node *child = material->first; child; child = child->next) {
        if (!dea_law_find(child->key)) {
            continue;
        }
        if (*law) {
            char path[DEA_NAME_LENGTH];
            char names[DEA_KEY_ROOM];
            laws_list(names);
            snprintf(path, sizeof path, "%s.%s", holder, child->key);
            return dea_place_fail(&child->key_at, reader->error, path, "a second law: the %s has %s already; accepted: one of %s",
                                  holder, (*law)->key, names);
        }
        *law = child;
    }
    return DEA_OK;
}

/* Makes the constants those of another law, none of them given yet but by its defaults. */
static void law_enter(dea_reader *reader, const dea_holder *holder, const dea_law *law)
{
    *holder->law = law;
    *holder->entry_count = 1;
    for (size_t i = 0; i < DEA_LAW_CONSTANTS; i++) {
        const bool used = i < law->constant_count;
        holder->constants[i] = used ? law->constants[i].standard : 0.0;
        dea_reader_given(reader, (size_t)((char *)&holder->constants[i] - (char *)reader->scene))->node = NULL;
    }
}

/* Entries of a law that is a list, each with all its constants. */
static dea_status entries_read(dea_reader *reader, const dea_ref *ref, const dea_node *node)
{
    const dea_law *law = ref->key.law;
    const dea_holder holder = dea_reader_holder(reader, &ref->key);
    size_t index = 0;
    if (node->kind != DEA_NODE_SEQUENCE || node->count == 0 || node->count > law->entries) {
        return dea_reader_refuse(reader, ref, node, node->kind != DEA_NODE_SEQUENCE ? "not a list" : node->count ? "too long" : "empty");
    }
    law_enter(reader, &holder, law);
    *holder.entry_count = node->count;
    for (const dea_node *entry = node->first; entry; entry = entry->next, index++) {
        double *constants = holder.constants + index * law->constant_count;
        char path[DEA_NAME_LENGTH];
        dea_ref own;
        for (size_t i = 0; i < law->constant_count; i++) {
            constants[i] = law->constants[i].standard;
        }
        snprintf(path, sizeof path, "%s.%s.%zu", holder.name, law->name, index);
        const dea_status status = dea_key_find(path, &own) ? dea_read_mapping(reader, &own, entry) : dea_reader_memory(reader);
        for (size_t i = 0; i < law->constant_count && !status; i++) {
            if (isnan(constants[i])) {
                char what[DEA_NAME_LENGTH];
                snprintf(what, sizeof what, "%s is missing", law->constants[i].name);
                return dea_reader_refuse(reader, &own, entry, what);
            }
        }
        if (status) {
            return status;
        }
    }
    return DEA_OK;
}

/* The constants of one law; those of the same law in the base stay where they are not given anew. */
dea_status dea_read_law(dea_reader *reader, const dea_ref *ref, const dea_node *node)
{
    const dea_law *law = ref->key.law;
    if (law->entries > 1) {
        return entries_read(reader, ref, node);
    }
    if (node->kind != DEA_NODE_MAPPING) {
        return dea_reader_refuse(reader, ref, node, "not a mapping");
    }
    const dea_holder holder = dea_reader_holder(reader, &ref->key);
    if (*holder.law != law) {
        law_enter(reader, &holder, law);
    }
    return dea_reader_children(reader, ref->path, node);
}

/* Reads the keys of a material; what its base says goes first. */
static dea_status mapping_read(dea_reader *reader, const dea_node *node)
{
    dea_material *material = &reader->scene->material;
    const dea_node *base = dea_tree_child(node, "base");
    dea_ref ref;
    if (base && dea_key_find("material.base", &ref)) {
        const dea_status status = base_read(reader, &ref, base);
        if (status) {
            return status;
        }
        char source[DEA_SOURCE_LENGTH];
        snprintf(source, sizeof source, "%s, with changes", material->name);
        memcpy(material->source, source, sizeof source);
    }
    snprintf(material->name, sizeof material->name, "%s", "scene");
    const dea_node *law = NULL;
    const dea_status status = law_find(reader, "material", node, &law);
    if (law) { /* other constants than the base has data for */
        memset(material->stretches, 0, sizeof material->stretches);
    }
    return status ? status : dea_reader_children(reader, "material", node);
}

dea_status dea_read_electrode(dea_reader *reader, const dea_ref *ref, const dea_node *node)
{
    const dea_node *law = NULL;
    if (node->kind != DEA_NODE_MAPPING) {
        return dea_reader_refuse(reader, ref, node, "not a mapping");
    }
    const dea_status status = law_find(reader, "electrode", node, &law);
    return status ? status : dea_reader_children(reader, ref->path, node);
}

/* Does a line begin as a key of a material does, and hardly one of another file? */
static bool is_material_line(const char *line)
{
    char path[DEA_NAME_LENGTH];
    dea_ref ref;
    const size_t word = strcspn(line, ":\n.#");
    return line[word] == ':' && snprintf(path, sizeof path, "material.%.*s", (int)word, line) < (int)sizeof path &&
           dea_key_find(path, &ref) && ref.key.read != dea_read_source && ref.key.read != dea_read_later;
}

/* Keeps a material's text to be shown with messages; of a file that has no line of a material, nothing is. */
static bool text_keep(dea_reader *reader, dea_origin *origin, const char *text, size_t length)
{
    const char *copy = dea_arena_copy(&reader->arena, text, length);
    const char *line = copy;
    while (line && !is_material_line(line)) {
        line = strchr(line, '\n');
        line = line ? line + 1 : NULL;
    }
    origin->text = line ? copy : NULL;
    origin->length = length;
    return copy != NULL;
}

/* Does it hold any key of a material? The words of another file are not for a message. */
static bool is_material(const dea_node *root)
{
    char path[DEA_NAME_LENGTH];
    dea_ref ref;
    for (const dea_node *child = root->first; child; child = child->next) {
        const int length = snprintf(path, sizeof path, "material.%s", child->key);
        if (length > 0 && (size_t)length < sizeof path && !strpbrk(child->key, ".#") && dea_key_find(path, &ref)) {
            return true;
        }
    }
    return root->kind == DEA_NODE_MAPPING && !root->first;
}

static dea_status file_parse(dea_reader *reader, const char *path, const char *text, size_t length)
{
    dea_node *root = NULL;
    dea_origin *origin = dea_reader_origin(reader, path);
    if (!origin || !text_keep(reader, origin, text, length)) {
        return dea_reader_memory(reader);
    }
    dea_status status = dea_tree_parse(text, length, origin, &reader->arena, &root, reader->error);
    if (!status && !is_material(root)) {
        status = dea_place_fail(&root->place, reader->error, "material", "%s; accepted: keys such as yeoh, gent, permittivity, density",
                                root->kind == DEA_NODE_MAPPING ? "no key of a material" : "not a mapping");
    }
    return status ? status : mapping_read(reader, root);
}

static dea_status file_read(dea_reader *reader, const dea_ref *ref, const dea_node *node)
{
    dea_material *material = &reader->scene->material;
    char shown[DEA_TEXT_ROOM];
    char *text = NULL;
    size_t length = 0;
    char *path = dea_reader_path(reader, node);
    if (!path) {
        return dea_reader_memory(reader);
    }
    if (reader->material_depth == DEA_MATERIAL_DEPTH) {
        return dea_reader_refuse(reader, ref, node, "materials name each other as base in a circle");
    }
    const char *refused = NULL;
    const dea_status read = dea_file_read(path, false, DEA_FILE_MAX, &text, &length, reader->scene->files, &refused);
    if (read == DEA_ERROR_MEMORY) {
        return dea_reader_memory(reader);
    }
    if (read) {
        return dea_place_fail(&node->place, reader->error, ref->path, "cannot read the material file %s: %s",
                              dea_reader_show(node, shown), refused);
    }
    reader->material_depth++;
    const dea_status status = file_parse(reader, path, text, length);
    reader->material_depth--;
    free(text);
    const char *slash = strrchr(path, '/');
    dea_text_clip(slash ? slash + 1 : path, DEA_TEXT_SHOWN, shown, DEA_NAME_LENGTH);
    memcpy(material->name, shown, DEA_NAME_LENGTH);
    return status;
}

static const char *material_name(size_t index)
{
    return index < dea_material_count() ? dea_material_builtin(index)->name : NULL;
}

static dea_status fail_name(dea_reader *reader, const dea_ref *ref, const dea_node *node)
{
    char shown[DEA_TEXT_ROOM];
    char names[DEA_KEY_ROOM];
    char meant[DEA_KEY_ROOM];
    dea_reader_names(node, material_name, names, meant);
    return dea_place_fail(&node->place, reader->error, ref->path,
                          "unknown material (%s); %saccepted: %sa file name with \".\" or \"/\", or a mapping",
                          dea_reader_show(node, shown), meant, names);
}

/* A built-in name or a file. */
static dea_status base_read(dea_reader *reader, const dea_ref *ref, const dea_node *node)
{
    if (node->kind != DEA_NODE_SCALAR || !node->text[0]) {
        return dea_reader_refuse(reader, ref, node, node->kind == DEA_NODE_SCALAR ? "has no value" : "not a name");
    }
    const dea_material *builtin = dea_material_find(node->text);
    if (builtin) {
        const double temperature = reader->scene->material.temperature; /* the scene's, not the film's */
        reader->scene->material = *builtin;
        reader->scene->material.temperature = temperature;
        return DEA_OK;
    }
    if (!strpbrk(node->text, "./")) {
        return fail_name(reader, ref, node);
    }
    const dea_status named = dea_reader_names_file(reader, ref, node);
    return named ? named : file_read(reader, ref, node);
}

dea_status dea_read_material(dea_reader *reader, const dea_ref *ref, const dea_node *node)
{
    if (node->kind == DEA_NODE_SEQUENCE) {
        return dea_reader_refuse(reader, ref, node, "not a material");
    }
    return node->kind == DEA_NODE_MAPPING ? mapping_read(reader, node) : base_read(reader, ref, node);
}

dea_status dea_read_source(dea_reader *reader, const dea_ref *ref, const dea_node *node)
{
    dea_material *material = &reader->scene->material;
    if (node->kind != DEA_NODE_SCALAR || strpbrk(node->text, "\n\r\t") || strlen(node->text) >= sizeof material->source) {
        return dea_reader_refuse(reader, ref, node, "not one line of text");
    }
    snprintf(material->source, sizeof material->source, "%s", node->text);
    return DEA_OK;
}

dea_status dea_read_stretches(dea_reader *reader, const dea_ref *ref, const dea_node *node)
{
    static const dea_key stretch = {.path = "material.stretches",
                                    .unit = "1",
                                    .high = INFINITY,
                                    .open = true,
                                    .kinds = DEA_KEY_BOTH,
                                    .accepted = "two stretches > 0, e.g. [1, 2]"};
    const dea_ref number = {.key = stretch, .path = "material.stretches"};
    double *range = reader->scene->material.stretches;
    if (node->kind != DEA_NODE_SEQUENCE || node->count != 2) {
        return dea_reader_refuse(reader, ref, node, "not a pair of stretches");
    }
    dea_status status = dea_reader_number(reader, &number, node->first, &range[0]);
    status = status ? status : dea_reader_number(reader, &number, node->last, &range[1]);
    return status || range[0] < range[1] ? status : dea_reader_refuse(reader, &number, node->last, "not above the first");
}

dea_status dea_read_permittivity(dea_reader *reader, const dea_ref *ref, const dea_node *node)
{
    if (node->kind == DEA_NODE_MAPPING) {
        return dea_reader_children(reader, ref->path, node);
    }
    const dea_status status = dea_read_scalar(reader, ref, node);
    if (!status) {
        reader->scene->material.permittivity_per_stretch = 0.0;
        reader->scene->material.permittivity_follows = false;
    }
    return status;
}

/* One number of a row of the table of shift factors. */
static dea_status shift_number(dea_reader *reader, const dea_node *node, bool factor, double *value)
{
    const dea_key key = {.path = "material.shift",
                         .unit = factor ? "1" : "K",
                         .high = factor ? INFINITY : 1e4,
                         .open = true,
                         .kinds = DEA_KEY_BOTH,
                         .accepted = factor ? "a factor > 0, e.g. [[20 degC, 1], [40 degC, 0.1]]"
                                            : "temperatures that rise, above 0 and below 10,000 K, e.g. [[20 degC, 1], [40 degC, 0.1]]"};
    const dea_ref ref = {.key = key, .path = "material.shift"};
    const dea_status status = dea_reader_number(reader, &ref, node, value);
    return status || factor || value == reader->scene->material.shift.table[0] || value[0] > value[-2]
               ? status
               : dea_reader_refuse(reader, &ref, node, "not above the one before");
}

static dea_status shift_table(dea_reader *reader, const dea_ref *ref, const dea_node *node)
{
    dea_shift *shift = &reader->scene->material.shift;
    if (node->kind != DEA_NODE_SEQUENCE || node->count < 2 || node->count > DEA_SHIFT_MOST) {
        const bool list = node->kind == DEA_NODE_SEQUENCE;
        return dea_reader_refuse(reader, ref, node, !list ? "not a table" : node->count < 2 ? "less than two rows" : "more than 64 rows");
    }
    for (const dea_node *row = node->first; row; row = row->next, shift->count++) {
        if (row->kind != DEA_NODE_SEQUENCE || row->count != 2) {
            return dea_reader_refuse(reader, ref, row, "not a pair of a temperature and a factor");
        }
        dea_status status = shift_number(reader, row->first, false, &shift->table[shift->count][0]);
        status = status ? status : shift_number(reader, row->last, true, &shift->table[shift->count][1]);
        if (status) {
            return status;
        }
    }
    return DEA_OK;
}

/* A table takes the place of the law of the base, and a law that of its table. */
dea_status dea_read_shift(dea_reader *reader, const dea_ref *ref, const dea_node *node)
{
    dea_shift *shift = &reader->scene->material.shift;
    shift->count = 0;
    if (node->kind == DEA_NODE_MAPPING) {
        return dea_reader_children(reader, ref->path, node);
    }
    shift->c1 = shift->c2 = shift->reference = NAN;
    return shift_table(reader, ref, node);
}

static dea_status branch_read(dea_reader *reader, size_t index, const dea_node *node)
{
    dea_prony *branch = &reader->scene->material.prony[index];
    char path[DEA_NAME_LENGTH];
    dea_ref ref;
    *branch = (dea_prony){.g = NAN, .tau = NAN};
    snprintf(path, sizeof path, "material.prony.%zu", index);
    if (!dea_key_find(path, &ref)) {
        return dea_reader_memory(reader);
    }
    const dea_status status = dea_read_mapping(reader, &ref, node);
    if (!status && (isnan(branch->g) || isnan(branch->tau))) {
        return dea_reader_refuse(reader, &ref, node, isnan(branch->g) ? "g is missing" : "tau is missing");
    }
    return status;
}

dea_status dea_read_prony(dea_reader *reader, const dea_ref *ref, const dea_node *node)
{
    size_t index = 0;
    if (node->kind != DEA_NODE_SEQUENCE) {
        return dea_reader_refuse(reader, ref, node, "not a list");
    }
    if (node->count > DEA_PRONY_MAX) {
        return dea_reader_refuse(reader, ref, node, "too many branches");
    }
    reader->scene->material.prony_count = node->count;
    for (const dea_node *branch = node->first; branch; branch = branch->next) {
        const dea_status status = branch_read(reader, index++, branch);
        if (status) {
            return status;
        }
    }
    return DEA_OK;
}
