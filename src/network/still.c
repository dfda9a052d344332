#include "network/still.h"

#include <float.h>
#include <math.h>
#include <string.h>

#include "film/point.h"

/* Share of the load that the first step from rest takes, and the least one: a fold then lies within it. */
static const double first_share = 0.25;
static const double least_share = 1e-9;

/* A step of the load is halved where Newton's corrections add up to more than so much of it: they may lead to another
 * equilibrium. */
static const double straight = 0.2;

enum { NEWTON_MOST = 12 };

void dea_still_open(const dea_point *point, dea_rings_mesh mesh, dea_still *still)
{
    const double nominal = dea_point_nominal_field(point);
    still->point = point;
    still->pressure = point->film.permittivity * nominal * nominal;
    dea_rings_cut(point, mesh, &still->rings);
}

/* What acts on a film at rest: a force on its edge, outward [N], and the voltage as M [Pa]. */
typedef struct action {
    double force, pressure;
} action;

static action whole(const dea_still *still)
{
    return (action){still->point->force, still->pressure};
}

/* Relative stretches of a ring. */
typedef struct strains {
    double e1, e2;
} strains;

static strains strains_of(const dea_ring *ring, const double *u)
{
    strains e = {0.0, 0.0};
    for (size_t i = 0; i < ring->count; i++) {
        e.e1 += ring->radial[i] * u[ring->first + i];
        e.e2 += ring->hoop[i] * u[ring->first + i];
    }
    return e;
}

/* Changes of s_a = P_a - k (lambda1 lambda2)^2/lambda_a from P_a at rest, and their slopes over the stretches; a permittivity that
 * follows the strain scales k (dea_film_electric()). */
static dea_biaxial stress_of(const dea_still *still, const dea_ring *ring, strains e, double pressure)
{
    const dea_film *film = &still->point->film;
    const double k = ring->electroded ? pressure : 0.0;
    const double l1 = film->prestretch * (1.0 + e.e1), l2 = film->prestretch * (1.0 + e.e2);
    const dea_electric electric = dea_film_electric(film, l1 * l2);
    const double first = k * electric.first, second = k * electric.second;
    dea_biaxial s = dea_film_biaxial(film, e.e1, e.e2);
    if (ring->electroded && still->point->skin_share > 0.0) {
        dea_point_coat(still->point, e.e1, e.e2, &s);
    }
    s.p1 -= first * l1 * l2 * l2;
    s.p2 -= first * l1 * l1 * l2;
    s.w11 -= second * l2 * l2;
    s.w12 -= (first + second) * l1 * l2;
    s.w22 -= second * l1 * l1;
    return s;
}

/* Forces of a ring against its nodes, negative, and its stiffness, lower triangle. */
static void add_ring(const dea_still *still, const dea_ring *ring, const dea_biaxial *s, size_t n, double *force, double *k)
{
    const double l0 = still->point->film.prestretch, v = ring->volume * l0;
    for (size_t i = 0; i < ring->count; i++) {
        const double d = ring->radial[i], h = ring->hoop[i];
        const double t1 = v * l0 * (d * s->w11 + h * s->w12), t2 = v * l0 * (d * s->w12 + h * s->w22);
        double *row = &k[(ring->first + i) * n + ring->first];
        force[ring->first + i] -= v * (d * s->p1 + h * s->p2);
        for (size_t j = 0; j <= i; j++) {
            row[j] += t1 * ring->radial[j] + t2 * ring->hoop[j];
        }
    }
}

/* L D L^T in place of the lower triangle; false at a pivot that is not positive. */
static bool factor(size_t n, double *k)
{
    for (size_t j = 0; j < n; j++) {
        for (size_t m = 0; m < j; m++) {
            k[j * n + j] -= k[j * n + m] * k[j * n + m] * k[m * n + m];
        }
        if (!(k[j * n + j] > 0.0)) {
            return false;
        }
        for (size_t i = j + 1; i < n; i++) {
            for (size_t m = 0; m < j; m++) {
                k[i * n + j] -= k[i * n + m] * k[j * n + m] * k[m * n + m];
            }
            k[i * n + j] /= k[j * n + j];
        }
    }
    return true;
}

