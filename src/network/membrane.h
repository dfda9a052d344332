/* The moving membrane as a network of rings: masses at its nodes, damper and branches on the principal Cauchy stresses of its
 * rings, and its electrical port (physics: section 7).
 *
 *   m_n v_n' = F_n = phi_n U^2 - sum_rings volume lambda_pre (radial_n s_1 + hoop_n s_2),   phi_n = (1/2) dC/du_n,
 *   s_a = P_a + x_a/lambda_a,   x_a = tau_KV S_a' + sum_i c_i (S_a - z_ai),   z_ai' = (S_a - z_ai)/tau_i,
 *
 * with the changes P_a of the long-term nominal stresses from rest and S_a of the Cauchy stresses lambda_a P_a. All is 0 at rest,
 * relaxed is z_ai = S_a. Where branches are held (springs alone) they belong to P_a and S_a. The state is u, v [nodes], z
 * [dea_membrane_relaxed()], numbered by ring, then a, then branch, and the charge where there is a series resistance.
 *
 * A second film on the edge has rings of its own on the same mesh, behind those of the first, and nodes behind those but for the edge,
 * which both share. It has a damper, no branches and a voltage that stays.
 *
 * Vectors over the nodes have `nodes` elements, those over the rings ring_total pairs, matrices are nodes x nodes, column by
 * column. */
#ifndef DEA_MEMBRANE_H
#define DEA_MEMBRANE_H

#include "network/dynamics.h"
#include "network/rings.h"

/* An electrode with a sheet resistance; network/sheet.h has its equations. */
enum { DEA_SHEET_PLACES = DEA_RINGS_DEGREE + 1 };

typedef struct dea_sheet {
    size_t charges; /* that are unknown: of the places, but not of a rim at the source's own voltage; behind R_s alone 1, else 0 */
    size_t places;  /* rings first ... first + places - 1 of the electrode, the last one fed; 0: it has one potential */
    size_t first;
    double conductance[DEA_SHEET_PLACES];                /* 2 pi R dR/rho of each [S m^2] */
    double gradient[DEA_SHEET_PLACES][DEA_SHEET_PLACES]; /* D: dV/dR at a place by the potential at another [1/m] */
    double leak[DEA_SHEET_PLACES];                       /* g [S] */
    double front; /* width of charge that comes in from the rim, by the first sample, over the radius: sqrt(4 D t), D = 1/(c rho) [1] */
} dea_sheet;

/* Most rings of two films. */
enum { DEA_MEMBRANE_RINGS = 2 * DEA_RINGS_MOST };

typedef struct dea_membrane_second {
    dea_point point;
    dea_rings rings; /* none: there is no second film */
    double retardation;
} dea_membrane_second;

typedef struct dea_membrane {
    dea_dynamics film; /* all of the scene's network but its functions of u: damper, branches, port */
    dea_rings rings;   /* of the first film */
    dea_membrane_second second;
    size_t nodes, ring_total; /* of both films */
    dea_sheet sheet; /* charges and potentials of its electrodes */
    double masses[DEA_RINGS_NODES]; /* m_n [kg]; all 0: none */
    bool heavy;
    double unseen; /* least time between a kink of the voltage and the sample behind it [s], 0: not known */
    size_t own[DEA_MEMBRANE_RINGS]; /* place, among the nodes of a ring, of the one at its own radius, which alone strains its hoop */
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
    dea_ring_look rings[DEA_MEMBRANE_RINGS];
    bool spread;                     /* the potential is not the same all over the electrode: dea_sheet_look() */
    double voltages[DEA_RINGS_MOST]; /* then those of electroded rings [V] */
    double edge;        /* displacement of the edge [m] */
    double capacitance; /* of the first film [F] */
    double beside;      /* share of the second film's voltage squared that acts: 1 but on the way to rest */
} dea_membrane_look;

/* Cuts the film of a scene whose axes are at their place; nothing is to be closed. DEA_ERROR_USAGE for numbers out of range. */
dea_status dea_membrane_open(const dea_scene *scene, const dea_model *model, dea_rings_mesh mesh, dea_membrane *membrane,
                             dea_error *error);

/* True where dampers would resist some nodes alone of a membrane without mass: the others have no equation of motion then; and that in
 * words. */
bool dea_load_stalls(const dea_scene *scene);
extern const char dea_load_stalled[];

/* A ring of either film. */
static inline const dea_ring *dea_membrane_ring(const dea_membrane *membrane, size_t r)
{
    const size_t first = membrane->rings.ring_count;
    return r < first ? &membrane->rings.rings[r] : &membrane->second.rings.rings[r - first];
}

/* Number of the z. */
static inline size_t dea_membrane_relaxed(const dea_membrane *membrane)
{
    return 2 * membrane->rings.ring_count * membrane->film.branch_count;
}

/* The rings at displacements u [m]; false where a stretch is not positive or the energy of the film has ended. */
bool dea_membrane_look_at(const dea_membrane *membrane, const double *u, dea_membrane_look *look);
/* s_a of a ring under a film voltage, without x_a [Pa]. */
void dea_membrane_ring_stress(const dea_membrane *membrane, const dea_membrane_look *look, size_t r, double voltage, double s[2]);
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
/* Adds what the damper of the second film resists at rates of @p pace times the displacements [N/m]; neither of both above knows it. */
void dea_membrane_damp_second(const dea_membrane *membrane, const dea_membrane_look *look, double pace, double *stiffness);
/* The lesser of the retardation times of both films [s]. */
double dea_membrane_least_damper(const dea_membrane *membrane);
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
 * shapes[k nodes + n]: mode k, of sum m_n shape_n^2 = 1 [kg^-1/2]. False without mass or where LAPACK fails; the square of a
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

/* Strain, displacement, force at the edge, largest true field, C, charge and state of a film at u, as its static row has them. And
 * those under the peak of a voltage that is not the same everywhere; the field is exact where lambda_1 lambda_2, times the share of
 * that voltage, passes a limit. */
void dea_membrane_row(const dea_membrane *membrane, const dea_membrane_look *look, double voltage, const double *u, dea_row *row);
void dea_membrane_fill(const dea_membrane *membrane, const dea_membrane_look *look, double peak, const double *u, double limit,
                       dea_row *row);
#endif
