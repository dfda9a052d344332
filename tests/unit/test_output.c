/* Writers and pictures: what a file holds, when it appears, and what is refused. */
#define _GNU_SOURCE /* posix_openpt */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include <dirent.h>
#include <dlfcn.h>
#include <fcntl.h>
#include <locale.h>
#include <math.h>
#include <netcdf.h>
#include <poll.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <time.h>
#include <unistd.h>

#include "deaspice/deaspice.h"
#include "deaspice/model.h"
#include "deaspice/output.h"
#include "deaspice/plot.h"
#include "output/progress.h"
#include "picture/runs.h"
#include "support/number.h"

static char folder[64];

static const char *in_folder(const char *name)
{
    static char path[4][384];
    static int turn;
    turn = (turn + 1) % 4;
    snprintf(path[turn], sizeof path[turn], "%s/%s", folder, name);
    return path[turn];
}

static int folder_make(void **state)
{
    (void)state;
    strcpy(folder, "/tmp/deaspice-test-XXXXXX");
    return mkdtemp(folder) ? 0 : -1;
}

static int folder_count(void)
{
    int count = 0;
    DIR *open = opendir(folder);
    for (const struct dirent *entry; open && (entry = readdir(open));) {
        count += entry->d_name[0] != '.' || strlen(entry->d_name) > 2;
    }
    closedir(open);
    return count;
}

static int folder_remove(void **state)
{
    (void)state;
    DIR *open = opendir(folder);
    for (const struct dirent *entry; open && (entry = readdir(open));) {
        unlink(in_folder(entry->d_name));
    }
    closedir(open);
    return rmdir(folder);
}

/* A scene of up to three axes, without the reader. */
static dea_axis axes[3];
static double values[3][200000];
static const dea_model lumped = {.name = "lumped", .equation = "Eqs. 19-23"},
                       coverage = {.name = "coverage", .equation = "Eq. 18"};
static char title[4096];

static dea_scene scene_make(size_t axis_count, const size_t *counts, size_t models)
{
    static const char *const keys[] = {"drive.voltage", "actuator.coverage", "actuator.prestretch"};
    static const char *const columns[] = {"voltage_V", "coverage", "prestretch"}, *const units[] = {"V", "1", "1"};
    static const double from[] = {0.0, 0.1, 1.1}, to[] = {4500.0, 0.9, 1.3};
    const size_t offsets[] = {offsetof(dea_scene, drive.voltage), offsetof(dea_scene, actuator.coverage),
                              offsetof(dea_scene, actuator.prestretch)};
    for (size_t i = 0; i < axis_count; i++) {
        axes[i] = (dea_axis){.unit = "", .offset = offsets[i], .uniform = true, .values = values[i], .count = counts[i]};
        strcpy(axes[i].key, keys[i]);
        strcpy(axes[i].column, columns[i]);
        strcpy(axes[i].unit, units[i]);
        for (size_t j = 0; j < counts[i]; j++) {
            values[i][j] = counts[i] > 1 ? from[i] + (to[i] - from[i]) * (double)j / (double)(counts[i] - 1) : from[i];
        }
    }
    strcpy(title, "test");
    dea_scene scene = {.title = title, .accuracy = 1e-6, .models = {&lumped, &coverage}, .model_count = models, .axes = axes};
    scene.axis_count = axis_count;
    scene.actuator = (dea_actuator){DEA_DOT, 0.03, 0.5, NAN, 1e-4, 1.2, NAN, NAN, NAN, 1.0};
    scene.drive = (dea_drive){.voltage = 4500.0, .series_resistance = NAN, .leakage_resistance = NAN};
    scene.material =
        (dea_material){.name = "test film", .source = "nowhere", .law = dea_law_find("yeoh"),
                       .constants = {178426.0, -6023.0, 4234.0}, .permittivity = 2.8};
    scene.material.density = scene.material.retardation = scene.material.modulus = scene.material.breakdown = NAN;
    return scene;
}

/* Numbers that tell their row. */
static dea_row row_make(size_t number)
{
    const double x = (double)number;
    return (dea_row){.strain = 0.001 * x,
                     .displacement = 1e-5 * x,
                     .force = 0.25 + x,
                     .field = 1e6 / (1.0 + x),
                     .capacitance = 1e-10 + x,
                     .charge = 2.0 - x,
                     .area_strain = 0.5 * x,
                     .energy = 0.25 * x,
                     .focal_length = 0.02 + x,
                     .state = DEA_STATE_OK};
}

static dea_status rows_write(dea_writer *writer, size_t total, size_t block, dea_error *error)
{
    dea_row rows[1000];
    dea_status status = DEA_OK;
    for (size_t first = 0; first < total && status == DEA_OK; first += block) {
        const size_t count = total - first < block ? total - first : block;
        for (size_t i = 0; i < count; i++) {
            rows[i] = row_make(first + i);
        }
        status = dea_writer_points(writer, first, rows, count, error);
    }
    return status;
}

/* The scene as a transient of @p samples samples, 0.5 s apart, with a port; its points hold numbers that tell their place. */
static dea_scene transient_make(size_t axis_count, const size_t *counts, size_t models, size_t samples)
{
    dea_scene scene = scene_make(axis_count, counts, models);
    scene.study = DEA_STUDY_TRANSIENT;
    strcpy(axes[0].column, "step_voltage_V"); /* the voltage is a column of its own */
    axes[0].offset = offsetof(dea_scene, drive.waveform.step.voltage);
    scene.transient = (dea_transient){.until = 0.5 * (double)(samples - 1), .every = 0.5};
    scene.drive = (dea_drive){.voltage = NAN, .series_resistance = 1e6, .leakage_resistance = NAN};
    scene.drive.waveform = (dea_waveform){.kind = DEA_WAVE_STEP, .step = {1.0, NAN, 4500.0, 0.0}, .period = NAN};
    return scene;
}

/* The scene as a frequency response of @p decades decades from 1 Hz, ten rows each. */
static dea_scene response_make(size_t axis_count, const size_t *counts, size_t models, int decades)
{
    dea_scene scene = scene_make(axis_count, counts, models);
    scene.study = DEA_STUDY_AC;
    scene.ac = (dea_ac){.from = 1.0, .to = pow(10.0, decades), .points_per_decade = 10, .bias = 4500.0};
    return scene;
}

static double sample_displacement(size_t number, double time)
{
    return 1e-4 * (double)(number + 1) * (1.0 - exp(-time));
}

/* Number @p index of what the rows of a run tell over the radius. */
static double entry_made(size_t number, size_t index)
{
    return 1e6 * (double)number + (double)index;
}

static void point_make(const dea_scene *scene, const dea_layout *layout, size_t number, void *point)
{
    for (size_t i = 0; i < layout->rows; i++) {
        const double at = dea_layout_place(scene, i);
        void *row = (char *)point + i * layout->row_size;
        if (scene->study == DEA_STUDY_TRANSIENT) {
            const double u = sample_displacement(number, at);
            *(dea_sample *)row = (dea_sample){at, 4500.0, u, u / 0.015, 0.25, 0.5, 1e-6, 2e-6, NAN, 4400.0, 2.5e-10, DEA_STATE_OK, {.field = 0.0}};
        } else {
            const double x = at / (100.0 * (double)(number + 1));
            *(dea_response *)row =
                (dea_response){at, 1e-9 / fabs(1.0 - x * x + 1e-3), x > 1.0 ? 180.0 : 0.0, 1e9 / at, -90.0, DEA_STATE_OK};
        }
    }
    if (scene->study == DEA_STUDY_AC) {
        *dea_layout_band(layout, point) = (dea_band){100.0 + (double)number, 150.0};
    }
    if (scene->study == DEA_STUDY_TRANSIENT) {
        const double x = (double)number;
        *dea_layout_summary(layout, point) = (dea_summary){.error = 1e-9,
                                                           .velocity_error = 2e-9,
                                                           .current_error = 3e-9,
                                                           .work = 1.0 + x,
                                                           .electric = 2.0 + x,
                                                           .elastic = 3.0 + x,
                                                           .kinetic = 4.0 + x,
                                                           .dissipated = 5.0 + x,
                                                           .residual = 1e-8,
                                                           .resonance = 700.0 + x,
                                                           .averages = {{0.01, 1e-3}, {0.02, 2e-3 + x}}};
    }
    for (size_t i = 0; i < layout->rows * layout->spread_points * layout->spread_count; i++) {
        dea_layout_entry(layout, point, 0, 0)[i] = entry_made(number, i);
    }
}

/* Writes all points of a transient or a frequency response, @p block at a time. */
static dea_status points_write(const dea_scene *scene, const char *path, size_t block, dea_error *error)
{
    const dea_layout layout = dea_layout_of(scene);
    const size_t total = dea_scene_point_count(scene) * scene->model_count;
    char *points = calloc(block, layout.point_size);
    dea_writer *writer;
    dea_status status = dea_writer_open(scene, "direct", path, NULL, &writer, error);
    for (size_t first = 0; first < total && status == DEA_OK; first += block) {
        const size_t count = total - first < block ? total - first : block;
        for (size_t i = 0; i < count; i++) {
            point_make(scene, &layout, first + i, points + i * layout.point_size);
        }
        status = dea_writer_points(writer, first, points, count, error);
    }
    free(points);
    const dea_status finished = dea_writer_finish(writer, status == DEA_OK, error);
    return status != DEA_OK ? status : finished;
}

