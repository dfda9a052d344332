/* A column, the displacement if no other is wanted, as colour over the two long axes, with level lines; where a limit is passed the map is hatched, where there is no
 * equilibrium it is grey. Values of any spacing are first brought onto an even grid, by the nearest neighbours. */
#include "picture/label.h"
#include "picture/picture.h"

#include <math.h>
#include <stdlib.h>

enum {
    WIDTH = 760,       /* of the picture, where no size is wanted */
    LEFT = 82,         /* of the map */
    RIGHT = 128,       /* behind it: the colour scale */
    PLAIN_HEIGHT = 405,
    LABELS = 58,       /* below it */
    LEGEND = 24,
    LEAST = 60,
    COLUMNS = 240,
    ROWS = 180,
    HATCH_STEP = 14,
    HATCH_SAMPLES = 400,
    HATCHES = 2
};

/* Hatches: rising for slack, falling for breakdown. */
static const struct {
    dea_state state;
    bool rising;
    const char *legend;
} hatches[HATCHES] = {{DEA_STATE_SLACK, true, "/// slack"}, {DEA_STATE_BREAKDOWN, false, "\\\\\\ breakdown"}};

/* One axis of the map, sorted by value. */
typedef struct side {
    const dea_axis *axis;
    const dea_thinning *thinning;
    size_t *order;
    dea_scale scale;
    double from, to;  /* [SI] */
    bool logarithmic; /* what is at or below zero is left out */
} side;

typedef struct chart {
    const dea_plot *plot;
    side x, y;
    dea_scale colour;
    bool hatched[HATCHES], gaps;
    dea_canvas canvas;
    int height;
    dea_box box;
} chart;

static double side_value(const side *edge, size_t rank)
{
    return edge->axis->values[dea_thinning_index(edge->thinning, edge->order[rank])];
}

static bool side_begin(side *edge, const dea_axis *axis, const dea_thinning *thinning, bool logarithmic)
{
    *edge = (side){.axis = axis,
                   .thinning = thinning,
                   .scale = dea_scale_axis(axis),
                   .order = dea_plot_order(axis, thinning),
                   .logarithmic = logarithmic || dea_axis_logarithmic(axis)};
    if (edge->order) {
        size_t rank = 0;
        while (edge->logarithmic && rank + 1 < thinning->kept && !(side_value(edge, rank) > 0.0)) {
            rank++;
        }
        edge->from = side_value(edge, rank);
        edge->to = side_value(edge, thinning->kept - 1);
    }
    return edge->order != NULL;
}

/* Interval of the sorted values that holds @p value, and the share of it that lies below. */
static size_t side_find(const side *edge, double value, double *share)
{
    size_t low = 0, high = edge->thinning->kept - 1;
    while (high - low > 1) {
        const size_t middle = low + (high - low) / 2;
        *(side_value(edge, middle) <= value ? &low : &high) = middle;
    }
    const double from = side_value(edge, low), width = side_value(edge, high) - from;
    *share = width > 0.0 ? fmin(fmax((value - from) / width, 0.0), 1.0) : 0.0;
    return low;
}

static const dea_dot *chart_dot(const chart *map, size_t x, size_t y)
{
    return &map->plot->dots[map->y.order[y] * map->plot->across.kept + map->x.order[x]];
}

/* Value and state at any place: linear between four neighbours that have an equilibrium, else the nearest of them. */
static dea_dot chart_sample(const chart *map, double x, double y)
{
    double p, q;
    const size_t i = side_find(&map->x, x, &p), j = side_find(&map->y, y, &q);
    dea_dot sample = *chart_dot(map, i + (p > 0.5), j + (q > 0.5));
    const double mixed =
        (1.0 - q) * ((1.0 - p) * chart_dot(map, i, j)->values[0] + p * chart_dot(map, i + 1, j)->values[0]) +
        q * ((1.0 - p) * chart_dot(map, i, j + 1)->values[0] + p * chart_dot(map, i + 1, j + 1)->values[0]);
    if (isfinite(mixed)) {
        sample.values[0] = mixed;
    }
    return sample;
}

/* The value at a share of the way along a side. */
static double side_at(const side *edge, double share)
{
    return edge->logarithmic ? edge->from * pow(edge->to / edge->from, share) : edge->from + (edge->to - edge->from) * share;
}

/* Where a value is drawn: gnuplot's images know no logarithmic axes. */
static double side_place(const side *edge, double value)
{
    return edge->logarithmic ? log10(value * edge->scale.factor) : value * edge->scale.factor;
}

