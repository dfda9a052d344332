/* NetCDF classic (64-bit offset; CDF-5 where a variable is too large for it): swept axes as dimensions, before them time or
 * frequency (CDO takes no other order for time), CF attributes. What a transient tells besides its samples
 * stands in variables over the axes. The classic layout keeps a variable in one piece, so blocks go straight to their place and
 * every NetCDF reader opens it; points with rows of their own are held until a write along the axes is long enough to be worth
 * it. No time stamp: the same study gives the same bytes. libnetcdf is loaded when the first such file is opened; nobody else
 * pays for it. */
#include "output/writer.h"

#include "deaspice/measures.h"
#include "deaspice/model.h"
#include "drive/wave.h"
#include "scene/keys.h"
#include "scene/line.h"
#include "study/study.h"

#include <dlfcn.h>
#include <math.h>
#include <netcdf.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#ifndef DEA_VERSION
#define DEA_VERSION "unknown"
#endif

enum { SLAB_VALUES = 4096, HELD_BYTES = 1 << 25, TEXT_LENGTH = 512, FIGURES = 16, AVERAGES = 2, WINDOW_FIGURES = 3 + 2 * DEA_HARMONICS, EDGE_FIGURES = 7 };

/* Largest number of doubles in one variable of the 64-bit offset format: 2^32 - 4 bytes. */
static const uint64_t offset_values = UINT64_C(4294967292) / sizeof(double);

#define NETCDF_LIST(X)                                                                                                           \
    X(nc_create)                                                                                                                 \
    X(nc_set_fill)                                                                                                               \
    X(nc_def_dim)                                                                                                                \
    X(nc_def_var)                                                                                                                \
    X(nc_put_att_text)                                                                                                           \
    X(nc_put_att_double)                                                                                                         \
    X(nc_put_att_schar)                                                                                                          \
    X(nc_enddef)                                                                                                                 \
    X(nc_put_var_double)                                                                                                         \
    X(nc_put_vara_double)                                                                                                        \
    X(nc_put_vara_schar)                                                                                                         \
    X(nc_put_vara_text)                                                                                                          \
    X(nc_close)                                                                                                                  \
    X(nc_strerror)

/* The functions of libnetcdf, with the types of its header. */
typedef struct netcdf_library {
    void *handle;
#define X(name) __typeof__(&name) name;
    NETCDF_LIST(X)
#undef X
} netcdf_library;

/* Over the axes and windows. */
static const dea_column averages[AVERAGES] = {
    {"average_strain", "mean radial strain of the disc edge over the window", "1", offsetof(dea_average, strain)},
    {"average_displacement_m", "mean radial displacement of the disc edge over the window", "m",
     offsetof(dea_average, displacement)},
};

/* Over the axes and the edges of a step, on and off; what is not reached is NAN. */
static const dea_column edges[EDGE_FIGURES] = {
    {"edge_time_s", "begin of the edge", "s", offsetof(dea_edge_answer, time)},
    {"change_m", "displacement that the film relaxes to behind the edge less that before it", "m", offsetof(dea_edge_answer, change)},
    {"overshoot", "largest excess over that, relative to the change", "1", offsetof(dea_edge_answer, overshoot)},
    {"rise_least_s", "time from 10 to 90 % of the change, no less than", "s", offsetof(dea_edge_answer, rise.early)},
    {"rise_most_s", "time from 10 to 90 % of the change, no more than", "s", offsetof(dea_edge_answer, rise.late)},
    {"settling_least_s", "time until the film stays within 2 % of the change, no less than", "s", offsetof(dea_edge_answer, settling.early)},
    {"settling_most_s", "time until the film stays within 2 % of the change, no more than", "s", offsetof(dea_edge_answer, settling.late)},
};

typedef struct grid {
    netcdf_library nc;
    const dea_scene *scene;
    const dea_study *study;
    dea_layout layout;
    const char *target;              /* for messages */
    int file;                        /* -1: not open */
    size_t lead;                     /* dimensions before those of the points: 1 of time or frequency, 0 in a sweep */
    size_t point_rank;               /* dimensions of a variable over the axes: models, axes */
    size_t *shape, *start, *edge;    /* of the lead, the points and the windows: point_rank + 2 values each */
    int *dimensions;                 /* as many */
    int *axes;                       /* variable of each axis */
    int columns[DEA_LAYOUT_COLUMNS]; /* variables of the rows; that of the first may be a coordinate */
    int state, model;
    int figures[FIGURES], averages[AVERAGES], window[2], window_figures[WINDOW_FIGURES];
    int step, step_figures[EDGE_FIGURES]; /* edges of a step */
    int radius, spread[DEA_SPREAD_COLUMNS]; /* what rows tell over the radius */
    int *spread_dimensions;                 /* of those: of the rows, the radius, the points */
    int failed; /* first status of the library that is not 0 */
    char *held; /* points that wait, NULL in a sweep; owned */
    size_t held_first, held_count, held_room;
    double values[SLAB_VALUES];
    signed char states[SLAB_VALUES];
} grid;

