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

/* Number @p k of an entry as a change from rest. */
static double entry_change(const dea_scene *scene, const double *entry, size_t k)
{
    const double rest = k == DEA_ALONG_RADIAL || k == DEA_ALONG_HOOP ? scene->actuator.prestretch : 0.0;
    return entry[k] - rest;
}

/* Largest difference along the radius, of the number that is worst over its largest change from rest, no less than that of a sample,
 * both stretches over that of the larger one, against what it promises: what a sample does by its displacement, and by its velocity. */
static double along_gap(const dea_scene *scene, const dea_sample *scale, const dea_rings_trace *a, const dea_rings_trace *b)
{
    const size_t count = (a->count < b->count ? a->count : b->count) * scene->transient.points * DEA_SPREAD_COLUMNS;
    double apart[DEA_SPREAD_COLUMNS] = {0.0}, worst = 0.0;
    const double strain = scene->actuator.prestretch * scale->strain;
    double largest[DEA_SPREAD_COLUMNS] = {scale->displacement, scale->velocity, strain, strain};
    for (size_t i = 0; i < count; i++) {
        const size_t k = i % DEA_SPREAD_COLUMNS, entry = i - k;
        apart[k] = fmax(apart[k], fabs(a->entries[i] - b->entries[i]));
        largest[k] = fmax(largest[k], fabs(entry_change(scene, b->entries + entry, k)));
    }
    largest[DEA_ALONG_RADIAL] = largest[DEA_ALONG_HOOP] = fmax(largest[DEA_ALONG_RADIAL], largest[DEA_ALONG_HOOP]);
    for (size_t k = 0; k < DEA_SPREAD_COLUMNS; k++) {
        const double share = apart[k] > 0.0 ? apart[k] / largest[k] : 0.0;
        worst = fmax(worst, share / (k == DEA_ALONG_DISPLACEMENT ? 1.0 : dea_scales_allowance(offsetof(dea_sample, velocity))));
    }
    return worst;
}

dea_rings_gap dea_rings_gap_of(const dea_scene *scene, const dea_scales *scales, const dea_rings_trace *a, const dea_rings_trace *b)
{
    const dea_sample scale = dea_scales_of(scales, b->samples, b->count);
    dea_columns_gap gap = {0};
    for (size_t i = 0; i < b->count; i++) { /* rows of @p b alone count as what it is measured by */
        dea_columns_widen(&gap, i < a->count ? &a->samples[i] : &b->samples[i], &b->samples[i]);
    }
    dea_rings_gap g = {.answer = dea_columns_worst(scales, &gap), .rates = {gap.most.velocity, gap.most.current}};
    g.displacement = gap.most.displacement / fmax(scale.displacement, DBL_MIN);
    for (size_t i = 0; i < scene->transient.average_count; i++) {
        const bool both = covers(scene, a, i) && covers(scene, b, i);
        g.displacement = fmax(g.displacement, both ? fabs(dea_rings_mean(scene, a, i) - dea_rings_mean(scene, b, i)) / scale.displacement : 0.0);
    }
    g.answer = fmax(g.answer, fmax(g.displacement, along_gap(scene, &scale, a, b)));
    return g;
}
