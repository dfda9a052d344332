#include "engine/ngspice/deck.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "netlist/curve_cards.h"
#include "support/memory_text.h"

/* The engine's text: numbers, in the analogy in which nothing but nodes is added. */
static dea_cards_form engine_form(void)
{
    return (dea_cards_form){.dialect = dea_dialect_find("ngspice"), .analogy = dea_analogy_at(0), .numbers = true};
}

typedef struct writer {
    const dea_mobility *mobility;
    const dea_dynamics *dynamics;
    const dea_mobility_piece *piece;
    dea_cards cards;
    FILE *out;
} writer;

/* Corners of a segment up to its end. The library meets each, and from one to the next takes four steps at least, which it would
 * not shorten for an edge that is shorter than one: corners on its line do that. */
static void write_ramp(FILE *out, const dea_mobility_piece *p, const dea_segment *segment)
{
    const double from = fmax(segment->from, p->from);
    const double end = fmin(segment->to, p->to);
    const bool brief = segment->start != segment->end && end - from < p->parts * p->step;
    const double parts = brief ? p->parts : 1.0;
    for (double part = 1.0; part <= parts; part++) {
        const double time = part == parts ? end : from + (end - from) * (part / parts);
        dea_part_print(out, " %g %g", time - p->from, dea_segment_voltage(p->signal, segment, time));
    }
}

/* The root of the square's polynomial, whose powers of x stand in @p power: from P_0 and P_1 on
 * (n + 1) P_n+1 = (2n + 1) x P_n - n P_n-1. */
static void powers_of(const double *terms, double power[DEA_TERMS])
{
    double p0[DEA_TERMS] = {1.0}, p1[DEA_TERMS] = {0.0, 1.0}, p2[DEA_TERMS];
    memset(power, 0, DEA_TERMS * sizeof *power);
    power[0] = terms[0];
    for (int n = 1; n < DEA_TERMS; n++) {
        for (int k = 0; k < DEA_TERMS; k++) {
            power[k] += terms[n] * p1[k];
            p2[k] = ((2 * n + 1) * (k > 0 ? p1[k - 1] : 0.0) - n * p0[k]) / (n + 1);
        }
        memcpy(p0, p1, sizeof p0);
        memcpy(p1, p2, sizeof p1);
    }
}

/* A segment that stands for lines, by Horner's scheme. */
static void write_thinned(FILE *out, const dea_mobility_piece *p, const char *node)
{
    const dea_segment *segment = &p->signal->segments[p->segment];
    const dea_dialect *dialect = engine_form().dialect;
    const double rate = 2.0 / (segment->to - segment->from), first = rate * (p->from - segment->from) - 1.0;
    double power[DEA_TERMS];
    powers_of(segment->terms, power);
    fprintf(out, "VSOURCE %s thinned 0\n", node);
    dea_dialect_source_begin(dialect, out, DEA_VOLTAGE, "thinned", "thinned", "0");
    fputs("sqrt(max(0,", out);
    for (int n = 1; n < DEA_TERMS; n++) {
        dea_part_print(out, "(%g)+((%g)+%g*time)*(", power[n - 1], first, rate);
    }
    dea_part_print(out, "(%g)", power[DEA_TERMS - 1]);
    for (int n = 1; n < DEA_TERMS; n++) {
        fputc(')', out);
    }
    fputs("))", out);
    dea_dialect_source_end(dialect, out);
}

void dea_deck_corners(FILE *out, const dea_mobility_piece *p)
{
    dea_part_print(out, "0 %g", dea_segment_voltage(p->signal, &p->signal->segments[p->segment], p->from));
    for (size_t i = p->segment; i < p->signal->count && p->signal->segments[i].from < p->to; i++) {
        write_ramp(out, p, &p->signal->segments[i]);
    }
}

void dea_deck_source(FILE *out, const dea_mobility_piece *p, const char *node)
{
    const dea_segment *segment = &p->signal->segments[p->segment];
    fputs("* voltage of the source [V]\n", out);
    if (segment->terms) {
        write_thinned(out, p, node);
        return;
    }
    if (segment->sine) {
        const dea_curve_cards cards = {.out = out,
                                       .dialect = engine_form().dialect,
                                       .signal = p->signal,
                                       .first = p->segment,
                                       .count = 1,
                                       .begin = p->from,
                                       .node = node};
        dea_curve_cards_write(&cards);
        return;
    }
    fprintf(out, "VSOURCE %s 0 pwl(", node);
    dea_deck_corners(out, p);
    fputs(")\n", out);
}

