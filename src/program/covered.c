#include "program/findings.h"

#include <math.h>
#include <stdio.h>

#include "program/omissions.h"

/* Stretches that a table gives with six digits are met to this. */
static const double met = 1e-6;

/* Disc and annulus under their mean stretches: l (1 + s) and l (1 - B s/(1 - B)). */
static void stretches_take(dea_covered *covered, const dea_scene *placed, double strain)
{
    const double rest = placed->actuator.prestretch, coverage = placed->actuator.coverage;
    const double s = isfinite(strain) ? strain : 0.0; /* a frequency response stays at its bias */
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
        stretches_take(&here, &placed, dea_answer_column(layout, (const char *)point + i * layout->row_size, "strain"));
    }
    const double off = fmax(data[0] * (1.0 - met) - here.least, here.most - data[1] * (1.0 + met));
    covered->outside += off > 0.0;
    if (off > covered->worst) {
        *covered = (dea_covered){here.least, here.most, covered->outside, number, off};
    }
}

void dea_covered_warn(const dea_covered *covered, const dea_scene *scene)
{
    if (covered->outside == 0) {
        return;
    }
    fprintf(stderr, "deaspice: warning: the data of the material cover stretches %.6g to %.6g, the film has %.4g to %.4g",
            scene->material.stretches[0], scene->material.stretches[1], covered->least, covered->most);
    dea_answer_place(scene, covered->at_worst, " at ");
    if (covered->outside > 1) {
        fprintf(stderr, ", and %zu other point%s beyond", covered->outside - 1, covered->outside > 2 ? "s" : "");
    }
    fputs(": its numbers are extrapolated\n", stderr);
}
