#include "engine/ngspice/track.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "support/grow.h"

/* Most time steps of one netlist: what its plot takes of memory. */
static const double most_steps = 300000.0;

/* Work of a step and of a netlist, in steps of a linear network, of films of linear springs and of others. */
static const double step_work[2] = {1.0, 5.0}, netlist_work[2] = {300.0, 500.0};

/* Share of a step within which a film charges at once. */
static const double at_once = 1e-2;

/* Steps over a time of the network, above which the trapezoidal rule turns the sign of what is left of its motion at every step.
 */
static const double alternating = 2.0;

/* Rates of the states that steps do not resolve: what is left of a fast motion alternates there from step to step, and where a
 * rate is a small difference over a short time, such as (S - z)/tau, it drowns. Their slopes over two steps leave it out,
 * (y(t + h) - y(t - h))/2h, with an error that is even in h as the rule's own. */
typedef struct fast_rates {
    bool any, u, charge; /* which */
    bool z[DEA_RELAXED_MAX];
} fast_rates;

typedef struct slopes {
    double u, charge; /* [m/s], [A] */
    double z[DEA_RELAXED_MAX];
} slopes;

/* An accepted point of the library with the slopes that go with it inside one segment. */
typedef struct node {
    dea_moment moment;
    dea_mobility_state state;
    double stress[DEA_STRESSES];  /* S_a */
    double acceleration;          /* with mass [m/s^2] */
    double current;               /* slope of the charge, with series resistance [A] */
    double rate[DEA_RELAXED_MAX]; /* slopes of z */
    double complex change;        /* what correct() has added [m] */
} node;

typedef struct runner {
    const dea_route *route;
    dea_track *track;
    dea_matching match;
    bool rings; /* so does the film in this piece */
    bool slow;  /* the piece steps over the ring, which is dead */
    double step;
    double parts;           /* of an edge that is shorter than a step */
    double loose;           /* absolute tolerances over the tightest, since the last collapse of the library's steps */
    double speed;           /* velocities of the film over those of the matched network [1] */
    bool cut;               /* the netlist ended early: the source came to its limit or from it */
    bool euler;             /* the next step is the first behind a corner */
    double complex lag;     /* what irregular steps since the last corner did to a ring: to multiply by */
    double complex carried; /* what those before it did: to add [m] */
    size_t segment;
    fast_rates fast;
    dea_mobility_state before; /* the state before the last point, */
    double before_time;        /* at that time, if it lies in the segment [s] */
    node last;                 /* in the segment that begins there */
    double pending;            /* weight of its powers [s] */
} runner;

double dea_route_voltage(const dea_route *route, double source, double u, double charge)
{
    return route->dynamics->series > 0.0 ? charge / dea_dynamics_edge(route->dynamics, u).capacitance : source;
}

/* m u'' = phi U^2 less what the film holds, its damper too. */
static double acceleration(const dea_dynamics *d, const dea_edge *e, const node *n)
{
    const double held = dea_edge_held(d, e, n->state.z) + dea_edge_resistance(d, e) * n->moment.v;
    return (e->push * n->moment.voltage * n->moment.voltage - held) / d->mass;
}

/* Stress and branch of z number @p k. */
static double stress_of(const dea_dynamics *d, const node *n, size_t k)
{
    return n->stress[k / d->branch_count];
}

static double tau_of(const dea_dynamics *d, size_t k)
{
    return d->branches[k % d->branch_count].tau;
}

/* Rates of the branches: (S - z)/tau, or the slopes of those that are too fast for the steps. */
static void set_rates(const runner *r, node *n, const slopes *slope)
{
    const dea_dynamics *d = r->route->dynamics;
    for (size_t i = 0; i < dea_dynamics_states(d); i++) {
        n->rate[i] = slope && r->fast.z[i] ? slope->z[i] : (stress_of(d, n, i) - n->state.z[i]) / tau_of(d, i);
    }
}

/* Velocity of a film without mass, or, at a point without neighbours, of one whose ring has died away: what is left of that would
 * count too much over a long step. */
static void set_velocity(const runner *r, const dea_edge *e, node *n)
{
    dea_dynamics *d = r->route->slow;
    dea_moment *m = &n->moment;
    double z[DEA_RELAXED_MAX]; /* that go with the rates */
    for (size_t i = 0; i < dea_dynamics_states(d); i++) {
        z[i] = r->fast.z[i] ? stress_of(d, n, i) - tau_of(d, i) * n->rate[i] : n->state.z[i];
    }
    if (d->series > 0.0) {
        const double slope = n->current / e->capacitance;
        m->v = dea_dynamics_velocity_charged(d, m->u, m->voltage, slope, z);
        m->slope = slope - e->capacitance_slope * m->voltage / e->capacitance * m->v;
    } else {
        m->v = dea_dynamics_velocity(d, m->u, m->voltage, m->slope, z);
    }
}

