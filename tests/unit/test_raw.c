/* SPICE raw files: read back byte by byte, and by ngspice. */
#include "scenes.h"

#include <dirent.h>
#include <ngspice/sharedspice.h>
#include <stdlib.h>
#include <unistd.h>

#include "deaspice/output.h"

enum { LINE_MOST = 511, VECTORS = 12, PLOTS = 12 };

/* What a reader finds; numbers are pairs where @p complex. */
typedef struct plot {
    char title[512], date[64], name[64], command[128];
    bool complex;
    size_t vectors, points;
    char names[VECTORS][64], types[VECTORS][64];
    double *numbers; /* point after point; free with plots_free() */
} plot;

static plot plots[PLOTS];
static size_t plot_count;
static char folder[64];
static char title[4096];
static dea_axis axes[2];
static double values[2][64];
static const dea_model lumped = {.name = "lumped"}, coverage = {.name = "coverage"};

static void plots_free(void)
{
    for (size_t i = 0; i < plot_count; i++) {
        free(plots[i].numbers);
    }
    plot_count = 0;
}

static int folder_make(void **state)
{
    (void)state;
    strcpy(folder, "/tmp/deaspice-test-XXXXXX");
    strcpy(title, "a dot");
    return setenv("SOURCE_DATE_EPOCH", "1700000000", 1) == 0 && mkdtemp(folder) && chdir(folder) == 0 ? 0 : -1;
}

static int folder_count(void)
{
    int count = 0;
    DIR *open = opendir(".");
    while (open && readdir(open)) {
        count++;
    }
    closedir(open);
    return count - 2;
}

static int folder_remove(void **state)
{
    (void)state;
    DIR *open = opendir(".");
    for (const struct dirent *entry; open && (entry = readdir(open));) {
        unlink(entry->d_name);
    }
    closedir(open);
    plots_free();
    return chdir("/") == 0 && rmdir(folder) == 0 ? 0 : -1;
}

/* The rest of a line that begins with @p key; the test fails on another line, and on one that ngspice would read as two. */
static void line_take(FILE *file, const char *key, char *rest, size_t room)
{
    char line[LINE_MOST + 2];
    assert_non_null(fgets(line, sizeof line, file));
    const size_t length = strlen(line);
    assert_true(length < LINE_MOST && line[length - 1] == '\n');
    line[length - 1] = '\0';
    if (strncmp(line, key, strlen(key)) != 0) {
        print_error("line \"%s\", wanted \"%s\"\n", line, key);
        fail();
    }
    assert_true(length - strlen(key) <= room);
    strcpy(rest, line + strlen(key));
}

static size_t number_take(FILE *file, const char *key)
{
    char rest[64];
    line_take(file, key, rest, sizeof rest);
    return (size_t)strtoul(rest, NULL, 10);
}

static void vector_take(FILE *file, plot *read, size_t index)
{
    char key[32], rest[LINE_MOST];
    snprintf(key, sizeof key, "\t%zu\t", index);
    line_take(file, key, rest, sizeof rest);
    assert_int_equal(sscanf(rest, "%63[^\t]\t%63[^\n]", read->names[index], read->types[index]), 2);
}

static void plot_take(FILE *file, plot *read)
{
    char rest[LINE_MOST];
    line_take(file, "Title: ", read->title, sizeof read->title);
    line_take(file, "Date: ", read->date, sizeof read->date);
    line_take(file, "Plotname: ", read->name, sizeof read->name);
    line_take(file, "Command: ", read->command, sizeof read->command);
    line_take(file, "Flags: ", rest, sizeof rest);
    read->complex = strcmp(rest, "complex") == 0;
    assert_true(read->complex || strcmp(rest, "real") == 0);
    read->vectors = number_take(file, "No. Variables: ");
    read->points = number_take(file, "No. Points: ");
    assert_true(read->vectors >= 2 && read->vectors <= VECTORS);
    assert_true(read->points >= 1 && read->points <= 1000);
    line_take(file, "Variables:", rest, 1);
    for (size_t i = 0; i < read->vectors; i++) {
        vector_take(file, read, i);
    }
    line_take(file, "Binary:", rest, 1);
    const size_t count = read->vectors * read->points * (read->complex ? 2 : 1);
    read->numbers = malloc(count * sizeof *read->numbers);
    assert_non_null(read->numbers);
    assert_int_equal(fread(read->numbers, sizeof *read->numbers, count, file), count);
}

