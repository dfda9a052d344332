/* Work-precision diagram: error over time, a curve for each engine and model, and beside it, in statics, what the models
 * themselves are off by. Colour tells the model (the engine where there is one model), the symbol the engine; a hollow symbol is
 * dominated. */
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "output/bench.h"
#include "output/legend.h"
#include "output/picture.h"

enum {
    WIDTH = 960,
    LEFT = 96,
    PANEL = 380,
    WIDE = 824,   /* panel width where it stands alone */
    HALF = 456,   /* where the models stand beside it */
    SECOND = 660, /* left edge of the panel of models */
    SECOND_WIDTH = 270,
    LABELS = 68,  /* below the panels */
    BOXES = 8192, /* places that labels must not cover */
    MARKS = 512,
    TEXT = 96
};

static const double letter = 6.2, line_height = 12.0; /* of a label at a mark [1/100 inch] */
static const double smallest = 1e-17;                 /* error that is drawn */
static const double pad = 0.06;                       /* beyond the marks, of a panel's width or height */

/* A logarithmic panel: decades along x and y. */
typedef struct panel {
    dea_box box;
    double low[2], high[2]; /* log10 of the ranges along x, y */
} panel;

/* A rectangle that is taken, on the canvas. */
typedef struct taken {
    double left, bottom, right, top;
} taken;

/* A mark, on the canvas. */
typedef struct spot {
    double x, y;
} spot;

typedef struct sheet {
    const dea_bench *bench;
    panel work, models;
    double floor; /* where references are drawn, as an error */
    bool references, statics;
    taken boxes[BOXES];
    spot marks[MARKS];
    size_t box_count, mark_count, label;
    int height;
} sheet;

/* Outline and filled symbol of an engine, by its place in the table. */
static void symbols_of(const dea_engine *engine, int *hollow, int *filled)
{
    static const int outlines[] = {6, 4, 8, 12, 10, 14};
    size_t place = 0;
    while (dea_engine_at(place) && dea_engine_at(place) != engine) {
        place++;
    }
    *hollow = outlines[place % (sizeof outlines / sizeof *outlines)];
    *filled = *hollow + 1;
}

static void colour_of(const dea_bench *bench, const dea_bench_setting *setting, char colour[8])
{
    size_t place = 0;
    if (bench->model_count > 1) {
        dea_plot_colour(setting->model, bench->model_count, colour);
        return;
    }
    while (dea_engine_at(place) && dea_engine_at(place) != setting->engine) {
        place++;
    }
    dea_plot_colour(place, dea_engine_count(), colour);
}

/* Is there something to draw of a setting? */
static bool is_drawn(const dea_bench_setting *setting)
{
    return setting->state == DEA_BENCH_MEASURED && (setting->reference || isfinite(setting->error));
}

static double time_of(const dea_bench *bench, const dea_bench_setting *setting)
{
    return setting->seconds / bench->units;
}

static double error_of(const sheet *page, const dea_bench_setting *setting)
{
    return setting->reference ? page->floor : fmax(setting->error, smallest);
}

/* The fastest setting of a model that keeps its promise; NULL: none. */
static const dea_bench_setting *cheapest(const dea_bench *bench, size_t model)
{
    const dea_bench_setting *best = NULL;
    for (size_t i = 0; i < bench->setting_count; i++) {
        const dea_bench_setting *setting = &bench->settings[i];
        const bool counts = setting->model == model && is_drawn(setting) && !setting->broken;
        best = counts && (!best || setting->seconds < best->seconds) ? setting : best;
    }
    return best;
}

/* Its name with blanks. */
static void model_name(const dea_model *model, char name[TEXT])
{
    snprintf(name, TEXT, "%s", model->name);
    for (char *byte = name; *byte; byte++) {
        *byte = *byte == '_' ? ' ' : *byte;
    }
}

/* ---- ranges */

static void widen(panel *part, double x, double y)
{
    part->low[0] = fmin(part->low[0], log10(x));
    part->high[0] = fmax(part->high[0], log10(x));
    part->low[1] = fmin(part->low[1], log10(y));
    part->high[1] = fmax(part->high[1], log10(y));
}

