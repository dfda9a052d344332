/* Standard errors for noise that is alike in all points, and for noise that is not.
 *
 * With A = U S V^T, x = V S^-1 U^T b and rows of variance v_i the covariance is W U^T diag(v) U W^T, W = V S^-1. Alike noise has v_i =
 * sum e^2/(rows - columns). Else v_i = e_i^2/(1 - h_i), h_i = |row i of U|^2 (HC2 of MacKinnon and White 1985) is right on the
 * average, but poor where few rows carry a constant. A variance is the larger of the two. */
#include "material/fit/errors.h"

#include <math.h>

/* Least 1 - h: a row that alone determines a constant has no residual to tell its variance. */
static const double freedom_least = 1e-9;

/* The variance of a row, from its residual. */
static double row_variance(const dea_decomposed *m, size_t row, double residual)
{
    double used = 0.0;
    for (size_t k = 0; k < m->columns; k++) {
        used += m->left[k * m->rows + row] * m->left[k * m->rows + row];
    }
    return residual * residual / fmax(1.0 - used, freedom_least);
}

/* Entry (k, l) of U^T diag(v) U. */
static double middle_entry(const dea_decomposed *m, const double *variance, size_t k, size_t l)
{
    double sum = 0.0;
    for (size_t i = 0; i < m->rows; i++) {
        sum += m->left[k * m->rows + i] * m->left[l * m->rows + i] * variance[i];
    }
    return sum;
}

/* W U^T diag(v) U W^T. */
static void covariance_fill(const dea_decomposed *m, const double *variance, double *covariance)
{
    const size_t n = m->columns;
    for (size_t i = 0; i < n * n; i++) {
        covariance[i] = 0.0;
    }
    for (size_t k = 0; k < n; k++) {
        for (size_t l = 0; l < n; l++) {
            const double middle = middle_entry(m, variance, k, l) / (m->singular[k] * m->singular[l]);
            for (size_t i = 0; i < n * n; i++) {
                covariance[i] += m->vt[i / n * n + k] * middle * m->vt[i % n * n + l];
            }
        }
    }
}

void dea_errors_covariances(const dea_decomposed *m, double *residual, double *alike, double *unlike)
{
    double squares = 0.0;
    for (size_t i = 0; i < m->rows; i++) {
        squares += residual[i] * residual[i];
        residual[i] = row_variance(m, i, residual[i]);
    }
    covariance_fill(m, residual, unlike);
    for (size_t i = 0; i < m->rows; i++) {
        residual[i] = squares / (double)(m->rows - m->columns);
    }
    covariance_fill(m, residual, alike);
}

/* F with 1 and n degrees of freedom is the square of Student's t, whose chance is in closed form (Abramowitz and Stegun 26.7.3
 * and 26.7.4): with tan a = t/sqrt n, 1 - sin a (1 + 1/2 cos^2 a + 1*3/(2*4) cos^4 a + ...) up to cos^(n-2) for even n, and
 * 1 - 2/pi (a + sin a cos a (1 + 2/3 cos^2 a + ...)) for odd n. */
double dea_errors_chance(double less, double more, size_t freedom)
{
    static const double pi = 3.14159265358979323846;
    if (freedom == 0) {
        return NAN;
    }
    const double tangent = sqrt(fmax(less - more, 0.0) / more), angle = atan(tangent);
    const double sine = sin(angle), cosine = cos(angle);
    const bool odd = freedom % 2 == 1;
    double term = odd ? cosine : 1.0, sum = freedom > 1 ? term : 0.0;
    for (size_t k = odd ? 3 : 2; k + 2 <= freedom; k += 2) {
        term *= cosine * cosine * (double)(k - 1) / (double)k;
        sum += term;
    }
    return odd ? 1.0 - 2.0 / pi * (angle + sine * sum) : 1.0 - sine * sum;
}
