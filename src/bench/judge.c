/* Errors of settings against the reference of their model, and of models against the exact membrane. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "bench/work.h"
#include "study/study.h"

/* Rungs of a long step of the climb to a reference; and rungs that are enough where only errors of models are judged, 1e-6. */
enum { CLIMB = 3, MODEL_RUNGS = 5 };

/* What a rung costs over the one below it, as long as only one is known, and bounds of what is seen. */
static const double growth_guess = 1.6, growth_least = 1.25, growth_most = 3.0;

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
    status = status ? status : dea_comparison_take(&truth->comparison, 0, work->buffer, work->points, error);
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

/* The climb to a reference: ever tighter runs of one engine, as long as time allows. */
typedef struct ascent {
    const dea_engine *engine;
    size_t rungs, rung;     /* rungs that the engine takes; those that are climbed, 0: none yet */
    size_t steps, alike;    /* runs, and those that gave the numbers of the one before */
    size_t failed;          /* rows that the reference so far does not solve */
    double seconds, growth; /* of the last run; what a rung costs over the one below it */
    double allowance;       /* time that is left [s] */
} ascent;

/* Rung of the next run: a long step up, a short one where time allows no more, 0: none. Long steps end at the top. */
static size_t next_rung(const ascent *up)
{
    if (up->rung == 0) {
        return up->rungs % CLIMB > 0 ? up->rungs % CLIMB : up->rungs < CLIMB ? up->rungs : CLIMB;
    }
    for (size_t step = CLIMB; step > 0; step = step == CLIMB ? 1 : 0) {
        if (up->rung + step <= up->rungs && up->seconds * pow(up->growth, (double)step) <= up->allowance) {
            return up->rung + step;
        }
    }
    return 0;
}

static size_t count_failed(const dea_bench_work *work)
{
    size_t failed = 0;
    for (size_t i = 0; i < work->points * work->layout.rows; i++) {
        const char *point = work->buffer + i / work->layout.rows * work->layout.point_size;
        const char *row = point + i % work->layout.rows * work->layout.row_size;
        failed += dea_layout_state(&work->layout, row) == DEA_STATE_FAILED;
    }
    return failed;
}

/* One run; ends the climb where it solves fewer rows than the reference that there is. */
static dea_status climb(dea_bench_work *work, dea_bench_truth *truth, ascent *up, size_t rung, dea_error *error)
{
    double seconds;
    dea_status status =
        dea_bench_solve(work, up->engine, &truth->scene, dea_bench_accuracy(rung - 1), true, work->buffer, &seconds, error);
    if (status == DEA_ERROR_INTERRUPTED || status == DEA_ERROR_MEMORY) {
        return status;
    }
    const size_t failed = status == DEA_OK ? count_failed(work) : SIZE_MAX;
    if (failed >= work->points * work->layout.rows || (up->steps > 0 && failed > up->failed)) {
        *error = (dea_error){0}; /* the ladder will tell why */
        up->rungs = 0;
        return DEA_OK;
    }
    const uint64_t digest = dea_bench_digest(&work->layout, work->buffer, work->points);
    up->alike += up->steps > 0 && digest == truth->digest;
    if (up->steps > 0) {
        const double growth = pow(seconds / up->seconds, 1.0 / (double)(rung - up->rung));
        up->growth = fmin(fmax(growth, growth_least), growth_most);
    }
    up->steps++;
    up->rung = rung;
    up->failed = failed;
    up->seconds = seconds;
    up->allowance -= seconds;
    return fill(work, truth, digest, error);
}

dea_status dea_bench_refer(dea_bench_work *work, size_t number, double allowance, dea_error *error)
{
    dea_bench_truth *truth = &work->truths[number];
    const char *why;
    ascent up = {.engine = dea_bench_best(&truth->scene), .growth = growth_guess, .allowance = allowance};
    up.rungs = up.engine ? dea_bench_rungs(up.engine, &truth->scene, &why) : 0;
    if (number == work->bench->model_count && up.rungs > MODEL_RUNGS) {
        up.rungs = MODEL_RUNGS;
    }
    dea_status status = DEA_OK;
    for (size_t rung = next_rung(&up); rung > 0 && status == DEA_OK; rung = up.rungs > 0 ? next_rung(&up) : 0) {
        status = climb(work, truth, &up, rung, error);
    }
    if (status == DEA_OK && truth->known) {
        note_reference(work, number, up.engine, dea_bench_accuracy(up.rung - 1), up.alike > 0 && up.alike + 1 == up.steps);
    }
    return status;
}

