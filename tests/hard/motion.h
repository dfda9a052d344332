/* A film in motion in long double, straight from physics.md, section 5:
 *
 *   - any network by Radau IIA (three stages, order 5) on a fixed mesh that is graded behind every edge, on two meshes;
 *   - many or very unlike branches without mass, damper and series resistance by product integration, extrapolated;
 *   - an undamped linear ring and a frequency response by their closed forms. */
#ifndef DEA_HARD_MOTION_H
#define DEA_HARD_MOTION_H

#include <complex.h>
#include <stdlib.h>

#include "film.h"

enum { HARD_MOST_STATES = 12, HARD_MOST_EDGES = 64 };

typedef struct hard_motion {
    const dea_scene *scene;
    hard_film film;
    long double mass, retardation, series, conductance;
    long double c[DEA_PRONY_MAX], tau[DEA_PRONY_MAX]; /* branches: shares of the long-term stress, times */
    size_t branches;
    long double edges[HARD_MOST_EDGES]; /* times at which the voltage breaks off, 0 and the end among them */
    size_t edge_count;
    size_t states; /* u, v where there is mass; u with a damper alone; then z; then q with series resistance */
    bool heavy, damped;
} hard_motion;

/* What a sample is compared with. */
typedef struct hard_sample {
    long double u, charge, current;
} hard_sample;

static inline long double hard_points(const dea_waveform *w, long double t, bool behind)
{
    size_t i = 0;
    while (i < w->point_count && (behind ? w->times[i] <= t : w->times[i] < t)) {
        i++;
    }
    if (i == 0 || i == w->point_count) {
        return w->voltages[i == 0 ? 0 : i - 1];
    }
    const long double width = (long double)w->times[i] - w->times[i - 1];
    return w->voltages[i - 1] + ((long double)w->voltages[i] - w->voltages[i - 1]) * (t - w->times[i - 1]) / width;
}

/* Source voltage before or behind an edge at t. */
static inline long double hard_source(const hard_motion *m, long double t, bool behind)
{
    const dea_waveform *w = &m->scene->drive.waveform;
    if (w->kind == DEA_WAVE_SINE) {
        const long double age = fmaxl(0.0L, t - w->sine.delay);
        return w->sine.offset + w->sine.amplitude * sinl(2.0L * hard_pi * w->sine.frequency * age + w->sine.phase);
    }
    if (w->kind == DEA_WAVE_POINTS) {
        return hard_points(w, t, behind);
    }
    const dea_step *s = &w->step;
    const long double on = s->on, off = isnan(s->off) ? INFINITY : (long double)s->off, rise = s->rise;
    const bool past_on = behind ? t >= on : t > on, past_off = behind ? t >= off : t > off;
    const long double up = !past_on ? 0.0L : t >= on + rise ? 1.0L : (t - on) / rise;
    const long double down = !past_off ? 0.0L : t >= off + rise ? 1.0L : (t - off) / rise;
    return s->voltage * (up - down);
}

static inline int hard_compare(const void *a, const void *b)
{
    const long double x = *(const long double *)a, y = *(const long double *)b;
    return (x > y) - (x < y);
}

static inline void hard_find_edges(hard_motion *m)
{
    const dea_waveform *w = &m->scene->drive.waveform;
    const long double until = m->scene->transient.until;
    long double all[HARD_MOST_EDGES] = {0.0L, until};
    size_t count = 2;
    if (w->kind == DEA_WAVE_STEP) {
        all[count++] = w->step.on;
        all[count++] = (long double)w->step.on + w->step.rise;
        all[count++] = isnan(w->step.off) ? until : (long double)w->step.off;
        all[count++] = isnan(w->step.off) ? until : (long double)w->step.off + w->step.rise;
    }
    for (size_t i = 0; w->kind == DEA_WAVE_POINTS && i < w->point_count && count < HARD_MOST_EDGES; i++) {
        all[count++] = w->times[i];
    }
    qsort(all, count, sizeof *all, hard_compare);
    for (size_t i = 0; i < count; i++) {
        if (all[i] <= until && (m->edge_count == 0 || all[i] > m->edges[m->edge_count - 1])) {
            m->edges[m->edge_count++] = all[i];
        }
    }
}

