/* Reading of the study: what it asks, and over which axes. */
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "scene/reader.h"
#include "support/number.h"

enum { PER_DECADE_MAX = 10000 };

static const char *const kinds[] = {[DEA_STUDY_SWEEP] = "sweep", [DEA_STUDY_TRANSIENT] = "transient", [DEA_STUDY_AC] = "ac"};
enum { KINDS = sizeof kinds / sizeof *kinds };

static dea_status window_read(dea_reader *reader, const dea_ref *ref, const dea_node *node, dea_window *window)
{
    *window = (dea_window){.from = NAN, .to = NAN};
    const dea_status status = node->kind == DEA_NODE_MAPPING ? dea_reader_children(reader, ref->path, node)
                                                             : dea_reader_refuse(reader, ref, node, "not a window");
    if (!status && (isnan(window->from) || isnan(window->to))) {
        return dea_reader_refuse(reader, ref, node, isnan(window->from) ? "from is missing" : "to is missing");
    }
    return status;
}

/* One window, or a list of them. */
dea_status dea_read_average(dea_reader *reader, const dea_ref *ref, const dea_node *node)
{
    dea_transient *transient = &reader->scene->transient;
    if (node->kind != DEA_NODE_SEQUENCE) {
        transient->average_count = 1;
        return window_read(reader, ref, node, &transient->averages[0]);
    }
    if (node->count > DEA_WINDOWS) {
        return dea_reader_refuse(reader, ref, node, "too many windows");
    }
    dea_status status = DEA_OK;
    for (const dea_node *window = node->first; window && !status; window = window->next) {
        char path[DEA_NAME_LENGTH];
        dea_ref own;
        const size_t index = transient->average_count++;
        snprintf(path, sizeof path, "study.transient.average.%zu", index);
        status =
            dea_key_find(path, &own) ? window_read(reader, &own, window, &transient->averages[index]) : dea_reader_memory(reader);
    }
    return status;
}

dea_status dea_read_start(dea_reader *reader, const dea_ref *ref, const dea_node *node)
{
    static const char *const words[] = {"rest", "bias", NULL};
    size_t index = 0;
    const dea_status status = dea_reader_word(reader, ref, node, words, &index);
    reader->scene->transient.from_bias = !status && index == 1;
    return status;
}

dea_status dea_read_points_per_decade(dea_reader *reader, const dea_ref *ref, const dea_node *node)
{
    if (node->kind != DEA_NODE_SCALAR || !dea_count_read(node->text, PER_DECADE_MAX, &reader->scene->ac.points_per_decade)) {
        return dea_reader_refuse(reader, ref, node, "out of range");
    }
    return DEA_OK;
}

static dea_status kind_find(dea_reader *reader, const dea_node *study)
{
    const dea_node *found = NULL;
    for (const dea_node *child = study->first; child; child = child->next) {
        for (size_t i = 0; i < KINDS; i++) {
            if (strcmp(child->key, kinds[i]) != 0) {
                continue;
            }
            if (found) {
                return dea_place_fail(&child->key_at, reader->error, "study", "asks for both %s and %s; give one of them",
                                      found->key, child->key);
            }
            found = child;
            reader->scene->study = (dea_study_kind)i;
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
    const bool transient = scene->study == DEA_STUDY_TRANSIENT;
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
                              scene->study == DEA_STUDY_AC ? "ac" : "sweep");
    }
    return DEA_OK;
}

