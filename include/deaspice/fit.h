/** @file fit.h
 * Constants of a law from measured stress over stretch, Prony branches from a test of relaxation, of creep, or of dynamic moduli.
 */
#ifndef DEASPICE_FIT_H
#define DEASPICE_FIT_H

#include <stdio.h>

#include "deaspice/material.h"

#ifdef __cplusplus
extern "C" {
#endif

/** Most Yeoh constants, most terms that can be asked for, most laws that are compared, fewest points of a relaxation test, most branches of a fit. */
enum { DEA_YEOH_TERMS = 3, DEA_LAW_TERMS = 4, DEA_FIT_CHOICES = 16, DEA_RELAXATION_LEAST = 3, DEA_RELAXATION_MOST = 10 };

/** How a specimen was loaded. */
typedef enum dea_load { DEA_LOAD_UNIAXIAL, DEA_LOAD_EQUIBIAXIAL, DEA_LOAD_COUNT, DEA_LOAD_UNKNOWN = DEA_LOAD_COUNT } dea_load;

/** One measured point. */
typedef struct dea_fit_point {
    double stretch; /**< along the load [1], > 0 */
    double stress;  /**< nominal (engineering) stress [Pa] */
    dea_load load;  /**< never DEA_LOAD_UNKNOWN */
} dea_fit_point;

/** Size of a specimen at rest, for tables of displacement and force. */
typedef struct dea_specimen {
    double length; /**< between the clamps [m], > 0, 0: not known */
    double area;   /**< cross-section [m^2], > 0, 0: not known */
} dea_specimen;

/** Measured points; zeroed: none. Owns its points; free with dea_fit_data_free(). */
typedef struct dea_fit_data {
    dea_fit_point *points;
    size_t count, room;              /**< points in use, points allocated */
    dea_specimen specimen;           /**< of the tables that are read next */
    char columns[DEA_SOURCE_LENGTH]; /**< what each column of the table that was read last was taken for, in words */
} dea_fit_data;

/** A number of constants that was tried. */
typedef struct dea_fit_trial {
    double residual_relative; /**< as in dea_fit [1], NAN: not tried, or not determined by the data */
    double p;                 /**< chance that noise gains as much by the last constant (F test) [1], NAN: not testable */
} dea_fit_trial;

/** A law that was tried, with so many constants. */
typedef struct dea_fit_choice {
    const dea_law *law;
    int terms;                /**< constants in use */
    double residual_relative; /**< as in dea_fit [1] */
    double criterion;         /**< Akaike's, n ln(S/n) + 2 K + 2 K (K + 1)/(n - K - 1) with n points, K = terms + 1 and the weighted sum of
                                 squares S as a share of the weighted stresses: the least is the best; NAN: too few points */
} dea_fit_choice;

/** Fitted constants and how good they are. */
typedef struct dea_fit {
    int terms;                        /**< constants in use, 1 to DEA_LAW_CONSTANTS */
    const dea_law *law;               /**< of the constants */
    double constants[DEA_LAW_CONSTANTS]; /**< C_i [Pa], 0 beyond terms */
    double deviation[DEA_LAW_CONSTANTS]; /**< standard errors of the constants, given the terms; NAN where points = terms */
    dea_fit_trial trials[DEA_LAW_CONSTANTS]; /**< of a law that can do with fewer: 1 constant, 2, ... */
    dea_fit_choice choices[DEA_FIT_CHOICES]; /**< laws, or numbers of terms, that were compared by the criterion */
    size_t choice_count;                     /**< 0: none were */
    double criterion;                        /**< of this fit, as in dea_fit_choice */
    double residual_rms;                  /**< root mean square of (measured - fitted) [Pa] */
    double residual_relative;             /**< residual_rms over the rms of the measured stress [1] */
    double r_squared;                     /**< 1 - sum of squared residuals / sum of squared deviations from the mean [1]; NAN: all stresses are alike */
    double condition;                     /**< condition number of the column-scaled problem [1] */
    size_t count[DEA_LOAD_COUNT];         /**< points of each load */
    double stretch_min, stretch_max;      /**< range of the data [1] */
    double unstable_stretch; /**< smallest stretch of the range where a tangent modulus is not positive [1], NAN: none */
    double unloads_from;     /**< largest stretch before the data go back by a fifth of their range [1], NAN: they do not */
} dea_fit;


/** Reads a table of measured points and appends it to @p data.
 *
 * Fields apart by comma, semicolon, tab or blanks; decimal comma where the fields stand apart by another sign; comments (#),
 * blank lines and title lines are skipped. The header names columns with their units (`stress_kPa`, `Stress (MPa)`, or a row of
 * units): stretch, strain (a ratio or percent) or displacement; nominal stress or force; optionally `mode` (uniaxial or
 * equibiaxial). Displacement and force want the specimen of @p data. Other columns are left alone.
 * @param path file name, "-" for standard input; only regular files and pipes are read, at most 64 MiB
 * @param load of all points of a file without the column `mode`
 * @return DEA_OK, DEA_ERROR_SCENE (message "file:line:column: ..."), DEA_ERROR_IO, DEA_ERROR_MEMORY; @p data is as before on
 * failure
 */
DEA_API dea_status dea_fit_read(const char *path, dea_load load, dea_fit_data *data, dea_error *error);
/** Same from memory; @p name stands in messages. */
DEA_API dea_status dea_fit_parse(const char *text, size_t length, const char *name, dea_load load, dea_fit_data *data,
                                 dea_error *error);
/** Appends one point. @return DEA_OK, DEA_ERROR_USAGE (a number out of range), DEA_ERROR_MEMORY */
DEA_API dea_status dea_fit_add(dea_fit_data *data, dea_fit_point point, dea_error *error);
/** Frees what the data owns; NULL and zeroed data are fine. */
DEA_API void dea_fit_data_free(dea_fit_data *data);

/** Fits @p terms Yeoh constants to all points.
 *
 * @param terms 1 to DEA_YEOH_TERMS; 0: the largest number whose last constant an F test finds significant at 5 %
 * @param relative weighs each point by 1/|stress|, or by 1/(1 % of the largest |stress|) where that is less: relative errors
 * count
 * @return DEA_OK, DEA_ERROR_USAGE (terms; the data does not determine the constants), DEA_ERROR_DATA (the stretches are percent
 * or strain; C1 is not positive by two standard errors), DEA_ERROR_MEMORY
 */
DEA_API dea_status dea_fit_yeoh(const dea_fit_data *data, int terms, bool relative, dea_fit *fit, dea_error *error);
/** Fits the constants of a law to all points: those that its stress is linear in by LAPACK, others by cminpack.
 *
 * @param terms of Yeoh the constants, of a list the entries; 0: as many as an F test finds significant at 5 %, of a list those
 * with the least criterion of dea_fit_choice
 * @return as dea_fit_yeoh(), and DEA_ERROR_MISSING (a library)
 */
DEA_API dea_status dea_fit_law(const dea_fit_data *data, const dea_law *law, int terms, bool relative, dea_fit *fit,
                               dea_error *error);
/** Fits every law and keeps the one with the least criterion; fit->choices has them all. @return as dea_fit_law() */
DEA_API dea_status dea_fit_auto(const dea_fit_data *data, bool relative, dea_fit *fit, dea_error *error);
/** Nominal stress of a material [Pa] at @p stretch under @p load. */
DEA_API double dea_fit_stress(const dea_law *law, const double constants[DEA_LAW_CONSTANTS], dea_load load, double stretch);

/** How a viscoelastic film was tested. */
typedef enum dea_test_kind {
    DEA_TEST_RELAXATION, /**< stress over time at a held stretch */
    DEA_TEST_DYNAMIC,    /**< storage and loss modulus over the frequency of small swings (DMA) */
    DEA_TEST_CREEP,      /**< strain, or compliance, over time under a held stress */
    DEA_TESTS
} dea_test_kind;

/** One measured point of such a test. */
typedef struct dea_relaxation_point {
    double time;   /**< since the end of the ramp [s], >= 0; of a dynamic test the angular frequency [rad/s], > 0 */
    double stress; /**< at the held stretch, nominal or true [Pa]; not below minus a tenth of the largest, which is noise about 0; the
                        storage modulus of a dynamic test [Pa]; of a creep test the strain [1], or the compliance in any unit */
    double loss;   /**< loss modulus of a dynamic test [Pa], else 0 */
} dea_relaxation_point;

/** One test; zeroed: a relaxation after a step without points. Owns its points; free with dea_relaxation_data_free(). */
typedef struct dea_relaxation_data {
    dea_test_kind kind;              /**< default DEA_TEST_RELAXATION */
    dea_relaxation_point *points;    /**< times increasing */
    size_t count, room;              /**< points in use, points allocated */
    double ramp;                     /**< duration of the ramp before the hold [s], >= 0, default 0: an ideal step; 0 of a dynamic test */
    dea_specimen specimen;           /**< of the table that is read */
    char columns[DEA_SOURCE_LENGTH]; /**< what each of its columns was taken for, in words */
} dea_relaxation_data;

/** A number of branches that was tried. */
typedef struct dea_relaxation_trial {
    double residual_relative; /**< as in dea_relaxation [1] */
    double p;                 /**< chance that noise gains as much by the last branch (F test) [1], NAN: not testable */
    double long_term;         /**< long-term share of this trial [1], >= 0 */
} dea_relaxation_trial;

/** Why a fit has no further branch. */
typedef enum dea_relaxation_end {
    DEA_RELAXATION_ASKED,     /**< that many were asked for */
    DEA_RELAXATION_TEST,      /**< the next one gains no more than noise would */
    DEA_RELAXATION_EXACT,     /**< the residual is rounding already */
    DEA_RELAXATION_POINTS,    /**< the points determine no more constants */
    DEA_RELAXATION_LONG_TERM, /**< with the next one, no long-term share is left */
    DEA_RELAXATION_TIME,      /**< the points do not tell the time of a branch that the ramp hides */
    DEA_RELAXATION_FULL       /**< DEA_RELAXATION_MOST branches */
} dea_relaxation_end;

/** Fitted branches and how good they are. */
typedef struct dea_relaxation {
    dea_test_kind kind;
    size_t prony_count;                                   /**< branches in use */
    dea_prony prony[DEA_RELAXATION_MOST];                 /**< of the instantaneous modulus, tau ascending */
    dea_prony deviation[DEA_RELAXATION_MOST];             /**< their standard errors, NAN where the points do not tell them */
    double long_term;                                     /**< 1 - sum of g [1], > 0 */
    double long_term_deviation;                           /**< its standard error [1], NAN where the points do not tell it */
    double instantaneous;                                 /**< stress or strain after an ideal step, instantaneous modulus [Pa, 1] */
    dea_prony retardation[DEA_RELAXATION_MOST];           /**< of a creep test: shares of the strain after a long time, and their times */
    double residual_rms;                                  /**< root mean square of (measured - fitted) [Pa, 1] */
    double residual_relative;                             /**< residual_rms over the rms of what was measured [1] */
    size_t count;                                         /**< points */
    double time_min, time_max, ramp;                      /**< of the data [s]; of a dynamic test 1/omega of the frequencies */
    size_t trial_count;                                   /**< entry i of the trials has i branches */
    dea_relaxation_trial trials[DEA_RELAXATION_MOST + 1]; /**< 0 branches, 1, ... */
    dea_relaxation_end end;                               /**< why there is no further branch */
} dea_relaxation;

/** Reads a test of its kind into @p data, which has no points yet; its ramp stays.
 *
 * A table as of dea_fit_read() with time (since the end of the ramp, increasing; rows of equal time become their mean) and stress
 * or force. With a displacement too, time may count from anywhere: the hold begins where it is reached, and a ramp of 0 becomes
 * the one before it. Of a dynamic test: frequency [Hz] or angular frequency [rad/s] in any order, storage modulus, and loss modulus
 * or tan delta. Of a creep test: time, and strain, stretch, displacement or compliance.
 * @return DEA_OK, DEA_ERROR_SCENE (message "file:line:column: ..."), DEA_ERROR_USAGE (has points), DEA_ERROR_IO,
 * DEA_ERROR_MEMORY; @p data has no points on DEA_ERROR_SCENE
 */
DEA_API dea_status dea_relaxation_read(const char *path, dea_relaxation_data *data, dea_error *error);
/** Same from memory; @p name stands in messages. */
DEA_API dea_status dea_relaxation_parse(const char *text, size_t length, const char *name, dea_relaxation_data *data,
                                        dea_error *error);
/** Appends one point. @return DEA_OK, DEA_ERROR_USAGE (a number out of range, a time not after the last), DEA_ERROR_MEMORY */
DEA_API dea_status dea_relaxation_add(dea_relaxation_data *data, dea_relaxation_point point, dea_error *error);
/** Frees what the data owns; NULL and zeroed data are fine. */
DEA_API void dea_relaxation_data_free(dea_relaxation_data *data);

/** Fits Prony branches to a test: shares by non-negative least squares, times refined from a logarithmic grid. Those of a creep test
 * are its retardation branches turned into those of the modulus, exactly.
 *
 * @param branches 1 to DEA_RELAXATION_MOST; 0: as many as an F test finds significant at 5 %; never more than (values - 1)/2
 * @param relative as in dea_fit_yeoh()
 * @return DEA_OK (also without a branch: the film does not relax), DEA_ERROR_USAGE (the stress grows, relaxes to nothing, or
 * does not determine the branches asked for), DEA_ERROR_DATA (the stress rises first: the ramp is in the data), DEA_ERROR_MEMORY
 */
DEA_API dea_status dea_fit_relaxation(const dea_relaxation_data *data, size_t branches, bool relative, dea_relaxation *fit,
                                      dea_error *error);
/** Stress, or strain, of the fitted test at @p time since the end of its ramp [Pa, 1]; storage modulus at that angular frequency. */
DEA_API double dea_relaxation_stress(const dea_relaxation *fit, double time);
/** Loss modulus of a fitted dynamic test at @p omega [rad/s] [Pa]. */
DEA_API double dea_relaxation_loss(const dea_relaxation *fit, double omega);
/** True where its slowest branch is slower than the test: the long-term share is extrapolated. */
DEA_API bool dea_relaxation_slow(const dea_relaxation *fit);
/** True where the fastest branch of a dynamic test is faster than its frequencies: the instantaneous modulus is extrapolated. */
DEA_API bool dea_relaxation_fast(const dea_relaxation *fit);
/** Name of a kind of test: "relaxation test". */
DEA_API const char *dea_test_name(dea_test_kind kind);
/** Why the fit has no further branch, in words. */
DEA_API const char *dea_relaxation_reason(const dea_relaxation *fit);

/** Prints fits as a material file, their quality as comments; one of the two may be NULL.
 * @param film whose permittivity, density and breakdown strength are printed too where they are not NAN; NULL: none is
 * @return DEA_OK, DEA_ERROR_IO */
DEA_API dea_status dea_fit_print(const dea_fit *fit, const dea_relaxation *relaxation, const dea_material *film, FILE *stream,
                                 dea_error *error);

#ifdef __cplusplus
}
#endif
#endif
