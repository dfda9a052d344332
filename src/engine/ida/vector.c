/* Serial vectors, and dense factors, whose sums go many numbers at once: most of a step of IDA over a film of rings is sums of vectors, for which the
 * library's own loops take one number after the other. Every number is the sum of the same products in the same order, whatever the
 * width of the processor's vectors; a norm has DEA_LANES sums. */
#include <math.h>
#include <string.h>

#include "engine/ida/sundials.h"
#include "support/lanes.h"

/* Most vectors of a sum: the past values that BDF or the stages that a Runge-Kutta method combines. */
enum { MOST_TERMS = 16 };

/* z = sum c_k x_k; z may be one of the x. */
DEA_INLINE void combine_body(size_t n, size_t count, const double *c, const double *const *x, double *z)
{
    size_t i = 0;
    for (; i + DEA_LANES <= n; i += DEA_LANES) {
        double sum[DEA_LANES] = {0.0};
        for (size_t k = 0; k < count; k++) {
            const double *at = x[k] + i;
            DEA_EACH_LANE(l)
            {
                sum[l] += c[k] * at[l];
            }
        }
        memcpy(z + i, sum, sizeof sum);
    }
    for (; i < n; i++) {
        double sum = 0.0;
        for (size_t k = 0; k < count; k++) {
            sum += c[k] * x[k][i];
        }
        z[i] = sum;
    }
}

DEA_LANES_DISPATCH(combine, combine_body, (size_t n, size_t count, const double *c, const double *const *x, double *z), (n, count, c, x, z))

/* sum (x_i w_i)^2, of each lane; what is left over goes to the first. */
DEA_INLINE void square_body(size_t n, const double *x, const double *w, double *sums)
{
    double sum[DEA_LANES] = {0.0};
    size_t i = 0;
    for (; i + DEA_LANES <= n; i += DEA_LANES) {
        DEA_EACH_LANE(l)
        {
            const double part = x[i + l] * w[i + l];
            sum[l] += part * part;
        }
    }
    for (; i < n; i++) {
        sum[0] += x[i] * w[i] * (x[i] * w[i]);
    }
    memcpy(sums, sum, sizeof sum);
}

DEA_LANES_DISPATCH(square, square_body, (size_t n, const double *x, const double *w, double *sums), (n, x, w, sums))

/* b -= c a. */
DEA_INLINE void reduce(size_t n, double c, const double *a, double *b)
{
    size_t i = 0;
    for (; i + DEA_LANES <= n; i += DEA_LANES) {
        double part[DEA_LANES];
        DEA_EACH_LANE(l)
        {
            part[l] = b[i + l] - c * a[i + l];
        }
        memcpy(b + i, part, sizeof part);
    }
    for (; i < n; i++) {
        b[i] -= c * a[i];
    }
}

/* L U x = P b in place, column by column. */
DEA_INLINE void substitute_body(size_t n, double *const *columns, const sunindextype *pivots, double *b)
{
    for (size_t k = 0; k < n; k++) {
        const double other = b[pivots[k]];
        b[pivots[k]] = b[k];
        b[k] = other;
    }
    for (size_t k = 0; k < n; k++) {
        reduce(n - k - 1, b[k], columns[k] + k + 1, b + k + 1);
    }
    for (size_t k = n; k-- > 0;) {
        b[k] /= columns[k][k];
        reduce(k, b[k], columns[k], b);
    }
}

DEA_LANES_DISPATCH(substitute, substitute_body, (size_t n, double *const *columns, const sunindextype *pivots, double *b),
                   (n, columns, pivots, b))

void dea_sundials_substitute(SUNLinearSolver solver, SUNMatrix factors, double *b)
{
    const SUNLinearSolverContent_Dense content = solver->content;
    substitute((size_t)SM_COLUMNS_D(factors), SM_COLS_D(factors), content->pivots, b);
}

static size_t length(N_Vector v)
{
    return (size_t)NV_LENGTH_S(v);
}

static void scale(sunrealtype c, N_Vector x, N_Vector z)
{
    const double *from = NV_DATA_S(x);
    combine(length(z), 1, &c, &from, NV_DATA_S(z));
}

static void linear_sum(sunrealtype a, N_Vector x, sunrealtype b, N_Vector y, N_Vector z)
{
    const double c[] = {a, b}, *const from[] = {NV_DATA_S(x), NV_DATA_S(y)};
    combine(length(z), 2, c, from, NV_DATA_S(z));
}

static int linear_combination(int count, sunrealtype *c, N_Vector *x, N_Vector z)
{
    const double *from[MOST_TERMS];
    if (count > MOST_TERMS) {
        return -1;
    }
    for (int k = 0; k < count; k++) {
        from[k] = NV_DATA_S(x[k]);
    }
    combine(length(z), (size_t)count, c, from, NV_DATA_S(z));
    return 0;
}

static sunrealtype weighted_norm(N_Vector x, N_Vector w)
{
    double sums[DEA_LANES], sum = 0.0;
    square(length(x), NV_DATA_S(x), NV_DATA_S(w), sums);
    DEA_EACH_LANE(l)
    {
        sum += sums[l];
    }
    return sqrt(sum / (double)length(x));
}

N_Vector dea_sundials_vector(const dea_sundials *sun, size_t count)
{
    N_Vector v = sun->N_VNew_Serial((sunindextype)count, sun->context);
    if (v) {
        v->ops->nvscale = scale;
        v->ops->nvlinearsum = linear_sum;
        v->ops->nvlinearcombination = linear_combination;
        v->ops->nvwrmsnorm = weighted_norm;
    }
    return v;
}
