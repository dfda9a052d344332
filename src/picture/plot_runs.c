/* Panels of transients, one above the other along time, and of frequency responses: magnitudes above phases. */
#include "picture/figure.h"
#include "study/study.h"

#include <math.h>
#include <stdint.h>
#include <string.h>

enum {
    MAIN = 270,     /* height of the first panel */
    SMALL = 84,     /* of those below it */
    CURRENTS = 130, /* of one with the currents of several runs */
    PHASE = 180     /* of one with phases */
};

/* A film moves by micrometres per volt, whatever a sharp peak comes to. */
static const double most_per_volt = 1e-4; /* [m/V] */

typedef struct sheet {
    const dea_plot *plot;
    const dea_runs *runs;
    dea_series series;
    dea_figure figure;
    size_t quantities[DEA_PANELS]; /* of the panels */
    bool single[DEA_PANELS];       /* every run has the same curve */
    bool peaks[DEA_PANELS];        /* curves are told apart at their peaks, the smaller ones lie above the larger */
    double factor;                 /* along x, from SI to what is drawn */
} sheet;

static bool axis_moves(const dea_scene *scene, size_t from, size_t size)
{
    for (size_t i = 0; i < scene->axis_count; i++) {
        if (scene->axes[i].offset >= from && scene->axes[i].offset < from + size) {
            return true;
        }
    }
    return false;
}

/* Least and largest number of a quantity, low above high where it has none. */
static dea_span range_of(const dea_runs *runs, size_t quantity)
{
    dea_span range = {INFINITY, -INFINITY, false};
    for (size_t run = 0; run < runs->count; run++) {
        const dea_plot_trace *trace = &runs->runs[run].traces[quantity];
        for (size_t i = 0; i < trace->count; i++) {
            dea_span_take(&range, trace->y[i]);
        }
    }
    return range;
}

/* Next panel, for the column at @p offset of the rows, labelled by words and unit, whose prefix goes by @p largest (NAN: by the largest
 * number); NULL where there is nothing to show. */
static dea_panel *panel_add(sheet *page, size_t offset, double tall, const char *words, const char *unit, double largest)
{
    const size_t quantity = dea_runs_find(page->runs, offset);
    const dea_span range = quantity == SIZE_MAX ? (dea_span){1.0, 0.0, false} : range_of(page->runs, quantity);
    char label[DEA_LABEL_LENGTH];
    if (range.low > range.high) {
        return NULL;
    }
    const dea_scale scale = dea_scale_choose(isnan(largest) ? fmax(fabs(range.low), fabs(range.high)) : largest, unit);
    snprintf(label, sizeof label, words, scale.unit);
    page->quantities[page->figure.count] = quantity;
    dea_panel *added = dea_figure_panel(&page->figure, tall, label);
    added->factor = scale.factor;
    added->floats = true;
    added->intervals = 4;
    return added;
}

/* Strain, and displacement on a second axis where all runs have the same edge. */
static void compose_strain(sheet *page)
{
    const dea_scene *scene = page->plot->scene;
    const dea_actuator *actuator = &scene->actuator;
    dea_panel *strain = panel_add(page, offsetof(dea_sample, strain), MAIN, "Strain s [%%]", "1", (double)NAN);
    if (!strain) {
        return;
    }
    strain->factor = 100.0;
    strain->zero = true;
    strain->intervals = 6;
    const bool moves = axis_moves(scene, offsetof(dea_scene, actuator.frame_radius), sizeof(double)) ||
                       axis_moves(scene, offsetof(dea_scene, actuator.coverage), sizeof(double)) ||
                       axis_moves(scene, offsetof(dea_scene, actuator.divide_radius), sizeof(double));
    const double radius = isnan(actuator->coverage) ? actuator->divide_radius : actuator->coverage * actuator->frame_radius;
    const dea_span range = range_of(page->runs, page->quantities[0]);
    const dea_scale scale = dea_scale_choose(radius * fmax(fabs(range.low), fabs(range.high)), "m");
    strain->second = moves ? 0.0 : scale.factor * radius / strain->factor;
    snprintf(strain->second_label, sizeof strain->second_label, "Displacement u [%s]", scale.unit);
}

