/* The runner: rows in order and complete, whatever an engine does. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include <errno.h>
#include <math.h>
#include <signal.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/mman.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <time.h>
#include <unistd.h>

#include "deaspice/model.h"
#include "engine/plan.h"

enum { POINTS = 500, BAD = 17 };

static const dea_model first_model = {.name = "first"};
static const dea_model second_model = {.name = "second"};

/* What the fake engines share with the test: counters that survive a fork, and the trouble they are to make. */
typedef struct fake {
    int begins;
    int sweeps;
    int bad_begins; /* so many of the first begin() fail */
    int signals;    /* so many times a worker gets a signal, at its begin or at the bad point */
    pid_t worker;   /* the last that began */
} fake;

static fake *shared;

typedef struct listener {
    size_t next;
    size_t failed;
    size_t wrong;
    size_t progress;
    size_t stop_after; /* rows, 0: never */
    size_t refuse_after;
    size_t lost;
    double calls; /* sum that tells in which calls of the engine the rows were made */
    size_t lines;
    char line[1024];
} listener;

static dea_scene scene_of(size_t points, size_t models)
{
    static dea_axis axis;
    axis = (dea_axis){.column = "voltage_V", .count = points, .values = calloc(points, sizeof(double))};
    for (size_t i = 0; i < points; i++)
        axis.values[i] = (double)i;
    dea_scene scene = {.axes = &axis, .axis_count = 1, .model_count = models, .models = {&first_model, &second_model}};
    return scene;
}

static double expected_strain(const dea_model *model, size_t point)
{
    return (double)point + (model == &second_model ? 0.5 : 0.0);
}

static dea_status begin_fine(void **session, dea_error *error)
{
    int number = __atomic_add_fetch(&shared->begins, 1, __ATOMIC_SEQ_CST);
    if (number <= shared->bad_begins)
        return dea_fail(error, DEA_ERROR_MISSING, "no licence today");
    *session = shared;
    return DEA_OK;
}

static void end_fine(void *session)
{
    (void)session;
}

static dea_status solve(void *session, const dea_scene *scene, const dea_model *model, size_t first, size_t count, dea_row *rows,
                        dea_error *error)
{
    if (session != shared || scene->model_count == 0)
        return dea_fail(error, DEA_ERROR_USAGE, "this is not my session");
    __atomic_add_fetch(&shared->sweeps, 1, __ATOMIC_SEQ_CST);
    for (size_t i = 0; i < count; i++)
        rows[i] = (dea_row){.strain = expected_strain(model, first + i), .displacement = 1, .force = 2, .field = 3};
    return DEA_OK;
}

static bool covers_bad_point(const dea_model *model, size_t first, size_t count)
{
    return model == &first_model && first <= BAD && BAD < first + count;
}

static dea_status sweep_crash(void *session, const dea_scene *scene, const dea_model *model, size_t first, size_t count,
                              dea_row *rows, dea_error *error)
{
    solve(session, scene, model, first, count, rows, error);
    if (covers_bad_point(model, first, count))
        raise(SIGSEGV);
    return DEA_OK;
}

static bool signal_is_due(void)
{
    return __atomic_fetch_sub(&shared->signals, 1, __ATOMIC_SEQ_CST) > 0;
}

/* Rows that tell from which call they are: an answer may depend on where its range begins. */
static dea_status sweep_struck(const dea_model *model, size_t first, size_t count, dea_row *rows, int number)
{
    for (size_t i = 0; i < count; i++)
        rows[i] = (dea_row){.strain = expected_strain(model, first + i), .displacement = (double)(first * count), .force = 2};
    if (number != 0 && covers_bad_point(model, first, count) && signal_is_due())
        raise(number);
    return DEA_OK;
}

static dea_status sweep_killed(void *session, const dea_scene *scene, const dea_model *model, size_t first, size_t count,
                               dea_row *rows, dea_error *error)
{
    (void)session, (void)scene, (void)error;
    return sweep_struck(model, first, count, rows, SIGKILL);
}

