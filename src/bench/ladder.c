/* Which settings are measured: for each engine the accuracies 1e-2, 1e-3, ... down to the best that it takes. */
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "bench/work.h"

/* Part of the budget that the first runs may take, the rest repeats them; and what each ladder may take in any case. */
static const double first_share = 0.6, least_share = 0.01;
/* What a step of the ladder costs over the one before it, as long as only one is known, and bounds of what is seen. */
static const double growth_guess = 2.0, growth_least = 1.0, growth_most = 10.0;

double dea_bench_accuracy(size_t rung)
{
    static const double powers[] = {1e-2, 1e-3, 1e-4, 1e-5, 1e-6, 1e-7, 1e-8, 1e-9, 1e-10, 1e-11, 1e-12, 1e-13, 1e-14, 1e-15};
    return powers[rung < sizeof powers / sizeof *powers ? rung : sizeof powers / sizeof *powers - 1];
}

size_t dea_bench_rungs(const dea_engine *engine, const dea_scene *scene, const char **why)
{
    dea_scene here = *scene;
    for (size_t rung = 0; rung + 1 < DEA_BENCH_RUNGS; rung++) {
        here.accuracy = dea_bench_accuracy(rung);
        const char *reason = dea_engine_refuses(engine, &here, here.models[0]);
        if (reason) {
            *why = reason;
            return rung;
        }
    }
    return DEA_BENCH_RUNGS - 1;
}

void dea_bench_take(dea_bench *bench, dea_bench_times *times, const dea_bench_setting *setting, const dea_bench_times *time)
{
    dea_bench_setting *last = bench->setting_count > 0 ? &bench->settings[bench->setting_count - 1] : NULL;
    const bool again = last && last->state == DEA_BENCH_MEASURED && setting->state == DEA_BENCH_MEASURED &&
                       last->engine == setting->engine && last->model == setting->model &&
                       times[bench->setting_count - 1].digest == time->digest;
    if (!again) {
        bench->settings[bench->setting_count] = *setting;
        times[bench->setting_count] = *time;
        bench->setting_count++;
        return;
    }
    const double loosest = last->loosest;
    *last = *setting;
    last->loosest = loosest;
    times[bench->setting_count - 1] = *time;
}

/* One engine's ladder on one model. */
typedef struct ladder {
    dea_bench_work *work;
    const dea_engine *engine;
    size_t model, rungs;
    double allowance;    /* time that its first runs may take in all [s] */
    double last, before; /* times of the latest steps, NAN [s] */
    double start;        /* of the engine [s] */
} ladder;

static dea_bench_setting setting_of(const ladder *l, double loosest, double accuracy, dea_bench_state state)
{
    return (dea_bench_setting){.model = l->model,
                               .engine = l->engine,
                               .loosest = loosest,
                               .accuracy = accuracy,
                               .state = state,
                               .start = l->start,
                               .error = (double)NAN};
}

static void take_unmeasured(const ladder *l, dea_bench_setting setting, const char *reason)
{
    const dea_bench_times none = {0};
    const size_t line = strcspn(reason, "\n");
    snprintf(setting.reason, sizeof setting.reason, "%.*s", line < DEA_BENCH_REASON ? (int)line : DEA_BENCH_REASON - 1, reason);
    dea_bench_take(l->work->bench, l->work->times, &setting, &none);
}

static double predict(const ladder *l)
{
    const double growth = isnan(l->before) ? growth_guess : fmin(fmax(l->last / l->before, growth_least), growth_most);
    return isnan(l->last) ? 0.0 : l->last * growth;
}

