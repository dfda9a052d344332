#include "result/compare.h"

#include <float.h>
#include <math.h>
#include <stddef.h>
#include <stdlib.h>
#include <string.h>

#include "scene/line.h"
#include "network/dynamics.h"
#include "result/scales.h"
#include "study/study.h"

/* Numbers below this share of a column's largest reference value are compared with that instead of with themselves. */
static const double negligible = 1e-9;

/* True of statics where something else moves the edge than the voltage of the film: a displacement is then the difference of two, and
 * right relative to the larger of it and the rest without that voltage. */
static bool is_pulled(const dea_scene *scene)
{
    return !dea_study_of(scene)->along && dea_scene_is_pulled(scene);
}

/* Columns that engines must agree on. */
static void choose_columns(dea_comparison *comparison)
{
    static const size_t ways[] = {offsetof(dea_row, strain), offsetof(dea_row, displacement), offsetof(dea_row, area_strain)};
    const dea_study *study = dea_study_of(comparison->scene);
    const bool pulled = is_pulled(comparison->scene);
    for (size_t i = 0; i < study->compared_count; i++) {
        const dea_study_column *known = &study->compared[i];
        for (size_t k = 0; k < comparison->layout.column_count; k++) {
            if (comparison->layout.columns[k].offset == known->offset) {
                const double allowance = study->timed ? dea_scales_allowance(known->offset) : 1.0;
                const bool way = pulled && (known->offset == ways[0] || known->offset == ways[1] || known->offset == ways[2]);
                const dea_measure measure = way ? DEA_OVER_PEAK : known->measure;
                comparison->columns[comparison->column_count++] = (dea_compared){k, measure, known->head, allowance};
            }
        }
    }
}

static double value_of(const dea_comparison *comparison, const char *row, size_t number)
{
    return dea_layout_number(row, comparison->layout.columns[comparison->columns[number].column].offset);
}

/* In frequency: what 1 V would do to the film at rest. Without a bias there is no response at all, whatever its rounding. */
static void set_least_response(dea_comparison *comparison)
{
    dea_dynamics dynamics;
    if (dea_dynamics_open(comparison->scene, comparison->scene->models[0], &dynamics, NULL) == DEA_OK) {
        const dea_response swing = {.displacement = dea_dynamics_scale(&dynamics, 1.0)};
        for (size_t c = 0; c < comparison->column_count; c++) {
            const bool angle = comparison->columns[c].measure == DEA_OVER_RADIAN;
            comparison->least[c] = angle ? 0.0 : value_of(comparison, (const char *)&swing, c);
        }
    }
    dea_dynamics_close(&dynamics);
}

/* Largest magnitude of a column over the rows of a point. */
static double peak_of(const dea_comparison *comparison, const char *point, size_t number)
{
    double peak = 0.0;
    for (size_t i = 0; i < comparison->layout.rows; i++) {
        peak = fmax(peak, fabs(value_of(comparison, point + i * comparison->layout.row_size, number)));
    }
    return peak;
}

/* The film of a point without its voltage. */
static dea_row rest_of(const dea_comparison *comparison, size_t number)
{
    dea_scene here = *comparison->scene;
    dea_point point;
    dea_row rest = dea_row_failed();
    dea_axes_place(&here, number);
    here.drive.voltage = 0.0;
    dea_film_prepare(&here, &point.film);
    dea_point_place(&here, &point);
    if (dea_point_valid(&point)) {
        dea_model_solve(here.models[0], &point, here.accuracy, &rest);
    }
    return rest;
}

/* What the columns of a point of the reference count by. */
static dea_status find_peaks(const dea_comparison *comparison, size_t number, const char *point, double peaks[DEA_COMPARED_COLUMNS])
{
    const bool moving = dea_study_of(comparison->scene)->timed;
    dea_sample of = dea_sample_refused(0.0, 0.0, DEA_STATE_OK);
    if (moving) {
        dea_scene here = *comparison->scene;
        dea_axes_place(&here, number);
        const dea_scales scales = dea_scales_open(&here, here.models[0]);
        if (scales.status == DEA_ERROR_MEMORY) {
            return scales.status;
        }
        of = dea_scales_of(&scales, (const dea_sample *)(const void *)point, comparison->layout.rows);
    }
    const bool pulled = is_pulled(comparison->scene);
    const dea_row rest = pulled ? rest_of(comparison, number) : dea_row_failed();
    for (size_t c = 0; c < comparison->column_count; c++) {
        const double without = pulled ? fabs(value_of(comparison, (const char *)&rest, c)) : comparison->least[c];
        peaks[c] = moving ? value_of(comparison, (const char *)&of, c)
                          : fmax(peak_of(comparison, point, c), without);
    }
    return DEA_OK;
}

static double angle_between(double a, double b)
{
    return fabs(remainder(a - b, 360.0)) * DEA_PI / 180.0;
}