static dea_status sweep_stopped(void *session, const dea_scene *scene, const dea_model *model, size_t first, size_t count,
                                dea_row *rows, dea_error *error)
{
    (void)session, (void)scene, (void)error;
    return sweep_struck(model, first, count, rows, SIGSTOP);
}

static dea_status sweep_crashed(void *session, const dea_scene *scene, const dea_model *model, size_t first, size_t count,
                                dea_row *rows, dea_error *error)
{
    (void)session, (void)scene, (void)error;
    return sweep_struck(model, first, count, rows, SIGABRT);
}

static dea_status sweep_exhausted(void *session, const dea_scene *scene, const dea_model *model, size_t first, size_t count,
                                  dea_row *rows, dea_error *error)
{
    (void)session, (void)scene;
    const bool due = covers_bad_point(model, first, count) && signal_is_due();
    sweep_struck(model, first, count, rows, 0);
    return due ? dea_fail(error, DEA_ERROR_MEMORY, "out of memory") : DEA_OK;
}

static dea_status sweep_hang(void *session, const dea_scene *scene, const dea_model *model, size_t first, size_t count,
                             dea_row *rows, dea_error *error)
{
    if (covers_bad_point(model, first, count))
        pause();
    return solve(session, scene, model, first, count, rows, error);
}

static dea_status sweep_error(void *session, const dea_scene *scene, const dea_model *model, size_t first, size_t count,
                              dea_row *rows, dea_error *error)
{
    solve(session, scene, model, first, count, rows, error);
    return covers_bad_point(model, first, count) ? dea_fail(error, DEA_ERROR_ENGINE, "singular matrix") : DEA_OK;
}

static dea_status sweep_exit(void *session, const dea_scene *scene, const dea_model *model, size_t first, size_t count,
                             dea_row *rows, dea_error *error)
{
    printf("chatter of a foreign library\n");
    if (covers_bad_point(model, first, count))
        exit(3);
    return solve(session, scene, model, first, count, rows, error);
}

/* Early blocks take longest, so that later ones are ready before them. */
static dea_status sweep_backwards(void *session, const dea_scene *scene, const dea_model *model, size_t first, size_t count,
                                  dea_row *rows, dea_error *error)
{
    struct timespec nap = {.tv_nsec = first % 3 == 0 ? 20000000 : 100000};
    nanosleep(&nap, NULL);
    return solve(session, scene, model, first, count, rows, error);
}

static dea_status sweep_always_fails(void *session, const dea_scene *scene, const dea_model *model, size_t first, size_t count,
                                     dea_row *rows, dea_error *error)
{
    solve(session, scene, model, first, count, rows, error);
    return dea_fail(error, DEA_ERROR_ENGINE, "broken");
}

static dea_status sweep_for_ever(void *session, const dea_scene *scene, const dea_model *model, size_t first, size_t count,
                                 dea_row *rows, dea_error *error)
{
    for (;;)
        pause();
    return solve(session, scene, model, first, count, rows, error);
}

static dea_engine engine_of(dea_status (*sweep)(void *, const dea_scene *, const dea_model *, size_t, size_t, dea_row *,
                                                dea_error *),
                            bool isolated)
{
    return (dea_engine){.name = "fake",
                        .isolated = isolated,
                        .patience = 1e-4,
                        .block = 20,
                        .begin = begin_fine,
                        .sweep = sweep,
                        .end = end_fine};
}

static dea_status take_rows(void *user, size_t first, const void *points, size_t count, dea_error *error)
{
    const dea_row *rows = points;
    listener *heard = user;
    heard->wrong += first != heard->next;
    for (size_t i = 0; i < count; i++) {
        size_t row = first + i;
        double strain = row < POINTS ? (double)row : (double)(row - POINTS) + 0.5;
        if (rows[i].state == DEA_STATE_FAILED) {
            heard->failed++;
            heard->wrong +=
                !(isnan(rows[i].strain) && isnan(rows[i].displacement) && isnan(rows[i].force) && isnan(rows[i].field));
        } else {
            heard->wrong += !(fabs(rows[i].strain - strain) <= 0 && rows[i].state == DEA_STATE_OK);
        }
    }
    for (size_t i = 0; i < count; i++)
        heard->calls += (double)(first + i + 1) * rows[i].displacement;
    heard->next = first + count;
    if (heard->refuse_after > 0 && heard->next >= heard->refuse_after)
        return dea_fail(error, DEA_ERROR_IO, "disk full");
    return DEA_OK;
}

