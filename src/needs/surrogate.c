#include "needs/surrogate.h"

#include <float.h>
#include <stdlib.h>

enum { ALL_BEHIND_A_CORNER = 32 };

static const double thinning = 0.06; /* from one probe to the next, later behind a corner: share of the samples since it */

static bool add_probe(dea_surrogate *s, size_t index, double age)
{
    if (s->count == s->room) {
        const size_t room = s->room ? 2 * s->room : 256;
        size_t *probes = realloc(s->probes, room * sizeof *probes);
        s->probes = probes ? probes : s->probes;
        double *ages = realloc(s->ages, room * sizeof *ages);
        s->ages = ages ? ages : s->ages;
        if (!probes || !ages) {
            return false;
        }
        s->room = room;
    }
    s->probes[s->count] = index;
    s->ages[s->count++] = age;
    return true;
}

/* The last sample at or before a time. */
static size_t sample_at(const dea_scene *scene, size_t rows, double time)
{
    size_t index = (size_t)fmin(dea_layout_index(scene, time), (double)(rows - 1));
    while (index > 0 && dea_layout_place(scene, index) > time) {
        index--;
    }
    while (index + 1 < rows && dea_layout_place(scene, index + 1) <= time) {
        index++;
    }
    return index;
}

/* The first samples behind every corner, then fewer and fewer, and the last before the next one. */
static bool place_probes(dea_surrogate *s)
{
    const size_t rows = dea_layout_of(s->scene).rows;
    size_t first = 0; /* sees a jump at the start */
    for (size_t i = 0; i < s->source.count; i++) {
        const dea_segment *segment = &s->source.segments[i];
        const size_t last = sample_at(s->scene, rows, segment->to);
        size_t next = first;
        while (next <= last) {
            if (!add_probe(s, next, dea_layout_place(s->scene, next) - segment->from)) {
                return false;
            }
            const size_t behind = next + 1 - first;
            const size_t step = behind < ALL_BEHIND_A_CORNER ? 1 : (size_t)(thinning * (double)behind);
            next = next < last && next + step > last ? last : next + step;
        }
        first = last + 1;
    }
    s->sampled = s->count;
    bool fits = true;
    for (size_t i = 0; i < s->scene->transient.average_count && fits; i++) {
        fits = add_probe(s, rows, 0.0);
    }
    return fits;
}

/* Stiffness of the relaxed film at u under that U^2 [N/m]. */
static double stiffness_at(dea_surrogate *s, double u, double square)
{
    return dea_dynamics_stiffness(&s->dynamics, u, sqrt(square), true);
}

/* U^2 that holds the relaxed film at u [V^2]. */
static double holding_square(dea_surrogate *s, double u)
{
    const dea_edge e = dea_dynamics_edge(&s->dynamics, u);
    return fmax(0.0, dea_edge_held(&s->dynamics, &e, NULL) / e.push);
}

static void add_point(dea_surrogate *s, double u, double square)
{
    const dea_edge e = dea_dynamics_edge(&s->dynamics, u);
    const double largest = s->source.largest * s->source.largest;
    dea_surrogate_point *point = &s->points[s->point_count++];
    *point = (dea_surrogate_point){.passive = dea_edge_held_slope(&s->dynamics, &e, NULL),
                                   .tension = e.tension_slope,
                                   .viscous = dea_edge_viscous(&s->dynamics, &e),
                                   .push = e.push,
                                   .push_slope = e.push_slope,
                                   .square = square,
                                   .excess = 1.0};
    if (s->loaded != s->dynamics.rest) {
        point->excess = fmax(1.0, fabs(e.push * largest / (stiffness_at(s, u, square) * (s->loaded - s->dynamics.rest))));
    }
}

/* True where a voltage that softens the film changes on the way. */
static bool softens_on_the_way(const dea_surrogate *s)
{
    bool flat = true;
    for (size_t i = 0; i < s->source.count; i++) {
        const dea_segment *segment = &s->source.segments[i];
        flat = flat && !segment->sine && segment->start == segment->end;
    }
    return s->points[0].push_slope != 0.0 && !flat;
}

