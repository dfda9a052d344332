/* Errors of settings against the reference of their model, and of models against the exact membrane. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "bench/work.h"

/* Steps of the climb to a reference, what a step costs at least over the one before, and at most. */
enum { CLIMB = 3 };
static const double climb_guess = 4.0, climb_least = 2.0, climb_most = 30.0;

uint64_t dea_bench_digest(const dea_layout *layout, const char *points, size_t count)
{
    uint64_t digest = 14695981039346656037u; /* FNV-1a over words */
    for (size_t i = 0; i < count * layout->rows; i++) {
        const char *row = points + i / layout->rows * layout->point_size + i % layout->rows * layout->row_size;
        for (size_t c = 0; c < layout->column_count; c++) {
            uint64_t word;
            memcpy(&word, row + layout->columns[c].offset, sizeof word);
            digest = (digest ^ word) * 1099511628211u;
            digest ^= digest >> 32;
        }
        digest = (digest ^ (uint64_t)dea_layout_state(layout, row)) * 1099511628211u;
    }
    return digest;
}

const dea_engine *dea_bench_best(const dea_scene *scene)
{
    const dea_engine *best = NULL;
    size_t most = 0;
    for (size_t i = 0; i < dea_engine_count(); i++) {
        const char *why;
        const size_t rungs = dea_bench_rungs(dea_engine_at(i), scene, &why);
        if (rungs > most) {
            most = rungs;
            best = dea_engine_at(i);
        }
    }
    return best;
}

/* Makes the points in the buffer the reference. */
static dea_status fill(dea_bench_work *work, dea_bench_truth *truth, uint64_t digest, dea_error *error)
{
    dea_comparison_close(&truth->comparison);
    dea_status status = dea_comparison_open(&truth->comparison, &truth->scene, error);
    if (status == DEA_OK) {
        status = dea_comparison_take(&truth->comparison, 0, work->buffer, work->points, error);
    }
    truth->comparison.filling = false;
    truth->digest = digest;
    truth->known = status == DEA_OK;
    return status;
}

static void note_reference(dea_bench_work *work, size_t number, const dea_engine *engine, double accuracy, bool exact)
{
    if (number < work->bench->model_count) {
        dea_bench_model *model = &work->bench->models[number];
        model->reference = engine;
        model->reference_accuracy = accuracy;
        model->exact = exact;
    }
}

dea_status dea_bench_refer(dea_bench_work *work, size_t number, double allowance, dea_error *error)
{
    dea_bench_truth *truth = &work->truths[number];
    const dea_engine *engine = dea_bench_best(&truth->scene);
    const char *why;
    const size_t rungs = engine ? dea_bench_rungs(engine, &truth->scene, &why) : 0;
    double last = (double)NAN, expected = 0.0;
    size_t steps = 0, alike = 0; /* steps that gave the numbers of the one before */
    for (size_t rung = rungs % CLIMB; rung <= rungs && rungs > 0 && expected <= allowance; rung += CLIMB) {
        if (rung == 0) {
            continue;
        }
        double seconds;
        const double accuracy = dea_bench_accuracy(rung - 1);
        dea_status status = dea_bench_solve(work, engine, &truth->scene, accuracy, true, work->buffer, &seconds, error);
        if (status == DEA_ERROR_INTERRUPTED || status == DEA_ERROR_MEMORY) {
            return status;
        }
        if (status != DEA_OK) { /* the ladder will tell why */
            *error = (dea_error){0};
            break;
        }
        const uint64_t digest = dea_bench_digest(&work->layout, work->buffer, work->points);
        alike += truth->known && digest == truth->digest;
        steps++;
        status = fill(work, truth, digest, error);
        if (status != DEA_OK) {
            return status;
        }
        note_reference(work, number, engine, accuracy, alike > 0 && alike + 1 == steps);
        allowance -= seconds;
        expected = seconds * (isnan(last) ? climb_guess : fmin(fmax(seconds / last, climb_least), climb_most));
        last = seconds;
    }
    return DEA_OK;
}

void dea_bench_judge(dea_bench_work *work, dea_bench_setting *setting, uint64_t digest)
{
    dea_bench_truth *truth = &work->truths[setting->model];
    if (!truth->known) {
        return;
    }
    dea_comparison *comparison = &truth->comparison;
    dea_comparison_forget(comparison);
    dea_comparison_take(comparison, 0, work->buffer, work->points, NULL);
    setting->reference = digest == truth->digest && setting->engine == work->bench->models[setting->model].reference;
    setting->error = dea_comparison_worst(comparison);
    setting->states = comparison->states;
    setting->failed = comparison->failed;
}

