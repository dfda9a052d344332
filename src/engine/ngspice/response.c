/* Frequency responses: the small-signal network about the equilibrium under the bias. Its elements are linear, so that no
 * operating point is looked for and every frequency is solved exactly. */
#include <math.h>
#include <stdlib.h>

#include "deaspice/measures.h"
#include "engine/ngspice/moving.h"
#include "engine/ngspice/deck.h"

/* The library rounds the number of steps between two frequencies down: a last one that rounding leaves short would be lost. */
static const double grid = 1e-13;

/* Magnitude and phase [deg], -180 < phase <= 180. */
static void polar(double re, double im, double *magnitude, double *phase)
{
    const double angle = atan2(im, re) * 180.0 / DEA_PI;
    *magnitude = hypot(re, im);
    *phase = angle <= -180.0 ? 180.0 : angle;
}

/* What a frequency response is computed from: where there is a series resistance, the current through it is a small difference of
 * voltages, and what goes into the film the better number. */
typedef struct film_port {
    bool series;
    double resistance, conductance;   /* R_s [Ohm], 1/R_p [S] */
    double capacitance, transduction; /* C [F], 2 phi U [A s/m] */
} film_port;

static film_port port_of(dea_dynamics *d, const dea_mobility_bias *bias)
{
    const dea_edge e = dea_dynamics_edge(d, bias->u);
    return (film_port){d->series > 0.0, d->series, d->conductance, e.capacitance, 2.0 * e.push * bias->voltage};
}

/* Input impedance: of the source of 1 V, whose current is counted from its plus to its minus pole; or R_s + U/i of the film with
 * i = i w (C U + T u) + U/R_p. Numbers are pairs of real and imaginary part. */
static void impedance_of(const film_port *port, const double *first, const double u[2], double frequency, double z[2])
{
    const double omega = 2.0 * DEA_PI * frequency;
    double current[2] = {-first[0], -first[1]}, voltage[2] = {1.0, 0.0};
    if (port->series) {
        voltage[0] = first[0];
        voltage[1] = first[1];
        current[0] = port->conductance * first[0] - omega * (port->capacitance * first[1] + port->transduction * u[1]);
        current[1] = port->conductance * first[1] + omega * (port->capacitance * first[0] + port->transduction * u[0]);
    }
    const double square = current[0] * current[0] + current[1] * current[1];
    z[0] = (port->series ? port->resistance : 0.0) + (voltage[0] * current[0] + voltage[1] * current[1]) / square;
    z[1] = (voltage[1] * current[0] - voltage[0] * current[1]) / square;
}

static void fill_row(const film_port *port, const dea_ngspice_table *table, size_t index, double frequency, dea_response *row)
{
    double z[2];
    const double *u = &table->columns[0][2 * index];
    impedance_of(port, &table->columns[1][2 * index], u, frequency, z);
    row->frequency = frequency;
    polar(u[0], u[1], &row->displacement, &row->displacement_phase);
    polar(z[0], z[1], &row->impedance, &row->impedance_phase);
    row->state = DEA_STATE_OK;
}

typedef struct response {
    dea_ngspice *library;
    const dea_scene *scene;
    dea_dynamics *dynamics;
    dea_mobility_bias bias;
    dea_response *rows;
} response;

/* Displacement and film of @p count frequencies; the caller frees the table, also after a failure. */
static dea_status run_netlist(const response *r, const dea_mobility_band *band, size_t count, dea_ngspice_table *table,
                              dea_error *error)
{
    const char *const names[] = {"disp", r->dynamics->series > 0.0 ? "film" : "vsource#branch"};
    char *netlist = NULL;
    dea_status status = dea_mobility_write_small(r->dynamics, &r->bias, band, &netlist, error);
    if (status == DEA_OK) {
        status = dea_ngspice_run_all(r->library, netlist, names, 2, table, error);
    }
    if (status == DEA_OK && table->count != count) {
        status = dea_fail(error, DEA_ERROR_ENGINE, "ngspice gave %zu of %zu frequencies", table->count, count);
    }
    free(netlist);
    return status;
}

/* Frequencies between the rows: the library counts them evenly from one to another. */
static bool magnitudes(void *user, double from, double to, size_t count, double *out)
{
    const response *r = user;
    const dea_mobility_band band = {.from = from, .to = to, .count = count};
    dea_ngspice_table table = {0};
    dea_error ignored = {0};
    const bool answered = run_netlist(r, &band, count, &table, &ignored) == DEA_OK;
    for (size_t i = 0; answered && i < count; i++) {
        out[i] = hypot(table.columns[0][2 * i], table.columns[0][2 * i + 1]);
    }
    dea_ngspice_table_free(&table);
    return answered;
}

