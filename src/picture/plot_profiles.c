/* Forces over the displacement, a colour for each run; and profiles over the radius: displacement, stretches, true stresses and field; a colour for each run, along the radius solid, along the
 * hoop dashed. */
#include "scene/line.h"
#include "picture/figure.h"
#include "study/study.h"

#include <math.h>
#include <stdint.h>

enum { RADIAL = 1, HOOP = 2, TALL = 250, SMALL = 150 /* heights of the first panel and of others */ };

static const double last_colour = 0.85; /* of the gradient: beyond it is too pale for a line */

static size_t run_count(const dea_plot *plot)
{
    return dea_scene_point_count(plot->scene) * plot->scene->model_count;
}

static dea_status profiles_open(dea_plot *plot, dea_error *error)
{
    if (run_count(plot) > DEA_CURVES_MAX) {
        return dea_fail(error, DEA_ERROR_USAGE, "%zu runs are too many for one picture (at most %d): give the axes fewer values",
                        run_count(plot), DEA_CURVES_MAX);
    }
    return dea_plot_keep(plot, error);
}

/* r_a of a run [m], from the axes at its place. */
static double edge_of(const dea_scene *scene, size_t run)
{
    dea_scene here = *scene;
    dea_axes_place(&here, run % dea_scene_point_count(scene));
    const dea_actuator *actuator = &here.actuator;
    return isnan(actuator->coverage) ? actuator->divide_radius : actuator->coverage * actuator->frame_radius;
}

/* A curve of one run on the last panel, broken at the edge where it jumps there. */
static void add_curve(const dea_plot *plot, dea_figure *figure, size_t run, size_t offset, size_t dash, double factor)
{
    const dea_layout layout = dea_layout_of(plot->scene);
    const double edge = edge_of(plot->scene, run) * (1.0 + 1e-12);
    const bool jumps = dea_study_of(plot->scene)->stations && offset != offsetof(dea_station, displacement) && offset != offsetof(dea_station, stretch[1]);
    dea_look look = {.dash = dash};
    dea_plot_gradient(run_count(plot) > 1 ? last_colour * (double)run / (double)(run_count(plot) - 1) : 0.25, look.colour);
    dea_figure_curve(figure, figure->count - 1, look, 1.8);
    for (size_t i = 0; i < layout.rows; i++) {
        const double x = dea_layout_place(plot->scene, i);
        if (i > 0 && dea_layout_place(plot->scene, i - 1) <= edge && x > edge && jumps) {
            dea_figure_point(figure, factor * x, (double)NAN, 0);
        }
        dea_figure_point(figure, factor * x, dea_layout_number(plot->kept + run * layout.point_size + i * layout.row_size, offset), 0);
    }
}

/* Unit of a column over all runs. */
static dea_scale scale_of(const dea_plot *plot, size_t offset, const char *unit)
{
    const dea_layout layout = dea_layout_of(plot->scene);
    double largest = 0.0;
    for (size_t i = 0; i < run_count(plot) * layout.rows; i++) {
        const double y = dea_layout_number(plot->kept + i / layout.rows * layout.point_size + i % layout.rows * layout.row_size, offset);
        largest = isfinite(y) ? fmax(largest, fabs(y)) : largest;
    }
    return dea_scale_choose(largest, unit);
}

/* A panel of one column, or of two: along the radius and along the hoop; @p factor: of what lies along x. */
static void add_panel(const dea_plot *plot, dea_figure *figure, const char *words, const char *unit, size_t offset, bool pair, double factor)
{
    const dea_scale scale = *unit ? scale_of(plot, offset, unit) : (dea_scale){.factor = 1.0};
    char label[DEA_LABEL_LENGTH];
    snprintf(label, sizeof label, "%s%s%s%s", words, *unit ? " [" : "", scale.unit, *unit ? "]" : "");
    dea_panel *panel = dea_figure_panel(figure, figure->count == 0 ? TALL : SMALL, label);
    panel->factor = scale.factor;
    panel->floats = pair;
    panel->zero = !pair;
    for (size_t run = 0; run < run_count(plot); run++) {
        add_curve(plot, figure, run, offset, RADIAL, factor);
        if (pair) {
            add_curve(plot, figure, run, offset + sizeof(double), HOOP, factor);
        }
    }
    dea_figure_prune(figure);
}

static void list_runs(const dea_plot *plot, dea_legend *legend)
{
    const size_t count = run_count(plot);
    for (size_t run = 0; count > 1 && run < count; run++) {
        dea_legend_entry *entry = dea_legend_add(legend);
        entry->dash = 1;
        dea_plot_gradient(last_colour * (double)run / (double)(count - 1), entry->colour);
        dea_label_run(plot->scene, run, SIZE_MAX, entry->label, sizeof entry->label);
    }
}

/* Runs, and where @p ways what dashes mean; its height. */
static int list(const dea_plot *plot, dea_legend *legend, bool ways)
{
    list_runs(plot, legend);
    const size_t runs = legend->count;
    for (size_t dash = RADIAL; ways && dash <= HOOP; dash++) {
        dea_legend_entry *entry = dea_legend_add(legend);
        entry->dash = dash;
        snprintf(entry->colour, sizeof entry->colour, "#505050");
        snprintf(entry->label, sizeof entry->label, dash == RADIAL ? "along the radius" : "along the hoop");
    }
    return dea_legend_lay(legend, (const size_t[]){0, runs, legend->count}, 2, plot->picture.canvas.width);
}

static dea_status figure_finish(dea_plot *plot, dea_figure *figure, bool ways, dea_error *error)
{
    figure->foot = list(plot, &figure->legend, ways);
    return dea_figure_end(figure, dea_figure_stack(figure, SIZE_MAX, error), error);
}

static dea_status profiles_draw(dea_plot *plot, dea_error *error)
{
    const dea_scale x = dea_scale_choose(plot->scene->actuator.frame_radius, "m");
    dea_figure figure = dea_figure_begin(&plot->picture, plot->scene->title, plot->picture.log_x);
    snprintf(figure.across[0].label, sizeof figure.across[0].label, "Radius at 0 V [%s]", x.unit);
    add_panel(plot, &figure, "Displacement", "m", offsetof(dea_station, displacement), false, x.factor);
    add_panel(plot, &figure, "Stretch", "", offsetof(dea_station, stretch), true, x.factor);
    add_panel(plot, &figure, "True stress", "Pa", offsetof(dea_station, stress), true, x.factor);
    add_panel(plot, &figure, "True field", "V/m", offsetof(dea_station, field), false, x.factor);
    return figure_finish(plot, &figure, true, error);
}

static dea_status forces_draw(dea_plot *plot, dea_error *error)
{
    const dea_force_study *force = &plot->scene->force;
    const dea_scale x = dea_scale_choose(fmax(fabs(force->from), fabs(force->to)), "m");
    dea_figure figure = dea_figure_begin(&plot->picture, plot->scene->title, plot->picture.log_x);
    snprintf(figure.across[0].label, sizeof figure.across[0].label, "Displacement of the edge [%s]", x.unit);
    add_panel(plot, &figure, "Force", "N", offsetof(dea_row, force), false, x.factor);
    return figure_finish(plot, &figure, false, error);
}

const dea_drawer dea_drawer_forces = {profiles_open, dea_plot_take, forces_draw};
const dea_drawer dea_drawer_profiles = {profiles_open, dea_plot_take, profiles_draw};
