/* Reading of the waveform, and what only the whole of it shows. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "drive/wave.h"
#include "scene/reader.h"

#define AT(member) offsetof(dea_scene, drive.waveform.member)

/* The kind that a key of the waveform says; DEA_WAVE_NONE: it is no form of one. */
static dea_wave_kind kind_of(const char *key)
{
    for (dea_wave_kind i = DEA_WAVE_NONE + 1; dea_wave_of(i); i++) {
        const char *alias = dea_wave_of(i)->alias;
        if (strcmp(key, dea_wave_name(dea_wave_of(i))) == 0 || (alias && strcmp(key, alias) == 0)) {
            return i;
        }
    }
    return DEA_WAVE_NONE;
}

dea_status dea_read_waveform(dea_reader *reader, const dea_ref *ref, const dea_node *node)
{
    const dea_node *form = NULL;
    for (const dea_node *child = node->kind == DEA_NODE_MAPPING ? node->first : NULL; child; child = child->next) {
        const dea_wave_kind kind = kind_of(child->key);
        if (kind != DEA_WAVE_NONE && form) {
            return dea_place_fail(&child->key_at, reader->error, ref->path, "gives both %s and %s; give one of them", form->key,
                                  child->key);
        }
        if (kind != DEA_WAVE_NONE) {
            form = child;
            reader->scene->drive.waveform.kind = kind;
        }
    }
    const dea_status status = dea_read_mapping(reader, ref, node);
    return status || form ? status : dea_reader_refuse(reader, ref, node, "says no voltage");
}

dea_status dea_read_wave_word(dea_reader *reader, const dea_ref *ref, const dea_node *node)
{
    dea_waveform *waveform = &reader->scene->drive.waveform;
    return dea_reader_word(reader, ref, node, dea_wave_of(waveform->kind)->words, &waveform->choice);
}

dea_status dea_read_sines(dea_reader *reader, const dea_ref *ref, const dea_node *node)
{
    if (node->kind != DEA_NODE_SEQUENCE || node->count == 0 || node->count > DEA_SINES) {
        return dea_reader_refuse(reader, ref, node, node->kind != DEA_NODE_SEQUENCE ? "not a list"
                                                    : node->count == 0 ? "holds no sine" : "too many sines");
    }
    size_t i = 0;
    reader->scene->drive.waveform.sine_count = node->count;
    for (const dea_node *child = node->first; child; child = child->next, i++) {
        char path[DEA_NAME_LENGTH];
        dea_ref entry;
        snprintf(path, sizeof path, "%.40s.%zu", ref->path, i);
        const dea_status status = dea_key_find(path, &entry) ? dea_read_mapping(reader, &entry, child) : DEA_ERROR_USAGE;
        if (status) {
            return status;
        }
    }
    return DEA_OK;
}

dea_status dea_points_new(dea_reader *reader, size_t count)
{
    dea_waveform *waveform = &reader->scene->drive.waveform;
    free(waveform->times);
    free(waveform->voltages);
    waveform->times = calloc(count, sizeof *waveform->times);
    waveform->voltages = calloc(count, sizeof *waveform->voltages);
    waveform->point_count = count;
    return waveform->times && waveform->voltages ? DEA_OK : dea_reader_memory(reader);
}

/* What is wrong with the time of point @p index after the one before it, NULL: nothing. */
static const char *points_fault(const dea_waveform *waveform, size_t index)
{
    const double time = waveform->times[index];
    if (time < 0.0) {
        return "the time is out of range";
    }
    if (index == 0) {
        return NULL;
    }
    const double before = waveform->times[index - 1];
    if (!(time >= before)) {
        return "the times decrease";
    }
    if (time == before) { /* a jump */
        return index > 1 && waveform->times[index - 2] == time ? "more than two points of one time" : NULL;
    }
    return time - before >= DEA_EDGE_MIN ? NULL : "two times are closer than 1e-12 s";
}

