/* The moving membrane of one run as a problem of SUNDIALS, in SI units and with only the unknowns that the scene needs:
 *
 *   u [nodes]   displacements; with mass states, with a damper alone u' follows from them, with neither algebraic
 *   v [nodes]   velocities, with mass
 *   z           stresses that the branches have relaxed from, as the membrane numbers them
 *   q           charge of the film, with series resistance, or charges along electrodes with a sheet resistance
 *
 *   u' = v,  v' = F/m,  z' = (S - z)/tau,  q' = (U_s - U)/R_s - U/R_p;   without mass 0 = F, a damper's v being u'. */
#ifndef DEA_RINGS_MOTION_STATE_H
#define DEA_RINGS_MOTION_STATE_H

#include "drive/signal.h"
#include "network/sheet.h"

typedef struct dea_rings_motion {
    const dea_membrane *membrane; /* borrowed, as all here */
    const dea_signal *signal;
    const dea_segment *segment; /* at which times are counted from its begin */
    size_t nodes, count;        /* of u, of unknowns */
    size_t z, q;                /* where they are; v follows u where the film is heavy */
    size_t charges;             /* of q */
    double shares[DEA_SHEET_PLACES]; /* of each in the capacitance at rest [1] */
    double charging;            /* fastest rate of the charges at rest, no less than it is [1/s] */
    bool heavy, damped, charged;
    double length, speed, stress, charge; /* sizes of the unknowns, the charge that of the film [m, m/s, Pa, C] */
    dea_membrane_rest rest;
} dea_rings_motion;

/* The film at a state. */
typedef struct dea_rings_state {
    dea_membrane_look look;
    double x[DEA_MEMBRANE_RINGS][2]; /* viscous and branch stresses */
    double push[DEA_RINGS_NODES];
    double force[DEA_RINGS_NODES];
    dea_charges charges;
    double voltage; /* of the film, the mean of it where its electrode has a sheet resistance [V] */
    double source;  /* [V] */
} dea_rings_state;

/* Lays out the unknowns. */
void dea_rings_motion_lay(const dea_membrane *membrane, const dea_signal *signal, dea_rings_motion *motion);
/* And tells their sizes from the film at rest; false where that is not stable. */
bool dea_rings_motion_open(const dea_membrane *membrane, const dea_signal *signal, dea_rings_motion *motion);
static inline bool dea_rings_algebraic(const dea_rings_motion *motion)
{
    return !motion->heavy && !motion->damped;
}

/* Looks at y, without forces; false where the film cannot be. */
bool dea_rings_glance(const dea_rings_motion *motion, double time, const double *y, dea_rings_state *state);
/* Looks at y; @p v: the velocities, NULL: 0. False where the film cannot be. */
bool dea_rings_look(const dea_rings_motion *motion, double time, const double *y, const double *v, dea_rings_state *state);
/* Rates of z and q in a vector of all unknowns. */
void dea_rings_relaxing(const dea_rings_motion *motion, const dea_rings_state *state, const double *y, double *rates);
/* y' at y: what stands there is replaced. False where the film cannot be or nothing holds it. */
bool dea_rings_rates(const dea_rings_motion *motion, double time, const double *y, double *rates);
/* Those of the displacements of a film without mass alone, from the rates of z and q that stand there. */
bool dea_rings_massless(const dea_rings_motion *motion, double time, const double *y, double *rates);

/* The matrix of Newton's method with all unknowns but u eliminated. */
typedef struct dea_rings_schur {
    double pace;                        /* alpha: y' = alpha y + ... of the method [1/s] */
    double slope[DEA_MEMBRANE_RINGS][2][2]; /* dS_a/dlambda_b [Pa] */
    double stretch[DEA_MEMBRANE_RINGS][2];
    double pull[DEA_SHEET_PLACES][DEA_RINGS_NODES];        /* P: dF/dV_k at constant u, which is C_k dF/dq_k [N/V] */
    double inverse[DEA_SHEET_PLACES * DEA_SHEET_PLACES];   /* of C + Y/alpha [1/F] */
    double capacitances[DEA_SHEET_PLACES];                 /* [F] */
} dea_rings_schur;

/* Prepares it at a state and writes the symmetric matrix over u [N/m]; false where LAPACK fails. */
bool dea_rings_schur_fill(const dea_rings_motion *motion, const dea_rings_state *state, double pace, dea_rings_schur *schur,
                          double *matrix);
/* Right-hand side over u for one over all unknowns [N]. */
void dea_rings_schur_reduce(const dea_rings_motion *motion, const dea_rings_schur *schur, const double *b, double *reduced);
/* All unknowns from u, which stands in x already. */
void dea_rings_schur_expand(const dea_rings_motion *motion, const dea_rings_schur *schur, const double *b, double *x);

/* Moves the displacements of a film without mass and damper to where they are held with its branches and charges as they are; false
 * where there is no such place. */
bool dea_rings_settle(const dea_rings_motion *motion, double *y);
/* The state at the begin of a run; false without a stable equilibrium. */
bool dea_rings_start(const dea_rings_motion *motion, bool from_bias, double *y);
/* Net stiffness of a film without mass and damper against its voltage, over that at rest; 0 where it is not stable, or has lost
 * its ellipticity with nothing that damps it. 1 for what holds. */
double dea_rings_firmness(const dea_rings_motion *motion, double time, const double *y);
/* Largest magnitude of the eigenvalues at rest: what an explicit method must resolve [1/s]. */
double dea_rings_stiffest(const dea_rings_motion *motion);

/* How fast the slowest mode dies away at least, 0: not at all [1/s]. */
double dea_rings_decay(const dea_rings_motion *motion);

/* The moment of a state. */
dea_moment dea_rings_moment(const dea_rings_motion *motion, double time, const dea_rings_state *state);

#endif
