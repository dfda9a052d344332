/* Random membranes that move, with all that a film may have beside it: in time and in frequency. */
#include <math.h>
#include <stdlib.h>

#include "draws.h"

enum { BRANCHES = 4 };

/* Wider ranges than engineers meet, but films that two hundred of are judged within minutes. */
static void draw_membrane(uint64_t *seed, dea_scene *scene, bool heavy)
{
    draw_film(seed, scene);
    draw_beside(*seed, 0.35, scene);
    scene->models[0] = dea_model_find("field");
    scene->material.density = heavy ? random_between(seed, 900.0, 1200.0) : (double)NAN;
    *dea_scene_load(scene, "mass") = heavy ? *dea_scene_load(scene, "mass") : (double)NAN;
    const bool weighed = scene->electrode.law && !isnan(scene->electrode.density); /* that of the skin is all then */
    const double areal = heavy && random_chance(seed, 0.3) ? random_decades(seed, 1e-3, 0.1) : (double)NAN;
    scene->actuator.electrode_mass = weighed ? (double)NAN : areal;
    scene->material.prony_count = 0;
    scene->material.retardation = (double)NAN;
}

/* Branches about the time of the run, a damper about that of the first mode, or of the run without mass. */
static void draw_losses(uint64_t *seed, dea_scene *scene, double until, double period)
{
    dea_material *m = &scene->material;
    m->prony_count = random_chance(seed, 0.5) ? 0 : 1 + (size_t)(BRANCHES * random_unit(seed));
    m->instantaneous = random_chance(seed, 0.3);
    for (size_t i = 0; i < m->prony_count; i++) {
        m->prony[i].g = random_between(seed, 0.05, 0.6) / (double)m->prony_count;
        m->prony[i].tau = until * random_decades(seed, 1e-4, 1e2);
    }
    const bool loaded = *dea_scene_load(scene, "damping") > 0.0 && isnan(m->density); /* its damper alone leaves the others without an equation */
    if (loaded || random_chance(seed, 0.75)) {
        m->retardation = isnan(m->density) ? until * random_decades(seed, 1e-4, 0.1) : period * random_decades(seed, 3e-3, 0.3);
    }
}

/* Edges that a membrane follows: without a damper no shorter than a part of its period. */
static void soften_edges(uint64_t *seed, dea_scene *scene, double period)
{
    dea_waveform *w = &scene->drive.waveform;
    const bool damped = !isnan(scene->material.retardation);
    if (w->kind == DEA_WAVE_STEP && !isnan(scene->material.density)) {
        w->step.rise = fmax(w->step.rise, period * random_decades(seed, damped ? 3e-3 : 0.1, 1.0));
        w->step.off = fmax(w->step.off, w->step.on + w->step.rise);
    }
}

static void draw_motion_of_field(uint64_t *seed, paper *p)
{
    dea_scene scene;
    const bool heavy = random_chance(seed, 0.75);
    draw_membrane(seed, &scene, heavy);
    dea_transient *run = &scene.transient;
    scene.study = DEA_STUDY_TRANSIENT;
    const double period = 1.0 / pace_of(&scene);
    run->until = heavy ? period * random_decades(seed, 0.7, 4.0) : random_decades(seed, 1e-6, 1e6);
    run->every = run->until / (double)(int)random_decades(seed, 8.0, 40.0);
    run->from_bias = random_chance(seed, 0.25);
    draw_losses(seed, &scene, run->until, period);
    const double share = random_chance(seed, 0.1) ? random_between(seed, 0.8, 1.2) : random_between(seed, 0.05, 0.7);
    random_wave(seed, &scene, share * limit_voltage(&scene, "field"));
    soften_edges(seed, &scene, period);
    if (random_chance(seed, 0.1)) {
        repeat(seed, &scene.drive.waveform, run->until);
    }
    lengthen(&scene.drive.waveform);
    draw_ports(seed, &scene, run->until);
    put_actuator(p, &scene);
    put_material(p, &scene.material);
    put_drive(p, &scene);
    put(p, "model: field\nstudy:\n  transient: {until: %.17g s, every: %.17g s, start: %s", run->until, run->every,
        run->from_bias ? "bias" : "rest");
    put_windows(seed, p, run->until);
    put(p, "}\n");
}

static void draw_response_of_field(uint64_t *seed, paper *p)
{
    dea_scene scene;
    const bool heavy = random_chance(seed, 0.75);
    draw_membrane(seed, &scene, heavy);
    scene.study = DEA_STUDY_AC;
    const double centre = heavy ? pace_of(&scene) : random_decades(seed, 1e-4, 1e4);
    draw_losses(seed, &scene, 1.0 / centre, 1.0 / centre);
    scene.drive.voltage = random_between(seed, 0.05, 0.95) * limit_voltage(&scene, "field");
    draw_ports(seed, &scene, 1.0 / centre);
    put_actuator(p, &scene);
    put_material(p, &scene.material);
    put_drive(p, &scene);
    put(p, "model: field\nstudy:\n  ac: {from: %.17g Hz, to: %.17g Hz, points_per_decade: %d}\n", centre * random_decades(seed, 1e-3, 0.3),
        centre * random_decades(seed, 1.0, 5.0), (int)random_between(seed, 3.0, 8.0));
}

char *draw_moving_film(uint64_t seed, size_t number)
{
    uint64_t own = stream_of(seed, number);
    paper p = {.text = malloc(TEXT)};
    if (p.text) {
        put(&p, "title: moving film %zu of seed %llu\n", number, (unsigned long long)seed);
        (random_unit(&own) < 0.7 ? draw_motion_of_field : draw_response_of_field)(&own, &p);
    }
    return p.text;
}
