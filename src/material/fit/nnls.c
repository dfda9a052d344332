#include "material/fit/branches.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "support/lapack.h"

/* Gain along a unit column, as a share of |b|, below which the column stays out. */
static const double gain_least = 1e-14;

/* The problem and the state of the search. */
typedef struct search {
    size_t rows, columns;
    const double *matrix, *right;
    double *x;        /* solution so far, columns values */
    double *residual; /* b - A x, rows values; owned */
    double *block;    /* the columns in use, as LAPACK destroys them; owned */
    double *solved;   /* least-squares solution on them, rows values; owned */
    double *length;   /* of each column; owned */
    size_t *used;     /* numbers of the columns in use; owned */
    size_t count;     /* of them */
    bool *barred;     /* out, or of no use at this x; owned */
    bool exhausted;       /* memory ran out in LAPACK */
} search;

static dea_status search_begin(search *s)
{
    s->residual = malloc(s->rows * sizeof *s->residual);
    s->block = malloc(s->rows * s->columns * sizeof *s->block);
    s->solved = malloc(s->rows * sizeof *s->solved);
    s->length = calloc(s->columns, sizeof *s->length);
    s->used = malloc(s->columns * sizeof *s->used);
    s->barred = calloc(s->columns, sizeof *s->barred);
    if (!s->residual || !s->block || !s->solved || !s->length || !s->used || !s->barred) {
        return DEA_ERROR_MEMORY;
    }
    for (size_t j = 0; j < s->columns; j++) {
        for (size_t i = 0; i < s->rows; i++) {
            s->length[j] += s->matrix[j * s->rows + i] * s->matrix[j * s->rows + i];
        }
        s->length[j] = sqrt(s->length[j]);
        s->x[j] = 0.0;
    }
    memcpy(s->residual, s->right, s->rows * sizeof *s->residual);
    return DEA_OK;
}

static void search_end(search *s)
{
    free(s->residual);
    free(s->block);
    free(s->solved);
    free(s->length);
    free(s->used);
    free(s->barred);
}

static void residual_update(search *s)
{
    memcpy(s->residual, s->right, s->rows * sizeof *s->residual);
    for (size_t k = 0; k < s->count; k++) {
        const double *column = s->matrix + s->used[k] * s->rows;
        for (size_t i = 0; i < s->rows; i++) {
            s->residual[i] -= column[i] * s->x[s->used[k]];
        }
    }
}

/* The column that the residual leans on most, columns where there is none. */
static size_t column_best(const search *s, double least)
{
    size_t best = s->columns;
    for (size_t j = 0; j < s->columns; j++) {
        double gain = 0.0;
        for (size_t i = 0; i < s->rows && !s->barred[j]; i++) {
            gain += s->matrix[j * s->rows + i] * s->residual[i];
        }
        if (gain > least * s->length[j]) {
            least = gain / s->length[j];
            best = j;
        }
    }
    return best;
}

/* Least squares on the columns in use; false where they depend on each other. */
static bool block_solve(search *s)
{
    for (size_t k = 0; k < s->count; k++) {
        memcpy(s->block + k * s->rows, s->matrix + s->used[k] * s->rows, s->rows * sizeof *s->block);
    }
    memcpy(s->solved, s->right, s->rows * sizeof *s->solved);
    const lapack_int rows = (lapack_int)s->rows;
    const lapack_int info =
        dea_lapacke_dgels(LAPACK_COL_MAJOR, 'N', rows, (lapack_int)s->count, 1, s->block, rows, s->solved, rows);
    s->exhausted = s->exhausted || info < 0;
    return info == 0;
}

/* Goes from x towards the solution as far as no unknown turns negative, and drops those that reach 0; true where it arrived. */
static bool step_inside(search *s)
{
    double share = 1.0;
    for (size_t k = 0; k < s->count; k++) {
        const double x = s->x[s->used[k]], z = s->solved[k];
        if (!(z > 0.0)) {
            share = fmin(share, x / (x - z));
        }
    }
    const bool arrived = share >= 1.0;
    size_t kept = 0;
    for (size_t k = 0; k < s->count; k++) {
        const size_t j = s->used[k];
        const bool blocks = !(s->solved[k] > 0.0) && s->x[j] / (s->x[j] - s->solved[k]) <= share;
        s->x[j] = blocks ? 0.0 : arrived ? s->solved[k] : s->x[j] + share * (s->solved[k] - s->x[j]);
        s->used[kept] = j;
        kept += !blocks;
    }
    s->count = kept;
    return arrived;
}

/* Takes a column in; false where that makes no step, and the column stays out until x moves. */
static bool column_enter(search *s, size_t j)
{
    s->used[s->count++] = j;
    s->barred[j] = true;
    if (!block_solve(s) || !(s->solved[s->count - 1] > 0.0)) {
        s->count--;
        return false;
    }
    while (!step_inside(s) && s->count > 0 && block_solve(s)) {
    }
    memset(s->barred, 0, s->columns * sizeof *s->barred);
    for (size_t k = 0; k < s->count; k++) {
        s->barred[s->used[k]] = true;
    }
    residual_update(s);
    return true;
}

dea_status dea_nnls(size_t rows, size_t columns, const double *matrix, const double *right, double *x, double *squares)
{
    search s = {.rows = rows, .columns = columns, .matrix = matrix, .right = right, .x = x};
    const dea_status status = search_begin(&s);
    double size = 0.0;
    for (size_t i = 0; i < rows && status == DEA_OK; i++) {
        size += right[i] * right[i];
    }
    size_t steps = 3 * columns;
    while (status == DEA_OK && !s.exhausted && s.count < rows && steps > 0) {
        const size_t j = column_best(&s, gain_least * sqrt(size));
        if (j == columns) {
            break;
        }
        steps -= column_enter(&s, j);
    }
    *squares = 0.0;
    for (size_t i = 0; i < rows && status == DEA_OK; i++) {
        *squares += s.residual[i] * s.residual[i];
    }
    search_end(&s);
    return s.exhausted ? DEA_ERROR_MEMORY : status;
}
