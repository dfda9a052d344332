/* Static truths: closed forms, a scan of Eqs. 13 and 18, and the membrane by extrapolated midpoint steps (Gragg, Bulirsch,
 * Stoer); all in long double. The branch from rest is followed by the displacement: the load that holds it grows up to the first
 * fold. */
#include <math.h>
#include <string.h>

#include "promises.h"

static const long double pi = 3.14159265358979323846264338327950288L;
static const long double none = (long double)NAN;

static dea_row refused(void)
{
    return (dea_row){(double)NAN, (double)NAN, (double)NAN, (double)NAN, DEA_STATE_PULL_IN};
}

/* ---- the share of the full load that holds a place on the branch, for Eqs. 13, 18 and for the membrane */

typedef struct branch {
    const true_film *film;
    long double load;                  /* eps lambda_pre^4 (U/H)^2 [Pa]; membrane: M [Pa] */
    long double ratio;                 /* strain that the passive film gives back */
    int steps;                         /* of the membrane */
    long double linear;                /* displacement under the full load without softening, of the membrane */
    long double known_at, known_share; /* last share found */
} branch;

typedef long double share_function(branch *b, long double place);

static long double balance_share(branch *b, long double e)
{
    const long double l = b->film->prestretch, s = 1.0L + e;
    const long double active = film_cauchy(b->film, l * s).value;
    const long double passive =
        b->ratio > 0.0L ? film_cauchy(b->film, l * (1.0L - b->ratio * e)).value : film_cauchy(b->film, l).value;
    return (active - passive) / (b->load * s * s * s * s);
}

/* Place between two where the share is 1. */
static long double between(branch *b, share_function *share, long double low, long double high)
{
    long double at_low = low == 0.0L ? -1.0L : share(b, low) - 1.0L, at_high = share(b, high) - 1.0L;
    for (int i = 0; i < 200 && fabsl(high - low) > 1e-19L * fabsl(high) && at_high != 0.0L; i++) {
        long double at = (low * at_high - high * at_low) / (at_high - at_low);
        if (i % 3 == 2 || !((at > low && at < high) || (at < low && at > high))) {
            at = 0.5L * (low + high);
        }
        const long double excess = share(b, at) - 1.0L;
        if (isnan(excess)) {
            return none;
        }
        if (excess < 0.0L) {
            low = at;
            at_low = excess;
        } else {
            high = at;
            at_high = excess;
        }
    }
    return high;
}

/* Largest share between two places, by golden section. */
static long double top(branch *b, share_function *share, long double low, long double high, long double *where)
{
    const long double golden = 0.618033988749894848L;
    long double x = high - golden * (high - low), y = low + golden * (high - low);
    long double f = share(b, x), g = share(b, y);
    for (int i = 0; i < 60; i++) {
        if (f > g || isnan(g)) {
            high = y;
            y = x;
            g = f;
            x = high - golden * (high - low);
            f = share(b, x);
        } else {
            low = x;
            x = y;
            f = g;
            y = low + golden * (high - low);
            g = share(b, y);
        }
    }
    *where = f > g ? x : y;
    return f > g ? f : g;
}

/* First place from rest that holds the full load, in steps of @p step towards @p end; NAN behind a fold. */
static long double first_place(branch *b, share_function *share, long double step, long double end)
{
    long double before = 0.0L, last = 0.0L, held = 0.0L;
    b->known_at = b->known_share = 0.0L;
    const long double shortest = 1e-6L * fabsl(step);
    while (fabsl(last) < fabsl(end) && fabsl(step) > shortest) {
        long double here = last + step;
        here = fabsl(here) < fabsl(end) ? here : end;
        const long double now = share(b, here);
        if (isnan(now)) {
            step *= 0.5L;
            continue;
        }
        if (now >= 1.0L) {
            return between(b, share, last, here);
        }
        if (now < held) {
            long double where;
            return top(b, share, before, here, &where) >= 1.0L ? between(b, share, before, where) : none;
        }
        before = last;
        last = here;
        held = now;
    }
    return none;
}

static long double balance(const true_film *f, long double ratio, long double voltage)
{
    const long double l2 = f->prestretch * f->prestretch, nominal = voltage / f->thickness;
    branch b = {.film = f, .load = f->permittivity * l2 * l2 * nominal * nominal, .ratio = ratio};
    if (b.load == 0.0L) {
        return 0.0L;
    }
    if (!(film_cauchy(f, f->prestretch).slope > 0.0L)) {
        return none;
    }
    const long double end = ratio > 0.05L ? 1.0L / ratio : 20.0L;
    return first_place(&b, balance_share, end / 8000.0L, end * (1.0L - 1e-9L));
}

