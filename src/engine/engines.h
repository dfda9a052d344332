/** @file engines.h
 * The engines that the table lists; each is defined in its own folder.
 */
#ifndef DEA_ENGINE_ENGINES_H
#define DEA_ENGINE_ENGINES_H

#include "deaspice/engine.h"

extern const dea_engine dea_engine_direct;  /**< the models' own equations, in this process */
extern const dea_engine dea_engine_ngspice; /**< the network in ngspice */
extern const dea_engine dea_engine_ida;     /**< network and membrane by SUNDIALS */

#endif
