/* The voltage of the source in long double. */
#include <math.h>

#include "drive/signal.h"
#include "truths.h"

static const long double pi = 3.14159265358979323846264338327950288L;

/* Turns of a sine. */
static long double turns_at(const dea_signal *signal, const dea_segment *s, long double time)
{
    const long double turns = (long double)signal->curve.tones[0].frequency * (s->from + time - (long double)s->origin);
    return turns - floorl(turns);
}

long double true_source(const dea_signal *signal, const dea_segment *s, long double time)
{
    const dea_tone *sine = &signal->curve.tones[0];
    if (s->sine) {
        return signal->curve.offset + sine->amplitude * sinl(2.0L * pi * turns_at(signal, s, time) + sine->phase);
    }
    return s->start + ((long double)s->end - s->start) * (time / ((long double)s->to - s->from));
}

long double true_source_slope(const dea_signal *signal, const dea_segment *s, long double time)
{
    const dea_tone *sine = &signal->curve.tones[0];
    if (s->sine) {
        const long double pace = 2.0L * pi * (long double)sine->frequency;
        return sine->amplitude * pace * cosl(2.0L * pi * turns_at(signal, s, time) + sine->phase);
    }
    return ((long double)s->end - s->start) / ((long double)s->to - s->from);
}
