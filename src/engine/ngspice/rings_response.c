/* Frequency responses of the membrane: its rings linearised about the equilibrium under the bias, on the mesh that exports take. */
#include <math.h>
#include <stdlib.h>

#include "engine/ngspice/bands.h"
#include "engine/ngspice/moving.h"
#include "netlist/rings_small.h"
#include "network/rings_band.h"

static void write_membrane(const void *user, FILE *out)
{
    const dea_rings_biased *b = user;
    dea_rings_small_write(&(dea_rings_small){&b->membrane, b->u, b->voltage}, out);
}

/* All rows of a film that stands. */
static dea_status run(dea_ngspice *library, const dea_scene *scene, const dea_rings_biased *b, dea_answer *answers, dea_response *rows,
                      dea_band *band, dea_error *error)
{
    const size_t count = dea_layout_of(scene).rows;
    char edge[24];
    snprintf(edge, sizeof edge, "u%zu", b->membrane.rings.edge + 1);
    const dea_bands bands = {.library = library,
                             .scene = scene,
                             .film = &b->membrane.film,
                             .capacitance = b->look.capacitance,
                             .transduction = (double)NAN,
                             .edge = edge,
                             .user = b,
                             .write = write_membrane};
    const dea_status status = dea_rings_stands(b) ? dea_bands_run(&bands, count, answers, error) : DEA_OK;
    if (status == DEA_OK) {
        dea_bands_fill(&bands, count, answers, b->state, rows, band);
    }
    return status;
}

dea_status dea_ngspice_ac_rings(dea_ngspice *library, const dea_scene *scene, const dea_model *model, dea_response *rows,
                                dea_band *band, dea_error *error)
{
    dea_rings_biased *b = calloc(1, sizeof *b);
    dea_answer *answers = calloc(dea_layout_of(scene).rows, sizeof *answers);
    double gap = INFINITY;
    dea_status status = b && answers ? dea_rings_band(scene, model, b, &gap, error)
                                     : dea_fail(error, DEA_ERROR_MEMORY, "out of memory for a frequency response");
    if (status == DEA_OK && dea_rings_stands(b) && gap > scene->accuracy) {
        b->state = DEA_STATE_FAILED;
        dea_fail(error, DEA_OK, "meshes of up to %d degrees do not agree within the accuracy", DEA_RINGS_DEGREE);
    }
    if (status == DEA_OK) {
        status = run(library, scene, b, answers, rows, band, error);
    }
    free(answers);
    free(b);
    return status;
}
