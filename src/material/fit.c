/* Yeoh constants by linear least squares. The nominal stress is linear in C: P = sum C_i dP/dC_i, so with rows weighted by v and
 * columns scaled to length 1 the problem is min |A x - b|. The singular value decomposition A = U S V^T gives x = V S^-1 U^T b,
 * the covariance (fit_errors.h) and the condition number at once. */
#include "deaspice/fit.h"

#include <float.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "material/fit_errors.h"
#include "material/fit_plausible.h"
#include "material/law.h"
#include "support/lapack.h"

/* Condition number of the scaled columns beyond which the data does not tell the constants apart. */
static const double condition_max = 1e7;

/* The largest weight in a relative fit: that of a stress of 1 % of the largest. */
static const double relative_floor = 0.01;

/* Chance of a gain by noise up to which a constant counts as significant. */
static const double significance = 0.05;

/* Residual, as a share of the rms stress, that is rounding. */
static const double rounding = 1e-9;

/* Standard errors by which C1 must lie above 0: less would leave its sign to noise. */
static const double sign_certain = 2.0;

const char *dea_load_name(dea_load load)
{
    static const char *const names[DEA_LOAD_COUNT] = {"uniaxial", "equibiaxial"};
    return (unsigned)load < DEA_LOAD_COUNT ? names[load] : "unknown";
}

dea_load dea_load_find(const char *name)
{
    int load = 0;
    while (load < DEA_LOAD_COUNT && strcmp(name, dea_load_name((dea_load)load)) != 0) {
        load++;
    }
    return (dea_load)load;
}

dea_status dea_fit_add(dea_fit_data *data, dea_fit_point point, dea_error *error)
{
    if (!(point.stretch > 0.0) || !isfinite(point.stretch) || !isfinite(point.stress) || (unsigned)point.load >= DEA_LOAD_COUNT) {
        return dea_fail(error, DEA_ERROR_USAGE, "a measured point needs a stretch above 0, a finite stress and a load");
    }
    if (data->count == data->room) {
        const size_t room = data->room > 0 ? 2 * data->room : 64;
        dea_fit_point *points = realloc(data->points, room * sizeof *points);
        if (!points) {
            return dea_fail(error, DEA_ERROR_MEMORY, "out of memory");
        }
        data->points = points;
        data->room = room;
    }
    data->points[data->count++] = point;
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
    double *matrix;                  /* A, rows x terms; owned */
    double *right;                   /* b, rows; owned */
    double *left;                    /* U, rows x terms; owned */
    double scale[DEA_YEOH_TERMS];    /* length of the columns before scaling */
    double singular[DEA_YEOH_TERMS]; /* descending */
    double vt[DEA_YEOH_TERMS * DEA_YEOH_TERMS];
    double squares; /* of the weighted residuals */
} problem;

static void problem_free(problem *p)
{
    free(p->matrix);
    free(p->right);
    free(p->left);
}

static double stress_largest(const dea_fit_data *data)
{
    double largest = 0.0;
    for (size_t i = 0; i < data->count; i++) {
        largest = fmax(largest, fabs(data->points[i].stress));
    }
    return largest;
}

static dea_status problem_fill(problem *p, const dea_fit_data *data, bool relative, dea_error *error)
{
    static const double units[DEA_YEOH_TERMS][DEA_LAW_CONSTANTS] = {{1.0, 0.0, 0.0}, {0.0, 1.0, 0.0}, {0.0, 0.0, 1.0}};
    const double largest = stress_largest(data);
    p->matrix = malloc(p->rows * (size_t)p->terms * sizeof *p->matrix);
    p->left = malloc(p->rows * (size_t)p->terms * sizeof *p->left);
    p->right = malloc(p->rows * sizeof *p->right);
    if (!p->matrix || !p->left || !p->right) {
        return dea_fail(error, DEA_ERROR_MEMORY, "out of memory");
    }
    for (int j = 0; j < p->terms; j++) {
        double *column = p->matrix + (size_t)j * p->rows;
        for (size_t i = 0; i < p->rows; i++) {
            const dea_fit_point *point = &data->points[i];
            const double weight = relative ? 1.0 / fmax(fabs(point->stress), relative_floor * largest) : 1.0;
            column[i] = weight * dea_fit_stress(&dea_law_yeoh, units[j], point->load, point->stretch);
            p->right[i] = weight * point->stress;
            p->scale[j] = hypot(p->scale[j], column[i]);
        }
        for (size_t i = 0; i < p->rows && p->scale[j] > 0.0; i++) {
            column[i] /= p->scale[j];
        }
    }
    return DEA_OK;
}

static dea_status problem_decompose(problem *p, dea_fit *fit, dea_error *error)
{
    double work[DEA_YEOH_TERMS];
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
            "the data does not determine %d Yeoh constants: stretch from %.6g to %.6g gives condition number %.3g; fit fewer "
            "constants or measure more stretches",
            p->terms, fit->stretch_min, fit->stretch_max, fit->condition);
    }
    return DEA_OK;
}

