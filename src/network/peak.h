/* The largest current of the source over a run, between its samples too. */
#ifndef DEA_PEAK_H
#define DEA_PEAK_H

typedef struct dea_peak {
    double current; /* magnitude [A], 0 before any was seen */
    double time;    /* when [s] */
} dea_peak;

/* The current at a time [A]. */
typedef double dea_current_at(void *user, double time);

/* Sees a stretch over which the current is smooth: its ends, and its largest inside where that may be the largest of all. */
void dea_peak_search(dea_peak *peak, double from, double to, dea_current_at *at, void *user);

#endif
