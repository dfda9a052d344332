/* Variable projection: what a test measures (fit_test.h) is linear in the shares a, none of them negative. So only
 * ln tau_i are searched, and the a follow by non-negative least squares. A step is the part of ln tau in a Levenberg-Marquardt
 * step of all unknowns; starts come from a logarithmic grid of times. */
#include "material/fit/branches.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "support/lapack.h"

enum { PER_DECADE = 5, STARTS = 4, STEPS_MOST = 300 };

/* Relaxation times are searched from the shortest interval of the data, divided by this, to the duration of the hold, times this.
 */
static const double reach = 4.0;
/* The largest weight in a relative fit: that of a stress of 1 % of the largest. */
static const double relative_floor = 0.01;

static void constant_column(const dea_held *held, double *column)
{
    for (size_t i = 0; i < held->rows; i++) {
        column[i] = held->weight[i] * held->test->rest[i % held->test->curves];
    }
}

/* The branch, or its slope over ln tau. */
static void branch_column(const dea_held *held, double log_tau, bool slope, double *column)
{
    const dea_test_time time = dea_test_time_of(held->data->ramp, exp(log_tau));
    const size_t curves = held->test->curves;
    for (size_t i = 0; i < held->rows; i++) {
        const dea_test_term term = held->test->branch(held->data->points[i / curves].time, &time, i % curves);
        column[i] = held->weight[i] * (slope ? term.slope : term.value);
    }
}

double dea_squares(const double *values, size_t count)
{
    double sum = 0.0;
    for (size_t i = 0; i < count; i++) {
        sum += values[i] * values[i];
    }
    return sum;
}

void dea_held_end(dea_held *held)
{
    free(held->weight);
    free(held->right);
    free(held->matrix);
    free(held->step);
}

static void grid_fill(dea_held *held)
{
    const dea_relaxation_point *points = held->data->points;
    const size_t last = held->data->count - 1;
    double interval = INFINITY;
    for (size_t i = 1; i <= last; i++) {
        interval = fmin(interval, points[i].time - points[i - 1].time);
    }
    const bool periodic = held->test->periodic;
    const double hold = periodic ? 1.0 / points[0].time : points[last].time - points[0].time;
    const double seen = (periodic ? 1.0 / points[last].time : fmax(interval, points[0].time)) / reach;
    held->log_min = log(fmin(seen, hold / reach));
    held->log_max = log(hold * reach);
    const double wanted = ceil((held->log_max - held->log_min) / log(10.0) * PER_DECADE) + 1.0;
    held->grid_count = (size_t)fmin(wanted, DEA_BRANCHES_GRID);
    for (size_t i = 0; i < held->grid_count; i++) {
        held->grid[i] = held->log_min + (held->log_max - held->log_min) * (double)i / (double)(held->grid_count - 1);
    }
}

dea_status dea_held_begin(dea_held *held, const dea_relaxation_data *data, bool relative, dea_error *error)
{
    const dea_test *test = dea_test_of(data->kind);
    *held = (dea_held){.rows = data->count * test->curves, .data = data, .test = test, .memory = true};
    for (size_t i = 0; i < data->count; i++) {
        held->scale = fmax(held->scale, data->points[i].stress);
    }
    if (!(held->scale > 0.0)) {
        return dea_fail(error, DEA_ERROR_USAGE, "all %zu measured %s are 0", data->count,
                        data->kind == DEA_TEST_RELAXATION ? "stresses" : "values");
    }
    held->weight = malloc(held->rows * sizeof *held->weight);
    held->right = malloc(held->rows * sizeof *held->right);
    held->matrix = malloc((held->rows + DEA_BRANCHES_COLUMNS) * DEA_BRANCHES_COLUMNS * sizeof *held->matrix);
    held->step = malloc((held->rows + DEA_BRANCHES_COLUMNS) * sizeof *held->step);
    if (!held->weight || !held->right || !held->matrix || !held->step) {
        return dea_fail(error, DEA_ERROR_MEMORY, "out of memory");
    }
    for (size_t i = 0; i < held->rows; i++) {
        const double stress = dea_test_measured(&data->points[i / test->curves], i % test->curves) / held->scale;
        held->weight[i] = relative ? 1.0 / fmax(stress, relative_floor) : 1.0;
        held->right[i] = held->weight[i] * stress;
    }
    held->squares = dea_squares(held->right, held->rows);
    grid_fill(held);
    return DEA_OK;
}

