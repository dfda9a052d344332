#include <float.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "deaspice/result.h"
#include "drive/signal.h"

/* Most segments of a run: a waveform that repeats more often than this wants shorter runs. */
enum { MOST_SEGMENTS = 8000000 };

/* A corner counts as none where it lies off the line through its neighbours by no more than rounding makes of times and voltages
 * that were written in decimals and in another unit: so many units in the last place of the voltage, and of the time. */
static const double rounding = 8.0 * DBL_EPSILON;

typedef struct dea_wave_builder {
    const dea_scene *scene;
    dea_signal *signal;
    double until;
    double origin; /* of the curves that come [s] */
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

/* An edge that rounding alone keeps off the end of the run, or off the time of a sample, lies there, so that the sample sees what is
 * before the edge. */
static double on_grid(const builder *b, double time)
{
    if (dea_wave_gap(b->until, time) == 0.0) {
        return b->until;
    }
    const double index = round(dea_layout_index(b->scene, time));
    if (!(index >= 0.0 && index < DEA_SAMPLES_MAX)) {
        return time;
    }
    const double sample = dea_layout_place(b->scene, (size_t)index);
    return fabs(sample - time) <= 4.0 * DBL_EPSILON * time ? sample : time;
}

/* Adds a segment, cut at the end of the run; none that is but the rounding of its ends. */
static void add(builder *b, double from, double to, double start, double end, bool sine)
{
    dea_signal *signal = b->signal;
    from = on_grid(b, from);
    to = on_grid(b, to);
    if (signal->count > 0) {
        dea_segment *last = &signal->segments[signal->count - 1];
        from = last->to;
        /* a sine that ends where it crosses a level ends there but for rounding */
        last->end = last->sine && fabs(last->end - start) <= 1e-12 * signal->largest ? start : last->end;
    }
    if (!(dea_wave_gap(to, from) > 0.0) || from >= b->until || b->exhausted) {
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
    signal->segments[signal->count++] = (dea_segment){.from = from, .to = to, .start = start, .end = end, .sine = sine, .origin = sine ? b->origin : 0.0};
    b->least = -INFINITY;
    b->most = INFINITY;
    signal->largest = fmax(signal->largest, fmax(fabs(start), fabs(end)));
}

bool dea_lay_affords(builder *b, double repeats)
{
    b->exhausted = b->exhausted || !(2.0 * repeats < MOST_SEGMENTS);
    return !b->exhausted;
}

void dea_lay_line(builder *b, double from, double to, double start, double end)
{
    add(b, from, to, start, end, false);
}

void dea_lay_tones(builder *b, double offset, const dea_tone *tones, size_t count)
{
    dea_curve *curve = &b->signal->curve;
    *curve = (dea_curve){.offset = offset, .count = count};
    memcpy(curve->tones, tones, count * sizeof *tones);
}

void dea_lay_origin(builder *b, double origin)
{
    b->origin = origin;
}

void dea_lay_curve(builder *b, double from, double to)
{
    const dea_segment whole = {.from = from, .to = fmin(to, b->until), .sine = true, .origin = b->origin};
    if (whole.from < whole.to) {
        add(b, whole.from, whole.to, dea_segment_voltage(b->signal, &whole, whole.from),
            dea_segment_voltage(b->signal, &whole, whole.to), true);
        b->signal->largest = fmax(b->signal->largest, dea_curve_largest(&b->signal->curve));
    }
}

/* What repeats is laid out period by period, each begin computed anew so that no rounding adds up. */
static void add_periods(builder *b, const dea_wave *kind, const dea_waveform *wave)
{
    const bool once = isnan(wave->period);
    for (size_t i = 0; i == 0 || (!once && (double)i * wave->period < b->until && !b->exhausted); i++) {
        const double begin = once ? 0.0 : (double)i * wave->period;
        kind->lay(b, wave, begin, once ? b->until : (double)(i + 1) * wave->period);
    }
}

/* A swept scalar can leave what a scene's own numbers were checked for. */
static dea_status check_order(const dea_scene *scene, const dea_wave *kind, dea_error *error)
{
    const dea_waveform *wave = &scene->drive.waveform;
    const dea_wave_bounds bounds = {.low = wave, .high = wave, .every = scene->transient.every};
    dea_wave_fault fault = {0};
    double first, last = 0.0, rise;
    if (kind->extent) {
        kind->extent(&bounds, &first, &last, &rise);
    }
    if (!isnan(wave->period) && !(dea_wave_gap(wave->period, last) >= 0.0)) {
        return dea_fail(error, DEA_ERROR_USAGE, "the edges of the waveform are out of order");
    }
    if (kind->fits && !kind->fits(&bounds, &fault)) {
        return dea_fail(error, DEA_ERROR_USAGE, "the edges of the waveform are out of order: %s.%s: %s; accepted: %s", kind->path,
                        fault.number->name, fault.problem, fault.accepted);
    }
    return DEA_OK;
}

dea_status dea_signal_open(const dea_scene *scene, dea_signal *signal, dea_error *error)
{
    const dea_waveform *wave = &scene->drive.waveform;
    const dea_wave *kind = dea_wave_of(wave->kind);
    builder b = {.scene = scene, .signal = signal, .until = scene->transient.until};
    *signal = (dea_signal){0};
    const dea_status status = kind ? check_order(scene, kind, error) : DEA_OK;
    if (status) {
        return status;
    }
    if (kind) {
        add_periods(&b, kind, wave);
    }
    if (b.exhausted) {
        return dea_fail(error, DEA_ERROR_MEMORY, "the waveform has too many edges for this run");
    }
    return signal->count > 0 ? DEA_OK : dea_fail(error, DEA_ERROR_USAGE, "the scene has no waveform");
}

dea_status dea_signal_cut(dea_signal *signal, const double *times, size_t count, dea_error *error)
{
    dea_segment *segments = malloc((signal->count + count) * sizeof *segments);
    size_t made = 0, next = 0;
    if (!segments) {
        return dea_fail(error, DEA_ERROR_MEMORY, "out of memory for the segments of a waveform");
    }
    for (size_t i = 0; i < signal->count; i++) {
        dea_segment part = signal->segments[i];
        const double room = 16.0 * DBL_EPSILON * part.to;
        for (; next < count && times[next] < signal->segments[i].to; next++) {
            if (times[next] > part.from + room && times[next] < part.to - room) {
                const double voltage = dea_segment_voltage(signal, &signal->segments[i], times[next]);
                segments[made] = part;
                segments[made].to = times[next];
                segments[made++].end = voltage;
                part.from = times[next];
                part.start = voltage;
            }
        }
        segments[made++] = part;
    }
    free(signal->segments);
    signal->segments = segments;
    signal->count = made;
    return DEA_OK;
}

void dea_signal_close(dea_signal *signal)
{
    free(signal->segments);
    free(signal->lines);
    free(signal->record);
    free(signal->terms);
    *signal = (dea_signal){0};
}

/* Turns at an age, and the frequency [Hz], whose slope is [Hz/s]. */
static double turns_at(const dea_tone *tone, double age)
{
    return tone->growth == 0.0 ? age * (tone->frequency + 0.5 * tone->rate * age)
                               : tone->frequency * expm1(tone->growth * age) / tone->growth;
}

static double frequency_at(const dea_tone *tone, double age)
{
    return tone->frequency * exp(tone->growth * age) + tone->rate * age;
}

static double sweep_at(const dea_tone *tone, double age)
{
    return tone->growth * tone->frequency * exp(tone->growth * age) + tone->rate;
}

/* Whole turns taken off so that late times keep their digits. */
static double angle_at(const dea_tone *tone, double age)
{
    const double turns = turns_at(tone, age);
    return 2.0 * DEA_PI * (turns - floor(turns)) + tone->phase;
}

dea_tone dea_tone_from(const dea_tone *tone, double age)
{
    dea_tone here = *tone;
    here.phase = angle_at(tone, age);
    here.frequency = frequency_at(tone, age);
    return here;
}

bool dea_curve_is_plain(const dea_curve *curve)
{
    return curve->count == 1 && curve->tones[0].rate == 0.0 && curve->tones[0].growth == 0.0;
}

double dea_curve_largest(const dea_curve *curve)
{
    double sum = fabs(curve->offset);
    for (size_t i = 0; i < curve->count; i++) {
        sum += fabs(curve->tones[i].amplitude);
    }
    return sum;
}

/* Number of the line of a run at a time: from < time <= to. */
static size_t segment_line(const dea_segment *run, double time)
{
    size_t low = 0, high = run->line_count - 1;
    while (low < high) {
        const size_t middle = (low + high) / 2;
        if (time > run->lines[middle].to) {
            low = middle + 1;
        } else {
            high = middle;
        }
    }
    return low;
}

static const dea_segment *line_at(const dea_segment *run, double time)
{
    return &run->lines[segment_line(run, time)];
}

const dea_segment *dea_segment_seen(const dea_segment *segment, double time)
{
    return segment->terms ? line_at(segment, time) : segment;
}

/* sum c_n P_n(x) and, unless NULL, its slope over x: (n + 1) P_n+1 = (2n + 1) x P_n - n P_n-1,  P_n+1' = P_n-1' + (2n + 1) P_n. */
static double legendre(const double *c, double x, double *slope)
{
    double p0 = 1.0, p1 = x, d0 = 0.0, d1 = 1.0, sum = c[0], rise = 0.0;
    for (int n = 1; n < DEA_TERMS; n++) {
        sum += c[n] * p1;
        rise += c[n] * d1;
        const double p2 = ((2 * n + 1) * x * p1 - n * p0) / (n + 1), d2 = d0 + (2 * n + 1) * p1;
        p0 = p1, p1 = p2;
        d0 = d1, d1 = d2;
    }
    if (slope) {
        *slope = rise;
    }
    return sum;
}

double dea_segment_square(const dea_segment *segment, double time)
{
    return legendre(segment->terms, 2.0 * (time - segment->from) / (segment->to - segment->from) - 1.0, NULL);
}

/* Voltage of a segment that stands for lines, and its slope: 0 where the square has fallen to nothing [V], [V/s]. */
static double thinned_voltage(const dea_segment *segment, double time, double *slope)
{
    const double width = segment->to - segment->from;
    const double square = legendre(segment->terms, 2.0 * (time - segment->from) / width - 1.0, slope);
    const double voltage = sqrt(fmax(square, 0.0));
    *slope = voltage > 0.0 ? *slope / (voltage * width) : 0.0; /* d sqrt(s)/dt = s'/(2 U), dx/dt = 2/width */
    return voltage;
}

double dea_segment_voltage(const dea_signal *signal, const dea_segment *segment, double time)
{
    if (segment->terms) {
        double slope;
        return thinned_voltage(segment, time, &slope);
    }
    if (segment->lines) {
        return dea_segment_voltage(signal, line_at(segment, time), time);
    }
    if (segment->sine) {
        double sum = signal->curve.offset;
        for (size_t i = 0; i < signal->curve.count; i++) {
            const dea_tone *tone = &signal->curve.tones[i];
            sum += tone->amplitude * sin(angle_at(tone, time - segment->origin));
        }
        return sum;
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
    if (segment->terms) {
        double slope;
        (void)thinned_voltage(segment, time, &slope);
        return slope;
    }
    segment = segment->lines ? line_at(segment, time) : segment;
    if (segment->sine) {
        double sum = 0.0;
        for (size_t i = 0; i < signal->curve.count; i++) {
            const dea_tone *tone = &signal->curve.tones[i];
            const double age = time - segment->origin, omega = 2.0 * DEA_PI * frequency_at(tone, age);
            sum += tone->amplitude * omega * cos(angle_at(tone, age));
        }
        return sum;
    }
    return (segment->end - segment->start) / (segment->to - segment->from);
}

double dea_segment_curvature(const dea_signal *signal, const dea_segment *segment, double time)
{
    double sum = 0.0;
    for (size_t i = 0; i < signal->curve.count && segment->sine; i++) {
        const dea_tone *tone = &signal->curve.tones[i];
        const double age = time - segment->origin, omega = 2.0 * DEA_PI * frequency_at(tone, age);
        const double angle = angle_at(tone, age);
        sum += tone->amplitude * (2.0 * DEA_PI * sweep_at(tone, age) * cos(angle) - omega * omega * sin(angle));
    }
    return sum;
}

double dea_segment_largest(const dea_signal *signal, const dea_segment *segment)
{
    if (segment->lines) {
        return signal->largest;
    }
    return segment->sine ? dea_curve_largest(&signal->curve) : fmax(fabs(segment->start), fabs(segment->end));
}

/* P_n makes n/2 turns over its width. An error that goes with the square of the steps counts by the size of the term. */
static double thinned_turn(const dea_segment *segment)
{
    const double *terms = segment->terms;
    double turn = 1.0;
    for (int n = 1; n < DEA_TERMS; n++) {
        turn = fmax(turn, n * sqrt(fabs(terms[n] / terms[0])));
    }
    return DEA_PI * turn / (segment->to - segment->from);
}

double dea_segment_turn(const dea_signal *signal, const dea_segment *segment)
{
    if (segment->terms) {
        return thinned_turn(segment);
    }
    double turn = 0.0;
    for (size_t i = 0; i < signal->curve.count && segment->sine; i++) {
        const dea_tone *tone = &signal->curve.tones[i];
        const double first = frequency_at(tone, segment->from - segment->origin);
        const double last = frequency_at(tone, segment->to - segment->origin);
        turn = fmax(turn, 2.0 * DEA_PI * fmax(fabs(first), fabs(last)));
    }
    return turn;
}

size_t dea_signal_find(const dea_signal *signal, size_t near, double time)
{
    while (near + 1 < signal->count && time > signal->segments[near].to) {
        near++;
    }
    return near;
}
