/* The entries of the model table, one file each, and what those files share. */
#ifndef DEA_MODELS_H
#define DEA_MODELS_H

#include <math.h>

#include "deaspice/model.h"

extern const dea_model dea_model_pelrine;
extern const dea_model dea_model_constant_force;
extern const dea_model dea_model_lumped;
extern const dea_model dea_model_coverage;
extern const dea_model dea_model_lame;
extern const dea_model dea_model_ring;
extern const dea_model dea_model_field;

/* +1 for a dot (the disc grows), -1 for a lens (the disc shrinks). */
static inline double dea_point_sign(const dea_point *point)
{
    return point->kind == DEA_DOT ? 1.0 : -1.0;
}

/* r_a = B r [m]. */
static inline double dea_point_divide(const dea_point *point)
{
    return point->coverage * point->frame_radius;
}

/* U/H [V/m]. */
static inline double dea_point_nominal_field(const dea_point *point)
{
    return point->voltage / point->film_thickness;
}

/* A_cross = 2 pi r_a H/lambda_pre^2 [m^2], the cross-section of the pre-stretched film at the electrode edge. */
static inline double dea_point_cross_section(const dea_point *point)
{
    return 2.0 * DEA_PI * dea_point_divide(point) * point->film_thickness / point->film.square;
}

/* eps lambda_pre^4/H^2 [Pa/V^2], the electrostatic stress at the pre-stretch per U^2. */
static inline double dea_point_stress_per_volt(const dea_point *point)
{
    return point->film.permittivity * point->film.square * point->film.square / (point->film_thickness * point->film_thickness);
}

/* Capacitance at rest [F]: eps lambda_pre^2/H times pi r_a^2 (dot) or pi (r^2 - r_a^2) (lens). */
static inline double dea_point_capacitance(const dea_point *point)
{
    const double b2 = point->coverage * point->coverage;
    const double area = DEA_PI * point->frame_radius * point->frame_radius * (point->kind == DEA_DOT ? b2 : 1.0 - b2);
    return point->film.permittivity * point->film.square / point->film_thickness * area;
}

/* A row without numbers. */
static inline void dea_row_refuse(dea_row *row, dea_state state)
{
    *row = (dea_row){NAN, NAN, NAN, NAN, state};
}

/* Fills a row. Strain, force [N] and stretch^2 of the electroded film (area ratio at its most stretched place) come from the
 * model; taut says whether every region is in tension. */
static inline void dea_row_fill(dea_row *row, const dea_point *point, double strain, double force, double area_stretch, bool taut)
{
    const double field = fabs(dea_point_nominal_field(point) * area_stretch);
    const double displacement = strain * dea_point_divide(point);
    if (!(isfinite(strain) && isfinite(displacement) && isfinite(force) && isfinite(field))) {
        dea_row_refuse(row, DEA_STATE_FAILED);
        return;
    }
    row->strain = strain;
    row->displacement = displacement;
    row->force = force;
    row->field = field;
    row->state = field > point->film.breakdown ? DEA_STATE_BREAKDOWN : taut ? DEA_STATE_OK : DEA_STATE_SLACK;
}

#endif
