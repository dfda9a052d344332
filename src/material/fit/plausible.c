#include "material/fit/plausible.h"

#include "material/fit/test.h"

#include <math.h>
#include <stdlib.h>

/* No elastomer film is stretched further: natural rubber tears at 7, VHB 4910 at 9 to 10. */
static const double stretch_most = 12.0;
/* Stresses below this share of the largest one are noise about 0, and have no sign. */
static const double stress_noise = 0.02;
/* An unloading that a fit would feel: this share of the range of the stretches. */
static const double turn_share = 0.2;
/* Largest step of an unloading, as a share of the way back: a larger one is the next test in the table. */
static const double turn_step = 0.5;
/* A rise is none of noise from so many standard deviations of a point on, and none of the film's from this share of the peak on. */
static const double rise_noise = 8.0, rise_share = 0.01;
/* Noise about 0 of a stress that has relaxed away, as a share of the largest stress. */
static const double below_zero = 0.1;

static double largest_stress(const dea_fit_data *data)
{
    double largest = 0.0;
    for (size_t i = 0; i < data->count; i++) {
        largest = fmax(largest, fabs(data->points[i].stress));
    }
    return largest;
}

dea_status dea_plausible_stretches(const dea_fit_data *data, dea_error *error)
{
    const double noise = stress_noise * largest_stress(data);
    double most = 0.0, least = INFINITY;
    size_t below = 0, pulled = 0;
    for (size_t i = 0; i < data->count; i++) {
        const dea_fit_point *point = &data->points[i];
        most = fmax(most, point->stretch);
        least = fmin(least, point->stretch);
        below += point->stretch < 1.0 && fabs(point->stress) > noise;
        pulled += point->stretch < 1.0 && point->stress > noise;
    }
    if (most > stretch_most) {
        return dea_fail(error, DEA_ERROR_DATA,
                        "stretches from %.6g to %.6g look like percent; a stretch is length over length at rest: divide percent of "
                        "length by 100, or take 1 + strain",
                        least, most);
    }
    if (pulled > 0 && 2 * pulled > below) {
        return dea_fail(error, DEA_ERROR_DATA,
                        "%zu points have a stress above 0 at a stretch below 1: a strain is no stretch (take 1 + strain), and the "
                        "stress of a compression is negative",
                        pulled);
    }
    return DEA_OK;
}

double dea_plausible_turn(const dea_fit_data *data)
{
    double least = INFINITY, most = -INFINITY, peak = -INFINITY, step = 0.0;
    for (size_t i = 0; i < data->count; i++) {
        least = fmin(least, data->points[i].stretch);
        most = fmax(most, data->points[i].stretch);
    }
    for (size_t i = 0; i < data->count; i++) {
        const double stretch = data->points[i].stretch;
        const bool other = i > 0 && data->points[i].load != data->points[i - 1].load;
        if (stretch >= peak || other) {
            peak = stretch;
            step = 0.0;
            continue;
        }
        step = fmax(step, data->points[i - 1].stretch - stretch);
        if (peak - stretch > turn_share * (most - least) && step < turn_step * (peak - stretch)) {
            return peak;
        }
    }
    return NAN;
}

static int ascending(const void *a, const void *b)
{
    const double x = *(const double *)a, y = *(const double *)b;
    return (x > y) - (x < y);
}

/* Standard deviation of a point, by the median of what it is off from the line through its neighbours: d = s_i - (1 - f) s_(i-1) -
 * f s_(i+1) has the variance 1 + (1 - f)^2 + f^2 of a point's, and the median of a normal |d| is 0.6745 of its deviation. */
static dea_status point_noise(const dea_relaxation_data *data, double *noise, dea_error *error)
{
    const size_t count = data->count - 2;
    double *off = malloc(count * sizeof *off);
    if (!off) {
        return dea_fail(error, DEA_ERROR_MEMORY, "out of memory");
    }
    for (size_t i = 0; i < count; i++) {
        const dea_relaxation_point *p = data->points + i;
        const double f = (p[1].time - p[0].time) / (p[2].time - p[0].time);
        off[i] = fabs(p[1].stress - (1.0 - f) * p[0].stress - f * p[2].stress) / sqrt(1.0 + (1.0 - f) * (1.0 - f) + f * f);
    }
    qsort(off, count, sizeof *off, ascending);
    *noise = off[count / 2] / 0.6745;
    free(off);
    return DEA_OK;
}

bool dea_plausible_negative(double stress, double largest)
{
    return stress < -below_zero * largest;
}

/* The point of the lowest or the largest value. */
static const dea_relaxation_point *extreme_of(const dea_relaxation_data *data, double sign)
{
    const dea_relaxation_point *found = data->points;
    for (size_t i = 1; i < data->count; i++) {
        found = sign * data->points[i].stress > sign * found->stress ? &data->points[i] : found;
    }
    return found;
}

/* Moduli that fall with the frequency, and a loss that is negative beyond noise. */
static dea_status dynamic_check(const dea_relaxation_data *data, double largest, double least, dea_error *error)
{
    const double first = data->points[0].stress, last = data->points[data->count - 1].stress;
    if (first - last > least) {
        return dea_fail(error, DEA_ERROR_DATA, dea_test_of(data->kind)->mirrored, first, last);
    }
    for (size_t i = 0; i < data->count; i++) {
        const double loss = data->points[i].loss;
        if (dea_plausible_negative(loss, largest)) {
            return dea_fail(error, DEA_ERROR_USAGE, "a loss modulus of %.6g Pa at %.6g Hz: a film takes energy, it gives none", loss,
                            data->points[i].time / (2.0 * DEA_PI));
        }
    }
    return DEA_OK;
}

dea_status dea_plausible_relaxation(const dea_relaxation_data *data, dea_error *error)
{
    const dea_test *test = dea_test_of(data->kind);
    const dea_relaxation_point *first = data->points, *last = first + data->count - 1;
    const dea_relaxation_point *peak = extreme_of(data, 1.0), *lowest = extreme_of(data, -1.0);
    double noise = 0.0;
    const dea_status status = point_noise(data, &noise, error);
    if (status != DEA_OK) {
        return status;
    }
    if (dea_plausible_negative(lowest->stress, peak->stress)) {
        return dea_fail(error, DEA_ERROR_USAGE, "a %s of %.6g%s at %.6g %s: %s", test->quantity, lowest->stress, test->unit,
                        test->periodic ? lowest->time / (2.0 * DEA_PI) : lowest->time, test->periodic ? "Hz" : "s", test->negative);
    }
    const double least = fmax(rise_noise * noise, rise_share * peak->stress);
    if (test->periodic) {
        return dynamic_check(data, peak->stress, least, error);
    }
    /* A peak at an end is growth, or decay, which the branches themselves tell. */
    if (peak == last || !(peak->stress - first->stress > least) || !(peak->stress - last->stress > least)) {
        return DEA_OK;
    }
    return data->kind == DEA_TEST_CREEP
               ? dea_fail(error, DEA_ERROR_DATA,
                          "the strain grows to %.6g at %.6g s and then falls to %.6g: a creep test is of one stress; leave out the %zu rows "
                          "behind",
                          peak->stress, peak->time, last->stress, (size_t)(last - peak))
               : dea_fail(error, DEA_ERROR_DATA,
                          "the stress rises from %.6g Pa to %.6g Pa at %.6g s before it falls: time counts from the end of the ramp; "
                          "leave out the %zu rows before and subtract %.6g s from the times",
                          first->stress, peak->stress, peak->time, (size_t)(peak - first), peak->time);
}
