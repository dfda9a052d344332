#include "picture/figure.h"

#include "support/grow.h"
#include "support/text.h"

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
    WIDE = 82,    /* of panels side by side: their labels */
    NARROW = 78,  /* the same where there is little room */
    TAG = 26,     /* above the lower one: (b) */
    LEAST_PAIR = 60,
    MARK = 10     /* room of a symbol */
};

dea_figure dea_figure_begin(dea_gnuplot *picture, const char *title, bool logarithmic)
{
    const dea_across across = {.span = {INFINITY, -INFINITY, logarithmic}, .name = dea_name_plain, .room = 1.0};
    return (dea_figure){.picture = picture, .title = title, .across = {across, across}};
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
    dea_curve *curve = figure->curve_count > 0 ? &figure->curves[figure->curve_count - 1] : NULL;
    dea_panel *panel = &figure->panels[curve ? curve->panel : 0];
    dea_span *along = &figure->across[panel->across].span;
    if (figure->failed || !curve || (along->logarithmic && !(x > 0.0))) {
        return;
    }
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
    dea_span_take(along, x);
    dea_span_take(&panel->span, drawn);
    for (size_t i = 0; i < DEA_MARKS; i++) {
        figure->seen[i] = figure->seen[i] || (marks & ((unsigned)DEA_AT_LIMIT << i));
    }
}

void dea_figure_word_add(dea_figure *figure, size_t panel, double x, double y, const char *text, const char colour[8])
{
    if (figure->word_count < DEA_WORDS) {
        dea_figure_word *word = &figure->words[figure->word_count++];
        *word = (dea_figure_word){.panel = panel, .x = x, .y = y};
        snprintf(word->text, sizeof word->text, "%s", text);
        snprintf(word->colour, sizeof word->colour, "%s", colour);
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

dea_status dea_figure_pair(dea_figure *figure, double share, double tall, dea_error *error)
{
    const dea_canvas canvas = figure->picture->canvas;
    const bool bar = figure->series && figure->series->bar != SIZE_MAX, fixed = canvas.height > 0, both = figure->count > 1;
    const double width = canvas.width - (bar ? DEA_BAR : 0), top = dea_plot_top(figure->title), usual = width < HALVES ? NARROW : WIDE;
    const double left = fmax(figure->left, usual);
    const double room = canvas.height - top - LABELS - figure->foot, single = width - left - CLOSE;
    const double first = (both ? share : 1.0) * width, half = (both ? fmin(first, width - first) : width) - left - CLOSE;
    const double one = fixed ? room : tall, two = fixed ? (room - LABELS - TAG) / 2.0 : tall;
    const bool stacked = fixed && both && fmin(single, 1.2 * two) > fmin(half, 1.2 * one);
    if ((stacked ? single : half) < LEAST_PAIR || (stacked ? two : one) < LEAST_PAIR) {
        return dea_plot_cramped(canvas, error);
    }
    figure->panels[0].box = (dea_box){left, top, stacked ? single : first - left - CLOSE, stacked ? two : one};
    figure->panels[1].box = stacked ? (dea_box){left, top + two + LABELS + TAG, single, two}
                                    : (dea_box){first + left, top, width - first - left - CLOSE, one};
    for (size_t i = 0; i < figure->count; i++) {
        figure->panels[i].tag = !both ? NULL : i == 0 ? "(a)" : "(b)";
    }
    figure->height = fixed ? canvas.height : (int)(top + tall + LABELS) + figure->foot;
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
            dea_gnuplot_put(script, " %g", curve->points[i].marks & ((unsigned)DEA_AT_SYMBOL << mark) ? y : (double)NAN);
        }
        fputc('\n', script);
    }
    fprintf(script, "\nNaN NaN%s\nEND\n", curve->marked ? " NaN NaN NaN NaN" : "");
}

