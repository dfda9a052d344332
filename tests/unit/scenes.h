/* Scenes made without a file, and comparisons, for the tests of physics. */
#ifndef DEA_TEST_SCENES_H
#define DEA_TEST_SCENES_H

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include <math.h>
#include <stdio.h>
#include <string.h>

#include "deaspice/deaspice.h"

/* Elastosil 2030 with the constants of the base paper. */
static inline dea_material paper_material(void)
{
    dea_material material = dea_material_default();
    snprintf(material.name, sizeof material.name, "paper");
    material.constants[0] = 178426.0;
    material.constants[1] = -6023.0;
    material.constants[2] = 4234.0;
    material.permittivity = 2.8;
    return material;
}

/* A scene of one point: the paper's film of 100 um in a frame of 30 mm. */
static inline dea_scene paper_scene(dea_kind kind, double prestretch, double coverage, double voltage)
{
    static char title[] = "";
    return (dea_scene){
        .title = title,
        .actuator = {.kind = kind,
                     .frame_radius = 0.03,
                     .coverage = coverage,
                     .divide_radius = (double)NAN,
                     .film_thickness = 1e-4,
                     .prestretch = prestretch,
                     .layers = 1.0,
                     .electrode_mass = (double)NAN,
                     .focal_length = (double)NAN,
                     .refractive_index = (double)NAN},
        .material = paper_material(),
        .drive = {.voltage = voltage, .series_resistance = (double)NAN, .leakage_resistance = (double)NAN},
        .model_count = 1,
        .accuracy = 1e-6,
    };
}

/* The point of a scene without axes by the model's own equation. */
static inline dea_row solve_direct(const dea_scene *scene, const char *name)
{
    dea_point point;
    dea_row row = dea_row_failed();
    const dea_model *model = dea_model_find(name);
    assert_non_null(model);
    dea_film_prepare(scene, &point.film);
    dea_point_place(scene, &point);
    if (dea_point_valid(&point)) {
        dea_model_solve(model, &point, scene->accuracy, &row);
    }
    return row;
}

static inline dea_row solve_paper(const char *model, dea_kind kind, double prestretch, double coverage, double voltage)
{
    const dea_scene scene = paper_scene(kind, prestretch, coverage, voltage);
    return solve_direct(&scene, model);
}

/* Makes all points of @p axis those of the scene; the scene borrows the axis. */
static inline void add_axis(dea_scene *scene, dea_axis *axis, const double *field, double *values, size_t count)
{
    *axis =
        (dea_axis){.unit = "1", .offset = (size_t)((const char *)field - (const char *)scene), .values = values, .count = count};
    const char *material = (const char *)&scene->material;
    const char *place = (const char *)field;
    axis->changes_film = field == &scene->actuator.prestretch || (place >= material && place < material + sizeof scene->material);
    scene->axes = axis;
    scene->axis_count = 1;
}

static inline bool is_close(double value, double wanted, double relative, double absolute)
{
    return fabs(value - wanted) <= relative * fabs(wanted) + absolute; /* a NAN is never close */
}

static inline void check_close(double value, double wanted, double relative, double absolute, const char *what, const char *file,
                               int line)
{
    if (!is_close(value, wanted, relative, absolute)) {
        print_error("%s: %.17g, wanted %.17g: relative difference %.3g\n", what, value, wanted, value / wanted - 1.0);
        _fail(file, line);
    }
}

#define assert_relative(value, wanted, tolerance) check_close(value, wanted, tolerance, 0.0, #value, __FILE__, __LINE__)
#define assert_near(value, wanted, tolerance) check_close(value, wanted, 0.0, tolerance, #value, __FILE__, __LINE__)

/* All @p digits printed after the point are right. */
#define assert_printed(value, wanted, digits) assert_near(value, wanted, 0.5000001 * pow(10.0, -(digits)))

static inline void check_state(dea_row row, dea_state state, const char *file, int line)
{
    if (row.state != state) {
        print_error("state %s (strain %.17g), wanted %s\n", dea_state_name(row.state), row.strain, dea_state_name(state));
        _fail(file, line);
    }
}

#define assert_state(row, state) check_state(row, state, __FILE__, __LINE__)

/* Opens a test whose time goes to a simulator in a process of its own, on netlists that its neighbours write too: sanitizers see nothing
 * of the simulator, and leave it out. */
static inline void simulate_without_sanitizers(void)
{
#ifdef __SANITIZE_ADDRESS__
    skip();
#endif
}

#endif
