/* Frequency responses of a film of one node: the small-signal network about the equilibrium under the bias. */
#include <math.h>
#include <stdlib.h>

#include "engine/ngspice/bands.h"
#include "engine/ngspice/moving.h"

static void write_film(const void *user, FILE *out)
{
    const dea_biased_film *film = user;
    const dea_cards_form form = {.dialect = dea_dialect_find("ngspice"), .analogy = dea_analogy_at(0), .numbers = true};
    dea_cards_write_small(film->dynamics, &film->bias, &form, out);
    fprintf(out, "VSOURCE %s 0 dc 0 ac 1\n", film->dynamics->series > 0.0 ? "source" : "film");
}

dea_bands dea_bands_of_film(const dea_biased_film *film, const dea_scene *scene, dea_ngspice *library)
{
    const dea_edge e = dea_dynamics_edge(film->dynamics, film->bias.u);
    return (dea_bands){.library = library,
                       .scene = scene,
                       .film = film->dynamics,
                       .capacitance = e.capacitance,
                       .transduction = 2.0 * e.push * film->bias.voltage,
                       .edge = "disp",
                       .user = film,
                       .write = write_film};
}

/* The film under its bias; its state there stands in every row. */
static dea_state settle(dea_biased_film *film, const dea_scene *scene)
{
    dea_dynamics *d = film->dynamics;
    dea_sample sample;
    film->bias.voltage = scene->ac.bias / (1.0 + d->series * d->conductance);
    if (!dea_dynamics_equilibrium(d, film->bias.voltage, &film->bias.u) ||
        !(dea_dynamics_stiffness(d, film->bias.u, film->bias.voltage, true) > 0.0)) {
        return DEA_STATE_PULL_IN;
    }
    const dea_moment moment = {.source = scene->ac.bias, .voltage = film->bias.voltage, .u = film->bias.u};
    return dea_dynamics_sample(d, &moment, &sample) ? sample.state : DEA_STATE_PULL_IN;
}

static dea_status run_bands(dea_biased_film *film, const dea_scene *scene, dea_ngspice *library, dea_response *rows, dea_band *band,
                            dea_error *error)
{
    const size_t count = dea_layout_of(scene).rows;
    dea_answer *answers = calloc(count, sizeof *answers);
    if (!answers) {
        return dea_fail(error, DEA_ERROR_MEMORY, "out of memory for a frequency response");
    }
    const dea_state state = settle(film, scene);
    const dea_bands bands = dea_bands_of_film(film, scene, library);
    const dea_status status = state == DEA_STATE_PULL_IN ? DEA_OK : dea_bands_run(&bands, count, answers, error);
    if (status == DEA_OK) {
        dea_bands_fill(&bands, count, answers, state, rows, band);
    }
    free(answers);
    return status;
}

static dea_status run_inside(dea_ngspice *library, const dea_scene *scene, const dea_model *model, dea_response *rows,
                             dea_band *band, dea_error *error)
{
    dea_dynamics dynamics;
    dea_biased_film film = {.dynamics = &dynamics};
    dea_status status = dea_dynamics_open(scene, model, &dynamics, error);
    if (status == DEA_OK) {
        status = run_bands(&film, scene, library, rows, band, error);
    }
    dea_dynamics_close(&dynamics);
    return status;
}

/* Units that suit the scene; its time is that of the middle of the band. */
static dea_status find_units(const dea_scene *scene, const dea_model *model, dea_units *units, dea_error *error)
{
    dea_dynamics dynamics;
    const dea_status status = dea_dynamics_open(scene, model, &dynamics, error);
    if (status == DEA_OK) {
        const dea_sizes sizes = {.displacement = dea_dynamics_scale(&dynamics, scene->ac.bias),
                                 .voltage = fabs(scene->ac.bias),
                                 .time = 1.0 / sqrt(scene->ac.from * scene->ac.to)};
        *units = dea_units_of(&dynamics, &sizes);
    }
    dea_dynamics_close(&dynamics);
    return status;
}

dea_status dea_ngspice_ac(dea_ngspice *library, const dea_scene *scene, const dea_model *model, dea_response *rows,
                          dea_band *band, dea_error *error)
{
    dea_units units;
    dea_scene inside;
    dea_band found = {(double)NAN, (double)NAN};
    dea_status status = find_units(scene, model, &units, error);
    if (status == DEA_OK) {
        status = dea_units_enter(&units, scene, &inside, error);
    }
    if (status != DEA_OK) {
        return status;
    }
    status = run_inside(library, &inside, model, rows, band ? &found : NULL, error);
    dea_units_leave(&inside);
    for (size_t i = 0; status == DEA_OK && i < dea_layout_of(scene).rows; i++) {
        dea_units_return_response(&units, &rows[i]);
    }
    if (band) {
        *band = (dea_band){found.resonance * units.time, found.bandwidth * units.time};
    }
    return status;
}