/* Reads all plots of a file, which holds nothing else. */
static void plots_read(const char *path)
{
    FILE *file = fopen(path, "rb");
    assert_non_null(file);
    plots_free();
    for (int next; (next = fgetc(file)) != EOF;) {
        ungetc(next, file);
        assert_true(plot_count < PLOTS);
        plot_take(file, &plots[plot_count]);
        plot_count++;
    }
    fclose(file);
}

static double number_of(const plot *read, size_t point, size_t vector)
{
    return read->numbers[point * read->vectors + vector];
}

static dea_scene scene_make(size_t axis_count, size_t models)
{
    static const char *const columns[] = {"prestretch", "voltage_V"}, *const units[] = {"1", "V"};
    static const size_t counts[] = {2, 3};
    dea_scene scene = paper_scene(DEA_DOT, 1.2, 0.5, 4500.0);
    for (size_t i = 0; i < axis_count; i++) {
        const size_t which = axis_count == 1 ? 1 : i;
        axes[i] = (dea_axis){.values = values[i], .count = counts[which]};
        strcpy(axes[i].column, columns[which]);
        strcpy(axes[i].unit, units[which]);
        for (size_t k = 0; k < axes[i].count; k++) {
            values[i][k] = which == 0 ? 1.1 + 0.2 * (double)k : 1500.0 * (double)k;
        }
    }
    scene.title = title;
    scene.axes = axes;
    scene.axis_count = axis_count;
    scene.models[0] = &lumped;
    scene.models[1] = &coverage;
    scene.model_count = models;
    return scene;
}

/* A transient of 50 samples with an electrical port; several runs lie along the pre-stretch and the voltage of the step. */
static dea_scene transient_make(size_t axis_count, size_t models)
{
    dea_scene scene = scene_make(axis_count, models);
    strcpy(axes[axis_count == 1 ? 0 : 1].column, "step_voltage_V");
    scene.study = DEA_STUDY_TRANSIENT;
    scene.transient = (dea_transient){.until = 24.5, .every = 0.5};
    scene.drive.series_resistance = 1e6;
    return scene;
}

static dea_scene response_make(void)
{
    dea_scene scene = scene_make(0, 1);
    scene.study = DEA_STUDY_AC;
    scene.ac = (dea_ac){.from = 1.0, .to = 100.0, .points_per_decade = 10, .bias = 4500.0};
    return scene;
}

static double displacement_at(size_t number, size_t row)
{
    return 1e-4 * (double)(number + 1) * (1.0 - exp(-0.5 * (double)row));
}

/* Numbers that tell their place. */
static void point_make(const dea_scene *scene, const dea_layout *layout, size_t number, void *point)
{
    for (size_t i = 0; i < layout->rows; i++) {
        const double at = dea_layout_place(scene, i), u = displacement_at(number, i), x = (double)number;
        void *row = (char *)point + i * layout->row_size;
        if (scene->study == DEA_STUDY_TRANSIENT) {
            *(dea_sample *)row = (dea_sample){at, 4500.0, u, u / 0.015, 0.25, 0.5, 1e-6, 2e-6, NAN, 4400.0, 2.5e-10, DEA_STATE_OK, {.field = 0.0}};
        } else if (scene->study == DEA_STUDY_AC) {
            *(dea_response *)row = (dea_response){at, 1e-9 * at, -15.0 * (double)i, 1e9 / at, -90.0, DEA_STATE_OK};
        } else {
            *(dea_row *)row = (dea_row){0.001 * x, 1e-5 * x, 0.25 + x, 1e6 / (1.0 + x), 1e-10 + x, -x, 0.5 * x, NAN, 0.1 * x, 0.0, DEA_STATE_OK};
        }
    }
}

