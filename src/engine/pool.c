#define _GNU_SOURCE
#include "engine/plan.h"

#include <errno.h>
#include <poll.h>
#include <stdlib.h>
#include <string.h>
#include <sys/mman.h>

#include "engine/worker.h"
#include "support/clock.h"

enum {
    SLOTS_PER_WORKER = 4,
    MOST_WORKERS = 1024,
    WAIT_MS = 50,
    MOST_MEMORY = 256 << 20,
    MOST_FALSE_STARTS = 8 /* workers lost one after the other before they could begin */
};

static const double longest_tick = 1; /* [s] the pool's clock stands still while this process is stopped */
static const double start_time = 30;  /* [s] an engine may take to begin a session */
static const double longest_stop = 2; /* [s] a worker may be stopped: who stops the whole run stops this clock too */

/* The n-th wanted block lives in slot n % slot_count from its first attempt until it and all before it are handed over. */
typedef struct dea_slot {
    dea_span span;
    dea_attempt attempt;
    char *points; /* shared memory */
    bool busy;    /* a worker has its current range */
    bool given;   /* its points are handed over */
} dea_slot;

typedef struct dea_pool {
    const dea_plan *plan;
    double beyond;
    dea_worker *workers;
    size_t worker_count; /* places for workers */
    size_t limit;        /* workers that may live at a time, <= worker_count */
    struct pollfd *polls;
    dea_slot *slots;
    size_t slot_count;
    size_t next;      /* number in the study from which on blocks have no slot yet */
    size_t opened;    /* blocks that have a slot or had one */
    size_t delivered; /* blocks whose slot is free again */
    size_t done;      /* points handed over */
    size_t false_starts; /* workers lost since the last one that could begin */
    dea_damage damage;
    double clock, last; /* [s] */
    double passed;      /* in the last tick of the clock [s] */
    void *memory;       /* shared: points of the slots, then errors of the workers */
    size_t memory_size;
} dea_pool;

static void pool_tick(dea_pool *pool)
{
    double now = dea_clock();
    double passed = now - pool->last;
    pool->passed = passed < longest_tick ? passed : longest_tick;
    pool->clock += pool->passed;
    pool->last = now;
}

static size_t smaller(size_t a, size_t b)
{
    return a < b ? a : b;
}

static size_t larger(size_t a, size_t b)
{
    return a > b ? a : b;
}

static dea_status pool_share_memory(dea_pool *pool, dea_error *error)
{
    size_t block = pool->plan->cut.block * pool->plan->layout.point_size;
    size_t points = pool->slot_count * block;
    pool->memory_size = points + pool->worker_count * sizeof(dea_error);
    pool->memory = mmap(NULL, pool->memory_size, PROT_READ | PROT_WRITE, MAP_SHARED | MAP_ANONYMOUS, -1, 0);
    if (pool->memory == MAP_FAILED)
        return dea_fail(error, DEA_ERROR_MEMORY, "no %zu bytes of shared memory for the workers: %s", pool->memory_size,
                        strerror(errno));
    dea_error *errors = (dea_error *)(void *)((char *)pool->memory + points);
    for (size_t i = 0; i < pool->worker_count; i++)
        pool->workers[i].error = errors + i;
    for (size_t i = 0; i < pool->slot_count; i++)
        pool->slots[i].points = (char *)pool->memory + i * block;
    return DEA_OK;
}

static dea_status pool_init(dea_pool *pool, const dea_plan *plan, double beyond, dea_error *error)
{
    size_t workers = smaller(smaller(plan->options->jobs, plan->blocks), MOST_WORKERS);
    *pool = (dea_pool){.plan = plan, .beyond = beyond, .worker_count = workers, .limit = workers, .memory = MAP_FAILED};
    const size_t affordable = MOST_MEMORY / (plan->cut.block * plan->layout.point_size);
    pool->slot_count = smaller(plan->blocks, larger(workers, smaller(workers * SLOTS_PER_WORKER, affordable)));
    pool->workers = calloc(workers, sizeof *pool->workers);
    pool->polls = calloc(workers, sizeof *pool->polls);
    pool->slots = calloc(pool->slot_count, sizeof *pool->slots);
    if (!pool->workers || !pool->polls || !pool->slots)
        return dea_fail(error, DEA_ERROR_MEMORY, "out of memory for %zu workers", workers);
    pool->last = dea_clock();
    return pool_share_memory(pool, error);
}

