#include "network/motion.h"

#include <math.h>
#include <string.h>

/* What the equations need at one state, in SI units. */
typedef struct local_state {
    dea_edge edge;
    double u, v;
    double voltage;       /* of the film [V] */
    double voltage_slope; /* dU/du at constant charge [V/m] */
    double viscous;       /* sum B_a S_a' [N/m] */
    double z[DEA_RELAXED_MAX];
    double force; /* phi U^2 less what the film holds but for its damper [N] */
} local_state;

/* Rate of all that relaxes and charges [1/s]; 1 where nothing does. */
static double pace_of(const dea_dynamics *d, double capacitance)
{
    double sum = d->series > 0.0 ? 1.0 / (d->series * capacitance) : 0.0;
    for (size_t i = 0; i < d->branch_count; i++) {
        sum += 1.0 / d->branches[i].tau;
    }
    return sum > 0.0 ? sum : 1.0;
}

/* Stress and branch that unknown number @p k, a z, belongs to. */
static size_t stress_of(const dea_motion *m, int k)
{
    return (size_t)(k - m->z) / m->dynamics->branch_count;
}

static const dea_branch *branch_of(const dea_motion *m, int k)
{
    return &m->dynamics->branches[(size_t)(k - m->z) % m->dynamics->branch_count];
}

/* One past the last z. */
static int relaxed_end(const dea_motion *m)
{
    return m->z + (int)dea_dynamics_states(m->dynamics);
}

void dea_motion_open(dea_dynamics *d, const dea_signal *signal, dea_motion *m)
{
    const double still = isnan(d->rest) ? 0.0 : d->rest;
    const dea_edge rest = dea_dynamics_edge(d, still);
    const double length = dea_dynamics_scale(d, signal->largest);
    const bool heavy = d->mass > 0.0;
    *m = (dea_motion){.dynamics = d, .signal = signal, .segment = signal->segments, .v = -1, .q = -1, .z = heavy ? 2 : 1};
    m->stiffness = dea_dynamics_stiffness(d, still, 0.0, false);
    m->algebraic = dea_dynamics_is_free(d);
    m->pace = pace_of(d, rest.capacitance);
    m->capacitance = rest.capacitance;
    m->size[0] = length;
    if (heavy) {
        m->v = 1;
        m->size[1] = length * sqrt(m->stiffness / d->mass);
    }
    m->count = m->z + (int)dea_dynamics_states(d);
    for (int i = m->z; i < m->count; i++) {
        m->size[i] = dea_edge_viscous(d, &rest) / rest.lever[stress_of(m, i)] * length; /* that holds the film at the length */
    }
    if (d->series > 0.0) {
        m->q = m->count++;
        m->size[m->q] = rest.capacitance * (signal->largest > 0.0 ? signal->largest : 1.0);
    }
}

/* Source voltage [V] and its slope [V/s] at a time of the segment [s]. */
static double motion_source(const dea_motion *m, double time)
{
    return dea_segment_voltage_since(m->signal, m->segment, time);
}

static double motion_slope(const dea_motion *m, double time)
{
    return dea_segment_slope(m->signal, m->segment, m->segment->from + time);
}

bool dea_motion_inside(const dea_motion *m, double u)
{
    return dea_dynamics_inside(m->dynamics, u);
}

/* False where a number is not finite, or a stretch not positive in springs that are not linear, or nothing is left to charge. */
static bool look(const dea_motion *m, double time, const double *y, local_state *at)
{
    dea_dynamics *d = m->dynamics;
    at->u = y[0] * m->size[0];
    at->v = m->v >= 0 ? y[m->v] * m->size[m->v] : 0.0;
    if (d->framed && !dea_motion_inside(m, at->u)) {
        return false;
    }
    at->edge = dea_dynamics_edge(d, at->u);
    at->voltage_slope = 0.0;
    if (m->q >= 0) {
        if (!(at->edge.capacitance > 0.0)) {
            return false;
        }
        at->voltage = y[m->q] * m->size[m->q] / at->edge.capacitance;
        at->voltage_slope = -at->voltage * at->edge.capacitance_slope / at->edge.capacitance;
    } else {
        at->voltage = motion_source(m, time);
    }
    dea_motion_branches(m, y, at->z);
    at->viscous = dea_edge_viscous(d, &at->edge);
    at->force = at->edge.push * at->voltage * at->voltage - dea_edge_held(d, &at->edge, at->z);
    return isfinite(at->force) && isfinite(at->v);
}