/* Axes stand in study.sweep, or in `over` beside or inside the other studies. */
static dea_status axes_find(dea_reader *reader, const dea_node **axes)
{
    const dea_scene *scene = reader->scene;
    const dea_node *over = dea_tree_find(reader->root, "study.over");
    const char *const inner = scene->study == DEA_STUDY_AC ? "study.ac.over" : "study.transient.over";
    const dea_node *inside = dea_tree_find(reader->root, inner);
    if (scene->study == DEA_STUDY_SWEEP) {
        reader->axes = "study.sweep";
        *axes = dea_tree_find(reader->root, reader->axes);
        return over ? dea_place_fail(&over->key_at, reader->error, "study.over",
                                     "belongs to transient and ac; accepted: its axes in study.sweep")
                    : DEA_OK;
    }
    reader->axes = inside ? inner : "study.over";
    *axes = inside ? inside : over;
    return over && inside ? dea_place_fail(&over->key_at, reader->error, "study.over",
                                           "contradicts %s, which is given too; give one of them", inner)
                          : DEA_OK;
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

static dea_status fail_value(dea_reader *reader, size_t offset, const char *parent, const char *path, const char *what,
                             double value, const char *accepted)
{
    return dea_place_fail(dea_reader_place(reader, offset, parent), reader->error, path, "%s (%g s); accepted: %s", what, value,
                          accepted);
}

static dea_status windows_finish(dea_reader *reader)
{
    const dea_transient *transient = &reader->scene->transient;
    for (size_t i = 0; i < transient->average_count; i++) {
        const dea_window *window = &transient->averages[i];
        const size_t from = offsetof(dea_scene, transient.averages) + i * sizeof *window + offsetof(dea_window, from);
        const size_t to = offsetof(dea_scene, transient.averages) + i * sizeof *window + offsetof(dea_window, to);
        const char *path = dea_reader_given(reader, to)->ref.path;
        if (window->to > transient->until) {
            return fail_value(reader, to, "study.transient.average", path, "beyond the end of the run", window->to,
                              "a time <= until");
        }
        if (!(window->from < window->to)) {
            return fail_value(reader, from, "study.transient.average", dea_reader_given(reader, from)->ref.path, "out of range",
                              window->from, "a time >= 0 and < to");
        }
    }
    return DEA_OK;
}

static dea_status transient_finish(dea_reader *reader)
{
    dea_transient *transient = &reader->scene->transient;
    const size_t every = offsetof(dea_scene, transient.every);
    if (isnan(transient->until)) {
        return dea_reader_missing(reader, "study.transient", "study.transient.until");
    }
    transient->every = isnan(transient->every) ? transient->until / 1000.0 : transient->every;
    if (!(transient->every > 0.0 && transient->every <= transient->until)) {
        return fail_value(reader, every, "study.transient", "study.transient.every", "out of range", transient->every,
                          "a time > 0 and <= until");
    }
    if (!(floor(transient->until / transient->every * (1.0 + 1e-12)) + 1.0 <= DEA_SAMPLES_MAX)) {
        return fail_value(reader, every, "study.transient", "study.transient.every", "too many samples", transient->every,
                          "at most 4000000 samples up to until");
    }
    double whole;
    transient->grid = dea_number_power(transient->every, &whole);
    return windows_finish(reader);
}

static dea_status ac_finish(dea_reader *reader)
{
    const dea_scene *scene = reader->scene;
    dea_ac *ac = &reader->scene->ac;
    if (isnan(ac->from) || isnan(ac->to)) {
        return dea_reader_missing(reader, "study.ac", isnan(ac->from) ? "study.ac.from" : "study.ac.to");
    }
    const dea_place *place = dea_reader_place(reader, offsetof(dea_scene, ac.to), "study.ac");
    if (!(ac->from <= ac->to)) {
        return dea_place_fail(place, reader->error, "study.ac.to", "out of range (%g Hz); accepted: a frequency >= from, %g Hz",
                              ac->to, ac->from);
    }
    if (!(ceil(log10(ac->to / ac->from) * (double)ac->points_per_decade) + 1.0 <= DEA_SAMPLES_MAX)) {
        return dea_place_fail(place, reader->error, "study.ac.to",
                              "too many frequencies (%g Hz); accepted: at most 4000000 from %g Hz on", ac->to, ac->from);
    }
    ac->bias = isnan(ac->bias) ? scene->drive.voltage : ac->bias;
    if (isnan(ac->bias)) {
        return dea_place_fail(&dea_tree_find(reader->root, "study.ac")->place, reader->error, "study.ac.bias",
                              "missing; accepted: a voltage, e.g. 4500 V, here or as drive.voltage");
    }
    return DEA_OK;
}

dea_status dea_study_finish(dea_reader *reader)
{
    if (reader->scene->study == DEA_STUDY_TRANSIENT) {
        return transient_finish(reader);
    }
    return reader->scene->study == DEA_STUDY_AC ? ac_finish(reader) : DEA_OK;
}