/* |a - b| over @p scale, with b the reference; a number that only one of them has differs without bound. */
static double difference(dea_measure measure, double a, double b, double scale, double peak)
{
    if (isnan(a) && isnan(b)) {
        return 0.0;
    }
    const double gap = measure == DEA_OVER_RADIAN ? angle_between(a, b) : fabs(a - b);
    if (gap <= 0.0) {
        return 0.0;
    }
    const double over = measure == DEA_OVER_RADIAN ? 1.0
                        : measure == DEA_OVER_PEAK ? fmax(peak, negligible * scale)
                                                   : fmax(fabs(b), negligible * scale);
    return isfinite(gap) ? gap / over : (double)INFINITY;
}

/* How much the phase of a number counts: that of one that is negligible beside the largest means nothing, that of a zero is any.
 * Its magnitude is the column before. */
static double weight_of(const dea_comparison *comparison, const char *row, size_t number)
{
    if (comparison->columns[number].measure != DEA_OVER_RADIAN) {
        return 1.0;
    }
    const double magnitude = fabs(value_of(comparison, row, number - 1));
    const double least = negligible * comparison->scale[number - 1];
    return magnitude < least ? magnitude / least : 1.0; /* a NAN is compared */
}

static bool is_failed(const dea_comparison *comparison, const char *row)
{
    return dea_layout_state(&comparison->layout, row) == DEA_STATE_FAILED;
}

/* Samples whose states are right for their own numbers: a limit lies between these, which are compared as all others. */
static bool follow_numbers(const dea_comparison *comparison, const dea_scene *placed, const char *row, const char *wanted, double peak)
{
    dea_sample samples[2];
    memcpy(&samples[0], row, sizeof *samples);
    memcpy(&samples[1], wanted, sizeof *samples);
    return dea_state_follows(placed, &samples[0], comparison->at_limit * peak) &&
           dea_state_follows(placed, &samples[1], comparison->at_limit * peak);
}

/* A film of many nodes passes its limit a moment before a sample in the one, behind it in the other: the sample before or after it has
 * that state in one of both. */
static bool pass_beside(const dea_comparison *comparison, size_t index, const char *row, const char *wanted)
{
    const dea_layout *layout = &comparison->layout;
    const dea_state one = dea_layout_state(layout, row), other = dea_layout_state(layout, wanted);
    bool passes = false;
    for (int side = -1; side <= 1; side += 2) {
        if (side < 0 ? index > 0 : index + 1 < layout->rows) {
            const ptrdiff_t step = side * (ptrdiff_t)layout->row_size;
            passes = passes || dea_layout_state(layout, row + step) == other || dea_layout_state(layout, wanted + step) == one;
        }
    }
    return passes;
}

/* What the voltage of a limit may be off by, over what the first compared column of two answers is: a stress that vanishes inside the
 * film errs more than the displacement of its edge. */
static const double inside = 10.0;

/* Whether two states of a row that has numbers in both are those on the two sides of a limit. */
static bool are_at_limit(const dea_comparison *comparison, size_t number, size_t index, const char *row, const char *wanted, double peak)
{
    const dea_study *study = dea_study_of(comparison->scene);
    const double one = value_of(comparison, row, 0), other = value_of(comparison, wanted, 0);
    dea_scene placed = *comparison->scene;
    dea_axes_place(&placed, number);
    if (isnan(one) || isnan(other)) {
        return false;
    }
    if (study->timed) {
        return placed.models[0]->membrane ? pass_beside(comparison, index, row, wanted)
                                          : follow_numbers(comparison, &placed, row, wanted, peak);
    }
    const bool rests = !study->along || study->rest;
    const double share = comparison->at_limit + inside * fabs(one - other) / fmax(fabs(other), DBL_MIN);
    return rests && (!study->rest || study->rest(&placed, NULL) == DEA_OK) &&
           dea_state_between(&placed, fmin(share, 0.5), dea_layout_state(&comparison->layout, row),
                             dea_layout_state(&comparison->layout, wanted));
}

/* Rows that one of the two did not solve are counted elsewhere: they are no disagreement. */
static void compare_rows(dea_comparison *comparison, size_t number, const char *point, const char *reference,
                         const double peaks[DEA_COMPARED_COLUMNS])
{
    const dea_layout *layout = &comparison->layout;
    for (size_t i = 0; i < layout->rows; i++) {
        const char *row = point + i * layout->row_size, *wanted = reference + i * layout->row_size;
        if (is_failed(comparison, row) || is_failed(comparison, wanted)) {
            continue;
        }
        if (dea_layout_state(layout, row) != dea_layout_state(layout, wanted) &&
            !are_at_limit(comparison, number, i, row, wanted, peaks[0])) {
            comparison->states++;
            continue;
        }
        for (size_t c = 0; c < comparison->column_count; c++) {
            const double found = difference(comparison->columns[c].measure, value_of(comparison, row, c),
                                            value_of(comparison, wanted, c), comparison->scale[c], peaks[c]);
            const double weight = weight_of(comparison, wanted, c);
            comparison->worst[c] = fmax(comparison->worst[c], weight > 0.0 ? weight * found : 0.0);
        }
    }
}