/* False where the film would pull in, or already is unstable at rest. */
static bool place_points(dea_surrogate *s)
{
    const double largest = s->source.largest;
    if (!dea_dynamics_equilibrium(&s->dynamics, largest, &s->loaded)) {
        return false;
    }
    const double still = s->dynamics.rest, rest = dea_dynamics_edge(&s->dynamics, still).capacitance;
    const double there = dea_dynamics_edge(&s->dynamics, s->loaded).capacitance;
    s->capacitance = fmax(rest, there);
    s->least_capacitance = fmin(rest, there);
    if (!(stiffness_at(s, still, 0.0) > 0.0 && stiffness_at(s, s->loaded, largest * largest) > 0.0)) {
        return false;
    }
    add_point(s, still, 0.0);
    if (s->dynamics.linear) {
        s->points[0].excess = 1.0;
        if (softens_on_the_way(s)) { /* the walk takes the largest voltage of a segment for all of it: here, none */
            add_point(s, 0.0, DBL_MIN);
        }
    } else if (largest > 0.0) {
        add_point(s, s->loaded, largest * largest);
    }
    return true;
}

/* ---- how soft and how stiff the film becomes on its way */

/* Stiffness over the softest: 0.2 % below the voltage of a fold, or of a film that stiffens so much that its time constants on
 * the way are not those of its ends. */
static const double most_varied = 20.0;

enum { STEPS = 16, FARTHEST = 4 }; /* steps from rest to the equilibrium; displacements of that to which a swing is followed */

typedef struct way {
    double softest, stiffest; /* [N/m] */
    double least, most;       /* slope of the displacement over U^2, phi/K [m/V^2] */
    double u, square;         /* where it is softest */
} way;

static const way nowhere = {.softest = (double)INFINITY, .least = (double)INFINITY};

static void pass(dea_surrogate *s, double u, double square, way *w)
{
    const double stiffness = stiffness_at(s, u, square);
    if (!(stiffness >= w->softest)) {
        w->softest = stiffness;
        w->u = u;
        w->square = square;
    }
    const double slope = fabs(dea_dynamics_edge(&s->dynamics, u).push / stiffness);
    w->stiffest = fmax(w->stiffest, stiffness);
    w->least = fmin(w->least, slope);
    w->most = fmax(w->most, slope);
}

/* Goes on from u under a constant voltage until the springs have taken up that energy: as far as a swing gets that starts there
 * with it. False where it does not come back, or leaves its frame. */
static bool swing_out(dea_surrogate *s, double from, double step, double square, double energy, way *w)
{
    const double least = -s->dynamics.radius, most = s->dynamics.point.frame_radius - s->dynamics.radius;
    double taken = 0.0, before = 0.0;
    for (int i = 1; taken < energy; i++) {
        const double u = from + i * step;
        if (i > FARTHEST * STEPS || !(u > least && u < most)) {
            return false;
        }
        const dea_edge e = dea_dynamics_edge(&s->dynamics, u);
        const double force = dea_edge_held(&s->dynamics, &e, NULL) - e.push * square;
        taken += 0.5 * (force + before) * step;
        before = force;
        pass(s, u, square, w);
        if (!(w->softest > 0.0)) {
            return false;
        }
    }
    return true;
}

/* From rest to the equilibrium under the voltage that holds the film at each place, past it by a swing under the largest one, and
 * past rest by one under none. A swing of the amplitude a has the energy of (a/u)^2 jumps. */
static bool find_way(dea_surrogate *s, way *w)
{
    const double square = s->source.largest * s->source.largest;
    const double rest = s->dynamics.rest, step = (s->loaded - rest) / STEPS;
    double pushed = 0.0, strained = 0.0; /* energy of the jump up, and down [J] */
    for (int i = 0; i <= STEPS; i++) {
        const double u = i < STEPS ? rest + i * step : s->loaded;
        const dea_edge e = dea_dynamics_edge(&s->dynamics, u);
        const double share = i == 0 || i == STEPS ? 0.5 : 1.0;
        const double held = dea_edge_held(&s->dynamics, &e, NULL);
        pushed += share * (e.push * square - held) * step;
        strained += share * held * step;
        pass(s, u, i < STEPS ? holding_square(s, u) : square, w);
    }
    const double jumps = s->swing * s->swing;
    return w->softest > 0.0 && swing_out(s, s->loaded, step, square, jumps * pushed, w) &&
           swing_out(s, rest, -step, 0.0, jumps * strained, w);
}