static char *file_text(const char *path)
{
    static char text[1 << 20];
    FILE *file = fopen(path, "rb");
    assert_non_null(file);
    text[fread(text, 1, sizeof text - 1, file)] = '\0';
    fclose(file);
    return text;
}

static void numbers_print_as_printf_does(void **state)
{
    (void)state;
    static const double special[] = {0.0,
                                     -0.0,
                                     1.0,
                                     0.1,
                                     1e-4,
                                     9.9999999999999991e-5,
                                     1e-5,
                                     123456.0,
                                     1e15,
                                     1e16,
                                     9999999999999998.0,
                                     1e17,
                                     1e-10,
                                     4.5e-12,
                                     5e-324,
                                     1.7976931348623157e308,
                                     0.3,
                                     2.5,
                                     1e22,
                                     -4500.0,
                                     INFINITY};
    uint64_t seed = 88172645463325252u;
    for (size_t i = 0; i < 200000; i++) {
        seed ^= seed << 13;
        seed ^= seed >> 7;
        seed ^= seed << 17;
        double value = (double)(seed >> 11) * pow(10.0, (int)(i % 40) - 30);
        value = i < sizeof special / sizeof *special ? special[i] : i % 2 ? value : (double)(seed % 1000000) / 1000.0;
        char ours[DEA_NUMBER_LENGTH + 1], theirs[64];
        ours[dea_number_write(ours, value)] = '\0';
        snprintf(theirs, sizeof theirs, "%.17g", value);
        assert_string_equal(ours, value == 0.0 ? "0" : theirs);
    }
}

static void numbers_keep_their_point_whatever_the_locale(void **state)
{
    (void)state;
    static const char *const names[] = {"de_DE.UTF-8", "de_DE.utf8", "fr_FR.UTF-8", "de_DE"};
    locale_t comma = (locale_t)0;
    for (size_t i = 0; i < 4 && !comma; i++) {
        comma = newlocale(LC_ALL_MASK, names[i], (locale_t)0);
    }
    if (!comma) {
        skip();
    }
    const locale_t before = uselocale(comma);
    char text[DEA_NUMBER_LENGTH], tiny[DEA_NUMBER_LENGTH + 1];
    dea_number_text(text, 1.5, 6);
    tiny[dea_number_write(tiny, 1.5e-30)] = '\0';
    uselocale(before);
    freelocale(comma);
    assert_string_equal(text, "1.5");
    assert_string_equal(tiny, "1.4999999999999999e-30");
}

static void csv_holds_axes_then_numbers_then_the_state(void **state)
{
    (void)state;
    const size_t counts[] = {2, 2};
    const dea_scene scene = scene_make(2, counts, 1);
    dea_error error = {0};
    dea_writer *writer;
    assert_int_equal(dea_writer_open(&scene, "direct", in_folder("a.csv"), NULL, &writer, &error), DEA_OK);
    dea_row rows[4] = {row_make(0), row_make(1), row_make(2), dea_row_failed()};
    rows[3].state = DEA_STATE_PULL_IN;
    rows[2].state = DEA_STATE_SLACK;
    assert_int_equal(dea_writer_points(writer, 0, rows, 4, &error), DEA_OK);
    assert_int_equal(dea_writer_finish(writer, true, &error), DEA_OK);
    assert_string_equal(file_text(in_folder("a.csv")),
                        "voltage_V,coverage,strain,displacement_m,force_N,field_V_per_m,capacitance_F,charge_C,area_strain,energy_J,state\n"
                        "0,0.10000000000000001,0,0,0.25,1000000,1e-10,2,0,0,ok\n"
                        "0,0.90000000000000002,0.001,1.0000000000000001e-05,1.25,500000,1.0000000001,1,0.5,0.25,ok\n"
                        "4500,0.10000000000000001,0.002,2.0000000000000002e-05,2.25,333333.33333333331,2.0000000001,0,1,0.5,slack\n"
                        "4500,0.90000000000000002,,,,,,,,,pull_in\n");
}

static void csv_names_the_model_where_there_are_several(void **state)
{
    (void)state;
    const dea_scene scene = scene_make(0, NULL, 2);
    dea_error error = {0};
    dea_writer *writer;
    assert_int_equal(dea_writer_open(&scene, "direct", in_folder("a.csv"), NULL, &writer, &error), DEA_OK);
    assert_int_equal(rows_write(writer, 2, 1, &error), DEA_OK);
    assert_int_equal(dea_writer_finish(writer, true, &error), DEA_OK);
    assert_string_equal(file_text(in_folder("a.csv")), "model,strain,displacement_m,force_N,field_V_per_m,capacitance_F,charge_C,area_strain,energy_J,state\n"
                        "lumped,0,0,0.25,1000000,1e-10,2,0,0,ok\n"
                        "coverage,0.001,1.0000000000000001e-05,1.25,500000,1.0000000001,1,0.5,0.25,ok\n");
}

static void csv_of_a_transient_holds_the_run_before_every_sample(void **state)
{
    (void)state;
    const size_t counts[] = {2};
    dea_scene scene = transient_make(1, counts, 2, 3);
    dea_error error = {0};
    dea_writer *writer;
    assert_int_equal(dea_writer_open(&scene, "direct", in_folder("a.csv"), NULL, &writer, &error), DEA_OK);
    const dea_layout layout = dea_layout_of(&scene);
    char *point = calloc(1, layout.point_size);
    for (size_t number = 0; number < 4; number++) {
        dea_sample *samples = (dea_sample *)(void *)point;
        for (size_t i = 0; i < 3; i++) {
            samples[i] = (dea_sample){0.5 * (double)i, 4500.0, 0.125, 0.25, 2.0, 0.5, 3.0, 4.0, 5.0, 6.0, 7.0, DEA_STATE_OK, {.field = 0.0}};
        }
        if (number == 3) {
            samples[2] = (dea_sample){1.0, 4500.0, NAN, NAN, NAN, NAN, NAN, NAN, NAN, NAN, NAN, DEA_STATE_PULL_IN, {.field = 0.0}};
        }
        assert_int_equal(dea_writer_points(writer, number, point, 1, &error), DEA_OK);
    }
    free(point);
    assert_int_equal(dea_writer_finish(writer, true, &error), DEA_OK);
    const char *text = file_text(in_folder("a.csv"));
    static const char begin[] =
        "model,step_voltage_V,time_s,voltage_V,displacement_m,strain,velocity_m_per_s,force_N,current_A,charge_C,film_voltage_V,capacitance_F,state\n"
        "lumped,0,0,4500,0.125,0.25,2,0.5,3,4,6,7,ok\n"
        "lumped,0,0.5,4500,0.125,0.25,2,0.5,3,4,6,7,ok\n";
    assert_int_equal(strncmp(text, begin, strlen(begin)), 0);
    assert_non_null(strstr(text, "\ncoverage,4500,0.5,4500,0.125,0.25,2,0.5,3,4,6,7,ok\ncoverage,4500,1,4500,,,,,,,,,pull_in\n"));
}

static void csv_of_a_frequency_response_holds_magnitudes_and_phases(void **state)
{
    (void)state;
    const dea_scene scene = response_make(0, NULL, 1, 1);
    dea_error error = {0};
    assert_int_equal(points_write(&scene, in_folder("a.csv"), 1, &error), DEA_OK);
    const char *text = file_text(in_folder("a.csv"));
    assert_non_null(
        strstr(text, "frequency_Hz,displacement_m_per_V,displacement_phase_deg,impedance_Ohm,impedance_phase_deg,state\n1,"));
    assert_non_null(strstr(text, "\n10,"));
}

static void blocks_of_any_size_give_the_same_bytes(void **state)
{
    (void)state;
    const size_t counts[] = {7, 11, 13};
    static const char *const names[] = {"a.csv", "a.nc"};
    const dea_scene scene = scene_make(3, counts, 2);
    for (size_t format = 0; format < 2; format++) {
        static char first[1 << 20];
        for (size_t block = 1; block < 1000; block = block * 3 + 1) {
            dea_error error = {0};
            dea_writer *writer;
            assert_int_equal(dea_writer_open(&scene, "direct", in_folder(names[format]), NULL, &writer, &error), DEA_OK);
            assert_int_equal(rows_write(writer, 2002, block, &error), DEA_OK);
            assert_int_equal(dea_writer_finish(writer, true, &error), DEA_OK);
            const char *text = file_text(in_folder(names[format]));
            if (block == 1) {
                memcpy(first, text, sizeof first);
            }
            assert_memory_equal(first, text, 60000);
        }
    }
}

