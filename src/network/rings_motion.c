#include "network/rings_motion.h"

#include <math.h>
#include <string.h>

#include "film/point.h"
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

/* Shares and pace of the charges at rest. */
static bool set_charges(dea_rings_motion *m)
{
    static const double still[DEA_RINGS_NODES] = {0.0}, none[DEA_SHEET_PLACES] = {0.0};
    dea_membrane_look look;
    dea_charges charges;
    if (!dea_membrane_look_at(m->membrane, still, &look)) {
        return false;
    }
    dea_sheet_look(m->membrane, &look, none, 0.0, &charges);
    for (size_t k = 0; k < m->charges; k++) {
        m->shares[k] = charges.capacitances[k] / look.capacitance;
    }
    m->charging = dea_sheet_fastest(m->membrane, &look);
    return true;
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
    m->nodes = membrane->nodes;
    m->heavy = membrane->heavy;
    m->damped = membrane->film.retardation > 0.0 || membrane->second.retardation > 0.0;
    m->charges = membrane->sheet.charges;
    m->charged = m->charges > 0;
    m->z = m->heavy ? 2 * m->nodes : m->nodes;
    m->q = m->z + dea_membrane_relaxed(membrane);
    m->count = m->q + m->charges;
}

bool dea_rings_motion_open(const dea_membrane *membrane, const dea_signal *signal, dea_rings_motion *m)
{
    dea_rings_motion_lay(membrane, signal, m);
    return set_sizes(m) && set_charges(m);
}

bool dea_rings_glance(const dea_rings_motion *m, double time, const double *y, dea_rings_state *state)
{
    if (!dea_membrane_look_at(m->membrane, y, &state->look)) {
        return false;
    }
    state->source = dea_segment_voltage_since(m->signal, m->segment, time);
    dea_sheet_look(m->membrane, &state->look, y + m->q, state->source, &state->charges);
    state->voltage = state->charges.voltage;
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
        dea_sheet_flows(m->membrane, &state->look, &state->charges, state->source, rates + m->q);
    }
}

/* P_k = dF/dV_k = 2 V_k (1/2) dC_k/du of charge number k [N/V]. */
static void pull_of(const dea_rings_motion *m, const dea_rings_state *state, size_t k, double *pull)
{
    dea_sheet_push(m->membrane, &state->look, k, pull);
    for (size_t n = 0; n < m->nodes; n++) {
        pull[n] *= 2.0 * state->charges.voltages[k];
    }
}

/* What changes of the charges, and of the voltage of a film or of a rim without resistance, do to the forces per second [N/s]. */
static void load_rates(const dea_rings_motion *m, double time, const dea_rings_state *state, const double *rates, double *out)
{
    const double slope = dea_segment_slope(m->signal, m->segment, m->segment->from + time);
    const size_t places = m->membrane->sheet.places > 0 ? m->membrane->sheet.places : 1;
    double pull[DEA_RINGS_NODES], sum[DEA_RINGS_NODES] = {0.0};
    for (size_t k = 0; k < places; k++) {
        const double rate = k < m->charges ? rates[m->q + k] / state->charges.capacitances[k] : slope;
        pull_of(m, state, k, pull);
        for (size_t n = 0; n < m->nodes; n++) {
            sum[n] += pull[n] * rate;
        }
    }
    memcpy(out, sum, m->nodes * sizeof *out);
}

/* Stiffness with the branches held, at constant charges: dV/du at constant q is -P/C. */
static void held_stiffness(const dea_rings_motion *m, dea_rings_state *state, double *stiffness)
{
    double pull[DEA_RINGS_NODES];
    dea_membrane_push(m->membrane, &state->look, state->push);
    dea_membrane_stiffness(m->membrane, &state->look, state->voltage, state->x, m->membrane->film.total_share, stiffness);
    for (size_t k = 0; k < m->charges; k++) {
        pull_of(m, state, k, pull);
        for (size_t j = 0; j < m->nodes; j++) {
            for (size_t i = 0; i < m->nodes; i++) {
                stiffness[j * m->nodes + i] += pull[i] * pull[j] / state->charges.capacitances[k];
            }
        }
    }
}

