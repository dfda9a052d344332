/* Frequency responses of the membrane: its rings linearised about the equilibrium under the bias. Two meshes, the finer by two
 * degrees, tell the error of the coarser one; the rows are those of the finer. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "engine/ngspice/bands.h"
#include "engine/ngspice/moving.h"
#include "netlist/rings_small.h"
#include "network/rings_mesh.h"

typedef struct response {
    dea_bands bands;
    dea_membrane membrane;
    double u[DEA_RINGS_NODES];
    double voltage; /* of the film at the bias [V] */
    char edge[24];
} response;

static void write_membrane(const void *user, FILE *out)
{
    const response *r = user;
    dea_rings_small_write(&(dea_rings_small){&r->membrane, r->u, r->voltage}, out);
}

/* The film at its bias on a mesh; *state: what it is there. */
static dea_status open_mesh(response *r, const dea_model *model, dea_rings_mesh mesh, dea_state *state, dea_error *error)
{
    dea_membrane_look look;
    dea_row row = dea_row_failed();
    const dea_status status = dea_membrane_open(r->bands.scene, model, mesh, &r->membrane, error);
    if (status != DEA_OK) {
        return status;
    }
    memset(r->u, 0, sizeof r->u);
    r->voltage = r->bands.scene->ac.bias / (1.0 + r->membrane.film.series * r->membrane.film.conductance);
    *state = DEA_STATE_PULL_IN;
    if (dea_membrane_still(&r->membrane, r->voltage, r->u) && dea_membrane_look_at(&r->membrane, r->u, &look)) {
        dea_membrane_row(&r->membrane, &look, r->voltage, r->u, &row);
        r->bands.capacitance = look.capacitance;
        snprintf(r->edge, sizeof r->edge, "u%zu", r->membrane.rings.edge + 1);
        *state = row.state;
    }
    return DEA_OK;
}

static double gap(const dea_answer *a, const dea_answer *b, size_t count)
{
    double most = 0.0;
    for (size_t i = 0; i < count; i++) {
        most = fmax(most, cabs(a[i].displacement - b[i].displacement) / cabs(b[i].displacement));
        most = fmax(most, cabs(a[i].impedance - b[i].impedance) / cabs(b[i].impedance));
    }
    return most;
}

/* Meshes ever finer until two of them agree: the error of the finer one is a small part of their difference. */
static dea_status refine(response *r, const dea_model *model, dea_answer *pair[2], size_t count, dea_state *state, dea_error *error)
{
    const bool wide = dea_rings_usual_mesh(r->bands.scene).logarithmic;
    const size_t first = 4 + (size_t)fmax(0.0, ceil(-0.5 * log10(r->bands.scene->accuracy)));
    for (size_t degree = first; degree <= DEA_RINGS_DEGREE; degree += 2) {
        dea_answer *last = pair[0];
        pair[0] = pair[1];
        pair[1] = last;
        dea_status status = open_mesh(r, model, (dea_rings_mesh){degree, degree, wide}, state, error);
        if (status != DEA_OK || *state == DEA_STATE_PULL_IN || *state == DEA_STATE_FAILED) {
            return status;
        }
        status = dea_bands_run(&r->bands, count, pair[1], error);
        if (status != DEA_OK || (degree > first && gap(pair[0], pair[1], count) <= r->bands.scene->accuracy)) {
            return status;
        }
    }
    *state = DEA_STATE_FAILED;
    dea_fail(error, DEA_OK, "meshes of up to %d degrees do not agree within the accuracy", DEA_RINGS_DEGREE);
    return DEA_OK;
}

dea_status dea_ngspice_ac_rings(dea_ngspice *library, const dea_scene *scene, const dea_model *model, dea_response *rows,
                                dea_band *band, dea_error *error)
{
    const size_t count = dea_layout_of(scene).rows;
    response *r = calloc(1, sizeof *r);
    dea_answer *answers = calloc(2 * count, sizeof *answers);
    dea_state state = DEA_STATE_FAILED;
    if (!r || !answers) {
        free(r);
        free(answers);
        return dea_fail(error, DEA_ERROR_MEMORY, "out of memory for a frequency response");
    }
    dea_answer *pair[2] = {answers, answers + count};
    r->bands = (dea_bands){.library = library,
                           .scene = scene,
                           .film = &r->membrane.film,
                           .transduction = (double)NAN,
                           .edge = r->edge,
                           .user = r,
                           .write = write_membrane};
    const dea_status status = refine(r, model, pair, count, &state, error);
    if (status == DEA_OK) {
        dea_bands_fill(&r->bands, count, pair[1], state, rows, band);
    }
    free(answers);
    free(r);
    return status;
}
