/* Panels of transients, one above the other along time, and of frequency responses: magnitudes above phases. */
#include "output/label.h"
#include "output/picture.h"

#include <math.h>
#include <stdint.h>
#include <string.h>

enum {
    WIDTH = 960,
    LEFT = 82,
    RIGHT = 86,      /* behind a panel with a second axis */
    MAIN = 270,      /* height of the first panel */
    SMALL = 84,      /* of those below it */
    GAP = 18,        /* between panels */
    LABELS = 58,     /* below the last panel */
    HALF_LEFT = 578, /* of a panel in the right half */
    HALF_WIDTH = 358
};

typedef struct panel {
    size_t quantity;
    dea_box box;
    bool bottom;      /* carries the labels along x */
    bool single;      /* every run has the same curve */
    bool logarithmic; /* along y */
    bool zero;        /* shows zero */
    int intervals;    /* of its tics, about */
    double factor;    /* from SI to what is drawn */
    double second;    /* second axis: its numbers over the drawn ones, 0: none */
    char label[DEA_LABEL_LENGTH], second_label[DEA_LABEL_LENGTH];
    double step; /* of its tics, 0: as it comes */
} panel;

typedef struct sheet {
    const dea_runs *runs;
    dea_series series;
    panel panels[DEA_RUNS_QUANTITIES];
    size_t count;
    bool response; /* frequency response, else transient */
    double across; /* factor along x */
    int height;
    bool seen[DEA_MARKS];
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

static bool has_numbers(const dea_runs *runs, size_t quantity)
{
    for (size_t i = 0; i < runs->count; i++) {
        for (size_t k = 0; k < runs->runs[i].traces[quantity].count; k++) {
            if (isfinite(runs->runs[i].traces[quantity].y[k])) {
                return true;
            }
        }
    }
    return false;
}

/* Next panel, for the column at @p offset of the rows; NULL where there is nothing to show. */
static panel *panel_add(sheet *page, size_t offset)
{
    const size_t quantity = dea_runs_find(page->runs, offset);
    if (quantity == SIZE_MAX || !has_numbers(page->runs, quantity)) {
        return NULL;
    }
    panel *added = &page->panels[page->count++];
    *added = (panel){.quantity = quantity, .factor = 1.0, .intervals = 6};
    return added;
}

/* Strain, and displacement on a second axis where all runs have the same edge. */
static void compose_strain(sheet *page)
{
    const dea_scene *scene = page->series.scene;
    const dea_actuator *actuator = &scene->actuator;
    panel *strain = panel_add(page, offsetof(dea_sample, strain));
    if (!strain) {
        return;
    }
    strain->factor = 100.0;
    strain->zero = true;
    snprintf(strain->label, sizeof strain->label, "Strain s [%%]");
    const bool moves = axis_moves(scene, offsetof(dea_scene, actuator.frame_radius), sizeof(double)) ||
                       axis_moves(scene, offsetof(dea_scene, actuator.coverage), sizeof(double)) ||
                       axis_moves(scene, offsetof(dea_scene, actuator.divide_radius), sizeof(double));
    const double radius = isnan(actuator->coverage) ? actuator->divide_radius : actuator->coverage * actuator->frame_radius;
    const dea_scale scale = dea_scale_choose(radius * dea_runs_largest(page->runs, strain->quantity), "m");
    strain->second = moves ? 0.0 : scale.factor * radius / strain->factor;
    snprintf(strain->second_label, sizeof strain->second_label, "Displacement u [%s]", scale.unit);
}

static void compose_small(sheet *page, size_t offset, const char *words, const char *unit, bool single, bool zero)
{
    panel *small = panel_add(page, offset);
    if (small) {
        const dea_scale scale = dea_scale_choose(dea_runs_largest(page->runs, small->quantity), unit);
        small->factor = scale.factor;
        small->single = single;
        small->zero = zero;
        small->intervals = 3;
        snprintf(small->label, sizeof small->label, "%s [%s]", words, scale.unit);
    }
}

static void compose_transient(sheet *page)
{
    const dea_scene *scene = page->series.scene;
    const bool same = !axis_moves(scene, offsetof(dea_scene, drive.waveform), sizeof scene->drive.waveform);
    compose_strain(page);
    compose_small(page, offsetof(dea_sample, voltage), "U", "V", same, true);
    compose_small(page, offsetof(dea_sample, current), "i", "A", false, true);
    compose_small(page, offsetof(dea_sample, focal_length), "f", "m", false, false);
    double top = *scene->title ? DEA_TITLE : DEA_NO_TITLE;
    for (size_t i = 0; i < page->count; i++) {
        const double height = i == 0 ? MAIN : SMALL;
        page->panels[i].box = (dea_box){LEFT, top, WIDTH - LEFT - RIGHT, height};
        page->panels[i].bottom = i + 1 == page->count;
        top += height + GAP;
    }
    page->height = (int)top - GAP + LABELS;
}

/* A magnitude and the phase below it; false where there is nothing to show. */
static bool compose_pair(sheet *page, size_t magnitude, size_t phase, const char *words, const char *unit)
{
    panel *upper = panel_add(page, magnitude);
    if (!upper) {
        return false;
    }
    upper->logarithmic = dea_runs_largest(page->runs, upper->quantity) > 0.0; /* without a bias nothing moves */
    snprintf(upper->label, sizeof upper->label, "%s [%s]", words, unit);
    panel *lower = panel_add(page, phase);
    if (lower) {
        lower->step = 45.0;
        snprintf(lower->label, sizeof lower->label, "Phase [°]");
    }
    (lower ? lower : upper)->bottom = true;
    return true;
}

static void compose_response(sheet *page)
{
    const double top = *page->series.scene->title ? DEA_TITLE : DEA_NO_TITLE;
    compose_pair(page, offsetof(dea_response, displacement), offsetof(dea_response, displacement_phase), "Displacement per volt",
                 "m/V");
    const size_t left = page->count;
    compose_pair(page, offsetof(dea_response, impedance), offsetof(dea_response, impedance_phase), "Impedance", "Ω");
    const bool halves = left > 0 && page->count > left;
    for (size_t i = 0; i < page->count; i++) {
        const bool right = halves && i >= left, lower = i != 0 && i != left;
        page->panels[i].box = (dea_box){right ? HALF_LEFT : LEFT, lower ? top + MAIN + GAP : top,
                                        halves ? HALF_WIDTH : WIDTH - LEFT - RIGHT, lower ? MAIN * 2.0 / 3.0 : MAIN};
    }
    page->height = (int)top + MAIN + GAP + MAIN * 2 / 3 + LABELS;
}

static void write_trace(const sheet *page, FILE *script, size_t run, size_t number)
{
    const panel *part = &page->panels[number];
    const dea_plot_trace *trace = &page->runs->runs[run].traces[part->quantity];
    fprintf(script, "$run%zu_%zu << END\n", run, number);
    for (size_t i = 0; i < trace->count; i++) {
        dea_gnuplot_number(script, trace->x[i] * page->across);
        fputc(' ', script);
        dea_gnuplot_number(script, part->logarithmic && !(trace->y[i] > 0.0) ? (double)NAN : trace->y[i] * part->factor);
        fputc('\n', script);
    }
    fputs("END\n", script);
}

/* Marks of one kind on the first panel, in a block that is never empty. */
static void write_spots(const sheet *page, FILE *script, size_t run, size_t mark)
{
    const dea_run *marked = &page->runs->runs[run];
    fprintf(script, "$spots%zu_%zu << END\nNaN NaN\n", run, mark);
    for (size_t i = 0; i < marked->spot_count; i++) {
        const dea_spot *spot = &marked->spots[i];
        if (spot->mark == mark) {
            dea_gnuplot_number(script, spot->x * page->across);
            fputc(' ', script);
            dea_gnuplot_number(script, spot->y * page->panels[0].factor);
            fputc('\n', script);
        }
    }
    fputs("END\n", script);
}

static void write_data(const sheet *page, FILE *script)
{
    for (size_t run = 0; run < page->runs->count; run++) {
        for (size_t i = 0; i < page->count; i++) {
            write_trace(page, script, run, i);
        }
        for (size_t mark = 0; mark < DEA_MARKS; mark++) {
            write_spots(page, script, run, mark);
        }
    }
}

static void write_curves(const sheet *page, FILE *script, size_t number)
{
    const panel *part = &page->panels[number];
    const size_t groups = page->series.groups;
    char colour[8] = "#404040";
    for (size_t run = 0; run < (part->single ? 1 : page->runs->count); run++) {
        if (!part->single) {
            dea_series_colour(&page->series, run / groups, run % groups, colour);
        }
        fprintf(script, "%s$run%zu_%zu using 1:2 with lines ", run > 0 ? ", \\\n " : "plot ", run, number);
        dea_plot_dash(script, part->single ? 1 : run / groups + 1);
        fprintf(script, " linewidth %s linecolor '%s' notitle", part->single ? "1.2" : "1.6", colour);
    }
    for (size_t i = 0; number == 0 && i < page->runs->count * DEA_MARKS; i++) {
        const size_t run = i / DEA_MARKS, mark = i % DEA_MARKS;
        if (page->seen[mark]) {
            dea_series_colour(&page->series, run / groups, run % groups, colour);
            fprintf(script, ", \\\n $spots%zu_%zu using 1:2 with points pointtype %d pointsize 0.8 linecolor '#ffffff' notitle",
                    run, mark, dea_marks[mark].inside);
            fprintf(script,
                    ", \\\n $spots%zu_%zu using 1:2 with points pointtype %d pointsize 0.7 linewidth 1.3 linecolor '%s' notitle",
                    run, mark, dea_marks[mark].symbol, colour);
        }
    }
    fputc('\n', script);
}

/* Smallest of 1, 2, 5 times a power of ten that is not below @p least. */
static double step_choose(double least)
{
    const double power = pow(10.0, floor(log10(least)));
    const double rest = least / power;
    return power * (rest <= 1.0 ? 1.0 : rest <= 2.0 ? 2.0 : rest <= 5.0 ? 5.0 : 10.0);
}

/* What a linear panel shows, from and to, a flat curve in its middle. */
static void panel_range(const sheet *page, const panel *part, double *low, double *high)
{
    *low = part->zero ? 0.0 : (double)INFINITY;
    *high = -*low;
    for (size_t run = 0; run < page->runs->count; run++) {
        const dea_plot_trace *trace = &page->runs->runs[run].traces[part->quantity];
        for (size_t i = 0; i < trace->count; i++) {
            *low = isfinite(trace->y[i]) ? fmin(*low, trace->y[i] * part->factor) : *low;
            *high = isfinite(trace->y[i]) ? fmax(*high, trace->y[i] * part->factor) : *high;
        }
    }
    if (!(*high > *low)) {
        const double pad = fabs(*low) > 0.0 ? 0.1 * fabs(*low) : 1.0;
        *low -= pad;
        *high += pad;
    }
}

static void write_second_axis(FILE *script, const panel *part, double span)
{
    fputs("set ytics nomirror\nset link y2 via y*(", script);
    dea_gnuplot_number(script, part->second);
    fputs(") inverse y/(", script);
    dea_gnuplot_number(script, part->second);
    fputs(")\nset y2tics nomirror ", script);
    dea_gnuplot_number(script, step_choose(span * part->second / part->intervals));
    fputs("\nset y2label ", script);
    dea_gnuplot_text(script, part->second_label);
    fputc('\n', script);
}

/* Ranges of a linear panel, in whole steps of its tics: gnuplot's own would crowd a small panel. */
static void write_ranges(const sheet *page, FILE *script, const panel *part)
{
    double low, high;
    panel_range(page, part, &low, &high);
    const double step = part->step > 0.0 ? part->step : step_choose((high - low) / part->intervals);
    fputs("\nset format y '%h'\nunset logscale y\nset yrange [", script);
    dea_gnuplot_number(script, step * floor(low / step + 1e-9));
    fputc(':', script);
    dea_gnuplot_number(script, step * ceil(high / step - 1e-9));
    fputs("]\nset ytics ", script);
    dea_gnuplot_number(script, step);
    fputc('\n', script);
    if (part->second > 0.0) {
        write_second_axis(script, part, high - low);
    }
}

static void write_panel(const sheet *page, FILE *script, size_t number, const char *across)
{
    const panel *part = &page->panels[number];
    const bool second = part->second > 0.0;
    dea_plot_place(script, WIDTH, page->height, part->box);
    fputs("set ylabel ", script);
    dea_gnuplot_text(script, part->label);
    if (part->logarithmic) {
        fputs("\nset format y '%.0s%c'\nset logscale y\nset yrange [*:*]\nset ytics autofreq\n", script);
    } else {
        write_ranges(page, script, part);
    }
    fprintf(script, "set format x '%s'\nset xlabel ", !part->bottom ? "" : page->response ? "%.0s%c" : "%h");
    dea_gnuplot_text(script, part->bottom ? across : "");
    fputc('\n', script);
    write_curves(page, script, number);
    fputs(second ? "unset link y2\nunset y2tics\nunset y2label\nunset label 2\n" : "unset label 2\n", script);
}

static void write_frame(const sheet *page, FILE *script, const dea_legend *legend)
{
    const dea_scene *scene = page->series.scene;
    const double last = dea_layout_place(scene, page->runs->layout.rows - 1);
    char label[DEA_LABEL_LENGTH] = "Frequency [Hz]";
    if (!page->response) {
        snprintf(label, sizeof label, "Time [%s]", dea_scale_choose(last, "s").unit);
    }
    dea_plot_style(script);
    dea_plot_title(script, scene->title, page->height);
    fputs(page->response ? "set logscale x\nset xrange [" : "set xrange [", script);
    dea_gnuplot_number(script, page->across * dea_layout_place(scene, 0));
    fputc(':', script);
    dea_gnuplot_number(script, page->across * last);
    fputs("]\n", script);
    for (size_t i = 0; i < page->count; i++) {
        write_panel(page, script, i, label);
    }
    if (legend->count > 0) {
        dea_legend_draw(legend, script, WIDTH, page->height);
    }
    fputs("unset multiplot\nunset output\n", script);
}

dea_status dea_plot_draw_runs(dea_plot *plot, dea_error *error)
{
    const dea_scene *scene = plot->scene;
    sheet page = {.runs = &plot->runs,
                  .series = {scene, SIZE_MAX, plot->runs.count / scene->model_count},
                  .response = scene->study == DEA_STUDY_AC,
                  .across = 1.0};
    if (page.response) {
        compose_response(&page);
    } else {
        page.across = dea_scale_choose(dea_layout_place(scene, plot->runs.layout.rows - 1), "s").factor;
        compose_transient(&page);
    }
    if (page.count == 0 || page.panels[0].quantity != 0) {
        return dea_fail(error, DEA_ERROR_USAGE, "nothing to draw: no run has an equilibrium");
    }
    dea_legend legend = {.count = 0};
    for (size_t i = 0; i < page.runs->count; i++) {
        for (size_t k = 0; k < page.runs->runs[i].spot_count; k++) {
            page.seen[page.runs->runs[i].spots[k].mark] = true;
        }
    }
    page.height += dea_series_legend(&page.series, page.seen, WIDTH, &legend);
    dea_gnuplot_size(&plot->picture, WIDTH, page.height);
    write_data(&page, plot->picture.script);
    write_frame(&page, plot->picture.script, &legend);
    return DEA_OK;
}
