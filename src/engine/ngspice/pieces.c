#include "engine/ngspice/pieces.h"

#include <math.h>

#include "support/grow.h"

/* Most corners of the voltage in one piece: the library walks through all of them at every step. */
enum { MOST_CORNERS = 64 };

/* Segments of a drive from which on its netlists cost more than their time steps: then a piece joins the one before it where that
 * takes no more than so many steps more, what is left of a segment is no piece of its own below such a share of one, and a short
 * edge shortens no step. */
enum { MANY_SEGMENTS = 200 };
static const double netlist_steps = 50.0;
static const double rest_share[2] = {0.1, 0.5};

/* Longest edge that counts as short, over the film's fastest time: its netlist cuts it by corners of its own. */
static const double short_edge = 0.1;

/* Longest step that the library takes from one corner to the next, over what lies between: they begin short and double. Masses fit the
 * steps that are taken, not those that would be good. */
static const double between_corners = 1.0 / 3.0;

typedef struct cutter {
    const dea_signal *signal;
    const dea_pace *pace;
    double life; /* of a ring [s] */
    bool many;   /* segments */
    dea_pieces *pieces;
    size_t room;
    size_t corners; /* of the voltage inside the last piece */
    bool exhausted;
} cutter;

/* Time steps that two pieces would take with the shorter of their steps, beyond those that they take. */
static double more_steps(const dea_piece *a, const dea_piece *b)
{
    const double step = fmin(a->step, b->step);
    return (a->to - a->from) * (1.0 / step - 1.0 / a->step) + (b->to - b->from) * (1.0 / step - 1.0 / b->step);
}

/* True where the last piece can go on with that step through this segment. */
static bool goes_on(const cutter *c, const dea_piece *next)
{
    if (c->pieces->count == 0 || next->jump || next->rings != c->pieces->pieces[c->pieces->count - 1].rings ||
        c->corners >= MOST_CORNERS) {
        return false;
    }
    const dea_piece *last = &c->pieces->pieces[c->pieces->count - 1];
    const bool alike = next->step <= 1.5 * last->step && last->step <= 1.5 * next->step;
    return (alike || (c->many && more_steps(last, next) <= netlist_steps)) && !c->signal->segments[last->segment].sine && !c->signal->segments[next->segment].sine;
}

static void add(cutter *c, dea_piece next)
{
    dea_pieces *pieces = c->pieces;
    if (goes_on(c, &next)) {
        dea_piece *last = &pieces->pieces[pieces->count - 1];
        c->corners += last->segment != next.segment;
        pieces->corners += last->segment != next.segment;
        last->to = next.to;
        last->step = fmin(last->step, next.step);
        last->longest = fmax(last->longest, next.longest);
        return;
    }
    dea_piece *grown = dea_grow(pieces->pieces, pieces->count, &c->room, sizeof *grown);
    if (!grown) {
        c->exhausted = true;
        return;
    }
    pieces->pieces = grown;
    c->corners = 0;
    grown[pieces->count++] = next;
}

/* Step wanted at an age since the last corner, and the age up to which it is good: a fraction of the age, since all that was
 * faster has settled; while the ring lives a fraction of its period, longer as it decays (errors of fourth order then weigh the
 * same). */
static double step_at(const cutter *c, double age, double *until)
{
    const dea_pace *pace = c->pace;
    double step = 0.25 * fmax(pace->fastest, age);
    *until = 16.0 * step;
    if (pace->omega > 0.0 && age < c->life) {
        const double decade = pace->decay > 0.0 ? log(10.0) / pace->decay : (double)INFINITY;
        const double passed = floor(age / decade * (1.0 + 1e-9));
        const double ring = fmin(pow(10.0, 0.25 * passed), 1.6) / pace->omega;
        *until = fmin(*until, c->life);
        if (ring < step) {
            *until = fmin(c->life, (passed + 1.0) * decade);
            step = ring;
        }
    }
    return step;
}

/* A change of the square of the voltage that is a corner where a segment that stands for lines begins, over the largest. */
static const double cornered = 1e-2;

/* True where a segment that stands for lines goes on from the one before: what it excites its length resolves. */
static bool continues(const cutter *c, size_t index)
{
    const dea_segment *segment = &c->signal->segments[index];
    const double before = index > 0 ? segment[-1].end : 0.0, change = segment->start * segment->start - before * before;
    return segment->terms && fabs(change) <= cornered * c->signal->largest * c->signal->largest;
}

static void cut_segment(cutter *c, size_t index, bool quiet)
{
    const dea_segment *segment = &c->signal->segments[index];
    const double length = segment->to - segment->from;
    const bool still = !segment->sine && segment->start == segment->end;
    const double turn = dea_segment_turn(c->signal, segment);
    const double limit = still ? length : segment->sine ? fmin(0.5 / turn, 0.25 * length) : 0.25 * length;
    const bool brief = c->many && !segment->sine && length <= short_edge * c->pace->fastest;
    const bool jump = index > 0 && c->signal->segments[index - 1].end != segment->start;
    const bool smooth = continues(c, index);
    const double ring = c->pace->omega > 0.0 ? 1.0 / c->pace->omega : length;
    double age = 0.0;
    while (age < length && !c->exhausted) {
        double until = length;
        const double wanted = quiet ? length : smooth ? ring : step_at(c, age, &until);
        if (!(until < length - rest_share[c->many] * (until - age))) {
            until = length;
        }
        const double seen = fmin(fmin(limit, wanted), 0.125 * (until - age)); /* finer steps must differ from the first few */
        const double step = brief ? wanted : seen;
        add(c, (dea_piece){.from = segment->from + age,
                           .to = until == length ? segment->to : segment->from + until,
                           .step = step,
                           .longest = until - age,
                           .segment = index,
                           .rings = !quiet && c->pace->omega > 0.0 && age < c->life,
                           .jump = jump && age == 0.0});
        age = until;
    }
}

dea_status dea_pieces_cut(const dea_signal *signal, const dea_pace *pace, double accuracy, double life, bool quiet,
                          dea_pieces *pieces, dea_error *error)
{
    cutter c = {.signal = signal, .pace = pace, .pieces = pieces};
    *pieces = (dea_pieces){0};
    c.many = signal->count > MANY_SEGMENTS;
    c.life = life > 0.0 ? life : pace->decay > 0.0 ? log(10.0 / accuracy) / pace->decay : (double)INFINITY;
    for (size_t i = 0; i < signal->count; i++) {
        const dea_segment *segment = &signal->segments[i];
        cut_segment(&c, i, i == 0 && quiet && !segment->sine && segment->start == segment->end);
    }
    if (c.exhausted) {
        return dea_fail(error, DEA_ERROR_MEMORY, "out of memory for the pieces of a run");
    }
    for (size_t i = 0; i < pieces->count; i++) {
        dea_piece *piece = &pieces->pieces[i];
        piece->step = fmin(piece->step, between_corners * piece->longest);
        pieces->points += (piece->to - piece->from) / piece->step;
    }
    return DEA_OK;
}

double dea_pieces_ringing(const dea_pieces *pieces)
{
    double time = 0.0;
    for (size_t i = 0; i < pieces->count; i++) {
        time += pieces->pieces[i].rings ? pieces->pieces[i].to - pieces->pieces[i].from : 0.0;
    }
    return time;
}