static dea_status pairs_check(dea_reader *reader, const dea_ref *ref, const dea_node *node)
{
    if (node->kind != DEA_NODE_SEQUENCE || node->count == 0) {
        return dea_reader_refuse(reader, ref, node, node->kind == DEA_NODE_SEQUENCE ? "holds no point" : "not a list");
    }
    for (const dea_node *pair = node->first; pair; pair = pair->next) {
        if (pair->kind != DEA_NODE_SEQUENCE || pair->count != 2) {
            return dea_reader_refuse(reader, ref, pair, "not a pair of a time and a voltage");
        }
    }
    return DEA_OK;
}

/* All times go before all voltages, so that the unit at hand seldom changes. */
static dea_status times_read(dea_reader *reader, const dea_node *node)
{
    static const dea_key time = {.path = "drive.waveform.points",
                                 .unit = "s",
                                 .high = INFINITY,
                                 .kinds = DEA_KEY_BOTH,
                                 .accepted = "times >= 0 that do not decrease, two of one time for a jump, e.g. [[0 s, 0 V], [5 s, 4500 V]]"};
    const dea_ref ref = {.key = time, .path = "drive.waveform.points"};
    const dea_waveform *waveform = &reader->scene->drive.waveform;
    size_t i = 0;
    for (const dea_node *pair = node->first; pair; pair = pair->next, i++) {
        const dea_status status = dea_reader_number(reader, &ref, pair->first, &waveform->times[i]);
        const char *fault = status ? NULL : points_fault(waveform, i);
        if (status || fault) {
            return status ? status : dea_reader_refuse(reader, &ref, pair->first, fault);
        }
    }
    return DEA_OK;
}

static dea_status voltages_read(dea_reader *reader, const dea_node *node)
{
    static const dea_key voltage = {.path = "drive.waveform.points",
                                    .unit = "V",
                                    .low = -INFINITY,
                                    .high = INFINITY,
                                    .kinds = DEA_KEY_BOTH,
                                    .accepted = "a voltage, e.g. [[0 s, 0 V], [5 s, 4500 V]]"};
    const dea_ref ref = {.key = voltage, .path = "drive.waveform.points"};
    double *next = reader->scene->drive.waveform.voltages;
    dea_status status = DEA_OK;
    for (const dea_node *pair = node->first; pair && !status; pair = pair->next) {
        status = dea_reader_number(reader, &ref, pair->last, next++);
    }
    return status;
}

dea_status dea_read_points(dea_reader *reader, const dea_ref *ref, const dea_node *node)
{
    dea_status status = pairs_check(reader, ref, node);
    status = status ? status : dea_points_new(reader, node->count);
    status = status ? status : times_read(reader, node);
    return status ? status : voltages_read(reader, node);
}

void dea_waveform_drop(dea_scene *scene)
{
    free(scene->drive.waveform.times);
    free(scene->drive.waveform.voltages);
    scene->drive.waveform = dea_waveform_none();
}

/* Least and largest value of a scalar over its axis. */
typedef struct span {
    double low, high;
} span;

static span span_of(const dea_scene *scene, size_t offset)
{
    const double value = *(const double *)((const char *)scene + offset);
    span range = {value, value};
    for (size_t i = 0; i < scene->axis_count; i++) {
        const dea_axis *axis = &scene->axes[i];
        for (size_t k = 0; axis->offset == offset && k < axis->count; k++) {
            range = k == 0 ? (span){axis->values[0], axis->values[0]}
                           : (span){fmin(range.low, axis->values[k]), fmax(range.high, axis->values[k])};
        }
    }
    return range;
}

static dea_status fail_at(dea_reader *reader, size_t offset, const char *path, const char *problem, const char *accepted)
{
    const dea_node *node = dea_reader_given(reader, offset)->node;
    char shown[DEA_TEXT_ROOM] = "";
    if (node) {
        dea_reader_show(node, shown);
    }
    return dea_place_fail(dea_reader_place(reader, offset, "drive.waveform"), reader->error, path, "%s%s%s%s; accepted: %s",
                          problem, shown[0] ? " (" : "", shown, shown[0] ? ")" : "", accepted);
}

