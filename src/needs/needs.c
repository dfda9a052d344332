/* What a transient leaves out. An element goes where the stand-in says that the samples hardly change without it; the elements
 * are tried one after the other, each on what those before it have left, so that the sum of the changes bounds the whole. */
#include "deaspice/needs.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "film/point.h"
#include "needs/surrogate.h"
#include "network/swing.h"
#include "study/study.h"

static const double budget = 0.25;     /* of the accuracy: all omissions */
static const double one_share = 0.5;   /* most that one omission takes of what is left of it */
static const double ring_share = 0.02; /* of the accuracy: what is left of a ring hides how fast the steps converge */
static const double safe_linear = 1.5; /* bound over what the stand-in says, where it is the film itself */
static const double safe_nonlinear = 4.0;
static const double doubt = 5.0;           /* what a relative variation of the stiffness adds to it */
static const double rate_allowance = 10.0; /* accuracies that velocity and current promise */
static const double missed = 0.01;         /* share of the static displacement that counts as peak where the samples see less */

static const double rounding = 1e-12; /* of a stand-in's answer, relative to its peak */

/* Of a membrane the ring stands in, for its mass alone: it swings in many modes. What a mass changes of a slow motion goes with the inverse
 * square of the resonance, which the ring has up to five times too high. */
static const double safe_membrane = 4.0, safe_resonance = 4.0;

enum { MANY_BRANCHES = 8 };

typedef struct planner {
    dea_surrogate surrogate;
    dea_surrogate_answer now, next; /* owned: with what is left out so far, and with one more */
    dea_reduction reduction;
    const dea_engine *engine;
    bool many_nodes; /* the surrogate is of a film that has one node only */
    dea_needs *needs;
    double left; /* of the budget [1] */
    double safety;
    double peaks[DEA_SURROGATE_POINTS];  /* of the displacement, as the film itself would have them [m] */
    double speeds[DEA_SURROGATE_POINTS]; /* of the velocity, likewise [m/s] */
} planner;

/* A load that alone resists the edge of a membrane leaves its other nodes without an equation of motion: they keep their mass; so they do
 * where the rim of a sheet resistance charges at once, which the one resistance of the stand-in hides. A branch has relaxed where a
 * steady force pulls the film, and as a spring it would pull it back to where it is without. */
static bool pays(const planner *p, dea_part part)
{
    const dea_scene *scene = p->surrogate.scene;
    if (part == DEA_PART_BRANCH && dea_point_is_pulled(&p->surrogate.dynamics.point)) {
        return false;
    }
    if (p->many_nodes && (dea_scene_edge(scene).damping > 0.0 || scene->electrode.sheet_resistance > 0.0)) {
        return false;
    }
    return (p->engine->omits & 1u << part) != 0 && (!p->many_nodes || part == DEA_PART_MASS);
}

static void omit(planner *p, dea_omission omission)
{
    p->needs->omissions[p->needs->count++] = omission;
    p->needs->bound += omission.bound;
    p->left -= omission.bound;
    p->reduction = dea_needs_reduction(p->needs->omissions, p->needs->count);
}

/* True of the first sample of a film that begins without bias and has a mass: it rests, which dea_dynamics_sample() knows without
 * the mass too, as of films of one node. */
static bool is_rest(const planner *p, size_t probe)
{
    const dea_surrogate *s = &p->surrogate;
    const bool first = probe == 0 && s->sampled > 0 && dea_layout_place(s->scene, s->probes[0]) == 0.0;
    return first && s->dynamics.heavy && !p->many_nodes && !s->scene->transient.from_bias;
}

/* The same of a film at its bias that a mass, a damper or a resistance holds there for the moment, but for its displacement.
 * Without them the film follows a sloping voltage at once. */
static bool is_start(const planner *p, size_t probe)
{
    const dea_scene *scene = p->surrogate.scene;
    const bool held = !isnan(scene->material.density) || dea_electrode_mass(scene) > 0.0 ||
                      !isnan(scene->material.retardation) || dea_scene_edge(scene).damping > 0.0 || dea_series_resistance(scene) > 0.0;
    return is_rest(p, probe) || (held && scene->transient.from_bias && probe == 0);
}

