/* State of one reading of a scene, and the steps of it. */
#ifndef DEA_SCENE_READER_H
#define DEA_SCENE_READER_H

#include "scene/keys.h"
#include "support/quantity.h"
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
    dea_origin model_origin, engine_origin;
    const char *model;       /* replaces the scene's model, may be NULL */
    const char *engine;      /* the same for engines */
    dea_override *overrides; /* settings of scalars, in order */
    bool kind_known;
    bool no_files;                                 /* none may be named */
    size_t material_depth;                         /* files that name files */
    const char *axes;                              /* path of the mapping that the axes stand in */
    const dea_node *model_names[DEA_SCENE_MODELS]; /* who named the scene's models */
    dea_given given[DEA_READER_SLOTS];             /* by place in dea_scene */
};

/* Fails at the place of a value: "...: path: what (value); accepted: ...". */
dea_status dea_reader_refuse(dea_reader *reader, const dea_ref *ref, const dea_node *node, const char *what);
dea_status dea_reader_memory(dea_reader *reader);
/* Fails because @p path is missing, at the place of the mapping @p parent ("": of the scene). */
dea_status dea_reader_missing(dea_reader *reader, const char *parent, const char *path);
/* The place of whoever gave the scalar, else of the mapping @p parent, else the scene's. */
const dea_place *dea_reader_place(dea_reader *reader, size_t offset, const char *parent);
/* Fails where the key is one of a list (a Prony branch, a window) that the scene has not. */
dea_status dea_reader_index(dea_reader *reader, const dea_ref *ref, const dea_place *place);
/* Who gave the scalar at that place of dea_scene. */
dea_given *dea_reader_given(dea_reader *reader, size_t offset);
/* Text of a scalar fit for a message. */
char *dea_reader_show(const dea_node *node, char out[DEA_TEXT_ROOM]);

/* A table of names: that of row @p index, NULL past the end. */
typedef const char *dea_names(size_t index);
/* Lists the names, each with ", " behind it, and says which of them a scalar is most likely a slip of ("did you mean gent? "; "": none). */
void dea_reader_names(const dea_node *node, dea_names *name, char names[DEA_KEY_ROOM], char meant[DEA_KEY_ROOM]);

/* Reads every key below a mapping whose path is @p path ("" for the scene itself). */
dea_status dea_reader_children(dea_reader *reader, const char *path, const dea_node *node);
/* Number of a scalar, checked against unit, range and kind of actuator; stored nowhere. */
dea_status dea_reader_number(dea_reader *reader, const dea_ref *ref, const dea_node *node, double *value);
/* Notes who gives a scalar; coverage and the radius exclude each other. */
dea_status dea_reader_claim(dea_reader *reader, const dea_ref *ref, const dea_node *node, bool swept);
/* Index of a scalar's word in @p words, a list that ends with NULL. */
dea_status dea_reader_word(dea_reader *reader, const dea_ref *ref, const dea_node *node, const char *const *words, size_t *index);

/* What holds the constants of a law: the material, or the skin of the electrode. */
typedef struct dea_holder {
    const char *name; /* of its mapping */
    const dea_law **law;
    double *constants;
    size_t *entry_count;
} dea_holder;

dea_holder dea_reader_holder(dea_reader *reader, const dea_key *key);

/* Reads dot or lens. */
dea_status dea_reader_kind(dea_reader *reader, const dea_ref *ref, const dea_node *node, dea_kind *kind);
/* What only the whole scene shows of a second film: unlike frames, studies that have none. */
dea_status dea_antagonist_finish(dea_reader *reader);

/* Kinds of keys, for the table. */
dea_read dea_read_scalar, dea_read_count, dea_read_choice, dea_read_mapping, dea_read_kind, dea_read_antagonist,
    dea_read_antagonist_kind, dea_read_antagonist_material, dea_read_title, dea_read_model, dea_read_engine, dea_read_later,
    dea_read_material, dea_read_law, dea_read_electrode, dea_read_source, dea_read_stretches, dea_read_permittivity,
    dea_read_shift, dea_read_prony, dea_read_waveform, dea_read_wave_word, dea_read_sines, dea_read_points, dea_read_wave_file;

/* Refuses the value of a key that is a file's name where no file may be named, or it names none. */
dea_status dea_reader_names_file(dea_reader *reader, const dea_ref *ref, const dea_node *node);
/* The file that @p node names, seen from the folder of the file that names it; NULL without memory. */
char *dea_reader_path(dea_reader *reader, const dea_node *node);
/* What stands before positions in the file @p path, NULL without memory. */
dea_origin *dea_reader_origin(dea_reader *reader, const char *path);

/* Room for @p count points of the waveform, counted from 0 on. */
dea_status dea_points_new(dea_reader *reader, size_t count);
/* Shortest time between two edges of a waveform [s]. */
#define DEA_EDGE_MIN 1e-12

/* Parses settings; puts those of other things than scalars into the tree, before it is read. */
dea_status dea_settings_graft(dea_reader *reader, const dea_setting *settings, size_t count);
/* Applies the settings of scalars, after the tree has been read. */
dea_status dea_settings_apply(dea_reader *reader);
/* Finds what the study asks, and reads its axes, after all scalars. */
dea_status dea_reader_study(dea_reader *reader);
/* Reads the axes in the mapping @p axes, whose path is reader->axes. */
dea_status dea_reader_axes(dea_reader *reader, const dea_node *axes);
/* Frees the scene's waveform and leaves none. */
void dea_waveform_drop(dea_scene *scene);
/* Puts defaults into the waveform and checks it as a whole, swept keys at all their values. */
dea_status dea_waveform_finish(dea_reader *reader);
/* Puts defaults into the study and checks it as a whole. */
dea_status dea_study_finish(dea_reader *reader);
/* Refuses a sweep of the frame radius beside the key @p path, whose radii are the same of all points. */
dea_status dea_reader_frame(dea_reader *reader, const char *path);
/* Gives a bias that the study's own key has not set the static voltage of the drive; fails where there is none. */
dea_status dea_reader_bias(dea_reader *reader, double *bias);
/* Refuses models that cannot do the scene's study. */
dea_status dea_models_finish(dea_reader *reader);
/* What only the whole law of the film shows: constants that are missing or do not fit together. */
dea_status dea_law_finish(dea_reader *reader);
/* What only the whole material shows: shares that leave no long-term modulus. */
dea_status dea_material_finish(dea_reader *reader);
/* What only the whole scene shows: missing keys, contradictions. */
dea_status dea_reader_finish(dea_reader *reader);

#endif
