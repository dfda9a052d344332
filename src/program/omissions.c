#include "program/omissions.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

#include "scene/line.h"
#include "picture/label.h"
#include "support/number.h"

const char *dea_bound_text(double bound, char text[32])
{
    const double power = bound > 0.0 ? pow(10.0, floor(log10(bound)) - 1.0) : 1.0;
    snprintf(text, 32, "%.2g", ceil(bound / power * (1.0 - 1e-12)) * power);
    return text;
}

/* Long times in minutes and hours. */
static dea_scale scale_of(double value, const char *unit)
{
    static const double minute = 60.0, hour = 3600.0;
    const bool time = strcmp(unit, "s") == 0;
    if (time && value >= 2.0 * minute) {
        const bool hours = value >= 2.0 * hour;
        dea_scale scale = {.factor = 1.0 / (hours ? hour : minute)};
        snprintf(scale.unit, sizeof scale.unit, "%s", hours ? "h" : "min");
        return scale;
    }
    return dea_scale_choose(value, unit);
}

const char *dea_quantity_text(double value, const char *unit, int digits, char text[DEA_QUANTITY_LENGTH])
{
    char number[DEA_NUMBER_LENGTH];
    if (strcmp(unit, "1") == 0) {
        snprintf(text, DEA_QUANTITY_LENGTH, "%s", dea_number_text(number, value, digits));
        return text;
    }
    const dea_scale scale = scale_of(fabs(value), unit);
    snprintf(text, DEA_QUANTITY_LENGTH, "%s %s", dea_number_text(number, value * scale.factor, digits), scale.unit);
    return text;
}

const char *dea_omission_text(const dea_omission *omission, const dea_scene *scene, char text[DEA_OMISSION_LENGTH])
{
    static const char *const names[] = {[DEA_PART_MASS] = "mass",
                                        [DEA_PART_RING] = "mass",
                                        [DEA_PART_BRANCH] = "branch",
                                        [DEA_PART_DAMPER] = "damper",
                                        [DEA_PART_SERIES] = "series resistance",
                                        [DEA_PART_SOFTENING] = "softening"};
    static const char *const forms[] = {[DEA_BRANCH_WHOLE] = "",
                                        [DEA_BRANCH_OUT] = "",
                                        [DEA_BRANCH_SPRING] = ", kept as a spring",
                                        [DEA_BRANCH_DAMPER] = ", kept as a damper"};
    char bound[32];
    dea_bound_text(omission->bound, bound);
    if (omission->part == DEA_PART_BRANCH) {
        snprintf(text, DEA_OMISSION_LENGTH, "branch %zu (tau %s%s, <= %s)", omission->branch + 1,
                 DEA_QUANTITY(dea_material_branch(&scene->material, omission->branch).tau, "s", 3), forms[omission->form], bound);
    } else if (omission->part == DEA_PART_RING) {
        snprintf(text, DEA_OMISSION_LENGTH, "mass from %.40s behind each corner of the voltage on (<= %s)",
                 DEA_QUANTITY(omission->from, "s", 3), bound);
    } else {
        snprintf(text, DEA_OMISSION_LENGTH, "%s (<= %s)", names[omission->part], bound);
    }
    return text;
}

dea_scene dea_scene_of_run(const dea_scene *scene, size_t number)
{
    dea_scene placed = *scene;
    dea_axes_place(&placed, number);
    return placed;
}
