#include "engine/direct/modes.h"

#include <string.h>

/* Roots that differ by less than this are one pair: apart, their residues would cancel. */
static const double close_roots = 0.5;
/* Largest cancellation that is let pass. */
static const double worst_cancellation = 1e4;

/* q_i - q_k without cancellation. */
static double rate_gap(const dea_chain *chain, size_t i, size_t k)
{
    return (chain->tau[k] - chain->tau[i]) / (chain->tau[i] * chain->tau[k]);
}

double dea_root_above(const dea_chain *chain, const dea_root *root, size_t branch)
{
    return root->pole == chain->count ? root->offset + chain->rate[branch] : root->offset + rate_gap(chain, branch, root->pole);
}

double complex dea_chain_stiffness(const dea_chain *chain, double complex s)
{
    double complex sum = (chain->mass * s + chain->damping) * s + chain->stiffness;
    for (size_t i = 0; i < chain->count; i++) {
        sum += chain->spring[i] * s / (s + chain->rate[i]);
    }
    return sum;
}

static dea_root root_at(const dea_chain *chain, size_t pole, double offset)
{
    return (dea_root){pole == chain->count ? offset : offset - chain->rate[pole], pole, offset, NAN};
}

/* p(s) times s + q_pole, which has no pole there, and its slope; p(s) itself where the root is measured from 0. */
static double secular(const dea_chain *chain, const dea_root *root, double *slope)
{
    const double s = root->value;
    double rest = (chain->mass * s + chain->damping) * s + chain->stiffness;
    *slope = 2.0 * chain->mass * s + chain->damping;
    for (size_t i = 0; i < chain->count; i++) {
        if (i != root->pole) {
            const double above = dea_root_above(chain, root, i);
            rest += chain->spring[i] * (s / above);
            *slope += chain->spring[i] * (chain->rate[i] / above) / above;
        }
    }
    if (root->pole == chain->count) {
        return rest;
    }
    *slope = rest + root->offset * *slope + chain->spring[root->pole];
    return root->offset * rest + chain->spring[root->pole] * s;
}

/* The root between two offsets from a pole where the secular function differs in sign: Newton, halving where it leaves them. */
static dea_root bracketed(const dea_chain *chain, size_t pole, double start, double end)
{
    double slope;
    dea_root root = root_at(chain, pole, start);
    const bool rises = secular(chain, &root, &slope) < 0.0;
    double low = start;
    double high = end;
    double step = INFINITY;
    for (int i = 0; i < 150; i++) {
        const double value = secular(chain, &root, &slope);
        if (value == 0.0 || !(fabs(step) > 3e-16 * fabs(root.offset))) {
            break;
        }
        *((value < 0.0) == rises ? &low : &high) = root.offset;
        double next = root.offset - value / slope;
        if (!(next > fmin(low, high) && next < fmax(low, high)) || (i > 20 && i % 3 == 0)) {
            next = 0.5 * (low + high);
        }
        step = next - root.offset;
        root = root_at(chain, pole, next);
    }
    return root;
}

static bool is_negative(const dea_chain *chain, size_t pole, double offset)
{
    double slope;
    const dea_root root = root_at(chain, pole, offset);
    return (secular(chain, &root, &slope) < 0.0) == (offset > 0.0 || pole == chain->count);
}

/* The root above the slowest pole: below 0 where the film is stable, else above. */
static dea_root slowest_root(const dea_chain *chain)
{
    const size_t none = chain->count;
    const double half = 0.5 * chain->rate[0];
    if (!is_negative(chain, 0, half)) {
        return bracketed(chain, 0, 0.0, half);
    }
    if (chain->stiffness >= 0.0) {
        return bracketed(chain, none, 0.0, -half);
    }
    double high = chain->rate[0];
    while (is_negative(chain, none, high) && high < 1e300) {
        high *= 2.0;
    }
    return bracketed(chain, none, 0.0, high);
}

/* p falls to -inf above a pole and rises to +inf below the next one. */
static dea_root root_between(const dea_chain *chain, size_t fast, size_t slow)
{
    const double half = 0.5 * rate_gap(chain, fast, slow);
    return is_negative(chain, fast, half) ? bracketed(chain, slow, 0.0, -half) : bracketed(chain, fast, 0.0, half);
}

/* Sum of the distances of the bracketed roots from the poles below them: all are positive. */
static double total_shift(const dea_modes *modes)
{
    double sum = 0.0;
    for (size_t i = 0; i < modes->chain.count; i++) {
        sum += dea_root_above(&modes->chain, &modes->roots[i], i);
    }
    return sum;
}

