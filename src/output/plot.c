#include "output/picture.h"

#include <math.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

enum { CURVE_POINTS = 2000, MAP_VALUES = 240, MAP_FROM = 13, COLOURS = 8 };

static dea_thinning thinning_choose(size_t count, size_t most)
{
    dea_thinning thinning = {.count = count, .stride = count > 1 ? (count - 2) / most + 1 : 1};
    thinning.kept = (count - 1) / thinning.stride + 1 + ((count - 1) % thinning.stride != 0);
    return thinning;
}

/* Number of a value among the kept ones, SIZE_MAX where it is not kept. */
static size_t thinning_place(const dea_thinning *thinning, size_t index)
{
    if (index % thinning->stride == 0) {
        return index / thinning->stride;
    }
    return index + 1 == thinning->count ? thinning->kept - 1 : SIZE_MAX;
}

size_t dea_thinning_index(const dea_thinning *thinning, size_t kept)
{
    return kept + 1 == thinning->kept ? thinning->count - 1 : kept * thinning->stride;
}

typedef struct ranked {
    double value;
    size_t place;
} ranked;

static int ranked_compare(const void *left, const void *right)
{
    const ranked *a = left, *b = right;
    if (a->value < b->value || a->value > b->value) {
        return a->value < b->value ? -1 : 1;
    }
    return a->place < b->place ? -1 : a->place > b->place;
}

size_t *dea_plot_order(const dea_axis *axis, const dea_thinning *thinning)
{
    ranked *sorted = malloc(thinning->kept * sizeof *sorted);
    size_t *order = malloc(thinning->kept * sizeof *order);
    if (!sorted || !order) {
        free(sorted);
        free(order);
        return NULL;
    }
    for (size_t i = 0; i < thinning->kept; i++) {
        sorted[i] = (ranked){axis->values[dea_thinning_index(thinning, i)], i};
    }
    qsort(sorted, thinning->kept, sizeof *sorted, ranked_compare);
    for (size_t i = 0; i < thinning->kept; i++) {
        order[i] = sorted[i].place;
    }
    free(sorted);
    return order;
}

void dea_plot_gradient(double share, char colour[8])
{
    static const unsigned char stops[][3] = {{68, 1, 84}, {59, 82, 139}, {33, 145, 140}, {94, 201, 98}, {253, 231, 37}};
    const double place = fmin(fmax(share, 0.0), 1.0) * 4.0;
    const int stop = place >= 4.0 ? 3 : (int)place;
    unsigned mixed[3];
    for (int i = 0; i < 3; i++) {
        mixed[i] = (unsigned)lround(stops[stop][i] + (place - stop) * (stops[stop + 1][i] - stops[stop][i])) & 0xffu;
    }
    snprintf(colour, 8, "#%02x%02x%02x", mixed[0], mixed[1], mixed[2]);
}

void dea_plot_colour(size_t number, size_t count, char colour[8])
{
    static const char *const hues[COLOURS] = {"#0072b2", "#d55e00", "#009e73", "#cc79a7",
                                              "#e69f00", "#56b4e9", "#6a3d9a", "#555555"};
    if (count <= COLOURS) {
        snprintf(colour, 8, "%s", hues[number % COLOURS]);
    } else {
        dea_plot_gradient(0.9 * (double)number / (double)(count - 1), colour);
    }
}

void dea_plot_dash(FILE *script, size_t number)
{
    static const char *const dashes[] = {"solid",  "(9, 4)",       "(2, 3)", "(9, 3, 2, 3)", "(16, 5)", "(9, 3, 2, 3, 2, 3)",
                                         "(4, 3)", "(16, 3, 4, 3)"};
    fprintf(script, "dashtype %s", dashes[(number - 1) % (sizeof dashes / sizeof *dashes)]);
}

void dea_plot_style(FILE *script)
{
    fputs("set format '%h'\n"
          "set border 15 linewidth 0.8 linecolor '#404040'\n"
          "set tics nomirror in scale 0.6 textcolor '#202020'\n"
          "set grid linetype 1 linewidth 0.5 linecolor '#e2e2e2'\n"
          "set xlabel textcolor '#202020'\nset ylabel textcolor '#202020'\n",
          script);
}

void dea_plot_place(FILE *script, int width, int height, dea_box box)
{
    const struct {
        const char *name;
        double share;
    } margins[] = {
        {"lmargin", box.left / width},
        {"rmargin", (box.left + box.width) / width},
        {"tmargin", 1.0 - box.top / height},
        {"bmargin", 1.0 - (box.top + box.height) / height},
    };
    for (size_t i = 0; i < sizeof margins / sizeof *margins; i++) {
        fprintf(script, "set %s at screen ", margins[i].name);
        dea_gnuplot_number(script, margins[i].share);
        fputc('\n', script);
    }
}

void dea_plot_title(FILE *script, const char *title, int height)
{
    fputs("set datafile missing 'NaN'\nset datafile separator whitespace\nunset key\nset multiplot\n", script);
    if (*title) {
        fputs("set label 2 ", script);
        dea_gnuplot_text(script, title);
        fputs(" at screen 0.5, screen ", script);
        dea_gnuplot_number(script, 1.0 - 17.0 / height);
        fputs(" center\n", script);
    }
}

