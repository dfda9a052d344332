/* The membrane's frequency response as a netlist: its rings linearised about the bias, on a mesh whose error is told by one that
 * is two degrees finer. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "netlist/export.h"
#include "netlist/rings_small.h"
#include "network/rings_mesh.h"

/* What tells how good a mesh is: the edge under the bias, and the first mode about it. */
typedef struct mark {
    double edge;  /* [m] */
    double omega; /* [rad/s], 0: without mass */
} mark;

typedef struct biased {
    dea_membrane membrane;
    double u[DEA_RINGS_NODES];
    double voltage; /* of the film [V] */
    double work[DEA_RINGS_NODES * DEA_RINGS_NODES], shapes[DEA_RINGS_NODES * DEA_RINGS_NODES];
    double frequencies[DEA_RINGS_NODES];
} biased;

static dea_status open_mesh(const dea_scene *scene, dea_rings_mesh mesh, biased *b, mark *found, dea_error *error)
{
    dea_membrane_look look;
    const dea_status status = dea_membrane_open(scene, scene->models[0], mesh, &b->membrane, error);
    if (status != DEA_OK) {
        return status;
    }
    memset(b->u, 0, sizeof b->u);
    b->voltage = scene->ac.bias / (1.0 + b->membrane.film.series * b->membrane.film.conductance);
    if (!dea_membrane_still(&b->membrane, b->voltage, b->u) || !dea_membrane_look_at(&b->membrane, b->u, &look)) {
        return dea_fail(error, DEA_ERROR_UNSUPPORTED, "the film has no equilibrium under its bias, %g V", scene->ac.bias);
    }
    *found = (mark){b->u[b->membrane.rings.edge], 0.0};
    if (b->membrane.heavy) {
        dea_membrane_stiffness(&b->membrane, &look, b->voltage, NULL, 0.0, b->work);
        if (dea_membrane_modes(&b->membrane, b->work, b->frequencies, b->shapes)) {
            found->omega = b->frequencies[0];
        }
    }
    return DEA_OK;
}

static double apart(const mark *coarse, const mark *fine)
{
    const double edge = fine->edge != 0.0 ? fabs(coarse->edge / fine->edge - 1.0) : 0.0;
    return fmax(edge, fine->omega > 0.0 ? fabs(coarse->omega / fine->omega - 1.0) : 0.0);
}

/* The coarsest mesh that is good to the scene's accuracy, or the finest; *gap: its error. */
static dea_status choose(const dea_scene *scene, biased *b, double *gap, dea_error *error)
{
    const bool wide = dea_rings_usual_mesh(scene).logarithmic;
    mark marks[2];
    size_t degree = 4;
    dea_status status = open_mesh(scene, (dea_rings_mesh){degree, degree, wide}, b, &marks[0], error);
    *gap = INFINITY;
    while (status == DEA_OK && degree + 2 <= DEA_RINGS_DEGREE && *gap > scene->accuracy) {
        degree += 2;
        status = open_mesh(scene, (dea_rings_mesh){degree, degree, wide}, b, &marks[1], error);
        *gap = apart(&marks[0], &marks[1]);
        marks[0] = marks[1];
    }
    return status;
}

static void write_band(const dea_export *export, size_t edge)
{
    const dea_scene *scene = export->scene;
    const size_t last = dea_layout_of(scene).rows - 1;
    fprintf(export->out,
            "* results: displacement v(u%zu) [m] and velocity v(v%zu) [m/s] per volt, input admittance -v(current) [S]\n"
            "HCURRENT current 0 VSOURCE 1\n.print ac vm(u%zu) vp(u%zu) vm(v%zu) vp(v%zu) vm(current) vp(current)\n",
            edge, edge, edge, edge, edge, edge);
    fputs(export->dialect->ac, export->out);
    fprintf(export->out, last > 0 ? ".ac dec %zu " : ".ac lin %zu ", last > 0 ? scene->ac.points_per_decade : 1);
    dea_part_number(export->out, scene->ac.from);
    fputc(' ', export->out);
    dea_part_number(export->out, dea_layout_place(scene, last));
    fputs("\n.end\n", export->out);
}

dea_status dea_export_ac_rings(dea_export *export, dea_error *error)
{
    char meaning[256];
    double gap;
    if (export->analogy_given && export->analogy->loop) {
        return dea_fail(error, DEA_ERROR_UNSUPPORTED, "the membrane is written in the mobility analogy: leave out --analogy");
    }
    biased *b = calloc(1, sizeof *b);
    if (!b) {
        return dea_fail(error, DEA_ERROR_MEMORY, "out of memory while a netlist is written");
    }
    const dea_status status = choose(export->scene, b, &gap, error);
    if (status == DEA_OK) {
        const dea_rings_small small = {&b->membrane, b->u, b->voltage};
        snprintf(meaning, sizeof meaning, "small signals about %.9g V; v(v<n>) = velocity [m/s] of node n, current = force [N]", b->voltage);
        dea_export_head(export, meaning);
        fprintf(export->out, "* expected error of the static displacement and of the first resonance: %.0e\n", gap);
        dea_rings_small_write(&small, export->out);
        write_band(export, b->membrane.rings.edge + 1);
    }
    free(b);
    return status;
}
