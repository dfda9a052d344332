/* Answers found another way: the exact membrane by plain Runge-Kutta over the radius, Eq. 18 by a scan in long double. */
#ifndef DEA_TEST_JUDGES_H
#define DEA_TEST_JUDGES_H

#include "scenes.h"

/* Yeoh film as physics.md writes it, nothing factored: stresses and moduli at l1, l2. */
typedef struct plain_film {
    double w, a1, a2, q;
} plain_film;

static inline plain_film plain_film_at(const double *yeoh, double l1, double l2)
{
    const double j = l1 * l1 + l2 * l2 + 1.0 / (l1 * l1 * l2 * l2) - 3.0;
    return (plain_film){
        .w = yeoh[0] + 2.0 * yeoh[1] * j + 3.0 * yeoh[2] * j * j,
        .a1 = 2.0 * (l1 - pow(l1, -3.0) / (l2 * l2)),
        .a2 = 2.0 * (l2 - pow(l2, -3.0) / (l1 * l1)),
        .q = 2.0 * yeoh[1] + 6.0 * yeoh[2] * j,
    };
}

/* The boundary value problem: reference radii b to 1, Maxwell pressures in disc and annulus [Pa]. */
typedef struct judged_membrane {
    double yeoh[DEA_YEOH_TERMS];
    double prestretch, coverage, disc_k, annulus_k;
    double largest_area, least_stress; /* of the last integration: in the annulus */
} judged_membrane;

static inline double radial_stress(const judged_membrane *m, double k, double l1, double l2)
{
    const plain_film f = plain_film_at(m->yeoh, l1, l2);
    return f.w * f.a1 - k * l1 * l2 * l2;
}

/* dlambda1/dR and dlambda2/dR. */
static inline void membrane_slopes(const judged_membrane *m, double radius, const double l[2], double slope[2])
{
    const double k = m->annulus_k;
    const plain_film f = plain_film_at(m->yeoh, l[0], l[1]);
    const double s1 = f.w * f.a1 - k * l[0] * l[1] * l[1];
    const double s2 = f.w * f.a2 - k * l[1] * l[0] * l[0];
    const double s11 = f.w * (2.0 + 6.0 * pow(l[0], -4.0) / (l[1] * l[1])) + f.q * f.a1 * f.a1 - k * l[1] * l[1];
    const double s12 = 4.0 * f.w * pow(l[0] * l[1], -3.0) + f.q * f.a1 * f.a2 - 2.0 * k * l[0] * l[1];
    slope[0] = (s2 - s1 - s12 * (l[0] - l[1])) / (s11 * radius);
    slope[1] = (l[0] - l[1]) / radius;
}

static inline void membrane_step(const judged_membrane *m, double radius, double h, double l[2])
{
    static const double at[] = {0.0, 0.5, 0.5, 1.0};
    static const double share[] = {1.0 / 6.0, 1.0 / 3.0, 1.0 / 3.0, 1.0 / 6.0};
    double slope[2] = {0.0, 0.0};
    double sum[2] = {0.0, 0.0};
    for (int i = 0; i < 4; i++) {
        const double here[2] = {l[0] + h * at[i] * slope[0], l[1] + h * at[i] * slope[1]};
        membrane_slopes(m, radius + h * at[i], here, slope);
        sum[0] += share[i] * slope[0];
        sum[1] += share[i] * slope[1];
    }
    l[0] += h * sum[0];
    l[1] += h * sum[1];
}

/* lambda1 behind the edge where the disc has the stretch l, by bisection of the radial stress. */
static inline double membrane_jump(const judged_membrane *m, double l)
{
    const double wanted = radial_stress(m, m->disc_k, l, l);
    double low = 0.01 * l;
    double high = 20.0 * l;
    for (int i = 0; i < 200; i++) {
        const double middle = 0.5 * (low + high);
        *(radial_stress(m, m->annulus_k, middle, l) < wanted ? &low : &high) = middle;
    }
    return 0.5 * (low + high);
}

static inline double membrane_miss_on(judged_membrane *m, double edge, int steps)
{
    double l[2] = {membrane_jump(m, edge), edge};
    const double h = (1.0 - m->coverage) / steps;
    m->largest_area = 0.0;
    m->least_stress = (double)INFINITY;
    for (int i = 0; i <= steps; i++) {
        const double s2 = radial_stress(m, m->annulus_k, l[1], l[0]);
        m->largest_area = fmax(m->largest_area, l[0] * l[1]);
        m->least_stress = fmin(m->least_stress, fmin(radial_stress(m, m->annulus_k, l[0], l[1]), s2));
        if (i < steps) {
            membrane_step(m, m->coverage + i * h, h, l);
        }
    }
    return l[1] - m->prestretch;
}

