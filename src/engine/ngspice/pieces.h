/* A transient cut into pieces of constant time step. */
#ifndef DEA_NGSPICE_PIECES_H
#define DEA_NGSPICE_PIECES_H

#include "drive/signal.h"
#include "network/pace.h"

typedef struct dea_piece {
    double from, to; /* [s] */
    double step;     /* time step at fineness 1 [s] */
    double longest;  /* of the segments inside [s] */
    size_t segment;  /* of the signal, of `from` */
    bool jump;       /* the voltage jumps at `from` */
    bool rings;      /* the ring lives */
} dea_piece;

typedef struct dea_pieces {
    dea_piece *pieces; /* owned */
    size_t count;
    double points;  /* time steps of them all at fineness 1, */
    double corners; /* and corners of the voltage inside them, behind which the library's steps begin short */
} dea_pieces;

/* Cuts the run; @p quiet: the film rests until the voltage changes first. A ring counts as dead @p life behind a corner of the
 * voltage [s]; 0: once it has decayed by @p accuracy. The caller frees pieces->pieces. DEA_ERROR_MEMORY. */
dea_status dea_pieces_cut(const dea_signal *signal, const dea_pace *pace, double accuracy, double life, bool quiet,
                          dea_pieces *pieces, dea_error *error);

/* Time in which the ring lives [s]. */
double dea_pieces_ringing(const dea_pieces *pieces);

#endif
