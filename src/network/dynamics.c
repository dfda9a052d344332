#include "network/dynamics.h"

#include <math.h>
#include <stddef.h>
#include <stdlib.h>

#include "film/point.h"
#include "study/study.h"
#include "support/gauss.h"

enum { TENSION, PUSH, CAPACITANCE, STRESSES, OUTPUTS = STRESSES + 2 * DEA_STRESSES };

/* Slowest first. */
static int by_time(const void *a, const void *b)
{
    const double x = ((const dea_branch *)a)->tau;
    const double y = ((const dea_branch *)b)->tau;
    return (x < y) - (x > y);
}

/* One branch in the form that the reduction wants, its share of the long-term stress. */
static void add_branch(dea_dynamics *d, dea_branch_form form, dea_branch branch)
{
    switch (form) {
    case DEA_BRANCH_OUT:
        break;
    case DEA_BRANCH_SPRING:
        d->held += branch.share;
        break;
    case DEA_BRANCH_DAMPER:
        d->retardation += branch.share * branch.tau;
        break;
    case DEA_BRANCH_WHOLE:
        d->branches[d->branch_count++] = branch;
        break;
    }
}

/* From shares of the long-term stress to those of S = (1 + held) of it. */
static void share_out(dea_dynamics *d)
{
    const double whole = 1.0 + d->held;
    d->retardation /= whole;
    for (size_t i = 0; i < d->branch_count; i++) {
        d->branches[i].share /= whole;
        d->total_share += d->branches[i].share;
    }
}

/* Those of the same time are one. */
static void join_branches(dea_dynamics *d)
{
    const size_t count = d->branch_count;
    qsort(d->branches, count, sizeof *d->branches, by_time);
    d->branch_count = 0;
    for (size_t i = 0; i < count; i++) {
        if (d->branch_count > 0 && d->branches[d->branch_count - 1].tau == d->branches[i].tau) {
            d->branches[d->branch_count - 1].share += d->branches[i].share;
        } else {
            d->branches[d->branch_count++] = d->branches[i];
        }
    }
}

bool dea_dynamics_relax(dea_dynamics *d, const dea_scene *scene)
{
    const dea_material *material = &scene->material;
    double rest = 1.0;
    d->held = d->total_share = 0.0;
    d->branch_count = 0;
    d->retardation = isnan(material->retardation) || scene->reduction.damper ? 0.0 : material->retardation;
    for (size_t i = 0; i < material->prony_count; i++) {
        rest -= material->prony[i].g;
    }
    for (size_t i = 0; i < material->prony_count && rest > 0.0; i++) {
        const dea_prony branch = dea_material_branch(material, i);
        add_branch(d, scene->reduction.branches[i], (dea_branch){branch.g / rest, branch.tau});
    }
    share_out(d);
    join_branches(d);
    return rest > 0.0;
}

static void set_port(const dea_scene *scene, dea_dynamics *d)
{
    const dea_drive *drive = &scene->drive;
    const double series = dea_series_resistance(scene);
    d->port = !isnan(series) || !isnan(drive->leakage_resistance);
    d->series = isnan(series) ? 0.0 : series;
    if (scene->reduction.series) {
        d->dropped = d->series;
        d->series = 0.0;
    }
    d->limit = drive->current_limit > 0.0 ? drive->current_limit : (double)INFINITY;
    d->conductance = isnan(drive->leakage_resistance) ? 0.0 : 1.0 / drive->leakage_resistance;
}

void dea_dynamics_stresses(const dea_dynamics *d, dea_network *network, dea_network_stress *stresses)
{
    const int count = dea_network_stresses(network, stresses);
    for (int a = 0; a < count && d->held > 0.0; a++) {
        stresses[a].stress = dea_expr_scale(&network->pool, 1.0 + d->held, stresses[a].stress);
    }
}

dea_expr dea_dynamics_push(const dea_dynamics *d, dea_network *network)
{
    dea_pool *pool = &network->pool;
    const dea_expr load = dea_network_load(network);
    if (!d->softens) {
        return load;
    }
    return dea_expr_sub(pool, load, dea_expr_mul(pool, dea_network_softening(network), network->edge));
}

dea_linear dea_dynamics_linear(const dea_dynamics *d)
{
    dea_linear linear;
    d->model->linear(&d->point, &linear);
    linear.stiffness *= 1.0 + d->held;
    linear.softening = d->softens ? linear.softening : 0.0;
    return linear;
}

