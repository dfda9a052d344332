/* Work-precision diagram: error over time, a curve for each engine and model, and beside it what the models
 * themselves are off by. Colour and dash tell the model, the symbol the engine; a hollow symbol is dominated. */
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "study/study.h"
#include "output/bench.h"
#include "output/picture.h"
#include "output/series.h"
#include "support/text.h"

enum {
    LEFT = 96,
    RIGHT = 24,
    PANEL = 380,
    LABELS = 68, /* below the panels */
    LEAST = 100, /* panel that can be read */
    WORDS = 1024, /* marks, and labels at them */
    KINDS = 3    /* of legend entries: models, engines, marks */
};

static const double letter = 6.6, line_height = 13.0; /* of a label at a mark [units] */
static const double smallest = 1e-17;                 /* error that is drawn */
static const double share = 0.62;                     /* of the width, for work and precision where the models stand beside it */

typedef struct panel {
    dea_box box;
    dea_span x, y;
} panel;

typedef struct sheet {
    const dea_bench *bench;
    panel work, models;
    double floor; /* where references are drawn, as an error */
    bool references, models_shown;
    dea_box words[WORDS]; /* where marks and labels stand */
    size_t word_count;
    dea_canvas canvas;
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

static dea_look look_of(const dea_bench *bench, size_t model)
{
    return dea_model_look(bench->models[model].model);
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

/* Time a point of a model's fastest setting that keeps its promise, NAN without one. */
static double fastest(const dea_bench *bench, size_t model)
{
    double best = (double)NAN;
    for (size_t i = 0; i < bench->setting_count; i++) {
        const dea_bench_setting *setting = &bench->settings[i];
        if (setting->model == model && is_drawn(setting) && !setting->broken) {
            best = fmin(best, time_of(bench, setting));
        }
    }
    return best;
}

/* Median error of a model as drawn: no less than what its worst leaves to be seen. */
static double median_of(const dea_bench_model *model)
{
    return fmax(model->error_median, 1e-4 * model->error_worst);
}

/* ---- ranges */

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
        if (is_drawn(&bench->settings[i])) {
            dea_span_take(&page->work.x, time_of(bench, &bench->settings[i]));
            dea_span_take(&page->work.y, error_of(page, &bench->settings[i]));
        }
    }
}

static void measure_models(sheet *page)
{
    const dea_bench *bench = page->bench;
    for (size_t i = 0; i < bench->model_count; i++) {
        const dea_bench_model *model = &bench->models[i];
        if (isfinite(fastest(bench, i)) && model->error_worst > 0.0) {
            page->models_shown = true;
            dea_span_take(&page->models.y, median_of(model));
            dea_span_take(&page->models.y, model->error_worst);
        }
        if (model->error_worst > 0.0 || model->model->membrane) {
            dea_span_take(&page->models.x, fastest(bench, i));
        }
    }
}

/* ---- tics */

/* "100 ns" for 1e-7. */
static void time_text(double value, char text[DEA_LABEL_LENGTH])
{
    dea_name_prefixed(value, text);
    const size_t length = strlen(text), digits = strspn(text, "0123456789.");
    char prefix[8];
    snprintf(prefix, sizeof prefix, "%s", text + digits);
    snprintf(text + digits, DEA_LABEL_LENGTH - length, " %ss", prefix);
}

/* "10 %" for 0.1; gnuplot reads tics as formats, so that the sign is doubled. */
static void percent_text(double value, char text[DEA_LABEL_LENGTH])
{
    snprintf(text, DEA_LABEL_LENGTH, "%g %%%%", 100.0 * value);
}

/* ---- labels at marks */

static bool overlap(const dea_box *a, const dea_box *b)
{
    return fabs(a->left - b->left) < 0.5 * (a->width + b->width) && fabs(a->top - b->top) < 0.5 * (a->height + b->height);
}

