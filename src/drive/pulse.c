/* Pulses of a duty on top of an offset, as of a pulse-width modulated driver: the duty of each period counts from the begin of the
 * rising edge to that of the falling one, so that the mean is offset + duty voltage. */
#include <math.h>
#include <stdio.h>

#include "drive/waves.h"

enum { OFFSET, VOLTAGE, FREQUENCY, DUTY, RISE, DELAY };

static const dea_wave_number numbers[] = {
    [OFFSET] = DEA_WAVE_VOLTAGE("offset", DEA_WAVE_PLACE(OFFSET), false, 0.0, "a voltage, e.g. 500 V"),
    [VOLTAGE] = DEA_WAVE_VOLTAGE("voltage", DEA_WAVE_PLACE(VOLTAGE), true, (double)NAN, "a voltage on top of the offset, e.g. 4500 V"),
    [FREQUENCY] = DEA_WAVE_FREQUENCY("frequency", DEA_WAVE_PLACE(FREQUENCY), "a frequency > 0, e.g. 5 kHz"),
    [DUTY] = {"duty", DEA_WAVE_PLACE(DUTY), "1", 0, 1, false, true, (double)NAN, "a share of the period 0 ... 1, e.g. 0.3"},
    [RISE] = DEA_WAVE_RISE("rise", DEA_WAVE_PLACE(RISE)),
    [DELAY] = DEA_WAVE_DELAY("delay", DEA_WAVE_PLACE(DELAY)),
};

static bool fits(const dea_wave_bounds *b, dea_wave_fault *fault)
{
    const double *low = b->low->numbers, *high = b->high->numbers;
    char accepted[100];
    const double off = high[DUTY] < 1.0 ? 1.0 - high[DUTY] : 1.0, on = low[DUTY] > 0.0 ? low[DUTY] : 1.0;
    const double most = fmin(on, off) / high[FREQUENCY];
    snprintf(accepted, sizeof accepted, "0 s, which is a jump, or 1e-12 s to %.4g s, the shorter part of a period", most);
    return (dea_wave_apart(dea_wave_gap(most, high[RISE]), high[RISE], b->shortest) && (low[RISE] == 0.0 || low[RISE] >= b->shortest)) ||
           dea_wave_blame(fault, &numbers[RISE], "does not fit into the pulses", accepted);
}

static void lay(struct dea_wave_builder *b, const dea_waveform *wave, double begin, double end)
{
    const double *n = wave->numbers;
    const double base = n[OFFSET], top = base + n[VOLTAGE], duty = n[DUTY];
    if (duty == 0.0 || duty == 1.0) {
        const double level = duty > 0.0 ? top : base, on = begin + n[DELAY];
        dea_lay_line(b, begin, on, base, base);
        dea_lay_line(b, on, on + n[RISE], base, level);
        dea_lay_line(b, on + n[RISE], end, level, level);
        return;
    }
    if (!dea_lay_affords(b, (end - begin) * n[FREQUENCY])) {
        return;
    }
    double from = begin;
    for (double i = 0.0; from < end; i++) {
        const double on = begin + n[DELAY] + i / n[FREQUENCY];
        const dea_trapezoid t = {base, n[VOLTAGE], on, duty / n[FREQUENCY], n[RISE]};
        const double to = begin + n[DELAY] + (i + 1.0) / n[FREQUENCY];
        dea_lay_trapezoid(b, &t, from, to);
        from = to;
    }
}

const dea_wave dea_wave_pulse = {
    .path = "drive.waveform.pulse",
    .accepted = "a mapping with voltage, frequency, duty, offset, rise and delay, e.g. {voltage: 4500 V, frequency: 5 kHz, duty: 0.3}",
    .numbers = numbers,
    .number_count = sizeof numbers / sizeof *numbers,
    .once = "which has its frequency",
    .fits = fits,
    .lay = lay,
};
