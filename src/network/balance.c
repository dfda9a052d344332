#include "network/balance.h"

#include <math.h>
#include <stdlib.h>

#include "model/models.h"

enum { ELASTIC, LOAD };
enum {
    STRAIN,
    FORCE,
    FIELD,
    BREAKDOWN,
    LENGTH,
    END,
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
    limits[LENGTH] = network->length;
    limits[END] = network->end;
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
                             .sign = network->sign};
    const dea_expr load = dea_network_load(network);
    const dea_expr forces[] = {dea_network_elastic(network), load};
    dea_status status = dea_tape_compile(&network->pool, forces, 2, &balance->forces, error);
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

/* Past the end of an energy, where forces are no numbers, nothing is stable. */
static double stiffness_at(dea_balance *balance, double symbol, double u)
{
    const dea_forces f = dea_balance_forces(balance, symbol, u);
    const double stiffness = dea_forces_stiffness(&f);
    return isnan(stiffness) ? -(double)INFINITY : stiffness;
}

double dea_balance_length(const dea_balance *balance)
{
    return dea_tape_value(&balance->limits, LENGTH);
}

double dea_balance_end(const dea_balance *balance)
{
    const double end = dea_tape_value(&balance->limits, END);
    return end > 0.0 ? end * (1.0 - 1e-12) : 1e9 * dea_balance_length(balance);
}

/* First place on the way from `from` to `to` (distances from rest, where the stiffness is at_from and at_to) at which the
 * stiffness is not positive, found by samples so close that it at most halves, or the stretch moves by 5 %, between two of them.
 * Returns true with a narrow bracket, else false. */
static bool find_softening(dea_balance *balance, double symbol, double from, double at_from, double to, double at_to,
                           double *before, double *after)
{
    const double length = dea_balance_length(balance);
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
        there = next == to ? at_to : stiffness_at(balance, symbol, balance->sign * next);
    }
    return false;
}

bool dea_balance_folds(dea_balance *balance, double symbol, double *share, double *u)
{
    dea_tape_run_values(&balance->limits, symbol, 0.0);
    const double length = dea_balance_length(balance);
    const double end = dea_balance_end(balance);
    double before = 0.0;
    double after = 0.0;
    double from = 0.0;
    double stiffness = stiffness_at(balance, symbol, 0.0);
    while (from < end) {
        const double to = fmin(end, from + 0.05 * (length + from));
        const double next = stiffness_at(balance, symbol, balance->sign * to);
        const bool softens = find_softening(balance, symbol, from, stiffness, to, next, &before, &after);
        for (int i = 0; softens && i < 100; i++) {
            const double middle = 0.5 * (before + after);
            if (middle <= before || middle >= after) {
                break;
            }
            *(stiffness_at(balance, symbol, balance->sign * middle) > 0.0 ? &before : &after) = middle;
        }
        const double at = softens ? before : to;
        const dea_forces f = dea_balance_forces(balance, symbol, balance->sign * at);
        if (f.elastic / f.load >= 1.0) {
            return false;
        }
        if (softens || to >= end) {
            *share = f.elastic / f.load;
            *u = balance->sign * at;
            return true;
        }
        from = to;
        stiffness = next;
    }
    return false;
}

/* True where u, an equilibrium with the forces f, is the first one from rest. The limits hold their values at u. */
static bool is_connected(dea_balance *balance, double symbol, double u, const dea_forces *f)
{
    const double distance = balance->sign * u;
    double before, after;
    if (!(distance > 0.0 && distance < dea_balance_end(balance))) {
        return false;
    }
    const double rest = stiffness_at(balance, symbol, 0.0);
    return !find_softening(balance, symbol, 0.0, rest, distance, dea_forces_stiffness(f), &before, &after);
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
    if (!(isfinite(row.strain) && isfinite(u) && isfinite(row.force) && isfinite(row.field))) {
        return dea_row_failed();
    }
    row.charge = row.capacitance * dea_tape_value(limits, VOLTAGE);
    row.energy = 0.5 * row.charge * dea_tape_value(limits, VOLTAGE);
    row.area_strain = dea_area_strain(balance->kind, dea_tape_value(limits, COVERAGE), row.strain);
    row.focal_length = isnan(focal) ? focal
                                    : dea_lens_focal_length(focal, dea_tape_value(limits, REFRACTIVE_INDEX),
                                                            dea_tape_value(limits, RADIUS), row.strain);
    for (int i = 0; i < balance->tension_count; i++) {
        if (!(dea_tape_value(limits, LISTS + balance->range_count + i) > 0.0)) {
            row.state = DEA_STATE_SLACK;
        }
    }
    if (row.field > dea_tape_value(limits, BREAKDOWN)) {
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
    const dea_forces f = dea_balance_forces(balance, symbol, u);
    dea_tape_run_values(&balance->limits, symbol, u);
    if (!in_range(balance)) {
        return false;
    }
    if (f.load == 0.0 && fabs(u) <= 1e-15 * dea_balance_length(balance)) {
        dea_balance_fill(balance, symbol, 0.0, row);
        return true;
    }
    const double correction = (f.elastic - f.load) / (f.elastic_slope - f.load_slope);
    if (!(fabs(correction) <= tolerance * fabs(u)) || !is_connected(balance, symbol, u, &f)) {
        return false;
    }
    *row = row_of(balance, u);
    return true;
}
