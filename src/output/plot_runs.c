/* Panels of transients, one above the other along time, and of frequency responses: magnitudes above phases. */
#include "output/label.h"
#include "output/picture.h"
#include "study/study.h"

#include <math.h>
#include <stdint.h>
#include <string.h>

enum {
    LEFT = 86,
    RIGHT = 86,   /* behind a panel with a second axis */
    CLOSE = 24,   /* behind one without */
    MAIN = 270,   /* height of the first panel */
    SMALL = 84,   /* of those below it */
    CURRENTS = 130, /* of one with the currents of several runs */
    GAP = 18,     /* between panels */
    LABELS = 58,  /* below the last panel of a column */
    LEAST = 24,   /* height of a panel that can be read */
    HALVES = 620  /* width that two columns need */
};

typedef struct panel {
    size_t quantity;
    dea_box box;
    bool bottom;   /* carries the labels along x */
    bool single;   /* every run has the same curve */
    bool peaks;    /* curves are told apart at their peaks, the smaller ones lie above the larger */
    bool absolute; /* is drawn without its sign */
    bool zero;     /* shows zero */
    int intervals; /* of its tics, at most */
    double factor; /* from SI to what is drawn */
    double second; /* second axis: its numbers over the drawn ones, 0: none */
    char label[DEA_LABEL_LENGTH], second_label[DEA_LABEL_LENGTH];
    double step; /* of its tics, 0: as it comes */
    dea_span span;
    dea_name *name; /* of logarithmic tics */
} panel;