static inline hard_motion hard_motion_of(const dea_scene *scene, const dea_model *model)
{
    const dea_material *material = &scene->material;
    hard_motion m = {.scene = scene, .film = hard_film_of(scene, model), .branches = material->prony_count};
    long double rest = 1.0L;
    for (size_t i = 0; i < m.branches; i++) {
        rest -= material->prony[i].g;
    }
    for (size_t i = 0; i < m.branches; i++) {
        m.c[i] = material->prony[i].g / rest;
        m.tau[i] = material->prony[i].tau;
    }
    m.mass = hard_mass(scene, &m.film);
    m.retardation = isnan(material->retardation) ? 0.0L : (long double)material->retardation;
    m.series = isnan(scene->drive.series_resistance) ? 0.0L : (long double)scene->drive.series_resistance;
    m.conductance = isnan(scene->drive.leakage_resistance) ? 0.0L : 1.0L / scene->drive.leakage_resistance;
    m.heavy = m.mass > 0.0L;
    m.damped = m.retardation > 0.0L;
    m.states = (m.heavy ? 2 : m.damped ? 1 : 0) + m.branches + (m.series > 0.0L ? 1 : 0);
    if (scene->study == DEA_STUDY_TRANSIENT) {
        hard_find_edges(&m);
    }
    return m;
}

/* ---- any network */

/* Everything at one state; without mass and damper u is found from the balance of forces, near *u. */
typedef struct hard_place {
    long double u, v, voltage, force, resistance;
    hard_edge edge;
} hard_place;

static inline long double hard_force(const hard_motion *m, const long double *z, long double fixed, long double charge,
                                     long double u, hard_place *at)
{
    at->edge = hard_edge_at(&m->film, u);
    at->voltage = m->series > 0.0L ? charge / at->edge.capacitance : fixed;
    long double stress = at->edge.stress;
    for (size_t i = 0; i < m->branches; i++) {
        stress += m->c[i] * (at->edge.stress - z[i]);
    }
    return at->edge.push * at->voltage * at->voltage - at->edge.area * stress;
}

static inline hard_place hard_look(const hard_motion *m, long double t, bool behind, const long double *y, long double near)
{
    const size_t first = m->heavy ? 2 : m->damped ? 1 : 0;
    const long double fixed = hard_source(m, t, behind), charge = m->series > 0.0L ? y[m->states - 1] : 0.0L;
    hard_place at = {.u = first > 0 ? y[0] : near, .v = m->heavy ? y[1] : 0.0L};
    for (int i = 0; i < 40 && first == 0; i++) {
        const long double h = 1e-6L * fminl(m->film.edge, m->film.frame - m->film.edge);
        const long double here = hard_force(m, y, fixed, charge, at.u, &at);
        const long double slope =
            (hard_force(m, y, fixed, charge, at.u + h, &at) - hard_force(m, y, fixed, charge, at.u - h, &at)) / (2.0L * h);
        at.u -= here / slope;
        if (fabsl(here / slope) <= 1e-19L * fabsl(at.u)) {
            break;
        }
    }
    at.force = hard_force(m, y + first, fixed, charge, at.u, &at);
    if (m->damped) {
        at.resistance = at.edge.area * m->retardation * hard_edge_slope(&m->film, at.u).stress;
        at.v = m->heavy ? at.v : at.force / at.resistance;
    }
    return at;
}

/* Rates at a time behind the begin of a segment, up to its end. */
static inline void hard_rates(const hard_motion *m, long double t, const long double *y, long double near, long double *f)
{
    const hard_place at = hard_look(m, t, false, y, near);
    size_t n = 0;
    if (m->heavy) {
        f[n++] = at.v;
        f[n++] = (at.force - at.resistance * at.v) / m->mass;
    } else if (m->damped) {
        f[n++] = at.v;
    }
    for (size_t i = 0; i < m->branches; i++, n++) {
        f[n] = (at.edge.stress - y[n]) / m->tau[i];
    }
    if (m->series > 0.0L) {
        f[n] = (hard_source(m, t, false) - at.voltage) / m->series - at.voltage * m->conductance;
    }
}

/* Solves a x = b by elimination; a is lost. */
static inline void hard_solve(size_t n, long double a[][3 * HARD_MOST_STATES], long double *b)
{
    for (size_t k = 0; k < n; k++) {
        size_t best = k;
        for (size_t i = k + 1; i < n; i++) {
            best = fabsl(a[i][k]) > fabsl(a[best][k]) ? i : best;
        }
        for (size_t j = 0; j < n; j++) {
            const long double swap = a[k][j];
            a[k][j] = a[best][j], a[best][j] = swap;
        }
        const long double swap = b[k];
        b[k] = b[best], b[best] = swap;
        for (size_t i = k + 1; i < n; i++) {
            const long double factor = a[i][k] / a[k][k];
            for (size_t j = k; factor != 0.0L && j < n; j++) {
                a[i][j] -= factor * a[k][j];
            }
            b[i] -= factor * b[k];
        }
    }
    for (size_t k = n; k-- > 0;) {
        for (size_t j = k + 1; j < n; j++) {
            b[k] -= a[k][j] * b[j];
        }
        b[k] /= a[k][k];
    }
}