/* Takes the place of a mark: left and top of such boxes are their middle. */
static void take_mark(sheet *page, const panel *part, double x, double y)
{
    enum { MARK = 10 };
    if (page->word_count < WORDS) {
        page->words[page->word_count++] = (dea_box){part->box.left + dea_span_share(&part->x, x) * part->box.width,
                                                    part->box.top + (1.0 - dea_span_share(&part->y, y)) * part->box.height, MARK, MARK};
    }
}

/* Writes a label beside a mark, where nothing stands. */
static void write_word(sheet *page, FILE *script, const panel *part, double x, double y, const char *text, const char *colour)
{
    const double width = letter * (double)dea_text_letters(text), across = dea_span_share(&part->x, x) * part->box.width;
    const double side = across + width + 14.0 < part->box.width ? 1.0 : -1.0;
    const dea_box box = {part->box.left + across + side * (8.0 + 0.5 * width),
                         part->box.top + (1.0 - dea_span_share(&part->y, y)) * part->box.height, width, line_height};
    for (size_t i = 0; i < page->word_count; i++) {
        if (overlap(&box, &page->words[i])) {
            return;
        }
    }
    if (page->word_count == WORDS) {
        return;
    }
    page->words[page->word_count++] = box;
    dea_gnuplot_put(script, "set label %z %q at screen %g, screen %g center font ',9' textcolor '%s'\n", 10 + page->word_count, text,
                    box.left / page->canvas.width, 1.0 - box.top / page->height, colour);
}

static bool begins_curve(const dea_bench *bench, size_t i)
{
    return i == 0 || bench->settings[i].model != bench->settings[i - 1].model ||
           bench->settings[i].engine != bench->settings[i - 1].engine;
}

/* Accuracies at the ends of the curves; a closed form needs none. */
static void write_accuracies(sheet *page, FILE *script)
{
    const dea_bench *bench = page->bench;
    for (size_t i = 0; i < bench->setting_count; i++) {
        if (is_drawn(&bench->settings[i])) {
            take_mark(page, &page->work, time_of(bench, &bench->settings[i]), error_of(page, &bench->settings[i]));
        }
    }
    for (size_t i = 0; i < bench->setting_count; i++) {
        const dea_bench_setting *setting = &bench->settings[i];
        const bool end = begins_curve(bench, i) || i + 1 == bench->setting_count || begins_curve(bench, i + 1);
        char text[DEA_LABEL_LENGTH] = "any";
        if (is_drawn(setting) && end && !(setting->any && setting->reference)) {
            if (!setting->any) {
                dea_name_power(setting->accuracy, text);
            }
            write_word(page, script, &page->work, time_of(bench, setting), error_of(page, setting), text,
                       look_of(bench, setting->model).colour);
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
            dea_gnuplot_put(script, "%g %g %g %g %g %g\n", time_of(bench, setting), setting->reference ? none : y,
                            !setting->reference && !setting->dominated ? y : none,
                            !setting->reference && setting->dominated ? y : none, setting->broken ? y : none,
                            setting->reference ? y : none);
        }
    }
    fputs("END\n", script);
}

static void write_curve(const sheet *page, FILE *script, size_t i)
{
    const dea_bench_setting *setting = &page->bench->settings[i];
    const dea_look look = look_of(page->bench, setting->model);
    int hollow, filled;
    symbols_of(setting->engine, &hollow, &filled);
    fprintf(script, "%s$curve%zu using 1:2 with lines linewidth 1.2 linecolor '%s' %s", i > 0 ? ", \\\n " : "plot ", i,
            look.colour, dea_plot_dash(look.dash));
    const struct {
        int column, symbol;
        double size;
        const char *colour;
    } marks[] = {{3, filled, 0.8, look.colour}, {4, filled, 0.8, "#ffffff"}, {4, hollow, 0.8, look.colour},
                 {5, 2, 1.4, "#b00000"},        {6, filled, 0.8, look.colour}, {6, 3, 1.3, look.colour}};
    for (size_t k = 0; k < sizeof marks / sizeof *marks; k++) {
        fprintf(script, ", \\\n $curve%zu using 1:%d with points pointtype %d pointsize %g*ps linewidth 1.3 linecolor '%s'", i,
                marks[k].column, marks[k].symbol, marks[k].size, marks[k].colour);
    }
}

