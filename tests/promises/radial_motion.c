/* Transients of the membrane: collocation (Radau IIA, six stages) over the whole film. With D the inverse of its weights over the
 * step, a step is M D (D u - v) + F = 0 at its stages, branches eliminated as in moving.c. Newton's matrix, held over the step,
 * falls apart along the eigenvectors of D into one film each: its dynamic stiffness at s = gamma/h,
 *
 *   K + s^2 M + s r + [s tau_KV + sum c_i s tau_i/(1 + s tau_i)] K_sigma,   bordered by the charge behind a series resistance.
 *
 * Steps end at samples and corners of the drive; their length follows the highest coefficient of the stages' polynomial. The run is
 * repeated on finer meshes at tighter tolerances until two agree: their difference bounds the error. */
#include <math.h>
#include <stddef.h>
#include <stdlib.h>
#include <string.h>

#include "drive/signal.h"
#include "radau.h"
#include "radial.h"

enum { PAIRS = STAGES / 2, ROUNDS = 24, BRANCHES = 8, LEVELS = 5, KNOTS = STAGES + 1 };

static const double most_work = 6e4; /* unknowns times steps of a run, some seconds */
static const double cheap_work = 5e3; /* below it a truth is made as good as any engine's best wants it */
static const long double first_tolerance = 4e-6L, next_tolerance = 0.05L, first_fineness = 2.0L;
static const double good = 9e-8, best = 3e-11; /* difference of two runs at which no third is made, of dear and of cheap ones; */
static const long double first_share = 0.03L; /* first tolerance over that accuracy */
static const double enough = 0.05;             /* and over the accuracy that is wanted */
static const double gains = 0.3; /* share of the last difference above which a finer mesh is not worth its steps: kinks travel undamped */
static const long double solved = 1e-4L; /* last change of Newton's method, over the tolerance */
static const long double shortest = 1e-13L; /* step over its segment at which the equations count as without solution */

/* Along an eigenvector of D: its eigenvalue, the vector and what takes the part of it out of the stages; one of each conjugate pair. */
typedef struct wave {
    long double complex pace, vector[STAGES], part[STAGES];
} wave;

typedef struct state {
    long double u[RADIAL_MOST], v[RADIAL_MOST];
    long double w, q, area; /* film voltage, charge, int u dt at the edge */
    long double z[RADIAL_SPOTS][2][BRANCHES];
} state;

/* Of a step: changes of u from its begin, velocities, film and source voltages, stresses and their rates. */
typedef struct stages {
    long double change[STAGES][RADIAL_MOST], v[STAGES][RADIAL_MOST];
    long double volts[STAGES], source[STAGES], capacitance[STAGES];
    long double sigma[STAGES][RADIAL_SPOTS][2], rate[STAGES][RADIAL_SPOTS][2], d[STAGES][RADIAL_SPOTS][2];
    long double residual[STAGES][RADIAL_MOST + 1];
} stages;

typedef struct motion {
    true_film film;
    radial mesh;
    dea_signal signal;
    const dea_segment *segment;
    const dea_scene *scene;
    method radau;
    wave waves[PAIRS];
    long double factor, tolerance;
    long double size[3]; /* of u, v, w */
    lag lags[BRANCHES];
    long double gain[STAGES][STAGES];              /* sum c_i gain_i of a step */
    long double relaxed[STAGES][RADIAL_SPOTS][2];  /* sum c_i rest_i z_i of a step */
    radial_look look;
    radial_system systems[PAIRS];
    long double complex border[PAIRS][RADIAL_MOST]; /* K^-1 2 phi U of each */
    long double volts; /* at which the look was taken */
    stages now;
    long double before[STAGES][RADIAL_MOST], before_h; /* changes and length of the last step, 0: there is none in this segment */
    radial_pairs held;
    state from, to;
    dea_sample *samples;
    radial_margins *margins;
    size_t rows, done;
    long double edges[DEA_WINDOWS][2];
    double steps;
    const char *why;
    bool gone;
} motion;

/* ---- the method along its eigenvectors */

/* Roots of the denominator of its stability function, sum_j (2s - 1 - j)! s!/((2s - 1)! (s - j)!) (-z)^j/j!, by Durand and Kerner. */
static void find_paces(long double complex roots[STAGES])
{
    long double c[STAGES + 1] = {1.0L};
    for (int j = 1; j <= STAGES; j++) {
        c[j] = -c[j - 1] * (STAGES - j + 1) / (long double)((2 * STAGES - j) * j);
    }
    for (int i = 0; i < STAGES; i++) {
        roots[i] = 8.0L * cexpl(I * (0.4L + 6.283185307179586L * i / STAGES));
    }
    for (int n = 0; n < 400; n++) {
        for (int i = 0; i < STAGES; i++) {
            long double complex p = 0.0L, others = c[STAGES];
            for (int j = STAGES; j >= 0; j--) {
                p = p * roots[i] + c[j];
            }
            for (int k = 0; k < STAGES; k++) {
                others *= k == i ? 1.0L : roots[i] - roots[k];
            }
            roots[i] -= p / others;
        }
    }
}

