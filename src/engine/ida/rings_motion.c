#include "engine/ida/rings_motion.h"

#include <math.h>
#include <string.h>

#include "support/lapack.h"

/* Solves the symmetric positive definite A x = b in place; false where A is not. */
static bool solve_definite(size_t n, double *a, double *b)
{
    return dea_lapacke_dposv(LAPACK_COL_MAJOR, 'L', (lapack_int)n, 1, a, (lapack_int)n, b, (lapack_int)n) == 0;
}

static double dot(size_t n, const double *a, const double *b)
{
    double sum = 0.0;
    for (size_t i = 0; i < n; i++) {
        sum += a[i] * b[i];
    }
    return sum;
}

/* Sizes: the displacement that the largest voltage makes in the linear film, and what goes with it. */
static bool set_sizes(dea_rings_motion *m)
{
    const dea_dynamics *d = &m->membrane->film;
    const dea_film *film = &d->point.film;
    const double largest = m->signal->largest > 0.0 ? m->signal->largest : 1.0;
    const double longest = fmin(d->radius, d->point.frame_radius - d->radius);
    if (!dea_membrane_at_rest(m->membrane, &m->rest)) {
        return false;
    }
    m->length = fmin(longest, m->rest.compliance * largest * largest);
    m->speed = m->length * m->rest.slowest;
    m->stress = (1.0 + d->held) * film->square * film->w11 * m->length / d->radius;
    m->charge = m->rest.capacitance * largest;
    return true;
}

void dea_rings_motion_lay(const dea_membrane *membrane, const dea_signal *signal, dea_rings_motion *m)
{
    *m = (dea_rings_motion){.membrane = membrane, .signal = signal, .segment = signal->segments};
    m->nodes = membrane->rings.node_count;
    m->heavy = membrane->heavy;
    m->damped = membrane->film.retardation > 0.0;
    m->charged = membrane->film.series > 0.0;
    m->z = m->heavy ? 2 * m->nodes : m->nodes;
    m->q = m->z + dea_membrane_relaxed(membrane);
    m->count = m->q + (m->charged ? 1 : 0);
}

bool dea_rings_motion_open(const dea_membrane *membrane, const dea_signal *signal, dea_rings_motion *m)
{
    dea_rings_motion_lay(membrane, signal, m);
    return set_sizes(m);
}

bool dea_rings_glance(const dea_rings_motion *m, double time, const double *y, dea_rings_state *state)
{
    if (!dea_membrane_look_at(m->membrane, y, &state->look)) {
        return false;
    }
    state->source = dea_segment_voltage_since(m->signal, m->segment, time);
    state->voltage = m->charged ? y[m->q] / state->look.capacitance : state->source;
    return true;
}

bool dea_rings_look(const dea_rings_motion *m, double time, const double *y, const double *v, dea_rings_state *state)
{
    if (!dea_rings_glance(m, time, y, state)) {
        return false;
    }
    dea_membrane_viscous(m->membrane, &state->look, v, y + m->z, state->x);
    dea_membrane_force(m->membrane, &state->look, state->voltage, state->x, state->force);
    const size_t edge = m->membrane->rings.edge;
    state->force[edge] -= v ? m->membrane->film.damping * v[edge] : 0.0;
    return isfinite(state->force[edge]);
}

void dea_rings_relaxing(const dea_rings_motion *m, const dea_rings_state *state, const double *y, double *rates)
{
    const dea_dynamics *d = &m->membrane->film;
    size_t k = m->z;
    for (size_t r = 0; d->branch_count > 0 && r < m->membrane->rings.ring_count; r++) {
        for (int a = 0; a < 2; a++) {
            for (size_t i = 0; i < d->branch_count; i++, k++) {
                rates[k] = (state->look.rings[r].cauchy[a] - y[k]) / d->branches[i].tau;
            }
        }
    }
    if (m->charged) {
        rates[m->q] = (state->source - state->voltage) / d->series - state->voltage * d->conductance;
    }
}

/* dU/du at constant charge is -(U/C) 2 phi. What a change of the charge, or of the voltage of a film without resistance, does to
 * the forces per second [N/s]. */
