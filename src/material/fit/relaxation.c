/* Prony branches of a test of relaxation, of creep or of dynamic moduli, whose models fit_test.h has.
 *
 * The number of branches grows while an F test finds the gain of the last one, 2 constants, significant; with 2 degrees of
 * freedom the chance is p = (R_m/R_(m-1))^((n - 2m - 1)/2) in closed form, R being squared residuals. */
#include "deaspice/fit.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>

#include "material/fit/branches.h"
#include "material/fit/errors.h"
#include "material/fit/plausible.h"
#include "support/grow.h"
#include "support/lapack.h"

/* Chance of a gain by noise up to which a branch counts as significant. */
static const double significance = 0.05;
/* Chance of growth by noise up to which data is refused as growing. */
static const double growth_chance = 1e-3;
/* Residual, as a share of the rms stress, and share of a branch that are rounding. */
static const double rounding = 1e-9;
/* Long-term share below which nothing is left. */
static const double long_term_least = 1e-6;
/* Standard error of ln tau beyond which the points do not tell a time: the errors are those of the tangent of the model, and where it
 * does not hold over three of them, they cover less than they say. */
static const double log_certain = 0.3;
/* A branch that is faster than the ramp by this has nearly all of its share in what the ramp hides. */
static const double ramp_hides = 10.0;

dea_status dea_relaxation_add(dea_relaxation_data *data, dea_relaxation_point point, dea_error *error)
{
    const double last = data->count > 0 ? data->points[data->count - 1].time : -1.0;
    if (!(point.time >= 0.0) || !isfinite(point.time) || !(point.time > last) || !isfinite(point.stress) || !isfinite(point.loss)) {
        return dea_fail(error, DEA_ERROR_USAGE,
                        "a point of a %s needs a time >= 0 or a frequency after the last and finite numbers", dea_test_of(data->kind)->name);
    }
    dea_relaxation_point *points = dea_grow(data->points, data->count, &data->room, sizeof *points);
    if (!points) {
        return dea_fail(error, DEA_ERROR_MEMORY, "out of memory");
    }
    data->points = points;
    points[data->count++] = point;
    return DEA_OK;
}

void dea_relaxation_data_free(dea_relaxation_data *data)
{
    if (data) {
        free(data->points);
        *data = (dea_relaxation_data){0};
    }
}

/* A curve of the fit; the sum of its shares is 1. */
static double curve_of(const dea_relaxation *fit, double at, size_t curve)
{
    const dea_test *test = dea_test_of(fit->kind);
    const bool creeps = fit->kind == DEA_TEST_CREEP;
    double share = fit->long_term * test->rest[curve];
    for (size_t i = 0; i < fit->prony_count; i++) {
        const dea_prony *branch = creeps ? &fit->retardation[i] : &fit->prony[i];
        const dea_test_time time = dea_test_time_of(fit->ramp, branch->tau);
        share += branch->g * test->branch(at, &time, curve).value;
    }
    return (creeps ? fit->instantaneous / fit->long_term : fit->instantaneous) * share;
}

double dea_relaxation_stress(const dea_relaxation *fit, double time)
{
    return curve_of(fit, time, 0);
}

double dea_relaxation_loss(const dea_relaxation *fit, double omega)
{
    return fit->kind == DEA_TEST_DYNAMIC ? curve_of(fit, omega, 1) : 0.0;
}

static double long_term_of(const dea_branches *c)
{
    double sum = 0.0;
    for (size_t k = 0; k <= c->count; k++) {
        sum += c->shares[k];
    }
    return c->shares[0] / sum;
}

/* Whether each branch has a share, and a time of its own. */
static bool branches_distinct(const dea_branches *c)
{
    for (size_t k = 0; k < c->count; k++) {
        bool distinct = c->shares[k + 1] > rounding;
        for (size_t i = 0; i < k; i++) {
            distinct = distinct && fabs(c->logs[i] - c->logs[k]) > 1e-6;
        }
        if (!distinct) {
            return false;
        }
    }
    return true;
}

/* p of the F test of @p more against @p less, NAN without a degree of freedom. */
static double gain_chance(const dea_held *held, const dea_branches *less, const dea_branches *more)
{
    const double freedom = (double)held->rows - 2.0 * (double)more->count - 1.0;
    const double least = rounding * rounding * held->squares;
    if (!branches_distinct(more)) {
        return 1.0;
    }
    return freedom > 0.0 ? pow(fmax(more->squares, least) / fmax(less->squares, least), 0.5 * freedom) : NAN;
}