static void settle(panel *part)
{
    for (int i = 0; i < 2; i++) {
        const double margin = fmax(0.25, pad * (part->high[i] - part->low[i]));
        part->low[i] -= margin;
        part->high[i] += margin;
    }
}

static void measure_work(sheet *page)
{
    const dea_bench *bench = page->bench;
    double least = 1.0;
    for (size_t i = 0; i < bench->setting_count; i++) {
        const dea_bench_setting *setting = &bench->settings[i];
        page->references = page->references || (is_drawn(setting) && setting->reference);
        least = is_drawn(setting) && !setting->reference ? fmin(least, fmax(setting->error, smallest)) : least;
    }
    page->floor = pow(10.0, floor(log10(least)) - 1.0);
    for (size_t i = 0; i < bench->setting_count; i++) {
        const dea_bench_setting *setting = &bench->settings[i];
        if (is_drawn(setting)) {
            widen(&page->work, time_of(bench, setting), error_of(page, setting));
        }
    }
    settle(&page->work);
}

/* Where a model stands: time a point of its cheapest setting, and its median error; false where it has none. */
static bool model_spot(const dea_bench *bench, size_t number, double *time, double *error)
{
    const dea_bench_model *model = &bench->models[number];
    const dea_bench_setting *setting = cheapest(bench, number);
    *time = setting ? time_of(bench, setting) : (double)NAN;
    *error = fmax(model->error_median, 1e-4 * model->error_worst);
    return setting && model->error_worst > 0.0;
}

static void measure_models(sheet *page)
{
    const dea_bench *bench = page->bench;
    double time, error;
    for (size_t i = 0; i < bench->model_count; i++) {
        if (model_spot(bench, i, &time, &error)) {
            page->statics = true;
            widen(&page->models, time, error);
            widen(&page->models, time, bench->models[i].error_worst);
        }
    }
    for (size_t i = 0; page->statics && i < bench->model_count; i++) {
        (void)model_spot(bench, i, &time, &error);
        if (bench->models[i].model->membrane && isfinite(time)) {
            widen(&page->models, time, pow(10.0, page->models.low[1]));
        }
    }
    settle(&page->models);
}

/* ---- tics */

/* "100 ns" for 1e-7. */
static void time_text(double value, char text[TEXT])
{
    static const char *const units[] = {"ps", "ns", "µs", "ms", "s", "ks"};
    const int unit = (int)fmin(fmax(floor(log10(value) / 3.0 + 1e-9) + 4.0, 0.0), 5.0);
    snprintf(text, TEXT, "%g %s", value * pow(10.0, 3.0 * (4 - unit)), units[unit]);
}

/* "10⁻⁶" for 1e-6. */
static void power_text(double value, char text[TEXT])
{
    static const char *const digits[] = {"⁰", "¹", "²", "³", "⁴", "⁵", "⁶", "⁷", "⁸", "⁹"};
    const int decade = (int)lround(log10(value));
    const int size = decade < 0 ? -decade : decade;
    snprintf(text, TEXT, "10%s%s%s", decade < 0 ? "⁻" : "", size > 9 ? digits[size / 10 % 10] : "", digits[size % 10]);
}

/* "10 %" for 0.1; gnuplot reads tics as formats, so that the sign is doubled. */
static void percent_text(double value, char text[TEXT])
{
    snprintf(text, TEXT, "%g %%%%", 100.0 * value);
}

static void write_tic(FILE *script, const char *before, const char *text, double value)
{
    fputs(before, script);
    dea_gnuplot_text(script, text);
    fputc(' ', script);
    dea_gnuplot_number(script, value);
    fputs(*text ? "" : " 1", script);
}

/* Labels at decades, as many as have room, and a short tic at each decade between; also at 2 and 5 of each where decades are
 * few and @p fine. */