/* With a damper and no mass one root is below the fastest pole: the sum of all is -(K + sum k)/r - sum q. */
static void add_damped_root(dea_modes *modes)
{
    const dea_chain *chain = &modes->chain;
    double held = chain->stiffness;
    for (size_t i = 0; i < chain->count; i++) {
        held += chain->spring[i];
    }
    const double value = -held / chain->damping - total_shift(modes);
    modes->roots[modes->count++] =
        chain->count == 0 ? root_at(chain, 0, value)
                          : bracketed(chain, chain->count - 1, 0.0,
                                      1.01 * (value + chain->rate[chain->count - 1]) - 1e-3 * chain->rate[chain->count - 1]);
}

/* A root known to a few digits: measured from the pole next to it, with Newton's last steps. */
static dea_root polished(const dea_chain *chain, double value)
{
    size_t pole = chain->count;
    double offset = value;
    for (size_t i = 0; i < chain->count; i++) {
        if (fabs(value + chain->rate[i]) < fabs(offset)) {
            pole = i;
            offset = value + chain->rate[i];
        }
    }
    dea_root root = root_at(chain, pole, offset);
    for (int i = 0; i < 4; i++) {
        double slope;
        const double step = secular(chain, &root, &slope) / slope;
        if (!(fabs(step) <= 0.5 * fabs(root.offset))) {
            break;
        }
        root = root_at(chain, pole, root.offset - step);
    }
    return root;
}

/* Two real roots far from each other. One of them may be close to a bracketed root: then these two are the pair. */
static void set_real(dea_modes *modes, double first, double second)
{
    const double both[2] = {first, second};
    double closest = close_roots;
    size_t partner = 0;
    int which = -1;
    for (size_t i = 0; i < modes->count; i++) {
        for (int k = 0; k < 2; k++) {
            const double apart = fabs(modes->roots[i].value - both[k]) / fmax(fabs(both[k]), fabs(modes->roots[i].value));
            if (apart < closest) {
                closest = apart;
                partner = i;
                which = k;
            }
        }
    }
    modes->pair = which >= 0;
    if (modes->pair) {
        const double half = 0.5 * (modes->roots[partner].value - both[which]);
        modes->sigma = both[which] + half;
        modes->square = half * half;
        modes->roots[partner] = polished(&modes->chain, both[1 - which]);
    } else {
        modes->roots[modes->count++] = polished(&modes->chain, first);
        modes->roots[modes->count++] = polished(&modes->chain, second);
    }
}

/* K/(-s) of the slowest root s; without stiffness both vanish and it is r + sum k_i/q_i. */
static double slowest_share(const dea_modes *modes)
{
    const dea_chain *chain = &modes->chain;
    if (modes->roots[0].value != 0.0) {
        return chain->stiffness / -modes->roots[0].value;
    }
    double sum = chain->damping;
    for (size_t i = 0; i < chain->count; i++) {
        sum += chain->spring[i] * chain->tau[i];
    }
    return sum;
}

/* The two roots that mass adds, from the sum of all, -r/m - sum q, and their product, (-1)^n K prod q/m. */
static void add_inertial_roots(dea_modes *modes)
{
    const dea_chain *chain = &modes->chain;
    double product = (chain->count > 0 ? slowest_share(modes) * chain->rate[0] : chain->stiffness) / chain->mass;
    for (size_t i = 1; i < chain->count; i++) {
        product *= chain->rate[i] / -modes->roots[i].value;
    }
    modes->sigma = -0.5 * (chain->damping / chain->mass + total_shift(modes));
    modes->square = modes->sigma * modes->sigma - product;
    modes->pair = modes->square < 0.25 * close_roots * close_roots * modes->sigma * modes->sigma;
    if (!modes->pair) {
        const double fast = modes->sigma - sqrt(modes->square);
        set_real(modes, fast, product / fast);
    }
}

static dea_dual above(const dea_modes *modes, double distance)
{
    return (dea_dual){modes->sigma + distance, 1.0};
}

/* p = m (s - s1) (s - s2) prod (s - s_j)/(s + q_j), over as many roots as branches. */
static void set_residues(dea_modes *modes)
{
    const dea_chain *chain = &modes->chain;
    for (size_t j = 0; j < modes->count; j++) {
        dea_root *root = &modes->roots[j];
        double slope = 2.0 * chain->mass * root->value + chain->damping;
        for (size_t i = 0; i < chain->count; i++) {
            const double distance = dea_root_above(chain, root, i);
            slope += chain->spring[i] * (chain->rate[i] / distance) / distance;
        }
        root->residue = 1.0 / slope;
    }
    if (modes->pair) {
        modes->residue = (dea_dual){1.0 / chain->mass, 0.0};
        for (size_t j = 0; j < modes->count; j++) {
            const dea_dual ratio =
                dea_dual_div(above(modes, chain->rate[j]), above(modes, -modes->roots[j].value), modes->square);
            modes->residue = dea_dual_mul(modes->residue, ratio, modes->square);
        }
    }
}