/* True where the film charges at once against the time in which it swings by a radian or moves by half of its size. */
static bool charges_at_once(const runner *r, const node *n, double time)
{
    const double pace = fmax(r->route->omega, 2.0 * fabs(n->moment.v) / (r->route->dynamics->radius + n->moment.u));
    return time < r->step && pace * time < 0.2 * at_once;
}

/* A film that charges at once: the drop over R_s, a difference of almost equal voltages, follows from i = d(C U)/dt with
 * U' = U_s' - R_s i' instead, where i' is C U_s'' + 2 C' u' U_s' + (C' u'' + C'' u'^2) U_s; C' = 2 phi. (R_s C)^2 i'' is left
 * out: that is nothing where the film charges within a small part of a step, and for a sample where that is of its own pace. */
static void follow_source(const runner *r, const dea_edge *e, node *n)
{
    const dea_dynamics *d = r->route->dynamics;
    const dea_signal *signal = r->route->signal;
    const dea_segment *segment = &signal->segments[r->segment];
    const double time = d->series * e->capacitance;
    const bool turns = d->mass > 0.0 && !r->slow && charges_at_once(r, n, time);
    const bool limited = dea_dynamics_excess(d, n->moment.source - n->moment.voltage) >= 0.0;
    if (limited || (time >= at_once * r->step && !turns)) {
        return;
    }
    dea_moment *m = &n->moment;
    const double rate = dea_segment_slope(signal, segment, m->time);
    const double bend = e->capacitance * dea_segment_curvature(signal, segment, m->time) +
                        2.0 * e->capacitance_slope * m->v * rate +
                        (e->capacitance_slope * n->acceleration + 2.0 * e->push_slope * m->v * m->v) * m->source;
    const double slope = rate - d->series * bend;
    const double motional = e->capacitance_slope * m->v; /* C' u' U = C' u' (U_s - R_s i) */
    n->current = (e->capacitance * slope + motional * m->source) / (1.0 + d->series * motional);
    if (time < at_once * r->step) {
        m->slope = slope;
        m->voltage = m->source - d->series * (n->current + m->source * d->conductance);
        m->charging = true;
        m->charge_slope = n->current;
    }
}

/* True where the equation of motion itself gives the velocity's slope. */
static bool is_heavy(const runner *r)
{
    return r->route->dynamics->mass > 0.0 && !r->fast.u;
}

/* A state at a time inside the segment, with the slopes of what is too fast for the steps, NULL: all is resolved. The velocity of
 * a film without mass follows from the rest. */
static node node_at(const runner *r, double time, const dea_mobility_state *state, const slopes *slope)
{
    const dea_route *route = r->route;
    dea_dynamics *d = route->dynamics;
    const dea_segment *segment = &route->signal->segments[r->segment];
    const dea_edge e = dea_dynamics_edge(d, state->u);
    node n = {.state = *state, .moment = {.time = time, .u = state->u, .v = state->v}};
    memcpy(n.stress, e.stress, d->stress_count * sizeof *n.stress);
    n.moment.source = dea_segment_voltage(route->signal, segment, time);
    n.moment.slope = dea_segment_slope(route->signal, segment, time);
    n.moment.voltage = d->series > 0.0 ? state->charge / e.capacitance : n.moment.source;
    if (d->series > 0.0) {
        n.current = slope && r->fast.charge
                        ? slope->charge
                        : dea_dynamics_flow(d, n.moment.source - n.moment.voltage) - n.moment.voltage * d->conductance;
    }
    set_rates(r, &n, slope);
    if (slope && r->fast.u) {
        n.moment.v = slope->u;
    } else if (is_heavy(r)) {
        n.acceleration = acceleration(d, &e, &n);
    } else {
        set_velocity(r, &e, &n);
    }
    if (d->series > 0.0) {
        follow_source(r, &e, &n);
    }
    return n;
}

/* Cubic through two values and slopes, at x = 0 ... 1 of the interval @p h. */
static double cubic(double a, double slope_a, double b, double slope_b, double h, double x)
{
    const double y = 1.0 - x;
    return a * y * y * (1.0 + 2.0 * x) + b * x * x * (1.0 + 2.0 * y) + h * x * y * (slope_a * y - slope_b * x);
}

/* Its slope. */
static double cubic_slope(double a, double slope_a, double b, double slope_b, double h, double x)
{
    const double y = 1.0 - x;
    return 6.0 * x * y * (b - a) / h + slope_a * y * (y - 2.0 * x) + slope_b * x * (x - 2.0 * y);
}

