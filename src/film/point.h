/* What follows from a static point, and what a model finds of it. */
#ifndef DEA_GEOMETRY_POINT_H
#define DEA_GEOMETRY_POINT_H

#include <math.h>

#include "deaspice/model.h"

/* The part of dea_point_place() that actuator and drive alone decide: loads, second film and skin stay as they are. */
void dea_point_shape(const dea_scene *scene, dea_point *point);

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

/* U/H [V/m], in a stack the field of one layer over their number. */
static inline double dea_point_nominal_field(const dea_point *point)
{
    return point->voltage / point->film_thickness;
}

/* What a permittivity that follows the mean stretch l = sqrt(J), J = lambda_1 lambda_2, makes of the electrical energy per volume
 * -eps(l)/2 (U/H)^2 J^2: the nominal stresses -k first J^2/lambda_a and their slopes -k second (J/lambda_a)^2, -k (first + second) J
 * with k = eps (U/H)^2 of the pre-stretched film. All are 1 where it does not follow. */
typedef struct dea_electric {
    double own;    /* eps(l)/eps */
    double first;  /* own + l own'/4 */
    double second; /* first + J dfirst/dJ = own + 7 l own'/8 */
} dea_electric;

static inline dea_electric dea_film_electric(const dea_film *film, double area)
{
    if (film->electrostriction == 0.0) {
        return (dea_electric){1.0, 1.0, 1.0};
    }
    const double l = sqrt(area), rise = film->electrostriction * l, own = 1.0 + rise - film->electrostriction * film->prestretch;
    return (dea_electric){own, own + 0.25 * rise, own + 0.875 * rise};
}

/* A_cross = 2 pi r_a H/lambda_pre^2 [m^2], the cross-section of the pre-stretched film at the electrode edge. */
static inline double dea_point_cross_section(const dea_point *point)
{
    return 2.0 * DEA_PI * dea_point_divide(point) * point->film_thickness / point->film.square;
}

/* dea_film_electric() at the pre-stretch: what models that are linear about it take of a permittivity that follows the strain. */
static inline dea_electric dea_point_electric(const dea_point *point)
{
    return dea_film_electric(&point->film, point->film.square);
}

/* eps lambda_pre^4/H^2 and its electrostriction [Pa/V^2], the electrostatic stress at the pre-stretch per U^2. */
static inline double dea_point_stress_per_volt(const dea_point *point)
{
    return point->film.permittivity * dea_point_electric(point).first * point->film.square * point->film.square / (point->film_thickness * point->film_thickness);
}

/* Relative change of the electroded area under a strain of the disc edge: (1 + s)^2 - 1 of the disc (dot), of the annulus
 * between disc and frame -B^2 ((1 + s)^2 - 1)/(1 - B^2) (lens) [1]. */
static inline double dea_area_strain(dea_kind kind, double coverage, double strain)
{
    const double disc = strain * (2.0 + strain), b2 = coverage * coverage;
    return kind == DEA_DOT ? disc : -b2 * disc / (1.0 - b2);
}

/* pi eps lambda_pre^2 r^2/H, the capacitance at rest of a film with electrodes up to its frame [F]. */
static inline double dea_point_full_capacitance(const dea_point *point)
{
    const double r = point->frame_radius;
    return DEA_PI * point->film.permittivity * point->film.square * (r * r) / point->film_thickness;
}

/* Capacitance at rest [F]: eps lambda_pre^2/H times pi r_a^2 (dot) or pi (r^2 - r_a^2) (lens). */
static inline double dea_point_capacitance(const dea_point *point)
{
    const double b2 = point->coverage * point->coverage;
    return dea_point_full_capacitance(point) * (point->kind == DEA_DOT ? b2 : 1.0 - b2);
}

/* Capacitance of a dot's uniform disc, C_0 lambda_a^4 eps(lambda)/eps [F]. */
static inline double dea_point_disc_capacitance(const dea_point *point, double strain)
{
    const double square = (1.0 + strain) * (1.0 + strain);
    return dea_point_capacitance(point) * square * square * dea_film_electric(&point->film, point->film.square * square).own;
}

/* dsigma/dlambda that the skin adds to the electroded film at the pre-stretch, t lambda_pre/H Y_e(1) [Pa]. */
static inline double dea_point_skin_modulus(const dea_point *point)
{
    return point->skin_share > 0.0 ? point->skin_share * point->film.prestretch * point->skin.slope : 0.0;
}

/* Adds what the skin does to the nominal stresses and moduli of the electroded film, t lambda_pre/H dW_e/dlambda. */
static inline void dea_point_coat(const dea_point *point, double e1, double e2, dea_biaxial *film)
{
    const dea_biaxial skin = dea_film_biaxial(&point->skin, e1, e2);
    const double share = point->skin_share, force = share * point->film.prestretch;
    film->p1 += force * skin.p1;
    film->p2 += force * skin.p2;
    film->w11 += share * skin.w11;
    film->w12 += share * skin.w12;
    film->w22 += share * skin.w22;
}

