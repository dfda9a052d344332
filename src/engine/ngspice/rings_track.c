#include "engine/ngspice/rings_track.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "film/point.h"
#include "support/gauss.h"

/* Steps in a radian of the first mode at fineness 1: the trapezoidal rule turns the modes above it too. */
static const double radian_steps = 3.0;

/* Time behind a corner in which the shortest waves of a film go, over a step of the swing. */
static const double behind_corner = 0.3;

/* Most time steps of one netlist, for what its plot takes of memory [numbers]. */
static const double most_numbers = 2e7;

/* Time of a state over a step, below which steps do not resolve it: its slope is then that of the parabola through its neighbours. */
static const double unresolved = 0.5;

/* Loosest tolerance of Newton's method in a step, relative: what it leaves goes with its square. A film without mass wants it tight: it
 * would pass its fold where nothing but the tolerance finds an equilibrium. */
static const double loosest = 1e-3, tight = 1e-7;

/* Share of the stiffness at rest below which a film that ngspice cannot follow has lost it. */
static const double soft = 1e-3;

/* ---- opening */

/* Behind a corner steps are finer than those of the swing: its waves are the faster for being short. */
static dea_pace pace_of(const dea_rings_track *t)
{
    dea_pace pace = dea_pace_of_rings(&t->flight.membrane, &t->flight.motion.rest, dea_rings_decay(&t->flight.motion));
    if (pace.omega > 0.0) {
        const bool others = pace.fastest < 0.3 / pace.omega;
        pace.omega *= radian_steps;
        pace.fastest = others ? pace.fastest : behind_corner / pace.omega;
    }
    return pace;
}

static double port_unit(const dea_rings_track *t)
{
    const double unit = 10.0 * t->signal->largest / t->flight.membrane.film.series; /* tolerance of forces 1e-10, of voltages 1e-9 */
    return unit > 0.0 && isfinite(unit) ? unit : 1.0;
}

static dea_status prepare(dea_rings_track *t, const dea_model *model, dea_rings_mesh mesh, dea_error *error)
{
    const dea_transient *transient = &t->scene->transient;
    const bool quiet = transient->from_bias || t->signal->segments[0].start == 0.0;
    dea_status status = dea_rings_flight_prepare(t->scene, model, t->signal, mesh, &t->flight, error);
    if (status != DEA_OK) {
        return status;
    }
    const dea_rings_motion *m = &t->flight.motion;
    t->quasi = *m;
    t->quasi.heavy = t->quasi.damped = false;
    t->quasi.z = m->nodes;
    t->quasi.q = m->nodes + dea_membrane_relaxed(m->membrane);
    t->quasi.count = m->count - (m->z - m->nodes);
    t->unit = port_unit(t);
    t->states = m->count;
    t->columns = m->count + 1;
    t->room = malloc(8 * t->states * sizeof *t->room);
    if (!t->room) {
        return dea_fail(error, DEA_ERROR_MEMORY, "out of memory for a run");
    }
    if (t->columns > DEA_NGSPICE_COLUMNS) {
        return dea_fail(error, DEA_ERROR_ENGINE, "%zu nodes with %zu branches have %zu states, ngspice is read for %d; take --engine ida",
                        m->nodes, m->membrane->film.branch_count, t->states, (int)DEA_NGSPICE_COLUMNS - 1);
    }
    const dea_pace pace = pace_of(t);
    status = dea_pieces_cut(t->signal, &pace, t->scene->accuracy, t->scene->reduction.ring, quiet, &t->pieces, error);
    return status == DEA_OK ? dea_rings_deck_network(t->scene, m->membrane, t->unit, &t->network, error) : status;
}

dea_status dea_rings_track_open(dea_ngspice *library, const dea_scene *scene, const dea_model *model, const dea_signal *signal,
                                dea_rings_mesh mesh, dea_rings_track *t, dea_error *error)
{
    *t = (dea_rings_track){.library = library, .scene = scene, .signal = signal};
    return prepare(t, model, mesh, error);
}

