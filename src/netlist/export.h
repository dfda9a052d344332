/* A scene's whole study as one netlist that a circuit simulator runs as it is: the moving network in one of the two analogies,
 * its linearisation about the bias, or the network in displacement form over all points of a sweep. */
#ifndef DEA_EXPORT_H
#define DEA_EXPORT_H

#include <stdio.h>

#include "deaspice/model.h"
#include "netlist/part_text.h"

/* How mechanical quantities become electrical ones. Mobility: velocity -> voltage, force -> current, elements between the edge
 * and the frame. Impedance: force -> voltage, velocity -> current, the same elements as links of one loop. */
typedef struct dea_analogy {
    const char *name;    /* as on the command line */
    const char *meaning; /* one line for the head of a netlist */
    char mass, spring;   /* letters of the elements */
    bool loop;           /* elements are links of a loop; else they lie between edge and frame */
} dea_analogy;

/* Analogy number @p index, the default first, NULL past the end; by name, NULL if there is none. */
const dea_analogy *dea_analogy_at(size_t index);
const dea_analogy *dea_analogy_find(const char *name);

enum { DEA_EXPORT_NOTE = 320 };

/* One export. */
typedef struct dea_export {
    const dea_scene *scene; /* borrowed, as all that follows; of one model */
    const dea_dialect *dialect;
    const dea_analogy *analogy;
    bool analogy_given; /* the user has chosen it */
    const char *name;   /* of a part, NULL: its own */
    FILE *out;
    char note[DEA_EXPORT_NOTE]; /* computed by dea_export_netlist(): what a user must know of the file, empty: nothing */
} dea_export;

/* Writes the netlist of the scene's study. DEA_ERROR_UNSUPPORTED, with nothing of use written, for a scene that one netlist
 * cannot hold: several models, axes over runs, a model without network. */
dea_status dea_export_netlist(dea_export *export, dea_error *error);

/* Its parts. */
dea_status dea_export_sweep(dea_export *export, dea_error *error);
dea_status dea_export_transient(dea_export *export, dea_error *error);
dea_status dea_export_ac(dea_export *export, dea_error *error);
/* The membrane's. */
dea_status dea_export_ac_rings(dea_export *export, dea_error *error);

/* First lines of every netlist: the title of the scene as a comment, the tool, what voltages and currents mean. */
void dea_export_head(const dea_export *export, const char *meaning);
/* Gives every moving term that is used twice a node of its own, but for a mere number times another: simulators differentiate an
 * expression by each of its nodes, so that short ones are worth it. */
void dea_export_share(dea_part_text *text);
/* Points `from` to `to`, excluded, of an axis as the voltage v(axis) of the index v(k); a list as a sum of its steps, each of which
 * rises between two indices. */
void dea_export_axis(const dea_dialect *dialect, const dea_axis *axis, size_t from, size_t to, FILE *out);
/* `.param name=value`, and a card's number. */
void dea_export_parameter(FILE *out, const char *name, double value);
void dea_export_number(FILE *out, double value);

#endif
