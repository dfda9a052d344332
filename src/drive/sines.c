/* A sum of sines, each about an offset of its own: the offsets add up too. */
#include <math.h>

#include "drive/waves.h"

#define AT(member) offsetof(dea_waveform, sines[0].member)

static const dea_wave_number numbers[] = {
    DEA_WAVE_VOLTAGE("offset", AT(offset), false, 0.0, "a voltage, e.g. 2 kV"),
    DEA_WAVE_VOLTAGE("amplitude", AT(amplitude), true, (double)NAN, "a voltage, e.g. 100 V"),
    DEA_WAVE_FREQUENCY("frequency", AT(frequency), "a frequency > 0, e.g. 50 Hz"),
    DEA_WAVE_ANGLE("phase", AT(phase)),
};

static void lay(struct dea_wave_builder *b, const dea_waveform *wave, double begin, double end)
{
    dea_tone tones[DEA_SINES];
    double offset = 0.0;
    for (size_t i = 0; i < wave->sine_count; i++) {
        const dea_sine *sine = &wave->sines[i];
        offset += sine->offset;
        tones[i] = (dea_tone){.amplitude = sine->amplitude, .frequency = sine->frequency, .phase = sine->phase};
    }
    dea_lay_tones(b, offset, tones, wave->sine_count);
    dea_lay_curve(b, begin, end);
}

const dea_wave dea_wave_sines = {
    .path = "drive.waveform.sines",
    .accepted = "a list of at most 8 sines, e.g. [{offset: 2 kV, amplitude: 300 V, frequency: 50 Hz}, "
                "{amplitude: 100 V, frequency: 120 Hz}]",
    .numbers = numbers,
    .number_count = sizeof numbers / sizeof *numbers,
    .stride = sizeof(dea_sine),
    .once = "which have their frequencies",
    .lay = lay,
};
