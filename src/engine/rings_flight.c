#include "engine/rings_flight.h"

#include <math.h>
#include <string.h>

/* Steps of one run after which it is given up. */
enum { MOST_STEPS = 500000 };

/* Share of the stiffness at rest at which a film without mass folds. */
static const double folded = 1e-4;

dea_status dea_rings_flight_prepare(const dea_scene *scene, const dea_model *model, const dea_signal *signal, dea_rings_mesh mesh,
                                    dea_rings_flight *f, dea_error *error)
{
    *f = (dea_rings_flight){.scene = scene, .signal = signal, .rows = dea_layout_of(scene).rows};
    const dea_status status = dea_membrane_open(scene, model, mesh, &f->membrane, error);
    if (status != DEA_OK) {
        return status;
    }
    if (!dea_rings_motion_open(&f->membrane, signal, &f->motion)) {
        return dea_fail(error, DEA_ERROR_ENGINE, "the film is not stable at rest");
    }
    f->peaks = dea_peak_is_known(scene, &f->membrane.film, signal);
    const dea_layout layout = dea_layout_of(scene);
    return dea_along_open(&f->membrane, scene, &layout, &f->along, error);
}

double dea_rings_next_sample(const dea_rings_flight *f)
{
    const size_t next = f->trace->count;
    return next < f->rows ? dea_layout_place(f->scene, next) : (double)INFINITY;
}

/* The moment of y: over a step longer than R_s C the slope of the charge is a better number than the small drop over R_s. */
static dea_moment moment_at(dea_rings_flight *f, double time, const double *y, const double *rates, bool charging)
{
    const dea_rings_motion *m = &f->motion;
    dea_moment moment = dea_rings_moment(m, time, &f->state);
    (void)y;
    moment.charging = charging && m->charged;
    moment.charge_slopes = f->derived ? rates + m->q : NULL;
    for (size_t k = 0; k < m->charges && moment.charging; k++) {
        moment.charge_slope += rates[m->q + k];
    }
    return moment;
}

static const double *velocity_of(const dea_rings_flight *f, const double *y, const double *rates)
{
    return f->motion.heavy ? y + f->motion.nodes : rates;
}

/* The film along its radius behind the sample that was just filled, at the state that was looked at. */
static void tell_along(dea_rings_flight *f, const double *y, const double *v)
{
    const size_t row = f->trace->count;
    dea_membrane_viscous(&f->membrane, &f->state.look, v, y + f->motion.z, f->state.x);
    const dea_along_state at = {&f->state.look, f->state.voltage, (const double(*)[2])f->state.x, y, v};
    dea_along_tell(&f->along, &f->membrane, &at, f->trace->entries + row * f->along.count * DEA_SPREAD_COLUMNS);
    f->trace->samples[row].weakest = dea_along_weakest(&f->along, &f->membrane, &at);
}

bool dea_rings_record(dea_rings_flight *f, double time, const double *y, const double *rates, bool charging)
{
    dea_rings_trace *trace = f->trace;
    const dea_dynamics *film = &f->membrane.film;
    static const double still[DEA_RINGS_NODES] = {0.0};
    if (!dea_rings_glance(&f->motion, time, y, &f->state)) {
        return false;
    }
    dea_moment moment = moment_at(f, time, y, rates, charging);
    const bool fed = f->membrane.sheet.places > 0 && !(film->series > 0.0), start = (film->biased || fed) && moment.time == 0.0;
    if (start) { /* the branches have relaxed, and the charge rests; into a rim at the source it comes as the root of time */
        moment.charging = film->series > 0.0 || film->dropped > 0.0 || fed;
        moment.charge_slope = 0.0;
        moment.slope = fed ? 0.0 : moment.slope;
    }
    const double *v = start && film->clamped ? still : velocity_of(f, y, rates);
    if (!dea_membrane_sample(&f->membrane, &f->state.look, &moment, y, v, &trace->samples[trace->count])) {
        return false;
    }
    if (f->along.count > 0) {
        tell_along(f, y, v);
    }
    trace->count++;
    return true;
}

