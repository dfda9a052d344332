#include "network/membrane.h"

#include <math.h>
#include <string.h>

#include "film/point.h"
#include "film/second.h"
#include "study/study.h"
#include "support/lapack.h"

static double given(double number)
{
    return isnan(number) ? 0.0 : number;
}

/* The second film has no electrodes of mass. */
static void add_second(const dea_scene *scene, const dea_rings *rings, dea_membrane *m)
{
    dea_scene other;
    dea_second_scene(scene, &other);
    for (size_t n = 0; n < rings->node_count; n++) {
        const size_t node = n == rings->edge ? m->rings.edge : m->rings.node_count + n - (n > rings->edge ? 1 : 0);
        m->masses[node] += m->heavy ? given(other.material.density) * m->second.point.film_thickness * rings->areas[n] : 0.0;
    }
    m->second.retardation = given(other.material.retardation);
}

static void set_masses(const dea_scene *scene, dea_membrane *m)
{
    const dea_point *point = &m->film.point;
    const double density = given(scene->material.density);
    const double electrode = dea_electrode_mass(scene);
    m->heavy = m->film.mass > 0.0;
    for (size_t n = 0; n < m->rings.node_count && m->heavy; n++) {
        m->masses[n] = density * point->film_thickness * m->rings.areas[n] +
                       electrode * point->film.square * m->rings.coated[n]; /* it lies on the pre-stretched film */
    }
    m->masses[m->rings.edge] += m->heavy ? dea_scene_edge(scene).mass : 0.0;
    if (point->second.there) {
        add_second(scene, &m->second.rings, m);
    }
}

const char dea_load_stalled[] = "a damper at the edge or of one film alone leaves the other nodes of the membrane without an equation of "
                                "motion: it takes material.density or material.retardation too, of both films";

bool dea_load_stalls(const dea_scene *scene)
{
    const bool damped = !isnan(scene->material.retardation);
    dea_scene other = *scene; /* borrows */
    if (scene->antagonist.there) {
        dea_second_scene(scene, &other);
    }
    return isnan(scene->material.density) && ((dea_scene_edge(scene).damping > 0.0 && !damped) || damped == isnan(other.material.retardation));
}

static bool is_first(const dea_membrane *m, size_t r)
{
    return r < m->rings.ring_count;
}

static const dea_point *point_at(const dea_membrane *m, size_t r)
{
    return is_first(m, r) ? &m->film.point : &m->second.point;
}

static const dea_film *film_at(const dea_membrane *m, size_t r)
{
    return &point_at(m, r)->film;
}

static double retardation_at(const dea_membrane *m, size_t r)
{
    return is_first(m, r) ? m->film.retardation : m->second.retardation;
}

static void cut(dea_rings_mesh mesh, dea_membrane *m)
{
    dea_rings_cut(&m->film.point, mesh, &m->rings);
    m->nodes = m->rings.node_count;
    if (m->film.point.second.there) {
        m->second.point = dea_point_second(&m->film.point);
        dea_rings_cut(&m->second.point, mesh, &m->second.rings);
        dea_rings_tie(&m->second.rings, m->nodes);
        m->nodes += m->second.rings.node_count - 1;
    }
    m->ring_total = m->rings.ring_count + m->second.rings.ring_count;
}

/* A ring without a node of its own, at the frame or where that is the edge it is tied to, takes any, with a hoop of 0. */
static void find_own(dea_membrane *m)
{
    for (size_t r = 0; r < m->ring_total; r++) {
        const dea_ring *ring = dea_membrane_ring(m, r);
        for (size_t i = 0; i < ring->count; i++) {
            m->own[r] = ring->hoop[i] != 0.0 ? i : m->own[r];
        }
    }
}

/* What a sheet is at rest, place by place. */
static void set_places(const dea_scene *scene, dea_membrane *m)
{
    dea_sheet *s = &m->sheet;
    const double layers = m->film.point.layers;
    const double both = scene->electrode.sheet_resistance * (4.0 * layers - 2.0) / (layers * layers);
    const bool dot = m->film.point.kind == DEA_DOT;
    double volume = 0.0;
    s->places = dot ? m->rings.mesh.disc : m->rings.mesh.annulus + 1; /* the disc has no ring at its centre */
    s->first = dot ? 0 : m->rings.mesh.disc;
    dea_rings_derivative(&m->rings, dot, s->gradient);
    for (size_t n = 0; n < s->places; n++) {
        volume += m->rings.rings[s->first + n].volume;
    }
    const double nominal = m->film.point.film.square / m->film.point.film_thickness; /* C = eps volume (lambda_pre^2/H)^2 at rest */
    const double first = scene->transient.logarithmic ? scene->transient.first : scene->transient.every;
    s->front = sqrt(4.0 * first * DEA_PI / (both * m->film.point.film.permittivity * volume * nominal * nominal));
    for (size_t n = 0; n < s->places; n++) {
        const double own = m->rings.rings[s->first + n].volume;
        s->conductance[n] = own / m->film.point.film_thickness / both;
        s->leak[n] = m->film.conductance * own / volume;
    }
}