static void runs_in_blocks_of_any_size_give_the_same_bytes(void **state)
{
    (void)state;
    const size_t counts[] = {3, 4};
    static const char *const names[] = {"a.csv", "a.nc"};
    for (size_t i = 0; i < 4; i++) {
        static char first[1 << 20];
        dea_scene scene = i < 2 ? transient_make(2, counts, 2, 57) : response_make(2, counts, 2, 4);
        scene.transient.averages[0] = (dea_window){1.0, 2.0};
        scene.transient.average_count = 1;
        for (size_t block = 1; block < 30; block = block * 3 + 1) {
            dea_error error = {0};
            assert_int_equal(points_write(&scene, in_folder(names[i % 2]), block, &error), DEA_OK);
            const char *text = file_text(in_folder(names[i % 2]));
            if (block == 1) {
                memcpy(first, text, sizeof first);
            }
            assert_memory_equal(first, text, 40000);
        }
    }
}

static void file_appears_when_it_is_finished_and_not_before(void **state)
{
    (void)state;
    static const char *const names[] = {"a.csv", "a.nc"};
    const size_t counts[] = {3};
    const dea_scene scene = scene_make(1, counts, 1);
    for (size_t i = 0; i < 2; i++) {
        dea_error error = {0};
        dea_writer *writer;
        assert_int_equal(dea_writer_open(&scene, "direct", in_folder(names[i]), NULL, &writer, &error), DEA_OK);
        assert_int_equal(rows_write(writer, 3, 2, &error), DEA_OK);
        assert_int_not_equal(access(in_folder(names[i]), F_OK), 0);
        assert_int_equal(dea_writer_finish(writer, true, &error), DEA_OK);
        assert_int_equal(access(in_folder(names[i]), F_OK), 0);
        assert_int_equal(folder_count(), (int)i + 1);
    }
}

static void discarded_file_leaves_the_old_one(void **state)
{
    (void)state;
    const size_t counts[] = {3};
    const dea_scene scene = scene_make(1, counts, 1);
    FILE *old = fopen(in_folder("a.csv"), "w");
    fputs("old", old);
    fclose(old);
    dea_error error = {0};
    dea_writer *writer;
    assert_int_equal(dea_writer_open(&scene, "direct", in_folder("a.csv"), NULL, &writer, &error), DEA_OK);
    assert_int_equal(rows_write(writer, 3, 2, &error), DEA_OK);
    assert_int_equal(dea_writer_finish(writer, false, &error), DEA_OK);
    assert_string_equal(file_text(in_folder("a.csv")), "old");
    assert_int_equal(folder_count(), 1);
}

static void missing_rows_make_no_file(void **state)
{
    (void)state;
    const size_t counts[] = {3};
    const dea_scene scene = scene_make(1, counts, 1);
    dea_error error = {0};
    dea_writer *writer;
    assert_int_equal(dea_writer_open(&scene, "direct", in_folder("a.csv"), NULL, &writer, &error), DEA_OK);
    assert_int_equal(rows_write(writer, 2, 2, &error), DEA_OK);
    const dea_row row = row_make(2);
    assert_int_equal(dea_writer_points(writer, 1, &row, 1, &error), DEA_ERROR_USAGE);
    assert_int_equal(dea_writer_points(writer, 2, &row, 2, &error), DEA_ERROR_USAGE);
    assert_int_equal(dea_writer_finish(writer, true, &error), DEA_ERROR_USAGE);
    assert_int_equal(folder_count(), 0);
}

static void link_stays_a_link(void **state)
{
    (void)state;
    const size_t counts[] = {3};
    const dea_scene scene = scene_make(1, counts, 1);
    FILE *old = fopen(in_folder("real.csv"), "w");
    fclose(old);
    assert_int_equal(symlink("real.csv", in_folder("link.csv")), 0);
    dea_error error = {0};
    dea_writer *writer;
    assert_int_equal(dea_writer_open(&scene, "direct", in_folder("link.csv"), NULL, &writer, &error), DEA_OK);
    assert_int_equal(rows_write(writer, 3, 2, &error), DEA_OK);
    assert_int_equal(dea_writer_finish(writer, true, &error), DEA_OK);
    struct stat about;
    assert_int_equal(lstat(in_folder("link.csv"), &about), 0);
    assert_true(S_ISLNK(about.st_mode));
    assert_non_null(strstr(file_text(in_folder("real.csv")), "voltage_V"));
}

static void targets_that_cannot_be_written_are_refused_at_once(void **state)
{
    (void)state;
    const dea_scene scene = scene_make(0, NULL, 1);
    const struct {
        const char *path, *format;
        dea_status status;
        const char *says;
    } cases[] = {
        {in_folder("none/a.csv"), NULL, DEA_ERROR_IO, "No such file or directory"},
        {folder, "csv", DEA_ERROR_IO, "Is a directory"},
        {in_folder("a.txt"), NULL, DEA_ERROR_USAGE, ".csv, .nc, .raw"},
        {in_folder("a.csv"), "json", DEA_ERROR_USAGE, "unknown format \"json\"; accepted: csv, nc, raw"},
        {"-", "nc", DEA_ERROR_USAGE, "regular file"},
        {"/dev/null", "nc", DEA_ERROR_USAGE, "regular file"},
        {"", "csv", DEA_ERROR_IO, "without a name"},
    };
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        dea_error error = {0};
        dea_writer *writer;
        assert_int_equal(dea_writer_open(&scene, "direct", cases[i].path, cases[i].format, &writer, &error), cases[i].status);
        assert_null(writer);
        assert_non_null(strstr(error.message, cases[i].says));
    }
    assert_int_equal(folder_count(), 0);
}

static void full_disk_is_an_error(void **state)
{
    (void)state;
    const size_t counts[] = {5000};
    const dea_scene scene = scene_make(1, counts, 1);
    dea_error error = {0};
    dea_writer *writer;
    assert_int_equal(dea_writer_open(&scene, "direct", "/dev/full", NULL, &writer, &error), DEA_OK);
    assert_int_equal(rows_write(writer, 5000, 500, &error), DEA_ERROR_IO);
    assert_non_null(strstr(error.message, "/dev/full: No space left on device"));
    dea_writer_finish(writer, false, NULL);
}

/* Value of a variable at one place, by the library's own reader. */
static double netcdf_value(void *library, const char *path, const char *variable, const size_t *place)
{
    __typeof__(&nc_open) open_file;
    __typeof__(&nc_inq_varid) find;
    __typeof__(&nc_get_var1_double) get;
    __typeof__(&nc_close) close_file;
    *(void **)&open_file = dlsym(library, "nc_open");
    *(void **)&find = dlsym(library, "nc_inq_varid");
    *(void **)&get = dlsym(library, "nc_get_var1_double");
    *(void **)&close_file = dlsym(library, "nc_close");
    int file, number;
    double value = NAN;
    assert_int_equal(open_file(path, NC_NOWRITE, &file), 0);
    assert_int_equal(find(file, variable, &number), 0);
    assert_int_equal(get(file, number, place, &value), 0);
    close_file(file);
    return value;
}

static void netcdf_holds_what_the_rows_held(void **state)
{
    (void)state;
    const size_t counts[] = {7, 11, 13};
    const dea_scene scene = scene_make(3, counts, 2);
    dea_error error = {0};
    dea_writer *writer;
    assert_int_equal(dea_writer_open(&scene, "direct", in_folder("a.nc"), NULL, &writer, &error), DEA_OK);
    assert_int_equal(rows_write(writer, 2002, 37, &error), DEA_OK);
    assert_int_equal(dea_writer_finish(writer, true, &error), DEA_OK);
    void *library = dlopen("libnetcdf.so.19", RTLD_NOW);
    library = library ? library : dlopen("libnetcdf.so", RTLD_NOW);
    assert_non_null(library);
    for (size_t number = 0; number < 2002; number += 91) {
        const size_t place[] = {number / 1001, number / 143 % 7, number / 13 % 11, number % 13};
        const dea_row row = row_make(number);
        assert_true(netcdf_value(library, in_folder("a.nc"), "strain", place) == row.strain);
        assert_true(netcdf_value(library, in_folder("a.nc"), "field_V_per_m", place) == row.field);
        assert_true(netcdf_value(library, in_folder("a.nc"), "coverage", &place[2]) == values[1][place[2]]);
    }
    dlclose(library);
}

static void *netcdf_library(void)
{
    void *library = dlopen("libnetcdf.so.19", RTLD_NOW);
    library = library ? library : dlopen("libnetcdf.so", RTLD_NOW);
    assert_non_null(library);
    return library;
}