/* Line and symbols of a curve; returns what parts it from the next one. */
static const char *write_curve(FILE *script, const dea_curve *curve, size_t number, const char *before)
{
    static const char *const between = ", \\\n ";
    const dea_look *look = &curve->look;
    if (curve->width > 0.0) {
        dea_gnuplot_put(script, "%s$curve%z using 1:2 with lines %s linewidth %g ", before, number, dea_plot_dash(look->dash), curve->width);
        dea_look_colour(script, look);
        fputs(" notitle", script);
        before = between;
    }
    if (look->symbol && (curve->marked || !(curve->width > 0.0))) {
        dea_gnuplot_put(script, "%s$curve%z using 1:%d with points pointtype %d pointsize %g*ps linewidth 1.3 ", before, number,
                        curve->width > 0.0 ? 3 : 2, look->symbol, look->size > 0.0 ? look->size : 0.75);
        dea_look_colour(script, look);
        fputs(" notitle", script);
        before = between;
    }
    return before;
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
    if (panel->reference > 0.0) {
        const dea_span numbers = {3.0 * panel->reference, panel->span.high, true};
        dea_span_tics(script, "y", &numbers, panel->box.height, panel->name, false);
        dea_gnuplot_put(script, "set ytics add ('ref.' %g)\n", panel->reference);
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

/* Middle of a point on the canvas. */
static dea_box place_of(const dea_figure *figure, size_t number, double x, double y)
{
    const dea_panel *panel = &figure->panels[number];
    return (dea_box){panel->box.left + dea_span_share(&figure->across[panel->across].span, x) * panel->box.width,
                     panel->box.top + (1.0 - dea_span_share(&panel->span, y)) * panel->box.height, MARK, MARK};
}

static bool overlap(const dea_box *a, const dea_box *b)
{
    return fabs(a->left - b->left) < 0.5 * (a->width + b->width) && fabs(a->top - b->top) < 0.5 * (a->height + b->height);
}

/* Does a box, given by its middle, lie on a symbol of a panel? */
static bool is_taken(const dea_figure *figure, size_t number, const dea_box *box)
{
    for (size_t i = 0; i < figure->curve_count; i++) {
        const dea_curve *curve = &figure->curves[i];
        for (size_t k = 0; curve->panel == number && !(curve->width > 0.0) && k < curve->count; k++) {
            const dea_box symbol = place_of(figure, number, curve->points[k].x, curve->points[k].y);
            if (overlap(box, &symbol)) {
                return true;
            }
        }
    }
    return false;
}

/* Words beside their points, on the other side near the right end, where nothing stands. */
static void write_words(const dea_figure *figure, FILE *script, size_t number)
{
    static const double letter = 6.6, line = 13.0; /* sizes of their letters [units] */
    dea_box taken[DEA_WORDS];
    size_t count = 0;
    for (size_t i = 0; i < figure->word_count; i++) {
        const dea_figure_word *word = &figure->words[i];
        const dea_box *panel = &figure->panels[number].box;
        dea_box box = place_of(figure, number, word->x, word->y);
        box.width = letter * (double)dea_text_letters(word->text);
        box.height = line;
        box.left += (box.left + box.width + 14.0 < panel->left + panel->width ? 1.0 : -1.0) * (8.0 + 0.5 * box.width);
        bool free_place = word->panel == number && !is_taken(figure, number, &box);
        for (size_t k = 0; k < count; k++) {
            free_place = free_place && !overlap(&box, &taken[k]);
        }
        if (free_place) {
            taken[count++] = box;
            dea_gnuplot_put(script, "set label %z %q at screen %g, screen %g center font ',9' textcolor '%s'\n", 10 + i, word->text,
                            box.left / figure->picture->canvas.width, 1.0 - box.top / figure->height, word->colour);
        }
    }
}

static void write_across(const dea_figure *figure, FILE *script, const dea_panel *panel)
{
    const dea_across *across = &figure->across[panel->across];
    dea_span_write(script, "x", &across->span, across->room * panel->box.width, panel->bottom ? across->name : dea_name_none);
    dea_gnuplot_put(script, "%sset xlabel %q\n", panel->bottom ? "" : "set format x ''\n", panel->bottom ? across->label : "");
    if (across->tics[0]) {
        fprintf(script, "set xtics (%s)\n", across->tics);
    }
}

static void write_panel(const dea_figure *figure, FILE *script, size_t number)
{
    const dea_panel *panel = &figure->panels[number];
    const int width = figure->picture->canvas.width;
    dea_plot_place(script, width, figure->height, panel->box);
    write_label(script, panel);
    write_upward(script, panel);
    write_across(figure, script, panel);
    if (panel->tag) {
        fprintf(script, "set label 1 '%s' at graph 0, graph 1 offset character 0, character 0.8 left\n", panel->tag);
    }
    if (number == 0 && figure->series && figure->series->bar != SIZE_MAX) {
        dea_series_bar(figure->series, script, figure->picture->canvas, figure->height, panel->box);
    }
    write_words(figure, script, number);
    const char *before = "plot ";
    for (size_t i = 0; i < figure->curve_count; i++) {
        before = figure->curves[i].panel == number ? write_curve(script, &figure->curves[i], i, before) : before;
    }
    for (size_t i = 0; i < figure->curve_count; i++) {
        if (figure->curves[i].panel == number) {
            write_limits(figure, script, i);
        }
    }
    fprintf(script, "\n%sunset label\nunset colorbox\n", panel->second > 0.0 ? "unset y2tics\nunset y2label\n" : "");
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
    for (size_t i = 0; i < 2; i++) {
        dea_span *span = &figure->across[i].span;
        if (figure->across[i].floats || !(span->high > span->low)) {
            dea_span_pad(span, true);
        }
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