static double current_tolerance(const writer *w)
{
    return 1e-10 * w->piece->force;
}

/* The library has one tolerance for all currents, forces and electrical ones: those of the port are drawn in a unit of so many
 * amperes that it leaves 10^-9 of the voltage open. In amperes the current of a small resistance could not be found so well, and
 * that of a large one would drown. */
static double port_unit(const writer *w)
{
    const double unit = 1e-9 * w->piece->signal->largest / (w->dynamics->series * current_tolerance(w));
    return unit > 0.0 && isfinite(unit) ? unit : 1.0;
}

static void write_fit(const writer *w)
{
    if (w->piece->conductance != 0.0) {
        fputs("* mechanical resistance [N s/m] that fits the damping of the time steps to that of the film; its inverse is "
              "written\n",
              w->out);
        dea_part_value(w->out, "r_fit", 1.0 / w->piece->conductance);
        fputs("RFIT edge 0 {r_fit}\n", w->out);
    }
}

/* Pivots are the largest elements (pivrel=1): with smaller ones the velocity of a spring's end, the difference of two fluxes over
 * a step, is taken from the row that rounds it most, by 1e-16 u/h, which no tolerance of a velocity allows for. A film that follows
 * its voltage has no such node: there the order of the largest elements has made matrices singular.
 *
 * The steps are as long as they may be, the step control of the library is off: its errors would follow no order. The library
 * takes a corner at the print interval, with a first step of the Euler rule behind it, which would damp a ring: with mass that
 * interval is short. */
static void write_analysis(const writer *w)
{
    const dea_mobility_piece *p = w->piece;
    const dea_mobility_vectors vectors = dea_mobility_vectors_of(w->mobility);
    const double speed = p->scale / p->step;
    /* rounding of the velocity: of that of a ring, or where no mass holds it, of differences of u over a step */
    const double ring = p->mass > 0.0 ? 1e-14 * sqrt(p->force * p->scale / p->mass) : 1e-11 * speed;
    const double noise = w->mobility->displaced ? 0.0 : ring;
    dea_part_print(w->out,
                   ".options method=trap trtol=1e30 itl4=50 pivtol=1e-60 pivrel=%s reltol=%g vntol=%g abstol=%g chgtol=1e-30\n"
                   ".save",
                   w->mobility->displaced ? "0.3" : "1", p->tolerance, p->loose * (1e-11 * fmin(speed, p->scale) + noise), p->loose * current_tolerance(w));
    for (size_t i = 1; i < vectors.count; i++) {
        const char *name = vectors.names[i];
        const char *mark = strchr(name, '#');
        if (mark) {
            fprintf(w->out, " i(%.*s)", (int)(mark - name), name);
        } else {
            fprintf(w->out, " v(%s)", name);
        }
    }
    dea_part_print(w->out, "\n.tran %g %g 0 %g uic\n.end\n", p->mass > 0.0 ? 0.01 * p->step : p->step, p->to - p->from, p->step);
}

static void write_piece(writer *w)
{
    const dea_mobility_piece *p = w->piece;
    const bool series = w->dynamics->series > 0.0;
    const dea_cards_numbers numbers = {p->start, p->mass, series ? port_unit(w) : 1.0};
    fputs("* moving dielectric elastomer actuator, numbers in units in which they are of size 1\n", w->out);
    dea_cards_write_numbers(&w->cards, &numbers);
    dea_cards_write_network(&w->cards);
    dea_deck_source(w->out, p, series ? "source" : "film");
    write_fit(w);
    fputs(".ic", w->out);
    dea_cards_write_start(&w->cards, &numbers, dea_segment_voltage(p->signal, &p->signal->segments[p->segment], p->from));
    fputc('\n', w->out);
    write_analysis(w);
}

