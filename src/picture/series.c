#include "picture/series.h"

#include "picture/panel.h"

#include <math.h>
#include <stdint.h>
#include <stdio.h>

enum {
    KINDS = 3,      /* of legend entries: groups, models, marks */
    TOLD_APART = 6, /* shades and marks that are */
    SYMBOLS = 8,
    PLACES = 6      /* marks on a curve */
};

static const double shade_depth = 0.42; /* how far the shades of the outer groups go to black and white */
static const double bar_end = 0.9;      /* of the gradient: beyond it is too pale for a line */
static const char neutral[] = "#505050";

const dea_mark dea_marks[DEA_MARKS] = {
    {DEA_STATE_SLACK, 6, 7, "slack"},
    {DEA_STATE_BREAKDOWN, 8, 9, "breakdown"},
    {DEA_STATE_PULL_IN, 5, 5, "pull-in"},
};

/* Of groups: none is that of a limit. */
static const int symbols[SYMBOLS] = {11, 13, 2, 15, 1, 12, 3, 10};

dea_series dea_series_of(const dea_scene *scene, size_t along, size_t groups)
{
    dea_series series = {.scene = scene, .along = along, .groups = groups, .bar = SIZE_MAX};
    for (size_t i = 0; groups > TOLD_APART && i < scene->axis_count; i++) {
        if (i != along && (series.bar == SIZE_MAX || scene->axes[i].count > scene->axes[series.bar].count)) {
            series.bar = i;
            series.scale = dea_scale_axis(&scene->axes[i]);
        }
    }
    return series;
}

/* Index that a group has on axis number @p axis, one of those that make the groups. */
static size_t group_index(const dea_series *series, size_t group, size_t axis)
{
    size_t step = 1;
    for (size_t i = series->scene->axis_count; i-- > axis + 1;) {
        step *= i == series->along ? 1 : series->scene->axes[i].count;
    }
    return group / step % series->scene->axes[axis].count;
}

/* Number of a group among those of the axes that have marks: all but the one along x and that of the colour scale. */
static size_t group_mark(const dea_series *series, size_t group)
{
    size_t number = 0;
    for (size_t i = 0; i < series->scene->axis_count; i++) {
        if (i != series->along && i != series->bar) {
            number = number * series->scene->axes[i].count + group_index(series, group, i);
        }
    }
    return number;
}

static size_t mark_count(const dea_series *series)
{
    return series->bar == SIZE_MAX ? series->groups : series->groups / series->scene->axes[series->bar].count;
}

/* Values of the axes of a group, but for those of the colour scale. */
static void group_label(const dea_series *series, size_t group, char *label, size_t size)
{
    size_t used = 0;
    *label = '\0';
    for (size_t i = 0; i < series->scene->axis_count; i++) {
        const dea_axis *axis = &series->scene->axes[i];
        if (i == series->along || i == series->bar || axis->count == 1) {
            continue;
        }
        const dea_scale scale = dea_scale_axis(axis);
        char part[DEA_LABEL_LENGTH];
        dea_label_value(axis, &scale, group_index(series, group, i), part);
        if (used < size) {
            used += (size_t)snprintf(label + used, size - used, "%s%s", used > 0 ? ", " : "", part);
        }
    }
}

static void model_label(const dea_scene *scene, size_t model, char label[DEA_LABEL_LENGTH])
{
    snprintf(label, DEA_LABEL_LENGTH, "%s", scene->models[model]->name);
    for (char *letter = label; *letter; letter++) {
        *letter = *letter == '_' ? ' ' : *letter;
    }
}

dea_look dea_model_look(const dea_model *model)
{
    static const struct {
        const char *colour;
        size_t dash;
    } looks[] = {{"#56b4e9", 7}, {"#cc79a7", 8}, {"#0072b2", 1}, {"#d55e00", 2}, {"#6a3d9a", 5}, {"#009e73", 3}, {"#8c6d1f", 4}, {"#555555", 6}};
    dea_look look = {.dash = 1};
    size_t place = 0;
    while (dea_model_at(place) && dea_model_at(place) != model) {
        place++;
    }
    place %= sizeof looks / sizeof *looks;
    snprintf(look.colour, sizeof look.colour, "%s", looks[place].colour);
    look.dash = looks[place].dash;
    return look;
}

/* Shade of a colour for one group of several: dark to light. */
static void shade(char colour[8], size_t group, size_t groups)
{
    const double place = groups > 1 ? shade_depth * (2.0 * (double)group / (double)(groups - 1) - 1.0) : 0.0;
    unsigned rgb[3];
    if (sscanf(colour, "#%2x%2x%2x", &rgb[0], &rgb[1], &rgb[2]) == 3) {
        for (int i = 0; i < 3; i++) {
            rgb[i] = (unsigned)lround(rgb[i] + fabs(place) * ((place > 0.0 ? 255.0 : 0.0) - rgb[i])) & 0xffu;
        }
        snprintf(colour, 8, "#%02x%02x%02x", rgb[0], rgb[1], rgb[2]);
    }
}

