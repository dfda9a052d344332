/* Frequency responses of the membrane: its dynamic stiffness about the equilibrium under the bias. */
#include <math.h>
#include <stdlib.h>

#include "radial.h"

static const long double pi = 3.14159265358979323846264338327950288L;

static double degrees(long double complex z)
{
    return (double)(cargl(z) * 180.0L / pi);
}

typedef struct biased {
    radial mesh;
    radial_look look;
    radial_system system;
    long double u[RADIAL_MOST], bias;
} biased;

/* K(s) u = 2 phi U dU, q = C U. */
static dea_response response_at(biased *b, long double frequency)
{
    const true_film *f = b->mesh.film;
    const long double complex s = I * (2.0L * pi * frequency);
    long double complex viscous = s * f->retardation, x[RADIAL_MOST], motional = 0.0L;
    for (size_t i = 0; i < f->branches; i++) {
        viscous += f->share[i] * (s * f->tau[i] / (1.0L + s * f->tau[i]));
    }
    radial_factor(&b->mesh, &b->look, (radial_factors){1.0L, viscous, b->mesh.heavy ? s * s : 0.0L, s * f->load_damping}, &b->system);
    for (int n = 0; n < b->mesh.size; n++) {
        x[n] = 2.0L * b->bias * b->look.push[n];
    }
    radial_solve(&b->mesh, &b->system, x);
    for (int n = 0; n < b->mesh.size; n++) {
        motional += 2.0L * b->bias * b->look.push[n] * x[n];
    }
    const long double complex current = s * (b->look.capacitance + motional) + f->conductance, source = 1.0L + f->series * current;
    const long double complex edge = x[b->mesh.edge] / source;
    return (dea_response){.frequency = (double)frequency,
                          .displacement = (double)cabsl(edge),
                          .displacement_phase = degrees(edge),
                          .impedance = (double)cabsl(source / current),
                          .impedance_phase = degrees(source / current)};
}

/* False where the film has no equilibrium under its bias. */
static bool rest_at(biased *b, long double bias, dea_state *state)
{
    radial_margins margins;
    b->bias = bias;
    if (!radial_still(&b->mesh, bias, b->u) ||
        !radial_look_at(&b->mesh, b->u, bias, NULL, 0.0L, &b->look)) {
        *state = DEA_STATE_PULL_IN;
        return false;
    }
    *state = radial_row(&b->mesh, b->u, bias, &margins).state;
    return true;
}

static double relative(double a, double b)
{
    return a == b || (isnan(a) && isnan(b)) ? 0.0 : fabs(a - b) / fabs(b);
}

double radial_response(const dea_scene *scene, const dea_model *model, dea_response *rows)
{
    biased *b = calloc(1, sizeof *b);
    const true_film film = film_of(scene, model);
    const size_t count = dea_layout_of(scene).rows;
    const double none = (double)NAN;
    double error = (double)INFINITY;
    for (int level = 0; level < 5 && !(error < 1e-13) && radial_open(&b->mesh, &film, 5.0 * (1 << level), level); level++) {
        dea_state state;
        const bool rests = rest_at(b, film.kept * (long double)scene->ac.bias, &state);
        double most = 0.0;
        for (size_t i = 0; i < count; i++) {
            const double at = dea_layout_place(scene, i);
            dea_response row = rests ? response_at(b, at) : (dea_response){at, none, none, none, none, state};
            row.state = state;
            most = fmax(most, fmax(relative(rows[i].displacement, row.displacement), relative(rows[i].impedance, row.impedance)));
            rows[i] = row;
        }
        error = level > 0 ? 1e-16 + most : error;
    }
    free(b);
    return error;
}
