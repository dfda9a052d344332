/* A sine whose frequency runs from one value to another, by equal steps or by equal factors in equal times; held at its last value
 * behind that. */
#include <math.h>
#include <stdio.h>

#include "drive/signal.h"
#include "drive/waves.h"

enum { OFFSET, AMPLITUDE, FROM, TO, DURATION, PHASE, DELAY };
/* As on an axis; the long word is taken too. */
enum { LINEAR, LOG, LOGARITHMIC };

static const char *const spacings[] = {[LINEAR] = "linear", [LOG] = "log", [LOGARITHMIC] = "logarithmic", NULL};

static const dea_wave_number numbers[] = {
    [OFFSET] = DEA_WAVE_VOLTAGE("offset", DEA_WAVE_PLACE(OFFSET), false, 0.0, "a voltage, e.g. 2 kV"),
    [AMPLITUDE] = DEA_WAVE_VOLTAGE("amplitude", DEA_WAVE_PLACE(AMPLITUDE), true, (double)NAN, "a voltage, e.g. 500 V"),
    [FROM] = DEA_WAVE_FREQUENCY("from", DEA_WAVE_PLACE(FROM), "a frequency > 0, e.g. 10 Hz"),
    [TO] = DEA_WAVE_FREQUENCY("to", DEA_WAVE_PLACE(TO), "a frequency > 0, e.g. 1 kHz"),
    [DURATION] = {"duration", DEA_WAVE_PLACE(DURATION), "s", 0, INFINITY, true, true, (double)NAN, "a time > 0, e.g. 2 s"},
    [PHASE] = DEA_WAVE_ANGLE("phase", DEA_WAVE_PLACE(PHASE)),
    [DELAY] = DEA_WAVE_DELAY("delay", DEA_WAVE_PLACE(DELAY)),
};

/* A chirp whose samples alias tells nothing: refused from half the rate of the samples on. */
static bool fits(const dea_wave_bounds *b, dea_wave_fault *fault)
{
    const double *high = b->high->numbers;
    const size_t at = high[TO] >= high[FROM] ? TO : FROM;
    char accepted[100];
    snprintf(accepted, sizeof accepted, "at most %.6g Hz, half the rate of the samples, or a shorter study.transient.every",
             0.5 / b->every);
    return 2.0 * high[at] * b->every <= 1.0 + 1e-12 ||
           dea_wave_blame(fault, &numbers[at], "past what the samples resolve", accepted);
}

static void lay(struct dea_wave_builder *b, const dea_waveform *wave, double begin, double end)
{
    const double *n = wave->numbers;
    const double first = begin + n[DELAY], last = first + n[DURATION];
    const bool even = wave->choice == LINEAR;
    const dea_tone tone = {.amplitude = n[AMPLITUDE],
                           .frequency = n[FROM],
                           .phase = n[PHASE],
                           .rate = even ? (n[TO] - n[FROM]) / n[DURATION] : 0.0,
                           .growth = even ? 0.0 : log(n[TO] / n[FROM]) / n[DURATION]};
    const double start = n[OFFSET] + n[AMPLITUDE] * sin(n[PHASE]);
    const double held = n[OFFSET] + n[AMPLITUDE] * sin(dea_tone_from(&tone, n[DURATION]).phase);
    dea_lay_line(b, begin, first, start, start);
    dea_lay_tones(b, n[OFFSET], &tone, 1);
    dea_lay_origin(b, first);
    dea_lay_curve(b, first, fmin(last, end));
    dea_lay_line(b, last, end, held, held);
}

const dea_wave dea_wave_chirp = {
    .path = "drive.waveform.chirp",
    .accepted = "a mapping with amplitude, from, to, duration, spacing, offset, phase and delay, e.g. {offset: 2 kV, amplitude: 500 V, "
                "from: 10 Hz, to: 1 kHz, duration: 2 s}",
    .numbers = numbers,
    .number_count = sizeof numbers / sizeof *numbers,
    .word = "spacing",
    .words = spacings,
    .choices = "linear, log",
    .once = "which runs once",
    .fits = fits,
    .lay = lay,
};