/* Quintic through two values, slopes and curvatures. */
static double quintic(const node *a, const node *b, double h, double x)
{
    const double y = 1.0 - x;
    const double x3 = x * x * x;
    const double y3 = y * y * y;
    return a->moment.u * y3 * (1.0 + 3.0 * x + 6.0 * x * x) + b->moment.u * x3 * (1.0 + 3.0 * y + 6.0 * y * y) +
           h * (a->moment.v * y3 * x * (1.0 + 3.0 * x) - b->moment.v * x3 * y * (1.0 + 3.0 * y)) +
           0.5 * h * h * (a->acceleration * y3 * x * x + b->acceleration * x3 * y * y);
}

/* Slopes between two points of one segment. */
static slopes slopes_between(const runner *r, const node *a, const node *b, double x)
{
    const double h = b->moment.time - a->moment.time;
    slopes s = {.u = cubic_slope(a->moment.u, a->moment.v, b->moment.u, b->moment.v, h, x),
                .charge = cubic_slope(a->state.charge, a->current, b->state.charge, b->current, h, x)};
    for (size_t i = 0; i < dea_dynamics_states(r->route->dynamics); i++) {
        s.z[i] = cubic_slope(a->state.z[i], a->rate[i], b->state.z[i], b->rate[i], h, x);
    }
    return s;
}

/* Displacement between two points of one segment. */
static double place_between(const runner *r, const node *a, const node *b, double time)
{
    const double h = b->moment.time - a->moment.time;
    const double x = (time - a->moment.time) / h;
    return is_heavy(r) ? quintic(a, b, h, x) : cubic(a->moment.u, a->moment.v, b->moment.u, b->moment.v, h, x);
}

/* State between two points of one segment. */
static node between(const runner *r, const node *a, const node *b, double time)
{
    const double h = b->moment.time - a->moment.time;
    const double x = (time - a->moment.time) / h;
    dea_mobility_state s = {.charge = cubic(a->state.charge, a->current, b->state.charge, b->current, h, x)};
    for (size_t i = 0; i < dea_dynamics_states(r->route->dynamics); i++) {
        s.z[i] = cubic(a->state.z[i], a->rate[i], b->state.z[i], b->rate[i], h, x);
    }
    s.u = place_between(r, a, b, time);
    if (is_heavy(r)) {
        s.v = cubic(a->moment.v, a->acceleration, b->moment.v, b->acceleration, h, x);
    }
    const slopes slope = r->fast.any ? slopes_between(r, a, b, x) : (slopes){0};
    return node_at(r, time, &s, r->fast.any ? &slope : NULL);
}

/* Adds the step to the point @p b to the windows, by Gauss's rule of three points: exact for the quintic in between. */
static void integrate(runner *r, const node *b)
{
    static const double places[] = {-0.77459666924148337704, 0.0, 0.77459666924148337704};
    static const double weights[] = {5.0 / 9.0, 8.0 / 9.0, 5.0 / 9.0};
    const dea_transient *transient = &r->route->scene->transient;
    for (size_t i = 0; i < transient->average_count; i++) {
        const double from = fmax(transient->averages[i].from, r->last.moment.time);
        const double to = fmin(transient->averages[i].to, b->moment.time);
        const double middle = 0.5 * (from + to), half = 0.5 * (to - from);
        for (int k = 0; k < 3 && half > 0.0; k++) {
            r->track->integrals[i] += half * weights[k] * place_between(r, &r->last, b, middle + half * places[k]);
        }
    }
}

/* The step from the last point to another. */
typedef struct stretch {
    runner *runner;
    const node *end;
} stretch;

/* Current of the source within it [A]. */
static double current_at(void *user, double time)
{
    const stretch *s = user;
    const node *a = &s->runner->last, *b = s->end;
    const node n = time <= a->moment.time ? *a : time >= b->moment.time ? *b : between(s->runner, a, b, time);
    dea_dynamics *d = s->runner->route->dynamics;
    return d->series > 0.0 ? n.current + n.moment.voltage * d->conductance : dea_dynamics_current(d, &n.moment);
}

static void see_current(runner *r, const node *b)
{
    stretch s = {r, b};
    if (r->route->peaks) {
        dea_peak_search(&r->track->peak, r->last.moment.time, b->moment.time, current_at, &s);
    }
}

/* The edge lies between centre and frame. A film of linear springs knows no frame: of what it does there only the samples tell; but what
 * charges it through a resistance ends with its capacitance. */
static bool is_inside(dea_dynamics *d, const node *n)
{
    const double u = n->moment.u;
    if (!isfinite(u) || !isfinite(n->moment.v)) {
        return false;
    }
    return d->framed ? dea_dynamics_inside(d, u) : d->series == 0.0 || dea_dynamics_edge(d, u).capacitance > 0.0;
}