/* The functions of u under 1 V, so that the force is phi. */
static dea_status compile(dea_network *network, dea_dynamics *d, dea_error *error)
{
    dea_network_stress stresses[DEA_STRESSES];
    d->stress_count = (size_t)dea_network_stresses(network, stresses);
    dea_dynamics_stresses(d, network, stresses);
    dea_expr refs[OUTPUTS] = {
        [TENSION] = dea_network_tension(network), [PUSH] = dea_dynamics_push(d, network), [CAPACITANCE] = network->capacitance};
    for (size_t a = 0; a < d->stress_count; a++) {
        refs[STRESSES + 2 * a] = stresses[a].stress;
        refs[STRESSES + 2 * a + 1] = stresses[a].lever;
    }
    d->seen = (double)NAN;
    const dea_status status = dea_tape_compile(&network->pool, refs, STRESSES + 2 * (int)d->stress_count, &d->tape, error);
    return status == DEA_OK ? dea_balance_open(network, &d->balance, error) : status;
}

/* The film sees its own voltage, whatever the resistances leave of the source's. */
static dea_scene film_of(const dea_scene *scene)
{
    dea_scene film = *scene;
    film.electrode.sheet_resistance = film.drive.series_resistance = film.drive.leakage_resistance = (double)NAN;
    film.drive.voltage = 1.0;
    return film;
}

/* That voltage is symbol 0. */
static dea_status build(const dea_scene *scene, dea_dynamics *d, dea_error *error)
{
    const dea_scene film = film_of(scene);
    dea_network network;
    const dea_axis voltage = {.offset = offsetof(dea_scene, drive.voltage)};
    dea_status status = dea_network_build(&film, d->model, &voltage, &network, error);
    if (status == DEA_OK) {
        status = compile(&network, d, error);
    }
    dea_network_free(&network);
    return status;
}

static dea_status place(const dea_scene *scene, dea_dynamics *d, dea_error *error)
{
    const dea_scene film = film_of(scene);
    dea_film_prepare(&film, &d->point.film);
    dea_point_place(&film, &d->point);
    if (!dea_point_valid(&d->point) || !(dea_electrode_mass(scene) >= 0.0)) {
        char fault[DEA_FAULT_LENGTH];
        return dea_fail(error, DEA_ERROR_USAGE, "%s", dea_film_fault(&d->point.film, fault));
    }
    return DEA_OK;
}

dea_status dea_dynamics_settle(const dea_scene *scene, const dea_model *model, dea_dynamics *d, dea_error *error)
{
    *d = (dea_dynamics){.model = model,
                        .radius = NAN,
                        .focal_length = scene->actuator.focal_length,
                        .refractive_index = scene->actuator.refractive_index,
                        .damping = dea_scene_edge(scene).damping};
    d->softens = !scene->reduction.softening;
    const double shift = dea_material_shift(&scene->material);
    if (!(shift > 0.0 && isfinite(shift))) {
        return dea_fail(error, DEA_ERROR_USAGE, "the shift factors of the material do not reach the temperature %g K", scene->material.temperature);
    }
    if (!dea_dynamics_relax(d, scene)) {
        return dea_fail(error, DEA_ERROR_USAGE, "the shares g of the branches sum to 1 or more");
    }
    const dea_status status = place(scene, d, error);
    if (status != DEA_OK) {
        return status;
    }
    d->framed = !model->linear;
    d->linear = !d->framed && !scene->electrode.law && !dea_point_is_loaded(&d->point);
    if (dea_point_is_pulled(&d->point) && !dea_dynamics_equilibrium(d, 0.0, &d->rest)) {
        d->rest = (double)NAN;
    }
    set_port(scene, d);
    d->biased = scene->transient.from_bias;
    const bool massive = dea_point_mass(scene, &d->point) > 0.0;
    d->heavy = massive && dea_study_of(scene)->timed;
    d->clamped = d->series > 0.0 || d->dropped > 0.0 || massive || dea_dynamics_is_damped(d) || !isnan(scene->material.retardation);
    d->radius = d->point.coverage * d->point.frame_radius;
    d->mass = scene->reduction.mass ? 0.0 : dea_point_mass(scene, &d->point);
    if (!isnan(d->focal_length) && !(d->focal_length * (d->refractive_index - 1.0) >= d->radius)) {
        return dea_fail(error, DEA_ERROR_USAGE,
                        "the cap of the lens cannot have so short a focal length: its radius of curvature, "
                        "%.9g m, is less than the lens radius, %.9g m",
                        d->focal_length * (d->refractive_index - 1.0), d->radius);
    }
    return DEA_OK;
}

