/* Transients by collocation (Radau IIA, six stages, order 11) in long double, steps controlled by halving; solved twice, the
 * second time a thousand times tighter, so that the difference bounds the error. Branches are eliminated from the equations of a
 * step: with the stages' stress S, Z = (1 + h/tau A)^-1 (z + h/tau A S). */
#include <math.h>
#include <stddef.h>
#include <stdlib.h>
#include <string.h>

#include "drive/signal.h"
#include "radau.h"
#include "radial.h"
#include "truths.h"

enum { UNKNOWNS = STAGE_UNKNOWNS, NEWTON = 20 };

static const double most_steps = 60000.0;
static const long double nearly = 0.02L; /* share of what is there at rest below which it counts as lost */

typedef struct state {
    long double u, v, w, q; /* displacement, velocity, film voltage, charge */
    long double z[TRUE_STRESSES][DEA_PRONY_MAX];
    long double area; /* int u dt from the begin of the run [m s] */
} state;

typedef struct motion {
    true_film film;
    dea_signal signal;
    const dea_segment *segment;
    const dea_scene *scene;
    method radau;
    long double factor;  /* of the source voltage */
    long double size[3]; /* of u, v, w */
    long double tolerance;
    long double largest_u, largest_v;
    dea_sample *samples;
    size_t rows, done;
    long double edges[DEA_WINDOWS][2]; /* areas at the edges of the windows, NAN before they are passed [m s] */
    double steps;
    const char *why;
    bool gone; /* pulled in */
} motion;

/* ---- one step */

static long double source_at(const motion *m, long double time)
{
    return m->factor * true_source(&m->signal, m->segment, time);
}

static long double source_slope(const motion *m, long double time)
{
    return m->factor * true_source_slope(&m->signal, m->segment, time);
}

/* What Newton's method works on: changes of u from the begin of the step, film voltages, and what follows from them. */
typedef struct stages {
    long double change[STAGES], volts[STAGES], source[STAGES];
    long double z[TRUE_STRESSES][DEA_PRONY_MAX][STAGES], v[STAGES], a[STAGES];
    true_edge edge[STAGES];
} stages;

static void follow_stages(const motion *m, const state *from, long double h, const lag *lags, stages *s)
{
    const true_film *f = &m->film;
    for (int i = 0; i < STAGES; i++) {
        s->edge[i] = film_edge(f, from->u + s->change[i]);
        s->v[i] = 0.0L;
        for (int j = 0; j < STAGES; j++) {
            s->v[i] += m->radau.slope.at[i][j] * s->change[j] / h;
        }
    }
    for (int i = 0; i < STAGES; i++) {
        s->a[i] = 0.0L;
        for (int j = 0; j < STAGES; j++) {
            s->a[i] += m->radau.slope.at[i][j] * (s->v[j] - from->v) / h;
        }
        for (int k = 0; k < s->edge[0].count; k++) {
            for (size_t b = 0; b < f->branches; b++) {
                s->z[k][b][i] = 0.0L;
                for (int j = 0; j < STAGES; j++) {
                    s->z[k][b][i] += lags[b].rest.at[i][j] * from->z[k][b] + lags[b].gain.at[i][j] * s->edge[j].stress[k].value;
                }
            }
        }
    }
}

static long double held_stress(const true_film *f, const stages *s, int i, int k)
{
    const long double stress = s->edge[i].stress[k].value;
    long double sum = stress;
    for (size_t b = 0; b < f->branches; b++) {
        sum += f->share[b] * (stress - s->z[k][b][i]);
    }
    return sum;
}

/* What a stress adds to a residual and its derivatives. */
static void add_stress(const motion *m, long double h, const lag *lags, const stages *s, int i, int k,
                       long double a[UNKNOWNS][UNKNOWNS], long double *r)
{
    const true_film *f = &m->film;
    const jet *area = &s->edge[i].area[k], *stress = &s->edge[i].stress[k];
    const long double damp = f->retardation, force = held_stress(f, s, i, k) + damp * stress->slope * s->v[i];
    r[i] += area->value * force;
    for (int j = 0; j < STAGES; j++) {
        long double branch = 0.0L;
        for (size_t b = 0; b < f->branches; b++) {
            branch += f->share[b] * lags[b].gain.at[i][j];
        }
        a[i][j] +=
            area->value * damp * stress->slope * m->radau.slope.at[i][j] / h - area->value * branch * s->edge[j].stress[k].slope;
    }
    a[i][i] += area->slope * force + area->value * (1.0L + f->total_share) * stress->slope +
               area->value * damp * stress->curve * s->v[i];
}