/* What a sample sees where its segment stands for lines: the voltage of the line, and the velocity that a damper lets it have. */
static void see_line(const runner *r, node *n)
{
    dea_dynamics *d = r->route->dynamics;
    const dea_segment *line = dea_segment_seen(&r->route->signal->segments[r->segment], n->moment.time);
    if (d->mass > 0.0 || line == &r->route->signal->segments[r->segment]) {
        return;
    }
    const dea_edge e = dea_dynamics_edge(d, n->moment.u);
    n->moment.source = n->moment.voltage = dea_segment_voltage(r->route->signal, line, n->moment.time);
    n->moment.slope = dea_segment_slope(r->route->signal, line, n->moment.time);
    set_velocity(r, &e, n);
}

/* Takes the samples up to the point @p b, or up to where the film leaves its frame before that. */
static void take_samples(runner *r, const node *b)
{
    dea_track *track = r->track;
    while (track->reached < r->route->samples) {
        const double time = dea_layout_place(r->route->scene, track->reached);
        if (time > b->moment.time) {
            return;
        }
        node n = *b;
        if (time < b->moment.time) {
            n = between(r, &r->last, b, time);
        }
        see_line(r, &n);
        if (!is_inside(r->route->dynamics, &n)) {
            return;
        }
        track->points[track->reached++] = (dea_track_point){n.moment.u, n.moment.v, n.state.charge, n.current};
    }
}

/* Powers by Simpson's rule over each step. */
static void add_power(runner *r, const node *n, double weight)
{
    if (weight > 0.0) {
        dea_audit_add(&r->track->audit, r->route->dynamics, &n->moment, n->state.z, weight);
    }
}

static void add_step(runner *r, const node *b)
{
    const node *a = &r->last;
    const double h = b->moment.time - a->moment.time;
    const node middle = between(r, a, b, 0.5 * (a->moment.time + b->moment.time));
    add_power(r, a, r->pending + h / 6.0);
    add_power(r, &middle, 4.0 * h / 6.0);
    r->pending = h / 6.0;
}

/* The powers of the last point that are still open. */
static void settle(runner *r)
{
    add_power(r, &r->last, r->pending);
    r->pending = 0.0;
}

/* Displacement of the ring at a point, as a complex amplitude A: u = Re A, v = Re sA, u'' = Re s^2 A. */
static double complex ring_at(double complex s, const node *n)
{
    const double d = -creal(s);
    const double w = cimag(s);
    const double a = -(n->acceleration + 2.0 * d * n->moment.v) / (w * w + d * d);
    return a - I * (n->moment.v + d * a) / w;
}

/* Behind a corner the library's steps grow from a hundredth to their full length, on which alone the network is matched: each
 * takes (1 + S h/2)/(1 - S h/2) for exp(s h). What that did to the ring is put right; it goes with h^3. */
static void correct(runner *r, double step, node *n)
{
    const dea_segment *segment = &r->route->signal->segments[r->segment];
    const double complex s = r->match.ring;
    if (cimag(s) == 0.0) {
        return;
    }
    if (r->carried != 0.0) {
        r->carried *= cexp(s * step);
    }
    if (fabs(step - r->step) > 1e-9 * r->step && (segment->terms || (!segment->sine && segment->start == segment->end))) {
        const double complex half = 0.5 * step * r->match.root;
        const double complex lag = cexp(s * step) * (r->euler ? 1.0 - 2.0 * half : (1.0 - half) / (1.0 + half));
        if (segment->terms) { /* the film follows its drive, and what a step does to its swing about that is free from there on */
            r->carried += (lag - 1.0) * (ring_at(s, n) + r->carried);
        } else {
            r->lag *= lag;
        }
    }
    r->euler = false;
    const double complex change = r->carried + (r->lag - 1.0) * ring_at(s, n);
    n->moment.u += creal(change);
    n->moment.v += creal(s * change);
    n->acceleration += creal(s * s * change);
    n->state.u = n->moment.u;
    n->state.v = n->moment.v;
    n->change = change;
}

/* Goes on from @p time in its segment. */
static void enter_segment(runner *r, double time, double next)
{
    const dea_signal *signal = r->route->signal;
    const size_t segment = dea_signal_find(signal, r->segment, 0.5 * (time + next));
    if (segment != r->segment) {
        const dea_mobility_state state = r->last.state;
        settle(r);
        r->segment = segment;
        r->carried = r->last.change;
        r->lag = 1.0;
        r->euler = true;
        r->last = node_at(r, time, &state, NULL);
        r->before_time = time;
    }
}

/* Inside; and a film without mass and damper stays where its branches and its charge, held, keep it stable. */
static bool is_possible(const runner *r, const node *n)
{
    dea_dynamics *d = r->route->dynamics;
    return is_inside(d, n) && (!dea_dynamics_is_free(d) || dea_dynamics_hold(d, n->moment.u, n->moment.voltage, n->state.z) > 0.0);
}

/* Why the run ends: the film has lost its stability there or, unless its charge holds it, will find no equilibrium, or another
 * reason. */
