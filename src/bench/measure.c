/* Times of settings: through dea_study_run() as a user gets them, on a steady clock. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "bench/work.h"
#include "engine/worker.h"
#include "support/clock.h"

enum { MOST_RUNS = 1000, MOST_ROUNDS = 25, STARTS = 5 };

/* Who listens to one run. */
typedef struct audience {
    const dea_bench_work *work;
    char *points; /* NULL: nobody keeps them */
} audience;

double dea_bench_left(const dea_bench_work *work)
{
    return fmax(0.0, work->options->budget - (dea_clock() - work->begun));
}

void dea_bench_step(dea_bench_work *work)
{
    work->step += work->step < work->steps;
    if (work->options->progress) {
        work->options->progress(work->options->user, work->step, work->steps);
    }
}

static dea_status take_points(void *user, size_t first, const void *points, size_t count, dea_error *error)
{
    const audience *listener = user;
    (void)error;
    if (listener->points) {
        const size_t size = listener->work->layout.point_size;
        memcpy(listener->points + first * size, points, count * size);
    }
    return DEA_OK;
}

static void take_log(void *user, const char *line)
{
    const dea_bench_options *options = ((const audience *)user)->work->options;
    options->log(options->user, line);
}

static bool poll_stop(void *user)
{
    const dea_bench_options *options = ((const audience *)user)->work->options;
    return options->stop(options->user);
}

dea_status dea_bench_solve(const dea_bench_work *work, const dea_engine *engine, const dea_scene *scene, double accuracy,
                           bool full, char *points, double *seconds, dea_error *error)
{
    dea_scene here = *scene;
    audience listener = {work, points};
    const dea_run_options options = {.jobs = work->options->jobs,
                                     .points = take_points,
                                     .log = points && work->options->log ? take_log : NULL,
                                     .stop = work->options->stop ? poll_stop : NULL,
                                     .user = &listener};
    here.accuracy = accuracy;
    here.full = scene->full || full;
    const double from = dea_clock();
    const dea_status status = dea_study_run(&here, engine, &options, error);
    *seconds = dea_clock() - from;
    return status;
}

/* ---- repetition */

static int compare(const void *left, const void *right)
{
    const double a = *(const double *)left, b = *(const double *)right;
    return (a > b) - (a < b);
}

/* Value at a share of sorted numbers, between neighbours in proportion. */
static double quantile(const double *sorted, size_t count, double share)
{
    const double place = share * (double)(count - 1);
    const size_t low = (size_t)place;
    const size_t high = low + 1 < count ? low + 1 : low;
    return sorted[low] + (place - (double)low) * (sorted[high] - sorted[low]);
}

void dea_bench_summarise(dea_bench_setting *setting, double *seconds, size_t count)
{
    qsort(seconds, count, sizeof *seconds, compare);
    setting->runs = count;
    setting->fastest = seconds[0];
    setting->lower = quantile(seconds, count, 0.25);
    setting->seconds = quantile(seconds, count, 0.5);
    setting->upper = quantile(seconds, count, 0.75);
    setting->slowest = seconds[count - 1];
}

/* Runs that a setting would have without a budget. */
static size_t runs_wished(const dea_bench_work *work, double seconds)
{
    const double many = ceil(work->options->enough / fmax(seconds, 1e-9));
    const size_t least = work->options->runs;
    return many < (double)least ? least : many < MOST_RUNS ? (size_t)many : least < MOST_RUNS ? MOST_RUNS : least;
}

static bool is_measured(const dea_bench_work *work, size_t i)
{
    return work->bench->settings[i].state == DEA_BENCH_MEASURED;
}

