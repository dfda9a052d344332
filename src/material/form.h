/* Laws as expressions of stretches, for networks: the hook `form` of a row of the law table.
 *
 * With y = lambda^2 and v = 1/(y1 y2): J = I1 - 3 = y1 + y2 + v - 3, I2 - 3 = 1/y1 + 1/y2 + 1/v - 3, and the principal Cauchy
 * stresses of an energy of both are sigma_a = 2 (y_a - v)(dW/dI1 + y_b dW/dI2), b the other direction in the plane. */
#ifndef DEA_FORM_H
#define DEA_FORM_H

#include "expression/formula.h"
#include "material/law.h"

typedef struct dea_law_form {
    dea_expr stress[2]; /* principal Cauchy stresses [Pa] */
    dea_expr room;      /* > 0 where the law holds, 1: everywhere */
} dea_law_form;

typedef struct dea_form_invariants {
    dea_expr y[2], v;
    dea_expr j; /* I1 - 3 */
} dea_form_invariants;

dea_form_invariants dea_form_invariants_of(dea_pool *pool, dea_expr l1, dea_expr l2);

/* The stresses of an energy of both invariants; NUM(0) for one that does not enter. */
void dea_form_stresses(dea_pool *pool, const dea_form_invariants *at, dea_expr first, dea_expr second, dea_law_form *form);

#endif
