#include "network/rings_band.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "network/rings_mesh.h"
#include "support/lapack.h"

/* Rows of the band that are looked at. */
enum { MOST_PROBES = 64 };

dea_status dea_rings_bias(const dea_scene *scene, const dea_model *model, dea_rings_mesh mesh, dea_rings_biased *b, dea_error *error)
{
    dea_row row = dea_row_failed();
    const dea_status status = dea_membrane_open(scene, model, mesh, &b->membrane, error);
    if (status != DEA_OK) {
        return status;
    }
    memset(b->u, 0, sizeof b->u);
    b->voltage = scene->ac.bias / (1.0 + b->membrane.film.series * b->membrane.film.conductance);
    b->state = DEA_STATE_PULL_IN;
    if (dea_membrane_still(&b->membrane, b->voltage, b->u) && dea_membrane_look_at(&b->membrane, b->u, &b->look)) {
        dea_membrane_row(&b->membrane, &b->look, b->voltage, b->u, &row);
        b->state = row.state;
    }
    return DEA_OK;
}

/* Per volt of the source: displacement of the edge, and what the source sees. */
typedef struct answer {
    double complex displacement, impedance;
} answer;

/* Matrices of small motion, K + share D - w^2 M. */
typedef struct small {
    const dea_rings_biased *biased;
    double push[DEA_RINGS_NODES];
    double stiffness[DEA_RINGS_NODES * DEA_RINGS_NODES], damping[DEA_RINGS_NODES * DEA_RINGS_NODES];
    double complex matrix[DEA_RINGS_NODES * DEA_RINGS_NODES];
} small;

static void make_small(const dea_rings_biased *b, small *s)
{
    s->biased = b;
    dea_membrane_push(&b->membrane, &b->look, s->push);
    dea_membrane_stiffness(&b->membrane, &b->look, b->voltage, NULL, 0.0, s->stiffness);
    dea_membrane_damping(&b->membrane, &b->look, 1.0, s->damping);
}

/* u = A^-1 2 phi U per volt of the film, i = s (C + sum 2 phi U u) + 1/R_p. */
static bool solve(small *s, double omega, answer *a)
{
    const dea_membrane *m = &s->biased->membrane;
    const dea_dynamics *film = &m->film;
    const size_t n = m->nodes;
    const double complex at = omega * I;
    double complex share = at * film->retardation, x[DEA_RINGS_NODES], current = s->biased->look.capacitance;
    lapack_int pivots[DEA_RINGS_NODES];
    for (size_t i = 0; i < film->branch_count; i++) {
        const double complex turn = at * film->branches[i].tau;
        share += film->branches[i].share * turn / (1.0 + turn);
    }
    for (size_t k = 0; k < n * n; k++) {
        s->matrix[k] = s->stiffness[k] + share * s->damping[k];
    }
    for (size_t i = 0; i < n; i++) {
        s->matrix[i * (n + 1)] += at * at * m->masses[i];
        x[i] = 2.0 * s->push[i] * s->biased->voltage;
    }
    if (dea_lapacke_zgesv(LAPACK_COL_MAJOR, (lapack_int)n, 1, s->matrix, (lapack_int)n, pivots, x, (lapack_int)n) != 0) {
        return false;
    }
    for (size_t i = 0; i < n; i++) {
        current += 2.0 * s->push[i] * s->biased->voltage * x[i];
    }
    const double complex admittance = at * current + film->conductance, whole = 1.0 + film->series * admittance;
    *a = (answer){x[m->rings.edge] / whole, whole / admittance};
    return true;
}

/* Largest relative difference of what two meshes answer over the band. */
static double apart(const answer *a, const answer *b, size_t count)
{
    double most = 0.0;
    for (size_t i = 0; i < count; i++) {
        most = fmax(most, cabs(a[i].displacement - b[i].displacement) / cabs(b[i].displacement));
        most = fmax(most, cabs(a[i].impedance - b[i].impedance) / cabs(b[i].impedance));
    }
    return most;
}

static bool probe(const dea_scene *scene, small *s, const dea_rings_biased *b, answer *answers, size_t count)
{
    const size_t rows = dea_layout_of(scene).rows;
    make_small(b, s);
    for (size_t i = 0; i < count; i++) {
        const size_t row = count > 1 ? i * (rows - 1) / (count - 1) : 0;
        if (!solve(s, 2.0 * DEA_PI * dea_layout_place(scene, row), &answers[i])) {
            return false;
        }
    }
    return true;
}

dea_status dea_rings_band(const dea_scene *scene, const dea_model *model, dea_rings_biased *b, double *gap, dea_error *error)
{
    const bool wide = dea_rings_usual_mesh(scene).logarithmic;
    const size_t rows = dea_layout_of(scene).rows, count = rows < MOST_PROBES ? rows : MOST_PROBES;
    answer answers[2][MOST_PROBES];
    small *s = malloc(sizeof *s);
    dea_status status = s ? dea_lapack_load(error) : dea_fail(error, DEA_ERROR_MEMORY, "out of memory for a membrane");
    const size_t first = 4 + (size_t)fmax(0.0, ceil(-0.5 * log10(scene->accuracy)));
    *gap = INFINITY;
    for (size_t degree = first; status == DEA_OK && degree <= DEA_RINGS_DEGREE && *gap > scene->accuracy; degree += 2) {
        status = dea_rings_bias(scene, model, (dea_rings_mesh){degree, degree, wide}, b, error);
        if (status != DEA_OK || !dea_rings_stands(b)) {
            break;
        }
        memcpy(answers[0], answers[1], sizeof answers[0]);
        if (!probe(scene, s, b, answers[1], count)) {
            b->state = DEA_STATE_FAILED;
            break;
        }
        *gap = degree > first ? apart(answers[0], answers[1], count) : *gap;
    }
    free(s);
    return status;
}
