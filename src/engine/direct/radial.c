/* The annulus is cut into elements, over each of which the two first-order equations in x = ln(R/R_a) are integrated by Gauss
 * collocation of order 20 from the frame in; with R_a as unit of length, W11 at the pre-stretch
 * as unit of stress, xi = e^x and T = xi s1:
 *
 *     u_x = (T - S12 u - xi f1)/S11,   T_x = S12 xi s + S22 u + xi f2 - rho w^2 xi^2 u,   s = u_x/xi
 *     c_x = xi (dC_1 u_x + dC_2 u):  change of the capacitance over 4 pi eps R_a^2/H
 *
 * Of the solutions with u = 0 at the frame, T = alpha u + beta at the edge. The disc is uniform: u ~ J1(kappa R). */
#include "engine/direct/radial.h"

#include <math.h>
#include <stdlib.h>

#include "film/point.h"
#include "model/field.h"
#include "support/gauss.h"

enum { STAGES = DEA_GAUSS_POINTS, UNKNOWNS = 2 * STAGES };

/* Width of an element of the first mesh in ln R; radians of the wave in one, with which the search for a mesh begins. */
static const double widest = 0.8, longest_phase = 3.0;
/* Displacements below this share of the static one count by that share: no engine is compared more closely. */
static const double negligible = 1e-9;
/* Meshes that differ by less differ by rounding. */
static const double rounding = 2e-13;

/* The film at one place of the annulus: real parts of what it answers with. */
typedef struct station {
    double xi;
    double w11, w12, w22; /* tangent moduli */
    double t1, t2;        /* P_a/l_a */
    double k11, k12, k22; /* what the voltage takes off them, less those of the skin */
    double c1, c2;        /* dC_1, dC_2 */
} station;

/* Gauss collocation over a step of 1: from slopes at the stages to the change up to each. */
typedef struct collocation {
    double a[STAGES][STAGES];
} collocation;

typedef struct dea_radial_mesh {
    collocation rule;
    size_t count;
    double *ends;      /* count + 1 of them, x */
    station *stations; /* STAGES of each element, from its outer end in */
} mesh;

static double lagrange(int j, double x)
{
    double product = 1.0;
    for (int m = 0; m < STAGES; m++) {
        product *= m == j ? 1.0 : (x - dea_gauss_place(m)) / (dea_gauss_place(j) - dea_gauss_place(m));
    }
    return product;
}

/* a_ij = int_0^{c_i} of polynomial j, which the rule itself integrates exactly. */
static collocation make_collocation(void)
{
    collocation rule;
    for (int i = 0; i < STAGES; i++) {
        for (int j = 0; j < STAGES; j++) {
            double sum = 0.0;
            for (int m = 0; m < STAGES; m++) {
                sum += dea_gauss_weight(m) * lagrange(j, dea_gauss_place(i) * dea_gauss_place(m));
            }
            rule.a[i][j] = dea_gauss_place(i) * sum;
        }
    }
    return rule;
}

/* Moduli of the skin where the film has one, which is elastic, else 0. */
static dea_biaxial skin_at(const dea_point *point, bool electroded, double l1, double l2)
{
    dea_biaxial skin = {0};
    if (electroded && point->skin_share > 0.0) {
        dea_point_coat(point, l1 / point->film.prestretch - 1.0, l2 / point->film.prestretch - 1.0, &skin);
    }
    return skin;
}

/* Material and voltage at stretches l1, l2 where the film has the Maxwell pressure k, 0 where bare. */
static station station_at(const dea_point *point, bool electroded, double xi, double l1, double l2, double k)
{
    const dea_film *film = &point->film;
    const dea_biaxial skin = skin_at(point, electroded, l1, l2);
    const dea_stress s = film->law->stress(film->constants, l1, l2);
    const dea_electric electric = dea_film_electric(film, l1 * l2);
    const double over = 1.0 / film->w11, second = k * electric.second;
    return (station){.xi = xi,
                     .w11 = s.w11 * over,
                     .w12 = s.w12 * over,
                     .w22 = s.w22 * over,
                     .t1 = s.p1 / l1 * over,
                     .t2 = s.p2 / l2 * over,
                     .k11 = (second * l2 * l2 - skin.w11) * over,
                     .k12 = ((k * electric.first + second) * l1 * l2 - skin.w12) * over,
                     .k22 = (second * l1 * l1 - skin.w22) * over,
                     .c1 = electric.first * l1 * l2 * l2,
                     .c2 = electric.first * l1 * l1 * l2};
}

