/* Random scenes of all studies, written as the YAML that the program reads, so that what is judged is what --dump shows. */
#include "draws.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "../unit/random_transients.h"
#include "scene/reader.h"

enum { SWEEP_POINTS = 6, BRANCHES = 8 };

/* ---- materials and geometry */

/* Constants of a law by the shear modulus and I1 - 3 of a film whose chains are straight. */
typedef void draw_constants(uint64_t *seed, double shear, double straight, dea_material *m);

static void draw_neo_hookean(uint64_t *seed, double shear, double straight, dea_material *m)
{
    (void)seed;
    (void)straight;
    m->constants[0] = shear;
}

static void draw_mooney_rivlin(uint64_t *seed, double shear, double straight, dea_material *m)
{
    const double second = random_between(seed, 0.0, 0.5);
    (void)straight;
    m->constants[0] = 0.5 * shear * (1.0 - second);
    m->constants[1] = 0.5 * shear * second;
}

static void draw_gent(uint64_t *seed, double shear, double straight, dea_material *m)
{
    (void)seed;
    m->constants[0] = shear;
    m->constants[1] = straight;
}

/* Up to three terms, those with another sign than their exponent weak. */
static void draw_ogden(uint64_t *seed, double shear, double straight, dea_material *m)
{
    double sum = 0.0;
    (void)straight;
    m->entry_count = 1 + (size_t)(3.0 * random_unit(seed));
    for (size_t i = 0; i < m->entry_count; i++) {
        const double alpha = random_chance(seed, 0.6) ? random_between(seed, 1.1, 6.0) : random_between(seed, -5.0, -0.5);
        const double sign = i > 0 && random_chance(seed, 0.2) ? -0.1 : 1.0;
        m->constants[2 * i] = sign * random_decades(seed, 0.01, 1.0) / alpha;
        m->constants[2 * i + 1] = alpha;
        sum += m->constants[2 * i] * alpha;
    }
    for (size_t i = 0; i < m->entry_count; i++) {
        m->constants[2 * i] *= 2.0 * shear / sum;
    }
}

static void draw_arruda_boyce(uint64_t *seed, double shear, double straight, dea_material *m)
{
    (void)seed;
    m->constants[0] = shear;
    m->constants[1] = sqrt(1.0 + straight / 3.0);
}

static const struct {
    const char *name;
    draw_constants *draw;
} laws[] = {
    {"neo_hookean", draw_neo_hookean}, {"mooney_rivlin", draw_mooney_rivlin}, {"gent", draw_gent}, {"ogden", draw_ogden},
    {"arruda_boyce", draw_arruda_boyce},
};

/* Another law than Yeoh's of about the same stiffness; chains may be straight soon behind the pre-stretch, where I1 - 3 is @p rest. */
static void draw_law(uint64_t *seed, double shear, double rest, dea_material *m)
{
    const double straight = rest * random_decades(seed, 1.02, 30.0) + random_decades(seed, 0.3, 10.0);
    const size_t chosen = (size_t)((double)(sizeof laws / sizeof *laws) * random_unit(seed));
    m->law = dea_law_find(laws[chosen].name);
    memset(m->constants, 0, sizeof m->constants);
    laws[chosen].draw(seed, shear, straight, m);
}

static void draw_material(uint64_t *seed, double prestretch, dea_material *m)
{
    const double y = prestretch * prestretch, factor = random_decades(seed, 0.1, 30.0);
    random_material(seed, m);
    if (random_chance(seed, 0.2)) {
        *m = *dea_material_builtin((size_t)((double)dea_material_count() * random_unit(seed)));
    } else if (random_chance(seed, 0.7)) {
        draw_law(seed, 2.0 * factor * m->constants[0], 2.0 * y + 1.0 / (y * y) - 3.0, m);
        m->modulus *= factor;
    } else {
        for (size_t i = 0; i < m->law->constant_count; i++) {
            m->constants[i] *= factor;
        }
        m->modulus *= factor;
    }
    if (random_chance(seed, 0.2)) {
        m->breakdown = random_decades(seed, 2e7, 3e8);
    }
}

