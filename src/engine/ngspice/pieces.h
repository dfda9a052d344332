/* A transient cut into pieces of constant time step, and the linear film about an operating point that decides both.
 *
 * Film about a point, s the complex frequency: D(s) = m s^2 + r s + K + sum k_i s tau_i/(1 + s tau_i) + T^2 s/(s C + 1/R_s +
 * 1/R_p). */
#ifndef DEA_NGSPICE_PIECES_H
#define DEA_NGSPICE_PIECES_H

#include <complex.h>

#include "drive/signal.h"
#include "network/membrane.h"

/* Its motion: the oscillating pair of roots of D, and the times of the rest. */
typedef struct dea_pace {
    double omega;   /* angular frequency [rad/s], 0: it does not oscillate */
    double decay;   /* of the ring [1/s] */
    double fastest; /* shortest time in which something else than the ring settles [s], +inf: nothing does */
} dea_pace;

/* The trapezoidal rule replaces s by (2/h) tanh(s h/2). Mass and resistance that make the ring's roots those of the film in spite
 * of it; with h -> 0 mass and nothing. */
typedef struct dea_matching {
    double mass;         /* [kg] */
    double resistance;   /* to add [N s/m] */
    double complex ring; /* the root that is matched, 0: none [1/s] */
    double complex root; /* that of the network with this mass and resistance [1/s] */
} dea_matching;

typedef struct dea_piece {
    double from, to; /* [s] */
    double step;     /* time step at fineness 1 [s] */
    size_t segment;  /* of the signal, of `from` */
    bool jump;       /* the voltage jumps at `from` */
    bool rings;      /* the ring lives */
} dea_piece;

typedef struct dea_pieces {
    dea_piece *pieces; /* owned */
    size_t count;
    double points; /* time steps of them all at fineness 1 */
} dea_pieces;

dea_pace dea_pace_of(dea_dynamics *dynamics, double u, double voltage);
/* The same of the slowest mode of a membrane at rest, which decays as fast as that; as to the rest of its film. */
dea_pace dea_pace_of_rings(const dea_membrane *membrane, const dea_membrane_rest *rest, double decay);
dea_matching dea_matching_of(dea_dynamics *dynamics, double u, double voltage, double step);

/* Cuts the run; @p quiet: the film rests until the voltage changes first. A ring counts as dead @p life behind a corner of the
 * voltage [s]; 0: once it has decayed by @p accuracy. The caller frees pieces->pieces. DEA_ERROR_MEMORY. */
dea_status dea_pieces_cut(const dea_signal *signal, const dea_pace *pace, double accuracy, double life, bool quiet,
                          dea_pieces *pieces, dea_error *error);

/* Time in which the ring lives [s]. */
double dea_pieces_ringing(const dea_pieces *pieces);

#endif
