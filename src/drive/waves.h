/* Every kind of waveform, a file each: rows of waves.c. */
#ifndef DEA_DRIVE_WAVES_H
#define DEA_DRIVE_WAVES_H

#include "drive/wave.h"

extern const dea_wave dea_wave_step, dea_wave_points, dea_wave_sine, dea_wave_pulse, dea_wave_square, dea_wave_triangle,
    dea_wave_chirp, dea_wave_burst, dea_wave_sines;

/* Rows of the tables of numbers. */
#define DEA_WAVE_VOLTAGE(key, place, must, otherwise, help) {key, place, "V", -INFINITY, INFINITY, true, must, otherwise, help}
#define DEA_WAVE_FREQUENCY(key, place, help) {key, place, "Hz", 0, INFINITY, true, true, (double)NAN, help}
#define DEA_WAVE_ANGLE(key, place) {key, place, "rad", -INFINITY, INFINITY, true, false, 0.0, "an angle, e.g. 90 deg"}
#define DEA_WAVE_DELAY(key, place) {key, place, "s", 0, INFINITY, false, false, 0.0, "a time >= 0, e.g. 5 s"}
#define DEA_WAVE_RISE(key, place) {key, place, "s", 0, INFINITY, false, false, 1e-6, "a time >= 0, e.g. 1 us"}
/* Place of a number that has no struct of its own. */
#define DEA_WAVE_PLACE(index) (offsetof(dea_waveform, numbers) + (index) * sizeof(double))

/* For waveforms of straight edges: a trapezoid that stands at @p base, and from @p on at @p base + @p height for @p width [s],
 * counted from begin to begin of its edges, which take @p rise. Adds it between two times. */
typedef struct dea_trapezoid {
    double base, height; /* [V] */
    double on, width, rise; /* [s] */
} dea_trapezoid;

static inline void dea_lay_trapezoid(struct dea_wave_builder *b, const dea_trapezoid *t, double from, double to)
{
    const double top = t->base + t->height, off = t->on + t->width;
    dea_lay_line(b, from, t->on, t->base, t->base);
    dea_lay_line(b, t->on, t->on + t->rise, t->base, top);
    dea_lay_line(b, t->on + t->rise, off, top, top);
    dea_lay_line(b, off, off + t->rise, top, t->base);
    dea_lay_line(b, off + t->rise, to, t->base, t->base);
}

#endif
