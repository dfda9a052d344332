/* Decks of transients and frequency responses that a user runs: source, what is read off, steps. */
#include <math.h>
#include <stdlib.h>

#include "engine/ngspice/pieces.h"
#include "netlist/curve_cards.h"
#include "netlist/export.h"

enum { LINE_POINTS = 4, MOST_CORNERS = 100000, MOST_PARTS = 400 };

/* Most time steps of one file, and the shortest edge in them: shorter ones fall together with their neighbour. */
static const double most_steps = 2e6;
static const double shortest_edge = 2e-4;

typedef struct writer {
    dea_export *export;
    FILE *out;
    const dea_dialect *dialect;
    const dea_analogy *analogy;
    dea_dynamics dynamics; /* owned */
    dea_mobility mobility; /* owned */
    dea_signal signal;     /* owned */
    dea_cards cards;       /* owned */
    dea_mobility_state start;
    double step;  /* longest time step [s] */
    bool rings;   /* the step is that of a ring */
    double quick; /* shortest time of the film: a radian of its ring, or its fastest relaxation [s] */
} writer;

static void end_source(const writer *w)
{
    dea_dialect_source_end(w->dialect, w->out);
}

/* A corner of the source's voltage. */
typedef struct pen {
    FILE *out;
    size_t count;
    double last; /* time of the last corner [s] */
    double voltage;
} pen;

static void corner(pen *p, double time, double voltage)
{
    fputs(p->count % LINE_POINTS == 0 ? "\n+ " : " ", p->out);
    dea_part_number(p->out, time);
    fputc(' ', p->out);
    dea_part_number(p->out, voltage);
    p->count++;
    p->last = time;
    p->voltage = voltage;
}

/* Parts of an edge of the length w. The film answers to the square of the voltage, so that an edge that is shorter than its times
 * wants steps far below tmax: behind a corner they begin anew at a tenth. The two bounds are those of the trapezoidal rule, whose
 * error is some w/(60 n^2) of the edge, and of the Euler rule at each corner. */
static size_t parts_of(const writer *w, double length)
{
    const double share = length / (w->quick * w->export->scene->accuracy);
    if (!(length < 0.1 * w->quick)) {
        return 1; /* long enough for steps of tmax, and better without corners */
    }
    const double most = fmin(MOST_PARTS, MOST_CORNERS / (double)w->signal.count);
    return (size_t)fmax(1.0, fmin(most, ceil(fmax(sqrt(0.3 * share), share / 400.0))));
}

static void edge(const writer *w, pen *p, double to, double voltage)
{
    const double from = p->last;
    const double start = p->voltage;
    const size_t parts = voltage != start ? parts_of(w, to - from) : 1;
    for (size_t i = 1; i <= parts; i++) {
        const double x = (double)i / (double)parts;
        corner(p, i == parts ? to : from + x * (to - from), i == parts ? voltage : start + x * (voltage - start));
    }
}

/* Jumps become edges; an edge that is too short for the simulator's steps is made longer. */
static void write_corners(const writer *w)
{
    pen p = {.out = w->out};
    const double shortest = shortest_edge * w->step;
    for (size_t i = 0; i < w->signal.count; i++) {
        const dea_segment *s = &w->signal.segments[i];
        if (i == 0) {
            corner(&p, s->from, s->start);
        } else if (s->start != s[-1].end) {
            corner(&p, fmax(s->from, p.last) + shortest, s->start);
        }
        if (s->to > p.last + 0.5 * shortest || i + 1 == w->signal.count) {
            edge(w, &p, fmax(s->to, p.last + shortest), s->end);
        }
    }
    fputs(")\n", w->out);
}

static void write_curves(const writer *w, const char *node)
{
    const dea_curve_cards cards = {.out = w->out,
                                   .dialect = w->dialect,
                                   .number = dea_part_number,
                                   .signal = &w->signal,
                                   .count = w->signal.count,
                                   .node = node};
    dea_curve_cards_write(&cards);
}

static void write_source(const writer *w)
{
    const char *node = w->dynamics.series > 0.0 ? "source" : "film";
    fputs("* voltage of the source [V]; i(vsource) = its current [A], counted into the source\n", w->out);
    if (dea_signal_curves(&w->signal)) {
        write_curves(w, node);
    } else {
        fprintf(w->out, "VSOURCE %s 0 pwl(", node);
        write_corners(w);
    }
}