static void take_line(void *user, const char *line)
{
    listener *heard = user;
    heard->lines++;
    snprintf(heard->line, sizeof heard->line, "%s", line);
}

static void take_lost(void *user, size_t count)
{
    listener *heard = user;
    heard->lost += count;
}

static void take_progress(void *user, size_t done, size_t total)
{
    listener *heard = user;
    heard->wrong += done != heard->next || total < done;
    heard->progress = done;
}

static bool wants_stop(void *user)
{
    const listener *heard = user;
    return heard->stop_after > 0 && heard->next >= heard->stop_after;
}

static void check_no_child_left(void)
{
    errno = 0;
    assert_int_equal(waitpid(-1, NULL, WNOHANG), -1);
    assert_int_equal(errno, ECHILD);
}

static dea_status run(const dea_scene *scene, const dea_engine *engine, size_t jobs, listener *heard, dea_error *error)
{
    dea_run_options options = {
        .jobs = jobs, .points = take_rows, .lost = take_lost, .progress = take_progress, .log = take_line, .stop = wants_stop,
        .user = heard};
    dea_status status = dea_study_run(scene, engine, &options, error);
    free(scene->axes[0].values);
    check_no_child_left();
    return status;
}

/* The pool itself, with little time for a worker that hangs. */
static dea_status run_impatiently(const dea_scene *scene, const dea_engine *engine, size_t jobs, listener *heard,
                                  dea_error *error)
{
    dea_run_options options = {
        .jobs = jobs, .points = take_rows, .lost = take_lost, .log = take_line, .stop = wants_stop, .user = heard};
    dea_plan plan;
    assert_int_equal(dea_plan_make(scene, engine, &options, &plan, error), DEA_OK);
    dea_status status = dea_pool_run(&plan, 0.2, error);
    free(scene->axes[0].values);
    check_no_child_left();
    return status;
}

static void check_one_failed(const listener *heard, const char *why)
{
    assert_int_equal(heard->next, 2 * POINTS);
    assert_int_equal(heard->wrong, 0);
    assert_int_equal(heard->failed, 1);
    assert_int_equal(heard->lines, 1);
    assert_non_null(strstr(heard->line, "first, point 17 (voltage_V=17)"));
    assert_non_null(strstr(heard->line, why));
}

static const size_t all_jobs[] = {1, 2, 4};

static void rows_come_in_order_and_complete(void **state)
{
    (void)state;
    for (size_t i = 0; i < 6; i++) {
        dea_scene scene = scene_of(POINTS, 2);
        dea_engine engine = engine_of(sweep_backwards, i < 3);
        listener heard = {0};
        assert_int_equal(run(&scene, &engine, all_jobs[i % 3], &heard, NULL), DEA_OK);
        assert_int_equal(heard.next, 2 * POINTS);
        assert_int_equal(heard.progress, 2 * POINTS);
        assert_int_equal(heard.wrong, 0);
        assert_int_equal(heard.failed, 0);
    }
}

/* Who wants some of the blocks, in any order. */
typedef struct chooser {
    dea_cut cut;
    size_t seen[2 * POINTS]; /* how often each block came */
    size_t last;             /* block that came last */
    size_t steps_back;       /* blocks that came behind a later one */
    size_t points, progress, total;
} chooser;

static bool wants_every_second(void *user, size_t block)
{
    (void)user;
    return block % 2 == 1;
}