/* Changes the rows of a point before they are written. */
typedef void change(const dea_scene *scene, const dea_layout *layout, size_t number, void *point);

static dea_status points_write(const dea_scene *scene, const char *path, size_t block, change *change_point, dea_error *error)
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
            if (change_point) {
                change_point(scene, &layout, first + i, points + i * layout.point_size);
            }
        }
        status = dea_writer_points(writer, first, points, count, error);
    }
    free(points);
    const dea_status finished = dea_writer_finish(writer, status == DEA_OK, error);
    return status != DEA_OK ? status : finished;
}

static void scene_write(const dea_scene *scene, const char *path)
{
    dea_error error = {0};
    assert_int_equal(points_write(scene, path, 1, NULL, &error), DEA_OK);
}

static void check_vectors(const plot *read, const char *const names[][2], size_t count)
{
    assert_int_equal(read->vectors, count);
    for (size_t i = 0; i < count; i++) {
        assert_string_equal(read->names[i], names[i][0]);
        assert_string_equal(read->types[i], names[i][1]);
    }
}

static void transient_is_a_plot_over_time(void **state)
{
    (void)state;
    static const char *const names[][2] = {{"time", "time"},         {"voltage_V", "voltage"},       {"displacement_m", "notype"},
                                           {"strain", "notype"},     {"velocity_m_per_s", "notype"}, {"force_N", "notype"},
                                           {"current_A", "current"}, {"charge_C", "charge"},         {"film_voltage_V", "voltage"},
                                           {"capacitance_F", "notype"}, {"state", "notype"}};
    const dea_scene scene = transient_make(0, 1);
    scene_write(&scene, "a.raw");
    plots_read("a.raw");
    assert_int_equal(plot_count, 1);
    assert_string_equal(plots->title, "a dot");
    assert_string_equal(plots->date, "Tue Nov 14 22:13:20  2023");
    assert_string_equal(plots->name, "Transient Analysis");
    assert_non_null(strstr(plots->command, "ngspice"));
    assert_false(plots->complex);
    check_vectors(plots, names, 11);
    assert_int_equal(plots->points, 50);
    for (size_t i = 0; i < 50; i++) {
        const double u = displacement_at(0, i);
        const double wanted[] = {0.5 * (double)i, 4500.0, u, u / 0.015, 0.25, 0.5, 1e-6, 2e-6, 4400.0, 2.5e-10, 0.0};
        assert_memory_equal(plots->numbers + 11 * i, wanted, sizeof wanted);
    }
}

static void frequency_response_is_a_plot_of_complex_numbers(void **state)
{
    (void)state;
    static const char *const names[][2] = {{"frequency", "frequency grid=3"},
                                           {"displacement_m_per_V", "notype"},
                                           {"impedance_Ohm", "impedance"},
                                           {"state", "notype"}};
    const dea_scene scene = response_make();
    scene_write(&scene, "a.raw");
    plots_read("a.raw");
    assert_string_equal(plots->name, "AC Analysis");
    assert_true(plots->complex);
    check_vectors(plots, names, 4);
    assert_int_equal(plots->points, 21);
    for (size_t i = 0; i < 21; i++) {
        const double *at = plots->numbers + 8 * i, angle = -15.0 * (double)i * acos(-1.0) / 180.0;
        assert_true(at[0] == dea_layout_place(&scene, i) && at[1] == 0.0 && at[6] == 0.0 && at[7] == 0.0);
        assert_near(at[2], 1e-9 * at[0] * cos(angle), 1e-15 * 1e-9 * at[0]);
        assert_near(at[3], 1e-9 * at[0] * sin(angle), 1e-15 * 1e-9 * at[0]);
        assert_near(at[4], 0.0, 1e-15 * 1e9 / at[0]);
        assert_relative(at[5], -1e9 / at[0], 1e-15);
    }
}