/* Sets the sheet of a membrane whose film and rings are set; its series resistance becomes that of the drive alone. */
static void lay_sheet(const dea_scene *scene, dea_membrane *m)
{
    m->sheet = (dea_sheet){.front = (double)INFINITY};
    const bool currents = dea_study_of(scene)->timed || dea_study_of(scene)->phasors;
    if (currents && scene->electrode.sheet_resistance > 0.0 && !scene->reduction.series) {
        m->film.series = scene->drive.series_resistance > 0.0 ? scene->drive.series_resistance : 0.0;
        set_places(scene, m);
    }
    const size_t behind = m->film.series > 0.0 ? 1 : 0;
    m->sheet.charges = m->sheet.places > 0 ? m->sheet.places - 1 + behind : behind;
}

dea_status dea_membrane_open(const dea_scene *scene, const dea_model *model, dea_rings_mesh mesh, dea_membrane *m, dea_error *error)
{
    *m = (dea_membrane){0};
    const dea_status status = dea_dynamics_settle(scene, model, &m->film, error);
    if (status == DEA_OK) {
        cut(mesh, m);
        lay_sheet(scene, m);
        set_masses(scene, m);
        find_own(m);
    }
    return status;
}

static double square_of(const dea_point *point, double voltage)
{
    const double field = voltage / point->film_thickness;
    return point->film.permittivity * field * field; /* k [Pa] */
}

/* k of a ring. */
static double square_at(const dea_membrane *m, const dea_membrane_look *look, size_t r, double voltage)
{
    if (!is_first(m, r)) {
        const dea_point *point = &m->second.point;
        return dea_membrane_ring(m, r)->electroded ? look->beside * square_of(point, point->voltage) : 0.0;
    }
    return square_of(&m->film.point, dea_membrane_voltage(m, look, r, voltage));
}

/* lambda_pre (1 + e_a): stretches of a ring, and their changes from rest. */
static void strain_ring(const dea_membrane *m, size_t r, const double *u, double e[2])
{
    const dea_ring *ring = dea_membrane_ring(m, r);
    const double *at = u + ring->first;
    double sums[4] = {0.0}; /* one would wait for each of its terms */
    size_t i = 0;
    for (; i + 4 <= ring->count; i += 4) {
        for (size_t k = 0; k < 4; k++) {
            sums[k] += ring->radial[i + k] * at[i + k];
        }
    }
    for (; i < ring->count; i++) {
        sums[0] += ring->radial[i] * at[i];
    }
    e[0] = (sums[0] + sums[1]) + (sums[2] + sums[3]);
    e[1] = ring->hoop[m->own[r]] * at[m->own[r]];
    if (!is_first(m, r)) {
        e[0] += ring->tie[0] * u[m->rings.edge];
        e[1] += ring->tie[1] * u[m->rings.edge];
    }
}

/* The skin is elastic: no damper or branch follows its stresses. */
static void add_skin(const dea_point *point, const double e[2], dea_ring_look *at)
{
    dea_biaxial skin = {0};
    dea_point_coat(point, e[0], e[1], &skin);
    at->nominal[0] += skin.p1;
    at->nominal[1] += skin.p2;
    at->tangent[0][0] += skin.w11;
    at->tangent[0][1] += skin.w12;
    at->tangent[1][0] += skin.w12;
    at->tangent[1][1] += skin.w22;
}

/* Branches that are held add their share of S_a to the film's own. */
static void add_held(double held, dea_ring_look *at)
{
    for (int a = 0; a < 2; a++) {
        const double l = at->stretch[a], own = at->cauchy[a];
        at->nominal[a] += held * own / l;
        at->cauchy[a] *= 1.0 + held;
        for (int b = 0; b < 2; b++) {
            at->tangent[a][b] += held * (at->slope[a][b] - (a == b ? own / l : 0.0)) / l;
            at->slope[a][b] *= 1.0 + held;
        }
    }
}