/* Change of the displacement at a probe over its peak, or of the velocity against what its column promises; the larger of the
 * operating points. */
static double change_at(const planner *p, size_t probe)
{
    double change = 0.0;
    for (int i = 0; i < p->surrogate.point_count && !is_rest(p, probe); i++) {
        const size_t k = (size_t)i * p->surrogate.count + probe;
        const double rate = is_start(p, probe) ? 0.0 : fabs(p->next.v[k] - p->now.v[k]) / (rate_allowance * p->speeds[i]);
        const double here = fmax(fabs(p->next.u[k] - p->now.u[k]) / p->peaks[i], rate);
        change = here <= change ? change : isnan(here) ? (double)INFINITY : here;
    }
    return p->safety * change;
}

static double change_of(const planner *p)
{
    double change = 0.0;
    for (size_t i = 0; i < p->surrogate.count; i++) {
        change = fmax(change, change_at(p, i));
    }
    return change;
}

/* Solves with one omission more, into `next`; false where that has no answer. */
static bool solve_with(planner *p, const dea_omission *omission)
{
    dea_omission all[DEA_OMISSIONS];
    memcpy(all, p->needs->omissions, p->needs->count * sizeof *all);
    all[p->needs->count] = *omission;
    const dea_reduction reduction = dea_needs_reduction(all, p->needs->count + 1);
    return dea_surrogate_solve(&p->surrogate, &reduction, p->next);
}

/* ---- what a linear stand-in does not see
 *
 * A part that has died away at every sample has left its mark in what is slow: z_i' = (S - z_i)/tau_i takes up the time integral
 * of what S was off by. In a linear film that integral is the same for a branch and for the damper that stands for it, and none
 * for a mass; in a film whose stiffness varies they differ by about that variation times
 *
 *     sum_i c_i/tau_i T D_i,   D_i = the changes of U^2 up to then over the largest U^2, each forgotten with tau_i,
 *
 * T being the time for which the part counts at a change. Parts that are simply left out differ by that integral in a linear film
 * as well, but there what a voltage's rise adds to it its fall takes away again.
 *
 * The mean over a window is such an integral too: it differs by about the variation times T over the window times the changes of
 * U^2 within it. */

static const double most_variation = 2.0; /* a film that stiffens much moves the less there */

typedef struct trace {
    double lasting; /* T, 0: no mark */
    double fading;  /* in which the part dies away: what is faster follows it */
    double quick;   /* within which a voltage must change for the part to see more than a slope */
} trace;

/* Largest ratio of what the damper bridges to the stiffness of the relaxed film: the film follows in that part of the retardation. */
static double slackest(const dea_surrogate *s)
{
    double ratio = 0.0;
    for (int i = 0; i < s->point_count; i++) {
        const dea_surrogate_point *point = &s->points[i];
        ratio = fmax(ratio, point->viscous / (point->passive - point->push_slope * point->square));
    }
    return ratio;
}

static trace trace_of(const planner *p, const dea_omission *omission)
{
    const dea_surrogate *s = &p->surrogate;
    const dea_material *material = &s->scene->material;
    if (omission->part == DEA_PART_MASS) { /* the offset of a swing goes with its square */
        const bool swings = s->swing > 0.0;
        return (trace){s->fading * (swings ? s->swing * s->swing : 1.0), s->fading, swings ? (double)INFINITY : s->fading};
    }
    if (omission->part == DEA_PART_BRANCH && omission->form != DEA_BRANCH_SPRING) {
        const dea_prony prony = dea_material_branch(material, omission->branch);
        double rest = 1.0;
        for (size_t i = 0; i < material->prony_count; i++) {
            rest -= material->prony[i].g;
        }
        return (trace){prony.g / rest * prony.tau, prony.tau, prony.tau};
    }
    if (omission->part == DEA_PART_DAMPER) {
        const double slowest = material->retardation * slackest(s);
        return (trace){slowest, slowest, slowest};
    }
    return (trace){0.0, 0.0, 0.0};
}