static void trial_note(const dea_held *held, dea_relaxation *fit, const dea_branches *c, double chance)
{
    const size_t curves = held->test->curves;
    double residuals = 0.0, squares = 0.0;
    for (size_t i = 0; i < held->rows; i++) {
        const dea_relaxation_point *point = &held->data->points[i / curves];
        const double measured = dea_test_measured(point, i % curves) / held->scale;
        double model = c->shares[0] * held->test->rest[i % curves];
        for (size_t k = 0; k < c->count; k++) {
            const dea_test_time time = dea_test_time_of(held->data->ramp, exp(c->logs[k]));
            model += c->shares[k + 1] * held->test->branch(point->time, &time, i % curves).value;
        }
        residuals += (measured - model) * (measured - model);
        squares += measured * measured;
    }
    fit->trials[fit->trial_count++] = (dea_relaxation_trial){sqrt(residuals / squares), chance, long_term_of(c)};
}

/* Covariances of a_inf, a_i and ln tau_i, in the order of the Jacobian (fit_errors.h). */
typedef struct covariances {
    size_t columns;
    double alike[DEA_BRANCHES_COLUMNS * DEA_BRANCHES_COLUMNS], unlike[DEA_BRANCHES_COLUMNS * DEA_BRANCHES_COLUMNS];
} covariances;

/* False where the Jacobian has no full rank, or no row is left to tell the noise. */
static bool covariances_find(dea_held *held, const dea_branches *c, covariances *found)
{
    const size_t columns = 2 * c->count + 1;
    double length[DEA_BRANCHES_COLUMNS], singular[DEA_BRANCHES_COLUMNS], vt[DEA_BRANCHES_COLUMNS * DEA_BRANCHES_COLUMNS],
        rest[DEA_BRANCHES_COLUMNS], right;
    found->columns = columns;
    if (held->rows <= columns) {
        return false;
    }
    dea_branches_jacobian(held, c, held->matrix, held->rows);
    dea_branches_residual(held, c, held->matrix, held->rows, held->step);
    for (size_t j = 0; j < columns; j++) {
        length[j] = sqrt(dea_squares(held->matrix + j * held->rows, held->rows));
        for (size_t i = 0; i < held->rows && length[j] > 0.0; i++) {
            held->matrix[j * held->rows + i] /= length[j];
        }
    }
    const lapack_int rows = (lapack_int)held->rows, order = (lapack_int)columns;
    const lapack_int info =
        dea_lapacke_dgesvd(LAPACK_COL_MAJOR, 'O', 'S', rows, order, held->matrix, rows, singular, &right, 1, vt, order, rest);
    held->memory = held->memory && info >= 0;
    if (info != 0 || !(singular[columns - 1] > 1e-12 * singular[0])) {
        return false;
    }
    dea_errors_covariances(&(dea_decomposed){held->rows, columns, held->matrix, singular, vt}, held->step, found->alike,
                           found->unlike);
    for (size_t j = 0; j < columns * columns; j++) {
        found->alike[j] /= length[j / columns] * length[j % columns];
        found->unlike[j] /= length[j / columns] * length[j % columns];
    }
    return true;
}

/* Variance of the combination of the unknowns with these weights, one a column. */
static double variance_of(const covariances *c, const double *weights)
{
    double alike = 0.0, unlike = 0.0;
    for (size_t k = 0; k < c->columns; k++) {
        for (size_t l = 0; l < c->columns; l++) {
            alike += weights[k] * c->alike[k * c->columns + l] * weights[l];
            unlike += weights[k] * c->unlike[k * c->columns + l] * weights[l];
        }
    }
    return fmax(alike, unlike);
}

/* Standard error of ln tau of a branch. */
static double log_deviation(const dea_branches *c, const covariances *found, size_t branch)
{
    double weights[DEA_BRANCHES_COLUMNS] = {0.0};
    weights[c->count + 1 + branch] = 1.0;
    return sqrt(variance_of(found, weights));
}

/* Whether the points tell the time of each branch, of those that are faster than @p below: not at the end of the range that is
 * searched, and not too uncertain. Where as many constants as points leave no noise to judge by, they do. */
static bool times_told(dea_held *held, const dea_branches *c, double below)
{
    covariances found;
    const bool known = covariances_find(held, c, &found);
    for (size_t k = 0; k < c->count; k++) {
        const bool inside = c->logs[k] > held->log_min && c->logs[k] < held->log_max;
        if (exp(c->logs[k]) < below && (!inside || (known && !(log_deviation(c, &found, k) <= log_certain)))) {
            return false;
        }
    }
    return true;
}

