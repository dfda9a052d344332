/* Force balance at the node `edge` (current): mass, springs, dampers and branches against the electrostatic force. Displacement
 * is an output of the network: the flux of the spring, n times its current, or where the spring is hyperelastic the integral of
 * the edge velocity in a capacitor of 1. `uic` with ic= everywhere: springs as inductors have no operating point. */
#include "netlist/mobility.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "model/models.h"
#include "netlist/curve_cards.h"
#include "netlist/expression_text.h"
#include "expression/derivative.h"
#include "expression/formula.h"
#include "support/text.h"

dea_status dea_mobility_open(const dea_scene *scene, const dea_dynamics *dynamics, dea_mobility *mobility, dea_error *error)
{
    dea_scene film = *scene;
    film.drive.voltage = 1.0;
    film.drive.series_resistance = film.drive.leakage_resistance = (double)NAN;
    *mobility = (dea_mobility){.dynamics = dynamics, .stiffness = (double)NAN};
    dea_network *network = &mobility->network;
    const dea_status status = dea_network_build(&film, dynamics->model, NULL, network, error);
    if (status != DEA_OK) {
        return status;
    }
    dea_pool *pool = &network->pool;
    dea_dynamics_stresses(dynamics, network, mobility->stresses);
    mobility->tension = dea_network_tension(network);
    mobility->tense = dea_expr_constant(pool, mobility->tension) != 0.0;
    mobility->push = dea_dynamics_push(dynamics, network);
    dea_expr viscous = NUM(0.0), slope = NUM(0.0);
    for (size_t a = 0; a < dynamics->stress_count; a++) {
        slope = dea_expr_slope(pool, mobility->stresses[a].stress);
        viscous = ADD(viscous, MUL(mobility->stresses[a].lever, slope));
    }
    mobility->resistance = SCALE(dynamics->retardation, viscous);
    if (pool->exhausted) {
        return dea_fail(error, DEA_ERROR_MEMORY, "out of memory while a network is built");
    }
    mobility->rest = dea_point_capacitance(&dynamics->point);
    if (dynamics->linear) {
        mobility->stiffness = dea_expr_constant(pool, slope);
    }
    return DEA_OK;
}

void dea_mobility_close(dea_mobility *mobility)
{
    if (mobility) {
        dea_network_free(&mobility->network);
    }
}

void dea_mobility_displace(dea_mobility *mobility)
{
    mobility->displaced = true;
    mobility->stiffness = (double)NAN;
}

dea_stress_node dea_mobility_stress_node(const dea_dynamics *dynamics, size_t index)
{
    dea_stress_node node = {"stress"};
    if (dynamics->stress_count > 1) {
        snprintf(node.name, sizeof node.name, "stress%zu", index + 1);
    }
    return node;
}

static bool is_linear(const dea_mobility *mobility)
{
    return !isnan(mobility->stiffness);
}

typedef struct writer {
    const dea_mobility *mobility;
    const dea_dynamics *dynamics;
    const dea_mobility_piece *piece;
    dea_expression_text text;
    FILE *out;
} writer;

/* The node onto which forces act: in the displacement form the balance of forces stands at the displacement itself. */
static const char *force_node(const writer *w)
{
    return w->mobility->displaced ? "disp" : "edge";
}

/* One `.param name=value`. */
static void parameter(FILE *out, const char *name, double value)
{
    fprintf(out, ".param %s=", name);
    dea_netlist_number(out, value);
    fputc('\n', out);
}

static void indexed(FILE *out, const char *name, size_t index, double value)
{
    char whole[32];
    snprintf(whole, sizeof whole, "%s%zu", name, index);
    parameter(out, whole, value);
}

