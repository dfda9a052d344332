/* Modes of small motion about the equilibrium under a bias: frequencies, damping ratios, shapes. */
#include <math.h>
#include <stdio.h>

#include "picture/picture.h"
#include "scene/key_forms.h"
#include "study/study.h"

#define MODES "study.modes"

static const dea_key keys[] = {
    OTHER(MODES, dea_read_mapping, "a mapping with count, bias, points and over, e.g. {count: 3, bias: 3 kV}"),
    AMOUNT(MODES ".count", modes.count, 1, DEA_MODES_MOST, NULL, "a whole number 1 ... 12"),
    AMOUNT(MODES ".points", modes.points, 2, DEA_RADII_MAX, NULL, "a whole number of radii, 2 ... 10001, at which shapes are told, e.g. 51"),
    PART(MODES ".bias", modes.bias, "V", "_V", -INFINITY, INFINITY, true, 1, MODES, "a voltage, e.g. 3 kV"),
    OVER(MODES ".over"),
};

/* The mass that moves. */
static dea_status mass_check(dea_reader *reader)
{
    const dea_scene *scene = reader->scene;
    const bool light = isnan(scene->material.density) && !(dea_electrode_mass(scene) > 0.0);
    return light ? dea_place_fail(&dea_tree_find(reader->root, MODES)->place, reader->error, "material.density",
                                  "missing, and modes need a mass; accepted: a density > 0, e.g. 1080 kg/m^3")
                 : DEA_OK;
}

/* A film with one node has one mode. */
static dea_status count_check(dea_reader *reader)
{
    dea_modes_study *modes = &reader->scene->modes;
    const dea_model *single = NULL;
    for (size_t i = 0; i < reader->scene->model_count; i++) {
        single = reader->scene->models[i]->membrane ? single : reader->scene->models[i];
    }
    if (single && modes->count > 1) {
        return dea_place_fail(&dea_tree_find(reader->root, MODES ".count")->place, reader->error, MODES ".count",
                              "out of range (%zu), the model %s moves in one shape; accepted: 1, or the model field alone",
                              modes->count, single->name);
    }
    modes->count = modes->count > 0 ? modes->count : single ? 1 : 3;
    return DEA_OK;
}

static dea_status finish(dea_reader *reader)
{
    dea_scene *scene = reader->scene;
    dea_status status = mass_check(reader);
    status = status ? status : count_check(reader);
    status = status || scene->modes.points == 0 ? status : dea_reader_frame(reader, MODES ".points");
    scene->modes.bias = isnan(scene->modes.bias) && isnan(scene->drive.voltage) ? 0.0 : scene->modes.bias;
    return status ? status : dea_reader_bias(reader, &scene->modes.bias);
}

static dea_status rest(dea_scene *scene, dea_error *error)
{
    (void)error;
    scene->drive.voltage = scene->modes.bias;
    return DEA_OK;
}

static void identify(FILE *out, const dea_scene *scene)
{
    fprintf(out, MODES ".count=%zu\n" MODES ".points=%zu\n", scene->modes.count, scene->modes.points);
}

static const dea_column columns[] = {
    {"mode", "number of the mode", "1", offsetof(dea_mode, number)},
    {"frequency_Hz", "frequency of the mode, damped", "Hz", offsetof(dea_mode, frequency)},
    {"damping_ratio", "damping ratio of the mode", "1", offsetof(dea_mode, damping_ratio)},
    {"undamped_frequency_Hz", "frequency of the mode without damper, its branches relaxed", "Hz", offsetof(dea_mode, undamped)},
    {"edge_share", "share of the mode in what a small change of the voltage does to the disc edge", "1",
     offsetof(dea_mode, edge_share)},
    {"edge_mass_kg", "mass that moves with the disc edge in the mode", "kg", offsetof(dea_mode, edge_mass)},
};

static const dea_column shape[] = {
    {"shape", "displacement in the mode without damper, over the square root of its mass", "kg-0.5", 0},
};

static const dea_study_column compared[] = {
    {offsetof(dea_mode, frequency), DEA_OVER_ITSELF, "frequency"},
    {offsetof(dea_mode, damping_ratio), DEA_OVER_ITSELF, "damping"},
    {offsetof(dea_mode, undamped), DEA_OVER_ITSELF, "undamped"},
    {offsetof(dea_mode, edge_share), DEA_OVER_ITSELF, "edge_share"},
    {offsetof(dea_mode, edge_mass), DEA_OVER_ITSELF, "edge_mass"},
};

static void lay(const dea_scene *scene, dea_layout *layout)
{
    layout->rows = scene->modes.count;
    if (scene->modes.points > 0) {
        dea_layout_spread(layout, shape, 1, scene->modes.points);
    }
}

static double place(const dea_scene *scene, size_t index)
{
    (void)scene;
    return (double)(index + 1);
}

static bool takes(const dea_model *model)
{
    return model->dynamic || model->membrane;
}

const dea_study dea_study_modes = {
    .name = "modes",
    .path = MODES,
    .axes = MODES ".over",
    .title = "study of modes",
    .points = {"run", "runs"},
    .rows = {"mode", "modes"},
    .along = true,
    .bias = MODES ".bias",
    .model_fails = "does not move",
    .model_lacks = "the model does not move",
    .engine_fails = "it has no modes",
    .at = " at the bias",
    .plot_name = "Modes",
    .unit = "mode",
    .unit_head = "us/mode",
    .unit_label = "Wall time per mode",
    .unit_scale = 1e6,
    .keys = keys,
    .key_count = sizeof keys / sizeof *keys,
    .columns = columns,
    .column_count = sizeof columns / sizeof *columns,
    .row_size = sizeof(dea_mode),
    .state_offset = offsetof(dea_mode, state),
    .compared = compared,
    .compared_count = sizeof compared / sizeof *compared,
    .resonance = offsetof(dea_mode, frequency),
    .drawer = &dea_drawer_modes,
    .takes = takes,
    .finish = finish,
    .rest = rest,
    .identify = identify,
    .lay = lay,
    .place = place,
    .solve = dea_study_solve,
};
