/* From rest at the begin of the edge, y' = f(t, y) by Dormand and Prince's Runge-Kutta pair of orders 5 and 4 (RK5(4)7M, 1980), whose
 * last stage is the first of the next step. Between two steps the displacement of the edge is the cubic through both with their
 * velocities; a peak is where that velocity turns. */
#include "needs/nearness.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "network/motion.h"
#include "network/rings_mesh.h"
#include "network/rings_motion.h"
#include "network/swing.h"

static const double tolerance = 1e-4;  /* of a step, of the sizes of displacement and velocity: peaks are right to 1e-4 then */
static const double agreed = 2e-3;     /* meshes that differ by less have the peak */
static const double smooth = 0.02;     /* of the retardation times the resonance: waves so smooth that two meshes that agree do, else three */
enum { COARSEST = 3, FINEST = 7 }; /* nodes of an element */

enum { STAGES = 7 };

/* A film that moves. */
typedef struct moving {
    const dea_signal *signal; /* borrowed */
    const dea_segment *segment;
    dea_dynamics dynamics; /* owned; of one node */
    dea_motion node;
    dea_membrane *membrane; /* owned; NULL: one node */
    dea_rings_motion rings;
    size_t count, u, v;    /* unknowns; places of displacement and velocity of the edge */
    size_t u_end, v_end;   /* displacements stand from 0 on, then velocities: these count in the error of a step */
    double length, speed;  /* sizes of both, in their units */
    double *work;          /* owned: y, next, STAGES slopes */
    double period;         /* of its first resonance at rest [s]: the first peak is the largest within it behind the edge */
    double peak, largest;  /* |u| of a turn so far, and of all, at the most, in units of u */
    int *steps; /* borrowed: those that are left */
} moving;

static bool rates(moving *m, double time, const double *y, double *f)
{
    m->node.segment = m->rings.segment = m->segment;
    return m->membrane ? dea_rings_rates(&m->rings, time, y, f) : dea_motion_rates(&m->node, time, y, f);
}

/* ---- one step */

static const double nodes[STAGES] = {0.0, 0.2, 0.3, 0.8, 8.0 / 9.0, 1.0, 1.0};
static const double weights[STAGES][STAGES - 1] = {
    {0.0},
    {1.0 / 5.0},
    {3.0 / 40.0, 9.0 / 40.0},
    {44.0 / 45.0, -56.0 / 15.0, 32.0 / 9.0},
    {19372.0 / 6561.0, -25360.0 / 2187.0, 64448.0 / 6561.0, -212.0 / 729.0},
    {9017.0 / 3168.0, -355.0 / 33.0, 46732.0 / 5247.0, 49.0 / 176.0, -5103.0 / 18656.0},
    {35.0 / 384.0, 0.0, 500.0 / 1113.0, 125.0 / 192.0, -2187.0 / 6784.0, 11.0 / 84.0},
};
/* Of order 5 less those of order 4. */
static const double doubts[STAGES] = {71.0 / 57600.0,      0.0,           -71.0 / 16695.0, 71.0 / 1920.0,
                                      -17253.0 / 339200.0, 22.0 / 525.0, -1.0 / 40.0};

static double *slope(const moving *m, int stage)
{
    return m->work + (size_t)(2 + stage) * m->count;
}

/* The error of a step over the tolerance; infinite where the film cannot be there. Slope 0 stands; next is the end of the step. */
static double step(moving *m, double time, double length)
{
    const double *y = m->work;
    double *next = m->work + m->count, worst = 0.0;
    for (int s = 1; s < STAGES; s++) {
        for (size_t i = 0; i < m->count; i++) {
            double sum = 0.0;
            for (int k = 0; k < s; k++) {
                sum += weights[s][k] * slope(m, k)[i];
            }
            next[i] = y[i] + length * sum;
        }
        if (!rates(m, time + nodes[s] * length, next, slope(m, s))) {
            return (double)INFINITY;
        }
    }
    for (size_t i = 0; i < m->v_end; i++) {
        double sum = 0.0;
        for (int k = 0; k < STAGES; k++) {
            sum += doubts[k] * slope(m, k)[i];
        }
        worst = fmax(worst, fabs(length * sum) / (i < m->u_end ? m->length : m->speed));
    }
    return worst / tolerance;
}

