/* The largest current of the source within a segment, from the closed form between its samples. */
#include <math.h>

#include "engine/direct/walk.h"

/* Stretches of a segment over which the current is smooth: so much of the age, since all that was faster has settled, of a radian
 * of the ring and of the sine; neper after which a mode is dead; and most stretches of a segment. */
static const double of_age = 0.5, of_radian = 1.0;
static const double dead = 37.0;
enum { MOST_STRETCHES = 20000 };

typedef struct crest {
    const dea_walk *walk;
    const dea_piece *piece;
    const dea_course *start;
    dea_dynamics *dynamics;
} crest;

/* Current of the source at a time of the run [A]. */
static double current_at(void *user, double time)
{
    const crest *c = user;
    const dea_segment *segment = c->piece->segment;
    const double t = fmin(fmax(time - segment->from, 0.0), c->piece->length);
    const dea_motion motion = dea_walk_motion(c->walk, c->piece, c->start, t);
    const dea_moment moment = {.time = time,
                               .voltage = dea_segment_voltage(c->walk->signal, segment, time),
                               .slope = dea_segment_slope(c->walk->signal, segment, time),
                               .u = motion.u,
                               .v = motion.v};
    return dea_dynamics_current(c->dynamics, &moment);
}

/* Rates of the fastest mode and of the slowest to decay, and of the ring with its decay [1/s]. */
typedef struct pace {
    double fastest, slowest, omega, decay;
} pace;

static pace pace_of(const dea_modes *modes)
{
    pace p = {.slowest = INFINITY};
    for (size_t i = 0; i < modes->count; i++) {
        p.fastest = fmax(p.fastest, -modes->roots[i].value);
        p.slowest = fmin(p.slowest, -modes->roots[i].value);
    }
    if (modes->pair) {
        const double apart = sqrt(fabs(modes->square));
        const bool rings = modes->square < 0.0;
        p.omega = rings ? apart : 0.0;
        p.decay = -modes->sigma;
        p.fastest = fmax(p.fastest, rings ? p.decay : p.decay + apart);
        p.slowest = fmin(p.slowest, rings ? p.decay : p.decay - apart);
    }
    return p;
}

bool dea_direct_peak(const dea_walk *walk, const dea_piece *piece, const dea_course *start, dea_dynamics *dynamics, dea_peak *peak)
{
    crest c = {walk, piece, start, dynamics};
    const pace p = pace_of(&walk->now->modes);
    const double from = piece->segment->from, turn = piece->omega > 0.0 ? 2.0 * DEA_PI / piece->omega : 0.0;
    const double steady = turn > 0.0 ? dead / p.slowest + turn : INFINITY; /* behind it the current repeats itself */
    const double end = fmin(piece->length, steady);
    int count = 0;
    for (double age = 0.0; age < end; count++) {
        const bool rings = p.omega > 0.0 && age * p.decay < dead;
        double step = of_age * fmax(age, p.fastest > 0.0 ? 1.0 / p.fastest : piece->length);
        step = fmin(step, rings ? of_radian / p.omega : INFINITY);
        step = fmin(step, turn > 0.0 ? 0.5 * of_radian / piece->omega : INFINITY);
        const double next = age + 1.5 * step < end ? age + step : end;
        if (count == MOST_STRETCHES) {
            return false;
        }
        dea_peak_search(peak, from + age, from + next, current_at, &c);
        age = next;
    }
    return true;
}
