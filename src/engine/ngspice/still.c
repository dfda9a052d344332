/* One mesh serves a line: that of its points that wants the most nodes, found by the film's own numbers. ngspice's answer is taken
 * where Newton's step of a mesh two degrees finer at it is small, which bounds the error of the discretisation and that of the
 * solution at once, and where the way from rest leads to it. */
#include "engine/ngspice/moving.h"

#include <math.h>
#include <stddef.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "engine/ngspice/stretch.h"
#include "netlist/rings_line.h"
#include "netlist/part_text.h"
#include "network/still.h"
#include "support/memory_text.h"

enum { LONGEST_SWEEP = 100000, LONGEST_LIST = 64, RAMP_STEPS = 32, RAMP_REFINED = 16, RAMP_MOST = RAMP_STEPS * RAMP_REFINED * RAMP_REFINED };

/* Shares of the wanted accuracy: of the mesh where it is chosen, of the answer where it is judged. */
static const double mesh_share = 0.03;
static const double answer_share = 0.2;

/* Newton's last step, over the error that an answer may have: ngspice tells what stood before that step. And the error of what is
 * small beside the film's strain, over that. */
static const double step_share = 0.5, small_share = 0.1;

/* Where Newton's method fails, trying it again, stepping gmin and sources fail too and take ten times as long: the voltage grows in
 * steps of our own. */
static const char newton_alone[] = "optran 0 0 0 0 0 0\nrun\n";

/* Two climbs and a solution of one equilibrium differ by less than this, of two by more [1]. */
static const double same = 1e-4;

typedef struct line_job {
    dea_ngspice *library;
    const dea_line *line;
    dea_row *rows;
    double accuracy;
    dea_scene scene; /* at the point that was placed last */
    dea_point point; /* that point */
    bool prepared;   /* it has a film */
    bool valid;      /* its numbers are in their ranges */
    dea_rings_mesh mesh;
    double error; /* of the line, expected of the mesh [1] */
    dea_still coarse, fine; /* of that point */
    double start[DEA_RINGS_NODES]; /* the equilibrium from which a sweep sets out [m] */
    double cut[4];          /* what the rings were cut for */
    double transfer[DEA_RINGS_NODES * DEA_RINGS_NODES];
} line_job;

static dea_row *row_at(const line_job *job, size_t i)
{
    return &job->rows[job->line->row + i * job->line->stride];
}

/* Moves the job to a point of its line. */
static void place(line_job *job, size_t i)
{
    if (job->line->axis) {
        dea_axis_set(job->line->axis, &job->scene, job->line->axis->values[job->line->from + i]);
    }
    if (!job->line->axis || job->line->axis->changes_film || !job->prepared) {
        dea_film_prepare(&job->scene, &job->point.film);
        job->prepared = true;
    }
    dea_point_place(&job->scene, &job->point);
    job->valid = dea_point_valid(&job->point);
}

/* True where nothing moves the film from rest. */
static bool at_rest(const line_job *job)
{
    return job->point.voltage == 0.0 && job->point.force == 0.0;
}

/* The rings of the point, cut anew where its geometry is another. */
static void cut(line_job *job)
{
    const dea_point *p = &job->point;
    const double now[4] = {p->frame_radius, p->coverage, p->film_thickness, p->film.prestretch};
    const double nominal = p->voltage / p->film_thickness;
    if (memcmp(now, job->cut, sizeof now) != 0) {
        dea_still_open(p, job->mesh, &job->coarse);
        dea_still_open(p, (dea_rings_mesh){job->mesh.disc, job->mesh.annulus + 2, job->mesh.logarithmic}, &job->fine);
        memcpy(job->cut, now, sizeof now);
    }
    job->coarse.pressure = job->fine.pressure = p->film.permittivity * nominal * nominal;
}

static void set_mesh(line_job *job, dea_rings_mesh mesh)
{
    job->mesh = mesh;
    memset(job->cut, 0, sizeof job->cut);
    dea_rings_transfer(mesh, (dea_rings_mesh){mesh.disc, mesh.annulus + 2, mesh.logarithmic}, job->transfer);
}

/* True where the way from rest leads to @p u. */
static bool is_connected(const line_job *job, const double *u)
{
    double own[DEA_RINGS_NODES];
    if (dea_still_near(&job->coarse, u)) {
        return true;
    }
    const size_t edge = job->coarse.rings.edge;
    return dea_still_climb(&job->coarse, own) == DEA_STATE_OK && fabs(own[edge] - u[edge]) <= same * dea_still_size(&job->coarse, own);
}

/* Fills the row of the placed point where displacements over r are its answer. */
static bool accept(line_job *job, size_t i, const double *const *columns, size_t index)
{
    double u[DEA_RINGS_NODES], v[DEA_RINGS_NODES];
    dea_row own;
    cut(job);
    const dea_rings *coarse = &job->coarse.rings, *fine = &job->fine.rings;
    for (size_t n = 0; n < coarse->node_count; n++) {
        u[n] = columns ? columns[n][index] * job->point.frame_radius : 0.0;
    }
    dea_rings_move(job->transfer, coarse->node_count, u, fine->node_count, v);
    if (!(dea_still_apart(&job->coarse, u, &job->fine, v, &own) <= answer_share * job->accuracy) || !is_connected(job, u)) {
        return false;
    }
    /* past a limit meshes converge slowly, and two may agree by chance */
    if (own.state != DEA_STATE_OK && !(dea_still_error(&job->coarse, u) <= answer_share * job->accuracy)) {
        return false;
    }
    *row_at(job, i) = own;
    return true;
}

