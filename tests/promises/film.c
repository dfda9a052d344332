/* The film straight from physics.md, sections 2, 3 and 5, in long double. */
#include "truths.h"

#include <math.h>
#include <string.h>

static const long double pi = 3.14159265358979323846264338327950288L;

/* A strain that goes with the displacement. */
static jet strain_of(long double u, long double per_u)
{
    return (jet){u * per_u, per_u, 0.0L, u * per_u};
}

/* lambda_pre (1 + e). */
static jet stretched(const true_film *f, jet strain)
{
    return times(f->prestretch, plus(plain(1.0L), strain));
}

/* sigma_1 at two stretches. */
static jet principal(const true_film *f, jet l1, jet l2)
{
    return f->law->stress(f->constants, l1, l2);
}

static jet cauchy(const true_film *f, jet l)
{
    return principal(f, l, l);
}

jet film_cauchy(const true_film *film, long double stretch)
{
    return cauchy(film, (jet){stretch, 1.0L, 0.0L, 0.0L});
}

long double film_cauchy_change(const true_film *f, long double e)
{
    return cauchy(f, stretched(f, strain_of(e, 1.0L))).change;
}

/* At changes d1 and d2 from an equi-biaxial stretch. */
static true_stress changed(const true_law *law, const long double *constants, long double stretch, long double d1, long double d2)
{
    const jet l1 = {stretch + d1, 0.0L, 0.0L, d1}, l2 = {stretch + d2, 0.0L, 0.0L, d2};
    const jet along1 = {l1.value, 1.0L, 0.0L, d1}, along2 = {l2.value, 1.0L, 0.0L, d2};
    const jet first = by(law->stress(constants, along1, l2), inverse(along1));
    const jet across = by(law->stress(constants, l2, along1), inverse(l2));
    const jet second = by(law->stress(constants, along2, l1), inverse(along2));
    return (true_stress){first.change, second.change, first.slope, across.slope, second.slope};
}

true_stress film_stress(const true_film *f, long double d1, long double d2)
{
    return changed(f->law, f->constants, f->prestretch, d1, d2);
}

/* Of W_e(lambda_1/lambda_pre, lambda_2/lambda_pre) t lambda_pre^2, stress-free at the pre-stretch. */
true_stress film_skin(const true_film *f, long double d1, long double d2)
{
    if (!f->skin_law) {
        return (true_stress){0};
    }
    const true_stress s = changed(f->skin_law, f->skin_constants, 1.0L, d1 / f->prestretch, d2 / f->prestretch);
    const long double nominal = f->skin * f->prestretch;
    return (true_stress){nominal * s.p1, nominal * s.p2, f->skin * s.w11, f->skin * s.w12, f->skin * s.w22};
}

void film_cauchy_along(const true_film *f, long double d1, long double d2, long double r1, long double r2, jet stress[2])
{
    const jet l1 = {f->prestretch + d1, r1, 0.0L, d1}, l2 = {f->prestretch + d2, r2, 0.0L, d2};
    stress[0] = since_rest(principal(f, l1, l2));
    stress[1] = since_rest(principal(f, l2, l1));
}

true_electric film_electric(const true_film *f, long double area)
{
    const long double stretch = sqrtl(area), rise = f->electrostriction * stretch;
    const long double own = f->permittivity + f->electrostriction * (stretch - f->prestretch);
    return (true_electric){own, own + 0.25L * rise, own + 0.875L * rise};
}

/* Shift factor of all relaxation times: Williams, Landel and Ferry, or evenly in its logarithm between the rows of a table. */
static long double shift_of(const dea_material *m)
{
    const dea_shift *s = &m->shift;
    const long double above = (long double)m->temperature - s->reference;
    if (isnan(m->temperature) || (isnan(s->c1) && s->count == 0)) {
        return 1.0L;
    }
    for (size_t i = 1; i < s->count; i++) {
        const double *low = s->table[i - 1], *high = s->table[i];
        if (m->temperature <= high[0]) {
            const long double along = ((long double)m->temperature - low[0]) / ((long double)high[0] - low[0]);
            return expl((1.0L - along) * logl(low[1]) + along * logl(high[1]));
        }
    }
    return powl(10.0L, -s->c1 * above / (s->c2 + above));
}

