/* Transients and frequency responses. An element of the mechanics lies between the edge and the frame (mobility) or is the next
 * link of the loop m0, m1, ... 0 (impedance), so that one list of elements makes both networks. */
#include <math.h>
#include <stdlib.h>

#include "engine/ngspice/pieces.h"
#include "netlist/curve_cards.h"
#include "netlist/export.h"
#include "netlist/mobility.h"
#include "netlist/part_text.h"

enum { NODE_NAME = 16, LINE_POINTS = 4, MOST_CORNERS = 100000, MOST_PARTS = 400 };

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
    dea_part_text text;    /* owned */
    dea_mobility_state start;
    double step;  /* longest time step [s] */
    double quick; /* shortest time of the film: a radian of its ring, or its fastest relaxation [s] */
    int links;    /* of the loop so far */
    char ends[2][NODE_NAME];
} writer;

/* Nodes between which the next element of the mechanics lies. */
static void place(writer *w)
{
    if (w->analogy->loop) {
        snprintf(w->ends[0], NODE_NAME, "m%d", w->links);
        snprintf(w->ends[1], NODE_NAME, "m%d", ++w->links);
    } else {
        snprintf(w->ends[0], NODE_NAME, "edge");
        snprintf(w->ends[1], NODE_NAME, "0");
    }
}

/* A mechanical resistance [N s/m]. */
static void write_resistance(writer *w, const char *name, const char *from, const char *to, double value)
{
    fprintf(w->out, ".param r_%s=", name);
    dea_export_number(w->out, w->analogy->loop ? value : 1.0 / value);
    fprintf(w->out, "\nr%s %s %s {r_%s}\n", name, from, to, name);
}

/* A compliance or a mass with its state at the start; @p start NULL: none. */
static void write_store(writer *w, char letter, const char *name, const char *from, const char *to, const char *start)
{
    fprintf(w->out, "%c%s %s %s {%s}", letter, name, from, to, name);
    if (start) {
        fprintf(w->out, " ic={%s}", start);
    }
    fprintf(w->out, "%s\n", letter == 'l' ? w->export->dialect->inductor : "");
}

/* The spring, whose flux (mobility) or charge (impedance) is the displacement: v(disp) = n times its force. */
static void write_spring(writer *w, double compliance, const char *start)
{
    FILE *out = w->out;
    dea_export_parameter(out, "n_spring", compliance);
    place(w);
    if (w->analogy->loop) {
        write_store(w, w->analogy->spring, "n_spring", w->ends[0], w->ends[1], start);
        fprintf(out, "* displacement of the edge [m]\nedisp disp 0 %s %s {n_spring}\n", w->ends[0], w->ends[1]);
    } else {
        fputs("vspring edge spring 0\n", out);
        write_store(w, w->analogy->spring, "n_spring", "spring", "0", start);
        fputs("* displacement of the edge [m]\nhdisp disp 0 vspring {n_spring}\n", out);
    }
}

/* A branch of the Prony series: spring and damper feel the same force, so they lie in series, in the loop beside each other. */
static void write_branch(writer *w, size_t number, double stiffness, double tau, const double *force)
{
    char spring[NODE_NAME], damper[NODE_NAME], start[NODE_NAME], middle[NODE_NAME];
    snprintf(spring, sizeof spring, "n_branch%zu", number);
    snprintf(damper, sizeof damper, "branch%zu", number);
    snprintf(start, sizeof start, "f_branch%zu", number);
    snprintf(middle, sizeof middle, "b%zu", number);
    fprintf(w->out,
            "* branch %zu of the prony series: compliance n/c [m/N], c its share of the long-term stiffness, and mechanical "
            "resistance tau c/n [N s/m]%s\n",
            number, w->analogy->loop ? "" : ", its inverse is written");
    dea_export_parameter(w->out, spring, 1.0 / stiffness);
    if (force) {
        dea_export_parameter(w->out, start, *force);
    }
    place(w);
    const bool loop = w->analogy->loop;
    write_store(w, w->analogy->spring, spring, w->ends[0], loop ? w->ends[1] : middle, force ? start : NULL);
    write_resistance(w, damper, loop ? w->ends[0] : middle, w->ends[1], stiffness * tau);
}

