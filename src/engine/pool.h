/** @file pool.h
 * A study on worker processes.
 */
#ifndef DEA_ENGINE_POOL_H
#define DEA_ENGINE_POOL_H

#include "engine/plan.h"

/** Runs the plan on up to plan->options->jobs forked workers and reaps them all before it returns.
 * @param beyond time that a worker may take on top of its engine's patience [s] */
dea_status dea_pool_run(const dea_plan *plan, double beyond, dea_error *error);

#endif
