/* Levenberg and Marquardt's method of cminpack, from a library that is loaded when it is first called: only a fit of a law whose
 * stress is not linear in its constants needs it. */
#ifndef DEA_SUPPORT_MINPACK_H
#define DEA_SUPPORT_MINPACK_H

#include <stddef.h>

#include "deaspice/status.h"

/* Writes @p rows residuals at @p x; what is not finite counts as far too large. */
typedef void dea_residuals(void *user, const double *x, double *residual);

/* Moves @p x, @p count values, to a least sum of squares of @p rows >= count residuals nearby. @p squares: that sum.
 * DEA_OK, DEA_ERROR_MISSING, DEA_ERROR_MEMORY. */
dea_status dea_minpack_least(dea_residuals *residuals, void *user, size_t rows, size_t count, double *x, double *squares,
                             dea_error *error);

#endif