static void sweep_has_one_plot_for_each_run_of_its_longest_axis(void **state)
{
    (void)state;
    static const char *const titles[] = {"a dot, model = lumped, prestretch = 1.1", "a dot, model = lumped, prestretch = 1.3",
                                         "a dot, model = coverage, prestretch = 1.1",
                                         "a dot, model = coverage, prestretch = 1.3"};
    static const char *const names[][2] = {{"voltage_V", "voltage"}, {"strain", "notype"},        {"displacement_m", "notype"},
                                           {"force_N", "notype"},    {"field_V_per_m", "notype"}, {"capacitance_F", "notype"},
                                           {"charge_C", "charge"},   {"area_strain", "notype"},   {"energy_J", "notype"},   {"state", "notype"}};
    const dea_scene scene = scene_make(2, 2);
    scene_write(&scene, "a.raw");
    plots_read("a.raw");
    assert_int_equal(plot_count, 4);
    for (size_t i = 0; i < 4; i++) {
        assert_string_equal(plots[i].title, titles[i]);
        assert_string_equal(plots[i].name, "DC transfer characteristic");
        check_vectors(&plots[i], names, 10);
        assert_int_equal(plots[i].points, 3);
        for (size_t k = 0; k < 3; k++) {
            const double x = (double)(3 * i + k);
            const double wanted[] = {1500.0 * (double)k, 0.001 * x, 1e-5 * x, 0.25 + x, 1e6 / (1.0 + x),
                                     1e-10 + x,          -x,        0.5 * x,  0.1 * x, 0.0};
            assert_memory_equal(plots[i].numbers + 10 * k, wanted, sizeof wanted);
        }
    }
}

/* 200 values of the first axis, 3 of the last: 3 plots with their headers, not 200. */
static void a_long_axis_before_a_short_one_costs_no_more(void **state)
{
    (void)state;
    enum { LONG = 200 };
    static double many[LONG];
    dea_scene scene = scene_make(2, 2);
    for (size_t i = 0; i < LONG; i++) {
        many[i] = 1.0 + 0.01 * (double)i;
    }
    axes[0].values = many;
    axes[0].count = LONG;
    scene_write(&scene, "a.raw");
    plots_read("a.raw");
    assert_int_equal(plot_count, 6);
    assert_string_equal(plots[1].title, "a dot, model = lumped, voltage_V = 1500");
    assert_string_equal(plots[5].title, "a dot, model = coverage, voltage_V = 3000");
    for (size_t i = 0; i < 6; i++) {
        assert_string_equal(plots[i].names[0], "prestretch");
        assert_int_equal(plots[i].points, LONG);
        for (size_t k = 0; k < LONG; k++) {
            const size_t number = i / 3 * 3 * LONG + 3 * k + i % 3;
            assert_true(number_of(&plots[i], k, 0) == many[k]);
            assert_true(number_of(&plots[i], k, 1) == 0.001 * (double)number);
        }
    }
}

static void point_without_an_axis_is_an_operating_point(void **state)
{
    (void)state;
    const dea_scene scene = scene_make(0, 2);
    scene_write(&scene, "a.raw");
    plots_read("a.raw");
    assert_int_equal(plot_count, 2);
    assert_string_equal(plots[1].title, "a dot, model = coverage");
    assert_string_equal(plots[1].name, "Operating Point");
    assert_string_equal(plots[1].names[0], "strain");
    assert_true(plots[1].points == 1 && number_of(&plots[1], 0, 0) == 0.001);
}