/* Residuals and their derivatives; the unknowns are the changes, then the film voltages. */
static void equations(const motion *m, const state *from, long double h, const lag *lags, const stages *s,
                      long double a[UNKNOWNS][UNKNOWNS], long double *r)
{
    const true_film *f = &m->film;
    const bool series = f->series > 0.0L;
    const square *d = &m->radau.slope;
    for (int i = 0; i < STAGES; i++) {
        const true_edge *e = &s->edge[i];
        const long double w = s->volts[i];
        r[i] = f->mass * s->a[i] + f->load_damping * s->v[i] + e->tension.value - e->push.value * w * w;
        for (int j = 0; j < STAGES; j++) {
            long double inertia = 0.0L;
            for (int k = 0; k < STAGES; k++) {
                inertia += d->at[i][k] * d->at[k][j];
            }
            a[i][j] = f->mass * inertia / (h * h) + f->load_damping * d->at[i][j] / h;
        }
        a[i][i] += e->tension.slope - e->push.slope * w * w;
        for (int k = 0; k < e->count; k++) {
            add_stress(m, h, lags, s, i, k, a, r);
        }
        if (series) {
            const int row = STAGES + i;
            a[i][row] = -2.0L * e->push.value * w;
            r[row] = w * (1.0L + f->series * f->conductance) - s->source[i];
            for (int j = 0; j < STAGES; j++) {
                const true_edge *o = &s->edge[j];
                r[row] += f->series * d->at[i][j] / h * (o->capacitance * s->volts[j] - from->q);
                a[row][j] = f->series * d->at[i][j] / h * 2.0L * o->push.value * s->volts[j];
                a[row][STAGES + j] = f->series * d->at[i][j] / h * o->capacitance;
            }
            a[row][row] += 1.0L + f->series * f->conductance;
        }
    }
}

/* Rows and columns in units of the run, so that pivots compare. */
static void balance_rows(int n, const motion *m, long double a[UNKNOWNS][UNKNOWNS], long double *r)
{
    for (int i = 0; i < n; i++) {
        long double largest = 0.0L;
        for (int j = 0; j < n; j++) {
            a[i][j] *= j < STAGES ? m->size[0] : m->size[2];
            largest = fmaxl(largest, fabsl(a[i][j]));
        }
        for (int j = 0; j < n && largest > 0.0L; j++) {
            a[i][j] /= largest;
        }
        r[i] = largest > 0.0L ? r[i] / largest : r[i];
    }
}

static bool newton(const motion *m, const state *from, long double h, const lag *lags, stages *s)
{
    const int n = m->film.series > 0.0L ? UNKNOWNS : STAGES;
    long double last = (long double)INFINITY;
    for (int i = 0; i < NEWTON; i++) {
        long double a[UNKNOWNS][UNKNOWNS] = {{0.0L}}, r[UNKNOWNS], most = 0.0L;
        follow_stages(m, from, h, lags, s);
        equations(m, from, h, lags, s, a, r);
        balance_rows(n, m, a, r);
        if (!dense_solve(n, a, r)) {
            return false;
        }
        for (int k = 0; k < n; k++) {
            *(k < STAGES ? &s->change[k] : &s->volts[k - STAGES]) -= r[k] * (k < STAGES ? m->size[0] : m->size[2]);
            most = fmaxl(most, fabsl(r[k]));
        }
        if (!(most < 1e3L)) {
            return false;
        }
        if (most <= 1e-19L || (most < 1e-15L && most >= 0.3L * last)) {
            follow_stages(m, from, h, lags, s);
            return true;
        }
        last = most;
    }
    return false;
}

