/* What a window of a transient holds besides its mean: extremes and, of a sine, harmonics of the displacement. They rest on the
 * samples and their velocities, of which a polynomial of degree 7 lies between two; the same of every second sample tells how far
 * that is off. */
#include <complex.h>
#include <math.h>

#include "deaspice/measures.h"
#include "drive/signal.h"
#include "drive/wave.h"
#include "support/gauss.h"

/* Samples in the shortest time in which the drive or the film turns, without which they may show something else. */
static const double resolved = 10.0;

static const double promised = 10.0; /* accuracies that the figures promise */
static const double clear = 100.0;   /* errors that an amplitude is worth before its phase is told */

/* Samples that cover a window, every so many of them. */
typedef struct trace {
    const dea_sample *samples;
    size_t first, last, stride;
    double from, to; /* [s] */
} trace;

/* Nodes of the polynomial between two samples: those and their neighbours, each with its velocity. */
enum { NODES = 4, TERMS = 2 * NODES };

/* One stretch between two samples, its part in the window, and the polynomial there in Newton's form. */
typedef struct stretch {
    const dea_sample *a, *b;
    double low, high;        /* [s] */
    double places[TERMS];    /* of the nodes, each twice [s] */
    double differences[TERMS];
    int terms;
} stretch;

/* Divided differences of Hermite's interpolation. */
static void fit(const trace *t, size_t index, size_t end, stretch *s)
{
    const dea_sample *nodes[NODES];
    int count = 0;
    if (index >= t->first + t->stride) {
        nodes[count++] = &t->samples[index - t->stride];
    }
    nodes[count++] = s->a;
    nodes[count++] = s->b;
    if (end + t->stride <= t->last) {
        nodes[count++] = &t->samples[end + t->stride];
    }
    s->terms = 2 * count;
    for (int i = 0; i < s->terms; i++) {
        s->places[i] = nodes[i / 2]->time;
        s->differences[i] = nodes[i / 2]->displacement;
    }
    for (int order = 1; order < s->terms; order++) {
        for (int i = s->terms - 1; i >= order; i--) {
            const bool twice = order == 1 && i % 2 == 1;
            s->differences[i] = twice ? nodes[i / 2]->velocity
                                      : (s->differences[i] - s->differences[i - 1]) / (s->places[i] - s->places[i - order]);
        }
    }
}

static double value_at(const stretch *s, double time)
{
    double value = s->differences[s->terms - 1];
    for (int i = s->terms - 2; i >= 0; i--) {
        value = value * (time - s->places[i]) + s->differences[i];
    }
    return value;
}

static double slope_at(const stretch *s, double time)
{
    double value = s->differences[s->terms - 1], slope = 0.0;
    for (int i = s->terms - 2; i >= 0; i--) {
        slope = slope * (time - s->places[i]) + value;
        value = value * (time - s->places[i]) + s->differences[i];
    }
    return slope;
}

/* The stretch that begins at sample *@p index, which moves on; false behind the last. */
static bool next_stretch(const trace *t, size_t *index, stretch *s)
{
    if (*index >= t->last) {
        return false;
    }
    const size_t begin = *index, end = begin + t->stride < t->last ? begin + t->stride : t->last;
    *index = end;
    *s = (stretch){.a = &t->samples[begin], .b = &t->samples[end]};
    s->low = fmax(s->a->time, t->from);
    s->high = fmin(s->b->time, t->to);
    fit(t, begin, end, s);
    return true;
}

static void widen(double value, double range[2])
{
    range[0] = fmin(range[0], value);
    range[1] = fmax(range[1], value);
}

/* Parts of a stretch in each of which the slope changes its sign once at the most, and halves that find where. */
enum { PARTS = 8, HALVES = 50 };

static void see_turn(const stretch *s, double from, double to, double range[2])
{
    const double first = slope_at(s, from);
    if (!(first * slope_at(s, to) < 0.0)) {
        return;
    }
    for (int i = 0; i < HALVES; i++) {
        const double middle = 0.5 * (from + to);
        *(slope_at(s, middle) * first > 0.0 ? &from : &to) = middle;
    }
    widen(value_at(s, to), range);
}