/* Of a sine each window has its extremes and five harmonics; the film, slow beside it, follows U^2: u = a (1 - cos 2 theta)/2. */
static void netcdf_of_a_sine_holds_extremes_and_harmonics(void **state)
{
    static const char *const names[] = {"least_m", "largest_m", "peak_to_peak_m", "amplitude_1_m", "amplitude_2_m", "phase_2_deg"};
    static const double sizes[] = {0.0, 1.0, 1.0, 0.0, 0.5, -90.0};
    const char *path = in_folder("a.nc");
    const size_t counts[] = {3};
    dea_error error = {0};
    (void)state;
    dea_scene scene = transient_make(1, counts, 1, 401);
    scene.transient = (dea_transient){.until = 2.0, .every = 0.005, .averages = {{0.25, 1.25}}, .average_count = 1};
    scene.drive.waveform = (dea_waveform){.kind = DEA_WAVE_SINE, .sine = {.amplitude = 3000.0, .frequency = 1.0}, .period = NAN};
    const dea_layout layout = dea_layout_of(&scene);
    dea_writer *writer;
    dea_sample *samples = calloc(1, layout.point_size);
    assert_int_equal(dea_writer_open(&scene, "ida", path, NULL, &writer, &error), DEA_OK);
    for (size_t run = 0; run < counts[0]; run++) {
        const double a = 1e-4 * (double)(run + 1), w = 2.0 * DEA_PI;
        for (size_t i = 0; i < layout.rows; i++) {
            const double t = dea_layout_place(&scene, i);
            samples[i] = (dea_sample){.time = t, .displacement = 0.5 * a * (1.0 - cos(2.0 * w * t)), .velocity = a * w * sin(2.0 * w * t)};
        }
        *dea_layout_summary(&layout, samples) = (dea_summary){.error = 1e-9, .resonance = NAN, .averages = {{0.01, 0.5 * a}}};
        assert_int_equal(dea_writer_points(writer, run, samples, 1, &error), DEA_OK);
    }
    assert_int_equal(dea_writer_finish(writer, true, &error), DEA_OK);
    free(samples);
    void *library = netcdf_library();
    for (size_t run = 0; run < counts[0]; run++) {
        const double a = 1e-4 * (double)(run + 1);
        for (size_t i = 0; i < sizeof names / sizeof *names; i++) {
            const double value = netcdf_value(library, path, names[i], (const size_t[]){run, 0});
            assert_true(fabs(value - (i == 5 ? sizes[i] : sizes[i] * a)) <= (i == 5 ? 1e-3 : 1e-5 * a)); /* not where NAN */
        }
    }
    dlclose(library);
    assert_int_equal(unlink(path), 0);
}

static dea_status points_take(void *user, size_t first, const void *points, size_t count, dea_error *error)
{
    return dea_writer_points(user, first, points, count, error);
}

/* A film without mass behind a damper of retardation tau follows an edge by u = 1 - exp(-t/tau), whatever its size, and relaxes back
 * behind the other one, which the third run has not: tau ln 9 from 10 to 90 %, tau ln 50 until 2 % are left. The voltage softens `lame`,
 * which is slower then. */
static void netcdf_of_a_step_holds_rise_and_settling(void **state)
{
    static const char text[] = "actuator: {kind: dot, frame_radius: 30 mm, coverage: 0.5, film_thickness: 100 um, prestretch: 1.2}\n"
                               "material: {neo_hookean: {mu: 300 kPa}, permittivity: 2.8, retardation: 10 ms}\n"
                               "drive: {waveform: {step: {on: 1 ms, off: 200 ms, voltage: 4 kV}}}\nmodel: [lame, lumped]\n"
                               "study: {transient: {until: 400 ms, every: 0.1 ms}, over: {off: [200 ms, 250 ms, 500 ms]}}\n";
    const char *path = in_folder("a.nc");
    dea_scene scene;
    dea_error error = {0};
    dea_writer *writer;
    (void)state;
    if (dea_scene_parse(text, strlen(text), "test", ".", NULL, 0, NULL, &scene, &error) != DEA_OK ||
        dea_writer_open(&scene, "ida", path, NULL, &writer, &error) != DEA_OK ||
        dea_study_run(&scene, dea_engine_find("ida"), &(dea_run_options){.jobs = 1, .points = points_take, .user = writer}, &error) != DEA_OK ||
        dea_writer_finish(writer, true, &error) != DEA_OK) {
        fail_msg("%s", error.message);
    }
    dea_scene_free(&scene);
    void *library = netcdf_library();
    for (size_t i = 0; i < 12; i++) {
        const size_t place[] = {i / 6, i / 2 % 3, i % 2};
        const bool there = place[1] < 2 || place[2] == 0;
        const double begin = place[2] == 0 ? 1e-3 : place[1] == 0 ? 0.2 : 0.25;
        const double change = netcdf_value(library, path, "change_m", place), overshoot = netcdf_value(library, path, "overshoot", place);
        const double rise[] = {netcdf_value(library, path, "rise_least_s", place), netcdf_value(library, path, "rise_most_s", place)};
        const double settling = netcdf_value(library, path, "settling_most_s", place);
        assert_true(there ? netcdf_value(library, path, "edge_time_s", place) == begin : isnan(change) && isnan(overshoot) && isnan(settling));
        assert_true(!there || ((change > 0.0) == (place[2] == 0) && overshoot < 1e-5));
        if (there && (place[0] == 1 || place[2] == 1)) {
            assert_true(rise[0] < 0.01 * log(9.0) + 1e-6 && rise[1] > 0.01 * log(9.0) - 1e-6 && rise[1] - rise[0] < 1e-4);
            assert_true(fabs(settling - 0.01 * log(50.0)) < 1e-5);
        } else if (there) {
            assert_true(rise[0] > 0.0103 * log(9.0) && settling > 0.0103 * log(50.0));
        }
    }
    dlclose(library);
    assert_int_equal(unlink(path), 0);
}

/* Samples that fit in what the writer holds, and samples that do not. */
static void netcdf_of_a_transient_holds_time_samples_and_summaries(void **state)
{
    (void)state;
    const size_t counts[] = {3, 4}, samples[] = {57, 20001};
    void *library = netcdf_library();
    const char *path = in_folder("a.nc");
    for (size_t i = 0; i < sizeof samples / sizeof *samples; i++) {
        dea_scene scene = transient_make(2, counts, 2, samples[i]);
        const double until = 0.5 * (double)(samples[i] - 1);
        dea_error error = {0};
        scene.transient.averages[0] = (dea_window){1.0, 2.0};
        scene.transient.averages[1] = (dea_window){0.0, 28.0};
        scene.transient.average_count = 2;
        assert_int_equal(points_write(&scene, path, 5, &error), DEA_OK);
        for (size_t number = 0; number < 24; number++) {
            const size_t place[] = {samples[i] - 1, number / 12, number / 4 % 3, number % 4};
            const size_t early[] = {7, place[1], place[2], place[3]};
            const size_t window[] = {number / 12, number / 4 % 3, number % 4, 1};
            assert_true(netcdf_value(library, path, "displacement_m", place) == sample_displacement(number, until));
            assert_true(netcdf_value(library, path, "displacement_m", early) == sample_displacement(number, 3.5));
            assert_true(netcdf_value(library, path, "work_J", &place[1]) == 1.0 + (double)number);
            assert_true(netcdf_value(library, path, "estimated_velocity_error", &place[1]) == 2e-9);
            assert_true(netcdf_value(library, path, "resonance_Hz", &place[1]) == 700.0 + (double)number);
            assert_true(netcdf_value(library, path, "state", place) == (double)DEA_STATE_OK);
            assert_true(netcdf_value(library, path, "average_displacement_m", window) == 2e-3 + (double)number);
            assert_true(netcdf_value(library, path, "average_strain", window) == 0.02);
        }
        assert_true(netcdf_value(library, path, "time", (const size_t[]){7}) == 3.5);
        assert_true(netcdf_value(library, path, "window_to_s", (const size_t[]){1}) == 28.0);
    }
    dlclose(library);
}

/* Over time, radius and axes, whether the radii of a row fit into a slab of the writer or not; and in CSV a line each. */
static void what_rows_tell_over_the_radius_keeps_its_places(void **state)
{
    (void)state;
    enum { SAMPLES = 3 };
    static const size_t counts[][2] = {{3, 4}, {1, 1}, {2, 100}}, radii[] = {7, 5001, 301};
    void *library = netcdf_library();
    const char *path = in_folder("a.nc");
    for (size_t i = 0; i < sizeof radii / sizeof *radii; i++) {
        dea_scene scene = transient_make(2, counts[i], 1, SAMPLES);
        dea_error error = {0};
        scene.transient.points = radii[i];
        const size_t all = counts[i][0] * counts[i][1];
        assert_int_equal(points_write(&scene, path, 5, &error), DEA_OK);
        for (size_t number = 0; number < all; number += 1 + all / 7) {
            for (size_t row = 0; row < SAMPLES; row++) {
                const size_t radius = (number * 31 + row * 17) % radii[i], index = (row * radii[i] + radius) * DEA_SPREAD_COLUMNS;
                const size_t place[] = {row, radius, number / counts[i][1], number % counts[i][1]};
                assert_true(netcdf_value(library, path, "profile_displacement_m", place) == entry_made(number, index));
                assert_true(netcdf_value(library, path, "field_V_per_m", place) == entry_made(number, index + 7));
            }
        }
        assert_true(netcdf_value(library, path, "radius", (const size_t[]){radii[i] - 1}) == scene.actuator.frame_radius);
    }
    dea_scene scene = transient_make(1, counts[1], 1, SAMPLES);
    dea_error error = {0};
    char last[128];
    scene.transient.points = 2;
    assert_int_equal(points_write(&scene, in_folder("a.csv"), 1, &error), DEA_OK);
    snprintf(last, sizeof last, ",%d,%d,ok\n", SAMPLES * 2 * DEA_SPREAD_COLUMNS - 2, SAMPLES * 2 * DEA_SPREAD_COLUMNS - 1);
    const char *text = file_text(in_folder("a.csv"));
    assert_non_null(strstr(text, "radius_m,profile_displacement_m,profile_velocity_m_per_s,stretch_radial,"));
    assert_string_equal(text + strlen(text) - strlen(last), last);
    dlclose(library);
}

