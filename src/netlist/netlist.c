#include "netlist/netlist.h"

#include <stdio.h>
#include <stdlib.h>

#include "netlist/mobility.h"
#include "support/memory_text.h"

static void evaluate(dea_still_cards *cards, double symbol, double u)
{
    dea_quantities *q = &cards->quantities;
    q->values[0] = symbol;
    dea_pool_values_at(&cards->network.pool, &(dea_point_values){q->values, &u, q->count + 1, 1}, cards->values);
}

/* Every expression that a card writes, as often as it does. */
static void declare(dea_still_cards *cards)
{
    dea_part_text *text = &cards->text;
    dea_part_text_move_symbol(text, 0);
    dea_part_text_share(text);
    dea_part_text_call(text, &cards->network);
    dea_part_text_root(text, "force");
    dea_part_text_use(text, cards->load);
    dea_part_text_root(text, "spring");
    dea_part_text_use(text, cards->elastic);
}

dea_status dea_still_cards_open(const dea_still_line *line, bool numbers, const dea_dialect *dialect, FILE *out,
                                dea_still_cards *cards, dea_error *error)
{
    dea_network *network = &cards->network;
    dea_pool *pool = &network->pool;
    *cards = (dea_still_cards){0};
    const dea_status status =
        dea_network_build_named(line->scene, line->model, line->axis, &cards->quantities, network, error);
    if (status != DEA_OK) {
        return status;
    }
    dea_network_gather(network);
    cards->elastic = dea_expr_gathered(pool, dea_network_elastic(network));
    cards->load = dea_expr_gathered(pool, dea_network_load(network));
    cards->values = calloc((size_t)pool->count + 1, sizeof *cards->values);
    if (!dea_part_text_open(&cards->text, pool, dialect, out) || !cards->values) {
        return dea_fail(error, DEA_ERROR_MEMORY, "out of memory while a netlist is written");
    }
    cards->symbols[0] = "v(axis)";
    for (int i = 1; i <= cards->quantities.count; i++) {
        cards->symbols[i] = cards->quantities.names[i];
    }
    evaluate(cards, line->first, 0.0);
    cards->text.node = "v(edge)";
    cards->text.symbols = cards->symbols;
    cards->text.values = numbers ? cards->values : NULL;
    declare(cards);
    return cards->text.exhausted ? dea_fail(error, DEA_ERROR_MEMORY, "out of memory while a netlist is written") : DEA_OK;
}

void dea_still_cards_close(dea_still_cards *cards)
{
    dea_part_text_close(&cards->text);
    dea_network_free(&cards->network);
    free(cards->values);
    cards->values = NULL;
}

void dea_still_cards_write_numbers(dea_still_cards *cards)
{
    if (!cards->text.values) {
        dea_cards_write_quantities(&cards->quantities, cards->text.out);
    }
    dea_part_text_parameters(&cards->text);
}

/* The springs are parallel and nobody asks for their single forces, so they are written as one. */
void dea_still_cards_write_network(dea_still_cards *cards, size_t ramp)
{
    const dea_part_text *text = &cards->text;
    FILE *out = text->out;
    char load[32] = "[]";
    fputs(DEA_CARDS_BEGIN, out);
    for (int i = 0; i < cards->network.element_count; i++) {
        const dea_element *element = &cards->network.elements[i];
        fprintf(out, "* %s%s: %s\n", element->second ? "second film, " : "", element->name, element->meaning);
    }
    dea_part_text_nodes(&cards->text);
    fputs("* elastic force of all springs [N], from the edge to the frame\n", out);
    dea_part_text_source(text, DEA_CURRENT, "spring", "edge", "0", "[]", cards->elastic);
    fputs("* electrostatic force f_dea [N], Eq. 21, onto the edge\n", out);
    if (ramp > 0) {
        snprintf(load, sizeof load, "[]*v(k)/%zu", ramp);
    }
    dea_part_text_source(text, DEA_CURRENT, "force", "0", "edge", load, cards->load);
    fputs(DEA_CARDS_END, out);
}

void dea_still_cards_write_start(dea_still_cards *cards, const char *inside, double symbol, double u)
{
    evaluate(cards, symbol, u);
    dea_part_text_start(&cards->text, inside, cards->values);
}

static bool is_even(const dea_axis *axis)
{
    return axis->uniform && axis->count > 1;
}

bool dea_axis_holds(const dea_axis *axis, size_t from, size_t to)
{
    return is_even(axis) && (from > 0 || to < axis->count);
}

static void write_even(const dea_part_text *text, const dea_axis *axis, bool held)
{
    char value[64];
    dea_part_value(text->out, "axis_from", axis->values[0]);
    dea_part_value(text->out, "axis_span", axis->values[axis->count - 1] - axis->values[0]);
    snprintf(value, sizeof value, "[axis_from]+[axis_span]*v(%s)/%zu", held ? "point" : "k", axis->count - 1);
    dea_part_text_source(text, DEA_VOLTAGE, "axis", "axis", "0", value);
}

