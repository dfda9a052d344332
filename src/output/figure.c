#include "output/figure.h"

#include "support/grow.h"

#include <math.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

enum {
    LEFT = 86,
    RIGHT = 86,   /* behind a panel with a second axis */
    CLOSE = 24,   /* behind one without */
    GAP = 18,     /* between panels */
    LABELS = 64,  /* below the last panel of a column */
    LEAST = 24,   /* height of a panel that can be read */
    HALVES = 620, /* width that two columns need */
    DOT = 7       /* symbol that is drawn small */
};

dea_figure dea_figure_begin(dea_plot *plot, bool logarithmic)
{
    return (dea_figure){.picture = &plot->picture,
                        .title = plot->scene->title,
                        .along = {INFINITY, -INFINITY, logarithmic},
                        .name = dea_name_plain};
}

dea_panel *dea_figure_panel(dea_figure *figure, double tall, const char *label)
{
    dea_panel *added = &figure->panels[figure->count++];
    *added = (dea_panel){.tall = tall, .factor = 1.0, .span = {INFINITY, -INFINITY, false}, .name = dea_name_plain, .bottom = true};
    snprintf(added->label, sizeof added->label, "%s", label);
    return added;
}

void dea_figure_curve(dea_figure *figure, size_t panel, dea_look look, double width)
{
    dea_curve *curves = dea_grow(figure->curves, figure->curve_count, &figure->curve_room, sizeof *curves);
    figure->failed = figure->failed || !curves;
    if (curves) {
        figure->curves = curves;
        curves[figure->curve_count++] = (dea_curve){.panel = panel, .look = look, .width = width};
    }
}

void dea_figure_point(dea_figure *figure, double x, double y, unsigned marks)
{
    if (figure->failed || (figure->along.logarithmic && !(x > 0.0))) {
        return;
    }
    dea_curve *curve = &figure->curves[figure->curve_count - 1];
    dea_panel *panel = &figure->panels[curve->panel];
    const double drawn = panel->factor * (panel->absolute ? fabs(y) : y);
    void *points = dea_grow(curve->points, curve->count, &curve->room, sizeof *curve->points);
    if (!points) {
        figure->failed = true;
        return;
    }
    curve->points = points;
    curve->points[curve->count].x = x;
    curve->points[curve->count].y = panel->span.logarithmic && !(drawn > 0.0) ? (double)NAN : drawn;
    curve->points[curve->count++].marks = marks;
    curve->marked = curve->marked || marks;
    dea_span_take(&figure->along, x);
    dea_span_take(&panel->span, drawn);
    for (size_t i = 0; i < DEA_MARKS; i++) {
        figure->seen[i] = figure->seen[i] || (marks & (DEA_AT_LIMIT << i));
    }
}

void dea_figure_prune(dea_figure *figure)
{
    const dea_span *span = &figure->panels[figure->count - 1].span;
    if (span->low < 0.0 || span->high > 0.0 || figure->failed) {
        return;
    }
    figure->count--;
    while (figure->curve_count > 0 && figure->curves[figure->curve_count - 1].panel == figure->count) {
        free(figure->curves[--figure->curve_count].points);
    }
}

/* The panels of one column, from its first to the one before @p end, and how high they are; @p stretch times their natural
 * heights. */
static double lay_column(dea_figure *figure, size_t first, size_t end, double left, double width, double stretch)
{
    double panels = 0.0, top = dea_plot_top(figure->title);
    for (size_t i = first; i < end; i++) {
        dea_panel *panel = &figure->panels[i];
        panel->box = (dea_box){left, top, width, stretch * panel->tall};
        panel->bottom = i + 1 == end;
        top += panel->box.height + GAP;
        panels += panel->tall;
    }
    return panels;
}

/* Puts the panels in place, @p stretch times their natural height; sets the height of the picture. */
static double lay_out(dea_figure *figure, size_t second, double stretch)
{
    const bool bar = figure->series && figure->series->bar != SIZE_MAX;
    const double width = figure->picture->canvas.width - (bar ? DEA_BAR : 0);
    const bool halves = second < figure->count && width >= HALVES;
    const double inside = (halves ? width / 2.0 : width) - LEFT - (figure->panels[0].second > 0.0 ? RIGHT : CLOSE);
    double panels = lay_column(figure, 0, halves ? second : figure->count, LEFT, inside, stretch);
    size_t rows = halves ? second : figure->count;
    if (halves) {
        panels = fmax(panels, lay_column(figure, second, figure->count, width / 2.0 + LEFT, inside, stretch));
        rows = rows > figure->count - second ? rows : figure->count - second;
    }
    figure->height = (int)lround(dea_plot_top(figure->title) + stretch * panels + (double)(rows - 1) * GAP) + LABELS + figure->foot;
    return panels;
}