/* How much U^2 changes over a segment, over the largest U^2, where a change that takes long counts less. */
static double change_over(const dea_surrogate *s, const dea_segment *segment, double quick, double forgotten)
{
    const double length = segment->to - segment->from, largest = s->largest * s->largest;
    if (segment->sine) {
        const double frequency = dea_surrogate_signal(s)->curve.tones[0].frequency;
        return 4.0 * (1.0 + frequency * fmin(length, forgotten)) * fmin(1.0, 2.0 * DEA_PI * frequency * quick);
    }
    const double start = segment->start * segment->start, end = segment->end * segment->end;
    const double change = segment->start * segment->end < 0.0 ? start + end : fabs(end - start);
    return change / largest * fmin(1.0, quick / length);
}

/* Largest D of one memory over the probes. The mark of the last jump takes its time. */
static double remembered(const planner *p, double tau, trace t)
{
    const dea_surrogate *s = &p->surrogate;
    const dea_signal *signal = dea_surrogate_signal(s);
    const double first = signal->segments[0].start;
    double mark = 0.0, most = 0.0;
    double before = s->scene->transient.from_bias ? first * first : 0.0;
    size_t probe = 0;
    for (size_t i = 0; i < signal->count; i++) {
        const dea_segment *segment = &signal->segments[i];
        const double on_the_way = change_over(s, segment, t.quick, tau);
        const double jump = fabs(segment->start * segment->start - before) / (s->largest * s->largest);
        for (; probe < s->count && dea_layout_place(s->scene, s->probes[probe]) <= segment->to; probe++) {
            const double age = fmax(0.0, dea_layout_place(s->scene, s->probes[probe]) - segment->from);
            most = fmax(most, (mark + jump * fmin(1.0, age / t.fading)) * exp(-age / tau) + on_the_way);
        }
        mark = (mark + jump) * exp((segment->from - segment->to) / tau) + on_the_way;
        before = segment->end * segment->end;
    }
    return most;
}

/* Changes of U^2 that count in a mean, over the largest U^2; what is before the window has died away. */
static double changes_within(const dea_surrogate *s, const dea_window *window, trace t)
{
    const dea_signal *signal = dea_surrogate_signal(s);
    const double first = signal->segments[0].start, length = window->to - window->from;
    double sum = 0.0, before = s->scene->transient.from_bias ? first * first : 0.0;
    for (size_t i = 0; i < signal->count && signal->segments[i].from < window->to; i++) {
        const dea_segment *segment = &signal->segments[i];
        const double jump = fabs(segment->start * segment->start - before) / (s->largest * s->largest);
        sum += jump * exp(-fmax(0.0, window->from - segment->from) / t.fading);
        sum += change_over(s, segment, t.quick, length) * exp(-fmax(0.0, window->from - segment->to) / t.fading);
        before = segment->end * segment->end;
    }
    return sum;
}

/* Largest displacement of a stand-in over that of the film. */
static double excess_of(const dea_surrogate *s)
{
    double excess = 1.0;
    for (int i = 0; i < s->point_count; i++) {
        excess = fmax(excess, s->points[i].excess);
    }
    return excess;
}

/* What the largest voltage does at once over the peak that the film's changes are told by: no sample may have seen it. */
static double unseen(const planner *p)
{
    const dea_surrogate *s = &p->surrogate;
    double most = excess_of(s);
    for (int i = 0; i < s->point_count; i++) {
        const dea_surrogate_point *point = &s->points[i];
        const double held = point->passive - point->push_slope * point->square + s->dynamics.total_share * point->viscous;
        most = fmax(most, fabs(point->push) * s->largest * s->largest / held / p->peaks[i]);
    }
    return most;
}

