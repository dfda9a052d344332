#include "material/fit/test.h"

#include <math.h>

/* r(x), the share of a branch that a ramp leaves. */
static double ramp_share(double x)
{
    return x > 0.0 ? -expm1(-x) / x : 1.0;
}

/* dr/dln tau = r - e^-x, since x = T/tau. */
dea_test_time dea_test_time_of(double ramp, double tau)
{
    const double x = ramp / tau;
    return (dea_test_time){tau, ramp_share(x), x > 0.0 ? ramp_share(x) - exp(-x) : 0.0};
}

double dea_test_measured(const dea_relaxation_point *point, size_t curve)
{
    return curve == 0 ? point->stress : point->loss;
}

/* Past these nothing of a branch is left, or all of it: times over many decades would make inf - inf of its slope. */
static const double all_gone = 800.0, all_there = 1e100;

static dea_test_term relaxing(double at, const dea_test_time *time, size_t curve)
{
    const double t = fmin(at / time->tau, all_gone), left = exp(-t);
    (void)curve;
    return (dea_test_term){left * time->share, left * (t * time->share + time->slope)};
}

static dea_test_term creeping(double at, const dea_test_time *time, size_t curve)
{
    const dea_test_term left = relaxing(at, time, curve);
    return (dea_test_term){1.0 - left.value, -left.slope};
}

static dea_test_term swinging(double at, const dea_test_time *time, size_t curve)
{
    const double w = fmin(at * time->tau, all_there), over = 1.0 / (1.0 + w * w);
    return curve == 0 ? (dea_test_term){w * w * over, 2.0 * w * w * over * over}
                      : (dea_test_term){w * over, w * (1.0 - w * w) * over * over};
}

static void modulus_branches(size_t count, const double *shares, const double *logs, dea_spectrum *spectrum)
{
    double sum = shares[0];
    for (size_t k = 0; k < count; k++) {
        sum += shares[k + 1];
    }
    spectrum->long_term = shares[0] / sum;
    for (size_t k = 0; k < count; k++) {
        spectrum->prony[k] = (dea_prony){.g = shares[k + 1] / sum, .tau = exp(logs[k])};
    }
}

/* J_0 + sum J_k/(1 - x lambda_k) at x = (1 + past)/lambda of branch @p of, whose term keeps its digits close to its pole. */
static double compliance_at(size_t count, const double *shares, const double *logs, size_t of, double past)
{
    double sum = shares[0];
    for (size_t k = 0; k < count; k++) {
        const double ratio = exp(logs[k] - logs[of]); /* lambda_k/lambda_of */
        sum += shares[k + 1] / (k == of ? -past : 1.0 - ratio * (1.0 + past));
    }
    return sum;
}

/* Zero of the compliance between the pole 1/lambda of a branch and that of the next faster one, as x lambda - 1. It grows all the
 * way, from -inf: behind the last pole, where x lambda - 1 = sum J/J_0 is past the zero, to J_0. */
static double zero_past(size_t count, const double *shares, const double *logs, size_t of)
{
    double low = -50.0, sum = 0.0; /* ln(x lambda - 1): a share of 1e-21 is none */
    for (size_t k = 0; k < count; k++) {
        sum += shares[k + 1];
    }
    double high = log(of == 0 ? sum / shares[0] : expm1(logs[of] - logs[of - 1]));
    for (int i = 0; i < 200 && high - low > 1e-15 * fabs(high); i++) {
        const double middle = 0.5 * (low + high);
        *(compliance_at(count, shares, logs, of, exp(middle)) < 0.0 ? &low : &high) = middle;
    }
    return exp(0.5 * (low + high));
}

/* The modulus of the transformed equations is 1/(s J(s)), s J(s) = J_0 + sum J_k/(1 + s lambda_k): its poles s = -1/tau_i are the
 * zeros of that, one past each -1/lambda_k, and E_i = tau_i/sum J_k lambda_k/(1 - lambda_k/tau_i)^2. */
static void compliance_branches(size_t count, const double *shares, const double *logs, dea_spectrum *spectrum)
{
    double sum = shares[0];
    for (size_t i = 0; i < count; i++) {
        const double past = zero_past(count, shares, logs, i);
        double slope = 0.0;
        for (size_t k = 0; k < count; k++) {
            const double ratio = exp(logs[k] - logs[i]);
            const double room = k == i ? -past : 1.0 - ratio * (1.0 + past);
            slope += shares[k + 1] * ratio / (room * room);
        }
        sum += shares[i + 1];
        spectrum->prony[i] = (dea_prony){.g = shares[0] / ((1.0 + past) * slope), .tau = exp(logs[i]) / (1.0 + past)};
    }
    spectrum->long_term = shares[0] / sum;
}

static const dea_test tests[DEA_TESTS] = {
    [DEA_TEST_RELAXATION] = {.curves = 1,
                             .rest = {1.0},
                             .branch = relaxing,
                             .convert = modulus_branches,
                             .name = "relaxation test",
                             .quantity = "stress",
                             .unit = " Pa",
                             .step = "stress after an ideal step",
                             .last = "no long-term stress",
                             .remedy = "measure longer than %.6g s",
                             .negative = "a stress is not negative, in compression too",
                             .mirrored = "the stress grows from %.6g Pa to %.6g Pa at the held stretch; a relaxation test falls"},
    [DEA_TEST_DYNAMIC] = {.curves = 2,
                          .rest = {1.0, 0.0},
                          .periodic = true,
                          .branch = swinging,
                          .convert = modulus_branches,
                          .name = "dynamic test",
                          .quantity = "storage modulus",
                          .unit = " Pa",
                          .step = "instantaneous modulus",
                          .last = "no long-term modulus",
                          .remedy = "measure below %.6g Hz",
                          .negative = "a modulus is not negative",
                          .mirrored = "the storage modulus falls from %.6g Pa to %.6g Pa over the frequency; that of a film grows"},
    [DEA_TEST_CREEP] = {.curves = 1,
                        .rest = {1.0},
                        .branch = creeping,
                        .convert = compliance_branches,
                        .name = "creep test",
                        .quantity = "strain",
                        .unit = "",
                        .step = "strain or compliance after an ideal step",
                        .last = "no strain at the start",
                        .remedy = "measure sooner after the load, or give a shorter ramp",
                        .negative = "a strain is not negative, in compression too",
                        .mirrored = "the strain falls from %.6g to %.6g under the held stress; a creep test grows"},
};

const dea_test *dea_test_of(dea_test_kind kind)
{
    return &tests[kind];
}
