#include "scene/keys.h"

#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "support/text.h"

/* Copies @p name with every component that is a number below DEA_PRONY_MAX written as "#", the last of them kept in *index. */
static bool name_normalise(const char *name, char out[DEA_NAME_LENGTH], size_t *index)
{
    size_t used = 0;
    *index = 0;
    while (*name && used + 2 < DEA_NAME_LENGTH) {
        const size_t length = strcspn(name, ".");
        const size_t digits = strspn(name, "0123456789");
        if (length > 0 && digits == length) {
            *index = length <= 2 && (length == 1 || name[0] != '0') ? strtoul(name, NULL, 10) : DEA_PRONY_MAX;
            out[used++] = '#';
        } else if (used + length + 2 < DEA_NAME_LENGTH) {
            memcpy(out + used, name, length);
            used += length;
        } else {
            return false;
        }
        name += length;
        if (*name == '.') {
            out[used++] = '.';
            name++;
        }
    }
    out[used] = '\0';
    return *name == '\0' && *index < DEA_PRONY_MAX;
}

static void ref_set(dea_ref *ref, const dea_key *key, size_t index)
{
    const char *mark = strchr(key->path, '#');
    ref->key = *key;
    ref->index = mark ? index : 0;
    if (mark) {
        snprintf(ref->path, sizeof ref->path, "%.*s%zu%s", (int)(mark - key->path), key->path, index, mark + 1);
    } else {
        snprintf(ref->path, sizeof ref->path, "%s", key->path);
    }
}

bool dea_key_find(const char *path, dea_ref *ref)
{
    char name[DEA_NAME_LENGTH];
    size_t index = 0;
    if (!name_normalise(path, name, &index)) {
        return false;
    }
    dea_key key;
    for (size_t i = 0; dea_key_at(i, &key); i++) {
        if (strcmp(key.path, name) == 0) {
            ref_set(ref, &key, index);
            return true;
        }
    }
    return false;
}

static bool is_of_second(const char *path)
{
    return strncmp(path, "antagonist.", 11) == 0;
}

/* True where @p name is the end of @p path, whole components, and holds the index of a path that has one. No short name means the
 * second film, whose keys have the names of the first. */
static bool ends_with(const char *path, const char *name)
{
    if (is_of_second(path)) {
        return false;
    }
    const size_t whole = strlen(path);
    const size_t part = strlen(name);
    const bool indexed = !strchr(path, '#') || strchr(name, '#');
    return part > 0 && part < whole && indexed && path[whole - part - 1] == '.' && strcmp(path + whole - part, name) == 0;
}

/* Law of the material, or of the skin, in the tree; NULL where only a file, or nothing, tells. */
static const dea_law *law_in(const dea_node *root, const char *within)
{
    const dea_node *material = dea_tree_child(root, within ? within : "material");
    const dea_node *base = material && material->kind == DEA_NODE_MAPPING ? dea_tree_child(material, "base") : material;
    for (size_t i = 0; material && dea_law_at(i); i++) {
        if (dea_tree_child(material, dea_law_at(i)->name)) {
            return dea_law_at(i);
        }
    }
    const dea_material *builtin = base && base->kind == DEA_NODE_SCALAR ? dea_material_find(base->text) : NULL;
    return builtin ? builtin->law : NULL;
}

bool dea_key_has_place(const dea_key *key, const dea_node *root)
{
    if (key->law && (!key->within || dea_tree_find(root, key->within))) {
        const dea_law *law = law_in(root, key->within);
        return law == key->law || !law;
    }
    return (!key->within || dea_tree_find(root, key->within)) && !(key->instead && dea_tree_find(root, key->instead));
}

bool dea_key_is_scalar(const dea_key *key, const dea_scene *scene)
{
    const unsigned kind = scene->actuator.kind == DEA_DOT ? DEA_KEY_DOT : DEA_KEY_LENS;
    const dea_law *law = key->within ? scene->electrode.law : scene->material.law;
    return key->offset != DEA_KEY_NOWHERE && key->stride == 0 && (key->kinds & kind) != 0 && (!key->law || key->law == law);
}

/* True where no key in use before this one, number @p index, names the same number. */
static bool is_first(const dea_scene *scene, const dea_key *key, size_t index, dea_key_use *used)
{
    dea_key before;
    for (size_t i = 0; i < index && dea_key_at(i, &before); i++) {
        if (before.offset == key->offset && used(&before, scene)) {
            return false;
        }
    }
    return true;
}