static dea_state verdict(const runner *r)
{
    dea_dynamics *d = r->route->dynamics;
    const dea_segment *segment = &r->route->signal->segments[r->segment];
    const double rest = dea_dynamics_stiffness(d, 0.0, 0.0, false);
    const double here = dea_dynamics_hold(d, r->last.moment.u, r->last.moment.voltage, r->last.state.z);
    double u;
    const double most = fmin(r->route->voltage, fmax(fabs(segment->start), fabs(segment->end)));
    const double voltage = d->series > 0.0 ? fmax(most, fabs(r->last.moment.voltage)) : most;
    const bool charged = dea_dynamics_is_free(d) && d->series > 0.0;
    const bool lost = here < 1e-3 * rest || (!charged && !dea_dynamics_equilibrium(d, voltage, &u));
    return lost ? DEA_STATE_PULL_IN : DEA_STATE_FAILED;
}

/* How near to its end a film is still asked for its force, relative: with an exponent of two a lens has stopped 1e-8 before the centre. */
static const double nearest = 1e-12;

/* What moves the film where it stands still [N]; not finite past the end of its material. */
static double push_at(dea_dynamics *d, double u, double voltage)
{
    const dea_edge e = dea_dynamics_edge(d, u);
    return e.push * voltage * voltage - dea_edge_held(d, &e, NULL);
}

/* True where the film turns back before the frame or the centre that @p n lies behind, or the end of its material before these: the
 * stress of what gets narrow or straight there grows beyond all bounds, against the motion unless the material has lost its stiffness. */
static bool turns_back(const runner *r, const node *n)
{
    dea_dynamics *d = r->route->dynamics;
    const double voltage = n->moment.voltage;
    double low = r->last.moment.u, high = (1.0 - nearest) * (n->moment.u > 0.0 ? d->point.frame_radius - d->radius : -d->radius);
    double force = push_at(d, high, voltage);
    while (!isfinite(force) && fabs(high - low) > nearest * fabs(high)) {
        const double middle = 0.5 * (low + high);
        *(isfinite(push_at(d, middle, voltage)) ? &low : &high) = middle;
    }
    force = isfinite(force) ? force : push_at(d, low, voltage);
    return d->framed && isfinite(n->moment.u) && force * high < 0.0;
}

/* Mass or damper carry the film out of its frame: pull_in. Where it would turn back the steps are too long. */
static void leave(runner *r, const node *n)
{
    r->track->bounces = turns_back(r, n);
    r->track->end = r->track->bounces ? DEA_STATE_FAILED : DEA_STATE_PULL_IN;
    if (!r->track->bounces) {
        take_samples(r, n);
    }
}

/* Slope at @p time of the parabola through three values. */
static double parabola_slope(const double time[3], double a, double b, double c, double at)
{
    const double left = (b - a) / (time[1] - time[0]), right = (c - b) / (time[2] - time[1]);
    return left + (right - left) * (2.0 * at - time[0] - time[1]) / (time[2] - time[0]);
}

/* Slopes over three points, at the time of one of them. */
static slopes slopes_over(const runner *r, const double time[3], const dea_mobility_state *const state[3], double at)
{
    slopes s = {.u = parabola_slope(time, state[0]->u, state[1]->u, state[2]->u, at),
                .charge = parabola_slope(time, state[0]->charge, state[1]->charge, state[2]->charge, at)};
    for (size_t i = 0; i < dea_dynamics_states(r->route->dynamics); i++) {
        s.z[i] = r->fast.z[i] ? parabola_slope(time, state[0]->z[i], state[1]->z[i], state[2]->z[i], at) : 0.0;
    }
    return s;
}

/* The point at hand and, in its segment, the one behind it: next_time <= time where there is none. */
typedef struct ahead {
    double time, next_time;
    dea_mobility_state state, next;
} ahead;

/* Reads a point with its neighbours; the first of a segment is read anew once those behind it are known. */
static node read_point(runner *r, const ahead *p)
{
    const bool follows = p->next_time > p->time, alone = !(r->before_time < r->last.moment.time);
    if (!r->fast.any || (alone && !follows)) {
        return node_at(r, p->time, &p->state, NULL);
    }
    const dea_mobility_state last = r->last.state;
    const double ends[3] = {r->before_time, r->last.moment.time, p->time};
    const double middle[3] = {r->last.moment.time, p->time, p->next_time};
    const dea_mobility_state *const behind[3] = {&r->before, &last, &p->state};
    const dea_mobility_state *const around[3] = {&last, &p->state, &p->next};
    if (alone) {
        const slopes first = slopes_over(r, middle, around, r->last.moment.time);
        const double complex change = r->last.change;
        r->last = node_at(r, r->last.moment.time, &last, &first);
        r->last.change = change;
    }
    const slopes here = follows ? slopes_over(r, middle, around, p->time) : slopes_over(r, ends, behind, p->time);
    return node_at(r, p->time, &p->state, &here);
}