static void netcdf_of_a_frequency_response_lies_along_frequency(void **state)
{
    (void)state;
    const size_t counts[] = {3};
    const dea_scene scene = response_make(1, counts, 1, 4);
    dea_error error = {0};
    assert_int_equal(points_write(&scene, in_folder("a.nc"), 2, &error), DEA_OK);
    void *library = netcdf_library();
    for (size_t i = 0; i < 41; i++) {
        const size_t place[] = {i, 2};
        const double frequency = netcdf_value(library, in_folder("a.nc"), "frequency", &i);
        assert_true(frequency == dea_layout_place(&scene, i));
        assert_true(netcdf_value(library, in_folder("a.nc"), "impedance_Ohm", place) == 1e9 / frequency);
    }
    assert_true(netcdf_value(library, in_folder("a.nc"), "resonance_Hz", (const size_t[]){2}) == 102.0);
    assert_true(netcdf_value(library, in_folder("a.nc"), "bandwidth_Hz", (const size_t[]){2}) == 150.0);
    dlclose(library);
}

/* A number among the attributes of the file, NAN where there is none. */
static double netcdf_attribute(void *library, const char *path, const char *name)
{
    __typeof__(&nc_open) open_file;
    __typeof__(&nc_get_att_double) get;
    __typeof__(&nc_close) close_file;
    *(void **)&open_file = dlsym(library, "nc_open");
    *(void **)&get = dlsym(library, "nc_get_att_double");
    *(void **)&close_file = dlsym(library, "nc_close");
    int file;
    double value = NAN;
    assert_int_equal(open_file(path, NC_NOWRITE, &file), 0);
    const int status = get(file, NC_GLOBAL, name, &value);
    close_file(file);
    return status == 0 ? value : NAN;
}

static void netcdf_keeps_the_scalars_that_the_study_used(void **state)
{
    (void)state;
    const size_t counts[] = {2};
    dea_scene scene = transient_make(1, counts, 1, 3);
    dea_error error = {0};
    axes[0].offset = offsetof(dea_scene, actuator.prestretch);
    strcpy(axes[0].column, "prestretch");
    assert_int_equal(points_write(&scene, in_folder("a.nc"), 1, &error), DEA_OK);
    void *library = netcdf_library();
    static const struct {
        const char *name;
        double value;
    } cases[] = {
        {"frame_radius_m", 0.03},
        {"coverage", 0.5},
        {"yeoh_C1_Pa", 178426.0},
        {"permittivity", 2.8},
        {"accuracy", 1e-6},
        {"series_resistance_Ohm", 1e6},
        {"transient_until_s", 1.0},
        {"waveform_step_on_s", 1.0},
        {"waveform_step_voltage_V", 4500.0},
        {"prestretch", NAN},
        {"density_kg_per_m3", NAN},
        {"waveform_step_off_s", NAN},
        {"waveform_sine_phase", NAN},
        {"ac_from_Hz", NAN},
        {"waveform_sine_frequency_Hz", NAN},
        {"permittivity_constant", NAN},
    };
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        const double value = netcdf_attribute(library, in_folder("a.nc"), cases[i].name);
        assert_true(isnan(cases[i].value) ? isnan(value) : value == cases[i].value);
    }
    dlclose(library);
}

/* A skin of the same kind of law as the film, and lighter. */
/* ... and a second film too. */
static void netcdf_tells_the_skin_from_the_film(void **state)
{
    (void)state;
    const size_t counts[] = {2};
    dea_scene scene = transient_make(1, counts, 1, 3);
    dea_error error = {0};
    scene.material.density = 1080.0;
    scene.electrode = (dea_electrode){
        .law = scene.material.law, .constants = {5000.0, 1.0, 2.0}, .entry_count = 1, .thickness = 25e-6, .density = 1010.0, .sheet_resistance = NAN};
    scene.antagonist = (dea_antagonist){.there = true, .kind = DEA_LENS, .own_material = true};
    scene.antagonist.material = (dea_material){.name = "other", .law = dea_law_find("neo_hookean"), .constants = {44e3}, .entry_count = 1, .permittivity = 4.7};
    assert_int_equal(points_write(&scene, in_folder("a.nc"), 1, &error), DEA_OK);
    void *library = netcdf_library();
    assert_true(netcdf_attribute(library, in_folder("a.nc"), "density_kg_per_m3") == 1080.0);
    assert_true(netcdf_attribute(library, in_folder("a.nc"), "electrode_density_kg_per_m3") == 1010.0);
    assert_true(netcdf_attribute(library, in_folder("a.nc"), "electrode_thickness_m") == 25e-6);
    assert_true(netcdf_attribute(library, in_folder("a.nc"), "yeoh_C1_Pa") == 178426.0);
    assert_true(netcdf_attribute(library, in_folder("a.nc"), "electrode_yeoh_C1_Pa") == 5000.0);
    assert_true(netcdf_attribute(library, in_folder("a.nc"), "antagonist_neo_hookean_mu_Pa") == 44e3);
    assert_true(netcdf_attribute(library, in_folder("a.nc"), "antagonist_permittivity") == 4.7);
    dlclose(library);
}

/* Draws a study of the scene; strains are those of numbers that a picture can show. */
static dea_status columns_draw(const dea_scene *scene, const char *path, const char *columns, dea_error *error)
{
    dea_plot *plot;
    const dea_plot_options options = {.columns = columns};
    dea_status status = dea_plot_begin(scene, path, &options, &plot, error);
    if (status != DEA_OK) {
        return status;
    }
    const size_t total = dea_scene_point_count(scene) * scene->model_count;
    for (size_t i = 0; i < total; i++) {
        const double x = (double)i / (double)total;
        const dea_row row = {.strain = 0.1 * x, .displacement = 1e-3 * x * (1.0 - x), .charge = 3e-6 * x, .state = DEA_STATE_OK};
        dea_plot_points(plot, i, &row, 1);
    }
    return dea_plot_finish(plot, true, error);
}

static dea_status study_draw(const dea_scene *scene, const char *path, dea_error *error)
{
    return columns_draw(scene, path, NULL, error);
}

/* One column or two of a sweep, one of a map; its largest value, 3 uC times 49/50, is drawn in its own unit. */
static void columns_of_a_sweep_are_drawn_as_wanted(void **state)
{
    static const size_t one[] = {50}, two[] = {50, 20};
    static const struct {
        const char *columns, *shown, *absent;
    } cases[] = {{"charge_C", "\"Charge Q [µC]\"", "[mm]"}, {"charge_C,displacement_m", "\"Displacement u [µm]\"", "Strain"}};
    const dea_scene curves = scene_make(1, one, 1), map = scene_make(2, two, 1);
    dea_error error = {0};
    (void)state;
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        assert_int_equal(columns_draw(&curves, in_folder("a.gp"), cases[i].columns, &error), DEA_OK);
        const char *script = file_text(in_folder("a.gp"));
        assert_non_null(strstr(script, cases[i].shown));
        assert_non_null(strstr(script, " 2.94 "));
        assert_null(strstr(script, cases[i].absent));
    }
    assert_int_equal(columns_draw(&map, in_folder("a.svg"), "charge_C", &error), DEA_OK);
    assert_non_null(strstr(file_text(in_folder("a.svg")), "Charge Q [µC]"));
    assert_int_equal(unlink(in_folder("a.svg")), 0);
    assert_int_equal(columns_draw(&map, in_folder("a.gp"), "charge_C,strain", &error), DEA_ERROR_USAGE);
    assert_non_null(strstr(error.message, "one, of a map"));
    assert_int_equal(columns_draw(&curves, in_folder("a.gp"), "charge_C,", &error), DEA_ERROR_USAGE);
    assert_non_null(strstr(error.message, "no column \"\""));
    assert_int_equal(columns_draw(&curves, in_folder("a.gp"), "charge_C,strain,force_N", &error), DEA_ERROR_USAGE);
    const dea_scene runs = response_make(1, one, 1, 4);
    assert_int_equal(columns_draw(&runs, in_folder("a.gp"), "strain", &error), DEA_ERROR_USAGE);
    assert_non_null(strstr(error.message, "columns are chosen of a sweep, but the study is ac"));
    assert_int_equal(unlink(in_folder("a.gp")), 0);
}

static void picture_shows_hostile_titles_as_text(void **state)
{
    (void)state;
    const size_t counts[] = {50};
    const dea_scene scene = scene_make(1, counts, 1);
    dea_error error = {0};
    snprintf(title, sizeof title, "`touch %s/x` $(id) @m \"q'z\" \\n <b> %%d 4.5 \xff\x01", folder);
    assert_int_equal(study_draw(&scene, in_folder("a.svg"), &error), DEA_OK);
    char shown[200];
    snprintf(shown, sizeof shown, "`touch %s/x` $(id) @m \"q'z\" \\n &lt;b> %%d 4.5 <", folder);
    assert_non_null(strstr(file_text(in_folder("a.svg")), shown));
    assert_int_equal(folder_count(), 1);
    memset(title, 'x', sizeof title - 1);
    assert_int_equal(study_draw(&scene, in_folder("a.svg"), &error), DEA_OK);
}

