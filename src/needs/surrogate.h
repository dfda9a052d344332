/* A linear stand-in for a moving scene, solved in closed form: what an element changes is the difference of two of its answers,
 * with the element and without. A film that is not linear is taken about rest, about its equilibrium under the largest voltage,
 * and where it is softest on its way, as far as it swings. Behind a series resistance it charges with the time constant of its
 * largest capacitance: a voltage of straight lines between points of that exponential, a sine of its steady state. */
#ifndef DEA_SURROGATE_H
#define DEA_SURROGATE_H

#include "engine/direct/walk.h"

enum { DEA_SURROGATE_POINTS = 6 };

/* An operating point. Behind a series resistance each stands twice: the current that a moving film draws damps it, by most under
 * the largest voltage, and before the film is charged not at all. */
typedef struct dea_surrogate_point {
    double passive, viscous; /* of the relaxed film's force its slope over u, and sum B_a S_a', without held branches [N/m] */
    double tension;          /* of passive what held branches leave as it is, G' [N/m] */
    double push, push_slope; /* phi [N/V^2], dphi/du [N/m/V^2] */
    double drag;             /* of that current [N s/m] */
    double square;           /* U^2 under which the voltage's stiffness counts as constant [V^2]; 0: it follows the voltage */
    double excess;           /* displacement of the stand-in under the largest voltage over that of the film, >= 1 [1] */
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
    double loaded;            /* equilibrium of the relaxed film under the source's largest voltage [m] */
    double largest;           /* |U| that the film sees over the run [V] */
    double capacitance;       /* larger one of rest and of the loaded film [F] */
    double least_capacitance; /* the smaller one */
    double variation; /* of the film's stiffness on its way, or of du/d(U^2): largest over smallest - 1; 0: it is the film */
    double coupling;  /* relative change of the force at constant charge that the change of the capacitance makes [1] */
    double swing;     /* largest amplitude of a swing about the equilibrium, over that under the largest voltage [1] */
    double fading;    /* time in which what the mass does dies away [s], 0 without mass */
} dea_surrogate;

/* Voltage that the film sees behind what is left of the series resistance. */
const dea_signal *dea_surrogate_signal(const dea_surrogate *surrogate);
/* Time constant with which the film charges through it [s], 0 without. */
double dea_surrogate_lag(const dea_surrogate *surrogate);

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
