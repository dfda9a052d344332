#include "network/pace.h"

#include <math.h>

#include "network/membrane.h"

/* Coefficients of D(s). */
typedef struct film {
    const dea_dynamics *dynamics;
    double mass, resistance, stiffness;
    double viscous;      /* sum B_a S_a': stiffness of a branch per share [N/m] */
    double transduction; /* T = 2 phi U, 0 where the film sees the source [N/V] */
    double capacitance, conductance;
} film;

static film film_at(dea_dynamics *d, double u, double voltage)
{
    const dea_edge e = dea_dynamics_edge(d, u);
    const double viscous = dea_edge_viscous(d, &e);
    return (film){.dynamics = d,
                  .mass = d->mass,
                  .resistance = dea_edge_resistance(d, &e),
                  .stiffness = dea_dynamics_stiffness(d, u, voltage, true),
                  .viscous = viscous,
                  .transduction = d->series > 0.0 ? 2.0 * e.push * voltage : 0.0,
                  .capacitance = e.capacitance,
                  .conductance = d->conductance + (d->series > 0.0 ? 1.0 / d->series : 0.0)};
}

/* D(s) - m s^2 - r s, and its derivative. */
static double complex springs(const film *f, double complex s, double complex *slope)
{
    double complex sum = f->stiffness;
    *slope = 0.0;
    for (size_t i = 0; i < f->dynamics->branch_count; i++) {
        const dea_branch *branch = &f->dynamics->branches[i];
        const double complex q = 1.0 + s * branch->tau;
        sum += f->viscous * branch->share * s * branch->tau / q;
        *slope += f->viscous * branch->share * branch->tau / (q * q);
    }
    if (f->transduction != 0.0) {
        const double complex y = s * f->capacitance + f->conductance;
        const double square = f->transduction * f->transduction;
        sum += square * s / y;
        *slope += square * f->conductance / (y * y);
    }
    return sum;
}

/* The root of D in the upper half plane, 0 where there is none, by Newton from the frequency with the branches held on. */
static double complex ring_of(const film *f)
{
    const double held = f->stiffness + f->viscous * f->dynamics->total_share;
    if (!(f->mass > 0.0) || !(held > 0.0)) {
        return 0.0;
    }
    const double first = sqrt(held / f->mass);
    double complex s = first * I;
    for (int i = 0; i < 60; i++) {
        double complex slope;
        const double complex value = (f->mass * s + f->resistance) * s + springs(f, s, &slope);
        const double complex step = value / (2.0 * f->mass * s + f->resistance + slope);
        s -= step;
        if (!(cabs(step) > 1e-14 * cabs(s))) {
            break;
        }
    }
    const bool rings = cimag(s) > fabs(creal(s)) && cabs(s) < 1e3 * first;
    return rings ? s : 0.0;
}

dea_pace dea_pace_of(dea_dynamics *dynamics, double u, double voltage)
{
    const film f = film_at(dynamics, u, voltage);
    const double complex ring = ring_of(&f);
    dea_pace pace = {.omega = cimag(ring), .decay = -creal(ring), .fastest = INFINITY};
    for (size_t i = 0; i < dynamics->branch_count; i++) {
        pace.fastest = fmin(pace.fastest, dynamics->branches[i].tau);
    }
    const double held = f.stiffness + f.viscous * dynamics->total_share;
    if (f.mass > 0.0 && pace.omega == 0.0) {
        pace.fastest = fmin(pace.fastest, fmin(sqrt(f.mass / held), f.resistance > 0.0 ? f.mass / f.resistance : INFINITY));
    } else if (f.mass > 0.0) {
        pace.fastest = fmax(pace.fastest, 0.3 / pace.omega); /* the edge moves no faster than the ring */
    } else if (f.resistance > 0.0) {
        pace.fastest = fmin(pace.fastest, f.resistance / held);
    }
    if (dynamics->series > 0.0) {
        pace.fastest = fmin(pace.fastest, f.capacitance / f.conductance);
    }
    return pace;
}