/* (a - shift) x = b, by elimination with pivots. */
static void shifted_solve(const square *a, bool transposed, long double complex shift, long double complex *x)
{
    long double complex m[STAGES][STAGES];
    for (int i = 0; i < STAGES; i++) {
        for (int j = 0; j < STAGES; j++) {
            m[i][j] = (transposed ? a->at[j][i] : a->at[i][j]) - (i == j ? shift : 0.0L);
        }
    }
    for (int k = 0; k < STAGES; k++) {
        int pivot = k;
        for (int i = k + 1; i < STAGES; i++) {
            pivot = cabsl(m[i][k]) > cabsl(m[pivot][k]) ? i : pivot;
        }
        for (int j = 0; j < STAGES; j++) {
            const long double complex swap = m[k][j];
            m[k][j] = m[pivot][j];
            m[pivot][j] = swap;
        }
        const long double complex swap = x[k];
        x[k] = x[pivot];
        x[pivot] = swap;
        for (int i = 0; i < STAGES; i++) {
            const long double complex share = i == k ? 0.0L : m[i][k] / m[k][k];
            for (int j = k; j < STAGES; j++) {
                m[i][j] -= share * m[k][j];
            }
            x[i] -= share * x[k];
        }
    }
    for (int k = 0; k < STAGES; k++) {
        x[k] /= m[k][k];
    }
}

/* Inverse iteration beside an eigenvalue, from either side. */
static void find_vector(const square *a, bool transposed, long double complex pace, long double complex *x)
{
    for (int i = 0; i < STAGES; i++) {
        x[i] = 1.0L + 0.1L * i;
    }
    for (int n = 0; n < 4; n++) {
        long double size = 0.0L;
        shifted_solve(a, transposed, pace * (1.0L + 1e-9L), x);
        for (int i = 0; i < STAGES; i++) {
            size = fmaxl(size, cabsl(x[i]));
        }
        for (int i = 0; i < STAGES; i++) {
            x[i] /= size;
        }
    }
}

static void set_waves(motion *m)
{
    long double complex roots[STAGES];
    int count = 0;
    find_paces(roots);
    for (int i = 0; i < STAGES; i++) {
        if (!(cimagl(roots[i]) > 0.0L) || count >= PAIRS) {
            continue;
        }
        wave *w = &m->waves[count++];
        long double complex product = 0.0L;
        w->pace = roots[i];
        find_vector(&m->radau.slope, false, w->pace, w->vector);
        find_vector(&m->radau.slope, true, w->pace, w->part);
        for (int k = 0; k < STAGES; k++) {
            product += w->vector[k] * w->part[k];
        }
        for (int k = 0; k < STAGES; k++) {
            w->part[k] /= product;
        }
    }
}

/* ---- one step */

static long double source_at(const motion *m, long double time)
{
    return m->factor * true_source(&m->signal, m->segment, time);
}

/* What the branches of a step do to its stages. */
static void set_branches(motion *m, const state *from, long double h)
{
    const true_film *f = &m->film;
    memset(m->gain, 0, sizeof m->gain);
    memset(m->relaxed, 0, sizeof m->relaxed);
    for (size_t b = 0; b < f->branches; b++) {
        m->lags[b] = lag_of(&m->radau, h / f->tau[b]);
        for (int i = 0; i < STAGES; i++) {
            long double rest = 0.0L;
            for (int j = 0; j < STAGES; j++) {
                rest += m->lags[b].rest.at[i][j];
                m->gain[i][j] += f->share[b] * m->lags[b].gain.at[i][j];
            }
            for (int k = 0; k < 2 * m->mesh.spots; k++) {
                m->relaxed[i][k / 2][k % 2] += f->share[b] * rest * from->z[k / 2][k % 2][b];
            }
        }
    }
}

static bool look_at_stage(motion *m, const state *from, int i)
{
    const radial *r = &m->mesh;
    stages *s = &m->now;
    long double u[RADIAL_MOST];
    for (int n = 0; n < r->size; n++) {
        u[n] = from->u[n] + s->change[i][n];
    }
    s->capacitance[i] = 0.0L;
    for (int spot = 0; spot < r->spots; spot++) {
        long double *d = s->d[i][spot], rates[2];
        jet own[2];
        radial_strain(r, u, spot, d);
        if (!(d[0] > -m->film.prestretch && d[1] > -m->film.prestretch)) {
            return false;
        }
        if (m->film.retardation > 0.0L) {
            radial_strain(r, s->v[i], spot, rates);
        } else {
            rates[0] = rates[1] = 0.0L;
        }
        film_cauchy_along(&m->film, d[0], d[1], rates[0], rates[1], own);
        for (int a = 0; a < 2; a++) {
            s->sigma[i][spot][a] = own[a].value;
            s->rate[i][spot][a] = own[a].slope;
        }
        s->capacitance[i] += radial_capacitance(r, spot, d);
    }
    return true;
}

