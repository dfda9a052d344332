/* The exact membrane of physics.md, section 3, by its energy: with x = ln(R/R_a) and e = lambda_2 - lambda_pre,
 *
 *     lambda_2 = lambda_pre + e,   lambda_1 = lambda_pre + e + de/dx,
 *     Pi/(2 pi n H R_a^2) = 1/2 [W - k lambda^4/2]_disc + int e^(2x) [W - k lambda_1^2 lambda_2^2/2] dx + loads at the edge,
 *
 * e by polynomials on elements of the annulus. The equilibrium is followed from 0 V as the load grows (tangent, then Newton). It
 * is stable as long as all pivots of the second derivative are positive; the last one is what a force on the edge would feel, and
 * where it vanishes the branch folds. All in long double; stresses are changes from the pre-stretched film, so that a strain of
 * any size keeps its digits. */
#include "truths.h"

#include <math.h>
#include <stdlib.h>

#include "legendre.h"

enum { DEGREE = 12, SHAPES = DEGREE + 1, PLACES = DEGREE + 2, MOST_ELEMENTS = 64, MOST = MOST_ELEMENTS * DEGREE, NEWTON = 8 };

static const long double pi = 3.14159265358979323846264338327950288L;
static const long double longest_step = 0.05L; /* change of a stretch in one step of the load */
static const long double trusted = 0.3L;       /* share of the tangent's change that Newton may correct */
static const long double settled = 1e-17L;     /* last change of a stretch over the largest */
static const long double rounds = 1e-13L;      /* the same where changes no longer shrink: rounding */
static const long double shortest = 1e-11L;    /* step of the load at which a fold is where the branch stands */
static const long double widest = 0.35L;       /* element to begin with, in ln R */
static const double good = 1e-14;              /* relative change of a row from one mesh to the next */
static const long double lost = 1e-3L;         /* share of the stiffness at rest below which it counts as gone */

typedef struct membrane {
    const true_film *film;
    long double load;   /* (U/H)^2 at full voltage [V^2/m^2] */
    bool steady;        /* the steady force on the edge grows, without voltage */
    long double width;  /* of an element, in x */
    int elements, size; /* unknowns, from the frame to the edge */
    shape at[PLACES];
    long double place[PLACES], weight[PLACES];
    long double stiffness[MOST][DEGREE + 1]; /* row i: columns i - DEGREE ... i */
    long double force[MOST], pull[MOST];     /* dPi/de and its derivative over the share of what grows */
    shape begin;                             /* at -1, the end of an element towards the edge */
    long double least_s11;                   /* smallest over places and begins [Pa] */
} membrane;

typedef struct tension {
    long double s1, s2; /* less the stress of the film at rest [Pa] */
    long double s11, s12, s22;
} tension;

/* ---- shapes */

static void set_places(membrane *m)
{
    gauss_rule(PLACES, m->place, m->weight);
    for (int i = 0; i < PLACES; i++) {
        m->at[i] = shape_at(DEGREE, m->place[i]);
    }
    m->begin = shape_at(DEGREE, -1.0L);
}

/* Unknown of a shape of an element, -1 at the frame. Element 0 lies at the frame, and x runs from the edge. */
static int unknown(int element, int number)
{
    const int far = element * DEGREE - 1; /* the end towards the frame */
    return number == 1 ? far : number == 0 ? far + DEGREE : far + number - 1;
}

/* ---- stresses */

/* At lambda_pre + d1, lambda_pre + d2, of disc or annulus, where it is electroded under (U/H)^2 = k. */
static tension tension_at(const true_film *f, bool disc, long double k, long double d1, long double d2)
{
    const long double l1 = f->prestretch + d1, l2 = f->prestretch + d2, area = l1 * l2;
    const true_stress p = film_stress(f, d1, d2);
    if (disc != f->dot) {
        return (tension){p.p1, p.p2, p.w11, p.w12, p.w22};
    }
    const true_stress skin = film_skin(f, d1, d2);
    const true_electric e = film_electric(f, area);
    return (tension){p.p1 + skin.p1 - k * e.first * area * l2,
                     p.p2 + skin.p2 - k * e.first * area * l1,
                     p.w11 + skin.w11 - k * e.second * l2 * l2,
                     p.w12 + skin.w12 - k * (e.first + e.second) * area,
                     p.w22 + skin.w22 - k * e.second * l1 * l1};
}

