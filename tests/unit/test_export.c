/* Exported netlists in a simulator of their own, `ngspice -b`, against the engines. Run from the project's folder. */
#include "films.h"
#include "random_transients.h"

#include <complex.h>
#include <ctype.h>
#include <fcntl.h>
#include <stdlib.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include "netlist/export.h"
#include "netlist/part.h"

enum { RANDOM_SCENES = 50, RANDOM_SWEEPS = 40, PATH_ROOM = 512, MOST_VECTORS = 96, SECONDS = 120 };

static char folder[] = "/tmp/test_export_XXXXXX";

/* A plot of a raw file: columns of `count` values, of real and imaginary parts where it is complex. */
typedef struct plot {
    char names[MOST_VECTORS][64];
    double *columns[MOST_VECTORS]; /* owned */
    size_t width, count;
    bool is_complex;
} plot;

static void free_plot(plot *p)
{
    for (size_t i = 0; i < p->width; i++) {
        free(p->columns[i]);
    }
    *p = (plot){.width = 0};
}

static void path_to(const char *name, char *path)
{
    snprintf(path, PATH_ROOM, "%s/%s", folder, name);
}

/* The head of a raw file up to "Binary:", then its numbers, point by point. */
static void read_raw(const char *name, plot *p)
{
    char path[PATH_ROOM], line[256];
    bool listing = false;
    *p = (plot){.width = 0};
    path_to(name, path);
    FILE *file = fopen(path, "rb");
    assert_non_null(file);
    while (fgets(line, sizeof line, file) && strncmp(line, "Binary:", 7) != 0) {
        size_t index;
        char word[64];
        if (strncmp(line, "Flags: complex", 14) == 0) {
            p->is_complex = true;
        } else if (sscanf(line, "No. Points: %zu", &p->count) == 1) {
            continue;
        } else if (strncmp(line, "Variables:", 10) == 0) {
            listing = true;
        } else if (listing && sscanf(line, " %zu %63s", &index, word) == 2) {
            assert_true(index < MOST_VECTORS);
            snprintf(p->names[index], sizeof p->names[index], "%s", word);
            p->width = index + 1;
        }
    }
    const size_t parts = p->is_complex ? 2 : 1;
    for (size_t i = 0; i < p->width; i++) {
        p->columns[i] = calloc(parts * p->count + 1, sizeof(double));
        assert_non_null(p->columns[i]);
    }
    for (size_t k = 0; k < p->count; k++) {
        for (size_t i = 0; i < p->width; i++) {
            assert_int_equal(fread(&p->columns[i][parts * k], sizeof(double), parts, file), parts);
        }
    }
    fclose(file);
}

static const double *column(const plot *p, const char *name)
{
    for (size_t i = 0; i < p->width; i++) {
        if (strcmp(p->names[i], name) == 0) {
            return p->columns[i];
        }
    }
    fail_msg("the simulator gave no %s", name);
    return NULL;
}

/* Netlist of a scene; the caller frees it. */
static dea_status export_scene(const dea_scene *scene, const char *dialect, const char *analogy, char **text, dea_error *error)
{
    size_t length;
    dea_export export = {.scene = scene,
                         .dialect = dea_dialect_find(dialect),
                         .analogy = dea_analogy_find(analogy),
                         .out = open_memstream(text, &length)};
    assert_non_null(export.out);
    assert_non_null(export.dialect);
    assert_non_null(export.analogy);
    export.analogy_given = scene->study != DEA_STUDY_SWEEP;
    const dea_status status = dea_export_netlist(&export, error);
    assert_int_equal(fclose(export.out), 0);
    return status;
}

static char *exported(const dea_scene *scene, const char *dialect, const char *analogy)
{
    char *text = NULL;
    dea_error error = {0};
    if (export_scene(scene, dialect, analogy, &text, &error) != DEA_OK) {
        fail_msg("%s", error.message);
    }
    return text;
}

/* Runs a netlist by `ngspice -b`; its exit status. */
static int simulate(const char *text)
{
    char path[PATH_ROOM];
    int status;
    path_to("circuit.cir", path);
    FILE *file = fopen(path, "w");
    assert_non_null(file);
    assert_true(fputs(text, file) >= 0);
    assert_int_equal(fclose(file), 0);
    const pid_t pid = fork();
    if (pid == 0) {
        const int log = open("/dev/null", O_RDWR);
        if (chdir(folder) != 0 || log < 0) {
            _exit(126);
        }
        dup2(log, STDIN_FILENO);
        dup2(log, STDOUT_FILENO);
        dup2(log, STDERR_FILENO);
        setrlimit(RLIMIT_CPU, &(struct rlimit){SECONDS, SECONDS});
        execlp("ngspice", "ngspice", "-n", "-b", "-r", "out.raw", "circuit.cir", (char *)NULL);
        _exit(127);
    }
    assert_int_equal(waitpid(pid, &status, 0), pid);
    return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
}

static void run_netlist(const dea_scene *scene, const char *analogy, plot *p)
{
    char *text = exported(scene, "ngspice", analogy);
    const int status = simulate(text);
    if (status != 0) {
        print_error("%s\n", text);
        fail_msg("ngspice -b gave exit status %d", status);
    }
    free(text);
    read_raw("out.raw", p);
}

/* All points of a study; the caller frees them. */
typedef struct answer {
    dea_layout layout;
    char *points;
} answer;

