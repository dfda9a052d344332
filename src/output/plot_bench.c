#include "deaspice/bench.h"
dea_status dea_bench_plot(const dea_bench *bench, const char *path, dea_error *error){(void)bench;(void)path;return dea_fail(error, DEA_ERROR_USAGE,"x");}