void dea_branches_solve(dea_held *held, dea_branches *c)
{
    constant_column(held, held->matrix);
    for (size_t k = 0; k < c->count; k++) {
        branch_column(held, c->logs[k], false, held->matrix + (k + 1) * held->rows);
    }
    if (dea_nnls(held->rows, c->count + 1, held->matrix, held->right, c->shares, &c->squares) != DEA_OK) {
        held->memory = false;
    }
}

void dea_branches_jacobian(const dea_held *held, const dea_branches *c, double *matrix, size_t rows)
{
    memset(matrix, 0, rows * (2 * c->count + 1) * sizeof *matrix);
    if (c->shares[0] > 0.0) {
        constant_column(held, matrix);
    }
    for (size_t k = 0; k < c->count; k++) {
        if (c->shares[k + 1] > 0.0) {
            double *slope = matrix + (c->count + 1 + k) * rows;
            branch_column(held, c->logs[k], false, matrix + (k + 1) * rows);
            branch_column(held, c->logs[k], true, slope);
            for (size_t i = 0; i < held->rows; i++) {
                slope[i] *= c->shares[k + 1];
            }
        }
    }
}

void dea_branches_residual(const dea_held *held, const dea_branches *c, const double *matrix, size_t rows, double *residual)
{
    memcpy(residual, held->right, held->rows * sizeof *residual);
    for (size_t j = 0; j <= c->count; j++) {
        for (size_t i = 0; i < held->rows; i++) {
            residual[i] -= c->shares[j] * matrix[j * rows + i];
        }
    }
}

/* Solves (J, sqrt(damping) |J_j|) step = (residual, 0); held->step holds the result, a_inf, a_i and ln tau_i. */
static bool step_solve(dea_held *held, const dea_branches *c, double damping)
{
    const size_t columns = 2 * c->count + 1, rows = held->rows + columns;
    dea_branches_jacobian(held, c, held->matrix, rows);
    memset(held->step, 0, rows * sizeof *held->step);
    dea_branches_residual(held, c, held->matrix, rows, held->step);
    for (size_t j = 0; j < columns; j++) {
        const double size = dea_squares(held->matrix + j * rows, held->rows);
        held->matrix[j * rows + held->rows + j] = size > 0.0 ? sqrt(damping * size) : 1.0;
    }
    const lapack_int info = dea_lapacke_dgels(LAPACK_COL_MAJOR, 'N', (lapack_int)rows, (lapack_int)columns, 1, held->matrix,
                                              (lapack_int)rows, held->step, (lapack_int)rows);
    held->memory = held->memory && info >= 0;
    return info == 0;
}

/* Moves the times until no step helps any more. */
static void branches_refine(dea_held *held, dea_branches *c)
{
    double damping = 1e-3;
    for (int i = 0; i < STEPS_MOST && held->memory && damping < 1e7 && c->squares > 1e-30 * held->squares; i++) {
        dea_branches trial = *c;
        double longest = 0.0;
        if (step_solve(held, c, damping)) {
            for (size_t k = 0; k < c->count; k++) {
                const double step = fmin(fmax(held->step[c->count + 1 + k], -1.0), 1.0);
                trial.logs[k] = fmin(fmax(c->logs[k] + step, held->log_min), held->log_max);
                longest = fmax(longest, fabs(trial.logs[k] - c->logs[k]));
            }
            dea_branches_solve(held, &trial);
        }
        const bool better = trial.squares < c->squares;
        const bool still = longest < 1e-12 || (better && trial.squares > c->squares * (1.0 - 1e-10));
        damping *= better ? 0.1 : 10.0;
        *c = better ? trial : *c;
        if (still) {
            break;
        }
    }
}