static dea_status take(void *user, size_t first, const void *points, size_t count, dea_error *error)
{
    answer *a = user;
    (void)error;
    memcpy(a->points + first * a->layout.point_size, points, count * a->layout.point_size);
    return DEA_OK;
}

static void solve(const dea_scene *scene, const char *engine, answer *a)
{
    const dea_run_options options = {.jobs = 1, .points = take, .user = a};
    dea_error error = {0};
    a->layout = dea_layout_of(scene);
    a->points = calloc(dea_scene_point_count(scene), a->layout.point_size);
    assert_non_null(a->points);
    if (dea_study_run(scene, dea_engine_find(engine), &options, &error) != DEA_OK) {
        fail_msg("%s: %s", engine, error.message);
    }
}

static const dea_sample *samples_of(const answer *a)
{
    return (const dea_sample *)(const void *)a->points;
}

/* True where the steps beside an interval are like it; behind a corner they are not. */
static bool is_alike(double a, double b)
{
    return a > 0.15 * b && b > 0.15 * a;
}

/* Displacement at a time: the polynomial through the two points around it and those beside them, where no corner lies between. */
static double displacement_at(const plot *p, double time)
{
    const double *t = column(p, "time");
    const double *u = column(p, "v(disp)");
    size_t low = 0;
    size_t high = p->count - 1;
    while (high - low > 1) {
        const size_t middle = (low + high) / 2;
        *(t[middle] <= time ? &low : &high) = middle;
    }
    const double h = t[high] - t[low];
    const size_t first = low > 0 && is_alike(t[low] - t[low - 1], h) ? low - 1 : low;
    const size_t last = high + 1 < p->count && is_alike(t[high + 1] - t[high], h) ? high + 1 : high;
    double sum = 0.0;
    for (size_t i = first; i <= last; i++) {
        double weight = 1.0;
        for (size_t k = first; k <= last; k++) {
            weight *= k == i ? 1.0 : (fmin(time, t[high]) - t[k]) / (t[i] - t[k]);
        }
        sum += weight * u[i];
    }
    return sum;
}

/* Largest difference from the samples over their peak. Standalone ngspice does not save the point t = 0. */
static double error_of(const plot *p, const answer *a)
{
    const dea_sample *samples = samples_of(a);
    const double first = column(p, "time")[0];
    double peak = 0.0;
    double error = 0.0;
    for (size_t i = 0; i < a->layout.rows; i++) {
        assert_true(isfinite(samples[i].displacement));
        peak = fmax(peak, fabs(samples[i].displacement));
        if (samples[i].time > first) {
            error = fmax(error, fabs(displacement_at(p, samples[i].time) - samples[i].displacement));
        }
    }
    return error / peak;
}

/* The netlist of a scene in each of some analogies, up to NULL, against one run of an engine. */
static void check_transient(const dea_scene *scene, const char *const *analogies, const char *reference, double tolerance,
                            const char *what)
{
    answer a;
    dea_scene exact = *scene;
    exact.accuracy = strcmp(reference, "ngspice") == 0 ? 1e-6 : 1e-9;
    solve(&exact, reference, &a);
    for (; *analogies; analogies++) {
        plot p;
        run_netlist(scene, *analogies, &p);
        const double error = error_of(&p, &a);
        if (!(error <= tolerance)) {
            fail_msg("%s, %s against %s: error %.3g, %zu time points", what, *analogies, reference, error, p.count);
        }
        free_plot(&p);
    }
    free(a.points);
}

static void read_example(const char *name, const char *const *changes, size_t count, const char *model, dea_scene *scene)
{
    char path[PATH_ROOM];
    dea_setting settings[8];
    dea_error error = {0};
    for (size_t i = 0; i < count; i++) {
        settings[i].text = changes[i];
    }
    snprintf(path, sizeof path, "examples/%s.yaml", name);
    if (dea_scene_read(path, settings, count, model, scene, &error) != DEA_OK) {
        fail_msg("%s", error.message);
    }
}

/* A transient example and what makes one run of it. The paper's protocol is cut to what rings, 25 s at its step are too long. */
typedef struct moving_example {
    const char *name, *model;
    const char *changes[6];
    double tolerance;
} moving_example;

static void check_example(const moving_example *e, const char *reference, double tolerance)
{
    dea_scene scene;
    size_t count = 0;
    while (count < 6 && e->changes[count]) {
        count++;
    }
    read_example(e->name, e->changes, count, e->model, &scene);
    check_transient(&scene, (const char *const[]){"mobility", "impedance", NULL}, reference, tolerance, e->name);
    dea_scene_free(&scene);
}

static void netlists_of_the_moving_examples_give_the_numbers_of_the_engines(void **state)
{
    static const moving_example examples[] = {
        {"fast-lens", NULL, {"accuracy=1e-5"}, 1e-5},
        {"lens-optics", NULL, {"study.over={}"}, 1e-6},
        {"lens-optics", "coverage", {"study.over={}"}, 1e-6},
        {"sine-supply", NULL, {"accuracy=1e-6"}, 1e-6},
        {"vhb-creep", "lumped", {"study.transient={until: 10 s, every: 50 ms}"}, 1e-6},
        {"vhb-creep", "coverage", {"study.transient={until: 10 s, every: 50 ms}"}, 1e-6},
        {"protocol",
         NULL,
         {"study.over={}", "drive.waveform.step.on=1 ms", "drive.waveform.step.off=6 ms",
          "study.transient={until: 10 ms, every: 0.1 ms}", "accuracy=1e-6"},
         1e-6},
    };
    (void)state;
    simulate_without_sanitizers();
    for (size_t i = 0; i < sizeof examples / sizeof *examples; i++) {
        check_example(&examples[i], "ida", examples[i].tolerance);
    }
    check_example(&examples[1], "ngspice", 2e-6); /* both have their error */
}

