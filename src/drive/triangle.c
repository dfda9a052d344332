/* A triangle between offset +- amplitude that begins at the offset, upwards; it rises over a share of each period. */
#include <math.h>

#include "drive/waves.h"

enum { OFFSET, AMPLITUDE, FREQUENCY, SYMMETRY, DELAY };

static const dea_wave_number numbers[] = {
    [OFFSET] = DEA_WAVE_VOLTAGE("offset", DEA_WAVE_PLACE(OFFSET), false, 0.0, "a voltage, e.g. 2 kV"),
    [AMPLITUDE] = DEA_WAVE_VOLTAGE("amplitude", DEA_WAVE_PLACE(AMPLITUDE), true, (double)NAN, "a voltage, e.g. 500 V"),
    [FREQUENCY] = DEA_WAVE_FREQUENCY("frequency", DEA_WAVE_PLACE(FREQUENCY), "a frequency > 0, e.g. 1 Hz"),
    [SYMMETRY] = {"symmetry", DEA_WAVE_PLACE(SYMMETRY), "1", 0, 1, true, false, 0.5,
                  "the share of a period in which it rises, > 0 and < 1, e.g. 0.5"},
    [DELAY] = DEA_WAVE_DELAY("delay", DEA_WAVE_PLACE(DELAY)),
};

static void lay(struct dea_wave_builder *b, const dea_waveform *wave, double begin, double end)
{
    const double *n = wave->numbers;
    if (!dea_lay_affords(b, (end - begin) * n[FREQUENCY])) {
        return;
    }
    const double first = begin + n[DELAY], high = n[OFFSET] + n[AMPLITUDE], low = n[OFFSET] - n[AMPLITUDE];
    double from = first;
    dea_lay_line(b, begin, first, n[OFFSET], n[OFFSET]);
    for (double i = 0.0; from < end; i++) {
        const double top = first + (i + 0.5 * n[SYMMETRY]) / n[FREQUENCY];
        const double bottom = first + (i + 1.0 - 0.5 * n[SYMMETRY]) / n[FREQUENCY];
        dea_lay_line(b, from, top, i == 0.0 ? n[OFFSET] : low, high);
        dea_lay_line(b, top, bottom, high, low);
        from = bottom;
    }
}

const dea_wave dea_wave_triangle = {
    .path = "drive.waveform.triangle",
    .accepted = "a mapping with amplitude, frequency, offset, symmetry and delay, e.g. {offset: 2 kV, amplitude: 2 kV, frequency: 1 Hz}",
    .numbers = numbers,
    .number_count = sizeof numbers / sizeof *numbers,
    .once = "which has its frequency",
    .lay = lay,
};
