/* The film of rings at rest under its voltage and a force on its edge: forces, stiffness, the way from rest, and the row of a
 * solution. Displacements are those of the moving nodes [m]. */
#ifndef DEA_STILL_H
#define DEA_STILL_H

#include "network/rings.h"

typedef struct dea_still {
    const dea_point *point; /* borrowed */
    dea_rings rings;
    double pressure; /* M = eps (U/H)^2 [Pa] */
} dea_still;

/* Cuts the film of a point whose numbers are in their ranges; it borrows the point. */
void dea_still_open(const dea_point *point, dea_rings_mesh mesh, dea_still *still);

/* Fills the row of a mesh at u; returns how far it is, relative, from that of a finer mesh behind Newton's step from @p v, the same
 * place on it, with the stress that tells slack where their states differ; inf where that has no step. */
double dea_still_apart(const dea_still *coarse, const double *u, const dea_still *fine, const double *v, dea_row *row);
/* Follows the equilibrium from rest as the force grows and then the voltage; on DEA_STATE_OK @p u holds it under the full load, good
 * to rounding. DEA_STATE_PULL_IN: it folds, or the film ends, before that. */
dea_state dea_still_climb(const dea_still *still, double *u);

/* True where a stable equilibrium @p u is so near to rest that no fold can lie between: small strains, and a stiffness against
 * them that the load has not halved. */
bool dea_still_near(const dea_still *still, const double *u);

/* What errors of the edge's displacement count against: it, or what the force alone makes where that is more [m]. */
double dea_still_size(const dea_still *still, const double *u);

/* Largest strain of a ring in its plane, at least that of the force alone [1]. */
double dea_still_strain(const dea_still *still, const double *u);

/* What meshes of one and of two degrees more make of the equilibrium @p u, the larger: of the edge's displacement, relative, and a
 * share of that of its row. */
double dea_still_error(const dea_still *still, const double *u);

/* Coarsest mesh on which the edge's displacement is good to @p accuracy, relative, by the Newton step of a mesh two degrees finer,
 * which is *error: of a film that has an equilibrium, the nodes of its annulus evenly in ln R. Degree 0: there is none, or none so
 * good. */
dea_rings_mesh dea_still_mesh(const dea_point *point, double accuracy, double *error);

#endif
