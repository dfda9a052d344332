/* From what was found of the exact membrane to its row. */
#ifndef DEA_FIELD_ROW_H
#define DEA_FIELD_ROW_H

#include "model/models.h"

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
