/* Exact axisymmetric membrane: by collocation (collocation.h) or, what that leaves, integrated in x = ln(R/R_a) by Gragg's midpoint
 * rule, extrapolated to order 14 on a fixed mesh.
 *
 * With D = lambda_2 - lambda_1 and e = lambda_2 - lambda_pre the equations of physics.md, section 3, read
 *
 *     de/dx = -D,   dD/dx = -D [ 1 + ((P2 - P1)/D + k lambda_1 lambda_2 + s12)/s11 ],
 *
 * which keeps the digits of a strain of any size: D and e scale with the load. The one condition is e = 0 at the frame. The
 * annulus of a lens has the capacitance (2 pi eps/H) int (lambda_1 lambda_2)^2 R dR; what of it lies within R is (2 pi eps/H) R^2 c,
 *
 *     dc/dx = (lambda_1 lambda_2)^2 - 2 c,   c = 0 at R_a.
 *
 * A permittivity that follows the strain puts its factors (dea_film_electric()) before k and the integrand of c.
 */

#include "model/path.h"
#include "model/field.h"

enum { GBS_COLUMNS = 7, ELLIPTIC_SAMPLES = 8 };

/* Longest step in x: the extrapolation error per step is then below 1e-13 of D, but for a film close to the loss of ellipticity,
 * where the step is halved until the last column of the extrapolation changes little. Where less than 1e-6 is wanted of the
 * result, the step shrinks with the 14th root, as the order has it, so that the result can be compared with itself on a finer
 * mesh. */
static const double longest_step = 0.35;
static const double shortest_step = 1e-3; /* of the longest: there the film ends */
static const double little = 1e-11;       /* of D */
static const double hundredth = 0.01; /* and of the accuracy: deep in slack the force follows the strain some twenty times, over steps */

static double step_for(double accuracy)
{
    return longest_step * fmin(1.0, pow(accuracy / 1e-6, 1.0 / 14.0));
}

typedef struct radial_state {
    double d; /* D = lambda_2 - lambda_1 */
    double e; /* lambda_2 - lambda_pre */
    double c; /* capacitance within R over 2 pi eps R^2/H */
} radial_state;

/* The boundary value problem at one load. */
typedef struct membrane {
    const dea_point *point;
    const dea_film *film;
    bool lens; /* the annulus is electroded */
    double disc_k;    /* Maxwell pressure in the disc: M of a dot, 0 of a lens [Pa] */
    double annulus_k; /* and in the annulus [Pa] */
    double length;    /* ln(1/B) */
    dea_field_mesh mesh;
} membrane;

/* What an integration collects for the limits of the film and the force on the edge. */
typedef struct extremes {
    double least_stress; /* smallest in-plane nominal stress [Pa] */
    double largest_area; /* largest lambda_1 lambda_2 of the electroded region [1] */
    double edge_force;   /* lambda_1 lambda_2^2 of the electroded side at R_a, over k the electrical stress [1] */
    double charge;       /* c at the frame [1] */
} extremes;

/* Stresses and moduli of the annulus, without what the voltage does, and of the disc. */
static dea_stress stress_at(const membrane *m, double l1, double l2)
{
    return m->lens ? dea_point_coated_stress(m->point, l1, l2) : m->film->law->stress(m->film->constants, l1, l2);
}

static dea_stress disc_stress(const membrane *m, double l)
{
    return m->lens ? m->film->law->stress(m->film->constants, l, l) : dea_point_coated_stress(m->point, l, l);
}

/* What the stress s1 of the annulus less that of the disc has of the skin, and of a load k at the edge, -k u/(2 pi R_a H). */
static double beside_jump(const membrane *m, double l, double d)
{
    const double e = l - m->film->prestretch;
    const double load = m->point->load * e / (2.0 * DEA_PI * m->point->film_thickness);
    return (m->lens ? dea_point_skin_rise(m->point, e - d, e) : -dea_point_skin_rise(m->point, e, e)) - load;
}

