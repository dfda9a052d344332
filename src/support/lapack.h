/* The functions of LAPACKE that are needed here, from a library that is loaded when the first of them is called, and with one
 * thread: threads of a BLAS would not survive the fork of a worker, hang where memory is short, and end the program by SIGINT
 * where they cannot start. Arguments and results are those of the function without "dea_"; there is one more result,
 * DEA_LAPACK_MISSING. */
#ifndef DEA_SUPPORT_LAPACK_H
#define DEA_SUPPORT_LAPACK_H

#include <lapacke.h>

#include "deaspice/status.h"

enum { DEA_LAPACK_MISSING = -9999 };

/* Loads the library, so that no later call finds it missing: DEA_OK, DEA_ERROR_MISSING or DEA_ERROR_MEMORY. */
dea_status dea_lapack_load(dea_error *error);

lapack_int dea_lapacke_dgeev(int layout, char left, char right, lapack_int n, double *a, lapack_int lda, double *wr, double *wi,
                             double *vl, lapack_int ldvl, double *vr, lapack_int ldvr);
lapack_int dea_lapacke_dgels(int layout, char trans, lapack_int m, lapack_int n, lapack_int nrhs, double *a, lapack_int lda,
                             double *b, lapack_int ldb);
lapack_int dea_lapacke_dgesvd(int layout, char jobu, char jobvt, lapack_int m, lapack_int n, double *a, lapack_int lda, double *s,
                              double *u, lapack_int ldu, double *vt, lapack_int ldvt, double *superb);
lapack_int dea_lapacke_dgetrf(int layout, lapack_int m, lapack_int n, double *a, lapack_int lda, lapack_int *ipiv);
lapack_int dea_lapacke_dgetri(int layout, lapack_int n, double *a, lapack_int lda, const lapack_int *ipiv);
lapack_int dea_lapacke_dposv(int layout, char uplo, lapack_int n, lapack_int nrhs, double *a, lapack_int lda, double *b, lapack_int ldb);
lapack_int dea_lapacke_dsyev(int layout, char jobz, char uplo, lapack_int n, double *a, lapack_int lda, double *w);
lapack_int dea_lapacke_zgesv(int layout, lapack_int n, lapack_int nrhs, lapack_complex_double *a, lapack_int lda, lapack_int *ipiv,
                             lapack_complex_double *b, lapack_int ldb);

#endif
