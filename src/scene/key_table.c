/* The keys of a scene, in the order in which messages list them. */
#include <math.h>
#include <string.h>

#include "drive/wave.h"
#include "scene/key_forms.h"
#include "study/study.h"

#define LAYERS(name, member, shown, mapping)                                                                                     \
    {                                                                                                                            \
        .path = name, .read = dea_read_scalar, .offset = AT(member), .unit = "1", .suffix = "", .low = 1, .high = 1e6,           \
        .whole = true, .kinds = DEA_KEY_BOTH, .words = shown, .within = mapping, .accepted = "a whole number >= 1, e.g. 5"       \
    }

static const dea_key keys_before[] = {
    OTHER("title", dea_read_title, "one line of text, at most 1000 bytes"),
    OTHER("actuator", dea_read_mapping, "a mapping with kind, frame_radius, coverage, ..."),
    OTHER("actuator.kind", dea_read_kind, "dot, lens"),
    SCALAR("actuator.frame_radius", actuator.frame_radius, "m", "_m", 0, INFINITY, true, DEA_KEY_BOTH, 1,
           "a length > 0, e.g. 30 mm"),
    SCALAR("actuator.coverage", actuator.coverage, "1", "", 0, 1, true, DEA_KEY_BOTH, 1, "a ratio > 0 and < 1, e.g. 0.5"),
    SCALAR("actuator.electrode_radius", actuator.divide_radius, "m", "_m", 0, INFINITY, true, DEA_KEY_DOT, 1,
           "a length > 0 and < frame_radius, e.g. 15 mm"),
    SCALAR("actuator.lens_radius", actuator.divide_radius, "m", "_m", 0, INFINITY, true, DEA_KEY_LENS, 1,
           "a length > 0 and < frame_radius, e.g. 15 mm"),
    SCALAR("actuator.film_thickness", actuator.film_thickness, "m", "_m", 0, INFINITY, true, DEA_KEY_BOTH, 1,
           "a length > 0, e.g. 100 um"),
    LAYERS("actuator.layers", actuator.layers, 1, NULL),
    SCALAR("actuator.prestretch", actuator.prestretch, "1", "", 1, INFINITY, false, DEA_KEY_BOTH, 1, "a stretch >= 1, e.g. 1.2"),
    SCALAR("actuator.electrode_mass", actuator.electrode_mass, "kg/m^2", "_kg_per_m2", 0, INFINITY, false, DEA_KEY_BOTH, 1,
           "a mass per area >= 0, e.g. 25 g/m^2"),
    OTHER("actuator.optics", dea_read_mapping, "a mapping with focal_length and refractive_index (lens only)"),
    SCALAR("actuator.optics.focal_length", actuator.focal_length, "m", "_m", 0, INFINITY, true, DEA_KEY_LENS, 1,
           "a length > 0, e.g. 22 mm"),
    SCALAR("actuator.optics.refractive_index", actuator.refractive_index, "1", "", 1, INFINITY, true, DEA_KEY_LENS, 1,
           "a number > 1, e.g. 1.4"),
    OTHER("material", dea_read_material, "a built-in name, the path of a material file, or a mapping"),
    OTHER("material.base", dea_read_later, "a built-in name or the path of a material file"),
    OTHER("material.source", dea_read_source, "one line of text, at most 255 bytes"),
    OTHER("material.stretches", dea_read_stretches, "the stretches that the data cover, e.g. [1, 2]"),
};

/* Here stand the keys of the laws, one mapping or list each with its constants. */

