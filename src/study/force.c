/* Force over displacement: what the actuator exerts on something that holds its edge at each displacement, under its static voltage.
 * Outward is positive, over the whole circumference: the film's F_DEA less what it holds there, and what else the scene has on the
 * edge, a load's spring and force or a second film. The force at displacement 0 is the blocked force; where it is 0 the edge rests. */
#include <math.h>
#include <stdio.h>

#include "picture/picture.h"
#include "scene/key_forms.h"
#include "study/study.h"

#define FORCE "study.force"
#define DISPLACEMENT FORCE ".displacement"

static const dea_key keys[] = {
    OTHER(FORCE, dea_read_mapping, "a mapping with displacement and over, e.g. {displacement: {from: 0 mm, to: 0.6 mm, points: 61}}"),
    OTHER(DISPLACEMENT, dea_read_mapping, "a mapping with from, to and points, e.g. {from: 0 mm, to: 0.6 mm, points: 61}"),
    PART(DISPLACEMENT ".from", force.from, "m", "_m", -INFINITY, INFINITY, true, 0, DISPLACEMENT, "a displacement, outward positive, e.g. 0 mm"),
    PART(DISPLACEMENT ".to", force.to, "m", "_m", -INFINITY, INFINITY, true, 0, DISPLACEMENT, "a displacement other than from, e.g. 0.6 mm"),
    AMOUNT(DISPLACEMENT ".points", force.points, 2, DEA_RADII_MAX, NULL, "a whole number of displacements, 2 ... 10001, e.g. 61"),
    OVER(FORCE ".over"),
};

static bool takes(const dea_model *model)
{
    return model->edge;
}

/* The edge stays between centre and frame; where these are swept, rows beyond tell so themselves. */
static dea_status room_check(dea_reader *reader, double displacement, size_t offset, const char *path)
{
    const dea_actuator *actuator = &reader->scene->actuator;
    const size_t places[] = {offsetof(dea_scene, actuator.frame_radius), offsetof(dea_scene, actuator.coverage),
                             offsetof(dea_scene, actuator.divide_radius)};
    const double radius = isnan(actuator->divide_radius) ? actuator->coverage * actuator->frame_radius : actuator->divide_radius;
    bool swept = false;
    for (size_t i = 0; i < sizeof places / sizeof *places; i++) {
        const dea_given *given = dea_reader_given(reader, places[i]);
        swept = swept || (given && given->swept);
    }
    if (swept || (displacement > -radius && displacement < actuator->frame_radius - radius)) {
        return DEA_OK;
    }
    return dea_place_fail(dea_reader_place(reader, offset, DISPLACEMENT), reader->error, path,
                          "out of range (%g m): the edge is %g m from the centre and %g m from the frame; accepted: between these", displacement,
                          radius, actuator->frame_radius - radius);
}

static dea_status finish(dea_reader *reader)
{
    const dea_force_study *force = &reader->scene->force;
    const size_t from = offsetof(dea_scene, force.from), to = offsetof(dea_scene, force.to);
    if (isnan(force->from) || isnan(force->to)) {
        return dea_reader_missing(reader, dea_tree_find(reader->root, DISPLACEMENT) ? DISPLACEMENT : FORCE,
                                  isnan(force->from) ? DISPLACEMENT ".from" : DISPLACEMENT ".to");
    }
    if (force->from == force->to) {
        return dea_place_fail(dea_reader_place(reader, to, DISPLACEMENT), reader->error, DISPLACEMENT ".to",
                              "out of range (%g m), from is the same; accepted: another displacement", force->to);
    }
    const dea_status status = room_check(reader, force->from, from, DISPLACEMENT ".from");
    return status ? status : room_check(reader, force->to, to, DISPLACEMENT ".to");
}

static void identify(FILE *out, const dea_scene *scene)
{
    fprintf(out, DISPLACEMENT ".points=%zu\n", scene->force.points);
}

static const dea_column columns[] = {
    {"displacement_m", "radial displacement at which the disc edge is held", "m", offsetof(dea_row, displacement)},
    {"force_N", "force that the actuator exerts on what holds its edge, outward, over the circumference", "N", offsetof(dea_row, force)},
    {"field_V_per_m", "true electric field", "V/m", offsetof(dea_row, field)},
    {"capacitance_F", "capacitance of the film", "F", offsetof(dea_row, capacitance)},
    {"charge_C", "charge of the film", "C", offsetof(dea_row, charge)},
};

/* A force passes zero on its way. */
static const dea_study_column compared[] = {
    {offsetof(dea_row, force), DEA_OVER_PEAK, "force"},
    {offsetof(dea_row, field), DEA_OVER_ITSELF, "field"},
    {offsetof(dea_row, capacitance), DEA_OVER_ITSELF, "capacitance"},
    {offsetof(dea_row, charge), DEA_OVER_ITSELF, "charge"},
};

static const size_t drawn[] = {offsetof(dea_row, force)};

static void lay(const dea_scene *scene, dea_layout *layout)
{
    layout->rows = scene->force.points;
}

static double place(const dea_scene *scene, size_t index)
{
    const dea_force_study *force = &scene->force;
    return index + 1 == force->points ? force->to : force->from + (force->to - force->from) * ((double)index / (double)(force->points - 1));
}

const dea_study dea_study_force = {
    .name = "force",
    .path = FORCE,
    .axes = FORCE ".over",
    .title = "study of forces",
    .points = {"run", "runs"},
    .rows = {"displacement", "displacements"},
    .along = true,
    .still = true,
    .holds = true,
    .sign = "u",
    .model_fails = "has no edge that something could hold",
    .model_lacks = "the model has no edge that something could hold",
    .engine_fails = "it holds no edge",
    .plot_name = "Force",
    .unit = "displacement",
    .unit_head = "us/place",
    .unit_label = "Wall time per displacement",
    .unit_scale = 1e6,
    .keys = keys,
    .key_count = sizeof keys / sizeof *keys,
    .columns = columns,
    .column_count = sizeof columns / sizeof *columns,
    .compared = compared,
    .compared_count = sizeof compared / sizeof *compared,
    .drawn = drawn,
    .drawn_count = sizeof drawn / sizeof *drawn,
    .drawer = &dea_drawer_forces,
    .takes = takes,
    .finish = finish,
    .identify = identify,
    .lay = lay,
    .place = place,
    .solve = dea_study_solve,
};
