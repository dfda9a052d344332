/* Truths: what a scene's film does, by the equations of the models in long double, nothing of the engines, the laws or the models
 * of the library; each says how far off it may be itself. */
#ifndef DEA_TRUTHS_H
#define DEA_TRUTHS_H

#include "deaspice/deaspice.h"
#include "jet.h"

/* ---- laws (law.c) */

/* One energy: its key in a scene, which of its constants are moduli (bit i: constant i), and its principal Cauchy stress
 * sigma_1(l1, l2) [Pa], NAN where the energy has ended. */
typedef struct true_law {
    const char *name;
    unsigned moduli;
    jet (*stress)(const long double *constants, jet l1, jet l2);
} true_law;

/* NULL: there is none. */
const true_law *true_law_find(const char *name);

/* ---- the film in long double (film.c) */

/* Changes of the nominal stresses from rest and the tangent moduli [Pa]. */
typedef struct true_stress {
    long double p1, p2;
    long double w11, w12, w22;
} true_stress;

/* A scene's film, geometry and model, once all axes are at their place. */
typedef struct true_film {
    const char *model;
    bool dot;
    const true_law *law;
    long double constants[DEA_LAW_CONSTANTS]; /* long-term */
    long double prestretch, permittivity;     /* [1], [F/m] */
    long double tension;                      /* nominal stress at rest [Pa] */
    true_stress rest;                         /* moduli at rest */
    long double modulus, breakdown;           /* Y [Pa], [V/m] */
    long double frame, divide, coverage;      /* r, r_a [m], B */
    long double thickness;                    /* H [m] */
    long double kept;                         /* share of the source voltage that the film sees at rest */
    long double mass, retardation;            /* [kg], [s], 0: none */
    long double share[DEA_PRONY_MAX], tau[DEA_PRONY_MAX], total_share; /* c_i = g_i/g_inf */
    size_t branches;
    long double series, conductance; /* [Ohm], [S] */
    long double focal_length, index; /* NAN: no optics */
} true_film;

/* m u'' + sum A [S + tau S' u' + branches] + G = phi U^2, with G what the stress at rest does by areas that change. */
enum { TRUE_STRESSES = 3 };

typedef struct true_edge {
    int count; /* of the A and S */
    jet area[TRUE_STRESSES], stress[TRUE_STRESSES];
    jet tension, push;
    long double capacitance;
} true_edge;

/* sum A S', sum A S + G and the slope of that. */
long double edge_viscous(const true_edge *edge);
jet edge_relaxed(const true_edge *edge);

/* Under equal stretches: sigma and its derivatives over the stretch. */
jet film_cauchy(const true_film *film, long double stretch);
/* Change of sigma from rest by a strain of both directions. */
long double film_cauchy_change(const true_film *film, long double strain);
/* At stretches that have changed by d1 and d2 from the pre-stretch. */
true_stress film_stress(const true_film *film, long double d1, long double d2);
true_film film_of(const dea_scene *scene, const dea_model *model);
true_edge film_edge(const true_film *film, long double u);
/* A row of the film: strain, F_DEA [N], largest true field [V/m], capacitance [F] and film voltage [V], and what follows from them. */
typedef struct true_numbers {
    long double strain, force, field, capacitance, voltage;
    bool taut;
} true_numbers;
dea_row film_state(const true_film *film, true_numbers numbers);
/* F_DEA as rows have it, and what else a row holds, under the film voltage. */
dea_row film_row(const true_film *film, long double u, long double voltage);
long double film_focal_length(const true_film *film, long double strain);

/* ---- truths */

/* A number of a row. */
double number_at(const void *row, size_t offset);

/* What is true of a static point: its row; how far its numbers may be off, relative; what follows from a voltage that is a little
 * less or more. */
typedef struct true_row {
    dea_row row;
    double error;
} true_row;

/* All axes of the scene at their place; the voltage multiplied. */
true_row still_truth(const dea_scene *scene, const dea_model *model, double factor);
/* The model `field`, under a film voltage (membrane.c). */
true_row membrane_truth(const true_film *film, long double voltage);
/* Displacement at rest under a film voltage; NAN: pull-in. Dynamic models. */
long double still_displacement(const true_film *film, long double voltage);

/* A run: rows in order (as the scene's layout has them), their errors relative to the peaks. */
typedef struct true_run {
    dea_sample *samples; /* owned */
    size_t count, good;  /* rows, and those before a pull-in */
    double error;
    double velocity_error, current_error; /* [m/s], [A] */
    double means[DEA_WINDOWS], mean_error; /* of u over the windows, NAN behind the end of the motion [m] */
    double steps;
    const char *why; /* NULL: judged, else why the truth was not found */
} true_run;

true_run moving_truth(const dea_scene *scene, const dea_model *model, double factor);
void true_run_free(true_run *run);

/* Fills the rows of a frequency response; returns its error. */
double response_truth(const dea_scene *scene, const dea_model *model, dea_response *rows);

#endif
