/* Transients of the linear network: exact on every segment of the source voltage, joined at the edges. */
#include <stdlib.h>
#include <string.h>

#include "engine/direct/direct.h"
#include "engine/direct/piece.h"

/* Samples that are stepped from one to the next before the state is computed anew from the begin of the segment. */
enum { STEPS = 64, CACHED = 2 };

static const char varies[] = "the voltage softens the film, which has a closed form only while the voltage is constant";

/* Modes under one stiffness, and what the sample interval does to them. */
typedef struct cached {
    dea_modes modes;
    dea_advance every;
} cached;

typedef struct run {
    const dea_scene *scene;
    dea_dynamics dynamics;
    dea_linear linear;
    dea_signal signal;
    dea_chain chain; /* at 0 V */
    cached cache[CACHED];
    size_t cached;     /* in use */
    const cached *now; /* NULL before the first segment */
    dea_course course; /* at the begin of the segment, the part of a sine included */
    double force;      /* before that begin [N] */
    dea_motion motion; /* before that begin */
    dea_sample *samples;
    size_t rows, row; /* the next one */
    bool lost;        /* pull-in */
    dea_audit audit;
    double peak;         /* of |u| at the samples [m] */
    double parts;        /* of what a sine does [m] */
    double cancellation; /* worst of the modes */
    double turns;        /* of the pair and of the sine, which round [rad] */
} run;

const char *dea_direct_refuses_transient(const dea_scene *scene, const dea_model *model)
{
    const dea_waveform *wave = &scene->drive.waveform;
    dea_point point;
    dea_linear linear;
    if (!model->linear) {
        return "its springs are not linear, so that a transient has no closed form";
    }
    if (scene->drive.series_resistance > 0.0) {
        return "the charging of the film through a series resistance is not linear";
    }
    dea_film_prepare(scene, &point.film);
    dea_point_place(scene, &point);
    model->linear(&point, &linear);
    bool ramps = wave->kind == DEA_WAVE_SINE && wave->sine.amplitude != 0.0;
    ramps = ramps || (wave->kind == DEA_WAVE_STEP && wave->step.rise > 0.0 && wave->step.voltage != 0.0);
    for (size_t i = 1; wave->kind == DEA_WAVE_POINTS && i < wave->point_count; i++) {
        ramps = ramps || wave->voltages[i] != wave->voltages[i - 1];
    }
    return ramps && linear.softening != 0.0 ? varies : NULL;
}

static bool is_constant(const dea_segment *segment, const dea_signal *signal)
{
    return segment->sine ? signal->sine.amplitude == 0.0 : segment->start == segment->end;
}

static dea_status check_segments(const run *r, dea_error *error)
{
    for (size_t i = 0; i < r->signal.count && r->linear.softening != 0.0; i++) {
        if (!is_constant(&r->signal.segments[i], &r->signal)) {
            return dea_fail(error, DEA_ERROR_UNSUPPORTED, "%s", varies);
        }
    }
    return DEA_OK;
}

static void set_chain(run *r)
{
    const dea_dynamics *d = &r->dynamics;
    r->chain = (dea_chain){.mass = d->mass,
                           .damping = d->retardation * r->linear.stiffness,
                           .stiffness = r->linear.stiffness,
                           .count = d->branch_count};
    for (size_t i = 0; i < d->branch_count; i++) {
        r->chain.spring[i] = r->linear.stiffness * d->branches[i].share;
        r->chain.tau[i] = d->branches[i].tau;
        r->chain.rate[i] = 1.0 / d->branches[i].tau;
    }
}

static dea_status open_run(run *r, const dea_model *model, dea_error *error)
{
    dea_status status = dea_dynamics_open(r->scene, model, &r->dynamics, error);
    if (status == DEA_OK) {
        status = dea_signal_open(r->scene, &r->signal, error);
    }
    if (status != DEA_OK) {
        return status;
    }
    model->linear(&r->dynamics.point, &r->linear);
    set_chain(r);
    r->rows = dea_layout_of(r->scene).rows;
    return check_segments(r, error);
}

static void close_run(run *r)
{
    dea_dynamics_close(&r->dynamics);
    dea_signal_close(&r->signal);
}

/* The modes under this stiffness into the older place of the cache, unless they are there. NULL with DEA_OK: nothing holds the
 * film. */
