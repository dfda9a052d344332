#include "deaspice/measures.h"

#include <math.h>

#include "drive/wave.h"
#include "network/dynamics.h"

static const double band = 0.02;      /* of the change of an edge: within it the film has settled */
static const double prominent = 1e-6; /* a peak that rises less than this share of itself is rounding */

/* Intervals behind an edge in which a film without a swing may do something faster than its samples show. */
enum { SHARP = 4 };

/* Share of an interval within which an edge counts as a jump. */
static const double short_rise = 0.1;

/* Parts of an interval between samples: with twenty samples a swing their straight lines miss 5e-5 of its amplitude. */
enum { PARTS = 16 };

/* Number of the last sample at or before @p time. */
static size_t sample_before(const dea_sample *samples, size_t count, double time)
{
    size_t low = 0, high = count;
    while (high - low > 1) {
        const size_t middle = low + (high - low) / 2;
        *(samples[middle].time <= time ? &low : &high) = middle;
    }
    return low;
}

/* A state at or between samples. */
typedef struct place {
    double time, u, v;
} place;

static place place_of(const dea_sample *s)
{
    return (place){s->time, s->displacement, s->velocity};
}

/* Cubic through two places with their velocities, also beyond them. */
static place between(place a, place b, double time)
{
    const double h = b.time - a.time, x = (time - a.time) / h, y = 1.0 - x;
    return (place){.time = time,
                   .u = a.u * y * y * (1.0 + 2.0 * x) + b.u * x * x * (1.0 + 2.0 * y) + h * x * y * (a.v * y - b.v * x),
                   .v = a.v * y * (1.0 - 3.0 * x) + b.v * x * (1.0 - 3.0 * y) + 6.0 * (b.u - a.u) / h * x * y};
}

/* An edge, and the trace behind it up to the last sample of its plateau. */
typedef struct plateau {
    const dea_sample *samples;
    size_t first, last; /* sample at or before the edge, last sample */
    place edge;         /* the state where it begins */
    double ramp;        /* how long it takes [s] */
    double change;      /* of the displacement, from the edge to where the film would relax to [m] */
    bool swings;        /* the samples show the film's swing */
} plateau;

static place begin_of(const plateau *p, size_t i)
{
    return i == p->first ? p->edge : place_of(&p->samples[i]);
}

/* True where the trace inside interval @p i is not the cubic: something is faster than its samples. */
static bool is_sharp(const plateau *p, size_t i)
{
    const double from = begin_of(p, i).time, to = p->samples[i + 1].time, corner = p->edge.time + p->ramp;
    if (!p->swings) {
        return i < p->first + SHARP || from < corner;
    }
    return corner > from && corner < to && p->ramp > short_rise * (to - from);
}

/* A share of the change, and the earliest and latest time at which the trace has it. */
typedef struct point {
    double share, early, late;
} point;

/* Part @p k of the trace: 0 is the edge, PARTS parts an interval. Within one that is sharp nothing is known but that it ends. */
static point part_of(const plateau *p, size_t k)
{
    const size_t i = p->first + k / PARTS;
    const place a = begin_of(p, i);
    if (k % PARTS == 0) {
        return (point){(a.u - p->edge.u) / p->change, a.time, a.time};
    }
    const place b = place_of(&p->samples[i + 1]);
    if (is_sharp(p, i)) {
        return (point){(a.u - p->edge.u) / p->change, a.time, b.time};
    }
    const double time = a.time + (b.time - a.time) * ((double)(k % PARTS) / PARTS);
    return (point){(between(a, b, time).u - p->edge.u) / p->change, time, time};
}

static size_t parts_of(const plateau *p)
{
    return (p->last - p->first) * PARTS;
}

/* When the share passes @p level between parts k - 1 and k. */
static dea_interval crossing(const plateau *p, size_t k, double level)
{
    const point a = part_of(p, k - 1), b = part_of(p, k);
    if (a.late > a.early) {
        return (dea_interval){a.early, a.late};
    }
    const double time = a.late + (b.early - a.late) * (level - a.share) / (b.share - a.share);
    return (dea_interval){time, time};
}

static dea_interval first_reach(const plateau *p, double level)
{
    for (size_t k = 1; k <= parts_of(p); k++) {
        if (part_of(p, k).share >= level) {
            return crossing(p, k, level);
        }
    }
    return (dea_interval){(double)NAN, (double)NAN};
}

