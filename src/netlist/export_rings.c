/* The membrane's transient and its frequency response as netlists: its rings, in the latter linearised about the bias, on a mesh
 * whose error is told by one that is two degrees finer. */
#include <math.h>
#include <stdlib.h>

#include "netlist/export_drive.h"
#include "netlist/rings_motion.h"
#include "netlist/rings_small.h"
#include "network/rings_band.h"
#include "network/rings_mesh.h"
#include "network/rings_motion.h"
#include "network/units.h"
#include "support/lapack.h"

/* What tells how good a mesh is: the edge under the bias, and the first mode about it. */
typedef struct mark {
    double edge;  /* [m] */
    double omega; /* [rad/s], 0: without mass */
} mark;

static dea_status mark_mesh(const dea_scene *scene, dea_rings_mesh mesh, dea_rings_biased *b, mark *found, dea_error *error)
{
    double stiffness[DEA_RINGS_NODES * DEA_RINGS_NODES], shapes[DEA_RINGS_NODES * DEA_RINGS_NODES], frequencies[DEA_RINGS_NODES];
    const dea_status status = dea_rings_bias(scene, scene->models[0], mesh, b, error);
    *found = (mark){(double)NAN, 0.0};
    if (status == DEA_OK && dea_rings_stands(b)) {
        found->edge = b->u[b->membrane.rings.edge];
        dea_membrane_stiffness(&b->membrane, &b->look, b->voltage, NULL, 0.0, stiffness);
        found->omega = dea_membrane_modes(&b->membrane, stiffness, frequencies, shapes) ? frequencies[0] : 0.0;
    }
    return status;
}

static double apart(const mark *coarse, const mark *fine)
{
    const double edge = fine->edge != 0.0 ? fabs(coarse->edge / fine->edge - 1.0) : 0.0;
    return fmax(edge, fine->omega > 0.0 ? fabs(coarse->omega / fine->omega - 1.0) : 0.0);
}

dea_status dea_export_ac_rings(dea_export *export, dea_error *error)
{
    char meaning[256], u[24], v[24];
    double gap = INFINITY;
    if (export->analogy_given && export->analogy->loop) {
        return dea_fail(error, DEA_ERROR_UNSUPPORTED, "the membrane is written in the mobility analogy: leave out --analogy");
    }
    dea_rings_biased *b = calloc(1, sizeof *b);
    dea_status status = b ? dea_rings_band(export->scene, export->scene->models[0], b, &gap, error)
                          : dea_fail(error, DEA_ERROR_MEMORY, "out of memory while a netlist is written");
    if (status == DEA_OK && !dea_rings_stands(b)) {
        status = dea_fail(error, DEA_ERROR_UNSUPPORTED, "the film has no equilibrium under its bias, %g V", export->scene->ac.bias);
    }
    if (status == DEA_OK) {
        const dea_rings_small small = {&b->membrane, b->u, b->voltage};
        snprintf(meaning, sizeof meaning, "small signals about %.9g V; v(v<n>) = velocity [m/s] of node n, current = force [N]", b->voltage);
        dea_export_head(export, meaning);
        fprintf(export->out, "* expected error of the response: %.0e\n", gap);
        dea_rings_small_write(&small, export->out);
        snprintf(u, sizeof u, "u%zu", b->membrane.rings.edge + 1);
        snprintf(v, sizeof v, "v%zu", b->membrane.rings.edge + 1);
        dea_export_band(export, u, v);
    }
    free(b);
    return status;
}

/* ---- a transient: mechanics in mm, N, MPa, s and the mass that goes with them, in which all numbers of a film have a middle size; the
 * port in SI */

static const dea_units handy = {.length = 1e3, .thickness = 1e3, .stress = 1e-6, .voltage = 1.0, .time = 1.0};

typedef struct moving {
    dea_export *export;
    FILE *out;
    dea_scene scene; /* owned: in those units */
    dea_membrane membrane;
    dea_export_drive drive; /* owned */
    dea_rings_motion motion;
    dea_rings_motion_cards cards; /* owned */
    double rest;                  /* capacitance at rest [F] */
    double *y;                    /* owned: the start */
    double gap;                   /* expected error of the nodes [1] */
} moving;

