/** @file deaspice.h
 * Everything of libdeaspice.
 */
#ifndef DEASPICE_H
#define DEASPICE_H

#include "deaspice/bench.h"
#include "deaspice/engine.h"
#include "deaspice/fit.h"
#include "deaspice/load.h"
#include "deaspice/material.h"
#include "deaspice/measures.h"
#include "deaspice/model.h"
#include "deaspice/needs.h"
#include "deaspice/output.h"
#include "deaspice/plot.h"
#include "deaspice/result.h"
#include "deaspice/scene.h"
#include "deaspice/status.h"

#endif