static void write_tics(FILE *script, const char *axis, double low, double high, int most, bool fine,
                       void (*name)(double, char[TEXT]))
{
    const int first = (int)ceil(low), last = (int)floor(high);
    const int step = last - first < most ? 1 : (last - first) / most + 1;
    const char *before = "(";
    fprintf(script, "set %stics ", axis);
    for (int decade = first - 1; decade <= last; decade++) {
        for (int number = 1; number <= 5; number += number == 1 ? 1 : 3) {
            const double value = number * pow(10.0, decade);
            char text[TEXT] = "";
            const bool named = number == 1 ? (last - decade) % step == 0 : fine && high - low < 2.5;
            if (!(log10(value) >= low && log10(value) <= high) || (number > 1 && !named)) {
                continue;
            }
            if (named) {
                name(value, text);
            }
            write_tic(script, before, text, value);
            before = ", ";
        }
    }
    fputs(*before == '(' ? "autofreq\n" : ")\n", script);
}

static void write_ranges(FILE *script, const panel *part)
{
    const char *const names[] = {"x", "y"};
    for (int i = 0; i < 2; i++) {
        fprintf(script, "set %srange [", names[i]);
        dea_gnuplot_number(script, pow(10.0, part->low[i]));
        fputc(':', script);
        dea_gnuplot_number(script, pow(10.0, part->high[i]));
        fputs("]\n", script);
    }
}

/* ---- labels at marks */

static double place_x(const panel *part, double x)
{
    return part->box.left + (log10(x) - part->low[0]) / (part->high[0] - part->low[0]) * part->box.width;
}

/* Downward, as boxes are. */
static double place_y(const panel *part, double y)
{
    return part->box.top + (part->high[1] - log10(y)) / (part->high[1] - part->low[1]) * part->box.height;
}

static void take_box(sheet *page, taken box)
{
    if (page->box_count < BOXES) {
        page->boxes[page->box_count++] = box;
    }
}

static void take_mark(sheet *page, double x, double y)
{
    take_box(page, (taken){x - 5.0, y + 5.0, x + 5.0, y - 5.0});
    if (page->mark_count < MARKS) {
        page->marks[page->mark_count++] = (spot){x, y};
    }
}

static double distance(taken box, double x, double y)
{
    return hypot(fmax(0.0, fmax(box.left - x, x - box.right)), fmax(0.0, fmax(box.top - y, y - box.bottom)));
}

/* Is the mark at x, y clearly the nearest to a label? */
static bool is_nearest(const sheet *page, taken box, double x, double y)
{
    const double own = distance(box, x, y);
    for (size_t i = 0; i < page->mark_count; i++) {
        const spot *mark = &page->marks[i];
        if (hypot(mark->x - x, mark->y - y) > 0.5 && distance(box, mark->x, mark->y) < own + 3.0) {
            return false;
        }
    }
    return true;
}

static bool is_free(const sheet *page, const panel *part, taken box)
{
    if (box.left < part->box.left + 2.0 || box.right > part->box.left + part->box.width - 2.0 || box.top < part->box.top + 2.0 ||
        box.bottom > part->box.top + part->box.height - 2.0) {
        return false;
    }
    for (size_t i = 0; i < page->box_count; i++) {
        const taken *other = &page->boxes[i];
        if (box.left < other->right && box.right > other->left && box.top < other->bottom && box.bottom > other->top) {
            return false;
        }
    }
    return true;
}

static size_t letters_in(const char *text)
{
    size_t letters = 0;
    for (const char *byte = text; *byte; byte++) {
        letters += ((unsigned char)*byte & 0xc0) != 0x80;
    }
    return letters;
}

/* Writes a label beside, above or below a mark, where there is room; nothing where there is none. */
static void label_mark(sheet *page, FILE *script, const panel *part, double x, double y, const char *text, const char *colour)
{
    const double width = letter * (double)letters_in(text), half = 0.5 * line_height;
    const double across = place_x(part, x), down = place_y(part, y);
    const struct {
        double x, y; /* middle of the text */
    } places[] = {{across + 8.0 + 0.5 * width, down},
                  {across - 8.0 - 0.5 * width, down},
                  {across + 8.0 + 0.5 * width, down - 9.0},
                  {across + 8.0 + 0.5 * width, down + 9.0},
                  {across, down - 13.0},
                  {across, down + 13.0},
                  {across - 8.0 - 0.5 * width, down - 9.0},
                  {across - 8.0 - 0.5 * width, down + 9.0}};
    for (size_t i = 0; i < sizeof places / sizeof *places; i++) {
        const taken box = {places[i].x - 0.5 * width, places[i].y + half, places[i].x + 0.5 * width, places[i].y - half};
        if (is_free(page, part, box) && is_nearest(page, box, across, down)) {
            take_box(page, box);
            fprintf(script, "set label %zu ", ++page->label);
            dea_gnuplot_text(script, text);
            fputs(" at screen ", script);
            dea_gnuplot_number(script, places[i].x / WIDTH);
            fputs(", screen ", script);
            dea_gnuplot_number(script, 1.0 - places[i].y / page->height);
            fprintf(script, " center font ',9' textcolor '%s'\n", colour);
            return;
        }
    }
}

