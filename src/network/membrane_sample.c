#include "network/membrane_sample.h"

#include <math.h>
#include <string.h>

#include "film/point.h"
#include "network/sheet.h"
#include "support/gauss.h"

/* The film voltage, or the largest of the rings. */
static double peak_voltage(const dea_membrane *m, const dea_membrane_look *look, double voltage)
{
    double largest = 0.0;
    for (size_t r = 0; r < m->rings.ring_count && look->spread; r++) {
        largest = fmax(largest, fabs(dea_membrane_voltage(m, look, r, voltage)));
    }
    return look->spread ? largest : voltage;
}

/* dC/dt [F/s]. */
static double capacitance_rate(const dea_membrane *m, const dea_membrane_look *look, const double *v)
{
    double push[DEA_RINGS_NODES], sum = 0.0;
    dea_membrane_push(m, look, push);
    for (size_t i = 0; i < m->nodes; i++) {
        sum += 2.0 * push[i] * v[i];
    }
    return sum;
}

double dea_membrane_current(const dea_membrane *m, const dea_membrane_look *look, const dea_moment *moment, const double *v)
{
    const dea_dynamics *d = &m->film;
    const double leak = dea_sheet_leakage(m, look, moment->voltage);
    if (moment->charging) {
        return moment->charge_slope + leak + dea_sheet_rim_current(m, look, moment->source, moment->slope, v);
    }
    if (d->series > 0.0) {
        return (moment->source - dea_sheet_rim_voltage(m, look, moment->voltage)) / d->series;
    }
    if (look->spread) {
        return dea_sheet_rim_current(m, look, moment->source, moment->slope, v) + dea_sheet_through(m, look);
    }
    return look->capacitance * moment->slope + capacitance_rate(m, look, v) * moment->voltage + leak;
}

static bool fill_sample(const dea_membrane *m, const dea_membrane_look *look, const dea_moment *moment, const double *u,
                        const double *v, dea_sample *sample)
{
    dea_row row = dea_row_failed();
    const dea_point *point = &m->film.point;
    const double peak = peak_voltage(m, look, moment->voltage);
    const double field = fabs(peak) * point->layers / point->film_thickness; /* nominal, of a layer */
    dea_membrane_fill(m, look, peak, u, field > 0.0 ? point->film.breakdown / field : (double)INFINITY, &row);
    *sample = dea_sample_refused(moment->time, moment->source, DEA_STATE_PULL_IN);
    if (row.state == DEA_STATE_FAILED || !isfinite(v[m->rings.edge])) {
        return false;
    }
    sample->state = row.state;
    sample->displacement = row.displacement;
    sample->strain = row.strain;
    sample->velocity = v[m->rings.edge];
    sample->force = row.force;
    sample->focal_length = row.focal_length;
    sample->film_voltage = moment->voltage;
    if (m->film.port) {
        sample->current = dea_membrane_current(m, look, moment, v);
        sample->charge = look->capacitance * moment->voltage;
        sample->capacitance = row.capacitance;
    }
    return true;
}

/* The first sample of a run from rest, over a resistance that the network leaves out: the film has no charge yet. */
static bool sample_uncharged(const dea_membrane *m, const dea_moment *moment, dea_sample *sample)
{
    static const double none[DEA_RINGS_NODES] = {0.0};
    double still[DEA_RINGS_NODES];
    const dea_moment at = {.time = moment->time, .source = moment->source, .charging = true,
                           .charge_slope = moment->source / m->film.dropped};
    dea_membrane_look look;
    return dea_membrane_still(m, 0.0, still) && dea_membrane_look_at(m, still, &look) && fill_sample(m, &look, &at, still, none, sample);
}

bool dea_membrane_sample(const dea_membrane *m, const dea_membrane_look *look, const dea_moment *moment, const double *u,
                         const double *v, dea_sample *sample)
{
    const bool first = m->film.dropped > 0.0 && moment->time == 0.0 && !m->film.biased;
    return first ? sample_uncharged(m, moment, sample) : fill_sample(m, look, moment, u, v, sample);
}