static const dea_key keys_behind[] = {
    {.path = "material.permittivity",
     .read = dea_read_permittivity,
     .offset = AT(material.permittivity),
     .unit = "1",
     .suffix = "",
     .low = 0,
     .high = INFINITY,
     .open = true,
     .kinds = DEA_KEY_BOTH,
     .words = 1,
     .accepted = "a relative permittivity > 0, e.g. 2.8, or {constant: 2.76, per_stretch: -0.28, follows: strain}"},
    SCALAR("material.permittivity.constant", material.permittivity, "1", "", 0, INFINITY, true, DEA_KEY_BOTH, 2,
           "a relative permittivity > 0, e.g. 2.76"),
    SCALAR("material.permittivity.per_stretch", material.permittivity_per_stretch, "1", "", -INFINITY, INFINITY, true,
           DEA_KEY_BOTH, 2, "a number, e.g. -0.28"),
    CHOICE("material.permittivity.follows", material.permittivity_follows, "prestretch", "strain"),
    SCALAR("material.density", material.density, "kg/m^3", "_kg_per_m3", 0, INFINITY, true, DEA_KEY_BOTH, 1,
           "a density > 0, e.g. 1080 kg/m^3"),
    OTHER("material.prony", dea_read_prony, "a list of at most 64 branches, e.g. [{g: 0.2, tau: 0.5 s}]"),
    OTHER("material.prony.#", dea_read_mapping, "a branch, e.g. {g: 0.2, tau: 0.5 s}"),
    ENTRY("material.prony.#.g", material.prony, g, "1", "", 0, 1, true, 3, "a share > 0 and < 1, e.g. 0.2"),
    ENTRY("material.prony.#.tau", material.prony, tau, "s", "_s", 0, INFINITY, true, 3, "a time > 0, e.g. 0.5 s"),
    CHOICE("material.moduli", material.instantaneous, "long-term", "instantaneous"),
    SCALAR("material.retardation", material.retardation, "s", "_s", 0, INFINITY, true, DEA_KEY_BOTH, 1, "a time > 0, e.g. 1 ms"),
    SCALAR("material.modulus", material.modulus, "Pa", "_Pa", 0, INFINITY, true, DEA_KEY_BOTH, 1, "a modulus > 0, e.g. 1.2 MPa"),
    SCALAR("material.breakdown", material.breakdown, "V/m", "_V_per_m", 0, INFINITY, true, DEA_KEY_BOTH, 1,
           "a field > 0, e.g. 80 V/um"),
    OTHER("material.shift", dea_read_shift,
          "{wlf: {C1: 17.4, C2: 51.6 K, reference: 20 degC}}, or temperatures and factors, e.g. [[20 degC, 1], [40 degC, 0.1]]"),
    OTHER("material.shift.wlf", dea_read_mapping, "a mapping with C1, C2 and reference, e.g. {C1: 17.4, C2: 51.6 K, reference: 20 degC}"),
    PART("material.shift.wlf.C1", material.shift.c1, "1", "", 0, INFINITY, true, 2, "material.shift.wlf", "a number > 0, e.g. 17.4"),
    PART("material.shift.wlf.C2", material.shift.c2, "kelvin", "_K", 0, 1e4, true, 2, "material.shift.wlf",
         "a difference of temperatures > 0, e.g. 51.6 K"),
    PART("material.shift.wlf.reference", material.shift.reference, "K", "_K", 0, 1e4, true, 2, "material.shift.wlf",
         "a temperature above 0 and below 10,000 K, e.g. 20 degC"),
    OTHER("material.modulus_slope", dea_read_mapping, "a mapping with per_kelvin and reference, e.g. {per_kelvin: 0.2 %/K, reference: 20 degC}"),
    SCALAR("material.modulus_slope.per_kelvin", material.modulus_slope, "kelvin-1", "_per_K", -INFINITY, INFINITY, true, DEA_KEY_BOTH, 2,
           "a relative change per temperature, e.g. 0.2 %/K"),
    SCALAR("material.modulus_slope.reference", material.modulus_reference, "K", "_K", 0, 1e4, true, DEA_KEY_BOTH, 2,
           "a temperature above 0 and below 10,000 K, e.g. 20 degC"),
    SCALAR("temperature", material.temperature, "K", "_K", 0, 1e4, true, DEA_KEY_BOTH, 1, "a temperature above 0 and below 10,000 K, e.g. 40 degC"),
    OTHER("electrode", dea_read_electrode, "a mapping with thickness, a law, density and sheet_resistance, e.g. {thickness: 25 um, neo_hookean: {mu: 20 kPa}}"),
    PART("electrode.thickness", electrode.thickness, "m", "_m", 0, INFINITY, true, 2, "electrode", "a length > 0, e.g. 25 um"),
    PART("electrode.density", electrode.density, "kg/m^3", "_kg_per_m3", 0, INFINITY, true, 2, "electrode",
         "a density > 0, e.g. 1010 kg/m^3"),
    PART("electrode.sheet_resistance", electrode.sheet_resistance, "ohm", "_Ohm", 0, INFINITY, true, 2, "electrode",
         "a resistance per square > 0, e.g. 10 kOhm"),
    OTHER("load", dea_read_mapping, "a mapping of what is fixed to the edge, e.g. {mass: 2 g, stiffness: 20 N/m}"),
};

