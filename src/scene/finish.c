/* What only the whole scene shows. */
#include <math.h>
#include <stddef.h>
#include <stdio.h>
#include <string.h>

#include "deaspice/model.h"
#include "scene/reader.h"
#include "study/study.h"

/* A key that every scene needs, by the mapping that should hold it. */
typedef struct need {
    const char *parent, *path;
} need;

/* A material that lacks a key gets it in its file, or in the scene on top of it. */
static dea_status material_missing(dea_reader *reader, const char *path)
{
    dea_ref ref;
    char shown[DEA_TEXT_ROOM];
    const dea_node *material = dea_tree_child(reader->root, "material");
    const dea_node *base = material->kind == DEA_NODE_MAPPING ? dea_tree_child(material, "base") : material;
    if (!base || !dea_key_find(path, &ref)) {
        return dea_reader_missing(reader, "material", path);
    }
    dea_reader_show(base, shown);
    const char *name = strrchr(path, '.') + 1;
    return dea_place_fail(
        &base->place, reader->error, path,
        "missing: %s gives none; write one there (%s: 2.8), or here, material: {base: %s, %s: 2.8}; accepted: %s", shown, name,
        shown, name, ref.key.accepted);
}

static dea_status needs_check(dea_reader *reader)
{
    static const need needs[] = {
        {"actuator", "actuator.frame_radius"}, {"actuator", "actuator.film_thickness"}, {"actuator", "actuator.prestretch"},
        {"material", "material.permittivity"}, {"drive", "drive.voltage"},
    };
    const dea_study *study = dea_study_of(reader->scene);
    if (!reader->kind_known) {
        return dea_reader_missing(reader, "actuator", "actuator.kind");
    }
    if (!dea_tree_child(reader->root, "material")) {
        return dea_reader_missing(reader, "material", "material");
    }
    for (size_t i = 0; i < sizeof needs / sizeof *needs; i++) {
        dea_ref ref;
        if (strcmp(needs[i].path, "drive.voltage") == 0 && (study->waveform || study->bias)) {
            continue;
        }
        if (dea_key_find(needs[i].path, &ref) && isnan(*(const double *)((const char *)reader->scene + dea_ref_offset(&ref)))) {
            return strcmp(needs[i].path, "material.permittivity") == 0
                       ? material_missing(reader, needs[i].path)
                       : dea_reader_missing(reader, needs[i].parent, needs[i].path);
        }
    }
    const dea_actuator *actuator = &reader->scene->actuator;
    if (isnan(actuator->coverage) && isnan(actuator->divide_radius)) {
        return dea_place_fail(&dea_tree_child(reader->root, "actuator")->place, reader->error, "actuator.coverage",
                              "missing; accepted: coverage, e.g. 0.5, or %s",
                              actuator->kind == DEA_LENS ? "lens_radius" : "electrode_radius");
    }
    return reader->scene->model_count > 0 ? DEA_OK : dea_reader_missing(reader, "", "model");
}

static bool swept(dea_reader *reader, size_t offset)
{
    return dea_reader_given(reader, offset)->swept;
}

static size_t constant_offset(size_t index)
{
    return offsetof(dea_scene, material.constants) + index * sizeof(double);
}

/* Every constant of the law is there, and they fit together: what is swept is judged point by point. */
static dea_status law_check(dea_reader *reader, const dea_holder *holder)
{
    const dea_law *law = *holder->law;
    const size_t first = (size_t)((char *)holder->constants - (char *)reader->scene);
    char path[DEA_NAME_LENGTH];
    bool varies = false;
    for (size_t i = 0; law && i < *holder->entry_count * law->constant_count; i++) {
        varies = varies || swept(reader, first + i * sizeof(double));
        snprintf(path, sizeof path, "%s.%s.%s", holder->name, law->name, law->constants[i % law->constant_count].name);
        if (isnan(holder->constants[i])) {
            return dea_reader_missing(reader, holder->name, path);
        }
    }
    const char *fault = law && law->fault && !varies ? law->fault(holder->constants) : NULL;
    if (!fault) {
        return DEA_OK;
    }
    snprintf(path, sizeof path, "%s.%s", holder->name, law->name);
    return dea_place_fail(dea_reader_place(reader, first, holder->name), reader->error, path, "%s", fault);
}

