/* NetCDF classic (64-bit offset; CDF-5 where a variable is too large for it): swept axes as dimensions, CF attributes. The
 * classic layout keeps a variable in one piece, so blocks go straight to their place and every NetCDF reader opens it. No time
 * stamp: the same study gives the same bytes. libnetcdf is loaded when the first such file is opened; nobody else pays for it. */
#include "output/writer.h"

#include "deaspice/model.h"

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

enum { SLAB_POINTS = 4096, TEXT_LENGTH = 512 };

/* Largest number of doubles in one variable of the 64-bit offset format: 2^32 - 4 bytes. */
static const uint64_t offset_points = UINT64_C(4294967292) / sizeof(double);

#define NETCDF_LIST(X) \
    X(nc_create) \
    X(nc_set_fill) \
    X(nc_def_dim) \
    X(nc_def_var) \
    X(nc_put_att_text) \
    X(nc_put_att_double) \
    X(nc_put_att_schar) \
    X(nc_enddef) \
    X(nc_put_var_double) \
    X(nc_put_vara_double) \
    X(nc_put_vara_schar) \
    X(nc_put_vara_text) \
    X(nc_close) \
    X(nc_strerror)

/* The functions of libnetcdf, with the types of its header. */
typedef struct netcdf_library {
    void *handle;
#define X(name) __typeof__(&name) name;
    NETCDF_LIST(X)
#undef X
} netcdf_library;