/* What a source at its limit charges over tens of periods hardly swings: steps as for a jump would be a million. */
static void a_film_that_is_charged_evenly_takes_long_steps(void **state)
{
    static const char *const changes[] = {"accuracy=1e-6"}, *const analogies[] = {"mobility", "impedance"};
    dea_scene scene, exact;
    answer a;
    (void)state;
    simulate_without_sanitizers();
    read_example("constant-current", changes, 1, "lame", &scene);
    exact = scene;
    exact.accuracy = 1e-9;
    solve(&exact, "ida", &a);
    for (size_t i = 0; i < 2; i++) {
        plot p;
        run_netlist(&scene, analogies[i], &p);
        const double error = error_of(&p, &a);
        if (!(error <= 1e-6 && p.count < 300000)) {
            fail_msg("%s: error %.3g, %zu time points", analogies[i], error, p.count);
        }
        free_plot(&p);
    }
    free(a.points);
    dea_scene_free(&scene);
}

/* Slow motion of a random scene: a twentieth of its periods, and no time below a hundredth of the run, so that one step for all
 * of the run is affordable. */
static void slow_down(dea_scene *scene)
{
    dea_material *material = &scene->material;
    const double shortest = 0.01 * scene->transient.until;
    material->density *= 400.0;
    for (size_t i = 0; i < material->prony_count; i++) {
        material->prony[i].tau = fmax(material->prony[i].tau, shortest);
    }
    if (isnan(material->density) && material->retardation < 10.0 * shortest) {
        material->retardation = 10.0 * shortest;
    }
    if (scene->drive.series_resistance > 0.0) {
        const double capacitance =
            3e-11 * 3.0 * pow(scene->actuator.frame_radius * scene->actuator.prestretch, 2.0) / scene->actuator.film_thickness;
        scene->drive.series_resistance = fmax(scene->drive.series_resistance, 10.0 * shortest / capacitance);
    }
    scene->drive.waveform.step.rise = fmax(scene->drive.waveform.step.rise, 1e-4 * shortest);
}

static bool ends_early(const answer *a)
{
    return dea_layout_state(&a->layout, a->points + (a->layout.rows - 1) * a->layout.row_size) == DEA_STATE_PULL_IN;
}

/* The step that the file takes for an accuracy keeps every one of these within half of it. */
static void netlists_of_random_transients_are_right_to_half_of_what_is_asked(void **state)
{
    static const char *const analogies[] = {"mobility", "impedance"};
    uint64_t seed = 20250711;
    size_t done = 0;
    (void)state;
    simulate_without_sanitizers();
    for (int i = 0; i < RANDOM_SCENES; i++) {
        dea_scene scene;
        plot p;
        answer a;
        random_transient(&seed, &scene);
        slow_down(&scene);
        scene.accuracy = 1e-8;
        solve(&scene, "ida", &a);
        scene.accuracy = 2e-5;
        if (!ends_early(&a)) {
            run_netlist(&scene, analogies[i % 2], &p);
            const double error = error_of(&p, &a);
            if (!(error <= 0.5 * scene.accuracy)) {
                fail_msg("random scene %d, %s: error %.3g, %zu points", i, scene.models[0]->name, error, p.count);
            }
            free_plot(&p);
            done++;
        }
        free(a.points);
    }
    assert_true(done >= RANDOM_SCENES - 5);
}

static double complex polar(double magnitude, double degrees)
{
    return magnitude * cexp(I * degrees * DEA_PI / 180.0);
}

static void check_response(const dea_scene *scene, const char *analogy)
{
    answer a;
    plot p;
    solve(scene, "ngspice", &a);
    run_netlist(scene, analogy, &p);
    const dea_response *rows = (const dea_response *)(const void *)a.points;
    const double *u = column(&p, "v(disp)");
    const double *i = column(&p, "i(vsource)");
    assert_true(p.is_complex);
    assert_int_equal(p.count, a.layout.rows);
    for (size_t k = 0; k < p.count; k++) {
        const double complex wanted = polar(rows[k].displacement, rows[k].displacement_phase);
        const double complex impedance = polar(rows[k].impedance, rows[k].impedance_phase);
        assert_true(cabs(u[2 * k] + I * u[2 * k + 1] - wanted) <= 1e-9 * cabs(wanted));
        assert_true(cabs(-1.0 / (i[2 * k] + I * i[2 * k + 1]) - impedance) <= 1e-9 * cabs(impedance));
    }
    free_plot(&p);
    free(a.points);
}

static void netlists_of_frequency_responses_give_the_numbers_of_the_engine(void **state)
{
    static const char *const models[] = {"lumped", "lame", "coverage"};
    static const char *const wide[] = {"retardation=10 us"};
    static const char *const leaky[] = {"drive.leakage_resistance=1 GOhm", "study.ac.bias=0 V"};
    dea_scene scene;
    (void)state;
    for (size_t i = 0; i < 3; i++) {
        read_example("resonance", wide, 1, models[i], &scene);
        check_response(&scene, "mobility");
        check_response(&scene, "impedance");
        dea_scene_free(&scene);
    }
    read_example("resonance", leaky, 2, NULL, &scene);
    check_response(&scene, "mobility");
    check_response(&scene, "impedance");
    dea_scene_free(&scene);
}