static void solve(size_t n, const double *k, double *x)
{
    for (size_t i = 0; i < n; i++) {
        for (size_t m = 0; m < i; m++) {
            x[i] -= k[i * n + m] * x[m];
        }
    }
    for (size_t i = n; i-- > 0;) {
        x[i] /= k[i * n + i];
        for (size_t m = i + 1; m < n; m++) {
            x[i] -= k[m * n + i] * x[m];
        }
    }
}

/* Newton's step at @p u under an action, node_count values [m]. False where the stiffness matrix is not positive
 * definite (a pivot <= 0: the film is not stable), a ring has no stress or is no longer elliptic (ds_1/dlambda_1 <= 0); then @p step is undefined. */
static bool still_step(const dea_still *still, action under, const double *u, double *step)
{
    const size_t n = still->rings.node_count;
    double k[DEA_RINGS_NODES * DEA_RINGS_NODES];
    memset(k, 0, n * n * sizeof *k);
    memset(step, 0, n * sizeof *step);
    for (size_t q = 0; q < still->rings.ring_count; q++) {
        const dea_ring *ring = &still->rings.rings[q];
        const strains e = strains_of(ring, u);
        if (!(e.e1 > -1.0 && e.e2 > -1.0)) {
            return false;
        }
        const dea_biaxial s = stress_of(still, ring, e, under.pressure);
        if (!ring->disc && !(s.w11 > 0.0)) {
            return false; /* no longer elliptic: the film thins within a place, and no mesh tells how far (the disc stays uniform) */
        }
        add_ring(still, ring, &s, n, step, k);
    }
    const size_t edge = still->rings.edge;
    const dea_spring spring = dea_point_spring(still->point, u[edge]);
    step[edge] += under.force - spring.force;
    k[edge * n + edge] += spring.slope;
    if (!factor(n, k)) {
        return false;
    }
    solve(n, k, step);
    return true;
}

static double size_of(size_t n, const double *u)
{
    double most = 0.0;
    for (size_t i = 0; i < n; i++) {
        most = fmax(most, fabs(u[i]));
    }
    return most;
}

/* What is lost of the film's displacements [m] where a stiff load holds its edge: the stresses there are as large as ever. That of
 * the edge keeps its digits. */
static double rounding(const dea_still *still)
{
    return dea_point_is_loaded(still->point) ? 4.0 * DBL_EPSILON * still->point->frame_radius : 0.0;
}

/* Newton from @p u under an action; false where it does not settle within @p reach or on something stable. */
static bool settle(const dea_still *still, action under, double reach, double *u)
{
    const size_t n = still->rings.node_count;
    double step[DEA_RINGS_NODES], moved = 0.0, last = (double)INFINITY;
    for (int i = 0; i < NEWTON_MOST; i++) {
        if (!still_step(still, under, u, step)) {
            return false;
        }
        const double size = size_of(n, step);
        moved += size;
        if (!(moved <= reach)) {
            return false;
        }
        for (size_t m = 0; m < n; m++) {
            u[m] += step[m];
        }
        if (size <= 1e-15 * size_of(n, u) || (size >= 0.5 * last && size <= fmax(1e-11 * size_of(n, u), rounding(still)))) {
            return true;
        }
        last = size;
    }
    return false;
}

/* A way of equilibria: what acts grows evenly from one action to another. */
typedef struct way {
    action from, to;
} way;

static action action_at(const way *w, double share)
{
    return (action){w->from.force + share * (w->to.force - w->from.force), w->from.pressure + share * (w->to.pressure - w->from.pressure)};
}

/* Slope of the equilibrium over the share of the way: at an equilibrium Newton's step under a share more is that. */
static bool tangent(const dea_still *still, const way *w, double share, const double *u, double *slope)
{
    const double more = 1e-4;
    if (!still_step(still, action_at(w, share + more), u, slope)) {
        return false;
    }
    for (size_t i = 0; i < still->rings.node_count; i++) {
        slope[i] /= more;
    }
    return true;
}

