#include "picture/label.h"

#include "deaspice/model.h"
#include "scene/line.h"
#include "support/number.h"

#include <ctype.h>
#include <math.h>
#include <stddef.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>

/* Units that take a prefix. */
static bool unit_scales(const char *unit)
{
    static const char *const units[] = {"m", "V", "Pa", "N", "s", "Ohm", "ohm", "V/m", "Hz", "F", "A", "C", "J"};
    for (size_t i = 0; i < sizeof units / sizeof *units; i++) {
        if (strcmp(unit, units[i]) == 0) {
            return true;
        }
    }
    return false;
}

/* Longer times are told in the units of clocks and calendars; false where seconds will do. */
static bool scale_time(double largest, const char *unit, dea_scale *scale)
{
    static const struct {
        double from, length; /* [s] */
        const char *name;
    } units[] = {{3.0 * 86400.0, 86400.0, "d"}, {7200.0, 3600.0, "h"}, {300.0, 60.0, "min"}};
    for (size_t i = 0; i < sizeof units / sizeof *units && strcmp(unit, "s") == 0 && isfinite(largest); i++) {
        if (largest >= units[i].from) {
            *scale = (dea_scale){.factor = 1.0 / units[i].length};
            snprintf(scale->unit, sizeof scale->unit, "%s", units[i].name);
            return true;
        }
    }
    return false;
}

dea_scale dea_scale_choose(double largest, const char *unit)
{
    static const char *const prefixes[] = {"p", "n", "µ", "m", "", "k", "M", "G", "T"};
    dea_scale scale = {.factor = 1.0};
    if (strcmp(unit, "1") == 0 || scale_time(largest, unit, &scale)) {
        return scale;
    }
    const char *shown = strcasecmp(unit, "ohm") == 0 ? "Ω" : unit;
    int step = 0;
    if (unit_scales(unit) && isfinite(largest) && largest > 0.0) {
        step = (int)floor(log10(largest * (1.0 + 1e-9)) / 3.0);
        step = step < -4 ? -4 : step > 4 ? 4 : step;
    }
    scale.factor = pow(10.0, -3.0 * step);
    snprintf(scale.unit, sizeof scale.unit, "%s%.16s", prefixes[step + 4], shown);
    return scale;
}

dea_scale dea_scale_axis(const dea_axis *axis)
{
    double largest = 0.0;
    for (size_t i = 0; i < axis->count; i++) {
        largest = fmax(largest, fabs(axis->values[i]));
    }
    return dea_scale_choose(largest, axis->unit);
}

/* The constant of a law that the key names, and "Yeoh constant" for it; NULL: another key. */
static const dea_constant *law_constant(const char *key, char words[DEA_NAME_LENGTH])
{
    const char *last = strrchr(key, '.');
    for (size_t i = 0; dea_law_at(i); i++) {
        const dea_law *law = dea_law_at(i);
        char front[DEA_NAME_LENGTH];
        const int length = snprintf(front, sizeof front, "material.%s.", law->name);
        for (size_t k = 0; k < law->constant_count && strncmp(key, front, (size_t)length) == 0; k++) {
            if (strcmp(last + 1, law->constants[k].name) == 0) {
                const int entry = law->entries > 1 ? atoi(key + length) + 1 : 0;
                snprintf(words, DEA_NAME_LENGTH, entry ? "%s constant of term %d" : "%s constant", law->title, entry);
                return &law->constants[k];
            }
        }
    }
    return NULL;
}

