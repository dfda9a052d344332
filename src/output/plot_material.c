/* Pictures of a material and of a fit: stress and modulus over stretch, stress over time. */
#include "output/picture.h"

#include "output/legend.h"
#include "support/number.h"

#include <math.h>
#include <string.h>

enum { LEFT = 82, RIGHT = 24, TOP = 18, LABELS = 58, PANEL = 340, LEAST = 60, NATURAL = 640, CURVE_STEPS = 200, POINTS_MAX = 2000 };

/* How the curve and the points of a load look: told apart in grey too. */
static const struct {
    const char *title, *colour;
    size_t dash;
    int symbol;
} loads[DEA_LOAD_COUNT] = {{"uniaxial", "#404040", 1, 6}, {"equi-biaxial", "#b03060", 2, 8}};

/* In the looks of a load. */
static void add_entry(dea_legend *legend, dea_load load, const char *title, const char *what, bool line, bool point)
{
    dea_legend_entry *entry = dea_legend_add(legend);
    snprintf(entry->label, sizeof entry->label, "%s%s", title, what);
    snprintf(entry->colour, sizeof entry->colour, "%s", loads[load].colour);
    entry->dash = line ? loads[load].dash : 0;
    entry->symbol = point ? loads[load].symbol : 0;
}

/* Puts a legend of one kind of entries at the foot of a canvas. */
static int lay_legend(dea_legend *legend, int width)
{
    const size_t kinds[] = {0, legend->count};
    return dea_legend_lay(legend, kinds, 1, width);
}

static void write_line(FILE *script, const char *before, const char *block, int number, dea_load load)
{
    fprintf(script, "%s$%s%d with lines linewidth 1.8 linecolor '%s' %s", before, block, number, loads[load].colour,
            dea_plot_dash(loads[load].dash));
}

static void write_measured(FILE *script, const char *before, const char *block, int number, dea_load load)
{
    fprintf(script, "%s$%s%d with points pointtype %d pointsize 0.7*ps linewidth 1 linecolor '%s'", before, block, number,
            loads[load].symbol, loads[load].colour);
}

/* Data block $fit<load> of nominal stress [kPa] over stretch. */
static void write_stress(FILE *script, const dea_law *law, const double *constants, dea_load load, double from, double to)
{
    fprintf(script, "$fit%d << END\n", (int)load);
    for (int i = 0; i <= CURVE_STEPS; i++) {
        const double stretch = from + (to - from) * i / CURVE_STEPS;
        dea_gnuplot_put(script, "%g %g\n", stretch, 1e-3 * dea_fit_stress(law, constants, load, stretch));
    }
    fputs("END\n", script);
}

static void write_material_data(const dea_material *material, double to, FILE *script)
{
    double constants[DEA_LAW_CONSTANTS];
    dea_material_long_term(material, constants);
    for (int load = 0; load < DEA_LOAD_COUNT; load++) {
        write_stress(script, material->law, constants, (dea_load)load, 1.0, to);
    }
    fputs("$modulus0 << END\n", script);
    for (int i = 0; i <= CURVE_STEPS; i++) {
        const double stretch = 1.0 + (to - 1.0) * i / CURVE_STEPS;
        dea_gnuplot_put(script, "%g %g\n", stretch, 1e-6 * dea_law_modulus(material->law, constants, stretch));
    }
    fputs("END\n", script);
}