/* Rounding of a swing, over its size: that of films with many branches. */
static const double same_swing = 1e-9;

/* Frequency and decay over the magnitude of the complex root that they are. */
static double swing_gap(const dea_summary *a, const dea_summary *b)
{
    if (isnan(a->resonance) && isnan(b->resonance)) {
        return 0.0;
    }
    const double size = hypot(2.0 * DEA_PI * b->resonance, b->decay);
    const double gap = hypot(2.0 * DEA_PI * (a->resonance - b->resonance), a->decay - b->decay) / size;
    return gap <= same_swing ? 0.0 : isfinite(gap) ? gap : (double)INFINITY;
}

/* What stands behind the rows; a point that one of the two did not solve to its end has no figures. */
static void compare_summaries(dea_comparison *comparison, const char *point, const char *reference, double peak)
{
    const dea_layout *layout = &comparison->layout;
    const dea_summary *a = dea_layout_summary(layout, point), *b = dea_layout_summary(layout, reference);
    if (is_failed(comparison, point + (layout->rows - 1) * layout->row_size) ||
        is_failed(comparison, reference + (layout->rows - 1) * layout->row_size)) {
        return;
    }
    for (size_t i = 0; i < comparison->scene->transient.average_count; i++) {
        const double found = a->averages[i].displacement, wanted = b->averages[i].displacement;
        comparison->mean = fmax(comparison->mean, difference(DEA_OVER_PEAK, found, wanted, 0.0, fmax(peak, fabs(wanted))));
    }
    comparison->swing = fmax(comparison->swing, swing_gap(a, b));
}

static dea_status take_point(dea_comparison *comparison, size_t number, const char *point)
{
    const dea_layout *layout = &comparison->layout;
    char *reference = comparison->reference + number * layout->point_size;
    for (size_t i = 0; i < layout->rows; i++) {
        comparison->failed += is_failed(comparison, point + i * layout->row_size) ? 1 : 0;
    }
    if (dea_study_of(comparison->scene)->timed) {
        const dea_summary *summary = dea_layout_summary(layout, point);
        comparison->error = fmax(comparison->error, summary->error);
        comparison->residual = fmax(comparison->residual, summary->residual);
    }
    double peaks[DEA_COMPARED_COLUMNS];
    if (comparison->filling) {
        memcpy(reference, point, layout->point_size);
    }
    const dea_status status = find_peaks(comparison, number, reference, peaks);
    if (status != DEA_OK) {
        return status;
    }
    for (size_t c = 0; c < comparison->column_count; c++) {
        comparison->scale[c] = fmax(comparison->scale[c], peaks[c]);
    }
    if (!comparison->filling) {
        compare_rows(comparison, number, point, reference, peaks);
        if (dea_study_of(comparison->scene)->timed) {
            compare_summaries(comparison, point, reference, peaks[0]); /* of the displacement */
        }
    }
    return DEA_OK;
}

dea_status dea_comparison_open(dea_comparison *comparison, const dea_scene *scene, dea_error *error)
{
    *comparison = (dea_comparison){.scene = scene,
                                   .layout = dea_layout_of(scene),
                                   .points = dea_scene_point_count(scene),
                                   .filling = true,
                                   .at_limit = negligible};
    choose_columns(comparison);
    if (dea_study_of(scene)->phasors) {
        set_least_response(comparison);
    }
    dea_comparison_forget(comparison);
    comparison->reference = malloc(comparison->points * comparison->layout.point_size);
    return comparison->reference ? DEA_OK : dea_fail(error, DEA_ERROR_MEMORY, "out of memory for %zu points", comparison->points);
}

void dea_comparison_close(dea_comparison *comparison)
{
    free(comparison->reference);
    comparison->reference = NULL;
}

void dea_comparison_forget(dea_comparison *comparison)
{
    memset(comparison->worst, 0, sizeof comparison->worst);
    comparison->mean = comparison->swing = 0.0;
    comparison->states = 0;
    comparison->failed = 0;
    comparison->error = (double)NAN;
    comparison->residual = (double)NAN;
}

dea_status dea_comparison_take(dea_comparison *comparison, size_t first, const void *points, size_t count, dea_error *error)
{
    if (first > comparison->points || count > comparison->points - first) {
        return dea_fail(error, DEA_ERROR_ENGINE, "more points than the study has");
    }
    for (size_t i = 0; i < count; i++) {
        if (take_point(comparison, first + i, (const char *)points + i * comparison->layout.point_size) != DEA_OK) {
            return dea_fail(error, DEA_ERROR_MEMORY, "out of memory for the scales of a run");
        }
    }
    return DEA_OK;
}

double dea_comparison_worst(const dea_comparison *comparison)
{
    double worst = fmax(comparison->mean, comparison->swing);
    for (size_t c = 0; c < comparison->column_count; c++) {
        worst = fmax(worst, comparison->worst[c] / comparison->columns[c].allowance);
    }
    return worst;
}