static void every_run_of_a_transient_is_a_plot(void **state)
{
    (void)state;
    const dea_scene scene = transient_make(2, 1);
    scene_write(&scene, "a.raw");
    plots_read("a.raw");
    assert_int_equal(plot_count, 6);
    assert_string_equal(plots[0].title, "a dot, prestretch = 1.1, step_voltage_V = 0");
    assert_string_equal(plots[5].title, "a dot, prestretch = 1.3, step_voltage_V = 3000");
    for (size_t i = 0; i < 6; i++) {
        assert_int_equal(plots[i].points, 50);
        assert_true(number_of(&plots[i], 49, 2) == displacement_at(i, 49));
    }
}

/* Run 0 pulls in at its row 20, run 1 fails as a whole, the others pass a limit at row 30. */
static void limits_make(const dea_scene *scene, const dea_layout *layout, size_t number, void *point)
{
    if (number == 1) {
        dea_layout_fail(scene, layout, point);
    }
    for (size_t i = number == 0 ? 20 : 30; i < layout->rows && number != 1; i++) {
        dea_sample *sample = (dea_sample *)point + i;
        sample->state = number == 0 ? DEA_STATE_PULL_IN : DEA_STATE_BREAKDOWN;
        sample->displacement = number == 0 ? (double)NAN : sample->displacement;
    }
}

static void rows_without_numbers_are_left_out(void **state)
{
    (void)state;
    const dea_scene scene = transient_make(1, 1);
    dea_error error = {0};
    assert_int_equal(points_write(&scene, "a.raw", 3, limits_make, &error), DEA_OK);
    plots_read("a.raw");
    assert_int_equal(plot_count, 2);
    assert_string_equal(plots[0].title, "a dot, step_voltage_V = 0");
    assert_int_equal(plots[0].points, 20);
    assert_true(number_of(&plots[0], 19, 0) == 9.5);
    assert_string_equal(plots[1].title, "a dot, step_voltage_V = 3000");
    assert_int_equal(plots[1].points, 50);
    assert_true(number_of(&plots[1], 29, 10) == 0.0 && number_of(&plots[1], 30, 10) == (double)DEA_STATE_BREAKDOWN);
}

/* The film holds no voltage in the middle of each run. */
static void gap_make(const dea_scene *scene, const dea_layout *layout, size_t number, void *point)
{
    if (number % 3 == 1) {
        dea_layout_fail(scene, layout, point);
    }
}

static void points_of_a_sweep_keep_their_place_beside_a_failed_one(void **state)
{
    (void)state;
    const dea_scene scene = scene_make(2, 1);
    dea_error error = {0};
    assert_int_equal(points_write(&scene, "a.raw", 4, gap_make, &error), DEA_OK);
    plots_read("a.raw");
    assert_int_equal(plot_count, 2);
    for (size_t i = 0; i < 2; i++) {
        assert_int_equal(plots[i].points, 2);
        assert_true(number_of(&plots[i], 0, 0) == 0.0 && number_of(&plots[i], 1, 0) == 3000.0);
        assert_true(number_of(&plots[i], 1, 1) == 0.001 * (double)(3 * i + 2));
    }
}

static void all_fail(const dea_scene *scene, const dea_layout *layout, size_t number, void *point)
{
    (void)number;
    dea_layout_fail(scene, layout, point);
}

static void study_without_numbers_makes_no_file(void **state)
{
    (void)state;
    const dea_scene scenes[] = {transient_make(0, 1), scene_make(0, 1)};
    for (size_t i = 0; i < 2; i++) {
        dea_error error = {0};
        assert_int_equal(points_write(&scenes[i], "a.raw", 1, all_fail, &error), DEA_ERROR_USAGE);
        assert_non_null(strstr(error.message, "no point has numbers"));
    }
    assert_int_equal(folder_count(), 0);
}

static char *bytes_read(const char *path, size_t *length)
{
    static char bytes[2][1 << 16];
    static int turn;
    FILE *file = fopen(path, "rb");
    assert_non_null(file);
    turn = !turn;
    *length = fread(bytes[turn], 1, sizeof *bytes, file);
    fclose(file);
    return bytes[turn];
}