static void write_damper(writer *w, double resistance)
{
    fprintf(w->out, "* kelvin-voigt damper, tau/n [N s/m]%s\n", w->analogy->loop ? "" : "; its inverse is written");
    place(w);
    write_resistance(w, "damper", w->ends[0], w->ends[1], resistance);
}

static void write_mass(writer *w, const double *velocity)
{
    if (w->dynamics.mass > 0.0) {
        fputs("* mass that moves with the edge [kg], Rayleigh with the shape of Lame's solution\n", w->out);
        dea_export_parameter(w->out, "m_edge", w->dynamics.mass);
        if (velocity) {
            dea_export_parameter(w->out, "v_start", *velocity);
        }
        place(w);
        write_store(w, w->analogy->mass, "m_edge", w->ends[0], w->ends[1], velocity ? "v_start" : NULL);
    }
}

/* Closes the loop over a source of 0 V, whose current is the velocity; v(edge) is then the velocity as in the other analogy. */
static void close_loop(writer *w)
{
    if (w->analogy->loop) {
        fprintf(w->out, "* velocity of the edge [m/s], the current of the loop\nvloop m%d 0 0\nhedge edge 0 vloop 1\n", w->links);
    }
}

/* Begins a behavioural source of a force: onto the edge, or against its motion. */
static void begin_force(writer *w, const char *name, bool onto)
{
    if (w->analogy->loop && onto) {
        dea_dialect_source_begin(w->dialect, w->out, DEA_VOLTAGE, name, "m0", "0");
        return;
    }
    place(w);
    const char *from = onto ? "0" : w->ends[0];
    const char *to = onto ? "edge" : w->ends[1];
    dea_dialect_source_begin(w->dialect, w->out, w->analogy->loop ? DEA_VOLTAGE : DEA_CURRENT, name, from, to);
}

static void end_source(writer *w)
{
    dea_dialect_source_end(w->dialect, w->out);
}

static void write_linear_springs(writer *w)
{
    const dea_dynamics *d = &w->dynamics;
    const double k = w->mobility.stiffness;
    fputs("* compliance of all parallel springs [m/N]; its force at the start [N]\n", w->out);
    dea_export_parameter(w->out, "f_start", k * w->start.u);
    write_spring(w, 1.0 / k, "f_start");
    for (size_t i = 0; i < d->branch_count; i++) {
        const double force = d->branches[i].share * (k * w->start.u - w->start.z[i]);
        write_branch(w, i + 1, k * d->branches[i].share, d->branches[i].tau, &force);
    }
    if (d->retardation > 0.0) {
        write_damper(w, d->retardation * k);
    }
}

/* The relaxed stresses of the branches follow the stress with their time constants. */
static void write_relaxations(const writer *w)
{
    const size_t count = w->dynamics.branch_count;
    for (size_t k = 0; k < dea_dynamics_states(&w->dynamics); k++) {
        const dea_branch *branch = &w->dynamics.branches[k % count];
        const dea_stress_node stress = dea_mobility_stress_node(&w->dynamics, k / count);
        const size_t n = k + 1;
        fprintf(w->out,
                "* branch %zu of the prony series: relaxed stress v(z%zu) [Pa], tau dz/dt = S - z; tau [s], share of the "
                "long-term stress [1]\n",
                n, n);
        fprintf(w->out, ".param tau%zu=", n);
        dea_export_number(w->out, branch->tau);
        fprintf(w->out, "\n.param share%zu=", n);
        dea_export_number(w->out, branch->share);
        fprintf(w->out, "\n.param z_start%zu=", n);
        dea_export_number(w->out, w->start.z[k]);
        fprintf(w->out, "\ngbranch%zu 0 z%zu %s z%zu 1\ncbranch%zu z%zu 0 {tau%zu} ic={z_start%zu}\n", n, n, stress.name, n, n, n,
                n, n);
    }
}