static void write_material(const dea_material *material, double to, const dea_gnuplot *picture, const dea_pair *pair,
                           const dea_legend *legend)
{
    FILE *script = picture->script;
    write_material_data(material, to, script);
    dea_plot_style(script);
    dea_plot_title(script, material->name, picture->canvas.width, pair->height);
    dea_gnuplot_put(script,
                    "set xrange [1:%g]\nset yrange [0:*]\nset offsets graph 0, graph 0, graph 0.06, graph 0\n"
                    "set label 1 '(a)' at graph 0, graph 1 offset character 0, character 0.8\n"
                    "set xlabel %q\nset ylabel %q\n",
                    to, "Stretch λ", "Engineering stress P [kPa]");
    dea_plot_place(script, picture->canvas.width, pair->height, pair->boxes[0]);
    for (int load = 0; load < DEA_LOAD_COUNT; load++) {
        write_line(script, load > 0 ? ", " : "plot ", "fit", load, (dea_load)load);
    }
    fputs("\nunset label 2\nset label 1 '(b)' at graph 0, graph 1 offset character 0, character 0.8\n", script);
    dea_gnuplot_put(script, "set ylabel %q\n", "Operating modulus Y [MPa]");
    dea_plot_place(script, picture->canvas.width, pair->height, pair->boxes[1]);
    write_line(script, "plot ", "modulus", 0, DEA_LOAD_EQUIBIAXIAL);
    fputs("\nunset offsets\n", script);
    dea_legend_draw(legend, script, picture->canvas.width, pair->height);
}

dea_status dea_plot_material(const dea_material *material, double to, const char *path, const dea_plot_options *options,
                             dea_error *error)
{
    dea_gnuplot picture;
    dea_pair pair;
    dea_legend legend = {.count = 0};
    dea_status status = dea_gnuplot_begin(&picture, path, options, error);
    if (status != DEA_OK) {
        return status;
    }
    for (int load = 0; load < DEA_LOAD_COUNT; load++) {
        add_entry(&legend, (dea_load)load, loads[load].title, "", true, false);
    }
    status = dea_plot_pair(picture.canvas, material->name, 0.0, lay_legend(&legend, picture.canvas.width), &pair, error);
    if (status == DEA_OK) {
        dea_gnuplot_size(&picture, pair.height);
        write_material(material, to, &picture, &pair, &legend);
    }
    const dea_status drawn = dea_gnuplot_finish(&picture, status == DEA_OK, status == DEA_OK ? error : NULL);
    return status != DEA_OK ? status : drawn;
}

/* Data block $data<load> of the measured points, evenly thinned where there are very many. */
static void write_points(FILE *script, const dea_fit_data *data, const dea_fit *fit, dea_load load)
{
    const size_t step = fit->count[load] / POINTS_MAX + 1;
    size_t seen = 0;
    fprintf(script, "$data%d << END\n", (int)load);
    for (size_t i = 0; i < data->count; i++) {
        if (data->points[i].load == load && seen++ % step == 0) {
            dea_gnuplot_put(script, "%g %g\n", data->points[i].stretch, 1e-3 * data->points[i].stress);
        }
    }
    fputs("END\n", script);
}

/* Where axes stand. */
typedef struct panel {
    const dea_gnuplot *picture;
    dea_box box;
    int height; /* of the picture */
} panel;

/* Opens axes with their titles. */
static void write_panel(FILE *script, const panel *at, double from, double to, const char *across, const char *up)
{
    dea_gnuplot_put(script, "set xrange [%g:%g]\nset xlabel %q\nset ylabel %q\n", from, to, across, up);
    dea_plot_place(script, at->picture->canvas.width, at->height, at->box);
}

static void write_fit(const dea_fit *fit, const dea_fit_data *data, const panel *at)
{
    FILE *script = at->picture->script;
    const double from = fmin(fit->stretch_min, 1.0), to = fmax(fit->stretch_max, 1.0);
    write_panel(script, at, from, to, "Stretch λ", "Engineering stress P [kPa]");
    for (int load = 0; load < DEA_LOAD_COUNT; load++) {
        if (fit->count[load] > 0) {
            write_stress(script, fit->law, fit->constants, (dea_load)load, from, to);
            write_points(script, data, fit, (dea_load)load);
        }
    }
    const char *before = "plot ";
    for (int load = 0; load < DEA_LOAD_COUNT; load++) {
        if (fit->count[load] > 0) {
            write_measured(script, before, "data", load, (dea_load)load);
            write_line(script, ", ", "fit", load, (dea_load)load);
            before = ", ";
        }
    }
    fputc('\n', script);
}

/* The time axis is log10(1 + t/t_1), t_1 the first time after 0: logarithmic, and yet with a place for t = 0. */
static double time_place(double time, double first)
{
    return log10(1.0 + time / first);
}