/* Here stand the keys of the loads, a number each. */

static const dea_key keys_beside[] = {
    OTHER("antagonist", dea_read_antagonist, "a mapping with actuator, material and drive, e.g. {actuator: {kind: lens}, drive: {voltage: 3 kV}}"),
    OTHER("antagonist.actuator", dea_read_mapping, "a mapping with kind, film_thickness, layers and prestretch, e.g. {kind: lens}"),
    OTHER("antagonist.actuator.kind", dea_read_antagonist_kind, "dot, lens"),
    PART("antagonist.actuator.frame_radius", antagonist.frame_radius, "m", "_m", 0, INFINITY, true, 0, "antagonist", "that of the first film"),
    PART("antagonist.actuator.coverage", antagonist.coverage, "1", "", 0, 1, true, 0, "antagonist", "that of the first film"),
    PART("antagonist.actuator.film_thickness", antagonist.film_thickness, "m", "_m", 0, INFINITY, true, 3, "antagonist",
         "a length > 0, e.g. 100 um"),
    LAYERS("antagonist.actuator.layers", antagonist.layers, 3, "antagonist"),
    PART("antagonist.actuator.prestretch", antagonist.prestretch, "1", "", 1, INFINITY, false, 3, "antagonist", "a stretch >= 1, e.g. 1.2"),
    OTHER("antagonist.material", dea_read_antagonist_material, "a built-in name, the path of a material file, or a mapping"),
    OTHER("antagonist.drive", dea_read_mapping, "a mapping with voltage, e.g. {voltage: 3 kV}"),
    PART("antagonist.drive.voltage", antagonist.voltage, "V", "_V", -INFINITY, INFINITY, true, 3, "antagonist", "a voltage, e.g. 3 kV"),
    OTHER("drive", dea_read_mapping, "a mapping with voltage or waveform, ..."),
    {.path = "drive.voltage",
     .read = dea_read_scalar,
     .offset = AT(drive.voltage),
     .unit = "V",
     .suffix = "_V",
     .low = -INFINITY,
     .high = INFINITY,
     .open = true,
     .kinds = DEA_KEY_BOTH,
     .words = 1,
     .instead = "drive.waveform",
     .accepted = "a voltage, e.g. 4500 V"},
    SCALAR("drive.series_resistance", drive.series_resistance, "ohm", "_Ohm", 0, INFINITY, false, DEA_KEY_BOTH, 1,
           "a resistance >= 0, e.g. 1 MOhm"),
    SCALAR("drive.leakage_resistance", drive.leakage_resistance, "ohm", "_Ohm", 0, INFINITY, true, DEA_KEY_BOTH, 1,
           "a resistance > 0, e.g. 100 GOhm"),
    SCALAR("drive.current_limit", drive.current_limit, "A", "_A", 0, INFINITY, true, DEA_KEY_BOTH, 1, "a current > 0, e.g. 100 uA"),
    OTHER("drive.waveform", dea_read_waveform, "a mapping with step, points, sine, pulse, square, triangle, chirp, burst, sines or file"),
};