/* e, de/dx and its derivative at a place of an element. */
typedef struct strain {
    long double e, slope, curve;
} strain;

static strain strain_at(const membrane *m, const long double *e, int element, const shape *s)
{
    const long double scale = 2.0L / m->width;
    strain sum = {0.0L, 0.0L, 0.0L};
    for (int k = 0; k < SHAPES; k++) {
        const int at = unknown(element, k);
        const long double here = at < 0 ? 0.0L : e[at];
        sum.e += here * s->value[k];
        sum.slope += here * s->slope[k] * scale;
        sum.curve += here * s->curve[k] * scale * scale;
    }
    return sum;
}

/* ---- energy */

/* No film where a stretch is none, or the energy has ended. */
static void note_ellipticity(membrane *m, long double l1, long double l2, long double s11)
{
    const bool is_film = l1 > 0.0L && l2 > 0.0L && !isnan(s11);
    m->least_s11 = is_film ? fminl(m->least_s11, s11) : -(long double)INFINITY;
}

/* Of a place of the annulus. */
static void add_place(membrane *m, int element, int place, const long double *e, long double k)
{
    const shape *s = &m->at[place];
    const long double x = m->width * (m->elements - element - 0.5L + 0.5L * m->place[place]), scale = 2.0L / m->width;
    const long double weight = 0.5L * m->width * m->weight[place] * expl(2.0L * x);
    const strain here = strain_at(m, e, element, s);
    const long double d2 = here.e, d1 = here.e + here.slope, l1 = m->film->prestretch + d1, l2 = m->film->prestretch + d2;
    const tension t = tension_at(m->film, false, k, d1, d2);
    const long double drive = m->film->dot || m->steady ? 0.0L : m->load * film_electric(m->film, l1 * l2).first;
    note_ellipticity(m, l1, l2, t.s11);
    for (int i = 0; i < SHAPES; i++) {
        const int row = unknown(element, i);
        const long double b2 = s->value[i], b1 = b2 + scale * s->slope[i];
        const long double first = weight * (t.s11 * b1 + t.s12 * b2), second = weight * (t.s12 * b1 + t.s22 * b2);
        if (row < 0) {
            continue;
        }
        m->force[row] += weight * (t.s1 * b1 + t.s2 * b2);
        m->pull[row] -= weight * drive * l1 * l2 * (l2 * b1 + l1 * b2);
        for (int j = 0; j < SHAPES; j++) {
            const int column = unknown(element, j);
            if (column >= 0 && column <= row) {
                m->stiffness[row][DEGREE + column - row] += first * (s->value[j] + scale * s->slope[j]) + second * s->value[j];
            }
        }
    }
}

/* Derivatives of the energy at a share of what grows: of the voltage's square or, while that is 0, of the steady force. */
static void derive(membrane *m, const long double *e, long double share)
{
    const true_film *f = m->film;
    const int edge = m->size - 1;
    const long double k = m->steady ? 0.0L : share * m->load;
    for (int i = 0; i < m->size; i++) {
        m->force[i] = m->pull[i] = 0.0L;
        for (int j = 0; j <= DEGREE; j++) {
            m->stiffness[i][j] = 0.0L;
        }
    }
    m->least_s11 = (long double)INFINITY;
    for (int i = 0; i < m->elements; i++) {
        const strain end = strain_at(m, e, i, &m->begin);
        const long double l2 = f->prestretch + end.e;
        note_ellipticity(m, l2 + end.slope, l2, tension_at(f, false, k, end.e + end.slope, end.e).s11);
        for (int q = 0; q < PLACES; q++) {
            add_place(m, i, q, e, k);
        }
    }
    const tension t = tension_at(f, true, k, e[edge], e[edge]);
    const long double l = f->prestretch + e[edge], whole = 2.0L * pi * f->layers * f->thickness, radius = f->divide / f->prestretch;
    const long double push = f->load_force / (whole * radius); /* u = R_a e */
    m->force[edge] += t.s1 + f->load_stiffness / whole * e[edge] - (m->steady ? share : 1.0L) * push;
    m->stiffness[edge][DEGREE] += t.s11 + t.s12 + f->load_stiffness / whole;
    m->pull[edge] -= m->steady ? push : f->dot ? m->load * film_electric(f, l * l).first * l * l * l : 0.0L;
}