static void accuracy_text(const dea_bench_setting *setting, char text[TEXT])
{
    char loose[TEXT], tight[TEXT];
    power_text(setting->loosest, loose);
    power_text(setting->accuracy, tight);
    if (setting->any) {
        snprintf(text, TEXT, "any");
    } else if (setting->loosest > setting->accuracy) {
        snprintf(text, TEXT, "%.20s–%.20s", loose, tight);
    } else {
        snprintf(text, TEXT, "%s", tight);
    }
}

static bool begins_curve(const dea_bench *bench, size_t i)
{
    return i == 0 || bench->settings[i].model != bench->settings[i - 1].model ||
           bench->settings[i].engine != bench->settings[i - 1].engine;
}

/* Number of the setting in its curve, and how many the curve has. */
static void place_in_curve(const dea_bench *bench, size_t number, size_t *place, size_t *count)
{
    const dea_bench_setting *own = &bench->settings[number];
    *place = *count = 0;
    for (size_t i = 0; i < bench->setting_count; i++) {
        const dea_bench_setting *setting = &bench->settings[i];
        if (setting->model == own->model && setting->engine == own->engine && is_drawn(setting)) {
            *place += i < number;
            ++*count;
        }
    }
}

/* Takes the place of marks, and of the lines between them in small steps. */
static void take_curves(sheet *page)
{
    enum { STEPS = 24 };
    const dea_bench *bench = page->bench;
    double before[2] = {(double)NAN, (double)NAN};
    for (size_t i = 0; i < bench->setting_count; i++) {
        const dea_bench_setting *setting = &bench->settings[i];
        if (begins_curve(bench, i)) {
            before[0] = (double)NAN;
        }
        if (!is_drawn(setting)) {
            continue;
        }
        const double x = place_x(&page->work, time_of(bench, setting)), y = place_y(&page->work, error_of(page, setting));
        take_mark(page, x, y);
        for (int k = 1; k < STEPS && !isnan(before[0]) && !setting->reference; k++) {
            const double share = (double)k / STEPS;
            const double across = before[0] + share * (x - before[0]), down = before[1] + share * (y - before[1]);
            take_box(page, (taken){across - 1.0, down + 1.0, across + 1.0, down - 1.0});
        }
        before[0] = setting->reference ? (double)NAN : x;
        before[1] = y;
    }
}

/* Ends of the curves first, then what lies between, as far as there is room. */
static void label_settings(sheet *page, FILE *script)
{
    const dea_bench *bench = page->bench;
    take_curves(page);
    for (int turn = 0; turn < 2; turn++) {
        for (size_t i = 0; i < bench->setting_count; i++) {
            const dea_bench_setting *setting = &bench->settings[i];
            size_t place, count;
            place_in_curve(bench, i, &place, &count);
            const bool end = place == 0 || place + 1 == count;
            const bool told = setting->any && setting->reference; /* a closed form: its place says all */
            if (is_drawn(setting) && !told && end == (turn == 0)) {
                char text[TEXT], colour[8];
                accuracy_text(setting, text);
                colour_of(bench, setting, colour);
                label_mark(page, script, &page->work, time_of(bench, setting), error_of(page, setting), text, colour);
            }
        }
    }
}

/* ---- the panel of work and precision */