/* One resistance stands for the sheets of a film whose electrode moves as one; of a membrane the potential is told along them, but in its
 * modes. Under a bias it is uniform only where no charge leaks away. */
static dea_status sheet_check(dea_reader *reader)
{
    const dea_scene *scene = reader->scene;
    const dea_study *study = dea_study_of(scene);
    const size_t sheet = offsetof(dea_scene, electrode.sheet_resistance);
    const bool along = study->timed || study->phasors, biased = study->phasors || scene->transient.from_bias;
    const bool leaks = biased && !isnan(scene->drive.leakage_resistance);
    for (size_t i = 0; i < scene->model_count && study->along && !study->still; i++) {
        if (scene->models[i]->membrane && (!along || leaks)) {
            return dea_place_fail(dea_reader_place(reader, sheet, "electrode"), reader->error, "electrode.sheet_resistance",
                                  along ? "beside a leakage, under a bias, is more than the model %s can do; accepted: no "
                                          "leakage_resistance, start: rest, or models of one node, e.g. ring"
                                        : "is one resistance, which the model %s has no place for; accepted: models of one node, e.g. ring, "
                                          "or a transient",
                                  scene->models[i]->name);
        }
    }
    return DEA_OK;
}

/* A skin is a thickness with a law; electrodes have mass by their density or per area, not both. */
static dea_status electrode_check(dea_reader *reader)
{
    const dea_electrode *electrode = &reader->scene->electrode;
    const size_t density = offsetof(dea_scene, electrode.density);
    if (!dea_tree_child(reader->root, "electrode")) {
        return DEA_OK;
    }
    if (!isnan(electrode->sheet_resistance)) {
        const dea_status status = sheet_check(reader);
        if (status || (isnan(electrode->thickness) && !electrode->law && isnan(electrode->density))) {
            return status;
        }
    }
    if (isnan(electrode->thickness)) {
        return dea_reader_missing(reader, "electrode", "electrode.thickness");
    }
    if (!electrode->law) {
        return dea_place_fail(dea_reader_place(reader, offsetof(dea_scene, electrode.thickness), "electrode"), reader->error, "electrode",
                              "a skin without a law; accepted: one beside the thickness, e.g. neo_hookean: {mu: 20 kPa}");
    }
    if (!isnan(electrode->density) && !isnan(reader->scene->actuator.electrode_mass)) {
        return dea_place_fail(dea_reader_place(reader, density, "electrode"), reader->error, "electrode.density",
                              "contradicts actuator.electrode_mass, which is given too; give one of them");
    }
    const dea_key skin = {.within = "electrode"};
    const dea_holder holder = dea_reader_holder(reader, &skin);
    return law_check(reader, &holder);
}

/* Chains that are straight before the pre-stretch hold no film; the last constant of such a law says where. */
static dea_status locking_check(dea_reader *reader)
{
    const dea_scene *scene = reader->scene;
    const dea_law *law = scene->material.law;
    const size_t last = law->constant_count - 1;
    if (!law->locking || swept(reader, constant_offset(last)) || swept(reader, offsetof(dea_scene, actuator.prestretch))) {
        return DEA_OK;
    }
    const dea_film film = dea_law_film(law, scene->material.constants, scene->actuator.prestretch);
    const double locking = law->locking(scene->material.constants);
    if (film.j < locking) {
        return DEA_OK;
    }
    char path[DEA_NAME_LENGTH];
    snprintf(path, sizeof path, "material.%s.%s", law->name, law->constants[last].name);
    return dea_place_fail(dea_reader_place(reader, constant_offset(last), "material"), reader->error, path,
                          "too small (%g) for the pre-stretch %g, where I1 - 3 is %.6g: the chains are straight at %.6g; accepted: "
                          "a larger %s, or less pre-stretch",
                          scene->material.constants[last], film.prestretch, film.j, locking, law->constants[last].name);
}

