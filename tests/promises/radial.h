/* The membrane along its radius, moving or not, by finite elements of high degree with Gauss's rule, in long double (physics.md,
 * sections 3, 7 and 8): u(R) of shapes that are polynomials in R, 0 at centre and frame,
 *
 *   F_n = sum_places 2 pi n H R dR [ phi_n' S_1 + phi_n/R S_2 ] + at the edge (K u + r u' - f),     M u'' + F = 0,
 *   S_a = (sigma_a - P_0 d_a)/lambda_a + skin_a - (U/H)^2 g lambda_b + x_a/lambda_a,   g = d(eps a^2/2)/da, a = lambda_1 lambda_2,
 *   x_a = tau_KV sigma_a' + sum_i c_i (sigma_a - z_ai),   z_ai' = (sigma_a - z_ai)/tau_i,
 *
 * with the changes sigma_a of the long-term Cauchy stresses from rest and d_a of the stretches. */
#ifndef DEA_RADIAL_H
#define DEA_RADIAL_H

#include <complex.h>

#include "legendre.h"
#include "truths.h"

enum {
    RADIAL_DEGREE = 8,
    RADIAL_SHAPES = RADIAL_DEGREE + 1,
    RADIAL_PLACES = RADIAL_DEGREE + 2,
    RADIAL_ELEMENTS = 56,
    RADIAL_MOST = RADIAL_ELEMENTS * RADIAL_DEGREE,
    RADIAL_SPOTS = RADIAL_ELEMENTS * RADIAL_PLACES
};

/* A symmetric matrix within its band: row i holds the columns i - DEGREE ... i. */
typedef long double radial_band[RADIAL_MOST][RADIAL_DEGREE + 1];

/* A pair for each place: of stresses, or of rates. */
typedef long double radial_pairs[RADIAL_SPOTS][2];

typedef struct radial {
    const true_film *film;
    int elements, disc;                      /* of all, of the disc: the first ones */
    int size, edge, spots;                   /* unknowns, the one at r_a, places */
    long double radius[RADIAL_ELEMENTS + 1]; /* R of the ends of the elements [m] */
    shape at[RADIAL_PLACES], ends[2];
    long double place[RADIAL_PLACES], weight[RADIAL_PLACES];
    radial_band mass; /* with that of electrodes and load [kg] */
    bool heavy;
} radial;

/* Elements no wider than the film over @p fineness, and in the annulus no wider than their radius; disc and annulus have @p more than
 * that each, so that one which is finer is so in both, however narrow. False: there are too many. */
bool radial_open(radial *r, const true_film *film, double fineness, int more);

/* Changes of the stretches at a place, or their rates. */
void radial_strain(const radial *r, const long double *u, int spot, long double d[2]);

/* The film at u under a voltage: dF/du at constant x, what a factor of the relaxed slopes dsigma/dlambda adds to it, phi = dC/du/2
 * and C; the smallest dS_1/dlambda_1, with that factor's part @p share. */
typedef struct radial_look {
    radial_band elastic, viscous;
    long double push[RADIAL_MOST];
    long double capacitance;
    long double firmness; /* [Pa] */
} radial_look;

/* x NULL: 0. False where there is no such film. */
bool radial_look_at(const radial *r, const long double *u, long double voltage, radial_pairs x, long double share, radial_look *look);

/* The stresses of a film whose Cauchy stresses have changed by sigma: S of a place. */
void radial_nominal(const radial *r, int spot, const long double d[2], long double voltage, const long double sigma[2],
                   const long double x[2], long double s[2]);
/* C of a place [F]; 0 without electrode. */
long double radial_capacitance(const radial *r, int spot, const long double d[2]);
/* Adds what stresses S of a place do to its unknowns. */
void radial_pull(const radial *r, int spot, const long double s[2], long double *force);

/* e dF/du + v dsigma/dlambda + i M + d at the edge, factored. */
typedef struct radial_system {
    long double complex band[RADIAL_MOST][RADIAL_DEGREE + 1];
    bool definite; /* all pivots have a positive real part */
} radial_system;

typedef struct radial_factors {
    long double complex elastic, viscous, inertia, damper;
} radial_factors;

void radial_factor(const radial *r, const radial_look *look, radial_factors by, radial_system *system);
void radial_solve(const radial *r, const radial_system *system, long double complex *x);
/* The same of a real right-hand side with a real system. */
void radial_solve_real(const radial *r, const radial_system *system, long double *x);

/* What acts on a film at rest. */
typedef struct radial_load {
    long double square; /* of the film voltage [V^2] */
    long double force;  /* on the edge [N] */
} radial_load;

/* Moves u from the equilibrium under one load to that under another along stable ones; with the branches held where sum c z are
 * @p held (NULL: relaxed). False where there is none. */
bool radial_settle(const radial *r, radial_load from, radial_load to, radial_pairs held, long double *u);
/* The relaxed equilibrium that is connected to rest. */
bool radial_still(const radial *r, long double voltage, long double *u);

/* How far a row's state is from the next one, relative. */
typedef struct radial_margins {
    double tension, strength;
} radial_margins;

dea_row radial_row(const radial *r, const long double *u, long double voltage, radial_margins *margins);

/* Transients and frequency responses of `field`. */
true_run radial_motion(const dea_scene *scene, const dea_model *model, double factor);
double radial_response(const dea_scene *scene, const dea_model *model, dea_response *rows);

#endif