typedef struct grid {
    netcdf_library nc;
    const dea_scene *scene;
    const char *target;           /* for messages */
    int file;                     /* -1: not open */
    size_t rank;                  /* dimensions of a variable */
    size_t *shape, *start, *edge; /* rank values each */
    int *dimensions;              /* rank values, and one for the length of names */
    int *axes;                    /* variable of each axis */
    int columns[DEA_ROW_COLUMNS]; /* variables of the rows */
    int state, model;
    int failed; /* first status of the library that is not 0 */
    double values[SLAB_POINTS];
    signed char states[SLAB_POINTS];
} grid;

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
#define X(name)                                                                                            \
    *(void **)&nc->name = dlsym(nc->handle, #name);                                                        \
    if (!nc->name) {                                                                                       \
        return dea_fail(error, DEA_ERROR_MISSING, "this libnetcdf has no " #name "; install a newer one"); \
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

/* Every scalar of the scene that is given and not swept. */
static void put_scalars(grid *file)
{
    static const struct {
        const char *name;
        size_t offset;
    } scalars[] = {
        {"frame_radius_m", offsetof(dea_scene, actuator.frame_radius)},
        {"coverage", offsetof(dea_scene, actuator.coverage)},
        {"divide_radius_m", offsetof(dea_scene, actuator.divide_radius)},
        {"film_thickness_m", offsetof(dea_scene, actuator.film_thickness)},
        {"prestretch", offsetof(dea_scene, actuator.prestretch)},
        {"electrode_mass_kg_per_m2", offsetof(dea_scene, actuator.electrode_mass)},
        {"focal_length_m", offsetof(dea_scene, actuator.focal_length)},
        {"refractive_index", offsetof(dea_scene, actuator.refractive_index)},
        {"yeoh_C1_Pa", offsetof(dea_scene, material.yeoh[0])},
        {"yeoh_C2_Pa", offsetof(dea_scene, material.yeoh[1])},
        {"yeoh_C3_Pa", offsetof(dea_scene, material.yeoh[2])},
        {"permittivity", offsetof(dea_scene, material.permittivity)},
        {"permittivity_per_stretch", offsetof(dea_scene, material.permittivity_per_stretch)},
        {"density_kg_per_m3", offsetof(dea_scene, material.density)},
        {"retardation_s", offsetof(dea_scene, material.retardation)},
        {"modulus_Pa", offsetof(dea_scene, material.modulus)},
        {"breakdown_V_per_m", offsetof(dea_scene, material.breakdown)},
        {"voltage_V", offsetof(dea_scene, drive.voltage)},
        {"series_resistance_ohm", offsetof(dea_scene, drive.series_resistance)},
        {"leakage_resistance_ohm", offsetof(dea_scene, drive.leakage_resistance)},
        {"accuracy", offsetof(dea_scene, accuracy)},
    };
    for (size_t i = 0; i < sizeof scalars / sizeof *scalars; i++) {
        double value;
        memcpy(&value, (const char *)file->scene + scalars[i].offset, sizeof value);
        if (!isnan(value) && !is_swept(file->scene, scalars[i].offset)) {
            put_number(file, NC_GLOBAL, scalars[i].name, value);
        }
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
    snprintf(history, sizeof history, "deaspice %s: static study of %zu points by engine %s", DEA_VERSION,
             dea_scene_point_count(scene) * scene->model_count, engine);
    put_text(file, NC_GLOBAL, "Conventions", "CF-1.10");
    put_text(file, NC_GLOBAL, "title", scene->title);
    put_text(file, NC_GLOBAL, "source", "deaspice " DEA_VERSION);
    put_text(file, NC_GLOBAL, "history", history);
    put_text(file, NC_GLOBAL, "engine", engine);
    put_text(file, NC_GLOBAL, "models", models);
    put_text(file, NC_GLOBAL, "actuator", scene->actuator.kind == DEA_DOT ? "dot" : "lens");
    put_text(file, NC_GLOBAL, "material", scene->material.name);
    put_text(file, NC_GLOBAL, "material_source", scene->material.source);
    put_scalars(file);
    put_prony(file);
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

/* Dimension and variable of the models, slowest of all. */
static void define_model(grid *file)
{
    int pair[2] = {0, 0};
    grid_keep(file, file->nc.nc_def_dim(file->file, "model", file->scene->model_count, &pair[0]));
    grid_keep(file, file->nc.nc_def_dim(file->file, "model_name_length", model_name_length(file->scene), &pair[1]));
    grid_keep(file, file->nc.nc_def_var(file->file, "model", NC_CHAR, 2, pair, &file->model));
    put_text(file, file->model, "long_name", "static model");
    put_text(file, file->model, "_Encoding", "utf-8");
    file->dimensions[0] = pair[0];
    file->shape[0] = file->scene->model_count;
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

static void define_columns(grid *file)
{
    const int rank = (int)file->rank;
    for (size_t i = 0; i < DEA_ROW_COLUMNS; i++) {
        const dea_column *column = &dea_row_columns[i];
        grid_keep(file, file->nc.nc_def_var(file->file, column->name, NC_DOUBLE, rank, file->dimensions, &file->columns[i]));
        put_text(file, file->columns[i], "units", column->unit);
        put_text(file, file->columns[i], "long_name", column->long_name);
        put_number(file, file->columns[i], "_FillValue", NAN);
    }
    grid_keep(file, file->nc.nc_def_var(file->file, "state", NC_BYTE, rank, file->dimensions, &file->state));
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
}

static void grid_define(grid *file, const char *path, const char *engine)
{
    const dea_scene *scene = file->scene;
    const bool large = dea_scene_point_count(scene) * scene->model_count > offset_points;
    int old_fill;
    file->failed = file->nc.nc_create(path, NC_CLOBBER | (large ? NC_64BIT_DATA : NC_64BIT_OFFSET), &file->file);
    if (file->failed) {
        file->file = -1;
        return;
    }
    grid_keep(file, file->nc.nc_set_fill(file->file, NC_NOFILL, &old_fill)); /* every value is written */
    put_provenance(file, engine);
    size_t dimension = 0;
    if (scene->model_count > 1) {
        define_model(file);
        dimension = 1;
    }
    for (size_t i = 0; i < scene->axis_count; i++) {
        define_axis(file, i, dimension + i);
    }
    define_columns(file);
    grid_keep(file, file->nc.nc_enddef(file->file));
    put_coordinates(file);
}

static void grid_free(grid *file)
{
    free(file->shape);
    free(file->dimensions);
    if (file->nc.handle) {
        dlclose(file->nc.handle);
    }
    free(file);
}

static dea_status grid_close(void *state, bool keep, dea_error *error)
{
    grid *file = state;
    if (!file) {
        return DEA_OK;
    }
    dea_status status = DEA_OK;
    if (file->file >= 0) {
        grid_keep(file, file->nc.nc_close(file->file));
        status = keep ? grid_status(file, error) : DEA_OK;
    }
    grid_free(file);
    return status;
}

static dea_status grid_allocate(grid *file)
{
    const size_t rank = file->scene->axis_count + (file->scene->model_count > 1 ? 1 : 0);
    file->rank = rank;
    file->shape = calloc(3 * rank + 1, sizeof *file->shape);
    file->dimensions = calloc(2 * rank + 1, sizeof *file->dimensions);
    if (!file->shape || !file->dimensions) {
        return DEA_ERROR_MEMORY;
    }
    file->start = file->shape + rank;
    file->edge = file->start + rank;
    file->axes = file->dimensions + rank;
    return DEA_OK;
}

static dea_status grid_open(const dea_scene *scene, const char *engine, dea_atomic *file, void **state, dea_error *error)
{
    grid *opened = calloc(1, sizeof *opened);
    if (!opened) {
        return dea_fail(error, DEA_ERROR_MEMORY, "out of memory");
    }
    opened->scene = scene;
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

/* The largest slab of the grid that starts at flattened point @p first and is one run of at most @p count points; its points. */
static size_t slab_next(grid *file, size_t first, size_t count)
{
    size_t rest = first;
    for (size_t i = file->rank; i-- > 0; rest /= file->shape[i]) {
        file->start[i] = rest % file->shape[i];
        file->edge[i] = 1;
    }
    size_t points = 1;
    for (size_t i = file->rank; i-- > 0;) {
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

static void slab_put(grid *file, const dea_row *rows, size_t points)
{
    for (size_t i = 0; i < DEA_ROW_COLUMNS; i++) {
        for (size_t j = 0; j < points; j++) {
            memcpy(&file->values[j], (const char *)&rows[j] + dea_row_columns[i].offset, sizeof file->values[j]);
        }
        grid_keep(file, file->nc.nc_put_vara_double(file->file, file->columns[i], file->start, file->edge, file->values));
    }
    for (size_t j = 0; j < points; j++) {
        file->states[j] = (signed char)rows[j].state;
    }
    grid_keep(file, file->nc.nc_put_vara_schar(file->file, file->state, file->start, file->edge, file->states));
}

static dea_status grid_rows(void *state, size_t first, const dea_row *rows, size_t count, dea_error *error)
{
    grid *file = state;
    for (size_t done = 0; done < count && !file->failed;) {
        const size_t left = count - done;
        const size_t points = slab_next(file, first + done, left < SLAB_POINTS ? left : SLAB_POINTS);
        slab_put(file, rows + done, points);
        done += points;
    }
    return grid_status(file, error);
}

const dea_format dea_format_netcdf = {.name = "nc", .straight = false, .open = grid_open, .rows = grid_rows, .close = grid_close};