/* A film that softens on its way is looked at where it is softest, too; false where nothing linear stands for it. */
static bool place_softest(dea_surrogate *s)
{
    way w = nowhere;
    pass(s, s->dynamics.rest, 0.0, &w);
    if (s->dynamics.linear || s->loaded == s->dynamics.rest) {
        pass(s, s->dynamics.rest, s->source.largest * s->source.largest, &w);
    } else if (!find_way(s, &w)) {
        return false;
    }
    s->variation = fmax(w.stiffest / w.softest, w.most / w.least) - 1.0;
    if (!s->dynamics.linear && w.u != s->dynamics.rest && w.u != s->loaded) {
        add_point(s, w.u, w.square);
    }
    return w.softest > 0.0 && w.stiffest <= most_varied * w.softest;
}

/* The current dC/du U v through R takes R of itself off the voltage, and so a drag (dC/du U)^2 R/(1 + (w R C)^2) off a film that
 * rings with w. */
static void drag_points(dea_surrogate *s, double resistance)
{
    const int count = s->point_count;
    for (int i = 0; i < count; i++) {
        dea_surrogate_point *point = &s->points[i];
        s->points[s->point_count++] = *point;
        const double held = point->passive + s->dynamics.total_share * point->viscous;
        const double omega = s->dynamics.mass > 0.0 ? sqrt(held / s->dynamics.mass) : 0.0;
        const double transduction = 2.0 * point->push * s->largest;
        const double turn = omega * resistance * s->capacitance;
        point->drag = transduction * transduction * resistance / (1.0 + turn * turn);
    }
}

/* Ages behind a corner, in time constants, between which a charging film's voltage counts as a straight line. */
static const double nodes[] = {0.05, 0.1, 0.2, 0.35, 0.55, 0.8, 1.1, 1.5, 2.0, 2.7, 3.5, 4.5, 6.0, 8.0, 11.0, 15.0, 20.0, 30.0};

static const double settled = 0.05; /* share of a sine in which its film has come to a steady state */

enum { NODES = sizeof nodes / sizeof *nodes, MOST_SEGMENTS = 2000000 };

static void add_line(dea_signal *film, double from, double to, double start, double end)
{
    if (to > from) {
        film->segments[film->count++] = (dea_segment){.from = from, .to = to, .start = start, .end = end};
    }
}

/* Voltage at age x of a segment a + b x of the source, both less what a leakage takes: y = a + b (x - T) + (y_0 - a + b T)
 * e^-x/T. */
static double charged(double a, double b, double first, double lag, double x)
{
    return a + b * (x - lag) + (first - a + b * lag) * exp(-x / lag);
}

/* Lines of one segment of the source; the voltage at its end. */
static double charge_segment(dea_signal *film, const dea_segment *source, double first, double lag, double share)
{
    const double length = source->to - source->from;
    const double a = share * source->start, b = share * (source->end - source->start) / length;
    double from = source->from, y = first;
    for (size_t k = 0; k < NODES && nodes[k] * lag < length; k++) {
        const double to = source->from + nodes[k] * lag, next = charged(a, b, first, lag, nodes[k] * lag);
        add_line(film, from, to, y, next);
        from = to;
        y = next;
    }
    const double last = charged(a, b, first, lag, length);
    add_line(film, from, source->to, y, last);
    return last;
}

/* The sine of a film that charges: smaller by 1/(1 + i w T), and late. */
static void charge_sine(dea_curve *curve, double lag, double share)
{
    dea_tone *sine = &curve->tones[0];
    const double turn = 2.0 * DEA_PI * sine->frequency * lag;
    curve->offset *= share;
    sine->amplitude *= share / hypot(1.0, turn);
    sine->phase -= atan(turn);
}

static void see_largest(dea_surrogate *s)
{
    const dea_signal *film = &s->film;
    s->largest = 0.0;
    for (size_t i = 0; i < film->count; i++) {
        s->largest = fmax(s->largest, dea_segment_largest(film, &film->segments[i]));
    }
}

/* The voltage of a film that charges with that time constant to that share of the source's; false without the memory, or where a
 * sine does not come to its steady state. */
