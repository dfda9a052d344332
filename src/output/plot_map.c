/* Displacement as colour over the two long axes, with level lines; where a limit is passed the map is hatched, where there is no
 * equilibrium it is grey. Values of any spacing are first brought onto an even grid, by the nearest neighbours. */
#include "output/label.h"
#include "output/picture.h"

#include <math.h>
#include <stdlib.h>

enum {
    WIDTH = 760,
    HEIGHT = 540,
    PLAIN_WIDTH = 540,
    PLAIN_HEIGHT = 405,
    COLUMNS = 240,
    ROWS = 180,
    HATCH_STEP = 14,
    HATCH_SAMPLES = 400,
    STOPS = 9,
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
    double from, to; /* [SI] */
} side;

typedef struct chart {
    const dea_plot *plot;
    side x, y;
    dea_scale colour;
    bool hatched[HATCHES], gaps;
} chart;

static bool side_begin(side *edge, const dea_axis *axis, const dea_thinning *thinning)
{
    *edge = (side){.axis = axis, .thinning = thinning, .scale = dea_scale_axis(axis), .order = dea_plot_order(axis, thinning)};
    if (edge->order) {
        edge->from = axis->values[dea_thinning_index(thinning, edge->order[0])];
        edge->to = axis->values[dea_thinning_index(thinning, edge->order[thinning->kept - 1])];
    }
    return edge->order != NULL;
}