static const char *error_label(const dea_bench *bench)
{
    return dea_study_of(bench->scene)->timed ? "Numerical error, relative to the peak" : "Numerical error, relative";
}

/* Opens a panel: its place, its labels and ranges; @p tag is empty where it stands alone. */
static void write_panel(const sheet *page, FILE *script, const panel *part, const char *across, const char *up, const char *tag)
{
    dea_plot_place(script, page->canvas.width, page->height, part->box);
    dea_gnuplot_put(script, "set xlabel %q\nset ylabel %q\nset label 1 '%s' at graph 0, graph 1 offset character 0, character 0.8\n",
                    across, up, tag);
    dea_span_write(script, "x", &part->x, 0.7 * part->box.width, time_text);
}

static void write_work(sheet *page, FILE *script)
{
    const dea_bench *bench = page->bench;
    const panel *part = &page->work;
    dea_span errors = part->y;
    write_panel(page, script, part, dea_study_of(bench->scene)->unit_label, error_label(bench), page->models_shown ? "(a)" : "");
    dea_span_write(script, "y", &part->y, part->box.height, dea_name_power);
    if (page->references) {
        errors.low = 3.0 * page->floor;
        dea_span_tics(script, "y", &errors, part->box.height, dea_name_power, false);
        dea_gnuplot_put(script, "set ytics add ('ref.' %g)\n", page->floor);
    }
    write_accuracies(page, script);
    for (size_t i = 0; i < bench->setting_count; i++) {
        if (begins_curve(bench, i)) {
            write_curve(page, script, i);
        }
    }
    fputs("\nunset label\n", script);
}

/* ---- the panel of models */

/* A block for each model, time, median error, largest error; a model without error is a line at its time. */
static void write_model(sheet *page, FILE *script, size_t number)
{
    const dea_bench_model *model = &page->bench->models[number];
    const double time = fastest(page->bench, number);
    const bool marked = isfinite(time) && model->error_worst > 0.0, line = isfinite(time) && !marked && model->model->membrane;
    const dea_look look = look_of(page->bench, number);
    fprintf(script, "$model%zu << END\nNaN NaN NaN\n", number);
    for (int end = 0; end < (line ? 2 : marked); end++) {
        const double y[] = {page->models.y.low, page->models.y.high};
        dea_gnuplot_put(script, "%g %g %g\n", time, line ? y[end] : median_of(model), line ? y[end] : model->error_worst);
    }
    fputs("END\n", script);
    if (marked || line) {
        write_word(page, script, &page->models, time, marked ? median_of(model) : 1.5 * page->models.y.low, model->model->name,
                   look.colour);
    }
}

static void write_models(sheet *page, FILE *script)
{
    const panel *part = &page->models;
    const bool moves = dea_study_of(page->bench->scene)->along;
    write_panel(page, script, part, "The same, fastest setting", moves ? "Displacement off from field" : "Strain off from field", "(b)");
    dea_span_write(script, "y", &part->y, part->box.height, percent_text);
    for (size_t i = 0; i < page->bench->model_count; i++) {
        write_model(page, script, i);
    }
    for (size_t i = 0; i < page->bench->model_count; i++) {
        const dea_look look = look_of(page->bench, i);
        const bool line = page->bench->models[i].model->membrane;
        fprintf(script, "%s$model%zu using %s linewidth 1.4 linecolor '%s' %s", i > 0 ? ", \\\n " : "plot ", i,
                line ? "1:2 with lines" : "1:2:2:3 with yerrorbars pointtype 7 pointsize 0.9*ps", look.colour,
                dea_plot_dash(line ? look.dash : 1));
    }
    fputc('\n', script);
}

/* ---- legend */

