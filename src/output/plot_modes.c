/* Modes: frequency, damping ratio and share of the edge over the longest axis, a colour for each mode and a dash for each value of the
 * other axes and each model; of runs without an axis their shapes over the radius. */
#include "output/strips.h"

#include <math.h>
#include <stdint.h>
#include <string.h>

static const double last_colour = 0.85; /* of the gradient: beyond it is too pale for a line */

typedef struct sheet {
    const dea_plot *plot;
    dea_layout layout;
    size_t axis, groups; /* number of the axis along x, SIZE_MAX: shapes over the radius; curves of each mode */
    size_t places;       /* along x */
    dea_scale scale;     /* of x */
} sheet;

static size_t longest_axis(const dea_scene *scene)
{
    size_t longest = SIZE_MAX;
    for (size_t i = 0; i < scene->axis_count; i++) {
        if (scene->axes[i].count > 1 && (longest == SIZE_MAX || scene->axes[i].count > scene->axes[longest].count)) {
            longest = i;
        }
    }
    return longest;
}

static sheet sheet_of(const dea_plot *plot)
{
    const dea_scene *scene = plot->scene;
    sheet page = {.plot = plot, .layout = dea_layout_of(scene), .axis = longest_axis(scene)};
    const dea_axis *axis = page.axis == SIZE_MAX ? NULL : &scene->axes[page.axis];
    page.places = axis ? axis->count : page.layout.spread_points;
    page.groups = dea_scene_point_count(scene) * scene->model_count / (axis ? axis->count : 1);
    page.scale = axis ? dea_scale_axis(axis) : dea_scale_choose(scene->actuator.frame_radius, "m");
    return page;
}

static dea_status modes_open(dea_plot *plot, dea_error *error)
{
    const sheet page = sheet_of(plot);
    if (page.places == 0) {
        return dea_fail(error, DEA_ERROR_USAGE, "nothing to draw: over gives no axis, and study.modes.points no shapes");
    }
    if (page.groups * page.layout.rows > DEA_CURVES_MAX) {
        return dea_fail(error, DEA_ERROR_USAGE, "%zu curves are too many for one picture (at most %d): give the other axes fewer values",
                        page.groups * page.layout.rows, DEA_CURVES_MAX);
    }
    return dea_plot_keep(plot, error);
}

/* Point number @p place along x of a group: models slowest, the last of the other axes fastest. */
static char *point_at(const sheet *page, size_t group, size_t place)
{
    const dea_scene *scene = page->plot->scene;
    size_t number = group;
    if (page->axis != SIZE_MAX) {
        size_t inner = 1;
        for (size_t i = page->axis + 1; i < scene->axis_count; i++) {
            inner *= scene->axes[i].count;
        }
        number = (group / inner * scene->axes[page->axis].count + place) * inner + group % inner;
    }
    return page->plot->kept + number * page->layout.point_size;
}

static double x_at(const sheet *page, size_t place)
{
    const dea_scene *scene = page->plot->scene;
    const double x = page->axis == SIZE_MAX ? dea_layout_radius(scene, &page->layout, place) : scene->axes[page->axis].values[place];
    return x * page->scale.factor;
}

static void mode_colour(const sheet *page, size_t mode, char colour[8])
{
    const size_t rows = page->layout.rows;
    dea_plot_gradient(rows > 1 ? last_colour * (double)mode / (double)(rows - 1) : 0.25, colour);
}

/* A strip of a column of the rows, times a factor; without an axis of the shapes. */
static void add_strip(const sheet *page, dea_strips *strips, const char *label, size_t offset, double factor)
{
    const size_t strip = strips->count++;
    snprintf(strips->strips[strip].label, DEA_LABEL_LENGTH, "%s", label);
    for (size_t i = 0; i < page->groups * page->layout.rows; i++) {
        const size_t group = i / page->layout.rows, mode = i % page->layout.rows;
        char colour[8];
        mode_colour(page, mode, colour);
        dea_strip_curve *curve = dea_strips_add(strips, strip, colour, group + 1);
        for (size_t k = 0; k < page->places; k++) {
            double y;
            if (page->axis == SIZE_MAX) {
                y = *dea_layout_entry(&page->layout, point_at(page, group, 0), mode, k);
            } else {
                memcpy(&y, point_at(page, group, k) + mode * page->layout.row_size + offset, sizeof y);
            }
            dea_strip_point(strips, curve, x_at(page, k), factor * y);
        }
    }
}

static void list(const sheet *page, dea_legend *legend, size_t kinds[3])
{
    for (size_t i = 0; i < page->layout.rows; i++) {
        dea_legend_entry *entry = dea_legend_add(legend);
        double frequency;
        memcpy(&frequency, point_at(page, 0, 0) + i * page->layout.row_size + offsetof(dea_mode, frequency), sizeof frequency);
        entry->dash = 1;
        mode_colour(page, i, entry->colour);
        const int used = snprintf(entry->label, sizeof entry->label, "mode %zu", i + 1);
        if (page->axis == SIZE_MAX && page->groups == 1) {
            snprintf(entry->label + used, sizeof entry->label - (size_t)used, ", %.4g Hz", frequency);
        }
    }
    kinds[1] = legend->count;
    for (size_t group = 0; page->groups > 1 && group < page->groups; group++) {
        dea_legend_entry *entry = dea_legend_add(legend);
        entry->dash = group + 1;
        snprintf(entry->colour, sizeof entry->colour, "#505050");
        dea_strips_name(page->plot->scene, page->axis, group, entry->label, sizeof entry->label);
    }
    kinds[2] = legend->count;
}

static dea_status modes_draw(dea_plot *plot, dea_error *error)
{
    const sheet page = sheet_of(plot);
    const dea_axis *axis = page.axis == SIZE_MAX ? NULL : &plot->scene->axes[page.axis];
    dea_strips strips;
    dea_status status = dea_strips_open(&strips, 3 * page.groups * page.layout.rows, page.places, error);
    if (status == DEA_OK) {
        strips.logarithmic = plot->picture.log_x || (axis && dea_axis_logarithmic(axis));
        strips.strips[0] = (dea_strip){.floats = true, .logarithmic = axis && plot->picture.log_y};
        if (axis) {
            dea_label_axis(axis, &page.scale, strips.label);
            add_strip(&page, &strips, "Frequency [Hz]", offsetof(dea_mode, frequency), 1.0);
            add_strip(&page, &strips, "Damping ratio", offsetof(dea_mode, damping_ratio), 1.0);
            add_strip(&page, &strips, "Share of edge [%]", offsetof(dea_mode, edge_share), 100.0);
        } else {
            snprintf(strips.label, sizeof strips.label, "Radius at 0 V [%s]", page.scale.unit);
            add_strip(&page, &strips, "Shape [g⁻½]", 0, sqrt(1e-3));
        }
        list(&page, &strips.legend, strips.kinds);
        status = dea_strips_draw(&strips, plot, error);
    }
    dea_strips_close(&strips);
    return status;
}

const dea_drawer dea_drawer_modes = {modes_open, dea_plot_take, modes_draw};
