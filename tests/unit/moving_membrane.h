/* The moving membrane found another way: finite elements of degree six with Gauss's rule and a mass matrix that is not diagonal,
 * stresses as physics.md writes them, and the classical Runge-Kutta method. It knows no rings. */
#ifndef DEA_TEST_MOVING_MEMBRANE_H
#define DEA_TEST_MOVING_MEMBRANE_H

#include <stdlib.h>

#include "judges.h"
#include "random_scenes.h"
#include "result/scales.h"
#include "support/gauss.h"

enum {
    FE_DEGREE = 6,
    FE_ELEMENTS = 6,
    FE_NODES = FE_DEGREE * FE_ELEMENTS + 1,
    FE_PLACES = FE_ELEMENTS * DEA_GAUSS_POINTS,
    FE_BRANCHES = 2
};

/* What moves: nodes, places and branches, charge. */
typedef struct fe_state {
    double u[FE_NODES], v[FE_NODES], z[FE_PLACES][2][FE_BRANCHES], q;
} fe_state;

typedef struct fe_film {
    double yeoh[3], prestretch, frame, coverage, thickness, permittivity, density, electrode;
    double retardation, share[FE_BRANCHES], tau[FE_BRANCHES];
    size_t branches;
    double series, leak; /* [Ohm] and [S]; series 0: none */
    bool dot;
    double voltage, rise;
    const double *potential; /* across each place of an electrode that has not one voltage [V]; NULL: it has */
    double radius[FE_PLACES], weight[FE_PLACES];     /* R, dR */
    double shape[DEA_GAUSS_POINTS][FE_DEGREE + 1];   /* of every element */
    double slope[FE_PLACES][FE_DEGREE + 1];          /* over R */
    double inverse[FE_NODES][FE_NODES];              /* of the mass matrix of the nodes that move */
    size_t disc_elements;
} fe_film;

static const double fe_pi = 3.14159265358979323846;

static inline double fe_node(int i)
{
    return 0.5 * (1.0 - cos(fe_pi * i / FE_DEGREE));
}

/* Lagrange polynomial n at x, and its slope. */
static inline double fe_polynomial(int n, double x, double *slope)
{
    double value = 1.0;
    *slope = 0.0;
    for (int k = 0; k <= FE_DEGREE; k++) {
        double product = k == n ? 0.0 : 1.0 / (fe_node(n) - fe_node(k));
        for (int j = 0; j <= FE_DEGREE; j++) {
            product *= j == n || j == k ? 1.0 : (x - fe_node(j)) / (fe_node(n) - fe_node(j));
        }
        *slope += product;
        value *= k == n ? 1.0 : (x - fe_node(k)) / (fe_node(n) - fe_node(k));
    }
    return value;
}

/* Two or more elements of equal length to each side of the edge. */
static inline void fe_mesh(fe_film *f)
{
    const double rim = f->frame / f->prestretch, edge = f->coverage * rim;
    f->disc_elements = (size_t)fmin(FE_ELEMENTS - 2, fmax(2.0, round(FE_ELEMENTS * f->coverage)));
    const double disc = edge / (double)f->disc_elements, annulus = (rim - edge) / (double)(FE_ELEMENTS - f->disc_elements);
    for (size_t e = 0; e < FE_ELEMENTS; e++) {
        const bool in = e < f->disc_elements;
        const double length = in ? disc : annulus, from = in ? disc * (double)e : edge + annulus * (double)(e - f->disc_elements);
        for (int g = 0; g < DEA_GAUSS_POINTS; g++) {
            const size_t p = e * DEA_GAUSS_POINTS + (size_t)g;
            f->radius[p] = from + length * dea_gauss_place(g);
            f->weight[p] = length * dea_gauss_weight(g);
            for (int n = 0; n <= FE_DEGREE; n++) {
                f->shape[g][n] = fe_polynomial(n, dea_gauss_place(g), &f->slope[p][n]);
                f->slope[p][n] /= length;
            }
        }
    }
}

static inline bool fe_electroded(const fe_film *f, size_t place)
{
    return (place / DEA_GAUSS_POINTS < f->disc_elements) == f->dot;
}

