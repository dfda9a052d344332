/* Reading of the study: what it asks, and over which axes. */
#include <math.h>
#include <string.h>

#include "scene/reader.h"
#include "study/study.h"

static dea_status kind_find(dea_reader *reader, const dea_node *study)
{
    const dea_node *found = NULL;
    for (const dea_node *child = study->first; child; child = child->next) {
        for (dea_study_kind kind = 0; kind < DEA_STUDIES; kind++) {
            if (strcmp(child->key, dea_study_at(kind)->name) != 0) {
                continue;
            }
            if (found) {
                return dea_place_fail(&child->key_at, reader->error, "study", "asks for both %s and %s; give one of them",
                                      found->key, child->key);
            }
            found = child;
            reader->scene->study = kind;
        }
    }
    return found ? DEA_OK
                 : dea_place_fail(&study->place, reader->error, "study",
                                  "asks for nothing; write {sweep: {}} for the scene as one point");
}

/* A waveform is a setting's where its form is. */
static bool waveform_set(const dea_node *waveform)
{
    bool set = waveform->place.origin->setting;
    for (const dea_node *child = waveform->first; child; child = child->next) {
        set = set || child->place.origin->setting;
    }
    return set;
}

static dea_status fail_contradiction(dea_reader *reader, const dea_node *waveform, const dea_node *voltage)
{
    const bool late = voltage->place.origin->setting;
    return dea_place_fail(late ? &voltage->place : &waveform->key_at, reader->error, late ? "drive.voltage" : "drive.waveform",
                          "contradicts %s, which is given too; a transient takes drive.waveform alone",
                          late ? "drive.waveform" : "drive.voltage");
}

/* A transient takes a waveform, the other studies a voltage. Of the two, a setting replaces that of the file. */
static dea_status drive_settle(dea_reader *reader)
{
    dea_scene *scene = reader->scene;
    dea_given *voltage = dea_reader_given(reader, offsetof(dea_scene, drive.voltage));
    const dea_node *waveform = dea_tree_find(reader->root, "drive.waveform");
    const bool transient = dea_study_of(scene)->waveform;
    if (transient && !waveform) {
        return dea_place_fail(
            dea_reader_place(reader, offsetof(dea_scene, drive.voltage), "drive"), reader->error, "drive.waveform",
            "missing; a transient takes it in place of drive.voltage; accepted: a mapping with a form "
            "such as step, sine or file, e.g. {step: {on: 5 s, off: 15 s, voltage: 4500 V}}");
    }
    if (!waveform || (transient && !voltage->node)) {
        return DEA_OK;
    }
    const bool voltage_set = voltage->node && voltage->node->place.origin->setting;
    const bool drops = transient ? waveform_set(waveform) && !voltage_set : voltage_set && !waveform_set(waveform);
    if (drops && transient) {
        *voltage = (dea_given){.node = NULL};
        scene->drive.voltage = NAN;
    } else if (drops) {
        dea_waveform_drop(scene);
        dea_tree_remove(dea_tree_child(reader->root, "drive"), "waveform");
    } else if (transient) {
        return fail_contradiction(reader, waveform, voltage->node);
    } else {
        return dea_place_fail(&waveform->key_at, reader->error, "drive.waveform",
                              "belongs to study.transient, but the study is %s; accepted: drive.voltage, e.g. 4500 V",
                              dea_study_of(scene)->name);
    }
    return DEA_OK;
}

/* Axes stand in the study's own mapping, or, of runs, in `over` beside it. */
static dea_status axes_find(dea_reader *reader, const dea_node **axes)
{
    const dea_study *study = dea_study_of(reader->scene);
    const dea_node *over = dea_tree_find(reader->root, "study.over");
    const dea_node *inside = dea_tree_find(reader->root, study->axes);
    if (over && !study->along) {
        return dea_place_fail(&over->key_at, reader->error, "study.over", "is not for a %s; accepted: its axes in %s", study->name,
                              study->axes);
    }
    if (over && inside) {
        return dea_place_fail(&over->key_at, reader->error, "study.over", "contradicts %s, which is given too; give one of them",
                              study->axes);
    }
    reader->axes = inside || !study->along ? study->axes : "study.over";
    *axes = inside ? inside : over;
    return DEA_OK;
}

dea_status dea_reader_study(dea_reader *reader)
{
    const dea_node *study = dea_tree_child(reader->root, "study");
    const dea_node *axes = NULL;
    dea_ref ref;
    if (!study) {
        return dea_place_fail(&reader->root->place, reader->error, "study",
                              "missing; write study: {sweep: {}} for the scene as one point");
    }
    dea_status status = kind_find(reader, study);
    status = status ? status : drive_settle(reader);
    status = status ? status : axes_find(reader, &axes);
    if (status || !axes) {
        return status;
    }
    if (axes->kind != DEA_NODE_MAPPING && dea_key_find(reader->axes, &ref)) {
        return dea_reader_refuse(reader, &ref, axes, "not a mapping");
    }
    return dea_reader_axes(reader, axes);
}

dea_status dea_reader_bias(dea_reader *reader, double *bias)
{
    const dea_study *study = dea_study_of(reader->scene);
    *bias = isnan(*bias) ? reader->scene->drive.voltage : *bias;
    return isnan(*bias) ? dea_place_fail(&dea_tree_find(reader->root, study->path)->place, reader->error, study->bias,
                                         "missing; accepted: a voltage, e.g. 4500 V, here or as drive.voltage")
                        : DEA_OK;
}

dea_status dea_reader_frame(dea_reader *reader, const char *path)
{
    const dea_given *frame = dea_reader_given(reader, offsetof(dea_scene, actuator.frame_radius));
    return frame->swept ? dea_place_fail(&frame->node->key_at, reader->error, "actuator.frame_radius",
                                         "is swept beside %s, whose radii are the same in all runs; accepted: the radius of an "
                                         "electrode, or coverage", path)
                        : DEA_OK;
}

dea_status dea_study_finish(dea_reader *reader)
{
    const dea_study *study = dea_study_of(reader->scene);
    return study->finish ? study->finish(reader) : DEA_OK;
}