/* The peak of the cubic between both ends of a step over which the velocity turns back. */
static void look_for_peak(moving *m, double length)
{
    const double *y = m->work, *next = y + m->count;
    const double from = slope(m, 0)[m->u] * length, to = slope(m, STAGES - 1)[m->u] * length, rise = next[m->u] - y[m->u];
    if (!(from * to < 0.0 && from * y[m->u] > 0.0)) {
        return;
    }
    /* u' = from + 2 b x + 3 c x^2 over the share x of the step */
    const double c = from + to - 2.0 * rise, b = 3.0 * rise - 2.0 * from - to;
    const double root = sqrt(fmax(0.0, b * b - 3.0 * c * from)), x = from / (from > 0.0 ? root - b : -root - b);
    m->peak = fmax(m->peak, fabs(y[m->u] + x * (from + x * (b + x * c))));
}

/* Through a segment up to an age; false where the film has no number or steps do not suffice. */
static bool pass(moving *m, const dea_segment *segment, double until, double first)
{
    double length = fmin(first, until);
    m->segment = segment;
    if (!rates(m, 0.0, m->work, slope(m, 0))) {
        return false;
    }
    for (double time = 0.0; time < until;) {
        const double error = step(m, time, length);
        if (--*m->steps < 0 || isnan(error)) {
            return false;
        }
        if (error <= 1.0) {
            look_for_peak(m, length);
            m->largest = fmax(m->largest, fabs(m->work[m->count + m->u]));
            time += length;
            memcpy(m->work, m->work + m->count, m->count * sizeof *m->work);
            memcpy(slope(m, 0), slope(m, STAGES - 1), m->count * sizeof *m->work);
        }
        length = fmin(length * fmin(4.0, fmax(0.2, 0.9 * pow(error, -0.2))), until - time);
    }
    return true;
}

/* ---- the edge */

/* The segments of a voltage that rises from 0 and stands, NULL where it jumps: both NULL where the voltage does anything else first. */
typedef struct edge {
    const dea_segment *rise, *stand;
} edge;

static bool is_line(const dea_segment *segment)
{
    return !segment->sine && !segment->lines;
}

static edge first_edge(const dea_signal *signal)
{
    size_t i = 0;
    while (i + 1 < signal->count && is_line(&signal->segments[i]) && signal->segments[i].start == 0.0 &&
           signal->segments[i].end == 0.0) {
        i++;
    }
    const dea_segment *rise = signal->segments[i].start == 0.0 ? &signal->segments[i] : NULL;
    const dea_segment *stand = rise ? (i + 1 < signal->count ? rise + 1 : NULL) : &signal->segments[i];
    const bool fits = stand && is_line(stand) && stand->start == stand->end && stand->start != 0.0 &&
                      (!rise || (is_line(rise) && rise->end == stand->start));
    return fits ? (edge){rise, stand} : (edge){NULL, NULL};
}

/* Largest displacement of a turn, in units of u; NAN where the film goes farther without one. */
static double peak_of(moving *m, const edge *e)
{
    const double first = 0.02 * m->period;
    const bool passed = (!e->rise || pass(m, e->rise, e->rise->to - e->rise->from, first)) && pass(m, e->stand, m->period, first);
    return passed && m->peak > 0.0 && m->peak >= m->largest ? m->peak : (double)NAN;
}

/* ---- both films */

static bool make_room(moving *m)
{
    m->work = calloc((2 + STAGES) * m->count, sizeof *m->work); /* y at rest: all 0 */
    return m->work;
}

