/* Standard errors of least squares, and the chance of an F test. */
#ifndef DEA_MATERIAL_FIT_ERRORS_H
#define DEA_MATERIAL_FIT_ERRORS_H

#include <stdbool.h>
#include <stddef.h>

/* The singular value decomposition of a matrix of rows x columns, stored column by column; borrows its arrays. */
typedef struct dea_decomposed {
    size_t rows, columns;
    const double *left;     /* U, rows x columns */
    const double *singular; /* descending, columns values */
    const double *vt;       /* V^T, columns x columns */
} dea_decomposed;

/* Covariances of the least-squares solution, columns x columns values each, for noise that is alike in all rows and for noise that is
 * not, from the residuals of the rows, which are overwritten. More rows than columns. */
void dea_errors_covariances(const dea_decomposed *matrix, double *residual, double *alike, double *unlike);
/* Chance that one constant without a meaning gains as much: F test with 1 and @p freedom degrees of freedom, @p more and @p less
 * being the squared residuals with and without it. NAN without a degree of freedom. */
double dea_errors_chance(double less, double more, size_t freedom);

#endif
