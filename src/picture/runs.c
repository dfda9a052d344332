#include "picture/runs.h"
#include "study/study.h"

#include <complex.h>
#include <math.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

enum { SPOT_PLACES = 20, STEP_DEGREES = 3 /* that a response turns between points that are drawn */ };

static const double degree = 0.017453292519943295; /* [rad] */

static double value_at(const dea_runs *runs, const void *point, size_t row, size_t column)
{
    return dea_layout_number((const char *)point + row * runs->layout.row_size, runs->layout.columns[column].offset);
}

/* Number of the column at an offset, SIZE_MAX where the layout has none. */
static size_t column_at(const dea_layout *layout, size_t offset)
{
    for (size_t i = 0; i < layout->column_count; i++) {
        if (layout->columns[i].offset == offset) {
            return i;
        }
    }
    return SIZE_MAX;
}

/* Columns that a picture of the study shows: those that the layout has, the first in the largest panel. */
static void quantities_choose(const dea_scene *scene, dea_runs *runs)
{
    const dea_study *study = dea_study_of(scene);
    for (size_t i = 0; i < study->drawn_count; i++) {
        const size_t column = column_at(&runs->layout, study->drawn[i]);
        if (column != SIZE_MAX && (column != runs->abscissa || column == 0)) {
            runs->quantities[runs->quantity_count++] = column;
        }
    }
}

dea_status dea_runs_open(const dea_scene *scene, bool loops, dea_runs *runs, dea_error *error)
{
    *runs = (dea_runs){.layout = dea_layout_of(scene), .count = dea_scene_point_count(scene) * scene->model_count};
    if (runs->count > DEA_CURVES_MAX) {
        return dea_fail(error, DEA_ERROR_USAGE, "%zu runs are too many for one picture (at most %d): give the axes fewer values",
                        runs->count, DEA_CURVES_MAX);
    }
    if (runs->layout.rows < 2) {
        return dea_fail(error, DEA_ERROR_USAGE, "nothing to draw: each run is a single point");
    }
    runs->abscissa = loops ? column_at(&runs->layout, offsetof(dea_sample, voltage)) : 0;
    quantities_choose(scene, runs);
    const bool filled = dea_study_of(scene)->phasors || runs->layout.rows > DEA_RUNS_POINTS;
    const size_t most = filled ? DEA_RUNS_POINTS : runs->layout.rows;
    runs->runs = calloc(runs->count, sizeof *runs->runs);
    runs->room = malloc(runs->count * runs->quantity_count * 2 * most * sizeof *runs->room);
    if (!runs->runs || !runs->room) {
        dea_runs_close(runs);
        return dea_fail(error, DEA_ERROR_MEMORY, "out of memory");
    }
    double *next = runs->room;
    for (size_t i = 0; i < runs->count * runs->quantity_count; i++, next += 2 * most) {
        runs->runs[i / runs->quantity_count].traces[i % runs->quantity_count] = (dea_plot_trace){next, next + most, 0};
    }
    return DEA_OK;
}

static void trace_add(dea_plot_trace *trace, double x, double y)
{
    trace->x[trace->count] = x;
    trace->y[trace->count++] = y;
}

/* Keeps a quantity over the voltage: rows as they come, thinned evenly. */
static void loop_take(const dea_runs *runs, dea_plot_trace *trace, const void *point, size_t column)
{
    const size_t rows = runs->layout.rows, stride = (rows - 1) / DEA_RUNS_POINTS + 1;
    trace->count = 0;
    for (size_t row = 0; row < rows; row += stride) {
        trace_add(trace, value_at(runs, point, row, runs->abscissa), value_at(runs, point, row, column));
    }
}

/* Keeps a quantity. Angles follow their predecessor: whole turns are added where they leap by more than half a turn, which the
 * answer of a film without losses does at its resonance. */
