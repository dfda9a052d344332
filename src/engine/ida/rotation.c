#include "engine/ida/rotation.h"

#include <math.h>
#include <string.h>

#include "support/lapack.h"

/* Radians of a segment that make a swing worth it, and its least quality Im lambda/|Re lambda|. */
static const double long_enough = 6.0;
static const double light_enough = 4.0;

/* Sizes of an unknown. */
static const double far_away = 30.0;

enum { N = DEA_MOTION_MOST };

static void multiply(int n, const double *a, const double *x, double *out)
{
    memset(out, 0, (size_t)n * sizeof *out);
    for (int k = 0; k < n; k++) {
        for (int i = 0; i < n; i++) {
            out[i] += a[k * n + i] * x[k];
        }
    }
}

/* X from the right and left eigenvectors x, l of the pair: y = Re(x a) + what l^H leaves of the other unit vectors. */
static void build_basis(const double *right, const double *left, dea_rotation *swing)
{
    const int n = swing->n;
    const double *xr = right, *xi = right + n;
    const double *lr = left, *li = left + n;
    double dr = 0.0; /* l^H x */
    double di = 0.0;
    for (int i = 0; i < n; i++) {
        dr += lr[i] * xr[i] + li[i] * xi[i];
        di += lr[i] * xi[i] - li[i] * xr[i];
    }
    const double square = dr * dr + di * di;
    memset(swing->basis, 0, (size_t)(n * n) * sizeof *swing->basis);
    for (int i = 0; i < n; i++) {
        swing->basis[i] = xr[i];
        swing->basis[n + i] = -xi[i];
    }
    for (int k = 2; k < n; k++) {
        const double ar = (lr[k] * dr - li[k] * di) / square; /* conj(l_k)/(l^H x) */
        const double ai = -(lr[k] * di + li[k] * dr) / square;
        for (int i = 0; i < n; i++) {
            swing->basis[k * n + i] = (i == k ? 1.0 : 0.0) - 2.0 * (xr[i] * ar - xi[i] * ai);
        }
    }
}

static bool invert(dea_rotation *swing)
{
    const int n = swing->n;
    lapack_int pivots[N];
    memcpy(swing->inverse, swing->basis, (size_t)(n * n) * sizeof *swing->basis);
    return dea_lapacke_dgetrf(LAPACK_COL_MAJOR, n, n, swing->inverse, n, pivots) == 0 &&
           dea_lapacke_dgetri(LAPACK_COL_MAJOR, n, swing->inverse, n, pivots) == 0;
}

/* X^-1 J X - Omega. */
static void turn_jacobian(const double *jacobian, dea_rotation *swing)
{
    const int n = swing->n;
    double column[N];
    for (int k = 0; k < n; k++) {
        multiply(n, jacobian, swing->basis + k * n, column);
        multiply(n, swing->inverse, column, swing->jacobian + k * n);
    }
    swing->jacobian[1] -= swing->omega;
    swing->jacobian[n] += swing->omega;
}

/* Eigenvalues and eigenvectors of the Jacobian: the pair that turns fastest, and what else there is. */
static int find_pair(const double *real, const double *imaginary, dea_rotation *swing)
{
    int pair = 0;
    for (int i = 1; i < swing->n; i++) {
        pair = imaginary[i] > imaginary[pair] ? i : pair;
    }
    swing->omega = imaginary[pair];
    swing->decay = fmax(0.0, -real[pair]);
    swing->fastest = swing->stiffest = 0.0;
    for (int i = 0; i < swing->n; i++) {
        swing->stiffest = fmax(swing->stiffest, hypot(real[i], imaginary[i]));
        if (i != pair && i != pair + 1) {
            swing->fastest = fmax(swing->fastest, hypot(real[i], imaginary[i]));
        }
    }
    return pair;
}

void dea_rotation_stop(dea_rotation *swing)
{
    swing->turns = false;
}

/* The equilibrium under the voltage; rest instead where that lies far beyond what the run reaches, of which the unknowns have
 * their sizes: behind a large series resistance the digits of a small answer would drown in it. */
static bool find_center(const dea_motion *motion, double *center)
{
    double largest = 0.0;
    if (!dea_motion_start(motion, true, center)) {
        return false;
    }
    for (int i = 0; i < motion->count; i++) {
        largest = fmax(largest, fabs(center[i]));
    }
    return motion->q < 0 || largest < far_away || dea_motion_start(motion, false, center);
}

void dea_rotation_find(const dea_motion *motion, dea_rotation *swing)
{
    const dea_segment *segment = motion->segment;
    const int n = swing->n = motion->count;
    double jacobian[N * N], work[N * N], left[N * N], right[N * N], real[N], imaginary[N];
    swing->turns = swing->light = false;
    swing->stiffest = INFINITY;
    if ((motion->v < 0 && !segment->terms) || motion->algebraic || !find_center(motion, swing->center)) {
        return;
    }
    dea_motion_jacobian(motion, 0.0, swing->center, jacobian);
    memcpy(work, jacobian, (size_t)(n * n) * sizeof *work);
    if (dea_lapacke_dgeev(LAPACK_COL_MAJOR, 'V', 'V', n, work, n, real, imaginary, left, n, right, n) != 0) {
        return;
    }
    const int pair = find_pair(real, imaginary, swing);
    swing->light = swing->omega * (segment->to - segment->from) > long_enough && swing->omega > light_enough * fabs(real[pair]);
    if (!swing->light || segment->sine || segment->start != segment->end) {
        return;
    }
    build_basis(right + pair * n, left + pair * n, swing);
    if (invert(swing)) {
        turn_jacobian(jacobian, swing);
        swing->turns = true;
    }
}

dea_turn dea_rotation_turn(const dea_rotation *swing, double time, double angle)
{
    const double whole = swing->omega * time + angle;
    return swing->turns ? (dea_turn){cos(whole), sin(whole)} : (dea_turn){1.0, 0.0};
}

void dea_rotation_state(const dea_rotation *swing, dea_turn turn, const double *w, double *y)
{
    const int n = swing->n;
    double turned[N];
    if (!swing->turns) {
        memcpy(y, w, (size_t)n * sizeof *y);
        return;
    }
    memcpy(turned, w, (size_t)n * sizeof *y);
    turned[0] = turn.c * w[0] - turn.s * w[1];
    turned[1] = turn.s * w[0] + turn.c * w[1];
    multiply(n, swing->basis, turned, y);
    for (int i = 0; i < n; i++) {
        y[i] += swing->center[i];
    }
}

static void turn_back(dea_turn turn, double *w)
{
    const double first = turn.c * w[0] + turn.s * w[1];
    w[1] = -turn.s * w[0] + turn.c * w[1];
    w[0] = first;
}

void dea_rotation_unknowns(const dea_rotation *swing, dea_turn turn, const double *y, double *w)
{
    const int n = swing->n;
    double change[N];
    if (!swing->turns) {
        memcpy(w, y, (size_t)n * sizeof *w);
        return;
    }
    for (int i = 0; i < n; i++) {
        change[i] = y[i] - swing->center[i];
    }
    multiply(n, swing->inverse, change, w);
    turn_back(turn, w);
}

void dea_rotation_rates(const dea_rotation *swing, dea_turn turn, const double *w, const double *f, double *rates)
{
    const int n = swing->n;
    if (!swing->turns) {
        memcpy(rates, f, (size_t)n * sizeof *rates);
        return;
    }
    multiply(n, swing->inverse, f, rates);
    turn_back(turn, rates);
    rates[0] += swing->omega * w[1];
    rates[1] -= swing->omega * w[0];
}