static dea_status find_modes(run *r, double stiffness, const cached **found, dea_error *error)
{
    for (size_t i = 0; i < r->cached; i++) {
        if (r->cache[i].modes.chain.stiffness == stiffness) {
            *found = &r->cache[i];
            return DEA_OK;
        }
    }
    const size_t place = r->cached < CACHED ? r->cached++ : r->now == &r->cache[0] ? 1 : 0;
    cached *entry = &r->cache[place];
    dea_chain chain = r->chain;
    chain.stiffness = stiffness;
    const dea_modes_answer answer = dea_modes_find(&chain, &entry->modes);
    *found = answer == DEA_MODES_FOUND ? entry : NULL;
    if (answer == DEA_MODES_CLOSE) {
        return dea_fail(error, DEA_ERROR_UNSUPPORTED,
                        "three time constants of the film nearly coincide: its modes cannot be told apart");
    }
    dea_advance_make(&entry->modes, r->scene->transient.every, &entry->every);
    r->cancellation = fmax(r->cancellation, entry->modes.cancellation);
    return DEA_OK;
}

/* Rows from the next one on: pull-in. */
static void refuse_rest(run *r)
{
    size_t near = 0;
    for (; r->row < r->rows; r->row++) {
        const double time = dea_layout_place(r->scene, r->row);
        near = dea_signal_find(&r->signal, near, time);
        const double voltage = dea_segment_voltage(&r->signal, &r->signal.segments[near], time);
        r->samples[r->row] = dea_sample_refused(time, voltage, DEA_STATE_PULL_IN);
    }
    r->lost = true;
}

static void write_row(run *r, const dea_piece *piece, const dea_course *course, double time, double t)
{
    const double voltage = dea_segment_voltage(&r->signal, piece->segment, time);
    const dea_motion motion = dea_piece_motion(piece, &r->now->modes, course, t);
    const dea_moment moment = {.time = time,
                               .source = voltage,
                               .voltage = voltage,
                               .slope = dea_segment_slope(&r->signal, piece->segment, time),
                               .u = motion.u,
                               .v = motion.v};
    if (dea_dynamics_sample(&r->dynamics, &moment, &r->samples[r->row])) {
        r->peak = fmax(r->peak, fabs(motion.u));
        r->row++;
    } else {
        refuse_rest(r);
    }
}

/* Rows of one segment. The amplitudes step from sample to sample; now and then they come from the begin of the segment, so that
 * no rounding adds up. */
static void write_rows(run *r, const dea_piece *piece, const dea_course *start, bool last)
{
    dea_course course = *start;
    size_t steps = STEPS;
    double before = 0.0;
    while (r->row < r->rows && !r->lost) {
        const double time = dea_layout_place(r->scene, r->row);
        const double t = fmax(time - piece->segment->from, 0.0);
        if (time > piece->segment->to && !last) {
            return;
        }
        if (steps >= STEPS || r->row + 1 == r->rows) {
            dea_advance fresh;
            course = *start;
            dea_advance_make(&r->now->modes, t, &fresh);
            dea_advance_take(&r->now->modes, &fresh, &piece->force, &course);
            steps = 0;
        } else {
            const dea_forcing force = dea_piece_force(piece, before);
            dea_advance_take(&r->now->modes, &r->now->every, &force, &course);
        }
        write_row(r, piece, &course, time, t);
        before = t;
        steps++;
    }
}

/* Rest, or the equilibrium under the first voltage; false where there is none. */
static bool begin_motion(run *r, const cached *modes, double force)
{
    memset(&r->course, 0, sizeof r->course);
    if (r->scene->transient.from_bias) {
        const double stiffness = modes->modes.chain.stiffness;
        if (!(stiffness > 0.0)) {
            return false;
        }
        r->course = dea_modes_relaxed(&modes->modes, force);
        r->motion.u = force / stiffness;
        r->force = force;
    }
    return true;
}

static void see_energies(run *r)
{
    const double kinetic = 0.5 * r->chain.mass * r->motion.v * r->motion.v;
    const double elastic = 0.5 * r->chain.stiffness * r->motion.u * r->motion.u;
    r->audit.largest = fmax(r->audit.largest, fmax(kinetic, elastic));
    r->audit.largest = fmax(r->audit.largest, fmax(fabs(r->audit.work), fabs(r->audit.dissipated)));
}