/* Here stand the keys of the forms of a waveform. */

static const dea_key keys_further[] = {
    OTHER("drive.waveform.file", dea_read_wave_file, "the name of a table with columns of time and voltage"),
    PART("drive.waveform.period", drive.waveform.period, "s", "_s", 0, INFINITY, true, 1, "drive.waveform",
         "a time, at least the last one of the waveform, e.g. 20 s"),
    OTHER("model", dea_read_model, "a model name or a list of them"),
    SCALAR("model_error", model_error, "1", "", 0, 1, true, DEA_KEY_BOTH, 0, "a relative error > 0 and < 1, e.g. 1 %"),
    OTHER("engine", dea_read_engine, "auto, an engine, or a list of engines in the order in which they are asked"),
#define X(code, name) #name ", "
    OTHER("study", dea_read_mapping, "a mapping with " DEA_STUDY_LIST(X) "e.g. {sweep: {}} for the scene as one point"),
#undef X
};

/* Here stand the keys of the kinds of study. */

static const dea_key keys_last[] = {
    OTHER("study.over", dea_read_later, "a mapping of axes, e.g. {coverage: [0.25, 0.5]}"),
    SCALAR("accuracy", accuracy, "1", "", 0, 1, true, DEA_KEY_BOTH, 0, "a relative error > 0 and < 1, e.g. 1e-6"),
};

#define COUNT(keys) (sizeof keys / sizeof *keys)

/* What holds constants of a law. */
typedef struct holder {
    const char *name;
    size_t offset;      /* of the constants */
    const char *within; /* as of a key */
} holder;

static const holder holders[] = {{"material", AT(material.constants), NULL}, {"electrode", AT(electrode.constants), "electrode"}};
enum { HOLDERS = sizeof holders / sizeof *holders };

/* Key number @p index of a law: its mapping or list, what an entry of a list is, and its constants; false past the end. */
static bool law_key(const holder *of, const dea_law *law, size_t index, dea_key *key)
{
    const bool list = law->entries > 1;
    *key = (dea_key){.offset = DEA_KEY_NOWHERE, .kinds = DEA_KEY_BOTH, .accepted = law->accepted, .law = law, .within = of->within};
    if (index <= list) {
        snprintf(key->path, sizeof key->path, index ? "%s.%s.#" : "%s.%s", of->name, law->name);
        key->read = index ? dea_read_mapping : dea_read_law;
        return true;
    }
    index -= 1 + list;
    if (index >= law->constant_count) {
        return false;
    }
    const dea_constant *constant = &law->constants[index];
    snprintf(key->path, sizeof key->path, list ? "%s.%s.#.%s" : "%s.%s.%s", of->name, law->name, constant->name);
    key->read = dea_read_scalar;
    key->offset = of->offset + index * sizeof(double);
    key->stride = list ? law->constant_count * sizeof(double) : 0;
    key->unit = constant->unit;
    key->suffix = constant->modulus ? "_Pa" : "";
    key->low = constant->low;
    key->high = INFINITY;
    key->open = true;
    key->words = list ? 3 : of->within ? 2 : 1;
    key->accepted = constant->accepted;
    return true;
}

static void load_key(size_t index, dea_key *key)
{
    const dea_load_kind *kind = dea_load_at(index);
    *key = (dea_key){.read = dea_read_scalar, .offset = AT(loads[0].number) + index * sizeof(dea_edge_load), .unit = kind->unit,
                     .suffix = kind->suffix, .low = kind->low, .high = kind->high, .open = true, .kinds = DEA_KEY_BOTH, .words = 2,
                     .within = "load", .accepted = kind->accepted};
    snprintf(key->path, sizeof key->path, "load.%s", kind->name);
}