static radial_state slope_at(const membrane *m, radial_state s)
{
    const double l2 = m->film->prestretch + s.e, l1 = l2 - s.d, area = l1 * l2;
    const dea_stress stress = stress_at(m, l1, l2);
    const dea_electric electric = dea_film_electric(m->film, area);
    const double s11 = stress.w11 - m->annulus_k * electric.second * l2 * l2;
    const double s12 = stress.w12 - m->annulus_k * (electric.first + electric.second) * area;
    if (!(s11 > 0.0)) {
        return (radial_state){NAN, NAN, NAN}; /* loss of ellipticity: no such film is stable */
    }
    const double rate = 1.0 + (stress.shear + m->annulus_k * electric.first * area + s12) / s11;
    return (radial_state){-s.d * rate, -s.d, electric.own * area * area - 2.0 * s.c};
}

static radial_state moved(radial_state s, double by, radial_state way)
{
    return (radial_state){s.d + by * way.d, s.e + by * way.e, s.c + by * way.c};
}

/* Gragg's modified midpoint rule over one step with n substeps and its smoothing: the change from the start, which keeps the digits
 * that extrapolation costs. */
static radial_state midpoint(const membrane *m, radial_state start, radial_state slope, double step, int n)
{
    const double h = step / n;
    const radial_state none = {0.0, 0.0, 0.0};
    radial_state before = none, now = moved(none, h, slope);
    for (int i = 1; i < n; i++) {
        const radial_state next = moved(before, 2.0 * h, slope_at(m, moved(start, 1.0, now)));
        before = now;
        now = next;
    }
    return moved(none, 0.5, moved(moved(before, 1.0, now), h, slope_at(m, moved(start, 1.0, now))));
}

/* One step: midpoint rules with 2, 4, ... 14 substeps, extrapolated in h^2 (Neville). False: the step is too long. */
static bool advance(const membrane *m, radial_state start, double step, radial_state *end)
{
    radial_state row[GBS_COLUMNS];
    const radial_state slope = slope_at(m, start);
    double change = 0.0;
    for (int k = 0; k < GBS_COLUMNS; k++) {
        radial_state value = midpoint(m, start, slope, step, 2 * (k + 1));
        for (int j = 1; j <= k; j++) {
            const double ratio = (double)(k + 1) / (double)(k + 1 - j);
            const double weight = 1.0 / (ratio * ratio - 1.0);
            const radial_state last = row[j - 1], off = moved(value, -1.0, last);
            row[j - 1] = value;
            change = weight * fabs(off.d);
            value = moved(value, weight, off);
        }
        row[k] = value;
    }
    *end = moved(start, 1.0, row[GBS_COLUMNS - 1]);
    return change <= m->mesh.change * fabs(start.d);
}

/* s1 of the annulus less that of the disc, and of what a load holds [Pa]:
 * p1(l - D, l) - p1(l, l) + (k_d - k_o) l^3 + k_o D l^2, of k_d and k_o one is 0 */
static double jump_of_stress(const membrane *m, double l, double d)
{
    const double rise = m->film->law->rise(m->film->constants, l, -d, 0.0) + beside_jump(m, l, d);
    const double disc = m->disc_k * dea_film_electric(m->film, l * l).first * l * l * l;
    return rise + disc - m->annulus_k * dea_film_electric(m->film, (l - d) * l).first * (l - d) * l * l;
}

/* D on the annulus side of R_a from the continuity of s1 there; NAN where there is none. */
static double jump_at_edge(const membrane *m, double l)
{
    double sound = 0.0; /* last place within the energy */
    double d = 0.0;
    for (int i = 0; i < 80; i++) {
        const dea_stress here = stress_at(m, l - d, l);
        if (isnan(here.w11) && d != sound) { /* a step went past the end of the energy */
            d = 0.5 * (sound + d);
            continue;
        }
        sound = d;
        const double residual = jump_of_stress(m, l, d);
        const double s11 = here.w11 - m->annulus_k * dea_film_electric(m->film, (l - d) * l).second * l * l;
        const double most = 0.25 * (l - d); /* lambda_1 moves by a quarter at most: the first root from lambda_2 on is meant */
        const double step = s11 > 0.0 ? residual / s11 : copysign(most, residual);
        const double next = d + fmax(-most, fmin(most, step));
        const double change = fabs(next - d);
        d = next;
        if (change <= 1e-9 * fabs(d)) { /* quadratic */
            return s11 > 0.0 ? d : NAN;
        }
    }
    return NAN;
}

