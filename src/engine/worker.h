/** @file worker.h
 * One worker process: forked, told what to solve over a socket, answers over it; rows and messages go through shared memory.
 */
#ifndef DEA_ENGINE_WORKER_H
#define DEA_ENGINE_WORKER_H

#include <sys/types.h>

#include "engine/plan.h"

/** Where a worker is. */
typedef enum dea_worker_state { DEA_WORKER_NONE, DEA_WORKER_STARTS, DEA_WORKER_IDLE, DEA_WORKER_BUSY } dea_worker_state;

/** A worker as its parent sees it. */
typedef struct dea_worker {
    dea_worker_state state;
    pid_t pid;        /**< 0: reaped */
    int socket;       /**< the parent's end */
    dea_error *error; /**< shared memory: what a failure was about */
    size_t slot;      /**< while busy: where its rows go */
    double deadline;  /**< on the pool's clock [s] */
    double used;      /**< processor time that it was last seen to have taken [s] */
    double waited;    /**< on the pool's clock, since then [s] */
    double moved;     /**< when it was last seen not to be stopped, on the pool's clock [s] */
} dea_worker;

/** What a worker is to solve. */
typedef struct dea_order {
    const dea_model *model; /**< same address in parent and worker */
    size_t first;           /**< point */
    size_t count;           /**< points */
    size_t skip;            /**< engines of the model's crew that are not asked */
    void *points;           /**< shared memory for their results */
} dea_order;

/** What a worker says when it has begun, and after each order. */
typedef struct dea_report {
    dea_status status;
    dea_hands hands; /**< who has solved what of the order */
} dea_report;

/** Forks a worker that begins a session of the engine and reports. @p others are closed in it. */
dea_status dea_worker_start(dea_worker *worker, const dea_plan *plan, const dea_worker *others, size_t count, dea_error *error);
/** Sends an order; false when the worker is gone. */
bool dea_worker_send(const dea_worker *worker, const dea_order *order);
/** Takes the worker's report; false when it is gone. */
bool dea_worker_receive(const dea_worker *worker, dea_report *report);
/** Processor time that the worker has taken since it was started, 0 where the system does not tell [s]. */
double dea_worker_used(const dea_worker *worker);
/** True while a signal has stopped it. */
bool dea_worker_stopped(const dea_worker *worker);
/** Reaps a worker that is gone by itself and writes how it ended into @p how; dea_worker_end() is still due.
 * @return what that end says about the work that it had */
dea_fault dea_worker_reap(dea_worker *worker, char *how, size_t size);
/** Kills and reaps the worker, if that is not done yet; its place is free then. */
void dea_worker_end(dea_worker *worker);

#endif
