/* Reading of a second film on the same edge. What it leaves out is taken from the first. */
#include <math.h>
#include <string.h>

#include "scene/reader.h"
#include "study/study.h"

dea_status dea_read_antagonist(dea_reader *reader, const dea_ref *ref, const dea_node *node)
{
    reader->scene->antagonist.there = true;
    return dea_read_mapping(reader, ref, node);
}

dea_status dea_read_antagonist_kind(dea_reader *reader, const dea_ref *ref, const dea_node *node)
{
    return dea_reader_kind(reader, ref, node, &reader->scene->antagonist.kind);
}

/* As the material of the first film, in whose place it is read; who gave what of that is kept aside. */
dea_status dea_read_antagonist_material(dea_reader *reader, const dea_ref *ref, const dea_node *node)
{
    dea_scene *scene = reader->scene;
    dea_given *given = dea_arena_take(&reader->arena, sizeof reader->given);
    if (!given) {
        return dea_reader_memory(reader);
    }
    const dea_material first = scene->material;
    memcpy(given, reader->given, sizeof reader->given);
    scene->material = dea_material_default();
    memset(reader->given, 0, sizeof reader->given);
    dea_status status = dea_read_material(reader, ref, node);
    scene->antagonist.material = scene->material;
    scene->antagonist.own_material = true;
    const bool lawless = !scene->material.law || isnan(scene->material.constants[0]);
    if (!status && (lawless || isnan(scene->material.permittivity))) {
        status = dea_place_fail(&node->place, reader->error, ref->path, "has no %s; accepted: a material with both a law and a permittivity",
                                lawless ? "law" : "permittivity");
    }
    status = status ? status : dea_law_finish(reader);
    status = status ? status : dea_material_finish(reader);
    scene->material = first;
    memcpy(reader->given, given, sizeof reader->given);
    return status;
}

/* Both films stand in one frame and share the edge at r_a. */
static dea_status frame_check(dea_reader *reader)
{
    const dea_scene *scene = reader->scene;
    const dea_actuator *actuator = &scene->actuator;
    const double coverage = isnan(actuator->divide_radius) ? actuator->coverage : actuator->divide_radius / actuator->frame_radius;
    const struct {
        size_t second;
        const char *path, *unit;
        double value, first;
    } numbers[] = {
        {offsetof(dea_scene, antagonist.frame_radius), "antagonist.actuator.frame_radius", " m", scene->antagonist.frame_radius, actuator->frame_radius},
        {offsetof(dea_scene, antagonist.coverage), "antagonist.actuator.coverage", "", scene->antagonist.coverage, coverage},
    };
    for (size_t i = 0; i < sizeof numbers / sizeof *numbers; i++) {
        if (!isnan(numbers[i].value) && !(fabs(numbers[i].value - numbers[i].first) <= 1e-12 * numbers[i].first)) {
            return dea_place_fail(dea_reader_place(reader, numbers[i].second, "antagonist"), reader->error, numbers[i].path,
                                  "unlike that of the first film (%g%s, %g%s there): two films of unlike frames share no edge; accepted: the "
                                  "same, or none",
                                  numbers[i].value, numbers[i].unit, numbers[i].first, numbers[i].unit);
        }
    }
    return DEA_OK;
}

/* The frame of the first film is swept, and that of the second stands still. */
static dea_status sweep_check(dea_reader *reader)
{
    const size_t firsts[] = {offsetof(dea_scene, actuator.frame_radius), offsetof(dea_scene, actuator.coverage),
                             offsetof(dea_scene, actuator.divide_radius)};
    const size_t seconds[] = {offsetof(dea_scene, antagonist.frame_radius), offsetof(dea_scene, antagonist.coverage)};
    bool swept = false;
    for (size_t i = 0; i < sizeof firsts / sizeof *firsts; i++) {
        swept = swept || dea_reader_given(reader, firsts[i])->swept;
    }
    for (size_t i = 0; i < sizeof seconds / sizeof *seconds; i++) {
        const dea_given *given = dea_reader_given(reader, seconds[i]);
        if (given->node && (swept || given->swept)) {
            return dea_place_fail(&given->node->place, reader->error, given->ref.path,
                                  "beside a sweep of the frame; accepted: none here, both films then have the swept one");
        }
    }
    return DEA_OK;
}

/* Branches follow the first film, and so does the damper of models of one node: they are the second's where its material is. A membrane's
 * inner nodes all have mass, or none has. */
static dea_status motion_check(dea_reader *reader)
{
    const dea_scene *scene = reader->scene;
    const bool own = scene->antagonist.own_material;
    const dea_material *material = own ? &scene->antagonist.material : &scene->material;
    const dea_study *study = dea_study_of(scene);
    const bool damped = !isnan(material->retardation), alike = isnan(material->density) == isnan(scene->material.density);
    const dea_place *place = &dea_tree_child(reader->root, "antagonist")->place;
    for (size_t i = 0; i < scene->model_count && study->along && !study->still; i++) {
        const bool membrane = scene->models[i]->membrane, node = !membrane || scene->automatic; /* which may become one of one node */
        if ((membrane && material->prony_count > 0) || (node && own && (material->prony_count > 0 || damped))) {
            return dea_place_fail(place, reader->error, "antagonist.material",
                                  "relaxes beside a %s of the model %s; accepted there: a material without %s, or a static study",
                                  study->title, scene->automatic ? "auto" : scene->models[i]->name,
                                  node ? "prony and retardation, or none of its own" : "prony");
        }
        if (membrane && !alike) {
            return dea_place_fail(place, reader->error, "antagonist.material.density",
                                  "of one film alone beside a %s of the model %s; accepted there: a density of both, or of neither",
                                  study->title, scene->models[i]->name);
        }
    }
    return DEA_OK;
}

dea_status dea_antagonist_finish(dea_reader *reader)
{
    const dea_scene *scene = reader->scene;
    if (!scene->antagonist.there) {
        return DEA_OK;
    }
    if (!dea_tree_find(reader->root, "antagonist.actuator.kind")) {
        return dea_reader_missing(reader, "antagonist", "antagonist.actuator.kind");
    }
    dea_status status = sweep_check(reader);
    status = status ? status : frame_check(reader);
    return status ? status : motion_check(reader);
}
