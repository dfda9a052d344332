/* The kinds of waveform: one row and one file each. */
#include <float.h>
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "drive/waves.h"

static const dea_wave *const waves[] = {
    [DEA_WAVE_STEP] = &dea_wave_step,     [DEA_WAVE_POINTS] = &dea_wave_points,     [DEA_WAVE_SINE] = &dea_wave_sine,
    [DEA_WAVE_PULSE] = &dea_wave_pulse,   [DEA_WAVE_SQUARE] = &dea_wave_square,     [DEA_WAVE_TRIANGLE] = &dea_wave_triangle,
    [DEA_WAVE_CHIRP] = &dea_wave_chirp,   [DEA_WAVE_BURST] = &dea_wave_burst,       [DEA_WAVE_SINES] = &dea_wave_sines,
};

const dea_wave *dea_wave_of(dea_wave_kind kind)
{
    const size_t index = (size_t)kind;
    return index < sizeof waves / sizeof *waves ? waves[index] : NULL;
}

const char *dea_wave_name(const dea_wave *wave)
{
    return strrchr(wave->path, '.') + 1;
}

double *dea_wave_at(const dea_wave *wave, dea_waveform *waveform, size_t index, size_t entry)
{
    return (double *)(void *)((char *)waveform + wave->numbers[index].offset + entry * wave->stride);
}

dea_waveform dea_waveform_none(void)
{
    const double none = (double)NAN;
    dea_waveform waveform = {.step = {none, none, none, none}, .sine = {none, none, none, none, none}, .period = none};
    for (size_t i = 0; i < DEA_SINES; i++) {
        waveform.sines[i] = waveform.sine;
    }
    for (size_t i = 0; i < DEA_WAVE_NUMBERS; i++) {
        waveform.numbers[i] = none;
    }
    return waveform;
}

bool dea_wave_blame(dea_wave_fault *fault, const dea_wave_number *number, const char *problem, const char *accepted)
{
    fault->number = number;
    fault->problem = problem;
    snprintf(fault->accepted, sizeof fault->accepted, "%s", accepted);
    return false;
}

double dea_wave_gap(double to, double from)
{
    const double gap = to - from;
    return fabs(gap) <= 4.0 * DBL_EPSILON * fabs(to) ? 0.0 : gap;
}

bool dea_wave_apart(double gap, double rise, double shortest)
{
    return (gap >= shortest && gap >= 0.0) || (gap == 0.0 && rise > 0.0);
}