static void write_grid(chart *map, FILE *script)
{
    fputs("$grid << END\n", script);
    for (int j = 0; j < ROWS; j++) {
        for (int i = 0; i < COLUMNS; i++) {
            const double x = side_at(&map->x, i / (COLUMNS - 1.0)), y = side_at(&map->y, j / (ROWS - 1.0));
            const dea_dot dot = chart_sample(map, x, y);
            map->gaps = map->gaps || !isfinite(dot.values[0]);
            dea_gnuplot_put(script, "%g %g %g\n", side_place(&map->x, x), side_place(&map->y, y), dot.values[0] * map->colour.factor);
        }
        fputc('\n', script);
    }
    fputs("END\n", script);
}

/* One diagonal of the hatch: x - y = c for a rising one, in units of the canvas from the lower left corner of the map; it is drawn
 * where its limit is passed. */
static void write_diagonal(chart *map, FILE *script, int number, double c)
{
    const double from = fmax(0.0, c), to = fmin(map->box.width, c + map->box.height);
    bool drawing = false;
    for (int i = 0; i <= HATCH_SAMPLES; i++) {
        const double along = from + (to - from) * i / HATCH_SAMPLES;
        const double up = fmin(fmax((along - c) / map->box.height, 0.0), 1.0);
        const double x = side_at(&map->x, along / map->box.width), y = side_at(&map->y, hatches[number].rising ? up : 1.0 - up);
        const bool past = chart_sample(map, x, y).state == hatches[number].state;
        if (past) {
            dea_gnuplot_put(script, "%g %g %g\n", side_place(&map->x, x), side_place(&map->y, y), 0.0);
        } else if (drawing) {
            fputc('\n', script);
        }
        drawing = past;
        map->hatched[number] = map->hatched[number] || past;
    }
    fputs("\n", script);
}

static void write_hatch(chart *map, FILE *script, int number)
{
    fprintf(script, "$hatch%d << END\n", number);
    for (double c = HATCH_STEP - map->box.height; c < map->box.width; c += HATCH_STEP) {
        write_diagonal(map, script, number, c);
    }
    fputs("END\n", script);
}

static void write_side(FILE *script, const side *edge, const char *letter, double length)
{
    char label[DEA_LABEL_LENGTH];
    const dea_span span = {edge->from * edge->scale.factor, edge->to * edge->scale.factor, true};
    dea_label_axis(edge->axis, &edge->scale, label);
    dea_gnuplot_put(script, "set %slabel %q\nset %srange [%g:%g]\n", letter, label, letter, side_place(edge, edge->from),
                    side_place(edge, edge->to));
    if (!edge->logarithmic) {
        dea_span_steps(script, letter, &span, length / (*letter == 'x' ? 50.0 : 36.0));
    } else {
        dea_span_tics(script, letter, &span, length, dea_name_plain, true);
    }
}

/* What hatches and grey mean, below the map. */
static void write_legend(const chart *map, FILE *script)
{
    char label[DEA_LABEL_LENGTH];
    snprintf(label, sizeof label, "%s%s%s%s%s", map->hatched[0] ? hatches[0].legend : "", map->hatched[0] ? "      " : "",
             map->hatched[1] ? hatches[1].legend : "", map->hatched[1] ? "      " : "",
             map->gaps ? "grey: no equilibrium (pull-in)" : "");
    if (*label) {
        dea_gnuplot_put(script, "set label 3 %q at graph 0.5, screen %g center textcolor '#202020'\n", label,
                        LEGEND / 2.0 / map->height);
    }
}

/* Lines of equal values as a table: gnuplot draws no contours over an image. */
static void write_levels(FILE *script)
{
    fputs("set contour base\nset cntrparam levels auto 8\nunset surface\n"
          "set table $levels\nsplot $grid using 1:2:3 with lines nosurface\nunset table\nunset contour\nset surface\n",
          script);
}

/* Condition that a share of a side is away from its ends. */
static void write_within(FILE *script, const side *edge, const char *letter)
{
    const double from = side_place(edge, edge->from), width = side_place(edge, edge->to) - from;
    dea_gnuplot_put(script, "abs(%s - (%g)) < %g", letter, from + 0.5 * width, 0.47 * fabs(width));
}