/* Makes a film neo-Hookean that its material does not hold. */
static void soften(dea_scene *scene)
{
    dea_material *m = &scene->material;
    const double shear = fabs(m->constants[0]);
    m->law = dea_law_find("neo_hookean");
    m->entry_count = 1;
    memset(m->constants, 0, sizeof m->constants);
    m->constants[0] = shear;
}

/* W11 at rest [Pa]. */
double stiffness_of(const dea_scene *scene)
{
    double constants[DEA_LAW_CONSTANTS];
    dea_material_long_term(&scene->material, constants);
    return dea_law_film(scene->material.law, constants, scene->actuator.prestretch).w11;
}

/* First resonance of a film of that frame, roughly [Hz]. */
double pace_of(const dea_scene *scene)
{
    const double wave = sqrt(stiffness_of(scene) / scene->material.density);
    return 0.6 * scene->actuator.prestretch / scene->actuator.frame_radius * wave;
}

/* ---- beside the film */

static void draw_skin(uint64_t *seed, dea_scene *scene)
{
    dea_electrode *e = &scene->electrode;
    const double share = random_decades(seed, 1e-3, 1.0); /* of the film's stiffness */
    e->law = dea_law_find(random_chance(seed, 0.7) ? "neo_hookean" : "yeoh");
    e->entry_count = 1;
    e->thickness = scene->actuator.film_thickness * random_decades(seed, 0.01, 1.0);
    e->constants[0] = share * stiffness_of(scene) * scene->actuator.film_thickness / (8.0 * e->thickness);
    e->constants[1] = e->law == dea_law_find("yeoh") ? 0.1 * e->constants[0] : 0.0;
    e->density = random_chance(seed, 0.5) ? random_between(seed, 900.0, 1500.0) : (double)NAN;
}

static void draw_load(uint64_t *seed, dea_scene *scene)
{
    const dea_actuator *a = &scene->actuator;
    const double thickness = a->layers * a->film_thickness, stiffness = 4.0 * DEA_PI * thickness * stiffness_of(scene);
    const double mass = 1000.0 * DEA_PI * thickness * pow(a->frame_radius / a->prestretch, 2.0);
    if (random_chance(seed, 0.4)) {
        *dea_scene_load(scene, "mass") = mass * random_decades(seed, 1e-3, 10.0);
    }
    if (random_chance(seed, 0.4)) {
        *dea_scene_load(scene, "stiffness") = stiffness * random_decades(seed, 1e-3, 10.0);
    }
    if (random_chance(seed, 0.4)) {
        *dea_scene_load(scene, "damping") = sqrt(stiffness * mass) * random_decades(seed, 1e-3, 1.0);
    }
    if (random_chance(seed, 0.4)) {
        const double room = fmin(a->coverage, 1.0 - a->coverage) * a->frame_radius; /* of the edge */
        *dea_scene_load(scene, "force") = stiffness * room * random_between(seed, -0.15, 0.15);
    }
}

/* 10 K and more above and below the temperature of the data. */
static void draw_temperature(uint64_t *seed, dea_material *m)
{
    const double reference = random_between(seed, 270.0, 320.0), rise = random_between(seed, -30.0, 60.0);
    const bool stiffens = random_chance(seed, 0.5), shifts = random_chance(seed, 0.5);
    m->temperature = reference + rise;
    m->shift.count = 0; /* a table drawn before need not reach there */
    if (stiffens || !shifts) {
        m->modulus_slope = random_between(seed, -2e-3, 4e-3);
        m->modulus_reference = reference;
    }
    if (shifts && random_chance(seed, 0.6)) {
        m->shift.c1 = random_between(seed, 2.0, 18.0);
        m->shift.c2 = random_between(seed, 50.0, 200.0);
        m->shift.reference = reference;
    } else if (shifts) {
        m->shift.count = 3;
        for (int i = 0; i < 3; i++) {
            m->shift.table[i][0] = reference + 60.0 * (i - 1);
            m->shift.table[i][1] = pow(random_between(seed, 5.0, 30.0), 1 - i);
        }
    }
}

