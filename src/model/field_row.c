#include "model/field.h"

double dea_field_lever(const dea_point *point)
{
    return 2.0 * DEA_PI * point->film_thickness * dea_point_divide(point) / point->film.prestretch;
}

dea_found dea_field_found_in(const dea_point *point, dea_field_found found)
{
    const double nominal = dea_point_nominal_field(point), pressure = point->film.permittivity * nominal * nominal;
    return (dea_found){.strain = found.strain,
                       .force = dea_point_sign(point) * dea_field_lever(point) * pressure * found.edge_force,
                       .stretch = found.stretch,
                       .capacitance = found.capacitance,
                       .taut = found.taut};
}

void dea_field_fill(const dea_point *point, dea_field_found found, dea_row *row)
{
    dea_row_fill(row, point, dea_field_found_in(point, found));
}