void dea_keys_visit(const dea_scene *scene, dea_key_use *used, void (*each)(void *user, const dea_key *key), void *user)
{
    dea_key key;
    for (size_t i = 0; dea_key_at(i, &key); i++) {
        if (used(&key, scene) && is_first(scene, &key, i, used)) {
            each(user, &key);
        }
    }
}

bool dea_key_resolve(const char *name, const dea_node *root, dea_ref *ref)
{
    char wanted[DEA_NAME_LENGTH];
    size_t index = 0;
    dea_key key;
    dea_key placed;
    size_t found = 0;
    size_t found_placed = 0;
    if (dea_key_find(name, ref)) {
        return true;
    }
    if (!name_normalise(name, wanted, &index)) {
        return false;
    }
    for (size_t i = 0; dea_key_at(i, &key); i++) {
        if (ends_with(key.path, wanted)) {
            const bool here = dea_key_has_place(&key, root);
            placed = here || found == 0 ? key : placed;
            found_placed += here;
            found++;
        }
    }
    if (found == 1 || found_placed == 1) {
        ref_set(ref, &placed, index);
        return true;
    }
    return false;
}

size_t dea_ref_offset(const dea_ref *ref)
{
    return ref->key.offset + ref->index * ref->key.stride;
}

static const char *last_component(const char *path)
{
    const char *dot = strrchr(path, '.');
    return dot ? dot + 1 : path;
}

static bool child_of(const char *path, const char *parent)
{
    const size_t length = strlen(parent);
    if (length == 0) {
        return !strchr(path, '.');
    }
    return strncmp(path, parent, length) == 0 && path[length] == '.' && !strchr(path + length + 1, '.');
}

static bool is_child(const dea_key *key, const char *parent)
{
    return child_of(key->path, parent);
}

static bool is_anywhere(const dea_key *key, const char *parent)
{
    (void)parent;
    return strchr(key->path, '#') == NULL;
}

/* The key that @p name is most likely a slip of, among those that @p among holds for; false: none. */
static bool nearest(bool (*among)(const dea_key *key, const char *parent), const char *parent, const char *name, dea_key *best)
{
    dea_key key;
    size_t least = SIZE_MAX;
    for (size_t i = 0; dea_key_at(i, &key); i++) {
        const char *word = last_component(key.path);
        const bool apart = !among(&key, parent) || word[0] == '#';
        const size_t distance = apart ? SIZE_MAX : dea_text_distance(word, name);
        if (distance < least && dea_text_likely(word, distance)) {
            *best = key;
            least = distance;
        }
    }
    return least < SIZE_MAX;
}

static size_t depth_of(const char *path)
{
    size_t depth = 1;
    for (; *path; path++) {
        depth += *path == '.';
    }
    return depth;
}

/* How far off a namesake is: one below the same key at the top is near, then by its depth, one of an electrode or a second film last. */
static size_t distance_of(const char *path, const char *place)
{
    const size_t top = strcspn(path, ".");
    const bool near = top == strcspn(place, ".") && strncmp(path, place, top) == 0;
    const bool aside = strncmp(path, "electrode.", 10) == 0 || is_of_second(path);
    return depth_of(path) + (near ? 0 : aside ? 2 * DEA_TREE_DEPTH : DEA_TREE_DEPTH);
}

/* True where a key is no help in the mapping @p place: that takes its place, or has the name of its own mapping, as
 * antagonist.actuator has that of actuator. */
static bool is_no_help(const dea_key *key, const char *place)
{
    char home[DEA_NAME_LENGTH];
    const size_t length = (size_t)(last_component(key->path) - key->path);
    snprintf(home, sizeof home, "%.*s", length > 0 ? (int)length - 1 : 0, key->path);
    return (key->instead && strncmp(place, key->instead, strlen(key->instead)) == 0) ||
           (length > 0 && strcmp(last_component(home), last_component(place)) == 0);
}

/* The key whose last component is @p name, the nearest to the mapping @p place of several; false where there is none, or that is
 * not one alone or no help. */
