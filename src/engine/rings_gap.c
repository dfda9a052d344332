#include "engine/rings_gap.h"

#include <float.h>
#include <math.h>
#include <stddef.h>

/* The columns that are compared. */
static const size_t columns[] = {offsetof(dea_sample, displacement), offsetof(dea_sample, velocity), offsetof(dea_sample, force),
                                 offsetof(dea_sample, current),      offsetof(dea_sample, charge),   offsetof(dea_sample, film_voltage),
                                 offsetof(dea_sample, focal_length), offsetof(dea_sample, capacitance)};

const size_t *dea_rings_column(size_t index)
{
    return index < sizeof columns / sizeof *columns ? &columns[index] : NULL;
}

static double at(const dea_sample *sample, size_t offset)
{
    return *(const double *)((const char *)sample + offset);
}

double dea_rings_mean(const dea_scene *scene, const dea_rings_trace *trace, size_t window)
{
    const dea_window *w = &scene->transient.averages[window];
    return trace->integrals[window] / (w->to - w->from);
}

/* True where the film has numbers all over a window. */
static bool covers(const dea_scene *scene, const dea_rings_trace *trace, size_t window)
{
    const double last = trace->count > 0 ? trace->samples[trace->count - 1].time : -1.0;
    return trace->end == DEA_STATE_OK || scene->transient.averages[window].to <= last;
}

/* Largest difference of a column over the samples that both have; NAN counts as none. */
static double column_gap(const dea_rings_trace *a, const dea_rings_trace *b, size_t offset)
{
    const size_t count = a->count < b->count ? a->count : b->count;
    double largest = 0.0;
    for (size_t i = 0; i < count; i++) {
        largest = fmax(largest, fabs(at(&a->samples[i], offset) - at(&b->samples[i], offset)));
    }
    return largest;
}

dea_rings_gap dea_rings_gap_of(const dea_scene *scene, const dea_scales *scales, const dea_rings_trace *a, const dea_rings_trace *b)
{
    const dea_sample scale = dea_scales_of(scales, b->samples, b->count);
    dea_rings_gap g = {0};
    for (size_t c = 0; c < sizeof columns / sizeof *columns; c++) {
        const double apart = column_gap(a, b, columns[c]);
        const double share = apart > 0.0 ? apart / at(&scale, columns[c]) : 0.0;
        g.answer = fmax(g.answer, share / dea_scales_allowance(columns[c]));
    }
    g.displacement = column_gap(a, b, offsetof(dea_sample, displacement)) / fmax(scale.displacement, DBL_MIN);
    for (size_t i = 0; i < scene->transient.average_count; i++) {
        const bool both = covers(scene, a, i) && covers(scene, b, i);
        g.displacement = fmax(g.displacement, both ? fabs(dea_rings_mean(scene, a, i) - dea_rings_mean(scene, b, i)) / scale.displacement : 0.0);
    }
    g.answer = fmax(g.answer, g.displacement);
    g.rates.velocity = column_gap(a, b, offsetof(dea_sample, velocity));
    g.rates.current = column_gap(a, b, offsetof(dea_sample, current));
    return g;
}
