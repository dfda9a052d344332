/* The damped swing of the film about an equilibrium: the one pair of complex roots that the linearised network can have. With the
 * film's own branches k_i = c_i sum B_a S_a', q_i = 1/tau_i and, under a voltage behind a series resistance, the charge as one
 * more, k = (2 phi U)^2/C, q = (1/R_s + 1/R_p)/C,
 *
 *   D(s) = m s^2 + r s + K + sum k_i s/(s + q_i) = 0. */
#ifndef DEA_SWING_H
#define DEA_SWING_H

#include "network/dynamics.h"

typedef struct dea_swing {
    double frequency; /* |Im s|/(2 pi) [Hz], NAN: none, without mass or overdamped */
    double decay;     /* -Re s [1/s], 0: undamped; NAN: no swing */
} dea_swing;

/* The swing about the equilibrium u under film voltage U; none where that is not stable. */
dea_swing dea_swing_of(dea_dynamics *dynamics, double u, double voltage);
/* That of the free film: at rest, 0 V, nothing left out; none for a model that is not dynamic. */
dea_swing dea_swing_free(const dea_scene *scene, const dea_model *model);

#endif