/* What limits the film at one place of the annulus, and its slopes over x: the slope of s1 is s2 - s1. */
typedef struct limits {
    double s1, s2, area;      /* [Pa], [1] */
    double s2_slope, area_slope;
} limits;

static limits limits_at(const membrane *m, radial_state s)
{
    const double l2 = m->film->prestretch + s.e, l1 = l2 - s.d, area = l1 * l2;
    const dea_electric electric = dea_film_electric(m->film, area);
    const double k = m->annulus_k * electric.first, k_slope = m->annulus_k * electric.second;
    const dea_stress stress = stress_at(m, l1, l2);
    const radial_state slope = slope_at(m, s);
    const double l2_slope = slope.e, l1_slope = slope.e - slope.d;
    return (limits){.s1 = stress.p1 - k * area * l2,
                    .s2 = stress.p2 - k * area * l1,
                    .area = area,
                    .s2_slope = (stress.w12 - (k + k_slope) * area) * l1_slope + (stress.w22 - k_slope * l1 * l1) * l2_slope,
                    .area_slope = l1_slope * l2 + l1 * l2_slope};
}

static void note(const membrane *m, limits at, extremes *x)
{
    x->least_stress = fmin(x->least_stress, fmin(at.s1, at.s2));
    if (m->annulus_k > 0.0) {
        x->largest_area = fmax(x->largest_area, at.area);
    }
}

static double area_slope(const limits *at)
{
    return at->area_slope;
}

static double hoop_slope(const limits *at)
{
    return -at->s2_slope;
}

/* Notes the largest value between two places a step apart of what has a slope there that changes its sign from + to -. (s1 is least
 * where it crosses s2, which is larger to one side of that.) */
static void note_between(const membrane *m, radial_state from, double step, limits ends[2], double (*slope)(const limits *),
                         extremes *x)
{
    double low = 0.0, high = step, rise = slope(&ends[0]), fall = slope(&ends[1]);
    for (int i = 0; i < 60 && rise > 0.0 && fall < 0.0 && high - low > 1e-9 * step; i++) {
        radial_state there;
        const double chord = low + (high - low) * rise / (rise - fall), middle = 0.5 * (low + high);
        const double at = i % 3 == 2 ? middle : fmin(fmax(chord, low + 1e-3 * (high - low)), high - 1e-3 * (high - low));
        if (!advance(m, from, at, &there)) {
            return;
        }
        const limits found = limits_at(m, there);
        const double value = slope(&found);
        note(m, found, x);
        *(value > 0.0 ? &low : &high) = at;
        *(value > 0.0 ? &rise : &fall) = value;
    }
}

/* Notes a step. */
static void note_step(const membrane *m, radial_state from, double step, radial_state to, extremes *x)
{
    limits ends[2] = {limits_at(m, from), limits_at(m, to)};
    note(m, ends[1], x);
    if (m->annulus_k > 0.0) {
        note_between(m, from, step, ends, area_slope, x);
    }
    note_between(m, from, step, ends, hoop_slope, x);
}

/* Integrates from the edge, where the disc has the stretch l = lambda_pre + edge and the annulus l - d, to the frame; returns e
 * there. x may be NULL. */
static double miss_from(const membrane *m, double edge, double d, extremes *x)
{
    const double l = m->film->prestretch + edge;
    radial_state s = {d, edge, 0.0};
    if (x) {
        const bool lens = m->annulus_k > 0.0;
        const double l1 = lens ? l - s.d : l, pull = dea_film_electric(m->film, l1 * l).first * l1 * l * l;
        *x = (extremes){disc_stress(m, l).p1 - m->disc_k * pull, l1 * l, pull, 0.0};
        note(m, limits_at(m, s), x);
    }
    const double longest = m->length / ceil(m->length / m->mesh.step);
    double step = longest;
    for (double rest = m->length; rest > 0.0;) {
        const double now = fmin(step, rest);
        radial_state next;
        if (!isfinite(s.d) || step < shortest_step * longest) {
            return NAN;
        }
        if (!advance(m, s, now, &next)) {
            step = 0.5 * now;
            continue;
        }
        if (x) {
            note_step(m, s, now, next, x);
        }
        s = next;
        rest = now < rest * (1.0 - 1e-12) ? rest - now : 0.0;
        step = fmin(longest, 2.0 * step);
    }
    if (x) {
        x->charge = s.c;
    }
    return s.e;
}