static dea_status take_block(void *user, size_t first, const void *points, size_t count, dea_error *error)
{
    chooser *chosen = user;
    const dea_row *rows = points;
    const size_t block = dea_cut_block(&chosen->cut, first);
    const dea_range range = dea_cut_range(&chosen->cut, block);
    (void)error;
    assert_true(range.place == first && range.count == count);
    assert_true(rows[count - 1].strain == (double)(range.first + count - 1) + 0.5 * (double)range.model);
    chosen->seen[block]++;
    chosen->steps_back += block < chosen->last;
    chosen->last = block;
    chosen->points += count;
    return DEA_OK;
}

static void tell_chooser(void *user, size_t done, size_t total)
{
    chooser *chosen = user;
    chosen->progress = done;
    chosen->total = total;
}

static void only_wanted_blocks_are_computed_each_as_soon_as_it_is_finished(void **state)
{
    (void)state;
    for (size_t i = 0; i < 6; i++) {
        static chooser chosen;
        dea_scene scene = scene_of(POINTS, 2);
        dea_engine engine = engine_of(sweep_backwards, i < 3);
        const dea_run_options options = {.jobs = all_jobs[i % 3],
                                         .points = take_block,
                                         .wanted = wants_every_second,
                                         .any_order = true,
                                         .progress = tell_chooser,
                                         .user = &chosen};
        chosen = (chooser){0};
        *shared = (fake){0};
        assert_int_equal(dea_cut_make(&scene, &engine, &chosen.cut, NULL), DEA_OK);
        assert_int_equal(dea_study_run(&scene, &engine, &options, NULL), DEA_OK);
        size_t wanted = 0;
        for (size_t block = 0; block < chosen.cut.blocks; block++) {
            assert_int_equal(chosen.seen[block], block % 2 == 1);
            wanted += block % 2 == 1;
        }
        assert_int_equal(shared->sweeps, wanted);
        assert_true(chosen.progress == chosen.points && chosen.total == chosen.points && wanted == chosen.cut.blocks / 2);
        assert_true(all_jobs[i % 3] == 1 ? chosen.steps_back == 0 : chosen.steps_back > 0);
        free(scene.axes[0].values);
        check_no_child_left();
    }
}

static void crash_costs_only_its_point(void **state)
{
    (void)state;
    for (size_t i = 0; i < 3; i++) {
        dea_scene scene = scene_of(POINTS, 2);
        dea_engine engine = engine_of(sweep_crash, true);
        listener heard = {0};
        assert_int_equal(run(&scene, &engine, all_jobs[i], &heard, NULL), DEA_OK);
        check_one_failed(&heard, "signal 11");
        assert_int_equal(heard.lost, 1);
    }
}

static void hang_costs_only_its_point(void **state)
{
    (void)state;
    for (size_t i = 0; i < 3; i++) {
        dea_scene scene = scene_of(POINTS, 2);
        dea_engine engine = engine_of(sweep_hang, true);
        listener heard = {0};
        assert_int_equal(run_impatiently(&scene, &engine, all_jobs[i], &heard, NULL), DEA_OK);
        check_one_failed(&heard, "no answer");
        assert_int_equal(heard.lost, 1);
    }
}

static void error_costs_only_its_point_and_is_told(void **state)
{
    (void)state;
    for (size_t i = 0; i < 6; i++) {
        dea_scene scene = scene_of(POINTS, 2);
        dea_engine engine = engine_of(sweep_error, i < 3);
        listener heard = {0};
        assert_int_equal(run(&scene, &engine, all_jobs[i % 3], &heard, NULL), DEA_OK);
        check_one_failed(&heard, "singular matrix");
        assert_int_equal(heard.lost, 0); /* the engine's last word */
    }
}

static void exit_of_a_library_costs_only_its_point(void **state)
{
    (void)state;
    for (size_t i = 0; i < 3; i++) {
        dea_scene scene = scene_of(POINTS, 2);
        dea_engine engine = engine_of(sweep_exit, true);
        listener heard = {0};
        assert_int_equal(run(&scene, &engine, all_jobs[i], &heard, NULL), DEA_OK);
        check_one_failed(&heard, "exit status 3");
    }
}