/* One step of Radau IIA by Newton's method on its three stages. */
static inline void hard_radau_step(const hard_motion *m, long double t, long double h, long double *y, const long double *size,
                                   long double near)
{
    const long double r = sqrtl(6.0L);
    const long double at[] = {(4.0L - r) / 10.0L, (4.0L + r) / 10.0L, 1.0L};
    const long double a[3][3] = {{(88.0L - 7.0L * r) / 360.0L, (296.0L - 169.0L * r) / 1800.0L, (-2.0L + 3.0L * r) / 225.0L},
                                 {(296.0L + 169.0L * r) / 1800.0L, (88.0L + 7.0L * r) / 360.0L, (-2.0L - 3.0L * r) / 225.0L},
                                 {(16.0L - r) / 36.0L, (16.0L + r) / 36.0L, 1.0L / 9.0L}};
    const size_t n = m->states;
    long double jacobian[HARD_MOST_STATES][HARD_MOST_STATES], stage[3][HARD_MOST_STATES], f[3][HARD_MOST_STATES];
    static long double matrix[3 * HARD_MOST_STATES][3 * HARD_MOST_STATES];
    for (size_t k = 0; k < n; k++) {
        long double there[HARD_MOST_STATES], low[HARD_MOST_STATES], high[HARD_MOST_STATES];
        const long double d = 1e-6L * size[k];
        memcpy(there, y, n * sizeof *y);
        there[k] = y[k] + d;
        hard_rates(m, t + h, there, near, high);
        there[k] = y[k] - d;
        hard_rates(m, t + h, there, near, low);
        for (size_t i = 0; i < n; i++) {
            jacobian[i][k] = (high[i] - low[i]) / (2.0L * d) * size[k] / size[i];
        }
    }
    for (int s = 0; s < 3; s++) {
        memcpy(stage[s], y, n * sizeof *y);
    }
    long double last = INFINITY;
    for (int round = 0; round < 60; round++) {
        long double miss[3 * HARD_MOST_STATES], change = 0.0L;
        for (int s = 0; s < 3; s++) {
            hard_rates(m, t + at[s] * h, stage[s], near, f[s]);
        }
        for (int s = 0; s < 3; s++) {
            for (size_t i = 0; i < n; i++) {
                const size_t row = (size_t)s * n + i;
                miss[row] = (y[i] - stage[s][i] + h * (a[s][0] * f[0][i] + a[s][1] * f[1][i] + a[s][2] * f[2][i])) / size[i];
                for (size_t j = 0; j < 3 * n; j++) {
                    matrix[row][j] = (row == j ? 1.0L : 0.0L) - h * a[s][j / n] * jacobian[i][j % n];
                }
            }
        }
        hard_solve(3 * n, matrix, miss);
        for (int s = 0; s < 3; s++) {
            for (size_t i = 0; i < n; i++) {
                stage[s][i] += miss[(size_t)s * n + i] * size[i];
                change = fmaxl(change, fabsl(miss[(size_t)s * n + i]));
            }
        }
        if (change < 1e-17L || (round > 2 && change < 1e-12L && change >= 0.5L * last)) {
            break;
        }
        last = change;
    }
    memcpy(y, stage[2], n * sizeof *y);
}

/* Current of the source: through R_s, or d(C U)/dt and the leakage, its jumps left out. */
static inline hard_sample hard_sample_at(const hard_motion *m, long double t, bool behind, const long double *y,
                                         long double *near)
{
    const hard_place at = hard_look(m, t, behind, y, *near);
    const long double source = hard_source(m, t, behind);
    *near = at.u;
    return (hard_sample){at.u, at.edge.capacitance * at.voltage,
                         m->series > 0.0L ? (source - at.voltage) / m->series : (long double)NAN};
}