static double side_value(const side *edge, size_t rank)
{
    return edge->axis->values[dea_thinning_index(edge->thinning, edge->order[rank])];
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

/* Displacement and state at any place: linear between four neighbours that have an equilibrium, else the nearest of them. */
static dea_dot chart_sample(const chart *map, double x, double y)
{
    double p, q;
    const size_t i = side_find(&map->x, x, &p), j = side_find(&map->y, y, &q);
    dea_dot sample = *chart_dot(map, i + (p > 0.5), j + (q > 0.5));
    const double mixed =
        (1.0 - q) * ((1.0 - p) * chart_dot(map, i, j)->displacement + p * chart_dot(map, i + 1, j)->displacement) +
        q * ((1.0 - p) * chart_dot(map, i, j + 1)->displacement + p * chart_dot(map, i + 1, j + 1)->displacement);
    if (isfinite(mixed)) {
        sample.displacement = mixed;
    }
    return sample;
}

/* Point number @p index of @p count along a side. */
static double side_at(const side *edge, int index, int count)
{
    return edge->from + (edge->to - edge->from) * index / (count - 1.0);
}

static void write_triple(FILE *script, double x, double y, double value)
{
    dea_gnuplot_number(script, x);
    fputc(' ', script);
    dea_gnuplot_number(script, y);
    fputc(' ', script);
    dea_gnuplot_number(script, value);
    fputc('\n', script);
}

static void write_grid(chart *map, FILE *script)
{
    fputs("$grid << END\n", script);
    for (int j = 0; j < ROWS; j++) {
        for (int i = 0; i < COLUMNS; i++) {
            const double x = side_at(&map->x, i, COLUMNS), y = side_at(&map->y, j, ROWS);
            const dea_dot dot = chart_sample(map, x, y);
            map->gaps = map->gaps || !isfinite(dot.displacement);
            write_triple(script, x * map->x.scale.factor, y * map->y.scale.factor, dot.displacement * map->colour.factor);
        }
        fputc('\n', script);
    }
    fputs("END\n", script);
}

/* One diagonal of the hatch: x - y = c for a rising one, in units of the canvas with the map at [0, PLAIN_WIDTH] x [0,
 * PLAIN_HEIGHT]; it is drawn where its limit is passed. */
static void write_diagonal(chart *map, FILE *script, int number, double c)
{
    const double from = fmax(0.0, c), to = fmin(PLAIN_WIDTH, c + PLAIN_HEIGHT);
    bool drawing = false;
    for (int i = 0; i <= HATCH_SAMPLES; i++) {
        const double along = from + (to - from) * i / HATCH_SAMPLES;
        const double up = fmin(fmax((along - c) / PLAIN_HEIGHT, 0.0), 1.0);
        const double x = map->x.from + (map->x.to - map->x.from) * along / PLAIN_WIDTH;
        const double y = map->y.from + (map->y.to - map->y.from) * (hatches[number].rising ? up : 1.0 - up);
        const bool past = chart_sample(map, x, y).state == hatches[number].state;
        if (past) {
            write_triple(script, x * map->x.scale.factor, y * map->y.scale.factor, 0.0);
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
    for (int c = HATCH_STEP - PLAIN_HEIGHT; c < PLAIN_WIDTH; c += HATCH_STEP) {
        write_diagonal(map, script, number, c);
    }
    fputs("END\n", script);
}

static void write_palette(FILE *script)
{
    fputs("set palette defined (", script);
    for (int i = 0; i < STOPS; i++) {
        char colour[8];
        dea_plot_gradient(i / (STOPS - 1.0), colour);
        fprintf(script, "%s%d '%s'", i > 0 ? ", " : "", i, colour);
    }
    fputs(")\n", script);
}

static void write_side(FILE *script, const side *edge, char letter)
{
    char label[DEA_LABEL_LENGTH];
    dea_label_axis(edge->axis, &edge->scale, label);
    fprintf(script, "set %clabel ", letter);
    dea_gnuplot_text(script, label);
    fprintf(script, "\nset %crange [", letter);
    dea_gnuplot_number(script, edge->from * edge->scale.factor);
    fputc(':', script);
    dea_gnuplot_number(script, edge->to * edge->scale.factor);
    fputs("]\n", script);
}

/* What hatches and grey mean, below the map. */
static void write_legend(const chart *map, FILE *script)
{
    char label[DEA_LABEL_LENGTH];
    snprintf(label, sizeof label, "%s%s%s%s%s", map->hatched[0] ? hatches[0].legend : "", map->hatched[0] ? "      " : "",
             map->hatched[1] ? hatches[1].legend : "", map->hatched[1] ? "      " : "",
             map->gaps ? "grey: no equilibrium (pull-in)" : "");
    if (*label) {
        fputs("set label 2 ", script);
        dea_gnuplot_text(script, label);
        fputs(" at graph 0.5, screen 0.03 center textcolor '#202020'\n", script);
    }
}

static void write_chart(chart *map, FILE *script)
{
    char label[DEA_LABEL_LENGTH];
    write_grid(map, script);
    for (int i = 0; i < HATCHES; i++) {
        write_hatch(map, script, i);
    }
    dea_plot_style(script);
    fputs("unset grid\nset tics out scale 0.6\nunset key\nset bmargin at screen 0.17\nset rmargin at screen 0.82\n"
          "set tmargin at screen 0.92\nset lmargin at screen 0.11\n",
          script);
    write_palette(script);
    write_side(script, &map->x, 'x');
    write_side(script, &map->y, 'y');
    snprintf(label, sizeof label, "Displacement u [%s]", map->colour.unit);
    fputs("set cblabel offset 1,0 textcolor '#202020' ", script);
    dea_gnuplot_text(script, label);
    fputs("\nset title ", script);
    dea_gnuplot_text(script, map->plot->scene->title);
    fputs("\nset object 1 rectangle from graph 0,0 to graph 1,1 behind fillstyle solid 1.0 noborder fillcolor '#d4d4d4'\n"
          "set contour base\nset cntrparam levels auto 8\nunset surface\n"
          "set table $levels\nsplot $grid using 1:2:3 with lines nosurface\nunset table\nunset contour\nset surface\n",
          script);
    write_legend(map, script);
    fputs("plot $grid using 1:2:3 with image notitle, $levels using 1:2 with lines linewidth 0.7 linecolor '#ffffff' notitle",
          script);
    for (int i = 0; i < HATCHES; i++) {
        if (map->hatched[i]) {
            fprintf(script, ", $hatch%d using 1:2 with lines linewidth 0.6 linecolor '#ffffff' notitle", i);
        }
    }
    fputs("\nunset output\n", script);
}

dea_status dea_plot_draw_map(dea_plot *plot, dea_error *error)
{
    chart map = {.plot = plot};
    const bool begun = side_begin(&map.x, &plot->scene->axes[plot->x], &plot->across);
    dea_status status = DEA_OK;
    if (begun && side_begin(&map.y, &plot->scene->axes[plot->y], &plot->up)) {
        double largest = 0.0;
        for (size_t i = 0; i < plot->curves * plot->across.kept; i++) {
            largest = isfinite(plot->dots[i].displacement) ? fmax(largest, fabs(plot->dots[i].displacement)) : largest;
        }
        map.colour = dea_scale_choose(largest, "m");
        dea_gnuplot_size(&plot->picture, WIDTH, HEIGHT);
        write_chart(&map, plot->picture.script);
    } else {
        status = dea_fail(error, DEA_ERROR_MEMORY, "out of memory");
    }
    free(map.x.order);
    free(map.y.order);
    return status;
}