/* From a state, a time behind the begin of the segment; false where there is no solution. */
static bool step_by(const motion *m, const state *from, long double time, long double h, state *to)
{
    const true_film *f = &m->film;
    lag lags[DEA_PRONY_MAX];
    stages s;
    for (size_t b = 0; b < f->branches; b++) {
        lags[b] = lag_of(&m->radau, h / f->tau[b]);
    }
    for (int i = 0; i < STAGES; i++) {
        s.source[i] = source_at(m, time + h * m->radau.place[i]);
        s.change[i] = f->mass > 0.0L ? from->v * h * m->radau.place[i] : 0.0L;
        s.volts[i] = f->series > 0.0L ? from->w : s.source[i];
    }
    if (!newton(m, from, h, lags, &s)) {
        return false;
    }
    const int last = STAGES - 1;
    *to = (state){.u = from->u + s.change[last], .v = s.v[last], .w = s.volts[last]};
    to->q = s.edge[last].capacitance * to->w;
    to->area = from->area;
    for (int i = 0; i < STAGES; i++) { /* the weights of the last stage are those of the step */
        to->area += h * m->radau.weight.at[last][i] * (from->u + s.change[i]);
    }
    for (int k = 0; k < s.edge[last].count; k++) {
        for (size_t b = 0; b < f->branches; b++) {
            to->z[k][b] = s.z[k][b][last];
        }
    }
    return true;
}

/* ---- a run */

static long double branch_stress(const true_film *f, const true_edge *e, const state *s, int k)
{
    long double sum = e->stress[k].value;
    for (size_t b = 0; b < f->branches; b++) {
        sum += f->share[b] * (e->stress[k].value - s->z[k][b]);
    }
    return sum;
}

/* What springs and branches hold. */
static long double held_force(const true_film *f, const true_edge *e, const state *s)
{
    long double sum = e->tension.value;
    for (int k = 0; k < e->count; k++) {
        sum += e->area[k].value * branch_stress(f, e, s, k);
    }
    return sum;
}

/* Stiffness with the branches held. */
static long double held_stiffness(const true_film *f, const state *s)
{
    const true_edge e = film_edge(f, s->u);
    long double sum = e.tension.slope - e.push.slope * s->w * s->w;
    for (int k = 0; k < e.count; k++) {
        sum += e.area[k].slope * branch_stress(f, &e, s, k) + e.area[k].value * (1.0L + f->total_share) * e.stress[k].slope;
    }
    return sum;
}

/* What holds a film without mass and damper: its branches and, behind a series resistance, its charge. */
static long double hold(const true_film *f, const state *s)
{
    const true_edge e = film_edge(f, s->u);
    const long double pull = 2.0L * e.push.value * s->w; /* dF/dU */
    return held_stiffness(f, s) + (f->series > 0.0L ? pull * pull / e.capacitance : 0.0L);
}

static bool is_framed(const motion *m, long double u)
{
    return u > -m->film.divide && u < m->film.frame - m->film.divide;
}

/* What charges a film needs a capacitance, and a permittivity that follows the strain has an end where it falls to 0; that of the linear
 * models may lie within the frame. */
static bool has_capacitance(const true_film *f, long double u)
{
    return film_edge(f, u).capacitance > 0.0L;
}

static bool needs_capacitance(const true_film *f)
{
    return f->series != 0.0L || f->conductance != 0.0L || f->electrostriction != 0.0L;
}

static bool inside(const motion *m, long double u)
{
    const true_film *f = &m->film;
    return is_framed(m, u) && (!needs_capacitance(f) || has_capacitance(f, u));
}

static bool is_linear(const true_film *f)
{
    return strcmp(f->model, "coverage") != 0 && strcmp(f->model, "ring") != 0;
}

/* Does a motion go on there? Of a linear film only the samples tell, and what charges it. */
static bool stays(const motion *m, long double u)
{
    return is_linear(&m->film) ? m->film.series == 0.0L || has_capacitance(&m->film, u) : inside(m, u);
}

/* A film without mass and damper: its displacement goes with the voltage, branches held. */
static bool jump(motion *m, state *s, long double to)
{
    enum { PARTS = 200 };
    const true_film *f = &m->film;
    const long double from = s->w * s->w, change = to * to - from;
    for (int i = 1; i <= PARTS; i++) {
        const long double load = i < PARTS ? from + change * i / PARTS : to * to; /* no sum: its rounding may be negative */
        long double step = (long double)INFINITY;
        s->w = sqrtl(load);
        for (int k = 0; k < 30 && fabsl(step) > 1e-19L * m->size[0]; k++) {
            const true_edge e = film_edge(f, s->u);
            const long double stiffness = held_stiffness(f, s);
            step = (held_force(f, &e, s) - e.push.value * load) / stiffness;
            if (!(stiffness > 0.0L)) {
                return false;
            }
            s->u -= step;
        }
        if (!stays(m, s->u) || !(fabsl(step) < 1e-9L * m->size[0])) {
            return false;
        }
    }
    s->w = to;
    return true;
}

