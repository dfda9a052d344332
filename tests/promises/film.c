/* The film straight from physics.md, sections 2, 3 and 5, in long double. */
#include "promises.h"

#include <math.h>
#include <string.h>

static const long double pi = 3.14159265358979323846264338327950288L;

static jet plain(long double value)
{
    return (jet){value, 0.0L, 0.0L};
}

static jet times(long double factor, jet a)
{
    return (jet){factor * a.value, factor * a.slope, factor * a.curve};
}

static jet plus(jet a, jet b)
{
    return (jet){a.value + b.value, a.slope + b.slope, a.curve + b.curve};
}

static jet by(jet a, jet b)
{
    return (jet){a.value * b.value, a.slope * b.value + a.value * b.slope,
                 a.curve * b.value + 2.0L * a.slope * b.slope + a.value * b.curve};
}

static jet inverse(jet a)
{
    const long double v = 1.0L / a.value;
    return (jet){v, -a.slope * v * v, 2.0L * a.slope * a.slope * v * v * v - a.curve * v * v};
}

/* sigma = 2 (l^2 - l^-4) w, as a function of whatever the stretch depends on. */
static jet cauchy(const true_film *f, jet l)
{
    const jet square = by(l, l);
    const jet fourth = inverse(by(square, square));
    const jet j = plus(plain(-3.0L), plus(times(2.0L, square), fourth));
    const jet w = plus(plain(f->yeoh[0]), plus(times(2.0L * f->yeoh[1], j), times(3.0L * f->yeoh[2], by(j, j))));
    return times(2.0L, by(plus(square, times(-1.0L, fourth)), w));
}

jet film_cauchy(const true_film *film, long double stretch)
{
    return cauchy(film, (jet){stretch, 1.0L, 0.0L});
}

/* sigma(l (1 + e)) - sigma(l), factored in d = y - l^2 with y = l^2 (1 + e)^2, so that a strain of any size keeps its digits. */
long double film_cauchy_change(const true_film *f, long double e)
{
    const long double rest = f->prestretch * f->prestretch, d = rest * e * (2.0L + e), y = rest + d;
    const long double fall = (y + rest) / (y * y * rest * rest); /* (rest^-2 - y^-2)/d */
    const long double dg = d * (1.0L + fall), dj = d * (2.0L - fall), j = 2.0L * rest + 1.0L / (rest * rest) - 3.0L;
    const long double w = f->yeoh[0] + 2.0L * f->yeoh[1] * (j + dj) + 3.0L * f->yeoh[2] * (j + dj) * (j + dj);
    const long double dw = dj * (2.0L * f->yeoh[1] + 3.0L * f->yeoh[2] * (2.0L * j + dj));
    return 2.0L * (dg * w + (rest - 1.0L / (rest * rest)) * dw);
}

static void set_material(const dea_scene *scene, true_film *f)
{
    const dea_material *m = &scene->material;
    long double rest = 1.0L;
    for (size_t i = 0; i < m->prony_count; i++) {
        rest -= (long double)m->prony[i].g;
    }
    for (size_t i = 0; i < m->prony_count; i++) {
        f->share[i] = m->prony[i].g / rest;
        f->tau[i] = m->prony[i].tau;
        f->total_share += f->share[i];
    }
    const long double given = m->instantaneous ? rest : 1.0L;
    f->branches = m->prony_count;
    for (int i = 0; i < DEA_YEOH_TERMS; i++) {
        f->yeoh[i] = given * m->constants[i];
    }
    f->permittivity = 8.8541878128e-12 * (m->permittivity + (long double)m->permittivity_per_stretch * f->prestretch);
    f->modulus = isnan(m->modulus) ? film_cauchy(f, f->prestretch).slope : given * m->modulus;
    f->breakdown = isnan(m->breakdown) ? (long double)INFINITY : (long double)m->breakdown;
    f->retardation = isnan(m->retardation) ? 0.0L : (long double)m->retardation;
}

