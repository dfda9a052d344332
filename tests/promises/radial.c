#include "radial.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

static const long double pi = 3.14159265358979323846264338327950288L;
static const long double graded = 1.0L;          /* widest element of the annulus over its inner radius */
static const long double longest_change = 0.15L; /* of a stretch in one round of Newton's method, relative */
static const long double shortest_load = 1e-10L; /* step of the load at which an equilibrium ends */

enum { NEWTON = 30, GRID = 24 };

/* Unknown of a shape of an element from the centre on; -1: none, at centre or frame. */
static int unknown(const radial *r, int element, int number)
{
    const int near = element * RADIAL_DEGREE - 1;
    const int at = number == 0 ? near : number == 1 ? near + RADIAL_DEGREE : near + number - 1;
    return at < r->size ? at : -1;
}

static bool electroded(const radial *r, int element)
{
    return (element < r->disc) == r->film->dot;
}

/* ---- mesh */

/* Ends of elements from one radius to another, each no wider than @p widest and, where graded, its own radius. */
static bool cut(radial *r, long double from, long double to, long double widest, bool grades)
{
    long double ends[RADIAL_ELEMENTS + 1] = {from};
    int count = 0;
    while (ends[count] < to * (1.0L - 1e-12L) && count < RADIAL_ELEMENTS) {
        const long double at = ends[count];
        ends[count + 1] = at + (grades ? fminl(widest, graded * at) : widest);
        count++;
    }
    if (ends[count] < to * (1.0L - 1e-12L) || r->elements + count > RADIAL_ELEMENTS) {
        return false;
    }
    const long double shrink = (to - from) / (ends[count] - from); /* all alike, so that the last one fits */
    for (int i = 1; i <= count; i++) {
        r->radius[r->elements + i] = from + shrink * (ends[i] - from);
    }
    r->elements += count;
    r->radius[r->elements] = to;
    return true;
}

static long double radius_at(const radial *r, int spot)
{
    const int e = spot / RADIAL_PLACES;
    return r->radius[e] + 0.5L * (1.0L + r->place[spot % RADIAL_PLACES]) * (r->radius[e + 1] - r->radius[e]);
}

/* dR of a place [m]. */
static long double width_at(const radial *r, int spot)
{
    const int e = spot / RADIAL_PLACES;
    return 0.5L * r->weight[spot % RADIAL_PLACES] * (r->radius[e + 1] - r->radius[e]);
}

/* M_nm = 2 pi (rho n H + coat) int R phi_n phi_m dR. */
static void set_mass(radial *r)
{
    const true_film *f = r->film;
    for (int spot = 0; spot < r->spots; spot++) {
        const int e = spot / RADIAL_PLACES;
        const shape *s = &r->at[spot % RADIAL_PLACES];
        const long double areal = f->density * f->layers * f->thickness + (electroded(r, e) ? f->coat : 0.0L);
        const long double weight = 2.0L * pi * areal * radius_at(r, spot) * width_at(r, spot);
        for (int i = 0; i < RADIAL_SHAPES; i++) {
            for (int j = 0; j < RADIAL_SHAPES; j++) {
                const int row = unknown(r, e, i), column = unknown(r, e, j);
                if (row >= 0 && column >= 0 && column <= row) {
                    r->mass[row][RADIAL_DEGREE + column - row] += weight * s->value[i] * s->value[j];
                }
            }
        }
    }
    r->mass[r->edge][RADIAL_DEGREE] += f->load_mass;
    r->heavy = f->density > 0.0L;
}

/* Width of the elements of a disc or annulus. */
static long double widest_of(long double width, long double rim, double fineness, int more)
{
    return width / (ceill(width * (long double)fineness / rim) + (long double)more);
}

bool radial_open(radial *r, const true_film *film, double fineness, int more)
{
    const long double edge = film->divide / film->prestretch, rim = film->frame / film->prestretch;
    memset(r, 0, sizeof *r);
    r->film = film;
    if (!cut(r, 0.0L, edge, widest_of(edge, rim, fineness, more), false)) {
        return false;
    }
    r->disc = r->elements;
    if (!cut(r, edge, rim, widest_of(rim - edge, rim, fineness, more), true)) {
        return false;
    }
    r->size = r->elements * RADIAL_DEGREE - 1;
    r->edge = r->disc * RADIAL_DEGREE - 1;
    r->spots = r->elements * RADIAL_PLACES;
    gauss_rule(RADIAL_PLACES, r->place, r->weight);
    for (int q = 0; q < RADIAL_PLACES; q++) {
        r->at[q] = shape_at(RADIAL_DEGREE, r->place[q]);
    }
    r->ends[0] = shape_at(RADIAL_DEGREE, -1.0L);
    r->ends[1] = shape_at(RADIAL_DEGREE, 1.0L);
    set_mass(r);
    return true;
}