/* sum k_i (u - z_i)^2/2 with u - z_i = tau_i z_i'. */
static double branch_energy(const run *r)
{
    double rates[DEA_PRONY_MAX];
    double sum = 0.0;
    dea_modes_branches(&r->now->modes, &r->course.speed, rates);
    for (size_t i = 0; i < r->chain.count; i++) {
        const double stretch = r->chain.tau[i] * rates[i];
        sum += 0.5 * r->chain.spring[i] * stretch * stretch;
    }
    return sum;
}

/* Takes the course over to the next segment. Its modes differ where the voltage softens the film. */
static void cross_edge(run *r, const cached *next, double force)
{
    if (next == r->now) {
        dea_modes_jump(&next->modes, force - r->force, &r->course);
    } else {
        double z[DEA_PRONY_MAX];
        dea_modes_branches(&r->now->modes, &r->course.place, z);
        r->course = dea_modes_split(&next->modes, r->motion.u, r->motion.v, z, force);
    }
    r->now = next;
    r->force = force;
}

/* Without mass and damper an edge moves the film at once, the branches held: the work is what the springs take. */
static void audit_jump(run *r, double to, double branches)
{
    r->audit.branch += branches;
    r->audit.work += branches + 0.5 * r->chain.stiffness * (to - r->motion.u) * (to + r->motion.u);
}

/* Begins a segment behind the edge in front of it. */
static dea_status enter(run *r, const dea_segment *segment, dea_error *error)
{
    const double square = segment->start * segment->start;
    const double softened = r->linear.softening == 0.0 ? 0.0 : r->linear.softening * square;
    const double force = r->linear.force * square;
    const cached *next;
    const dea_status status = find_modes(r, r->chain.stiffness + softened, &next, error);
    if (status != DEA_OK) {
        return status;
    }
    if (!next || (!r->now && !begin_motion(r, next, force))) {
        refuse_rest(r);
        return DEA_OK;
    }
    r->now = r->now ? r->now : next;
    const double branches = branch_energy(r);
    cross_edge(r, next, force);
    if (next->modes.prompt > 0.0) {
        const dea_forcing now = {force, 0.0, 0.0};
        const double to = dea_modes_displacement(&next->modes, &r->course, &now);
        audit_jump(r, to, branch_energy(r) - branches);
        r->motion.u = to;
    }
    return DEA_OK;
}

/* Adds what a segment takes; @p first and @p branches: motion and energy of the branches at its begin. */
static void audit_piece(run *r, const dea_piece *piece, const dea_course *start, dea_motion first, double branches)
{
    const dea_spent spent = dea_piece_spend(piece, &r->now->modes, start);
    const double leak = r->dynamics.conductance * spent.square;
    const double softened = r->now->modes.chain.stiffness - r->chain.stiffness;
    const double u = r->motion.u;
    r->audit.work += spent.push - 0.5 * softened * (u - first.u) * (u + first.u) + leak;
    r->audit.dissipated += spent.damper + leak;
    r->audit.branch += spent.branches + branch_energy(r) - branches;
    see_energies(r);
}

static void count_turns(run *r, const dea_piece *piece)
{
    const dea_modes *modes = &r->now->modes;
    const double ring = modes->pair && modes->square < 0.0 ? sqrt(-modes->square) : 0.0;
    const double lasts = fmin(piece->length, 1.0 / fmax(-modes->sigma, 1e-300));
    r->turns = fmax(r->turns, fmax(ring * lasts, piece->omega * piece->segment->to));
    r->parts = fmax(r->parts, dea_piece_parts(piece, modes));
}

static bool at_resonance(const dea_piece *piece, const dea_modes *modes)
{
    double worst = INFINITY;
    for (int k = 0; k < DEA_HARMONICS && piece->omega > 0.0; k++) {
        const double omega = (k + 1) * piece->omega;
        const double size = modes->chain.mass * omega * omega;
        if (cabs(piece->harmonics[k]) > 0.0 && size > 0.0) {
            worst = fmin(worst, cabs(dea_chain_stiffness(&modes->chain, dea_complex(0.0, omega))) / size);
        }
    }
    return worst < 1e-6;
}