void dea_rings_track_close(dea_rings_track *t)
{
    free(t->pieces.pieces);
    free(t->network);
    free(t->room);
    *t = (dea_rings_track){0};
}

/* ---- between points */

/* A state of the film with its slopes, at a time of the run. */
typedef struct point {
    double time;
    double *y, *rates;
} point;

typedef struct runner {
    dea_rings_track *track;
    double step;   /* of the piece [s] */
    bool slow;     /* it steps over the swing, which is dead */
    bool drags;    /* and over what a damper without mass does */
    bool charging; /* and over the charging of the film */
    dea_matching match; /* of its masses to the steps */
    double speed;       /* velocity of a node of the film over that of the netlist [1] */
    double loose, parts;
    double *state; /* at the end of the last netlist */
    point a, b, between;
} runner;

static size_t charge_of(const runner *r)
{
    return r->track->flight.motion.q;
}

/* The branch that a state belongs to; NULL: none. */
static const dea_branch *branch_of(const runner *r, size_t k)
{
    const dea_rings_motion *m = &r->track->flight.motion;
    const dea_dynamics *film = &m->membrane->film;
    return k >= m->z && k < m->q ? &film->branches[(k - m->z) % film->branch_count] : NULL;
}

/* Its slope is read off its neighbours. */
static bool is_fast(const runner *r, size_t k)
{
    const dea_branch *branch = branch_of(r, k);
    const bool charge = r->track->flight.motion.charged && k == charge_of(r);
    return (branch && branch->tau < unresolved * r->step) || (charge && r->charging) || (k < r->track->flight.motion.nodes && r->drags);
}

static double since(const runner *r, double time)
{
    return time - r->track->flight.motion.segment->from;
}

/* Velocities of the film that follows its voltage and its branches, whose slopes are known. */
static bool quasi_rates(runner *r, point *p)
{
    dea_rings_track *t = r->track;
    const dea_rings_motion *m = &t->flight.motion;
    double *y = t->room + 6 * t->states, *rates = t->room + 7 * t->states;
    const size_t others = t->quasi.count - t->quasi.z; /* stresses of branches, charge */
    t->quasi.segment = m->segment;
    memcpy(y, p->y, m->nodes * sizeof *y);
    memcpy(y + t->quasi.z, p->y + m->z, others * sizeof *y);
    memcpy(rates + t->quasi.z, p->rates + m->z, others * sizeof *y);
    if (!dea_rings_massless(&t->quasi, since(r, p->time), y, rates)) {
        return false;
    }
    memcpy(p->rates, rates, m->nodes * sizeof *rates);
    if (m->heavy) {
        memcpy(p->y + m->nodes, rates, m->nodes * sizeof *rates);
        memset(p->rates + m->nodes, 0, m->nodes * sizeof *rates);
    }
    return true;
}

/* True where the equations of the whole film tell its slopes. */
static bool is_resolved(const runner *r)
{
    const dea_rings_motion *m = &r->track->flight.motion;
    return m->heavy ? !r->slow : m->damped;
}

/* Slopes at a point, whose fast ones stand there; false where the film cannot be. */
static bool set_rates(runner *r, point *p)
{
    dea_rings_track *t = r->track;
    double *known = t->room + 6 * t->states;
    memcpy(known, p->rates, t->states * sizeof *known);
    if (!dea_rings_rates(&t->flight.motion, since(r, p->time), p->y, p->rates)) {
        return false;
    }
    for (size_t k = 0; k < t->states; k++) {
        p->rates[k] = is_fast(r, k) ? known[k] : p->rates[k];
    }
    return is_resolved(r) || quasi_rates(r, p);
}

/* Cubic through values and slopes of a state at both ends, and its slope. */
static void blend(const runner *r, size_t k, double h, double x, double *value, double *slope)
{
    const double a = r->a.y[k], b = r->b.y[k], sa = r->a.rates[k], sb = r->b.rates[k], y = 1.0 - x;
    *value = a * y * y * (1.0 + 2.0 * x) + b * x * x * (1.0 + 2.0 * y) + h * x * y * (sa * y - sb * x);
    *slope = 6.0 * x * y * (b - a) / h + sa * y * (y - 2.0 * x) + sb * x * (x - 2.0 * y);
}

