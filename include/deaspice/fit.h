/** @file fit.h
 * Yeoh constants from measured stress-stretch data, by linear least squares.
 */
#ifndef DEASPICE_FIT_H
#define DEASPICE_FIT_H

#include <stdio.h>

#include "deaspice/material.h"

#ifdef __cplusplus
extern "C" {
#endif

/** How a specimen was loaded. */
typedef enum dea_load { DEA_LOAD_UNIAXIAL, DEA_LOAD_EQUIBIAXIAL, DEA_LOAD_COUNT, DEA_LOAD_UNKNOWN = DEA_LOAD_COUNT } dea_load;

/** One measured point. */
typedef struct dea_fit_point {
    double stretch; /**< along the load [1], > 0 */
    double stress;  /**< nominal (engineering) stress [Pa] */
    dea_load load;  /**< never DEA_LOAD_UNKNOWN */
} dea_fit_point;

/** Measured points; zeroed: none. Owns its points; free with dea_fit_data_free(). */
typedef struct dea_fit_data {
    dea_fit_point *points;
    size_t count, room; /**< points in use, points allocated */
} dea_fit_data;

/** Fitted constants and how good they are. */
typedef struct dea_fit {
    int terms;                        /**< constants in use, 1 to DEA_YEOH_TERMS */
    double yeoh[DEA_YEOH_TERMS];      /**< C_i [Pa], 0 beyond terms */
    double deviation[DEA_YEOH_TERMS]; /**< standard errors of C_i [Pa], NAN where points = terms */
    double residual_rms;              /**< root mean square of (measured - fitted) [Pa] */
    double residual_relative;         /**< residual_rms over the rms of the measured stress [1] */
    double r_squared;                 /**< 1 - sum of squared residuals / sum of squared deviations from the mean [1] */
    double condition;                 /**< condition number of the column-scaled problem [1] */
    size_t count[DEA_LOAD_COUNT];     /**< points of each load */
    double stretch_min, stretch_max;  /**< range of the data [1] */
    double unstable_stretch;          /**< smallest stretch of the range where a tangent modulus is not positive [1], NAN: none */
} dea_fit;

/** Name of a load: "uniaxial", "equibiaxial", "unknown". */
DEA_API const char *dea_load_name(dea_load load);
/** Load by name, DEA_LOAD_UNKNOWN if there is none. */
DEA_API dea_load dea_load_find(const char *name);

/** Reads a table of measured points and appends it to @p data.
 *
 * CSV (or ; or tab between the fields) with a header row: `stretch`, one of `stress_Pa`, `stress_kPa`, `stress_MPa` (nominal
 * stress), and optionally `mode` (uniaxial or equibiaxial). Blank lines and lines that begin with # are skipped.
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
 * @param relative weighs each point by 1/|stress|, or by 1/(1 % of the largest |stress|) where that is less: relative errors
 * count
 * @return DEA_OK, DEA_ERROR_USAGE (terms; the data does not determine the constants), DEA_ERROR_MEMORY
 */
DEA_API dea_status dea_fit_yeoh(const dea_fit_data *data, int terms, bool relative, dea_fit *fit, dea_error *error);
/** Nominal stress of the fitted material [Pa] at @p stretch under @p load. */
DEA_API double dea_fit_stress(const double yeoh[DEA_YEOH_TERMS], dea_load load, double stretch);
/** Prints the fit as a material file, its quality as comments. @return DEA_OK, DEA_ERROR_IO */
DEA_API dea_status dea_fit_print(const dea_fit *fit, FILE *stream, dea_error *error);

#ifdef __cplusplus
}
#endif
#endif
