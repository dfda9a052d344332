/* Natural modes: small motion about the equilibrium under a bias.
 *
 * Of the membrane, on rings of film (physics: section 7): K phi = w^2 M phi with the relaxed stiffness K at constant film voltage,
 * and with damper, branches and the charge behind a series resistance the roots of
 *
 *   D(s) x = 0,   D = s^2 M + K + (tau_KV s + sum_i c_i s tau_i/(1 + s tau_i)) V + (2 U)^2/C s/(s + q) phi phi^T,
 *
 * V = sum of the slopes of the Cauchy stresses on their levers, phi = (1/2) dC/du, q = (1/R_s + 1/R_p)/C; dampers of a load and of
 * a second film add s times theirs. In the coordinates of
 * the undamped modes M is 1 and K diagonal; each root is followed from +i w as V and phi phi^T grow from nothing. The mesh is refined
 * until no number moves by more than the accuracy. A film with one node has one mode, in the shape of Lame that its mass has. */
#include "engine/direct/direct.h"

#include <complex.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "network/membrane.h"
#include "network/swing.h"
#include "support/lapack.h"

enum { STEP = 2, FEW = 4, NEWTON_MOST = 30 };

/* Share of V's growth that a step may come down to, and share of |s| below which the root reaches the real axis. */
static const double least_growth = 1e-4, overdamped = 0.05;

typedef struct film {
    dea_membrane membrane;
    double voltage;               /* across the film [V] */
    double u[DEA_RINGS_NODES];    /* equilibrium [m] */
    size_t count;                 /* n, nodes and modes */
    double w[DEA_RINGS_NODES];    /* [rad/s] */
    double shapes[DEA_RINGS_NODES * DEA_RINGS_NODES];  /* mode after mode [kg^-1/2] */
    double viscous[DEA_RINGS_NODES * DEA_RINGS_NODES]; /* V in modal coordinates [1/s^2] */
    double beside[DEA_RINGS_NODES * DEA_RINGS_NODES];  /* damper of the second film likewise [1/s] */
    double push[DEA_RINGS_NODES];                      /* phi likewise [N/V^2/kg^1/2] */
    double charge_gain, charge_rate;                   /* (2 U)^2/C [V^2/F], q [1/s]; 0: the voltage holds */
    bool damped;
    dea_row row; /* at the equilibrium */
} film;

/* ---- the undamped modes */

/* Columns of shapes^T A shapes, which take the place of the symmetric A. */
static void to_modal(const film *f, double *a)
{
    const size_t n = f->count;
    double *half = calloc(n * n, sizeof *half);
    for (size_t j = 0; half && j < n; j++) {
        for (size_t i = 0; i < n; i++) {
            for (size_t m = 0; m < n; m++) {
                half[j * n + i] += a[m * n + i] * f->shapes[j * n + m];
            }
        }
    }
    for (size_t j = 0; j < n; j++) {
        for (size_t i = 0; i < n; i++) {
            double sum = half ? 0.0 : (double)NAN;
            for (size_t m = 0; half && m < n; m++) {
                sum += f->shapes[i * n + m] * half[j * n + m];
            }
            a[j * n + i] = sum;
        }
    }
    free(half);
}

/* Damper, branches and charge, in modal coordinates. */
static void set_losses(film *f, const dea_membrane_look *look)
{
    const dea_dynamics *d = &f->membrane.film;
    const size_t n = f->count;
    double push[DEA_RINGS_NODES];
    dea_membrane_stiffness(&f->membrane, look, f->voltage, NULL, 1.0, f->viscous);
    to_modal(f, f->viscous);
    if (f->membrane.second.retardation > 0.0) {
        dea_membrane_damp_second(&f->membrane, look, 1.0, f->beside);
        to_modal(f, f->beside);
    }
    dea_membrane_push(&f->membrane, look, push);
    for (size_t k = 0; k < n; k++) {
        f->viscous[k * n + k] -= f->w[k] * f->w[k]; /* K went into it too */
        f->push[k] = 0.0;
        for (size_t i = 0; i < n; i++) {
            f->push[k] += f->shapes[k * n + i] * push[i];
        }
    }
    if (d->series > 0.0 && f->voltage != 0.0) {
        f->charge_gain = 4.0 * f->voltage * f->voltage / look->capacitance;
        f->charge_rate = (1.0 / d->series + d->conductance) / look->capacitance;
    }
    f->damped = dea_dynamics_is_damped(d) || d->branch_count > 0 || f->charge_gain > 0.0 || f->membrane.second.retardation > 0.0;
}

/* Degree of an element that takes that share of the radius: many nodes close together cost the slow modes their digits. */
static size_t degree_of(size_t degree, double share)
{
    const size_t fitting = FEW + (degree - FEW) / 4 + (size_t)(2.0 * share * (double)degree);
    return fitting < degree ? fitting : degree;
}