/* ---- places */

static void strain_at(const radial *r, const long double *u, int e, const shape *s, long double radius, long double d[2])
{
    const long double scale = 2.0L / (r->radius[e + 1] - r->radius[e]);
    long double slope = 0.0L, value = 0.0L;
    for (int k = 0; k < RADIAL_SHAPES; k++) {
        const int at = unknown(r, e, k);
        const long double here = at < 0 ? 0.0L : u[at];
        slope += here * s->slope[k];
        value += here * s->value[k];
    }
    d[0] = scale * slope;
    d[1] = value / radius;
}

void radial_strain(const radial *r, const long double *u, int spot, long double d[2])
{
    strain_at(r, u, spot / RADIAL_PLACES, &r->at[spot % RADIAL_PLACES], radius_at(r, spot), d);
}

/* (U/H)^2, 0 without electrode. */
static long double square_at(const radial *r, int element, long double voltage)
{
    const long double nominal = voltage / r->film->thickness;
    return electroded(r, element) ? nominal * nominal : 0.0L;
}

/* S of an element's film at changes d of the stretches. */
static void stress_at(const radial *r, int element, const long double d[2], long double voltage, const long double sigma[2],
                      const long double x[2], long double s[2])
{
    const true_film *f = r->film;
    const long double l[2] = {f->prestretch + d[0], f->prestretch + d[1]}, area = l[0] * l[1];
    const long double square = square_at(r, element, voltage), pull = square > 0.0L ? square * film_electric(f, area).first * area : 0.0L;
    const true_stress skin = electroded(r, element) ? film_skin(f, d[0], d[1]) : (true_stress){0};
    for (int a = 0; a < 2; a++) {
        s[a] = (sigma[a] - f->tension * d[a] + x[a]) / l[a] + (a == 0 ? skin.p1 : skin.p2) - pull * l[1 - a];
    }
}

void radial_nominal(const radial *r, int spot, const long double d[2], long double voltage, const long double sigma[2],
                   const long double x[2], long double s[2])
{
    stress_at(r, spot / RADIAL_PLACES, d, voltage, sigma, x, s);
}

/* 2 pi n R dR/H times eps a^2. */
long double radial_capacitance(const radial *r, int spot, const long double d[2])
{
    const true_film *f = r->film;
    if (!electroded(r, spot / RADIAL_PLACES)) {
        return 0.0L;
    }
    const long double area = (f->prestretch + d[0]) * (f->prestretch + d[1]);
    return 2.0L * pi * f->layers / f->thickness * radius_at(r, spot) * width_at(r, spot) * film_electric(f, area).own * area * area;
}

void radial_pull(const radial *r, int spot, const long double s[2], long double *force)
{
    const int e = spot / RADIAL_PLACES;
    const shape *at = &r->at[spot % RADIAL_PLACES];
    const long double radius = radius_at(r, spot), scale = 2.0L / (r->radius[e + 1] - r->radius[e]);
    const long double unit = 2.0L * pi * r->film->layers * r->film->thickness * width_at(r, spot);
    const long double along = unit * radius * scale * s[0], across = unit * s[1];
    for (int k = 0; k < RADIAL_SHAPES; k++) {
        const int n = unknown(r, e, k);
        if (n >= 0) {
            force[n] += along * at->slope[k] + across * at->value[k];
        }
    }
}

/* ---- matrices */

/* Symmetric 2 x 2: 11, 12, 22 [Pa]. */
typedef struct tangent {
    long double t11, t12, t22;
} tangent;

