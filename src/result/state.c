#include "result/state.h"

#include <math.h>

#include "network/dynamics.h"

static bool is_state_at(dea_dynamics *dynamics, const dea_sample *sample, double u)
{
    dea_sample there;
    const double capacitance = dea_dynamics_edge(dynamics, u).capacitance;
    const double voltage = isnan(sample->charge) ? sample->voltage : sample->charge / capacitance;
    const dea_moment moment = {.time = sample->time, .source = sample->voltage, .voltage = voltage, .u = u};
    return dea_dynamics_sample(dynamics, &moment, &there) && there.state == sample->state;
}

bool dea_state_follows(const dea_scene *scene, const dea_sample *sample, double slack)
{
    dea_dynamics dynamics;
    bool follows = false;
    if (isnan(sample->displacement)) {
        return false;
    }
    if (dea_dynamics_open(scene, scene->models[0], &dynamics, NULL) == DEA_OK) {
        follows = is_state_at(&dynamics, sample, sample->displacement - slack) ||
                  is_state_at(&dynamics, sample, sample->displacement + slack);
    }
    dea_dynamics_close(&dynamics);
    return follows;
}