/* B_a [S_a + sum c_i (S_a - z_ai)]. */
static void write_stress_force(writer *w, size_t a)
{
    const dea_stress_node stress = dea_mobility_stress_node(&w->dynamics, a);
    dea_part_text_write(&w->text, w->mobility.stresses[a].lever);
    fprintf(w->out, "*(v(%s)", stress.name);
    for (size_t i = 0; i < w->dynamics.branch_count; i++) {
        const size_t n = a * w->dynamics.branch_count + i + 1;
        char name[NODE_NAME];
        snprintf(name, sizeof name, "share%zu", n);
        fputc('+', w->out);
        dea_dialect_parameter(w->dialect, w->out, name);
        fprintf(w->out, "*(v(%s)-v(z%zu))", stress.name, n);
    }
    fputc(')', w->out);
}

/* All of them and G against the motion. */
static void write_spring_force(writer *w)
{
    begin_force(w, "spring", false);
    for (size_t a = 0; a < w->dynamics.stress_count; a++) {
        fputs(a > 0 ? "+" : "", w->out);
        write_stress_force(w, a);
    }
    if (w->mobility.tense) {
        fputc('+', w->out);
        dea_part_text_write(&w->text, w->mobility.tension);
    }
    end_source(w);
}

static void write_hyperelastic_springs(writer *w)
{
    FILE *out = w->out;
    fputs("* displacement of the edge [m], the integral of its velocity\n", out);
    dea_export_parameter(out, "u_start", w->start.u);
    fputs("gdisp 0 disp edge 0 1\ncdisp disp 0 1 ic={u_start}\n", out);
    for (size_t a = 0; a < w->dynamics.stress_count; a++) {
        const dea_stress_node node = dea_mobility_stress_node(&w->dynamics, a);
        fputs("* stress S of the relaxed film [Pa], its change from rest\n", out);
        dea_dialect_source_begin(w->dialect, out, DEA_VOLTAGE, node.name, node.name, "0");
        dea_part_text_write(&w->text, w->mobility.stresses[a].stress);
        end_source(w);
    }
    write_relaxations(w);
    fputs("* force of the film [N], its stresses and those of its branches on their levers [m^2]\n", out);
    write_spring_force(w);
    if (w->dynamics.retardation > 0.0) {
        fputs("* kelvin-voigt damper, tau sum B dS/du times the velocity [N]\n", out);
        begin_force(w, "damper", false);
        dea_part_text_write(&w->text, w->mobility.resistance);
        fputs("*v(edge)", out);
        end_source(w);
    }
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
    dea_export_number(p->out, time);
    fputc(' ', p->out);
    dea_export_number(p->out, voltage);
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
                                   .number = dea_export_number,
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
        fprintf(w->out, "vsource %s 0 pwl(", node);
        write_corners(w);
    }
}

static void write_resistors(const writer *w)
{
    if (w->dynamics.conductance > 0.0) {
        fputs("* leakage resistance of the film [Ohm]\n", w->out);
        dea_export_parameter(w->out, "r_leak", 1.0 / w->dynamics.conductance);
        fputs("rleak film 0 {r_leak}\n", w->out);
    }
    if (w->dynamics.series > 0.0) {
        fputs("* series resistance of source and electrodes [Ohm]\n", w->out);
        dea_export_parameter(w->out, "r_series", w->dynamics.series);
        fputs("rseries source film {r_series}\n", w->out);
    }
}

