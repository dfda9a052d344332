#include "netlist/netlist.h"

#include <stdio.h>
#include <stdlib.h>

#include "netlist/mobility.h"
#include "support/text.h"

bool dea_still_cards_open(dea_network *network, double symbol, const dea_dialect *dialect, FILE *out, dea_still_cards *cards)
{
    dea_pool *pool = &network->pool;
    *cards = (dea_still_cards){.network = network};
    dea_network_gather(network);
    cards->elastic = dea_expr_gathered(pool, dea_network_elastic(network));
    cards->load = dea_expr_gathered(pool, dea_network_load(network));
    cards->values = calloc((size_t)pool->count + 1, sizeof *cards->values);
    if (!dea_part_text_open(&cards->text, pool, dialect, out) || !cards->values) {
        return false;
    }
    static const char *const symbols[] = {"v(axis)"};
    dea_pool_values(pool, symbol, 0.0, cards->values);
    cards->text.node = "v(edge)";
    cards->text.symbols = symbols;
    cards->text.values = cards->values;
    dea_part_text_move_symbol(&cards->text, 0);
    dea_part_text_share(&cards->text);
    dea_part_text_call(&cards->text, network);
    dea_part_text_root(&cards->text, "force");
    dea_part_text_use(&cards->text, cards->load);
    dea_part_text_root(&cards->text, "spring");
    dea_part_text_use(&cards->text, cards->elastic);
    return !cards->text.exhausted;
}

void dea_still_cards_close(dea_still_cards *cards)
{
    dea_part_text_close(&cards->text);
    free(cards->values);
}

void dea_still_cards_write_numbers(dea_still_cards *cards)
{
    dea_part_text_parameters(&cards->text);
}

/* The springs are parallel and nobody asks for their single forces, so they are written as one. */
void dea_still_cards_write_network(dea_still_cards *cards, size_t ramp)
{
    const dea_part_text *text = &cards->text;
    FILE *out = text->out;
    fputs(DEA_CARDS_BEGIN, out);
    for (int i = 0; i < cards->network->element_count; i++) {
        const dea_element *element = &cards->network->elements[i];
        fprintf(out, "* %s%s: %s\n", element->second ? "second film, " : "", element->name, element->meaning);
    }
    dea_part_text_nodes(&cards->text);
    fputs("* elastic force of all springs [N], from the edge to the frame\n", out);
    dea_dialect_source_begin(text->dialect, out, DEA_CURRENT, "spring", "edge", "0");
    dea_part_text_write(text, cards->elastic);
    dea_dialect_source_end(text->dialect, out);
    fputs("* electrostatic force f_dea [N], Eq. 21, onto the edge\n", out);
    dea_dialect_source_begin(text->dialect, out, DEA_CURRENT, "force", "0", "edge");
    dea_part_text_write(text, cards->load);
    if (ramp > 0) {
        fprintf(out, "*v(k)/%zu", ramp);
    }
    dea_dialect_source_end(text->dialect, out);
    fputs(DEA_CARDS_END, out);
}

void dea_still_cards_write_start(dea_still_cards *cards, const char *inside, double symbol, double u)
{
    dea_pool_values(&cards->network->pool, symbol, u, cards->values);
    dea_part_text_start(&cards->text, inside, cards->values);
}

/* The swept scalar as a voltage of the index k, so that no rounding adds up along a sweep. */
static void write_axis(FILE *out, const dea_netlist_study *study)
{
    const dea_axis *axis = study->axis;
    fputs("VINDEX k 0 0\n", out);
    if (!axis) {
        return;
    }
    if (axis->uniform && axis->count > 1) {
        fputs(".param axis_from=", out);
        dea_part_number(out, axis->values[0]);
        fputs(" axis_span=", out);
        dea_part_number(out, axis->values[axis->count - 1] - axis->values[0]);
        fputs(" axis_last=", out);
        dea_part_number(out, (double)(axis->count - 1));
        fputs("\nBAXIS axis 0 v=({axis_from})+({axis_span})*v(k)/{axis_last}\n", out);
        return;
    }
    for (size_t i = 0; i < study->count; i++) {
        fprintf(out, ".param a%zu=", i);
        dea_part_number(out, axis->values[study->from + i]);
        fputc('\n', out);
    }
    if (study->count == 1) {
        fputs("VAXIS axis 0 {a0}\n", out);
        return;
    }
    fputs("BAXIS axis 0 v=pwl(v(k)", out);
    for (size_t i = 0; i < study->count; i++) {
        fprintf(out, ",%zu,{a%zu}", study->from + i, i);
    }
    fputs(")\n", out);
}

/* The displacement of an edge that is held, as a voltage of the index k. */
static void write_hold(FILE *out, const dea_netlist_study *study)
{
    fputs("* what holds the edge: its current is the force on it\n.param hold_from=", out);
    dea_part_number(out, study->held->from);
    fputs(" hold_span=", out);
    dea_part_number(out, study->held->to - study->held->from);
    fputs(" hold_last=", out);
    dea_part_number(out, (double)(study->count - 1));
    fputs("\nBHOLD edge 0 v=({hold_from})+({hold_span})*v(k)/{hold_last}\n", out);
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
    write_axis(out, study);
    if (study->held) {
        write_hold(out, study);
    }
    fputs(".nodeset v(edge)=0", out);
    if (study->axis) {
        fputs(" v(axis)=", out);
        dea_part_number(out, first_of(study));
    }
    dea_still_cards_write_start(cards, "", first_of(study), 0.0);
    fputs("\n.options itl1=60 itl2=60 gminsteps=0 srcsteps=0 reltol=", out);
    dea_part_number(out, study->tolerance);
    fputs(" vntol=", out);
    dea_part_number(out, 1e-21 * study->length_scale);
    fputs(" abstol=", out);
    dea_part_number(out, 1e-21 * study->force_scale);
    fputs(study->held ? "\n.save bhold#branch\n" : "\n.save v(edge)\n", out);
    const size_t last = study->ramp ? study->ramp : study->from + study->count - 1;
    fprintf(out, ".dc VINDEX %zu %zu 1\n.end\n", study->ramp ? 0 : study->from, last);
}

dea_status dea_netlist_write(dea_network *network, const dea_netlist_study *study, char **text, dea_error *error)
{
    size_t length = 0;
    dea_still_cards cards = {.network = NULL};
    *text = NULL;
    FILE *out = open_memstream(text, &length);
    const bool ready = out && dea_still_cards_open(network, first_of(study), dea_dialect_find("ngspice"), out, &cards);
    if (ready) {
        write_all(&cards, study);
    }
    const bool written = dea_text_close(out);
    dea_still_cards_close(&cards);
    if (!ready || !written) {
        free(*text);
        *text = NULL;
        return dea_fail(error, DEA_ERROR_MEMORY, "out of memory while a netlist is written");
    }
    return DEA_OK;
}
