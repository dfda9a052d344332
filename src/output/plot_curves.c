/* Strain and displacement side by side: one colour for each value of the other axes, one dash for each model. */
#include "output/label.h"
#include "output/picture.h"
#include "output/series.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

enum {
    WIDTH = 960,
    PANEL = 300,
    PANEL_WIDTH = 358,
    LABELS = 58, /* below a panel */
    MARKS_PER_CURVE = 20,
    FEW_POINTS = 25
};

/* What the whole picture needs to know. */
typedef struct sheet {
    const dea_plot *plot;
    const dea_axis *axis;
    const size_t *order; /* kept values by size */
    dea_scale across, displacement;
    dea_series series;
    bool seen[DEA_MARKS];
    double low[2], high[2]; /* of strain and displacement as drawn, 0 included */
    int height;
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
    return isfinite(dot->strain) && (before || after);
}

static void sheet_scan(sheet *page)
{
    const dea_plot *plot = page->plot;
    double largest = 0.0;
    for (size_t i = 0; i < plot->curves * plot->across.kept; i++) {
        if (isfinite(plot->dots[i].displacement)) {
            largest = fmax(largest, fabs(plot->dots[i].displacement));
        }
    }
    page->displacement = dea_scale_choose(largest, "m");
    for (size_t curve = 0; curve < plot->curves; curve++) {
        for (size_t place = 0; place < plot->across.kept; place++) {
            const dea_dot *dot = sheet_dot(page, curve, place);
            const double drawn[2] = {100.0 * dot->strain, page->displacement.factor * dot->displacement};
            for (int i = 0; i < 2 && isfinite(drawn[i]); i++) {
                page->low[i] = fmin(page->low[i], drawn[i]);
                page->high[i] = fmax(page->high[i], drawn[i]);
            }
            for (size_t mark = 0; mark < DEA_MARKS; mark++) {
                page->seen[mark] = page->seen[mark] || is_marked(page, curve, place, mark);
            }
        }
    }
}

static void write_data(const sheet *page, FILE *script)
{
    const dea_plot *plot = page->plot;
    for (size_t curve = 0; curve < plot->curves; curve++) {
        fprintf(script, "$curve%zu << END\n", curve);
        for (size_t place = 0; place < plot->across.kept; place++) {
            const dea_dot *dot = sheet_dot(page, curve, place);
            const double drawn[2] = {100.0 * dot->strain, page->displacement.factor * dot->displacement};
            const size_t index = dea_thinning_index(&plot->across, page->order[place]);
            dea_gnuplot_number(script, page->across.factor * page->axis->values[index]);
            for (int i = 0; i < 2; i++) {
                fputc(' ', script);
                dea_gnuplot_number(script, drawn[i]);
            }
            for (size_t mark = 0; mark < DEA_MARKS; mark++) {
                for (int i = 0; i < 2; i++) {
                    fputc(' ', script);
                    dea_gnuplot_number(script, is_marked(page, curve, place, mark) ? drawn[i] : NAN);
                }
            }
            fputc('\n', script);
        }
        fputs("END\n", script);
    }
}

static void write_marks(const sheet *page, FILE *script, size_t curve, int column)
{
    char colour[8];
    dea_series_colour(&page->series, curve / page->series.groups, curve % page->series.groups, colour);
    for (size_t mark = 0; mark < DEA_MARKS; mark++) {
        if (page->seen[mark]) {
            const int from = column + 2 * ((int)mark + 1);
            fprintf(script, ", \\\n $curve%zu using 1:%d with points pointtype %d pointsize 0.8 linecolor '#ffffff' notitle",
                    curve, from, dea_marks[mark].inside);
            fprintf(script,
                    ", \\\n $curve%zu using 1:%d with points pointtype %d pointsize 0.7 linewidth 1.3 linecolor '%s' notitle",
                    curve, from, dea_marks[mark].symbol, colour);
        }
    }
}

/* One plot command: all curves of column 2 (strain) or 3 (displacement), then their marks. */
static void write_curves(const sheet *page, FILE *script, int column)
{
    const dea_plot *plot = page->plot;
    const bool few = plot->across.kept <= FEW_POINTS;
    fputs("plot ", script);
    for (size_t curve = 0; curve < plot->curves; curve++) {
        char colour[8];
        dea_series_colour(&page->series, curve / page->series.groups, curve % page->series.groups, colour);
        fprintf(script, "%s$curve%zu using 1:%d with %s ", curve > 0 ? ", \\\n " : "", curve, column,
                few ? "linespoints" : "lines");
        dea_plot_dash(script, curve / page->series.groups + 1);
        fprintf(script, " linewidth 1.8 linecolor '%s' pointtype 7 pointsize 0.4 notitle", colour);
    }
    for (size_t curve = 0; curve < plot->curves; curve++) {
        write_marks(page, script, curve, column);
    }
    fputc('\n', script);
}

