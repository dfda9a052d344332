/* The part of a transient's deck that asks for no film: the voltage of its source, its steps, what is read off. */
#include "netlist/export_drive.h"

#include <math.h>

#include "netlist/curve_cards.h"

enum { LINE_POINTS = 4, MOST_CORNERS = 100000, MOST_PARTS = 400 };

/* Most time steps of one file, and the shortest edge in them: shorter ones fall together with their neighbour. */
static const double most_steps = 2e6;
static const double shortest_edge = 2e-4;

dea_status dea_export_drive_open(dea_export *export, dea_export_drive *w, dea_error *error)
{
    *w = (dea_export_drive){.export = export, .out = export->out, .dialect = export->dialect, .quick = INFINITY};
    const dea_status status = dea_signal_open(export->scene, &w->signal, error);
    if (status == DEA_OK && !dea_curve_cards_fit(&w->signal)) {
        return dea_fail(error, DEA_ERROR_UNSUPPORTED, "the burst repeats too often for a netlist, which takes at most %d; export a shorter run",
                        DEA_CURVE_CARDS_MAX);
    }
    if (status == DEA_OK && w->signal.count > MOST_CORNERS) {
        return dea_fail(error, DEA_ERROR_UNSUPPORTED, "the waveform has %zu edges, a netlist holds %d", w->signal.count, MOST_CORNERS);
    }
    return status;
}

void dea_export_drive_close(dea_export_drive *w)
{
    dea_signal_close(&w->signal);
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
    dea_part_print(p->out, "%g %g", time, voltage);
    p->count++;
    p->last = time;
    p->voltage = voltage;
}

/* Parts of an edge of the length w. The film answers to the square of the voltage, so that an edge that is shorter than its times
 * wants steps far below tmax: behind a corner they begin anew at a tenth. The two bounds are those of the trapezoidal rule, whose
 * error is some w/(60 n^2) of the edge, and of the Euler rule at each corner. */
static size_t parts_of(const dea_export_drive *w, double length)
{
    const double share = length / (w->quick * w->export->scene->accuracy);
    if (!(length < 0.1 * w->quick)) {
        return 1; /* long enough for steps of tmax, and better without corners */
    }
    const double most = fmin(MOST_PARTS, MOST_CORNERS / (double)w->signal.count);
    return (size_t)fmax(1.0, fmin(most, ceil(fmax(sqrt(0.3 * share), share / 400.0))));
}

static void edge(const dea_export_drive *w, pen *p, double to, double voltage)
{
    const double from = p->last;
    const double start = p->voltage;
    const size_t parts = voltage != start ? parts_of(w, to - from) : 1;
    for (size_t i = 1; i <= parts; i++) {
        const double x = (double)i / (double)parts;
        corner(p, i == parts ? to : from + x * (to - from), i == parts ? voltage : start + x * (voltage - start));
    }
}

/* Jumps become edges; an edge that is too short for the simulator's steps is made longer, or left out, and its jump made behind it. */
static void write_corners(const dea_export_drive *w)
{
    pen p = {.out = w->out};
    const double shortest = shortest_edge * w->step;
    for (size_t i = 0; i < w->signal.count; i++) {
        const dea_segment *s = &w->signal.segments[i];
        if (i == 0) {
            corner(&p, s->from, s->start);
        } else if (s->start != p.voltage) {
            corner(&p, fmax(s->from, p.last) + shortest, s->start);
        }
        if (s->to > p.last + 0.5 * shortest || i + 1 == w->signal.count) {
            edge(w, &p, fmax(s->to, p.last + shortest), s->end);
        }
    }
    fputs(")\n", w->out);
}

static void write_curves(const dea_export_drive *w, const char *node)
{
    const dea_curve_cards cards = {.out = w->out,
                                   .dialect = w->dialect,
                                   .signal = &w->signal,
                                   .count = w->signal.count,
                                   .node = node};
    dea_curve_cards_write(&cards);
}

