/* A record, or the edges of a pulse-width modulated driver, thinned to what the samples of a run can see. */
#ifndef DEA_THIN_H
#define DEA_THIN_H

#include "drive/signal.h"
#include "network/dynamics.h"

/* Lets polynomials stand for many lines of the signal where that changes no sample by more than a small share of the accuracy,
 * signal->thinned; velocities count with @p pace, 1/T of their scale [1/s]. Only where a mass or a damper takes in the square of the
 * voltage, without a series resistance. DEA_ERROR_MEMORY. */
dea_status dea_signal_thin(dea_signal *signal, const dea_scene *scene, dea_dynamics *dynamics, double pace, dea_error *error);

#endif