/* Mechanical resistance tau_KV sum B_a S_a' + r [N s/m]. */
static double resistance(const dea_motion *m, const local_state *at)
{
    return m->dynamics->retardation * at->viscous + m->dynamics->damping;
}

bool dea_motion_rates(const dea_motion *m, double time, const double *y, double *f)
{
    const dea_dynamics *d = m->dynamics;
    local_state at;
    if (!look(m, time, y, &at)) {
        return false;
    }
    if (m->v >= 0) {
        f[0] = at.v / m->size[0];
        f[m->v] = (at.force - resistance(m, &at) * at.v) / (d->mass * m->size[m->v]);
    } else if (m->algebraic) {
        f[0] = at.force / (m->stiffness * m->size[0]) * m->pace;
    } else {
        const double r = resistance(m, &at);
        if (!(r > 0.0)) {
            return false; /* nothing holds the film any more: no velocity */
        }
        f[0] = at.force / (r * m->size[0]);
    }
    for (int k = m->z; k < relaxed_end(m); k++) {
        f[k] = (at.edge.stress[stress_of(m, k)] / m->size[k] - y[k]) / branch_of(m, k)->tau;
    }
    if (m->q >= 0) {
        const double current = dea_dynamics_flow(d, motion_source(m, time) - at.voltage) - at.voltage * d->conductance;
        f[m->q] = current / m->size[m->q];
    }
    return isfinite(f[0]);
}

/* Slope of the net force over u [N/m]. */
static double force_slope(const dea_motion *m, const local_state *at)
{
    const dea_edge *e = &at->edge;
    return (e->push_slope * at->voltage + 2.0 * e->push * at->voltage_slope) * at->voltage -
           dea_edge_held_slope(m->dynamics, e, at->z);
}

/* The row of the edge equation: force over u, z and q, over @p unit [N]. */
static void fill_edge_row(const dea_motion *m, const local_state *at, int row, double unit, double *jacobian)
{
    const int n = m->count;
    jacobian[row] = force_slope(m, at) * m->size[0] / unit;
    for (int k = m->z; k < relaxed_end(m); k++) {
        jacobian[k * n + row] = at->edge.lever[stress_of(m, k)] * branch_of(m, k)->share * m->size[k] / unit;
    }
    if (m->q >= 0) {
        jacobian[m->q * n + row] = 2.0 * at->edge.push * at->voltage / at->edge.capacitance * m->size[m->q] / unit;
    }
}

void dea_motion_jacobian(const dea_motion *m, double time, const double *y, double *jacobian)
{
    const dea_dynamics *d = m->dynamics;
    const int n = m->count;
    local_state at;
    memset(jacobian, 0, (size_t)(n * n) * sizeof *jacobian);
    if (!look(m, time, y, &at)) {
        return;
    }
    const double r = resistance(m, &at);
    if (m->v >= 0) {
        const double unit = d->mass * m->size[m->v];
        fill_edge_row(m, &at, m->v, unit, jacobian);
        jacobian[m->v] -= d->retardation * dea_edge_viscous_slope(d, &at.edge) * at.v * m->size[0] / unit;
        jacobian[m->v * n + m->v] = -r / d->mass;
        jacobian[m->v * n] = m->size[m->v] / m->size[0];
    } else {
        fill_edge_row(m, &at, 0, (m->algebraic ? m->stiffness / m->pace : r) * m->size[0], jacobian);
        jacobian[0] -= m->algebraic ? 0.0 : at.force * d->retardation * dea_edge_viscous_slope(d, &at.edge) / (r * r);
    }
    for (int k = m->z; k < relaxed_end(m); k++) {
        const double tau = branch_of(m, k)->tau;
        jacobian[k] = at.edge.stress_slope[stress_of(m, k)] * m->size[0] / (m->size[k] * tau);
        jacobian[k * n + k] = -1.0 / tau;
    }
    if (m->q >= 0) {
        const bool limited = dea_dynamics_excess(d, motion_source(m, time) - at.voltage) > 0.0;
        const double admittance = (limited ? 0.0 : 1.0 / d->series) + d->conductance;
        jacobian[m->q] = -admittance * at.voltage_slope * m->size[0] / m->size[m->q];
        jacobian[m->q * n + m->q] = -admittance / at.edge.capacitance;
    }
}