/* The film between the two points; false where it cannot be. */
static bool look_between(runner *r, double time)
{
    const dea_rings_track *t = r->track;
    point *p = &r->between;
    const double h = r->b.time - r->a.time, x = (time - r->a.time) / h;
    p->time = time;
    for (size_t k = 0; k < t->states; k++) {
        blend(r, k, h, x, &p->y[k], &p->rates[k]);
    }
    return is_resolved(r) ? r->track->flight.motion.heavy || dea_rings_massless(&t->flight.motion, since(r, time), p->y, p->rates) : quasi_rates(r, p);
}

/* Samples up to the second point. */
static bool take_samples(runner *r)
{
    dea_rings_flight *f = &r->track->flight;
    for (double next = dea_rings_next_sample(f); next <= r->b.time; next = dea_rings_next_sample(f)) {
        if (!look_between(r, next) || !dea_rings_record(f, since(r, next), r->between.y, r->between.rates, r->charging)) {
            return false;
        }
    }
    return true;
}

/* The step's share of the windows. */
static void integrate(runner *r)
{
    dea_rings_track *t = r->track;
    const size_t edge = t->flight.membrane.rings.edge;
    for (size_t i = 0; i < t->scene->transient.average_count; i++) {
        const dea_window *window = &t->scene->transient.averages[i];
        const double from = fmax(r->a.time, window->from), to = fmin(r->b.time, window->to), h = r->b.time - r->a.time;
        for (int g = 0; g < DEA_GAUSS_POINTS && from < to; g++) {
            double u, slope;
            blend(r, edge, h, (from + dea_gauss_place(g) * (to - from) - r->a.time) / h, &u, &slope);
            t->flight.trace->integrals[i] += dea_gauss_weight(g) * (to - from) * u;
        }
    }
}

static void audit_at(runner *r, const point *p, double weight)
{
    dea_rings_audit(&r->track->flight, since(r, p->time), p->y, p->rates, r->charging, weight);
}

/* Powers by Simpson's rule. */
static void audit(runner *r)
{
    const double h = r->b.time - r->a.time;
    if (look_between(r, r->a.time + 0.5 * h)) {
        audit_at(r, &r->between, 4.0 * h / 6.0);
        audit_at(r, &r->a, h / 6.0);
        audit_at(r, &r->b, h / 6.0);
    }
}

/* Current at a time of the step [A]. */
static double current_at(void *user, double time)
{
    runner *r = user;
    return look_between(r, fmin(fmax(time, r->a.time), r->b.time))
               ? dea_rings_current(&r->track->flight, since(r, time), r->between.y, r->between.rates, r->charging)
               : 0.0;
}

/* ---- points of a netlist */

/* Points of a plot that lie in one segment of the voltage: the state before them, then so many of the table. */
typedef struct stretch {
    const dea_ngspice_table *table;
    const double *start; /* NULL: all points are of the table */
    double start_time;   /* of the run [s] */
    size_t first, count; /* points of the table */
    double from, to;     /* of the piece [s] */
} stretch;

/* The last point is the end of the piece, whose sample it holds, whatever its time rounds to. */
static double time_of(const stretch *s, size_t i)
{
    const double since = i == 0 ? 0.0 : s->table->columns[0][s->first + i - 1], length = s->to - s->from;
    return i == 0 ? s->start_time : since >= length * (1.0 - 1e-12) ? s->to : s->from + since;
}

/* A state over the number that stands for it in a netlist: velocities of masses that fit the steps, the charge as the voltage that it
 * makes at rest. */
static double unit_of(const runner *r, size_t k)
{
    const dea_rings_motion *m = &r->track->flight.motion;
    const bool fast = m->heavy && k >= m->nodes && k < 2 * m->nodes;
    return fast ? r->speed : m->charged && k == m->q ? dea_point_capacitance(&m->membrane->film.point) : 1.0;
}