/* lambda2 at the frame less the pre-stretch, extrapolated from two meshes. */
static inline double membrane_miss(judged_membrane *m, double edge)
{
    const double coarse = membrane_miss_on(m, edge, 1000);
    return membrane_miss_on(m, edge, 2000) + (membrane_miss_on(m, edge, 2000) - coarse) / 15.0;
}

/* Long-term constants, relative permittivity at the pre-stretch, and voltage across the film, as physics.md and the scene say. */
typedef struct judged_film {
    double yeoh[DEA_LAW_CONSTANTS], permittivity, voltage, coverage, share;
} judged_film;

static inline judged_film judged_film_of(const dea_scene *scene)
{
    const dea_material *material = &scene->material;
    const dea_drive *drive = &scene->drive;
    const bool leaks = !isnan(drive->series_resistance) && !isnan(drive->leakage_resistance);
    const double kept = leaks ? 1.0 / (1.0 + drive->series_resistance / drive->leakage_resistance) : 1.0;
    judged_film film = {.share = 1.0};
    for (size_t i = 0; i < material->prony_count && material->instantaneous; i++) {
        film.share -= material->prony[i].g;
    }
    for (int i = 0; i < DEA_LAW_CONSTANTS; i++) {
        film.yeoh[i] = film.share * material->constants[i];
    }
    film.permittivity =
        8.8541878128e-12 * (material->permittivity + material->permittivity_per_stretch * scene->actuator.prestretch);
    film.voltage = kept * drive->voltage;
    film.coverage =
        isnan(scene->actuator.coverage) ? scene->actuator.divide_radius / scene->actuator.frame_radius : scene->actuator.coverage;
    return film;
}

/* How far the displacement of a row is from holding the forces of lumped (Eqs. 19-21) or lame (physics.md, section 3), relative.
 */
static inline double judge_linear(const dea_scene *scene, const dea_row *row, bool lame)
{
    const judged_film film = judged_film_of(scene);
    const dea_actuator *a = &scene->actuator;
    const double pi = 3.14159265358979323846;
    const double l = a->prestretch;
    const double b2 = film.coverage * film.coverage;
    const double divide = film.coverage * a->frame_radius;
    const double m = film.permittivity * pow(film.voltage / a->film_thickness, 2.0);
    const double sign = a->kind == DEA_DOT ? 1.0 : -1.0;
    const dea_stress at = dea_law_stress(scene->material.law, film.yeoh, l, l);
    const double soft1 = m * l * l;
    const double disc = at.w11 + at.w12 - (a->kind == DEA_DOT ? 3.0 * soft1 : 0.0);
    const double q = (1.0 + b2) / (1.0 - b2);
    const double annulus = at.w11 * q - at.w12 - (a->kind == DEA_LENS ? soft1 * (q - 2.0) : 0.0);
    const double free = dea_law_modulus(scene->material.law, film.yeoh, l);
    const double modulus = isnan(scene->material.modulus) ? free : film.share * scene->material.modulus;
    const double section = 2.0 * pi * divide * a->film_thickness / (l * l);
    const double stiffness = lame ? 2.0 * pi * a->film_thickness * (disc + annulus)
                                  : modulus * section * (1.0 / divide + 1.0 / (a->frame_radius - divide));
    const double force = sign * m * pow(l, 4.0) * section;
    return fmax(fabs(row->displacement * stiffness / force - 1.0), fabs(row->force / force - 1.0));
}

static inline judged_membrane judged_membrane_of(const dea_scene *scene)
{
    const bool dot = scene->actuator.kind == DEA_DOT;
    const judged_film film = judged_film_of(scene);
    const double nominal = film.voltage / scene->actuator.film_thickness;
    const double k = film.permittivity * nominal * nominal;
    return (judged_membrane){.yeoh = {film.yeoh[0], film.yeoh[1], film.yeoh[2]},
                             .prestretch = scene->actuator.prestretch,
                             .coverage = film.coverage,
                             .disc_k = dot ? k : 0.0,
                             .annulus_k = dot ? 0.0 : k};
}

