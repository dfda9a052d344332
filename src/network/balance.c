#include "network/balance.h"

#include <math.h>
#include <stdlib.h>

#include "film/point.h"

enum { ELASTIC, LOAD, STEADY, FORCES };
enum {
    STRAIN,
    FORCE,
    FIELD,
    BREAKDOWN,
    SECOND_FIELD,
    SECOND_BREAKDOWN,
    LENGTH,
    CAPACITANCE,
    VOLTAGE,
    COVERAGE,
    RADIUS,
    FOCAL_LENGTH,
    REFRACTIVE_INDEX,
    LISTS
};

/* What a row needs, then the ranges, then the tensions. */
static dea_status compile_limits(dea_network *network, dea_balance *balance, dea_expr load, dea_error *error)
{
    const int ranges = network->range_count, count = LISTS + ranges + network->tension_count;
    dea_expr *limits = malloc((size_t)count * sizeof *limits);
    if (!limits) {
        return dea_fail(error, DEA_ERROR_MEMORY, "out of memory while a network is built");
    }
    limits[STRAIN] = network->strain;
    limits[FORCE] = load;
    limits[FIELD] = network->field;
    limits[BREAKDOWN] = network->breakdown;
    limits[SECOND_FIELD] = network->second_field;
    limits[SECOND_BREAKDOWN] = network->second_breakdown;
    limits[LENGTH] = network->length;
    limits[CAPACITANCE] = network->capacitance;
    limits[VOLTAGE] = network->voltage;
    limits[COVERAGE] = network->coverage;
    limits[RADIUS] = network->radius;
    limits[FOCAL_LENGTH] = network->focal_length;
    limits[REFRACTIVE_INDEX] = network->refractive_index;
    for (int i = 0; i < count - LISTS; i++) {
        limits[LISTS + i] = i < ranges ? network->range[i] : network->tension[i - ranges];
    }
    const dea_status status = dea_tape_compile(&network->pool, limits, count, &balance->limits, error);
    free(limits);
    return status;
}

dea_status dea_balance_open(dea_network *network, dea_balance *balance, dea_error *error)
{
    *balance = (dea_balance){.range_count = network->range_count,
                             .tension_count = network->tension_count,
                             .kind = network->kind,
                             .sign = network->sign,
                             .ends = network->ends,
                             .symbol = (double)NAN};
    const dea_expr load = dea_network_load(network), steady = dea_network_steady(network);
    const dea_expr forces[FORCES] = {dea_network_elastic(network), load, steady};
    balance->steady = dea_expr_constant(&network->pool, steady) != 0.0;
    dea_status status = dea_tape_compile(&network->pool, forces, balance->steady ? FORCES : STEADY, &balance->forces, error);
    if (status == DEA_OK) {
        status = compile_limits(network, balance, load, error);
    }
    if (status != DEA_OK) {
        dea_balance_close(balance);
    }
    return status;
}

void dea_balance_close(dea_balance *balance)
{
    if (balance) {
        dea_tape_free(&balance->forces);
        dea_tape_free(&balance->limits);
    }
}

/* True where everything that must be positive is, at the values that the limits hold now. */
static bool in_range(const dea_balance *balance)
{
    for (int i = 0; i < balance->range_count; i++) {
        if (!(dea_tape_value(&balance->limits, LISTS + i) > 0.0)) {
            return false;
        }
    }
    return true;
}

bool dea_balance_valid(dea_balance *balance, double symbol)
{
    dea_tape_run_values(&balance->limits, symbol, 0.0);
    return in_range(balance);
}

dea_forces dea_balance_forces(dea_balance *balance, double symbol, double u)
{
    dea_tape *tape = &balance->forces;
    dea_tape_run(tape, symbol, u);
    return (dea_forces){dea_tape_value(tape, ELASTIC), dea_tape_slope(tape, ELASTIC), dea_tape_value(tape, LOAD),
                        dea_tape_slope(tape, LOAD)};
}

double dea_forces_stiffness(const dea_forces *f)
{
    return f->load == 0.0 ? f->elastic_slope : f->elastic_slope - f->elastic / f->load * f->load_slope;
}

/* A way from a begin on: what grows there, and in which sense u moves. */
typedef struct way {
    dea_balance *balance;
    double symbol, begin, sign;
    bool steady; /* T grows, without load; else the load, beside all of T */
} way;

static dea_forces forces_on(const way *w, double distance)
{
    dea_forces f = dea_balance_forces(w->balance, w->symbol, w->begin + w->sign * distance);
    if (w->steady) {
        const double t = dea_tape_value(&w->balance->forces, STEADY), slope = dea_tape_slope(&w->balance->forces, STEADY);
        f = (dea_forces){f.elastic + t, f.elastic_slope + slope, t, slope};
    }
    return f;
}

