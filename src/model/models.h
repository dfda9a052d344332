/* The entries of the model table, one file each. */
#ifndef DEA_MODELS_H
#define DEA_MODELS_H

#include "film/point.h"

extern const dea_model dea_model_pelrine;
extern const dea_model dea_model_constant_force;
extern const dea_model dea_model_lumped;
extern const dea_model dea_model_coverage;
extern const dea_model dea_model_lame;
extern const dea_model dea_model_ring;
extern const dea_model dea_model_field;

#endif