/* S_a = lambda_a P_a + lambda_pre e_a P_0, of absolute stresses P_0 + P_a; dS_a/dlambda_b = lambda_a W_ab + (P_0 + P_a) where
 * a = b. */
static bool look_at_ring(const dea_membrane *m, size_t r, const double *u, dea_ring_look *at)
{
    const dea_film *film = film_at(m, r);
    const double l0 = film->prestretch;
    double e[2];
    strain_ring(m, r, u, e);
    if (!(e[0] > -1.0 && e[1] > -1.0)) {
        return false;
    }
    const dea_biaxial stress = dea_film_biaxial(film, e[0], e[1]);
    const double p[2] = {stress.p1, stress.p2};
    const double w[2][2] = {{stress.w11, stress.w12}, {stress.w12, stress.w22}};
    for (int a = 0; a < 2; a++) {
        const double l = at->stretch[a] = l0 * (1.0 + e[a]);
        at->nominal[a] = p[a];
        at->cauchy[a] = l * p[a] + l0 * e[a] * film->tension;
        for (int b = 0; b < 2; b++) {
            at->slope[a][b] = l * w[a][b] + (a == b ? film->tension + p[a] : 0.0);
            at->tangent[a][b] = w[a][b];
        }
    }
    if (m->film.held > 0.0 && is_first(m, r)) {
        add_held(m->film.held, at);
    }
    if (point_at(m, r)->skin_share > 0.0 && dea_membrane_ring(m, r)->electroded) {
        add_skin(&m->film.point, e, at);
    }
    return isfinite(at->nominal[0]) && isfinite(at->nominal[1]);
}

bool dea_membrane_look_at(const dea_membrane *m, const double *u, dea_membrane_look *look)
{
    const double thickness = m->film.point.film_thickness, unit = m->film.point.film.permittivity / (thickness * thickness);
    double sum = 0.0;
    for (size_t r = 0; r < m->ring_total; r++) {
        const dea_ring *ring = dea_membrane_ring(m, r);
        dea_ring_look *at = &look->rings[r];
        if (!look_at_ring(m, r, u, at)) {
            return false;
        }
        const double area = at->stretch[0] * at->stretch[1], own = dea_film_electric(film_at(m, r), area).own;
        const double content = ring->electroded && is_first(m, r) ? ring->volume * own * area * area : 0.0;
        if (!(own > 0.0)) {
            return false; /* there is no such film */
        }
        at->capacitance = unit * content;
        sum += content;
    }
    look->edge = u[m->rings.edge];
    look->capacitance = unit * sum;
    look->spread = false;
    look->beside = 1.0;
    return true;
}

/* Subtracts what nominal stresses f_a of one ring do to its nodes. */
static void pull_ring(const dea_membrane *m, size_t r, const double f[2], double *force)
{
    const dea_ring *ring = dea_membrane_ring(m, r);
    const double unit = ring->volume * film_at(m, r)->prestretch, radial = unit * f[0];
    double *at = force + ring->first;
    for (size_t i = 0; i < ring->count; i++) {
        at[i] -= radial * ring->radial[i];
    }
    at[m->own[r]] -= unit * f[1] * ring->hoop[m->own[r]];
    if (!is_first(m, r)) {
        force[m->rings.edge] -= radial * ring->tie[0] + unit * f[1] * ring->tie[1];
    }
}

void dea_membrane_pull(const dea_membrane *m, double (*f)[2], double *force)
{
    for (size_t r = 0; r < m->ring_total; r++) {
        pull_ring(m, r, f[r], force);
    }
}

/* Adds phi_n of one ring. */
static void push_ring(const dea_membrane *m, const dea_membrane_look *look, size_t r, double *push)
{
    const double *l = look->rings[r].stretch, k = square_of(&m->film.point, 1.0) * dea_film_electric(&m->film.point.film, l[0] * l[1]).first;
    const double f[2] = {-k * l[0] * l[1] * l[1], -k * l[0] * l[0] * l[1]};
    pull_ring(m, r, f, push);
}

void dea_membrane_push_ring(const dea_membrane *m, const dea_membrane_look *look, size_t r, double *push)
{
    memset(push, 0, m->nodes * sizeof *push);
    push_ring(m, look, r, push);
}