/* Follows the equilibrium @p u along a way; false where it folds, or the film ends, before the end of it. */
static bool follow(const dea_still *still, way w, double *u)
{
    const size_t n = still->rings.node_count;
    double slope[DEA_RINGS_NODES], next[DEA_RINGS_NODES];
    double share = 0.0, step = first_share;
    if (w.from.force == w.to.force && w.from.pressure == w.to.pressure) {
        return still_step(still, w.from, u, slope);
    }
    while (share < 1.0 && step > least_share) {
        const double to = share + step < 1.0 ? share + step : 1.0;
        bool reached = tangent(still, &w, share, u, slope);
        for (size_t i = 0; i < n && reached; i++) {
            next[i] = u[i] + (to - share) * slope[i];
        }
        reached = reached && settle(still, action_at(&w, to), straight * (to - share) * size_of(n, slope), next);
        if (reached) {
            memcpy(u, next, n * sizeof *u);
            share = to;
        }
        step *= reached ? 2.0 : 0.5;
    }
    return share == 1.0;
}

dea_state dea_still_climb(const dea_still *still, double *u)
{
    const action rest = {0.0, 0.0}, alone = {still->point->force, 0.0};
    memset(u, 0, still->rings.node_count * sizeof *u);
    const bool stands = (alone.force == 0.0 || follow(still, (way){rest, alone}, u)) && follow(still, (way){alone, whole(still)}, u);
    return stands ? DEA_STATE_OK : DEA_STATE_PULL_IN;
}

/* Displacement of the edge that the force alone makes of a film that stays linear: beside it the edge's is a difference [m]. */
static double pulled(const dea_still *still)
{
    double u[DEA_RINGS_NODES] = {0.0}, step[DEA_RINGS_NODES];
    if (still->point->force == 0.0 || !still_step(still, (action){still->point->force, 0.0}, u, step)) {
        return 0.0;
    }
    return fabs(step[still->rings.edge]);
}

double dea_still_size(const dea_still *still, const double *u)
{
    return fmax(fabs(u[still->rings.edge]), pulled(still));
}

double dea_still_strain(const dea_still *still, const double *u)
{
    double most = pulled(still) / dea_point_divide(still->point);
    for (size_t q = 0; q < still->rings.ring_count; q++) {
        const strains e = strains_of(&still->rings.rings[q], u);
        most = fmax(most, fmax(fabs(e.e1), fabs(e.e2)));
    }
    return most;
}

/* Energies of the displacement u in the stiffness at u and in that at rest without load. */
bool dea_still_near(const dea_still *still, const double *u)
{
    double now = 0.0, rest = 0.0, most = 0.0;
    if (still->point->force != 0.0) {
        return false; /* the force alone may have led further */
    }
    for (size_t q = 0; q < still->rings.ring_count; q++) {
        const dea_ring *ring = &still->rings.rings[q];
        const strains e = strains_of(ring, u);
        const dea_biaxial s = stress_of(still, ring, e, still->pressure);
        now += ring->volume * (s.w11 * e.e1 * e.e1 + 2.0 * s.w12 * e.e1 * e.e2 + s.w22 * e.e2 * e.e2);
        const dea_biaxial bare = stress_of(still, ring, (strains){0.0, 0.0}, 0.0);
        rest += ring->volume * (bare.w11 * (e.e1 * e.e1 + e.e2 * e.e2) + 2.0 * bare.w12 * e.e1 * e.e2);
        most = fmax(most, fmax(fabs(e.e1), fabs(e.e2)));
    }
    return most < 0.15 && now > 0.5 * rest && now < 2.0 * rest;
}


/* Radial strain of a ring from its radial stress: a derivative of polynomials at the end of an element is the least exact of
 * their numbers, a stress that follows from the balance of forces is as exact as the displacement. */
static double radial_strain(const dea_still *still, const dea_ring *ring, strains guess, double stress)
{
    for (int i = 0; i < NEWTON_MOST; i++) {
        const dea_biaxial s = stress_of(still, ring, guess, still->pressure);
        const double step = (stress - s.p1) / (s.w11 * still->point->film.prestretch);
        guess.e1 += step;
        if (!(fabs(step) > 1e-15)) {
            break;
        }
    }
    return guess.e1;
}

