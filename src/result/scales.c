#include "result/scales.h"

#include <math.h>
#include <stddef.h>

#include "network/rings_mesh.h"

static const double missed = 0.01;  /* share of what the largest voltage does at rest below which a peak counts as that */
static const double promised = 10.0; /* accuracies, of what follows from displacement and charge */

double dea_scales_allowance(size_t offset)
{
    return offset == offsetof(dea_sample, displacement) || offset == offsetof(dea_sample, strain) ? 1.0 : promised;
}

/* The film at rest, whatever its nodes. */
typedef struct rest {
    double length;      /* displacement under the largest voltage [m] */
    double force;       /* F_DEA under it [N] */
    double capacitance; /* [F] */
    double motional;    /* C' U_max [A s/m] */
    double swing;       /* sqrt(m/K), the branches held [s], 0 without mass */
    double drag;        /* r/K of a load [s] */
} rest;

static rest rest_of_edge(dea_dynamics *d, double largest)
{
    const double still = isnan(d->rest) ? 0.0 : d->rest;
    const dea_edge e = dea_dynamics_edge(d, still);
    const double held = dea_dynamics_stiffness(d, still, 0.0, false);
    return (rest){.length = dea_dynamics_scale(d, largest),
                  .force = fabs(e.push) * largest * largest,
                  .capacitance = e.capacitance,
                  .motional = fabs(e.capacitance_slope) * largest,
                  .swing = d->mass > 0.0 && held > 0.0 ? sqrt(d->mass / held) : 0.0,
                  .drag = held > 0.0 ? d->damping / held : 0.0};
}

/* Time in which the film answers a jump; *creep: only by its branches, of those that are not held [s]. */
static double answer_time(const dea_dynamics *d, const rest *film, bool *creep)
{
    const double time = fmax(fmax(d->series * film->capacitance, film->swing), d->retardation + film->drag);
    *creep = !(time > 0.0);
    if (*creep) {
        double rate = 0.0;
        for (size_t i = 0; i < d->branch_count; i++) {
            rate += d->branches[i].share / (1.0 + d->total_share) / d->branches[i].tau;
        }
        return rate > 0.0 ? 1.0 / rate : (double)INFINITY;
    }
    return time;
}

/* Change of the voltage within a segment over the largest one, and its time. */
static double change_within(const dea_signal *signal, const dea_segment *segment, double *width)
{
    if (segment->sine) {
        *width = 1.0 / dea_segment_turn(signal, segment);
        return (dea_curve_largest(&signal->curve) - fabs(signal->curve.offset)) / signal->largest;
    }
    *width = segment->to - segment->from;
    return fabs(segment->end - segment->start) / signal->largest;
}

/* 1/T; @p follows: what changes with the voltage itself does so at once, and a jump of it is no rate. */
static double pace_of(const dea_signal *signal, double first, double time, bool follows)
{
    double pace = 1.0 / signal->segments[signal->count - 1].to, before = first;
    for (size_t i = 0; i < signal->count; i++) {
        const dea_segment *segment = &signal->segments[i];
        double width;
        const double change = change_within(signal, segment, &width);
        const double jump = fabs(segment->start - before) / signal->largest;
        pace = fmax(pace, fmax(jump / time, change / (follows ? width : fmax(width, time))));
        before = segment->end;
    }
    return pace;
}

static void set_least(dea_scales *scales, const dea_dynamics *d, const rest *film, double largest)
{
    const double u = missed * film->length;
    scales->least = (dea_sample){.displacement = u,
                                 .strain = u / d->radius,
                                 .force = missed * film->force,
                                 .charge = missed * film->capacitance * largest,
                                 .film_voltage = missed * largest,
                                 .capacitance = film->capacitance,
                                 .focal_length = missed * fmax(0.0, d->focal_length)};
}

static void set_rates(dea_scales *scales, const dea_dynamics *d, const rest *film, const dea_signal *signal, double first)
{
    const double largest = signal->largest;
    bool creeps;
    const double answer = answer_time(d, film, &creeps);
    /* of a jump of the largest voltage, which a source at its limit takes longer for */
    const double charging = fmax(d->series, largest / d->limit) * film->capacitance;
    scales->pace = pace_of(signal, first, answer, creeps);
    scales->charging = pace_of(signal, first, charging > 0.0 ? charging : (double)INFINITY, !(charging > 0.0));
    scales->motional = film->motional;
}