void dea_membrane_push(const dea_membrane *m, const dea_membrane_look *look, double *push)
{
    memset(push, 0, m->nodes * sizeof *push);
    for (size_t r = 0; r < m->rings.ring_count; r++) {
        if (m->rings.rings[r].electroded) {
            push_ring(m, look, r, push);
        }
    }
}

void dea_membrane_rates(const dea_membrane *m, const double *v, double (*rates)[2])
{
    for (size_t r = 0; r < m->ring_total; r++) {
        strain_ring(m, r, v, rates[r]);
        rates[r][0] *= film_at(m, r)->prestretch;
        rates[r][1] *= film_at(m, r)->prestretch;
    }
}

/* sum_i c_i (S_a - z_ai) of stress a of a ring. */
static double branch_stress(const dea_membrane *m, const dea_membrane_look *look, size_t r, int a, const double *z)
{
    const dea_dynamics *d = &m->film;
    const double *own = z + (2 * r + (size_t)a) * d->branch_count;
    double sum = 0.0;
    for (size_t i = 0; i < d->branch_count; i++) {
        sum += d->branches[i].share * (look->rings[r].cauchy[a] - own[i]);
    }
    return sum;
}

void dea_membrane_viscous(const dea_membrane *m, const dea_membrane_look *look, const double *v, const double *z, double (*x)[2])
{
    const bool damped = v && (m->film.retardation > 0.0 || m->second.retardation > 0.0);
    if (damped) {
        dea_membrane_rates(m, v, x);
    }
    for (size_t r = 0; r < m->ring_total; r++) {
        const dea_ring_look *at = &look->rings[r];
        const double tau = retardation_at(m, r);
        const double rates[2] = {damped ? x[r][0] : 0.0, damped ? x[r][1] : 0.0};
        for (int a = 0; a < 2; a++) {
            x[r][a] = tau * (at->slope[a][0] * rates[0] + at->slope[a][1] * rates[1]) + (z && is_first(m, r) ? branch_stress(m, look, r, a, z) : 0.0);
        }
    }
}

void dea_membrane_ring_stress(const dea_membrane *m, const dea_membrane_look *look, size_t r, double voltage, double s[2])
{
    const dea_ring_look *at = &look->rings[r];
    const double area = at->stretch[0] * at->stretch[1];
    const double pressure = square_at(m, look, r, voltage) * dea_film_electric(film_at(m, r), area).first * area;
    s[0] = at->nominal[0] - pressure * at->stretch[1];
    s[1] = at->nominal[1] - pressure * at->stretch[0];
}

void dea_membrane_force(const dea_membrane *m, const dea_membrane_look *look, double voltage, double (*x)[2], double *force)
{
    memset(force, 0, m->nodes * sizeof *force);
    for (size_t r = 0; r < m->ring_total; r++) {
        const dea_ring_look *at = &look->rings[r];
        double s[2];
        dea_membrane_ring_stress(m, look, r, voltage, s);
        for (int a = 0; a < 2; a++) {
            s[a] += x ? x[r][a] / at->stretch[a] : 0.0;
        }
        pull_ring(m, r, s, force);
    }
    force[m->rings.edge] += m->film.point.force - dea_point_spring(&m->film.point, look->edge).force;
}

/* ds_a/dlambda_b of a ring: of the film, of its electrical part k lambda_a lambda_b^2, of x_a/lambda_a at constant x_a, and of a
 * damper. */
static void ring_tangent(const dea_film *film, const dea_ring_look *at, double k, const double *x, double share, double t[2][2])
{
    const double area = at->stretch[0] * at->stretch[1];
    const dea_electric electric = dea_film_electric(film, area);
    for (int a = 0; a < 2; a++) {
        const double l = at->stretch[a];
        for (int b = 0; b < 2; b++) {
            const double other = at->stretch[1 - a];
            const double softening = a == b ? k * electric.second * other * other : k * (electric.first + electric.second) * area;
            const double lever = a == b && x ? x[a] / (l * l) : 0.0;
            t[a][b] = at->tangent[a][b] - softening - lever + share * at->slope[a][b] / l;
        }
    }
}

bool dea_membrane_elliptic(const dea_membrane *m, const dea_membrane_look *look, double voltage, double (*x)[2], double share)
{
    for (size_t r = 0; r < m->ring_total; r++) {
        double t[2][2];
        ring_tangent(film_at(m, r), &look->rings[r], square_at(m, look, r, voltage), x ? x[r] : NULL, is_first(m, r) ? share : 0.0, t);
        if (!(t[0][0] > 0.0)) {
            return false;
        }
    }
    return true;
}