static void pool_finish(dea_pool *pool)
{
    for (size_t i = 0; pool->workers && i < pool->worker_count; i++)
        dea_worker_end(&pool->workers[i]);
    if (pool->memory != MAP_FAILED)
        munmap(pool->memory, pool->memory_size);
    free(pool->slots);
    free(pool->polls);
    free(pool->workers);
}

static dea_slot *slot_of(dea_pool *pool, size_t block)
{
    return &pool->slots[block % pool->slot_count];
}

/* Gives slots to blocks in order as they come free. */
static void pool_open_blocks(dea_pool *pool)
{
    while (pool->opened < pool->plan->blocks && pool->opened - pool->delivered < pool->slot_count) {
        dea_slot *slot = slot_of(pool, pool->opened);
        slot->span = dea_plan_next(pool->plan, &pool->next);
        slot->attempt = dea_attempt_start(slot->span.count);
        slot->busy = false;
        slot->given = false;
        pool->opened++;
    }
}

/* The earliest block that waits for a worker; NULL when there is none. */
static dea_slot *pool_waiting(dea_pool *pool)
{
    for (size_t block = pool->delivered; block < pool->opened; block++) {
        dea_slot *slot = slot_of(pool, block);
        if (!slot->busy && !dea_attempt_over(&slot->attempt))
            return slot;
    }
    return NULL;
}

static void slot_failed(dea_pool *pool, dea_slot *slot, dea_fault fault, const char *why)
{
    slot->busy = false;
    dea_attempt_failed(&slot->attempt, pool->plan, &slot->span, slot->points, fault, why, &pool->damage);
}

/* Fails what is left once the engine is past hope. */
static void pool_abandon(dea_pool *pool)
{
    for (size_t block = pool->delivered; block < pool->opened; block++) {
        dea_slot *slot = slot_of(pool, block);
        if (!slot->busy)
            dea_attempt_abandon(&slot->attempt, pool->plan, slot->points);
    }
}

static size_t pool_unsettled(dea_pool *pool)
{
    size_t count = 0;
    for (size_t block = pool->delivered; block < pool->opened; block++)
        count += dea_attempt_over(&slot_of(pool, block)->attempt) ? 0 : 1;
    return count;
}

static size_t pool_alive(const dea_pool *pool)
{
    size_t count = 0;
    for (size_t i = 0; i < pool->worker_count; i++)
        count += pool->workers[i].state != DEA_WORKER_NONE ? 1 : 0;
    return count;
}

/* Fewer workers will do as long as there is one. */
static dea_status pool_shrink(dea_pool *pool, dea_status status, const dea_error *reason, dea_error *error)
{
    pool->limit = pool_alive(pool);
    if (pool->limit == 0)
        return dea_fail(error, status, "%s", reason->message);
    dea_plan_log(pool->plan, &pool->damage, "going on with %zu workers: %s", pool->limit, reason->message);
    return DEA_OK;
}

/* Starts workers until there is one for every block that is open. */
static dea_status pool_staff(dea_pool *pool, dea_error *error)
{
    size_t wanted = smaller(pool_unsettled(pool), pool->limit);
    size_t alive = pool_alive(pool);
    for (size_t i = 0; i < pool->worker_count && alive < wanted; i++) {
        dea_worker *worker = &pool->workers[i];
        if (worker->state != DEA_WORKER_NONE)
            continue;
        dea_error reason = {0};
        dea_status status = dea_worker_start(worker, pool->plan, pool->workers, pool->worker_count, &reason);
        if (status != DEA_OK)
            return pool_shrink(pool, status, &reason, error);
        worker->deadline = pool->clock + start_time;
        worker->used = worker->waited = 0.0;
        worker->moved = pool->clock;
        alive++;
    }
    return DEA_OK;
}