/* The end of a band that is no multiple of the decade's steps has no row. */
static void grid_of_a_frequency_response_ends_below_an_end_that_is_off_it(void **state)
{
    static const char *const end[] = {"study.ac.to=7 kHz"};
    dea_scene scene;
    plot p;
    (void)state;
    read_example("resonance", end, 1, NULL, &scene);
    run_netlist(&scene, "mobility", &p);
    assert_int_equal(p.count, dea_layout_of(&scene).rows - 1);
    free_plot(&p);
    dea_scene_free(&scene);
}

/* Rows of one line and where they lie in the answer. */
static size_t check_line(const plot *p, size_t line, const dea_row *rows, size_t count, size_t stride, const char *what)
{
    char name[32];
    size_t begin = 0, from = 0, to = 0;
    for (size_t i = 0; i <= count; i++) {
        if (i == count || isnan(rows[i * stride].displacement)) {
            if (i - begin > to - from) {
                from = begin;
                to = i;
            }
            begin = i + 1;
        }
    }
    const size_t parts = count > 1 ? (p->count - 1) / (count - 1) : 1;
    snprintf(name, sizeof name, "v(edge%zu)", line);
    for (size_t i = from; i < to; i++) {
        const double found = column(p, name)[i * parts];
        const double wanted = rows[i * stride].displacement;
        if (!is_close(found, wanted, 1e-6, 1e-24)) {
            fail_msg("%s, line %zu, point %zu: %.17g, wanted %.17g", what, line, i, found, wanted);
        }
    }
    return to - from;
}

/* The longest axis of a sweep makes the lines; of two as long ones the last. */
static size_t check_sweep(const dea_scene *scene, const char *what)
{
    plot p;
    answer a;
    size_t best = 0, stride = 1, done = 0;
    for (size_t i = 1; i < scene->axis_count; i++) {
        best = scene->axes[i].count >= scene->axes[best].count ? i : best;
    }
    for (size_t i = best + 1; i < scene->axis_count; i++) {
        stride *= scene->axes[i].count;
    }
    const size_t count = scene->axis_count > 0 ? scene->axes[best].count : 1;
    solve(scene, "ngspice", &a);
    run_netlist(scene, "mobility", &p);
    const dea_row *rows = (const dea_row *)(const void *)a.points;
    for (size_t i = 0; i * count < dea_scene_point_count(scene); i++) {
        const dea_row *first = rows + i / stride * stride * count + i % stride;
        done += check_line(&p, i + 1, first, count, stride, what);
    }
    free_plot(&p);
    free(a.points);
    return done;
}

static void netlists_of_the_static_examples_give_the_numbers_of_the_engine(void **state)
{
    static const struct {
        const char *name, *model;
        size_t points;
    } examples[] = {
        {"figure9", "constant_force", 273},
        {"figure10", "lumped", 543},
        {"figure10", "coverage", 543},
        {"lens-sweep", "lumped", 81},
        {"lens-sweep", "lame", 81},
        {"lens-sweep", "coverage", 81},
        {"pull-in", "constant_force", 48},
        {"pull-in", "coverage", 123},
        {"vhb", "lumped", 93},
        {"vhb", "coverage", 78},
        {"voltage-coverage-map", NULL, 3721},
    };
    (void)state;
    for (size_t i = 0; i < sizeof examples / sizeof *examples; i++) {
        dea_scene scene;
        read_example(examples[i].name, NULL, 0, examples[i].model, &scene);
        assert_int_equal(check_sweep(&scene, examples[i].name), examples[i].points);
        dea_scene_free(&scene);
    }
}

static void netlist_of_one_point_gives_its_displacement(void **state)
{
    dea_scene scene = paper_scene(DEA_LENS, 1.2, 0.4, 3000.0);
    (void)state;
    scene.models[0] = dea_model_find("coverage");
    assert_int_equal(check_sweep(&scene, "one point"), 1);
}

/* Lists of any scalar from the scene's value on, up to the voltage of pull-in. */
static void netlists_of_random_sweeps_give_the_numbers_of_the_engine(void **state)
{
    static const char *const models[] = {"constant_force", "lumped", "coverage", "lame"};
    uint64_t seed = 4711;
    size_t done = 0;
    (void)state;
    for (int i = 0; i < RANDOM_SWEEPS; i++) {
        enum { COUNT = 12 };
        double values[COUNT];
        dea_axis axis;
        char what[32];
        const char *model = models[i % 4];
        dea_scene scene = random_scene(&seed);
        scene.models[0] = dea_model_find(model);
        if (strcmp(model, "constant_force") == 0) {
            scene.actuator.kind = DEA_DOT;
        }
        scene.actuator.coverage = random_between(&seed, 0.1, 0.9);
        double *field = swept_field(&scene, i % SWEPT_FIELDS);
        scene.drive.voltage = pull_in_voltage(&scene, model) * random_between(&seed, 0.1, 0.8);
        for (int k = 0; k < COUNT; k++) {
            values[k] = *field * (1.0 + 0.04 * k * random_between(&seed, 0.5, 1.0));
        }
        add_axis(&scene, &axis, field, values, COUNT);
        answer a;
        solve(&scene, "direct", &a);
        bool any = false;
        for (size_t k = 0; k < COUNT; k++) {
            any = any || isfinite(((const dea_row *)(const void *)a.points)[k].displacement);
        }
        free(a.points);
        snprintf(what, sizeof what, "random sweep %d", i);
        done += any ? check_sweep(&scene, what) : 0;
    }
    assert_true(done > RANDOM_SWEEPS * 9);
}

