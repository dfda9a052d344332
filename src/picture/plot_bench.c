/* Work-precision diagram: error over time, a curve for each engine and model, and beside it what the models
 * themselves are off by. Colour and dash tell the model, the symbol the engine; a hollow symbol is dominated. */
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "study/study.h"
#include "picture/figure.h"

enum { PANEL = 380, LEFT = 96, KINDS = 3 /* of legend entries: models, engines, marks */ };

static const double smallest = 1e-17; /* error that is drawn */
static const double share = 0.62;     /* of the width, for work and precision where the models stand beside it */

typedef struct sheet {
    const dea_bench *bench;
    dea_figure figure;
    double floor; /* where references are drawn, as an error */
    bool references;
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

/* Is a reference drawn, and where: a decade below the least error. */
static void find_floor(sheet *page)
{
    const dea_bench *bench = page->bench;
    double least = 1.0;
    for (size_t i = 0; i < bench->setting_count; i++) {
        const dea_bench_setting *setting = &bench->settings[i];
        page->references = page->references || (is_drawn(setting) && setting->reference);
        least = is_drawn(setting) && !setting->reference ? fmin(least, fmax(setting->error, smallest)) : least;
    }
    page->floor = pow(10.0, floor(log10(least)) - 1.0);
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

static bool begins_curve(const dea_bench *bench, size_t i)
{
    return i == 0 || bench->settings[i].model != bench->settings[i - 1].model ||
           bench->settings[i].engine != bench->settings[i - 1].engine;
}

/* Accuracies at the ends of the curves; a closed form needs none. */
static void add_accuracies(sheet *page)
{
    const dea_bench *bench = page->bench;
    for (size_t i = 0; i < bench->setting_count; i++) {
        const dea_bench_setting *setting = &bench->settings[i];
        const bool end = begins_curve(bench, i) || i + 1 == bench->setting_count || begins_curve(bench, i + 1);
        char text[DEA_LABEL_LENGTH] = "any";
        if (is_drawn(setting) && end && !(setting->any && setting->reference)) {
            if (!setting->any) {
                dea_name_power(setting->accuracy, text);
            }
            dea_figure_word_add(&page->figure, 0, time_of(bench, setting), error_of(page, setting), text,
                                look_of(bench, setting->model).colour);
        }
    }
}

/* Which settings a mark is for. */
static bool is_efficient(const dea_bench_setting *setting)
{
    return !setting->reference && !setting->dominated;
}

static bool is_dominated(const dea_bench_setting *setting)
{
    return !setting->reference && setting->dominated;
}

static bool is_broken(const dea_bench_setting *setting)
{
    return setting->broken;
}

static bool is_reference(const dea_bench_setting *setting)
{
    return setting->reference;
}

/* The curve of a model by an engine, which begins with setting number @p first, and its marks. */
static void add_curve(sheet *page, size_t first)
{
    const dea_bench *bench = page->bench;
    const dea_look look = look_of(bench, bench->settings[first].model);
    int hollow, filled;
    symbols_of(bench->settings[first].engine, &hollow, &filled);
    const struct {
        bool (*of)(const dea_bench_setting *setting);
        int symbol; /* 0: the line through all but references */
        double size;
        const char *colour;
    } parts[] = {{NULL, 0, 0.0, look.colour},           {is_efficient, filled, 0.8, look.colour}, {is_dominated, filled, 0.8, "#ffffff"},
                 {is_dominated, hollow, 0.8, look.colour}, {is_broken, 2, 1.4, "#b00000"},        {is_reference, filled, 0.8, look.colour},
                 {is_reference, 3, 1.3, look.colour}};
    for (size_t k = 0; k < sizeof parts / sizeof *parts; k++) {
        dea_look own = {.dash = look.dash, .symbol = parts[k].symbol, .size = parts[k].size};
        snprintf(own.colour, sizeof own.colour, "%s", parts[k].colour);
        dea_figure_curve(&page->figure, 0, own, parts[k].symbol ? 0.0 : 1.2);
        for (size_t i = first; i < bench->setting_count && (i == first || !begins_curve(bench, i)); i++) {
            const dea_bench_setting *setting = &bench->settings[i];
            if (is_drawn(setting) && (parts[k].of ? parts[k].of(setting) : !setting->reference)) {
                dea_figure_point(&page->figure, time_of(bench, setting), error_of(page, setting), 0);
            }
        }
    }
}

static dea_panel *add_panel(sheet *page, const char *label, const char *across, dea_name *name)
{
    dea_figure *figure = &page->figure;
    dea_panel *panel = dea_figure_panel(figure, PANEL, label);
    panel->span.logarithmic = panel->floats = panel->whole = true;
    panel->name = name;
    panel->across = figure->count - 1;
    snprintf(figure->across[panel->across].label, DEA_LABEL_LENGTH, "%s", across);
    figure->across[panel->across].floats = true;
    figure->across[panel->across].name = time_text;
    figure->across[panel->across].room = 0.7;
    return panel;
}

static void add_work(sheet *page)
{
    const dea_bench *bench = page->bench;
    const dea_study *study = dea_study_of(bench->scene);
    dea_panel *panel = add_panel(page, study->timed ? "Numerical error, relative to the peak" : "Numerical error, relative",
                                 study->unit_label, dea_name_power);
    find_floor(page);
    panel->reference = page->references ? page->floor : 0.0;
    for (size_t i = 0; i < bench->setting_count; i++) {
        if (begins_curve(bench, i)) {
            add_curve(page, i);
        }
    }
    add_accuracies(page);
}

/* A model at its fastest: from the median error, a mark, to the largest; one without error is a line at its time. */
static void add_model(sheet *page, size_t number, const dea_span *errors)
{
    const dea_bench_model *model = &page->bench->models[number];
    const double time = fastest(page->bench, number);
    const bool marked = model->error_worst > 0.0;
    if (!isfinite(time) || !(marked || model->model->membrane)) {
        return;
    }
    const double low = marked ? median_of(model) : errors->low, high = marked ? model->error_worst : errors->high;
    dea_look look = look_of(page->bench, number);
    look.dash = marked ? 1 : look.dash;
    dea_figure_curve(&page->figure, 1, look, 1.4);
    dea_figure_point(&page->figure, time, low, 0);
    dea_figure_point(&page->figure, time, high, 0);
    if (marked) {
        look.symbol = 7;
        look.size = 0.9;
        dea_figure_curve(&page->figure, 1, look, 0.0);
        dea_figure_point(&page->figure, time, low, 0);
    }
    dea_figure_word_add(&page->figure, 1, time, marked ? low : 1.5 * low, model->model->name, look.colour);
}

/* The panel of models, where there is an error to show. */
static void add_models(sheet *page)
{
    const dea_bench *bench = page->bench;
    dea_span errors = {INFINITY, -INFINITY, true};
    for (size_t i = 0; i < bench->model_count; i++) {
        if (isfinite(fastest(bench, i)) && bench->models[i].error_worst > 0.0) {
            dea_span_take(&errors, median_of(&bench->models[i]));
            dea_span_take(&errors, bench->models[i].error_worst);
        }
    }
    if (errors.low > errors.high) {
        return;
    }
    add_panel(page, dea_study_of(bench->scene)->along ? "Displacement off from field" : "Strain off from field", "The same, fastest setting",
              percent_text);
    for (size_t i = 0; i < bench->model_count; i++) {
        add_model(page, i, &errors);
    }
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

static int make_legend(sheet *page)
{
    dea_legend *legend = &page->figure.legend;
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
    return dea_legend_lay(legend, kinds, KINDS, page->figure.picture->canvas.width);
}

dea_status dea_bench_picture(const dea_bench *bench, dea_gnuplot *picture, dea_error *error)
{
    sheet page = {.bench = bench, .figure = dea_figure_begin(picture, bench->scene->title, true)};
    dea_status status = DEA_OK;
    page.figure.left = LEFT;
    add_work(&page);
    add_models(&page);
    page.figure.foot = make_legend(&page);
    if (page.figure.panels[0].span.low > page.figure.panels[0].span.high) {
        status = dea_fail(error, DEA_ERROR_USAGE, "nothing to draw: no setting was measured against a reference");
    }
    status = status ? status : dea_figure_pair(&page.figure, share, PANEL, error);
    return dea_figure_end(&page.figure, status, error);
}