/* Adds what relaxing branches let go per second, sum of c_i z_i'/lambda [N/s]. */
static void add_relaxation(const dea_rings_motion *m, const dea_rings_state *state, const double *rates, double *out)
{
    const dea_dynamics *d = &m->membrane->film;
    double f[DEA_MEMBRANE_RINGS][2] = {{0.0}};
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
        dea_membrane_damp_second(m->membrane, &state->look, 1.0, matrix);
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

/* ---- Newton's method: with y' = alpha y + ..., branch i relaxes by dz = (tau b_z + S dlambda)/(1 + alpha tau), dv = alpha du - b_u;
 * charges dq = C dV + P du spread by (alpha C + Y) dV = b_q - alpha P du with the admittance Y, so that V adds P (C + Y/alpha)^-1 P to
 * the stiffness. That of the sheets counts as constant: a Newton step more is cheaper than its change with u. */

/* The inverse of C + Y/alpha. */
static bool fill_charges(const dea_rings_motion *m, const dea_rings_state *state, dea_rings_schur *schur)
{
    const size_t count = m->charges;
    double matrix[DEA_SHEET_PLACES * DEA_SHEET_PLACES];
    dea_sheet_admittance(m->membrane, &state->look, matrix);
    memset(schur->inverse, 0, count * count * sizeof *schur->inverse);
    for (size_t k = 0; k < count; k++) {
        schur->capacitances[k] = state->charges.capacitances[k];
        schur->inverse[k * (count + 1)] = 1.0;
        pull_of(m, state, k, schur->pull[k]);
        for (size_t j = 0; j < count; j++) {
            matrix[j * count + k] = matrix[j * count + k] / schur->pace + (j == k ? schur->capacitances[k] : 0.0);
        }
    }
    const lapack_int size = (lapack_int)count;
    return dea_lapacke_dposv(LAPACK_COL_MAJOR, 'L', size, size, matrix, size, schur->inverse, size) == 0;
}

/* Adds P (C + Y/alpha)^-1 P. */
static void add_charges(const dea_rings_motion *m, const dea_rings_schur *schur, double *matrix)
{
    const size_t count = m->charges;
    double spread[DEA_RINGS_NODES];
    for (size_t k = 0; k < count; k++) {
        memset(spread, 0, m->nodes * sizeof *spread);
        for (size_t l = 0; l < count; l++) {
            for (size_t n = 0; n < m->nodes; n++) {
                spread[n] += schur->inverse[k * count + l] * schur->pull[l][n];
            }
        }
        for (size_t j = 0; j < m->nodes; j++) {
            for (size_t i = 0; i < m->nodes && schur->pull[k][j] != 0.0; i++) {
                matrix[j * m->nodes + i] += schur->pull[k][j] * spread[i];
            }
        }
    }
}

/* (C + Y/alpha)^-1 (b_q/alpha - P u), of the charges' right-hand sides and displacements; u NULL: 0 [V]. */
static void spread_charges(const dea_rings_motion *m, const dea_rings_schur *schur, const double *b, const double *u, double *voltages)
{
    const size_t count = m->charges;
    memset(voltages, 0, count * sizeof *voltages);
    for (size_t k = 0; k < count; k++) {
        const double charge = b[m->q + k] / schur->pace - (u ? dot(m->nodes, schur->pull[k], u) : 0.0);
        for (size_t l = 0; l < count; l++) {
            voltages[l] += schur->inverse[k * count + l] * charge;
        }
    }
}

bool dea_rings_schur_fill(const dea_rings_motion *m, const dea_rings_state *state, double pace, dea_rings_schur *schur,
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
    for (size_t r = 0; r < membrane->ring_total; r++) {
        memcpy(schur->slope[r], state->look.rings[r].slope, sizeof schur->slope[r]);
        memcpy(schur->stretch[r], state->look.rings[r].stretch, sizeof schur->stretch[r]);
    }
    dea_membrane_stiffness(membrane, &state->look, state->voltage, (double(*)[2])state->x, share, matrix);
    dea_membrane_damp_second(membrane, &state->look, pace, matrix);
    for (size_t n = 0; n < m->nodes && m->heavy; n++) {
        matrix[n * m->nodes + n] += pace * pace * membrane->masses[n];
    }
    matrix[membrane->rings.edge * (m->nodes + 1)] += pace * d->damping;
    if (m->charged && !fill_charges(m, state, schur)) {
        return false;
    }
    add_charges(m, schur, matrix);
    return true;
}

/* Nominal stresses that the right-hand sides of z, and of u' = v through a damper, stand for. */
static void reduce_rings(const dea_rings_motion *m, const dea_rings_schur *schur, const double *b, double (*f)[2])
{
    const dea_dynamics *d = &m->membrane->film;
    const bool drags = m->heavy && m->damped;
    if (drags) {
        dea_membrane_rates(m->membrane, b, f);
    }
    for (size_t r = 0; r < m->membrane->ring_total; r++) {
        const bool first = r < m->membrane->rings.ring_count;
        const double tau = first ? d->retardation : m->membrane->second.retardation;
        const double rates[2] = {drags ? f[r][0] : 0.0, drags ? f[r][1] : 0.0};
        for (int a = 0; a < 2; a++) {
            double sum = tau * (schur->slope[r][a][0] * rates[0] + schur->slope[r][a][1] * rates[1]);
            const double *own = b + m->z + (2 * r + (size_t)a) * d->branch_count;
            for (size_t i = 0; i < d->branch_count && first; i++) {
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
        double f[DEA_MEMBRANE_RINGS][2];
        reduce_rings(m, schur, b, f);
        dea_membrane_pull(m->membrane, f, reduced);
    }
    double voltages[DEA_SHEET_PLACES];
    spread_charges(m, schur, b, NULL, voltages);
    for (size_t k = 0; k < m->charges; k++) {
        for (size_t n = 0; n < m->nodes; n++) {
            reduced[n] += schur->pull[k][n] * voltages[k];
        }
    }
}

/* The z of x from its u. */
static void expand_rings(const dea_rings_motion *m, const dea_rings_schur *schur, const double *b, double *x)
{
    const dea_dynamics *d = &m->membrane->film;
    double strains[DEA_MEMBRANE_RINGS][2];
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
    double voltages[DEA_SHEET_PLACES];
    spread_charges(m, schur, b, x, voltages);
    for (size_t k = 0; k < m->charges; k++) {
        x[m->q + k] = schur->capacitances[k] * voltages[k] + dot(m->nodes, schur->pull[k], x);
    }
}

/* ---- begin and end */

bool dea_rings_start(const dea_rings_motion *m, bool from_bias, double *y)
{
    const dea_dynamics *d = &m->membrane->film;
    const double voltage = from_bias ? m->segment->start / (1.0 + d->series * d->conductance) : 0.0;
    dea_membrane_look look;
    dea_charges charges;
    memset(y, 0, m->count * sizeof *y);
    if (!from_bias && !dea_point_is_pulled(&d->point)) {
        return true;
    }
    if (!dea_membrane_still(m->membrane, voltage, y) || !dea_membrane_look_at(m->membrane, y, &look)) {
        return false;
    }
    dea_membrane_relax(m->membrane, &look, y + m->z);
    dea_sheet_look(m->membrane, &look, y + m->q, voltage, &charges);
    for (size_t k = 0; k < m->charges; k++) { /* with a sheet resistance there is no leakage then */
        y[m->q + k] = charges.capacitances[k] * voltage;
    }
    return true;
}

enum { MOST_ROUNDS = 30 };
static const double longest_step = 0.1; /* of the radius of the edge, in one round */

bool dea_rings_settle(const dea_rings_motion *m, double *y)
{
    double matrix[DEA_RINGS_NODES * DEA_RINGS_NODES], last = INFINITY;
    dea_rings_state state;
    for (int i = 0; i < MOST_ROUNDS && dea_rings_look(m, 0.0, y, NULL, &state); i++) {
        double largest = 0.0, step = 0.0;
        held_stiffness(m, &state, matrix);
        if (!dea_membrane_elliptic(m->membrane, &state.look, state.voltage, state.x, m->membrane->film.total_share) ||
            !solve_definite(m->nodes, matrix, state.force)) {
            return false;
        }
        for (size_t n = 0; n < m->nodes; n++) {
            step = fmax(step, fabs(state.force[n]));
            largest = fmax(largest, fabs(y[n]));
        }
        const double most = longest_step * m->membrane->film.radius;
        for (size_t n = 0; n < m->nodes; n++) {
            y[n] += state.force[n] * fmin(1.0, most / step);
        }
        if (step <= 4e-16 * largest || (step < 1e-10 * most && step >= 0.5 * last)) {
            return true;
        }
        last = step;
    }
    return last <= 1e-11 * m->membrane->film.radius;
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

/* Damping over stiffness at rest. */
static double lag_of(const dea_film *film)
{
    return 1.0 + film->tension / (film->prestretch * film->w11);
}

double dea_rings_stiffest(const dea_rings_motion *m)
{
    const dea_dynamics *d = &m->membrane->film;
    const dea_membrane_second *second = &m->membrane->second;
    const double tau = fmax(d->retardation * lag_of(&d->point.film), second->retardation > 0.0 ? second->retardation * lag_of(&second->point.film) : 0.0);
    double largest = fmax(m->rest.fastest, tau * m->rest.fastest * m->rest.fastest);
    for (size_t i = 0; i < d->branch_count; i++) {
        largest = fmax(largest, (1.0 + d->branches[i].share) / d->branches[i].tau);
    }
    return fmax(largest, m->charging);
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
    const bool second = m->membrane->second.rings.ring_count > 0;
    return 0.5 * square * (second ? fmin(sum, m->membrane->second.retardation) : sum); /* a mode of one film dies by its damper alone */
}

dea_moment dea_rings_moment(const dea_rings_motion *m, double time, const dea_rings_state *state)
{
    return (dea_moment){.time = m->segment->from + time,
                        .source = state->source,
                        .voltage = state->voltage,
                        .slope = dea_segment_slope(m->signal, m->segment, m->segment->from + time)};
}