/* Bound of that mark [1]. */
static double mark_of(const planner *p, const dea_omission *omission)
{
    const dea_surrogate *s = &p->surrogate;
    const trace t = trace_of(p, omission);
    const double lag = dea_surrogate_lag(s);
    double rate = 0.0, mean = 0.0;
    if (!(s->variation > 0.0) || !(t.lasting > 0.0)) {
        return 0.0;
    }
    for (size_t i = 0; i < s->dynamics.branch_count; i++) {
        const dea_branch *branch = &s->dynamics.branches[i];
        rate += branch->tau > t.fading ? branch->share / branch->tau * remembered(p, branch->tau, t) : 0.0;
    }
    rate += lag > t.fading ? s->coupling / lag * remembered(p, lag, t) : 0.0;
    for (size_t i = 0; i < s->scene->transient.average_count; i++) {
        const dea_window *window = &s->scene->transient.averages[i];
        mean = fmax(mean, changes_within(s, window, t) / (window->to - window->from));
    }
    return unseen(p) * fmin(s->variation, most_variation) * t.lasting * fmax(rate, mean);
}

/* A mass acts by u'', and a damper differs from its branch by c tau^2 S'': where the film follows a slow voltage, u'' = u_P P'' +
 * u_PP P'^2 with P = U^2, and u_PP grows with one more power of the softening than u_P does, which the stand-ins have. */
static double curvature_of(const planner *p, dea_part part, dea_branch_form form)
{
    const bool second = part == DEA_PART_MASS || part == DEA_PART_RING || form == DEA_BRANCH_DAMPER;
    return second ? (1.0 + p->surrogate.variation) * excess_of(&p->surrogate) : 1.0;
}

/* Angular frequency of the film at rest, its branches held [rad/s]. */
static double omega_of(const dea_surrogate *s)
{
    return sqrt((s->points[0].passive + s->dynamics.total_share * s->points[0].viscous) / s->dynamics.mass);
}

/* What a change of a swing grows by where the film's stiffness varies on its way: with its amplitude or middle, off by x, its frequency
 * is off by x/2 of that variation, and turns its phase over all radians that it lives. */
static double turning_of(const planner *p, dea_part part)
{
    const dea_surrogate *s = &p->surrogate;
    const bool varies = !s->dynamics.linear || s->dynamics.series > 0.0;
    if (!varies || part == DEA_PART_MASS || p->reduction.mass || !(s->swing > 0.0)) {
        return 1.0;
    }
    return 1.0 + 0.5 * s->variation * fmin(1.0, s->swing) * omega_of(s) * s->fading;
}

/* Leaves something out if it fits into the budget; a bound that it has already is for what the stand-in does not see. */
static bool try(planner *p, dea_omission omission)
{
    if (!pays(p, omission.part) || !solve_with(p, &omission)) {
        return false;
    }
    omission.bound += curvature_of(p, omission.part, omission.form) * turning_of(p, omission.part) * change_of(p) + rounding;
    if (omission.bound <= one_share * p->left) {
        omission.bound += mark_of(p, &omission);
    }
    if (!(omission.bound <= one_share * p->left)) {
        return false;
    }
    const dea_surrogate_answer before = p->now;
    p->now = p->next;
    p->next = before;
    omit(p, omission);
    return true;
}

/* Amplitude of the ring at a probe, over the peak of the displacement: whatever its phase there. */
static double ring_at(const planner *p, double omega, size_t probe)
{
    double ring = 0.0;
    for (int i = 0; i < p->surrogate.point_count && !is_rest(p, probe); i++) {
        const size_t k = (size_t)i * p->surrogate.count + probe;
        const double swing = hypot(p->next.u[k] - p->now.u[k], (p->next.v[k] - p->now.v[k]) / omega);
        const double rate = probe < p->surrogate.sampled ? omega * swing / (rate_allowance * p->speeds[i]) : 0.0;
        const double here = fmax(swing / p->peaks[i], rate);
        ring = here <= ring ? ring : isnan(here) ? (double)INFINITY : here;
    }
    return curvature_of(p, DEA_PART_RING, DEA_BRANCH_WHOLE) * p->safety * ring;
}