/* By the simulator's function of a table; without one as the sum of the steps between values, each of which rises between two indices:
 * in ngspice a sum of 64 takes three times as long. */
static void write_list(const dea_part_text *text, const dea_axis *axis, size_t from, size_t to)
{
    const char *table = to - from > 1 ? text->dialect->table : NULL;
    char piece[96];
    dea_part_value(text->out, "axis_from", axis->values[from]);
    for (size_t i = from + 1; i < to; i++) {
        snprintf(piece, sizeof piece, "axis_%zu", i);
        dea_part_value(text->out, piece, axis->values[i] - (table ? 0.0 : axis->values[i - 1]));
    }
    dea_dialect_source_begin(text->dialect, text->out, DEA_VOLTAGE, "axis", "axis", "0");
    if (table) {
        fprintf(text->out, "%s(min(max(v(k),%zu),%zu),%zu,", table, from, to - 1, from);
    }
    dea_part_text_format(text, "[axis_from]");
    for (size_t i = from + 1; i < to; i++) {
        snprintf(piece, sizeof piece, table ? ",%zu,[axis_%zu]" : "+min(max(v(k)-%zu,0),1)*[axis_%zu]", table ? i : i - 1, i);
        dea_part_text_format(text, piece);
    }
    fputs(table ? ")" : "", text->out);
    dea_dialect_source_end(text->dialect, text->out);
}

void dea_axis_write(const dea_part_text *text, const dea_axis *axis, size_t from, size_t to)
{
    const bool held = dea_axis_holds(axis, from, to);
    if (held) {
        char index[64];
        snprintf(index, sizeof index, "min(max(v(k),%zu),%zu)", from, to - 1);
        fputs("* index of the point, held inside the points that have an equilibrium\n", text->out);
        dea_part_text_source(text, DEA_VOLTAGE, "point", "point", "0", index);
    }
    fprintf(text->out, "* value of %s at the point of index v(k) [%s]\n", axis->key, axis->unit);
    if (is_even(axis)) {
        write_even(text, axis, held);
    } else {
        write_list(text, axis, from, to);
    }
}

/* The displacement of an edge that is held, as a voltage of the index k. */
static void write_hold(FILE *out, const dea_netlist_study *study)
{
    dea_part_print(out,
                   "* what holds the edge: its current is the force on it\n"
                   ".param hold_from=%g hold_span=%g hold_last=%g\n"
                   "BHOLD edge 0 v=({hold_from})+({hold_span})*v(k)/{hold_last}\n",
                   study->held->from, study->held->to - study->held->from, (double)(study->count - 1));
}

static double first_of(const dea_netlist_study *study)
{
    return study->axis ? study->axis->values[study->from] : 0.0;
}

/* Newton starts from the first point at rest, without voltage on the mechanics. */
static void write_all(dea_still_cards *cards, const dea_netlist_study *study)
{
    FILE *out = cards->text.out;
    fputs("* dielectric elastomer actuator: v(edge) = displacement of the disc edge [m], current = force [N]\n", out);
    dea_still_cards_write_numbers(cards);
    dea_still_cards_write_network(cards, study->ramp);
    fputs("VINDEX k 0 0\n", out);
    if (study->axis) { /* all of an even axis: nothing holds the index */
        const bool even = is_even(study->axis);
        dea_axis_write(&cards->text, study->axis, even ? 0 : study->from, even ? study->axis->count : study->from + study->count);
    }
    if (study->held) {
        write_hold(out, study);
    }
    fputs(".nodeset v(edge)=0", out);
    if (study->axis) {
        dea_part_print(out, " v(axis)=%g", first_of(study));
    }
    dea_still_cards_write_start(cards, "", first_of(study), 0.0);
    dea_part_print(out, "\n.options itl1=60 itl2=60 gminsteps=0 srcsteps=0 reltol=%g vntol=%g abstol=%g",
                   study->tolerance, 1e-21 * study->length_scale, 1e-21 * study->force_scale);
    fputs(study->held ? "\n.save bhold#branch\n" : "\n.save v(edge)\n", out);
    const size_t last = study->ramp ? study->ramp : study->from + study->count - 1;
    fprintf(out, ".dc VINDEX %zu %zu 1\n.end\n", study->ramp ? 0 : study->from, last);
}

dea_status dea_netlist_write(const dea_netlist_study *study, char **text, dea_error *error)
{
    const dea_still_line line = {study->scene, study->model, study->axis, first_of(study)};
    dea_still_cards cards = {0};
    dea_memory_text memory;
    dea_status status = dea_memory_text_begin(&memory, error);
    status = status ? status : dea_still_cards_open(&line, true, dea_dialect_find("ngspice"), memory.out, &cards, error);
    if (status == DEA_OK) {
        write_all(&cards, study);
    }
    dea_still_cards_close(&cards);
    status = dea_memory_text_end(&memory, status, error);
    *text = memory.text;
    return status;
}