/* L D L^T within the band, in place; false where a pivot is not positive. The last pivot is the stiffness of the edge. */
static bool factor(membrane *m)
{
    for (int i = 0; i < m->size; i++) {
        long double *row = m->stiffness[i];
        const int first = i > DEGREE ? i - DEGREE : 0;
        for (int j = first; j < i; j++) {
            const long double *other = m->stiffness[j];
            for (int k = j > DEGREE && j - DEGREE > first ? j - DEGREE : first; k < j; k++) {
                row[DEGREE + j - i] -= row[DEGREE + k - i] * other[DEGREE + k - j];
            }
        }
        for (int j = first; j < i; j++) {
            const long double product = row[DEGREE + j - i];
            row[DEGREE + j - i] = product / m->stiffness[j][DEGREE];
            row[DEGREE] -= product * row[DEGREE + j - i];
        }
        if (!(row[DEGREE] > 0.0L)) {
            return false;
        }
    }
    return true;
}

static void solve(const membrane *m, long double *x)
{
    for (int i = 0; i < m->size; i++) {
        for (int j = i > DEGREE ? i - DEGREE : 0; j < i; j++) {
            x[i] -= m->stiffness[i][DEGREE + j - i] * x[j];
        }
    }
    for (int i = m->size - 1; i >= 0; i--) {
        x[i] /= m->stiffness[i][DEGREE];
        for (int k = i + 1; k < m->size && k <= i + DEGREE; k++) {
            x[i] -= m->stiffness[k][DEGREE + i - k] * x[k];
        }
    }
}

/* ---- the branch from rest */

/* Largest change of a stretch, relative to the pre-stretch. */
static long double largest(const membrane *m, const long double *change)
{
    long double most = 0.0L;
    for (int i = 0; i < m->elements; i++) {
        for (int q = 0; q < PLACES; q++) {
            const strain s = strain_at(m, change, i, &m->at[q]);
            most = fmaxl(most, fmaxl(fabsl(s.e), fabsl(s.e + s.slope)));
        }
    }
    return most / m->film->prestretch;
}

static bool is_stable(membrane *m)
{
    return m->least_s11 > 0.0L && factor(m);
}

/* Newton's method at a share of the load from @p e on; false where a change goes past @p most, or stability is lost. */
static bool settle(membrane *m, long double share, long double most, long double *e)
{
    long double last = most;
    for (int i = 0; i < NEWTON; i++) {
        long double change[MOST];
        derive(m, e, share);
        if (!is_stable(m)) {
            return false;
        }
        for (int k = 0; k < m->size; k++) {
            change[k] = -m->force[k];
        }
        solve(m, change);
        const long double now = largest(m, change), size = largest(m, e);
        const bool rounding = i > 0 && now <= rounds * size && now > 0.25L * last;
        if (!(now <= most) && !rounding) {
            return false;
        }
        for (int k = 0; k < m->size; k++) {
            e[k] += change[k];
        }
        if (now <= settled * size || rounding) {
            return true;
        }
        most = 0.5L * now;
        last = now;
    }
    return false;
}

typedef enum end { AT_LOAD, FOLDED, LOST } end;

/* Follows the equilibrium from none to all of what grows. */
static end follow(membrane *m, long double *e)
{
    long double share = 0.0L, ahead = 1.0L, tangent[MOST], next[MOST];
    derive(m, e, 0.0L);
    const long double s11_at_rest = m->least_s11;
    if (!is_stable(m)) {
        return FOLDED;
    }
    const long double stiffness_at_rest = m->stiffness[m->size - 1][DEGREE];
    while (share < 1.0L) {
        derive(m, e, share);
        const long double s11 = m->least_s11;
        if (!is_stable(m)) {
            return LOST;
        }
        const long double stiffness = m->stiffness[m->size - 1][DEGREE];
        for (int i = 0; i < m->size; i++) {
            tangent[i] = -m->pull[i];
        }
        solve(m, tangent);
        const long double rate = largest(m, tangent);
        long double step = 2.0L * fminl(fminl(1.0L - share, ahead), longest_step / rate);
        do {
            step *= 0.5L;
            if (step < shortest * share || step < 1e-30L) {
                return stiffness < lost * stiffness_at_rest || s11 < lost * s11_at_rest ? FOLDED : LOST;
            }
            for (int i = 0; i < m->size; i++) {
                next[i] = e[i] + step * tangent[i];
            }
        } while (!settle(m, share + step, trusted * step * rate, next));
        for (int i = 0; i < m->size; i++) {
            e[i] = next[i];
        }
        share = step < 1.0L - share ? share + step : 1.0L;
        ahead = 2.0L * step;
    }
    return AT_LOAD;
}

