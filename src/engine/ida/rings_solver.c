#include "engine/ida/rings_solver.h"

#include <math.h>

/* Radians of the fastest mode in a step of an explicit method, at the most. */
static const double longest_turn = 3.0;

/* Share of its size below which an unknown needs a smaller one. */
static const double small = 0.03;

dea_status dea_rings_solver_open(const dea_sundials *sun, const dea_scene *scene, const dea_model *model,
                                 const dea_signal *signal, dea_rings_mesh mesh, dea_rings_solver *s, dea_error *error)
{
    dea_rings_flight *f = &s->flight;
    *s = (dea_rings_solver){.sun = sun};
    const dea_status status = dea_rings_flight_prepare(scene, model, signal, mesh, f, error);
    if (status != DEA_OK) {
        return status;
    }
    s->y = dea_sundials_vector(sun, f->motion.count);
    s->yp = s->y ? sun->N_VClone(s->y) : NULL;
    s->between = s->y ? sun->N_VClone(s->y) : NULL;
    s->slope = s->y ? sun->N_VClone(s->y) : NULL;
    s->tolerances = s->y ? sun->N_VClone(s->y) : NULL;
    if (!s->yp || !s->between || !s->slope || !s->tolerances) {
        return dea_fail(error, DEA_ERROR_MEMORY, "out of memory while IDA starts");
    }
    return dea_rings_implicit_open(s, error);
}

void dea_rings_solver_close(dea_rings_solver *s)
{
    N_Vector vectors[] = {s->y, s->yp, s->between, s->slope, s->tolerances};
    dea_rings_implicit_close(s);
    dea_along_close(&s->flight.along);
    for (size_t i = 0; i < sizeof vectors / sizeof *vectors; i++) {
        if (vectors[i]) {
            s->sun->N_VDestroy(vectors[i]);
        }
    }
}

bool dea_rings_solver_fit(dea_rings_solver *s)
{
    dea_rings_flight *f = &s->flight;
    dea_rings_motion *m = &f->motion;
    const double share = f->trace->largest / m->length;
    if (!(share > 0.0) || share >= small) {
        return false;
    }
    const double smaller = fmax(share, 10.0 * f->tolerance);
    m->length *= smaller;
    m->speed *= smaller;
    m->stress *= smaller;
    return true;
}

static void set_tolerances(dea_rings_solver *s)
{
    dea_rings_flight *f = &s->flight;
    const dea_rings_motion *m = &f->motion;
    double *absolute = NV_DATA_S(s->tolerances);
    for (size_t i = 0; i < m->count; i++) {
        const double charge = i < m->q ? 0.0 : m->charge * m->shares[i - m->q];
        absolute[i] = f->tolerance * (i < m->nodes ? m->length : i < m->z ? m->speed : i < m->q ? m->stress : charge);
    }
}

/* How long the segment is worth an explicit method [s]: while the slowest mode lives, where nothing relaxes faster than the fastest
 * one swings. Once a damper holds the fast modes, BDF has no trouble with them. */
static double explicit_time(const dea_rings_flight *f)
{
    const dea_rings_motion *m = &f->motion;
    const double width = m->segment->to - m->segment->from;
    if (!m->heavy || dea_rings_stiffest(m) > m->rest.fastest) {
        return 0.0;
    }
    return fmin(width, log(10.0 / f->tolerance) / dea_rings_decay(m));
}

static dea_state fly_segment(dea_rings_solver *s)
{
    dea_rings_flight *f = &s->flight;
    const dea_segment *segment = f->motion.segment;
    double *y = NV_DATA_S(s->y), *rates = NV_DATA_S(s->yp);
    if (!dea_rings_jump(f, y) || !dea_rings_rates(&f->motion, 0.0, y, rates) ||
        (f->trace->count == 0 && !dea_rings_record(f, 0.0, y, rates, false))) {
        return DEA_STATE_PULL_IN;
    }
    const double turning = explicit_time(f);
    if (turning > 0.0) {
        const dea_state state = dea_rings_affords(f, turning * f->motion.rest.fastest / longest_turn) ? dea_rings_explicit(s, turning) : DEA_STATE_FAILED;
        if (state != DEA_STATE_OK || turning >= segment->to - segment->from) {
            return state;
        }
    }
    return dea_rings_implicit(s, turning);
}

void dea_rings_solver_run(dea_rings_solver *s, double tolerance, dea_rings_trace *trace, dea_summary *summary)
{
    dea_rings_flight *f = &s->flight;
    dea_audit audit = {0};
    dea_rings_motion *m = &f->motion;
    *trace = (dea_rings_trace){.samples = trace->samples, .entries = trace->entries};
    f->trace = trace;
    f->audit = summary ? &audit : NULL;
    f->tolerance = tolerance;
    f->steps = 0;
    m->segment = f->signal->segments;
    set_tolerances(s);
    if (!dea_rings_start(m, f->scene->transient.from_bias, NV_DATA_S(s->y))) {
        trace->end = DEA_STATE_PULL_IN;
        return;
    }
    const dea_membrane_energy first = dea_rings_energy(f, 0.0, NV_DATA_S(s->y));
    for (size_t i = 0; trace->end == DEA_STATE_OK && i < f->signal->count; i++) {
        m->segment = &f->signal->segments[i];
        trace->end = fly_segment(s);
    }
    if (summary && trace->end == DEA_STATE_OK) {
        const dea_membrane_energy last = dea_rings_energy(f, m->segment->to - m->segment->from, NV_DATA_S(s->y));
        dea_membrane_audit_close(&audit, &f->membrane, &first, &last, summary);
    }
}
