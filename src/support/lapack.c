#include "support/lapack.h"

#include <dlfcn.h>
#include <stdlib.h>
#include <string.h>

#define LAPACK_LIST(X) X(dgeev) X(dgels) X(dgesvd) X(dgetrf) X(dgetri)

typedef struct lapack {
#define X(name) __typeof__(&LAPACKE_##name) name;
    LAPACK_LIST(X)
#undef X
} lapack;

#ifdef DEA_LAPACKE /* name of the shared library; without one it is linked in */

/* What the usual libraries ask for their number of threads, once, when they are loaded. */
static const char *const thread_variables[] = {"OPENBLAS_NUM_THREADS", "OMP_NUM_THREADS", "MKL_NUM_THREADS", "BLIS_NUM_THREADS"};

enum { THREAD_VARIABLES = sizeof thread_variables / sizeof *thread_variables };

/* Loads it with these variables at 1, and puts them back. */
static void *load_single(const char *name, int flags)
{
    char *before[THREAD_VARIABLES];
    for (size_t i = 0; i < THREAD_VARIABLES; i++) {
        const char *value = getenv(thread_variables[i]);
        before[i] = value ? strdup(value) : NULL;
        setenv(thread_variables[i], "1", 1);
    }
    void *handle = dlopen(name, flags);
    for (size_t i = 0; i < THREAD_VARIABLES; i++) {
        if (before[i]) {
            setenv(thread_variables[i], before[i], 1);
        } else {
            unsetenv(thread_variables[i]);
        }
        free(before[i]);
    }
    return handle;
}

/* Finds the functions; a library that is there already is found again within 2 us, so nothing needs to be kept. */
static bool find(lapack *out)
{
    const int flags = RTLD_NOW | RTLD_LOCAL | RTLD_NODELETE;
    void *handle = dlopen(DEA_LAPACKE, flags | RTLD_NOLOAD);
    handle = handle ? handle : load_single(DEA_LAPACKE, flags);
    if (!handle) {
        return false;
    }
    bool whole = true;
#define X(name)                                                                                                                  \
    *(void **)&out->name = dlsym(handle, "LAPACKE_" #name);                                                                      \
    whole = whole && out->name;
    LAPACK_LIST(X)
#undef X
    dlclose(handle);
    return whole;
}

dea_status dea_lapack_load(dea_error *error)
{
    lapack found;
    return find(&found) ? DEA_OK
                        : dea_fail(error, DEA_ERROR_MISSING, "this needs the library LAPACKE, %s (Debian: package liblapacke)",
                                   DEA_LAPACKE);
}

#else

static bool find(lapack *out)
{
#define X(name) out->name = LAPACKE_##name;
    LAPACK_LIST(X)
#undef X
    return true;
}

dea_status dea_lapack_load(dea_error *error)
{
    (void)error;
    return DEA_OK;
}

#endif

lapack_int dea_lapacke_dgeev(int layout, char left, char right, lapack_int n, double *a, lapack_int lda, double *wr, double *wi,
                             double *vl, lapack_int ldvl, double *vr, lapack_int ldvr)
{
    lapack l;
    return find(&l) ? l.dgeev(layout, left, right, n, a, lda, wr, wi, vl, ldvl, vr, ldvr) : DEA_LAPACK_MISSING;
}

lapack_int dea_lapacke_dgels(int layout, char trans, lapack_int m, lapack_int n, lapack_int nrhs, double *a, lapack_int lda,
                             double *b, lapack_int ldb)
{
    lapack l;
    return find(&l) ? l.dgels(layout, trans, m, n, nrhs, a, lda, b, ldb) : DEA_LAPACK_MISSING;
}

lapack_int dea_lapacke_dgesvd(int layout, char jobu, char jobvt, lapack_int m, lapack_int n, double *a, lapack_int lda, double *s,
                              double *u, lapack_int ldu, double *vt, lapack_int ldvt, double *superb)
{
    lapack l;
    return find(&l) ? l.dgesvd(layout, jobu, jobvt, m, n, a, lda, s, u, ldu, vt, ldvt, superb) : DEA_LAPACK_MISSING;
}

lapack_int dea_lapacke_dgetrf(int layout, lapack_int m, lapack_int n, double *a, lapack_int lda, lapack_int *ipiv)
{
    lapack l;
    return find(&l) ? l.dgetrf(layout, m, n, a, lda, ipiv) : DEA_LAPACK_MISSING;
}

lapack_int dea_lapacke_dgetri(int layout, lapack_int n, double *a, lapack_int lda, const lapack_int *ipiv)
{
    lapack l;
    return find(&l) ? l.dgetri(layout, n, a, lda, ipiv) : DEA_LAPACK_MISSING;
}
