#include "engine/ngspice/bands.h"

#include <math.h>
#include <stdlib.h>

#include "support/memory_text.h"

/* The library rounds the number of steps between two frequencies down: a last one that rounding leaves short would be lost. */
static const double grid = 1e-13;

enum { EDGE, FILM, MOTION };

/* Vectors that are read. */
static size_t vectors_of(const dea_bands *b)
{
    return isnan(b->transduction) ? MOTION + 1 : MOTION;
}

dea_status dea_bands_write(const dea_bands *b, const dea_mobility_band *band, char **text, dea_error *error)
{
    dea_memory_text memory;
    dea_status status = dea_memory_text_begin(&memory, error);
    if (status == DEA_OK) {
        fputs("* dielectric elastomer actuator about its bias\n", memory.out);
        b->write(b->user, memory.out);
        fprintf(memory.out, "%s.save v(%s) v(film)%s\n", dea_dialect_find("ngspice")->ac, b->edge,
                vectors_of(b) > MOTION ? " v(motion)" : "");
        dea_cards_write_band(band, memory.out);
    }
    status = dea_memory_text_end(&memory, status, error);
    *text = memory.text;
    return status;
}

static double complex vector_at(const dea_ngspice_table *table, int vector, size_t index)
{
    const double *value = &table->columns[vector][2 * index];
    return value[0] + I * value[1];
}

/* i = i w (C U + T u) + U/R_p: the current through a series resistance is a small difference of voltages, what goes into the film the
 * better number. */
static dea_answer answer_of(const dea_bands *b, const dea_ngspice_table *table, size_t index, double frequency)
{
    const double complex u = vector_at(table, EDGE, index), voltage = vector_at(table, FILM, index);
    const double complex motion = vectors_of(b) > MOTION ? vector_at(table, MOTION, index) : b->transduction * u;
    const double complex current = 2.0 * DEA_PI * frequency * I * (b->capacitance * voltage + motion) + b->film->conductance * voltage;
    return (dea_answer){u, b->film->series + voltage / current};
}

/* Answers at @p count frequencies of a band. */
static dea_status run_band(const dea_bands *b, const dea_mobility_band *band, size_t count, dea_answer *answers, dea_error *error)
{
    const char *const names[] = {[EDGE] = b->edge, [FILM] = "film", [MOTION] = "motion"};
    dea_ngspice_table table = {0};
    char *netlist;
    dea_status status = dea_bands_write(b, band, &netlist, error);
    if (status == DEA_OK) {
        status = dea_ngspice_run_all(b->library, netlist, names, vectors_of(b), &table, error);
        free(netlist);
    }
    if (status == DEA_OK && table.count != count) {
        status = dea_fail(error, DEA_ERROR_ENGINE, "ngspice gave %zu of %zu frequencies", table.count, count);
    }
    for (size_t i = 0; i < count && status == DEA_OK; i++) {
        const double share = count > 1 ? (double)i / (double)(count - 1) : 0.0;
        const double frequency =
            band->points_per_decade > 0 ? dea_layout_place(b->scene, i) : band->from + (band->to - band->from) * share;
        answers[i] = answer_of(b, &table, i, frequency);
    }
    dea_ngspice_table_free(&table);
    return status;
}

/* The last frequency is the end of the band, which need not lie on the grid of the others. */
dea_status dea_bands_run(const dea_bands *b, size_t count, dea_answer *answers, dea_error *error)
{
    const double last = dea_layout_place(b->scene, count - 1);
    const dea_mobility_band end = {.from = last, .to = last, .count = 1};
    dea_status status = DEA_OK;
    if (count > 1) {
        const dea_mobility_band band = {.from = dea_layout_place(b->scene, 0),
                                        .to = dea_layout_place(b->scene, count - 2) * (1.0 + grid),
                                        .points_per_decade = count > 2 ? b->scene->ac.points_per_decade : 0,
                                        .count = 1};
        status = run_band(b, &band, count - 1, answers, error);
    }
    return status == DEA_OK ? run_band(b, &end, 1, &answers[count - 1], error) : status;
}

/* Frequencies between the rows: the library counts them evenly from one to another. */
static bool magnitudes(void *user, double from, double to, size_t count, double *out)
{
    const dea_mobility_band band = {.from = from, .to = to, .count = count};
    dea_answer *answers = calloc(count, sizeof *answers);
    dea_error ignored = {0};
    const bool answered = answers && run_band(user, &band, count, answers, &ignored) == DEA_OK;
    for (size_t i = 0; answered && i < count; i++) {
        out[i] = cabs(answers[i].displacement);
    }
    free(answers);
    return answered;
}

/* In (-180, 180]. */
static double degrees(double complex z)
{
    const double angle = carg(z) * (180.0 / DEA_PI);
    return angle > -180.0 ? angle : 180.0;
}

void dea_bands_fill(const dea_bands *b, size_t count, const dea_answer *answers, dea_state state, dea_response *rows, dea_band *band)
{
    const double none = (double)NAN;
    const bool held = state == DEA_STATE_OK || state == DEA_STATE_SLACK || state == DEA_STATE_BREAKDOWN;
    for (size_t i = 0; i < count; i++) {
        const dea_answer *a = &answers[i];
        rows[i] = (dea_response){dea_layout_place(b->scene, i), none, none, none, none, state};
        if (held) {
            rows[i].displacement = cabs(a->displacement);
            rows[i].displacement_phase = degrees(a->displacement);
            rows[i].impedance = cabs(a->impedance);
            rows[i].impedance_phase = degrees(a->impedance);
        }
    }
    if (band) {
        dea_bands asked = *b;
        *band = held ? dea_measure_band(rows, count, magnitudes, &asked) : (dea_band){none, none};
    }
}