static void long_curves_make_small_pictures(void **state)
{
    (void)state;
    const size_t counts[] = {200000};
    const dea_scene scene = scene_make(1, counts, 1);
    dea_error error = {0};
    struct stat about;
    assert_int_equal(study_draw(&scene, in_folder("a.svg"), &error), DEA_OK);
    assert_int_equal(stat(in_folder("a.svg"), &about), 0);
    assert_true(about.st_size >= 10000 && about.st_size <= 200000);
}

static void two_long_axes_make_a_map(void **state)
{
    (void)state;
    const size_t counts[] = {40, 30};
    const dea_scene scene = scene_make(2, counts, 1);
    dea_error error = {0};
    assert_int_equal(study_draw(&scene, in_folder("a.svg"), &error), DEA_OK);
    assert_non_null(strstr(file_text(in_folder("a.svg")), "<image "));
    assert_int_equal(study_draw(&scene, in_folder("a.png"), &error), DEA_OK);
    assert_memory_equal(file_text(in_folder("a.png")), "\x89PNG", 4);
}

static void pictures_without_content_are_refused(void **state)
{
    (void)state;
    const size_t one[] = {1}, many[] = {40, 30}, some[] = {5};
    dea_error error = {0};
    dea_scene scene = scene_make(1, one, 1);
    assert_int_equal(study_draw(&scene, in_folder("a.svg"), &error), DEA_ERROR_USAGE);
    assert_non_null(strstr(error.message, "nothing to draw"));
    scene = scene_make(2, many, 2);
    assert_int_equal(study_draw(&scene, in_folder("a.svg"), &error), DEA_ERROR_USAGE);
    assert_non_null(strstr(error.message, "60 curves"));
    scene = scene_make(1, some, 1);
    assert_int_equal(study_draw(&scene, in_folder("a.jpg"), &error), DEA_ERROR_USAGE);
    dea_plot *plot;
    assert_int_equal(dea_plot_begin(&scene, in_folder("a.svg"), NULL, &plot, &error), DEA_OK);
    assert_int_equal(dea_plot_finish(plot, true, &error), DEA_ERROR_USAGE);
    assert_int_equal(folder_count(), 0);
}

/* Draws all points of a transient or a frequency response. */
static dea_status points_draw(const dea_scene *scene, const char *path, dea_error *error)
{
    const dea_layout layout = dea_layout_of(scene);
    dea_plot *plot;
    const dea_status status = dea_plot_begin(scene, path, NULL, &plot, error);
    if (status != DEA_OK) {
        return status;
    }
    char *point = calloc(1, layout.point_size);
    const size_t total = dea_scene_point_count(scene) * scene->model_count;
    for (size_t i = 0; i < total; i++) {
        point_make(scene, &layout, i, point);
        dea_plot_points(plot, i, point, 1);
    }
    free(point);
    return dea_plot_finish(plot, true, error);
}

static void pictures_of_runs_appear_whole(void **state)
{
    (void)state;
    const size_t counts[] = {3};
    const dea_scene scenes[] = {transient_make(1, counts, 2, 500), response_make(1, counts, 2, 4)};
    static const char *const shown[][4] = {{"Strain s [%]", "U [kV]", "i [µA]", "Time [s]"},
                                           {"Displacement per volt [µm/V]", "Impedance [Ω]", "Phase [°]", "Frequency [Hz]"}};
    for (size_t i = 0; i < 2; i++) {
        dea_error error = {0};
        assert_int_equal(points_draw(&scenes[i], in_folder("a.svg"), &error), DEA_OK);
        const char *text = file_text(in_folder("a.svg"));
        for (size_t k = 0; k < 4; k++) {
            assert_non_null(strstr(text, shown[i][k]));
        }
        assert_non_null(strstr(text, "coverage"));
        assert_int_equal(points_draw(&scenes[i], in_folder("a.png"), &error), DEA_OK);
        assert_memory_equal(file_text(in_folder("a.png")), "\x89PNG", 4);
    }
    assert_int_equal(folder_count(), 2);
}

static void long_runs_make_small_pictures(void **state)
{
    (void)state;
    const dea_scene scene = transient_make(0, NULL, 1, 300000);
    dea_error error = {0};
    struct stat about;
    assert_int_equal(points_draw(&scene, in_folder("a.svg"), &error), DEA_OK);
    assert_int_equal(stat(in_folder("a.svg"), &about), 0);
    assert_true(about.st_size >= 10000 && about.st_size <= 200000);
}

/* The curve of quantity @p quantity that a picture keeps of @p count samples. */
static dea_plot_trace *trace_make(const dea_scene *scene, dea_runs *runs, size_t quantity, const void *point)
{
    dea_error error = {0};
    assert_int_equal(dea_runs_open(scene, false, runs, &error), DEA_OK);
    dea_runs_take(runs, 0, point);
    return &runs->runs[0].traces[quantity];
}

static void thinned_curve_keeps_every_peak(void **state)
{
    (void)state;
    enum { COUNT = 1000001 };
    const dea_scene scene = transient_make(0, NULL, 1, COUNT);
    const dea_layout layout = dea_layout_of(&scene);
    char *point = calloc(1, layout.point_size);
    dea_sample *samples = (dea_sample *)(void *)point;
    for (size_t i = 0; i < COUNT; i++) {
        samples[i] = (dea_sample){.time = 0.5 * (double)i, .strain = 0.01, .state = DEA_STATE_OK};
    }
    static const size_t peaks[] = {0, 1, 12345, 499999, 777777, COUNT - 1};
    for (size_t i = 0; i < 6; i++) {
        samples[peaks[i]].strain = i % 2 ? -0.5 : 0.5;
    }
    dea_runs runs;
    const dea_plot_trace *trace = trace_make(&scene, &runs, 0, point);
    assert_true(trace->count >= 1000 && trace->count <= 2000);
    for (size_t i = 0; i < 6; i++) {
        size_t found = 0;
        for (size_t k = 0; k < trace->count; k++) {
            found += trace->x[k] == 0.5 * (double)peaks[i] && trace->y[k] == (i % 2 ? -0.5 : 0.5);
            assert_true(k == 0 || trace->x[k] > trace->x[k - 1]);
        }
        assert_int_equal(found, 1);
    }
    dea_runs_close(&runs);
    free(point);
}

static void curve_ends_where_the_film_pulls_in(void **state)
{
    (void)state;
    enum { COUNT = 10000, END = 7000 };
    const dea_scene scene = transient_make(0, NULL, 1, COUNT);
    const dea_layout layout = dea_layout_of(&scene);
    char *point = calloc(1, layout.point_size);
    dea_sample *samples = (dea_sample *)(void *)point;
    for (size_t i = 0; i < COUNT; i++) {
        const bool held = i < END;
        samples[i] = (dea_sample){.time = 0.5 * (double)i, .strain = held ? 1e-5 * (double)i : NAN};
        samples[i].state = held ? DEA_STATE_OK : DEA_STATE_PULL_IN;
    }
    dea_runs runs;
    const dea_plot_trace *trace = trace_make(&scene, &runs, 0, point);
    double last = 0.0;
    for (size_t i = 0; i < trace->count; i++) {
        last = isfinite(trace->y[i]) ? trace->x[i] : last;
    }
    assert_true(last == 0.5 * (END - 1));
    assert_true(isnan(trace->y[trace->count - 1]));
    assert_int_equal(runs.runs[0].spot_count, 1);
    assert_int_equal(dea_marks[runs.runs[0].spots[0].mark].state, DEA_STATE_PULL_IN);
    assert_true(runs.runs[0].spots[0].x == last);
    dea_runs_close(&runs);
    free(point);
}

static void phase_is_drawn_without_jumps(void **state)
{
    (void)state;
    const dea_scene scene = response_make(0, NULL, 1, 3);
    const dea_layout layout = dea_layout_of(&scene);
    char *point = calloc(1, layout.point_size);
    point_make(&scene, &layout, 0, point);
    for (size_t i = 0; i < layout.rows; i++) {
        ((dea_response *)(void *)point)[i].displacement = 1e-9;
        ((dea_response *)(void *)point)[i].displacement_phase = remainder(-20.0 * (double)i, 360.0);
    }
    dea_runs runs;
    const dea_plot_trace *trace = trace_make(&scene, &runs, 1, point);
    size_t samples = 0;
    for (size_t i = 0; i < trace->count; i++) {
        const double place = 10.0 * log10(trace->x[i]); /* number of the sample */
        const bool sample = fabs(place - round(place)) < 1e-6;
        samples += sample;
        assert_true(fabs(trace->y[i] + 20.0 * place) < (sample ? 1e-6 : 20.0));
        assert_true(i == 0 || fabs(trace->y[i] - trace->y[i - 1]) < 21.0);
    }
    assert_int_equal(samples, 31);
    assert_true(trace->count > 100);
    dea_runs_close(&runs);
    free(point);
}

