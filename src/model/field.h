/* The exact membrane on a mesh of one's own, what its order is measured with, and along its radius. */
#ifndef DEA_FIELD_H
#define DEA_FIELD_H

#include "deaspice/model.h"
#include "model/models.h"

typedef struct dea_field_mesh {
    double step;   /* longest in ln R */
    double change; /* of D by the last column of the extrapolation, relative: where it is larger the step is halved */
} dea_field_mesh;

/* The model's solve() on a mesh. */
void dea_field_solve(const dea_point *point, dea_field_mesh mesh, dea_row *row);

/* The model's along(). Right to 1e-13 of the strain. */
bool dea_field_profile(const dea_point *point, double strain, size_t count, const double *x, dea_stretches *stretches);

/* ---- The exact membrane by collocation, many points abreast. */

/* Solves @p count points of one film within @p accuracy; solved[i] says whether row i was filled. Where not, the equilibrium is far
 * from rest or near a limit of the film, there is none, its electrodes have a skin, or the accuracy is out of reach: dea_field_solve() tells. A row does not
 * depend on the other points. */
void dea_collocation_solve(const dea_point *points, size_t count, double accuracy, dea_row *rows, bool *solved);

/* ---- From what was found of the exact membrane to its row. */

/* 2 pi H R_a [m^2]: force over stress at the edge. */
double dea_field_lever(const dea_point *point);

/* What was found of a film. */
typedef struct dea_field_found {
    double strain;      /* of the disc edge [1] */
    double edge_force;  /* lambda_1 lambda_2^2 of the electroded side at R_a [1] */
    double stretch;     /* largest lambda_1 lambda_2 of the electroded region [1] */
    double capacitance; /* [F] */
    bool taut;          /* no nominal stress has fallen to 0 */
} dea_field_found;

/* The same for a row, with its force; and that row. */
dea_found dea_field_found_in(const dea_point *point, dea_field_found found);
void dea_field_fill(const dea_point *point, dea_field_found found, dea_row *row);

#endif
