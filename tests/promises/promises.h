/* Promises of accuracy: rows that an engine delivers, against truths that are found another way. A truth uses the equations of
 * the models in long double, nothing of the engines, and says how far off it may be itself. */
#ifndef DEA_PROMISES_H
#define DEA_PROMISES_H

#include <stdint.h>

#include "deaspice/deaspice.h"

/* ---- the film in long double (film.c) */

/* A function of the displacement with its first two derivatives. */
typedef struct jet {
    long double value, slope, curve;
} jet;

/* A scene's film, geometry and model, once all axes are at their place. */
typedef struct true_film {
    const char *model;
    bool dot;
    long double yeoh[DEA_YEOH_TERMS];     /* long-term [Pa] */
    long double prestretch, permittivity; /* [1], [F/m] */
    long double modulus, breakdown;       /* Y [Pa], [V/m] */
    long double frame, divide, coverage;  /* r, r_a [m], B */
    long double thickness;                /* H [m] */
    long double kept;                     /* share of the source voltage that the film sees at rest */
    long double mass, retardation;        /* [kg], [s], 0: none */
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

/* Yeoh film under equal stretches: sigma and its derivatives over the stretch. */
jet film_cauchy(const true_film *film, long double stretch);
/* Change of sigma from rest by a strain of both directions. */
long double film_cauchy_change(const true_film *film, long double strain);
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

/* ---- random scenes (draw.c) */

/* YAML of the scene of that number; freed by the caller. */
char *draw_scene(uint64_t seed, size_t number);
/* The same of one kind of transients, which names its accuracy (stalls.c). */
char *draw_stall(uint64_t seed, size_t number);

/* ---- judging (judge.c) */

enum { MOST_REASONS = 48, REASON_LENGTH = 320, ACCURACIES = 4, STUDIES = 3, MOST_ENGINES = 4 };

/* How often something was said. */
typedef struct reason {
    char text[REASON_LENGTH];
    size_t count;
} reason;

typedef struct tally {
    size_t scenes;    /* runs: scene x accuracy */
    size_t delivered; /* with all rows judged */
    size_t refused, failed, unjudged, broken;
    double worst;   /* delivered over wanted error, of promises that were kept */
    double seconds; /* of processors */
    reason reasons[MOST_REASONS];
} tally;

/* One scene with what is true of it, by all accuracies. */
typedef struct judged {
    dea_scene scene;
    size_t number;
    void *truth;    /* points as the layout has them */
    double *errors; /* of each point */
    dea_layout layout;
    size_t points;
    true_run *runs;  /* of transients */
    const char *why; /* NULL, or why nothing is judged */
} judged;

/* A number of a row. */
double number_at(const void *row, size_t offset);

bool judge_open(judged *j, const char *text, size_t number);
void judge_close(judged *j);
/* Runs an engine at one accuracy; adds to the tally. True where the promise was broken; *text then says how. */
bool judge_engine(judged *j, const dea_engine *engine, double accuracy, tally *t, char *text, size_t size);

/* What columns of transients that follow from displacement and charge are off by (columns.c). */
typedef struct column_error {
    const char *column;
    size_t row;
    double error; /* over what the column promises for an accuracy of 1 */
} column_error;

/* Worst of them in the rows of a point, of those whose truth is good to a tenth of what it judges. */
column_error columns_error(const judged *j, size_t point, const dea_sample *rows, double accuracy);

/* Worst mean of a point's windows that its rows cover, over the peak; INFINITY where a film that never ends has none. */
column_error means_error(const judged *j, size_t point, const dea_summary *summary, double peak, double accuracy);

/* The tightest accuracy that the engine promises for such a study. */
double best_accuracy(const dea_engine *engine, const dea_scene *scene);

#endif