void draw_beside(uint64_t seed, double share, dea_scene *scene)
{
    dea_material *m = &scene->material;
    uint64_t own = seed ^ UINT64_C(0x5851F42D4C957F2D);
    if (random_chance(&own, share)) {
        scene->actuator.layers = 1.0 + (double)(int)random_decades(&own, 1.0, 20.0);
    }
    if (random_chance(&own, share)) {
        draw_skin(&own, scene);
    }
    if (random_chance(&own, share)) {
        draw_load(&own, scene);
    }
    if (random_chance(&own, share)) {
        m->permittivity_follows = true;
        m->permittivity_per_stretch = m->permittivity_per_stretch == 0.0 ? random_between(&own, -0.1, 0.1) * m->permittivity
                                                                         : m->permittivity_per_stretch;
    }
    if (random_chance(&own, share)) {
        draw_temperature(&own, m);
    }
}

void draw_film(uint64_t *seed, dea_scene *scene)
{
    dea_actuator *a = &scene->actuator;
    *scene = random_scene(seed);
    dea_scene_unload(scene);
    a->prestretch = random_chance(seed, 0.6) ? random_between(seed, 1.05, 1.6) : random_between(seed, 1.6, 4.0);
    draw_material(seed, a->prestretch, &scene->material);
    a->coverage = random_chance(seed, 0.3)
                      ? (random_chance(seed, 0.5) ? random_between(seed, 0.02, 0.1) : random_between(seed, 0.9, 0.98))
                      : random_between(seed, 0.1, 0.9);
    a->film_thickness = random_decades(seed, 1e-6, 1e-3);
    a->frame_radius = random_decades(seed, 1e-3, 0.1);
    if (!(stiffness_of(scene) > 0.0)) {
        soften(scene);
    }
    draw_beside(*seed, 0.1, scene);
}

/* Voltage at which a film pulls in, or one that strains it well. */
double limit_voltage(dea_scene *scene, const char *model)
{
    for (int i = 0; i < 2; i++) {
        const double most =
            scene->actuator.film_thickness * sqrt(stiffness_of(scene) / DEA_EPSILON_0) / scene->actuator.prestretch;
        const double voltage = pull_in_below(scene, model, most);
        if (static_strain(scene, model, 1e-3 * voltage) != 1.0) {
            return voltage;
        }
        soften(scene);
    }
    return 0.0;
}

static int by_size(const void *a, const void *b)
{
    const double x = *(const double *)a, y = *(const double *)b;
    return (x > y) - (x < y);
}

/* ---- static sweeps: along the voltage up to and past pull-in, along coverage or pre-stretch below it */

static void put_axis(paper *p, uint64_t *seed, const char *key, const char *unit, double low, double high)
{
    double values[SWEEP_POINTS];
    for (int i = 0; i < SWEEP_POINTS; i++) {
        values[i] = random_between(seed, low, high);
    }
    qsort(values, SWEEP_POINTS, sizeof *values, by_size);
    put(p, "study:\n  sweep:\n    %s: [", key);
    for (int i = 0; i < SWEEP_POINTS; i++) {
        put(p, "%s%.17g%s%s", i > 0 ? ", " : "", values[i], unit[0] ? " " : "", unit);
    }
    put(p, "]\n");
}

static void draw_sweep(uint64_t *seed, paper *p)
{
    dea_scene scene;
    draw_film(seed, &scene);
    const dea_model *model = dea_model_at((size_t)((double)dea_model_count() * random_unit(seed)));
    scene.actuator.kind = model->lens ? scene.actuator.kind : DEA_DOT;
    if (!model->edge) {
        *dea_scene_load(&scene, "stiffness") = *dea_scene_load(&scene, "force") = (double)NAN;
    }
    *dea_scene_load(&scene, "mass") = *dea_scene_load(&scene, "damping") = (double)NAN; /* at rest they do nothing */
    const double limit = limit_voltage(&scene, model->name), kind = random_unit(seed);
    const double share = scene.drive.leakage_resistance / (scene.drive.leakage_resistance + scene.drive.series_resistance);
    const double source = limit / (isnan(share) ? 1.0 : share);
    scene.drive.voltage = source * random_between(seed, 0.1, 0.9);
    put_actuator(p, &scene);
    put_material(p, &scene.material);
    put_drive(p, &scene);
    put(p, "model: %s\n", model->name);
    if (kind < 0.6) {
        put_axis(p, seed, "voltage", "V", 0.02 * source, (random_chance(seed, 0.4) ? 1.3 : 0.95) * source);
    } else if (kind < 0.8) {
        put_axis(p, seed, "coverage", "", 0.02, 0.98);
    } else {
        put_axis(p, seed, "prestretch", "", 1.05, fmin(4.0, 1.5 * scene.actuator.prestretch));
    }
}

