/* The film of a scene in long double, straight from physics.md (sections 2 to 5): statics by root finding, and the functions of
 * the moving edge. Shares no code with the library but the scene that it reads. */
#ifndef DEA_HARD_FILM_H
#define DEA_HARD_FILM_H

#include <math.h>
#include <stdbool.h>
#include <string.h>

#include "deaspice/deaspice.h"

typedef enum hard_model { HARD_LUMPED, HARD_LAME, HARD_COVERAGE, HARD_FIELD } hard_model;

typedef struct hard_film {
    hard_model model;
    bool dot;
    long double c1, c2, c3;                                   /* long-term [Pa] */
    long double prestretch, coverage, frame, edge, thickness; /* edge: r_a [m] */
    long double permittivity;                                 /* [F/m] */
    long double modulus;                                      /* Y [Pa] */
    long double voltage;                                      /* across the film [V] */
    long double share;                                        /* long-term share of the moduli */
} hard_film;

/* An answer: a state, and the strain of the disc edge where that is a number. */
typedef struct hard_answer {
    dea_state state;
    long double strain;
} hard_answer;

static const long double hard_pi = 3.14159265358979323846264338327950288L;

/* ---- material, section 2 */

typedef struct hard_stress {
    long double w, a1, a2, q;
} hard_stress;

static inline hard_stress hard_yeoh(const hard_film *f, long double l1, long double l2)
{
    const long double t = 1.0L / (l1 * l1 * l2 * l2);
    const long double j = l1 * l1 + l2 * l2 + t - 3.0L;
    return (hard_stress){f->c1 + 2.0L * f->c2 * j + 3.0L * f->c3 * j * j, 2.0L * (l1 - t / l1), 2.0L * (l2 - t / l2),
                         2.0L * f->c2 + 6.0L * f->c3 * j};
}

static inline long double hard_cauchy(const hard_film *f, long double l)
{
    const long double p = (l - 1.0L) * (l + 1.0L), y = l * l;
    return 2.0L * p * (y * y + y + 1.0L) / (y * y) * hard_yeoh(f, l, l).w;
}

static inline long double hard_cauchy_slope(const hard_film *f, long double l)
{
    const long double h = 1e-4L * l;
    return (8.0L * (hard_cauchy(f, l + h) - hard_cauchy(f, l - h)) - hard_cauchy(f, l + 2.0L * h) +
            hard_cauchy(f, l - 2.0L * h)) /
           (12.0L * h);
}

static inline hard_film hard_film_of(const dea_scene *scene, const dea_model *model)
{
    const dea_material *m = &scene->material;
    const dea_actuator *a = &scene->actuator;
    static const char *const names[] = {"lumped", "lame", "coverage", "field"};
    hard_film f = {.dot = a->kind == DEA_DOT, .share = 1.0L, .prestretch = a->prestretch, .frame = a->frame_radius};
    for (int i = 0; i < 4; i++) {
        f.model = strcmp(model->name, names[i]) == 0 ? (hard_model)i : f.model;
    }
    for (size_t i = 0; i < m->prony_count && m->instantaneous; i++) {
        f.share -= m->prony[i].g;
    }
    f.c1 = f.share * m->constants[0];
    f.c2 = f.share * m->constants[1];
    f.c3 = f.share * m->constants[2];
    f.thickness = a->film_thickness;
    f.coverage = isnan(a->coverage) ? (long double)a->divide_radius / a->frame_radius : (long double)a->coverage;
    f.edge = f.coverage * f.frame;
    f.permittivity = 8.8541878128e-12L * (m->permittivity + m->permittivity_per_stretch * f.prestretch);
    f.modulus = isnan(m->modulus) ? hard_cauchy_slope(&f, f.prestretch) : f.share * m->modulus;
    f.voltage = scene->drive.voltage;
    return f;
}

/* M = eps (U/H)^2 */
static inline long double hard_maxwell(const hard_film *f)
{
    return f->permittivity * f->voltage * f->voltage / (f->thickness * f->thickness);
}

/* ---- statics, section 3 */