dea_status dea_dynamics_open(const dea_scene *scene, const dea_model *model, dea_dynamics *d, dea_error *error)
{
    const dea_status status = dea_dynamics_settle(scene, model, d, error);
    if (!model->dynamic || model->membrane) {
        return dea_fail(error, DEA_ERROR_UNSUPPORTED, "the model %s has %s", model->name,
                        model->dynamic ? "more than one node" : "no time domain");
    }
    return status == DEA_OK ? build(scene, d, error) : status;
}

void dea_dynamics_close(dea_dynamics *dynamics)
{
    dea_tape_free(&dynamics->tape);
    dea_balance_close(&dynamics->balance);
}

dea_edge dea_dynamics_edge(dea_dynamics *dynamics, double u)
{
    dea_tape *tape = &dynamics->tape;
    if (!(u == dynamics->seen)) { /* rates and energies of one state are asked for one after the other */
        dea_tape_run(tape, 1.0, u);
        dynamics->seen = u;
    }
    dea_edge e;
    e.tension = dea_tape_value(tape, TENSION);
    e.tension_slope = dea_tape_slope(tape, TENSION);
    e.push = dea_tape_value(tape, PUSH);
    e.push_slope = dea_tape_slope(tape, PUSH);
    e.capacitance = dea_tape_value(tape, CAPACITANCE);
    e.capacitance_slope = dea_tape_slope(tape, CAPACITANCE);
    for (size_t a = 0; a < dynamics->stress_count; a++) {
        const int stress = STRESSES + 2 * (int)a, lever = stress + 1;
        e.stress[a] = dea_tape_value(tape, stress);
        e.stress_slope[a] = dea_tape_slope(tape, stress);
        e.lever[a] = dea_tape_value(tape, lever);
        e.lever_slope[a] = dea_tape_slope(tape, lever);
    }
    return e;
}

/* sum c_i (S_a - z_ai) of stress number @p a, and what it loses a second. */
static double branch_stress(const dea_dynamics *d, const dea_edge *e, size_t a, const double *z)
{
    double sum = 0.0;
    for (size_t i = 0; i < d->branch_count; i++) {
        sum += d->branches[i].share * (e->stress[a] - z[a * d->branch_count + i]);
    }
    return sum;
}

static double branch_loss(const dea_dynamics *d, const dea_edge *e, size_t a, const double *z)
{
    double sum = 0.0;
    for (size_t i = 0; i < d->branch_count; i++) {
        sum += d->branches[i].share * (e->stress[a] - z[a * d->branch_count + i]) / d->branches[i].tau;
    }
    return sum;
}

double dea_edge_held(const dea_dynamics *d, const dea_edge *e, const double *z)
{
    double sum = e->tension;
    for (size_t a = 0; a < d->stress_count; a++) {
        sum += e->lever[a] * (z ? e->stress[a] + branch_stress(d, e, a, z) : e->stress[a]);
    }
    return sum;
}

/* Slope of what the film holds, @p share the stress that goes with a strain, over that of the relaxed film. */
static double held_slope(const dea_dynamics *d, const dea_edge *e, double share, const double *z)
{
    double sum = e->tension_slope;
    for (size_t a = 0; a < d->stress_count; a++) {
        const double stress = z ? e->stress[a] + branch_stress(d, e, a, z) : e->stress[a];
        sum += e->lever[a] * share * e->stress_slope[a] + e->lever_slope[a] * stress;
    }
    return sum;
}

double dea_edge_held_slope(const dea_dynamics *d, const dea_edge *e, const double *z)
{
    return held_slope(d, e, z ? 1.0 + d->total_share : 1.0, z);
}

double dea_edge_viscous(const dea_dynamics *d, const dea_edge *e)
{
    double sum = 0.0;
    for (size_t a = 0; a < d->stress_count; a++) {
        sum += e->lever[a] * e->stress_slope[a];
    }
    return sum;
}

double dea_edge_resistance(const dea_dynamics *d, const dea_edge *e)
{
    return d->retardation * dea_edge_viscous(d, e) + d->damping;
}

