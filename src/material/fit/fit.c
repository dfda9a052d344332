/* Constants of a law by least squares. Where the nominal stress is linear in them, P = sum C_i dP/dC_i, so with rows weighted by v
 * and columns scaled to length 1 the problem is min |A x - b|. Of other laws it is the problem of the last small step. The singular value decomposition A = U S V^T gives x = V S^-1 U^T b,
 * the covariance (fit_errors.h) and the condition number at once. */
#include "deaspice/fit.h"

#include <float.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "material/fit/errors.h"
#include "material/fit/plausible.h"
#include "material/law.h"
#include "support/grow.h"
#include "support/lapack.h"

/* Condition number of the scaled columns beyond which the data does not tell the constants apart. */
static const double condition_max = 1e7;

/* The largest weight in a relative fit: that of a stress of 1 % of the largest. */
static const double relative_floor = 0.01;

/* Chance of a gain by noise up to which a constant counts as significant. */
static const double significance = 0.05;

/* Relative step of a constant for a slope over it. */
static const double nudge = 1e-6;

/* Residual, as a share of the rms stress, that is rounding. */
static const double rounding = 1e-9;

/* Standard errors by which C1 must lie above 0: less would leave its sign to noise. */
static const double sign_certain = 2.0;

dea_status dea_fit_add(dea_fit_data *data, dea_fit_point point, dea_error *error)
{
    if (!(point.stretch > 0.0) || !isfinite(point.stretch) || !isfinite(point.stress) || (unsigned)point.load >= DEA_LOAD_COUNT) {
        return dea_fail(error, DEA_ERROR_USAGE, "a measured point needs a stretch above 0, a finite stress and a load");
    }
    dea_fit_point *points = dea_grow(data->points, data->count, &data->room, sizeof *points);
    if (!points) {
        return dea_fail(error, DEA_ERROR_MEMORY, "out of memory");
    }
    data->points = points;
    points[data->count++] = point;
    return DEA_OK;
}

void dea_fit_data_free(dea_fit_data *data)
{
    if (data) {
        free(data->points);
        *data = (dea_fit_data){0};
    }
}

/* Stretch across the load, in the plane. */
static double stretch_across(dea_load load, double stretch)
{
    return load == DEA_LOAD_EQUIBIAXIAL ? stretch : 1.0 / sqrt(stretch);
}

double dea_fit_stress(const dea_law *law, const double constants[DEA_LAW_CONSTANTS], dea_load load, double stretch)
{
    return law->stress(constants, stretch, stretch_across(load, stretch)).p1;
}

/* Slope of the nominal stress over stretch [Pa]: W11 + W12 equi-biaxial, W11 - W12^2/W22 uniaxial. */
static double load_tangent(const dea_fit *fit, dea_load load, double stretch)
{
    const dea_stress s = fit->law->stress(fit->constants, stretch, stretch_across(load, stretch));
    return load == DEA_LOAD_EQUIBIAXIAL ? s.w11 + s.w12 : s.w11 - s.w12 * s.w12 / s.w22;
}

/* The least-squares problem, matrices column by column. */
typedef struct problem {
    size_t rows;
    int terms;
    double *matrix;                     /* A, rows x terms; owned */
    double *right;                      /* b, rows; owned */
    double *left;                       /* U, rows x terms; owned */
    double *weights;                    /* v of the rows; owned */
    double scale[DEA_LAW_CONSTANTS];    /* length of the columns before scaling */
    double singular[DEA_LAW_CONSTANTS]; /* descending */
    double vt[DEA_LAW_CONSTANTS * DEA_LAW_CONSTANTS];
    double squares; /* of the weighted residuals */
    double all;     /* of the weighted stresses */
} problem;

static void problem_free(problem *p)
{
    free(p->matrix);
    free(p->right);
    free(p->left);
    free(p->weights);
}

static double stress_largest(const dea_fit_data *data)
{
    double largest = 0.0;
    for (size_t i = 0; i < data->count; i++) {
        largest = fmax(largest, fabs(data->points[i].stress));
    }
    return largest;
}

/* Room, the weights, and the weighted stresses as the right side. */
static dea_status problem_new(problem *p, const dea_fit_data *data, bool relative, dea_error *error)
{
    const double largest = stress_largest(data);
    p->matrix = malloc(p->rows * (size_t)p->terms * sizeof *p->matrix);
    p->left = malloc(p->rows * (size_t)p->terms * sizeof *p->left);
    p->right = malloc(p->rows * sizeof *p->right);
    p->weights = malloc(p->rows * sizeof *p->weights);
    if (!p->matrix || !p->left || !p->right || !p->weights) {
        return dea_fail(error, DEA_ERROR_MEMORY, "out of memory");
    }
    for (size_t i = 0; i < p->rows; i++) {
        const double stress = data->points[i].stress;
        p->weights[i] = relative ? 1.0 / fmax(fabs(stress), relative_floor * largest) : 1.0;
        p->right[i] = p->weights[i] * stress;
        p->all += p->right[i] * p->right[i];
    }
    return DEA_OK;
}

