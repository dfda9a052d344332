/* A sine about an offset. */
#include <math.h>

#include "drive/waves.h"

#define AT(member) offsetof(dea_waveform, sine.member)

static const dea_wave_number numbers[] = {
    DEA_WAVE_VOLTAGE("offset", AT(offset), false, 0.0, "a voltage, e.g. 4000 V"),
    DEA_WAVE_VOLTAGE("amplitude", AT(amplitude), true, (double)NAN, "a voltage, e.g. 100 V"),
    DEA_WAVE_FREQUENCY("frequency", AT(frequency), "a frequency > 0, e.g. 50 Hz"),
    DEA_WAVE_ANGLE("phase", AT(phase)),
    DEA_WAVE_DELAY("delay", AT(delay)),
};

static void lay(struct dea_wave_builder *b, const dea_waveform *wave, double begin, double end)
{
    const dea_sine *sine = &wave->sine;
    const dea_tone tone = {.amplitude = sine->amplitude, .frequency = sine->frequency, .phase = sine->phase};
    const double first = sine->offset + sine->amplitude * sin(sine->phase);
    dea_lay_line(b, begin, fmin(sine->delay, end), first, first);
    dea_lay_tones(b, sine->offset, &tone, 1);
    dea_lay_origin(b, sine->delay);
    dea_lay_curve(b, sine->delay, end);
}

const dea_wave dea_wave_sine = {
    .path = "drive.waveform.sine",
    .accepted = "a mapping with amplitude, frequency, offset, phase and delay, e.g. {amplitude: 100 V, frequency: 50 Hz}",
    .pure = true,
    .numbers = numbers,
    .number_count = sizeof numbers / sizeof *numbers,
    .once = "which has its frequency",
    .lay = lay,
};
