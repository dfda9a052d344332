/** @file material.h
 * Incompressible Yeoh film (Eq. 11) and what follows from it at a pre-stretch.
 */
#ifndef DEASPICE_MATERIAL_H
#define DEASPICE_MATERIAL_H

#include <stdbool.h>

#include "deaspice/status.h"

#ifdef __cplusplus
extern "C" {
#endif

/** Permittivity of free space [F/m]. */
#define DEA_EPSILON_0 8.8541878128e-12
#define DEA_PI 3.14159265358979323846

enum { DEA_YEOH_TERMS = 3, DEA_PRONY_MAX = 64, DEA_NAME_LENGTH = 64, DEA_SOURCE_LENGTH = 256 };

/** One branch of a Prony series. */
typedef struct dea_prony {
    double g;   /**< share of the instantaneous modulus [1], > 0; their sum < 1 */
    double tau; /**< relaxation time [s], > 0 */
} dea_prony;

/** Film material. Scalars that a scene does not give are NAN. */
typedef struct dea_material {
    char name[DEA_NAME_LENGTH];         /**< built-in name, file name or "scene" */
    char source[DEA_SOURCE_LENGTH];     /**< where the numbers come from, may be empty */
    double yeoh[DEA_YEOH_TERMS];        /**< C1, C2, C3 [Pa], C1 > 0, default C2 = C3 = 0 */
    double permittivity;                /**< relative, at stretch 0 of the line below [1], > 0 */
    double permittivity_per_stretch;    /**< slope of the relative permittivity over stretch [1], default 0 */
    double density;                     /**< [kg/m^3], > 0, NAN: no inertia */
    double retardation;                 /**< Kelvin-Voigt retardation time [s], > 0, NAN: none */
    double modulus;                     /**< operating modulus Y [Pa], > 0, NAN: dsigma/dlambda at the pre-stretch */
    double breakdown;                   /**< breakdown strength [V/m], > 0, NAN: never breaks down */
    double stretches[2];                /**< least and largest stretch that the data behind the constants cover [1], 0: not known */
    bool instantaneous;                 /**< elastic constants are instantaneous (true) or long-term (false, default) */
    size_t prony_count;                 /**< branches in use */
    dea_prony prony[DEA_PRONY_MAX];     /**< relaxation of the instantaneous modulus */
} dea_material;

/** Principal in-plane nominal stresses and tangent moduli of the passive film at stretches l1, l2 [Pa]. */
typedef struct dea_stress {
    double w;             /**< dW/dI */
    double p1, p2;        /**< nominal stresses dW/dl1, dW/dl2 */
    double w11, w12, w22; /**< tangent moduli d2W/dl1^2, d2W/dl1 dl2, d2W/dl2^2 */
} dea_stress;

/** A material without any number: every optional scalar NAN, C2 = C3 = 0. */
DEA_API dea_material dea_material_default(void);

/** Number of built-in materials. */
DEA_API size_t dea_material_count(void);
/** Built-in material number @p index, NULL past the end. The library owns it. */
DEA_API const dea_material *dea_material_builtin(size_t index);
/** Built-in material by name, NULL if there is none. The library owns it. */
DEA_API const dea_material *dea_material_find(const char *name);

/** Long-term share of the given elastic constants [1]: 1 - sum g_i where they are instantaneous, else 1. */
DEA_API double dea_material_long_term_share(const dea_material *material);
/** Long-term Yeoh constants [Pa], 3 values. */
DEA_API void dea_material_long_term(const dea_material *material, double yeoh[DEA_YEOH_TERMS]);
/** Relative permittivity at stretch @p stretch [1]. */
DEA_API double dea_material_permittivity(const dea_material *material, double stretch);

/** Stresses and tangent moduli of a Yeoh film (physics: W = sum C_i (I - 3)^i), l1, l2 > 0. */
DEA_API dea_stress dea_yeoh_stress(const double yeoh[DEA_YEOH_TERMS], double l1, double l2);
/** Strain energy per reference volume W [Pa]. */
DEA_API double dea_yeoh_energy(const double yeoh[DEA_YEOH_TERMS], double l1, double l2);
/** Equi-biaxial Cauchy stress sigma = 2 (l^2 - l^-4) w [Pa]. */
DEA_API double dea_yeoh_equibiaxial(const double yeoh[DEA_YEOH_TERMS], double stretch);
/** Operating modulus Y = dsigma/dl of the equi-biaxial Cauchy stress [Pa]. */
DEA_API double dea_yeoh_modulus(const double yeoh[DEA_YEOH_TERMS], double stretch);

#ifdef __cplusplus
}
#endif
#endif