double dea_edge_viscous_slope(const dea_dynamics *d, const dea_edge *e)
{
    double sum = 0.0;
    for (size_t a = 0; a < d->stress_count; a++) {
        sum += e->lever_slope[a] * e->stress_slope[a];
    }
    return sum;
}

void dea_edge_relax(const dea_dynamics *d, const dea_edge *e, double *z)
{
    for (size_t a = 0; a < d->stress_count; a++) {
        for (size_t i = 0; i < d->branch_count; i++) {
            z[a * d->branch_count + i] = e->stress[a];
        }
    }
}

bool dea_dynamics_equilibrium(const dea_dynamics *dynamics, double voltage, double *u)
{
    dea_point point = dynamics->point;
    dea_row row = dea_row_failed();
    point.voltage = voltage;
    dea_model_solve(dynamics->model, &point, 1e-12, &row);
    *u = row.displacement;
    return row.state != DEA_STATE_PULL_IN && row.state != DEA_STATE_FAILED;
}

bool dea_dynamics_begin(const dea_dynamics *d, bool from_bias, double source, double *u, double *voltage)
{
    *voltage = from_bias ? dea_dynamics_rest(d, source) : 0.0;
    *u = d->rest;
    return from_bias ? dea_dynamics_equilibrium(d, *voltage, u) : isfinite(*u);
}

double dea_dynamics_stiffness(dea_dynamics *dynamics, double u, double voltage, bool relaxed)
{
    const dea_edge e = dea_dynamics_edge(dynamics, u);
    const double share = relaxed ? 1.0 : 1.0 + dynamics->total_share;
    return held_slope(dynamics, &e, share, NULL) - e.push_slope * voltage * voltage;
}

double dea_dynamics_hold(dea_dynamics *dynamics, double u, double voltage, const double *z)
{
    const dea_edge e = dea_dynamics_edge(dynamics, u);
    const double pull = 2.0 * e.push * voltage; /* dF/dU */
    const double charge = dynamics->series > 0.0 ? pull * pull / e.capacitance : 0.0;
    return dea_edge_held_slope(dynamics, &e, z) - e.push_slope * voltage * voltage + charge;
}

double dea_dynamics_scale(dea_dynamics *dynamics, double voltage)
{
    const double rest = isnan(dynamics->rest) ? 0.0 : dynamics->rest;
    const dea_edge e = dea_dynamics_edge(dynamics, rest);
    const double size = fabs(rest) + fabs(e.push * voltage * voltage / dea_edge_held_slope(dynamics, &e, NULL));
    const double longest = fmin(dynamics->radius, dynamics->point.frame_radius - dynamics->radius);
    return size > 0.0 && size < longest ? size : longest;
}

/* Net force without mass and damper, sum B_a [S_a + sum c_i (S_a - z_ai)] + G - phi U^2, and its slope over u. */
static double imbalance(dea_dynamics *d, double u, double voltage, const double *z, double *slope)
{
    const dea_edge e = dea_dynamics_edge(d, u);
    *slope = dea_edge_held_slope(d, &e, z) - e.push_slope * voltage * voltage;
    return dea_edge_held(d, &e, z) - e.push * voltage * voltage;
}

/* Newton on imbalance = wanted from *u on, over stable states only. */
static bool newton(dea_dynamics *d, double voltage, const double *z, double wanted, double *u)
{
    const double longest = fmin(d->radius, d->point.frame_radius - d->radius);
    double last = INFINITY;
    for (int i = 0; i < 30; i++) {
        double slope;
        const double excess = imbalance(d, *u, voltage, z, &slope) - wanted;
        if (!(slope > 0.0)) {
            return false;
        }
        const double step = excess / slope;
        if (!(fabs(step) <= 0.1 * longest)) {
            return false;
        }
        *u -= step;
        if (fabs(step) <= 4e-16 * fabs(*u) || (fabs(step) < 1e-10 * longest && fabs(step) >= 0.5 * last)) {
            return true;
        }
        last = fabs(step);
    }
    return last <= 1e-12 * longest;
}

/* Square of the voltage that holds u, with the branches where they are [V^2]. */
static double holding_square(dea_dynamics *d, double u, const double *z)
{
    const dea_edge e = dea_dynamics_edge(d, u);
    const double square = dea_edge_held(d, &e, z) / e.push;
    return square > 0.0 ? square : 0.0;
}