static void trace_take(const dea_runs *runs, dea_plot_trace *trace, const void *point, size_t column, double turn)
{
    const size_t rows = runs->layout.rows;
    const size_t stride = rows <= DEA_RUNS_POINTS ? 1 : (2 * rows - 1) / DEA_RUNS_POINTS + 1;
    double before = (double)NAN;
    trace->count = 0;
    for (size_t first = 0; first < rows; first += stride) {
        double x[2] = {value_at(runs, point, first, 0), 0.0}, y[2] = {(double)NAN, (double)NAN}; /* least, largest */
        for (size_t row = first; row < first + stride && row < rows; row++) {
            double value = value_at(runs, point, row, column);
            value += turn > 0.0 && fabs(value - before) > 0.51 * turn ? turn * round((before - value) / turn) : 0.0;
            before = isfinite(value) ? value : before;
            for (int end = 0; end < 2 && isfinite(value); end++) {
                if (!isfinite(y[end]) || (end == 0 ? value < y[end] : value > y[end])) {
                    x[end] = value_at(runs, point, row, 0);
                    y[end] = value;
                }
            }
        }
        const int early = isfinite(y[0]) && x[1] < x[0] ? 1 : 0;
        trace_add(trace, x[early], y[early]);
        if (stride > 1 && isfinite(y[0]) && x[0] != x[1]) {
            trace_add(trace, x[1 - early], y[1 - early]);
        }
    }
}

static double complex response_at(const dea_runs *runs, const void *point, size_t row, size_t quantity)
{
    const double size = value_at(runs, point, row, runs->quantities[quantity]);
    return size * cexp(I * degree * value_at(runs, point, row, runs->quantities[quantity + 1]));
}

/* Four samples about a gap. */
typedef struct stencil {
    double at[4];
    double complex values[4];
} stencil;

/* Cubic through the inverse of four values, inverted: for one mode 1/H = k - (2 pi f)^2 m + 2 pi i f r. */
static double complex between_inverse(const stencil *samples, double f)
{
    double complex sum = 0.0;
    for (size_t i = 0; i < 4; i++) {
        double complex weight = 1.0 / samples->values[i];
        for (size_t k = 0; k < 4; k++) {
            weight *= k == i ? 1.0 : (f - samples->at[k]) / (samples->at[i] - samples->at[k]);
        }
        sum += weight;
    }
    return 1.0 / sum;
}

/* Thiele's continued fraction through four values: a resonance beside an antiresonance, as an impedance has them. */
static double complex between_fraction(const stencil *samples, double f)
{
    const double *at = samples->at;
    double complex terms[4];
    memcpy(terms, samples->values, sizeof terms);
    for (size_t level = 1; level < 4; level++) {
        for (size_t i = level; i < 4; i++) {
            terms[i] = (at[i] - at[level - 1]) / (terms[i] - terms[level - 1]);
        }
    }
    double complex value = terms[3];
    for (size_t i = 3; i-- > 0;) {
        value = terms[i] + (f - at[i]) / value;
    }
    return value;
}

/* Response between the samples number first + 1 and first + 2 of four; the first pair is the one with the single mode. */
static double complex response_between(const dea_runs *runs, const void *point, size_t first, size_t quantity, double f)
{
    stencil samples;
    for (size_t i = 0; i < 4; i++) {
        samples.values[i] = response_at(runs, point, first + i, quantity);
        samples.at[i] = value_at(runs, point, first + i, 0);
    }
    return quantity == 0 ? between_inverse(&samples, f) : between_fraction(&samples, f);
}

/* Steps in which the response goes from a sample to the next: as its phase turns. */
static size_t response_steps(const dea_runs *runs, const void *point, size_t row, size_t quantity)
{
    const double turn = carg(response_at(runs, point, row + 1, quantity) / response_at(runs, point, row, quantity));
    return isfinite(turn) ? 1 + (size_t)(fabs(turn) / (STEP_DEGREES * degree)) : 1;
}

