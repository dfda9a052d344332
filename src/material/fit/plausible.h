/* What measured tables can be told to be from their numbers alone. */
#ifndef DEA_MATERIAL_FIT_PLAUSIBLE_H
#define DEA_MATERIAL_FIT_PLAUSIBLE_H

#include "deaspice/fit.h"

/* DEA_ERROR_DATA where the stretches look like percent or strain, or a compression has the sign of a tension. */
dea_status dea_plausible_stretches(const dea_fit_data *data, dea_error *error);
/* The largest stretch before the points go back by a fifth of their range in small steps, as an unloading film does; NAN: they do
 * not. */
double dea_plausible_turn(const dea_fit_data *data);
/* Whether a stress is below 0 by more than noise about 0, @p largest being the largest of its test. */
bool dea_plausible_negative(double stress, double largest);
/* DEA_ERROR_DATA where the stress of a relaxation test rises before it falls or the strain of a creep test falls behind its peak,
 * DEA_ERROR_USAGE where a number is negative beyond noise. */
dea_status dea_plausible_relaxation(const dea_relaxation_data *data, dea_error *error);

/* ---- Constants of a law whose stress is not linear in them. */

/* The constants of @p entries entries of the law (1 where it is no list) with the least sum of squares of weighted residuals,
 * weights[i] (measured - fitted) [Pa], from several starts; unused ones 0. DEA_OK, DEA_ERROR_MISSING, DEA_ERROR_MEMORY,
 * DEA_ERROR_DATA (none describes the data). */
dea_status dea_fit_search(const dea_fit_data *data, const dea_law *law, size_t entries, const double *weights,
                          double constants[DEA_LAW_CONSTANTS], dea_error *error);

#endif