/* dS_a/dlambda_b at constant x, and (1/lambda_a) dsigma_a/dlambda_b, at a place; false where there is no such film. */
static bool tangents_at(const radial *r, int spot, const long double d[2], long double voltage, const long double x[2],
                        tangent *elastic, tangent *viscous)
{
    const true_film *f = r->film;
    const int e = spot / RADIAL_PLACES;
    const long double l1 = f->prestretch + d[0], l2 = f->prestretch + d[1], area = l1 * l2;
    if (!(l1 > 0.0L && l2 > 0.0L)) {
        return false;
    }
    const true_stress p = film_stress(f, d[0], d[1]), skin = electroded(r, e) ? film_skin(f, d[0], d[1]) : (true_stress){0};
    const true_electric own = film_electric(f, area);
    const long double k = square_at(r, e, voltage);
    *viscous = (tangent){p.w11 + (f->tension + p.p1) / l1, p.w12, p.w22 + (f->tension + p.p2) / l2};
    *elastic = (tangent){p.w11 + skin.w11 - k * own.second * l2 * l2 - x[0] / (l1 * l1),
                         p.w12 + skin.w12 - k * (own.second + own.first) * area,
                         p.w22 + skin.w22 - k * own.second * l1 * l1 - x[1] / (l2 * l2)};
    return isfinite(elastic->t11) && own.own > 0.0L;
}

/* Adds the lever^T t lever of a place. */
static void assemble(const radial *r, int spot, const tangent *t, radial_band band)
{
    const int e = spot / RADIAL_PLACES;
    const shape *s = &r->at[spot % RADIAL_PLACES];
    const long double radius = radius_at(r, spot), scale = 2.0L / (r->radius[e + 1] - r->radius[e]);
    const long double unit = 2.0L * pi * r->film->layers * r->film->thickness * radius * width_at(r, spot);
    for (int i = 0; i < RADIAL_SHAPES; i++) {
        const int row = unknown(r, e, i);
        const long double b1 = scale * s->slope[i], b2 = s->value[i] / radius;
        const long double first = unit * (t->t11 * b1 + t->t12 * b2), second = unit * (t->t12 * b1 + t->t22 * b2);
        for (int j = 0; j < RADIAL_SHAPES && row >= 0; j++) {
            const int column = unknown(r, e, j);
            if (column >= 0 && column <= row) {
                band[row][RADIAL_DEGREE + column - row] += first * scale * s->slope[j] + second * s->value[j] / radius;
            }
        }
    }
}

bool radial_look_at(const radial *r, const long double *u, long double voltage, radial_pairs x, long double share, radial_look *look)
{
    static const long double none[2] = {0.0L, 0.0L};
    const true_film *f = r->film;
    memset(look, 0, sizeof *look);
    look->firmness = (long double)INFINITY;
    for (int spot = 0; spot < r->spots; spot++) {
        long double d[2];
        tangent elastic, viscous;
        radial_strain(r, u, spot, d);
        if (!tangents_at(r, spot, d, voltage, x ? x[spot] : none, &elastic, &viscous)) {
            return false;
        }
        assemble(r, spot, &elastic, look->elastic);
        assemble(r, spot, &viscous, look->viscous);
        look->firmness = fminl(look->firmness, elastic.t11 + share * viscous.t11);
        look->capacitance += radial_capacitance(r, spot, d);
        if (electroded(r, spot / RADIAL_PLACES)) {
            const long double l1 = f->prestretch + d[0], l2 = f->prestretch + d[1];
            const long double g = film_electric(f, l1 * l2).first * l1 * l2 / (f->thickness * f->thickness);
            const long double s[2] = {g * l2, g * l1};
            radial_pull(r, spot, s, look->push);
        }
    }
    look->elastic[r->edge][RADIAL_DEGREE] += f->load_stiffness;
    return true;
}

void radial_factor(const radial *r, const radial_look *look, radial_factors by, radial_system *system)
{
    system->definite = true;
    for (int i = 0; i < r->size; i++) {
        long double complex *row = system->band[i];
        const int first = i > RADIAL_DEGREE ? i - RADIAL_DEGREE : 0;
        for (int k = 0; k <= RADIAL_DEGREE; k++) {
            row[k] = by.elastic * look->elastic[i][k] + by.viscous * look->viscous[i][k] + by.inertia * r->mass[i][k];
        }
        row[RADIAL_DEGREE] += i == r->edge ? by.damper : 0.0L;
        for (int j = first; j < i; j++) {
            const long double complex *other = system->band[j];
            for (int k = j > RADIAL_DEGREE && j - RADIAL_DEGREE > first ? j - RADIAL_DEGREE : first; k < j; k++) {
                row[RADIAL_DEGREE + j - i] -= row[RADIAL_DEGREE + k - i] * other[RADIAL_DEGREE + k - j];
            }
        }
        for (int j = first; j < i; j++) {
            const long double complex product = row[RADIAL_DEGREE + j - i];
            row[RADIAL_DEGREE + j - i] = product / system->band[j][RADIAL_DEGREE];
            row[RADIAL_DEGREE] -= product * row[RADIAL_DEGREE + j - i];
        }
        system->definite = system->definite && creall(row[RADIAL_DEGREE]) > 0.0L;
    }
}