/* The static displacement under the largest voltage and the first mode at rest, of the mesh and of one two degrees finer. */
static dea_status tell_gap(moving *m, dea_error *error)
{
    const dea_rings_mesh own = m->membrane.rings.mesh;
    const dea_rings_mesh meshes[2] = {own, {own.disc > 1 ? own.disc + 2 : 1, own.annulus + 2, own.logarithmic}};
    mark marks[2];
    dea_scene scene = m->scene;
    dea_status status = DEA_OK;
    dea_rings_biased *b = calloc(1, sizeof *b);
    if (!b) {
        return dea_fail(error, DEA_ERROR_MEMORY, "out of memory while a netlist is written");
    }
    scene.ac.bias = m->drive.signal.largest;
    for (int i = 0; i < 2 && status == DEA_OK; i++) {
        status = mark_mesh(&scene, meshes[i], b, &marks[i], error);
    }
    m->gap = status == DEA_OK ? apart(&marks[0], &marks[1]) : (double)NAN;
    if (status == DEA_OK && !dea_rings_stands(b)) {
        snprintf(m->export->note, sizeof m->export->note,
                 "the film has no equilibrium under %g V (pull-in): a simulator may end there with too small a time step",
                 m->drive.signal.largest);
    }
    free(b);
    return status;
}

/* A mesh as fine as those that the engine comes to; the film at its start. */
static dea_status open_moving(moving *m, dea_error *error)
{
    const dea_scene *scene = m->export->scene;
    const dea_model *model = scene->models[0];
    dea_membrane_rest rest;
    double nodes = dea_rings_first_nodes(scene->accuracy);
    dea_status status = dea_membrane_open(&m->scene, model, dea_rings_mesh_of(scene, nodes), &m->membrane, error);
    if (status == DEA_OK && !dea_membrane_at_rest(&m->membrane, &rest)) {
        return dea_fail(error, DEA_ERROR_UNSUPPORTED, "the film is not stable at rest");
    }
    if (status == DEA_OK) {
        nodes = dea_rings_more_nodes(&m->membrane, &rest, nodes);
        status = dea_membrane_open(&m->scene, model, dea_rings_mesh_of(scene, nodes), &m->membrane, error);
    }
    if (status == DEA_OK && !dea_rings_motion_open(&m->membrane, &m->drive.signal, &m->motion)) {
        return dea_fail(error, DEA_ERROR_UNSUPPORTED, "the film is not stable at rest");
    }
    m->y = status == DEA_OK ? calloc(m->motion.count, sizeof *m->y) : NULL;
    if (status == DEA_OK && !m->y) {
        return dea_fail(error, DEA_ERROR_MEMORY, "out of memory while a netlist is written");
    }
    const bool follows = status == DEA_OK && dea_rings_algebraic(&m->motion) && !m->motion.charged;
    const double first = m->drive.signal.segments[0].start;
    if (status == DEA_OK && (!dea_rings_start(&m->motion, scene->transient.from_bias, m->y) ||
                             (follows && !dea_membrane_follow(&m->membrane, first, m->y + m->motion.z, m->y)))) {
        return dea_fail(error, DEA_ERROR_UNSUPPORTED, "the film has no equilibrium under its first voltage, %g V", first);
    }
    return status == DEA_OK ? tell_gap(m, error) : status;
}

/* On the source alone the charge is C(u) U; its derivative is taken from the film's terminals. */
static void write_charge(moving *m)
{
    if (m->membrane.film.series > 0.0) {
        return;
    }
    dea_rings_motion_cards_write_swell(&m->cards);
    fputs("* film: charge C(u) U on its capacitance at rest [F], whose current i = d(C U)/dt the film takes\n", m->out);
    dea_part_value(m->out, "c_rest", m->rest);
    dea_dialect_source_begin(m->export->dialect, m->out, DEA_VOLTAGE, "charge", "drive", "0");
    fputs("v(film)*(1+v(swell))", m->out);
    dea_dialect_source_end(m->export->dialect, m->out);
    fputs("VFILM drive charge 0\nCCHARGE charge 0 {c_rest}\nFFILM film 0 VFILM 1\n", m->out);
}

/* What is read off, in SI; the velocity of a film without is the current of a capacitor under its displacement. */
static void write_readings(const moving *m)
{
    fputs("* displacement [m] and velocity [m/s] of the edge\nEDISP disp 0 u 0 1e-3\n", m->out);
    fputs(dea_rings_algebraic(&m->motion) ? "ECOPY copy 0 disp 0 1\nCRATE copy rate 1\nVRATE rate 0 0\nHSPEED speed 0 VRATE 1\n"
                                          : "ESPEED speed 0 edge 0 1e-3\n",
          m->out);
}

static void start_node(const moving *m, const char *node, double value)
{
    dea_part_print(m->out, ".ic v(%s)=%g\n", node, value);
}

