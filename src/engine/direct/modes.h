/* Modes of the linear network under one voltage,
 *
 *   m u'' + r u' + K u + sum k_i (u - z_i) = F(t),   z_i' = q_i (u - z_i),   q_i = 1/tau_i
 *
 * By Laplace u = 1/p(s) [F + m (s u + v) + r u + sum k_i z_i/(s + q_i)] (u, v, z_i at t = 0) with the dynamic stiffness
 *
 *   p(s) = m s^2 + r s + K + sum k_i s/(s + q_i).
 *
 * Its roots are the modes: u(t) = prompt F + sum a_j, a_j' = s_j a_j + F/p'(s_j). Two roots of a network with mass, complex or
 * close to each other, are one mode whose amplitude is a dual number, so that critical damping is no special case. */
#ifndef DEA_DIRECT_MODES_H
#define DEA_DIRECT_MODES_H

#include <complex.h>

#include "deaspice/material.h"
#include "engine/direct/dual.h"

static inline double complex dea_complex(double real, double imaginary)
{
    return real + imaginary * I;
}

enum { DEA_MODES_MAX = DEA_PRONY_MAX + 2 };

typedef struct dea_chain {
    double mass;                  /* m [kg], 0: none */
    double damping;               /* r [N s/m], 0: none */
    double stiffness;             /* K [N/m] */
    size_t count;                 /* of branches */
    double spring[DEA_PRONY_MAX]; /* k_i [N/m], > 0 */
    double tau[DEA_PRONY_MAX];    /* [s], strictly falling */
    double rate[DEA_PRONY_MAX];   /* q_i [1/s] */
} dea_chain;

/* A real root, measured from the pole next to it so that both s and s + q_i keep all their digits. */
typedef struct dea_root {
    double value;   /* s [1/s] */
    size_t pole;    /* its number, or the count of branches: measured from 0 */
    double offset;  /* s + q_pole, or s [1/s] */
    double residue; /* 1/p'(s) */
} dea_root;

typedef struct dea_modes {
    dea_chain chain;
    double prompt; /* u that follows F at once where there is neither mass nor damper: 1/p(inf) [m/N] */
    dea_root roots[DEA_MODES_MAX];
    size_t count; /* of them */
    bool pair;
    double sigma, square; /* the pair: s = sigma + e, e^2 = square */
    dea_dual residue;     /* of the pair: (s - s1) (s - s2)/p(s) at sigma + e */
    double cancellation;  /* how many times larger than the static displacement its parts are */
} dea_modes;

typedef enum dea_modes_answer {
    DEA_MODES_FOUND,
    DEA_MODES_UNSTABLE, /* without mass and damper nothing holds the film */
    DEA_MODES_CLOSE     /* three roots nearly coincide */
} dea_modes_answer;

/* Finds the modes of a chain. */
dea_modes_answer dea_modes_find(const dea_chain *chain, dea_modes *modes);
/* p(s). */
double complex dea_chain_stiffness(const dea_chain *chain, double complex s);
/* s + q_i of a root. */
double dea_root_above(const dea_chain *chain, const dea_root *root, size_t branch);

typedef struct dea_amplitudes {
    double roots[DEA_MODES_MAX]; /* [m] */
    dea_dual pair;               /* its odd part is the displacement [m] */
} dea_amplitudes;

/* Amplitudes and their velocities. The second follow from the first, but the difference s_j a_j + F/p'(s_j) has no digits left
 * once a fast mode has settled, so that they move side by side. */
typedef struct dea_course {
    dea_amplitudes place; /* [m] */
    dea_amplitudes speed; /* [m/s] */
} dea_course;

/* Force and its first two derivatives [N, N/s, N/s^2]; the second is constant. */
typedef struct dea_forcing {
    double value, slope, bend;
} dea_forcing;

/* The course through the state u, v, z under a force; that of the equilibrium under it. */
dea_course dea_modes_split(const dea_modes *modes, double u, double v, const double *z, double force);
dea_course dea_modes_relaxed(const dea_modes *modes, double force);
/* Lets the force jump. */
void dea_modes_jump(const dea_modes *modes, double rise, dea_course *course);
double dea_modes_displacement(const dea_modes *modes, const dea_course *course, const dea_forcing *force);
double dea_modes_velocity(const dea_modes *modes, const dea_course *course, const dea_forcing *force);
/* States of the branches z_i from the places [m], or z_i' from the speeds [m/s]. */
void dea_modes_branches(const dea_modes *modes, const dea_amplitudes *a, double *z);

/* What a time t does to the amplitudes: their decay, and what force, slope and bend add, t^k phi_k(s t)/p'(s); to their integrals:
 * t phi_1 times what they were, and the next gain instead of each. */
typedef struct dea_advance {
    double time;
    double decay[DEA_MODES_MAX], span[DEA_MODES_MAX], gain[DEA_MODES_MAX][DEA_PHI_COUNT];
    dea_dual pair_decay, pair_span, pair_gain[DEA_PHI_COUNT];
} dea_advance;

void dea_advance_make(const dea_modes *modes, double time, dea_advance *advance);
/* Moves the course by that time; @p force is that at its begin. */
void dea_advance_take(const dea_modes *modes, const dea_advance *advance, const dea_forcing *force, dea_course *course);
/* Integral of the displacement over that time from the course on, in closed form [m s]. */
double dea_advance_integral(const dea_modes *modes, const dea_advance *advance, const dea_forcing *force,
                            const dea_course *course);

#endif
