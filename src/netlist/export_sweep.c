/* Static sweeps in displacement form: v(edge) = displacement, current = force. One subcircuit a line of points; all lines are
 * solved side by side in one DC sweep over the index of the points on their axis. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "scene/line.h"
#include "netlist/export.h"
#include "netlist/netlist.h"
#include "netlist/rings_line.h"
#include "network/balance.h"
#include "support/memory_text.h"

/* Most lines of one netlist, most values of an axis that is not uniform, and most steps from one point to the next. */
enum { MOST_LINES = 2000, MOST_LIST = 400, MOST_PARTS = 64, NAMES_A_LINE = 6 };

/* Largest change of a displacement from one step to the next, relative to the size of the film: Newton then stays on the branch
 * of equilibria that is connected to rest. */
static const double longest_step = 0.01;

typedef struct writer {
    dea_export *export;
    FILE *out;
    const dea_dialect *dialect;
    size_t lines;    /* written so far */
    size_t points;   /* of a line */
    size_t left_out; /* points without equilibrium */
    FILE *names;     /* of the nodes that hold answers */
    size_t written;  /* of these */
    size_t parts;    /* steps from one point to the next, a power of 2 so that no rounding adds up */
    double length;   /* smallest size of a displacement [m] */
    double force;    /* smallest size of a force [N] */
} writer;

/* One line with its network. */
typedef struct line_text {
    writer *w;
    const dea_scene *scene; /* axes at the first point */
    const dea_axis *axis;   /* NULL: one point */
    bool membrane;          /* a network of rings, else one node: */
    dea_network network;    /* owned */
    dea_balance balance;    /* owned */
    dea_still_cards cards;  /* owned */
    size_t from, to; /* points with an equilibrium, `to` excluded */
} line_text;

static double symbol_at(const line_text *l, size_t i)
{
    return l->axis ? l->axis->values[i] : 0.0;
}

/* Static displacement at a point of the line, from the model's own equation: where Newton starts. NAN where there is none. */
static double solve_at(const line_text *l, size_t i)
{
    dea_scene here = *l->scene;
    dea_point point;
    dea_row row = dea_row_failed();
    if (l->axis) {
        dea_axis_set(l->axis, &here, symbol_at(l, i));
    }
    dea_film_prepare(&here, &point.film);
    dea_point_place(&here, &point);
    if (dea_point_valid(&point)) {
        dea_model_solve(here.models[0], &point, 1e-9, &row);
    }
    return row.displacement;
}

static double displacement_at(const line_text *l, size_t i)
{
    const double u = solve_at(l, i);
    return isfinite(u) ? u : 0.0;
}

static bool has_equilibrium(line_text *l, size_t i)
{
    double share, fold;
    if (l->membrane) {
        return isfinite(solve_at(l, i));
    }
    const double symbol = symbol_at(l, i);
    return dea_balance_valid(&l->balance, symbol) && !dea_balance_folds(&l->balance, symbol, &share, &fold);
}

/* The longest stretch of points that have an equilibrium. */
static void find_stretch(line_text *l)
{
    size_t begin = 0;
    l->from = l->to = 0;
    for (size_t i = 0; i <= l->w->points; i++) {
        if (i < l->w->points && has_equilibrium(l, i)) {
            continue;
        }
        if (i - begin > l->to - l->from) {
            l->from = begin;
            l->to = i;
        }
        begin = i + 1;
    }
    l->w->left_out += l->w->points - (l->to - l->from);
}

static void write_guess(const line_text *l, const char *node, double value)
{
    FILE *out = l->w->out;
    dea_part_print(out, " v(xline%zu%s%s)=%g", l->w->lines, l->w->dialect->inside, node, value);
}

/* Newton's start of the first point. */
static void write_start(line_text *l)
{
    char inside[32];
    const double u = displacement_at(l, l->from);
    dea_part_print(l->w->out, ".nodeset v(edge%zu)=%g", l->w->lines, u);
    if (l->axis) {
        if (dea_axis_holds(l->axis, l->from, l->to)) {
            write_guess(l, "point", (double)l->from);
        }
        write_guess(l, "axis", symbol_at(l, l->from));
    }
    snprintf(inside, sizeof inside, "xline%zu%s", l->w->lines, l->w->dialect->inside);
    dea_still_cards_write_start(&l->cards, inside, symbol_at(l, l->from), u);
    fputc('\n', l->w->out);
}