/* The displacement of a linear film in the mobility analogy: n times the force of its spring. */
static void write_displacement(const writer *w)
{
    if (!isnan(w->mobility.stiffness) && !w->analogy->loop) {
        fputs("* displacement of the edge [m]\n", w->out);
        dea_dialect_source_begin(w->dialect, w->out, DEA_VOLTAGE, "DISP", "disp", "0");
        fputs(w->cards.node, w->out);
        end_source(w);
    }
}

/* Velocity of a film whose displacement follows its voltage: the current of a capacitor of 1 on a copy of it. */
static void write_velocity(const writer *w)
{
    if (w->mobility.displaced) {
        fputs("* velocity of the edge [m/s], the current of a capacitor of 1 under its displacement\n"
              "ECOPY copy 0 disp 0 1\nCRATE copy rate 1 ic={u_follow}\nVRATE rate 0 0\nHEDGE edge 0 VRATE 1\n",
              w->out);
        dea_part_value(w->out, "u_follow", w->start.u);
    }
}

/* On the source alone the charge is C(u) U; its derivative is taken from the film's terminals. */
static void write_charge(const writer *w)
{
    if (w->dynamics.series > 0.0) {
        return;
    }
    FILE *out = w->out;
    const double charge = w->start.charge / w->mobility.rest;
    fputs("* film: charge C(u) U on its capacitance at rest [F], whose current i = d(C U)/dt the film takes\n", out);
    dea_part_value(out, "c_rest", w->mobility.rest);
    dea_part_value(out, "q_start", charge);
    dea_dialect_source_begin(w->dialect, out, DEA_VOLTAGE, "CHARGE", "drive", "0");
    fputs("v(film)*(", out);
    dea_part_text_write(&w->cards.text, w->mobility.network.capacitance);
    fputs(")/", out);
    dea_dialect_parameter(w->dialect, out, "c_rest");
    end_source(w);
    fputs("VFILM drive charge 0\nCCHARGE charge 0 {c_rest} ic={q_start}\nFFILM film 0 VFILM 1\n", out);
}

/* Tolerances of Newton from the sizes of displacement, velocity and force. */
static void write_tolerances(writer *w)
{
    if (!w->dialect->solver) {
        return;
    }
    dea_dynamics *d = &w->dynamics;
    const double scale = dea_dynamics_scale(d, w->signal.largest);
    const double force = scale * fabs(dea_dynamics_stiffness(d, 0.0, 0.0, false));
    const double speed = scale / w->step;
    const double velocity = 1e-11 * fmin(speed, scale) + 2e-12 * speed;
    const double least = fmin(1e-11 * scale, 1e-11 * force);
    const double free = 1e-7 * scale; /* the velocity is a difference of displacements over a step: it hears what they are open by */
    const double held = w->analogy->loop ? least : fmin(velocity, 1e-11 * scale + 2e-12 * speed);
    const double voltage = w->mobility.displaced ? free : held;
    const double current = w->analogy->loop ? 1e-11 * speed : 1e-10 * force;
    fprintf(w->out, "* tolerances of one time step\n%s reltol=1e-7 abstol=", w->dialect->solver);
    dea_part_number(w->out, current);
    fputs(" vntol=", w->out);
    dea_part_number(w->out, voltage);
    fputc('\n', w->out);
}

static void write_analysis(writer *w)
{
    const dea_transient *transient = &w->export->scene->transient;
    write_tolerances(w);
    fputs(w->dialect->transient, w->out);
    fputs(
        "* results: displacement v(disp) [m], velocity v(edge) [m/s], film voltage v(film) [V], source current -i(vsource) [A]\n"
        ".print tran v(disp) v(edge) v(film) i(vsource)\n",
        w->out);
    if (w->export->dialect->save) {
        fprintf(w->out, "%s v(disp) v(edge) v(film) i(vsource)\n", w->export->dialect->save);
    }
    fputs("* .tran print interval, end, begin of the output, tmax [s]. tmax sets the accuracy: a tenth of it makes the error a "
          "hundredth\n.tran ",
          w->out);
    dea_part_number(w->out, transient->logarithmic ? transient->until / 1000.0 : transient->every);
    fputc(' ', w->out);
    dea_part_number(w->out, transient->until);
    fputs(" 0 ", w->out);
    dea_part_number(w->out, w->step);
    fputs(" uic\n.end\n", w->out);
}

/* The error of the trapezoidal rule is (w h)^2/12 a radian of a ring, and (h/tau)^2/12 of what relaxes; the step of the Euler
 * rule behind every edge adds some (w h)^2/2. Hence 1 in the place of 12. */
