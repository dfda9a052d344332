/* A film in time along its radius: displacement, radial stretch and true field in colour over time and radius, one map above the other;
 * the electrode's edge is a line across them. */
#include "picture/picture.h"

#include <math.h>
#include <string.h>

#include "network/along.h"

enum {
    MAPS = 3,
    LEFT = 82,   /* of a map: its labels */
    RIGHT = 150, /* behind it: its colours */
    NATURAL = 170, /* height of a map, where no size is wanted */
    GAP = 18,    /* between two */
    LABELS = 64, /* below the last */
    LEAST = 50,  /* height of a map that can be read */
    COLUMNS = 400, /* most times and radii that are drawn */
    ROWS = 240
};

static const struct {
    const char *words, *unit;
    size_t number; /* of an entry */
    bool coated;   /* nothing without electrode */
} maps[MAPS] = {{"Displacement", "m", DEA_ALONG_DISPLACEMENT, false},
                {"Radial stretch", "", DEA_ALONG_RADIAL, false},
                {"True field", "V/m", DEA_ALONG_FIELD, true}};

/* The one run of a picture. */
typedef struct page {
    const dea_plot *plot;
    dea_layout layout;
    dea_scale time, radius;
    size_t first, across, up; /* sample that is drawn first, then every so many, and of radii */
} page;

static dea_status waves_open(dea_plot *plot, dea_error *error)
{
    const size_t runs = dea_scene_point_count(plot->scene) * plot->scene->model_count;
    if (runs > 1) {
        return dea_fail(error, DEA_ERROR_USAGE, "%zu runs are too many for a picture of profiles in time: give the axes one value each", runs);
    }
    return dea_plot_keep(plot, error);
}

static double edge_of(const dea_scene *scene)
{
    const dea_actuator *actuator = &scene->actuator;
    return isnan(actuator->coverage) ? actuator->divide_radius : actuator->coverage * actuator->frame_radius;
}

static double value_at(const page *p, size_t row, size_t radius, size_t map)
{
    const bool dot = p->plot->scene->actuator.kind == DEA_DOT;
    const double at = dea_layout_radius(p->plot->scene, &p->layout, radius), edge = edge_of(p->plot->scene) * (1.0 + 1e-12);
    const bool coated = dot == (at <= edge);
    return maps[map].coated && !coated ? (double)NAN : dea_layout_entry(&p->layout, p->plot->kept, row, radius)[maps[map].number];
}

/* Range of a map, as it is drawn: empty where it has no number. */
static dea_span span_of(const page *p, size_t map)
{
    dea_span span = {INFINITY, -INFINITY, false};
    for (size_t i = 0; i < p->layout.rows * p->layout.spread_points; i++) {
        dea_span_take(&span, value_at(p, i / p->layout.spread_points, i % p->layout.spread_points, map));
    }
    return span;
}

static dea_scale scale_of(const dea_span *span, size_t map)
{
    const char *unit = maps[map].unit;
    return *unit ? dea_scale_choose(fmax(fabs(span->low), fabs(span->high)), unit) : (dea_scale){.factor = 1.0};
}

/* Where a sample is drawn: gnuplot's images know no logarithmic axes. */
static double place_of(const page *p, size_t row)
{
    const double time = p->time.factor * dea_layout_place(p->plot->scene, row);
    return p->plot->scene->transient.logarithmic ? log10(time) : time;
}

static void write_grid(const page *p, FILE *script, size_t map, dea_scale scale)
{
    fprintf(script, "$map%zu << END\n", map);
    for (size_t k = 0; k < p->layout.spread_points; k += p->up) {
        for (size_t i = p->first; i < p->layout.rows; i += p->across) {
            dea_gnuplot_put(script, "%g %g %g\n", place_of(p, i), p->radius.factor * dea_layout_radius(p->plot->scene, &p->layout, k),
                            scale.factor * value_at(p, i, k, map));
        }
        fputc('\n', script);
    }
    fputs("END\n", script);
}

/* Colours of a map, and what they are. */
static void write_colours(FILE *script, size_t map, const dea_span *span, dea_scale scale, dea_box box)
{
    char label[DEA_LABEL_LENGTH];
    const double middle = 0.5 * scale.factor * (span->low + span->high);
    dea_span drawn = {scale.factor * span->low, scale.factor * span->high, false};
    if (!(drawn.high - drawn.low > 1e-9 * fabs(middle))) { /* the same everywhere */
        drawn = (dea_span){middle - 0.5 * fabs(middle) - 1e-9, middle + 0.5 * fabs(middle) + 1e-9, false};
    }
    dea_gnuplot_put(script, "set cbrange [%g:%g]\n", drawn.low, drawn.high);
    dea_span_steps(script, "cb", &drawn, box.height / 26.0);
    snprintf(label, sizeof label, "%s%s%s%s", maps[map].words, *scale.unit ? " [" : "", scale.unit, *scale.unit ? "]" : "");
    dea_gnuplot_put(script, "set cblabel offset 1.5,0 textcolor '#202020' %q\n", label);
}

