/* The moving network of one run: what every engine in the time and frequency domain, and every row of them, is made from.
 *
 *   m u'' + r u' + sum_a B_a(u) [ S_a(u) + tau_KV S_a'(u) u' + sum_i c_i (S_a - z_ai) ] + G(u) = phi(u) U^2,
 *   z_ai' = (S_a - z_ai)/tau_i
 *
 * with the film voltage U, the changes S_a of the long-term stresses from rest on their levers B_a (one with B = 1 and S = K u
 * where the springs are linear, one of Eq. 18, three of rings), what the stress at rest does by its levers, less what is steady, G,
 * c_i = g_i/g_inf, phi = (1/2) dC/du. Relaxed, z_ai = S_a. With an electrical port: d(C U)/dt + U/R_p = i, where
 * i = (U_s - U)/R_s, held within -I ... I by a source that gives no more than I: what it does not give is heat in it. */
#ifndef DEA_DYNAMICS_H
#define DEA_DYNAMICS_H

#include "drive/signal.h"
#include "network/balance.h"

/* Most stresses of a film, and most states of its branches: z_ai stands at a branch_count + i. */
enum { DEA_STRESSES = DEA_NETWORK_STRESSES, DEA_RELAXED_MAX = DEA_STRESSES * DEA_PRONY_MAX };

typedef struct dea_branch {
    double share; /* c = g/g_inf, of the stress S [1] */
    double tau;   /* [s] */
} dea_branch;

typedef struct dea_dynamics {
    dea_point point;
    const dea_model *model;
    double mass;                        /* [kg], 0: none */
    double retardation;                 /* tau_KV [s], 0: none */
    double damping;                     /* r of the load [N s/m], 0: none */
    double rest;                        /* u without voltage [m]: 0 but under a steady force; NAN: there is no equilibrium */
    double held;                        /* sum of c_i of branches that are springs alone: S is that of film and these [1] */
    bool softens;                       /* the voltage changes the stiffness */
    dea_branch branches[DEA_PRONY_MAX]; /* slowest first, those of equal time drawn together */
    size_t branch_count;
    size_t stress_count;                   /* of the S_a, >= 1 */
    double total_share;                    /* sum of their c_i */
    bool port;                             /* a resistance is given: current and charge are wanted */
    double series;                         /* R_s [Ohm], 0: the film sees the source */
    double dropped;                        /* R_s that is left out and shows in the first sample alone [Ohm], else 0 */
    bool biased;                           /* the run starts at the equilibrium under its first voltage */
    bool clamped;                          /* mass, damper or resistance, left out or not, hold the film there for the moment */
    bool heavy;                            /* a mass, left out or not, holds a film in time for the moment */
    double limit;                          /* I [A], +inf: any */
    double conductance;                    /* 1/R_p [S], 0: no leakage */
    double radius;                         /* r_a [m] */
    double focal_length, refractive_index; /* NAN: no optics */
    bool linear;                           /* one stress K u on the lever 1, without G, as without a skin and a load, as without a skin */
    bool framed;                           /* its stresses end at centre and frame: those of a hyperelastic film; linear models have a linear skin */
    dea_tape tape;                         /* owned: G, phi, C, then S_a and B_a in turn */
    double seen;                           /* u that the tape has its values at [m] */
    dea_balance balance;                   /* owned: rows */
} dea_dynamics;

/* The functions of u and their slopes. */
typedef struct dea_edge {
    double stress[DEA_STRESSES], stress_slope[DEA_STRESSES]; /* S_a [Pa or N], stress_count of them */
    double lever[DEA_STRESSES], lever_slope[DEA_STRESSES];   /* B_a [m^2 or 1] */
    double tension, tension_slope;                           /* G [N] */
    double push, push_slope;                                 /* phi [N/V^2] */
    double capacitance, capacitance_slope;                   /* C [F]; its slope is 2 phi */
} dea_edge;

/* Compiles the network of a scene whose axes are at their place; the caller ends it with dea_dynamics_close(), also after a
 * failure. DEA_ERROR_UNSUPPORTED for a model that is not dynamic, DEA_ERROR_USAGE for numbers out of range, DEA_ERROR_MEMORY. */