/* Moduli at the film's temperature over those given. */
static long double stiffening_of(const dea_material *m)
{
    const bool given = !isnan(m->temperature) && !isnan(m->modulus_slope);
    return given ? 1.0L + m->modulus_slope * ((long double)m->temperature - m->modulus_reference) : 1.0L;
}

static void set_material(const dea_scene *scene, true_film *f)
{
    const dea_material *m = &scene->material;
    const long double shift = shift_of(m);
    long double rest = 1.0L;
    for (size_t i = 0; i < m->prony_count; i++) {
        rest -= (long double)m->prony[i].g;
    }
    for (size_t i = 0; i < m->prony_count; i++) {
        f->share[i] = m->prony[i].g / rest;
        f->tau[i] = shift * m->prony[i].tau;
        f->total_share += f->share[i];
    }
    const long double given = (m->instantaneous ? rest : 1.0L) * stiffening_of(m);
    f->branches = m->prony_count;
    f->law = true_law_find(m->law->name);
    for (unsigned i = 0; i < DEA_LAW_CONSTANTS; i++) {
        f->constants[i] = f->law->moduli >> i & 1u ? given * m->constants[i] : (long double)m->constants[i];
    }
    f->rest = film_stress(f, 0.0L, 0.0L);
    f->tension = film_cauchy(f, f->prestretch).value / f->prestretch;
    f->permittivity = 8.8541878128e-12 * (m->permittivity + (long double)m->permittivity_per_stretch * f->prestretch);
    f->electrostriction = m->permittivity_follows ? 8.8541878128e-12L * m->permittivity_per_stretch : 0.0L;
    f->density = isnan(m->density) ? 0.0L : (long double)m->density;
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
    return f->density * f->layers * f->thickness * film + f->coat / (f->prestretch * f->prestretch) * electrode + f->load_mass;
}

static long double given_or_none(double value)
{
    return isnan(value) ? 0.0L : (long double)value;
}

static long double load_of(const dea_scene *scene, const char *name)
{
    for (size_t i = 0; i < DEA_LOADS; i++) {
        const dea_edge_load *load = &scene->loads[i];
        if (load->kind && strcmp(load->kind->name, name) == 0) {
            return given_or_none(load->number);
        }
    }
    return 0.0L;
}

/* Electrodes and what is fixed to the edge: physics.md, section 8. */
static void set_beside(const dea_scene *scene, true_film *f)
{
    const dea_electrode *e = &scene->electrode;
    const bool weighed = e->law && !isnan(e->density);
    const long double areal = weighed ? (long double)e->density * e->thickness : given_or_none(scene->actuator.electrode_mass);
    f->layers = scene->actuator.layers;
    f->coat = areal * f->prestretch * f->prestretch;
    f->skin_law = e->law ? true_law_find(e->law->name) : NULL;
    f->skin = e->law ? e->thickness / (f->layers * f->thickness) : 0.0L;
    for (unsigned i = 0; i < DEA_LAW_CONSTANTS; i++) {
        f->skin_constants[i] = e->constants[i];
    }
    f->load_mass = load_of(scene, "mass");
    f->load_stiffness = load_of(scene, "stiffness");
    f->load_damping = load_of(scene, "damping");
    f->load_force = load_of(scene, "force");
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
    set_beside(scene, &f);
    f.mass = moving_mass(scene, &f);
    return f;
}

/* int_0^s (1 - p y)^n/(1 + y) dy, n = 4 or 5, with p = B/(1 - B): a series where the closed form would cancel so far that both differ
 * by what Newton's method sees; that is of (1 - p y) = q - p (1 + y), q = 1 + p. */
static long double lens_charge(int n, long double p, long double s)
{
    static const long double binomials[2][6] = {{1.0L, 4.0L, 6.0L, 4.0L, 1.0L}, {1.0L, 5.0L, 10.0L, 10.0L, 5.0L, 1.0L}};
    const long double *binomial = binomials[n - 4], q = 1.0L + p;
    long double sum = 0.0L, front = 1.0L;
    for (int k = 0; k <= n && fabsl(s) <= 0.5L; k++) {
        long double power = front * binomial[k] * s;
        for (int i = 0; i < 70; i++) {
            sum += power / (k + i + 1);
            power *= -s;
        }
        front *= -p * s;
    }
    for (int k = 1; k <= n && fabsl(s) > 0.5L; k++) {
        sum += binomial[k] * powl(q, n - k) * (k % 2 ? -1.0L : 1.0L) * powl(p, k) * (powl(1.0L + s, k) - 1.0L) / k;
    }
    return fabsl(s) > 0.5L ? sum + powl(q, n) * log1pl(s) : sum;
}