/* ---- the membrane */

typedef struct membrane {
    const true_film *film;
    long double disc, annulus; /* k [Pa] */
} membrane;

typedef struct stretches {
    long double l1, l2;
} stretches;

typedef struct tension {
    long double s1, s2, s11, s12;
} tension;

static tension tension_at(const true_film *f, long double k, stretches l)
{
    const long double i1 = 1.0L / l.l1, i2 = 1.0L / l.l2, c = i1 * i1 * i2 * i2;
    const long double j = l.l1 * l.l1 + l.l2 * l.l2 + c - 3.0L;
    const long double w = f->yeoh[0] + 2.0L * f->yeoh[1] * j + 3.0L * f->yeoh[2] * j * j;
    const long double q = 2.0L * f->yeoh[1] + 6.0L * f->yeoh[2] * j;
    const long double a1 = 2.0L * (l.l1 - c * i1), a2 = 2.0L * (l.l2 - c * i2);
    return (tension){w * a1 - k * l.l1 * l.l2 * l.l2, w * a2 - k * l.l2 * l.l1 * l.l1,
                     w * (2.0L + 6.0L * c * i1 * i1) + q * a1 * a1 - k * l.l2 * l.l2,
                     4.0L * w * c * i1 * i2 + q * a1 * a2 - 2.0L * k * l.l1 * l.l2};
}

/* Over x = ln R. */
static stretches slope_at(const membrane *m, stretches l)
{
    const tension t = tension_at(m->film, m->annulus, l);
    if (!(t.s11 > 0.0L) || !(l.l1 > 0.0L) || !(l.l2 > 0.0L)) {
        return (stretches){none, none};
    }
    return (stretches){(t.s2 - t.s1 - t.s12 * (l.l1 - l.l2)) / t.s11, l.l1 - l.l2};
}

static stretches moved(stretches a, long double h, stretches slope)
{
    return (stretches){a.l1 + h * slope.l1, a.l2 + h * slope.l2};
}

/* Modified midpoint rule in n steps, Gragg's smoothing at the end. */
static stretches midpoint(const membrane *m, stretches from, long double width, int n)
{
    const long double h = width / n;
    stretches before = from, here = moved(from, h, slope_at(m, from));
    for (int i = 1; i < n; i++) {
        const stretches next = moved(before, 2.0L * h, slope_at(m, here));
        before = here;
        here = next;
    }
    const stretches end = moved(before, h, slope_at(m, here));
    return (stretches){0.5L * (here.l1 + end.l1), 0.5L * (here.l2 + end.l2)};
}

static stretches step_by(const membrane *m, stretches from, long double width)
{
    enum { ROWS = 6 };
    static const int counts[ROWS] = {2, 4, 6, 8, 12, 16};
    stretches row[ROWS];
    for (int i = 0; i < ROWS; i++) {
        row[i] = midpoint(m, from, width, counts[i]);
        for (int k = i - 1; k >= 0; k--) {
            const long double ratio = (long double)counts[i] / counts[k], share = 1.0L / (ratio * ratio - 1.0L);
            row[k].l1 = row[k + 1].l1 + share * (row[k + 1].l1 - row[k].l1);
            row[k].l2 = row[k + 1].l2 + share * (row[k + 1].l2 - row[k].l2);
        }
    }
    return row[0];
}

/* lambda_1 behind the edge: the radial stress is that of the disc. */
static stretches behind_edge(const membrane *m, long double l)
{
    const long double wanted = tension_at(m->film, m->disc, (stretches){l, l}).s1;
    stretches at = {l, l};
    while (!(tension_at(m->film, m->annulus, at).s11 > 0.0L) && at.l1 > 0.1L * l) {
        at.l1 *= 0.9L; /* on the branch from rest the stress rises with the stretch */
    }
    for (int i = 0; i < 60; i++) {
        const tension t = tension_at(m->film, m->annulus, at);
        if (!(t.s11 > 0.0L)) {
            return (stretches){none, none};
        }
        long double step = (wanted - t.s1) / t.s11;
        step = step > 0.2L * at.l1 ? 0.2L * at.l1 : step < -0.2L * at.l1 ? -0.2L * at.l1 : step;
        at.l1 += step;
        if (fabsl(step) <= 1e-19L * at.l1) {
            break;
        }
    }
    return at;
}

