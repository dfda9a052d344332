#include "radau.h"

#include <math.h>

/* ---- linear algebra */

bool dense_solve(int n, long double a[STAGE_UNKNOWNS][STAGE_UNKNOWNS], long double *x)
{
    for (int k = 0; k < n; k++) {
        int pivot = k;
        for (int i = k + 1; i < n; i++) {
            pivot = fabsl(a[i][k]) > fabsl(a[pivot][k]) ? i : pivot;
        }
        if (!(fabsl(a[pivot][k]) > 0.0L)) {
            return false;
        }
        for (int j = 0; j < n && pivot != k; j++) {
            const long double swap = a[k][j];
            a[k][j] = a[pivot][j];
            a[pivot][j] = swap;
        }
        const long double swap = x[k];
        x[k] = x[pivot];
        x[pivot] = swap;
        for (int i = k + 1; i < n; i++) {
            const long double share = a[i][k] / a[k][k];
            for (int j = k; j < n; j++) {
                a[i][j] -= share * a[k][j];
            }
            x[i] -= share * x[k];
        }
    }
    for (int k = n - 1; k >= 0; k--) {
        for (int j = k + 1; j < n; j++) {
            x[k] -= a[k][j] * x[j];
        }
        x[k] /= a[k][k];
    }
    return true;
}

static square inverse_of(const square *of)
{
    square inverse;
    for (int column = 0; column < STAGES; column++) {
        long double a[STAGE_UNKNOWNS][STAGE_UNKNOWNS] = {{0.0L}}, x[STAGE_UNKNOWNS] = {0.0L};
        x[column] = 1.0L;
        for (int i = 0; i < STAGES; i++) {
            for (int j = 0; j < STAGES; j++) {
                a[i][j] = of->at[i][j];
            }
        }
        (void)dense_solve(STAGES, a, x);
        for (int i = 0; i < STAGES; i++) {
            inverse.at[i][column] = x[i];
        }
    }
    return inverse;
}

/* ---- the method */

static long double legendre(int n, long double x, long double *before)
{
    long double p = 1.0L, last = 0.0L;
    for (int k = 1; k <= n; k++) {
        const long double next = ((2.0L * k - 1.0L) * x * p - (k - 1.0L) * last) / k;
        last = p;
        p = next;
    }
    *before = last;
    return p;
}

/* P_n - share P_(n-1): its roots are the places of Gauss (0) and of Radau (1). */
static long double polynomial(int n, long double share, long double x)
{
    long double before;
    const long double p = legendre(n, x, &before);
    return p - share * before;
}

static void find_places(int n, long double share, long double *place)
{
    enum { GRID = 4000 };
    int found = 0;
    for (int i = 0; i < GRID && found < n; i++) {
        long double low = -1.0L + 2.0L * i / GRID, high = -1.0L + 2.0L * (i + 1) / GRID;
        if (i == GRID - 1 && share > 0.0L) {
            break;
        }
        if (polynomial(n, share, low) * polynomial(n, share, high) < 0.0L || polynomial(n, share, low) == 0.0L) {
            for (int k = 0; k < 80; k++) {
                const long double middle = 0.5L * (low + high);
                *(polynomial(n, share, low) * polynomial(n, share, middle) <= 0.0L ? &high : &low) = middle;
            }
            place[found++] = 0.5L * (1.0L + 0.5L * (low + high));
        }
    }
    if (share > 0.0L) {
        place[n - 1] = 1.0L;
    }
}

static long double lagrange(const long double *place, int number, long double x)
{
    long double value = 1.0L;
    for (int i = 0; i < STAGES; i++) {
        value *= i == number ? 1.0L : (x - place[i]) / (place[number] - place[i]);
    }
    return value;
}

method radau_method(void)
{
    method m;
    long double gauss[STAGES];
    find_places(STAGES, 1.0L, m.place);
    find_places(STAGES, 0.0L, gauss);
    for (int i = 0; i < STAGES; i++) {
        for (int j = 0; j < STAGES; j++) {
            long double sum = 0.0L;
            for (int k = 0; k < STAGES; k++) {
                long double before;
                const long double x = 2.0L * gauss[k] - 1.0L, p = legendre(STAGES, x, &before);
                const long double slope = STAGES * (x * p - before) / (x * x - 1.0L);
                const long double weight = 1.0L / ((1.0L - x * x) * slope * slope);
                sum += weight * lagrange(m.place, j, m.place[i] * gauss[k]);
            }
            m.weight.at[i][j] = m.place[i] * sum;
        }
    }
    m.slope = inverse_of(&m.weight);
    return m;
}

lag lag_of(const method *radau, long double pace)
{
    lag l;
    square sum;
    for (int i = 0; i < STAGES; i++) {
        for (int j = 0; j < STAGES; j++) {
            sum.at[i][j] = (i == j ? 1.0L : 0.0L) + pace * radau->weight.at[i][j];
        }
    }
    l.rest = inverse_of(&sum);
    for (int i = 0; i < STAGES; i++) {
        for (int j = 0; j < STAGES; j++) {
            l.gain.at[i][j] = 0.0L;
            for (int k = 0; k < STAGES; k++) {
                l.gain.at[i][j] += l.rest.at[i][k] * pace * radau->weight.at[k][j];
            }
        }
    }
    return l;
}