/* Next to its limit a source counts as there: such shares of the drop at the limit are rounding. */
static const double at_limit = 1e-9;

static double excess_of(const runner *r, const node *n)
{
    return dea_dynamics_excess(r->route->dynamics, n->moment.source - n->moment.voltage);
}

static void note_cut(dea_cuts *cuts, double time)
{
    double *times = dea_grow(cuts->times, cuts->count, &cuts->room, sizeof *times);
    if (!times) {
        cuts->exhausted = true;
        return;
    }
    cuts->times = times;
    times[cuts->count++] = time;
}

/* Where the source comes to its limit or from it before the point @p n, the point there takes its place: the current has a corner
 * there, which no step may pass. */
static void cut_short(runner *r, node *n)
{
    const double first = excess_of(r, &r->last), last = excess_of(r, n);
    double low = r->last.moment.time, high = n->moment.time;
    if (!isfinite(r->route->dynamics->limit) || !(first * last < 0.0) || fabs(first) < at_limit) {
        return;
    }
    const node end = *n;
    for (int i = 0; i < 60 && high - low > 4e-16 * high; i++) {
        const double middle = 0.5 * (low + high);
        const node there = between(r, &r->last, &end, middle);
        *(excess_of(r, &there) * first > 0.0 ? &low : &high) = middle;
    }
    if (high < end.moment.time && high > r->last.moment.time) {
        *n = between(r, &r->last, &end, high);
        r->cut = true;
    }
}

/* Takes one more point; false where the film has left what it can do, or the netlist ends early. */
static bool advance(runner *r, const ahead *p)
{
    enter_segment(r, r->last.moment.time, p->time);
    node n = read_point(r, p);
    correct(r, p->time - r->last.moment.time, &n);
    cut_short(r, &n);
    if (!is_possible(r, &n)) {
        if (dea_dynamics_is_free(r->route->dynamics)) {
            r->track->end = verdict(r); /* Newton's method may have found a root of no film */
        } else {
            leave(r, &n);
        }
        return false;
    }
    add_step(r, &n);
    integrate(r, &n);
    see_current(r, &n);
    take_samples(r, &n);
    r->before = r->last.state;
    r->before_time = r->last.moment.time;
    r->last = n;
    if (r->cut) {
        r->before_time = n.moment.time; /* slopes do not go on */
    }
    if (r->cut && r->route->cuts) {
        note_cut(r->route->cuts, n.moment.time);
    }
    return !r->cut;
}

static dea_mobility_state scaled(dea_mobility_state state, double speed)
{
    state.v *= speed;
    return state;
}

/* True where the piece that goes to @p to begins behind a corner of the drive, by what is over of a ring or a kick at a damper, and meets no
 * other. Steps there begin short: what is fast has died, and stays so. */
static bool is_calm(const runner *r, double to)
{
    const dea_segment *segment = &r->route->signal->segments[r->segment];
    return r->last.moment.time > segment->from && to <= segment->to;
}

/* Which rates the steps do not resolve: a branch; a film that charges, but for what follow_source() sees; the velocity of a
 * damper that bridges springs, r/K, or that a damper holds against the mass, m/r, unless nothing kicks it; or of a film whose dead ring
 * the steps pass over: one that stiffens as it moves may be kicked into another, which its balance without mass would not show. */
static void find_fast(runner *r, double to)
{
    dea_dynamics *d = r->route->dynamics;
    const dea_edge e = dea_dynamics_edge(d, r->last.moment.u);
    const double resistance = dea_edge_resistance(d, &e), limit = r->step / alternating;
    const double held = dea_dynamics_stiffness(d, r->last.moment.u, r->last.moment.voltage, false);
    const double settled = r->rings || is_calm(r, to) ? (double)INFINITY : d->mass / resistance;
    const double heavy = r->slow ? 0.0 : d->mass > 0.0 ? settled : resistance / held;
    const bool moves = !dea_dynamics_is_free(d) && heavy < limit;
    r->fast = (fast_rates){.u = moves, .charge = d->series > 0.0 && d->series * e.capacitance < limit && !r->rings};
    r->fast.any = r->fast.u || r->fast.charge;
    for (size_t i = 0; i < dea_dynamics_states(d); i++) {
        r->fast.z[i] = tau_of(d, i) < limit;
        r->fast.any = r->fast.any || r->fast.z[i];
    }
}

/* Reads the last point anew as the piece does; rates that it does not resolve stay, but for those of a corner. */
static void start_again(runner *r)
{
    const dea_mobility_state state = r->last.state;
    slopes known = {.u = r->last.moment.v, .charge = r->last.current};
    memcpy(known.z, r->last.rate, sizeof known.z);
    settle(r);
    r->last = node_at(r, r->last.moment.time, &state, r->before_time < r->last.moment.time ? &known : NULL);
}

