#include "engine/ngspice/rings_track.h"

#include <math.h>
#include <stdlib.h>

#include "film/point.h"
#include "support/memory_text.h"

dea_status dea_rings_deck_network(const dea_scene *scene, const dea_membrane *membrane, double unit, char **text, dea_error *error)
{
    const dea_dynamics *film = &membrane->film;
    const dea_cards_form form = {.dialect = dea_dialect_at(0), .analogy = dea_analogy_at(0), .numbers = true};
    const dea_rings_port port = {unit * film->series, unit / film->conductance, dea_point_capacitance(&film->point) / unit};
    dea_rings_motion_cards cards;
    dea_memory_text memory;
    dea_status status = dea_memory_text_begin(&memory, error);
    if (status == DEA_OK) {
        status = dea_rings_motion_cards_open(scene, membrane, &form, memory.out, &cards, error);
        if (status == DEA_OK) {
            dea_rings_motion_cards_write_numbers(&cards, &port);
            dea_rings_motion_cards_write_network(&cards);
        }
        dea_rings_motion_cards_close(&cards);
    }
    status = dea_memory_text_end(&memory, status, error);
    *text = memory.text;
    return status;
}

/* Names on one card: longer ones get lost. */
enum { NAMES = 16 };

static void write_states(FILE *out, const char *card, const dea_membrane *membrane, const double *values)
{
    for (size_t i = 0; i < dea_rings_states(membrane); i++) {
        fprintf(out, "%s%s v(%s)", i % NAMES ? "" : "\n", i % NAMES ? "" : card, dea_rings_state_node(membrane, i).text);
        if (values) {
            dea_part_print(out, "=%g", values[i]);
        }
    }
    fputc('\n', out);
}

/* The steps are as long as they may be, the step control of the library is off: its errors would follow no order. All nodes are of
 * size 1. */
static void write_options(FILE *out, const dea_mobility_piece *p)
{
    dea_part_print(out, ".options method=trap trtol=1e30 itl4=50 pivtol=1e-60 reltol=%g vntol=%g abstol=%g chgtol=1e-30\n", p->tolerance,
                   p->loose * fmax(1e-11, 1e-3 * p->tolerance), p->loose * fmax(1e-10, 1e-2 * p->tolerance));
}

/* The library takes a corner at the print interval, with a first step of the Euler rule behind it: that interval is short. */
static void write_steps(FILE *out, const dea_mobility_piece *p)
{
    dea_part_print(out, "tran %g %g 0 %g uic\n", 0.01 * p->step, p->to - p->from, p->step);
}

/* What makes the circuit that is loaded that of another piece: corners of its source, states at its begin. */
typedef struct piece_writer {
    const char *network;
    const dea_membrane *membrane;
    const dea_mobility_piece *piece;
    const double *states;
    const char *node; /* of the source */
} piece_writer;

/* What fits the masses to the rule's steps: capacitors beside them, and resistors. */
static void write_fit(FILE *out, const dea_membrane *m, double mass, double conductance)
{
    for (size_t n = 0; n < m->rings.node_count && m->heavy; n++) {
        const char *v = dea_rings_state_node(m, m->rings.node_count + n).text;
        dea_part_print(out, "GFIT%zu %s 0 %s 0 %g\n", n + 1, v, v, conductance * m->masses[n]);
        if (mass != 1.0) {
            dea_part_print(out, "CFIT%zu %s 0 %g\n", n + 1, v, (mass - 1.0) * m->masses[n]);
        }
    }
}

/* The same by commands that change the circuit. */
static void change_fit(FILE *out, const dea_membrane *m, double mass, double conductance)
{
    for (size_t n = 0; n < m->rings.node_count && m->heavy; n++) {
        dea_part_print(out, "alter GFIT%zu gain=%g\nalter CMASS%zu=%g\n", n + 1, conductance * m->masses[n], n + 1, mass * m->masses[n]);
    }
}

/* The circuit of all pieces, and the commands that make it that of this one. */
static void write_again(FILE *out, const piece_writer *w, const char *corners)
{
    fprintf(out, "VSOURCE %s 0 pwl(0 0 1 0)\n", w->node);
    write_fit(out, w->membrane, 1.0, 0.0);
    write_states(out, ".save", w->membrane, NULL);
    write_options(out, w->piece);
    fprintf(out, ".end\n%s", corners);
    change_fit(out, w->membrane, w->piece->mass, w->piece->conductance);
    for (size_t i = 0; i < dea_rings_states(w->membrane); i++) {
        fprintf(out, "alter %s ic", dea_rings_state_element(w->membrane, i).text);
        dea_part_print(out, "=%g\n", w->states[i]);
    }
    write_steps(out, w->piece);
}

/* A netlist of its own. */
static void write_alone(FILE *out, const piece_writer *w)
{
    dea_deck_source(out, w->piece, w->node);
    write_fit(out, w->membrane, w->piece->mass, w->piece->conductance);
    write_states(out, ".ic", w->membrane, w->states);
    write_states(out, ".save", w->membrane, NULL);
    write_options(out, w->piece);
    fputc('.', out);
    write_steps(out, w->piece);
    fputs(".end\n", out);
}

/* True where commands can change one piece into another: each state is the charge of a capacitor, the source follows a few lines,
 * whose corners are one command, *@p corners. */
static bool can_change(const piece_writer *w, char **corners)
{
    const dea_segment *segment = &w->piece->signal->segments[w->piece->segment];
    const bool charged = w->membrane->heavy || w->membrane->film.retardation > 0.0;
    dea_memory_text memory;
    dea_status status = dea_memory_text_begin(&memory, NULL);
    if (status == DEA_OK) {
        fputs("alter @vsource[pwl] = [ ", memory.out);
        if (charged && !segment->sine) {
            dea_deck_corners(memory.out, w->piece);
        }
        fputs(" ]\n", memory.out);
    }
    status = dea_memory_text_end(&memory, status, NULL);
    *corners = memory.text;
    return status == DEA_OK && charged && !segment->sine && memory.length <= DEA_NGSPICE_COMMAND;
}

dea_status dea_rings_deck_write(const char *network, const dea_membrane *membrane, const dea_mobility_piece *piece,
                                const double *states, char **text, dea_error *error)
{
    const piece_writer w = {network, membrane, piece, states, membrane->film.series > 0.0 ? "source" : "film"};
    char *corners = NULL;
    dea_memory_text memory;
    dea_status status = dea_memory_text_begin(&memory, error);
    if (status == DEA_OK) {
        fprintf(memory.out, "* moving membrane, numbers in units in which they are of size 1\n%s", network);
        if (can_change(&w, &corners)) {
            write_again(memory.out, &w, corners);
        } else {
            write_alone(memory.out, &w);
        }
    }
    free(corners);
    status = dea_memory_text_end(&memory, status, error);
    *text = memory.text;
    return status;
}