/* Waveforms between which those of all runs lie. */
static void bounds_of(const dea_scene *scene, const dea_wave *wave, dea_waveform *low, dea_waveform *high)
{
    *low = *high = scene->drive.waveform;
    const size_t entries = wave->stride ? scene->drive.waveform.sine_count : 1;
    for (size_t i = 0; i < wave->number_count * entries; i++) {
        double *first = dea_wave_at(wave, low, i % wave->number_count, i / wave->number_count);
        const size_t offset = AT(kind) - offsetof(dea_waveform, kind) + (size_t)((char *)first - (char *)low);
        const span range = span_of(scene, offset);
        *first = range.low;
        *dea_wave_at(wave, high, i % wave->number_count, i / wave->number_count) = range.high;
    }
    low->period = span_of(scene, AT(period)).low;
}

/* What was not given takes its preset, or is missing. */
static dea_status numbers_finish(dea_reader *reader, const dea_wave *wave)
{
    dea_waveform *waveform = &reader->scene->drive.waveform;
    const size_t entries = wave->stride ? waveform->sine_count : 1;
    for (size_t i = 0; i < wave->number_count * entries; i++) {
        const dea_wave_number *number = &wave->numbers[i % wave->number_count];
        double *value = dea_wave_at(wave, waveform, i % wave->number_count, i / wave->number_count);
        if (!isnan(*value)) {
            continue;
        }
        if (number->needed) {
            char parent[DEA_NAME_LENGTH], path[DEA_NAME_LENGTH];
            snprintf(parent, sizeof parent, wave->stride ? "%s.%zu" : "%s", wave->path, i / wave->number_count);
            snprintf(path, sizeof path, "%.40s.%.20s", parent, number->name);
            return dea_reader_missing(reader, wave->stride ? wave->path : parent, path);
        }
        *value = number->preset;
    }
    return DEA_OK;
}

/* What repeats has come to its end before, and its next edge keeps its distance. */
static dea_status period_finish(dea_reader *reader, const dea_wave *wave, const dea_wave_bounds *bounds)
{
    const double period = bounds->low->period;
    if (isnan(period)) {
        return DEA_OK;
    }
    if (wave->once) {
        char problem[100];
        snprintf(problem, sizeof problem, "contradicts %s, %s", dea_wave_name(wave), wave->once);
        return fail_at(reader, AT(period), "drive.waveform.period", problem, "period with step, points, burst or file");
    }
    double first, last, rise;
    wave->extent(bounds, &first, &last, &rise);
    const double rest = dea_wave_gap(period, last);
    if (rest >= 0.0 && period >= DEA_EDGE_MIN && dea_wave_apart(rest + first, rise, DEA_EDGE_MIN)) {
        return DEA_OK;
    }
    return fail_at(reader, AT(period), "drive.waveform.period", rest < 0.0 ? "out of range" : "two edges closer than 1e-12 s",
                   wave->until);
}

dea_status dea_waveform_finish(dea_reader *reader)
{
    const dea_scene *scene = reader->scene;
    const dea_wave *wave = dea_wave_of(scene->drive.waveform.kind);
    dea_waveform low, high;
    dea_wave_fault fault = {0};
    if (!wave) {
        return DEA_OK;
    }
    const dea_status status = numbers_finish(reader, wave);
    if (status) {
        return status;
    }
    bounds_of(scene, wave, &low, &high);
    const span every = span_of(scene, offsetof(dea_scene, transient.every));
    const span until = span_of(scene, offsetof(dea_scene, transient.until));
    const dea_wave_bounds bounds = {
        .low = &low, .high = &high, .every = isnan(every.high) ? until.high / 1000.0 : every.high, .shortest = DEA_EDGE_MIN};
    if (wave->fits && !wave->fits(&bounds, &fault)) {
        char path[DEA_NAME_LENGTH];
        snprintf(path, sizeof path, "%.40s.%.20s", wave->path, fault.number->name);
        if (fault.period) {
            return dea_place_fail(dea_reader_place(reader, AT(period), "drive.waveform"), reader->error, path, "%s; accepted: %s",
                                  fault.problem, fault.accepted);
        }
        const size_t offset = AT(kind) - offsetof(dea_waveform, kind) + fault.number->offset;
        return fail_at(reader, offset, path, fault.problem, fault.accepted);
    }
    return period_finish(reader, wave, &bounds);
}
