#include "output/series.h"

#include "output/label.h"
#include "output/picture.h"

#include "deaspice/model.h"

#include <stdio.h>

enum { MARGIN = 20, KINDS = 3 /* of legend entries: groups, models, marks */ };

const dea_mark dea_marks[DEA_MARKS] = {
    {DEA_STATE_SLACK, 6, 7, "slack"},
    {DEA_STATE_BREAKDOWN, 8, 9, "breakdown"},
    {DEA_STATE_PULL_IN, 5, 5, "pull-in"},
};

/* Name of a group of curves: the values of all axes but the one along x. */
static void group_label(const dea_series *series, size_t group, char *label, size_t size)
{
    const dea_scene *scene = series->scene;
    size_t step = series->groups;
    size_t used = 0;
    *label = '\0';
    for (size_t i = 0; i < scene->axis_count; i++) {
        const dea_axis *axis = &scene->axes[i];
        if (i == series->along || axis->count == 1) {
            continue;
        }
        step /= axis->count;
        const dea_scale scale = dea_scale_axis(axis);
        char part[DEA_LABEL_LENGTH];
        dea_label_value(axis, &scale, group / step % axis->count, part);
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

/* Colour follows the group; with one group it follows the model, as the dash does. */
void dea_series_colour(const dea_series *series, size_t model, size_t group, char colour[8])
{
    const bool single = series->groups == 1;
    dea_plot_colour(single ? model : group, single ? series->scene->model_count : series->groups, colour);
}

/* Entries in the order groups, models, marks; kinds[i] is the first of kind i. */
static void legend_list(const dea_series *series, const bool seen[DEA_MARKS], dea_legend *legend, size_t kinds[KINDS + 1])
{
    const dea_scene *scene = series->scene;
    const size_t groups = series->groups > 1 ? series->groups : 0, models = scene->model_count > 1 ? scene->model_count : 0;
    kinds[0] = 0;
    for (size_t i = 0; i < groups; i++) {
        dea_legend_entry *entry = dea_legend_add(legend);
        entry->dash = 1;
        group_label(series, i, entry->label, sizeof entry->label);
        dea_series_colour(series, 0, i, entry->colour);
    }
    kinds[1] = legend->count;
    for (size_t i = 0; i < models; i++) {
        dea_legend_entry *entry = dea_legend_add(legend);
        entry->dash = i + 1;
        model_label(scene, i, entry->label);
        if (groups == 0) {
            dea_series_colour(series, i, 0, entry->colour);
        } else {
            snprintf(entry->colour, sizeof entry->colour, "#404040");
        }
    }
    kinds[2] = legend->count;
    for (size_t i = 0; i < DEA_MARKS; i++) {
        if (seen[i]) {
            dea_legend_entry *entry = dea_legend_add(legend);
            entry->symbol = dea_marks[i].symbol;
            snprintf(entry->colour, sizeof entry->colour, "#404040");
            snprintf(entry->label, sizeof entry->label, "%s", dea_marks[i].legend);
        }
    }
    kinds[3] = legend->count;
}

static double legend_room(const dea_legend *legend, size_t from, size_t to)
{
    double room = 0.0;
    for (size_t i = from; i < to; i++) {
        room += dea_legend_room(&legend->entries[i]);
    }
    return room;
}

/* End of the row that begins with entry @p from: all that is left where it fits, else as much of one kind as fits. */
static size_t legend_row_end(const dea_legend *legend, const size_t kinds[KINDS + 1], size_t from, int width)
{
    const size_t count = kinds[KINDS];
    if (legend_room(legend, from, count) <= width - MARGIN) {
        return count;
    }
    size_t end = count;
    for (int kind = KINDS; kind > 0 && kinds[kind] > from; kind--) {
        end = kinds[kind];
    }
    while (end > from + 1 && legend_room(legend, from, end) > width - MARGIN) {
        end--;
    }
    return end;
}

int dea_series_legend(const dea_series *series, const bool seen[DEA_MARKS], int width, dea_legend *legend)
{
    size_t kinds[KINDS + 1];
    legend_list(series, seen, legend, kinds);
    double y = 0.0;
    for (size_t from = 0; from < legend->count; y -= DEA_LEGEND_ROW) {
        const size_t end = legend_row_end(legend, kinds, from, width);
        double x = 0.5 * (width + MARGIN - legend_room(legend, from, end));
        for (; from < end; from++) {
            legend->entries[from].x = x;
            legend->entries[from].y = y;
            x += dea_legend_room(&legend->entries[from]);
        }
    }
    for (size_t i = 0; i < legend->count; i++) {
        legend->entries[i].y += 8.0 - y - DEA_LEGEND_ROW / 2.0;
    }
    return (int)-y + (y < 0.0 ? 8 : 0);
}