dea_status dea_mobility_write(const dea_mobility *mobility, const dea_mobility_piece *piece, char **text, dea_error *error)
{
    const dea_cards_form form = engine_form();
    dea_memory_text memory;
    dea_status status = dea_memory_text_begin(&memory, error);
    writer w = {.mobility = mobility, .dynamics = mobility->dynamics, .piece = piece, .out = memory.out};
    if (status == DEA_OK && dea_cards_open(mobility, &form, w.out, &w.cards)) {
        dea_cards_declare(&w.cards);
        write_piece(&w);
    } else {
        w.cards.text.exhausted = true;
    }
    if (status == DEA_OK && w.cards.text.exhausted) {
        status = dea_fail(error, DEA_ERROR_MEMORY, "out of memory while a netlist is written");
    }
    dea_cards_close(&w.cards);
    status = dea_memory_text_end(&memory, status, error);
    *text = memory.text;
    return status;
}

static bool is_linear(const dea_mobility *mobility)
{
    return !isnan(mobility->stiffness);
}

dea_mobility_vectors dea_mobility_vectors_of(const dea_mobility *mobility)
{
    const bool linear = is_linear(mobility);
    dea_mobility_vectors v = {.count = 0};
    snprintf(v.names[v.count++], DEA_MOBILITY_NAME, "time");
    snprintf(v.names[v.count++], DEA_MOBILITY_NAME, linear ? "lspring#branch" : "disp");
    if (!mobility->displaced) {
        snprintf(v.names[v.count++], DEA_MOBILITY_NAME, "edge");
    }
    for (size_t i = 1; i <= dea_dynamics_states(mobility->dynamics); i++) {
        snprintf(v.names[v.count++], DEA_MOBILITY_NAME, linear ? "lbranch%zu#branch" : "z%zu", i);
    }
    if (mobility->dynamics->series > 0.0) {
        snprintf(v.names[v.count++], DEA_MOBILITY_NAME, "charge");
    }
    return v;
}

dea_mobility_state dea_mobility_read(const dea_mobility *mobility, const double *const *columns, size_t index)
{
    const dea_dynamics *d = mobility->dynamics;
    const double k = mobility->stiffness;
    const double first = columns[1][index];
    const size_t next = mobility->displaced ? 2 : 3;
    dea_mobility_state state = {.u = is_linear(mobility) ? first / k : first};
    state.v = mobility->displaced ? 0.0 : columns[2][index];
    for (size_t i = 0; i < dea_dynamics_states(d); i++) {
        const double value = columns[next + i][index];
        state.z[i] = is_linear(mobility) ? first - value / d->branches[i].share : value;
    }
    if (d->series > 0.0) {
        state.charge = mobility->rest * columns[next + dea_dynamics_states(d)][index];
    }
    return state;
}

double dea_deck_parts(double fineness)
{
    return ceil(2.0 / fineness);
}

/* The library shortens a step to an eighth where Newton's method does not settle, and goes on with that for ever where rounding
 * alone keeps it from doing so: a netlist that takes so many times its steps and so many points more behind each corner is run
 * again with absolute tolerances so many times as large, in which its answers move by no more than that. */
static const double collapse = 2.0;
static const double corner_points = 100.0;
static const double first_points = 500.0;
static const double loosen = 100.0;
static const double loosest = 1e4;

/* Points after which the steps of a netlist have collapsed, or it has taken what it may. */
static double most_points(const dea_mobility_piece *piece)
{
    const dea_signal *signal = piece->signal;
    double corners = 0.0;
    for (size_t i = piece->segment; i < signal->count && signal->segments[i].from < piece->to; i++) {
        corners += piece->parts;
    }
    const double all = first_points + corner_points * corners + collapse * (piece->to - piece->from) / piece->step;
    return piece->most > 0.0 ? fmin(all, fmax(1.0, ceil(piece->most - piece->taken))) : all;
}

dea_status dea_deck_run(dea_ngspice *library, dea_mobility_piece *piece, dea_deck_writer *write, const void *user,
                        const char *const *names, size_t count, dea_ngspice_table *table, dea_error *error)
{
    *table = (dea_ngspice_table){0};
    for (;;) {
        char *text = NULL;
        const size_t most = (size_t)most_points(piece);
        dea_status status = write(user, piece, &text, error);
        if (status == DEA_OK) {
            dea_ngspice_limit(library, most);
            status = dea_ngspice_run_all(library, text, names, count, table, error);
        }
        free(text);
        piece->taken += (double)table->count;
        const bool spent = piece->most > 0.0 && piece->taken >= piece->most;
        if (status != DEA_OK || table->count < most || !(piece->loose < loosest) || spent) {
            return status;
        }
        dea_ngspice_table_free(table);
        piece->loose *= loosen;
    }
}