/* A load gives something, and one that has mass moves a film that has, too. */
static dea_status load_check(dea_reader *reader)
{
    const dea_scene *scene = reader->scene;
    const dea_node *load = dea_tree_child(reader->root, "load");
    bool given = false;
    for (size_t i = 0; i < dea_load_count(); i++) {
        const dea_edge_load *one = &scene->loads[i];
        given = given || !isnan(one->number);
        if (!isnan(one->number) && one->kind->adds.mass > 0.0 && isnan(scene->material.density)) {
            char path[DEA_NAME_LENGTH];
            snprintf(path, sizeof path, "load.%s", one->kind->name);
            return dea_place_fail(dea_reader_place(reader, (size_t)((const char *)&one->number - (const char *)scene), "load"), reader->error, path,
                                  "moves with a film that has none; accepted: material.density beside it, e.g. 1080 kg/m^3");
        }
    }
    if (load && !given) {
        char accepted[DEA_KEY_ROOM];
        dea_key_suggest("load", "", accepted);
        return dea_place_fail(&load->place, reader->error, "load", "without a number%s, e.g. {stiffness: 20 N/m}", accepted);
    }
    return DEA_OK;
}

/* A source gives less than its voltage only in time, and what it gives then needs a resistance to be told from that voltage. */
static dea_status limit_check(dea_reader *reader)
{
    const dea_scene *scene = reader->scene;
    const size_t limit = offsetof(dea_scene, drive.current_limit), series = offsetof(dea_scene, drive.series_resistance);
    const dea_place *place = dea_reader_place(reader, limit, "drive");
    if (isnan(scene->drive.current_limit)) {
        return DEA_OK;
    }
    if (!dea_study_of(scene)->timed) {
        return dea_place_fail(place, reader->error, "drive.current_limit",
                              "belongs to study.transient, but the study is %s, in which the source gives what the film takes; accepted: a "
                              "transient, or no limit",
                              dea_study_of(scene)->name);
    }
    return swept(reader, series) || dea_series_resistance(scene) > 0.0
               ? DEA_OK
               : dea_place_fail(place, reader->error, "drive.current_limit",
                                "of a source without resistance; accepted: drive.series_resistance > 0 beside it, e.g. 1 MOhm");
}

static dea_status radius_check(dea_reader *reader)
{
    const dea_actuator *actuator = &reader->scene->actuator;
    const size_t divide = offsetof(dea_scene, actuator.divide_radius);
    const size_t frame = offsetof(dea_scene, actuator.frame_radius);
    if (isnan(actuator->divide_radius) || swept(reader, divide) || swept(reader, frame) ||
        actuator->divide_radius < actuator->frame_radius) {
        return DEA_OK;
    }
    return dea_place_fail(dea_reader_place(reader, divide, "actuator"), reader->error, dea_reader_given(reader, divide)->ref.path,
                          "out of range (%g m); accepted: less than frame_radius, %g m", actuator->divide_radius,
                          actuator->frame_radius);
}

/* A film as thick as its frame is wide is no film: most likely the unit is another one. */
static dea_status thickness_check(dea_reader *reader)
{
    const dea_actuator *actuator = &reader->scene->actuator;
    const size_t thickness = offsetof(dea_scene, actuator.film_thickness);
    if (swept(reader, thickness) || swept(reader, offsetof(dea_scene, actuator.frame_radius)) ||
        actuator->film_thickness < actuator->frame_radius) {
        return DEA_OK;
    }
    return dea_place_fail(dea_reader_place(reader, thickness, "actuator"), reader->error, "actuator.film_thickness",
                          "out of range (%g m); accepted: less than frame_radius, %g m, e.g. 100 um", actuator->film_thickness,
                          actuator->frame_radius);
}