/* 1/(1 - x^2 + i x/Q) with Q = 50 at ten samples a decade, none of them within its width: the samples reach a fifth of the peak. */
static void a_resonance_is_drawn_as_high_as_it_is(void **state)
{
    (void)state;
    static const double quality = 50.0, resonance = 133.0; /* [1], [Hz] */
    const dea_scene scene = response_make(0, NULL, 1, 4);
    const dea_layout layout = dea_layout_of(&scene);
    char *point = calloc(1, layout.point_size);
    double sampled = 0.0, drawn = 0.0;
    for (size_t i = 0; i < layout.rows; i++) {
        const double f = dea_layout_place(&scene, i), x = f / resonance;
        const double real = 1.0 - x * x, imaginary = x / quality, size = hypot(real, imaginary);
        ((dea_response *)(void *)point)[i] =
            (dea_response){f, 1e-9 / size, -atan2(imaginary, real) * 180.0 / acos(-1.0), 1e9 / f, -90.0, DEA_STATE_OK};
        sampled = fmax(sampled, 1e-9 / size);
    }
    dea_runs runs;
    const dea_plot_trace *trace = trace_make(&scene, &runs, 0, point);
    for (size_t i = 0; i < trace->count; i++) {
        drawn = fmax(drawn, trace->y[i]);
    }
    assert_true(sampled < 0.2 * quality * 1e-9);
    assert_true(fabs(drawn / (quality * 1e-9) - 1.0) < 0.01);
    dea_runs_close(&runs);
    free(point);
}

/* How the script of a picture draws a curve. */
typedef struct drawn {
    char dash[48], colour[8], palette[24];
    int symbol;
} drawn;

/* Look of the lines of a data block, and of the last points of @p marks; false where no line has it. */
static bool drawn_read(const char *script, const char *block, const char *marks, drawn *look)
{
    char words[64];
    *look = (drawn){.symbol = 0};
    snprintf(words, sizeof words, "%s with lines dashtype ", block);
    const char *line = strstr(script, words);
    if (!line) {
        return false;
    }
    line += strlen(words);
    snprintf(look->dash, sizeof look->dash, "%.*s", (int)(strstr(line, " linewidth") - line), line);
    sscanf(strstr(line, "linecolor "), "linecolor '%7[#0-9a-f]", look->colour);
    sscanf(strstr(line, "linecolor "), "linecolor palette cb %23s", look->palette);
    snprintf(words, sizeof words, "%s with points pointtype ", marks);
    const char *points = strstr(script, words);
    if (points) {
        look->symbol = atoi(points + strlen(words));
    }
    return true;
}

/* Luminance, 0 to 1, of a colour in grey (ITU-R BT.601). */
static double grey_of(const char *colour)
{
    unsigned rgb[3];
    assert_int_equal(sscanf(colour, "#%2x%2x%2x", &rgb[0], &rgb[1], &rgb[2]), 3);
    return (0.299 * rgb[0] + 0.587 * rgb[1] + 0.114 * rgb[2]) / 255.0;
}

static bool told_apart_in_grey(const drawn *a, const drawn *b)
{
    return strcmp(a->dash, b->dash) != 0 || a->symbol != b->symbol || fabs(grey_of(a->colour) - grey_of(b->colour)) > 0.15;
}

static void curves_are_told_apart_in_grey(void **state)
{
    (void)state;
    enum { GROUPS = 6 };
    const size_t counts[] = {40, GROUPS}, runs[] = {GROUPS};
    for (size_t k = 0; k < 3; k++) { /* the scenes share their axes */
        dea_error error = {0};
        dea_scene scene = k == 0 ? scene_make(2, counts, 2) : k == 1 ? transient_make(1, runs, 2, 50) : response_make(1, runs, 2, 3);
        drawn looks[2 * GROUPS];
        char block[32], marks[32];
        scene.models[0] = dea_model_find("lumped");
        scene.models[1] = dea_model_find("coverage");
        assert_int_equal(k == 0 ? study_draw(&scene, in_folder("a.gp"), &error) : points_draw(&scene, in_folder("a.gp"), &error),
                         DEA_OK);
        const char *script = file_text(in_folder("a.gp"));
        for (size_t i = 0; i < 2 * GROUPS; i++) {
            snprintf(block, sizeof block, "$curve%zu using 1:2", i);
            snprintf(marks, sizeof marks, "$curve%zu using 1:3", i);
            assert_true(drawn_read(script, block, marks, &looks[i]));
            for (size_t before = 0; before < i; before++) {
                assert_true(told_apart_in_grey(&looks[i], &looks[before]));
            }
        }
    }
}

/* But where it is alone, where dashes tell nothing. */
static void a_model_has_its_colour_and_dash_in_every_picture(void **state)
{
    (void)state;
    const size_t counts[] = {40};
    for (size_t i = 0; i < dea_model_count(); i++) {
        drawn looks[3];
        for (size_t k = 0; k < 3; k++) {
            dea_error error = {0};
            dea_scene scene = k == 0 ? scene_make(1, counts, 2) : k == 1 ? transient_make(0, NULL, 2, 50) : response_make(0, NULL, 1, 3);
            scene.models[k == 0] = dea_model_at(i); /* first or second among others */
            scene.models[k != 0] = dea_model_at((i + 1) % dea_model_count());
            assert_int_equal(k == 0 ? study_draw(&scene, in_folder("a.gp"), &error) : points_draw(&scene, in_folder("a.gp"), &error), DEA_OK);
            assert_true(drawn_read(file_text(in_folder("a.gp")), k == 0 ? "$curve1 using 1:2" : "$curve0 using 1:2", "none", &looks[k]));
            assert_string_equal(looks[k].colour, looks[0].colour);
            assert_string_equal(looks[k].dash, k == 2 ? "solid" : looks[0].dash);
        }
    }
}

static void many_curves_have_a_colour_scale(void **state)
{
    (void)state;
    const size_t counts[] = {40, 8};
    dea_error error = {0};
    drawn first, last;
    dea_scene scene = scene_make(2, counts, 2);
    assert_int_equal(study_draw(&scene, in_folder("a.gp"), &error), DEA_OK);
    const char *script = file_text(in_folder("a.gp"));
    assert_true(drawn_read(script, "$curve0 using 1:2", "none", &first) && drawn_read(script, "$curve7 using 1:2", "none", &last));
    assert_string_equal(first.palette, "0.1");
    assert_string_equal(last.palette, "0.9");
    assert_non_null(strstr(script, "set cbrange [0.1:0.9]"));
    assert_non_null(strstr(script, "set cblabel offset 1.5,0 textcolor '#202020' \"Coverage ratio B\""));
}

/* The range of the axis behind a label. */
static void range_read(const char *script, const char *label, double *low, double *high)
{
    const char *at = strstr(script, label);
    assert_non_null(at);
    assert_int_equal(sscanf(strstr(at, "set yrange"), "set yrange [%lf:%lf]", low, high), 2);
}

static void a_flat_drive_does_not_lie_on_the_frame(void **state)
{
    (void)state;
    double low, high;
    dea_error error = {0};
    const dea_scene scene = transient_make(0, NULL, 1, 20001); /* 10 000 s */
    assert_int_equal(points_draw(&scene, in_folder("a.gp"), &error), DEA_OK);
    const char *script = file_text(in_folder("a.gp"));
    range_read(script, "U [kV]", &low, &high);
    assert_true(low < -0.1 && high > 4.6);
    assert_non_null(strstr(script, "Time [h]"));
    assert_non_null(strstr(script, "set xrange [0:2.77777778]"));
}

static void a_script_draws_the_picture(void **state)
{
    (void)state;
    const size_t counts[] = {40, 30};
    dea_error error = {0};
    const dea_scene scene = scene_make(2, counts, 1);
    char command[256], *drawn_text;
    snprintf(title, sizeof title, "`touch x` $(id) \"q'z\" 50%% \\n 4.5 λ");
    assert_int_equal(study_draw(&scene, in_folder("a.svg"), &error), DEA_OK);
    drawn_text = strdup(file_text(in_folder("a.svg")));
    assert_int_equal(study_draw(&scene, in_folder("b.gp"), &error), DEA_OK);
    snprintf(command, sizeof command, "cd %s && gnuplot b.gp", folder);
    assert_int_equal(system(command), 0);
    assert_string_equal(strstr(file_text(in_folder("b.svg")), "<svg"), strstr(drawn_text, "<svg"));
    assert_int_equal(folder_count(), 3);
    free(drawn_text);
}

