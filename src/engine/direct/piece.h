/* One segment of the source voltage as a force on the modes, and what happens to the energies during it. */
#ifndef DEA_DIRECT_PIECE_H
#define DEA_DIRECT_PIECE_H

#include "drive/signal.h"
#include "engine/direct/modes.h"
#include "network/dynamics.h"

enum { DEA_HARMONICS = 2 };

/* F(t) = force (value + slope t + bend t^2/2) + Re sum harmonics[k] e^{i (k+1) omega t}, t from the begin of the segment. */
typedef struct dea_piece {
    const dea_signal *signal;
    const dea_segment *segment;
    double length;                              /* [s] */
    double per_square;                          /* F/U^2 [N/V^2] */
    dea_forcing force;                          /* at the begin */
    double omega;                               /* of a sine [rad/s], else 0 */
    double complex harmonics[DEA_HARMONICS];    /* [N] */
    double complex displacement[DEA_HARMONICS]; /* what they do to u: harmonics/p(i k omega) [m] */
} dea_piece;

/* The force f U^2 of a segment on a network with these modes. */
dea_piece dea_piece_make(const dea_signal *signal, const dea_segment *segment, const dea_linear *linear, const dea_modes *modes);
/* Force at time t of the piece without the harmonics; e^{i omega t} of the sine there. */
dea_forcing dea_piece_force(const dea_piece *piece, double t);
double complex dea_piece_turn(const dea_piece *piece, double t);
/* Adds @p sign times what the harmonics do to the course at time t: the modes move as if they were not there. */
void dea_piece_shift(const dea_piece *piece, const dea_modes *modes, double t, double sign, dea_course *course);

/* Sum of the parts into which the harmonics take the displacement apart [m]: what their rounding scales with. */
double dea_piece_parts(const dea_piece *piece, const dea_modes *modes);

/* Displacement and velocity at time t from the course without harmonics. */
typedef struct dea_motion {
    double u, v; /* [m], [m/s] */
} dea_motion;
dea_motion dea_piece_motion(const dea_piece *piece, const dea_modes *modes, const dea_course *course, double t);

/* Integral of the displacement from time @p from to @p to of the piece [m s]; @p start: the course without harmonics at its begin. */
double dea_piece_integral(const dea_piece *piece, const dea_modes *modes, const dea_course *start, double from, double to);

/* Energies that change during a piece, each an integral of its own. */
typedef struct dea_spent {
    double push;     /* int F v dt [J] */
    double damper;   /* int r v^2 dt [J] */
    double branches; /* int sum (k_i/q_i) z_i'^2 dt [J] */
    double square;   /* int U^2 dt [V^2 s] */
} dea_spent;
dea_spent dea_piece_spend(const dea_piece *piece, const dea_modes *modes, const dea_course *start);

#endif