static void compose_transient(sheet *page, bool logarithmic)
{
    static const struct {
        size_t offset;
        const char *words, *unit;
        bool zero, peaks;
    } further[] = {{offsetof(dea_sample, voltage), "U [%s]", "V", true, false},
                   {offsetof(dea_sample, current), "i [%s]", "A", true, true},
                   {offsetof(dea_sample, film_voltage), "film U [%s]", "V", true, false},
                   {offsetof(dea_sample, focal_length), "f [%s]", "m", false, false}};
    const dea_scene *scene = page->plot->scene;
    compose_strain(page);
    for (size_t i = 0; i < sizeof further / sizeof *further; i++) {
        const double tall = further[i].peaks && page->runs->count > 1 ? CURRENTS : SMALL;
        dea_panel *panel = panel_add(page, further[i].offset, tall, further[i].words, further[i].unit, (double)NAN);
        if (panel) {
            panel->zero = further[i].zero;
            page->peaks[page->figure.count - 1] = further[i].peaks;
            page->single[page->figure.count - 1] = further[i].offset == offsetof(dea_sample, voltage) &&
                                                   !axis_moves(scene, offsetof(dea_scene, drive.waveform), sizeof scene->drive.waveform);
        }
    }
    for (size_t i = 0; logarithmic && i < page->figure.count; i++) {
        if (i == 0 || page->peaks[i]) {
            page->figure.panels[i].span.logarithmic = true;
            page->figure.panels[i].absolute = range_of(page->runs, page->quantities[i]).low < 0.0;
        }
    }
}

/* A magnitude and the phase below it. */
static void compose_pair(sheet *page, size_t magnitude, size_t phase, const char *words, const char *unit, bool per_volt)
{
    const size_t quantity = dea_runs_find(page->runs, magnitude);
    const double largest = quantity == SIZE_MAX ? 0.0 : fmax(0.0, range_of(page->runs, quantity).high);
    dea_panel *upper = panel_add(page, magnitude, MAIN, words, unit, per_volt ? fmin(largest, most_per_volt) : 1.0);
    if (!upper) {
        return;
    }
    upper->span.logarithmic = largest > 0.0; /* without a bias nothing moves */
    upper->name = per_volt ? dea_name_plain : dea_name_prefixed;
    upper->whole = true;
    upper->intervals = 6;
    dea_panel *lower = panel_add(page, phase, PHASE, "Phase [°]", "1", 1.0);
    if (lower) {
        lower->step = 45.0;
    }
}

/* Place of the largest magnitude of a curve. */
static size_t peak_of(const dea_plot_trace *trace)
{
    size_t peak = 0;
    for (size_t i = 0; i < trace->count; i++) {
        peak = fabs(trace->y[i]) > fabs(trace->y[peak]) || isnan(trace->y[peak]) ? i : peak;
    }
    return peak;
}

/* The curve of a run on a panel, with the symbols of its group. */
static void add_trace(sheet *page, size_t number, size_t run)
{
    const dea_plot_trace *trace = &page->runs->runs[run].traces[page->quantities[number]];
    const size_t peak = peak_of(trace), group = run % page->series.groups;
    const bool single = page->single[number];
    const dea_look look = single ? (dea_look){.colour = "#404040", .dash = 1} : dea_series_look(&page->series, run / page->series.groups, group);
    int before = INT32_MIN;
    dea_figure_curve(&page->figure, number, look, single ? 1.2 : 1.6);
    for (size_t i = 0; i < trace->count; i++) {
        const double x = trace->x[i] * page->factor;
        unsigned marks = 0;
        if (isfinite(trace->y[i]) && look.symbol && (x > 0.0 || !page->figure.across[0].span.logarithmic)) {
            const double share = page->runs->abscissa > 0 ? (double)i / (double)trace->count : dea_span_share(&page->figure.across[0].span, x);
            const int place = dea_series_mark(&page->series, group, share);
            marks = (page->peaks[number] ? i == peak : before != INT32_MIN && place != before) ? DEA_AT_SYMBOL : 0;
            before = place;
        }
        dea_figure_point(&page->figure, x, trace->y[i], marks);
    }
}

/* The limits that a run passes, on the first panel. */
static void add_limits(sheet *page, size_t run)
{
    const dea_run *marked = &page->runs->runs[run];
    dea_look look = dea_series_look(&page->series, run / page->series.groups, run % page->series.groups);
    look.symbol = 0;
    dea_figure_curve(&page->figure, 0, look, 0.0);
    for (size_t i = 0; i < marked->spot_count; i++) {
        dea_figure_point(&page->figure, marked->spots[i].x * page->factor, marked->spots[i].y, (unsigned)DEA_AT_LIMIT << marked->spots[i].mark);
    }
}