/* The same where nothing holds the edge but what the point says. */
static double miss_at_frame(const membrane *m, double edge, extremes *x)
{
    const double l = m->film->prestretch + edge;
    return l > 0.0 ? miss_from(m, edge, jump_at_edge(m, l), x) : NAN;
}

/* The same problem under a share of the load. */
static membrane under_load(const membrane *full, double share)
{
    membrane m = *full;
    m.disc_k *= share;
    m.annulus_k *= share;
    return m;
}

/* lambda_1 behind the edge under a share of the load; NAN where there is none. */
static double radial_stretch(const membrane *full, double share, double edge)
{
    const membrane m = under_load(full, share);
    const double l = full->film->prestretch + edge;
    return l - jump_at_edge(&m, l);
}

/* A place of the equilibrium: the edge, the share of the load that holds it, and lambda_1 behind the edge. */
typedef struct place {
    double edge, share, stretch;
} place;

/* True where s11 behind the edge stays above @p least on the straight way from one place to another. Where it does not, the film
 * ends between them (loss of ellipticity), and a root on the other side is not connected to rest. */
static bool stays_elliptic(const membrane *full, place from, place to, double least)
{
    for (int i = 1; i <= ELLIPTIC_SAMPLES; i++) {
        const double t = (double)i / ELLIPTIC_SAMPLES;
        const double l2 = full->film->prestretch + from.edge + t * (to.edge - from.edge);
        const double l1 = from.stretch + t * (to.stretch - from.stretch);
        const double k = full->annulus_k * (from.share + t * (to.share - from.share));
        if (!(stress_at(full, l1, l2).w11 - k * dea_film_electric(full->film, l1 * l2).second * l2 * l2 > least)) {
            return false;
        }
    }
    return true;
}

/* 1/(2 pi H n) of disc and annulus of bare film, and of what is beside them, skin and load [Pa]. */
static double bare_stiffness(const dea_point *point)
{
    const double b2 = point->coverage * point->coverage, q = (1.0 + b2) / (1.0 - b2);
    const dea_film *film = &point->film;
    return film->w11 + film->w12 + film->w11 * q - film->w12;
}

static double beside_stiffness(const dea_point *point)
{
    const double b2 = point->coverage * point->coverage, q = (1.0 + b2) / (1.0 - b2);
    const dea_film *skin = &point->skin;
    const double coat = point->kind == DEA_DOT ? skin->w11 + skin->w12 : skin->w11 * q - skin->w12;
    return (point->skin_share > 0.0 ? point->skin_share * coat : 0.0) + point->load / (2.0 * DEA_PI * point->film_thickness);
}

/* Strain of the linearised membrane (the model `lame`), NAN where it has pulled in. */
static double linear_guess(const dea_point *point, double m)
{
    const dea_film *film = &point->film;
    const bool dot = point->kind == DEA_DOT;
    const double b2 = point->coverage * point->coverage;
    const double softening = m * film->square * (dot ? 3.0 : (1.0 + b2) / (1.0 - b2) - 2.0);
    const double stiffness = bare_stiffness(point) + beside_stiffness(point) - softening;
    return stiffness > 0.0 ? dea_point_sign(point) * m * film->square * film->prestretch / stiffness : NAN;
}

/* Secant from the linear answer; true where it settles on a root so near to rest that no fold can lie between, nor an end of the
 * film: a small strain of a wide disc is a large one of the narrow annulus around it. */