static bool charge_film(dea_surrogate *s, double lag, double share)
{
    dea_signal *film = &s->film;
    double y = s->scene->transient.from_bias ? share * s->source.segments[0].start : 0.0;
    *film = (dea_signal){.curve = s->source.curve};
    charge_sine(&film->curve, lag, share);
    if (s->source.count < MOST_SEGMENTS / (NODES + 1)) {
        film->segments = malloc(s->source.count * (NODES + 1) * sizeof *film->segments);
    }
    for (size_t i = 0; film->segments && i < s->source.count; i++) {
        const dea_segment *source = &s->source.segments[i];
        if (!source->sine) {
            y = charge_segment(film, source, y, lag, share);
            continue;
        }
        dea_segment *segment = &film->segments[film->count++];
        *segment = *source;
        segment->start = dea_segment_voltage(film, source, source->from);
        segment->end = y = dea_segment_voltage(film, source, source->to);
        if (lag > settled * (source->to - source->from)) {
            return false;
        }
    }
    see_largest(s);
    return film->segments != NULL && s->largest > 0.0;
}

void dea_surrogate_close(dea_surrogate *s)
{
    dea_dynamics_close(&s->dynamics);
    dea_signal_close(&s->source);
    dea_signal_close(&s->film);
    free(s->walk);
    free(s->probes);
    free(s->ages);
}

static void set_walk(dea_surrogate *s, const dea_reduction *reduction, const dea_surrogate_point *point)
{
    dea_scene reduced = *s->scene;
    dea_dynamics d = s->dynamics; /* borrows its tapes */
    reduced.reduction = *reduction;
    (void)dea_dynamics_relax(&d, &reduced);
    d.mass = reduction->mass ? 0.0 : d.mass;
    const double whole = 1.0 + d.held;
    const double slope = reduction->softening ? 0.0 : point->push_slope;
    const bool charging = s->film.count > 0 && !reduction->series;
    *s->walk = (dea_walk){.signal = charging ? &s->film : &s->source,
                          .every = s->scene->transient.every,
                          .from_bias = s->scene->transient.from_bias,
                          .chain = dea_walk_chain(&d, whole * point->viscous)};
    s->walk->chain.damping += charging ? point->drag : 0.0;
    s->walk->chain.stiffness = whole * (point->passive - point->tension) + point->tension - slope * point->square;
    s->walk->linear.softening = point->square > 0.0 || !s->dynamics.linear ? 0.0 : -slope;
    s->walk->linear.force = point->push;
}

/* Adds what a segment does to the means. */
static void walk_windows(const dea_surrogate *s, const dea_piece *piece, const dea_course *start, double *means)
{
    const dea_segment *segment = piece->segment;
    for (size_t i = 0; i < s->scene->transient.average_count; i++) {
        const dea_window *window = &s->scene->transient.averages[i];
        const double from = fmax(window->from - segment->from, 0.0), to = fmin(window->to - segment->from, piece->length);
        if (from < to) {
            means[i] += dea_piece_integral(piece, &s->walk->now->modes, start, from, to) / (window->to - window->from);
        }
    }
}

static bool walk_probes(dea_surrogate *s, double *u, double *v)
{
    dea_walk *walk = s->walk;
    size_t probe = 0;
    for (size_t i = s->sampled; i < s->count; i++) {
        u[i] = v[i] = 0.0;
    }
    for (size_t i = 0; i < walk->signal->count; i++) {
        const dea_segment *segment = &walk->signal->segments[i];
        if (dea_walk_enter(walk, segment, NULL) != DEA_OK || walk->lost) {
            return false;
        }
        dea_course start;
        const dea_piece piece = dea_walk_piece(walk, segment, &start);
        for (; probe < s->sampled; probe++) {
            const double time = dea_layout_place(s->scene, s->probes[probe]);
            if (time > segment->to) {
                break;
            }
            const dea_motion motion = dea_walk_motion(walk, &piece, &start, time - segment->from);
            u[probe] = motion.u;
            v[probe] = motion.v;
        }
        walk_windows(s, &piece, &start, u + s->sampled);
        dea_walk_pass(walk, &piece, &start);
    }
    return probe == s->sampled;
}

bool dea_surrogate_solve(dea_surrogate *s, const dea_reduction *reduction, dea_surrogate_answer answer)
{
    for (int i = 0; i < s->point_count; i++) {
        set_walk(s, reduction, &s->points[i]);
        if (!walk_probes(s, answer.u + (size_t)i * s->count, answer.v + (size_t)i * s->count)) {
            return false;
        }
    }
    return true;
}

/* ---- the swing */

/* Amplitude of the pair of modes about the equilibrium at the begin of a piece: its speed over s; of a sine what the film moves
 * more than it would at rest [m]. */