/* A block for each curve: time, error of the line, of efficient, dominated, broken settings and of references. */
static void write_settings(const sheet *page, FILE *script)
{
    const dea_bench *bench = page->bench;
    const double none = (double)NAN;
    for (size_t i = 0; i < bench->setting_count; i++) {
        const dea_bench_setting *setting = &bench->settings[i];
        if (begins_curve(bench, i)) {
            fprintf(script, "%s$curve%zu << END\nNaN NaN NaN NaN NaN NaN\n", i > 0 ? "END\n" : "", i);
        }
        if (is_drawn(setting)) {
            const double y = error_of(page, setting);
            const double columns[] = {time_of(bench, setting),
                                      setting->reference ? none : y,
                                      !setting->reference && !setting->dominated ? y : none,
                                      !setting->reference && setting->dominated ? y : none,
                                      setting->broken ? y : none,
                                      setting->reference ? y : none};
            for (size_t c = 0; c < sizeof columns / sizeof *columns; c++) {
                dea_gnuplot_number(script, columns[c]);
                fputc(c + 1 < sizeof columns / sizeof *columns ? ' ' : '\n', script);
            }
        }
    }
    fputs("END\n", script);
}

static void write_curve(const sheet *page, FILE *script, size_t i)
{
    const dea_bench_setting *setting = &page->bench->settings[i];
    char colour[8];
    int hollow, filled;
    colour_of(page->bench, setting, colour);
    symbols_of(setting->engine, &hollow, &filled);
    fprintf(script, "%s$curve%zu using 1:2 with lines linewidth 1.2 linecolor '%s' notitle", i > 0 ? ", \\\n " : "plot ", i,
            colour);
    const struct {
        int column, symbol;
        double size;
        const char *colour;
    } marks[] = {{3, filled, 0.8, colour}, {4, filled, 0.8, "#ffffff"}, {4, hollow, 0.8, colour},
                 {5, 2, 1.4, "#b00000"},   {6, filled, 0.8, colour},    {6, 3, 1.3, colour}};
    for (size_t k = 0; k < sizeof marks / sizeof *marks; k++) {
        fprintf(script, ", \\\n $curve%zu using 1:%d with points pointtype %d pointsize %g linewidth 1.3 linecolor '%s' notitle",
                i, marks[k].column, marks[k].symbol, marks[k].size, marks[k].colour);
    }
}

static const char *time_label(const dea_bench *bench)
{
    switch (bench->scene->study) {
    case DEA_STUDY_TRANSIENT:
        return "Wall time per simulated second";
    case DEA_STUDY_AC:
        return "Wall time per frequency";
    default:
        return "Wall time per point";
    }
}

static const char *error_label(const dea_bench *bench)
{
    return bench->scene->study == DEA_STUDY_TRANSIENT ? "Numerical error, relative to the peak" : "Numerical error, relative";
}

static void write_axes(FILE *script, const char *across, const char *up)
{
    fputs("set xlabel ", script);
    dea_gnuplot_text(script, across);
    fputs("\nset ylabel ", script);
    dea_gnuplot_text(script, up);
    fputc('\n', script);
}

static void write_work(sheet *page, FILE *script)
{
    const dea_bench *bench = page->bench;
    dea_plot_place(script, WIDTH, page->height, page->work.box);
    write_axes(script, time_label(bench), error_label(bench));
    write_ranges(script, &page->work);
    write_tics(script, "x", page->work.low[0], page->work.high[0], (int)(page->work.box.width / 62.0), false, time_text);
    const double low = page->references ? log10(page->floor) + 0.5 : page->work.low[1];
    write_tics(script, "y", low, page->work.high[1], 10, false, power_text);
    if (page->references) {
        fputs("set ytics add ('ref.' ", script);
        dea_gnuplot_number(script, page->floor);
        fputs(")\n", script);
    }
    if (page->statics) {
        fputs("set label 1 '(a)' at graph 0, graph 1.04 left\n", script);
    }
    label_settings(page, script);
    for (size_t i = 0; i < bench->setting_count; i++) {
        if (begins_curve(bench, i)) {
            write_curve(page, script, i);
        }
    }
    fputc('\n', script);
}

/* ---- the panel of models */