static void add_entry(dea_legend *legend, const char *words, const char *colour, size_t dash, int symbol)
{
    dea_legend_entry *entry = dea_legend_add(legend);
    snprintf(entry->label, sizeof entry->label, "%s", words);
    snprintf(entry->colour, sizeof entry->colour, "%s", colour);
    entry->dash = dash;
    entry->symbol = symbol;
}

static void list_engines(const sheet *page, dea_legend *legend)
{
    for (size_t e = 0; e < dea_engine_count(); e++) {
        bool seen = false;
        int hollow, filled;
        for (size_t i = 0; i < page->bench->setting_count; i++) {
            seen = seen || (page->bench->settings[i].engine == dea_engine_at(e) && is_drawn(&page->bench->settings[i]));
        }
        if (seen) {
            symbols_of(dea_engine_at(e), &hollow, &filled);
            add_entry(legend, dea_engine_at(e)->name, "#404040", 0, filled);
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
        add_entry(legend, "hollow: dominated", "#404040", 0, 6);
    }
    if (broken) {
        add_entry(legend, "promise broken", "#b00000", 0, 2);
    }
    if (page->references) {
        add_entry(legend, "reference", "#404040", 0, 3);
    }
    add_entry(legend, "10⁻³: accuracy asked for", "#404040", 0, 0);
}

static int make_legend(const sheet *page, dea_legend *legend)
{
    size_t kinds[KINDS + 1] = {0};
    for (size_t i = 0; i < page->bench->model_count; i++) {
        const dea_look look = look_of(page->bench, i);
        add_entry(legend, page->bench->models[i].model->name, look.colour, look.dash, 0);
    }
    kinds[1] = legend->count;
    list_engines(page, legend);
    kinds[2] = legend->count;
    list_marks(page, legend);
    kinds[3] = legend->count;
    return dea_legend_lay(legend, kinds, KINDS, page->canvas.width);
}

/* Puts the panels beside each other; false where they have no room. */
static bool place_panels(sheet *page, int legend)
{
    const double top = dea_plot_top(page->bench->scene->title), width = page->canvas.width;
    const double first = page->models_shown ? share * width : width;
    page->height = page->canvas.height > 0 ? page->canvas.height : (int)top + PANEL + LABELS + legend;
    const double height = page->height - top - LABELS - legend;
    page->work.box = (dea_box){LEFT, top, first - LEFT - RIGHT, height};
    page->models.box = (dea_box){first + LEFT, top, width - first - LEFT - RIGHT, height};
    return height >= LEAST && page->work.box.width >= LEAST && (!page->models_shown || page->models.box.width >= LEAST);
}

dea_status dea_bench_picture(const dea_bench *bench, dea_gnuplot *picture, dea_error *error)
{
    const dea_span none = {INFINITY, -INFINITY, true};
    sheet page = {.bench = bench, .work = {.x = none, .y = none}, .models = {.x = none, .y = none}, .canvas = picture->canvas};
    dea_legend legend = {.count = 0};
    measure_work(&page);
    if (!(page.work.x.high >= page.work.x.low)) {
        return dea_fail(error, DEA_ERROR_USAGE, "nothing to draw: no setting was measured against a reference");
    }
    measure_models(&page);
    dea_span *const spans[] = {&page.work.x, &page.work.y, &page.models.x, &page.models.y};
    for (size_t i = 0; i < sizeof spans / sizeof *spans; i++) {
        dea_span_pad(spans[i], true);
    }
    if (!place_panels(&page, make_legend(&page, &legend))) {
        return dea_plot_cramped(picture->canvas, error);
    }
    dea_gnuplot_size(picture, page.height);
    write_settings(&page, picture->script);
    dea_plot_style(picture->script);
    dea_plot_title(picture->script, bench->scene->title, page.canvas.width, page.height);
    write_work(&page, picture->script);
    if (page.models_shown) {
        write_models(&page, picture->script);
    }
    dea_legend_draw(&legend, picture->script, page.canvas.width, page.height);
    return DEA_OK;
}