/* Behind a resistance the charge is a state: the integral of the film's current, in units of the capacitance at rest. */
static void write_charge_state(writer *w)
{
    FILE *out = w->out;
    fputs("* film: its current into its capacitance at rest [F], whose charge over C(u) is its voltage, i = d(C U)/dt\n", out);
    dea_export_parameter(out, "c_rest", w->mobility.rest);
    dea_export_parameter(out, "q_start", w->start.charge / w->mobility.rest);
    fputs("vfilm film plate 0\nfcharge 0 charge vfilm 1\nccharge charge 0 {c_rest} ic={q_start}\n", out);
    dea_dialect_source_begin(w->dialect, out, DEA_VOLTAGE, "film", "plate", "0");
    fputs("v(charge)*", out);
    dea_dialect_parameter(w->dialect, out, "c_rest");
    fputs("/(", out);
    dea_part_text_write(&w->text, w->mobility.network.capacitance);
    fputc(')', out);
    end_source(w);
}

/* On the source alone the charge is C(u) U; its derivative is taken from the film's terminals. */
static void write_charge_follower(writer *w)
{
    FILE *out = w->out;
    const double charge = w->mobility.rest > 0.0 ? w->start.charge / w->mobility.rest : 0.0;
    fputs("* film: charge C(u) U on its capacitance at rest [F], whose current i = d(C U)/dt the film takes\n", out);
    dea_export_parameter(out, "c_rest", w->mobility.rest);
    dea_export_parameter(out, "q_start", charge);
    dea_dialect_source_begin(w->dialect, out, DEA_VOLTAGE, "charge", "drive", "0");
    fputs("v(film)*(", out);
    dea_part_text_write(&w->text, w->mobility.network.capacitance);
    fputs(")/", out);
    dea_dialect_parameter(w->dialect, out, "c_rest");
    end_source(w);
    fputs("vfilm drive charge 0\nccharge charge 0 {c_rest} ic={q_start}\nffilm film 0 vfilm 1\n", out);
}

static void write_force(writer *w)
{
    fputs("* electrostatic force f_dea = U^2/2 dC/du [N], Eq. 21, onto the edge\n", w->out);
    begin_force(w, "force", true);
    dea_part_text_write(&w->text, w->mobility.push);
    fputs("*v(film)*v(film)", w->out);
    end_source(w);
}

static void declare(writer *w)
{
    const dea_mobility *m = &w->mobility;
    dea_part_text_use(&w->text, m->push);
    dea_part_text_use(&w->text, m->network.capacitance);
    if (!w->dynamics.linear) {
        for (size_t a = 0; a < w->dynamics.stress_count; a++) {
            dea_part_text_use(&w->text, m->stresses[a].lever);
            dea_part_text_use(&w->text, m->stresses[a].stress);
        }
        if (w->mobility.tense) {
            dea_part_text_use(&w->text, m->tension);
        }
        if (w->dynamics.retardation > 0.0) {
            dea_part_text_use(&w->text, m->resistance);
        }
    }
}