static void set_prompt(dea_modes *modes)
{
    const dea_chain *chain = &modes->chain;
    double held = chain->stiffness;
    for (size_t i = 0; i < chain->count; i++) {
        held += chain->spring[i];
    }
    modes->prompt = chain->mass == 0.0 && chain->damping == 0.0 ? 1.0 / held : 0.0;
}

static void set_cancellation(dea_modes *modes)
{
    double parts = fabs(modes->prompt);
    double whole = modes->prompt;
    for (size_t j = 0; j < modes->count; j++) {
        parts += fabs(modes->roots[j].residue / modes->roots[j].value);
        whole -= modes->roots[j].residue / modes->roots[j].value;
    }
    if (modes->pair) {
        const double part = dea_dual_div(modes->residue, above(modes, 0.0), modes->square).odd;
        parts += fabs(part);
        whole -= part;
    }
    modes->cancellation = modes->chain.stiffness == 0.0 ? 1.0 : parts / fabs(whole);
}

dea_modes_answer dea_modes_find(const dea_chain *chain, dea_modes *modes)
{
    memset(modes, 0, sizeof *modes);
    modes->chain = *chain;
    set_prompt(modes);
    if (chain->mass == 0.0 && chain->damping == 0.0 && !(modes->prompt > 0.0 && isfinite(modes->prompt))) {
        return DEA_MODES_UNSTABLE;
    }
    for (size_t i = 0; i < chain->count; i++) {
        modes->roots[modes->count++] = i == 0 ? slowest_root(chain) : root_between(chain, i, i - 1);
    }
    if (chain->mass > 0.0) {
        add_inertial_roots(modes);
    } else if (chain->damping > 0.0) {
        add_damped_root(modes);
    }
    set_residues(modes);
    set_cancellation(modes);
    return modes->cancellation <= worst_cancellation ? DEA_MODES_FOUND : DEA_MODES_CLOSE;
}

/* Amplitudes of a state: the parts of 1/p(s) [m (s u + v) + r u + sum k_i z_i/(s + q_i)]. */
static dea_amplitudes split(const dea_modes *modes, double u, double v, const double *z)
{
    const dea_chain *chain = &modes->chain;
    dea_amplitudes a;
    for (size_t j = 0; j < modes->count; j++) {
        const dea_root *root = &modes->roots[j];
        double sum = chain->mass * (root->value * u + v) + chain->damping * u;
        for (size_t i = 0; i < chain->count; i++) {
            sum += chain->spring[i] * z[i] / dea_root_above(chain, root, i);
        }
        a.roots[j] = root->residue * sum;
    }
    a.pair = (dea_dual){0.0, 0.0};
    if (modes->pair) {
        dea_dual sum = {chain->mass * (modes->sigma * u + v) + chain->damping * u, chain->mass * u};
        for (size_t i = 0; i < chain->count; i++) {
            const dea_dual part = {chain->spring[i] * z[i], 0.0};
            sum = dea_dual_add(sum, dea_dual_div(part, above(modes, chain->rate[i]), modes->square));
        }
        a.pair = dea_dual_mul(modes->residue, sum, modes->square);
    }
    return a;
}

dea_course dea_modes_split(const dea_modes *modes, double u, double v, const double *z, double force)
{
    dea_course course = {.place = split(modes, u, v, z)};
    for (size_t j = 0; j < modes->count; j++) {
        course.speed.roots[j] = modes->roots[j].value * course.place.roots[j];
    }
    course.speed.pair = dea_dual_mul(above(modes, 0.0), course.place.pair, modes->square);
    dea_modes_jump(modes, force, &course);
    return course;
}

void dea_modes_jump(const dea_modes *modes, double rise, dea_course *course)
{
    for (size_t j = 0; j < modes->count; j++) {
        course->speed.roots[j] += modes->roots[j].residue * rise;
    }
    if (modes->pair) {
        course->speed.pair = dea_dual_add(course->speed.pair, dea_dual_scale(rise, modes->residue));
    }
}

dea_course dea_modes_relaxed(const dea_modes *modes, double force)
{
    dea_course course = {.place.pair = {0.0, 0.0}};
    for (size_t j = 0; j < modes->count; j++) {
        course.place.roots[j] = -modes->roots[j].residue * force / modes->roots[j].value;
    }
    if (modes->pair) {
        course.place.pair = dea_dual_div(dea_dual_scale(-force, modes->residue), above(modes, 0.0), modes->square);
    }
    return course;
}

