/* The keys of a scene: one table that the reader, --set, sweep axes and result columns work from. */
#ifndef DEA_SCENE_KEYS_H
#define DEA_SCENE_KEYS_H

#include <stdbool.h>
#include <stddef.h>

#include "deaspice/scene.h"
#include "scene/tree.h"

typedef struct dea_reader dea_reader;
typedef struct dea_key dea_key;
typedef struct dea_ref dea_ref;

enum { DEA_KEY_DOT = 1, DEA_KEY_LENS = 2, DEA_KEY_BOTH = 3, DEA_KEY_ROOM = 512 };

/* Not a scalar: no place in the scene. */
#define DEA_KEY_NOWHERE ((size_t)-1)

/* Reads the value of a key. */
typedef dea_status dea_read(dea_reader *reader, const dea_ref *ref, const dea_node *node);

struct dea_key {
    char path[DEA_NAME_LENGTH]; /* dotted; a component "#" stands for an index */
    dea_read *read;
    size_t offset;        /* of the double in dea_scene, DEA_KEY_NOWHERE for what is no scalar */
    size_t stride;        /* from one index to the next, 0 without "#" */
    const char *unit;     /* "1" without dimension */
    const char *suffix;   /* of the result column, e.g. "_m" */
    double low, high;     /* range */
    bool open;            /* the range is without its ends */
    bool whole;           /* only whole numbers are in it */
    size_t place;         /* in dea_scene of a count, or of the bool of a choice */
    const char *const *choice; /* the word that leaves that bool false, the one that sets it, NULL */
    unsigned kinds;       /* of actuator that have it */
    size_t words;         /* components of the path that its result column shows at least, 0: cannot be a sweep axis */
    const char *within;   /* key that the scene must give for this one to have a place (the inner `over`: itself), NULL: none */
    const char *instead;  /* key that takes the place of this one, NULL: none */
    const char *accepted; /* for messages: range and an example */
    const dea_law *law;   /* whose constants it holds, or is one of, NULL: none; of the skin where `within` is set */
};

/* One key with its index. */
struct dea_ref {
    dea_key key;
    size_t index;               /* of "#", else 0 */
    char path[DEA_NAME_LENGTH]; /* with the index, e.g. material.prony.0.tau */
};

/* Key number @p index: those of the table, with those that the table of laws tells of in between. False past the end. */
bool dea_key_at(size_t index, dea_key *key);
/* Finds a key by its whole path. */
bool dea_key_find(const char *path, dea_ref *ref);
/* Finds a key by its whole path or by the end of it ("coverage", "yeoh.C1") where only one key ends so, or only one of those that
 * have a place in the scene @p root. */
bool dea_key_resolve(const char *name, const dea_node *root, dea_ref *ref);
/* True where the scene @p root has what the key stands in, and nothing that takes its place. */
bool dea_key_has_place(const dea_key *key, const dea_node *root);
/* True where the key names one number that the scene's kind of actuator and its laws have. */
bool dea_key_is_scalar(const dea_key *key, const dea_scene *scene);

/* Whether the scene uses what a key names. */
typedef bool dea_key_use(const dea_key *key, const dea_scene *scene);
/* Calls @p each for all keys that name a number in use: once a number, though two keys can name it. */
void dea_keys_visit(const dea_scene *scene, dea_key_use *used, void (*each)(void *user, const dea_key *key), void *user);
/* Lists the keys that end in @p name where there are several ("a, b"); false where there is one or none. */
bool dea_key_ambiguous(const char *name, char out[DEA_KEY_ROOM]);
/* Place of the scalar in dea_scene. */
size_t dea_ref_offset(const dea_ref *ref);
/* Says what an unknown key in the mapping @p parent ("", "actuator", ...) could mean: "; did you mean one of that mapping?
 * accepted:
 * ...", or where it stands. */
void dea_key_suggest(const char *parent, const char *name, char out[DEA_KEY_ROOM]);
/* Says what an unknown short name, which may be the end of any key, could mean: "; did you mean actuator.coverage? accepted:
 * ...". */
void dea_key_suggest_short(const char *name, const dea_node *root, const char *accepted, char out[DEA_KEY_ROOM]);
/* Result column of the last @p components components of a key's path and its unit. */
void dea_ref_column(const dea_ref *ref, size_t components, char column[DEA_NAME_LENGTH]);

#endif