/* Keeps magnitude and phase of a response with points between its samples where it turns fast. */
static void pair_take(const dea_runs *runs, dea_run *run, const void *point, size_t quantity)
{
    const size_t rows = runs->layout.rows;
    dea_plot_trace *size = &run->traces[quantity], *phase = &run->traces[quantity + 1];
    const dea_plot_trace coarse = *phase;
    double phases[DEA_RUNS_POINTS];
    memcpy(phases, coarse.y, rows * sizeof *phases); /* without leaps */
    size->count = phase->count = 0;
    for (size_t row = 0; row < rows; row++) {
        const double f = value_at(runs, point, row, 0);
        trace_add(size, f, value_at(runs, point, row, runs->quantities[quantity]));
        trace_add(phase, f, phases[row]);
        const size_t first = row == 0 ? 0 : row + 3 < rows ? row - 1 : rows - 4;
        const size_t steps = row + 1 < rows ? response_steps(runs, point, row, quantity) : 1;
        for (size_t k = 1; k < steps && size->count + rows - row < DEA_RUNS_POINTS; k++) { /* the samples left have room too */
            const double next = value_at(runs, point, row + 1, 0), at = f * pow(next / f, (double)k / (double)steps);
            const double complex h = response_between(runs, point, first, quantity, at);
            const double angle = carg(h) / degree, before = phase->y[phase->count - 1];
            if (isfinite(angle) && isfinite(before)) { /* a neighbour may have no number */
                trace_add(size, at, cabs(h));
                trace_add(phase, at, angle + 360.0 * round((before - angle) / 360.0));
            }
        }
    }
}

static void spot_add(const dea_runs *runs, dea_run *run, const void *point, size_t row, dea_state state)
{
    for (size_t mark = 0; mark < DEA_MARKS; mark++) {
        if (dea_marks[mark].state == state && run->spot_count < DEA_SPOTS) {
            run->spots[run->spot_count++] =
                (dea_spot){value_at(runs, point, row, runs->abscissa), value_at(runs, point, row, runs->quantities[0]), mark};
        }
    }
}

/* A limit is marked where it is passed and every so often from there on, pull-in where the curve ends. */
static void spots_take(const dea_runs *runs, dea_run *run, const void *point)
{
    const dea_layout *layout = &runs->layout;
    const size_t step = layout->rows / SPOT_PLACES + 1;
    dea_state before = DEA_STATE_OK;
    size_t since = 0; /* row where the state began */
    run->spot_count = 0;
    for (size_t row = 0; row < layout->rows; row++) {
        const dea_state state = dea_layout_state(layout, (const char *)point + row * layout->row_size);
        since = state != before ? row : since;
        if (state == DEA_STATE_PULL_IN) {
            if (before != state && row > 0) {
                spot_add(runs, run, point, row - 1, state);
            }
        } else if (state != before || (row - since) % step == 0) {
            spot_add(runs, run, point, row, state);
        }
        before = state;
    }
}

void dea_runs_take(dea_runs *runs, size_t number, const void *point)
{
    dea_run *run = &runs->runs[number];
    bool response = runs->layout.rows >= 4 && runs->layout.rows <= DEA_RUNS_POINTS / 2;
    for (size_t i = 0; i < runs->quantity_count; i++) {
        const size_t column = runs->quantities[i];
        const bool angle = strcmp(runs->layout.columns[column].unit, "degree") == 0;
        if (runs->abscissa > 0) {
            loop_take(runs, &run->traces[i], point, column);
        } else {
            trace_take(runs, &run->traces[i], point, column, angle ? 360.0 : 0.0);
        }
        response = response && angle == (i % 2 == 1);
    }
    for (size_t i = 0; response && i + 1 < runs->quantity_count; i += 2) {
        pair_take(runs, run, point, i);
    }
    spots_take(runs, run, point);
}

size_t dea_runs_find(const dea_runs *runs, size_t offset)
{
    for (size_t i = 0; i < runs->quantity_count; i++) {
        if (runs->layout.columns[runs->quantities[i]].offset == offset) {
            return i;
        }
    }
    return SIZE_MAX;
}

void dea_runs_close(dea_runs *runs)
{
    free(runs->runs);
    free(runs->room);
    *runs = (dea_runs){.count = 0};
}