static double sum_of(const dea_modes *modes, const dea_amplitudes *a)
{
    double sum = modes->pair ? a->pair.odd : 0.0;
    for (size_t j = 0; j < modes->count; j++) {
        sum += a->roots[j];
    }
    return sum;
}

double dea_modes_displacement(const dea_modes *modes, const dea_course *course, const dea_forcing *force)
{
    return modes->prompt * force->value + sum_of(modes, &course->place);
}

double dea_modes_velocity(const dea_modes *modes, const dea_course *course, const dea_forcing *force)
{
    return modes->prompt * force->slope + sum_of(modes, &course->speed);
}

void dea_modes_branches(const dea_modes *modes, const dea_amplitudes *a, double *z)
{
    const dea_chain *chain = &modes->chain;
    for (size_t i = 0; i < chain->count; i++) {
        z[i] = 0.0;
        for (size_t j = 0; j < modes->count; j++) {
            z[i] += a->roots[j] * (chain->rate[i] / dea_root_above(chain, &modes->roots[j], i));
        }
        if (modes->pair) {
            z[i] += chain->rate[i] * dea_dual_div(a->pair, above(modes, chain->rate[i]), modes->square).odd;
        }
    }
}

void dea_advance_make(const dea_modes *modes, double time, dea_advance *advance)
{
    const double powers[DEA_PHI_COUNT] = {time, time * time, time * time * time, time * time * time * time};
    dea_dual phi[DEA_PHI_COUNT];
    advance->time = time;
    for (size_t j = 0; j < modes->count; j++) {
        const dea_root *root = &modes->roots[j];
        advance->decay[j] = dea_dual_phi((dea_dual){root->value * time, 0.0}, 0.0, phi).even;
        advance->span[j] = time * phi[0].even;
        for (int k = 0; k < DEA_PHI_COUNT; k++) {
            advance->gain[j][k] = root->residue * powers[k] * phi[k].even;
        }
    }
    if (modes->pair) {
        advance->pair_decay = dea_dual_phi(dea_dual_scale(time, above(modes, 0.0)), modes->square, phi);
        advance->pair_span = dea_dual_scale(time, phi[0]);
        for (int k = 0; k < DEA_PHI_COUNT; k++) {
            advance->pair_gain[k] = dea_dual_scale(powers[k], dea_dual_mul(modes->residue, phi[k], modes->square));
        }
    }
}

void dea_advance_take(const dea_modes *modes, const dea_advance *advance, const dea_forcing *force, dea_course *course)
{
    double *place = course->place.roots;
    double *speed = course->speed.roots;
    for (size_t j = 0; j < modes->count; j++) {
        const double *gain = advance->gain[j];
        place[j] = advance->decay[j] * place[j] + gain[0] * force->value + gain[1] * force->slope + gain[2] * force->bend;
        speed[j] = advance->decay[j] * speed[j] + gain[0] * force->slope + gain[1] * force->bend;
    }
    if (modes->pair) {
        const dea_dual *gain = advance->pair_gain;
        const dea_dual kept = dea_dual_mul(advance->pair_decay, course->place.pair, modes->square);
        const dea_dual fast = dea_dual_mul(advance->pair_decay, course->speed.pair, modes->square);
        course->place.pair = (dea_dual){
            kept.even + gain[0].even * force->value + gain[1].even * force->slope + gain[2].even * force->bend,
            kept.odd + gain[0].odd * force->value + gain[1].odd * force->slope + gain[2].odd * force->bend,
        };
        course->speed.pair = (dea_dual){fast.even + gain[0].even * force->slope + gain[1].even * force->bend,
                                        fast.odd + gain[0].odd * force->slope + gain[1].odd * force->bend};
    }
}

double dea_advance_integral(const dea_modes *modes, const dea_advance *advance, const dea_forcing *force,
                            const dea_course *course)
{
    const double t = advance->time;
    double sum = modes->prompt * t * (force->value + t * (force->slope / 2.0 + t * force->bend / 6.0));
    for (size_t j = 0; j < modes->count; j++) {
        const double *gain = advance->gain[j];
        sum += advance->span[j] * course->place.roots[j] + gain[1] * force->value + gain[2] * force->slope + gain[3] * force->bend;
    }
    if (modes->pair) {
        const dea_dual *gain = advance->pair_gain;
        sum += dea_dual_mul(advance->pair_span, course->place.pair, modes->square).odd + gain[1].odd * force->value +
               gain[2].odd * force->slope + gain[3].odd * force->bend;
    }
    return sum;
}
