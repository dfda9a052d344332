/* A record is many short lines whose corners are small, a pulse-width modulated driver many edges: one segment of them costs an
 * integrator the steps that what it holds takes, where a segment each would cost a start each. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "drive/signal.h"

/* A corner counts as small up to this share of the accuracy: the change of slope times the length of the shorter line, over the
 * largest voltage; what a step that passes it leaves out is an eighth of that at most. */
static const double small = 0.1;

/* Lengths of two lines that meet in a small corner: the longer over the shorter; and fewest lines that are worth a run. */
static const double alike = 4.0;
enum { FEWEST = 8 };

/* Lines that one step may pass: a step of the methods at hand looks at some eight places. */
static const double passed = 16.0;

static double slope_of(const dea_segment *s)
{
    return (s->end - s->start) / (s->to - s->from);
}

/* Marks the corner at the end of a line that the next one follows; shortens *step where it is small. */
static void mark(dea_segment *line, const dea_segment *next, double limit, double *step)
{
    const double first = line->to - line->from, second = next->to - next->from;
    const double low = fmin(first, second), high = fmax(first, second);
    line->corner = fabs(slope_of(next) - slope_of(line)) * low > limit || high > alike * low;
    if (!line->corner && (*step == 0.0 || passed * low < *step)) {
        *step = passed * low;
    }
}

/* Lines from number @p first on that make one run, and the longest step through it: lines that are short, whatever their
 * corners, or others with small corners alone. */
static size_t run_of(dea_segment *s, size_t all, size_t first, double limit, double shorter, double *step)
{
    const bool corners = s[first].to - s[first].from <= shorter;
    size_t count = 1;
    *step = 0.0;
    while (first + count < all) {
        dea_segment *last = &s[first + count - 1];
        const dea_segment *next = last + 1;
        const bool alike_long = (next->to - next->from <= shorter) == corners;
        if (last->sine || next->sine || last->end != next->start || !alike_long) {
            break;
        }
        mark(last, next, limit, step);
        if (last->corner && !corners) {
            break;
        }
        count++;
    }
    return count;
}

dea_status dea_signal_soften(dea_signal *signal, double accuracy, double shorter, dea_error *error)
{
    dea_segment *lines = malloc(signal->count * sizeof *lines);
    const size_t all = signal->count;
    const double limit = small * accuracy * signal->largest;
    if (!lines) {
        return dea_fail(error, DEA_ERROR_MEMORY, "out of memory for the lines of a waveform");
    }
    memcpy(lines, signal->segments, all * sizeof *lines);
    signal->count = 0;
    signal->lines = lines;
    for (size_t i = 0, count; i < all; i += count) {
        double step;
        count = run_of(lines, all, i, limit, shorter, &step);
        const dea_segment run = {.from = lines[i].from,
                                 .to = lines[i + count - 1].to,
                                 .start = lines[i].start,
                                 .end = lines[i + count - 1].end,
                                 .sine = true,
                                 .lines = &lines[i],
                                 .line_count = count,
                                 .step = step,
                                 .corner = lines[i].to - lines[i].from <= shorter};
        for (size_t k = 0; count < FEWEST && k < count; k++) {
            signal->segments[signal->count++] = lines[i + k];
        }
        if (count >= FEWEST) {
            signal->segments[signal->count++] = run;
        }
    }
    return DEA_OK;
}
