/* Static truths but for the membrane's: closed forms, and a scan of Eqs. 13 and 18, whose branch from rest is followed by the
 * displacement: the load that holds it grows up to the first fold. All in long double. */
#include <math.h>
#include <string.h>

#include "truths.h"

static const long double pi = 3.14159265358979323846264338327950288L;
static const long double none = (long double)NAN;

static dea_row refused(void)
{
    dea_row row = dea_row_failed();
    row.state = DEA_STATE_PULL_IN;
    return row;
}

/* ---- the share of the full load that holds a place on the branch, for Eqs. 13 and 18 */

typedef struct branch {
    const true_film *film;
    long double load;        /* what grows: lambda_pre^4 (U/H)^2, U^2, or the force on the edge */
    long double ratio;       /* strain that the passive film gives back */
    long double base, toward; /* displacement from which a film with an edge goes, and its sense */
    bool steady;              /* the force on the edge grows, without voltage */
} branch;

typedef long double share_function(branch *b, long double place);

/* Stress of the electroded film less that of the passive one, over that of the voltage. */
static long double balance_share(branch *b, long double e)
{
    const true_film *f = b->film;
    const long double s = 1.0L + e, l = f->prestretch * s;
    const long double active = film_cauchy_change(f, e) + film_skin_change(f, e), passive = film_cauchy_change(f, -b->ratio * e);
    return (active - passive) / (b->load * film_electric(f, l * l).first * s * s * s * s);
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

/* A strain that no film reaches; below it some do without a fold (Ogden's films whose largest exponent is just above 4). */
static const long double far = 1e9L;

/* First place from rest that holds the full load, on the way to @p end in steps that grow with the film, of which @p size is the
 * length at rest; NAN behind a fold. */
static long double first_place(branch *b, share_function *share, long double size, long double end)
{
    const long double longest = fabsl(end) / 8000.0L;
    long double before = 0.0L, last = 0.0L, held = 0.0L, part = 1.0L;
    while (fabsl(last) < fabsl(end) && part > 1e-6L) {
        const long double step = part * fminl(longest, (size + fabsl(last)) / 400.0L);
        long double here = last + copysignl(step, end);
        here = fabsl(here) < fabsl(end) ? here : end;
        const long double now = share(b, here);
        if (isnan(now)) {
            part *= 0.5L;
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

/* Share of the load that holds a film with an edge at a distance from where it rests. */
static long double edge_share(branch *b, long double distance)
{
    const true_film *f = b->film;
    const true_edge e = film_edge(f, b->base + b->toward * distance);
    const long double held = edge_relaxed(&e).value + (b->steady ? f->load_force : 0.0L);
    return held / ((b->steady ? 1.0L : e.push.value) * b->load);
}

/* Moves the base along what grows; false where there is no equilibrium. */
static bool grow(branch *b, bool steady, long double load)
{
    const true_film *f = b->film;
    const true_edge e = film_edge(f, b->base);
    const long double size = fminl(f->divide, f->frame - f->divide);
    b->steady = steady;
    b->load = load;
    b->toward = (steady ? load : e.push.value) < 0.0L ? -1.0L : 1.0L;
    if (load == 0.0L || !(edge_relaxed(&e).slope > 0.0L)) {
        return load == 0.0L;
    }
    const long double room = b->toward > 0.0L ? f->frame - f->divide - b->base : f->divide + b->base;
    const long double place = first_place(b, edge_share, size, room * (1.0L - 1e-9L));
    b->base += b->toward * place;
    return !isnan(place);
}

static long double balance(const true_film *f, long double ratio, long double voltage)
{
    const long double l2 = f->prestretch * f->prestretch, nominal = voltage / f->thickness;
    branch b = {.film = f, .load = l2 * l2 * nominal * nominal, .ratio = ratio};
    if (b.load == 0.0L) {
        return 0.0L;
    }
    const long double skin = film_skin(f, 0.0L, 0.0L).w11 + film_skin(f, 0.0L, 0.0L).w12;
    const long double active = film_cauchy(f, f->prestretch).slope + f->prestretch * skin;
    if (!(active + ratio * film_cauchy(f, f->prestretch).slope > 0.0L)) {
        return none;
    }
    const long double end = ratio > 0.0L ? 1.0L / ratio : far;
    return first_place(&b, balance_share, 1.0L, end * (1.0L - 1e-9L));
}

/* ---- all models */

/* Eq. 4 takes the permittivity at the pre-stretch for its force, Eq. 13 that of the strained film. */
static dea_row free_row(const true_film *f, long double voltage, bool constant_force)
{
    const long double l = f->prestretch, l2 = l * l, nominal = voltage / f->thickness;
    const long double square = l2 * l2 * nominal * nominal, section = 2.0L * pi * f->divide * f->layers * f->thickness / l2;
    const true_stress skin = film_skin(f, 0.0L, 0.0L);
    const long double pressure = film_electric(f, l2).first * square, x = pressure / (f->modulus + l * (skin.w11 + skin.w12));
    long double s = 0.0L;
    if (constant_force) {
        s = balance(f, 0.0L, voltage);
    } else if (pressure > 0.0L) {
        s = x > 0.0L && x < 1.0L ? x / (sqrtl(1.0L - x) * (1.0L + sqrtl(1.0L - x))) : none;
    }
    if (isnan(s)) {
        return refused();
    }
    const long double a = 1.0L + s, area = l2 * a * a;
    const true_electric e = film_electric(f, area);
    const long double rest = e.own * f->layers * l2 / f->thickness * pi * f->divide * f->divide;
    return film_state(f, (true_numbers){.strain = s,
                                        .force = section * (constant_force ? e.first * square * a * a * a : pressure),
                                        .field = fabsl(nominal) * area,
                                        .capacitance = rest * a * a * a * a,
                                        .voltage = voltage,
                                        .taut = true});
}

long double still_displacement(const true_film *f, long double voltage)
{
    const bool hyper = strcmp(f->model, "coverage") == 0, loaded = f->load_stiffness > 0.0L || f->load_force != 0.0L;
    if (hyper && !loaded) {
        const long double p = f->divide / (f->frame - f->divide), ratio = f->dot ? p : 1.0L / p;
        const long double active = balance(f, ratio, voltage);
        return f->divide * (f->dot ? active : -ratio * active);
    }
    if (hyper || strcmp(f->model, "ring") == 0) {
        branch b = {.film = f};
        return grow(&b, true, f->load_force) && grow(&b, false, voltage * voltage) ? b.base : none;
    }
    const true_edge e = film_edge(f, 0.0L);
    const long double square = voltage * voltage, rest = edge_relaxed(&e).slope, net = rest - e.push.slope * square;
    const bool stable = (rest > 0.0L || f->load_force == 0.0L) && (net > 0.0L || square == 0.0L);
    return stable ? (e.push.value * square + f->load_force) / net : none;
}

static dea_row row_of(const true_film *f, long double voltage)
{
    if (strcmp(f->model, "pelrine") == 0 || strcmp(f->model, "constant_force") == 0) {
        return free_row(f, voltage, f->model[0] == 'c');
    }
    const long double u = still_displacement(f, voltage);
    return isnan(u) ? refused() : film_row(f, u, voltage);
}

true_row still_truth(const dea_scene *scene, const dea_model *model, double factor)
{
    const true_film f = film_of(scene, model);
    const long double voltage = f.kept * (long double)scene->drive.voltage * (long double)factor;
    if (model->membrane) {
        return membrane_truth(&f, voltage);
    }
    return (true_row){row_of(&f, voltage), 1e-15};
}