static inline hard_answer hard_lumped(const hard_film *f)
{
    const long double l = f->prestretch;
    const long double strain = (f->dot ? 1.0L : -1.0L) * (1.0L - f->coverage) * hard_maxwell(f) * l * l * l * l / f->modulus;
    const long double passive = f->dot ? l * (1.0L - f->coverage * (1.0L + strain)) / (1.0L - f->coverage) : l * (1.0L + strain);
    return (hard_answer){passive > 1.0L ? DEA_STATE_OK : DEA_STATE_SLACK, strain};
}

/* Both in-plane stresses where radial and hoop stretch change by d1 and d2. */
static inline long double hard_least(long double rest, long double a, long double b, long double d1, long double d2)
{
    return rest + fminl(a * d1 + b * d2, b * d1 + a * d2);
}

static inline hard_answer hard_lame(const hard_film *f)
{
    const long double l = f->prestretch, b2 = f->coverage * f->coverage, m = hard_maxwell(f);
    const hard_stress s = hard_yeoh(f, l, l);
    const long double t = 1.0L / (l * l * l * l * l * l);
    const long double w11 = s.w * (2.0L + 6.0L * t) + s.q * s.a1 * s.a1, w12 = 4.0L * s.w * t + s.q * s.a1 * s.a1;
    const long double k1 = m * l * l, k2 = 2.0L * m * l * l, rest = s.w * s.a1, pull = m * l * l * l;
    const long double ad = w11 - (f->dot ? k1 : 0.0L), bd = w12 - (f->dot ? k2 : 0.0L);
    const long double ao = w11 - (f->dot ? 0.0L : k1), bo = w12 - (f->dot ? 0.0L : k2);
    const long double q = (1.0L + b2) / (1.0L - b2), stiffness = ad + bd + ao * q - bo;
    if (!(stiffness > 0.0L)) {
        return (hard_answer){DEA_STATE_PULL_IN, (long double)NAN};
    }
    const long double d = (f->dot ? pull : -pull) / stiffness; /* change of the hoop stretch at the edge */
    const long double disc = hard_least(rest - (f->dot ? pull : 0.0L), ad, bd, d, d);
    const long double outer = rest - (f->dot ? 0.0L : pull);
    const long double annulus =
        fminl(hard_least(outer, ao, bo, -q * d, d), hard_least(outer, ao, bo, -2.0L * d * b2 / (1.0L - b2), 0.0L));
    return (hard_answer){fminl(disc, annulus) > 0.0L ? DEA_STATE_OK : DEA_STATE_SLACK, d / l};
}

/* Eq. 18 in the strain e of the electroded film: share of the load M lambda^4 that holds e. */
static inline long double hard_share(const hard_film *f, long double e)
{
    const long double b = f->coverage, l = f->prestretch, s = 1.0L + e;
    const long double ratio = f->dot ? b / (1.0L - b) : (1.0L - b) / b;
    const long double held = hard_cauchy(f, l * s) - hard_cauchy(f, l * (1.0L - ratio * e));
    return held / (hard_maxwell(f) * l * l * l * l * s * s * s * s);
}

/* Largest of a function that rises, then falls, between low and high. */
typedef long double (*hard_curve)(const hard_film *f, long double x);

static inline long double hard_peak(hard_curve curve, const hard_film *f, long double low, long double high)
{
    const long double golden = 0.618033988749894848204586834365638118L;
    long double a = high - golden * (high - low), b = low + golden * (high - low);
    long double ya = curve(f, a), yb = curve(f, b);
    for (int i = 0; i < 48; i++) {
        if (ya > yb) {
            high = b, b = a, yb = ya;
            a = high - golden * (high - low), ya = curve(f, a);
        } else {
            low = a, a = b, ya = yb;
            b = low + golden * (high - low), yb = curve(f, b);
        }
    }
    return 0.5L * (low + high);
}

/* First x where a curve that starts below @p level reaches it before its first peak; NAN where it does not. @p end is not a
 * place. */