static void write_map(const page *p, FILE *script, size_t map, dea_box box)
{
    const dea_scene *scene = p->plot->scene;
    const bool bottom = map + 1 == MAPS;
    const dea_span times = {place_of(p, p->first), place_of(p, p->layout.rows - 1), false};
    const dea_span radii = {0.0, p->radius.factor * scene->actuator.frame_radius, false};
    char label[DEA_LABEL_LENGTH];
    snprintf(label, sizeof label, "Radius [%s]", p->radius.unit);
    dea_gnuplot_put(script, "set ylabel %q\n", label);
    snprintf(label, sizeof label, "Time [%s]", p->time.unit);
    dea_gnuplot_put(script, "set xlabel %q\n", bottom ? label : "");
    dea_span_write(script, "x", &times, box.width, bottom ? dea_name_plain : dea_name_none);
    fprintf(script, "set format x '%s'\n", bottom ? "%h" : "");
    if (scene->transient.logarithmic) {
        const dea_span decades = {pow(10.0, times.low), pow(10.0, times.high), true};
        dea_span_tics(script, "x", &decades, box.width, bottom ? dea_name_plain : dea_name_none, true);
    }
    dea_span_write(script, "y", &radii, box.height, dea_name_plain);
    const double edge = p->radius.factor * edge_of(scene);
    dea_gnuplot_put(script,
                    "set arrow 1 from graph 0, first %g to graph 1, first %g nohead front dashtype (6, 4) linewidth 1 linecolor '#ffffff'\n"
                    "plot $map%z using 1:2:3 with image notitle\nunset label 2\n",
                    edge, edge, map);
}

static dea_status waves_draw(dea_plot *plot, dea_error *error)
{
    page p = {.plot = plot, .layout = dea_layout_of(plot->scene)};
    dea_span spans[MAPS];
    dea_scale scales[MAPS];
    const dea_canvas canvas = plot->picture.canvas;
    const double top = dea_plot_top(plot->scene->title);
    const double room = canvas.height > 0 ? (canvas.height - top - LABELS - (MAPS - 1) * GAP) / MAPS : NATURAL;
    dea_box box = {LEFT, top, canvas.width - LEFT - RIGHT, room};
    for (size_t i = 0; i < MAPS; i++) {
        spans[i] = span_of(&p, i);
        scales[i] = scale_of(&spans[i], i);
    }
    if (!(spans[0].high > spans[0].low)) {
        return dea_fail(error, DEA_ERROR_USAGE, "nothing to draw: the run has no samples, or nothing moves");
    }
    if (room < LEAST || box.width < LEAST) {
        return dea_plot_cramped(canvas, error);
    }
    const int height = canvas.height > 0 ? canvas.height : (int)lround(top + MAPS * room + (MAPS - 1) * GAP) + LABELS;
    FILE *script = plot->picture.script;
    p.time = dea_scale_choose(dea_layout_place(plot->scene, p.layout.rows - 1), "s");
    p.radius = dea_scale_choose(plot->scene->actuator.frame_radius, "m");
    p.first = plot->scene->transient.logarithmic ? 1 : 0; /* the one at 0 has no logarithm */
    p.across = (p.layout.rows - 1) / COLUMNS + 1;
    p.up = (p.layout.spread_points - 1) / ROWS + 1;
    dea_gnuplot_size(&plot->picture, height);
    for (size_t i = 0; i < MAPS; i++) {
        write_grid(&p, script, i, scales[i]);
    }
    dea_plot_style(script);
    dea_plot_title(script, plot->scene->title, canvas.width, height);
    dea_plot_palette(script, 1.0);
    fputs("unset grid\nset tics out scale 0.6\nset object 1 rectangle from graph 0,0 to graph 1,1 behind fillstyle solid 1.0 noborder fillcolor '#d4d4d4'\n", script);
    for (size_t i = 0; i < MAPS; i++, box.top += room + GAP) {
        dea_plot_place(script, canvas.width, height, box);
        write_colours(script, i, &spans[i], scales[i], box);
        write_map(&p, script, i, box);
    }
    return DEA_OK;
}

const dea_drawer dea_drawer_waves = {waves_open, dea_plot_take, waves_draw};
