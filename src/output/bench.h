/* A work-precision study as a table. */
#ifndef DEASPICE_OUTPUT_BENCH_H
#define DEASPICE_OUTPUT_BENCH_H

#include "deaspice/bench.h"
#include "support/atomic.h"

/* Writes the table into an open file. */
dea_status dea_bench_table(const dea_bench *bench, dea_atomic *file, dea_error *error);

#endif
