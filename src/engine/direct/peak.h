#ifndef DEA_DIRECT_PEAK_H
#define DEA_DIRECT_PEAK_H

#include "engine/direct/walk.h"
#include "network/peak.h"

/* Sees the current of the source over a segment that was entered, without series resistance: the walk, its piece and the course at
 * its begin. False where a ring or a sine turns too often for that. */
bool dea_direct_peak(const dea_walk *walk, const dea_piece *piece, const dea_course *start, dea_dynamics *dynamics, dea_peak *peak);

#endif