/* Column j: the weighted slope of the stress over constant j, scaled. Of a linear law it is the stress of that constant alone, of
 * others a central difference. */
static void problem_column(problem *p, const dea_fit_data *data, const dea_fit *fit, int j)
{
    double *column = p->matrix + (size_t)j * p->rows;
    double more[DEA_LAW_CONSTANTS] = {0.0}, less[DEA_LAW_CONSTANTS];
    double step = 1.0;
    if (fit->law->linear) {
        more[j] = 1.0;
    } else {
        memcpy(more, fit->constants, sizeof more);
        memcpy(less, fit->constants, sizeof less);
        more[j] *= 1.0 + nudge;
        less[j] *= 1.0 - nudge;
        step = more[j] - less[j];
    }
    for (size_t i = 0; i < p->rows; i++) {
        const dea_fit_point *point = &data->points[i];
        const double rest = fit->law->linear ? 0.0 : dea_fit_stress(fit->law, less, point->load, point->stretch);
        column[i] = p->weights[i] * (dea_fit_stress(fit->law, more, point->load, point->stretch) - rest) / step;
        p->scale[j] = hypot(p->scale[j], column[i]);
    }
    for (size_t i = 0; i < p->rows && p->scale[j] > 0.0; i++) {
        column[i] /= p->scale[j];
    }
}

static dea_status problem_decompose(problem *p, dea_fit *fit, dea_error *error)
{
    double work[DEA_LAW_CONSTANTS];
    const lapack_int rows = (lapack_int)p->rows, terms = (lapack_int)p->terms;
    const lapack_int info = dea_lapacke_dgesvd(LAPACK_COL_MAJOR, 'S', 'S', rows, terms, p->matrix, rows, p->singular, p->left,
                                               rows, p->vt, terms, work);
    if (info < 0) { /* says nothing about the data */
        return dea_fail(error, DEA_ERROR_MEMORY, "out of memory in LAPACK (dgesvd: %d)", (int)info);
    }
    if (info > 0) {
        return dea_fail(error, DEA_ERROR_USAGE, "the least-squares problem could not be solved (LAPACK dgesvd: %d)", (int)info);
    }
    fit->condition = p->singular[0] / p->singular[p->terms - 1];
    if (!(fit->condition <= condition_max)) {
        return dea_fail(
            error, DEA_ERROR_USAGE,
            "the data does not determine %d %s constants: stretch from %.6g to %.6g gives condition number %.3g; fit fewer "
            "constants or measure more stretches",
            p->terms, fit->law->title, fit->stretch_min, fit->stretch_max, fit->condition);
    }
    return DEA_OK;
}

/* x_j = sum_k V_jk (u_k . b)/s_k, back in the unscaled columns; b becomes the residual. */
static void problem_solve(problem *p, dea_fit *fit)
{
    double projection[DEA_LAW_CONSTANTS] = {0.0};
    for (int k = 0; k < p->terms; k++) {
        for (size_t i = 0; i < p->rows; i++) {
            projection[k] += p->left[(size_t)k * p->rows + i] * p->right[i];
        }
    }
    for (int k = 0; k < p->terms; k++) {
        for (int j = 0; j < p->terms; j++) {
            fit->constants[j] += p->vt[j * p->terms + k] / p->singular[k] * projection[k] / p->scale[j];
        }
        for (size_t i = 0; i < p->rows; i++) {
            p->right[i] -= p->left[(size_t)k * p->rows + i] * projection[k];
        }
    }
    for (size_t i = 0; i < p->rows; i++) {
        p->squares += p->right[i] * p->right[i];
    }
}

/* Standard errors of the constants; the residual is overwritten. */
static void problem_spread(problem *p, dea_fit *fit)
{
    double alike[DEA_LAW_CONSTANTS * DEA_LAW_CONSTANTS], unlike[DEA_LAW_CONSTANTS * DEA_LAW_CONSTANTS];
    const size_t terms = (size_t)p->terms;
    const bool known = p->rows > terms;
    if (known) {
        dea_errors_covariances(&(dea_decomposed){p->rows, terms, p->left, p->singular, p->vt}, p->right, alike, unlike);
    }
    for (size_t j = 0; j < terms; j++) {
        const size_t place = j * terms + j;
        fit->deviation[j] = known ? sqrt(fmax(alike[place], unlike[place])) / p->scale[j] : NAN;
    }
}