dea_status dea_figure_stack(dea_figure *figure, size_t second, dea_error *error)
{
    const dea_canvas canvas = figure->picture->canvas;
    if (figure->count == 0) {
        return dea_fail(error, DEA_ERROR_USAGE, "nothing to draw: no run has an equilibrium, or nothing moves");
    }
    const double panels = lay_out(figure, second, 1.0);
    if (canvas.height > 0) {
        lay_out(figure, second, 1.0 + (canvas.height - figure->height) / panels);
        figure->height = canvas.height;
        for (size_t i = 0; i < figure->count; i++) {
            if (figure->panels[i].box.height < LEAST || figure->panels[i].box.width < 2.0 * LEAST) {
                return dea_plot_cramped(canvas, error);
            }
        }
    }
    return DEA_OK;
}

/* x and y of a point and, on a curve with marks, y again in the column of each mark that stands there; never empty. A blank line
 * breaks a curve, a missing number does not. */
static void write_block(FILE *script, const dea_curve *curve, size_t number)
{
    fprintf(script, "$curve%zu << END\n", number);
    for (size_t i = 0; i < curve->count; i++) {
        const double y = curve->points[i].y;
        if (!isnan(y)) {
            dea_gnuplot_put(script, "%g %g", curve->points[i].x, y);
        }
        for (int mark = 0; mark <= DEA_MARKS && curve->marked && !isnan(y); mark++) {
            dea_gnuplot_put(script, " %g", curve->points[i].marks & (DEA_AT_SYMBOL << mark) ? y : (double)NAN);
        }
        fputc('\n', script);
    }
    fprintf(script, "\nNaN NaN%s\nEND\n", curve->marked ? " NaN NaN NaN NaN" : "");
}

/* Line and symbols of a curve. */
static void write_curve(FILE *script, const dea_curve *curve, size_t number, const char *before)
{
    dea_gnuplot_put(script, "%s$curve%z using 1:2 with lines %s linewidth %g ", before, number, dea_plot_dash(curve->look.dash), curve->width);
    dea_look_colour(script, &curve->look);
    fputs(" notitle", script);
    if (curve->look.symbol && curve->marked) {
        fprintf(script, ", \\\n $curve%zu using 1:3 with points pointtype %d pointsize %s*ps linewidth 1.3 ", number, curve->look.symbol,
                curve->look.symbol == DOT ? "0.4" : "0.75");
        dea_look_colour(script, &curve->look);
        fputs(" notitle", script);
    }
}

/* Marks of limits on a curve: an outline over white. */
static void write_limits(const dea_figure *figure, FILE *script, size_t number)
{
    const dea_curve *curve = &figure->curves[number];
    for (size_t mark = 0; mark < DEA_MARKS && curve->marked; mark++) {
        if (figure->seen[mark]) {
            fprintf(script,
                    ", \\\n $curve%zu using 1:%zu with points pointtype %d pointsize 0.8*ps linecolor '#ffffff' notitle"
                    ", \\\n $curve%zu using 1:%zu with points pointtype %d pointsize 0.7*ps linewidth 1.3 ",
                    number, mark + 4, dea_marks[mark].inside, number, mark + 4, dea_marks[mark].symbol);
            dea_look_colour(script, &curve->look);
            fputs(" notitle", script);
        }
    }
}

/* The second axis, on the other side. */
static void write_second_axis(FILE *script, const dea_panel *panel)
{
    dea_span span = panel->span;
    span.low *= panel->second;
    span.high *= panel->second;
    dea_span_write(script, "y2", &span, panel->box.height, panel->name);
    if (!span.logarithmic) {
        dea_span_steps(script, "y2", &span, panel->intervals);
    }
    dea_gnuplot_put(script, "set y2label %q\n", panel->second_label);
}

