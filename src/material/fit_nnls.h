/* Linear least squares with non-negative unknowns. */
#ifndef DEA_MATERIAL_FIT_NNLS_H
#define DEA_MATERIAL_FIT_NNLS_H

#include <stddef.h>

#include "deaspice/status.h"

/* Minimises |A x - b| over x >= 0 by the active-set method of Lawson and Hanson, "Solving Least Squares Problems", chapter 23.
 * @p matrix is A, rows x columns, column by column; @p x gets the solution, *squares the sum of squared residuals.
 * Returns DEA_OK or DEA_ERROR_MEMORY. */
dea_status dea_nnls(size_t rows, size_t columns, const double *matrix, const double *right, double *x, double *squares);

#endif
