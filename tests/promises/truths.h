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
    long double layers;              /* films of that thickness in a stack */
    long double electrostriction;    /* slope of the permittivity over the mean stretch [F/m], 0: it is that at the pre-stretch */
    const true_law *skin_law;        /* of the electrodes, NULL: they have no stiffness */
    long double skin_constants[DEA_LAW_CONSTANTS];
    long double skin;                /* their thickness over that of all layers [1] */
    long double density, coat;       /* of the film [kg/m^3], of the electrodes over the film before its pre-stretch [kg/m^2], 0: none */
    long double load_mass, load_stiffness, load_damping, load_force; /* on the edge at r_a */
} true_film;

/* A permittivity that follows the area stretch a: eps(sqrt(a)); first = d(eps a^2/2)/da/a, second = d(first a)/da [F/m]. */
typedef struct true_electric {
    long double own, first, second;
} true_electric;

true_electric film_electric(const true_film *film, long double area);

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
/* The same of the electrodes' skin, spread over the thickness of all layers. */
long double film_skin_change(const true_film *film, long double strain);
/* At stretches that have changed by d1 and d2 from the pre-stretch. */
true_stress film_stress(const true_film *film, long double d1, long double d2);
/* Those of the electrodes' skin, spread over the thickness of all layers. */
true_stress film_skin(const true_film *film, long double d1, long double d2);
/* Changes of both Cauchy stresses from rest there, and their slopes along the rates r1 and r2 of the stretches. */
void film_cauchy_along(const true_film *film, long double d1, long double d2, long double r1, long double r2, jet stress[2]);
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

/* ---- the source (source.c) */

struct dea_signal;
struct dea_segment;

/* Its voltage a time behind the begin of a segment [V], and the slope of that [V/s]. */
long double true_source(const struct dea_signal *signal, const struct dea_segment *segment, long double time);
long double true_source_slope(const struct dea_signal *signal, const struct dea_segment *segment, long double time);

/* ---- truths */

/* A number of a row. */
double number_at(const void *row, size_t offset);
/* Raises the errors to the largest differences of two runs' columns. */
void raise_errors(dea_sample *errors, const dea_sample *a, const dea_sample *b, size_t count);

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
    dea_sample errors;                    /* of each column, in its unit */
    struct radial_margins *margins;       /* of a membrane, owned: how far each row's state is from another one; NULL: not told */
    double still; /* what the largest voltage does at rest, as a linear film has it [m] */
    double means[DEA_WINDOWS], mean_error; /* of u over the windows, NAN behind the end of the motion [m] */
    double steps;
    const char *why; /* NULL: judged, else why the truth was not found */
} true_run;

true_run moving_truth(const dea_scene *scene, const dea_model *model, double factor);
void true_run_free(true_run *run);

/* Fills the rows of a frequency response; returns its error. */
double response_truth(const dea_scene *scene, const dea_model *model, dea_response *rows);

#endif