static void pool_dispatch(dea_pool *pool)
{
    for (size_t i = 0; i < pool->worker_count; i++) {
        dea_worker *worker = &pool->workers[i];
        if (worker->state != DEA_WORKER_IDLE)
            continue;
        dea_slot *slot = pool_waiting(pool);
        if (!slot)
            return;
        const dea_attempt *attempt = &slot->attempt;
        dea_order order = {.model = slot->span.model,
                           .first = slot->span.first + attempt->next,
                           .count = attempt->end - attempt->next,
                           .skip = attempt->skip,
                           .points = slot->points + attempt->next * pool->plan->layout.point_size};
        if (!dea_worker_send(worker, &order)) {
            pool->damage.losses++;
            dea_worker_end(worker);
            continue;
        }
        slot->busy = true;
        worker->slot = (size_t)(slot - pool->slots);
        worker->state = DEA_WORKER_BUSY;
        worker->waited = 0.0;
        worker->moved = pool->clock;
        worker->deadline = pool->clock + pool->beyond + dea_plan_patience(pool->plan, order.model, order.count);
    }
}

/* A worker is to go: its range failed, or it could not even begin. One that is lost before it begins has a successor, one whose
 * engine refuses to begin has none. */
static dea_status worker_failed(dea_pool *pool, dea_worker *worker, dea_fault fault, dea_status status, const char *why,
                                dea_error *error)
{
    dea_worker_state before = worker->state;
    dea_worker_end(worker);
    if (before == DEA_WORKER_IDLE)
        pool->damage.losses++;
    if (before == DEA_WORKER_BUSY)
        slot_failed(pool, &pool->slots[worker->slot], fault, why);
    if (before != DEA_WORKER_STARTS || (fault != DEA_FAULT_REFUSED && ++pool->false_starts < MOST_FALSE_STARTS))
        return DEA_OK;
    dea_error reason = {0};
    char names[DEA_ERROR_LENGTH / 8];
    dea_crew_names(pool->plan->scene, pool->plan->engine, names, sizeof names);
    dea_fail(&reason, status, "engine %s could not begin: %s", names, why);
    return pool_shrink(pool, status, &reason, error);
}

/* A worker that has gone by itself. */
static dea_status worker_gone(dea_pool *pool, dea_worker *worker, dea_error *error)
{
    char how[128];
    const dea_fault fault = dea_worker_reap(worker, how, sizeof how);
    return worker_failed(pool, worker, fault, DEA_ERROR_ENGINE, how, error);
}

static dea_status worker_reported(dea_pool *pool, dea_worker *worker, dea_error *error)
{
    dea_report report;
    if (!dea_worker_receive(worker, &report))
        return worker_gone(pool, worker, error);
    char why[DEA_ERROR_LENGTH]; /* a copy: the worker's memory may change at any time */
    size_t length = strnlen(worker->error->message, sizeof why - 1);
    memcpy(why, worker->error->message, length);
    why[length] = '\0';
    const dea_status status = report.status;
    if (status != DEA_OK)
        return worker_failed(pool, worker, dea_fault_of(status), status, length > 0 ? why : dea_status_text(status), error);
    pool->false_starts = 0;
    if (worker->state == DEA_WORKER_BUSY) {
        dea_slot *slot = &pool->slots[worker->slot];
        slot->busy = false;
        dea_attempt_remark(&slot->attempt, pool->plan, &slot->span, why, &pool->damage);
        dea_attempt_solved(&slot->attempt, &report.hands, &pool->damage);
    }
    worker->state = DEA_WORKER_IDLE;
    return DEA_OK;
}

/* Patience is for the work of a worker: while others have the processor its deadline waits, so that a loaded machine makes no run
 * fail. One that takes no processor time at all any more has its deadline as it is. */
static void worker_waits(const dea_pool *pool, dea_worker *worker)
{
    const double used = dea_worker_used(worker);
    const double own = used - worker->used;
    worker->waited += pool->passed;
    if (own > 0.0) {
        worker->deadline += worker->waited > own ? worker->waited - own : 0.0;
        worker->used = used;
        worker->waited = 0.0;
    }
}