/* Past the end of an energy, where forces are no numbers, nothing is stable. */
static double stiffness_on(const way *w, double distance)
{
    const dea_forces f = forces_on(w, distance);
    const double stiffness = dea_forces_stiffness(&f);
    return isnan(stiffness) ? -(double)INFINITY : stiffness;
}

double dea_balance_radius(const dea_balance *balance)
{
    return dea_tape_value(&balance->limits, RADIUS);
}

double dea_balance_length(const dea_balance *balance)
{
    return dea_tape_value(&balance->limits, LENGTH);
}

/* Outward the annulus ends at r - r_a = r_a (1 - B)/B, inward the disc at -r_a. */
static double end_of(const dea_balance *balance, double begin, double sign)
{
    const double b = dea_tape_value(&balance->limits, COVERAGE), radius = dea_tape_value(&balance->limits, RADIUS);
    const double end = sign > 0.0 ? radius * (1.0 - b) / b - begin : radius + begin;
    return balance->ends ? end * (1.0 - 1e-12) : 1e9 * dea_balance_length(balance);
}

double dea_balance_end(const dea_balance *balance)
{
    return end_of(balance, balance->steady ? balance->rest : 0.0, balance->sign);
}

/* First place on the way from `from` to `to` (distances from its begin, where the stiffness is at_from and at_to) at which the
 * stiffness is not positive, found by samples so close that it at most halves, or the stretch moves by 5 %, between two of them.
 * Returns true with a narrow bracket, else false. */
static bool find_softening(const way *w, double from, double at_from, double to, double at_to, double *before, double *after)
{
    const double length = dea_balance_length(w->balance);
    double at = from;
    double stiffness = at_from;
    double next = to;
    double there = at_to;
    if (!(stiffness > 0.0)) {
        *before = *after = from;
        return true;
    }
    while (at < to) {
        const double width = next - at;
        const double trusted = 0.05 * (length + at);
        const bool finest = width <= 1e-6 * trusted;
        if (finest && !(there > 0.0)) {
            *before = at;
            *after = next;
            return true;
        }
        if (finest || (width <= trusted && fmin(stiffness, there) > 0.5 * fmax(stiffness, there))) {
            at = next;
            stiffness = there;
            next = fmin(to, at + 2.0 * width);
        } else {
            next = at + 0.5 * width;
        }
        there = next == to ? at_to : stiffness_on(w, next);
    }
    return false;
}

/* What the way comes to. */
typedef struct arrival {
    double low, high; /* distances between which its full load is reached, high NAN: a fold or the end is at low */
    double share;     /* of the load at low */
} arrival;

static arrival follow(const way *w)
{
    const double length = dea_balance_length(w->balance), end = end_of(w->balance, w->begin, w->sign);
    double before = 0.0, after = 0.0, from = 0.0, share = 0.0;
    double stiffness = stiffness_on(w, 0.0);
    while (from < end) {
        const double to = fmin(end, from + 0.05 * (length + from));
        const double next = stiffness_on(w, to);
        const bool softens = find_softening(w, from, stiffness, to, next, &before, &after);
        for (int i = 0; softens && i < 100; i++) {
            const double middle = 0.5 * (before + after);
            if (middle <= before || middle >= after) {
                break;
            }
            *(stiffness_on(w, middle) > 0.0 ? &before : &after) = middle;
        }
        const double at = softens ? before : to;
        const dea_forces f = forces_on(w, at);
        share = f.elastic / f.load;
        if (w->sign * f.elastic >= w->sign * f.load) {
            return (arrival){from, at, share};
        }
        if (softens || to >= end) {
            return (arrival){at, (double)NAN, share};
        }
        from = to;
        stiffness = next;
    }
    return (arrival){from, (double)NAN, share};
}

bool dea_balance_folds(dea_balance *balance, double symbol, double *share, double *u)
{
    const double rest = dea_balance_rest(balance, symbol);
    const way w = {balance, symbol, rest, balance->sign, false};
    if (isnan(rest)) {
        *share = 0.0;
        *u = rest;
        return true;
    }
    const arrival there = follow(&w);
    *share = there.share;
    *u = rest + w.sign * there.low;
    return isnan(there.high);
}

/* The zero of R - F between two distances, by Newton's steps and halving. */
static double arrive(const way *w, double low, double high)
{
    double at = 0.5 * (low + high);
    for (int i = 0; i < 200 && high - low > 1e-16 * high; i++) {
        const dea_forces f = forces_on(w, at);
        const double excess = w->sign * (f.elastic - f.load);
        *(excess < 0.0 ? &low : &high) = at;
        const double next = at - excess / (f.elastic_slope - f.load_slope), step = fabs(next - at);
        at = next > low && next < high ? next : 0.5 * (low + high);
        if (at == next && step <= 2e-16 * fabs(at)) {
            break;
        }
    }
    return at;
}