/* The mass from that time behind a corner on from which no sample sees its ring any more. */
static void try_ring(planner *p)
{
    const dea_surrogate *s = &p->surrogate;
    const dea_omission mass = {.part = DEA_PART_MASS};
    const double omega = omega_of(s);
    const double wanted = fmin(one_share * p->left, ring_share * p->surrogate.scene->accuracy);
    dea_omission ring = {.part = DEA_PART_RING};
    double last = (double)INFINITY; /* amplitude at the last probe that sees it */
    double next = (double)INFINITY; /* the first age of those that do not */
    if (!pays(p, DEA_PART_RING) || !solve_with(p, &mass)) {
        return;
    }
    for (size_t i = 0; i < s->count; i++) {
        const double here = ring_at(p, omega, i);
        if (!(here <= wanted) && s->ages[i] >= ring.from) {
            last = s->ages[i] > ring.from ? here : fmax(last, here);
            ring.from = s->ages[i];
        }
    }
    for (size_t i = 0; i < s->count; i++) {
        if (s->ages[i] > ring.from) {
            next = fmin(next, s->ages[i]);
            ring.bound = fmax(ring.bound, ring_at(p, omega, i));
        }
    }
    if (!isfinite(next)) {
        return;
    }
    /* between the two it falls exponentially */
    const double fallen = log(last / wanted) / log(last / fmin(ring.bound, wanted));
    ring.from += (next - ring.from) * (isfinite(last) ? fallen : 1.0);
    ring.bound = wanted;
    omit(p, ring);
}

/* Could a branch be out, or stand for something simpler? Spares a film of many branches the trial. */
static bool may_go(const planner *p, const dea_prony *prony)
{
    const dea_transient *transient = &p->surrogate.scene->transient;
    return p->surrogate.scene->material.prony_count <= MANY_BRANCHES || prony->tau > 10.0 * transient->until ||
           prony->tau < transient->every || prony->g < p->left;
}

static void try_branch(planner *p, size_t branch)
{
    const dea_scene *scene = p->surrogate.scene;
    const dea_prony prony = dea_material_branch(&scene->material, branch);
    const bool slow = prony.tau > scene->transient.until;
    dea_omission omission = {.part = DEA_PART_BRANCH, .branch = branch, .form = DEA_BRANCH_OUT};
    if (!may_go(p, &prony) || try(p, omission)) {
        return;
    }
    /* one that is held counts from rest, where its spring is not strained */
    omission.form = slow ? DEA_BRANCH_SPRING : DEA_BRANCH_DAMPER;
    if (!slow || !scene->transient.from_bias) {
        (void)try(p, omission);
    }
}

static void try_branches(planner *p)
{
    const dea_material *material = &p->surrogate.scene->material;
    bool tried[DEA_PRONY_MAX] = {false};
    for (size_t n = 0; n < material->prony_count; n++) {
        size_t fastest = DEA_PRONY_MAX;
        for (size_t i = 0; i < material->prony_count; i++) {
            const bool faster = fastest == DEA_PRONY_MAX || material->prony[i].tau < material->prony[fastest].tau;
            fastest = !tried[i] && faster ? i : fastest;
        }
        tried[fastest] = true;
        try_branch(p, fastest);
    }
}

/* What the charge misses behind R_s: the film's voltage lags by R_s C behind a slope; a jump, or the last slope, reaches it as
 * exp(-t/(R_s C)). */
static double lag_at(const planner *p, double lag, size_t segment, size_t probe)
{
    const dea_surrogate *s = &p->surrogate;
    const dea_segment *here = &s->source.segments[segment];
    const dea_segment rest = {.end = s->scene->transient.from_bias ? here->start : 0.0};
    const dea_segment *before = segment > 0 ? here - 1 : &rest;
    const double time = dea_layout_place(s->scene, s->probes[probe]);
    const double on_the_way = fabs(here->start - before->end) + (segment > 0 ? fabs(before->end - before->start) : 0.0);
    const double change = lag * fabs(dea_segment_slope(&s->source, here, time)) + on_the_way * exp(-s->ages[probe] / lag);
    return 4.0 * change / s->largest;
}

/* What the current C U' misses behind R_s, against what its column promises: the charge of a jump flows as
 * exp(-t/(R_s C))/(R_s C), behind a corner the slope comes to its new value. */