static dea_status worker_overdue(dea_pool *pool, dea_worker *worker, dea_error *error)
{
    if (worker->state == DEA_WORKER_IDLE)
        return DEA_OK;
    if (!dea_worker_stopped(worker))
        worker->moved = pool->clock;
    const bool stopped = pool->clock - worker->moved > longest_stop;
    if (!stopped && pool->clock < worker->deadline)
        return DEA_OK;
    pool->damage.losses++;
    return stopped ? worker_failed(pool, worker, DEA_FAULT_KILLED, DEA_ERROR_ENGINE, "the worker was stopped by a signal", error)
                   : worker_failed(pool, worker, DEA_FAULT_OVERDUE, DEA_ERROR_ENGINE,
                                   "no answer for too long, the worker was killed", error);
}

/* Waits a moment for workers that have something to tell and takes it. */
static dea_status pool_listen(dea_pool *pool, dea_error *error)
{
    nfds_t living = 0; /* no place for others: there may be more than descriptors */
    for (size_t i = 0; i < pool->worker_count; i++) {
        if (pool->workers[i].state != DEA_WORKER_NONE)
            pool->polls[living++] = (struct pollfd){.fd = pool->workers[i].socket, .events = POLLIN};
    }
    int ready = poll(pool->polls, living, WAIT_MS);
    if (ready < 0 && errno != EINTR)
        return dea_fail(error, DEA_ERROR_ENGINE, "cannot wait for the workers: %s", strerror(errno));
    pool_tick(pool);
    dea_status status = DEA_OK;
    const struct pollfd *next = pool->polls;
    for (size_t i = 0; i < pool->worker_count && status == DEA_OK; i++) {
        if (pool->workers[i].state == DEA_WORKER_NONE)
            continue;
        worker_waits(pool, &pool->workers[i]);
        if (ready > 0 && next->revents != 0)
            status = worker_reported(pool, &pool->workers[i], error);
        else
            status = worker_overdue(pool, &pool->workers[i], error);
        next++;
    }
    return status;
}

/* Hands over the blocks that are settled: in order, or all of them. */
static dea_status pool_deliver(dea_pool *pool, dea_error *error)
{
    const bool in_order = !pool->plan->options->any_order;
    for (size_t block = pool->delivered; block < pool->opened; block++) {
        dea_slot *slot = slot_of(pool, block);
        const bool settled = !slot->busy && dea_attempt_over(&slot->attempt);
        if (!settled && in_order)
            break;
        if (!settled || slot->given)
            continue;
        const dea_status status = dea_plan_deliver(pool->plan, &slot->span, slot->points, &slot->attempt, &pool->done, error);
        if (status != DEA_OK)
            return status;
        slot->given = true;
    }
    while (pool->delivered < pool->opened && slot_of(pool, pool->delivered)->given)
        pool->delivered++;
    return DEA_OK;
}

/* Workers get their next blocks before the caller gets the results, so that they solve while it writes. */
static dea_status pool_round(dea_pool *pool, dea_error *error)
{
    pool_open_blocks(pool);
    if (dea_damage_hopeless(&pool->damage))
        pool_abandon(pool);
    dea_status status = pool_staff(pool, error);
    pool_dispatch(pool);
    if (status == DEA_OK)
        status = pool_deliver(pool, error);
    if (status == DEA_OK && pool_unsettled(pool) > 0)
        status = pool_listen(pool, error);
    return status;
}

dea_status dea_pool_run(const dea_plan *plan, double beyond, dea_error *error)
{
    dea_pool pool;
    dea_status status = pool_init(&pool, plan, beyond, error);
    while (status == DEA_OK && pool.delivered < plan->blocks) {
        if (dea_plan_stopped(plan))
            status = dea_fail(error, DEA_ERROR_INTERRUPTED, "interrupted");
        else
            status = pool_round(&pool, error);
    }
    pool_finish(&pool);
    return status;
}