static void fit_judge(const dea_fit_data *data, dea_fit *fit)
{
    double mean = 0.0, residuals = 0.0, spread = 0.0, squares = 0.0;
    const double count = (double)data->count;
    for (size_t i = 0; i < data->count; i++) {
        mean += data->points[i].stress / count;
    }
    for (size_t i = 0; i < data->count; i++) {
        const dea_fit_point *point = &data->points[i];
        const double residual = point->stress - dea_fit_stress(fit->law, fit->constants, point->load, point->stretch);
        residuals += residual * residual;
        spread += (point->stress - mean) * (point->stress - mean);
        squares += point->stress * point->stress;
    }
    fit->residual_rms = sqrt(residuals / count);
    fit->residual_relative = sqrt(residuals / squares);
    fit->r_squared = spread > DBL_EPSILON * squares ? 1.0 - residuals / spread : (double)NAN;
}

/* Walks the range of the data, and from rest, in search of a tangent modulus that is not positive. */
static void fit_walk(dea_fit *fit)
{
    enum { STEPS = 400 };
    const double from = fmin(fit->stretch_min, 1.0), to = fmax(fit->stretch_max, 1.0);
    fit->unstable_stretch = NAN;
    for (int i = 0; i <= STEPS; i++) {
        const double stretch = from + (to - from) * i / STEPS;
        for (int load = 0; load < DEA_LOAD_COUNT; load++) {
            if (!(load_tangent(fit, (dea_load)load, stretch) > 0.0)) {
                fit->unstable_stretch = stretch;
                return;
            }
        }
    }
}

static dea_status fit_examine(const dea_fit_data *data, const dea_law *law, int terms, dea_fit *fit, dea_error *error)
{
    *fit = (dea_fit){.law = law, .terms = terms, .criterion = (double)NAN, .stretch_min = INFINITY, .stretch_max = -INFINITY, .unloads_from = dea_plausible_turn(data)};
    size_t deformed = 0;
    for (size_t i = 0; i < data->count; i++) {
        const dea_fit_point *point = &data->points[i];
        deformed += fabs(point->stretch - 1.0) > 1e-9;
        fit->count[point->load]++;
        fit->stretch_min = fmin(fit->stretch_min, point->stretch);
        fit->stretch_max = fmax(fit->stretch_max, point->stretch);
    }
    for (int i = 0; i < DEA_LAW_CONSTANTS; i++) {
        fit->trials[i] = (dea_fit_trial){NAN, NAN};
    }
    if (deformed < (size_t)terms) {
        return dea_fail(error, DEA_ERROR_USAGE, "%zu points with a stretch other than 1 do not determine %d %s constant%s",
                        deformed, terms, law->title, terms == 1 ? "" : "s");
    }
    return DEA_OK;
}

/* Akaike's criterion, corrected for few points. */
static double criterion_of(double squares, size_t points, int terms)
{
    const double n = (double)points, k = terms + 1.0;
    return n > k + 1.0 ? n * log(squares / n) + 2.0 * k + 2.0 * k * (k + 1.0) / (n - k - 1.0) : (double)NAN;
}

/* Constants of a law that is not linear in them, and what is left of the right side. */
static dea_status problem_search(problem *p, const dea_fit_data *data, dea_fit *fit, dea_error *error)
{
    const size_t entries = (size_t)p->terms / fit->law->constant_count;
    const dea_status status = dea_fit_search(data, fit->law, entries, p->weights, fit->constants, error);
    for (size_t i = 0; i < p->rows && status == DEA_OK; i++) {
        const dea_fit_point *point = &data->points[i];
        p->right[i] -= p->weights[i] * dea_fit_stress(fit->law, fit->constants, point->load, point->stretch);
        p->squares += p->right[i] * p->right[i];
    }
    return status;
}

static dea_status problem_work(problem *p, const dea_fit_data *data, dea_fit *fit, dea_error *error)
{
    dea_status status = fit->law->linear ? DEA_OK : problem_search(p, data, fit, error);
    for (int j = 0; j < p->terms && status == DEA_OK; j++) {
        problem_column(p, data, fit, j);
    }
    status = status == DEA_OK ? problem_decompose(p, fit, error) : status;
    if (status == DEA_OK && fit->law->linear) {
        problem_solve(p, fit);
    }
    return status;
}