/* The load grows from what holds u now: under the full one a film that stiffens later on need not be stable here. */
bool dea_dynamics_follow(dea_dynamics *dynamics, double voltage, const double *z, double *u)
{
    double slope;
    const double before = holding_square(dynamics, *u, z);
    const double start = imbalance(dynamics, *u, sqrt(before), z, &slope);
    double at = 0.0; /* share of the change of the load that is made */
    double step = 1.0;
    while (at < 1.0) {
        const double next = fmin(1.0, at + step);
        const double square = before + next * (voltage * voltage - before);
        double guess = *u;
        if (newton(dynamics, next < 1.0 ? sqrt(square) : voltage, z, (1.0 - next) * start, &guess)) {
            *u = guess;
            at = next;
            step *= 2.0;
        } else {
            step *= 0.25;
            if (step < 1e-9) {
                return false;
            }
        }
    }
    return true;
}

/* K v = 2 phi U U' + sum B_a c_i (S_a - z_ai)/tau_i, U' = slope - reaction v. */
static double velocity(dea_dynamics *d, double u, double voltage, double slope, double reaction, const double *z)
{
    double stiffness;
    const double force = imbalance(d, u, voltage, z, &stiffness);
    const dea_edge e = dea_dynamics_edge(d, u);
    if (dea_dynamics_is_damped(d)) {
        return -force / dea_edge_resistance(d, &e);
    }
    const double push = 2.0 * e.push * voltage;
    double loss = 0.0;
    for (size_t a = 0; a < d->stress_count; a++) {
        loss += e.lever[a] * branch_loss(d, &e, a, z);
    }
    return (push * slope + loss) / (stiffness + push * reaction);
}

double dea_dynamics_velocity(dea_dynamics *dynamics, double u, double voltage, double slope, const double *z)
{
    return velocity(dynamics, u, voltage, slope, 0.0, z);
}

double dea_dynamics_velocity_charged(dea_dynamics *dynamics, double u, double voltage, double slope, const double *z)
{
    const dea_edge e = dea_dynamics_edge(dynamics, u);
    return velocity(dynamics, u, voltage, slope, voltage * e.capacitance_slope / e.capacitance, z);
}

dea_sample dea_sample_refused(double time, double voltage, dea_state state)
{
    const double none = (double)NAN;
    return (dea_sample){time, voltage, none, none, none, none, none, none, none, none, none, state, {none, none, none, none}};
}

void dea_samples_refuse(const dea_scene *scene, const dea_signal *signal, size_t from, dea_state state, dea_sample *samples)
{
    size_t near = 0;
    for (size_t i = from; i < dea_layout_of(scene).rows; i++) {
        const double time = dea_layout_place(scene, i);
        near = dea_signal_find(signal, near, time);
        samples[i] = dea_sample_refused(time, dea_segment_voltage(signal, dea_segment_seen(&signal->segments[near], time), time), state);
    }
}

/* Within the limit; NAN stays. */
static double held_within(const dea_dynamics *d, double current)
{
    return current > d->limit ? d->limit : current < -d->limit ? -d->limit : current;
}

double dea_dynamics_flow(const dea_dynamics *d, double drop)
{
    return held_within(d, drop / d->series);
}

double dea_dynamics_excess(const dea_dynamics *d, double drop)
{
    return fabs(drop) / (d->series * d->limit) - 1.0;
}

double dea_dynamics_rest(const dea_dynamics *d, double source)
{
    const double current = source * d->conductance / (1.0 + d->series * d->conductance);
    return fabs(current) > d->limit ? held_within(d, current) / d->conductance : source / (1.0 + d->series * d->conductance);
}

/* Current of the source: through R_s, or d(C U)/dt and the leakage. */
static double current(const dea_dynamics *d, const dea_edge *e, const dea_moment *m)
{
    if (m->charging) {
        return held_within(d, m->charge_slope + m->voltage * d->conductance);
    }
    if (d->series > 0.0) {
        return dea_dynamics_flow(d, m->source - m->voltage);
    }
    return e->capacitance * m->slope + e->capacitance_slope * m->v * m->voltage + m->voltage * d->conductance;
}

double dea_dynamics_current(dea_dynamics *dynamics, const dea_moment *moment)
{
    const dea_edge e = dea_dynamics_edge(dynamics, moment->u);
    return current(dynamics, &e, moment);
}