/* Where the first step starts: at 0, where nothing else is said. */
static void write_start(const moving *m)
{
    const size_t count = dea_rings_states(&m->membrane) - (m->motion.charged ? 1 : 0);
    const double source = m->drive.signal.segments[0].start;
    dea_membrane_look look;
    for (size_t i = 0; i < count; i++) {
        if (m->y[i] != 0.0) {
            start_node(m, dea_rings_state_node(&m->membrane, i).text, m->y[i]);
        }
    }
    if (source == 0.0 || !dea_membrane_look_at(&m->membrane, m->y, &look)) {
        return;
    }
    const double voltage = m->motion.charged ? m->y[m->motion.q] / look.capacitance : source;
    const double swell = look.capacitance / m->motion.rest.capacitance;
    start_node(m, "film", voltage);
    start_node(m, "charge", voltage * swell);
    if (dea_rings_algebraic(&m->motion)) {
        start_node(m, "copy", 1e-3 * m->y[m->membrane.rings.edge]);
    }
}

/* Of Newton, from the sizes of strains and forces. */
static void write_tolerances(const moving *m)
{
    const double voltage = m->drive.signal.largest;
    if (m->export->dialect->solver) {
        dea_part_print(m->out, "* tolerances of one time step\n%s reltol=1e-7 abstol=%g vntol=%g\n",
                       m->export->dialect->solver, 1e-9 * m->motion.rest.force * voltage * voltage, 1e-9 * m->motion.length / m->membrane.film.radius);
    }
}

static dea_status write_moving(moving *m, dea_error *error)
{
    const dea_scene *scene = m->export->scene;
    const dea_cards_form form = {.dialect = m->export->dialect, .analogy = m->export->analogy};
    const double force = handy.stress * handy.thickness * handy.length, charge = force * handy.length / handy.voltage;
    const dea_rings_port port = {dea_series_resistance(scene), scene->drive.leakage_resistance, m->motion.rest.capacitance / charge};
    const dea_pace pace = dea_pace_of_rings(&m->membrane, &m->motion.rest, dea_rings_decay(&m->motion));
    const dea_rings_mesh mesh = m->membrane.rings.mesh;
    const dea_status status = dea_rings_motion_cards_open(&m->scene, &m->membrane, &form, m->out, &m->cards, error);
    if (status != DEA_OK) {
        return status;
    }
    m->rest = port.rest;
    dea_export_drive_steps(&m->drive, &pace, 1);
    dea_export_head(m->export, "mobility analogy: v(edge) = velocity [mm/s], v(u) = displacement [mm], current = force [N], mm, N, MPa, s, V");
    fprintf(m->out, "* %zu moving nodes (degrees of disc and annulus: %zu, %zu); expected error of the static displacement and of the first\n"
                    "* resonance: %.0e\n",
            m->membrane.rings.node_count, mesh.disc, mesh.annulus, m->gap);
    if (m->export->note[0]) {
        dea_dialect_comment(m->out, m->export->note);
    }
    dea_rings_motion_cards_write_numbers(&m->cards, &port);
    dea_rings_motion_cards_write_network(&m->cards);
    dea_export_drive_source(&m->drive, m->motion.charged ? "source" : "film");
    write_charge(m);
    write_readings(m);
    write_start(m);
    write_tolerances(m);
    dea_export_drive_analysis(&m->drive, "speed");
    return DEA_OK;
}

dea_status dea_export_transient_rings(dea_export *export, dea_error *error)
{
    if (export->analogy_given && export->analogy->loop) {
        return dea_fail(error, DEA_ERROR_UNSUPPORTED, "the membrane is written in the mobility analogy: leave out --analogy");
    }
    moving *m = calloc(1, sizeof *m);
    dea_status status = m ? dea_lapack_load(error) : dea_fail(error, DEA_ERROR_MEMORY, "out of memory while a netlist is written");
    if (status != DEA_OK) {
        free(m);
        return status;
    }
    m->export = export;
    m->out = export->out;
    status = dea_units_enter(&handy, export->scene, &m->scene, error);
    if (status == DEA_OK) {
        status = dea_export_drive_open(export, &m->drive, error);
        if (status == DEA_OK) {
            status = open_moving(m, error);
        }
        if (status == DEA_OK) {
            status = write_moving(m, error);
        }
        dea_rings_motion_cards_close(&m->cards);
        dea_export_drive_close(&m->drive);
        dea_units_leave(&m->scene);
    }
    free(m->y);
    free(m);
    return status;
}