static dea_status permittivity_check(dea_reader *reader)
{
    const dea_scene *scene = reader->scene;
    const size_t constant = offsetof(dea_scene, material.permittivity);
    const size_t slope = offsetof(dea_scene, material.permittivity_per_stretch);
    const bool follows = scene->material.permittivity_follows;
    const double value = dea_material_permittivity(&scene->material, scene->actuator.prestretch);
    const double pull = dea_material_permittivity(&scene->material, (follows ? 1.25 : 1.0) * scene->actuator.prestretch);
    if (swept(reader, constant) || swept(reader, slope) || swept(reader, offsetof(dea_scene, actuator.prestretch)) ||
        (value > 0.0 && pull > 0.0)) {
        return DEA_OK;
    }
    if (value > 0.0) {
        return dea_place_fail(dea_reader_place(reader, slope, "material"), reader->error, "material.permittivity.per_stretch",
                              "%g: a film whose permittivity follows that shrinks under voltage at the pre-stretch %g; accepted: "
                              "constant + 1.25 per_stretch prestretch > 0",
                              scene->material.permittivity_per_stretch, scene->actuator.prestretch);
    }
    return dea_place_fail(dea_reader_place(reader, slope, "material"), reader->error, "material.permittivity",
                          "falls to %g at the pre-stretch %g; accepted: a permittivity > 0 there", value,
                          scene->actuator.prestretch);
}

/* Each law of the temperature has all its numbers. */
static dea_status thermal_check(dea_reader *reader)
{
    const dea_material *material = &reader->scene->material;
    const dea_shift *shift = &material->shift;
    const struct {
        const char *path;
        double value;
        bool needed;
    } numbers[] = {
        {"material.shift.wlf.C1", shift->c1, !isnan(shift->c2) || !isnan(shift->reference)},
        {"material.shift.wlf.C2", shift->c2, !isnan(shift->c1)},
        {"material.shift.wlf.reference", shift->reference, !isnan(shift->c1)},
        {"material.modulus_slope.per_kelvin", material->modulus_slope, !isnan(material->modulus_reference)},
        {"material.modulus_slope.reference", material->modulus_reference, !isnan(material->modulus_slope)},
    };
    for (size_t i = 0; i < sizeof numbers / sizeof *numbers; i++) {
        if (numbers[i].needed && isnan(numbers[i].value)) {
            return dea_reader_missing(reader, "material", numbers[i].path);
        }
    }
    return DEA_OK;
}

/* A temperature is one that the material says something about. */
static dea_status temperature_check(dea_reader *reader)
{
    const dea_material *material = &reader->scene->material;
    const dea_shift *shift = &material->shift;
    const size_t offset = offsetof(dea_scene, material.temperature);
    const dea_given *given = dea_reader_given(reader, offset);
    const dea_place *place = dea_reader_place(reader, offset, "");
    if (!given->node) {
        return DEA_OK;
    }
    if (isnan(shift->c1) && shift->count == 0 && isnan(material->modulus_slope)) {
        return dea_place_fail(place, reader->error, "temperature", "changes nothing: the material has no shift and no modulus_slope; accepted: "
                              "one of them, e.g. modulus_slope: {per_kelvin: 0.2 %%/K, reference: 20 degC}");
    }
    if (given->swept || swept(reader, offsetof(dea_scene, material.shift.c2)) || swept(reader, offsetof(dea_scene, material.shift.reference)) ||
        swept(reader, offsetof(dea_scene, material.modulus_slope)) || swept(reader, offsetof(dea_scene, material.modulus_reference))) {
        return DEA_OK;
    }
    const double factor = dea_material_shift(material);
    if (isnan(factor) && shift->count > 0) {
        return dea_place_fail(place, reader->error, "temperature", "out of the table of shift factors (%g K); accepted: %g to %g K",
                              material->temperature, shift->table[0][0], shift->table[shift->count - 1][0]);
    }
    if (!(factor > 0.0 && isfinite(factor))) {
        return dea_place_fail(place, reader->error, "temperature", "at or below the pole of the WLF law, or so near that no factor is left (%g K); "
                              "accepted: above reference - C2, %g K", material->temperature, shift->reference - shift->c2);
    }
    if (!(dea_material_stiffening(material) > 0.0)) {
        return dea_place_fail(place, reader->error, "temperature", "leaves the film no modulus (%g K, %g of it); accepted: 1 + per_kelvin (T - reference) > 0",
                              material->temperature, dea_material_stiffening(material));
    }
    return DEA_OK;
}

