/* YAML text as a tree of nodes that know where they come from. Everything lives in an arena. */
#ifndef DEA_SCENE_TREE_H
#define DEA_SCENE_TREE_H

#include <stddef.h>
#include <stdbool.h>

#include "deaspice/status.h"

/* ---- Memory of one reading: taken piece by piece, freed at once. */

typedef struct dea_arena_block dea_arena_block;

/* Start with {0}; end with dea_arena_free(). */
typedef struct dea_arena {
    dea_arena_block *blocks;
} dea_arena;

/* Zeroed memory that lives until dea_arena_free(), NULL without memory. */
void *dea_arena_take(dea_arena *arena, size_t size);
/* NUL-terminated copy of @p length bytes, NULL without memory. */
char *dea_arena_copy(dea_arena *arena, const char *text, size_t length);
/* Frees all that was taken. */
void dea_arena_free(dea_arena *arena);

/* What a place is a place in. */
typedef struct dea_origin {
    const char *name;   /* of a file, or "--set key=value"; fit for messages */
    const char *folder; /* where relative file names start, NULL: no file may be named */
    bool setting;       /* from the command line: has no lines and columns, and replaces what a file says */
    const char *text;   /* what may be shown of it, not owned; NULL: nothing */
    size_t length;      /* of the text */
} dea_origin;

typedef struct dea_place {
    const dea_origin *origin;
    int line, column; /* from 1 */
} dea_place;

typedef enum dea_node_kind { DEA_NODE_SCALAR, DEA_NODE_SEQUENCE, DEA_NODE_MAPPING } dea_node_kind;

typedef struct dea_node dea_node;
struct dea_node {
    dea_node_kind kind;
    bool quoted;      /* a scalar in quotes */
    dea_place place;  /* of the value */
    dea_place key_at; /* of the key, the value's own place outside a mapping */
    const char *key;  /* inside a mapping, else NULL */
    const char *text; /* of a scalar; UTF-8 without control characters but line breaks and tabs */
    size_t count;     /* children */
    dea_node *first, *last, *next;
};

enum { DEA_TREE_DEPTH = 24, DEA_TREE_NODES = 1 << 20, DEA_TREE_KEYS = 256 };

/* Writes the line of a place with its number, and a caret under it; nothing where its text may not be shown. */
void dea_place_excerpt(const dea_place *place, char *out, size_t room);
/* Fails with "file:line:column: subject: ..." (or "--set key=value: subject: ..."); returns DEA_ERROR_SCENE. */
dea_status dea_place_fail(const dea_place *place, dea_error *error, const char *subject, const char *format, ...)
    DEA_PRINTF(4, 5);

enum { DEA_SYNTAX_ROOM = 1024 };
/* Says what a text that is no YAML most likely gets wrong near @p place and what to write, and moves the place there; false where
 * it is none of the usual slips, or the text may not be shown. */
bool dea_syntax_explain(dea_place *place, char out[DEA_SYNTAX_ROOM]);

/* Parses one YAML document. Anchors, aliases, tags, duplicate keys and more than one document are refused. */
dea_status dea_tree_parse(const char *text, size_t length, const dea_origin *origin, dea_arena *arena, dea_node **root,
                          dea_error *error);
/* A scalar of the plain text @p text, NULL without memory. */
dea_node *dea_tree_scalar(dea_arena *arena, const dea_origin *origin, const char *text);
/* An empty mapping at @p place, NULL without memory. */
dea_node *dea_tree_mapping(dea_arena *arena, const dea_place *place);
/* Child of a mapping by key; NULL without one, or where @p node is NULL or no mapping. */
dea_node *dea_tree_child(const dea_node *node, const char *key);
/* What stands at the dotted @p path ("drive.waveform.step") below @p node, NULL where nothing does. */
const dea_node *dea_tree_find(const dea_node *node, const char *path);
/* Takes the child of that key out of a mapping; nothing happens without one. */
void dea_tree_remove(dea_node *node, const char *key);
/* Puts @p child under @p key, last or in the place of one of that key. */
void dea_tree_put(dea_node *node, const char *key, dea_node *child);
/* True where text is valid UTF-8 without control characters but tab and line breaks; else the place of the first that is not. */
bool dea_tree_text_clean(const char *text, size_t length, int *line, int *column);

#endif