/* Sizes of the states: what the largest voltage would make of them. */
static inline void hard_sizes(const hard_motion *m, long double largest, long double *size)
{
    const hard_edge rest = hard_edge_at(&m->film, 0.0L), slope = hard_edge_slope(&m->film, 0.0L);
    const long double stiffness = rest.area * slope.stress;
    const long double u =
        fminl(fabsl(rest.push) * largest * largest / stiffness, 0.1L * fminl(m->film.edge, m->film.frame - m->film.edge));
    size_t n = 0;
    if (m->heavy || m->damped) {
        size[n++] = u;
    }
    if (m->heavy) {
        size[n++] = u * sqrtl(stiffness / m->mass);
    }
    for (size_t i = 0; i < m->branches; i++) {
        size[n++] = slope.stress * u;
    }
    if (m->series > 0.0L) {
        size[n] = rest.capacitance * largest;
    }
}

/* Shortest time of the network, and the longest step that follows its ring and its source [s]. */
static inline long double hard_shortest(const hard_motion *m, long double *longest)
{
    const hard_edge rest = hard_edge_at(&m->film, 0.0L), slope = hard_edge_slope(&m->film, 0.0L);
    long double held = 1.0L;
    for (size_t i = 0; i < m->branches; i++) {
        held += m->c[i];
    }
    long double shortest = INFINITY;
    *longest = INFINITY;
    if (m->heavy) {
        shortest = 1.0L / sqrtl(held * rest.area * slope.stress / m->mass);
        const bool rings = m->retardation < 2.0L * shortest;
        *longest = rings ? 0.12L * shortest : (long double)INFINITY;
        shortest = rings ? shortest : m->mass / (rest.area * m->retardation * slope.stress);
    }
    shortest = m->damped && !m->heavy ? fminl(shortest, m->retardation) : shortest;
    for (size_t i = 0; i < m->branches; i++) {
        shortest = fminl(shortest, m->tau[i]);
    }
    shortest = m->series > 0.0L ? fminl(shortest, m->series * rest.capacitance) : shortest;
    if (m->scene->drive.waveform.kind == DEA_WAVE_SINE) {
        *longest = fminl(*longest, 0.02L / m->scene->drive.waveform.sine.frequency);
    }
    return shortest;
}

/* All samples, with every step of one mesh cut into @p parts. */
static inline void hard_radau(const hard_motion *m, int parts, size_t rows, hard_sample *samples)
{
    long double y[HARD_MOST_STATES] = {0.0L}, size[HARD_MOST_STATES], longest, near = 0.0L, largest = 0.0L;
    const long double shortest = hard_shortest(m, &longest);
    for (size_t i = 0; i < m->edge_count; i++) {
        largest = fmaxl(largest, fmaxl(fabsl(hard_source(m, m->edges[i], true)), fabsl(hard_source(m, m->edges[i], false))));
    }
    if (m->scene->drive.waveform.kind == DEA_WAVE_SINE) {
        largest = fabsl((long double)m->scene->drive.waveform.sine.offset) +
                  fabsl((long double)m->scene->drive.waveform.sine.amplitude);
    }
    hard_sizes(m, fmaxl(largest, 1e-3L), size);
    samples[0] = hard_sample_at(m, 0.0L, true, y, &near);
    size_t row = 1;
    for (size_t i = 0; i + 1 < m->edge_count; i++) {
        const long double from = m->edges[i], to = m->edges[i + 1];
        long double t = 0.0L; /* since the edge: a short segment late in a run keeps its digits */
        while (t < to - from) {
            const long double next = row < rows ? dea_layout_place(m->scene, row) - from : INFINITY;
            const long double stop = fminl(next, to - from);
            const long double h = fminl(fminl(longest, 0.03L * shortest + 0.2L * t), stop - t);
            const bool reached = h >= stop - t;
            for (int part = 0; part < parts; part++) {
                hard_radau_step(m, from + t + h * part / parts, h / parts, y, size, near);
            }
            t = reached ? stop : t + h;
            if (reached && stop == next) {
                samples[row] = hard_sample_at(m, from + stop, false, y, &near);
                row++;
            }
        }
    }
}

/* ---- many branches without mass, damper and series resistance: S is taken as a straight line over each step in
 *
 *   z(t + h) = e^-x z + (S_0 (1 - e^-x) + (S_1 - S_0) (1 - (1 - e^-x)/x)),   x = h/tau,
 *
 * which leaves one equation for u in every step; steps grow with the age of the edge; error of second order in them */