static void extremes(const trace *t, double range[2])
{
    stretch s;
    size_t index = t->first;
    range[0] = INFINITY;
    range[1] = -INFINITY;
    while (next_stretch(t, &index, &s)) {
        const double part = (s.high - s.low) / PARTS;
        for (int i = 0; i < PARTS && part > 0.0; i++) {
            see_turn(&s, s.low + part * i, s.low + part * (i + 1), range);
        }
        if (part >= 0.0) {
            widen(value_at(&s, s.low), range);
            widen(value_at(&s, s.high), range);
        }
    }
}

/* Harmonics over the whole periods of the window: u = mean + sum A_k sin(k theta + phi_k), theta the argument of the drive's sine,
 * so that 2/T int u e^{-i k theta} dt = A_k e^{i phi_k}/i. */
static void harmonics(const trace *t, const dea_sine *sine, double complex sum[DEA_HARMONICS])
{
    stretch s;
    size_t index = t->first;
    for (int k = 0; k < DEA_HARMONICS; k++) {
        sum[k] = 0.0;
    }
    while (next_stretch(t, &index, &s)) {
        for (int g = 0; g < DEA_GAUSS_POINTS && s.high > s.low; g++) {
            const double time = s.low + (s.high - s.low) * dea_gauss_place(g);
            const double weight = 2.0 * dea_gauss_weight(g) * (s.high - s.low) / (t->to - t->from) * value_at(&s, time);
            const double theta = 2.0 * DEA_PI * sine->frequency * (time - sine->delay) + sine->phase;
            for (int k = 0; k < DEA_HARMONICS; k++) {
                sum[k] += I * weight * cexp(-I * (double)(k + 1) * theta);
            }
        }
    }
}

/* Longest interval of the samples; NAN where one has no number. */
static double longest(const trace *t)
{
    double interval = 0.0;
    for (size_t i = t->first; i <= t->last; i++) {
        if (!isfinite(t->samples[i].displacement) || !isfinite(t->samples[i].velocity)) {
            return (double)NAN;
        }
        interval = i > t->first ? fmax(interval, t->samples[i].time - t->samples[i - 1].time) : interval;
    }
    return interval;
}

/* Longest interval of samples that still shows what the film does in a part of a window, under a segment of the drive: U^2 turns
 * twice as fast as U, and a swing that corners have set off must have died away. */
static double finest(const dea_scene *scene, const dea_summary *summary, const dea_signal *signal, const dea_segment *s, double from)
{
    const double turn = dea_segment_turn(signal, s), dead = -log(scene->accuracy) / summary->decay;
    const bool swings = summary->resonance > 0.0 && !(fmax(from, s->from) - s->from > dead);
    const double own = turn > 0.0 ? DEA_PI / turn : s->to - s->from;
    return fmin(own, swings ? 1.0 / summary->resonance : (double)INFINITY) / resolved;
}

/* True where the samples are dense beside the swing of the film, and beside what the drive does in the window. */
static bool shows(const dea_scene *scene, const dea_summary *summary, const trace *t)
{
    dea_signal signal;
    dea_error error = {0};
    const double interval = longest(t);
    bool dense = interval > 0.0 && dea_signal_open(scene, &signal, &error) == DEA_OK;
    if (!dense) {
        return false;
    }
    for (size_t i = 0; i < signal.count && dense; i++) {
        const dea_segment *s = &signal.segments[i];
        dense = s->to <= t->from || s->from >= t->to || interval <= finest(scene, summary, &signal, s, t->from);
    }
    dea_signal_close(&signal);
    return dense;
}

/* The samples of a window; false where they do not cover it, or are too few to be halved. */
static bool cover(const dea_sample *samples, size_t count, double from, double to, trace *t)
{
    *t = (trace){.samples = samples, .stride = 1, .from = from, .to = to};
    while (t->first + 1 < count && samples[t->first + 1].time <= from) {
        t->first++;
    }
    t->last = t->first;
    while (t->last < count && samples[t->last].time < to) {
        t->last++;
    }
    return t->last < count && t->last - t->first >= 4;
}