/* What of that goes with the edge that a ring is tied to. */
static void tie_ring(const dea_membrane *m, const dea_ring *ring, size_t own, double unit, double t[2][2], double *matrix)
{
    const size_t n = m->nodes, edge = m->rings.edge;
    const double radial = unit * (t[0][0] * ring->tie[0] + t[0][1] * ring->tie[1]);
    const double hoop = unit * (t[0][1] * ring->tie[0] + t[1][1] * ring->tie[1]);
    for (size_t i = 0; i < ring->count; i++) {
        const double both = radial * ring->radial[i] + (i == own ? hoop * ring->hoop[i] : 0.0);
        matrix[edge * n + ring->first + i] += both;
        matrix[(ring->first + i) * n + edge] += both;
    }
    matrix[edge * (n + 1)] += radial * ring->tie[0] + hoop * ring->tie[1];
}

/* Adds lever^T t lever of one ring; t is symmetric. */
static void assemble_ring(const dea_membrane *m, size_t r, double t[2][2], double *matrix)
{
    const dea_ring *ring = dea_membrane_ring(m, r);
    const double l0 = film_at(m, r)->prestretch, unit = ring->volume * l0 * l0, hoop = ring->hoop[m->own[r]];
    const size_t n = m->nodes, own = m->own[r];
    double *block = matrix + ring->first * n + ring->first;
    for (size_t j = 0; j < ring->count; j++) {
        const double radial = unit * t[0][0] * ring->radial[j];
        for (size_t i = 0; i < ring->count; i++) {
            block[j * n + i] += ring->radial[i] * radial;
        }
        const double mixed = unit * t[0][1] * ring->radial[j] * hoop;
        block[own * n + j] += mixed;
        block[j * n + own] += mixed;
    }
    block[own * n + own] += unit * t[1][1] * hoop * hoop;
    if (!is_first(m, r)) {
        tie_ring(m, ring, own, unit, t, matrix);
    }
}

void dea_membrane_stiffness(const dea_membrane *m, const dea_membrane_look *look, double voltage, double (*x)[2], double share,
                            double *stiffness)
{
    memset(stiffness, 0, m->nodes * m->nodes * sizeof *stiffness);
    for (size_t r = 0; r < m->ring_total; r++) {
        double t[2][2];
        ring_tangent(film_at(m, r), &look->rings[r], square_at(m, look, r, voltage), x ? x[r] : NULL, is_first(m, r) ? share : 0.0, t);
        assemble_ring(m, r, t, stiffness);
    }
    stiffness[m->rings.edge * (m->nodes + 1)] += dea_point_spring(&m->film.point, look->edge).slope;
}

/* Of the rings from one number to another. */
static void add_damping(const dea_membrane *m, const dea_membrane_look *look, size_t from, size_t to, double share, double *damping)
{
    for (size_t r = from; r < to; r++) {
        const dea_ring_look *at = &look->rings[r];
        double t[2][2];
        for (int a = 0; a < 2; a++) {
            t[a][0] = share * at->slope[a][0] / at->stretch[a];
            t[a][1] = share * at->slope[a][1] / at->stretch[a];
        }
        assemble_ring(m, r, t, damping);
    }
}

void dea_membrane_damping(const dea_membrane *m, const dea_membrane_look *look, double share, double *damping)
{
    memset(damping, 0, m->nodes * m->nodes * sizeof *damping);
    add_damping(m, look, 0, m->rings.ring_count, share, damping);
}

void dea_membrane_damp_second(const dea_membrane *m, const dea_membrane_look *look, double pace, double *stiffness)
{
    add_damping(m, look, m->rings.ring_count, m->ring_total, pace * m->second.retardation, stiffness);
}

double dea_membrane_least_damper(const dea_membrane *m)
{
    return m->film.point.second.there ? fmin(m->film.retardation, m->second.retardation) : m->film.retardation;
}

void dea_membrane_relax(const dea_membrane *m, const dea_membrane_look *look, double *z)
{
    const size_t count = m->film.branch_count;
    for (size_t k = 0; k < 2 * m->rings.ring_count; k++) {
        for (size_t i = 0; i < count; i++) {
            z[k * count + i] = look->rings[k / 2].cauchy[k % 2];
        }
    }
}

/* ---- equilibria */

enum { MOST_ROUNDS = 30 };
static const double longest_step = 0.1;  /* of a strain in one round */
static const double shortest_load = 1e-9; /* step of the load, over its change: there the equilibrium ends */