static inline long double hard_reach(hard_curve curve, const hard_film *f, long double level, long double end, int steps,
                                     int halvings)
{
    const long double step = end / steps;
    long double before = -INFINITY, low = 0.0L, high = (long double)NAN;
    for (int i = 1; i < steps; i++) {
        const long double here = curve(f, step * i);
        if (here >= level) {
            high = step * i;
            break;
        }
        if (here < before) {
            const long double top = hard_peak(curve, f, step * (i > 2 ? i - 2 : 0), step * i);
            high = curve(f, top) >= level ? top : (long double)NAN;
            break;
        }
        before = here;
        low = step * (i - 1);
    }
    for (int i = 0; i < halvings && !isnan(high); i++) {
        const long double middle = 0.5L * (low + high);
        *(curve(f, middle) < level ? &low : &high) = middle;
    }
    return 0.5L * (low + high);
}

static inline hard_answer hard_balance(const hard_film *f)
{
    const long double b = f->coverage, ratio = f->dot ? b / (1.0L - b) : (1.0L - b) / b;
    const long double e = hard_reach(hard_share, f, 1.0L, fminl(1.0L / ratio, 10.0L), 4000, 70);
    if (isnan(e)) {
        return (hard_answer){DEA_STATE_PULL_IN, e};
    }
    const bool taut = f->prestretch * (1.0L - ratio * e) > 1.0L;
    return (hard_answer){taut ? DEA_STATE_OK : DEA_STATE_SLACK, f->dot ? e : -ratio * e};
}

/* The exact membrane: both stretches over x = ln R from the edge out, by Runge-Kutta, from the radial stress of the disc. */
typedef struct hard_rim {
    long double stretch; /* lambda_2 at the frame */
    long double least;   /* smallest stress on the way */
} hard_rim;

static inline void hard_membrane_slope(const hard_film *f, long double k, const long double l[2], long double slope[2],
                                       long double *least)
{
    const hard_stress s = hard_yeoh(f, l[0], l[1]);
    const long double i0 = 1.0L / l[0], i1 = 1.0L / l[1], t = i0 * i0 * i1 * i1;
    const long double s1 = s.w * s.a1 - k * l[0] * l[1] * l[1], s2 = s.w * s.a2 - k * l[1] * l[0] * l[0];
    const long double s11 = s.w * (2.0L + 6.0L * t * i0 * i0) + s.q * s.a1 * s.a1 - k * l[1] * l[1];
    const long double s12 = 4.0L * s.w * t * i0 * i1 + s.q * s.a1 * s.a2 - 2.0L * k * l[0] * l[1];
    slope[0] = (s2 - s1 - s12 * (l[0] - l[1])) / s11;
    slope[1] = l[0] - l[1];
    *least = fminl(*least, fminl(s1, s2));
}

static inline hard_rim hard_membrane_run(const hard_film *f, long double k, long double radial, long double hoop, int steps)
{
    const long double h = -logl(f->coverage) / steps;
    long double l[2] = {radial, hoop}, none;
    hard_rim rim = {.least = INFINITY};
    for (int i = 0; i <= steps; i++) {
        long double a[2], b[2], c[2], d[2];
        hard_membrane_slope(f, k, l, a, &rim.least);
        if (i == steps) {
            break;
        }
        hard_membrane_slope(f, k, (long double[2]){l[0] + 0.5L * h * a[0], l[1] + 0.5L * h * a[1]}, b, &none);
        hard_membrane_slope(f, k, (long double[2]){l[0] + 0.5L * h * b[0], l[1] + 0.5L * h * b[1]}, c, &none);
        hard_membrane_slope(f, k, (long double[2]){l[0] + h * c[0], l[1] + h * c[1]}, d, &none);
        for (int n = 0; n < 2; n++) {
            l[n] += h * (a[n] + 2.0L * b[n] + 2.0L * c[n] + d[n]) / 6.0L;
        }
    }
    rim.stretch = l[1];
    return rim;
}