static double nominal(const dea_radial *m)
{
    return m->dynamics->point.voltage / m->dynamics->point.film_thickness;
}

static double maxwell(const dea_radial *m, bool electroded)
{
    return electroded ? m->dynamics->point.film.permittivity * nominal(m) * nominal(m) : 0.0;
}

static bool is_dot(const dea_radial *m)
{
    return m->dynamics->point.kind == DEA_DOT;
}

static void free_mesh(mesh *grid)
{
    if (grid) {
        free(grid->ends);
        free(grid->stations);
        free(grid);
    }
}

/* Ends of the elements from the edge out, of which there are about 2^level; @p ends NULL counts them. Stretches vary with ln R,
 * waves with R. What is left for the last element is shared with the one before. */
static size_t lay_elements(const dea_radial *m, size_t level, double *ends)
{
    const double share = ldexp(1.0, -(int)level), length = -log(m->dynamics->point.coverage);
    size_t count = 0;
    double x = 0.0, last = 0.0;
    for (; x < length; count++) {
        if (ends) {
            ends[count] = length - x < 0.5 * last ? 0.5 * (ends[count - 1] + length) : x;
        }
        last = share * fmin(widest, expm1(length) * exp(-x));
        x += last;
    }
    if (ends) {
        ends[count] = length;
    }
    return count;
}

/* Stretches of the static film at all places of a mesh. */
static bool set_stations(const dea_radial *m, mesh *grid)
{
    const dea_point *point = &m->dynamics->point;
    const size_t count = grid->count * STAGES;
    double *x = calloc(count, sizeof *x);
    dea_stretches *stretches = malloc(count * sizeof *stretches);
    bool done = x && stretches;
    for (size_t i = 0; done && i < count; i++) {
        const double low = grid->ends[i / STAGES], high = grid->ends[i / STAGES + 1];
        x[i] = low + (high - low) * dea_gauss_place((int)(i % STAGES));
    }
    done = done && dea_field_profile(point, m->rest.strain, count, x, stretches);
    for (size_t i = 0; done && i < count; i++) {
        const size_t element = i / STAGES, stage = STAGES - 1 - i % STAGES; /* stages count from the outer end */
        grid->stations[element * STAGES + stage] =
            station_at(point, !is_dot(m), exp(x[i]), stretches[i].radial, stretches[i].hoop, maxwell(m, !is_dot(m)));
    }
    free(x);
    free(stretches);
    return done;
}

static mesh *make_mesh(const dea_radial *m, size_t level)
{
    mesh *grid = calloc(1, sizeof *grid);
    if (!grid) {
        return NULL;
    }
    grid->rule = make_collocation();
    grid->count = lay_elements(m, level, NULL);
    grid->ends = malloc((grid->count + 1) * sizeof *grid->ends);
    grid->stations = malloc(grid->count * STAGES * sizeof *grid->stations);
    bool done = grid->ends && grid->stations;
    if (done) {
        lay_elements(m, level, grid->ends);
        done = set_stations(m, grid);
    }
    if (!done) {
        free_mesh(grid);
    }
    return done ? grid : NULL;
}

/* What is the same all over the film at one frequency. */
typedef struct excitation {
    double complex viscous, elastic; /* V/(1 + V), 1/(1 + V): stresses are in units of (1 + V) W11 */
    double complex slope;            /* dk/dU of the annulus [1/V] */
    double complex inertia[2];       /* rho w^2 R_a^2 of disc and annulus */
} excitation;

/* u_x, T_x = [[a, b], [c, d]] (u, T) + (f, g). */
typedef struct linear_slope {
    double complex a, b, c, d, f, g;
} linear_slope;

static linear_slope slope_at(const station *s, const excitation *e)
{
    const double complex s11 = s->w11 + e->viscous * s->t1 - e->elastic * s->k11;
    const double complex s12 = s->w12 - e->elastic * s->k12;
    const double complex s22 = s->w22 + e->viscous * s->t2 - e->elastic * s->k22;
    const double complex over = 1.0 / s11;
    const double complex f1 = -e->slope * s->c1, f2 = -e->slope * s->c2;
    return (linear_slope){.a = -s12 * over,
                          .b = over,
                          .c = s22 - s12 * s12 * over - e->inertia[1] * s->xi * s->xi,
                          .d = s12 * over,
                          .f = -s->xi * f1 * over,
                          .g = s->xi * (f2 - s12 * f1 * over)};
}

