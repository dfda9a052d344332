#include "network/swing.h"

#include <math.h>
#include <stdlib.h>

enum { POLES = DEA_PRONY_MAX + 1 };

typedef struct relaxation {
    double spring; /* k_i [N/m], > 0 */
    double tau;    /* 1/q_i [s] */
} relaxation;

typedef struct film {
    double mass, resistance, stiffness;
    relaxation poles[POLES]; /* slowest first, all different */
    size_t count;
} film;

/* Slowest first. */
static int by_time(const void *a, const void *b)
{
    const double x = ((const relaxation *)a)->tau, y = ((const relaxation *)b)->tau;
    return (x < y) - (x > y);
}

static void join_equal(film *f)
{
    const size_t count = f->count;
    qsort(f->poles, count, sizeof *f->poles, by_time);
    f->count = 0;
    for (size_t i = 0; i < count; i++) {
        if (f->count > 0 && f->poles[f->count - 1].tau == f->poles[i].tau) {
            f->poles[f->count - 1].spring += f->poles[i].spring;
        } else {
            f->poles[f->count++] = f->poles[i];
        }
    }
}

static film film_at(dea_dynamics *d, double u, double voltage)
{
    const dea_edge e = dea_dynamics_edge(d, u);
    const double viscous = dea_edge_viscous(d, &e);
    const double transduction = d->series > 0.0 ? 2.0 * e.push * voltage : 0.0;
    film f = {.mass = d->mass, .resistance = dea_edge_resistance(d, &e)};
    f.stiffness = dea_dynamics_stiffness(d, u, voltage, true);
    for (size_t i = 0; i < d->branch_count; i++) {
        f.poles[f.count++] = (relaxation){viscous * d->branches[i].share, d->branches[i].tau};
    }
    if (transduction != 0.0) {
        const double spring = transduction * transduction / e.capacitance;
        f.poles[f.count++] = (relaxation){spring, e.capacitance / (1.0 / d->series + d->conductance)};
    }
    join_equal(&f);
    return f;
}

/* q_i - q_k without cancellation [1/s]. */
static double gap(const film *f, size_t i, size_t k)
{
    return (f->poles[k].tau - f->poles[i].tau) / (f->poles[i].tau * f->poles[k].tau);
}

/* D at s = x - q_pole. */
static double dynamic_stiffness(const film *f, size_t pole, double x)
{
    const double s = x - 1.0 / f->poles[pole].tau;
    double sum = (f->mass * s + f->resistance) * s + f->stiffness;
    for (size_t i = 0; i < f->count; i++) {
        sum += f->poles[i].spring * s / (i == pole ? x : x + gap(f, i, pole));
    }
    return sum;
}

/* Distance of a root from the pole below it: between that pole, where D falls to -inf, and the next one or 0, where it is
 * positive. Halved in logarithms, as the root of a weak branch lies very close to its pole. */
static double distance_above(const film *f, size_t pole)
{
    enum { HALVINGS = 64 };
    double high = pole == 0 ? 1.0 / f->poles[0].tau : gap(f, pole, pole - 1);
    double low = 1e-30 * high;
    for (int i = 0; i < HALVINGS; i++) {
        const double middle = sqrt(low) * sqrt(high);
        *(dynamic_stiffness(f, pole, middle) < 0.0 ? &low : &high) = middle;
    }
    return sqrt(low) * sqrt(high);
}

/* Every branch has a real root above its pole. Of all roots the sum is -r/m - sum q_i and the product (-1)^n K prod q_i/m, so
 * that two are left with the sum 2 sigma and the product p below: complex where p > sigma^2. */
static dea_swing swing_of(film f)
{
    const dea_swing none = {(double)NAN, (double)NAN};
    if (!(f.mass > 0.0) || !(f.stiffness > 0.0)) {
        return none;
    }
    double sum = f.resistance / f.mass;
    double product = f.stiffness / f.mass;
    for (size_t i = 0; i < f.count; i++) {
        const double distance = distance_above(&f, i), rate = 1.0 / f.poles[i].tau;
        sum += distance;
        product *= rate / (rate - distance);
    }
    const double square = product - 0.25 * sum * sum;
    return square > 0.0 ? (dea_swing){sqrt(square) / (2.0 * DEA_PI), 0.5 * sum} : none;
}

dea_swing dea_swing_of(dea_dynamics *dynamics, double u, double voltage)
{
    return swing_of(film_at(dynamics, u, voltage));
}

/* At rest the damper of the membrane is its stiffness times 1 + P/(lambda_pre W11), whatever its electrodes weigh: of
 * int (e_1^2 + e_2^2) and int e_1 e_2, which both are made of, the second is 0 between a centre and a frame that do not move. So its
 * modes stay those of the undamped film, and each has the one pair of roots. */
static dea_swing swing_of_membrane(const dea_scene *scene, const dea_dynamics *d)
{
    const dea_film *material = &d->point.film;
    const double omega = d->mass > 0.0 ? 2.0 * DEA_PI * dea_point_resonance(scene, &d->point) : (double)NAN;
    film f = {.mass = 1.0, .stiffness = omega * omega};
    const double viscous = f.stiffness * (1.0 + material->tension / (material->prestretch * material->w11));
    f.resistance = d->retardation * viscous;
    for (size_t i = 0; i < d->branch_count; i++) {
        f.poles[f.count++] = (relaxation){viscous * d->branches[i].share, d->branches[i].tau};
    }
    return swing_of(f);
}

dea_swing dea_swing_free(const dea_scene *scene, const dea_model *model)
{
    dea_scene full = *scene; /* borrows what the scene owns */
    dea_dynamics dynamics;
    dea_swing swing = {(double)NAN, (double)NAN};
    full.reduction = (dea_reduction){0};
    if (model->membrane) {
        return dea_dynamics_settle(&full, model, &dynamics, NULL) == DEA_OK ? swing_of_membrane(&full, &dynamics) : swing;
    }
    if (dea_dynamics_open(&full, model, &dynamics, NULL) == DEA_OK) {
        swing = dea_swing_of(&dynamics, dynamics.rest, 0.0);
    }
    dea_dynamics_close(&dynamics);
    return swing;
}
