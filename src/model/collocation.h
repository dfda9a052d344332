/* The exact membrane by collocation, many points abreast. */
#ifndef DEA_COLLOCATION_H
#define DEA_COLLOCATION_H

#include "deaspice/model.h"

/* Solves @p count points of one film within @p accuracy; solved[i] says whether row i was filled. Where not, the equilibrium is far
 * from rest or near a limit of the film, there is none, its electrodes have a skin, or the accuracy is out of reach: dea_field_solve() tells. A row does not
 * depend on the other points. */
void dea_collocation_solve(const dea_point *points, size_t count, double accuracy, dea_row *rows, bool *solved);

#endif
