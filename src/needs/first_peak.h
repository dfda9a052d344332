/* The first peak of a film behind the first edge of its voltage, by few steps and without a library: how far a model is from the
 * membrane once both swing. */
#ifndef DEA_FIRST_PEAK_H
#define DEA_FIRST_PEAK_H

#include "deaspice/model.h"
#include "deaspice/scene.h"

/* Peak of a model's displacement over that of the membrane, less 1 [1], right to 0.5 %. NAN where there is none, or it is not cheap: without
 * a voltage that rises along one line from 0 and stands for the first period of the swing, a swing or rest at the begin; with a skin, a load,
 * steep waves, stiff dampers, or an end in between. All axes of @p scene are at their place.
 * @param[in,out] steps that may be taken, some 4 us each; those that were taken are subtracted */
double dea_first_peak_deviation(const dea_scene *scene, const dea_model *model, const dea_model *truth, int *steps);

#endif
