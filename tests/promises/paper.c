/* A scene as the YAML that the program reads. */
#include "draws.h"

#include <math.h>
#include <stdarg.h>
#include <stdio.h>

void put(paper *p, const char *format, ...)
{
    va_list arguments;
    va_start(arguments, format);
    const int length = vsnprintf(p->text + p->used, TEXT - p->used, format, arguments);
    va_end(arguments);
    p->used += length > 0 ? (size_t)length : 0;
}

static void put_given(paper *p, const char *key, double value, const char *unit)
{
    if (!isnan(value)) {
        put(p, "  %s: %.17g %s\n", key, value, unit);
    }
}

/* One law as a mapping of its constants, or a list of such mappings. */
static void put_law(paper *p, const dea_law *law, const double *constants, size_t entries)
{
    put(p, "  %s: %s", law->name, law->entries > 1 ? "[" : "");
    for (size_t entry = 0; entry < entries; entry++) {
        put(p, "%s", entry > 0 ? ", " : "");
        for (size_t i = 0; i < law->constant_count; i++) {
            const dea_constant *constant = &law->constants[i];
            const char *unit = constant->modulus ? " Pa" : "";
            put(p, "%s%s: %.17g%s", i > 0 ? ", " : "{", constant->name, constants[entry * law->constant_count + i], unit);
        }
        put(p, "}");
    }
    put(p, "%s\n", law->entries > 1 ? "]" : "");
}

static void put_electrode(paper *p, const dea_electrode *e)
{
    if (e->law) {
        put(p, "electrode:\n  thickness: %.17g m\n", e->thickness);
        put_law(p, e->law, e->constants, e->entry_count);
        put_given(p, "density", e->density, "kg/m^3");
    }
}

static void put_loads(paper *p, const dea_edge_load *loads)
{
    bool any = false;
    for (size_t i = 0; i < dea_load_count(); i++) {
        if (loads[i].kind && !isnan(loads[i].number)) {
            put(p, "%s", any ? "" : "load:\n");
            put_given(p, loads[i].kind->name, loads[i].number, loads[i].kind->unit);
            any = true;
        }
    }
}

void put_actuator(paper *p, const dea_scene *scene)
{
    const dea_actuator *a = &scene->actuator;
    put_electrode(p, &scene->electrode);
    put_loads(p, scene->loads);
    if (!isnan(scene->material.temperature)) {
        put(p, "temperature: %.17g K\n", scene->material.temperature);
    }
    put(p, "actuator:\n  kind: %s\n", a->kind == DEA_DOT ? "dot" : "lens");
    put(p, "  frame_radius: %.17g m\n  coverage: %.17g\n", a->frame_radius, a->coverage);
    put(p, "  film_thickness: %.17g m\n  prestretch: %.17g\n", a->film_thickness, a->prestretch);
    if (a->layers > 1.0) {
        put(p, "  layers: %g\n", a->layers);
    }
    put_given(p, "electrode_mass", a->electrode_mass, "kg/m^2");
    if (!isnan(a->focal_length)) {
        put(p, "  optics: {focal_length: %.17g m, refractive_index: %.17g}\n", a->focal_length, a->refractive_index);
    }
}

/* What a temperature does to a material. */
static void put_shift(paper *p, const dea_material *m)
{
    const dea_shift *s = &m->shift;
    if (s->count > 0) {
        put(p, "  shift: [");
        for (size_t i = 0; i < s->count; i++) {
            put(p, "%s[%.17g K, %.17g]", i > 0 ? ", " : "", s->table[i][0], s->table[i][1]);
        }
        put(p, "]\n");
    } else if (!isnan(s->c1)) {
        put(p, "  shift: {wlf: {C1: %.17g, C2: %.17g K, reference: %.17g K}}\n", s->c1, s->c2, s->reference);
    }
    if (!isnan(m->modulus_slope)) {
        put(p, "  modulus_slope: {per_kelvin: %.17g K-1, reference: %.17g K}\n", m->modulus_slope, m->modulus_reference);
    }
}

void put_material(paper *p, const dea_material *m)
{
    put(p, "material:\n");
    put_law(p, m->law, m->constants, m->entry_count);
    put(p, "  permittivity: {constant: %.17g, per_stretch: %.17g%s}\n", m->permittivity, m->permittivity_per_stretch,
        m->permittivity_follows ? ", follows: strain" : "");
    put_shift(p, m);
    put_given(p, "density", m->density, "kg/m^3");
    put_given(p, "retardation", m->retardation, "s");
    put_given(p, "modulus", m->modulus, "Pa");
    put_given(p, "breakdown", m->breakdown, "V/m");
    if (m->prony_count > 0) {
        put(p, "  moduli: %s\n  prony:\n", m->instantaneous ? "instantaneous" : "long-term");
    }
    for (size_t i = 0; i < m->prony_count; i++) {
        put(p, "    - {g: %.17g, tau: %.17g s}\n", m->prony[i].g, m->prony[i].tau);
    }
}

static void put_wave(paper *p, const dea_waveform *w)
{
    put(p, "  waveform:\n");
    if (w->kind == DEA_WAVE_STEP) {
        put(p, "    step: {on: %.17g s, voltage: %.17g V, rise: %.17g s", w->step.on, w->step.voltage, w->step.rise);
        if (!isnan(w->step.off)) {
            put(p, ", off: %.17g s", w->step.off);
        }
        put(p, "}\n");
    } else if (w->kind == DEA_WAVE_SINE) {
        put(p, "    sine: {offset: %.17g V, amplitude: %.17g V, frequency: %.17g Hz, phase: %.17g rad, delay: %.17g s}\n",
            w->sine.offset, w->sine.amplitude, w->sine.frequency, w->sine.phase, w->sine.delay);
    } else {
        put(p, "    points:\n");
        for (size_t i = 0; i < w->point_count; i++) {
            put(p, "      - [%.17g s, %.17g V]\n", w->times[i], w->voltages[i]);
        }
    }
    if (!isnan(w->period)) {
        put(p, "    period: %.17g s\n", w->period);
    }
}

void put_drive(paper *p, const dea_scene *scene)
{
    put(p, "drive:\n");
    put_given(p, "series_resistance", scene->drive.series_resistance, "Ohm");
    put_given(p, "leakage_resistance", scene->drive.leakage_resistance, "Ohm");
    if (scene->study == DEA_STUDY_TRANSIENT) {
        put_wave(p, &scene->drive.waveform);
    } else {
        put(p, "  voltage: %.17g V\n", scene->drive.voltage);
    }
}