/* D times a vector of the stages less that at the begin. */
static void slope_of(const motion *m, long double h, long double (*values)[RADIAL_MOST], const long double *begin,
                     long double (*slopes)[RADIAL_MOST])
{
    for (int i = 0; i < STAGES; i++) {
        for (int n = 0; n < m->mesh.size; n++) {
            long double sum = 0.0L;
            for (int j = 0; j < STAGES; j++) {
                sum += m->radau.slope.at[i][j] * (values[j][n] - (begin ? begin[n] : 0.0L));
            }
            slopes[i][n] = sum / h;
        }
    }
}

static void add_inertia(motion *m, int i, const long double *a)
{
    const radial *r = &m->mesh;
    long double *out = m->now.residual[i];
    for (int row = 0; row < r->size; row++) {
        for (int k = 0; k <= RADIAL_DEGREE; k++) {
            const int column = row - RADIAL_DEGREE + k;
            if (column >= 0) {
                out[row] += r->mass[row][k] * a[column];
                out[column] += column < row ? r->mass[row][k] * a[row] : 0.0L;
            }
        }
    }
}

/* F of a stage, but for its inertia. */
static void add_film(motion *m, int i)
{
    const true_film *f = &m->film;
    const radial *r = &m->mesh;
    stages *s = &m->now;
    for (int spot = 0; spot < r->spots; spot++) {
        long double x[2], stress[2];
        for (int a = 0; a < 2; a++) {
            x[a] = f->total_share * s->sigma[i][spot][a] + f->retardation * s->rate[i][spot][a] - m->relaxed[i][spot][a];
            for (int j = 0; j < STAGES && f->branches > 0; j++) {
                x[a] -= m->gain[i][j] * s->sigma[j][spot][a];
            }
        }
        radial_nominal(r, spot, s->d[i][spot], s->volts[i], s->sigma[i][spot], x, stress);
        radial_pull(r, spot, stress, s->residual[i]);
    }
}

/* Residuals of all stages; that of the charge stands behind those of the film. False where a stage is no film. */
static bool follow_stages(motion *m, const state *from, long double h)
{
    static _Thread_local long double a[STAGES][RADIAL_MOST];
    const true_film *f = &m->film;
    const radial *r = &m->mesh;
    stages *s = &m->now;
    slope_of(m, h, s->change, NULL, s->v);
    slope_of(m, h, s->v, from->v, a);
    memset(s->residual, 0, sizeof s->residual);
    for (int i = 0; i < STAGES; i++) {
        if (!look_at_stage(m, from, i)) {
            return false;
        }
    }
    for (int i = 0; i < STAGES; i++) {
        add_film(m, i);
        if (r->heavy) {
            add_inertia(m, i, a[i]);
        }
        s->residual[i][r->edge] += f->load_stiffness * (from->u[r->edge] + s->change[i][r->edge]) +
                                   f->load_damping * s->v[i][r->edge] - f->load_force;
        if (f->series > 0.0L) {
            long double current = 0.0L;
            for (int j = 0; j < STAGES; j++) {
                current += m->radau.slope.at[i][j] / h * (s->capacitance[j] * s->volts[j] - from->q);
            }
            s->residual[i][r->size] = f->series * current + s->volts[i] * (1.0L + f->series * f->conductance) - s->source[i];
        }
    }
    return true;
}

/* Newton's matrices, about the middle of the step as it is guessed. */
static bool set_systems(motion *m, const state *from, long double h)
{
    const true_film *f = &m->film;
    const radial *r = &m->mesh;
    const int middle = STAGES / 2;
    long double u[RADIAL_MOST];
    for (int n = 0; n < r->size; n++) {
        u[n] = from->u[n] + m->now.change[middle][n];
    }
    for (int spot = 0; spot < r->spots; spot++) {
        long double d[2];
        jet own[2];
        radial_strain(r, u, spot, d);
        film_cauchy_along(f, d[0], d[1], 0.0L, 0.0L, own);
        for (int a = 0; a < 2; a++) {
            m->held[spot][a] = f->total_share * own[a].value - m->relaxed[0][spot][a];
        }
    }
    m->volts = m->now.volts[middle];
    if (!radial_look_at(r, u, m->volts, f->branches > 0 ? m->held : NULL, 0.0L, &m->look)) {
        return false;
    }
    for (int k = 0; k < PAIRS; k++) {
        const long double complex s = m->waves[k].pace / h;
        long double complex viscous = s * f->retardation;
        for (size_t b = 0; b < f->branches; b++) {
            viscous += f->share[b] * (s * f->tau[b] / (1.0L + s * f->tau[b]));
        }
        radial_factor(r, &m->look, (radial_factors){1.0L, viscous, r->heavy ? s * s : 0.0L, s * f->load_damping}, &m->systems[k]);
        for (int n = 0; n < r->size && f->series > 0.0L; n++) {
            m->border[k][n] = 2.0L * m->volts * m->look.push[n];
        }
        if (f->series > 0.0L) {
            radial_solve(r, &m->systems[k], m->border[k]);
        }
    }
    return true;
}

static long double complex along(const radial *r, const long double *a, const long double complex *b)
{
    long double complex sum = 0.0L;
    for (int n = 0; n < r->size; n++) {
        sum += a[n] * b[n];
    }
    return sum;
}

