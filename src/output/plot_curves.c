/* Strain and displacement, or columns that are wanted: a curve for each model and each value of the other axes. */
#include "output/label.h"
#include "output/picture.h"
#include "output/series.h"

#include <math.h>
#include <stdint.h>
#include <stdlib.h>

enum { MARKS_PER_CURVE = 20, FEW_POINTS = 25, PANELS = DEA_DRAWN };

/* What the whole picture needs to know. */
typedef struct sheet {
    const dea_plot *plot;
    const dea_axis *axis;
    const size_t *order; /* kept values by size */
    dea_scale across, scales[PANELS];
    int panels;
    dea_series series;
    bool seen[DEA_MARKS];
    bool negative[PANELS];           /* the columns have values below zero */
    dea_span along, spans[PANELS];   /* as drawn */
    dea_pair pair;
} sheet;

static const dea_dot *sheet_dot(const sheet *page, size_t curve, size_t place)
{
    return &page->plot->dots[curve * page->plot->across.kept + page->order[place]];
}

/* Is there a mark of this kind at this point? Pull-in is marked where the curve ends, the others every so often. */
static bool is_marked(const sheet *page, size_t curve, size_t place, size_t mark)
{
    const size_t kept = page->plot->across.kept;
    const dea_dot *dot = sheet_dot(page, curve, place);
    if (dea_marks[mark].state != DEA_STATE_PULL_IN) {
        const size_t step = kept / MARKS_PER_CURVE + 1, back = step / 2 < place ? step / 2 : place;
        const bool begins = place == 0 || sheet_dot(page, curve, place - 1)->state != dot->state;
        const bool within = place % step == 0 && sheet_dot(page, curve, place - back)->state == dot->state;
        return dot->state == dea_marks[mark].state && (begins || within);
    }
    const bool before = place > 0 && sheet_dot(page, curve, place - 1)->state == DEA_STATE_PULL_IN;
    const bool after = place + 1 < kept && sheet_dot(page, curve, place + 1)->state == DEA_STATE_PULL_IN;
    return isfinite(dot->values[0]) && (before || after);
}

/* Columns of a dot as drawn: on a logarithmic axis without their sign. */
static void dot_values(const sheet *page, const dea_dot *dot, double drawn[PANELS])
{
    for (int i = 0; i < PANELS; i++) {
        drawn[i] = page->scales[i].factor * dot->values[i];
        drawn[i] = !page->spans[i].logarithmic ? drawn[i] : drawn[i] != 0.0 ? fabs(drawn[i]) : (double)NAN;
    }
}

/* Where a kept value stands along x, as drawn. */
static double place_value(const sheet *page, size_t place)
{
    return page->across.factor * page->axis->values[dea_thinning_index(&page->plot->across, page->order[place])];
}

/* Its share of the way along x. */
static double place_share(const sheet *page, size_t place)
{
    const dea_span *x = &page->along;
    const double value = place_value(page, place);
    if (x->logarithmic && !(value > 0.0)) {
        return 0.0;
    }
    return x->logarithmic ? log(value / x->low) / log(x->high / x->low) : (value - x->low) / (x->high - x->low);
}

/* Does the mark of its group stand at this point? On a curve of few points at all of them. */
static bool has_symbol(const sheet *page, size_t curve, size_t place)
{
    const size_t group = curve % page->series.groups;
    if (page->plot->across.kept <= FEW_POINTS) {
        return true;
    }
    return place > 0 && dea_series_mark(&page->series, group, place_share(page, place)) !=
                            dea_series_mark(&page->series, group, place_share(page, place - 1));
}

static void scan_scale(sheet *page)
{
    const dea_plot *plot = page->plot;
    for (int k = 0; k < page->panels; k++) {
        double largest = 0.0;
        for (size_t i = 0; i < plot->curves * plot->across.kept; i++) {
            const double value = plot->dots[i].values[k];
            largest = isfinite(value) ? fmax(largest, fabs(value)) : largest;
            page->negative[k] = page->negative[k] || value < 0.0;
        }
        page->scales[k] = dea_scale_column(&plot->drawn[k], largest);
    }
}