/* Where the line lies on the other axes, and what it leaves out. */
static void write_place(const line_text *l)
{
    FILE *out = l->w->out;
    const dea_scene *scene = l->scene;
    fprintf(out, "* line %zu: displacement v(edge%zu) [m]", l->w->lines, l->w->lines);
    for (size_t i = 0; i < scene->axis_count; i++) {
        const dea_axis *axis = &scene->axes[i];
        if (axis != l->axis) {
            double value;
            memcpy(&value, (const char *)scene + axis->offset, sizeof value);
            fprintf(out, ", %s = %.9g %s", axis->key, value, axis->unit);
        }
    }
    fputc('\n', out);
    if (l->to - l->from < l->w->points) {
        fprintf(out, "* points %zu to %zu alone: the others have no equilibrium connected to rest, or a gap lies between\n",
                l->from, l->to - 1);
    }
}

static dea_status write_membrane(line_text *l, dea_error *error)
{
    dea_rings_line line = {.scene = l->scene, .axis = l->axis, .from = l->from, .to = l->to, .number = l->w->lines};
    dea_rings_line_choose(&line);
    write_place(l);
    return dea_rings_line_write(&line, l->w->dialect, l->w->out, error);
}

static dea_status write_line(line_text *l, dea_error *error)
{
    FILE *out = l->w->out;
    const dea_still_line line = {l->scene, l->scene->models[0], l->axis, symbol_at(l, l->from)};
    const dea_status status = dea_still_cards_open(&line, false, l->w->dialect, out, &l->cards, error);
    if (status != DEA_OK) {
        return status;
    }
    write_place(l);
    fprintf(out, ".subckt line%zu k edge\n", l->w->lines);
    dea_still_cards_write_numbers(&l->cards);
    if (l->axis) {
        dea_axis_write(&l->cards.text, l->axis, l->from, l->to);
    }
    dea_still_cards_write_network(&l->cards, 0);
    fprintf(out, ".ends\nXLINE%zu k edge%zu line%zu\n", l->w->lines, l->w->lines, l->w->lines);
    write_start(l);
    return DEA_OK;
}

/* Size of the film at a point. */
static double length_at(line_text *l, size_t i)
{
    if (!l->membrane) {
        (void)dea_balance_valid(&l->balance, symbol_at(l, i)); /* moves the balance there */
        return dea_balance_length(&l->balance);
    }
    dea_scene here = *l->scene;
    dea_point point;
    if (l->axis) {
        dea_axis_set(l->axis, &here, symbol_at(l, i));
    }
    dea_point_place(&here, &point);
    return point.frame_radius * fmin(point.coverage, 1.0 - point.coverage);
}

static void divide_steps(line_text *l)
{
    double before = displacement_at(l, l->from);
    for (size_t i = l->from + 1; i < l->to; i++) {
        const double next = displacement_at(l, i);
        const double length = length_at(l, i);
        while (l->w->parts < MOST_PARTS &&
               fabs(next - before) > (double)l->w->parts * longest_step * length) {
            l->w->parts *= 2;
        }
        before = next;
    }
}

static void add_scales(line_text *l)
{
    if (l->membrane) { /* of numbers of size 1 */
        l->w->length = fmin(l->w->length, 1.0);
        l->w->force = fmin(l->w->force, 1.0);
        return;
    }
    const dea_forces f = dea_balance_forces(&l->balance, symbol_at(l, l->from), 0.0);
    const double length = l->scene->actuator.frame_radius;
    l->w->length = fmin(l->w->length, length);
    l->w->force = fmin(l->w->force, fabs(f.elastic_slope) * length);
}

/* A line without any point that has an equilibrium is left out. */
static dea_status visit_line(void *user, const dea_scene *scene, const dea_line *line, dea_error *error)
{
    writer *w = user;
    line_text l = {.w = w, .scene = scene, .axis = line->axis};
    w->lines++;
    l.membrane = scene->models[0]->membrane;
    dea_status status = l.membrane ? DEA_OK : dea_network_build(scene, scene->models[0], line->axis, &l.network, error);
    if (status == DEA_OK && !l.membrane) {
        status = dea_balance_open(&l.network, &l.balance, error);
    }
    if (status == DEA_OK) {
        find_stretch(&l);
        if (l.to > l.from) {
            add_scales(&l);
            divide_steps(&l);
            fprintf(w->names, "%sv(edge%zu)", ++w->written % NAMES_A_LINE == 0 ? "\n+ " : " ", w->lines);
            status = (l.membrane ? write_membrane : write_line)(&l, error);
        } else {
            fprintf(w->out, "* line %zu has no point with an equilibrium\n", w->lines);
        }
    }
    dea_still_cards_close(&l.cards);
    dea_balance_close(&l.balance);
    dea_network_free(&l.network);
    return status;
}

