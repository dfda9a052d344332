#include "network/sheet.h"

#include <math.h>
#include <string.h>

/* Ring of place n. */
static size_t ring_of(const dea_sheet *s, size_t n)
{
    return s->first + n;
}

static size_t rim_of(const dea_sheet *s)
{
    return s->places - 1;
}

void dea_sheet_look(const dea_membrane *m, dea_membrane_look *look, const double *q, double source, dea_charges *c)
{
    const dea_sheet *s = &m->sheet;
    double sum = 0.0;
    look->spread = s->places > 0;
    if (!look->spread) {
        c->capacitances[0] = look->capacitance;
        c->voltage = c->voltages[0] = s->charges > 0 ? q[0] / look->capacitance : source;
        return;
    }
    for (size_t n = 0; n < s->places; n++) {
        c->capacitances[n] = look->rings[ring_of(s, n)].capacitance;
        c->voltages[n] = n < s->charges ? q[n] / c->capacitances[n] : source;
        look->voltages[ring_of(s, n)] = c->voltages[n];
        sum += c->capacitances[n] * c->voltages[n];
    }
    c->voltage = sum / look->capacitance;
}

/* 2 pi R dR/rho lambda_2/lambda_1 of a place [S m^2]. */
static double conductance_at(const dea_membrane *m, const dea_membrane_look *look, size_t n)
{
    const double *l = look->rings[ring_of(&m->sheet, n)].stretch;
    return m->sheet.conductance[n] * l[1] / l[0];
}

/* dV/dR at a place [V/m]. */
static double gradient_at(const dea_membrane *m, const dea_membrane_look *look, size_t n)
{
    double sum = 0.0;
    for (size_t i = 0; i < m->sheet.places; i++) {
        sum += m->sheet.gradient[n][i] * look->voltages[ring_of(&m->sheet, i)];
    }
    return sum;
}

/* L V + g V of all places: what leaves each through sheets and leakage [A]. */
static void losses(const dea_membrane *m, const dea_membrane_look *look, double *out)
{
    const dea_sheet *s = &m->sheet;
    for (size_t n = 0; n < s->places; n++) {
        out[n] = s->leak[n] * look->voltages[ring_of(s, n)];
    }
    for (size_t i = 0; i < s->places; i++) {
        const double flux = conductance_at(m, look, i) * gradient_at(m, look, i);
        for (size_t n = 0; n < s->places; n++) {
            out[n] += s->gradient[i][n] * flux;
        }
    }
}

void dea_sheet_flows(const dea_membrane *m, const dea_membrane_look *look, const dea_charges *c, double source, double *flows)
{
    const dea_sheet *s = &m->sheet;
    double out[DEA_SHEET_PLACES] = {c->voltages[0] * m->film.conductance};
    const size_t rim = s->places > 0 ? rim_of(s) : 0;
    if (s->places > 0) {
        losses(m, look, out);
    }
    for (size_t k = 0; k < s->charges; k++) {
        flows[k] = (k == rim ? (source - c->voltages[k]) / m->film.series : 0.0) - out[k];
    }
}

void dea_sheet_admittance(const dea_membrane *m, const dea_membrane_look *look, double *y)
{
    const dea_sheet *s = &m->sheet;
    const size_t count = s->charges, rim = s->places > 0 ? rim_of(s) : 0;
    memset(y, 0, count * count * sizeof *y);
    for (size_t i = 0; i < s->places; i++) {
        const double own = conductance_at(m, look, i);
        for (size_t n = 0; n < count; n++) {
            for (size_t k = 0; k < count; k++) {
                y[n * count + k] += own * s->gradient[i][n] * s->gradient[i][k];
            }
        }
    }
    for (size_t n = 0; n < count; n++) {
        y[n * (count + 1)] += (s->places > 0 ? s->leak[n] : m->film.conductance) + (n == rim ? 1.0 / m->film.series : 0.0);
    }
}

void dea_sheet_push(const dea_membrane *m, const dea_membrane_look *look, size_t k, double *push)
{
    if (m->sheet.places > 0) {
        dea_membrane_push_ring(m, look, ring_of(&m->sheet, k), push);
    } else {
        dea_membrane_push(m, look, push);
    }
}

