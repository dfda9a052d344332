#include "program/findings.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

#include "program/omissions.h"
#include "scene/line.h"
#include "support/number.h"

/* Stretches that a table gives with six digits are met to this. */
static const double met = 1e-6;

static double strain_of(const dea_layout *layout, const void *row)
{
    for (size_t i = 0; i < layout->column_count; i++) {
        if (strcmp(layout->columns[i].name, "strain") == 0) {
            double strain;
            memcpy(&strain, (const char *)row + layout->columns[i].offset, sizeof strain);
            return strain;
        }
    }
    return 0.0; /* a frequency response stays at its bias */
}

/* Disc and annulus under their mean stretches: l (1 + s) and l (1 - B s/(1 - B)). */
static void stretches_take(dea_covered *covered, const dea_scene *placed, double strain)
{
    const double rest = placed->actuator.prestretch, coverage = placed->actuator.coverage;
    const double s = isfinite(strain) ? strain : 0.0;
    const double disc = rest * (1.0 + s), annulus = rest * (1.0 - coverage * s / (1.0 - coverage));
    covered->least = fmin(covered->least, fmin(disc, annulus));
    covered->most = fmax(covered->most, fmax(disc, annulus));
}

void dea_covered_take(dea_covered *covered, const dea_scene *scene, const dea_layout *layout, size_t number, const void *point)
{
    const double *data = scene->material.stretches;
    if (!(data[1] > 0.0)) {
        return;
    }
    const dea_scene placed = dea_scene_of_run(scene, number % dea_scene_point_count(scene));
    dea_covered here = {.least = INFINITY, .most = 0.0};
    for (size_t i = 0; i < layout->rows; i++) {
        stretches_take(&here, &placed, strain_of(layout, (const char *)point + i * layout->row_size));
    }
    const double off = fmax(data[0] * (1.0 - met) - here.least, here.most - data[1] * (1.0 + met));
    covered->outside += off > 0.0;
    if (off > covered->worst) {
        *covered = (dea_covered){here.least, here.most, covered->outside, number, off};
    }
}

static void print_place(const dea_scene *scene, size_t number)
{
    for (size_t i = 0; i < scene->axis_count; i++) {
        char text[DEA_NUMBER_LENGTH];
        fprintf(stderr, "%s%s = %s", i > 0 ? ", " : " at ", scene->axes[i].column,
                dea_number_text(text, scene->axes[i].values[dea_axis_index(scene, i, number)], 6));
    }
}

void dea_covered_warn(const dea_covered *covered, const dea_scene *scene)
{
    if (covered->outside == 0) {
        return;
    }
    fprintf(stderr, "deaspice: warning: the data of the material cover stretches %.6g to %.6g, the film has %.4g to %.4g",
            scene->material.stretches[0], scene->material.stretches[1], covered->least, covered->most);
    print_place(scene, covered->at_worst);
    if (covered->outside > 1) {
        fprintf(stderr, ", and %zu other point%s beyond", covered->outside - 1, covered->outside > 2 ? "s" : "");
    }
    fputs(": its numbers are extrapolated\n", stderr);
}