/* ---- energies */

/* Power against nominal stresses f_a of the rings at stretches per time [W]. */
static double ring_power(const dea_membrane *m, double (*f)[2], double (*rates)[2])
{
    double sum = 0.0;
    for (size_t r = 0; r < m->ring_total; r++) {
        sum += dea_membrane_ring(m, r)->volume * (f[r][0] * rates[r][0] + f[r][1] * rates[r][1]);
    }
    return sum;
}

static double kinetic_energy(const dea_membrane *m, const double *v)
{
    double sum = 0.0;
    for (size_t i = 0; i < m->nodes && m->heavy; i++) {
        sum += 0.5 * m->masses[i] * v[i] * v[i];
    }
    return sum;
}

/* f_a = x_a/lambda_a. */
static void nominal_of(const dea_membrane *m, const dea_membrane_look *look, double (*x)[2])
{
    for (size_t r = 0; r < m->ring_total; r++) {
        x[r][0] /= look->rings[r].stretch[0];
        x[r][1] /= look->rings[r].stretch[1];
    }
}

void dea_membrane_audit_add(dea_audit *audit, const dea_membrane *m, const dea_membrane_look *look, const dea_moment *moment,
                            const double *v, const double *z, double weight)
{
    const dea_dynamics *d = &m->film;
    const double square = moment->voltage * moment->voltage;
    const bool series = d->series > 0.0;
    const dea_sheet_powers sheets = look->spread ? dea_sheet_powers_of(m, look, moment, v) : (dea_sheet_powers){0};
    const double leak = look->spread ? sheets.heat : square * d->conductance;
    const double fed = look->spread ? sheets.fed : 0.5 * capacitance_rate(m, look, v) * square + leak;
    const double flow = series ? dea_membrane_current(m, look, moment, v) : 0.0;
    double rates[DEA_MEMBRANE_RINGS][2], x[DEA_MEMBRANE_RINGS][2];
    dea_membrane_rates(m, v, rates);
    if (d->branch_count > 0) {
        dea_membrane_viscous(m, look, NULL, z, x);
        nominal_of(m, look, x);
        audit->branch += weight * ring_power(m, x, rates);
    }
    double ohmic = leak + flow * flow * d->series;
    if (d->retardation > 0.0 || m->second.retardation > 0.0) {
        dea_membrane_viscous(m, look, v, NULL, x);
        nominal_of(m, look, x);
        ohmic += ring_power(m, x, rates);
    }
    ohmic += d->damping * v[m->rings.edge] * v[m->rings.edge];
    audit->work += weight * (series ? moment->source * flow : fed);
    audit->dissipated += weight * ohmic;
    audit->largest = fmax(fmax(audit->largest, kinetic_energy(m, v)), fmax(fabs(audit->work), fabs(audit->dissipated)));
}

/* Work against the film, z NULL, or against its branches at z alone, along the straight way from u to @p to [J]. */
static double way_integral(const dea_membrane *m, const double *u, const double *to, const double *z)
{
    const size_t n = m->nodes;
    double sum = 0.0, way[DEA_RINGS_NODES], at[DEA_RINGS_NODES], rates[DEA_MEMBRANE_RINGS][2], f[DEA_MEMBRANE_RINGS][2];
    dea_membrane_look look;
    for (size_t i = 0; i < n; i++) {
        way[i] = to[i] - u[i];
    }
    dea_membrane_rates(m, way, rates);
    for (int g = 0; g < DEA_GAUSS_POINTS; g++) {
        for (size_t i = 0; i < n; i++) {
            at[i] = u[i] + dea_gauss_place(g) * way[i];
        }
        if (!dea_membrane_look_at(m, at, &look)) {
            return (double)NAN;
        }
        dea_membrane_viscous(m, &look, NULL, z, f);
        nominal_of(m, &look, f);
        for (size_t r = 0; r < m->ring_total && !z; r++) {
            dea_membrane_ring_stress(m, &look, r, 0.0, f[r]);
        }
        const double load = z ? 0.0 : dea_point_spring(&m->film.point, look.edge).force - m->film.point.force;
        sum += dea_gauss_weight(g) * (ring_power(m, f, rates) + load * way[m->rings.edge]);
    }
    return sum;
}