typedef dea_status sweep_function(void *, const dea_scene *, const dea_model *, size_t, size_t, dea_row *, dea_error *);

/* A run whose workers get so many signals. */
static listener run_struck(sweep_function *sweep, int signals, size_t jobs)
{
    dea_scene scene = scene_of(POINTS, 2);
    dea_engine engine = engine_of(sweep, true);
    listener heard = {0};
    *shared = (fake){.signals = signals};
    assert_int_equal(run(&scene, &engine, jobs, &heard, NULL), DEA_OK);
    assert_int_equal(heard.next, 2 * POINTS);
    assert_int_equal(heard.wrong, 0);
    return heard;
}

/* More losses than a block bears as a whole halve it; but no point is to blame. */
static void lost_workers_change_no_bit(void **state)
{
    (void)state;
    static sweep_function *const sweeps[] = {sweep_killed, sweep_crashed, sweep_exhausted};
    static const int signals[] = {1, 2, 3, 4, 5};
    const double calls = run_struck(sweep_killed, 0, 1).calls;
    for (size_t i = 0; i < 3 * 5; i++) {
        const listener heard = run_struck(sweeps[i % 3], signals[i / 3], all_jobs[i % 3]);
        assert_int_equal(heard.failed, 0);
        assert_int_equal(heard.lost, 0);
        assert_int_equal(heard.lines, 0);
        assert_true(heard.calls == calls);
    }
}

static void stopped_worker_is_replaced(void **state)
{
    (void)state;
    const double calls = run_struck(sweep_stopped, 0, 1).calls;
    for (size_t i = 0; i < 2; i++) {
        const listener heard = run_struck(sweep_stopped, 1, all_jobs[i]);
        assert_int_equal(heard.failed, 0);
        assert_true(heard.calls == calls);
    }
}

/* A point whose workers are always killed is lost; its neighbours are not. */
static void point_that_is_always_lost_is_told(void **state)
{
    (void)state;
    const listener heard = run_struck(sweep_killed, 1000000, 2);
    check_one_failed(&heard, "signal 9");
    assert_int_equal(heard.lost, 1);
}

static dea_status begin_killed(void **session, dea_error *error)
{
    if (signal_is_due())
        raise(SIGKILL);
    return begin_fine(session, error);
}

static void workers_killed_while_they_begin_have_successors(void **state)
{
    (void)state;
    for (size_t i = 0; i < 3; i++) {
        dea_scene scene = scene_of(POINTS, 1);
        dea_engine engine = engine_of(solve, true);
        listener heard = {0};
        engine.begin = begin_killed;
        *shared = (fake){.signals = 3};
        assert_int_equal(run(&scene, &engine, all_jobs[i], &heard, NULL), DEA_OK);
        assert_int_equal(heard.next, POINTS);
        assert_int_equal(heard.failed + heard.lines, 0);
    }
    dea_scene scene = scene_of(POINTS, 1);
    dea_engine engine = engine_of(solve, true);
    listener heard = {0};
    dea_error error = {0};
    engine.begin = begin_killed;
    *shared = (fake){.signals = 1000000};
    assert_int_equal(run(&scene, &engine, 2, &heard, &error), DEA_ERROR_ENGINE);
    assert_non_null(strstr(error.message, "could not begin: the worker was killed by signal 9"));
    *shared = (fake){0};
}

/* With few descriptors there are fewer workers, not an error. */
static void few_descriptors_mean_few_workers(void **state)
{
    (void)state;
    struct rlimit before, few;
    assert_int_equal(getrlimit(RLIMIT_NOFILE, &before), 0);
    few = before;
    few.rlim_cur = 12;
    assert_int_equal(setrlimit(RLIMIT_NOFILE, &few), 0);
    const listener heard = run_struck(sweep_killed, 1, 64);
    assert_int_equal(setrlimit(RLIMIT_NOFILE, &before), 0);
    assert_int_equal(heard.failed, 0);
    assert_int_equal(heard.lines, 1);
    assert_non_null(strstr(heard.line, "going on with "));
}