dea_status dea_dynamics_open(const dea_scene *scene, const dea_model *model, dea_dynamics *dynamics, dea_error *error);
void dea_dynamics_close(dea_dynamics *dynamics);

/* All of them but the functions of u, which are none of a film with more nodes than one: point, masses, damper, branches, port. */
dea_status dea_dynamics_settle(const dea_scene *scene, const dea_model *model, dea_dynamics *dynamics, dea_error *error);

/* The stresses, as many as the dynamics have, and phi under 1 V, of a network that was built under 1 V for these dynamics. */
void dea_dynamics_stresses(const dea_dynamics *dynamics, dea_network *network, dea_network_stress *stresses);
dea_expr dea_dynamics_push(const dea_dynamics *dynamics, dea_network *network);
/* Sets damper and branches from the scene's material and reduction anew; false where no long-term stress is left. */
bool dea_dynamics_relax(dea_dynamics *dynamics, const dea_scene *scene);
/* Coefficients of a network whose springs are linear. */
dea_linear dea_dynamics_linear(const dea_dynamics *dynamics);

dea_edge dea_dynamics_edge(dea_dynamics *dynamics, double u);
/* What the film holds against u but for its damper, sum B_a [S_a + sum c_i (S_a - z_ai)] + G [N]; z NULL: relaxed. Its slope over
 * u [N/m] with the branches held at z; z NULL: with them relaxed. */
double dea_edge_held(const dea_dynamics *dynamics, const dea_edge *edge, const double *z);
double dea_edge_held_slope(const dea_dynamics *dynamics, const dea_edge *edge, const double *z);
/* sum B_a S_a' [N/m], which damper and branches scale; and sum B_a' S_a' [N/m^2]: its slope but for S''. */
double dea_edge_viscous(const dea_dynamics *dynamics, const dea_edge *edge);
double dea_edge_viscous_slope(const dea_dynamics *dynamics, const dea_edge *edge);
/* Mechanical resistance of damper and load, tau_KV sum B_a S_a' + r [N s/m]. */
double dea_edge_resistance(const dea_dynamics *dynamics, const dea_edge *edge);
/* Sets z to the branches relaxed at the edge. */
void dea_edge_relax(const dea_dynamics *dynamics, const dea_edge *edge, double *z);
/* Number of the z. */
static inline size_t dea_dynamics_states(const dea_dynamics *dynamics)
{
    return dynamics->stress_count * dynamics->branch_count;
}
/* Static displacement under film voltage U from the model's own equation; false where there is none. */
bool dea_dynamics_equilibrium(const dea_dynamics *dynamics, double voltage, double *u);
/* Where a run begins under the first @p source voltage, and what of that the film has: rest without voltage, or from its bias the
 * equilibrium; the branches are relaxed there. False where there is none. */
bool dea_dynamics_begin(const dea_dynamics *dynamics, bool from_bias, double source, double *u, double *voltage);
/* Net stiffness of the relaxed film dR/du - dF/du at u under film voltage U [N/m]; relaxed false: with the branches held. */
double dea_dynamics_stiffness(dea_dynamics *dynamics, double u, double voltage, bool relaxed);
/* Stiffness with the branches held at z that a film without mass and damper stays by: behind a series resistance its charge holds it,
 * which cannot jump, so that it passes the fold of the voltage: dR/du - dF/du at constant U, and (2 phi U)^2/C more [N/m]. */
double dea_dynamics_hold(dea_dynamics *dynamics, double u, double voltage, const double *z);
/* A displacement that is large for this film under that voltage: its size for tolerances [m], > 0. */
double dea_dynamics_scale(dea_dynamics *dynamics, double voltage);

/* Without mass and damper the displacement follows the rest: solves the edge equation for u, from @p u on; false without a
 * solution connected to it (pull-in). */