void dea_membrane_audit_jump(dea_audit *audit, const dea_membrane *m, const double *u, const double *to, const double *z)
{
    const double branch = m->film.branch_count > 0 ? way_integral(m, u, to, z) : 0.0;
    audit->branch += branch;
    audit->work += branch + way_integral(m, u, to, NULL);
    audit->largest = fmax(audit->largest, fabs(audit->work));
}

/* Springs of the branches: (1/2) f k^-1 f of the nominal stresses f_a = c_i (S_a - z_ai)/lambda_a that they hold, with the tangent
 * k_ab = c_i S_ab/lambda_a. */
static double spring_energy(const dea_membrane *m, const dea_membrane_look *look, const double *z)
{
    const size_t count = m->film.branch_count;
    double sum = 0.0;
    for (size_t r = 0; r < m->rings.ring_count; r++) {
        const dea_ring_look *at = &look->rings[r];
        const double det = at->slope[0][0] * at->slope[1][1] - at->slope[0][1] * at->slope[1][0];
        for (size_t i = 0; i < count; i++) {
            const double q1 = at->cauchy[0] - z[2 * r * count + i], q2 = at->cauchy[1] - z[(2 * r + 1) * count + i];
            const double e1 = (at->slope[1][1] * q1 - at->slope[0][1] * q2) / det; /* elongations of the spring */
            const double e2 = (at->slope[0][0] * q2 - at->slope[1][0] * q1) / det;
            sum += 0.5 * m->rings.rings[r].volume * m->film.branches[i].share * (q1 * e1 / at->stretch[0] + q2 * e2 / at->stretch[1]);
        }
    }
    return sum;
}

dea_membrane_energy dea_membrane_energy_of(const dea_membrane *m, double voltage, const double *u, const double *v, const double *z)
{
    static const double rest[DEA_RINGS_NODES] = {0.0};
    const double none = (double)NAN;
    dea_membrane_look look;
    if (!dea_membrane_look_at(m, u, &look)) {
        return (dea_membrane_energy){none, none, none, none, none};
    }
    const double electric = 0.5 * look.capacitance * voltage * voltage;
    return (dea_membrane_energy){.electric = electric,
                                 .fed = m->film.series > 0.0 ? 0.0 : electric,
                                 .elastic = way_integral(m, rest, u, NULL),
                                 .springs = m->film.branch_count > 0 ? spring_energy(m, &look, z) : 0.0,
                                 .kinetic = kinetic_energy(m, v)};
}

void dea_membrane_audit_close(const dea_audit *audit, const dea_membrane *m, const dea_membrane_energy *first,
                              const dea_membrane_energy *last, dea_summary *summary)
{
    const double springs = last->springs - first->springs;
    (void)m;
    summary->electric = last->electric - first->electric;
    summary->elastic = last->elastic - first->elastic + springs;
    summary->kinetic = last->kinetic - first->kinetic;
    summary->work = audit->work + last->fed - first->fed;
    summary->dissipated = audit->dissipated + audit->branch - springs;
    const double spent = summary->electric + summary->elastic + summary->kinetic + summary->dissipated;
    double largest = fmax(audit->largest, fabs(audit->branch));
    largest = fmax(largest, fmax(fabs(summary->elastic), fmax(first->electric, last->electric)));
    summary->residual = largest > 0.0 ? fabs(summary->work - spent) / largest : 0.0;
}