static double amplitude_of(const dea_walk *w, const dea_piece *piece, const dea_course *start)
{
    const dea_modes *modes = &w->now->modes;
    if (!modes->pair || modes->square >= 0.0) {
        return 0.0;
    }
    const double turn = -modes->square; /* omega^2 */
    const dea_dual speed = start->speed.pair;
    double amplitude =
        sqrt((speed.even * speed.even + speed.odd * speed.odd * turn) / (turn * (modes->sigma * modes->sigma + turn)));
    for (int k = 0; k < DEA_HARMONICS; k++) {
        amplitude += fmax(0.0, cabs(piece->displacement[k]) - cabs(piece->harmonics[k]) / modes->chain.stiffness);
    }
    return amplitude;
}

/* Time in which the mass counts: that in which the swing decays, or the fastest root of a film that does not swing [s]. */
static double fading_of(const dea_modes *modes, double until)
{
    double rate = 0.0;
    if (modes->pair) {
        rate = fabs(modes->sigma) + (modes->square > 0.0 ? sqrt(modes->square) : 0.0);
    } else {
        for (size_t i = 0; i < modes->count; i++) {
            rate = fmax(rate, fabs(modes->roots[i].value));
        }
    }
    return rate * until > 1.0 ? 1.0 / rate : until;
}

/* Largest swing over the run, seen by samples or not; false where the stand-ins have no answer. */
static bool look_at_swing(dea_surrogate *s)
{
    const dea_reduction nothing = {0};
    dea_walk *walk = s->walk;
    for (int k = 0; k < s->point_count && s->dynamics.mass > 0.0; k++) {
        const dea_surrogate_point *point = &s->points[k];
        const double still = fabs(point->push) * s->largest * s->largest / (point->passive - point->push_slope * point->square);
        set_walk(s, &nothing, point);
        for (size_t i = 0; i < walk->signal->count; i++) {
            dea_course start;
            const dea_segment *segment = &walk->signal->segments[i];
            if (dea_walk_enter(walk, segment, NULL) != DEA_OK || walk->lost) {
                return false;
            }
            const dea_piece piece = dea_walk_piece(walk, segment, &start);
            s->swing = fmax(s->swing, amplitude_of(walk, &piece, &start) / still);
            s->fading = fmax(s->fading, fading_of(&walk->now->modes, s->scene->transient.until));
            dea_walk_pass(walk, &piece, &start);
        }
    }
    return true;
}

/* Share of the source's voltage that a leakage leaves. */
static double share_of(const dea_surrogate *s)
{
    return 1.0 / (1.0 + s->dynamics.series * s->dynamics.conductance);
}

double dea_surrogate_lag(const dea_surrogate *s)
{
    return s->dynamics.series * s->capacitance * share_of(s);
}

const dea_signal *dea_surrogate_signal(const dea_surrogate *s)
{
    return s->film.count > 0 ? &s->film : &s->source;
}

dea_status dea_surrogate_open(const dea_scene *scene, const dea_model *model, dea_surrogate *s, bool *usable, dea_error *error)
{
    dea_scene full = *scene; /* borrows what the scene owns */
    full.reduction = (dea_reduction){0};
    *s = (dea_surrogate){.scene = scene};
    *usable = false;
    dea_status status = dea_dynamics_open(&full, model, &s->dynamics, error);
    if (status == DEA_OK) {
        status = dea_signal_open(scene, &s->source, error);
    }
    if (status != DEA_OK) {
        return status;
    }
    s->walk = malloc(sizeof *s->walk);
    if (!s->walk || !place_probes(s)) {
        return dea_fail(error, DEA_ERROR_MEMORY, "out of memory while a run is planned");
    }
    s->largest = s->source.largest;
    const bool charging = s->dynamics.series > 0.0;
    *usable = s->count > 0 && s->largest > 0.0 && (s->source.curve.count == 0 || dea_curve_is_plain(&s->source.curve)) &&
              place_points(s);
    if (*usable && charging) {
        *usable = charge_film(s, dea_surrogate_lag(s), share_of(s));
    }
    *usable = *usable && look_at_swing(s) && place_softest(s);
    if (*usable && charging) {
        s->coupling = 2.0 * (s->capacitance / s->least_capacitance - 1.0);
        s->variation += s->coupling;
        drag_points(s, s->dynamics.series * share_of(s));
    }
    return DEA_OK;
}
