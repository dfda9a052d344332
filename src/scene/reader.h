/* State of one reading of a scene, and the steps of it. */
#ifndef DEA_SCENE_READER_H
#define DEA_SCENE_READER_H

#include "scene/keys.h"
#include "scene/quantity.h"
#include "support/text.h"

enum { DEA_READER_SLOTS = sizeof(dea_scene) / sizeof(double) + 1, DEA_MATERIAL_DEPTH = 8, DEA_WORD_ROOM = 256 };

/* Who gave a scalar. */
typedef struct dea_given {
    const dea_node *node; /* NULL: nobody */
    dea_ref ref;
    bool swept; /* by an axis */
} dea_given;

/* One parsed setting. */
typedef struct dea_override {
    struct dea_override *next;
    dea_ref ref;
    dea_node *node;
} dea_override;

struct dea_reader {
    dea_scene *scene;
    dea_error *error;
    dea_arena arena;
    dea_units *units;
    dea_node *root;
    dea_origin model_origin;
    const char *model;       /* replaces the scene's model, may be NULL */
    dea_override *overrides; /* settings of scalars, in order */
    bool kind_known;
    size_t material_depth;             /* files that name files */
    dea_given given[DEA_READER_SLOTS]; /* by place in dea_scene */
};

/* Fails at the place of a value: "...: path: what (value); accepted: ...". */
dea_status dea_reader_refuse(dea_reader *reader, const dea_ref *ref, const dea_node *node, const char *what);
dea_status dea_reader_memory(dea_reader *reader);
/* Who gave the scalar at that place of dea_scene. */
dea_given *dea_reader_given(dea_reader *reader, size_t offset);
/* Text of a scalar fit for a message. */
char *dea_reader_show(const dea_node *node, char out[DEA_TEXT_ROOM]);

/* Reads every key below a mapping whose path is @p path ("" for the scene itself). */
dea_status dea_reader_children(dea_reader *reader, const char *path, const dea_node *node);
/* Number of a scalar, checked against unit, range and kind of actuator; stored nowhere. */
dea_status dea_reader_number(dea_reader *reader, const dea_ref *ref, const dea_node *node, double *value);
/* Notes who gives a scalar; coverage and the radius exclude each other. */
dea_status dea_reader_claim(dea_reader *reader, const dea_ref *ref, const dea_node *node, bool swept);
/* Index of a scalar's word in @p words, a list that ends with NULL. */
dea_status dea_reader_word(dea_reader *reader, const dea_ref *ref, const dea_node *node, const char *const *words, size_t *index);

/* Kinds of keys, for the table. */
dea_status dea_read_scalar(dea_reader *reader, const dea_ref *ref, const dea_node *node);
dea_status dea_read_mapping(dea_reader *reader, const dea_ref *ref, const dea_node *node);
dea_status dea_read_kind(dea_reader *reader, const dea_ref *ref, const dea_node *node);
dea_status dea_read_title(dea_reader *reader, const dea_ref *ref, const dea_node *node);
dea_status dea_read_model(dea_reader *reader, const dea_ref *ref, const dea_node *node);
dea_status dea_read_later(dea_reader *reader, const dea_ref *ref, const dea_node *node);
dea_status dea_read_unavailable(dea_reader *reader, const dea_ref *ref, const dea_node *node);
dea_status dea_read_material(dea_reader *reader, const dea_ref *ref, const dea_node *node);
dea_status dea_read_source(dea_reader *reader, const dea_ref *ref, const dea_node *node);
dea_status dea_read_permittivity(dea_reader *reader, const dea_ref *ref, const dea_node *node);
dea_status dea_read_prony(dea_reader *reader, const dea_ref *ref, const dea_node *node);
dea_status dea_read_moduli(dea_reader *reader, const dea_ref *ref, const dea_node *node);

/* Parses settings; puts those of other things than scalars into the tree, before it is read. */
dea_status dea_settings_graft(dea_reader *reader, const dea_setting *settings, size_t count);
/* Applies the settings of scalars, after the tree has been read. */
dea_status dea_settings_apply(dea_reader *reader);
/* Reads what the study asks, after all scalars. */
dea_status dea_reader_study(dea_reader *reader);
/* What only the whole scene shows: missing keys, contradictions. */
dea_status dea_reader_finish(dea_reader *reader);

#endif
