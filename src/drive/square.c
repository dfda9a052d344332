/* A square wave, offset +- amplitude, its first half period up. Each edge from one to the other takes the rise. */
#include <math.h>
#include <stdio.h>

#include "drive/waves.h"

enum { OFFSET, AMPLITUDE, FREQUENCY, RISE, DELAY };

static const dea_wave_number numbers[] = {
    [OFFSET] = DEA_WAVE_VOLTAGE("offset", DEA_WAVE_PLACE(OFFSET), false, 0.0, "a voltage, e.g. 2 kV"),
    [AMPLITUDE] = DEA_WAVE_VOLTAGE("amplitude", DEA_WAVE_PLACE(AMPLITUDE), true, (double)NAN, "a voltage, e.g. 500 V"),
    [FREQUENCY] = DEA_WAVE_FREQUENCY("frequency", DEA_WAVE_PLACE(FREQUENCY), "a frequency > 0, e.g. 50 Hz"),
    [RISE] = DEA_WAVE_RISE("rise", DEA_WAVE_PLACE(RISE)),
    [DELAY] = DEA_WAVE_DELAY("delay", DEA_WAVE_PLACE(DELAY)),
};

static bool fits(const dea_wave_bounds *b, dea_wave_fault *fault)
{
    const double *low = b->low->numbers, *high = b->high->numbers;
    const double half = 0.5 / high[FREQUENCY];
    char accepted[100];
    snprintf(accepted, sizeof accepted, "0 s, which is a jump, or 1e-12 s to %.4g s, half a period", half);
    return (dea_wave_apart(dea_wave_gap(half, high[RISE]), high[RISE], b->shortest) && (low[RISE] == 0.0 || low[RISE] >= b->shortest)) ||
           dea_wave_blame(fault, &numbers[RISE], "does not fit into half a period", accepted);
}

static void lay(struct dea_wave_builder *b, const dea_waveform *wave, double begin, double end)
{
    const double *n = wave->numbers;
    if (!dea_lay_affords(b, (end - begin) * n[FREQUENCY])) {
        return;
    }
    const double first = begin + n[DELAY];
    double level = n[OFFSET];
    dea_lay_line(b, begin, first, level, level);
    for (double i = 0.0; first + 0.5 * i / n[FREQUENCY] < end; i++) {
        const double from = first + 0.5 * i / n[FREQUENCY];
        const double next = n[OFFSET] + (fmod(i, 2.0) == 0.0 ? n[AMPLITUDE] : -n[AMPLITUDE]);
        dea_lay_line(b, from, from + n[RISE], level, next);
        dea_lay_line(b, from + n[RISE], first + 0.5 * (i + 1.0) / n[FREQUENCY], next, next);
        level = next;
    }
}

const dea_wave dea_wave_square = {
    .path = "drive.waveform.square",
    .accepted = "a mapping with amplitude, frequency, offset, rise and delay, e.g. {offset: 2 kV, amplitude: 500 V, frequency: 50 Hz}",
    .numbers = numbers,
    .number_count = sizeof numbers / sizeof *numbers,
    .once = "which has its frequency",
    .fits = fits,
    .lay = lay,
};
