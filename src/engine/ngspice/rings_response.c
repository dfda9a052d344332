/* Frequency responses of the membrane: its rings linearised about the equilibrium under the bias. Two meshes, the finer by two
 * degrees, tell the error of the coarser one; the rows are those of the finer. */
#include <complex.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "deaspice/measures.h"
#include "engine/ngspice/moving.h"
#include "netlist/part_text.h"
#include "engine/ngspice/deck.h"
#include "netlist/rings_small.h"
#include "support/text.h"
#include "network/rings_mesh.h"

/* The library rounds the number of steps between two frequencies down: a last one that rounding leaves short would be lost. */
static const double grid = 1e-13;

enum { EDGE, FILM, MOTION, VECTORS };

typedef struct response {
    dea_ngspice *library;
    const dea_scene *scene;
    dea_membrane membrane;
    double u[DEA_RINGS_NODES];
    double voltage; /* of the film at the bias [V] */
    double capacitance;
} response;

/* Per volt of the source: displacement of the edge, and what the source sees. */
typedef struct answer {
    double complex displacement, impedance;
} answer;

static dea_status write_netlist(const response *r, const dea_mobility_band *band, char **text, dea_error *error)
{
    const dea_rings_small small = {&r->membrane, r->u, r->voltage};
    size_t length = 0;
    *text = NULL;
    FILE *out = open_memstream(text, &length);
    if (out) {
        fputs("* membrane about its bias\n", out);
        dea_rings_small_write(&small, out);
        fprintf(out, ".options noopac pivtol=1e-60\n.save v(u%zu) v(film) v(motion)\n.ac ", r->membrane.rings.edge + 1);
        fprintf(out, band->points_per_decade > 0 ? "dec %zu " : "lin %zu ",
                band->points_per_decade > 0 ? band->points_per_decade : band->count > 1 ? band->count : 1);
        dea_part_number(out, band->from);
        fputc(' ', out);
        dea_part_number(out, band->to);
        fputs("\n.end\n", out);
    }
    if (!dea_text_close(out) || !*text) {
        free(*text);
        *text = NULL;
        return dea_fail(error, DEA_ERROR_MEMORY, "out of memory while a netlist is written");
    }
    return DEA_OK;
}

static double complex vector_at(const dea_ngspice_table *table, int vector, size_t index)
{
    const double *value = &table->columns[vector][2 * index];
    return value[0] + I * value[1];
}

/* i = i w (C U + sum T_n u_n) + U/R_p: the current through a series resistance is a small difference of voltages, what goes into
 * the film the better number. */
static answer answer_of(const response *r, const dea_ngspice_table *table, size_t index, double frequency)
{
    const dea_dynamics *film = &r->membrane.film;
    const double complex voltage = vector_at(table, FILM, index), s = 2.0 * DEA_PI * frequency * I;
    const double complex current = s * (r->capacitance * voltage + vector_at(table, MOTION, index)) + film->conductance * voltage;
    return (answer){vector_at(table, EDGE, index), film->series + voltage / current};
}

/* Answers at @p count frequencies of a band. */
static dea_status run_band(const response *r, const dea_mobility_band *band, size_t count, answer *answers, dea_error *error)
{
    char edge[24];
    const char *names[VECTORS] = {[EDGE] = edge, [FILM] = "film", [MOTION] = "motion"};
    dea_ngspice_table table = {0};
    char *netlist;
    snprintf(edge, sizeof edge, "u%zu", r->membrane.rings.edge + 1);
    dea_status status = write_netlist(r, band, &netlist, error);
    if (status == DEA_OK) {
        status = dea_ngspice_run_all(r->library, netlist, names, VECTORS, &table, error);
        free(netlist);
    }
    if (status == DEA_OK && table.count != count) {
        status = dea_fail(error, DEA_ERROR_ENGINE, "ngspice gave %zu of %zu frequencies", table.count, count);
    }
    for (size_t i = 0; i < count && status == DEA_OK; i++) {
        const double share = count > 1 ? (double)i / (double)(count - 1) : 0.0;
        const double frequency = band->points_per_decade > 0 ? dea_layout_place(r->scene, i) : band->from + (band->to - band->from) * share;
        answers[i] = answer_of(r, &table, i, frequency);
    }
    dea_ngspice_table_free(&table);
    return status;
}

/* All rows; the last frequency is the end of the band, which need not lie on the grid of the others. */
static dea_status run_rows(const response *r, size_t count, answer *answers, dea_error *error)
{
    const double last = dea_layout_place(r->scene, count - 1);
    const dea_mobility_band end = {.from = last, .to = last, .count = 1};
    dea_status status = DEA_OK;
    if (count > 1) {
        const dea_mobility_band band = {.from = dea_layout_place(r->scene, 0),
                                        .to = dea_layout_place(r->scene, count - 2) * (1.0 + grid),
                                        .points_per_decade = count > 2 ? r->scene->ac.points_per_decade : 0,
                                        .count = 1};
        status = run_band(r, &band, count - 1, answers, error);
    }
    return status == DEA_OK ? run_band(r, &end, 1, &answers[count - 1], error) : status;
}