/* Largest strain that goes with displacements. */
static double largest_strain(const dea_membrane *m, const double *u)
{
    double largest = 0.0;
    for (size_t r = 0; r < m->ring_total; r++) {
        double e[2];
        strain_ring(m, r, u, e);
        largest = fmax(largest, fmax(fabs(e[0]), fabs(e[1])));
    }
    return largest;
}

/* What grows: the voltage, or rather its square, and of that of the second film such a share. */
typedef struct load {
    double voltage, beside;
} load;

/* One round of Newton on F + remainder = 0 from u on; the size of its step as a strain, NAN where the film is not stable there. */
static double newton_round(const dea_membrane *m, load on, const double *z, const double *remainder, double *u)
{
    const size_t n = m->nodes;
    double x[DEA_MEMBRANE_RINGS][2], step[DEA_RINGS_NODES], stiffness[DEA_RINGS_NODES * DEA_RINGS_NODES];
    dea_membrane_look look;
    if (!dea_membrane_look_at(m, u, &look)) {
        return (double)NAN;
    }
    look.beside = on.beside;
    dea_membrane_viscous(m, &look, NULL, z, x);
    const double share = z ? m->film.total_share : 0.0;
    if (!dea_membrane_elliptic(m, &look, on.voltage, x, share)) {
        return (double)NAN;
    }
    dea_membrane_force(m, &look, on.voltage, x, step);
    dea_membrane_stiffness(m, &look, on.voltage, x, share, stiffness);
    for (size_t i = 0; i < n; i++) {
        step[i] += remainder[i];
    }
    if (dea_lapacke_dposv(LAPACK_COL_MAJOR, 'L', (lapack_int)n, 1, stiffness, (lapack_int)n, step, (lapack_int)n) != 0) {
        return (double)NAN;
    }
    const double size = largest_strain(m, step);
    for (size_t i = 0; i < n && size <= longest_step; i++) {
        u[i] += step[i];
    }
    return size <= longest_step ? size : (double)NAN;
}

/* Newton over stable states only. */
static bool newton(const dea_membrane *m, load on, const double *z, const double *remainder, double *u)
{
    double last = INFINITY;
    for (int i = 0; i < MOST_ROUNDS; i++) {
        const double size = newton_round(m, on, z, remainder, u);
        if (isnan(size)) {
            return false;
        }
        if (size <= 4e-16 * largest_strain(m, u) || (size < 1e-10 && size >= 0.5 * last)) {
            return true;
        }
        last = size;
    }
    return last <= 1e-12;
}

/* F at u [N]; false where the film cannot be there. */
static bool force_at(const dea_membrane *m, load on, const double *z, const double *u, double *force)
{
    double x[DEA_MEMBRANE_RINGS][2];
    dea_membrane_look look;
    if (!dea_membrane_look_at(m, u, &look)) {
        return false;
    }
    look.beside = on.beside;
    dea_membrane_viscous(m, &look, NULL, z, x);
    dea_membrane_force(m, &look, on.voltage, x, force);
    return true;
}

/* The load grows from what holds u now to that under a voltage and all of the second film's, in steps over stable states: squares of
 * voltages, and what F is short of at first. */
static bool follow(const dea_membrane *m, load from, double voltage, const double *z, double *u)
{
    const size_t n = m->nodes;
    const double before = from.voltage * from.voltage;
    double start[DEA_RINGS_NODES], remainder[DEA_RINGS_NODES], guess[DEA_RINGS_NODES];
    if (!force_at(m, from, z, u, start)) {
        return false;
    }
    for (double at = 0.0, step = 1.0; at < 1.0;) {
        const double next = fmin(1.0, at + step), square = before + next * (voltage * voltage - before);
        const load on = {next < 1.0 ? sqrt(square) : voltage, from.beside + next * (1.0 - from.beside)};
        for (size_t i = 0; i < n; i++) {
            remainder[i] = -(1.0 - next) * start[i];
            guess[i] = u[i];
        }
        if (newton(m, on, z, remainder, guess)) {
            memcpy(u, guess, n * sizeof *u);
            at = next;
            step *= 2.0;
        } else if ((step *= 0.25) < shortest_load) {
            return false;
        }
    }
    return true;
}

