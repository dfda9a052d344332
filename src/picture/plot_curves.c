/* Strain and displacement, or columns that are wanted: a curve for each model and each value of the other axes. */
#include "picture/figure.h"

#include <math.h>
#include <stdint.h>
#include <stdlib.h>

enum { MARKS_PER_CURVE = 20, FEW_POINTS = 25, DOT = 7 /* symbol */ };

/* What the whole picture needs to know. */
typedef struct sheet {
    const dea_plot *plot;
    const dea_axis *axis;
    const size_t *order; /* kept values by size */
    dea_scale across;
    dea_series series;
    dea_figure figure;
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

/* Where a kept value stands along x, as drawn. */
static double place_value(const sheet *page, size_t place)
{
    return page->across.factor * page->axis->values[dea_thinning_index(&page->plot->across, page->order[place])];
}

/* Does the mark of its group stand at this point? On a curve of few points at all of them. */
static bool has_symbol(const sheet *page, size_t curve, size_t place)
{
    const size_t group = curve % page->series.groups;
    const dea_span *along = &page->figure.across[0].span;
    return page->plot->across.kept <= FEW_POINTS ||
           (place > 0 && dea_series_mark(&page->series, group, dea_span_share(along, place_value(page, place))) !=
                             dea_series_mark(&page->series, group, dea_span_share(along, place_value(page, place - 1))));
}

static unsigned marks_at(const sheet *page, size_t curve, size_t place)
{
    unsigned marks = has_symbol(page, curve, place) ? DEA_AT_SYMBOL : 0;
    for (size_t i = 0; i < DEA_MARKS; i++) {
        marks |= is_marked(page, curve, place, i) ? (unsigned)DEA_AT_LIMIT << i : 0u;
    }
    return marks;
}

/* The panel of one column, from zero on; single curves of few points show them as dots. */
static void add_panel(sheet *page, size_t number, bool logarithmic)
{
    const dea_plot *plot = page->plot;
    char label[DEA_LABEL_LENGTH];
    double largest = 0.0;
    bool negative = false;
    for (size_t i = 0; i < plot->curves * plot->across.kept; i++) {
        const double value = plot->dots[i].values[number];
        largest = isfinite(value) ? fmax(largest, fabs(value)) : largest;
        negative = negative || value < 0.0;
    }
    const dea_scale scale = dea_scale_column(&plot->drawn[number], largest);
    dea_label_column(&plot->drawn[number], &scale, label);
    dea_panel *panel = dea_figure_panel(&page->figure, 0.0, label);
    panel->factor = scale.factor;
    panel->zero = true;
    panel->span.logarithmic = logarithmic;
    panel->absolute = negative && logarithmic;
    for (size_t curve = 0; curve < plot->curves; curve++) {
        dea_look look = dea_series_look(&page->series, curve / page->series.groups, curve % page->series.groups);
        if (!look.symbol && plot->across.kept <= FEW_POINTS) {
            look.symbol = DOT;
            look.size = 0.4;
        }
        dea_figure_curve(&page->figure, number, look, 1.8);
        for (size_t place = 0; place < plot->across.kept; place++) {
            dea_figure_point(&page->figure, place_value(page, place), sheet_dot(page, curve, place)->values[number], marks_at(page, curve, place));
        }
    }
}

/* Puts the panels in place; fails where a logarithmic axis has nothing to show. */
static dea_status sheet_lay(sheet *page, dea_error *error)
{
    dea_figure *figure = &page->figure;
    for (size_t i = 0; i <= figure->count; i++) {
        const dea_span *span = i == 0 ? &figure->across[0].span : &figure->panels[i - 1].span;
        if (span->low > span->high) {
            return dea_fail(error, DEA_ERROR_USAGE, "nothing to draw: nothing is above zero along the logarithmic axis %c", i == 0 ? 'x' : 'y');
        }
    }
    figure->foot = dea_series_legend(&page->series, figure->seen, figure->picture->canvas.width, &figure->legend);
    return dea_figure_pair(figure, 0.5, 300.0, error);
}

dea_status dea_plot_draw_curves(dea_plot *plot, dea_error *error)
{
    const dea_axis *axis = &plot->scene->axes[plot->x];
    size_t *order = dea_plot_order(axis, &plot->across);
    if (!order) {
        return dea_fail(error, DEA_ERROR_MEMORY, "out of memory");
    }
    sheet page = {.plot = plot,
                  .axis = axis,
                  .order = order,
                  .across = dea_scale_axis(axis),
                  .series = dea_series_of(plot->scene, plot->x, plot->curves / plot->scene->model_count),
                  .figure = dea_figure_begin(&plot->picture, plot->scene->title, plot->picture.log_x || dea_axis_logarithmic(axis))};
    page.figure.series = &page.series;
    dea_label_axis(axis, &page.across, page.figure.across[0].label);
    for (size_t place = 0; place < plot->across.kept; place++) {
        dea_span_take(&page.figure.across[0].span, place_value(&page, place));
    }
    for (size_t i = 0; i < plot->drawn_count; i++) {
        add_panel(&page, i, plot->picture.log_y);
    }
    free(order);
    return dea_figure_end(&page.figure, sheet_lay(&page, error), error);
}
