#include "scene/tree.h"

#include <libfyaml.h>
#include <stdarg.h>
#include <stdio.h>
#include <string.h>

#include "support/text.h"

enum { SYNTAX_LENGTH = 512, BRACKETS_MAX = 256 };

typedef struct parse {
    struct fy_parser *parser;
    struct fy_diag *diag;
    const dea_origin *origin;
    dea_arena *arena;
    dea_error *error;
    size_t nodes;
    char syntax[SYNTAX_LENGTH]; /* first message of libfyaml, with its position in front */
} parse;

dea_status dea_place_fail(const dea_place *place, dea_error *error, const char *subject, const char *format, ...)
{
    char what[DEA_ERROR_LENGTH / 2];
    va_list arguments;
    va_start(arguments, format);
    vsnprintf(what, sizeof what, format, arguments);
    va_end(arguments);
    if (place->origin->setting) {
        dea_fail(error, DEA_ERROR_SCENE, "%s: %s: %s", place->origin->name, subject, what);
    } else {
        dea_fail(error, DEA_ERROR_SCENE, "%s:%d:%d: %s: %s", place->origin->name, place->line, place->column, subject, what);
    }
    if (error) {
        dea_place_excerpt(place, error->excerpt, sizeof error->excerpt);
    }
    return DEA_ERROR_SCENE;
}

static dea_status fail_memory(dea_error *error)
{
    return dea_fail(error, DEA_ERROR_MEMORY, "out of memory while reading the scene");
}

bool dea_tree_text_clean(const char *text, size_t length, int *line, int *column)
{
    *line = 1;
    *column = 1;
    for (size_t at = 0; at < length;) {
        unsigned code = 0;
        const size_t size = dea_text_character(text + at, length - at, &code);
        const bool blank = code == '\t' || code == '\n' || code == '\r';
        if (size == 0 || (!blank && (code < 0x20 || (code >= 0x7F && code < 0xA0)))) {
            return false;
        }
        *column += 1;
        if (code == '\n') {
            *line += 1;
            *column = 1;
        }
        at += size;
    }
    return true;
}

static void take_message(struct fy_diag *diag, void *user, const char *text, size_t length)
{
    parse *self = user;
    (void)diag;
    if (self->syntax[0] == '\0') {
        snprintf(self->syntax, sizeof self->syntax, "%.*s", (int)(length < SYNTAX_LENGTH ? length : SYNTAX_LENGTH - 1), text);
    }
}

/* The first collected error, in the form of those that are told. libfyaml draws the lines of an error that it tells, which has
 * crashed on texts that a fuzzer made; of collected ones it draws none. */
static void take_collected(parse *self)
{
    void *at = NULL;
    const struct fy_diag_error *first = fy_diag_errors_iterate(self->diag, &at);
    if (first) {
        snprintf(self->syntax, sizeof self->syntax, "<input>:%d:%d: error: %s", first->line, first->column, first->msg);
    }
}

/* libfyaml says "<input>:LINE:COLUMN: error: MESSAGE", or "<LINE:COLUMN>: MESSAGE" with both counted from 0. */
static dea_status fail_syntax(parse *self, const dea_place *last)
{
    take_collected(self);
    dea_place place = *last;
    int line = 0;
    int column = 0;
    int start = 0;
    char shown[DEA_TEXT_ROOM];
    self->syntax[strcspn(self->syntax, "\n")] = '\0';
    const char *after = strchr(self->syntax, '>');
    if (after && sscanf(after, ">:%d:%d: error: %n", &line, &column, &start) == 2 && start > 0) {
        place.line = line;
        place.column = column;
    } else if (sscanf(self->syntax, "<%d: %d>: %n", &line, &column, &start) == 2 && start > 0) {
        after = self->syntax;
        place.line = line + 1;
        place.column = column + 1;
    }
    char usual[DEA_SYNTAX_ROOM];
    if (dea_syntax_explain(&place, usual)) {
        return dea_place_fail(&place, self->error, "syntax", "%s", usual);
    }
    const char *message = start > 0 ? after + start : "the text cannot be read as YAML";
    return dea_place_fail(&place, self->error, "syntax", "%s", dea_text_clip(message, DEA_TEXT_SHOWN, shown, sizeof shown));
}

static dea_place place_of(const parse *self, struct fy_token *token, const dea_place *otherwise)
{
    const struct fy_mark *mark = token ? fy_token_start_mark(token) : NULL;
    if (!mark) {
        return *otherwise;
    }
    return (dea_place){.origin = self->origin, .line = mark->line + 1, .column = mark->column + 1};
}

