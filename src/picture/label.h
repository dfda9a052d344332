/* What axes are called in pictures, and the unit prefix that keeps their numbers short. */
#ifndef DEASPICE_PICTURE_LABEL_H
#define DEASPICE_PICTURE_LABEL_H

#include "deaspice/result.h"
#include "deaspice/scene.h"

enum { DEA_LABEL_LENGTH = 160 };

/* A unit as it is shown: value in SI times factor, e.g. 1e-3 and "kV". */
typedef struct dea_scale {
    double factor;
    char unit[24]; /* empty where there is no dimension */
} dea_scale;

/* Scale that makes @p largest (absolute, SI) read as 1 to 999; times from five minutes on are in min, h or d. */
dea_scale dea_scale_choose(double largest, const char *unit);
/* Scale of an axis, from its largest value. */
dea_scale dea_scale_axis(const dea_axis *axis);
/* Label of an axis in full: "Voltage U [kV]". */
void dea_label_axis(const dea_axis *axis, const dea_scale *scale, char label[DEA_LABEL_LENGTH]);
/* One value of an axis, as a legend has it: "U = 4.5 kV". */
void dea_label_value(const dea_axis *axis, const dea_scale *scale, size_t index, char label[DEA_LABEL_LENGTH]);
/* Scale of a column of a sweep, strains in percent. */
dea_scale dea_scale_column(const dea_column *column, double largest);
/* Label of a column of a sweep: "Capacitance C [pF]". */
void dea_label_column(const dea_column *column, const dea_scale *scale, char label[DEA_LABEL_LENGTH]);
/* Model and values of the axes but number @p along (SIZE_MAX: of all) of point number @p number: models slowest, last axis fastest. */
void dea_label_run(const dea_scene *scene, size_t number, size_t along, char *label, size_t size);

#endif