dea_look dea_series_look(const dea_series *series, size_t model, size_t group)
{
    dea_look look = dea_model_look(series->scene->models[model]);
    look.symbol = mark_count(series) > 1 ? symbols[group_mark(series, group) % SYMBOLS] : 0;
    look.scaled = series->bar != SIZE_MAX;
    look.dash = series->scene->model_count > 1 ? look.dash : 1; /* dots would hide a fast swing for nothing */
    if (look.scaled) {
        look.value = series->scene->axes[series->bar].values[group_index(series, group, series->bar)] * series->scale.factor;
    } else {
        shade(look.colour, group, series->groups);
    }
    return look;
}

void dea_look_colour(FILE *script, const dea_look *look)
{
    if (look->scaled) {
        dea_gnuplot_put(script, "linecolor palette cb %g", look->value);
    } else {
        fprintf(script, "linecolor '%s'", look->colour);
    }
}

int dea_series_mark(const dea_series *series, size_t group, double share)
{
    const double offset = ((double)group + 0.5) / (double)series->groups;
    return (int)floor(PLACES * share - offset + 1.0);
}

void dea_series_bar(const dea_series *series, FILE *script, dea_canvas canvas, int height, dea_box panel)
{
    const dea_axis *axis = &series->scene->axes[series->bar];
    char label[DEA_LABEL_LENGTH];
    dea_span span = {INFINITY, -INFINITY, dea_axis_logarithmic(axis)};
    for (size_t i = 0; i < axis->count; i++) {
        dea_span_take(&span, axis->values[i] * series->scale.factor);
    }
    dea_plot_palette(script, bar_end);
    dea_span_write(script, "cb", &span, panel.height, dea_name_plain);
    dea_label_axis(axis, &series->scale, label);
    dea_gnuplot_put(script,
                    "set cblabel offset 1.5,0 textcolor '#202020' %q\n"
                    "set colorbox vertical user origin screen %g, screen %g size screen %g, screen %g\n",
                    label, (canvas.width - DEA_BAR + 12.0) / canvas.width, 1.0 - (panel.top + panel.height) / height,
                    14.0 / canvas.width, panel.height / height);
}

/* Groups, or marks where the groups have a colour scale. */
static void list_groups(const dea_series *series, dea_legend *legend)
{
    const size_t count = mark_count(series);
    const bool one = series->scene->model_count == 1;
    for (size_t group = 0, listed = 0; count > 1 && listed < count && group < series->groups; group++) {
        if (group_mark(series, group) != listed) {
            continue;
        }
        listed++;
        const dea_look look = dea_series_look(series, 0, group);
        dea_legend_entry *entry = dea_legend_add(legend);
        entry->symbol = look.symbol;
        entry->dash = look.scaled ? 0 : one ? look.dash : 1;
        group_label(series, group, entry->label, sizeof entry->label);
        snprintf(entry->colour, sizeof entry->colour, "%s", one && !look.scaled ? look.colour : neutral);
        if (!one && !look.scaled) {
            shade(entry->colour, group, series->groups);
        }
    }
}

/* Entries in the order groups, models, marks; kinds[i] is the first of kind i. */
static void legend_list(const dea_series *series, const bool seen[DEA_MARKS], dea_legend *legend, size_t kinds[KINDS + 1])
{
    const dea_scene *scene = series->scene;
    kinds[0] = 0;
    list_groups(series, legend);
    kinds[1] = legend->count;
    for (size_t i = 0; scene->model_count > 1 && i < scene->model_count; i++) {
        const dea_look look = dea_model_look(scene->models[i]);
        dea_legend_entry *entry = dea_legend_add(legend);
        entry->dash = look.dash;
        model_label(scene, i, entry->label);
        snprintf(entry->colour, sizeof entry->colour, "%s", series->bar == SIZE_MAX ? look.colour : neutral);
    }
    kinds[2] = legend->count;
    for (size_t i = 0; i < DEA_MARKS; i++) {
        if (seen[i]) {
            dea_legend_entry *entry = dea_legend_add(legend);
            entry->symbol = dea_marks[i].symbol;
            snprintf(entry->colour, sizeof entry->colour, "%s", neutral);
            snprintf(entry->label, sizeof entry->label, "%s", dea_marks[i].legend);
        }
    }
    kinds[3] = legend->count;
}

int dea_series_legend(const dea_series *series, const bool seen[DEA_MARKS], int width, dea_legend *legend)
{
    size_t kinds[KINDS + 1];
    legend_list(series, seen, legend, kinds);
    return dea_legend_lay(legend, kinds, KINDS, width);
}