/* Rows of a transient and of a frequency response lie along a coordinate of their own: their first column. */
static bool has_coordinate(const grid *file)
{
    return file->lead > 0;
}

/* Keeps the first failure, so that a row of calls needs one check at its end. */
static void grid_keep(grid *file, int status)
{
    if (!file->failed) {
        file->failed = status;
    }
}

static dea_status grid_status(const grid *file, dea_error *error)
{
    if (!file->failed) {
        return DEA_OK;
    }
    return dea_fail(error, DEA_ERROR_IO, "cannot write %s: %s", file->target, file->nc.nc_strerror(file->failed));
}

static dea_status library_load(netcdf_library *nc, dea_error *error)
{
    static const char *const names[] = {"libnetcdf.so.19", "libnetcdf.so.22", "libnetcdf.so.18", "libnetcdf.so"};
    for (size_t i = 0; i < sizeof names / sizeof *names && !nc->handle; i++) {
        nc->handle = dlopen(names[i], RTLD_NOW | RTLD_LOCAL | RTLD_NODELETE);
    }
    if (!nc->handle) {
        return dea_fail(error, DEA_ERROR_MISSING, "NetCDF files need the library libnetcdf (Debian: package libnetcdf19)");
    }
#define X(name)                                                                                                                  \
    *(void **)&nc->name = dlsym(nc->handle, #name);                                                                              \
    if (!nc->name) {                                                                                                             \
        return dea_fail(error, DEA_ERROR_MISSING, "this libnetcdf has no " #name "; install a newer one");                       \
    }
    NETCDF_LIST(X)
#undef X
    return DEA_OK;
}

static void put_text(grid *file, int variable, const char *name, const char *text)
{
    grid_keep(file, file->nc.nc_put_att_text(file->file, variable, name, strlen(text), text));
}

static void put_number(grid *file, int variable, const char *name, double value)
{
    grid_keep(file, file->nc.nc_put_att_double(file->file, variable, name, NC_DOUBLE, 1, &value));
}

static bool is_swept(const dea_scene *scene, size_t offset)
{
    for (size_t i = 0; i < scene->axis_count; i++) {
        if (scene->axes[i].offset == offset) {
            return true;
        }
    }
    return false;
}

static bool begins_with(const char *path, const char *with)
{
    return strncmp(path, with, strlen(with)) == 0;
}

/* Does the scene use this scalar, and the same in all points? Windows and branches are lists, which have places of their own. */
static bool is_used(const dea_key *key, const dea_scene *scene)
{
    const dea_wave *wave = dea_wave_of(scene->drive.waveform.kind);
    const struct {
        const char *path;
        bool used;
    } parts[] = {
        {"drive.waveform.period", wave && !wave->once},
        {"drive.waveform.", wave && begins_with(key->path, wave->path) && key->path[strlen(wave->path)] == '.'},
        {"study.transient.average.", false},
        {dea_study_of(scene)->path, true},
        {"study.", false},
        {"electrode.", scene->electrode.law},
        {"material.prony.", false},
        {"", true},
    };
    size_t part = 0;
    while (!begins_with(key->path, parts[part].path)) {
        part++;
    }
    return parts[part].used && dea_key_is_scalar(key, scene) && !is_swept(scene, key->offset);
}

/* A scalar under its path without the section, one of the electrode under its whole path: a skin has a law and a density as the
 * film has. */
static void put_scalar(void *user, const dea_key *key)
{
    grid *file = user;
    char name[DEA_NAME_LENGTH];
    const double value = dea_layout_number(file->scene, key->offset);
    dea_ref ref;
    if (isnan(value) || !dea_key_find(key->path, &ref)) {
        return;
    }
    size_t components = begins_with(key->path, "electrode.") ? 1 : 0;
    for (const char *dot = strchr(key->path, '.'); dot; dot = strchr(dot + 1, '.')) {
        components++;
    }
    dea_ref_column(&ref, components > 0 ? components : 1, name);
    put_number(file, NC_GLOBAL, name, value);
}

/* The constants of a law, entry after entry, under one name each. */
static void put_law(grid *file, const char *of, const dea_law *law, const double *constants, size_t count)
{
    const size_t stride = law->constant_count;
    for (size_t k = 0; k < stride; k++) {
        char name[DEA_NAME_LENGTH];
        double values[DEA_LAW_CONSTANTS];
        for (size_t i = 0; i < count; i++) {
            values[i] = constants[i * stride + k];
        }
        snprintf(name, sizeof name, "%s%s_%s%s", of, law->name, law->constants[k].name, law->constants[k].modulus ? "_Pa" : "");
        grid_keep(file, file->nc.nc_put_att_double(file->file, NC_GLOBAL, name, NC_DOUBLE, count, values));
    }
}

/* Those of a law that is a list: others are scalars of the scene. */
static void put_listed_law(grid *file, const char *of, const dea_law *law, const double *constants, size_t count)
{
    if (law && law->entries > 1) {
        put_law(file, of, law, constants, count);
    }
}

/* A second film: what it is made of, and what it does not have from the first. */
static void put_antagonist(grid *file)
{
    const dea_antagonist *film = &file->scene->antagonist;
    if (!film->there) {
        return;
    }
    put_text(file, NC_GLOBAL, "antagonist_actuator", film->kind == DEA_DOT ? "dot" : "lens");
    if (film->own_material) {
        put_text(file, NC_GLOBAL, "antagonist_material", film->material.name);
        put_text(file, NC_GLOBAL, "antagonist_material_source", film->material.source);
        put_law(file, "antagonist_", film->material.law, film->material.constants, film->material.entry_count);
        put_number(file, NC_GLOBAL, "antagonist_permittivity", film->material.permittivity);
    }
}

static void put_prony(grid *file)
{
    const dea_material *material = &file->scene->material;
    double g[DEA_PRONY_MAX], tau[DEA_PRONY_MAX];
    for (size_t i = 0; i < material->prony_count; i++) {
        g[i] = material->prony[i].g;
        tau[i] = material->prony[i].tau;
    }
    if (material->prony_count > 0) {
        grid_keep(file, file->nc.nc_put_att_double(file->file, NC_GLOBAL, "prony_g", NC_DOUBLE, material->prony_count, g));
        grid_keep(file, file->nc.nc_put_att_double(file->file, NC_GLOBAL, "prony_tau_s", NC_DOUBLE, material->prony_count, tau));
        put_text(file, NC_GLOBAL, "moduli", material->instantaneous ? "instantaneous" : "long-term");
    }
}

static void put_shift(grid *file)
{
    const dea_shift *shift = &file->scene->material.shift;
    double temperatures[DEA_SHIFT_MOST], factors[DEA_SHIFT_MOST];
    for (size_t i = 0; i < shift->count; i++) {
        temperatures[i] = shift->table[i][0];
        factors[i] = shift->table[i][1];
    }
    if (shift->count > 0) {
        grid_keep(file, file->nc.nc_put_att_double(file->file, NC_GLOBAL, "shift_temperature_K", NC_DOUBLE, shift->count, temperatures));
        grid_keep(file, file->nc.nc_put_att_double(file->file, NC_GLOBAL, "shift_factor", NC_DOUBLE, shift->count, factors));
    }
}

/* Where the numbers come from. */
static void put_provenance(grid *file, const char *engine)
{
    const dea_scene *scene = file->scene;
    char models[TEXT_LENGTH] = "", history[TEXT_LENGTH];
    for (size_t i = 0, used = 0; i < scene->model_count && used < sizeof models; i++) {
        const int more = snprintf(models + used, sizeof models - used, "%s%s (%s)", i > 0 ? ", " : "", scene->models[i]->name,
                                  scene->models[i]->equation);
        used += (size_t)more;
    }
    snprintf(history, sizeof history, "deaspice %s: %s of %zu %s by engine %s", DEA_VERSION, file->study->title,
             dea_scene_point_count(scene) * scene->model_count, file->study->points[1], engine);
    put_text(file, NC_GLOBAL, "Conventions", "CF-1.10");
    put_text(file, NC_GLOBAL, "title", scene->title);
    put_text(file, NC_GLOBAL, "source", "deaspice " DEA_VERSION);
    put_text(file, NC_GLOBAL, "history", history);
    put_text(file, NC_GLOBAL, "engine", engine);
    put_text(file, NC_GLOBAL, "models", models);
    put_text(file, NC_GLOBAL, "actuator", scene->actuator.kind == DEA_DOT ? "dot" : "lens");
    put_text(file, NC_GLOBAL, "material", scene->material.name);
    put_text(file, NC_GLOBAL, "material_source", scene->material.source);
    dea_keys_visit(scene, is_used, put_scalar, file);
    put_listed_law(file, "", scene->material.law, scene->material.constants, scene->material.entry_count);
    put_listed_law(file, "electrode_", scene->electrode.law, scene->electrode.constants, scene->electrode.entry_count);
    put_antagonist(file);
    put_prony(file);
    put_shift(file);
    if (file->study->timed) {
        const dea_wave *wave = dea_wave_of(scene->drive.waveform.kind);
        put_text(file, NC_GLOBAL, "waveform", wave ? dea_wave_name(wave) : "none");
        if (wave && wave->word) {
            put_text(file, NC_GLOBAL, wave->word, wave->words[scene->drive.waveform.choice]);
        }
        put_text(file, NC_GLOBAL, "start", scene->transient.from_bias ? "bias" : "rest");
    }
}

static size_t model_name_length(const dea_scene *scene)
{
    size_t longest = 1;
    for (size_t i = 0; i < scene->model_count; i++) {
        const size_t length = strlen(scene->models[i]->name);
        longest = length > longest ? length : longest;
    }
    return longest;
}

/* Dimension and variable of the models, slowest of the points. */
static void define_model(grid *file)
{
    int pair[2] = {0, 0};
    grid_keep(file, file->nc.nc_def_dim(file->file, "model", file->scene->model_count, &pair[0]));
    grid_keep(file, file->nc.nc_def_dim(file->file, "model_name_length", model_name_length(file->scene), &pair[1]));
    grid_keep(file, file->nc.nc_def_var(file->file, "model", NC_CHAR, 2, pair, &file->model));
    put_text(file, file->model, "long_name", "model");
    put_text(file, file->model, "_Encoding", "utf-8");
    file->dimensions[file->lead] = pair[0];
    file->shape[file->lead] = file->scene->model_count;
}

/* Dimension and coordinate variable of an axis. */
static void define_axis(grid *file, size_t number, size_t dimension)
{
    const dea_axis *axis = &file->scene->axes[number];
    char words[DEA_NAME_LENGTH];
    const char *dot = strchr(axis->key, '.');
    snprintf(words, sizeof words, "%s", dot ? dot + 1 : axis->key);
    for (char *letter = words; *letter; letter++) {
        *letter = *letter == '_' || *letter == '.' ? ' ' : *letter;
    }
    file->shape[dimension] = axis->count;
    grid_keep(file, file->nc.nc_def_dim(file->file, axis->column, axis->count, &file->dimensions[dimension]));
    grid_keep(file,
              file->nc.nc_def_var(file->file, axis->column, NC_DOUBLE, 1, &file->dimensions[dimension], &file->axes[number]));
    put_text(file, file->axes[number], "units", axis->unit);
    put_text(file, file->axes[number], "long_name", words);
}

/* Dimension of the rows of a point, and their first column as its coordinate variable: "time", not "time_s". */
static void define_coordinate(grid *file)
{
    const dea_column *column = &file->layout.columns[0];
    char name[DEA_NAME_LENGTH];
    int *dimension = &file->dimensions[0];
    snprintf(name, sizeof name, "%.*s", (int)strcspn(column->name, "_"), column->name);
    file->shape[0] = file->layout.rows;
    grid_keep(file, file->nc.nc_def_dim(file->file, name, file->layout.rows, dimension));
    grid_keep(file, file->nc.nc_def_var(file->file, name, NC_DOUBLE, 1, dimension, &file->columns[0]));
    put_text(file, file->columns[0], "units", column->unit);
    put_text(file, file->columns[0], "long_name", column->long_name);
}

/* A variable of numbers over the dimensions from @p first on. */
static int define_numbers(grid *file, const char *name, const char *long_name, const char *unit, size_t first, size_t rank)
{
    int variable = -1;
    grid_keep(file, file->nc.nc_def_var(file->file, name, NC_DOUBLE, (int)rank, &file->dimensions[first], &variable));
    put_text(file, variable, "units", unit);
    put_text(file, variable, "long_name", long_name);
    put_number(file, variable, "_FillValue", (double)NAN);
    return variable;
}

static void define_columns(grid *file)
{
    const size_t rank = file->lead + file->point_rank;
    for (size_t i = has_coordinate(file) ? 1 : 0; i < file->layout.column_count; i++) {
        const dea_column *column = &file->layout.columns[i];
        file->columns[i] = define_numbers(file, column->name, column->long_name, column->unit, 0, rank);
    }
    grid_keep(file, file->nc.nc_def_var(file->file, "state", NC_BYTE, (int)rank, file->dimensions, &file->state));
    signed char codes[DEA_STATE_COUNT];
    char names[TEXT_LENGTH] = "";
    size_t used = 0;
    for (int i = 0; i < DEA_STATE_COUNT; i++) {
        codes[i] = (signed char)i;
        used += (size_t)snprintf(names + used, sizeof names - used, "%s%s", i > 0 ? " " : "", dea_state_name((dea_state)i));
    }
    put_text(file, file->state, "long_name", "state of the point");
    put_text(file, file->state, "flag_meanings", names);
    grid_keep(file, file->nc.nc_put_att_schar(file->file, file->state, "flag_values", NC_BYTE, DEA_STATE_COUNT, codes));
}

/* Variables over the axes: what a point tells besides its rows. */
static void define_figures(grid *file)
{
    for (size_t i = 0; i < file->study->figure_count; i++) {
        const dea_column *told = &file->study->figures[i];
        file->figures[i] = define_numbers(file, told->name, told->long_name, told->unit, file->lead, file->point_rank);
    }
}

/* What rows tell over the radius, whose dimension stands behind that of the rows. */
static void define_spread(grid *file)
{
    const dea_layout *layout = &file->layout;
    int *own = file->spread_dimensions, *saved = file->dimensions;
    memcpy(own, saved, file->lead * sizeof *own);
    memcpy(own + file->lead + 1, saved + file->lead, file->point_rank * sizeof *own);
    grid_keep(file, file->nc.nc_def_dim(file->file, "radius", layout->spread_points, &own[file->lead]));
    grid_keep(file, file->nc.nc_def_var(file->file, "radius", NC_DOUBLE, 1, &own[file->lead], &file->radius));
    put_text(file, file->radius, "units", "m");
    put_text(file, file->radius, "long_name", "radius of the film at rest and 0 V");
    file->dimensions = own;
    for (size_t i = 0; i < layout->spread_count; i++) {
        const dea_column *told = &layout->spread[i];
        file->spread[i] = define_numbers(file, told->name, told->long_name, told->unit, 0, file->lead + 1 + file->point_rank);
    }
    file->dimensions = saved;
}

/* Averages and further figures of a transient over a dimension of windows. */
static void define_windows(grid *file)
{
    if (file->scene->transient.average_count == 0) {
        return;
    }
    size_t told;
    const dea_column *columns = dea_window_columns(file->scene, &told);
    static const char *const ends[] = {"window_from_s", "window_to_s"}, *const words[] = {"begin of the window",
                                                                                          "end of the window"};
    int *window = &file->dimensions[file->lead + file->point_rank];
    grid_keep(file, file->nc.nc_def_dim(file->file, "window", file->scene->transient.average_count, window));
    for (size_t i = 0; i < AVERAGES; i++) {
        file->averages[i] = define_numbers(file, averages[i].name, averages[i].long_name, averages[i].unit, file->lead,
                                           file->point_rank + 1);
    }
    for (size_t i = 0; i < told; i++) {
        file->window_figures[i] =
            define_numbers(file, columns[i].name, columns[i].long_name, columns[i].unit, file->lead, file->point_rank + 1);
    }
    for (size_t i = 0; i < 2; i++) {
        grid_keep(file, file->nc.nc_def_var(file->file, ends[i], NC_DOUBLE, 1, window, &file->window[i]));
        put_text(file, file->window[i], "units", "s");
        put_text(file, file->window[i], "long_name", words[i]);
    }
}

/* Only a step has edges that a film answers one by one. */
static bool has_edges(const grid *file)
{
    return file->study->timed && dea_wave_settles(&file->scene->drive.waveform);
}

/* Answers to the edges of a step over a dimension of two. */
static void define_edges(grid *file)
{
    static const signed char codes[DEA_EDGES] = {0, 1};
    int *edge = &file->dimensions[file->lead + file->point_rank];
    grid_keep(file, file->nc.nc_def_dim(file->file, "edge", DEA_EDGES, edge));
    grid_keep(file, file->nc.nc_def_var(file->file, "edge", NC_BYTE, 1, edge, &file->step));
    put_text(file, file->step, "long_name", "edge of the step");
    put_text(file, file->step, "flag_meanings", "on off");
    grid_keep(file, file->nc.nc_put_att_schar(file->file, file->step, "flag_values", NC_BYTE, DEA_EDGES, codes));
    for (size_t i = 0; i < EDGE_FIGURES; i++) {
        file->step_figures[i] =
            define_numbers(file, edges[i].name, edges[i].long_name, edges[i].unit, file->lead, file->point_rank + 1);
    }
}

static void put_rows_coordinate(grid *file)
{
    for (size_t first = 0; first < file->layout.rows && !file->failed; first += SLAB_VALUES) {
        const size_t left = file->layout.rows - first, count = left < SLAB_VALUES ? left : SLAB_VALUES;
        for (size_t i = 0; i < count; i++) {
            file->values[i] = dea_layout_place(file->scene, first + i);
        }
        grid_keep(file, file->nc.nc_put_vara_double(file->file, file->columns[0], &first, &count, file->values));
    }
}

static void put_radii(grid *file)
{
    for (size_t i = 0; i < file->layout.spread_points; i++) {
        const size_t one = 1;
        const double radius = dea_layout_radius(file->scene, &file->layout, i);
        grid_keep(file, file->nc.nc_put_vara_double(file->file, file->radius, &i, &one, &radius));
    }
}

static void put_windows(grid *file)
{
    const dea_transient *transient = &file->scene->transient;
    for (size_t i = 0; i < transient->average_count; i++) {
        const size_t one = 1;
        grid_keep(file, file->nc.nc_put_vara_double(file->file, file->window[0], &i, &one, &transient->averages[i].from));
        grid_keep(file, file->nc.nc_put_vara_double(file->file, file->window[1], &i, &one, &transient->averages[i].to));
    }
}

static void put_edges(grid *file)
{
    static const signed char codes[DEA_EDGES] = {0, 1};
    const size_t start = 0, count = DEA_EDGES;
    grid_keep(file, file->nc.nc_put_vara_schar(file->file, file->step, &start, &count, codes));
}

static void put_coordinates(grid *file)
{
    const dea_scene *scene = file->scene;
    for (size_t i = 0; i < scene->axis_count; i++) {
        grid_keep(file, file->nc.nc_put_var_double(file->file, file->axes[i], scene->axes[i].values));
    }
    for (size_t i = 0; i < scene->model_count && scene->model_count > 1; i++) {
        char name[TEXT_LENGTH] = "";
        snprintf(name, sizeof name, "%s", scene->models[i]->name);
        const size_t start[2] = {i, 0}, edge[2] = {1, model_name_length(scene)};
        grid_keep(file, file->nc.nc_put_vara_text(file->file, file->model, start, edge, name));
    }
    if (has_coordinate(file)) {
        put_rows_coordinate(file);
    }
    put_radii(file);
    if (file->study->timed) {
        put_windows(file);
    }
    if (has_edges(file)) {
        put_edges(file);
    }
}

static void grid_define(grid *file, const char *path, const char *engine)
{
    const dea_scene *scene = file->scene;
    const bool large = dea_scene_point_count(scene) * scene->model_count * file->layout.rows > offset_values;
    int old_fill;
    file->failed = file->nc.nc_create(path, NC_CLOBBER | (large ? NC_64BIT_DATA : NC_64BIT_OFFSET), &file->file);
    if (file->failed) {
        file->file = -1;
        return;
    }
    grid_keep(file, file->nc.nc_set_fill(file->file, NC_NOFILL, &old_fill)); /* every value is written */
    put_provenance(file, engine);
    if (has_coordinate(file)) {
        define_coordinate(file);
    }
    if (scene->model_count > 1) {
        define_model(file);
    }
    for (size_t i = 0; i < scene->axis_count; i++) {
        define_axis(file, i, file->lead + file->point_rank - scene->axis_count + i);
    }
    define_columns(file);
    define_figures(file);
    if (file->layout.spread_count > 0) {
        define_spread(file);
    }
    if (file->study->timed) {
        define_windows(file);
    }
    if (has_edges(file)) {
        define_edges(file);
    }
    grid_keep(file, file->nc.nc_enddef(file->file));
    put_coordinates(file);
}

static void grid_free(grid *file)
{
    free(file->shape);
    free(file->dimensions);
    free(file->held);
    if (file->nc.handle) {
        dlclose(file->nc.handle);
    }
    free(file);
}

/* Room for as many points as HELD_BYTES take, at least one. */
static dea_status grid_allocate(grid *file)
{
    const dea_scene *scene = file->scene;
    const size_t points = dea_scene_point_count(scene) * scene->model_count, fit = HELD_BYTES / file->layout.point_size;
    file->lead = file->study->along ? 1 : 0;
    file->point_rank = scene->axis_count + (scene->model_count > 1 ? 1 : 0);
    const size_t most = file->point_rank + 2;
    file->shape = calloc(3 * most, sizeof *file->shape);
    file->dimensions = calloc(2 * most + scene->axis_count, sizeof *file->dimensions);
    if (!file->shape || !file->dimensions) {
        return DEA_ERROR_MEMORY;
    }
    file->start = file->shape + most;
    file->edge = file->start + most;
    file->spread_dimensions = file->dimensions + most;
    file->axes = file->spread_dimensions + most;
    if (!has_coordinate(file)) {
        return DEA_OK;
    }
    file->held_room = fit < 1 ? 1 : fit < points ? fit : points;
    file->held = calloc(file->held_room, file->layout.point_size);
    return file->held ? DEA_OK : DEA_ERROR_MEMORY;
}

/* The largest slab of the points' dimensions that starts at flattened point @p first and is one run of at most @p count points;
 * its points. */
static size_t slab_next(grid *file, size_t first, size_t count)
{
    const size_t end = file->lead + file->point_rank;
    size_t rest = first;
    for (size_t i = end; i-- > file->lead; rest /= file->shape[i]) {
        file->start[i] = rest % file->shape[i];
        file->edge[i] = 1;
    }
    size_t points = 1;
    for (size_t i = end; i-- > file->lead;) {
        const size_t left = file->shape[i] - file->start[i];
        const size_t fits = count / points;
        file->edge[i] = left < fits ? left : fits;
        points *= file->edge[i];
        if (file->edge[i] < file->shape[i]) {
            break;
        }
    }
    return points;
}

/* Puts @p rows rows of @p count points, which stand at @p row with those of the next point a point's size behind: row after row,
 * the points side by side. */
static void slab_put(grid *file, const char *row, size_t count, size_t rows)
{
    const dea_layout *layout = &file->layout;
    for (size_t i = file->lead; i < layout->column_count; i++) {
        for (size_t j = 0; j < count; j++) {
            const char *value = row + j * layout->point_size + layout->columns[i].offset;
            for (size_t k = 0; k < rows; k++, value += layout->row_size) {
                memcpy(&file->values[k * count + j], value, sizeof *file->values);
            }
        }
        grid_keep(file, file->nc.nc_put_vara_double(file->file, file->columns[i], file->start, file->edge, file->values));
    }
    for (size_t j = 0; j < count; j++) {
        for (size_t k = 0; k < rows; k++) {
            const dea_state state = dea_layout_state(layout, row + j * layout->point_size + k * layout->row_size);
            file->states[k * count + j] = (signed char)state;
        }
    }
    grid_keep(file, file->nc.nc_put_vara_schar(file->file, file->state, file->start, file->edge, file->states));
}

/* Figures of @p count points, which stand at @p values, @p apart bytes from one to the next. */
static void put_figures(grid *file, const int *variables, const dea_column *figures, size_t kinds, const void *values, size_t apart,
                        size_t count)
{
    for (size_t i = 0; i < kinds; i++) {
        for (size_t j = 0; j < count; j++) {
            memcpy(&file->values[j], (const char *)values + j * apart + figures[i].offset, sizeof *file->values);
        }
        grid_keep(file, file->nc.nc_put_vara_double(file->file, variables[i], &file->start[file->lead], &file->edge[file->lead],
                                                    file->values));
    }
}

/* What a window of @p count points holds, the first of them number @p first. */
static void put_window(grid *file, size_t window, size_t first, const char *point, size_t count)
{
    const dea_layout *layout = &file->layout;
    size_t told;
    const dea_column *columns = dea_window_columns(file->scene, &told);
    dea_window_figures *figures = calloc(count, sizeof *figures);
    if (!figures) {
        grid_keep(file, NC_ENOMEM);
        return;
    }
    for (size_t j = 0; j < count; j++) {
        dea_scene placed = *file->scene;
        dea_axes_place(&placed, first + j);
        const char *samples = point + j * layout->point_size;
        figures[j] = dea_measure_window(&placed, (const dea_sample *)(const void *)samples, layout->rows,
                                        dea_layout_summary(layout, samples), window);
    }
    put_figures(file, file->window_figures, columns, told, figures, sizeof *figures, count);
    free(figures);
}

static void put_windows_of(grid *file, size_t first, const char *point, size_t count)
{
    const size_t window = file->lead + file->point_rank;
    const char *means = point + file->layout.rows * file->layout.row_size + offsetof(dea_summary, averages);
    file->edge[window] = 1;
    for (size_t i = 0; i < file->scene->transient.average_count; i++) {
        file->start[window] = i;
        put_figures(file, file->averages, averages, AVERAGES, means + i * sizeof(dea_average), file->layout.point_size, count);
        put_window(file, i, first, point, count);
    }
}

/* The answer to an edge of run number @p run, whose samples do not hide the film's swing. */
static dea_edge_answer edge_of(const grid *file, size_t run, const char *point, size_t edge)
{
    const double none = (double)NAN;
    dea_scene scene = *file->scene;
    dea_edge_answer found[DEA_EDGES];
    const dea_summary *summary = dea_layout_summary(&file->layout, point);
    dea_axes_place(&scene, run);
    scene.models[0] = file->scene->models[run / dea_scene_point_count(file->scene)];
    const bool hidden = dea_measure_lives(&scene, summary) && !dea_measure_shows(&scene, summary);
    const size_t count =
        hidden ? 0 : dea_measure_edges(&scene, (const dea_sample *)(const void *)point, file->layout.rows, summary, found);
    for (size_t i = 0; i < count; i++) {
        if (found[i].rising == (edge == 0)) {
            return found[i];
        }
    }
    return (dea_edge_answer){none, .change = none, .overshoot = none, .rise = {none, none}, .settling = {none, none}};
}

static void put_edges_of(grid *file, size_t first, const char *point, size_t count)
{
    const size_t place = file->lead + file->point_rank;
    dea_edge_answer *answers = calloc(count, sizeof *answers);
    if (!answers) {
        grid_keep(file, NC_ENOMEM);
        return;
    }
    file->edge[place] = 1;
    for (size_t i = 0; i < DEA_EDGES; i++) {
        file->start[place] = i;
        for (size_t j = 0; j < count; j++) {
            answers[j] = edge_of(file, first + j, point + j * file->layout.point_size, i);
        }
        put_figures(file, file->step_figures, edges, EDGE_FIGURES, answers, sizeof *answers, count);
    }
    free(answers);
}

/* What one row of @p count points tells at some radii, the points side by side at each. */
static void put_entries(grid *file, const char *point, size_t count, const size_t *start, const size_t *edge)
{
    const dea_layout *layout = &file->layout;
    for (size_t i = 0; i < layout->spread_count; i++) {
        for (size_t k = 0; k < edge[1]; k++) {
            for (size_t j = 0; j < count; j++) {
                file->values[k * count + j] = dea_layout_entry(layout, point + j * layout->point_size, start[0], start[1] + k)[i];
            }
        }
        grid_keep(file, file->nc.nc_put_vara_double(file->file, file->spread[i], start, edge, file->values));
    }
}

/* What the rows of @p count points tell over the radius, as many radii at a time as there is room for. */
static void put_spread(grid *file, const char *point, size_t count)
{
    const size_t points = file->layout.spread_points, most = SLAB_VALUES / count;
    size_t *start = calloc(2 * (file->point_rank + 2), sizeof *start), *edge = start + file->point_rank + 2;
    if (!start) {
        grid_keep(file, NC_ENOMEM);
        return;
    }
    memcpy(start + 2, &file->start[file->lead], file->point_rank * sizeof *start);
    memcpy(edge + 2, &file->edge[file->lead], file->point_rank * sizeof *edge);
    edge[0] = 1;
    for (start[0] = 0; start[0] < file->layout.rows && !file->failed; start[0]++) {
        for (start[1] = 0; start[1] < points; start[1] += most) {
            edge[1] = points - start[1] < most ? points - start[1] : most;
            put_entries(file, point, count, start, edge);
        }
    }
    free(start);
}

/* Puts a slab of points, the first of them number @p first: rows as many at a time as there is room for. */
static void put_slab(grid *file, size_t first, const char *point, size_t count)
{
    const size_t rows = file->layout.rows, most = SLAB_VALUES / count;
    for (size_t row = 0; row < rows && !file->failed; row += most) {
        const size_t taken = rows - row < most ? rows - row : most;
        if (has_coordinate(file)) {
            file->start[0] = row;
            file->edge[0] = taken;
        }
        slab_put(file, point + row * file->layout.row_size, count, taken);
    }
    const char *behind = point + rows * file->layout.row_size;
    put_figures(file, file->figures, file->study->figures, file->study->figure_count, behind, file->layout.point_size, count);
    if (file->layout.spread_count > 0) {
        put_spread(file, point, count);
    }
    if (file->study->timed) {
        put_windows_of(file, first, point, count);
    }
    if (has_edges(file)) {
        put_edges_of(file, first, point, count);
    }
}

static void put_points(grid *file, size_t first, const char *points, size_t count)
{
    for (size_t done = 0; done < count && !file->failed;) {
        const size_t left = count - done;
        const size_t taken = slab_next(file, first + done, left < SLAB_VALUES ? left : SLAB_VALUES);
        put_slab(file, first + done, points + done * file->layout.point_size, taken);
        done += taken;
    }
}

/* Puts the points that waited. */
static void held_put(grid *file)
{
    put_points(file, file->held_first, file->held, file->held_count);
    file->held_first += file->held_count;
    file->held_count = 0;
}

static dea_status grid_points(void *state, size_t first, const void *points, size_t count, dea_error *error)
{
    grid *file = state;
    const size_t size = file->layout.point_size;
    if (!has_coordinate(file)) {
        put_points(file, first, points, count);
    }
    for (size_t done = 0; has_coordinate(file) && done < count && !file->failed;) {
        const size_t left = count - done, room = file->held_room - file->held_count, taken = left < room ? left : room;
        memcpy(file->held + file->held_count * size, (const char *)points + done * size, taken * size);
        file->held_count += taken;
        done += taken;
        if (file->held_count == file->held_room) {
            held_put(file);
        }
    }
    return grid_status(file, error);
}

static dea_status grid_close(void *state, bool keep, dea_error *error)
{
    grid *file = state;
    if (!file) {
        return DEA_OK;
    }
    dea_status status = DEA_OK;
    if (file->file >= 0) {
        if (keep) {
            held_put(file);
        }
        grid_keep(file, file->nc.nc_close(file->file));
        status = keep ? grid_status(file, error) : DEA_OK;
    }
    grid_free(file);
    return status;
}

static dea_status grid_open(const dea_scene *scene, const char *engine, dea_atomic *file, void **state, dea_error *error)
{
    grid *opened = calloc(1, sizeof *opened);
    if (!opened) {
        return dea_fail(error, DEA_ERROR_MEMORY, "out of memory");
    }
    opened->scene = scene;
    opened->study = dea_study_of(scene);
    opened->layout = dea_layout_of(scene);
    opened->target = file->target;
    opened->file = -1;
    dea_status status = grid_allocate(opened);
    if (status != DEA_OK) {
        dea_fail(error, status, "out of memory");
    } else {
        status = library_load(&opened->nc, error);
    }
    if (status == DEA_OK) {
        grid_define(opened, file->temporary, engine);
        status = grid_status(opened, error);
    }
    if (status != DEA_OK) {
        grid_close(opened, false, NULL);
        return status;
    }
    *state = opened;
    return DEA_OK;
}

const dea_format dea_format_netcdf = {
    .name = "nc", .straight = false, .open = grid_open, .points = grid_points, .close = grid_close};
