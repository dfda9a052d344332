/* Reading of axes: those of a sweep, and those over which a transient or an AC study repeats. */
#include <math.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "scene/reader.h"
#include "study/study.h"
#include "support/number.h"

/* Most points of one axis, values of all axes together, and points of a study. */
#ifndef DEA_AXIS_VALUES_MAX
#define DEA_AXIS_VALUES_MAX 100000000
#endif
#define AXIS_POINTS_MAX 1000000000
#define STUDY_POINTS_MAX 1e12

#define AXIS_ACCEPTED "a list of values or {from, to, points}, with spacing: log where wanted"

/* An axis being read. */
typedef struct axis_reader {
    dea_reader *reader;
    dea_ref ref;
    dea_axis *axis;
    const dea_node *node;
} axis_reader;

static dea_status axis_fail(const axis_reader *self, const dea_node *node, const char *what, const char *accepted)
{
    char subject[2 * DEA_NAME_LENGTH];
    char shown[DEA_TEXT_ROOM];
    snprintf(subject, sizeof subject, "%s.%s", self->reader->axes, self->ref.path);
    dea_reader_show(node, shown);
    return dea_place_fail(&node->place, self->reader->error, subject, "%s (%s); accepted: %s", what, shown, accepted);
}

static dea_status values_new(const axis_reader *self, size_t count)
{
    const dea_scene *scene = self->reader->scene;
    size_t total = count;
    for (size_t i = 0; i < scene->axis_count; i++) {
        total += scene->axes[i].count;
    }
    if (total > DEA_AXIS_VALUES_MAX) {
        return axis_fail(self, self->node, "too many points", "100000000 values on all axes together");
    }
    self->axis->values = malloc(count * sizeof *self->axis->values);
    if (!self->axis->values) {
        return dea_reader_memory(self->reader);
    }
    self->axis->count = count;
    return DEA_OK;
}

static dea_status list_read(const axis_reader *self)
{
    if (self->node->count == 0) {
        return axis_fail(self, self->node, "an axis without a value", AXIS_ACCEPTED);
    }
    dea_status status = values_new(self, self->node->count);
    size_t i = 0;
    for (const dea_node *value = self->node->first; value && !status; value = value->next) {
        status = dea_reader_number(self->reader, &self->ref, value, &self->axis->values[i++]);
    }
    return status;
}

/* Both ends as whole numbers over one power of ten; false where that is not to be had, or the values between them would not be
 * exact before their one division: (from (n - i) + to i)/(n power), all below 2^53. */
static bool ends_decimal(double steps, double *from, double *to, double *power)
{
    double first, last;
    *power = fmax(dea_number_power(*from, &first), dea_number_power(*to, &last));
    if (!(*power > 0.0 && dea_number_over(*from, *power, &first) && dea_number_over(*to, *power, &last))) {
        return false;
    }
    *from = first;
    *to = last;
    return fmax(fabs(first), fabs(last)) * steps <= 0x1p53 && *power * steps <= 0x1p53;
}

/* values[i] = from + (to - from) i/(count - 1), the double nearest to it where the ends are decimals of some length, or
 * from (to/from)^(i/(count - 1)); the ends are exact. */
static void values_space(dea_axis *axis, double from, double to, bool logarithmic)
{
    const double steps = axis->count > 1 ? (double)(axis->count - 1) : 1.0;
    double first = from, last = to, power;
    const bool decimal = ends_decimal(steps, &first, &last, &power);
    for (size_t i = 0; i < axis->count; i++) {
        const double at = (double)i;
        axis->values[i] = logarithmic ? from * pow(to / from, at / steps)
                          : decimal   ? (first * (steps - at) + last * at) / (steps * power)
                                      : from + (to - from) * at / steps;
    }
    axis->values[axis->count - 1] = axis->count > 1 ? to : from;
    axis->uniform = !logarithmic && axis->count > 1;
}

static dea_status keys_check(const axis_reader *self)
{
    char shown[DEA_TEXT_ROOM];
    char subject[DEA_TEXT_ROOM + 2 * DEA_NAME_LENGTH];
    for (const dea_node *child = self->node->first; child; child = child->next) {
        const char *key = child->key;
        if (strcmp(key, "from") != 0 && strcmp(key, "to") != 0 && strcmp(key, "points") != 0 && strcmp(key, "spacing") != 0) {
            snprintf(subject, sizeof subject, "%s.%s.%s", self->reader->axes, self->ref.path,
                     dea_text_clip(key, DEA_TEXT_SHOWN, shown, sizeof shown));
            return dea_place_fail(&child->key_at, self->reader->error, subject,
                                  "unknown key; accepted: from, to, points, spacing");
        }
    }
    return DEA_OK;
}