/* The first sample of a run from rest, over a resistance that the network leaves out: the film has no charge yet. */
static void sample_uncharged(dea_dynamics *dynamics, const dea_moment *moment, dea_sample *sample)
{
    const dea_moment rest = {.time = moment->time, .u = dynamics->rest};
    const double series = dynamics->dropped;
    dynamics->dropped = 0.0;
    (void)dea_dynamics_sample(dynamics, &rest, sample);
    dynamics->dropped = series;
    sample->voltage = moment->source;
    sample->current = moment->source / series;
}

bool dea_dynamics_is_damped(const dea_dynamics *d)
{
    return d->retardation > 0.0 || d->damping > 0.0;
}

bool dea_dynamics_is_free(const dea_dynamics *d)
{
    return !(d->mass > 0.0) && !dea_dynamics_is_damped(d);
}

void dea_dynamics_lighten(dea_dynamics *d, double accuracy)
{
    const dea_edge e = dea_dynamics_edge(d, 0.0);
    const double resistance = dea_edge_resistance(d, &e);
    if (d->mass * dea_dynamics_stiffness(d, 0.0, 0.0, false) <= 1e-3 * accuracy * resistance * resistance) {
        d->mass = 0.0;
    }
}

bool dea_dynamics_inside(dea_dynamics *dynamics, double u)
{
    const bool framed = u > -dynamics->radius && u < dynamics->point.frame_radius - dynamics->radius;
    const bool charged = dynamics->port || dynamics->point.film.electrostriction != 0.0;
    return framed && (!charged || dea_dynamics_edge(dynamics, u).capacitance > 0.0);
}

void dea_dynamics_start(dea_dynamics *dynamics, dea_moment *moment)
{
    if (moment->time != 0.0) {
        return;
    }
    if (!dynamics->biased) {
        moment->u = dynamics->heavy ? dynamics->rest : moment->u;
        moment->v = dynamics->heavy ? 0.0 : moment->v;
        return;
    }
    double stiffness;
    const dea_edge e = dea_dynamics_edge(dynamics, moment->u);
    double z[DEA_RELAXED_MAX];
    dea_edge_relax(dynamics, &e, z);
    (void)imbalance(dynamics, moment->u, moment->voltage, z, &stiffness);
    moment->v = dynamics->clamped ? 0.0 : 2.0 * e.push * moment->voltage * moment->slope / stiffness;
    moment->charging = dynamics->series > 0.0 || dynamics->dropped > 0.0;
    moment->charge_slope = 0.0;
}

bool dea_dynamics_sample(dea_dynamics *dynamics, const dea_moment *moment, dea_sample *sample)
{
    dea_row row = dea_row_failed();
    if (dynamics->dropped > 0.0 && moment->time == 0.0 && !dynamics->biased) {
        sample_uncharged(dynamics, moment, sample);
        return true;
    }
    dea_moment started = *moment;
    dea_dynamics_start(dynamics, &started);
    moment = &started;
    const bool inside = dea_dynamics_inside(dynamics, moment->u);
    if (inside) {
        dea_balance_fill(&dynamics->balance, moment->voltage, moment->u, &row);
    }
    if (!inside || row.state == DEA_STATE_FAILED || !isfinite(moment->v)) {
        *sample = dea_sample_refused(moment->time, moment->source, DEA_STATE_PULL_IN);
        return false;
    }
    *sample = dea_sample_refused(moment->time, moment->source, row.state);
    sample->displacement = row.displacement;
    sample->strain = row.strain;
    sample->velocity = moment->v;
    sample->force = row.force;
    if (dynamics->port) {
        const dea_edge e = dea_dynamics_edge(dynamics, moment->u);
        sample->current = current(dynamics, &e, moment);
        sample->charge = e.capacitance * moment->voltage;
        sample->capacitance = e.capacitance;
    }
    sample->focal_length = row.focal_length;
    sample->film_voltage = moment->voltage;
    return true;
}

/* sum B_a c_i (S_a - z_ai) [N]. */
static double branch_force(const dea_dynamics *d, const dea_edge *e, const double *z)
{
    double sum = 0.0;
    for (size_t a = 0; a < d->stress_count; a++) {
        sum += e->lever[a] * branch_stress(d, e, a, z);
    }
    return sum;
}