/* Polynomials in R follow the 1/R about a small disc slowly, those in ln R the modes far from it. */
static dea_rings_mesh mesh_of(const dea_scene *scene, size_t degree, bool logarithmic)
{
    const dea_actuator *actuator = &scene->actuator;
    const double coverage = isnan(actuator->coverage) ? actuator->divide_radius / actuator->frame_radius : actuator->coverage;
    return (dea_rings_mesh){degree_of(degree, coverage), degree_of(degree, 1.0 - coverage), logarithmic};
}

/* The equilibrium and its undamped modes; the state of the row says whether there is one. */
static dea_status film_open(const dea_scene *scene, const dea_model *model, dea_rings_mesh mesh, film *f, dea_error *error)
{
    memset(f, 0, sizeof *f);
    const dea_status status = dea_membrane_open(scene, model, mesh, &f->membrane, error);
    if (status != DEA_OK) {
        return status;
    }
    const dea_dynamics *d = &f->membrane.film;
    dea_membrane_look look;
    f->count = f->membrane.nodes;
    f->voltage = scene->modes.bias / (1.0 + d->series * d->conductance);
    f->row = dea_row_failed();
    f->row.state = DEA_STATE_PULL_IN;
    if (!dea_membrane_still(&f->membrane, f->voltage, f->u) || !dea_membrane_look_at(&f->membrane, f->u, &look)) {
        return DEA_OK;
    }
    dea_membrane_row(&f->membrane, &look, f->voltage, f->u, &f->row);
    dea_membrane_stiffness(&f->membrane, &look, f->voltage, NULL, 0.0, f->viscous);
    if (!dea_membrane_modes(&f->membrane, f->viscous, f->w, f->shapes)) {
        return dea_fail(error, DEA_ERROR_ENGINE, "LAPACK finds no modes of the film");
    }
    set_losses(f, &look);
    return DEA_OK;
}

/* ---- the damped ones */

/* tau_KV s + sum_i c_i s tau_i/(1 + s tau_i), and its slope. */
static double complex viscous_share(const dea_dynamics *d, double complex s, double complex *slope)
{
    double complex share = d->retardation * s;
    *slope = d->retardation;
    for (size_t i = 0; i < d->branch_count; i++) {
        const double complex rate = 1.0 + s * d->branches[i].tau;
        share += d->branches[i].share * s * d->branches[i].tau / rate;
        *slope += d->branches[i].share * d->branches[i].tau / (rate * rate);
    }
    return share;
}

/* One round of Newton on D(s) x = 0, x_k = 1, with V and phi phi^T grown to @p grown; the size of its step over |s| and |x|. */
static double newton_round(const film *f, size_t k, double grown, double complex *s, double complex *x)
{
    const dea_dynamics *d = &f->membrane.film;
    const size_t n = f->count, m = n + 1, edge = f->membrane.rings.edge;
    lapack_complex_double a[(DEA_RINGS_NODES + 1) * (DEA_RINGS_NODES + 1)], b[DEA_RINGS_NODES + 1];
    lapack_int pivots[DEA_RINGS_NODES + 1];
    double complex slope;
    const double complex share = grown * viscous_share(d, *s, &slope), behind = *s + f->charge_rate;
    const double complex gain = grown * f->charge_gain * *s / behind;
    const double complex gain_slope = grown * f->charge_gain * f->charge_rate / (behind * behind);
    memset(a, 0, m * m * sizeof *a);
    memset(b, 0, m * sizeof *b);
    for (size_t j = 0; j < n; j++) {
        for (size_t i = 0; i < n; i++) {
            const double drag = grown * (d->damping * f->shapes[i * n + edge] * f->shapes[j * n + edge] + f->beside[j * n + i]);
            const double complex at = share * f->viscous[j * n + i] + gain * f->push[i] * f->push[j] + drag * *s +
                                      (i == j ? *s * *s + f->w[i] * f->w[i] : 0.0);
            a[j * m + i] = at;
            a[n * m + i] += (grown * slope * f->viscous[j * n + i] + gain_slope * f->push[i] * f->push[j] + drag + (i == j ? 2.0 * *s : 0.0)) * x[j];
            b[i] -= at * x[j];
        }
    }
    a[k * m + n] = 1.0;
    if (dea_lapacke_zgesv(LAPACK_COL_MAJOR, (lapack_int)m, 1, a, (lapack_int)m, pivots, b, (lapack_int)m) != 0) {
        return (double)NAN;
    }
    double moved = cabs(b[n]) / cabs(*s);
    for (size_t i = 0; i < n; i++) {
        x[i] += b[i];
        moved = fmax(moved, cabs(b[i]));
    }
    *s += b[n];
    return moved;
}

