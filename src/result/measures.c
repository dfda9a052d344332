#include "deaspice/measures.h"

#include <math.h>

static const double settled = 0.02;   /* of the change of an edge */
static const double prominent = 1e-6; /* a peak that rises less than this share of itself is rounding */

static double mix(double a, double b, double share)
{
    return share <= 0.0 ? a : share >= 1.0 ? b : a + share * (b - a); /* exact at the ends, also beside a sample without number */
}

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

static double displacement_at(const dea_sample *samples, size_t count, double time)
{
    const size_t i = sample_before(samples, count, time);
    const dea_sample *a = &samples[i], *b = &samples[i + 1 < count ? i + 1 : i];
    const double share = b->time > a->time ? (time - a->time) / (b->time - a->time) : 0.0;
    return mix(a->displacement, b->displacement, share);
}

/* The samples first ... last of the plateau behind an edge, relative: 0 before the edge, 1 at the end. */
typedef struct plateau {
    const dea_sample *samples;
    size_t first, last; /* sample at or before the edge, last sample of the plateau */
    double begin, edge, change;
} plateau;

static double share_of(const plateau *p, size_t i)
{
    return i == p->first ? 0.0 : (p->samples[i].displacement - p->begin) / p->change;
}

static double time_of(const plateau *p, size_t i)
{
    return i == p->first ? p->edge : p->samples[i].time;
}

/* When the share passes @p level between samples i - 1 and i. */
static double crossing(const plateau *p, size_t i, double level)
{
    const double before = share_of(p, i - 1), after = share_of(p, i);
    return mix(time_of(p, i - 1), time_of(p, i), (level - before) / (after - before));
}

static double first_reach(const plateau *p, double level)
{
    for (size_t i = p->first + 1; i <= p->last; i++) {
        if (share_of(p, i) >= level) {
            return crossing(p, i, level);
        }
    }
    return (double)NAN;
}

static double settling_time(const plateau *p)
{
    size_t i = p->last;
    while (i > p->first && fabs(share_of(p, i) - 1.0) <= settled) {
        i--;
    }
    if (i == p->last) {
        return (double)NAN;
    }
    return crossing(p, i + 1, share_of(p, i) > 1.0 ? 1.0 + settled : 1.0 - settled) - p->edge;
}

static double overshoot(const plateau *p)
{
    double largest = 1.0;
    for (size_t i = p->first + 1; i <= p->last; i++) {
        largest = fmax(largest, share_of(p, i));
    }
    return largest - 1.0;
}

static bool is_whole(const plateau *p)
{
    for (size_t i = p->first; i <= p->last; i++) {
        if (!isfinite(p->samples[i].displacement)) {
            return false;
        }
    }
    return true;
}

static bool edge_measure(const dea_sample *samples, size_t count, double from, double to, dea_edge_answer *edge)
{
    plateau p = {.samples = samples, .edge = from};
    p.first = sample_before(samples, count, from);
    p.last = sample_before(samples, count, to);
    if (p.last <= p.first || samples[p.first].time > from) {
        return false;
    }
    p.begin = displacement_at(samples, count, from);
    p.change = samples[p.last].displacement - p.begin;
    const double none = (double)NAN;
    *edge = (dea_edge_answer){.time = from, .change = p.change, .rise_time = none, .settling_time = none, .overshoot = none};
    if (is_whole(&p) && fabs(p.change) > 0.0) {
        edge->rise_time = first_reach(&p, 0.9) - first_reach(&p, 0.1);
        edge->settling_time = settling_time(&p);
        edge->overshoot = overshoot(&p);
    }
    return true;
}

size_t dea_measure_edges(const dea_scene *scene, const dea_sample *samples, size_t count, dea_edge_answer edges[DEA_EDGES])
{
    const dea_waveform *wave = &scene->drive.waveform;
    const double until = scene->transient.until;
    size_t found = 0;
    if (wave->kind != DEA_WAVE_STEP || count == 0) {
        return 0;
    }
    const double next = isnan(wave->period) ? until : fmin(wave->period + wave->step.on, until);
    const double off = isnan(wave->step.off) ? fmin(wave->period, next) : fmin(wave->step.off, next);
    if (edge_measure(samples, count, wave->step.on, isnan(off) ? next : off, &edges[found])) {
        edges[found++].rising = true;
    }
    if (off < next && edge_measure(samples, count, off, next, &edges[found])) {
        edges[found++].rising = false;
    }
    return found;
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

/* The largest peak; below it relaxation may let the response fall from a value that is larger still. */
static double resonance_of(const dea_response *rows, size_t count)
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
    if (top == 0 || !(lowest(rows, top + 1, count) < (1.0 - prominent) * rows[top].displacement)) {
        return (double)NAN;
    }
    return isfinite(rows[top].displacement) ? parabola_top(&rows[top - 1]) : rows[top].frequency;
}

static double bandwidth_of(const dea_response *rows, size_t count)
{
    for (size_t i = 1; i < count; i++) {
        const double level = rows[0].displacement * sqrt(0.5);
        const double before = rows[i - 1].displacement, after = rows[i].displacement;
        if (before > level && after <= level) {
            const double share = isfinite(before) ? log(level / before) / log(after / before) : 1.0;
            return rows[i - 1].frequency * exp(share * log(rows[i].frequency / rows[i - 1].frequency));
        }
    }
    return (double)NAN;
}

dea_band dea_measure_band(const dea_response *rows, size_t count)
{
    return (dea_band){resonance_of(rows, count), bandwidth_of(rows, count)};
}