static bool near_rest(const membrane *m, double guess, double *edge)
{
    double e0 = guess;
    double miss0 = miss_at_frame(m, e0, NULL);
    const double at_rest = 1.0 + beside_stiffness(m->point) / bare_stiffness(m->point); /* d(miss)/d(edge) */
    double slope = at_rest;
    double first_slope = slope;
    for (int i = 0; i < 12 && isfinite(miss0); i++) {
        const double step = -miss0 / slope;
        const double e1 = e0 + step;
        if (fabs(step) <= 1e-9 * fabs(e1)) { /* the error left is the product of the last two steps */
            *edge = e1;
            const double size = fabs(e1) / m->film->prestretch;
            const double softest = fmin(first_slope, slope) / at_rest; /* falls from 1 at rest to 0 at a fold */
            const place rest = {0.0, 0.0, m->film->prestretch};
            const place here = {e1, 1.0, radial_stretch(m, 1.0, e1)};
            return fmax(first_slope, slope) < 2.0 * at_rest && (softest > 0.4 ? size < 0.1 : softest > 0.1 && size < 0.05) &&
                   fabs(here.stretch - rest.stretch) < 0.5 * rest.stretch && stays_elliptic(m, rest, here, 0.1 * m->film->w11);
        }
        const double miss1 = miss_at_frame(m, e1, NULL);
        slope = (miss1 - miss0) / (e1 - e0);
        if (i == 0) {
            first_slope = slope;
        }
        e0 = e1;
        miss0 = miss1;
    }
    return false;
}

/* Largest miss of a root, over the edge: a bracket may also close on a share at which the miss jumps. */
static const double root_miss = 1e-6;

/* Share of the full load that holds the edge at @p edge, from @p guess; NAN where there is none. As the share grows, the miss
 * falls from that of a uniform film, @p edge, to 0; beyond some share there may be no film. Secant, with bisection where it
 * leaves the bracket or is slow. */
static double share_at(const membrane *full, double edge, double guess)
{
    double low = 0.0;
    double high = INFINITY;
    double last = 0.0;
    double miss_last = edge;
    double share = guess;
    for (int i = 0; i < 200; i++) {
        const membrane m = under_load(full, share);
        const double miss = miss_at_frame(&m, edge, NULL);
        *(miss * edge > 0.0 ? &low : &high) = share;
        double next = share - miss * (share - last) / (miss - miss_last);
        if (miss != 0.0 && (!(next > low && next < high) || (i > 12 && i % 2 == 1))) {
            next = isinf(high) ? 2.0 * share : 0.5 * (low + high);
        }
        if (fabs(next - share) <= 1e-13 * share) {
            return fabs(miss) <= root_miss * fabs(edge) ? next : NAN;
        }
        last = share;
        miss_last = miss;
        share = next;
    }
    return NAN;
}

/* 0 where the share is 1; bounded, because close to the end of the film the share grows beyond all measure. */
static double excess(double share)
{
    return (share - 1.0) / (share + 1.0);
}

/* Edge that the full load holds, between one that less holds and one that more does (Illinois variant of regula falsi on the
 * share); NAN where a share is not found. */
static double bracketed_edge(const membrane *full, double low, double share_low, double high, double share_high)
{
    double miss_low = excess(share_low);
    double miss_high = excess(share_high);
    double edge = high;
    for (int i = 0; i < 200 && fabs(miss_high) > 1e-14 && fabs(high - low) > 4e-16 * fabs(high); i++) {
        edge = (low * miss_high - high * miss_low) / (miss_high - miss_low);
        const double miss = excess(share_at(full, edge, 1.0));
        if (isnan(miss)) {
            return NAN;
        }
        if ((miss > 0.0) == (miss_high > 0.0)) {
            miss_low *= 0.5;
        } else {
            low = high;
            miss_low = miss_high;
        }
        high = edge;
        miss_high = miss;
    }
    return edge;
}