/* Gauss-Jordan on the mass matrix; centre and frame do not move. */
static inline void fe_invert_mass(fe_film *f)
{
    static double m[FE_NODES][FE_NODES];
    memset(m, 0, sizeof m);
    memset(f->inverse, 0, sizeof f->inverse);
    for (size_t p = 0; p < FE_PLACES; p++) {
        const double areal = f->density * f->thickness + (fe_electroded(f, p) ? f->electrode * f->prestretch * f->prestretch : 0.0);
        for (int i = 0; i <= FE_DEGREE; i++) {
            for (int j = 0; j <= FE_DEGREE; j++) {
                const size_t e = p / DEA_GAUSS_POINTS * FE_DEGREE, g = p % DEA_GAUSS_POINTS;
                m[e + (size_t)i][e + (size_t)j] +=
                    2.0 * fe_pi * f->radius[p] * f->weight[p] * areal * f->shape[g][i] * f->shape[g][j];
            }
        }
    }
    for (size_t i = 1; i < FE_NODES - 1; i++) {
        f->inverse[i][i] = 1.0;
    }
    for (size_t k = 1; k < FE_NODES - 1; k++) {
        const double pivot = m[k][k];
        for (size_t j = 1; j < FE_NODES - 1; j++) {
            m[k][j] /= pivot;
            f->inverse[k][j] /= pivot;
        }
        for (size_t i = 1; i < FE_NODES - 1; i++) {
            const double factor = i == k ? 0.0 : m[i][k];
            for (size_t j = 1; j < FE_NODES - 1 && factor != 0.0; j++) {
                m[i][j] -= factor * m[k][j];
                f->inverse[i][j] -= factor * f->inverse[k][j];
            }
        }
    }
}

/* Stretches at a place, and their rates with v. */
static inline void fe_stretches(const fe_film *f, size_t p, const double *u, double rest, double l[2])
{
    const size_t e = p / DEA_GAUSS_POINTS * FE_DEGREE, g = p % DEA_GAUSS_POINTS;
    l[0] = l[1] = rest;
    for (size_t n = 0; n <= FE_DEGREE; n++) {
        l[0] += f->slope[p][n] * u[e + n];
        l[1] += f->shape[g][n] * u[e + n] / f->radius[p];
    }
}

static inline void fe_cauchy(const fe_film *f, const double l[2], double s[2])
{
    const plain_film at = plain_film_at(f->yeoh, l[0], l[1]);
    s[0] = l[0] * at.w * at.a1;
    s[1] = l[1] * at.w * at.a2;
}

static inline double fe_capacitance(const fe_film *f, const double *u)
{
    double sum = 0.0;
    for (size_t p = 0; p < FE_PLACES; p++) {
        double l[2];
        fe_stretches(f, p, u, f->prestretch, l);
        sum += fe_electroded(f, p) ? f->weight[p] * f->radius[p] * l[0] * l[0] * l[1] * l[1] : 0.0;
    }
    return 2.0 * fe_pi * f->permittivity / f->thickness * sum;
}

static inline double fe_source(const fe_film *f, double time)
{
    return f->voltage * fmin(1.0, time / f->rise);
}

static inline double fe_voltage(const fe_film *f, double time, const fe_state *s)
{
    return f->series > 0.0 ? s->q / fe_capacitance(f, s->u) : fe_source(f, time);
}

/* Total Cauchy stresses of a place without the electrical part; the rates of its branches into @p dz. */
static inline void fe_stress(const fe_film *f, size_t p, const fe_state *s, const double l[2], double (*dz)[FE_BRANCHES],
                             double stress[2])
{
    double rate[2], ahead[2], behind[2];
    fe_cauchy(f, l, stress);
    fe_stretches(f, p, s->v, 0.0, rate);
    const double h = 1e-6 / (1e-3 + fabs(rate[0]) + fabs(rate[1]));
    const double on[2] = {l[0] + h * rate[0], l[1] + h * rate[1]}, back[2] = {l[0] - h * rate[0], l[1] - h * rate[1]};
    fe_cauchy(f, on, ahead);
    fe_cauchy(f, back, behind);
    for (int a = 0; a < 2; a++) {
        double total = stress[a] + f->retardation * (ahead[a] - behind[a]) / (2.0 * h);
        for (size_t i = 0; i < f->branches; i++) {
            total += f->share[i] * (stress[a] - s->z[p][a][i]);
            dz[a][i] = (stress[a] - s->z[p][a][i]) / f->tau[i];
        }
        stress[a] = total;
    }
}

/* Forces on all nodes; the rates of the branches into @p d. */
static inline void fe_forces(const fe_film *f, double time, const fe_state *s, double *force, fe_state *d)
{
    const double field = fe_voltage(f, time, s) / f->thickness;
    memset(force, 0, FE_NODES * sizeof *force);
    for (size_t p = 0; p < FE_PLACES; p++) {
        const size_t e = p / DEA_GAUSS_POINTS * FE_DEGREE, g = p % DEA_GAUSS_POINTS;
        const double own = f->potential ? f->potential[p] / f->thickness : field;
        const double k = fe_electroded(f, p) ? f->permittivity * own * own : 0.0;
        double l[2], stress[2];
        fe_stretches(f, p, s->u, f->prestretch, l);
        fe_stress(f, p, s, l, d->z[p], stress);
        const double s1 = stress[0] / l[0] - k * l[0] * l[1] * l[1], s2 = stress[1] / l[1] - k * l[1] * l[0] * l[0];
        const double unit = 2.0 * fe_pi * f->thickness * f->weight[p];
        for (size_t n = 0; n <= FE_DEGREE; n++) {
            force[e + n] -= unit * (f->radius[p] * f->slope[p][n] * s1 + f->shape[g][n] * s2);
        }
    }
}