/* Solves and refines @p start, and keeps it where it is better than @p best. */
static void branches_try(dea_held *held, dea_branches start, dea_branches *best)
{
    dea_branches_solve(held, &start);
    branches_refine(held, &start);
    if (start.squares < best->squares) {
        *best = start;
    }
}

/* The best local minimum of @p squares that is not yet in @p used, grid_count where there is none. */
static size_t valley_find(const dea_held *held, const double *squares, const bool *used)
{
    const size_t last = held->grid_count - 1;
    size_t found = held->grid_count;
    for (size_t i = 0; i <= last; i++) {
        const bool valley = (i == 0 || squares[i] <= squares[i - 1]) && (i == last || squares[i] <= squares[i + 1]);
        if (valley && !used[i] && (found > last || squares[i] < squares[found])) {
            found = i;
        }
    }
    return found;
}

/* Starts with one branch more than @p less: its new time where the grid has the best local minima. */
static void try_additions(dea_held *held, const dea_branches *less, dea_branches *best)
{
    double squares[DEA_BRANCHES_GRID];
    bool used[DEA_BRANCHES_GRID] = {false};
    dea_branches start = *less;
    start.count++;
    for (size_t i = 0; i < held->grid_count; i++) {
        start.logs[less->count] = held->grid[i];
        dea_branches_solve(held, &start);
        squares[i] = start.squares;
    }
    for (int tries = 0; tries < STARTS; tries++) {
        const size_t found = valley_find(held, squares, used);
        if (found == held->grid_count) {
            break;
        }
        used[found] = true;
        start.logs[less->count] = held->grid[found];
        branches_try(held, start, best);
    }
}

/* Merges the nearest two of @p count times, weighted by their shares, until @p wanted are left. */
static void lines_merge(double *logs, double *shares, size_t count, size_t wanted)
{
    for (; count > wanted; count--) {
        size_t nearest = 0;
        for (size_t i = 1; i + 1 < count; i++) {
            nearest = logs[i + 1] - logs[i] < logs[nearest + 1] - logs[nearest] ? i : nearest;
        }
        const double sum = shares[nearest] + shares[nearest + 1];
        logs[nearest] = (shares[nearest] * logs[nearest] + shares[nearest + 1] * logs[nearest + 1]) / sum;
        shares[nearest] = sum;
        memmove(logs + nearest + 1, logs + nearest + 2, (count - nearest - 2) * sizeof *logs);
        memmove(shares + nearest + 1, shares + nearest + 2, (count - nearest - 2) * sizeof *shares);
    }
}

/* The lines of the spectrum that non-negative least squares finds on the whole grid. */
static size_t spectrum_find(dea_held *held, double logs[DEA_BRANCHES_GRID], double shares[DEA_BRANCHES_GRID])
{
    double found[DEA_BRANCHES_GRID + 1], squares;
    size_t count = 0;
    double *matrix = malloc(held->rows * (held->grid_count + 1) * sizeof *matrix);
    if (!matrix) {
        held->memory = false;
        return 0;
    }
    constant_column(held, matrix);
    for (size_t i = 0; i < held->grid_count; i++) {
        branch_column(held, held->grid[i], false, matrix + (i + 1) * held->rows);
    }
    held->memory = dea_nnls(held->rows, held->grid_count + 1, matrix, held->right, found, &squares) == DEA_OK;
    free(matrix);
    for (size_t i = 0; i < held->grid_count && held->memory; i++) {
        if (found[i + 1] > 0.0) {
            logs[count] = held->grid[i];
            shares[count++] = found[i + 1];
        }
    }
    return count;
}

dea_branches dea_branches_next(dea_held *held, const dea_branches *less)
{
    double logs[DEA_BRANCHES_GRID], shares[DEA_BRANCHES_GRID];
    dea_branches best = {.count = less->count + 1, .squares = INFINITY};
    try_additions(held, less, &best);
    const size_t lines = held->memory ? spectrum_find(held, logs, shares) : 0;
    if (lines >= best.count) {
        dea_branches start = {.count = best.count};
        lines_merge(logs, shares, lines, best.count);
        memcpy(start.logs, logs, best.count * sizeof *logs);
        branches_try(held, start, &best);
    }
    return best;
}
