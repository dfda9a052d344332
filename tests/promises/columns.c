/* Columns of transients that follow from displacement and charge: each within ten accuracies of its scale, as `deaspice check`
 * measures them. */
#include <math.h>
#include <stddef.h>

#include "scene/line.h"
#include "promises.h"
#include "result/scales.h"

static const struct {
    size_t offset;
    const char *name;
} columns[] = {
    {offsetof(dea_sample, velocity), "velocity"}, {offsetof(dea_sample, force), "force"},
    {offsetof(dea_sample, current), "current"},   {offsetof(dea_sample, charge), "charge"},
    {offsetof(dea_sample, focal_length), "focal_length"}, {offsetof(dea_sample, film_voltage), "film_voltage"},
    {offsetof(dea_sample, capacitance), "capacitance"},
};

static bool has(const judged *j, size_t offset)
{
    for (size_t i = 0; i < j->layout.column_count; i++) {
        if (j->layout.columns[i].offset == offset) {
            return true;
        }
    }
    return false;
}

static void hold(const true_run *truth, const dea_sample *rows, size_t offset, const char *name, double scale, column_error *worst)
{
    for (size_t i = 0; i < truth->good; i++) {
        const double got = number_at(&rows[i], offset), wanted = number_at(&truth->samples[i], offset);
        const bool delivered = rows[i].state != DEA_STATE_FAILED && rows[i].state != DEA_STATE_PULL_IN;
        const double gap = fabs(got - wanted);
        const double error = !delivered || gap <= 0.0 ? 0.0 : isfinite(gap) ? gap / scale : (double)INFINITY;
        if (error > worst->error) {
            *worst = (column_error){name, i, error};
        }
    }
}

column_error columns_error(const judged *j, size_t point, const dea_sample *rows, double accuracy)
{
    column_error worst = {.column = ""};
    dea_scene here = j->scene;
    dea_axes_place(&here, point);
    const true_run *truth = &j->runs[point];
    const dea_scales scales = dea_scales_open(&here, here.models[0]);
    const dea_sample scale = dea_scales_of(&scales, truth->samples, truth->good);
    for (size_t c = 0; c < sizeof columns / sizeof *columns; c++) {
        const size_t offset = columns[c].offset;
        const double promise = dea_scales_allowance(offset) * number_at(&scale, offset);
        if (has(j, offset) && number_at(&truth->errors, offset) <= 0.1 * accuracy * promise) {
            hold(truth, rows, offset, columns[c].name, promise, &worst);
        }
    }
    return worst;
}

column_error means_error(const judged *j, size_t point, const dea_summary *summary, double peak, double accuracy)
{
    column_error worst = {.column = ""};
    const true_run *truth = &j->runs[point];
    const dea_transient *run = &j->scene.transient;
    const double last = truth->good > 0 ? truth->samples[truth->good - 1].time : -1.0;
    for (size_t i = 0; i < run->average_count && truth->mean_error <= 0.1 * accuracy * peak; i++) {
        const double got = summary->averages[i].displacement, gap = fabs(got - truth->means[i]);
        const bool covered = truth->good == truth->count || (run->averages[i].to <= last && !isnan(got));
        const double error = !covered || gap <= 0.0 ? 0.0 : isfinite(gap) ? gap / peak : (double)INFINITY;
        if (error > worst.error) {
            worst = (column_error){"mean", i, error};
        }
    }
    return worst;
}

column_error told_error(const judged *j, size_t point, const dea_sample *rows, const dea_summary *summary)
{
    const true_run *truth = &j->runs[point];
    const dea_scales scales = dea_scales_open(&j->scene, j->scene.models[0]);
    const dea_sample scale = dea_scales_of(&scales, truth->samples, truth->good);
    const struct {
        size_t offset;
        double told;
        const char *name;
    } held[] = {{offsetof(dea_sample, displacement), summary->error, "error of the displacement"},
                {offsetof(dea_sample, velocity), summary->velocity_error, "error of the velocity"},
                {offsetof(dea_sample, current), summary->current_error, "error of the current"}};
    column_error worst = {.column = ""};
    for (size_t c = 0; c < sizeof held / sizeof *held; c++) {
        const double whole = number_at(&scale, held[c].offset);
        if (has(j, held[c].offset) && number_at(&truth->errors, held[c].offset) <= 0.1 * held[c].told * whole) {
            hold(truth, rows, held[c].offset, held[c].name, whole * held[c].told, &worst);
        }
    }
    return worst;
}