double dea_rings_current(dea_rings_flight *f, double time, const double *y, const double *rates, bool charging)
{
    if (!dea_rings_glance(&f->motion, time, y, &f->state)) {
        return 0.0;
    }
    const dea_moment moment = moment_at(f, time, y, rates, charging);
    return dea_membrane_current(&f->membrane, &f->state.look, &moment, velocity_of(f, y, rates));
}

void dea_rings_audit(dea_rings_flight *f, double time, const double *y, const double *rates, bool charging, double weight)
{
    if (dea_rings_glance(&f->motion, time, y, &f->state)) {
        const dea_moment moment = moment_at(f, time, y, rates, charging);
        dea_membrane_audit_add(f->audit, &f->membrane, &f->state.look, &moment, velocity_of(f, y, rates), y + f->motion.z, weight);
    }
}

dea_state dea_rings_step(dea_rings_flight *f, double time, const double *y)
{
    f->trace->largest = fmax(f->trace->largest, fabs(y[f->membrane.rings.edge]));
    if (++f->steps > MOST_STEPS) {
        dea_fail(&f->why, DEA_ERROR_ENGINE, "at a tolerance of %.1g, %ld steps take the run to %g s", f->tolerance,
                 f->steps, f->motion.segment->from + time);
        return DEA_STATE_FAILED;
    }
    return dea_rings_firmness(&f->motion, time, y) < folded ? DEA_STATE_PULL_IN : DEA_STATE_OK;
}

dea_state dea_rings_broke(dea_rings_flight *f, const char *solver, int code, double time)
{
    dea_fail(&f->why, DEA_ERROR_ENGINE, "at a tolerance of %.1g, %s stopped at %g s with its error %d", f->tolerance, solver,
             f->motion.segment->from + time, code);
    return DEA_STATE_FAILED;
}

/* Energy of the charges at y [J]. */
static double charge_energy(dea_rings_flight *f, const double *y)
{
    return dea_rings_glance(&f->motion, 0.0, y, &f->state) ? dea_sheet_energy(&f->membrane, &f->state.charges) : (double)NAN;
}

/* What a jump of a rim at the source does to the charges within is work too. */
bool dea_rings_jump(dea_rings_flight *f, double *y)
{
    const dea_rings_motion *m = &f->motion;
    double before[DEA_RINGS_NODES];
    if (!dea_rings_algebraic(m) || f->membrane.film.series > 0.0) {
        return true;
    }
    memcpy(before, y, m->nodes * sizeof *y);
    const double stored = m->charged ? charge_energy(f, y) : 0.0;
    if (!(m->charged ? dea_rings_settle(m, y) : dea_membrane_follow(&f->membrane, m->segment->start, y + m->z, y))) {
        return false;
    }
    if (f->audit && memcmp(before, y, m->nodes * sizeof *y) != 0) {
        dea_membrane_audit_jump(f->audit, &f->membrane, before, y, y + m->z);
        f->audit->work += m->charged ? charge_energy(f, y) - stored : 0.0;
    }
    return true;
}

bool dea_rings_affords(dea_rings_flight *f, double steps)
{
    const double left = (double)(MOST_STEPS - f->steps);
    if (steps <= left) {
        return true;
    }
    dea_fail(&f->why, DEA_ERROR_ENGINE,
             "the swing of its %zu nodes takes %.2g more steps at a tolerance of %.1g, %.2g are left: a damper "
             "(material.retardation) ends it",
             f->motion.nodes, steps, f->tolerance, left);
    return false;
}

dea_membrane_energy dea_rings_energy(dea_rings_flight *f, double time, const double *y)
{
    const dea_rings_motion *m = &f->motion;
    const bool seen = dea_rings_glance(m, time, y, &f->state);
    dea_membrane_energy energy =
        dea_membrane_energy_of(&f->membrane, seen ? f->state.voltage : (double)NAN, y, y + m->nodes, y + m->z);
    if (seen && f->membrane.sheet.places > 0) {
        const size_t rim = m->charges; /* the place at the source, if there is one */
        const bool fed = rim < f->membrane.sheet.places;
        energy.fed = fed ? 0.5 * f->state.charges.capacitances[rim] * f->state.source * f->state.source : 0.0;
        energy.electric = energy.fed + dea_sheet_energy(&f->membrane, &f->state.charges);
    }
    return energy;
}
