/* The equilibrium of a film on whose edge other things act too: springs k(u), a force F, and a second film with its own voltage.
 *
 *     held(u) + held_2(u) + k(u) = F + push_2(u) + push(u)
 *
 * F and the second film's voltage come first: rest under load is the equilibrium that is reached from u = 0 as both grow together;
 * from there the square of the film's own voltage grows. Where either way folds the row is pull-in. */
#ifndef DEA_LOADED_H
#define DEA_LOADED_H

#include "model/models.h"

/* Who knows what a film does at an edge that is held, as a model's hold(). */
typedef struct dea_holder {
    bool (*hold)(void *user, const dea_point *point, double strain, dea_hold *hold);
    void *user;
    bool endless; /* its films are linear: they go on past centre and frame */
    double rough; /* error of its forces, relative [1] */
} dea_holder;

/* The row of a point whose edge is held, as dea_model_hold() has it. */
void dea_loaded_hold(const dea_holder *holder, const dea_point *point, double displacement, dea_row *row);
/* Rows of a study of forces. DEA_ERROR_USAGE: a number is out of its range. */
dea_status dea_loaded_curve(const dea_scene *scene, void (*hold)(void *user, const dea_point *point, double displacement, dea_row *row),
                            void *user, dea_row *rows, dea_error *error);

/* Fills the row of a point by the holds of its films. */
void dea_loaded_solve(const dea_holder *holder, const dea_point *point, dea_row *row);

#endif