static dea_status node_new(parse *self, dea_node_kind kind, const dea_place *place, dea_node **node)
{
    if (self->nodes++ >= DEA_TREE_NODES) {
        return dea_place_fail(place, self->error, "syntax", "more than %d values in one file", DEA_TREE_NODES);
    }
    *node = dea_arena_take(self->arena, sizeof **node);
    if (!*node) {
        return fail_memory(self->error);
    }
    (*node)->kind = kind;
    (*node)->place = *place;
    (*node)->key_at = *place;
    return DEA_OK;
}

static dea_status scalar_make(parse *self, struct fy_event *event, const dea_place *near, dea_node **node)
{
    const dea_place place = place_of(self, event->scalar.value, near);
    size_t length = 0;
    const char *text = event->scalar.value ? fy_token_get_text(event->scalar.value, &length) : "";
    int line = 0;
    int column = 0;
    dea_status status = node_new(self, DEA_NODE_SCALAR, &place, node);
    if (status) {
        return status;
    }
    if (!text) {
        return fail_memory(self->error);
    }
    if (!dea_tree_text_clean(text, length, &line, &column)) {
        return dea_place_fail(&place, self->error, "syntax", "a control character inside a text");
    }
    (*node)->quoted = event->scalar.value && fy_token_scalar_style(event->scalar.value) != FYSS_PLAIN;
    (*node)->text = dea_arena_copy(self->arena, text, length);
    return (*node)->text ? DEA_OK : fail_memory(self->error);
}

static void child_add(dea_node *parent, dea_node *child)
{
    if (parent->last) {
        parent->last->next = child;
    } else {
        parent->first = child;
    }
    parent->last = child;
    child->next = NULL;
    parent->count++;
}

static dea_status value_read(parse *self, struct fy_event *event, const dea_place *near, size_t depth, dea_node **node);

/* Fetches the next event; the caller frees it. */
static dea_status event_next(parse *self, const dea_place *near, struct fy_event **event)
{
    *event = fy_parser_parse(self->parser);
    if (*event && self->syntax[0] == '\0') {
        return DEA_OK;
    }
    if (*event) {
        fy_parser_event_free(self->parser, *event);
        *event = NULL;
    }
    return fail_syntax(self, near);
}

static dea_status key_check(parse *self, const dea_node *parent, const dea_node *key)
{
    char shown[DEA_TEXT_ROOM];
    if (key->kind != DEA_NODE_SCALAR || key->text[0] == '\0') {
        return dea_place_fail(&key->place, self->error, "syntax", "a key must be a word");
    }
    dea_text_clip(key->text, DEA_TEXT_SHOWN, shown, sizeof shown);
    const dea_node *earlier = dea_tree_child(parent, key->text);
    if (earlier) {
        return dea_place_fail(&key->place, self->error, shown, "the key is given twice, first in line %d", earlier->key_at.line);
    }
    if (parent->count >= DEA_TREE_KEYS) {
        return dea_place_fail(&key->place, self->error, shown, "more than %d keys in one mapping", DEA_TREE_KEYS);
    }
    return DEA_OK;
}

/* Reads the value of one mapping entry whose key has been read. */
static dea_status entry_read(parse *self, dea_node *parent, const dea_node *key, size_t depth)
{
    struct fy_event *event = NULL;
    dea_node *value = NULL;
    dea_status status = key_check(self, parent, key);
    status = status ? status : event_next(self, &key->place, &event);
    if (!status) {
        status = value_read(self, event, &key->place, depth, &value);
        fy_parser_event_free(self->parser, event);
    }
    if (!status) {
        value->key = key->text;
        value->key_at = key->place;
        if (value->kind == DEA_NODE_SCALAR && value->text[0] == '\0' && !value->quoted) {
            value->place = key->place; /* where nothing stands, releases of libfyaml differ about its place */
        }
        child_add(parent, value);
    }
    return status;
}