/* Key number *@p index of some keys; where there are fewer, it becomes the number in those that follow. */
static bool listed_key(const dea_key *keys, size_t count, size_t *index, dea_key *key)
{
    const bool found = *index < count;
    if (found) {
        *key = keys[*index];
    } else {
        *index -= count;
    }
    return found;
}

/* Ending of a result column of that unit. */
static const char *suffix_of(const char *unit)
{
    static const char *const suffixes[][2] = {{"V", "_V"}, {"s", "_s"}, {"Hz", "_Hz"}, {"rad", "_rad"}};
    for (size_t i = 0; i < sizeof suffixes / sizeof *suffixes; i++) {
        if (strcmp(suffixes[i][0], unit) == 0) {
            return suffixes[i][1];
        }
    }
    return "";
}

static size_t wave_keys(const dea_wave *wave)
{
    return 1u + (wave->stride > 0 ? 1u : 0u) + wave->number_count + (wave->word ? 1u : 0u);
}

/* Key number @p index of a waveform: its mapping or list, what an entry of a list is, its numbers, its word. */
static void wave_key(const dea_wave *wave, size_t index, dea_key *key)
{
    const bool list = wave->stride > 0;
    *key = (dea_key){.offset = DEA_KEY_NOWHERE, .kinds = DEA_KEY_BOTH, .accepted = wave->accepted};
    if (index <= list) {
        snprintf(key->path, sizeof key->path, index ? "%s.#" : "%s", wave->path);
        key->read = wave->number_count == 0 ? dea_read_points : list && index == 0 ? dea_read_sines : dea_read_mapping;
        return;
    }
    index -= 1 + list;
    if (index == wave->number_count) {
        snprintf(key->path, sizeof key->path, "%s.%s", wave->path, wave->word);
        key->read = dea_read_wave_word;
        key->accepted = wave->choices;
        return;
    }
    const dea_wave_number *number = &wave->numbers[index];
    snprintf(key->path, sizeof key->path, list ? "%s.#.%s" : "%s.%s", wave->path, number->name);
    key->read = dea_read_scalar;
    key->offset = AT(drive.waveform) + number->offset;
    key->stride = wave->stride;
    key->unit = number->unit;
    key->suffix = suffix_of(number->unit);
    key->low = number->low;
    key->high = number->high;
    key->open = number->open;
    key->words = list ? 3 : 2;
    key->within = wave->path;
    key->accepted = number->accepted;
}

bool dea_key_at(size_t index, dea_key *key)
{
    if (listed_key(keys_before, COUNT(keys_before), &index, key)) {
        return true;
    }
    for (size_t i = 0; i < (size_t)HOLDERS * dea_law_count(); i++) {
        const dea_law *law = dea_law_at(i % dea_law_count());
        const size_t count = law->constant_count + (law->entries > 1 ? 2 : 1);
        if (index < count) {
            return law_key(&holders[i / dea_law_count()], law, index, key);
        }
        index -= count;
    }
    if (listed_key(keys_behind, COUNT(keys_behind), &index, key)) {
        return true;
    }
    if (index < dea_load_count()) {
        load_key(index, key);
        return true;
    }
    index -= dea_load_count();
    if (listed_key(keys_beside, COUNT(keys_beside), &index, key)) {
        return true;
    }
    for (dea_wave_kind kind = DEA_WAVE_NONE + 1; dea_wave_of(kind); kind++) {
        const size_t count = wave_keys(dea_wave_of(kind));
        if (index < count) {
            wave_key(dea_wave_of(kind), index, key);
            return true;
        }
        index -= count;
    }
    if (listed_key(keys_further, COUNT(keys_further), &index, key)) {
        return true;
    }
    for (dea_study_kind kind = 0; kind < DEA_STUDIES; kind++) {
        const dea_study *study = dea_study_at(kind);
        if (listed_key(study->keys, study->key_count, &index, key)) {
            return true;
        }
    }
    return listed_key(keys_last, COUNT(keys_last), &index, key);
}