static void write_time_tics(FILE *script, double first, double last)
{
    fputs("set xtics (\"0\" 0", script);
    for (double tic = pow(10.0, floor(log10(first))); tic <= last; tic *= 10.0) {
        if (tic >= 0.99 * first) {
            char label[DEA_NUMBER_LENGTH];
            dea_gnuplot_put(script, ", \"%s\" %g", dea_number_text(label, tic, 3), time_place(tic, first));
        }
    }
    fputs(")\n", script);
}

/* How a test is drawn: its axes, the factor to their unit, the curves and their names. */
typedef struct drawn_test {
    const char *across, *up;
    double factor;
    size_t curves;
    const char *titles[2];
} drawn_test;

static const drawn_test drawn_tests[DEA_TESTS] = {
    [DEA_TEST_RELAXATION] = {"Time since the end of the ramp t [s]", "Engineering stress P [kPa]", 1e-3, 1, {"uniaxial", NULL}},
    [DEA_TEST_DYNAMIC] = {"Frequency f [Hz]", "Modulus [kPa]", 1e-3, 2, {"storage", "loss"}},
    [DEA_TEST_CREEP] = {"Time since the end of the ramp t [s]", "Strain over the largest one", 1.0, 1, {"creep", NULL}},
};

/* Where a time or an angular frequency stands on the axis. */
static double test_place(const dea_relaxation *fit, double at, double first)
{
    return fit->kind == DEA_TEST_DYNAMIC ? log10(0.5 * at / DEA_PI) : time_place(at, first);
}

/* Data blocks $held<curve> and $relaxed<curve>; @p scale: of their numbers. */
static void write_test_data(FILE *script, const dea_relaxation *fit, const dea_relaxation_data *data, double first, double scale)
{
    const dea_relaxation_point *points = data->points;
    const bool swings = fit->kind == DEA_TEST_DYNAMIC;
    const size_t step = data->count / POINTS_MAX + 1;
    const double from = swings ? test_place(fit, points[0].time, first) : 0.0;
    const double to = test_place(fit, points[data->count - 1].time, first);
    for (size_t curve = 0; curve < drawn_tests[fit->kind].curves; curve++) {
        fprintf(script, "$held%zu << END\n", curve);
        for (size_t i = 0; i < data->count; i += step) {
            dea_gnuplot_put(script, "%g %g\n", test_place(fit, points[i].time, first), scale * (curve == 0 ? points[i].stress : points[i].loss));
        }
        fprintf(script, "END\n$relaxed%zu << END\n", curve);
        for (int i = 0; i <= CURVE_STEPS; i++) {
            const double place = from + (to - from) * i / CURVE_STEPS, power = pow(10.0, place);
            const double at = swings ? 2.0 * DEA_PI * power : first * (power - 1.0);
            dea_gnuplot_put(script, "%g %g\n", place, scale * (curve == 0 ? dea_relaxation_stress(fit, at) : dea_relaxation_loss(fit, at)));
        }
        fputs("END\n", script);
    }
}

/* Whole decades of the frequency. */
static void write_frequency_tics(FILE *script, double from, double to)
{
    const char *before = "";
    fputs("set xtics (", script);
    for (double power = ceil(from - 1e-9); power <= to + 1e-9; power += 1.0) {
        char label[DEA_NUMBER_LENGTH];
        dea_gnuplot_put(script, "%s\"%s\" %g", before, dea_number_text(label, pow(10.0, power), 3), power);
        before = ", ";
    }
    fputs(")\n", script);
}

static double largest_of(const dea_relaxation_data *data)
{
    double largest = 0.0;
    for (size_t i = 0; i < data->count; i++) {
        largest = fmax(largest, data->points[i].stress);
    }
    return largest;
}

