/* What a moving membrane tells of its states: samples, the current of its source, energies. */
#ifndef DEA_MEMBRANE_SAMPLE_H
#define DEA_MEMBRANE_SAMPLE_H

#include "network/membrane.h"

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
