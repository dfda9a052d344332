#include "engine/direct/walk.h"

#include <string.h>

dea_chain dea_walk_chain(const dea_dynamics *d, double stiffness)
{
    dea_chain chain = {.mass = d->mass, .damping = d->retardation * stiffness + d->damping, .stiffness = stiffness, .count = d->branch_count};
    for (size_t i = 0; i < d->branch_count; i++) {
        chain.spring[i] = stiffness * d->branches[i].share;
        chain.tau[i] = d->branches[i].tau;
        chain.rate[i] = 1.0 / d->branches[i].tau;
    }
    return chain;
}

/* The modes under this stiffness into the older place of the cache, unless they are there. NULL with DEA_OK: nothing holds the
 * film. */
static dea_status find_modes(dea_walk *w, double stiffness, const dea_walk_modes **found, dea_error *error)
{
    for (size_t i = 0; i < w->cached; i++) {
        if (w->cache[i].modes.chain.stiffness == stiffness) {
            *found = &w->cache[i];
            return DEA_OK;
        }
    }
    const size_t place = w->cached < DEA_WALK_CACHED ? w->cached++ : w->now == &w->cache[0] ? 1 : 0;
    dea_walk_modes *entry = &w->cache[place];
    dea_chain chain = w->chain;
    chain.stiffness = stiffness;
    const dea_modes_answer answer = dea_modes_find(&chain, &entry->modes);
    *found = answer == DEA_MODES_FOUND ? entry : NULL;
    if (answer == DEA_MODES_CLOSE) {
        return dea_fail(error, DEA_ERROR_UNSUPPORTED,
                        "three time constants of the film nearly coincide: its modes cannot be told apart");
    }
    dea_advance_make(&entry->modes, w->every, &entry->every);
    w->cancellation = fmax(w->cancellation, entry->modes.cancellation);
    return DEA_OK;
}

/* Rest, or the equilibrium under the first voltage; false where there is none. */
static bool begin_motion(dea_walk *w, const dea_walk_modes *modes, double force)
{
    memset(&w->course, 0, sizeof w->course);
    if (w->from_bias) {
        const double stiffness = modes->modes.chain.stiffness;
        if (!(stiffness > 0.0)) {
            return false;
        }
        w->course = dea_modes_relaxed(&modes->modes, force);
        w->motion.u = force / stiffness;
        w->force = force;
    }
    return true;
}

/* Takes the course over to the next segment. Its modes differ where the voltage softens the film. */
static void cross_edge(dea_walk *w, const dea_walk_modes *next, double force)
{
    if (next == w->now) {
        dea_modes_jump(&next->modes, force - w->force, &w->course);
    } else {
        double z[DEA_PRONY_MAX];
        dea_modes_branches(&w->now->modes, &w->course.place, z);
        w->course = dea_modes_split(&next->modes, w->motion.u, w->motion.v, z, force);
    }
    w->now = next;
    w->force = force;
}

dea_status dea_walk_enter(dea_walk *w, const dea_segment *segment, dea_error *error)
{
    const double largest = dea_segment_largest(w->signal, segment);
    const double softened = w->linear.softening == 0.0 ? 0.0 : w->linear.softening * largest * largest;
    const double force = w->linear.force * segment->start * segment->start;
    const dea_walk_modes *next;
    const dea_status status = find_modes(w, w->chain.stiffness + softened, &next, error);
    if (status != DEA_OK) {
        return status;
    }
    if (!next || (!w->now && !begin_motion(w, next, force))) {
        w->lost = true;
        return DEA_OK;
    }
    w->now = w->now ? w->now : next;
    cross_edge(w, next, force);
    return DEA_OK;
}

dea_piece dea_walk_piece(const dea_walk *w, const dea_segment *segment, dea_course *start)
{
    const dea_piece piece = dea_piece_make(w->signal, segment, &w->linear, &w->now->modes);
    *start = w->course;
    dea_piece_shift(&piece, &w->now->modes, 0.0, -1.0, start);
    return piece;
}

dea_motion dea_walk_motion(const dea_walk *w, const dea_piece *piece, const dea_course *start, double t)
{
    dea_advance advance;
    dea_course course = *start;
    dea_advance_make(&w->now->modes, t, &advance);
    dea_advance_take(&w->now->modes, &advance, &piece->force, &course);
    return dea_piece_motion(piece, &w->now->modes, &course, t);
}

void dea_walk_pass(dea_walk *w, const dea_piece *piece, const dea_course *start)
{
    const dea_segment *segment = piece->segment;
    dea_advance whole;
    w->course = *start;
    dea_advance_make(&w->now->modes, piece->length, &whole);
    dea_advance_take(&w->now->modes, &whole, &piece->force, &w->course);
    w->motion = dea_piece_motion(piece, &w->now->modes, &w->course, piece->length);
    dea_piece_shift(piece, &w->now->modes, piece->length, 1.0, &w->course);
    w->force = w->linear.force * segment->end * segment->end;
}
