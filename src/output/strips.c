#include "output/strips.h"

#include <math.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

enum { LEFT = 82, RIGHT = 24, GAP = 20, TALL = 250, SMALL = 150, LABELS = 58, LEAST = 40 };

dea_status dea_strips_open(dea_strips *s, size_t curves, size_t points, dea_error *error)
{
    *s = (dea_strips){.curve_room = curves, .curves = calloc(curves, sizeof *s->curves), .room = malloc(2 * curves * points * sizeof *s->room)};
    s->next = s->room;
    return s->curves && s->room ? DEA_OK : dea_fail(error, DEA_ERROR_MEMORY, "out of memory");
}

void dea_strips_close(dea_strips *s)
{
    free(s->curves);
    free(s->room);
}

dea_strip_curve *dea_strips_add(dea_strips *s, size_t strip, const char colour[8], size_t dash)
{
    dea_strip_curve *curve = &s->curves[s->curve_count++];
    *curve = (dea_strip_curve){.strip = strip, .dash = dash};
    memcpy(curve->colour, colour, sizeof curve->colour);
    return curve;
}

void dea_strip_point(dea_strips *s, dea_strip_curve *curve, double x, double y)
{
    curve->x = curve->x ? curve->x : s->next;
    curve->y = curve->x + 1; /* pairs */
    curve->x[2 * curve->count] = x;
    curve->y[2 * curve->count++] = y;
    s->next += 2;
}

/* Does a strip have anything to show? Its span. */
static bool measure(const dea_strips *s, size_t strip, dea_span *span)
{
    bool shows = false;
    *span = (dea_span){INFINITY, -INFINITY, s->strips[strip].logarithmic};
    for (size_t i = 0; i < s->curve_count; i++) {
        const dea_strip_curve *curve = &s->curves[i];
        for (size_t k = 0; curve->strip == strip && k < curve->count; k++) {
            dea_span_take(span, curve->y[2 * k]);
            shows = shows || (isfinite(curve->y[2 * k]) && curve->y[2 * k] != 0.0);
        }
    }
    if (!s->strips[strip].floats && !span->logarithmic) {
        dea_span_take(span, 0.0);
    }
    dea_span_limit(span);
    dea_span_pad(span, s->strips[strip].floats);
    return shows;
}

static void write_curves(const dea_strips *s, FILE *script)
{
    for (size_t i = 0; i < s->curve_count; i++) {
        fprintf(script, "$curve%zu << END\n", i);
        for (size_t k = 0; k < s->curves[i].count; k++) {
            const double x = s->curves[i].x[2 * k];
            if (isnan(s->curves[i].y[2 * k])) {
                fputc('\n', script); /* a blank line breaks a curve, a missing number does not */
            } else if (x > 0.0 || !s->logarithmic) {
                dea_gnuplot_put(script, "%g %g\n", x, s->curves[i].y[2 * k]);
            }
        }
        fputs("\nNaN NaN\nEND\n", script); /* never empty */
    }
}

static void write_strip(const dea_strips *s, FILE *script, size_t strip)
{
    const char *before = "plot ";
    for (size_t i = 0; i < s->curve_count; i++) {
        if (s->curves[i].strip == strip) {
            fprintf(script, "%s$curve%zu using 1:2 with lines %s linewidth 1.8 linecolor '%s' notitle", before, i,
                    dea_plot_dash(s->curves[i].dash), s->curves[i].colour);
            before = ", \\\n ";
        }
    }
    fputs("\nunset label 2\n", script);
}

static void write_frame(const dea_strips *s, FILE *script, const dea_span *along, const dea_span *span, const char *label, dea_box box,
                        bool bottom)
{
    dea_gnuplot_put(script, "set ylabel %q\n", label);
    dea_span_write(script, "y", span, box.height, dea_name_plain);
    dea_span_write(script, "x", along, box.width, bottom ? dea_name_plain : dea_name_none);
    dea_gnuplot_put(script, "%sset xlabel %q\n", bottom ? "" : "set format x ''\n", bottom ? s->label : "");
}

static dea_span span_along(const dea_strips *s)
{
    dea_span along = {INFINITY, -INFINITY, s->logarithmic};
    for (size_t i = 0; i < s->curve_count; i++) {
        for (size_t k = 0; k < s->curves[i].count; k++) {
            dea_span_take(&along, s->curves[i].x[2 * k]);
        }
    }
    return along;
}

dea_status dea_strips_draw(dea_strips *s, dea_plot *plot, dea_error *error)
{
    const dea_canvas canvas = plot->picture.canvas;
    const int below = dea_legend_lay(&s->legend, s->kinds, 2, canvas.width) + LABELS;
    const double top = dea_plot_top(plot->scene->title);
    size_t shown[DEA_STRIPS], count = 0;
    dea_span spans[DEA_STRIPS];
    for (size_t i = 0; i < s->count; i++) {
        shown[count] = i;
        count += measure(s, i, &spans[count]);
    }
    if (count == 0) {
        return dea_fail(error, DEA_ERROR_USAGE, "nothing to draw: no run has an equilibrium, or nothing moves");
    }
    const double natural = TALL + (double)(count - 1) * (SMALL + GAP);
    const double stretch = canvas.height > 0 ? (canvas.height - below - top) / natural : 1.0;
    if (stretch * SMALL < LEAST || canvas.width < 3 * (LEFT + RIGHT)) {
        return dea_plot_cramped(canvas, error);
    }
    const int height = canvas.height > 0 ? canvas.height : (int)lround(top + natural) + below;
    const dea_span along = span_along(s);
    FILE *script = plot->picture.script;
    dea_gnuplot_size(&plot->picture, height);
    write_curves(s, script);
    dea_plot_style(script);
    dea_plot_title(script, plot->scene->title, canvas.width, height);
    dea_box box = {LEFT, top, canvas.width - LEFT - RIGHT, stretch * TALL};
    for (size_t i = 0; i < count; i++) {
        dea_plot_place(script, canvas.width, height, box);
        write_frame(s, script, &along, &spans[i], s->strips[shown[i]].label, box, i + 1 == count);
        write_strip(s, script, shown[i]);
        box.top += box.height + stretch * GAP;
        box.height = stretch * SMALL;
    }
    dea_legend_draw(&s->legend, script, canvas.width, height);
    return DEA_OK;
}

void dea_strips_name(const dea_scene *scene, size_t along, size_t group, char *label, size_t size)
{
    size_t used = 0, step = dea_scene_point_count(scene) / (along == SIZE_MAX ? 1 : scene->axes[along].count);
    *label = '\0';
    if (scene->model_count > 1) {
        used = (size_t)snprintf(label, size, "%s", scene->models[group / step]->name);
    }
    for (size_t i = 0; i < scene->axis_count && used < size; i++) {
        const dea_axis *axis = &scene->axes[i];
        if (i != along && axis->count > 1) {
            char part[DEA_LABEL_LENGTH];
            const dea_scale scale = dea_scale_axis(axis);
            step /= axis->count;
            dea_label_value(axis, &scale, group / step % axis->count, part);
            used += (size_t)snprintf(label + used, size - used, "%s%s", used > 0 ? ", " : "", part);
        }
    }
}
