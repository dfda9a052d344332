/* Hyperelastic springs of a region of film, measured from the pre-stretch. */
#ifndef DEA_HYPERELASTIC_H
#define DEA_HYPERELASTIC_H

#include "network/network.h"

/* sigma(lambda_pre (1 + e)) - sigma(lambda_pre) [Pa] by change arithmetic, so that a small strain keeps its digits. */
dea_expr dea_hyperelastic_change(const dea_symbols *symbols, dea_expr e);
/* sigma_1 - sigma(lambda_pre) [Pa] at the stretches lambda_pre (1 + e1), lambda_pre (1 + e2), likewise. */
dea_expr dea_hyperelastic_principal(const dea_symbols *symbols, dea_expr e1, dea_expr e2);
/* Both changes of the Cauchy stresses [Pa], likewise. */
void dea_hyperelastic_cauchy(const dea_symbols *symbols, dea_expr e1, dea_expr e2, dea_expr stress[2]);
/* Change of lambda_3^2 = 1/(lambda_1 lambda_2)^2 as it stands in them, of a law of the invariants. */
dea_expr dea_hyperelastic_thin(const dea_symbols *symbols, dea_expr e1, dea_expr e2);

/* t lambda_pre^2/H sigma_e(1 + e1, 1 + e2) [Pa], the Cauchy stress that the skin adds to the film under it. Only where there is a
 * skin. */
dea_expr dea_hyperelastic_skin(const dea_symbols *symbols, dea_expr e1, dea_expr e2);

/* A(lambda_a) = 2 pi r_a H/(lambda_pre^2 (1 + s)) [m^2]. */
dea_expr dea_hyperelastic_area(const dea_symbols *symbols, dea_expr strain);

/* A(lambda_a) eps E^2 [N] and the true field E = U lambda^2/H [V/m] of the electroded region at lambda = lambda_pre (1 + e). */
dea_expr dea_hyperelastic_force(const dea_symbols *symbols, dea_expr strain, dea_expr e);
dea_expr dea_hyperelastic_field(const dea_symbols *symbols, dea_expr e);

#endif
