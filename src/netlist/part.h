/* The actuator as a part for circuit designers: subcircuits with electrical pins p and n and a mechanical pin edge.
 *
 *   .subckt dea_dot p n edge params: frame_radius=... coverage=... film_thickness=... prestretch=... c1=... permittivity=... ...
 *   .subckt NAME p n edge p2 n2 params: ..., of a scene with a second film, on p2 and n2
 *
 * Mobility analogy: v(edge) is the outward velocity of the disc edge [m/s], the current into the pin the force on it [N]; the
 * frame is node 0. All parameters are SI numbers, moduli of the law long-term ones. Derived numbers come from the model's own
 * network, with the parameters as its symbols. */
#ifndef DEA_PART_H
#define DEA_PART_H

#include <stdio.h>

#include "deaspice/model.h"
#include "netlist/dialect.h"
#include "deaspice/status.h"

/* Room for a name with its ending; longest name that a user gives; what the names of the library's helpers begin with. */
enum { DEA_PART_TITLE = 48, DEA_PART_NAME_LENGTH = 32 };
#define DEA_PART_PREFIX "dea"

/* Name of the subcircuit: dea_dot, dea_lens of lumped; ..._lame; ..._hyper of coverage. NULL where the model is no part. */
const char *dea_part_name_of(dea_kind kind, const dea_model *model, char name[DEA_PART_TITLE]);

/* A name that every simulator takes: a letter, then letters, digits and underscores, at most DEA_PART_NAME_LENGTH in all. */
bool dea_part_name_valid(const char *name);

/* The name of a part in the file of that path, or from the scene of that path: that of the file up to its first dot, "_" for what
 * no name holds, "dea_" before what is no letter, as long as a name can be. False where the file has none: "-", ".lib". */
bool dea_part_name_after(const char *path, char name[DEA_PART_NAME_LENGTH + 1]);

/* Writes one subcircuit called @p name, NULL: as dea_part_name_of() says. Its defaults are the numbers of the scene, an axis at
 * its first value. As many Prony branches as the scene has, but three at least. DEA_ERROR_UNSUPPORTED for a model that is no
 * part. */
dea_status dea_part_write(const dea_scene *defaults, const dea_model *model, const char *name, const dea_dialect *dialect,
                          FILE *out, dea_error *error);

/* Writes the mechanical helpers: PREFIX_spring a b params: stiffness, and PREFIX_lever a b params: ratio. */
void dea_part_write_mechanics(const char *prefix, FILE *out);

/* Writes the part of a scene and the helpers as a library file with the scene's title as a comment. A @p name is that of the part
 * and the prefix of the helpers, so that files of different names go into one circuit; NULL: the names of the library. */
dea_status dea_part_of_scene(const dea_scene *scene, const dea_model *model, const char *name, const dea_dialect *dialect,
                             FILE *out, dea_error *error);
/* What of the scene is no business of its part and stands in the circuit around it, in words; empty: nothing. */
void dea_part_note(const dea_scene *scene, char *note, size_t size);

/* Writes the library of all parts, with the film of the base paper as defaults. */
dea_status dea_part_library(const dea_dialect *dialect, FILE *out, dea_error *error);

/* One parameter of a part: what header, symbols and documentation list. */
typedef struct dea_part_parameter {
    char name[40];
    const char *unit; /* SI, "1" without dimension */
    char meaning[64];
    double value; /* its default */
} dea_part_parameter;

enum { DEA_FILM_PARAMETERS = 32 + 2 * DEA_PRONY_MAX, DEA_PART_PARAMETERS = 2 * DEA_FILM_PARAMETERS };

/* The parameters of the part of a scene, in the order of the .subckt card; returns how many there are. Those of a second film alone
 * are called second_... */
size_t dea_part_parameters(const dea_scene *scene, const dea_model *model, dea_part_parameter list[DEA_PART_PARAMETERS]);

/* The scene behind the library's defaults: the film of the base paper, at rest. It owns nothing. */
dea_scene dea_part_paper(dea_kind kind);

/* ---- The ready-made library of netlists/: parts in every dialect and symbols. */

/* Writes the library below @p folder, one folder a tool, made where they are missing; files of the same names are replaced whole.
 * DEA_ERROR_IO, DEA_ERROR_MEMORY. */
dea_status dea_library_write(const char *folder, dea_error *error);

#endif
