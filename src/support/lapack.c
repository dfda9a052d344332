#include "support/lapack.h"

#include <dlfcn.h>
#include <stdlib.h>
#include <string.h>
#include <sys/mman.h>

#define LAPACK_LIST(X) X(dgeev) X(dgels) X(dgesvd) X(dgetrf) X(dgetri) X(dposv) X(dsyev) X(zgesv)

typedef struct lapack {
#define X(name) __typeof__(&LAPACKE_##name) name;
    LAPACK_LIST(X)
#undef X
} lapack;

#ifdef DEA_LAPACKE /* name of the shared library; without one it is linked in */

/* What the usual libraries ask for their number of threads, once, when they are loaded. */
static const char *const thread_variables[] = {"OPENBLAS_NUM_THREADS", "OMP_NUM_THREADS", "MKL_NUM_THREADS", "BLIS_NUM_THREADS"};

static const int flags = RTLD_NOW | RTLD_LOCAL | RTLD_NODELETE;

/* Address space for the library with those that it needs, and for the work space of OpenBLAS (measured: 50 and 131 MB, in the
 * build with OpenMP 182 and 131 MB). */
static const size_t library_size = (size_t)64 << 20, work_space_size = (size_t)136 << 20;

enum { THREAD_VARIABLES = sizeof thread_variables / sizeof *thread_variables };

/* Loads it with these variables at 1, and puts them back. */
static void *load_single(const char *name, int how)
{
    char *before[THREAD_VARIABLES];
    for (size_t i = 0; i < THREAD_VARIABLES; i++) {
        const char *value = getenv(thread_variables[i]);
        before[i] = value ? strdup(value) : NULL;
        setenv(thread_variables[i], "1", 1);
    }
    void *handle = dlopen(name, how);
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

/* Is that much of the address space left? */
static bool has_room(size_t size)
{
    void *room = mmap(NULL, size, PROT_NONE, MAP_PRIVATE | MAP_ANONYMOUS | MAP_NORESERVE, -1, 0);
    if (room != MAP_FAILED) {
        munmap(room, size);
    }
    return room != MAP_FAILED;
}

/* OpenBLAS waits for ever for a work space that it cannot get, and keeps the one that it got: so it gets it at once. Its build
 * with OpenMP does not look at the variables where that is there already, as ngspice has it. */
static bool work_space(void *handle)
{
    double one = 1.0;
    lapack_int pivot;
    void (*set_threads)(int);
    __typeof__(&LAPACKE_dgetrf) factor;
    *(void **)&set_threads = dlsym(handle, "openblas_set_num_threads");
    if (!set_threads) {
        return true;
    }
    set_threads(1);
    *(void **)&factor = dlsym(handle, "LAPACKE_dgetrf");
    return factor && has_room(work_space_size) && factor(LAPACK_COL_MAJOR, 1, 1, &one, 1, &pivot) == 0;
}

static dea_status library_load(dea_error *error)
{
    void *handle = has_room(library_size) ? load_single(DEA_LAPACKE, RTLD_NOW | RTLD_LOCAL) : NULL;
    const bool roomy = handle ? work_space(handle) : has_room(library_size);
    const bool kept = handle && roomy && dlopen(DEA_LAPACKE, flags | RTLD_NOLOAD);
    if (handle) {
        dlclose(handle);
    }
    if (!roomy) {
        return dea_fail(error, DEA_ERROR_MEMORY, "out of memory: LAPACK needs some %zu MB more than the limit leaves",
                        (library_size + work_space_size) >> 20);
    }
    return kept ? DEA_OK
                : dea_fail(error, DEA_ERROR_MISSING, "this needs the library LAPACKE, %s (Debian: package liblapacke)",
                           DEA_LAPACKE);
}

dea_status dea_lapack_load(dea_error *error)
{
    void *handle = dlopen(DEA_LAPACKE, flags | RTLD_NOLOAD);
    if (!handle) {
        return library_load(error);
    }
    dlclose(handle);
    return DEA_OK;
}

/* Finds the functions; a library that is there already is found again within 2 us, so nothing needs to be kept. */
static bool find(lapack *out)
{
    void *handle = dea_lapack_load(NULL) == DEA_OK ? dlopen(DEA_LAPACKE, flags | RTLD_NOLOAD) : NULL;
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

/* The same function where it is found. */
#define LAPACK_CALL(name, parameters, arguments)                                                                                 \
    lapack_int dea_lapacke_##name parameters                                                                                     \
    {                                                                                                                            \
        lapack l;                                                                                                                \
        return find(&l) ? l.name arguments : DEA_LAPACK_MISSING;                                                                 \
    }
LAPACK_CALL(dgeev, (int layout, char left, char right, lapack_int n, double *a, lapack_int lda, double *wr, double *wi,
              double *vl, lapack_int ldvl, double *vr, lapack_int ldvr),
            (layout, left, right, n, a, lda, wr, wi, vl, ldvl, vr, ldvr))
LAPACK_CALL(dgels, (int layout, char trans, lapack_int m, lapack_int n, lapack_int nrhs, double *a, lapack_int lda, double *b,
              lapack_int ldb), (layout, trans, m, n, nrhs, a, lda, b, ldb))
LAPACK_CALL(dgesvd, (int layout, char jobu, char jobvt, lapack_int m, lapack_int n, double *a, lapack_int lda, double *s,
              double *u, lapack_int ldu, double *vt, lapack_int ldvt, double *superb),
            (layout, jobu, jobvt, m, n, a, lda, s, u, ldu, vt, ldvt, superb))
LAPACK_CALL(dgetrf, (int layout, lapack_int m, lapack_int n, double *a, lapack_int lda, lapack_int *ipiv),
            (layout, m, n, a, lda, ipiv))
LAPACK_CALL(dgetri, (int layout, lapack_int n, double *a, lapack_int lda, const lapack_int *ipiv), (layout, n, a, lda, ipiv))
LAPACK_CALL(dposv, (int layout, char uplo, lapack_int n, lapack_int nrhs, double *a, lapack_int lda, double *b, lapack_int ldb),
            (layout, uplo, n, nrhs, a, lda, b, ldb))
LAPACK_CALL(dsyev, (int layout, char jobz, char uplo, lapack_int n, double *a, lapack_int lda, double *w),
            (layout, jobz, uplo, n, a, lda, w))
LAPACK_CALL(zgesv, (int layout, lapack_int n, lapack_int nrhs, lapack_complex_double *a, lapack_int lda, lapack_int *ipiv,
              lapack_complex_double *b, lapack_int ldb), (layout, n, nrhs, a, lda, ipiv, b, ldb))