/* Strains of all rings. Across r_a the radial stress goes on, but for what a load takes there, 2 pi H A [s_1] = K(u), and
 * d(R s_1)/dR = s_2 takes it to the frame; s_1 and s_2 may be changes from rest, which holds itself. */
static void strains_all(const dea_still *still, const double *u, strains *e)
{
    const dea_rings *rings = &still->rings;
    const double thickness = still->point->film_thickness;
    double moment = 0.0, stress = 0.0; /* R s_1, s_1 */
    for (size_t q = 0; q < rings->ring_count; q++) {
        const dea_ring *ring = &rings->rings[q];
        e[q] = strains_of(ring, u);
        const dea_biaxial s = stress_of(still, ring, e[q], still->pressure);
        if (ring->disc) {
            stress = s.p1;
            moment = ring->radius * stress;
            continue;
        }
        const bool edge = rings->rings[q - 1].disc, frame = q + 1 == rings->ring_count;
        const double outside = dea_point_spring(still->point, u[rings->edge]).force - still->point->force;
        const double held = edge ? outside / (2.0 * DEA_PI * thickness) : 0.0;
        stress += held * still->point->film.prestretch / dea_point_divide(still->point);
        moment += held + ring->volume / (2.0 * DEA_PI * ring->radius * thickness) * s.p2;
        if (edge || frame) {
            e[q].e1 = radial_strain(still, ring, e[q], edge ? stress : moment / ring->radius);
        }
    }
}

/* The two rings at r_a: the electroded one. */
static size_t electrode_edge(const dea_rings *rings)
{
    size_t q = 0;
    while (q + 2 < rings->ring_count && rings->rings[q + 1].disc) {
        q++;
    }
    return rings->rings[q].electroded ? q : q + 1;
}

/* C = C_rest + (eps/H^2) sum of volume ((lambda_1 lambda_2)^2 - lambda_pre^4), electroded: at rest no mesh is asked. Of the
 * displacements as they are: an integral is the best of their numbers. */
static double capacitance(const dea_still *still, const double *u)
{
    const dea_point *point = still->point;
    const double square = point->film.square;
    double sum = 0.0;
    for (size_t q = 0; q < still->rings.ring_count; q++) {
        const dea_ring *ring = &still->rings.rings[q];
        const strains e = strains_of(ring, u);
        const double more = e.e1 + e.e2 + e.e1 * e.e2; /* lambda_1 lambda_2/lambda_pre^2 - 1 */
        const double own = dea_film_electric(&point->film, square * (1.0 + more)).own;
        sum += ring->electroded ? ring->volume * (own * more * (2.0 + more) + (own - 1.0)) : 0.0;
    }
    return dea_point_capacitance(point) + point->film.permittivity * sum * square * square / (point->film_thickness * point->film_thickness);
}

/* Fills the row; returns the largest loss of tension over the film [Pa]. */
static double fill(const dea_still *still, const double *u, dea_row *row)
{
    const dea_point *point = still->point;
    const dea_film *film = &point->film;
    const double strain = u[still->rings.edge] / dea_point_divide(point);
    double radial[DEA_RINGS_MOST], hoop[DEA_RINGS_MOST], area[DEA_RINGS_MOST]; /* stresses below that at rest */
    strains e[DEA_RINGS_MOST];
    strains_all(still, u, e);
    for (size_t q = 0; q < still->rings.ring_count; q++) {
        const dea_biaxial s = stress_of(still, &still->rings.rings[q], e[q], still->pressure);
        radial[q] = -s.p1;
        hoop[q] = -s.p2;
        area[q] = film->square * (1.0 + e[q].e1) * (1.0 + e[q].e2);
    }
    const dea_rings *rings = &still->rings;
    const double slack = fmax(radial[0], fmax(dea_rings_largest(rings, false, radial, NULL), dea_rings_largest(rings, false, hoop, NULL)));
    const strains *edge = &e[electrode_edge(&still->rings)];
    const double stretched = film->square * (1.0 + edge->e1) * (1.0 + edge->e2);
    const double pull = stretched * (1.0 + edge->e2) * dea_film_electric(film, stretched).first; /* lambda_1 lambda_2^2/lambda_pre */
    const double force = 2.0 * DEA_PI * point->film_thickness * still->pressure * pull * dea_point_divide(point);
    dea_row_fill(row, point,
                 (dea_found){.strain = strain,
                             .force = dea_point_sign(point) * force,
                             .stretch = point->kind == DEA_DOT ? area[0] : dea_rings_largest(rings, false, area, NULL),
                             .capacitance = capacitance(still, u),
                             .taut = film->tension > slack}); /* the disc is uniform */
    return slack;
}