dea_pace dea_pace_of_rings(const dea_membrane *membrane, const dea_membrane_rest *rest, double decay)
{
    const dea_dynamics *d = &membrane->film;
    const double slowest = rest->slowest, tau = d->retardation;
    dea_pace pace = {.omega = decay < slowest ? slowest : 0.0, .decay = decay, .fastest = INFINITY};
    if (pace.omega > 0.0) {
        pace.fastest = 0.3 / pace.omega; /* the edge moves no faster */
    } else if (slowest > 0.0) {
        pace.fastest = fmin(1.0 / slowest, 1.0 / (tau * slowest * slowest)); /* a damper outweighs the mass */
    } else if (tau > 0.0) {
        pace.fastest = tau / (1.0 + d->total_share);
    }
    for (size_t i = 0; i < d->branch_count; i++) {
        pace.fastest = fmin(pace.fastest, d->branches[i].tau);
    }
    const double charging = d->series > 0.0 ? rest->capacitance / (1.0 / d->series + d->conductance) : (double)INFINITY;
    pace.fastest = fmin(pace.fastest, charging);
    return pace;
}

/* Fit of a film to steps [s]; its mass alone where they are too long, or the fit makes another film of it. */
static dea_matching match(const film *f, double step)
{
    const double complex ring = ring_of(f);
    const dea_matching none = {.mass = f->mass};
    if (cimag(ring) == 0.0 || !(cimag(ring) * step < 2.0)) {
        return none;
    }
    double complex slope;
    const double complex s = 2.0 / step * ctanh(0.5 * step * ring);
    const double complex rest = -springs(f, s, &slope); /* = M s^2 + R s, with real M and R */
    const double complex over = rest / s;               /* = M s + R */
    const dea_matching fit = {.mass = cimag(over) / cimag(s),
                              .resistance = creal(over) - cimag(over) / cimag(s) * creal(s) - f->resistance,
                              .ring = ring,
                              .root = s};
    return fit.mass > 0.1 * f->mass && fit.mass < 10.0 * f->mass ? fit : none;
}

dea_matching dea_matching_of(dea_dynamics *dynamics, double u, double voltage, double step)
{
    const film f = film_at(dynamics, u, voltage);
    return match(&f, step);
}

/* x A x of a symmetric matrix. */
static double square_of(size_t n, const double *a, const double *x)
{
    double sum = 0.0;
    for (size_t j = 0; j < n; j++) {
        for (size_t i = 0; i < n; i++) {
            sum += x[i] * a[j * n + i] * x[j];
        }
    }
    return sum;
}

/* The slowest mode at a state, as a film of mass 1 whose displacement is that mode's share. */
static bool slowest_at(const dea_membrane *m, const dea_membrane_look *look, double voltage, film *f)
{
    const size_t n = m->nodes;
    const dea_dynamics *d = &m->film;
    double stiffness[DEA_RINGS_NODES * DEA_RINGS_NODES], viscous[DEA_RINGS_NODES * DEA_RINGS_NODES], shapes[DEA_RINGS_NODES * DEA_RINGS_NODES];
    double frequencies[DEA_RINGS_NODES], push[DEA_RINGS_NODES], pushed = 0.0;
    dea_membrane_stiffness(m, look, voltage, NULL, d->total_share, stiffness);
    if (!dea_membrane_modes(m, stiffness, frequencies, shapes)) {
        return false;
    }
    dea_membrane_stiffness(m, look, voltage, NULL, 0.0, stiffness);
    dea_membrane_damping(m, look, 1.0, viscous);
    dea_membrane_push(m, look, push);
    for (size_t i = 0; i < n; i++) {
        pushed += push[i] * shapes[i];
    }
    const double edge = shapes[m->rings.edge], own = square_of(n, viscous, shapes);
    *f = (film){.dynamics = d,
                .mass = 1.0,
                .resistance = d->retardation * own + d->damping * edge * edge,
                .stiffness = square_of(n, stiffness, shapes),
                .viscous = own,
                .transduction = d->series > 0.0 ? 2.0 * pushed * voltage : 0.0,
                .capacitance = look->capacitance,
                .conductance = d->conductance + (d->series > 0.0 ? 1.0 / d->series : 0.0)};
    return true;
}

dea_matching dea_matching_of_rings(const dea_membrane *m, double voltage, double step)
{
    double u[DEA_RINGS_NODES];
    dea_membrane_look look;
    film f;
    const bool loaded = dea_membrane_still(m, voltage, u), there = loaded || dea_membrane_still(m, 0.0, u);
    if (!there || !dea_membrane_look_at(m, u, &look) || !slowest_at(m, &look, loaded ? voltage : 0.0, &f)) {
        return (dea_matching){.mass = 1.0};
    }
    return match(&f, step);
}