/* A film of every law at rest, in motion and about a bias. */
static void netlists_of_every_law_give_the_numbers_of_the_engines(void **state)
{
    (void)state;
    for (size_t i = 0; i + 1 < FILMS; i++) { /* Yeoh's law stands everywhere else */
        const film *f = &films[i + 1];
        double voltages[] = {400.0, 500.0, 600.0};
        dea_axis axis;
        dea_scene scene = paper_scene(i % 2 ? DEA_LENS : DEA_DOT, 1.3, 0.45, 400.0);
        set_law(&scene, f);
        scene.models[0] = dea_model_find(i % 3 ? "ring" : "coverage");
        add_axis(&scene, &axis, &scene.drive.voltage, voltages, 3);
        assert_int_equal(check_sweep(&scene, f->law), 3);
        scene.axis_count = 0;
        scene.material.retardation = 2e-4;
        scene.material.prony_count = 1;
        scene.material.prony[0] = (dea_prony){0.1, 5e-3};
        scene.drive.voltage = (double)NAN;
        scene.accuracy = 1e-4;
        scene.study = DEA_STUDY_AC;
        scene.ac = (dea_ac){.from = 10.0, .to = 1000.0, .points_per_decade = 1, .bias = 500.0};
        check_response(&scene, i % 2 ? "mobility" : "impedance");
        scene.study = DEA_STUDY_TRANSIENT;
        scene.transient = (dea_transient){.until = 4e-3, .every = 1e-4};
        scene.drive.waveform =
            (dea_waveform){.kind = DEA_WAVE_STEP, .step = {1e-3, (double)NAN, 600.0, 1e-4}, .period = (double)NAN};
        check_transient(&scene, (const char *const[]){i % 2 ? "mobility" : "impedance", NULL}, "ida", 1e-4, f->law);
    }
}

static void check_refused(const dea_scene *scene, const char *analogy, const char *says)
{
    char *text = NULL;
    dea_error error = {0};
    assert_int_equal(export_scene(scene, "ngspice", analogy, &text, &error), DEA_ERROR_UNSUPPORTED);
    if (!strstr(error.message, says)) {
        fail_msg("\"%s\" does not say \"%s\"", error.message, says);
    }
    free(text);
}

static void what_no_netlist_can_hold_is_refused_with_a_way_out(void **state)
{
    static const char *const far[] = {"study.sweep={}", "prestretch=1.4", "drive.voltage=6 kV"};
    dea_scene scene;
    (void)state;
    read_example("figure10", NULL, 0, NULL, &scene);
    check_refused(&scene, "mobility", "--model lumped");
    dea_scene_free(&scene);
    read_example("figure9", NULL, 0, "pelrine", &scene);
    check_refused(&scene, "mobility", "the model pelrine is not a network");
    dea_scene_free(&scene);
    read_example("figure9", NULL, 0, "lumped", &scene);
    dea_export export = {.scene = &scene,
                         .dialect = dea_dialect_at(0),
                         .analogy = dea_analogy_find("impedance"),
                         .analogy_given = true,
                         .out = tmpfile()};
    assert_non_null(export.out);
    assert_int_equal(dea_export_netlist(&export, NULL), DEA_ERROR_UNSUPPORTED);
    fclose(export.out);
    dea_scene_free(&scene);
    read_example("lens-optics", NULL, 0, NULL, &scene);
    check_refused(&scene, "mobility", "--set study.over={}");
    dea_scene_free(&scene);
    read_example("pull-in", far, 3, "constant_force", &scene);
    check_refused(&scene, "mobility", "no point of the sweep has an equilibrium");
    dea_scene_free(&scene);
}

/* Lines that are no comments. */
static char *cards_of(const char *text)
{
    char *cards = calloc(strlen(text) + 1, 1);
    assert_non_null(cards);
    for (const char *line = text; *line; line += strcspn(line, "\n") + 1) {
        if (*line != '*') {
            strncat(cards, line, strcspn(line, "\n") + 1);
        }
    }
    return cards;
}

static void titles_never_become_cards_or_commands(void **state)
{
    static const char *const titles[] = {
        ".control\nshell touch pwned\n.endc",
        "a\n.control\nshell touch pwned\n.endc\n",
        "*ng_script\nshell touch pwned",
        "ng_script\r\nshell touch pwned",
        "a\r.control\rshell touch pwned\r.endc\r",
        "`touch pwned`",
        "$(touch pwned)",
        "\\\n+ touch",
        "# shell touch pwned",
        "a\n.include /etc/passwd",
        "; vx film 0 1",
        "\n\n",
        "",
        "\xc3\xa4\xff\x01\x1b[31m",
    };
    char pwned[PATH_ROOM];
    char plain_title[] = "plain";
    dea_scene scene;
    path_to("pwned", pwned);
    (void)state;
    read_example("sine-supply", NULL, 0, NULL, &scene);
    scene.transient.until = 1e-3;
    char *own = scene.title;
    scene.title = plain_title;
    for (size_t d = 0; dea_dialect_at(d); d++) {
        char *plain = exported(&scene, dea_dialect_at(d)->name, "mobility");
        char *wanted = cards_of(plain);
        for (size_t i = 0; i < sizeof titles / sizeof *titles; i++) {
            char title[128];
            snprintf(title, sizeof title, "%s", titles[i]);
            scene.title = title;
            char *text = exported(&scene, dea_dialect_at(d)->name, "mobility");
            char *cards = cards_of(text);
            assert_string_equal(cards, wanted);
            assert_memory_equal(text, "* ", 2);
            assert_null(strchr(text, '\r'));
            assert_int_equal(d == 0 ? simulate(text) : 0, 0);
            assert_int_equal(access(pwned, F_OK), -1);
            free(cards);
            free(text);
        }
        scene.title = plain_title;
        free(wanted);
        free(plain);
    }
    scene.title = own;
    dea_scene_free(&scene);
}