static void moving_close(moving *m)
{
    dea_dynamics_close(&m->dynamics);
    free(m->membrane);
    free(m->work);
}

static double node_peak(moving *m, const edge *e)
{
    m->count = (size_t)m->node.count;
    m->v = m->u_end = 1;
    m->v_end = 2;
    m->length = m->speed = 1.0;
    return make_room(m) ? peak_of(m, e) * m->node.size[0] : (double)NAN;
}

/* With the sizes of displacement and velocity of the film of one node. */
static double membrane_peak(const dea_scene *scene, const dea_model *truth, const dea_signal *signal, const edge *e, int degree,
                            const moving *like)
{
    moving m = {.signal = signal, .steps = like->steps, .membrane = malloc(sizeof *m.membrane)};
    double peak = (double)NAN;
    if (m.membrane && dea_membrane_open(scene, truth, dea_rings_mesh_of(scene, degree), m.membrane, NULL) == DEA_OK) {
        dea_rings_motion_lay(m.membrane, signal, &m.rings);
        m.count = m.rings.count;
        m.u = m.membrane->rings.edge;
        m.u_end = m.rings.nodes;
        m.v_end = 2 * m.rings.nodes;
        m.period = 1.0 / dea_point_resonance(scene, &like->dynamics.point);
        m.length = like->node.size[0];
        m.speed = like->node.size[1];
        peak = make_room(&m) ? peak_of(&m, e) : (double)NAN;
    }
    moving_close(&m);
    return peak;
}

/* On ever finer meshes, until the last of them agree; NAN where they do not. */
static double finest_peak(const dea_scene *scene, const dea_model *truth, const edge *e, const moving *like)
{
    const int least = like->dynamics.retardation * dea_point_resonance(scene, &like->dynamics.point) > smooth ? 1 : 2;
    double peak = membrane_peak(scene, truth, like->signal, e, COARSEST, like), low = peak, high = peak;
    int alike = 0; /* meshes that agree with the one that low and high begin at */
    for (int degree = COARSEST + 1; degree <= FINEST && alike < least && !isnan(peak); degree++) {
        peak = membrane_peak(scene, truth, like->signal, e, degree, like);
        low = fmin(low, peak);
        high = fmax(high, peak);
        alike = high - low <= agreed * peak ? alike + 1 : 0;
        low = alike > 0 ? low : peak;
        high = alike > 0 ? high : peak;
    }
    return alike < least ? (double)NAN : peak;
}

static double deviation(const dea_scene *scene, moving *m, const dea_model *truth)
{
    const edge e = first_edge(m->signal);
    const dea_swing swing = dea_swing_of(&m->dynamics, 0.0, 0.0);
    const double slower = fmin(swing.frequency, dea_point_resonance(scene, &m->dynamics.point));
    if (!e.stand || isnan(swing.frequency) || m->dynamics.biased || !(slower * (e.stand->to - e.stand->from) >= 1.0)) {
        return (double)NAN;
    }
    m->period = 1.0 / swing.frequency;
    dea_motion_open(&m->dynamics, m->signal, &m->node);
    const double own = node_peak(m, &e);
    if (isnan(own)) {
        return own;
    }
    return own / finest_peak(scene, truth, &e, m) - 1.0;
}

double dea_first_peak_deviation(const dea_scene *scene, const dea_model *model, const dea_model *truth, int *steps)
{
    dea_signal signal;
    moving m = {.signal = &signal, .steps = steps};
    double off = (double)NAN;
    const bool opened = dea_signal_open(scene, &signal, NULL) == DEA_OK;
    if (dea_dynamics_open(scene, model, &m.dynamics, NULL) == DEA_OK && opened && m.dynamics.mass > 0.0) {
        off = deviation(scene, &m, truth);
    }
    moving_close(&m);
    dea_signal_close(&signal);
    return off;
}
