#include "engine/direct/sheets.h"

#include <math.h>
#include <stdlib.h>

#include "network/sheet.h"
#include "support/lapack.h"

/* Nodes of each element. */
static const size_t degrees[DEA_SHEETS_MESHES] = {8, 12, 17, 24, 32, 40};

/* Coverage below which the annulus has its nodes even in ln R. */
static const double small_disc = 0.1;

typedef struct dea_sheets_mesh {
    dea_membrane membrane;
    double stiffness[DEA_RINGS_NODES * DEA_RINGS_NODES], viscous[DEA_RINGS_NODES * DEA_RINGS_NODES]; /* K, K_v */
    double beside[DEA_RINGS_NODES * DEA_RINGS_NODES]; /* K_2 [N s/m] */
    double pull[DEA_SHEET_PLACES][DEA_RINGS_NODES];                                                /* P of all places [N/V] */
    double capacitances[DEA_SHEET_PLACES];                                                        /* [F] */
    double admittance[DEA_SHEET_PLACES * DEA_SHEET_PLACES];                                       /* Y without the rim [S] */
} mesh;

/* Places of one potential each: an electrode without a sheet resistance is one, at the rim. */
static size_t places_of(const mesh *m)
{
    return m->membrane.sheet.places > 0 ? m->membrane.sheet.places : 1;
}

/* The film under its bias, where the potential is uniform. */
static bool set_mesh(const dea_sheets *s, size_t level, mesh *m)
{
    const dea_actuator *actuator = &s->scene.actuator;
    const double coverage = isnan(actuator->coverage) ? actuator->divide_radius / actuator->frame_radius : actuator->coverage;
    const dea_rings_mesh rings = {degrees[level], degrees[level], coverage < small_disc};
    double u[DEA_RINGS_NODES], still[DEA_SHEET_PLACES] = {0.0};
    dea_membrane_look look;
    dea_charges charges;
    if (dea_membrane_open(&s->scene, s->model, rings, &m->membrane, NULL) != DEA_OK ||
        !dea_membrane_still(&m->membrane, s->voltage, u) || !dea_membrane_look_at(&m->membrane, u, &look)) {
        return false;
    }
    const size_t n = m->membrane.nodes;
    dea_membrane_stiffness(&m->membrane, &look, s->voltage, NULL, 0.0, m->stiffness);
    dea_membrane_damping(&m->membrane, &look, 1.0, m->viscous);
    dea_membrane_damp_second(&m->membrane, &look, 1.0, m->beside);
    dea_sheet_look(&m->membrane, &look, still, s->voltage, &charges);
    dea_sheet_admittance(&m->membrane, &look, m->admittance);
    for (size_t k = 0; k < places_of(m); k++) {
        m->capacitances[k] = charges.capacitances[k];
        dea_sheet_push(&m->membrane, &look, k, m->pull[k]);
        for (size_t i = 0; i < n; i++) {
            m->pull[k][i] *= 2.0 * s->voltage;
        }
    }
    return true;
}

/* (C + Y/(i w)) v = -(row of the rim in Y)/(i w) - P^T u: columns of b are v by each u, and last, without u. */
static bool spread(const mesh *m, double omega, lapack_complex_double *b)
{
    const size_t count = m->membrane.sheet.charges, n = m->membrane.nodes;
    lapack_complex_double *a = malloc(count * count * sizeof *a);
    lapack_int pivots[DEA_SHEET_PLACES];
    for (size_t k = 0; a && k < count; k++) {
        double row = -m->membrane.sheet.leak[k]; /* the sheets conserve charge: what the others do not take, the rim does */
        for (size_t l = 0; l < count; l++) {
            a[l * count + k] = m->admittance[l * count + k] / (I * omega) + (l == k ? m->capacitances[k] : 0.0);
            row += m->admittance[l * count + k];
        }
        for (size_t i = 0; i < n; i++) {
            b[i * count + k] = -m->pull[k][i];
        }
        b[n * count + k] = row / (I * omega);
    }
    const bool done = count == 0 || (a && dea_lapacke_zgesv(LAPACK_COL_MAJOR, (lapack_int)count, (lapack_int)(n + 1), a,
                                                            (lapack_int)count, pivots, b, (lapack_int)count) == 0);
    free(a);
    return done;
}