/* Strain, true field and state of the first equilibrium from rest, looked for in steps of 0.004 of stretch. */
static inline dea_row judge_membrane(const dea_scene *scene)
{
    const bool dot = scene->actuator.kind == DEA_DOT;
    const double l = scene->actuator.prestretch;
    judged_membrane m = judged_membrane_of(scene);
    const double sign = dot ? 1.0 : -1.0;
    double low = l;
    double high = l + sign * 0.004;
    while (sign * membrane_miss(&m, high) < 0.0 && high > 0.5 * l && high < 2.0 * l) {
        low = high;
        high += sign * 0.004;
    }
    for (int i = 0; i < 45; i++) {
        const double middle = 0.5 * (low + high);
        *(sign * membrane_miss(&m, middle) < 0.0 ? &low : &high) = middle;
    }
    const double edge = 0.5 * (low + high);
    (void)membrane_miss(&m, edge);
    const double nominal = judged_film_of(scene).voltage / scene->actuator.film_thickness;
    dea_row row = {.strain = edge / l - 1.0, .field = nominal * (dot ? edge * edge : m.largest_area)};
    row.state = fmin(radial_stress(&m, m.disc_k, edge, edge), m.least_stress) > 0.0 ? DEA_STATE_OK : DEA_STATE_SLACK;
    return row;
}

/* Eq. 18 in the strain e of the active film, in long double: sigma_A - sigma_P and the load m (1 + e)^4. Or the model `ring` in
 * the size e of the disc's strain. */
typedef struct judged_balance {
    double yeoh[DEA_YEOH_TERMS];
    long double prestretch, ratio, load;
    bool ring, dot;
    long double coverage;
} judged_balance;

static inline long double plain_cauchy(const double *yeoh, long double l)
{
    const long double y = l * l;
    const long double j = 2.0L * y + 1.0L / (y * y) - 3.0L;
    return 2.0L * (y - 1.0L / (y * y)) * (yeoh[0] + 2.0L * yeoh[1] * j + 3.0L * yeoh[2] * j * j);
}

static inline judged_balance judged_balance_of(const dea_scene *scene, bool constant_force)
{
    const judged_film film = judged_film_of(scene);
    const long double b = film.coverage;
    const long double nominal = (long double)film.voltage / scene->actuator.film_thickness;
    const long double y = (long double)scene->actuator.prestretch * scene->actuator.prestretch;
    const long double ratio = scene->actuator.kind == DEA_DOT ? b / (1.0L - b) : (1.0L - b) / b;
    return (judged_balance){{film.yeoh[0], film.yeoh[1], film.yeoh[2]},
                            scene->actuator.prestretch,
                            constant_force ? 0.0L : ratio,
                            film.permittivity * y * y * nominal * nominal,
                            false,
                            scene->actuator.kind == DEA_DOT,
                            b};
}

/* The same for the model `ring`: its strain ends where the annulus of a dot has no width, or the disc of a lens none. */
static inline judged_balance judged_ring_of(const dea_scene *scene)
{
    judged_balance balance = judged_balance_of(scene, false);
    balance.ring = true;
    balance.ratio = balance.dot ? balance.coverage / (1.0L - balance.coverage) : 1.0L;
    return balance;
}

/* Nominal stress along l1, nothing factored. */
static inline long double plain_nominal(const double *yeoh, long double l1, long double l2)
{
    const long double v = 1.0L / (l1 * l1 * l2 * l2);
    const long double j = l1 * l1 + l2 * l2 + v - 3.0L;
    return 2.0L * (l1 - v / l1) * (yeoh[0] + 2.0L * yeoh[1] * j + 3.0L * yeoh[2] * j * j);
}

/* 2 A P_disc - (F + A) P_radial + (F - A) P_hoop over 2 A, against the load eps (U/H)^2 lambda_pre^3 (1 + s) times the area
 * stretch, with radii in units of that of the frame. */
static inline long double judged_ring_share(const judged_balance *b, long double e)
{
    const long double edge = b->coverage * (b->dot ? 1.0L + e : 1.0L - e), l0 = b->prestretch, r = b->coverage;
    const long double disc = l0 * edge / r, radial = l0 * (1.0L - edge) / (1.0L - r), hoop = l0 * (1.0L + edge) / (1.0L + r);
    const long double held = plain_nominal(b->yeoh, disc, disc) - (1.0L + r) / (2.0L * r) * plain_nominal(b->yeoh, radial, hoop) +
                             (1.0L - r) / (2.0L * r) * plain_nominal(b->yeoh, hoop, radial);
    const long double area = (b->dot ? disc * disc : radial * hoop) / (l0 * l0);
    return (b->dot ? held : -held) / (b->load / l0 * edge / r * area);
}