/* Least strain under load of the two ends of a sweep, for tolerances; some number where none has one. */
static double least_strain(line_job *job, size_t from, size_t count)
{
    double least = 1.0, u[DEA_RINGS_NODES];
    for (size_t end = 0; end < 2; end++) {
        place(job, end == 0 ? from : from + count - 1);
        if (!job->valid) {
            continue;
        }
        cut(job);
        if (!at_rest(job) && dea_still_climb(&job->coarse, u) == DEA_STATE_OK) {
            least = fmin(least, dea_still_strain(&job->coarse, u));
        }
    }
    return least;
}

/* Where Newton starts on the nodes: from rest it may miss the first equilibrium of a sweep, or come to one that the film does not reach. */
static void write_start(const dea_rings_line *line, const line_job *job, const double *u, FILE *out)
{
    fputs("\n.nodeset", out);
    for (size_t n = 0; n < line->mesh.disc + line->mesh.annulus - 1; n++) {
        dea_part_print(out, " v(xline%zu.u%zu)=%g", line->number, n + 1, u[n] / job->point.frame_radius);
    }
}

/* Points of a line, how exactly they are solved, and the displacements to start from [m], NULL: rest. */
typedef struct analysis {
    size_t from, to;
    double relative, absolute;
    const double *start;
} analysis;

/* The circuit of some points with its analysis; the caller frees *text. */
static dea_status write_deck(const dea_rings_line *line, const line_job *job, const analysis *a, char **text, dea_error *error)
{
    dea_memory_text memory;
    dea_status status = dea_memory_text_begin(&memory, error);
    FILE *out = memory.out;
    if (status == DEA_OK) {
        fputs("* exact membrane as a network of rings\n", out);
        status = dea_rings_line_write(line, dea_dialect_at(0), out, error);
        dea_part_print(out, "VINDEX k 0 0\n.options itl1=100 itl2=100 reltol=%g vntol=%g abstol=%g\n.save",
                       a->relative, a->absolute, a->absolute);
        for (size_t n = 1; n < line->mesh.disc + line->mesh.annulus; n++) {
            fprintf(out, " v(xline%zu.u%zu)", line->number, n);
        }
        if (a->start) {
            write_start(line, job, a->start, out);
        }
        fprintf(out, "\n.dc VINDEX %zu %zu 1\n.end\n%s", a->from, a->to, newton_alone);
    }
    status = dea_memory_text_end(&memory, status, error);
    *text = memory.text;
    return status;
}

/* Runs a circuit and reads the displacements of its nodes over r; the caller frees the table, also after a failure. */
static dea_status run(line_job *job, const dea_rings_line *line, const analysis *a, dea_ngspice_table *table, dea_error *error)
{
    char *text;
    char names[DEA_RINGS_NODES][32];
    const char *list[DEA_RINGS_NODES];
    const size_t nodes = line->mesh.disc + line->mesh.annulus - 1;
    for (size_t n = 0; n < nodes; n++) {
        snprintf(names[n], sizeof names[n], "xline%zu.u%zu", line->number, n + 1);
        list[n] = names[n];
    }
    dea_status status = write_deck(line, job, a, &text, error);
    if (status == DEA_OK) {
        status = dea_ngspice_run_all(job->library, text, list, nodes, table, error);
        free(text);
    }
    return status;
}

static bool can_start(void *user, size_t i)
{
    line_job *job = user;
    place(job, i);
    if (!job->valid || at_rest(job)) {
        return false;
    }
    cut(job);
    return dea_still_climb(&job->coarse, job->start) == DEA_STATE_OK;
}

static dea_status sweep(void *user, size_t from, size_t count, size_t *good, dea_error *error)
{
    line_job *job = user;
    const dea_line *l = job->line;
    const size_t first = l->from + from;
    const bool uniform = !l->axis || l->axis->uniform;
    const double relative = step_share * answer_share * job->accuracy;
    const analysis a = {first, first + count - 1, relative, small_share * relative * least_strain(job, from, count), job->start};
    place(job, from);
    const dea_scene start = job->scene; /* borrowed by the text alone */
    const dea_rings_line line = {.scene = &start,
                                 .axis = l->axis,
                                 .from = uniform ? 0 : first,
                                 .to = uniform && l->axis ? l->axis->count : first + count,
                                 .mesh = job->mesh,
                                 .error = job->error,
                                 .number = 1};
    dea_ngspice_table table = {0};
    const dea_status status = run(job, &line, &a, &table, error);
    *good = 0;
    while (status == DEA_OK && *good < table.count && *good < count) {
        place(job, from + *good);
        if (!job->valid || !accept(job, from + *good, (const double *const *)table.columns, *good)) {
            break;
        }
        ++*good;
    }
    dea_ngspice_table_free(&table);
    return status;
}