static bool namesake(const char *name, const char *place, dea_key *found)
{
    dea_key key;
    size_t least = SIZE_MAX;
    size_t count = 0;
    for (size_t i = 0; dea_key_at(i, &key); i++) {
        const size_t distance = distance_of(key.path, place);
        if (is_anywhere(&key, NULL) && distance <= least && strcmp(last_component(key.path), name) == 0) {
            count = distance < least ? 1 : count + 1;
            least = distance;
            *found = key;
        }
    }
    return count == 1 && !is_no_help(found, place);
}

static size_t append(char out[DEA_KEY_ROOM], size_t used, const char *between, const char *word)
{
    const int more = used < DEA_KEY_ROOM ? snprintf(out + used, DEA_KEY_ROOM - used, "%s%s", between, word) : 0;
    return used + (size_t)(more > 0 ? more : 0);
}

bool dea_key_ambiguous(const char *name, char out[DEA_KEY_ROOM])
{
    char wanted[DEA_NAME_LENGTH];
    size_t index = 0;
    size_t found = 0;
    size_t used = 0;
    out[0] = '\0';
    if (!name_normalise(name, wanted, &index)) {
        return false;
    }
    dea_key key;
    for (size_t i = 0; dea_key_at(i, &key); i++) {
        if (ends_with(key.path, wanted)) {
            used = append(out, used, found ? ", " : "", key.path);
            found++;
        }
    }
    return found > 1;
}

/* Tells where a key that is right, but in the wrong mapping, belongs. */
static size_t place_tell(const char *parent, const dea_key *key, char out[DEA_KEY_ROOM])
{
    const char *name = last_component(key->path);
    const size_t home = (size_t)(name - key->path);
    size_t used = append(out, 0, "; ", name);
    if (key->words > 0 && strncmp(parent, "study", 5) == 0) {
        return append(out, used, " as an axis stands in ", strcmp(parent, "study") == 0 ? "study.sweep" : "over");
    }
    if (home == 0) {
        return append(out, used, " stands at the top, without indentation", "");
    }
    char mapping[DEA_NAME_LENGTH];
    snprintf(mapping, sizeof mapping, "%.*s", (int)home - 1, key->path);
    return append(out, used, " stands in ", mapping);
}

void dea_key_suggest(const char *parent, const char *name, char out[DEA_KEY_ROOM])
{
    char place[DEA_NAME_LENGTH];
    size_t index = 0;
    size_t used = 0;
    out[0] = '\0';
    if (!name_normalise(parent, place, &index)) {
        return;
    }
    dea_key key;
    const bool sibling = nearest(is_child, place, name, &key);
    const bool elsewhere = !sibling && namesake(name, place, &key);
    if (sibling) {
        used = append(out, used, "; did you mean ", last_component(key.path));
        used = append(out, used, "?", "");
    } else if (elsewhere) {
        used = place_tell(place, &key, out);
    }
    const char *between = sibling ? " accepted: " : elsewhere ? "; accepted here: " : "; accepted: ";
    for (size_t i = 0; dea_key_at(i, &key); i++) {
        if (child_of(key.path, place)) {
            used = append(out, used, between, last_component(key.path));
            between = ", ";
        }
    }
}

void dea_key_suggest_short(const char *name, const dea_node *root, const char *accepted, char out[DEA_KEY_ROOM])
{
    char dotted[DEA_NAME_LENGTH];
    dea_ref ref;
    size_t at = 0;
    for (const char *from = name; *from && at + 1 < sizeof dotted; from++) {
        if (*from != ']') {
            dotted[at++] = *from == '[' ? '.' : *from;
        }
    }
    dotted[at] = '\0';
    if (strchr(name, '[') && dea_key_resolve(dotted, root, &ref)) {
        at = append(out, 0, "; an index, counted from 0, stands between points: ", dotted);
        return;
    }
    dea_key key;
    const bool meant = nearest(is_anywhere, NULL, last_component(name), &key);
    at = meant ? append(out, 0, "; did you mean ", key.path) : 0;
    append(out, at, meant ? "? accepted: " : "; accepted: ", accepted);
}

void dea_ref_column(const dea_ref *ref, size_t components, char column[DEA_NAME_LENGTH])
{
    const char *start = ref->path + strlen(ref->path);
    for (size_t seen = 0; start > ref->path; start--) {
        seen += start[-1] == '.';
        if (seen == components) {
            break;
        }
    }
    snprintf(column, DEA_NAME_LENGTH, "%s%s", start, ref->key.suffix);
    for (char *c = column; *c; c++) {
        *c = *c == '.' ? '_' : *c;
    }
}
