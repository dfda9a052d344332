/* A linear stand-in for a moving scene, solved in closed form: what an element changes is the difference of two of its answers,
 * with the element and without. A film that is not linear is taken about rest and about its equilibrium under the largest
 * voltage. Behind a series resistance it charges with the time constant of its largest capacitance: a voltage of straight lines
 * between points of that exponential, a sine of its steady state. */
#ifndef DEA_SURROGATE_H
#define DEA_SURROGATE_H

#include "engine/direct/walk.h"

enum { DEA_SURROGATE_POINTS = 4 };

/* An operating point. Behind a series resistance each stands twice: the current that a moving film draws damps it, by most under
 * the largest voltage, and before the film is charged not at all. */
typedef struct dea_surrogate_point {
    double passive, viscous; /* d(A S)/du and A S' of the film without held branches [N/m] */
    double push, push_slope; /* phi [N/V^2], dphi/du [N/m/V^2] */
    double drag;             /* of that current [N s/m] */
    double square;           /* U^2 under which the voltage's stiffness counts as constant [V^2]; 0: it follows the voltage */
} dea_surrogate_point;

typedef struct dea_surrogate {
    const dea_scene *scene;  /* borrowed */
    dea_dynamics dynamics;   /* owned, as all here: nothing left out */
    dea_signal source, film; /* voltage of the source; behind the series resistance, without one no segments */
    dea_walk *walk;
    size_t *probes; /* samples that are looked at; behind them stand the means over the scene's windows */
    double *ages;   /* their times since the last corner of the voltage [s], 0 of a mean */
    size_t sampled; /* probes that are samples */
    size_t count, room;
    dea_surrogate_point points[DEA_SURROGATE_POINTS];
    int point_count;
    double largest;     /* |U| that the film sees over the run [V] */
    double capacitance; /* larger one of rest and of the loaded film [F] */
} dea_surrogate;

/* Answers at the probes, operating point after operating point: room for point_count * count. A mean has no velocity: 0. */
typedef struct dea_surrogate_answer {
    double *u, *v; /* [m], [m/s] */
} dea_surrogate_answer;

/* Opens the stand-in; the caller ends it with dea_surrogate_close(), also after a failure. *usable false with DEA_OK: the film
 * has no stable equilibrium that it could stand for. */
dea_status dea_surrogate_open(const dea_scene *scene, const dea_model *model, dea_surrogate *surrogate, bool *usable,
                              dea_error *error);
void dea_surrogate_close(dea_surrogate *surrogate);
/* Solves it with a reduction; false where that has no answer. */
bool dea_surrogate_solve(dea_surrogate *surrogate, const dea_reduction *reduction, dea_surrogate_answer answer);

#endif