static bool is_free(const true_film *f)
{
    return f->mass == 0.0L && f->retardation == 0.0L && f->load_damping == 0.0L;
}

/* Velocity that a damper sets: at the begin of the run. Behind a step its stages tell it, as a change over the step; the small force
 * that drives it is the rounding of large ones where the film has come to rest. */
static long double damped_velocity(const true_film *f, const state *s)
{
    const true_edge e = film_edge(f, s->u);
    const long double rest = e.push.value * s->w * s->w - held_force(f, &e, s);
    return rest / (f->retardation * edge_viscous(&e) + f->load_damping);
}

/* Velocity; with neither mass nor damper from the rate of the balance of forces: the stages of a step tell an algebraic displacement,
 * not its slope. */
static long double velocity_of(const motion *m, long double time, const state *s)
{
    const true_film *f = &m->film;
    const true_edge e = film_edge(f, s->u);
    if (!is_free(f)) {
        return s->v;
    }
    const long double pull = 2.0L * e.push.value * s->w; /* dF/dU */
    long double rate = 0.0L, slope = source_slope(m, time);
    for (size_t b = 0; b < f->branches; b++) {
        for (int k = 0; k < e.count; k++) {
            rate += e.area[k].value * f->share[b] * (e.stress[k].value - s->z[k][b]) / f->tau[b];
        }
    }
    if (f->series > 0.0L) { /* U' = (i - U/R_p - C' U v)/C */
        slope = ((source_at(m, time) - s->w) / f->series - s->w * f->conductance) / e.capacitance;
    }
    return (rate + pull * slope) / hold(f, s);
}

/* Current of the source: what the series resistance drops, or what charges the film and leaks through it. */
static long double current_of(const motion *m, long double time, const state *s)
{
    const true_film *f = &m->film;
    if (f->series > 0.0L) {
        return (source_at(m, time) - s->w) / f->series;
    }
    const true_edge e = film_edge(f, s->u);
    return e.capacitance * source_slope(m, time) + 2.0L * e.push.value * velocity_of(m, time, s) * s->w + s->w * f->conductance;
}

/* A sample, the time behind the begin of the segment. */
static bool record(motion *m, double time, long double here, const state *s)
{
    const true_film *f = &m->film;
    if (!inside(m, s->u)) {
        return false;
    }
    const dea_row row = film_row(f, s->u, s->w);
    m->samples[m->done++] = (dea_sample){
        .time = time,
        .voltage = (double)s->w,
        .displacement = row.displacement,
        .strain = row.strain,
        .velocity = (double)velocity_of(m, here, s),
        .force = row.force,
        .current = (double)current_of(m, here, s),
        .charge = (double)s->q,
        .focal_length = isnan((double)f->focal_length) ? (double)NAN : (double)film_focal_length(f, s->u / f->divide),
        .film_voltage = f->series > 0.0L ? (double)s->w : (double)NAN,
        .capacitance = row.capacitance,
        .state = row.state};
    return true;
}

/* Samples within a step. */
static bool record_step(motion *m, const state *from, long double time, long double h, const state *to)
{
    const long double begin = m->segment->from;
    while (m->done < m->rows) {
        const double at = dea_layout_place(m->scene, m->done);
        const long double here = (long double)at - begin;
        state s = *to;
        const bool last = at >= m->segment->to && time + h >= (long double)m->segment->to - begin;
        if (at > m->segment->to || (here > time + h && !last)) {
            return true;
        }
        if (here < time + h && !last && here > time && !step_by(m, from, time, here - time, &s)) {
            return false;
        }
        if (!record(m, at, here, &s)) {
            return false;
        }
    }
    return true;
}