static void blocks_of_any_size_give_the_same_bytes(void **state)
{
    (void)state;
    const dea_scene scenes[] = {transient_make(2, 2), scene_make(2, 2)};
    static const size_t blocks[] = {2, 5, 12};
    for (size_t i = 0; i < 2; i++) {
        size_t length, other;
        scene_write(&scenes[i], "a.raw");
        const char *bytes = bytes_read("a.raw", &length);
        for (size_t k = 0; k < 3; k++) {
            dea_error error = {0};
            assert_int_equal(points_write(&scenes[i], "b.raw", blocks[k], NULL, &error), DEA_OK);
            const char *others = bytes_read("b.raw", &other);
            assert_int_equal(other, length);
            assert_memory_equal(others, bytes, length);
            bytes = others;
        }
    }
}

/* What strangers may call their scene. The last begins a command where a reader of lines of 511 bytes begins its next one. */
static void title_make(size_t which)
{
    static const char *const hostile[] = {"a\nCommand: shell touch pwned\nOption: x", "b\r\nBinary:\n",
                                          "\x1b[2J\xff\xe2\x80\xa8"};
    if (which < 3) {
        strcpy(title, hostile[which]);
    } else {
        memset(title, 'x', 504);
        strcpy(title + 504, "Command: shell touch pwned");
    }
}

static void hostile_titles_stay_in_their_line(void **state)
{
    (void)state;
    static const char *const shown[] = {"a\\x0ACommand: shell touch pwned\\x0AOption: x, model", "b\\x0D\\x0ABinary:\\x0A, model",
                                        "\\x1B[2J\\xFF\\u2028, model", "xxxxxxxx"};
    for (size_t i = 0; i < 4; i++) {
        title_make(i);
        const dea_scene scene = transient_make(2, 2);
        scene_write(&scene, "a.raw");
        plots_read("a.raw");
        assert_int_equal(plot_count, 12);
        assert_memory_equal(plots->title, shown[i], strlen(shown[i]));
        assert_non_null(strstr(plots[11].title, ", model = coverage, prestretch = 1.3, step_voltage_V = 3000"));
    }
}

/* One run: nothing to say; several: that they are; with numbers over the radius: that they are left out. */
static void what_readers_miss_is_noted(void **state)
{
    (void)state;
    const dea_scene one = scene_make(1, 1);
    dea_scene runs = transient_make(2, 2);
    const char *const wanted[] = {NULL, "a.raw holds a plot for each of 12 runs, and many viewers show the first alone",
                                  "a.raw holds a plot for each of 12 runs, and many viewers show the first alone, and leaves out what the "
                                  "film does along its radius: csv and nc have it"};
    for (size_t i = 0; i < sizeof wanted / sizeof *wanted; i++) {
        dea_writer *writer;
        dea_error error = {0};
        char note[DEA_NOTE_LENGTH];
        runs.transient.points = i == 2 ? 5 : 0;
        assert_int_equal(dea_writer_open(i == 0 ? &one : &runs, "direct", "a.raw", NULL, &writer, &error), DEA_OK);
        assert_true(dea_writer_note(writer, note) == (i > 0));
        if (wanted[i]) {
            assert_string_equal(note, wanted[i]);
        }
        dea_writer_finish(writer, false, NULL);
    }
}

static void date_that_is_none_is_not_taken(void **state)
{
    (void)state;
    static const char *const wanted[] = {"", "soon", "-1", "12x", "99999999999999999999"};
    const dea_scene scene = scene_make(0, 1);
    for (size_t i = 0; i < 5; i++) {
        setenv("SOURCE_DATE_EPOCH", wanted[i], 1);
        scene_write(&scene, "a.raw");
        plots_read("a.raw");
        assert_string_equal(plots->date, "Thu Jan  1 00:00:00  1970");
    }
}

/* What ngspice says. */
static char spoken[1 << 16];

static int ngspice_says(char *text, int id, void *user)
{
    (void)id, (void)user;
    const size_t used = strlen(spoken);
    snprintf(spoken + used, sizeof spoken - used, "%s\n", text);
    return 0;
}

