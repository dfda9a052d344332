/* Eq. 4: free film under the Maxwell pressure, Y at the operating point, no frame. Of a permittivity that follows the strain the
 * pressure is that of the pre-stretched film, electrostriction included. */
#include "model/models.h"

static void solve(const dea_point *point, double accuracy, dea_row *row)
{
    (void)accuracy;
    const dea_film *film = &point->film;
    const double field = dea_point_nominal_field(point) * film->square; /* E = U lambda_pre^2/H */
    const double pressure = film->permittivity * dea_point_electric(point).first * field * field;
    const double x = pressure / (film->modulus + dea_point_skin_modulus(point));
    if (pressure > 0.0 && !(x >= 0.0 && x < 1.0)) {
        dea_row_refuse(row, DEA_STATE_PULL_IN);
        return;
    }
    const double root = sqrt(1.0 - x);
    const double strain = x / (root * (1.0 + root)); /* 1/sqrt(1-x) - 1 without cancellation */
    const double stretch = film->prestretch * (1.0 + strain);
    dea_row_fill(row, point,
                 (dea_found){.strain = strain,
                             .force = pressure * dea_point_cross_section(point),
                             .stretch = stretch * stretch,
                             .capacitance = dea_point_disc_capacitance(point, strain),
                             .taut = true});
}

const dea_model dea_model_pelrine = {
    .name = "pelrine",
    .equation = "Eq. 4",
    .leaves_out = "frame, coverage",
    .lens = false,
    .solve = solve,
};
