/* What a test of a viscoelastic film measures of its branches, by kind: a model that is linear in shares a_0, a_i >= 0 of given times.
 *
 *     relaxation   S = a_0 + sum a_i e^(-t/tau_i) r(T/tau_i)            stress at a held stretch after a ramp of duration T
 *     dynamic      E' = a_0 + sum a_i w^2/(1 + w^2), E'' = sum a_i w/(1 + w^2)    moduli of a harmonic test, w = omega tau_i
 *     creep        e = a_0 + sum a_i (1 - e^(-t/tau_i) r(T/tau_i))      strain under a held stress, tau_i those of retardation
 *
 * r(x) = (1 - e^-x)/x, r(0) = 1: an ideal step. The share of a_0 in the sum is the long-term share of the modulus in all of them:
 * of creep the first strain over the last. */
#ifndef DEA_MATERIAL_FIT_TEST_H
#define DEA_MATERIAL_FIT_TEST_H

#include "deaspice/fit.h"

enum { DEA_TEST_CURVES = 2 };

/* A time with what the ramp makes of it. */
typedef struct dea_test_time {
    double tau;
    double share, slope; /* r(T/tau), dr/dln tau */
} dea_test_time;

/* Term of a branch of share 1, and its slope over ln tau. */
typedef struct dea_test_term {
    double value, slope;
} dea_test_term;

/* Branches of the modulus. */
typedef struct dea_spectrum {
    double long_term; /* 1 - sum g [1] */
    dea_prony prony[DEA_RELAXATION_MOST];
} dea_spectrum;

/* A kind of test. */
typedef struct dea_test {
    size_t curves;                 /* what a point has measured: its stress alone, or the loss too */
    double rest[DEA_TEST_CURVES];  /* term of a_0 in each */
    bool periodic;                 /* points are of angular frequencies, which see the times 1/omega */
    dea_test_term (*branch)(double at, const dea_test_time *time, size_t curve);
    /* Branches of the modulus of @p count shares a_i and ln tau_i, tau ascending, and a_0 before them. */
    void (*convert)(size_t count, const double *shares, const double *logs, dea_spectrum *spectrum);
    const char *name;     /* "relaxation test" */
    const char *quantity; /* what stress stands for, "stress" */
    const char *unit;     /* of it, " Pa" */
    const char *step;     /* what `instantaneous` of a fit is, in words */
    const char *last;     /* what no branch leaves where a_0 is 0, "no long-term stress" */
    const char *remedy;   /* and what to do; may take the last time, or the least frequency [s, Hz] */
    const char *negative; /* what no point is */
    const char *mirrored; /* what is wrong with a test that goes the other way; takes two numbers [unit] */
} dea_test;

const dea_test *dea_test_of(dea_test_kind kind);

dea_test_time dea_test_time_of(double ramp, double tau);
/* Stress or loss of a point. */
double dea_test_measured(const dea_relaxation_point *point, size_t curve);

#endif
