/* Frequency response: the moving network linearised about the equilibrium under the bias. */
#include <complex.h>
#include <math.h>

#include "deaspice/measures.h"
#include "engine/direct/direct.h"
#include "network/dynamics.h"

/* Dynamic stiffness at an equilibrium under the film voltage U,
 *   -m w^2 + d(A S - phi U^2)/du + A S' [i w tau_KV + sum c_i i w tau_i/(1 + i w tau_i)]. */
static double complex dynamic_stiffness(const dea_dynamics *d, const dea_edge *e, double relaxed, double omega)
{
    const double spring = dea_edge_viscous(d, e);
    double complex sum = relaxed - d->mass * omega * omega + I * (omega * d->retardation * spring);
    for (size_t i = 0; i < d->branch_count; i++) {
        const double complex s = I * (omega * d->branches[i].tau);
        sum += spring * d->branches[i].share * s / (1.0 + s);
    }
    return sum;
}

/* In (-180, 180]. */
static double degrees(double complex z)
{
    const double angle = carg(z) * (180.0 / DEA_PI);
    return angle > -180.0 ? angle : 180.0;
}

/* Per volt on the film: u = 2 phi U/D, q = C + C' U u; then the source sees U_s = U_f + R_s (i w q + U_f/R_p). */
static dea_response response_at(const dea_dynamics *d, const dea_edge *e, double bias, double relaxed, double frequency)
{
    const double omega = 2.0 * DEA_PI * frequency;
    const double complex u = 2.0 * e->push * bias / dynamic_stiffness(d, e, relaxed, omega);
    const double complex charge = e->capacitance + e->capacitance_slope * bias * u;
    const double complex current = I * (omega * charge) + d->conductance;
    const double complex source = 1.0 + d->series * current;
    const double complex gain = u / source;
    const double complex impedance = source / current;
    return (dea_response){.frequency = frequency,
                          .displacement = cabs(gain),
                          .displacement_phase = degrees(gain),
                          .impedance = cabs(impedance),
                          .impedance_phase = degrees(impedance)};
}

/* The film under its bias. */
typedef struct biased {
    const dea_dynamics *dynamics;
    dea_edge edge;
    double bias, relaxed; /* of the film [V], its stiffness [N/m] */
} biased;

static dea_response biased_response(const biased *b, double frequency)
{
    return response_at(b->dynamics, &b->edge, b->bias, b->relaxed, frequency);
}

static bool magnitudes(void *user, double from, double to, size_t count, double *out)
{
    for (size_t i = 0; i < count; i++) {
        out[i] = biased_response(user, from + (to - from) * (double)i / (double)(count - 1)).displacement;
    }
    return true;
}

static void respond(dea_dynamics *d, const dea_scene *scene, dea_response *rows, size_t count, dea_band *band)
{
    const double none = (double)NAN;
    biased b = {.dynamics = d, .bias = scene->ac.bias / (1.0 + d->series * d->conductance)};
    dea_sample rest = {.state = DEA_STATE_PULL_IN};
    dea_moment moment = {.source = scene->ac.bias, .voltage = b.bias};
    const bool held = dea_dynamics_equilibrium(d, b.bias, &moment.u) && dea_dynamics_sample(d, &moment, &rest);
    b.edge = dea_dynamics_edge(d, held ? moment.u : 0.0);
    b.relaxed = held ? dea_dynamics_stiffness(d, moment.u, b.bias, true) : none;
    for (size_t i = 0; i < count; i++) {
        const double frequency = dea_layout_place(scene, i);
        rows[i] = held ? biased_response(&b, frequency) : (dea_response){frequency, none, none, none, none, rest.state};
        rows[i].state = rest.state;
    }
    if (band) {
        *band = dea_measure_band(rows, count, held ? magnitudes : NULL, &b);
    }
}

dea_status dea_direct_ac(void *session, const dea_scene *scene, const dea_model *model, dea_response *rows, dea_band *band,
                         dea_error *error)
{
    (void)session;
    dea_dynamics dynamics;
    const dea_status status = dea_dynamics_open(scene, model, &dynamics, error);
    if (status == DEA_OK) {
        respond(&dynamics, scene, rows, dea_layout_of(scene).rows, band);
    }
    dea_dynamics_close(&dynamics);
    return status;
}