/* d(eps a^2/2)/da/a at a mean stretch. */
static jet first_of(const true_film *f, jet stretch)
{
    return plus(plain(f->permittivity - f->electrostriction * f->prestretch), times(1.25L * f->electrostriction, stretch));
}

/* Principal Cauchy stress of the electrodes' skin at two strains from the pre-stretch, spread over the film. */
static jet skin_at(const true_film *f, jet e1, jet e2)
{
    if (!f->skin_law) {
        return plain(0.0L);
    }
    const jet one = plain(1.0L);
    return times(f->skin * f->prestretch * f->prestretch, since_rest(f->skin_law->stress(f->skin_constants, plus(one, e1), plus(one, e2))));
}

long double film_skin_change(const true_film *f, long double e)
{
    const jet strain = strain_of(e, 1.0L);
    return skin_at(f, strain, strain).value;
}

/* What acts on the edge beside the film: a spring less a force. */
static jet beside_at(const true_film *f, long double u)
{
    return plus(strain_of(u, f->load_stiffness), plain(-f->load_force));
}

/* Skin of a film that is linear: a spring more [N/m]. */
static long double linear_skin(const true_film *f, bool lame, long double section, long double q)
{
    const true_stress s = film_skin(f, 0.0L, 0.0L);
    if (lame) {
        return 2.0L * pi * f->layers * f->thickness * (f->dot ? s.w11 + s.w12 : s.w11 * q - s.w12);
    }
    return f->prestretch * (s.w11 + s.w12) * section / (f->dot ? f->divide : f->frame - f->divide);
}

static true_edge edge_linear(const true_film *f, long double u, bool lame)
{
    const long double l2 = f->prestretch * f->prestretch, b2 = f->coverage * f->coverage, sign = f->dot ? 1.0L : -1.0L;
    const long double whole = f->layers * f->thickness, section = 2.0L * pi * f->divide * whole / l2;
    const true_electric el = film_electric(f, l2);
    const long double unit = 2.0L * pi * f->layers / f->thickness * l2; /* 2 pi n H (lambda/H)^2 */
    const long double q = (1.0L + b2) / ((1.0L - f->coverage) * (1.0L + f->coverage));
    const true_stress *m = &f->rest;
    const long double stiffness = lame ? 2.0L * pi * whole * (m->w11 + m->w12 + m->w11 * q - m->w12)
                                       : f->modulus * section * (1.0L / f->divide + 1.0L / (f->frame - f->divide));
    const long double force = sign * unit * el.first * f->divide; /* Eq. 21 over the circumference, per U^2 */
    const long double both = el.first + el.second, soft = lame ? unit * (f->dot ? both + el.second : q * el.second - both) : 0.0L;
    const long double area = pi * (f->dot ? f->divide * f->divide : (f->frame - f->divide) * (f->frame + f->divide));
    return (true_edge){.count = 1,
                       .area = {plain(1.0L)},
                       .stress = {strain_of(u, stiffness)},
                       .tension = plus(beside_at(f, u), strain_of(u, linear_skin(f, lame, section, q))),
                       .push = {force + soft * u, soft, 0.0L, soft * u},
                       .capacitance = f->layers * el.own * l2 / f->thickness * area + u * (2.0L * force + soft * u)};
}

static true_edge edge_hyperelastic(const true_film *f, long double u)
{
    const long double l = f->prestretch, b = f->coverage, p = f->divide / (f->frame - f->divide);
    const jet s = strain_of(u, 1.0L / f->divide), away = times(-p, s), one = plain(1.0L);
    const jet disc = plus(one, s), annulus = plus(one, away);
    const jet inner = cauchy(f, stretched(f, s)), outer = cauchy(f, stretched(f, away));
    const long double section = 2.0L * pi * f->divide * f->layers * f->thickness / (l * l);
    const long double unit = l * l * l * l / (f->thickness * f->thickness), sign = f->dot ? 1.0L : -1.0L;
    const jet area = times(section, inverse(disc)), active = f->dot ? disc : annulus, square = by(active, active);
    const jet coat = f->dot ? skin_at(f, s, s) : skin_at(f, away, away);
    true_edge e = {.count = 1, .area = {area}, .stress = {since_rest(minus(inner, outer))}};
    e.tension = plus(beside_at(f, u), times(sign, by(area, coat)));
    e.push = times(sign * unit, by(first_of(f, times(l, active)), by(area, by(square, square))));
    const long double rest = f->layers * l * l / f->thickness * pi;
    if (f->dot) {
        e.capacitance = rest * film_electric(f, l * l * square.value).own * f->divide * f->divide * square.value * square.value;
    } else {
        const long double rise = 1.25L * f->electrostriction, fixed = f->permittivity - f->electrostriction * l;
        const long double charge = fixed * lens_charge(4, p, s.value) + rise * l * lens_charge(5, p, s.value);
        e.capacitance = rest * f->permittivity * (1.0L - b) * (1.0L + b) * f->frame * f->frame - 4.0L * rest * f->divide * f->divide * charge;
    }
    return e;
}