/* Areas at the edges of windows within a step. */
static bool pass_edges(motion *m, const state *from, long double time, long double h, const state *to)
{
    const dea_transient *transient = &m->scene->transient;
    const long double begin = m->segment->from;
    for (size_t i = 0; i < 2 * transient->average_count; i++) {
        const dea_window *window = &transient->averages[i / 2];
        const double end = m->signal.segments[m->signal.count - 1].to; /* next to `until`, which may round to the other side */
        const double edge = fmin(i % 2 == 0 ? window->from : window->to, end);
        const long double here = fminl((long double)edge - begin, h + time);
        const bool ends = edge >= m->segment->to && time + h >= (long double)m->segment->to - begin;
        state s = here > time ? *to : *from;
        if (edge > m->segment->to || !isnan(m->edges[i / 2][i % 2]) || ((long double)edge - begin > time + h && !ends)) {
            continue;
        }
        if (here > time && here < time + h && !step_by(m, from, time, here - time, &s)) {
            return false;
        }
        m->edges[i / 2][i % 2] = s.area;
    }
    return true;
}

/* Share of the run over which a step may be off by the tolerance of u on the mean. */
static const long double area_share = 0.01L;

static long double distance(const motion *m, const state *a, const state *b)
{
    const long double u = fabsl(a->u - b->u) / m->size[0], w = fabsl(a->w - b->w) / m->size[2];
    const long double v = m->film.mass > 0.0L ? fabsl(a->v - b->v) / m->size[1] : 0.0L;
    /* a film that follows its voltage at once is right after any step, what it passed through is not */
    const bool means = m->scene->transient.average_count > 0;
    const long double passed = means ? fabsl(a->area - b->area) / (m->size[0] * area_share * m->scene->transient.until) : 0.0L;
    return fmaxl(fmaxl(u, passed), fmaxl(v, w));
}

/* Steps of any length fail where a film without mass and damper has nearly lost its stiffness, or one that charges its
 * capacitance, or where the film ends; anywhere else that is the fault of these steps and says nothing of the film. */
static bool is_ending(const motion *m, const state *s)
{
    const true_film *f = &m->film;
    const state rest = {0};
    const long double room = fminl(s->u + f->divide, f->frame - f->divide - s->u);
    return (is_free(f) && hold(f, s) < nearly * hold(f, &rest)) ||
           (f->series > 0.0L && film_edge(f, s->u).capacitance < nearly * film_edge(f, 0.0L).capacitance) ||
           room < 1e-6L * fminl(f->divide, f->frame - f->divide);
}

/* First step behind an edge: short against everything. */
static long double first_step(const motion *m)
{
    const true_film *f = &m->film;
    const true_edge e = film_edge(f, 0.0L);
    long double h = (long double)m->segment->to - m->segment->from;
    const long double stiffness = edge_viscous(&e) * (1.0L + f->total_share);
    if (f->mass > 0.0L && stiffness > 0.0L) {
        h = fminl(h, sqrtl(f->mass / stiffness));
    }
    for (size_t b = 0; b < f->branches; b++) {
        h = fminl(h, f->tau[b]);
    }
    if (f->retardation > 0.0L) {
        h = fminl(h, f->retardation);
    }
    if (f->series > 0.0L) {
        h = fminl(h, f->series * e.capacitance);
    }
    return 0.03L * h;
}

static bool run_segment(motion *m, state *s)
{
    const long double width = (long double)m->segment->to - m->segment->from;
    long double time = 0.0L, h = first_step(m);
    while (time < width) {
        state whole, half, two;
        const bool last = time + 1.01L * h >= width;
        h = last ? width - time : h;
        const bool found = step_by(m, s, time, h, &whole) && step_by(m, s, time, 0.5L * h, &half) &&
                           step_by(m, &half, time + 0.5L * h, 0.5L * h, &two);
        const long double error = found ? distance(m, &whole, &two) : (long double)INFINITY;
        m->steps++;
        if (m->steps > most_steps) {
            m->why = "too many steps of the truth";
            return false;
        }
        if (!(error <= m->tolerance)) {
            const long double share = found ? fmaxl(0.1L, 0.7L * powl(m->tolerance / error, 0.125L)) : 0.25L;
            h *= share;
            if (h < 1e-15L * width || h < 1e-18L * m->segment->to) {
                m->gone = is_ending(m, s);
                m->why = m->gone ? NULL : "the truth's equations were not solved";
                return false;
            }
            continue;
        }
        if (!stays(m, two.u) || (is_free(&m->film) && !(hold(&m->film, &two) > 0.0L))) {
            if (h > 1e-9L * width) {
                h *= 0.1L; /* rows before it counts are still to be taken */
                continue;
            }
            m->gone = true;
            return false;
        }
        if (!pass_edges(m, s, time, h, &two) || !record_step(m, s, time, h, &two)) {
            m->gone = true;
            return false;
        }
        *s = two;
        m->largest_u = fmaxl(m->largest_u, fabsl(s->u));
        m->largest_v = fmaxl(m->largest_v, fabsl(s->v));
        time = last ? width : time + h;
        h *= fminl(6.0L, 0.8L * powl(m->tolerance / fmaxl(error, 1e-30L), 0.1L));
    }
    return true;
}