static void broken_engine_ends_in_bounded_time(void **state)
{
    (void)state;
    for (size_t i = 0; i < 4; i++) {
        dea_scene scene = scene_of(20000, 1);
        dea_engine engine = engine_of(sweep_always_fails, i % 2 == 0);
        listener heard = {0};
        *shared = (fake){0};
        assert_int_equal(run(&scene, &engine, i < 2 ? 1 : 4, &heard, NULL), DEA_OK);
        assert_int_equal(heard.failed, 20000);
        assert_true(shared->sweeps < 1500);
        assert_true(heard.lines >= 64 && heard.lines <= 201);
    }
}

static void hanging_engine_ends_in_bounded_time(void **state)
{
    (void)state;
    dea_scene scene = scene_of(20000, 1);
    dea_engine engine = engine_of(sweep_for_ever, true);
    listener heard = {0};
    dea_run_options options = {.jobs = 4, .points = take_rows, .user = &heard};
    dea_plan plan;
    *shared = (fake){0};
    assert_int_equal(dea_plan_make(&scene, &engine, &options, &plan, NULL), DEA_OK);
    assert_int_equal(dea_pool_run(&plan, 0.02, NULL), DEA_OK);
    free(scene.axes[0].values);
    check_no_child_left();
    assert_int_equal(heard.failed, 20000);
    assert_true(shared->begins <= 40);
}

static void failed_begin_is_told_with_its_status(void **state)
{
    (void)state;
    for (size_t i = 0; i < 4; i++) {
        dea_scene scene = scene_of(POINTS, 1);
        dea_engine engine = engine_of(solve, i % 2 == 0);
        listener heard = {0};
        dea_error error = {0};
        *shared = (fake){.bad_begins = 4};
        assert_int_equal(run(&scene, &engine, i < 2 ? 1 : 4, &heard, &error), DEA_ERROR_MISSING);
        assert_non_null(strstr(error.message, "no licence today"));
    }
    *shared = (fake){0};
}

static void one_worker_that_cannot_begin_is_done_without(void **state)
{
    (void)state;
    dea_scene scene = scene_of(POINTS, 1);
    dea_engine engine = engine_of(solve, true);
    listener heard = {0};
    *shared = (fake){.bad_begins = 1};
    assert_int_equal(run(&scene, &engine, 4, &heard, NULL), DEA_OK);
    assert_int_equal(heard.next, POINTS);
    assert_int_equal(heard.failed, 0);
    assert_int_equal(heard.lines, 1);
    assert_non_null(strstr(heard.line, "no licence today"));
    *shared = (fake){0};
}

static void failing_listener_ends_the_run_with_its_status(void **state)
{
    (void)state;
    for (size_t i = 0; i < 6; i++) {
        dea_scene scene = scene_of(POINTS, 1);
        dea_engine engine = engine_of(solve, i < 3);
        listener heard = {.refuse_after = 100};
        dea_error error = {0};
        assert_int_equal(run(&scene, &engine, all_jobs[i % 3], &heard, &error), DEA_ERROR_IO);
        assert_string_equal(error.message, "disk full");
        assert_true(heard.next < 200);
    }
}

static void stop_ends_the_run_soon(void **state)
{
    (void)state;
    for (size_t i = 0; i < 6; i++) {
        dea_scene scene = scene_of(POINTS, 1);
        dea_engine engine = engine_of(sweep_backwards, i < 3);
        listener heard = {.stop_after = 100};
        assert_int_equal(run(&scene, &engine, all_jobs[i % 3], &heard, NULL), DEA_ERROR_INTERRUPTED);
        assert_true(heard.next < 400);
        assert_int_equal(heard.wrong, 0);
    }
}