double dea_track_work(const dea_route *route, double points, double netlists)
{
    const bool bent = !route->dynamics->linear;
    return step_work[bent] * points + netlist_work[bent] * netlists;
}

/* Work that is left. Counted, not timed: whatever else the machine does, the same run ends at the same place. */
static double work_left(const dea_route *route, const dea_track *track)
{
    return route->most > 0.0 ? route->most - dea_track_work(route, track->steps, track->netlists) : (double)INFINITY;
}

/* Points that a netlist may take; one at least, so that the run can end there. */
static double points_left(const runner *r)
{
    const double left = work_left(r->route, r->track);
    return isfinite(left) ? fmax(1.0, left / step_work[!r->route->dynamics->linear]) : 0.0;
}

static void set_piece(runner *r, dea_mobility_piece *piece, double to, double step)
{
    const dea_route *route = r->route;
    const dea_segment *segment = &route->signal->segments[r->segment];
    const double voltage = fabs(segment->end) > fabs(segment->start) ? segment->end : segment->start;
    double u = 0.0;
    const bool there = dea_dynamics_equilibrium(route->dynamics, voltage, &u);
    r->match = dea_matching_of(route->dynamics, there ? u : 0.0, there ? voltage : 0.0, r->rings ? step : (double)INFINITY);
    r->speed = r->match.mass > 0.0 ? sqrt(r->match.mass / route->dynamics->mass) : 1.0;
    r->step = step;
    r->slow = !r->rings && route->omega * step > 2.0;
    r->cut = false;
    r->lag = 1.0;
    r->carried = 0.0;
    r->euler = true;
    find_fast(r, to);
    start_again(r);
    *piece = (dea_mobility_piece){.signal = route->signal,
                                  .segment = r->segment,
                                  .from = r->last.moment.time,
                                  .to = to,
                                  .step = step,
                                  .parts = r->parts,
                                  .scale = route->scale,
                                  .force = route->scale * dea_dynamics_stiffness(route->dynamics, 0.0, 0.0, false),
                                  .tolerance = fmin(1e-7, 1e-3 * route->scene->accuracy),
                                  .loose = r->loose,
                                  .most = points_left(r),
                                  .mass = r->match.mass,
                                  .conductance = r->match.resistance,
                                  .start = scaled(r->last.state, 1.0 / r->speed)};
}

/* The point at hand, and where rates need it the next one of its segment. */
static ahead read_ahead(const runner *r, const dea_ngspice_table *table, size_t index, double time, double from, double to)
{
    const double *const *columns = (const double *const *)table->columns;
    const dea_signal *signal = r->route->signal;
    ahead p = {.time = time, .state = scaled(dea_mobility_read(r->route->mobility, columns, index), r->speed)};
    if (!r->fast.any || index + 1 >= table->count || !(time < to)) {
        return p;
    }
    const double next = fmin(from + table->columns[0][index + 1], to);
    const size_t segment = dea_signal_find(signal, r->segment, 0.5 * (r->last.moment.time + time));
    if (next > time && dea_signal_find(signal, segment, 0.5 * (time + next)) == segment) {
        p.next_time = next;
        p.next = scaled(dea_mobility_read(r->route->mobility, columns, index + 1), r->speed);
    }
    return p;
}

/* The points of one netlist. */
static void absorb(runner *r, const dea_ngspice_table *table, double from, double to)
{
    const double *times = table->columns[0];
    const double length = to - from;
    for (size_t i = 0; i < table->count; i++) {
        const bool last = times[i] >= length * (1.0 - 1e-12);
        const double time = last ? to : from + times[i];
        if (!(time > r->last.moment.time) || (time >= to && !last)) {
            continue; /* late in a run the steps of a short edge are finer than its time can be told */
        }
        const ahead p = read_ahead(r, table, i, time, from, to);
        if (!advance(r, &p) || last) {
            return;
        }
    }
    r->track->end = verdict(r);
}

_Static_assert((int)DEA_MOBILITY_VECTORS <= (int)DEA_NGSPICE_COLUMNS, "a table holds all vectors of a piece");

static dea_status write_piece(const void *user, const dea_mobility_piece *piece, char **text, dea_error *error)
{
    return dea_mobility_write(user, piece, text, error);
}

static dea_status run_netlist(runner *r, double to, double step, dea_error *error)
{
    const dea_mobility *mobility = r->route->mobility;
    const dea_mobility_vectors vectors = dea_mobility_vectors_of(mobility);
    const char *names[DEA_MOBILITY_VECTORS];
    dea_mobility_piece piece;
    dea_ngspice_table table;
    for (size_t i = 0; i < vectors.count; i++) {
        names[i] = vectors.names[i];
    }
    set_piece(r, &piece, to, step);
    const dea_status status = dea_deck_run(r->route->library, &piece, write_piece, mobility, names, vectors.count, &table, error);
    r->loose = piece.loose;
    r->track->steps += piece.taken;
    r->track->netlists++;
    if (status == DEA_OK) {
        absorb(r, &table, piece.from, to);
    }
    dea_ngspice_table_free(&table);
    return status;
}