/* Extremes over the annulus. */
typedef struct extremes {
    long double area, stress;
} extremes;

static void widen(const membrane *m, stretches l, extremes *x)
{
    const tension t = tension_at(m->film, m->annulus, l);
    x->area = fmaxl(x->area, l.l1 * l.l2);
    x->stress = fminl(x->stress, fminl(t.s1, t.s2));
}

/* The largest area inside a step: where its slope vanishes on the cubic of the step. */
static void look_inside(const membrane *m, stretches a, stretches b, long double h, extremes *x)
{
    const stretches da = slope_at(m, a), db = slope_at(m, b);
    const long double f = da.l1 * a.l2 + a.l1 * da.l2, g = db.l1 * b.l2 + b.l1 * db.l2;
    if ((f > 0.0L && g < 0.0L) || (f < 0.0L && g > 0.0L)) {
        long double low = 0.0L, high = h, at_low = f;
        for (int i = 0; i < 40; i++) {
            const long double at = 0.5L * (low + high);
            const stretches l = step_by(m, a, at), d = slope_at(m, l);
            const long double slope = d.l1 * l.l2 + l.l1 * d.l2;
            if ((slope > 0.0L) == (at_low > 0.0L)) {
                low = at;
            } else {
                high = at;
            }
        }
        widen(m, step_by(m, a, low), x);
    }
}

/* lambda_2 at the frame less the pre-stretch, the disc stretched by @p edge more than that. */
static long double miss_at_frame(const membrane *m, long double edge, int steps, extremes *x)
{
    const true_film *f = m->film;
    stretches l = behind_edge(m, f->prestretch + edge);
    const long double h = -logl(f->divide / f->frame) / steps;
    for (int i = 0; i < steps && !isnan(l.l1); i++) {
        const stretches next = step_by(m, l, h);
        if (x) {
            widen(m, l, x);
            look_inside(m, l, next, h, x);
        }
        l = next;
    }
    if (x) {
        widen(m, l, x);
    }
    return l.l2 - f->prestretch;
}

/* Secant; from the last share that was found, which grows with the edge. */
static long double membrane_share(branch *b, long double edge)
{
    const long double full = b->load;
    long double last = 0.0L, miss_last = edge;
    long double share = b->known_share > 0.0L ? b->known_share * (edge / b->known_at) : edge / b->linear;
    for (int i = 0; i < 80; i++) {
        const membrane m = {b->film, b->film->dot ? share * full : 0.0L, b->film->dot ? 0.0L : share * full};
        const long double miss = miss_at_frame(&m, edge, b->steps, NULL);
        if (isnan(miss)) {
            share = last + 0.25L * (share - last);
            continue;
        }
        const long double next = share - miss * (share - last) / (miss - miss_last);
        if (miss == 0.0L || fabsl(next - share) <= fmaxl(1e-14L, 2e-17L / fabsl(edge)) * fabsl(share)) {
            b->known_at = edge;
            b->known_share = miss == 0.0L ? share : next;
            return b->known_share;
        }
        last = share;
        miss_last = miss;
        share = next > 0.0L ? next : 0.5L * share;
    }
    return none;
}

static long double nominal_pressure(const true_film *f, long double voltage)
{
    const long double nominal = voltage / f->thickness;
    return f->permittivity * nominal * nominal;
}

