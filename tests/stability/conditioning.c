/* Condition numbers of the matrices that a time step is solved with: ngspice's of the network in the mobility analogy, and IDA's
 * Jacobian; each in SI and in the units of the engine. */
#include "stability.h"

#include "../bench/bench.h"

#include "support/lapack.h"
#include <math.h>
#include <stdio.h>
#include <stdlib.h>

#include "network/motion.h"
#include "engine/ngspice/moving.h"
#include "engine/ngspice/pieces.h"

#define SILICONE "yeoh: {C1: 178426 Pa, C2: -6023 Pa, C3: 4234 Pa}, permittivity: 2.8, density: 1080 kg/m^3"
#define DOT(frame, film)                                                                                                         \
    "actuator: {kind: dot, frame_radius: " frame ", coverage: 0.5, film_thickness: " film ", prestretch: 1.2}\n"
#define THREE ", prony: [{g: 0.1, tau: 1 ms}, {g: 0.1, tau: 0.3 s}, {g: 0.05, tau: 3 s}]"
#define WIDE ", prony: [{g: 0.1, tau: 1 us}, {g: 0.1, tau: 1 s}, {g: 0.05, tau: 1e6 s}]"
#define STEP(volt) "waveform: {step: {on: 5 s, off: 15 s, voltage: " volt ", rise: 1 us}}"
#define RUN "model: lumped\nstudy: {transient: {until: 25 s, every: 10 ms}}\n"

static const struct {
    const char *name, *text;
    int branches; /* of equal distance from 1 us to 1e6 s, beside those of the text */
} subjects[] = {
    {"usual: 100 um in 30 mm, 3 branches",
     DOT("30 mm", "100 um") "material: {" SILICONE THREE "}\ndrive: {" STEP("4.5 kV") "}\n" RUN, 0},
    {"usual, behind 10 MOhm",
     DOT("30 mm", "100 um") "material: {" SILICONE THREE "}\ndrive: {series_resistance: 10 MOhm, " STEP("4.5 kV") "}\n" RUN, 0},
    {"film of 1 um", DOT("30 mm", "1 um") "material: {" SILICONE THREE "}\ndrive: {" STEP("45 V") "}\n" RUN, 0},
    {"frame of 1 m, film of 10 mm", DOT("1 m", "10 mm") "material: {" SILICONE THREE "}\ndrive: {" STEP("450 kV") "}\n" RUN, 0},
    {"mass of 1e-12 kg", DOT("48 um", "1 um") "material: {" SILICONE THREE "}\ndrive: {" STEP("45 V") "}\n" RUN, 0},
    {"branches of 1 us, 1 s, 1e6 s", DOT("30 mm", "100 um") "material: {" SILICONE WIDE "}\ndrive: {" STEP("4.5 kV") "}\n" RUN,
     0},
    {"40 branches from 1 us to 1e6 s", DOT("30 mm", "100 um") "material: {" SILICONE "}\ndrive: {" STEP("4.5 kV") "}\n" RUN, 40},
    {"all of it, behind 1 GOhm",
     DOT("48 um", "1 um") "material: {" SILICONE "}\ndrive: {series_resistance: 1 GOhm, " STEP("45 V") "}\n" RUN, 40},
};

/* Nodes and branches of a network, and its matrix, column by column. */
enum { LARGEST = 2 * DEA_PRONY_MAX + 16 };

typedef struct matrix {
    int n;
    double at[LARGEST * LARGEST];
} matrix;

/* Largest over smallest singular value; what rounding cannot tell from a singular matrix is infinite. */
static double condition(const matrix *m)
{
    static double work[LARGEST * LARGEST];
    double values[LARGEST], rest[LARGEST];
    for (int i = 0; i < m->n * m->n; i++) {
        work[i] = m->at[i];
    }
    if (dea_lapacke_dgesvd(LAPACK_COL_MAJOR, 'N', 'N', m->n, m->n, work, m->n, values, NULL, 1, NULL, 1, rest) != 0) {
        return (double)NAN;
    }
    const double ratio = values[0] / values[m->n - 1];
    return ratio < 1.0 / (2.2e-16 * m->n) ? ratio : (double)INFINITY;
}

