/* The exact membrane on a mesh of one's own, what its order is measured with, and along its radius. */
#ifndef DEA_FIELD_H
#define DEA_FIELD_H

#include "deaspice/model.h"

typedef struct dea_field_mesh {
    double step;   /* longest in ln R */
    double change; /* of D by the last column of the extrapolation, relative: where it is larger the step is halved */
} dea_field_mesh;

/* The model's solve() on a mesh. */
void dea_field_solve(const dea_point *point, dea_field_mesh mesh, dea_row *row);

/* The model's along(). Right to 1e-13 of the strain. */
bool dea_field_profile(const dea_point *point, double strain, size_t count, const double *x, dea_stretches *stretches);

#endif
