/** @file plot.h
 * Pictures through gnuplot: of studies, of a material, of a fit. A picture appears whole or not at all. The format is that of the
 * path's ending: .svg, .png, .pdf, .eps, or .gp for the script of gnuplot with its data, which needs no gnuplot to be written;
 * "-" is not taken.
 */
#ifndef DEASPICE_PLOT_H
#define DEASPICE_PLOT_H

#include "deaspice/fit.h"
#include "deaspice/material.h"
#include "deaspice/result.h"
#include "deaspice/scene.h"

#ifdef __cplusplus
extern "C" {
#endif

typedef struct dea_plot dea_plot;

#define DEA_PLOT_SIDE_LEAST 0.04 /**< [m] */
#define DEA_PLOT_SIDE_MOST 2.0   /**< [m] */

/** How a picture looks. Zeroed, or NULL in its place: 25 cm wide, as high as its panels ask for, axes as the study has them. */
typedef struct dea_plot_options {
    double width, height; /**< [m], DEA_PLOT_SIDE_LEAST to DEA_PLOT_SIDE_MOST; 0: as the picture asks for */
    bool log_x;           /**< logarithmic along x: the long axis, time; points at or below zero are left out */
    bool log_y;           /**< logarithmic along y: strain, displacement, current, the second axis of a map */
    bool loops;           /**< a transient over the voltage of its source instead of time: hysteresis; not with log_x */
    const char *columns;  /**< of a sweep: one of its columns, or two for curves, e.g. "capacitance_F,force_N"; NULL: strain, displacement */
} dea_plot_options;

/** Opens the picture of a study; the scene must outlive it. It keeps at most some 2000 points of a curve, so its memory is
 * bounded.
 *
 * One long axis gives strain and displacement, or the columns that are wanted, over that axis, a curve for each value of the other
 * axes and each model (24 at most); two axes of more than 12 values and one model give a map of the displacement, or of one column. A transient gives strain, voltage, and
 * current, film voltage and focal length where the scene has them, over time; a frequency response gives displacement and impedance: a curve for
 * each run (24 at most), thinned without losing its peaks.
 * @param[out] plot the caller ends it with dea_plot_finish()
 * @return DEA_OK, DEA_ERROR_USAGE (ending, a single point, too many curves, loops of no transient, columns that it
 *         has not), DEA_ERROR_IO, DEA_ERROR_MISSING (no gnuplot),
 *         DEA_ERROR_MEMORY
 */
DEA_API dea_status dea_plot_begin(const dea_scene *scene, const char *path, const dea_plot_options *options, dea_plot **plot,
                                  dea_error *error);
/** Takes the rows of @p count points, laid out as dea_layout_of() says, the first of them being point number @p first: models
 * slowest, last axis fastest. */
DEA_API void dea_plot_points(dea_plot *plot, size_t first, const void *points, size_t count);
/** Draws when @p keep is true, and frees the plot; NULL is fine.
 * @return DEA_OK, DEA_ERROR_USAGE (no point has an equilibrium), DEA_ERROR_IO, DEA_ERROR_ENGINE (gnuplot failed: its words),
 *         DEA_ERROR_MISSING, DEA_ERROR_MEMORY */
DEA_API dea_status dea_plot_finish(dea_plot *plot, bool keep, dea_error *error);

/** Draws nominal stress (uniaxial and equi-biaxial) and operating modulus of a material over stretch 1 to @p to, which is
 * above 1. Returns as dea_plot_finish(). */
DEA_API dea_status dea_plot_material(const dea_material *material, double to, const char *path, const dea_plot_options *options,
                                     dea_error *error);
/** Draws measured points and fitted curves: stress over stretch, stress over time, or both side by side; @p fit or @p relaxation
 * may be NULL, not both. Returns as dea_plot_finish(). */
DEA_API dea_status dea_plot_fit(const dea_fit *fit, const dea_fit_data *data, const dea_relaxation *relaxation,
                                const dea_relaxation_data *held, const char *path, const dea_plot_options *options,
                                dea_error *error);

#ifdef __cplusplus
}
#endif
#endif
