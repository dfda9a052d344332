#include "support/minpack.h"

#include <dlfcn.h>
#include <math.h>
#include <stdlib.h>

/* As cminpack.h declares them, in double precision. */
typedef int minpack_function(void *user, int rows, int count, const double *x, double *residual, int flag);
typedef int minpack_lmdif1(minpack_function *function, void *user, int rows, int count, double *x, double *residual, double tolerance,
                           int *whole, double *work, int work_size);

static const char library_name[] = "libcminpack.so.1"; /* of its ABI, not of its development files */

static const double tolerance = 1e-14; /* of the sum of squares and of x: as far as rounding lets it go */
static const double wall = 1e10;       /* residual where there is none */

typedef struct problem {
    dea_residuals *residuals;
    void *user;
} problem;

static int evaluate(void *user, int rows, int count, const double *x, double *residual, int flag)
{
    const problem *p = user;
    (void)count;
    (void)flag;
    p->residuals(p->user, x, residual);
    for (int i = 0; i < rows; i++) {
        residual[i] = isfinite(residual[i]) ? residual[i] : wall;
    }
    return 0;
}

static dea_status library_load(minpack_lmdif1 **lmdif1, dea_error *error)
{
    void *handle = dlopen(library_name, RTLD_NOW | RTLD_LOCAL | RTLD_NODELETE);
    if (handle) {
        *(void **)lmdif1 = dlsym(handle, "lmdif1");
        dlclose(handle);
    }
    return handle && *lmdif1 ? DEA_OK
                             : dea_fail(error, DEA_ERROR_MISSING,
                                        "to fit this law needs the library cminpack, %s (Debian: package libcminpack1)",
                                        library_name);
}

dea_status dea_minpack_least(dea_residuals *residuals, void *user, size_t rows, size_t count, double *x, double *squares,
                             dea_error *error)
{
    minpack_lmdif1 *lmdif1 = NULL;
    const dea_status status = library_load(&lmdif1, error);
    if (status != DEA_OK) {
        return status;
    }
    const size_t work_size = rows * count + 5 * count + rows;
    double *work = malloc((work_size + rows) * sizeof *work);
    int *whole = malloc(count * sizeof *whole);
    if (work && whole) {
        problem p = {residuals, user};
        double *residual = work + work_size;
        lmdif1(evaluate, &p, (int)rows, (int)count, x, residual, tolerance, whole, work, (int)work_size);
        *squares = 0.0;
        for (size_t i = 0; i < rows; i++) {
            *squares += residual[i] * residual[i];
        }
    }
    const bool done = work && whole;
    free(work);
    free(whole);
    return done ? DEA_OK : dea_fail(error, DEA_ERROR_MEMORY, "out of memory");
}
