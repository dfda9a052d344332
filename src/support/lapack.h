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

__typeof__(LAPACKE_dgeev) dea_lapacke_dgeev;
__typeof__(LAPACKE_dgels) dea_lapacke_dgels;
__typeof__(LAPACKE_dgesvd) dea_lapacke_dgesvd;
__typeof__(LAPACKE_dgetrf) dea_lapacke_dgetrf;
__typeof__(LAPACKE_dgetri) dea_lapacke_dgetri;
__typeof__(LAPACKE_dposv) dea_lapacke_dposv;
__typeof__(LAPACKE_dsyev) dea_lapacke_dsyev;
__typeof__(LAPACKE_zgesv) dea_lapacke_zgesv;

#endif