static void write_springs(const writer *w)
{
    FILE *out = w->out;
    const dea_network *network = &w->mobility->network;
    for (int i = 0; i < network->element_count; i++) {
        fprintf(out, "* %s: %s\n", network->elements[i].name, network->elements[i].meaning);
    }
    if (is_linear(w->mobility)) {
        fputs("* compliance of all parallel springs [m/N]; its current is their force [N], its flux the displacement [m]\n", out);
        parameter(out, "n_spring", 1.0 / w->mobility->stiffness);
        parameter(out, "f_start", w->mobility->stiffness * w->piece->start.u);
        fputs("lspring edge 0 {n_spring} ic={f_start}\n", out);
        return;
    }
    if (!w->mobility->displaced) {
        fputs("* displacement [m], the integral of the edge velocity\n", out);
        parameter(out, "u_start", w->piece->start.u);
        fputs("gdisp 0 disp edge 0 1\ncdisp disp 0 1 ic={u_start}\n", out);
    }
    for (size_t a = 0; a < w->dynamics->stress_count; a++) {
        const dea_stress_node node = dea_mobility_stress_node(w->dynamics, a);
        fprintf(out, "* stress of the relaxed springs [Pa]\nb%s %s 0 v=", node.name, node.name);
        dea_expression_text_write(&w->text, w->mobility->stresses[a].stress);
        fputc('\n', out);
    }
    fprintf(out, "* their force [N]\nbspring %s 0 i=", force_node(w));
    for (size_t a = 0; a < w->dynamics->stress_count; a++) {
        fputs(a > 0 ? "+" : "", out);
        dea_expression_text_factor(&w->text, w->mobility->stresses[a].lever);
        fprintf(out, "*v(%s)", dea_mobility_stress_node(w->dynamics, a).name);
    }
    if (w->mobility->tense) {
        fputc('+', out);
        dea_expression_text_factor(&w->text, w->mobility->tension);
    }
    fputc('\n', out);
}

/* A branch of the Prony series beside a linear spring: a spring and a damper in series. */
static void write_linear_branches(const writer *w)
{
    const double k = w->mobility->stiffness;
    for (size_t i = 0; i < w->dynamics->branch_count; i++) {
        const dea_branch *branch = &w->dynamics->branches[i];
        const double stiffness = k * branch->share;
        const size_t n = i + 1;
        fprintf(w->out, "* branch %zu: compliance [m/N] in series with a mechanical resistance [N s/m], its inverse is written\n",
                n);
        indexed(w->out, "n_branch", n, 1.0 / stiffness);
        indexed(w->out, "r_branch", n, 1.0 / (stiffness * branch->tau));
        indexed(w->out, "f_branch", n, branch->share * (k * w->piece->start.u - w->piece->start.z[i]));
        fprintf(w->out, "lbranch%zu edge b%zu {n_branch%zu} ic={f_branch%zu}\nrbranch%zu b%zu 0 {r_branch%zu}\n", n, n, n, n, n,
                n, n);
    }
}

/* Quasi-linear branches: z follows its stress with its time constant, sum B_a c_i (S_a - z_ai) acts on the edge. */
static void write_stress_branches(const writer *w)
{
    const size_t count = w->dynamics->branch_count;
    for (size_t k = 0; k < dea_dynamics_states(w->dynamics); k++) {
        const dea_branch *branch = &w->dynamics->branches[k % count];
        const dea_stress_node stress = dea_mobility_stress_node(w->dynamics, k / count);
        const size_t n = k + 1;
        fprintf(w->out, "* branch %zu: relaxed stress [Pa] with its time constant [s] and share of the long-term stress [1]\n",
                n);
        indexed(w->out, "tau", n, branch->tau);
        indexed(w->out, "share", n, branch->share);
        indexed(w->out, "z_start", n, w->piece->start.z[k]);
        fprintf(w->out, "gbranch%zu 0 z%zu %s z%zu 1\ncbranch%zu z%zu 0 {tau%zu} ic={z_start%zu}\n", n, n, stress.name, n, n, n,
                n, n);
    }
    if (count > 0) {
        fprintf(w->out, "* force of the branches [N]\nbbranches %s 0 i=", force_node(w));
    }
    for (size_t k = 0; k < dea_dynamics_states(w->dynamics); k++) {
        if (k % count == 0) {
            fputs(k > 0 ? ")+" : "", w->out);
            dea_expression_text_factor(&w->text, w->mobility->stresses[k / count].lever);
        }
        fprintf(w->out, "%s{share%zu}*(v(%s)-v(z%zu))", k % count == 0 ? "*(" : "+", k + 1,
                dea_mobility_stress_node(w->dynamics, k / count).name, k + 1);
    }
    fputs(count > 0 ? ")\n" : "", w->out);
}