static double state_of(const runner *r, const stretch *s, size_t i, size_t k)
{
    if (i == 0) {
        return s->start[k];
    }
    return s->table->columns[k + 1][s->first + i - 1] * unit_of(r, k);
}

/* Slope at point i of the parabola through the three next to it, or of the line through two. */
static double slope_at(const runner *r, const stretch *s, size_t i, size_t k)
{
    const size_t first = s->count < 2 || i == 0 ? 0 : i == s->count ? i - 2 : i - 1;
    const double ta = time_of(s, first), tb = time_of(s, first + 1);
    const double left = (state_of(r, s, first + 1, k) - state_of(r, s, first, k)) / (tb - ta);
    if (s->count < 2) {
        return left;
    }
    const double tc = time_of(s, first + 2);
    const double right = (state_of(r, s, first + 2, k) - state_of(r, s, first + 1, k)) / (tc - tb);
    return left + (right - left) * (2.0 * time_of(s, i) - ta - tb) / (tc - ta);
}

/* Reads point i; false where the film cannot be there. */
static bool read_point(runner *r, const stretch *s, size_t i, point *p)
{
    p->time = time_of(s, i);
    for (size_t k = 0; k < r->track->states; k++) {
        p->y[k] = state_of(r, s, i, k);
        p->rates[k] = is_fast(r, k) ? slope_at(r, s, i, k) : 0.0;
    }
    return set_rates(r, p);
}

/* The steps of a stretch; what happened. */
static dea_state walk(runner *r, const stretch *s)
{
    dea_rings_flight *f = &r->track->flight;
    if (!read_point(r, s, 0, &r->a)) {
        return DEA_STATE_PULL_IN;
    }
    for (size_t i = 1; i <= s->count; i++) {
        if (!read_point(r, s, i, &r->b) || !take_samples(r)) {
            return DEA_STATE_PULL_IN;
        }
        integrate(r);
        if (f->peaks) {
            dea_peak_search(&f->trace->peak, r->a.time, r->b.time, current_at, r);
        }
        if (f->audit) {
            audit(r);
        }
        const dea_state state = dea_rings_step(f, since(r, r->b.time), r->b.y);
        if (state != DEA_STATE_OK) {
            return state;
        }
        const point last = r->a;
        r->a = r->b;
        r->b = last;
    }
    for (size_t k = 0; k < r->track->states; k++) {
        r->state[k] = state_of(r, s, s->count, k);
    }
    return DEA_STATE_OK;
}

/* Why a netlist ended before its time. */
static dea_state verdict(runner *r, double time)
{
    dea_rings_flight *f = &r->track->flight;
    double u[DEA_RINGS_NODES];
    const dea_segment *segment = f->motion.segment;
    const double voltage = fmax(fabs(segment->start), fabs(segment->end));
    const bool charged = dea_rings_algebraic(&f->motion) && f->motion.charged;
    const bool lost = dea_rings_firmness(&f->motion, since(r, time), r->state) < soft ||
                      (!charged && !dea_membrane_still(&f->membrane, voltage, u));
    const char *complaint = dea_ngspice_complaint(r->track->library);
    if (!lost) {
        dea_fail(&f->why, DEA_ERROR_ENGINE, "ngspice stopped%s%s", complaint[0] ? ": " : "", complaint);
    }
    return lost ? DEA_STATE_PULL_IN : DEA_STATE_FAILED;
}

/* Points of the table behind `first` that follow each other up to a time, the end of a segment. */
static size_t points_up_to(const dea_ngspice_table *table, size_t first, double length)
{
    size_t count = 0;
    while (first + count < table->count && table->columns[0][first + count] <= length * (1.0 + 1e-12)) {
        count++;
    }
    return count;
}

