/* What follows from a law and its constants alone. */
#include <math.h>
#include <stdio.h>

#include "deaspice/material.h"

bool dea_law_valid(const dea_law *law, const double constants[DEA_LAW_CONSTANTS])
{
    const bool list = law->entries > 1; /* its last entries may be out of use: 0 */
    for (size_t i = 0; i < law->constant_count; i++) {
        if (!isfinite(constants[i]) || !(list || constants[i] > law->constants[i].low)) {
            return false;
        }
    }
    return !law->fault || !law->fault(constants);
}

dea_stress dea_law_stress(const dea_law *law, const double constants[DEA_LAW_CONSTANTS], double l1, double l2)
{
    return law->stress(constants, l1, l2);
}

double dea_law_energy(const dea_law *law, const double constants[DEA_LAW_CONSTANTS], double l1, double l2)
{
    return law->energy(constants, l1, l2);
}

/* A strain that no film reaches; Ogden films whose largest exponent is just above 4 hold past 1e4 without a fold. */
static const double far = 1e9;

/* Strains at which I1 - 3 = 2 y + y^-2 - 3 reaches @p most, by bisection in y = lambda^2 on either side of 1. */
static void ends_find(dea_film *film, double most)
{
    double inner[2] = {1.0, 1.0};
    double outer[2] = {0.0, 0.5 * (most + 3.0)};
    for (int side = 0; side < 2; side++) {
        for (int i = 0; i < 200; i++) {
            const double y = 0.5 * (inner[side] + outer[side]);
            *(2.0 * y + 1.0 / (y * y) - 3.0 < most ? &inner[side] : &outer[side]) = y;
        }
    }
    film->shrinks = 1.0 - sqrt(inner[0]) / film->prestretch;
    film->grows = sqrt(inner[1]) / film->prestretch - 1.0;
}

dea_film dea_law_film(const dea_law *law, const double constants[DEA_LAW_CONSTANTS], double prestretch)
{
    const double y = prestretch * prestretch;
    const double p = (prestretch - 1.0) * (prestretch + 1.0);
    dea_film film = {.law = law, .prestretch = prestretch, .breakdown = INFINITY, .square = y, .shrinks = 1.0, .grows = far};
    for (size_t i = 0; i < DEA_LAW_CONSTANTS; i++) {
        film.constants[i] = constants[i];
    }
    film.inverse_fourth = 1.0 / (y * y);
    film.j = p * p * (2.0 * y + 1.0) * film.inverse_fourth;
    film.g = p * (y * y + y + 1.0) * film.inverse_fourth;
    const double locking = law->locking ? law->locking(constants) : INFINITY;
    film.valid = dea_law_valid(law, constants) && film.j < locking;
    if (law->ends && film.valid) {
        ends_find(&film, locking);
    }
    law->prepare(&film);
    const double unstrained = 0.0;
    dea_change rest;
    law->change(&film, 1, &unstrained, &rest); /* dsigma/de = lambda dsigma/dlambda */
    const dea_stress stress = law->stress(constants, prestretch, prestretch);
    film.slope = film.modulus = rest.slope / prestretch;
    film.curvature = rest.curve / y;
    film.tension = stress.p1;
    film.w11 = stress.w11;
    film.w12 = stress.w12;
    return film;
}

const char *dea_film_fault(const dea_film *film, char text[DEA_FAULT_LENGTH])
{
    const dea_law *law = film->law;
    const double locking = law->locking ? law->locking(film->constants) : INFINITY;
    if (film->j >= locking) {
        const size_t last = law->constant_count - 1;
        snprintf(text, DEA_FAULT_LENGTH, "%s = %g is too small for the pre-stretch %g, where I1 - 3 is %.6g: the chains are straight at %.6g",
                 law->constants[last].name, film->constants[last], film->prestretch, film->j, locking);
    } else {
        snprintf(text, DEA_FAULT_LENGTH, "a number is out of its range");
    }
    return text;
}

dea_biaxial dea_film_biaxial(const dea_film *film, double e1, double e2)
{
    const dea_law *law = film->law;
    if (law->biaxial) {
        return law->biaxial(film, e1, e2);
    }
    const double l = film->prestretch;
    const dea_stress at = law->stress(film->constants, l * (1.0 + e1), l * (1.0 + e2));
    return (dea_biaxial){.p1 = law->rise(film->constants, l, l * e1, l * e2),
                         .p2 = law->rise(film->constants, l, l * e2, l * e1),
                         .w11 = at.w11,
                         .w12 = at.w12,
                         .w22 = at.w22};
}

void dea_film_biaxials(const dea_film *film, size_t count, const double *e1, const double *e2, const dea_biaxials *changes)
{
    if (film->law->biaxials) {
        film->law->biaxials(film, count, e1, e2, changes);
        return;
    }
    for (size_t i = 0; i < count; i++) {
        const dea_biaxial at = dea_film_biaxial(film, e1[i], e2[i]);
        changes->p1[i] = at.p1;
        changes->p2[i] = at.p2;
        changes->w11[i] = at.w11;
        changes->w12[i] = at.w12;
    }
}

void dea_film_changes(const dea_film *film, size_t count, const double *strains, const dea_changes *changes)
{
    if (film->law->changes) {
        film->law->changes(film, count, strains, changes);
        return;
    }
    for (size_t i = 0; i < count; i++) {
        dea_change at;
        film->law->change(film, 1, &strains[i], &at);
        changes->value[i] = at.value;
        changes->slope[i] = at.slope;
        changes->curve[i] = at.curve;
    }
}

/* As the change from the film that is not stretched, which has no stress. */
double dea_law_equibiaxial(const dea_law *law, const double constants[DEA_LAW_CONSTANTS], double stretch)
{
    const dea_film film = dea_law_film(law, constants, 1.0);
    const double strain = stretch - 1.0;
    dea_change change;
    law->change(&film, 1, &strain, &change);
    return change.value;
}

double dea_law_modulus(const dea_law *law, const double constants[DEA_LAW_CONSTANTS], double stretch)
{
    return dea_law_film(law, constants, stretch).slope;
}

double dea_material_long_term_share(const dea_material *material)
{
    double share = 1.0;
    if (material->instantaneous) {
        for (size_t i = 0; i < material->prony_count; i++) {
            share -= material->prony[i].g;
        }
    }
    return share * dea_material_stiffening(material);
}

void dea_material_long_term(const dea_material *material, double constants[DEA_LAW_CONSTANTS])
{
    const double share = dea_material_long_term_share(material);
    for (size_t i = 0; i < DEA_LAW_CONSTANTS; i++) {
        const bool scales = material->law->constants[i % material->law->constant_count].modulus;
        constants[i] = scales ? share * material->constants[i] : material->constants[i];
    }
}

double dea_material_permittivity(const dea_material *material, double stretch)
{
    return material->permittivity + material->permittivity_per_stretch * stretch;
}