/* With the edge at hoop stretch l: extrapolated from two meshes. */
static inline hard_rim hard_membrane(const hard_film *f, long double l)
{
    const long double m = hard_maxwell(f), disc = f->dot ? m : 0.0L, annulus = f->dot ? 0.0L : m;
    const hard_stress s = hard_yeoh(f, l, l);
    const long double wanted = s.w * s.a1 - disc * l * l * l;
    long double low = 0.02L * l, high = 20.0L * l;
    for (int i = 0; i < 90; i++) {
        const long double middle = 0.5L * (low + high);
        const hard_stress at = hard_yeoh(f, middle, l);
        *(at.w * at.a1 - annulus * middle * l * l < wanted ? &low : &high) = middle;
    }
    const int steps = (int)fmaxl(100.0L, fminl(600.0L, -120.0L * logl(f->coverage)));
    const hard_rim coarse = hard_membrane_run(f, annulus, 0.5L * (low + high), l, steps);
    hard_rim fine = hard_membrane_run(f, annulus, 0.5L * (low + high), l, 2 * steps);
    fine.stretch += (fine.stretch - coarse.stretch) / 15.0L;
    fine.least = fminl(fine.least, wanted);
    return fine;
}

/* Along the strain of the disc (its size, of a lens), scaled so that the answer is near 1: lambda_2 at the frame rises with it.
 */
static inline long double hard_miss(const hard_film *f, long double e)
{
    const long double sign = f->dot ? 1.0L : -1.0L;
    return sign * (hard_membrane(f, f->prestretch * (1.0L + sign * e)).stretch / f->prestretch - 1.0L);
}

static inline hard_answer hard_field(const hard_film *f)
{
    hard_film linear = *f;
    const hard_answer guess = hard_lame(&linear);
    const long double near = guess.state == DEA_STATE_PULL_IN ? 0.3L : fabsl(guess.strain);
    const long double e = hard_reach(hard_miss, f, 0.0L, fminl(f->dot ? 8.0L * near : fminl(8.0L * near, 0.9L), 4.0L), 120, 56);
    if (isnan(e)) {
        return (hard_answer){DEA_STATE_PULL_IN, e};
    }
    const long double strain = f->dot ? e : -e;
    const hard_rim rim = hard_membrane(f, f->prestretch * (1.0L + strain));
    return (hard_answer){rim.least > 0.0L ? DEA_STATE_OK : DEA_STATE_SLACK, strain};
}

/* The static answer of a film: `failed` where there can be none, rest without voltage. Linear springs stretch for ever; where
 * others let the edge leave the frame, there is no equilibrium. */
static inline hard_answer hard_statics(const hard_film *f)
{
    static hard_answer (*const solve[])(const hard_film *) = {hard_lumped, hard_lame, hard_balance, hard_field};
    if (!(f->coverage < 1.0L)) {
        return (hard_answer){DEA_STATE_FAILED, (long double)NAN};
    }
    if (f->voltage == 0.0L) {
        return (hard_answer){f->prestretch > 1.0L ? DEA_STATE_OK : DEA_STATE_SLACK, 0.0L};
    }
    const hard_answer answer = solve[f->model](f);
    const bool inside = answer.strain > -1.0L && f->coverage * (1.0L + answer.strain) < 1.0L;
    const bool linear = solve[f->model] == hard_lumped || solve[f->model] == hard_lame;
    return inside || linear ? answer : (hard_answer){DEA_STATE_PULL_IN, (long double)NAN};
}

/* ---- the moving edge, section 5: m u'' + A(u) [S + tau S' u' + sum c_i (S - z_i)] = phi(u) U^2, and the capacitance C(u) */

typedef struct hard_edge {
    long double area, stress, push, capacitance;
} hard_edge;