/* ---- what a row says */

/* Smallest stress over disc and annulus, largest area stretch of the annulus. */
typedef struct extremes {
    long double stress, area;
} extremes;

/* d(lambda_1 lambda_2)/dx. */
static long double area_slope(const membrane *m, const strain *s)
{
    const long double l2 = m->film->prestretch + s->e, l1 = l2 + s->slope;
    return (s->slope + s->curve) * l2 + l1 * s->slope;
}

static void widen(const membrane *m, const strain *s, long double k, extremes *x)
{
    const long double l2 = m->film->prestretch + s->e, l1 = l2 + s->slope;
    const tension t = tension_at(m->film, false, k, s->e + s->slope, s->e);
    x->area = fmaxl(x->area, l1 * l2);
    x->stress = fminl(x->stress, m->film->tension + fminl(t.s1, t.s2));
}

/* Over a grid of places, and where the area is largest between two of them. */
static extremes extremes_of(const membrane *m, const long double *e)
{
    enum { GRID = 16 };
    const true_film *f = m->film;
    const long double k = m->load, edge = e[m->size - 1];
    extremes x = {f->tension + tension_at(f, true, k, edge, edge).s1, 0.0L};
    for (int i = 0; i < m->elements; i++) {
        for (int g = 0; g < GRID; g++) {
            long double low = -1.0L + 2.0L * g / GRID, high = -1.0L + 2.0L * (g + 1) / GRID;
            shape s = shape_at(DEGREE, low);
            strain here = strain_at(m, e, i, &s);
            widen(m, &here, k, &x);
            const bool rises = area_slope(m, &here) > 0.0L;
            for (int n = 0; rises && n < 64; n++) {
                const long double middle = 0.5L * (low + high);
                s = shape_at(DEGREE, middle);
                here = strain_at(m, e, i, &s);
                *(area_slope(m, &here) > 0.0L ? &low : &high) = middle;
            }
            s = shape_at(DEGREE, high);
            here = strain_at(m, e, i, &s);
            widen(m, &here, k, &x);
        }
    }
    return x;
}

/* eps times the area of the deformed film over its thickness there, (2 pi n/H) int eps (lambda_1 lambda_2)^2 R dR [F]. */
static long double capacitance_of(const membrane *m, const long double *e)
{
    const true_film *f = m->film;
    const long double radius = f->divide / f->prestretch, disc = f->prestretch + e[m->size - 1];
    long double sum = f->dot ? 0.5L * film_electric(f, disc * disc).own * disc * disc * disc * disc : 0.0L;
    for (int i = 0; i < m->elements && !f->dot; i++) {
        for (int q = 0; q < PLACES; q++) {
            const long double x = m->width * (m->elements - i - 0.5L + 0.5L * m->place[q]);
            const strain s = strain_at(m, e, i, &m->at[q]);
            const long double area = (f->prestretch + s.e) * (f->prestretch + s.e + s.slope);
            sum += 0.5L * m->width * m->weight[q] * expl(2.0L * x) * film_electric(f, area).own * area * area;
        }
    }
    return 2.0L * pi * f->layers / f->thickness * radius * radius * sum;
}