static dea_status spacing_read(const axis_reader *self, bool *logarithmic)
{
    const dea_node *node = dea_tree_child(self->node, "spacing");
    *logarithmic = node && node->kind == DEA_NODE_SCALAR && strcmp(node->text, "log") == 0;
    if (!node || *logarithmic || (node->kind == DEA_NODE_SCALAR && strcmp(node->text, "linear") == 0)) {
        return DEA_OK;
    }
    return axis_fail(self, node, "unknown spacing", "linear, log");
}

static dea_status points_read(const axis_reader *self, size_t *count)
{
    const dea_node *node = dea_tree_child(self->node, "points");
    if (!node) {
        return axis_fail(self, self->node, "points is missing", AXIS_ACCEPTED);
    }
    if (node->kind != DEA_NODE_SCALAR || !dea_count_read(node->text, AXIS_POINTS_MAX, count)) {
        return axis_fail(self, node, "points is out of range", "a whole number 1 ... 1000000000");
    }
    return DEA_OK;
}

/* Reads from and to; an axis of one point needs no `to`. */
static dea_status ends_read(const axis_reader *self, size_t count, double *from, double *to)
{
    const dea_node *first = dea_tree_child(self->node, "from");
    const dea_node *last = dea_tree_child(self->node, "to");
    if (!first || (!last && count > 1)) {
        return axis_fail(self, self->node, first ? "to is missing" : "from is missing", AXIS_ACCEPTED);
    }
    dea_status status = dea_reader_number(self->reader, &self->ref, first, from);
    *to = *from;
    if (!status && last) {
        status = dea_reader_number(self->reader, &self->ref, last, to);
    }
    if (!status && count == 1 && *from != *to) {
        status = axis_fail(self, last, "one point, but from and to differ", "2 points or more, or `to` left out");
    }
    return status;
}

static dea_status range_read(const axis_reader *self)
{
    size_t count = 0;
    double from = NAN;
    double to = NAN;
    bool logarithmic = false;
    dea_status status = keys_check(self);
    status = status ? status : points_read(self, &count);
    status = status ? status : ends_read(self, count, &from, &to);
    status = status ? status : spacing_read(self, &logarithmic);
    if (!status && logarithmic && !(to / from > 0.0 && isfinite(to / from))) {
        status = axis_fail(self, self->node, "no logarithmic axis", "from and to of the same sign, neither of them 0");
    }
    if (!status && !isfinite(to - from)) {
        status = axis_fail(self, self->node, "from and to are too far apart", "a difference of double precision");
    }
    status = status ? status : values_new(self, count);
    if (!status) {
        values_space(self->axis, from, to, logarithmic);
    }
    return status;
}

/* An axis gives its key as a scalar would. A setting of just this scalar would be lost under an axis of the scene: that is
 * refused. */
static dea_status axis_claim(const axis_reader *self)
{
    dea_reader *reader = self->reader;
    const size_t offset = dea_ref_offset(&self->ref);
    const dea_given *given = dea_reader_given(reader, offset);
    if (given->swept) {
        return dea_place_fail(&self->node->key_at, reader->error, self->ref.path, "is swept twice");
    }
    const bool scalar_set = given->node && given->node->place.origin->setting && !given->node->key;
    if (scalar_set && !self->node->place.origin->setting) {
        char shown[DEA_TEXT_ROOM];
        return dea_place_fail(&given->node->place, reader->error, self->ref.path, "is swept by the scene; set %s.%s=[%s] instead",
                              reader->axes, self->ref.path, dea_reader_show(given->node, shown));
    }
    const bool known = given->node || !isnan(*(double *)((char *)reader->scene + offset));
    const dea_status status = dea_reader_claim(reader, &self->ref, self->node, true);
    if (!status && !known) {
        memcpy((char *)reader->scene + offset, self->axis->values, sizeof(double));
    }
    return status;
}

/* A key is swept where the scene has a place for it. */
static dea_status place_check(const axis_reader *self)
{
    const dea_key *key = &self->ref.key;
    dea_reader *reader = self->reader;
    const char *bias = dea_study_of(reader->scene)->bias;
    if (bias && dea_ref_offset(&self->ref) == offsetof(dea_scene, drive.voltage)) {
        return dea_place_fail(&self->node->key_at, reader->error, self->ref.path,
                              "is not what this study varies; accepted: %s, by its short name bias", bias);
    }
    if (key->law || dea_key_has_place(key, reader->root)) {
        return DEA_OK;
    }
    if (key->within && !dea_tree_find(reader->root, key->within)) {
        return dea_place_fail(&self->node->key_at, reader->error, self->ref.path,
                              "cannot be swept: the scene has no %s; accepted: a scalar of the scene, this one too once %s is there", key->within,
                              key->within);
    }
    return dea_place_fail(&self->node->key_at, reader->error, self->ref.path,
                          "contradicts %s, which is given; accepted: a scalar of that, e.g. drive.waveform.step.voltage",
                          key->instead);
}