/* Newton that goes straight to its end. */
static bool newton(const film *f, size_t k, double grown, double complex *s, double complex *x)
{
    double last = 0.3;
    for (int i = 0; i < NEWTON_MOST; i++) {
        const double moved = newton_round(f, k, grown, s, x);
        if (!(moved <= last)) {
            return last <= 1e-13;
        }
        if (moved <= 1e-15) {
            return true;
        }
        last = moved;
    }
    return last <= 1e-13;
}

/* Follows root number @p k; 0 where it reaches the real axis, NAN where it is lost on the way. */
static double complex follow_root(const film *f, size_t k)
{
    double complex s = I * f->w[k], x[DEA_RINGS_NODES] = {0};
    x[k] = 1.0;
    for (double grown = 0.0, step = 1.0; grown < 1.0;) {
        double complex at = s, shape[DEA_RINGS_NODES];
        const double next = fmin(1.0, grown + step);
        memcpy(shape, x, sizeof shape);
        if (newton(f, k, next, &at, shape) && cimag(at) > 0.0) {
            s = at;
            memcpy(x, shape, sizeof x);
            grown = next;
            step *= 2.0;
        } else if ((step *= 0.5) < least_growth) {
            return cimag(s) < overdamped * cabs(s) ? 0.0 : (double)NAN;
        }
    }
    return s;
}

/* ---- rows */

/* Frequency and damping ratio of a root. */
static void take_root(double complex s, dea_mode *mode)
{
    const double size = cabs(s);
    mode->frequency = fabs(cimag(s)) / (2.0 * DEA_PI);
    mode->damping_ratio = size > 0.0 ? -creal(s) / size : (double)NAN;
}

/* What du = K^-1 phi d(U^2) does to the edge is a sum over the modes, phi_edge (phi . push)/w^2 each. */
static bool fill_modes(const film *f, dea_mode *modes, size_t count)
{
    const size_t n = f->count, edge = f->membrane.rings.edge;
    double whole = 0.0;
    bool found = count <= n;
    for (size_t k = 0; k < n; k++) {
        whole += f->shapes[k * n + edge] * f->push[k] / (f->w[k] * f->w[k]);
    }
    for (size_t k = 0; k < count && found; k++) {
        const double at = f->shapes[k * n + edge];
        const double complex s = f->damped ? follow_root(f, k) : I * f->w[k];
        modes[k] = (dea_mode){.number = (double)(k + 1), .undamped = f->w[k] / (2.0 * DEA_PI), .state = f->row.state};
        take_root(s, &modes[k]);
        modes[k].edge_share = at * f->push[k] / (f->w[k] * f->w[k]) / whole;
        modes[k].edge_mass = 1.0 / (at * at);
        found = !isnan(modes[k].frequency);
    }
    return found;
}

static double apart(double a, double b)
{
    return a == b || (isnan(a) && isnan(b)) ? 0.0 : fabs(a - b) / fabs(b);
}

/* Two meshes agree on the modes. A mass that the finest two do not agree on has no number: the edge is near a node of the mode. */
static bool agree(const dea_mode *coarse, dea_mode *fine, size_t count, double accuracy, bool finest)
{
    bool same = true;
    for (size_t k = 0; k < count; k++) {
        const double far = fmax(apart(coarse[k].frequency, fine[k].frequency), apart(coarse[k].undamped, fine[k].undamped));
        const double share = fabs(coarse[k].edge_share - fine[k].edge_share);
        const double ratio = apart(coarse[k].damping_ratio, fine[k].damping_ratio);
        const bool mass = apart(coarse[k].edge_mass, fine[k].edge_mass) <= 10.0 * accuracy;
        same = same && far <= accuracy && share <= accuracy && ratio <= 10.0 * accuracy && (mass || finest);
        fine[k].edge_mass = mass || !finest ? fine[k].edge_mass : (double)NAN;
    }
    return same;
}

static void fill_shapes(const film *f, const dea_scene *scene, const dea_layout *layout, void *point)
{
    const dea_rings *rings = &f->membrane.rings;
    for (size_t k = 0; k < layout->rows; k++) {
        const double *shape = &f->shapes[k * f->count];
        const double sign = shape[rings->edge] < 0.0 ? -1.0 : 1.0;
        for (size_t i = 0; i < layout->spread_points; i++) {
            const double radius = dea_layout_radius(scene, layout, i) / f->membrane.film.point.film.prestretch;
            const dea_rings_spot spot = dea_rings_spot_at(rings, radius, false);
            double slope;
            *dea_layout_entry(layout, point, k, i) = sign * dea_rings_displacement(rings, &spot, shape, &slope) + 0.0; /* no -0 */
        }
    }
}