/* A block for each model: time, median error, largest error. */
static void write_model_data(sheet *page, FILE *script)
{
    const dea_bench *bench = page->bench;
    const panel *part = &page->models;
    for (size_t i = 0; i < bench->model_count; i++) {
        double time, error;
        fprintf(script, "$model%zu << END\nNaN NaN NaN\n", i);
        if (model_spot(bench, i, &time, &error)) {
            const double worst = bench->models[i].error_worst, across = place_x(part, time);
            dea_gnuplot_number(script, time);
            fputc(' ', script);
            dea_gnuplot_number(script, error);
            fputc(' ', script);
            dea_gnuplot_number(script, worst);
            fputc('\n', script);
            take_mark(page, across, place_y(part, error));
            take_box(page, (taken){across - 5.0, place_y(part, error), across + 5.0, place_y(part, worst) - 3.0});
        }
        fputs("END\n", script);
    }
}

/* What a model without error costs: a line. */
static void write_truth(sheet *page, FILE *script, const char *name, double time, const char *colour)
{
    fputs("set arrow from ", script);
    dea_gnuplot_number(script, time);
    fputs(", graph 0 to ", script);
    dea_gnuplot_number(script, time);
    fprintf(script, ", graph 1 nohead dashtype (6, 4) linewidth 1.4 linecolor '%s'\nset label %zu ", colour, ++page->label);
    dea_gnuplot_text(script, name);
    fputs(" at ", script);
    dea_gnuplot_number(script, time);
    fprintf(script, ", graph 0.04 right offset -0.8, 0 font ',9' textcolor '%s'\n", colour);
}

static void label_models(sheet *page, FILE *script)
{
    const dea_bench *bench = page->bench;
    for (size_t i = 0; i < bench->model_count; i++) {
        double time, error;
        char colour[8], name[TEXT];
        const bool marked = model_spot(bench, i, &time, &error);
        dea_plot_colour(i, bench->model_count, colour);
        model_name(bench->models[i].model, name);
        if (marked) {
            label_mark(page, script, &page->models, time, error, name, colour);
        } else if (bench->models[i].model->membrane && isfinite(time)) {
            write_truth(page, script, name, time, colour);
        }
    }
}

static void write_models(sheet *page, FILE *script)
{
    const panel *part = &page->models;
    page->mark_count = page->box_count = 0;
    page->label = 2;
    fputs("unset label\nset label 1 '(b)' at graph 0, graph 1.04 left\n", script);
    dea_plot_place(script, WIDTH, page->height, part->box);
    write_axes(script, "Wall time per point, fastest setting", "Error of the model’s strain against field");
    write_ranges(script, part);
    write_tics(script, "x", part->low[0], part->high[0], (int)(part->box.width / 62.0), false, time_text);
    write_tics(script, "y", part->low[1], part->high[1], 10, true, percent_text);
    write_model_data(page, script);
    label_models(page, script);
    for (size_t i = 0; i < page->bench->model_count; i++) {
        char colour[8];
        dea_plot_colour(i, page->bench->model_count, colour);
        fprintf(script,
                "%s$model%zu using 1:2:2:3 with yerrorbars pointtype 7 pointsize 0.9 linewidth 1.4 linecolor '%s' notitle",
                i > 0 ? ", \\\n " : "plot ", i, colour);
    }
    fputs("\nunset arrow\n", script);
}

/* ---- legend */

static void entry_words(dea_legend *legend, const char *words, const char *colour, size_t dash, int symbol)
{
    dea_legend_entry *entry = dea_legend_add(legend);
    snprintf(entry->label, sizeof entry->label, "%s", words);
    snprintf(entry->colour, sizeof entry->colour, "%s", colour);
    entry->dash = dash;
    entry->symbol = symbol;
}

static void list_models(const sheet *page, dea_legend *legend)
{
    const dea_bench *bench = page->bench;
    for (size_t i = 0; bench->model_count > 1 && i < bench->model_count; i++) {
        char colour[8];
        char name[TEXT];
        dea_plot_colour(i, bench->model_count, colour);
        model_name(bench->models[i].model, name);
        entry_words(legend, name, colour, 1, 0);
    }
}