static double step_wanted(writer *w)
{
    const dea_scene *scene = w->export->scene;
    dea_dynamics *d = &w->dynamics;
    const double until = scene->transient.until;
    const double share = sqrt(scene->accuracy);
    double u = 0.0;
    double step = fmin(until / 100.0, scene->transient.every);
    const bool there = dea_dynamics_equilibrium(d, w->signal.largest, &u);
    w->quick = INFINITY;
    for (int at = 0; at <= (int)there; at++) {
        const dea_pace pace = dea_pace_of(d, at ? u : 0.0, at ? w->signal.largest : 0.0);
        if (pace.omega > 0.0) {
            const double life = fmin(until, pace.decay > 0.0 ? 1.0 / (2.718281828 * pace.decay) : INFINITY);
            step = fmin(step, share / pace.omega / sqrt(1.0 + pace.omega * life));
            w->rings = true;
        }
        w->rings = w->rings && step <= share * pace.fastest;
        step = fmin(step, share * pace.fastest);
        w->quick = fmin(w->quick, pace.omega > 0.0 ? fmin(pace.fastest, 1.0 / pace.omega) : pace.fastest);
    }
    for (size_t i = 0; i < w->signal.count; i++) {
        const double turn = dea_segment_turn(&w->signal, &w->signal.segments[i]);
        step = turn > 0.0 ? fmin(step, 0.5 * share / turn) : step;
    }
    return step;
}

static void choose_step(writer *w)
{
    const double wanted = step_wanted(w);
    const double least = w->export->scene->transient.until / most_steps;
    w->step = fmax(wanted, least);
    if (wanted < least) {
        snprintf(w->export->note, sizeof w->export->note,
                 "a netlist has one tmax, where the engine ngspice cuts the run into pieces, each of its own step: tmax is %.3g s, %g "
                 "steps; the accuracy %.3g of the scene needs %.3g s while %s: expect an error of some %.2g, or shorten the run",
                 w->step, most_steps, w->export->scene->accuracy, wanted, w->rings ? "the film rings" : "the film relaxes",
                 fmin(1.0, w->export->scene->accuracy * (w->step / wanted) * (w->step / wanted)));
    }
}

static void warn_of_pull_in(writer *w)
{
    double u;
    if (!w->export->note[0] && !dea_dynamics_equilibrium(&w->dynamics, w->signal.largest, &u)) {
        snprintf(w->export->note, sizeof w->export->note,
                 "the film has no equilibrium under %g V (pull-in): a simulator may end there with too small a time step",
                 w->signal.largest);
    }
}

/* Relaxed under the first voltage, or at rest; a film that follows its voltage begins where that wants it. */
static dea_status set_start(writer *w, dea_error *error)
{
    dea_dynamics *d = &w->dynamics;
    const double source = w->signal.segments[0].start;
    const bool follows = dea_dynamics_is_free(d) && d->series == 0.0;
    double voltage;
    w->start = (dea_mobility_state){0};
    bool there = dea_dynamics_begin(d, d->biased, source, &w->start.u, &voltage);
    if (there) {
        const dea_edge e = dea_dynamics_edge(d, w->start.u);
        dea_edge_relax(d, &e, w->start.z);
    }
    if (there && follows && !d->biased) {
        there = dea_dynamics_follow(d, source, w->start.z, &w->start.u);
    }
    if (!there) {
        return dea_fail(error, DEA_ERROR_UNSUPPORTED, "the film has no equilibrium under its first voltage, %g V", source);
    }
    voltage = d->series > 0.0 ? voltage : source;
    w->start.charge = dea_dynamics_edge(d, w->start.u).capacitance * voltage;
    return DEA_OK;
}

static dea_status write_transient(writer *w, dea_error *error)
{
    choose_step(w);
    warn_of_pull_in(w);
    const dea_status status = set_start(w, error);
    if (status != DEA_OK) {
        return status;
    }
    const dea_cards_numbers numbers = {w->start, w->dynamics.mass, 1.0};
    dea_cards_declare(&w->cards);
    if (w->dynamics.series == 0.0) { /* for write_charge() */
        dea_part_text_root(&w->cards.text, "capacity");
        dea_part_text_use_aside(&w->cards.text, w->mobility.network.capacitance);
    }
    if (w->cards.text.exhausted) {
        return dea_fail(error, DEA_ERROR_MEMORY, "out of memory while a netlist is written");
    }
    dea_export_head(w->export, w->analogy->meaning);
    if (w->export->note[0]) {
        dea_dialect_comment(w->out, w->export->note);
    }
    dea_cards_write_numbers(&w->cards, &numbers);
    dea_cards_write_network(&w->cards);
    write_source(w);
    write_charge(w);
    write_displacement(w);
    write_velocity(w);
    fputs("* where the first step starts\n.ic", w->out);
    dea_cards_write_start(&w->cards, &numbers, w->signal.segments[0].start);
    fputc('\n', w->out);
    write_analysis(w);
    return status;
}

