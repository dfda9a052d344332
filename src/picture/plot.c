#include "picture/picture.h"
#include "study/study.h"

#include <math.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

enum { CURVE_POINTS = 2000, MAP_VALUES = 240, MAP_FROM = 13 };

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

/* The column of a sweep named by the first @p length bytes of @p name; NULL: none. */
static const dea_column *column_find(const dea_layout *layout, const char *name, size_t length)
{
    for (size_t i = 0; i < layout->column_count; i++) {
        if (strlen(layout->columns[i].name) == length && strncmp(layout->columns[i].name, name, length) == 0) {
            return &layout->columns[i];
        }
    }
    return NULL;
}

static dea_status column_refuse(const dea_layout *layout, const char *name, dea_error *error)
{
    char names[512] = "";
    for (size_t i = 0, used = 0; i < layout->column_count && used < sizeof names; i++) {
        used += (size_t)snprintf(names + used, sizeof names - used, "%s%s", i > 0 ? ", " : "", layout->columns[i].name);
    }
    return dea_fail(error, DEA_ERROR_USAGE, "there is no column \"%.*s\" to draw; the study has %s", (int)strcspn(name, ","), name,
                    names);
}

/* The columns that are wanted: of a map one, of curves two at most. */
static dea_status columns_choose(dea_plot *plot, dea_error *error)
{
    const dea_layout layout = dea_layout_of(plot->scene);
    const char *name = plot->columns ? plot->columns : plot->map ? "displacement_m" : "strain,displacement_m";
    const size_t most = plot->map ? 1 : DEA_DRAWN;
    for (bool more = true; more; name += strcspn(name, ",") + 1) {
        const dea_column *column = column_find(&layout, name, strcspn(name, ","));
        if (!column) {
            return column_refuse(&layout, name, error);
        }
        if (plot->drawn_count == most) {
            return dea_fail(error, DEA_ERROR_USAGE, "too many columns \"%s\"; accepted: %s", plot->columns,
                            plot->map ? "one, of a map" : "one or two");
        }
        plot->drawn[plot->drawn_count++] = *column;
        more = name[strcspn(name, ",")] == ',';
    }
    return DEA_OK;
}

static dea_status dots_open(dea_plot *plot, dea_error *error)
{
    dea_status status = plot_choose(plot, error);
    status = status ? status : columns_choose(plot, error);
    if (status != DEA_OK) {
        return status;
    }
    const size_t count = plot->curves * plot->across.kept;
    plot->dots = malloc(count * sizeof *plot->dots);
    if (!plot->dots) {
        return dea_fail(error, DEA_ERROR_MEMORY, "out of memory");
    }
    for (size_t i = 0; i < count; i++) {
        plot->dots[i] = (dea_dot){{NAN, NAN}, DEA_STATE_FAILED};
    }
    return DEA_OK;
}

static dea_status runs_open(dea_plot *plot, dea_error *error)
{
    return dea_runs_open(plot->scene, plot->loops, &plot->runs, error);
}

dea_status dea_plot_begin(const dea_scene *scene, const char *path, const dea_plot_options *options, dea_plot **plot,
                          dea_error *error)
{
    *plot = NULL;
    if (options && options->loops && !dea_study_of(scene)->timed) {
        return dea_fail(error, DEA_ERROR_USAGE, "loops are drawn of a transient, but the study is %s", dea_study_of(scene)->name);
    }
    if (options && options->columns && dea_study_of(scene)->drawer != &dea_drawer_points) {
        return dea_fail(error, DEA_ERROR_USAGE, "columns are chosen of a sweep, but the study is %s", dea_study_of(scene)->name);
    }
    dea_plot *begun = calloc(1, sizeof *begun);
    if (!begun) {
        return dea_fail(error, DEA_ERROR_MEMORY, "out of memory");
    }
    begun->scene = scene;
    begun->loops = options && options->loops;
    begun->columns = options ? options->columns : NULL;
    const dea_study *study = dea_study_of(scene);
    begun->drawer = study->spread_drawer && dea_layout_of(scene).spread_count > 0 ? study->spread_drawer : study->drawer;
    dea_status status = begun->drawer->open(begun, error);
    status = status ? status : dea_gnuplot_begin(&begun->picture, path, options, error);
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

static void dots_take(dea_plot *plot, size_t first, const void *points, size_t count)
{
    const dea_row *rows = points;
    for (size_t i = 0; i < count; i++) {
        dea_dot *dot = plot_dot(plot, first + i);
        if (dot) {
            dot->state = rows[i].state;
            for (size_t k = 0; k < plot->drawn_count; k++) {
                memcpy(&dot->values[k], (const char *)&rows[i] + plot->drawn[k].offset, sizeof *dot->values);
            }
        }
    }
}

static void runs_take(dea_plot *plot, size_t first, const void *points, size_t count)
{
    for (size_t i = 0; i < count; i++) {
        dea_runs_take(&plot->runs, first + i, (const char *)points + i * plot->runs.layout.point_size);
    }
}

static dea_status dots_draw(dea_plot *plot, dea_error *error)
{
    for (size_t i = 0; i < plot->curves * plot->across.kept; i++) {
        if (isfinite(plot->dots[i].values[0])) {
            return plot->map ? dea_plot_draw_map(plot, error) : dea_plot_draw_curves(plot, error);
        }
    }
    return dea_fail(error, DEA_ERROR_USAGE, "nothing to draw: no point of the study has an equilibrium");
}

dea_status dea_plot_keep(dea_plot *plot, dea_error *error)
{
    plot->kept = malloc(dea_scene_point_count(plot->scene) * plot->scene->model_count * dea_layout_of(plot->scene).point_size);
    return plot->kept ? DEA_OK : dea_fail(error, DEA_ERROR_MEMORY, "out of memory");
}

void dea_plot_take(dea_plot *plot, size_t first, const void *points, size_t count)
{
    const size_t size = dea_layout_of(plot->scene).point_size;
    memcpy(plot->kept + first * size, points, count * size);
}

const dea_drawer dea_drawer_points = {dots_open, dots_take, dots_draw};
const dea_drawer dea_drawer_runs = {runs_open, runs_take, dea_plot_draw_runs};

void dea_plot_points(dea_plot *plot, size_t first, const void *points, size_t count)
{
    plot->drawer->take(plot, first, points, count);
}

dea_status dea_plot_finish(dea_plot *plot, bool keep, dea_error *error)
{
    if (!plot) {
        return DEA_OK;
    }
    const dea_status status = keep ? plot->drawer->draw(plot, error) : DEA_OK;
    const dea_status finished = dea_gnuplot_finish(&plot->picture, keep && status == DEA_OK, error);
    dea_runs_close(&plot->runs);
    free(plot->kept);
    free(plot->dots);
    free(plot);
    return status != DEA_OK ? status : finished;
}