/* The change along one eigenvector; behind a series resistance K u - 2 phi U w = r and s R (2 phi U u + C w) + (1 + R/R_p) w = r_w. */
static void solve_wave(const motion *m, int k, long double h, long double complex *x)
{
    const true_film *f = &m->film;
    const radial *r = &m->mesh;
    const long double complex rest = x[r->size], s = m->waves[k].pace / h;
    radial_solve(r, &m->systems[k], x);
    x[r->size] = 0.0L;
    if (f->series > 0.0L) {
        const long double complex turn = s * f->series * 2.0L * m->volts;
        const long double complex own =
            s * f->series * m->look.capacitance + 1.0L + f->series * f->conductance + turn * along(r, m->look.push, m->border[k]);
        x[r->size] = (rest - turn * along(r, m->look.push, x)) / own;
        for (int n = 0; n < r->size; n++) {
            x[n] += m->border[k][n] * x[r->size];
        }
    }
}

/* One round of Newton's method; the size of its change. */
static long double round_of(motion *m, long double h)
{
    const radial *r = &m->mesh;
    stages *s = &m->now;
    long double most = 0.0L;
    static _Thread_local long double complex x[PAIRS][RADIAL_MOST + 1];
    for (int k = 0; k < PAIRS; k++) {
        for (int n = 0; n <= r->size; n++) {
            x[k][n] = 0.0L;
            for (int i = 0; i < STAGES; i++) {
                x[k][n] += m->waves[k].part[i] * s->residual[i][n];
            }
        }
        solve_wave(m, k, h, x[k]);
    }
    for (int i = 0; i < STAGES; i++) {
        for (int n = 0; n <= r->size; n++) {
            long double change = 0.0L;
            for (int k = 0; k < PAIRS; k++) {
                change += 2.0L * creall(m->waves[k].vector[i] * x[k][n]);
            }
            *(n < r->size ? &s->change[i][n] : &s->volts[i]) -= n < r->size || m->film.series > 0.0L ? change : 0.0L;
            most = fmaxl(most, fabsl(change) / m->size[n < r->size ? 0 : 2]);
        }
    }
    return most;
}

static bool newton(motion *m, const state *from, long double h)
{
    long double last = (long double)INFINITY;
    if (!set_systems(m, from, h)) {
        return false;
    }
    for (int i = 0; i < ROUNDS; i++) {
        if (!follow_stages(m, from, h)) {
            return false;
        }
        const long double change = round_of(m, h);
        if (!(change < 1e3L) || (i > 2 && change > 2.0L * last)) {
            return false;
        }
        if (change <= solved * m->tolerance || (change < 1e-12L && change >= 0.3L * last)) {
            return follow_stages(m, from, h);
        }
        last = change;
    }
    return false;
}

/* Lagrange's polynomials over the begin of a step and its stages, at a place in units of the step. */
static void extrapolation(const motion *m, long double at, long double weights[KNOTS])
{
    for (int k = 0; k < KNOTS; k++) {
        const long double own = k == 0 ? 0.0L : m->radau.place[k - 1];
        weights[k] = 1.0L;
        for (int j = 0; j < KNOTS; j++) {
            const long double other = j == 0 ? 0.0L : m->radau.place[j - 1];
            weights[k] *= j == k ? 1.0L : (at - other) / (own - other);
        }
    }
}

/* The last step goes on, or the film as it moves. */
static void guess(motion *m, const state *from, long double time, long double h)
{
    stages *s = &m->now;
    for (int i = 0; i < STAGES; i++) {
        const long double place = m->radau.place[i];
        long double w[KNOTS];
        s->source[i] = source_at(m, time + h * place);
        s->volts[i] = m->film.series > 0.0L ? from->w : s->source[i];
        for (int n = 0; n < m->mesh.size; n++) {
            s->change[i][n] = m->mesh.heavy ? h * place * from->v[n] : 0.0L;
        }
        if (!(m->before_h > 0.0L) || h > 2.0L * m->before_h) {
            continue;
        }
        extrapolation(m, 1.0L + place * h / m->before_h, w);
        for (int n = 0; n < m->mesh.size; n++) {
            long double sum = -m->before[STAGES - 1][n]; /* that step's end is this one's begin */
            for (int j = 0; j < STAGES; j++) {
                sum += w[j + 1] * m->before[j][n];
            }
            s->change[i][n] = sum;
        }
    }
}

/* From a state, a time behind the begin of the segment; false where there is no solution. */
static bool step_by(motion *m, const state *from, long double time, long double h, state *to)
{
    const radial *r = &m->mesh;
    const int last = STAGES - 1;
    guess(m, from, time, h);
    set_branches(m, from, h);
    if (!newton(m, from, h)) {
        return false;
    }
    const stages *s = &m->now;
    to->w = s->volts[last];
    to->q = s->capacitance[last] * to->w;
    to->area = from->area;
    for (int n = 0; n < r->size; n++) {
        to->u[n] = from->u[n] + s->change[last][n];
        to->v[n] = s->v[last][n];
    }
    for (int i = 0; i < STAGES; i++) { /* the weights of the last stage are those of the step */
        to->area += h * m->radau.weight.at[last][i] * (from->u[r->edge] + s->change[i][r->edge]);
    }
    for (int k = 0; k < 2 * r->spots; k++) {
        for (size_t b = 0; b < m->film.branches; b++) {
            long double sum = 0.0L;
            for (int j = 0; j < STAGES; j++) {
                sum += m->lags[b].rest.at[last][j] * from->z[k / 2][k % 2][b] + m->lags[b].gain.at[last][j] * s->sigma[j][k / 2][k % 2];
            }
            to->z[k / 2][k % 2][b] = sum;
        }
    }
    return true;
}

