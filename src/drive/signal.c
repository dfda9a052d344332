#include "drive/signal.h"

#include <float.h>
#include <math.h>
#include <stdlib.h>

#include "deaspice/result.h"

/* Most segments of a run: a waveform that repeats more often than this wants shorter runs. */
enum { MOST_SEGMENTS = 8000000 };

/* A corner counts as none where it lies off the line through its neighbours by no more than rounding makes of times and voltages
 * that were written in decimals and in another unit: so many units in the last place of the voltage, and of the time. */
static const double rounding = 8.0 * DBL_EPSILON;

typedef struct builder {
    const dea_scene *scene;
    dea_signal *signal;
    double until;
    size_t room;
    double least, most; /* slopes of a line from the begin of the last segment that pass all corners that it took in [V/s] */
    bool exhausted;
} builder;

/* The range of those slopes with one more corner. */
static void narrow(builder *b, const dea_segment *last, double slope)
{
    const double width = last->to - last->from;
    const double off = rounding * (fmax(fabs(last->start), fabs(last->end)) + fabs(slope) * last->to);
    b->least = fmax(b->least, (last->end - last->start - off) / width);
    b->most = fmin(b->most, (last->end - last->start + off) / width);
}

/* Takes a linear segment into the last one where it goes on on the same line: constant voltages, or a ramp that passes every
 * corner of the ramp before it. */
static bool joins(builder *b, double to, double start, double end)
{
    dea_signal *signal = b->signal;
    dea_segment *last = signal->count > 0 ? &signal->segments[signal->count - 1] : NULL;
    if (!last || last->sine || last->end != start || (last->start == last->end) != (start == end)) {
        return false;
    }
    if (start != end) {
        const double slope = (end - last->start) / (to - last->from);
        narrow(b, last, slope);
        if (!(slope >= b->least && slope <= b->most)) {
            return false;
        }
    }
    last->to = to;
    last->end = end;
    signal->largest = fmax(signal->largest, fabs(end));
    return true;
}

/* An edge that rounding alone keeps off the time of a sample lies there, so that the sample sees what is before the edge. */
static double on_grid(const builder *b, double time)
{
    const double index = round(time / b->scene->transient.every);
    if (!(index >= 0.0 && index < DEA_SAMPLES_MAX)) {
        return time;
    }
    const double sample = dea_layout_place(b->scene, (size_t)index);
    return fabs(sample - time) <= 4.0 * DBL_EPSILON * time ? sample : time;
}

/* Adds a segment, cut at the end of the run. */
static void add(builder *b, double from, double to, double start, double end, bool sine)
{
    dea_signal *signal = b->signal;
    from = on_grid(b, from);
    to = on_grid(b, to);
    if (!(to > from) || from >= b->until || b->exhausted) {
        return;
    }
    if (to > b->until) {
        end = sine ? end : start + (end - start) * ((b->until - from) / (to - from));
        to = b->until;
    }
    if (!sine && joins(b, to, start, end)) {
        return;
    }
    if (signal->count == b->room) {
        const size_t room = b->room ? 2 * b->room : 16;
        dea_segment *more = room <= MOST_SEGMENTS ? realloc(signal->segments, room * sizeof *more) : NULL;
        if (!more) {
            b->exhausted = true;
            return;
        }
        signal->segments = more;
        b->room = room;
    }
    signal->segments[signal->count++] = (dea_segment){from, to, start, end, sine};
    b->least = -INFINITY;
    b->most = INFINITY;
    signal->largest = fmax(signal->largest, fmax(fabs(start), fabs(end)));
}

static void add_step(builder *b, const dea_step *step, double begin, double end)
{
    const double on = begin + step->on;
    const double top = on + step->rise;
    add(b, begin, fmin(on, end), 0.0, 0.0, false);
    add(b, on, top, 0.0, step->voltage, false);
    if (isnan(step->off)) {
        add(b, top, end, step->voltage, step->voltage, false);
        return;
    }
    const double off = begin + step->off;
    const double bottom = off + step->rise;
    add(b, top, off, step->voltage, step->voltage, false);
    add(b, off, bottom, step->voltage, 0.0, false);
    add(b, bottom, end, 0.0, 0.0, false);
}

static void add_points(builder *b, const dea_waveform *wave, double begin, double end)
{
    const double *v = wave->voltages;
    const size_t last = wave->point_count - 1;
    add(b, begin, begin + wave->times[0], v[0], v[0], false);
    for (size_t i = 0; i < last; i++) {
        add(b, begin + wave->times[i], begin + wave->times[i + 1], v[i], v[i + 1], false);
    }
    add(b, begin + wave->times[last], end, v[last], v[last], false);
}