/* Largest share of the load between two edges (golden section); returns its edge. */
static double edge_of_largest_share(const membrane *full, double low, double high, double guess, double *largest)
{
    const double golden = 0.6180339887498949;
    double x1 = high - golden * (high - low);
    double x2 = low + golden * (high - low);
    double f1 = share_at(full, x1, guess);
    double f2 = share_at(full, x2, guess);
    for (int i = 0; i < 60 && fabs(high - low) > 1e-8 * fabs(high); i++) {
        if (f1 > f2 || isnan(f2)) {
            high = x2;
            x2 = x1;
            f2 = f1;
            x1 = high - golden * (high - low);
            f1 = share_at(full, x1, guess);
        } else {
            low = x1;
            x1 = x2;
            f1 = f2;
            x2 = low + golden * (high - low);
            f2 = share_at(full, x2, guess);
        }
    }
    *largest = fmax(f1, f2);
    return f1 > f2 ? x1 : x2;
}

/* Follows the equilibrium from rest in steps of the edge until the load is reached or falls again; false: pull-in. Where the film
 * ends, the steps become short and then end. */
static bool trace(const membrane *full, double sign, double end, double *edge)
{
    const double pre = full->film->prestretch;
    place before = {0.0, 0.0, pre};
    place last = before;
    const double longest = 0.03 * fmin(1.0, full->film->grows); /* a film near the end of its energy has no longer way */
    double step = longest;
    while (fabs(last.edge) < fabs(end) && step > 3e-4 * longest) {
        const double at = sign * fmin(fabs(end), fabs(last.edge) + step * (pre + fmax(0.0, last.edge)));
        const double share = share_at(full, at, last.share > 0.0 ? last.share * fabs(at / last.edge) : 0.1);
        const place here = {at, share, radial_stretch(full, share, at)};
        const bool connected = fabs(here.stretch - last.stretch) < 0.2 * last.stretch && stays_elliptic(full, last, here, 0.0);
        *edge = connected && share >= 1.0 ? bracketed_edge(full, last.edge, last.share, at, share) : NAN;
        if (isfinite(*edge)) {
            return true;
        }
        if (!connected || share >= 1.0) {
            step *= 0.5;
            continue;
        }
        if (!(share > last.share)) {
            double largest;
            const double top = edge_of_largest_share(full, before.edge, at, last.share, &largest);
            if (!(largest >= 1.0)) {
                return false;
            }
            *edge = bracketed_edge(full, before.edge, before.share, top, largest);
            return true;
        }
        before = last;
        last = here;
        step = fmin(longest, 1.5 * step);
    }
    return false;
}

/* The film of a point, with its Maxwell pressure M. */
static membrane membrane_of(const dea_point *point, double pressure, dea_field_mesh mesh)
{
    const bool dot = point->kind == DEA_DOT;
    return (membrane){point, &point->film, !dot, dot ? pressure : 0.0, dot ? 0.0 : pressure, -log(point->coverage), mesh};
}

/* A film whose edge is held under its load. */
typedef struct grip {
    const membrane *film;
    double edge;
} grip;

/* D behind the edge at a share of edge and load, where e = 0 at the frame: by secants from a guess; NAN where there is none. */
static double jump_from(void *user, double way, double d)
{
    enum { MOST = 60 };
    const grip *g = user;
    const membrane m = under_load(g->film, way);
    const double edge = way * g->edge;
    double d0 = 0.0;
    double miss0 = miss_from(&m, edge, d0, NULL);
    if (isnan(miss0)) { /* alike stretches at the edge can be past the end of the film where those of Lame's solution are not */
        d0 = 0.99 * d;
        miss0 = miss_from(&m, edge, d0, NULL);
    }
    for (int i = 0; i < MOST && d != d0; i++) {
        const double miss = miss_from(&m, edge, d, NULL);
        if (isnan(miss)) { /* past the end of the film */
            d = 0.5 * (d0 + d);
            continue;
        }
        const double step = miss == 0.0 ? 0.0 : -miss * (d - d0) / (miss - miss0);
        d0 = d;
        miss0 = miss;
        d += step;
        if (fabs(step) <= 1e-14 * fabs(d)) {
            return d;
        }
    }
    return d == d0 ? d : (double)NAN;
}

/* The same of the whole, from Lame's solution. */
static double jump_of_held(const membrane *m, double edge)
{
    grip g = {m, edge};
    return dea_path_reach(jump_from, &g, 2.0 * edge / (1.0 - m->point->coverage * m->point->coverage));
}

