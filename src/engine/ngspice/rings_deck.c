#include "engine/ngspice/rings_deck.h"

#include <stdlib.h>

#include "geometry/point.h"
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

/* The steps are as long as they may be, the step control of the library is off: its errors would follow no order. It takes a
 * corner at the print interval, with a first step of the Euler rule behind it: that interval is short. All nodes are of size 1. */
static void write_analysis(FILE *out, const dea_mobility_piece *p)
{
    dea_part_print(out,
                   ".options method=trap trtol=1e30 itl4=50 pivtol=1e-60 reltol=%g vntol=%g abstol=%g chgtol=1e-30\n"
                   ".tran %g %g 0 %g uic\n"
                   ".end\n",
                   p->tolerance, p->loose * 1e-11, p->loose * 1e-10, 0.01 * p->step, p->to - p->from, p->step);
}

dea_status dea_rings_deck_write(const char *network, const dea_membrane *membrane, const dea_mobility_piece *piece,
                                const double *states, char **text, dea_error *error)
{
    dea_memory_text memory;
    dea_status status = dea_memory_text_begin(&memory, error);
    FILE *out = memory.out;
    if (status == DEA_OK) {
        fprintf(out, "* moving membrane, numbers in units in which they are of size 1\n%s", network);
        dea_deck_source(out, piece, membrane->film.series > 0.0 ? "source" : "film");
        write_states(out, ".ic", membrane, states);
        write_states(out, ".save", membrane, NULL);
        write_analysis(out, piece);
    }
    status = dea_memory_text_end(&memory, status, error);
    *text = memory.text;
    return status;
}