static dea_row row_at(const membrane *m, const long double *e, long double voltage)
{
    const true_film *f = m->film;
    const long double l = f->prestretch, edge = e[m->size - 1], disc = l + edge, sign = f->dot ? 1.0L : -1.0L;
    const strain behind = strain_at(m, e, m->elements - 1, &m->begin);
    const extremes x = extremes_of(m, e);
    const long double field = fabsl(voltage) / f->thickness * (f->dot ? disc * disc : x.area);
    const long double radial = f->dot ? disc : disc + behind.slope; /* of the electroded side */
    const long double stress = m->load * film_electric(f, radial * disc).first * radial * disc * disc;
    const long double force = sign * 2.0L * pi * f->layers * f->thickness * (f->divide / l) * stress;
    return film_state(f, (true_numbers){edge / l, force, field, capacitance_of(m, e), voltage, x.stress > 0.0L});
}

/* ---- meshes */

static void set_mesh(membrane *m, int elements)
{
    m->elements = elements;
    m->size = elements * DEGREE;
    m->width = -logl(m->film->divide / m->film->frame) / elements;
}

/* Halves all elements, and takes what is known with it: the slopes of the shapes are orthonormal polynomials. */
static void halve_elements(membrane *m, long double *e)
{
    membrane *const coarse = malloc(sizeof *coarse);
    long double known[MOST];
    if (!coarse) {
        return;
    }
    *coarse = *m;
    for (int i = 0; i < m->size; i++) {
        known[i] = e[i];
    }
    set_mesh(m, 2 * m->elements);
    for (int i = 0; i < m->elements; i++) {
        const long double middle = i % 2 == 0 ? 0.5L : -0.5L; /* of the halves, the first lies towards the frame */
        const shape begin = shape_at(DEGREE, middle - 0.5L);
        e[unknown(i, 0)] = strain_at(coarse, known, i / 2, &begin).e;
        for (int n = 2; n < SHAPES; n++) {
            long double sum = 0.0L;
            for (int q = 0; q < PLACES; q++) {
                const shape there = shape_at(DEGREE, middle + 0.5L * m->place[q]);
                sum += m->weight[q] * m->at[q].slope[n] * strain_at(coarse, known, i / 2, &there).slope * 0.5L * m->width;
            }
            e[unknown(i, n)] = sum;
        }
    }
    free(coarse);
}

static dea_row pulled_in(void)
{
    dea_row row = dea_row_failed();
    row.state = DEA_STATE_PULL_IN;
    return row;
}

static double relative(double a, double b)
{
    return a == b ? 0.0 : fabs(a - b) / fabs(b);
}

static double gap(const dea_row *a, const dea_row *b)
{
    return fmax(fmax(relative(a->strain, b->strain), relative(a->capacitance, b->capacitance)),
                fmax(relative(a->field, b->field), relative(a->force, b->force)));
}

/* Halves the elements under the full load until the row no longer changes; infinite: it does not come to that. */
static double refine(membrane *m, long double *e, long double voltage, dea_row *row)
{
    double error = (double)INFINITY;
    *row = row_at(m, e, voltage);
    while (2 * m->elements <= MOST_ELEMENTS && !(error < good)) {
        const dea_row coarse = *row;
        halve_elements(m, e);
        if (!settle(m, 1.0L, 1.0L, e)) {
            return (double)INFINITY;
        }
        *row = row_at(m, e, voltage);
        error = 1e-16 + gap(&coarse, row);
    }
    return error;
}

true_row membrane_truth(const true_film *film, long double voltage)
{
    membrane *m = calloc(1, sizeof *m);
    const long double nominal = voltage / film->thickness, length = -logl(film->divide / film->frame);
    true_row truth = {.row = pulled_in(), .error = (double)INFINITY};
    if (!m) {
        return truth;
    }
    m->film = film;
    m->load = nominal * nominal;
    set_places(m);
    end last = LOST;
    for (int n = 2 + (int)(length / widest); 2 * n <= MOST_ELEMENTS && isinf(truth.error); n *= 2) {
        long double e[MOST] = {0.0L};
        set_mesh(m, n);
        m->steady = true;
        end reached = film->load_force != 0.0L ? follow(m, e) : AT_LOAD;
        m->steady = false;
        reached = reached == AT_LOAD ? follow(m, e) : reached;
        if (reached == AT_LOAD) {
            truth.error = refine(m, e, voltage, &truth.row);
        } else if (reached == FOLDED && last == FOLDED) { /* on two meshes */
            truth = (true_row){pulled_in(), 1e-16};
        }
        last = reached;
    }
    free(m);
    return truth;
}