static double peak_of(const dea_sample *samples, size_t count)
{
    double peak = 0.0;
    for (size_t i = 0; i < count; i++) {
        peak = fmax(peak, fabs(samples[i].displacement)); /* drops NAN */
    }
    return peak;
}

static void tell_harmonics(const dea_scene *scene, const trace *window, double allowed, double own, dea_window_figures *figures)
{
    const dea_sine *sine = &scene->drive.waveform.sine;
    const double periods = floor((window->to - window->from) * sine->frequency * (1.0 + 1e-12));
    if (!dea_wave_is_pure(&scene->drive.waveform) || !(periods >= 1.0) || window->from < sine->delay) {
        return;
    }
    double complex fine[DEA_HARMONICS], coarse[DEA_HARMONICS];
    trace t = *window;
    t.to = fmin(t.to, t.from + periods / sine->frequency);
    harmonics(&t, sine, fine);
    t.stride = 2;
    harmonics(&t, sine, coarse);
    for (int k = 0; k < DEA_HARMONICS; k++) {
        const double error = cabs(fine[k] - coarse[k]), size = cabs(fine[k]);
        if (error <= allowed) {
            figures->amplitude[k] = size;
            figures->phase[k] = size > clear * (error + own) ? carg(fine[k]) * 180.0 / DEA_PI : (double)NAN;
        }
    }
}

#define HARMONIC(number, ordinal)                                                                                                \
    {"amplitude_" #number "_m", "amplitude of the " ordinal " harmonic of the displacement in the window", "m",                   \
     offsetof(dea_window_figures, amplitude[number - 1])},                                                                       \
        {"phase_" #number "_deg", "its phase against as many times the argument of the drive's sine", "degree",                   \
         offsetof(dea_window_figures, phase[number - 1])}

static const dea_column window_columns[] = {
    {"least_m", "least radial displacement of the disc edge in the window", "m", offsetof(dea_window_figures, least)},
    {"largest_m", "largest radial displacement of the disc edge in the window", "m", offsetof(dea_window_figures, largest)},
    {"peak_to_peak_m", "displacement from peak to peak in the window", "m", offsetof(dea_window_figures, range)},
    HARMONIC(1, "first"),
    HARMONIC(2, "second"),
    HARMONIC(3, "third"),
    HARMONIC(4, "fourth"),
    HARMONIC(5, "fifth"),
};

const dea_column *dea_window_columns(const dea_scene *scene, size_t *count)
{
    const size_t all = sizeof window_columns / sizeof *window_columns;
    *count = dea_wave_is_pure(&scene->drive.waveform) ? all : all - 2 * DEA_HARMONICS;
    return window_columns;
}

dea_window_figures dea_measure_window(const dea_scene *scene, const dea_sample *samples, size_t count, const dea_summary *summary,
                                      size_t window)
{
    const double none = (double)NAN;
    dea_window_figures figures = {none, none, none, {none}, {none}};
    trace t;
    for (int k = 0; k < DEA_HARMONICS; k++) {
        figures.amplitude[k] = figures.phase[k] = none;
    }
    const dea_window *at = &scene->transient.averages[window];
    if (!cover(samples, count, at->from, at->to, &t) || !shows(scene, summary, &t)) {
        return figures;
    }
    const double peak = peak_of(samples, count), own = summary->error * peak;
    const double allowed = promised * scene->accuracy * peak;
    double fine[2], coarse[2];
    extremes(&t, fine);
    t.stride = 2;
    extremes(&t, coarse);
    if (fmax(fabs(fine[0] - coarse[0]), fabs(fine[1] - coarse[1])) <= allowed) {
        figures.least = fine[0];
        figures.largest = fine[1];
        figures.range = fine[1] - fine[0];
    }
    t.stride = 1;
    tell_harmonics(scene, &t, allowed, own, &figures);
    return figures;
}