/* Reads the children of @p parent up to the event that ends it. */
static dea_status children_read(parse *self, dea_node *parent, size_t depth)
{
    const enum fy_event_type end = parent->kind == DEA_NODE_MAPPING ? FYET_MAPPING_END : FYET_SEQUENCE_END;
    for (;;) {
        struct fy_event *event = NULL;
        dea_node *child = NULL;
        dea_status status = event_next(self, &parent->place, &event);
        if (status) {
            return status;
        }
        const bool done = event->type == end;
        if (!done) {
            status = value_read(self, event, &parent->place, depth, &child);
        }
        fy_parser_event_free(self->parser, event);
        if (status || done) {
            return status;
        }
        if (parent->kind == DEA_NODE_SEQUENCE) {
            child_add(parent, child);
        } else {
            status = entry_read(self, parent, child, depth);
        }
        if (status) {
            return status;
        }
    }
}

static dea_status collection_read(parse *self, struct fy_event *event, const dea_place *near, size_t depth, dea_node **node)
{
    const bool mapping = event->type == FYET_MAPPING_START;
    struct fy_token *token = mapping ? event->mapping_start.mapping_start : event->sequence_start.sequence_start;
    const dea_place place = place_of(self, token, near);
    if (depth >= DEA_TREE_DEPTH) {
        return dea_place_fail(&place, self->error, "syntax", "nested deeper than %d levels", DEA_TREE_DEPTH);
    }
    dea_status status = node_new(self, mapping ? DEA_NODE_MAPPING : DEA_NODE_SEQUENCE, &place, node);
    return status ? status : children_read(self, *node, depth + 1);
}

/* A scene has no use for anchors, aliases and tags: what an editor shows is what is read. */
static const char *event_refused(const struct fy_event *event)
{
    const bool scalar = event->type == FYET_SCALAR;
    const bool mapping = event->type == FYET_MAPPING_START;
    if (event->type == FYET_ALIAS) {
        return "aliases (*name) are not accepted; write the value out";
    }
    const struct fy_token *anchor = scalar    ? event->scalar.anchor
                                    : mapping ? event->mapping_start.anchor
                                              : event->sequence_start.anchor;
    const struct fy_token *tag = scalar ? event->scalar.tag : mapping ? event->mapping_start.tag : event->sequence_start.tag;
    return anchor ? "anchors (&name) are not accepted; write the value out"
           : tag  ? "tags (!name) are not accepted; write the plain value"
                  : NULL;
}

static dea_status value_read(parse *self, struct fy_event *event, const dea_place *near, size_t depth, dea_node **node)
{
    const bool scalar = event->type == FYET_SCALAR;
    if (!scalar && event->type != FYET_ALIAS && event->type != FYET_MAPPING_START && event->type != FYET_SEQUENCE_START) {
        return dea_place_fail(near, self->error, "syntax", "the text ends in the middle of a value");
    }
    const char *refused = event_refused(event);
    if (refused) {
        struct fy_token *token = event->type == FYET_ALIAS           ? event->alias.anchor
                                 : scalar                            ? event->scalar.value
                                 : event->type == FYET_MAPPING_START ? event->mapping_start.mapping_start
                                                                     : event->sequence_start.sequence_start;
        const dea_place place = place_of(self, token, near);
        return dea_place_fail(&place, self->error, "syntax", "%s", refused);
    }
    return scalar ? scalar_make(self, event, near, node) : collection_read(self, event, near, depth, node);
}

/* Steps over stream and document starts; leaves *root NULL where there is no document. */
static dea_status document_read(parse *self, dea_node **root)
{
    const dea_place top = {.origin = self->origin, .line = 1, .column = 1};
    for (bool more = true; more;) {
        struct fy_event *event = NULL;
        dea_status status = event_next(self, &top, &event);
        if (status) {
            return status;
        }
        const enum fy_event_type type = event->type;
        if (type == FYET_DOCUMENT_START && *root) {
            const dea_place place = place_of(self, event->document_start.document_start, &top);
            status = dea_place_fail(&place, self->error, "syntax", "a second document; one file holds one scene");
        } else if (type != FYET_STREAM_START && type != FYET_DOCUMENT_START && type != FYET_DOCUMENT_END &&
                   type != FYET_STREAM_END) {
            status = value_read(self, event, &top, 0, root);
        }
        fy_parser_event_free(self->parser, event);
        more = !status && type != FYET_STREAM_END;
        if (status) {
            return status;
        }
    }
    return *root ? DEA_OK : dea_place_fail(&top, self->error, "scene", "the text is empty");
}