static inline hard_edge hard_linear_edge(const hard_film *f, long double u)
{
    const long double l = f->prestretch, b2 = f->coverage * f->coverage, h = f->thickness, sign = f->dot ? 1.0L : -1.0L;
    const long double section = 2.0L * hard_pi * f->edge * h / (l * l);
    const long double force = sign * f->permittivity * l * l * l * l / (h * h) * section; /* F_DEA/U^2 */
    const long double plate = f->permittivity * hard_pi * l * l / h;
    const long double rest = plate * f->edge * f->edge * (f->dot ? 1.0L : (1.0L - b2) / b2);
    if (f->model == HARD_LUMPED) {
        const long double stiffness = f->modulus * section * (1.0L / f->edge + 1.0L / (f->frame - f->edge));
        return (hard_edge){1.0L, stiffness * u, force, rest + 2.0L * force * u};
    }
    const hard_stress s = hard_yeoh(f, l, l);
    const long double t = 1.0L / (l * l * l * l * l * l);
    const long double w11 = s.w * (2.0L + 6.0L * t) + s.q * s.a1 * s.a1, w12 = 4.0L * s.w * t + s.q * s.a1 * s.a1;
    const long double stiffness = 2.0L * hard_pi * h * (w11 + w12 + w11 * (1.0L + b2) / (1.0L - b2) - w12);
    const long double second = plate * (f->dot ? 12.0L : -4.0L * (1.0L - 3.0L * b2) / (1.0L - b2)); /* C_2 */
    return (hard_edge){1.0L, stiffness * u, force + 0.5L * second * u, rest + 2.0L * force * u + 0.5L * second * u * u};
}

static inline hard_edge hard_edge_at(const hard_film *f, long double u)
{
    if (f->model != HARD_COVERAGE) {
        return hard_linear_edge(f, u);
    }
    const long double l = f->prestretch, b = f->coverage, h = f->thickness, s = 1.0L + u / f->edge;
    const long double other = (1.0L - b * s) / (1.0L - b);
    const long double difference = hard_cauchy(f, l * s) - hard_cauchy(f, l * other);
    const long double active = l * (f->dot ? s : other), sign = f->dot ? 1.0L : -1.0L;
    hard_edge e = {.area = 2.0L * hard_pi * f->edge * h / (l * l * s), .stress = difference};
    e.push = sign * e.area * f->permittivity * active * active * active * active / (h * h);
    const long double plate = f->permittivity * hard_pi * l * l / h;
    if (f->dot) {
        e.capacitance = plate * f->edge * f->edge * s * s * s * s;
    } else { /* C_0 + int 2 phi du, with (1 - b s)^4/s integrated term by term */
        const long double x = b * s;
        const long double at = logl(s) - 4.0L * x + 3.0L * x * x - 4.0L / 3.0L * x * x * x + 0.25L * x * x * x * x;
        const long double rest = -4.0L * b + 3.0L * b * b - 4.0L / 3.0L * b * b * b + 0.25L * b * b * b * b;
        const long double c = 1.0L - b;
        e.capacitance =
            plate * (f->frame * f->frame - f->edge * f->edge) - 4.0L * plate * f->edge * f->edge * (at - rest) / (c * c * c * c);
    }
    return e;
}

/* Slopes over u, by differences of fourth order. */
static inline hard_edge hard_edge_slope(const hard_film *f, long double u)
{
    const long double h = 1e-4L * fminl(f->edge, f->frame - f->edge);
    const hard_edge a = hard_edge_at(f, u - 2.0L * h), b = hard_edge_at(f, u - h), c = hard_edge_at(f, u + h),
                    d = hard_edge_at(f, u + 2.0L * h);
#define HARD_SLOPE(x) ((8.0L * (c.x - b.x) - d.x + a.x) / (12.0L * h))
    return (hard_edge){HARD_SLOPE(area), HARD_SLOPE(stress), HARD_SLOPE(push), HARD_SLOPE(capacitance)};
#undef HARD_SLOPE
}

/* Rayleigh's mass with Lame's shape. */
static inline long double hard_mass(const dea_scene *scene, const hard_film *f)
{
    if (isnan(scene->material.density)) {
        return 0.0L;
    }
    const long double a = f->edge / f->prestretch, r = f->frame / f->prestretch;
    const long double a2 = a * a, r2 = r * r, gap = r2 - a2;
    const long double annulus = r2 * r2 * logl(r / a) - r2 * gap + 0.25L * (r2 * r2 - a2 * a2);
    return hard_pi * (long double)scene->material.density * f->thickness * a2 * (0.5L + 2.0L * annulus / (gap * gap));
}

#endif
