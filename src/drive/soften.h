/* Runs of lines as one segment, for engines whose steps follow what they see. */
#ifndef DEA_SOFTEN_H
#define DEA_SOFTEN_H

#include "drive/signal.h"

/* Draws lines that continue each other together to segments with `lines`, whose voltage stays what it is: those whose corners are
 * small for this accuracy, and whatever their corners, which are marked as such, those that take no longer than @p shorter [s].
 * DEA_ERROR_MEMORY. */
dea_status dea_signal_soften(dea_signal *signal, double accuracy, double shorter, dea_error *error);

#endif