/* Runs as they come or, where they are told apart at their peaks, the larger ones first. */
static void add_traces(sheet *page, size_t number)
{
    double peaks[DEA_CURVES_MAX];
    size_t order[DEA_CURVES_MAX];
    for (size_t i = 0; i < page->runs->count; i++) {
        const dea_plot_trace *trace = &page->runs->runs[i].traces[page->quantities[number]];
        const double peak = page->peaks[number] && trace->count > 0 ? fabs(trace->y[peak_of(trace)]) : 0.0;
        size_t place = i;
        for (; place > 0 && peak > peaks[place - 1]; place--) {
            peaks[place] = peaks[place - 1];
            order[place] = order[place - 1];
        }
        peaks[place] = peak;
        order[place] = i;
    }
    for (size_t i = 0; i < (page->single[number] ? 1 : page->runs->count); i++) {
        add_trace(page, number, order[i]);
    }
}

/* Loops lie along the voltages of all runs. */
static void measure_loops(sheet *page)
{
    dea_span span = {INFINITY, -INFINITY, false};
    for (size_t run = 0; run < page->runs->count; run++) {
        const dea_plot_trace *trace = &page->runs->runs[run].traces[0];
        for (size_t i = 0; i < trace->count; i++) {
            dea_span_take(&span, trace->x[i]);
        }
    }
    const dea_scale scale = dea_scale_choose(fmax(fabs(span.low), fabs(span.high)), "V");
    page->factor = scale.factor;
    snprintf(page->figure.across[0].label, sizeof page->figure.across[0].label, "Voltage U [%s]", scale.unit);
    dea_span_take(&page->figure.across[0].span, page->factor * span.low);
    dea_span_take(&page->figure.across[0].span, page->factor * span.high);
}

/* What lies along x: frequency, or time, from the first row after zero where it is logarithmic. */
static void measure_along(sheet *page, bool response)
{
    const dea_scene *scene = page->plot->scene;
    dea_figure *figure = &page->figure;
    const double first = dea_layout_place(scene, 0), last = dea_layout_place(scene, page->runs->layout.rows - 1);
    const bool plain = response || figure->across[0].span.logarithmic;
    const dea_scale scale = plain ? (dea_scale){.factor = 1.0, .unit = "s"} : dea_scale_choose(last, "s");
    page->factor = scale.factor;
    figure->across[0].name = response ? dea_name_prefixed : dea_name_plain;
    snprintf(figure->across[0].label, sizeof figure->across[0].label, response ? "Frequency [Hz]" : "Time [%s]", scale.unit);
    dea_span_take(&figure->across[0].span, scale.factor * (figure->across[0].span.logarithmic && !(first > 0.0) ? dea_layout_place(scene, 1) : first));
    dea_span_take(&figure->across[0].span, scale.factor * last);
}

/* The curves of all panels, then the limits on the first, and what they are. */
static void fill(sheet *page)
{
    for (size_t i = 0; i < page->figure.count; i++) {
        add_traces(page, i);
    }
    for (size_t run = 0; run < page->runs->count; run++) {
        add_limits(page, run);
    }
    page->figure.foot = dea_series_legend(&page->series, page->figure.seen, page->plot->picture.canvas.width, &page->figure.legend);
}

dea_status dea_plot_draw_runs(dea_plot *plot, dea_error *error)
{
    const dea_scene *scene = plot->scene;
    const bool response = dea_study_of(scene)->phasors;
    const bool logarithmic = plot->picture.log_x || response || scene->transient.logarithmic;
    sheet page = {.plot = plot,
                  .runs = &plot->runs,
                  .series = dea_series_of(scene, SIZE_MAX, plot->runs.count / scene->model_count),
                  .figure = dea_figure_begin(&plot->picture, plot->scene->title, logarithmic && !plot->loops)};
    page.figure.series = &page.series;
    if (plot->loops) {
        measure_loops(&page);
    } else {
        measure_along(&page, response);
    }
    size_t second = SIZE_MAX;
    if (response) {
        compose_pair(&page, offsetof(dea_response, displacement), offsetof(dea_response, displacement_phase),
                     "Displacement per volt [%s/V]", "m", true);
        second = page.figure.count;
        compose_pair(&page, offsetof(dea_response, impedance), offsetof(dea_response, impedance_phase), "Impedance [%s]", "Ohm", false);
    } else {
        compose_transient(&page, plot->picture.log_y);
    }
    if (page.figure.count == 0 || page.quantities[0] != 0) {
        return dea_fail(error, DEA_ERROR_USAGE, "nothing to draw: no run has an equilibrium");
    }
    fill(&page);
    return dea_figure_end(&page.figure, dea_figure_stack(&page.figure, second, error), error);
}