/* Section 7: relative changes of the stretches of disc, and radial and hoop of the annulus. */
typedef struct ring_strains {
    jet disc, radial, hoop;
} ring_strains;

static ring_strains rings_at(const true_film *f, long double u)
{
    const long double width = f->frame - f->divide, sum = f->frame + f->divide;
    return (ring_strains){strain_of(u, 1.0L / f->divide), strain_of(u, -1.0L / width), strain_of(u, 1.0L / sum)};
}

/* Area stretch of the electroded film over that at rest. */
static jet ring_area(const true_film *f, const ring_strains *at)
{
    const jet one = plain(1.0L), disc = plus(one, at->disc);
    return f->dot ? by(disc, disc) : by(plus(one, at->radial), plus(one, at->hoop));
}

static true_edge edge_ring(const true_film *f, long double u)
{
    const long double l = f->prestretch, section = pi * f->layers * f->thickness / (l * l), rest = f->tension * l;
    const jet one = plain(1.0L), lever = strain_of(u, -1.0L);
    const ring_strains at = rings_at(f, u);
    const jet disc = plus(one, at.disc), radial = plus(one, at.radial), hoop = plus(one, at.hoop);
    const jet l0 = stretched(f, at.disc), l1 = stretched(f, at.radial), l2 = stretched(f, at.hoop);
    const long double outer = f->frame + f->divide, inner = f->frame - f->divide;
    true_edge e = {.count = 3,
                   .area = {times(2.0L * section * f->divide, inverse(disc)), times(section * outer, inverse(radial)),
                            times(section * inner, inverse(hoop))},
                   .stress = {since_rest(cauchy(f, l0)), times(-1.0L, since_rest(principal(f, l1, l2))),
                              since_rest(principal(f, l2, l1))}};
    /* 2 r_a/(1 + e) - (r + r_a)/(1 + e1) + (r - r_a)/(1 + e2), which is 0 at rest, over -u */
    const jet fall =
        plus(times(2.0L, inverse(disc)), plus(times(outer / inner, inverse(radial)), times(inner / outer, inverse(hoop))));
    e.tension = plus(beside_at(f, u), times(section * rest, by(lever, fall)));
    const jet coat = f->dot ? by(e.area[0], skin_at(f, at.disc, at.disc))
                            : minus(by(e.area[2], skin_at(f, at.hoop, at.radial)), by(e.area[1], skin_at(f, at.radial, at.hoop)));
    e.tension = plus(e.tension, coat);
    const jet area = ring_area(f, &at);
    const long double unit = 2.0L * pi * f->divide * f->layers * l * l / f->thickness;
    const jet mean = f->dot ? disc : power(area, 0.5L);
    e.push = times(f->dot ? unit : -unit, by(first_of(f, times(l, mean)), by(disc, area)));
    const long double electrode = pi * (f->dot ? f->divide * f->divide : outer * inner);
    const long double own = film_electric(f, l * l * area.value).own;
    e.capacitance = f->layers * own * l * l / f->thickness * electrode * area.value * area.value;
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

/* Smallest in-plane stress of lame's disc and annulus, under (U/H)^2. */
static long double lame_tension(const true_film *f, long double strain, long double square)
{
    const long double l = f->prestretch, soft = square * l * l, b2 = f->coverage * f->coverage, c = l * strain;
    const true_electric e = film_electric(f, l * l);
    const true_stress skin = film_skin(f, 0.0L, 0.0L);
    const long double w1 = f->rest.w11 + skin.w11 - soft * e.second, w2 = f->rest.w12 + skin.w12 - soft * (e.first + e.second);
    const long double stress = f->tension - soft * e.first * l; /* of the electroded region */
    const long double a1 = f->dot ? w1 : f->rest.w11, a2 = f->dot ? w2 : f->rest.w12;
    const long double o1 = f->dot ? f->rest.w11 : w1, o2 = f->dot ? f->rest.w12 : w2;
    const long double in = -c * (1.0L + b2) / (1.0L - b2), rim = -2.0L * c * b2 / (1.0L - b2);
    const long double t = (f->dot ? stress : f->tension) + (a1 + a2) * c, rest = f->dot ? f->tension : stress;
    return least(least(t, rest + least(o1 * in + o2 * c, o2 * in + o1 * c)), rest + least(o1 * rim, o2 * rim));
}

/* Smallest in-plane Cauchy stress of the two rings. */
static long double ring_tension(const true_film *f, long double u, long double square)
{
    const ring_strains at = rings_at(f, u);
    const true_edge e = edge_ring(f, u);
    const long double rest = f->tension * f->prestretch, l2 = f->prestretch * f->prestretch, area = l2 * ring_area(f, &at).value;
    const long double pull = square * film_electric(f, area).first * area * area;
    const long double disc = e.stress[0].value + (f->dot ? skin_at(f, at.disc, at.disc).value - pull : 0.0L);
    const long double radial = -e.stress[1].value + (f->dot ? 0.0L : skin_at(f, at.radial, at.hoop).value - pull);
    const long double hoop = e.stress[2].value + (f->dot ? 0.0L : skin_at(f, at.hoop, at.radial).value - pull);
    return rest + least(disc, least(radial, hoop));
}

static bool is_loaded(const true_film *f)
{
    return f->load_stiffness > 0.0L || f->load_force != 0.0L;
}

/* Eq. 18 and its linear form hold what the passive film does in balance; under a load the active one may be slack first, at its stress
 * of strain @p e less that of the voltage: of the linear form as the stretch that it stands for. */
static bool is_active_taut(const true_film *f, bool hyper, long double e, long double square)
{
    const long double l = f->prestretch, stretch = l * (1.0L + (hyper ? e : 0.0L)), area = stretch * stretch;
    const long double pull = square * film_electric(f, area).first * area * area;
    const true_stress skin = film_skin(f, 0.0L, 0.0L);
    if (hyper) {
        return f->tension * l + film_cauchy_change(f, e) + film_skin_change(f, e) > pull;
    }
    return l * (1.0L + ((f->modulus + l * (skin.w11 + skin.w12)) * e - pull) / f->modulus) > 1.0L;
}

/* Is the smaller stress of each region positive? */
static bool is_taut(const true_film *f, long double u, long double square)
{
    const long double s = u / f->divide, away = -s * f->divide / (f->frame - f->divide);
    if (strcmp(f->model, "ring") == 0) {
        return ring_tension(f, u, square) > 0.0L;
    }
    if (strcmp(f->model, "lame") == 0) {
        return lame_tension(f, s, square) > 0.0L;
    }
    const bool hyper = strcmp(f->model, "coverage") == 0;
    return f->prestretch * (1.0L + (f->dot ? away : s)) > 1.0L &&
           (!is_loaded(f) || is_active_taut(f, hyper, f->dot ? s : away, square));
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
                     .energy = (double)(0.5L * n.capacitance * n.voltage * n.voltage),
                     .state = n.field > f->breakdown ? DEA_STATE_BREAKDOWN
                              : n.taut               ? DEA_STATE_OK
                                                     : DEA_STATE_SLACK};
}

/* Area stretch of the electroded film and whether all is taut; the models that move. */
dea_row film_row(const true_film *f, long double u, long double voltage)
{
    const long double l = f->prestretch, s = u / f->divide, p = f->divide / (f->frame - f->divide);
    const long double b = f->coverage, nominal = voltage / f->thickness;
    const bool hyper = strcmp(f->model, "coverage") == 0, ring = strcmp(f->model, "ring") == 0;
    const long double active = f->dot ? 1.0L + s : 1.0L - p * s;
    long double area = active * active;
    if (!f->dot && !hyper) {
        area = (1.0L - b * b * (1.0L + s) * (1.0L + s)) / (1.0L - b * b);
    }
    const true_edge e = film_edge(f, hyper || ring ? u : 0.0L);
    const bool taut = is_taut(f, u, nominal * nominal);
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