/* Whether the fit goes on to @p more; where not, fit->end says why. */
static bool branch_accept(dea_held *held, const dea_branches *more, double chance, bool asked, dea_relaxation *fit)
{
    if (!asked && (isnan(chance) ? more->count > 1 : chance > significance)) {
        fit->end = isnan(chance) ? DEA_RELAXATION_POINTS : DEA_RELAXATION_TEST;
        return false;
    }
    if (!branches_distinct(more)) {
        fit->end = DEA_RELAXATION_POINTS;
        return false;
    }
    if (!(long_term_of(more) > long_term_least)) {
        fit->end = DEA_RELAXATION_LONG_TERM;
        return false;
    }
    /* A ramp of T leaves tau/T of a fast branch in the points, so that an uncertain time is an uncertain share, however small the
     * stress that tells of it. */
    if (!asked && !times_told(held, more, held->data->ramp / ramp_hides)) {
        fit->end = DEA_RELAXATION_TIME;
        return false;
    }
    return true;
}

/* Adds branches while they are worth it. */
static dea_branches search_run(dea_held *held, size_t asked, dea_relaxation *fit)
{
    const size_t points_most = (held->rows - 1) / 2;
    const size_t most = asked > 0 ? asked : points_most < DEA_RELAXATION_MOST ? points_most : DEA_RELAXATION_MOST;
    dea_branches best = {.count = 0};
    dea_branches_solve(held, &best);
    trial_note(held, fit, &best, NAN);
    fit->end = asked > 0                            ? DEA_RELAXATION_ASKED
               : points_most <= DEA_RELAXATION_MOST ? DEA_RELAXATION_POINTS
                                                    : DEA_RELAXATION_FULL;
    while (best.count < most && held->memory) {
        if (asked == 0 && best.squares <= rounding * rounding * held->squares) {
            fit->end = DEA_RELAXATION_EXACT;
            break;
        }
        const dea_branches more = dea_branches_next(held, &best);
        const double chance = gain_chance(held, &best, &more);
        trial_note(held, fit, &more, chance);
        if (!branch_accept(held, &more, chance, asked > 0, fit)) {
            break;
        }
        best = more;
    }
    return best;
}

static void branches_sort(dea_branches *c)
{
    for (size_t k = 1; k < c->count; k++) {
        for (size_t i = k; i > 0 && c->logs[i - 1] > c->logs[i]; i--) {
            const double log_tau = c->logs[i], share = c->shares[i + 1];
            c->logs[i] = c->logs[i - 1];
            c->shares[i + 1] = c->shares[i];
            c->logs[i - 1] = log_tau;
            c->shares[i] = share;
        }
    }
}

/* What a fit prints of its branches: g_inf, g_i, ln tau_i. */
static void outputs_of(const dea_held *held, const dea_branches *c, double outputs[DEA_BRANCHES_COLUMNS])
{
    dea_spectrum spectrum;
    held->test->convert(c->count, c->shares, c->logs, &spectrum);
    outputs[0] = spectrum.long_term;
    for (size_t i = 0; i < c->count; i++) {
        outputs[1 + i] = spectrum.prony[i].g;
        outputs[1 + c->count + i] = log(spectrum.prony[i].tau);
    }
}

/* Standard errors by the slopes of the outputs over the unknowns, from differences of either side: their error of 1e-10 is none of a
 * standard error. */
static void deviations_find(dea_held *held, const dea_branches *c, dea_relaxation *fit)
{
    const double step = 1e-5;
    const size_t columns = 2 * c->count + 1;
    covariances found;
    double slopes[DEA_BRANCHES_COLUMNS][DEA_BRANCHES_COLUMNS]; /* [output][unknown] */
    const bool told = fit->end != DEA_RELAXATION_TIME && times_told(held, c, INFINITY) && covariances_find(held, c, &found);
    for (size_t k = 0; k < columns; k++) {
        double up[DEA_BRANCHES_COLUMNS], down[DEA_BRANCHES_COLUMNS];
        dea_branches more = *c, less = *c;
        const double size = k <= c->count ? step * c->shares[k] : step;
        *(k <= c->count ? &more.shares[k] : &more.logs[k - c->count - 1]) += size;
        *(k <= c->count ? &less.shares[k] : &less.logs[k - c->count - 1]) -= size;
        outputs_of(held, &more, up);
        outputs_of(held, &less, down);
        for (size_t j = 0; j < columns; j++) {
            slopes[j][k] = (up[j] - down[j]) / (2.0 * size);
        }
    }
    fit->long_term_deviation = told ? sqrt(variance_of(&found, slopes[0])) : NAN;
    for (size_t i = 0; i < c->count; i++) {
        fit->deviation[i].g = told ? sqrt(variance_of(&found, slopes[1 + i])) : NAN;
        fit->deviation[i].tau = told ? fit->prony[i].tau * sqrt(variance_of(&found, slopes[1 + c->count + i])) : NAN;
    }
}