double dea_balance_rest(dea_balance *balance, double symbol)
{
    dea_tape_run_values(&balance->limits, symbol, 0.0);
    if (!balance->steady || symbol == balance->symbol) {
        return balance->steady ? balance->rest : 0.0;
    }
    const dea_forces f = dea_balance_forces(balance, symbol, 0.0);
    const double steady = dea_tape_value(&balance->forces, STEADY);
    const way w = {balance, symbol, 0.0, steady < 0.0 ? -1.0 : 1.0, true};
    balance->symbol = symbol;
    balance->rest = f.elastic_slope > 0.0 ? 0.0 : (double)NAN;
    if (steady != 0.0) {
        const arrival there = follow(&w);
        balance->rest = isnan(there.high) ? (double)NAN : w.sign * arrive(&w, there.low, there.high);
    }
    return balance->rest;
}

/* True where u, an equilibrium with the forces f, is the first one from rest. The limits hold their values at u. */
static bool is_connected(dea_balance *balance, double symbol, double u, const dea_forces *f)
{
    const way w = {balance, symbol, balance->steady ? balance->rest : 0.0, balance->sign, false};
    const double distance = w.sign * (u - w.begin);
    double before, after;
    if (!(distance > 0.0 && distance < dea_balance_end(balance))) {
        return false;
    }
    const double rest = stiffness_on(&w, 0.0);
    return !find_softening(&w, 0.0, rest, distance, dea_forces_stiffness(f), &before, &after);
}

/* The row at u, from the limits there. */
static dea_row row_of(const dea_balance *balance, double u)
{
    const dea_tape *limits = &balance->limits;
    const double focal = dea_tape_value(limits, FOCAL_LENGTH);
    dea_row row = {.strain = dea_tape_value(limits, STRAIN),
                   .displacement = u,
                   .force = dea_tape_value(limits, FORCE),
                   .field = fabs(dea_tape_value(limits, FIELD)),
                   .capacitance = dea_tape_value(limits, CAPACITANCE),
                   .state = DEA_STATE_OK};
    if (!(isfinite(row.strain) && isfinite(u) && isfinite(row.force) && isfinite(row.field)) || !in_range(balance)) {
        return dea_row_failed();
    }
    row.charge = row.capacitance * dea_tape_value(limits, VOLTAGE);
    row.energy = 0.5 * row.charge * dea_tape_value(limits, VOLTAGE);
    row.second_field = fabs(dea_tape_value(limits, SECOND_FIELD));
    row.area_strain = dea_area_strain(balance->kind, dea_tape_value(limits, COVERAGE), row.strain);
    row.focal_length = isnan(focal) ? focal
                                    : dea_lens_focal_length(focal, dea_tape_value(limits, REFRACTIVE_INDEX),
                                                            dea_tape_value(limits, RADIUS), row.strain);
    for (int i = 0; i < balance->tension_count; i++) {
        if (!(dea_tape_value(limits, LISTS + balance->range_count + i) > 0.0)) {
            row.state = DEA_STATE_SLACK;
        }
    }
    if (row.field > dea_tape_value(limits, BREAKDOWN) || row.second_field > dea_tape_value(limits, SECOND_BREAKDOWN)) {
        row.state = DEA_STATE_BREAKDOWN;
    }
    return row;
}

void dea_balance_fill(dea_balance *balance, double symbol, double u, dea_row *row)
{
    dea_tape_run_values(&balance->limits, symbol, u);
    *row = row_of(balance, u);
}

bool dea_balance_accept(dea_balance *balance, double symbol, double u, double tolerance, dea_row *row)
{
    const double rest = dea_balance_rest(balance, symbol);
    const dea_forces f = dea_balance_forces(balance, symbol, u);
    dea_tape_run_values(&balance->limits, symbol, u);
    if (!in_range(balance)) {
        return false;
    }
    if (f.load == 0.0 && fabs(u - rest) <= fmax(1e-15 * dea_balance_length(balance), tolerance * fabs(rest))) {
        dea_balance_fill(balance, symbol, rest, row);
        return true;
    }
    const double correction = (f.elastic - f.load) / (f.elastic_slope - f.load_slope);
    if (!(fabs(correction) <= tolerance * fmax(fabs(u), fabs(rest))) || !is_connected(balance, symbol, u, &f)) {
        return false;
    }
    *row = row_of(balance, u);
    return true;
}
