/* The static film along its radius: displacement, stretches, thickness, true stresses and field from the centre to the frame. */
#include <math.h>
#include <stdio.h>

#include "picture/picture.h"
#include "scene/key_forms.h"
#include "study/study.h"

#define PROFILE "study.profile"

static const dea_key keys[] = {
    OTHER(PROFILE, dea_read_mapping, "a mapping with points and over, e.g. {points: 101}"),
    AMOUNT(PROFILE ".points", profile.points, 2, DEA_RADII_MAX, NULL, "a whole number of radii, 2 ... 10001, e.g. 101"),
    OVER(PROFILE ".over"),
};

static bool takes(const dea_model *model)
{
    return model->along != NULL;
}

static dea_status finish(dea_reader *reader)
{
    return dea_reader_frame(reader, PROFILE);
}

static void identify(FILE *out, const dea_scene *scene)
{
    fprintf(out, PROFILE ".points=%zu\n", scene->profile.points);
}

static const dea_column columns[] = {
    {"radius_m", "radius of the film at rest and 0 V", "m", offsetof(dea_station, radius)},
    {"displacement_m", "radial displacement from there", "m", offsetof(dea_station, displacement)},
    {"stretch_radial", "stretch along the radius, pre-stretch included", "1", offsetof(dea_station, stretch[0])},
    {"stretch_hoop", "stretch along the hoop, pre-stretch included", "1", offsetof(dea_station, stretch[1])},
    {"thickness_m", "thickness of each layer of the deformed film", "m", offsetof(dea_station, thickness)},
    {"stress_radial_Pa", "true radial stress of film and voltage together", "Pa", offsetof(dea_station, stress[0])},
    {"stress_hoop_Pa", "true hoop stress of film and voltage together", "Pa", offsetof(dea_station, stress[1])},
    {"field_V_per_m", "true electric field, 0 without electrode", "V/m", offsetof(dea_station, field)},
};

static const dea_column figures[] = {
    {"largest_field_V_per_m", "largest true electric field", "V/m", offsetof(dea_weakest, field)},
    {"largest_field_radius_m", "radius of the largest field, at rest and 0 V", "m", offsetof(dea_weakest, field_radius)},
    {"least_tension_Pa", "smallest true stress in the plane of the film", "Pa", offsetof(dea_weakest, tension)},
    {"least_tension_radius_m", "radius of the smallest stress, at rest and 0 V", "m", offsetof(dea_weakest, tension_radius)},
};

static const dea_study_column compared[] = {
    {offsetof(dea_station, displacement), DEA_OVER_ITSELF, "displacement"},
    {offsetof(dea_station, stretch[0]), DEA_OVER_ITSELF, "radial"},
    {offsetof(dea_station, stretch[1]), DEA_OVER_ITSELF, "hoop"},
    {offsetof(dea_station, thickness), DEA_OVER_ITSELF, "thickness"},
    {offsetof(dea_station, stress[0]), DEA_OVER_ITSELF, "radial_Pa"},
    {offsetof(dea_station, stress[1]), DEA_OVER_ITSELF, "hoop_Pa"},
    {offsetof(dea_station, field), DEA_OVER_ITSELF, "field"},
};

static const size_t drawn[] = {offsetof(dea_station, displacement), offsetof(dea_station, stretch[0]),
                               offsetof(dea_station, stretch[1]), offsetof(dea_station, stress[0]),
                               offsetof(dea_station, stress[1]), offsetof(dea_station, field)};

static void lay(const dea_scene *scene, dea_layout *layout)
{
    layout->rows = scene->profile.points;
}

static double place(const dea_scene *scene, size_t index)
{
    return scene->actuator.frame_radius * (double)index / (double)(scene->profile.points - 1);
}

static void fail(const dea_layout *layout, void *point)
{
    const double none = (double)NAN;
    *dea_layout_weakest(layout, point) = (dea_weakest){none, none, none, none};
}

const dea_study dea_study_profile = {
    .name = "profile",
    .path = PROFILE,
    .axes = PROFILE ".over",
    .title = "study of profiles",
    .points = {"run", "runs"},
    .rows = {"radius", "radii"},
    .along = true,
    .still = true,
    .stations = true,
    .sign = "radius",
    .model_fails = "has no profile, its annulus has not two stretches",
    .model_lacks = "the model has no profile",
    .engine_fails = "it has no profiles",
    .plot_name = "Profile",
    .unit = "radius",
    .unit_head = "us/radius",
    .unit_label = "Wall time per radius",
    .unit_scale = 1e6,
    .keys = keys,
    .key_count = sizeof keys / sizeof *keys,
    .columns = columns,
    .column_count = sizeof columns / sizeof *columns,
    .row_size = sizeof(dea_station),
    .state_offset = offsetof(dea_station, state),
    .behind = sizeof(dea_weakest),
    .compared = compared,
    .compared_count = sizeof compared / sizeof *compared,
    .figures = figures,
    .figure_count = sizeof figures / sizeof *figures,
    .drawn = drawn,
    .drawn_count = sizeof drawn / sizeof *drawn,
    .drawer = &dea_drawer_profiles,
    .takes = takes,
    .finish = finish,
    .identify = identify,
    .lay = lay,
    .place = place,
    .fail = fail,
    .solve = dea_study_solve,
};