/* The film at its bias on a mesh; *state: what it is there. */
static dea_status open_mesh(response *r, const dea_model *model, dea_rings_mesh mesh, dea_state *state, dea_error *error)
{
    dea_membrane_look look;
    dea_row row = dea_row_failed();
    const dea_status status = dea_membrane_open(r->scene, model, mesh, &r->membrane, error);
    if (status != DEA_OK) {
        return status;
    }
    memset(r->u, 0, sizeof r->u);
    r->voltage = r->scene->ac.bias / (1.0 + r->membrane.film.series * r->membrane.film.conductance);
    *state = DEA_STATE_PULL_IN;
    if (dea_membrane_still(&r->membrane, r->voltage, r->u) && dea_membrane_look_at(&r->membrane, r->u, &look)) {
        dea_membrane_row(&r->membrane, &look, r->voltage, r->u, &row);
        r->capacitance = look.capacitance;
        *state = row.state;
    }
    return DEA_OK;
}

static bool magnitudes(void *user, double from, double to, size_t count, double *out)
{
    const response *r = user;
    const dea_mobility_band band = {.from = from, .to = to, .count = count};
    answer *answers = calloc(count, sizeof *answers);
    dea_error ignored = {0};
    const bool answered = answers && run_band(r, &band, count, answers, &ignored) == DEA_OK;
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

static void fill(const response *r, size_t count, const answer *answers, dea_state state, dea_response *rows)
{
    const double none = (double)NAN;
    for (size_t i = 0; i < count; i++) {
        const answer *a = &answers[i];
        rows[i] = (dea_response){dea_layout_place(r->scene, i), none, none, none, none, state};
        if (state == DEA_STATE_OK || state == DEA_STATE_SLACK || state == DEA_STATE_BREAKDOWN) {
            rows[i].displacement = cabs(a->displacement);
            rows[i].displacement_phase = degrees(a->displacement);
            rows[i].impedance = cabs(a->impedance);
            rows[i].impedance_phase = degrees(a->impedance);
        }
    }
}

static double gap(const answer *a, const answer *b, size_t count)
{
    double most = 0.0;
    for (size_t i = 0; i < count; i++) {
        most = fmax(most, cabs(a[i].displacement - b[i].displacement) / cabs(b[i].displacement));
        most = fmax(most, cabs(a[i].impedance - b[i].impedance) / cabs(b[i].impedance));
    }
    return most;
}

/* Meshes ever finer until two of them agree: the error of the finer one is a small part of their difference. */
static dea_status refine(response *r, const dea_model *model, answer *pair[2], size_t count, dea_state *state, dea_error *error)
{
    const bool wide = dea_rings_usual_mesh(r->scene).logarithmic;
    const size_t first = 4 + (size_t)fmax(0.0, ceil(-0.5 * log10(r->scene->accuracy)));
    for (size_t degree = first; degree <= DEA_RINGS_DEGREE; degree += 2) {
        answer *last = pair[0];
        pair[0] = pair[1];
        pair[1] = last;
        dea_status status = open_mesh(r, model, (dea_rings_mesh){degree, degree, wide}, state, error);
        if (status != DEA_OK || *state == DEA_STATE_PULL_IN || *state == DEA_STATE_FAILED) {
            return status;
        }
        status = run_rows(r, count, pair[1], error);
        if (status != DEA_OK || (degree > first && gap(pair[0], pair[1], count) <= r->scene->accuracy)) {
            return status;
        }
    }
    *state = DEA_STATE_FAILED;
    dea_fail(error, DEA_OK, "meshes of up to %d degrees do not agree within the accuracy", DEA_RINGS_DEGREE);
    return DEA_OK;
}

dea_status dea_ngspice_ac_rings(dea_ngspice *library, const dea_scene *scene, const dea_model *model, dea_response *rows,
                                dea_band *band, dea_error *error)
{
    const size_t count = dea_layout_of(scene).rows;
    response *r = calloc(1, sizeof *r);
    answer *answers = calloc(2 * count, sizeof *answers);
    dea_state state = DEA_STATE_FAILED;
    if (!r || !answers) {
        free(r);
        free(answers);
        return dea_fail(error, DEA_ERROR_MEMORY, "out of memory for a frequency response");
    }
    answer *pair[2] = {answers, answers + count};
    r->library = library;
    r->scene = scene;
    const dea_status status = refine(r, model, pair, count, &state, error);
    if (status == DEA_OK) {
        fill(r, count, pair[1], state, rows);
        const bool held = state != DEA_STATE_PULL_IN && state != DEA_STATE_FAILED;
        if (band) {
            *band = held ? dea_measure_band(rows, count, magnitudes, r) : (dea_band){(double)NAN, (double)NAN};
        }
    }
    free(answers);
    free(r);
    return status;
}
