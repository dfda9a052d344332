#include "netlist/netlist.h"

#include <stdio.h>
#include <stdlib.h>

#include "netlist/expression_text.h"
#include "support/text.h"

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
        dea_netlist_number(out, axis->values[0]);
        fputs(" axis_span=", out);
        dea_netlist_number(out, axis->values[axis->count - 1] - axis->values[0]);
        fputs(" axis_last=", out);
        dea_netlist_number(out, (double)(axis->count - 1));
        fputs("\nBAXIS axis 0 v=({axis_from})+({axis_span})*v(k)/{axis_last}\n", out);
        return;
    }
    for (size_t i = 0; i < study->count; i++) {
        fprintf(out, ".param a%zu=", i);
        dea_netlist_number(out, axis->values[study->from + i]);
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

/* The springs are parallel and nobody asks for their single forces, so they are written as one. */
static void write_forces(const dea_expression_text *text, const dea_network *network, dea_expr elastic, dea_expr load,
                         const dea_netlist_study *study)
{
    FILE *out = text->out;
    for (int i = 0; i < network->element_count; i++) {
        fprintf(out, "* %s: %s\n", network->elements[i].name, network->elements[i].meaning);
    }
    fputs("* elastic force of all springs [N], from the edge to the frame\nBSPRING edge 0 i=", out);
    dea_expression_text_write(text, elastic);
    fputs("\n* electrostatic force f_dea [N], onto the edge\nBFORCE 0 edge i=", out);
    if (study->ramp) {
        dea_expression_text_factor(text, load);
        fprintf(out, "*v(k)/%zu", study->ramp);
    } else {
        dea_expression_text_write(text, load);
    }
    fputc('\n', out);
}

/* Where Newton starts: the first point at rest, without voltage on the mechanics. */
static void write_start(dea_expression_text *text, const dea_netlist_study *study)
{
    const double first = study->axis ? study->axis->values[study->from] : 0.0;
    fputs(".nodeset v(edge)=0", text->out);
    if (study->axis) {
        fputs(" v(axis)=", text->out);
        dea_netlist_number(text->out, first);
    }
    dea_expression_text_start(text, first, 0.0);
    fputc('\n', text->out);
}

static void write_all(dea_expression_text *text, const dea_network *network, dea_expr elastic, dea_expr load,
                      const dea_netlist_study *study)
{
    FILE *out = text->out;
    fputs("* dielectric elastomer actuator: v(edge) = displacement of the disc edge [m], current = force [N]\n", out);
    dea_expression_text_use(text, elastic);
    dea_expression_text_use(text, load);
    dea_expression_text_share(text);
    dea_expression_text_parameters(text);
    write_axis(out, study);
    dea_expression_text_nodes(text);
    write_forces(text, network, elastic, load, study);
    write_start(text, study);
    fputs(".options itl1=60 itl2=60 gminsteps=0 srcsteps=0 reltol=", out);
    dea_netlist_number(out, study->tolerance);
    fputs(" vntol=", out);
    dea_netlist_number(out, 1e-21 * study->length_scale);
    fputs(" abstol=", out);
    dea_netlist_number(out, 1e-21 * study->force_scale);
    fputs("\n.save v(edge)\n", out);
    const size_t last = study->ramp ? study->ramp : study->from + study->count - 1;
    fprintf(out, ".dc VINDEX %zu %zu 1\n.end\n", study->ramp ? 0 : study->from, last);
}

dea_status dea_netlist_write(dea_network *network, const dea_netlist_study *study, char **text, dea_error *error)
{
    const dea_expr elastic = dea_network_elastic(network);
    const dea_expr load = dea_network_load(network);
    size_t length = 0;
    dea_expression_text writer;
    *text = NULL;
    FILE *out = open_memstream(text, &length);
    const bool ready = dea_expression_text_open(&writer, &network->pool, out, "v(edge)") && out;
    if (ready) {
        write_all(&writer, network, elastic, load, study);
    }
    const bool written = dea_text_close(out);
    dea_expression_text_close(&writer);
    if (!ready || !written) {
        free(*text);
        *text = NULL;
        return dea_fail(error, DEA_ERROR_MEMORY, "out of memory while a netlist is written");
    }
    return DEA_OK;
}