/* Section 5: film over the reference radii, electrode over the deformed ones, both with Lame's shape. */
static long double shape_annulus(long double a, long double f)
{
    const long double x = (f - a) * (f + a), y = x / (f * f);
    long double sum = 0.0L, power = y * y * y; /* ln(f/a) - y + (1 - (a/f)^4)/4 = sum y^k/(2 k) from 3 on */
    if (y < 0.3L) {
        for (int k = 3; k < 60; k++) {
            sum += power / (2.0L * k);
            power *= y;
        }
    } else {
        const long double b2 = a * a / (f * f);
        sum = logl(f / a) - y + 0.25L * (1.0L - b2 * b2);
    }
    return 2.0L * pi * a * a * (f * f * f * f) * sum / (x * x);
}

static long double moving_mass(const dea_scene *scene, const true_film *f)
{
    if (isnan(scene->material.density)) {
        return 0.0L;
    }
    const long double a = f->divide / f->prestretch, out = f->frame / f->prestretch;
    const long double film = 0.5L * pi * a * a + shape_annulus(a, out);
    const long double electrode = f->dot ? 0.5L * pi * f->divide * f->divide : shape_annulus(f->divide, f->frame);
    const long double areal = isnan(scene->actuator.electrode_mass) ? 0.0L : (long double)scene->actuator.electrode_mass;
    return scene->material.density * f->thickness * film + areal * electrode;
}

true_film film_of(const dea_scene *scene, const dea_model *model)
{
    const dea_actuator *a = &scene->actuator;
    const dea_drive *d = &scene->drive;
    true_film f = {.model = model->name,
                   .dot = a->kind == DEA_DOT,
                   .prestretch = a->prestretch,
                   .frame = a->frame_radius,
                   .thickness = a->film_thickness,
                   .series = isnan(d->series_resistance) ? 0.0L : (long double)d->series_resistance,
                   .conductance = isnan(d->leakage_resistance) ? 0.0L : 1.0L / d->leakage_resistance,
                   .focal_length = a->focal_length,
                   .index = a->refractive_index};
    f.divide = isnan(a->coverage) ? (long double)a->divide_radius : (long double)a->coverage * f.frame;
    f.coverage = isnan(a->coverage) ? f.divide / f.frame : (long double)a->coverage;
    f.kept = 1.0L / (1.0L + f.series * f.conductance);
    set_material(scene, &f);
    f.mass = moving_mass(scene, &f);
    return f;
}

/* int_0^s (1 - p y)^4/(1 + y) dy with p = B/(1 - B): a series where the closed form would cancel so
 * far that both differ by what Newton's method sees. */
static long double lens_charge(long double p, long double s)
{
    static const long double binomial[] = {1.0L, 4.0L, 6.0L, 4.0L, 1.0L};
    long double sum = 0.0L, front = 1.0L;
    if (fabsl(s) > 0.5L) {
        /* (1 - p y)^4 = (1 + y) P(y) + (1 + p)^4 */
        const long double c3 = p * p * p * p, c2 = -4.0L * p * p * p - c3, c1 = 6.0L * p * p - c2, c0 = -4.0L * p - c1;
        const long double q = (1.0L + p) * (1.0L + p);
        return s * (c0 + s * (c1 / 2.0L + s * (c2 / 3.0L + s * c3 / 4.0L))) + q * q * log1pl(s);
    }
    for (int k = 0; k <= 4; k++) {
        long double power = front * binomial[k] * s;
        for (int n = 0; n < 70; n++) {
            sum += power / (k + n + 1);
            power *= -s;
        }
        front *= -p * s;
    }
    return sum;
}

/* Moduli of section 2 at equal stretches. */
typedef struct moduli {
    long double w11, w12, tension;
} moduli;

static moduli moduli_of(const true_film *f)
{
    const long double l = f->prestretch, l2 = l * l, sixth = 1.0L / (l2 * l2 * l2);
    const long double j = 2.0L * l2 + 1.0L / (l2 * l2) - 3.0L;
    const long double w = f->yeoh[0] + 2.0L * f->yeoh[1] * j + 3.0L * f->yeoh[2] * j * j;
    const long double q = 2.0L * f->yeoh[1] + 6.0L * f->yeoh[2] * j, a = 2.0L * (l - l * sixth);
    return (moduli){w * (2.0L + 6.0L * sixth) + q * a * a, 4.0L * w * sixth + q * a * a, w * a};
}