/* What a key must be to be swept here. */
static dea_status key_check(const axis_reader *self)
{
    const dea_material *material = &self->reader->scene->material;
    if (self->ref.key.words == 0) {
        return dea_place_fail(&self->node->key_at, self->reader->error, self->ref.path,
                              "cannot be swept; accepted: any scalar, e.g. voltage");
    }
    dea_status status = dea_reader_index(self->reader, &self->ref, &self->node->key_at);
    status = status ? status : place_check(self);
    if (status) {
        return status;
    }
    if (strcmp(self->ref.path, "material.permittivity") == 0 && material->permittivity_per_stretch != 0.0) {
        return dea_place_fail(&self->node->key_at, self->reader->error, self->ref.path,
                              "has a slope here; sweep material.permittivity.constant or material.permittivity.per_stretch");
    }
    return DEA_OK;
}

static void axis_describe(const axis_reader *self)
{
    dea_axis *axis = self->axis;
    snprintf(axis->key, sizeof axis->key, "%s", self->ref.path);
    snprintf(axis->unit, sizeof axis->unit, "%s", self->ref.key.unit);
    dea_ref_column(&self->ref, self->ref.key.words, axis->column);
    axis->offset = dea_ref_offset(&self->ref);
    axis->changes_film = strncmp(axis->key, "material.", 9) == 0 || axis->offset == offsetof(dea_scene, actuator.prestretch) ||
                         axis->offset == offsetof(dea_scene, actuator.layers) || axis->offset == offsetof(dea_scene, material.temperature);
}

static dea_status axis_read(const axis_reader *self)
{
    dea_status status = key_check(self);
    if (!status && self->node->kind == DEA_NODE_SCALAR) {
        status = axis_fail(self, self->node, "not an axis", AXIS_ACCEPTED);
    }
    if (!status) {
        status = self->node->kind == DEA_NODE_SEQUENCE ? list_read(self) : range_read(self);
    }
    if (!status) {
        axis_describe(self);
        status = axis_claim(self);
    }
    return status;
}

static dea_status fail_axis(dea_reader *reader, const dea_node *node)
{
    char shown[DEA_TEXT_ROOM];
    char subject[DEA_TEXT_ROOM + DEA_NAME_LENGTH];
    char help[DEA_KEY_ROOM];
    dea_text_clip(node->key, DEA_TEXT_SHOWN, shown, sizeof shown);
    snprintf(subject, sizeof subject, "%s.%s", reader->axes, shown);
    if (dea_key_ambiguous(node->key, help)) {
        return dea_place_fail(&node->key_at, reader->error, subject, "could mean several keys; accepted: one of %s", help);
    }
    dea_key_suggest_short(node->key, reader->root, "any scalar of the scene, e.g. coverage, prestretch, voltage", help);
    return dea_place_fail(&node->key_at, reader->error, subject, "unknown key%s", help);
}

static dea_status axes_read(dea_reader *reader, const dea_node *axes)
{
    dea_scene *scene = reader->scene;
    scene->axes = calloc(axes->count + 1, sizeof *scene->axes);
    if (!scene->axes) {
        return dea_reader_memory(reader);
    }
    double points = 1.0;
    for (const dea_node *node = axes->first; node; node = node->next) {
        axis_reader self = {.reader = reader, .axis = &scene->axes[scene->axis_count], .node = node};
        if (!dea_key_resolve(node->key, reader->root, &self.ref)) {
            return fail_axis(reader, node);
        }
        const dea_status status = axis_read(&self);
        scene->axis_count++;
        if (status) {
            return status;
        }
        points *= (double)self.axis->count;
        if (points > STUDY_POINTS_MAX || points > (double)(SIZE_MAX / 2 / DEA_SCENE_MODELS)) {
            return dea_place_fail(&node->key_at, reader->error, reader->axes, "more than 1e12 points");
        }
    }
    return DEA_OK;
}

/* The focal length is a column of its own: an axis of it takes more of its path too. */
static bool column_taken(const dea_scene *scene, size_t index)
{
    if (!dea_study_of(scene)->phasors && strcmp(scene->axes[index].column, "focal_length_m") == 0) {
        return true;
    }
    for (size_t i = 0; i < scene->axis_count; i++) {
        if (i != index && strcmp(scene->axes[i].column, scene->axes[index].column) == 0) {
            return true;
        }
    }
    return false;
}

/* Columns that clash take more of their path. */
static void columns_part(dea_scene *scene)
{
    for (size_t i = 0; i < scene->axis_count; i++) {
        dea_ref ref;
        for (size_t words = 1; words < 6 && column_taken(scene, i) && dea_key_find(scene->axes[i].key, &ref); words++) {
            dea_ref_column(&ref, ref.key.words + words, scene->axes[i].column);
        }
    }
}

dea_status dea_reader_axes(dea_reader *reader, const dea_node *axes)
{
    const dea_status status = axes_read(reader, axes);
    columns_part(reader->scene);
    return status;
}
