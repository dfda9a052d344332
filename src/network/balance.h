/* Equilibrium of a network with one edge: is a displacement the one that is connected to rest, and what is its result row.
 *
 * With R(u) the elastic force less what is steady, T(u), and F(u) the full load, the share of the load that holds u is t(u) = R/F. The
 * equilibrium connected to rest is the first u with t = 1 up to which t grows; t' has the sign of the stiffness R' - (R/F) F'.
 * Rest is u = 0, or where something is steady the first equilibrium R = 0 on the way from there as T grows from nothing, found
 * likewise. */
#ifndef DEA_BALANCE_H
#define DEA_BALANCE_H

#include "network/network.h"

typedef struct dea_balance {
    dea_tape forces; /* owned: R, F, T */
    bool steady;     /* there is a T */
    dea_tape limits; /* owned: what a row and the ranges need */
    int range_count, tension_count;
    dea_kind kind;
    double sign; /* of u less rest */
    bool ends;   /* a region vanishes where the edge comes to the centre or the frame */
    double symbol, rest; /* where something is steady: the rest [m] at that symbol, NAN: none */
} dea_balance;

/* R, F and their slopes at one u. */
typedef struct dea_forces {
    double elastic, elastic_slope; /* R [N], R' [N/m] */
    double load, load_slope;       /* F [N], F' [N/m] */
} dea_forces;

/* Compiles a network; the caller ends it with dea_balance_close(). The network may go before it. */
dea_status dea_balance_open(dea_network *network, dea_balance *balance, dea_error *error);
void dea_balance_close(dea_balance *balance);

/* True where coverage, permittivity and elastic constants are in range at this value of the swept scalar. */
bool dea_balance_valid(dea_balance *balance, double symbol);
dea_forces dea_balance_forces(dea_balance *balance, double symbol, double u);
/* Where the film rests without load at this value of the swept scalar [m], NAN: there is no equilibrium. */
double dea_balance_rest(dea_balance *balance, double symbol);
/* R' - (R/F) F' [N/m]. */
double dea_forces_stiffness(const dea_forces *forces);
/* Takes u as the answer of a point and fills its row, if u balances the forces to @p tolerance (relative, of u) and no fold lies
 * between rest and u; else false, as where the point is not valid. */
bool dea_balance_accept(dea_balance *balance, double symbol, double u, double tolerance, dea_row *row);
/* Share of the load at which the equilibrium from rest folds, if that is below 1, and the displacement of the fold; else false.
 */
bool dea_balance_folds(dea_balance *balance, double symbol, double *share, double *u);
/* Fills the row of equilibrium u. */
void dea_balance_fill(dea_balance *balance, double symbol, double u, dea_row *row);
/* r_a at the point that was evaluated last [m]. */
double dea_balance_radius(const dea_balance *balance);
/* Size of the film at the point that was evaluated last [m]: below both r_a and r - r_a. */
double dea_balance_length(const dea_balance *balance);
/* Distance from rest at which a region has vanished, at that point, whose rest was found last [m]; far out where there is none. */
double dea_balance_end(const dea_balance *balance);

#endif