static true_edge edge_linear(const true_film *f, long double u, bool lame)
{
    const long double l2 = f->prestretch * f->prestretch, b2 = f->coverage * f->coverage, sign = f->dot ? 1.0L : -1.0L;
    const long double section = 2.0L * pi * f->divide * f->thickness / l2;
    const long double unit = 2.0L * pi * f->permittivity / f->thickness * l2; /* 2 pi H M lambda^2/U^2 */
    const long double q = (1.0L + b2) / ((1.0L - f->coverage) * (1.0L + f->coverage));
    const moduli m = moduli_of(f);
    const long double stiffness = lame ? 2.0L * pi * f->thickness * (m.w11 + m.w12 + m.w11 * q - m.w12)
                                       : f->modulus * section * (1.0L / f->divide + 1.0L / (f->frame - f->divide));
    const long double force = sign * unit * f->divide; /* Eq. 21 over the circumference, per U^2 */
    const long double soft = lame ? unit * (f->dot ? 3.0L : q - 2.0L) : 0.0L;
    const long double area = pi * (f->dot ? f->divide * f->divide : (f->frame - f->divide) * (f->frame + f->divide));
    return (true_edge){.count = 1,
                       .area = {plain(1.0L)},
                       .stress = {{stiffness * u, stiffness, 0.0L}},
                       .push = {force + soft * u, soft, 0.0L},
                       .capacitance = f->permittivity * l2 / f->thickness * area + u * (2.0L * force + soft * u)};
}

static true_edge edge_hyperelastic(const true_film *f, long double u)
{
    const long double l = f->prestretch, b = f->coverage, p = f->divide / (f->frame - f->divide);
    const jet s = {u / f->divide, 1.0L / f->divide, 0.0L}, one = plain(1.0L);
    const jet disc = plus(one, s), annulus = plus(one, times(-p, s));
    const jet inner = cauchy(f, times(l, disc)), outer = cauchy(f, times(l, annulus));
    const long double section = 2.0L * pi * f->divide * f->thickness / (l * l);
    const long double unit = f->permittivity * l * l * l * l / (f->thickness * f->thickness);
    const jet area = times(section, inverse(disc)), active = f->dot ? disc : annulus, square = by(active, active);
    true_edge e = {.count = 1, .area = {area}, .stress = {plus(inner, times(-1.0L, outer))}};
    e.stress[0].value = film_cauchy_change(f, s.value) - film_cauchy_change(f, -p * s.value);
    e.push = times(f->dot ? unit : -unit, by(area, by(square, square)));
    const long double rest = f->permittivity * l * l / f->thickness * pi;
    if (f->dot) {
        e.capacitance = rest * f->divide * f->divide * square.value * square.value;
    } else {
        e.capacitance =
            rest * (1.0L - b) * (1.0L + b) * f->frame * f->frame - 4.0L * rest * f->divide * f->divide * lens_charge(p, s.value);
    }
    return e;
}

/* sigma_1 = 2 w (y1 - v) at two stretches, J = y1 + y2 + v - 3, y = l^2, v = 1/(y1 y2). */
static jet principal(const true_film *f, jet l1, jet l2)
{
    const jet y1 = by(l1, l1), y2 = by(l2, l2), v = inverse(by(y1, y2));
    const jet j = plus(plain(-3.0L), plus(plus(y1, y2), v));
    const jet w = plus(plain(f->yeoh[0]), plus(times(2.0L * f->yeoh[1], j), times(3.0L * f->yeoh[2], by(j, j))));
    return times(2.0L, by(plus(y1, times(-1.0L, v)), w));
}

/* Its change from rest by relative changes of the stretches, factored as film_cauchy_change(). */
static long double principal_change(const true_film *f, long double e1, long double e2)
{
    const long double rest = f->prestretch * f->prestretch, d1 = rest * e1 * (2.0L + e1), d2 = rest * e2 * (2.0L + e2);
    const long double sum = rest * (d1 + d2) + d1 * d2; /* of y1 y2 */
    const long double dv = -sum / ((rest + d1) * (rest + d2) * rest * rest), dj = d1 + d2 + dv;
    const long double j = 2.0L * rest + 1.0L / (rest * rest) - 3.0L;
    const long double w = f->yeoh[0] + 2.0L * f->yeoh[1] * (j + dj) + 3.0L * f->yeoh[2] * (j + dj) * (j + dj);
    const long double dw = dj * (2.0L * f->yeoh[1] + 3.0L * f->yeoh[2] * (2.0L * j + dj));
    return 2.0L * ((d1 - dv) * w + (rest - 1.0L / (rest * rest)) * dw);
}

