/* Equi-biaxial balance of an active and a passive film of equal pre-stretch, the equation behind Eqs. 13 and 18:
 *
 *     sigma(lambda_A) - sigma(lambda_P) = eps lambda_A^4 (U/H)^2,   lambda_A = lambda_pre (1 + e),   lambda_P = lambda_pre (1 -
 * ratio e)
 *
 * A permittivity that follows the strain scales the right side by dea_film_electric().first.
 *
 * ratio is the strain that the passive film gives back per strain of the active one: 0 for a constant bias force (Eq. 13),
 * B/(1 - B) for a dot (Eq. 17), (1 - B)/B for a lens, whose annulus is the active film.
 */
#ifndef DEA_FILM_BALANCE_H
#define DEA_FILM_BALANCE_H

#include "model/models.h"

/* Rows of points of one film from the strains of their active films that are connected to rest: @p ratio gives the ratio of a point,
 * @p fill its row from pressure and strain. Where there is no such strain the row is pull-in. No row depends on other points. */
void dea_film_balances_solve(const dea_point *points, size_t count, double (*ratio)(const dea_point *point),
                             void (*fill)(const dea_point *point, double pressure, double strain, dea_row *row), dea_row *rows);

/* m = eps lambda_pre^4 (U/H)^2 [Pa], the Maxwell stress at the pre-stretch. */
static inline double dea_point_pressure(const dea_point *point)
{
    const double field = dea_point_nominal_field(point) * point->film.square;
    return point->film.permittivity * field * field;
}

#endif