/* The stage equations of one element, with two right-hand sides, real and imaginary parts apart. */
typedef struct system_of {
    double re[UNKNOWNS][UNKNOWNS + 2], im[UNKNOWNS][UNKNOWNS + 2];
} system_of;

static void set_entry(system_of *s, int row, int column, double complex value)
{
    s->re[row][column] = creal(value);
    s->im[row][column] = cimag(value);
}

static void swap_rows(system_of *s, int a, int b)
{
    for (int j = 0; j < UNKNOWNS + 2; j++) {
        const double re = s->re[a][j], im = s->im[a][j];
        s->re[a][j] = s->re[b][j];
        s->im[a][j] = s->im[b][j];
        s->re[b][j] = re;
        s->im[b][j] = im;
    }
}

/* Gauss-Jordan with pivots from the column: both solutions stand behind the matrix. Twenty unknowns are too few for a library. */
static void eliminate(system_of *s)
{
    for (int k = 0; k < UNKNOWNS; k++) {
        int best = k;
        for (int i = k + 1; i < UNKNOWNS; i++) {
            best = hypot(s->re[i][k], s->im[i][k]) > hypot(s->re[best][k], s->im[best][k]) ? i : best;
        }
        swap_rows(s, k, best);
        const double complex over = 1.0 / (s->re[k][k] + I * s->im[k][k]);
        for (int j = k + 1; j < UNKNOWNS + 2; j++) {
            const double complex value = (s->re[k][j] + I * s->im[k][j]) * over;
            set_entry(s, k, j, value);
        }
        for (int i = 0; i < UNKNOWNS; i++) {
            const double re = i == k ? 0.0 : s->re[i][k], im = i == k ? 0.0 : s->im[i][k];
            for (int j = k + 1; j < UNKNOWNS + 2; j++) {
                s->re[i][j] -= re * s->re[k][j] - im * s->im[k][j];
                s->im[i][j] -= re * s->im[k][j] + im * s->re[k][j];
            }
        }
    }
}

/* One solution at an end of an element. */
typedef struct wave {
    double complex u, t, c;
} wave;

/* Y_i + h sum_j a_ij (A_j Y_j + g_j) = y at the outer end, for the free solution (without g) and the driven one. */
static void set_system(const collocation *rule, const linear_slope *at, double h, const wave *free_one, const wave *driven, system_of *s)
{
    for (int i = 0; i < STAGES; i++) {
        double complex f = driven->u, g = driven->t;
        for (int j = 0; j < STAGES; j++) {
            const double weight = h * rule->a[i][j], one = i == j ? 1.0 : 0.0;
            set_entry(s, 2 * i, 2 * j, one + weight * at[j].a);
            set_entry(s, 2 * i, 2 * j + 1, weight * at[j].b);
            set_entry(s, 2 * i + 1, 2 * j, weight * at[j].c);
            set_entry(s, 2 * i + 1, 2 * j + 1, one + weight * at[j].d);
            f -= weight * at[j].f;
            g -= weight * at[j].g;
        }
        set_entry(s, 2 * i, UNKNOWNS, free_one->u);
        set_entry(s, 2 * i + 1, UNKNOWNS, free_one->t);
        set_entry(s, 2 * i, UNKNOWNS + 1, f);
        set_entry(s, 2 * i + 1, UNKNOWNS + 1, g);
    }
}

/* From the outer end of an element to the inner one: y - h sum b_i (A_i Y_i + g_i). */
static void cross(const station *stations, const linear_slope *at, const system_of *s, double h, int number, wave *w)
{
    const double driven = number == 1 ? 1.0 : 0.0;
    for (int i = 0; i < STAGES; i++) {
        const double complex u = s->re[2 * i][UNKNOWNS + number] + I * s->im[2 * i][UNKNOWNS + number];
        const double complex t = s->re[2 * i + 1][UNKNOWNS + number] + I * s->im[2 * i + 1][UNKNOWNS + number];
        const double complex slope = at[i].a * u + at[i].b * t + driven * at[i].f;
        const double weight = h * dea_gauss_weight(i);
        w->u -= weight * slope;
        w->t -= weight * (at[i].c * u + at[i].d * t + driven * at[i].g);
        w->c -= weight * stations[i].xi * (stations[i].c1 * slope + stations[i].c2 * u);
    }
}