/* Largest coefficient of Legendre's polynomial of degree STAGES in the stages, over the sizes. */
static long double top_coefficient(const motion *m, const state *from)
{
    static const long double central = 924.0L; /* 12!/(6!)^2: leading coefficient of that polynomial on 0..1 */
    const stages *s = &m->now;
    long double weights[STAGES], most = 0.0L, volts = 0.0L;
    for (int k = 0; k < STAGES; k++) {
        weights[k] = 1.0L / m->radau.place[k];
        for (int j = 0; j < STAGES; j++) {
            weights[k] /= j == k ? 1.0L : m->radau.place[k] - m->radau.place[j];
        }
        volts += weights[k] * (s->volts[k] - from->w);
    }
    for (int n = 0; n < m->mesh.size; n++) {
        long double u = 0.0L, v = 0.0L;
        for (int k = 0; k < STAGES; k++) {
            u += weights[k] * s->change[k][n];
            v += weights[k] * (s->v[k][n] - from->v[n]);
        }
        most = fmaxl(most, fmaxl(fabsl(u) / m->size[0], m->mesh.heavy ? fabsl(v) / m->size[1] : 0.0L));
    }
    volts = m->film.series > 0.0L ? fabsl(volts) / m->size[2] : 0.0L;
    return fmaxl(most, volts) / central;
}

/* ---- rates */

static bool is_free(const motion *m)
{
    return !m->mesh.heavy && m->film.retardation == 0.0L;
}

/* x = sum c_i (sigma_a - z_ai) of a state, and sum c_i z_ai of it. */
static void branch_stresses(motion *m, const state *s, radial_pairs x, radial_pairs held)
{
    const true_film *f = &m->film;
    for (int spot = 0; spot < m->mesh.spots; spot++) {
        long double d[2];
        jet own[2];
        radial_strain(&m->mesh, s->u, spot, d);
        film_cauchy_along(f, d[0], d[1], 0.0L, 0.0L, own);
        for (int a = 0; a < 2; a++) {
            held[spot][a] = 0.0L;
            for (size_t b = 0; b < f->branches; b++) {
                held[spot][a] += f->share[b] * s->z[spot][a][b];
            }
            x[spot][a] = f->total_share * own[a].value - held[spot][a];
        }
    }
}

/* Sum over the places of what stresses of branches, f_a/lambda_a, do to the unknowns, f: c (sigma - z)/tau. */
static void relaxing(motion *m, const state *s, long double *force)
{
    const true_film *f = &m->film;
    for (int spot = 0; spot < m->mesh.spots; spot++) {
        long double d[2], stress[2] = {0.0L, 0.0L};
        jet own[2];
        radial_strain(&m->mesh, s->u, spot, d);
        film_cauchy_along(f, d[0], d[1], 0.0L, 0.0L, own);
        for (size_t b = 0; b < f->branches; b++) {
            for (int a = 0; a < 2; a++) {
                stress[a] += f->share[b] * (own[a].value - s->z[spot][a][b]) / f->tau[b] / (f->prestretch + d[a]);
            }
        }
        radial_pull(&m->mesh, spot, stress, force);
    }
}

static long double dot(const radial *r, const long double *a, const long double *b)
{
    long double sum = 0.0L;
    for (int n = 0; n < r->size; n++) {
        sum += a[n] * b[n];
    }
    return sum;
}

/* Velocities of a film without mass and damper, from the rate of its balance: K_held v = 2 phi U U' + what the branches lose, with
 * U' = (i - U/R_p - 2 phi U v)/C behind a series resistance. */
static void velocity_of_balance(motion *m, long double time, const state *s, long double *v)
{
    const true_film *f = &m->film;
    const radial *r = &m->mesh;
    long double pull[RADIAL_MOST], own[RADIAL_MOST];
    memset(v, 0, RADIAL_MOST * sizeof *v);
    relaxing(m, s, v);
    radial_factor(r, &m->look, (radial_factors){.elastic = 1.0L, .viscous = f->total_share}, &m->systems[0]);
    for (int n = 0; n < r->size; n++) {
        pull[n] = own[n] = 2.0L * s->w * m->look.push[n];
    }
    radial_solve_real(r, &m->systems[0], v);
    radial_solve_real(r, &m->systems[0], own);
    long double slope = m->factor * true_source_slope(&m->signal, m->segment, time);
    if (f->series > 0.0L) {
        const long double charging = (source_at(m, time) - s->w) / f->series - s->w * f->conductance;
        slope = (charging - dot(r, pull, v)) / (m->look.capacitance + dot(r, pull, own));
    }
    for (int n = 0; n < r->size; n++) {
        v[n] += own[n] * slope;
    }
}

