#include "legendre.h"

#include <math.h>

static const long double pi = 3.14159265358979323846264338327950288L;

shape shape_at(int degree, long double xi)
{
    shape s = {{0.0L}, {0.0L}, {0.0L}};
    long double p[SHAPES_MOST] = {1.0L, xi}, d[SHAPES_MOST] = {0.0L, 1.0L};
    for (int n = 2; n <= degree; n++) {
        p[n] = ((2.0L * n - 1.0L) * xi * p[n - 1] - (n - 1.0L) * p[n - 2]) / n;
        d[n] = d[n - 2] + (2.0L * n - 1.0L) * p[n - 1];
    }
    s.value[0] = 0.5L * (1.0L - xi);
    s.value[1] = 0.5L * (1.0L + xi);
    s.slope[0] = -0.5L;
    s.slope[1] = 0.5L;
    for (int n = 2; n <= degree; n++) {
        const long double norm = sqrtl(2.0L * (2.0L * n - 1.0L));
        s.value[n] = (p[n] - p[n - 2]) / norm;
        s.slope[n] = (2.0L * n - 1.0L) * p[n - 1] / norm;
        s.curve[n] = (2.0L * n - 1.0L) * d[n - 1] / norm;
    }
    return s;
}

/* By Newton's method from their asymptotic places. */
void gauss_rule(int count, long double *places, long double *weights)
{
    for (int i = 0; i < count; i++) {
        long double x = -cosl(pi * (i + 0.75L) / (count + 0.5L)), slope = 1.0L;
        for (int k = 0; k < 20; k++) {
            long double before = 1.0L, p = x;
            for (int n = 2; n <= count; n++) {
                const long double next = ((2.0L * n - 1.0L) * x * p - (n - 1.0L) * before) / n;
                before = p;
                p = next;
            }
            slope = count * (x * p - before) / (x * x - 1.0L);
            x -= p / slope;
        }
        places[i] = x;
        weights[i] = 2.0L / ((1.0L - x * x) * slope * slope);
    }
}