static dea_row membrane_row(const true_film *f, long double voltage, int steps)
{
    const long double l = f->prestretch, pressure = nominal_pressure(f, voltage), sign = f->dot ? 1.0L : -1.0L;
    const membrane m = {f, f->dot ? pressure : 0.0L, f->dot ? 0.0L : pressure};
    branch b = {.film = f, .load = pressure, .steps = steps};
    const long double end = sign * (f->dot ? l * (f->frame / f->divide - 1.0L) : l) * (1.0L - 1e-9L);
    const tension rest = tension_at(f, 0.0L, (stretches){l, l});
    long double edge = 0.0L;
    if (pressure > 0.0L) {
        b.linear = sign * pressure * l * l * l * (1.0L - f->coverage) * (1.0L + f->coverage) / (2.0L * rest.s11);
        const long double step = sign * fminl(fminl(0.01L * l, 0.02L * fabsl(end)), 0.3L * fabsl(b.linear));
        edge = rest.s11 > 0.0L ? first_place(&b, membrane_share, step, end) : none;
    }
    if (isnan(edge)) {
        return refused();
    }
    extremes x = {0.0L, (long double)INFINITY};
    (void)miss_at_frame(&m, edge, steps, &x);
    const long double disc = l + edge, nominal = fabsl(voltage / f->thickness);
    x.stress = fminl(x.stress, tension_at(f, m.disc, (stretches){disc, disc}).s1);
    const long double field = nominal * (f->dot ? disc * disc : x.area);
    const long double radial = f->dot ? disc : behind_edge(&m, disc).l1; /* of the electroded side */
    const long double force = sign * 2.0L * pi * f->thickness * pressure * (f->divide / l) * radial * disc * disc;
    return (dea_row){(double)(edge / l), (double)(edge / l * f->divide), (double)force, (double)field,
                     field > f->breakdown ? DEA_STATE_BREAKDOWN
                     : x.stress > 0.0L    ? DEA_STATE_OK
                                          : DEA_STATE_SLACK};
}

/* ---- all models */

static dea_row free_row(const true_film *f, long double voltage, bool constant_force)
{
    const long double l2 = f->prestretch * f->prestretch, nominal = voltage / f->thickness;
    const long double pressure = f->permittivity * l2 * l2 * nominal * nominal,
                      section = 2.0L * pi * f->divide * f->thickness / l2;
    const long double x = pressure / f->modulus;
    long double s = 0.0L;
    if (constant_force) {
        s = balance(f, 0.0L, voltage);
    } else if (pressure > 0.0L) {
        s = x > 0.0L && x < 1.0L ? x / (sqrtl(1.0L - x) * (1.0L + sqrtl(1.0L - x))) : none;
    }
    if (isnan(s)) {
        return refused();
    }
    const long double a = 1.0L + s, field = fabsl(nominal) * l2 * a * a;
    return (dea_row){(double)s, (double)(s * f->divide), (double)(pressure * section * (constant_force ? a * a * a : 1.0L)),
                     (double)field, field > f->breakdown ? DEA_STATE_BREAKDOWN : DEA_STATE_OK};
}

long double still_displacement(const true_film *f, long double voltage)
{
    const true_edge e = film_edge(f, 0.0L);
    if (strcmp(f->model, "coverage") == 0) {
        const long double p = f->divide / (f->frame - f->divide), ratio = f->dot ? p : 1.0L / p;
        const long double active = balance(f, ratio, voltage);
        return f->divide * (f->dot ? active : -ratio * active);
    }
    const long double square = voltage * voltage, net = e.stress.slope - e.push.slope * square;
    return net > 0.0L || square == 0.0L ? e.push.value * square / net : none;
}

static dea_row row_of(const true_film *f, long double voltage, int steps)
{
    if (strcmp(f->model, "pelrine") == 0 || strcmp(f->model, "constant_force") == 0) {
        return free_row(f, voltage, f->model[0] == 'c');
    }
    if (strcmp(f->model, "field") == 0) {
        return membrane_row(f, voltage, steps);
    }
    const long double u = still_displacement(f, voltage);
    return isnan(u) ? refused() : film_row(f, u, voltage);
}

static double relative(double a, double b)
{
    return a == b ? 0.0 : fabs(a - b) / fabs(b);
}

true_row still_truth(const dea_scene *scene, const dea_model *model, double factor)
{
    const true_film f = film_of(scene, model);
    const long double voltage = f.kept * (long double)scene->drive.voltage * (long double)factor;
    true_row truth = {.row = row_of(&f, voltage, 24), .error = 1e-15};
    if (model->membrane && truth.row.state != DEA_STATE_PULL_IN) {
        const dea_row coarse = row_of(&f, voltage, 12);
        truth.error += fmax(relative(coarse.strain, truth.row.strain), relative(coarse.field, truth.row.field));
        truth.error +=
            truth.row.strain != 0.0 ? 1e-17 / fabs(truth.row.strain) : 0.0; /* the miss at the frame has so many digits */
    }
    if (model->solve && (strcmp(model->name, "coverage") == 0 || strcmp(model->name, "constant_force") == 0) &&
        truth.row.strain != 0.0) {
        truth.error += 1e-18 / fabs(truth.row.strain); /* stresses that nearly cancel */
    }
    return truth;
}
