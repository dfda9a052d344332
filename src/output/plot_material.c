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

static void write_setting(FILE *script, const char *setting, const char *text)
{
    fprintf(script, "set %s ", setting);
    dea_gnuplot_text(script, text);
    fputc('\n', script);
}

static void write_pair(FILE *script, double x, double y)
{
    dea_gnuplot_number(script, x);
    fputc(' ', script);
    dea_gnuplot_number(script, y);
    fputc('\n', script);
}

static void add_entry(dea_legend *legend, dea_load load, const char *what, bool line, bool point)
{
    dea_legend_entry *entry = dea_legend_add(legend);
    snprintf(entry->label, sizeof entry->label, "%s%s", loads[load].title, what);
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
    fprintf(script, "%s$%s%d with lines linewidth 1.8 linecolor '%s' ", before, block, number, loads[load].colour);
    dea_plot_dash(script, loads[load].dash);
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
        write_pair(script, stretch, 1e-3 * dea_fit_stress(law, constants, load, stretch));
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
        write_pair(script, stretch, 1e-6 * dea_law_modulus(material->law, constants, stretch));
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
    fputs("set xrange [1:", script);
    dea_gnuplot_number(script, to);
    fputs("]\nset yrange [0:*]\nset offsets graph 0, graph 0, graph 0.06, graph 0\n"
          "set label 1 '(a)' at graph 0, graph 1 offset character 0, character 0.8\n",
          script);
    write_setting(script, "xlabel", "Stretch λ");
    write_setting(script, "ylabel", "Engineering stress P [kPa]");
    dea_plot_place(script, picture->canvas.width, pair->height, pair->boxes[0]);
    for (int load = 0; load < DEA_LOAD_COUNT; load++) {
        write_line(script, load > 0 ? ", " : "plot ", "fit", load, (dea_load)load);
    }
    fputs("\nunset label 2\nset label 1 '(b)' at graph 0, graph 1 offset character 0, character 0.8\n", script);
    write_setting(script, "ylabel", "Operating modulus Y [MPa]");
    dea_plot_place(script, picture->canvas.width, pair->height, pair->boxes[1]);
    write_line(script, "plot ", "modulus", 0, DEA_LOAD_EQUIBIAXIAL);
    fputs("\nunset offsets\n", script);
    dea_legend_draw(legend, script, picture->canvas.width, pair->height);
    fputs("unset multiplot\nunset output\n", script);
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
        add_entry(&legend, (dea_load)load, "", true, false);
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
            write_pair(script, data->points[i].stretch, 1e-3 * data->points[i].stress);
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
static void write_panel(FILE *script, const panel *at, double from, double to, const char *across)
{
    fputs("set xrange [", script);
    dea_gnuplot_number(script, from);
    fputc(':', script);
    dea_gnuplot_number(script, to);
    fputs("]\n", script);
    write_setting(script, "xlabel", across);
    write_setting(script, "ylabel", "Engineering stress P [kPa]");
    dea_plot_place(script, at->picture->canvas.width, at->height, at->box);
}

static void write_fit(const dea_fit *fit, const dea_fit_data *data, const panel *at)
{
    FILE *script = at->picture->script;
    const double from = fmin(fit->stretch_min, 1.0), to = fmax(fit->stretch_max, 1.0);
    write_panel(script, at, from, to, "Stretch λ");
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
            fprintf(script, ", \"%s\" ", dea_number_text(label, tic, 3));
            dea_gnuplot_number(script, time_place(tic, first));
        }
    }
    fputs(")\n", script);
}

static void write_relaxation_points(FILE *script, const dea_relaxation_data *data, double first)
{
    const size_t step = data->count / POINTS_MAX + 1;
    fputs("$held0 << END\n", script);
    for (size_t i = 0; i < data->count; i += step) {
        write_pair(script, time_place(data->points[i].time, first), 1e-3 * data->points[i].stress);
    }
    fputs("END\n", script);
}

static void write_relaxation_curve(FILE *script, const dea_relaxation *fit, double first)
{
    const double to = time_place(fit->time_max, first);
    fputs("$relaxed0 << END\n", script);
    for (int i = 0; i <= CURVE_STEPS; i++) {
        const double place = to * i / CURVE_STEPS;
        write_pair(script, place, 1e-3 * dea_relaxation_stress(fit, first * (pow(10.0, place) - 1.0)));
    }
    fputs("END\n", script);
}

static void write_relaxation(const dea_relaxation *fit, const dea_relaxation_data *data, const panel *at)
{
    FILE *script = at->picture->script;
    const double first = data->points[0].time > 0.0 ? data->points[0].time : data->points[1].time;
    write_panel(script, at, 0.0, time_place(fit->time_max, first), "Time since the end of the ramp t [s]");
    fputs("set yrange [0:*]\n", script);
    write_time_tics(script, first, fit->time_max);
    write_relaxation_points(script, data, first);
    write_relaxation_curve(script, fit, first);
    write_measured(script, "plot ", "held", 0, DEA_LOAD_UNIAXIAL);
    write_line(script, ", ", "relaxed", 0, DEA_LOAD_UNIAXIAL);
    fputc('\n', script);
}

/* What curves and points are, for the loads that were measured; a test of relaxation is uniaxial. */
static void list_fit(const dea_fit *fit, bool held, dea_legend *legend)
{
    for (int load = 0; load < DEA_LOAD_COUNT; load++) {
        if ((fit && fit->count[load] > 0) || (held && load == DEA_LOAD_UNIAXIAL)) {
            add_entry(legend, (dea_load)load, ", measured", false, true);
            add_entry(legend, (dea_load)load, ", fit", true, false);
        }
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
        fputs("unset multiplot\nunset output\n", picture.script);
    }
    const dea_status drawn = dea_gnuplot_finish(&picture, status == DEA_OK, status == DEA_OK ? error : NULL);
    return status != DEA_OK ? status : drawn;
}
