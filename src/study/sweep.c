/* Statics: the scene at every combination of values of its axes. */
#include <math.h>

#include "netlist/export.h"
#include "scene/key_forms.h"
#include "picture/picture.h"
#include "study/study.h"

static const dea_key keys[] = {
    OTHER("study.sweep", dea_read_later, "a mapping of axes, e.g. {coverage: [0.25, 0.5]}"),
};

static const dea_study_column compared[] = {
    {offsetof(dea_row, strain), DEA_OVER_ITSELF, "strain"},
    {offsetof(dea_row, displacement), DEA_OVER_ITSELF, "displacement"},
    {offsetof(dea_row, force), DEA_OVER_ITSELF, "force"},
    {offsetof(dea_row, field), DEA_OVER_ITSELF, "field"},
    {offsetof(dea_row, capacitance), DEA_OVER_ITSELF, "capacitance"},
    {offsetof(dea_row, charge), DEA_OVER_ITSELF, "charge"},
    {offsetof(dea_row, area_strain), DEA_OVER_ITSELF, "area_strain"},
    {offsetof(dea_row, focal_length), DEA_OVER_ITSELF, "focal_length"},
    {offsetof(dea_row, energy), DEA_OVER_ITSELF, "energy"},
    {offsetof(dea_row, second_field), DEA_OVER_ITSELF, "antagonist"},
};

static void lay(const dea_scene *scene, dea_layout *layout)
{
    for (size_t i = 0; i < DEA_ROW_COLUMNS; i++) {
        const size_t offset = dea_row_columns[i].offset;
        const bool absent = (offset == offsetof(dea_row, focal_length) && isnan(scene->actuator.focal_length)) ||
                            (offset == offsetof(dea_row, second_field) && !scene->antagonist.there);
        if (!absent) {
            dea_layout_add(layout, dea_row_columns[i]);
        }
    }
}

static bool offered(const dea_engine *engine)
{
    (void)engine;
    return true;
}

const dea_study dea_study_sweep = {
    .name = "sweep",
    .path = "study.sweep",
    .axes = "study.sweep",
    .title = "static study",
    .points = {"point", "points"},
    .rows = {"point", "points"},
    .plot_name = "DC transfer characteristic",
    .unit = "point",
    .unit_head = "us/point",
    .unit_label = "Wall time per point",
    .unit_scale = 1e6,
    .keys = keys,
    .key_count = sizeof keys / sizeof *keys,
    .compared = compared,
    .compared_count = sizeof compared / sizeof *compared,
    .drawer = &dea_drawer_points,
    .lay = lay,
    .offered = offered,
    .netlist = dea_export_sweep,
};