static dea_status parser_run(parse *self, const char *text, size_t length, dea_node **root)
{
    const struct fy_diag_cfg messages = {.output_fn = take_message,
                                         .user = self,
                                         .level = FYET_ERROR,
                                         .module_mask = ~0u,
                                         .show_position = true,
                                         .show_type = true};
    struct fy_diag *diag = self->diag = fy_diag_create(&messages);
    const struct fy_parse_cfg settings = {.search_path = "", .flags = FYPCF_DEFAULT_PARSE, .diag = diag};
    self->parser = diag ? fy_parser_create(&settings) : NULL;
    fy_diag_set_collect_errors(diag, true);
    dea_status status = DEA_OK;
    if (!self->parser || fy_parser_set_string(self->parser, text, length)) {
        status = fail_memory(self->error);
    }
    status = status ? status : document_read(self, root);
    fy_diag_set_collect_errors(diag, false); /* lets go of what they hold of the parser */
    if (self->parser) {
        fy_parser_destroy(self->parser);
    }
    if (diag) {
        fy_diag_destroy(diag);
    }
    return status;
}

/* libfyaml looks far ahead at every open bracket, which takes seconds where millions of them are open. */
static bool brackets_modest(const char *text, size_t length)
{
    long open = 0;
    for (size_t i = 0; i < length && open <= BRACKETS_MAX; i++) {
        open += (text[i] == '[') + (text[i] == '{') - (text[i] == ']') - (text[i] == '}');
        open = open < 0 ? 0 : open;
    }
    return open <= BRACKETS_MAX;
}

dea_status dea_tree_parse(const char *text, size_t length, const dea_origin *origin, dea_arena *arena, dea_node **root,
                          dea_error *error)
{
    parse self = {.origin = origin, .arena = arena, .error = error};
    dea_place place = {.origin = origin, .line = 1, .column = 1};
    *root = NULL;
    if (length == 0) {
        return dea_place_fail(&place, error, "scene", "the text is empty");
    }
    if (!dea_tree_text_clean(text, length, &place.line, &place.column)) {
        return dea_place_fail(&place, error, "syntax", "not a text: a control character, or bytes that are not UTF-8");
    }
    if (!brackets_modest(text, length)) {
        place = (dea_place){.origin = origin, .line = 1, .column = 1};
        return dea_place_fail(&place, error, "syntax", "more than %d open brackets", BRACKETS_MAX);
    }
    return parser_run(&self, text, length, root);
}

dea_node *dea_tree_scalar(dea_arena *arena, const dea_origin *origin, const char *text)
{
    dea_node *node = dea_arena_take(arena, sizeof *node);
    if (node) {
        node->kind = DEA_NODE_SCALAR;
        node->place = (dea_place){.origin = origin, .line = 1, .column = 1};
        node->key_at = node->place;
        node->text = text;
    }
    return node;
}

dea_node *dea_tree_mapping(dea_arena *arena, const dea_place *place)
{
    dea_node *node = dea_arena_take(arena, sizeof *node);
    if (node) {
        node->kind = DEA_NODE_MAPPING;
        node->place = *place;
        node->key_at = *place;
    }
    return node;
}

dea_node *dea_tree_child(const dea_node *node, const char *key)
{
    if (!node || node->kind != DEA_NODE_MAPPING) {
        return NULL;
    }
    for (dea_node *child = node->first; child; child = child->next) {
        if (strcmp(child->key, key) == 0) {
            return child;
        }
    }
    return NULL;
}

void dea_tree_put(dea_node *node, const char *key, dea_node *child)
{
    child->key = key;
    dea_node *old = dea_tree_child(node, key);
    if (!old) {
        child_add(node, child);
        return;
    }
    dea_node **link = &node->first;
    while (*link != old) {
        link = &(*link)->next;
    }
    *link = child;
    child->next = old->next;
    node->last = node->last == old ? child : node->last;
}

const dea_node *dea_tree_find(const dea_node *node, const char *path)
{
    while (node && node->kind == DEA_NODE_MAPPING) {
        const size_t length = strcspn(path, ".");
        const dea_node *child = node->first;
        while (child && !(strncmp(child->key, path, length) == 0 && child->key[length] == '\0')) {
            child = child->next;
        }
        if (!child || path[length] == '\0') {
            return child;
        }
        node = child;
        path += length + 1;
    }
    return NULL;
}

void dea_tree_remove(dea_node *node, const char *key)
{
    dea_node *before = NULL;
    for (dea_node *child = node->first; child; before = child, child = child->next) {
        if (strcmp(child->key, key) == 0) {
            *(before ? &before->next : &node->first) = child->next;
            node->last = node->last == child ? before : node->last;
            node->count--;
            return;
        }
    }
}