static double late_current_at(const planner *p, double lag, size_t segment, size_t probe, double steepest)
{
    const dea_surrogate *s = &p->surrogate;
    const dea_segment *here = &s->source.segments[segment];
    const dea_segment rest = {.end = s->scene->transient.from_bias ? here->start : 0.0};
    const dea_segment *before = segment > 0 ? here - 1 : &rest;
    const double slope = dea_segment_slope(&s->source, here, here->from);
    const double last = segment > 0 ? dea_segment_slope(&s->source, before, before->to) : 0.0;
    const double change = fabs(here->start - before->end) / lag + fabs(slope - last);
    return 4.0 * change * exp(-s->ages[probe] / lag) / (rate_allowance * steepest);
}

/* Largest slope of the source at a sample, no less than what charges the film once within the run [V/s]. */
static double steepest_of(const planner *p)
{
    const dea_surrogate *s = &p->surrogate;
    double steepest = s->largest / s->scene->transient.until;
    size_t segment = 0;
    for (size_t i = 0; i < s->sampled; i++) {
        const double time = dea_layout_place(s->scene, s->probes[i]);
        segment = dea_signal_find(&s->source, segment, time);
        steepest = fmax(steepest, fabs(dea_segment_slope(&s->source, &s->source.segments[segment], time)));
    }
    return steepest;
}

static void try_series(planner *p)
{
    const dea_surrogate *s = &p->surrogate;
    const double leak = 2.0 * s->dynamics.series * s->dynamics.conductance; /* of the share of the voltage that it takes */
    const double lag = s->dynamics.series * s->capacitance;
    double late = leak;
    size_t segment = 0;
    const double steepest = steepest_of(p);
    /* the first sample of a film at rest has no charge in any case, that of a film at its bias only the current of the leakage */
    for (size_t i = s->scene->transient.from_bias ? 0 : 1; i < s->sampled; i++) {
        segment = dea_signal_find(&s->source, segment, dea_layout_place(s->scene, s->probes[i]));
        late = fmax(late, leak + lag_at(p, lag, segment, i));
        late = is_start(p, i) ? late : fmax(late, late_current_at(p, lag, segment, i, steepest));
    }
    if (late <= one_share * p->left) {
        (void)try(p, (dea_omission){.part = DEA_PART_SERIES, .bound = late});
    }
}

/* True where a film of linear springs leaves its frame: its rows end there, and their peak is not that of the run. */
static bool leaves_frame(const planner *p)
{
    const dea_dynamics *d = &p->surrogate.dynamics;
    for (size_t k = 0; !d->framed && k < p->surrogate.count; k++) {
        const double u = p->now.u[k];
        if (!(u > -d->radius && u < d->point.frame_radius - d->radius)) {
            return true;
        }
    }
    return false;
}

/* Peaks of the displacement over the samples, and of the velocity, no less than what moves the film once within the run. The
 * start of a film from rest, where its peak may be an edge's alone, counts where a sample sees it. */
static void set_peaks(planner *p)
{
    const dea_surrogate *s = &p->surrogate;
    for (int i = 0; i < s->point_count; i++) {
        const dea_surrogate_point *point = &s->points[i];
        p->peaks[i] = missed * fabs(point->push) * s->largest * s->largest / point->passive;
        for (size_t k = 0; k < s->sampled; k++) {
            p->peaks[i] = fmax(p->peaks[i], fabs(p->now.u[(size_t)i * s->count + k]));
        }
        p->speeds[i] = p->peaks[i] / s->scene->transient.until;
        for (size_t k = is_start(p, 0) ? 1 : 0; k < s->sampled; k++) {
            p->speeds[i] = fmax(p->speeds[i], fabs(p->now.v[(size_t)i * s->count + k]));
        }
        p->peaks[i] /= point->excess;
        p->speeds[i] /= point->excess;
    }
}

static void try_all(planner *p)
{
    const dea_surrogate *s = &p->surrogate;
    const double softening = s->points[0].push_slope;
    if (s->dynamics.linear && softening != 0.0) {
        (void)try(p, (dea_omission){.part = DEA_PART_SOFTENING});
    }
    const bool heavy = s->dynamics.mass > 0.0;
    const bool weightless = heavy && try(p, (dea_omission){.part = DEA_PART_MASS});
    try_branches(p);
    if (!isnan(s->scene->material.retardation)) {
        (void)try(p, (dea_omission){.part = DEA_PART_DAMPER});
    }
    if (s->dynamics.series > 0.0) {
        try_series(p);
    }
    if (heavy && !weightless) {
        try_ring(p);
    }
}