static dea_status move_for_long(void *session, const dea_scene *scene, const dea_model *model, dea_sample *samples, dea_summary *summary,
                                dea_error *error)
{
    (void)session, (void)scene, (void)model, (void)samples, (void)summary, (void)error;
    sleep(10);
    return DEA_OK;
}

static bool wants_stop_at_once(void *user)
{
    size_t *polls = user;
    return ++*polls > 1;
}

static dea_status take_nothing(void *user, size_t first, const void *points, size_t count, dea_error *error)
{
    (void)user, (void)first, (void)points, (void)count, (void)error;
    return DEA_OK;
}

/* One run of an engine that solves here: nobody could end it. */
static void stop_ends_a_long_run_of_a_worker(void **state)
{
    (void)state;
    dea_scene scene = {.study = DEA_STUDY_TRANSIENT, .transient = {.until = 1.0, .every = 0.5}, .model_count = 1, .models = {dea_model_find("lumped")}};
    dea_engine engine = engine_of(solve, false);
    engine.transient = move_for_long;
    size_t polls = 0;
    dea_run_options options = {.jobs = 1, .points = take_nothing, .stop = wants_stop_at_once, .apart = true, .user = &polls};
    assert_int_equal(dea_study_run(&scene, &engine, &options, NULL), DEA_ERROR_INTERRUPTED);
    check_no_child_left();
}

static const char *refuse_second(const dea_scene *scene, const dea_model *model)
{
    (void)scene;
    return model == &second_model ? "it is too hard" : NULL;
}

static void refused_model_runs_nothing(void **state)
{
    (void)state;
    dea_scene scene = scene_of(POINTS, 2);
    dea_engine engine = engine_of(solve, true);
    engine.refuses = refuse_second;
    listener heard = {0};
    dea_error error = {0};
    *shared = (fake){0};
    assert_int_equal(run(&scene, &engine, 2, &heard, &error), DEA_ERROR_UNSUPPORTED);
    assert_non_null(strstr(error.message, "it is too hard"));
    assert_int_equal(shared->begins, 0);
}

static void single_point_needs_one_worker(void **state)
{
    (void)state;
    dea_scene scene = scene_of(1, 1);
    dea_engine engine = engine_of(solve, true);
    listener heard = {0};
    *shared = (fake){0};
    assert_int_equal(run(&scene, &engine, 64, &heard, NULL), DEA_OK);
    assert_int_equal(heard.next, 1);
    assert_int_equal(shared->begins, 1);
}

static void memory_does_not_grow_with_the_study(void **state)
{
    (void)state;
    struct rusage before, after;
    static dea_axis axis = {.column = "voltage_V", .count = 2000000};
    dea_scene scene = {.axes = &axis, .axis_count = 1, .model_count = 1, .models = {&first_model}};
    dea_engine engine = engine_of(solve, true);
    engine.block = 256;
    dea_run_options options = {.jobs = 2, .points = take_rows, .user = &(listener){0}};
    getrusage(RUSAGE_SELF, &before);
    assert_int_equal(dea_study_run(&scene, &engine, &options, NULL), DEA_OK);
    getrusage(RUSAGE_SELF, &after);
    assert_true(after.ru_maxrss - before.ru_maxrss < 4096);
    check_no_child_left();
}

static void wait_until_gone(pid_t worker)
{
    for (int i = 0; i < 200 && kill(worker, 0) == 0; i++) {
        struct timespec nap = {.tv_nsec = 10000000};
        nanosleep(&nap, NULL);
    }
}

static dea_status begin_and_tell(void **session, dea_error *error)
{
    __atomic_store_n(&shared->worker, getpid(), __ATOMIC_SEQ_CST);
    return begin_fine(session, error);
}