static void add_sine(builder *b, const dea_sine *sine)
{
    const double first = sine->offset + sine->amplitude * sin(sine->phase);
    add(b, 0.0, fmin(sine->delay, b->until), first, first, false);
    if (sine->delay < b->until) {
        dea_signal *signal = b->signal;
        const dea_segment whole = {.from = sine->delay, .to = b->until, .sine = true};
        signal->sine = *sine;
        add(b, whole.from, whole.to, dea_segment_voltage(signal, &whole, whole.from),
            dea_segment_voltage(signal, &whole, whole.to), true);
        signal->largest = fmax(signal->largest, fabs(sine->offset) + fabs(sine->amplitude));
    }
}

/* What repeats is laid out period by period, each begin computed anew so that no rounding adds up. */
static void add_periods(builder *b, const dea_waveform *wave)
{
    const bool once = isnan(wave->period);
    for (size_t i = 0; i == 0 || (!once && (double)i * wave->period < b->until); i++) {
        const double begin = once ? 0.0 : (double)i * wave->period;
        const double end = once ? b->until : (double)(i + 1) * wave->period;
        if (wave->kind == DEA_WAVE_STEP) {
            add_step(b, &wave->step, begin, end);
        } else {
            add_points(b, wave, begin, end);
        }
        if (b->exhausted) {
            return;
        }
    }
}

/* A swept scalar can leave the order that a scene's own numbers were checked for. */
static bool in_order(const dea_waveform *wave)
{
    const dea_step *step = &wave->step;
    const double last = wave->kind == DEA_WAVE_POINTS ? wave->times[wave->point_count - 1] : step->off + step->rise;
    const bool edges = wave->kind != DEA_WAVE_STEP || isnan(step->off) || step->off >= step->on + step->rise;
    return edges && (isnan(wave->period) || wave->kind == DEA_WAVE_SINE || wave->period >= last);
}

dea_status dea_signal_open(const dea_scene *scene, dea_signal *signal, dea_error *error)
{
    const dea_waveform *wave = &scene->drive.waveform;
    builder b = {.scene = scene, .signal = signal, .until = scene->transient.until};
    *signal = (dea_signal){0};
    if (!in_order(wave)) {
        return dea_fail(error, DEA_ERROR_USAGE, "the edges of the waveform are out of order");
    }
    if (wave->kind == DEA_WAVE_SINE) {
        add_sine(&b, &wave->sine);
    } else if (wave->kind != DEA_WAVE_NONE) {
        add_periods(&b, wave);
    }
    if (b.exhausted) {
        return dea_fail(error, DEA_ERROR_MEMORY, "the waveform has too many edges for this run");
    }
    return signal->count > 0 ? DEA_OK : dea_fail(error, DEA_ERROR_USAGE, "the scene has no waveform");
}

void dea_signal_close(dea_signal *signal)
{
    free(signal->segments);
    *signal = (dea_signal){0};
}

/* Phase of the sine, whole turns taken off so that late times keep their digits. */
static double angle(const dea_sine *sine, double time)
{
    const double turns = sine->frequency * (time - sine->delay);
    return 2.0 * DEA_PI * (turns - floor(turns)) + sine->phase;
}

double dea_segment_voltage(const dea_signal *signal, const dea_segment *segment, double time)
{
    if (segment->sine) {
        return signal->sine.offset + signal->sine.amplitude * sin(angle(&signal->sine, time));
    }
    if (segment->start == segment->end || time >= segment->to) {
        return segment->end;
    }
    return segment->start + (segment->end - segment->start) * ((time - segment->from) / (segment->to - segment->from));
}

double dea_segment_voltage_since(const dea_signal *signal, const dea_segment *segment, double since)
{
    if (segment->sine || segment->start == segment->end) {
        return dea_segment_voltage(signal, segment, segment->from + since);
    }
    return segment->start + (segment->end - segment->start) * fmin(since / (segment->to - segment->from), 1.0);
}

double dea_segment_slope(const dea_signal *signal, const dea_segment *segment, double time)
{
    if (segment->sine) {
        const double omega = 2.0 * DEA_PI * signal->sine.frequency;
        return signal->sine.amplitude * omega * cos(angle(&signal->sine, time));
    }
    return (segment->end - segment->start) / (segment->to - segment->from);
}

double dea_segment_curvature(const dea_signal *signal, const dea_segment *segment, double time)
{
    const double omega = 2.0 * DEA_PI * signal->sine.frequency;
    return segment->sine ? -signal->sine.amplitude * omega * omega * sin(angle(&signal->sine, time)) : 0.0;
}

size_t dea_signal_find(const dea_signal *signal, size_t near, double time)
{
    while (near + 1 < signal->count && time > signal->segments[near].to) {
        near++;
    }
    return near;
}