/* A voltage that grows from 0, where the force alone holds the film, in so many steps to that of the placed point. */
static dea_status climb(line_job *job, size_t i, size_t steps, bool *accepted, dea_error *error)
{
    double *values = malloc((steps + 1) * sizeof *values);
    if (!values) {
        return dea_fail(error, DEA_ERROR_MEMORY, "out of memory for the steps of a load");
    }
    for (size_t k = 0; k <= steps; k++) {
        values[k] = job->scene.drive.voltage * ((double)k / (double)steps);
    }
    const dea_axis axis = {.key = "voltage",
                           .unit = "V",
                           .offset = offsetof(dea_scene, drive.voltage),
                           .values = values,
                           .count = steps + 1,
                           .uniform = true};
    const dea_scene here = job->scene;
    const dea_rings_line line = {.scene = &here, .axis = &axis, .to = steps + 1, .mesh = job->mesh, .number = 1};
    dea_ngspice_table table = {0};
    double u[DEA_RINGS_NODES], begin[DEA_RINGS_NODES];
    job->coarse.pressure = 0.0;
    const bool pulled = job->point.force != 0.0 && dea_still_climb(&job->coarse, begin) == DEA_STATE_OK;
    cut(job);
    const bool known = dea_still_climb(&job->coarse, u) == DEA_STATE_OK;
    const double strain = known ? dea_still_strain(&job->coarse, u) / (double)(steps * steps) : 1e-6;
    const analysis a = {.to = steps, .relative = fmin(1e-7, job->accuracy), .absolute = 1e-11 * strain, .start = pulled ? begin : NULL};
    const dea_status status = run(job, &line, &a, &table, error);
    *accepted = status == DEA_OK && table.count == steps + 1 && accept(job, i, (const double *const *)table.columns, steps);
    dea_ngspice_table_free(&table);
    free(values);
    return status;
}

/* What the placed point is where a mesh has lost its equilibrium. Beside a small disc strains are so steep that every mesh folds where
 * the film does not, and all at the same load: pulled in it is only where the exact membrane is too. */
static dea_state end_of(const line_job *job)
{
    dea_row exact = dea_row_failed();
    dea_model_solve(job->scene.models[0], &job->point, job->accuracy, &exact);
    return exact.state == DEA_STATE_PULL_IN ? DEA_STATE_PULL_IN : DEA_STATE_FAILED;
}

static dea_status alone(void *user, size_t i, dea_error *failure)
{
    line_job *job = user;
    double u[DEA_RINGS_NODES], error;
    *row_at(job, i) = dea_row_failed();
    place(job, i);
    if (!job->valid || (at_rest(job) && accept(job, i, NULL, 0))) {
        return DEA_OK;
    }
    cut(job);
    if (dea_still_climb(&job->coarse, u) != DEA_STATE_OK && end_of(job) == DEA_STATE_PULL_IN) {
        row_at(job, i)->state = DEA_STATE_PULL_IN;
        return DEA_OK;
    }
    const dea_rings_mesh usual = job->mesh, own = dea_still_mesh(&job->point, mesh_share * job->accuracy, &error);
    bool accepted = false;
    dea_status status = DEA_OK;
    if (own.annulus == 0) { /* no mesh is fine enough: the finest one tells whether the film ends before */
        set_mesh(job, (dea_rings_mesh){1, DEA_RINGS_DEGREE - 2, true});
        cut(job);
        row_at(job, i)->state = dea_still_climb(&job->fine, u) == DEA_STATE_OK ? DEA_STATE_FAILED : end_of(job);
        set_mesh(job, usual);
    } else {
        set_mesh(job, own);
        cut(job);
        for (size_t steps = RAMP_STEPS; status == DEA_OK && !accepted && steps <= RAMP_MOST; steps *= RAMP_REFINED) {
            status = climb(job, i, steps, &accepted, failure);
        }
        set_mesh(job, usual);
    }
    return status;
}

dea_status dea_ngspice_still(dea_ngspice *library, const dea_scene *scene, const dea_model *model, const dea_line *line,
                             dea_row *rows, dea_error *error)
{
    line_job *job = calloc(1, sizeof *job);
    if (!job) {
        return dea_fail(error, DEA_ERROR_MEMORY, "out of memory for a line of points");
    }
    job->library = library;
    job->line = line;
    job->rows = rows;
    job->accuracy = scene->accuracy;
    job->scene = *scene;
    job->scene.models[0] = model;
    dea_rings_line whole = {.scene = scene, .axis = line->axis, .from = line->from, .to = line->from + line->count};
    dea_rings_line_choose(&whole);
    job->error = whole.error;
    set_mesh(job, whole.mesh);
    const dea_stretch stretch = {.user = job,
                                 .count = line->count,
                                 .longest = line->axis && !line->axis->uniform ? LONGEST_LIST : LONGEST_SWEEP,
                                 .can_start = can_start,
                                 .sweep = sweep,
                                 .alone = alone};
    const dea_status status = dea_stretch_solve(&stretch, error);
    free(job);
    return status;
}
