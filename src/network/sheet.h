/* The charges of a membrane's film, and the potential along electrodes with a sheet resistance (physics: section 8): charge is
 * conserved on the rings of the electrode, which is fed at its outer rim,
 *
 *     dq_n/dt = -sum_m L_nm V_m - g_n V_n,   V_n = q_n/C_n,   C_n = eps/H^2 volume_n (lambda_1 lambda_2)^2_n,
 *     L = D^T diag(2 pi R dR/rho lambda_2/lambda_1) D,   rho = rho_s (4 layers - 2)/layers^2: 2 rho_s of one film,
 *
 * with the derivative D over R of the polynomial through the places, so that L is what div((1/rho) grad V) does to deformed film. The
 * leakage 1/R_p is shared out over the film as it was laid. At the rim the source is, or the series resistance R_s before it.
 *
 * Without a sheet resistance the film has one potential, and behind R_s one charge. */
#ifndef DEA_SHEET_H
#define DEA_SHEET_H

#include "network/membrane.h"

/* A film at a state. Each of `charges`; with places the rim behind them where the source is. */
typedef struct dea_charges {
    double capacitances[DEA_SHEET_PLACES]; /* C_n [F] */
    double voltages[DEA_SHEET_PLACES];     /* V_n [V] */
    double voltage;                        /* their mean by capacitance: charge of the film over its capacitance [V] */
} dea_charges;

/* Powers of the electrodes [W]. */
typedef struct dea_sheet_powers {
    double heat; /* in sheets and leakage */
    double fed;  /* that a source without R_s puts in beyond what it stores in the rim */
} dea_sheet_powers;

/* Potentials of a film at charges q [C] under a source voltage; those of the rings go into the look. */
void dea_sheet_look(const dea_membrane *membrane, dea_membrane_look *look, const double *q, double source,
                    dea_charges *charges);
/* dq/dt of the charges [A]. */
void dea_sheet_flows(const dea_membrane *membrane, const dea_membrane_look *look, const dea_charges *charges,
                     double source, double *flows);
/* -d(dq_n/dt)/dV_m [S], charges x charges, symmetric. */
void dea_sheet_admittance(const dea_membrane *membrane, const dea_membrane_look *look, double *admittance);
/* (1/2) dC_k/du of number k [N/V^2]. */
void dea_sheet_push(const dea_membrane *membrane, const dea_membrane_look *look, size_t k, double *push);
/* Current of the source into a rim without R_s [A]: what stays there at velocities v, while the voltage changes by @p slope [V/s]; what
 * goes on from there into the sheets. Both 0 of an electrode that has no such rim. */
double dea_sheet_rim_current(const dea_membrane *membrane, const dea_membrane_look *look, double source, double slope,
                             const double *v);
double dea_sheet_through(const dea_membrane *membrane, const dea_membrane_look *look);
/* Voltage where R_s ends: of the rim, or of a film without a potential along its electrode [V]. */
double dea_sheet_rim_voltage(const dea_membrane *membrane, const dea_membrane_look *look, double voltage);
/* Current of the leakage [A], of a look with potentials under a mean voltage. */
double dea_sheet_leakage(const dea_membrane *membrane, const dea_membrane_look *look, double voltage);
/* Of an electrode with places, at a moment: where it knows the slopes of the charges better than the small drops along the sheets, from
 * those, as sum_n (V_rim - V_n) dq_n/dt and leakage. */
dea_sheet_powers dea_sheet_powers_of(const dea_membrane *membrane, const dea_membrane_look *look,
                                     const dea_moment *moment, const double *v);
/* Energy of the charges [J], without a rim at the source. */
double dea_sheet_energy(const dea_membrane *membrane, const dea_charges *charges);
/* Fastest rate at which charges spread, no less than it is [1/s]. */
double dea_sheet_fastest(const dea_membrane *membrane, const dea_membrane_look *look);

#endif