/* Stresses and moduli of the film under its electrode, without what the voltage does. */
static inline dea_stress dea_point_coated_stress(const dea_point *point, double l1, double l2)
{
    dea_stress film = point->film.law->stress(point->film.constants, l1, l2);
    if (point->skin_share > 0.0) {
        const double pre = point->film.prestretch, share = point->skin_share, force = share * pre;
        const dea_stress skin = point->skin.law->stress(point->skin.constants, l1 / pre, l2 / pre);
        film.shear += share * skin.shear;
        film.p1 += force * skin.p1;
        film.p2 += force * skin.p2;
        film.w11 += share * skin.w11;
        film.w12 += share * skin.w12;
        film.w22 += share * skin.w22;
    }
    return film;
}

/* Nominal stress of the skin in the film under it at lambda_pre + d1, lambda_pre + d2 [Pa]; keeps its digits. */
static inline double dea_point_skin_rise(const dea_point *point, double d1, double d2)
{
    const double pre = point->film.prestretch;
    return point->skin_share > 0.0
               ? point->skin_share * pre * point->skin.law->rise(point->skin.constants, 1.0, d1 / pre, d2 / pre)
               : 0.0;
}

/* A row without numbers. */
static inline void dea_row_refuse(dea_row *row, dea_state state)
{
    *row = dea_row_failed();
    row->state = state;
}

/* What a model finds of a point. */
typedef struct dea_found {
    double strain;
    double force;       /* [N] */
    double stretch;     /* lambda_1 lambda_2 of the electroded film at its most stretched place [1] */
    double capacitance; /* [F] */
    bool taut;          /* every region is in tension */
} dea_found;

/* A film whose edge is held at a strain. */
typedef struct dea_hold {
    bool plain; /* set by the caller: slopes are not wanted, and 0 where they cost anything */
    dea_found found;
    double held, held_slope; /* what the film without voltage pulls inward [N], and its slope over u [N/m] */
    double push, push_slope; /* what the voltage adds outward [N], [N/m] */
} dea_hold;

/* True where something moves the edge without the voltage of the film. */
static inline bool dea_point_is_pulled(const dea_point *point)
{
    return point->force != 0.0 || point->second.there;
}

/* True where more acts on the edge than a model's own equation knows: its film and a linear spring. */
static inline bool dea_point_is_shared(const dea_point *point)
{
    return point->spring_count > 0 || dea_point_is_pulled(point);
}

/* True where the film is not alone with its edge: what its two regions hold then differs. */
static inline bool dea_point_is_loaded(const dea_point *point)
{
    return point->load > 0.0 || dea_point_is_shared(point);
}

/* What the springs hold against a displacement u of the edge. */
static inline dea_spring dea_point_spring(const dea_point *point, double u)
{
    dea_spring sum = {point->load * u, point->load};
    for (size_t i = 0; i < point->spring_count; i++) {
        const dea_spring one = point->springs[i].kind->spring(point->springs[i].number, u);
        sum.force += one.force;
        sum.slope += one.slope;
    }
    return sum;
}

/* The second film as a point of its own, without what else acts on the edge. */
static inline dea_point dea_point_second(const dea_point *point)
{
    const dea_second *second = &point->second;
    dea_point other = {.film = second->film,
                       .kind = second->kind,
                       .frame_radius = point->frame_radius,
                       .coverage = point->coverage,
                       .film_thickness = second->film_thickness,
                       .layers = second->layers,
                       .voltage = second->voltage,
                       .focal_length = (double)NAN,
                       .refractive_index = (double)NAN};
    return other;
}

/* Fills a row from what the model found and what follows from that. */
static inline void dea_row_fill(dea_row *row, const dea_point *point, dea_found found)
{
    const double field = fabs(dea_point_nominal_field(point) * point->layers * found.stretch);
    const double radius = dea_point_divide(point);
    const double displacement = found.strain * radius;
    const bool insulates = dea_film_electric(&point->film, found.stretch).own > 0.0; /* no film has a permittivity below */
    if (!(isfinite(found.strain) && isfinite(displacement) && isfinite(found.force) && isfinite(field) && insulates)) {
        dea_row_refuse(row, DEA_STATE_FAILED);
        return;
    }
    row->strain = found.strain;
    row->displacement = displacement;
    row->force = found.force;
    row->field = field;
    row->capacitance = found.capacitance;
    row->charge = found.capacitance * point->voltage;
    row->energy = 0.5 * row->charge * point->voltage;
    row->second_field = 0.0;
    row->area_strain = dea_area_strain(point->kind, point->coverage, found.strain);
    row->focal_length = isnan(point->focal_length)
                            ? (double)NAN
                            : dea_lens_focal_length(point->focal_length, point->refractive_index, radius, found.strain);
    row->state = field > point->film.breakdown ? DEA_STATE_BREAKDOWN : found.taut ? DEA_STATE_OK : DEA_STATE_SLACK;
}

#endif