/* Integrates over a stretch of x in steps that are short enough. */
static bool advance_to(const membrane *m, double length, radial_state *s)
{
    double step = length;
    for (double rest = length; rest > 0.0;) {
        radial_state next;
        const double now = fmin(step, rest);
        if (!isfinite(s->d) || now < shortest_step * fmin(length, m->mesh.step)) {
            return false;
        }
        if (now > m->mesh.step || !advance(m, *s, now, &next)) {
            step = 0.5 * now;
            continue;
        }
        *s = next;
        rest = now < rest * (1.0 - 1e-12) ? rest - now : 0.0;
    }
    return isfinite(s->d);
}

bool dea_field_profile(const dea_point *point, double strain, size_t count, const double *x, dea_stretches *stretches)
{
    const double nominal = dea_point_nominal_field(point), pre = point->film.prestretch;
    const membrane m = membrane_of(point, point->film.permittivity * nominal * nominal, (dea_field_mesh){longest_step, 1e-13});
    const double edge = pre * strain;
    const bool pulled = dea_point_is_shared(point); /* what else acts on the edge is not looked at */
    radial_state s = {pulled ? jump_of_held(&m, edge) : jump_at_edge(&m, pre + edge), edge, 0.0};
    double last = 0.0;
    for (size_t i = 0; i < count; i++) {
        if (!advance_to(&m, x[i] - last, &s)) {
            return false;
        }
        last = x[i];
        stretches[i] = (dea_stretches){pre + s.e - s.d, pre + s.e};
    }
    return true;
}

/* From what an integration found of the film at an edge. */
static dea_found found_of(const dea_point *point, double edge, const extremes *x)
{
    const dea_film *film = &point->film;
    const double strain = edge / film->prestretch;
    /* (2 pi eps/H) (r/lambda_pre)^2 c */
    const double annulus = 2.0 * dea_point_full_capacitance(point) * x->charge / (film->square * film->square);
    return dea_field_found_in(point, (dea_field_found){.strain = strain,
                                             .edge_force = x->edge_force,
                                             .stretch = x->largest_area,
                                             .capacitance = point->kind == DEA_DOT ? dea_point_disc_capacitance(point, strain) : annulus,
                                             .taut = x->least_stress > 0.0});
}

/* What is found of the film where it meets the frame, on the line through an edge next to that and one beside it. From a small hole
 * in a wide annulus, whose edge moves the frame some 1/B^2 times as far, one ulp of the edge is many of what is found far from it: no
 * edge in double meets the frame, the line does. */
static bool finish(const membrane *m, double *edge, extremes *x)
{
    const double beside = 1e-7; /* of the edge */
    extremes other;
    const double miss = miss_at_frame(m, *edge, x);
    if (miss == 0.0 || isnan(miss)) {
        return miss == 0.0;
    }
    const double way = -miss / (miss_at_frame(m, *edge * (1.0 + beside), &other) - miss);
    if (fabs(way) <= 1.0) { /* not past the end of the film */
        *edge += way * beside * *edge;
        x->least_stress += way * (other.least_stress - x->least_stress);
        x->largest_area += way * (other.largest_area - x->largest_area);
        x->edge_force += way * (other.edge_force - x->edge_force);
        x->charge += way * (other.charge - x->charge);
    }
    return true;
}

void dea_field_solve(const dea_point *point, dea_field_mesh mesh, dea_row *row)
{
    const dea_film *film = &point->film;
    const bool dot = point->kind == DEA_DOT;
    const double nominal = dea_point_nominal_field(point);
    const double pressure = film->permittivity * nominal * nominal; /* M */
    const double b = point->coverage;
    const membrane m = membrane_of(point, pressure, mesh);
    const double sign = dea_point_sign(point);
    double edge = 0.0;

    if (pressure > 0.0 && !near_rest(&m, linear_guess(point, pressure), &edge)) {
        const double end = dot ? film->prestretch * (1.0 / b - 1.0) : -film->prestretch;
        if (!(film->w11 > 0.0) || !trace(&m, sign, end * (1.0 - 1e-9), &edge)) {
            dea_row_refuse(row, DEA_STATE_PULL_IN);
            return;
        }
    }
    extremes x;
    if (!finish(&m, &edge, &x)) {
        dea_row_refuse(row, DEA_STATE_FAILED);
        return;
    }
    dea_row_fill(row, point, found_of(point, edge, &x));
}

