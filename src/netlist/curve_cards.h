/* The curved parts of a source's voltage as cards: SIN sources in series where its tones keep their frequencies, else behavioural
 * sources of the time. */
#ifndef DEA_CURVE_CARDS_H
#define DEA_CURVE_CARDS_H

#include "drive/signal.h"
#include "netlist/part_text.h"

/* Most behavioural sources of one netlist: a burst that repeats more often takes a shorter run. */
enum { DEA_CURVE_CARDS_MAX = 200 };

typedef struct dea_curve_cards {
    FILE *out;
    const dea_dialect *dialect;
    const dea_signal *signal;
    size_t first, count; /* segments of the netlist, curved or constant */
    double begin;        /* time of the run at which the netlist's begins [s] */
    const char *node;    /* of the source, against ground */
} dea_curve_cards;

/* True where a segment of the signal is curved. */
bool dea_signal_curves(const dea_signal *signal);
/* False where there would be too many of them. */
bool dea_curve_cards_fit(const dea_signal *signal);
/* Writes the cards, the first of them `vsource`, through which the source's current flows. */
void dea_curve_cards_write(const dea_curve_cards *cards);

#endif
