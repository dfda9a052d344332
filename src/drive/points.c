/* Straight lines between points, from a list or a file. */

#include "drive/waves.h"

static void extent(const dea_wave_bounds *b, double *first, double *last, double *rise)
{
    *first = 0.0;
    *last = b->low->times[b->low->point_count - 1];
    *rise = 1.0; /* the edge of the next period is a corner */
}

static void lay(struct dea_wave_builder *b, const dea_waveform *wave, double begin, double end)
{
    const double *v = wave->voltages;
    const size_t last = wave->point_count - 1;
    dea_lay_line(b, begin, begin + wave->times[0], v[0], v[0]);
    for (size_t i = 0; i < last; i++) {
        dea_lay_line(b, begin + wave->times[i], begin + wave->times[i + 1], v[i], v[i + 1]);
    }
    dea_lay_line(b, begin + wave->times[last], end, v[last], v[last]);
}

const dea_wave dea_wave_points = {
    .path = "drive.waveform.points",
    .alias = "file",
    .accepted = "a list of [time, voltage], e.g. [[0 s, 0 V], [5 s, 4500 V]]",
    .until = "at least the last time of the points",
    .extent = extent,
    .lay = lay,
};
