#include "result/compare.h"

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

static dea_state still_state(const dea_scene *scene, double voltage)
{
    dea_point point;
    dea_row row = dea_row_failed();
    dea_film_prepare(scene, &point.film);
    dea_point_place(scene, &point);
    point.voltage = voltage;
    if (dea_point_valid(&point)) {
        dea_model_solve(scene->models[0], &point, scene->accuracy, &row);
    }
    return row.state;
}

bool dea_state_between(const dea_scene *scene, double share, dea_state one, dea_state other)
{
    const dea_state below = still_state(scene, scene->drive.voltage * (1.0 - share));
    const dea_state above = still_state(scene, scene->drive.voltage * (1.0 + share));
    return (below == one && above == other) || (below == other && above == one);
}