void radial_solve(const radial *r, const radial_system *system, long double complex *x)
{
    for (int i = 0; i < r->size; i++) {
        for (int j = i > RADIAL_DEGREE ? i - RADIAL_DEGREE : 0; j < i; j++) {
            x[i] -= system->band[i][RADIAL_DEGREE + j - i] * x[j];
        }
    }
    for (int i = r->size - 1; i >= 0; i--) {
        x[i] /= system->band[i][RADIAL_DEGREE];
        for (int k = i + 1; k < r->size && k <= i + RADIAL_DEGREE; k++) {
            x[i] -= system->band[k][RADIAL_DEGREE + i - k] * x[k];
        }
    }
}

void radial_solve_real(const radial *r, const radial_system *system, long double *x)
{
    long double complex y[RADIAL_MOST];
    for (int i = 0; i < r->size; i++) {
        y[i] = x[i];
    }
    radial_solve(r, system, y);
    for (int i = 0; i < r->size; i++) {
        x[i] = creall(y[i]);
    }
}

/* ---- equilibria */

/* Largest change of a stretch, over the pre-stretch. */
static long double largest_strain(const radial *r, const long double *u)
{
    long double most = 0.0L;
    for (int spot = 0; spot < r->spots; spot++) {
        long double d[2];
        radial_strain(r, u, spot, d);
        most = fmaxl(most, fmaxl(fabsl(d[0]), fabsl(d[1])));
    }
    return most / r->film->prestretch;
}

/* -F under a load, and x of branches that are held. */
static void residual_of(const radial *r, radial_load load, radial_pairs held, const long double *u, radial_pairs x, long double *out)
{
    const true_film *f = r->film;
    memset(out, 0, RADIAL_MOST * sizeof *out);
    for (int spot = 0; spot < r->spots; spot++) {
        long double d[2], s[2];
        jet own[2];
        radial_strain(r, u, spot, d);
        film_cauchy_along(f, d[0], d[1], 0.0L, 0.0L, own);
        const long double sigma[2] = {own[0].value, own[1].value};
        for (int a = 0; a < 2; a++) {
            x[spot][a] = held ? f->total_share * sigma[a] - held[spot][a] : 0.0L;
        }
        radial_nominal(r, spot, d, sqrtl(load.square), sigma, x[spot], s);
        s[0] = -s[0];
        s[1] = -s[1];
        radial_pull(r, spot, s, out);
    }
    out[r->edge] += load.force - f->load_stiffness * u[r->edge];
}

typedef struct still_work {
    radial_pairs x;
    radial_look look;
    radial_system system;
    long double step[RADIAL_MOST];
} still_work;

/* Newton's method over stable states. */
static bool newton(const radial *r, radial_load load, radial_pairs held, still_work *w, long double *u)
{
    const long double share = held ? r->film->total_share : 0.0L;
    long double last = (long double)INFINITY;
    for (int i = 0; i < NEWTON; i++) {
        residual_of(r, load, held, u, w->x, w->step);
        if (!radial_look_at(r, u, sqrtl(load.square), w->x, share, &w->look) || !(w->look.firmness > 0.0L)) {
            return false;
        }
        radial_factor(r, &w->look, (radial_factors){.elastic = 1.0L, .viscous = share}, &w->system);
        if (!w->system.definite) {
            return false;
        }
        radial_solve_real(r, &w->system, w->step);
        const long double size = largest_strain(r, w->step);
        if (!(size <= longest_change)) {
            return false;
        }
        for (int k = 0; k < r->size; k++) {
            u[k] += w->step[k];
        }
        if (size <= 1e-17L * largest_strain(r, u) || (size < 1e-11L && size >= 0.5L * last)) {
            return true;
        }
        last = size;
    }
    return last < 1e-13L;
}

