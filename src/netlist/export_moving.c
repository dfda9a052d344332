/* Decks of transients and frequency responses that a user runs: source, what is read off, steps. */
#include <math.h>
#include <stdlib.h>

#include "netlist/export_drive.h"

typedef struct writer {
    dea_export *export;
    FILE *out;
    const dea_dialect *dialect;
    const dea_analogy *analogy;
    dea_dynamics dynamics; /* owned */
    dea_mobility mobility; /* owned */
    dea_export_drive drive; /* owned */
    dea_cards cards;       /* owned */
    dea_mobility_state start;
} writer;

/* The displacement of a linear film in the mobility analogy: n times the force of its spring. */
static void write_displacement(const writer *w)
{
    if (!isnan(w->mobility.stiffness) && !w->analogy->loop) {
        fputs("* displacement of the edge [m]\n", w->out);
        dea_part_text_source(&w->cards.text, DEA_VOLTAGE, "DISP", "disp", "0", w->cards.node);
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
    dea_part_text_source(&w->cards.text, DEA_VOLTAGE, "CHARGE", "drive", "0", "v(film)*([])/[c_rest]", w->mobility.network.capacitance);
    fputs("VFILM drive charge 0\nCCHARGE charge 0 {c_rest} ic={q_start}\nFFILM film 0 VFILM 1\n", out);
}

/* Tolerances of Newton from the sizes of displacement, velocity and force. */
static void write_tolerances(writer *w)
{
    if (!w->dialect->solver) {
        return;
    }
    dea_dynamics *d = &w->dynamics;
    const double scale = dea_dynamics_scale(d, w->drive.signal.largest);
    const double force = scale * fabs(dea_dynamics_stiffness(d, 0.0, 0.0, false));
    const double speed = scale / w->drive.step;
    const double velocity = 1e-11 * fmin(speed, scale) + 2e-12 * speed;
    const double least = fmin(1e-11 * scale, 1e-11 * force);
    const double free = 1e-7 * scale; /* the velocity is a difference of displacements over a step: it hears what they are open by */
    /* in a loop the velocity is a current, and a voltage once more to be read: its rounding is that of differences of u over a step */
    const double held = w->analogy->loop ? least + 2e-12 * speed : fmin(velocity, 1e-11 * scale + 2e-12 * speed);
    const double voltage = w->mobility.displaced ? free : held;
    const double current = w->analogy->loop ? 1e-11 * speed : 1e-10 * force;
    dea_part_print(w->out, "* tolerances of one time step\n%s reltol=1e-7 abstol=%g vntol=%g\n",
                   w->dialect->solver, current, voltage);
}

/* C U/I of a film that a limited source charges behind the edges of a step, or the shorter time that it has; 0 for drives that may
 * drive a swing again and again. */
static double charging_time(writer *w)
{
    const dea_scene *scene = w->export->scene;
    const dea_step *step = &scene->drive.waveform.step;
    if (!isfinite(w->dynamics.limit) || !dea_wave_settles(&scene->drive.waveform) || !isnan(scene->drive.waveform.period)) {
        return 0.0;
    }
    const double end = isnan(step->off) ? scene->transient.until : fmin(step->off, scene->transient.until);
    const double whole = dea_dynamics_edge(&w->dynamics, 0.0).capacitance * w->drive.signal.largest / w->dynamics.limit;
    return fmin(whole, end - step->on);
}

/* The film at rest and, where it stands, under the largest voltage. */
static void choose_step(writer *w)
{
    w->drive.evenly = charging_time(w);
    const double voltage = w->drive.signal.largest;
    double u;
    dea_pace paces[2] = {dea_pace_of(&w->dynamics, 0.0, 0.0)};
    const bool there = dea_dynamics_equilibrium(&w->dynamics, voltage, &u);
    if (there) {
        paces[1] = dea_pace_of(&w->dynamics, u, voltage);
    }
    dea_export_drive_steps(&w->drive, paces, there ? 2 : 1);
}

static void warn_of_pull_in(writer *w)
{
    double u;
    if (!w->export->note[0] && !dea_dynamics_equilibrium(&w->dynamics, w->drive.signal.largest, &u)) {
        snprintf(w->export->note, sizeof w->export->note,
                 "the film has no equilibrium under %g V (pull-in): a simulator may end there with too small a time step",
                 w->drive.signal.largest);
    }
}

/* Relaxed under the first voltage, or at rest; a film that follows its voltage begins where that wants it. */
static dea_status set_start(writer *w, dea_error *error)
{
    dea_dynamics *d = &w->dynamics;
    const double source = w->drive.signal.segments[0].start;
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
    dea_export_drive_source(&w->drive, w->dynamics.series > 0.0 ? "source" : "film");
    write_charge(w);
    write_displacement(w);
    write_velocity(w);
    fputs("* where the first step starts\n.ic", w->out);
    dea_cards_write_start(&w->cards, &numbers, w->drive.signal.segments[0].start);
    fputc('\n', w->out);
    write_tolerances(w);
    dea_export_drive_analysis(&w->drive, "edge");
    return status;
}

static writer writer_of(dea_export *export)
{
    return (writer){.export = export, .out = export->out, .dialect = export->dialect, .analogy = export->analogy};
}

dea_status dea_export_transient(dea_export *export, dea_error *error)
{
    if (export->scene->models[0]->membrane) {
        return dea_export_transient_rings(export, error);
    }
    writer w = writer_of(export);
    const dea_cards_form form = {.dialect = export->dialect, .analogy = export->analogy};
    dea_status status =
        dea_mobility_prepare(export->scene, export->scene->models[0], export->analogy, &w.dynamics, &w.mobility, error);
    status = status ? status : dea_export_drive_open(export, &w.drive, error);
    if (status == DEA_OK && !dea_cards_open(&w.mobility, &form, w.out, &w.cards)) {
        status = dea_fail(error, DEA_ERROR_MEMORY, "out of memory while a netlist is written");
    }
    status = status ? status : write_transient(&w, error);
    dea_cards_close(&w.cards);
    dea_export_drive_close(&w.drive);
    dea_mobility_close(&w.mobility);
    dea_dynamics_close(&w.dynamics);
    return status;
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
        dea_export_band(export, "disp", "edge");
    }
    dea_dynamics_close(&w.dynamics);
    return status;
}