static void a_picture_has_the_size_that_is_asked_for(void **state)
{
    (void)state;
    static const struct {
        const char *name, *size;
    } kinds[] = {{"a.svg", "width=\"321\" height=\"227\""}, {"a.eps", "%%BoundingBox: 0 0 241 170"}, {"a.pdf", "MediaBox [ 0 0 241 170 ]"}};
    const size_t counts[] = {40};
    const dea_scene scene = scene_make(1, counts, 1);
    const dea_plot_options sizes[] = {{.width = 0.085, .height = 0.06}, {.width = 0.04, .height = 0.04}, {.width = 0.085}};
    const dea_status wanted[] = {DEA_OK, DEA_ERROR_USAGE, DEA_ERROR_USAGE};
    for (size_t i = 0; i < sizeof kinds / sizeof *kinds; i++) {
        for (size_t k = 0; k < 3; k++) {
            dea_plot *plot = NULL;
            dea_error error = {0};
            dea_status status = dea_plot_begin(&scene, in_folder(kinds[i].name), &sizes[k], &plot, &error);
            for (size_t row = 0; status == DEA_OK && row < counts[0]; row++) {
                const dea_row made = row_make(row);
                dea_plot_points(plot, row, &made, 1);
            }
            status = status == DEA_OK ? dea_plot_finish(plot, true, &error) : status;
            assert_int_equal(status, wanted[k]);
        }
        struct stat about;
        assert_int_equal(stat(in_folder(kinds[i].name), &about), 0);
        if (!memmem(file_text(in_folder(kinds[i].name)), (size_t)about.st_size, kinds[i].size, strlen(kinds[i].size))) {
            fail_msg("%s is not of the size %s", kinds[i].name, kinds[i].size);
        }
    }
}

static void runs_that_no_picture_can_show_are_refused(void **state)
{
    (void)state;
    const size_t many[] = {5, 5};
    dea_error error = {0};
    dea_scene scene = transient_make(2, many, 1, 3);
    assert_int_equal(points_draw(&scene, in_folder("a.svg"), &error), DEA_ERROR_USAGE);
    assert_non_null(strstr(error.message, "25 runs"));
    scene = response_make(0, NULL, 1, 0);
    assert_int_equal(points_draw(&scene, in_folder("a.svg"), &error), DEA_ERROR_USAGE);
    assert_non_null(strstr(error.message, "nothing to draw"));
    scene = transient_make(0, NULL, 1, 30);
    const dea_layout layout = dea_layout_of(&scene);
    char *point = calloc(1, layout.point_size);
    dea_plot *plot;
    assert_int_equal(dea_plot_begin(&scene, in_folder("a.svg"), NULL, &plot, &error), DEA_OK);
    dea_layout_fail(&scene, &layout, point);
    dea_plot_points(plot, 0, point, 1);
    assert_int_equal(dea_plot_finish(plot, true, &error), DEA_ERROR_USAGE);
    free(point);
    assert_int_equal(folder_count(), 0);
}

static void gnuplot_failures_are_told_in_its_words(void **state)
{
    (void)state;
    const size_t counts[] = {5};
    const dea_scene scene = scene_make(1, counts, 1);
    char path[4096];
    snprintf(path, sizeof path, "%s", getenv("PATH"));
    dea_error error = {0};
    setenv("PATH", folder, 1);
    const dea_status missing = study_draw(&scene, in_folder("a.svg"), &error);
    FILE *fake = fopen(in_folder("gnuplot"), "w");
    fputs("#!/bin/sh\necho bad weather >&2\nexit 3\n", fake);
    fclose(fake);
    chmod(in_folder("gnuplot"), 0755);
    dea_error failure = {0};
    const dea_status failed = study_draw(&scene, in_folder("a.svg"), &failure);
    setenv("PATH", path, 1);
    assert_int_equal(missing, DEA_ERROR_MISSING);
    assert_non_null(strstr(error.message, "gnuplot-nox"));
    assert_int_equal(failed, DEA_ERROR_ENGINE);
    assert_non_null(strstr(failure.message, "exit status 3"));
    assert_non_null(strstr(failure.message, "bad weather"));
    assert_int_equal(folder_count(), 1);
}

/* Shows a bar often on the file @p target in place of standard error. */
static bool progress_try(int target)
{
    const int before = dup(STDERR_FILENO);
    dup2(target, STDERR_FILENO);
    dea_progress *bar = dea_progress_begin();
    nanosleep(&(struct timespec){.tv_nsec = 400000000}, NULL);
    for (int i = 0; i < 1000; i++) {
        dea_progress_show(bar, 50, 100);
    }
    dea_progress_end(bar);
    dup2(before, STDERR_FILENO);
    close(before);
    return bar != NULL;
}

static void progress_shows_on_a_terminal_and_erases_itself(void **state)
{
    (void)state;
    const int master = posix_openpt(O_RDWR | O_NOCTTY);
    assert_true(master >= 0 && grantpt(master) == 0 && unlockpt(master) == 0);
    const int terminal = open(ptsname(master), O_RDWR | O_NOCTTY);
    setenv("TERM", "xterm", 1);
    setenv("NO_COLOR", "1", 1);
    assert_true(progress_try(terminal));
    char text[4096] = "";
    ssize_t length = 0;
    struct pollfd wait = {.fd = master, .events = POLLIN}; /* a terminal hands over in pieces */
    while (length < (ssize_t)sizeof text - 1 && poll(&wait, 1, 200) > 0) {
        const ssize_t piece = read(master, text + length, sizeof text - 1 - (size_t)length);
        assert_true(piece > 0);
        length += piece;
    }
    assert_true(length >= 20 && length <= 200); /* one bar, not a thousand */
    assert_non_null(strstr(text, " 50 %  50/100"));
    assert_null(strstr(text, "\033[36m"));
    assert_string_equal(text + length - 4, "\r\033[K");
    setenv("TERM", "dumb", 1);
    assert_false(progress_try(terminal));
    close(terminal);
    close(master);
}

static void progress_is_silent_without_a_terminal(void **state)
{
    (void)state;
    int ends[2];
    assert_int_equal(pipe(ends), 0);
    assert_false(progress_try(ends[1]));
    close(ends[1]);
    char text[8];
    assert_int_equal(read(ends[0], text, sizeof text), 0);
    close(ends[0]);
}

#define IN_FOLDER(test) cmocka_unit_test_setup_teardown(test, folder_make, folder_remove)

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(numbers_print_as_printf_does),
        cmocka_unit_test(numbers_keep_their_point_whatever_the_locale),
        IN_FOLDER(csv_holds_axes_then_numbers_then_the_state),
        IN_FOLDER(csv_names_the_model_where_there_are_several),
        IN_FOLDER(csv_of_a_transient_holds_the_run_before_every_sample),
        IN_FOLDER(csv_of_a_frequency_response_holds_magnitudes_and_phases),
        IN_FOLDER(blocks_of_any_size_give_the_same_bytes),
        IN_FOLDER(runs_in_blocks_of_any_size_give_the_same_bytes),
        IN_FOLDER(file_appears_when_it_is_finished_and_not_before),
        IN_FOLDER(discarded_file_leaves_the_old_one),
        IN_FOLDER(missing_rows_make_no_file),
        IN_FOLDER(link_stays_a_link),
        IN_FOLDER(targets_that_cannot_be_written_are_refused_at_once),
        IN_FOLDER(full_disk_is_an_error),
        IN_FOLDER(netcdf_holds_what_the_rows_held),
        IN_FOLDER(netcdf_of_a_step_holds_rise_and_settling),
        IN_FOLDER(netcdf_of_a_transient_holds_time_samples_and_summaries),
        IN_FOLDER(netcdf_of_a_sine_holds_extremes_and_harmonics),
        IN_FOLDER(what_rows_tell_over_the_radius_keeps_its_places),
        IN_FOLDER(netcdf_of_a_frequency_response_lies_along_frequency),
        IN_FOLDER(netcdf_keeps_the_scalars_that_the_study_used),
        IN_FOLDER(netcdf_tells_the_skin_from_the_film),
        IN_FOLDER(columns_of_a_sweep_are_drawn_as_wanted),
        IN_FOLDER(picture_shows_hostile_titles_as_text),
        IN_FOLDER(long_curves_make_small_pictures),
        IN_FOLDER(two_long_axes_make_a_map),
        IN_FOLDER(pictures_without_content_are_refused),
        IN_FOLDER(pictures_of_runs_appear_whole),
        IN_FOLDER(long_runs_make_small_pictures),
        cmocka_unit_test(thinned_curve_keeps_every_peak),
        cmocka_unit_test(curve_ends_where_the_film_pulls_in),
        cmocka_unit_test(phase_is_drawn_without_jumps),
        IN_FOLDER(runs_that_no_picture_can_show_are_refused),
        IN_FOLDER(gnuplot_failures_are_told_in_its_words),
        IN_FOLDER(a_resonance_is_drawn_as_high_as_it_is),
        IN_FOLDER(curves_are_told_apart_in_grey),
        IN_FOLDER(a_model_has_its_colour_and_dash_in_every_picture),
        IN_FOLDER(many_curves_have_a_colour_scale),
        IN_FOLDER(a_flat_drive_does_not_lie_on_the_frame),
        IN_FOLDER(a_script_draws_the_picture),
        IN_FOLDER(a_picture_has_the_size_that_is_asked_for),
        cmocka_unit_test(progress_shows_on_a_terminal_and_erases_itself),
        cmocka_unit_test(progress_is_silent_without_a_terminal),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
