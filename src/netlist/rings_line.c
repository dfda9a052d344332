#include "netlist/rings_line.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "scene/line.h"
#include "netlist/netlist.h"
#include "netlist/rings_text.h"
#include "network/still.h"

enum { AXIS };

typedef struct writer {
    const dea_rings_line *line;
    const dea_dialect *dialect;
    FILE *out;
    dea_pool pool; /* owned */
    dea_rings_quantities quantities;
    dea_symbols symbols;
    dea_rings_cards cards;
    dea_part_text text; /* owned */
} writer;

/* The displacement of the edge in metres. */
static void write_edge(const writer *w)
{
    fputs("* displacement of the edge [m]\n", w->out);
    if (!w->text.terms[w->symbols.frame_radius].moves) {
        char radius[DEA_PART_NAME];
        fprintf(w->out, "EEDGE edge 0 u%zu 0 {%s}\n", w->cards.edge,
                dea_part_text_parameter(&w->text, w->symbols.frame_radius, radius));
        return;
    }
    dea_dialect_source_begin(w->dialect, w->out, DEA_VOLTAGE, "edge", "edge", "0");
    dea_part_text_write(&w->text, w->symbols.frame_radius);
    fprintf(w->out, "*v(u%zu)", w->cards.edge);
    dea_dialect_source_end(w->dialect, w->out);
}

static void write_guess(const writer *w, const char *node, double value)
{
    fprintf(w->out, " v(xline%zu%s%s)=", w->line->number, w->dialect->inside, node);
    dea_part_number(w->out, value);
}

/* Where Newton starts: the film at rest, and what moves with the axis alone at the first point. */
static dea_status write_start(writer *w, dea_error *error)
{
    const dea_axis *axis = w->line->axis;
    const double none[DEA_RINGS_VARIABLES] = {0.0};
    char inside[DEA_PART_NAME];
    double symbols[DEA_RINGS_SYMBOLS], *values = calloc((size_t)w->pool.count + 1, sizeof *values);
    if (!values) {
        return dea_fail(error, DEA_ERROR_MEMORY, "out of memory while a netlist is written");
    }
    memcpy(symbols, w->quantities.values, sizeof symbols);
    symbols[AXIS] = axis->values[w->line->from];
    dea_pool_values_at(&w->pool, &(dea_point_values){symbols, none, (int)w->quantities.count, DEA_RINGS_VARIABLES}, values);
    snprintf(inside, sizeof inside, "xline%zu%s", w->line->number, w->dialect->inside);
    fputs(".nodeset", w->out);
    if (dea_axis_holds(axis, w->line->from, w->line->to)) {
        write_guess(w, "point", (double)w->line->from);
    }
    write_guess(w, "axis", symbols[AXIS]);
    dea_part_text_start(&w->text, inside, values);
    fputc('\n', w->out);
    free(values);
    return DEA_OK;
}

static dea_status write_all(writer *w, dea_error *error)
{
    const dea_rings_line *line = w->line;
    const char *symbols[DEA_RINGS_SYMBOLS];
    for (size_t i = 0; i < w->quantities.count; i++) {
        symbols[i] = w->quantities.names[i];
    }
    w->text.symbols = symbols;
    if (line->axis) {
        dea_part_text_move_symbol(&w->text, AXIS);
    }
    dea_rings_cards_declare(&w->cards, &w->text);
    dea_part_text_use(&w->text, w->symbols.frame_radius);
    fprintf(w->out, "* exact membrane: %zu moving nodes (degrees of disc and annulus: %zu, %zu), displacement v(u<n>)/r, expected error\n",
            w->cards.node_count, line->mesh.disc, line->mesh.annulus);
    fprintf(w->out, "* of v(edge): %.0e. ring q: strains v(a<q>), v(b<q>), stresses v(s<q>), v(t<q>) [MPa]\n", line->error);
    fprintf(w->out, ".subckt line%zu k edge\n", line->number);
    dea_rings_quantities_write(&w->quantities, w->out);
    dea_part_text_parameters(&w->text);
    if (line->axis) {
        dea_axis_write(&w->text, line->axis, line->from, line->to);
    }
    dea_part_text_swept(&w->text);
    dea_rings_cards_write(&w->cards, &w->text);
    write_edge(w);
    fprintf(w->out, ".ends\nXLINE%zu k edge%zu line%zu\n", line->number, line->number, line->number);
    return line->axis ? write_start(w, error) : DEA_OK;
}

/* Share of the wanted accuracy that is the mesh's. */
static const double mesh_share = 0.03;

void dea_rings_line_choose(dea_rings_line *line)
{
    enum { PROBES = 5 };
    dea_scene scene = *line->scene;
    line->mesh = (dea_rings_mesh){1, 3, true};
    line->error = 0.0;
    for (size_t probe = 0; probe < (line->axis ? PROBES : 1); probe++) {
        dea_point point;
        double error;
        if (line->axis) {
            dea_axis_set(line->axis, &scene, line->axis->values[line->from + probe * (line->to - line->from - 1) / (PROBES - 1)]);
        }
        dea_film_prepare(&scene, &point.film);
        dea_point_place(&scene, &point);
        if (dea_point_valid(&point) && (point.voltage != 0.0 || point.force != 0.0)) {
            const dea_rings_mesh mesh = dea_still_mesh(&point, mesh_share * scene.accuracy, &error);
            line->error = mesh.annulus > 0 ? fmax(line->error, error) : line->error;
            line->mesh = mesh.annulus > line->mesh.annulus ? mesh : line->mesh;
        }
    }
}

dea_status dea_rings_line_write(const dea_rings_line *line, const dea_dialect *dialect, FILE *out, dea_error *error)
{
    writer w = {.line = line, .dialect = dialect, .out = out};
    dea_status status = DEA_OK;
    (void)dea_expr_number(&w.pool, 0.0);
    if (!w.pool.exhausted) {
        dea_rings_quantities_of(line->scene, line->axis, &w.pool, &w.symbols, &w.quantities);
        dea_rings_cards_make(&w.symbols, line->mesh, &w.cards);
    }
    if (!w.pool.exhausted && dea_part_text_open(&w.text, &w.pool, dialect, out)) {
        status = write_all(&w, error);
    } else {
        status = dea_fail(error, DEA_ERROR_MEMORY, "out of memory while a netlist is written");
    }
    if (status == DEA_OK && w.text.exhausted) {
        status = dea_fail(error, DEA_ERROR_MEMORY, "out of memory while a netlist is written");
    }
    dea_part_text_close(&w.text);
    dea_pool_free(&w.pool);
    return status;
}