static void fill_state(dea_mode *modes, size_t count, dea_state state)
{
    const double none = (double)NAN;
    for (size_t k = 0; k < count; k++) {
        modes[k] = (dea_mode){(double)(k + 1), none, none, none, none, none, state};
    }
}

/* Finer and finer, until two meshes agree; *@p found: they do, or there is no equilibrium. */
static dea_status refine(const dea_scene *scene, const dea_model *model, const dea_layout *layout, bool logarithmic, dea_mode *modes, film *f,
                         bool *found, dea_error *error)
{
    dea_mode before[DEA_MODES_MOST];
    bool known = false;
    for (size_t degree = layout->rows / 2 + FEW; degree <= DEA_RINGS_DEGREE && !*found; degree += STEP) {
        const dea_status status = film_open(scene, model, mesh_of(scene, degree, logarithmic), f, error);
        if (status != DEA_OK) {
            return status;
        }
        if (f->row.state == DEA_STATE_PULL_IN) {
            *found = true;
            return DEA_OK;
        }
        memcpy(before, modes, layout->rows * sizeof *modes);
        const bool filled = fill_modes(f, modes, layout->rows);
        *found = filled && known && agree(before, modes, layout->rows, scene->accuracy, degree + STEP > DEA_RINGS_DEGREE);
        known = filled;
    }
    return DEA_OK;
}

static dea_status solve_membrane(const dea_scene *scene, const dea_model *model, const dea_layout *layout, void *point, film *f,
                                 dea_error *error)
{
    bool found = false;
    dea_status status = refine(scene, model, layout, false, point, f, &found, error);
    if (status == DEA_OK && !found) {
        status = refine(scene, model, layout, true, point, f, &found, error);
    }
    if (status != DEA_OK) {
        return status;
    }
    if (!found) {
        dea_layout_fail(scene, layout, point);
        dea_fail(error, DEA_OK, "modes on %d rings of film are not within the accuracy", DEA_RINGS_MOST);
    } else if (f->row.state == DEA_STATE_PULL_IN) {
        dea_layout_fail(scene, layout, point);
        fill_state(point, layout->rows, DEA_STATE_PULL_IN);
    } else {
        fill_shapes(f, scene, layout, point);
    }
    return DEA_OK;
}

/* Lame: w ~ R in the disc, F^2/R - R in the annulus, w = 1 at the edge. */
static double lame_shape(double coverage, double place)
{
    return place <= coverage ? place / coverage : (1.0 / place - place) / (1.0 / coverage - coverage);
}

static dea_status solve_single(const dea_scene *scene, const dea_model *model, const dea_layout *layout, void *point, dea_error *error)
{
    dea_dynamics d;
    const dea_status status = dea_dynamics_open(scene, model, &d, error);
    dea_sample rest = {.state = DEA_STATE_PULL_IN};
    const double voltage = status == DEA_OK ? scene->modes.bias / (1.0 + d.series * d.conductance) : 0.0;
    dea_moment moment = {.source = scene->modes.bias, .voltage = voltage};
    if (status == DEA_OK && dea_dynamics_equilibrium(&d, voltage, &moment.u) && dea_dynamics_sample(&d, &moment, &rest)) {
        const dea_swing swing = dea_swing_of(&d, moment.u, voltage);
        const double w = sqrt(dea_dynamics_stiffness(&d, moment.u, voltage, true) / d.mass), omega = 2.0 * DEA_PI * swing.frequency;
        dea_mode *mode = point;
        *mode = (dea_mode){.number = 1.0, .undamped = w / (2.0 * DEA_PI), .edge_share = 1.0, .edge_mass = d.mass, .state = rest.state};
        take_root(isnan(omega) ? 0.0 : I * omega - swing.decay, mode);
        for (size_t i = 0; i < layout->spread_points; i++) {
            const double place = dea_layout_radius(scene, layout, i) / d.point.frame_radius;
            *dea_layout_entry(layout, point, 0, i) = lame_shape(d.point.coverage, place) / sqrt(d.mass);
        }
    } else if (status == DEA_OK) {
        dea_layout_fail(scene, layout, point);
        fill_state(point, 1, rest.state);
    }
    dea_dynamics_close(&d);
    return status;
}

dea_status dea_direct_modes(void *session, const dea_scene *scene, const dea_model *model, const dea_layout *layout, void *point,
                            dea_error *error)
{
    (void)session;
    if (!model->membrane) {
        return solve_single(scene, model, layout, point, error);
    }
    film *f = malloc(sizeof *f);
    const dea_status status = f ? solve_membrane(scene, model, layout, point, f, error)
                                : dea_fail(error, DEA_ERROR_MEMORY, "out of memory");
    free(f);
    return status;
}