/* Square of the voltage that holds u best, with the branches where they are [V^2]: of F = F_0 + phi U^2 the least sum of squares. */
static double holding_square(const dea_membrane *m, const double *z, const double *u)
{
    double still[DEA_RINGS_NODES], push[DEA_RINGS_NODES], up = 0.0, down = 0.0;
    dea_membrane_look look;
    if (!force_at(m, (load){0.0, 1.0}, z, u, still) || !dea_membrane_look_at(m, u, &look)) {
        return 0.0;
    }
    dea_membrane_push(m, &look, push);
    for (size_t i = 0; i < m->nodes; i++) {
        up -= still[i] * push[i];
        down += push[i] * push[i];
    }
    return up > 0.0 ? up / down : 0.0;
}

bool dea_membrane_follow(const dea_membrane *m, double voltage, const double *z, double *u)
{
    return follow(m, (load){sqrt(holding_square(m, z, u)), 1.0}, voltage, z, u);
}

bool dea_membrane_still(const dea_membrane *m, double voltage, double *u)
{
    memset(u, 0, m->nodes * sizeof *u);
    if (dea_point_is_pulled(&m->film.point) && !follow(m, (load){0.0, 0.0}, 0.0, NULL, u)) {
        return false;
    }
    return follow(m, (load){0.0, 1.0}, voltage, NULL, u);
}

bool dea_membrane_modes(const dea_membrane *m, double *stiffness, double *frequencies, double *shapes)
{
    const size_t n = m->nodes;
    if (!m->heavy) {
        return false;
    }
    for (size_t j = 0; j < n; j++) {
        for (size_t i = 0; i < n; i++) {
            shapes[j * n + i] = 0.5 * (stiffness[j * n + i] + stiffness[i * n + j]) / sqrt(m->masses[i] * m->masses[j]);
        }
    }
    if (dea_lapacke_dsyev(LAPACK_COL_MAJOR, 'V', 'L', (lapack_int)n, shapes, (lapack_int)n, frequencies) != 0) {
        return false;
    }
    for (size_t k = 0; k < n; k++) {
        frequencies[k] = sqrt(fmax(0.0, frequencies[k]));
        for (size_t i = 0; i < n; i++) {
            shapes[k * n + i] /= sqrt(m->masses[i]);
        }
    }
    return true;
}

/* ---- rows */

/* F_DEA at the edge, outward: 2 pi R_a H times the electrical stress k lambda_1 lambda_2^2 of its electroded side [N]. */
static double edge_force(const dea_membrane *m, const dea_membrane_look *look, double voltage)
{
    const size_t inner = m->rings.mesh.disc - 1; /* the disc has no ring at its centre */
    const bool dot = m->film.point.kind == DEA_DOT;
    const size_t r = dot ? inner : inner + 1;
    const double *l = look->rings[r].stretch;
    return (dot ? 1.0 : -1.0) * 2.0 * DEA_PI * m->rings.rings[r].radius * m->film.point.film_thickness * square_at(m, look, r, voltage) *
           dea_film_electric(&m->film.point.film, l[0] * l[1]).first * l[0] * l[1] * l[1];
}

/* Largest of values at the rings of an element, between them too where it could pass a limit: a polynomial leaves the range of its
 * values at Lobatto's places by less than that range (Lebesgue constant below 3 up to degree 40). */
static double largest_up_to(const dea_rings *rings, bool disc, const double *values, double limit)
{
    double low = INFINITY, high = -INFINITY;
    for (size_t r = 0; r < rings->ring_count; r++) {
        const bool counts = rings->rings[r].disc == disc;
        low = counts ? fmin(low, values[r]) : low;
        high = counts ? fmax(high, values[r]) : high;
    }
    return high + (high - low) < limit ? high : dea_rings_largest(rings, disc, values, NULL);
}

/* Whether a film is in tension, and its largest lambda_1 lambda_2, of that of the ring under the peak of a voltage. */
static void find(const dea_membrane *m, const dea_membrane_look *look, const dea_rings *rings, double peak, double limit, dea_found *found)
{
    const size_t from = rings == &m->rings ? 0 : m->rings.ring_count;
    const dea_point *point = point_at(m, from);
    double loss[2][DEA_RINGS_MOST], area[DEA_RINGS_MOST], most = -INFINITY; /* of stresses */
    for (size_t r = 0; r < rings->ring_count; r++) {
        const dea_ring_look *at = &look->rings[from + r];
        double s[2];
        dea_membrane_ring_stress(m, look, from + r, peak, s);
        loss[0][r] = -s[0];
        loss[1][r] = -s[1];
        area[r] = at->stretch[0] * at->stretch[1];
        area[r] *= look->spread && peak > 0.0 && from == 0 ? fabs(dea_membrane_voltage(m, look, r, peak)) / peak : 1.0;
    }
    for (int i = 0; i < 4; i++) {
        most = fmax(most, largest_up_to(rings, i < 2, loss[i % 2], point->film.tension));
    }
    found->stretch = largest_up_to(rings, point->kind == DEA_DOT, area, limit);
    found->taut = point->film.tension > most;
}

