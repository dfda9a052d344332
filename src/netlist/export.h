/* A scene's whole study as one netlist that a circuit simulator runs as it is: the moving network in one of the two analogies,
 * its linearisation about the bias, or the network in displacement form over all points of a sweep. */
#ifndef DEA_EXPORT_H
#define DEA_EXPORT_H

#include <stdio.h>

#include "deaspice/model.h"
#include "netlist/mobility.h"

enum { DEA_EXPORT_NOTE = 320 };

/* One export. */
typedef struct dea_export {
    const dea_scene *scene; /* borrowed, as all that follows; of one model */
    const dea_dialect *dialect;
    const dea_analogy *analogy;
    bool analogy_given; /* the user has chosen it */
    const char *name;   /* of a part, NULL: its own */
    FILE *out;
    char note[DEA_EXPORT_NOTE]; /* computed by who writes the file: what a user must know of it, empty: nothing */
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
dea_status dea_export_transient_rings(dea_export *export, dea_error *error);

/* First lines of every netlist: the title of the scene as a comment, the tool, what voltages and currents mean. */
void dea_export_head(const dea_export *export, const char *meaning);
/* What is read of a frequency response from the nodes of displacement and velocity, and the card of its grid, on which the last
 * frequency of the scene need not lie; last lines of the file. */
void dea_export_band(const dea_export *export, const char *displacement, const char *velocity);

#endif