/* The points of one netlist, segment by segment; *time: how far the film came. */
static dea_state absorb(runner *r, const dea_ngspice_table *table, double from, double to, double *time)
{
    dea_rings_motion *m = &r->track->flight.motion;
    const dea_signal *signal = r->track->signal;
    size_t first = 0;
    double begin = from;
    *time = from;
    while (first < table->count) {
        const size_t near = (size_t)(m->segment - signal->segments);
        const double next = fmin(from + table->columns[0][first], to);
        if (!(next > begin)) { /* late in a run the first steps are finer than its time can be told */
            first++;
            continue;
        }
        m->segment = &signal->segments[dea_signal_find(signal, near, 0.5 * (begin + next))];
        const double end = fmin(m->segment->to, to);
        const size_t count = points_up_to(table, first, end - from);
        const stretch s = {table, r->state, begin, first, count > 0 ? count : 1, from, to};
        double *start = r->track->room + 5 * r->track->states;
        memcpy(start, r->state, r->track->states * sizeof *start);
        const stretch own = {table, start, s.start_time, s.first, s.count, s.from, s.to};
        const dea_state state = walk(r, &own);
        if (state != DEA_STATE_OK) {
            return state;
        }
        first += own.count;
        *time = begin = time_of(&own, own.count);
    }
    return *time >= to - 1e-9 * (to - from) ? DEA_STATE_OK : verdict(r, *time);
}

/* ---- pieces */

static dea_status write_piece(const void *user, const dea_mobility_piece *piece, char **text, dea_error *error)
{
    const runner *r = user;
    const dea_rings_track *t = r->track;
    double *states = t->room + 6 * t->states;
    for (size_t k = 0; k < t->states; k++) {
        states[k] = r->state[k] / unit_of(r, k);
    }
    return dea_rings_deck_write(t->network, &t->flight.membrane, piece, states, text, error);
}

static double newton_tolerance(const dea_rings_track *t)
{
    const double accuracy = t->scene->accuracy;
    return t->flight.membrane.heavy ? fmin(loosest, accuracy) : fmin(tight, 1e-3 * accuracy);
}

static dea_status run_netlist(runner *r, double from, double to, size_t segment, dea_state *end, double *reached, dea_error *error)
{
    const dea_rings_track *t = r->track;
    dea_rings_label labels[DEA_NGSPICE_COLUMNS];
    const char *names[DEA_NGSPICE_COLUMNS] = {"time"};
    dea_ngspice_table table;
    dea_mobility_piece piece = {.signal = t->signal,
                                .segment = segment,
                                .from = from,
                                .to = to,
                                .step = r->step,
                                .parts = r->parts,
                                .tolerance = newton_tolerance(t),
                                .loose = r->loose,
                                .mass = r->match.mass,
                                .conductance = r->match.resistance};
    for (size_t i = 0; i < t->states; i++) {
        labels[i] = dea_rings_state_node(&t->flight.membrane, i);
        names[i + 1] = labels[i].text;
    }
    const dea_status status = dea_deck_run(t->library, &piece, write_piece, r, names, t->columns, &table, error);
    r->loose = piece.loose;
    if (status == DEA_OK) {
        *end = absorb(r, &table, from, to, reached);
    }
    dea_ngspice_table_free(&table);
    return status;
}

static void set_step(runner *r, const dea_piece *piece, double step)
{
    const dea_rings_track *t = r->track;
    const dea_rings_motion *m = &t->flight.motion;
    const double charging = m->charged ? m->rest.capacitance / (1.0 / m->membrane->film.series + m->membrane->film.conductance) : 0.0;
    r->step = step;
    r->slow = m->heavy && !piece->rings && m->rest.slowest * step > unresolved;
    const dea_segment *segment = &t->signal->segments[piece->segment];
    const double voltage = fmax(fabs(segment->start), fabs(segment->end));
    r->match = m->heavy && piece->rings ? dea_matching_of_rings(m->membrane, voltage, step) : (dea_matching){.mass = 1.0};
    r->speed = sqrt(r->match.mass);
    r->drags = !m->heavy && m->damped && m->membrane->film.retardation < unresolved * step * (1.0 + m->membrane->film.total_share);
    r->charging = m->charged && charging < unresolved * step;
    r->track->quasi.charged = m->charged && !r->charging; /* else it has the voltage of the source */
}