/* Share of the load that holds the strain e: it grows from rest to the first fold. */
static inline long double judged_share(const judged_balance *b, long double e)
{
    if (b->ring) {
        return judged_ring_share(b, e);
    }
    const long double s = 1.0L + e;
    const long double active = plain_cauchy(b->yeoh, b->prestretch * s);
    return (active - plain_cauchy(b->yeoh, b->prestretch * (1.0L - b->ratio * e))) / (b->load * s * s * s * s);
}

/* What a scan of Eq. 18 in @p steps finds: strain of the first equilibrium from rest, NAN past the first fold, and whether the
 * film has an equilibrium behind a fold. */
typedef struct judgement {
    double strain;
    double fold; /* share of the load at the first fold, NAN: none */
    bool later;  /* a share of 1 is reached behind the fold */
} judgement;

static inline long double refine(const judged_balance *b, long double low, long double high)
{
    for (int i = 0; i < 80; i++) {
        const long double middle = 0.5L * (low + high);
        *(judged_share(b, middle) < 1.0L ? &low : &high) = middle;
    }
    return 0.5L * (low + high);
}

static inline judgement judge_balance(const judged_balance *b, int steps)
{
    const long double end = b->ratio > 0.1L ? 1.0L / b->ratio : 10.0L; /* where the passive film ends, or far out */
    judgement found = {(double)NAN, (double)NAN, false};
    long double before = 0.0L;
    for (int i = 1; i < steps; i++) {
        const long double e = end * i / steps;
        const long double share = judged_share(b, e);
        if (isnan(found.fold) && share >= 1.0L) {
            found.strain = (double)refine(b, end * (i - 1) / steps, e);
            return found;
        }
        if (isnan(found.fold) && share < before) {
            found.fold = (double)before;
        }
        found.later = found.later || share >= 1.0L;
        before = share;
    }
    return found;
}

/* Eqs. 19-23 of a film without electrodes' mass and skin behind a step at 0, m u'' = F(t) - K (u + tau u'), with Rayleigh's mass of
 * Lame's shape (physics: section 5) and the modulus Y. */
typedef struct lumped_state {
    double u, v;
} lumped_state;

static inline double lumped_acceleration(const dea_scene *scene, double y_modulus, double time, lumped_state at)
{
    const dea_actuator *actuator = &scene->actuator;
    const dea_step *step = &scene->drive.waveform.step;
    const double r = actuator->frame_radius, ra = actuator->coverage * r, pre = actuator->prestretch, pi = 3.14159265358979323846;
    const double a = ra / pre, f = r / pre, wide = f * f - a * a;
    const double ring = f * f * f * f * log(f / a) - f * f * wide + (f * f * f * f - a * a * a * a) / 4.0;
    const double mass = pi * scene->material.density * actuator->film_thickness * a * a * (0.5 + 2.0 * ring / (wide * wide));
    const double area = 2.0 * pi * ra * actuator->film_thickness / (pre * pre);
    const double stiffness = y_modulus * area * (1.0 / ra + 1.0 / (r - ra));
    const double field = step->voltage * fmin(1.0, time / step->rise) / actuator->film_thickness;
    const double sign = actuator->kind == DEA_LENS ? -1.0 : 1.0;
    const double force = sign * 8.8541878128e-12 * scene->material.permittivity * pow(pre, 4.0) * field * field * area;
    return (force - stiffness * (at.u + scene->material.retardation * at.v)) / mass;
}

/* From one time to another, by the classical Runge-Kutta method in ten steps. */
static inline lumped_state lumped_move(const dea_scene *scene, double y_modulus, double from, double to, lumped_state at)
{
    const double h = (to - from) / 10.0;
    for (int i = 0; i < 10; i++) {
        static const double places[] = {0.0, 0.5, 0.5, 1.0}, shares[] = {1.0 / 6.0, 1.0 / 3.0, 1.0 / 3.0, 1.0 / 6.0};
        lumped_state rate = {0.0, 0.0}, sum = {0.0, 0.0};
        for (int k = 0; k < 4; k++) {
            const lumped_state here = {at.u + places[k] * h * rate.u, at.v + places[k] * h * rate.v};
            rate.u = here.v;
            rate.v = lumped_acceleration(scene, y_modulus, from + (i + places[k]) * h, here);
            sum.u += shares[k] * rate.u;
            sum.v += shares[k] * rate.v;
        }
        at.u += h * sum.u;
        at.v += h * sum.v;
    }
    return at;
}

#endif
