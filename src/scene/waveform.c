/* Reading of the waveform, and what only the whole of it shows. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "scene/reader.h"

#define AT(member) offsetof(dea_scene, drive.waveform.member)

dea_status dea_read_waveform(dea_reader *reader, const dea_ref *ref, const dea_node *node)
{
    static const struct {
        const char *key;
        dea_wave_kind kind;
    } forms[] = {{"step", DEA_WAVE_STEP}, {"points", DEA_WAVE_POINTS}, {"sine", DEA_WAVE_SINE}, {"file", DEA_WAVE_POINTS}};
    const dea_node *form = NULL;
    for (const dea_node *child = node->kind == DEA_NODE_MAPPING ? node->first : NULL; child; child = child->next) {
        for (size_t i = 0; i < sizeof forms / sizeof *forms; i++) {
            if (strcmp(child->key, forms[i].key) != 0) {
                continue;
            }
            if (form) {
                return dea_place_fail(&child->key_at, reader->error, ref->path, "gives both %s and %s; give one of them",
                                      form->key, child->key);
            }
            form = child;
            reader->scene->drive.waveform.kind = forms[i].kind;
        }
    }
    const dea_status status = dea_read_mapping(reader, ref, node);
    return status || form ? status : dea_reader_refuse(reader, ref, node, "says no voltage");
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
    const double none = (double)NAN;
    free(scene->drive.waveform.times);
    free(scene->drive.waveform.voltages);
    scene->drive.waveform =
        (dea_waveform){.step = {none, none, none, none}, .sine = {none, none, none, none, none}, .period = none};
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

/* Edges may touch, which makes a corner, but two jumps at one time are none. */
static bool apart(double gap, double rise)
{
    return gap >= DEA_EDGE_MIN || (gap == 0.0 && rise > 0.0);
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

static dea_status step_finish(dea_reader *reader)
{
    const dea_scene *scene = reader->scene;
    dea_step *step = &reader->scene->drive.waveform.step;
    if (isnan(step->on) || isnan(step->voltage)) {
        return dea_reader_missing(reader, "drive.waveform.step",
                                  isnan(step->on) ? "drive.waveform.step.on" : "drive.waveform.step.voltage");
    }
    step->rise = isnan(step->rise) ? 1e-6 : step->rise;
    const span rise = span_of(scene, AT(step.rise));
    if (!(rise.low == 0.0 || rise.low >= DEA_EDGE_MIN)) {
        return fail_at(reader, AT(step.rise), "drive.waveform.step.rise", "two edges closer than 1e-12 s",
                       "0 s, which is a jump, or at least 1e-12 s");
    }
    const double gap = span_of(scene, AT(step.off)).low - (span_of(scene, AT(step.on)).high + rise.high);
    if (isnan(step->off) || apart(gap, rise.high)) {
        return DEA_OK;
    }
    return fail_at(reader, AT(step.off), "drive.waveform.step.off", gap < 0.0 ? "out of range" : "two edges closer than 1e-12 s",
                   "a time >= on + rise, where rise is 1 us unless given");
}

static dea_status sine_finish(dea_reader *reader)
{
    dea_sine *sine = &reader->scene->drive.waveform.sine;
    if (isnan(sine->amplitude) || isnan(sine->frequency)) {
        return dea_reader_missing(reader, "drive.waveform.sine",
                                  isnan(sine->amplitude) ? "drive.waveform.sine.amplitude" : "drive.waveform.sine.frequency");
    }
    sine->offset = isnan(sine->offset) ? 0.0 : sine->offset;
    sine->phase = isnan(sine->phase) ? 0.0 : sine->phase;
    sine->delay = isnan(sine->delay) ? 0.0 : sine->delay;
    if (isnan(reader->scene->drive.waveform.period)) {
        return DEA_OK;
    }
    return fail_at(reader, AT(period), "drive.waveform.period", "contradicts sine, which has its frequency",
                   "period with step, points or file");
}

/* What repeats has come to its end before, and its next edge keeps its distance. */
static dea_status period_finish(dea_reader *reader)
{
    const dea_scene *scene = reader->scene;
    const dea_waveform *waveform = &scene->drive.waveform;
    const bool step = waveform->kind == DEA_WAVE_STEP;
    if (isnan(waveform->period)) {
        return DEA_OK;
    }
    if (step && isnan(waveform->step.off)) {
        return dea_place_fail(dea_reader_place(reader, AT(period), "drive.waveform"), reader->error, "drive.waveform.step.off",
                              "missing; a step with a period goes off again; accepted: a time >= on + rise, e.g. 15 s");
    }
    const double period = span_of(scene, AT(period)).low;
    const span rise = span_of(scene, AT(step.rise));
    const double end = step ? span_of(scene, AT(step.off)).high + rise.high : waveform->times[waveform->point_count - 1];
    const double next = step ? span_of(scene, AT(step.on)).low : 0.0;
    const bool fits = period >= end && period >= DEA_EDGE_MIN && apart(period - end + next, step ? rise.high : 1.0);
    return fits
               ? DEA_OK
               : fail_at(reader, AT(period), "drive.waveform.period",
                         period < end ? "out of range" : "two edges closer than 1e-12 s",
                         step ? "a time >= off + rise, where rise is 1 us unless given" : "at least the last time of the points");
}

dea_status dea_waveform_finish(dea_reader *reader)
{
    const dea_wave_kind kind = reader->scene->drive.waveform.kind;
    if (kind == DEA_WAVE_NONE) {
        return DEA_OK;
    }
    if (kind == DEA_WAVE_SINE) {
        return sine_finish(reader);
    }
    const dea_status status = kind == DEA_WAVE_STEP ? step_finish(reader) : DEA_OK;
    return status ? status : period_finish(reader);
}
