/* The source voltage of a transient as segments: each linear in time or part of one sine, without gaps from 0 to the end. */
#ifndef DEA_SIGNAL_H
#define DEA_SIGNAL_H

#include "deaspice/scene.h"

typedef struct dea_segment {
    double from, to;   /* [s], from < to */
    double start, end; /* voltage at from, behind an edge there, and at to, before one [V] */
    bool sine;         /* in between that of the signal's sine, else linear */
} dea_segment;

typedef struct dea_signal {
    dea_segment *segments; /* owned */
    size_t count;          /* >= 1 */
    dea_sine sine;         /* of segments that are part of one */
    double largest;        /* |U| over the run [V] */
} dea_signal;

/* Segments of the scene's waveform from 0 to `until`; the caller ends it with dea_signal_close(), also after a failure.
 * Neighbours that continue each other are one segment: a corner
 * that rounding of its time and voltage can explain is none. DEA_ERROR_MEMORY. */
dea_status dea_signal_open(const dea_scene *scene, dea_signal *signal, dea_error *error);
void dea_signal_close(dea_signal *signal);

/* Voltage [V], its slope [V/s] and its curvature [V/s^2] inside a segment, ends included. */
double dea_segment_voltage(const dea_signal *signal, const dea_segment *segment, double time);
double dea_segment_slope(const dea_signal *signal, const dea_segment *segment, double time);
double dea_segment_curvature(const dea_signal *signal, const dea_segment *segment, double time);

/* Voltage at a time counted from the begin of the segment, so that a short edge late in a run keeps its digits [V]. */
double dea_segment_voltage_since(const dea_signal *signal, const dea_segment *segment, double since);

/* The segment of a time, searched from segment number @p near on: from < time <= to, the first one at its begin too. */
size_t dea_signal_find(const dea_signal *signal, size_t near, double time);

#endif