/* The motion u, with v = v_0 + (dv/du) u in b. */
static bool move(const mesh *m, double omega, const lapack_complex_double *b, lapack_complex_double *u)
{
    const dea_membrane *membrane = &m->membrane;
    const size_t count = membrane->sheet.charges, n = membrane->nodes;
    const double complex v = dea_radial_viscosity(&membrane->film, omega);
    lapack_complex_double *a = malloc(n * n * sizeof *a);
    lapack_int pivots[DEA_RINGS_NODES];
    for (size_t i = 0; a && i < n; i++) {
        u[i] = m->pull[count][i]; /* of the rim */
        for (size_t k = 0; k < count; k++) {
            u[i] += m->pull[k][i] * b[n * count + k];
        }
        for (size_t j = 0; j < n; j++) {
            a[j * n + i] = m->stiffness[j * n + i] + v * m->viscous[j * n + i] + I * (omega * m->beside[j * n + i]);
            for (size_t k = 0; k < count; k++) {
                a[j * n + i] -= m->pull[k][i] * b[j * count + k];
            }
        }
        a[i * n + i] -= membrane->masses[i] * omega * omega;
        a[i * n + i] += i == membrane->rings.edge ? I * (omega * membrane->film.damping) : 0.0;
    }
    const bool done =
        a && dea_lapacke_zgesv(LAPACK_COL_MAJOR, (lapack_int)n, 1, a, (lapack_int)n, pivots, u, (lapack_int)n) == 0;
    free(a);
    return done;
}

static bool answer_on(const mesh *m, double omega, dea_per_volt *answer)
{
    const dea_membrane *membrane = &m->membrane;
    const dea_sheet *s = &membrane->sheet;
    const size_t count = s->charges, n = membrane->nodes;
    lapack_complex_double *b = malloc((count + 1) * (n + 1) * sizeof *b), u[DEA_RINGS_NODES];
    const bool done = b && spread(m, omega, b) && move(m, omega, b, u);
    double complex charge = 0.0, leak = s->places > 0 ? -membrane->film.conductance : 0.0;
    for (size_t k = 0; done && k < places_of(m); k++) {
        double complex v = k < count ? b[n * count + k] : 1.0;
        for (size_t i = 0; i < n; i++) {
            v += k < count ? b[i * count + k] * u[i] : 0.0;
            charge += m->pull[k][i] * u[i];
        }
        charge += m->capacitances[k] * v;
        leak += s->leak[k] * v; /* none of an electrode of one potential */
    }
    if (done) {
        *answer = (dea_per_volt){.displacement = u[membrane->rings.edge], .charge = charge + leak / (I * omega)};
    }
    free(b);
    return done;
}

dea_sheets dea_sheets_open(const dea_scene *scene, const dea_model *model, double voltage)
{
    dea_sheets s = {.scene = *scene, .model = model, .voltage = voltage};
    s.scene.drive.series_resistance = (double)NAN; /* stands before the rim */
    return s;
}

void dea_sheets_close(dea_sheets *s)
{
    for (size_t i = 0; i < DEA_SHEETS_MESHES; i++) {
        free(s->meshes[i]);
        s->meshes[i] = NULL;
    }
}

static bool answer_by(dea_sheets *s, size_t level, double omega, dea_per_volt *answer)
{
    if (!s->meshes[level]) {
        s->meshes[level] = calloc(1, sizeof *s->meshes[level]);
        if (s->meshes[level] && !set_mesh(s, level, s->meshes[level])) {
            free(s->meshes[level]);
            s->meshes[level] = NULL;
        }
    }
    return s->meshes[level] && answer_on(s->meshes[level], omega, answer);
}

bool dea_sheets_answer(dea_sheets *s, double frequency, double accuracy, dea_per_volt *answer)
{
    const double omega = 2.0 * DEA_PI * frequency;
    dea_per_volt last;
    bool done = false, made = answer_by(s, 0, omega, &last);
    for (size_t level = 1; made && !done && level < DEA_SHEETS_MESHES; level++) {
        made = answer_by(s, level, omega, answer);
        done = made && cabs(answer->displacement - last.displacement) <= accuracy * cabs(answer->displacement) &&
               cabs(answer->charge - last.charge) <= accuracy * cabs(answer->charge);
        last = *answer;
    }
    return done;
}