/* Velocities at a state that m->look has been taken of: of a mass the state's, of a damper alone from the balance of forces. */
static void velocities_of(motion *m, long double time, const state *s, radial_pairs x, long double *v)
{
    const true_film *f = &m->film;
    const radial *r = &m->mesh;
    if (r->heavy) {
        memcpy(v, s->v, RADIAL_MOST * sizeof *v);
        return;
    }
    if (is_free(m)) {
        velocity_of_balance(m, time, s, v);
        return;
    }
    memset(v, 0, RADIAL_MOST * sizeof *v);
    for (int spot = 0; spot < r->spots; spot++) {
        long double d[2], stress[2];
        jet own[2];
        radial_strain(r, s->u, spot, d);
        film_cauchy_along(f, d[0], d[1], 0.0L, 0.0L, own);
        const long double sigma[2] = {own[0].value, own[1].value};
        radial_nominal(r, spot, d, s->w, sigma, x[spot], stress);
        stress[0] = -stress[0];
        stress[1] = -stress[1];
        radial_pull(r, spot, stress, v);
    }
    v[r->edge] += f->load_force - f->load_stiffness * s->u[r->edge];
    radial_factor(r, &m->look, (radial_factors){.viscous = f->retardation, .damper = f->load_damping}, &m->systems[0]);
    radial_solve_real(r, &m->systems[0], v);
}

static long double current_of(const motion *m, long double time, const state *s, const long double *v)
{
    const true_film *f = &m->film;
    if (f->series > 0.0L) {
        return (source_at(m, time) - s->w) / f->series;
    }
    const long double slope = m->factor * true_source_slope(&m->signal, m->segment, time);
    return m->look.capacitance * slope + 2.0L * s->w * dot(&m->mesh, m->look.push, v) + s->w * f->conductance;
}

/* ---- a run */

/* A sample, the time behind the begin of the segment; false where the film has ended. */
static bool record(motion *m, double time, long double here, const state *s)
{
    const true_film *f = &m->film;
    static _Thread_local radial_pairs x;
    long double v[RADIAL_MOST];
    branch_stresses(m, s, x, m->held);
    if (!radial_look_at(&m->mesh, s->u, s->w, x, f->total_share, &m->look)) {
        return false;
    }
    const bool firm = f->retardation > 0.0L || m->look.firmness > 0.0L;
    if (!firm && !(m->mesh.heavy && time == 0.0)) { /* at the start a film with mass has not moved yet, whatever it does then */
        return false;
    }
    velocities_of(m, here, s, x, v);
    const dea_row row = radial_row(&m->mesh, s->u, s->w, &m->margins[m->done]);
    m->samples[m->done++] = (dea_sample){.time = time,
                                         .voltage = (double)s->w,
                                         .displacement = row.displacement,
                                         .strain = row.strain,
                                         .velocity = (double)v[m->mesh.edge],
                                         .force = row.force,
                                         .current = (double)current_of(m, here, s, v),
                                         .charge = row.charge,
                                         .focal_length = row.focal_length,
                                         .film_voltage = f->series > 0.0L ? (double)s->w : (double)NAN,
                                         .capacitance = row.capacitance,
                                         .state = row.state};
    return firm;
}

/* Place of an edge of a window in the segment, INFINITY once it is passed. */
static long double edge_at(const motion *m, size_t i)
{
    const dea_window *window = &m->scene->transient.averages[i / 2];
    const double end = m->signal.segments[m->signal.count - 1].to, edge = fmin(i % 2 == 0 ? window->from : window->to, end);
    return isnan(m->edges[i / 2][i % 2]) ? (long double)edge - m->segment->from : (long double)INFINITY;
}

/* The next place at which a step has to end. */
static long double next_stop(const motion *m, long double time)
{
    const long double width = (long double)m->segment->to - m->segment->from;
    long double stop = width;
    if (m->done < m->rows) {
        stop = fminl(stop, (long double)dea_layout_place(m->scene, m->done) - m->segment->from);
    }
    for (size_t i = 0; i < 2 * m->scene->transient.average_count; i++) {
        stop = fminl(stop, edge_at(m, i));
    }
    return stop > time ? stop : width;
}

/* Samples and edges of windows that lie where a step ends. */
static bool arrive(motion *m, long double time, bool ends, const state *s)
{
    for (size_t i = 0; i < 2 * m->scene->transient.average_count; i++) {
        if (edge_at(m, i) <= time || (ends && m->segment == &m->signal.segments[m->signal.count - 1])) {
            m->edges[i / 2][i % 2] = isnan(m->edges[i / 2][i % 2]) ? s->area : m->edges[i / 2][i % 2];
        }
    }
    const bool last = ends && m->segment == &m->signal.segments[m->signal.count - 1];
    while (m->done < m->rows) {
        const double at = dea_layout_place(m->scene, m->done);
        if ((long double)at - m->segment->from > time && !last) {
            return true;
        }
        if (!record(m, at, time, s)) {
            return false;
        }
    }
    return true;
}