/* Rows first ... first + count - 1, on one grid. */
static dea_status run_band(const response *r, size_t first, size_t count, dea_error *error)
{
    const film_port port = port_of(r->dynamics, &r->bias);
    const dea_mobility_band band = {.from = dea_layout_place(r->scene, first),
                                    .to = dea_layout_place(r->scene, first + count - 1) * (1.0 + grid),
                                    .points_per_decade = count > 1 ? r->scene->ac.points_per_decade : 0};
    dea_ngspice_table table = {0};
    const dea_status status = run_netlist(r, &band, count, &table, error);
    for (size_t i = 0; i < count && status == DEA_OK; i++) {
        fill_row(&port, &table, i, dea_layout_place(r->scene, first + i), &r->rows[first + i]);
    }
    dea_ngspice_table_free(&table);
    return status;
}

/* The state of the film under its bias stands in every row. */
static void name_states(const response *r, size_t count, dea_state state)
{
    for (size_t i = 0; i < count; i++) {
        r->rows[i].state = state;
    }
}

static void refuse_rows(const response *r, size_t count)
{
    const double none = (double)NAN;
    for (size_t i = 0; i < count; i++) {
        r->rows[i] = (dea_response){dea_layout_place(r->scene, i), none, none, none, none, DEA_STATE_PULL_IN};
    }
}

static bool sample_at_bias(const response *r, dea_sample *sample)
{
    const dea_moment moment = {.source = r->scene->ac.bias, .voltage = r->bias.voltage, .u = r->bias.u};
    return dea_dynamics_sample(r->dynamics, &moment, sample);
}

/* The last frequency is the end of the band, which need not lie on the grid of the others. */
static dea_status run_bands(response *r, dea_band *band, dea_error *error)
{
    const size_t count = dea_layout_of(r->scene).rows;
    dea_dynamics *d = r->dynamics;
    dea_sample at_bias;
    r->bias.voltage = r->scene->ac.bias / (1.0 + d->series * d->conductance);
    if (!dea_dynamics_equilibrium(d, r->bias.voltage, &r->bias.u) ||
        !(dea_dynamics_stiffness(d, r->bias.u, r->bias.voltage, true) > 0.0) || !sample_at_bias(r, &at_bias)) {
        refuse_rows(r, count);
        return DEA_OK;
    }
    dea_status status = DEA_OK;
    if (count > 1) {
        status = run_band(r, 0, count - 1, error);
    }
    if (status == DEA_OK) {
        status = run_band(r, count - 1, 1, error);
    }
    if (status == DEA_OK && band) {
        *band = dea_measure_band(r->rows, count, magnitudes, r);
    }
    name_states(r, count, at_bias.state);
    return status;
}

static dea_status run_inside(dea_ngspice *library, const dea_scene *scene, const dea_model *model, dea_response *rows,
                             dea_band *band, dea_error *error)
{
    dea_dynamics dynamics;
    dea_status status = dea_dynamics_open(scene, model, &dynamics, error);
    if (status == DEA_OK) {
        response r = {.library = library, .scene = scene, .dynamics = &dynamics, .rows = rows};
        status = run_bands(&r, band, error);
    }
    dea_dynamics_close(&dynamics);
    return status;
}

/* Units that suit the scene; its time is that of the middle of the band. */
static dea_status find_units(const dea_scene *scene, const dea_model *model, dea_units *units, dea_error *error)
{
    dea_dynamics dynamics;
    const dea_status status = dea_dynamics_open(scene, model, &dynamics, error);
    if (status == DEA_OK) {
        const dea_sizes sizes = {.displacement = dea_dynamics_scale(&dynamics, scene->ac.bias),
                                 .voltage = fabs(scene->ac.bias),
                                 .time = 1.0 / sqrt(scene->ac.from * scene->ac.to)};
        *units = dea_units_of(&dynamics, &sizes);
    }
    dea_dynamics_close(&dynamics);
    return status;
}

dea_status dea_ngspice_ac(dea_ngspice *library, const dea_scene *scene, const dea_model *model, dea_response *rows,
                          dea_band *band, dea_error *error)
{
    dea_units units;
    dea_scene inside;
    dea_band found = {(double)NAN, (double)NAN};
    dea_status status = find_units(scene, model, &units, error);
    if (status == DEA_OK) {
        status = dea_units_enter(&units, scene, &inside, error);
    }
    if (status != DEA_OK) {
        return status;
    }
    status = run_inside(library, &inside, model, rows, band ? &found : NULL, error);
    dea_units_leave(&inside);
    for (size_t i = 0; status == DEA_OK && i < dea_layout_of(scene).rows; i++) {
        dea_units_return_response(&units, &rows[i]);
    }
    if (band) {
        *band = (dea_band){found.resonance * units.time, found.bandwidth * units.time};
    }
    return status;
}