/* The voltage jumps: a film without mass, damper and series resistance goes with it. */
static bool jump(runner *r, size_t segment)
{
    dea_rings_flight *f = &r->track->flight;
    f->motion.segment = &r->track->signal->segments[segment];
    return dea_rings_jump(f, r->state);
}

static dea_status run_piece(runner *r, const dea_piece *piece, double fineness, dea_state *end, dea_error *error)
{
    const dea_rings_track *t = r->track;
    const double most = floor(most_numbers / (double)t->columns), steps = (piece->to - piece->from) / (piece->step * fineness);
    const double parts = ceil(steps / most);
    double from = piece->from;
    dea_status status = DEA_OK;
    if (piece->jump && !jump(r, piece->segment)) {
        *end = DEA_STATE_PULL_IN;
    }
    set_step(r, piece, piece->step * fineness);
    for (double part = 1.0; part <= parts && status == DEA_OK && *end == DEA_STATE_OK; part++) {
        const double to = part == parts ? piece->to : piece->from + (piece->to - piece->from) * (part / parts);
        const size_t segment = dea_signal_find(t->signal, piece->segment, nextafter(from, INFINITY));
        double reached;
        status = run_netlist(r, from, to, segment, end, &reached, error);
        from = to;
    }
    return status;
}

/* At rest, or at the equilibrium under the first voltage, where @p first is stored; the first sample. */
static bool start(runner *r, dea_membrane_energy *first)
{
    dea_rings_flight *f = &r->track->flight;
    if (!dea_rings_start(&f->motion, r->track->scene->transient.from_bias, r->state)) {
        return false;
    }
    *first = dea_rings_energy(f, 0.0, r->state);
    if (!jump(r, 0)) {
        return false;
    }
    memcpy(r->a.y, r->state, r->track->states * sizeof *r->a.y);
    return dea_rings_rates(&f->motion, 0.0, r->a.y, r->a.rates) && dea_rings_record(f, 0.0, r->a.y, r->a.rates, false);
}

dea_status dea_rings_track_run(dea_rings_track *t, double fineness, dea_rings_trace *trace, dea_summary *summary, dea_error *error)
{
    dea_rings_flight *f = &t->flight;
    double *points = malloc(7 * t->states * sizeof *points);
    if (!points) {
        return dea_fail(error, DEA_ERROR_MEMORY, "out of memory for a run");
    }
    const size_t n = t->states;
    dea_audit energies = {0};
    runner r = {.track = t, .loose = 1.0, .parts = dea_deck_parts(fineness), .state = points,
                .a = {0.0, points + n, points + 2 * n}, .b = {0.0, points + 3 * n, points + 4 * n},
                .between = {0.0, points + 5 * n, points + 6 * n}};
    *trace = (dea_rings_trace){.samples = trace->samples};
    *summary = dea_summary_failed();
    f->trace = trace;
    f->audit = &energies;
    f->steps = 0;
    f->why.message[0] = '\0';
    f->motion.segment = t->signal->segments;
    dea_membrane_energy first = {0};
    trace->end = start(&r, &first) ? DEA_STATE_OK : DEA_STATE_PULL_IN;
    dea_status status = DEA_OK;
    for (size_t i = 0; i < t->pieces.count && status == DEA_OK && trace->end == DEA_STATE_OK; i++) {
        status = run_piece(&r, &t->pieces.pieces[i], fineness, &trace->end, error);
    }
    if (status == DEA_OK && trace->end == DEA_STATE_OK) {
        const dea_membrane_energy last = dea_rings_energy(f, since(&r, f->motion.segment->to), r.state);
        dea_membrane_audit_close(&energies, &f->membrane, &first, &last, summary);
    }
    free(points);
    return status;
}