/* Tics of a linear panel: gnuplot's own would crowd a small one. */
static void write_upward(FILE *script, const dea_panel *panel)
{
    dea_span_write(script, "y", &panel->span, panel->box.height, panel->name);
    if (panel->step > 0.0) {
        dea_gnuplot_put(script, "set ytics %g\n", panel->step);
    } else if (!panel->span.logarithmic && panel->intervals > 0) {
        dea_span_steps(script, "y", &panel->span, panel->intervals);
    }
    if (panel->second > 0.0) {
        write_second_axis(script, panel);
    }
}

/* A label that tells of magnitudes: "Strain |s| [%]". */
static void write_label(FILE *script, const dea_panel *panel)
{
    char label[DEA_LABEL_LENGTH + 2];
    const char *unit = strstr(panel->label, " [");
    if (panel->absolute && unit) {
        const char *symbol = unit;
        while (symbol > panel->label && symbol[-1] != ' ') {
            symbol--;
        }
        snprintf(label, sizeof label, "%.*s|%.*s|%s", (int)(symbol - panel->label), panel->label, (int)(unit - symbol), symbol, unit);
    } else {
        snprintf(label, sizeof label, "%s", panel->label);
    }
    dea_gnuplot_put(script, "set ylabel %q\n", label);
}

static void write_panel(const dea_figure *figure, FILE *script, size_t number)
{
    const dea_panel *panel = &figure->panels[number];
    const int width = figure->picture->canvas.width;
    dea_plot_place(script, width, figure->height, panel->box);
    write_label(script, panel);
    write_upward(script, panel);
    dea_span_write(script, "x", &figure->along, panel->box.width, panel->bottom ? figure->name : dea_name_none);
    dea_gnuplot_put(script, "%sset xlabel %q\n", panel->bottom ? "" : "set format x ''\n", panel->bottom ? figure->label : "");
    if (panel->tag) {
        fprintf(script, "set label 1 '%s' at graph 0, graph 1 offset character 0, character 0.8 left\n", panel->tag);
    }
    if (number == 0 && figure->series && figure->series->bar != SIZE_MAX) {
        dea_series_bar(figure->series, script, figure->picture->canvas, figure->height, panel->box);
    }
    const char *before = "plot ";
    for (size_t i = 0; i < figure->curve_count; i++) {
        if (figure->curves[i].panel == number && figure->curves[i].width > 0.0) {
            write_curve(script, &figure->curves[i], i, before);
            before = ", \\\n ";
        }
    }
    for (size_t i = 0; i < figure->curve_count; i++) {
        if (figure->curves[i].panel == number) {
            write_limits(figure, script, i);
        }
    }
    fprintf(script, "\n%sunset label 2\nunset colorbox\n", panel->second > 0.0 ? "unset y2tics\nunset y2label\n" : "");
}

/* Room beyond what the panels show: a flat drive does not lie on the frame. */
static void settle(dea_figure *figure)
{
    for (size_t i = 0; i < figure->count; i++) {
        dea_panel *panel = &figure->panels[i];
        if (panel->zero) {
            dea_span_take(&panel->span, 0.0);
        }
        if (!panel->whole) {
            dea_span_limit(&panel->span);
        }
        dea_span_pad(&panel->span, panel->floats);
    }
    if (!(figure->along.high > figure->along.low)) {
        dea_span_pad(&figure->along, true);
    }
}

static void write_figure(dea_figure *figure)
{
    FILE *script = figure->picture->script;
    const int width = figure->picture->canvas.width;
    settle(figure);
    dea_gnuplot_size(figure->picture, figure->height);
    for (size_t i = 0; i < figure->curve_count; i++) {
        write_block(script, &figure->curves[i], i);
    }
    dea_plot_style(script);
    dea_plot_title(script, figure->title, width, figure->height);
    for (size_t i = 0; i < figure->count; i++) {
        write_panel(figure, script, i);
    }
    dea_legend_draw(&figure->legend, script, width, figure->height);
}

dea_status dea_figure_end(dea_figure *figure, dea_status status, dea_error *error)
{
    if (status == DEA_OK && figure->failed) {
        status = dea_fail(error, DEA_ERROR_MEMORY, "out of memory");
    }
    if (status == DEA_OK) {
        write_figure(figure);
    }
    for (size_t i = 0; i < figure->curve_count; i++) {
        free(figure->curves[i].points);
    }
    free(figure->curves);
    return status;
}