/* The voltage jumps: without mass, damper and series resistance the displacement goes with it, branches held. */
static void jump(runner *r, size_t segment)
{
    const dea_route *route = r->route;
    dea_dynamics *d = route->dynamics;
    dea_mobility_state state = r->last.state;
    settle(r);
    r->segment = segment;
    if (dea_dynamics_is_free(d) && d->series == 0.0) {
        const double u = state.u;
        if (!dea_dynamics_follow(d, route->signal->segments[segment].start, state.z, &state.u)) {
            r->track->end = DEA_STATE_PULL_IN;
            return;
        }
        dea_audit_jump(&r->track->audit, d, u, state.u, state.z);
    }
    r->last = node_at(r, r->last.moment.time, &state, NULL);
    r->before_time = r->last.moment.time;
}

static dea_status run_piece(runner *r, const dea_piece *piece, double fineness, dea_error *error)
{
    const double steps = (piece->to - piece->from) / (piece->step * fineness);
    const double parts = ceil(steps / most_steps);
    dea_status status = DEA_OK;
    r->rings = piece->rings;
    if (piece->jump) {
        jump(r, piece->segment);
    }
    for (double part = 1.0; part <= parts && status == DEA_OK && r->track->end == DEA_STATE_OK; part++) {
        const double to = part == parts ? piece->to : piece->from + (piece->to - piece->from) * (part / parts);
        do {
            const double behind = nextafter(r->last.moment.time, INFINITY);
            enter_segment(r, r->last.moment.time, 2.0 * behind - r->last.moment.time);
            status = run_netlist(r, to, piece->step * fineness, error);
        } while (r->cut && status == DEA_OK && r->track->end == DEA_STATE_OK && r->last.moment.time < to);
    }
    return status;
}

/* Relaxed under the first voltage, or at rest; a film that follows its voltage jumps to where that wants it. */
static bool start(runner *r)
{
    const dea_route *route = r->route;
    dea_dynamics *d = route->dynamics;
    const double source = route->signal->segments[0].start;
    dea_mobility_state state = {0};
    double voltage;
    if (!dea_dynamics_begin(d, d->biased, source, &state.u, &voltage)) {
        return false;
    }
    const dea_edge e = dea_dynamics_edge(d, state.u);
    state.charge = e.capacitance * voltage;
    dea_edge_relax(d, &e, state.z);
    r->last = node_at(r, 0.0, &state, NULL);
    r->track->start = state;
    r->track->first = r->last.moment;
    r->track->first.v = 0.0;
    jump(r, 0);
    if (r->track->end == DEA_STATE_OK) {
        r->track->points[r->track->reached++] =
            (dea_track_point){r->last.moment.u, r->last.moment.v, r->last.state.charge, r->last.current};
    }
    return r->track->end == DEA_STATE_OK;
}

/* Films of linear springs, and those without mass and damper, end at a time that is known. */
static bool is_vague(const runner *r)
{
    const dea_route *route = r->route;
    const dea_track *track = r->track;
    return track->end == DEA_STATE_PULL_IN && route->dynamics->framed && !dea_dynamics_is_free(route->dynamics) &&
           track->reached < route->samples && dea_layout_place(route->scene, track->reached) <= track->last.time + r->step;
}

dea_status dea_track_run(const dea_route *route, double fineness, dea_track *track, dea_error *error)
{
    runner r = {.route = route, .track = track, .speed = 1.0, .loose = 1.0, .parts = dea_deck_parts(fineness)};
    *track = (dea_track){.end = DEA_STATE_OK};
    track->points = malloc(route->samples * sizeof *track->points);
    if (!track->points) {
        return dea_fail(error, DEA_ERROR_MEMORY, "out of memory for the samples of a run");
    }
    dea_status status = DEA_OK;
    if (!start(&r)) {
        track->end = DEA_STATE_PULL_IN;
    }
    for (size_t i = 0; i < route->pieces->count && status == DEA_OK && track->end == DEA_STATE_OK; i++) {
        status = run_piece(&r, &route->pieces->pieces[i], fineness, error);
        if (!(work_left(route, track) > 0.0) && r.last.moment.time < route->pieces->pieces[route->pieces->count - 1].to) {
            track->end = DEA_STATE_FAILED;
            track->exhausted = true;
        }
    }
    if (track->reached > 0) {
        settle(&r);
    }
    track->last = r.last.moment;
    track->stop = r.last.state;
    track->vague = is_vague(&r);
    return status;
}