static dea_status run_segment(run *r, const dea_segment *segment, bool last, dea_error *error)
{
    const dea_status status = enter(r, segment, error);
    if (status != DEA_OK || r->lost) {
        return status;
    }
    const dea_modes *modes = &r->now->modes;
    const dea_piece piece = dea_piece_make(&r->signal, segment, &r->linear, modes);
    if (at_resonance(&piece, modes)) {
        return dea_fail(error, DEA_ERROR_UNSUPPORTED, "the sine drives the film at an undamped resonance");
    }
    const double branches = branch_energy(r);
    const dea_motion first = r->motion;
    dea_course start = r->course;
    dea_piece_shift(&piece, modes, 0.0, -1.0, &start);
    write_rows(r, &piece, &start, last);

    dea_advance whole;
    r->course = start;
    dea_advance_make(modes, piece.length, &whole);
    dea_advance_take(modes, &whole, &piece.force, &r->course);
    r->motion = dea_piece_motion(&piece, modes, &r->course, piece.length);
    dea_piece_shift(&piece, modes, piece.length, 1.0, &r->course);
    r->force = r->linear.force * segment->end * segment->end;
    audit_piece(r, &piece, &start, first, branches);
    count_turns(r, &piece);
    return DEA_OK;
}

/* Rounding relative to the peak: of the modes' parts, of the phase after many turns, of what a sine takes apart. */
static double error_of(const run *r)
{
    const double epsilon = 2.3e-16;
    const double parts = r->peak > 0.0 ? r->parts / r->peak : 0.0;
    return epsilon * (100.0 * r->cancellation + 20.0 * r->turns + 4.0 * parts);
}

static double resonance_of(run *r)
{
    dea_modes modes;
    if (r->chain.mass == 0.0 || dea_modes_find(&r->chain, &modes) == DEA_MODES_UNSTABLE || !modes.pair) {
        return NAN;
    }
    return modes.square < 0.0 ? sqrt(-modes.square) / (2.0 * DEA_PI) : NAN;
}

/* Branch states as the dynamics have them: the stress S = K z that each has relaxed to. */
static void stresses(const run *r, double *z)
{
    for (size_t i = 0; i < r->chain.count; i++) {
        z[i] *= r->chain.stiffness;
    }
}

static void close_audit(run *r, const dea_moment *first, dea_summary *summary)
{
    double first_z[DEA_PRONY_MAX], last_z[DEA_PRONY_MAX];
    const dea_segment *end = &r->signal.segments[r->signal.count - 1];
    for (size_t i = 0; i < r->chain.count; i++) {
        first_z[i] = first->u;
    }
    dea_modes_branches(&r->now->modes, &r->course.place, last_z);
    stresses(r, first_z);
    stresses(r, last_z);
    const dea_moment last = {.voltage = end->end, .u = r->motion.u, .v = r->motion.v};
    dea_audit_close(&r->audit, &r->dynamics, first, first_z, &last, last_z, summary);
}

static dea_status run_segments(run *r, dea_summary *summary, dea_error *error)
{
    dea_status status = DEA_OK;
    dea_moment first = {0};
    for (size_t i = 0; i < r->signal.count && status == DEA_OK && !r->lost; i++) {
        const dea_segment *segment = &r->signal.segments[i];
        if (i == 0 && r->scene->transient.from_bias) {
            const double square = segment->start * segment->start;
            first = (dea_moment){.voltage = segment->start,
                                 .u = r->linear.force * square / (r->chain.stiffness + r->linear.softening * square)};
        }
        status = run_segment(r, segment, i + 1 == r->signal.count, error);
    }
    *summary = dea_summary_failed();
    if (status == DEA_OK && !r->lost) {
        close_audit(r, &first, summary);
    }
    summary->error = error_of(r);
    summary->resonance = resonance_of(r);
    return status;
}

dea_status dea_direct_transient(void *session, const dea_scene *scene, const dea_model *model, dea_sample *samples,
                                dea_summary *summary, dea_error *error)
{
    (void)session;
    const char *why = dea_direct_refuses_transient(scene, model);
    if (why) {
        return dea_fail(error, DEA_ERROR_UNSUPPORTED, "%s", why);
    }
    run *r = calloc(1, sizeof *r);
    if (!r) {
        return dea_fail(error, DEA_ERROR_MEMORY, "out of memory for the modes of a run");
    }
    r->scene = scene;
    r->samples = samples;
    dea_status status = open_run(r, model, error);
    if (status == DEA_OK) {
        status = run_segments(r, summary, error);
    }
    close_run(r);
    free(r);
    return status;
}