/* First step behind an edge: short against all that the film does. */
static long double first_step(const motion *m)
{
    const true_film *f = &m->film;
    long double h = (long double)m->segment->to - m->segment->from;
    h = m->mesh.heavy ? fminl(h, m->size[0] / m->size[1]) : h;
    h = f->retardation > 0.0L ? fminl(h, f->retardation) : h;
    h = f->series > 0.0L ? fminl(h, f->series * m->look.capacitance) : h;
    for (size_t b = 0; b < f->branches; b++) {
        h = fminl(h, f->tau[b]);
    }
    return 0.05L * h;
}

/* Has the film lost what holds it? */
static bool is_ending(motion *m, const state *s)
{
    static _Thread_local radial_pairs x;
    branch_stresses(m, s, x, m->held);
    if (!radial_look_at(&m->mesh, s->u, s->w, x, m->film.total_share, &m->look)) {
        return true;
    }
    radial_factor(&m->mesh, &m->look, (radial_factors){.elastic = 1.0L, .viscous = m->film.total_share}, &m->systems[0]);
    return !(m->look.firmness > 1e-3L * fabsl(m->film.rest.w11)) || (is_free(m) && !m->systems[0].definite);
}

static void give_up(motion *m, const state *s)
{
    m->gone = is_ending(m, s);
    m->why = m->gone ? NULL : "the truth's equations were not solved";
}

static bool run_segment(motion *m)
{
    const long double width = (long double)m->segment->to - m->segment->from;
    long double time = 0.0L, h = first_step(m);
    m->before_h = 0.0L;
    while (time < width) {
        const long double stop = next_stop(m, time);
        const bool stops = time + 1.001L * h >= stop;
        const long double step = stops ? stop - time : time + 2.0L * h > stop ? 0.5L * (stop - time) : h;
        const bool found = step_by(m, &m->from, time, step, &m->to);
        const long double error = found ? top_coefficient(m, &m->from) : (long double)INFINITY;
        if ((m->steps += 1.0) * m->mesh.size > most_work) {
            m->why = "too many steps of the truth";
            return false;
        }
        if (!(error <= m->tolerance)) {
            h = step * (found ? fmaxl(0.1L, 0.8L * powl(m->tolerance / error, 1.0L / 6.0L)) : 0.25L);
            if (h < shortest * width) {
                give_up(m, &m->from);
                return false;
            }
            continue;
        }
        time = stops ? stop : time + step;
        m->from = m->to;
        memcpy(m->before, m->now.change, sizeof m->before);
        m->before_h = step;
        if (!arrive(m, time, time >= width, &m->from)) {
            m->gone = true;
            return false;
        }
        const long double longer = step * fminl(4.0L, 0.9L * powl(m->tolerance / fmaxl(error, 1e-40L), 1.0L / 6.0L));
        h = step < h ? fmaxl(longer, h) : longer; /* a step that a stop cut short says nothing against the last length */
    }
    return true;
}

/* Static displacement under the largest voltage as a linear film has it, and how fast the film swings. */
static bool set_sizes(motion *m)
{
    const true_film *f = &m->film;
    const radial *r = &m->mesh;
    long double still[RADIAL_MOST], u[RADIAL_MOST] = {0.0L}, energy = 0.0L, inertia = 0.0L;
    if (!radial_still(r, 0.0L, u) || !radial_look_at(r, u, 0.0L, NULL, 0.0L, &m->look)) {
        return false;
    }
    const long double volts = fmaxl(m->factor * m->signal.largest, 1e-30L), rest = fabsl(u[r->edge]);
    memcpy(still, m->look.push, sizeof still);
    radial_factor(r, &m->look, (radial_factors){.elastic = 1.0L}, &m->systems[0]);
    radial_solve_real(r, &m->systems[0], still);
    energy = dot(r, still, m->look.push);
    memset(m->now.residual, 0, sizeof m->now.residual);
    add_inertia(m, 0, still);
    inertia = dot(r, still, m->now.residual[0]);
    m->size[0] = fmaxl(rest, fminl(fabsl(still[r->edge]) * volts * volts, fminl(f->divide, f->frame - f->divide)));
    m->size[1] = r->heavy ? m->size[0] * sqrtl(energy / inertia) : 1.0L;
    m->size[2] = volts;
    return true;
}

static bool start(motion *m)
{
    state *s = &m->from;
    const bool biased = m->scene->transient.from_bias;
    memset(s, 0, sizeof *s);
    m->segment = m->signal.segments;
    s->w = biased ? m->film.kept * source_at(m, 0.0L) : 0.0L;
    if (!radial_still(&m->mesh, s->w, s->u)) {
        return false;
    }
    for (int spot = 0; spot < m->mesh.spots; spot++) {
        long double d[2];
        jet own[2];
        radial_strain(&m->mesh, s->u, spot, d);
        film_cauchy_along(&m->film, d[0], d[1], 0.0L, 0.0L, own);
        s->q += radial_capacitance(&m->mesh, spot, d) * s->w;
        for (size_t b = 0; b < m->film.branches; b++) {
            s->z[spot][0][b] = own[0].value;
            s->z[spot][1][b] = own[1].value;
        }
    }
    return true;
}