double dea_motion_firmness(const dea_motion *m, double time, const double *y)
{
    local_state at;
    if (!m->algebraic && m->q < 0) {
        return 1.0;
    }
    if (!look(m, time, y, &at)) {
        return 0.0;
    }
    const double charge = m->q < 0 ? 1.0 : fmin(1.0, at.edge.capacitance / m->capacitance);
    return m->algebraic ? fmin(charge, -force_slope(m, &at) / m->stiffness) : charge;
}

void dea_motion_branches(const dea_motion *m, const double *y, double *z)
{
    for (int k = m->z; k < relaxed_end(m); k++) {
        z[k - m->z] = y[k] * m->size[k];
    }
}

bool dea_motion_jump(const dea_motion *m, double *y)
{
    double z[DEA_RELAXED_MAX];
    double u = y[0] * m->size[0];
    if (!m->algebraic || m->q >= 0) {
        return true;
    }
    dea_motion_branches(m, y, z);
    if (!dea_dynamics_follow(m->dynamics, m->segment->start, z, &u)) {
        return false;
    }
    y[0] = u / m->size[0];
    return true;
}

bool dea_motion_start(const dea_motion *m, bool from_bias, double *y)
{
    dea_dynamics *d = m->dynamics;
    double u, voltage;
    memset(y, 0, (size_t)m->count * sizeof *y);
    if (!(m->stiffness > 0.0) || !dea_dynamics_begin(d, from_bias, m->segment->start, &u, &voltage)) {
        return false;
    }
    const dea_edge e = dea_dynamics_edge(d, u);
    y[0] = u / m->size[0];
    for (int k = m->z; k < relaxed_end(m); k++) {
        y[k] = e.stress[stress_of(m, k)] / m->size[k];
    }
    if (m->q >= 0) {
        y[m->q] = e.capacitance * voltage / m->size[m->q];
    }
    return true;
}

/* Velocity of a film without mass. */
static double velocity(const dea_motion *m, double time, const local_state *at)
{
    dea_dynamics *d = m->dynamics;
    if (m->q < 0) {
        return dea_dynamics_velocity(d, at->u, at->voltage, motion_slope(m, time), at->z);
    }
    const double current = dea_dynamics_flow(d, motion_source(m, time) - at->voltage) - at->voltage * d->conductance;
    return dea_dynamics_velocity_charged(d, at->u, at->voltage, current / at->edge.capacitance, at->z);
}

dea_moment dea_motion_moment(const dea_motion *m, double time, const double *y)
{
    local_state at;
    const double none = (double)NAN;
    dea_moment moment = {
        .time = m->segment->from + time, .source = motion_source(m, time), .u = none, .v = none, .voltage = none};
    if (!look(m, time, y, &at)) {
        return moment;
    }
    moment.voltage = at.voltage;
    moment.slope = motion_slope(m, time);
    moment.u = at.u;
    moment.v = at.v;
    if (m->v < 0) {
        moment.v = velocity(m, time, &at);
    }
    return moment;
}
