/* Frequency responses: the edge equation linearised about the equilibrium under the bias, in complex long double. */
#include <complex.h>
#include <math.h>

#include "radial.h"

static const long double pi = 3.14159265358979323846264338327950288L;

typedef long double complex number;

static double degrees(number z)
{
    return (double)(cargl(z) * 180.0L / pi);
}

/* (-m w^2 + d(sum A S + G - phi U^2)/du + sum A S' [s tau + sum c s tau_i/(1 + s tau_i)]) u = 2 phi U dU; q = C U. */
static dea_response response_at(const true_film *f, const true_edge *e, long double u_bias, long double frequency)
{
    const number s = I * (2.0L * pi * frequency);
    const long double spring = edge_viscous(e);
    number stiffness = f->mass * s * s + (spring * f->retardation + f->load_damping) * s + edge_relaxed(e).slope - e->push.slope * u_bias * u_bias;
    for (size_t i = 0; i < f->branches; i++) {
        stiffness += spring * f->share[i] * (s * f->tau[i] / (1.0L + s * f->tau[i]));
    }
    const number u = 2.0L * e->push.value * u_bias / stiffness;
    const number current = s * (e->capacitance + 2.0L * e->push.value * u_bias * u) + f->conductance;
    const number source = 1.0L + f->series * current;
    return (dea_response){.frequency = (double)frequency,
                          .displacement = (double)cabsl(u / source),
                          .displacement_phase = degrees(u / source),
                          .impedance = (double)cabsl(source / current),
                          .impedance_phase = degrees(source / current)};
}

double response_truth(const dea_scene *scene, const dea_model *model, dea_response *rows)
{
    if (model->membrane) {
        return radial_response(scene, model, rows);
    }
    const true_film f = film_of(scene, model);
    const size_t count = dea_layout_of(scene).rows;
    const long double bias = f.kept * (long double)scene->ac.bias;
    const long double still = still_displacement(&f, bias);
    const bool inside = still > -f.divide && still < f.frame - f.divide; /* what else a film cannot do */
    const long double u = inside ? still : (long double)NAN;
    const true_edge e = film_edge(&f, isnan(u) ? 0.0L : u);
    const double none = (double)NAN;
    const dea_state state = isnan(u) ? DEA_STATE_PULL_IN : film_row(&f, u, bias).state;
    for (size_t i = 0; i < count; i++) {
        const double at = dea_layout_place(scene, i);
        rows[i] = isnan(u) ? (dea_response){at, none, none, none, none, state} : response_at(&f, &e, bias, at);
        rows[i].state = state;
    }
    return 1e-15;
}