static dea_status make_room(planner *p, dea_error *error)
{
    const size_t count = (size_t)p->surrogate.point_count * p->surrogate.count;
    double *room = malloc(4 * count * sizeof *room);
    if (!room) {
        return dea_fail(error, DEA_ERROR_MEMORY, "out of memory while a run is planned");
    }
    p->now = (dea_surrogate_answer){room, room + count};
    p->next = (dea_surrogate_answer){room + 2 * count, room + 3 * count};
    return DEA_OK;
}

static dea_status plan(planner *p, dea_error *error)
{
    const dea_status status = make_room(p, error);
    if (status != DEA_OK) {
        return status;
    }
    double *room = p->now.u;
    if (dea_surrogate_solve(&p->surrogate, &p->reduction, p->now) && !leaves_frame(p)) {
        set_peaks(p);
        try_all(p);
    }
    free(room);
    return DEA_OK;
}

/* The less the film's stiffness varies, the more the stand-in is the film. */
static double safety_of(const dea_surrogate *s)
{
    return s->dynamics.series > 0.0 ? safe_nonlinear : fmin(safe_nonlinear, safe_linear + doubt * s->variation);
}

/* NAN where nobody knows the membrane's resonance: with a skin or a load. */
static double safety_of_membrane(const dea_scene *scene, dea_dynamics *ring)
{
    const double stiff = dea_dynamics_stiffness(ring, ring->rest, 0.0, true) / ring->mass;
    const double pace = 2.0 * DEA_PI * dea_point_resonance(scene, &ring->point);
    return stiff > 0.0 && pace > 0.0 ? fmax(safe_membrane, safe_resonance * stiff / (pace * pace)) : (double)NAN;
}

dea_status dea_needs_find(const dea_scene *scene, const dea_model *model, const dea_engine *engine, dea_needs *needs,
                          dea_error *error)
{
    planner p = {.engine = engine, .needs = needs, .left = budget * scene->accuracy};
    bool usable;
    *needs = (dea_needs){.resonance = (double)NAN, .decay = (double)NAN};
    if (!dea_study_of(scene)->timed || engine->omits == 0) {
        return DEA_OK;
    }
    p.many_nodes = model->membrane;
    dea_status status = dea_surrogate_open(scene, model->stand_in ? model->stand_in : model, &p.surrogate, &usable, error);
    if (status == DEA_OK) {
        const dea_swing swing = p.many_nodes ? dea_swing_free(scene, model) : dea_swing_of(&p.surrogate.dynamics, p.surrogate.dynamics.rest, 0.0);
        needs->resonance = swing.frequency;
        needs->decay = swing.decay;
    }
    const bool linear = !isfinite(p.surrogate.dynamics.limit); /* the stand-in charges through its resistance alone */
    if (status == DEA_OK && usable && linear) {
        p.safety = safety_of(&p.surrogate) * (p.many_nodes ? safety_of_membrane(scene, &p.surrogate.dynamics) : 1.0);
        status = isnan(p.safety) ? DEA_OK : plan(&p, error);
    }
    dea_surrogate_close(&p.surrogate);
    return status == DEA_ERROR_MEMORY ? status : DEA_OK;
}

dea_reduction dea_needs_reduction(const dea_omission *omissions, size_t count)
{
    dea_reduction reduction = {0};
    for (size_t i = 0; i < count; i++) {
        const dea_omission *omission = &omissions[i];
        switch (omission->part) {
        case DEA_PART_MASS:
            reduction.mass = true;
            break;
        case DEA_PART_RING:
            reduction.ring = omission->from;
            break;
        case DEA_PART_BRANCH:
            reduction.branches[omission->branch] = omission->form;
            break;
        case DEA_PART_DAMPER:
            reduction.damper = true;
            break;
        case DEA_PART_SERIES:
            reduction.series = true;
            break;
        case DEA_PART_SOFTENING:
            reduction.softening = true;
            break;
        }
    }
    return reduction;
}