static void sheet_scan(sheet *page)
{
    const dea_plot *plot = page->plot;
    scan_scale(page);
    for (size_t place = 0; place < plot->across.kept; place++) {
        dea_span_take(&page->along, place_value(page, place));
    }
    for (size_t curve = 0; curve < plot->curves; curve++) {
        for (size_t place = 0; place < plot->across.kept; place++) {
            double drawn[PANELS];
            dot_values(page, sheet_dot(page, curve, place), drawn);
            for (int i = 0; i < page->panels && (place_value(page, place) > 0.0 || !page->along.logarithmic); i++) {
                dea_span_take(&page->spans[i], drawn[i]);
            }
            for (size_t mark = 0; mark < DEA_MARKS; mark++) {
                page->seen[mark] = page->seen[mark] || is_marked(page, curve, place, mark);
            }
        }
    }
}

static void write_values(FILE *script, const double drawn[PANELS], bool shown)
{
    for (int i = 0; i < PANELS; i++) {
        dea_gnuplot_put(script, " %g", shown ? drawn[i] : (double)NAN);
    }
}

/* A block a curve: x, then pairs of columns: all of it, its marks of limits, those of its group. */
static void write_data(const sheet *page, FILE *script)
{
    const dea_plot *plot = page->plot;
    for (size_t curve = 0; curve < plot->curves; curve++) {
        fprintf(script, "$curve%zu << END\n", curve);
        for (size_t place = 0; place < plot->across.kept; place++) {
            double drawn[PANELS];
            const double x = place_value(page, place);
            dot_values(page, sheet_dot(page, curve, place), drawn);
            if (page->along.logarithmic && !(x > 0.0)) {
                continue;
            }
            dea_gnuplot_put(script, "%g", x);
            write_values(script, drawn, true);
            for (size_t mark = 0; mark < DEA_MARKS; mark++) {
                write_values(script, drawn, is_marked(page, curve, place, mark));
            }
            write_values(script, drawn, has_symbol(page, curve, place));
            fputc('\n', script);
        }
        fputs("END\n", script);
    }
}

static void write_marks(const sheet *page, FILE *script, size_t curve, int column)
{
    const dea_look look = dea_series_look(&page->series, curve / page->series.groups, curve % page->series.groups);
    for (size_t mark = 0; mark < DEA_MARKS; mark++) {
        if (page->seen[mark]) {
            const int from = column + 2 * ((int)mark + 1);
            fprintf(script, ", \\\n $curve%zu using 1:%d with points pointtype %d pointsize 0.8*ps linecolor '#ffffff' notitle",
                    curve, from, dea_marks[mark].inside);
            fprintf(script, ", \\\n $curve%zu using 1:%d with points pointtype %d pointsize 0.7*ps linewidth 1.3 ", curve, from,
                    dea_marks[mark].symbol);
            dea_look_colour(script, &look);
            fputs(" notitle", script);
        }
    }
}

/* The line of a curve and its marks; single curves of few points show them as dots. */
static void write_curve(const sheet *page, FILE *script, size_t curve, int column)
{
    enum { DOT = 7 };
    const dea_look look = dea_series_look(&page->series, curve / page->series.groups, curve % page->series.groups);
    const int symbol = look.symbol ? look.symbol : page->plot->across.kept <= FEW_POINTS ? DOT : 0;
    fprintf(script, "%s$curve%zu using 1:%d with lines %s linewidth 1.8 ", curve > 0 ? ", \\\n " : "plot ", curve, column,
            dea_plot_dash(look.dash));
    dea_look_colour(script, &look);
    fputs(" notitle", script);
    if (symbol) {
        fprintf(script, ", \\\n $curve%zu using 1:%d with points pointtype %d pointsize %s*ps linewidth 1.3 ", curve,
                column + 2 * (DEA_MARKS + 1), symbol, symbol == DOT ? "0.4" : "0.75");
        dea_look_colour(script, &look);
        fputs(" notitle", script);
    }
}