void dea_export_drive_source(const dea_export_drive *w, const char *node)
{
    fputs("* voltage of the source [V]; i(vsource) = its current [A], counted into the source\n", w->out);
    if (dea_signal_curves(&w->signal)) {
        write_curves(w, node);
    } else {
        fprintf(w->out, "VSOURCE %s 0 pwl(", node);
        write_corners(w);
    }
}

/* How much longer a step may be where the load grows over many times of what answers to it: so much less is that excited. */
static double eased(const dea_export_drive *w, double time)
{
    return sqrt(fmax(1.0, w->evenly / time));
}

/* The error of the trapezoidal rule is (w h)^2/12 a radian of a ring, and (h/tau)^2/12 of what relaxes; the step of the Euler
 * rule behind every edge adds some (w h)^2/2. Hence 1 in the place of 12. */
static double step_wanted(dea_export_drive *w, const dea_pace *paces, size_t count)
{
    const dea_scene *scene = w->export->scene;
    const double until = scene->transient.until;
    const double share = sqrt(scene->accuracy);
    double step = fmin(until / 100.0, scene->transient.every);
    for (size_t i = 0; i < count; i++) {
        const dea_pace *pace = &paces[i];
        if (pace->omega > 0.0) {
            const double life = fmin(until, pace->decay > 0.0 ? 1.0 / (2.718281828 * pace->decay) : INFINITY);
            step = fmin(step, eased(w, 1.0 / pace->omega) * share / pace->omega / sqrt(1.0 + pace->omega * life));
            w->rings = true;
        }
        const double relaxes = eased(w, pace->fastest) * share * pace->fastest;
        w->rings = w->rings && step <= relaxes;
        step = fmin(step, relaxes);
        w->quick = fmin(w->quick, pace->omega > 0.0 ? fmin(pace->fastest, 1.0 / pace->omega) : pace->fastest);
    }
    for (size_t i = 0; i < w->signal.count; i++) {
        const double turn = dea_segment_turn(&w->signal, &w->signal.segments[i]);
        step = turn > 0.0 ? fmin(step, 0.5 * share / turn) : step;
    }
    return step;
}

void dea_export_drive_steps(dea_export_drive *w, const dea_pace *paces, size_t count)
{
    const double wanted = step_wanted(w, paces, count);
    const double least = w->export->scene->transient.until / most_steps;
    w->step = fmax(wanted, least);
    w->expected = fmin(1.0, w->export->scene->accuracy * fmax(1.0, (w->step / wanted) * (w->step / wanted)));
    if (wanted < least) {
        snprintf(w->export->note, sizeof w->export->note,
                 "a netlist has one tmax, where the engine ngspice cuts the run into pieces, each of its own step: tmax is %.3g s, %g "
                 "steps; the accuracy %.3g of the scene needs %.3g s while %s: expect an error of some %.2g, or shorten the run",
                 w->step, most_steps, w->export->scene->accuracy, wanted, w->rings ? "the film rings" : "the film relaxes",
                 w->expected);
    }
}

void dea_export_drive_analysis(const dea_export_drive *w, const char *velocity)
{
    const dea_transient *transient = &w->export->scene->transient;
    fputs(w->dialect->transient, w->out);
    fprintf(w->out,
            "* results: displacement v(disp) [m], velocity v(%s) [m/s], film voltage v(film) [V], source current -i(vsource) [A]\n"
            ".print tran v(disp) v(%s) v(film) i(vsource)\n",
            velocity, velocity);
    if (w->export->dialect->save) {
        fprintf(w->out, "%s v(disp) v(%s) v(film) i(vsource)\n", w->export->dialect->save, velocity);
    }
    dea_part_print(w->out,
                   "* .tran print interval, end, begin of the output, tmax [s]. tmax sets the accuracy: a tenth of it makes the error a "
                   "hundredth\n* %g steps or more, for an error of some %g\n.tran %g %g 0 %g uic\n"
                   ".end\n",
                   ceil(transient->until / w->step), w->expected,
                   transient->logarithmic ? transient->until / 1000.0 : transient->every, transient->until, w->step);
}