/* The best constants of that number; *squares: the weighted residuals, as a share of the weighted stresses. */
static dea_status fit_terms(const dea_fit_data *data, const dea_law *law, int terms, bool relative, dea_fit *fit, double *squares,
                            dea_error *error)
{
    dea_status status = fit_examine(data, law, terms, fit, error);
    status = status == DEA_OK ? dea_lapack_load(error) : status;
    if (status != DEA_OK) {
        return status;
    }
    problem p = {.rows = data->count, .terms = terms};
    status = problem_new(&p, data, relative, error);
    status = status == DEA_OK ? problem_work(&p, data, fit, error) : status;
    if (status == DEA_OK) {
        *squares = fmax(p.squares / p.all, rounding * rounding);
        fit->criterion = criterion_of(*squares, p.rows, terms);
        problem_spread(&p, fit);
        fit_judge(data, fit);
    }
    problem_free(&p);
    return status;
}

/* All numbers of constants of a law that can do with fewer up to @p most, each tested against one fewer; fits[i] has i + 1. Returns how many the data
 * determine. */
static dea_status fit_ladder(const dea_fit_data *data, const dea_law *law, int most, bool relative, dea_fit fits[DEA_LAW_CONSTANTS],
                             int *determined, dea_error *error)
{
    double squares[DEA_LAW_CONSTANTS];
    for (*determined = 0; *determined < most; ++*determined) {
        const int i = *determined;
        const dea_status status = fit_terms(data, law, i + 1, relative, &fits[i], &squares[i], error);
        if (status != DEA_OK) {
            return status == DEA_ERROR_USAGE && i > 0 ? DEA_OK : status;
        }
        if (i > 0) {
            memcpy(fits[i].trials, fits[i - 1].trials, sizeof fits[i].trials);
        }
        const size_t freedom = data->count - (size_t)i - 1;
        fits[i].trials[i] = (dea_fit_trial){fits[i].residual_relative, i > 0 ? dea_errors_chance(squares[i - 1], squares[i], freedom) : NAN};
    }
    return DEA_OK;
}

/* The largest number of constants whose last one is significant. */
static int terms_choose(const dea_fit *last)
{
    int terms = last->terms;
    while (terms > 1 && !(last->trials[terms - 1].p <= significance)) {
        terms--;
    }
    return terms;
}

/* A film has a stiffness at rest: C1, half its shear modulus, is above 0 beyond doubt. */
static dea_status sign_examine(const dea_fit *fit, dea_error *error)
{
    const double doubt = isfinite(fit->deviation[0]) ? sign_certain * fit->deviation[0] : 0.0;
    if (fit->constants[0] > doubt) {
        return DEA_OK;
    }
    return dea_fail(error, DEA_ERROR_DATA,
                    "the data give no elasticity: C1, half the shear modulus at rest, is %.4g Pa +- %.3g Pa and has to be above 0; "
                    "measure nearer to stretch 1, look at the columns, or fit fewer constants (--terms)",
                    fit->constants[0], isfinite(fit->deviation[0]) ? fit->deviation[0] : 0.0);
}

/* A law whose constants but the first have defaults: as many as are asked for, or as are significant. */
static dea_status climb(const dea_fit_data *data, const dea_law *law, int terms, bool relative, dea_fit *fit, dea_error *error)
{
    dea_fit fits[DEA_LAW_CONSTANTS];
    dea_error refused = {0};
    int determined = 0;
    const int most = (int)law->constant_count;
    if (terms < 0 || terms > most) {
        return dea_fail(error, DEA_ERROR_USAGE, "%d %s constants were asked for; accepted: 1 to %d, 0 for as many as the data tell",
                        terms, law->title, most);
    }
    dea_status status = fit_ladder(data, law, terms > 0 ? terms : most, relative, fits, &determined, &refused);
    if (status == DEA_OK && determined < terms) {
        status = refused.status;
    }
    if (refused.status == status && status != DEA_OK) {
        return dea_fail(error, status, "%s", refused.message);
    }
    if (status == DEA_OK) {
        *fit = fits[(terms > 0 ? terms : terms_choose(&fits[determined - 1])) - 1];
        memcpy(fit->trials, fits[determined - 1].trials, sizeof fit->trials);
        status = sign_examine(fit, error);
    }
    return status;
}

static void choice_note(dea_fit *to, const dea_fit *tried)
{
    if (to->choice_count < DEA_FIT_CHOICES) {
        to->choices[to->choice_count++] =
            (dea_fit_choice){tried->law, tried->terms, tried->residual_relative, tried->criterion};
    }
}

