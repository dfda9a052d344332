/* Constants of a law whose stress is not linear in them. */
#ifndef DEA_MATERIAL_FIT_SEARCH_H
#define DEA_MATERIAL_FIT_SEARCH_H

#include "deaspice/fit.h"

/* The constants of @p entries entries of the law (1 where it is no list) with the least sum of squares of weighted residuals,
 * weights[i] (measured - fitted) [Pa], from several starts; unused ones 0. DEA_OK, DEA_ERROR_MISSING, DEA_ERROR_MEMORY,
 * DEA_ERROR_DATA (none describes the data). */
dea_status dea_fit_search(const dea_fit_data *data, const dea_law *law, size_t entries, const double *weights,
                          double constants[DEA_LAW_CONSTANTS], dea_error *error);

#endif
