/* Transients of a membrane: runs at tighter tolerances on finer meshes, until two of them show that the answer is good enough. */
#include <float.h>
#include <math.h>
#include <stddef.h>
#include <stdlib.h>

#include "engine/ida/rings_flight.h"
#include "result/scales.h"
#include "support/lapack.h"

enum { MOST_RUNS = 6 };

static const double first_tolerance = 0.05; /* of the accuracy */
static const double first_share = 0.2;      /* from one tolerance to the next */
static const double doubt = 1.5;            /* most that the error of the better of two runs is taken for, over their difference */
static const double smooth_enough = 1.0;    /* of smoothness over the spacing of the nodes */
static const double gains_nothing = 0.5;    /* a difference that falls by less than that stays too large */
static const double least_tolerance = 3e-12; /* what rounding of the stiffest nodes leaves */
static const double certain = 1e-7; /* an end of the motion counts from this tolerance on */

/* A study of one scene. */
typedef struct search {
    const dea_sundials *sun;
    const dea_scene *scene;
    const dea_model *model;
    const dea_signal *signal;
    dea_scales scales;
    dea_rings_trace traces[2]; /* owned samples and entries: of the run before, and of the last */
    dea_rings_flight *flight;  /* owned: of the last */
    dea_layout layout;
    size_t rows, entries; /* of the layout; numbers that a row tells over the radius */
    double loosest, coverage;
    double worst; /* error that the last run is left with, of the column that is worst against what it promises [1] */
} search;

/* What two runs differ by. */
typedef struct gap {
    double answer;         /* of the column that is worst against what it promises, times its allowance [1] */
    double displacement;   /* of displacement and its means, over their peaks [1] */
    dea_rate_errors rates; /* of velocity and current */
} gap;

/* The columns that are compared. */
static const size_t columns[] = {offsetof(dea_sample, displacement), offsetof(dea_sample, velocity), offsetof(dea_sample, force),
                                 offsetof(dea_sample, current),      offsetof(dea_sample, charge),   offsetof(dea_sample, film_voltage),
                                 offsetof(dea_sample, focal_length)};

static double at(const dea_sample *sample, size_t offset)
{
    return *(const double *)((const char *)sample + offset);
}

static double mean(const search *s, const dea_rings_trace *trace, size_t window)
{
    const dea_window *w = &s->scene->transient.averages[window];
    return trace->integrals[window] / (w->to - w->from);
}

