/* The equilibrium of a film on whose edge other things act too: a spring k, a force F, and a second film with its own voltage.
 *
 *     held(u) + held_2(u) + k u = F + push_2(u) + push(u)
 *
 * F and the second film's voltage come first: rest under load is the equilibrium that is reached from u = 0 as both grow together;
 * from there the square of the film's own voltage grows. Where either way folds the row is pull-in. */
#ifndef DEA_LOADED_H
#define DEA_LOADED_H

#include "model/models.h"

/* Fills the row of a point whose model is one unknown, by the holds of its films. */
void dea_loaded_solve(const dea_model *model, const dea_point *point, dea_row *row);

/* The state of a row is that of the worse film: broken down, slack. */
void dea_loaded_join(dea_row *row, const dea_point *second, const dea_found *found);

#endif