static void write_tolerances(const writer *w)
{
    if (w->dialect->solver) {
        dea_part_print(w->out, "* tolerances of one point\n%s reltol=%g abstol=%g vntol=%g\n",
                       w->dialect->solver, fmin(1e-8, 0.1 * w->export->scene->accuracy), 1e-18 * w->force, 1e-18 * w->length);
    }
}

static void write_analysis(const writer *w, const char *names)
{
    FILE *out = w->out;
    write_tolerances(w);
    fputs(w->dialect->sweep, out);
    fputs("* the sweep over the index of the points\nVINDEX k 0 0\n", out);
    if (w->export->dialect->save) {
        fprintf(out, "%s%s\n", w->export->dialect->save, names);
    }
    fprintf(out, ".print dc%s\n", names);
    if (w->parts > 1) {
        fprintf(out, "* every row number n %zu, n = 0, 1, 2 ..., is a point; those between lead from one to the next\n",
                w->parts);
    }
    dea_part_print(out, ".dc VINDEX 0 %zu %g\n.end\n", w->points - 1, 1.0 / (double)w->parts);
}

static dea_status refuse(const dea_export *export, dea_error *error)
{
    const dea_scene *scene = export->scene;
    const size_t points = dea_scene_point_count(scene);
    size_t longest = 1;
    for (size_t i = 0; i < scene->axis_count; i++) {
        const dea_axis *axis = &scene->axes[i];
        longest = axis->count > longest ? axis->count : longest;
        if (!axis->uniform && axis->count > MOST_LIST) {
            return dea_fail(error, DEA_ERROR_UNSUPPORTED,
                            "the axis %s is a list of %zu values, a netlist holds %d of them: give it as from, to, points",
                            axis->key, axis->count, MOST_LIST);
        }
    }
    if (points / longest > MOST_LINES) {
        return dea_fail(error, DEA_ERROR_UNSUPPORTED, "the sweep has %zu lines of points, a netlist holds %d: sweep fewer axes",
                        points / longest, MOST_LINES);
    }
    if (export->analogy_given && export->analogy->loop) {
        return dea_fail(error, DEA_ERROR_UNSUPPORTED,
                        "a static sweep is written in displacement form, which has no analogies: leave out --analogy");
    }
    return DEA_OK;
}

static dea_status write_lines(writer *w, dea_error *error)
{
    const dea_scene *scene = w->export->scene;
    dea_memory_text names;
    dea_status status = dea_memory_text_begin(&names, error);
    w->names = names.out;
    status = status ? status : dea_lines_visit(scene, 0, dea_scene_point_count(scene), visit_line, w, error);
    status = dea_memory_text_end(&names, status, error);
    if (status == DEA_OK && w->written == 0) {
        status = dea_fail(error, DEA_ERROR_UNSUPPORTED, "no point of the sweep has an equilibrium");
    }
    if (status == DEA_OK) {
        write_analysis(w, names.text);
    }
    free(names.text);
    return status;
}

dea_status dea_export_sweep(dea_export *export, dea_error *error)
{
    const dea_scene *scene = export->scene;
    writer w = {.export = export,
                .out = export->out,
                .dialect = export->dialect,
                .points = 1,
                .parts = 1,
                .length = INFINITY,
                .force = INFINITY};
    dea_status status = refuse(export, error);
    if (status != DEA_OK) {
        return status;
    }
    for (size_t i = 0; i < scene->axis_count; i++) {
        w.points = scene->axes[i].count > w.points ? scene->axes[i].count : w.points;
    }
    dea_export_head(export, "displacement form: v(edge) = displacement of the disc edge [m], current = force [N]");
    status = write_lines(&w, error);
    if (status == DEA_OK && w.left_out > 0) {
        snprintf(export->note, sizeof export->note,
                 "%zu points have no equilibrium: there the netlist repeats the nearest point of its line that has one, or has "
                 "no line",
                 w.left_out);
    }
    return status;
}
