/* The membrane at rest: a line of points as a network of rings. */
#ifndef DEA_NGSPICE_STILL_H
#define DEA_NGSPICE_STILL_H

#include "deaspice/model.h"
#include "scene/line.h"
#include "engine/ngspice/library.h"

/* Solves the points of a line; its rows are those of @p rows that the line says. */
dea_status dea_ngspice_still(dea_ngspice *library, const dea_scene *scene, const dea_model *model, const dea_line *line,
                             dea_row *rows, dea_error *error);

#endif