/* A row has the state of the worse film, broken down or slack. */
static void fill_second(const dea_membrane *m, const dea_membrane_look *look, dea_row *row)
{
    const dea_point *point = &m->second.point;
    const double field = fabs(dea_point_nominal_field(point)) * point->layers;
    dea_found found = {.strain = look->edge / m->film.radius};
    dea_row other;
    find(m, look, &m->second.rings, 0.0, field > 0.0 ? point->film.breakdown / field : (double)INFINITY, &found);
    dea_row_fill(&other, point, found);
    row->second_field = other.field;
    if (other.state == DEA_STATE_BREAKDOWN || (other.state == DEA_STATE_SLACK && row->state == DEA_STATE_OK)) {
        row->state = other.state;
    }
}

void dea_membrane_fill(const dea_membrane *m, const dea_membrane_look *look, double peak, const double *u, double limit, dea_row *row)
{
    dea_point point = m->film.point;
    dea_found found = {.strain = u[m->rings.edge] / m->film.radius, .force = edge_force(m, look, peak), .capacitance = look->capacitance};
    find(m, look, &m->rings, peak, limit, &found);
    point.voltage = peak;
    dea_row_fill(row, &point, found);
    if (point.second.there) {
        fill_second(m, look, row);
    }
}

void dea_membrane_row(const dea_membrane *m, const dea_membrane_look *look, double voltage, const double *u, dea_row *row)
{
    dea_membrane_fill(m, look, voltage, u, -INFINITY, row);
}

static double dot(size_t n, const double *a, const double *b)
{
    double sum = 0.0;
    for (size_t i = 0; i < n; i++) {
        sum += a[i] * b[i];
    }
    return sum;
}

/* Slowest and fastest mode of a stiffness, which is lost. */
static bool find_modes(const dea_membrane *m, double *stiffness, dea_membrane_rest *rest)
{
    double frequencies[DEA_RINGS_NODES], shapes[DEA_RINGS_NODES * DEA_RINGS_NODES];
    if (!dea_membrane_modes(m, stiffness, frequencies, shapes)) {
        return false;
    }
    rest->slowest = frequencies[0];
    rest->fastest = frequencies[m->nodes - 1];
    return true;
}

bool dea_membrane_at_rest(const dea_membrane *m, dea_membrane_rest *rest)
{
    const size_t n = m->nodes, edge = m->rings.edge;
    double still[DEA_RINGS_NODES], stiffness[DEA_RINGS_NODES * DEA_RINGS_NODES], held[DEA_RINGS_NODES * DEA_RINGS_NODES];
    double push[DEA_RINGS_NODES], shape[DEA_RINGS_NODES], stiff[DEA_RINGS_NODES];
    dea_membrane_look look;
    *rest = (dea_membrane_rest){0};
    if (!dea_membrane_still(m, 0.0, still) || !dea_membrane_look_at(m, still, &look)) {
        return false;
    }
    dea_membrane_push(m, &look, push);
    memcpy(shape, push, sizeof shape);
    memcpy(stiff, push, sizeof stiff);
    dea_membrane_stiffness(m, &look, 0.0, NULL, 0.0, stiffness);
    dea_membrane_stiffness(m, &look, 0.0, NULL, m->film.total_share, held);
    const lapack_int size = (lapack_int)n;
    if ((m->heavy && !find_modes(m, held, rest)) ||
        dea_lapacke_dposv(LAPACK_COL_MAJOR, 'L', size, 1, stiffness, size, shape, size) != 0 ||
        dea_lapacke_dposv(LAPACK_COL_MAJOR, 'L', size, 1, held, size, stiff, size) != 0) {
        return false;
    }
    rest->compliance = fabs(shape[edge]);
    rest->softness = dot(n, push, stiff);
    rest->force = fabs(edge_force(m, &look, 1.0));
    rest->capacitance = look.capacitance;
    rest->capacitance_slope = 2.0 * dot(n, push, shape) / rest->compliance;
    return true;
}
