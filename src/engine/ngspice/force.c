/* Forces on an edge that is held: the network of a line of points with a voltage source at its edge, v(edge) = displacement, whose
 * current is what the network exerts on it. */
#include <math.h>
#include <stdlib.h>

#include "deaspice/result.h"
#include "engine/ngspice/library.h"
#include "engine/ngspice/moving.h"
#include "netlist/netlist.h"
#include "network/balance.h"

typedef struct curve {
    dea_ngspice *library;
    const dea_scene *scene;
    const dea_model *model;
    dea_network network;
    dea_balance balance;
    dea_row *rows;
} curve;

/* Rows from the forces and, of all else, from the network at the displacement. */
static void fill(curve *c, const double *forces)
{
    const double radius = dea_balance_radius(&c->balance), frame = c->scene->actuator.frame_radius;
    for (size_t i = 0; i < c->scene->force.points; i++) {
        const double u = dea_layout_place(c->scene, i);
        c->rows[i] = dea_row_failed();
        c->rows[i].displacement = u;
        if (u > -radius && u < frame - radius) {
            dea_balance_fill(&c->balance, 0.0, u, &c->rows[i]);
            c->rows[i].force = c->rows[i].state == DEA_STATE_FAILED ? (double)NAN : forces[i];
        }
    }
}

static dea_status sweep(curve *c, dea_error *error)
{
    char *netlist;
    const char *const current = "bhold#branch";
    dea_ngspice_table table = {0};
    const dea_forces f = dea_balance_forces(&c->balance, 0.0, 0.0);
    const dea_force_study *held = &c->scene->force;
    const dea_netlist_study study = {.scene = c->scene,
                                     .model = c->model,
                                     .count = held->points,
                                     .held = held,
                                     .tolerance = fmin(1e-8, 0.1 * c->scene->accuracy),
                                     .length_scale = c->scene->actuator.frame_radius,
                                     .force_scale = fabs(f.elastic_slope) * c->scene->actuator.frame_radius};
    dea_status status = dea_netlist_write(&study, &netlist, error);
    if (status == DEA_OK) {
        status = dea_ngspice_run_all(c->library, netlist, &current, 1, &table, error);
        free(netlist);
    }
    if (status == DEA_OK && table.count != held->points) {
        status = dea_fail(error, DEA_ERROR_ENGINE, "ngspice gave %zu of %zu displacements", table.count, held->points);
    }
    if (status == DEA_OK) {
        fill(c, table.columns[0]);
    }
    dea_ngspice_table_free(&table);
    return status;
}

dea_status dea_ngspice_force(void *session, const dea_scene *scene, const dea_model *model, const dea_layout *layout, void *point,
                             dea_error *error)
{
    curve c = {.library = session, .scene = scene, .model = model, .rows = point};
    (void)layout;
    dea_status status = dea_network_build(scene, model, NULL, &c.network, error);
    if (status == DEA_OK) {
        status = dea_balance_open(&c.network, &c.balance, error);
    }
    if (status == DEA_OK && !dea_balance_valid(&c.balance, 0.0)) {
        status = dea_fail(error, DEA_ERROR_USAGE, "a number is out of its range");
    }
    if (status == DEA_OK) {
        status = sweep(&c, error);
    }
    dea_balance_close(&c.balance);
    dea_network_free(&c.network);
    return status;
}