/* ---- motion */

void draw_motion(uint64_t *seed, dea_scene *scene, double until)
{
    dea_material *m = &scene->material;
    m->prony_count = random_chance(seed, 0.4) ? 0 : 1 + (size_t)(BRANCHES * random_unit(seed));
    m->instantaneous = random_chance(seed, 0.3);
    for (size_t i = 0; i < m->prony_count; i++) {
        m->prony[i].g = random_between(seed, 0.05, 0.8) / (double)m->prony_count;
        m->prony[i].tau = random_chance(seed, 0.5) ? random_decades(seed, 1e-6, 2e5) : until * random_decades(seed, 1e-4, 1e2);
    }
    m->retardation = random_chance(seed, 0.4) ? until * random_decades(seed, 1e-5, 1e-1) : (double)NAN;
}

void draw_ports(uint64_t *seed, dea_scene *scene, double time)
{
    const dea_actuator *a = &scene->actuator;
    const double capacitance = 1e-10 * pow(a->frame_radius * a->prestretch, 2.0) / a->film_thickness;
    scene->drive.series_resistance = scene->drive.leakage_resistance = (double)NAN;
    if (random_chance(seed, 0.35)) {
        scene->drive.series_resistance = time * random_decades(seed, 1e-5, 1.0) / capacitance;
    }
    if (random_chance(seed, 0.25)) {
        scene->drive.leakage_resistance = time * random_decades(seed, 0.3, 1e4) / capacitance;
    }
    if (a->kind == DEA_LENS && random_chance(seed, 0.3)) {
        scene->actuator.refractive_index = 1.4;
        scene->actuator.focal_length = a->coverage * a->frame_radius * random_between(seed, 1.2, 6.0) / 0.4;
    }
}

static const char *draw_mover(uint64_t *seed, dea_scene *scene, bool heavy)
{
    static const char *const models[] = {"lumped", "lame", "coverage", "ring"};
    draw_film(seed, scene);
    *dea_scene_load(scene, "mass") = heavy ? *dea_scene_load(scene, "mass") : (double)NAN;
    scene->material.density = heavy ? random_between(seed, 900.0, 1200.0) : (double)NAN;
    const bool weighed = scene->electrode.law && !isnan(scene->electrode.density); /* that of the skin is all then */
    const double areal = heavy && random_chance(seed, 0.3) ? random_decades(seed, 1e-3, 0.1) : (double)NAN;
    scene->actuator.electrode_mass = weighed ? (double)NAN : areal;
    return models[(int)(4.0 * random_unit(seed))];
}

/* Squeezes the waveform into a period of which the run holds some. */
void repeat(uint64_t *seed, dea_waveform *w, double until)
{
    const double period = until / random_between(seed, 1.5, 6.0), squeeze = period / (1.3 * until);
    if (w->kind == DEA_WAVE_SINE) {
        return;
    }
    w->step.off = isnan(w->step.off) ? w->step.on + w->step.rise + 0.2 * until : w->step.off;
    w->step.on *= squeeze;
    w->step.off *= squeeze;
    w->step.rise *= squeeze;
    for (size_t i = 0; i < w->point_count; i++) {
        w->times[i] *= squeeze;
    }
    w->period = period;
}

/* A rise is a jump, or no shorter than edges can be. */
void lengthen(dea_waveform *w)
{
    if (w->kind == DEA_WAVE_STEP && w->step.rise < DEA_EDGE_MIN) {
        w->step.rise = 0.0;
    }
}

