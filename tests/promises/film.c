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
    const long double areal = isnan(scene->actuator.electrode_mass) ? 0.0L : (long double)scene->actuator.electrode_mass;
    return scene->material.density * f->thickness * film + areal * electrode;
}

static long double given_or_none(double value)
{
    return isnan(value) ? 0.0L : (long double)value;
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
    f->load_mass = given_or_none(scene->load.mass);
    f->load_stiffness = given_or_none(scene->load.stiffness);
    f->load_damping = given_or_none(scene->load.damping);
    f->load_force = given_or_none(scene->load.force);
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

static true_edge edge_linear(const true_film *f, long double u, bool lame)
{
    const long double l2 = f->prestretch * f->prestretch, b2 = f->coverage * f->coverage, sign = f->dot ? 1.0L : -1.0L;
    const long double section = 2.0L * pi * f->divide * f->thickness / l2;
    const long double unit = 2.0L * pi * f->permittivity / f->thickness * l2; /* 2 pi H M lambda^2/U^2 */
    const long double q = (1.0L + b2) / ((1.0L - f->coverage) * (1.0L + f->coverage));
    const true_stress *m = &f->rest;
    const long double stiffness = lame ? 2.0L * pi * f->thickness * (m->w11 + m->w12 + m->w11 * q - m->w12)
                                       : f->modulus * section * (1.0L / f->divide + 1.0L / (f->frame - f->divide));
    const long double force = sign * unit * f->divide; /* Eq. 21 over the circumference, per U^2 */
    const long double soft = lame ? unit * (f->dot ? 3.0L : q - 2.0L) : 0.0L;
    const long double area = pi * (f->dot ? f->divide * f->divide : (f->frame - f->divide) * (f->frame + f->divide));
    return (true_edge){.count = 1,
                       .area = {plain(1.0L)},
                       .stress = {strain_of(u, stiffness)},
                       .push = {force + soft * u, soft, 0.0L, soft * u},
                       .capacitance = f->permittivity * l2 / f->thickness * area + u * (2.0L * force + soft * u)};
}

static true_edge edge_hyperelastic(const true_film *f, long double u)
{
    const long double l = f->prestretch, b = f->coverage, p = f->divide / (f->frame - f->divide);
    const jet s = strain_of(u, 1.0L / f->divide), away = times(-p, s), one = plain(1.0L);
    const jet disc = plus(one, s), annulus = plus(one, away);
    const jet inner = cauchy(f, stretched(f, s)), outer = cauchy(f, stretched(f, away));
    const long double section = 2.0L * pi * f->divide * f->thickness / (l * l);
    const long double unit = f->permittivity * l * l * l * l / (f->thickness * f->thickness);
    const jet area = times(section, inverse(disc)), active = f->dot ? disc : annulus, square = by(active, active);
    true_edge e = {.count = 1, .area = {area}, .stress = {since_rest(minus(inner, outer))}};
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
    const long double l = f->prestretch, section = pi * f->thickness / (l * l), rest = f->tension * l;
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
    const long double l = f->prestretch, soft = m * l * l, b2 = f->coverage * f->coverage;
    const long double d = f->dot ? soft : 0.0L, o = f->dot ? 0.0L : soft, c = l * strain;
    const long double a1 = f->rest.w11 - d, a2 = f->rest.w12 - 2.0L * d;
    const long double o1 = f->rest.w11 - o, o2 = f->rest.w12 - 2.0L * o;
    const long double in = -c * (1.0L + b2) / (1.0L - b2), rim = -2.0L * c * b2 / (1.0L - b2);
    long double t = f->tension - d * l + (a1 + a2) * c;
    const long double rest = f->tension - o * l;
    t = least(t, rest + least(o1 * in + o2 * c, o2 * in + o1 * c));
    return least(t, rest + least(o1 * rim, o2 * rim));
}

/* Smallest in-plane Cauchy stress of the two rings. */
static long double ring_tension(const true_film *f, long double u, long double m)
{
    const ring_strains at = rings_at(f, u);
    const true_edge e = edge_ring(f, u);
    const long double rest = f->tension * f->prestretch,
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
                     .energy = (double)(0.5L * n.capacitance * n.voltage * n.voltage),
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