/* Shares the time that is left: who needs less than an equal share gets it all, the rest share what that leaves. */
static void share_runs(dea_bench_work *work)
{
    double left = dea_bench_left(work);
    size_t open = 0;
    for (size_t i = 0; i < work->bench->setting_count; i++) {
        work->times[i].wanted = 0;
        open += is_measured(work, i);
    }
    for (bool settled = true; settled && open > 0;) {
        const double share = left / (double)open;
        settled = false;
        for (size_t i = 0; i < work->bench->setting_count; i++) {
            dea_bench_times *times = &work->times[i];
            const size_t wish = is_measured(work, i) && times->wanted == 0 ? runs_wished(work, times->first) : 0;
            if (wish > 0 && (double)wish * times->first <= share) {
                times->wanted = wish;
                left -= (double)wish * times->first;
                open--;
                settled = true;
            }
        }
    }
    for (size_t i = 0; i < work->bench->setting_count && open > 0; i++) {
        dea_bench_times *times = &work->times[i];
        if (is_measured(work, i) && times->wanted == 0) {
            times->wanted = (size_t)(left / (double)open / times->first); /* 0: its first run must do */
        }
    }
}

/* The part of a setting's runs that belongs to round @p round. */
static dea_status run_round(dea_bench_work *work, size_t number, size_t round, dea_error *error)
{
    dea_bench_setting *setting = &work->bench->settings[number];
    dea_bench_times *times = &work->times[number];
    const dea_scene *scene = &work->truths[setting->model].scene;
    const size_t until = (round + 1) * times->wanted / MOST_ROUNDS;
    dea_status status = DEA_OK;
    while (times->count < until && status == DEA_OK && dea_bench_left(work) > 0.0) {
        status =
            dea_bench_solve(work, setting->engine, scene, setting->accuracy, false, NULL, &times->seconds[times->count], error);
        times->count += status == DEA_OK;
    }
    return status;
}

dea_status dea_bench_repeat(dea_bench_work *work, dea_error *error)
{
    dea_bench *bench = work->bench;
    dea_status status = DEA_OK;
    share_runs(work);
    for (size_t i = 0; i < bench->setting_count; i++) {
        dea_bench_times *times = &work->times[i];
        times->seconds = malloc((times->wanted + 1) * sizeof *times->seconds);
        if (!times->seconds) {
            return dea_fail(error, DEA_ERROR_MEMORY, "out of memory for times");
        }
    }
    for (size_t round = 0; round < MOST_ROUNDS && status == DEA_OK; round++) {
        for (size_t i = 0; i < bench->setting_count && status == DEA_OK; i++) {
            status = run_round(work, i, round, error);
        }
        dea_bench_step(work);
    }
    for (size_t i = 0; i < bench->setting_count && status == DEA_OK; i++) {
        dea_bench_times *times = &work->times[i];
        if (is_measured(work, i)) {
            times->seconds[times->count] = times->first;
            dea_bench_summarise(&bench->settings[i], times->seconds, times->count > 0 ? times->count : 1);
        }
    }
    return status;
}

/* ---- start of an engine */

static double start_once(const dea_plan *plan)
{
    dea_error error = {0};
    dea_worker worker = {.error = &error};
    dea_status status = DEA_OK;
    const double from = dea_clock();
    double until;
    if (dea_plan_here(plan)) {
        void *session = NULL;
        status = plan->engine->begin(&session, &error);
        until = dea_clock();
        plan->engine->end(session);
    } else {
        dea_report report = {.status = DEA_ERROR_ENGINE};
        status = dea_worker_start(&worker, plan, NULL, 0, &error);
        status = status == DEA_OK && !dea_worker_receive(&worker, &report) ? DEA_ERROR_ENGINE : status;
        status = status == DEA_OK ? report.status : status;
        until = dea_clock();
        dea_worker_end(&worker);
    }
    return status == DEA_OK ? until - from : (double)NAN;
}

double dea_bench_start(const dea_bench_work *work, const dea_engine *engine)
{
    double seconds[STARTS];
    dea_plan plan;
    const dea_run_options options = {.jobs = work->options->jobs, .points = take_points};
    if (dea_plan_make(&work->truths[0].scene, engine, &options, &plan, NULL) != DEA_OK) {
        return (double)NAN;
    }
    for (size_t i = 0; i < STARTS; i++) {
        seconds[i] = start_once(&plan);
        if (isnan(seconds[i])) {
            return (double)NAN;
        }
    }
    qsort(seconds, STARTS, sizeof *seconds, compare);
    return seconds[STARTS / 2];
}