static writer writer_of(dea_export *export)
{
    return (writer){.export = export, .out = export->out, .dialect = export->dialect, .analogy = export->analogy};
}

dea_status dea_export_transient(dea_export *export, dea_error *error)
{
    writer w = writer_of(export);
    const dea_cards_form form = {.dialect = export->dialect, .analogy = export->analogy};
    dea_status status =
        dea_mobility_prepare(export->scene, export->scene->models[0], export->analogy, &w.dynamics, &w.mobility, error);
    if (status == DEA_OK) {
        status = dea_signal_open(export->scene, &w.signal, error);
    }
    if (status == DEA_OK && !dea_curve_cards_fit(&w.signal)) {
        status = dea_fail(error, DEA_ERROR_UNSUPPORTED, "the burst repeats too often for a netlist, which takes at most %d; export a shorter run",
                          DEA_CURVE_CARDS_MAX);
    }
    if (status == DEA_OK && w.signal.count > MOST_CORNERS) {
        status = dea_fail(error, DEA_ERROR_UNSUPPORTED, "the waveform has %zu edges, a netlist holds %d", w.signal.count,
                          MOST_CORNERS);
    }
    if (status == DEA_OK && !dea_cards_open(&w.mobility, &form, w.out, &w.cards)) {
        status = dea_fail(error, DEA_ERROR_MEMORY, "out of memory while a netlist is written");
    }
    if (status == DEA_OK) {
        status = write_transient(&w, error);
    }
    dea_cards_close(&w.cards);
    dea_signal_close(&w.signal);
    dea_mobility_close(&w.mobility);
    dea_dynamics_close(&w.dynamics);
    return status;
}

/* One card for the grid of the scene; its last frequency need not lie on it and has a card of its own in ngspice. */
static void write_band(const writer *w)
{
    const dea_scene *scene = w->export->scene;
    const size_t last = dea_layout_of(scene).rows - 1;
    fputs("* results: displacement v(disp) [m] and velocity v(edge) [m/s] per volt, input admittance -v(current) [S]\n"
          "HCURRENT current 0 VSOURCE 1\n"
          ".print ac vm(disp) vp(disp) vm(edge) vp(edge) vm(current) vp(current)\n",
          w->out);
    fputs(w->export->dialect->ac, w->out);
    if (last > 0) {
        fprintf(w->out, ".ac dec %zu ", scene->ac.points_per_decade);
        dea_part_number(w->out, scene->ac.from);
        fputc(' ', w->out);
        dea_part_number(w->out, dea_layout_place(scene, last));
        fputc('\n', w->out);
    } else {
        fputs(".ac lin 1 ", w->out);
        dea_part_number(w->out, scene->ac.from);
        fputc(' ', w->out);
        dea_part_number(w->out, scene->ac.from);
        fputc('\n', w->out);
    }
    fputs(".end\n", w->out);
}

dea_status dea_export_ac(dea_export *export, dea_error *error)
{
    if (export->scene->models[0]->membrane) {
        return dea_export_ac_rings(export, error);
    }
    writer w = writer_of(export);
    const dea_cards_form form = {.dialect = export->dialect, .analogy = export->analogy};
    char meaning[256];
    dea_status status = dea_dynamics_open(export->scene, export->scene->models[0], &w.dynamics, error);
    dea_mobility_bias bias = {.voltage = export->scene->ac.bias / (1.0 + w.dynamics.series * w.dynamics.conductance)};
    if (status == DEA_OK && (!dea_dynamics_equilibrium(&w.dynamics, bias.voltage, &bias.u) ||
                             !(dea_dynamics_stiffness(&w.dynamics, bias.u, bias.voltage, true) > 0.0))) {
        status =
            dea_fail(error, DEA_ERROR_UNSUPPORTED, "the film has no equilibrium under its bias, %g V", export->scene->ac.bias);
    }
    if (status == DEA_OK) {
        snprintf(meaning, sizeof meaning, "small signals about %.9g V and %.9g m; %s", bias.voltage, bias.u, w.analogy->meaning);
        dea_export_head(export, meaning);
        dea_cards_write_small(&w.dynamics, &bias, &form, w.out);
        fprintf(w.out, "* source of 1 V\nVSOURCE %s 0 dc 0 ac 1\n", w.dynamics.series > 0.0 ? "source" : "film");
        write_band(&w);
    }
    dea_dynamics_close(&w.dynamics);
    return status;
}