/* A voltage that jumps takes a film with it that nothing holds. */
static bool jump(motion *m, long double to)
{
    static _Thread_local radial_pairs x, held;
    state *s = &m->from;
    const radial_load before = {s->w * s->w, m->film.load_force}, behind = {to * to, m->film.load_force};
    branch_stresses(m, s, x, held);
    s->w = to;
    return !is_free(m) || radial_settle(&m->mesh, before, behind, m->film.branches > 0 ? held : NULL, s->u);
}

static void run(motion *m)
{
    m->done = 0;
    m->steps = 0.0;
    for (size_t i = 0; i < 2 * DEA_WINDOWS; i++) {
        m->edges[i / 2][i % 2] = (long double)NAN;
    }
    m->gone = !set_sizes(m) || !start(m);
    for (size_t i = 0; !m->gone && i < m->signal.count; i++) {
        m->segment = &m->signal.segments[i];
        if (!(m->film.series > 0.0L)) {
            m->gone = !jump(m, source_at(m, 0.0L));
        }
        if (i == 0 && !m->gone) {
            m->gone = !record(m, 0.0, 0.0L, &m->from);
            for (size_t k = 0; k < 2 * m->scene->transient.average_count; k++) {
                m->edges[k / 2][k % 2] = edge_at(m, k) <= 0.0L ? 0.0L : m->edges[k / 2][k % 2];
            }
        }
        if (m->gone || !run_segment(m)) {
            return;
        }
    }
}

/* ---- meshes */

/* Difference of two runs over the peak of the displacement. */
static double apart(const dea_sample *a, const dea_sample *b, size_t count, dea_sample *errors)
{
    double peak = 0.0;
    raise_errors(errors, a, b, count);
    for (size_t i = 0; i < count; i++) {
        peak = fmax(peak, fabs(b[i].displacement));
    }
    return errors->displacement > 0.0 ? errors->displacement / peak : 0.0;
}

/* Means of the last run; how far those of the one before were off. */
static void take_means(const motion *m, true_run *truth)
{
    truth->mean_error = 0.0;
    for (size_t i = 0; i < m->scene->transient.average_count; i++) {
        const dea_window *w = &m->scene->transient.averages[i];
        const double now = (double)((m->edges[i][1] - m->edges[i][0]) / ((long double)w->to - w->from));
        truth->mean_error = fmax(truth->mean_error, fabs(now - truth->means[i]));
        truth->means[i] = now;
    }
}

static bool is_enough(const motion *m, double error)
{
    const double least = m->steps * m->mesh.size < cheap_work ? best : good;
    return error <= fmax(least, enough * m->scene->accuracy);
}

static void refine(motion *m, true_run *truth)
{
    dea_sample *before = calloc(m->rows, sizeof *before);
    double fineness = (double)first_fineness, last = (double)INFINITY;
    size_t count = 0;
    m->tolerance = fmaxl(first_tolerance, first_share * (long double)m->scene->accuracy);
    truth->error = (double)INFINITY;
    for (int level = 0; level < LEVELS && !is_enough(m, truth->error); level++) {
        if (!radial_open(&m->mesh, &m->film, fineness, level)) {
            break;
        }
        m->why = NULL;
        run(m);
        if (m->why) {
            truth->why = isfinite(truth->error) ? NULL : m->why;
            break;
        }
        truth->why = NULL;
        truth->good = m->done;
        memset(&truth->errors, 0, sizeof truth->errors);
        const double gap = apart(before, m->samples, count < m->done ? count : m->done, &truth->errors);
        last = truth->error;
        truth->error = level > 0 && count == m->done ? 1e-16 + gap : (double)INFINITY;
        take_means(m, truth);
        memcpy(before, m->samples, m->done * sizeof *before);
        count = m->done;
        truth->steps = m->steps;
        m->tolerance *= next_tolerance;
        fineness *= 1.7;
        if (isfinite(last) && !(truth->error <= gains * last)) {
            break;
        }
    }
    memcpy(m->samples, before, count * sizeof *before);
    free(before);
}

true_run radial_motion(const dea_scene *scene, const dea_model *model, double factor)
{
    motion *m = calloc(1, sizeof *m);
    true_run truth = {.count = dea_layout_of(scene).rows};
    truth.samples = calloc(truth.count, sizeof *truth.samples);
    truth.margins = calloc(truth.count, sizeof *truth.margins);
    m->scene = scene;
    m->film = film_of(scene, model);
    m->radau = radau_method();
    m->factor = factor;
    m->rows = truth.count;
    m->samples = truth.samples;
    m->margins = truth.margins;
    set_waves(m);
    truth.why = m->film.branches > BRANCHES ? "more branches than the truth takes" : NULL;
    if (!truth.why && dea_signal_open(scene, &m->signal, NULL) == DEA_OK) {
        refine(m, &truth);
    } else {
        truth.why = truth.why ? truth.why : "no signal";
    }
    truth.still = (double)m->size[0];
    dea_signal_close(&m->signal);
    free(m);
    return truth;
}
