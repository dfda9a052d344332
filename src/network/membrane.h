/* The moving membrane as a network of rings: masses at its nodes, damper and branches on the principal Cauchy stresses of its
 * rings, and its electrical port (physics: section 7).
 *
 *   m_n v_n' = F_n = phi_n U^2 - sum_rings volume lambda_pre (radial_n s_1 + hoop_n s_2),   phi_n = (1/2) dC/du_n,
 *   s_a = P_a + x_a/lambda_a,   x_a = tau_KV S_a' + sum_i c_i (S_a - z_ai),   z_ai' = (S_a - z_ai)/tau_i,
 *
 * with the changes P_a of the long-term nominal stresses from rest and S_a of the Cauchy stresses lambda_a P_a. All is 0 at rest,
 * relaxed is z_ai = S_a. Where branches are held (springs alone) they belong to P_a and S_a. The state is u, v [node_count], z
 * [dea_membrane_relaxed()], numbered by ring, then a, then branch, and the charge where there is a series resistance.
 *
 * Vectors over the nodes have node_count elements, those over the rings ring_count pairs, matrices are node_count x node_count,
 * column by column. */
#ifndef DEA_MEMBRANE_H
#define DEA_MEMBRANE_H

#include "network/dynamics.h"
#include "network/rings.h"
#include "network/sheet.h"

typedef struct dea_membrane {
    dea_dynamics film; /* all of the scene's network but its functions of u: damper, branches, port */
    dea_rings rings;
    dea_sheet sheet; /* charges and potentials of its electrodes */
    double masses[DEA_RINGS_NODES]; /* m_n [kg]; all 0: none */
    bool heavy;
    size_t own[DEA_RINGS_MOST]; /* place, among the nodes of a ring, of the one at its own radius, which alone strains its hoop */
} dea_membrane;

/* A ring at a state. */
typedef struct dea_ring_look {
    double stretch[2];     /* lambda_a [1] */
    double nominal[2];     /* P_a [Pa] */
    double cauchy[2];      /* S_a [Pa] */
    double tangent[2][2];  /* dP_a/dlambda_b [Pa] */
    double slope[2][2];    /* dS_a/dlambda_b [Pa] */
    double capacitance;    /* [F], 0 without electrode */
} dea_ring_look;

/* Where `spread`, functions that take a film voltage look at those of the rings instead. */
typedef struct dea_membrane_look {
    dea_ring_look rings[DEA_RINGS_MOST];
    bool spread;                     /* the potential is not the same all over the electrode: dea_sheet_look() */
    double voltages[DEA_RINGS_MOST]; /* then those of electroded rings [V] */
    double edge;        /* displacement of the edge [m] */
    double capacitance; /* [F] */
} dea_membrane_look;

/* Cuts the film of a scene whose axes are at their place; nothing is to be closed. DEA_ERROR_USAGE for numbers out of range. */
dea_status dea_membrane_open(const dea_scene *scene, const dea_model *model, dea_rings_mesh mesh, dea_membrane *membrane,
                             dea_error *error);

/* True where a load's damper alone would resist a membrane: its other nodes have no equation of motion then; and that in words. */
bool dea_load_stalls(const dea_scene *scene);
extern const char dea_load_stalled[];

/* Number of the z. */
static inline size_t dea_membrane_relaxed(const dea_membrane *membrane)
{
    return 2 * membrane->rings.ring_count * membrane->film.branch_count;
}

/* The rings at displacements u [m]; false where a stretch is not positive or the energy of the film has ended. */
bool dea_membrane_look_at(const dea_membrane *membrane, const double *u, dea_membrane_look *look);
/* phi_n = (1/2) dC/du_n [N/V^2]. */
void dea_membrane_push(const dea_membrane *membrane, const dea_membrane_look *look, double *push);
/* That of one electroded ring. */
void dea_membrane_push_ring(const dea_membrane *membrane, const dea_membrane_look *look, size_t r, double *push);
/* Voltage across a ring: 0 without electrode [V]. */
static inline double dea_membrane_voltage(const dea_membrane *membrane, const dea_membrane_look *look, size_t r, double voltage)
{
    return !membrane->rings.rings[r].electroded ? 0.0 : look->spread ? look->voltages[r] : voltage;
}
/* x_a of all rings [Pa]; v NULL: 0, z NULL: relaxed. */
void dea_membrane_viscous(const dea_membrane *membrane, const dea_membrane_look *look, const double *v, const double *z,
                          double (*x)[2]);
/* F_n under the film voltage [N]; x NULL: 0. */
void dea_membrane_force(const dea_membrane *membrane, const dea_membrane_look *look, double voltage, double (*x)[2],
                        double *force);