/* First run of a setting, and its error. */
static dea_status climb(ladder *l, double accuracy, dea_error *error)
{
    dea_bench_work *work = l->work;
    dea_bench_setting setting = setting_of(l, accuracy, accuracy, DEA_BENCH_MEASURED);
    dea_bench_times times = {0};
    const dea_status status =
        dea_bench_solve(work, l->engine, &work->truths[l->model].scene, accuracy, false, work->buffer, &times.first, error);
    if (status == DEA_ERROR_INTERRUPTED || status == DEA_ERROR_MEMORY) {
        return status;
    }
    l->before = l->last;
    l->last = times.first;
    l->allowance -= times.first;
    if (status != DEA_OK) {
        setting.state = DEA_BENCH_FAILED;
        take_unmeasured(l, setting, error->message[0] ? error->message : dea_status_text(status));
        *error = (dea_error){0};
        return DEA_OK;
    }
    times.digest = dea_bench_digest(&work->layout, work->buffer, work->points);
    dea_bench_judge(work, &setting, times.digest);
    dea_bench_take(work->bench, work->times, &setting, &times);
    return DEA_OK;
}

/* Is the rung out of reach? Then says why. */
static bool is_skipped(const ladder *l, size_t rung, char reason[DEA_BENCH_REASON])
{
    const dea_bench_model *model = &l->work->bench->models[l->model];
    const double expected = predict(l);
    if (l->engine == model->reference && dea_bench_accuracy(rung) < model->reference_accuracy) {
        snprintf(reason, DEA_BENCH_REASON, "the budget affords no tighter reference than %.0e", model->reference_accuracy);
        return true;
    }
    snprintf(reason, DEA_BENCH_REASON, "expected to take %.2g s, %.2g s of the budget are left for it", expected,
             fmax(0.0, l->allowance));
    return expected > l->allowance;
}

static dea_status walk_ladder(ladder *l, dea_error *error)
{
    const size_t before = l->work->bench->setting_count;
    for (size_t rung = 0; rung < l->rungs; rung++) {
        char reason[DEA_BENCH_REASON];
        if (is_skipped(l, rung, reason)) {
            const double tightest = dea_bench_accuracy(l->rungs - 1);
            take_unmeasured(l, setting_of(l, dea_bench_accuracy(rung), tightest, DEA_BENCH_SKIPPED), reason);
            return DEA_OK;
        }
        const dea_status status = climb(l, dea_bench_accuracy(rung), error);
        if (status != DEA_OK) {
            return status;
        }
    }
    dea_bench_setting *only = &l->work->bench->settings[before];
    only->any = l->rungs > 1 && l->work->bench->setting_count == before + 1 && only->state == DEA_BENCH_MEASURED;
    return DEA_OK;
}

static bool takes_part(const dea_bench_work *work, const dea_engine *engine)
{
    return !work->options->engine || work->options->engine == engine;
}

/* Ladders of all models from number @p model on. */
static size_t ladders_left(const dea_bench_work *work, size_t model)
{
    size_t engines = 0;
    for (size_t i = 0; i < dea_engine_count(); i++) {
        engines += takes_part(work, dea_engine_at(i));
    }
    return engines * (work->bench->model_count - model);
}

dea_status dea_bench_walk(dea_bench_work *work, size_t model, dea_error *error)
{
    const double none = (double)NAN;
    const dea_scene *scene = &work->truths[model].scene;
    size_t left = ladders_left(work, model);
    for (size_t i = 0; i < dea_engine_count(); i++) {
        const dea_engine *engine = dea_engine_at(i);
        if (!takes_part(work, engine)) {
            continue;
        }
        const char *why = "";
        const double share = dea_bench_left(work) - (1.0 - first_share) * work->options->budget;
        ladder l = {.work = work,
                    .engine = engine,
                    .model = model,
                    .rungs = dea_bench_rungs(engine, scene, &why),
                    .allowance = fmax(least_share * work->options->budget, share / (double)left--),
                    .last = none,
                    .before = none,
                    .start = none};
        dea_status status = DEA_OK;
        if (l.rungs == 0) {
            take_unmeasured(&l, setting_of(&l, none, none, DEA_BENCH_REFUSED), why);
        } else {
            l.start = dea_bench_start(work, engine);
            status = walk_ladder(&l, error);
        }
        if (status != DEA_OK) {
            return status;
        }
        dea_bench_step(work);
    }
    return DEA_OK;
}