typedef struct sheet {
    const dea_runs *runs;
    dea_series series;
    panel panels[DEA_RUNS_QUANTITIES];
    size_t count;
    size_t second; /* number of the first panel of the second column, count: there is one column */
    bool response; /* frequency response, else transient */
    dea_scale time;
    dea_span along; /* as drawn */
    dea_canvas canvas;
    double top;
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
    *added = (panel){.quantity = quantity,
                     .factor = 1.0,
                     .intervals = 6,
                     .span = {INFINITY, -INFINITY, false},
                     .name = dea_name_plain};
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

static panel *compose_small(sheet *page, size_t offset, const char *words, const char *unit, bool zero)
{
    panel *small = panel_add(page, offset);
    if (small) {
        const dea_scale scale = dea_scale_choose(dea_runs_largest(page->runs, small->quantity), unit);
        small->factor = scale.factor;
        small->zero = zero;
        small->intervals = 4;
        snprintf(small->label, sizeof small->label, "%s [%s]", words, scale.unit);
    }
    return small;
}

/* Draws a panel on a logarithmic axis, without the sign of its numbers where some are negative. */
static void make_logarithmic(const sheet *page, panel *part)
{
    part->span.logarithmic = true;
    for (size_t run = 0; run < page->runs->count; run++) {
        const dea_plot_trace *trace = &page->runs->runs[run].traces[part->quantity];
        for (size_t i = 0; i < trace->count; i++) {
            part->absolute = part->absolute || trace->y[i] < 0.0;
        }
    }
}

static void compose_transient(sheet *page, bool logarithmic)
{
    const dea_scene *scene = page->series.scene;
    compose_strain(page);
    panel *voltage = compose_small(page, offsetof(dea_sample, voltage), "U", "V", true);
    if (voltage) {
        voltage->single = !axis_moves(scene, offsetof(dea_scene, drive.waveform), sizeof scene->drive.waveform);
    }
    panel *current = compose_small(page, offsetof(dea_sample, current), "i", "A", true);
    if (current) {
        current->peaks = true;
    }
    compose_small(page, offsetof(dea_sample, film_voltage), "U_f", "V", true);
    compose_small(page, offsetof(dea_sample, focal_length), "f", "m", false);
    for (size_t i = 0; logarithmic && i < page->count; i++) {
        if (i == 0 || page->panels[i].peaks) {
            make_logarithmic(page, &page->panels[i]);
        }
    }
}

/* A film moves by micrometres per volt, whatever a sharp peak comes to. */
static const double most_per_volt = 1e-4; /* [m/V] */

/* A magnitude and the phase below it. */
static void compose_pair(sheet *page, size_t magnitude, size_t phase, const char *words, const char *unit, const char *per)
{
    panel *upper = panel_add(page, magnitude);
    if (!upper) {
        return;
    }
    const double largest = dea_runs_largest(page->runs, upper->quantity);
    const dea_scale scale = dea_scale_choose(*per ? fmin(largest, most_per_volt) : 1.0, unit);
    upper->span.logarithmic = largest > 0.0; /* without a bias nothing moves */
    upper->factor = scale.factor;
    upper->name = *per ? dea_name_plain : dea_name_prefixed;
    snprintf(upper->label, sizeof upper->label, "%s [%s%s]", words, scale.unit, per);
    panel *lower = panel_add(page, phase);
    if (lower) {
        lower->step = 45.0;
        snprintf(lower->label, sizeof lower->label, "Phase [°]");
    }
}

static double natural_height(const sheet *page, size_t number)
{
    if (page->response) {
        return page->panels[number].step > 0.0 ? MAIN * 2.0 / 3.0 : MAIN;
    }
    return number == 0 ? MAIN : page->panels[number].peaks && page->runs->count > 1 ? CURRENTS : SMALL;
}

/* The panels of one column, from its first to the one before @p end, and how high they are; @p stretch times their natural
 * heights. */
static double lay_column(sheet *page, size_t first, size_t end, double left, double width, double top, double stretch)
{
    double panels = 0.0;
    for (size_t i = first; i < end; i++) {
        const double natural = natural_height(page, i);
        page->panels[i].box = (dea_box){left, top, width, stretch * natural};
        page->panels[i].bottom = i + 1 == end;
        top += stretch * natural + GAP;
        panels += natural;
    }
    return panels;
}

/* Puts the panels in place, @p stretch times their natural height; sets the height of the picture without its legend. */
static double lay_out(sheet *page, double stretch)
{
    const double width = page->canvas.width - (page->series.bar == SIZE_MAX ? 0 : DEA_BAR);
    const size_t second = page->second;
    const bool halves = second < page->count && width >= HALVES;
    const double inside = (halves ? width / 2.0 : width) - LEFT - (page->panels[0].second > 0.0 ? RIGHT : CLOSE);
    double panels = lay_column(page, 0, halves ? second : page->count, LEFT, inside, page->top, stretch);
    size_t rows = halves ? second : page->count;
    if (halves) {
        panels = fmax(panels, lay_column(page, second, page->count, width / 2.0 + LEFT, inside, page->top, stretch));
        rows = rows > page->count - second ? rows : page->count - second;
    }
    page->height = (int)lround(page->top + stretch * panels + (double)(rows - 1) * GAP) + LABELS;
    return panels;
}

/* Fills the canvas, or takes the height that it needs. */
static dea_status fill_canvas(sheet *page, int legend, dea_error *error)
{
    const double panels = lay_out(page, 1.0);
    if (page->canvas.height > 0) {
        const double stretch = 1.0 + (page->canvas.height - legend - page->height) / panels;
        if (stretch * SMALL < LEAST || page->panels[0].box.width < 2.0 * LEAST) {
            return dea_plot_cramped(page->canvas, error);
        }
        lay_out(page, stretch);
        page->height = page->canvas.height - legend;
    }
    page->height += legend;
    return DEA_OK;
}

/* A number of a panel as drawn, NAN where it cannot be. */
static double value_drawn(const panel *part, double value)
{
    const double drawn = part->factor * (part->absolute ? fabs(value) : value);
    return part->span.logarithmic && !(drawn > 0.0) ? (double)NAN : drawn;
}

static bool is_along(const sheet *page, double x)
{
    return x > 0.0 || !page->along.logarithmic;
}

static double share_along(const sheet *page, double x)
{
    const dea_span *span = &page->along;
    return span->logarithmic ? log(x / span->low) / log(span->high / span->low) : (x - span->low) / (span->high - span->low);
}

static void write_trace(const sheet *page, FILE *script, size_t run, size_t number)
{
    const panel *part = &page->panels[number];
    const dea_plot_trace *trace = &page->runs->runs[run].traces[part->quantity];
    fprintf(script, "$run%zu_%zu << END\n", run, number);
    for (size_t i = 0; i < trace->count; i++) {
        if (is_along(page, trace->x[i])) {
            dea_gnuplot_put(script, "%g %g\n", trace->x[i] * page->time.factor, value_drawn(part, trace->y[i]));
        }
    }
    fputs("END\n", script);
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

/* Marks of the group of a run, in a block that is never empty. */
static void write_symbols(const sheet *page, FILE *script, size_t run, size_t number)
{
    const panel *part = &page->panels[number];
    const dea_plot_trace *trace = &page->runs->runs[run].traces[part->quantity];
    const size_t peak = peak_of(trace);
    int before = 0;
    bool begun = false;
    fprintf(script, "$marks%zu_%zu << END\nNaN NaN\n", run, number);
    for (size_t i = 0; i < trace->count; i++) {
        const double x = trace->x[i] * page->time.factor;
        if (!is_along(page, x) || !isfinite(trace->y[i])) {
            continue;
        }
        const double share = page->runs->abscissa > 0 ? (double)i / (double)trace->count : share_along(page, x);
        const int place = dea_series_mark(&page->series, run % page->series.groups, share);
        if (part->peaks ? i == peak : begun && place != before) {
            dea_gnuplot_put(script, "%g %g\n", x, value_drawn(part, trace->y[i]));
        }
        before = place;
        begun = true;
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
        if (spot->mark == mark && is_along(page, spot->x)) {
            dea_gnuplot_put(script, "%g %g\n", spot->x * page->time.factor, value_drawn(&page->panels[0], spot->y));
        }
    }
    fputs("END\n", script);
}

static void write_data(const sheet *page, FILE *script)
{
    for (size_t run = 0; run < page->runs->count; run++) {
        for (size_t i = 0; i < page->count; i++) {
            write_trace(page, script, run, i);
            write_symbols(page, script, run, i);
        }
        for (size_t mark = 0; mark < DEA_MARKS; mark++) {
            write_spots(page, script, run, mark);
        }
    }
}

static dea_look look_of(const sheet *page, const panel *part, size_t run)
{
    dea_look look = dea_series_look(&page->series, run / page->series.groups, run % page->series.groups);
    if (part->single) {
        look = (dea_look){.colour = "#404040", .dash = 1};
    }
    return look;
}

/* Runs in the order in which a panel draws them: as they come, or the larger peaks first. */
static void order_runs(const sheet *page, const panel *part, size_t order[DEA_CURVES_MAX])
{
    double peaks[DEA_CURVES_MAX];
    for (size_t i = 0; i < page->runs->count; i++) {
        const dea_plot_trace *trace = &page->runs->runs[i].traces[part->quantity];
        const double peak = part->peaks && trace->count > 0 ? fabs(trace->y[peak_of(trace)]) : 0.0;
        size_t place = i;
        for (; place > 0 && peak > peaks[place - 1]; place--) {
            peaks[place] = peaks[place - 1];
            order[place] = order[place - 1];
        }
        peaks[place] = peak;
        order[place] = i;
    }
}

static void write_limits(const sheet *page, FILE *script, size_t run)
{
    const dea_look look = look_of(page, &page->panels[0], run);
    for (size_t mark = 0; mark < DEA_MARKS; mark++) {
        if (page->seen[mark]) {
            fprintf(script, ", \\\n $spots%zu_%zu using 1:2 with points pointtype %d pointsize 0.8*ps linecolor '#ffffff' notitle",
                    run, mark, dea_marks[mark].inside);
            fprintf(script, ", \\\n $spots%zu_%zu using 1:2 with points pointtype %d pointsize 0.7*ps linewidth 1.3 ", run, mark,
                    dea_marks[mark].symbol);
            dea_look_colour(script, &look);
            fputs(" notitle", script);
        }
    }
}

static void write_curves(const sheet *page, FILE *script, size_t number)
{
    const panel *part = &page->panels[number];
    size_t order[DEA_CURVES_MAX];
    order_runs(page, part, order);
    for (size_t i = 0; i < (part->single ? 1 : page->runs->count); i++) {
        const dea_look look = look_of(page, part, order[i]);
        fprintf(script, "%s$run%zu_%zu using 1:2 with lines %s linewidth %s ", i > 0 ? ", \\\n " : "plot ", order[i], number,
                dea_plot_dash(look.dash), part->single ? "1.2" : "1.6");
        dea_look_colour(script, &look);
        fputs(" notitle", script);
        if (look.symbol) {
            fprintf(script, ", \\\n $marks%zu_%zu using 1:2 with points pointtype %d pointsize 0.75*ps linewidth 1.3 ", order[i],
                    number, look.symbol);
            dea_look_colour(script, &look);
            fputs(" notitle", script);
        }
    }
    for (size_t run = 0; number == 0 && run < page->runs->count; run++) {
        write_limits(page, script, run);
    }
    fputc('\n', script);
}

/* What the panels show, with room beyond it: a flat drive does not lie on the frame. */
static void measure_panels(sheet *page)
{
    for (size_t number = 0; number < page->count; number++) {
        panel *part = &page->panels[number];
        for (size_t run = 0; run < page->runs->count; run++) {
            const dea_plot_trace *trace = &page->runs->runs[run].traces[part->quantity];
            for (size_t i = 0; i < trace->count; i++) {
                dea_span_take(&part->span, value_drawn(part, trace->y[i]));
            }
        }
        if (part->zero) {
            dea_span_take(&part->span, 0.0);
        }
        if (!page->response) {
            dea_span_limit(&part->span);
        }
        dea_span_pad(&part->span, true);
    }
}

/* The displacement on the other side, for the same edge. */
static void write_second_axis(FILE *script, const panel *part)
{
    dea_span span = part->span;
    span.low *= part->second;
    span.high *= part->second;
    dea_span_write(script, "y2", &span, part->box.height, part->name);
    if (!span.logarithmic) {
        dea_span_steps(script, "y2", &span, part->intervals);
    }
    dea_gnuplot_put(script, "set y2label %q\n", part->second_label);
}

/* Tics of a linear panel: gnuplot's own would crowd a small one. */
static void write_upward(FILE *script, const panel *part)
{
    dea_span_write(script, "y", &part->span, part->box.height, part->name);
    if (part->step > 0.0) {
        fprintf(script, "set ytics %g\n", part->step);
    } else if (!part->span.logarithmic) {
        dea_span_steps(script, "y", &part->span, part->intervals);
    }
    if (part->second > 0.0) {
        write_second_axis(script, part);
    }
}

/* A label that tells of magnitudes: "Strain |s| [%]". */
static void write_label(FILE *script, const panel *part)
{
    char label[DEA_LABEL_LENGTH + 2];
    const char *unit = strstr(part->label, " [");
    if (part->absolute && unit && unit > part->label) {
        const int before = (int)(unit - part->label) - 1;
        snprintf(label, sizeof label, "%.*s|%c|%s", before, part->label, part->label[before], unit);
    } else {
        snprintf(label, sizeof label, "%s", part->label);
    }
    dea_gnuplot_put(script, "set ylabel %q\n", label);
}

static void write_panel(const sheet *page, FILE *script, size_t number, const char *across)
{
    const panel *part = &page->panels[number];
    dea_name *name = !part->bottom ? dea_name_none : page->response ? dea_name_prefixed : dea_name_plain;
    dea_plot_place(script, page->canvas.width, page->height, part->box);
    write_label(script, part);
    write_upward(script, part);
    dea_span_write(script, "x", &page->along, part->box.width, name);
    dea_gnuplot_put(script, "%sset xlabel %q\n", part->bottom ? "" : "set format x ''\n", part->bottom ? across : "");
    if (number == 0 && page->series.bar != SIZE_MAX) {
        dea_series_bar(&page->series, script, page->canvas, page->height, part->box);
    }
    write_curves(page, script, number);
    fputs(part->second > 0.0 ? "unset y2tics\nunset y2label\n" : "", script);
    fputs("unset label 2\nunset colorbox\n", script);
}

static void write_frame(const sheet *page, FILE *script, const dea_legend *legend)
{
    const dea_scene *scene = page->series.scene;
    char label[DEA_LABEL_LENGTH] = "Frequency [Hz]";
    if (!page->response) {
        snprintf(label, sizeof label, page->runs->abscissa > 0 ? "Voltage U [%s]" : "Time [%s]", page->time.unit);
    }
    dea_plot_style(script);
    dea_plot_title(script, scene->title, page->canvas.width, page->height);
    for (size_t i = 0; i < page->count; i++) {
        write_panel(page, script, i, label);
    }
    dea_legend_draw(legend, script, page->canvas.width, page->height);
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
    page->time = dea_scale_choose(fmax(fabs(span.low), fabs(span.high)), "V");
    page->along = (dea_span){INFINITY, -INFINITY, false};
    dea_span_take(&page->along, page->time.factor * span.low);
    dea_span_take(&page->along, page->time.factor * span.high);
}

/* What lies along x: frequency, or time, from the first row after zero where it is logarithmic. */
static void measure_along(sheet *page, bool logarithmic)
{
    const dea_scene *scene = page->series.scene;
    const size_t rows = page->runs->layout.rows;
    const double first = dea_layout_place(scene, 0);
    page->along = (dea_span){INFINITY, -INFINITY, logarithmic || page->response};
    page->time = page->response || logarithmic ? (dea_scale){.factor = 1.0, .unit = "s"} : dea_scale_choose(dea_layout_place(scene, rows - 1), "s");
    dea_span_take(&page->along, page->time.factor * (logarithmic && !(first > 0.0) ? dea_layout_place(scene, 1) : first));
    dea_span_take(&page->along, page->time.factor * dea_layout_place(scene, rows - 1));
}

/* Legend of the runs and of the limits that they pass; its height. */
static int list_runs(sheet *page, dea_legend *legend)
{
    for (size_t i = 0; i < page->runs->count; i++) {
        for (size_t k = 0; k < page->runs->runs[i].spot_count; k++) {
            page->seen[page->runs->runs[i].spots[k].mark] = true;
        }
    }
    return dea_series_legend(&page->series, page->seen, page->canvas.width, legend);
}

dea_status dea_plot_draw_runs(dea_plot *plot, dea_error *error)
{
    const dea_scene *scene = plot->scene;
    dea_gnuplot *picture = &plot->picture;
    sheet page = {.runs = &plot->runs,
                  .series = dea_series_of(scene, SIZE_MAX, plot->runs.count / scene->model_count),
                  .response = dea_study_of(scene)->phasors,
                  .top = dea_plot_top(scene->title),
                  .canvas = picture->canvas};
    dea_legend legend = {.count = 0};
    if (plot->loops) {
        measure_loops(&page);
    } else {
        measure_along(&page, picture->log_x || (!page.response && scene->transient.logarithmic));
    }
    if (page.response) {
        compose_pair(&page, offsetof(dea_response, displacement), offsetof(dea_response, displacement_phase),
                     "Displacement per volt", "m", "/V");
        page.second = page.count;
        compose_pair(&page, offsetof(dea_response, impedance), offsetof(dea_response, impedance_phase), "Impedance", "Ohm", "");
    } else {
        compose_transient(&page, picture->log_y);
        page.second = page.count;
    }
    if (page.count == 0 || page.panels[0].quantity != 0) {
        return dea_fail(error, DEA_ERROR_USAGE, "nothing to draw: no run has an equilibrium");
    }
    measure_panels(&page);
    const dea_status status = fill_canvas(&page, list_runs(&page, &legend), error);
    if (status == DEA_OK) {
        dea_gnuplot_size(picture, page.height);
        write_data(&page, picture->script);
        write_frame(&page, picture->script, &legend);
    }
    return status;
}