/* Section 7: relative changes of the stretches of disc, and radial and hoop of the annulus. */
typedef struct ring_strains {
    jet disc, radial, hoop;
} ring_strains;

static ring_strains rings_at(const true_film *f, long double u)
{
    const long double width = f->frame - f->divide, sum = f->frame + f->divide;
    return (ring_strains){
        {u / f->divide, 1.0L / f->divide, 0.0L}, {-u / width, -1.0L / width, 0.0L}, {u / sum, 1.0L / sum, 0.0L}};
}

/* Area stretch of the electroded film over that at rest. */
static jet ring_area(const true_film *f, const ring_strains *at)
{
    const jet one = plain(1.0L), disc = plus(one, at->disc);
    return f->dot ? by(disc, disc) : by(plus(one, at->radial), plus(one, at->hoop));
}

static true_edge edge_ring(const true_film *f, long double u)
{
    const long double l = f->prestretch, section = pi * f->thickness / (l * l), rest = film_cauchy(f, l).value;
    const jet one = plain(1.0L), lever = {-u, -1.0L, 0.0L};
    const ring_strains at = rings_at(f, u);
    const jet disc = plus(one, at.disc), radial = plus(one, at.radial), hoop = plus(one, at.hoop);
    const jet l0 = times(l, disc), l1 = times(l, radial), l2 = times(l, hoop);
    const long double outer = f->frame + f->divide, inner = f->frame - f->divide;
    true_edge e = {.count = 3,
                   .area = {times(2.0L * section * f->divide, inverse(disc)), times(section * outer, inverse(radial)),
                            times(section * inner, inverse(hoop))},
                   .stress = {principal(f, l0, l0), times(-1.0L, principal(f, l1, l2)), principal(f, l2, l1)}};
    e.stress[0].value = principal_change(f, at.disc.value, at.disc.value);
    e.stress[1].value = -principal_change(f, at.radial.value, at.hoop.value);
    e.stress[2].value = principal_change(f, at.hoop.value, at.radial.value);
    /* 2 r_a/(1 + e) - (r + r_a)/(1 + e1) + (r - r_a)/(1 + e2), which is 0 at rest, over -u */
    const jet fall =
        plus(times(2.0L, inverse(disc)), plus(times(outer / inner, inverse(radial)), times(inner / outer, inverse(hoop))));
    e.tension = times(section * rest, by(lever, fall));
    const jet area = ring_area(f, &at);
    const long double unit = 2.0L * pi * f->divide * f->permittivity * l * l / f->thickness;
    e.push = times(f->dot ? unit : -unit, by(disc, area));
    const long double electrode = pi * (f->dot ? f->divide * f->divide : outer * inner);
    e.capacitance = f->permittivity * l * l / f->thickness * electrode * area.value * area.value;
    return e;
}

long double edge_viscous(const true_edge *e)
{
    long double sum = 0.0L;
    for (int a = 0; a < e->count; a++) {
        sum += e->area[a].value * e->stress[a].slope;
    }
    return sum;
}

jet edge_relaxed(const true_edge *e)
{
    jet sum = e->tension;
    for (int a = 0; a < e->count; a++) {
        sum = plus(sum, by(e->area[a], e->stress[a]));
    }
    return sum;
}

true_edge film_edge(const true_film *f, long double u)
{
    if (strcmp(f->model, "ring") == 0) {
        return edge_ring(f, u);
    }
    if (strcmp(f->model, "coverage") == 0) {
        return edge_hyperelastic(f, u);
    }
    return edge_linear(f, u, strcmp(f->model, "lame") == 0);
}

static long double least(long double a, long double b)
{
    return a < b ? a : b;
}

/* Smallest in-plane stress of lame's disc and annulus. */
static long double lame_tension(const true_film *f, long double strain, long double m)
{
    const moduli at = moduli_of(f);
    const long double l = f->prestretch, soft = m * l * l, b2 = f->coverage * f->coverage;
    const long double d = f->dot ? soft : 0.0L, o = f->dot ? 0.0L : soft, c = l * strain;
    const long double a1 = at.w11 - d, a2 = at.w12 - 2.0L * d, o1 = at.w11 - o, o2 = at.w12 - 2.0L * o;
    const long double in = -c * (1.0L + b2) / (1.0L - b2), rim = -2.0L * c * b2 / (1.0L - b2);
    long double t = at.tension - d * l + (a1 + a2) * c;
    const long double rest = at.tension - o * l;
    t = least(t, rest + least(o1 * in + o2 * c, o2 * in + o1 * c));
    return least(t, rest + least(o1 * rim, o2 * rim));
}