static void load_rates(const dea_rings_motion *m, double time, const dea_rings_state *state, const double *rates, double *out)
{
    const double slope = m->charged ? rates[m->q] / state->look.capacitance
                                    : dea_segment_slope(m->signal, m->segment, m->segment->from + time);
    for (size_t n = 0; n < m->nodes; n++) {
        out[n] = 2.0 * state->push[n] * state->voltage * slope;
    }
}

/* Stiffness with the branches held, at constant charge where there is a series resistance. */
static void held_stiffness(const dea_rings_motion *m, dea_rings_state *state, double *stiffness)
{
    dea_membrane_push(m->membrane, &state->look, state->push);
    dea_membrane_stiffness(m->membrane, &state->look, state->voltage, state->x, m->membrane->film.total_share, stiffness);
    const double unit = m->charged ? 4.0 * state->voltage * state->voltage / state->look.capacitance : 0.0;
    for (size_t j = 0; j < m->nodes && m->charged; j++) {
        for (size_t i = 0; i < m->nodes; i++) {
            stiffness[j * m->nodes + i] += unit * state->push[i] * state->push[j];
        }
    }
}

/* Adds what relaxing branches let go per second, sum of c_i z_i'/lambda [N/s]. */
static void add_relaxation(const dea_rings_motion *m, const dea_rings_state *state, const double *rates, double *out)
{
    const dea_dynamics *d = &m->membrane->film;
    double f[DEA_RINGS_MOST][2];
    for (size_t k = 0; k < 2 * m->membrane->rings.ring_count; k++) {
        double sum = 0.0;
        for (size_t i = 0; i < d->branch_count; i++) {
            sum += d->branches[i].share * rates[m->z + k * d->branch_count + i];
        }
        f[k / 2][k % 2] = -sum / state->look.rings[k / 2].stretch[k % 2];
    }
    dea_membrane_pull(m->membrane, f, out);
}

/* Velocities of a film without mass: K v = dF/dt at constant u, or of a damper alone tau V v = F. */
static bool massless_rates(const dea_rings_motion *m, double time, dea_rings_state *state, double *rates)
{
    double matrix[DEA_RINGS_NODES * DEA_RINGS_NODES];
    if (m->damped) {
        memcpy(rates, state->force, m->nodes * sizeof *rates);
        dea_membrane_damping(m->membrane, &state->look, m->membrane->film.retardation, matrix);
        matrix[m->membrane->rings.edge * (m->nodes + 1)] += m->membrane->film.damping;
    } else {
        held_stiffness(m, state, matrix);
        load_rates(m, time, state, rates, rates);
        add_relaxation(m, state, rates, rates);
    }
    return solve_definite(m->nodes, matrix, rates);
}

bool dea_rings_massless(const dea_rings_motion *m, double time, const double *y, double *rates)
{
    dea_rings_state state;
    return dea_rings_look(m, time, y, NULL, &state) && massless_rates(m, time, &state, rates);
}

bool dea_rings_rates(const dea_rings_motion *m, double time, const double *y, double *rates)
{
    dea_rings_state state;
    if (!dea_rings_look(m, time, y, m->heavy ? y + m->nodes : NULL, &state)) {
        return false;
    }
    dea_rings_relaxing(m, &state, y, rates);
    if (!m->heavy) {
        return massless_rates(m, time, &state, rates);
    }
    for (size_t n = 0; n < m->nodes; n++) {
        rates[n] = y[m->nodes + n];
        rates[m->nodes + n] = state.force[n] / m->membrane->masses[n];
    }
    return true;
}

/* ---- Newton's method: with y' = alpha y + ..., branch i relaxes by dz = (tau b_z + S dlambda)/(1 + alpha tau), the charge by
 * dq = (b_q + (r U/C) 2 phi du)/(alpha + r), r = (1/R_s + 1/R_p)/C in units of the charge, dv = alpha du - b_u. */

