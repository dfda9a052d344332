/* The time and frequency domain of the engine `ngspice`. */
#ifndef DEA_NGSPICE_MOVING_H
#define DEA_NGSPICE_MOVING_H

#include "deaspice/engine.h"
#include "engine/ngspice/library.h"
#include "deaspice/model.h"
#include "network/units.h"
#include "scene/line.h"

/* Units in which a transient runs. */
dea_status dea_ngspice_units(const dea_scene *scene, const dea_model *model, dea_units *units, dea_error *error);
/* The same of the membrane, and one transient of it inside its units. */
dea_status dea_ngspice_units_rings(const dea_scene *scene, const dea_model *model, dea_units *units, dea_error *error);
dea_status dea_ngspice_transient_rings(dea_ngspice *library, const dea_scene *scene, const dea_model *model, dea_sample *samples,
                                       dea_summary *summary, dea_error *error);
/* One transient, as dea_engine says. */
dea_status dea_ngspice_transient(dea_ngspice *library, const dea_scene *scene, const dea_model *model, dea_sample *samples,
                                 dea_summary *summary, dea_error *error);
/* One frequency response, as dea_engine says. */
dea_status dea_ngspice_ac(dea_ngspice *library, const dea_scene *scene, const dea_model *model, dea_response *rows,
                          dea_band *band, dea_error *error);
/* The same of the membrane. */
dea_status dea_ngspice_ac_rings(dea_ngspice *library, const dea_scene *scene, const dea_model *model, dea_response *rows,
                                dea_band *band, dea_error *error);

/* Forces on an edge that is held, of a model that is a network. */
dea_status dea_ngspice_force(void *session, const dea_scene *scene, const dea_model *model, const dea_layout *layout, void *point,
                             dea_error *error);

/* ---- The membrane at rest: a line of points as a network of rings. */

/* Solves the points of a line; its rows are those of @p rows that the line says. */
dea_status dea_ngspice_still(dea_ngspice *library, const dea_scene *scene, const dea_model *model, const dea_line *line,
                             dea_row *rows, dea_error *error);

#endif