/* Chooses what is drawn over what. */
static dea_status plot_choose(dea_plot *plot, dea_error *error)
{
    const dea_scene *scene = plot->scene;
    size_t longest = 0, second = SIZE_MAX, long_axes = 0;
    for (size_t i = 0; i < scene->axis_count; i++) {
        long_axes += scene->axes[i].count > 1;
        if (scene->axes[i].count > scene->axes[longest].count) {
            longest = i;
        }
    }
    if (long_axes == 0) {
        return dea_fail(error, DEA_ERROR_USAGE, "nothing to draw: the study is a single point; sweep something");
    }
    for (size_t i = 0; i < scene->axis_count; i++) {
        if (i != longest && (second == SIZE_MAX || scene->axes[i].count > scene->axes[second].count)) {
            second = i;
        }
    }
    plot->x = longest;
    plot->y = second;
    plot->map = scene->model_count == 1 && long_axes == 2 && scene->axes[second].count >= MAP_FROM;
    plot->across = thinning_choose(scene->axes[longest].count, plot->map ? MAP_VALUES : CURVE_POINTS);
    if (plot->map) {
        plot->up = thinning_choose(scene->axes[second].count, MAP_VALUES);
        plot->curves = plot->up.kept;
        return DEA_OK;
    }
    plot->curves = dea_scene_point_count(scene) / scene->axes[longest].count * scene->model_count;
    if (plot->curves > DEA_CURVES_MAX) {
        return dea_fail(
            error, DEA_ERROR_USAGE,
            "%zu curves over %s are too many for one picture (at most %d): give the other axes fewer values; two axes and "
            "one model make a map",
            plot->curves, scene->axes[longest].column, DEA_CURVES_MAX);
    }
    return DEA_OK;
}

static dea_status dots_open(dea_plot *plot, dea_error *error)
{
    const dea_status status = plot_choose(plot, error);
    if (status != DEA_OK) {
        return status;
    }
    const size_t count = plot->curves * plot->across.kept;
    plot->dots = malloc(count * sizeof *plot->dots);
    if (!plot->dots) {
        return dea_fail(error, DEA_ERROR_MEMORY, "out of memory");
    }
    for (size_t i = 0; i < count; i++) {
        plot->dots[i] = (dea_dot){NAN, NAN, DEA_STATE_FAILED};
    }
    return DEA_OK;
}

static bool is_sweep(const dea_plot *plot)
{
    return plot->scene->study == DEA_STUDY_SWEEP;
}

dea_status dea_plot_begin(const dea_scene *scene, const char *path, dea_plot **plot, dea_error *error)
{
    *plot = NULL;
    dea_plot *begun = calloc(1, sizeof *begun);
    if (!begun) {
        return dea_fail(error, DEA_ERROR_MEMORY, "out of memory");
    }
    begun->scene = scene;
    dea_status status = is_sweep(begun) ? dots_open(begun, error) : dea_runs_open(scene, &begun->runs, error);
    if (status == DEA_OK) {
        status = dea_gnuplot_begin(&begun->picture, path, error);
    }
    if (status != DEA_OK) {
        dea_plot_finish(begun, false, NULL);
        return status;
    }
    *plot = begun;
    return DEA_OK;
}

/* The dot that point number @p row of a sweep belongs to, NULL where it is thinned out. */
static dea_dot *plot_dot(dea_plot *plot, size_t row)
{
    const dea_scene *scene = plot->scene;
    size_t across = 0, up = 0, curve = 0, step = 1, rest = row;
    for (size_t i = scene->axis_count; i-- > 0;) {
        const size_t index = rest % scene->axes[i].count;
        rest /= scene->axes[i].count;
        if (i == plot->x) {
            across = index;
        } else if (plot->map && i == plot->y) {
            up = index;
        } else {
            curve += index * step;
            step *= scene->axes[i].count;
        }
    }
    curve = plot->map ? thinning_place(&plot->up, up) : curve + rest * step;
    const size_t place = thinning_place(&plot->across, across);
    return place != SIZE_MAX && curve < plot->curves ? &plot->dots[curve * plot->across.kept + place] : NULL;
}

static void dots_take(dea_plot *plot, size_t first, const dea_row *rows, size_t count)
{
    for (size_t i = 0; i < count; i++) {
        dea_dot *dot = plot_dot(plot, first + i);
        if (dot) {
            *dot = (dea_dot){rows[i].strain, rows[i].displacement, rows[i].state};
        }
    }
}

void dea_plot_points(dea_plot *plot, size_t first, const void *points, size_t count)
{
    if (is_sweep(plot)) {
        dots_take(plot, first, points, count);
        return;
    }
    for (size_t i = 0; i < count; i++) {
        dea_runs_take(&plot->runs, first + i, (const char *)points + i * plot->runs.layout.point_size);
    }
}

static dea_status plot_draw(dea_plot *plot, dea_error *error)
{
    if (!is_sweep(plot)) {
        return dea_plot_draw_runs(plot, error);
    }
    for (size_t i = 0; i < plot->curves * plot->across.kept; i++) {
        if (isfinite(plot->dots[i].displacement)) {
            return plot->map ? dea_plot_draw_map(plot, error) : dea_plot_draw_curves(plot, error);
        }
    }
    return dea_fail(error, DEA_ERROR_USAGE, "nothing to draw: no point of the study has an equilibrium");
}

dea_status dea_plot_finish(dea_plot *plot, bool keep, dea_error *error)
{
    if (!plot) {
        return DEA_OK;
    }
    const dea_status status = keep ? plot_draw(plot, error) : DEA_OK;
    const dea_status finished = dea_gnuplot_finish(&plot->picture, keep && status == DEA_OK, error);
    dea_runs_close(&plot->runs);
    free(plot->dots);
    free(plot);
    return status != DEA_OK ? status : finished;
}
