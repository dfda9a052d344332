/* Some cycles of a sine, then its offset; with a period again. */
#include <math.h>

#include "drive/waves.h"

enum { OFFSET, AMPLITUDE, FREQUENCY, CYCLES, DELAY };

static const dea_wave_number numbers[] = {
    [OFFSET] = DEA_WAVE_VOLTAGE("offset", DEA_WAVE_PLACE(OFFSET), false, 0.0, "a voltage, e.g. 2 kV"),
    [AMPLITUDE] = DEA_WAVE_VOLTAGE("amplitude", DEA_WAVE_PLACE(AMPLITUDE), true, (double)NAN, "a voltage, e.g. 500 V"),
    [FREQUENCY] = DEA_WAVE_FREQUENCY("frequency", DEA_WAVE_PLACE(FREQUENCY), "a frequency > 0, e.g. 200 Hz"),
    [CYCLES] = {"cycles", DEA_WAVE_PLACE(CYCLES), "1", 0, INFINITY, true, true, (double)NAN, "a number of half cycles, e.g. 5 or 0.5"},
    [DELAY] = DEA_WAVE_DELAY("delay", DEA_WAVE_PLACE(DELAY)),
};

/* It ends where it crosses the offset. */
static bool fits(const dea_wave_bounds *b, dea_wave_fault *fault)
{
    const double low = 2.0 * b->low->numbers[CYCLES], high = 2.0 * b->high->numbers[CYCLES];
    return (low == floor(low) && high == floor(high)) ||
           dea_wave_blame(fault, &numbers[CYCLES], "does not end at the offset", "whole and half numbers, e.g. 5 or 0.5");
}

static void extent(const dea_wave_bounds *b, double *first, double *last, double *rise)
{
    const double *low = b->low->numbers, *high = b->high->numbers;
    *first = low[DELAY];
    *last = high[DELAY] + high[CYCLES] / low[FREQUENCY];
    *rise = 1.0 / high[FREQUENCY];
}

static void lay(struct dea_wave_builder *b, const dea_waveform *wave, double begin, double end)
{
    const double *n = wave->numbers;
    const double first = begin + n[DELAY], last = first + n[CYCLES] / n[FREQUENCY];
    const dea_tone tone = {.amplitude = n[AMPLITUDE], .frequency = n[FREQUENCY]};
    dea_lay_line(b, begin, first, n[OFFSET], n[OFFSET]);
    dea_lay_tones(b, n[OFFSET], &tone, 1);
    dea_lay_origin(b, first);
    dea_lay_curve(b, first, fmin(last, end));
    dea_lay_line(b, last, end, n[OFFSET], n[OFFSET]);
}

const dea_wave dea_wave_burst = {
    .path = "drive.waveform.burst",
    .accepted = "a mapping with amplitude, frequency, cycles, offset and delay, e.g. {amplitude: 500 V, frequency: 200 Hz, cycles: 5}",
    .numbers = numbers,
    .number_count = sizeof numbers / sizeof *numbers,
    .until = "a time >= delay + cycles/frequency",
    .fits = fits,
    .extent = extent,
    .lay = lay,
};