/* -dF_n/du_m at constant x_a and film voltage, and @p share times -dF_n/dv_m of a damper of 1 s on top [N/m]. x NULL: 0. With
 * x = 0 it is, about a relaxed equilibrium, the dynamic stiffness of the film without its mass for
 * share = s tau_KV + sum c_i s tau_i/(1 + s tau_i). */
void dea_membrane_stiffness(const dea_membrane *membrane, const dea_membrane_look *look, double voltage, double (*x)[2],
                            double share, double *stiffness);
/* That share of its own. */
void dea_membrane_damping(const dea_membrane *membrane, const dea_membrane_look *look, double share, double *damping);
/* True where ds_1/dlambda_1 is positive at every ring: without that the film thins somewhere at once, however fine its rings are.
 */
bool dea_membrane_elliptic(const dea_membrane *membrane, const dea_membrane_look *look, double voltage, double (*x)[2],
                           double share);
/* Stretches per time lambda_a' of the rings that go with v. */
void dea_membrane_rates(const dea_membrane *membrane, const double *v, double (*rates)[2]);
/* Subtracts from @p force what nominal stresses f_a of the rings do to the nodes. */
void dea_membrane_pull(const dea_membrane *membrane, double (*f)[2], double *force);
/* Sets z to the branches relaxed. */
void dea_membrane_relax(const dea_membrane *membrane, const dea_membrane_look *look, double *z);

/* Moves u to the equilibrium under the film voltage with the branches held at z (NULL: relaxed) that is connected to u as it
 * stands; false where there is none (pull-in). */
bool dea_membrane_follow(const dea_membrane *membrane, double voltage, const double *z, double *u);
/* The relaxed equilibrium under the film voltage that is connected to rest; false where there is none. */
bool dea_membrane_still(const dea_membrane *membrane, double voltage, double *u);
/* Undamped angular frequencies [rad/s], slowest first, of small motion about a state whose stiffness this is, which is lost;
 * shapes[k node_count + n]: mode k, of sum m_n shape_n^2 = 1 [kg^-1/2]. False without mass or where LAPACK fails; the square of a
 * frequency that is not real counts as 0. */
bool dea_membrane_modes(const dea_membrane *membrane, double *stiffness, double *frequencies, double *shapes);

/* The film at rest. */
typedef struct dea_membrane_rest {
    double compliance;        /* |displacement| of the edge over U^2 of the relaxed film [m/V^2] */
    double softness;          /* phi K^-1 phi, the branches held [N m/V^4] */
    double force;             /* |F_DEA| over U^2 [N/V^2] */
    double capacitance;       /* [F] */
    double capacitance_slope; /* |dC/du| at the edge, where all moves as a small voltage has it [F/m] */
    double slowest, fastest;  /* undamped angular frequencies, branches held [rad/s], 0 without mass */
} dea_membrane_rest;

/* False where the film is not stable at rest, or LAPACK fails. */
bool dea_membrane_at_rest(const dea_membrane *membrane, dea_membrane_rest *rest);

/* Strain, displacement, force at the edge, largest true field, C, charge and state of a film at u, as its static row has them. */
void dea_membrane_row(const dea_membrane *membrane, const dea_membrane_look *look, double voltage, const double *u, dea_row *row);
/* Current of the source at a moment [A]; its u and v are not looked at. */
double dea_membrane_current(const dea_membrane *membrane, const dea_membrane_look *look, const dea_moment *moment,
                            const double *v);
/* Fills a row of a transient from a look at u; u and v of the moment are not looked at. False, and pull_in, where it has no numbers.
 */
bool dea_membrane_sample(const dea_membrane *membrane, const dea_membrane_look *look, const dea_moment *moment, const double *u,
                         const double *v, dea_sample *sample);

/* Adds @p weight [s] times the powers at a moment to the audit. */
void dea_membrane_audit_add(dea_audit *audit, const dea_membrane *membrane, const dea_membrane_look *look, const dea_moment *moment,
                            const double *v, const double *z, double weight);
/* Adds a jump of the displacements from u to @p to at constant z (no mass, no damper). */
void dea_membrane_audit_jump(dea_audit *audit, const dea_membrane *membrane, const double *u, const double *to, const double *z);

/* What is stored at a state [J]. */
typedef struct dea_membrane_energy {
    double electric;
    double fed; /* that of it which follows the source at once: of the whole film without R_s, or of its rim */
    double elastic; /* over that at rest, without springs of branches */
    double springs; /* of the branches */
    double kinetic;
} dea_membrane_energy;

dea_membrane_energy dea_membrane_energy_of(const dea_membrane *membrane, double voltage, const double *u, const double *v,
                                           const double *z);
/* Energies between a first and a last state, into the summary. */
void dea_membrane_audit_close(const dea_audit *audit, const dea_membrane *membrane, const dea_membrane_energy *first,
                              const dea_membrane_energy *last, dea_summary *summary);

#endif