/* One panel: its place on the canvas, its labels, its curves. */
static void write_panel(const sheet *page, FILE *script, int number)
{
    const double left = number == 0 ? 82.0 : 578.0;
    const double top = page->plot->scene->title[0] ? DEA_TITLE : DEA_NO_TITLE;
    char label[DEA_LABEL_LENGTH + 24];
    dea_plot_place(script, WIDTH, page->height, (dea_box){left, top, PANEL_WIDTH, PANEL});
    snprintf(label, sizeof label, number == 0 ? "Strain s [%%]" : "Displacement u [%s]", page->displacement.unit);
    fputs("set ylabel ", script);
    dea_gnuplot_text(script, label);
    fprintf(script, "\nset label 1 '(%c)' at graph 0, graph 1.045 left\n", 'a' + number);
    const bool flat = !(page->high[number] > page->low[number]);
    fprintf(script, "set yrange [%s:%s]\n", page->low[number] < 0.0 || flat ? "*" : "0",
            page->high[number] > 0.0 || flat ? "*" : "0");
    write_curves(page, script, number + 2);
}

/* Positive values with a constant ratio over two decades or more ask for a logarithmic axis. */
static bool axis_logarithmic(const sheet *page)
{
    const double *values = page->axis->values;
    const size_t count = page->axis->count;
    if (page->axis->uniform || count < 4 || !(values[0] > 0.0) || !(values[count - 1] >= 100.0 * values[0])) {
        return false;
    }
    const double ratio = pow(values[count - 1] / values[0], 1.0 / (double)(count - 1));
    for (size_t i = 1; i < count; i++) {
        if (!(fabs(values[i] / (values[i - 1] * ratio) - 1.0) < 0.05)) {
            return false;
        }
    }
    return true;
}

static void write_frame(const sheet *page, FILE *script)
{
    const size_t last = page->plot->across.kept - 1;
    char label[DEA_LABEL_LENGTH];
    dea_plot_style(script);
    dea_plot_title(script, page->plot->scene->title, page->height);
    dea_label_axis(page->axis, &page->across, label);
    fputs("set xlabel ", script);
    dea_gnuplot_text(script, label);
    const double first = page->axis->values[dea_thinning_index(&page->plot->across, page->order[0])];
    const double end = page->axis->values[dea_thinning_index(&page->plot->across, page->order[last])];
    const double pad = end > first ? 0.0 : first != 0.0 ? 0.1 * fabs(first) : 1.0; /* an axis may repeat one value */
    fputs("\nset xrange [", script);
    dea_gnuplot_number(script, page->across.factor * (first - pad));
    fputc(':', script);
    dea_gnuplot_number(script, page->across.factor * (end + pad));
    fprintf(script, "]\n%s", axis_logarithmic(page) ? "set logscale x\nset format x '%g'\n" : "");
}

dea_status dea_plot_draw_curves(dea_plot *plot, dea_error *error)
{
    sheet page = {.plot = plot, .axis = &plot->scene->axes[plot->x]};
    size_t *order = dea_plot_order(page.axis, &plot->across);
    if (!order) {
        return dea_fail(error, DEA_ERROR_MEMORY, "out of memory");
    }
    page.order = order;
    page.across = dea_scale_axis(page.axis);
    page.series = (dea_series){plot->scene, plot->x, plot->curves / plot->scene->model_count};
    sheet_scan(&page);
    dea_legend legend = {.count = 0};
    page.height = (plot->scene->title[0] ? DEA_TITLE : DEA_NO_TITLE) + PANEL + LABELS +
                  dea_series_legend(&page.series, page.seen, WIDTH, &legend);
    FILE *script = plot->picture.script;
    dea_gnuplot_size(&plot->picture, WIDTH, page.height);
    write_data(&page, script);
    write_frame(&page, script);
    write_panel(&page, script, 0);
    fputs("unset label 2\n", script);
    write_panel(&page, script, 1);
    if (legend.count > 0) {
        dea_legend_draw(&legend, script, WIDTH, page.height);
    }
    fputs("unset multiplot\nunset output\n", script);
    free(order);
    return DEA_OK;
}