/* u that balances stress against the voltage: S(u) (1 + sum c) - sum c z = phi U^2/A, with z = past + share S. */
static inline long double hard_creep_balance(const hard_motion *m, const long double *past, const long double *share,
                                             long double voltage, long double u)
{
    for (int i = 0; i < 60; i++) {
        const hard_edge e = hard_edge_at(&m->film, u), slope = hard_edge_slope(&m->film, u);
        long double left = e.stress, held = 1.0L;
        for (size_t k = 0; k < m->branches; k++) {
            left += m->c[k] * (e.stress - past[k] - share[k] * e.stress);
            held += m->c[k] * (1.0L - share[k]);
        }
        const long double load = e.push * voltage * voltage / e.area;
        const long double load_slope = (slope.push - e.push * slope.area / e.area) * voltage * voltage / e.area;
        const long double step = (left - load) / (held * slope.stress - load_slope);
        u -= step;
        if (fabsl(step) <= 1e-18L * fabsl(u)) {
            break;
        }
    }
    return u;
}

/* One step from behind t to before t + h; u stays that before the end. */
static inline void hard_creep_step(const hard_motion *m, long double t, long double h, long double *z, long double *u)
{
    long double past[DEA_PRONY_MAX], share[DEA_PRONY_MAX];
    const long double before = hard_edge_at(&m->film, *u).stress;
    for (size_t k = 0; k < m->branches; k++) {
        const long double x = h / m->tau[k], decayed = -expm1l(-x);
        const long double mean = x < 1e-6L ? 0.5L * x - x * x / 6.0L : 1.0L - decayed / x;
        past[k] = (1.0L - decayed) * z[k] + before * (decayed - mean);
        share[k] = mean;
    }
    *u = hard_creep_balance(m, past, share, hard_source(m, t + h, false), *u);
    const long double after = hard_edge_at(&m->film, *u).stress;
    for (size_t k = 0; k < m->branches; k++) {
        z[k] = past[k] + share[k] * after;
    }
}

/* All samples, with every step of one mesh cut into @p parts. */
static inline void hard_creep_run(const hard_motion *m, int parts, size_t rows, hard_sample *samples)
{
    const long double none[DEA_PRONY_MAX] = {0.0L};
    long double z[DEA_PRONY_MAX] = {0.0L}, longest, u = 0.0L;
    const long double shortest = hard_shortest(m, &longest);
    u = hard_creep_balance(m, z, none, hard_source(m, 0.0L, true), u);
    samples[0].u = u;
    size_t row = 1;
    for (size_t i = 0; i + 1 < m->edge_count; i++) {
        const long double from = m->edges[i], to = m->edges[i + 1];
        long double t = 0.0L;
        u = hard_creep_balance(m, z, none, hard_source(m, from, true), u);
        while (t < to - from) {
            const long double next = row < rows ? dea_layout_place(m->scene, row) - from : INFINITY;
            const long double stop = fminl(next, to - from);
            const long double h = fminl(fminl(longest, 0.1L * (t + shortest)), stop - t);
            const bool reached = h >= stop - t;
            for (int part = 0; part < parts; part++) {
                hard_creep_step(m, from + t + h * part / parts, h / parts, z, &u);
            }
            t = reached ? stop : t + h;
            if (reached && stop == next) {
                samples[row++].u = u;
            }
        }
    }
}

/* ---- frequency responses, section 5: displacement and input impedance per volt of the source, about an equilibrium */

typedef struct hard_response {
    long double complex displacement, impedance;
} hard_response;

static inline hard_response hard_respond(const hard_motion *m, long double bias, long double u, long double frequency)
{
    const long double omega = 2.0L * hard_pi * frequency, film = bias / (1.0L + m->series * m->conductance);
    const hard_edge e = hard_edge_at(&m->film, u), slope = hard_edge_slope(&m->film, u);
    const long double spring = e.area * slope.stress;
    long double complex dynamic =
        spring + slope.area * e.stress - slope.push * film * film - m->mass * omega * omega + I * omega * m->retardation * spring;
    for (size_t i = 0; i < m->branches; i++) {
        const long double x = omega * m->tau[i]; /* i x/(1 + i x) */
        dynamic += spring * m->c[i] * (x * x + I * x) / (1.0L + x * x);
    }
    const long double complex gain = 2.0L * e.push * film / dynamic;
    const long double complex current = I * omega * (e.capacitance + slope.capacitance * film * gain) + m->conductance;
    const long double complex source = 1.0L + m->series * current;
    return (hard_response){gain / source, source / current};
}

#endif