/* True where the film has numbers all over a window. */
static bool covers(const search *s, const dea_rings_trace *trace, size_t window)
{
    const double last = trace->count > 0 ? trace->samples[trace->count - 1].time : -1.0;
    return trace->end == DEA_STATE_OK || s->scene->transient.averages[window].to <= last;
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

/* Number @p k of an entry as a change from rest. */
static double entry_change(const search *s, const double *entry, size_t k)
{
    const double rest = k == DEA_ALONG_RADIAL || k == DEA_ALONG_HOOP ? s->scene->actuator.prestretch : 0.0;
    return entry[k] - rest;
}

/* Largest difference along the radius, of the number that is worst over its largest change from rest, no less than that of a sample,
 * both stretches over that of the larger one, against what it promises: what a sample does by its displacement, and by its velocity. */
static double along_gap(const search *s, const dea_sample *scale)
{
    const dea_rings_trace *a = &s->traces[0], *b = &s->traces[1];
    const size_t count = (a->count < b->count ? a->count : b->count) * s->entries;
    double apart[DEA_SPREAD_COLUMNS] = {0.0}, worst = 0.0;
    const double strain = s->scene->actuator.prestretch * scale->strain;
    double largest[DEA_SPREAD_COLUMNS] = {scale->displacement, scale->velocity, strain, strain};
    for (size_t i = 0; i < count; i++) {
        const size_t k = i % DEA_SPREAD_COLUMNS, entry = i - k;
        apart[k] = fmax(apart[k], fabs(a->entries[i] - b->entries[i]));
        largest[k] = fmax(largest[k], fabs(entry_change(s, b->entries + entry, k)));
    }
    largest[DEA_ALONG_RADIAL] = largest[DEA_ALONG_HOOP] = fmax(largest[DEA_ALONG_RADIAL], largest[DEA_ALONG_HOOP]);
    for (size_t k = 0; k < DEA_SPREAD_COLUMNS; k++) {
        const double share = apart[k] > 0.0 ? apart[k] / largest[k] : 0.0;
        worst = fmax(worst, share / (k == DEA_ALONG_DISPLACEMENT ? 1.0 : dea_scales_allowance(offsetof(dea_sample, velocity))));
    }
    return worst;
}

static gap difference(const search *s)
{
    const dea_rings_trace *a = &s->traces[0], *b = &s->traces[1];
    const dea_sample scale = dea_scales_of(&s->scales, b->samples, b->count);
    gap g = {0};
    for (size_t c = 0; c < sizeof columns / sizeof *columns; c++) {
        const double apart = column_gap(a, b, columns[c]);
        const double share = apart > 0.0 ? apart / at(&scale, columns[c]) : 0.0;
        g.answer = fmax(g.answer, share / dea_scales_allowance(columns[c]));
    }
    g.displacement = column_gap(a, b, offsetof(dea_sample, displacement)) / fmax(scale.displacement, DBL_MIN);
    for (size_t i = 0; i < s->scene->transient.average_count; i++) {
        const bool both = covers(s, a, i) && covers(s, b, i);
        g.displacement = fmax(g.displacement, both ? fabs(mean(s, a, i) - mean(s, b, i)) / scale.displacement : 0.0);
    }
    g.answer = fmax(fmax(g.answer, g.displacement), s->entries > 0 ? along_gap(s, &scale) : 0.0);
    g.rates.velocity = column_gap(a, b, offsetof(dea_sample, velocity));
    g.rates.current = column_gap(a, b, offsetof(dea_sample, current));
    return g;
}

/* ---- meshes. Every kink of the voltage sends a wave out. Where damper and charging smooth it over more than the time that it takes
 * between two nodes, every node more cuts the error of the mesh by one factor; else it falls with a power of their number. */

/* Coverage below which the annulus, much longer than its inner radius, has its nodes even in ln R. */
static const double small_disc = 0.1;

static const double resolved = 0.25; /* of the root of a front's width, over the spacing of nodes that follow it */

/* What charge that comes in from the rim of a resistive electrode is smooth over by the first sample: sqrt(4 D t) with D = 1/(c rho),
 * over the radius. Nodes lie closer to the rim by their number squared. */
static double front_of(const search *s)
{
    const dea_scene *scene = s->scene;
    const double both = scene->electrode.sheet_resistance * (4.0 * scene->actuator.layers - 2.0) / (scene->actuator.layers * scene->actuator.layers);
    const double spreading = both * s->flight->motion.rest.capacitance / DEA_PI; /* c rho r_a^2 [s] */
    return s->flight->membrane.sheet.places > 0 ? resolved * sqrt(sqrt(4.0 * scene->transient.every / spreading)) : INFINITY;
}

/* Time over which all waves are smooth, over the time that one takes from centre to frame [1]. */
static double smoothness(const search *s)
{
    const dea_membrane *m = &s->flight->membrane;
    const dea_dynamics *d = &m->film;
    const double crossing = 3.83 / s->flight->motion.rest.slowest; /* J1(3.83) = 0 at the frame */
    const double charging = d->series * s->flight->motion.rest.capacitance;
    return fmin(front_of(s), m->heavy ? fmax(2.0 * DEA_PI * d->retardation, charging) / crossing : INFINITY);
}

/* Share of the nodes that an element takes that is so long, of two. */
static size_t degree_of(double nodes, double length, double least)
{
    return (size_t)fmin(DEA_RINGS_DEGREE, fmax(least, ceil(nodes * (0.4 + 1.2 * length))));
}

static dea_rings_mesh mesh_of(const search *s, double nodes)
{
    const double coverage = s->coverage;
    return (dea_rings_mesh){degree_of(nodes, coverage, 3.0), degree_of(nodes, 1.0 - coverage, 3.0), coverage < small_disc};
}

/* Nodes of an element for a first run. */
static double first_nodes(const search *s)
{
    const double digits = -log10(s->scene->accuracy);
    return 2.5 + 1.45 * digits;
}

/* One run on a mesh of its own, which takes the place of the last. */
static dea_status run_on(search *s, dea_rings_mesh mesh, double tolerance, dea_summary *summary, dea_error *error)
{
    const dea_rings_trace before = s->traces[1];
    s->traces[1] = s->traces[0];
    s->traces[0] = before;
    dea_rings_flight_close(s->flight);
    const dea_status status = dea_rings_flight_open(s->sun, s->scene, s->model, s->signal, mesh, s->flight, error);
    if (status != DEA_OK) {
        return status;
    }
    s->flight->loosest = s->loosest;
    dea_rings_flight_run(s->flight, tolerance, &s->traces[1], summary);
    if (dea_rings_flight_fit(s->flight)) {
        dea_rings_flight_run(s->flight, tolerance, &s->traces[1], summary);
    }
    return DEA_OK;
}

/* What the error of the better of two runs is taken for, over their difference, and by how much more nodes it has: where the film is
 * not smooth the errors of both are alike. */
static double trust_of(const search *s, double nodes)
{
    return smoothness(s) * nodes > smooth_enough ? 0.75 : doubt;
}

static double finer(const search *s, double nodes)
{
    return smoothness(s) * nodes > smooth_enough ? nodes + 2.0 : 1.5 * nodes;
}

/* Leaves the better run of the last two in traces[1]; *good false where the accuracy was not reached. */
static dea_status refine(search *s, dea_summary *summary, dea_rate_errors *rates, bool *good, dea_error *error)
{
    const double accuracy = s->scene->accuracy;
    double tolerance = s->loosest = first_tolerance * accuracy, nodes = first_nodes(s), last = INFINITY;
    *good = false;
    dea_rings_mesh mesh = mesh_of(s, nodes);
    dea_status status = run_on(s, mesh, tolerance, NULL, error);
    for (int i = 0; i < MOST_RUNS && status == DEA_OK && s->traces[1].end != DEA_STATE_FAILED; i++) {
        const dea_rings_mesh before = mesh;
        nodes = finer(s, nodes);
        mesh = mesh_of(s, nodes);
        if (mesh.disc == before.disc || mesh.annulus == before.annulus) {
            return status; /* what both have alike tells nothing about itself */
        }
        tolerance = fmax(first_share * tolerance, least_tolerance);
        *summary = dea_summary_failed();
        status = run_on(s, mesh, tolerance, summary, error);
        if (status != DEA_OK) {
            return status;
        }
        const gap apart = difference(s);
        const double trust = trust_of(s, nodes);
        const bool doubtful = s->traces[1].end == DEA_STATE_PULL_IN && tolerance > certain;
        const bool comparable = s->traces[0].count == s->traces[1].count;
        summary->error = fmax(apart.displacement * trust, fmax(10.0 * tolerance, 0.1 * accuracy));
        *rates = (dea_rate_errors){apart.rates.velocity * trust, apart.rates.current * trust};
        s->worst = fmax(apart.answer * trust, 10.0 * tolerance);
        *good = s->worst <= accuracy && comparable && !doubtful;
        const bool fronts = s->flight->membrane.sheet.places > 0; /* what lies between the nodes converges late, and then fast */
        const bool hopeless = comparable && !(apart.answer < gains_nothing * last) && !fronts;
        if (*good || s->traces[1].end == DEA_STATE_FAILED || hopeless) {
            return status;
        }
        last = comparable ? apart.answer : INFINITY;
    }
    return status;
}

/* Rows of a trace; where it ended, all that follow are refused. */
static void fill(const search *s, const dea_rings_trace *trace, bool good, dea_sample *samples)
{
    size_t near = 0;
    for (size_t i = 0; i < s->rows; i++) {
        double *entries = s->entries > 0 ? dea_layout_entry(&s->layout, samples, i, 0) : NULL;
        for (size_t k = 0; k < s->entries; k++) {
            entries[k] = good && i < trace->count ? trace->entries[i * s->entries + k] : (double)NAN;
        }
        if (good && i < trace->count) {
            samples[i] = trace->samples[i];
            continue;
        }
        const double time = dea_layout_place(s->scene, i);
        near = dea_signal_find(s->signal, near, time);
        const double voltage = dea_segment_voltage(s->signal, &s->signal->segments[near], time);
        samples[i] = dea_sample_refused(time, voltage, good ? trace->end : DEA_STATE_FAILED);
    }
}

static void tell_averages(const search *s, const dea_rings_trace *trace, dea_summary *summary)
{
    for (size_t i = 0; i < s->scene->transient.average_count; i++) {
        const double u = mean(s, trace, i);
        summary->averages[i] = (dea_average){u / s->flight->membrane.film.radius, u};
    }
}

/* The peak of the current, where two runs agree about it within ten times the accuracy. */
static void tell_peak(const search *s, dea_summary *summary)
{
    const dea_peak *a = &s->traces[0].peak, *b = &s->traces[1].peak;
    if (s->flight->peaks && s->traces[1].end == DEA_STATE_OK &&
        fabs(a->current - b->current) <= 10.0 * s->scene->accuracy * b->current) {
        summary->peak_current = b->current;
        summary->peak_time = b->time;
    }
}

static void explain(const search *s, const dea_summary *summary, dea_error *error)
{
    const dea_rings_flight *f = s->flight;
    if (f->why.message[0] != '\0') {
        dea_fail(error, DEA_ERROR_ENGINE, "%s", f->why.message);
    } else {
        dea_fail(error, DEA_ERROR_ENGINE,
                 "%zu nodes and %ld steps of SUNDIALS at a tolerance of %.1g leave an error of %.1g, the scene wants %g: waves of a "
                 "film without much damping get steep; a rise of the voltage and a damper (material.retardation) smooth them%s",
                 f->membrane.rings.node_count, f->steps, f->tolerance, fmax(s->worst, summary->error), s->scene->accuracy,
                 f->membrane.sheet.places > 0 ? "; charge lies close to the rim of so resistive an electrode "
                                                "(electrode.sheet_resistance), the closer the denser the samples" : "");
    }
}

static dea_status fly(search *s, dea_sample *samples, dea_summary *summary, dea_error *error)
{
    dea_rate_errors rates = {0.0, 0.0};
    bool good;
    if (s->scene->electrode.sheet_resistance > 0.0 && !(s->scene->drive.series_resistance > 0.0) && dea_peak_jumps(s->scene, s->signal)) {
        dea_fail(error, DEA_ERROR_ENGINE, "behind a jump of the voltage nothing bounds the current into the rim of the electrode "
                                          "(electrode.sheet_resistance): give the waveform a rise, or the drive a series_resistance");
        fill(s, &s->traces[1], false, samples);
        return DEA_OK;
    }
    const dea_status status = refine(s, summary, &rates, &good, error);
    if (status != DEA_OK) {
        return status;
    }
    if (!good) {
        explain(s, summary, error);
    }
    fill(s, &s->traces[1], good, samples);
    tell_averages(s, &s->traces[1], summary);
    dea_scales_tell(&s->scales, s->traces[1].samples, s->traces[1].count, rates, summary);
    tell_peak(s, summary);
    return DEA_OK;
}

static dea_status search_open(search *s, dea_error *error)
{
    const dea_actuator *actuator = &s->scene->actuator;
    s->layout = dea_layout_of(s->scene);
    s->rows = s->layout.rows;
    s->entries = s->layout.spread_points * s->layout.spread_count;
    s->coverage = isnan(actuator->divide_radius) ? actuator->coverage : actuator->divide_radius / actuator->frame_radius;
    s->scales = dea_scales_open(s->scene, s->model);
    s->flight = calloc(1, sizeof *s->flight);
    bool room = s->flight && s->scales.status != DEA_ERROR_MEMORY;
    for (int i = 0; i < 2; i++) {
        s->traces[i].samples = malloc(s->rows * sizeof *s->traces[i].samples);
        s->traces[i].entries = s->entries > 0 ? malloc(s->rows * s->entries * sizeof *s->traces[i].entries) : NULL;
        room = room && s->traces[i].samples && (s->traces[i].entries || s->entries == 0);
    }
    return room ? DEA_OK : dea_fail(error, DEA_ERROR_MEMORY, "out of memory for %zu samples", s->rows);
}

static void search_close(search *s)
{
    if (s->flight) {
        dea_rings_flight_close(s->flight);
    }
    free(s->flight);
    for (int i = 0; i < 2; i++) {
        free(s->traces[i].samples);
        free(s->traces[i].entries);
    }
}

dea_status dea_rings_transient_solve(const dea_sundials *sun, const dea_scene *scene, const dea_model *model, dea_sample *samples,
                                     dea_summary *summary, dea_error *error)
{
    dea_signal signal;
    *summary = dea_summary_failed();
    dea_status status = dea_lapack_load(error);
    if (status != DEA_OK) {
        return status;
    }
    status = dea_signal_open(scene, &signal, error);
    search s = {.sun = sun, .scene = scene, .model = model, .signal = &signal};
    if (status == DEA_OK) {
        status = search_open(&s, error);
        if (status == DEA_OK) {
            status = fly(&s, samples, summary, error);
        }
        search_close(&s);
    }
    dea_signal_close(&signal);
    return status;
}