static bool start(motion *m, state *s)
{
    const true_film *f = &m->film;
    *s = (state){0};
    if (m->scene->transient.from_bias || f->load_force != 0.0L) {
        m->segment = m->signal.segments;
        s->w = m->scene->transient.from_bias ? f->kept * source_at(m, 0.0L) : 0.0L;
        s->u = still_displacement(f, s->w);
        if (isnan(s->u)) {
            return false;
        }
        const true_edge e = film_edge(f, s->u);
        s->q = e.capacitance * s->w;
        for (int k = 0; k < e.count; k++) {
            for (size_t b = 0; b < f->branches; b++) {
                s->z[k][b] = e.stress[k].value;
            }
        }
    }
    return true;
}

static void run(motion *m, long double tolerance)
{
    state s;
    m->tolerance = tolerance;
    m->done = 0;
    m->steps = 0.0;
    for (size_t i = 0; i < 2 * DEA_WINDOWS; i++) {
        m->edges[i / 2][i % 2] = (long double)NAN;
    }
    m->gone = !start(m, &s);
    for (size_t i = 0; !m->gone && i < m->signal.count; i++) {
        m->segment = &m->signal.segments[i];
        if (!(m->film.series > 0.0L)) {
            const long double to = source_at(m, 0.0L);
            if (is_free(&m->film)) {
                m->gone = !jump(m, &s, to);
            }
            s.w = to;
            s.q = film_edge(&m->film, s.u).capacitance * to;
        }
        if (i == 0 && !m->gone) {
            s.v = m->film.mass > 0.0L || is_free(&m->film) ? s.v : damped_velocity(&m->film, &s);
            m->gone = !record(m, 0.0, 0.0L, &s);
        }
        if (m->gone || !run_segment(m, &s)) {
            return;
        }
    }
}

/* Largest magnitudes over the samples, no less than a hundredth of what the largest voltage does at rest. */
static void set_sizes(motion *m, long double share)
{
    const true_film *f = &m->film;
    const true_edge e = film_edge(f, 0.0L);
    const long double volts = fmaxl(m->signal.largest, 1e-30L), still = fabsl(e.push.value / edge_viscous(&e)) * volts * volts;
    m->size[0] = share * fminl(still, fminl(f->divide, f->frame - f->divide));
    m->size[2] = share * volts;
    for (size_t i = 0; share < 1.0L && i < m->done; i++) {
        m->size[0] = fmaxl(m->size[0], fabs(m->samples[i].displacement));
        m->size[2] = fmaxl(m->size[2], fabs(m->samples[i].voltage));
    }
    const long double pace = f->mass > 0.0L ? sqrtl(fabsl(edge_viscous(&e) / f->mass)) : 1.0L;
    m->size[1] = share < 1.0L ? fmaxl(m->largest_v, m->size[0] * pace * 0.01L) : m->size[0] * pace;
}

static double gap(const motion *m, const dea_sample *a, size_t count)
{
    long double most = 0.0L;
    for (size_t i = 0; i < count; i++) {
        const dea_sample *b = &m->samples[i];
        most = fmaxl(most, fabsl((long double)a[i].displacement - b->displacement) / m->size[0]);
        most = fmaxl(most, fabsl((long double)a[i].voltage - b->voltage) / m->size[2]);
    }
    return (double)most;
}