dea_status dea_material_finish(dea_reader *reader)
{
    const dea_material *material = &reader->scene->material;
    double sum = 0.0;
    for (size_t i = 0; i < material->prony_count; i++) {
        sum += swept(reader, offsetof(dea_scene, material.prony) + i * sizeof(dea_prony)) ? 0.0 : material->prony[i].g;
    }
    if (sum < 1.0) {
        return thermal_check(reader);
    }
    const size_t first = offsetof(dea_scene, material.prony);
    return dea_place_fail(dea_reader_place(reader, first, "material"), reader->error, "material.prony",
                          "the shares g sum to %g; accepted: less than 1, so that a long-term modulus stays", sum);
}

/* The cap of the lens is part of a sphere: its radius at rest, f (n - 1), is no less than that of the lens. */
static dea_status cap_check(dea_reader *reader)
{
    const dea_actuator *actuator = &reader->scene->actuator;
    const size_t focus = offsetof(dea_scene, actuator.focal_length);
    const size_t needed[] = {focus, offsetof(dea_scene, actuator.refractive_index), offsetof(dea_scene, actuator.divide_radius),
                             offsetof(dea_scene, actuator.coverage), offsetof(dea_scene, actuator.frame_radius)};
    const double power = actuator->refractive_index - 1.0;
    const double radius =
        isnan(actuator->divide_radius) ? actuator->coverage * actuator->frame_radius : actuator->divide_radius;
    for (size_t i = 0; i < sizeof needed / sizeof *needed; i++) {
        if (swept(reader, needed[i])) {
            return DEA_OK;
        }
    }
    if (actuator->focal_length * power >= radius) {
        return DEA_OK;
    }
    return dea_place_fail(dea_reader_place(reader, focus, "actuator"), reader->error, "actuator.optics.focal_length",
                          "too short (%g m) for a cap of that lens radius, %g m; accepted: %.6g m and more",
                          actuator->focal_length, radius, radius / power);
}

static dea_status optics_check(dea_reader *reader)
{
    const dea_actuator *actuator = &reader->scene->actuator;
    const bool length = !isnan(actuator->focal_length);
    if (length == !isnan(actuator->refractive_index)) {
        return length ? cap_check(reader) : DEA_OK;
    }
    const size_t given = length ? offsetof(dea_scene, actuator.focal_length) : offsetof(dea_scene, actuator.refractive_index);
    return dea_place_fail(dea_reader_place(reader, given, "actuator"), reader->error, "actuator.optics",
                          "%s is missing; accepted: both keys together", length ? "refractive_index" : "focal_length");
}

dea_status dea_law_finish(dea_reader *reader)
{
    const dea_key film = {.within = NULL};
    const dea_holder holder = dea_reader_holder(reader, &film);
    return law_check(reader, &holder);
}

dea_status dea_reader_finish(dea_reader *reader)
{
    dea_status status = needs_check(reader);
    status = status ? status : dea_law_finish(reader);
    status = status ? status : electrode_check(reader);
    status = status ? status : load_check(reader);
    status = status ? status : limit_check(reader);
    status = status ? status : locking_check(reader);
    status = status ? status : radius_check(reader);
    status = status ? status : thickness_check(reader);
    status = status ? status : permittivity_check(reader);
    status = status ? status : dea_material_finish(reader);
    status = status ? status : temperature_check(reader);
    status = status ? status : optics_check(reader);
    status = status ? status : dea_models_finish(reader);
    status = status ? status : dea_antagonist_finish(reader);
    status = status ? status : dea_waveform_finish(reader);
    return status ? status : dea_study_finish(reader);
}