/* Scales rows and columns until their largest entries are 1 (Ruiz): what is left no choice of units can better. */
static void equilibrate(matrix *m)
{
    for (int pass = 0; pass < 60; pass++) {
        double rows[LARGEST] = {0.0}, columns[LARGEST] = {0.0};
        for (int i = 0; i < m->n * m->n; i++) {
            rows[i % m->n] = fmax(rows[i % m->n], fabs(m->at[i]));
            columns[i / m->n] = fmax(columns[i / m->n], fabs(m->at[i]));
        }
        for (int i = 0; i < m->n * m->n; i++) {
            m->at[i] /= sqrt(rows[i % m->n] * columns[i / m->n]);
        }
    }
}

static void put(matrix *m, int row, int column, double value)
{
    m->at[column * LARGEST + row] += value;
}

/* Between two nodes, -1: ground. */
static void put_conductance(matrix *m, int a, int b, double value)
{
    put(m, a, a, value);
    if (b >= 0) {
        put(m, b, b, value);
        put(m, a, b, -value);
        put(m, b, a, -value);
    }
}

/* A branch whose current is an unknown: v(a) - v(b) - resistance i = ... */
static void put_branch(matrix *m, int branch, int a, int b, double resistance)
{
    put(m, a, branch, 1.0);
    put(m, branch, a, 1.0);
    if (b >= 0) {
        put(m, b, branch, -1.0);
        put(m, branch, b, -1.0);
    }
    put(m, branch, branch, -resistance);
}

/* Where the network stands: under its largest voltage. */
typedef struct place {
    dea_edge edge;
    double u, voltage, step;
} place;

/* Source, series and leakage resistance, and the charge of the film; `spring` is the branch whose flux is u. */
static int put_port(matrix *m, const dea_dynamics *d, const place *at, int film, int spring, double compliance)
{
    int next = m->n;
    if (d->conductance > 0.0) {
        put_conductance(m, film, -1, d->conductance);
    }
    if (!(d->series > 0.0)) {
        put_branch(m, next, film, -1, 0.0);
        return next + 1;
    }
    const double rest = at->edge.capacitance - at->edge.capacitance_slope * at->u;
    const int source = next++, plate = next++, charge = next++, feed = next++, into = next++, behind = next++;
    put_branch(m, feed, source, -1, 0.0);
    put_conductance(m, source, film, 1.0 / d->series);
    put_branch(m, into, film, plate, 0.0);
    put(m, charge, into, -1.0);
    put(m, charge, charge, 2.0 * rest / at->step);
    put_branch(m, behind, plate, -1, 0.0);
    put(m, behind, charge, -rest / at->edge.capacitance);
    put(m, behind, spring, at->voltage * at->edge.capacitance_slope / at->edge.capacitance * compliance);
    return next;
}

/* The network as mobility.c writes it, each element as the trapezoidal rule makes it: C -> 2 C/h, L -> 2 L/h. */
static void assemble(matrix *m, dea_dynamics *d, const place *at)
{
    const double stiffness = at->edge.stress_slope[0], step = at->step;
    const int film = 0, edge = 1, spring = 2;
    *m = (matrix){.n = 3};
    if (d->mass > 0.0) {
        put_conductance(m, edge, -1, 2.0 * d->mass / step);
    }
    if (d->retardation > 0.0) {
        put_conductance(m, edge, -1, d->retardation * stiffness);
    }
    put_branch(m, spring, edge, -1, 2.0 / (stiffness * step));
    put(m, edge, film, -2.0 * at->edge.push * at->voltage);
    for (size_t i = 0; i < d->branch_count; i++) {
        const double branch = stiffness * d->branches[i].share;
        const int node = m->n++, current = m->n++;
        put_branch(m, current, edge, node, 2.0 / (branch * step));
        put_conductance(m, node, -1, branch * d->branches[i].tau);
    }
    m->n = put_port(m, d, at, film, spring, 1.0 / stiffness);
}

static void pack(matrix *m)
{
    for (int k = 0; k < m->n; k++) {
        for (int i = 0; i < m->n; i++) {
            m->at[k * m->n + i] = m->at[k * LARGEST + i];
        }
    }
}