static void fit_fill(dea_held *held, dea_branches *c, dea_relaxation *fit)
{
    dea_spectrum spectrum;
    double sum = c->shares[0], squares = 0.0;
    branches_sort(c);
    held->test->convert(c->count, c->shares, c->logs, &spectrum);
    for (size_t k = 0; k < c->count; k++) {
        sum += c->shares[k + 1];
    }
    fit->prony_count = c->count;
    fit->long_term = spectrum.long_term;
    fit->instantaneous = held->scale * (fit->kind == DEA_TEST_CREEP ? c->shares[0] : sum);
    for (size_t k = 0; k < c->count; k++) {
        fit->prony[k] = spectrum.prony[k];
        fit->retardation[k] = (dea_prony){.g = c->shares[k + 1] / sum, .tau = exp(c->logs[k])};
    }
    deviations_find(held, c, fit);
    for (size_t i = 0; i < held->rows; i++) {
        squares += pow(dea_test_measured(&held->data->points[i / held->test->curves], i % held->test->curves), 2.0) / (double)held->rows;
    }
    fit->residual_relative = fit->trials[c->count].residual_relative;
    fit->residual_rms = fit->residual_relative * sqrt(squares);
}

/* Whether the mirror image of the data relaxes. */
static dea_status growth_find(const dea_relaxation_data *data, bool relative, bool *grows, dea_error *error)
{
    dea_relaxation_data mirror = {.kind = data->kind, .ramp = data->ramp};
    dea_relaxation fit = {0};
    double most = 0.0;
    dea_status status = DEA_OK;
    for (size_t i = 0; i < data->count; i++) {
        most = fmax(most, data->points[i].stress);
    }
    for (size_t i = 0; i < data->count && status == DEA_OK; i++) {
        const dea_relaxation_point *own = &data->points[i];
        const dea_relaxation_point point = {.time = own->time, .stress = 2.0 * most - own->stress, .loss = own->loss};
        status = dea_relaxation_add(&mirror, point, error);
    }
    dea_held held = {.rows = 0};
    status = status ? status : dea_held_begin(&held, &mirror, relative, error);
    if (status == DEA_OK) {
        search_run(&held, 0, &fit);
        *grows = fit.trial_count > 1 && !(fit.trials[1].p > growth_chance);
        status = held.memory ? DEA_OK : dea_fail(error, DEA_ERROR_MEMORY, "out of memory");
    }
    dea_held_end(&held);
    dea_relaxation_data_free(&mirror);
    return status;
}

static dea_status data_examine(const dea_relaxation_data *data, size_t branches, dea_error *error)
{
    const dea_test *test = dea_test_of(data->kind);
    const size_t most = data->count > 0 ? (data->count * test->curves - 1) / 2 : 0;
    if (data->count < DEA_RELAXATION_LEAST) {
        return dea_fail(error, DEA_ERROR_USAGE, "%zu points; a %s needs at least %d", data->count, test->name, DEA_RELAXATION_LEAST);
    }
    if (branches > DEA_RELAXATION_MOST || branches > most) {
        return dea_fail(error, DEA_ERROR_USAGE,
                        "%zu branches were asked for; %zu points determine %zu at most, and no fit has more than %d", branches,
                        data->count, most, DEA_RELAXATION_MOST);
    }
    const double from = data->points[0].time, to = data->points[data->count - 1].time;
    if (test->periodic ? !(from > 0.0) : !(to - from >= from)) {
        return test->periodic
                   ? dea_fail(error, DEA_ERROR_USAGE, "a frequency of 0; the moduli of a dynamic test are of frequencies above 0")
                   : dea_fail(error, DEA_ERROR_USAGE,
                              "the first point lies %.6g s after the ramp and the last one %.6g s: too late to tell what came "
                              "before; time counts from the end of the ramp",
                              from, to);
    }
    if (!(data->ramp >= 0.0) || !isfinite(data->ramp)) {
        return dea_fail(error, DEA_ERROR_USAGE, "the duration of the ramp is negative or not finite; 0 is an ideal step");
    }
    return dea_plausible_relaxation(data, error);
}