static void list_engines(const sheet *page, dea_legend *legend)
{
    const dea_bench *bench = page->bench;
    for (size_t e = 0; e < dea_engine_count(); e++) {
        for (size_t i = 0; i < bench->setting_count; i++) {
            if (bench->settings[i].engine == dea_engine_at(e) && is_drawn(&bench->settings[i])) {
                char colour[8] = "#404040";
                int hollow, filled;
                symbols_of(dea_engine_at(e), &hollow, &filled);
                if (bench->model_count == 1) {
                    colour_of(bench, &bench->settings[i], colour);
                }
                entry_words(legend, dea_engine_at(e)->name, colour, bench->model_count == 1, filled);
                break;
            }
        }
    }
}

static void list_marks(const sheet *page, dea_legend *legend)
{
    bool dominated = false, broken = false;
    for (size_t i = 0; i < page->bench->setting_count; i++) {
        dominated = dominated || page->bench->settings[i].dominated;
        broken = broken || page->bench->settings[i].broken;
    }
    if (dominated) {
        entry_words(legend, "hollow: dominated", "#404040", 0, 6);
    }
    if (broken) {
        entry_words(legend, "promise broken", "#b00000", 0, 2);
    }
    entry_words(legend, "10⁻³ accuracy asked for", "#404040", 0, 0);
    if (page->references) {
        entry_words(legend, "reference", "#404040", 0, 3);
    }
}

static double room_of(const dea_legend *legend, size_t from, size_t to)
{
    double room = 0.0;
    for (size_t i = from; i < to; i++) {
        room += dea_legend_room(&legend->entries[i]);
    }
    return room;
}

/* A centred row of entries; its height. */
static double lay_row(dea_legend *legend, size_t from, size_t to, double y)
{
    double x = 0.5 * (WIDTH + 20.0 - room_of(legend, from, to));
    for (size_t i = from; i < to; i++) {
        legend->entries[i].x = x;
        legend->entries[i].y = y;
        x += dea_legend_room(&legend->entries[i]);
    }
    return to > from ? DEA_LEGEND_ROW : 0.0;
}

/* Rows: models, engines, marks; the last two in one where it has room for both. Its height. */
static int make_legend(const sheet *page, dea_legend *legend)
{
    list_models(page, legend);
    const size_t models = legend->count;
    list_engines(page, legend);
    const size_t engines = legend->count;
    list_marks(page, legend);
    const bool together = room_of(legend, models, legend->count) <= WIDTH;
    double y = -lay_row(legend, 0, models, 0.0);
    y -= lay_row(legend, models, together ? legend->count : engines, y);
    y -= lay_row(legend, together ? legend->count : engines, legend->count, y);
    for (size_t i = 0; i < legend->count; i++) {
        legend->entries[i].y += 8.0 - y - DEA_LEGEND_ROW / 2.0;
    }
    return (int)-y + 8;
}

dea_status dea_bench_picture(const dea_bench *bench, dea_gnuplot *picture, dea_error *error)
{
    const panel empty = {.low = {(double)INFINITY, (double)INFINITY}, .high = {-(double)INFINITY, -(double)INFINITY}};
    static const char nothing[] = "nothing to draw: no setting was measured against a reference";
    sheet page = {.bench = bench, .work = empty, .models = empty, .label = 2};
    dea_legend legend = {.count = 0};
    measure_work(&page);
    if (!(page.work.high[0] > page.work.low[0])) {
        return dea_fail(error, DEA_ERROR_USAGE, nothing);
    }
    measure_models(&page);
    const double top = *bench->scene->title ? DEA_TITLE : DEA_NO_TITLE;
    page.work.box = (dea_box){LEFT, top, page.statics ? HALF : WIDE, PANEL};
    page.models.box = (dea_box){SECOND, top, SECOND_WIDTH, PANEL};
    page.height = (int)top + PANEL + LABELS + make_legend(&page, &legend);
    dea_gnuplot_size(picture, WIDTH, page.height);
    write_settings(&page, picture->script);
    dea_plot_style(picture->script);
    dea_plot_title(picture->script, bench->scene->title, page.height);
    fputs("set logscale xy\n", picture->script);
    write_work(&page, picture->script);
    if (page.statics) {
        write_models(&page, picture->script);
    }
    dea_legend_draw(&legend, picture->script, WIDTH, page.height);
    fputs("unset multiplot\nunset output\n", picture->script);
    return DEA_OK;
}