/* Keeps the better of two fits in @p best, with the choices of both; of two that are the same film the simpler law. */
static void better_keep(dea_fit *best, const dea_fit *tried, bool first)
{
    const bool same = fabs(tried->criterion - best->criterion) <= 1e-6;
    const bool better = same ? tried->law->constant_count < best->law->constant_count : tried->criterion < best->criterion;
    dea_fit_choice choices[DEA_FIT_CHOICES];
    const size_t count = best->choice_count;
    memcpy(choices, best->choices, sizeof choices);
    if (first || better) {
        *best = *tried;
        memcpy(best->choices, choices, sizeof choices);
        best->choice_count = count;
    }
    choice_note(best, tried);
}

static bool is_fatal(dea_status status)
{
    return status == DEA_ERROR_MEMORY || status == DEA_ERROR_MISSING;
}

/* The number of entries of a list with the least criterion, from 1 on; more than the data determine are left out. */
static dea_status entries_choose(const dea_fit_data *data, const dea_law *law, bool relative, dea_fit *fit, dea_error *error)
{
    dea_status first = DEA_OK;
    fit->choice_count = 0;
    for (size_t entries = 1; entries <= law->entries; entries++) {
        dea_fit tried;
        double squares;
        const dea_status status = fit_terms(data, law, (int)(entries * law->constant_count), relative, &tried, &squares,
                                            entries == 1 ? error : NULL);
        first = entries == 1 ? status : first;
        if (first != DEA_OK || is_fatal(status)) {
            return first != DEA_OK ? first : dea_fail(error, status, "out of memory");
        }
        if (status == DEA_OK && (entries == 1 || isfinite(tried.criterion))) {
            better_keep(fit, &tried, entries == 1);
        }
    }
    return DEA_OK;
}

static dea_status law_fit(const dea_fit_data *data, const dea_law *law, int terms, bool relative, dea_fit *fit, dea_error *error)
{
    double squares;
    const int whole = (int)law->constant_count;
    if (law->linear && whole > 1 && isfinite(law->constants[1].standard)) {
        return climb(data, law, terms, relative, fit, error);
    }
    if (law->entries > 1 && terms == 0) {
        return entries_choose(data, law, relative, fit, error);
    }
    if (terms < 0 || terms > (int)law->entries) {
        return dea_fail(error, DEA_ERROR_USAGE, "%d terms of the law %s were asked for; accepted: 1 to %zu", terms, law->name,
                        law->entries);
    }
    return fit_terms(data, law, terms > 0 ? terms * whole : whole, relative, fit, &squares, error);
}

dea_status dea_fit_law(const dea_fit_data *data, const dea_law *law, int terms, bool relative, dea_fit *fit, dea_error *error)
{
    if (!(stress_largest(data) > 0.0)) {
        return dea_fail(error, DEA_ERROR_USAGE, "all %zu measured stresses are 0", data->count);
    }
    dea_status status = dea_plausible_stretches(data, error);
    *fit = (dea_fit){0};
    status = status == DEA_OK ? law_fit(data, law, terms, relative, fit, error) : status;
    if (status != DEA_OK) {
        return status;
    }
    fit_walk(fit);
    return dea_law_valid(law, fit->constants)
               ? DEA_OK
               : dea_fail(error, DEA_ERROR_DATA, "the data give no film of the law %s: the best constants are out of range", law->name);
}

dea_status dea_fit_yeoh(const dea_fit_data *data, int terms, bool relative, dea_fit *fit, dea_error *error)
{
    return dea_fit_law(data, &dea_law_yeoh, terms, relative, fit, error);
}

dea_status dea_fit_auto(const dea_fit_data *data, bool relative, dea_fit *fit, dea_error *error)
{
    dea_error refused = {0};
    bool any = false;
    *fit = (dea_fit){0};
    for (size_t i = 0; dea_law_at(i); i++) {
        dea_fit tried;
        dea_error why = {0};
        const dea_status status = dea_fit_law(data, dea_law_at(i), 0, relative, &tried, &why);
        if (is_fatal(status)) {
            return dea_fail(error, status, "%s", why.message);
        }
        if (status == DEA_OK && isfinite(tried.criterion)) {
            better_keep(fit, &tried, !any);
            any = true;
        } else if (!refused.message[0]) {
            refused = why;
        }
    }
    if (any) {
        return DEA_OK;
    }
    return refused.message[0] ? dea_fail(error, refused.status, "%s", refused.message)
                              : dea_fail(error, DEA_ERROR_USAGE, "%zu points are too few to compare laws", data->count);
}