/* Smallest in-plane Cauchy stress of the two rings. */
static long double ring_tension(const true_film *f, long double u, long double m)
{
    const ring_strains at = rings_at(f, u);
    const true_edge e = edge_ring(f, u);
    const long double rest = film_cauchy(f, f->prestretch).value,
                      l4 = f->prestretch * f->prestretch * f->prestretch * f->prestretch;
    const long double area = ring_area(f, &at).value, pull = m * l4 * area * area;
    const long double disc = e.stress[0].value - (f->dot ? pull : 0.0L);
    return rest + least(disc, least(-e.stress[1].value, e.stress[2].value) - (f->dot ? 0.0L : pull));
}

static long double electroded_area(const true_film *f, long double radius)
{
    return f->dot ? pi * radius * radius : pi * (f->frame - radius) * (f->frame + radius);
}

dea_row film_state(const true_film *f, true_numbers n)
{
    const long double disc = n.strain * (2.0L + n.strain) * f->divide * f->divide * pi; /* its growth [m^2] */
    return (dea_row){.strain = (double)n.strain,
                     .displacement = (double)(n.strain * f->divide),
                     .force = (double)n.force,
                     .field = (double)n.field,
                     .capacitance = (double)n.capacitance,
                     .charge = (double)(n.capacitance * n.voltage),
                     .area_strain = (double)((f->dot ? disc : -disc) / electroded_area(f, f->divide)),
                     .focal_length = isnan((double)f->focal_length) ? (double)NAN : (double)film_focal_length(f, n.strain),
                     .state = n.field > f->breakdown ? DEA_STATE_BREAKDOWN
                              : n.taut               ? DEA_STATE_OK
                                                     : DEA_STATE_SLACK};
}

/* Area stretch of the electroded film and whether all is taut; the models that move. */
dea_row film_row(const true_film *f, long double u, long double voltage)
{
    const long double l = f->prestretch, s = u / f->divide, p = f->divide / (f->frame - f->divide);
    const long double b = f->coverage, nominal = voltage / f->thickness, m = f->permittivity * nominal * nominal;
    const bool lame = strcmp(f->model, "lame") == 0, hyper = strcmp(f->model, "coverage") == 0,
               ring = strcmp(f->model, "ring") == 0;
    const long double active = f->dot ? 1.0L + s : 1.0L - p * s;
    long double area = active * active;
    if (!f->dot && !hyper) {
        area = (1.0L - b * b * (1.0L + s) * (1.0L + s)) / (1.0L - b * b);
    }
    const true_edge e = film_edge(f, hyper || ring ? u : 0.0L);
    const bool taut = ring   ? ring_tension(f, u, m) > 0.0L
                      : lame ? lame_tension(f, s, m) > 0.0L
                             : l * (f->dot ? 1.0L - p * s : 1.0L + s) > 1.0L;
    const long double field = fabsl(nominal * l * l * area);
    const long double capacitance = film_edge(f, u).capacitance;
    dea_row row = film_state(f, (true_numbers){s, e.push.value * voltage * voltage, field, capacitance, voltage, taut});
    row.displacement = (double)u;
    return row;
}

/* Cap of fixed volume: a^2 h 3 + h^3 = 6 V/pi. */
long double film_focal_length(const true_film *f, long double strain)
{
    const long double radius = f->focal_length * (f->index - 1.0L), a0 = f->divide, a = a0 * (1.0L + strain);
    const long double h0 = a0 * a0 / (radius + sqrtl((radius - a0) * (radius + a0)));
    const long double volume = h0 * (3.0L * a0 * a0 + h0 * h0);
    long double h = h0;
    for (int i = 0; i < 60; i++) {
        h -= (h * (3.0L * a * a + h * h) - volume) / (3.0L * (a * a + h * h));
    }
    return (a * a + h * h) / (2.0L * h * (f->index - 1.0L));
}