void dea_bench_judge(dea_bench_work *work, dea_bench_setting *setting, uint64_t digest)
{
    dea_bench_truth *truth = &work->truths[setting->model];
    if (!truth->known) {
        return;
    }
    dea_comparison *comparison = &truth->comparison;
    dea_comparison_forget(comparison);
    if (dea_comparison_take(comparison, 0, work->buffer, work->points, NULL) != DEA_OK) {
        setting->error = (double)NAN; /* out of memory: not judged */
        return;
    }
    setting->reference = digest == truth->digest && setting->engine == work->bench->models[setting->model].reference;
    setting->error = comparison->failed < work->bench->rows ? dea_comparison_worst(comparison) : (double)NAN;
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
        const bool unsolved = isnan(setting->error) && setting->failed > 0;
        setting->broken = judged && !unsolved && (setting->states > 0 || !(setting->error <= allowed));
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

dea_bench_truth *dea_bench_membrane(const dea_bench_work *work)
{
    const size_t models = work->bench->model_count;
    for (size_t i = 0; i < models; i++) {
        if (work->bench->models[i].model == work->truths[models].scene.models[0]) {
            return &work->truths[i];
        }
    }
    return &work->truths[models];
}

/* Row number i of a reference. */
static const void *row_of(const dea_bench_truth *truth, size_t i)
{
    const dea_layout *layout = &truth->comparison.layout;
    return truth->comparison.reference + i / layout->rows * layout->point_size + i % layout->rows * layout->row_size;
}

/* What a model is held against the membrane by: strain, displacement over time, displacement per volt. */
static double answer_of(const dea_study *study, const void *row)
{
    return study->timed     ? ((const dea_sample *)row)->displacement
           : study->phasors ? ((const dea_response *)row)->displacement
                            : ((const dea_row *)row)->strain;
}

/* Size of the answer of the run that row number i belongs to: over time its largest, else its own. */
static double size_of(const dea_study *study, const dea_bench_truth *field, size_t i)
{
    const size_t rows = field->comparison.layout.rows, first = i - i % rows;
    double largest = fabs(answer_of(study, row_of(field, i)));
    for (size_t k = first; k < first + rows && study->timed; k++) {
        largest = fmax(largest, fabs(answer_of(study, row_of(field, k))));
    }
    return largest;
}

/* Numbers of a row count over time in whatever state, in statics where both are ok. */
static bool comparable(const dea_study *study, const dea_layout *layout, const void *row, const void *exact)
{
    const bool ok = dea_layout_state(layout, row) == DEA_STATE_OK && dea_layout_state(layout, exact) == DEA_STATE_OK;
    return (ok || study->along) && isfinite(answer_of(study, row)) && isfinite(answer_of(study, exact));
}

static void judge_model(const dea_bench_work *work, size_t number, double *errors)
{
    dea_bench_model *model = &work->bench->models[number];
    const dea_study *study = dea_study_of(work->bench->scene);
    const dea_bench_truth *own = &work->truths[number], *field = dea_bench_membrane(work);
    double size = 0.0, squares = 0.0;
    for (size_t i = 0; i < work->bench->rows; i++) {
        const void *row = row_of(own, i), *exact = row_of(field, i);
        size = i % work->layout.rows == 0 || !study->timed ? size_of(study, field, i) : size;
        if (!comparable(study, &work->layout, row, exact)) {
            model->error_left_out++;
        } else if (size > 0.0) { /* nothing moves where nothing pulls */
            const double error = fabs(answer_of(study, row) - answer_of(study, exact)) / size;
            squares += error * error;
            errors[model->error_points++] = error;
        }
    }
    if (model->error_points > 0) {
        const size_t count = model->error_points;
        qsort(errors, count, sizeof *errors, compare);
        model->error_median = 0.5 * (errors[(count - 1) / 2] + errors[count / 2]);
        model->error_worst = errors[count - 1];
        model->error_rms = sqrt(squares / (double)count);
    }
}

bool dea_bench_has_membrane(const dea_study *study)
{
    return study->timed || study->phasors || !study->along;
}

dea_status dea_bench_judge_models(dea_bench_work *work, dea_error *error)
{
    const dea_bench *bench = work->bench;
    const dea_bench_truth *field = dea_bench_membrane(work);
    if (!field->known) {
        return DEA_OK;
    }
    double *errors = malloc(bench->rows * sizeof *errors);
    if (!errors) {
        return dea_fail(error, DEA_ERROR_MEMORY, "out of memory for %zu errors", bench->rows);
    }
    for (size_t i = 0; i < bench->model_count && dea_bench_has_membrane(dea_study_of(bench->scene)); i++) {
        if (work->truths[i].known && bench->models[i].model != field->scene.models[0]) {
            judge_model(work, i, errors);
        }
    }
    free(errors);
    return DEA_OK;
}