double number_at(const void *row, size_t offset)
{
    double value;
    memcpy(&value, (const char *)row + offset, sizeof value);
    return value;
}

void raise_errors(dea_sample *errors, const dea_sample *a, const dea_sample *b, size_t count)
{
    static const size_t offsets[] = {offsetof(dea_sample, displacement), offsetof(dea_sample, strain), offsetof(dea_sample, velocity),
                                     offsetof(dea_sample, force), offsetof(dea_sample, current), offsetof(dea_sample, charge),
                                     offsetof(dea_sample, focal_length), offsetof(dea_sample, film_voltage),
                                     offsetof(dea_sample, capacitance)};
    for (size_t i = 0; i < count; i++) {
        for (size_t k = 0; k < sizeof offsets / sizeof *offsets; k++) {
            const double gap = fabs(number_at(&a[i], offsets[k]) - number_at(&b[i], offsets[k]));
            double most = number_at(errors, offsets[k]);
            most = fmax(most, gap); /* a column that there is not is NAN in both */
            memcpy((char *)errors + offsets[k], &most, sizeof most);
        }
    }
}

/* Mean of u over a window, NAN where the motion ends before it [m]. */
static double mean(const motion *m, size_t window)
{
    const dea_window *w = &m->scene->transient.averages[window];
    return (double)((m->edges[window][1] - m->edges[window][0]) / ((long double)w->to - w->from));
}

/* Means of the last run, and how far those of the one before, in them so far, were off. */
static void take_means(const motion *m, true_run *run_out)
{
    for (size_t i = 0; i < m->scene->transient.average_count; i++) {
        const double now = mean(m, i);
        run_out->mean_error = fmax(run_out->mean_error, fabs(now - run_out->means[i]));
        run_out->means[i] = now;
    }
}

static void solve_twice(motion *m, true_run *run_out)
{
    dea_sample *first = malloc(m->rows * sizeof *first), *second = m->samples;
    set_sizes(m, 1.0L);
    run(m, 1e-7L);
    set_sizes(m, 0.01L);
    m->samples = first;
    if (!m->why) {
        run(m, 1e-12L);
    }
    take_means(m, run_out);
    run_out->mean_error = 0.0;
    const size_t count = m->done;
    m->samples = second;
    if (!m->why) {
        run(m, 1e-15L);
    }
    take_means(m, run_out);
    run_out->good = m->done;
    run_out->error = count == m->done ? 1e-16 + gap(m, first, count) : (double)INFINITY;
    raise_errors(&run_out->errors, first, second, count);
    run_out->steps = m->steps;
    run_out->why = m->why;
    free(first);
}

/* That of a film with one node. */
static true_run edge_motion(const dea_scene *scene, const dea_model *model, double factor)
{
    dea_error error = {0};
    motion *m = calloc(1, sizeof *m);
    true_run truth = {.count = dea_layout_of(scene).rows};
    m->scene = scene;
    m->film = film_of(scene, model);
    m->radau = radau_method();
    m->factor = factor;
    m->rows = truth.count;
    m->samples = truth.samples = calloc(truth.count, sizeof *truth.samples);
    if (dea_signal_open(scene, &m->signal, &error) == DEA_OK) {
        solve_twice(m, &truth);
    } else {
        truth.why = "no signal";
    }
    const true_edge e = film_edge(&m->film, 0.0L);
    const double push = fabs((double)e.push.value) * m->signal.largest * m->signal.largest;
    truth.still = fmin(push / (double)edge_viscous(&e), (double)fminl(m->film.divide, m->film.frame - m->film.divide));
    dea_signal_close(&m->signal);
    free(m);
    return truth;
}

true_run moving_truth(const dea_scene *scene, const dea_model *model, double factor)
{
    true_run truth = model->membrane ? radial_motion(scene, model, factor) : edge_motion(scene, model, factor);
    const double none = (double)NAN;
    for (size_t i = truth.good; i < truth.count; i++) {
        const double time = dea_layout_place(scene, i);
        truth.samples[i] = (dea_sample){
            time, none, none, none, none, none, none, none, none, none, none, DEA_STATE_PULL_IN, {none, none, none, none}};
    }
    return truth;
}

void true_run_free(true_run *of)
{
    free(of->samples);
    free(of->margins);
    of->samples = NULL;
    of->margins = NULL;
}
