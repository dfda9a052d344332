/* Transients of the linear network: exact on every segment of the source voltage, joined at the edges. */
#include <stdlib.h>
#include <string.h>

#include "engine/direct/direct.h"
#include "engine/direct/walk.h"

/* Samples that are stepped from one to the next before the state is computed anew from the begin of the segment. */
enum { STEPS = 64 };

static const char varies[] = "the voltage softens the film, which has a closed form only while the voltage is constant";

typedef struct run {
    const dea_scene *scene;
    dea_dynamics dynamics;
    dea_signal signal;
    dea_walk walk;
    dea_sample *samples;
    size_t rows, row; /* the next one */
    dea_audit audit;
    double integrals[DEA_WINDOWS]; /* of u over the windows of the scene [m s] */
    dea_peak current;              /* largest of the source, while known */
    bool known;
    double peak;  /* of |u| at the samples [m] */
    double parts; /* of what a sine does [m] */
    double turns; /* of the pair and of the sine, which round [rad] */
} run;

static bool is_constant(const dea_segment *segment, const dea_signal *signal)
{
    return segment->sine ? dea_curve_largest(&signal->curve) == fabs(signal->curve.offset) : segment->start == segment->end;
}

/* What a waveform asks of a closed form. */
typedef struct course {
    bool varies; /* it changes, not by jumps alone */
    bool plain;  /* straight lines and a sine */
} wave_course;

static wave_course course_of(const dea_scene *scene)
{
    dea_signal signal;
    const bool known = dea_signal_open(scene, &signal, NULL) == DEA_OK;
    wave_course c = {.varies = !known, .plain = !known || signal.curve.count == 0 || dea_curve_is_plain(&signal.curve)};
    for (size_t i = 0; known && i < signal.count; i++) {
        c.varies = c.varies || !is_constant(&signal.segments[i], &signal);
    }
    dea_signal_close(&signal);
    return c;
}

const char *dea_direct_refuses_transient(const dea_scene *scene, const dea_model *model)
{
    dea_point point;
    dea_linear linear;
    if (model->membrane) {
        return "it has no equation of the moving membrane";
    }
    if (!model->linear) {
        return "its springs are not linear, so that a transient has no closed form";
    }
    if (dea_scene_edge(scene).bent) {
        return "a spring on the edge that is not linear has no closed form in time";
    }
    if (dea_scene_is_pulled(scene)) {
        return "a steady force beside that of the voltage has no closed form here";
    }
    if (dea_series_resistance(scene) > 0.0 && !scene->reduction.series) {
        return "the charging of the film through a series resistance is not linear";
    }
    dea_film_prepare(scene, &point.film);
    dea_point_place(scene, &point);
    model->linear(&point, &linear);
    const wave_course c = course_of(scene);
    if (!c.plain) {
        return "chirps and sums of sines have no closed form here";
    }
    return linear.softening != 0.0 && !scene->reduction.softening && c.varies ? varies : NULL;
}

static dea_status check_segments(const run *r, dea_error *error)
{
    for (size_t i = 0; i < r->signal.count && r->walk.linear.softening != 0.0; i++) {
        if (!is_constant(&r->signal.segments[i], &r->signal)) {
            return dea_fail(error, DEA_ERROR_UNSUPPORTED, "%s", varies);
        }
    }
    return DEA_OK;
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
    r->walk = (dea_walk){.signal = &r->signal,
                         .linear = dea_dynamics_linear(&r->dynamics),
                         .every = r->scene->transient.every,
                         .from_bias = r->scene->transient.from_bias};
    r->walk.chain = dea_walk_chain(&r->dynamics, r->walk.linear.stiffness);
    r->walk.chain.stiffness += r->walk.linear.beside;
    r->rows = dea_layout_of(r->scene).rows;
    r->known = dea_peak_is_known(r->scene, &r->dynamics, &r->signal);
    return check_segments(r, error);
}

static void close_run(run *r)
{
    dea_dynamics_close(&r->dynamics);
    dea_signal_close(&r->signal);
}

/* Rows from the next one on: pull-in. */
static void refuse_rest(run *r)
{
    dea_samples_refuse(r->scene, &r->signal, r->row, DEA_STATE_PULL_IN, r->samples);
    r->row = r->rows;
    r->walk.lost = true;
}