/* Windows of means: none, or up to three, the whole run too. */
void put_windows(uint64_t *seed, paper *p, double until)
{
    const int count = (int)random_between(seed, -2.0, 4.0);
    for (int i = 0; i < count; i++) {
        const bool whole = random_chance(seed, 0.1);
        const double from = whole ? 0.0 : until * random_between(seed, 0.0, 0.9);
        const double to = whole ? until : from + (until - from) * random_decades(seed, 1e-2, 1.0);
        put(p, "%s{from: %.17g s, to: %.17g s}", i == 0 ? ", average: [" : ", ", from, fmin(to, until));
    }
    put(p, "%s", count > 0 ? "]" : "");
}

static void draw_transient(uint64_t *seed, paper *p)
{
    dea_scene scene;
    const bool heavy = random_chance(seed, 0.6);
    const char *model = draw_mover(seed, &scene, heavy);
    dea_transient *run = &scene.transient;
    scene.study = DEA_STUDY_TRANSIENT;
    scene.material.prony_count = 0;
    const double pace = pace_of(&scene);
    run->until = heavy ? random_decades(seed, 2.0, 40.0) / pace : random_decades(seed, 1e-6, 1e6);
    run->every = run->until / (double)(int)random_decades(seed, 10.0, 400.0);
    run->from_bias = random_chance(seed, 0.25);
    draw_motion(seed, &scene, run->until);
    const double share = random_chance(seed, 0.1) ? random_between(seed, 0.9, 1.4) : random_between(seed, 0.05, 0.7);
    random_wave(seed, &scene, share * limit_voltage(&scene, model));
    if (random_chance(seed, 0.2)) {
        repeat(seed, &scene.drive.waveform, run->until);
    }
    lengthen(&scene.drive.waveform);
    draw_ports(seed, &scene, run->until);
    put_actuator(p, &scene);
    put_material(p, &scene.material);
    put_drive(p, &scene);
    put(p, "model: %s\nstudy:\n  transient: {until: %.17g s, every: %.17g s, start: %s", model, run->until, run->every,
        run->from_bias ? "bias" : "rest");
    put_windows(seed, p, run->until);
    put(p, "}\n");
}

static void draw_response(uint64_t *seed, paper *p)
{
    dea_scene scene;
    const bool heavy = random_chance(seed, 0.7);
    const char *model = draw_mover(seed, &scene, heavy);
    scene.study = DEA_STUDY_AC;
    scene.material.prony_count = 0;
    const double centre = heavy ? pace_of(&scene) : random_decades(seed, 1e-4, 1e4);
    draw_motion(seed, &scene, 1.0 / centre);
    scene.drive.voltage = random_between(seed, 0.05, 0.95) * limit_voltage(&scene, model);
    draw_ports(seed, &scene, 1.0 / centre);
    put_actuator(p, &scene);
    put_material(p, &scene.material);
    put_drive(p, &scene);
    put(p, "model: %s\nstudy:\n  ac: {from: %.17g Hz, to: %.17g Hz, points_per_decade: %d}\n", model,
        centre * random_decades(seed, 1e-4, 0.3), centre * random_decades(seed, 3.0, 300.0),
        (int)random_between(seed, 3.0, 12.0));
}

/* A stream of its own for each scene. */
uint64_t stream_of(uint64_t seed, size_t number)
{
    uint64_t own = (seed + 1u) * UINT64_C(0x9E3779B97F4A7C15) ^ ((uint64_t)number + 1u) * UINT64_C(0xD1B54A32D192ED03);
    for (int i = 0; i < 8; i++) {
        (void)random_unit(&own);
    }
    return own;
}

char *draw_scene(uint64_t seed, size_t number)
{
    uint64_t own = stream_of(seed, number);
    paper p = {.text = malloc(TEXT)};
    if (p.text) {
        put(&p, "title: promise %zu of seed %llu\n", number, (unsigned long long)seed);
        const double kind = random_unit(&own);
        (kind < 0.4 ? draw_sweep : kind < 0.85 ? draw_transient : draw_response)(&own, &p);
    }
    return p.text;
}
