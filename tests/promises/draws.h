/* What random scenes are made of. */
#ifndef DEA_DRAWS_H
#define DEA_DRAWS_H

#include "../unit/random_transients.h"
#include "promises.h"

enum { TEXT = 16384 };

/* ---- a scene as YAML (paper.c) */

typedef struct paper {
    char *text; /* of TEXT bytes */
    size_t used;
} paper;

void put(paper *p, const char *format, ...) DEA_PRINTF(2, 3);
/* With what the scene has on its edge, too. */
void put_actuator(paper *p, const dea_scene *scene);
void put_material(paper *p, const dea_material *material);
void put_drive(paper *p, const dea_scene *scene);

/* ---- films (draw.c) */

/* A stream of random numbers of its own for each scene. */
uint64_t stream_of(uint64_t seed, size_t number);

/* A film of any law and size, without voltage. */
void draw_film(uint64_t *seed, dea_scene *scene);
/* What films may have beside themselves: layers, a skin, loads, a permittivity that follows, a temperature. From a seed of its own, so
 * that scenes without are what they are. */
void draw_beside(uint64_t seed, double share, dea_scene *scene);
/* W11 at rest [Pa]. */
double stiffness_of(const dea_scene *scene);
/* First resonance of a film of that frame, roughly [Hz]. */
double pace_of(const dea_scene *scene);
/* Voltage at which a film pulls in, or one that strains it well. */
double limit_voltage(dea_scene *scene, const char *model);

/* Branches and damper; resistances and optics. */
void draw_motion(uint64_t *seed, dea_scene *scene, double until);
void draw_ports(uint64_t *seed, dea_scene *scene, double time);
/* Squeezes the waveform into a period of which the run holds some. */
void repeat(uint64_t *seed, dea_waveform *w, double until);
/* A rise is a jump, or no shorter than edges can be. */
void lengthen(dea_waveform *w);
/* Windows of means: none, or up to three, the whole run too. */
void put_windows(uint64_t *seed, paper *p, double until);

#endif