bool radial_settle(const radial *r, radial_load from, radial_load to, radial_pairs held, long double *u)
{
    still_work *w = malloc(sizeof *w);
    long double next[RADIAL_MOST];
    bool found = w != NULL;
    for (long double at = 0.0L, step = 1.0L; found && at < 1.0L;) {
        const long double share = fminl(1.0L, at + step);
        const radial_load here = {from.square + share * (to.square - from.square), from.force + share * (to.force - from.force)};
        memcpy(next, u, sizeof next);
        if (newton(r, share < 1.0L ? here : to, held, w, next)) {
            memcpy(u, next, sizeof next);
            at = share;
            step *= 2.0L;
        } else {
            step *= 0.25L;
            found = step > shortest_load;
        }
    }
    free(w);
    return found;
}

bool radial_still(const radial *r, long double voltage, long double *u)
{
    const radial_load rest = {0}, pushed = {0.0L, r->film->load_force}, full = {voltage * voltage, r->film->load_force};
    memset(u, 0, RADIAL_MOST * sizeof *u);
    return radial_settle(r, rest, pushed, NULL, u) && radial_settle(r, pushed, full, NULL, u);
}

/* ---- rows */

typedef struct extremes {
    long double stress, area; /* smallest elastic stress, largest area stretch of the electroded film */
} extremes;

static void widen(const radial *r, const long double *u, long double voltage, int e, long double xi, extremes *x)
{
    static const long double none[2] = {0.0L, 0.0L};
    const true_film *f = r->film;
    const shape s = shape_at(RADIAL_DEGREE, xi);
    const long double radius = r->radius[e] + 0.5L * (1.0L + xi) * (r->radius[e + 1] - r->radius[e]);
    long double d[2], stress[2];
    jet own[2];
    if (!(radius > 0.0L)) {
        return;
    }
    strain_at(r, u, e, &s, radius, d);
    film_cauchy_along(f, d[0], d[1], 0.0L, 0.0L, own);
    const long double sigma[2] = {own[0].value, own[1].value};
    stress_at(r, e, d, voltage, sigma, none, stress);
    x->stress = fminl(x->stress, f->tension + fminl(stress[0], stress[1]));
    x->area = electroded(r, e) ? fmaxl(x->area, (f->prestretch + d[0]) * (f->prestretch + d[1])) : x->area;
}

/* 2 pi n H R_a times the electrical stress on the electroded side of the edge. */
static long double edge_force(const radial *r, const long double *u, long double voltage)
{
    const true_film *f = r->film;
    const int e = f->dot ? r->disc - 1 : r->disc;
    const long double edge = r->radius[r->disc];
    long double d[2];
    strain_at(r, u, e, &r->ends[f->dot ? 1 : 0], edge, d);
    const long double l2 = f->prestretch + d[1], area = (f->prestretch + d[0]) * l2;
    const long double stress = square_at(r, e, voltage) * film_electric(f, area).first * area * l2;
    return (f->dot ? 2.0L : -2.0L) * pi * f->layers * f->thickness * edge * stress;
}

dea_row radial_row(const radial *r, const long double *u, long double voltage, radial_margins *margins)
{
    const true_film *f = r->film;
    extremes x = {(long double)INFINITY, 0.0L};
    long double capacitance = 0.0L;
    for (int e = 0; e < r->elements; e++) {
        for (int g = 0; g <= GRID; g++) {
            widen(r, u, voltage, e, -1.0L + 2.0L * g / GRID, &x);
        }
    }
    for (int spot = 0; spot < r->spots; spot++) {
        long double d[2];
        radial_strain(r, u, spot, d);
        capacitance += radial_capacitance(r, spot, d);
    }
    const long double field = fabsl(voltage) / f->thickness * x.area;
    *margins = (radial_margins){(double)fabsl(x.stress / (fabsl(f->rest.w11) + fabsl(f->rest.w12))),
                                isinf(f->breakdown) ? (double)INFINITY : (double)fabsl(field / f->breakdown - 1.0L)};
    return film_state(f, (true_numbers){u[r->edge] / f->divide, edge_force(r, u, voltage), field, capacitance, voltage, x.stress > 0.0L});
}