/* The dynamics, and of the film at rest what the scales need. */
static dea_status look_at_film(const dea_scene *scene, const dea_model *model, double largest, dea_dynamics *d, rest *film)
{
    if (model->membrane) {
        dea_membrane membrane;
        dea_membrane_rest at;
        const dea_status status = dea_membrane_open(scene, model, dea_rings_usual_mesh(scene), &membrane, NULL);
        *d = membrane.film;
        if (status == DEA_OK && dea_membrane_at_rest(&membrane, &at)) {
            const double longest = fmin(d->radius, d->point.frame_radius - d->radius);
            *film = (rest){fmin(longest, at.compliance * largest * largest), at.force * largest * largest, at.capacitance,
                           at.capacitance_slope * largest, at.slowest > 0.0 ? 1.0 / at.slowest : 0.0, 0.0};
        }
        return status;
    }
    const dea_status status = dea_dynamics_open(scene, model, d, NULL);
    if (status == DEA_OK) {
        *film = rest_of_edge(d, largest);
    }
    return status;
}

dea_scales dea_scales_open(const dea_scene *scene, const dea_model *model)
{
    dea_scene full = *scene; /* borrows what the scene owns */
    dea_dynamics dynamics = {0};
    dea_signal signal = {0};
    dea_scales scales = {0};
    rest film = {0};
    full.reduction = (dea_reduction){0};
    scales.status = dea_signal_open(scene, &signal, NULL);
    if (scales.status == DEA_OK) {
        scales.status = look_at_film(&full, model, signal.largest, &dynamics, &film);
    }
    if (scales.status == DEA_OK && signal.largest > 0.0) {
        set_least(&scales, &dynamics, &film, signal.largest);
        set_rates(&scales, &dynamics, &film, &signal, scene->transient.from_bias ? signal.segments[0].start : 0.0);
    }
    dea_signal_close(&signal);
    dea_dynamics_close(&dynamics);
    return scales;
}

/* 0 / 0 = 0: what neither moves nor charges has no error. */
static double share(double error, double scale)
{
    return error > 0.0 ? error / scale : 0.0;
}

/* The columns that are measured. */
static const size_t columns[] = {offsetof(dea_sample, displacement), offsetof(dea_sample, strain),       offsetof(dea_sample, velocity),
                                 offsetof(dea_sample, force),        offsetof(dea_sample, current),      offsetof(dea_sample, charge),
                                 offsetof(dea_sample, focal_length), offsetof(dea_sample, film_voltage), offsetof(dea_sample, capacitance)};
enum { COLUMNS = sizeof columns / sizeof *columns };

static double *column(dea_sample *sample, size_t index)
{
    return (double *)((char *)sample + columns[index]);
}

static double value(const dea_sample *sample, size_t index)
{
    return *(const double *)((const char *)sample + columns[index]);
}

/* Rates are measured by what they would be in the run's fastest time too. */
static dea_sample scale_of(const dea_scales *scales, const dea_sample *largest)
{
    dea_sample peak = scales->least;
    for (size_t c = 0; c < COLUMNS; c++) {
        *column(&peak, c) = fmax(value(&peak, c), value(largest, c));
    }
    peak.velocity = fmax(peak.velocity, peak.displacement * scales->pace);
    peak.current =
        fmax(peak.current, peak.charge * scales->charging + scales->motional * peak.displacement * scales->pace);
    return peak;
}

/* fmax drops the NAN of rows without numbers. */
static void see_peaks(dea_sample *peak, const dea_sample *sample)
{
    for (size_t c = 0; c < COLUMNS; c++) {
        *column(peak, c) = fmax(value(peak, c), fabs(value(sample, c)));
    }
}

dea_sample dea_scales_of(const dea_scales *scales, const dea_sample *samples, size_t count)
{
    dea_sample largest = {0};
    for (size_t i = 0; i < count; i++) {
        see_peaks(&largest, &samples[i]);
    }
    return scale_of(scales, &largest);
}

void dea_columns_widen(dea_columns_gap *gap, const dea_sample *a, const dea_sample *b)
{
    for (size_t c = 0; c < COLUMNS; c++) {
        *column(&gap->most, c) = fmax(value(&gap->most, c), fabs(value(a, c) - value(b, c)));
    }
    see_peaks(&gap->peak, b);
}

double dea_columns_worst(const dea_scales *scales, const dea_columns_gap *gap)
{
    const dea_sample scale = scale_of(scales, &gap->peak);
    double worst = 0.0;
    for (size_t c = 0; c < COLUMNS; c++) {
        worst = fmax(worst, share(value(&gap->most, c), value(&scale, c)) / dea_scales_allowance(columns[c]));
    }
    return worst;
}

void dea_scales_tell(const dea_scales *scales, const dea_sample *samples, size_t count, dea_rate_errors errors, double least,
                     dea_summary *summary)
{
    const dea_sample scale = dea_scales_of(scales, samples, count);
    const bool port = count > 0 && !isnan(samples[0].current);
    summary->velocity_error = fmax(share(errors.velocity, scale.velocity), least);
    summary->current_error = port ? fmax(share(errors.current, scale.current), least) : (double)NAN;
}