static void write_motion(const writer *w)
{
    FILE *out = w->out;
    if (w->piece->mass > 0.0) {
        fputs("* mass that moves with the edge [kg] and its velocity at the start [m/s]\n", out);
        parameter(out, "m_edge", w->piece->mass);
        parameter(out, "v_start", w->piece->start.v);
        fputs("cmass edge 0 {m_edge} ic={v_start}\n", out);
    }
    if (w->piece->conductance != 0.0) {
        fputs("* mechanical resistance [N s/m] that fits the damping of the time steps to that of the film; its inverse is "
              "written\n",
              out);
        parameter(out, "r_fit", 1.0 / w->piece->conductance);
        fputs("rfit edge 0 {r_fit}\n", out);
    }
    if (w->dynamics->retardation > 0.0 && is_linear(w->mobility)) {
        fputs("* kelvin-voigt damper, tau/n [N s/m]; its inverse is written\n", out);
        parameter(out, "r_damper", 1.0 / (w->dynamics->retardation * w->mobility->stiffness));
        fputs("rdamper edge 0 {r_damper}\n", out);
    } else if (w->dynamics->retardation > 0.0) {
        fputs("* kelvin-voigt damper, tau sum B dS/du times the velocity [N]\nbdamper edge 0 i=", out);
        dea_expression_text_factor(&w->text, w->mobility->resistance);
        fputs("*v(edge)\n", out);
    }
}

/* Corners of a segment up to its end. The library meets each, and from one to the next takes four steps at least, which it would
 * not shorten for an edge that is shorter than one: corners on its line do that. */
static void write_ramp(const writer *w, const dea_segment *segment)
{
    const dea_mobility_piece *p = w->piece;
    const double from = fmax(segment->from, p->from);
    const double end = fmin(segment->to, p->to);
    const bool brief = segment->start != segment->end && end - from < p->parts * p->step;
    const double parts = brief ? p->parts : 1.0;
    for (double part = 1.0; part <= parts; part++) {
        const double time = part == parts ? end : from + (end - from) * (part / parts);
        fputc(' ', w->out);
        dea_netlist_number(w->out, time - p->from);
        fputc(' ', w->out);
        dea_netlist_number(w->out, dea_segment_voltage(p->signal, segment, time));
    }
}