/* Words and symbol of a quantity. */
static void axis_names(const dea_axis *axis, char words[DEA_NAME_LENGTH], const char **symbol)
{
    static const struct {
        const char *key, *words, *symbol;
    } known[] = {
        {"actuator.coverage", "Coverage ratio", "B"},
        {"actuator.prestretch", "Pre-stretch", "λ"},
        {"actuator.frame_radius", "Frame radius", "r"},
        {"actuator.film_thickness", "Film thickness", "H"},
        {"actuator.layers", "Layers", "n"},
        {"drive.voltage", "Voltage", "U"},
        {"antagonist.drive.voltage", "Antagonist voltage", ""},
        {"antagonist.actuator.prestretch", "Antagonist pre-stretch", ""},
        {"antagonist.actuator.film_thickness", "Antagonist film thickness", ""},
        {"antagonist.actuator.layers", "Antagonist layers", ""},
        {"drive.waveform.step.voltage", "Step voltage", "U"},
        {"drive.waveform.sine.offset", "Offset voltage", ""},
        {"drive.waveform.sine.amplitude", "Amplitude", ""},
        {"drive.waveform.sine.frequency", "Frequency", "f"},
        {"drive.waveform.pulse.voltage", "Pulse voltage", "U"},
        {"drive.waveform.pulse.frequency", "Frequency", "f"},
        {"drive.waveform.pulse.duty", "Duty", ""},
        {"drive.waveform.square.frequency", "Frequency", "f"},
        {"drive.waveform.triangle.frequency", "Frequency", "f"},
        {"drive.waveform.burst.frequency", "Frequency", "f"},
        {"study.ac.bias", "Bias voltage", "U"},
        {"study.modes.bias", "Bias voltage", "U"},
        {"material.modulus", "Operating modulus", "Y"},
        {"material.permittivity", "Relative permittivity", "ε"},
    };
    for (size_t i = 0; i < sizeof known / sizeof *known; i++) {
        if (strcmp(axis->key, known[i].key) == 0) {
            snprintf(words, DEA_NAME_LENGTH, "%s", known[i].words);
            *symbol = known[i].symbol;
            return;
        }
    }
    const dea_constant *constant = law_constant(axis->key, words);
    if (constant) {
        *symbol = constant->name;
        return;
    }
    const char *dot = strchr(axis->key, '.');
    snprintf(words, DEA_NAME_LENGTH, "%s", dot ? dot + 1 : axis->key);
    for (char *letter = words; *letter; letter++) {
        *letter = *letter == '_' || *letter == '.' ? ' ' : *letter;
    }
    words[0] = (char)toupper((unsigned char)words[0]);
    *symbol = "";
}

void dea_label_axis(const dea_axis *axis, const dea_scale *scale, char label[DEA_LABEL_LENGTH])
{
    char words[DEA_NAME_LENGTH];
    const char *symbol;
    axis_names(axis, words, &symbol);
    snprintf(label, DEA_LABEL_LENGTH, "%s%s%s%s%s%s", words, *symbol ? " " : "", symbol, *scale->unit ? " [" : "", scale->unit,
             *scale->unit ? "]" : "");
}

void dea_label_value(const dea_axis *axis, const dea_scale *scale, size_t index, char label[DEA_LABEL_LENGTH])
{
    char words[DEA_NAME_LENGTH], number[DEA_NUMBER_LENGTH];
    const char *symbol;
    axis_names(axis, words, &symbol);
    dea_number_text(number, axis->values[index] * scale->factor, 4);
    snprintf(label, DEA_LABEL_LENGTH, "%s = %s%s%s", *symbol ? symbol : words, number, *scale->unit ? " " : "", scale->unit);
}

dea_scale dea_scale_column(const dea_column *column, double largest)
{
    const bool strain = strstr(column->name, "strain") != NULL;
    return strain ? (dea_scale){.factor = 100.0, .unit = "%"} : dea_scale_choose(largest, column->unit);
}

void dea_label_column(const dea_column *column, const dea_scale *scale, char label[DEA_LABEL_LENGTH])
{
    static const struct {
        size_t offset;
        const char *words, *symbol;
    } known[] = {
        {offsetof(dea_row, strain), "Strain", "s"},
        {offsetof(dea_row, displacement), "Displacement", "u"},
        {offsetof(dea_row, force), "Force", "F"},
        {offsetof(dea_row, field), "Field", "E"},
        {offsetof(dea_row, capacitance), "Capacitance", "C"},
        {offsetof(dea_row, charge), "Charge", "Q"},
        {offsetof(dea_row, area_strain), "Area strain", "α"},
        {offsetof(dea_row, focal_length), "Focal length", "f"},
        {offsetof(dea_row, energy), "Energy", "W"},
        {offsetof(dea_row, second_field), "Antagonist field", "E"},
    };
    size_t i = 0;
    while (i + 1 < sizeof known / sizeof *known && known[i].offset != column->offset) {
        i++;
    }
    snprintf(label, DEA_LABEL_LENGTH, "%s %s [%s]", known[i].words, known[i].symbol, scale->unit);
}

void dea_label_run(const dea_scene *scene, size_t number, size_t along, char *label, size_t size)
{
    size_t used = 0;
    *label = '\0';
    if (scene->model_count > 1) {
        used = (size_t)snprintf(label, size, "%s", scene->models[number / dea_scene_point_count(scene)]->name);
    }
    for (size_t i = 0; i < scene->axis_count && used < size; i++) {
        const dea_axis *axis = &scene->axes[i];
        if (i != along && axis->count > 1) {
            char part[DEA_LABEL_LENGTH];
            const dea_scale scale = dea_scale_axis(axis);
            dea_label_value(axis, &scale, dea_axis_index(scene, i, number), part);
            used += (size_t)snprintf(label + used, size - used, "%s%s", used > 0 ? ", " : "", part);
        }
    }
}