/* When the trace is outside of the band for the last time; at the edge where it never is. */
static dea_interval last_outside(const plateau *p, double width)
{
    size_t k = parts_of(p);
    while (k > 0 && fabs(part_of(p, k).share - 1.0) <= width) {
        k--;
    }
    if (k == parts_of(p)) {
        return (dea_interval){(double)NAN, (double)NAN};
    }
    return crossing(p, k + 1, part_of(p, k).share > 1.0 ? 1.0 + width : 1.0 - width);
}

static double overshoot(const plateau *p)
{
    double largest = 1.0;
    for (size_t k = 1; k <= parts_of(p); k++) {
        largest = fmax(largest, part_of(p, k).share);
    }
    return largest - 1.0;
}

static bool is_whole(const plateau *p)
{
    for (size_t i = p->first; i <= p->last; i++) {
        if (!isfinite(p->samples[i].displacement) || !isfinite(p->samples[i].velocity)) {
            return false;
        }
    }
    return true;
}

/* The state at an edge between two samples goes on from before it. */
static place state_at(const dea_sample *samples, size_t first, double time)
{
    const place a = place_of(&samples[first]);
    if (time <= a.time) {
        return a;
    }
    return first > 0 ? between(place_of(&samples[first - 1]), a, time) : (place){time, a.u + a.v * (time - a.time), a.v};
}

/* Distance from the final value that the swing can still reach, as a share of the change: its amplitude. */
static double amplitude_of(const plateau *p, double omega)
{
    const place end = place_of(&p->samples[p->last]);
    const double gap = (end.u - p->edge.u) / p->change - 1.0;
    return p->swings ? hypot(gap, end.v / (omega * p->change)) : fabs(gap);
}

bool dea_measure_edge(const dea_sample *samples, size_t count, const dea_step_edge *edge, dea_edge_answer *answer)
{
    const double none = (double)NAN;
    const dea_interval never = {none, none};
    plateau p = {.samples = samples, .ramp = edge->rise, .swings = edge->omega > 0.0};
    *answer = (dea_edge_answer){.time = edge->from, .rising = edge->rising, .change = none, .overshoot = none};
    answer->rise = answer->settling = never;
    if (count == 0) {
        return false;
    }
    p.first = sample_before(samples, count, edge->from);
    p.last = sample_before(samples, count, edge->to);
    if (p.last <= p.first || samples[p.first].time > edge->from) {
        return false;
    }
    p.edge = state_at(samples, p.first, edge->from);
    answer->change = p.change = edge->final - p.edge.u;
    if (!is_whole(&p) || !(fabs(p.change) > 0.0)) {
        return true;
    }
    const dea_interval low = first_reach(&p, 0.1), high = first_reach(&p, 0.9);
    answer->reached = !isnan(first_reach(&p, 1.0 - band).late);
    answer->settled = amplitude_of(&p, edge->omega) <= band;
    if (answer->reached) {
        answer->rise = (dea_interval){fmax(0.0, high.early - low.late), high.late - low.early};
        answer->overshoot = overshoot(&p);
    }
    if (answer->settled) {
        const dea_interval narrow = last_outside(&p, band - edge->error), wide = last_outside(&p, band + edge->error);
        answer->settling = (dea_interval){wide.early - edge->from, (isnan(narrow.late) ? edge->to : narrow.late) - edge->from};
    }
    return true;
}

/* Displacement to which the film relaxes under a voltage of the source; NAN where it has none, or the model no time domain. */
static double relaxed(const dea_scene *scene, double voltage)
{
    dea_dynamics dynamics;
    double u = (double)NAN;
    if (dea_dynamics_settle(scene, scene->models[0], &dynamics, NULL) != DEA_OK ||
        !dea_dynamics_equilibrium(&dynamics, dea_dynamics_rest(&dynamics, voltage), &u)) {
        u = (double)NAN;
    }
    return u;
}

size_t dea_measure_edges(const dea_scene *scene, const dea_sample *samples, size_t count, const dea_summary *summary,
                         dea_edge_answer answers[DEA_EDGES])
{
    const dea_waveform *wave = &scene->drive.waveform;
    const double until = scene->transient.until;
    if (!dea_wave_settles(wave)) {
        return 0;
    }
    const double next = isnan(wave->period) ? until : fmin(wave->period + wave->step.on, until);
    const double off = isnan(wave->step.off) ? fmin(wave->period, next) : fmin(wave->step.off, next);
    const bool falls = off < next;
    const double omega = dea_measure_shows(scene, summary) ? 2.0 * DEA_PI * summary->resonance : 0.0;
    dea_step_edge edge = {
        .from = wave->step.on, .to = falls ? off : next, .rise = wave->step.rise, .rising = true, .omega = omega};
    edge.error = isnan(summary->error) ? 0.0 : fmin(summary->error, 0.5 * band);
    edge.final = relaxed(scene, wave->step.voltage);
    size_t found = dea_measure_edge(samples, count, &edge, &answers[0]) ? 1 : 0;
    if (falls) {
        edge = (dea_step_edge){
            .from = off, .to = next, .rise = edge.rise, .omega = omega, .error = edge.error, .final = relaxed(scene, 0.0)};
        found += dea_measure_edge(samples, count, &edge, &answers[found]) ? 1 : 0;
    }
    return found;
}