/* The voltage of the source from the begin of the piece on: its segments as breakpoints, or a sine. */
static void write_source(const writer *w, const char *node)
{
    const dea_mobility_piece *p = w->piece;
    const dea_segment *segment = &p->signal->segments[p->segment];
    fputs("* voltage of the source [V]\n", w->out);
    if (segment->sine) {
        const dea_curve_cards cards = {.out = w->out,
                                       .dialect = dea_dialect_at(0),
                                       .number = dea_netlist_number,
                                       .signal = p->signal,
                                       .first = p->segment,
                                       .count = 1,
                                       .begin = p->from,
                                       .node = node};
        dea_curve_cards_write(&cards);
        return;
    }
    fprintf(w->out, "vsource %s 0 ", node);
    fputs("pwl(0 ", w->out);
    dea_netlist_number(w->out, dea_segment_voltage(p->signal, segment, p->from));
    for (size_t i = p->segment; i < p->signal->count && p->signal->segments[i].from < p->to; i++) {
        write_ramp(w, &p->signal->segments[i]);
    }
    fputs(")\n", w->out);
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

/* The electrical side: the film's charge is the integral of its current, its voltage that charge over C(u). */
static void write_port(const writer *w)
{
    FILE *out = w->out;
    const double unit = w->dynamics->series > 0.0 ? port_unit(w) : 1.0;
    write_source(w, w->dynamics->series > 0.0 ? "source" : "film");
    if (w->dynamics->conductance > 0.0) {
        fprintf(out, "* leakage resistance of the film [Ohm], current in units of %.9g A\n", unit);
        parameter(out, "r_leak", unit / w->dynamics->conductance);
        fputs("rleak film 0 {r_leak}\n", out);
    }
    if (w->dynamics->series > 0.0) {
        fprintf(out, "* series resistance of source and electrodes [Ohm], current in units of %.9g A\n", unit);
        parameter(out, "r_series", unit * w->dynamics->series);
        fputs("rseries source film {r_series}\n", out);
        fputs("* film: its current into its capacitance at rest [F], whose charge over C(u) is its voltage\n", out);
        parameter(out, "c_rest", w->mobility->rest);
        parameter(out, "c_unit", w->mobility->rest / unit);
        parameter(out, "u_rest", w->piece->start.charge / w->mobility->rest);
        fputs("vfilm film plate 0\nfcharge 0 charge vfilm 1\nccharge charge 0 {c_unit} ic={u_rest}\n", out);
        fputs("bfilm plate 0 v=v(charge)*{c_rest}/(", out);
        dea_expression_text_write(&w->text, w->mobility->network.capacitance);
        fputs(")\n", out);
    }
    fprintf(out, "* electrostatic force phi U^2 = U^2/2 dC/du [N], Eq. 21, onto the edge\nbforce 0 %s i=", force_node(w));
    dea_expression_text_factor(&w->text, w->mobility->push);
    fputs("*v(film)*v(film)\n", out);
}

static double film_voltage(const writer *w)
{
    const dea_mobility_piece *p = w->piece;
    if (w->dynamics->series > 0.0) {
        const dea_pool *pool = &w->mobility->network.pool;
        dea_pool_values(pool, 0.0, p->start.u, w->text.rest);
        return p->start.charge / w->text.rest[w->mobility->network.capacitance];
    }
    return dea_segment_voltage(p->signal, &p->signal->segments[p->segment], p->from);
}

static void start_node(FILE *out, const char *node, double value)
{
    fprintf(out, " v(%s)=", node);
    dea_netlist_number(out, value);
}

/* Where Newton starts in the first step: every node at its value. */
static void write_start(writer *w)
{
    FILE *out = w->out;
    const dea_mobility_state *start = &w->piece->start;
    const double voltage = film_voltage(w);
    fputs(".ic", out);
    start_node(out, "film", voltage);
    if (w->dynamics->series > 0.0) {
        start_node(out, "plate", voltage);
        start_node(out, "charge", start->charge / w->mobility->rest);
    }
    if (!w->mobility->displaced) {
        start_node(out, "edge", start->v);
    }
    dea_expression_text_start(&w->text, 0.0, start->u);
    if (!is_linear(w->mobility)) {
        start_node(out, "disp", start->u);
        for (size_t a = 0; a < w->dynamics->stress_count; a++) {
            start_node(out, dea_mobility_stress_node(w->dynamics, a).name, w->text.rest[w->mobility->stresses[a].stress]);
        }
        for (size_t i = 0; i < dea_dynamics_states(w->dynamics); i++) {
            char name[24];
            snprintf(name, sizeof name, "z%zu", i + 1);
            start_node(out, name, start->z[i]);
        }
    }
    fputc('\n', out);
}

/* Pivots are the largest elements (pivrel=1): with smaller ones the velocity of a spring's end, the difference of two fluxes over
 * a step, is taken from the row that rounds it most, by 1e-16 u/h, which no tolerance of a velocity allows for.
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
    fputs(".options method=trap trtol=1e30 itl4=50 pivtol=1e-60 pivrel=1 reltol=", w->out);
    dea_netlist_number(w->out, p->tolerance);
    fputs(" vntol=", w->out);
    dea_netlist_number(w->out, p->loose * (1e-11 * fmin(speed, p->scale) + noise));
    fputs(" abstol=", w->out);
    dea_netlist_number(w->out, p->loose * current_tolerance(w));
    fputs(" chgtol=1e-30\n.save", w->out);
    for (size_t i = 1; i < vectors.count; i++) {
        const char *name = vectors.names[i];
        const char *mark = strchr(name, '#');
        if (mark) {
            fprintf(w->out, " i(%.*s)", (int)(mark - name), name);
        } else {
            fprintf(w->out, " v(%s)", name);
        }
    }
    fputs("\n.tran ", w->out);
    dea_netlist_number(w->out, p->mass > 0.0 ? 0.01 * p->step : p->step);
    fputc(' ', w->out);
    dea_netlist_number(w->out, p->to - p->from);
    fputs(" 0 ", w->out);
    dea_netlist_number(w->out, p->step);
    fputs(" uic\n.end\n", w->out);
}

/* Every expression that a card writes, as often as it does. */
static void declare(writer *w)
{
    const dea_mobility *m = w->mobility;
    dea_expression_text_use(&w->text, m->push);
    if (w->dynamics->series > 0.0) {
        dea_expression_text_use(&w->text, m->network.capacitance);
    }
    for (size_t a = 0; a < w->dynamics->stress_count && !is_linear(m); a++) {
        dea_expression_text_use(&w->text, m->stresses[a].lever);
        dea_expression_text_use(&w->text, m->stresses[a].stress);
        if (w->dynamics->branch_count > 0) {
            dea_expression_text_use(&w->text, m->stresses[a].lever);
        }
    }
    if (!is_linear(m) && m->tense) {
        dea_expression_text_use(&w->text, m->tension);
    }
    if (!is_linear(m) && w->dynamics->retardation > 0.0) {
        dea_expression_text_use(&w->text, m->resistance);
    }
    dea_expression_text_share(&w->text);
}

static void write_piece(writer *w)
{
    fputs(w->mobility->displaced
              ? "* moving dielectric elastomer actuator: v(disp) = displacement of the disc edge [m], current = force [N]\n"
              : "* moving dielectric elastomer actuator: v(edge) = velocity of the disc edge [m/s], current = force [N]\n",
          w->out);
    declare(w);
    dea_expression_text_parameters(&w->text);
    write_port(w);
    write_springs(w);
    if (is_linear(w->mobility)) {
        write_linear_branches(w);
    } else {
        write_stress_branches(w);
    }
    write_motion(w);
    dea_expression_text_nodes(&w->text);
    write_start(w);
    write_analysis(w);
}

/* Closes the stream; on DEA_OK its text belongs to the caller. */
static dea_status finish(FILE *out, bool ready, char **text, dea_error *error)
{
    const bool whole = dea_text_close(out);
    if (!ready || !whole) {
        free(*text);
        *text = NULL;
        return dea_fail(error, DEA_ERROR_MEMORY, "out of memory while a netlist is written");
    }
    return DEA_OK;
}

dea_status dea_mobility_write(const dea_mobility *mobility, const dea_mobility_piece *piece, char **text, dea_error *error)
{
    size_t length = 0;
    *text = NULL;
    writer w = {.mobility = mobility, .dynamics = mobility->dynamics, .piece = piece, .out = open_memstream(text, &length)};
    const char *node = is_linear(mobility) ? "({n_spring}*i(lspring))" : "v(disp)";
    const bool ready = w.out && dea_expression_text_open(&w.text, &mobility->network.pool, w.out, node);
    if (ready) {
        write_piece(&w);
    }
    dea_expression_text_close(&w.text);
    return finish(w.out, ready, text, error);
}

static void add_vector(dea_mobility_vectors *vectors, const char *format, size_t index)
{
    char *name = vectors->names[vectors->count++];
    const char *number = strchr(format, '%');
    snprintf(name, DEA_MOBILITY_NAME, "%.*s", (int)(number ? number - format : (ptrdiff_t)strlen(format)), format);
    if (number) {
        const size_t used = strlen(name);
        snprintf(name + used, DEA_MOBILITY_NAME - used, "%zu%s", index, number + 1);
    }
}

dea_mobility_vectors dea_mobility_vectors_of(const dea_mobility *mobility)
{
    const bool linear = is_linear(mobility);
    dea_mobility_vectors vectors = {.count = 0};
    add_vector(&vectors, "time", 0);
    add_vector(&vectors, linear ? "lspring#branch" : "disp", 0);
    if (!mobility->displaced) {
        add_vector(&vectors, "edge", 0);
    }
    for (size_t i = 1; i <= dea_dynamics_states(mobility->dynamics); i++) {
        add_vector(&vectors, linear ? "lbranch%#branch" : "z%", i);
    }
    if (mobility->dynamics->series > 0.0) {
        add_vector(&vectors, "charge", 0);
    }
    return vectors;
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

/* Transduction T = dF/dU = dq/du = 2 phi U: force from the film's voltage and current from the edge's velocity. */
static void write_transducer(FILE *out, const dea_dynamics *d, const dea_edge *e, const dea_mobility_bias *bias)
{
    fputs("* source of 1 V\n", out);
    fputs(d->series > 0.0 ? "vsource source 0 dc 0 ac 1\n" : "vsource film 0 dc 0 ac 1\n", out);
    if (d->series > 0.0) {
        fputs("* series resistance of source and electrodes [Ohm]\n", out);
        parameter(out, "r_series", d->series);
        fputs("rseries source film {r_series}\n", out);
    }
    if (d->conductance > 0.0) {
        fputs("* leakage resistance of the film [Ohm]\n", out);
        parameter(out, "r_leak", 1.0 / d->conductance);
        fputs("rleak film 0 {r_leak}\n", out);
    }
    fputs("* capacitance of the film at the bias [F]\n", out);
    parameter(out, "c_film", e->capacitance);
    fputs("cfilm film 0 {c_film}\n* transduction 2 phi U [N/V] = [A s/m]: force on the edge, current into the film\n", out);
    parameter(out, "transduction", 2.0 * e->push * bias->voltage);
    fputs("gforce 0 edge film 0 {transduction}\ngcurrent film 0 edge 0 {transduction}\n", out);
}

static void write_small_mechanics(FILE *out, dea_dynamics *d, const dea_edge *e, const dea_mobility_bias *bias)
{
    const double viscous = dea_edge_viscous(d, e);
    fputs("* compliance of the relaxed film at the bias, of film and voltage, inverted stiffness [m/N]; its flux is the "
          "displacement\n",
          out);
    parameter(out, "n_spring", 1.0 / dea_dynamics_stiffness(d, bias->u, bias->voltage, true));
    fputs("lspring edge 0 {n_spring}\n", out);
    for (size_t i = 0; i < d->branch_count; i++) {
        const double stiffness = viscous * d->branches[i].share;
        const size_t n = i + 1;
        fprintf(out, "* branch %zu: compliance [m/N] in series with a mechanical resistance [N s/m], its inverse is written\n",
                n);
        indexed(out, "n_branch", n, 1.0 / stiffness);
        indexed(out, "r_branch", n, 1.0 / (stiffness * d->branches[i].tau));
        fprintf(out, "lbranch%zu edge b%zu {n_branch%zu}\nrbranch%zu b%zu 0 {r_branch%zu}\n", n, n, n, n, n, n);
    }
    if (d->retardation > 0.0) {
        fputs("* kelvin-voigt damper [N s/m]; its inverse is written\n", out);
        parameter(out, "r_damper", 1.0 / (d->retardation * viscous));
        fputs("rdamper edge 0 {r_damper}\n", out);
    }
    if (d->mass > 0.0) {
        fputs("* mass that moves with the edge [kg]\n", out);
        parameter(out, "m_edge", d->mass);
        fputs("cmass edge 0 {m_edge}\n", out);
    }
}

dea_status dea_mobility_write_small(dea_dynamics *dynamics, const dea_mobility_bias *bias, const dea_mobility_band *band,
                                    char **text, dea_error *error)
{
    size_t length = 0;
    const dea_edge edge = dea_dynamics_edge(dynamics, bias->u);
    *text = NULL;
    FILE *out = open_memstream(text, &length);
    if (!out) {
        return finish(out, false, text, error);
    }
    fputs("* dielectric elastomer actuator about its bias: v(edge) = velocity [m/s], current = force [N]\n", out);
    write_transducer(out, dynamics, &edge, bias);
    write_small_mechanics(out, dynamics, &edge, bias);
    fprintf(out, ".options noopac pivtol=1e-60\n.save i(lspring) %s\n.ac ", dynamics->series > 0.0 ? "v(film)" : "i(vsource)");
    if (band->points_per_decade > 0) {
        fprintf(out, "dec %zu ", band->points_per_decade);
    } else {
        fprintf(out, "lin %zu ", band->count > 1 ? band->count : 1);
    }
    dea_netlist_number(out, band->from);
    fputc(' ', out);
    dea_netlist_number(out, band->to);
    fputs("\n.end\n", out);
    return finish(out, true, text, error);
}