/* Levels are black on white with their value, hatches white with black dots: seen on light and dark, in colour and in grey. */
static void write_layers(const chart *map, FILE *script)
{
    fputs("inside(x, y) = ", script);
    write_within(script, &map->x, "x");
    fputs(" && ", script);
    write_within(script, &map->y, "y");
    fputs("\nplot $grid using 1:2:3 with image notitle", script);
    for (int i = 0; i < HATCHES; i++) {
        if (map->hatched[i]) {
            fprintf(script,
                    ", \\\n $hatch%d using 1:2 with lines linewidth 1.4 linecolor '#ffffff' notitle"
                    ", \\\n $hatch%d using 1:2 with lines linewidth 1 dashtype (0.5, 4) linecolor '#000000' notitle",
                    i, i);
        }
    }
    fputs(", \\\n $levels using 1:2 with lines linewidth 2.6 linecolor '#ffffff' notitle"
          ", \\\n $levels using 1:2 with lines linewidth 1.1 linecolor '#000000' notitle"
          ", \\\n $levels using (int(column(0)) % 100 == 50 && inside($1, $2) ? $1 : NaN):2:(sprintf('%g', $3)) "
          "with labels boxed font ',9' textcolor '#000000' notitle\n",
          script);
}

static void write_chart(chart *map, FILE *script)
{
    char label[DEA_LABEL_LENGTH];
    write_grid(map, script);
    for (int i = 0; i < HATCHES; i++) {
        write_hatch(map, script, i);
    }
    write_levels(script);
    dea_plot_style(script);
    dea_plot_title(script, map->plot->scene->title, map->canvas.width, map->height);
    dea_plot_place(script, map->canvas.width, map->height, map->box);
    fputs("unset grid\nset tics out scale 0.6\nset style textbox opaque margins 0.4, 0.4 fillcolor '#ffffff' noborder\n", script);
    dea_plot_palette(script, 1.0);
    write_side(script, &map->x, "x", map->box.width);
    write_side(script, &map->y, "y", map->box.height);
    dea_label_column(&map->plot->drawn[0], &map->colour, label);
    dea_gnuplot_put(script,
                    "set cblabel offset 1,0 textcolor '#202020' %q\n"
                    "set object 1 rectangle from graph 0,0 to graph 1,1 behind fillstyle solid 1.0 noborder fillcolor '#d4d4d4'\n",
                    label);
    write_legend(map, script);
    write_layers(map, script);
}

/* Puts the map on its canvas. */
static dea_status place_chart(chart *map, dea_canvas *canvas, dea_error *error)
{
    const double top = dea_plot_top(map->plot->scene->title);
    canvas->width = canvas->height > 0 ? canvas->width : WIDTH;
    map->canvas = *canvas;
    map->height = canvas->height > 0 ? canvas->height : (int)top + PLAIN_HEIGHT + LABELS + LEGEND;
    map->box = (dea_box){LEFT, top, canvas->width - LEFT - RIGHT, map->height - top - LABELS - LEGEND};
    return map->box.width < LEAST || map->box.height < LEAST ? dea_plot_cramped(*canvas, error) : DEA_OK;
}

static bool has_room(const side *edge)
{
    return edge->to > edge->from && (edge->from > 0.0 || !edge->logarithmic);
}

static dea_status draw_chart(chart *map, dea_gnuplot *picture, dea_error *error)
{
    const dea_plot *plot = map->plot;
    double largest = 0.0;
    if ((map->x.logarithmic && !has_room(&map->x)) || (map->y.logarithmic && !has_room(&map->y))) {
        return dea_fail(error, DEA_ERROR_USAGE, "nothing to draw: nothing is above zero along a logarithmic axis");
    }
    for (size_t i = 0; i < plot->curves * plot->across.kept; i++) {
        largest = isfinite(plot->dots[i].values[0]) ? fmax(largest, fabs(plot->dots[i].values[0])) : largest;
    }
    map->colour = dea_scale_column(&plot->drawn[0], largest);
    const dea_status status = place_chart(map, &picture->canvas, error);
    if (status == DEA_OK) {
        dea_gnuplot_size(picture, map->height);
        write_chart(map, picture->script);
    }
    return status;
}

dea_status dea_plot_draw_map(dea_plot *plot, dea_error *error)
{
    chart map = {.plot = plot};
    const bool begun = side_begin(&map.x, &plot->scene->axes[plot->x], &plot->across, plot->picture.log_x);
    dea_status status = DEA_OK;
    if (begun && side_begin(&map.y, &plot->scene->axes[plot->y], &plot->up, plot->picture.log_y)) {
        status = draw_chart(&map, &plot->picture, error);
    } else {
        status = dea_fail(error, DEA_ERROR_MEMORY, "out of memory");
    }
    free(map.x.order);
    free(map.y.order);
    return status;
}