/* Behind any other waveform than a step the swing may live to the end. */
double dea_measure_interval(const dea_scene *scene, const dea_summary *summary)
{
    const dea_transient *transient = &scene->transient;
    const dea_waveform *wave = &scene->drive.waveform;
    if (!transient->logarithmic || !dea_wave_settles(wave) || !isnan(wave->period)) {
        return transient->every;
    }
    const double life = -log(band) / summary->decay; /* of an undamped swing without end */
    const double end = (isnan(wave->step.off) ? wave->step.on : wave->step.off) + wave->step.rise + life;
    const double ratio = pow(10.0, 1.0 / (double)transient->points_per_decade);
    return end < transient->until ? fmax(transient->first, end * (1.0 - 1.0 / ratio)) : transient->every;
}

bool dea_measure_lives(const dea_scene *scene, const dea_summary *summary)
{
    const double shortest = scene->transient.logarithmic ? scene->transient.first : scene->transient.every;
    return summary->resonance > 0.0 && exp(-summary->decay * shortest) > band;
}

bool dea_measure_shows(const dea_scene *scene, const dea_summary *summary)
{
    return summary->resonance * dea_measure_interval(scene, summary) <= 1.0 / DEA_SAMPLES_A_SWING;
}

/* Vertex of the parabola through three points of ln(magnitude) over ln(frequency), the middle one being the largest. */
static double parabola_top(const dea_response *rows)
{
    double x[3], y[3];
    for (int i = 0; i < 3; i++) {
        x[i] = log(rows[i].frequency / rows[1].frequency);
        y[i] = log(rows[i].displacement / rows[1].displacement);
    }
    const double left = y[0] / x[0], right = y[2] / x[2]; /* slopes from the middle point, which is the origin */
    const double curvature = (right - left) / (x[2] - x[0]);
    const double top = 0.5 * (x[0] - left / curvature);
    return rows[1].frequency * exp(curvature < 0.0 ? fmin(fmax(top, x[0]), x[2]) : 0.0);
}

static double lowest(const dea_response *rows, size_t from, size_t to)
{
    double least = (double)INFINITY;
    for (size_t i = from; i < to; i++) {
        least = fmin(least, rows[i].displacement);
    }
    return least;
}

/* Frequencies of one question; rounds of them that shrink any interval to rounding. */
enum { ASKED = 33, MOST_ROUNDS = 24 };

/* Share of the top that five neighbours may differ by, so that the quartic through them has it to 1e-8 of the peak's width; and
 * relative width of an interval that is a point. */
static const double flat = 1e-4;
static const double narrow = 1e-12;

/* Place of the top of the quartic through five values around the middle one, in steps from there. */
static double quartic_top(const double *y)
{
    const double c1 = (y[0] - 8.0 * y[1] + 8.0 * y[3] - y[4]) / 12.0;
    const double c2 = (-y[0] + 16.0 * y[1] - 30.0 * y[2] + 16.0 * y[3] - y[4]) / 24.0;
    const double c3 = (-y[0] + 2.0 * y[1] - 2.0 * y[3] + y[4]) / 12.0;
    const double c4 = (y[0] - 4.0 * y[1] + 6.0 * y[2] - 4.0 * y[3] + y[4]) / 24.0;
    double t = 0.0;
    for (int i = 0; i < 20; i++) {
        t -= (c1 + t * (2.0 * c2 + t * (3.0 * c3 + t * 4.0 * c4))) / (2.0 * c2 + t * (6.0 * c3 + t * 12.0 * c4));
    }
    return fabs(t) <= 1.0 ? t : 0.0;
}

static size_t largest_of(const double *m)
{
    size_t largest = 0;
    for (size_t i = 1; i < ASKED; i++) {
        largest = m[i] <= m[largest] ? largest : i; /* also one without a number: nothing damps it */
    }
    return largest;
}

