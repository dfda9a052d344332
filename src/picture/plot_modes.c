/* Modes: frequency, damping ratio and share of the edge over the longest axis, a colour for each mode and a dash for each value of the
 * other axes and each model; of runs without an axis their shapes over the radius. */
#include "picture/figure.h"

#include <math.h>
#include <stdint.h>

enum { TALL = 250, SMALL = 150 }; /* heights of the first panel and of others */

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

/* Number of point @p place along x of a group: models slowest, the last of the other axes fastest. */
static size_t number_at(const sheet *page, size_t group, size_t place)
{
    const dea_scene *scene = page->plot->scene;
    size_t inner = 1;
    if (page->axis == SIZE_MAX) {
        return group;
    }
    for (size_t i = page->axis + 1; i < scene->axis_count; i++) {
        inner *= scene->axes[i].count;
    }
    return (group / inner * scene->axes[page->axis].count + place) * inner + group % inner;
}

static char *point_at(const sheet *page, size_t group, size_t place)
{
    return page->plot->kept + number_at(page, group, place) * page->layout.point_size;
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

/* A panel of a column of the rows, times a factor; without an axis of the shapes. */
static void add_panel(const sheet *page, dea_figure *figure, const char *label, size_t offset, double factor)
{
    const size_t number = figure->count;
    dea_panel *panel = dea_figure_panel(figure, number == 0 ? TALL : SMALL, label);
    panel->factor = factor;
    panel->floats = number == 0;
    panel->zero = number > 0;
    panel->span.logarithmic = number == 0 && page->axis != SIZE_MAX && page->plot->picture.log_y;
    for (size_t i = 0; i < page->groups * page->layout.rows; i++) {
        const size_t group = i / page->layout.rows, mode = i % page->layout.rows;
        dea_look look = {.dash = group + 1};
        mode_colour(page, mode, look.colour);
        dea_figure_curve(figure, number, look, 1.8);
        for (size_t k = 0; k < page->places; k++) {
            const double y = page->axis == SIZE_MAX ? *dea_layout_entry(&page->layout, point_at(page, group, 0), mode, k)
                                                    : dea_layout_number(point_at(page, group, k) + mode * page->layout.row_size, offset);
            dea_figure_point(figure, x_at(page, k), y, 0);
        }
    }
    dea_figure_prune(figure);
}

static int list(const sheet *page, dea_legend *legend)
{
    size_t kinds[3] = {0};
    for (size_t i = 0; i < page->layout.rows; i++) {
        dea_legend_entry *entry = dea_legend_add(legend);
        const double frequency = dea_layout_number(point_at(page, 0, 0) + i * page->layout.row_size, offsetof(dea_mode, frequency));
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
        dea_label_run(page->plot->scene, number_at(page, group, 0), page->axis, entry->label, sizeof entry->label);
    }
    kinds[2] = legend->count;
    return dea_legend_lay(legend, kinds, 2, page->plot->picture.canvas.width);
}

static dea_status modes_draw(dea_plot *plot, dea_error *error)
{
    const sheet page = sheet_of(plot);
    const dea_axis *axis = page.axis == SIZE_MAX ? NULL : &plot->scene->axes[page.axis];
    dea_figure figure = dea_figure_begin(&plot->picture, plot->scene->title, plot->picture.log_x || (axis && dea_axis_logarithmic(axis)));
    if (axis) {
        dea_label_axis(axis, &page.scale, figure.across[0].label);
        add_panel(&page, &figure, "Frequency [Hz]", offsetof(dea_mode, frequency), 1.0);
        add_panel(&page, &figure, "Damping ratio", offsetof(dea_mode, damping_ratio), 1.0);
        add_panel(&page, &figure, "Share of edge [%]", offsetof(dea_mode, edge_share), 100.0);
    } else {
        snprintf(figure.across[0].label, sizeof figure.across[0].label, "Radius at 0 V [%s]", page.scale.unit);
        add_panel(&page, &figure, "Shape [g⁻½]", 0, sqrt(1e-3));
    }
    figure.foot = list(&page, &figure.legend);
    return dea_figure_end(&figure, dea_figure_stack(&figure, SIZE_MAX, error), error);
}

const dea_drawer dea_drawer_modes = {modes_open, dea_plot_take, modes_draw};