static void worker_dies_with_a_killed_parent(void **state)
{
    (void)state;
    *shared = (fake){0};
    pid_t parent = fork();
    if (parent == 0) {
        dea_scene scene = scene_of(POINTS, 1);
        dea_engine engine = engine_of(sweep_for_ever, true);
        engine.begin = begin_and_tell;
        dea_run_options options = {.jobs = 1, .points = take_rows, .user = &(listener){0}};
        dea_study_run(&scene, &engine, &options, NULL);
        _exit(0);
    }
    pid_t worker = 0;
    for (int i = 0; i < 500 && worker == 0; i++) {
        struct timespec nap = {.tv_nsec = 10000000};
        nanosleep(&nap, NULL);
        worker = __atomic_load_n(&shared->worker, __ATOMIC_SEQ_CST);
    }
    assert_true(worker > 0 && kill(worker, 0) == 0);
    kill(parent, SIGKILL);
    waitpid(parent, NULL, 0);
    wait_until_gone(worker);
    assert_int_equal(kill(worker, 0), -1);
}

static void halving_finds_every_bad_point(void **state)
{
    (void)state;
    dea_run_options options = {0};
    dea_engine engine = engine_of(solve, false);
    dea_scene scene = scene_of(64, 1);
    dea_plan plan = {.scene = &scene, .engine = &engine, .options = &options, .layout = dea_layout_of(&scene)};
    for (size_t a = 0; a < 64; a++) {
        size_t b = (a * 37 + 5) % 64;
        dea_row rows[64] = {{0}};
        dea_damage damage = {0};
        dea_span span = {.model = &first_model, .count = 64};
        dea_attempt attempt = dea_attempt_start(64);
        size_t tries = 0;
        for (; !dea_attempt_over(&attempt); tries++) {
            assert_true(attempt.end > attempt.next && attempt.end <= 64);
            bool bad = (attempt.next <= a && a < attempt.end) || (attempt.next <= b && b < attempt.end);
            if (bad)
                dea_attempt_failed(&attempt, &plan, &span, rows, DEA_FAULT_REFUSED, "bad", &damage);
            else
                dea_attempt_solved(&attempt, &(dea_hands){{0}}, &damage);
        }
        assert_true(tries <= 2 * 8 + 1);
        for (size_t i = 0; i < 64; i++)
            assert_int_equal(rows[i].state == DEA_STATE_FAILED, i == a || i == b);
    }
    free(scene.axes[0].values);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(rows_come_in_order_and_complete),
        cmocka_unit_test(only_wanted_blocks_are_computed_each_as_soon_as_it_is_finished),
        cmocka_unit_test(crash_costs_only_its_point),
        cmocka_unit_test(hang_costs_only_its_point),
        cmocka_unit_test(error_costs_only_its_point_and_is_told),
        cmocka_unit_test(exit_of_a_library_costs_only_its_point),
        cmocka_unit_test(lost_workers_change_no_bit),
        cmocka_unit_test(stopped_worker_is_replaced),
        cmocka_unit_test(point_that_is_always_lost_is_told),
        cmocka_unit_test(workers_killed_while_they_begin_have_successors),
        cmocka_unit_test(few_descriptors_mean_few_workers),
        cmocka_unit_test(broken_engine_ends_in_bounded_time),
        cmocka_unit_test(hanging_engine_ends_in_bounded_time),
        cmocka_unit_test(failed_begin_is_told_with_its_status),
        cmocka_unit_test(one_worker_that_cannot_begin_is_done_without),
        cmocka_unit_test(failing_listener_ends_the_run_with_its_status),
        cmocka_unit_test(stop_ends_the_run_soon),
        cmocka_unit_test(stop_ends_a_long_run_of_a_worker),
        cmocka_unit_test(refused_model_runs_nothing),
        cmocka_unit_test(single_point_needs_one_worker),
        cmocka_unit_test(memory_does_not_grow_with_the_study),
        cmocka_unit_test(worker_dies_with_a_killed_parent),
        cmocka_unit_test(halving_finds_every_bad_point),
    };
    shared = mmap(NULL, sizeof *shared, PROT_READ | PROT_WRITE, MAP_SHARED | MAP_ANONYMOUS, -1, 0);
    return shared == MAP_FAILED ? 1 : cmocka_run_group_tests(tests, NULL, NULL);
}