static double relative(double a, double b)
{
    return a == b ? 0.0 : fabs(a - b) / fabs(b);
}

/* Of strains: over what the force alone makes, where that is more. */
static double apart(const dea_still *still, double a, double b)
{
    return a == b ? 0.0 : fabs(a - b) / fmax(fabs(b), pulled(still) / dea_point_divide(still->point));
}

double dea_still_apart(const dea_still *coarse, const double *u, const dea_still *fine, const double *v, dea_row *row)
{
    double better[DEA_RINGS_NODES];
    dea_row other;
    if (!still_step(fine, whole(fine), v, better)) {
        return INFINITY;
    }
    for (size_t n = 0; n < fine->rings.node_count; n++) {
        better[n] += v[n];
    }
    const double lost = fill(coarse, u, row), finer = fill(fine, better, &other);
    const double worst = fmax(fmax(apart(fine, row->strain, other.strain), relative(row->force, other.force)),
                              fmax(relative(row->field, other.field), relative(row->capacitance, other.capacitance)));
    return row->state == other.state ? worst : fmax(worst, relative(lost, finer)); /* of two states the stress must tell */
}

/* A row may be off by several times what the strain is: the mesh is chosen by the strain, and by this share of the row. */
static const double row_share = 0.15;

/* Of a mesh at its solution by one of so many degrees more: Newton's step of the edge, relative, or what it makes of the row. */
static double finer_error(const dea_still *still, const double *u, size_t more)
{
    const dea_rings_mesh mesh = still->rings.mesh;
    double matrix[DEA_RINGS_NODES * DEA_RINGS_NODES], v[DEA_RINGS_NODES], step[DEA_RINGS_NODES];
    dea_row row;
    dea_still fine;
    dea_still_open(still->point, (dea_rings_mesh){mesh.disc, mesh.annulus + more, mesh.logarithmic}, &fine);
    dea_rings_transfer(mesh, fine.rings.mesh, matrix);
    dea_rings_move(matrix, still->rings.node_count, u, fine.rings.node_count, v);
    if (!still_step(&fine, whole(&fine), v, step)) {
        return INFINITY;
    }
    return fmax(fabs(step[fine.rings.edge]) / dea_still_size(&fine, v), row_share * dea_still_apart(still, u, &fine, v, &row));
}

/* By two: errors of meshes that converge slowly rise and fall with the degree, and two of them may agree by chance. */
double dea_still_error(const dea_still *still, const double *u)
{
    return still->pressure == 0.0 && still->point->force == 0.0 ? 0.0 : fmax(finer_error(still, u, 1), finer_error(still, u, 2));
}

/* Meshes of which none has an equilibrium, each finer than the last, and the degree from which on such a row of them is believed: finer
 * ones take long to say the same. */
enum { ALL_LOST = 8, LOST_DEGREE = 12 };

dea_rings_mesh dea_still_mesh(const dea_point *point, double accuracy, double *error)
{
    const dea_rings_mesh none = {0, 0, true};
    double u[DEA_RINGS_NODES];
    size_t lost = 0;
    *error = (double)INFINITY;
    for (size_t degree = 2; degree + 2 <= DEA_RINGS_DEGREE && !(lost >= ALL_LOST && degree > LOST_DEGREE); degree++) {
        dea_still still;
        dea_still_open(point, (dea_rings_mesh){1, degree, true}, &still);
        const bool stands = dea_still_climb(&still, u) == DEA_STATE_OK;
        lost = stands ? 0 : lost + 1;
        if (stands) {
            *error = dea_still_error(&still, u);
        }
        if (*error <= accuracy) {
            return still.rings.mesh;
        }
    }
    return none;
}