/* A word of a card that begins with a digit is a number without suffix. */
static void check_numbers(const char *line, size_t length)
{
    for (size_t i = 0; i < length; i++) {
        const bool begins = isdigit((unsigned char)line[i]) &&
                            (i == 0 || !(isalnum((unsigned char)line[i - 1]) || line[i - 1] == '_' || line[i - 1] == '.'));
        if (begins) {
            char *end;
            (void)strtod(&line[i], &end);
            if (isalpha((unsigned char)*end)) {
                fail_msg("a number with a suffix: %.*s", (int)length, line);
            }
            i = (size_t)(end - line) - 1;
        }
    }
}

static bool holds(const char *line, size_t length, const char *what)
{
    const char *at = strstr(line, what);
    return at && at < line + length;
}

static void check_card(const char *line, size_t length, const dea_dialect *dialect)
{
    static const char *const reserved[] = {".param e=",   ".param pi=",  ".param time=", ".param temper=",
                                           ".param min=", ".param max=", ".param abs=",  ".param hertz="};
    const bool pspice = strcmp(dialect->name, "pspice") == 0;
    bool wrong = !(strchr(".+", line[0]) || isupper((unsigned char)line[0])) || holds(line, length, "^") || holds(line, length, "**") ||
                 holds(line, length, "?") || (!pspice && holds(line, length, "log(")) || (pspice && line[0] == 'B') ||
                 (pspice && holds(line, length, "ln("));
    for (size_t i = 0; i < sizeof reserved / sizeof *reserved; i++) {
        wrong = wrong || holds(line, length, reserved[i]);
    }
    for (size_t i = 0; i < length; i++) {
        wrong = wrong || (unsigned char)line[i] > '~';
    }
    const char *expression = strstr(line, line[0] == 'B' ? "=" : "value=");
    if (*dialect->open && expression && expression < line + length && strchr("BEG", line[0])) {
        wrong = wrong || expression[strcspn(expression, "=") + 1] != '{' || line[length - 1] != '}';
    }
    if (wrong) {
        fail_msg("%s: %.*s", dialect->name, (int)length, line);
    }
    check_numbers(line, length);
}

static void lint(const dea_scene *scene, const dea_dialect *dialect, const char *analogy)
{
    char *text = exported(scene, dialect->name, analogy);
    const char *line = text;
    while (*line) {
        const size_t length = strcspn(line, "\n");
        assert_true(length > 0);
        if (*line != '*') {
            check_card(line, length, dialect);
        }
        line += length + 1;
    }
    assert_string_equal(line - strlen(".end\n"), ".end\n");
    free(text);
}

static void netlists_keep_to_the_rules_of_their_dialect(void **state)
{
    static const moving_example examples[] = {
        {"fast-lens", NULL, {NULL}, 0},
        {"lens-optics", NULL, {"study.over={}"}, 0},
        {"sine-supply", NULL, {"drive.leakage_resistance=1 GOhm", "drive.waveform.sine.delay=1 ms"}, 0},
        {"vhb-creep", "coverage", {NULL}, 0},
        {"protocol", NULL, {"study.over={}"}, 0},
        {"resonance", NULL, {NULL}, 0},
        {"figure10", "coverage", {NULL}, 0},
        {"vhb", "lumped", {NULL}, 0},
    };
    (void)state;
    for (size_t i = 0; i < sizeof examples / sizeof *examples; i++) {
        dea_scene scene;
        const size_t changes = !examples[i].changes[0] ? 0 : !examples[i].changes[1] ? 1 : 2;
        read_example(examples[i].name, examples[i].changes, changes, examples[i].model, &scene);
        for (size_t d = 0; dea_dialect_at(d); d++) {
            lint(&scene, dea_dialect_at(d), "mobility");
            if (scene.study != DEA_STUDY_SWEEP) {
                lint(&scene, dea_dialect_at(d), "impedance");
            }
        }
        dea_scene_free(&scene);
    }
}

/* Runs the program with words up to NULL; its exit status. DEASPICE names it, else build/deaspice. */
static int run_program(const char *const *words)
{
    char *arguments[16];
    int status;
    const char *given = getenv("DEASPICE");
    size_t count = 0;
    arguments[count++] = (char *)(uintptr_t)(given ? given : "build/deaspice");
    for (size_t i = 0; words[i]; i++) {
        arguments[count++] = (char *)(uintptr_t)words[i];
    }
    arguments[count] = NULL;
    const pid_t pid = fork();
    if (pid == 0) {
        const int log = open("/dev/null", O_RDWR);
        dup2(log, STDIN_FILENO);
        dup2(log, STDOUT_FILENO);
        dup2(log, STDERR_FILENO);
        execv(arguments[0], arguments);
        _exit(127);
    }
    assert_int_equal(waitpid(pid, &status, 0), pid);
    return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
}