static void write_row(run *r, const dea_piece *piece, const dea_course *course, double time, double t)
{
    const double voltage = dea_segment_voltage(&r->signal, piece->segment, time);
    const dea_motion motion = dea_piece_motion(piece, &r->walk.now->modes, course, t);
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

/* Rows of one segment. The amplitudes step from sample to sample; now and then, and always where samples are not even, they come
 * from the begin of the segment, so that no rounding adds up. */
static void write_rows(run *r, const dea_piece *piece, const dea_course *start, bool last)
{
    dea_course course = *start;
    const size_t most = r->scene->transient.logarithmic ? 0 : STEPS;
    size_t steps = most;
    double before = 0.0;
    while (r->row < r->rows && !r->walk.lost) {
        const double time = dea_layout_place(r->scene, r->row);
        const double t = fmax(time - piece->segment->from, 0.0);
        if (time > piece->segment->to && !last) {
            return;
        }
        if (steps >= most || r->row + 1 == r->rows) {
            dea_advance fresh;
            course = *start;
            dea_advance_make(&r->walk.now->modes, t, &fresh);
            dea_advance_take(&r->walk.now->modes, &fresh, &piece->force, &course);
            steps = 0;
        } else {
            const dea_forcing force = dea_piece_force(piece, before);
            dea_advance_take(&r->walk.now->modes, &r->walk.now->every, &force, &course);
        }
        write_row(r, piece, &course, time, t);
        before = t;
        steps++;
    }
}

static void see_energies(run *r)
{
    const double kinetic = 0.5 * r->walk.chain.mass * r->walk.motion.v * r->walk.motion.v;
    const double elastic = 0.5 * r->walk.chain.stiffness * r->walk.motion.u * r->walk.motion.u;
    r->audit.largest = fmax(r->audit.largest, fmax(kinetic, elastic));
    r->audit.largest = fmax(r->audit.largest, fmax(fabs(r->audit.work), fabs(r->audit.dissipated)));
}

/* sum k_i (u - z_i)^2/2 with u - z_i = tau_i z_i'. */
static double branch_energy(const run *r)
{
    double rates[DEA_PRONY_MAX];
    double sum = 0.0;
    dea_modes_branches(&r->walk.now->modes, &r->walk.course.speed, rates);
    for (size_t i = 0; i < r->walk.chain.count; i++) {
        const double stretch = r->walk.chain.tau[i] * rates[i];
        sum += 0.5 * r->walk.chain.spring[i] * stretch * stretch;
    }
    return sum;
}

/* Without mass and damper an edge moves the film at once, the branches held: the work is what the springs take. */
static void audit_jump(run *r, double to, double branches)
{
    r->audit.branch += branches;
    r->audit.work += branches + 0.5 * r->walk.chain.stiffness * (to - r->walk.motion.u) * (to + r->walk.motion.u);
}

/* Begins a segment behind the edge in front of it. */
static dea_status enter(run *r, const dea_segment *segment, dea_error *error)
{
    const double branches = r->walk.now ? branch_energy(r) : 0.0;
    const dea_status status = dea_walk_enter(&r->walk, segment, error);
    if (status != DEA_OK) {
        return status;
    }
    if (r->walk.lost) {
        refuse_rest(r);
        return DEA_OK;
    }
    const dea_modes *modes = &r->walk.now->modes;
    if (modes->prompt > 0.0) {
        const dea_forcing now = {r->walk.force, 0.0, 0.0};
        const double to = dea_modes_displacement(modes, &r->walk.course, &now);
        audit_jump(r, to, branch_energy(r) - branches);
        r->walk.motion.u = to;
    }
    return DEA_OK;
}

/* Adds what a segment takes; @p first and @p branches: motion and energy of the branches at its begin. */
static void audit_piece(run *r, const dea_piece *piece, const dea_course *start, dea_motion first, double branches)
{
    const dea_spent spent = dea_piece_spend(piece, &r->walk.now->modes, start);
    const double leak = r->dynamics.conductance * spent.square;
    const double softened = r->walk.now->modes.chain.stiffness - r->walk.chain.stiffness;
    const double u = r->walk.motion.u;
    r->audit.work += spent.push - 0.5 * softened * (u - first.u) * (u + first.u) + leak;
    r->audit.dissipated += spent.damper + leak;
    r->audit.branch += spent.branches + branch_energy(r) - branches;
    see_energies(r);
}

/* Adds what a segment does inside the windows. */
static void integrate(run *r, const dea_piece *piece, const dea_course *start)
{
    const dea_segment *segment = piece->segment;
    for (size_t i = 0; i < r->scene->transient.average_count; i++) {
        const dea_window *window = &r->scene->transient.averages[i];
        const double from = fmax(window->from - segment->from, 0.0);
        const double to = fmin(window->to - segment->from, piece->length);
        if (from < to) {
            r->integrals[i] += dea_piece_integral(piece, &r->walk.now->modes, start, from, to);
        }
    }
}

static void count_turns(run *r, const dea_piece *piece)
{
    const dea_modes *modes = &r->walk.now->modes;
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
    if (status != DEA_OK || r->walk.lost) {
        return status;
    }
    const double branches = branch_energy(r);
    const dea_motion first = r->walk.motion;
    dea_course start;
    const dea_piece piece = dea_walk_piece(&r->walk, segment, &start);
    if (at_resonance(&piece, &r->walk.now->modes)) {
        return dea_fail(error, DEA_ERROR_UNSUPPORTED, "the sine drives the film at an undamped resonance");
    }
    write_rows(r, &piece, &start, last);
    integrate(r, &piece, &start);
    r->known = r->known && dea_direct_peak(&r->walk, &piece, &start, &r->dynamics, &r->current);
    dea_walk_pass(&r->walk, &piece, &start);
    audit_piece(r, &piece, &start, first, branches);
    count_turns(r, &piece);
    return DEA_OK;
}

/* Rounding relative to the peak: of the modes' parts, of the phase after many turns, of what a sine takes apart. */
static double error_of(const run *r)
{
    const double epsilon = 2.3e-16;
    const double parts = r->peak > 0.0 ? r->parts / r->peak : 0.0;
    return epsilon * (100.0 * r->walk.cancellation + 20.0 * r->turns + 4.0 * parts);
}

/* The complex pair of the film at 0 V. */
static void tell_swing(const run *r, dea_summary *summary)
{
    dea_modes modes;
    if (r->walk.chain.mass > 0.0 && dea_modes_find(&r->walk.chain, &modes) != DEA_MODES_UNSTABLE && modes.pair &&
        modes.square < 0.0) {
        summary->resonance = sqrt(-modes.square) / (2.0 * DEA_PI);
        summary->decay = -modes.sigma;
    }
}

/* Branch states as the dynamics have them: the stress S = K z that each has relaxed to. */
static void stresses(const run *r, double *z)
{
    for (size_t i = 0; i < r->walk.chain.count; i++) {
        z[i] *= r->walk.chain.stiffness;
    }
}

static void close_audit(run *r, const dea_moment *first, dea_summary *summary)
{
    double first_z[DEA_PRONY_MAX], last_z[DEA_PRONY_MAX];
    const dea_segment *end = &r->signal.segments[r->signal.count - 1];
    for (size_t i = 0; i < r->walk.chain.count; i++) {
        first_z[i] = first->u;
    }
    dea_modes_branches(&r->walk.now->modes, &r->walk.course.place, last_z);
    stresses(r, first_z);
    stresses(r, last_z);
    const dea_moment last = {.voltage = end->end, .u = r->walk.motion.u, .v = r->walk.motion.v};
    dea_audit_close(&r->audit, &r->dynamics, first, first_z, &last, last_z, summary);
}

static void tell_averages(const run *r, dea_summary *summary)
{
    for (size_t i = 0; i < r->scene->transient.average_count; i++) {
        const dea_window *window = &r->scene->transient.averages[i];
        const double mean = r->integrals[i] / (window->to - window->from);
        summary->averages[i] = (dea_average){mean / r->dynamics.radius, mean};
    }
}

static dea_status run_segments(run *r, dea_summary *summary, dea_error *error)
{
    dea_status status = DEA_OK;
    dea_moment first = {0};
    for (size_t i = 0; i < r->signal.count && status == DEA_OK && !r->walk.lost; i++) {
        const dea_segment *segment = &r->signal.segments[i];
        if (i == 0 && r->scene->transient.from_bias) {
            const double square = segment->start * segment->start;
            first =
                (dea_moment){.voltage = segment->start,
                             .u = r->walk.linear.force * square / (r->walk.chain.stiffness + r->walk.linear.softening * square)};
        }
        status = run_segment(r, segment, i + 1 == r->signal.count, error);
    }
    *summary = dea_summary_failed();
    if (status == DEA_OK && !r->walk.lost) {
        close_audit(r, &first, summary);
        summary->peak_current = r->known ? r->current.current : (double)NAN;
        summary->peak_time = r->known ? r->current.time : (double)NAN;
    }
    tell_averages(r, summary);
    summary->error = summary->velocity_error = error_of(r); /* rounding of modes, whose rates are as exact */
    summary->current_error = r->dynamics.port ? summary->error : (double)NAN;
    tell_swing(r, summary);
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
