/* The two forms in which a work-precision study is written. */
#ifndef DEASPICE_OUTPUT_BENCH_H
#define DEASPICE_OUTPUT_BENCH_H

#include "deaspice/bench.h"
#include "output/gnuplot.h"

/* Writes the table into an open file. */
dea_status dea_bench_table(const dea_bench *bench, dea_atomic *file, dea_error *error);
/* Writes the script of the picture. */
dea_status dea_bench_picture(const dea_bench *bench, dea_gnuplot *picture, dea_error *error);

#endif
