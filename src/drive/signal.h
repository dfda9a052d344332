/* The source voltage of a transient as segments: each linear in time or part of a sum of sines, without gaps from 0 to the end. */
#ifndef DEA_SIGNAL_H
#define DEA_SIGNAL_H

#include "drive/wave.h"

/* Terms of a square of a voltage that stands for a run of lines: a polynomial of the 11th degree. Of an impulse response of rate Omega
 * the best one leaves 2 (Omega h/4)^12/12! over a time h, 4e-9 at Omega h = 4. */
enum { DEA_TERMS = 12 };

typedef struct dea_segment {
    double from, to;   /* [s], from < to */
    double start, end; /* voltage at from, behind an edge there, and at to, before one [V] */
    bool sine;         /* in between that of the signal's curve, else linear */
    double origin;     /* of a curve: time from which its phases count [s] */
    const struct dea_segment *lines; /* of a curve that is a run of lines or stands for one: these, line_count of them; else NULL */
    size_t line_count;
    const double *terms; /* of a curve that stands for lines: U^2 = sum terms[n] P_n(x) with x = -1 ... 1 over the segment [V^2]; NULL */
    double step; /* longest step through such a run [s]; 0: any */
    bool corner; /* of a line of a run: at its end is a corner that no step may pass; of the run: it may have such lines */
} dea_segment;

/* offset + sum of tones. */
typedef struct dea_curve {
    double offset; /* [V] */
    dea_tone tones[DEA_SINES];
    size_t count;
} dea_curve;

typedef struct dea_signal {
    dea_segment *segments; /* owned */
    size_t count;          /* >= 1 */
    dea_curve curve;       /* of segments that are part of one */
    double largest;        /* |U| over the run [V] */
    dea_segment *lines;    /* owned: of segments that are runs of them, or NULL */
    dea_segment *record;   /* owned: lines of segments that stand for them, or NULL */
    double *terms;         /* owned: of those segments, or NULL */
    double thinned;        /* what they change of the displacement, at most, relative to its peak [1] */
} dea_signal;

/* Segments of the scene's waveform from 0 to `until`; the caller ends it with dea_signal_close(), also after a failure.
 * Neighbours that continue each other are one segment: a corner
 * that rounding of its time and voltage can explain is none. DEA_ERROR_MEMORY. */
dea_status dea_signal_open(const dea_scene *scene, dea_signal *signal, dea_error *error);
void dea_signal_close(dea_signal *signal);

/* Cuts segments at times inside of them, which do not decrease; the voltage stays what it is. DEA_ERROR_MEMORY. */
dea_status dea_signal_cut(dea_signal *signal, const double *times, size_t count, dea_error *error);

/* Voltage [V], its slope [V/s] and its curvature [V/s^2] inside a segment, ends included. */
double dea_segment_voltage(const dea_signal *signal, const dea_segment *segment, double time);
double dea_segment_slope(const dea_signal *signal, const dea_segment *segment, double time);
double dea_segment_curvature(const dea_signal *signal, const dea_segment *segment, double time);
/* Largest |U| that a segment can have [V]. */
double dea_segment_largest(const dea_signal *signal, const dea_segment *segment);
/* Fastest turn of a curve's tones within a segment [rad/s]; 0 of a line. */
double dea_segment_turn(const dea_signal *signal, const dea_segment *segment);

/* True where the curve is a single sine of one frequency. */
bool dea_curve_is_plain(const dea_curve *curve);
/* |offset| + the amplitudes [V]. */
double dea_curve_largest(const dea_curve *curve);
/* The tone at a time, its age counted from there: phase in one turn and frequency of that moment. */
dea_tone dea_tone_from(const dea_tone *tone, double age);

/* Voltage at a time counted from the begin of the segment, so that a short edge late in a run keeps its digits [V]. */
double dea_segment_voltage_since(const dea_signal *signal, const dea_segment *segment, double since);

/* The polynomial of a segment that stands for lines: the square of its voltage, but where it is negative [V^2]. */
double dea_segment_square(const dea_segment *segment, double time);

/* What a sample of that time sees: of a segment that stands for lines, the line. */
const dea_segment *dea_segment_seen(const dea_segment *segment, double time);

/* The segment of a time, searched from segment number @p near on: from < time <= to, the first one at its begin too. */
size_t dea_signal_find(const dea_signal *signal, size_t near, double time);

/* ---- Runs of lines as one segment, for engines whose steps follow what they see. */

/* Draws lines that continue each other together to segments with `lines`, whose voltage stays what it is: those whose corners are
 * small for this accuracy, and whatever their corners, which are marked as such, those that take no longer than @p shorter [s].
 * DEA_ERROR_MEMORY. */
dea_status dea_signal_soften(dea_signal *signal, double accuracy, double shorter, dea_error *error);

#endif
