/* Variation of constants about a lightly damped swing. While the voltage rests, y = y_0 + X R(t) w with the relaxed equilibrium
 * y_0, the oscillating pair lambda, x of the Jacobian there in the first two columns of X, the invariant subspace of all else in
 * the others, and R(t) a rotation of the first two unknowns by omega = Im lambda:
 *
 *     w' = R^-1 X^-1 f(y) - Omega w.
 *
 * It holds for every f. Where f is linear w only decays, so that steps pass over many periods. */
#ifndef DEA_IDA_ROTATION_H
#define DEA_IDA_ROTATION_H

#include "network/motion.h"

typedef struct dea_rotation {
    int n;
    bool light;     /* the segment holds a lightly damped swing */
    bool turns;     /* and its voltage rests, else y = w */
    double omega;   /* of the swing [rad/s] */
    double decay;   /* -Re lambda of the swing [1/s], 0: it does not decay */
    double fastest; /* of the other eigenvalues [1/s] */
    double stiffest; /* of all eigenvalues [1/s], +inf: not known */
    double center[DEA_MOTION_MOST];
    double basis[DEA_MOTION_MOST * DEA_MOTION_MOST];    /* X, column by column, as all matrices here */
    double inverse[DEA_MOTION_MOST * DEA_MOTION_MOST];  /* X^-1 */
    double jacobian[DEA_MOTION_MOST * DEA_MOTION_MOST]; /* of w' at the equilibrium */
} dea_rotation;

/* Cosine and sine of the angle by which R turns. */
typedef struct dea_turn {
    double c, s;
} dea_turn;

/* Looks for the swing of the motion's segment; none is no failure. */
void dea_rotation_find(const dea_motion *motion, dea_rotation *swing);
/* Makes y = w. */
void dea_rotation_stop(dea_rotation *swing);
/* R at a time; an angle on top turns the swing and leaves all else. */
dea_turn dea_rotation_turn(const dea_rotation *swing, double time, double angle);
/* w to y, y to w, and f to w'. In and out may not overlap. */
void dea_rotation_state(const dea_rotation *swing, dea_turn turn, const double *w, double *y);
void dea_rotation_unknowns(const dea_rotation *swing, dea_turn turn, const double *y, double *w);
void dea_rotation_rates(const dea_rotation *swing, dea_turn turn, const double *w, const double *f, double *rates);

#endif