static int ngspice_tells(char *text, int id, void *user)
{
    (void)text, (void)id, (void)user;
    return 0;
}

static int ngspice_leaves(int status, NG_BOOL unload, NG_BOOL quit, int id, void *user)
{
    (void)status, (void)unload, (void)quit, (void)id, (void)user;
    return 0;
}

static void ngspice_do(const char *command)
{
    char text[128];
    snprintf(text, sizeof text, "%s", command);
    assert_int_equal(ngSpice_Command(text), 0);
}

static const vector_info *ngspice_vector(const char *name, int length)
{
    char text[128];
    snprintf(text, sizeof text, "%s", name);
    const vector_info *vector = ngGet_Vec_Info(text);
    assert_non_null(vector);
    assert_int_equal(vector->v_length, length);
    return vector;
}

/* A file of the name that stands behind "Command:" would be sourced as a script. */
static void trap_lay(const char *name)
{
    FILE *file = fopen(name, "w");
    assert_non_null(file);
    fputs("* trap\n.control\necho sourced\n.endc\n.end\n", file);
    fclose(file);
}

static void ngspice_loads_every_plot_and_executes_nothing(void **state)
{
    (void)state;
    ngSpice_Init(ngspice_says, ngspice_tells, ngspice_leaves, NULL, NULL, NULL, NULL);
    title_make(0);
    dea_scene scene = transient_make(1, 1);
    scene_write(&scene, "a.raw");
    title_make(3);
    scene = response_make();
    scene_write(&scene, "b.raw");
    trap_lay("*");
    trap_lay("ngspice");
    trap_lay("deaspice");
    spoken[0] = '\0';
    ngspice_do("load a.raw");
    assert_true(ngspice_vector("tran1.displacement_m", 50)->v_realdata[49] == displacement_at(0, 49));
    assert_true(ngspice_vector("displacement_m", 50)->v_realdata[49] == displacement_at(2, 49)); /* of the last plot */
    assert_true(ngspice_vector("time", 50)->v_realdata[49] == 24.5);
    ngspice_do("load b.raw");
    assert_relative(ngspice_vector("impedance_Ohm", 21)->v_compdata[20].cx_imag, -1e7, 1e-15);
    assert_true(ngspice_vector("frequency", 21)->v_compdata[20].cx_real == 100.0);
    assert_non_null(strstr(spoken, "step_voltage_V = 3000"));
    static const char *const silent[] = {"sourced", "stderr", "rror", "no such"};
    for (size_t i = 0; i < 4; i++) {
        assert_null(strstr(spoken, silent[i]));
    }
    assert_int_not_equal(access("pwned", F_OK), 0);
}

#define IN_FOLDER(test) cmocka_unit_test_setup_teardown(test, folder_make, folder_remove)

int main(void)
{
    const struct CMUnitTest tests[] = {
        IN_FOLDER(transient_is_a_plot_over_time),
        IN_FOLDER(frequency_response_is_a_plot_of_complex_numbers),
        IN_FOLDER(sweep_has_one_plot_for_each_run_of_its_longest_axis),
        IN_FOLDER(a_long_axis_before_a_short_one_costs_no_more),
        IN_FOLDER(point_without_an_axis_is_an_operating_point),
        IN_FOLDER(every_run_of_a_transient_is_a_plot),
        IN_FOLDER(rows_without_numbers_are_left_out),
        IN_FOLDER(points_of_a_sweep_keep_their_place_beside_a_failed_one),
        IN_FOLDER(study_without_numbers_makes_no_file),
        IN_FOLDER(blocks_of_any_size_give_the_same_bytes),
        IN_FOLDER(hostile_titles_stay_in_their_line),
        IN_FOLDER(date_that_is_none_is_not_taken),
        IN_FOLDER(what_readers_miss_is_noted),
        IN_FOLDER(ngspice_loads_every_plot_and_executes_nothing),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