void dea_audit_add(dea_audit *audit, dea_dynamics *dynamics, const dea_moment *m, const double *z, double weight)
{
    const dea_edge e = dea_dynamics_edge(dynamics, m->u);
    const double square = m->voltage * m->voltage;
    const double leak = square * dynamics->conductance;
    const bool series = dynamics->series > 0.0;
    const double flow = series ? current(dynamics, &e, m) : 0.0;
    const double work = series ? m->source * flow : e.push * square * m->v + leak;
    const double kept = fmax(0.0, fabs(m->source - m->voltage) - dynamics->series * dynamics->limit); /* by a source at its limit [V] */
    const double ohmic = leak + flow * flow * dynamics->series + (kept > 0.0 ? kept * fabs(flow) : 0.0);
    audit->work += weight * work;
    audit->dissipated += weight * (ohmic + dea_edge_resistance(dynamics, &e) * m->v * m->v);
    audit->branch += weight * branch_force(dynamics, &e, z) * m->v;
    const double kinetic = 0.5 * dynamics->mass * m->v * m->v;
    audit->largest = fmax(fmax(audit->largest, kinetic), fmax(fabs(audit->work), fabs(audit->dissipated)));
}

enum { PANELS = 16 };

/* What the relaxed film holds, and where z is given the force of the branches instead, integrated over u from u to @p to. */
static double force_integral(dea_dynamics *d, double u, double to, const double *z)
{
    double sum = 0.0;
    for (int panel = 0; panel < PANELS; panel++) {
        for (int i = 0; i < DEA_GAUSS_POINTS; i++) {
            const double place = ((double)panel + dea_gauss_place(i)) / PANELS;
            const dea_edge e = dea_dynamics_edge(d, u + (to - u) * place);
            sum += dea_gauss_weight(i) * (z ? branch_force(d, &e, z) : dea_edge_held(d, &e, NULL));
        }
    }
    return sum * (to - u) / PANELS;
}

void dea_audit_jump(dea_audit *audit, dea_dynamics *dynamics, double u, double to, const double *z)
{
    const double branch = dynamics->branch_count > 0 ? force_integral(dynamics, u, to, z) : 0.0;
    audit->branch += branch;
    audit->work += branch + force_integral(dynamics, u, to, NULL);
    audit->largest = fmax(audit->largest, fabs(audit->work));
}

/* Energy of the branches' springs: (1/2) f_i^2/k_i with f_i = c_i sum B_a (S_a - z_ai) and k_i = c_i sum B_a S_a'. */
static double branch_energy(dea_dynamics *d, double u, const double *z)
{
    const dea_edge e = dea_dynamics_edge(d, u);
    const double viscous = dea_edge_viscous(d, &e);
    double sum = 0.0;
    for (size_t i = 0; i < d->branch_count; i++) {
        double force = 0.0;
        for (size_t a = 0; a < d->stress_count; a++) {
            force += e.lever[a] * (e.stress[a] - z[a * d->branch_count + i]);
        }
        sum += 0.5 * d->branches[i].share * force * force / viscous;
    }
    return sum;
}

static double electric_energy(dea_dynamics *d, const dea_moment *m)
{
    return 0.5 * dea_dynamics_edge(d, m->u).capacitance * m->voltage * m->voltage;
}

void dea_audit_close(const dea_audit *audit, dea_dynamics *dynamics, const dea_moment *first, const double *first_z,
                     const dea_moment *last, const double *last_z, dea_summary *summary)
{
    const double springs = branch_energy(dynamics, last->u, last_z) - branch_energy(dynamics, first->u, first_z);
    const double before = electric_energy(dynamics, first);
    const double after = electric_energy(dynamics, last);
    summary->electric = after - before;
    summary->elastic = force_integral(dynamics, first->u, last->u, NULL) + springs;
    summary->kinetic = 0.5 * dynamics->mass * (last->v * last->v - first->v * first->v);
    summary->work = audit->work + (dynamics->series > 0.0 ? 0.0 : summary->electric);
    summary->dissipated = audit->dissipated + audit->branch - springs;
    if (dynamics->mass == 0.0) {
        summary->kinetic = 0.0;
    }
    const double spent = summary->electric + summary->elastic + summary->kinetic + summary->dissipated;
    double largest = fmax(audit->largest, fabs(audit->branch));
    largest = fmax(largest, fmax(fabs(summary->elastic), fmax(before, after)));
    summary->residual = largest > 0.0 ? fabs(summary->work - spent) / largest : 0.0;
}