static void write_relaxation(const dea_relaxation *fit, const dea_relaxation_data *data, const panel *at)
{
    FILE *script = at->picture->script;
    const drawn_test *drawn = &drawn_tests[fit->kind];
    const bool swings = fit->kind == DEA_TEST_DYNAMIC, creeps = fit->kind == DEA_TEST_CREEP;
    const double first = data->points[0].time > 0.0 ? data->points[0].time : data->points[1].time;
    const double from = swings ? test_place(fit, first, first) : 0.0, to = test_place(fit, data->points[data->count - 1].time, first);
    write_panel(script, at, from, to, drawn->across, drawn->up);
    fputs("set yrange [0:*]\n", script);
    if (swings) {
        write_frequency_tics(script, from, to);
    } else {
        write_time_tics(script, first, fit->time_max);
    }
    write_test_data(script, fit, data, first, creeps ? 1.0 / largest_of(data) : drawn->factor);
    for (size_t curve = 0; curve < drawn->curves; curve++) {
        write_measured(script, curve == 0 ? "plot " : ", ", "held", (int)curve, (dea_load)curve);
        write_line(script, ", ", "relaxed", (int)curve, (dea_load)curve);
    }
    fputc('\n', script);
}

/* What curves and points are, for the loads and the curves of a test that were measured; a test of relaxation is uniaxial. */
static void list_fit(const dea_fit *fit, const dea_relaxation *test, dea_legend *legend)
{
    const bool relaxes = test && test->kind == DEA_TEST_RELAXATION;
    for (int load = 0; load < DEA_LOAD_COUNT; load++) {
        if ((fit && fit->count[load] > 0) || (relaxes && load == DEA_LOAD_UNIAXIAL)) {
            add_entry(legend, (dea_load)load, loads[load].title, ", measured", false, true);
            add_entry(legend, (dea_load)load, loads[load].title, ", fit", true, false);
        }
    }
    for (size_t curve = 0; test && !relaxes && curve < drawn_tests[test->kind].curves; curve++) {
        add_entry(legend, (dea_load)curve, drawn_tests[test->kind].titles[curve], ", measured", false, true);
        add_entry(legend, (dea_load)curve, drawn_tests[test->kind].titles[curve], ", fit", true, false);
    }
}

/* Panels of stress over stretch and over time, side by side where there are both. */
static dea_status place_fit(dea_gnuplot *picture, bool both, int legend, panel panels[2], dea_error *error)
{
    const dea_canvas *canvas = &picture->canvas;
    const int height = canvas->height > 0 ? canvas->height : TOP + PANEL + LABELS + legend;
    const double cell = canvas->width / (both ? 2.0 : 1.0);
    for (int i = 0; i < 2; i++) {
        const dea_box box = {LEFT + (both ? i * cell : 0.0), TOP, cell - LEFT - RIGHT, height - TOP - LABELS - legend};
        panels[i] = (panel){picture, box, height};
    }
    return panels[0].box.width < LEAST || panels[0].box.height < LEAST ? dea_plot_cramped(*canvas, error) : DEA_OK;
}

dea_status dea_plot_fit(const dea_fit *fit, const dea_fit_data *data, const dea_relaxation *relaxation,
                        const dea_relaxation_data *held, const char *path, const dea_plot_options *options, dea_error *error)
{
    dea_gnuplot picture;
    panel panels[2];
    dea_legend legend = {.count = 0};
    dea_status status = dea_gnuplot_begin(&picture, path, options, error);
    if (status != DEA_OK) {
        return status;
    }
    if (picture.canvas.height == 0) {
        picture.canvas.width = fit && relaxation ? 2 * NATURAL : NATURAL;
    }
    list_fit(fit, relaxation, &legend);
    status = place_fit(&picture, fit && relaxation, lay_legend(&legend, picture.canvas.width), panels, error);
    if (status == DEA_OK) {
        dea_gnuplot_size(&picture, panels[0].height);
        dea_plot_style(picture.script);
        fputs("unset key\nset multiplot\n", picture.script);
        if (fit) {
            write_fit(fit, data, &panels[0]);
        }
        if (relaxation) {
            write_relaxation(relaxation, held, &panels[1]);
        }
        dea_legend_draw(&legend, picture.script, picture.canvas.width, panels[0].height);
    }
    const dea_status drawn = dea_gnuplot_finish(&picture, status == DEA_OK, status == DEA_OK ? error : NULL);
    return status != DEA_OK ? status : drawn;
}
