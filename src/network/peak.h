/* The largest current of the source over a run, between its samples too. */
#ifndef DEA_PEAK_H
#define DEA_PEAK_H

#include "drive/signal.h"
#include "network/dynamics.h"

typedef struct dea_peak {
    double current; /* magnitude [A], 0 before any was seen */
    double time;    /* when [s] */
} dea_peak;

/* The current at a time [A]. */
typedef double dea_current_at(void *user, double time);

/* Sees a stretch over which the current is smooth: its ends, and its largest inside where that may be the largest of all. */
void dea_peak_search(dea_peak *peak, double from, double to, dea_current_at *at, void *user);

/* Tells the peak of the last of two runs where they agree about it within ten times the accuracy. */
void dea_peak_tell(const dea_peak *before, const dea_peak *last, double accuracy, dea_summary *summary);

/* True where a run knows the current between its samples: the scene has an electrical port, the run leaves nothing out that moves
 * or charges the film faster than they see (it keeps mass, damper and resistance, and of the branches leaves out no more than that
 * slow ones relax), and a series resistance limits the current where the voltage jumps. */
bool dea_peak_is_known(const dea_scene *scene, const dea_dynamics *dynamics, const dea_signal *signal);

/* True where a segment begins with another voltage than that before it ends with: 0 V before the first, unless at bias. */
bool dea_peak_jumps(const dea_scene *scene, const dea_signal *signal);

#endif
