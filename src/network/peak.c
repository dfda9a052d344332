#include "network/peak.h"

#include <math.h>

/* Places of a stretch that are looked at, and what its ends must have of the largest so far: it is short beside all that the film
 * does, so that the current inside is no more than a little larger. */
enum { PLACES = 5 };
static const double near = 0.8;

/* A current whose places differ by no more than such a share has no top worth finding: that of a source at its limit. */
static const double flat = 1e-9;

/* Golden section: share of an interval that stays, and rounds that leave 1e-8 of it, where a smooth top no longer changes. */
static const double golden = 0.61803398874989484820;
enum { ROUNDS = 40 };

static void see(dea_peak *peak, double current, double time)
{
    if (fabs(current) > peak->current) {
        *peak = (dea_peak){fabs(current), time};
    }
}

/* The largest magnitude between two times, with one larger than both ends in between. */
static void close_in(dea_peak *peak, double from, double to, dea_current_at *at, void *user)
{
    double low = to - golden * (to - from), high = from + golden * (to - from);
    double first = fabs(at(user, low)), second = fabs(at(user, high));
    for (int i = 0; i < ROUNDS; i++) {
        if (first > second) {
            to = high, high = low, second = first;
            low = to - golden * (to - from);
            first = fabs(at(user, low));
        } else {
            from = low, low = high, first = second;
            high = from + golden * (to - from);
            second = fabs(at(user, high));
        }
    }
    see(peak, first > second ? first : second, first > second ? low : high);
}

void dea_peak_search(dea_peak *peak, double from, double to, dea_current_at *at, void *user)
{
    double times[PLACES], sizes[PLACES];
    for (int i = 0; i < PLACES; i += PLACES - 1) {
        times[i] = i == 0 ? from : to;
        sizes[i] = fabs(at(user, times[i]));
    }
    if (fmax(sizes[0], sizes[PLACES - 1]) < near * peak->current) {
        return;
    }
    int largest = 0, least = 0;
    for (int i = 1; i < PLACES; i++) {
        if (i < PLACES - 1) {
            times[i] = from + (to - from) * i / (PLACES - 1);
            sizes[i] = fabs(at(user, times[i]));
        }
        largest = sizes[i] > sizes[largest] ? i : largest;
        least = sizes[i] < sizes[least] ? i : least;
    }
    see(peak, sizes[largest], times[largest]);
    if (sizes[largest] - sizes[least] <= flat * sizes[largest]) {
        return;
    }
    if (largest > 0 && largest < PLACES - 1) {
        close_in(peak, times[largest - 1], times[largest + 1], at, user);
    } else { /* the top may lie next to an end */
        close_in(peak, times[largest == 0 ? 0 : PLACES - 2], times[largest == 0 ? 1 : PLACES - 1], at, user);
    }
}

bool dea_peak_jumps(const dea_scene *scene, const dea_signal *signal)
{
    double before = scene->transient.from_bias ? signal->segments[0].start : 0.0;
    for (size_t i = 0; i < signal->count; i++) {
        if (signal->segments[i].start != before) {
            return true;
        }
        before = signal->segments[i].end;
    }
    return false;
}

bool dea_peak_is_known(const dea_scene *scene, const dea_dynamics *dynamics, const dea_signal *signal)
{
    const dea_reduction *reduction = &scene->reduction;
    const bool heavy = dea_point_mass(scene, &dynamics->point) > 0.0;
    if (!dynamics->port || dynamics->dropped > 0.0 || (reduction->mass && heavy) ||
        (reduction->damper && scene->material.retardation > 0.0)) {
        return false;
    }
    for (size_t i = 0; i < scene->material.prony_count; i++) {
        const dea_branch_form form = reduction->branches[i];
        if (form == DEA_BRANCH_DAMPER || form == DEA_BRANCH_OUT) {
            return false;
        }
    }
    return dynamics->series > 0.0 || !dea_peak_jumps(scene, signal);
}

void dea_peak_tell(const dea_peak *before, const dea_peak *last, double accuracy, dea_summary *summary)
{
    if (fabs(before->current - last->current) <= 10.0 * accuracy * last->current) {
        summary->peak_current = last->current;
        summary->peak_time = last->time;
    }
}