static inline void fe_rates(const fe_film *f, double time, const fe_state *s, fe_state *d)
{
    double force[FE_NODES];
    const double voltage = fe_voltage(f, time, s);
    fe_forces(f, time, s, force, d);
    for (size_t i = 0; i < FE_NODES; i++) {
        d->u[i] = s->v[i];
        d->v[i] = 0.0;
        for (size_t j = 1; j < FE_NODES - 1; j++) {
            d->v[i] += f->inverse[i][j] * force[j];
        }
    }
    d->q = f->series > 0.0 ? (fe_source(f, time) - voltage) / f->series - voltage * f->leak : 0.0;
}

/* The film of a scene: a step at 0 with a rise, from rest. */
static inline void fe_open(const dea_scene *scene, fe_film *f)
{
    const dea_material *material = &scene->material;
    double rest = 1.0;
    *f = (fe_film){.prestretch = scene->actuator.prestretch,
                   .frame = scene->actuator.frame_radius,
                   .coverage = scene->actuator.coverage,
                   .thickness = scene->actuator.film_thickness,
                   .permittivity = 8.8541878128e-12 * material->permittivity,
                   .density = material->density,
                   .electrode = isnan(scene->actuator.electrode_mass) ? 0.0 : scene->actuator.electrode_mass,
                   .retardation = isnan(material->retardation) ? 0.0 : material->retardation,
                   .branches = material->prony_count,
                   .series = isnan(scene->drive.series_resistance) ? 0.0 : scene->drive.series_resistance,
                   .leak = isnan(scene->drive.leakage_resistance) ? 0.0 : 1.0 / scene->drive.leakage_resistance,
                   .dot = scene->actuator.kind == DEA_DOT,
                   .voltage = scene->drive.waveform.step.voltage,
                   .rise = scene->drive.waveform.step.rise};
    memcpy(f->yeoh, material->constants, sizeof f->yeoh);
    for (size_t i = 0; i < f->branches; i++) {
        rest -= material->prony[i].g;
    }
    for (size_t i = 0; i < f->branches; i++) {
        f->share[i] = material->prony[i].g / rest;
        f->tau[i] = material->prony[i].tau;
    }
    fe_mesh(f);
    fe_invert_mass(f);
}

static inline void fe_rest(const fe_film *f, fe_state *s)
{
    const double l[2] = {f->prestretch, f->prestretch};
    double stress[2];
    *s = (fe_state){0};
    fe_cauchy(f, l, stress);
    for (size_t p = 0; p < FE_PLACES; p++) {
        for (size_t i = 0; i < FE_BRANCHES; i++) {
            s->z[p][0][i] = s->z[p][1][i] = stress[0];
        }
    }
}

/* One step of the classical method. */
static inline void fe_step(const fe_film *f, double time, double h, fe_state *s)
{
    static const double at[] = {0.0, 0.5, 0.5, 1.0}, share[] = {1.0 / 6.0, 1.0 / 3.0, 1.0 / 3.0, 1.0 / 6.0};
    enum { SIZE = sizeof(fe_state) / sizeof(double) };
    static fe_state here, rate, sum;
    double *const y = (double *)s, *const x = (double *)&here, *const k = (double *)&rate, *const total = (double *)&sum;
    memset(&rate, 0, sizeof rate);
    memset(&sum, 0, sizeof sum);
    for (int i = 0; i < 4; i++) {
        for (size_t j = 0; j < SIZE; j++) {
            x[j] = y[j] + h * at[i] * k[j];
        }
        fe_rates(f, time + h * at[i], &here, &rate);
        for (size_t j = 0; j < SIZE; j++) {
            total[j] += share[i] * k[j];
        }
    }
    for (size_t j = 0; j < SIZE; j++) {
        y[j] += h * total[j];
    }
}

static inline size_t fe_edge(const fe_film *f)
{
    return f->disc_elements * FE_DEGREE;
}

/* ---- scenes and their judgement */

static inline dea_scene fe_step_scene(dea_kind kind, double prestretch, double coverage, double voltage, double rise)
{
    dea_scene scene = paper_scene(kind, prestretch, coverage, (double)NAN);
    scene.material.density = 1080.0;
    scene.study = DEA_STUDY_TRANSIENT;
    scene.drive.waveform = (dea_waveform){.kind = DEA_WAVE_STEP,
                                          .step = {.off = (double)NAN, .voltage = voltage, .rise = rise},
                                          .period = (double)NAN};
    scene.transient = (dea_transient){.until = 8e-3, .every = 2e-5};
    return scene;
}

