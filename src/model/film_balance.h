/* Equi-biaxial balance of an active and a passive film of equal pre-stretch, the equation behind Eqs. 13 and 18:
 *
 *     sigma(lambda_A) - sigma(lambda_P) = eps lambda_A^4 (U/H)^2,   lambda_A = lambda_pre (1 + e),   lambda_P = lambda_pre (1 -
 * ratio e)
 *
 * ratio is the strain that the passive film gives back per strain of the active one: 0 for a constant bias force (Eq. 13),
 * B/(1 - B) for a dot (Eq. 17), (1 - B)/B for a lens, whose annulus is the active film.
 */
#ifndef DEA_FILM_BALANCE_H
#define DEA_FILM_BALANCE_H

#include "model/models.h"

/* Strain e of the active film of a point, with its skin, that is connected to rest under the pressure m = eps lambda_pre^4 (U/H)^2
 * [Pa]. False where there is none: pull-in. */
bool dea_film_balance(const dea_point *point, double ratio, double m, double *strain);

/* m = eps lambda_pre^4 (U/H)^2 [Pa], the Maxwell stress at the pre-stretch. */
static inline double dea_point_pressure(const dea_point *point)
{
    const double field = dea_point_nominal_field(point) * point->film.square;
    return point->film.permittivity * field * field;
}

#endif