bool dea_dynamics_follow(dea_dynamics *dynamics, double voltage, const double *z, double *u);
/* Velocity that goes with u, the film voltage, its slope and z where there is no mass (with mass it is a state) [m/s]. */
double dea_dynamics_velocity(dea_dynamics *dynamics, double u, double voltage, double slope, const double *z);
/* The same behind a series resistance, where the film voltage has that @p slope only at constant u: U' = slope - U C'/C v. */
double dea_dynamics_velocity_charged(dea_dynamics *dynamics, double u, double voltage, double slope, const double *z);

/* True where disc and annulus both are there and, with an electrical port, a capacitance is: that of the linear models falls to
 * zero before the electrode is gone, and what charges it ends there. */
bool dea_dynamics_inside(dea_dynamics *dynamics, double u);

/* True where damper or load resist the velocity. */
bool dea_dynamics_is_damped(const dea_dynamics *dynamics);
/* True without mass and without what resists. */
bool dea_dynamics_is_free(const dea_dynamics *dynamics);
/* Drops a mass that a damper outweighs: it only matters for a moment m/r behind an edge, and then to m K/r^2 of the displacement. */
void dea_dynamics_lighten(dea_dynamics *dynamics, double accuracy);

/* State of the moving network at one time. */
typedef struct dea_moment {
    double time;
    double source;       /* source voltage [V] */
    double voltage;      /* film voltage [V] */
    double slope;        /* of the film voltage [V/s], used where there is no series resistance */
    double u, v;         /* [m], [m/s] */
    bool charging;       /* the slope of the charge is known better than the small drop over R_s: */
    double charge_slope; /* [A] */
    const double *charge_slopes; /* those of the charges along an electrode with a sheet resistance [A]; NULL: not known so well */
} dea_moment;

/* At the first moment of a film at its bias the branches have relaxed and the charge rests: of forces that cancel nothing is
 * left. So is the velocity 0 or, where nothing holds the film, that of its springs under a sloping voltage. A film that begins
 * without bias and has a mass, left out or not, rests where it is without voltage, however that jumps. Leaves other moments. */
void dea_dynamics_start(dea_dynamics *dynamics, dea_moment *moment);
/* Fills a row; its state says slack or breakdown. A displacement past what the film can do is pull_in: false, as for all that
 * follows. */
bool dea_dynamics_sample(dea_dynamics *dynamics, const dea_moment *moment, dea_sample *sample);
/* Current of the source behind its resistance, from the drop U_s - U [A]. */
double dea_dynamics_flow(const dea_dynamics *dynamics, double drop);
/* The drop over that at which the source gives its limit, less 1: >= 0 where it does, -1 without a limit. */
double dea_dynamics_excess(const dea_dynamics *dynamics, double drop);
/* Film voltage at rest under a voltage of the source [V]. */
double dea_dynamics_rest(const dea_dynamics *dynamics, double source);
/* Current of the source at a moment [A]. */
double dea_dynamics_current(dea_dynamics *dynamics, const dea_moment *moment);
/* A row without numbers but time and voltage. */
dea_sample dea_sample_refused(double time, double voltage, dea_state state);
/* Such rows of a run from number @p from on. */
void dea_samples_refuse(const dea_scene *scene, const dea_signal *signal, size_t from, dea_state state, dea_sample *samples);

/* Energy balance of a run, from the states between its samples. */
typedef struct dea_audit {
    double work;       /* put in by the source; without series resistance what it does mechanically and to the leakage [J] */
    double dissipated; /* in resistances and dampers [J] */
    double branch;     /* work done on the branches [J] */
    double largest;    /* of the energies seen [J] */
} dea_audit;

/* Adds @p weight [s] times the powers at a moment; z: states of the branches. */
void dea_audit_add(dea_audit *audit, dea_dynamics *dynamics, const dea_moment *moment, const double *z, double weight);
/* Adds a jump of the displacement from u to @p to at constant z (no mass, no damper). */
void dea_audit_jump(dea_audit *audit, dea_dynamics *dynamics, double u, double to, const double *z);
/* Energies between a first and a last moment, into the summary. */
void dea_audit_close(const dea_audit *audit, dea_dynamics *dynamics, const dea_moment *first, const double *first_z,
                     const dea_moment *last, const double *last_z, dea_summary *summary);

#endif