/* A random film of moderate stiffness, which a step moves by some per cent. */
static inline dea_scene fe_random_step(uint64_t *seed)
{
    const dea_kind kind = random_chance(seed, 0.5) ? DEA_DOT : DEA_LENS;
    dea_scene scene = fe_step_scene(kind, random_between(seed, 1.05, 1.5), random_between(seed, 0.2, 0.8),
                                 random_between(seed, 1500.0, 4500.0), random_between(seed, 2e-4, 5e-4));
    scene.material.retardation = random_between(seed, 2e-5, 5e-5); /* the judge's elements see no sharper waves */
    scene.transient = (dea_transient){.until = 1.5e-3, .every = 5e-5};
    scene.accuracy = random_decades(seed, 1e-5, 1e-3);
    if (random_chance(seed, 0.5)) {
        scene.actuator.electrode_mass = random_between(seed, 0.0, 0.05);
    }
    scene.material.prony_count = random_chance(seed, 0.3) ? 0 : random_chance(seed, 0.5) ? 1 : 2;
    scene.material.prony[0] = (dea_prony){random_between(seed, 0.05, 0.2), random_decades(seed, 1e-4, 1e-1)};
    scene.material.prony[1] = (dea_prony){random_between(seed, 0.05, 0.2), random_decades(seed, 1e-3, 1.0)};
    if (random_chance(seed, 0.5)) {
        scene.drive.series_resistance = random_decades(seed, 1e5, 1e6);
        scene.drive.leakage_resistance = random_chance(seed, 0.5) ? random_decades(seed, 1e7, 1e9) : (double)NAN;
    }
    return scene;
}

/* Steps of the judge between two samples: as many as its fastest mode and its damper take. */
static inline int fe_judge_steps(const dea_scene *scene)
{
    const dea_film film = dea_law_film(scene->material.law, scene->material.constants, scene->actuator.prestretch);
    const double shortest = 0.02 * fmin(scene->actuator.coverage, 1.0 - scene->actuator.coverage) * scene->actuator.frame_radius;
    const double omega = 3.0 * scene->actuator.prestretch * sqrt(film.w11 / scene->material.density) / shortest;
    return 1 + (int)(scene->transient.every * fmax(omega, 2.0 * scene->material.retardation * omega * omega) / 2.0);
}

/* Largest differences of displacement, velocity, film voltage and charge over what the columns promise. */
static inline double fe_broken(const dea_scene *scene, const dea_sample *samples, size_t rows)
{
    static fe_film film;
    static fe_state s;
    const dea_scales scales = dea_scales_open(scene, dea_model_find("field"));
    const dea_sample size = dea_scales_of(&scales, samples, rows);
    const int steps = fe_judge_steps(scene);
    const double h = scene->transient.every / steps;
    double worst = 0.0;
    fe_open(scene, &film);
    fe_rest(&film, &s);
    for (size_t i = 0; i < rows && samples[i].state != DEA_STATE_PULL_IN; i++) {
        const dea_sample *row = &samples[i];
        const double voltage = fe_voltage(&film, row->time, &s);
        worst = fmax(worst, fabs(row->displacement - s.u[fe_edge(&film)]) / size.displacement);
        worst = fmax(worst, 0.1 * fabs(row->velocity - s.v[fe_edge(&film)]) / size.velocity);
        worst = fmax(worst, 0.1 * fabs(row->film_voltage - voltage) / size.film_voltage);
        if (!isnan(row->charge)) {
            worst = fmax(worst, 0.1 * fabs(row->charge - fe_capacitance(&film, s.u) * voltage) / size.charge);
        }
        for (int k = 0; k < steps; k++) {
            const double time = row->time + k * h; /* the rise ends within a step, which is cut there */
            const double cut = film.rise - time;
            const double first = cut > 0.0 && cut < h ? cut : h;
            fe_step(&film, time, first, &s);
            if (first < h) {
                fe_step(&film, film.rise, h - first, &s);
            }
        }
    }
    return worst / scene->accuracy;
}

/* Samples of a run and what stands behind them; the caller frees them. */
static inline dea_sample *fly(const dea_scene *scene, dea_layout *layout)
{
    const dea_engine *ida = dea_engine_find("ida");
    dea_error error = {0};
    void *session = NULL;
    *layout = dea_layout_of(scene);
    dea_sample *samples = calloc(1, layout->point_size);
    assert_non_null(samples);
    assert_null(dea_engine_refuses(ida, scene, scene->models[0]));
    assert_int_equal(ida->begin(&session, &error), DEA_OK);
    if (ida->transient(session, scene, scene->models[0], samples, dea_layout_summary(layout, samples), &error) != DEA_OK ||
        error.message[0]) {
        fail_msg("%s", error.message);
    }
    ida->end(session);
    return samples;
}

#endif