/* dC/dt of the rim [F/s]. */
static double rim_rate(const dea_membrane *m, const dea_membrane_look *look, const double *v)
{
    double push[DEA_RINGS_NODES], sum = 0.0;
    dea_sheet_push(m, look, rim_of(&m->sheet), push);
    for (size_t i = 0; i < m->nodes; i++) {
        sum += 2.0 * push[i] * v[i];
    }
    return sum;
}

static bool is_fed(const dea_membrane *m, const dea_membrane_look *look)
{
    return look->spread && !(m->film.series > 0.0);
}

double dea_sheet_rim_current(const dea_membrane *m, const dea_membrane_look *look, double source, double slope, const double *v)
{
    const size_t rim = is_fed(m, look) ? ring_of(&m->sheet, rim_of(&m->sheet)) : 0;
    return is_fed(m, look) ? look->rings[rim].capacitance * slope + rim_rate(m, look, v) * source : 0.0;
}

double dea_sheet_through(const dea_membrane *m, const dea_membrane_look *look)
{
    double out[DEA_SHEET_PLACES];
    if (!is_fed(m, look)) {
        return 0.0;
    }
    losses(m, look, out);
    return out[rim_of(&m->sheet)];
}

double dea_sheet_rim_voltage(const dea_membrane *m, const dea_membrane_look *look, double voltage)
{
    return look->spread ? look->voltages[ring_of(&m->sheet, rim_of(&m->sheet))] : voltage;
}

double dea_sheet_leakage(const dea_membrane *m, const dea_membrane_look *look, double voltage)
{
    double sum = look->spread ? 0.0 : voltage * m->film.conductance;
    for (size_t n = 0; n < m->sheet.places && look->spread; n++) {
        sum += m->sheet.leak[n] * look->voltages[ring_of(&m->sheet, n)];
    }
    return sum;
}

dea_sheet_powers dea_sheet_powers_of(const dea_membrane *m, const dea_membrane_look *look, const dea_moment *moment, const double *v)
{
    const dea_sheet *s = &m->sheet;
    const double rim = look->voltages[ring_of(s, rim_of(s))], leakage = dea_sheet_leakage(m, look, 0.0);
    dea_sheet_powers powers = {.heat = moment->charge_slopes ? rim * leakage : 0.0};
    for (size_t n = 0; n < s->places; n++) {
        const double voltage = look->voltages[ring_of(s, n)];
        if (!moment->charge_slopes) {
            const double gradient = gradient_at(m, look, n);
            powers.heat += s->leak[n] * voltage * voltage + conductance_at(m, look, n) * gradient * gradient;
        } else if (n < s->charges) {
            powers.heat += (rim - voltage) * moment->charge_slopes[n];
        }
    }
    const double through = moment->charging ? moment->charge_slope + leakage : dea_sheet_through(m, look);
    powers.fed = moment->source * (through + 0.5 * dea_sheet_rim_current(m, look, moment->source, 0.0, v));
    return powers;
}

double dea_sheet_energy(const dea_membrane *m, const dea_charges *c)
{
    double sum = 0.0;
    for (size_t k = 0; k < m->sheet.charges; k++) {
        sum += 0.5 * c->capacitances[k] * c->voltages[k] * c->voltages[k];
    }
    return sum;
}

/* Gershgorin's bound of C^-1 Y. */
double dea_sheet_fastest(const dea_membrane *m, const dea_membrane_look *look)
{
    double y[DEA_SHEET_PLACES * DEA_SHEET_PLACES], fastest = 0.0;
    const size_t count = m->sheet.charges;
    dea_sheet_admittance(m, look, y);
    for (size_t n = 0; n < count; n++) {
        const double own = m->sheet.places > 0 ? look->rings[ring_of(&m->sheet, n)].capacitance : look->capacitance;
        double sum = 0.0;
        for (size_t k = 0; k < count; k++) {
            sum += fabs(y[n * count + k]);
        }
        fastest = fmax(fastest, sum / own);
    }
    return fastest;
}