/* The top between two frequencies; NAN where nobody answers. */
static double refine_top(double from, double to, dea_magnitudes *ask, void *user)
{
    double m[ASKED];
    for (int round = 0; round < MOST_ROUNDS && to - from > narrow * to; round++) {
        const double step = (to - from) / (ASKED - 1);
        if (!ask(user, from, to, ASKED, m)) {
            return (double)NAN;
        }
        size_t k = largest_of(m);
        if (!isfinite(m[k])) {
            return from + (double)k * step;
        }
        if (k >= 2 && k + 2 < ASKED && fmin(m[k - 2], m[k + 2]) >= (1.0 - flat) * m[k]) {
            return from + ((double)k + quartic_top(m + k - 2)) * step;
        }
        k = k == 0 ? 1 : k == ASKED - 1 ? ASKED - 2 : k;
        from += (double)(k - 1) * step;
        to = from + 2.0 * step;
    }
    return 0.5 * (from + to);
}

/* Where the magnitude falls to a level between two frequencies; NAN where nobody answers. */
static double refine_fall(double from, double to, double level, dea_magnitudes *ask, void *user)
{
    double m[ASKED];
    for (int round = 0; round < MOST_ROUNDS; round++) {
        const double step = (to - from) / (ASKED - 1);
        size_t k = 1;
        if (!ask(user, from, to, ASKED, m)) {
            return (double)NAN;
        }
        while (k + 1 < ASKED && !(m[k] <= level)) {
            k++;
        }
        from += (double)(k - 1) * step;
        if (step < flat * to) {
            return from + step * (isfinite(m[k - 1]) ? (m[k - 1] - level) / (m[k - 1] - m[k]) : 0.5);
        }
        to = from + step;
    }
    return (double)NAN;
}

/* The resonance between the last two frequencies, where the response still rises from one to the other. */
static double last_resonance(const dea_response *rows, size_t count, dea_magnitudes *ask, void *user)
{
    double m[ASKED];
    const double from = rows[count - 2].frequency, to = rows[count - 1].frequency;
    if (!ask(user, from, to, ASKED, m)) {
        return (double)NAN;
    }
    const size_t k = largest_of(m);
    const bool inside = k > 0 && k < ASKED - 1 && !(m[ASKED - 1] > (1.0 - prominent) * m[k]);
    return inside ? refine_top(from, to, ask, user) : (double)NAN;
}

/* The largest peak; below it relaxation may let the response fall from a value that is larger still. */
static double resonance_of(const dea_response *rows, size_t count, dea_magnitudes *ask, void *user)
{
    size_t top = 0;
    double before = (double)INFINITY; /* the least magnitude so far */
    for (size_t i = 1; i + 1 < count; i++) {
        const double here = rows[i].displacement;
        before = fmin(before, rows[i - 1].displacement);
        const bool peak = here > rows[i - 1].displacement && here >= rows[i + 1].displacement;
        if (peak && before < (1.0 - prominent) * here && (top == 0 || here > rows[top].displacement)) {
            top = i;
        }
    }
    if (ask && top == 0 && count > 1 && rows[count - 1].displacement > rows[count - 2].displacement) {
        return last_resonance(rows, count, ask, user);
    }
    if (top == 0 || !(lowest(rows, top + 1, count) < (1.0 - prominent) * rows[top].displacement)) {
        return (double)NAN;
    }
    if (!isfinite(rows[top].displacement)) {
        return rows[top].frequency;
    }
    return ask ? refine_top(rows[top - 1].frequency, rows[top + 1].frequency, ask, user) : parabola_top(&rows[top - 1]);
}

static double bandwidth_of(const dea_response *rows, size_t count, dea_magnitudes *ask, void *user)
{
    for (size_t i = 1; i < count; i++) {
        const double level = rows[0].displacement * sqrt(0.5);
        const double before = rows[i - 1].displacement, after = rows[i].displacement;
        if (before > level && after <= level) {
            if (ask) {
                return refine_fall(rows[i - 1].frequency, rows[i].frequency, level, ask, user);
            }
            const double share = isfinite(before) ? log(level / before) / log(after / before) : 1.0;
            return rows[i - 1].frequency * exp(share * log(rows[i].frequency / rows[i - 1].frequency));
        }
    }
    return (double)NAN;
}

dea_band dea_measure_band(const dea_response *rows, size_t count, dea_magnitudes *ask, void *user)
{
    return (dea_band){resonance_of(rows, count, ask, user), bandwidth_of(rows, count, ask, user)};
}
