/* Frequency response: the moving network, or the membrane itself, linearised about the equilibrium under the bias. */
#include <complex.h>
#include <math.h>

#include "deaspice/measures.h"
#include "engine/direct/direct.h"
#include "engine/direct/sheets.h"

/* Dynamic stiffness at an equilibrium under the film voltage U,
 *   -m w^2 + i w r + d(A S - phi U^2)/du + A S' [i w tau_KV + sum c_i i w tau_i/(1 + i w tau_i)]. */
static double complex dynamic_stiffness(const dea_dynamics *d, const dea_edge *e, double relaxed, double omega)
{
    const double spring = dea_edge_viscous(d, e);
    double complex sum = relaxed - d->mass * omega * omega + I * (omega * dea_edge_resistance(d, e));
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

/* What the source sees of a film with these answers per volt: U_s = U_f + R_s (i w q + U_f/R_p). */
static dea_response response_of(const dea_dynamics *d, const dea_per_volt *film, double frequency)
{
    const double complex current = I * (2.0 * DEA_PI * frequency * film->charge) + d->conductance;
    const double complex source = 1.0 + d->series * current;
    const double complex gain = film->displacement / source;
    const double complex impedance = source / current;
    return (dea_response){.frequency = frequency,
                          .displacement = cabs(gain),
                          .displacement_phase = degrees(gain),
                          .impedance = cabs(impedance),
                          .impedance_phase = degrees(impedance)};
}

/* The film under its bias: of one node, or a membrane. */
typedef struct biased {
    dea_dynamics *dynamics;
    double bias;  /* of the film [V] */
    dea_state state;
    bool held;    /* there is an equilibrium */
    double accuracy;
    dea_edge edge;
    double relaxed;         /* stiffness of the node [N/m] */
    dea_radial *radial; /* borrowed, as sheets; NULL: one node */
    dea_sheets *sheets; /* NULL: one film whose electrodes have no sheet resistance */
} biased;

/* Per volt on the film: u = 2 phi U/D, q = C + C' U u. */
static bool answer_of(const biased *b, double frequency, dea_per_volt *answer)
{
    if (b->sheets) {
        return dea_sheets_answer(b->sheets, frequency, b->accuracy, answer);
    }
    if (b->radial) {
        return dea_radial_answer(b->radial, frequency, b->accuracy, answer);
    }
    const dea_edge *e = &b->edge;
    const double complex u = 2.0 * e->push * b->bias / dynamic_stiffness(b->dynamics, e, b->relaxed, 2.0 * DEA_PI * frequency);
    *answer = (dea_per_volt){u, e->capacitance + e->capacitance_slope * b->bias * u};
    return true;
}

static dea_response biased_response(const biased *b, double frequency)
{
    const double none = (double)NAN;
    dea_per_volt answer;
    dea_response response = {frequency, none, none, none, none, b->state};
    if (b->held && answer_of(b, frequency, &answer)) {
        response = response_of(b->dynamics, &answer, frequency);
        response.state = b->state;
    } else if (b->held) {
        response.state = DEA_STATE_FAILED;
    }
    return response;
}

static bool magnitudes(void *user, double from, double to, size_t count, double *out)
{
    for (size_t i = 0; i < count; i++) {
        out[i] = biased_response(user, from + (to - from) * (double)i / (double)(count - 1)).displacement;
    }
    return true;
}

/* Fills rows and band; the number of rows without an answer. */
static size_t respond(biased *b, const dea_scene *scene, dea_response *rows, dea_band *band)
{
    const size_t count = dea_layout_of(scene).rows;
    size_t failed = 0;
    for (size_t i = 0; i < count; i++) {
        rows[i] = biased_response(b, dea_layout_place(scene, i));
        failed += rows[i].state == DEA_STATE_FAILED ? 1 : 0;
    }
    if (band) {
        *band = dea_measure_band(rows, count, b->held ? magnitudes : NULL, b);
    }
    return failed;
}

/* The voltage that leakage leaves the film of the source's. */
static double film_bias(const dea_dynamics *d, const dea_scene *scene)
{
    return scene->ac.bias / (1.0 + d->series * d->conductance);
}

static dea_status respond_node(const dea_scene *scene, const dea_model *model, dea_response *rows, dea_band *band, dea_error *error)
{
    dea_dynamics d;
    const dea_status status = dea_dynamics_open(scene, model, &d, error);
    if (status == DEA_OK) {
        dea_sample rest = {.state = DEA_STATE_PULL_IN};
        dea_moment moment = {.source = scene->ac.bias, .voltage = film_bias(&d, scene)};
        biased b = {.dynamics = &d, .bias = moment.voltage};
        b.held = dea_dynamics_equilibrium(&d, b.bias, &moment.u) && dea_dynamics_sample(&d, &moment, &rest);
        b.state = rest.state;
        b.edge = dea_dynamics_edge(&d, b.held ? moment.u : 0.0);
        b.relaxed = b.held ? dea_dynamics_stiffness(&d, moment.u, b.bias, true) : (double)NAN;
        respond(&b, scene, rows, band);
    }
    dea_dynamics_close(&d);
    return status;
}

static dea_status respond_radius(const dea_scene *scene, const dea_model *model, dea_response *rows, dea_band *band,
                                   dea_error *error)
{
    dea_dynamics d;
    const dea_status status = dea_dynamics_settle(scene, model, &d, error);
    if (status != DEA_OK) {
        return status;
    }
    const bool resistive = scene->electrode.sheet_resistance > 0.0;
    if (resistive) { /* what stands before the rim */
        d.series = scene->drive.series_resistance > 0.0 ? scene->drive.series_resistance : 0.0;
    }
    d.point.voltage = film_bias(&d, scene);
    dea_sheets sheets = dea_sheets_open(scene, model, d.point.voltage);
    dea_radial radial;
    dea_radial_open(&d, scene, &radial);
    biased b = {.dynamics = &d,
                .bias = d.point.voltage,
                .state = radial.rest.state,
                .held = isfinite(radial.rest.strain),
                .accuracy = scene->accuracy,
                .radial = &radial,
                .sheets = resistive || scene->antagonist.there ? &sheets : NULL};
    const size_t failed = respond(&b, scene, rows, band);
    if (failed > 0) {
        dea_fail(error, DEA_OK, "%zu frequencies failed: two meshes of the film do not agree within the accuracy", failed);
    }
    dea_radial_close(&radial);
    dea_sheets_close(&sheets);
    return DEA_OK;
}

dea_status dea_direct_ac(void *session, const dea_scene *scene, const dea_model *model, dea_response *rows, dea_band *band,
                         dea_error *error)
{
    (void)session;
    return (model->membrane ? respond_radius : respond_node)(scene, model, rows, band, error);
}