/* Shortest and longest time step of the run. */
static void find_steps(dea_dynamics *d, const dea_signal *signal, double steps[2])
{
    dea_error error = {0};
    dea_pieces pieces;
    const dea_pace pace = dea_pace_of(d, 0.0, 0.0);
    if (dea_pieces_cut(signal, &pace, 1e-6, 0.0, true, &pieces, &error) != DEA_OK) {
        bench_give_up("%s", error.message);
    }
    steps[0] = steps[1] = pieces.pieces[0].step;
    for (size_t i = 0; i < pieces.count; i++) {
        steps[0] = fmin(steps[0], pieces.pieces[i].step);
        steps[1] = fmax(steps[1], pieces.pieces[i].step);
    }
    free(pieces.pieces);
}

/* cj - df/dy, in unknowns of size 1 or in SI. */
static double ida_condition(const dea_motion *motion, const double *y, double step, bool si)
{
    static matrix m;
    double jacobian[DEA_MOTION_MOST * DEA_MOTION_MOST];
    m = (matrix){.n = motion->count};
    dea_motion_jacobian(motion, 0.0, y, jacobian);
    for (int k = 0; k < m.n; k++) {
        for (int i = 0; i < m.n; i++) {
            const bool state = !(i == 0 && motion->algebraic);
            const double row = state ? motion->size[i] : motion->stiffness * motion->size[0] / motion->pace;
            const double value = (i == k && state ? 1.0 / step : 0.0) - jacobian[k * m.n + i];
            m.at[k * m.n + i] = value * (si ? row / motion->size[k] : 1.0);
        }
    }
    return condition(&m);
}

/* Worst condition numbers over the two steps. */
static void measure(const dea_scene *scene, double *network, double *best, double *scaled, double *plain)
{
    static matrix m;
    dea_error error = {0};
    dea_dynamics d;
    dea_signal signal = {0};
    dea_motion motion;
    place at = {.u = 0.0};
    double steps[2], y[DEA_MOTION_MOST];
    if (dea_dynamics_open(scene, scene->models[0], &d, &error) != DEA_OK || dea_signal_open(scene, &signal, &error) != DEA_OK) {
        bench_give_up("%s", error.message);
    }
    at.voltage = signal.largest;
    (void)dea_dynamics_equilibrium(&d, at.voltage, &at.u);
    at.edge = dea_dynamics_edge(&d, at.u);
    find_steps(&d, &signal, steps);
    dea_motion_open(&d, &signal, &motion);
    motion.segment = &signal.segments[signal.count / 2];
    (void)dea_motion_start(&motion, true, y);
    *network = *best = *scaled = *plain = 0.0;
    for (int i = 0; i < 2; i++) {
        at.step = steps[i];
        assemble(&m, &d, &at);
        pack(&m);
        *network = fmax(*network, condition(&m));
        equilibrate(&m);
        *best = fmax(*best, condition(&m));
        *scaled = fmax(*scaled, ida_condition(&motion, y, steps[i], false));
        *plain = fmax(*plain, ida_condition(&motion, y, steps[i], true));
    }
    dea_signal_close(&signal);
    dea_dynamics_close(&d);
}

static void add_branches(dea_scene *scene, int count)
{
    for (int i = 0; i < count; i++) {
        scene->material.prony[scene->material.prony_count++] = (dea_prony){0.5 / count, pow(10.0, -6.0 + 12.0 * i / (count - 1))};
    }
}

/* The scene in the units that ngspice runs it in. */
static dea_scene inside_of(const dea_scene *scene)
{
    dea_error error = {0};
    dea_units units;
    dea_scene inside;
    if (dea_ngspice_units(scene, scene->models[0], &units, &error) != DEA_OK ||
        dea_units_enter(&units, scene, &inside, &error) != DEA_OK) {
        bench_give_up("%s", error.message);
    }
    return inside;
}

size_t stability_condition_count(void)
{
    return sizeof subjects / sizeof subjects[0];
}

stability_condition stability_condition_of(size_t index)
{
    stability_condition c = {.name = subjects[index].name};
    double unused;
    dea_scene scene = stability_scene(subjects[index].text);
    add_branches(&scene, subjects[index].branches);
    dea_scene inside = inside_of(&scene);
    measure(&scene, &c.network, &unused, &c.ida_scaled, &c.ida);
    measure(&inside, &c.network_scaled, &c.network_best, &unused, &unused);
    dea_units_leave(&inside);
    dea_scene_free(&scene);
    return c;
}