/* x_j = sum_k V_jk (u_k . b)/s_k, back in the unscaled columns; b becomes the residual. */
static void problem_solve(problem *p, dea_fit *fit)
{
    double projection[DEA_YEOH_TERMS] = {0.0};
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
    double alike[DEA_YEOH_TERMS * DEA_YEOH_TERMS], unlike[DEA_YEOH_TERMS * DEA_YEOH_TERMS];
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
    fit->r_squared = 1.0 - residuals / spread;
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

static dea_status fit_examine(const dea_fit_data *data, int terms, dea_fit *fit, dea_error *error)
{
    *fit = (dea_fit){.law = &dea_law_yeoh, .terms = terms, .stretch_min = INFINITY, .stretch_max = -INFINITY, .unloads_from = dea_plausible_turn(data)};
    size_t deformed = 0;
    for (size_t i = 0; i < data->count; i++) {
        const dea_fit_point *point = &data->points[i];
        deformed += fabs(point->stretch - 1.0) > 1e-9;
        fit->count[point->load]++;
        fit->stretch_min = fmin(fit->stretch_min, point->stretch);
        fit->stretch_max = fmax(fit->stretch_max, point->stretch);
    }
    for (int i = 0; i < DEA_YEOH_TERMS; i++) {
        fit->trials[i] = (dea_fit_trial){NAN, NAN};
    }
    if (deformed < (size_t)terms) {
        return dea_fail(error, DEA_ERROR_USAGE, "%zu points with a stretch other than 1 do not determine %d Yeoh constant%s",
                        deformed, terms, terms == 1 ? "" : "s");
    }
    return DEA_OK;
}

/* The best constants of that number; *squares: the weighted residuals, as a share of the weighted stresses. */
static dea_status fit_terms(const dea_fit_data *data, int terms, bool relative, dea_fit *fit, double *squares, dea_error *error)
{
    dea_status status = fit_examine(data, terms, fit, error);
    status = status == DEA_OK ? dea_lapack_load(error) : status;
    if (status != DEA_OK) {
        return status;
    }
    problem p = {.rows = data->count, .terms = terms};
    status = problem_fill(&p, data, relative, error);
    if (status == DEA_OK) {
        status = problem_decompose(&p, fit, error);
    }
    if (status == DEA_OK) {
        double all = 0.0;
        for (size_t i = 0; i < p.rows; i++) {
            all += p.right[i] * p.right[i];
        }
        problem_solve(&p, fit);
        *squares = fmax(p.squares / all, rounding * rounding);
        problem_spread(&p, fit);
        fit_judge(data, fit);
    }
    problem_free(&p);
    return status;
}

/* All numbers of constants up to @p most, each tested against one fewer; fits[i] has i + 1. Returns how many the data determine. */
static dea_status fit_ladder(const dea_fit_data *data, int most, bool relative, dea_fit fits[DEA_YEOH_TERMS], int *determined,
                             dea_error *error)
{
    double squares[DEA_YEOH_TERMS];
    for (*determined = 0; *determined < most; ++*determined) {
        const int i = *determined;
        const dea_status status = fit_terms(data, i + 1, relative, &fits[i], &squares[i], error);
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

dea_status dea_fit_yeoh(const dea_fit_data *data, int terms, bool relative, dea_fit *fit, dea_error *error)
{
    dea_fit fits[DEA_YEOH_TERMS];
    dea_error refused = {0};
    int determined = 0;
    if (terms < 0 || terms > DEA_YEOH_TERMS) {
        return dea_fail(error, DEA_ERROR_USAGE, "%d Yeoh constants were asked for; accepted: 1 to %d, 0 for as many as the data tell",
                        terms, DEA_YEOH_TERMS);
    }
    if (!(stress_largest(data) > 0.0)) {
        return dea_fail(error, DEA_ERROR_USAGE, "all %zu measured stresses are 0", data->count);
    }
    dea_status status = dea_plausible_stretches(data, error);
    if (status == DEA_OK) {
        status = fit_ladder(data, terms > 0 ? terms : DEA_YEOH_TERMS, relative, fits, &determined, &refused);
    }
    if (status == DEA_OK && determined < terms) {
        status = refused.status;
    }
    if (refused.status == status && status != DEA_OK) {
        return dea_fail(error, status, "%s", refused.message);
    }
    if (status == DEA_OK) {
        *fit = fits[(terms > 0 ? terms : terms_choose(&fits[determined - 1])) - 1];
        memcpy(fit->trials, fits[determined - 1].trials, sizeof fit->trials);
        fit_walk(fit);
        status = sign_examine(fit, error);
    }
    return status;
}
