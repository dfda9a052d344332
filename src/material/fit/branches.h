/* Relaxation branches in search of their times: the weighted data of a test, and sets of branches fitted to it. */
#ifndef DEA_MATERIAL_FIT_BRANCHES_H
#define DEA_MATERIAL_FIT_BRANCHES_H

#include <stddef.h>
#include "material/fit/test.h"
#include "deaspice/status.h"

enum { DEA_BRANCHES_GRID = 128, DEA_BRANCHES_COLUMNS = 2 * DEA_RELAXATION_MOST + 1 };

/* The weighted data, stresses as shares of the largest one; row i is curve i % curves of point i/curves. */
typedef struct dea_held {
    size_t rows;
    const dea_relaxation_data *data;
    const dea_test *test;
    double scale;                   /* largest stress [Pa] */
    double *weight, *right;         /* rows values; owned */
    double *matrix;                 /* room for DEA_BRANCHES_COLUMNS columns of rows + DEA_BRANCHES_COLUMNS values; owned */
    double *step;                   /* right side and solution of a step, rows + DEA_BRANCHES_COLUMNS values; owned */
    double squares;                 /* of right */
    double log_min, log_max;        /* limits of ln tau */
    double grid[DEA_BRANCHES_GRID]; /* ln tau, ascending */
    size_t grid_count;
    bool memory; /* false once memory ran out */
} dea_held;

/* Branches with what they leave. */
typedef struct dea_branches {
    size_t count;
    double logs[DEA_RELAXATION_MOST];       /* ln tau */
    double shares[DEA_RELAXATION_MOST + 1]; /* a_inf, a_i as shares of the largest stress */
    double squares;                         /* of the weighted residuals */
} dea_branches;

/* Begins with a test that it borrows; the caller ends it with dea_held_end(), also after a failure. */
dea_status dea_held_begin(dea_held *held, const dea_relaxation_data *data, bool relative, dea_error *error);
/* Frees what it owns; zeroed is fine. */
void dea_held_end(dea_held *held);

/* The shares that go with the times, and what they leave. */
void dea_branches_solve(dea_held *held, dea_branches *branches);
/* The best fit found with one branch more than @p less. */
dea_branches dea_branches_next(dea_held *held, const dea_branches *less);
/* Derivatives of the weighted model by a_inf, a_i and ln tau_i, with @p rows rows of room in a column; 0 for an unused branch. */
void dea_branches_jacobian(const dea_held *held, const dea_branches *branches, double *matrix, size_t rows);
/* Weighted residuals of the points, from that matrix. */
void dea_branches_residual(const dea_held *held, const dea_branches *branches, const double *matrix, size_t rows, double *residual);
/* Sum of squares. */
double dea_squares(const double *values, size_t count);

/* ---- Linear least squares with non-negative unknowns. */

/* Minimises |A x - b| over x >= 0 by the active-set method of Lawson and Hanson, "Solving Least Squares Problems", chapter 23.
 * @p matrix is A, rows x columns, column by column; @p x gets the solution, *squares the sum of squared residuals.
 * Returns DEA_OK or DEA_ERROR_MEMORY. */
dea_status dea_nnls(size_t rows, size_t columns, const double *matrix, const double *right, double *x, double *squares);

#endif