/* One panel: its place on the canvas, its labels, its curves in column 2 or 3. */
static void write_panel(sheet *page, FILE *script, int number)
{
    const dea_plot *plot = page->plot;
    const dea_box *box = &page->pair.boxes[number];
    char label[DEA_LABEL_LENGTH];
    dea_plot_place(script, plot->picture.canvas.width, page->pair.height, *box);
    dea_label_column(&plot->drawn[number], &page->scales[number], page->negative[number] && page->spans[number].logarithmic, label);
    dea_gnuplot_put(script, "set ylabel %q\n", label);
    if (page->panels > 1) {
        dea_gnuplot_put(script, "set label 1 '(%s)' at graph 0, graph 1 offset character 0, character 0.8 left\n", number == 0 ? "a" : "b");
    }
    dea_span_write(script, "x", &page->along, box->width, dea_name_plain);
    dea_span_write(script, "y", &page->spans[number], box->height, dea_name_plain);
    if (number == 0 && page->series.bar != SIZE_MAX) {
        dea_series_bar(&page->series, script, plot->picture.canvas, page->pair.height, *box);
    }
    for (size_t curve = 0; curve < plot->curves; curve++) {
        write_curve(page, script, curve, number + 2);
    }
    for (size_t curve = 0; curve < plot->curves; curve++) {
        write_marks(page, script, curve, number + 2);
    }
    fputs("\nunset label 2\nunset colorbox\n", script);
}

/* Ranges: columns from zero, with room above; one value along x is put in the middle. */
static void sheet_settle(sheet *page)
{
    for (int i = 0; i < page->panels; i++) {
        dea_span *span = &page->spans[i];
        if (!span->logarithmic) {
            dea_span_take(span, 0.0);
        }
        dea_span_limit(span);
        dea_span_pad(span, false);
    }
    if (!(page->along.high > page->along.low)) {
        dea_span_pad(&page->along, true);
    }
}

static void write_picture(sheet *page, const dea_legend *legend)
{
    const dea_plot *plot = page->plot;
    FILE *script = plot->picture.script;
    char label[DEA_LABEL_LENGTH];
    write_data(page, script);
    dea_plot_style(script);
    dea_plot_title(script, plot->scene->title, plot->picture.canvas.width, page->pair.height);
    dea_label_axis(page->axis, &page->across, label);
    dea_gnuplot_put(script, "set xlabel %q\n", label);
    for (int i = 0; i < page->panels; i++) {
        write_panel(page, script, i);
    }
    dea_legend_draw(legend, script, plot->picture.canvas.width, page->pair.height);
}

/* Fails where a logarithmic axis has nothing to show. */
static dea_status sheet_check(const sheet *page, dea_error *error)
{
    const dea_span *spans[] = {&page->along, &page->spans[0], &page->spans[1]};
    for (int i = 0; i < 1 + page->panels; i++) {
        if (spans[i]->low > spans[i]->high) {
            return dea_fail(error, DEA_ERROR_USAGE, "nothing to draw: nothing is above zero along the logarithmic axis %c",
                            i == 0 ? 'x' : 'y');
        }
    }
    return DEA_OK;
}

/* The room of both panels for one. */
static dea_box joined(const dea_pair *pair)
{
    const dea_box *first = &pair->boxes[0], *last = &pair->boxes[1];
    return (dea_box){first->left, first->top, last->left + last->width - first->left, last->top + last->height - first->top};
}

dea_status dea_plot_draw_curves(dea_plot *plot, dea_error *error)
{
    const dea_span none = {INFINITY, -INFINITY, plot->picture.log_y};
    sheet page = {.plot = plot, .axis = &plot->scene->axes[plot->x], .panels = (int)plot->drawn_count, .spans = {none, none}, .along = none};
    size_t *order = dea_plot_order(page.axis, &plot->across);
    if (!order) {
        return dea_fail(error, DEA_ERROR_MEMORY, "out of memory");
    }
    page.order = order;
    page.along.logarithmic = plot->picture.log_x || dea_axis_logarithmic(page.axis);
    page.across = dea_scale_axis(page.axis);
    page.series = dea_series_of(plot->scene, plot->x, plot->curves / plot->scene->model_count);
    sheet_scan(&page);
    dea_status status = sheet_check(&page, error);
    dea_legend legend = {.count = 0};
    const int room = dea_series_legend(&page.series, page.seen, plot->picture.canvas.width, &legend);
    if (status == DEA_OK) {
        sheet_settle(&page);
        status = dea_plot_pair(plot->picture.canvas, plot->scene->title, page.series.bar == SIZE_MAX ? 0.0 : DEA_BAR, room, &page.pair,
                               error);
    }
    if (status == DEA_OK) {
        page.pair.boxes[0] = page.panels == 1 ? joined(&page.pair) : page.pair.boxes[0];
        dea_gnuplot_size(&plot->picture, page.pair.height);
        write_picture(&page, &legend);
    }
    free(order);
    return status;
}