void dea_rings_schur_fill(const dea_rings_motion *m, const dea_rings_state *state, double pace, dea_rings_schur *schur,
                          double *matrix)
{
    const dea_membrane *membrane = m->membrane;
    const dea_dynamics *d = &membrane->film;
    double share = d->retardation * pace;
    schur->pace = pace;
    for (size_t i = 0; i < d->branch_count; i++) {
        const double turn = pace * d->branches[i].tau;
        share += d->branches[i].share * turn / (1.0 + turn);
    }
    for (size_t r = 0; r < membrane->rings.ring_count; r++) {
        memcpy(schur->slope[r], state->look.rings[r].slope, sizeof schur->slope[r]);
        memcpy(schur->stretch[r], state->look.rings[r].stretch, sizeof schur->stretch[r]);
    }
    dea_membrane_stiffness(membrane, &state->look, state->voltage, (double(*)[2])state->x, share, matrix);
    for (size_t n = 0; n < m->nodes && m->heavy; n++) {
        matrix[n * m->nodes + n] += pace * pace * membrane->masses[n];
    }
    matrix[membrane->rings.edge * (m->nodes + 1)] += pace * d->damping;
    if (!m->charged) {
        return;
    }
    const double capacitance = schur->capacitance = state->look.capacitance;
    schur->rate = (1.0 / d->series + d->conductance) / capacitance;
    dea_membrane_push(membrane, &state->look, schur->pull);
    for (size_t n = 0; n < m->nodes; n++) {
        schur->pull[n] *= 2.0 * state->voltage / capacitance;
    }
    const double unit = capacitance * pace / (pace + schur->rate);
    for (size_t j = 0; j < m->nodes; j++) {
        for (size_t i = 0; i < m->nodes; i++) {
            matrix[j * m->nodes + i] += unit * schur->pull[i] * schur->pull[j];
        }
    }
}

/* Nominal stresses that the right-hand sides of z, and of u' = v through a damper, stand for. */
static void reduce_rings(const dea_rings_motion *m, const dea_rings_schur *schur, const double *b, double (*f)[2])
{
    const dea_dynamics *d = &m->membrane->film;
    const bool drags = m->heavy && m->damped;
    if (drags) {
        dea_membrane_rates(m->membrane, b, f);
    }
    for (size_t r = 0; r < m->membrane->rings.ring_count; r++) {
        const double rates[2] = {drags ? f[r][0] : 0.0, drags ? f[r][1] : 0.0};
        for (int a = 0; a < 2; a++) {
            double sum = d->retardation * (schur->slope[r][a][0] * rates[0] + schur->slope[r][a][1] * rates[1]);
            const double *own = b + m->z + (2 * r + (size_t)a) * d->branch_count;
            for (size_t i = 0; i < d->branch_count; i++) {
                sum += d->branches[i].share * d->branches[i].tau * own[i] / (1.0 + schur->pace * d->branches[i].tau);
            }
            f[r][a] = -sum / schur->stretch[r][a];
        }
    }
}

void dea_rings_schur_reduce(const dea_rings_motion *m, const dea_rings_schur *schur, const double *b, double *reduced)
{
    for (size_t n = 0; n < m->nodes; n++) {
        reduced[n] = m->heavy ? m->membrane->masses[n] * (b[m->nodes + n] + schur->pace * b[n]) : b[n];
    }
    const size_t edge = m->membrane->rings.edge;
    reduced[edge] += m->heavy ? m->membrane->film.damping * b[edge] : 0.0;
    if (m->membrane->film.branch_count > 0 || (m->heavy && m->damped)) {
        double f[DEA_RINGS_MOST][2];
        reduce_rings(m, schur, b, f);
        dea_membrane_pull(m->membrane, f, reduced);
    }
    for (size_t n = 0; n < m->nodes && m->charged; n++) {
        reduced[n] += schur->pull[n] * b[m->q] / (schur->pace + schur->rate);
    }
}

