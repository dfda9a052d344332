/* Forces over the displacement, a colour for each run; and profiles over the radius: displacement, stretches, true stresses and field; a colour for each run, along the radius solid, along the
 * hoop dashed. */
#include "scene/line.h"
#include "output/strips.h"
#include "study/study.h"

#include <math.h>
#include <stdint.h>
#include <string.h>

enum { QUANTITIES = 6, RADIAL = 1, HOOP = 2 };

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

/* A curve of one run, broken at the edge where it jumps there. */
static void add_curve(const dea_plot *plot, dea_strips *strips, size_t strip, size_t run, size_t offset, size_t dash, const dea_scale scales[2])
{
    const dea_layout layout = dea_layout_of(plot->scene);
    const double edge = edge_of(plot->scene, run) * (1.0 + 1e-12);
    const bool jumps = dea_study_of(plot->scene)->stations && offset != offsetof(dea_station, displacement) && offset != offsetof(dea_station, stretch[1]);
    char colour[8];
    dea_plot_gradient(run_count(plot) > 1 ? last_colour * (double)run / (double)(run_count(plot) - 1) : 0.25, colour);
    dea_strip_curve *curve = dea_strips_add(strips, strip, colour, dash);
    for (size_t i = 0; i < layout.rows; i++) {
        double y;
        const double x = dea_layout_place(plot->scene, i);
        memcpy(&y, plot->kept + run * layout.point_size + i * layout.row_size + offset, sizeof y);
        if (i > 0 && dea_layout_place(plot->scene, i - 1) <= edge && x > edge && jumps) {
            dea_strip_point(strips, curve, scales[0].factor * x, (double)NAN);
        }
        dea_strip_point(strips, curve, scales[0].factor * x, scales[1].factor * y);
    }
}

/* Unit of a column over all runs. */
static dea_scale scale_of(const dea_plot *plot, size_t offset, const char *unit)
{
    const dea_layout layout = dea_layout_of(plot->scene);
    double largest = 0.0;
    for (size_t i = 0; i < run_count(plot) * layout.rows; i++) {
        double y;
        memcpy(&y, plot->kept + i / layout.rows * layout.point_size + i % layout.rows * layout.row_size + offset, sizeof y);
        largest = isfinite(y) ? fmax(largest, fabs(y)) : largest;
    }
    return dea_scale_choose(largest, unit);
}

/* A strip of one column, or of two: along the radius and along the hoop. */
static void add_strip(const dea_plot *plot, dea_strips *strips, const char *words, const char *unit, size_t offset, bool pair, dea_scale x)
{
    const size_t strip = strips->count++;
    const dea_scale scales[2] = {x, *unit ? scale_of(plot, offset, unit) : (dea_scale){.factor = 1.0}};
    snprintf(strips->strips[strip].label, DEA_LABEL_LENGTH, "%s%s%s%s", words, *unit ? " [" : "", scales[1].unit, *unit ? "]" : "");
    strips->strips[strip].floats = pair;
    for (size_t run = 0; run < run_count(plot); run++) {
        add_curve(plot, strips, strip, run, offset, RADIAL, scales);
        if (pair) {
            add_curve(plot, strips, strip, run, offset + sizeof(double), HOOP, scales);
        }
    }
}

static void list_runs(const dea_plot *plot, dea_legend *legend)
{
    const size_t count = run_count(plot);
    for (size_t run = 0; count > 1 && run < count; run++) {
        dea_legend_entry *entry = dea_legend_add(legend);
        entry->dash = 1;
        dea_plot_gradient(last_colour * (double)run / (double)(count - 1), entry->colour);
        dea_strips_name(plot->scene, SIZE_MAX, run, entry->label, sizeof entry->label);
    }
}

static void list(const dea_plot *plot, dea_legend *legend, size_t kinds[3])
{
    list_runs(plot, legend);
    kinds[1] = legend->count;
    for (size_t dash = RADIAL; dash <= HOOP; dash++) {
        dea_legend_entry *entry = dea_legend_add(legend);
        entry->dash = dash;
        snprintf(entry->colour, sizeof entry->colour, "#505050");
        snprintf(entry->label, sizeof entry->label, dash == RADIAL ? "along the radius" : "along the hoop");
    }
    kinds[2] = legend->count;
}

static dea_status profiles_draw(dea_plot *plot, dea_error *error)
{
    const dea_scale x = dea_scale_choose(plot->scene->actuator.frame_radius, "m");
    dea_strips strips;
    dea_status status = dea_strips_open(&strips, QUANTITIES * run_count(plot), dea_layout_of(plot->scene).rows + 1, error);
    if (status == DEA_OK) {
        snprintf(strips.label, sizeof strips.label, "Radius at 0 V [%s]", x.unit);
        strips.logarithmic = plot->picture.log_x;
        add_strip(plot, &strips, "Displacement", "m", offsetof(dea_station, displacement), false, x);
        add_strip(plot, &strips, "Stretch", "", offsetof(dea_station, stretch), true, x);
        add_strip(plot, &strips, "True stress", "Pa", offsetof(dea_station, stress), true, x);
        add_strip(plot, &strips, "True field", "V/m", offsetof(dea_station, field), false, x);
        list(plot, &strips.legend, strips.kinds);
        status = dea_strips_draw(&strips, plot, error);
    }
    dea_strips_close(&strips);
    return status;
}

static dea_status forces_draw(dea_plot *plot, dea_error *error)
{
    const dea_force_study *force = &plot->scene->force;
    const dea_scale x = dea_scale_choose(fmax(fabs(force->from), fabs(force->to)), "m");
    dea_strips strips;
    dea_status status = dea_strips_open(&strips, run_count(plot), force->points, error);
    if (status == DEA_OK) {
        snprintf(strips.label, sizeof strips.label, "Displacement of the edge [%s]", x.unit);
        strips.logarithmic = plot->picture.log_x;
        add_strip(plot, &strips, "Force", "N", offsetof(dea_row, force), false, x);
        list_runs(plot, &strips.legend);
        strips.kinds[1] = strips.kinds[2] = strips.legend.count;
        status = dea_strips_draw(&strips, plot, error);
    }
    dea_strips_close(&strips);
    return status;
}

const dea_drawer dea_drawer_forces = {profiles_open, dea_plot_take, forces_draw};
const dea_drawer dea_drawer_profiles = {profiles_open, dea_plot_take, profiles_draw};