/* Where Newton starts in the first step: nodes of zero would be divided by. */
static dea_status write_nodes(writer *w, dea_error *error)
{
    const dea_pool *pool = w->text.pool;
    double *rest = malloc(((size_t)pool->count + 1) * sizeof *rest);
    if (!rest) {
        return dea_fail(error, DEA_ERROR_MEMORY, "out of memory while a netlist is written");
    }
    fputs("* terms of u that several sources share, and all at the start\n", w->out);
    dea_part_text_nodes(&w->text);
    dea_pool_values(pool, 0.0, w->start.u, rest);
    fputs(".ic v(disp)=", w->out);
    dea_export_number(w->out, w->start.u);
    for (int i = 0; i < pool->count; i++) {
        if (w->text.written[i] && w->text.moves[i]) {
            fprintf(w->out, " v(x%d)=", i);
            dea_export_number(w->out, rest[i]);
        }
    }
    if (!w->dynamics.linear) {
        for (size_t a = 0; a < w->dynamics.stress_count; a++) {
            fprintf(w->out, " v(%s)=", dea_mobility_stress_node(&w->dynamics, a).name);
            dea_export_number(w->out, rest[w->mobility.stresses[a].stress]);
        }
    }
    fputc('\n', w->out);
    free(rest);
    return DEA_OK;
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
    const double voltage = w->analogy->loop ? least : fmin(velocity, 1e-11 * scale + 2e-12 * speed);
    const double current = w->analogy->loop ? 1e-11 * speed : 1e-10 * force;
    fprintf(w->out, "* tolerances of one time step\n%s reltol=1e-7 abstol=", w->dialect->solver);
    dea_export_number(w->out, current);
    fputs(" vntol=", w->out);
    dea_export_number(w->out, voltage);
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
    dea_export_number(w->out, transient->every);
    fputc(' ', w->out);
    dea_export_number(w->out, transient->until);
    fputs(" 0 ", w->out);
    dea_export_number(w->out, w->step);
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
        }
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
                 "tmax is %.3g s, %g steps; the accuracy %.3g of the scene needs %.3g s: expect an error of some %.2g", w->step,
                 most_steps, w->export->scene->accuracy, wanted,
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
    const bool follows = !(d->mass > 0.0) && !(d->retardation > 0.0) && d->series == 0.0;
    bool there = true;
    double voltage = 0.0;
    w->start = (dea_mobility_state){0};
    if (w->export->scene->transient.from_bias) {
        voltage = source / (1.0 + d->series * d->conductance);
        there = dea_dynamics_equilibrium(d, voltage, &w->start.u);
        const dea_edge e = dea_dynamics_edge(d, w->start.u);
        dea_edge_relax(d, &e, w->start.z);
    } else if (follows) {
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
    dea_status status = set_start(w, error);
    if (status != DEA_OK) {
        return status;
    }
    dea_export_head(w->export, w->analogy->meaning);
    if (w->export->note[0]) {
        dea_dialect_comment(w->out, w->export->note);
    }
    declare(w);
    fputs("* numbers of the expressions below\n", w->out);
    dea_part_text_parameters(&w->text);
    status = write_nodes(w, error); /* the sources below refer to them */
    write_source(w);
    write_resistors(w);
    if (w->dynamics.series > 0.0) {
        write_charge_state(w);
    } else {
        write_charge_follower(w);
    }
    write_force(w);
    for (int i = 0; i < w->mobility.network.element_count; i++) {
        fprintf(w->out, "* %s: %s\n", w->mobility.network.elements[i].name, w->mobility.network.elements[i].meaning);
    }
    if (w->dynamics.linear) {
        write_linear_springs(w);
    } else {
        write_hyperelastic_springs(w);
    }
    write_mass(w, &w->start.v);
    close_loop(w);
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
    dea_status status = dea_dynamics_open(export->scene, export->scene->models[0], &w.dynamics, error);
    if (status == DEA_OK) {
        status = dea_mobility_open(export->scene, &w.dynamics, &w.mobility, error);
    }
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
    if (status == DEA_OK && !dea_part_text_open(&w.text, &w.mobility.network.pool, w.dialect, w.out)) {
        status = dea_fail(error, DEA_ERROR_MEMORY, "out of memory while a netlist is written");
    }
    if (status == DEA_OK) {
        w.text.node = "v(disp)";
        dea_export_share(&w.text);
        status = write_transient(&w, error);
    }
    dea_part_text_close(&w.text);
    dea_signal_close(&w.signal);
    dea_mobility_close(&w.mobility);
    dea_dynamics_close(&w.dynamics);
    return status;
}

