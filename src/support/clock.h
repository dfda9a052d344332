/* A clock that never goes back. */
#ifndef DEA_SUPPORT_CLOCK_H
#define DEA_SUPPORT_CLOCK_H

#include <time.h>

/* Its time [s]. */
static inline double dea_clock(void)
{
    struct timespec now = {0};
    clock_gettime(CLOCK_MONOTONIC, &now);
    return (double)now.tv_sec + 1e-9 * (double)now.tv_nsec;
}

#endif