/* ---- conclusions */

/* Is @p a at least as good as @p b in time and error, and better in one? */
static bool dominates(const dea_bench_setting *a, const dea_bench_setting *b)
{
    const double error_a = a->failed > 0 || a->states > 0 ? (double)INFINITY : a->error;
    const double error_b = b->failed > 0 || b->states > 0 ? (double)INFINITY : b->error;
    return a->seconds <= b->seconds && error_a <= error_b && (a->seconds < b->seconds || error_a < error_b);
}

static void mark_dominated(dea_bench *bench)
{
    for (size_t i = 0; i < bench->setting_count; i++) {
        dea_bench_setting *setting = &bench->settings[i];
        setting->dominated = false;
        for (size_t k = 0; k < bench->setting_count && setting->state == DEA_BENCH_MEASURED; k++) {
            const dea_bench_setting *other = &bench->settings[k];
            setting->dominated = setting->dominated || (other->state == DEA_BENCH_MEASURED && other->model == setting->model &&
                                                        dominates(other, setting));
        }
    }
}

/* The reference of another kind than a closed form may itself be off by what it promises. */
static void mark_broken(dea_bench *bench)
{
    for (size_t i = 0; i < bench->setting_count; i++) {
        dea_bench_setting *setting = &bench->settings[i];
        const dea_bench_model *model = &bench->models[setting->model];
        const double allowed = setting->accuracy + (model->exact ? 0.0 : model->reference_accuracy);
        const bool judged = setting->state == DEA_BENCH_MEASURED && model->reference && !setting->reference;
        setting->broken = judged && (setting->states > 0 || !(setting->error <= allowed));
    }
}

static void find_checks(dea_bench *bench)
{
    for (size_t i = 0; i < bench->setting_count; i++) {
        const dea_bench_setting *setting = &bench->settings[i];
        dea_bench_model *model = &bench->models[setting->model];
        const bool other = setting->state == DEA_BENCH_MEASURED && model->reference && setting->engine != model->reference;
        if (other && (!model->check || setting->error < model->apart)) {
            model->check = setting->engine;
            model->check_accuracy = setting->accuracy;
            model->apart = setting->error;
        }
    }
}

void dea_bench_conclude(dea_bench *bench)
{
    mark_broken(bench);
    mark_dominated(bench);
    find_checks(bench);
}

/* ---- models against the membrane */

static int compare(const void *left, const void *right)
{
    const double a = *(const double *)left, b = *(const double *)right;
    return (a > b) - (a < b);
}

static dea_row row_of(const dea_bench_truth *truth, size_t i)
{
    dea_row row;
    memcpy(&row, truth->comparison.reference + i * truth->comparison.layout.point_size, sizeof row);
    return row;
}

static void judge_model(const dea_bench_work *work, size_t number, double *errors)
{
    dea_bench_model *model = &work->bench->models[number];
    const dea_bench_truth *own = &work->truths[number], *field = &work->truths[work->bench->model_count];
    for (size_t i = 0; i < work->points; i++) {
        const dea_row row = row_of(own, i), exact = row_of(field, i);
        if (row.state != DEA_STATE_OK || exact.state != DEA_STATE_OK) {
            model->error_left_out++;
        } else if (exact.strain != 0.0) { /* nothing moves where nothing pulls */
            errors[model->error_points++] = fabs(row.strain / exact.strain - 1.0);
        }
    }
    if (model->error_points > 0) {
        const size_t count = model->error_points;
        qsort(errors, count, sizeof *errors, compare);
        model->error_median = 0.5 * (errors[(count - 1) / 2] + errors[count / 2]);
        model->error_worst = errors[count - 1];
    }
}

dea_status dea_bench_judge_models(dea_bench_work *work, dea_error *error)
{
    const dea_bench *bench = work->bench;
    const dea_bench_truth *field = &work->truths[bench->model_count];
    if (!field->known) {
        return DEA_OK;
    }
    double *errors = malloc(work->points * sizeof *errors);
    if (!errors) {
        return dea_fail(error, DEA_ERROR_MEMORY, "out of memory for %zu errors", work->points);
    }
    for (size_t i = 0; i < bench->model_count; i++) {
        if (work->truths[i].known && bench->models[i].model != field->scene.models[0]) {
            judge_model(work, i, errors);
        }
    }
    free(errors);
    return DEA_OK;
}