/* The z of x from its u. */
static void expand_rings(const dea_rings_motion *m, const dea_rings_schur *schur, const double *b, double *x)
{
    const dea_dynamics *d = &m->membrane->film;
    double strains[DEA_RINGS_MOST][2];
    size_t k = m->z;
    dea_membrane_rates(m->membrane, x, strains);
    for (size_t r = 0; r < m->membrane->rings.ring_count; r++) {
        for (int a = 0; a < 2; a++) {
            const double stress = schur->slope[r][a][0] * strains[r][0] + schur->slope[r][a][1] * strains[r][1];
            for (size_t i = 0; i < d->branch_count; i++, k++) {
                const double tau = d->branches[i].tau;
                x[k] = (tau * b[k] + stress) / (1.0 + schur->pace * tau);
            }
        }
    }
}

void dea_rings_schur_expand(const dea_rings_motion *m, const dea_rings_schur *schur, const double *b, double *x)
{
    for (size_t n = 0; n < m->nodes && m->heavy; n++) {
        x[m->nodes + n] = schur->pace * x[n] - b[n];
    }
    if (m->membrane->film.branch_count > 0) {
        expand_rings(m, schur, b, x);
    }
    if (m->charged) {
        x[m->q] = (b[m->q] + schur->rate * schur->capacitance * dot(m->nodes, schur->pull, x)) / (schur->pace + schur->rate);
    }
}

/* ---- begin and end */

bool dea_rings_start(const dea_rings_motion *m, bool from_bias, double *y)
{
    const dea_dynamics *d = &m->membrane->film;
    const double voltage = from_bias ? m->segment->start / (1.0 + d->series * d->conductance) : 0.0;
    dea_membrane_look look;
    memset(y, 0, m->count * sizeof *y);
    if (!from_bias && d->point.force == 0.0) {
        return true;
    }
    if (!dea_membrane_still(m->membrane, voltage, y) || !dea_membrane_look_at(m->membrane, y, &look)) {
        return false;
    }
    dea_membrane_relax(m->membrane, &look, y + m->z);
    if (m->charged) {
        y[m->q] = look.capacitance * voltage;
    }
    return true;
}

double dea_rings_firmness(const dea_rings_motion *m, double time, const double *y)
{
    double matrix[DEA_RINGS_NODES * DEA_RINGS_NODES], shape[DEA_RINGS_NODES];
    dea_rings_state state;
    if (m->damped) {
        return 1.0;
    }
    if (!dea_rings_look(m, time, y, NULL, &state) ||
        !dea_membrane_elliptic(m->membrane, &state.look, state.voltage, state.x, m->membrane->film.total_share)) {
        return 0.0;
    }
    if (m->heavy) {
        return 1.0;
    }
    held_stiffness(m, &state, matrix);
    memcpy(shape, state.push, sizeof shape);
    return solve_definite(m->nodes, matrix, shape) ? m->rest.softness / dot(m->nodes, state.push, shape) : 0.0;
}

double dea_rings_stiffest(const dea_rings_motion *m)
{
    const dea_dynamics *d = &m->membrane->film;
    const dea_film *film = &d->point.film;
    const double lag = 1.0 + film->tension / (film->prestretch * film->w11); /* damping over stiffness at rest */
    double largest = fmax(m->rest.fastest, d->retardation * lag * m->rest.fastest * m->rest.fastest);
    for (size_t i = 0; i < d->branch_count; i++) {
        largest = fmax(largest, (1.0 + d->branches[i].share) / d->branches[i].tau);
    }
    const double charging = m->charged ? (1.0 / d->series + d->conductance) * m->signal->largest / m->charge : 0.0;
    return fmax(largest, charging);
}

double dea_rings_decay(const dea_rings_motion *m)
{
    const dea_dynamics *d = &m->membrane->film;
    const double square = m->rest.slowest * m->rest.slowest;
    double sum = d->retardation;
    for (size_t i = 0; i < d->branch_count; i++) {
        const double tau = d->branches[i].tau;
        sum += d->branches[i].share / (1.0 + d->total_share) * tau / (1.0 + square * tau * tau);
    }
    return 0.5 * square * sum;
}

dea_moment dea_rings_moment(const dea_rings_motion *m, double time, const dea_rings_state *state)
{
    return (dea_moment){.time = m->segment->from + time,
                        .source = state->source,
                        .voltage = state->voltage,
                        .slope = dea_segment_slope(m->signal, m->segment, m->segment->from + time)};
}
