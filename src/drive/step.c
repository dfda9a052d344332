/* A step up, and perhaps down again. */
#include <math.h>

#include "drive/waves.h"

#define AT(member) offsetof(dea_waveform, step.member)

enum { ON, OFF, VOLTAGE, RISE };

static const dea_wave_number numbers[] = {
    [ON] = {"on", AT(on), "s", 0, INFINITY, false, true, (double)NAN, "a time >= 0, e.g. 5 s"},
    [OFF] = {"off", AT(off), "s", 0, INFINITY, true, false, (double)NAN, "a time >= on + rise, e.g. 15 s"},
    [VOLTAGE] = DEA_WAVE_VOLTAGE("voltage", AT(voltage), true, (double)NAN, "a voltage, e.g. 4500 V"),
    [RISE] = DEA_WAVE_RISE("rise", AT(rise)),
};

static bool fits(const dea_wave_bounds *b, dea_wave_fault *fault)
{
    const dea_step *low = &b->low->step, *high = &b->high->step;
    if (!(low->rise == 0.0 || low->rise >= b->shortest)) {
        return dea_wave_blame(fault, &numbers[RISE], "two edges closer than 1e-12 s", "0 s, which is a jump, or at least 1e-12 s");
    }
    const double gap = dea_wave_gap(low->off, high->on + high->rise);
    if (isnan(low->off) || dea_wave_apart(gap, high->rise, b->shortest)) {
        fault->period = !isnan(b->low->period) && isnan(low->off);
        return !fault->period || dea_wave_blame(fault, &numbers[OFF], "missing; a step with a period goes off again",
                                                "a time >= on + rise, e.g. 15 s");
    }
    return dea_wave_blame(fault, &numbers[OFF], gap < 0.0 ? "out of range" : "two edges closer than 1e-12 s",
                          "a time >= on + rise, where rise is 1 us unless given");
}

static void extent(const dea_wave_bounds *b, double *first, double *last, double *rise)
{
    *first = b->low->step.on;
    *rise = b->high->step.rise;
    *last = b->high->step.off + *rise;
}

static void lay(struct dea_wave_builder *b, const dea_waveform *wave, double begin, double end)
{
    const dea_step *step = &wave->step;
    const double on = begin + step->on, top = on + step->rise;
    dea_lay_line(b, begin, fmin(on, end), 0.0, 0.0);
    dea_lay_line(b, on, top, 0.0, step->voltage);
    if (isnan(step->off)) {
        dea_lay_line(b, top, end, step->voltage, step->voltage);
        return;
    }
    const double off = begin + step->off, bottom = off + step->rise;
    dea_lay_line(b, top, off, step->voltage, step->voltage);
    dea_lay_line(b, off, bottom, step->voltage, 0.0);
    dea_lay_line(b, bottom, end, 0.0, 0.0);
}

const dea_wave dea_wave_step = {
    .path = "drive.waveform.step",
    .accepted = "a mapping with on, off, voltage and rise, e.g. {on: 5 s, off: 15 s, voltage: 4500 V}",
    .settles = true,
    .numbers = numbers,
    .number_count = sizeof numbers / sizeof *numbers,
    .until = "a time >= off + rise, where rise is 1 us unless given",
    .fits = fits,
    .extent = extent,
    .lay = lay,
};