/* The driven solution less so much of the free one that it is orthogonal to that, and the free one of size 1: neither outgrows the other. */
static void restart(wave *free_one, wave *driven)
{
    const double size = fmax(cabs(free_one->u), cabs(free_one->t));
    *free_one = (wave){free_one->u / size, free_one->t / size, free_one->c / size};
    const double square = creal(free_one->u * conj(free_one->u) + free_one->t * conj(free_one->t));
    const double complex share = (driven->u * conj(free_one->u) + driven->t * conj(free_one->t)) / square;
    *driven = (wave){driven->u - share * free_one->u, driven->t - share * free_one->t, driven->c - share * free_one->c};
}

/* Both solutions from the frame to the edge. */
static void integrate(const mesh *grid, const excitation *e, wave *free_one, wave *driven)
{
    *free_one = (wave){.t = 1.0};
    *driven = (wave){0};
    for (size_t k = grid->count; k-- > 0;) {
        const station *stations = grid->stations + k * STAGES;
        const double h = grid->ends[k + 1] - grid->ends[k];
        linear_slope at[STAGES];
        system_of s;
        for (int i = 0; i < STAGES; i++) {
            at[i] = slope_at(&stations[i], e);
        }
        set_system(&grid->rule, at, h, free_one, driven, &s);
        eliminate(&s);
        cross(stations, at, &s, h, 0, free_one);
        cross(stations, at, &s, h, 1, driven);
        restart(free_one, driven);
    }
}

/* z J0(z)/J1(z) = 2 - z^2/(4 - z^2/(6 - ...)), from the square of z. */
static double complex bessel_ratio(double complex square)
{
    const double far = cabs(csqrt(square));
    double complex tail = 0.0;
    for (double n = 2.0 * ceil(0.5 * far + 4.0 * cbrt(far) + 20.0); n > 0.0; n -= 1.0) {
        tail = 2.0 * n - (tail == 0.0 ? 0.0 : square / tail);
    }
    return tail;
}

/* The uniform disc: T = stiffness u + load at the edge. */
static double complex disc_stiffness(const excitation *e, const station *s)
{
    const double complex s11 = s->w11 + e->viscous * s->t1 - e->elastic * s->k11;
    const double complex s12 = s->w12 - e->elastic * s->k12;
    return s11 * (bessel_ratio(e->inertia[0] / s11) - 1.0) + s12;
}

double complex dea_radial_viscosity(const dea_dynamics *d, double omega)
{
    double complex sum = I * (omega * d->retardation);
    for (size_t i = 0; i < d->branch_count; i++) {
        const double complex s = I * (omega * d->branches[i].tau);
        sum += d->branches[i].share * s / (1.0 + s);
    }
    return sum;
}

static dea_per_volt answer_on(const dea_radial *m, const mesh *grid, double omega)
{
    const dea_point *point = &m->dynamics->point;
    const bool dot = is_dot(m);
    const double complex v = dea_radial_viscosity(m->dynamics, omega);
    const double complex slope =
        2.0 * point->film.permittivity * nominal(m) / (point->film_thickness * point->film.w11) / (1.0 + v); /* dk/dU */
    const double radius = m->dynamics->radius / point->film.prestretch;                       /* R_a */
    const double square = omega * omega;
    const excitation e = {.viscous = v / (1.0 + v),
                          .elastic = 1.0 / (1.0 + v),
                          .slope = dot ? 0.0 : slope,
                          .inertia = {m->mass[0] * square / (1.0 + v), m->mass[1] * square / (1.0 + v)}};
    const double l = point->film.prestretch * (1.0 + m->rest.strain);
    const station disc = station_at(point, dot, 1.0, l, l, maxwell(m, dot));
    wave free_one, driven;
    integrate(grid, &e, &free_one, &driven);
    /* disc: T = d u + f; annulus: (u, T) = driven + share free */
    const double complex load = dea_point_spring(point, m->rest.displacement).slope - m->load_mass * square + I * (omega * m->dynamics->damping);
    const double complex d = disc_stiffness(&e, &disc) +
                             load / (2.0 * DEA_PI * point->film_thickness * point->film.w11 * (1.0 + v));
    const double complex f = dot ? -slope * disc.c1 : 0.0;
    const double complex share = (d * driven.u + f - driven.t) / (free_one.t - d * free_one.u);
    const double complex u = driven.u + share * free_one.u;
    const double complex change = dot ? disc.c1 * u : -(driven.c + share * free_one.c); /* the integral runs inwards */
    const double unit = 4.0 * DEA_PI * point->film.permittivity * radius * radius / point->film_thickness;
    return (dea_per_volt){.displacement = radius * u, .charge = m->rest.capacitance + point->voltage * unit * change};
}