/* Transduction T = dF/dU = dq/du = 2 phi U: force from the film's voltage, current from the edge's velocity. */
static void write_transducer(writer *w, const dea_edge *edge, double voltage)
{
    FILE *out = w->out;
    fputs(w->dynamics.series > 0.0 ? "* source of 1 V\nvsource source 0 dc 0 ac 1\n"
                                   : "* source of 1 V\nvsource film 0 dc 0 ac 1\n",
          out);
    write_resistors(w);
    fputs("* capacitance of the film at the bias [F]\n", out);
    dea_export_parameter(out, "c_film", edge->capacitance);
    fputs("cfilm film 0 {c_film}\n* transduction dF/dU = dC/du U [N/V] = [A s/m], Eq. 21: force onto the edge, current into the "
          "film\n",
          out);
    dea_export_parameter(out, "transduction", 2.0 * edge->push * voltage);
    fputs(w->analogy->loop ? "eforce m0 0 film 0 {transduction}\nfcurrent film 0 vloop {transduction}\n"
                           : "gforce 0 edge film 0 {transduction}\ngcurrent film 0 edge 0 {transduction}\n",
          out);
}

static void write_small_mechanics(writer *w, const dea_edge *edge, double u, double voltage)
{
    dea_dynamics *d = &w->dynamics;
    const double viscous = dea_edge_viscous(d, edge);
    fputs("* compliance of the relaxed film at the bias, of film and voltage, inverted stiffness [m/N]\n", w->out);
    write_spring(w, 1.0 / dea_dynamics_stiffness(d, u, voltage, true), NULL);
    for (size_t i = 0; i < d->branch_count; i++) {
        write_branch(w, i + 1, viscous * d->branches[i].share, d->branches[i].tau, NULL);
    }
    if (d->retardation > 0.0) {
        write_damper(w, d->retardation * viscous);
    }
    write_mass(w, NULL);
    close_loop(w);
}

/* One card for the grid of the scene; its last frequency need not lie on it and has a card of its own in ngspice. */
static void write_band(const writer *w)
{
    const dea_scene *scene = w->export->scene;
    const size_t last = dea_layout_of(scene).rows - 1;
    fputs("* results: displacement v(disp) [m] and velocity v(edge) [m/s] per volt, input admittance -v(current) [S]\n"
          "hcurrent current 0 vsource 1\n"
          ".print ac vm(disp) vp(disp) vm(edge) vp(edge) vm(current) vp(current)\n",
          w->out);
    fputs(w->export->dialect->ac, w->out);
    if (last > 0) {
        fprintf(w->out, ".ac dec %zu ", scene->ac.points_per_decade);
        dea_export_number(w->out, scene->ac.from);
        fputc(' ', w->out);
        dea_export_number(w->out, dea_layout_place(scene, last));
        fputc('\n', w->out);
    } else {
        fputs(".ac lin 1 ", w->out);
        dea_export_number(w->out, scene->ac.from);
        fputc(' ', w->out);
        dea_export_number(w->out, scene->ac.from);
        fputc('\n', w->out);
    }
    fputs(".end\n", w->out);
}

dea_status dea_export_ac(dea_export *export, dea_error *error)
{
    writer w = writer_of(export);
    double u = 0.0;
    char meaning[256];
    dea_status status = dea_dynamics_open(export->scene, export->scene->models[0], &w.dynamics, error);
    const double voltage = export->scene->ac.bias / (1.0 + w.dynamics.series * w.dynamics.conductance);
    if (status == DEA_OK &&
        (!dea_dynamics_equilibrium(&w.dynamics, voltage, &u) || !(dea_dynamics_stiffness(&w.dynamics, u, voltage, true) > 0.0))) {
        status =
            dea_fail(error, DEA_ERROR_UNSUPPORTED, "the film has no equilibrium under its bias, %g V", export->scene->ac.bias);
    }
    if (status == DEA_OK) {
        const dea_edge edge = dea_dynamics_edge(&w.dynamics, u);
        snprintf(meaning, sizeof meaning, "small signals about %.9g V and %.9g m; %s", voltage, u, w.analogy->meaning);
        dea_export_head(export, meaning);
        write_transducer(&w, &edge, voltage);
        write_small_mechanics(&w, &edge, u, voltage);
        write_band(&w);
    }
    dea_dynamics_close(&w.dynamics);
    return status;
}