/* What speaks against the branches found, though the search went through. */
static dea_status outcome_examine(const dea_relaxation_data *data, size_t asked, bool relative, const dea_branches *best,
                                  const dea_relaxation *fit, dea_error *error)
{
    bool grows = false;
    const dea_status status = best->count == 0 ? growth_find(data, relative, &grows, error) : DEA_OK;
    if (status != DEA_OK) {
        return status;
    }
    const dea_test *test = dea_test_of(data->kind);
    const dea_relaxation_point *first = data->points, *last = first + data->count - 1;
    if (grows) {
        return dea_fail(error, DEA_ERROR_USAGE, test->mirrored, first->stress, last->stress);
    }
    if (fit->end == DEA_RELAXATION_LONG_TERM && (best->count == 0 || asked > 0)) {
        char remedy[80];
        snprintf(remedy, sizeof remedy, test->remedy, test->periodic ? first->time / (2.0 * DEA_PI) : last->time);
        return dea_fail(error, DEA_ERROR_USAGE, "branch %zu leaves %s, which a film needs; %s", best->count + 1, test->last, remedy);
    }
    if (best->count < asked) {
        return dea_fail(error, DEA_ERROR_USAGE, "%zu branches were asked for, the data tells %zu apart", asked, best->count);
    }
    return DEA_OK;
}

dea_status dea_fit_relaxation(const dea_relaxation_data *data, size_t branches, bool relative, dea_relaxation *fit,
                              dea_error *error)
{
    dea_status status = data_examine(data, branches, error);
    status = status == DEA_OK ? dea_lapack_load(error) : status;
    if (status != DEA_OK) {
        return status;
    }
    const double first = data->points[0].time, last = data->points[data->count - 1].time;
    const bool periodic = dea_test_of(data->kind)->periodic;
    *fit = (dea_relaxation){.kind = data->kind,
                            .count = data->count,
                            .time_min = periodic ? 1.0 / last : first,
                            .time_max = periodic ? 1.0 / first : last,
                            .ramp = data->ramp};
    dea_held held;
    status = dea_held_begin(&held, data, relative, error);
    if (status == DEA_OK) {
        dea_branches best = search_run(&held, branches, fit);
        status = held.memory ? outcome_examine(data, branches, relative, &best, fit, error)
                             : dea_fail(error, DEA_ERROR_MEMORY, "out of memory");
        if (status == DEA_OK) {
            fit_fill(&held, &best, fit);
        }
        if (status == DEA_OK && !held.memory) {
            status = dea_fail(error, DEA_ERROR_MEMORY, "out of memory");
        }
    }
    dea_held_end(&held);
    return status;
}

bool dea_relaxation_slow(const dea_relaxation *fit)
{
    const double longest = dea_test_of(fit->kind)->periodic ? fit->time_max : fit->time_max - fit->time_min;
    const dea_prony *measured = fit->kind == DEA_TEST_CREEP ? fit->retardation : fit->prony;
    return fit->prony_count > 0 && measured[fit->prony_count - 1].tau > longest;
}

bool dea_relaxation_fast(const dea_relaxation *fit)
{
    return fit->kind == DEA_TEST_DYNAMIC && fit->prony_count > 0 && fit->prony[0].tau < fit->time_min;
}

const char *dea_test_name(dea_test_kind kind)
{
    return dea_test_of(kind)->name;
}

const char *dea_relaxation_reason(const dea_relaxation *fit)
{
    static const char *const reasons[] = {
        [DEA_RELAXATION_ASKED] = "as many as asked for",
        [DEA_RELAXATION_TEST] = "one more gains no more than noise would (F test, 5 %)",
        [DEA_RELAXATION_EXACT] = "the residual is rounding",
        [DEA_RELAXATION_POINTS] = "the points determine no more",
        [DEA_RELAXATION_LONG_TERM] = "one more leaves no long-term stress",
        [DEA_RELAXATION_TIME] = "there is one that is faster than a tenth of the ramp, and the points do not tell its time",
        [DEA_RELAXATION_FULL] = "no fit has more",
    };
    if (fit->end == DEA_RELAXATION_LONG_TERM && fit->kind == DEA_TEST_CREEP) {
        return "one more leaves no strain at the start";
    }
    return (unsigned)fit->end < sizeof reasons / sizeof *reasons ? reasons[fit->end] : "unknown";
}