#define PROGRAM(...) run_program((const char *const[]){"export", __VA_ARGS__, NULL})

static void program_writes_whole_files_or_none(void **state)
{
    static const char scene[] = "examples/sine-supply.yaml";
    char netlist[PATH_ROOM], part[PATH_ROOM], symbol[PATH_ROOM], drawing[PATH_ROOM], library[PATH_ROOM], bad[PATH_ROOM];
    path_to("a.cir", netlist);
    path_to("b.lib", part);
    path_to("c.kicad_sym", symbol);
    path_to("c.lib", library);
    path_to("c.asy", drawing);
    path_to("d;x.asy", bad);
    (void)state;
    assert_int_equal(PROGRAM("--as", "netlist", "-o", netlist, scene), 0);
    assert_int_equal(PROGRAM("--as", "subckt", "--dialect", "xyce", "-o", part, scene), 0);
    assert_int_equal(access(netlist, F_OK) | access(part, F_OK), 0);
    assert_int_equal(PROGRAM("--as", "kicad", "-o", symbol, scene), 0);
    assert_int_equal(access(symbol, F_OK) | unlink(library), 0);
    assert_int_equal(PROGRAM("--as", "ltspice", "-o", drawing, scene), 0);
    assert_int_equal(access(drawing, F_OK) | unlink(library), 0);
    unlink(netlist);
    unlink(part);
    unlink(symbol);
    unlink(drawing);
    assert_int_equal(PROGRAM(scene), 2);
    assert_int_equal(PROGRAM("--as", "board", "-o", netlist, scene), 2);
    assert_int_equal(PROGRAM("--as", "netlist", "--dialect", "spectre", "-o", netlist, scene), 2);
    assert_int_equal(PROGRAM("--as", "netlist", "--analogy", "thermal", "-o", netlist, scene), 2);
    assert_int_equal(PROGRAM("--as", "netlist", "--model", "lumped,lame", "-o", netlist, scene), 2);
    assert_int_equal(PROGRAM("--as", "netlist", "-o", netlist, "examples/lens-optics.yaml"), 2);
    assert_int_equal(PROGRAM("--as", "subckt", "--analogy", "impedance", "-o", netlist, scene), 2);
    assert_int_equal(PROGRAM("--as", "kicad", "--dialect", "xyce", "-o", symbol, scene), 2);
    assert_int_equal(PROGRAM("--as", "kicad", "-o", netlist, scene), 2);
    assert_int_equal(PROGRAM("--as", "ltspice", "-o", bad, scene), 2);
    assert_int_equal(PROGRAM("--as", "netlist", "-o", "/nonexistent/a.cir", scene), 1);
    assert_int_equal(access(netlist, F_OK), -1);
    assert_int_equal(access(symbol, F_OK), -1);
    assert_int_equal(access(library, F_OK), -1);
}

/* A film without mass, relaxation and damper has no time of its own: it stands where its voltage wants it. */
static void film_without_memory_follows_the_voltage_in_both_analogies(void **state)
{
    static const char *const analogies[] = {"mobility", "impedance"};
    static const char *const models[] = {"lumped", "lame", "coverage"};
    static const double rises[] = {0.0, 1e-6}; /* both shorter than what steps of 10 ms resolve */
    (void)state;
    for (int i = 0; i < 6; i++) {
        plot p;
        dea_scene scene = paper_scene(DEA_DOT, 1.2, 0.5, (double)NAN);
        scene.models[0] = dea_model_find(models[i % 3]);
        scene.material.density = (double)NAN;
        scene.study = DEA_STUDY_TRANSIENT;
        scene.transient = (dea_transient){.until = 1.0, .every = 0.01};
        scene.drive.waveform = (dea_waveform){.kind = DEA_WAVE_STEP,
                                              .step = {.on = 0.25, .off = (double)NAN, .voltage = 4500.0, .rise = rises[i % 2]},
                                              .period = (double)NAN};
        const double wanted = solve_paper(models[i % 3], DEA_DOT, 1.2, 0.5, 4500.0).displacement;
        run_netlist(&scene, analogies[i / 3], &p);
        assert_true(fabs(displacement_at(&p, 0.24)) <= 1e-9 * wanted);
        assert_relative(displacement_at(&p, 0.26), wanted, 1e-6);
        assert_relative(displacement_at(&p, 1.0), wanted, 1e-6);
        free_plot(&p);
    }
}

static bool holds_line(const char *path, const char *wanted)
{
    char line[512];
    bool held = false;
    FILE *file = fopen(path, "r");
    assert_non_null(file);
    while (fgets(line, sizeof line, file)) {
        held = held || strcmp(line, wanted) == 0;
    }
    fclose(file);
    return held;
}