/* At rest the disc stays uniform whatever its radial stiffness ds1/dlambda1 is; where that is lost each of its waves grows instead of
 * passing, and no small motion about that rest is one. */
static bool is_disc_firm(const dea_radial *m)
{
    const dea_point *point = &m->dynamics->point;
    const double l = point->film.prestretch * (1.0 + m->rest.strain);
    const station disc = station_at(point, is_dot(m), 1.0, l, l, maxwell(m, is_dot(m)));
    return disc.w11 - disc.k11 > 0.0;
}

void dea_radial_open(const dea_dynamics *d, const dea_scene *scene, dea_radial *m)
{
    const dea_point *point = &d->point;
    const double radius = d->radius / point->film.prestretch;
    const double coat = dea_electrode_mass(scene);
    const double unit = d->mass > 0.0 ? radius * radius / point->film.w11 : 0.0;
    const double film = d->mass > 0.0 ? scene->material.density * unit : 0.0;
    const double electrode = coat * point->film.square / point->film_thickness * unit;
    *m = (dea_radial){.dynamics = d};
    m->mass[0] = film + (is_dot(m) ? electrode : 0.0);
    m->mass[1] = film + (is_dot(m) ? 0.0 : electrode);
    m->load_mass = d->mass > 0.0 ? dea_scene_edge(scene).mass : 0.0;
    dea_model_solve(d->model, point, fmin(scene->accuracy, 1e-12), &m->rest);
    if (isfinite(m->rest.strain) && !is_disc_firm(m)) {
        dea_row_refuse(&m->rest, DEA_STATE_PULL_IN);
    }
}

void dea_radial_close(dea_radial *m)
{
    for (size_t i = 0; i < DEA_RADIAL_MESHES; i++) {
        free_mesh(m->meshes[i]);
        m->meshes[i] = NULL;
    }
}

static bool answer_by(dea_radial *m, size_t level, double omega, dea_per_volt *answer)
{
    if (!m->meshes[level]) {
        m->meshes[level] = make_mesh(m, level);
    }
    if (m->meshes[level]) {
        *answer = answer_on(m, m->meshes[level], omega);
    }
    return m->meshes[level] != NULL;
}

/* Static displacement per volt, to which small ones are compared [m/V]. */
static double static_size(const dea_radial *m)
{
    return m->dynamics->point.voltage != 0.0 ? fabs(2.0 * m->rest.displacement / m->dynamics->point.voltage) : 0.0;
}

/* The mesh whose elements are short beside the wave at a frequency [rad/s]. */
static size_t first_level(const dea_radial *m, double omega)
{
    const double across = omega * sqrt(m->mass[1]) * expm1(-log(m->dynamics->point.coverage)); /* radians from edge to frame */
    size_t level = 0;
    for (double phase = across; phase > longest_phase && level + 2 < DEA_RADIAL_MESHES; level++) {
        phase *= 0.5;
    }
    return level;
}

bool dea_radial_answer(dea_radial *m, double frequency, double accuracy, dea_per_volt *answer)
{
    const double omega = 2.0 * DEA_PI * frequency, wanted = fmax(accuracy, rounding);
    const size_t first = first_level(m, omega);
    dea_per_volt last;
    bool done = false, made = answer_by(m, first, omega, &last);
    for (size_t level = first + 1; made && !done && level < DEA_RADIAL_MESHES; level++) {
        made = answer_by(m, level, omega, answer);
        const double size = fmax(cabs(answer->displacement), negligible * static_size(m));
        done = made && cabs(answer->displacement - last.displacement) <= wanted * size &&
               cabs(answer->charge - last.charge) <= wanted * cabs(answer->charge);
        last = *answer;
    }
    return done;
}