/* ---- a film whose edge is held */

/* What a film exerts on its edge, outward [N], and D there. */
static double force_on_edge(const membrane *m, double edge, double *d)
{
    *d = jump_of_held(m, edge);
    return dea_field_lever(m->point) * jump_of_stress(m, m->film->prestretch + edge, *d);
}

/* Without voltage, inward; and what the voltage adds, outward: all of it on the disc of a dot, whose annulus does not feel it. */
static double held_at(const membrane *full, const membrane *still, double edge, double *push, double *d)
{
    const double held = -force_on_edge(still, edge, d), l = full->film->prestretch + edge;
    *push = full->lens ? force_on_edge(full, edge, d) + held
                       : dea_field_lever(full->point) * full->disc_k * dea_film_electric(full->film, l * l).first * l * l * l;
    return held;
}

static bool hold(const dea_point *point, double strain, dea_hold *hold)
{
    const double nudge = 1e-5; /* of the stretch: slopes tell folds and steer Newton's steps, no digit hangs on them */
    const double nominal = dea_point_nominal_field(point), pre = point->film.prestretch, edge = pre * strain, step = pre * nudge;
    dea_point bare = *point;
    bare.load = 0.0;
    const dea_field_mesh mesh = {step_for(1e-9), little};
    const membrane full = membrane_of(&bare, point->film.permittivity * nominal * nominal, mesh), still = under_load(&full, 0.0);
    double d, side, above, below;
    extremes x;
    if (!(pre + edge > step)) {
        return false;
    }
    hold->held = held_at(&full, &still, edge, &hold->push, &d);
    hold->held_slope = hold->push_slope = 0.0;
    if (!hold->plain) {
        const double over = 0.5 / (step * dea_point_divide(point) / pre);
        const double up = held_at(&full, &still, edge + step, &above, &side), down = held_at(&full, &still, edge - step, &below, &side);
        hold->held_slope = (up - down) * over;
        hold->push_slope = (above - below) * over;
    }
    const bool there = isfinite(hold->held) && isfinite(hold->push) && isfinite(miss_from(&full, edge, d, &x));
    if (there) {
        hold->found = found_of(point, edge, &x);
    }
    return there;
}

/* By collocation where that is enough, else by integration. */
static void solve_many(const dea_point *points, size_t count, double accuracy, dea_row *rows)
{
    enum { CHUNK = 64 };
    const dea_field_mesh mesh = {step_for(accuracy), fmin(little, hundredth * accuracy)};
    for (size_t from = 0; from < count; from += CHUNK) {
        const size_t some = count - from < CHUNK ? count - from : CHUNK;
        bool solved[CHUNK];
        dea_collocation_solve(points + from, some, accuracy, rows + from, solved);
        for (size_t i = 0; i < some; i++) {
            if (!solved[i] || points[from + i].skin_share > 0.0 || points[from + i].load > 0.0) { /* collocation takes bare films */
                dea_field_solve(&points[from + i], mesh, &rows[from + i]);
            }
        }
    }
}

static void solve(const dea_point *point, double accuracy, dea_row *row)
{
    solve_many(point, 1, accuracy, row);
}

const dea_model dea_model_field = {
    .name = "field",
    .equation = "axisymmetric membrane",
    .leaves_out = "bending, all out of plane",
    .lens = true,
    .edge = true,
    .solve = solve,
    .solve_many = solve_many,
    .along = dea_field_profile,
    .hold = hold,
    .dynamic = true,
    .membrane = true,
    .stand_in = &dea_model_ring,
    .part = &(const dea_model_part){"_field", "the exact membrane as a network of rings, quasi-linear relaxation", false, 1e6, 1.0},
};