/* After the file, the scene where that is a stream, or what the user says. */
static void a_part_has_the_name_of_its_file(void **state)
{
    (void)state;
    static const struct {
        const char *path, *name;
    } known[] = {{"a/soft.lib", "soft"}, {"2 ply.v1.lib", "dea_2_ply"}, {"-", NULL}, {"a/.lib", NULL}, {"./.hidden", NULL},
                 {"_a-b", "dea__a_b"}, {"a234567890123456789012345678901234567890.lib", "a2345678901234567890123456789012"}};
    char name[DEA_PART_NAME_LENGTH + 1], part[PATH_ROOM];
    for (size_t i = 0; i < sizeof known / sizeof *known; i++) {
        assert_int_equal(dea_part_name_after(known[i].path, name), known[i].name != NULL);
        assert_true(!known[i].name || (strcmp(name, known[i].name) == 0 && dea_part_name_valid(name)));
    }
    path_to("hard-one.lib", part);
    assert_int_equal(PROGRAM("--as", "subckt", "-o", part, "tests/cases/part_soft.yaml"), 0);
    assert_true(holds_line(part, ".subckt hard_one p n edge\n") && holds_line(part, ".ends hard_one_lever\n"));
    assert_int_equal(PROGRAM("--as", "subckt", "--name", "soft", "-o", part, "tests/cases/part_soft.yaml"), 0);
    assert_true(holds_line(part, ".subckt soft p n edge\n"));
    unlink(part);
}

/* Two scenes of different material as parts of one circuit. */
static void two_parts_keep_their_material_in_one_circuit(void **state)
{
    (void)state;
    char first[PATH_ROOM], second[PATH_ROOM], command[4 * PATH_ROOM], line[256];
    double silicone = 0.0, soft = 0.0;
    path_to("part_silicone.lib", first);
    path_to("part_soft.lib", second);
    assert_int_equal(PROGRAM("--as", "subckt", "-o", first, "tests/cases/part_silicone.yaml"), 0);
    assert_int_equal(PROGRAM("--as", "subckt", "-o", second, "tests/cases/part_soft.yaml"), 0);
    snprintf(command, sizeof command, "cp tests/cases/two_parts.cir '%s/circuit.cir' && cd '%s' && ngspice -b circuit.cir 2>&1", folder,
             folder);
    FILE *heard = popen(command, "r");
    assert_non_null(heard);
    while (fgets(line, sizeof line, heard)) {
        (void)sscanf(line, "v(xa.u) = %lf", &silicone);
        (void)sscanf(line, "v(xb.u) = %lf", &soft);
    }
    pclose(heard);
    assert_true(fabs(silicone - 94.73) < 0.01 && fabs(soft - 524.35) < 0.01);
    unlink(first);
    unlink(second);
    assert_int_equal(PROGRAM("--as", "subckt", "--name", "2soft", "-o", first, "tests/cases/part_soft.yaml"), 2);
    assert_int_equal(PROGRAM("--as", "netlist", "--name", "soft", "-o", first, "tests/cases/part_soft.yaml"), 2);
    assert_int_equal(access(first, F_OK), -1);
}

/* Xyce's own control of the error stops at edges, and tolerances for one node cannot be given to it. */
static void transients_for_xyce_step_by_tmax_alone(void **state)
{
    (void)state;
    static const char *const analogies[] = {"mobility", "impedance"};
    char netlist[PATH_ROOM], line[512];
    path_to("x.cir", netlist);
    for (size_t i = 0; i < 2; i++) {
        int steps = 0;
        assert_int_equal(PROGRAM("--as", "netlist", "--dialect", "xyce", "--analogy", analogies[i], "--model", "coverage", "-o", netlist,
                                 "examples/sine-supply.yaml"),
                         0);
        FILE *file = fopen(netlist, "r");
        assert_non_null(file);
        while (fgets(line, sizeof line, file)) {
            steps += strcmp(line, ".options timeint erroption=1\n") == 0;
            assert_true(!strstr(line, "nonlin") && (strncmp(line, ".options", 8) != 0 || strstr(line, "erroption")));
        }
        fclose(file);
        assert_int_equal(steps, 1);
    }
    unlink(netlist);
}

int main(int argc, char **argv)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(netlists_of_the_moving_examples_give_the_numbers_of_the_engines),
        cmocka_unit_test(a_film_that_is_charged_evenly_takes_long_steps),
        cmocka_unit_test(netlists_of_random_transients_are_right_to_half_of_what_is_asked),
        cmocka_unit_test(netlists_of_frequency_responses_give_the_numbers_of_the_engine),
        cmocka_unit_test(grid_of_a_frequency_response_ends_below_an_end_that_is_off_it),
        cmocka_unit_test(netlists_of_the_static_examples_give_the_numbers_of_the_engine),
        cmocka_unit_test(netlist_of_one_point_gives_its_displacement),
        cmocka_unit_test(netlists_of_random_sweeps_give_the_numbers_of_the_engine),
        cmocka_unit_test(netlists_of_every_law_give_the_numbers_of_the_engines),
        cmocka_unit_test(what_no_netlist_can_hold_is_refused_with_a_way_out),
        cmocka_unit_test(titles_never_become_cards_or_commands),
        cmocka_unit_test(netlists_keep_to_the_rules_of_their_dialect),
        cmocka_unit_test(film_without_memory_follows_the_voltage_in_both_analogies),
        cmocka_unit_test(program_writes_whole_files_or_none),
        cmocka_unit_test(a_part_has_the_name_of_its_file),
        cmocka_unit_test(two_parts_keep_their_material_in_one_circuit),
        cmocka_unit_test(transients_for_xyce_step_by_tmax_alone),
    };
    if (!mkdtemp(folder)) {
        return 1;
    }
    cmocka_set_test_filter(argc > 1 ? argv[1] : NULL);
    const int failed = cmocka_run_group_tests(tests, NULL, NULL);
    char path[PATH_ROOM];
    path_to("circuit.cir", path);
    unlink(path);
    path_to("out.raw", path);
    unlink(path);
    rmdir(folder);
    return failed;
}
