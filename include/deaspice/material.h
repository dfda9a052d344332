/** @file material.h
 * Incompressible hyperelastic films: their laws, their constants, and what follows from them at a pre-stretch.
 */
#ifndef DEASPICE_MATERIAL_H
#define DEASPICE_MATERIAL_H

#include <stdbool.h>
#include <stddef.h>

#include "deaspice/status.h"

#ifdef __cplusplus
extern "C" {
#endif

/** Permittivity of free space [F/m]. */
#define DEA_EPSILON_0 8.8541878128e-12
#define DEA_PI 3.14159265358979323846

/** Most constants of a law, starts of a fit, most branches, rows of a table of shift factors, lengths of texts. */
enum { DEA_LAW_CONSTANTS = 8, DEA_LAW_STARTS = 4, DEA_PRONY_MAX = 64, DEA_SHIFT_MOST = 64, DEA_NAME_LENGTH = 64, DEA_SOURCE_LENGTH = 256 };

struct dea_film;
struct dea_law_form;
struct dea_pool;

/** Principal in-plane nominal stresses and tangent moduli of the passive film at stretches l1, l2 [Pa]. */
typedef struct dea_stress {
    double shear;         /**< (p2 - p1)/(l2 - l1), w11 - w12 where l1 = l2 */
    double p1, p2;        /**< nominal stresses dW/dl1, dW/dl2 */
    double w11, w12, w22; /**< tangent moduli d2W/dl1^2, d2W/dl1 dl2, d2W/dl2^2 */
} dea_stress;

/** Change of the equi-biaxial Cauchy stress from the pre-stretch to lambda_pre (1 + e), and its derivatives over e [Pa]. */
typedef struct dea_change {
    double value, slope, curve;
} dea_change;

/** Changes of the nominal stresses from the equi-biaxial pre-stretch to lambda_pre (1 + e1), lambda_pre (1 + e2), and the tangent
 * moduli there [Pa]. */
typedef struct dea_biaxial {
    double p1, p2;
    double w11, w12, w22;
} dea_biaxial;

/** Where the changes of many strains go: arrays of as many values [Pa]. */
typedef struct dea_changes {
    double *value, *slope, *curve;
} dea_changes;

/** Where those of many pairs of strains go [Pa]. */
typedef struct dea_biaxials {
    double *p1, *p2;
    double *w11, *w12;
} dea_biaxials;

/** One constant of a law. */
typedef struct dea_constant {
    const char *name;     /**< e.g. "C1" */
    const char *unit;     /**< "Pa" or "1" */
    bool modulus;         /**< a stress: a long-term share scales it */
    double low;           /**< must lie above this [unit], -inf: anywhere */
    double standard;      /**< default [unit], NAN: must be given */
    const char *accepted; /**< range and an example, for messages */
} dea_constant;

/** A law: a strain energy W(l1, l2) of an incompressible film under plane stress. One row of a table (src/material/laws.c), one
 * file a row. Constants are an array of DEA_LAW_CONSTANTS, 0 where the law has no such constant; those of a list stand entry after
 * entry. The functions take them long-term and in range, and return NAN where the energy has ended. */
typedef struct dea_law {
    const char *name;              /**< key in a scene, e.g. "yeoh" */
    const char *title;             /**< e.g. "Yeoh" */
    const char *energy_text;       /**< W in words of its constants */
    const char *accepted;          /**< how a scene gives the constants, with an example, for messages */
    const dea_constant *constants; /**< constant_count of them; where it is a list, those of one entry */
    size_t constant_count;         /**< >= 1 */
    size_t entries;                /**< 1: a mapping of constants; more: a list of at most so many such mappings */
    bool linear;                   /**< its stresses are linear in the constants */
    double starts[DEA_LAW_STARTS]; /**< where it is not: from where a fit looks for the constants that are no modulus [1] */
    /** What is wrong with constants that are each in range, NULL: nothing. NULL: nothing ever is. */
    const char *(*fault)(const double *constants);
    /** I1 - 3 at which the chains are straight [1]: no film is pre-stretched so far. NULL: never. */
    double (*locking)(const double *constants);
    /** Whether the energy ends there (true) or goes on (false). */
    bool ends;
    /** W [Pa]; keeps its digits however close to 1 the stretches are. */
    double (*energy)(const double *constants, double l1, double l2);
    dea_stress (*stress)(const double *constants, double l1, double l2);
    /** W11 at equi-biaxial stretch l in long double, for what is left where terms of the size of it cancel [Pa]; NULL: that of
     * stress() has to do. */
    long double (*fine_w11)(const double *constants, long double l);
    /** P1(l + d1, l + d2) - P1(l, l) [Pa]; keeps its digits however small d1 and d2 are. */
    double (*rise)(const double *constants, double l, double d1, double d2);
    /** Notes in film->rest what change() wants to know of the film's pre-stretch. */
    void (*prepare)(struct dea_film *film);
    /** Changes of the equi-biaxial Cauchy stress at @p count strains; keep their digits however small the strains are. */
    void (*change)(const struct dea_film *film, size_t count, const double *strains, dea_change *changes);
    /** Both nominal stresses and the moduli at once, as exact as rise(). NULL: they are made of rise() and stress(). */
    dea_biaxial (*biaxial)(const struct dea_film *film, double e1, double e2);
    /** change() and biaxial() of @p count strains, a multiple of 8, abreast: the same digits, sooner. NULL: one after the other. */
    void (*changes)(const struct dea_film *film, size_t count, const double *strains, const dea_changes *changes);
    void (*biaxials)(const struct dea_film *film, size_t count, const double *e1, const double *e2, const dea_biaxials *changes);
    /** The same law as expressions, for networks: constants and stretches l1, l2 are terms of a pool (src/material/form.h). */
    void (*form)(struct dea_pool *pool, const int *constants, int l1, int l2, struct dea_law_form *form);
} dea_law;

/** One branch of a Prony series. */
typedef struct dea_prony {
    double g;   /**< share of the instantaneous modulus [1], > 0; their sum < 1 */
    double tau; /**< relaxation time [s], > 0 */
} dea_prony;

/** Shift factor a_T of all relaxation times over the temperature: by Williams, Landel and Ferry, log10 a_T = -C1 (T - T_r)/(C2 + T -
 * T_r), or by a table, evenly in ln a_T between its rows. */
typedef struct dea_shift {
    double c1;        /**< [1], > 0, NAN: no such law */
    double c2;        /**< [K], > 0 */
    double reference; /**< T_r, where a_T is 1 [K], > 0 */
    size_t count;     /**< rows of the table, 0: none, else >= 2; it goes before the law */
    double table[DEA_SHIFT_MOST][2]; /**< temperature, rising [K], and a_T, > 0 [1] */
} dea_shift;

/** Film material. Scalars that a scene does not give are NAN. */
typedef struct dea_material {
    char name[DEA_NAME_LENGTH];         /**< built-in name, file name or "scene" */
    char source[DEA_SOURCE_LENGTH];     /**< where the numbers come from, may be empty */
    const dea_law *law;                 /**< of the constants */
    double constants[DEA_LAW_CONSTANTS]; /**< of the law, 0 beyond those in use */
    size_t entry_count;                 /**< entries in use of a law that is a list, else 1 */
    double permittivity;                /**< relative, at stretch 0 of the line below [1], > 0 */
    double permittivity_per_stretch;    /**< slope of the relative permittivity over stretch [1], default 0 */
    bool permittivity_follows;          /**< it is that of the strained film (true) or of the pre-stretched one (false, default) */
    double density;                     /**< [kg/m^3], > 0, NAN: no inertia */
    double retardation;                 /**< Kelvin-Voigt retardation time [s], > 0, NAN: none */
    double modulus;                     /**< operating modulus Y [Pa], > 0, NAN: dsigma/dlambda at the pre-stretch */
    double breakdown;                   /**< breakdown strength [V/m], > 0, NAN: never breaks down */
    double stretches[2];                /**< least and largest stretch that the data behind the constants cover [1], 0: not known */
    double temperature;                 /**< of the film [K], > 0, NAN: that of the data */
    double modulus_slope;               /**< change of all moduli over the temperature, over them at the reference [1/K], NAN: none */
    double modulus_reference;           /**< temperature at which the moduli were measured [K], > 0 */
    dea_shift shift;                    /**< of the relaxation times */
    bool instantaneous;                 /**< elastic constants are instantaneous (true) or long-term (false, default) */
    size_t prony_count;                 /**< branches in use */
    dea_prony prony[DEA_PRONY_MAX];     /**< relaxation of the instantaneous modulus */
} dea_material;

/** The film at its pre-stretch: all that depends on material and pre-stretch alone, so that a sweep computes it once.
 * With y = lambda_pre^2: J = I1 - 3, g = y - y^-2. */
typedef struct dea_film {
    const dea_law *law;
    double constants[DEA_LAW_CONSTANTS]; /**< long-term */
    bool valid;                          /**< constants in range, and the pre-stretch where the law holds */
    double prestretch;                   /**< lambda_pre [1] */
    double permittivity;                 /**< absolute permittivity at the pre-stretch, of a stack times layers^2 [F/m] */
    double electrostriction;             /**< slope of the permittivity over the mean stretch, over that at the pre-stretch, where it
                                            follows the strain, else 0 [1] */
    double breakdown;                    /**< breakdown strength [V/m], +inf: none */
    double slope;                        /**< dsigma/dlambda at the pre-stretch [Pa] */
    double curvature;                    /**< d2sigma/dlambda2 at the pre-stretch [Pa] */
    double modulus;                      /**< operating modulus Y [Pa]: the scene's, else slope */
    double tension;                      /**< nominal stress at the pre-stretch [Pa] */
    double w11, w12;                     /**< tangent moduli at the pre-stretch [Pa] */
    double square;                       /**< lambda_pre^2 [1] */
    double inverse_fourth;               /**< lambda_pre^-4 [1] */
    double j, g;                         /**< J, g at the pre-stretch [1] */
    double shrinks, grows;               /**< strains from the pre-stretch at which the film or its energy ends, both > 0 [1] */
    double rest[DEA_LAW_CONSTANTS];      /**< what the law noted by prepare() */
} dea_film;

/** A material without any number: every optional scalar NAN, a Yeoh film whose C1 is NAN. */
DEA_API dea_material dea_material_default(void);

/** Number of built-in materials. */
DEA_API size_t dea_material_count(void);
/** Built-in material number @p index, NULL past the end. The library owns it. */
DEA_API const dea_material *dea_material_builtin(size_t index);
/** Built-in material by name, NULL if there is none. The library owns it. */
DEA_API const dea_material *dea_material_find(const char *name);

/** Shift factor a_T of the relaxation times at the material's temperature [1]; NAN where its law or table does not reach. */
DEA_API double dea_material_shift(const dea_material *material);
/** Moduli at the material's temperature over those given [1], 1 + slope (T - T_ref); <= 0 where no film is left. */
DEA_API double dea_material_stiffening(const dea_material *material);
/** Branch number @p index at the material's temperature. */
DEA_API dea_prony dea_material_branch(const dea_material *material, size_t index);
/** What is left of the given elastic constants in the long term and at the temperature [1]: dea_material_stiffening(), times
 * 1 - sum g_i where they are instantaneous. */
DEA_API double dea_material_long_term_share(const dea_material *material);
/** Constants of the law with their moduli long-term and at the temperature, DEA_LAW_CONSTANTS values. */
DEA_API void dea_material_long_term(const dea_material *material, double constants[DEA_LAW_CONSTANTS]);
/** Relative permittivity at stretch @p stretch [1]. */
DEA_API double dea_material_permittivity(const dea_material *material, double stretch);

/** Number of laws. */
DEA_API size_t dea_law_count(void);
/** Law number @p index, NULL past the end. The library owns it. */
DEA_API const dea_law *dea_law_at(size_t index);
/** Law by name, NULL if there is none. The library owns it. */
DEA_API const dea_law *dea_law_find(const char *name);
/** True where every constant is in its range and they fit together. */
DEA_API bool dea_law_valid(const dea_law *law, const double constants[DEA_LAW_CONSTANTS]);
/** Stresses and tangent moduli, l1, l2 > 0; NAN where the energy has ended. */
DEA_API dea_stress dea_law_stress(const dea_law *law, const double constants[DEA_LAW_CONSTANTS], double l1, double l2);
/** Strain energy per reference volume W [Pa]. */
DEA_API double dea_law_energy(const dea_law *law, const double constants[DEA_LAW_CONSTANTS], double l1, double l2);
/** Equi-biaxial Cauchy stress sigma = lambda P1(lambda, lambda) [Pa]. */
DEA_API double dea_law_equibiaxial(const dea_law *law, const double constants[DEA_LAW_CONSTANTS], double stretch);
/** Operating modulus Y = dsigma/dlambda of the equi-biaxial Cauchy stress [Pa]. */
DEA_API double dea_law_modulus(const dea_law *law, const double constants[DEA_LAW_CONSTANTS], double stretch);
/** Changes of both nominal stresses of a film from its pre-stretch, and moduli; NAN where the energy has ended. */
DEA_API dea_biaxial dea_film_biaxial(const dea_film *film, double e1, double e2);
/** Those of @p count pairs of strains, and the changes of the equi-biaxial Cauchy stress of @p count strains, a multiple of 8. */
DEA_API void dea_film_biaxials(const dea_film *film, size_t count, const double *e1, const double *e2, const dea_biaxials *changes);
DEA_API void dea_film_changes(const dea_film *film, size_t count, const double *strains, const dea_changes *changes);
/** Film of a law at rest under an equi-biaxial pre-stretch >= 0, its permittivity 0, without breakdown. */
DEA_API dea_film dea_law_film(const dea_law *law, const double constants[DEA_LAW_CONSTANTS], double prestretch);
/** Room for what dea_film_fault() writes. */
enum { DEA_FAULT_LENGTH = 160 };
/** Why a film that is not valid, or whose scene is not, cannot rest: the constant whose straight chains the pre-stretch passes, else
 * only that a number is out of its range; into @p text, which is returned. */
DEA_API const char *dea_film_fault(const dea_film *film, char text[DEA_FAULT_LENGTH]);

#ifdef __cplusplus
}
#endif
#endif
